//! A field between points: the polynomial of third degree that fits those around best.

use std::collections::HashMap;

/// Points within so many spacings are fitted: at a corner of a square lattice 15, for 10 coefficients.
const REACH: f64 = 3.2;
/// Highest power of a fit where there are points enough, and of one in a thin body.
const DEGREES: [usize; 3] = [3, 2, 1];

/// Points by cells of edge `REACH` spacings.
pub struct Around<'a> {
    points: &'a [[f64; 3]],
    spacing: f64,
    cells: HashMap<[i64; 3], Vec<u32>>,
    /// Axes along which points differ.
    axes: Vec<usize>,
}

impl<'a> Around<'a> {
    pub fn new(points: &'a [[f64; 3]], spacing: f64) -> Self {
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for (i, x) in points.iter().enumerate() {
            let cell = x.map(|c| (c / (REACH * spacing)).floor() as i64);
            cells.entry(cell).or_default().push(i as u32);
        }
        let differ = |a: &usize| points.iter().any(|x| x[*a] != points[0][*a]);
        Around {
            points,
            spacing,
            cells,
            axes: (0..3).filter(differ).collect(),
        }
    }

    /// Value at a place; `None`: too few points are near.
    ///
    /// Least squares over the points within `REACH` spacings, of all monomials up to a degree in the distance from the place.
    pub fn fitted(&self, at: &[f64; 3], values: &[[f64; 3]]) -> Option<[f64; 3]> {
        let centre = at.map(|c| (c / (REACH * self.spacing)).floor() as i64);
        let mut near: Vec<(u32, [f64; 3])> = vec![];
        for n in 0..27 {
            let shift = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
            let cell = std::array::from_fn(|a| centre[a] + shift[a]);
            for i in self.cells.get(&cell).into_iter().flatten() {
                let x = self.points[*i as usize];
                let from: [f64; 3] = std::array::from_fn(|a| (x[a] - at[a]) / self.spacing);
                if from.iter().map(|c| c * c).sum::<f64>() <= REACH * REACH {
                    near.push((*i, from));
                }
            }
        }
        DEGREES
            .iter()
            .find_map(|degree| self.fit(&near, *degree, values))
    }

    fn fit(
        &self,
        near: &[(u32, [f64; 3])],
        degree: usize,
        values: &[[f64; 3]],
    ) -> Option<[f64; 3]> {
        let powers = self.powers(degree);
        let n = powers.len();
        if near.len() < n {
            return None;
        }
        // normal equations, of which the constant is wanted
        let mut rows = vec![vec![0.0; n + 3]; n];
        for (i, x) in near {
            let term = |p: &[usize; 3]| -> f64 { (0..3).map(|a| x[a].powi(p[a] as i32)).product() };
            let terms: Vec<f64> = powers.iter().map(term).collect();
            for (row, t) in rows.iter_mut().zip(&terms) {
                row.iter_mut().zip(&terms).for_each(|(r, s)| *r += t * s);
                (0..3).for_each(|c| row[n + c] += t * values[*i as usize][c]);
            }
        }
        solved(rows, n)
    }

    /// Exponents of the monomials, the constant first.
    fn powers(&self, degree: usize) -> Vec<[usize; 3]> {
        let most = |a: usize| if self.axes.contains(&a) { degree } else { 0 };
        let mut all = vec![];
        for i in 0..=most(0) {
            for j in 0..=most(1) {
                for k in 0..=most(2) {
                    if i + j + k <= degree {
                        all.push([i, j, k]);
                    }
                }
            }
        }
        all.sort_by_key(|p| p.iter().sum::<usize>());
        all
    }
}

/// The first unknown of n equations with three right sides, by Gauss's elimination with pivots; `None`: they do not determine it.
fn solved(mut rows: Vec<Vec<f64>>, n: usize) -> Option<[f64; 3]> {
    let size = (0..n).map(|i| rows[i][i].abs()).fold(0.0, f64::max);
    // the first unknown is eliminated last
    for c in (0..n).rev() {
        let pivot = (0..=c).max_by(|a, b| rows[*a][c].abs().total_cmp(&rows[*b][c].abs()))?;
        if rows[pivot][c].abs() <= 1e-10 * size {
            return None;
        }
        rows.swap(c, pivot);
        let (above, own) = rows.split_at_mut(c);
        for row in above {
            let part = row[c] / own[0][c];
            row.iter_mut()
                .zip(&own[0])
                .for_each(|(r, o)| *r -= part * o);
        }
    }
    Some(std::array::from_fn(|k| rows[0][n + k] / rows[0][0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_found_in_the_middle_and_at_a_corner() {
        let points: Vec<[f64; 3]> = (0..144)
            .map(|n| [0.1 * f64::from(n % 12), 0.1 * f64::from(n / 12), 0.0])
            .collect();
        let field = |x: &[f64; 3]| {
            let (x, y) = (x[0], x[1]);
            [1.0 + x * x * y - y.powi(3), x - 2.0 * y, 3.0 * x * y * y]
        };
        let values: Vec<[f64; 3]> = points.iter().map(field).collect();
        let around = Around::new(&points, 0.1);
        for at in [[0.55, 0.45, 0.0], [0.05, 0.05, 0.0], [1.05, 0.3, 0.0]] {
            let (found, wanted) = (around.fitted(&at, &values).unwrap(), field(&at));
            for a in 0..3 {
                assert!(
                    (found[a] - wanted[a]).abs() < 1e-9,
                    "{at:?} {found:?} {wanted:?}"
                );
            }
        }
        assert_eq!(around.fitted(&[9.0, 9.0, 0.0], &values), None);
    }
}
