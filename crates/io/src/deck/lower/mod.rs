//! From the deck as written to the specification: units, defaults, checks.

mod acting;
mod atoms;
mod bodies;
mod body;
mod contact;
pub(super) mod context;
mod deck;
mod family;
mod fields;
mod files;
mod indenter;
mod interface;
mod law;
mod material;
mod motion;
mod names;
mod periods;
mod pieces;
mod points;
mod probes;
mod region;
mod schedule;
mod section;
mod sets;
mod stage;
mod transfer;
mod units;
mod warnings;

pub(super) use atoms::boltzmann;
pub(super) use deck::lower;
pub(super) use files::Files;
pub(super) use material::point_volume;
pub(super) use schedule::{MANY_STEPS, steps};
pub(super) use stage::Entries;
pub(super) use units::{units, units_of};
pub(super) use warnings::unitless;
