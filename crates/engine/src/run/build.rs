//! From a specification to a model: the only place that matches on dimension, law and family.

use super::atoms;
use super::calibration::cloud_moments;
use super::equilibrium::StaticState;
use super::model::Model;
use super::probe;
use super::recipe::{Laws, Recipe};
use super::reference::{Reference, cell, current_neighbours, reference};
use super::sets::{assign_materials, initial, sets};
use super::{Info, Simulation};
use super::{bonds, surface};
use crate::body::{Values, zeros};
use crate::condition::still::Still;
use crate::dynamics::verlet::Verlet;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::fracture::precrack::Crack;
use crate::interaction::contact::Contact;
use crate::law::micromodulus::Moments;
use crate::spec::{
    BodySpec, Calibration, CrackKind, LawSpec, MaterialSpec, PmbStiffness, Spec, TimeStep,
};

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
    if !spec.pairs.is_empty() && spec.schedule.statics.is_some() {
        return Err(BuildError::new(
            "pairs",
            "pairs of materials with constants of their own move in time; there is no statics of them",
        ));
    }
    if let Some(simd) = options.simd
        && !Simd::available().contains(&simd)
    {
        return Err(BuildError::new(
            "simd",
            format!("this machine has no {}", simd.name()),
        ));
    }
    match spec.dimension {
        1 => Ok(Box::new(build_in::<1>(spec, options)?)),
        2 => Ok(Box::new(build_in::<2>(spec, options)?)),
        3 => Ok(Box::new(build_in::<3>(spec, options)?)),
        d => Err(BuildError::new(
            "dimension",
            format!("{d} dimensions; expected 1, 2 or 3"),
        )),
    }
}

/// Build the model of a spec in D dimensions.
pub fn build_in<const D: usize>(spec: &Spec, options: Options) -> Result<Model<D>, BuildError> {
    let simd = options.simd.unwrap_or_else(Simd::detect);
    let mut warnings = vec![];
    let Reference {
        mut body,
        stencil,
        bulk,
        mut horizon,
    } = reference::<D>(spec)?;
    if let Some(potential) = &spec.potential
        && current_neighbours(spec)
    {
        atoms::check_box(potential, &body.period)?;
        horizon = potential.cut_off();
    }
    let cell = cell(spec, &body);
    let from_modulus = |m: &MaterialSpec| {
        use PmbStiffness::{Bulk, Young};
        matches!(m.law, LawSpec::Pmb(Bulk(_) | Young(_)))
    };
    let mut bulk = bulk;
    if bulk.is_none()
        && spec.calibration == Calibration::Discrete
        && spec.materials.iter().any(from_modulus)
    {
        bulk = cloud_moments(spec, &body, horizon, cell)?;
        if bulk.is_none() {
            warnings.push(
                "no point of this cloud has a full family to calibrate to, all are closer to the surface than the horizon: the constants are those of the continuum".into(),
            );
        }
    }
    let discrete =
        bulk.unwrap_or_else(|| Moments::continuum(D, horizon, spec.section, spec.influence));
    let sets = sets(spec, &body)?;
    assign_materials(spec, &mut body, &sets)?;
    if let BodySpec::Cloud(cloud) = &spec.body
        && !cloud.density.is_empty()
    {
        body.density = Values::from_points(&cloud.density, &body.slots, body.len, 1.0);
    }
    let ends = stencil.as_ref().map_or(0, |s| s.near_horizon as u64);
    if let (Some(potential), BodySpec::Lattice { kind, spacing, .. }) =
        (&spec.potential, &spec.body)
    {
        warnings.extend(atoms::crystal(spec, potential, *kind, *spacing)?);
    }
    let mut recipe = Recipe::new::<D>(spec, stencil, horizon, cell, discrete, simd)?;
    let mut interaction = recipe.interaction(&body, None)?;
    let cell_volume = body.volume.uniform();
    if let Some(factors) = &spec.surface {
        surface::scale(factors, &mut body, interaction.as_mut())?;
        warnings.extend(factors.warning.clone());
    }
    warnings.extend(bonds::scale(spec, &body, interaction.as_mut())?);
    // a ratio is meant inclusively; only a length leaves the decision to round-off
    let near_horizon = if recipe.ratio {
        0
    } else {
        ends.max(interaction.near_horizon())
    };
    if near_horizon > 0 {
        let what = if ends > 0 {
            "bonds of the stencil"
        } else {
            "directed bonds"
        };
        warnings.push(format!(
            "{near_horizon} {what} end within round-off of the horizon {horizon:e}: a larger or smaller number in its last digits changes the family; write the horizon as a whole number of spacings (m_ratio), or well between two distances"
        ));
    }
    let mut cut = 0;
    for kind in [CrackKind::Absent, CrackKind::Broken] {
        if kind == CrackKind::Broken {
            interaction.prepare(&body);
        }
        for (n, crack) in spec
            .precracks
            .iter()
            .enumerate()
            .filter(|(_, c)| c.kind == kind)
        {
            let shape = Crack::new(&crack.shape, body.period).map_err(|e| BuildError {
                path: format!("precracks[{n}]"),
                ..e
            })?;
            let count = interaction.cut(&body, kind, &|from, to| shape.crosses(&from, &to));
            if count == 0 {
                warnings.push(format!("pre-crack {} cuts no bond", n + 1));
            }
            cut += count;
        }
    }
    let directed_bonds = interaction.directed_bonds();
    if directed_bonds == 0 && body.points() > 1 {
        return Err(BuildError::new(
            "horizon",
            format!(
                "no two of the {} points are within the horizon {horizon:e}",
                body.points()
            ),
        )
        .help(format!(
            "the spacing is {:e}: a horizon of three spacings is usual",
            body.spacing
        )));
    }
    let stable_step = if options.trust_time_step || spec.schedule.statics.is_some() {
        f64::INFINITY
    } else {
        probe::stable_step(&recipe, &body, interaction.as_mut(), spec, cell_volume)?
    };
    let dt = match spec.schedule.time_step {
        TimeStep::Fraction(x) if stable_step.is_finite() => x * stable_step,
        TimeStep::Fraction(_) if body.points() == 1 => {
            return Err(BuildError::new(
                "body",
                "the body has one point, and a point alone has no bonds",
            )
            .help("a larger region or a smaller spacing"));
        }
        TimeStep::Fraction(_) => {
            return Err(BuildError::new(
                "schedule.time_step",
                "nothing resists: no stable step can be derived",
            )
            .help("give time_step as a number"));
        }
        TimeStep::Fixed(dt) => dt,
    };
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(BuildError::new(
            "schedule.time_step",
            format!("the time step is {dt}, expected a positive number"),
        ));
    }
    if dt > stable_step {
        let message = format!(
            "the time step {dt:.4e} is above the stability limit {stable_step:.4e} of this body"
        );
        if !spec.schedule.force_unstable {
            return Err(BuildError::new("schedule.time_step", message)
                .help(format!("write time_step = {:.3e} or \"auto\"; force_unstable = true under [run] runs it all the same", 0.8 * stable_step)));
        }
        warnings.push(message);
    }
    let sizes = body
        .slots
        .iter()
        .map(|s| interaction.family_size(&body, *s as usize));
    let (smallest, largest) = sizes.fold((usize::MAX, 0), |(a, b), n| (a.min(n), b.max(n)));
    let u = body.at_rest();
    recipe.stencil = None; // the interaction has it
    let mut model = Model {
        info: Info {
            dimension: D,
            points: body.points() as u64,
            directed_bonds,
            family: (
                smallest,
                directed_bonds as f64 / body.points() as f64,
                largest,
            ),
            family_kind: interaction.family(),
            near_horizon,
            horizon,
            spacing: body.spacing,
            section: spec.section,
            mass: body.mass(),
            volume: body.slots.iter().map(|s| body.volume.at(*s as usize)).sum(),
            micromodulus: if let Laws::Bond(c) = &recipe.laws {
                c.clone()
            } else {
                vec![]
            },
            critical_stretch: recipe.toughness.iter().map(|t| t.s00).collect(),
            time_step: dt,
            stable_step,
            cut,
            bytes: 0,
            simd: simd.name(),
            warnings,
        },
        v: zeros(body.len),
        f: zeros(body.len),
        u,
        verlet: Verlet::new(simd, &body),
        contact: recipe.repulsion.clone().map(|r| {
            let pairs = recipe.pairs.as_ref();
            Contact::new(r, &body, pairs.map_or(horizon, |p| p.shortest()))
        }),
        release: spec.release,
        recipe,
        interaction,
        body,
        loads: vec![],
        constraints: vec![],
        driven: vec![],
        still: Still::new(vec![]),
        watch: false,
        watched: None,
        watch_virial: false,
        virial: None,
        indenters: vec![],
        sets,
        dt,
        step: 0,
        origin: (0, 0.0),
        pending: false,
        broken: 0,
        released: 0.0,
        past_work: [0.0; 3],
        initial_energy: None,
        fault: None,
        statics: None,
    };
    model.info.bytes = model.bytes();
    if let Some(thermal) = spec.thermal {
        model.heat(thermal);
    }
    if let BodySpec::Cloud(cloud) = &spec.body
        && !cloud.velocity.is_empty()
    {
        model.set_velocities(&cloud.velocity);
    }
    initial(spec, &mut model)?;
    let sets = std::mem::take(&mut model.sets);
    model.set_conditions(&spec.conditions, &sets, &spec.indenters)?;
    model.sets = sets;
    // how long a run of a given duration is, its caller knows
    let steps = match spec.schedule.steps {
        0 => 1000,
        steps => steps,
    };
    model.check_agreement(&spec.conditions, steps as f64 * dt)?;
    if let Some(statics) = spec.schedule.statics {
        if spec.schedule.steps > 0 {
            model.check_statics(statics)?;
        }
        model.statics = Some(StaticState::new(statics));
    }
    Ok(model)
}
