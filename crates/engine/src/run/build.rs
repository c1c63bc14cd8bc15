//! From a specification to a model: the only place that matches on dimension, law and family.

use super::accounts::state::Accounts;
use super::atoms;
use super::bind::{bind, names};
use super::clock::Clock;
use super::clouds::{own_densities, own_velocities};
use super::constitutive::{Shelf, breaks, criteria, directed};
use super::equilibrium::state::StaticState;
use super::faces::Faces;
use super::feasible::{consistent, enough_memory, possible};
use super::implicit;
use super::implicit::state::Implicit;
use super::inertia::state::Inertia;
use super::model::Model;
use super::parts::{Part, parts};
use super::reference::current_neighbours;
use super::sets::{assign_materials, initial, sets};
use super::time_step::{Limits, time_step};
use super::transfers::state::Transfers;
use super::{Info, Simulation, Steered};
use super::{bonds, indenters, own_horizons, precracks, surface, transfers};
use super::{contact, gaps, meant};
use crate::body::{Values, zeros};
use crate::condition::applied::AppliedForces;
use crate::condition::prescribed_motion::PrescribedMotion;
use crate::dynamics::verlet::Verlet;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::nodes::Nodes;
use crate::interaction::atoms::smoothed::Smoothed;
use crate::interaction::{ContactForces, Interaction};
use crate::message;
use crate::quantity::{Dimension, Warnings, rounded};
use crate::spec::{BodySpec, Control, FamilyChoice, Horizon, LawSpec, Spec, Stepper, TimeStep};
use crate::statics::SYMMETRIC;

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
    build_with(spec, options, &Shelf::standard())
}

/// The same with laws, potentials, observables and forces of one's own.
pub fn build_with(
    spec: &Spec,
    options: Options,
    shelf: &Shelf,
) -> Result<Box<dyn Simulation>, BuildError> {
    possible(spec, options.simd)?;
    match spec.dimension {
        1 => Ok(Box::new(build_in::<1>(spec, options, shelf)?)),
        2 => Ok(Box::new(build_in::<2>(spec, options, shelf)?)),
        3 => Ok(Box::new(build_in::<3>(spec, options, shelf)?)),
        d => Err(BuildError::invalid(
            "dimension",
            format!("{d} dimensions; expected 1, 2 or 3"),
        )),
    }
}

/// Build the model of a spec in D dimensions.
pub fn build_in<const D: usize>(
    spec: &Spec,
    options: Options,
    shelf: &Shelf,
) -> Result<Model<D>, BuildError> {
    let mut resolved = spec.clone();
    shelf.resolve(&mut resolved)?;
    let expanding = transfers::expanding(&mut resolved);
    let own = own_horizons::resolve(&mut resolved);
    let directed = directed(&mut resolved)?;
    if criteria::remembering(&mut resolved)? || expanding || own || directed {
        shelf.resolve(&mut resolved)?;
    }
    consistent(&resolved)?;
    let potentials = shelf.potentials(&resolved)?;
    atoms::check_smooth(&resolved, potentials.is_some())?;
    atoms::resolve_family(&mut resolved, potentials.as_ref())?;
    let spec = &resolved;
    let simd = options.simd.unwrap_or_else(Simd::detect);
    let mut warnings = Warnings::default();
    let (mut parts, mut body) = parts::<D>(spec)?;
    match (&potentials, spec.family) {
        (Some(potentials), _) if current_neighbours(spec) => {
            atoms::check_box(potentials, &body.period)?;
            parts[0].horizon = potentials.reach;
        }
        (Some(_), FamilyChoice::Reference) => {
            atoms::check_periods("horizon", "horizon", parts[0].horizon, &body.period)?;
        }
        _ => {}
    }
    let bonded_horizons = || parts.iter().filter(|p| p.bonded).map(|p| p.horizon);
    let horizon = bonded_horizons()
        .reduce(f64::max)
        .unwrap_or(parts[0].horizon);
    // within a body all pairs nearer than this are a family
    let mut least_horizon = bonded_horizons().fold(horizon, f64::min);
    for (n, part) in parts.iter().enumerate().filter(|(_, p)| p.bonded) {
        let own = body.pieces().get(n).map_or(&body, |p| &p.body);
        let atoms = current_neighbours(spec);
        enough_memory(own, part.stencil.as_ref(), part.horizon, atoms)?;
    }
    let smoothed = match &spec.smooth {
        None => None,
        Some(smooth) => {
            let (nodes, carried) = Nodes::new(&body, smooth)?;
            let mut atoms = std::mem::replace(&mut body, nodes);
            atoms.density = Values::Uniform(spec.materials[0].density);
            own_densities(spec, &mut atoms);
            Some((atoms, carried))
        }
    };
    let carriers = match spec.micromoduli() {
        Some(linear) => (**linear).clone().of::<D>().and_then(|l| l.carriers),
        None => None,
    };
    let (sets, carrier_sets) = sets(spec, &body, carriers.as_ref())?;
    assign_materials(spec, &mut body, &sets)?;
    match &smoothed {
        None => own_densities(spec, &mut body),
        Some((atoms, carried)) => carried.give_masses(atoms, &mut body),
    }
    own_horizons::give(spec, &mut body, horizon)?;
    if !body.horizon.is_empty() {
        let own = body.slots.iter().map(|s| body.horizon[*s as usize]);
        least_horizon = own.fold(least_horizon, f64::min);
    }
    let by_length = |p: &&Part| matches!(p.spec.horizon, Horizon::Length(_));
    let ends = parts.iter().filter(by_length).flat_map(|p| &p.stencil);
    let ends: u64 = ends.map(|s| s.near_horizon as u64).sum();
    if let (Some(potentials), BodySpec::Lattice { kind, spacing, .. }) = (&potentials, &spec.body) {
        warnings.extend(atoms::crystal(spec, potentials, *kind, *spacing)?);
    }
    let (mut constitutive, mut interaction) = match smoothed {
        None => bind(spec, &mut parts, &mut body, shelf, simd, &mut warnings)?,
        Some((mut atoms, carried)) => {
            let (constitutive, inner) =
                bind(spec, &mut parts, &mut atoms, shelf, simd, &mut warnings)?;
            let made = Smoothed::new(&body, atoms, inner, carried, breaks(spec));
            let made: Box<dyn Interaction<D>> = Box::new(made);
            (constitutive, made)
        }
    };
    let cell_volume = body.volume.uniform();
    if let Some(factors) = &spec.surface {
        surface::scale(factors, &mut body, interaction.as_mut())?;
        warnings.extend(factors.warning.clone());
    }
    warnings.extend(bonds::scale(spec, &body, interaction.as_mut())?);
    // a ratio is meant inclusively; only a length leaves the decision to round-off
    let ratios = constitutive.all().filter(|m| m.ratio).count();
    let near_horizon = match ratios {
        0 => ends.max(interaction.near_horizon()),
        // lists do not say whose bonds they count
        _ => ends,
    };
    if near_horizon > 0 {
        let what = if ends > 0 {
            "bonds of the stencil"
        } else {
            "directed bonds"
        };
        warnings.push(message![
            format!("{near_horizon} {what} end within round-off of the horizon "),
            Dimension::LENGTH.of(horizon),
            ": a larger or smaller number in its last digits changes the family; write the horizon as a whole number of spacings (m_ratio), or well between two distances",
        ]);
    }
    let solid = spec.potential().is_none() && spec.micromoduli().is_none();
    let separate = match solid {
        true => gaps::across(spec, &body, interaction.as_ref()),
        false => vec![],
    };
    let solid = solid && separate.is_empty();
    warnings.extend(separate);
    let cut = precracks::cut(spec, &body, interaction.as_mut(), &mut warnings)?;
    if solid {
        warnings.extend(gaps::bridged(&body, interaction.as_ref()));
    }
    if potentials.is_some() && breaks(spec) {
        warnings.push(
            "atoms feel those of their family in the reference whose bonds are whole, and nobody else: parts that come apart and meet again go through each other",
        );
    }
    warnings.extend(meant::regions(spec, &body));
    warnings.extend(meant::periods(spec, &body)?);
    warnings.extend(meant::sets(spec, &body, &sets));
    if { spec.contact.as_ref() }.is_some_and(|c| c.conductance.is_some())
        && spec.materials.iter().any(|m| m.fracture.is_some())
    {
        warnings.push(
            "contact conducts heat between points that were never bonded: none crosses a crack, whether its faces touch or not",
        );
    }
    let asymmetry = interaction.asymmetry();
    if asymmetry > SYMMETRIC {
        warnings.push(format!(
            "action is not reaction in this body (asymmetry {}): it has no energy, what is printed as strain energy is that of its symmetric part, and neither energy nor momentum need balance",
            rounded(asymmetry, 2)
        ));
    }
    let directed_bonds = interaction.directed_bonds();
    let bonded = parts.iter().any(|p| p.bonded);
    if cut > 0 && directed_bonds <= cut && precracks::left(&body, interaction.as_ref()) == 0 {
        let message = format!(
            "the pre-crack cuts all bonds: none of the {} between {} points is left",
            cut / 2,
            body.points()
        );
        return Err(BuildError::empty("precracks[0]", message).help(
            "make it shorter than the body, or the spacing smaller; parts that nothing holds together are bodies of their own",
        ));
    }
    if directed_bonds == 0 && body.points() > 1 && bonded && body.points() > body.pieces().len() {
        return Err(BuildError::empty(
            "horizon",
            message![
                format!("no two of the {} points are within the horizon ", body.points()),
                Dimension::LENGTH.of(horizon),
            ],
        )
        .help(message![
            "the spacing is ",
            Dimension::LENGTH.of(body.spacing),
            ": a horizon of three spacings is usual; points that only touch are a body with bonded = false",
        ]));
    }
    let repulsion = contact::repulsion(spec, &parts, &constitutive, &body)?;
    let range = |a: usize, b: usize| repulsion.as_ref().map_or(0.0, |r| r.range(a, b));
    let reach = (0..parts.len())
        .map(|n| range(n, n))
        .fold(horizon, f64::max);
    let gaps = gaps::between(&body, reach, range);
    let spacing = |n: usize| body.pieces()[n].body.spacing;
    warnings.extend(gaps::warnings(spec, &gaps, spacing));
    if spec.healing.is_some() {
        // a step is stable when all is whole again
        let rest = body.at_rest();
        interaction.mend(&body, &rest, &|_, _, _| true);
    }
    let inertia = Inertia::of(spec, &body)?;
    let limits = match options.trust_time_step
        || spec.schedule.statics().is_some()
        || spec.schedule.stepper == Stepper::Still
    {
        true => Limits::UNKNOWN,
        false => Limits::of(
            spec,
            (&parts, &constitutive),
            (&body, inertia.as_ref()),
            interaction.as_mut(),
            cell_volume,
            repulsion.as_ref(),
        )?,
    };
    interaction.begin_steps(&body);
    if spec.healing.is_some() {
        precracks::cut(spec, &body, interaction.as_mut(), &mut Warnings::default())?;
    }
    let points = body.points();
    let dt = time_step(spec, points, &limits, repulsion.as_ref(), &mut warnings)?;
    let sizes = body
        .slots
        .iter()
        .map(|s| interaction.family_size(&body, *s as usize));
    let (smallest, largest) = sizes.fold((usize::MAX, 0), |(a, b), n| (a.min(n), b.max(n)));
    let u = body.at_rest();
    constitutive.forget_stencils(); // the interaction has them
    let kinds = |law: &LawSpec| matches!(law, LawSpec::Named(law) if shelf.kinds(&law.name));
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
            // bonds of several kinds have no single one
            micromodulus: match spec.materials.iter().any(|m| kinds(&m.law)) {
                true => vec![],
                false => constitutive.micromoduli(spec.materials.len()),
            },
            critical_stretch: constitutive.critical_stretches(spec.materials.len()),
            families: constitutive.families(spec.materials.len()),
            time_step: dt,
            stepper: spec.schedule.stepper,
            stable_step: limits.stable(),
            contact_step: limits.contact,
            contact_stiffness: repulsion.as_ref().map_or(vec![], |r| r.stiffness()),
            parts: 1,
            conserves: asymmetry <= SYMMETRIC && !spec.schedule.force_unstable,
            bodies: names(spec, &body),
            gaps,
            transfers: vec![],
            loads: vec![],
            cut,
            bytes: 0,
            simd: simd.name(),
            warnings,
        },
        v: zeros(body.len),
        f: zeros(body.len),
        u,
        verlet: Verlet::new(simd, &body),
        inertia,
        contact: match repulsion {
            None => None,
            Some(r) => {
                let pairs = constitutive.first().pairs.as_ref();
                let horizon = pairs.map_or(least_horizon, |p| p.shortest());
                Some(ContactForces {
                    central: r.contact(&parts, &body, horizon),
                    friction: contact::friction(spec, &body)?,
                })
            }
        },
        toughness: None,
        healing: None,
        boltzmann: spec.boltzmann,
        release: spec.release,
        stop: || false,
        constitutive,
        shelf: shelf.clone(),
        interaction,
        body,
        prescribed: PrescribedMotion::default(),
        applied: AppliedForces::default(),
        fastest: 0.0,
        watch: false,
        watched: None,
        watch_virial: false,
        virial: None,
        watch_virials: false,
        virials: None,
        probes: vec![],
        sets,
        faces: Faces::new(spec)?,
        carriers,
        carrier_sets,
        clock: Clock::new(dt),
        fraction: match spec.schedule.time_step {
            TimeStep::Fixed(_) => None,
            TimeStep::Fraction(_) | TimeStep::Auto => Some(dt / limits.bond).filter(|x| *x > 0.0),
        },
        pending: false,
        stale: false,
        accounts: Accounts::default(),
        fault: None,
        statics: None,
        preload: None,
        loaded: None,
        implicit: None,
        stands: false,
        transfers: Transfers::default(),
    };
    if let Some(thermal) = &spec.thermal {
        model.heat(thermal)?;
    }
    if let Some(velocity) = own_velocities(spec, &model.body) {
        model.set_velocities(&velocity);
    }
    initial(spec, &mut model)?;
    if let (TimeStep::Auto, Some(potentials)) = (spec.schedule.time_step, &potentials) {
        let dt = dt.min(model.step_of_speeds(potentials)?);
        model.clock = Clock::new(dt);
        model.info.time_step = dt;
    }
    model.make_transfers(spec)?;
    if spec.schedule.stepper == Stepper::Still {
        model.stand_for(spec)?;
    }
    model.info.bytes = model.bytes();
    model.check_fields(spec.fields.as_deref().unwrap_or_default())?;
    let sets = std::mem::take(&mut model.sets);
    indenters::check(spec, &model.body)?;
    model.set_conditions(&spec.conditions, &sets, &spec.indenters)?;
    model.toughness = model.toughness_of(spec, shelf, &sets)?;
    model.healing = model.healing_of(spec, &sets)?;
    // how long a run of a given duration is, its caller knows
    let steps = match spec.schedule.steps {
        0 => 1000,
        steps => steps,
    };
    let end = steps as f64 * dt;
    model.check_agreement(&spec.conditions, end)?;
    let told = Model::tell_loads(&model.body, &mut model.applied.loads, &spec.conditions, end);
    model.info.loads.extend(told);
    let torn = model.torn(end);
    model.info.warnings.extend(torn);
    match spec.schedule.stepper {
        Stepper::Verlet | Stepper::Still => {}
        Stepper::Newmark(newmark) => {
            model.check_implicit(newmark, spec)?;
            let mut made = Implicit::new(newmark);
            made.breaks = implicit::breaks(spec);
            let reach = model.info.horizon / model.info.spacing;
            if made.breaks && dt > reach * limits.bond {
                model.info.warnings.push(message![
                    "bonds break at the end of a step: a crack grows by no more than a horizon in each, and a wave goes further than that in ",
                    Dimension::TIME.of(dt),
                    "; where cracks run, steps of ",
                    Dimension::TIME.of(reach * limits.bond),
                    " follow them",
                ]);
            }
            model.implicit = Some(made);
        }
        Stepper::Statics(statics) => {
            if spec.schedule.steps > 0 {
                model.check_statics(statics)?;
                match statics.control {
                    Control::Load => {}
                    Control::Breaking => model.check_sequence(statics, spec)?,
                    Control::Opening(_) | Control::ArcLength(_) => {
                        model.check_path(statics, spec, shelf)?;
                    }
                }
            }
            model.statics = Some(StaticState::new(statics));
        }
    }
    if let Some(preload) = &spec.preload {
        model.prepare_preload(preload, &sets)?;
    }
    model.sets = sets;
    model.probes = model.probes_of(&spec.probes)?;
    Ok(model)
}
