//! Numbers that know what they measure, alone and in sentences. The engine counts in one consistent system of units and does not know
//! which; who reads what it says sees units all the same.

mod dimension;
mod message;
mod number;

pub use dimension::Dimension;
pub use message::{Message, Part, Warnings, place};
pub use number::{Quantity, power, rounded};
