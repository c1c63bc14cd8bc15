//! As much of a scene as fits into a report: bits, frames and points are given up in this order, and said.

use std::borrow::Cow;
use std::io;
use std::iter;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::{Value, json};

use super::quantise::{Codes, FINE};
use super::scene::Scene;
use super::short;

/// What one block costs besides its bytes in base 64: its tag, and its line of numbers.
const TAG: usize = 220;

/// How much is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rung {
    /// Bits of displacements.
    moved: u8,
    /// Bits of values.
    values: u8,
    frames: usize,
    /// Of so many points one.
    stride: usize,
}

/// From all there is down.
fn rungs(frames: usize) -> impl Iterator<Item = Rung> {
    let fine = [(FINE, FINE), (FINE, 8), (14, 8), (13, 7), (12, 6)];
    let of = |(moved, values), frames, stride| Rung {
        moved,
        values,
        frames,
        stride,
    };
    let few = (3..).map(move |k| (2 * frames).div_ceil(k));
    let few = few.take_while(|f| *f >= 5);
    let least = frames.min(5);
    fine.into_iter()
        .map(move |bits| of(bits, frames, 1))
        .chain(few.map(move |f| of((12, 6), f, 1)))
        .chain((1..16).map(move |k| of((12, 6), least, 1 << k)))
}

/// A scene as it stands in a report.
pub struct Packed {
    pub scene: Value,
    pub blocks: Vec<Vec<u8>>,
}

/// Packs a scene into about `room` bytes of the file; its blocks are numbered from `first`.
///
/// # Errors
/// None in practice: it is written to memory.
pub fn pack(scene: &Scene, room: usize, first: usize, told: Value) -> io::Result<Packed> {
    let all = scene.frames.len();
    let own = Rows::own(scene);
    let mut shared = None;
    let mut last = None;
    for rung in rungs(all) {
        let rows = match rung.moved {
            FINE => &own,
            _ => shared.get_or_insert_with(|| Rows::shared(scene)),
        };
        let keep = kept(scene.points, rung.stride);
        if estimate(scene, rows, rung, &keep)? > room {
            last = Some(rung);
            continue;
        }
        let packed = packed(scene, rows, rung, &keep, first, &told)?;
        if cost(&packed.blocks) <= room {
            return Ok(packed);
        }
        last = Some(rung);
    }
    // the least there is
    let rung = last.unwrap_or(Rung {
        moved: FINE,
        values: FINE,
        frames: all,
        stride: 1,
    });
    packed(
        scene,
        &own,
        rung,
        &kept(scene.points, rung.stride),
        first,
        &told,
    )
}

/// The codes of all frames: displacements, then the fields; and do they share their bounds?
struct Rows<'a>(Vec<(Cow<'a, [Codes]>, bool)>);

impl<'a> Rows<'a> {
    fn own(scene: &'a Scene) -> Rows<'a> {
        let all = iter::once(&scene.moved).chain(scene.fields.iter().map(|f| &f.frames));
        Rows(all.map(|r| (Cow::Borrowed(&**r), false)).collect())
    }

    fn shared(scene: &'a Scene) -> Rows<'a> {
        let Rows(all) = Rows::own(scene);
        let each = all.into_iter().enumerate();
        let each = each.map(|(n, row)| match Codes::shared(&row.0, n == 0) {
            Some(shared) => (Cow::Owned(shared), true),
            None => row,
        });
        Rows(each.collect())
    }

    /// What a frame after another (`None`: the first) costs to pack.
    fn jobs(&self, rung: Rung, at: usize, before: Option<usize>) -> impl Iterator<Item = Job<'_>> {
        let each = self.0.iter().enumerate();
        each.map(move |(n, (frames, shared))| Job {
            codes: &frames[at],
            bits: if n == 0 { rung.moved } else { rung.values },
            before: before.filter(|_| *shared).map(|b| &frames[b]),
        })
    }
}

/// A block to be packed.
#[derive(Clone, Copy)]
struct Job<'a> {
    codes: &'a Codes,
    bits: u8,
    before: Option<&'a Codes>,
}

impl<'a> Job<'a> {
    fn places(scene: &'a Scene) -> Job<'a> {
        Job {
            codes: &scene.reference,
            bits: FINE,
            before: None,
        }
    }

    fn pack(self, keep: &[u32], points: usize) -> io::Result<(Vec<u8>, bool)> {
        if keep.len() == points {
            return self.codes.pack(self.bits, self.before);
        }
        let before = self.before.map(|b| b.thinned(keep));
        self.codes.thinned(keep).pack(self.bits, before.as_ref())
    }
}

fn cost(blocks: &[Vec<u8>]) -> usize {
    blocks.iter().map(|b| cost_of(b)).sum()
}

fn cost_of(block: &[u8]) -> usize {
    block.len().div_ceil(3) * 4 + TAG
}

/// Every one of `stride` points, here and there: every second along a line would leave stripes.
fn kept(points: usize, stride: usize) -> Vec<u32> {
    let mixed = |i: u32| (i ^ (i >> 15)).wrapping_mul(0x2c1b_3c6d) >> 12;
    (0..points as u32)
        .filter(|i| (mixed(*i) as usize).is_multiple_of(stride))
        .collect()
}

/// Numbers of the frames that are kept, the first and last among them.
fn frames(all: usize, kept: usize) -> Vec<usize> {
    if kept < 2 {
        return (0..all.min(1)).collect();
    }
    (0..kept).map(|k| k * (all - 1) / (kept - 1)).collect()
}

/// What it would cost, by the middle and the last frame.
fn estimate(scene: &Scene, rows: &Rows, rung: Rung, keep: &[u32]) -> io::Result<usize> {
    let shown = frames(scene.frames.len(), rung.frames);
    let of = |k: usize| rows.jobs(rung, shown[k], k.checked_sub(1).map(|b| shown[b]));
    let looked = [shown.len() / 2, shown.len() - 1];
    let jobs: Vec<Job> = looked.into_iter().flat_map(of).collect();
    let sum = |jobs: &[Job]| -> io::Result<usize> {
        let packed = all(jobs, keep, scene.points)?;
        Ok(packed.iter().map(|(b, _)| cost_of(b)).sum())
    };
    Ok(sum(&[Job::places(scene)])? + sum(&jobs)? / 2 * shown.len())
}

/// Packs everything, on several threads.
fn all(jobs: &[Job], keep: &[u32], points: usize) -> io::Result<Vec<(Vec<u8>, bool)>> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let next = AtomicUsize::new(0);
    let done = Mutex::new(vec![]);
    let work = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = jobs.get(at) else {
                return;
            };
            let packed = job.pack(keep, points);
            let mut done = done.lock().unwrap_or_else(|e| e.into_inner());
            done.push((at, packed));
        }
    };
    std::thread::scope(|s| {
        for _ in 1..threads.min(8).min(jobs.len()) {
            s.spawn(work);
        }
        work();
    });
    let mut done = done.into_inner().unwrap_or_else(|e| e.into_inner());
    done.sort_by_key(|(at, _)| *at);
    done.into_iter().map(|(_, packed)| packed).collect()
}

fn packed(
    scene: &Scene,
    rows: &Rows,
    rung: Rung,
    keep: &[u32],
    first: usize,
    told: &Value,
) -> io::Result<Packed> {
    let shown = frames(scene.frames.len(), rung.frames);
    let mut jobs = vec![Job::places(scene)];
    // field after field
    for n in 0..rows.0.len() {
        let of = |k: usize| {
            rows.jobs(rung, shown[k], k.checked_sub(1).map(|b| shown[b]))
                .nth(n)
        };
        jobs.extend((0..shown.len()).filter_map(of));
    }
    let done = all(&jobs, keep, scene.points)?;
    let line = |(k, (job, (_, after))): (usize, (&Job, &(Vec<u8>, bool)))| {
        let codes = job.codes;
        let seen: Vec<[Value; 2]> = codes.seen.iter().map(|s| s.map(short)).collect();
        json!({
            "at": first + k, "bits": codes.bits_of(job.bits), "after": after, "low": codes.low, "high": codes.high, "seen": seen,
            "size": short(codes.size),
        })
    };
    let lines: Vec<Value> = jobs.iter().zip(&done).enumerate().map(line).collect();
    let mut lines = lines.into_iter();
    let blocks: Vec<Vec<u8>> = done.into_iter().map(|(bytes, _)| bytes).collect();
    let mut take = |n: usize| lines.by_ref().take(n).collect::<Vec<Value>>();
    let reference = take(1).pop();
    let moved = take(shown.len());
    let mut fields: Vec<Value> = scene.fields.iter().map(|f| {
        json!({
            "name": f.name, "unit": f.unit, "says": f.says, "kind": f.kind, "components": f.components, "names": f.names,
            "blocks": take(shown.len()),
        })
    }).collect();
    let any = scene.moved.iter().any(|m| m.size > 0.0);
    if any {
        let axes = &["x", "y", "z"][..];
        fields.push(json!({
            "name": "displacement", "unit": told["length"], "kind": "vector", "components": axes, "names": [],
            "says": if scene.atoms { "From the position in the first frame." } else { "From the reference position." },
        }));
    }
    let mut made = told.clone();
    let frame = |f: &usize| json!({"step": scene.frames[*f].0, "value": scene.frames[*f].1});
    // smaller cubes would leave gaps between fewer points
    let grown = libm::pow(
        scene.points as f64 / keep.len().max(1) as f64,
        1.0 / scene.dimension as f64,
    );
    let more = json!({
        "kind": scene.kind, "dimension": scene.dimension, "points": keep.len(), "stride": rung.stride,
        "spacing": scene.spacing * grown, "atoms": scene.atoms, "reference": reference, "moved": moved, "fields": fields,
        "frames": shown.iter().map(frame).collect::<Vec<_>>(), "notes": notes(scene, rung, keep.len()),
    });
    if let (Some(made), Value::Object(more)) = (made.as_object_mut(), more) {
        made.extend(more);
    }
    Ok(Packed {
        scene: made,
        blocks,
    })
}

/// What was given up.
fn notes(scene: &Scene, rung: Rung, points: usize) -> Vec<String> {
    let mut notes = scene.notes.clone();
    let bits = |b: u8| (1u32 << b) - 1;
    let mut said = format!(
        "Numbers of points are rounded to {} levels between the extremes of their frame, displacements to {}, positions to {}.",
        bits(rung.values),
        bits(rung.moved),
        bits(FINE)
    );
    if rung.frames < scene.frames.len() {
        said += &format!(
            " To stay small the report has {} of {} frames.",
            rung.frames,
            scene.frames.len()
        );
    }
    if points < scene.points {
        said += &format!(
            " To stay small the report has {points} of {} points, drawn larger.",
            scene.points
        );
    }
    notes.push(said);
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rungs_go_down() {
        let all: Vec<Rung> = rungs(21).collect();
        assert_eq!((all[0].moved, all[0].frames, all[0].stride), (16, 21, 1));
        let weight = |r: &Rung| f64::from(r.moved + r.values) * r.frames as f64 / r.stride as f64;
        assert!(all.windows(2).all(|w| weight(&w[1]) <= weight(&w[0])));
        assert!(rungs(1).count() > 5);
    }

    #[test]
    fn frames_keep_their_ends_and_points_their_share() {
        assert_eq!(frames(21, 5), [0, 5, 10, 15, 20]);
        assert_eq!(frames(2, 2), [0, 1]);
        assert_eq!(frames(1, 1), [0]);
        assert_eq!(kept(10, 1).len(), 10);
        let some = kept(100_000, 8).len();
        assert!((11_000..14_000).contains(&some), "{some}");
    }
}
