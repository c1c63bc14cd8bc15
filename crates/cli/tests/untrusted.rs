//! Files of other people: what they ask for is weighed, what they would replace is kept.

use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const BODY: &str = r#"horizon = { m_ratio = 3 }
body = { lattice = "cubic", spacing = "2 mm", region = { block = { low = [0, 0, 0], high = ["12 mm", "12 mm", "12 mm"] } } }
material = { density = 2200, law = { pmb = { bulk = "14.9 GPa" } } }
"#;

const ATOMS: &str = r#"units = "metal"
body.file = "FILE"
material = { mass = 40, law = { lennard_jones = { epsilon = 0.01, sigma = 2.5, cutoff = 5 } } }
run = { steps = 2, time_step = 0.001 }
output = { vtu = false, picture = false, report = false }
"#;

/// Twenty-seven atoms in a periodic cell of 6; `far` is where the last one is along x.
fn frame(far: &str) -> String {
    let mut text = String::from(
        "27\nLattice=\"6 0 0 0 6 0 0 0 6\" Properties=species:S:1:pos:R:3:velo:R:3 pbc=\"T T T\"\n",
    );
    for n in 0..27 {
        let [x, y, z] = [n % 3, n / 3 % 3, n / 9].map(|k| (2 * k).to_string());
        let x = if n == 26 { far.into() } else { x };
        text += &format!("Ar {x} {y} {z} 0.1 0 0.{n}\n");
    }
    text
}

struct Case(TempDir);

impl Case {
    fn new(files: &[(&str, &str)]) -> Case {
        let dir = TempDir::new().unwrap();
        for (name, text) in files {
            std::fs::write(dir.path().join(name), text).unwrap();
        }
        Case(dir)
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// In 4 GB of address space and 20 s: what takes more is an abort or a hang. `before` are words of the shell.
    fn shell(&self, before: &str, arguments: &[&str]) -> Output {
        let begin = Instant::now();
        let done = Command::new("sh")
            .args([
                "-c",
                &format!("ulimit -v 4000000; {before} exec \"$0\" \"$@\""),
            ])
            .arg(env!("CARGO_BIN_EXE_peridyne"))
            .args(arguments)
            .current_dir(self.0.path())
            .output()
            .unwrap();
        assert!(begin.elapsed() < Duration::from_secs(20), "{arguments:?}");
        done
    }

    /// Ends with this code, and says these words.
    fn says(&self, arguments: &[&str], code: i32, words: &[&str]) {
        let done = self.shell("", arguments);
        let said = plain(&done.stderr);
        assert_eq!(done.status.code(), Some(code), "{arguments:?}: {said}");
        for word in words {
            assert!(said.contains(word), "{arguments:?}: no {word:?} in\n{said}");
        }
    }
}

/// Without frames and breaks of lines.
fn plain(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes).into_owned();
    let words = text.split(['│', ' ', '\n']).filter(|w| !w.is_empty());
    words.collect::<Vec<_>>().join(" ")
}

fn deck(more: &str) -> String {
    format!("{BODY}{more}")
}

#[test]
fn counts_of_fields_are_weighed() {
    let place = [
        "line = { from = [0, 0, 0], to = [\"20 mm\", 0, 0], count = 1000000000000 }",
        "plane = { corner = [0, 0, 0], edges = [[\"9 mm\", 0, 0], [0, \"9 mm\", 0]], counts = [4000000000, 4000000000] }",
        "grid = [4294967296, 4294967296, 4294967296]",
        "grid = [100000, 100000, 100]",
    ];
    for place in place {
        let text = deck(&format!(
            "run = {{ steps = 5 }}\n[[fields]]\nkernel = \"bspline\"\nwidth = \"6 mm\"\n{place}\n"
        ));
        let case = Case::new(&[("d.toml", &text)]);
        case.says(&["check", "d.toml"], 2, &["left"]);
        case.says(&["run", "d.toml"], 2, &["left"]);
    }
}

/// What `peridyne fields` is asked for.
const FLAGS: [&str; 17] = [
    "fields",
    "--frames",
    "l.extxyz",
    "--potential",
    "lennard_jones",
    "--with",
    "epsilon=1",
    "--with",
    "sigma=1",
    "--with",
    "cutoff=2.5",
    "--units",
    "lj",
    "--kernel",
    "polynomial",
    "--out",
    "o",
];

#[test]
fn fields_of_frames_are_weighed() {
    let case = Case::new(&[("l.extxyz", &frame("4"))]);
    let with = |more: &[&'static str]| [&FLAGS[..], more].concat();
    case.says(
        &with(&["--width", "1.5", "--grid", "1000,1000,100"]),
        2,
        &["left"],
    );
    case.says(&with(&["--width", "1e9", "--grid", "4,4,4"]), 2, &["width"]);
    let many = with(&["--width", "1.5", "--grid", "4,4,4", "--threads", "100000"]);
    case.says(&many, 2, &["100000 threads", "cores"]);
    assert!(!case.path("o").exists());
}

#[test]
fn an_atom_far_beyond_its_cell_is_told() {
    for far in ["1e12", "-1e12", "1.8e19", "1e308"] {
        let case = Case::new(&[
            ("l.extxyz", &frame(far)),
            ("d.toml", &ATOMS.replace("FILE", "l.extxyz")),
        ]);
        let all = [&FLAGS[..], &["--width", "1.5", "--grid", "3,2,1"]].concat();
        case.says(&all, 2, &["particle 27", "periods from the cell"]);
        case.says(&["check", "d.toml"], 2, &["periods from the cell"]);
    }
}

#[test]
fn a_bar_is_weighed() {
    let case = Case::new(&[]);
    let all = [
        "bar", "--m", "100", "--points", "10000000", "--ends", "half",
    ];
    case.says(&all, 2, &["8.3 GB", "left"]);
}

#[test]
fn dumps_and_films_are_in_the_estimate_of_the_disk() {
    for output in [
        "vtu = false, every = 1, dump = \"a.dump\"",
        "vtu = false, every = 1, pictures = [{ film = true }]",
    ] {
        let text = deck(&format!(
            "run = {{ steps = 100000000000 }}\noutput = {{ {output} }}\n"
        ));
        let case = Case::new(&[("d.toml", &text)]);
        case.says(&["check", "d.toml"], 2, &["TB of frames of", "left"]);
        case.says(&["run", "d.toml"], 2, &["TB of frames of", "left"]);
        assert!(!case.path("out").exists());
    }
    let script = script("dump D all custom 1 a.dump id type x y z\nrun 100000000000000\n");
    let case = Case::new(&[("in.s", &script)]);
    case.says(&["run", "in.s"], 2, &["into the dump `D`", "left"]);
}

#[test]
fn a_horizon_over_everything_is_refused_at_once() {
    let text = script("run 1\n").replace("0.0020001", "1.0");
    let case = Case::new(&[("in.s", &text)]);
    for verb in ["check", "run"] {
        let begin = Instant::now();
        case.says(
            &[verb, "in.s"],
            2,
            &["bonds per point are too many", "pair_coeff"],
        );
        assert!(
            begin.elapsed() < Duration::from_secs(5),
            "{:?}",
            begin.elapsed()
        );
    }
}

#[test]
fn threads_have_an_end() {
    let case = Case::new(&[
        (
            "d.toml",
            &deck("run = { steps = 2, threads = 1000000000 }\n"),
        ),
        ("e.toml", &deck("run = { steps = 2 }\n")),
    ]);
    case.says(
        &["run", "d.toml"],
        2,
        &["1000000000 threads", "cores", "d.toml:4"],
    );
    for verb in ["run", "check"] {
        let all = [verb, "e.toml", "--threads", "1000000000"];
        case.says(&all, 2, &["1000000000 threads", "cores"]);
    }
}

/// Links to what has no end, in place of files that decks, scripts and verbs name.
#[cfg(unix)]
#[test]
fn what_has_no_end_is_no_file() {
    let case = Case::new(&[]);
    for name in [
        "a.lammpstrj",
        "a.extxyz",
        "a.xyz",
        "a.data",
        "a.txt",
        "a.inp",
        "a.msh",
        "a.g",
        "a.npz",
    ] {
        std::os::unix::fs::symlink("/dev/zero", case.path(name)).unwrap();
        std::fs::write(case.path("d.toml"), ATOMS.replace("FILE", name)).unwrap();
        case.says(&["check", "d.toml"], 2, &[name, "plain file"]);
    }
    let words = [
        ("a.alloy", "eam = { file = \"a.alloy\", element = \"Cu\" }"),
        (
            "a.sw",
            "stillinger_weber = { file = \"a.sw\", element = \"Si\" }",
        ),
    ];
    for (name, law) in words {
        std::os::unix::fs::symlink("/dev/zero", case.path(name)).unwrap();
        let text = format!(
            "units = \"metal\"\nbody = {{ lattice = \"fcc\", spacing = 4, cells = [3, 3, 3] }}\nmaterial = {{ mass = 40, law = {{ {law} }} }}\nrun = {{ steps = 2, time_step = 0.001 }}\n"
        );
        std::fs::write(case.path("d.toml"), text).unwrap();
        case.says(&["check", "d.toml"], 2, &[name, "plain file"]);
    }
    std::os::unix::fs::symlink("/dev/zero", case.path("z.toml")).unwrap();
    for all in [
        &["run", "z.toml"][..],
        &["fields", "z.toml"],
        &["fields", "--frames", "a.extxyz"],
        &["convert", "z.toml", "--out", "o.toml"],
        &["coarsen", "z.toml", "--every", "2"],
        &["waves", "z.toml"],
    ] {
        case.says(all, 2, &[]);
    }
}

#[test]
fn a_packed_line_without_an_end_is_refused() {
    let case = Case::new(&[("d.toml", &ATOMS.replace("FILE", "a.dump"))]);
    let file = std::fs::File::create(case.path("a.dump")).unwrap();
    let mut packed = GzEncoder::new(file, Compression::fast());
    packed.write_all(b"ITEM: TIMESTEP\n").unwrap();
    for _ in 0..64 {
        packed.write_all(&[b'7'; 1 << 20]).unwrap();
    }
    packed.finish().unwrap();
    case.says(&["check", "d.toml"], 2, &["a.dump:2", "longer than"]);
}

#[test]
fn headers_are_not_trusted_with_memory() {
    let head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4000000000\nITEM: BOX BOUNDS pp pp pp\n0 6\n0 6\n0 6\nITEM: ATOMS id type x y z\n1 1 0 0 0\n";
    let xyz =
        "4000000000\nLattice=\"6 0 0 0 6 0 0 0 6\" Properties=species:S:1:pos:R:3\nAr 0 0 0\n";
    let data = "x\n\n4000000000 atoms\n1 atom types\n\n0 6 xlo xhi\n0 6 ylo yhi\n0 6 zlo zhi\n\nAtoms # atomic\n\n1 1 0 0 0\n";
    for (name, text) in [("a.data", data), ("a.dump", head), ("a.extxyz", xyz)] {
        let case = Case::new(&[("d.toml", &ATOMS.replace("FILE", name)), (name, text)]);
        case.says(&["check", "d.toml"], 2, &[name]);
    }
    let points = "x\n\n1 atoms\n4294967295 atom types\n\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms # peri\n\n1 1 1e-10 2200 0 0 0\n";
    let script = "units si\nboundary s s s\natom_style peri\nlattice sc 0.0005\nread_data points.data\npair_style peri/pmb\npair_coeff * * 1.6863e22 0.0015001 0.02 0.25\nrun 4\n";
    let case = Case::new(&[("in.s", script), ("points.data", points)]);
    case.says(
        &["check", "in.s"],
        2,
        &["in.s:5", "points.data", "4294967295 atom types"],
    );
}

const FIELDS: &str = r#"frames = "l.extxyz"
potential = "lennard_jones"
with = { epsilon = 1, sigma = 1, cutoff = 2.5 }
units = "lj"
kernel = "gaussian"
width = 1.0
grid = [2, 2, 2]
out = "OUT"
"#;

#[test]
fn a_deck_of_fields_stays_in_its_folder() {
    let case = Case::new(&[("l.extxyz", &frame("4"))]);
    let absolute = case.path("absolute");
    let inside = case.path("inside");
    std::fs::create_dir(&inside).unwrap();
    std::fs::copy(case.path("l.extxyz"), inside.join("l.extxyz")).unwrap();
    for out in ["../outside", absolute.to_str().unwrap(), "a/../../outside"] {
        std::fs::write(inside.join("f.toml"), FIELDS.replace("OUT", out)).unwrap();
        case.says(
            &["fields", "inside/f.toml"],
            2,
            &["leads out", "--allow-outside"],
        );
        assert!(!case.path("outside").exists() && !absolute.exists());
    }
    std::fs::write(inside.join("f.toml"), FIELDS.replace("OUT", "o")).unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("..", inside.join("link")).unwrap();
        std::fs::write(inside.join("g.toml"), FIELDS.replace("OUT", "link")).unwrap();
        case.says(&["fields", "inside/g.toml"], 2, &["leads out"]);
    }
    case.says(&["fields", "inside/f.toml"], 0, &[]);
    assert!(inside.join("o/fields.json").exists());
    std::fs::write(inside.join("f.toml"), FIELDS.replace("OUT", "../outside")).unwrap();
    case.says(&["fields", "inside/f.toml", "--allow-outside"], 0, &[]);
    assert!(case.path("outside/fields.json").exists());
}

#[cfg(unix)]
#[test]
fn a_link_in_place_of_a_folder_of_fields_is_not_followed() {
    let text = deck(
        "run = { steps = 2 }\n[[fields]]\nname = \"f\"\nkernel = \"bspline\"\nwidth = \"6 mm\"\ngrid = [2, 2, 2]\n",
    );
    let case = Case::new(&[("d.toml", &text)]);
    for dir in ["out", "outside"] {
        std::fs::create_dir(case.path(dir)).unwrap();
    }
    std::os::unix::fs::symlink("../outside", case.path("out/f")).unwrap();
    let done = case.shell("", &["run", "d.toml", "--out", "out"]);
    assert_ne!(done.status.code(), Some(0));
    assert!(
        plain(&done.stderr).contains("outside the folder"),
        "{}",
        plain(&done.stderr)
    );
    let left = std::fs::read_dir(case.path("outside")).unwrap();
    assert_eq!(left.count(), 0);
    case.says(
        &["run", "d.toml", "--out", "out", "--allow-outside"],
        0,
        &[],
    );
}

#[test]
fn a_deck_replaces_nothing_that_it_read() {
    let own = deck("run = { steps = 2 }\noutput = { dump = \"d.toml\" }\n");
    let points: String = (0..27)
        .map(|n| format!("{} {} {} 1\n", n % 3, n / 3 % 3, n / 9))
        .collect();
    let of_points = |output: &str| {
        format!(
            "horizon = 1.5\nbody = {{ file = \"history.txt\" }}\nmaterial = {{ density = 1, law = {{ pmb = {{ bulk = 1 }} }} }}\nunits = \"none\"\nrun = {{ steps = 2 }}\n{output}\n"
        )
    };
    let read = of_points("output = { dump = \"history.txt\" }");
    let csv = of_points("").replace("history.txt", "history.csv");
    for (text, name, kept) in [
        (&own, "d.toml", &own),
        (&read, "history.txt", &points),
        (&csv, "history.csv", &points),
    ] {
        let mut files = vec![("d.toml", &**text)];
        files.extend((name != "d.toml").then_some((name, &*points)));
        let case = Case::new(&files);
        case.says(
            &["run", "d.toml", "--out", "."],
            2,
            &[name, "never replaced"],
        );
        assert_eq!(&case.text(name), kept);
        assert!(!case.path("run.json").exists());
    }
    // another name, another folder: all well
    let case = Case::new(&[("d.toml", &own)]);
    case.says(&["run", "d.toml", "--out", "o"], 0, &[]);
    case.says(&["run", "d.toml", "--out", "o"], 0, &[]);
    assert_eq!(case.text("d.toml"), own);
}

/// A small body, and then these lines.
fn script(more: &str) -> String {
    format!(
        "units si\nboundary s s s\natom_style peri\natom_modify map array\nlattice sc 0.001\nregion box block 0 5 0 5 0 5\ncreate_box 1 box\ncreate_atoms 1 box\npair_style peri/pmb\npair_coeff * * 1.6863e22 0.0020001 0.1 0.25\nset group all density 2200\nset group all volume 1e-9\nfix F1 all nve\ntimestep 1e-7\n{more}"
    )
}

#[test]
fn a_script_replaces_neither_what_it_read_nor_files_of_others() {
    let case = Case::new(&[
        ("in.s", "units si\nprint \"gone\" file in.s\n"),
        ("in.t", "units si\nprint \"gone\" file theirs.txt\n"),
        ("in.u", "units si\nprint \"more\" append theirs.txt\n"),
        ("theirs.txt", "theirs"),
        (
            "in.v",
            &script("dump D all custom 5 own.dump id x\nlog own.log\nrun 5\n"),
        ),
    ]);
    case.says(&["run", "in.s"], 2, &["in.s:2", "never replaced"]);
    assert!(case.text("in.s").starts_with("units si"));
    for name in ["in.t", "in.u"] {
        case.says(&["run", name], 2, &["theirs.txt", "there already", "--out"]);
        assert_eq!(case.text("theirs.txt"), "theirs");
    }
    // its own files it may replace
    case.says(&["run", "in.v"], 0, &[]);
    case.says(&["run", "in.v"], 0, &[]);
    assert_eq!(case.text("own.dump").matches("TIMESTEP").count(), 2);
    case.says(&["run", "in.t", "--allow-outside"], 0, &[]);
    assert_eq!(case.text("theirs.txt"), "gone\n");
}

#[test]
fn outputs_of_a_script_have_names_of_their_own() {
    for (more, words) in [
        (
            "dump D all custom 5 history.csv id x\nrun 5\n",
            "name of a file of the results",
        ),
        (
            "dump D all custom 5 points_0.vtu id x\nrun 5\n",
            "name of a file of the results",
        ),
        (
            "dump D all custom 5 a id x\ndump E all custom 5 a id y\nrun 5\n",
            "are one file",
        ),
        (
            "dump D all custom 5 a id x\nlog a\nrun 5\n",
            "being written by another command",
        ),
    ] {
        let case = Case::new(&[("in.s", &script(more))]);
        let done = case.shell("", &["run", "in.s", "--out", "o"]);
        let said = plain(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{more}: {said}");
        assert!(said.contains(words), "{more}: {said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_script_on_a_full_disk_fails_with_whole_frames() {
    let text = script(
        "compute C all damage/atom\ndump D all custom 1 dump.peri id type x y z c_C\nrun 100\n",
    );
    let case = Case::new(&[("in.s", &text)]);
    let done = case.shell(
        "trap '' XFSZ; ulimit -f 60;",
        &["run", "in.s", "--out", "o"],
    );
    let said = plain(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{said}");
    assert!(said.contains("dump.peri"), "{said}");
    let dump = case.text("o/dump.peri");
    let frames: Vec<&str> = dump.split_inclusive("ITEM: TIMESTEP\n").skip(1).collect();
    assert!(frames.len() > 2);
    let atoms = dump.lines().nth(3).unwrap().parse::<usize>().unwrap();
    let lines = 9 * frames.len() + atoms * frames.len();
    assert_eq!(dump.lines().count(), lines, "frames are whole");
    assert!(dump.ends_with('\n'));
}

/// A film of a run that goes on as long as it is let.
fn film() -> String {
    deck(
        "run = { steps = 100000000 }\n[[initial]]\nvelocity = { x = \"0.1*sin(1e3*y)\" }\n[output]\nevery = 5000000\nvtu = false\nreport = false\npictures = [{ field = \"velocity\", film = true }]\n",
    )
}

#[cfg(unix)]
#[test]
fn frames_of_films_wait_in_the_folder_of_the_results() {
    let text = film().replace("100000000", "20").replace("5000000", "10");
    let case = Case::new(&[("d.toml", &text)]);
    let done = case.shell(
        "TMPDIR=/nowhere; export TMPDIR;",
        &["run", "d.toml", "--out", "o"],
    );
    assert_eq!(done.status.code(), Some(0), "{}", plain(&done.stderr));
    assert!(case.path("o/velocity_film.png").exists());
    let names = std::fs::read_dir(case.path("o")).unwrap();
    let hidden = |name: &std::ffi::OsStr| name.to_string_lossy().starts_with('.');
    assert_eq!(
        names
            .filter(|e| hidden(&e.as_ref().unwrap().file_name()))
            .count(),
        0
    );
}

/// Number of frames that an animated PNG says it has.
#[cfg(unix)]
fn frames_of(path: &Path) -> u32 {
    let bytes = std::fs::read(path).unwrap();
    let at = bytes.windows(4).position(|w| w == b"acTL").unwrap();
    u32::from_be_bytes(bytes[at + 4..at + 8].try_into().unwrap())
}

#[cfg(unix)]
#[test]
fn a_signal_makes_films_short_and_a_hangup_ends_as_a_termination_does() {
    let text = film()
        .replace("every = 5000000", "every = 1")
        .replace("100000000", "30000");
    let case = Case::new(&[("d.toml", &text)]);
    let mut child = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(["run", "d.toml", "--out", "o", "--threads", "1"])
        .current_dir(case.0.path())
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    // many frames, each of which takes a tenth of a second to draw
    let until = Instant::now() + Duration::from_secs(60);
    let waiting = || -> u64 {
        let files = std::fs::read_dir(case.path("o/checkpoint"))
            .into_iter()
            .flatten();
        let files = files.filter_map(|e| e.ok()?.metadata().ok());
        files.map(|m| m.len()).max().unwrap_or(0)
    };
    // 343 points of 16 bytes
    while waiting() < 1000 * 343 * 16 {
        assert!(Instant::now() < until, "no frames");
        std::thread::sleep(Duration::from_millis(20));
    }
    let begin = Instant::now();
    let told = Command::new("kill")
        .args(["-HUP", &child.id().to_string()])
        .status();
    assert!(told.unwrap().success());
    let done = child.wait().unwrap();
    assert_eq!(done.code(), Some(129));
    assert!(
        begin.elapsed() < Duration::from_secs(9),
        "{:?}",
        begin.elapsed()
    );
    let frames = frames_of(&case.path("o/velocity_film.png"));
    assert!(0 < frames && frames < 1000, "{frames} frames");
    assert!(case.text("o/run.json").contains("SIGHUP"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_hangup_that_is_passed_over_ends_nothing() {
    let text = deck("run = { steps = 400 }\n[output]\nvtu = false\nreport = false\n");
    let case = Case::new(&[("d.toml", &text)]);
    let before = "trap '' HUP; (sleep 0.3; kill -HUP $$) &";
    let done = case.shell(before, &["run", "d.toml", "--out", "o"]);
    assert_eq!(done.status.code(), Some(0), "{}", plain(&done.stderr));
}

#[test]
fn a_cloud_in_another_order_of_lines_has_the_same_step() {
    let mut points: Vec<String> = (0..120)
        .map(|n| {
            let [x, y, z] = [n % 6, n / 6 % 5, n / 30].map(|k| 0.01 * f64::from(k));
            // no lattice: each has its place
            let off = 0.002 * (f64::from(n) * 0.754_877_666).fract();
            format!("{} {} {} 1e-6\n", x + off, y - 0.5 * off, z + 0.7 * off)
        })
        .collect();
    let body = "horizon = 0.031\nbody = { file = \"cloud.txt\", spacing = 0.01 }\nmaterial = { density = 1000, law = { lps = { young = 1e9, poisson = 0.3 } } }\nrun.steps = 1\n";
    let mut step = || {
        let case = Case::new(&[("a.toml", body), ("cloud.txt", &points.concat())]);
        points.reverse();
        points.rotate_left(37);
        let done = case.shell("", &["check", "--json", "a.toml"]);
        let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
        json["stable_step"].as_f64().unwrap()
    };
    let (one, other) = (step(), step());
    assert!((one - other).abs() <= 1e-13 * one, "{one} is not {other}");
}

/// Steps of the states of a run, the oldest first.
#[cfg(unix)]
fn states(case: &Case) -> Vec<u64> {
    let entries = std::fs::read_dir(case.path("o/checkpoint"));
    let names = entries.into_iter().flatten().flatten();
    let mut steps: Vec<u64> = names
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let digits = name.strip_prefix("step_")?.strip_suffix(".state")?;
            digits.parse().ok()
        })
        .collect();
    steps.sort_unstable();
    steps
}

#[cfg(unix)]
#[test]
fn a_run_that_is_asked_for_a_state_writes_it_and_goes_on() {
    let text = deck(
        "run = { steps = 100000000 }\n[output]\nvtu = false\nreport = false\npicture = false\nhistory = 1000\ncheckpoint = false\n",
    );
    let case = Case::new(&[("d.toml", &text)]);
    let mut child = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(["run", "d.toml", "--out", "o", "--threads", "1"])
        .current_dir(case.0.path())
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let until = Instant::now() + Duration::from_secs(60);
    let wait = |what: &str, is: &dyn Fn() -> bool| {
        while !is() {
            assert!(Instant::now() < until, "{what}");
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    let signal = |name: &str| {
        let told = Command::new("kill")
            .args([name, &child.id().to_string()])
            .status();
        assert!(told.unwrap().success());
    };
    let rows = || {
        let text = std::fs::read_to_string(case.path("o/history.csv"));
        text.map_or(0, |t| t.lines().count())
    };
    wait("no steps", &|| rows() > 2);
    assert!(states(&case).is_empty());
    signal("-USR1");
    wait("no state", &|| states(&case).len() == 1);
    let (first, before) = (states(&case)[0], rows());
    wait("it does not go on", &|| rows() > before + 2);
    signal("-USR1");
    wait("no second state", &|| states(&case).len() == 2);
    assert!(states(&case)[1] > first);
    signal("-TERM");
    assert_eq!(child.wait().unwrap().code(), Some(143));
    let run: serde_json::Value = serde_json::from_str(&case.text("o/run.json")).unwrap();
    let last = states(&case);
    assert_eq!(run["steps"].as_u64(), last.last().copied());
    let stop = (last[last.len() - 1] + 5).to_string();
    let done = case.shell("", &["resume", "o", "--stop-after", &stop]);
    assert_eq!(done.status.code(), Some(0), "{}", plain(&done.stderr));
    assert!(
        case.text("o/run.json")
            .contains(&format!("\"steps\": {stop}"))
    );
}

/// No file may be larger than some kilobytes: a state is not written, and the one before stays.
#[cfg(unix)]
#[test]
fn a_disk_that_is_full_when_a_state_is_written_leaves_the_one_before() {
    let text = deck(
        "run = { steps = 30 }\n[[initial]]\nvelocity = { x = \"0.1*sin(1e3*y)\" }\n[output]\nvtu = false\nreport = false\npicture = false\nhistory = 10\ncheckpoint = false\n",
    )
    .replace("12 mm", "24 mm");
    let case = Case::new(&[("d.toml", &text)]);
    let good = |before: &str, arguments: &[&str]| {
        let done = case.shell(before, arguments);
        assert_eq!(done.status.code(), Some(0), "{}", plain(&done.stderr));
        plain(&done.stderr)
    };
    good("", &["run", "d.toml", "--out", "whole"]);
    good("", &["run", "d.toml", "--out", "o", "--stop-after", "10"]);
    assert_eq!(states(&case), [10]);
    // of 512 or 1024 bytes each; a state of 2197 points has more than 150 kilobytes
    let full = "trap '' XFSZ; ulimit -f 100;";
    let said = good(full, &["resume", "o", "--stop-after", "20"]);
    assert!(
        said.contains("no state to go on from was written"),
        "{said}"
    );
    assert!(said.contains("step_0000000020.state"), "{said}");
    assert_eq!(states(&case), [10]);
    let names = std::fs::read_dir(case.path("o/checkpoint")).unwrap();
    assert_eq!(names.count(), 1, "a part of a state is left");
    let said = good("", &["resume", "o"]);
    assert!(said.contains("going on from step 10"), "{said}");
    assert_eq!(case.text("o/history.csv"), case.text("whole/history.csv"));
}
