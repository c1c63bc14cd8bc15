//! The cube of section 4.3, from the deck of Fig. 6.

use std::path::Path;

use peridyne::run::Simulation;
use peridyne_io::write::plot::{Map, Plot};

use super::{conserved, deck, model};
use crate::checkpoint::{self, Plan, Record};
use crate::measure::{apart, largest};
use crate::{Context, Failure, Findings};

pub const DECK: &str = include_str!("figure-6/cube.toml");
/// Final time (s).
pub const T: f64 = 5e-5;

/// A cube to run: points along x (one more along z), and steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cube {
    pub points: u32,
    pub steps: u64,
    /// Steps per part that is kept; 0: none.
    pub part: u64,
}

/// A finished run.
pub struct Wave {
    pub points: u64,
    pub bonds: u64,
    pub bytes: usize,
    pub steps: u64,
    pub record: Record,
    pub spacing: f64,
    /// Points along x.
    pub across: usize,
    /// Displacements, in the precision that differences of runs need.
    pub u: Vec<[f32; 3]>,
    /// Radial displacement at whole multiples of the spacing along +x, +y, +z, from the middle.
    pub radial: [Vec<f64>; 3],
    /// Strain energy density of the planes x = 0, y = 0, z = 0 where the other coordinates are not negative: those
    /// coordinates in order, and the value.
    pub faces: [Vec<([f64; 2], f64)>; 3],
}

impl Cube {
    pub fn spacing(&self) -> f64 {
        1.0 / f64::from(self.points)
    }

    pub fn model(&self) -> Result<Box<dyn Simulation>, Failure> {
        let set = [
            ("constants.h", self.spacing().to_string()),
            ("constants.dt", (T / self.steps as f64).to_string()),
        ];
        model(&deck(DECK, "cube.toml", &set)?, false)
    }

    pub fn run(&self, context: &Context) -> Result<Wave, Failure> {
        let mut sim = self.model()?;
        let plan = Plan {
            steps: self.steps,
            row: (self.steps / 20).max(1),
            part: self.part,
        };
        let record = checkpoint::run(context, "cube", sim.as_mut(), plan)?;
        let info = sim.info().clone();
        let n = self.points as usize;
        let h = self.spacing();
        // points are in order z, y, x, from −n/2 on
        let id = |i: usize, j: usize, k: usize| {
            let m = n / 2;
            ((k + m) * n + j + m) * n + i + m
        };
        let mut radial = [vec![], vec![], vec![]];
        for (axis, values) in radial.iter_mut().enumerate() {
            for k in 0..n / 2 {
                let mut at = [0; 3];
                at[axis] = k;
                let mut u = [0.0];
                sim.read("displacement", axis, id(at[0], at[1], at[2]), &mut u);
                values.push(u[0]);
            }
        }
        let energy = sim.scalars("energy_density");
        let face = |axis: usize| {
            let half = n / 2;
            let pairs = (0..half).flat_map(|b| (0..half).map(move |a| [a, b]));
            let value = |[a, b]: [usize; 2]| {
                let at = match axis {
                    0 => [0, a, b],
                    1 => [a, 0, b],
                    _ => [a, b, 0],
                };
                (
                    [a as f64 * h, b as f64 * h],
                    energy[id(at[0], at[1], at[2])],
                )
            };
            pairs.map(value).collect()
        };
        Ok(Wave {
            points: info.points,
            bonds: info.directed_bonds,
            bytes: info.bytes,
            steps: self.steps,
            record,
            u: displacements(sim.as_mut()),
            spacing: h,
            across: n,
            radial,
            faces: [face(0), face(1), face(2)],
        })
    }
}

/// Points that are read at once.
const BLOCK: usize = 8192;

fn displacements(sim: &mut dyn Simulation) -> Vec<[f32; 3]> {
    let mut u = vec![[0.0; 3]; sim.info().points as usize];
    let mut values = [0.0; BLOCK];
    for (block, part) in u.chunks_mut(BLOCK).enumerate() {
        for axis in 0..3 {
            let values = &mut values[..part.len()];
            sim.read("displacement", axis, block * BLOCK, values);
            for (u, x) in part.iter_mut().zip(values) {
                u[axis] = *x as f32;
            }
        }
    }
    u
}

impl Wave {
    /// `√(Σ |u − v|²/Σ |v|²)` over all points, v of the other run.
    pub fn difference(&self, other: &Wave) -> f64 {
        let pairs = self.u.as_flattened().iter().zip(other.u.as_flattened());
        let (mut apart, mut size) = (0.0, 0.0);
        for (u, v) in pairs {
            let (u, v) = (f64::from(*u), f64::from(*v));
            apart += (u - v) * (u - v);
            size += v * v;
        }
        (apart / size).sqrt()
    }

    /// Distance of the largest radial displacement beyond r = 0.05 along each axis.
    pub fn crests(&self) -> [f64; 3] {
        [0, 1, 2].map(|a| {
            let beyond = self.radial[a].iter().enumerate();
            let beyond = beyond.filter(|(k, _)| *k as f64 * self.spacing > 0.05);
            let top = beyond.max_by(|a, b| a.1.total_cmp(b.1));
            top.map_or(0.0, |(k, _)| k as f64 * self.spacing)
        })
    }

    /// The octant seen into its corner in the middle of the cube, the plane z = 0, and the radial displacements.
    pub fn pictures(&self, out: &Path, found: &mut Findings) -> Result<(), Failure> {
        let beyond = self.faces[2]
            .iter()
            .filter(|(x, _)| x[0].hypot(x[1]) > 0.05);
        let top = largest(beyond.map(|(_, e)| *e));
        let (cos, sin) = (0.75f64.sqrt(), 0.5);
        // x to the left below, y to the right below, z up
        let seen = |[x, y, z]: [f64; 3]| [cos * (y - x), z - sin * (x + y)];
        let (mut points, mut values) = (vec![], vec![]);
        for (axis, face) in self.faces.iter().enumerate() {
            for ([a, b], e) in face {
                let at = match axis {
                    0 => [0.0, *a, *b],
                    1 => [*a, 0.0, *b],
                    _ => [*a, *b, 0.0],
                };
                points.push(seen(at));
                values.push(*e);
            }
        }
        let map = Map::new("Strain energy density at T: planes x = 0, y = 0, z = 0 of an octant")
            .x("(y − x) cos 30°", "m", [-0.46, 0.46])
            .y("z − (x + y)/2", "m", [-0.52, 0.52])
            .value("strain energy density", "J/m³")
            .between(0.0, top)
            .equal()
            .points(&points, &values, 1.05 * self.spacing);
        found.picture(map.save(out, "octant")?);
        let flat: Vec<f64> = self.faces[2].iter().map(|f| f.1).collect();
        let range = [-0.5 * self.spacing, 0.5 - 0.5 * self.spacing];
        let map = Map::new("Strain energy density at T in the plane z = 0")
            .x("x", "m", range)
            .y("y", "m", range)
            .value("strain energy density", "J/m³")
            .between(0.0, top)
            .equal()
            .grid(self.across / 2, &flat);
        found.picture(map.save(out, "plane")?);
        let r: Vec<f64> = (0..self.radial[0].len())
            .map(|k| k as f64 * self.spacing)
            .collect();
        let plot = Plot::new("Radial displacement along the axes at T")
            .x("r", "m")
            .y("u_r", "m")
            .line("x", &r, &self.radial[0])
            .dashed("z", &r, &self.radial[2]);
        found.picture(plot.save(out, "radial")?);
        let path = out.join("radial.csv");
        peridyne_io::write::table::Table::new()
            .column("r", "m", r)
            .column("radial displacement along x", "m", self.radial[0].clone())
            .column("radial displacement along y", "m", self.radial[1].clone())
            .column("radial displacement along z", "m", self.radial[2].clone())
            .save(&path)?;
        found.file(path);
        Ok(())
    }

    /// What both figures say of the wave.
    pub fn judge(&self, found: &mut Findings) {
        let crests = self.crests();
        let worst = apart(&self.radial[0], &self.radial[2]);
        found.holds(
            "spherical",
            format!("largest radial displacement at r = {crests:.4?} along x, y, z; x and z differ by {worst:.1e} m"),
            crests.iter().all(|r| (r - crests[0]).abs() < 1.5 * self.spacing),
        );
        conserved([&self.record], found);
    }
}

/// Bonds of a full family of the cubic lattice.
pub fn family(horizon: i64) -> u64 {
    let reach = -horizon..=horizon;
    let square = move |[i, j, k]: [i64; 3]| i * i + j * j + k * k;
    let all = reach.clone().flat_map(|i| {
        let reach = reach.clone();
        (-horizon..=horizon).flat_map(move |j| reach.clone().map(move |k| [i, j, k]))
    });
    all.filter(|x| (1..=horizon * horizon).contains(&square(*x)))
        .count() as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::pulse;

    #[test]
    fn the_deck_begins_with_the_profile_in_the_order_that_is_read() {
        let cube = Cube {
            points: 20,
            steps: 10,
            part: 0,
        };
        let mut sim = cube.model().unwrap();
        assert_eq!(sim.info().points, 20 * 20 * 21);
        let x = sim.vectors("reference");
        for (x, u) in x.iter().zip(sim.displacements()) {
            let r = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            let p = if r > 0.0 {
                pulse(r, 0.0, 0.2, 1e-4)
            } else {
                0.0
            };
            for a in 0..3 {
                assert!((u[a] - p * x[a] / r.max(1e-99)).abs() < 1e-17);
            }
        }
        // the middle is the point of all zeros
        let middle = (10 * 20 + 10) * 20 + 10;
        assert!(x[middle].iter().all(|x| x.abs() < 1e-12), "{:?}", x[middle]);
        assert!((x[middle + 400][2] - 0.05).abs() < 1e-12);
        assert_eq!(family(3), 122);
    }
}
