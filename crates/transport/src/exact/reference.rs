//! The solution of the local law, to which the nonlocal one tends, where it is known: for runs that compare themselves with it.

use super::characteristics::{characteristics, shock_time};

use super::{ColeHopf, Primitive, riemann};
use crate::flux::Flux;
use crate::grid::{Boundary, Grid, Values};
use crate::kernel::Function;
use crate::law::Law;
use crate::measure::extremes;
use crate::threads::pieces;
use peridyne::error::BuildError;
use peridyne::message;
use peridyne::quantity::Dimension;
use std::fmt;
use std::sync::Arc;

/// How the local law is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solution {
    /// `u = g(x − t f′(u))`, without diffusion, before the first shock.
    Characteristics,
    /// Of a step, without diffusion.
    Riemann,
    /// With diffusion, of a quadratic flux.
    ColeHopf,
}

impl Solution {
    /// As a deck names it.
    pub fn name(self) -> &'static str {
        match self {
            Solution::Characteristics => "characteristics",
            Solution::Riemann => "riemann",
            Solution::ColeHopf => "cole_hopf",
        }
    }
}

/// How far collars may be from the solution on the whole line, of the largest |u|.
const CLOSE: f64 = 1e-6;

/// Times at which collars are looked at.
const TIMES: u32 = 16;

/// What a solution needs.
enum Way {
    Characteristics {
        fastest: f64,
    },
    Riemann {
        states: [f64; 2],
        place: f64,
    },
    /// `w = f′(u) = b + 2cu` solves `w_t + w w_x = ε w_xx`.
    ColeHopf {
        speed: [f64; 2],
        primitive: Primitive,
        fastest: f64,
        viscosity: f64,
    },
}

/// The solution of the local law `u_t + f(u)_x = ε u_xx` from the state at t = 0.
pub struct Reference {
    solution: Solution,
    grid: Grid,
    flux: Flux,
    /// u at t = 0 on the whole line: with the period of the grid, or with what collars hold then.
    initial: Function,
    way: Way,
}

impl fmt::Debug for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Reference({:?})", self.solution)
    }
}

impl Reference {
    /// Of a law from `initial` (of a place, at t = 0) until `duration`.
    ///
    /// # Errors
    /// The solution does not exist, with the reason: planes, fields of directions, nothing that is carried; diffusion, or none; a shock before the end, a jump; no step; a flux that
    /// is not quadratic; collars that hold something else than the solution on the whole line. `path` is in all of them.
    pub fn new(
        solution: Solution,
        law: &Law,
        initial: &Values,
        duration: f64,
        path: &str,
    ) -> Result<Reference, BuildError> {
        let none = |why: &str| BuildError::unsupported(path, why);
        if law.grid.dimension > 1 {
            return Err(none("solutions are known on a line, not in a plane")
                .help("leave compare out, or write a domain without y"));
        }
        let Some(flux) = law.local_flux() else {
            return Err(match law.advection {
                None => none("nothing is carried here: these solutions are those of a flux")
                    .help("leave compare out, or write [advection]"),
                Some(_) => none("the direction depends on x, and no solution is known along it")
                    .help("leave compare out, or write a constant direction"),
            });
        };
        let viscosity = law.diffusion.as_ref().map_or(0.0, |d| d.viscosity);
        match solution {
            Solution::ColeHopf if !(viscosity > 0.0) => {
                return Err(none("Cole and Hopf solve the law with diffusion, and here is none")
                    .help("write [diffusion] with a viscosity above 0; without it compare = \"characteristics\" until the shock, or \"riemann\" from a step"));
            }
            Solution::Characteristics | Solution::Riemann if viscosity > 0.0 => {
                return Err(none("this is a solution without diffusion, which spreads what characteristics carry unchanged")
                    .help("leave [diffusion] out, or write compare = \"cole_hopf\""));
            }
            _ => {}
        }
        let whole = whole_line(law, initial);
        let places = places(law);
        let u: Vec<f64> = places.iter().map(|x| whole(*x)).collect();
        let way = match solution {
            Solution::Characteristics => {
                along_characteristics(law, &flux, &whole, &places, &u, duration, path)?
            }
            Solution::Riemann => from_a_step(law, &whole, &places, &u, path)?,
            Solution::ColeHopf => {
                with_viscosity(law, &flux, &whole, &u, viscosity, duration, path)?
            }
        };
        let reference = Reference {
            solution,
            grid: law.grid,
            flux,
            initial: whole,
            way,
        };
        reference.holds_in_collars(law, &places, &u, duration, path)?;
        Ok(reference)
    }

    pub fn solution(&self) -> Solution {
        self.solution
    }

    /// u at x and t.
    pub fn value(&self, x: f64, t: f64) -> f64 {
        match &self.way {
            _ if t <= 0.0 => (self.initial)(x),
            Way::Characteristics { fastest } => {
                characteristics(&self.flux, &*self.initial, *fastest, x, t)
            }
            Way::Riemann {
                states: [left, right],
                place,
            } => riemann(&self.flux, *left, *right, (x - place) / t),
            Way::ColeHopf {
                speed: [b, c],
                primitive,
                fastest,
                viscosity,
            } => {
                let solution = ColeHopf {
                    primitive: |y| primitive.value(y),
                    fastest: *fastest,
                    viscosity: *viscosity,
                };
                (solution.value(x, t) - b) / c
            }
        }
    }

    /// u at all points of the grid, on all threads.
    pub fn values(&self, t: f64) -> Vec<f64> {
        /// Points that a thread takes, and operations of one, roughly.
        const TOGETHER: usize = 16;
        const WORK: usize = 10_000;
        let mut out = vec![0.0; self.grid.points()];
        pieces(&mut out, TOGETHER, WORK, |first, piece| {
            for (k, u) in piece.iter_mut().enumerate() {
                *u = self.value(self.grid.place(first + k)[0], t);
            }
        });
        out
    }

    /// Do collars hold what the solution of the whole line is there, until the end?
    fn holds_in_collars(
        &self,
        law: &Law,
        places: &[f64],
        u: &[f64],
        duration: f64,
        path: &str,
    ) -> Result<(), BuildError> {
        let Boundary::Collars(given) = &law.boundary else {
            return Ok(());
        };
        let largest = u.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        let reach = law.reach();
        let count = places.len();
        for k in 0..=TIMES {
            let t = duration * f64::from(k) / f64::from(TIMES);
            for n in [0, reach - 1, count - reach, count - 1] {
                let x = places[n];
                if (self.value(x, t) - given(&[x, 0.0, 0.0], t)).abs() > CLOSE * largest {
                    return Err(BuildError::unsupported(
                        path,
                        message![
                            "the collar at x = ",
                            Dimension::LENGTH.of(x),
                            " does not hold what the solution on the whole line is there at t = ",
                            Dimension::TIME.of(t),
                            ": it is the solution of another problem"
                        ],
                    )
                    .help("write collars that hold the solution, a larger domain, or a shorter run.duration"));
                }
            }
        }
        Ok(())
    }
}

/// u at t = 0 on the whole line.
fn whole_line(law: &Law, initial: &Values) -> Function {
    let (low, length) = (law.grid.low[0], law.grid.spacing * law.grid.cells[0] as f64);
    let initial = initial.clone();
    let at = move |x: f64| initial(&[x, 0.0, 0.0], 0.0);
    match &law.boundary {
        Boundary::Periodic => Arc::new(move |x| at(low + (x - low).rem_euclid(length))),
        Boundary::Collars(given) => {
            let given = given.clone();
            Arc::new(move |x| match (low..=low + length).contains(&x) {
                true => at(x),
                false => given(&[x, 0.0, 0.0], 0.0),
            })
        }
    }
}

/// Points of the grid and of its collars, in order; where it is periodic one more, with which it closes.
fn places(law: &Law) -> Vec<f64> {
    let n = law.grid.cells[0] as isize;
    let (first, last) = match law.boundary {
        Boundary::Periodic => (0, n + 1),
        Boundary::Collars(_) => {
            let reach = law.reach() as isize;
            (-reach, n + reach)
        }
    };
    (first..last).map(|i| law.grid.middle(i, 0)[0]).collect()
}

/// The place between `a` and `b` at which `f` jumps, if halving that part again and again leaves more than half of its change.
fn jump(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> Option<f64> {
    let (mut low, mut high) = (f(a), f(b));
    let change = (high - low).abs();
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if !(a < middle && middle < b) {
            break;
        }
        let here = f(middle);
        match (here - low).abs() >= (high - here).abs() {
            true => (b, high) = (middle, here),
            false => (a, low) = (middle, here),
        }
    }
    ((high - low).abs() > 0.5 * change).then_some(b)
}

/// Largest |f′| over values, with room for extremes between those that are looked at.
fn fastest(flux: &Flux, u: &[f64]) -> f64 {
    let [low, high] = extremes(u);
    let looked = flux.fastest(low, high);
    let own = u
        .iter()
        .fold(0.0, |most: f64, u| most.max(flux.speed(*u).abs()));
    1.01 * looked.max(own)
}

fn along_characteristics(
    law: &Law,
    flux: &Flux,
    whole: &Function,
    places: &[f64],
    u: &[f64],
    duration: f64,
    path: &str,
) -> Result<Way, BuildError> {
    /// Of the range of speeds: smaller steps of them are looked at no closer.
    const LITTLE: f64 = 1e-3;
    let speed: Vec<f64> = u.iter().map(|u| flux.speed(*u)).collect();
    let [slow, fast] = extremes(&speed);
    let noise = 1e-9 * slow.abs().max(fast.abs());
    let pairs = places.windows(2).zip(speed.windows(2));
    for (x, s) in pairs {
        let step = (s[1] - s[0]).abs();
        if step <= noise || step <= LITTLE * (fast - slow) {
            continue;
        }
        if let Some(place) = jump(|x| flux.speed(whole(x)), x[0], x[1]) {
            let rises = s[1] > s[0];
            return Err(BuildError::unsupported(
                path,
                message![
                    "u jumps at x = ",
                    Dimension::LENGTH.of(place),
                    if rises {
                        ", where a fan opens that no characteristic from t = 0 reaches"
                    } else {
                        ", where characteristics cross from the beginning"
                    }
                ],
            )
            .help("write compare = \"riemann\" where that is a single step, or a smooth initial state"));
        }
    }
    match shock_time(flux, u, law.grid.spacing, false) {
        Some(shock) if shock <= duration => Err(BuildError::unsupported(
            path,
            message![
                "characteristics cross at t = ",
                Dimension::TIME.of(shock),
                ", before the run ends at ",
                Dimension::TIME.of(duration),
                ": from then on the local law has a shock, and u = g(x − t f′(u)) more than one root"
            ],
        )
        .help("write a shorter run.duration, or a viscosity and compare = \"cole_hopf\"")),
        _ => Ok(Way::Characteristics {
            fastest: fastest(flux, u),
        }),
    }
}

fn from_a_step(
    law: &Law,
    whole: &Function,
    places: &[f64],
    u: &[f64],
    path: &str,
) -> Result<Way, BuildError> {
    let none = |why| {
        BuildError::unsupported(path, why).help(
            "write one step, such as initial = \"x < 0 ? 1 : 0\" with boundary = { left = 1, right = 0 }",
        )
    };
    if law.periodic() {
        return Err(none(
            "Riemann's problem is a single step on the whole line: on a periodic one u steps back where the ends meet",
        ));
    }
    let states = [u[0], u[u.len() - 1]];
    let [left, right] = states;
    let step = u.iter().position(|u| *u != left).unwrap_or(0);
    if step == 0 || u[step..].iter().any(|u| *u != right) {
        return Err(none(
            "Riemann's problem begins with one step between two constants, and this initial state is none",
        ));
    }
    let (mut a, mut b) = (places[step - 1], places[step]);
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        match whole(middle) == left {
            true => a = middle,
            false => b = middle,
        }
    }
    Ok(Way::Riemann { states, place: b })
}

fn with_viscosity(
    law: &Law,
    flux: &Flux,
    whole: &Function,
    u: &[f64],
    viscosity: f64,
    duration: f64,
    path: &str,
) -> Result<Way, BuildError> {
    let speed = match flux.coefficients().as_deref() {
        Some([_, b, c]) => [*b, 2.0 * c],
        _ => {
            return Err(BuildError::unsupported(
                path,
                "Cole and Hopf's transformation makes the law linear where the flux is quadratic in u, and this one is not",
            )
            .help("leave compare out, or write flux = \"burgers\" or { polynomial = [c0, c1, c2] }"));
        }
    };
    let fastest = fastest(flux, u);
    let own = [
        law.grid.low[0],
        law.grid.low[0] + law.grid.spacing * law.grid.cells[0] as f64,
    ];
    // as far as the phase is looked at
    let far = 2.0 * fastest * duration + (160.0 * viscosity * duration).sqrt();
    let reach = law.reach() as f64 * law.grid.spacing;
    let (ends, periodic) = match law.periodic() {
        true => (own, true),
        false => ([own[0] - reach - far, own[1] + reach + far], false),
    };
    let g = |x: f64| speed[0] + speed[1] * whole(x);
    let primitive = Primitive::new(g, ends, fastest, periodic);
    Ok(Way::ColeHopf {
        speed,
        primitive,
        fastest,
        viscosity,
    })
}
