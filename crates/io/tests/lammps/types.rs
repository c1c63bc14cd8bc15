//! What several atom types may have, and what they are told where the engine cannot follow LAMMPS.

use peridyne_io::lammps::host::Console;
use peridyne_io::lammps::model::ModelHost;
use peridyne_io::lammps::{Options, ScriptError, run_text};

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
    let (low, high) = (2.6 + gap, 5.6 + gap);
    let text = format!(
        "units si\natom_style peri\natom_modify map array\nboundary s s s\nlattice sc 0.0005\n\
         region box block -1 20 -1 4 -1 4 units lattice\nregion a block -0.1 2.6 -0.1 2.1 -0.1 2.1\n\
         region b block {low} {high} -0.1 2.1 -0.1 2.1\ncreate_box 2 box\ncreate_atoms 1 region a\n\
         create_atoms 2 region b\ntimestep 1e-7\npair_style peri/{style}\n{coefficients}\n\
         set group all density 2200\nset group all volume 1.25e-10\nfix 1 all nve\n{more}\nrun 20\n"
    );
    let mut paper = Paper::default();
    let output = tempfile::tempdir().unwrap();
    let options = Options {
        output: output.path().into(),
        ..Options::default()
    };
    run_text(
        "in.bar",
        &text,
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

#[test]
fn horizons_must_agree() {
    refused(
        "pmb",
        "pair_coeff 1 1 1e22 0.0015001 0.01 0\npair_coeff 1 2 1e22 0.0015001 0.01 0\npair_coeff 2 2 1e22 0.0012 0.01 0",
        16,
        "`pair_coeff 2 2` has the horizon 1.2e-3, `pair_coeff 1 1` has 1.5001e-3",
        "same horizon",
    );
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
fn bonds_across_have_a_mean_of_both() {
    refused(
        "pmb",
        "pair_coeff 1 1 1e22 0.0015001 0.01 0\npair_coeff 2 2 4e22 0.0015001 0.01 0\npair_coeff 1 2 2e22 0.0015001 0.01 0",
        16,
        "`pair_coeff 1 2` has c = 2e22, which is no mean of 1e22 and 4e22",
        "the harmonic mean 1.6",
    );
    for mean in ["1.6e22", "1e22", "2.5e22"] {
        let coefficients = format!(
            "pair_coeff 1 1 1e22 0.0015001 0.01 0\npair_coeff 2 2 4e22 0.0015001 0.01 0\npair_coeff 1 2 {mean} 0.0015001 0.01 0"
        );
        let paper = run("pmb", &coefficients, 0.0, "").unwrap();
        assert!(
            paper.0.iter().any(|n| n.contains("differ in stiffness")),
            "{:?}",
            paper.0
        );
    }
}

#[test]
fn moduli_of_bonded_lps_types_agree() {
    refused(
        "lps",
        "pair_coeff * * 14.9e9 6e9 0.0015001 0.01 0\npair_coeff 2 2 20e9 6e9 0.0015001 0.01 0",
        14,
        "atoms of types 1 and 2 are bonded, and their K or G differ",
        "deck (TOML)",
    );
}

#[test]
fn critical_stretches_of_bonded_types_can_be_followed() {
    let pair = |own: &str, across: &str| {
        format!(
            "pair_coeff 1 1 1e22 0.0015001 0.01 0\npair_coeff 2 2 1e22 0.0015001 {own}\npair_coeff 1 2 1e22 0.0015001 {across}"
        )
    };
    let words = "between bonded types it must be the smaller of 0.01 and 0.02";
    refused("pmb", &pair("0.02 0", "0.02 0"), 16, words, "write 0.01");
    let words = "have different s00 or alpha, and alpha is not 0";
    refused(
        "pmb",
        &pair("0.02 0.25", "0.01 0.25"),
        16,
        words,
        "smaller s00",
    );
    run("pmb", &pair("0.02 0", "0.01 0"), 0.0, "").unwrap();
}

/// Nothing is bonded across: any coefficients will do.
#[test]
fn types_apart_may_have_any() {
    let coefficients = "pair_coeff 1 1 1e22 0.0015001 0.01 0.25\npair_coeff 2 2 3e22 0.0015001 0.02 0\npair_coeff 1 2 7e22 0.0015001 5 1";
    run("pmb", coefficients, 3.0, "").unwrap();
    let coefficients = "pair_coeff 1 1 10e9 6e9 0.0015001 0.01 0.25\npair_coeff 2 2 12e9 6e9 0.0015001 0.02 0\npair_coeff 1 2 1e9 1e9 0.0015001 5 1";
    run("lps", coefficients, 3.0, "").unwrap();
}

/// LAMMPS repels each pair of types with its own stiffness.
#[test]
fn unlike_types_may_not_touch() {
    let unlike = "pair_coeff 1 1 1e22 0.0015001 5 0\npair_coeff 2 2 3e22 0.0015001 5 0\npair_coeff 1 2 2e22 0.0015001 5 0";
    let meet = "variable v atom (x>0.0018)*(-900.0)\nvelocity all set v_v 0 0 units box";
    let error = run("pmb", unlike, 3.0, meet).map(|_| ()).unwrap_err();
    assert!(error.while_running, "{error}");
    assert!(
        error.message.contains("points repel each other since step"),
        "{error}"
    );
    let alike = unlike.replace("3e22", "1e22").replace("2e22", "1e22");
    run("pmb", &alike, 3.0, meet).unwrap();
}
