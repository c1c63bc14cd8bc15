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
        // the law stands once in what is compiled: all slopes of a bond in one loop, by η and then by numbers of the point
        let moved = if pass > 0 { D + points } else { D };
        for b in bonds {
            let mut own = vec![[0.0; D]; sums];
            for n in 0..moved {
                let slopes = share(b, Some(n).filter(|n| *n < D), n.checked_sub(D));
                for s in 0..sums {
                    let slope = slopes.get(s).slope;
                    match n.checked_sub(D) {
                        None => own[s][n] = b.weight * b.per_length * slope,
                        Some(n) => through[s][n] += b.weight * slope,
                    }
                    if n == 0 {
                        sum[s] += b.weight * slopes.get(s).value;
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
        let all = |n: usize| {
            let after = settle(Some(n).filter(|n| *n < sums), n.checked_sub(sums));
            let slopes: Vec<f64> = after.iter().map(|x| x.slope).collect();
            let values: Vec<f64> = after.iter().map(|x| x.value).collect();
            (slopes, values)
        };
        // and the point itself, last
        let mut by_sum: Vec<_> = (0..=sums + points).map(all).collect();
        let (_, point) = by_sum.pop().unwrap_or_default();
        let mut by_sum: Vec<_> = by_sum.into_iter().map(|(slopes, _)| slopes).collect();
        let by_point = by_sum.split_off(sums);
        PassSlopes {
            shares,
            through,
            by_sum,
            by_point,
            point,
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
            let seen = if own { bond } else { mirrored(&bond) };
            let force = self.0.answer(&seen, &end).alone(&seen);
            if own {
                force
            } else {
                force.map(|x| still(0.0) - x)
            }
        };
        let points = <M::Point<f64> as Numbers<f64>>::COUNT;
        let (mut by_eta, mut by_point, mut force) = ([[0.0; D]; D], vec![], [0.0; D]);
        // by η, by numbers of the point, and the force itself
        for n in 0..=D + points {
            let pulled = pull(Some(n).filter(|n| *n < D), n.checked_sub(D));
            match n.checked_sub(D) {
                None => {
                    for r in 0..D {
                        by_eta[r][n] = pulled[r].slope;
                    }
                }
                Some(n) if n < points => by_point.push(pulled.map(|x| x.slope)),
                Some(_) => force = pulled.map(|x| x.value),
            }
        }
        AnswerSlopes {
            by_eta,
            by_point,
            force,
        }
    }
}
