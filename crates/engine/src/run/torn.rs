//! Points that a traction tears off before the body has answered: few bonds, and all of the load of a point.

use super::system::System;
use crate::body::{view, view_mut, zeros};
use crate::interaction::{BondStatus, Sweep};
use crate::law::material::tensor::{inverse, times};
use crate::message;
use crate::quantity::{Message, place, rounded};
use crate::space::full;
use std::collections::{HashMap, HashSet};

/// So many points with the fewest bonds are looked at, that far apart in horizons that none feels another.
const LOOKS: usize = 8;
const APART: f64 = 2.5;
/// Times up to the end of the run at which the load is looked at.
const TIMES: u32 = 8;
/// Of a spacing: a displacement in which laws are linear.
const SMALL: f64 = 1e-6;

/// A point under a load.
struct Loaded<const D: usize> {
    slot: usize,
    bonds: usize,
    /// Force density.
    force: [f64; D],
    /// Where it goes while all others stand still (length).
    goes: [f64; D],
    /// The largest of its bonds (–).
    stretch: f64,
}

/// Of the points under tractions those with the fewest bonds that these do not hold, as long as all others stand still: `K u = f` with
/// the stiffness K of the bonds of the point, torn off where u stretches one of them beyond its limit.
pub(super) fn torn<const D: usize>(system: &mut System<D>, end: f64) -> Option<Message> {
    if system.info.critical_stretch.iter().all(|s| !s.is_finite()) {
        return None;
    }
    let mut all = loosest(system, end);
    push_alone(system, &mut all);
    stretch_alone(system, &mut all);
    let limit = |p: &Loaded<D>| {
        let limits = &system.info.critical_stretch;
        limits
            .get(system.body.material_of(p.slot))
            .copied()
            .unwrap_or(f64::INFINITY)
    };
    let torn: Vec<&Loaded<D>> = all.iter().filter(|p| p.stretch >= limit(p)).collect();
    let first = torn.first()?;
    let many = match torn.len() {
        1 => "a point with few bonds".to_string(),
        n => format!("{n} points with few bonds"),
    };
    let x = system.body.position(first.slot);
    Some(message![
        format!("a traction tears off {many} at once: that at "),
        place(&x[..D]),
        format!(
            " has {}, the load stretches one by {} % while all others stand still, and they break at {} %. Leave corners out of the set, or let points there not break ([[toughness]])",
            first.bonds,
            rounded(100.0 * first.stretch, 2),
            rounded(100.0 * limit(first), 2)
        ),
    ])
}

/// Points under tractions with the fewest bonds, far from each other.
fn loosest<const D: usize>(system: &System<D>, end: f64) -> Vec<Loaded<D>> {
    let mut force: HashMap<usize, [f64; D]> = HashMap::new();
    let tractions = system
        .applied
        .loads
        .iter()
        .filter(|l| l.of.is_some_and(|(_, area)| area.is_some()));
    for (slot, density) in tractions.flat_map(|l| l.largest(end, TIMES)) {
        let sum = force.entry(slot).or_insert([0.0; D]);
        (0..D).for_each(|a| sum[a] += density[a]);
    }
    let mut held = HashSet::new();
    let mut hold = |slot, _| held.extend([slot]);
    system.prescribed.all().for_each(|p| p.each_held(&mut hold));
    let mut few: Vec<(usize, usize)> = { force.keys() }
        .filter(|slot| !held.contains(slot))
        .map(|slot| (system.interaction.family_size(&system.body, *slot), *slot))
        .collect();
    few.sort_unstable();
    let mut found: Vec<Loaded<D>> = vec![];
    let apart = APART * system.info.horizon;
    for (bonds, slot) in few {
        let x = system.body.position(slot);
        let near = |p: &Loaded<D>| {
            let y = system.body.position(p.slot);
            (0..3).map(|a| (x[a] - y[a]).powi(2)).sum::<f64>() < apart * apart
        };
        if found.len() < LOOKS && !found.iter().any(near) {
            found.push(Loaded {
                slot,
                bonds,
                force: force[&slot],
                goes: [0.0; D],
                stretch: 0.0,
            });
        }
    }
    found
}

/// Where they go.
fn push_alone<const D: usize>(system: &mut System<D>, all: &mut [Loaded<D>]) {
    if all.is_empty() {
        return;
    }
    let small = SMALL * system.body.spacing();
    let mut u = system.body.at_rest();
    let mut f = zeros(system.body.len());
    let mut stiffness = vec![[[0.0; D]; D]; all.len()];
    for way in [1.0, -1.0] {
        for a in 0..D {
            all.iter().for_each(|p| u[a][p.slot] = way * small);
            system.body.exchange().fill(&mut u[a]);
            system
                .interaction
                .forces(&system.body, view(&u), view_mut(&mut f), Sweep::Hold, None);
            for (p, k) in all.iter().zip(&mut stiffness) {
                (0..D).for_each(|b| k[b][a] -= way * f[b][p.slot] / (2.0 * small));
            }
            all.iter().for_each(|p| u[a][p.slot] = 0.0);
            system.body.exchange().fill(&mut u[a]);
        }
    }
    for (p, k) in all.iter_mut().zip(stiffness) {
        let even = crate::array::from_fn(|a| crate::array::from_fn(|b| 0.5 * (k[a][b] + k[b][a])));
        if let (flexibility, true) = inverse(even) {
            p.goes = times(&flexibility, &p.force);
        }
    }
}

fn stretch_alone<const D: usize>(system: &System<D>, all: &mut [Loaded<D>]) {
    let place: HashMap<usize, usize> = all.iter().enumerate().map(|(k, p)| (p.slot, k)).collect();
    if place.is_empty() {
        return;
    }
    system
        .interaction
        .each_bond(&system.body, &mut |i, j, xi, state| {
            if state != BondStatus::Whole {
                return;
            }
            let xi = full(&xi);
            let square: f64 = xi.iter().map(|c| c * c).sum();
            for (end, way) in [(i, -1.0), (j, 1.0)] {
                if let Some(k) = place.get(&end) {
                    let p = &mut all[*k];
                    let along: f64 = (0..D).map(|a| xi[a] * p.goes[a]).sum();
                    p.stretch = p.stretch.max(way * along / square);
                }
            }
        });
}
