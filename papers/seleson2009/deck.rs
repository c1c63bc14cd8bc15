//! Decks of the figures: one text per figure; its comments list the runs as command lines, and the code takes them from there.

use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::Deck;

use crate::Failure;

/// The overrides of a run that the deck's comments list: `# NAME: peridyne run deck.toml --set KEY=VALUE …`.
fn listed(text: &str, run: &str) -> Option<Vec<(String, String)>> {
    let start = format!("# {run}: peridyne run ");
    let line = text.lines().find_map(|l| l.strip_prefix(start.as_str()))?;
    let settings = line.split(" --set ").skip(1);
    settings
        .map(|s| {
            let (key, value) = s.trim().split_once('=')?;
            Some((key.to_string(), value.to_string()))
        })
        .collect()
}

/// Names of all runs that the deck's comments list.
#[cfg(test)]
pub fn runs(text: &str) -> Vec<&str> {
    let names = text.lines().filter_map(|l| {
        let (name, _) = l.strip_prefix("# ")?.split_once(": peridyne run ")?;
        Some(name)
    });
    names.collect()
}

/// A run of a deck, with further changes (a small variant, another time step).
///
/// # Errors
/// The deck lists no such run; the deck's own.
pub fn deck(text: &str, run: &str, changes: &[(&str, String)]) -> Result<Deck, Failure> {
    let mut overrides = listed(text, run)
        .ok_or_else(|| Failure::new(format!("the deck's comments list no run `{run}`")))?;
    overrides.extend(changes.iter().map(|(k, v)| ((*k).to_string(), v.clone())));
    Deck::parse(text, "deck.toml", &overrides).map_err(|e| Failure::new(format!("{run}: {e}")))
}

/// The model of a deck.
///
/// # Errors
/// Those of the engine, with their place in the deck.
pub fn model(deck: &Deck) -> Result<Box<dyn Simulation>, Failure> {
    build(&deck.spec, Options::default()).map_err(|e| Failure::new(deck.explain(&e).to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_taken_from_the_comments() {
        let text = "# md: peridyne run deck.toml\n# pd: peridyne run deck.toml --set constants.N=10 --set run.steps=4\n";
        assert_eq!(runs(text), ["md", "pd"]);
        assert_eq!(listed(text, "md"), Some(vec![]));
        let pd = listed(text, "pd").unwrap();
        assert_eq!(pd[1], ("run.steps".to_string(), "4".to_string()));
        assert_eq!(listed(text, "ccm"), None);
        let told = deck(text, "ccm", &[]).unwrap_err().to_string();
        assert_eq!(told, "the deck's comments list no run `ccm`");
    }

    /// Every run that a deck of this paper lists is one that the program takes, without warning.
    #[test]
    fn every_listed_run_can_be_built() {
        let mut count = 0;
        for e in super::super::all() {
            for text in e.sources() {
                for run in runs(text) {
                    let deck = deck(text, run, &[]).unwrap();
                    count += 1;
                    // a limit measured on half a billion bonds takes its time
                    let points = deck.spec.body.spacing().map_or(0.0, |h| 1000.0 / h);
                    if points < 5000.0 {
                        let info = model(&deck).unwrap().info().clone();
                        // a deck that goes to the limit on purpose is told so
                        let warned = !info.warnings.is_empty();
                        let allowed = deck.spec.run.schedule.force_unstable;
                        assert!(!warned || allowed, "{run}: {:?}", info.warnings);
                    }
                }
            }
        }
        assert!(count >= 15, "{count}");
    }
}
