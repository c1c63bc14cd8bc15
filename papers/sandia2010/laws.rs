//! Laws of chapter 2 from a study's deck.

use peridyne_io::deck::conservation::LawDeck;
use peridyne_transport::Evolution;

use crate::Failure;

/// The law of a deck with changed keys, at t = 0.
pub fn law(deck: &str, changes: &[(&str, String)]) -> Result<Evolution, Failure> {
    let changes: Vec<(String, String)> = { changes.iter() }
        .map(|(key, value)| (key.to_string(), value.clone()))
        .collect();
    let deck = LawDeck::parse(deck, "deck.toml", &changes);
    let deck = deck.map_err(|e| Failure::new(format!("deck.toml: {e}")))?;
    Ok(deck.evolution)
}

/// Where its points are.
pub fn places(law: &Evolution) -> Vec<f64> {
    law.operator.law().grid.sample(|x| x[0])
}

/// Runs to a time.
pub fn run_to(law: &mut Evolution, time: f64) -> Result<(), Failure> {
    law.run_to(time).map_err(|e| Failure::new(e.to_string()))
}

/// The study's words for what the engine refuses.
pub fn failed(error: impl std::fmt::Display) -> Failure {
    Failure::new(error.to_string())
}

/// Numbers with four digits.
pub fn digits(values: &[f64]) -> String {
    let each: Vec<String> = values.iter().map(|v| format!("{v:.3e}")).collect();
    each.join(", ")
}
