//! Atoms or fine points to coarse points with the same dynamics: a specification in, a specification out.
//!
//! | law | what is kept | what changes |
//! |---|---|---|
//! | springs, pmb, lps, eam-like on a lattice | horizon δ, moduli | m_ratio = N/n (seleson2009 (A.2), seleson2014 (4.10)) |
//! | a potential whose form allows it (Lennard-Jones) on fixed neighbours, without cut-off | σ̄, ε̄, reach | M = N/n (seleson2009 (5.3)) |
//! | any other potential | energy density under every homogeneous strain, number of shells | lengths times n, energies times n^D (seleson2014 (3.3)) |
//!
//! Atoms of several kinds in a cell, and potentials of fans, keep their shells too, on current neighbours: the coarse crystal is the fine one
//! n times as large with masses n^D times as large. Mass density, pressure, energy density and elastic constants, sites relaxed, are the
//! same, and so are long acoustic waves; at the wave vector k/n it has 1/n of all frequencies at k. Optical waves are lost: those of the
//! coarse crystal lie at 1/n of theirs, and stand for nothing.
//!
//! What a constant of a potential is multiplied by follows from its dimension, and stands with the potential
//! ([`Described::scaled`](peridyne::law::potential::Described::scaled), `keeping_reach`).
//!
//! [`upscale_keeping`] asks for one of the two: [`Keep::Shells`] goes with every law.

mod atoms;
pub mod card;
mod equilibrium_spacing;
pub mod kernels;
mod verdict;

pub use atoms::has_basis_or_fans;
pub use equilibrium_spacing::equilibrium_spacing;

use atoms::Atoms;

use crate::crystal::{Crystal, CrystalError, LatticeSolid, Reach, Reference};
use peridyne::family::stencil::Stencil;
use peridyne::law::potential::{KeptReach, Potential, Visitor};
use peridyne::message;
use peridyne::quantity::{Dimension, Message};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{
    BodySpec, FamilyChoice, Horizon, LawSpec, PmbStiffness, PotentialSpec, Schedule, Spec, TimeStep,
};

/// How many cut-offs of reference neighbours an upscaled potential keeps: those that a compression of a tenth brings in.
pub const REACH: f64 = 1.1;

/// Why a model has no upscaling.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UpscaleError {
    #[error("the factor is {0}: expected a whole number of 2 or more")]
    Factor(u32),
    #[error("only a lattice body can be upscaled: its coarse points are lattice points, too")]
    NoLattice,
    #[error(
        "a body with several materials is not upscaled, unless they are atoms whose kinds repeat from cell to cell: one law has one \
         upscaling"
    )]
    SeveralMaterials,
    #[error(
        "the materials do not lie on the coarse lattice as they lie on this one: name sublattices by the sites of the cell, \
         `sets.NAME = {{ basis = [2] }}`, which grow with it"
    )]
    OtherArrangement,
    #[error("{what} {number} is not divisible by the factor {factor}: choose one of {choices}")]
    NotDivisible {
        what: &'static str,
        number: u32,
        factor: u32,
        choices: String,
    },
    #[error(
        "{}", beyond(*.spacing, *.horizon, *.most)
    )]
    BeyondHorizon {
        spacing: f64,
        horizon: f64,
        most: u32,
    },
    #[error("nonlinear gradient equations are those of a chain of atoms")]
    NoChain,
    #[error(
        "only springs, solids, and Lennard-Jones on fixed neighbours without a cut-off keep their reach: a potential with \
         lengths of its own has one spacing, and keeps its shells"
    )]
    NoReach,
    #[error(
        "a micromodulus belongs to its horizon, which grows with the spacing where shells are kept: give the law `young` or \
         `bulk` instead"
    )]
    Micromodulus,
    #[error(
        "a potential has no influence function: kernels are those of springs and peridynamic solids"
    )]
    NoKernels,
    #[error(
        "a micromodulus belongs to its influence function: give the law `young` or `bulk` instead, which every kernel fits"
    )]
    OneKernel,
    #[error(transparent)]
    Crystal(#[from] CrystalError),
    #[error(transparent)]
    Surface(#[from] crate::homogenize::surface::SurfaceError),
}

fn beyond(spacing: f64, horizon: f64, most: u32) -> Message {
    message![
        "the coarse spacing ",
        Dimension::LENGTH.of(spacing),
        " is beyond the horizon ",
        Dimension::LENGTH.of(horizon),
        format!(": points would be alone; the largest factor is {most}"),
    ]
}

impl UpscaleError {
    /// What it says, its numbers with what they measure.
    pub fn message(&self) -> Message {
        match self {
            UpscaleError::BeyondHorizon {
                spacing,
                horizon,
                most,
            } => beyond(*spacing, *horizon, *most),
            UpscaleError::Crystal(e) => e.message(),
            UpscaleError::Surface(e) => e.message(),
            other => other.to_string().into(),
        }
    }
}

/// What can be asked to be kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// The distance up to which points talk: nonlocality in units of length, with fewer neighbours.
    Reach,
    /// The number of shells of neighbours: the length scale grows with the spacing.
    Shells,
}

/// What an upscaling keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// The horizon and the moduli.
    Horizon,
    /// Reduced σ̄ and ε̄ of Lennard-Jones chains, and the reach.
    Reduced,
    /// Energy density and number of shells.
    Shells,
}

impl Rule {
    pub fn describe(self) -> &'static str {
        match self {
            Rule::Horizon => "horizon and moduli are kept, the number of neighbours falls",
            Rule::Reduced => {
                "reduced constants and reach of Lennard-Jones are kept, the number of neighbours falls (seleson2009 (5.3))"
            }
            Rule::Shells => {
                "energy density under every homogeneous strain and the number of shells are kept, the length scale grows with the spacing (seleson2014 (3.3), (3.4))"
            }
        }
    }
}

/// Lattice and spacing of a body.
pub fn lattice(spec: &Spec) -> Result<(LatticeKind, f64), UpscaleError> {
    match &spec.body {
        BodySpec::Lattice {
            kind,
            spacing,
            perturb: None,
            ..
        }
        | BodySpec::Sites { kind, spacing, .. } => Ok((*kind, *spacing)),
        BodySpec::Lattice { .. } | BodySpec::Cloud(_) | BodySpec::Several(_) => {
            Err(UpscaleError::NoLattice)
        }
    }
}

fn current(spec: &Spec) -> bool {
    let own = spec.materials.iter().filter_map(|m| m.law.potential());
    let all = own.chain(spec.potentials.iter().map(|p| &p.potential));
    let longest = all.map(PotentialSpec::cut_off).fold(0.0, f64::max);
    match spec.family {
        _ if spec.potential().is_none() => false,
        FamilyChoice::Auto | FamilyChoice::Neighbours => true,
        // about the reference nobody can tell, if families hold all that feel each other
        FamilyChoice::Reference => {
            lattice(spec).is_ok_and(|(_, a)| spec.horizon.length(a) >= longest)
        }
        FamilyChoice::Stencil | FamilyChoice::List => false,
    }
}

/// Which neighbours of a perfect crystal count.
pub(crate) fn reach(spec: &Spec) -> Reach {
    match current(spec) {
        true => Reach::Cutoff,
        false => Reach::Horizon(spec.horizon),
    }
}

/// Divisors of n from 2 on.
fn divisors(n: u32) -> String {
    let all: Vec<String> = (2..=n)
        .filter(|d| n.is_multiple_of(*d))
        .map(|d| d.to_string())
        .collect();
    if all.is_empty() {
        "none".into()
    } else {
        all.join(", ")
    }
}

/// The model at `factor` times the spacing, by the rule of its law.
///
/// # Errors
/// Why it has none.
pub fn upscale(spec: &Spec, factor: u32) -> Result<(Spec, Rule), UpscaleError> {
    upscale_keeping(spec, factor, None)
}

/// The same, keeping what is asked for.
///
/// # Errors
/// Why it has none.
pub fn upscale_keeping(
    spec: &Spec,
    factor: u32,
    keep: Option<Keep>,
) -> Result<(Spec, Rule), UpscaleError> {
    if factor < 2 {
        return Err(UpscaleError::Factor(factor));
    }
    let (kind, fine) = lattice(spec)?;
    if spec.materials.len() != 1 && spec.potential().is_none() {
        return Err(UpscaleError::SeveralMaterials);
    }
    let n = f64::from(factor);
    let mut coarse = spec.clone();
    match &mut coarse.body {
        BodySpec::Lattice { spacing, .. } | BodySpec::Sites { spacing, .. } => *spacing *= n,
        BodySpec::Cloud(_) | BodySpec::Several(_) => return Err(UpscaleError::NoLattice),
    }
    coarse.family = FamilyChoice::Stencil;
    let divided = |horizon: Horizon| -> Result<Horizon, UpscaleError> {
        match horizon {
            Horizon::Ratio(m) if m.is_multiple_of(factor) => Ok(Horizon::Ratio(m / factor)),
            Horizon::Ratio(m) => Err(UpscaleError::NotDivisible {
                what: "the number of neighbours N =",
                number: m,
                factor,
                choices: divisors(m),
            }),
            Horizon::Length(d) if d < fine * n * kind.nearest() => {
                Err(UpscaleError::BeyondHorizon {
                    spacing: fine * n * kind.nearest(),
                    horizon: d,
                    most: (d / (fine * kind.nearest())) as u32,
                })
            }
            length @ Horizon::Length(_) => Ok(length),
        }
    };
    let grown = |horizon: Horizon| match horizon {
        Horizon::Length(d) => Horizon::Length(n * d),
        ratio @ Horizon::Ratio(_) => ratio,
    };
    let shells = keep == Some(Keep::Shells);
    let rule = match &spec.materials[0].law {
        LawSpec::Atoms(_) if has_basis_or_fans(spec) => {
            if keep == Some(Keep::Reach) {
                return Err(UpscaleError::NoReach);
            }
            atoms::grow(spec, &mut coarse, n)?;
            Rule::Shells
        }
        LawSpec::Atoms(potential) => {
            let fixed = !current(spec) && potential.cut_off().is_infinite();
            let kept = match fixed && !shells {
                true => keeping_reach(potential, (kind, fine, n), spec.horizon, &divided)?,
                false => None,
            };
            match kept {
                Some((potential, horizon)) => {
                    coarse.horizon = horizon;
                    coarse.materials[0].law = LawSpec::Atoms(potential);
                    Rule::Reduced
                }
                None if keep == Some(Keep::Reach) => return Err(UpscaleError::NoReach),
                None => {
                    let energy = n.powi(kind.dimension() as i32);
                    let scaled = potential.scaled(n, energy);
                    coarse.materials[0].law =
                        LawSpec::Atoms(scaled.map_err(CrystalError::Potential)?);
                    coarse.horizon = match current(spec) {
                        true => Horizon::Length(REACH * n * potential.cut_off()),
                        false => grown(spec.horizon),
                    };
                    Rule::Shells
                }
            }
        }
        LawSpec::Pmb(c) | LawSpec::Springs(c)
            if shells && matches!(c, PmbStiffness::Micromodulus(_)) =>
        {
            return Err(UpscaleError::Micromodulus);
        }
        _ if shells => {
            coarse.horizon = grown(spec.horizon);
            Rule::Shells
        }
        _ => {
            coarse.horizon = divided(spec.horizon)?;
            Rule::Horizon
        }
    };
    // increments of a load are not steps in time
    if spec.schedule.statics().is_none() {
        let longer = match spec.dimension {
            1 => longer::<1>(spec, &coarse)?,
            2 => longer::<2>(spec, &coarse)?,
            _ => longer::<3>(spec, &coarse)?,
        };
        coarse.schedule = Schedule {
            // as near to the same end as whole steps are
            steps: match spec.schedule.steps {
                0 => 0,
                steps => ((steps as f64 / longer).round() as u64).max(1),
            },
            time_step: match spec.schedule.time_step {
                TimeStep::Fixed(dt) => TimeStep::Fixed(dt * longer),
                TimeStep::Fraction(x) => TimeStep::Fraction(x),
                TimeStep::Auto => TimeStep::Auto,
            },
            ..spec.schedule
        };
    }
    crate::homogenize::surface::renew(&mut coarse)?;
    Ok((coarse, rule))
}

/// How many times as long a step of the coarse model is: as its bound of stable steps is to that of the fine one (seleson2009 (4.13)), and no more than
/// what leaves it the same part of its own limit where that bound is far off.
fn longer<const D: usize>(fine: &Spec, coarse: &Spec) -> Result<f64, UpscaleError> {
    let of = |spec: &Spec| -> Result<[f64; 2], UpscaleError> {
        let (crystal, _) = crystal::<D>(spec)?;
        let sharp = crystal.largest(if D == 3 { 8 } else { 32 }).time_step();
        Ok([crystal.bound(), sharp])
    };
    let ([bound, limit], [coarse_bound, coarse_limit]) = (of(fine)?, of(coarse)?);
    let sharp = coarse_limit / limit;
    let by_bounds = coarse_bound / bound;
    let safe = match fine.schedule.time_step {
        TimeStep::Fixed(dt) => dt * by_bounds <= SAFE * coarse_limit,
        TimeStep::Fraction(_) | TimeStep::Auto => false,
    };
    Ok(if safe { by_bounds } else { sharp })
}

/// Part of the stability limit of a perfect crystal up to which a step is taken by the rule of bounds.
const SAFE: f64 = 0.95;

/// The potential with the same reach at `n` times the spacing, and its horizon; `None`: its form does not allow that.
fn keeping_reach(
    potential: &PotentialSpec,
    (kind, fine, n): (LatticeKind, f64, f64),
    horizon: Horizon,
    divided: &dyn Fn(Horizon) -> Result<Horizon, UpscaleError>,
) -> Result<Option<(PotentialSpec, Horizon)>, UpscaleError> {
    let before = Stencil::new(kind, fine, horizon);
    let with = |after: &Stencil| {
        let found = potential.keeping_reach(&KeptReach {
            factor: n,
            dimension: kind.dimension(),
            fine: &before,
            coarse: after,
        });
        found.map_err(CrystalError::Potential)
    };
    // does its form allow it at all?
    if with(&before)?.is_none() {
        return Ok(None);
    }
    let horizon = divided(horizon)?;
    let after = Stencil::new(kind, fine * n, horizon);
    Ok(with(&after)?.map(|p| (p, horizon)))
}

struct OfPotential<const D: usize> {
    kind: LatticeKind,
    spacing: f64,
    mass: f64,
    reach: Reach,
}

impl<const D: usize> Visitor for OfPotential<D> {
    type Out = Result<(Crystal<D>, Reference), CrystalError>;
    fn visit<P: Potential>(self, potential: P) -> Self::Out {
        Crystal::of_potential(&potential, self.kind, self.spacing, self.mass, self.reach)
    }
}

/// The perfect crystal of a lattice spec about its reference; of atoms also what that reference is.
pub fn crystal<const D: usize>(
    spec: &Spec,
) -> Result<(Crystal<D>, Option<Reference>), UpscaleError> {
    let (kind, spacing) = lattice(spec)?;
    let density = spec.materials[0].density;
    match spec.potential() {
        Some(_) if has_basis_or_fans(spec) => {
            let (crystal, reference) = Atoms::<D>::of(spec)?.crystal()?;
            Ok((crystal, Some(reference)))
        }
        None if spec.materials.len() > 1 => Err(UpscaleError::SeveralMaterials),
        Some(potential) => {
            let volume = kind.site_volume() * spacing.powi(D as i32) * spec.section;
            let of = OfPotential::<D> {
                kind,
                spacing,
                mass: density * volume,
                reach: reach(spec),
            };
            let (crystal, reference) = potential.apply(of).map_err(CrystalError::Potential)??;
            Ok((crystal, Some(reference)))
        }
        None => {
            let mut solid = LatticeSolid::new(kind, spacing, spec.horizon);
            solid.section = spec.section;
            solid.density = density;
            solid.influence = spec.influence;
            solid.volume_scaling = spec.volume_scaling;
            let crystal = solid.of_law(&spec.materials[0].law, spec.plane, spec.calibration)?;
            Ok((crystal, None))
        }
    }
}
