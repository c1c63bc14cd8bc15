//! What happens when LAMMPS would rebuild its neighbour lists: the box follows the atoms, and those that left it are lost.

use crate::domain::Face;
use crate::error::{Problem, Result};
use crate::session::{Session, Store};
use crate::thermo::Lost;

use peridyne::quantity::rounded;

impl Session<'_> {
    /// Does a rebuild change anything: can atoms be lost, or does the box follow them?
    fn is_open(&self) -> bool {
        let domain = self.space.domain.as_ref();
        domain.is_some_and(|d| !(0..3).all(|a| d.periodic(a)))
    }

    /// A rebuild at the start of a run.
    ///
    /// # Errors
    /// The atoms cannot be read.
    pub fn rebuild(&mut self) -> Result<()> {
        if !self.is_open() {
            return Ok(());
        }
        self.shrink_box()?;
        self.lose()?;
        self.neighbors.rebuild.held = self.population.unwrapped()?;
        (
            self.neighbors.rebuild.ago,
            self.neighbors.rebuild.farthest,
            self.neighbors.rebuild.path,
        ) = (0, 0.0, 0.0);
        Ok(())
    }

    /// After the drift of a step in which no atom went further than `path`.
    ///
    /// # Errors
    /// The atoms cannot be read.
    pub fn rebuild_if_due(&mut self, path: f64) -> Result<()> {
        if !self.is_open() {
            return Ok(());
        }
        let (schedule, trigger) = (self.neighbors.schedule, 0.5 * self.neighbors.skin);
        let state = &mut self.neighbors.rebuild;
        state.ago += 1;
        state.path += path;
        let looks = state.ago >= schedule.delay && state.ago.is_multiple_of(schedule.every);
        if schedule.once || !looks {
            return Ok(());
        }
        if !schedule.check {
            return self.rebuild();
        }
        // a thousandth for round-off of the bound
        if (state.farthest + state.path) * 1.001 <= trigger {
            return Ok(());
        }
        let now = self.population.unwrapped()?;
        let state = &mut self.neighbors.rebuild;
        let far = now.iter().zip(&state.held).map(|(x, h)| {
            let d = [0, 1, 2].map(|a| x[a] - h[a]);
            d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
        });
        let farthest = far.fold(0.0, f64::max);
        (state.farthest, state.path) = (farthest.sqrt(), 0.0);
        if farthest > trigger * trigger {
            return self.rebuild();
        }
        Ok(())
    }

    /// Takes away what is outside a fixed face.
    fn lose(&mut self) -> Result<()> {
        let domain = *self.space.domain()?;
        let x = self.population.unwrapped()?;
        let outside = |x: &[f64; 3]| {
            (0..3).find(|&a| {
                let [low, high] = domain.faces[a];
                (low == Face::Fixed && x[a] < domain.low[a])
                    || (high == Face::Fixed && x[a] >= domain.high[a])
            })
        };
        let gone: Vec<(u32, usize)> = x
            .iter()
            .enumerate()
            .filter_map(|(i, x)| Some((i as u32, outside(x)?)))
            .collect();
        let Some((first, axis)) = gone.first().copied() else {
            return Ok(());
        };
        let place = x[first as usize][axis];
        self.neighbors.rebuild.lost = match self.watch.thermo.lost {
            // they stay, and are counted again
            Lost::Error => gone.len(),
            Lost::Warn | Lost::Ignore => self.neighbors.rebuild.lost + gone.len(),
        };
        let example = (self.population.ids.get(first as usize), axis, place);
        self.neighbors.rebuild.example.get_or_insert(example);
        if self.watch.thermo.lost == Lost::Error {
            // the next line of output stops the run
            return Ok(());
        }
        if gone.len() == x.len() {
            return Err(Problem::new("all atoms left the box through fixed faces")
                .help("use `boundary s` so that the box follows the atoms, or a larger box"));
        }
        let gone: Vec<u32> = gone.iter().map(|(i, _)| *i).collect();
        self.remove(&gone)
    }

    /// Takes atoms (from 0, ascending) away for ever.
    ///
    /// # Errors
    /// None are left.
    pub fn remove(&mut self, gone: &[u32]) -> Result<()> {
        let n = self.population.count();
        let stays = |i: usize| gone.binary_search(&(i as u32)).is_err();
        let places: Vec<usize> = (0..n).filter(|i| stays(*i)).collect();
        match &mut self.population.store {
            Store::Atoms(atoms) => atoms.pick(&places, self.population.ids.only(&places)),
            Store::Engine(e) => e.remove(gone),
        }
        self.population.ids = self.population.ids.only(&places);
        self.forget(&places);
        if !self.neighbors.rebuild.held.is_empty() {
            let held = std::mem::take(&mut self.neighbors.rebuild.held);
            self.neighbors.rebuild.held = places.iter().map(|i| held[*i]).collect();
        }
        Ok(())
    }

    /// What was lost since the last line of output.
    ///
    /// # Errors
    /// Something was, and that is an error.
    pub fn check_lost(&mut self) -> Result<()> {
        let lost = std::mem::take(&mut self.neighbors.rebuild.lost);
        let Some((id, axis, place)) = self.neighbors.rebuild.example.take() else {
            return Ok(());
        };
        let axis = ["x", "y", "z"][axis];
        let what = format!(
            "{lost} atoms left the box through a fixed face by step {}, first the atom with id {id}: {axis} = {}",
            self.progress.step,
            rounded(place, 6)
        );
        match self.watch.thermo.lost {
            Lost::Error => Err(Problem::new(what).help(
                "use `boundary s` so that the box follows the atoms, or a larger box; `thermo_modify lost ignore` goes on without them",
            )),
            Lost::Warn => {
                let (was, now) = (self.population.count() + lost, self.population.count());
                self.console
                    .note(&format!("{what}; lost atoms: original {was} current {now}"));
                Ok(())
            }
            Lost::Ignore => Ok(()),
        }
    }
}
