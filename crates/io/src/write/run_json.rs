//! `run.json`: what ran, how fast, in how much memory, and where the energy went; for scripts and benchmarks.

use std::fmt;
use std::path::Path;

use peridyne::observe::{Ledger, StateHash};
use peridyne::state::{Archive, Owner};
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::atomic::{WriteError, write_file};
use super::picture::marks::{Mark, Marks};
use super::picture::rigid::{Form, Placed};
use crate::deck::{UnitSystem, each_once};

/// Everything `run.json` holds. Numbers are in the units of the run; a number that is not finite reads `null`.
#[derive(Debug, Clone, Serialize)]
pub struct RunReport {
    /// Version of peridyne.
    pub version: String,
    /// The deck or script as given on the command line.
    pub deck: String,
    /// [`deck_hash`] of its bytes.
    pub deck_hash: String,
    pub title: String,
    pub status: Status,
    /// The signal that ended the run early, where one did.
    pub ended_by: Option<String>,
    pub particles: u64,
    /// Bonds at the start.
    pub bonds: u64,
    /// Steps done.
    pub steps: u64,
    pub time_step: f64,
    /// Most parts in which a step was done, as bonds became shorter and stiffer; 1: all were whole.
    pub parts_of_a_step: u32,
    /// Wall time inside the steps alone (s).
    pub seconds_stepping: f64,
    /// What was spent beside them.
    pub seconds: Spent,
    /// [`ns_per_bond_step`].
    pub ns_per_bond_step: Option<f64>,
    /// [`peak_memory_bytes`].
    pub peak_memory_bytes: Option<u64>,
    pub broken_bonds: u64,
    /// Connected components, when they were counted.
    pub fragments: Option<u64>,
    /// Of the last state, as `state_hash` and `ledger_hash`.
    #[serde(flatten, serialize_with = "digits")]
    pub hash: StateHash,
    /// Processes that shared the run, 1: one had all of it.
    pub ranks: usize,
    /// Of each of them.
    pub threads: usize,
    /// Instruction set of the hot loop ("avx512", "avx2", "portable").
    pub simd: String,
    pub energy: EnergyReport,
    /// File names of pictures and films.
    pub pictures: Vec<String>,
    pub warnings: Vec<String>,
    /// What reports tell besides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub setting: Option<Setting>,
}

/// Wall time of a run (s): all of it, and what is no steps. Of a run that went on, of all its parts, each to the state that the next
/// began with.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Spent {
    pub all: f64,
    /// Frames, rows of the history and what else is written as a run goes on.
    pub frames: f64,
    /// Continuum fields.
    pub fields: f64,
    /// Pictures and films.
    pub pictures: f64,
    /// States to go on from.
    pub checkpoints: f64,
    /// The report; it is made of `run.json`, which does not know.
    #[serde(skip)]
    pub report: f64,
    /// All of each part, of a run that went on.
    #[serde(skip_serializing_if = "is_one")]
    pub parts: Vec<f64>,
}

fn is_one(parts: &[f64]) -> bool {
    parts.len() < 2
}

impl Owner for Spent {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("all", &mut self.all);
        archive.one("fields", &mut self.fields);
        archive.one("pictures", &mut self.pictures);
        archive.one("checkpoints", &mut self.checkpoints);
        archive.list("parts", &mut self.parts);
    }
}

impl Spent {
    /// So much more of the part that is going on.
    pub fn goes_on(&mut self, seconds: f64) {
        self.all += seconds;
        if let Some(last) = self.parts.last_mut() {
            *last += seconds;
        }
    }

    /// A sentence of the parts that took time, with that of the steps.
    pub fn told(&self, stepping: f64) -> String {
        let parts = [
            ("steps", stepping),
            ("frames", self.frames),
            ("fields", self.fields),
            ("pictures", self.pictures),
            ("checkpoints", self.checkpoints),
            ("report", self.report),
        ];
        let there = parts.iter().filter(|(_, seconds)| *seconds >= 0.005);
        let each = there.map(|(name, seconds)| format!("{name} {seconds:.2} s"));
        let each: Vec<String> = each.collect();
        format!("in all {:.2} s: {}", self.all, each.join(", "))
    }
}

/// How a run was asked for, and what its files hold: with them, all that a report tells.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Setting {
    /// What makes the same run again.
    pub command: String,
    pub deck_text: String,
    /// What was understood, in lines of a word and its text.
    pub understood: String,
    /// Where the laws come from.
    pub sources: Vec<String>,
    pub dimension: usize,
    /// Typical distance of points (length); 0 where it is not known.
    pub spacing: f64,
    /// Are steps increments of load?
    pub statics: bool,
    pub atoms: bool,
    pub units: UnitNames,
    pub fields: Vec<FieldNote>,
    pub rigid_bodies: Vec<RigidNote>,
    pub marks: MarkNotes,
    /// Pictures of continuum fields, in the folder.
    pub slices: Vec<String>,
    /// Files with snapshots of atoms that a script wrote, and what their columns are here.
    pub dumps: Vec<String>,
    pub columns: Vec<(String, String)>,
    /// Names in the folder, of series their collection.
    pub files: Vec<String>,
}

/// Names of the units of what a report shows beside fields.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct UnitNames {
    pub length: String,
    pub time: String,
    pub energy: String,
}

/// A rigid body: what it looks like along its own axes, a ball of this radius or triangles; and where it was, linear between.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RigidNote {
    pub radius: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub corner: Vec<[f32; 3]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub face: Vec<[u32; 3]>,
    /// Normal of a plane, all that is behind it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plane: Option<[f64; 3]>,
    /// Time and centre.
    pub path: Vec<[f64; 4]>,
    /// Of each of these the axes, rows from its own to space; none of one that never turns.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<[[f64; 3]; 3]>,
}

impl Owner for RigidNote {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("radius", &mut self.radius);
        archive.list("corners", &mut self.corner);
        archive.list("faces", &mut self.face);
        archive.one("plane", &mut self.plane);
        archive.list("path", &mut self.path);
        archive.list("axes", &mut self.axes);
    }
}

/// Triangles of a body in a report.
const TRIANGLES: usize = 6000;

impl RigidNote {
    pub fn of(form: &Form) -> RigidNote {
        let mut note = RigidNote::default();
        match form {
            Form::Ball(radius) => note.radius = *radius,
            Form::Plane(normal) => note.plane = Some(*normal),
            Form::Surface(surface) => {
                let surface = surface.coarser(TRIANGLES);
                note.corner = { surface.corner.iter() }
                    .map(|x| x.map(|c| c as f32))
                    .collect();
                note.face = surface.face;
            }
        }
        note
    }

    /// Where it is at a time, of which it has none yet.
    pub fn push(&mut self, time: f64, placed: &Placed) {
        if self.path.last().is_some_and(|p| p[0] >= time) {
            return;
        }
        let [x, y, z] = placed.center;
        self.path.push([time, x, y, z]);
        if self.radius == 0.0 {
            self.axes.push(placed.axes);
        }
    }
}

/// What is done to a body, in its reference configuration (lengths).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MarkNotes {
    /// Corners of cracks, one after the other.
    pub cracks: Vec<Vec<[f64; 3]>>,
    pub supports: Vec<MarkNote>,
    pub loads: Vec<MarkNote>,
}

/// A support or load at one place of its set.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MarkNote {
    pub at: [f64; 3],
    /// A vector of length 1; 0 of supports.
    pub toward: [f64; 3],
    pub says: String,
}

impl MarkNotes {
    /// Of what pictures mark.
    pub fn of(marks: &Marks, units: UnitSystem) -> MarkNotes {
        let note = |m: &Mark| {
            let held = m.size == 0.0;
            MarkNote {
                at: m.at,
                toward: m.toward.map(|c| if held { 0.0 } else { c / m.size }),
                says: match held {
                    true => format!("{} is held", m.set),
                    false => {
                        let size = units.show(m.size, m.dimension);
                        format!("{} of {}: {size} at most", m.what, m.set)
                    }
                },
            }
        };
        let (supports, loads, cracks) = marks.seen();
        MarkNotes {
            cracks: cracks.to_vec(),
            supports: supports.iter().map(note).collect(),
            loads: loads.iter().map(note).collect(),
        }
    }
}

/// Unit of a field, and what it is.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct FieldNote {
    pub name: String,
    pub unit: String,
    pub says: String,
}

/// How a run ended; `"done"`, `"ended"` (early, because someone asked for it) or `"stopped: why"`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Status {
    Done,
    Ended,
    Stopped(String),
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Status::Done => f.write_str("done"),
            Status::Ended => f.write_str("ended"),
            Status::Stopped(why) => write!(f, "stopped: {why}"),
        }
    }
}

impl Serialize for Status {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// The energy ledger with what its balance misses.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnergyReport {
    pub kinetic: f64,
    pub strain: f64,
    pub contact: f64,
    pub dissipated_by_breakage: f64,
    /// What points hold more without the bonds that broke.
    pub created_by_breakage: f64,
    pub dissipated: f64,
    /// Taken by an implicit method.
    pub numerical: f64,
    pub work_boundary_conditions: f64,
    pub work_rigid_bodies: f64,
    pub initial: f64,
    pub balance_error: f64,
}

impl From<&Ledger> for EnergyReport {
    fn from(l: &Ledger) -> Self {
        EnergyReport {
            kinetic: l.kinetic,
            strain: l.strain,
            contact: l.contact,
            dissipated_by_breakage: l.released,
            created_by_breakage: l.made,
            dissipated: l.dissipated,
            numerical: l.numerical,
            work_boundary_conditions: l.work_boundary_conditions,
            work_rigid_bodies: l.work_rigid_bodies,
            initial: l.initial,
            balance_error: l.residual(),
        }
    }
}

/// `state_hash` and `ledger_hash` in 16 hexadecimal digits each; `null`: there is none.
pub fn digits<S: Serializer>(hash: &StateHash, serializer: S) -> Result<S::Ok, S::Error> {
    let digits = |hash: u64| format!("{hash:016x}");
    let mut map = serializer.serialize_map(Some(2))?;
    map.serialize_entry("state_hash", &digits(hash.state))?;
    map.serialize_entry("ledger_hash", &hash.ledger.map(digits))?;
    map.end()
}

impl RunReport {
    /// How it ended, in a word or three.
    pub fn outcome(&self) -> String {
        match &self.ended_by {
            Some(signal) => format!("ended by {signal}"),
            None => self.status.to_string(),
        }
    }

    /// Writes the report, all or nothing.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        write_file(path, |w| {
            serde_json::to_writer_pretty(&mut *w, self)?;
            std::io::Write::write_all(w, b"\n")
        })
    }
}

/// Keys of `energy` that had another name in version 0.1: as they were, as they are.
const RENAMED: [(&str, &str); 5] = [
    ("released", "dissipated_by_breakage"),
    ("made", "created_by_breakage"),
    ("work_conditions", "work_boundary_conditions"),
    ("work_indenter", "work_rigid_bodies"),
    ("residual", "balance_error"),
];

/// A file of version 0.1 in the keys of today, with each bond once.
pub fn today(run: &mut Value) {
    if let Some(energy) = run.get_mut("energy").and_then(Value::as_object_mut) {
        for (old, new) in RENAMED {
            if let Some(value) = energy.remove(old) {
                energy.insert(new.into(), value);
            }
        }
    }
    let Some(run) = run.as_object_mut() else {
        return;
    };
    for (old, new) in [
        ("directed_bonds", "bonds"),
        ("broken_directed_bonds", "broken_bonds"),
    ] {
        if let Some(directed) = run.remove(old).as_ref().and_then(Value::as_u64) {
            run.insert(new.into(), each_once(directed).into());
        }
    }
}

/// `sha256:` and the SHA-256 of a deck in hexadecimal digits, as `sha256sum` prints it.
pub fn deck_hash(deck: &[u8]) -> String {
    let digits: Vec<String> = Sha256::digest(deck)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    format!("sha256:{}", digits.concat())
}

/// Wall time per directed bond and step (ns); `None` before there is one of each.
pub fn ns_per_bond_step(seconds: f64, directed_bonds: u64, steps: u64) -> Option<f64> {
    let visits = directed_bonds as f64 * steps as f64;
    (visits > 0.0).then(|| seconds * 1e9 / visits)
}

/// The most memory this process has held at once (bytes): the peak resident set, on Linux; `None` elsewhere.
pub fn peak_memory_bytes() -> Option<u64> {
    high_water_mark(&std::fs::read_to_string("/proc/self/status").ok()?)
}

/// `VmHWM:    1234 kB` of `/proc/self/status`, where kB are 1024 bytes.
fn high_water_mark(status: &str) -> Option<u64> {
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn report() -> RunReport {
        RunReport {
            version: "0.1.0".into(),
            deck: "impact.toml".into(),
            deck_hash: deck_hash(b"abc"),
            title: "impact".into(),
            status: Status::Done,
            ended_by: None,
            particles: 103_110,
            bonds: 5_004_900,
            steps: 2000,
            time_step: 1e-7,
            parts_of_a_step: 1,
            seconds_stepping: 10.5,
            seconds: Spent::default(),
            ns_per_bond_step: ns_per_bond_step(10.5, 10_009_800, 2000),
            peak_memory_bytes: None,
            broken_bonds: 6,
            fragments: Some(3),
            hash: StateHash {
                state: 0xab,
                ledger: None,
            },
            ranks: 1,
            threads: 2,
            simd: "avx512".into(),
            energy: EnergyReport::from(&Ledger {
                kinetic: 1.5,
                initial: 1.0,
                ..Ledger::default()
            }),
            pictures: vec!["damage.png".into()],
            warnings: vec!["a \"quoted\" warning".into()],
            setting: None,
        }
    }

    fn written(report: &RunReport) -> Value {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("run.json");
        report.write(&path).unwrap();
        serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
    }

    #[test]
    fn files_of_version_0_1_are_read_by_their_names_of_today() {
        let mut old = json!({"directed_bonds": 101, "broken_directed_bonds": 12,
            "energy": {"released": 1.0, "made": 2.0, "work_conditions": 3.0, "work_indenter": 4.0, "residual": 5.0, "kinetic": 6.0}});
        today(&mut old);
        let now = json!({"bonds": 51, "broken_bonds": 6,
            "energy": {"dissipated_by_breakage": 1.0, "created_by_breakage": 2.0, "work_boundary_conditions": 3.0, "work_rigid_bodies": 4.0,
                "balance_error": 5.0, "kinetic": 6.0}});
        assert_eq!(old, now);
        today(&mut old);
        assert_eq!(old, now);
    }

    #[test]
    fn all_keys_are_there() {
        let json = written(&report());
        for (key, value) in [
            ("version", json!("0.1.0")),
            ("particles", json!(103_110)),
            ("bonds", json!(5_004_900)),
            ("steps", json!(2000)),
            ("time_step", json!(1e-7)),
            ("seconds_stepping", json!(10.5)),
            ("ns_per_bond_step", json!(10.5e9 / 20_019_600_000.0)),
            ("peak_memory_bytes", Value::Null),
            ("broken_bonds", json!(6)),
            ("fragments", json!(3)),
            ("state_hash", json!("00000000000000ab")),
            ("ledger_hash", Value::Null),
            ("threads", json!(2)),
            ("simd", json!("avx512")),
            ("status", json!("done")),
            ("pictures", json!(["damage.png"])),
            ("warnings", json!(["a \"quoted\" warning"])),
        ] {
            assert_eq!(json[key], value, "{key}");
        }
        assert_eq!(json["energy"]["kinetic"], 1.5);
        assert_eq!(json["energy"]["balance_error"], 0.5);
    }

    #[test]
    fn a_run_gone_bad_still_reports() {
        let status = Status::Stopped("point 7 is not finite".into());
        let mut bad = RunReport { status, ..report() };
        bad.energy.kinetic = f64::NAN;
        let json = written(&bad);
        assert_eq!(json["status"], "stopped: point 7 is not finite");
        assert_eq!(json["energy"]["kinetic"], Value::Null);
    }

    #[test]
    fn what_took_time_is_told() {
        let spent = Spent {
            all: 9.5,
            fields: 4.0,
            pictures: 0.25,
            checkpoints: 0.0,
            report: 1.0,
            frames: 0.001,
            parts: vec![],
        };
        let text = "in all 9.50 s: steps 4.20 s, fields 4.00 s, pictures 0.25 s, report 1.00 s";
        assert_eq!(spent.told(4.2), text);
    }

    #[test]
    fn hash_is_sha256() {
        // FIPS 180-4, the one-block example
        let digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(deck_hash(b"abc"), format!("sha256:{digest}"));
    }

    #[test]
    fn no_rate_without_bonds() {
        assert_eq!(ns_per_bond_step(1.0, 0, 10), None);
        assert_eq!(ns_per_bond_step(1.0, 10, 0), None);
    }

    #[test]
    fn peak_memory_is_read_in_kibibytes() {
        let status = "Name:\tperidyne\nVmPeak:\t  9 kB\nVmHWM:\t  1234 kB\nVmRSS:\t  7 kB\n";
        assert_eq!(high_water_mark(status), Some(1_263_616));
        assert_eq!(high_water_mark("Name:\tx\n"), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn peak_memory_grows_with_what_is_held() {
        let held = std::hint::black_box(vec![1u8; 64 << 20]);
        assert!(peak_memory_bytes().unwrap() > held.len() as u64);
    }
}
