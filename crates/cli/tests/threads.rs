//! Every good deck, shortened, and every small script writes the same bytes on any number of threads and ranks, and ends as `hashes.txt` says.

use serde_json::Value;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use tempfile::TempDir;

/// Steps of a run; statics and relaxations are run whole.
const STEPS: i64 = 12;
/// What `run.json` says of the machine and the clock.
const CLOCK: [&str; 6] = [
    "seconds_stepping",
    "seconds",
    "ns_per_bond_step",
    "peak_memory_bytes",
    "threads",
    "ranks",
];
/// How lines of LAMMPS's own output begin that tell of the clock and of memory.
const CLOCK_OF_LAMMPS: [&str; 2] = ["Loop time of ", "Per MPI rank memory"];
/// The same of a conservation law.
const CLOCK_OF_LAW: [&str; 3] = ["seconds_stepping", "ns_per_point_step", "peak_memory_bytes"];

/// Takes that away.
fn stop_clock(run: &mut Value) {
    let clock = match run["kind"] == "conservation_law" {
        true => &CLOCK_OF_LAW[..],
        false => &CLOCK,
    };
    for key in clock {
        assert!(run.as_object_mut().unwrap().remove(*key).is_some(), "{key}");
    }
}

/// Lines without those of the clock.
fn without_clock_of_lammps<'a>(lines: impl Iterator<Item = &'a str>) -> String {
    let clock = |line: &&str| CLOCK_OF_LAMMPS.iter().any(|word| line.starts_with(word));
    let lines = lines.filter(|line| !clock(line));
    lines.map(|line| format!("{line}\n")).collect()
}

/// What is run.
struct Case {
    /// File stem of a deck; a script's file.
    name: String,
    path: PathBuf,
    /// May it solve equations by sparse factors?
    factors: bool,
}

impl Case {
    fn is_script(&self) -> bool {
        self.name.starts_with("in.")
    }

    /// Where a run of so many steps is cut off: a deck after a third of them, a script that has several runs after its first and in the
    /// middle of what is left.
    fn stops(&self, steps: u64) -> Vec<u64> {
        if !self.is_script() {
            return vec![steps / 3];
        }
        let text = std::fs::read_to_string(&self.path).unwrap();
        let runs: Vec<u64> = { text.lines() }
            .filter_map(|line| line.strip_prefix("run ")?.split_whitespace().next())
            .map(|steps| steps.parse().unwrap())
            .collect();
        match runs[..] {
            [first, _, ..] => vec![first, first + (steps - first) / 2],
            [_] | [] => vec![],
        }
    }
}

/// Of so many decks one draws its last state as a picture: half the work of a short run, of a state that is compared anyway.
const PICTURED: usize = 4;

/// A copy of the good decks and what they read, with runs of so many steps.
fn decks(to: &Path, steps: i64) -> Vec<Case> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    let mut decks = vec![];
    let entries = std::fs::read_dir(from).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        if !path.is_file() {
            continue;
        }
        let copy = to.join(path.file_name().unwrap());
        if path.extension().is_none_or(|e| e != "toml") {
            std::fs::copy(&path, &copy).unwrap();
            continue;
        }
        let mut deck: toml::Table = std::fs::read_to_string(&path).unwrap().parse().unwrap();
        let output = { deck.entry("output") }.or_insert_with(|| toml::Table::new().into());
        if let (Some(output), true) = (output.as_table_mut(), decks.len() % PICTURED > 0) {
            output
                .entry("picture")
                .or_insert(toml::Value::Boolean(false));
        }
        let mut factors = deck.contains_key("statics");
        if let Some(toml::Value::Table(run)) = deck.get_mut("run") {
            let integrator = run.get("integrator").and_then(|i| i.as_str());
            factors |= integrator.is_some_and(|i| ["newmark", "hht"].contains(&i));
            run.remove("duration");
            run.insert("steps".into(), toml::Value::Integer(steps));
        }
        std::fs::write(&copy, toml::to_string(&deck).unwrap()).unwrap();
        decks.push(Case {
            name: path.file_stem().unwrap().to_str().unwrap().to_string(),
            path: copy,
            factors,
        });
    }
    decks.sort_by(|a, b| a.name.cmp(&b.name));
    decks
}

/// The good decks of conservation laws, whole.
fn laws() -> Vec<Case> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/conservation");
    let paths = std::fs::read_dir(from).unwrap().map(|e| e.unwrap().path());
    let mut laws: Vec<Case> = paths
        .map(|path| Case {
            name: format!("law.{}", path.file_stem().unwrap().display()),
            path,
            factors: false,
        })
        .collect();
    laws.sort_by(|a, b| a.name.cmp(&b.name));
    assert!(laws.len() >= 6);
    laws
}

/// The small scripts that LAMMPS has computed, too.
fn scripts() -> Vec<Case> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../verify/lammps/cases");
    let paths = std::fs::read_dir(from).unwrap().map(|e| e.unwrap().path());
    let mut scripts: Vec<Case> = paths
        .map(|path| Case {
            name: path.file_name().unwrap().to_str().unwrap().to_string(),
            path,
            factors: false,
        })
        .filter(Case::is_script)
        .collect();
    scripts.sort_by(|a, b| a.name.cmp(&b.name));
    scripts
}

/// All files of a folder by name, `run.json` without the clock.
fn files(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![dir.to_path_buf()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
                continue;
            }
            let mut bytes = std::fs::read(&path).unwrap();
            if path.file_name().is_some_and(|n| n == "run.json") {
                let mut report: Value = serde_json::from_slice(&bytes).unwrap();
                stop_clock(&mut report);
                bytes = report.to_string().into_bytes();
            }
            if path.file_name().is_some_and(|n| n == "report.html") {
                bytes = without_clock(&bytes);
            }
            if path.extension().is_some_and(|e| e == "log") {
                let text = String::from_utf8(bytes).unwrap();
                bytes = without_clock_of_lammps(text.lines()).into_bytes();
            }
            all.insert(path.strip_prefix(dir).unwrap().to_path_buf(), bytes);
        }
    }
    all
}

/// A report without what it says of the machine and the clock, and of how long `run.json` is.
fn without_clock(page: &[u8]) -> Vec<u8> {
    const BEGIN: &str = "<script type=\"application/json\" id=\"meta\">";
    let page = std::str::from_utf8(page).unwrap();
    let (before, rest) = page.split_once(BEGIN).unwrap();
    let (meta, after) = rest.split_once("</script>").unwrap();
    let mut meta: Value = serde_json::from_str(meta).unwrap();
    stop_clock(&mut meta["run"]);
    for key in ["facts", "files"] {
        assert!(meta.as_object_mut().unwrap().remove(key).is_some(), "{key}");
    }
    format!("{before}{meta}{after}").into_bytes()
}

/// The program on a case, and what it [printed].
fn program(case: &Case, arguments: &[&str]) -> String {
    let name = &case.name;
    let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{name} {arguments:?}: {said}");
    printed(done.stdout)
}

/// What LAMMPS would have printed, without the clock: what comes before the first line of ours.
fn printed(stdout: Vec<u8>) -> String {
    let text = String::from_utf8(stdout).unwrap();
    let ours = |line: &&str| {
        ["done", "ended by "]
            .iter()
            .any(|word| line.starts_with(word))
    };
    without_clock_of_lammps(text.lines().take_while(|line| !ours(line)))
}

/// Runs a case; all that it wrote.
fn run(dir: &Path, case: &Case, threads: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let out = dir.join(format!("{}-{threads}", case.name));
    let to = out.to_str().unwrap();
    let deck = case.path.to_str().unwrap();
    let mut arguments = vec!["run", deck, "--threads", threads, "--out", to];
    if threads != "1" {
        arguments.extend(["--on-threads", "3"]);
    }
    let said = program(case, &arguments);
    with_output(case, files(&out), said)
}

/// Of a script what it printed, too.
fn with_output(
    case: &Case,
    mut files: BTreeMap<PathBuf, Vec<u8>>,
    said: String,
) -> BTreeMap<PathBuf, Vec<u8>> {
    if case.is_script() {
        files.insert("printed".into(), said.into_bytes());
    }
    files
}

/// The same in parts, each on another number of threads and of ranks: to the first stop, as if it were cut off there, from there to the next, and so on.
fn run_in_parts(dir: &Path, case: &Case, stops: &[u64]) -> BTreeMap<PathBuf, Vec<u8>> {
    let out = dir.join(format!("{}-parts", case.name));
    let to = out.to_str().unwrap();
    let deck = case.path.to_str().unwrap();
    let mut said = String::new();
    for part in 0..=stops.len() {
        let mut arguments = match part {
            0 => vec!["run", deck, "--out", to],
            _ => vec!["resume", to],
        };
        arguments.extend(["--threads", ["1", "3", "2"][part % 3]]);
        if let Some(ranks) = [Some("3"), None, Some("2"), Some("4")][part % 4] {
            arguments.extend(["--on-threads", ranks]);
        }
        let stop = stops.get(part).map(u64::to_string);
        if let Some(stop) = &stop {
            arguments.extend(["--stop-after", stop]);
        }
        let before = last_state(&out);
        let printed = program(case, &arguments);
        // where no state was written the next part begins where this one did
        if stop.is_none() || last_state(&out) != before {
            said += &printed;
        }
        assert_eq!(
            out.join("checkpoint").is_dir(),
            stop.is_some(),
            "{}",
            case.name
        );
    }
    with_output(case, files(&out), said)
}

/// Steps of the newest state of a run that was cut off.
fn last_state(out: &Path) -> Option<String> {
    let entries = std::fs::read_dir(out.join("checkpoint")).into_iter();
    let names = entries
        .flatten()
        .map(|e| e.unwrap().file_name().into_string().unwrap());
    let steps = names.filter_map(|name| {
        let digits = name.strip_prefix("step_")?.strip_suffix(".state")?;
        digits.parse::<u64>().ok()
    });
    steps.max().map(|step| step.to_string())
}

/// One case on one thread, and on ranks of three, which halve no work evenly, in parts where it has some. How it ended: a line of the table.
fn compare(dir: &Path, case: &Case) -> String {
    let (line, report) = compare_cut(dir, case, &|steps| case.stops(steps));
    let warned = report["warnings"].to_string();
    assert!(!warned.contains("energy balance"), "{line}: {warned}");
    line
}

/// The same with other stops, and the run's record.
fn compare_cut(dir: &Path, case: &Case, stops: &dyn Fn(u64) -> Vec<u64>) -> (String, Value) {
    let name = &case.name;
    let one = run(dir, case, "1");
    assert!(one.len() >= 2, "{name}");
    let report = Path::new("run.json");
    let steps = |of: &[u8]| serde_json::from_slice::<Value>(of).unwrap()["steps"].as_u64();
    let stops = steps(&one[report])
        .filter(|steps| *steps > 0)
        .map(stops)
        .unwrap_or_default();
    let many = match stops[..] {
        [] => run(dir, case, "3"),
        [..] => run_in_parts(dir, case, &stops),
    };
    let names = |of: &BTreeMap<PathBuf, Vec<u8>>| of.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&many), "{name}: other files");
    for (file, bytes) in &one {
        let same = many[file] == *bytes;
        assert!(same, "{name}: {} cut off at {stops:?}", file.display());
    }
    let report: Value = serde_json::from_slice(&one[report]).unwrap();
    let [state, ledger] = ["state_hash", "ledger_hash"].map(|key| report[key].as_str());
    let mut line = format!("{name} {} {}", state.unwrap(), ledger.unwrap_or("-"));
    if case.factors {
        line += " factors";
    }
    (line, report)
}

/// What the table says of itself, after the line with the features of the machine that wrote it.
const HEADER: &str = "\
# How each good deck of 12 steps, each law and each script of verify/lammps/cases ends: its name, state_hash and ledger_hash
# of its run.json (-: none). PERIDYNE_RENEW_HASHES=1 cargo test -p peridyne-cli --test threads writes this table anew.
# `factors`: the deck has [statics] or an implicit integrator, and so may solve by sparse factors, for which faer takes
# the instructions that it finds; such a line is compared where the processor has the features of the first line.
";

fn table() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hashes.txt")
}

/// What faer chooses by.
fn features() -> String {
    #[cfg(target_arch = "x86_64")]
    let found = [
        ("avx2", std::is_x86_feature_detected!("avx2")),
        ("fma", std::is_x86_feature_detected!("fma")),
        ("avx512f", std::is_x86_feature_detected!("avx512f")),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let found = [(std::env::consts::ARCH, true)];
    let found = found.iter().filter(|(_, there)| *there);
    let names: Vec<&str> = found.map(|(name, _)| *name).collect();
    format!("# {}", names.join(" "))
}

/// Lines of the table that are wrong, as they would have to be.
fn wrong(table: &str, lines: &[String]) -> Vec<String> {
    let alike = table.lines().next() == Some(&*features());
    let name = |line: &str| line.split(' ').next().unwrap().to_string();
    let known = table.lines().filter(|l| !l.starts_with('#'));
    let mut known: BTreeMap<String, &str> = known.map(|l| (name(l), l)).collect();
    let mut wrong = vec![];
    for line in lines {
        let before = known.remove(&name(line));
        let counts = alike || !line.ends_with(" factors");
        if before.is_none_or(|before| before != line && counts) {
            wrong.push(line.clone());
        }
    }
    wrong.extend(known.into_keys().map(|name| format!("{name}: is gone")));
    wrong
}

#[test]
fn every_good_deck_writes_the_same_bytes_on_any_number_of_threads_and_ends_as_it_did() {
    let dir = TempDir::new().unwrap();
    let mut cases = decks(dir.path(), STEPS);
    assert!(cases.len() >= 20);
    cases.extend(laws());
    cases.extend(scripts());
    let lines = each(&cases, &|case| compare(dir.path(), case));
    if std::env::var_os("PERIDYNE_RENEW_HASHES").is_some() {
        let text = format!("{}\n{HEADER}{}\n", features(), lines.join("\n"));
        return std::fs::write(table(), text).unwrap();
    }
    let wrong = wrong(&std::fs::read_to_string(table()).unwrap(), &lines);
    assert!(
        wrong.is_empty(),
        "{} ends are not those of {}:\n{}",
        wrong.len(),
        table().display(),
        wrong.join("\n")
    );
}

/// Runs in a loop, in another file, in a command and in parts; with numbers that are drawn, means, and files that grow in every way.
const SCRIPT: &str = r#"# A bar of LPS
log             bar.log
variable        seed index 5
units           si
dimension       3
boundary        s s s
atom_style      peri
atom_modify     map array
neighbor        0.0005 bin
lattice         sc 0.0005
region          box block -4 4 -3 3 -3 3
create_box      1 box
create_atoms    1 region box
pair_style      peri/lps
pair_coeff      * * 14.9e9 10.2e9 0.0015001 0.01 0.25
set             group all density 2200
set             group all volume 1.25e-10
velocity        all set 0.0 0.0 0.0 sum no units box
timestep        1.0e-7
compute         dmg all damage/atom
compute         dsum all reduce sum c_dmg
compute         way all displace/atom
compute         wmax all reduce max c_way[4]
fix             F1 all nve
fix             AV all ave/time 1 2 4 c_dsum ave running file means.txt
variable        e equal ke
fix             P1 all print 3 "step $(step) energy ${e}" file print.txt screen no
thermo_style    custom step pe ke c_dsum c_wmax f_AV
thermo_modify   format float %.17g
thermo          5
run             1
variable        vx atom 2.0e3*x+5.0*random(-1,1,${seed})
velocity        all set v_vx 0.0 0.0 sum no units box
dump            D1 all custom 7 bar.dump id type x vx c_dmg
dump_modify     D1 sort id format float %.17g
run             20
region          r block 1 INF INF INF INF INF
group           right region r
group           left subtract all right
unfix           F1
fix             F2 left nve
fix             M2 right move linear 10.0 NULL NULL
variable        i loop 3
label           again
velocity        left set v_vx 0.0 0.0 sum yes units box
print           "pass $i" append passes.txt
run             6
next            i
jump            SELF again
include         more.in
if "$(c_wmax) > 0" then "run 4"
run             6 every 3 "print between"
run             2
"#;

/// A body of 20 blocks, led in every way, of which atoms are lost within a run.
const LED: &str = r#"units           si
dimension       3
boundary        f f f
atom_style      peri
atom_modify     map array
neighbor        0.0005 bin
lattice         sc 0.0005 origin 0.5 0.5 0.5
region          box block -14 14 -12 12 -14 14
create_box      2 box
region          body block -9 9 -7 7 -10 10
create_atoms    1 region body
pair_style      peri/pmb
pair_coeff      * * 1.6863e22 0.0015001 0.02 0.25
set             group all density 2200
set             group all volume 1.25e-10
velocity        all set 0.0 0.0 0.0 sum no units box
timestep        1.0e-7
compute         dmg all damage/atom
compute         dsum all reduce sum c_dmg
region          left block INF -8 INF INF INF INF
region          right block 8 INF INF INF INF INF
region          top block -1 1 6 INF INF INF
group           left region left
group           right region right
group           top region top
group           free subtract all left right top
variable        fx atom 1e9*sin(z*1000)
variable        dx equal 2e-6*sin(4e5*time)
variable        vx equal 0.8*cos(4e5*time)
fix             F1 free nve
fix             M1 left move linear -8000 NULL 0.0
fix             M2 right move rotate 0 0 0 1 0 0 4e-4
fix             M4 top move variable v_dx NULL NULL v_vx NULL NULL
fix             A1 free addforce v_fx 1e9 0.0
fix             S1 top setforce NULL 0.0 NULL
fix             V1 free viscous 2e8
fix             I1 free indent 1e17 sphere 0 0.005 0 0.002 units box
fix             W1 all wall/reflect zhi 12.5
thermo_style    custom step pe ke c_dsum atoms f_I1 f_I1[2] f_S1[2] f_A1[1]
thermo_modify   format float %.17g lost ignore
thermo          5
dump            D1 all custom 20 many.dump id type x y z vx vy vz c_dmg
dump_modify     D1 sort id format float %.17g
run             1
velocity        free ramp vz -90000 150000 z -10 10 sum yes
velocity        free ramp vy -500000 900000 y -7 7 sum yes
run             99
"#;

#[test]
fn a_script_that_leads_a_body_of_many_blocks_writes_the_same_bytes_on_ranks() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("in.led");
    std::fs::write(&path, LED).unwrap();
    let case = Case {
        name: "in.led".into(),
        path,
        factors: false,
    };
    let (_, report) = compare_cut(dir.path(), &case, &|_| vec![1, 60, 85]);
    // of 5040
    let left = report["particles"].as_u64().unwrap();
    assert!((5000..5040).contains(&left), "{left}");
    assert!(report["broken_bonds"].as_u64().unwrap() > 50_000);
    let out = dir.path().join("ranks");
    let [to, script] = [&out, &case.path].map(|p| p.to_str().unwrap());
    program(
        &case,
        &[
            "run",
            script,
            "--out",
            to,
            "--threads",
            "1",
            "--on-threads",
            "5",
        ],
    );
    let record = std::fs::read_to_string(out.join("run.json")).unwrap();
    let record: Value = serde_json::from_str(&record).unwrap();
    assert_eq!(record["ranks"], 5);
    assert_eq!(record["ledger_hash"], report["ledger_hash"]);
}

#[test]
fn a_script_that_is_cut_off_anywhere_goes_on_to_the_same_bytes() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("in.bar");
    std::fs::write(&path, SCRIPT).unwrap();
    std::fs::write(dir.path().join("more.in"), "run 5\n").unwrap();
    let case = Case {
        name: "in.bar".into(),
        path: path.clone(),
        factors: false,
    };
    // at the end of a run, in runs, in that of a loop, of a file; what is asked for in the run of a command and in one of parts waits
    let stops = [1, 12, 24, 33, 41, 46, 50];
    compare_cut(dir.path(), &case, &|steps| {
        assert_eq!(steps, 56);
        stops.to_vec()
    });
    let out = dir.path().join("cut");
    let [to, script] = [&out, &path].map(|p| p.to_str().unwrap());
    program(&case, &["run", script, "--out", to, "--stop-after", "46"]);
    assert_eq!(last_state(&out).unwrap(), "48");
    let refused = |why: &str| {
        let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
            .args(["resume", to])
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stderr).replace('│', " ");
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(done.status.code(), Some(2), "{said}");
        assert!(said.contains(why), "{why}: {said}");
    };
    for name in ["bar.dump", "means.txt", "print.txt", "bar.log"] {
        let file = out.join(name);
        let bytes = std::fs::read(&file).unwrap();
        let mut other = bytes.clone();
        other[5] ^= 1;
        std::fs::write(&file, other).unwrap();
        refused("it is not as the run left it");
        std::fs::write(&file, bytes).unwrap();
    }
    std::fs::write(dir.path().join("more.in"), "run 6\n").unwrap();
    refused("this is not the file that the run began with");
    std::fs::write(
        &path,
        SCRIPT.replace("run             2", "run             3"),
    )
    .unwrap();
    refused("this is not the script that the run began with");
}

/// What each case gives, two at a time: much of a run is on one thread.
fn each(cases: &[Case], of: &(dyn Fn(&Case) -> String + Sync)) -> Vec<String> {
    let next = AtomicUsize::new(0);
    let lines = Mutex::new(BTreeMap::new());
    let failed = Mutex::new(vec![]);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let n = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(n) else { break };
                    // all that fail are told
                    match catch_unwind(AssertUnwindSafe(|| of(case))) {
                        Ok(line) => drop(lines.lock().unwrap().insert(n, line)),
                        Err(_) => failed.lock().unwrap().push(&*case.name),
                    }
                }
            });
        }
    });
    let failed = failed.into_inner().unwrap();
    assert!(failed.is_empty(), "{failed:?}");
    lines.into_inner().unwrap().into_values().collect()
}

/// Bodies whose bonds and points remember something, as lattices and clouds, one and several.
const REMEMBER: [&str; 10] = [
    "bond_energy",
    "glued_solids",
    "graded_solid",
    "healing_polymer",
    "johnson_cook_bar",
    "mesh_plate",
    "minimal_crack",
    "plastic_bar",
    "relaxing_sheet",
    "silicon_torn",
];

#[test]
fn a_state_is_the_initial_state_of_another_run_on_any_number_of_ranks() {
    let dir = TempDir::new().unwrap();
    let mut cases = decks(dir.path(), STEPS);
    cases.retain(|case| REMEMBER.contains(&&*case.name));
    assert_eq!(cases.len(), REMEMBER.len());
    let hashes = each(&cases, &|case| {
        let place = |part: &str| dir.path().join(format!("{}-{part}", case.name));
        let [earlier, one, three] = ["earlier", "one", "three"].map(place);
        let [deck, from] = [&case.path, &earlier].map(|p| p.to_str().unwrap());
        let steps = (STEPS / 2).to_string();
        program(case, &["run", deck, "--out", from, "--stop-after", &steps]);
        let anew = |out: &Path, ranks: &[&str]| {
            let out = out.to_str().unwrap();
            let words = [
                "resume",
                from,
                "--as-initial",
                deck,
                "--out",
                out,
                "--threads",
                "1",
            ];
            program(case, &[&words[..], ranks].concat());
        };
        anew(&one, &[]);
        anew(&three, &["--on-threads", "3"]);
        let [one, three] = [&one, &three].map(|out| files(out));
        assert_eq!(
            one.keys().collect::<Vec<_>>(),
            three.keys().collect::<Vec<_>>()
        );
        for (file, bytes) in &one {
            assert!(three[file] == *bytes, "{}: {}", case.name, file.display());
        }
        let record: Value = serde_json::from_slice(&one[Path::new("run.json")]).unwrap();
        record["state_hash"].to_string()
    });
    assert_eq!(hashes.len(), REMEMBER.len());
}

/// Of as many steps as `PERIDYNE_RESTART_STEPS` says, 48 otherwise; of decks with a part of a name in `PERIDYNE_DECKS` alone.
#[test]
#[ignore = "hours with many steps: the command is in CONTRIBUTING.md"]
fn every_good_deck_that_is_cut_off_three_times_writes_the_same_bytes() {
    let dir = TempDir::new().unwrap();
    let steps = std::env::var("PERIDYNE_RESTART_STEPS");
    let mut cases = decks(dir.path(), steps.map_or(48, |n| n.parse().unwrap()));
    cases.extend(laws());
    let only = std::env::var("PERIDYNE_DECKS").unwrap_or_default();
    cases.retain(|case| case.name.contains(&only));
    let quarters = |steps: u64| [1, 2, 3].map(|n| n * steps / 4).to_vec();
    each(&cases, &|case| {
        let (line, _) = compare_cut(dir.path(), case, &quarters);
        println!("{line}");
        line
    });
}

#[test]
fn a_wrong_line_of_the_table_is_found() {
    let lines = ["a 1 2", "b 3 -", "c 4 5 factors"].map(String::from);
    let of = |first: &str, text: &str| wrong(&format!("{first}\n# x\n{text}"), &lines);
    let here = features();
    assert!(of(&here, "a 1 2\nb 3 -\nc 4 5 factors\n").is_empty());
    assert_eq!(of(&here, "a 1 2\nb 3 4\nc 4 6 factors\n"), lines[1..]);
    // the factors of another machine, a new line and an old one
    let other = of("# none", "a 1 2\nc 4 6 factors\nd 7 8\n");
    assert_eq!(other, ["b 3 -", "d: is gone"]);
}
