//! From the deck as written to the specification: units, defaults, checks.

mod atoms;
mod bodies;
mod body;
mod contact;
pub(super) mod context;
mod fields;
mod files;
mod indenter;
mod interface;
mod law;
mod material;
mod motion;
mod names;
mod periods;
mod pieces;
mod points;
mod probes;
mod region;
mod schedule;
mod sets;
mod stage;
mod transfer;
mod warnings;

pub(super) use atoms::boltzmann;
pub(super) use files::Files;
pub(super) use material::point_volume;
pub(super) use schedule::{MANY_STEPS, steps};
pub(super) use warnings::unitless;

use super::OutputSpec;
use super::document::{
    CalibrationName, Document, FamilyName, HorizonRatio, InfluenceName, InfluenceWritten,
    PlaneName, StageName, SurfaceName, UnitName, Units,
};
use super::error::DeckError;
use super::source::Source;
use super::units::{Constants, Dim, UnitSystem, short};
use super::value::{At, Or, Written};
use crate::continuum::plan::FieldsSpec;
use crate::read::Cells;
use context::{Context, Result};
use peridyne::run::Shelf;
use peridyne::spec::{
    BodySpec, Calibration, FamilyChoice, Formula, Horizon, Influence, MaterialSpec, Plane,
    PreloadSpec, Spec, SurfaceFactors, SurfaceMethod,
};
pub(super) use stage::Entries;
use stage::{Staged, Stages};

pub(super) struct Lowered {
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

pub(super) fn lower(
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
    let current = !potentials.is_empty()
        && matches!(
            document.family,
            None | Some(FamilyName::Auto | FamilyName::Neighbours)
        );
    // of potentials that a continuum's fields may be made of in several ways
    let kept = document.family == Some(FamilyName::Reference) && document.smooth.is_none();
    let chosen = current || kept && !potentials.is_empty();
    if document.family == Some(FamilyName::Neighbours) && !current {
        let shelf = Shelf::standard();
        let all = shelf.descriptors().map(|d| &*d.name);
        let potentials: Vec<&str> = all.filter(|name| shelf.is_potential(name)).collect();
        return Err(context.error(
            &document.body.span,
            format!(
                "family = \"neighbours\" belongs to interatomic potentials ({})",
                potentials.join(", ")
            ),
        ));
    }
    let (mut initial, mut starts) = (Vec::new(), Vec::new());
    for (index, at) in document.initial.iter().enumerate() {
        let made = motion::initial(&context, index, at, &mut sets)?;
        transfer::initial(&context, &at.value, &made.set, &mut starts)?;
        initial.push(made);
    }
    let mut conditions = Staged::default();
    let mut exchanged = Vec::new();
    for (index, at) in document.condition.iter().enumerate() {
        let stage = stages.named(&context, &at.value.stage)?;
        context.set_time(stages.time(stage));
        let made = motion::condition(&context, index, at, &mut sets, &mut exchanged)?;
        if stages.both && stage.is_none() && made.iter().any(stage::of_time) {
            return Err(stages.whose(&context, &at.span));
        }
        conditions.put(stage, stages.both, index, made);
    }
    let section = section(&context, document)?;
    let mut indenters = Staged::default();
    for (index, at) in document.indenter.iter().enumerate() {
        let stage = stages.named(&context, &at.value.stage)?;
        context.set_time(stages.time(stage));
        let made = indenter::indenter(&context, at, section, files)?;
        if stages.both && stage.is_none() && stage::moves(&made) {
            return Err(stages.whose(&context, &at.span));
        }
        indenters.put(stage, stages.both, index, vec![made]);
    }
    context.set_time(stages.time(None));
    let mut precracks = Staged::default();
    for (index, at) in document.precrack.iter().enumerate() {
        let late = stages.named(&context, &at.value.stage)? == Some(StageName::Motion);
        let made = motion::precrack(&context, at, late, files)?;
        let when = if late {
            StageName::Motion
        } else {
            StageName::Statics
        };
        precracks.put(Some(when), true, index, vec![made]);
    }
    let transfers = transfer::transfers(&context, document, &materials, starts, exchanged)?;
    let probes = document.probe.iter();
    let probes = probes
        .map(|at| probes::probe(&context, at, &sets))
        .collect::<Result<Vec<_>>>()?;
    let first = bodies::own(&context, document, &mut body, &materials, &sets)?;
    let run = schedule::schedule(&context, document)?;
    let mut spec = Spec {
        title: document.title.clone().unwrap_or_default(),
        dimension: context.dimension,
        plane: match document.plane.as_ref().map(|p| p.value) {
            Some(PlaneName::Strain) => Plane::Strain,
            Some(PlaneName::Stress) | None => Plane::Stress,
        },
        section,
        horizon: match &document.horizon {
            _ if let Some(first) = first => first,
            Some(written) => horizon(&context, written, &body)?,
            // the cut-off takes its place
            None if current => Horizon::Ratio(1),
            None if let Some(linear) = &context.micromoduli => {
                Horizon::Length(linear.range() * (1.0 + 1e-9))
            }
            None => {
                return Err(context.error_with(
                    &document.body.span,
                    "the key `horizon` is missing",
                    "write horizon = { m_ratio = 3 }, or a length",
                ));
            }
        },
        own_horizon: document
            .own_horizon
            .as_ref()
            .map(|e| context.expression(e, Dim::LENGTH))
            .transpose()?,
        bonded: atoms::molecules(&context, document, files)?,
        thermal: document
            .thermal
            .as_ref()
            .map(|t| atoms::thermal(&context, t))
            .transpose()?,
        interface: interface::rule(&context, document, &materials)?,
        interfaces: interface::interfaces(&context, document, &body)?,
        pairs: vec![],
        potentials: atoms::pairs(&context, document, &body, &potentials, files)?,
        mixing: atoms::mixing(&context, document, &potentials)?,
        release: material::release(&context, &document.material)?,
        volume_scaling: document.volume_scaling.unwrap_or(true),
        calibration: match document.calibration {
            Some(CalibrationName::Continuum) => Calibration::Continuum,
            Some(CalibrationName::Discrete) | None => Calibration::Discrete,
        },
        influence: influence(&context, document.influence.as_ref(), &materials)?,
        periodic,
        surface: None,
        bonds: document
            .bond_factor
            .iter()
            .map(|b| motion::bond_factor(&context, b))
            .collect::<Result<_>>()?,
        toughness: document
            .toughness
            .iter()
            .map(|t| motion::toughness(&context, t, &sets))
            .collect::<Result<_>>()?,
        healing: { document.healing.as_ref() }
            .map(|h| motion::healing(&context, h, &sets))
            .transpose()?,
        precracks: precracks.before,
        contact: contact::contact(&context, document, &materials)?,
        initial,
        preload: run.preload.map(|p| PreloadSpec {
            statics: p.statics,
            increments: p.increments,
            duration: p.duration,
            conditions: conditions.before,
            indenters: indenters.before,
            cuts: precracks.then,
        }),
        conditions: conditions.then,
        transfers,
        indenters: indenters.then,
        family: match document.family {
            Some(FamilyName::Stencil) => FamilyChoice::Stencil,
            Some(FamilyName::List) => FamilyChoice::List,
            Some(FamilyName::Neighbours) => FamilyChoice::Neighbours,
            Some(FamilyName::Reference) => FamilyChoice::Reference,
            Some(FamilyName::Auto) | None => FamilyChoice::Auto,
        },
        smooth: { document.smooth.as_ref() }
            .map(|s| fields::smooth(&context, s))
            .transpose()?,
        schedule: run.schedule,
        fields: written_fields(document),
        probes,
        boltzmann: atoms::boltzmann(units),
        body,
        sets,
        materials,
    };
    if let Some(surface) = &document.surface {
        spec.surface = surface_factors(&context, surface, &spec)?;
    }
    indenter::of_material(&mut context, document, &mut spec)?;
    let species = potentials.into_values().map(|p| p.element);
    names::folders(&context, &document.output, &document.fields)?;
    let moves = spec.schedule.statics().is_none();
    let kinds = [spec.potential().is_some(), moves];
    let output = schedule::output(&context, &document.output, kinds)?;
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
            indenters: indenters.entries,
            precracks: precracks.entries,
        },
    })
}

/// Columns that the deck asks for.
fn written_fields(document: &Document) -> Option<Vec<String>> {
    let written = document.output.fields.as_ref()?;
    // numbers of points are always written
    let named = written.iter().filter(|f| f.value != "id");
    Some(named.map(|f| f.value.clone()).collect())
}

fn section(context: &Context, document: &Document) -> Result<f64> {
    let d = context.dimension;
    if let Some(plane) = &document.plane
        && d != 2
    {
        return Err(context.error(
            &plane.span,
            format!("plane stress and strain are 2-D; this body is {d}-D"),
        ));
    }
    match (&document.thickness, &document.area) {
        (Some(thickness), None) if d == 2 => {
            context.positive(thickness, Dim::LENGTH, "the thickness")
        }
        (None, Some(area)) if d == 1 => context.positive(area, Dim::AREA, "the area"),
        (None, None) => Ok(1.0),
        (Some(thickness), _) if d != 2 => Err(context.error(
            &thickness.span,
            format!("thickness belongs to a 2-D body; this one is {d}-D"),
        )),
        (_, Some(area)) => Err(context.error(
            &area.span,
            format!("area belongs to a 1-D body; this one is {d}-D"),
        )),
        (Some(_), None) => Ok(1.0),
    }
}

fn horizon(
    context: &Context,
    written: &At<Or<Written, HorizonRatio>>,
    body: &BodySpec,
) -> Result<Horizon> {
    // the length of the shortest bond, where it is known
    let lattice = match body {
        BodySpec::Lattice { kind, spacing, .. } => Some((*spacing, spacing * kind.nearest())),
        BodySpec::Cloud(cloud) => cloud.spacing.map(|s| (s, 0.0)),
        BodySpec::Sites { kind, spacing, .. } => Some((*spacing, spacing * kind.nearest())),
        // each has its own
        BodySpec::Several(_) => None,
    };
    let on_lattices = match body {
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } => true,
        BodySpec::Cloud(_) | BodySpec::Several(_) => false,
    };
    let below = |length: f64, shortest: f64| {
        let [length, shortest] = [length, shortest].map(|l| context.units.write(l, Dim::LENGTH));
        let message =
            format!("the horizon {length} is below the distance of points {shortest}: no bonds");
        context.error_with(&written.span, message, "write horizon = { m_ratio = 3 }")
    };
    match &written.value {
        Or::Bare(number) => {
            let number = At {
                value: number.clone(),
                span: written.span.clone(),
            };
            let length = context.positive(&number, Dim::LENGTH, "the horizon")?;
            match lattice {
                Some((_, shortest)) if length < shortest => Err(below(length, shortest)),
                _ => Ok(Horizon::Length(length)),
            }
        }
        Or::Table(HorizonRatio { m_ratio }) => {
            let ratio = context.positive(m_ratio, Dim::NUMBER, "m_ratio")?;
            let Some((spacing, shortest)) = lattice else {
                return Err(context.error_with(
                    &m_ratio.span,
                    "m_ratio counts spacings, and these points have none",
                    "give body.spacing, or the horizon as a length",
                ));
            };
            let whole = ratio.fract() == 0.0 && ratio <= f64::from(u32::MAX);
            if ratio * spacing < shortest {
                Err(below(ratio * spacing, shortest))
            } else if ratio > 1000.0 {
                Err(context.error(
                    &m_ratio.span,
                    format!(
                        "m_ratio = {} would bond everything: 3 is usual",
                        short(ratio)
                    ),
                ))
            } else if whole && on_lattices {
                Ok(Horizon::Ratio(ratio as u32))
            } else {
                Ok(Horizon::Length(ratio * spacing))
            }
        }
    }
}

/// The customary influence function of the law, unless one is asked for.
fn influence(
    context: &Context,
    written: Option<&At<InfluenceWritten>>,
    materials: &[MaterialSpec],
) -> Result<Influence> {
    let Some(At { value, span }) = written else {
        let first = materials.first().map(|m| &m.law);
        let shelf = Shelf::standard();
        let written = first.and_then(|law| shelf.written(law));
        return Ok(written.map_or(Influence::Constant, |(d, _)| d.influence));
    };
    Ok(match value {
        InfluenceWritten::Named(InfluenceName::Constant) => Influence::Constant,
        InfluenceWritten::Named(InfluenceName::Inverse) => Influence::Inverse,
        InfluenceWritten::Named(InfluenceName::Conical) => Influence::Conical,
        InfluenceWritten::Named(InfluenceName::Gaussian) => Influence::Gaussian,
        InfluenceWritten::Named(InfluenceName::CubicSpline) => Influence::CubicSpline,
        InfluenceWritten::Formula(text) => {
            // a word by itself is a name that was meant, or a variable
            let word = text.trim();
            let alone = word.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
            if alone && !Formula::VARIABLES.contains(&word) && !["e", "pi"].contains(&word) {
                return Err(context.error_with(
                    span,
                    format!("there is no influence function `{word}`"),
                    format!(
                        "write constant, inverse, conical, gaussian, cubic_spline, or an expression of {}: \"r^-2\"",
                        Formula::VARIABLES.join(", ")
                    ),
                ));
            }
            let expression = context.unmeasured(text, span, (Formula::VARIABLES, Dim::LENGTH))?;
            Influence::Formula(Formula::new(expression))
        }
    })
}

/// Factors of the bonds near the surface that a deck asks for.
fn surface_factors(
    context: &Context,
    named: &At<SurfaceName>,
    spec: &Spec,
) -> Result<Option<SurfaceFactors>> {
    let method = match named.value {
        SurfaceName::None => return Ok(None),
        SurfaceName::Exact => SurfaceMethod::Exact,
        SurfaceName::Volume => SurfaceMethod::Volume,
        SurfaceName::Energy => SurfaceMethod::Energy,
        SurfaceName::Force => SurfaceMethod::Force,
    };
    match peridyne_theory::homogenize::surface::correct(spec, method) {
        Ok((factors, _)) => Ok(Some(factors)),
        Err(e) => {
            let message = context.units.tell(&e.message());
            Err(context.error_with(&named.span, message, e.help()))
        }
    }
}

/// What plain numbers of the deck mean.
pub(super) fn units(document: &Document) -> UnitSystem {
    units_of(document.units.as_ref())
}

pub(super) fn units_of(written: Option<&At<Or<UnitName, Units>>>) -> UnitSystem {
    match written.map(|u| &u.value) {
        None => UnitSystem::default(),
        Some(Or::Bare(name)) => name.system(Constants::default()),
        Some(Or::Table(u)) => {
            let constants = u.constants.as_ref().map(|c| c.value);
            u.system.system(constants.unwrap_or_default())
        }
    }
}

/// Only metal is made of measured constants.
fn measured_constants(context: &Context, document: &Document) -> Result<()> {
    let written = document.units.as_ref().map(|u| &u.value);
    if let Some(Or::Table(u)) = written
        && let Some(constants) = &u.constants
        && !matches!(context.units, UnitSystem::Metal(_))
    {
        return Err(context.error_with(
            &constants.span,
            format!("units = \"{}\" takes no constants", context.units.name()),
            "constants are chosen for system = \"metal\": g/mol, bar and kelvin are made with them",
        ));
    }
    Ok(())
}
