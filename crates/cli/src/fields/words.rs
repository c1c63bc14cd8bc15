//! What a user says: flags, or a file with the same keys.

use crate::failure::Failure;
use peridyne_io::read::text_of;
use peridyne_io::write::folder::is_inside;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Continuum fields from particles: densities, stress (tension positive), heat flux, with the residuals of their balance laws.
///
/// With the distance r from a point and the width S, a particle counts as
///   polynomial  c (1 - r^2/S^2)^n for r < S, n = --smoothness (3 if not given)
///   bspline     c [(2 - q)^3 - 4 max(1 - q, 0)^3], q = 2 r/S < 2
///   quartic     c [(5/2 - q)^4 - 5 max(3/2 - q, 0)^4 + 10 max(1/2 - q, 0)^4], q = 5 r/(2 S) < 5/2
///   gaussian    c exp(-r^2/(2 S^2)) for r < 8 S
///   step        c for r < S
///   cell        c in a cube of edge S
/// with c so that the integral over space is 1.
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct FieldsArguments {
    /// File (.toml) whose keys are the flags below, without their dashes; paths are relative to it.
    pub deck: Option<PathBuf>,
    /// Frames: extended XYZ, LAMMPS dump or data file, each also packed (.gz). Fields are means over all frames.
    #[arg(long, value_name = "FILE")]
    pub frames: Option<PathBuf>,
    /// A potential that `peridyne laws` lists; setfl or funcfl with --file.
    #[arg(long, value_name = "NAME")]
    pub potential: Option<String>,
    /// A constant of the potential by the name it has in decks, e.g. `--with epsilon=1 --with cutoff=2.5`; may be repeated.
    #[arg(long, value_name = "KEY=VALUE", value_parser = crate::pair)]
    pub with: Vec<(String, String)>,
    /// File of the potential; of several funcfl files, an element each, repeat it.
    #[arg(long, value_name = "FILE")]
    pub file: Vec<String>,
    /// Elements of the file, in the order of the types of the frames, e.g. `Ni,Al`; species with names are found by them.
    #[arg(long, value_name = "NAME,…")]
    pub element: Option<String>,
    /// Instead of --potential: the potentials between the materials of a deck, with `mixing`, `[[pair]]`, masses, molecules, units. Nothing
    /// but `units` and `[material.NAME]` is needed of it; species are materials by name, element or order of types.
    #[arg(long, value_name = "DECK", conflicts_with_all = ["potential", "with", "file", "element"])]
    pub model: Option<PathBuf>,
    /// LAMMPS data file with bonds, angles, dihedrals and their coefficients, of atoms in order of their ids.
    #[arg(long, value_name = "FILE")]
    pub molecules: Option<PathBuf>,
    /// What is left of the potential between atoms that are one, two and three bonds apart, e.g. `0,0,0.5`.
    #[arg(long, value_name = "A,B,C", requires = "molecules")]
    pub special: Option<String>,
    /// Mass of a species or type, e.g. `--mass Cu=63.546` or `--mass 1=2`; may be repeated.
    #[arg(long, value_name = "NAME=MASS", value_parser = crate::pair)]
    pub mass: Vec<(String, String)>,
    /// Of frames and potential: metal (Å, ps, eV, g/mol), real (Å, fs, kcal/mol, g/mol), lj, si or none (any consistent units).
    #[arg(long, value_name = "UNITS")]
    pub units: Option<String>,
    /// polynomial, bspline, quartic, gaussian, step or cell: see above.
    #[arg(long, value_name = "NAME")]
    pub kernel: Option<String>,
    /// S (in the frames' unit of length).
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub width: Option<f64>,
    /// n of the polynomial, 0 to 7: n - 1 derivatives are continuous.
    #[arg(long, value_name = "N")]
    pub smoothness: Option<u32>,
    /// Average over these axes of the box, e.g. `yz` for a profile along x.
    #[arg(long, value_name = "AXES")]
    pub average: Option<String>,
    /// Fields at the centres of so many equal pieces of the box.
    #[arg(long, value_name = "NX,NY,NZ")]
    pub grid: Option<String>,
    /// Fields at the points of this file: x y z in each row, by blanks or commas.
    #[arg(long, value_name = "FILE")]
    pub points: Option<PathBuf>,
    /// Fields at N points from A to B, both included, e.g. `--line 0,0,5 20,0,5 101`.
    #[arg(long, num_args = 3, value_names = ["A", "B", "N"], allow_hyphen_values = true)]
    pub line: Option<Vec<String>>,
    /// Fields at N,M points of the parallelogram at a corner A with the edges E and F, borders included, e.g. `--plane 0,0,5 20,0,0 0,20,0
    /// 41,41`.
    #[arg(long, num_args = 4, value_names = ["A", "E", "F", "N,M"], allow_hyphen_values = true)]
    pub plane: Option<Vec<String>>,
    /// Also the pressure, minus a third of the trace of the Cauchy stress.
    #[arg(long)]
    pub pressure: bool,
    /// Also the material coordinate y (where the mass at a point is centred), its flux, and the angular momentum ρ y × v.
    #[arg(long)]
    pub coordinate: bool,
    /// Whose a term's energy is: site (its centre's), equal (in equal parts its atoms'), or centre:W (W its centre's).
    #[arg(long, value_name = "NAME")]
    pub partition: Option<String>,
    /// Pair forces: distances (central, symmetric stress) or differences (from the centre's star).
    #[arg(long, value_name = "NAME")]
    pub pair_force: Option<String>,
    /// Keep the parts of the potential apart.
    #[arg(long)]
    pub parts: bool,
    /// Also write the fields of each frame.
    #[arg(long)]
    pub each: bool,
    /// Frames to pass over first.
    #[arg(long, value_name = "N")]
    pub skip: Option<usize>,
    /// Then take every so many.
    #[arg(long, value_name = "N")]
    pub every: Option<usize>,
    /// Points at which the residuals of the balance laws are measured, 16 if not given.
    #[arg(long, value_name = "N")]
    pub residuals: Option<usize>,
    /// Folder for the results.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Let the file of keys write outside its own folder.
    #[arg(long)]
    pub allow_outside: bool,
    /// Threads; all cores if not given. Results do not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
}

/// A number or a word of a file.
#[derive(Deserialize, JsonSchema, Clone)]
#[serde(untagged)]
enum Scalar {
    Number(f64),
    Whole(i64),
    Flag(bool),
    Word(String),
}

impl Scalar {
    fn text(&self) -> String {
        match self {
            Scalar::Number(x) => format!("{x:?}"),
            Scalar::Whole(n) => n.to_string(),
            Scalar::Flag(b) => b.to_string(),
            Scalar::Word(w) => w.clone(),
        }
    }
}

/// A word, or a list of them.
#[derive(Deserialize, JsonSchema, Clone)]
#[serde(untagged)]
enum OneOrMore {
    One(String),
    More(Vec<String>),
}

impl Default for OneOrMore {
    fn default() -> OneOrMore {
        OneOrMore::More(vec![])
    }
}

impl OneOrMore {
    fn all(&self) -> &[String] {
        match self {
            OneOrMore::One(one) => std::slice::from_ref(one),
            OneOrMore::More(all) => all,
        }
    }
}

/// A list of so many: lists that are longer are not cut.
fn exactly<'de, D, T, const N: usize>(reader: D) -> Result<[T; N], D::Error>
where
    D: serde::Deserializer<'de>,
    T: Deserialize<'de>,
{
    let all = Vec::<T>::deserialize(reader)?;
    let count = all.len();
    all.try_into()
        .map_err(|_| serde::de::Error::custom(format!("expected a list of {N}, not of {count}")))
}

fn three<'de, D, T>(reader: D) -> Result<Option<[T; 3]>, D::Error>
where
    D: serde::Deserializer<'de>,
    T: Deserialize<'de>,
{
    exactly(reader).map(Some)
}

/// Points on a line.
#[derive(Deserialize, JsonSchema, Clone)]
#[serde(deny_unknown_fields)]
struct LineKeys {
    #[serde(deserialize_with = "exactly")]
    from: [f64; 3],
    #[serde(deserialize_with = "exactly")]
    to: [f64; 3],
    points: usize,
}

/// Points on a parallelogram.
#[derive(Deserialize, JsonSchema, Clone)]
#[serde(deny_unknown_fields)]
struct PlaneKeys {
    #[serde(deserialize_with = "exactly")]
    corner: [f64; 3],
    #[serde(deserialize_with = "exactly")]
    edges: [[f64; 3]; 2],
    #[serde(deserialize_with = "exactly")]
    points: [usize; 2],
}

/// As flags have it.
fn listed(x: &[f64]) -> String {
    let all: Vec<String> = x.iter().map(|c| format!("{c:?}")).collect();
    all.join(",")
}

/// A file of `peridyne fields`: its flags as keys, without their dashes; paths are relative to it.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields, default)]
struct Keys {
    frames: Option<PathBuf>,
    potential: Option<String>,
    with: BTreeMap<String, Scalar>,
    file: OneOrMore,
    element: OneOrMore,
    model: Option<PathBuf>,
    molecules: Option<PathBuf>,
    #[serde(deserialize_with = "three")]
    special: Option<[f64; 3]>,
    mass: BTreeMap<String, f64>,
    units: Option<String>,
    kernel: Option<String>,
    width: Option<f64>,
    smoothness: Option<u32>,
    average: Option<String>,
    #[serde(deserialize_with = "three")]
    grid: Option<[usize; 3]>,
    points: Option<PathBuf>,
    line: Option<LineKeys>,
    plane: Option<PlaneKeys>,
    pressure: bool,
    coordinate: bool,
    partition: Option<String>,
    pair_force: Option<String>,
    parts: bool,
    each: bool,
    skip: usize,
    every: Option<usize>,
    residuals: Option<usize>,
    out: Option<PathBuf>,
    threads: Option<usize>,
}

/// JSON schema (2020-12) of a file: its form.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Keys).to_value()
}

/// All that was said, flags before keys of a file.
#[derive(Default)]
pub struct Words {
    pub frames: Option<PathBuf>,
    pub potential: Option<String>,
    pub with: Vec<(String, String)>,
    pub files: Vec<String>,
    pub elements: Vec<String>,
    pub model: Option<PathBuf>,
    pub molecules: Option<PathBuf>,
    pub special: Option<String>,
    pub mass: Vec<(String, String)>,
    pub units: Option<String>,
    pub kernel: Option<String>,
    pub width: Option<f64>,
    pub smoothness: Option<u32>,
    pub average: Option<String>,
    pub grid: Option<String>,
    pub points: Option<PathBuf>,
    pub line: Option<Vec<String>>,
    pub plane: Option<Vec<String>>,
    pub pressure: bool,
    pub coordinate: bool,
    pub partition: Option<String>,
    pub pair_force: Option<String>,
    pub parts: bool,
    pub each: bool,
    pub skip: usize,
    pub every: usize,
    pub residuals: usize,
    pub out: Option<PathBuf>,
    pub threads: Option<usize>,
}

impl FieldsArguments {
    /// Flags, and what a file says besides.
    pub fn words(&self) -> Result<Words, Failure> {
        let keys = match &self.deck {
            Some(path) => read(path)?,
            None => Keys::default(),
        };
        if let (Some(deck), Some(out), None) = (&self.deck, &keys.out, &self.out)
            && !self.allow_outside
        {
            let folder = deck.parent().unwrap_or(Path::new(""));
            if !is_inside(folder, &out.join("file")) {
                return Err(Failure::input(format!(
                    "{}: out = {:?} leads out of its folder: give a name without `..` that does not begin with `/` and is no link; --out says a folder, --allow-outside lets the file do so",
                    deck.display(),
                    out.display().to_string(),
                )));
            }
        }
        let joined = |name: &str| {
            let of = |d: &PathBuf| d.parent().unwrap_or(Path::new("")).join(name);
            self.deck.as_ref().map_or_else(|| PathBuf::from(name), of)
        };
        let path = |own: &Option<PathBuf>, key: &Option<PathBuf>| {
            let key = key.as_ref().map(|k| joined(&k.to_string_lossy()));
            own.clone().or(key)
        };
        // flags come last and win
        let mut with: Vec<(String, String)> = keys
            .with
            .iter()
            .map(|(k, v)| (k.clone(), v.text()))
            .collect();
        with.retain(|(k, _)| self.with.iter().all(|(own, _)| own != k));
        with.extend(self.with.clone());
        let mut mass: Vec<(String, String)> = keys
            .mass
            .iter()
            .map(|(k, v)| (k.clone(), format!("{v:?}")))
            .collect();
        mass.retain(|(k, _)| self.mass.iter().all(|(own, _)| own != k));
        mass.extend(self.mass.clone());
        let grid = keys.grid.map(|[x, y, z]| format!("{x},{y},{z}"));
        let line = keys.line.map(|l| {
            let ends = [l.from, l.to].map(|x| listed(&x));
            [&ends[..], &[l.points.to_string()]].concat()
        });
        let plane = keys.plane.map(|p| {
            let [n, m] = p.points;
            let sides = [p.corner, p.edges[0], p.edges[1]].map(|x| listed(&x));
            [&sides[..], &[format!("{n},{m}")]].concat()
        });
        // a flag that says where takes the place of all keys that do
        let flags = [
            self.grid.is_some(),
            self.points.is_some(),
            self.line.is_some(),
            self.plane.is_some(),
        ];
        let own = flags.contains(&true);
        let grid = self.grid.clone().or(grid.filter(|_| !own));
        let points = match own {
            true => self.points.clone(),
            false => path(&None, &keys.points),
        };
        let line = self.line.clone().or(line.filter(|_| !own));
        let plane = self.plane.clone().or(plane.filter(|_| !own));
        let of_keys = keys.file.all().iter();
        let of_keys = of_keys.map(|f| joined(f).to_string_lossy().into_owned());
        let files = match self.file.is_empty() {
            true => of_keys.collect(),
            false => self.file.clone(),
        };
        let listed = |names: &str| names.split(',').map(|n| n.trim().to_string()).collect();
        let elements = match &self.element {
            Some(names) => listed(names),
            None => keys
                .element
                .all()
                .iter()
                .flat_map(|n| -> Vec<String> { listed(n) })
                .collect(),
        };
        Ok(Words {
            frames: path(&self.frames, &keys.frames),
            potential: self.potential.clone().or(keys.potential),
            with,
            files,
            elements,
            model: path(&self.model, &keys.model),
            molecules: path(&self.molecules, &keys.molecules),
            special: self
                .special
                .clone()
                .or(keys.special.map(|[a, b, c]| format!("{a:?},{b:?},{c:?}"))),
            mass,
            units: self.units.clone().or(keys.units),
            kernel: self.kernel.clone().or(keys.kernel),
            width: self.width.or(keys.width),
            smoothness: self.smoothness.or(keys.smoothness),
            average: self.average.clone().or(keys.average),
            grid,
            points,
            line,
            plane,
            pressure: self.pressure || keys.pressure,
            coordinate: self.coordinate || keys.coordinate,
            partition: self.partition.clone().or(keys.partition),
            pair_force: self.pair_force.clone().or(keys.pair_force),
            parts: self.parts || keys.parts,
            each: self.each || keys.each,
            skip: self.skip.unwrap_or(keys.skip),
            every: self.every.or(keys.every).unwrap_or(1),
            residuals: self.residuals.or(keys.residuals).unwrap_or(16),
            out: path(&self.out, &keys.out),
            threads: self.threads.or(keys.threads),
        })
    }
}

fn read(path: &Path) -> Result<Keys, Failure> {
    let (text, name) = text_of(path).map_err(|e| Failure::input(e.to_string()))?;
    toml::from_str(&text).map_err(|e| {
        let line = e
            .span()
            .map(|s| 1 + text[..s.start.min(text.len())].matches('\n').count());
        let place = line.map_or(String::new(), |l| format!(":{l}"));
        Failure::input(format!("{name}{place}: {}", e.message()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    const GOOD: &str = r#"
frames = "run.lammpstrj.gz"
potential = "lj"
with = { epsilon = 0.25, cutoff = 8.5, end = "smooth", shift = true }
file = ["a.eam", "b.eam"]
element = "Ni,Al"
special = [0.5, 0.5, 0.5]
mass = { Cu = 63.5 }
units = "metal"
kernel = "gaussian"
width = 2.5
smoothness = 3
average = "yz"
grid = [20, 1, 1]
line = { from = [0.5, 0.5, 0.5], to = [1.5, 1.5, 1.5], points = 7 }
plane = { corner = [0.5, 0.5, 0.5], edges = [[1.5, 0.5, 0.5], [0.5, 1.5, 0.5]], points = [3, 4] }
pressure = true
coordinate = true
skip = 1
every = 2
out = "out/x"
"#;

    /// What the reader takes of form passes, and nothing else does.
    #[test]
    fn files_pass_and_faults_of_form_do_not() {
        let validator = jsonschema::validator_for(&schema()).unwrap();
        let good: Value = toml::from_str(GOOD).unwrap();
        let error = validator.iter_errors(&good).next().map(|e| e.to_string());
        assert_eq!(error, None);
        let table = good.as_object().unwrap();
        let (mut refused, mut taken) = (0, 0);
        let mut see = |fault: &Value| {
            let text = toml::to_string(fault).unwrap();
            let read = toml::from_str::<Keys>(&text).is_ok();
            assert_eq!(read, validator.is_valid(fault), "{fault}");
            refused += usize::from(!read);
            taken += usize::from(read);
        };
        let faults = [
            json!(true),
            json!(-1),
            json!(1.5),
            json!("zzz"),
            json!(["zzz"]),
            json!([0.5, 0.5]),
            json!([1, 2, 3, 4]),
            json!({ "zzz": 1 }),
            json!([[true]]),
        ];
        for key in table.keys().map(String::as_str).chain(["zzz"]) {
            for fault in &faults {
                let mut other = table.clone();
                other.insert(key.into(), fault.clone());
                see(&Value::Object(other));
            }
            let mut less = table.clone();
            less.remove(key);
            see(&Value::Object(less));
        }
        for (table_of, key) in [("line", "from"), ("line", "points"), ("plane", "edges")] {
            let mut other = good.clone();
            other[table_of].as_object_mut().unwrap().remove(key);
            see(&other);
            other[table_of]["zzz"] = json!(1);
            see(&other);
        }
        assert!(refused > 100 && taken > 20, "{refused} {taken}");
    }
}
