//! `peridyne check`.

use crate::Input;
use crate::deck;
use crate::failure::{Failure, say};

#[derive(clap::Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub input: Input,
}

pub fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let deck = deck::read(&arguments.input)?;
    let sim = deck::model(&deck, &arguments.input)?;
    say(&deck.describe());
    say(&deck::headline(sim.as_ref()));
    Ok(())
}
