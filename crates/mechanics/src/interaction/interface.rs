//! Bonds between two of several bodies: an interaction on the points of both that are near to the other, as a cloud of its own.
//!
//! Ranks that share the bodies all have the whole cloud, with copies of who is somebody else's, and sweep over all of it: each finds the same, takes the
//! forces on its own points, and the first one reports. So an interface is as many points on each rank as it has in one process.

use super::{
    BondFatigue, BondForce, BondTangent, Crosses, EachBond, EachForce, EachPair, EachTangent,
    FactorsOf, Gradient, Heals, Interaction, PointEnergies, PointEnergiesMut, Sweep, Tally,
    history,
};
use crate::body::{Body, Field, FieldView, FieldViewMut, view, view_mut, zeros};
use crate::columns::On;
use crate::error::BuildError;
use crate::spec::{CrackKind, Cycles};
use crate::state::Archive;

/// No slot.
const NONE: u32 = u32::MAX;

/// Which points of all an interface bonds, and where they are among its own.
struct Points<const D: usize> {
    /// In order of ids.
    cloud: Body<D>,
    /// Their slots in the body of all.
    slots: Vec<u32>,
    /// `[slots of all]`: their slots in the cloud.
    place: Vec<u32>,
    /// `[slots of the cloud]`: slots in the body of all.
    whole: Vec<u32>,
    /// `[slots of the cloud]`, where ranks share the bodies: ids among all points, and which are of this rank.
    shared: Option<(Vec<u32>, Vec<bool>)>,
    /// Is it this rank that reports?
    first: bool,
}

impl<const D: usize> Points<D> {
    fn take(&self, from: FieldView<D>, to: FieldViewMut<D>) {
        for (all, own) in self.slots.iter().zip(&self.cloud.slots) {
            for a in 0..D {
                to[a][*own as usize] = from[a][*all as usize];
            }
        }
    }

    fn add(&self, from: &[f64], to: &mut [f64]) {
        let all = self.slots.iter().zip(&self.cloud.slots);
        for (all, own) in all.filter(|(_, own)| self.is_here(**own as usize)) {
            to[*all as usize] += from[*own as usize];
        }
    }

    /// Is the point in a slot of the cloud of this rank?
    fn is_here(&self, own: usize) -> bool {
        self.shared.as_ref().is_none_or(|(_, here)| here[own])
    }

    /// Does one end of a bond come before the other?
    fn is_before(&self, i: usize, j: usize) -> bool {
        match &self.shared {
            Some((ids, _)) => ids[i] < ids[j],
            None => self.whole[i] < self.whole[j],
        }
    }

    /// A count of all of it, once of all ranks.
    fn counted(&self, count: u64) -> u64 {
        if self.first { count } else { 0 }
    }

    /// Adds the energies; dilatations are those of the bodies alone.
    fn add_energies(&self, seen: &PointEnergies, out: &mut PointEnergiesMut) {
        self.add(&seen.strain, out.strain);
        self.add(&seen.repulsion, out.repulsion);
    }

    fn whole(&self, slot: usize) -> usize {
        self.whole[slot] as usize
    }
}

/// Has an interaction a column of bonds of this name?
pub fn has_bonds<const D: usize>(bonds: &dyn Interaction<D>, name: &str) -> bool {
    let columns = bonds.columns();
    columns.iter().any(|c| c.name == name && c.on == On::Bonds)
}

/// An interface and its own columns.
pub struct Interface<const D: usize> {
    pub bonds: Box<dyn Interaction<D>>,
    points: Points<D>,
    u: Field<D>,
    v: Field<D>,
    f: Field<D>,
    seen: PointEnergies,
}

impl<const D: usize> Interface<D> {
    /// `cloud` has the points of `slots`, in this order, and `bonds` are on it. Ranks that share `body` all have the same cloud; slots may be those of copies.
    pub fn new(
        body: &Body<D>,
        cloud: Body<D>,
        slots: Vec<u32>,
        bonds: Box<dyn Interaction<D>>,
    ) -> Self {
        let mut place = vec![NONE; body.len];
        let mut whole = vec![NONE; cloud.len];
        for (all, own) in slots.iter().zip(&cloud.slots) {
            place[*all as usize] = *own;
            whole[*own as usize] = *all;
        }
        let shared = body.subdomain().map(|of| {
            let ids: Vec<u32> = { whole.iter() }
                .map(|all| of.of_slots().get(*all as usize).copied().unwrap_or(0))
                .collect();
            let here = ids.iter().map(|id| of.ids().binary_search(id).is_ok());
            let here = here.collect();
            (ids, here)
        });
        Interface {
            bonds,
            u: cloud.at_rest(),
            v: zeros(cloud.len),
            f: zeros(cloud.len),
            seen: PointEnergies::default(),
            points: Points {
                cloud,
                slots,
                place,
                whole,
                shared,
                first: body.is_first(),
            },
        }
    }

    /// [`archive`](Interaction::archive) of its bonds.
    pub fn archive_bonds(&mut self, archive: &mut Archive<'_>) {
        self.bonds.archive(&self.points.cloud, archive);
    }

    /// Critical values of `e` by slot of the body of all: NaN where it has no point, [`history::NEVER`] of bonds that never break.
    pub fn criticals(&self) -> Vec<f64> {
        let points = &self.points;
        let mut own = vec![];
        let name = history::ELONGATION;
        if !(self.bonds).read_column(&points.cloud, view(&self.u), name, &mut own) {
            own = vec![history::NEVER; points.cloud.len];
        }
        let at = |place: &u32| match *place {
            NONE => f64::NAN,
            place => own[place as usize],
        };
        points.place.iter().map(at).collect()
    }

    /// Adds its forces to `f`.
    pub fn forces(
        &mut self,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let points = &self.points;
        points.take(u, view_mut(&mut self.u));
        let sweep = match sweep {
            Sweep::Evolve { v, steps, breakage } => {
                points.take(v, view_mut(&mut self.v));
                Sweep::Evolve {
                    v: view(&self.v),
                    steps,
                    breakage,
                }
            }
            Sweep::Hold => Sweep::Hold,
        };
        let workspace = points.cloud.len;
        let mut watch = seen.is_some().then(|| self.seen.for_slots(workspace));
        let mut tally = self.bonds.forces(
            &points.cloud,
            view(&self.u),
            view_mut(&mut self.f),
            sweep,
            watch.as_mut(),
        );
        tally.fault = tally.fault.map(|fault| fault.at(|s| points.whole(s)));
        if !points.first {
            // they are those of the first rank, too
            tally = Tally {
                fault: tally.fault,
                ..Tally::default()
            };
        }
        for a in 0..D {
            points.add(&self.f[a], f[a]);
        }
        if let Some(seen) = seen {
            points.add_energies(&self.seen, seen);
        }
        tally
    }

    pub fn energy(&mut self, u: FieldView<D>) -> [f64; 2] {
        self.points.take(u, view_mut(&mut self.u));
        self.bonds.energy(&self.points.cloud, view(&self.u))
    }

    pub fn observe(&self, u: FieldView<D>, out: &mut PointEnergiesMut) {
        let mut own = self.points.cloud.at_rest();
        self.points.take(u, view_mut(&mut own));
        let mut seen = PointEnergies::default();
        self.bonds.observe(
            &self.points.cloud,
            view(&own),
            &mut seen.for_slots(own[0].len()),
        );
        self.points.add_energies(&seen, out);
    }

    pub fn observe_gradient(&self, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        let mut seen = PointEnergies::default();
        self.bonds.observe_gradient(
            &self.points.cloud,
            gradient,
            &mut seen.for_slots(self.points.cloud.len),
        );
        self.points.add_energies(&seen, out);
    }

    pub fn tangents(&mut self, u: FieldView<D>, visit: &mut EachTangent<D>) {
        let points = &self.points;
        points.take(u, view_mut(&mut self.u));
        self.bonds
            .tangents(&points.cloud, view(&self.u), &mut |bond| {
                if points.is_here(bond.i) {
                    visit(BondTangent {
                        i: points.whole(bond.i),
                        j: points.whole(bond.j),
                        ..bond
                    });
                }
            });
    }

    pub fn each_force(&mut self, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        let points = &self.points;
        points.take(u, view_mut(&mut self.u));
        self.bonds
            .each_force(&points.cloud, view(&self.u), &mut |bond| {
                if points.is_here(bond.i) {
                    visit(BondForce {
                        i: points.whole(bond.i),
                        j: points.whole(bond.j),
                        ..bond
                    });
                }
            })
    }

    /// A column of its bonds, of all that are on this rank.
    pub fn read_bonds(&self, name: &str, out: &mut Vec<f64>) -> bool {
        let cloud = &self.points.cloud;
        self.bonds
            .read_column(cloud, view(&cloud.at_rest()), name, out)
    }

    /// Sets a column of its bonds, in the order in which they are read.
    pub fn write_bonds(&mut self, name: &str, values: &[f64]) -> bool {
        self.bonds.write_column(&self.points.cloud, name, values)
    }

    /// Of [`read_bonds`](Interface::read_bonds); nothing if there is no such column.
    pub fn each_directed(&self, name: &str, visit: &mut EachPair<D>) {
        let points = &self.points;
        if has_bonds(self.bonds.as_ref(), name) {
            self.bonds
                .each_directed(&points.cloud, name, &mut |i, j, xi| {
                    visit(points.whole(i), points.whole(j), xi);
                });
        }
    }

    pub fn each_bond(&self, visit: &mut EachBond<D>) {
        let points = &self.points;
        self.bonds.each_bond(&points.cloud, &mut |i, j, xi, state| {
            let (i, j, xi) = match points.is_before(i, j) {
                true => (i, j, xi),
                false => (j, i, xi.map(|x| -x)),
            };
            if points.is_here(i) {
                visit(points.whole(i), points.whole(j), xi, state);
            }
        });
    }

    pub fn each_partner(&self, visit: &mut EachBond<D>) {
        let points = &self.points;
        let cloud = &points.cloud;
        self.bonds.each_partner(cloud, &mut |i, j, xi, state| {
            if points.is_here(i) {
                visit(points.whole(i), points.whole(j), xi, state);
            }
        });
    }

    /// [`mend`](Interaction::mend), of slots of the body of all.
    pub fn mend(&mut self, u: FieldView<D>, heals: &Heals) -> Option<u64> {
        let points = &self.points;
        points.take(u, view_mut(&mut self.u));
        let heals = |i: usize, j: usize, e: f64| heals(points.whole(i), points.whole(j), e);
        let mended = self.bonds.mend(&points.cloud, view(&self.u), &heals);
        mended.map(|count| points.counted(count))
    }

    /// [`expand`](Interaction::expand), by slots of the body of all.
    pub fn expand(&mut self, strain: &[f64]) -> bool {
        let points = &self.points;
        let mut own = vec![0.0; points.cloud.len];
        for (all, slot) in points.slots.iter().zip(&points.cloud.slots) {
            own[*slot as usize] = strain[*all as usize];
        }
        self.bonds.expand(&points.cloud, &own)
    }

    /// [`fatigue_of_bonds`](Interaction::fatigue_of_bonds)
    pub fn fatigue_of_bonds(&self, u: FieldView<D>, load: &Cycles) -> Option<Vec<BondFatigue>> {
        let mut own = self.points.cloud.at_rest();
        self.points.take(u, view_mut(&mut own));
        let mut all = self
            .bonds
            .fatigue_of_bonds(&self.points.cloud, view(&own), load)?;
        { all.iter_mut() }.for_each(|bond| bond.counts &= self.points.first);
        Some(all)
    }

    /// [`work_borne`](Interaction::work_borne), of slots of the body of all.
    pub fn work_borne(
        &mut self,
        u: FieldView<D>,
        visit: &mut dyn FnMut(usize, usize, [f64; D], f64),
    ) -> bool {
        let points = &self.points;
        points.take(u, view_mut(&mut self.u));
        let visit = &mut |i: usize, j: usize, xi: [f64; D], part: f64| {
            if points.is_here(i) {
                visit(points.whole(i), points.whole(j), xi, part);
            }
        };
        self.bonds.work_borne(&points.cloud, view(&self.u), visit)
    }

    pub fn cut(&mut self, kind: CrackKind, crosses: &Crosses<D>) -> u64 {
        let count = self.bonds.cut(&self.points.cloud, kind, crosses);
        self.points.counted(count)
    }

    /// [`scale_bonds`](Interaction::scale_bonds), by slots of the body of all.
    pub fn scale_bonds(&mut self, factors: &FactorsOf<D>) -> Result<(), BuildError> {
        let points = &self.points;
        let of = |i: usize, j: usize, c| factors(points.whole(i), points.whole(j), c);
        self.bonds.scale_bonds(&points.cloud, &of)
    }

    pub fn prepare(&mut self) {
        self.bonds.prepare(&self.points.cloud);
    }

    pub fn directed_bonds(&self) -> u64 {
        self.points.counted(self.bonds.directed_bonds())
    }

    pub fn family_size(&self, slot: usize) -> usize {
        match self.points.place[slot] {
            NONE => 0,
            own => self.bonds.family_size(&self.points.cloud, own as usize),
        }
    }

    pub fn near_horizon(&self) -> u64 {
        self.bonds.near_horizon()
    }

    pub fn bytes(&self) -> usize {
        let columns: usize = [&self.u, &self.v, &self.f]
            .iter()
            .map(|f| 8 * D * f[0].len())
            .sum();
        let p = &self.points;
        let places = 4 * (p.slots.len() + p.place.len() + p.whole.len());
        columns + places + p.cloud.bytes() + self.bonds.bytes()
    }
}
