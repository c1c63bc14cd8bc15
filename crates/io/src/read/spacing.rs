//! Volumes against distances: points fill a body, so the volume of each is near the cube of the distance to the next.

use super::plane::is_same;

/// Points that are looked at, of each kind.
const LOOKED_AT: usize = 8;
/// Kinds of points.
const KINDS: usize = 16;

/// Distance from a point to the next one, to the power of how many coordinates change from place to place; over all points of a file that is
/// their volume, up to the thickness of a plane and some factor.
pub(crate) struct Spacing<'a> {
    position: &'a [[f64; 3]],
    axes: Vec<usize>,
}

impl<'a> Spacing<'a> {
    pub fn new(position: &'a [[f64; 3]]) -> Self {
        let axes = (0..3).filter(|a| !is_same(position.iter(), *a)).collect();
        Spacing { position, axes }
    }

    /// In how many coordinates points differ.
    pub fn dimension(&self) -> usize {
        self.axes.len()
    }

    fn volume(&self, point: usize) -> f64 {
        let own = &self.position[point];
        let square = |x: &[f64; 3]| (0..3).map(|a| (x[a] - own[a]).powi(2)).sum::<f64>();
        let all = self.position.iter().map(square).filter(|s| *s > 0.0);
        let next = all.fold(f64::INFINITY, f64::min);
        libm::pow(next, 0.5 * self.dimension() as f64)
    }

    /// The logarithm of how many times too large `volume` is for the distance to the next point: the middle one of some points of each kind,
    /// of which one is worst. Kinds are numbers of points, `None`: one kind.
    pub fn excess(&self, volume: &[f64], kind: Option<&[f64]>) -> f64 {
        let mut kinds: Vec<f64> = vec![];
        for k in kind.unwrap_or(&[]) {
            if !kinds.contains(k) && kinds.len() < KINDS {
                kinds.push(*k);
            }
        }
        let of = |k: Option<f64>| -> Vec<usize> {
            let all = 0..self.position.len();
            all.filter(|i| kind.is_none_or(|all| Some(all[*i]) == k))
                .collect()
        };
        let groups: Vec<Vec<usize>> = match kind {
            Some(_) => kinds.into_iter().map(|k| of(Some(k))).collect(),
            None => vec![of(None)],
        };
        let each = groups.iter().map(|points| {
            let step = points.len().div_ceil(LOOKED_AT).max(1);
            let some = points.iter().step_by(step);
            let mut logs: Vec<f64> = some
                .map(|i| libm::log(volume[*i] / self.volume(*i)))
                .collect();
            logs.sort_by(f64::total_cmp);
            logs.get(logs.len() / 2).copied().unwrap_or(0.0)
        });
        let worst = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        each.fold(0.0, worst)
    }
}
