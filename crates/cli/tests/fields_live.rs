//! `[[fields]]` of a deck: what a run writes, and that it is what `peridyne fields` makes of its frames.

use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Exit code, standard output and error of the program in a folder.
fn peridyne(dir: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .current_dir(dir)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

fn run(dir: &Path, deck: &str) {
    std::fs::write(dir.join("deck.toml"), deck).unwrap();
    let (code, _, error) = peridyne(dir, &["run", "deck.toml", "--out", "out", "--threads", "2"]);
    assert_eq!(code, Some(0), "{error}");
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

const POINTS: &str = "0.3 0.2 0.1\n1.7 2.2 0.4\n3.1 0.9 2.8\n2.0 2.0 2.0\n";

fn inline() -> String {
    let rows = POINTS
        .lines()
        .map(|l| format!("[{}]", l.replace(' ', ", ")));
    rows.collect::<Vec<_>>().join(", ")
}

/// Means over three frames of a liquid, and silicon with parts of the potential kept apart.
#[test]
fn fields_of_running_atoms_are_those_of_their_frames() {
    let dir = TempDir::new().unwrap();
    let at = dir.path();
    std::fs::write(at.join("points.txt"), POINTS).unwrap();
    let deck = format!(
        "units = \"lj\"\nperiodic = [\"x\", \"y\", \"z\"]\n\
         body = {{ lattice = \"fcc\", spacing = 1.6, cells = [4, 4, 4] }}\n\
         material = {{ mass = 1, law = {{ lennard_jones = {{ epsilon = 1, sigma = 1, cutoff = 2.5, end = \"smooth\" }} }} }}\n\
         initial_velocities = {{ temperature = 0.8, seed = 2 }}\n\
         run = {{ steps = 20, time_step = 0.005 }}\n\
         output = {{ every = 10, vtu = false, trajectory = \"frames.extxyz\" }}\n\
         [[fields]]\nkernel = \"bspline\"\nwidth = 1.5\npoints = [{}]\nevery = 10\npartition = \"equal\"\n",
        inline()
    );
    run(at, &deck);
    let flags = "--frames out/frames.extxyz --potential lj --with epsilon=1 --with sigma=1 --with cutoff=2.5 --with end=smooth --units lj \
         --kernel bspline --width 1.5 --points points.txt --partition equal --out files";
    let mut words: Vec<&str> = vec!["fields"];
    words.extend(flags.split_whitespace());
    let (code, _, error) = peridyne(at, &words);
    assert_eq!(code, Some(0), "{error}");
    same(
        &at.join("out/fields/points.csv"),
        &at.join("files/points.csv"),
        1e-11,
    );
    same(
        &at.join("out/fields/errors.csv"),
        &at.join("files/errors.csv"),
        1e-11,
    );

    let silicon = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/Si.sw");
    std::fs::copy(silicon, at.join("Si.sw")).unwrap();
    let deck = format!(
        "units = \"metal\"\nperiodic = [\"x\", \"y\", \"z\"]\n\
         body = {{ lattice = \"diamond\", spacing = 5.431, cells = [2, 2, 2] }}\n\
         material = {{ mass = 28.0855, law = {{ stillinger_weber = {{ file = \"Si.sw\" }} }} }}\n\
         initial_velocities = {{ temperature = 900, seed = 3 }}\n\
         run = {{ steps = 10, time_step = 0.001 }}\n\
         output = {{ vtu = false, trajectory = \"silicon.extxyz\" }}\n\
         [[fields]]\nname = \"stress\"\nkernel = \"gaussian\"\nwidth = \"1.5 Å\"\npoints = [{}]\nparts = true\npair_force = \"differences\"\n",
        inline()
    );
    run(at, &deck);
    let flags = "--frames out/silicon.extxyz --skip 1 --potential stillinger_weber --file Si.sw --element Si --units metal --mass Si=28.0855 \
         --kernel gaussian --width 1.5 --points points.txt --parts --pair-force differences --out silicon";
    let mut words: Vec<&str> = vec!["fields"];
    words.extend(flags.split_whitespace());
    let (code, _, error) = peridyne(at, &words);
    assert_eq!(code, Some(0), "{error}");
    same(
        &at.join("out/stress/points.csv"),
        &at.join("silicon/points.csv"),
        1e-11,
    );
}

/// Molecules, a mixture with mixing rules, alloys with a gas beside them, Tersoff's carbide: as their frames, read with the same deck.
#[test]
fn fields_of_all_kinds_of_atoms_are_those_of_their_frames() {
    let decks = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    let dir = TempDir::new().unwrap();
    let at = dir.path();
    std::fs::write(at.join("points.txt"), POINTS).unwrap();
    for file in ["hexane.data", "alloy.eam.alloy", "SiC.tersoff"] {
        std::fs::copy(decks.join(file), at.join(file)).unwrap();
    }
    for (name, width) in [
        ("hexane", "4"),
        ("mixture", "1.5"),
        ("alloy", "4"),
        ("silicon_carbide", "3"),
    ] {
        let deck = std::fs::read_to_string(decks.join(format!("{name}.toml"))).unwrap();
        let replaced = deck.lines().map(|line| match line.split(" = ").next() {
            Some("output") => {
                "output = { every = 10, vtu = false, trajectory = \"frames.extxyz\" }".into()
            }
            Some("run") => line
                .replace("steps = 100", "steps = 20")
                .replace("steps = 50", "steps = 20"),
            _ => line.to_string(),
        });
        let deck = format!(
            "{}\n[[fields]]\nname = \"{name}\"\nkernel = \"polynomial\"\nwidth = {width}\npoints = [{}]\nevery = 10\npartition = \"equal\"\n",
            replaced.collect::<Vec<_>>().join("\n"),
            inline()
        );
        run(at, &deck);
        let flags = format!(
            "fields --frames out/frames.extxyz --model deck.toml --kernel polynomial --width {width} --points points.txt --partition equal --out {name}"
        );
        let words: Vec<&str> = flags.split_whitespace().collect();
        let (code, _, error) = peridyne(at, &words);
        assert_eq!(code, Some(0), "{name}: {error}");
        let [live, files] = [
            format!("out/{name}/points.csv"),
            format!("{name}/points.csv"),
        ];
        same(&at.join(live), &at.join(files), 1e-11);
    }
}

/// Planes and chains have the thickness and the section of their deck, whatever box frames have: as the running model says, and the density in closed form
/// (the mass of an atom is that per thickness).
#[test]
fn fields_of_planes_and_chains_are_those_of_their_frames() {
    let dir = TempDir::new().unwrap();
    let at = dir.path();
    let law = "law = { lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5, end = \"shifted_force\" } }";
    for (name, body, points, density) in [
        (
            "plane",
            "dimension = 2\nthickness = 1.5\nperiodic = [\"x\", \"y\"]\nbody = { lattice = \"triangular\", spacing = 1.11615, cells = [16, 10] }",
            "[0, 0], [3.3, 4.1], [8.7, 2.2]",
            2.0 / (3f64.sqrt() * 1.11615 * 1.11615),
        ),
        (
            "chain",
            "dimension = 1\narea = 0.7\nperiodic = [\"x\"]\nbody = { lattice = \"chain\", spacing = 1.12, cells = [40] }",
            "[0], [3.3], [8.7]",
            1.0 / 1.12,
        ),
    ] {
        for file in ["frames.extxyz", "frames.lammpstrj"] {
            let deck = format!(
                "units = \"lj\"\n{body}\nmaterial = {{ mass = 1, {law} }}\ninitial_velocities = {{ temperature = 0.01, seed = 2 }}\n\
                 run = {{ steps = 20, time_step = 0.002 }}\noutput = {{ every = 10, vtu = false, trajectory = \"{file}\" }}\n\
                 [[fields]]\nname = \"{name}\"\nkernel = \"bspline\"\nwidth = 4\npoints = [{points}]\nevery = 10\n"
            );
            run(at, &deck);
            let places = points.trim_matches(['[', ']']).split("], [");
            let places = places.map(|p| {
                let mut x: Vec<&str> = p.split(", ").collect();
                x.resize(3, "0");
                x.join(" ") + "\n"
            });
            std::fs::write(at.join("points.txt"), places.collect::<String>()).unwrap();
            let out = format!("{name}-{}", &file[7..]);
            let flags = format!(
                "fields --frames out/{file} --model deck.toml --kernel bspline --width 4 --points points.txt --out {out}"
            );
            let words: Vec<&str> = flags.split_whitespace().collect();
            let (code, _, error) = peridyne(at, &words);
            assert_eq!(code, Some(0), "{name}: {error}");
            let [live, files] = [
                format!("out/{name}/points.csv"),
                format!("{out}/points.csv"),
            ];
            same(&at.join(live), &at.join(&files), 1e-9);
            let rho = table(&at.join(files));
            let rho = &rho.iter().find(|c| c.0 == "rho").unwrap().1;
            for found in rho {
                assert!(
                    (found / density - 1.0).abs() < 0.02,
                    "{name}: {rho:?}, {density}"
                );
            }
        }
    }
}

/// A plate with a crack, pulled: an image for each frame, their collection, the picture, and why there is no temperature.
#[test]
fn fields_of_a_body_are_written_as_those_of_atoms() {
    let dir = TempDir::new().unwrap();
    let at = dir.path();
    let deck = "horizon = { m_ratio = 3 }\nplane = \"strain\"\nthickness = \"2 mm\"\n\
         body = { lattice = \"square\", spacing = \"1 mm\", cells = [21, 17] }\n\
         material = { density = \"2500 kg/m^3\", law = { lps = { young = \"70 GPa\", poisson = 0.22 } } }\n\
         initial = [{ velocity = [0, \"10 m/s * (y - 8e-3) / (8 mm)\"] }]\n\
         run = { steps = 8 }\noutput = { vtu = false }\n\
         [[fields]]\nkernel = \"polynomial\"\nwidth = \"3 mm\"\ngrid = [20, 16]\nevery = 4\neach = true\n\
         [[fields]]\nname = \"profile\"\nkernel = \"bspline\"\nwidth = \"4 mm\"\naverage = [\"x\"]\n\
         line = { from = [0, \"2 mm\"], to = [0, \"14 mm\"], count = 5 }\n";
    run(at, deck);
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

/// Frames along a line are tables. A run goes on only if those of before are as it left them, and then ends as one that was never cut off.
#[test]
fn a_frame_that_was_changed_is_told_and_others_are_those_of_a_whole_run() {
    let dir = TempDir::new().unwrap();
    let at = dir.path();
    let deck = "horizon = { m_ratio = 3 }\nplane = \"strain\"\nthickness = \"2 mm\"\n\
         body = { lattice = \"square\", spacing = \"1 mm\", cells = [13, 11] }\n\
         material = { density = \"2500 kg/m^3\", law = { lps = { young = \"70 GPa\", poisson = 0.22 } } }\n\
         initial = [{ velocity = [0, \"10 m/s * (y - 5e-3) / (5 mm)\"] }]\n\
         run = { steps = 8 }\noutput = { vtu = false }\n\
         [[fields]]\nname = \"profile\"\nkernel = \"bspline\"\nwidth = \"3 mm\"\nevery = 2\neach = true\n\
         line = { from = [\"6 mm\", \"2 mm\"], to = [\"6 mm\", \"8 mm\"], count = 5 }\n";
    run(at, deck);
    let cut = ["run", "deck.toml", "--out", "cut", "--stop-after", "4"];
    let (code, _, error) = peridyne(at, &cut);
    assert_eq!(code, Some(0), "{error}");
    let first = at.join("cut/profile/frame.000000.csv");
    let frame = std::fs::read(&first).unwrap();
    let mut bytes = frame.clone();
    let digit = bytes.iter().rposition(u8::is_ascii_digit).unwrap();
    bytes[digit] ^= 1;
    std::fs::write(&first, bytes).unwrap();
    let (code, _, error) = peridyne(at, &["resume", "cut"]);
    assert_eq!(code, Some(2), "{error}");
    let said = error.replace("\n  │ ", " ");
    assert!(
        said.contains("frame.000000.csv`: it is not as the run left it"),
        "{said}"
    );
    std::fs::write(&first, frame).unwrap();
    let (code, _, error) = peridyne(at, &["resume", "cut"]);
    assert_eq!(code, Some(0), "{error}");
    for n in 0..5 {
        let name = format!("profile/frame.{n:06}.csv");
        let [whole, cut] = ["out", "cut"].map(|out| std::fs::read(at.join(out).join(&name)));
        assert_eq!(whole.unwrap(), cut.unwrap(), "{name}");
    }
}

/// A potential on the families of the reference, in every partition and with both pair forces: σ, q_K, q_U, q_C, z of the run and of its frames.
#[test]
fn fields_of_the_reference_are_those_of_its_frames() {
    let dir = TempDir::new().unwrap();
    let at = dir.path();
    std::fs::write(at.join("points.txt"), POINTS).unwrap();
    let silicon = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/Si.sw");
    std::fs::copy(silicon, at.join("Si.sw")).unwrap();
    for (written, flag) in [
        ("\"site\"", "site"),
        ("\"equal\"", "equal"),
        ("{ centre = 0.5 }", "centre:0.5"),
    ] {
        for pair_force in ["distances", "differences"] {
            let deck = format!(
                "units = \"metal\"\nperiodic = [\"x\", \"y\", \"z\"]\nfamily = \"reference\"\nhorizon = 5.2\n\
                 body = {{ lattice = \"diamond\", spacing = 5.43094978, cells = [2, 2, 2] }}\n\
                 material = {{ mass = 28.0855, law = {{ stillinger_weber = {{ file = \"Si.sw\" }} }} }}\n\
                 initial_velocities = {{ temperature = 300, seed = 3 }}\n\
                 run = {{ steps = 20, time_step = 0.001 }}\n\
                 output = {{ every = 20, vtu = false, trajectory = \"frames.extxyz\" }}\n\
                 [[fields]]\nkernel = \"polynomial\"\nsmoothness = 5\nwidth = 5\npoints = [{}]\nevery = 20\n\
                 partition = {written}\npair_force = \"{pair_force}\"\n",
                inline()
            );
            let out = format!("{}-{pair_force}", flag.replace(':', ""));
            std::fs::write(at.join("deck.toml"), deck).unwrap();
            let (code, _, error) = peridyne(at, &["run", "deck.toml", "--out", &out]);
            assert_eq!(code, Some(0), "{error}");
            let frames = format!("{out}/frames.extxyz");
            let files = format!("{out}-files");
            let mut words = vec!["fields", "--frames", &frames, "--out", &files];
            let flags = "--model deck.toml --kernel polynomial --smoothness 5 --width 5 --points points.txt --partition";
            words.extend(flags.split_whitespace());
            words.extend([flag, "--pair-force", pair_force]);
            let (code, _, error) = peridyne(at, &words);
            assert_eq!(code, Some(0), "{error}");
            let [live, files] = [&out, &files].map(|folder| at.join(folder));
            same(
                &live.join("fields/points.csv"),
                &files.join("points.csv"),
                1e-11,
            );
        }
    }
}
