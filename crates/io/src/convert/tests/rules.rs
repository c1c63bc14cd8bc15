//! What the other programs do, by hand, against what the new deck says.

use super::*;
use peridyne::spec::{LawSpec, MaterialSpec};

/// A cube of five points to an edge, one apart, from 0.
pub fn cube() -> String {
    let mut mesh = String::from("# x y z block volume\n");
    for n in 0..125 {
        mesh += &format!("{} {} {} 1 1.0\n", n % 5, n / 5 % 5, n / 25);
    }
    mesh
}

/// A folder with `body.txt` and a deck; what becomes of it.
pub fn told(mesh: &str, deck: &str) -> (tempfile::TempDir, Result<Converted, ReadError>) {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("body.txt"), mesh).unwrap();
    let path = dir.path().join("a.yaml");
    fs::write(&path, deck).unwrap();
    let found = convert(&path, "new.g");
    (dir, found)
}

pub fn read(mesh: &str, deck: &str) -> (Converted, Deck) {
    let (dir, found) = told(mesh, deck);
    let found = found.unwrap();
    let deck = super::deck(dir.path(), &found);
    (found, deck)
}

/// A deck of Peridigm with parts of its lists.
pub fn peridigm(discretization: &str, conditions: &str, solver: &str) -> String {
    format!(
        "Peridigm:
  Discretization:
    Type: Text File
    Input Mesh File: body.txt
{discretization}
  Materials:
    M:
      Material Model: Elastic
      Density: 1.0
      Bulk Modulus: 2.0
      Shear Modulus: 1.0
  Blocks:
    B:
      Block Names: block_1
      Material: M
      Horizon: 1.5
  Boundary Conditions:
    Left Node Set: 1 2
    Right Node Set: 3 4
{conditions}
  Solver:
{solver}
"
    )
}

/// One of PeriLab.
pub fn perilab(material: &str, conditions: &str, solver: &str) -> String {
    format!(
        "PeriLab:
  Discretization:
    Type: Text File
    Input Mesh File: body.txt
    Node Sets:
      Left: 1 2
      Right: 3:4
  Models:
    Material Models:
      M:
{material}
  Blocks:
    block_1:
      Block ID: 1
      Density: 1.0
      Horizon: 1.5
      Material Model: M
  Boundary Conditions:
{conditions}
  Solver:
{solver}
"
    )
}

pub const SHEET: &str = "header: x y block_id volume\n0 0 1 1\n1 0 1 1\n0 1 1 1\n1 1 1 2\n";
const PULLED: &str = "    Verlet:\n      Fixed dt: 1.0e-4";

fn condition(kind: &str, set: &str, value: &str) -> String {
    format!(
        "    {kind} {set}:\n      Type: {kind}\n      Node Set: {set}\n      Coordinate: x\n      Value: \"{value}\"\n"
    )
}

/// The displacement along x of the first condition at a place after a time.
fn displaced(deck: &Deck, x: [f64; 3], t: f64) -> f64 {
    let ConditionKind::Displacement(value) = &deck.spec.loading.conditions[0].kind else {
        panic!("{:?}", deck.spec.loading.conditions)
    };
    value[0].as_ref().unwrap().eval(&x, t)
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b.abs().max(1e-3), "{a} {b}");
}

pub fn times(from: f64, to: f64) -> String {
    format!("    Initial Time: {from:?}\n    Final Time: {to:?}\n{PULLED}")
}

#[test]
fn a_prescribed_displacement_is_what_it_changes_by() {
    let pull = |value: &str, from: f64, before: &str| {
        let conditions =
            before.to_string() + &condition("Prescribed Displacement", "Right Node Set", value);
        let text = peridigm("", &conditions, &times(from, from + 0.01));
        read(&cube(), &text).1
    };
    // f(t) - f(0)
    let deck = pull("0.01*cos(100*t)", 0.0, "");
    near(
        displaced(&deck, [0.0; 3], 0.005),
        0.01 * (0.5f64.cos() - 1.0),
    );
    near(displaced(&deck, [0.0; 3], 0.0), 0.0);
    // a value that does not change is taken itself, whenever it begins
    for from in [0.0, 2.0] {
        near(displaced(&pull("0.3", from, ""), [0.0; 3], 0.004), 0.3);
    }
    // time begins at 2: f(2 + t) - f(2) = 5 t
    near(displaced(&pull("5*t", 2.0, ""), [0.0; 3], 0.004), 0.02);
    // of the place: (x + 1) (cos - 1)
    let deck = pull("(x+1)*cos(100*t)", 0.0, "");
    near(
        displaced(&deck, [3.0, 0.0, 0.0], 0.005),
        4.0 * (0.5f64.cos() - 1.0),
    );
    // on what is there: 0.1 x + 5 t
    let start = condition("Initial Displacement", "Right Node Set", "0.1*x");
    let deck = pull("1 + 5*t", 0.0, &start);
    near(displaced(&deck, [3.0, 0.0, 0.0], 0.004), 0.3 + 0.02);
    // a ramp from 0 that is then held has no other value
    let deck = pull("min(t, 0.005)", 0.0, "");
    near(displaced(&deck, [0.0; 3], 0.009), 0.005);
}

#[test]
fn what_no_expression_says_of_a_prescribed_displacement_is_refused() {
    let refused = |value: &str, before: &str| -> String {
        let conditions =
            before.to_string() + &condition("Prescribed Displacement", "Right Node Set", value);
        let (_dir, found) = told(&cube(), &peridigm("", &conditions, &times(0.0, 0.01)));
        let whys: Vec<String> = found.unwrap().unmapped.into_iter().map(|u| u.why).collect();
        whys.join("\n")
    };
    // it jumps to f where it is held
    let why = refused("0.1 + min(t, 0.005)", "");
    assert!(why.contains("takes it itself in steps"), "{why}");
    // at x = 0 it never changes, elsewhere it does; points 3 and 4 have x of 2 and 3
    assert!(refused("0.1 + (x - 2)*t", "").contains("takes it itself"));
    let part = "    One Node Set: 3\n".to_string()
        + &condition("Initial Displacement", "One Node Set", "0.1*y+0.2");
    assert!(refused("t", &part).contains("split the set"));
}

#[test]
fn initial_values_are_those_at_time_0() {
    let conditions = condition("Initial Velocity", "Left Node Set", "3*t + 1");
    let (_, deck) = read(&cube(), &peridigm("", &conditions, &times(2.0, 2.01)));
    let value = deck.spec.loading.initial[0].velocity[0].as_ref().unwrap();
    near(value.eval(&[0.0; 3], 0.0), 1.0);
    // PeriLab has them at time 0 alone
    let lab = |from: f64| {
        let conditions = "    V:\n      Variable: Velocity\n      Node Set: Left\n      Coordinate: x\n      Value: 2\n      Type: Initial\n";
        let material = "        Material Model: PD Solid Elastic\n        Bulk Modulus: 2.0\n        Shear Modulus: 1.0";
        told(
            &cube(),
            &perilab(material, conditions, &times(from, from + 0.01)),
        )
        .1
        .unwrap()
    };
    assert!(lab(0.0).text.contains("velocity = { x = \"2\" }"));
    assert!(
        lab(1.0)
            .unmapped
            .iter()
            .any(|u| u.why.contains("at time 0 alone"))
    );
}

/// Cells of a grid, one apart, with a horizon.
fn grid(count: [usize; 3], horizon: f64, ball: bool) -> Result<Converted, ReadError> {
    let kind = ["", "    NeighborhoodType: Spherical\n"][usize::from(ball)];
    let mut list = String::from("    TensorProduct3DMeshGenerator:\n      Type: PdQuickGrid\n");
    for (axis, n) in ["X", "Y", "Z"].iter().zip(count) {
        list += &format!(
            "      {axis} Origin: 0.0\n      {axis} Length: {:?}\n      Number Points {axis}: {n}\n",
            n as f64
        );
    }
    let deck = peridigm(&(kind.to_string() + &list), "", &times(0.0, 0.01))
        .replace("Text File\n    Input Mesh File: body.txt", "PdQuickGrid")
        .replace("Right Node Set: 3 4", "Right Node Set: 2")
        .replace("Horizon: 1.5", &format!("Horizon: {horizon:?}"));
    told("", &deck).1
}

fn horizon_of(found: &Converted) -> f64 {
    let mut lines = found.text.lines();
    let line = lines.find_map(|l| l.strip_prefix("horizon = "));
    line.unwrap().parse().unwrap()
}

#[test]
fn families_are_those_of_the_other_program() {
    // |ξ|² < δ² on a grid: bonds of exactly the horizon are none
    let found = grid([3, 1, 1], 2.0, true).unwrap();
    let found = horizon_of(&found);
    assert!(found < 2.0 && found > 2.0 - 1e-6, "{found}");
    assert_eq!(horizon_of(&grid([4, 2, 1], 2.5, true).unwrap()), 2.5);
    // a box of one cell around has the diagonals
    let found = grid([2, 2, 1], 1.1, false).unwrap();
    let why = &found
        .unmapped
        .iter()
        .find(|u| u.entry.contains("Horizon"))
        .unwrap()
        .why;
    assert!(
        why.contains("4 directed bonds are missing, 0 are added"),
        "{why}"
    );
    // along a line a box is a ball
    assert!(grid([5, 1, 1], 1.1, false).unwrap().unmapped.is_empty());
    // |ξ|² ≤ δ² elsewhere, also of PeriLab: nothing changes
    let mut mesh = String::new();
    for n in 0..9 {
        mesh += &format!("{:?} 0 0 1 1\n", f64::from(n) * 0.1);
    }
    let deck = peridigm("", "", &times(0.0, 0.01)).replace("Horizon: 1.5", "Horizon: 0.2");
    assert_eq!(horizon_of(&told(&mesh, &deck).1.unwrap()), 0.2);
}

#[test]
fn steps_are_counted_as_there() {
    let steps = |deck: &str| {
        let (_, deck) = read(&cube(), deck);
        let TimeStep::Fixed(dt) = deck.spec.run.schedule.time_step else {
            panic!("{:?}", deck.spec.run.schedule)
        };
        (deck.spec.run.schedule.steps, dt)
    };
    // Peridigm shortens a step that is given: 0.01 / (3e-3 · 0.5) = 6.67
    let solver =
        "    Final Time: 0.01\n    Verlet:\n      Fixed dt: 3.0e-3\n      Safety Factor: 0.5";
    assert_eq!(steps(&peridigm("", "", solver)), (6, 1.5e-3));
    // PeriLab divides the time: 0.01 / 3e-3 = 3.33, four steps
    let material = "        Material Model: PD Solid Elastic\n        Bulk Modulus: 2.0\n        Shear Modulus: 1.0";
    let solver = solver.replace("    Final", "    Initial Time: 0.0\n    Final");
    assert_eq!(steps(&perilab(material, "", &solver)), (4, 2.5e-3));
    // times of load steps
    let solver = "    QuasiStatic:\n      Time Steps: \"1.0 2.0 3.0 4.0\"";
    let pull = condition("Prescribed Displacement", "Right Node Set", "t");
    let (_, deck) = read(&cube(), &peridigm("", &pull, solver));
    assert_eq!(deck.spec.run.schedule.steps, 3);
    near(displaced(&deck, [0.0; 3], 1.0), 3.0);
    let uneven = solver.replace("3.0 4.0", "3.5 4.0");
    let found = told(&cube(), &peridigm("", &pull, &uneven)).1.unwrap();
    assert!(
        found
            .unmapped
            .iter()
            .any(|u| u.why.contains("increments of a load are equal"))
    );
}

#[test]
fn numbers_of_frames_are_those_of_perilab() {
    let material = "        Material Model: PD Solid Elastic\n        Bulk Modulus: 2.0\n        Shear Modulus: 1.0";
    let output = "  Outputs:\n    O:\n      Output Filename: o\n      Number of Output Steps: 30\n      Output Variables:\n        Displacements: true\n";
    let of = |solver: &str| {
        read(&cube(), &(perilab(material, "", solver) + output))
            .1
            .output
    };
    // 100 steps: ceil(100 / 30)
    let known = of(&times(0.0, 0.01));
    assert_eq!((known.every, known.frames), (Some(4), None));
    // the step follows from a safety factor
    let open =
        of("    Initial Time: 0.0\n    Final Time: 0.01\n    Verlet:\n      Safety Factor: 0.5");
    assert_eq!((open.every, open.frames), (None, Some(30)));
    assert_eq!(open.every(100), Some(4));
    assert_eq!(open.every(7), Some(1));
}

#[test]
fn flat_bodies_of_perilab_without_symmetry_have_constants_of_a_solid() {
    let law = |model: &str, more: &str| {
        let material = format!("        Material Model: {model}\n{more}");
        let (_dir, found) = told(SHEET, &perilab(&material, "", &times(0.0, 0.01)));
        found
    };
    let found = law(
        "PD Solid Elastic",
        "        Young's Modulus: 10.0\n        Poisson's Ratio: 0.25",
    );
    // K = 10/(3 - 1.5), G = 10/2.5
    let text = found.unwrap().text;
    let [k, g] = ["bulk = ", "shear = "].map(|key| {
        let rest = text.split_once(key).unwrap_or_else(|| panic!("{text}")).1;
        rest.split([',', ' '])
            .next()
            .unwrap()
            .parse::<f64>()
            .unwrap()
    });
    assert!(text.contains("lps_3d"), "{text}");
    near(k, 10.0 / 1.5);
    near(g, 4.0);
    // c = 12 E/(π δ⁴), and E = K of Poisson's ratio 1/3
    for (modulus, young) in [
        ("Young's Modulus", 10.0),
        ("Bulk Modulus", 10.0),
        ("Shear Modulus", 26.666666666666668),
    ] {
        let given = 10.0;
        let text = law(
            "Bond-based Elastic",
            &format!("        {modulus}: {given:?}"),
        )
        .unwrap()
        .text;
        let rest = text
            .split_once("micromodulus = ")
            .unwrap_or_else(|| panic!("{text}"))
            .1;
        let c: f64 = rest.split([',', ' ']).next().unwrap().parse().unwrap();
        near(c, 12.0 * young / (std::f64::consts::PI * 1.5f64.powi(4)));
    }
    let two = "        Young's Modulus: 10.0\n        Poisson's Ratio: 0.25";
    let failure = law("Correspondence Elastic", two).unwrap_err().to_string();
    assert!(
        failure.contains("asks for plane stress or plane strain"),
        "{failure}"
    );
    // what is written in other words
    let text = law(
        "PD Solid Elastic",
        &format!("{two}\n        Symmetry: Isotropic Plane Strain"),
    )
    .unwrap()
    .text;
    assert!(
        text.contains("plane = \"strain\"") && text.contains("law = { lps = "),
        "{text}"
    );
}

#[test]
fn planes_of_peridigm_have_a_height() {
    let material = |more: &str| {
        peridigm("", "", &times(0.0, 0.01)).replace(
            "Material Model: Elastic\n      Density: 1.0\n      Bulk Modulus: 2.0\n      Shear Modulus: 1.0",
            &format!("Material Model: Elastic Bond Based\n      Density: 1.0\n{more}"),
        )
    };
    let flat = "0 0 7 1 0.5\n1 0 7 1 0.5\n0 1 7 1 0.5\n1 1 7 1 0.5\n";
    let text = material("      Young's Modulus: 2.0\n      Plane Stress: true\n      Height: 0.25");
    let (_dir, found) = told(flat, &text);
    let found = found.unwrap();
    // areas 0.5/0.25; K = 0.75 E of two dimensions; c = 12 K/(π δ³)
    assert_eq!(found.points.volume, [2.0; 4]);
    assert!(found.text.contains("thickness = 0.25\n"), "{}", found.text);
    let c = 12.0 * 1.5 / (std::f64::consts::PI * 1.5f64.powi(3));
    assert!(
        found.text.contains(&format!("micromodulus = {c:?}")),
        "{}",
        found.text
    );
    for (text, why) in [
        (
            material("      Young's Modulus: 2.0\n      Plane Stress: true"),
            "asks for the Height",
        ),
        (
            peridigm("", "", &times(0.0, 0.01)).replace(
                "Shear Modulus: 1.0",
                "Shear Modulus: 1.0\n      Plane Strain: true",
            ),
            "bond-based material alone",
        ),
    ] {
        let failure = told(flat, &text).1.unwrap_err().to_string();
        assert!(failure.contains(why), "{failure}");
    }
    let deep = flat.replace("1 1 7", "1 1 8");
    let text = material("      Young's Modulus: 2.0\n      Plane Stress: true\n      Height: 0.25");
    let failure = told(&deep, &text).1.unwrap_err().to_string();
    assert!(failure.contains("points are in none"), "{failure}");
}

#[test]
fn conditions_of_perilab_keep_their_meaning() {
    let material = "        Material Model: PD Solid Elastic\n        Symmetry: isotropic plane stress\n        Bulk Modulus: 2.0\n        Shear Modulus: 1.0";
    let of = |set: &str, variable: &str, value: &str, kind: &str| {
        let conditions = format!(
            "    C:\n      Variable: {variable}\n      Node Set: {set}\n      Coordinate: x\n      Value: {value}\n      Type: {kind}\n"
        );
        told(SHEET, &perilab(material, &conditions, &times(1.0, 1.01)))
            .1
            .unwrap()
    };
    // displacements are f itself; st is the time since the start, operators have dots
    let found = of("Left", "Displacements", "0.5 .+ 2 .* st", "Dirichlet");
    assert!(
        found
            .text
            .contains("displacement = { x = \"0.5 + 2 * ((1.0 + t) - 1.0)\" }"),
        "{}",
        found.text
    );
    // unions
    let found = of("Left + Right", "Displacements", "0", "Dirichlet");
    assert_eq!(found.points.of("Left + Right"), [0, 1, 2, 3]);
    assert!(
        found.text.contains("set = \"Left + Right\""),
        "{}",
        found.text
    );
    // a force on each point, by its volume; those of Right differ
    assert!(
        of("Left", "Forces", "3", "Dirichlet")
            .text
            .contains("body_force = { x = \"(3)/1.0\" }")
    );
    let whys = |found: Converted| {
        found
            .unmapped
            .iter()
            .map(|u| u.why.clone())
            .collect::<String>()
    };
    assert!(whys(of("Right", "Forces", "3", "Dirichlet")).contains("volumes differ"));
    assert!(whys(of("Left", "Forces", "3", "Neumann")).contains("applies none"));
}

#[test]
fn bonds_that_break_in_compression_are_refused() {
    let found = converted(
        "a.yaml",
        &YAML.replace(
            "Critical Stretch: 0.01",
            "Critical Stretch: 0.01\n      Only Tension: false",
        ),
    )
    .1
    .unwrap();
    assert!(
        found
            .unmapped
            .iter()
            .any(|u| u.why.contains("in tension alone"))
    );
}

/// A square of two triangles of gmsh.
const MSH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n2\n1 2 2 G 1 1 2 3\n2 2 2 G 1 1 3 4\n$EndElements\n";

#[test]
fn meshes_without_groups_are_block_1() {
    let material = "        Material Model: PD Solid Elastic\n        Symmetry: isotropic plane stress\n        Bulk Modulus: 2.0\n        Shear Modulus: 1.0";
    // with a group of a plane PeriLab does the same
    for group in ["0", "7"] {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("body.msh"), MSH.replace('G', group)).unwrap();
        let path = dir.path().join("a.yaml");
        let deck = perilab(material, "", &times(0.0, 0.01))
            .replace("Text File", "Gmsh")
            .replace("body.txt", "body.msh");
        fs::write(
            &path,
            deck.replace("Left: 1 2", "Left: All")
                .replace("3:4", "1:1:2"),
        )
        .unwrap();
        let found = convert(&path, "new.g").unwrap();
        assert_eq!(found.points.block, [1, 1], "group {group}");
        assert_eq!(
            (found.points.of("Left"), found.points.of("Right")),
            (vec![0, 1], vec![0, 1])
        );
    }
}

/// Two points of two blocks of Peridigm; laws of the deck.
fn two_blocks(first: &str, second: &str) -> (Converted, Deck) {
    let mesh = "# x y z block volume\n0 0 0 1 1.0\n1 0 0 2 1.0\n0 1 0 1 1.0\n0 0 1 2 1.0\n";
    let deck = format!(
        "Peridigm:
  Discretization:
    Type: Text File
    Input Mesh File: body.txt
  Materials:
    One:
      Density: 1.0
      Bulk Modulus: 2.0
{first}
    Other:
      Density: 1.0
      Bulk Modulus: 4.0
{second}
  Blocks:
    A:
      Block Names: block_1
      Material: One
      Horizon: 1.6
    B:
      Block Names: block_2
      Material: Other
      Horizon: 1.6
  Solver:
    Final Time: 1.0
    Verlet:
      Fixed dt: 0.5
"
    );
    read(mesh, &deck)
}

#[test]
fn ends_of_a_bond_between_materials_give_half_of_their_constants() {
    // c/2 of each end is added there; here springs in a row where nothing is said
    let pmb = "      Material Model: Elastic Bond Based";
    let (found, _) = two_blocks(pmb, pmb);
    assert!(
        found.text.contains("\nbond_mixing = \"arithmetic\"\n"),
        "{}",
        found.text
    );
    let lps = "      Material Model: Elastic\n      Shear Modulus: 1.0";
    let (found, _) = two_blocks(lps, lps);
    assert!(!found.text.contains("interface"), "{}", found.text);
}

#[test]
fn what_is_elastic_beside_what_yields_is_a_law_that_never_yields() {
    let lps = "      Material Model: Elastic\n      Shear Modulus: 1.0";
    let plastic =
        "      Material Model: Elastic Plastic\n      Shear Modulus: 1.0\n      Yield Stress: 0.1";
    let (found, deck) = two_blocks(lps, plastic);
    let named = |m: &MaterialSpec| match &m.law {
        LawSpec::Named(law) => law.name.clone(),
        _ => String::new(),
    };
    let laws: Vec<String> = deck.spec.materials.iter().map(named).collect();
    assert_eq!(laws, ["elastic_plastic"; 2], "{}", found.text);
    assert!(
        found.text.contains("yield_stress = 1e100"),
        "{}",
        found.text
    );
}

#[test]
fn numerical_damping_is_a_part_of_the_velocity_in_each_step() {
    let material = "        Material Model: PD Solid Elastic\n        Bulk Modulus: 2.0\n        Shear Modulus: 1.0";
    let deck = |solver: &str| perilab(material, "", solver);
    let fixed = deck(
        "    Final Time: 1.0\n    Verlet:\n      Fixed dt: 0.25\n      Numerical Damping: 1.0e-3\n",
    );
    let (found, _) = read(&cube(), &fixed);
    // 1e-3 in a step of 0.25 of a density of 1
    let text = found
        .text
        .split_once("damping = ")
        .map(|(_, t)| t.lines().next());
    let damping: f64 = text.flatten().unwrap().parse().unwrap();
    near(damping, 4e-3);
    let free = deck(
        "    Final Time: 1.0\n    Verlet:\n      Safety Factor: 0.5\n      Numerical Damping: 1.0e-3\n",
    );
    let (found, _) = read(&cube(), &free);
    assert!(
        found
            .unmapped
            .iter()
            .any(|u| u.entry.contains("Numerical Damping")),
        "{}",
        found.text
    );
}
