//! `stress`

use super::PAIRS;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "stress",
        Shape::Symmetric,
        Dimension::PRESSURE,
        "Stress from the forces of bonds, tension positive: half of the virial of the point per volume, in the reference volume and along the bonds as they are now (Kirchhoff stress); its symmetric part. Loads and friction are not in it, and points near a surface have less of it than the continuum.",
    ).derived(),
    equation: "σ = ½ Σ_j f_ij ⊗ y_ij, f_ij the force density from partner j at y_ij",
    source: "Lehoucq, Silling 2008; Lehoucq, Sears 2011 (sandia2010, ch. 4): the flux of force, collapsed onto the point",
    needs: Needs::Forces,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    let mut stress = vec![[0.0; 6]; state.points()];
    let known = state.each_force(&mut |pair| {
        let of = &mut stress[pair.id];
        for (s, (m, n)) in of.iter_mut().zip(PAIRS) {
            *s += 0.25 * (pair.force[m] * pair.y[n] + pair.force[n] * pair.y[m]);
        }
    });
    known.then_some(Values::Symmetric(stress))
}
