//! From a specification to a model: the only place that matches on dimension, law and family.

mod bodies;
mod bonds;
mod made;

use self::bodies::Bodies;
use self::bonds::Bonds;
use self::made::Made;
use super::model::Model;
use super::sanity::{consistent, possible};
use super::stages::Stages;
use super::stepper::stepper;
use super::{Simulation, atoms};
use crate::constitutive::Registry;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::quantity::Warnings;
use crate::spec::Spec;
use peridyne_comm::Comm;
use std::sync::Arc;

/// How to build, as opposed to what.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Instruction set; `None` takes the widest there is.
    pub simd: Option<Simd>,
    /// Leave the stability limit unmeasured (a fixed step is then taken as it is).
    pub trust_time_step: bool,
}

/// Build the model of a spec.
pub fn build(spec: &Spec, options: Options) -> Result<Box<dyn Simulation>, BuildError> {
    build_with(spec, options, &Registry::standard())
}

/// The same with laws, potentials, observables and forces of one's own.
pub fn build_with(
    spec: &Spec,
    options: Options,
    registry: &Registry,
) -> Result<Box<dyn Simulation>, BuildError> {
    possible(spec, options.simd)?;
    match spec.space.dimension {
        1 => Ok(Box::new(build_in::<1>(spec, options, registry)?)),
        2 => Ok(Box::new(build_in::<2>(spec, options, registry)?)),
        3 => Ok(Box::new(build_in::<3>(spec, options, registry)?)),
        d => Err(BuildError::invalid(
            "dimension",
            format!("{d} dimensions; expected 1, 2 or 3"),
        )),
    }
}

fn build_in<const D: usize>(
    spec: &Spec,
    options: Options,
    registry: &Registry,
) -> Result<Model<D>, BuildError> {
    made_among(spec, options, registry, None)
}

/// The part of it that this rank has; `None`: all.
pub(super) fn made_among<const D: usize>(
    spec: &Spec,
    options: Options,
    registry: &Registry,
    ranks: Option<&Arc<Comm>>,
) -> Result<Model<D>, BuildError> {
    let mut resolved = spec.clone();
    registry.resolve(&mut resolved)?;
    consistent(&resolved, registry)?;
    let potentials = registry.potentials(&resolved)?;
    atoms::check_smooth(&resolved)?;
    if let Some(potentials) = &potentials {
        atoms::resolve_family(&mut resolved, potentials);
    }
    let spec = &resolved;
    let simd = options.simd.unwrap_or_else(Simd::detect);
    let mut warnings = Warnings::default();
    let mut bodies = Bodies::<D>::new(spec, registry, potentials.as_ref(), ranks, &mut warnings)?;
    let bonds = Bonds::new(spec, simd, &mut bodies, &mut warnings)?;
    let mut made = Made::new(
        spec,
        (simd, options.trust_time_step),
        bodies,
        bonds,
        warnings,
    )?;
    made.begin(spec, potentials.as_ref())?;
    made.act(spec)?;
    let Made {
        mut system,
        names,
        limits,
        dt,
    } = made;
    let stepper = stepper(spec, simd, &mut system, (&limits, dt))?;
    let stages = match &spec.run.preload {
        Some(preload) => system.prepare_preload(preload, &names, stepper)?,
        None => {
            system.regime = stepper.regime();
            Stages::one(stepper)
        }
    };
    let mut model = Model {
        system,
        stages,
        stale: false,
        probes: vec![],
        names,
        boltzmann: spec.loading.boltzmann,
    };
    model.probes = model.probes_of(&spec.run.probes)?;
    Ok(model)
}
