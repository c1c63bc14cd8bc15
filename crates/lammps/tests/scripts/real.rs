//! Whole scripts, unchanged but for their number of steps.

use peridyne_lammps::host::Pair;
use peridyne_lammps::{Options, Reference};

use super::host::{Ran, run};

fn deck(name: &str, variables: &[(&str, &str)], steps: Option<(&str, &str)>) -> Ran {
    let path = format!("{}/tests/scripts/decks/{name}", env!("CARGO_MANIFEST_DIR"));
    let mut text = std::fs::read_to_string(&path).unwrap();
    if let Some((from, to)) = steps {
        assert!(text.contains(from));
        text = text.replace(from, to);
    }
    let output = tempfile::tempdir().unwrap();
    let variables = variables
        .iter()
        .map(|(n, v)| (n.to_string(), vec![v.to_string()]))
        .collect();
    let ran = run(
        &path,
        &text,
        &Options {
            variables,
            output: output.path().into(),
            ..Options::default()
        },
    );
    if let Err(e) = &ran.outcome {
        panic!("{e} ({:?})", e.help);
    }
    ran
}

fn atoms(ran: &Ran) -> usize {
    ran.host
        .built
        .as_ref()
        .map_or(0, |(_, _, atoms)| atoms.len())
}

/// 103,110 atoms: eight points per layer on the rim lose to rounding.
#[test]
fn algorithm_7() {
    let ran = deck("in.algorithm7", &[], Some(("run 2000", "run 2")));
    let (pair, lattice, atoms) = ran.host.built.unwrap();
    assert_eq!(atoms.len(), 103_110);
    assert_eq!(lattice, 0.0005);
    let Pair::Pmb(table) = pair else {
        panic!("not PMB")
    };
    let c = table.get(1, 1);
    assert_eq!(
        (c.micromodulus, c.horizon, c.critical_stretch, c.alpha),
        (1.6863e22, 0.0015001, 0.0005, 0.25)
    );
    // the engine gets integers and no copies
    let Reference::Sites { sites, .. } = &atoms.reference else {
        panic!("no lattice sites")
    };
    assert_eq!(
        sites[0],
        [0, -5, -74],
        "LAMMPS starts with the lowest layer in z"
    );
    assert!(atoms.moved.is_none());
    assert!(ran.lines.iter().any(|l| l.contains("with 103110 atoms")));
}

#[test]
fn impact() {
    for model in ["pmb", "lps"] {
        let ran = deck("in.impact", &[("model", model), ("steps", "1")], None);
        assert_eq!(atoms(&ran), 103_110);
        let header = "   Step         PotEng         KinEng         TotEng          c_D1     ";
        assert!(ran.lines.iter().any(|l| l == header), "{:?}", ran.lines);
        let (pair, ..) = ran.host.built.unwrap();
        assert_eq!(matches!(pair, Pair::Lps(_)), model == "lps");
    }
}

#[test]
fn wave_block_and_plate() {
    assert_eq!(
        atoms(&deck("in.wave3d", &[("n", "12"), ("steps", "2")], None)),
        12 * 12 * 12
    );
    assert_eq!(
        atoms(&deck(
            "in.wave3d",
            &[("n", "6"), ("steps", "2"), ("model", "pmb")],
            None
        )),
        216
    );
    assert_eq!(atoms(&deck("in.block16", &[("steps", "2")], None)), 4096);
    assert_eq!(
        atoms(&deck(
            "in.block16",
            &[("steps", "2"), ("model", "lps")],
            None
        )),
        4096
    );
    assert_eq!(
        atoms(&deck("in.plate2d", &[("steps", "1")], None)),
        200 * 200
    );
    assert_eq!(
        atoms(&deck("in.plate2d", &[("steps", "1"), ("dim", "2")], None)),
        200 * 200
    );
}
