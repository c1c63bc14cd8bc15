mod celsius;
mod reader;

use super::*;
use peridyne::space::rigid::RigidShape;
use peridyne::spec::*;
use proptest::prelude::*;

const IMPACT: &str = r#"title = "impact"
horizon = { m_ratio = 3 }
[constants]
R = "5 mm"
v = "-100 m/s"
[body]
lattice = "cubic"
spacing = "0.5 mm"
region = { cylinder = { axis = "y", radius = "37 mm", low = 0, high = "2.5 mm" } }
[material]
density = "2200 kg/m^3"
law = { pmb = { bulk = "14.9 GPa" } }
fracture = { critical_stretch = 0.0005, alpha = 0.25 }
[[initial]]
velocity = { y = "x > 2*R ? v : 0" }
[[rigid_body]]
stiffness = "1e17 N/m^5"
radius = "R"
center = [0, "2.5 mm", 0]
velocity = [0, "v", 0]
[run]
steps = 2000
time_step = "100 ns"
"#;

fn parse(text: &str) -> Deck {
    Deck::parse(text, "impact.toml", &[])
        .unwrap_or_else(|e| panic!("{e} {:?} {:?}", e.line, e.help))
}

fn with(key: &str, value: &str) -> Result<Deck, DeckError> {
    Deck::parse(IMPACT, "impact.toml", &[(key.into(), value.into())])
}

#[test]
fn a_deck_becomes_a_spec() {
    let spec = parse(IMPACT).spec;
    assert_eq!(spec.space.dimension, 3);
    assert!(matches!(spec.body, BodySpec::Lattice { spacing, .. } if spacing == 0.5e-3));
    assert_eq!(
        spec.materials[0].law,
        LawSpec::Pmb(PmbStiffness::Bulk(14.9e9))
    );
    assert_eq!(
        spec.materials[0].fracture,
        Some(FractureSpec {
            criterion: Criterion::Stretch(0.0005),
            alpha: 0.25,
            rate: None,
            fatigue: None,
        })
    );
    assert_eq!(spec.bonds.horizon, Horizon::Ratio(3));
    assert_eq!(
        spec.interactions.contact,
        Some(ContactSpec {
            bonded: 0.9,
            free: 1.35,
            stiffness: ContactStiffness::Laws,
            friction: None,
            cohesion: None,
            conductance: None,
        })
    );
    assert_eq!(spec.run.schedule.time_step, TimeStep::Fixed(1e-7));
    let velocity = spec.loading.initial[0].velocity[1].as_ref().unwrap();
    assert_eq!(velocity.eval(&[0.02, 0.0, 0.0], 0.0), -100.0);
    assert!(spec.loading.initial[0].velocity[0].is_none());
    let RigidShape::Sphere { radius } = spec.loading.rigid_bodies[0].shape else {
        panic!()
    };
    assert_eq!(radius, 0.005);
    let RigidBodyMotion::Kinematic(center) = &spec.loading.rigid_bodies[0].motion else {
        panic!()
    };
    assert!((center[1].eval(&[0.0; 3], 1e-5) - 0.0015).abs() < 1e-15);
}

#[test]
fn overrides_lie_over_the_deck_and_are_blamed_for_their_mistakes() {
    let deck = with("material.law.pmb.bulk", "20 GPa").unwrap();
    assert_eq!(
        deck.spec.materials[0].law,
        LawSpec::Pmb(PmbStiffness::Bulk(20e9))
    );
    assert_eq!(
        with("initial.0.velocity.y", "7")
            .unwrap()
            .spec
            .loading
            .initial[0]
            .velocity[1]
            .as_ref()
            .unwrap()
            .as_constant(),
        Some(7.0)
    );
    assert_eq!(with("output.every", "5").unwrap().output.every, Some(5));
    assert!(
        with("horizon", "{ m_ratio = 4 }").is_ok_and(|d| d.spec.bonds.horizon == Horizon::Ratio(4))
    );
    for (key, value, message) in [
        ("body.spacing", "-1 mm", "`spacing` must be positive"),
        ("body.spacin", "1 mm", "unknown key `spacin`"),
        (
            "run.steps",
            "many",
            "expected a whole number from 0, found string \"many\"",
        ),
        ("run.", "1", ""),
    ] {
        let error = with(key, value).unwrap_err();
        assert!(error.message.contains(message), "{error}");
        assert_eq!((error.file, error.line), (format!("--set {key}"), None));
    }
}

#[test]
fn an_error_of_the_engine_finds_its_line() {
    let deck = parse(IMPACT);
    for (path, text) in [
        ("body.region", "{ cylinder"),
        ("body.region.cylinder.radius", "\"37 mm\""),
        ("materials[0].density", "\"2200 kg/m^3\""),
        ("materials.material.law", "{ pmb"),
        ("schedule.time_step", "\"100 ns\""),
        ("conditions.0", ""),
        ("rigid_bodies[0].radius", "\"R\""),
        ("horizon", "{ m_ratio"),
    ] {
        let found = deck.locate(path).map_or("", |span| &IMPACT[span]);
        assert!(
            found.starts_with(text) && found.is_empty() == text.is_empty(),
            "{path}: {found}"
        );
    }
    let error = deck.explain(&BuildError::empty("body.region", "empty").help("grow it"));
    assert_eq!((error.line, error.file.as_str()), (Some(9), "impact.toml"));
}

#[test]
fn two_materials_keep_their_names_and_places() {
    let text = IMPACT.replace("[material]", "[material.glass]\nset = \"left\"")
        + "[sets.left]\nregion = { half_space = { point = [0,0,0], normal = [1,0,0] } }\n[sets.right]\nregion = { half_space = { point = [0.1,0,0], normal = [-1,0,0] } }\n[material.steel]\nset = \"right\"\ndensity = \"7.8 g/cm^3\"\nlaw = { pmb = { young = \"210 GPa\" } }\n";
    let deck = parse(&text);
    let names: Vec<_> = deck
        .spec
        .materials
        .iter()
        .map(|m| (m.name.as_str(), m.set.as_str()))
        .collect();
    assert_eq!(names, [("glass", "left"), ("steel", "right")]);
    assert!((deck.spec.materials[1].density - 7800.0).abs() < 1e-9);
    assert_eq!(
        &text[deck.locate("materials.steel.density").unwrap()],
        "\"7.8 g/cm^3\""
    );
}

#[test]
fn a_periodic_body_is_one_period_long() {
    let text = IMPACT.replace(
        "region = {",
        "region = { block = { low = [0,0,0], high = [0.01, 0.01, 0.01] } }\n#",
    ) + "\n";
    let deck = Deck::parse(&text, "f", &[("periodic".into(), "[\"x\"]".into())]).unwrap();
    assert!(
        (deck.spec.space.periodic[0].unwrap() - 0.01).abs() < 1e-15
            && deck.spec.space.periodic[1].is_none()
    );
    let BodySpec::Lattice {
        kind,
        spacing,
        origin,
        region,
        ..
    } = deck.spec.body
    else {
        panic!()
    };
    let lattice = peridyne::space::lattice::Lattice {
        kind,
        spacing,
        origin,
    };
    assert_eq!(
        peridyne::space::fill::fill(&lattice, &region)
            .unwrap()
            .len(),
        20 * 20 * 20
    );
}

#[test]
fn metal_units_are_made_consistent() {
    let text = "units = \"metal\"\nhorizon = 9\n[body]\nlattice = \"fcc\"\nspacing = \"0.4 nm\"\nregion = { block = { low = [0,0,0], high = [40,40,40] } }\n[material]\ndensity = 2.7\nlaw = { pmb = { bulk = \"76 GPa\" } }\n[run]\nduration = 1\n[[boundary_condition]]\ntraction = { x = \"1e4*t\" }\n";
    let deck = parse(text);
    assert!(
        matches!(deck.spec.body, BodySpec::Lattice { spacing, .. } if (spacing - 4.0).abs() < 1e-12)
    );
    let LawSpec::Pmb(PmbStiffness::Bulk(k)) = deck.spec.materials[0].law else {
        panic!()
    };
    assert!((k - 0.474354689).abs() < 1e-6, "{k}"); // eV/Å³
    assert!((deck.spec.materials[0].density - 2.7 * 6.02214076e-1 * 1.036426966e-4).abs() < 1e-10);
    let ConditionKind::Traction { value, .. } = &deck.spec.loading.conditions[0].kind else {
        panic!()
    };
    assert!((value[0].as_ref().unwrap().eval(&[0.0; 3], 2.0) - 2e4 * 6.241509074e-7).abs() < 1e-12);
    assert_eq!((deck.duration, deck.steps(0.003)), (Some(1.0), 334));
}

#[test]
fn the_header_says_what_was_understood() {
    let text = parse(IMPACT).describe();
    for part in [
        "impact",
        "cubic lattice of 0.5 mm, within 74 mm × 2.5 mm × 74 mm",
        "pmb, bulk = 14.9 GPa",
        "2200 kg/m^3",
        "3 spacings",
        "2000 steps of 0.1 µs",
        "radius 5 mm",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

#[test]
fn the_schema_knows_every_table() {
    let schema = schema();
    for key in [
        "body",
        "material",
        "horizon",
        "run",
        "boundary_condition",
        "precrack",
    ] {
        assert!(schema["properties"][key].is_object(), "{key}");
    }
    assert_eq!(schema["additionalProperties"], false);
}

proptest! {
    /// No damage to a deck makes the reader panic, and every complaint has words.
    #[test]
    fn damaged_decks_are_read_or_refused(
        at in 0.0..1.0f64,
        cut in 0usize..40,
        put in "[-\\[\\]{}=\"0-9$*,. \\na-z]{0,12}",
        key in "[a-z.0-9]{0,12}",
        value in "\\PC{0,12}",
    ) {
        let start = (at * IMPACT.len() as f64) as usize;
        let damaged = format!("{}{put}{}", &IMPACT[..start], &IMPACT[(start + cut).min(IMPACT.len())..]);
        for (text, overrides) in [(damaged.as_str(), vec![]), (IMPACT, vec![(key, value)])] {
            match Deck::parse(text, "f.toml", &overrides) {
                Ok(deck) => prop_assert!(!deck.describe().is_empty()),
                Err(error) => prop_assert!(!error.message.is_empty()),
            }
        }
    }
}

#[test]
fn flags_make_a_deck_and_are_named_where_they_are_wrong() {
    let flags = |spacing: &str| {
        [
            ("--lattice", "body.lattice", "chain"),
            ("--cells", "body.cells", "[8]"),
            ("--spacing", "body.spacing", spacing),
            ("--m-ratio", "horizon.m_ratio", "2"),
            ("--law", "material.law.springs", "{ young = 3 }"),
            ("--density", "material.density", "1"),
            ("--steps", "run.steps", "5"),
        ]
        .map(|(name, key, value)| Flag {
            name: name.into(),
            key: key.into(),
            value: value.into(),
        })
    };
    let deck = Deck::of_flags(&flags("0.25")).unwrap();
    assert_eq!(
        (deck.spec.space.dimension, deck.spec.run.schedule.steps),
        (1, 5)
    );
    let text = upscaled::copied(&deck).unwrap().text;
    assert_eq!(
        format!("{:?}", parse(&text).spec),
        format!("{:?}", deck.spec)
    );
    let error = Deck::of_flags(&flags("-1")).unwrap_err();
    assert_eq!((&*error.file, error.line), ("--spacing", None));
}

/// The impact with constants and a condition of this text: its value at x = 0.02, t = 3e-5, or message and help.
fn value(key: &str, text: &str, statics: bool) -> Result<f64, (String, String)> {
    let run = IMPACT.find("[[initial]]").unwrap();
    let schedule = if statics {
        "[statics]\n"
    } else {
        "[run]\nsteps = 1\n"
    };
    let deck = format!(
        "{}L = \"50 mm\"\nw = \"2*R\"\nc = \"sqrt(14 GPa/(2200 kg/m^3))\"\nT = \"L/c\"\nn = 3\np = \"12 MPa\"\n{}\
         [[boundary_condition]]\n{key} = {{ x = '{text}' }}\n{schedule}",
        &IMPACT[..IMPACT.find("[body]").unwrap()],
        &IMPACT[IMPACT.find("[body]").unwrap()..run],
    );
    match Deck::parse(&deck, "f.toml", &[]) {
        Ok(deck) => {
            let value = match &deck.spec.loading.conditions[0].kind {
                ConditionKind::Displacement(v) | ConditionKind::Velocity(v) => v[0].clone(),
                ConditionKind::Traction { value, .. } => value[0].clone(),
                other => panic!("{other:?}"),
            };
            Ok(value.unwrap().eval(&[0.02, 0.0, 0.0], 3e-5))
        }
        Err(error) => {
            let marked = error.span().map_or("", |span| &deck[span]);
            assert!(text.contains(marked.trim_matches('\'')), "{text}: {marked}");
            Err((error.message, error.help.unwrap_or_default()))
        }
    }
}

#[test]
fn quantities_stand_in_expressions() {
    let speed = (14e9f64 / 2200.0).sqrt();
    for (key, text, wanted) in [
        ("traction", "12 MPa * t / 10 us", 3.6e7),
        ("traction", "12 MPa*t/1e-5", 3.6e7),
        ("traction", "p*t/1e-5", 3.6e7),
        ("traction", "12 MPa * min(t / (10 us), 1)", 1.2e7),
        ("traction", "12 MPa * (1e5*t)", 3.6e7),
        ("traction", "1 MPa + 1e10*t", 1.3e6),
        ("traction", "t < 20us ? p : 0", 0.0),
        ("traction", "1e10*t", 3e5),
        ("traction", "14 GPa * x / L", 5.6e9),
        ("displacement", "100 m/s * t", 3e-3),
        ("displacement", "-100 m/s*t", -3e-3),
        ("displacement", "v*t", -3e-3),
        ("displacement", "0.5*9.81 m/s^2*t^2", 0.5 * 9.81 * 9e-10),
        (
            "displacement",
            "0.001*sin(2*pi*x/L)",
            1e-3 * (0.8 * std::f64::consts::PI).sin(),
        ),
        (
            "displacement",
            "1 mm * sin(2*pi*50 kHz*t)",
            1e-3 * (3.0 * std::f64::consts::PI).sin(),
        ),
        ("displacement", "1 mm * exp(-((x - 2 cm)/0.002)^2)", 1e-3),
        (
            "displacement",
            "1 mm * exp(-((x - R)/(2 mm))^2)",
            1e-3 * (-56.25f64).exp(),
        ),
        ("displacement", "0.1*(1 - x/L)", 0.06),
        ("displacement", "max(x - w, 0 mm) + 3*t", 0.01 + 9e-5),
        (
            "displacement",
            "hypot(3 mm, 4 mm) * t/T",
            5e-3 * 3e-5 / (0.05 / speed),
        ),
        ("displacement", "5 % * x", 1e-3),
        ("displacement", "n*1 mm", 3e-3),
        ("displacement", "x > 0.01 ? 1mm : 2mm", 1e-3),
        ("velocity", "sqrt(14 GPa / (2.2 g/cm^3))", speed),
        ("velocity", "c", speed),
        ("velocity", "1 kN / (1 kg/s)", 1e3),
        ("velocity", "5 kN*m/(1 J)*c", 5e3 * speed),
        ("velocity", "22e6*t", 660.0),
        ("velocity", "x/L", 0.4),
    ] {
        match (value(key, text, false), text) {
            // a pure number is no velocity
            (Err((message, _)), "x/L") => {
                assert!(message.contains("is a plain number"), "{message}")
            }
            (got, _) => {
                let got = got.unwrap_or_else(|e| panic!("{text}: {e:?}"));
                assert!(
                    (got - wanted).abs() <= 1e-14 * wanted.abs(),
                    "{text}: {got} {wanted}"
                );
            }
        }
    }
    // t counts from 0 to 1 there
    assert_eq!(value("displacement", "5 mm * t", true), Ok(5e-3 * 3e-5));
}

#[test]
fn numbers_in_quotes_without_a_unit_are_warned_of() {
    let deck = |old: &str, new: &str| {
        let text = IMPACT.replace(old, new);
        assert_ne!(text, IMPACT);
        parse(&text).warnings
    };
    let taken = |line: u32, number: &str, as_: &str| {
        [format!(
            "impact.toml:{line}: \"{number}\" has no unit and is taken as {as_}: write the unit, or the number without quotes"
        )]
    };
    assert_eq!(
        deck("\"5 mm\"", "\"0.005\""),
        taken(4, "0.005", "0.005 in the unit of each place that uses it")
    );
    assert_eq!(deck("\"0.5 mm\"", "\"5e-4\""), taken(8, "5e-4", "500 µm"));
    assert_eq!(
        deck("{ y = \"x > 2*R ? v : 0\" }", "{ y = \"-100\" }"),
        taken(15, "-100", "-100 m/s")
    );
    // pure numbers, zero, and plain numbers
    for (old, new) in [
        ("= 0.0005", "= \"0.0005\""),
        ("low = 0,", "low = \"0\","),
        ("\"0.5 mm\"", "5e-4"),
    ] {
        assert!(deck(old, new).is_empty(), "{new}");
    }
    let reduced = IMPACT.replace("title = \"impact\"", "units = \"none\"");
    let plain = ["5 mm", "-100 m/s", "0.5 mm", "37 mm", "2.5 mm"];
    let plain = plain.iter().fold(reduced, |text, n| {
        text.replace(n, n.split(' ').next().unwrap())
    });
    let plain = plain
        .replace("2200 kg/m^3", "2200")
        .replace("14.9 GPa", "14.9");
    let plain = plain.replace("1e17 N/m^5", "1e17").replace("100 ns", "100");
    assert!(parse(&plain).warnings.is_empty());
}

#[test]
fn what_does_not_fit_together_is_refused_with_its_place() {
    for (key, text, message, help) in [
        (
            "displacement",
            "5 mm * t",
            "expected a length, \"5 mm * t\" is a length times a time",
            "divide by a time, for example `/ (20 us)`",
        ),
        (
            "traction",
            "12 MPa * t",
            "is a pressure times a time",
            "divide by a time",
        ),
        (
            "traction",
            "0.5 * 12 MPa * t",
            "is a pressure times a time",
            "a number without unit beside a quantity is a pure number",
        ),
        (
            "displacement",
            "12 MPa",
            "expected a length, \"12 MPa\" is a pressure",
            "write for example \"0.5 mm\"",
        ),
        (
            "displacement",
            "v",
            "expected a length, \"v\" is a velocity",
            "0.5 mm",
        ),
        (
            "displacement",
            "2*c",
            "expected a length, \"2*c\" is a velocity",
            "0.5 mm",
        ),
        (
            "displacement",
            "R + t",
            "`+` takes two of a kind, here are a length and a time",
            "",
        ),
        (
            "displacement",
            "x > 5 us ? R : 0",
            "`>` takes two of a kind, here are a length and a time",
            "",
        ),
        (
            "displacement",
            "max(R, 5 us)",
            "`max` takes two of a kind",
            "",
        ),
        (
            "displacement",
            "1 mm * sin(x)",
            "`sin` takes a plain number, this is a length",
            "divide by a length",
        ),
        (
            "displacement",
            "1 mm * exp(t/R)",
            "`exp` takes a plain number",
            "",
        ),
        (
            "displacement",
            "R^0.5",
            "`^` takes a plain number, this is a length",
            "",
        ),
        ("displacement", "R^x", "`^` takes a plain number", ""),
        (
            "displacement",
            "x/L",
            "is a plain number",
            "multiply by a length, for example `* 0.5 mm`",
        ),
        (
            "displacement",
            "5 furlong * x",
            "unknown unit `furlong`",
            "",
        ),
        ("displacement", "5 mpa * x", "did you mean `MPa`", ""),
        (
            "displacement",
            "5 t * x",
            "`t` is a unit, and a name",
            "write `* t`",
        ),
        ("displacement", "5 L * x", "expected an operator", "`*`"),
        (
            "displacement",
            "5 m^x",
            "power of a unit is a whole number",
            "",
        ),
        (
            "displacement",
            "0,5 mm",
            "decimal point, not a comma",
            "write 0.5 mm",
        ),
        ("displacement", "5 mm +", "ends too early", ""),
    ] {
        let (got, cure) = value(key, text, false).expect_err(text);
        assert!(got.contains(message), "{text}: {got}");
        assert!(cure.contains(help), "{text}: {cure}");
    }
}

#[test]
fn expressions_in_metal_units_are_computed_in_those() {
    let text = "units = \"metal\"\nhorizon = 9\n[constants]\nK = \"76 GPa\"\n[body]\nlattice = \"fcc\"\nspacing = \"0.4 nm\"\nregion = { block = { low = [0,0,0], high = [40,40,40] } }\n[material]\ndensity = \"2*1.35 g/cm^3\"\nlaw = { pmb = { bulk = \"0.5*K\" } }\n[run]\nduration = 1\n[[boundary_condition]]\ntraction = { x = \"TEXT\" }\n";
    let traction = |t: &str| {
        let deck = Deck::parse(&text.replace("TEXT", t), "f", &[])?;
        let ConditionKind::Traction { value, .. } = &deck.spec.loading.conditions[0].kind else {
            panic!()
        };
        Ok::<f64, DeckError>(value[0].as_ref().unwrap().eval(&[8.0, 0.0, 0.0], 2.0))
    };
    let gpa = 1.0 / 160.2176634;
    let deck = parse(&text.replace("TEXT", "0"));
    let LawSpec::Pmb(PmbStiffness::Bulk(k)) = deck.spec.materials[0].law else {
        panic!()
    };
    assert!((k - 38.0 * gpa).abs() < 1e-12, "{k}");
    assert!((deck.spec.materials[0].density - 2.7 * 6.02214076e-1 * 1.036426966e-4).abs() < 1e-10);
    for (written, wanted) in [
        ("3 eV / (2 Å)^3", 0.375),
        ("1 GPa * t / 4 ps", 0.5 * gpa),
        ("K * x / 16", 38.0 * gpa),
        ("1e4*t", 2.0 * gpa),
        ("t > 1 ? 1 GPa : 0", gpa),
    ] {
        let got = traction(written).unwrap();
        assert!((got - wanted).abs() < 1e-12, "{written}: {got} {wanted}");
    }
    // bars or eV/Å³?
    let error = traction("1 GPa + 100").unwrap_err();
    assert!(
        error
            .message
            .contains("a pressure and a number without unit"),
        "{error}"
    );
}

const OLD: &str = r#"own_horizon = "3 mm"
influence = "conical"
interface = "parallel"
volume_scaling = false
contact = { bonded = 0.8, free = 1.2 }
horizon = "3 mm"
[body]
file = "cloud.txt"
[sets]
left = { mark = 2 }
[material.a]
density = 1
law = { position_aware = { young = 1, poisson = 0.2 } }
fracture = { critical_stretch = 0.1, release = "at_once" }
[material.b]
density = 1
set = "left"
law = { lps_as_typed = { bulk = 1, shear = 1 } }
[[condition]]
set = "left"
stage = "motion"
traction = { x = 1 }
[[condition]]
set = "all"
traction = { y = 1 }
[[indenter]]
name = "ball"
radius = 1
center = [0, 0, 0]
mass = 1
spin = [0, 0, 1]
[[bond_factor]]
value = 0.5
[[toughness]]
stretch_factor = 2
[[precrack]]
kind = "absent"
point = 1
[thermal]
temperature = 1
seed = 1
[[probe]]
name = "turning"
measure = "indenter"
indenter = "ball"
of = "spin"
[run]
integrator = "still"
[statics]
control = "breaking"
[output]
fields = ["velocity", "mark"]
"#;
const TODAY: &str = r#"variable_horizon = "3 mm"
influence = "linear"
bond_mixing = "arithmetic"
partial_volume_correction = false
contact = { reference_fraction = 0.8, spacing_multiple = 1.2 }
horizon = "3 mm"
[body]
file = "cloud.txt"
[sets]
left = { block = 2 }
[material.a]
density = 1
law = { pals = { young = 1, poisson = 0.2 } }
fracture = { critical_stretch = 0.1, breakage = "before_force" }
[material.b]
density = 1
set = "left"
law = { lps_3d = { bulk = 1, shear = 1 } }
[[boundary_condition]]
set = "left"
stage = "dynamics"
traction = { x = 1 }
[[boundary_condition]]
set = "all"
traction = { y = 1 }
[[rigid_body]]
name = "ball"
radius = 1
center = [0, 0, 0]
mass = 1
angular_velocity = [0, 0, 1]
[[bond_stiffness]]
factor = 0.5
[[toughness]]
critical_stretch_factor = 2
[[precrack]]
kind = "excluded"
point = 1
[initial_velocities]
temperature = 1
seed = 1
[[probe]]
name = "turning"
measure = "rigid_body"
rigid_body = "ball"
of = "angular_velocity"
[run]
integrator = "none"
[statics]
control = "sequentially_linear"
[output]
fields = ["velocity", "block"]
"#;

/// A deck by the names of version 0.1 is the deck of today, with a note for each name.
#[test]
fn old_names_are_read_with_a_note() {
    let plain = |text: &str| {
        let source = source::Source::new(text, "old.toml", &[]);
        let (tree, renames) = source.tree_and_renames().unwrap();
        let table: toml::Table =
            serde::Deserialize::deserialize(toml::de::Deserializer::from(tree)).unwrap();
        (table, source.notes(&renames))
    };
    let ((old, said), (new, nothing)) = (plain(OLD), plain(TODAY));
    assert_eq!(old, new);
    assert_eq!(nothing, Vec::<String>::new());
    assert_eq!(said.len(), 23, "{said:#?}");
    assert_eq!(
        said[0],
        "old.toml:1: `own_horizon` is called `variable_horizon` now"
    );
}

#[test]
fn old_names_are_those_of_overrides_and_of_spec_paths_too() {
    let set = |key: &str, value: &str| with(key, value);
    let deck = set("indenter.0.radius", "7 mm").unwrap();
    let RigidShape::Sphere { radius } = deck.spec.loading.rigid_bodies[0].shape else {
        panic!()
    };
    assert_eq!(radius, 0.007);
    assert_eq!(deck.notes.len(), 1, "{:?}", deck.notes);
    assert!(deck.notes[0].contains("`indenter` is called `rigid_body` now"));
    let both = format!("{IMPACT}[[indenter]]\nradius = 1\n");
    let error = Deck::parse(&both, "impact.toml", &[]).unwrap_err();
    assert_eq!(
        error.message,
        "`indenter` is an older name of `rigid_body`, which is there, too"
    );
    assert_eq!(error.line, Some(24));
    let source = source::Source::new(IMPACT, "impact.toml", &[]);
    for path in ["rigid_bodies[0].radius", "rigid_bodies[0]"] {
        let at = locate::locate(&source, path).unwrap();
        assert!(at.start >= IMPACT.find("[[rigid_body]]").unwrap(), "{path}");
    }
    assert_eq!(
        renamed("condition.stage").unwrap(),
        "boundary_condition.stage"
    );
    assert_eq!(
        renamed("stretch_factor").unwrap(),
        "critical_stretch_factor"
    );
    assert_eq!(renamed("run.steps"), None);
}

/// A table that is written takes the place of the one before; keys on the way to a value do not.
#[test]
fn an_override_replaces_what_it_writes() {
    let law = |set: &[(&str, &str)]| {
        let set: Vec<(String, String)> = { set.iter() }
            .map(|(key, value)| (key.to_string(), value.to_string()))
            .collect();
        Deck::parse(IMPACT, "impact.toml", &set)
            .unwrap()
            .spec
            .materials
            .remove(0)
    };
    let springs = law(&[("material.law", "{ lps = { bulk = 2, shear = 1 } }")]);
    assert!(matches!(springs.law, LawSpec::Lps(_)), "{:?}", springs.law);
    // alpha of the deck is gone with its table, and stays where one key is set
    let whole = law(&[("material.fracture", "{ critical_stretch = 0.1 }")]);
    assert_eq!(whole.fracture.unwrap().alpha, 0.0);
    let one = law(&[("material.fracture.critical_stretch", "0.1")]);
    assert_eq!(one.fracture.unwrap().alpha, 0.25);
    let deck = with(
        "rigid_body.0",
        "{ radius = 1, center = [0, 0, 0], stiffness = 1 }",
    )
    .unwrap();
    assert_eq!(deck.spec.loading.rigid_bodies[0].stiffness, 1.0);
    assert!(with("material.law.pmb", "{ young = 1 }").is_ok());
}
