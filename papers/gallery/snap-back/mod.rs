//! Snap-back of a double cantilever: load and opening fall together, on the curve that beam theory has at a constant energy release.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    SnapBack,
    "snap-back",
    "Snap-back of a double cantilever",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (SI): thickness, height of the thick arms, where they begin, how far the crack is beyond, opening at t = 1, energy of fracture.
const B: f64 = 0.01;
const H: f64 = 0.02;
const A: f64 = 0.08;
const FIRST: f64 = 0.01;
const OPENING: f64 = 1e-3;
const G: f64 = 50.0;
/// Length that the root of an arm adds to the crack, over the height of the arm (Gross and Srawley 1966).
const ROOT: f64 = 0.687;

/// An equilibrium: length of the crack (m), opening (m), load (N), energy that was released (J).
#[derive(Debug, Clone, Copy)]
struct At {
    crack: f64,
    opening: f64,
    load: f64,
    released: f64,
}

/// Pairs of points that face each other across the crack's plane, by x.
fn facing(bench: &mut Bench, h: f64) -> Vec<(u32, u32)> {
    let places = bench.places();
    let near = |y: f64| {
        let all = places.iter().enumerate();
        let mut row: Vec<(f64, u32)> = { all.filter(|(_, p)| (p[1] - y).abs() < 0.1 * h) }
            .map(|(n, p)| (p[0], n as u32))
            .collect();
        row.sort_by(|a, b| a.0.total_cmp(&b.0));
        row
    };
    let (low, high) = (near(-0.5 * h), near(0.5 * h));
    let both = low.iter().zip(&high);
    both.map(|((_, a), (_, b))| (*a.min(b), *a.max(b)))
        .collect()
}

fn grown(h: f64, set: &[(&str, &str)], longest: f64) -> Result<(Vec<At>, Bench), Failure> {
    let mut bench = Bench::new(DECK, set)?;
    let pairs = facing(&mut bench, h);
    let mut all = vec![];
    for _ in 0..bench.steps() {
        bench.step()?;
        let whole: std::collections::HashSet<(u32, u32)> = { bench.sim.snapshot(&[], true).bonds }
            .unwrap_or_default()
            .into_iter()
            .collect();
        let cut = pairs.iter().filter(|p| !whole.contains(p)).count();
        let first = A + FIRST;
        // columns of points begin half a thin arm before the line of load
        let crack = (cut as f64 - 0.5) * h - 0.25 * H;
        let ledger = bench
            .sim
            .ledger()
            .map_err(|e| Failure::new(e.to_string()))?;
        all.push(At {
            crack,
            opening: OPENING * bench.sim.time(),
            load: bench.probe("load_y")?,
            released: ledger.released,
        });
        if crack > first + longest {
            break;
        }
    }
    Ok((all, bench))
}

/// Of each length of the crack the equilibrium of the greatest load: teeth of the saw.
fn teeth(all: &[At]) -> Vec<At> {
    let mut found: Vec<At> = vec![];
    for at in all {
        match found.last_mut() {
            Some(last) if (last.crack - at.crack).abs() < 1e-9 => {
                if at.load > last.load {
                    *last = *at;
                }
            }
            _ => found.push(*at),
        }
    }
    found
}

/// The line y = p + q x through points.
fn line(points: &[(f64, f64)]) -> [f64; 2] {
    let n = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let q = mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2));
    [y - q * x, q]
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let (spacing, h, longest) = match context.small {
        true => ("2 mm", 0.002, 0.02),
        false => ("1 mm", 0.001, 0.06),
    };
    let (all, mut bench) = grown(h, &[("constants.h", spacing)], longest)?;
    let teeth = teeth(&all);
    // the first tooth and the last one are not whole
    let teeth = &teeth[1..teeth.len() - 1];
    let arm = |at: &At| at.crack + ROOT * H;
    // beams: opening/load = p + q (a + χH)³
    let cubes: Vec<(f64, f64)> = { teeth.iter() }
        .map(|t| (arm(t).powi(3), t.opening / t.load))
        .collect();
    let [p, q] = line(&cubes);
    let off = { cubes.iter() }.map(|(x, y)| ((p + q * x) / y - 1.0).abs());
    found.number("compliance", off.fold(0.0, f64::max));
    // energy release, P²/2B d(opening/load)/da, of every tooth
    let release: Vec<f64> = { teeth.iter() }
        .map(|t| t.load.powi(2) / (2.0 * B) * 3.0 * q * arm(t).powi(2))
        .collect();
    let mean = release.iter().sum::<f64>() / release.len() as f64;
    let scatter = release.iter().map(|g| (g / mean - 1.0).abs());
    found.number("constant", scatter.fold(0.0, f64::max));
    found.measured(
        "energy release at the teeth, over the energy of fracture",
        mean / G,
        "",
    );
    // what the crack took, over what its faces are worth
    let (begin, end) = (teeth[0], teeth[teeth.len() - 1]);
    let faces = B * (end.crack - begin.crack);
    found.number("taken", (end.released - begin.released) / (faces * G));
    // how far the opening falls, beside the beams' at a constant energy release
    let curve = |x: f64| (p + q * x.powi(3)) / x;
    let lowest = |of: &[f64]| of.iter().copied().fold(f64::INFINITY, f64::min);
    let openings: Vec<f64> = teeth.iter().map(|t| t.opening).collect();
    let beams: Vec<f64> = teeth.iter().map(|t| curve(arm(t))).collect();
    let fall = lowest(&openings) / openings[0];
    found.measured("least opening over that of the first tooth", fall, "");
    found.number("fall", fall / (lowest(&beams) / beams[0]));
    let of = |at: &[At], f: fn(&At) -> f64| at.iter().map(f).collect::<Vec<f64>>();
    let scale = (2.0 * B * mean / (3.0 * q)).sqrt();
    let theory: Vec<[f64; 2]> = { teeth.iter() }
        .map(|t| [scale * curve(arm(t)), scale / arm(t)])
        .collect();
    let plot =
        Plot::new("Load over opening: every equilibrium, and beams at the mean energy release")
            .x("opening", "m")
            .y("load", "N")
            .line(
                "bond after bond",
                &of(&all, |a| a.opening),
                &of(&all, |a| a.load),
            )
            .points("teeth", &openings, &of(teeth, |a| a.load))
            .line(
                "beams",
                &theory.iter().map(|t| t[0]).collect::<Vec<_>>(),
                &theory.iter().map(|t| t[1]).collect::<Vec<_>>(),
            );
    found.picture(plot.save(&context.out, "load")?);
    bench.damage(context, "damage", &mut found)?;
    let path = context.out.join("equilibria.csv");
    Table::new()
        .column("crack", "m", of(&all, |a| a.crack))
        .column("opening", "m", of(&all, |a| a.opening))
        .column("load", "N", of(&all, |a| a.load))
        .column("released", "J", of(&all, |a| a.released))
        .save(&path)?;
    found.file(path);
    Ok(found)
}
