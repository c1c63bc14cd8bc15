//! LAMMPS scripts on peridyne's own engine.
//!
//! The reference configuration is that of the first `run`. Lattice sites that were never moved become a stencil, all
//! else a cloud. The first force evaluation has no bonds yet (contact and conditions only), like LAMMPS's.

mod build;
mod conditions;
mod spec;
mod types;

pub use build::{ModelHost, Prepared};

use std::any::Any;
use std::cell::RefCell;

use peridyne::condition::driven::Drive;
use peridyne::run::{PointField, Simulation};

use super::atoms::Column;
use super::domain::SimBox;
use super::host::{
    BLOCK, Condition, Energies, Engine, HostError, Particles, Quantity, Reaction, RunStart,
};

/// In two dimensions nothing leaves the plane.
fn in_plane(what: &str, values: &[f64], expected: f64) -> Result<(), HostError> {
    match values.iter().find(|z| **z != expected) {
        None => Ok(()),
        Some(z) => Err(HostError::new(format!(
            "an atom has the z {what} {z:e} in two dimensions; all others have {expected:e}"
        ))
        .help("use `dimension 3`, or leave z alone")),
    }
}

/// Values of all atoms that cost a pass over the bonds, kept until something changes.
#[derive(Debug, Default)]
struct Derived {
    damage: Option<Vec<f64>>,
    dilatation: Option<Vec<f64>>,
    energy: Option<Vec<f64>>,
}

/// A peridyne model that a script runs.
pub struct ModelEngine {
    sim: RefCell<Box<dyn Simulation>>,
    dimension: usize,
    domain: SimBox,
    /// z of all points in two dimensions.
    height: f64,
    types: Column<u32>,
    derived: RefCell<Derived>,
    /// Were the bonds there in a force evaluation?
    bonded: bool,
    driven: Vec<Option<usize>>,
    /// Must nothing repel?
    guarded: bool,
    notes: Vec<String>,
}

impl ModelEngine {
    /// The model itself.
    pub fn simulation(&mut self) -> &mut dyn Simulation {
        self.sim.get_mut().as_mut()
    }

    fn changed(&mut self) {
        *self.derived.get_mut() = Derived::default();
    }

    fn keep_watched(&mut self) {
        if let Some((energy, dilatation)) = self.sim.get_mut().watched() {
            let kept = self.derived.get_mut();
            (kept.energy, kept.dilatation) = (Some(energy), Some(dilatation));
        }
    }

    /// Refuses a state in which points repel, if LAMMPS's types repel each in their own way.
    fn guard(&mut self) -> Result<(), HostError> {
        if !self.guarded {
            return Ok(());
        }
        let sim = self.sim.get_mut();
        let ledger = sim.ledger().map_err(|e| HostError::new(e.to_string()))?;
        if ledger.contact == 0.0 {
            return Ok(());
        }
        Err(HostError::new(format!(
            "points repel each other since step {}, and the types differ in stiffness: LAMMPS repels each pair of types with its own, only one is supported",
            sim.step_number()
        ))
        .help("give all types the same c (K); points repel below 0.9 of their reference distance or 1.35 lattice constants"))
    }

    /// Hands the values of this instant to the model.
    fn drive(&mut self, conditions: &[Condition]) -> Result<(), HostError> {
        let sim = self.sim.get_mut();
        for (condition, place) in conditions.iter().zip(&self.driven) {
            let (Some(place), Some(value)) = (place, conditions::drive(condition)) else {
                continue;
            };
            if !sim.drive(*place, &value) {
                return Err(HostError::new("the fixes changed within a run"));
            }
        }
        Ok(())
    }
}

impl Particles for ModelEngine {
    fn count(&self) -> usize {
        self.sim.borrow().info().points as usize
    }

    fn read(&self, quantity: Quantity, first: usize, out: &mut [f64]) -> Result<(), HostError> {
        let mut sim = self.sim.borrow_mut();
        let mut kept = self.derived.borrow_mut();
        let mut copy = |kept: &mut Option<Vec<f64>>, make: fn(&mut dyn Simulation) -> Vec<f64>| {
            let all = kept.get_or_insert_with(|| make(sim.as_mut()));
            out.copy_from_slice(&all[first..first + out.len()]);
        };
        match quantity {
            Quantity::Damage => copy(&mut kept.damage, |s| s.damage()),
            Quantity::Dilatation => copy(&mut kept.dilatation, |s| s.dilatation()),
            Quantity::Energy => copy(&mut kept.energy, |s| s.energy_density()),
            Quantity::Type => {
                for (k, x) in out.iter_mut().enumerate() {
                    *x = f64::from(self.types.get(first + k));
                }
            }
            Quantity::Position(a) | Quantity::Reference(a) if a >= self.dimension => {
                out.fill(self.height);
            }
            Quantity::Position(a) => {
                sim.read(PointField::Reference(a), first, out);
                let mut u = [0.0; BLOCK];
                for (b, part) in out.chunks_mut(BLOCK).enumerate() {
                    let u = &mut u[..part.len()];
                    sim.read(PointField::Displacement(a), first + b * BLOCK, u);
                    part.iter_mut().zip(u).for_each(|(x, u)| *x += *u);
                }
            }
            Quantity::Reference(a) => sim.read(PointField::Reference(a), first, out),
            Quantity::Velocity(a) => sim.read(PointField::Velocity(a), first, out),
            Quantity::Force(a) => sim.read(PointField::Force(a), first, out),
            Quantity::Volume => sim.read(PointField::Volume, first, out),
            Quantity::Density => sim.read(PointField::Density, first, out),
            Quantity::CriticalStretch => sim.read(PointField::CriticalStretch, first, out),
        }
        Ok(())
    }

    fn write(&mut self, quantity: Quantity, first: usize, values: &[f64]) -> Result<(), HostError> {
        self.changed();
        let mut before = [0.0; BLOCK];
        for (b, values) in values.chunks(BLOCK).enumerate() {
            let first = first + b * BLOCK;
            let before = &mut before[..values.len()];
            self.read(quantity, first, before)?;
            if values == before {
                continue;
            }
            let sim = self.sim.get_mut();
            match quantity {
                Quantity::Position(a) if a < self.dimension => {
                    let mut x = [0.0; BLOCK];
                    let mut u = [0.0; BLOCK];
                    let (x, u) = (&mut x[..values.len()], &mut u[..values.len()]);
                    sim.read(PointField::Reference(a), first, x);
                    sim.read(PointField::Displacement(a), first, u);
                    for k in (0..values.len()).filter(|k| values[*k] != before[*k]) {
                        // bonds are whole: of all images of the new place the one near the old
                        let around = if self.domain.periodic(a) {
                            let edge = self.domain.edge(a);
                            edge * ((before[k] - values[k]) / edge).round()
                        } else {
                            0.0
                        };
                        u[k] = values[k] - x[k] + around;
                    }
                    sim.write(PointField::Displacement(a), first, u);
                }
                Quantity::Velocity(a) if a < self.dimension => {
                    sim.write(PointField::Velocity(a), first, values);
                }
                Quantity::Position(_) => in_plane("position", values, self.height)?,
                Quantity::Velocity(_) => in_plane("velocity", values, 0.0)?,
                _ => {
                    return Err(HostError::new(
                        "types, densities and volumes are fixed since the first `run`",
                    )
                    .help("move this command before the first `run`"));
                }
            }
        }
        Ok(())
    }
}

impl Engine for ModelEngine {
    fn setup(&mut self, run: &RunStart, conditions: &[Condition]) -> Result<(), HostError> {
        self.changed();
        let n = self.count();
        let sim = self.sim.get_mut();
        let changed = sim.info().time_step != run.time_step;
        sim.set_time_step(run.time_step);
        let time = sim.time();
        sim.set_time(run.step, time);
        let stable = sim.info().stable_step;
        if (changed || !self.bonded) && run.time_step > stable {
            self.notes.push(format!(
                "the time step {:.4e} is above the stability limit {stable:.4e} of this body: write `timestep {:.2e}` or less",
                run.time_step,
                0.8 * stable
            ));
        }
        let still: Vec<u32> = (0..n as u32)
            .filter(|i| !run.moving.as_ref().is_some_and(|m| m.contains(*i as usize)))
            .collect();
        sim.set_still(&still);
        let mut driven: Vec<(Drive, Option<Vec<u32>>)> = Vec::new();
        self.driven.clear();
        for condition in conditions {
            let drive = conditions::drive(condition);
            self.driven.push(drive.map(|_| driven.len()));
            driven.extend(drive.map(|d| (d, conditions::members(condition, n))));
        }
        sim.set_driven(&driven);
        sim.watch_next();
        sim.start(self.bonded);
        self.bonded = true;
        self.keep_watched();
        self.guard()
    }

    fn step(&mut self, conditions: &[Condition]) -> Result<(), HostError> {
        self.changed();
        self.drive(conditions)?;
        let sim = self.sim.get_mut();
        sim.step().map_err(|e| HostError::new(e.to_string()))?;
        self.keep_watched();
        self.guard()
    }

    fn expect_output(&mut self) {
        self.sim.get_mut().watch_next();
    }

    fn energies(&mut self) -> Result<Energies, HostError> {
        let sim = self.sim.get_mut();
        let kept = self.derived.get_mut();
        let energy = kept.energy.get_or_insert_with(|| sim.energy_density());
        Ok(Energies {
            potential: energy.iter().sum(),
        })
    }

    fn expect_virial(&mut self) {
        self.sim.get_mut().watch_virial_next();
    }

    fn virial(&mut self) -> Result<[f64; 6], HostError> {
        Ok(self.sim.get_mut().virial())
    }

    fn reaction(&self, index: usize) -> Reaction {
        let place = self.driven.get(index).copied().flatten();
        place.map_or_else(Reaction::default, |place| {
            let r = self.sim.borrow().reaction(place);
            Reaction {
                energy: r.energy,
                force: r.force,
            }
        })
    }

    fn directed_bonds(&self) -> u64 {
        self.sim.borrow().info().directed_bonds
    }

    fn memory_bytes(&self) -> u64 {
        self.sim.borrow().info().bytes as u64
    }

    fn notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    fn as_any(&mut self) -> &mut dyn Any {
        self
    }
}
