//! A conservation law on a grid: what carries, what spreads, what lies around.

use crate::flux::Flux;
use crate::grid::{Boundary, Grid, Padded, Values};
use crate::kernel::Kernel;
use crate::weights::Stencil;
use peridyne::error::BuildError;
use std::fmt;

/// Where a law carries.
#[derive(Clone)]
pub enum Direction {
    /// The same everywhere; `[1, 0]` on a line.
    Constant([f64; 2]),
    /// Components of a field that does not change in time.
    Field([Values; 2]),
}

impl fmt::Debug for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Direction::Constant(d) => write!(f, "Constant({d:?})"),
            Direction::Field(_) => f.write_str("Field"),
        }
    }
}

/// The transport part of a law.
#[derive(Debug, Clone)]
pub struct Advection {
    pub flux: Flux,
    pub direction: Direction,
    pub(crate) stencil: Stencil,
}

/// The spreading part.
#[derive(Debug, Clone)]
pub struct Diffusion {
    /// ε (length²/time)
    pub viscosity: f64,
    pub(crate) stencil: Stencil,
}

impl Advection {
    pub fn stencil(&self) -> &Stencil {
        &self.stencil
    }
}

impl Diffusion {
    pub fn stencil(&self) -> &Stencil {
        &self.stencil
    }
}

/// A conservation law on a grid.
#[derive(Debug, Clone)]
pub struct Law {
    pub grid: Grid,
    pub boundary: Boundary,
    pub advection: Option<Advection>,
    pub diffusion: Option<Diffusion>,
}

impl Law {
    /// # Errors
    /// See [`Stencil::new`]; a law without transport and without diffusion.
    pub fn new(
        grid: Grid,
        boundary: Boundary,
        advection: Option<(Flux, Direction, &Kernel)>,
        diffusion: Option<(f64, &Kernel)>,
    ) -> Result<Law, BuildError> {
        let advection = advection.map(|(flux, direction, kernel)| {
            let stencil = Stencil::new(kernel, &grid, "advection.kernel")?;
            Ok(Advection {
                flux,
                direction,
                stencil,
            })
        });
        let diffusion = diffusion.map(|(viscosity, kernel)| {
            let stencil = Stencil::new(kernel, &grid, "diffusion.kernel")?;
            if !(viscosity >= 0.0 && viscosity.is_finite()) {
                return Err(BuildError::invalid(
                    "diffusion.viscosity",
                    format!("the viscosity must not be negative, it is {viscosity}"),
                ));
            }
            Ok(Diffusion { viscosity, stencil })
        });
        let law = Law {
            grid,
            boundary,
            advection: advection.transpose()?,
            diffusion: diffusion.transpose()?,
        };
        match law.advection.is_none() && law.diffusion.is_none() {
            true => Err(BuildError::missing(
                "",
                "nothing moves: a conservation law has a flux, a diffusion, or both",
            )),
            false => Ok(law),
        }
    }

    pub fn periodic(&self) -> bool {
        matches!(self.boundary, Boundary::Periodic)
    }

    /// The flux f of the local law `u_t + f(u)_x = ε u_xx` of a line; none in a plane, along a field of directions, and where nothing is carried.
    pub fn local_flux(&self) -> Option<Flux> {
        let advection = self.advection.as_ref()?;
        match advection.direction {
            Direction::Constant([d, _]) if self.grid.dimension == 1 => {
                Some(advection.flux.times(d))
            }
            Direction::Constant(_) | Direction::Field(_) => None,
        }
    }

    /// Steps of the longest bond.
    pub fn reach(&self) -> usize {
        let of = |s: Option<&Stencil>| s.map_or(0, Stencil::reach);
        of(self.advection.as_ref().map(|a| &a.stencil))
            .max(of(self.diffusion.as_ref().map(|d| &d.stencil)))
    }

    /// Bonds of a point that transport uses, and those that diffusion uses.
    pub fn bonds(&self) -> [usize; 2] {
        let of = |s: Option<&Stencil>| s.map_or(0, |s| 2 * s.steps.len());
        [
            of(self.advection.as_ref().map(|a| &a.stencil)),
            of(self.diffusion.as_ref().map(|d| &d.stencil)),
        ]
    }

    /// Convolutions of an evaluation: of transport along a constant direction, and of diffusion.
    pub fn convolutions(&self) -> [usize; 2] {
        let carried = self.advection.as_ref().map_or(0, |a| match &a.flux {
            Flux::Polynomial(rows) => {
                let asks = |row: &&Vec<f64>| row.iter().skip(1).any(|c| *c != 0.0);
                rows.iter().filter(asks).count()
            }
            Flux::Function(_) => 1,
        });
        [carried, usize::from(self.diffusion.is_some())]
    }

    /// Can sums be made by Fourier transforms?
    pub fn is_convolution(&self) -> bool {
        let polynomial = self
            .advection
            .as_ref()
            .is_none_or(|a| matches!(a.flux, Flux::Polynomial(_)));
        self.periodic() && polynomial
    }

    /// A field of directions on a padded grid, for each axis; nothing of a constant one.
    pub(crate) fn direction(&self, padded: &Padded) -> Vec<Vec<f64>> {
        let Some(advection) = &self.advection else {
            return vec![];
        };
        let axes = 0..self.grid.dimension;
        match &advection.direction {
            Direction::Constant(_) => vec![],
            Direction::Field(f) => {
                let column = |a: usize| {
                    let own = self.grid.sample(|x| f[a](x, 0.0));
                    let around = match self.boundary {
                        Boundary::Periodic => Boundary::Periodic,
                        Boundary::Collars(_) => Boundary::Collars(f[a].clone()),
                    };
                    let mut out = vec![];
                    padded.fill(&own, &around, 0.0, &mut out);
                    out
                };
                axes.map(column).collect()
            }
        }
    }
}
