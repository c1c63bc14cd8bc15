//! A potential as a smoothed peridynamic material: nodes move, and the atoms of the reference are carried along.
//!
//! Chapter 4 of sandia2010 reads a potential as force states `∂U^(j)/∂x_k` ((4.0.122)–(4.0.124)) and averages fields with φ
//! ((4.0.56)–(4.0.60)); chapter 1 asks for the averaged material. With `T̄[x]⟨q − x⟩ = Σ_jk ∂U^(j)/∂x_k φ(x − X_j) φ(q − X_k)` the force density is
//! `∫{T̄[x]⟨q − x⟩ − T̄[q]⟨x − q⟩} dq = Σ_j F_j φ(x − X_j)`, since `∫φ = 1` and `Σ_k ∂U^(j)/∂x_k = 0`, and the density `ρ̄ = Σ_j m_j φ(x − X_j)`.
//!
//! Here x and q are nodes: `V_g φ(x_g − X_j)` becomes the weight `w_g(X_j)` of [`family::nodes`](crate::family::nodes), a quadrature that
//! gives every quadratic field exactly, where a plain sum over nodes would not:
//!
//! `u(X_j) = Σ_g w_g(X_j) u_g`, `f_g V_g = Σ_j w_g(X_j) F_j`, `m_g = Σ_j m_j w_g(X_j)`.
//!
//! Forces are slopes of the atoms' energy by the nodes' displacements, so energy, momentum and (linear fields are reproduced) angular momentum are
//! conserved. The mass is lumped.

use crate::body::{Body, Field, FieldView, FieldViewMut, Identity, view, view_mut, zeros};
use crate::execute::blocks::for_each_piece;
use crate::family::nodes::Nodes;
use crate::interaction::{
    BondForce, BondStatus, BondTangent, Crosses, EachBond, EachForce, EachTangent, Gradient,
    Interaction, PointEnergies, PointEnergiesMut, Sweep, Tally,
};
use crate::spec::CrackKind;
use crate::state::Archive;
use std::collections::BTreeMap;

/// An interaction of atoms that nodes carry along.
pub struct Smoothed<const D: usize> {
    nodes: Identity,
    atoms: Body<D>,
    inner: Box<dyn Interaction<D>>,
    carried: Nodes,
    /// Do bonds between atoms break?
    breaks: bool,
    /// Displacements and force densities of atoms.
    u: Field<D>,
    f: Field<D>,
    /// By slot: nodes that feel each other, those with a greater slot.
    family: Vec<Vec<u32>>,
    /// By slot, how many.
    sizes: Vec<u32>,
}

impl<const D: usize> Smoothed<D> {
    /// `inner` is made for `atoms`, `carried` says how much each of the `nodes` counts for them, `breaks` whether bonds of atoms do.
    pub fn new(
        nodes: &Body<D>,
        atoms: Body<D>,
        inner: Box<dyn Interaction<D>>,
        carried: Nodes,
        breaks: bool,
    ) -> Self {
        let u = atoms.at_rest();
        let family = family(&atoms, inner.as_ref(), &carried, |_| true);
        let mut sizes = vec![0; nodes.len];
        for (g, others) in family.iter().enumerate() {
            sizes[g] += others.len() as u32;
            others.iter().for_each(|h| sizes[*h as usize] += 1);
        }
        Smoothed {
            nodes: nodes.identity,
            f: u.clone(),
            u,
            breaks,
            atoms,
            inner,
            carried,
            family,
            sizes,
        }
    }

    /// Displacements of atoms where nodes have these.
    fn carry(&self, u: FieldView<D>, mut of_atoms: FieldViewMut<D>) {
        let points = &self.carried.points;
        let mut moved = vec![[0.0; D]; points.len()];
        for_each_piece(&mut moved, |first, piece| {
            for (moved, (_, row)) in piece.iter_mut().zip(&points[first..]) {
                for seen in row {
                    for a in 0..D {
                        moved[a] = seen.weight.mul_add(u[a][seen.node as usize], moved[a]);
                    }
                }
            }
        });
        for (moved, (slot, _)) in moved.iter().zip(points) {
            (0..D).for_each(|a| of_atoms[a][*slot as usize] = moved[a]);
        }
        self.atoms.exchange.fill_field(&mut of_atoms);
    }

    fn carried(&self, u: FieldView<D>) -> Field<D> {
        let mut of_atoms = self.atoms.at_rest();
        self.carry(u, view_mut(&mut of_atoms));
        of_atoms
    }

    /// What atoms have per volume as what nodes have per volume.
    fn gather(&self, nodes: &Body<D>, of_atoms: &[f64], out: &mut [f64]) {
        let atom = |n: u32| {
            let slot = self.carried.points[n as usize].0 as usize;
            self.atoms.volume.at(slot) * of_atoms[slot]
        };
        for_each_piece(out, |first, piece| {
            for (g, (out, of)) in piece.iter_mut().zip(&self.carried.of[first..]).enumerate() {
                *out = 0.0;
                if !of.is_empty() {
                    let sum: f64 = of.iter().map(|(n, w)| w * atom(*n)).sum();
                    *out = sum / nodes.volume.at(first + g);
                }
            }
        });
    }

    fn gather_energies(&self, nodes: &Body<D>, seen: &PointEnergies, out: &mut PointEnergiesMut) {
        out.zeros(nodes.len);
        self.gather(nodes, &seen.strain, out.strain);
    }

    /// The node that carries most of an atom.
    fn carrier(&self, atom: u32) -> usize {
        let (_, row) = &self.carried.points[atom as usize];
        let most = { row.iter() }.max_by(|a, b| a.weight.total_cmp(&b.weight));
        most.map_or(0, |seen| seen.node as usize)
    }

    /// Each atom's nodes, by slot of atoms.
    fn places(&self) -> Vec<u32> {
        let mut place = vec![u32::MAX; self.atoms.len];
        for (n, (slot, _)) in self.carried.points.iter().enumerate() {
            place[*slot as usize] = n as u32;
        }
        place
    }
}

/// Nodes that atoms with such a bond tie to each other: those of one atom or of both.
fn family<const D: usize>(
    atoms: &Body<D>,
    inner: &dyn Interaction<D>,
    carried: &Nodes,
    such: impl Fn(BondStatus) -> bool,
) -> Vec<Vec<u32>> {
    let mut place = vec![u32::MAX; atoms.len];
    for (n, (slot, _)) in carried.points.iter().enumerate() {
        place[*slot as usize] = n as u32;
    }
    // an atom's own, if it is bonded to any, and those
    let mut near: Vec<Vec<u32>> = vec![vec![]; carried.points.len()];
    inner.each_bond(atoms, &mut |i, j, _, state| {
        if such(state) {
            let ends = [place[i], place[j]];
            ends.iter().for_each(|end| near[*end as usize].extend(ends));
        }
    });
    let mut family = vec![vec![]; carried.of.len()];
    for_each_piece(&mut family, |first, piece| {
        for (g, others) in piece.iter_mut().enumerate() {
            let own = (first + g) as u32;
            let mut atoms: Vec<u32> = { carried.of[first + g].iter() }
                .flat_map(|(n, _)| &near[*n as usize])
                .copied()
                .collect();
            atoms.sort_unstable();
            atoms.dedup();
            let rows = atoms.iter().flat_map(|n| &carried.points[*n as usize].1);
            others.extend(rows.map(|seen| seen.node).filter(|h| *h > own));
            others.sort_unstable();
            others.dedup();
        }
    });
    family
}

/// A field that is put back.
fn taken<const D: usize>(field: &mut Field<D>) -> Field<D> {
    std::mem::replace(field, zeros(0))
}

/// The matrix of a node's partner.
type Block<const D: usize> = [[f64; D]; D];

impl<const D: usize> Interaction<D> for Smoothed<D> {
    fn made_for(&self) -> Identity {
        self.nodes
    }

    fn family(&self) -> &'static str {
        "smoothed"
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let [mut moved, mut own] = [&mut self.u, &mut self.f].map(taken);
        self.carry(u, view_mut(&mut moved));
        let mut energies = seen.is_some().then(PointEnergies::default);
        let mut of_atoms = energies.as_mut().map(|e| e.for_slots(self.atoms.len));
        let velocity;
        let sweep = match sweep {
            Sweep::Evolve { v, steps, breakage } if self.breaks => {
                velocity = self.carried(v);
                Sweep::Evolve {
                    v: view(&velocity),
                    steps,
                    breakage,
                }
            }
            Sweep::Evolve { .. } | Sweep::Hold => Sweep::Hold,
        };
        let tally = self.inner.forces(
            &self.atoms,
            view(&moved),
            view_mut(&mut own),
            sweep,
            of_atoms.as_mut(),
        );
        for (f, own) in f.iter_mut().zip(&own) {
            self.gather(body, own, f);
        }
        if let (Some(seen), Some(energies)) = (seen, energies) {
            self.gather_energies(body, &energies, seen);
        }
        (self.u, self.f) = (moved, own);
        let place = || self.places();
        Tally {
            fault: tally
                .fault
                .map(|fault| fault.at(|atom| self.carrier(place()[atom]))),
            ..tally
        }
    }

    unsafe fn energy_unchecked(&mut self, _: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let mut moved = taken(&mut self.u);
        self.carry(u, view_mut(&mut moved));
        let energy = self.inner.energy(&self.atoms, view(&moved));
        self.u = moved;
        energy
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        let mut seen = PointEnergies::default();
        self.inner.observe(
            &self.atoms,
            view(&self.carried(u)),
            &mut seen.for_slots(self.atoms.len),
        );
        self.gather_energies(body, &seen, out);
    }

    /// Linear fields are reproduced: the atoms have the same gradient.
    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        let mut seen = PointEnergies::default();
        self.inner
            .observe_gradient(&self.atoms, gradient, &mut seen.for_slots(self.atoms.len));
        self.gather_energies(body, &seen, out);
    }

    fn has_many_body(&self) -> bool {
        true
    }

    /// `K_gh = Σ_ij w_g(X_i) K_ij w_h(X_j)`, sums of channels multiplied out.
    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        let moved = self.carried(u);
        let mut bonds: Vec<BondTangent<D>> = vec![];
        self.inner
            .tangents(&self.atoms, view(&moved), &mut |bond| bonds.push(bond));
        let place = self.places();
        let points = &self.carried.points;
        let row = |slot: usize| &points[place[slot] as usize].1;
        // δp of atoms, by nodes
        let mut sums: Vec<BTreeMap<u32, [f64; D]>> = vec![BTreeMap::new(); points.len()];
        for bond in &bonds {
            let gain = self.inner.gain(bond.i);
            if gain == 0.0 {
                continue;
            }
            let sum = &mut sums[place[bond.i] as usize];
            for (end, sign) in [(bond.j, gain), (bond.i, -gain)] {
                for seen in row(end) {
                    let to = sum.entry(seen.node).or_insert([0.0; D]);
                    (0..D).for_each(|a| to[a] += sign * seen.weight * bond.share[a]);
                }
            }
        }
        let mut rows: Vec<BTreeMap<u32, Block<D>>> = vec![BTreeMap::new(); body.len];
        for same in bonds.chunk_by(|a, b| a.i == b.i) {
            let i = same[0].i;
            // of the force density on the atom, by nodes
            let mut own: BTreeMap<u32, Block<D>> = BTreeMap::new();
            let mut add = |node: u32, of: &dyn Fn(usize, usize) -> f64| {
                let block = own.entry(node).or_insert([[0.0; D]; D]);
                for a in 0..D {
                    for b in 0..D {
                        block[a][b] += of(a, b);
                    }
                }
            };
            for bond in same {
                for (end, sign) in [(bond.j, 1.0), (i, -1.0)] {
                    for seen in row(end) {
                        add(seen.node, &|a, b| sign * seen.weight * bond.stiffness[a][b]);
                    }
                }
                for (end, pull) in [i, bond.j].into_iter().zip(bond.pull) {
                    for (node, sum) in &sums[place[end] as usize] {
                        add(*node, &|a, b| pull[a] * sum[b]);
                    }
                }
            }
            for seen in row(i) {
                let g = seen.node as usize;
                let scale = seen.weight * self.atoms.volume.at(i) / body.volume.at(g);
                for (h, block) in &own {
                    let to = rows[g].entry(*h).or_insert([[0.0; D]; D]);
                    for a in 0..D {
                        (0..D).for_each(|b| to[a][b] += scale * block[a][b]);
                    }
                }
            }
        }
        for (g, row) in rows.into_iter().enumerate() {
            for (h, block) in row.into_iter().filter(|(h, _)| *h as usize != g) {
                let h = h as usize;
                let xi = between(body, g, h);
                let y = crate::array::from_fn(|a| xi[a] + u[a][h] - u[a][g]);
                visit(BondTangent::direct(g, h, y, block));
            }
        }
    }

    /// Nodes that feel each other: a bond is as long as that to the nearest image, and whole as long as a whole bond of atoms ties them.
    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        let whole = |state| state == BondStatus::Whole;
        let tied = self
            .breaks
            .then(|| family(&self.atoms, self.inner.as_ref(), &self.carried, whole));
        for (g, others) in self.family.iter().enumerate() {
            for &h in others {
                let tied = tied.as_ref().is_none_or(|t| t[g].binary_search(&h).is_ok());
                let state = match tied {
                    true => BondStatus::Whole,
                    false => BondStatus::Broken,
                };
                let h = h as usize;
                visit(g, h, between(body, g, h), state);
            }
        }
    }

    /// The mean of the atoms, by how much each counts for a node; some count less than nothing, so that it is held between 0 and 1.
    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        let mut of_atoms = vec![0.0; self.atoms.len];
        self.inner.damage(&self.atoms, &mut of_atoms);
        self.gather(body, &of_atoms, out);
        out.iter_mut().for_each(|d| *d = d.clamp(0.0, 1.0));
    }

    /// Bonds between atoms are what is cut.
    fn cut(&mut self, _: &Body<D>, kind: CrackKind, crosses: &Crosses<D>) -> u64 {
        self.inner.cut(&self.atoms, kind, crosses)
    }

    /// `T̄[x_g]⟨x_h − x_g⟩ − T̄[x_h]⟨x_g − x_h⟩ = Σ_ij w_g(X_i) w_h(X_j) f_ij` between nodes and images of nodes.
    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        let moved = self.carried(u);
        let mut bonds: Vec<BondForce<D>> = vec![];
        let known = self
            .inner
            .each_force(&self.atoms, view(&moved), &mut |bond| bonds.push(bond));
        if !known {
            return false;
        }
        let place = self.places();
        let (atoms, points) = (&self.atoms, &self.carried.points);
        let at = |slot: usize| -> [f64; D] {
            let x = atoms.position(slot);
            crate::array::from_fn(|a| x[a] + moved[a][slot])
        };
        let period = |a: usize| body.period[a];
        // partner, its image, the force and the part of the own state
        type Pulls<const D: usize> = BTreeMap<(u32, [i32; 3]), [[f64; D]; 2]>;
        let own = bonds.iter().all(|b| b.own.is_some());
        // of atoms: what the nodes of their partners do, and by the own states what their own nodes do
        let mut of_atoms: Vec<Pulls<D>> = vec![BTreeMap::new(); points.len()];
        for bond in &bonds {
            let (from, to) = (at(bond.i), at(bond.j));
            // the image of the atom that pulls
            let off: [i32; 3] = crate::array::from_fn(|a| match a < D {
                true => {
                    let whole = |p: f64| ((bond.y[a] + from[a] - to[a]) / p).round() as i32;
                    period(a).map_or(0, whole)
                }
                false => 0,
            });
            let state = bond.own.unwrap_or([0.0; D]);
            let pulls = &mut of_atoms[place[bond.i] as usize];
            for (end, off, force, state) in [
                (bond.j, off, bond.force, state),
                (bond.i, [0; 3], [0.0; D], state.map(|c| -c)),
            ] {
                for seen in &points[place[end] as usize].1 {
                    let image = crate::array::from_fn(|a| off[a] + i32::from(seen.image[a]));
                    let sum = pulls.entry((seen.node, image)).or_insert([[0.0; D]; 2]);
                    for a in 0..D {
                        sum[0][a] += seen.weight * force[a];
                        sum[1][a] += seen.weight * state[a];
                    }
                }
            }
        }
        let mut all: Vec<Pulls<D>> = vec![BTreeMap::new(); body.len];
        for ((slot, row), pulls) in points.iter().zip(&of_atoms) {
            for seen in row {
                let g = seen.node as usize;
                let scale = seen.weight * atoms.volume.at(*slot as usize) / body.volume.at(g);
                for ((h, image), [force, state]) in pulls {
                    let image = crate::array::from_fn(|a| image[a] - i32::from(seen.image[a]));
                    let sum = all[g].entry((*h, image)).or_insert([[0.0; D]; 2]);
                    for a in 0..D {
                        sum[0][a] += scale * force[a];
                        sum[1][a] += scale * state[a];
                    }
                }
            }
        }
        let node = |slot: usize| -> [f64; D] {
            let x = body.position(slot);
            crate::array::from_fn(|a| x[a] + u[a][slot])
        };
        for (g, pulls) in all.into_iter().enumerate() {
            for ((h, image), [force, state]) in pulls {
                // a node pulls nothing at itself
                if h as usize == g && image == [0; 3] {
                    continue;
                }
                let (from, to) = (node(g), node(h as usize));
                visit(BondForce {
                    i: g,
                    j: h as usize,
                    y: crate::array::from_fn(|a| {
                        to[a] - from[a] + f64::from(image[a]) * period(a).unwrap_or(0.0)
                    }),
                    force,
                    own: own.then_some(state),
                });
            }
        }
        true
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        self.check(body, &[u]);
        let moved = self.carried(u);
        self.inner.virial(&self.atoms, view(&moved))
    }

    fn directed_bonds(&self) -> u64 {
        self.sizes.iter().map(|n| u64::from(*n)).sum()
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        self.sizes[slot] as usize
    }

    fn archive(&mut self, _: &Body<D>, archive: &mut Archive<'_>) {
        self.inner.archive(&self.atoms, archive);
    }

    fn bytes(&self) -> usize {
        let family: usize = self.family.iter().map(Vec::len).sum();
        let columns: usize = self.u.iter().map(|c| 16 * c.len()).sum();
        self.inner.bytes() + self.carried.bytes() + 4 * (family + self.sizes.len()) + columns
    }
}

/// From one node to the nearest image of another in the reference.
fn between<const D: usize>(body: &Body<D>, g: usize, h: usize) -> [f64; D] {
    let (x, y) = (body.position(g), body.position(h));
    crate::array::from_fn(|a| {
        let d = y[a] - x[a];
        d - body.period[a].map_or(0.0, |p| p * (d / p).round())
    })
}
