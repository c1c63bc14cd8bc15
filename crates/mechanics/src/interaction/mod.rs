//! A law bound to a family: forces, energies and bonds of a body. Compiled once per law and family, called once
//! per sweep.

pub(crate) mod atoms;
pub(crate) mod bond;
pub(crate) mod bonds;
pub mod cohesion;
pub mod contact;
mod contact_forces;
mod contract;
pub mod coulomb;
pub(crate) mod criterion;
mod evaluation;
pub mod friction;
pub mod history;
pub(crate) mod interface;
pub(crate) mod linear;
pub mod list;
pub(crate) mod material;
pub(crate) mod micromoduli;
pub mod nearness;
pub mod pairs;
mod point_constants;
mod point_energies;
pub mod pull;
mod replicated;
pub mod repulsion;
pub(crate) mod scale;
pub(crate) mod several;
mod spin;
pub mod stencil;
mod sweep;
pub mod tangent;
pub mod weight;

pub use atoms::bonded::{BondedAtoms, longest_term};
pub use atoms::smoothed::Smoothed;
use bond::along;
pub use bond::{
    BondForce, BondStatus, Crosses, EachBond, EachForce, EachPair, FactorsOf, Gradient, Heals,
    Toughness,
};
pub use bond::{add_virial, critical_stretch};
pub use contact_forces::ContactForces;
pub use contract::Interaction;
pub use criterion::{BondFatigue, cycles_to_failure, first_to_fail};
pub use evaluation::Evaluation;
pub use interface::Interface;
pub use point_constants::PointConstants;
use point_constants::laws_fields;
use point_energies::EnergyFields;
pub use point_energies::{PointEnergies, PointEnergiesMut};
pub use replicated::Replicated;
pub use repulsion::{PairTable, Repulsion, in_series};
pub use several::MultiBodyInteraction;
pub(crate) use sweep::Motion;
pub use sweep::{BlockTally, Fault, Released, Sweep, Tally};
pub use tangent::{BondTangent, Channel, EachTangent};
