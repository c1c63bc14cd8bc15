//! Points with their frames, as a report shows them: read from the files of a run, held as codes.

use std::path::Path;

use super::quantise::Codes;
use crate::read::frames::Frames;
use crate::read::vtu::{self, Array, Frame};
use crate::read::{Atoms, ReadError};
use crate::write::fields::SIZE;
use crate::write::run_json::Setting;

/// Numbers that are held at once, of all points, components and frames.
const NUMBERS: usize = 48_000_000;
/// Frames of a small body.
const FRAMES: usize = 201;
/// Points further away than so many sizes of the body are not shown: they would leave no bits to the others.
const FAR: f64 = 4.0;

/// A field in all frames.
#[derive(Debug)]
pub struct Field {
    pub name: String,
    pub unit: String,
    pub says: String,
    /// "scalar", "integer", "vector", "symmetric", "tensor"
    pub kind: &'static str,
    pub components: Vec<String>,
    /// What whole numbers are called.
    pub names: Vec<String>,
    pub frames: Vec<Codes>,
}

impl Field {
    /// The number that all points have in all frames, if it is one.
    pub fn constant(&self) -> Option<f64> {
        let mut all = self.frames.iter().flat_map(|f| &f.seen);
        let first = all.next()?[0];
        let same = |s: &[f64; 2]| s[0] == first && s[1] == first;
        self.frames
            .iter()
            .all(|f| f.seen.iter().all(same))
            .then_some(first)
    }
}

/// What is shown in 3-D, or along a line.
#[derive(Debug)]
pub struct Scene {
    /// "run", "modes", "law"
    pub kind: &'static str,
    pub dimension: usize,
    pub points: usize,
    /// Typical distance of points (length).
    pub spacing: f64,
    pub atoms: bool,
    /// Have frames a step and no time?
    pub stepped: bool,
    /// Step and time (of modes: number and frequency) of each frame.
    pub frames: Vec<(u64, f64)>,
    pub reference: Codes,
    pub moved: Vec<Codes>,
    pub fields: Vec<Field>,
    /// What is not as in the files, in sentences.
    pub notes: Vec<String>,
}

/// A frame as it is read; its arrays one after the other.
pub struct Look<'a> {
    pub step: u64,
    pub value: f64,
    /// Three numbers for each point.
    pub position: Vec<f64>,
    /// `None`: since the first frame.
    pub displacement: Option<Vec<f64>>,
    pub arrays: Box<dyn Iterator<Item = Result<Values, ReadError>> + 'a>,
}

/// Values of a field over the points of a frame.
pub struct Values {
    pub name: String,
    pub components: Vec<String>,
    pub kind: &'static str,
    pub names: Vec<String>,
    pub numbers: Vec<f64>,
}

impl Values {
    pub fn new(name: &str, kind: &'static str, numbers: Vec<f64>) -> Values {
        let components: &[&str] = match kind {
            "vector" => &["x", "y", "z"],
            "symmetric" => &["xx", "yy", "zz", "xy", "yz", "xz"],
            "tensor" => &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
            _ => &[""],
        };
        Values {
            name: name.into(),
            components: components.iter().map(|c| (*c).into()).collect(),
            kind,
            names: vec![],
            numbers,
        }
    }
}

/// Collects frames.
pub struct Maker {
    scene: Scene,
    /// Reference positions, three numbers for each point.
    reference: Vec<f64>,
    far: f64,
    lost: usize,
}

impl Maker {
    pub fn new(kind: &'static str, setting: &Setting) -> Maker {
        Maker {
            scene: Scene {
                kind,
                dimension: setting.dimension,
                points: 0,
                spacing: setting.spacing,
                atoms: setting.atoms,
                stepped: false,
                frames: vec![],
                reference: Codes::of(&[], 3, false),
                moved: vec![],
                fields: vec![],
                notes: vec![],
            },
            reference: vec![],
            far: f64::INFINITY,
            lost: 0,
        }
    }

    /// Adds a frame; one of another number of points than the first is passed over.
    ///
    /// # Errors
    /// An array cannot be read.
    pub fn push(&mut self, look: Look, setting: &Setting) -> Result<(), ReadError> {
        let scene = &mut self.scene;
        if scene.frames.is_empty() {
            self.reference = match &look.displacement {
                Some(u) => look.position.iter().zip(u).map(|(x, u)| x - u).collect(),
                None => look.position.clone(),
            };
            scene.points = self.reference.len() / 3;
            scene.reference = Codes::of(&self.reference, 3, false);
            let extent = scene.reference.seen.iter().map(|s| s[1] - s[0]);
            let extent: Vec<f64> = extent.collect();
            if scene.dimension == 0 {
                scene.dimension = extent.iter().filter(|e| **e > 0.0).count().max(1);
            }
            if !(scene.spacing > 0.0) {
                scene.spacing = spacing(&extent[..scene.dimension], scene.points);
            }
            let diagonal = extent.iter().map(|e| e * e).sum::<f64>().sqrt();
            if scene.kind == "run" {
                self.far = FAR * diagonal.max(scene.spacing);
            }
        }
        if look.position.len() != self.reference.len() {
            return Ok(());
        }
        let moved = look.displacement.unwrap_or_else(|| {
            let each = look.position.iter().zip(&self.reference);
            each.map(|(x, r)| x - r).collect()
        });
        let (far, mut lost) = (self.far, 0);
        let moved = moved.chunks_exact(3).flat_map(|u| {
            let near = u.iter().all(|c| c.abs() <= far);
            lost += usize::from(!near);
            std::array::from_fn::<f64, 3, _>(|a| if near { u[a] } else { f64::NAN })
        });
        let moved: Vec<f64> = moved.collect();
        self.lost = self.lost.max(lost);
        let scene = &mut self.scene;
        scene.moved.push(Codes::of(&moved, 3, false));
        let number = scene.frames.len();
        scene.frames.push((look.step, look.value));
        for values in look.arrays {
            let values = values?;
            let count = values.components.len();
            if values.numbers.len() != scene.points * count {
                continue;
            }
            let known = scene.fields.iter().position(|f| f.name == values.name);
            let at = known.unwrap_or_else(|| {
                let note = setting.fields.iter().find(|f| f.name == values.name);
                scene.fields.push(Field {
                    unit: note.map_or(String::new(), |n| n.unit.clone()),
                    says: note.map_or(String::new(), |n| n.says.clone()),
                    name: values.name,
                    kind: values.kind,
                    components: values.components,
                    names: values.names,
                    frames: vec![],
                });
                scene.fields.len() - 1
            });
            let field = &mut scene.fields[at];
            let whole = field.kind == "integer";
            // a field that comes later is not there before
            if field.frames.len() == number {
                field.frames.push(Codes::of(&values.numbers, count, whole));
            }
        }
        Ok(())
    }

    pub fn made(mut self) -> Option<Scene> {
        let count = self.scene.frames.len();
        self.scene.fields.retain(|f| f.frames.len() == count);
        if self.lost > 0 {
            let noun = if self.lost == 1 { "point" } else { "points" };
            self.scene.notes.push(format!(
                "{} {noun} further than {FAR} sizes of the body from where they began are not drawn.",
                self.lost
            ));
        }
        (count > 0 && self.scene.points > 0).then_some(self.scene)
    }
}

/// Typical distance of points that fill a box.
fn spacing(extent: &[f64], points: usize) -> f64 {
    let d = extent.len() as f64;
    let volume: f64 = extent.iter().filter(|e| **e > 0.0).product();
    let mean = libm::pow(volume / points.max(1) as f64, 1.0 / d);
    if mean > 0.0 && mean.is_finite() {
        mean
    } else {
        1.0
    }
}

/// Numbers of those frames that are read, first and last among them.
fn chosen(total: usize, numbers: usize) -> Vec<usize> {
    let most = (NUMBERS / numbers.max(1)).clamp(3, FRAMES).min(total);
    if most < 2 {
        return (0..total).collect();
    }
    (0..most)
        .map(|k| (k * (total - 1) + (most - 1) / 2) / (most - 1))
        .collect()
}

fn fewer(taken: usize, total: usize) -> Option<String> {
    (taken < total).then(|| format!("{taken} of the {total} frames are shown."))
}

/// Frames of a collection of VTU files.
///
/// # Errors
/// A file that is listed cannot be read.
pub fn of_collection(
    dir: &Path,
    name: &str,
    kind: &'static str,
    setting: &Setting,
) -> Result<Option<Scene>, ReadError> {
    let path = dir.join(name);
    let folder = path.parent().unwrap_or(dir).to_path_buf();
    let entries = vtu::collection(&path)?;
    let Some((_, first)) = entries.first() else {
        return Ok(None);
    };
    let first = Frame::open(&folder.join(first))?;
    let shown = |a: &&Array| is_shown(&a.name, setting);
    let width: usize = { first.arrays.iter().filter(shown) }
        .map(|a| a.components)
        .sum();
    let numbers = chosen(entries.len(), width * first.points);
    let mut maker = Maker::new(kind, setting);
    for n in &numbers {
        let path = folder.join(&entries[*n].1);
        let frame = Frame::open(&path)?;
        maker.push(look(&frame, (&path, entries[*n].0), setting)?, setting)?;
    }
    let mut scene = maker.made();
    if let Some(scene) = &mut scene {
        scene.notes.extend(fewer(numbers.len(), entries.len()));
    }
    Ok(scene)
}

/// Is an array of a file a field to look at? How large points are is in all files, and one of those that were asked for.
fn is_shown(name: &str, setting: &Setting) -> bool {
    name != SIZE || setting.fields.iter().any(|f| f.name == name)
}

fn look<'a>(
    frame: &'a Frame,
    (path, value): (&'a Path, f64),
    setting: &'a Setting,
) -> Result<Look<'a>, ReadError> {
    let read = move |array: &Array| {
        let numbers = frame.numbers(array);
        numbers.map_err(|e| ReadError::file(path, e.to_string()))
    };
    let all = |name: &str| frame.array(name).map(read).transpose();
    let hidden = ["position", "displacement", "id"];
    let shown = frame
        .arrays
        .iter()
        .filter(move |a| !hidden.contains(&&*a.name) && is_shown(&a.name, setting));
    let position = all("position")?.unwrap_or_default();
    let displacement = all("displacement")?;
    let arrays = shown.map(move |a| {
        let kind = match (a.components, a.kind.is_whole()) {
            (1, true) => "integer",
            (3, _) => "vector",
            (6, _) => "symmetric",
            (9, _) => "tensor",
            _ => "scalar",
        };
        let mut values = Values::new(&a.name, kind, read(a)?);
        if a.names.len() == a.components && a.components > 1 {
            values.components = a.names.clone();
        }
        Ok(values)
    });
    Ok(Look {
        step: frame.step,
        value,
        position,
        displacement,
        arrays: Box::new(arrays),
    })
}

/// Frames of a trajectory of atoms.
///
/// # Errors
/// File and line of the first mistake.
pub fn of_trajectory(path: &Path, setting: &Setting) -> Result<Option<Scene>, ReadError> {
    let total = Frames::count(path)?;
    let mut frames = Frames::open(path)?;
    let mut maker = Maker::new("run", setting);
    let mut numbers = vec![];
    let mut at = 0;
    while let Some(atoms) = frames.next_frame()? {
        if at == 0 {
            numbers = chosen(total, 12 * atoms.len());
        }
        if numbers.binary_search(&at).is_ok() {
            maker.push(of_atoms(atoms, at), setting)?;
        }
        at += 1;
    }
    let mut scene = maker.made();
    if let Some(scene) = &mut scene {
        scene.notes.extend(fewer(numbers.len(), total));
    }
    Ok(scene)
}

/// Frames of the dumps that a script wrote, several files one after the other; `clock`: steps and their times. Files without atoms are
/// passed over.
///
/// # Errors
/// File and line of the first mistake, where no frame could be read.
pub fn of_dumps(
    dir: &Path,
    setting: &Setting,
    clock: &[(u64, f64)],
) -> Result<Option<Scene>, ReadError> {
    let mut wrong = None;
    let mut files = vec![];
    for name in &setting.dumps {
        let path = dir.join(name);
        match Frames::count(&path) {
            Ok(n) => files.push((path, n)),
            Err(e) => wrong = Some(e),
        }
    }
    let total: usize = files.iter().map(|f| f.1).sum();
    let mut maker = Maker::new("run", setting);
    maker.scene.stepped = clock.is_empty();
    let (mut at, mut numbers) = (0, None);
    let mut last = None;
    for (path, count) in files {
        let mut frames = match Frames::open(&path) {
            Ok(frames) => frames,
            Err(e) => {
                wrong = Some(e);
                continue;
            }
        };
        for _ in 0..count {
            let atoms = match frames.next_frame() {
                Ok(Some(atoms)) => atoms,
                Ok(None) => break,
                Err(e) => {
                    wrong = Some(e);
                    break;
                }
            };
            let width = 12 + atoms.columns.len();
            let numbers = numbers.get_or_insert_with(|| chosen(total, width * atoms.len()));
            // two dumps may have the same steps: those of the first count
            let later = last.is_none_or(|l| atoms.step > Some(l));
            if numbers.binary_search(&at).is_ok() && later {
                last = atoms.step;
                let mut look = of_atoms(atoms, at);
                if !clock.is_empty() {
                    look.value = time_of(look.step, clock);
                }
                look.arrays = Box::new(look.arrays.map(|values| {
                    let mut values = values?;
                    let known = setting.columns.iter().find(|c| c.0 == values.name);
                    if let Some((_, name)) = known {
                        values.name = name.clone();
                    }
                    Ok(values)
                }));
                maker.push(look, setting)?;
            }
            at += 1;
        }
    }
    let mut scene = maker.made();
    if let Some(scene) = &mut scene {
        scene.notes.extend(fewer(scene.frames.len(), total));
    }
    match (scene, wrong) {
        (None, Some(e)) => Err(e),
        (scene, _) => Ok(scene),
    }
}

/// The time of a step between or beyond those of a clock.
fn time_of(step: u64, clock: &[(u64, f64)]) -> f64 {
    let after = clock.iter().position(|c| c.0 >= step);
    let [a, b] = match after {
        Some(0) if clock[0].0 == step => return clock[0].1,
        Some(n) if n > 0 => [clock[n - 1], clock[n]],
        _ if clock.len() > 1 && after.is_none() => [clock[clock.len() - 2], clock[clock.len() - 1]],
        _ if clock.len() > 1 => [clock[0], clock[1]],
        _ => return clock[0].1,
    };
    if b.0 == a.0 {
        return a.1;
    }
    a.1 + (step as f64 - a.0 as f64) / (b.0 as f64 - a.0 as f64) * (b.1 - a.1)
}

fn of_atoms(atoms: Atoms, number: usize) -> Look<'static> {
    let mut arrays: Vec<Values> = { atoms.columns.iter() }
        .map(|(name, values)| Values::new(name, "scalar", values.clone()))
        .collect();
    if atoms.species.len() > 1 {
        let kinds = atoms.kind.iter().map(|k| f64::from(*k)).collect();
        let mut kinds = Values::new("kind", "integer", kinds);
        kinds.names = atoms.species.iter().map(|s| s.name.clone()).collect();
        arrays.push(kinds);
    }
    let vectors = [("velocity", &atoms.velocity), ("force", &atoms.force)];
    for (name, values) in vectors {
        if let Some(values) = values {
            arrays.push(Values::new(name, "vector", values.concat()));
        }
    }
    if let Some(energy) = atoms.energy {
        arrays.push(Values::new("energy", "scalar", energy));
    }
    Look {
        step: atoms.step.unwrap_or(number as u64),
        value: atoms
            .time
            .or(atoms.step.map(|s| s as f64))
            .unwrap_or(number as f64),
        position: atoms.position.concat(),
        displacement: None,
        arrays: Box::new(arrays.into_iter().map(Ok)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_have_the_times_of_the_clock() {
        let clock = [(0, 0.0), (10, 1.0), (20, 1.5)];
        for (step, time) in [(0, 0.0), (5, 0.5), (10, 1.0), (15, 1.25), (30, 2.0)] {
            assert_eq!(time_of(step, &clock), time, "{step}");
        }
        assert_eq!(time_of(7, &[(10, 1.0), (20, 2.0)]), 0.7);
        assert_eq!(time_of(7, &[(10, 1.0)]), 1.0);
    }
}
