//! What was understood, in words.

use super::units::{Dim, UnitSystem, short};
use peridyne::law::descriptor::Value;
use peridyne::run::Shelf;
use peridyne::space::region::Region;
use peridyne::space::rigid::RigidShape;
use peridyne::spec::{
    Acting, BodySpec, BondFactorSpec, Control, Criterion, FamilyChoice, Fold, Horizon,
    IndenterMotion, LawSpec, MaterialSpec, Measure, Method, Parameter, Part, PieceSpec, Plane,
    PotentialSpec, ProbeSpec, Release, RigidQuantity, Spec, Statics, Stepper, TimeStep,
    ToughnessFactor, TransferMethod, TransferSpec,
};

/// A short header: body, materials, horizon, what acts, schedule; numbers with units.
pub fn describe(spec: &Spec, units: UnitSystem) -> String {
    let mut lines = Vec::new();
    if !spec.title.is_empty() {
        lines.push(spec.title.clone());
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
                    format!("on fixed neighbours within {horizon}")
                }
            )
        }
        None => format!(
            "horizon    {horizon}, influence {:?}, volume scaling {}, constants {:?}",
            spec.influence,
            if spec.volume_scaling { "on" } else { "off" },
            spec.calibration
        ),
    });
    if let BodySpec::Several(pieces) = &spec.body {
        let own = |p: &&PieceSpec| {
            p.horizon.is_some_and(|h| h != spec.horizon)
                || p.influence.is_some_and(|i| i != spec.influence)
        };
        lines.extend(pieces.iter().filter(own).map(|p| {
            format!(
                "           of {}: {}, influence {:?}",
                p.name,
                length(p.horizon.unwrap_or(spec.horizon)),
                p.influence.unwrap_or(spec.influence)
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
        let range = |which: usize| {
            let all = surface.rows.iter().flatten().map(|(_, x)| x[which]);
            all.fold((1.0f64, 1.0f64), |(a, b), x| (a.min(x), b.max(x)))
        };
        let ((low, high), (least, most)) = (range(0), range(1));
        let shares = match least < most {
            true => format!(", of the dilatation {least:.2} to {most:.2}"),
            false => String::new(),
        };
        lines.push(format!(
            "surface    {:?}: {} kinds of points, factors of bonds {low:.2} to {high:.2}{shares}",
            surface.method,
            surface.rows.len() - 1
        ));
    }
    for bonds in &spec.bonds {
        lines.push(match bonds {
            BondFactorSpec::Field(field) => format!(
                "bonds      stiffness times {}, between unlike ends {:?}",
                field.source(),
                spec.interface
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
    if let Some(contact) = &spec.contact {
        lines.push(format!(
            "contact    below {} of the reference distance, within {} spacings{}",
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
            }
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
        "acting     {} initial values, {} conditions, {} pre-cracks",
        spec.initial.len(),
        spec.conditions.len(),
        spec.precracks.len()
    ));
    for probe in &spec.probes {
        let ProbeSpec { name, set, measure } = probe;
        lines.push(format!(
            "probe      {name}: {}",
            measured(measure, set, units, spec.dimension)
        ));
    }
    if let Some(statics) = &spec.schedule.statics() {
        lines.push(equilibrium(statics, spec.schedule.steps));
        return lines.join("\n");
    }
    if let Some(preload) = &spec.preload {
        lines.push(format!(
            "{}, under {} conditions",
            equilibrium(&preload.statics, preload.increments),
            preload.conditions.len()
        ));
        if !preload.cuts.is_empty() {
            lines.push(format!(
                "cut        {} cracks, when motion begins",
                preload.cuts.len()
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
            ", implicit by the method of Hilber, Hughes and Taylor with alpha = {}, tolerance {:e}",
            n.alpha, n.tolerance
        ),
        Stepper::Newmark(n) => format!(
            ", implicit by Newmark's method with beta = {}, gamma = {}, tolerance {:e}",
            n.beta, n.gamma, n.tolerance
        ),
    };
    lines.push(format!("run        {steps} of {step}{how}"));
    lines.join("\n")
}

/// Increments of load and how each finds its equilibrium.
fn equilibrium(statics: &Statics, increments: u64) -> String {
    let method = match statics.method {
        Method::Linear => "linear equations about the reference",
        Method::Newton => "Newton's method",
        Method::Relaxation => "adaptive dynamic relaxation",
    };
    let what = match statics.control {
        Control::Load => "increments of load",
        Control::Breaking => "equilibria, each where the next bond breaks",
    };
    format!(
        "statics    {increments} {what}, {method}, tolerance {:e}",
        statics.tolerance
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
            format!("implicit ({name}), tolerance {tolerance:e}")
        }
        TransferMethod::Steady { tolerance } => format!("steady, tolerance {tolerance:e}"),
    };
    format!(
        "{:<11}{how}, {} initial values, {} conditions",
        t.quantity.name(),
        t.initial.len(),
        t.conditions.len()
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

fn rigid(shape: &RigidShape, units: UnitSystem, dimension: usize) -> String {
    let length = |x: f64| units.write(x, Dim::LENGTH);
    let place = |x: &[f64]| {
        let each = x.iter().take(dimension).map(|x| length(*x));
        each.collect::<Vec<_>>().join(", ")
    };
    match shape {
        RigidShape::Sphere { radius } => format!("sphere of radius {}", length(*radius)),
        RigidShape::Box { half } => {
            let edges: Vec<String> = { half.iter().take(dimension) }
                .map(|h| length(2.0 * h))
                .collect();
            format!("box of {}", edges.join(" by "))
        }
        RigidShape::Cylinder { radius, half, .. } => format!(
            "cylinder of radius {} and length {}",
            length(*radius),
            length(2.0 * half)
        ),
        RigidShape::Plane { normal } => {
            let normal = normal.iter().take(dimension).map(|n| short(*n));
            format!(
                "plane of normal ({})",
                normal.collect::<Vec<_>>().join(", ")
            )
        }
        RigidShape::Solid(solid) => format!(
            "surface of {} triangles, volume {}, centroid ({})",
            solid.triangles().face.len(),
            units.write(solid.volume(), Dim::VOLUME),
            place(&solid.centroid())
        ),
    }
}

fn body(body: &BodySpec, units: UnitSystem, dimension: usize) -> String {
    match body {
        BodySpec::Lattice {
            kind,
            spacing,
            region,
            perturb,
            ..
        } => {
            let perturbed = if perturb.is_some() { ", perturbed" } else { "" };
            let spacing = units.write(*spacing, Dim::LENGTH);
            format!(
                "{} lattice of {spacing}{perturbed}, {}",
                kind.name(),
                extent(region, units, dimension)
            )
        }
        BodySpec::Sites {
            kind,
            spacing,
            quarters,
            ..
        } => {
            format!(
                "{} sites of a {} lattice of {}",
                quarters.len(),
                kind.name(),
                units.write(*spacing, Dim::LENGTH)
            )
        }
        BodySpec::Several(pieces) => {
            let each = pieces.iter().map(|p| {
                let loose = if p.bonded { "" } else { ", loose points" };
                format!(
                    "\n           {}: {}{loose}",
                    p.name,
                    self::body(&p.body, units, dimension)
                )
            });
            let word = if pieces.len() == 1 { "body" } else { "bodies" };
            format!("{} {word}{}", pieces.len(), each.collect::<String>())
        }
        BodySpec::Cloud(cloud) => {
            let own = if cloud.density.is_empty() {
                ""
            } else {
                ", each with the density of the file (below: their mean)"
            };
            format!("{} points{own}", cloud.position.len())
        }
    }
}

fn extent(region: &Region, units: UnitSystem, dimension: usize) -> String {
    let (low, high) = region.bounds();
    let sizes: Vec<String> = (0..dimension)
        .map(|a| units.write(high[a] - low[a], Dim::LENGTH))
        .collect();
    format!("within {}", sizes.join(" × "))
}

/// All potentials between atoms that a spec names.
fn potentials(spec: &Spec) -> impl Iterator<Item = &PotentialSpec> {
    let own = spec.materials.iter().filter_map(|m| m.law.potential());
    own.chain(spec.potentials.iter().map(|a| &a.potential))
}

/// What atoms of several kinds have with each other.
fn between_atoms(spec: &Spec, units: UnitSystem) -> Vec<String> {
    let mut lines = vec![];
    for acting in &spec.potentials {
        let Acting::Between(pair) = acting.on;
        let [a, b] = pair.map(|n| spec.materials.get(n).map_or("", |m| &*m.name));
        let said = constants(&LawSpec::Atoms(acting.potential.clone()), units);
        lines.push(format!("pair       {a} and {b}: {said}"));
    }
    if let Some(rule) = spec.mixing {
        lines.push(format!("mixing     {}", rule.name()));
    }
    lines
}

/// A law, of all but potentials with its constants.
fn law(law: &LawSpec, units: UnitSystem) -> String {
    match law.potential() {
        Some(potential) => potential.name.replace('_', "-"),
        None => constants(law, units),
    }
}

/// A law with its constants.
fn constants(law: &LawSpec, units: UnitSystem) -> String {
    let shelf = Shelf::standard();
    let Some((descriptor, parameters)) = shelf.written(law) else {
        return "a law of its own".into();
    };
    let mut said = descriptor.name.replace('_', "-");
    for (key, given) in &parameters.0 {
        let value = match (descriptor.key(key).map(|k| k.value), given) {
            (Some(Value::Number(dimension, _)), Parameter::Number(x)) => units.write(*x, dimension),
            (Some(Value::List(_, dimension, _)), Parameter::List(list)) => {
                let each = list.iter().map(|x| units.write(*x, dimension));
                format!("[{}]", each.collect::<Vec<_>>().join(", "))
            }
            (Some(Value::Rows(columns)), Parameter::Rows(rows)) => {
                let row = |row: &Vec<f64>| {
                    let each = row.iter().zip(columns);
                    let each: Vec<String> = each.map(|(x, c)| units.write(*x, c.1)).collect();
                    format!("[{}]", each.join(", "))
                };
                rows.iter().map(row).collect::<Vec<_>>().join(" ")
            }
            (_, Parameter::Word(word)) => word.clone(),
            (_, Parameter::Number(x)) => super::units::short(*x),
            (_, Parameter::List(list)) => format!("{list:?}"),
            (_, Parameter::Rows(rows)) => format!("{rows:?}"),
            (_, Parameter::Formula(formula)) => formula.source().into(),
            (_, Parameter::Table(_)) => "tables".into(),
        };
        said += &format!(", {} = {value}", key.replace('_', " "));
    }
    said
}

/// When bonds break.
fn criterion(criterion: Criterion, units: UnitSystem) -> String {
    match criterion {
        Criterion::Stretch(s) => format!("breaks at stretch {s}"),
        Criterion::Energy(g) => format!("breaks at {}", units.write(g, Dim::FRACTURE_ENERGY)),
        Criterion::BondEnergy(g) => format!(
            "bonds break by their work at {}",
            units.write(g, Dim::FRACTURE_ENERGY)
        ),
        Criterion::VonMises(s) => {
            format!(
                "breaks at the von Mises stress {}",
                units.write(s, Dim::PRESSURE)
            )
        }
        Criterion::PlasticStrain(e) => format!("breaks at the plastic strain {e}"),
    }
}

fn material(m: &MaterialSpec, units: UnitSystem) -> String {
    let law = law(&m.law, units);
    let fracture = match m.fracture {
        None => "unbreakable".to_string(),
        Some(f) => {
            let mut said = criterion(f.criterion, units);
            if f.alpha != 0.0 {
                said += &format!(", α = {}", f.alpha);
            }
            if let Some(rate) = f.rate {
                let reference = units.write(rate.reference, Dim::FREQUENCY);
                said += &format!(", times 1 + {} ln(rate/({reference}))", rate.coefficient);
            }
            if let Some(fatigue) = f.fatigue {
                let law = |[a, m]: [f64; 2]| format!("{a} ε^{m}");
                let of = |law: String, place: &str| format!(", {law} of a life a cycle {place}");
                let far = format!("far from any crack above {}", fatigue.limit);
                let growth = fatigue.growth.map(|x| of(law(x), "near a crack"));
                let nucleation = fatigue.nucleation.map(|x| of(law(x), &far));
                said += &[growth, nucleation].map(Option::unwrap_or_default).concat();
            }
            said
        }
    };
    format!(
        "{} on {}: {law}, ρ = {}, {fracture}",
        m.name,
        m.set,
        units.write(m.density, Dim::DENSITY)
    )
}
