//! The error card of an upscaling: `card.json`, `card.md`, pictures of dispersion and energy.

use super::atomic::{WriteError, write_file};
use super::plot::Plot;
use crate::deck::{Dim, UnitSystem};
use peridyne_theory::upscale::card::{Card, Side};
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
        "unstable_waves": s.unstable,
    })
}

fn json(card: &Card, units: UnitSystem, measured: Option<&Measured>) -> Value {
    json!({
        "factor": card.factor,
        "dimension": card.dimension,
        "kept": card.rule.describe(),
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
        })),
        "notes": card.notes.iter().map(|n| units.tell(n)).collect::<Vec<_>>(),
    })
}

fn markdown(card: &Card, units: UnitSystem, measured: Option<&Measured>) -> String {
    let mut t = String::new();
    let pressure = Dim::PRESSURE;
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
    t += "\n| | fine | coarse |\n|---|---:|---:|\n";
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
        pressure,
    );
    let n = card.fine.stiffness.len();
    for (i, j) in [(0, 0), (0, 1), (n - 1, n - 1)] {
        if n > 1 || (i, j) == (0, 0) {
            row(
                &format!("C{}{}", i + 1, j + 1),
                card.fine.stiffness[i][j],
                card.coarse.stiffness[i][j],
                pressure,
            );
        }
        if n == 1 {
            break;
        }
    }
    if let (Some(f), Some(c)) = (card.fine.anisotropy, card.coarse.anisotropy) {
        row("Zener's ratio", f, c, Dim::NUMBER);
    }
    for g in &card.gradients {
        row(
            &format!("gradient coefficient of ∂^{}", g.order),
            g.fine,
            g.coarse,
            coefficient(g.order),
        );
    }
    let _ = writeln!(
        t,
        "\nPredicted cost (points × bonds × steps, both at their stable step): 1 : {:.1}.\n",
        card.cost
    );
    t += "| direction | error | waves shorter than |\n|---|---:|---:|\n";
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
    t += "\n| strain | mode | energy density, fine | coarse | difference |\n|---:|---|---:|---:|---:|\n";
    for e in &card.energies {
        let _ = writeln!(
            t,
            "| {} | {} | {} | {} | {:+.3} % |",
            e.strain,
            e.mode,
            units.show(e.fine, pressure),
            units.show(e.coarse, pressure),
            100.0 * (e.coarse - e.fine) / e.fine
        );
    }
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
    if let Some(m) = measured {
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
    }
    t += "\n![dispersion](dispersion.png)\n\n![energy](energy.png)\n";
    t
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
    Ok(files)
}

/// What a coefficient of so many derivatives measures: `ρ ü = Σ c_k ∂^k u`.
fn coefficient(order: usize) -> Dim {
    let lengths = i8::try_from(order).unwrap_or(i8::MAX).saturating_sub(2);
    let dim = Dim::PRESSURE.times(Dim::LENGTH, lengths);
    dim.unwrap_or(Dim::NUMBER)
}
