//! The potential files that come with LAMMPS, where they are: `PERIDYNE_POTENTIALS` names their directory.

use peridyne::spec::{LawSpec, Parameter, PotentialSpec};
use peridyne_io::deck::Deck;
use peridyne_io::read::eam::{funcfl, setfl};
use std::path::{Path, PathBuf};

fn directory() -> Option<PathBuf> {
    let directory = std::env::var_os("PERIDYNE_POTENTIALS").map(PathBuf::from);
    if directory.is_none() {
        eprintln!("skipped: set PERIDYNE_POTENTIALS to LAMMPS's directory of potentials");
    }
    directory
}

#[test]
fn files_of_lammps_are_read() {
    let Some(directory) = directory() else { return };
    let mut read = 0;
    for entry in std::fs::read_dir(&directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().to_string();
        let file = if name.ends_with(".eam.alloy") {
            setfl(&path)
        } else if name.ends_with(".eam") {
            funcfl(&[&path])
        } else {
            continue;
        };
        let file = file.unwrap_or_else(|e| panic!("{e}"));
        let first = &file.elements[0];
        eprintln!(
            "{name}: {} … cutoff {}, {} values",
            first.name,
            file.cutoff,
            file.pair[0].len()
        );
        // no pull without neighbours: the last values are those at the cutoff
        let last = file.density[0].last().unwrap().abs();
        let largest = file.density[0].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(last < 1e-2 * largest, "{name}: {last} of {largest}");
        read += 1;
    }
    assert!(
        read > 0,
        "no .eam and .eam.alloy files in {}",
        directory.display()
    );
}

#[test]
fn copper_of_foiles_has_its_first_values() {
    let Some(directory) = directory() else { return };
    let file = funcfl(&[directory.join("Cu_u3.eam")]).unwrap();
    assert_eq!(file.element("Cu").unwrap(), 0);
    assert_eq!(
        (file.dr, file.cutoff),
        (1.0000000000000009e-02, 4.949_999_999_999_989)
    );
    assert_eq!((file.pair[0].len(), file.embedding[0].len()), (499, 499));
    assert!((file.embedding[0][1] + 3.156_163_690_342_435e-1).abs() < 1e-15);
}

const ENTRY: &str =
    "Si Si Si 2.1683 2.0951 1.80 21.0 1.20 -0.333333333333 7.049556277 0.6022245584 4.0 0.0 0.0\n";

/// The potential and the mass of a deck with one file.
fn potential(dir: &Path, units: &str, law: &str) -> Result<(PotentialSpec, Option<f64>), String> {
    let mass = match law.contains("eam") && units.contains("metal") {
        true => "",
        false => "mass = 1\n",
    };
    let text = format!(
        "units = {units}\nbody = {{ lattice = \"fcc\", spacing = 4, cells = [2, 2, 2] }}\nperiodic = [\"x\", \"y\", \"z\"]\n\
         run = {{ steps = 1, time_step = 1e-3 }}\n[material]\n{mass}law = {{ {law} }}\n"
    );
    let path = dir.join("deck.toml");
    let deck = Deck::parse(&text, path.to_str().unwrap(), &[]).map_err(|e| e.to_string())?;
    let mass = deck.masses().first().copied().flatten();
    match &deck.spec.materials[0].law {
        LawSpec::Atoms(spec) => Ok((spec.clone(), mass)),
        other => panic!("{other:?}"),
    }
}

/// Energies of rows of Stillinger and Weber's, and of tables: the embedding.
fn energies(spec: &PotentialSpec) -> (f64, Vec<f64>) {
    match spec.parameters.get("file") {
        Some(Parameter::Rows(rows)) => (rows[0][4], vec![rows[0][3]]),
        Some(Parameter::Table(table)) => {
            (table.step, [&table.embedding[..], &table.pair[..]].concat())
        }
        other => panic!("{other:?}"),
    }
}

/// What a file of potentials says of its units is heard: kcal/mol become eV, whatever the format. 1 eV is 23.060548 kcal/mol, for LAMMPS
/// 23.060549.
#[test]
fn tags_of_units_are_heard() {
    let dir = tempfile::tempdir().unwrap();
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let put = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
    // the first line of each is a comment
    let tagged = |name: &str, tag: &str| {
        let text = match name {
            "Si.sw" => format!("# silicon\n{ENTRY}"),
            "toy.eam.fs" => std::fs::read_to_string(here.join("toy.eam.alloy")).unwrap(),
            name => std::fs::read_to_string(here.join(name)).unwrap(),
        };
        let (head, rest) = text.split_once('\n').unwrap();
        format!("{head} UNITS: {tag} CONTRIBUTOR: nobody\n{rest}")
    };
    let files = [
        ("Si.sw", "stillinger_weber = { file = \"Si.sw\" }"),
        ("toy.eam", "eam = { file = \"toy.eam\" }"),
        (
            "toy.eam.alloy",
            "eam = { file = \"toy.eam.alloy\", element = \"ELEMENT\" }",
        ),
    ];
    let calorie = 23.060547830619;
    for (name, law) in files {
        let element = match name.ends_with("alloy") {
            true => setfl(&here.join(name)).unwrap().elements[0].name.clone(),
            false => String::new(),
        };
        let law = law.replace("ELEMENT", &element);
        let of = |units: &str, tag: &str| {
            put(name, &tagged(name, tag));
            potential(dir.path(), units, &law)
        };
        let (metal, mass) = of("\"metal\"", "metal").unwrap();
        let (real, same) = of("\"metal\"", "real").unwrap();
        assert_eq!(mass, same, "{name}");
        let (length, plain) = energies(&metal);
        let (other, scaled) = energies(&real);
        assert_eq!(length, other, "{name}");
        let lammps = "{ system = \"metal\", constants = \"lammps\" }";
        let theirs = energies(&of(lammps, "real").unwrap().0).1;
        assert!(plain.iter().any(|x| *x != 0.0));
        for ((a, b), c) in plain.iter().zip(&scaled).zip(&theirs) {
            assert!(
                (a / calorie - b).abs() <= 1e-10 * b.abs(),
                "{name}: {a} {b}"
            );
            assert!(
                (a / 23.060549 - c).abs() <= 1e-14 * c.abs(),
                "{name}: {a} {c}"
            );
        }
        // hartree and bohr
        let (electron, _) = of("\"metal\"", "electron").unwrap();
        assert!((energies(&electron).0 / length - 0.529177210903).abs() < 1e-12);
        // as they are where numbers have no size, and where one of both has none they do not fit
        assert_eq!(
            energies(&of("\"none\"", "real").unwrap().0),
            energies(&metal)
        );
        assert!(of("\"lj\"", "lj").is_ok());
        for (units, tag) in [
            ("\"metal\"", "lj"),
            ("\"lj\"", "metal"),
            ("\"metal\"", "imperial"),
        ] {
            let error = of(units, tag).unwrap_err();
            assert!(error.contains(&format!("UNITS: {tag}")), "{error}");
        }
    }
}
