//! What becomes of the mass and volume of removed points.

use super::near::Near;
use super::small::solve_semidefinite;
use peridyne::spec::LinearBody;

/// How the volume of removed points is counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Volume {
    /// Retained points take it over, like the mass: a body force density acts on all of the body.
    #[default]
    Lumped,
    /// Retained points keep their own (silling2010: every level has the same v, so that a body force density at a point means the same
    /// force at every level: erratum 5).
    Kept,
}

/// Where the mass went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lumping {
    /// To several points around: total and centre of mass are kept.
    Centred,
    /// To the nearest points, because a coarse mass would not be positive: the total is kept.
    Nearest,
}

/// Volume and mass per retained point, those of removed points included.
pub(super) struct LumpedMass {
    pub volume: Vec<f64>,
    pub mass: Vec<f64>,
    pub lumping: Lumping,
}

pub(super) fn lump_mass<const D: usize>(
    body: &LinearBody<D>,
    retained: &[u32],
    marked: &[bool],
    spacing: f64,
) -> LumpedMass {
    let points = retained.iter().map(|i| body.position[*i as usize]);
    let near = Near::of(points, spacing, body.period);
    let widest = 2.0 * extents(body).iter().sum::<f64>();
    let attempt = |lumping| {
        let own = |i: &u32| body.volume[*i as usize];
        let mut volume: Vec<f64> = retained.iter().map(own).collect();
        let mut mass: Vec<f64> = retained
            .iter()
            .map(|i| own(i) * body.density[*i as usize])
            .collect();
        for p in (0..body.points()).filter(|p| !marked[*p]) {
            let centred = match lumping {
                Lumping::Centred => centred(&near, body.position[p], spacing, widest),
                Lumping::Nearest => None,
            };
            let shares =
                centred.unwrap_or_else(|| nearest(&near, body.position[p], spacing, widest));
            for (q, w) in shares {
                volume[q as usize] += w * body.volume[p];
                mass[q as usize] += w * body.volume[p] * body.density[p];
            }
        }
        LumpedMass {
            volume,
            mass,
            lumping,
        }
    };
    let lumped = attempt(Lumping::Centred);
    // what was positive stays so
    let sound = (lumped.volume.iter().zip(&lumped.mass).zip(retained))
        .all(|((v, m), i)| *v > 0.0 && (*m > 0.0 || body.density[*i as usize] <= 0.0));
    match sound {
        true => lumped,
        false => attempt(Lumping::Nearest),
    }
}

/// Length of a body along each axis.
pub(super) fn extents<const D: usize>(body: &LinearBody<D>) -> [f64; D] {
    std::array::from_fn(|a| {
        let x = body.position.iter().map(|x| x[a]);
        let wide = x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min);
        body.period[a].unwrap_or(wide)
    })
}

/// Smooth weights with `Σ w = 1`, `Σ w ξ = 0`, if points around allow.
fn centred<const D: usize>(
    near: &Near<D>,
    x: [f64; D],
    spacing: f64,
    widest: f64,
) -> Option<Vec<(u32, f64)>> {
    let n = D + 1;
    let mut radius = 1.5 * spacing;
    while radius < 1.5 * widest {
        let found = near.within(x, radius);
        let terms: Vec<(u32, f64, Vec<f64>)> = found
            .into_iter()
            .map(|(q, xi)| {
                let s = xi.map(|x| x / radius);
                let w = 1.0 - s.iter().map(|s| s * s).sum::<f64>();
                (q, w.max(0.0).powi(2), [&[1.0], s.as_slice()].concat())
            })
            .collect();
        let mut g = vec![0.0; n * n];
        for (_, w, s) in &terms {
            for a in 0..n {
                for b in 0..n {
                    g[a * n + b] += w * s[a] * s[b];
                }
            }
        }
        let mut one = vec![0.0; n];
        one[0] = 1.0;
        let factor = solve_semidefinite(g, &one);
        let shares: Vec<(u32, f64)> = terms
            .iter()
            .map(|(q, w, s)| {
                (
                    *q,
                    w * s.iter().zip(&factor).map(|(s, f)| s * f).sum::<f64>(),
                )
            })
            .collect();
        let moment = |a: usize| {
            let sum: f64 = shares.iter().zip(&terms).map(|(s, t)| s.1 * t.2[a]).sum();
            (sum - one[a]).abs()
        };
        if (0..n).all(|a| moment(a) < 1e-12) {
            return Some(shares);
        }
        radius *= 1.5;
    }
    None
}

/// Equal shares of the nearest points.
fn nearest<const D: usize>(
    near: &Near<D>,
    x: [f64; D],
    spacing: f64,
    widest: f64,
) -> Vec<(u32, f64)> {
    let mut radius = spacing;
    loop {
        let mut found: Vec<(u32, f64)> = (near.within(x, radius).into_iter())
            .map(|(q, xi)| (q, xi.iter().map(|x| x * x).sum()))
            .collect();
        let least = found.iter().fold(f64::INFINITY, |m, f| m.min(f.1));
        if !found.is_empty() || radius > widest {
            found.retain(|f| f.1 <= least * (1.0 + 1e-8));
            let share = 1.0 / found.len() as f64;
            return found.into_iter().map(|f| (f.0, share)).collect();
        }
        radius *= 2.0;
    }
}
