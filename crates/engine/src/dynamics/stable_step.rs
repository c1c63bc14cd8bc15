//! The largest stable step of velocity Verlet, `Δt = 2/√λ_max`, from the operator itself: Lanczos on `M⁻¹K`, whose
//! products are force sweeps at tiny displacements about the reference. No formula, so no units to get wrong.

use crate::body::{Body, Field, Layout, view, view_mut, zeros};
use crate::interaction::{Interaction, Sweep};
use crate::spec::LinearBody;
use std::cmp::Ordering;

/// Krylov steps; the top of a peridynamic spectrum is found to about a percent in these.
const STEPS: usize = 30;
/// The Ritz value comes from below; this covers what is missing.
const MARGIN: f64 = 1.02;

/// Largest eigenvalue of `M⁻¹K` (1 / time²) at the reference configuration; 0 if nothing resists.
pub fn largest_eigenvalue<const D: usize>(
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
) -> f64 {
    let mass: Vec<f64> = body
        .slots()
        .iter()
        .map(|&s| body.volume().at(s as usize) * body.density().at(s as usize))
        .collect();
    largest_ratio(body, interaction, &mass)
}

/// The same with a mass for every point, in order of ids.
pub fn largest_ratio<const D: usize>(
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
    mass: &[f64],
) -> f64 {
    let mut tiny = Tiny::new(body, interaction);
    let inner = |x: &[[f64; D]], y: &[[f64; D]]| -> f64 {
        let each = x.iter().zip(y).zip(mass);
        body.sum(each.map(|((x, y), m)| m * (0..D).map(|a| x[a] * y[a]).sum::<f64>()))
    };
    lanczos(body, &inner, &mut |w| tiny.pull(w, |i| mass[i]))
}

/// Masses that couple points, in order of ids: `x · M y`, and the accelerations `M⁻¹F`.
pub struct Coupled<'a, const D: usize> {
    pub dot: &'a dyn Fn(&[[f64; D]], &[[f64; D]]) -> f64,
    pub solve: &'a dyn Fn(&[[f64; D]]) -> Vec<[f64; D]>,
}

impl<const D: usize> Coupled<'_, D> {
    /// Largest eigenvalue of `M⁻¹K` (1 / time²) at the reference configuration.
    pub fn largest_eigenvalue(&self, body: &Body<D>, interaction: &mut dyn Interaction<D>) -> f64 {
        let mut tiny = Tiny::new(body, interaction);
        lanczos(body, self.dot, &mut |w| {
            (self.solve)(&tiny.pull(w, |_| 1.0))
        })
    }

    /// Largest eigenvalue of `M⁻¹L` (–), L the masses lumped.
    pub fn lightest(&self, body: &Body<D>) -> f64 {
        let mass = |i: usize| body.volume().at(i) * body.density().at(i);
        let lumped = body.by_id(mass);
        lanczos(body, self.dot, &mut |w| {
            let weighed = w.iter().zip(&lumped);
            let weighed: Vec<[f64; D]> = weighed.map(|(w, m)| w.map(|c| m * c)).collect();
            (self.solve)(&weighed)
        })
    }
}

/// `√(|L⁻¹K|_∞ |L⁻¹Kᵀ|_∞)` (1 / time²), L the masses lumped, of bonds that act directly, symmetric or not: with the largest eigenvalue of `M⁻¹L` a
/// bound on every one of `M⁻¹K`, as `|L^-½ K L^-½|` is no larger.
pub fn lumped_bound<const D: usize>(linear: &LinearBody<D>) -> f64 {
    let n = linear.points();
    let mut own = vec![[[0.0; D]; D]; n];
    let (mut across, mut down) = (vec![[0.0f64; D]; n], vec![[0.0f64; D]; n]);
    for i in 0..n {
        let (partners, blocks) = linear.row(i);
        for (&j, block) in partners.iter().zip(blocks) {
            for a in 0..D {
                for b in 0..D {
                    let c = linear.volume[i] * block[a][b];
                    own[i][a][b] += c;
                    across[i][a] += c.abs();
                    down[j as usize][b] += c.abs();
                }
            }
        }
    }
    let (mut rows, mut columns) = (0.0f64, 0.0f64);
    for (i, mass) in linear.masses().into_iter().enumerate() {
        for a in 0..D {
            let row: f64 = (0..D).map(|b| own[i][a][b].abs()).sum();
            let column: f64 = (0..D).map(|b| own[i][b][a].abs()).sum();
            rows = rows.max((row + across[i][a]) / mass);
            columns = columns.max((column + down[i][a]) / mass);
        }
    }
    (rows * columns).sqrt()
}

/// Largest eigenvalue of an operator that is symmetric in an inner product, as a Ritz value and a margin.
fn lanczos<const D: usize>(
    body: &Body<D>,
    inner: &dyn Fn(&[[f64; D]], &[[f64; D]]) -> f64,
    apply: &mut dyn FnMut(&[[f64; D]]) -> Vec<[f64; D]>,
) -> f64 {
    // every point in motion, no symmetry: a fixed low-discrepancy start
    let mut w = vec![[0.0; D]; body.points()];
    for (w, place) in w.iter_mut().zip(places(body)) {
        *w = crate::array::from_fn(|a| {
            ((place * D + a + 1) as f64 * 0.618_033_988_749_894_9).fract() - 0.5
        });
    }
    let norm = |w: &[[f64; D]]| inner(w, w).sqrt();
    let scale = norm(&w);
    w.iter_mut().flatten().for_each(|c| *c /= scale);
    let mut previous = vec![[0.0; D]; body.points()];
    let (mut alphas, mut betas): (Vec<f64>, Vec<f64>) = (vec![], vec![]);
    for _ in 0..STEPS.min(D * body.all_points()) {
        let mut next = apply(&w);
        let alpha = inner(&next, &w);
        let beta = betas.last().copied().unwrap_or(0.0);
        for ((n, w), p) in next.iter_mut().zip(&w).zip(&previous) {
            for a in 0..D {
                n[a] -= alpha * w[a] + beta * p[a];
            }
        }
        alphas.push(alpha);
        let b = norm(&next);
        if !(b > 1e-12 * alphas[0].abs()) {
            break;
        }
        betas.push(b);
        next.iter_mut().flatten().for_each(|c| *c /= b);
        previous = std::mem::replace(&mut w, next);
    }
    betas.truncate(alphas.len() - 1);
    MARGIN * largest_of_tridiagonal(&alphas, &betas).max(0.0)
}

/// The place of each point among all in an order that is the body's own: a cloud whose lines come in another order has the same step.
fn places<const D: usize>(body: &Body<D>) -> Vec<usize> {
    if matches!(body.layout(), Layout::Grid(_)) {
        return (0..body.points()).map(|id| body.id_of_all(id)).collect();
    }
    let own = body.slots().iter().enumerate().map(|(id, &s)| {
        let [x, y, z] = body.position(s as usize);
        [x, y, z, body.id_of_all(id) as f64]
    });
    let own: Vec<[f64; 4]> = own.collect();
    let compare = |p: &[f64; 4], q: &[f64; 4]| {
        let numbers = p.iter().zip(q);
        numbers.fold(Ordering::Equal, |o, (x, y)| o.then(x.total_cmp(y)))
    };
    let mut all = body.all_of(&own).concat();
    all.sort_unstable_by(compare);
    let place = |x: &[f64; 4]| all.partition_point(|y| compare(y, x).is_lt());
    own.iter().map(place).collect()
}

/// A bound on every eigenvalue of `M⁻¹K` (1 / time²) of bonds that act directly: the largest sum of magnitudes of a row
/// (Gershgorin). Lanczos finds the eigenvalues of symmetric operators only.
pub fn row_bound<const D: usize>(body: &Body<D>, interaction: &mut dyn Interaction<D>) -> f64 {
    let mut own = vec![[[0.0; D]; D]; body.len()];
    let mut sum = vec![[0.0f64; D]; body.len()];
    interaction.tangents(body, view(&body.at_rest()), &mut |bond| {
        for a in 0..D {
            for b in 0..D {
                own[bond.i][a][b] += bond.stiffness[a][b];
                sum[bond.i][a] += bond.stiffness[a][b].abs();
            }
        }
    });
    let mut bound = 0.0f64;
    for &s in body.slots() {
        let i = s as usize;
        for a in 0..D {
            let row = sum[i][a] + (0..D).map(|b| own[i][a][b].abs()).sum::<f64>();
            bound = bound.max(row / body.density().at(i));
        }
    }
    body.most(bound)
}

/// Sweeps at displacements so small that the law is linear.
struct Tiny<'a, const D: usize> {
    body: &'a Body<D>,
    interaction: &'a mut dyn Interaction<D>,
    u: Field<D>,
    f: Field<D>,
    /// What acts at rest: 0 for solids, not for atoms under pressure.
    rest: Field<D>,
}

impl<'a, const D: usize> Tiny<'a, D> {
    fn new(body: &'a Body<D>, interaction: &'a mut dyn Interaction<D>) -> Self {
        let u = body.at_rest();
        let mut rest = zeros::<D>(body.len());
        interaction.forces(body, view(&u), view_mut(&mut rest), Sweep::Hold, None);
        Tiny {
            f: zeros(body.len()),
            body,
            interaction,
            u,
            rest,
        }
    }

    /// `K w` over the mass of every point.
    fn pull(&mut self, w: &[[f64; D]], mass: impl Fn(usize) -> f64) -> Vec<[f64; D]> {
        let (body, u) = (self.body, &mut self.u);
        let peak = w.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        let peak = body.most(peak);
        let small = 1e-7 * body.spacing() / peak.max(f64::MIN_POSITIVE);
        body.set_vectors(u, |id, _| w[id].map(|c| small * c));
        self.interaction
            .forces(body, view(u), view_mut(&mut self.f), Sweep::Hold, None);
        let (f, rest) = (&self.f, &self.rest);
        let each = body.slots().iter().enumerate().map(|(i, &s)| {
            let s = s as usize;
            let scale = body.volume().at(s) / (small * mass(i));
            crate::array::from_fn(|a| (rest[a][s] - f[a][s]) * scale)
        });
        each.collect()
    }
}

/// Largest eigenvalue of a symmetric tridiagonal matrix, by bisection on Sturm counts.
fn largest_of_tridiagonal(diagonal: &[f64], off: &[f64]) -> f64 {
    let radius =
        |i: usize| off.get(i).map_or(0.0, |b| b.abs()) + if i > 0 { off[i - 1].abs() } else { 0.0 };
    let mut high = (0..diagonal.len())
        .map(|i| diagonal[i] + radius(i))
        .fold(f64::MIN, f64::max);
    let mut low = diagonal.iter().copied().fold(f64::MIN, f64::max);
    let below = |x: f64| {
        let mut d = 1.0;
        (0..diagonal.len())
            .filter(|&i| {
                let b = if i > 0 { off[i - 1] } else { 0.0 };
                d = diagonal[i] - x - if i > 0 { b * b / d } else { 0.0 };
                if d == 0.0 {
                    d = -f64::MIN_POSITIVE;
                }
                d < 0.0
            })
            .count()
    };
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if below(middle) == diagonal.len() {
            high = middle
        } else {
            low = middle
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tridiagonal_extreme_is_the_closed_form() {
        // 2 on the diagonal, −1 beside it: 2 + 2 cos(π/(n+1))
        let n = 17;
        let exact = 2.0 + 2.0 * (std::f64::consts::PI / (n as f64 + 1.0)).cos();
        let found = largest_of_tridiagonal(&vec![2.0; n], &vec![-1.0; n - 1]);
        assert!(
            (found - exact).abs() < 1e-14 * exact,
            "{found} is not {exact}"
        );
    }
}
