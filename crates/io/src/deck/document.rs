//! The deck as written: one struct per table, nothing interpreted yet.

mod condition;
mod crack;
mod deck;
mod diffusion;
mod fields;
mod influence;
mod law;
mod molecules;
mod names;
mod output;
mod region;
mod rigid_body;
mod run;
mod thermal;
mod touching;
mod units;

pub use condition::{Condition, Initial};
pub use crack::{BondFactor, FlatShape, Healing, Precrack, Toughness};
pub use deck::{Body, Document, Fatigue, Fracture, HorizonRatio, Material};
pub use diffusion::{Convection, Radiation, SpeciesExchange};
pub use fields::{Centre, Fields, Smooth};
pub use influence::InfluenceWritten;
pub use law::{Force, Given, Law, Listed, OfShelf};
pub use names::*;
pub use output::{Checkpoint, Film, Output, Picture, SpaceTimes};
pub use region::{Block, Periodic, Set, Shape};
pub use rigid_body::{Rigid, RigidBody, Rotation};
pub use run::{BreakageName, LoadCycles, MethodName, Probe, Run, Safety, SolverName, Statics};
pub use thermal::Thermal;
pub use touching::{Cohesion, Friction};
pub use units::{UnitName, Units};
