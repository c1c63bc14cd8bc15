//! What is measured of rigid bodies.

use super::state::Kind;
use crate::body::Body;
use crate::boundary_condition::rigid_body::RigidBody;
use crate::columns::{Dimension, Shape};
use crate::error::BuildError;
use crate::observe::ProbeColumn;
use crate::run::system::System;
use crate::space::Point;
use crate::spec::RigidQuantity;

/// Names of what it consists of in D dimensions: components, or energies.
fn parts<const D: usize>(of: RigidQuantity) -> &'static [&'static str] {
    let axes = Shape::Vector.components();
    match of {
        RigidQuantity::Energy => &["kinetic", "dissipated"],
        // in a plane about z, on a line about nothing
        RigidQuantity::Torque | RigidQuantity::Turn | RigidQuantity::Spin => {
            &axes[[3, 3, 2, 0][D]..]
        }
        RigidQuantity::Force | RigidQuantity::Center | RigidQuantity::Velocity => &axes[..D],
    }
}

fn column(of: RigidQuantity, name: String) -> ProbeColumn {
    let dimension = match of {
        RigidQuantity::Force => Dimension::FORCE,
        RigidQuantity::Torque | RigidQuantity::Energy => Dimension::ENERGY,
        RigidQuantity::Center => Dimension::LENGTH,
        RigidQuantity::Velocity => Dimension::VELOCITY,
        RigidQuantity::Turn => Dimension::NUMBER,
        RigidQuantity::Spin => Dimension::FREQUENCY,
    };
    let column = ProbeColumn::new(name, dimension);
    match of {
        // no energy, though it has the dimension of one
        RigidQuantity::Torque => column.moment(),
        _ => column,
    }
}

/// Its numbers, in the order of its parts.
fn values<const D: usize>(
    of: RigidQuantity,
    rigid_body: &RigidBody<D>,
    body: &Body<D>,
) -> Vec<f64> {
    let rigid = &rigid_body.rigid;
    let part = |first: usize| -> Point {
        let all = rigid_body.wrench(body);
        std::array::from_fn(|a| all[first + a])
    };
    let vector = match of {
        RigidQuantity::Energy => return vec![rigid.kinetic(), rigid_body.dissipated(body)],
        RigidQuantity::Force => part(0),
        RigidQuantity::Torque => part(3),
        RigidQuantity::Center => rigid.center,
        RigidQuantity::Velocity => rigid.velocity,
        RigidQuantity::Turn => rigid.turn(),
        RigidQuantity::Spin => rigid.turning,
    };
    let count = parts::<D>(of).len();
    let first = if of.is_turn() { 3 - count } else { 0 };
    vector[first..first + count].to_vec()
}

impl<const D: usize> System<D> {
    /// A probe of the rigid body of this name.
    ///
    /// # Errors
    /// There is none.
    pub(super) fn rigid_probe(
        &self,
        probe: &str,
        name: &str,
        of: Option<RigidQuantity>,
        path: &str,
    ) -> Result<(Kind, Vec<ProbeColumn>), BuildError> {
        let found = self.applied.rigid.iter().position(|i| i.name == name);
        let Some(n) = found.filter(|_| !name.is_empty()) else {
            let named = self.applied.rigid.iter().filter(|i| !i.name.is_empty());
            let names: Vec<&str> = named.map(|i| i.name.as_str()).collect();
            let message = format!("there is no rigid body `{name}`");
            let help = match names.is_empty() {
                true => "give the [[rigid_body]] a name: name = \"punch\"".into(),
                false => format!("known are {}", names.join(", ")),
            };
            let error = BuildError::unknown(format!("{path}.rigid_body"), name, message);
            return Err(error.help(help));
        };
        let of = of.map_or(RigidQuantity::ALL.to_vec(), |of| vec![of]);
        let each = |of: &RigidQuantity| {
            let of = *of;
            let parts = parts::<D>(of).iter();
            parts.map(move |part| column(of, format!("{probe}_{}_{part}", of.name())))
        };
        let columns = of.iter().flat_map(each).collect();
        Ok((Kind::Rigid(n, of), columns))
    }

    pub(super) fn rigid_values(&self, rigid_body: usize, of: &[RigidQuantity]) -> Vec<f64> {
        let found = self.applied.rigid.get(rigid_body);
        // conditions that were replaced since took the body away
        let value = |q: &RigidQuantity| match found {
            Some(rigid_body) => values(*q, rigid_body, &self.body),
            None => vec![f64::NAN; parts::<D>(*q).len()],
        };
        of.iter().flat_map(value).collect()
    }
}
