//! Table 1: the constants of the embedded-atom chain, and what they imply.

use peridyne::law::potential::Described;
use peridyne::law::potential::Potential;
use peridyne::law::potential::mei::{EamForm, Mei};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::PotentialSpec;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::crystal::Crystal;
use peridyne_theory::crystal::potential::{Reach, Reference};

use super::chain::{DECK, Family, parsed};
use super::deck;
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Table1,
    "table-1",
    "Constants of the embedded-atom model",
    ["../chain.rs", "../figure-1/chain.toml"]
);

/// Copper's bulk modulus (GPa) and cube (Å), which the fit has; eV (J).
const COPPER_BULK: f64 = 138.0;
const COPPER_CUBE: f64 = 3.6147;
const ELECTRONVOLT: f64 = 1.602_176_634e-19;

fn mei(potential: Option<&PotentialSpec>) -> Result<Mei, Failure> {
    let read = potential.map(|p| EamForm::read(&p.parameters));
    match read {
        Some(Ok(mei)) => Ok(Mei::new(mei)),
        Some(Err(_)) | None => Err(Failure::new("the deck has another potential")),
    }
}

/// The uniform chain of a spacing.
fn uniform(mei: &Mei, spacing: f64) -> Result<Reference, Failure> {
    let chain = Crystal::<1>::of_potential(mei, LatticeKind::Chain, spacing, 1.0, Reach::Cutoff);
    chain.map(|c| c.1).map_err(|e| Failure::new(e.to_string()))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let mut models = vec![];
    for h in [1.0, 2.0, 4.0] {
        models.push((h, mei(parsed(h, Family::Chain)?.spec.potential())?));
    }
    let (_, md) = &models[0];
    let s = md.spec();
    let names = [
        "E_c", "φ_e", "α", "β", "γ", "λ", "f_e/ρ_e", "r_n/a", "r_c/a",
    ];
    let values = [
        s.cohesive,
        s.pair,
        s.alpha,
        s.beta,
        s.gamma,
        s.lambda,
        s.density_scale,
        s.near,
        s.cutoff,
    ];
    let c = (0..6).map(|l| (format!("c_{l}"), s.density[l]));
    let rows: Vec<(String, f64)> = names
        .map(String::from)
        .into_iter()
        .zip(values)
        .chain(c)
        .collect();
    let path = context.out.join("constants.csv");
    Table::new()
        .text("constant", rows.iter().map(|r| r.0.clone()))
        .column("value", "", rows.iter().map(|r| r.1))
        .save(&path)?;
    found.file(path);

    // α = (9 K Ω/E_c)^½, Ω a quarter of the cube
    let volume = COPPER_CUBE.powi(3) / 4.0;
    let bulk = COPPER_BULK * 1e9 * 1e-30 / ELECTRONVOLT;
    found.number("alpha", (9.0 * bulk * volume / s.cohesive).sqrt());
    found.measured("α of the deck", s.alpha, "");

    // the host density of the fcc crystal that f was fitted to, without cut-off function
    let f = |x: f64| -> f64 { (0..6).map(|l| s.density[l] * x.powi(-(l as i32))).sum() };
    let fcc: f64 = [(12.0, 1.0f64), (6.0, 2.0), (24.0, 3.0)]
        .iter()
        .map(|(count, square)| count * f(square.sqrt()))
        .sum();
    found.number("fcc-density", fcc * s.density_scale);

    // remark 3.1: energy density under uniform stretches, for all h
    let stretches: Vec<f64> = (0..=60).map(|k| 0.85 + 0.005 * f64::from(k)).collect();
    let mut energies = vec![];
    for (h, mei) in &models {
        let of = |x: &f64| uniform(mei, x * h).map(|r| r.energy / h);
        energies.push(stretches.iter().map(of).collect::<Result<Vec<f64>, _>>()?);
    }
    let pairs = energies[1..]
        .iter()
        .flat_map(|e| e.iter().zip(&energies[0]));
    found.number(
        "upscaling",
        largest(pairs.map(|(a, b)| (a / b - 1.0).abs())),
    );
    let path = context.out.join("uniform.csv");
    Table::new()
        .column("stretch", "", stretches.clone())
        .column("energy density, h = a", "", energies[0].clone())
        .column("energy density, h = 2a", "", energies[1].clone())
        .column("energy density, h = 4a", "", energies[2].clone())
        .save(&path)?;
    found.file(path);
    let plot = Plot::new("Energy per reference volume of the uniform chain")
        .x("stretch", "")
        .y("energy density", "")
        .line("h = a", &stretches, &energies[0])
        .dashed("h = 4a", &stretches, &energies[2]);
    found.picture(plot.save(&context.out, "uniform")?);

    let rest = uniform(md, 1.0)?;
    found.holds(
        "pressure",
        format!(
            "pressure {:.4}, host density {:.5} ρ_e",
            rest.pressure, rest.density
        ),
        rest.pressure > 1.0 && rest.density > 0.0,
    );
    // σ = 2 in f, too: the first stretch below 1 at which there is no density
    let set = [("material.law.eam_form.density_length", "2".to_string())];
    let literal = deck(DECK, "chain.toml", &set)?;
    let literal = mei(literal.spec.potential())?;
    let density = |x: f64| -> f64 {
        (1..=5)
            .map(|m| 2.0 * literal.density((x * f64::from(m)).powi(2)))
            .sum()
    };
    let [at_rest, compressed] = [density(1.0), density(1.0 / 1.15)];
    found.holds(
        "literal",
        format!(
            "ρ_h/ρ_e is {at_rest:.4} at rest and {compressed:.4} compressed as the pulse compresses"
        ),
        compressed < 0.0,
    );
    Ok(found)
}
