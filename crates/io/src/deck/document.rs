//! The deck as written: one struct per table, nothing interpreted yet.

mod condition;
mod crack;
mod deck;
mod fields;
mod indenter;
mod influence;
mod law;
mod molecules;
mod names;
mod output;
mod region;
mod run;
mod thermal;
mod touching;
mod transfer;
mod units;

pub use condition::{Condition, Initial};
pub use crack::{BondFactor, FlatShape, Healing, Precrack, Toughness};
pub use deck::{Body, Document, Fatigue, Fracture, HorizonRatio, Material};
pub use fields::{Centre, Fields, Smooth};
pub use indenter::{Indenter, Rigid, Rotation};
pub use influence::InfluenceWritten;
pub use law::{Force, Given, Law, Listed, OfShelf};
pub use names::*;
pub use output::{Checkpoint, Output, Picture, SpaceTimes};
pub use region::{Mark, Periodic, Set, Shape};
pub use run::{LoadCycles, MethodName, Probe, ReleaseName, Run, Safety, SolverName, Statics};
pub use thermal::Thermal;
pub use touching::{Cohesion, Friction};
pub use transfer::{Convection, Radiation, SpeciesExchange};
pub use units::{UnitName, Units};
