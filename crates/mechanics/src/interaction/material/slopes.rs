//! Slopes of a law's functions by dual numbers, of one point or one bond.

use super::plain::Compiled;
use super::view::mirrored;
use crate::array;
use crate::execute::lane::{Lane, Piece};
use crate::interaction::bonds::points::PlainPoint;
use crate::law::material::{Around, Bond, End, ForceState, Material, Numbers, Site};
use crate::law::number::Dual;

type Real = Dual<f64>;

#[inline(always)]
fn still(x: f64) -> Real {
    Dual {
        value: x,
        slope: 0.0,
    }
}

/// Numbers without slopes, but that `moved` has 1.
#[inline(always)]
fn lifted<A: Numbers<Real>>(all: &[f64], moved: Option<usize>) -> A {
    let mut out = A::constant(0.0);
    for (n, x) in all.iter().enumerate() {
        let slope = if moved == Some(n) { 1.0 } else { 0.0 };
        out.set(n, Dual { value: *x, slope });
    }
    out
}

/// A bond about η; `moved`: the axis along which η grows.
#[inline(always)]
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

/// Slopes of the force state of an end.
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

    /// The force state of an end, the `own` one or the other, as the force on the own one.
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
        f64::out_of_line(Pass {
            law: &self.0,
            constants: lifted(&at.constants, None),
            form: lifted(&at.form, None),
            past: lifted(&at.past, None),
            at,
            pass,
            point,
            bonds,
        })
    }

    fn answer_slopes(&self, b: &Bent<D>, end: PlainEnd, own: bool) -> AnswerSlopes<D> {
        let others: M::Constants<Real> = lifted(end.others, None);
        f64::out_of_line(ForceStateAt {
            law: &self.0,
            constants: self.0.between(lifted(end.constants, None), &others),
            memory: lifted(end.memory, None),
            bond: b,
            point: end.point,
            own,
        })
    }
}

/// A pass of a point; methods, since what closures do is not inlined.
struct Pass<'a, const D: usize, M: Material<D>> {
    law: &'a M,
    constants: M::Constants<Real>,
    form: M::Form<Real>,
    past: M::Past<Real>,
    at: &'a PlainPoint,
    pass: usize,
    point: &'a [f64],
    bonds: &'a [Bent<D>],
}

impl<const D: usize, M: Material<D>> Pass<'_, D, M> {
    /// What a bond gives to the point, where η grows along an axis or a number of the point grows.
    #[inline(always)]
    fn pair_pass(&self, b: &Bent<D>, axis: Option<usize>, number: Option<usize>) -> M::Sum<Real> {
        let bond = bent(&b.xi, &b.eta, b.omega, axis);
        let end = End {
            constants: &self.constants,
            point: &lifted(self.point, number),
            memory: &lifted(&b.memory, None),
        };
        self.law.pair_pass(self.pass, &bond, &end)
    }

    /// The point after the pass, where a number of the sum or of the point before grows.
    #[inline(always)]
    fn point_update(
        &self,
        sum: &[f64],
        by_sum: Option<usize>,
        by_point: Option<usize>,
    ) -> M::Point<Real> {
        let site = Site {
            constants: &self.constants,
            form: &self.form,
            past: &self.past,
            around: Around {
                section: still(self.at.section),
            },
        };
        let mut point = lifted(self.point, by_point);
        self.law
            .point_update(self.pass, &site, lifted(sum, by_sum), &mut point);
        point
    }
}

impl<const D: usize, M: Material<D>> Piece for Pass<'_, D, M> {
    type Out = PassSlopes<D>;

    #[inline(always)]
    fn run(self) -> PassSlopes<D> {
        let points = <M::Point<f64> as Numbers<f64>>::COUNT;
        let sums = <M::Sum<f64> as Numbers<f64>>::COUNT;
        let mut sum = vec![0.0; sums];
        let mut through = vec![vec![0.0; points]; sums];
        let mut shares = vec![];
        // the law stands once in what is compiled: all slopes of a bond in one loop, by η and then by numbers of the point
        let moved = if self.pass > 0 { D + points } else { D };
        for b in self.bonds {
            let mut own = vec![[0.0; D]; sums];
            for n in 0..moved {
                let slopes = self.pair_pass(b, Some(n).filter(|n| *n < D), n.checked_sub(D));
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
        let (mut by_sum, mut by_point, mut point) = (vec![], vec![], vec![]);
        // by numbers of the sum, by those of the point, and the point itself
        for n in 0..=sums + points {
            let after = self.point_update(&sum, Some(n).filter(|n| *n < sums), n.checked_sub(sums));
            let slopes = (0..points).map(|n| after.get(n).slope).collect();
            match n.checked_sub(sums) {
                None => by_sum.push(slopes),
                Some(n) if n < points => by_point.push(slopes),
                Some(_) => point = (0..points).map(|n| after.get(n).value).collect(),
            }
        }
        PassSlopes {
            shares,
            through,
            by_sum,
            by_point,
            point,
        }
    }
}

/// The force state of an end.
struct ForceStateAt<'a, const D: usize, M: Material<D>> {
    law: &'a M,
    constants: M::Constants<Real>,
    memory: M::Memory<Real>,
    bond: &'a Bent<D>,
    point: &'a [f64],
    own: bool,
}

impl<const D: usize, M: Material<D>> ForceStateAt<'_, D, M> {
    /// The force where η grows along an axis, or a number of the point grows.
    #[inline(always)]
    fn pull(&self, axis: Option<usize>, number: Option<usize>) -> [Real; D] {
        let b = self.bond;
        let bond = bent(&b.xi, &b.eta, b.omega, axis);
        let end = End {
            constants: &self.constants,
            point: &lifted(self.point, number),
            memory: &self.memory,
        };
        let seen = if self.own { bond } else { mirrored(&bond) };
        let mut force = self.law.force_state(&seen, &end).alone(&seen);
        if !self.own {
            for f in &mut force {
                *f = still(0.0) - *f;
            }
        }
        force
    }
}

impl<const D: usize, M: Material<D>> Piece for ForceStateAt<'_, D, M> {
    type Out = AnswerSlopes<D>;

    #[inline(always)]
    fn run(self) -> AnswerSlopes<D> {
        let points = <M::Point<f64> as Numbers<f64>>::COUNT;
        let (mut by_eta, mut by_point, mut force) = ([[0.0; D]; D], vec![], [0.0; D]);
        // by η, by numbers of the point, and the force itself
        for n in 0..=D + points {
            let pulled = self.pull(Some(n).filter(|n| *n < D), n.checked_sub(D));
            match n.checked_sub(D) {
                None => {
                    for r in 0..D {
                        by_eta[r][n] = pulled[r].slope;
                    }
                }
                Some(n) if n < points => by_point.push(array::from_fn(|r| pulled[r].slope)),
                Some(_) => force = array::from_fn(|r| pulled[r].value),
            }
        }
        AnswerSlopes {
            by_eta,
            by_point,
            force,
        }
    }
}
