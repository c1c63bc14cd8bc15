//! A coarser body with the same mechanics: some points are retained, the others are taken to be in equilibrium between them.
//!
//! S. Silling, "A coarsening method for linear peridynamics" (2010). With K_ij = V_i C_ij, removed points e and retained points q,
//! `u_e = Σ_q S_eq u_q` is the equilibrium of the removed points under given u_q, and the coarse micromoduli are
//! `V_i C¹_iq = K_iq + Σ_e K_ie S_eq`. Over all removed points at once this is the Schur complement, which is exact and full. In balls
//! about each retained point it is cheap and sparse, by one of two schemes:
//!
//! - [`Scheme::Rows`], as published: each coarse row is that of a free ball. In inhomogeneous bodies it is not symmetric (erratum 5),
//!   and stays so unless told otherwise: rows of central bonds meet no force under rotations as they are, and do when they are
//!   symmetrised. For state-based laws they break rotations (erratum 8).
//! - [`Scheme::Energy`]: the shapes S are cut off by balls, and the coarse energy is that of the shapes. Symmetric, positive
//!   semidefinite and free of force under rigid motions for any law; errors of shapes enter squared.
//!
//! Loads on removed points are condensed with them where the body says who carries loads ([`peridyne::spec::LoadMap`]):
//! `b_q + Σ_e K_qe K_ee⁻¹ b_e`. Without, a load acts on the retained points alone, as in the paper, which has none on removed ones
//! (5); with [`Volume::Kept`] the same force density is then the same force at every level.
//!
//! In motion removed points are carried by the shapes: [`Mass`]. Nonlinear bodies go on in [`increments`].
//!
//! The balls' radius can be chosen by the effective modulus: [`Radius::Tolerance`]. Interior points of lattices share one ball.
//! The result is a [`LinearBody`] again: it runs, and it can be coarsened further.
//!
//! Of atoms at a temperature [`thermal`] makes level 0 from the frames of a run.

mod ball;
mod balls;
mod block;
mod check;
mod coupling;
mod energy;
mod error;
pub mod exact;
pub mod increments;
pub mod lattice;
mod mass;
mod mass_lumping;
mod near;
mod rows;
mod schur;
mod select;
mod shapes;
mod signature;
mod small;
mod solve;
mod sublattice;
#[cfg(test)]
mod tests;
pub mod thermal;
pub mod waves;

pub use balls::Work;
pub use check::{DEFINITE_LIMIT, EIGEN_LIMIT, Stability};
pub use error::CoarsenError;
pub use mass::Mass;
pub use mass_lumping::{Lumping, Volume};
pub use schur::SCHUR_LIMIT;
pub use select::Selection;

use balls::{Eliminated, Task};
use coupling::Coupling;
use peridyne::spec::LinearBody;
use peridyne::statics::Soundness;

/// Asymmetry of a body that still has an energy: the round-off of levels below.
const ENERGY: f64 = 1e-9;

/// How coarse micromoduli are found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Scheme {
    /// One free ball per row, as published.
    Rows,
    /// The energy of shapes that balls cut off.
    #[default]
    Energy,
    /// All removed points at once: exact, full; the radius says nothing.
    Schur,
}

/// The radius of balls (length).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Radius {
    Fixed(f64),
    /// Grows until the effective modulus is within this fraction of its limit.
    Tolerance(f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    pub scheme: Scheme,
    pub radius: Radius,
    pub volume: Volume,
    pub mass: Mass,
    /// Makes action reaction where the rows do not: `K_ij ← ½ (K_ij + K_jiᵀ)`. Rotations of such a body may meet forces.
    pub symmetrise: bool,
    /// Largest force under a rigid rotation that is accepted, as [`Soundness::rotation`], beyond that of the body below.
    pub rotation: f64,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            scheme: Scheme::default(),
            radius: Radius::Tolerance(0.01),
            volume: Volume::default(),
            mass: Mass::default(),
            symmetrise: false,
            rotation: 1e-3,
        }
    }
}

/// One radius that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    pub radius: f64,
    /// Mean over axes of the modulus of uniaxial affine strain: `½ Σ_ij V_i C_ij[a][a] ξ_a² / Σ V` (force density × length²).
    pub modulus: f64,
    /// Change of all components of the modulus since the radius before, relative; 0 for the first.
    pub change: f64,
    /// What is left by the trend of the changes, relative; 0 where the balls span the body, infinite before there is a trend.
    pub left: f64,
}

/// What was done, and how sound the coarse body is.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Numbers in the body below of the coarse points.
    pub retained: Vec<u32>,
    /// Of the balls; infinite for the exact elimination.
    pub radius: f64,
    /// Convergence with the radius, the accepted one last.
    pub convergence: Vec<Tried>,
    /// Of the accepted radius.
    pub work: Work,
    /// Of the body below.
    pub below: Soundness,
    /// [`Soundness::asymmetry`] as it came, before it was repaired if that was asked for.
    pub asymmetry: f64,
    /// Of the coarse body.
    pub soundness: Soundness,
    /// Of the operator as it is, symmetric or not, but for what a rotation meets.
    pub stability: Stability,
    /// Were all energies found to be at least 0? `false`: action is not reaction, or more than [`DEFINITE_LIMIT`] unknowns.
    pub definite: bool,
    /// The largest part of a force on a removed point that is lost on its way to the retained ones; `None`: loads are not condensed.
    pub loss: Option<f64>,
    pub lumping: Lumping,
    /// Mass of the body below and of the coarse one.
    pub mass: [f64; 2],
    /// Distance of their centres of mass (length); 0 for periodic axes.
    pub shift: f64,
    /// Longest coarse bond (length).
    pub range: f64,
}

/// The coarse body of some points of a body, ascending by their numbers.
///
/// # Errors
/// [`CoarsenError`]: the request is meaningless, or the coarse body would not be sound.
pub fn coarsen<const D: usize>(
    body: &LinearBody<D>,
    retained: &[u32],
    options: &Options,
) -> Result<(LinearBody<D>, Report), CoarsenError> {
    let (coarse, report, _) = made(body, retained, options, options.mass != Mass::Lumped, false)?;
    Ok((coarse, report))
}

/// The coarse body, and the shapes that its points carry.
fn shaped<const D: usize>(
    body: &LinearBody<D>,
    retained: &[u32],
    options: &Options,
) -> Result<(LinearBody<D>, Report, shapes::Shapes<D>), CoarsenError> {
    let (coarse, report, shapes) = made(body, retained, options, true, true)?;
    let shapes = shapes.unwrap_or(shapes::Shapes { rows: vec![] });
    Ok((coarse, report, shapes))
}

/// Are shapes wanted, and are they `kept` beside the body?
fn made<const D: usize>(
    body: &LinearBody<D>,
    retained: &[u32],
    options: &Options,
    wanted: bool,
    kept: bool,
) -> Result<(LinearBody<D>, Report, Option<shapes::Shapes<D>>), CoarsenError> {
    let mut retained = retained.to_vec();
    retained.sort_unstable();
    select::check(&retained, body.points())?;
    finite(body)?;
    let mut marked = vec![false; body.points()];
    for i in &retained {
        marked[*i as usize] = true;
    }
    let parts = check::parts(body.points(), check::bonds(body));
    check::represented(&parts, &marked)?;
    let below = body.soundness();
    let loaded = match &body.load_map {
        Some(load_map) => load_map.reached(body.points()),
        None => vec![false; body.points()],
    };
    let task = Task {
        body,
        retained: &retained,
        marked: &marked,
        range: body.range(),
        asymmetry: below.asymmetry,
        loaded: &loaded,
        shaped: wanted,
    };
    let plan = Plan {
        task,
        options,
        lumped: mass_lumping::lump_mass(body, &retained, &marked, spacing(body, retained.len())),
    };
    let (mut made, radius, convergence) = plan.converged()?;
    let shapes = match kept {
        true => made.shapes.clone(),
        false => None,
    };
    made.body.mass = mass::matrix(&plan.task, made.shapes.take(), &made.body, options.mass);
    made.body.load_map = body.load_map.clone().map(|c| c.passed(&made.pass));
    check::connected(&made.coupling, &retained, &parts, radius)?;
    let soundness = made.body.soundness();
    let allowed = options.rotation + 2.0 * below.rotation;
    // bonds of half a period have no one direction
    let half = body
        .period
        .iter()
        .flatten()
        .fold(f64::INFINITY, |m, p| m.min(0.5 * p));
    let turns = made.body.range() < half * (1.0 - 1e-9);
    if turns && soundness.rotation > allowed {
        return Err(CoarsenError::Rotation {
            found: soundness.rotation,
            allowed,
        });
    }
    // where a rotation meets forces, its energy may be as much below 0
    let slack = soundness.rotation.max(1e-10);
    let stability = match soundness.asymmetry < ENERGY {
        true => check::definite(&made.coupling.symmetrised(), slack)?,
        false => check::stable(&made.coupling, &made.body, slack)?,
    };
    let (mass, centre) = mass_and_centre(body);
    let (coarse, moved) = mass_and_centre(&made.body);
    let shift = (0..D).filter(|a| body.period[*a].is_none());
    let shift: f64 = shift.map(|a| (centre[a] - moved[a]).powi(2)).sum();
    let report = Report {
        radius,
        convergence,
        work: made.work,
        below,
        asymmetry: made.asymmetry,
        soundness,
        stability,
        definite: stability == Stability::Definite,
        loss: made.body.load_map.as_ref().map(|c| c.loss()),
        lumping: plan.lumped.lumping,
        mass: [mass, coarse],
        shift: shift.sqrt(),
        range: made.body.range(),
        retained,
    };
    Ok((made.body, report, shapes))
}

/// The exact coarse body: [`coarsen`] with [`Scheme::Schur`].
///
/// # Errors
/// As [`coarsen`]; too many points.
pub fn schur<const D: usize>(
    body: &LinearBody<D>,
    retained: &[u32],
) -> Result<(LinearBody<D>, Report), CoarsenError> {
    let options = Options {
        scheme: Scheme::Schur,
        ..Options::default()
    };
    coarsen(body, retained, &options)
}

/// Is every number a number?
fn finite<const D: usize>(body: &LinearBody<D>) -> Result<(), CoarsenError> {
    let sound = |i: &usize| {
        let x = body.position[*i]
            .iter()
            .chain(body.row(*i).1.as_flattened().as_flattened());
        let (v, rho) = (body.volume[*i], body.density[*i]);
        let counts = v > 0.0 && v.is_finite() && rho >= 0.0 && rho.is_finite();
        counts && x.copied().all(f64::is_finite)
    };
    match (0..body.points()).find(|i| !sound(i)) {
        None => Ok(()),
        Some(i) => Err(CoarsenError::NotFinite(i)),
    }
}

/// Mean spacing of so many points in the box of a body (length).
fn spacing<const D: usize>(body: &LinearBody<D>, points: usize) -> f64 {
    let wide = mass_lumping::extents(body);
    let most = wide.iter().fold(0.0f64, |m, x| m.max(*x));
    // a body that is thin along an axis is counted as a plate
    let thin = most / points as f64;
    let axes: Vec<f64> = wide.into_iter().filter(|x| *x > thin).collect();
    let box_: f64 = axes.iter().product();
    match axes.is_empty() {
        true => 1.0,
        false => libm::pow(box_ / points as f64, 1.0 / axes.len() as f64),
    }
}

fn mass_and_centre<const D: usize>(body: &LinearBody<D>) -> (f64, [f64; D]) {
    let (mut mass, mut centre) = (0.0, [0.0; D]);
    for ((x, v), rho) in body.position.iter().zip(&body.volume).zip(&body.density) {
        mass += v * rho;
        for a in 0..D {
            centre[a] += v * rho * x[a];
        }
    }
    (
        mass,
        centre.map(|x| if mass > 0.0 { x / mass } else { 0.0 }),
    )
}

struct Plan<'a, const D: usize> {
    task: Task<'a, D>,
    options: &'a Options,
    lumped: mass_lumping::LumpedMass,
}

/// The coarse body of one radius.
struct Made<const D: usize> {
    coupling: Coupling<D>,
    body: LinearBody<D>,
    asymmetry: f64,
    work: Work,
    pass: Vec<Vec<(u32, block::Block<D>)>>,
    shapes: Option<shapes::Shapes<D>>,
}

impl<const D: usize> Plan<'_, D> {
    fn make(&self, radius: f64) -> Result<Made<D>, CoarsenError> {
        let task = &self.task;
        if radius.is_nan() || radius <= 0.0 {
            return Err(CoarsenError::Radius(radius));
        }
        // closed balls: a radius equal to the longest bond will do
        if radius < task.range * (1.0 - 1e-9) {
            return Err(CoarsenError::Range {
                radius,
                range: task.range,
            });
        }
        let Eliminated {
            coupling,
            work,
            pass,
            shapes,
        } = match self.options.scheme {
            Scheme::Rows => rows::rows(task, radius)?,
            Scheme::Schur => schur::schur(task)?,
            Scheme::Energy if task.asymmetry < ENERGY => energy::energy(task, radius)?,
            Scheme::Energy => return Err(CoarsenError::Unsymmetric(task.asymmetry)),
        };
        let volume = match self.options.volume {
            Volume::Lumped => self.lumped.volume.clone(),
            Volume::Kept => (task.retained.iter())
                .map(|i| task.body.volume[*i as usize])
                .collect(),
        };
        let body =
            |c: &Coupling<D>| c.body(task.body, task.retained, volume.clone(), &self.lumped.mass);
        let asymmetry = body(&coupling).soundness().asymmetry;
        // an elimination of a symmetric body is symmetric but for round-off
        let round_off =
            asymmetry < ENERGY && task.asymmetry < ENERGY && self.options.scheme != Scheme::Rows;
        let coupling = match asymmetry > 0.0 && (self.options.symmetrise || round_off) {
            true => coupling.symmetrised(),
            false => coupling,
        };
        let body = body(&coupling);
        Ok(Made {
            coupling,
            body,
            asymmetry,
            work,
            pass,
            shapes,
        })
    }

    fn converged(&self) -> Result<(Made<D>, f64, Vec<Tried>), CoarsenError> {
        let volume: f64 = self.task.body.volume.iter().sum();
        let modulus = |affine: &[f64]| {
            let axial = (0..D).map(|a| affine[a * D * D * D + a * D * D + a * D + a]);
            axial.sum::<f64>() / (2.0 * D as f64 * volume)
        };
        let one = |made: &Made<D>, radius, left| {
            let modulus = modulus(&check::affine(&made.body));
            let change = 0.0;
            vec![Tried {
                radius,
                modulus,
                change,
                left,
            }]
        };
        let tolerance = match (self.options.scheme, self.options.radius) {
            (Scheme::Schur, _) => {
                let made = self.make(f64::INFINITY)?;
                let tried = one(&made, f64::INFINITY, 0.0);
                return Ok((made, f64::INFINITY, tried));
            }
            (_, Radius::Fixed(radius)) => {
                let made = self.make(radius)?;
                let tried = one(&made, radius, f64::INFINITY);
                return Ok((made, radius, tried));
            }
            (_, Radius::Tolerance(t)) if t > 0.0 && t < 1.0 => t,
            (_, Radius::Tolerance(t)) => return Err(CoarsenError::Tolerance(t)),
        };
        let coarse = spacing(self.task.body, self.task.retained.len());
        let span = mass_lumping::extents(self.task.body);
        let span = span.iter().map(|x| x * x).sum::<f64>().sqrt();
        // shapes from the energy fall off sooner than rows
        let first = match self.options.scheme {
            Scheme::Energy => 1.25 * coarse,
            Scheme::Rows | Scheme::Schur => 2.0 * coarse,
        };
        let mut radius = self.task.range.max(first);
        let mut tried: Vec<Tried> = vec![];
        let mut before: Vec<f64> = vec![];
        loop {
            let made = match self.make(radius) {
                // a larger ball may do
                Err(
                    e @ (CoarsenError::Uncovered { .. }
                    | CoarsenError::Indefinite { .. }
                    | CoarsenError::Singular { .. }),
                ) => {
                    if radius >= span {
                        return Err(e);
                    }
                    radius *= 1.25;
                    continue;
                }
                made => made?,
            };
            let affine = check::affine(&made.body);
            let (mut off, mut size) = (0.0, 0.0);
            for (x, y) in affine.iter().zip(&before) {
                off += (x - y) * (x - y);
                size += x * x;
            }
            let change = if size > 0.0 {
                f64::sqrt(off / size)
            } else {
                0.0
            };
            let left = match tried.last() {
                _ if radius >= span => 0.0,
                None => f64::INFINITY,
                Some(_) if change < 1e-13 => change,
                // a geometric trend, but never one that ends at once
                Some(last) if last.change > 0.0 => {
                    let ratio = (change / last.change).clamp(0.5, 0.95);
                    change * ratio / (1.0 - ratio)
                }
                Some(_) => f64::INFINITY,
            };
            tried.push(Tried {
                radius,
                modulus: modulus(&affine),
                change,
                left,
            });
            if left <= tolerance {
                return Ok((made, radius, tried));
            }
            before = affine;
            // balls grow by whole coarse cells: less would show no trend
            radius = (radius + coarse).max(1.2 * radius);
        }
    }
}
