//! Equilibria along a path on which the load may rise and fall, of bodies that deform as they like: how far bonds open in an increment is
//! given, or how far points go, and the factor λ of the load is an unknown like the displacements (arc length: E. Riks 1979, An
//! incremental approach to the solution of snapping and buckling problems, Int. J. Solids Struct. 15, 529–551; what opens as the
//! measure of softening bodies: R. de Borst 1987, Computation of post-bifurcation and post-failure behavior of strain-softening solids,
//! Comput. Struct. 25, 211–224).
//!
//! All that loads the body is proportional to λ, which is t. A step of Newton's method solves the tangent K for the residual and for the load
//! of 1, `K a = r`, `K b = f¹`, and goes by `a + δλ b`, with δλ such that the measure is what it should be. K may have any sign.
//!
//! Measures of an increment Δu: *opening*, the mean growth of the stretch of bonds, weighted by the fourth power of what each grows by along the path
//! at the increment's first trial (linear in Δu, `c·Δu`: nearly the growth of those that open fastest); *arc length*, the root of the mean square of
//! what points go by, whose condition is linear about every trial.
//!
//! An increment begins where the one before would lead, which decides what goes on loading and what unloads. One that does not converge is
//! halved; the next is twice as long again, up to what is asked for.

use super::Way;
use super::problem::Problem;
use super::state::{Followed, StaticState};
use super::whole::{told, unknowns, whole_support};
use crate::body::{Field, zeros};
use crate::error::{BuildError, SolveError};
use crate::interaction::BondStatus;
use crate::run::system::System;
use crate::spec::Control;
use crate::statics::{Assembled, Direct, Solved, Support};

/// Newton's iterations in a trial of an increment.
const TRIALS: usize = 25;
/// How often a step of Newton's method is halved that leaves more than was.
const BACK: i32 = 6;
/// How often an increment is halved.
const HALVINGS: i32 = 10;
/// Relative deviation of an increment from its length that is none.
const LENGTH: f64 = 1e-6;
/// Relative residual above which factors have solved nothing.
const SOLVED: f64 = 1e-6;

/// Solutions with the tangent of a trial: of the residual, and of the load of 1. Is it positive definite?
struct Along<const D: usize> {
    a: Vec<[f64; D]>,
    b: Vec<[f64; D]>,
    stable: bool,
}

/// A trial of an increment.
struct Trial<const D: usize> {
    way: Vec<[f64; D]>,
    /// What it adds to the factor of the load.
    factor: f64,
    r: Vec<[f64; D]>,
    /// r over the largest loads and reactions of the path.
    left: f64,
}

/// `x + by · y`
fn further<const D: usize>(x: &[[f64; D]], y: &[[f64; D]], by: f64) -> Vec<[f64; D]> {
    let both = x.iter().zip(y);
    both.map(|(x, y)| crate::array::from_fn(|a| x[a] + by * y[a]))
        .collect()
}

impl<const D: usize> System<D> {
    /// Is there a path, and can it be followed?
    pub(in crate::run) fn check_path(&mut self) -> Result<(), BuildError> {
        self.check_factor()?;
        self.enough_memory_for_rows()
    }
}

impl<const D: usize> Problem<'_, D> {
    /// One increment along the path; on an error displacements and forces are anything.
    pub(in crate::run) fn settle_path(
        &mut self,
        state: &mut StaticState<D>,
        [u, f, external]: [&Field<D>; 3],
    ) -> Result<(Solved, Way), SolveError> {
        let support = self.support_now(state.options)?.support;
        if unknowns(&self.system.body, &support) == 0 {
            return Err(SolveError::NothingFree);
        }
        let before = self.system.clock.origin();
        let start = self.system.body.values(u);
        let asked = state
            .followed
            .as_ref()
            .map_or(1.0, |f| (2.0 * f.part).min(1.0));
        let mut halvings = 0;
        let (solved, followed) = loop {
            let part = asked * 0.5f64.powi(halvings);
            match self.go_on(state, &support, &start, before, part) {
                Ok(found) => break found,
                Err(error) => {
                    let final_one = matches!(error, SolveError::Stopped | SolveError::TooLarge);
                    if self.sums.any(final_one) || halvings == HALVINGS {
                        return Err(error);
                    }
                    halvings += 1;
                }
            }
        };
        let mut way = Way::default();
        self.hold(false);
        self.follow(
            &support,
            &[u.clone(), f.clone(), external.clone()],
            false,
            &mut way,
        );
        self.system.forces(true, self.system.clock.trial());
        state.followed = Some(followed);
        Ok((solved, way))
    }

    /// From displacements `start` under the factor `before` by `part` of an increment.
    fn go_on(
        &mut self,
        state: &StaticState<D>,
        support: &Support<D>,
        start: &[[f64; D]],
        before: f64,
        part: f64,
    ) -> Result<(Solved, Followed<D>), SolveError> {
        let goal = self.goal(state.options);
        let last = state.followed.as_ref();
        let (opens, target) = match state.options.control {
            Control::IndirectDisplacement(by) => (true, part * by),
            Control::ArcLength(by) => (false, part * by),
            Control::Load | Control::SequentiallyLinear => return Err(SolveError::NotFinite),
        };
        let unit = self.unit_load(support);
        let points = self.system.body.all_points() as f64;
        let (longer, mut most) = last.map_or((0.0, 0.0), |l| (part / l.part, l.most));
        let way = match last {
            Some(l) => l.way.iter().map(|w| w.map(|c| longer * c)).collect(),
            None => vec![[0.0; D]; start.len()],
        };
        let factor = longer * last.map_or(0.0, |l| l.factor);
        let mut now = self.trial(way, factor, support, start, before, &mut most)?;
        let mut slope: Vec<[f64; D]> = vec![];
        for iterations in 0..TRIALS {
            goal.go_on(0, &self.sums)?;
            let Along { a, b, stable } = self.along(support, &now.r, &unit)?;
            if opens && iterations == 0 {
                let x = further(start, &now.way, 1.0);
                slope = self.opening(&x, &b, stable)?;
            } else if !opens {
                // of the length with the way, at first that along the load of 1
                let along = if self.sums.dot(&now.way, &now.way) > 0.0 {
                    &now.way
                } else {
                    &b
                };
                let per = (self.sums.dot(along, along) * points).sqrt();
                slope = along.iter().map(|w| w.map(|c| c / per)).collect();
            }
            // how far the way is from its length, over that
            let sums = self.sums.clone();
            let short = |way: &[[f64; D]]| match opens {
                true => sums.dot(&slope, way) / target - 1.0,
                false => (sums.dot(way, way) / points).sqrt() / target - 1.0,
            };
            let more = -target * short(&now.way) - sums.dot(&slope, &a);
            let more = more / sums.dot(&slope, &b);
            let step = further(&a, &b, more);
            let left = libm::hypot(now.left, short(&now.way));
            for halving in 0..=BACK {
                let by = 0.5f64.powi(halving);
                let way = further(&now.way, &step, by);
                let next = now.factor + by * more;
                let next = self.trial(way, next, support, start, before, &mut most)?;
                if libm::hypot(next.left, short(&next.way)) < left || halving == BACK {
                    now = next;
                    break;
                }
            }
            if now.left <= goal.tolerance && short(&now.way).abs() < LENGTH {
                let solved = Solved {
                    iterations: iterations + 1,
                    residual: now.left,
                };
                let followed = Followed {
                    way: now.way,
                    factor: now.factor,
                    part,
                    most,
                };
                return Ok((solved, followed));
            }
        }
        Err(goal.missed(TRIALS, now.left))
    }

    /// What is left over at the end of a way.
    fn trial(
        &mut self,
        way: Vec<[f64; D]>,
        factor: f64,
        support: &Support<D>,
        start: &[[f64; D]],
        before: f64,
        most: &mut f64,
    ) -> Result<Trial<D>, SolveError> {
        let mut r = vec![[0.0; D]; way.len()];
        self.system.clock.set(before + factor);
        let found = self.imbalance(&further(start, &way, 1.0), &mut r, support);
        *most = found.scale.max(*most);
        let size = found.size;
        if !size.is_finite() {
            return Err(SolveError::NotFinite);
        }
        Ok(Trial {
            way,
            factor,
            r,
            left: if *most > 0.0 { size / *most } else { 0.0 },
        })
    }

    /// Forces on the free components and displacements of the others under the load of 1.
    fn unit_load(&mut self, support: &Support<D>) -> Vec<[f64; D]> {
        let system = &mut *self.system;
        let clock = system.clock;
        system.clock.set(1.0);
        let mut u = system.body.at_rest();
        system.prescribed.place(&mut u, 1.0);
        let load = system.external();
        let (mut unit, load) = (system.body.values(&u), system.body.per_point(&load));
        for ((unit, load), free) in unit.iter_mut().zip(&load).zip(&support.free) {
            for a in (0..D).filter(|a| free[*a]) {
                unit[a] = load[a];
            }
        }
        system.clock = clock;
        unit
    }

    /// What the tangent of now makes of a residual and of the load of 1.
    fn along(
        &mut self,
        support: &Support<D>,
        r: &[[f64; D]],
        unit: &[[f64; D]],
    ) -> Result<Along<D>, SolveError> {
        let whole = whole_support(&self.system.body, support);
        let factored = self.tangent_now().zip(whole).map(|(body, support)| {
            let support = support.resisted(&body);
            let (factors, stable) = match Direct::new(&body, &support, 0.0) {
                Err(SolveError::Indefinite { .. }) => {
                    (Direct::of_any_sign(&body, &support)?, false)
                }
                made => (made?, true),
            };
            Ok((body, support, factors, stable))
        });
        let factored = told(&self.system.body, factored.transpose())?;
        let solved = |b: &[[f64; D]], mut x: Vec<[f64; D]>| {
            self.solve_whole((support, b), &mut x, |_, b, x| {
                let (body, support, factors, _) =
                    { factored.as_ref() }.expect("the matrix is here");
                let done = factors.solve_held(&mut Assembled(body), support, b, x);
                match done.residual <= SOLVED {
                    true => Ok(done),
                    false => Err(SolveError::Singular),
                }
            })?;
            Ok(x)
        };
        Ok(Along {
            a: solved(r, vec![[0.0; D]; r.len()])?,
            b: solved(unit, unit.to_vec())?,
            stable: self.sums.any(factored.as_ref().is_some_and(|made| made.3)),
        })
    }

    /// `c` of the opening `c·Δu` at displacements x: the mean of what bonds grow by, weighted by the fourth power of what they grow by along b or against
    /// it: where a body softens and some grow faster so, what softens opens against the load, and all else unloads.
    fn opening(
        &self,
        x: &[[f64; D]],
        b: &[[f64; D]],
        stable: bool,
    ) -> Result<Vec<[f64; D]>, SolveError> {
        let body = &self.system.body;
        let id = body.ids_by_slot();
        // partners may be others' points
        let [x, b] = [x, b].map(|of| {
            let mut field = zeros(body.len());
            body.set_vectors(&mut field, |id, _| of[id]);
            field
        });
        // of each bond, at each of its points that are here: what it is longer by, and grows by
        let mut bonds = vec![];
        // along b, and against it
        let mut fastest = [0.0f64; 2];
        self.system
            .interaction
            .each_partner(body, &mut |i, j, xi, state| {
                if state != BondStatus::Whole {
                    return;
                }
                let y: [f64; D] = crate::array::from_fn(|a| xi[a] + x[a][j] - x[a][i]);
                let square = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
                let lengths = (square(&y) * square(&xi)).sqrt();
                let slope = y.map(|c| c / lengths);
                let grows: f64 = (0..D).map(|a| slope[a] * (b[a][j] - b[a][i])).sum();
                fastest = [fastest[0].max(grows), fastest[1].max(-grows)];
                bonds.push((id[i] as usize, slope, grows));
            });
        let (sign, fastest) = match fastest.map(|own| self.sums.most(own)) {
            [along, against] if against > along && !stable => (-1.0, against),
            [along, _] => (1.0, along),
        };
        if !(fastest > 0.0) {
            return Err(SolveError::NothingOpens);
        }
        let mut c = vec![[0.0; D]; body.points()];
        let mut weights = vec![0.0; body.points()];
        for (i, slope, grows) in bonds {
            let weight = (sign * grows / fastest).max(0.0).powi(4);
            weights[i] += weight;
            for a in 0..D {
                c[i][a] -= weight * slope[a];
            }
        }
        // a bond has two points
        let [sum] = self.sums.each(weights.len(), |i| [0.5 * weights[i]]);
        c.iter_mut().for_each(|c| *c = c.map(|x| x / sum));
        Ok(c)
    }
}
