//! Scripts of molecular dynamics, which peridyne does not run: what to do instead.

use super::Args;
use crate::error::{Problem, Result};
use crate::session::Session;

/// First words of pair styles of molecular dynamics, and the law of a deck that has their force.
const PAIRS: [(&str, Option<&str>); 18] = [
    ("lj", Some("lennard_jones")),
    ("morse", Some("morse")),
    ("buck", Some("buckingham")),
    ("eam", Some("eam")),
    ("meam", None),
    ("sw", Some("stillinger_weber")),
    ("tersoff", Some("tersoff")),
    ("rebo", None),
    ("airebo", None),
    ("reaxff", None),
    ("soft", None),
    ("table", None),
    ("coul", None),
    ("born", None),
    ("hybrid", None),
    ("yukawa", None),
    ("gran", None),
    ("snap", None),
];

/// Commands that only scripts of molecular dynamics have.
const COMMANDS: [&str; 10] = [
    "bond_style",
    "bond_coeff",
    "angle_style",
    "angle_coeff",
    "dihedral_style",
    "improper_style",
    "kspace_style",
    "special_bonds",
    "molecule",
    "temper",
];

/// Fixes that hold a temperature or a pressure, or constrain molecules.
const FIXES: [&str; 11] = [
    "nvt",
    "npt",
    "nph",
    "langevin",
    "berendsen",
    "temp",
    "press",
    "shake",
    "rattle",
    "rigid",
    "box",
];

const STYLES: [&str; 12] = [
    "atomic",
    "bond",
    "angle",
    "molecular",
    "full",
    "charge",
    "sphere",
    "ellipsoid",
    "dipole",
    "hybrid",
    "template",
    "body",
];

impl Session<'_> {
    /// Refuses what belongs to molecular dynamics, and says what to do instead.
    ///
    /// # Errors
    /// The command is of that kind.
    pub(super) fn no_molecules(&self, args: &Args) -> Result<()> {
        let command = args.command.as_str();
        let style = match command {
            "pair_style" | "atom_style" => args.peek(),
            "fix" => args.third(),
            _ => None,
        };
        let stem = |text: &str| text.split('/').next().unwrap_or("").to_string();
        let named = style.map(stem).unwrap_or_default();
        let pair = PAIRS.iter().find(|(name, _)| *name == named);
        let found = match command {
            "pair_style" => pair.is_some(),
            "atom_style" => STYLES.contains(&named.as_str()),
            "fix" => FIXES.contains(&named.as_str()),
            name => COMMANDS.contains(&name),
        };
        if !found {
            return Ok(());
        }
        let shown = match style {
            Some(style) if command == "fix" => format!("fix {style}"),
            Some(style) => format!("{command} {style}"),
            None => command.to_string(),
        };
        let law = match pair.and_then(|(_, law)| *law) {
            Some(law) => format!("`law = {{ {law} = {{ ... }} }}`"),
            None => "a potential".to_string(),
        };
        Err(Problem::new(format!(
            "`{shown}` belongs to molecular dynamics; of LAMMPS's scripts peridyne runs those of peridynamics (`atom_style peri`, `pair_style peri/pmb`, `peri/lps`, `peri/ves` or `peri/eps`)"
        ))
        .help(format!(
            "atoms run from a deck: write a .toml file with a body (`body = {{ file = \"FILE.data\" }}` takes LAMMPS's data files and dumps) and a material with {law}; `peridyne laws` lists the potentials, `peridyne schema` the keys, decks/good/lennard_jones_liquid.toml and copper_bar.toml are examples"
        )))
    }
}
