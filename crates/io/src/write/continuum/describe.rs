//! `fields.json`: what every quantity is, how it was made, and how well the balance laws hold.

use super::columns::Table;
use super::columns::components;
use crate::continuum::Units;
use peridyne::state::{Archive, Owner};
use peridyne_fields::fields::Totals;
use peridyne_fields::residuals::{Residual, Residuals};
use peridyne_fields::{Method, Quantity};
use serde_json::{Map, Value, json};

/// Of a frame.
#[derive(Debug, Clone)]
pub struct Frame {
    pub index: usize,
    pub step: Option<u64>,
    pub time: Option<f64>,
    pub atoms: usize,
    pub totals: Totals,
    pub volume: f64,
    /// Or why they were not measured.
    pub residuals: Result<Residuals, String>,
    /// Largest difference of two stresses across the diagonal over the largest stress.
    pub asymmetry: f64,
    /// Of the mean over a periodic grid of `σ − ρ v⊗v` (`σ_U` without velocities) from the virial, over the largest of its components.
    pub virial: Option<f64>,
    /// Of the mean of z over a periodic grid, over the largest potential stress there.
    pub churning: Option<f64>,
    /// Largest difference of a force from that of the file over the largest force, where the file has them.
    pub forces: Option<f64>,
}

impl Frame {
    /// Of nothing.
    pub(super) fn none() -> Frame {
        Frame {
            index: 0,
            step: None,
            time: None,
            atoms: 0,
            totals: Totals::default(),
            volume: 0.0,
            residuals: Err(String::new()),
            asymmetry: 0.0,
            virial: None,
            churning: None,
            forces: None,
        }
    }
}

impl Owner for Frame {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("index", &mut self.index);
        archive.one("step", &mut self.step);
        archive.one("time", &mut self.time);
        archive.one("atoms", &mut self.atoms);
        archive.one("totals", &mut self.totals);
        archive.one("volume", &mut self.volume);
        let mut measured = self.residuals.as_ref().ok().copied();
        let mut why = self.residuals.as_ref().err().cloned().unwrap_or_default();
        archive.one("residuals", &mut measured);
        archive.text("why_none", &mut why);
        self.residuals = measured.ok_or(why);
        archive.one("asymmetry", &mut self.asymmetry);
        archive.one("virial", &mut self.virial);
        archive.one("churning", &mut self.churning);
        archive.one("forces", &mut self.forces);
    }
}

/// All that is the same for all frames.
#[derive(Debug, Clone)]
pub struct About<'a> {
    pub frames: &'a str,
    pub potential: &'a str,
    pub units: Units,
    pub method: &'a Method,
    pub read: Vec<Frame>,
}

fn residual(of: &Residual) -> Value {
    json!({
        "value": of.value,
        "relative": of.relative(),
        "expected": of.expected,
        "extrapolated": of.extrapolated,
        "scale": of.scale,
    })
}

fn number(x: f64) -> Value {
    serde_json::Number::from_f64(x).map_or(Value::Null, Value::Number)
}

fn frame(of: &Frame) -> Value {
    let residuals = match &of.residuals {
        Ok(all) => json!({
            "mass": residual(&all.mass),
            "momentum": residual(&all.momentum),
            "energy": residual(&all.energy),
            "internal_energy": residual(&all.internal_energy),
            "coordinate": residual(&all.coordinate),
            "angular_momentum": residual(&all.angular_momentum),
            "points": all.points,
            "step": all.step,
        }),
        Err(why) => json!({ "missing": why }),
    };
    let size = of.totals.virial.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let exact = of
        .totals
        .churning
        .iter()
        .fold(0.0f64, |m, x| m.max(x.abs()));
    json!({
        "frame": of.index,
        "step": of.step,
        "time": of.time,
        "atoms": of.atoms,
        "volume": of.volume,
        "potential_energy": of.totals.complete.then_some(of.totals.energy),
        "virial_stress": of.totals.complete.then(|| of.totals.virial.map(|x| number(-x / of.volume))),
        "residuals": residuals,
        "asymmetry_of_stress": number(of.asymmetry),
        "mean_stress_against_virial": of.virial.map(number),
        "mean_churning_over_stress": of.churning.map(number),
        "integral_of_churning_over_virial": number(if size > 0.0 { exact / size } else { 0.0 }),
        "forces_against_file": of.forces.map(number),
    })
}

/// The whole description.
pub fn describe(about: &About, table: &Table) -> Value {
    let mut quantities = Map::new();
    for column in &table.columns {
        let q = column.quantity;
        let shape: &[usize] = match q.components() {
            3 => &[3],
            9 => &[3, 3],
            _ => &[],
        };
        let mut own = json!({
            "name": q.name(),
            "unit": column.unit,
            "shape": shape,
            "columns": components(&column.name, q),
            "equation": q.equation(),
        });
        match (&column.values, &mut own) {
            (Err(why), Value::Object(own)) => {
                own.insert("missing".into(), json!(why));
            }
            (Ok(values), Value::Object(own)) => {
                let none = values.iter().filter(|v| !v.is_finite()).count();
                own.insert("undefined".into(), json!(none / q.components().max(1)));
            }
            _ => {}
        }
        if q == Quantity::Temperature
            && let Value::Object(own) = &mut own
        {
            own.insert("boltzmann".into(), json!(about.units.boltzmann()));
        }
        quantities.insert(column.name.clone(), own);
    }
    let kernel = &about.method.kernel;
    let averaged: Vec<&str> = (0..3)
        .filter(|a| kernel.averaged_axes()[*a].is_some())
        .map(|a| ["x", "y", "z"][a])
        .collect();
    let worst = |of: &dyn Fn(&Residuals) -> f64| {
        let all = about.read.iter().filter_map(|f| f.residuals.as_ref().ok());
        let most = all.map(of).fold(f64::NAN, f64::max);
        number(most)
    };
    json!({
        "program": concat!("peridyne ", env!("CARGO_PKG_VERSION")),
        "source": "lehoucq2010, chapter 4; stress positive in tension; the first index of tensors is that of the divergence",
        "frames": about.frames,
        "frames_read": about.read.len(),
        "potential": about.potential,
        "units": about.units.name(),
        "kernel": {
            "name": kernel.shape().name(),
            "formula": kernel.shape().formula(),
            "width": kernel.width(),
            "radius": kernel.radius(),
            "peak": kernel.value([0.0; 3]),
            "averaged_over": averaged,
        },
        "partition": about.method.partition.name(),
        "pair_force": about.method.pair_force.name(),
        "points": table.points.len(),
        "grid": table.grid.as_ref().map(|(n, cell)| json!({
            "size": n,
            "origin": cell.origin,
            "edges": cell.edges,
            "points": "centres of equal pieces of the cell, x fastest",
        })),
        "quantities": quantities,
        "residuals": {
            "what": "root mean square over points of what is left of a balance law; relative to the rate that cancels; expected: by the differences over the step alone; extrapolated: with the steps h and 2h combined",
            "mass": worst(&|r| r.mass.relative()),
            "momentum": worst(&|r| r.momentum.relative()),
            "energy": worst(&|r| r.energy.relative()),
            "internal_energy": worst(&|r| r.internal_energy.relative()),
            "coordinate": worst(&|r| r.coordinate.relative()),
            "angular_momentum": worst(&|r| r.angular_momentum.relative()),
            "mass_extrapolated": worst(&|r| relative(&r.mass)),
            "momentum_extrapolated": worst(&|r| relative(&r.momentum)),
            "energy_extrapolated": worst(&|r| relative(&r.energy)),
        },
        "each_frame": about.read.iter().map(frame).collect::<Vec<_>>(),
    })
}

fn relative(of: &Residual) -> f64 {
    if of.scale > 0.0 {
        of.extrapolated / of.scale
    } else {
        0.0
    }
}
