//! What the problems share: a deck that is run, its state, its picture.

use std::path::PathBuf;

use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::{Deck, UnitSystem};
use peridyne_io::write::picture::rigid::Placed;
use peridyne_io::write::picture::shown::About;
use peridyne_io::write::picture::{self, PictureOptions};
use peridyne_io::write::plot::{ColorMap, Map};

use crate::{Context, Failure, Findings};

/// A deck and its model.
pub struct Bench {
    pub deck: Deck,
    pub sim: Box<dyn Simulation>,
}

impl Bench {
    /// With some entries replaced, before the first step.
    pub fn new(text: &str, set: &[(&str, &str)]) -> Result<Bench, Failure> {
        let set: Vec<_> = set
            .iter()
            .map(|(k, v)| (k.to_string(), v.to_string()))
            .collect();
        let deck = Deck::parse(text, "deck.toml", &set).map_err(|e| Failure::new(e.to_string()))?;
        let mut sim = build(&deck.spec, Options::default())
            .map_err(|e| Failure::new(deck.explain(&e).to_string()))?;
        sim.start(true);
        Ok(Bench { deck, sim })
    }

    /// To the end of the deck.
    pub fn finished(text: &str, set: &[(&str, &str)]) -> Result<Bench, Failure> {
        let mut bench = Bench::new(text, set)?;
        for _ in 0..bench.steps() {
            bench.step()?;
        }
        Ok(bench)
    }

    /// Steps, or increments, of the deck.
    pub fn steps(&self) -> u64 {
        self.deck.steps(self.sim.info().time_step)
    }

    pub fn step(&mut self) -> Result<(), Failure> {
        self.sim.step().map_err(|e| Failure::new(e.to_string()))
    }

    /// Reference positions.
    pub fn places(&mut self) -> Vec<[f64; 2]> {
        let x = self.sim.vectors("reference");
        x.iter().map(|x| [x[0], x[1]]).collect()
    }

    /// A component of a column, by point.
    pub fn values(&mut self, column: &str, component: usize) -> Result<Vec<f64>, Failure> {
        let values = self.sim.column(column).map(|c| c.values);
        let values = values.ok_or_else(|| Failure::new(format!("no column {column}")))?;
        Ok((0..values.len()).map(|i| values.at(i, component)).collect())
    }

    /// What a probe measures now, by the name of its column: `load_y`.
    pub fn probe(&mut self, column: &str) -> Result<f64, Failure> {
        let at = self.sim.probe_columns();
        let at = at.iter().position(|c| c.name == column);
        let at = at.ok_or_else(|| Failure::new(format!("no probe {column}")))?;
        Ok(self.sim.measure()[at])
    }

    /// What the program draws at the end of a run.
    pub fn damage(
        &mut self,
        context: &Context,
        name: &str,
        found: &mut Findings,
    ) -> Result<(), Failure> {
        self.drawn(context, name, ["damage", ""], About::Fracture, found)
    }

    /// The same of any field, or a component of it.
    pub fn drawn(
        &mut self,
        context: &Context,
        name: &str,
        [field, component]: [&str; 2],
        about: About,
        found: &mut Findings,
    ) -> Result<(), Failure> {
        let path: PathBuf = context.out.join(format!("{name}.png"));
        let options = PictureOptions {
            title: self.deck.spec.title.clone(),
            length_unit: "m".into(),
            time_unit: "s".into(),
            units: UnitSystem::Si,
            // names of components need room
            width: if component.is_empty() { 800 } else { 1200 },
            field: Some(field.into()),
            component: Some(component.to_string()).filter(|c| !c.is_empty()),
            still: matches!(about, About::Equilibrium),
            ..PictureOptions::default()
        };
        let shown = self.sim.snapshot(&[field], false);
        let spec = &self.deck.spec;
        let centers = spec
            .loading
            .rigid_bodies
            .iter()
            .zip(self.sim.rigid_bodies());
        let bodies = centers.map(|(body, center)| Placed {
            center,
            ..Placed::at(body, spec.space.dimension, shown.time)
        });
        let bodies: Vec<Placed> = bodies.collect();
        picture::write(&path, &shown, &bodies, &options, about)?;
        found.file(path);
        Ok(())
    }

    /// `field.png`: values of points where they are in the reference.
    pub fn map(
        &mut self,
        context: &Context,
        name: [&str; 2],
        values: &[f64],
        range: [f64; 2],
        found: &mut Findings,
    ) -> Result<(), Failure> {
        let points = self.places();
        let h = self.sim.info().spacing;
        let along = |axis: usize| {
            let all = points.iter().map(|p| p[axis]);
            let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), x| {
                (l.min(x), u.max(x))
            });
            [low - 0.5 * h, high + 0.5 * h]
        };
        let map = Map::new(&self.deck.spec.title)
            .x("x", "m", along(0))
            .y("y", "m", along(1))
            .value(name[0], name[1])
            .between(range[0], range[1])
            .colors(ColorMap::Sequential)
            .equal()
            .points(&points, values, h);
        found.picture(map.save(&context.out, "field")?);
        Ok(())
    }
}

/// Place and value of the largest size, of points that are asked for.
pub fn peak(x: &[[f64; 2]], u: &[f64], of: impl Fn(f64) -> bool) -> [f64; 2] {
    let all = x.iter().zip(u).filter(|(x, _)| of(x[0]));
    all.fold([f64::NAN, 0.0], |[at, top], (x, u)| {
        if u.abs() > top.abs() {
            [x[0], *u]
        } else {
            [at, top]
        }
    })
}

/// The value at a place, between points.
pub fn level(x: &[f64], y: &[f64], place: f64) -> Option<f64> {
    let k = (1..x.len()).find(|k| x[k - 1] <= place && place <= x[*k])?;
    let part = (place - x[k - 1]) / (x[k] - x[k - 1]);
    Some(y[k - 1] + part * (y[k] - y[k - 1]))
}

/// A point with this damage lies at a crack; beside a straight one damage is below one half, and above 0.35 in the row at the crack.
pub const CRACKED: f64 = 0.35;

/// Speed of Rayleigh waves, Viktorov's approximation.
pub fn rayleigh(young: f64, nu: f64, density: f64) -> f64 {
    (young / (2.0 * (1.0 + nu)) / density).sqrt() * (0.862 + 1.14 * nu) / (1.0 + nu)
}

/// What values near whose error is of first order in the spacing, from those of a spacing and of half of it.
pub fn limit(coarse: f64, fine: f64) -> f64 {
    2.0 * fine - coarse
}

/// Slope of the least squares' line.
pub fn slope(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len() as f64;
    let [mx, my] = [x, y].map(|v| v.iter().sum::<f64>() / n);
    let both = x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my));
    both.sum::<f64>() / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>()
}

/// Steady speed of a tip: the largest slope over `width` of time.
pub fn fastest(t: &[f64], tip: &[f64], width: f64) -> f64 {
    let mut top = 0.0;
    for a in 0..t.len() {
        let b = t.iter().position(|u| *u >= t[a] + width);
        let Some(b) = b else { break };
        top = f64::max(top, slope(&t[a..=b], &tip[a..=b]));
    }
    top
}
