//! A law in plain numbers: one point, or one bond. Knows no family of bonds.

use crate::interaction::Gradient;
use crate::interaction::along;
use crate::interaction::bonds::law::PointLaw;
use crate::interaction::bonds::points::PlainPoint;
use crate::interaction::bonds::state::WholeBond;
use crate::law::material::{Around, Bond, End, Material, Numbers, ReferenceFamily, Site};
use crate::space::Point;

/// What is asked of a law one point or one bond at a time, by numbers in its order.
pub trait PlainLaw<const D: usize>: PointLaw<D> {
    /// `[materials][numbers]` for a step of this length.
    fn constants(&self, materials: usize, dt: f64, all: &mut Vec<f64>);

    /// Strain energy density, `Σ ω ν V |ξ|² s` and `Σ ω ν V |ξ|²` of a point under a homogeneous displacement gradient, by its whole bonds with what they
    /// remember, and the constants of their other ends.
    fn strained(
        &self,
        at: &PlainPoint,
        bonds: &[(WholeBond<D>, [Vec<f64>; 2])],
        gradient: &Gradient<D>,
    ) -> [f64; 3];

    /// Stress across a body in plane strain, of a point that has settled and has all of its force state.
    fn across(&self, at: &PlainPoint, point: &[f64]) -> f64;
}

/// The sweeps of a law.
pub struct Compiled<M>(pub M);

impl<const D: usize, M: Material<D>> PointLaw<D> for Compiled<M> {
    fn form(&self, material: usize, reference: ReferenceFamily<D>, numbers: &mut [f64]) {
        let form = self.0.form(material, reference);
        for (n, x) in numbers.iter_mut().enumerate() {
            *x = form.get(n);
        }
    }

    fn stiffness(&self, material: usize, reference: ReferenceFamily<D>) -> f64 {
        self.0.stiffness(material, reference)
    }

    fn at_place(&self, material: usize, place: &Point) -> Vec<f64> {
        self.0.at_place(material, place)
    }
}

impl<const D: usize, M: Material<D>> PlainLaw<D> for Compiled<M> {
    fn constants(&self, materials: usize, dt: f64, all: &mut Vec<f64>) {
        all.clear();
        for m in 0..materials {
            let of = self.0.constants(m, dt);
            all.extend((0..<M::Constants<f64> as Numbers<f64>>::COUNT).map(|n| of.get(n)));
        }
    }

    fn strained(
        &self,
        at: &PlainPoint,
        bonds: &[(WholeBond<D>, [Vec<f64>; 2])],
        gradient: &Gradient<D>,
    ) -> [f64; 3] {
        let constants: M::Constants<f64> = numbers(&at.constants);
        let site = Site {
            constants: &constants,
            form: &numbers(&at.form),
            past: &numbers(&at.past),
            around: around(at),
        };
        let bond = |xi: &[f64; D], omega: f64| Bond::new(*xi, along(gradient, xi), omega);
        let mut point = <M::Point<f64> as Numbers<f64>>::constant(0.0);
        let mut sum = <M::Sum<f64> as Numbers<f64>>::constant(0.0);
        for pass in 0..M::PASSES {
            sum = <M::Sum<f64> as Numbers<f64>>::constant(0.0);
            for ((_, xi, omega, weight), [memory, _]) in bonds {
                let memory = numbers(memory);
                let end = End {
                    constants: &constants,
                    point: &point,
                    memory: &memory,
                };
                sum = sum.plus(*weight, self.0.pair_pass(pass, &bond(xi, *omega), &end));
            }
            self.0.point_update(pass, &site, sum, &mut point);
        }
        let mut energy = self.0.point_energy(&site, sum, &point);
        let (mut share, mut whole) = (0.0, 0.0);
        for ((_, xi, omega, weight), [memory, others]) in bonds {
            let memory = numbers(memory);
            let end = End {
                constants: &self.0.between(constants, &numbers(others)),
                point: &point,
                memory: &memory,
            };
            let bond = bond(xi, *omega);
            energy += weight * self.0.energy(&bond, &end);
            let part = weight * omega * bond.length * bond.length;
            share += part * bond.stretch;
            whole += part;
        }
        [energy, share, whole]
    }

    fn across(&self, at: &PlainPoint, point: &[f64]) -> f64 {
        let site = Site {
            constants: &numbers(&at.constants),
            form: &numbers(&at.form),
            past: &numbers(&at.past),
            around: around(at),
        };
        self.0.across(&site, &numbers::<M::Point<f64>>(point))
    }
}

/// Numbers as a law has them.
fn numbers<A: Numbers<f64>>(all: &[f64]) -> A {
    let mut out = A::constant(0.0);
    for (n, x) in all.iter().enumerate() {
        out.set(n, *x);
    }
    out
}

fn around(at: &PlainPoint) -> Around<f64> {
    Around {
        section: at.section,
    }
}
