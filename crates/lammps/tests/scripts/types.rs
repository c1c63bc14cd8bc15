//! What several atom types may have, and what is said where LAMMPS does something unexpected or unknown.

use peridyne_lammps::host::Console;
use peridyne_lammps::model::ModelHost;
use peridyne_lammps::{Options, ScriptError, run_text};

#[derive(Default)]
struct Paper(Vec<String>);

impl Console for Paper {
    fn print(&mut self, _: &str) {}
    fn note(&mut self, line: &str) {
        self.0.push(line.to_string());
    }
}

/// A bar whose halves, `gap` spacings apart, are of type 1 and 2; line 14 is the first of `coefficients`.
fn run(style: &str, coefficients: &str, gap: f64, more: &str) -> Result<Paper, Box<ScriptError>> {
    run_script(&script(style, coefficients, gap, more))
}

fn script(style: &str, coefficients: &str, gap: f64, more: &str) -> String {
    let (low, high) = (2.6 + gap, 5.6 + gap);
    format!(
        "units si\natom_style peri\natom_modify map array\nboundary s s s\nlattice sc 0.0005\n\
         region box block -1 20 -1 4 -1 4 units lattice\nregion a block -0.1 2.6 -0.1 2.1 -0.1 2.1\n\
         region b block {low} {high} -0.1 2.1 -0.1 2.1\ncreate_box 2 box\ncreate_atoms 1 region a\n\
         create_atoms 2 region b\ntimestep 1e-7\npair_style peri/{style}\n{coefficients}\n\
         set group all density 2200\nset group all volume 1.25e-10\nfix 1 all nve\n{more}\nrun 20\n"
    )
}

fn run_script(text: &str) -> Result<Paper, Box<ScriptError>> {
    let mut paper = Paper::default();
    let output = tempfile::tempdir().unwrap();
    let options = Options {
        output: output.path().into(),
        ..Options::default()
    };
    run_text(
        "in.bar",
        text,
        &options,
        &mut ModelHost::default(),
        &mut paper,
    )
    .map(|_| paper)
}

#[track_caller]
fn refused(style: &str, coefficients: &str, line: usize, message: &str, help: &str) {
    let error = run(style, coefficients, 0.0, "").map(|_| ()).unwrap_err();
    assert!(error.message.contains(message), "{error}");
    assert!(
        error.help.as_ref().unwrap().contains(help),
        "{:?}",
        error.help
    );
    assert_eq!(error.line, line, "{error}");
    let shown = format!("{:?}", miette::Report::new(*error));
    assert!(shown.contains("here"), "the place is not marked: {shown}");
}

#[track_caller]
fn noted(paper: &Paper, words: &str) -> bool {
    paper.0.iter().any(|n| n.contains(words))
}

#[test]
fn every_pair_needs_coefficients() {
    refused(
        "pmb",
        "pair_coeff 1 1 1e22 0.0015001 0.01 0\npair_coeff 2 2 1e22 0.0015001 0.01 0",
        20,
        "some pairs of atom types have no coefficients: 1 2",
        "nothing is mixed",
    );
}

#[test]
fn a_horizon_is_a_number_that_is_not_negative() {
    for horizon in ["-0.001", "nan"] {
        let coefficients = format!("pair_coeff * * 1e22 {horizon} 0.01 0");
        let error = run("pmb", &coefficients, 0.0, "").map(|_| ()).unwrap_err();
        assert_eq!(error.line, 14, "{error}");
    }
    let error = run("pmb", "pair_coeff * * 1e22 0 0.01 0", 0.0, "").map(|_| ());
    let error = error.unwrap_err();
    assert!(error.message.contains("horizon"), "{error}");
}

/// Horizons, c, s00 and α of pairs: numbers are in the parity tests.
#[test]
fn every_pair_of_types_has_its_own() {
    let pmb = "pair_coeff 1 1 1e22 0.0015001 0.01 0.25\npair_coeff 2 2 4e22 0.0012 0.02 0\npair_coeff 1 2 2e22 0.0011 0.005 1";
    let paper = run("pmb", pmb, 0.0, "").unwrap();
    assert!(
        paper.0.iter().all(|n| !n.contains("types")),
        "{:?}",
        paper.0
    );
    // nothing is bonded across
    run("pmb", pmb, 3.0, "").unwrap();
}

/// LAMMPS's forces between unlike LPS types are not opposite, and its energy is half of what it should be.
#[test]
fn what_is_odd_in_lps_is_said() {
    let alike = "pair_coeff * * 14.9e9 6e9 0.0015001 0.01 0";
    let paper = run("lps", alike, 0.0, "").unwrap();
    assert!(noted(
        &paper,
        "counts half of the energy of changes of shape"
    ));
    assert!(!noted(&paper, "differ in K or G"));
    let unlike = format!("{alike}\npair_coeff 2 2 20e9 6e9 0.0015001 0.01 0");
    let paper = run("lps", &unlike, 0.0, "").unwrap();
    assert!(noted(
        &paper,
        "forces between unlike types are not opposite"
    ));
    let paper = run("pmb", "pair_coeff * * 1e22 0.0015001 0.01 0", 0.0, "").unwrap();
    assert!(!noted(&paper, "counts half"));
}

const VES: &str = "pair_coeff * * 14.9e9 6e9 0.0015001 0.01 0.25 0.5 1e-3";
const EPS: &str = "pair_coeff * * 14.9e9 6e9 0.0015001 0.01 0.25 1e8";

/// LAMMPS's `peri/ves` and `peri/eps` are not the laws that they are named after.
#[test]
fn what_is_odd_in_ves_and_eps_is_said() {
    for (style, coefficients) in [("ves", VES), ("eps", EPS)] {
        let paper = run(style, coefficients, 0.0, "").unwrap();
        for words in [
            "forces between two atoms whose dilatations differ are not opposite",
            &format!("`peri/{style}` counts half of the energy"),
        ] {
            assert!(noted(&paper, words), "{style}: {:?}", paper.0);
        }
        let flows = noted(&paper, "plastic flow is not LAMMPS's here");
        assert_eq!(flows, style == "eps");
    }
    // nothing relaxes
    let elastic = VES.replace("0.5 1e-3", "0 1e-3");
    run("ves", &elastic, 0.0, "").unwrap();
}

#[test]
fn ves_and_eps_are_for_one_material_in_space() {
    for (style, coefficients) in [("ves", VES), ("eps", EPS)] {
        let unlike = format!(
            "{coefficients}\n{}",
            coefficients.replace("* *", "2 2").replace("6e9", "7e9")
        );
        let error = run(style, &unlike, 0.0, "").map(|_| ()).unwrap_err();
        assert!(error.message.contains("unlike coefficients"), "{error}");
        assert!(error.message.contains("types 2 and 2"), "{error}");
        let flat = script(style, coefficients, 0.0, "")
            .replace("boundary s s s", "dimension 2\nboundary s s p")
            .replace("lattice sc", "lattice sq");
        let error = run_script(&flat).map(|_| ()).unwrap_err();
        assert!(error.message.contains("two dimensions"), "{error}");
        let short = coefficients.rsplit_once(' ').unwrap().0;
        let error = run(style, short, 0.0, "").map(|_| ()).unwrap_err();
        let help = error.help.unwrap();
        assert!(
            help.contains("pair_coeff I J K G horizon s00 alpha m_"),
            "{help}"
        );
    }
    let outside = VES.replace("0.5 1e-3", "1.5 1e-3");
    let error = run("ves", &outside, 0.0, "").map(|_| ()).unwrap_err();
    assert!(error.message.contains("above 0, at most 1"), "{error}");
}

/// LAMMPS's LPS has no critical stretches before its first evaluation with bonds.
#[test]
fn a_start_in_motion_is_said() {
    let coefficients = "pair_coeff * * 14.9e9 6e9 0.0015001 0.01 0";
    let words = "LAMMPS has no critical stretches yet";
    let moving = "variable v atom 10*x\nvelocity all set v_v 0 0 units box";
    assert!(noted(
        &run("lps", coefficients, 0.0, moving).unwrap(),
        words
    ));
    let after_rest = format!("run 1\n{moving}");
    for more in ["", &after_rest] {
        assert!(!noted(&run("lps", coefficients, 0.0, more).unwrap(), words));
    }
    let strained = "run 0\nvariable x atom 1.001*x\nset group all x v_x";
    assert!(noted(
        &run("lps", coefficients, 0.0, strained).unwrap(),
        words
    ));
}

/// Which of two unlike volumes LAMMPS takes depends on its neighbour list.
#[test]
fn unlike_volumes_are_said() {
    let coefficients = "pair_coeff * * 1e22 0.0015001 0.01 0";
    let more = "set type 2 volume 1e-10";
    let paper = run("pmb", coefficients, 0.0, more).unwrap();
    assert!(noted(&paper, "atoms differ in volume"), "{:?}", paper.0);
    let paper = run("pmb", coefficients, 0.0, "").unwrap();
    assert!(!noted(&paper, "atoms differ in volume"));
}

const MEET: &str = "variable v atom (x>0.0018)*(-900.0)\nvelocity all set v_v 0 0 units box";

/// Unlike types repel each other; with a horizon of 0 without bounds, as in LAMMPS, which is said when it happens.
#[test]
fn unlike_types_may_touch() {
    let unlike = "pair_coeff 1 1 1e22 0.0015001 5 0\npair_coeff 2 2 3e22 0.0015001 5 0\npair_coeff 1 2 2e22 0.0015001 5 0";
    run("pmb", unlike, 3.0, MEET).unwrap();
    let unbonded = unlike.replace("2e22 0.0015001", "2e22 0");
    run("pmb", &unbonded, 3.0, "").unwrap();
    let error = run("pmb", &unbonded, 3.0, MEET).map(|_| ()).unwrap_err();
    assert!(error.while_running, "{error}");
    let help = error.help.unwrap();
    assert!(
        help.contains("atoms of types 1 and 2 have a horizon of 0"),
        "{help}"
    );
}

/// A horizon at a distance of the lattice: positions in floating point decide, as in LAMMPS, and that is said.
#[test]
fn horizons_at_round_off_are_said() {
    let paper = run("pmb", "pair_coeff * * 1e22 0.001 0.01 0", 0.0, "").unwrap();
    assert!(
        noted(&paper, "within round-off of their horizon"),
        "{:?}",
        paper.0
    );
    let paper = run("pmb", "pair_coeff * * 1e22 0.00101 0.01 0", 0.0, "").unwrap();
    assert!(!noted(&paper, "within round-off"));
}

/// LAMMPS moves atoms of two `fix nve` twice in each step.
#[test]
fn nobody_is_moved_twice() {
    let coefficients = "pair_coeff * * 1e22 0.0015001 0.01 0";
    let more = "group half type 1\nfix again half nve";
    let error = run("pmb", coefficients, 0.0, more).map(|_| ()).unwrap_err();
    assert!(error.message.contains("`1` and `again`"), "{error}");
    assert!(error.help.unwrap().contains("twice"));
    let apart = "group half type 1\ngroup other type 2\nunfix 1\nfix a half nve\nfix b other nve";
    run("pmb", coefficients, 0.0, apart).unwrap();
}
