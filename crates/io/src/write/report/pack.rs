//! As much of a scene as fits into a report: bits, frames and points are given up in this order, and said.

use std::io;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::{Value, json};

use super::quantise::{Codes, FINE};
use super::scene::Scene;
use super::short;

/// What one block costs besides its bytes in base 64: its tag, and its line of numbers.
const TAG: usize = 180;

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
    let fine = [(FINE, FINE), (FINE, 8), (13, 8), (12, 7), (12, 6)];
    let of = |(moved, values), frames, stride| Rung {
        moved,
        values,
        frames,
        stride,
    };
    let few = (2..).map(move |k| frames.div_ceil(k));
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
    let mut last = None;
    for rung in rungs(all) {
        let keep = kept(scene.points, rung.stride);
        if estimate(scene, rung, &keep)? > room {
            last = Some(rung);
            continue;
        }
        let packed = packed(scene, rung, &keep, first, &told)?;
        if cost(&packed.blocks) <= room {
            return Ok(packed);
        }
        last = Some(rung);
    }
    // the least there is
    let rung = last.unwrap_or(Rung {
        moved: 12,
        values: 6,
        frames: all.min(2),
        stride: 1,
    });
    packed(scene, rung, &kept(scene.points, rung.stride), first, &told)
}

fn cost(blocks: &[Vec<u8>]) -> usize {
    blocks.iter().map(|b| b.len().div_ceil(3) * 4 + TAG).sum()
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
fn estimate(scene: &Scene, rung: Rung, keep: &[u32]) -> io::Result<usize> {
    let count = scene.frames.len();
    let looked = [count / 2, count - 1];
    let mut jobs = vec![];
    for f in looked {
        jobs.push((&scene.moved[f], rung.moved));
        jobs.extend(
            scene
                .fields
                .iter()
                .map(|field| (&field.frames[f], rung.values)),
        );
    }
    let two = cost(&all(&jobs, keep, scene.points)?);
    let place = cost(&all(&[(&scene.reference, FINE)], keep, scene.points)?);
    Ok(place + two / 2 * rung.frames)
}

/// Packs everything, on several threads.
fn all(jobs: &[(&Codes, u8)], keep: &[u32], points: usize) -> io::Result<Vec<Vec<u8>>> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let next = AtomicUsize::new(0);
    let done = Mutex::new(vec![]);
    let work = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some((codes, bits)) = jobs.get(at) else {
                return;
            };
            let bytes = if keep.len() == points {
                codes.pack(*bits)
            } else {
                codes.thinned(keep).pack(*bits)
            };
            let mut done = done.lock().unwrap_or_else(|e| e.into_inner());
            done.push((at, bytes));
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
    done.into_iter().map(|(_, bytes)| bytes).collect()
}

fn packed(
    scene: &Scene,
    rung: Rung,
    keep: &[u32],
    first: usize,
    told: &Value,
) -> io::Result<Packed> {
    let shown = frames(scene.frames.len(), rung.frames);
    let mut jobs = vec![(&scene.reference, FINE)];
    jobs.extend(shown.iter().map(|f| (&scene.moved[*f], rung.moved)));
    for field in &scene.fields {
        jobs.extend(shown.iter().map(|f| (&field.frames[*f], rung.values)));
    }
    let blocks = all(&jobs, keep, scene.points)?;
    let mut lines = jobs.iter().enumerate().map(|(k, (codes, bits))| {
        json!({
            "at": first + k, "bits": codes.bits_of(*bits), "low": codes.low, "high": codes.high,
            "seen": codes.seen.iter().map(|s| s.map(short)).collect::<Vec<_>>(), "size": short(codes.size),
        })
    });
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
    let grown = (scene.points as f64 / keep.len().max(1) as f64).powf(1.0 / scene.dimension as f64);
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
        assert!(all.windows(2).all(|w| weight(&w[1]) < weight(&w[0])));
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
