//! Terms of the potential energy of particles, one after the other: `U = Σ_t U_t`, each a function of the distances within a few
//! particles. With `ξ_ab = d_ab²/2` its generalized forces are `G_ab = ∂U_t/∂ξ_ab`, one per unordered pair, and the force on a is
//! `−Σ_b (x_a − x_b) G_ab` (lehoucq2010 (4.0.38) to (4.0.40)). What measures fields from particles reads potentials so; sweeps of
//! molecular dynamics have kernels of their own.

use super::number::Dual;
use super::potential::Potential;
use super::potential::mixture::Mixture;

/// A particle near a centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    pub kind: u32,
    /// From the centre to it (length).
    pub y: [f64; 3],
}

impl Near {
    /// Squared distance.
    pub fn square(&self) -> f64 {
        self.y.iter().map(|c| c * c).sum()
    }
}

/// A term of a centre. Particle 0 is the centre, n + 1 the n-th of those that are near.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Term {
    /// Which part of the potential it belongs to: its place in [`Sites::parts`].
    pub part: usize,
    /// `U_t` (energy).
    pub energy: f64,
    /// All particles that it depends on, the centre first.
    pub particles: Vec<u32>,
    /// a, b and `G_ab` (energy / length²), every pair once, a < b.
    pub pulls: Vec<(u32, u32, f64)>,
}

impl Term {
    /// Empty it for another term of a part.
    pub fn begin(&mut self, part: usize) {
        self.part = part;
        self.energy = 0.0;
        self.particles.clear();
        self.particles.push(0);
        self.pulls.clear();
    }
}

/// A potential as terms that belong to sites: the energy is the sum over all centres of that of their terms, and a pair's energy is
/// in halves at its two ends.
pub trait Sites: Send + Sync {
    /// Distance from a centre beyond which nothing counts (length).
    fn reach(&self) -> f64;

    /// Names of the parts that terms are told apart by.
    fn parts(&self) -> Vec<String>;

    /// All terms of a centre. Those that are near may be farther away than the reach, and in any order.
    fn terms(&self, kind: u32, near: &[Near], visit: &mut dyn FnMut(&Term));
}

/// A potential of one kind of atom: `F(ρ_i) + ½ Σ φ`, the pairs as terms of their own. [`Mixture`]s have the same of their kinds.
#[derive(Debug, Clone)]
pub struct OfSites<P>(pub P);

impl<P: Potential> Sites for OfSites<P> {
    fn reach(&self) -> f64 {
        self.0.cutoff()
    }

    fn parts(&self) -> Vec<String> {
        parts::<P>()
    }

    fn terms(&self, _: u32, near: &[Near], visit: &mut dyn FnMut(&Term)) {
        let own = Some(&self.0);
        terms(own, |_| own, near, visit);
    }
}

impl<P: Potential> Sites for Mixture<P> {
    fn reach(&self) -> f64 {
        Mixture::reach(self)
    }

    fn parts(&self) -> Vec<String> {
        parts::<P>()
    }

    fn terms(&self, kind: u32, near: &[Near], visit: &mut dyn FnMut(&Term)) {
        // one potential for all does not tell them apart
        let place = |kind: u32| match self.kinds() {
            1 => 0,
            _ => kind as usize,
        };
        let kind = place(kind);
        terms(
            self.own(kind),
            |other| self.of(kind, place(other)),
            near,
            visit,
        );
    }
}

fn parts<P: Potential>() -> Vec<String> {
    let pair = "pair".to_string();
    match P::EMBEDDED {
        true => vec![pair, "embedding".into()],
        false => vec![pair],
    }
}

/// Terms of a centre with its `own` potential, and that `of` those that are near by their kinds.
fn terms<'a, P: Potential>(
    own: Option<&P>,
    of: impl Fn(u32) -> Option<&'a P>,
    near: &[Near],
    visit: &mut dyn FnMut(&Term),
) {
    let mut term = Term::default();
    let mut embedding = Term::default();
    embedding.begin(1);
    let mut density = 0.0;
    for (n, near) in near.iter().enumerate() {
        let q = near.square();
        let Some(potential) = of(near.kind).filter(|p| q < p.cutoff() * p.cutoff()) else {
            continue;
        };
        let end = n as u32 + 1;
        let [pair, f] = potential.both(Dual::variable(q));
        term.begin(0);
        term.energy = 0.5 * pair.value;
        term.particles.push(end);
        // q = 2ξ
        term.pulls.push((0, end, pair.slope));
        visit(&term);
        if P::EMBEDDED {
            // pairs may reach farther than densities
            if f.value == 0.0 && f.slope == 0.0 {
                continue;
            }
            density += f.value;
            embedding.particles.push(end);
            embedding.pulls.push((0, end, 2.0 * f.slope));
        }
    }
    if P::EMBEDDED
        && let Some(own) = own
    {
        let f = own.embedding(Dual::variable(density));
        embedding.energy = f.value;
        for (_, _, g) in &mut embedding.pulls {
            *g *= f.slope;
        }
        visit(&embedding);
    }
}

/// A sum of potentials: parts and terms of one after those of the other.
pub struct SumOfSites(pub Vec<Box<dyn Sites>>);

impl Sites for SumOfSites {
    fn reach(&self) -> f64 {
        self.0.iter().map(|s| s.reach()).fold(0.0, f64::max)
    }

    fn parts(&self) -> Vec<String> {
        self.0.iter().flat_map(|s| s.parts()).collect()
    }

    fn terms(&self, kind: u32, near: &[Near], visit: &mut dyn FnMut(&Term)) {
        let mut first = 0;
        let mut moved = Term::default();
        for sites in &self.0 {
            sites.terms(kind, near, &mut |term| {
                moved.clone_from(term);
                moved.part += first;
                visit(&moved);
            });
            first += sites.parts().len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::number::Number;
    use crate::law::potential::lennard_jones::LennardJones;

    /// `φ = q⁻¹`, `f = e^−q`, `F = −√ρ` (Finnis & Sinclair's).
    #[derive(Clone)]
    struct SquareRoot;

    impl Potential for SquareRoot {
        const EMBEDDED: bool = true;
        fn pair<N: Number>(&self, q: N) -> N {
            q.recip()
        }
        fn density<N: Number>(&self, q: N) -> N {
            q.times(-1.0).exp()
        }
        fn embedding<N: Number>(&self, density: N) -> N {
            density.sqrt().times(-1.0)
        }
    }

    /// The energy of the terms, and that it falls along the forces that their pulls say.
    fn check<P: Potential>(potential: P, near: &[Near]) {
        let sites = OfSites(potential);
        let energy = |near: &[Near]| {
            let mut sum = 0.0;
            sites.terms(0, near, &mut |t| sum += t.energy);
            sum
        };
        let mut force = vec![[0.0; 3]; near.len()];
        sites.terms(0, near, &mut |t| {
            for &(a, b, g) in &t.pulls {
                assert_eq!(a, 0, "pairs and densities are stars");
                let n = b as usize - 1;
                for c in 0..3 {
                    force[n][c] -= g * near[n].y[c];
                }
            }
        });
        for n in 0..near.len() {
            for c in 0..3 {
                let at = |step: f64| {
                    let mut moved = near.to_vec();
                    moved[n].y[c] += step;
                    energy(&moved)
                };
                let slope = (8.0 * (at(1e-4) - at(-1e-4)) - (at(2e-4) - at(-2e-4))) / 12e-4;
                assert!(
                    (slope + force[n][c]).abs() < 1e-9 * (1.0 + slope.abs()),
                    "{n} {c}: {slope} {}",
                    force[n][c]
                );
            }
        }
    }

    #[test]
    fn pulls_are_slopes_of_terms() {
        let at = |y: [f64; 3]| Near { kind: 0, y };
        let near = [
            at([1.0, 0.1, -0.2]),
            at([-0.3, 1.1, 0.2]),
            at([0.1, -0.4, -1.2]),
        ];
        let lj = LennardJones {
            epsilon: 0.7,
            sigma: 1.1,
        };
        check(lj, &near);
        check(SquareRoot, &near);
    }
}
