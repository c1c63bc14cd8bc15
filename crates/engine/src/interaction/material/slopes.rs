//! Slopes of a law's functions by dual numbers, of one point or one bond.

use super::plain::Compiled;
use super::view::mirrored;
use crate::interaction::bonds::points::PlainPoint;
use crate::law::material::{Around, Bond, End, ForceState, Material, Numbers, Site};
use crate::law::number::Dual;

type Real = Dual<f64>;

fn still(x: f64) -> Real {
    Dual {
        value: x,
        slope: 0.0,
    }
}

/// Numbers without slopes, but that `moved` has 1.
fn lifted<A: Numbers<Real>>(all: &[f64], moved: Option<usize>) -> A {
    let mut out = A::constant(0.0);
    for (n, x) in all.iter().enumerate() {
        let slope = if moved == Some(n) { 1.0 } else { 0.0 };
        out.set(n, Dual { value: *x, slope });
    }
    out
}

/// A bond about η; `moved`: the axis along which η grows.
fn bent<const D: usize>(
    xi: &[f64; D],
    eta: &[f64; D],
    [omega, back]: [f64; 2],
    moved: Option<usize>,
) -> Bond<Real, D> {
    let mut change = eta.map(still);
    if let Some(a) = moved {
        change[a].slope = 1.0;
    }
    let mut bond = Bond::new(xi.map(still), change, still(omega));
    bond.omega_back = still(back);
    bond
}

/// A bond about displacements, from one of its points.
pub struct Bent<const D: usize> {
    /// Place among the group's bonds, and slot of the other end (an image, maybe).
    pub k: usize,
    pub end: usize,
    pub xi: [f64; D],
    /// As the law sees it, and without the strain by temperature or swelling.
    pub eta: [f64; D],
    pub moved: [f64; D],
    /// `1/(1 + ε)` of that strain.
    pub per_length: f64,
    /// Of both ends.
    pub omega: [f64; 2],
    pub weight: f64,
    pub memory: Vec<f64>,
}

/// Slopes of a pass of one point.
pub struct PassSlopes<const D: usize> {
    /// What bonds give to their point, by η: `[bonds][sums][D]`
    pub shares: Vec<Vec<[f64; D]>>,
    /// What the sum gains from the point: `[sums][points]`
    pub through: Vec<Vec<f64>>,
    /// Numbers of the point after the pass by those of the sum, and of the point before: `[sums, points][points]`
    pub by_sum: Vec<Vec<f64>>,
    pub by_point: Vec<Vec<f64>>,
    /// The point after the pass.
    pub point: Vec<f64>,
}

/// An end of a bond.
#[derive(Clone, Copy)]
pub struct PlainEnd<'a> {
    pub constants: &'a [f64],
    /// Those of the other end.
    pub others: &'a [f64],
    pub point: &'a [f64],
    pub memory: &'a [f64],
}

/// Slopes of what an end answers to a bond.
pub struct AnswerSlopes<const D: usize> {
    /// By η (rows are components of the force).
    pub by_eta: [[f64; D]; D],
    /// `[points][D]`
    pub by_point: Vec<[f64; D]>,
    pub force: [f64; D],
}

/// What tangents ask of a law.
pub trait LawSlopes<const D: usize>: Send + Sync {
    /// One pass about a point: `point` as the pass before left it.
    fn pass_slopes(
        &self,
        at: &PlainPoint,
        pass: usize,
        point: &[f64],
        bonds: &[Bent<D>],
    ) -> PassSlopes<D>;

    /// What an end answers to a bond, the `own` one or the other, as the force on the own one.
    fn answer_slopes(&self, b: &Bent<D>, end: PlainEnd, own: bool) -> AnswerSlopes<D>;
}

impl<const D: usize, M: Material<D>> LawSlopes<D> for Compiled<M> {
    fn pass_slopes(
        &self,
        at: &PlainPoint,
        pass: usize,
        point: &[f64],
        bonds: &[Bent<D>],
    ) -> PassSlopes<D> {
        let points = <M::Point<f64> as Numbers<f64>>::COUNT;
        let sums = <M::Sum<f64> as Numbers<f64>>::COUNT;
        let constants: M::Constants<Real> = lifted(&at.constants, None);
        let share = |b: &Bent<D>, axis: Option<usize>, number: Option<usize>| {
            let bond = bent(&b.xi, &b.eta, b.omega, axis);
            let point: M::Point<Real> = lifted(point, number);
            let memory: M::Memory<Real> = lifted(&b.memory, None);
            let end = End {
                constants: &constants,
                point: &point,
                memory: &memory,
            };
            self.0.share(pass, &bond, &end)
        };
        let mut sum = vec![0.0; sums];
        let mut through = vec![vec![0.0; points]; sums];
        let mut shares = vec![];
        for b in bonds {
            let mut own = vec![[0.0; D]; sums];
            for a in 0..D {
                let slopes = share(b, Some(a), None);
                for (s, own) in own.iter_mut().enumerate() {
                    own[a] = b.weight * b.per_length * slopes.get(s).slope;
                    if a == 0 {
                        sum[s] += b.weight * slopes.get(s).value;
                    }
                }
            }
            if pass > 0 {
                for n in 0..points {
                    let slopes = share(b, None, Some(n));
                    for (s, through) in through.iter_mut().enumerate() {
                        through[n] += b.weight * slopes.get(s).slope;
                    }
                }
            }
            shares.push(own);
        }
        let form: M::Form<Real> = lifted(&at.form, None);
        let past: M::Past<Real> = lifted(&at.past, None);
        let settle = |by_sum: Option<usize>, by_point: Option<usize>| -> Vec<Real> {
            let site = Site {
                constants: &constants,
                form: &form,
                past: &past,
                around: Around {
                    section: still(at.section),
                },
            };
            let mut point: M::Point<Real> = lifted(point, by_point);
            self.0.settle(pass, &site, lifted(&sum, by_sum), &mut point);
            (0..points).map(|n| point.get(n)).collect()
        };
        let slopes = |all: Vec<Real>| all.into_iter().map(|x| x.slope).collect::<Vec<f64>>();
        PassSlopes {
            shares,
            through,
            by_sum: (0..sums).map(|s| slopes(settle(Some(s), None))).collect(),
            by_point: (0..points).map(|n| slopes(settle(None, Some(n)))).collect(),
            point: settle(None, None).into_iter().map(|x| x.value).collect(),
        }
    }

    fn answer_slopes(&self, b: &Bent<D>, end: PlainEnd, own: bool) -> AnswerSlopes<D> {
        let others: M::Constants<Real> = lifted(end.others, None);
        let constants = self.0.between(lifted(end.constants, None), &others);
        let memory: M::Memory<Real> = lifted(end.memory, None);
        let pull = |axis: Option<usize>, number: Option<usize>| -> [Real; D] {
            let bond = bent(&b.xi, &b.eta, b.omega, axis);
            let point: M::Point<Real> = lifted(end.point, number);
            let end = End {
                constants: &constants,
                point: &point,
                memory: &memory,
            };
            if own {
                let state = self.0.answer(&bond, &end);
                state.alone(&bond)
            } else {
                let state = self.0.answer(&mirrored(&bond), &end);
                state.alone(&mirrored(&bond)).map(|x| still(0.0) - x)
            }
        };
        let mut by_eta = [[0.0; D]; D];
        for c in 0..D {
            let slopes = pull(Some(c), None);
            for r in 0..D {
                by_eta[r][c] = slopes[r].slope;
            }
        }
        let points = 0..<M::Point<f64> as Numbers<f64>>::COUNT;
        AnswerSlopes {
            by_eta,
            by_point: points
                .map(|n| pull(None, Some(n)).map(|x| x.slope))
                .collect(),
            force: pull(None, None).map(|x| x.value),
        }
    }
}
