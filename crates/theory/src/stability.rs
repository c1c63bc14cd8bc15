//! The largest stable time step of velocity Verlet: bounds, and the sharp limit `2/ω_max`.

use crate::crystal::Crystal;
use crate::dispersion::zone;
use crate::exact::zeta;
use crate::gradient::linear::LinearChain;
use std::f64::consts::PI;

/// A largest frequency and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit<const D: usize> {
    /// ω² (1 / time²)
    pub squared: f64,
    /// Wave vector (1 / length).
    pub wave: [f64; D],
}

impl<const D: usize> Limit<D> {
    /// `2/ω_max`; ∞ if nothing oscillates.
    pub fn time_step(&self) -> f64 {
        if self.squared > 0.0 {
            2.0 / self.squared.sqrt()
        } else {
            f64::INFINITY
        }
    }
}

/// Bound (4.12) of seleson2009 with `K(N) = 2K₁/(N(N+1))`: `Δt < Δx √(ρ/(K(N) H_N)) = δ √(ρ/2K₁) √((1 + 1/N)/H_N)`.
pub fn springs_bound(k1: f64, density: f64, horizon: f64, neighbours: usize) -> f64 {
    let n = neighbours as f64;
    let harmonic: f64 = zeta(neighbours, 1);
    horizon * (density / (2.0 * k1)).sqrt() * ((1.0 + 1.0 / n) / harmonic).sqrt()
}

/// The same with `H_N ≈ ln N + γ` for many neighbours.
pub fn springs_bound_asymptotic(k1: f64, density: f64, horizon: f64, neighbours: usize) -> f64 {
    let harmonic = libm::log(neighbours as f64) + 0.577_215_664_901_532_9;
    horizon * (density / (2.0 * k1)).sqrt() / harmonic.sqrt()
}

impl LinearChain<f64> {
    /// (4.12) for any chain: every versine at its largest, `ω² ≤ (4 Σ K_j⁺ + 4 F″⁺ (Σ |f_j|)²)/m`. A step below it is stable
    /// if the chain is; the bound is sharp where all waves peak at one k.
    pub fn bound(&self, density: f64) -> f64 {
        let springs: f64 = self.stiffness.iter().map(|k| k.max(0.0)).sum();
        let share: f64 = self.share.iter().map(|f| f.abs()).sum();
        let squared =
            4.0 * (springs + self.curvature.max(0.0) * share * share) / (density * self.spacing);
        Limit {
            squared,
            wave: [0.0],
        }
        .time_step()
    }

    /// The largest ω² of all waves, to round-off: every local maximum on a fine grid, each by Newton's method.
    pub fn largest(&self, density: f64) -> Limit<1> {
        let reach = self.stiffness.len().max(2 * self.share.len()).max(1);
        let edge = PI / self.spacing;
        let n = 32 * reach;
        let step = edge / n as f64;
        // ω² is even about both ends of the half zone
        let value = |i: usize| self.at(i as f64 * step)[0];
        let mut best = Limit {
            squared: value(0),
            wave: [0.0],
        };
        for i in 1..=n {
            let here = value(i);
            let right = if i == n { here } else { value(i + 1) };
            if here < value(i - 1) || here < right {
                continue;
            }
            let k = self.climb(i as f64 * step, step).min(edge);
            let squared = self.at(k)[0].max(here);
            if squared > best.squared {
                best = Limit { squared, wave: [k] };
            }
        }
        best.squared /= density * self.spacing;
        best
    }

    /// The maximum within a step of k: Newton where the curve is concave, halving where it is not.
    fn climb(&self, start: f64, step: f64) -> f64 {
        let (mut low, mut high) = (start - step, start + step);
        let mut k = start;
        for _ in 0..80 {
            let [_, slope, curvature] = self.at(k);
            if slope > 0.0 {
                low = k;
            } else {
                high = k;
            }
            let newton = k - slope / curvature;
            let next = if curvature < 0.0 && newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - k).abs() <= 1e-15 * start.abs() {
                return next;
            }
            k = next;
        }
        k
    }
}

/// How many of the grid's best points are refined.
const CANDIDATES: usize = 12;

impl<const D: usize> Crystal<D> {
    /// The largest ω² of all waves: a grid of `per_axis` points along every reciprocal vector, its best points refined
    /// by a pattern search in k until steps are 1e-9 of the grid's.
    pub fn largest(&self, per_axis: usize) -> Limit<D> {
        let top = |k: [f64; D]| self.squares(k).last().copied().unwrap_or(0.0);
        let mut found: Vec<Limit<D>> = vec![];
        zone::grid(self, per_axis, |wave| {
            found.push(Limit {
                squared: top(wave),
                wave,
            });
        });
        found.sort_by(|a, b| b.squared.total_cmp(&a.squared));
        found.truncate(CANDIDATES);
        let b = self.reciprocal();
        let size = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let width = b.iter().map(size).fold(0.0, f64::max) / per_axis.max(1) as f64;
        found
            .into_iter()
            .map(|start| climb(start, width, top))
            .fold(None, |best: Option<Limit<D>>, next| match best {
                Some(best) if best.squared >= next.squared => Some(best),
                _ => Some(next),
            })
            .unwrap_or(Limit {
                squared: 0.0,
                wave: [0.0; D],
            })
    }

    /// A bound in the manner of (4.12): `ω² ≤ max_s (2/m_s) Σ_b |Φ_b| + max F″ (2 Σ|share|)²/m`, never below the sharp
    /// limit where all sites have one mass.
    pub fn bound(&self) -> f64 {
        let mut pair = vec![0.0; self.basis.len()];
        let mut share = vec![0.0; self.basis.len()];
        for b in &self.bonds {
            pair[b.from] += b.stiffness.abs().max(b.tension.abs());
            share[b.from] += b.share.abs();
        }
        for (span, spring) in self.couplings.iter().flat_map(|c| c.springs()) {
            span.sites.iter().for_each(|s| pair[*s] += spring);
        }
        let lightest = self.mass.iter().copied().fold(f64::INFINITY, f64::min);
        let pair = pair.iter().copied().fold(0.0, f64::max);
        let widest = share.iter().copied().fold(0.0, f64::max);
        let embedding = self.curvature.iter().copied().fold(0.0, f64::max) * widest * widest;
        // |Σ share n·(u_to − u_from)| of a wave, summed over sites
        let squared = (2.0 * pair + 4.0 * embedding) / lightest;
        Limit {
            squared,
            wave: [0.0; D],
        }
        .time_step()
    }
}

/// Steps along every axis and diagonal, halved when none leads up.
fn climb<const D: usize>(start: Limit<D>, width: f64, top: impl Fn([f64; D]) -> f64) -> Limit<D> {
    let mut best = start;
    let mut step = 0.5 * width;
    while step > 1e-9 * width {
        let mut moved = false;
        for code in 0..3usize.pow(D as u32) {
            let wave: [f64; D] = std::array::from_fn(|a| {
                best.wave[a] + step * ((code / 3usize.pow(a as u32) % 3) as f64 - 1.0)
            });
            let squared = top(wave);
            if squared > best.squared {
                best = Limit { squared, wave };
                moved = true;
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
    best
}

/// The observed limit: the border between steps that run and steps that do not, by bisection between a stable and an
/// unstable one until they are `tolerance` apart (relative); `None` if they are not what they should be.
pub fn observed(
    mut stable: impl FnMut(f64) -> bool,
    [mut low, mut high]: [f64; 2],
    tolerance: f64,
) -> Option<f64> {
    if !stable(low) || stable(high) {
        return None;
    }
    while high - low > tolerance * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_blows_up_beyond_the_sharp_limit() {
        // springs with two neighbours on a ring that holds the wave of the limit, 2π/3
        let chain = LinearChain::springs(3.0, 1.0, 2);
        let n = 12;
        let runs = |dt: f64| {
            let mut u: Vec<f64> = (0..n).map(|i| ((i * i) as f64).sin()).collect();
            let mut v = vec![0.0; n];
            for _ in 0..4000 {
                for i in 0..n {
                    let pull = |j: usize| u[(i + j) % n] + u[(i + n - j) % n] - 2.0 * u[i];
                    v[i] += dt * (chain.stiffness[0] * pull(1) + chain.stiffness[1] * pull(2));
                }
                for i in 0..n {
                    u[i] += dt * v[i];
                }
            }
            u.iter().all(|x| x.abs() < 1e6)
        };
        let limit = chain.largest(1.0).time_step();
        let found = observed(runs, [0.5 * limit, 2.0 * limit], 1e-4).unwrap();
        assert!((found / limit - 1.0).abs() < 2e-4, "{found} {limit}");
        assert_eq!(observed(|_| true, [1.0, 2.0], 1e-3), None);
    }
    use crate::crystal::LatticeSolid;
    use peridyne::law::solid::eam_like::Solid;
    use peridyne::space::lattice::LatticeKind;
    use peridyne::spec::Horizon;

    #[test]
    fn one_neighbour_is_the_courant_number() {
        // (4.12) is sharp for N = 1: Δt = Δx/c
        let chain = LinearChain::springs(4.0, 0.5, 1);
        let sharp = chain.largest(1.0);
        assert!((sharp.time_step() - 0.25).abs() < 1e-15);
        assert!((chain.bound(1.0) - 0.25).abs() < 1e-15);
        assert!((springs_bound(4.0, 1.0, 0.5, 1) - 0.25).abs() < 1e-15);
    }

    #[test]
    fn two_neighbours_in_closed_form() {
        // (1 − cos θ) + (1 − cos 2θ)/2 is largest at cos θ = −½: 9/4, against the bound's 3
        let chain = LinearChain::springs(3.0, 1.0, 2);
        let sharp = chain.largest(1.0);
        assert!((sharp.wave[0] - 2.0 * PI / 3.0).abs() < 1e-9);
        assert!((sharp.squared - 2.0 * 9.0 / 4.0).abs() < 1e-14);
        let ratio = sharp.time_step() / chain.bound(1.0);
        assert!((ratio - (4.0f64 / 3.0).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn the_bound_falls_behind_towards_the_root_of_two() {
        let mut last = 0.999;
        for n in [1, 2, 4, 16, 64, 256, 1024] {
            let chain = LinearChain::springs(1.0, 5.0 / n as f64, n);
            let bound = chain.bound(1.0);
            assert!((bound / springs_bound(1.0, 1.0, 5.0, n) - 1.0).abs() < 1e-13);
            let ratio = chain.largest(1.0).time_step() / bound;
            assert!(ratio > last && ratio < 2f64.sqrt(), "{n}: {ratio}");
            last = ratio;
        }
        assert!(last > 1.25, "{last}");
        let a = springs_bound_asymptotic(1.0, 1.0, 5.0, 1000);
        assert!((a / springs_bound(1.0, 1.0, 5.0, 1000) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn the_sharp_limit_is_global() {
        // brute force on a far finer grid
        let chain = LinearChain::structured_eam(1.0, 4.0, 1, 1.0, 9);
        let limit = chain.largest(1.0);
        let brute = (0..=400_000)
            .map(|i| chain.squared(PI * i as f64 / 400_000.0, 1.0))
            .fold(0.0, f64::max);
        assert!((limit.squared / brute - 1.0).abs() < 1e-9);
        assert!(limit.squared >= brute * (1.0 - 1e-15));
        assert!(chain.bound(1.0) <= limit.time_step());
    }

    #[test]
    fn in_higher_dimensions() {
        // square lattice, nearest neighbours: ω² = 4K/m at the edge of the zone
        let body = LatticeSolid::new(LatticeKind::Square, 1.0, Horizon::Ratio(1));
        let crystal = body.bond_based::<2>(3.0).unwrap();
        let limit = crystal.largest(5);
        assert!((limit.squared - 12.0).abs() < 1e-12);
        // one-dimensional crystals agree with chains
        let body = LatticeSolid::new(LatticeKind::Chain, 0.5, Horizon::Ratio(6));
        let crystal = body.state_based::<1>(Solid::lps(1, 3.0, 1.0)).unwrap();
        let chain = LinearChain::of_crystal(&crystal).unwrap();
        let (a, b) = (crystal.largest(24), chain.largest(1.0));
        assert!((a.squared / b.squared - 1.0).abs() < 1e-12);
        let body = LatticeSolid::new(LatticeKind::Cubic, 1.0, Horizon::Ratio(2));
        for solid in [Solid::lps(3, 1.0, 1.0), Solid::lps(3, 5.0, 1.0)] {
            let crystal = body.state_based::<3>(solid).unwrap();
            assert!(crystal.bound() <= crystal.largest(6).time_step());
        }
    }
}
