//! Observables: a file each, and a line here.

mod block;
mod body;
mod damage;
mod density;
mod dilatation;
mod displacement;
mod displacement_gradient;
mod energy_density;
mod force_density;
mod fragment;
mod kinetic_energy_density;
mod material;
mod position;
mod reference;
mod repulsion_energy_density;
mod strain;
mod strain_energy_density;
mod stress;
mod temperature;
mod velocity;
mod volume;

pub use temperature::temperature_of;

use super::{State, Values};
use crate::columns::Declaration;
use crate::space::Point;

/// All there are, in the order in which they are listed.
pub static ALL: &[&Observable] = &[
    &displacement::OBSERVABLE,
    &velocity::OBSERVABLE,
    &position::OBSERVABLE,
    &reference::OBSERVABLE,
    &force_density::OBSERVABLE,
    &stress::OBSERVABLE,
    &strain::OBSERVABLE,
    &displacement_gradient::OBSERVABLE,
    &strain_energy_density::OBSERVABLE,
    &repulsion_energy_density::OBSERVABLE,
    &energy_density::OBSERVABLE,
    &kinetic_energy_density::OBSERVABLE,
    &damage::OBSERVABLE,
    &dilatation::OBSERVABLE,
    &temperature::OBSERVABLE,
    &volume::OBSERVABLE,
    &density::OBSERVABLE,
    &block::OBSERVABLE,
    &material::OBSERVABLE,
    &body::OBSERVABLE,
    &fragment::OBSERVABLE,
];

/// What a run writes of its points where nobody says otherwise.
pub const USUAL: [&str; 7] = [
    "displacement",
    "velocity",
    "damage",
    "energy_density",
    "dilatation",
    "block",
    "body",
];

/// A derived column: a function of the state, with a name.
#[derive(Debug)]
pub struct Observable {
    /// Name, shape, dimension, and what it is.
    pub declaration: Declaration,
    /// The equation, where there is one.
    pub equation: &'static str,
    /// Who says so.
    pub source: &'static str,
    pub needs: Needs,
    /// Its values; `None`: this state has none.
    pub of: fn(&mut dyn State) -> Option<Values>,
}

impl Observable {
    /// A column that every model has; its values are of this many points, in order of their ids.
    pub const fn new(
        declaration: Declaration,
        of: fn(&mut dyn State) -> Option<Values>,
    ) -> Observable {
        Observable {
            declaration,
            equation: "",
            source: "",
            needs: Needs::Nothing,
            of,
        }
    }
}

/// What a model must have for an observable to exist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    Nothing,
    /// Several bodies.
    Bodies,
    /// Points that are atoms.
    Atoms,
    /// A family of the reference.
    Family,
    /// Forces of single bonds.
    Forces,
}

impl Needs {
    /// Why a model without it has no such column.
    pub fn missing(self) -> &'static str {
        match self {
            Needs::Nothing => "",
            Needs::Bodies => "there is one body",
            Needs::Atoms => "the points are no atoms",
            Needs::Family => "atoms have no family in the reference",
            Needs::Forces => "the law has no forces of single bonds",
        }
    }
}

/// The observable of this name.
pub fn named(name: &str) -> Option<&'static Observable> {
    ALL.iter().copied().find(|o| o.declaration.name == name)
}

/// Components of symmetric tensors.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

fn by_id<T>(state: &dyn State, of: impl Fn(&dyn State, usize) -> T) -> Vec<T> {
    (0..state.points()).map(|i| of(state, i)).collect()
}

fn square(x: Point) -> f64 {
    x.iter().map(|c| c * c).sum()
}
