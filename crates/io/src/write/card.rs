//! The error card of an upscaling: `card.json`, `card.md`, pictures of dispersion and energy.

use super::atomic::{WriteError, write_file};
use super::plot::Plot;
use crate::deck::{Dim, UnitSystem};
use peridyne::spec::Influence;
use peridyne_theory::gradient::comparison::Verdict;
use peridyne_theory::upscale::card::{Card, Side};
use peridyne_theory::upscale::kernels::Kernel;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Measured by running both models.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// `‖u_coarse − u_fine‖ / ‖u_fine‖` at the coarse points, at the end.
    pub error: f64,
    /// Largest displacement of the fine model at those points (length).
    pub largest: f64,
    pub points: usize,
    /// Seconds of stepping.
    pub seconds: [f64; 2],
    pub steps: [u64; 2],
    /// At which both are compared, the end of the coarse deck (time).
    pub time: f64,
    /// Of both runs at the same times.
    pub energies: Energies,
}

/// Energies of both runs over time, strain energy and total less those of the body at rest in its reference.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Energies {
    /// Time; of statics t.
    pub time: Vec<f64>,
    /// `[fine, coarse][kinetic, strain, total]` at these times.
    pub of: [[Vec<f64>; 3]; 2],
}

/// What the three energies are.
pub const ENERGIES: [&str; 3] = ["kinetic", "strain", "total"];

impl Energies {
    /// The largest difference of both runs over time, over the largest value of the fine one; `None`: it has none.
    pub fn differences(&self) -> [Option<f64>; 3] {
        let [fine, coarse] = &self.of;
        std::array::from_fn(|k| {
            let size = fine[k].iter().fold(0.0f64, |m, e| m.max(e.abs()));
            let apart = fine[k].iter().zip(&coarse[k]);
            let apart = apart.fold(0.0f64, |m, (a, b)| m.max((b - a).abs()));
            (size > 0.0).then(|| apart / size)
        })
    }

    fn json(&self) -> Value {
        let [fine, coarse] = self
            .of
            .each_ref()
            .map(|e| json!({ "kinetic": e[0], "strain": e[1], "total": e[2] }));
        let [kinetic, strain, total] = self.differences();
        json!({
            "time": self.time, "fine": fine, "coarse": coarse,
            "largest_difference": { "kinetic": kinetic, "strain": strain, "total": total },
        })
    }
}

/// Words of decks.
const INFLUENCES: [(Influence, &str); 5] = [
    (Influence::Constant, "constant"),
    (Influence::Inverse, "inverse"),
    (Influence::Linear, "linear"),
    (Influence::Gaussian, "gaussian"),
    (Influence::CubicSpline, "cubic_spline"),
];

/// The word of decks, or that the deck has its own.
pub fn influence_name(influence: Influence) -> &'static str {
    let known = INFLUENCES.iter().find(|(known, _)| *known == influence);
    known.map_or("the deck's", |(_, name)| name)
}

fn side(s: &Side) -> Value {
    json!({
        "spacing": s.spacing,
        "bonds_per_point": s.bonds,
        "points_per_volume": s.points,
        "stable_step": s.stable_step,
        "reference_pressure": s.pressure,
        "reference_energy_density": s.energy,
        "stiffness": s.stiffness,
        "zener_ratio": s.anisotropy,
        "length_scale": s.length_scale,
        "unstable_waves": s.unstable,
    })
}

fn upscaling(v: &Verdict) -> Value {
    json!({
        "equal_to_order": v.order,
        "compared_to_order": v.compared,
        "first_difference": v.difference.map(|(order, part)| json!({ "order": order, "relative": part })),
        "all_in_the_limit_of_many_neighbours": v.limit,
        "verdict": v.to_string(),
    })
}

fn kernel(k: &Kernel) -> Value {
    json!({
        "influence": influence_name(k.influence),
        "horizon": k.horizon,
        "horizon_kept": k.kept,
        "bonds_per_point": k.bonds,
        "upscaling": upscaling(&k.verdict),
        "difference_of_c4": k.fourth,
        "length_scale": k.length_scale,
        "wavelength_below_which_the_error_exceeds_1_percent": k.wavelength,
    })
}

fn json(card: &Card, units: UnitSystem, measured: Option<&Measured>) -> Value {
    json!({
        "factor": card.factor,
        "dimension": card.dimension,
        "kept": card.rule.describe(),
        "upscaling": upscaling(&card.verdict),
        "kernels": card.kernels.iter().map(kernel).collect::<Vec<_>>(),
        "fine": side(&card.fine),
        "coarse": side(&card.coarse),
        "energies": card.energies.iter().map(|e| json!({
            "mode": e.mode, "strain": e.strain, "fine": e.fine, "coarse": e.coarse,
        })).collect::<Vec<_>>(),
        "gradient_coefficients": card.gradients.iter().map(|g| json!({
            "derivative": g.order, "fine": g.fine, "coarse": g.coarse,
        })).collect::<Vec<_>>(),
        "nonlinear_gradient_equation": card.nonlinear.iter().map(|g| json!({
            "stretch": g.stretch, "order": g.order, "term": g.term, "fine": g.fine, "coarse": g.coarse,
        })).collect::<Vec<_>>(),
        "dispersion": card.dispersion.iter().map(|d| json!({
            "direction": d.direction,
            "wave_number": d.wave,
            "fine": d.fine,
            "coarse": d.coarse,
            "wavelength_below_which_the_error_exceeds": d.wavelengths.iter().map(|(t, l)| json!({
                "error": t, "wavelength": l,
            })).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "predicted_cost_ratio": card.cost,
        "measured": measured.map(|m| json!({
            "displacement_error": m.error,
            "largest_displacement": m.largest,
            "points_compared": m.points,
            "seconds": m.seconds,
            "steps": m.steps,
            "time": m.time,
            "speed_up": m.seconds[0] / m.seconds[1],
            "energies": m.energies.json(),
        })),
        "notes": card.notes.iter().map(|n| units.tell(n)).collect::<Vec<_>>(),
    })
}

fn markdown(card: &Card, units: UnitSystem, measured: Option<&Measured>) -> String {
    let mut t = String::new();
    let h = card.coarse.spacing / card.fine.spacing;
    let _ = writeln!(
        t,
        "# Error card: spacing h = {h} a\n\n{}.\n",
        card.rule.describe()
    );
    if card.notes.is_empty() {
        t += "Nothing speaks against this upscaling.\n";
    }
    for note in &card.notes {
        let _ = writeln!(t, "- {}", units.tell(note));
    }
    let _ = writeln!(t, "\nGradient equations: {}.", card.verdict);
    t += &both_models(card, units);
    let what = match card.statics {
        true => "points × bonds, of an iteration",
        false => "points × bonds × steps, both at their stable step",
    };
    let _ = writeln!(t, "\nPredicted cost ({what}): 1 : {:.1}.\n", card.cost);
    t += &waves(card, units);
    if !card.kernels.is_empty() {
        t += "\nKernels for the coarse model, each fitted to the same moduli, the best first:\n\n| influence | horizon | bonds | gradient equation | c₄ | length scale √\\|c₄/c₂\\| | 1 % waves shorter than |\n|---|---:|---:|---|---:|---:|---:|\n";
    }
    for row in kernel_rows(&card.kernels, units) {
        let _ = writeln!(t, "| {} |", row.join(" | "));
    }
    t += &strain_energies(card, units);
    t += &nonlinear(card, units);
    if let Some(m) = measured {
        t += &both_runs(m, units);
    }
    t += "\n![dispersion](dispersion.png)\n\n![energy](energy.png)\n";
    if measured.is_some_and(|m| m.energies.time.len() > 1) {
        t += "\n![energies of both runs](energies.png)\n";
    }
    t
}

/// A table of what both models are.
fn both_models(card: &Card, units: UnitSystem) -> String {
    let mut t = String::from("\n| | fine | coarse |\n|---|---:|---:|\n");
    let mut row = |name: &str, f: f64, c: f64, dim: Dim| {
        let (f, c) = (units.show(f, dim), units.show(c, dim));
        let _ = writeln!(t, "| {name} | {f} | {c} |");
    };
    row(
        "spacing",
        card.fine.spacing,
        card.coarse.spacing,
        Dim::LENGTH,
    );
    row(
        "bonds of a point",
        card.fine.bonds as f64,
        card.coarse.bonds as f64,
        Dim::NUMBER,
    );
    row(
        "stable step",
        card.fine.stable_step,
        card.coarse.stable_step,
        Dim::TIME,
    );
    row(
        "pressure of the reference",
        card.fine.pressure,
        card.coarse.pressure,
        Dim::PRESSURE,
    );
    let n = card.fine.stiffness.len();
    for (i, j) in [(0, 0), (0, 1), (n - 1, n - 1)] {
        if n > 1 || (i, j) == (0, 0) {
            row(
                &format!("C{}{}", i + 1, j + 1),
                card.fine.stiffness[i][j],
                card.coarse.stiffness[i][j],
                Dim::PRESSURE,
            );
        }
        if n == 1 {
            break;
        }
    }
    if let (Some(f), Some(c)) = (card.fine.anisotropy, card.coarse.anisotropy) {
        row("Zener's ratio", f, c, Dim::NUMBER);
    }
    if let (Some(f), Some(c)) = (card.fine.length_scale, card.coarse.length_scale) {
        row("length scale √\\|c₄/c₂\\|", f, c, Dim::LENGTH);
    }
    for g in &card.gradients {
        row(
            &format!("gradient coefficient of ∂^{}", g.order),
            g.fine,
            g.coarse,
            coefficient(g.order),
        );
    }
    t
}

/// A table of the waves that the coarse model has right.
fn waves(card: &Card, units: UnitSystem) -> String {
    let mut t = String::from("| direction | error | waves shorter than |\n|---|---:|---:|\n");
    for d in &card.dispersion {
        for (tolerance, wavelength) in &d.wavelengths {
            let text = wavelength.map_or("none".into(), |l| {
                format!(
                    "{} ({:.1} h)",
                    units.show(l, Dim::LENGTH),
                    l / card.coarse.spacing
                )
            });
            let _ = writeln!(t, "| {} | {} % | {text} |", d.direction, 100.0 * tolerance);
        }
    }
    t
}

/// A table of energies under homogeneous strain.
fn strain_energies(card: &Card, units: UnitSystem) -> String {
    let mut t = String::from(
        "\n| strain | mode | energy density, fine | coarse | difference |\n|---:|---|---:|---:|---:|\n",
    );
    for e in &card.energies {
        let _ = writeln!(
            t,
            "| {} | {} | {} | {} | {:+.3} % |",
            e.strain,
            e.mode,
            units.show(e.fine, Dim::PRESSURE),
            units.show(e.coarse, Dim::PRESSURE),
            100.0 * (e.coarse - e.fine) / e.fine
        );
    }
    t
}

/// A table of the nonlinear gradient equation, where there is one.
fn nonlinear(card: &Card, units: UnitSystem) -> String {
    let mut t = String::new();
    if !card.nonlinear.is_empty() {
        t += "\nThe nonlinear gradient equation ρ ÿ = Σ c · term, at the stretch y':\n\n| y' | order | term | fine | coarse |\n|---:|---:|---|---:|---:|\n";
    }
    for g in &card.nonlinear {
        let _ = writeln!(
            t,
            "| {} | {} | {} | {} | {} |",
            g.stretch,
            g.order,
            g.term,
            units.show(g.fine, coefficient(g.order)),
            units.show(g.coarse, coefficient(g.order))
        );
    }
    t
}

/// What running both models said.
fn both_runs(m: &Measured, units: UnitSystem) -> String {
    let mut t = String::new();
    let _ = writeln!(
        t,
        "\nBoth were run to {}, the end of the coarse deck: {} and {} steps in {:.3} and {:.3} s of stepping, {:.1} times as fast. The displacements at the {} coarse points differ by {:.3} % (root mean square, largest displacement {}).",
        units.show(m.time, Dim::TIME),
        m.steps[0],
        m.steps[1],
        m.seconds[0],
        m.seconds[1],
        m.seconds[0] / m.seconds[1],
        m.points,
        100.0 * m.error,
        units.show(m.largest, Dim::LENGTH)
    );
    let _ = writeln!(t, "\nThe {}.", energies_told(&m.energies));
    t
}

/// Cells of the table of kernels: influence, horizon, bonds, gradient equation, c₄, length scale, wavelength of 1 %.
pub fn kernel_rows(kernels: &[Kernel], units: UnitSystem) -> Vec<[String; 7]> {
    let length = |l: f64| units.show(l, Dim::LENGTH);
    let row = |k: &Kernel| {
        [
            influence_name(k.influence).to_string(),
            format!(
                "{}{}",
                length(k.horizon),
                if k.kept { " (kept)" } else { "" }
            ),
            k.bonds.to_string(),
            k.verdict.equal(),
            k.fourth
                .map_or("–".into(), |f| format!("{:+.2} %", 100.0 * f)),
            k.length_scale.map_or("–".into(), length),
            k.wavelength.map_or("none".into(), length),
        ]
    };
    kernels.iter().map(row).collect()
}

/// How far the energies of both runs are apart.
pub fn energies_told(energies: &Energies) -> String {
    let each = ENERGIES.iter().zip(energies.differences());
    let each: Vec<String> = each
        .filter_map(|(name, d)| Some(format!("{name} {:.3} %", 100.0 * d?)))
        .collect();
    match each.is_empty() {
        true => "energies of both runs are zero".into(),
        false => format!(
            "energies of both runs differ over time by at most, of the largest: {}",
            each.join(", ")
        ),
    }
}

/// Writes the card into `dir`; numbers of `card.md` and of pictures are in these units.
///
/// # Errors
/// The first file that could not be written.
pub fn write(
    dir: &Path,
    card: &Card,
    units: UnitSystem,
    measured: Option<&Measured>,
) -> Result<Vec<PathBuf>, WriteError> {
    let mut files = vec![dir.join("card.json"), dir.join("card.md")];
    write_file(&files[0], |w| {
        Ok(serde_json::to_writer_pretty(
            w,
            &json(card, units, measured),
        )?)
    })?;
    write_file(&files[1], |w| {
        w.write_all(markdown(card, units, measured).as_bytes())
    })?;
    let mut plot = Plot::new(format!("Dispersion, h = {} a", card.factor))
        .x("wave number", &units.unit(Dim::INVERSE_LENGTH))
        .y("frequency ω", &units.unit(Dim::FREQUENCY));
    for d in &card.dispersion {
        let top = |rows: &[Vec<f64>]| -> Vec<f64> {
            rows.iter()
                .map(|r| r.last().copied().unwrap_or(f64::NAN))
                .collect()
        };
        plot = plot
            .line(&format!("fine, {}", d.direction), &d.wave, &top(&d.fine))
            .dashed(
                &format!("coarse, {}", d.direction),
                &d.wave,
                &top(&d.coarse),
            );
    }
    files.extend(plot.save(dir, "dispersion")?);
    let mut plot = Plot::new("Energy density under homogeneous strain")
        .x("strain", "")
        .y("energy density", &units.unit(Dim::PRESSURE));
    for mode in ["isotropic", "uniaxial", "shear"] {
        let rows = || card.energies.iter().filter(|e| e.mode == mode);
        let strain: Vec<f64> = rows().map(|e| e.strain).collect();
        if strain.is_empty() {
            continue;
        }
        let fine: Vec<f64> = rows().map(|e| e.fine).collect();
        let coarse: Vec<f64> = rows().map(|e| e.coarse).collect();
        plot = plot.line(&format!("{mode}, fine"), &strain, &fine).points(
            &format!("{mode}, coarse"),
            &strain,
            &coarse,
        );
    }
    if !card.energies.is_empty() {
        files.extend(plot.save(dir, "energy")?);
    }
    if let Some(m) = measured.filter(|m| m.energies.time.len() > 1) {
        let time = match card.statics {
            true => String::new(),
            false => units.unit(Dim::TIME),
        };
        let mut plot = Plot::new("Energies of both runs, of the strain since the body at rest")
            .x("t", &time)
            .y("energy", &units.unit(Dim::ENERGY));
        let [fine, coarse] = &m.energies.of;
        for (k, name) in ENERGIES.iter().enumerate() {
            plot = plot
                .line(&format!("{name}, fine"), &m.energies.time, &fine[k])
                .dashed(&format!("{name}, coarse"), &m.energies.time, &coarse[k]);
        }
        files.extend(plot.save(dir, "energies")?);
    }
    Ok(files)
}

/// What a coefficient of so many derivatives measures: `ρ ü = Σ c_k ∂^k u`.
fn coefficient(order: usize) -> Dim {
    let lengths = i8::try_from(order).unwrap_or(i8::MAX).saturating_sub(2);
    let dim = Dim::PRESSURE.times(Dim::LENGTH, lengths);
    dim.unwrap_or(Dim::NUMBER)
}
