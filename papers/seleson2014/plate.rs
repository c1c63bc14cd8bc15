//! The plate of section 4.3, from the deck of Fig. 4.

use peridyne::run::Simulation;
use peridyne_io::write::plot::{Map, Plot};
use peridyne_io::write::table::Table;

use super::{deck, model};
use crate::checkpoint::{self, Plan, Record, Row};
use crate::measure::{largest, relative_difference};
use crate::{Context, Failure, Findings};

pub const DECK: &str = include_str!("figure-4/plate.toml");
/// Lattice constant of Table 3 (m).
pub const A: f64 = 1.25e-3;
/// Final time (s).
pub const T: f64 = 2.5e-5;
/// Mesh sizes in lattice constants.
pub const MESHES: [u32; 3] = [1, 2, 4];

/// Which time step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// 800 times that of the paper at h = a, for all meshes: 0.7 of the stability limit.
    Limit,
    /// Half of that.
    HalfLimit,
    /// 100 times that of the paper at h = a, for all meshes.
    Hundred,
    /// Δt0 h/a.
    Paper,
}

/// A plate to run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// h/a
    pub mesh: u32,
    /// ε/a
    pub horizon: f64,
    pub step: Step,
    /// With a, ε and Δt0 four times as large.
    pub small: bool,
}

impl Plate {
    pub fn new(context: &Context, mesh: u32, step: Step) -> Plate {
        Plate {
            mesh,
            horizon: 12.1,
            step,
            small: context.small,
        }
    }

    pub fn spacing(&self) -> f64 {
        let a = if self.small { 4.0 * A } else { A };
        a * f64::from(self.mesh)
    }

    pub fn steps(&self) -> u64 {
        let all = if self.small { 5000 } else { 20_000 };
        match self.step {
            Step::Limit => all / 800,
            Step::HalfLimit => all / 400,
            Step::Hundred => all / 100,
            Step::Paper => all / u64::from(self.mesh),
        }
    }

    pub fn time_step(&self) -> f64 {
        T / self.steps() as f64
    }

    pub fn model(&self, measured: bool) -> Result<Box<dyn Simulation>, Failure> {
        let epsilon = self.horizon * self.spacing() / f64::from(self.mesh);
        let set = [
            ("constants.h", self.spacing()),
            ("constants.epsilon", epsilon),
            ("constants.dt", self.time_step()),
        ];
        let deck = deck(DECK, "plate.toml", &set.map(|(k, v)| (k, v.to_string())))?;
        model(&deck, measured)
    }

    /// Runs to the end; at the paper's step in parts that are kept.
    pub fn run(&self, context: &Context) -> Result<Wave, Failure> {
        let mut sim = self.model(false)?;
        let steps = self.steps();
        let plan = Plan {
            steps,
            row: (steps / if self.small { 10 } else { 50 }).max(1),
            part: match self.step {
                Step::Limit | Step::HalfLimit | Step::Hundred => 0,
                Step::Paper => 500,
            },
        };
        let name = format!("plate-{}", self.mesh);
        let record = checkpoint::run(context, &name, sim.as_mut(), plan)?;
        let info = sim.info();
        Ok(Wave {
            mesh: self.mesh,
            spacing: self.spacing(),
            time_step: info.time_step,
            bonds: info.directed_bonds,
            steps,
            record,
            x: sim
                .vectors("reference")
                .iter()
                .map(|x| [x[0], x[1]])
                .collect(),
            u: sim.displacements().iter().map(|u| [u[0], u[1]]).collect(),
            energy: sim.scalars("energy_density"),
        })
    }
}

/// A finished run.
pub struct Wave {
    pub mesh: u32,
    pub spacing: f64,
    pub time_step: f64,
    pub bonds: u64,
    pub steps: u64,
    pub record: Record,
    pub x: Vec<[f64; 2]>,
    pub u: Vec<[f64; 2]>,
    /// Strain energy density.
    pub energy: Vec<f64>,
}

impl Wave {
    /// Whole numbers of spacings from the middle.
    fn at(&self, k: usize) -> [i64; 2] {
        self.x[k].map(|x| (x / self.spacing).round() as i64)
    }

    /// x and radial displacement of points on the x axis.
    pub fn along_x(&self) -> (Vec<f64>, Vec<f64>) {
        (0..self.x.len())
            .filter(|k| self.at(*k)[1] == 0)
            .map(|k| (self.x[k][0], self.u[k][0] * self.x[k][0].signum()))
            .unzip()
    }

    /// Displacements of the points that a coarser mesh has, too, in its order.
    pub fn on(&self, coarse: &Wave) -> Vec<[f64; 2]> {
        let every = i64::from(coarse.mesh / self.mesh);
        (0..self.x.len())
            .filter(|k| self.at(*k).iter().all(|i| i % every == 0))
            .map(|k| self.u[k])
            .collect()
    }

    /// `√(Σ |u − v|²/Σ |v|²)` on the points that both have, v of the finer mesh.
    pub fn difference(&self, fine: &Wave) -> f64 {
        let reference = fine.on(self);
        relative_difference(self.u.as_flattened(), reference.as_flattened())
    }

    /// Radius of the largest radial displacement on the x axis, and that displacement; beyond the middle, where the
    /// initial displacement has no direction.
    pub fn crest(&self) -> [f64; 2] {
        let (x, u) = self.along_x();
        let beyond = x.iter().zip(&u).filter(|(x, _)| **x > 0.05);
        beyond.fold(
            [0.0, 0.0],
            |[r, top], (x, u)| {
                if *u > top { [*x, *u] } else { [r, top] }
            },
        )
    }

    pub fn time(&self) -> Vec<f64> {
        let times = self
            .record
            .rows
            .iter()
            .map(|r| r.step as f64 * self.time_step);
        times.collect()
    }
}

/// The plates of all meshes, with the same step.
pub fn waves(context: &Context) -> Result<Vec<Wave>, Failure> {
    let run = |mesh| {
        context.say(&format!("plate with h = {mesh}a"));
        Plate::new(context, mesh, Step::Hundred).run(context)
    };
    MESHES.into_iter().map(run).collect()
}

/// Energy maps of all meshes, with the same colours: from 0 to the largest value beyond r = 0.05 of the finest mesh.
pub fn maps(out: &std::path::Path, waves: &[Wave], found: &mut Findings) -> Result<(), Failure> {
    let beyond = |w: &Wave| {
        let ring = w.x.iter().zip(&w.energy);
        let ring = ring.filter(|(x, _)| x[0].hypot(x[1]) > 0.05);
        largest(ring.map(|(_, e)| *e))
    };
    let top = waves.first().map_or(1.0, beyond);
    for wave in waves {
        let h = wave.spacing;
        let columns = (1.0 / h).round() as usize;
        let mut values = vec![f64::NAN; columns * columns];
        for (k, e) in wave.energy.iter().enumerate() {
            let [i, j] = wave.at(k).map(|i| (i + columns as i64 / 2) as usize);
            values[j * columns + i] = *e;
        }
        let range = [-0.5 - 0.5 * h, 0.5 - 0.5 * h];
        let map = Map::new(format!("Strain energy density at T, h = {}a", wave.mesh))
            .x("x", "m", range)
            .y("y", "m", range)
            .value("strain energy density", "J/m³")
            .between(0.0, top)
            .equal()
            .grid(columns, &values);
        found.picture(map.save(out, &format!("energy-{}", wave.mesh))?);
        let (x, energy): (Vec<f64>, Vec<f64>) = (0..wave.x.len())
            .filter(|k| wave.at(*k)[1] == 0)
            .map(|k| (wave.x[k][0], wave.energy[k]))
            .unzip();
        let path = out.join(format!("energy-along-x-{}.csv", wave.mesh));
        Table::new()
            .column("x", "m", x)
            .column("strain energy density", "J/m^3", energy)
            .save(&path)?;
        found.file(path);
    }
    Ok(())
}

/// Radial displacements along the x axis, and energies over time.
pub fn curves(out: &std::path::Path, waves: &[Wave], found: &mut Findings) -> Result<(), Failure> {
    let mut radial = Plot::new("Radial displacement along the x axis at T")
        .x("x", "m")
        .y("u_r", "m");
    let mut energies = Plot::new("Energies of the plate")
        .x("t", "s")
        .y("energy", "J");
    for wave in waves {
        let name = format!("h = {}a", wave.mesh);
        let (x, u) = wave.along_x();
        radial = radial.line(&name, &x, &u);
        let path = out.join(format!("radial-{}.csv", wave.mesh));
        Table::new()
            .column("x", "m", x)
            .column("radial displacement", "m", u)
            .save(&path)?;
        found.file(path);
        let time = wave.time();
        let kinetic: Vec<f64> = wave.record.rows.iter().map(|r| r.kinetic).collect();
        let strain: Vec<f64> = wave.record.rows.iter().map(|r| r.strain).collect();
        let total: Vec<f64> = wave.record.rows.iter().map(Row::total).collect();
        // the coarsest lies over the finest; what is between would hide both
        let columns = [
            ("kinetic", &kinetic),
            ("strain", &strain),
            ("total", &total),
        ];
        for (what, values) in columns {
            let label = format!("{what}, {name}");
            if wave.mesh == waves[0].mesh {
                energies = energies.line(&label, &time, values);
            } else if wave.mesh == 4 {
                energies = energies.dashed(&label, &time, values);
            }
        }
        let path = out.join(format!("energies-{}.csv", wave.mesh));
        Table::new()
            .column("time", "s", time)
            .column("kinetic energy", "J", kinetic)
            .column("strain energy", "J", strain)
            .column("total energy", "J", total)
            .save(&path)?;
        found.file(path);
    }
    found.picture(radial.save(out, "radial")?);
    found.picture(energies.save(out, "energies")?);
    Ok(())
}

/// Squares of the lengths of bonds up to a horizon (in spacings), and how many bonds a full family has.
pub fn family(horizon: f64) -> u64 {
    offsets(horizon).count() as u64
}

fn offsets(horizon: f64) -> impl Iterator<Item = [i64; 2]> {
    let (reach, square) = (horizon as i64, (horizon * horizon + 1e-9) as i64);
    let all = (-reach..=reach).flat_map(move |i| (-reach..=reach).map(move |j| [i, j]));
    all.filter(move |[i, j]| (1..=square).contains(&(i * i + j * j)))
}

/// Directed bonds of a square of n × n points: those that leave it are missing.
pub fn bonds(n: i64, horizon: f64) -> u64 {
    let inside = |o: [i64; 2]| ((n - o[0].abs()) * (n - o[1].abs())) as u64;
    offsets(horizon).map(inside).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::pulse;

    fn plate(mesh: u32, step: Step) -> Plate {
        Plate {
            mesh,
            horizon: 12.1,
            step,
            small: false,
        }
    }

    #[test]
    fn steps_and_bonds_are_those_of_the_paper() {
        let steps = MESHES.map(|m| plate(m, Step::Paper).steps());
        assert_eq!(steps, [20_000, 10_000, 5000]);
        assert!((plate(2, Step::Paper).time_step() / 2.5e-9 - 1.0).abs() < 1e-12);
        assert_eq!(family(12.0), 440);
        assert_eq!([12.1, 6.05, 3.025].map(family), [464, 112, 28]);
        // 3 × 3 points, four neighbours: 12 undirected bonds
        assert_eq!(bonds(3, 1.0), 24);
    }

    #[test]
    fn the_deck_begins_with_the_profile_and_has_the_bonds() {
        let coarse = plate(4, Step::Hundred);
        let mut sim = coarse.model(false).unwrap();
        assert_eq!(sim.info().directed_bonds, bonds(200, 3.025));
        for (x, u) in sim.vectors("reference").iter().zip(sim.displacements()) {
            let r = x[0].hypot(x[1]);
            let p = if r > 0.0 {
                pulse(r, 0.0, 0.2, 1e-4)
            } else {
                0.0
            };
            let [a, b] = [x[0], x[1]].map(|x| p * x / r.max(1e-99));
            assert!(
                (u[0] - a).abs() < 1e-17 && (u[1] - b).abs() < 1e-17,
                "{x:?}"
            );
        }
    }
}
