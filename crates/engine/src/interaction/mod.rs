//! A law bound to a family: forces, energies and bonds of a body. Compiled once per law and family, called once
//! per sweep.

pub(crate) mod atoms;
pub(crate) mod bond;
pub mod contact;
pub mod friction;
mod history;
pub(crate) mod interface;
pub(crate) mod linear;
pub mod list;
pub(crate) mod material;
pub(crate) mod micromoduli;
pub mod pairs;
pub mod repulsion;
pub(crate) mod scale;
pub(crate) mod several;
pub mod stencil;
pub mod tangent;
pub mod weight;

use crate::body::{Body, Field, Identity};
use crate::columns::Declaration;
use crate::error::BuildError;
use crate::execute::blocks::Shared;
use crate::execute::lane::Lane;
use crate::law::BondFactors;
use crate::law::Law;
use crate::law::solid::eam_like::Solid;
use crate::spec::{CrackKind, Release};
pub use repulsion::{PairTable, Repulsion};
use std::ops::AddAssign;
pub use tangent::{BondTangent, Channel};

/// What a sweep reports besides its forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tally {
    /// Directed bonds that broke.
    pub broken: u64,
    /// Energy that they held (energy).
    pub released: f64,
    /// What laws with memory dissipated (energy).
    pub dissipated: f64,
    /// The lowest critical `e` of any point from now on, where that is counted.
    pub least_critical: f64,
    /// Why these forces mean nothing.
    pub fault: Option<Fault>,
}

/// A state that a law has no answer to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// The embedding energy has no meaning at this density of this slot.
    Density { slot: usize, density: f64 },
    /// Neighbours of a chain went through each other (slots).
    Crossing { i: usize, j: usize },
}

impl Fault {
    /// The same of other slots.
    fn at(self, slot_of: impl Fn(usize) -> usize) -> Fault {
        match self {
            Fault::Density { slot, density } => Fault::Density {
                slot: slot_of(slot),
                density,
            },
            Fault::Crossing { i, j } => Fault::Crossing {
                i: slot_of(i),
                j: slot_of(j),
            },
        }
    }
}

impl Default for Tally {
    fn default() -> Tally {
        Tally {
            broken: 0,
            released: 0.0,
            dissipated: 0.0,
            least_critical: f64::INFINITY,
            fault: None,
        }
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, o: Tally) {
        self.broken += o.broken;
        self.released += o.released;
        self.dissipated += o.dissipated;
        self.least_critical = self.least_critical.min(o.least_critical);
        self.fault = self.fault.or(o.fault);
    }
}

/// Critical stretch of one material: `s0 = s00 − α s_min`; infinite `s00` never breaks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Toughness {
    pub s00: f64,
    pub alpha: f64,
}

/// May bonds break in this sweep?
#[derive(Debug, Clone, Copy)]
pub enum Sweep<'a, const D: usize> {
    /// Forces, test and break, then the new critical stretch. A bond that lets go at once missed the half step that
    /// ends here, one that does after its force pulls over half the next step, and the others pull over that half step
    /// with pressures of before; `v` (velocity of the step's middle, images too) and `steps`, the time steps that end
    /// and begin here, say what that costs. The first evaluation of a run ends no step: 0.
    Evolve {
        v: &'a Field<D>,
        steps: [f64; 2],
        release: Release,
    },
    /// Forces only; the memory stays as it is.
    Hold,
}

/// How the point fields of a law follow from the weighted volume of each point.
#[derive(Debug, Clone)]
pub enum PointConstants {
    /// No fields.
    None,
    /// Field 0 is a constant per material.
    PerMaterial(Vec<f64>),
    /// EAM-like: per material `(n, κ, β)`.
    Solid(Vec<Solid>),
}

/// Is a bond of the reference family whole?
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BondState {
    Whole,
    Broken,
}

/// The motion of a sweep in which bonds break.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<'a, const D: usize> {
    v: &'a Field<D>,
    steps: [f64; 2],
    release: Release,
}

impl<const D: usize> Motion<'_, D> {
    /// Energy density that a breaking bond takes from the motion, by pulling over half a step once more, or gives to it by not
    /// doing so over half a step: half of `½Δt F·(v_j − v_i)`, the other half is the partner's. `rate` is
    /// `(ξ+η)·(v_j − v_i)`.
    #[inline(always)]
    fn farewell<L: Lane>(&self, pull: L, rate: L) -> L {
        let time = match self.release {
            Release::AtOnce => -0.25 * self.steps[0],
            Release::AfterForce => 0.25 * self.steps[1],
        };
        L::splat(time) * pull * rate
    }

    /// Half the step that begins (time).
    fn half_step(&self) -> f64 {
        0.5 * self.steps[1]
    }
}

impl<'a, const D: usize> Sweep<'a, D> {
    /// `None`: nothing breaks.
    fn motion(self) -> Option<Motion<'a, D>> {
        match self {
            Sweep::Evolve { v, steps, release } => Some(Motion { v, steps, release }),
            Sweep::Hold => None,
        }
    }
}

/// Energies and dilatation of all points, per slot.
#[derive(Debug, Clone, Default)]
pub struct PointEnergies {
    /// Strain energy density of bonds (energy / volume).
    pub strain: Vec<f64>,
    /// Energy density of repulsion inside the family (energy / volume).
    pub repulsion: Vec<f64>,
    /// Dilatation θ (–).
    pub dilatation: Vec<f64>,
    /// `Σ k r0²` over whole bonds, of peridynamic laws: over the weighted volume m where there is one (–).
    pub whole: Vec<f64>,
}

impl PointEnergies {
    /// Make dilatations of `Σ k r0² s`: times `n/m` for laws that share, else `D Σ k r0² s / Σ k r0²`. `factors` of a
    /// slot are n and 1/m.
    fn dilate<W: Law, const D: usize>(
        &mut self,
        body: &Body<D>,
        factors: impl Fn(usize) -> [f64; 2],
    ) {
        for &slot in &body.slots {
            let i = slot as usize;
            let share = self.dilatation[i];
            if W::SHARES {
                let [n, per_m] = factors(i);
                self.dilatation[i] = n * per_m * share;
                self.whole[i] *= per_m;
            } else if self.whole[i] > 0.0 {
                self.dilatation[i] = D as f64 * share / self.whole[i];
            }
        }
    }

    /// All zero, for so many slots.
    pub fn zeros(&mut self, len: usize) {
        for field in [
            &mut self.strain,
            &mut self.repulsion,
            &mut self.dilatation,
            &mut self.whole,
        ] {
            field.clear();
            field.resize(len, 0.0);
        }
    }
}

/// Where an energy pass writes, per slot.
#[derive(Clone, Copy)]
struct EnergyFields {
    strain: Shared,
    repulsion: Shared,
    share: Shared,
    weight: Shared,
}

/// Kernels have two point fields, and laws that share a scalar keep it and the weighted volume there.
///
/// # Panics
/// If the law says otherwise.
fn laws_fields<W: Law>() {
    assert!(
        W::FIELDS <= 2 && (!W::SHARES || W::FIELDS == 2),
        "a law has at most two point fields, and two if it shares a scalar"
    );
}

/// Axes of the components of a virial.
const VIRIAL: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Add `factor · y ⊗ pull` to a virial.
pub(crate) fn add_virial<const D: usize>(
    sum: &mut [f64; 6],
    pull: &[f64; D],
    y: &[f64; D],
    factor: f64,
) {
    for (sum, (m, n)) in sum.iter_mut().zip(VIRIAL) {
        if n < D {
            *sum += factor * y[m] * pull[n];
        }
    }
}

/// `gradient · x`
fn along<const D: usize>(gradient: &[[f64; D]; D], x: &[f64]) -> [f64; D] {
    gradient.map(|row| row.iter().zip(x).map(|(g, x)| g * x).sum())
}

/// A directed bond, and what it does to the point that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondForce<const D: usize> {
    /// Slots of points, images resolved.
    pub i: usize,
    pub j: usize,
    /// From i to j now; of linear laws in the reference (length).
    pub y: [f64; D],
    /// What i gets from the bond: that of its own force state and that of its partner's (force / volume).
    pub force: [f64; D],
}

/// A law on a family, made for one body.
///
/// What kernels read and write without looking is checked here, once for each sweep: methods that take a body refuse another one
/// than that of [`made_for`](Interaction::made_for), and fields of another length.
pub trait Interaction<const D: usize>: Send + Sync {
    /// The body that it was made for.
    fn made_for(&self) -> Identity;

    /// Does a sweep over this body with these fields stay inside what was made?
    ///
    /// # Panics
    /// If the body is another one, or a field has another length than it.
    fn check(&self, body: &Body<D>, fields: &[&Field<D>]) {
        assert!(
            body.identity == self.made_for(),
            "an interaction made for another body: make one for this body"
        );
        let columns = fields.iter().flat_map(|f| f.iter());
        if let Some(column) = { columns }.find(|c| c.len() != body.len) {
            panic!(
                "a field of {} slots, the body has {}: fields come from `at_rest` or `zeros(body.len())`",
                column.len(),
                body.len
            );
        }
    }

    /// Write the force density of all bonds (and repulsion inside the family) into `f`, slot by slot; advance the
    /// bonds' memory if asked to. Images of `u` must be fresh. What is `seen` are the energies of the bonds that are
    /// whole before any breaks, as [observe](Interaction::observe) gives them, at less cost.
    ///
    /// # Panics
    /// If the body is another one than that of [`made_for`](Interaction::made_for), or a field does not have its length.
    fn forces(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergies>,
    ) -> Tally {
        self.check(body, &[u, &*f]);
        if let Sweep::Evolve { v, .. } = sweep {
            self.check(body, &[v]);
        }
        // SAFETY: just checked
        unsafe { self.forces_unchecked(body, u, f, sweep, seen) }
    }

    /// [`forces`](Interaction::forces).
    ///
    /// # Safety
    /// The body and all fields pass [`check`](Interaction::check).
    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergies>,
    ) -> Tally;

    /// Strain energy of bonds and energy of repulsion inside the family at `u` (energy), without allocating.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn energy(&mut self, body: &Body<D>, u: &Field<D>) -> [f64; 2] {
        self.check(body, &[u]);
        // SAFETY: just checked
        unsafe { self.energy_unchecked(body, u) }
    }

    /// [`energy`](Interaction::energy).
    ///
    /// # Safety
    /// The body and the field pass [`check`](Interaction::check).
    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: &Field<D>) -> [f64; 2];

    /// Energy densities and dilatation of all points at `u`.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn observe(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        self.check(body, &[u]);
        // SAFETY: just checked
        unsafe { self.observe_unchecked(body, u, out) }
    }

    /// [`observe`](Interaction::observe).
    ///
    /// # Safety
    /// The body and the field pass [`check`](Interaction::check).
    unsafe fn observe_unchecked(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies);

    /// Energy densities and dilatation of all points under a homogeneous displacement gradient `∂u_a/∂x_b`, so small that
    /// nobody gets other neighbours; periodic images move like everything else.
    fn observe_gradient(&self, body: &Body<D>, gradient: &[[f64; D]; D], out: &mut PointEnergies) {
        // images of a grid have displacements of their own
        let mut u = body.at_rest();
        let images = body.images.iter().map(|(copy, _)| copy);
        for &s in body.slots.iter().chain(images) {
            let moved = along(gradient, &body.position(s as usize));
            for a in 0..D {
                u[a][s as usize] = moved[a];
            }
        }
        self.observe(body, &u, out);
    }

    /// Is it a potential between atoms, per atom and not per volume?
    fn is_potential(&self) -> bool {
        false
    }

    /// Every directed bond that is whole with its tangent at `u`, images of which are fresh, in order of slots. Repulsion inside
    /// the family is left out. The scalars' gains are in [`Interaction::gain`] afterwards.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn tangents(&mut self, body: &Body<D>, u: &Field<D>, visit: &mut dyn FnMut(BondTangent<D>)) {
        self.check(body, &[u]);
        // SAFETY: just checked
        unsafe { self.tangents_unchecked(body, u, visit) }
    }

    /// [`tangents`](Interaction::tangents).
    ///
    /// # Safety
    /// The body and the field pass [`check`](Interaction::check).
    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    );

    /// `∂p_i / ∂(Σ share)` of a slot, since the last call of [`Interaction::tangents`].
    fn gain(&self, _slot: usize) -> f64 {
        0.0
    }

    /// Every undirected bond of the reference family once: slots i < j (images resolved), reference vector ξ.
    fn each_bond(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondState));

    /// What enumerates the bonds: `"stencil"`, `"list"` or `"neighbours"`.
    fn family(&self) -> &'static str;

    /// Σ over pairs of distance times force, xx yy zz xy xz yz (energy), positive where pairs repel; `None`: the law has no forces
    /// of single bonds.
    fn virial(&mut self, body: &Body<D>, u: &Field<D>) -> Option<[f64; 6]> {
        let mut virial = [0.0; 6];
        let known = self.each_force(body, u, &mut |bond| {
            let factor = -0.5 * body.volume.at(bond.i);
            add_virial(&mut virial, &bond.force, &bond.y, factor);
        });
        known.then_some(virial)
    }

    /// Damage `1 − Σ V_j (whole) / Σ V_j (family)` per slot; 0 for points without a family.
    fn damage(&self, _body: &Body<D>, out: &mut [f64]) {
        out.fill(0.0);
    }

    /// Cut bonds whose end points satisfy `crosses`. Returns directed bonds cut. Call before the first sweep.
    fn cut(
        &mut self,
        _body: &Body<D>,
        _kind: CrackKind,
        _crosses: &(dyn Fn([f64; D], [f64; D]) -> bool + Sync),
    ) -> u64 {
        0
    }

    /// Multiply the parts of the force density at slot i, of its bond to slot j (an image, maybe) `cell` cells away, by
    /// `factors(i, j, cell)`; energies, and what breaking releases, follow. Weighted volumes become those of full families,
    /// critical stretches stay. Factors of several calls are multiplied. Call before the first sweep.
    fn scale_bonds(
        &mut self,
        _body: &Body<D>,
        _factors: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) -> Result<(), BuildError> {
        Err(BuildError::unsupported(
            "bonds",
            "factors of bonds need a solid (pmb, lps) or springs on a lattice",
        ))
    }

    /// Volume with which the bond along ξ acts on slot i, and its factors, where there are any.
    fn reached(
        &self,
        _body: &Body<D>,
        _i: usize,
        _xi: [f64; D],
    ) -> Option<(f64, BondFactors<f64>)> {
        None
    }

    /// Compute what depends on the family (weighted volumes); after all `Absent` cuts, before the first sweep.
    fn prepare(&mut self, _body: &Body<D>) {}

    /// How far action is from reaction, as `Soundness::asymmetry` of a linear body; given micromoduli need not be
    /// symmetric, and then there is no energy whose slope the forces are.
    fn asymmetry(&self) -> f64 {
        0.0
    }

    /// Directed bonds of the reference family.
    fn directed_bonds(&self) -> u64;

    /// Size of the family of every slot.
    fn family_size(&self, body: &Body<D>, slot: usize) -> usize;

    /// Directed pairs whose distance is within round-off of the horizon, in or out, where that was counted.
    fn near_horizon(&self) -> u64 {
        0
    }

    /// Point field of the law at a slot; 0 where the law has none.
    fn point_field(&self, _field: usize, _slot: usize) -> f64 {
        0.0
    }

    /// Is the pair bonded or repelled inside the family (so that contact outside must leave it alone)?
    fn in_family(&self, _body: &Body<D>, _i: usize, _j: usize) -> bool {
        false
    }

    /// Columns that the law has of points and of bonds: what it remembers ([`Life::Persistent`](crate::columns::Life)) and what it
    /// answers at the displacements of now ([`Life::Derived`](crate::columns::Life)). Names are those of the field, none twice.
    fn columns(&self) -> Vec<Declaration> {
        vec![]
    }

    /// Writes the values of one of its [columns](Interaction::columns) into `out`: [`stored`](crate::columns::Shape::stored)
    /// numbers, of points for each slot of the body (0 where there is no point), of bonds for each directed bond of the reference
    /// family in order of slots, broken ones too. Images of `u` must be fresh. False: there is no such column, and `out` is empty.
    fn read_column(&self, _body: &Body<D>, _u: &Field<D>, _name: &str, out: &mut Vec<f64>) -> bool {
        out.clear();
        false
    }

    /// Sets a persistent column to values in the order in which [`read_column`](Interaction::read_column) gives them, after
    /// [`prepare`](Interaction::prepare). False: there is no such column, it follows from others, or the number of values is
    /// another; then nothing is changed.
    fn write_column(&mut self, _body: &Body<D>, _name: &str, _values: &[f64]) -> bool {
        false
    }

    /// Every directed bond that pulls or pushes at `u`, in order of slots, with the force density that its point gets from it: their
    /// sum is that of [`forces`](Interaction::forces) without breaking. Repulsion inside the family counts. Images of `u` must be
    /// fresh. False: the law has no forces of single bonds, and nothing is visited.
    fn each_force(
        &mut self,
        _body: &Body<D>,
        _u: &Field<D>,
        _visit: &mut dyn FnMut(BondForce<D>),
    ) -> bool {
        false
    }

    /// The memory of bonds, as it is laid out: bits of whole bonds and critical values of `e`.
    fn memory(&self) -> (&[u8], &[f64]) {
        (&[], &[])
    }

    /// Bytes held.
    fn bytes(&self) -> usize;
}
