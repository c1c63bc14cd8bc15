//! What can be asked of each atom, whoever holds it.

use super::atoms::Ids;
use super::domain::SimBox;
use super::error::{Problem, Result};
use super::host::{HostError, Particles, Quantity};
use super::units::Units;

/// One number per atom as scripts name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    Id,
    Raw(Quantity),
    /// Position inside the periodic box, in lengths or as a fraction of the box.
    Wrapped(usize),
    Scaled(usize),
    UnwrappedScaled(usize),
    /// Periods between the atom and the box.
    Image(usize),
    /// ½ρv²
    Kinetic,
    Number(u32),
}

impl Field {
    /// Fields that `dump custom`, `compute property/atom`, `compute reduce` and formulas share.
    pub fn parse(name: &str) -> Option<Field> {
        let (base, axis) = match name {
            "id" => return Some(Field::Id),
            "type" => return Some(Field::Raw(Quantity::Type)),
            "mass" => return Some(Field::Raw(Quantity::Density)),
            "proc" => return Some(Field::Number(0)),
            "procp1" => return Some(Field::Number(1)),
            _ => {
                let at = name.find(['x', 'y', 'z'])?;
                let axis = usize::from(name.as_bytes()[at] - b'x');
                (format!("{}*{}", &name[..at], &name[at + 1..]), axis)
            }
        };
        Some(match base.as_str() {
            "*" => Field::Wrapped(axis),
            "*s" => Field::Scaled(axis),
            "*u" => Field::Raw(Quantity::Position(axis)),
            "*su" => Field::UnwrappedScaled(axis),
            "i*" => Field::Image(axis),
            "v*" => Field::Raw(Quantity::Velocity(axis)),
            "f*" => Field::Raw(Quantity::Force(axis)),
            _ => return None,
        })
    }

    /// Is it printed as an integer?
    pub fn is_integer(self) -> bool {
        matches!(
            self,
            Field::Id | Field::Image(_) | Field::Number(_) | Field::Raw(Quantity::Type)
        )
    }
}

impl From<HostError> for Box<Problem> {
    fn from(e: HostError) -> Self {
        let p = Problem::new(e.message);
        match e.help {
            Some(h) => p.help(h),
            None => p,
        }
    }
}

/// Atoms with their box, for reading.
pub struct View<'a> {
    pub particles: &'a dyn Particles,
    pub ids: &'a Ids,
    pub domain: &'a SimBox,
    pub units: Units,
}

impl View<'_> {
    pub fn id(&self, i: usize) -> u64 {
        self.ids.get(i)
    }

    /// Values of atoms `first..first + out.len()`.
    ///
    /// # Errors
    /// The quantity does not exist (yet).
    pub fn read(&self, field: Field, first: usize, out: &mut [f64]) -> Result<()> {
        match field {
            Field::Id => out
                .iter_mut()
                .enumerate()
                .for_each(|(k, x)| *x = self.ids.get(first + k) as f64),
            Field::Number(n) => out.fill(f64::from(n)),
            Field::Raw(q) => self.particles.read(q, first, out)?,
            Field::Wrapped(a) | Field::Scaled(a) | Field::UnwrappedScaled(a) | Field::Image(a) => {
                self.particles.read(Quantity::Position(a), first, out)?;
                let (low, inverse) = (self.domain.low[a], 1.0 / self.domain.edge(a));
                for x in out {
                    let (wrapped, image) = self.domain.wrap(a, *x);
                    *x = match field {
                        Field::Wrapped(_) => wrapped,
                        Field::Scaled(_) => (wrapped - low) * inverse,
                        Field::UnwrappedScaled(_) => (*x - low) * inverse,
                        Field::Image(_) => image as f64,
                        Field::Id | Field::Raw(_) | Field::Kinetic | Field::Number(_) => {
                            unreachable!("the arm above names the others")
                        }
                    };
                }
            }
            Field::Kinetic => {
                let mut v = vec![0.0; out.len()];
                out.fill(0.0);
                for a in 0..3 {
                    self.particles.read(Quantity::Velocity(a), first, &mut v)?;
                    out.iter_mut().zip(&v).for_each(|(s, v)| *s += v * v);
                }
                self.particles.read(Quantity::Density, first, &mut v)?;
                let factor = 0.5 * self.units.kinetic();
                out.iter_mut()
                    .zip(&v)
                    .for_each(|(s, rho)| *s *= factor * rho);
            }
        }
        Ok(())
    }
}
