//! A potential between atoms that are near now: molecular dynamics. Or between those that were near in the reference, held for ever.

mod kernel;

use super::breaking::Held;
use super::line::Table;
use super::{Curvatures, Faults, Said, find_fault};
use crate::body::{Body, FieldView, FieldViewMut, Identity, view};
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::neighbours::near::{Lines, NearList, Reaches};
use crate::interaction::along;
use crate::interaction::{
    BondStatus, BondTangent, EachBond, EachTangent, Gradient, Interaction, PointEnergiesMut, Sweep,
    Tally,
};
use crate::law::potential::Potential;
use crate::law::potential::mixture::Mixture;
use crate::state::Archive;
use kernel::{Density, Energies, Forces, View};

/// Margin of the list, in cut-offs.
const SKIN: f64 = 0.12;

/// Cut-offs of held lists in horizons at most: an atom that is nowhere is farther.
const MOST: f64 = 1e15;

/// A potential on current neighbours, or on those of the reference.
pub struct CurrentAtoms<const D: usize, P> {
    body: Identity,
    simd: Simd,
    potential: Mixture<P>,
    /// Squared cut-offs of pairs of kinds.
    limits: Vec<f64>,
    /// Horizon of the families of the reference, if these are held (length).
    held: Option<f64>,
    /// Constants of these pairs, where they are evaluated side by side.
    table: Option<Table>,
    list: NearList<D>,
    faults: Faults,
    /// Neighbours of every slot in the reference.
    family: Vec<u16>,
    curvatures: Curvatures,
}

impl<const D: usize, P: Potential> CurrentAtoms<D, P> {
    /// The kinds of the potential are the materials of the body, or there is one.
    pub fn new(body: &Body<D>, potential: Mixture<P>, simd: Simd) -> Self {
        Self::made(body, potential, None, simd)
    }

    /// The same between those that are within `horizon` (length) of each other in the reference, and nobody else, wherever they go.
    pub fn of_reference(body: &Body<D>, potential: Mixture<P>, horizon: f64, simd: Simd) -> Self {
        Self::made(body, potential, Some(horizon), simd)
    }

    fn made(body: &Body<D>, potential: Mixture<P>, held: Option<f64>, simd: Simd) -> Self {
        let kinds = potential.kinds();
        let limits = potential.limits(held.map_or(f64::INFINITY, |h| MOST * h));
        let of = |i, j| potential.of(i, j);
        let table = potential.is_side_by_side();
        let table = table.then(|| Table::new(kinds, of));
        let list = list_at(body, &potential, held, view(&body.at_rest()), simd);
        let blocks = list.blocks();
        let mut made = CurrentAtoms {
            body: body.identity,
            simd,
            potential,
            limits,
            held,
            table,
            list,
            faults: PerBlock::new(blocks, None),
            family: vec![],
            curvatures: Curvatures::default(),
        };
        let mut family = vec![0u16; body.len];
        made.each_near(|near| {
            let count = &mut family[near.slot];
            *count = count.saturating_add(1);
        });
        made.family = family;
        made
    }

    /// Visits every pair of an atom with another, or an image of one, that is within their cut-off at the positions of the list.
    fn each_near(&self, mut visit: impl FnMut(NearPair<D, P>)) {
        let at = self.list.positions();
        let kinds = self.potential.kinds();
        for tile in (0..self.list.blocks()).flat_map(|b| self.list.tiles_of_kinds(b)) {
            for (l, &slot) in self.list.slots(tile.number).iter().enumerate() {
                let own = self.list.kind(tile.number * TILE + l);
                let x = at[tile.number * TILE + l];
                for (n, line) in tile.lines().iter().enumerate() {
                    let z = at[line[l] as usize];
                    let y: [f64; D] = crate::array::from_fn(|a| z[a] - x[a]);
                    let q: f64 = y.iter().map(|c| c * c).sum();
                    let kind = self.list.kind(line[l] as usize);
                    let Some(potential) = self.potential.of(own, kind) else {
                        continue;
                    };
                    let Some(other) = self.list.original(line[l] as usize) else {
                        continue;
                    };
                    if q >= self.limits[own * kinds + kind] {
                        continue;
                    }
                    visit(NearPair {
                        potential,
                        unlike: own != kind,
                        bond: [tile.number, n, l],
                        slot: slot as usize,
                        other,
                        y,
                        q,
                        slopes: [x[3], z[3]],
                    });
                }
            }
        }
    }

    /// Positions and, with embedding, F′ in their fourth place.
    fn ready(&mut self, body: &Body<D>, u: FieldView<D>) -> Tally {
        self.list.update(body, u, self.simd);
        if !P::EMBEDDED {
            return Tally::default();
        }
        let position = self.list.positions_mut().as_mut_ptr();
        let kernel = Density {
            view: self.view(&self.list, position),
            slope: Shared(position.cast()),
        };
        let tally = find_fault(&self.faults, self.simd, &kernel);
        self.list.copy_fourth();
        tally
    }

    /// `position` points to those of all that `list` knows.
    fn view<'a>(&'a self, list: &'a NearList<D>, position: *const [f64; 4]) -> View<'a, D, P> {
        View {
            list,
            position: position.cast(),
            potential: &self.potential,
            limits: &self.limits,
            mixed: self.table.as_ref().zip(self.potential.each().next()),
        }
    }

    /// What each point of a list says (of [ready](Self::ready) positions).
    fn said(
        &self,
        body: &Body<D>,
        virial: bool,
        list: &NearList<D>,
        position: &[[f64; 4]],
    ) -> Said {
        let mut said = Said::new(body, virial);
        let kernel = Energies {
            view: self.view(list, position.as_ptr()),
            said: said.places(),
        };
        run_blocks(self.simd, &kernel, list.blocks());
        said
    }

    /// Energies of all points, of the list as it is.
    fn see(
        &self,
        body: &Body<D>,
        list: &NearList<D>,
        position: &[[f64; 4]],
        out: &mut PointEnergiesMut,
    ) {
        self.said(body, false, list, position).see(body, out);
    }
}

/// A list for the displacements `u`, held where there is a horizon.
fn list_at<const D: usize, P: Potential>(
    body: &Body<D>,
    potential: &Mixture<P>,
    held: Option<f64>,
    u: FieldView<D>,
    simd: Simd,
) -> NearList<D> {
    let lines = match potential.is_side_by_side() {
        true => Lines::Mixed,
        false => Lines::ByKind,
    };
    let kinds = potential.kinds();
    let mut list = match held {
        Some(horizon) => {
            let of = |i, j| potential.of(i, j).map_or(0.0, |_| horizon);
            NearList::of_reference(body, Reaches::new(kinds, of), lines)
        }
        None => {
            let reaches = Reaches::new(kinds, |i, j| potential.cutoff(i, j));
            let skin = SKIN * reaches.longest();
            NearList::of_kinds(body, reaches, skin, lines)
        }
    };
    list.update(body, u, simd);
    list
}

/// An atom and one that is near to it.
struct NearPair<'a, const D: usize, P> {
    potential: &'a P,
    unlike: bool,
    /// Tile, line and lane.
    bond: [usize; 3],
    slot: usize,
    other: usize,
    /// From the first to the second (length), and its square.
    y: [f64; D],
    q: f64,
    /// The fourth numbers of both.
    slopes: [f64; 2],
}

impl<const D: usize, P: Potential> NearPair<'_, D, P> {
    /// Its tangent, times `scale`.
    fn tangent(&self, scale: f64) -> BondTangent<D> {
        let slopes = if P::EMBEDDED { self.slopes } else { [0.0; 2] };
        let ends = [self.slot, self.other];
        BondTangent::of_potential(self.potential, ends, self.y, slopes, scale, self.unlike)
    }
}

impl<const D: usize, P: Potential> Held<D> for CurrentAtoms<D, P> {
    fn list(&self) -> &NearList<D> {
        &self.list
    }

    fn list_mut(&mut self) -> &mut NearList<D> {
        &mut self.list
    }

    fn pulls(&self, first: &[u32], out: &mut [[f64; D]]) {
        out.fill([0.0; D]);
        self.each_near(|near| {
            let [tile, line, lane] = near.bond;
            let place = (first[tile] as usize + line) * TILE + lane;
            out[place] = near.tangent(2.0).force().force;
        });
    }
}

impl<const D: usize, P: Potential> Interaction<D> for CurrentAtoms<D, P> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        match self.held {
            Some(_) => "reference",
            None => "neighbours",
        }
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        _: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let tally = self.ready(body, u);
        if let Some(seen) = seen {
            self.see(body, &self.list, self.list.positions(), seen);
        }
        let kernel = Forces {
            view: self.view(&self.list, self.list.positions().as_ptr()),
            f: crate::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            volume: &body.volume,
        };
        run_blocks(self.simd, &kernel, self.list.blocks());
        tally
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        self.list.update(body, u, self.simd);
        let list = &self.list;
        [
            self.said(body, false, list, list.positions()).energy(body),
            0.0,
        ]
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        if let Some(position) = self.list.positions_at(u, self.simd) {
            self.see(body, &self.list, &position, out);
        } else {
            let list = list_at(body, &self.potential, self.held, u, self.simd);
            self.see(body, &list, list.positions(), out);
        }
    }

    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        let rest = body.at_rest();
        let strain = |mut position: Vec<[f64; 4]>| {
            // what is nowhere stays there
            for x in position.iter_mut().filter(|x| x[0].is_finite()) {
                let moved = along(gradient, &x[..D]);
                for a in 0..D {
                    x[a] += moved[a];
                }
            }
            position
        };
        // of a list that is held some may have been taken out
        let held = self
            .held
            .and(self.list.positions_at(view(&rest), self.simd));
        if let Some(position) = held {
            self.see(body, &self.list, &strain(position), out);
        } else {
            let list = list_at(body, &self.potential, self.held, view(&rest), self.simd);
            self.see(body, &list, &strain(list.positions().to_vec()), out);
        }
    }

    fn is_potential(&self) -> bool {
        true
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        self.ready(body, u);
        let mut density = vec![0.0; if P::EMBEDDED { body.len } else { 0 }];
        self.each_near(|near| {
            if P::EMBEDDED {
                density[near.slot] += near.potential.density(near.q);
            }
            visit(near.tangent(2.0 / body.volume.at(near.slot)));
        });
        let kind = |slot| match self.potential.kinds() {
            1 => 0,
            _ => body.material_of(slot),
        };
        let slots = density.iter().enumerate();
        self.curvatures =
            Curvatures::of(slots.map(|(slot, d)| (self.potential.own(kind(slot)), *d)));
    }

    fn gain(&self, slot: usize) -> f64 {
        self.curvatures.at(slot)
    }

    /// Pairs of the current list that are within the cut-off now.
    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        let id = body.id_of();
        self.each_near(|near| {
            if id(near.slot) < id(near.other) {
                visit(near.slot, near.other, near.y, BondStatus::Whole);
            }
        });
    }

    fn each_partner(&self, _: &Body<D>, visit: &mut EachBond<D>) {
        self.each_near(|near| visit(near.slot, near.other, near.y, BondStatus::Whole));
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        self.check(body, &[u]);
        self.ready(body, u);
        let list = &self.list;
        Some(self.said(body, true, list, list.positions()).virial(body))
    }

    fn directed_bonds(&self) -> u64 {
        self.family.iter().map(|n| *n as u64).sum()
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        self.family[slot] as usize
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        self.list.archive(body, self.simd, archive);
    }

    fn bytes(&self) -> usize {
        self.list.bytes() + 2 * self.family.len()
    }
}
