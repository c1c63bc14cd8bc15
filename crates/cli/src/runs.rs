//! What a deck asks for, for those who run it without the program.

pub use crate::check::checked;
pub use crate::run::planned;

use crate::early;
use peridyne_io::deck::Deck;
use peridyne_io::write::checkpoint::Asked;

/// What a state says of how the run of a deck was asked for.
pub fn asked_of(deck: &Deck, command: &str) -> Asked {
    let records = [command, deck.file(), deck.text()].map(String::from);
    early::asked_by(deck.file().as_ref(), vec![], records)
}
