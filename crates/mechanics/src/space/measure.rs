//! How large a region is.

use super::region::Region;
use std::f64::consts::PI;

/// Points at which a region that is no box, ball or cylinder is looked at: its measure is then right to about a thousandth.
const LOOKS: usize = 1 << 17;

/// Ends of a region that is a box; `None`: another shape.
pub fn ends(region: &Region) -> Option<[[f64; 3]; 2]> {
    match region {
        Region::Everything | Region::Block { .. } => Some(region.bounds().into()),
        Region::Intersection(parts) if parts.iter().all(|p| ends(p).is_some()) => {
            Some(region.bounds().into())
        }
        _ => None,
    }
}

/// Length, area or volume of a region in so many dimensions, along periodic axes that of one period from its lower end; `None`: it has
/// no end, or nothing inside.
///
/// Of boxes, balls and cylinders in closed form; of others the part of their box that holds, at places of Roberts's additive
/// recurrence `x_n = n/φ^k mod 1`, `φ^(D+1) = φ + 1`, which are spread evenly whatever the shape.
pub fn measure(region: &Region, dimension: usize, period: [Option<f64>; 3]) -> Option<f64> {
    let (low, high) = region.bounds();
    let along = |a: usize| period[a].unwrap_or(high[a] - low[a]);
    let fine = |x: f64| (x > 0.0 && x.is_finite()).then_some(x);
    let whole = fine((0..dimension).map(along).product())?;
    if ends(region).is_some() {
        return Some(whole);
    }
    let closed = period.iter().all(Option::is_none);
    match (region, dimension) {
        (Region::Sphere { radius, .. }, _) if closed => {
            return Some(super::ball_volume(dimension, *radius));
        }
        (
            Region::Cylinder {
                radius, axis: 2, ..
            },
            2,
        ) if closed => {
            return Some(PI * radius * radius);
        }
        (
            Region::Cylinder {
                radius, low, high, ..
            },
            3,
        ) if closed => return fine(PI * radius * radius * (high - low)),
        _ => {}
    }
    let phi = [
        1.618_033_988_749_895,
        1.324_717_957_244_746,
        1.220_744_084_605_76,
    ][dimension - 1];
    let step: Vec<f64> = (1..=dimension)
        .map(|k| 1.0 / f64::powi(phi, k as i32))
        .collect();
    let inside = (0..LOOKS).filter(|n| {
        let place = |a: usize| {
            if a >= dimension {
                return 0.0;
            }
            let part = (0.5 + (*n as f64 + 1.0) * step[a]).fract();
            low[a] + (high[a] - low[a]) * part
        };
        region.contains(&crate::array::from_fn(place))
    });
    fine(whole * inside.count() as f64 / LOOKS as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const INF: f64 = f64::INFINITY;

    #[test]
    fn shapes_are_as_large_as_they_are() {
        let block = |high: [f64; 3]| Region::Block {
            low: [0.0; 3],
            high,
        };
        let ball = |radius| Region::Sphere {
            center: [1.0; 3],
            radius,
        };
        let rod = Region::Cylinder {
            axis: 1,
            center: [1.0; 3],
            radius: 0.5,
            low: -1.0,
            high: 2.0,
        };
        let tube = Region::Difference(
            Box::new(rod.clone()),
            vec![Region::Cylinder {
                axis: 1,
                center: [1.0; 3],
                radius: 0.3,
                low: -2.0,
                high: 3.0,
            }],
        );
        let slotted = Region::Difference(
            Box::new(block([10.0, 4.0, 1.0])),
            vec![block([7.0, 0.31, INF])],
        );
        for (region, d, wanted, off) in [
            (block([2.0, 3.0, 4.0]), 3, 24.0, 0.0),
            (block([2.0, 3.0, INF]), 2, 6.0, 0.0),
            (
                Region::Intersection(vec![block([2.0, 3.0, 4.0]), block([1.0, 9.0, 9.0])]),
                3,
                12.0,
                0.0,
            ),
            (ball(2.0), 3, 32.0 * PI / 3.0, 1e-15),
            (ball(2.0), 2, 4.0 * PI, 1e-15),
            (rod, 3, 0.75 * PI, 1e-15),
            (tube, 3, 3.0 * PI * 0.16, 2e-3),
            (slotted, 2, 40.0 - 2.17, 1e-3),
            (
                Region::Union(vec![block([1.0, 1.0, 1.0]), block([3.0, 0.5, 1.0])]),
                2,
                2.0,
                1e-3,
            ),
        ] {
            let found = measure(&region, d, [None; 3]).unwrap();
            assert!(
                (found / wanted - 1.0).abs() <= off,
                "{region:?}: {found} {wanted}"
            );
        }
        assert_eq!(measure(&Region::Everything, 2, [None; 3]), None);
        // one period, whatever was cut of it
        assert_eq!(
            measure(&block([1.9, 3.0, INF]), 2, [Some(2.0), None, None]),
            Some(6.0)
        );
    }
}
