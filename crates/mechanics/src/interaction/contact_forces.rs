//! All that acts between points that touch, outside their families and over broken bonds: they repel and attract each other ([`Contact`]), and
//! rub ([`Friction`]).

use super::contact::Contact;
use super::friction::{Friction, Pressed};
use super::{BondForce, EachTangent, Evaluation, Interaction, PointEnergies};
use crate::body::{Body, Field};
use crate::state::Archive;

#[derive(Debug, Clone)]
pub struct ContactForces<const D: usize> {
    /// Along the line between two points.
    pub central: Contact<D>,
    /// `None`: points slide freely.
    pub friction: Option<Friction<D>>,
}

impl<const D: usize> ContactForces<D> {
    /// Passes what it remembers through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        archive.given("friction", &mut self.friction, |f, a| f.archive(body, a));
    }

    /// Finds who may touch at `u`, of points that these bonds have in no common family.
    pub fn find(&mut self, body: &Body<D>, u: &Field<D>, bonds: &dyn Interaction<D>) {
        let in_family = |i, j| bonds.in_family(body, i, j);
        self.central.update(body, u, &in_family);
    }

    /// Adds the force density at time `t` to `f`, and the energies of central forces to those that are seen.
    pub fn add(
        &mut self,
        bonds: &dyn Interaction<D>,
        body: &Body<D>,
        state: [&Field<D>; 2],
        f: &mut Field<D>,
        seen: Option<&mut PointEnergies>,
        (t, at): (f64, Evaluation),
    ) {
        let central = &mut self.central;
        central.add_forces(body, state[0], f, &|i, j| bonds.in_family(body, i, j));
        if let Some(seen) = seen {
            central.add_energy_density(body, state[0], &mut seen.repulsion);
        }
        if let Some(friction) = &mut self.friction {
            friction.add(central, bonds, body, state, f, (t, at));
        }
    }

    /// Visit every central force now from each of its ends, a point's as they come on any number of ranks.
    pub fn each_force(
        &mut self,
        bonds: &dyn Interaction<D>,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) {
        self.find(body, u, bonds);
        let mut ends = vec![];
        self.central.each_end(body, u, |end| ends.push(end));
        ends.sort_by_key(|end| body.order(end.at));
        for end in ends {
            let force = end.y.map(|y| end.pull * end.volume * y);
            visit(BondForce {
                i: end.at,
                j: end.other,
                y: end.y,
                force,
                own: Some(force.map(|f| 0.5 * f)),
            });
        }
    }

    /// Tangents as those of bonds between points that touch, at the displacements `u` of the last evaluation; as of [`Contact::tangents`].
    pub fn tangents(&self, body: &Body<D>, u: &Field<D>, visit: &mut EachTangent<D>) {
        self.central.tangents(body, u, visit);
        if let Some(friction) = &self.friction {
            friction.tangents(body, visit);
        }
    }

    /// As of friction: the forces at the end of an explicit step dt long (time) are next.
    pub fn begin_step(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        if let Some(friction) = &mut self.friction {
            friction.begin(body, v, dt);
        }
    }

    /// An increment of statics or an implicit step begins, from these displacements.
    pub fn depart(&mut self, body: &Body<D>, u: &Field<D>, pressed: Pressed) {
        if let Some(friction) = &mut self.friction {
            friction.depart(body, u, pressed);
        }
    }

    /// It ends at these.
    pub fn arrive(&mut self, body: &Body<D>, u: &Field<D>) {
        if let Some(friction) = &mut self.friction {
            friction.arrive(body, u);
        }
    }

    /// Back to where a step or an increment began.
    pub fn retreat(&mut self) {
        if let Some(friction) = &mut self.friction {
            friction.retreat();
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.central.bytes() + self.friction.as_ref().map_or(0, Friction::bytes)
    }
}
