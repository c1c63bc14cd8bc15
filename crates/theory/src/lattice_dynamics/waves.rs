//! Waves along the path of the Brillouin zone and along symmetry directions.

use crate::crystal::Crystal;
use crate::dispersion::verlet_frequency;
use crate::dispersion::zone::{SpecialPoint, path};
use crate::gradient::length_scale;
use std::f64::consts::PI;

/// Steps along each line of the path.
const STEPS: usize = 80;

/// One wave of one branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branch {
    /// ω² (1 / time²)
    pub squared: f64,
    /// Of velocity Verlet at the step asked about; `None`: the wave grows, or so does its error.
    pub verlet: Option<f64>,
    /// ω/k; `None` at k = 0 and where the wave grows.
    pub phase: Option<f64>,
    /// Component of ∂ω/∂k along the line; `None` at ω² ≤ 0.
    pub group: Option<f64>,
}

impl Branch {
    /// ω, or −√−ω² of a wave that grows.
    pub fn signed(&self) -> f64 {
        self.squared.abs().sqrt().copysign(self.squared)
    }
}

/// A wave vector with its waves.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Along the path (1 / length).
    pub distance: f64,
    pub wave: [f64; 3],
    pub name: Option<&'static str>,
    /// By rising ω².
    pub branches: Vec<Branch>,
}

/// Long waves along a symmetry direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Direction {
    /// As `Γ–X`.
    pub name: String,
    pub unit: Vec<f64>,
    /// Speeds of long waves, rising; `None` where they grow.
    pub sound: Vec<Option<f64>>,
    /// From long waves to the end of the line.
    pub rows: Vec<Row>,
    /// `[p][a][b]` of `ρ ü_a = Σ_p c_p[a][b] (n·∇)^{2p+2} u_b`; empty with several sites per cell.
    pub gradients: Vec<Vec<Vec<f64>>>,
}

impl Direction {
    /// Of longitudinal waves, `n·c_p·n`.
    pub fn longitudinal(&self) -> Vec<f64> {
        let n = &self.unit;
        let of = |c: &Vec<Vec<f64>>| -> f64 {
            (0..n.len())
                .flat_map(|a| (0..n.len()).map(move |b| (a, b)))
                .map(|(a, b)| n[a] * c[a][b] * n[b])
                .sum()
        };
        self.gradients.iter().map(of).collect()
    }

    /// Of longitudinal waves (length).
    pub fn length_scale(&self) -> Option<f64> {
        length_scale(&self.longitudinal())
    }
}

pub(super) fn scaled<const D: usize>(v: &[f64; 3], by: f64) -> [f64; D] {
    std::array::from_fn(|a| v[a] * by)
}

pub(super) fn size<const D: usize>(v: &[f64; D]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// All branches of a wave vector; ω² within round-off of 0 is 0.
fn branches<const D: usize>(
    crystal: &Crystal<D>,
    wave: [f64; D],
    line: [f64; D],
    dt: f64,
    scale: f64,
) -> Vec<Branch> {
    let k = size(&wave);
    let rows = crystal.slopes_along(wave, line).into_iter();
    rows.map(|[squared, slope]| {
        let squared = if squared.abs() <= 1e-13 * scale {
            0.0
        } else {
            squared
        };
        let omega = (squared >= 0.0).then(|| squared.sqrt());
        Branch {
            squared,
            verlet: omega.and_then(|w| verlet_frequency(w, dt)),
            phase: omega.filter(|_| k > 0.0).map(|w| w / k),
            group: omega.filter(|w| *w > 0.0).map(|w| slope / (2.0 * w)),
        }
    })
    .collect()
}

fn row<const D: usize>(distance: f64, wave: [f64; D], name: Option<&'static str>) -> Row {
    Row {
        distance,
        wave: std::array::from_fn(|a| if a < D { wave[a] } else { 0.0 }),
        name,
        branches: vec![],
    }
}

pub(super) fn along_path<const D: usize>(
    crystal: &Crystal<D>,
    points: &[SpecialPoint],
    spacing: f64,
    dt: f64,
    scale: f64,
) -> Vec<Row> {
    let stations = path::<D>(points, spacing, STEPS);
    let line = |n: usize| -> [f64; D] {
        // a corner belongs to the line that ends there
        let (a, b) = if n == 0 { (0, 1) } else { (n - 1, n) };
        let v: [f64; D] = std::array::from_fn(|i| stations[b].wave[i] - stations[a].wave[i]);
        let length = size(&v);
        v.map(|x| x / length)
    };
    (0..stations.len())
        .map(|n| {
            let s = &stations[n];
            Row {
                branches: branches(crystal, s.wave, line(n), dt, scale),
                ..row(s.distance, s.wave, s.name)
            }
        })
        .collect()
}

/// The lines of the path that start or end at Γ.
pub(super) fn directions<const D: usize>(
    crystal: &Crystal<D>,
    points: &[SpecialPoint],
    spacing: f64,
    dt: f64,
    scale: f64,
    section: f64,
    terms: usize,
) -> Vec<Direction> {
    let ends = points.windows(2).filter_map(|pair| {
        if pair[0].name == "Γ" {
            Some(pair[1])
        } else {
            (pair[1].name == "Γ").then_some(pair[0])
        }
    });
    ends.map(|end| {
        let wave: [f64; D] = scaled(&end.wave, 2.0 * PI / spacing);
        let length = size(&wave);
        let unit = wave.map(|x| x / length);
        let sound = crystal.sound(unit).unwrap_or_default();
        let top = sound.iter().map(|s| s.abs()).fold(0.0, f64::max);
        let rows = (1..=STEPS).map(|n| {
            let k = length * n as f64 / STEPS as f64;
            let wave = unit.map(|x| x * k);
            Row {
                branches: branches(crystal, wave, unit, dt, scale),
                ..row(k, wave, (n == STEPS).then_some(end.name))
            }
        });
        let gradients = crystal
            .gradient_coefficients(unit, terms)
            .unwrap_or_default();
        Direction {
            name: format!("Γ–{}", end.name),
            unit: unit.to_vec(),
            sound: sound
                .iter()
                .map(|s| (*s >= -1e-12 * top).then(|| s.max(0.0).sqrt()))
                .collect(),
            rows: rows.collect(),
            gradients: gradients
                .iter()
                .map(|c| {
                    c.iter()
                        .map(|r| r.iter().map(|x| x / section).collect())
                        .collect()
                })
                .collect(),
        }
    })
    .collect()
}
