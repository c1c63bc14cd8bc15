//! A layer of steel is sheared: heat softens it more than strain and its rate harden it, and flow is localised in a band.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    ShearBand,
    "shear-band",
    "A layer of steel is sheared until its flow localises (Molinari & Clifton)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (SI): shear modulus, yield stress, ε₀ and n of Swift's law, ε̇₀ and 1/m of the rate's, rise of the temperature where nothing
/// is left of the strength, its exponent, part of the work that heats over the heat per volume.
const SHEAR: f64 = 200e9 / 2.6;
const YIELD: f64 = 2e9;
const REFERENCE: f64 = 0.01;
const N: f64 = 0.01;
const SLOWEST: f64 = 1e-3;
const RATE: f64 = 70.0;
const MELTED: f64 = 405.5;
const THERMAL: f64 = 1.32;
const HEATING: f64 = 0.9 / (7830.0 * 448.0);
/// Of the layer: its height, half of the distance of the marks, the weaker part and what it yields at, nominal strain per time.
const HEIGHT: f64 = 2.5e-3;
const MARK: f64 = 1e-3;
const WEAK: f64 = 0.5e-3;
const PART: f64 = 0.998;
const NOMINAL: f64 = 2000.0;

/// Course of a test: nominal strain, shear stress, plastic strain of the rest.
#[derive(Default)]
struct Course {
    strain: Vec<f64>,
    stress: Vec<f64>,
    rest: Vec<f64>,
}

impl Course {
    fn top(&self) -> usize {
        let all = (0..self.stress.len()).max_by(|a, b| self.stress[*a].total_cmp(&self.stress[*b]));
        all.unwrap_or(0)
    }

    /// Nominal strain at which the stress has fallen to this part of the greatest.
    fn fallen(&self, part: f64) -> Option<f64> {
        let top = self.top();
        let low = part * self.stress[top];
        let k = (top..self.stress.len()).find(|k| self.stress[*k] < low)?;
        Some(self.strain[k])
    }

    fn stress_at(&self, strain: f64) -> f64 {
        crate::gallery::bench::level(&self.strain, &self.stress, strain).unwrap_or(f64::NAN)
    }
}

/// Two layers side by side under one shear stress, adiabatic, up to a nominal strain: a step of the stress is implicit in what flows.
fn layers(weak: f64, part: f64, end: f64) -> Course {
    const STEP: f64 = 1e-5;
    let share = [weak, 1.0 - weak];
    let strength = [part, 1.0];
    let dt = STEP / NOMINAL;
    let [mut strain, mut heat] = [[0.0; 2]; 2];
    let mut stress = 0.0;
    let mut course = Course::default();
    for n in 1..=(end / STEP) as usize {
        let mises = 3f64.sqrt() * stress;
        let flow = |k: usize| {
            let hard = strength[k] * YIELD * (1.0 + strain[k] / REFERENCE).powf(N);
            let soft = 1.0 - (heat[k] / MELTED).clamp(0.0, 0.999_999).powf(THERMAL);
            SLOWEST * (mises / (hard * soft)).powf(RATE)
        };
        let rates = [flow(0), flow(1)];
        let all = 3f64.sqrt() * (share[0] * rates[0] + share[1] * rates[1]);
        let slope = if stress > 0.0 {
            RATE * all / stress
        } else {
            0.0
        };
        let rise = SHEAR * (NOMINAL - all) * dt / (1.0 + SHEAR * slope * dt);
        let grown = if all > 0.0 {
            1.0 + slope * rise / all
        } else {
            0.0
        };
        for k in 0..2 {
            let step = rates[k] * grown * dt;
            strain[k] += step;
            heat[k] += HEATING * mises * step;
        }
        stress += rise;
        course.strain.push(STEP * n as f64);
        course.stress.push(stress);
        course.rest.push(strain[1]);
    }
    course
}

fn mean(values: &[f64], of: &[usize]) -> f64 {
    of.iter().map(|k| values[*k]).sum::<f64>() / of.len() as f64
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let set: &[(&str, &str)] = match context.small {
        true => &[("constants.h", "50 um")],
        false => &[],
    };
    let mut bench = Bench::new(DECK, set)?;
    let x = bench.places();
    let h = bench.sim.info().spacing;
    let rest = (0..x.len()).filter(|k| (x[*k][1].abs() - 0.32 * HEIGHT).abs() < 0.05 * HEIGHT);
    let rest: Vec<usize> = rest.collect();
    // the body is six spacings long and 1 mm thick
    let area = 6.0 * h * 1e-3;
    let steps = bench.steps();
    let every = (steps / 1000).max(1);
    let mut course = Course::default();
    for n in 1..=steps {
        bench.step()?;
        if n % every != 0 {
            continue;
        }
        let slid = bench.probe("mark_x")? - bench.probe("other_x")?;
        course.strain.push(slid / (2.0 * MARK));
        course.stress.push(bench.probe("pull_x")?.abs() / area);
        course
            .rest
            .push(mean(&bench.values("plastic_strain", 0)?, &rest));
    }
    let end = course.strain.last().copied().unwrap_or(f64::NAN);
    let theory = layers(WEAK / (2.0 * MARK), PART, end);
    let even = layers(WEAK / (2.0 * MARK), 1.0, end);

    let [top, theirs] = [&course, &theory].map(|c| c.stress[c.top()]);
    found.number("greatest", top / theirs);
    found.measured("greatest shear stress", 1e-6 * top, "MPa");
    found.measured(
        "greatest shear stress of the two layers",
        1e-6 * theirs,
        "MPa",
    );
    found.measured("nominal strain there", course.strain[course.top()], "");
    found.measured(
        "nominal strain there, of the two layers",
        theory.strain[theory.top()],
        "",
    );
    let late = |c: &Course, part: f64| {
        let at = c.fallen(part);
        at.ok_or_else(|| Failure::new(format!("the stress does not fall to {part}")))
    };
    let last = late(&course, 0.98)?.min(late(&theory, 0.98)?);
    let part = (0..course.strain.len()).filter(|k| (0.025..last).contains(&course.strain[*k]));
    let apart = part.map(|k| (course.stress[k] / theory.stress_at(course.strain[k]) - 1.0).abs());
    found.number("curve", apart.fold(0.0, f64::max));
    found.number("onset", late(&course, 0.95)? / late(&theory, 0.95)?);
    found.measured(
        "nominal strain where the stress has fallen by 5 %",
        late(&course, 0.95)?,
        "",
    );
    found.measured(
        "without a weakness",
        even.fallen(0.95).unwrap_or(f64::NAN),
        "",
    );
    let of_rest = |c: &Course| c.rest.last().copied().unwrap_or(f64::NAN);
    found.number("rest", of_rest(&course) / of_rest(&theory));

    let [strain, heat] = [
        bench.values("plastic_strain", 0)?,
        bench.values("temperature_rise", 0)?,
    ];
    let [most, hottest] = [&strain, &heat].map(|v| v.iter().copied().fold(0.0, f64::max));
    let cold = mean(&heat, &rest);
    found.holds(
        "heat",
        format!("{hottest:.0} K, {cold:.0} K"),
        hottest > 300.0 && cold < 50.0,
    );
    found.measured("largest plastic strain", most, "");
    // rows of the first column, from below
    let mut rows: Vec<usize> = (0..x.len()).filter(|k| x[*k][0] < h).collect();
    rows.sort_by(|a, b| x[*a][1].total_cmp(&x[*b][1]));
    let wide = rows.iter().filter(|k| strain[**k] > 0.5 * most).count() as f64 * h;
    found.holds(
        "width",
        format!("{:.0} µm, the horizon is {:.0} µm", 1e6 * wide, 2e6 * h),
        wide <= 4.0 * h * (1.0 + 1e-9),
    );

    let mega = |c: &Course| c.stress.iter().map(|s| 1e-6 * s).collect::<Vec<f64>>();
    let plot = Plot::new("Shear stress of a layer whose flow localises")
        .x("nominal shear strain", "")
        .y("shear stress", "MPa")
        .line("two layers", &theory.strain, &mega(&theory))
        .line("one layer, even", &even.strain, &mega(&even))
        .line("computed", &course.strain, &mega(&course));
    found.picture(plot.save(&context.out, "stress")?);
    let micro: Vec<f64> = rows.iter().map(|k| 1e6 * x[*k][1]).collect();
    let across: Vec<f64> = rows.iter().map(|k| strain[*k]).collect();
    let plot = Plot::new("Plastic strain across the layer")
        .x("y", "µm")
        .y("plastic strain", "")
        .points("computed", &micro, &across);
    found.picture(plot.save(&context.out, "strain")?);
    let path = context.out.join("stress.csv");
    Table::new()
        .column("nominal shear strain", "", course.strain)
        .column("shear stress", "Pa", course.stress)
        .column("plastic strain of the rest", "", course.rest)
        .save(&path)?;
    found.file(path);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_layer_follows_its_adiabatic_curve() {
        // slow beside its waves, the flow takes the nominal rate: τ √3 = g(ε) (ε̇/ε̇₀)^m (1 − T*)
        let course = layers(0.25, 1.0, 0.1);
        let k = course.strain.len() - 1;
        let (strain, mut heat) = (course.rest[k], 0.0);
        let rate = (NOMINAL / 3f64.sqrt() / SLOWEST).powf(1.0 / RATE);
        let stress = |strain: f64, heat: f64| {
            YIELD
                * (1.0 + strain / REFERENCE).powf(N)
                * rate
                * (1.0 - f64::powf(heat / MELTED, THERMAL))
        };
        let steps = 10_000;
        for n in 0..steps {
            let at = strain * (f64::from(n) + 0.5) / f64::from(steps);
            heat += HEATING * stress(at, heat) * strain / f64::from(steps);
        }
        let ratio = course.stress[k] * 3f64.sqrt() / stress(strain, heat);
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    }
}
