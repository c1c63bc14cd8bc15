//! What a bond-based cloud is calibrated to: sums over the families that it really has in its bulk.

use crate::body::Body;
use crate::error::BuildError;
use crate::family::horizon::HorizonList;
use crate::family::periods;
use crate::interaction::weight::BondWeight;
use crate::law::micromodulus::Moments;
use crate::spec::Spec;

/// Means over the families of the bulk; `None` for a body without bulk, all of it closer to its surface than the
/// horizon. `cell` is the spacing over which a partner's volume fades at the horizon (length).
///
/// A point is in the bulk if its partners reach to within a spacing of the horizon along every axis and every diagonal,
/// both ways: a surface nearer than that is seen, and the volumes of the family, which scatter, do not matter.
pub(super) fn cloud_moments<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    horizon: f64,
    cell: f64,
) -> Result<Option<Moments>, BuildError> {
    let list = HorizonList::new(body, horizon * (1.0 + 1e-9))?;
    let scaling = spec.bonds.partial_volume_correction.then_some(cell);
    let weight = BondWeight::new(spec.bonds.influence, horizon, scaling);
    let directions = directions::<D>();
    let bulk: Vec<Moments> = (0..list.rows().len())
        .filter_map(|row| family(body, &list, row, weight, &directions, horizon - cell))
        .collect();
    let of = |of: fn(&Moments) -> f64| bulk.iter().map(of).collect();
    let sums = body.sums([of(|m| m.first), of(|m| m.second), of(|m| m.bare)]);
    let points = body.count(bulk.len() as u64);
    let [first, second, bare] = sums.map(|sum| sum / points as f64);
    Ok((points > 0).then_some(Moments {
        first,
        second,
        bare,
    }))
}

/// Unit vectors along all axes and diagonals.
fn directions<const D: usize>() -> Vec<[f64; D]> {
    let all = (0..3usize.pow(D as u32)).map(|n| -> [f64; D] {
        crate::array::from_fn(|a| (n / 3usize.pow(a as u32) % 3) as f64 - 1.0)
    });
    all.filter_map(|d| {
        let length = d.iter().map(|c| c * c).sum::<f64>().sqrt();
        (length > 0.0).then(|| d.map(|c| c / length))
    })
    .collect()
}

/// The sums of one family, if its partners reach as far as `reach` (length) in all directions.
fn family<const D: usize>(
    body: &Body<D>,
    list: &HorizonList,
    row: usize,
    weight: BondWeight,
    directions: &[[f64; D]],
    reach: f64,
) -> Option<Moments> {
    let x = body.position(list.rows()[row] as usize);
    let mut support = [0.0f64; 26];
    let mut sum = Moments {
        first: 0.0,
        second: 0.0,
        bare: 0.0,
    };
    for (_, j) in list.partners(row) {
        let y = body.position(j);
        let xi: [f64; D] = crate::array::from_fn(|a| y[a] - x[a]);
        let back = periods(body, &xi);
        let xi: [f64; D] = crate::array::from_fn(|a| xi[a] - back[a]);
        let r0 = xi.iter().map(|c| c * c).sum::<f64>().sqrt();
        let w = weight.at(&xi, r0, 1.0 / r0) * body.volume().at(j);
        sum.first += w * r0;
        sum.second += w * r0 * r0;
        sum.bare += weight.volume_fraction(r0) * body.volume().at(j) * r0;
        for (s, d) in support.iter_mut().zip(directions) {
            *s = s.max((0..D).map(|a| xi[a] * d[a]).sum());
        }
    }
    let seen = &support[..directions.len()];
    (sum.first > 0.0 && seen.iter().all(|s| *s >= reach)).then_some(sum)
}
