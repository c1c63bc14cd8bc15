//! A crystal, its levels, and what they do under load.

use std::collections::HashMap;

use peridyne_theory::coarsen::Options;

use crate::Failure;
use crate::silling2010::compare::{Levels, Pulled};
use crate::silling2010::crystal::Crystal;

const STRAIN: f64 = 1e-3;

/// A crystal under its loads.
pub struct Case<const D: usize> {
    pub crystal: Crystal<D>,
    pub levels: Levels<D>,
    /// Pulled at its ends, and under two opposite forces with its ends held.
    pub pulled: Pulled<D>,
    pub pinched: Pulled<D>,
    /// Force over elongation, per level.
    pub stiffness: Vec<f64>,
}

impl<const D: usize> Case<D> {
    /// Coarsened so many times, to twice the spacing each time.
    pub fn of(crystal: Crystal<D>, times: usize, options: &Options) -> Result<Self, Failure> {
        let levels = Levels::made(crystal.body.clone(), times, options, |_, atoms| {
            crystal.half(atoms)
        })?;
        let last = &levels.point[times];
        let end = |k: usize| -> Vec<usize> {
            let atoms = crystal.ends[k].iter().map(|i| *i as usize);
            atoms.filter(|i| last.binary_search(i).is_ok()).collect()
        };
        let ends = [end(0), end(1)];
        let long = crystal.sites.iter().fold(0.0f64, |m, x| m.max(x[0]));
        let place = |u: f64, k: &usize| {
            let mut x = [0.0; D];
            x[0] = u;
            (*k, x)
        };
        let held = |u: f64| -> Vec<(usize, [f64; D])> {
            let left = ends[0].iter().map(|k| place(0.0, k));
            left.chain(ends[1].iter().map(|k| place(u, k))).collect()
        };
        let elongation = STRAIN * long;
        let pulled = levels.solved(&held(elongation), &[])?;
        let stiffness = (0..=times)
            .map(|m| levels.reaction(&pulled, m, &ends[1]) / elongation)
            .collect();
        let pair = nearest_pair(&crystal, last, &ends)?;
        let forces = [place(1.0, &pair[0]), place(-1.0, &pair[1])];
        let pinched = levels.solved(&held(0.0), &forces)?;
        Ok(Case {
            crystal,
            levels,
            pulled,
            pinched,
            stiffness,
        })
    }

    /// Displacements of a level by site.
    fn by_site(&self, m: usize) -> HashMap<[i64; D], [f64; D]> {
        let point = &self.levels.point[m];
        let site = point.iter().zip(&self.pulled.u[m]);
        site.map(|(k, u)| (self.crystal.key(*k), *u)).collect()
    }

    /// What a hole adds to the displacements of the points of a level, in that level and in the finest: `[place, level, finest]`.
    pub fn added(&self, without: &Case<D>, m: usize) -> Vec<[[f64; D]; 3]> {
        let (coarse, fine) = (without.by_site(m), without.by_site(0));
        let minus = |a: [f64; D], b: &[f64; D]| std::array::from_fn(|c| a[c] - b[c]);
        let points = self.levels.point[m].iter().zip(&self.pulled.u[m]);
        points
            .filter_map(|(k, u)| {
                let key = self.crystal.key(*k);
                let here = minus(*u, coarse.get(&key)?);
                let finest = minus(self.pulled.u[0][*k], fine.get(&key)?);
                Some([self.crystal.sites[*k], here, finest])
            })
            .collect()
    }
}

/// The two free retained atoms that are nearest to the middle.
fn nearest_pair<const D: usize>(
    crystal: &Crystal<D>,
    retained: &[usize],
    ends: &[Vec<usize>; 2],
) -> Result<[usize; 2], Failure> {
    let middle: [f64; D] =
        std::array::from_fn(|a| 0.5 * crystal.sites.iter().fold(0.0f64, |m, x| m.max(x[a])));
    let off = |k: &usize| -> f64 {
        let x = &crystal.sites[*k];
        (0..D).map(|a| (x[a] - middle[a]).powi(2)).sum()
    };
    let mut free: Vec<usize> = (retained.iter().copied())
        .filter(|k| !ends.iter().any(|e| e.contains(k)))
        .collect();
    free.sort_by(|a, b| off(a).total_cmp(&off(b)));
    match free[..] {
        [a, b, ..] => Ok([a, b]),
        _ => Err(Failure::new("the last level has fewer than two free atoms")),
    }
}

/// Of `[place, a, b]` the root of `Σ |a − b|² / Σ |b|²`.
pub fn relative<const D: usize>(pairs: &[[[f64; D]; 3]]) -> f64 {
    let square = |x: f64| x * x;
    let off = pairs.iter().flat_map(|[_, a, b]| a.iter().zip(b));
    let size = pairs.iter().flat_map(|[_, _, b]| b);
    let off: f64 = off.map(|(a, b)| square(a - b)).sum();
    (off / size.map(|b| square(*b)).sum::<f64>()).sqrt()
}
