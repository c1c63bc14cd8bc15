//! The commands of a script, by theme.

mod args;
mod computes;
mod control;
mod create;
mod displace;
mod fix_output;
mod fixes;
mod geometry;
mod groups;
mod molecular;
mod output;
mod pair;
mod particles;
mod region;
mod run;
mod set;
mod settings;
mod thermo;
mod variables;
mod velocity;

pub use self::args::Args;
pub use self::run::RunPlan;

use super::error::{Problem, Result, suggestion};
use super::session::Session;

/// Every command, for messages.
pub const COMMANDS: [&str; 56] = [
    "atom_modify",
    "atom_style",
    "boundary",
    "clear",
    "comm_modify",
    "comm_style",
    "compute",
    "create_atoms",
    "create_box",
    "delete_atoms",
    "dimension",
    "displace_atoms",
    "dump",
    "dump_modify",
    "echo",
    "fix",
    "group",
    "if",
    "include",
    "info",
    "jump",
    "label",
    "lattice",
    "log",
    "neigh_modify",
    "neighbor",
    "newton",
    "next",
    "pair_coeff",
    "pair_modify",
    "pair_style",
    "print",
    "processors",
    "quit",
    "read_data",
    "read_dump",
    "region",
    "reset_timestep",
    "run",
    "run_style",
    "set",
    "thermo",
    "thermo_modify",
    "thermo_style",
    "timestep",
    "uncompute",
    "undump",
    "unfix",
    "units",
    "variable",
    "velocity",
    "write_data",
    "write_dump",
    "suffix",
    "package",
    "balance",
];

impl Session<'_> {
    /// Runs a command that does not steer the script itself.
    ///
    /// # Errors
    /// The command is unknown or cannot be done.
    pub fn command(&mut self, mut args: Args) -> Result<()> {
        let args = &mut args;
        self.no_molecules(args)?;
        match args.command.as_str() {
            "units" => self.set_units(args),
            "dimension" => self.set_dimension(args),
            "boundary" => self.set_boundary(args),
            "atom_style" => self.set_atom_style(args),
            "timestep" => self.set_timestep(args),
            "reset_timestep" => self.reset_timestep(args),
            "neighbor" => self.set_neighbor(args),
            "neigh_modify" => self.neigh_modify(args),
            "log" => self.set_log(args),
            "atom_modify" | "newton" | "processors" | "comm_modify" | "comm_style" | "suffix"
            | "package" | "balance" | "run_style" | "echo" | "pair_modify" => {
                self.without_effect(args)
            }
            "info" => self.info(),
            "lattice" => self.set_lattice(args),
            "region" => self.add_region(args),
            "create_box" => self.create_box(args),
            "create_atoms" => self.create_atoms(args),
            "displace_atoms" => self.displace_atoms(args),
            "delete_atoms" => self.delete_atoms(args),
            "read_data" => self.read_data(args),
            "read_dump" => self.read_dump(args),
            "write_data" => self.write_data_command(args),
            "set" => self.set_atoms(args),
            "velocity" => self.set_velocity(args),
            "group" => self.set_group(args),
            "pair_style" => self.pair_style(args),
            "pair_coeff" => self.pair_coeff(args),
            "fix" => self.add_fix(args),
            "unfix" => self.remove_fix(args),
            "compute" => self.add_compute(args),
            "uncompute" => self.remove_compute(args),
            "thermo" => self.set_thermo(args),
            "thermo_style" => self.thermo_style(args),
            "thermo_modify" => self.thermo_modify(args),
            "dump" => self.add_dump(args),
            "dump_modify" => self.dump_modify(args),
            "undump" => self.remove_dump(args),
            "write_dump" => self.write_dump(args),
            "variable" => self.set_variable(args),
            name => Err(Problem::at(
                args.command.span,
                format!("the command `{name}` is not supported"),
            )
            .help(suggestion(name, COMMANDS))),
        }
    }
}
