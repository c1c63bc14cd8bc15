//! From a specification to a model: the only place that matches on dimension, law and family.

use super::atoms;
use super::constitutive::{ConstitutiveModels, Shelf};
use super::equilibrium::state::StaticState;
use super::implicit::state::Implicit;
use super::interfaces::interfaces;
use super::model::Model;
use super::parts::{Part, parts};
use super::probe;
use super::reference::current_neighbours;
use super::sets::{assign_materials, initial, sets};
use super::{Info, Simulation, Steered};
use super::{bonds, surface};
use super::{contact, gaps};
use crate::body::{Body, Layout, Values, zeros};
use crate::condition::carried::Carried;
use crate::condition::still::Still;
use crate::dynamics::verlet::Verlet;
use crate::error::BuildError;
use crate::execute::memory;
use crate::execute::simd::Simd;
use crate::family::stencil::Stencil;
use crate::fracture::precrack::Crack;
use crate::interaction::Interaction;
use crate::interaction::friction::Friction;
use crate::interaction::several::SeveralInteraction;
use crate::space::Point;
use crate::space::ball_volume;
use crate::spec::{BodySpec, Cloud, CrackKind, Form, Horizon, LawSpec, Spec, Stepper, TimeStep};
use crate::statics::SYMMETRIC;

/// Part of the stability limit that peridynamic bodies run at if nobody says otherwise.
const SOLID_FRACTION: f64 = 0.8;

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

/// The same with laws of one's own.
pub fn build_with(
    spec: &Spec,
    options: Options,
    shelf: &Shelf,
) -> Result<Box<dyn Simulation>, BuildError> {
    if !spec.pairs.is_empty() && spec.schedule.stepper != Stepper::Verlet {
        return Err(BuildError::unsupported(
            "pairs",
            "pairs of materials with constants of their own have no tangents: velocity Verlet moves them, there is no statics and no implicit step",
        ));
    }
    if let Some(simd) = options.simd
        && !Simd::available().contains(&simd)
    {
        return Err(BuildError::unsupported(
            "simd",
            format!("this machine has no {}", simd.name()),
        ));
    }
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

/// Does the model fit into memory? Of bonds a stencil keeps bits, a list partners and bits, and atoms about the partners
/// of their cut-off.
fn enough_memory<const D: usize>(
    body: &Body<D>,
    stencil: Option<&Stencil>,
    horizon: f64,
    atoms: bool,
) -> Result<(), BuildError> {
    let slots = body.len as f64;
    let spacings = horizon / body.spacing;
    let (bonds, each) = match stencil {
        Some(s) => (slots * s.bonds() as f64, 0.125),
        None => {
            // no point has more partners than the ball holds, or the body
            let ball = ball_volume(D, spacings);
            // the estimate may be some times too high where bodies are thin: the list itself is counted before it is made
            let doubt = if atoms { 1.0 } else { 4.0 };
            (slots * ball.min(body.points() as f64) / doubt, 4.125)
        }
    };
    let (what, path, help) = if bonds * each > slots * 24.0 * D as f64 {
        (
            format!("{:.2e} bonds of {:.2e} points", bonds, body.points() as f64),
            "horizon",
            format!(
                "the horizon {horizon:e} is {spacings:.1} spacings: check its unit and its decimal point, and those of the \
                 spacing; three to six spacings are usual"
            ),
        )
    } else {
        (
            format!("a body of {:.2e} points", body.points() as f64),
            "body.spacing",
            "check the units of the spacing and of the region; a larger spacing makes fewer points"
                .into(),
        )
    };
    memory::afford(path, &what, slots * 24.0 * D as f64 + bonds * each, &help)
}

/// Do lists that the spec gives belong to each other?
fn consistent(spec: &Spec) -> Result<(), BuildError> {
    for (n, m) in spec.materials.iter().enumerate() {
        let fits = match &m.law {
            LawSpec::Micromoduli(body) => body.check(),
            LawSpec::Atoms(potential) => match &potential.form {
                Form::Tabulated(table) => table.check(),
                Form::LennardJones(_) | Form::Morse(_) | Form::Buckingham(_) | Form::Mei(_) => {
                    Ok(())
                }
            },
            LawSpec::Pmb(_)
            | LawSpec::Lps(_)
            | LawSpec::LpsAsTyped { .. }
            | LawSpec::EamLike { .. }
            | LawSpec::Springs(_)
            | LawSpec::Named(_) => Ok(()),
        };
        fits.map_err(|message| BuildError::invalid(format!("materials[{n}].law"), message))?;
    }
    Ok(())
}

/// Build the model of a spec in D dimensions.
pub fn build_in<const D: usize>(
    spec: &Spec,
    options: Options,
    shelf: &Shelf,
) -> Result<Model<D>, BuildError> {
    let mut resolved = spec.clone();
    shelf.resolve(&mut resolved)?;
    let spec = &resolved;
    consistent(spec)?;
    let simd = options.simd.unwrap_or_else(Simd::detect);
    let mut warnings = vec![];
    let (mut parts, mut body) = parts::<D>(spec)?;
    if let Some(potential) = spec.potential()
        && current_neighbours(spec)
    {
        atoms::check_box(potential, &body.period)?;
        parts[0].horizon = potential.cut_off();
    }
    let bonded_horizons = || parts.iter().filter(|p| p.bonded).map(|p| p.horizon);
    let horizon = bonded_horizons()
        .reduce(f64::max)
        .unwrap_or(parts[0].horizon);
    // within a body all pairs nearer than this are a family
    let least_horizon = bonded_horizons().fold(horizon, f64::min);
    for (n, part) in parts.iter().enumerate().filter(|(_, p)| p.bonded) {
        let own = body.pieces().get(n).map_or(&body, |p| &p.body);
        let atoms = current_neighbours(spec);
        enough_memory(own, part.stencil.as_ref(), part.horizon, atoms)?;
    }
    let carriers = match spec.micromoduli() {
        Some(linear) => (**linear).clone().of::<D>().and_then(|l| l.carriers),
        None => None,
    };
    let (sets, carrier_sets) = sets(spec, &body, carriers.as_ref())?;
    assign_materials(spec, &mut body, &sets)?;
    own_densities(spec, &mut body);
    let by_length = |p: &&Part| matches!(p.spec.horizon, Horizon::Length(_));
    let ends = parts.iter().filter(by_length).flat_map(|p| &p.stencil);
    let ends: u64 = ends.map(|s| s.near_horizon as u64).sum();
    if let (Some(potential), BodySpec::Lattice { kind, spacing, .. }) =
        (spec.potential(), &spec.body)
    {
        warnings.extend(atoms::crystal(spec, potential, *kind, *spacing)?);
    }
    let (mut constitutive, mut interaction) =
        bind(spec, &mut parts, &mut body, shelf, simd, &mut warnings)?;
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
        warnings.push(format!(
            "{near_horizon} {what} end within round-off of the horizon {horizon:e}: a larger or smaller number in its last digits changes the family; write the horizon as a whole number of spacings (m_ratio), or well between two distances"
        ));
    }
    if spec.potential().is_none() && spec.micromoduli().is_none() {
        warnings.extend(gaps::across(spec, &body, interaction.as_ref()));
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
            let shape = Crack::new(&crack.shape, body.period)
                .map_err(|e| e.at(format!("precracks[{n}]")))?;
            let count = interaction.cut(&body, kind, &|from, to| shape.crosses(&from, &to));
            if count == 0 {
                warnings.push(format!("pre-crack {} cuts no bond", n + 1));
            }
            cut += count;
        }
    }
    if spec.contact.as_ref().is_some_and(|c| c.friction > 0.0)
        && spec.materials.iter().any(|m| m.fracture.is_some())
    {
        warnings.push(
            "friction acts between points that were never bonded: the faces of a crack slide on each other without it"
                .into(),
        );
    }
    let asymmetry = interaction.asymmetry();
    if asymmetry > SYMMETRIC {
        warnings.push(format!(
            "action is not reaction in this body (asymmetry {asymmetry:.1e}): it has no energy, what is printed as strain energy is that of its symmetric part, and neither energy nor momentum need balance"
        ));
    }
    let directed_bonds = interaction.directed_bonds();
    let bonded = parts.iter().any(|p| p.bonded);
    if directed_bonds == 0 && body.points() > 1 && bonded && body.points() > body.pieces().len() {
        return Err(BuildError::empty(
            "horizon",
            format!(
                "no two of the {} points are within the horizon {horizon:e}",
                body.points()
            ),
        )
        .help(format!(
            "the spacing is {:e}: a horizon of three spacings is usual; points that only touch are a body with bonded = false",
            body.spacing
        )));
    }
    let repulsion = contact::repulsion(spec, &parts, &constitutive, &body)?;
    let range = |a: usize, b: usize| repulsion.as_ref().map_or(0.0, |r| r.range(a, b));
    let reach = (0..parts.len())
        .map(|n| range(n, n))
        .fold(horizon, f64::max);
    let gaps = gaps::between(&body, reach, range);
    let spacing = |n: usize| body.pieces()[n].body.spacing;
    warnings.extend(gaps::warnings(spec, &gaps, spacing));
    let (mut bond_step, mut contact_step) = (f64::INFINITY, f64::INFINITY);
    let mut touching = None;
    if !options.trust_time_step && spec.schedule.statics().is_none() {
        let first = constitutive.first();
        let lambda = probe::bonds(first, &body, interaction.as_mut(), spec, cell_volume)?;
        bond_step = probe::step(lambda);
        if let Some(r) = &repulsion {
            touching = r.limit(&parts, &body, lambda);
        }
        contact_step = touching.map_or(f64::INFINITY, |t| probe::step(t.lambda));
    }
    let stable_step = bond_step.min(contact_step);
    let explicit = match spec.schedule.stepper {
        Stepper::Verlet | Stepper::Statics(_) => true,
        Stepper::Newmark(_) => false,
    };
    if !explicit && spec.schedule.time_step == TimeStep::Auto {
        return Err(BuildError::missing(
            "schedule.time_step",
            "an implicit step is stable at any length: how long it is must be said",
        )
        .help("write time_step as a number, a thirtieth of the shortest period of interest, or { safety = 20 } for twenty explicit ones"));
    }
    let fraction = match spec.schedule.time_step {
        TimeStep::Fixed(_) => None,
        TimeStep::Fraction(x) => Some(x),
        TimeStep::Auto if spec.potential().is_some() => Some(atoms::FRACTION),
        TimeStep::Auto => Some(SOLID_FRACTION),
    };
    let dt = match (spec.schedule.time_step, fraction) {
        (_, Some(x)) if stable_step.is_finite() => x * stable_step,
        (TimeStep::Fraction(_) | TimeStep::Auto, _) if body.points() == 1 => {
            return Err(BuildError::empty(
                "body",
                "the body has one point, and a point alone has no bonds: no stable step can be derived",
            )
            .help("a larger region or a smaller spacing, or time_step as a number"));
        }
        (TimeStep::Fraction(_) | TimeStep::Auto, _) => {
            return Err(BuildError::ill_posed(
                "schedule.time_step",
                "nothing resists: no stable step can be derived",
            )
            .help("give time_step as a number"));
        }
        (TimeStep::Fixed(dt), _) => dt,
    };
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(BuildError::invalid(
            "schedule.time_step",
            format!("the time step is {dt}, expected a positive number"),
        ));
    }
    // a step that was chosen may be right where nothing ever touches
    let chosen = matches!(spec.schedule.time_step, TimeStep::Fixed(_));
    let limit = if chosen { bond_step } else { stable_step };
    if dt > contact_step && dt <= limit && explicit {
        let of = touching
            .map_or([0, 0], |t| t.materials)
            .map(|k| repulsion.as_ref().map_or("", |r| r.name(spec, k)));
        let [a, b] = of;
        let between = if a == b {
            format!("points of {a}")
        } else {
            format!("{a} and {b}")
        };
        warnings.push(format!(
            "the time step {dt:.4e} is above the stability limit {contact_step:.4e} of contact between {between}: the run goes unstable if many of them touch"
        ));
    }
    if dt > limit && explicit {
        let message =
            format!("the time step {dt:.4e} is above the stability limit {limit:.4e} of this body");
        if !spec.schedule.force_unstable {
            return Err(BuildError::invalid("schedule.time_step", message)
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
    constitutive.forget_stencils(); // the interaction has them
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
            micromodulus: constitutive.micromoduli(spec.materials.len()),
            critical_stretch: constitutive.critical_stretches(spec.materials.len()),
            families: constitutive.families(spec.materials.len()),
            time_step: dt,
            stepper: spec.schedule.stepper,
            stable_step,
            contact_step,
            bodies: names(spec, &body),
            gaps,
            cut,
            bytes: 0,
            simd: simd.name(),
            warnings,
        },
        v: zeros(body.len),
        f: zeros(body.len),
        u,
        verlet: Verlet::new(simd, &body),
        contact: repulsion.map(|r| {
            let pairs = constitutive.first().pairs.as_ref();
            r.contact(&parts, &body, pairs.map_or(least_horizon, |p| p.shortest()))
        }),
        friction: friction(spec, &body)?,
        boltzmann: spec.boltzmann,
        release: spec.release,
        stop: || false,
        constitutive,
        interaction,
        body,
        loads: vec![],
        constraints: vec![],
        driven: vec![],
        still: Still::new(vec![]),
        carried: Carried::default(),
        fastest: 0.0,
        watch: false,
        watched: None,
        watch_virial: false,
        virial: None,
        watch_virials: false,
        virials: None,
        indenters: vec![],
        probes: vec![],
        sets,
        carriers,
        carrier_sets,
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
        implicit: None,
    };
    model.info.bytes = model.bytes();
    if let Some(thermal) = spec.thermal {
        model.heat(thermal);
    }
    if let Some(velocity) = own_velocities(spec, &model.body) {
        model.set_velocities(&velocity);
    }
    initial(spec, &mut model)?;
    if let (TimeStep::Auto, Some(potential)) = (spec.schedule.time_step, spec.potential()) {
        model.dt = model.dt.min(model.step_of_speeds(potential));
        model.info.time_step = model.dt;
    }
    model.check_fields(spec.fields.as_deref().unwrap_or_default())?;
    let sets = std::mem::take(&mut model.sets);
    model.set_conditions(&spec.conditions, &sets, &spec.indenters)?;
    model.sets = sets;
    // how long a run of a given duration is, its caller knows
    let steps = match spec.schedule.steps {
        0 => 1000,
        steps => steps,
    };
    model.check_agreement(&spec.conditions, steps as f64 * dt)?;
    match spec.schedule.stepper {
        Stepper::Verlet => {}
        Stepper::Newmark(newmark) => {
            model.check_implicit(newmark, spec)?;
            model.implicit = Some(Implicit::new(newmark));
        }
        Stepper::Statics(statics) => {
            if spec.schedule.steps > 0 {
                model.check_statics(statics)?;
            }
            model.statics = Some(StaticState::new(statics));
        }
    }
    model.probes = model.probes_of(&spec.probes)?;
    Ok(model)
}

/// Laws and bonds of all bodies.
#[allow(clippy::type_complexity)] // what a model is made of, twice
fn bind<const D: usize>(
    spec: &Spec,
    parts: &mut [Part],
    body: &mut Body<D>,
    shelf: &Shelf,
    simd: Simd,
    warnings: &mut Vec<String>,
) -> Result<(ConstitutiveModels, Box<dyn Interaction<D>>), BuildError> {
    let BodySpec::Several(named) = &spec.body else {
        if let Some(interface) = spec.interfaces.first() {
            let message = format!(
                "interface `{}` joins two of several bodies, and there is one",
                interface.name
            );
            return Err(BuildError::conflict("interface[0].bodies", message)
                .help("write [[body]] for each of the two"));
        }
        let model = parts[0].constitutive(body, shelf, simd, warnings)?;
        let interaction = model.interaction(body, None)?;
        return Ok((ConstitutiveModels::one(model), interaction));
    };
    let (mut constitutive, mut bonds) = (vec![], vec![]);
    for (n, part) in parts.iter_mut().enumerate() {
        let mut own = body.pieces()[n].body.clone();
        part.choose(body, n, &mut own);
        let mut told = vec![];
        let made = part
            .constitutive(&own, shelf, simd, &mut told)
            .and_then(|model| {
                let bonds = part.bonds(&model, &own)?;
                Ok((model, bonds))
            });
        let (model, bond) = made.map_err(|e| BuildError {
            message: format!("body `{}`: {}", named[n].name, e.message),
            ..e
        })?;
        warnings.extend(
            told.iter()
                .map(|w| format!("body `{}`: {w}", named[n].name)),
        );
        constitutive.push((body.pieces()[n].first, part.materials.clone(), model));
        bonds.push(bond);
        if let Layout::Several(pieces) = &mut body.layout {
            pieces[n].body = own;
        }
    }
    let mut joined = vec![];
    for made in interfaces(spec, named, body, shelf, simd)? {
        let (count, horizon) = (made.interface.near_horizon(), made.model.horizon);
        if count > 0 && !made.model.ratio {
            warnings.push(format!(
                "{count} directed bonds of an interface end within round-off of its horizon {horizon:e}: write it as a whole number of spacings (m_ratio), or well between two distances"
            ));
        }
        joined.push(made.interface);
    }
    let interaction = SeveralInteraction::new(body, bonds, joined);
    let constitutive = ConstitutiveModels::several(constitutive);
    Ok((constitutive, Box::new(interaction)))
}

/// Friction of contact; `None`: points slide freely.
fn friction<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
) -> Result<Option<Friction<D>>, BuildError> {
    let Some(coefficient) = spec.contact.as_ref().map(|c| c.friction) else {
        return Ok(None);
    };
    let path = "contact.friction";
    if !(coefficient >= 0.0 && coefficient.is_finite()) {
        let message =
            format!("the friction coefficient is {coefficient}, expected a number from 0 on");
        return Err(BuildError::invalid(path, message).help("0.3 is usual"));
    }
    if coefficient == 0.0 {
        return Ok(None);
    }
    if D == 1 {
        let message = "points on a line have nothing to rub along";
        return Err(BuildError::unsupported(path, message).help("leave friction out"));
    }
    if spec.schedule.statics().is_some() {
        let message = "friction follows velocities, which equilibrium does not have";
        return Err(BuildError::unsupported(path, message)
            .help("leave friction out, or take [run] instead of [statics]"));
    }
    Ok(Some(Friction::new(coefficient, body)))
}

/// Names and sizes of several bodies.
fn names<const D: usize>(spec: &Spec, body: &Body<D>) -> Vec<(String, u64)> {
    match &spec.body {
        BodySpec::Several(pieces) => {
            let all = pieces.iter().zip(body.pieces());
            all.map(|(p, own)| (p.name.clone(), own.body.points() as u64))
                .collect()
        }
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => vec![],
    }
}

/// The clouds of a spec, each with the ids of its points.
fn clouds<'a, const D: usize>(
    spec: &'a Spec,
    body: &Body<D>,
) -> Vec<(&'a Cloud, std::ops::Range<usize>)> {
    let cloud = |b: &'a BodySpec| match b {
        BodySpec::Cloud(cloud) => Some(cloud),
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Several(_) => None,
    };
    match &spec.body {
        BodySpec::Several(pieces) => {
            let all = pieces.iter().zip(body.ids());
            all.filter_map(|(p, ids)| Some((cloud(&p.body)?, ids)))
                .collect()
        }
        one => cloud(one)
            .map(|c| (c, 0..body.points()))
            .into_iter()
            .collect(),
    }
}

/// Points of a cloud that brings densities have those.
fn own_densities<const D: usize>(spec: &Spec, body: &mut Body<D>) {
    let mut density: Vec<f64> = vec![];
    for (cloud, ids) in clouds(spec, body) {
        if !cloud.density.is_empty() {
            if density.is_empty() {
                density = body
                    .slots
                    .iter()
                    .map(|s| body.density.at(*s as usize))
                    .collect();
            }
            density[ids].copy_from_slice(&cloud.density);
        }
    }
    if !density.is_empty() {
        body.density = Values::from_points(&density, &body.slots, body.len, 1.0);
    }
}

/// Velocities that clouds bring; `None`: they bring none.
fn own_velocities<const D: usize>(spec: &Spec, body: &Body<D>) -> Option<Vec<Point>> {
    let mut velocity = vec![];
    for (cloud, ids) in clouds(spec, body) {
        if !cloud.velocity.is_empty() {
            velocity.resize(body.points(), [0.0; 3]);
            velocity[ids].copy_from_slice(&cloud.velocity);
        }
    }
    (!velocity.is_empty()).then_some(velocity)
}
