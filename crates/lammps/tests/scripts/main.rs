//! LAMMPS scripts against a host whose points rest or fly freely.

mod bad;
mod commands;
mod files;
mod fuzz;
mod host;
mod output;
mod real;
mod types;
mod values;
