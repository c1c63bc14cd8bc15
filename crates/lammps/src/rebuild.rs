//! When LAMMPS would rebuild its neighbour lists, which atoms it loses then, and when its box follows the atoms.
//!
//! Atoms that are outside a fixed face when the lists are rebuilt are gone: `thermo_modify lost` says whether that is an
//! error, and the next line of output notices. Faces that follow the atoms (`s`, `m`) do so then alone: volume, pressure and
//! the box of dumps are those of the last rebuild. Lists are rebuilt at the start of a run, and when an atom has moved by more
//! than half the skin since the last time, looked for as often as `neigh_modify` says.

/// `neigh_modify`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schedule {
    pub every: u64,
    pub delay: u64,
    pub check: bool,
    pub once: bool,
}

impl Default for Schedule {
    fn default() -> Self {
        Schedule {
            every: 1,
            delay: 0,
            check: true,
            once: false,
        }
    }
}

/// What is known about the last rebuild.
#[derive(Debug, Clone, Default)]
pub struct Rebuild {
    /// Places at the last rebuild.
    pub held: Vec<[f64; 3]>,
    /// Steps since.
    pub ago: u64,
    /// How far the farthest atom was from its place when somebody looked last, and how far any can have gone since.
    pub farthest: f64,
    pub path: f64,
    /// Atoms lost since the last line of output, and the first of them: id, axis, place.
    pub lost: usize,
    pub example: Option<(u64, usize, f64)>,
}
