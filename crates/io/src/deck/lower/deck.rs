//! All of a deck.

use super::atoms::AtomsPotentials;
use super::context::{Context, Result};
use super::output::{OutputSpec, output};
use super::section::{plane, section};
use super::stage::{Entries, Stages};
use super::units::{measured_constants, units};
use super::{
    Files, acting, atoms, bodies, contact, diffusion, family, fields, interface, material, motion,
    names, periods, probes, rigid_body, schedule, sets, warnings,
};
use crate::continuum::plan::FieldsSpec;
use crate::deck::document::Document;
use crate::deck::error::DeckError;
use crate::deck::source::Source;
use crate::read::Cells;
use peridyne::spec::{
    BondsSpec, DamageSpec, InteractionsSpec, LoadingSpec, PreloadSpec, RunSpec, SpaceSpec, Spec,
};

pub(in crate::deck) struct Lowered {
    pub spec: Spec,
    /// Names of the atoms of each material, where a file says it.
    pub species: Vec<Option<String>>,
    /// Lower corner of the periods.
    pub corner: [f64; 3],
    pub output: OutputSpec,
    pub fields: Vec<FieldsSpec>,
    pub threads: Option<usize>,
    pub duration: Option<f64>,
    pub modes: usize,
    pub warnings: Vec<String>,
    pub notes: Vec<String>,
    pub cells: Cells,
    pub entries: Entries,
}

pub(in crate::deck) fn lower(
    source: &Source,
    document: &Document,
    files: &Files,
) -> std::result::Result<Lowered, DeckError> {
    let units = units(document);
    let stages = Stages::of(document);
    let mut context = Context::new(source, units, stages.time(None), &document.constants)?;
    measured_constants(&context, document)?;
    let mut body = bodies::bodies(&mut context, document, files)?;
    bodies::check(&context, document)?;
    let periodic = periods::periods(
        &context,
        document.periodic.as_ref(),
        document.body.value.cells.as_ref(),
        &mut body,
    )?;
    let mut sets = bodies::sets(&context, document, &body)?;
    sets.extend(sets::sets(&context, &document.sets, &body)?);
    let mut potentials = atoms::potentials(&context, &document.material, &body, files)?;
    if !potentials.is_empty() {
        atoms::units_are_said(&context, document)?;
    }
    atoms::of_file(&context, document, &mut potentials)?;
    material::what_is_left(document, &potentials, &mut sets);
    let materials = material::materials(&context, document, &sets, &mut body, &potentials)?;
    let (current, chosen) = family::of_atoms(document, !potentials.is_empty());
    family::goes_with(&context, document, current)?;
    let (initial, starts) = acting::initial(&context, document, &mut sets)?;
    let (conditions, exchanged) = acting::conditions(&mut context, document, &stages, &mut sets)?;
    let section = section(&context, document)?;
    let rigid_bodies = acting::rigid_bodies(&mut context, document, &stages, section, files)?;
    context.set_time(stages.time(None));
    let precracks = acting::precracks(&context, document, &stages, files)?;
    let diffusions = diffusion::diffusions(&context, document, &materials, starts, exchanged)?;
    let probes = all(&document.probe, |at| probes::probe(&context, at, &sets))?;
    let first = bodies::own(&context, document, &mut body, &materials, &sets)?;
    let run = schedule::schedule(&context, document)?;
    let horizon = match first {
        Some(first) => first,
        None => family::horizon_of(&context, document, &body, current)?,
    };
    let mut spec = Spec {
        title: document.title.clone().unwrap_or_default(),
        space: SpaceSpec {
            dimension: context.dimension,
            plane: plane(document),
            section,
            periodic,
        },
        body,
        sets,
        materials,
        bonds: BondsSpec {
            horizon,
            partial_volume_correction: document.partial_volume_correction.unwrap_or(true),
            calibration: family::calibration(document),
            family: family::choice(document),
            ..BondsSpec::default()
        },
        interactions: InteractionsSpec {
            diffusions,
            ..InteractionsSpec::default()
        },
        damage: DamageSpec {
            precracks: precracks.before,
            ..DamageSpec::default()
        },
        loading: LoadingSpec {
            initial,
            boltzmann: atoms::boltzmann(units),
            thermal: None,
            conditions: conditions.then,
            rigid_bodies: rigid_bodies.then,
        },
        run: RunSpec {
            preload: run.preload.map(|p| PreloadSpec {
                statics: p.statics,
                increments: p.increments,
                duration: p.duration,
                conditions: conditions.before,
                rigid_bodies: rigid_bodies.before,
                cuts: precracks.then,
            }),
            schedule: run.schedule,
            fields: written_fields(document),
            probes,
        },
    };
    between_points(&context, document, files, &potentials, &mut spec)?;
    bodies::surfaces(&context, document, &mut spec)?;
    rigid_body::of_material(&mut context, document, &mut spec)?;
    let species = potentials.into_values().map(|p| p.element);
    names::folders(&context, &document.output, &document.fields)?;
    let moves = spec.run.schedule.statics().is_none();
    let kinds = [spec.potential().is_some(), moves];
    let output = output(&context, &document.output, kinds)?;
    Ok(Lowered {
        corner: periods::corner(&context, &document.body.value, &spec.body),
        species: species.collect(),
        fields: fields::fields(&context, &document.fields, chosen)?,
        spec,
        output,
        threads: run.threads,
        duration: run.duration,
        modes: run.modes,
        warnings: warnings::warnings(&context, document),
        notes: context.notes,
        cells: context.cells,
        entries: Entries {
            conditions: conditions.entries,
            rigid_bodies: rigid_bodies.entries,
            precracks: precracks.entries,
        },
    })
}

/// What bonds have, and what points exchange; of several mistakes in it the first of this order is reported.
fn between_points(
    context: &Context,
    document: &Document,
    files: &Files,
    potentials: &AtomsPotentials,
    spec: &mut Spec,
) -> Result<()> {
    let (bonds, interactions, damage) = (&mut spec.bonds, &mut spec.interactions, &mut spec.damage);
    let (body, sets, materials) = (&spec.body, &spec.sets, &spec.materials);
    bonds.variable_horizon = optional(&document.variable_horizon, |e| context.expression(e))?;
    interactions.bonded = atoms::molecules(context, document, files)?;
    spec.loading.thermal = optional(&document.initial_velocities, |t| atoms::thermal(context, t))?;
    interactions.interface = interface::rule(context, document, materials)?;
    interactions.interfaces = interface::interfaces(context, document, body)?;
    interactions.potentials = atoms::pairs(context, document, body, potentials, files)?;
    interactions.mixing = atoms::mixing(context, document, potentials)?;
    damage.breakage = material::breakage(context, &document.material)?;
    bonds.influence = family::influence(context, document.influence.as_ref(), materials)?;
    bonds.factors = all(&document.bond_stiffness, |b| {
        motion::bond_factor(context, b)
    })?;
    damage.toughness = all(&document.toughness, |t| motion::toughness(context, t, sets))?;
    damage.healing = optional(&document.healing, |h| motion::healing(context, h, sets))?;
    interactions.contact = contact::contact(context, document, materials)?;
    bonds.smooth = optional(&document.smooth, |s| fields::smooth(context, s))?;
    Ok(())
}

fn all<T, U>(written: &[T], made: impl Fn(&T) -> Result<U>) -> Result<Vec<U>> {
    written.iter().map(made).collect()
}

fn optional<T, U>(written: &Option<T>, made: impl Fn(&T) -> Result<U>) -> Result<Option<U>> {
    written.as_ref().map(made).transpose()
}

/// Columns that the deck asks for.
fn written_fields(document: &Document) -> Option<Vec<String>> {
    let written = document.output.fields.as_ref()?;
    // numbers of points are always written
    let named = written.iter().filter(|f| f.value != "id");
    Some(named.map(|f| f.value.clone()).collect())
}
