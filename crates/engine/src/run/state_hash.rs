//! What a model is in two numbers ([`StateHash`]), for a look whether two runs went the same way.
//!
//! Points are hashed by id in blocks, bonds by the ids of their ends and the image that they lead to: how points and bonds lie in memory does not
//! show. A bond that is whole adds nothing, so that a body where nothing broke costs a walk over its bonds.

use super::system::System;
use crate::body::{Field, view};
use crate::columns::{Life, On};
use crate::diffusion::DiffusionAccount;
use crate::interaction::{BondStatus, history};
use crate::observe::state_hash::{Words, hash_of_name};
use crate::observe::{Ledger, StateHash};
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::HashMap;

/// Ids of a block, which has a digest of its own.
const BLOCK: usize = 1024;

/// The id of nobody.
const GONE: u32 = u32::MAX;

/// Who has a column of points.
enum Owner {
    Displacement,
    Velocity,
    /// Forces of a step in which bonds broke are found no more.
    Force,
    Diffusion,
    /// So many numbers of each point.
    Law(usize),
}

/// Chains a column of points, `each` numbers of every id, to the digests of blocks.
fn chain(digests: &mut [u64], (name, each): (&str, usize), values: &[f64]) {
    let name = hash_of_name(name);
    let blocks = values.par_chunks(each * BLOCK);
    digests.par_iter_mut().zip(blocks).for_each(|(digest, of)| {
        let mut words = Words::default();
        words.put([name]);
        words.numbers(of.iter().copied());
        *digest = words.hash(*digest);
    });
}

/// What bonds add to the blocks of their points, in any order.
struct Bonds<'a, const D: usize> {
    system: &'a System<D>,
    /// By slot; [`GONE`] of who was taken away.
    id: Vec<u32>,
    /// Of blocks, where there is anything.
    sums: HashMap<u64, u64>,
    words: Words,
}

impl<const D: usize> Bonds<'_, D> {
    /// A directed bond between two slots, with numbers of its own in the column of this hash.
    fn add(&mut self, column: u64, [i, j]: [usize; 2], xi: [f64; D], numbers: &[f64]) {
        if [i, j].iter().any(|slot| self.id[*slot] == GONE) {
            return;
        }
        let body = &self.system.body;
        let [from, to] = [i, j].map(|slot| body.home(slot));
        let image = (0..D).map(|a| {
            let further = |period: f64| ((xi[a] - (to[a] - from[a])) / period).round() as i64;
            body.period()[a].map_or(0, further) as u64
        });
        let [i, j] = [i, j].map(|slot| self.id[slot]);
        self.words.put([i, j].map(u64::from));
        self.words.put(image);
        self.words.numbers(numbers.iter().copied());
        let sum = self.sums.entry(u64::from(i) / BLOCK as u64).or_default();
        *sum = sum.wrapping_add(self.words.hash(column));
    }
}

/// Of the model of all ranks on the first of them; others help.
pub(super) fn hashed<const D: usize>(system: &mut System<D>) -> StateHash {
    system.refresh_images();
    StateHash {
        state: hash_of_state(system),
        ledger: hash_of_ledger(system),
    }
}

fn hash_of_state<const D: usize>(system: &System<D>) -> u64 {
    let mut words = Words::default();
    let points = system.body.all_points() as u64;
    words.put([
        D as u64,
        points,
        system.clock.step(),
        system.clock.shown().to_bits(),
    ]);
    let digests = digests_of_points(system).zip(sums_of_bonds(system));
    for (digest, bonds) in digests.into_iter().flat_map(|(d, b)| d.into_iter().zip(b)) {
        words.put([digest, bonds]);
    }
    for rigid_body in &system.applied.rigid {
        words.numbers(rigid_body.rigid.center);
    }
    words.hash(0)
}

/// Of each block, all that its points remember; on the first rank.
fn digests_of_points<const D: usize>(system: &System<D>) -> Option<Vec<u64>> {
    let mut columns: Vec<(Cow<'static, str>, Owner)> = vec![
        ("displacement".into(), Owner::Displacement),
        ("velocity".into(), Owner::Velocity),
        ("force_density".into(), Owner::Force),
    ];
    let spread = system.diffusion_columns().into_iter();
    columns.extend(spread.map(|c| (c.name, Owner::Diffusion)));
    columns.extend(declared(system, On::Points).map(|(name, each)| (name, Owner::Law(each))));
    columns.sort_by(|a, b| a.0.cmp(&b.0));

    let runs = system.body.runs_of_ids(BLOCK);
    let mut digests = vec![0; runs.points().div_ceil(BLOCK)];
    let slots = || system.body.slots().iter().map(|s| *s as usize);
    for (name, owner) in columns {
        let of = |field: &Field<D>| -> Vec<f64> {
            slots()
                .flat_map(|s| (0..D).map(move |a| field[a][s]))
                .collect()
        };
        let (each, own) = match owner {
            Owner::Displacement => (D, of(&system.u)),
            Owner::Velocity => (D, of(&system.v)),
            Owner::Force => (D, of(&system.f)),
            Owner::Diffusion => (1, system.transferred(&name).unwrap_or_default()),
            Owner::Law(each) => {
                let values = of_law(system, &name);
                let own = slots().flat_map(|s| &values[each * s..each * (s + 1)]);
                (each, own.copied().collect())
            }
        };
        chain(&mut digests, (&name, each), &runs.of(each, own));
    }
    system.body.joined(digests)
}

/// Columns over points or over bonds that the law declares and that persist, with the numbers of each.
fn declared<const D: usize>(
    system: &System<D>,
    on: On,
) -> impl Iterator<Item = (Cow<'static, str>, usize)> {
    let columns = system.interaction.columns().into_iter();
    let kept = columns.filter(move |c| c.life == Life::Persistent && c.on == on);
    kept.map(|c| (c.name, c.shape.stored(D)))
}

/// Such a column, as it lies.
fn of_law<const D: usize>(system: &System<D>, name: &str) -> Vec<f64> {
    let mut values = vec![];
    let known = (system.interaction).read_column(&system.body, view(&system.u), name, &mut values);
    assert!(known, "{name} is declared and cannot be read");
    values
}

/// Of each block, which bonds of its points are broken or were never there, and what the others of its bonds' columns say; on the first rank.
fn sums_of_bonds<const D: usize>(system: &System<D>) -> Option<Vec<u64>> {
    let mut id = vec![GONE; system.body.len()];
    let number = |id: usize| system.body.id_of_all(id) as u32;
    { system.body.slots().iter().enumerate() }.for_each(|(n, s)| id[*s as usize] = number(n));
    system.body.exchange().fill(&mut id);
    let mut bonds = Bonds {
        system,
        id,
        sums: HashMap::new(),
        words: Words::default(),
    };
    let (whole, whose) = (hash_of_name(history::WHOLE), system.body.whose());
    system
        .interaction
        .each_bond(&system.body, &mut |i, j, xi, state| {
            if state != BondStatus::Whole {
                bonds.add(whole, [i, j], xi, &[]);
                bonds.add(whole, [j, i], xi.map(|x| -x), &[]);
            }
        });
    for (name, each) in declared(system, On::Bonds).filter(|c| c.0 != history::WHOLE) {
        let hash = hash_of_name(&name);
        let values = of_law(system, &name);
        let mut rows = values.chunks_exact(each);
        system
            .interaction
            .each_directed(&system.body, &name, &mut |i, j, xi| {
                let row = rows.next().expect("a value of each bond");
                // those of an interface are known to all ranks
                if whose.place(bonds.id[i]).is_some() {
                    bonds.add(hash, [i, j], xi, row);
                }
            });
        assert!(rows.next().is_none(), "a bond of each value");
    }
    let own = bonds.sums.into_iter().map(<[u64; 2]>::from);
    let all = system.body.joined(own.collect())?;
    let mut sums = vec![0u64; system.body.all_points().div_ceil(BLOCK)];
    for [block, sum] in all {
        let all = &mut sums[block as usize];
        *all = all.wrapping_add(sum);
    }
    Some(sums)
}

fn hash_of_ledger<const D: usize>(system: &mut System<D>) -> Option<u64> {
    let Ledger {
        kinetic,
        strain,
        contact,
        released,
        made,
        dissipated,
        numerical,
        work_boundary_conditions,
        work_rigid_bodies,
        initial,
    } = system.balance().ok()?;
    let mut words = Words::default();
    words.numbers([
        kinetic,
        strain,
        contact,
        released,
        made,
        dissipated,
        numerical,
        work_boundary_conditions,
        work_rigid_bodies,
        initial,
    ]);
    for (quantity, account) in system.diffusion_accounts() {
        let DiffusionAccount {
            content,
            initial,
            supplied,
            exchanged,
            held,
            made,
            through_contact,
        } = account;
        words.put([hash_of_name(quantity.column())]);
        words.numbers([content, initial, supplied, exchanged, held, made]);
        words.numbers(through_contact);
    }
    Some(words.hash(0))
}
