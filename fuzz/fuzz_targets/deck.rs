#![no_main]
//! The deck reader and the header that says what was understood.

use libfuzzer_sys::fuzz_target;
use peridyne_io::deck::Deck;

fuzz_target!(|text: &str| {
    // decks name files; none but those of the deck's folder are meant, and that one does not exist
    match Deck::parse(text, "no/such/folder/deck.toml", &[]) {
        Ok(deck) => assert!(!deck.describe().is_empty()),
        Err(error) => assert!(!error.message.is_empty()),
    }
});
