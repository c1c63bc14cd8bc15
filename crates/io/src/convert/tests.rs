use super::clock::Clock;
use super::*;
use crate::deck::Deck;
use crate::read::exodus::files::given;
use crate::read::exodus::parse_exodus;
use peridyne::spec::{ConditionKind, Horizon, TimeStep};
use proptest::prelude::*;
use std::fs;

mod filters;
mod rules;

const MESH: &str = "# x y z block_id volume\n0 0 0 1 1.0\n1 0 0 1 1.0\n0 1 0 2 2.0\n1 1 0 2 2.0\n";

const YAML: &str = r#"Peridigm:
  Verbose: false
  Discretization:
    Type: "Text File"
    Input Mesh File: "points.txt"
    Bond Filters:
      Notch:
        Type: "Rectangular_Plane"
        Normal_X: 1.0
        Normal_Y: 0.0
        Normal_Z: 0.0
        Lower_Left_Corner_X: 0.5
        Lower_Left_Corner_Y: 0.0
        Lower_Left_Corner_Z: -1.0
        Bottom_Unit_Vector_X: 0.0
        Bottom_Unit_Vector_Y: 1.0
        Bottom_Unit_Vector_Z: 0.0
        Bottom_Length: 0.25
        Side_Length: 2.0
  Materials:
    Glass:
      Material Model: "Elastic"
      Density: 2440.0
      Bulk Modulus: 40.0e9
      Shear Modulus: 30.0e9
      Thermal Expansion Coefficient: 1.0e-5
  Damage Models:
    Brittle:
      Damage Model: "Critical Stretch"
      Critical Stretch: 0.01
  Blocks:
    All:
      Block Names: "block_1 block_2"
      Material: "Glass"
      Damage Model: "Brittle"
      Horizon: 1.5
  Boundary Conditions:
    Foot: "1 2"
    Head: "head.txt"
    Hold:
      Type: "Prescribed Displacement"
      Node Set: "Foot"
      Coordinate: "y"
      Value: "0.0"
    Pull:
      Type: "Prescribed Displacement"
      Node Set: "Head"
      Coordinate: "y"
      Value: "0.1*t*exp(-t)"
    Throw:
      Type: "Initial Velocity"
      Node Set: "block_2"
      Coordinate: "x"
      Value: "3.0*y"
    Heat:
      Type: "Prescribed Temperature"
      Node Set: "Foot"
      Value: "300.0"
  Solver:
    Initial Time: 0.0
    Final Time: 1.0e-4
    Verlet:
      Fixed dt: 1.0e-5
  Compute Class Parameters:
    Top:
      Compute Class: "Block_Data"
      Calculation Type: "Maximum"
      Block: "block_2"
      Variable: "Displacement"
      Output Label: "Top_Displacement"
  Output:
    Output Filename: "notch"
    Output Frequency: 5
    Output Variables:
      Displacement: true
      Damage: true
      Weighted_Volume: true
      Velocity: false
      Top_Displacement: true
"#;

/// A deck in a folder with its mesh.
fn converted(name: &str, text: &str) -> (tempfile::TempDir, Result<Converted, ReadError>) {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("points.txt"), MESH).unwrap();
    fs::write(dir.path().join("head.txt"), "3\n4\n").unwrap();
    fs::write(dir.path().join(name), text).unwrap();
    let result = convert(&dir.path().join(name), "new.g");
    (dir, result)
}

fn failure(text: &str) -> String {
    converted("a.yaml", text).1.unwrap_err().to_string()
}

/// What was written, read again.
fn deck(dir: &Path, found: &Converted) -> Deck {
    found.write_mesh(&dir.join("new.g")).unwrap();
    let path = dir.join("new.toml");
    let deck = Deck::parse(&found.text, path.to_str().unwrap(), &[])
        .unwrap_or_else(|e| panic!("{e}\n{}", found.text));
    let old = deck.notes.iter().find(|n| n.contains("is called"));
    assert_eq!(old, None, "{}", found.text);
    deck
}

#[test]
fn what_maps_is_in_the_deck() {
    let (dir, found) = converted("notch.yaml", YAML);
    let found = found.unwrap();
    let deck = deck(dir.path(), &found);
    let spec = &deck.spec;
    assert_eq!(spec.bonds.horizon, Horizon::Length(1.5));
    assert_eq!(spec.materials.len(), 2);
    for m in &spec.materials {
        assert_eq!(m.density, 2440.0);
        assert!(m.fracture.is_some());
    }
    let set = |name: &str| spec.sets.iter().any(|s| s.name == name);
    assert!(set("Foot") && set("Head") && set("block_1") && set("block_2"));
    let [hold, pull] = &spec.loading.conditions[..] else {
        panic!("{}", found.text)
    };
    assert_eq!((&*hold.set, &*pull.set), ("Foot", "Head"));
    let ConditionKind::Displacement(value) = &pull.kind else {
        panic!("{pull:?}")
    };
    let value = value[1].as_ref().unwrap().eval(&[0.0; 3], 2.0);
    assert!((value - 0.2 * (-2.0f64).exp()).abs() < 1e-15);
    assert_eq!(spec.run.schedule.time_step, TimeStep::Fixed(1e-5));
    assert_eq!(spec.run.schedule.steps, 10);
    assert_eq!(deck.output.every, Some(5));
    assert_eq!(deck.output.exodus, Some("notch.e".into()));
    let fields = spec.run.fields.as_ref().unwrap();
    assert_eq!(fields[..], ["displacement", "damage"]);
    for part in [
        "polygon = [[0.5, 0.0, -1.0], [0.5, 0.25, -1.0], [0.5, 0.25, -3.0], [0.5, 0.0, -3.0]]",
        "name = \"Top_Displacement\"",
        "measure = \"max\"",
        "contact = false",
        "velocity = { x = \"3.0*y\" }",
    ] {
        assert!(found.text.contains(part), "{part}:\n{}", found.text);
    }
}

#[test]
fn what_does_not_map_is_named_with_its_line() {
    let (_dir, found) = converted("notch.yaml", YAML);
    let found = found.unwrap();
    let told: Vec<(usize, &str)> = { found.unmapped.iter() }
        .map(|u| (u.line, &*u.entry))
        .collect();
    let line = |part: &str| YAML.lines().position(|l| l.contains(part)).unwrap() + 1;
    let heat = line("Heat:");
    let wanted = [
        (
            line("Thermal"),
            "Materials / Glass / Thermal Expansion Coefficient = 1.0e-5",
        ),
        (
            heat + 1,
            "Boundary Conditions / Heat / Type = Prescribed Temperature",
        ),
        (heat + 2, "Boundary Conditions / Heat / Node Set = Foot"),
        (heat + 3, "Boundary Conditions / Heat / Value = 300.0"),
        (
            line("Weighted"),
            "Output / Output Variables / Weighted_Volume = true",
        ),
    ];
    assert_eq!(told, wanted);
    for u in &found.unmapped {
        let comment = format!("#   line {}: {}: {}\n", u.line, u.entry, u.why);
        assert!(found.text.contains(&comment), "{}", found.text);
    }
}

#[test]
fn xml_says_the_same_as_yaml() {
    // the same deck, list by list
    let mut xml = String::from("<ParameterList>\n");
    let mut depth = vec![];
    for line in YAML.lines().skip(1) {
        let indent = line.len() - line.trim_start().len();
        while depth.last().is_some_and(|d| *d >= indent) {
            depth.pop();
            xml += "</ParameterList>";
        }
        let (name, value) = line.trim().split_once(':').unwrap();
        match value.trim().trim_matches('"') {
            "" => {
                depth.push(indent);
                xml += &format!("<ParameterList name=\"{name}\">\n");
            }
            value => xml += &format!("<Parameter name=\"{name}\" type=\"x\" value=\"{value}\"/>\n"),
        }
    }
    xml += &"</ParameterList>".repeat(depth.len() + 1);
    let (_a, of_xml) = converted("notch.xml", &xml);
    let (_b, of_yaml) = converted("notch.yaml", YAML);
    let (of_xml, of_yaml) = (of_xml.unwrap(), of_yaml.unwrap());
    let rest = |found: &Converted| found.text.split_once("title").unwrap().1.to_string();
    assert_eq!(rest(&of_xml), rest(&of_yaml));
    let entries = |found: &Converted| -> Vec<String> {
        found.unmapped.iter().map(|u| u.entry.clone()).collect()
    };
    assert_eq!(entries(&of_xml), entries(&of_yaml));
}

#[test]
fn blocks_and_node_sets_are_in_the_mesh() {
    let (dir, found) = converted("notch.yaml", YAML);
    let path = dir.path().join("new.g");
    found.unwrap().write_mesh(&path).unwrap();
    let points = parse_exodus(fs::read(&path).unwrap(), "new.g").unwrap();
    assert_eq!(points.cloud.volume, [1.0, 1.0, 2.0, 2.0]);
    assert_eq!(points.cloud.mark, [1, 1, 2, 2]);
    let sets: Vec<(&str, &[u32])> = { points.cloud.sets.iter() }
        .map(|(n, s)| (&**n, &**s))
        .collect();
    let wanted: [(&str, &[u32]); 4] = [
        ("block_1", &[0, 1]),
        ("block_2", &[2, 3]),
        ("Foot", &[0, 1]),
        ("Head", &[2, 3]),
    ];
    assert_eq!(sets, wanted);
}

#[test]
fn a_mesh_in_netcdf4_is_that_of_netcdf3() {
    let yaml = [
        ("Type: \"Text File\"", "Type: \"Exodus\""),
        ("points.txt", "mesh.g"),
        ("block_1 block_2", "steel block_20"),
        ("\"block_2\"", "\"block_20\""),
        ("    Foot: \"1 2\"\n    Head: \"head.txt\"\n", ""),
        ("\"Foot\"", "\"left\""),
        ("\"Head\"", "\"nodelist_7\""),
    ];
    let yaml = { yaml.into_iter() }.fold(YAML.to_string(), |t, (a, b)| t.replace(a, b));
    let of = |file: &str| {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("mesh.g"), given(file)).unwrap();
        let deck = dir.path().join("notch.yaml");
        fs::write(&deck, &yaml).unwrap();
        let found = convert(&deck, "new.g").unwrap();
        let mesh = dir.path().join("new.g");
        found.write_mesh(&mesh).unwrap();
        let points = parse_exodus(fs::read(&mesh).unwrap(), "new.g").unwrap();
        (found.text, points)
    };
    let (text, points) = of("cubit_netcdf4.g");
    assert_eq!(points.cloud.volume.len(), 2);
    let sets: Vec<&str> = points.cloud.sets.iter().map(|s| &*s.0).collect();
    let names = [
        "steel",
        "block_20",
        "both",
        "left",
        "nodelist_7",
        "surface_4",
    ];
    assert_eq!(sets, names);
    assert_eq!((text, points), of("cubit_netcdf3_classic.g"));
}

/// PeriLab's: two dimensions, sets by ranges and conditions, damage switched on in the solver.
const LAB: &str = r#"PeriLab:
  Discretization:
    Type: Text File
    Input Mesh File: flat.txt
    Node Sets:
      Foot: 1:2
      Head: y > 0.5
  Models:
    Material Models:
      Glass:
        Material Model: PD Solid Elastic
        Symmetry: isotropic plane stress
        Young's Modulus: 70.0e3
        Poisson's Ratio: 0.25
        Zero Energy Control: Global
    Damage Models:
      Brittle:
        Damage Model: Critical Energy
        Critical Value: 0.5
  Blocks:
    sheet:
      Block ID: 1
      Density: 2.4e-9
      Horizon: 1.5
      Material Model: Glass
      Damage Model: Brittle
  Boundary Conditions:
    Pull:
      Variable: Displacements
      Node Set: Head
      Coordinate: y
      Value: 2*t
      Type: Dirichlet
    Up:
      Variable: Displacements
      Node Set: Head
      Coordinate: z
      Value: 0
      Type: Dirichlet
  Solver:
    Damage Models: SWITCH
    Initial Time: 1.0
    Final Time: 3.0
    Static:
      Number of Steps: 4
  Outputs:
    One:
      Output File Type: Exodus
      Output Filename: flat
      Number of Output Steps: 2
      Output Variables:
        Displacements: true
"#;

fn lab(switch: &str) -> (tempfile::TempDir, Converted) {
    let dir = tempfile::tempdir().unwrap();
    let mesh = "# a sheet\nheader: x y block_id volume\n0 0 1 1\n1 0 1 1\n0 1 1 1\n1 1 1 1\n";
    fs::write(dir.path().join("flat.txt"), mesh).unwrap();
    let path = dir.path().join("flat.yaml");
    fs::write(&path, LAB.replace("SWITCH", switch)).unwrap();
    let found = convert(&path, "new.g").unwrap();
    (dir, found)
}

#[test]
fn decks_of_perilab_are_flat_static_and_break_if_told_so() {
    let (dir, found) = lab("true");
    let deck = deck(dir.path(), &found);
    assert_eq!(deck.spec.space.dimension, 2);
    assert!(found.text.contains("plane = \"stress\""));
    assert!(deck.spec.materials[0].fracture.is_some());
    assert!(found.remarks.iter().any(|r| r.contains("Critical Energy")));
    // t from 0 to 1 is 1 to 3 there
    let ConditionKind::Displacement(value) = &deck.spec.loading.conditions[0].kind else {
        panic!()
    };
    let value = value[1].as_ref().unwrap();
    assert_eq!([0.0, 1.0].map(|t| value.eval(&[0.0; 3], t)), [2.0, 6.0]);
    assert_eq!(deck.spec.run.schedule.steps, 4);
    assert_eq!(deck.output.every, Some(2));
    let told: Vec<&str> = found.unmapped.iter().map(|u| &*u.why).collect();
    assert!(told.contains(&"there is no z in 2-D"), "{told:?}");
    let (_dir, whole) = lab("false");
    assert!(!whole.text.contains("fracture ="), "{}", whole.text);
    assert!(
        whole
            .unmapped
            .iter()
            .any(|u| u.why.contains("Damage Models: true"))
    );
}

#[test]
fn what_is_no_deck_is_told() {
    for (text, expected) in [
        ("Peridigm:\n  Blocks:\n    A: 1\n", "no list Discretization"),
        ("a: 1\n", "no list Peridigm: or PeriLab:"),
        ("a: [1\n", "no YAML"),
        ("", "no list Peridigm"),
        ("<ParameterList><x/></ParameterList>", "found <x>"),
        ("<ParameterList>", "no XML"),
        ("&a b: *a\n", "aliases"),
    ] {
        let told = failure(text);
        assert!(told.contains(expected), "{text}: {told}");
    }
    let without = |part: &str, by: &str| failure(&YAML.replace(part, by));
    for (told, expected) in [
        (
            without("points.txt", "nothing.txt"),
            "nothing.txt: cannot read it",
        ),
        (
            without("\"Text File\"", "\"Albany\""),
            "type \"albany\" is not read",
        ),
        (
            without("\"Elastic\"", "\"Pals\""),
            "no law here is the material model \"Pals\"",
        ),
        (
            without("\"1 2\"", "\"one two\""),
            "node set Foot: \"one two\" is neither",
        ),
        (without("Verlet:", "Euler:"), "the solver is none of Verlet"),
        (
            without("Final Time: 1.0e-4", "Final Time: 0.0"),
            "ends at 0",
        ),
        (
            without("block_1 block_2", "block_1"),
            "blocks block_2 of the mesh",
        ),
        (
            without("Horizon: 1.5", "Horizon: x*2"),
            "no block has a Horizon",
        ),
    ] {
        assert!(told.contains(expected), "{told}: {expected}");
    }
}

#[test]
fn numbers_of_points_that_are_not_there_are_noted() {
    let (_dir, found) = converted("a.yaml", &YAML.replace("\"1 2\"", "\"1 2 9\""));
    let remarks = found.unwrap().remarks;
    assert!(
        remarks
            .iter()
            .any(|r| r.contains("there is no point 9, the mesh has 4")),
        "{remarks:?}"
    );
}

#[test]
fn influence_functions_are_mapped_or_named() {
    for (given, here, left) in [
        ("One", "constant", false),
        ("1.0/zeta", "inverse", false),
        ("Parabolic Decay", "constant", true),
        ("exp(-zeta)", "constant", true),
    ] {
        let with = format!("Discretization:\n    Influence Function: \"{given}\"\n");
        let (_dir, found) = converted("a.yaml", &YAML.replace("Discretization:\n", &with));
        let found = found.unwrap();
        assert!(
            found.text.contains(&format!("\ninfluence = \"{here}\"\n")),
            "{given}"
        );
        let named = found.unmapped.iter().any(|u| u.entry.contains("Influence"));
        assert_eq!(named, left, "{given}");
    }
}

#[test]
fn times_are_put_in_place_of_t() {
    let clock = |start, scale| Clock { start, scale };
    let text = "sin(t) + tan(x)*t + sqrt(t)";
    let same = clock(0.0, 1.0).expression(text).unwrap();
    assert_eq!(same, text);
    let other = clock(1.0, 2.0).expression(text).unwrap();
    assert_eq!(
        other,
        "sin((1.0 + 2.0*t)) + tan(x)*(1.0 + 2.0*t) + sqrt((1.0 + 2.0*t))"
    );
    assert_eq!(clock(0.0, 1.0).expression("value = 2*x;").unwrap(), "2*x");
    let told = clock(0.0, 1.0)
        .expression("if(t<=1){value=1;}")
        .unwrap_err();
    assert!(told.contains("no expression"), "{told}");
    assert!(clock(0.0, 1.0).expression("pow(x, 2").is_err());
}

proptest! {
    #[test]
    fn no_text_is_too_odd(text in "(<ParameterList|[-a:&*\\[\\]{}\"'|>#\n ]|name=\"a\"|Peridigm:){0,40}") {
        if let Err((line, message)) = syntax::tree(&text) {
            prop_assert!(!message.is_empty(), "{}", line);
        }
    }

    #[test]
    fn damaged_decks_are_converted_or_refused(at in any::<prop::sample::Index>(), by in "[ -~\n]{0,3}") {
        let mut text = YAML.to_string();
        let place = at.index(text.len());
        text.replace_range(place..place + 1, &by);
        let _ = converted("a.yaml", &text).1;
    }
}
