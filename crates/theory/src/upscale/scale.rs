//! Coarse specifications of fine ones.

use super::atoms::has_basis_or_many_body;
use super::crystal::crystal;
use super::error::UpscaleError;
use super::reference::{REACH, current, lattice};
use crate::crystal::CrystalError;
use peridyne::family::stencil::Stencil;
use peridyne::law::potential::KeptReach;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{
    BodySpec, FamilyChoice, Horizon, LawSpec, PmbStiffness, PotentialSpec, Schedule, Spec, TimeStep,
};

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
    coarse.bonds.family = FamilyChoice::Stencil;
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
        LawSpec::Atoms(_) if has_basis_or_many_body(spec) => {
            if keep == Some(Keep::Reach) {
                return Err(UpscaleError::NoReach);
            }
            super::atoms::grow(spec, &mut coarse, n)?;
            Rule::Shells
        }
        LawSpec::Atoms(potential) => {
            let fixed = !current(spec) && potential.cut_off().is_infinite();
            let kept = match fixed && !shells {
                true => keeping_reach(potential, (kind, fine, n), spec.bonds.horizon, &divided)?,
                false => None,
            };
            match kept {
                Some((potential, horizon)) => {
                    coarse.bonds.horizon = horizon;
                    coarse.materials[0].law = LawSpec::Atoms(potential);
                    Rule::Reduced
                }
                None if keep == Some(Keep::Reach) => return Err(UpscaleError::NoReach),
                None => {
                    let energy = n.powi(kind.dimension() as i32);
                    let scaled = potential.scaled(n, energy);
                    coarse.materials[0].law =
                        LawSpec::Atoms(scaled.map_err(CrystalError::Potential)?);
                    coarse.bonds.horizon = match current(spec) {
                        true => Horizon::Length(REACH * n * potential.cut_off()),
                        false => grown(spec.bonds.horizon),
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
            coarse.bonds.horizon = grown(spec.bonds.horizon);
            Rule::Shells
        }
        _ => {
            coarse.bonds.horizon = divided(spec.bonds.horizon)?;
            Rule::Horizon
        }
    };
    // increments of a load are not steps in time
    if spec.run.schedule.statics().is_none() {
        let longer = match spec.space.dimension {
            1 => longer::<1>(spec, &coarse)?,
            2 => longer::<2>(spec, &coarse)?,
            _ => longer::<3>(spec, &coarse)?,
        };
        coarse.run.schedule = Schedule {
            // as near to the same end as whole steps are
            steps: match spec.run.schedule.steps {
                0 => 0,
                steps => ((steps as f64 / longer).round() as u64).max(1),
            },
            time_step: match spec.run.schedule.time_step {
                TimeStep::Fixed(dt) => TimeStep::Fixed(dt * longer),
                TimeStep::Fraction(x) => TimeStep::Fraction(x),
                TimeStep::Auto => TimeStep::Auto,
            },
            ..spec.run.schedule
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
    let safe = match fine.run.schedule.time_step {
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
