//! Points that a traction tears off before the body has answered: few bonds, and all of the load of a point.

use super::system::System;
use crate::body::{view, view_mut, zeros};
use crate::interaction::{BondStatus, Sweep};
use crate::law::material::tensor::{inverse, times};
use crate::message;
use crate::quantity::{Message, place, rounded};
use crate::space::{Point, full};
use std::collections::{HashMap, HashSet};

/// So many points with the fewest bonds are looked at, that far apart in horizons that none feels another.
const LOOKS: usize = 8;
const APART: f64 = 2.5;
/// Times up to the end of the run at which the load is looked at.
const TIMES: u32 = 8;
/// Of a spacing: a displacement in which laws are linear.
const SMALL: f64 = 1e-6;

/// A point under a load that is here, the how-manieth of those that were chosen.
struct Loaded<const D: usize> {
    chosen: usize,
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
/// the stiffness K of the bonds of the point, torn off where u stretches one of them beyond its limit. All ranks ask at once.
pub(super) fn overloaded<const D: usize>(system: &mut System<D>, end: f64) -> Option<Message> {
    if system.info.critical_stretch.iter().all(|s| !s.is_finite()) {
        return None;
    }
    let (chosen, mut here) = loosest(system, end);
    if chosen == 0 {
        return None;
    }
    push_alone(system, &mut here);
    stretch_alone(system, &mut here);
    let overloaded = here.iter().filter_map(|p| {
        let limits = &system.info.critical_stretch;
        let limit = limits.get(system.body.material_of(p.slot)).copied();
        let limit = limit.unwrap_or(f64::INFINITY);
        let [x, y, z] = system.body.position(p.slot);
        let told = [p.chosen as f64, p.bonds as f64, p.stretch, limit, x, y, z];
        (p.stretch >= limit).then_some(told)
    });
    let overloaded = system.body.all_of(&overloaded.collect::<Vec<_>>()).concat();
    let first = overloaded.iter().min_by(|a, b| a[0].total_cmp(&b[0]))?;
    let [_, bonds, stretch, limit, x @ ..] = *first;
    let many = match overloaded.len() {
        1 => "a point with few bonds".to_string(),
        n => format!("{n} points with few bonds"),
    };
    Some(message![
        format!("a traction breaks off {many} at once: that at "),
        place(&x[..D]),
        format!(
            " has {}, the load stretches one by {} % while all others stand still, and they break at {} %. Leave corners out of the set, or let points there not break ([[toughness]])",
            bonds,
            rounded(100.0 * stretch, 2),
            rounded(100.0 * limit, 2)
        ),
    ])
}

/// Points under tractions with the fewest bonds, far from each other: how many, and those that are here.
fn loosest<const D: usize>(system: &System<D>, end: f64) -> (usize, Vec<Loaded<D>>) {
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
    let body = &system.body;
    // fewest bonds first, then in the order of the whole
    let key = |slot: usize| {
        let bonds = system.interaction.family_size(body, slot);
        (bonds as u64, body.order(slot))
    };
    let loaded = force.keys().filter(|slot| !held.contains(slot));
    let mut few: Vec<_> = loaded.map(|slot| (key(*slot), *slot)).collect();
    few.sort_unstable();
    let mut few = few.into_iter().peekable();
    let apart = APART * system.info.horizon;
    let (mut found, mut here) = (Vec::<Point>::new(), vec![]);
    while found.len() < LOOKS {
        let near = |slot: usize| {
            let x = body.position(slot);
            let square = |y: &Point| (0..3).map(|a| (x[a] - y[a]).powi(2)).sum::<f64>();
            found.iter().any(|y| square(y) < apart * apart)
        };
        while few.next_if(|(_, slot)| near(*slot)).is_some() {}
        let own = few.peek().map(|((bonds, order), slot)| {
            let x = body.position(*slot).map(f64::to_bits);
            [*bonds, *order, x[0], x[1], x[2]]
        });
        let all = body.all_of(own.as_slice()).concat();
        let Some(first) = all.into_iter().min() else {
            break;
        };
        if own == Some(first)
            && let Some(((bonds, _), slot)) = few.next()
        {
            here.push(Loaded {
                chosen: found.len(),
                slot,
                bonds: bonds as usize,
                force: force[&slot],
                goes: [0.0; D],
                stretch: 0.0,
            });
        }
        found.push([first[2], first[3], first[4]].map(f64::from_bits));
    }
    (found.len(), here)
}

/// Where they go.
fn push_alone<const D: usize>(system: &mut System<D>, all: &mut [Loaded<D>]) {
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
        .each_partner(&system.body, &mut |i, _, xi, state| {
            let Some(k) = place.get(&i).filter(|_| state == BondStatus::Whole) else {
                return;
            };
            let p = &mut all[*k];
            let xi = full(&xi);
            let square: f64 = xi.iter().map(|c| c * c).sum();
            let along: f64 = (0..D).map(|a| xi[a] * p.goes[a]).sum();
            p.stretch = p.stretch.max(-along / square);
        });
}
