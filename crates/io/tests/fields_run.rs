//! `[[fields]]` of a deck: what a run writes, and that it is what `peridyne fields` makes of its frames.

use peridyne::observe::Ledger;
use peridyne::run::{Options, build};
use peridyne_fields::average::Average;
use peridyne_fields::{Kernel, Method, PairForce, Partition, Shape, Targets, evaluate};
use peridyne_io::continuum::run::FieldsPlan;
use peridyne_io::continuum::{Masses, Units, frame, model, potential};
use peridyne_io::deck::Deck;
use peridyne_io::drive::{AtomsPlan, Plan, Progress, drive};
use peridyne_io::read::frames::Frames;
use peridyne_io::write::SeriesOptions;
use peridyne_io::write::continuum::{Table, write_table};
use std::path::Path;
use std::time::Duration;
use tempfile::TempDir;

struct Quiet;

impl Progress for Quiet {
    fn step(&mut self, _: u64, _: u64, _: Duration) {}
    fn row(&mut self, _: u64, _: f64, _: &Ledger, _: u64) {}
    fn warning(&mut self, message: &str) {
        panic!("{message}");
    }
}

/// Runs a deck; files are those beside the good decks, results go to `dir`.
fn run(dir: &Path, text: &str) -> Deck {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/test.toml");
    let deck = Deck::parse(text, file.to_str().unwrap(), &[]).unwrap();
    let mut sim = build(&deck.spec, Options::default()).unwrap();
    let units = Units::Deck(deck.units);
    let atoms = deck.spec.potential().map(|_| AtomsPlan {
        boltzmann: deck.boltzmann(),
        temperature_unit: String::new(),
        pressure_scale: 1.0,
        pressure_unit: String::new(),
        trajectories: deck.output.trajectories.clone(),
        data: None,
        species: deck.species(),
        ase_velocity: deck.units.ase_velocity(),
        mass_scale: 1.0 / units.mass(),
        corner: deck.corner,
        periodic: deck.spec.periodic,
    });
    let plan = Plan {
        title: String::new(),
        deck: deck.file().into(),
        deck_text: deck.text().into(),
        dir: dir.to_path_buf(),
        allow_outside: false,
        steps: deck.steps(sim.info().time_step),
        every: deck.output.every,
        history: 5,
        modes: 0,
        linear_body: false,
        series: SeriesOptions {
            picture: None,
            dump: None,
            bonds: false,
            points: false,
        },
        fields: vec![],
        units: deck.units,
        time_unit: String::new(),
        energy_unit: String::new(),
        threads: 2,
        atoms,
        continuum: Some(FieldsPlan {
            asked: deck.fields.clone(),
            spec: deck.spec.clone(),
            corner: deck.corner,
            units,
        }),
    };
    drive(sim.as_mut(), &plan, &mut Quiet).unwrap();
    deck
}

/// The table of frames of a file, as `peridyne fields` makes it.
fn of_frames(
    file: &Path,
    skip: usize,
    words: &potential::Words,
    units: &str,
    method: &Method,
    out: &Path,
) {
    let units = Units::named(units).unwrap();
    let model = model(words, units).unwrap_or_else(|_| panic!("{}", words.name));
    let method = Method {
        boltzmann: units.boltzmann(),
        ..method.clone()
    };
    let masses = Masses::from([("Si".to_string(), 28.0855)]);
    let mut frames = Frames::open(file).unwrap();
    let mut average = Average::default();
    let mut last = None;
    let mut n = 0;
    while let Some(atoms) = frames.next_frame().unwrap() {
        n += 1;
        if n <= skip {
            continue;
        }
        let state = frame(&atoms, units, &masses, &model).unwrap();
        let targets = Targets::Points(POINTS.to_vec());
        let found = evaluate(&state, &*model.sites, &targets, &method).unwrap();
        average.add(&found);
        last = Some(found);
    }
    let last = last.unwrap();
    let table = match average.frames() {
        1 => Table::of_frame(&last, units, None, false),
        _ => Table::of_average(&average, last.points, units, None, false),
    };
    std::fs::create_dir_all(out).unwrap();
    write_table(&out.join("points.csv"), &table).unwrap();
}

/// Numbers of a table by the names of its columns; empty fields are not numbers.
fn table(path: &Path) -> Vec<(String, Vec<f64>)> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',');
    let mut columns: Vec<(String, Vec<f64>)> = names.map(|n| (n.to_string(), vec![])).collect();
    for line in lines {
        for (column, field) in columns.iter_mut().zip(line.split(',')) {
            column.1.push(field.parse().unwrap_or(f64::NAN));
        }
    }
    columns
}

/// Columns of one name agree to so much of the largest of those that begin alike.
fn same(live: &Path, files: &Path, tolerance: f64) {
    let (live, files) = (table(live), table(files));
    assert_eq!(live.len(), files.len());
    for ((name, a), (other, b)) in live.iter().zip(&files) {
        assert_eq!(name, other);
        let kind = name.split('_').next().unwrap();
        let alike = files.iter().filter(|c| c.0.split('_').next() == Some(kind));
        let size = alike.flat_map(|c| &c.1).fold(0.0f64, |m, x| m.max(x.abs()));
        // what churns by round-off alone, beside stress
        let stress = files.iter().find(|c| c.0 == "s_xx").unwrap();
        let size = size.max(stress.1.iter().fold(0.0, |m, x| m.max(x.abs())));
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= tolerance * size, "{name}: {a} {b}");
        }
    }
}

const POINTS: [[f64; 3]; 4] = [
    [0.3, 0.2, 0.1],
    [1.7, 2.2, 0.4],
    [3.1, 0.9, 2.8],
    [2.0, 2.0, 2.0],
];

/// Means over three frames of a liquid, and silicon with the whole pair force of differences.
#[test]
fn fields_of_running_atoms_are_those_of_their_frames() {
    let dir = TempDir::new().unwrap();
    let at = dir.path();
    let deck = format!(
        "units = \"lj\"\nperiodic = [\"x\", \"y\", \"z\"]\n\
         body = {{ lattice = \"fcc\", spacing = 1.6, cells = [4, 4, 4] }}\n\
         material = {{ mass = 1, law = {{ lennard_jones = {{ epsilon = 1, sigma = 1, cutoff = 2.5, end = \"smooth\" }} }} }}\n\
         thermal = {{ temperature = 0.8, seed = 2 }}\n\
         run = {{ steps = 20, time_step = 0.005 }}\n\
         output = {{ every = 10, vtu = false, trajectory = \"frames.extxyz\" }}\n\
         [[fields]]\nkernel = \"bspline\"\nwidth = 1.5\npoints = {POINTS:?}\nevery = 10\npartition = \"equal\"\n"
    );
    let out = at.join("liquid");
    run(&out, &deck);
    let with = |key: &str, value: &str| (key.to_string(), value.to_string());
    let words = potential::Words {
        name: "lj".into(),
        with: vec![
            with("epsilon", "1"),
            with("sigma", "1"),
            with("cutoff", "2.5"),
            with("end", "smooth"),
        ],
        ..Default::default()
    };
    let method = Method {
        partition: Partition::Equal,
        ..Method::new(Kernel::new(Shape::CubicSpline, 1.5).unwrap())
    };
    let files = at.join("liquid files");
    of_frames(&out.join("frames.extxyz"), 0, &words, "lj", &method, &files);
    same(
        &out.join("fields/points.csv"),
        &files.join("points.csv"),
        1e-11,
    );
    assert!(out.join("fields/errors.csv").exists());

    let deck = format!(
        "units = \"metal\"\nperiodic = [\"x\", \"y\", \"z\"]\n\
         body = {{ lattice = \"diamond\", spacing = 5.431, cells = [2, 2, 2] }}\n\
         material = {{ mass = 28.0855, law = {{ stillinger_weber = {{ file = \"Si.sw\" }} }} }}\n\
         thermal = {{ temperature = 900, seed = 3 }}\n\
         run = {{ steps = 10, time_step = 0.001 }}\n\
         output = {{ vtu = false, trajectory = \"silicon.extxyz\" }}\n\
         [[fields]]\nname = \"stress\"\nkernel = \"gaussian\"\nwidth = \"1.5 Å\"\npoints = {POINTS:?}\npair_force = \"differences\"\n"
    );
    let out = at.join("silicon");
    run(&out, &deck);
    let silicon = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/Si.sw");
    let words = potential::Words {
        name: "stillinger_weber".into(),
        files: vec![silicon.to_string_lossy().into_owned()],
        elements: vec!["Si".into()],
        ..Default::default()
    };
    let method = Method {
        pair_force: PairForce::Differences,
        ..Method::new(Kernel::new(Shape::Gaussian, 1.5).unwrap())
    };
    let files = at.join("silicon files");
    // the first frame is the start
    of_frames(
        &out.join("silicon.extxyz"),
        1,
        &words,
        "metal",
        &method,
        &files,
    );
    same(
        &out.join("stress/points.csv"),
        &files.join("points.csv"),
        1e-11,
    );
}

/// A plate, pulled: an image for each frame, their collection, the picture, and why there is no temperature.
#[test]
fn fields_of_a_body_are_written_as_those_of_atoms() {
    let dir = TempDir::new().unwrap();
    let at = dir.path();
    let deck = "horizon = { m_ratio = 3 }\nplane = \"strain\"\nthickness = \"2 mm\"\n\
         body = { lattice = \"square\", spacing = \"1 mm\", region = { block = { low = [0, 0], high = [\"20 mm\", \"16 mm\"] } } }\n\
         material = { density = \"2500 kg/m^3\", law = { lps = { young = \"70 GPa\", poisson = 0.22 } } }\n\
         initial = [{ velocity = [0, \"10 m/s * (y - 8e-3) / (8 mm)\"] }]\n\
         run = { steps = 8 }\noutput = { vtu = false }\n\
         [[fields]]\nkernel = \"polynomial\"\nwidth = \"3 mm\"\ngrid = [20, 16]\nevery = 4\neach = true\n\
         [[fields]]\nname = \"profile\"\nkernel = \"bspline\"\nwidth = \"4 mm\"\naverage = [\"x\"]\n\
         line = { from = [0, \"2 mm\"], to = [0, \"14 mm\"], count = 5 }\n";
    run(&at.join("out"), deck);
    for file in [
        "fields.vti",
        "fields.npz",
        "fields.json",
        "stress.png",
        "frames.pvd",
        "frame.000000.vti",
        "frame.000002.vti",
    ] {
        assert!(at.join("out/fields").join(file).exists(), "{file}");
    }
    let profile = table(&at.join("out/profile/points.csv"));
    let column = |name: &str| &profile.iter().find(|c| c.0 == name).unwrap().1;
    assert!(column("s_yy").iter().all(|s| *s > 0.0));
    assert!(column("T").iter().all(|t| t.is_nan()));
    let reason = profile.last().unwrap();
    assert!(reason.0.starts_with("no T: "), "{}", reason.0);
    let text = std::fs::read_to_string(at.join("out/fields/fields.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["frames_read"], 3);
    assert_eq!(json["pair_force"], "differences");
    for law in ["mass", "momentum", "energy"] {
        let left = json["residuals"][format!("{law}_extrapolated")]
            .as_f64()
            .unwrap();
        assert!(left < 1e-3, "{law}: {left:e}");
    }
}
