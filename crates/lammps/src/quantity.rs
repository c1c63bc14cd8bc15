//! Numbers of atoms by name, and how they are read and written in blocks.

/// Why a host cannot do something; the interpreter adds file and line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct HostError {
    pub message: String,
    pub help: Option<String>,
    /// Atom types (from 1) whose `pair_coeff` is to blame.
    pub pair: Option<(usize, usize)>,
}

impl HostError {
    pub fn new(message: impl Into<String>) -> Self {
        HostError {
            message: message.into(),
            help: None,
            pair: None,
        }
    }
    #[must_use]
    pub fn of_pair(mut self, i: usize, j: usize) -> Self {
        self.pair = Some((i, j));
        self
    }
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// One number per atom. Axes are 0, 1, 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Atom type, from 1.
    Type,
    /// Mass density ρ.
    Density,
    /// Volume V.
    Volume,
    /// Current position, *not* wrapped into a periodic box (length).
    Position(usize),
    /// Reference position `x0` (length).
    Reference(usize),
    Velocity(usize),
    /// Force density after all conditions (force / volume).
    Force(usize),
    /// 1 − unbroken volume / family volume.
    Damage,
    Dilatation,
    /// s0, LAMMPS's `property/atom s0`.
    CriticalStretch,
    /// Strain and contact energy density W as LAMMPS counts it, without the rigid_body (energy / volume).
    Energy,
    /// Half the virial of the pairs of an atom, one of xx yy zz xy xz yz (energy): weighted with volumes.
    Virial(usize),
}

/// Per-atom data in blocks, so that nobody needs a second copy of everything.
pub trait Particles {
    /// Number of atoms.
    fn count(&self) -> usize;

    /// Fills `out` with `quantity` of atoms `first..first + out.len()`.
    ///
    /// # Errors
    /// The quantity does not exist (yet).
    fn read(&self, quantity: Quantity, first: usize, out: &mut [f64]) -> Result<(), HostError>;

    /// Sets `quantity` (type, density, volume, position or velocity) of atoms `first..first + values.len()`.
    ///
    /// # Errors
    /// The quantity cannot be set (any more).
    fn write(&mut self, quantity: Quantity, first: usize, values: &[f64]) -> Result<(), HostError>;

    /// Sets `quantity` of all atoms to one value.
    ///
    /// # Errors
    /// As for [`Particles::write`].
    fn fill(&mut self, quantity: Quantity, value: f64) -> Result<(), HostError> {
        fill_in_blocks(self, quantity, value)
    }
}

/// Atoms per block when per-atom data are streamed.
pub const BLOCK: usize = 4096;

/// [`Particles::fill`] by [`Particles::write`].
pub(crate) fn fill_in_blocks<P: Particles + ?Sized>(
    atoms: &mut P,
    quantity: Quantity,
    value: f64,
) -> Result<(), HostError> {
    let n = atoms.count();
    let values = [value; BLOCK];
    for first in (0..n).step_by(BLOCK) {
        atoms.write(quantity, first, &values[..BLOCK.min(n - first)])?;
    }
    Ok(())
}
