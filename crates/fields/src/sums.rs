//! All fields of a frame at given points.
//!
//! Particles are taken in blocks of neighbouring bins. A block lists the terms of its centres, adds the bonds of each pair together,
//! and adds them to the points near it; blocks are fixed and their results are added in order, so the bits do not depend on the
//! number of threads. Velocities are counted from the drift of the whole frame, so that a fast body loses no digits of its heat.

use crate::FieldsError;
use crate::accumulate::{self, BOND, Form, ParticleSums, Particles};
use crate::bonds::Block;
use crate::collect::Spare;
use crate::effort::{Effort, bonds_within};
use crate::fields::{Fields, Layout, Sums, Totals};
use crate::frame::Frame;
use crate::kernel::dot;
use crate::method::{Method, Progress};
use crate::neighbours::Neighbours;
use crate::partition::PairForce;
use crate::patch::Patch;
use crate::targets::{Bins, Targets};
use crate::workspace::Collector;
use peridyne::law::terms::Sites;
use rayon::prelude::*;
use std::sync::Mutex;

/// The part of bonds in a frame's work, about; the rest is that of particles.
const OF_BONDS: f64 = 0.9;

/// Particles of a block, about.
const BLOCK: usize = 4096;
/// Blocks of a small frame, about: enough for many threads.
const BLOCKS: usize = 64;

/// Fields of a frame.
///
/// # Errors
/// A frame that makes no sense, particles that coincide, a potential without a cut-off; more than memory holds or a day computes
/// ([`Effort`]); somebody stops it.
pub fn evaluate(
    frame: &Frame,
    sites: &dyn Sites,
    targets: &Targets,
    method: &Method,
) -> Result<Fields, FieldsError> {
    frame.check()?;
    let neighbours = neighbours(frame, sites, method)?;
    let bonds = bonds_within(frame, sites.reach());
    Effort::of(frame, bonds, sites.reach(), targets, method).check(targets, method)?;
    let mut bins = Bins::new(targets, &frame.cell, &method.kernel)?;
    bins.stop = method.stop;
    let molecules = method.molecules.as_deref();
    if let Some(molecules) = molecules {
        molecules.check(frame.len(), sites)?;
    }
    let names = names(sites, method);
    let parts = names.len();
    let drift = frame.drift();
    let velocity = frame.velocities_beside(drift);
    let collector = Collector {
        frame,
        sites,
        molecules,
        neighbours: &neighbours,
        partition: &method.partition,
        pair_force: method.pair_force,
        parts,
        velocity: &velocity,
        stop: method.stop,
    };
    let blocks = Blocks::new(&neighbours, frame.len());
    let mut layout = Layout {
        parts,
        moving: !velocity.is_empty(),
        rates: method.rates && !velocity.is_empty(),
        churns: false,
        places: method.coordinate,
        averaged: method.kernel.averaged_axes().map(|a| a.is_some()),
    };
    let mut bonds = vec![0.0; targets.len() * parts * BOND];
    let mut own = Own::new(frame.len(), parts);
    let mut totals = Totals::new(frame);
    // bonded partners may be farther than the potential reaches
    let wide = sites
        .reach()
        .max(molecules.map_or(0.0, |m| m.longest(frame)));
    let spares: Mutex<Vec<Spare>> = Mutex::default();
    let batch = 2 * rayon::current_num_threads();
    for first in (0..blocks.count).step_by(batch) {
        let some: Vec<_> = (first..(first + batch).min(blocks.count))
            .into_par_iter()
            .map(|b| -> Result<_, FieldsError> {
                let (centres, bounds) = blocks.members(&neighbours, b);
                let reach = std::array::from_fn(|a| wide / frame.cell.height(a));
                let patch = Patch::of(&bins, widened(bounds, reach));
                // far from all points: nothing of it is seen
                if patch.is_empty() || centres.is_empty() {
                    return Ok((Block::default(), None, centres.is_empty()));
                }
                let spare = spares.lock().ok().and_then(|mut all| all.pop());
                let mut workspace = spare.unwrap_or_default();
                let mut block = collector.collect(&centres, &mut workspace)?;
                let form = form(&block, &layout, method);
                workspace.bonds = std::mem::take(&mut block.bonds);
                let of = &workspace.bonds;
                let sums = accumulate::bonds(&method.kernel, &patch, of, parts, form);
                if let Ok(mut all) = spares.lock() {
                    all.push(workspace);
                }
                Ok((block, Some((patch.index, sums)), true))
            })
            .collect();
        method.go_on()?;
        for result in some {
            let (block, part, seen) = result?;
            if let Some((index, part)) = part {
                part.add_to(&mut bonds, &index, parts);
            }
            layout.churns |= block.churns;
            own.take(&block, parts);
            totals.take(&block, seen);
        }
        let done = (first + batch).min(blocks.count) as f64 / blocks.count as f64;
        tell(method, OF_BONDS * done);
    }
    totals.energy = own.energy.iter().sum();
    let moving = Moving {
        frame,
        velocity: &velocity,
        drift,
        layout: &layout,
    };
    let sums = Sums {
        bonds,
        particles: moving.sums(&neighbours, &bins, &own, method)?,
    };
    Ok(Fields::finish(
        targets.positions(&frame.cell),
        names,
        layout,
        &sums,
        drift,
        method.boltzmann,
        totals,
        own.force,
    ))
}

/// Who may feel whom.
fn neighbours<'a>(
    frame: &'a Frame,
    sites: &dyn Sites,
    method: &'a Method,
) -> Result<Neighbours<'a>, FieldsError> {
    // particles that are bonded alone feel nobody else
    let alone = sites.reach() == 0.0 && method.molecules.is_some();
    let reach = if alone {
        method.kernel.width()
    } else {
        sites.reach()
    };
    let neighbours = Neighbours::new(frame, reach)?;
    match &method.families {
        Some(families) => neighbours.held(families),
        None => Ok(neighbours),
    }
}

/// Of the parts of the potential that are kept apart.
fn names(sites: &dyn Sites, method: &Method) -> Vec<String> {
    match method.by_part {
        true => {
            let bonded = method.molecules.as_deref().map_or(&[][..], |m| m.parts());
            let bonded = bonded.iter().map(|p| p.to_string());
            sites.parts().into_iter().chain(bonded).collect()
        }
        false => vec!["all".to_string()],
    }
}

/// What of the bonds of a block is needed.
#[inline]
fn form(block: &Block, layout: &Layout, method: &Method) -> Form {
    match block.churns || method.pair_force == PairForce::Differences {
        true => Form::Whole,
        false if layout.moving => Form::Moving,
        false => Form::Still,
    }
}

fn tell(method: &Method, part: f64) {
    if let Some(Progress(tell)) = &method.progress {
        tell(part);
    }
}

fn widened(bounds: [[f64; 3]; 2], by: [f64; 3]) -> [[f64; 3]; 2] {
    let [low, high] = bounds;
    [
        std::array::from_fn(|a| low[a] - by[a]),
        std::array::from_fn(|a| high[a] + by[a]),
    ]
}

/// Particles and how they move, velocities from the drift.
pub(crate) struct Moving<'a> {
    pub frame: &'a Frame,
    pub velocity: &'a [[f64; 3]],
    pub drift: [f64; 3],
    pub layout: &'a Layout,
}

impl Moving<'_> {
    /// Sums of all particles at the points, block by block.
    pub fn sums(
        &self,
        neighbours: &Neighbours,
        bins: &Bins,
        own: &Own,
        method: &Method,
    ) -> Result<Vec<f64>, FieldsError> {
        let layout = self.layout;
        let blocks = Blocks::new(neighbours, self.frame.len());
        let mut sums = vec![0.0; bins.points() * layout.stride()];
        let batch = 2 * rayon::current_num_threads();
        for first in (0..blocks.count).step_by(batch) {
            let some: Vec<_> = (first..(first + batch).min(blocks.count))
                .into_par_iter()
                .map(|b| {
                    let (members, bounds) = blocks.members(neighbours, b);
                    let patch = Patch::of(bins, bounds);
                    if patch.is_empty() {
                        return (vec![], ParticleSums::default());
                    }
                    let mut columns = Columns::default();
                    for i in members {
                        columns.push(self, own, i as usize);
                        columns.position.push(neighbours.wrapped[i as usize]);
                    }
                    let of = Particles {
                        position: &columns.position,
                        width: layout.width(),
                        value: &columns.value,
                        slopes: (layout.slopes() > 0).then_some(&columns.slope[..]),
                        slope_width: layout.slopes(),
                        moments: &columns.moment,
                        moment_width: layout.moments(),
                        carried: &columns.carried,
                    };
                    let sums = accumulate::particles(&method.kernel, &patch, &of);
                    (patch.index, sums)
                })
                .collect();
            method.go_on()?;
            for (index, part) in some {
                part.add_to(&mut sums, &index);
            }
            let done = (first + batch).min(blocks.count) as f64 / blocks.count as f64;
            tell(method, OF_BONDS + (1.0 - OF_BONDS) * done);
        }
        Ok(sums)
    }
}

/// What atoms have of all terms.
pub(crate) struct Own {
    /// For each part.
    pub energy: Vec<f64>,
    pub force: Vec<[f64; 3]>,
    /// `Σ_k v_k · ∂U^(j)/∂x_k` (4.0.107).
    pub power: Vec<f64>,
}

impl Own {
    pub fn new(particles: usize, parts: usize) -> Own {
        Own {
            energy: vec![0.0; particles * parts],
            force: vec![[0.0; 3]; particles],
            power: vec![0.0; particles],
        }
    }

    fn take(&mut self, block: &Block, parts: usize) {
        for (n, share) in block.shares.iter().enumerate() {
            let i = share.atom as usize;
            for c in 0..3 {
                self.force[i][c] += share.force[c];
            }
            self.power[i] += share.power;
            for part in 0..parts {
                self.energy[i * parts + part] += block.energy[n * parts + part];
            }
        }
    }
}

/// What particles of a block add.
#[derive(Default)]
struct Columns {
    position: Vec<[f64; 3]>,
    value: Vec<f64>,
    slope: Vec<f64>,
    moment: Vec<f64>,
    carried: Vec<f64>,
}

impl Columns {
    fn push(&mut self, of: &Moving, own: &Own, i: usize) {
        let (layout, drift) = (of.layout, of.drift);
        let m = of.frame.mass[i];
        let energy = &own.energy[i * layout.parts..][..layout.parts];
        self.value.extend([1.0, m]);
        self.value.extend(energy);
        if layout.places {
            self.moment.push(m);
        }
        if !layout.moving {
            return;
        }
        let v = of.velocity[i];
        if layout.places {
            self.moment.extend(v.map(|c| m * c));
        }
        let square = dot(v, v);
        let potential: f64 = energy.iter().sum();
        self.value.extend(v.map(|c| m * c));
        self.value.extend(products(v).map(|c| m * c));
        self.value.extend(v.map(|c| m * square * c));
        self.value.extend(v.map(|c| potential * c));
        if layout.slopes() == 0 {
            return;
        }
        self.slope.push(m);
        self.slope.extend(v.map(|c| m * c));
        if !layout.rates {
            return;
        }
        let v: [f64; 3] = std::array::from_fn(|a| v[a] + drift[a]);
        if layout.places {
            self.carried.extend(v.map(|c| m * c));
        }
        let total = 0.5 * m * dot(v, v) + potential;
        self.value.extend(own.force[i]);
        self.value.push(dot(v, own.force[i]) + own.power[i]);
        self.slope.extend(products(v).map(|c| m * c));
        self.slope.extend(v.map(|c| total * c));
    }
}

/// xx, yy, zz, yz, xz, xy.
fn products(v: [f64; 3]) -> [f64; 6] {
    [
        v[0] * v[0],
        v[1] * v[1],
        v[2] * v[2],
        v[1] * v[2],
        v[0] * v[2],
        v[0] * v[1],
    ]
}

/// Bricks of bins of particles.
struct Blocks {
    size: [i32; 3],
    along: [i32; 3],
    count: usize,
}

impl Blocks {
    fn new(neighbours: &Neighbours, atoms: usize) -> Blocks {
        let bins = neighbours.bins;
        let total: f64 = bins.iter().map(|b| f64::from(*b)).product();
        let wanted = (atoms / BLOCKS).clamp(32, BLOCK) as f64;
        let edge = libm::cbrt(wanted * total / atoms as f64).round().max(1.0) as i32;
        let size = bins.map(|b| edge.min(b));
        let along: [i32; 3] = std::array::from_fn(|a| (bins[a] + size[a] - 1) / size[a]);
        Blocks {
            size,
            along,
            count: along.iter().map(|n| *n as usize).product(),
        }
    }

    /// Particles of a block, and the fractions between which they lie.
    fn members(&self, neighbours: &Neighbours, b: usize) -> (Vec<u32>, [[f64; 3]; 2]) {
        let b = b as i32;
        let at = [
            b / (self.along[1] * self.along[2]),
            b / self.along[2] % self.along[1],
            b % self.along[2],
        ];
        let from: [i32; 3] = std::array::from_fn(|a| at[a] * self.size[a]);
        let to: [i32; 3] =
            std::array::from_fn(|a| (from[a] + self.size[a]).min(neighbours.bins[a]));
        let mut all = vec![];
        for i in from[0]..to[0] {
            for j in from[1]..to[1] {
                for k in from[2]..to[2] {
                    all.extend_from_slice(neighbours.members([i, j, k]));
                }
            }
        }
        (all, neighbours.bounds(from, to))
    }
}
