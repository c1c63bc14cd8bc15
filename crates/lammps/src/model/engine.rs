//! A peridyne model as the engine of a script.

use crate::atoms::{Column, Members};
use crate::domain::SimBox;
use crate::host::{
    BLOCK, Condition, Energies, Engine, HostError, Motion, Particles, Quantity, Reaction, RunStart,
    Style, Wall,
};
use crate::units::Units;
use peridyne::boundary_condition::driven::Drive;
use peridyne::error::RunError;
use peridyne::observe::Observed;
use peridyne::observe::Snapshot;
use peridyne::quantity::rounded;
use peridyne::run::{Prescription, Seen, Simulation, Watched};
use peridyne::state::{Archive, Owner};
use std::any::Any;
use std::cell::RefCell;

/// In two dimensions nothing leaves the plane.
pub(super) fn in_plane(what: &str, values: &[f64], expected: f64) -> Result<(), HostError> {
    match values.iter().find(|z| **z != expected) {
        None => Ok(()),
        Some(z) => Err(HostError::new(format!(
            "an atom has the z {what} {} in two dimensions; all others have {}",
            rounded(*z, 6),
            rounded(expected, 6)
        ))
        .help("use `dimension 3`, or leave z alone")),
    }
}

/// Values of all atoms that cost a pass over the bonds, kept until something changes.
#[derive(Debug, Default)]
pub(super) struct Derived {
    damage: Option<Vec<f64>>,
    critical_stretch: Option<Vec<f64>>,
    dilatation: Option<Vec<f64>>,
    energy: Option<Vec<f64>>,
    virials: Option<Vec<[f64; 6]>>,
}

/// Bonds that broke in the last step are in energies and dilatations, and are found no more.
impl Owner for Derived {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let columns = [
            ("damage", &mut self.damage),
            ("critical_stretch", &mut self.critical_stretch),
            ("dilatation", &mut self.dilatation),
            ("energy", &mut self.energy),
        ];
        for (name, column) in columns {
            archive.option(name, column, Vec::new, |values, a| a.list("values", values));
        }
        archive.option("virials", &mut self.virials, Vec::new, |values, a| {
            a.list("values", values);
        });
    }
}

/// A peridyne model that a script runs.
pub struct ModelEngine {
    pub(super) sim: RefCell<Box<dyn Simulation>>,
    pub(super) dimension: usize,
    pub(super) domain: SimBox,
    pub(super) units: Units,
    /// z of all points in two dimensions.
    pub(super) height: f64,
    pub(super) types: Column<u32>,
    /// As the script has them; those of the model are inertias.
    pub(super) density: Column<f64>,
    pub(super) derived: RefCell<Derived>,
    /// Were the bonds there in a force evaluation?
    pub(super) bonded: bool,
    pub(super) driven: Vec<Option<usize>>,
    /// Bulk and shear modulus for each atom type, from 1, with which LAMMPS counts energies; nothing of PMB.
    pub(super) moduli: Vec<[f64; 2]>,
    /// Pairs of atom types that repel without bounds.
    pub(super) unbonded: Vec<(usize, usize)>,
    pub(super) style: Style,
    /// Would LAMMPS not know the critical stretches of the next evaluation with bonds?
    pub(super) undefined: bool,
    pub(super) notes: Vec<String>,
    /// What was understood, in lines.
    pub(super) understood: String,
    /// Where its law comes from.
    pub(super) sources: Vec<String>,
}

impl ModelEngine {
    /// What was understood, in lines.
    pub fn understood(&self) -> &str {
        &self.understood
    }

    /// Where its law comes from.
    pub fn sources(&self) -> &[String] {
        &self.sources
    }

    /// The units of the script.
    pub fn units(&self) -> Units {
        self.units
    }

    /// The model itself.
    pub fn simulation(&mut self) -> &mut dyn Simulation {
        self.sim.get_mut().as_mut()
    }

    fn changed(&mut self) {
        *self.derived.get_mut() = Derived::default();
    }

    fn keep_watched(&mut self) {
        let seen = self.sim.get_mut().watched(Watched::Energies);
        if let Some(Seen::Energies(seen)) = seen {
            let energy = self.energy_of(&seen);
            let kept = self.derived.get_mut();
            (kept.energy, kept.dilatation) = (Some(energy), Some(seen.dilatation));
        }
    }

    /// Energy densities as LAMMPS counts them. Its LPS has `½ K θ² + ½ (15 G/2m) Σ ω ν V e_d²`, with half of the deviatoric
    /// energy and `e_d = e − θ r0/3`. From the whole `W = ½ (K − 5G/3) θ² + (15 G/2m) Σ ω ν V e²` and `Σ e r0 …= θ m/3` that
    /// is `½ K θ² + ½ (W − ½ (K − 5G/3) θ²) + (5G/12) θ² (q − 2)`, q the whole part of m.
    fn energy_of(&self, seen: &Observed) -> Vec<f64> {
        let pairs = seen.strain.iter().zip(&seen.repulsion).enumerate();
        pairs
            .map(|(i, (w, repulsion))| {
                let kind = self.types.get(i) as usize;
                let Some([bulk, shear]) = self.moduli.get(kind - 1) else {
                    return w + repulsion;
                };
                let square = seen.dilatation[i] * seen.dilatation[i];
                let extensions = w - 0.5 * (bulk - 5.0 / 3.0 * shear) * square;
                let mixed = 5.0 / 12.0 * shear * square * (seen.whole[i] - 2.0);
                0.5 * bulk * square + 0.5 * extensions + mixed + repulsion
            })
            .collect()
    }

    /// A step's error, and what may be behind it.
    fn explained(&self, e: &RunError) -> HostError {
        let error = HostError::new(self.units.system().tell(&e.message()));
        match self.unbonded[..] {
            [] => error,
            [(i, j), ..] => error.help(format!(
                "atoms of types {i} and {j} have a horizon of 0: as in LAMMPS they repel with 15 c/0, without bounds, where they come closer than 0.9 of their first distance or 1.35 lattice constants; a short horizon with s00 = 0 cuts bonds and leaves a contact"
            )),
        }
    }

    /// Time step, and what moves, carries and drives points in a run. Is the time step another than before?
    fn take_up(&mut self, run: &RunStart, conditions: &[Condition]) -> bool {
        self.changed();
        let n = self.count();
        let sim = self.sim.get_mut();
        let changed = sim.info().time_step != run.time_step;
        sim.set_time_step(run.time_step);
        let time = sim.time();
        sim.set_time(run.step, time);
        let still: Vec<u32> = (0..n as u32)
            .filter(|i| !run.moving.as_ref().is_some_and(|m| m.contains(*i as usize)))
            .collect();
        sim.prescribe(Prescription::Still, &still);
        sim.prescribe(Prescription::KinematicPoints, &run.kinematic);
        let mut driven: Vec<(Drive, Option<Vec<u32>>)> = Vec::new();
        self.driven.clear();
        for condition in conditions {
            let drive = super::conditions::drive(condition, self.height);
            self.driven.push(drive.as_ref().map(|_| driven.len()));
            driven.extend(drive.map(|d| (d, super::conditions::members(condition, n))));
        }
        sim.set_driven(&driven);
        changed
    }

    /// Hands the values of this instant to the model.
    fn drive(&mut self, conditions: &[Condition]) -> Result<(), HostError> {
        let sim = self.sim.get_mut();
        for (condition, place) in conditions.iter().zip(&self.driven) {
            let value = super::conditions::drive(condition, self.height);
            let (Some(place), Some(value)) = (place, value) else {
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
        if let Quantity::Virial(place) = quantity {
            let all = kept
                .virials
                .get_or_insert_with(|| match sim.watched(Watched::Virials) {
                    Some(Seen::Virials(all)) => all,
                    Some(Seen::Energies(_) | Seen::Virial(_)) | None => vec![],
                });
            for (k, x) in out.iter_mut().enumerate() {
                *x = all[first + k][place];
            }
            return Ok(());
        }
        let mut copy = |kept: &mut Option<Vec<f64>>,
                        make: &dyn Fn(&mut dyn Simulation) -> Vec<f64>| {
            let all = kept.get_or_insert_with(|| make(sim.as_mut()));
            out.copy_from_slice(&all[first..first + out.len()]);
        };
        match quantity {
            Quantity::Damage => copy(&mut kept.damage, &|s| s.scalars("damage")),
            Quantity::Dilatation => copy(&mut kept.dilatation, &|s| s.scalars("dilatation")),
            Quantity::Energy => copy(&mut kept.energy, &|s| self.energy_of(&s.observed())),
            Quantity::Type => {
                for (k, x) in out.iter_mut().enumerate() {
                    *x = f64::from(self.types.get(first + k));
                }
            }
            Quantity::Position(a) | Quantity::Reference(a) if a >= self.dimension => {
                out.fill(self.height);
            }
            Quantity::Position(a) => {
                sim.read("reference", a, first, out);
                let mut u = [0.0; BLOCK];
                for (b, part) in out.chunks_mut(BLOCK).enumerate() {
                    let u = &mut u[..part.len()];
                    sim.read("displacement", a, first + b * BLOCK, u);
                    part.iter_mut().zip(u).for_each(|(x, u)| *x += *u);
                }
            }
            Quantity::Reference(a) => {
                sim.read("reference", a, first, out);
            }
            Quantity::Velocity(a) => {
                sim.read("velocity", a, first, out);
            }
            Quantity::Force(a) => {
                sim.read("force_density", a, first, out);
            }
            Quantity::Volume => {
                sim.read("volume", 0, first, out);
            }
            Quantity::Density => {
                for (k, x) in out.iter_mut().enumerate() {
                    *x = self.density.get(first + k);
                }
            }
            // nothing to break: LAMMPS has the largest number
            Quantity::CriticalStretch => {
                copy(&mut kept.critical_stretch, &|s| {
                    let known = s.scalars("critical_stretch");
                    match known.is_empty() {
                        true => vec![f64::MAX; s.info().points as usize],
                        false => known.iter().map(|s0| s0.min(f64::MAX)).collect(),
                    }
                });
            }
            Quantity::Virial(_) => {}
        }
        Ok(())
    }

    fn write(&mut self, quantity: Quantity, first: usize, values: &[f64]) -> Result<(), HostError> {
        // energies and the like do not know velocities
        if !matches!(quantity, Quantity::Velocity(_)) {
            self.changed();
        }
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
                    sim.read("reference", a, first, x);
                    sim.read("displacement", a, first, u);
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
                    sim.write("displacement", a, first, u);
                }
                Quantity::Velocity(a) if a < self.dimension => {
                    sim.write("velocity", a, first, values);
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
        let changed = self.take_up(run, conditions);
        let sim = self.sim.get_mut();
        let stable = sim.info().stable_step;
        if (changed || !self.bonded) && run.time_step > stable {
            self.notes.push(format!(
                "the time step {} is above the stability limit {} of this body: write `timestep {}` or less",
                rounded(run.time_step, 4),
                rounded(stable, 4),
                rounded(0.8 * stable, 3)
            ));
        }
        // the next evaluation with bonds is now, or at the end of the first step
        if self.undefined && (self.bonded || run.steps > 0) {
            self.undefined = false;
            let moves = |v: &[f64; 3]| v.iter().any(|c| *c != 0.0);
            if sim.velocities().iter().any(moves)
                || self.bonded && sim.displacements().iter().any(moves)
            {
                self.notes.push(format!("atoms move or are strained when the bonds of `{}` are first asked: LAMMPS has no critical stretches yet then and may break every bond that is stretched; here none breaks in that step (let LAMMPS make `run 1` at rest before anything moves, for equal results)", self.style.name()));
            }
        }
        sim.watch(Watched::Energies);
        sim.start(self.bonded);
        self.bonded = true;
        self.keep_watched();
        Ok(())
    }

    fn depart(&mut self, kinematic: &[Motion]) -> Result<f64, HostError> {
        self.changed();
        let sim = self.sim.get_mut();
        let departed = sim.depart(kinematic);
        departed.map_err(|e| self.explained(&e))
    }

    fn reflect(&mut self, wall: &Wall, members: &Members) {
        let n = self.count();
        let ids = super::conditions::ids(members, n);
        self.sim.get_mut().reflect(wall, ids.as_deref());
    }

    fn arrive(&mut self, conditions: &[Condition]) -> Result<(), HostError> {
        self.changed();
        self.drive(conditions)?;
        let sim = self.sim.get_mut();
        if let Err(e) = sim.arrive() {
            return Err(self.explained(&e));
        }
        self.keep_watched();
        Ok(())
    }

    fn remove(&mut self, atoms: &[u32]) {
        self.changed();
        let stays = |i: &usize| atoms.binary_search(&(*i as u32)).is_err();
        let places: Vec<usize> = (0..self.count()).filter(stays).collect();
        self.types.pick(&places);
        self.density.pick(&places);
        self.sim.get_mut().remove(atoms);
    }

    fn expect_output(&mut self) {
        self.sim.get_mut().watch(Watched::Energies);
    }

    fn energies(&mut self) -> Result<Energies, HostError> {
        if self.derived.get_mut().energy.is_none() {
            let seen = self.sim.get_mut().observed();
            self.derived.get_mut().energy = Some(self.energy_of(&seen));
        }
        let energy = self.derived.get_mut().energy.iter().flatten();
        Ok(Energies {
            potential: energy.sum(),
        })
    }

    fn expect_virial(&mut self) {
        self.sim.get_mut().watch(Watched::Virial);
    }

    fn expect_virials(&mut self) {
        self.sim.get_mut().watch(Watched::Virials);
    }

    fn virial(&mut self) -> Result<[f64; 6], HostError> {
        Ok(self.sim.get_mut().virial())
    }

    fn reaction(&self, index: usize) -> Reaction {
        let place = self.driven.get(index).copied().flatten();
        let of = place.and_then(|place| self.sim.borrow_mut().reaction(place));
        of.map_or_else(Reaction::default, |r| Reaction {
            energy: r.energy,
            force: r.force,
        })
    }

    fn snapshot(&mut self) -> Option<Snapshot> {
        Some(
            self.sim
                .get_mut()
                .snapshot(&["velocity", "damage", "block", "body"], false),
        )
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

    fn await_state(&mut self, run: &RunStart, conditions: &[Condition]) -> Result<(), HostError> {
        self.take_up(run, conditions);
        // they were told when it began
        self.notes.clear();
        Ok(())
    }

    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.part("model", self.sim.get_mut().as_mut());
        archive.part("derived", self.derived.get_mut());
        archive.one("bonded", &mut self.bonded);
        archive.one("undefined", &mut self.undefined);
    }

    fn as_any(&mut self) -> &mut dyn Any {
        self
    }
}
