//! What was understood, in words.

mod material;
mod shape;

use super::units::{Dim, UnitSystem, counted, short};
use crate::excerpt::one_line;
use material::{between_atoms, criterion, material, potentials};
use peridyne::run::Shelf;
use peridyne::spec::{
    BodySpec, BondFactorSpec, Calibration, Control, Criterion, FamilyChoice, Fold, Horizon,
    IndenterMotion, Influence, LawSpec, Measure, Part, PieceSpec, Plane, PotentialSpec, ProbeSpec,
    Release, RigidQuantity, Spec, Statics, Stepper, SurfaceFactor, TimeStep, ToughnessFactor,
    TransferMethod, TransferSpec,
};
use shape::{body, rigid};

/// The name of a choice as a deck has it, in words: `cubic spline`.
fn words(choice: &impl std::fmt::Debug) -> String {
    let mut out = String::new();
    for (n, c) in format!("{choice:?}").chars().enumerate() {
        if n > 0 && c.is_uppercase() {
            out.push(' ');
        }
        out.extend(c.to_lowercase());
    }
    out
}

fn influence(chosen: Influence) -> String {
    match chosen {
        Influence::Formula(formula) => one_line(formula.source()).into_owned(),
        word => words(&word),
    }
}

/// A short header: body, materials, horizon, what acts, schedule; numbers with units.
pub fn describe(spec: &Spec, units: UnitSystem) -> String {
    let mut lines = Vec::new();
    if !spec.title.is_empty() {
        lines.push(one_line(&spec.title).into_owned());
    }
    if let UnitSystem::Metal(constants) = units {
        lines.push(format!(
            "units      metal, physical constants: {}",
            constants.name()
        ));
    }
    let plane = match (spec.dimension, spec.plane) {
        (2, Plane::Stress) => " plane stress",
        (2, Plane::Strain) => " plane strain",
        _ => "",
    };
    let section = match spec.dimension {
        1 => format!(", cross-section {}", units.write(spec.section, Dim::AREA)),
        2 => format!(", thickness {}", units.write(spec.section, Dim::LENGTH)),
        _ => String::new(),
    };
    lines.push(format!(
        "body       {}-D{plane}{section}, {}",
        spec.dimension,
        body(&spec.body, units, spec.dimension)
    ));
    lines.extend(
        spec.materials
            .iter()
            .map(|m| format!("material   {}", material(m, units))),
    );
    if spec.materials.iter().any(|m| m.fracture.is_some()) {
        lines.push(match spec.release {
            Release::AtOnce => "release    bonds let go at once past their critical stretch".into(),
            Release::AfterForce => {
                "release    bonds pull once more past their critical stretch".into()
            }
        });
    }
    if !spec.pairs.is_empty() {
        lines.push(
            "pairs      of materials have stiffness, horizon and critical stretch of their own"
                .into(),
        );
    }
    lines.extend(between_atoms(spec, units));
    let length = |horizon: Horizon| match horizon {
        Horizon::Ratio(m) => format!("{m} spacings"),
        Horizon::Length(length) => units.write(length, Dim::LENGTH),
    };
    let horizon = length(spec.horizon);
    lines.push(match spec.potential() {
        Some(_) => {
            let cutoffs = potentials(spec).map(PotentialSpec::cut_off);
            let cutoff = cutoffs.fold(0.0, f64::max);
            let mut names: Vec<&str> = potentials(spec).map(|p| &*p.name).collect();
            names.dedup();
            let current = matches!(spec.family, FamilyChoice::Auto | FamilyChoice::Neighbours);
            format!(
                "potential  {}, {}, {}",
                names.join(" and "),
                if cutoff.is_finite() {
                    format!("cut-off {}", units.write(cutoff, Dim::LENGTH))
                } else {
                    "without cut-off".into()
                },
                if current {
                    "between atoms that are near now".into()
                } else {
                    format!("between those within {horizon} in the reference")
                }
            )
        }
        None => format!(
            "horizon    {horizon}, influence {}, volume scaling {}, constants {}",
            influence(spec.influence),
            if spec.volume_scaling { "on" } else { "off" },
            match spec.calibration {
                Calibration::Continuum => "of the continuum",
                Calibration::Discrete => "of this body's own sums",
            }
        ),
    });
    if let Some(smooth) = &spec.smooth {
        let nodes = match smooth.spacing {
            Some(spacing) => format!("every {}", units.write(spacing, Dim::LENGTH)),
            None => "at the places of the atoms".into(),
        };
        lines.push(format!(
            "smooth     nodes {nodes} carry the atoms, by a kernel of width {}",
            units.write(smooth.width, Dim::LENGTH)
        ));
    }
    if let BodySpec::Several(pieces) = &spec.body {
        let own = |p: &&PieceSpec| {
            p.horizon.is_some_and(|h| h != spec.horizon)
                || p.influence.is_some_and(|i| i != spec.influence)
        };
        lines.extend(pieces.iter().filter(own).map(|p| {
            format!(
                "           of {}: {}, influence {}",
                p.name,
                length(p.horizon.unwrap_or(spec.horizon)),
                influence(p.influence.unwrap_or(spec.influence))
            )
        }));
    }
    if let Some(own) = &spec.own_horizon {
        lines.push(format!(
            "           of each point {}, at most that: dual horizon",
            own.source()
        ));
    }
    for i in &spec.interfaces {
        let fracture = match i.fracture.map(|f| f.criterion) {
            None => "never breaks".into(),
            Some(Criterion::Stretch(s)) => format!("critical stretch {s}"),
            Some(Criterion::Energy(e)) => {
                format!("fracture energy {}", units.write(e, Dim::FRACTURE_ENERGY))
            }
            Some(other) => criterion(other, units),
        };
        lines.push(format!(
            "interface  {} bonds {} and {} within {}, {fracture}",
            i.name,
            i.bodies[0],
            i.bodies[1],
            length(i.horizon)
        ));
    }
    for (axis, period) in ["x", "y", "z"].iter().zip(spec.periodic) {
        if let Some(period) = period {
            lines.push(format!(
                "periodic   {axis} with {}",
                units.write(period, Dim::LENGTH)
            ));
        }
    }
    if let Some(surface) = &spec.surface {
        let range = |of: fn(&SurfaceFactor) -> f64| {
            let all = surface.rows.iter().flatten().map(|(_, x)| of(x));
            all.fold((1.0f64, 1.0f64), |(a, b), x| (a.min(x), b.max(x)))
        };
        let beside = |what: &str, (least, most): (f64, f64)| match least < most {
            true => format!(", of {what} {least:.2} to {most:.2}"),
            false => String::new(),
        };
        let (low, high) = range(|x| x.pair);
        let mut others = beside("the dilatation", range(|x| x.share));
        if !spec.transfers.is_empty() {
            others += &beside("conductances", range(|x| x.conductance));
        }
        lines.push(format!(
            "surface    {}: {} kinds of points, factors of bonds {low:.2} to {high:.2}{others}",
            words(&surface.method),
            surface.rows.len() - 1
        ));
    }
    for bonds in &spec.bonds {
        lines.push(match bonds {
            BondFactorSpec::Field(field) => format!(
                "bonds      stiffness times {}, between unlike ends {}",
                field.source(),
                words(&spec.interface)
            ),
            BondFactorSpec::Crossing { factor, .. } => {
                format!("bonds      stiffness times {factor} across a flat shape")
            }
        });
    }
    for t in &spec.toughness {
        let of = match &t.factor {
            ToughnessFactor::Stretch(e) => format!("critical stretch times {}", e.source()),
            ToughnessFactor::Energy(e) => format!("fracture energy times {}", e.source()),
            ToughnessFactor::Temperature(rows) => {
                let row =
                    |[t, x]: &[f64; 2]| format!("{x} at {}", units.write(*t, Dim::TEMPERATURE));
                let rows: Vec<String> = rows.iter().map(row).collect();
                format!("critical stretch times {}", rows.join(", "))
            }
            ToughnessFactor::NoFailure => "bonds never break".to_string(),
        };
        lines.push(format!("toughness  on {}: {of}", t.set));
    }
    if let Some(healing) = &spec.healing {
        lines.push(format!(
            "healing    of bonds of {} below a stretch of {}",
            healing.set,
            healing.below.source()
        ));
    }
    if let Some(contact) = &spec.contact {
        lines.push(format!(
            "contact    below {} of the reference distance, within {} spacings{}{}",
            contact.bonded,
            contact.free,
            match &contact.friction {
                None => String::new(),
                Some(friction) => {
                    let sliding = friction.kinetic.source();
                    match &friction.at_rest {
                        None => format!(", friction {sliding}"),
                        Some(rest) => format!(
                            ", friction {} at rest, {sliding} sliding",
                            rest.coefficient.source()
                        ),
                    }
                }
            },
            { contact.cohesion.as_ref() }.map_or(String::new(), |c| {
                format!(
                    ", bodies stick with {} and {}",
                    units.write(c.energy, Dim::FRACTURE_ENERGY),
                    units.write(c.strength, Dim::PRESSURE)
                )
            }),
        ));
    }
    for indenter in &spec.indenters {
        let motion = match &indenter.motion {
            IndenterMotion::Kinematic(center) => {
                let center: Vec<&str> = center
                    .iter()
                    .take(spec.dimension)
                    .map(|c| c.source())
                    .collect();
                format!("moved along ({})", center.join(", "))
            }
            IndenterMotion::Free(free) => {
                format!("free with {}", units.write(free.mass, Dim::MASS))
            }
        };
        let name = match indenter.name.is_empty() {
            true => String::new(),
            false => format!("{}: ", indenter.name),
        };
        let friction = { indenter.friction.as_ref() }.map_or(String::new(), |f| {
            format!(", friction {}", f.kinetic.source())
        });
        let cohesion = { indenter.cohesion.as_ref() }.map_or(String::new(), |c| {
            format!(", sticky up to {}", units.write(c.range(), Dim::LENGTH))
        });
        lines.push(format!(
            "indenter   {name}{}, {motion}{friction}{cohesion}",
            rigid(&indenter.shape, units, spec.dimension)
        ));
    }
    lines.extend(spec.transfers.iter().map(spreading));
    lines.push(format!(
        "acting     {}, {}, {}",
        counted(spec.initial.len() as u64, "initial value"),
        counted(spec.conditions.len() as u64, "condition"),
        counted(spec.precracks.len() as u64, "pre-crack")
    ));
    for probe in &spec.probes {
        let ProbeSpec { name, set, measure } = probe;
        lines.push(format!(
            "probe      {name}: {}",
            measured(measure, set, units, spec.dimension)
        ));
    }
    if let Some(statics) = &spec.schedule.statics() {
        lines.push(equilibrium(statics, spec.schedule.steps, units));
        return lines.join("\n");
    }
    if let Some(preload) = &spec.preload {
        lines.push(format!(
            "{}, under {}",
            equilibrium(&preload.statics, preload.increments, units),
            counted(preload.conditions.len() as u64, "condition")
        ));
        if !preload.cuts.is_empty() {
            lines.push(format!(
                "cut        {}, when motion begins",
                counted(preload.cuts.len() as u64, "crack")
            ));
        }
    }
    let step = match spec.schedule.time_step {
        TimeStep::Fixed(step) => units.write(step, Dim::TIME),
        TimeStep::Auto if spec.schedule.stepper == Stepper::Still => {
            "the longest explicit one of what spreads".into()
        }
        TimeStep::Auto if spec.potential().is_some() => {
            "a tenth of the stability limit, less for fast atoms".into()
        }
        TimeStep::Auto => "0.8 of the stability limit".into(),
        TimeStep::Fraction(fraction) => format!("{fraction} of the stability limit"),
    };
    let steps = match spec.schedule.steps {
        0 => "as many steps as the duration takes".to_string(),
        steps => format!("{steps} steps"),
    };
    let how = match spec.schedule.stepper {
        Stepper::Verlet | Stepper::Statics(_) => String::new(),
        Stepper::Still => ", no point moves".into(),
        Stepper::Newmark(n) if n.alpha != 0.0 => format!(
            ", implicit by the method of Hilber, Hughes and Taylor with alpha = {}, tolerance {}",
            n.alpha,
            short(n.tolerance)
        ),
        Stepper::Newmark(n) => format!(
            ", implicit by Newmark's method with beta = {}, gamma = {}, tolerance {}",
            n.beta,
            n.gamma,
            short(n.tolerance)
        ),
    };
    lines.push(format!("run        {steps} of {step}{how}"));
    lines.join("\n")
}

/// Increments of load and how each finds its equilibrium.
fn equilibrium(statics: &Statics, increments: u64, units: UnitSystem) -> String {
    let method = statics.method.words();
    let many = match statics.control {
        Control::Load => counted(increments, "increment") + " of load",
        _ if increments == 1 => "1 equilibrium".into(),
        _ => format!("{increments} equilibria"),
    };
    let each = match statics.control {
        Control::Load => String::new(),
        Control::Breaking => ", each where the next bond breaks".into(),
        Control::Opening(by) => format!(", bonds open by {} in each", short(by)),
        Control::ArcLength(by) => {
            let by = units.write(by, Dim::LENGTH);
            format!(", points go by {by} in each")
        }
    };
    format!(
        "statics    {many}{each}, {method}, tolerance {}",
        short(statics.tolerance)
    )
}

/// What spreads, and how.
fn spreading(t: &TransferSpec) -> String {
    let how = match t.method {
        TransferMethod::Explicit { safety } => {
            format!("explicit, in parts of {safety} of its stable step")
        }
        TransferMethod::Implicit { theta, tolerance } => {
            let name = match theta < 1.0 {
                true => "Crank and Nicolson",
                false => "backward Euler",
            };
            format!("implicit ({name}), tolerance {}", short(tolerance))
        }
        TransferMethod::Steady { tolerance } => format!("steady, tolerance {}", short(tolerance)),
    };
    format!(
        "{:<11}{how}, {}, {}",
        t.quantity.name(),
        counted(t.initial.len() as u64, "initial value"),
        counted(t.conditions.len() as u64, "condition")
    )
}

/// Names of the laws of a spec and where they come from, each once.
pub fn sources(spec: &Spec) -> Vec<String> {
    let shelf = Shelf::standard();
    let own = spec.materials.iter().map(|m| m.law.clone());
    let pairs = { spec.potentials.iter() }.map(|a| LawSpec::Atoms(a.potential.clone()));
    let mut all = vec![];
    for law in own.chain(pairs) {
        if let Some((descriptor, _)) = shelf.written(&law) {
            let name = descriptor.name.replace('_', "-");
            let line = format!("{name}: {}", descriptor.source);
            if !descriptor.source.is_empty() && !all.contains(&line) {
                all.push(line);
            }
        }
    }
    all
}

fn measured(measure: &Measure, set: &str, units: UnitSystem, dimension: usize) -> String {
    let place = |x: &[f64]| {
        let each = x
            .iter()
            .take(dimension)
            .map(|x| units.write(*x, Dim::LENGTH));
        format!("({})", each.collect::<Vec<_>>().join(", "))
    };
    let part = |part: &Part| match part {
        Part::All => String::new(),
        Part::Component(name) => format!(", {name}"),
        Part::Magnitude => ", magnitude".into(),
    };
    match measure {
        Measure::Reaction => format!("force of the constraints on {set}"),
        Measure::Moment { about } => {
            format!("moment of the constraints on {set} about {}", place(about))
        }
        Measure::Energy => format!("energies of {set}"),
        Measure::Over { fold, of, part: p } => {
            let fold = match fold {
                Fold::Mean => "mean",
                Fold::Min => "smallest",
                Fold::Max => "largest",
                Fold::Sum => "sum",
            };
            format!("{fold} {of}{} of {set}", part(p))
        }
        Measure::Value { at, of, part: p } => {
            format!(
                "{of}{} of the point of {set} nearest to {}",
                part(p),
                place(at)
            )
        }
        Measure::Indenter { indenter, of } => format!(
            "{} of the indenter {indenter}",
            of.map_or("all", RigidQuantity::name)
        ),
        Measure::Contour(c) => format!(
            "J and K by the rectangle {} to {}",
            place(&c.low),
            place(&c.high)
        ),
    }
}
