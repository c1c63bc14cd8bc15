//! What a deck asks for, for those who run it without the program.

pub use crate::check::checked;
pub use crate::run::{go_on, planned};

use crate::early;
use peridyne_io::deck::Deck;
use peridyne_io::write::checkpoint::Asked;

/// What a state says of how the run of a deck was asked for, with what overrides its keys.
pub fn asked_of(deck: &Deck, set: Vec<(String, String)>, command: &str) -> Asked {
    let records = [command, deck.file(), deck.text()].map(String::from);
    early::asked_by(deck.file().as_ref(), set, records)
}
