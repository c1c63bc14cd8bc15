//! Potentials on families of the reference whose bonds break: who is taken out of a family is never felt again.
//!
//! What is held is a list of neighbours; a broken bond is an entry of it, and of that of its partner, that names nobody. The energy of an
//! atom is then that of the neighbours that are left: of pairs one term less, of densities, angles and bond orders what they say without
//! this neighbour. Bonds break by their stretch, or by the work that the force states `∂U^(i)/∂y_ij` (sandia2010 (4.0.122)) of both
//! ends have done on them, `∫ (T_i − T_j)·dη` (Foster, Silling & Chen 2011), by the trapezoidal rule from step to step.
//!
//! What breaking does to the energy is the difference of all energy before and after. A potential that holds atoms together is lowest at
//! the reference: there breaking a bond gives energy to the atoms (it is booked as made), and it takes the more the farther it was stretched.

mod kernel;

use crate::body::{Body, Field, FieldView, FieldViewMut, Identity, view, view_mut, zeros};
use crate::columns::Declaration;
use crate::execute::blocks::{Shared, run_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::neighbours::near::NearList;
use crate::interaction::criterion::Measure;
use crate::interaction::history::{self, crossed, damage};
use crate::interaction::{
    BondStatus, Crosses, EachBond, EachForce, EachPair, EachTangent, Gradient, Heals, Interaction,
    Motion, PointEnergiesMut, Released, Sweep, Tally, Toughness,
};
use crate::spec::{Breakage, CrackKind};
use crate::state::Archive;
use kernel::{Add, Test};
use std::collections::HashMap;

/// In place of an atom where a slot has none.
const NOBODY: u32 = u32::MAX;

/// What bonds of potentials break by.
#[derive(Debug, Clone)]
pub struct Breaks {
    /// Per material.
    pub toughness: Vec<Toughness>,
    /// [`Measure::Stretch`] or [`Measure::Work`].
    pub measure: Measure,
}

/// A potential on a held list of neighbours.
pub trait Held<const D: usize>: Interaction<D> {
    fn list(&self) -> &NearList<D>;

    fn list_mut(&mut self) -> &mut NearList<D>;

    /// `T_i − T_j` (force) of each bond, towards its partner where it pulls, by place: `8 (first[tile] + line) + lane`; 0 where nobody is. Of the
    /// displacements of the last [`forces`](Interaction::forces).
    fn pulls(&self, first: &[u32], out: &mut [[f64; D]]);

    /// The bond at a place of its list was taken out, or put back.
    fn follow(&mut self, _place: usize, _whole: bool) {}
}

/// First line of each tile of a list, and its lines.
pub(super) fn lines_of<const D: usize>(list: &NearList<D>) -> (Vec<u32>, Vec<[u32; TILE]>) {
    let (mut first, mut family) = (vec![], vec![]);
    for (_, lines) in (0..list.blocks()).flat_map(|b| list.tiles(b)) {
        first.push(family.len() as u32);
        family.extend_from_slice(lines);
    }
    (first, family)
}

/// Such a potential with bonds that break.
pub struct Breaking<const D: usize> {
    inner: Box<dyn Held<D>>,
    simd: Simd,
    toughness: Vec<Toughness>,
    /// First line of each tile.
    first: Vec<u32>,
    /// `[lines]`: the families of the reference.
    family: Vec<[u32; TILE]>,
    /// `[listed][4]`: places in the reference, and critical values: of `e`, or works (energy / volume²).
    reference: Vec<[f64; 4]>,
    /// By slot: place among own atoms.
    own: Vec<u32>,
    work: Option<Work<D>>,
    found: Vec<Vec<u32>>,
    next: Vec<f64>,
    /// Forces without the bonds that just broke.
    after: Field<D>,
}

/// What is known of the work on bonds.
struct Work<const D: usize> {
    /// By place (energy / volume²).
    done: Vec<f64>,
    /// Positions and forces of bonds at the step before.
    at: Vec<[f64; 4]>,
    before: Vec<[f64; D]>,
    pulls: Vec<[f64; D]>,
}

impl<const D: usize> Work<D> {
    /// None, of a body at rest whose list has so many lines.
    fn new(body: &Body<D>, inner: &mut dyn Held<D>, first: &[u32], lines: usize) -> Self {
        let mut f = zeros(body.len);
        inner.forces(
            body,
            view(&body.at_rest()),
            view_mut(&mut f),
            Sweep::Hold,
            None,
        );
        let mut before = vec![[0.0; D]; lines * TILE];
        inner.pulls(first, &mut before);
        Work {
            done: vec![0.0; before.len()],
            at: inner.list().positions().to_vec(),
            pulls: before.clone(),
            before,
        }
    }
}

impl<const D: usize> Breaking<D> {
    /// `inner` holds the families of the reference of this body, which is at rest.
    pub fn new(body: &Body<D>, mut inner: Box<dyn Held<D>>, breaks: Breaks, simd: Simd) -> Self {
        let list = inner.list();
        let (first, family) = lines_of(list);
        let own = list.by_slot();
        let mut reference = list.positions().to_vec();
        let limits = match &breaks.measure {
            Measure::Work(limits) => limits.as_slice(),
            // critical stretches are known after the first evaluation; other measures potentials do not have
            Measure::Stretch | Measure::VonMises(_) | Measure::PlasticStrain(_) => &[],
        };
        for (slot, own) in own.iter().enumerate().filter(|(_, own)| **own != NOBODY) {
            let limit = limits.get(body.material_of(slot)).copied();
            reference[*own as usize][3] = limit.unwrap_or(f64::INFINITY);
        }
        list.fill_fourth(&mut reference);
        let (blocks, tiles) = (list.blocks(), first.len());
        let work = match breaks.measure {
            Measure::Work(_) => Some(Work::new(body, inner.as_mut(), &first, family.len())),
            Measure::Stretch | Measure::VonMises(_) | Measure::PlasticStrain(_) => None,
        };
        Breaking {
            inner,
            simd,
            toughness: breaks.toughness,
            first,
            family,
            reference,
            own,
            work,
            found: vec![vec![]; blocks],
            next: vec![0.0; tiles * TILE],
            after: zeros(body.len),
        }
    }

    /// The work of the step that ends here, by the forces that were just found.
    fn add_work(&mut self, body: &Body<D>) {
        let Some(work) = &mut self.work else {
            return;
        };
        self.inner.pulls(&self.first, &mut work.pulls);
        let list = self.inner.list();
        let kernel = Add {
            body,
            list,
            first: &self.first,
            then: &work.at,
            before: &work.before,
            pulls: &work.pulls,
            work: Shared(work.done.as_mut_ptr()),
        };
        run_blocks(self.simd, &kernel, list.blocks());
        work.at.copy_from_slice(list.positions());
        std::mem::swap(&mut work.before, &mut work.pulls);
    }

    /// Bonds that go, of which both directions know: they are found by one or by both.
    fn test(&mut self, body: &Body<D>) -> Vec<usize> {
        let list = self.inner.list();
        let kernel = Test {
            body,
            list,
            reference: &self.reference,
            first: &self.first,
            work: self.work.as_ref().map_or(&[], |w| &w.done),
            toughness: &self.toughness,
            next: Shared(self.next.as_mut_ptr()),
            found: Shared(self.found.as_mut_ptr()),
        };
        run_blocks(self.simd, &kernel, list.blocks());
        self.found.iter().flatten().map(|p| *p as usize).collect()
    }

    /// What points bear from now on, where bonds break by their stretch.
    fn strengthen(&mut self) {
        if self.work.is_some() {
            return;
        }
        for own in self.own.iter().filter(|own| **own != NOBODY) {
            let own = *own as usize;
            self.reference[own][3] = self.next[own];
        }
        self.inner.list().fill_fourth(&mut self.reference);
    }

    /// Line and lane of a place in the list.
    fn entry(&mut self, place: usize) -> &mut u32 {
        let (tile, line) = self.line(place);
        &mut self.inner.list_mut().lines_mut(tile)[line][place % TILE]
    }

    fn is_whole(&self, place: usize) -> bool {
        let (tile, line) = self.line(place);
        let list = self.inner.list();
        list.lines(tile)[line][place % TILE] != list.nowhere()
    }

    /// Tile of a place, and its line there.
    fn line(&self, place: usize) -> (usize, usize) {
        let line = place / TILE;
        let tile = self.first.partition_point(|f| *f as usize <= line) - 1;
        (tile, line - self.first[tile] as usize)
    }

    /// Places of the family of an own atom, broken bonds too, with the listed atoms that they name.
    fn bonds(&self, own: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let tile = own / TILE;
        let end = { self.first.get(tile + 1) }.map_or(self.family.len(), |f| *f as usize);
        let nowhere = self.inner.list().nowhere();
        (self.first[tile] as usize..end)
            .map(move |line| (line * TILE + own % TILE, self.family[line][own % TILE]))
            .filter(move |(_, other)| *other != nowhere)
            .map(|(place, other)| (place, other as usize))
    }

    /// ξ of an own atom and a listed one.
    fn xi(&self, own: usize, other: usize) -> [f64; D] {
        let (x, z) = (&self.reference[own], &self.reference[other]);
        crate::array::from_fn(|a| z[a] - x[a])
    }

    /// The place of the same bond from its other end.
    fn opposite(&self, place: usize) -> Option<usize> {
        let (tile, _) = self.line(place);
        let own = tile * TILE + place % TILE;
        let other = self.family[place / TILE][place % TILE] as usize;
        let list = self.inner.list();
        let xi = self.xi(own, other);
        let size = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
        let near = 1e-12 * size(&xi);
        self.bonds(list.home(other)?).find_map(|(back, n)| {
            let of = self.xi(list.home(other)?, n);
            let sum: [f64; D] = crate::array::from_fn(|a| of[a] + xi[a]);
            (list.home(n)? == own && size(&sum) < near).then_some(back)
        })
    }

    /// Places of these bonds from both of their ends, and of those that other ranks name: of atoms of others whose lists are here, too. All ranks come here
    /// at once.
    fn both_ends(&self, body: &Body<D>, places: &[usize]) -> Vec<usize> {
        if !body.exchange.is_shared() {
            let ends = |place: &usize| [Some(*place), self.opposite(*place)];
            return places.iter().flat_map(ends).flatten().collect();
        }
        let (list, id) = (self.inner.list(), body.id_of());
        let named = |n: usize| list.original(n).map(&id);
        let said = places.iter().filter_map(|&place| {
            let (tile, _) = self.line(place);
            let own = tile * TILE + place % TILE;
            let other = self.family[place / TILE][place % TILE] as usize;
            let mut said = [0.0; 5];
            said[0] = f64::from(named(own)?);
            said[1] = f64::from(named(other)?);
            said[2..2 + D].copy_from_slice(&self.xi(own, other));
            Some(said)
        });
        let said = body.all_of(&said.collect::<Vec<_>>()).concat();
        if said.is_empty() {
            return vec![];
        }
        let listed = 0..TILE * self.first.len();
        let known: HashMap<u32, usize> = listed.filter_map(|n| Some((named(n)?, n))).collect();
        let turned = said.iter().map(|[i, j, x, y, z]| [*j, *i, -x, -y, -z]);
        let find = |[i, j, xi @ ..]: [f64; 5]| {
            let own = *known.get(&(i as u32))?;
            self.bonds(own).find_map(|(place, other)| {
                let of = self.xi(own, other);
                let off = (0..D).map(|a| (of[a] - xi[a]).powi(2)).sum::<f64>();
                let near = off < 1e-12 * of.iter().map(|c| c * c).sum::<f64>();
                (near && named(other) == Some(j as u32)).then_some(place)
            })
        };
        said.iter()
            .copied()
            .chain(turned)
            .filter_map(find)
            .collect()
    }

    /// Takes bonds out at these places, or puts them back. Directed ones of own atoms that were otherwise.
    fn put(&mut self, places: &[usize], whole: bool) -> u64 {
        let nowhere = self.inner.list().nowhere();
        let mut changed = 0;
        for &place in places {
            let named = match whole {
                true => self.family[place / TILE][place % TILE],
                false => nowhere,
            };
            let (tile, _) = self.line(place);
            let is_own = !self.inner.list().slots(tile).is_empty();
            let entry = self.entry(place);
            changed += u64::from(is_own && *entry != named);
            *entry = named;
            self.inner.follow(place, whole);
        }
        changed
    }

    /// Takes these bonds out, from both ends. Directed ones that were whole.
    fn tear(&mut self, body: &Body<D>, places: &[usize]) -> u64 {
        let places = self.both_ends(body, places);
        self.put(&places, false)
    }

    /// These are broken, and no others.
    fn break_only(&mut self, body: &Body<D>, broken: &[usize]) {
        let all: Vec<usize> = (0..TILE * self.first.len())
            .flat_map(|own| self.bonds(own).map(|(place, _)| place))
            .collect();
        self.put(&all, true);
        self.tear(body, broken);
    }

    /// All directed bonds of the reference, in order of slots: slots, ξ and place.
    fn each_place(&self, body: &Body<D>, mut visit: impl FnMut(usize, usize, [f64; D], usize)) {
        let list = self.inner.list();
        for &slot in &body.slots {
            let own = self.own[slot as usize] as usize;
            for (place, other) in self.bonds(own) {
                if let Some(j) = list.original(other) {
                    visit(slot as usize, j, self.xi(own, other), place);
                }
            }
        }
    }

    /// Is there anything that breaks by itself?
    fn breaks(&self) -> bool {
        self.work.is_some() || self.toughness.iter().any(|t| t.s00.is_finite())
    }

    /// What goes in this step goes, and what that does to the energy: `f` are the forces with all bonds, and those without where bonds let
    /// go at once.
    fn evolve(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        motion: Motion<D>,
    ) -> Tally {
        self.add_work(body);
        let found = self.test(body);
        let mut tally = Tally::default();
        if body.exchange.any(!found.is_empty()) {
            let [before, _] = self.inner.energy(body, u);
            tally.broken = self.tear(body, &found);
            let mut after = std::mem::replace(&mut self.after, zeros(0));
            let without = self
                .inner
                .forces(body, u, view_mut(&mut after), Sweep::Hold, None);
            tally += without;
            if let Some(work) = &mut self.work {
                // the next step begins with the pulls of the bonds that are left
                self.inner.pulls(&self.first, &mut work.before);
            }
            let [left, _] = self.inner.energy(body, u);
            // over half a step these bonds pulled too long, or not at all
            let half = match motion.breakage {
                Breakage::BeforeForce => 0.5 * motion.steps[0],
                Breakage::AfterForce => -0.5 * motion.steps[1],
            };
            let power = body.sum(body.slots.iter().map(|&s| {
                let s = s as usize;
                let of = |a: usize| (f[a][s] - after[a][s]) * motion.v[a][s];
                body.volume.at(s) * (0..D).map(of).sum::<f64>()
            }));
            // energies are those of all ranks
            if body.is_first() {
                let mut released = Released::default();
                released.book(before - left + half * power);
                tally.lost.add(released.lost);
                tally.made.add(released.made);
            }
            if motion.breakage == Breakage::BeforeForce {
                for a in 0..D {
                    f[a].swap_with_slice(&mut after[a]);
                }
            }
            self.after = after;
        }
        self.strengthen();
        tally
    }
}

impl<const D: usize> Interaction<D> for Breaking<D> {
    fn made_for(&self) -> Identity {
        self.inner.made_for()
    }

    fn family(&self) -> &'static str {
        self.inner.family()
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let mut tally = self
            .inner
            .forces(body, u, view_mut(&mut f), Sweep::Hold, seen);
        if let Some(motion) = sweep.motion().filter(|_| self.breaks()) {
            tally += self.evolve(body, u, f, motion);
        }
        tally
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        self.inner.energy(body, u)
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        self.inner.observe(body, u, out);
    }

    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.inner.observe_gradient(body, gradient, out);
    }

    fn is_potential(&self) -> bool {
        true
    }

    fn has_many_body(&self) -> bool {
        self.inner.has_many_body()
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        self.inner.tangents(body, u, visit);
    }

    fn gain(&self, slot: usize) -> f64 {
        self.inner.gain(slot)
    }

    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        self.inner.each_force(body, u, visit)
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        self.inner.virial(body, u)
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        let id = body.id_of();
        self.each_partner(body, &mut |i, j, xi, state| {
            if id(i) < id(j) {
                visit(i, j, xi, state);
            }
        });
    }

    fn each_partner(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.each_place(body, |i, j, xi, place| {
            let state = match self.is_whole(place) {
                true => BondStatus::Whole,
                false => BondStatus::Broken,
            };
            visit(i, j, xi, state);
        });
    }

    fn mend(&mut self, body: &Body<D>, u: FieldView<D>, heals: &Heals) -> Option<u64> {
        self.check(body, &[u]);
        let position = self.inner.list().positions_at(u, self.simd)?;
        let mut places = vec![];
        for &slot in &body.slots {
            let own = self.own[slot as usize] as usize;
            for (place, other) in self.bonds(own).filter(|(place, _)| !self.is_whole(*place)) {
                let xi = self.xi(own, other);
                let eta = crate::array::from_fn(|a| position[other][a] - position[own][a] - xi[a]);
                let partner = self.inner.list().original(other);
                let e = history::relative(&xi, eta);
                if partner.is_some_and(|j| heals(slot as usize, j, e)) {
                    places.push(place);
                }
            }
        }
        let places = self.both_ends(body, &places);
        Some(self.put(&places, true))
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        let mut family = vec![0.0; body.len];
        out.fill(0.0);
        self.each_place(body, |i, j, _, place| {
            let volume = body.volume.at(j);
            family[i] += volume;
            out[i] += if self.is_whole(place) { volume } else { 0.0 };
        });
        for (out, family) in out.iter_mut().zip(family) {
            *out = damage(*out, family);
        }
    }

    fn cut(&mut self, body: &Body<D>, kind: CrackKind, crosses: &Crosses<D>) -> u64 {
        let mut places = vec![];
        self.each_place(body, |i, j, xi, place| {
            let [from, to] = [i, j].map(|slot| {
                let x = body.position(slot);
                crate::array::from_fn(|a| x[a])
            });
            if self.is_whole(place) && crossed(crosses, from, xi, Some(to)) {
                places.push(place);
            }
        });
        let places = self.both_ends(body, &places);
        let cut = self.put(&places, false);
        if kind == CrackKind::Excluded {
            // they were never there
            let nowhere = self.inner.list().nowhere();
            for place in places {
                self.family[place / TILE][place % TILE] = nowhere;
            }
        }
        cut
    }

    fn directed_bonds(&self) -> u64 {
        let own = self.own.iter().filter(|own| **own != NOBODY);
        own.map(|own| self.bonds(*own as usize).count() as u64)
            .sum()
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        self.bonds(self.own[slot] as usize).count()
    }

    fn columns(&self) -> Vec<Declaration> {
        let mut all = history::columns(self.work.is_none());
        if self.work.is_some() {
            all.extend(history::of_work());
        }
        all
    }

    fn read_column(&self, body: &Body<D>, _: FieldView<D>, name: &str, out: &mut Vec<f64>) -> bool {
        out.clear();
        match (name, &self.work) {
            (history::WHOLE, _) => self.each_place(body, |_, _, _, place| {
                out.push(f64::from(u8::from(self.is_whole(place))));
            }),
            (history::DONE, Some(work)) => {
                self.each_place(body, |_, _, _, place| out.push(work.done[place]));
            }
            _ => {
                let mut critical = vec![0.0; body.len];
                for &s in &body.slots {
                    critical[s as usize] = self.reference[self.own[s as usize] as usize][3];
                }
                return history::read_critical(body, &critical, name, out);
            }
        }
        true
    }

    fn each_directed(&self, body: &Body<D>, _: &str, visit: &mut EachPair<D>) {
        self.each_place(body, |i, j, xi, _| visit(i, j, xi));
    }

    fn write_column(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        let mut places = vec![];
        match name {
            history::WHOLE | history::DONE => {
                self.each_place(body, |_, _, _, place| places.push(place));
                if values.len() != places.len() {
                    return false;
                }
            }
            _ => {}
        }
        match (name, &mut self.work) {
            (history::WHOLE, _) => {
                let broken = places
                    .iter()
                    .zip(values)
                    .filter(|(_, whole)| **whole == 0.0);
                let broken: Vec<usize> = broken.map(|(place, _)| *place).collect();
                self.break_only(body, &broken);
            }
            (history::DONE, Some(work)) => {
                for (place, value) in places.into_iter().zip(values) {
                    work.done[place] = *value;
                }
            }
            (history::ELONGATION, None) | (history::WORK, Some(_)) => {
                if values.len() != body.len {
                    return false;
                }
                for (own, value) in self.own.iter().zip(values).filter(|(o, _)| **o != NOBODY) {
                    self.reference[*own as usize][3] = *value;
                }
                self.inner.list().fill_fourth(&mut self.reference);
            }
            _ => return false,
        }
        true
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        self.inner.archive(body, archive);
        let own = |slot: usize| self.own[slot] as usize;
        let critical = self.reference.as_flattened_mut();
        body.archive_points(archive, "critical", (critical, 1), |slot, _| {
            4 * own(slot) + 3
        });
        let rows: Vec<Vec<usize>> = { body.slots.iter() }
            .map(|s| {
                self.bonds(own(*s as usize))
                    .map(|(place, _)| place)
                    .collect()
            })
            .collect();
        let counts = rows.iter().map(|row| row.len() as u32).collect();
        let bonds = archive.bonds("bonds", body.whose(), counts);
        let bits = |row: &Vec<usize>| {
            let mut bytes = vec![0; row.len().div_ceil(8)];
            for (n, place) in row.iter().enumerate() {
                bytes[n / 8] |= u8::from(self.is_whole(*place)) << (n % 8);
            }
            bytes
        };
        let mut bytes: Vec<u8> = rows.iter().flat_map(bits).collect();
        archive.bits("whole", body.whose(), &bonds, &mut bytes);
        let list = self.inner.list();
        archive.given("work", &mut self.work, |work, archive| {
            let places = || rows.iter().flatten().copied();
            archive.rows(
                "done",
                body.whose(),
                (&bonds, 1),
                (&mut work.done, places()),
            );
            let pulls = work.before.as_flattened_mut();
            let numbers = places().flat_map(|place| D * place..D * place + D);
            archive.rows("pulls", body.whose(), (&bonds, D), (pulls, numbers));
            let at = |slot: usize, n: usize| 4 * own(slot) + n;
            body.archive_points(archive, "at", (work.at.as_flattened_mut(), 4), at);
            if archive.loads() {
                list.fill(&mut work.at);
            }
        });
        if archive.loads() {
            list.fill_fourth(&mut self.reference);
            let mut broken = vec![];
            let mut next = 0;
            for row in &rows {
                let is_broken = |n: &usize| bytes[next + n / 8] >> (n % 8) & 1 == 0;
                broken.extend((0..row.len()).filter(is_broken).map(|n| row[n]));
                next += row.len().div_ceil(8);
            }
            self.break_only(body, &broken);
        }
    }

    fn bytes(&self) -> usize {
        let work = self.work.as_ref().map_or(0, |w| {
            8 * w.done.len() + 32 * w.at.len() + 16 * D * w.before.len()
        });
        self.inner.bytes()
            + 4 * (self.first.len() + TILE * self.family.len() + self.own.len())
            + 32 * self.reference.len()
            + 8 * (self.next.len() + D * self.after[0].len())
            + work
    }
}
