//! `peridyne waves`: what waves a lattice deck carries, and how stiff and stable it is.

mod files;
mod report;

use crate::Input;
use crate::deck;
use crate::failure::{Failure, json_text, say};
use crate::run::with_threads;
use peridyne::spec::{Stepper, TimeStep};
use peridyne_io::deck::{Deck, UnitSystem};
use peridyne_theory::lattice_dynamics::{LatticeDynamics, TERMS, lattice_dynamics};
use peridyne_theory::upscale::{UpscaleError, lattice};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct WavesArguments {
    /// Deck of one material on a lattice, or of several kinds of atoms that repeat on it.
    #[command(flatten)]
    pub input: Input,
    /// Folder for the results; `out/<name of the deck>-waves` if not given.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Highest derivative in the gradient equation, an even number up to 40.
    #[arg(long, default_value_t = 2 * TERMS)]
    pub order: usize,
    /// Print the JSON of the results instead of a report.
    #[arg(long)]
    pub json: bool,
    /// Threads; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}

/// The dynamics of a lattice with what the deck says about it.
struct Found<'a> {
    deck: &'a Deck,
    dynamics: LatticeDynamics,
    /// The program's own estimate of the stability limit, if the step comes from it.
    estimate: Option<f64>,
}

/// Names of units in tables: length, time.
fn units(system: UnitSystem) -> [&'static str; 2] {
    match system {
        UnitSystem::Si => ["m", "s"],
        UnitSystem::Metal(_) => ["Å", "ps"],
        UnitSystem::Lj | UnitSystem::None => ["", ""],
    }
}

pub fn waves(arguments: &WavesArguments) -> Result<(), Failure> {
    if !deck::is_deck(&arguments.input) {
        return Err(Failure::input(
            "waves takes a deck (.toml) with a lattice body; `peridyne check` reads LAMMPS scripts",
        ));
    }
    let order = arguments.order;
    if !order.is_multiple_of(2) || !(2..=40).contains(&order) {
        return Err(Failure::input(format!(
            "--order {order}: gradient equations have derivatives of even order, from 2 to 40; write for example --order 8"
        )));
    }
    let deck = deck::read(&arguments.input)?;
    deck::is_plain(&deck, "waves")?;
    with_threads(arguments.threads, |_| all(arguments, &deck))
}

fn all(arguments: &WavesArguments, deck: &Deck) -> Result<(), Failure> {
    let told =
        |e: UpscaleError| Failure::input(format!("{}: {}", deck.file(), explained(&e, deck)));
    lattice(&deck.spec).map_err(told)?;
    if deck.spec.materials.len() != 1 && deck.spec.potential().is_none() {
        return Err(told(UpscaleError::SeveralMaterials));
    }
    if let Stepper::Newmark(_) = deck.spec.run.schedule.stepper {
        return Err(Failure::input(format!(
            "{}: waves are those of velocity Verlet, and this deck has integrator = \"newmark\": leave it out",
            deck.file()
        )));
    }
    let (time_step, estimate) = match deck.spec.run.schedule.time_step {
        TimeStep::Fixed(dt) => (dt, None),
        TimeStep::Fraction(_) | TimeStep::Auto => {
            let mut trusting = deck.clone();
            trusting.spec.run.schedule.force_unstable = true;
            let sim = deck::model(&trusting, &arguments.input)?;
            (sim.info().time_step, Some(sim.info().stable_step))
        }
    };
    let found = Found {
        dynamics: lattice_dynamics(&deck.spec, time_step, arguments.order / 2).map_err(told)?,
        deck,
        estimate,
    };
    let out = arguments.out.clone().unwrap_or_else(|| {
        let name = arguments.input.stem();
        Path::new("out").join(format!("{name}-waves"))
    });
    let json = files::json(&found);
    let written = files::write(&out, &found, &json).map_err(|e| Failure::Run(e.to_string()))?;
    if arguments.json {
        say(&json_text(&json));
    } else {
        say(&report::text(&found));
        let names: Vec<String> = written.iter().map(|p| p.display().to_string()).collect();
        say(&format!("written   {}", names.join("\n          ")));
    }
    Ok(())
}

/// What to do instead.
fn explained(error: &UpscaleError, deck: &Deck) -> String {
    match error {
        UpscaleError::NoLattice => "plane waves are those of an endless lattice, and this body is a cloud, a mesh or a \
             perturbed lattice: give it as `lattice` with `spacing`; `peridyne check` computes stiffness and stable step of \
             any body"
            .into(),
        UpscaleError::SeveralMaterials => "waves of several materials are known of atoms, whose unlike ones repeat from cell to cell: \
             write a deck with one of these materials, and one for each other"
            .into(),
        other => deck.units.tell(&other.message()),
    }
}
