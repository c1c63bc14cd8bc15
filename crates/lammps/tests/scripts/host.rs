//! A host for tests: points in free flight, with bonds counted by brute force only in `directed_bonds`.

use std::any::Any;
use std::sync::{Arc, Mutex};

use peridyne_lammps::host::*;
use peridyne_lammps::{Atoms, Members, Options, Outcome, ScriptError, run_text};

/// Atoms that fly freely; forces come from conditions only.
pub struct Flight {
    atoms: Atoms,
    force: Vec<[f64; 3]>,
    reactions: Vec<Reaction>,
    run: Option<RunStart>,
}

impl Particles for Flight {
    fn count(&self) -> usize {
        self.atoms.len()
    }
    fn read(&self, q: Quantity, first: usize, out: &mut [f64]) -> Result<(), HostError> {
        match q {
            Quantity::Force(a) => out
                .iter_mut()
                .zip(&self.force[first..])
                .for_each(|(o, f)| *o = f[a]),
            Quantity::Damage | Quantity::Dilatation | Quantity::Energy => out.fill(0.0),
            Quantity::CriticalStretch => out.fill(0.0005),
            _ => return self.atoms.read(q, first, out),
        }
        Ok(())
    }
    fn write(&mut self, q: Quantity, first: usize, values: &[f64]) -> Result<(), HostError> {
        self.atoms.write(q, first, values)
    }
}

impl Flight {
    fn forces(&mut self, conditions: &[Condition]) {
        self.force.iter_mut().for_each(|f| *f = [0.0; 3]);
        self.reactions = vec![Reaction::default(); conditions.len()];
        for (c, reaction) in conditions.iter().zip(&mut self.reactions) {
            for i in 0..self.atoms.len() {
                let f = &mut self.force[i];
                match c {
                    Condition::Indent {
                        members,
                        stiffness,
                        center,
                        radius,
                        ..
                    } if members.contains(i) => {
                        let x = self.atoms.position(i);
                        let d = [0, 1, 2].map(|a| x[a] - center[a]);
                        let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                        let dr = r - radius;
                        if dr < 0.0 {
                            for a in 0..3 {
                                let push = stiffness * dr * dr * d[a] / r;
                                f[a] += push;
                                reaction.force[a] -= push;
                            }
                            reaction.energy -= stiffness / 3.0 * dr * dr * dr;
                        }
                    }
                    Condition::SetForce { members, force } if members.contains(i) => {
                        f.iter_mut()
                            .zip(force)
                            .for_each(|(f, v)| *f = v.unwrap_or(*f));
                    }
                    Condition::AddForce { members, force } if members.contains(i) => {
                        f.iter_mut().zip(force).for_each(|(f, v)| *f += v);
                    }
                    Condition::Enforce2d { members } if members.contains(i) => f[2] = 0.0,
                    _ => {}
                }
            }
        }
    }

    fn kick(&mut self) {
        let Some(run) = &self.run else { return };
        let Some(moving) = &run.moving else { return };
        let n = self.atoms.len();
        let half = 0.5 * run.time_step;
        for i in (0..n).filter(|i| moving.contains(*i)) {
            let rho = self.atoms.density.get(i);
            let v = &mut self.atoms.velocity.each(n)[i];
            v.iter_mut()
                .zip(&self.force[i])
                .for_each(|(v, f)| *v += half * f / rho);
        }
    }
}

impl Engine for Flight {
    fn setup(&mut self, run: &RunStart, conditions: &[Condition]) -> Result<(), HostError> {
        self.run = Some(run.clone());
        self.forces(conditions);
        Ok(())
    }
    fn depart(&mut self, _: &[Motion]) -> Result<f64, HostError> {
        self.kick();
        if let Some(RunStart {
            moving: Some(moving),
            time_step,
            ..
        }) = self.run.clone()
        {
            let n = self.atoms.len();
            for a in 0..3 {
                let mut x = vec![0.0; n];
                self.atoms.read(Quantity::Position(a), 0, &mut x)?;
                for i in (0..n).filter(|i| moving.contains(*i)) {
                    x[i] += time_step * self.atoms.velocity.get(i)[a];
                }
                self.atoms.write(Quantity::Position(a), 0, &x)?;
            }
        }
        Ok(f64::INFINITY)
    }
    fn reflect(&mut self, _: &Wall, _: &Members) {}
    fn arrive(&mut self, conditions: &[Condition]) -> Result<(), HostError> {
        self.forces(conditions);
        self.kick();
        Ok(())
    }
    fn remove(&mut self, atoms: &[u32]) {
        let n = self.atoms.len();
        let stays = |i: &usize| atoms.binary_search(&(*i as u32)).is_err();
        let places: Vec<usize> = (0..n).filter(stays).collect();
        let ids = self.atoms.ids.only(&places);
        self.atoms.pick(&places, ids);
        self.force = places.iter().map(|i| self.force[*i]).collect();
    }
    fn energies(&mut self) -> Result<Energies, HostError> {
        Ok(Energies { potential: 0.0 })
    }

    fn virial(&mut self) -> Result<[f64; 6], HostError> {
        Ok([0.0; 6])
    }
    fn reaction(&self, index: usize) -> Reaction {
        self.reactions.get(index).copied().unwrap_or_default()
    }
    fn directed_bonds(&self) -> u64 {
        0
    }
    fn memory_bytes(&self) -> u64 {
        0
    }
    fn as_any(&mut self) -> &mut dyn Any {
        self
    }
}

/// Keeps what was asked for.
#[derive(Default)]
pub struct TestHost {
    /// Everything of the set-up but the atoms, which fly.
    pub built: Option<(Pair, f64, Atoms)>,
}

impl Host for TestHost {
    fn build(&mut self, setup: Setup) -> Result<Box<dyn Engine>, HostError> {
        self.built = Some((setup.pair, setup.lattice_constant, setup.atoms.clone()));
        let n = setup.atoms.len();
        Ok(Box::new(Flight {
            atoms: setup.atoms,
            force: vec![[0.0; 3]; n],
            reactions: Vec::new(),
            run: None,
        }))
    }
}

/// Collects what is printed.
#[derive(Default, Clone)]
pub struct Paper(pub Arc<Mutex<Vec<String>>>);

impl Console for Paper {
    fn print(&mut self, line: &str) {
        self.0
            .lock()
            .unwrap()
            .extend(line.lines().map(str::to_string));
    }
    fn note(&mut self, line: &str) {
        self.0.lock().unwrap().push(format!("note: {line}"));
    }
}

/// Result of a script: host, printed lines, outcome.
pub struct Ran {
    pub host: TestHost,
    pub lines: Vec<String>,
    pub outcome: Result<Outcome, Box<ScriptError>>,
}

pub fn run(name: &str, text: &str, options: &Options) -> Ran {
    let mut host = TestHost::default();
    let paper = Paper::default();
    let outcome = run_text(name, text, options, &mut host, &mut paper.clone());
    let lines = std::mem::take(&mut *paper.0.lock().unwrap());
    Ran {
        host,
        lines,
        outcome,
    }
}
