//! Table 3: the constants of the plate, and what they imply.

use peridyne::law::solid::eam_like::Solid;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{Horizon, Influence, LawSpec, Moduli, Plane};
use peridyne_io::write::table::Table;
use peridyne_theory::crystal::solid::LatticeSolid;

use crate::seleson2014::cube;
use crate::seleson2014::deck;
use crate::seleson2014::plate::{self, A};
use crate::{Context, Failure, Findings};

experiment!(
    Table3,
    "table-3",
    "Constants of the structured embedded-atom model",
    [
        "../plate.rs",
        "../figure-4/plate.toml",
        "../figure-6/cube.toml"
    ]
);

/// k̄ and c̄ of a deck's law.
fn constants(text: &str) -> Result<[f64; 2], Failure> {
    match deck(text, "deck.toml", &[])?.spec.materials[0].law {
        LawSpec::EamLike { pair, volume } => Ok([pair, 3.0 * volume]),
        _ => Err(Failure::new("the deck has another law")),
    }
}

/// (A.26)
fn moduli([k, c]: [f64; 2]) -> Moduli {
    Moduli::from_bulk_shear((c + 0.5 * k) / 9.0, k / 30.0)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let wrong = |e: &dyn std::fmt::Display| Failure::new(e.to_string());
    let bodies = [("plate", plate::DECK), ("cube", cube::DECK)];
    let mut rows = vec![];
    for (name, text) in bodies {
        let pair = constants(text)?;
        let m = moduli(pair);
        rows.push((name, pair, m));
        found.number(&format!("shear-{name}"), m.shear() / 1e9);
        found.number(&format!("bulk-{name}"), m.bulk() / 1e9);
    }
    let path = context.out.join("moduli.csv");
    Table::new()
        .text("body", rows.iter().map(|r| r.0))
        .column("k", "Pa", rows.iter().map(|r| r.1[0]))
        .column("c", "Pa", rows.iter().map(|r| r.1[1]))
        .column("G", "Pa", rows.iter().map(|r| r.2.shear()))
        .column("K", "Pa", rows.iter().map(|r| r.2.bulk()))
        .column("Poisson's ratio", "", rows.iter().map(|r| r.2.poisson))
        .save(&path)?;
    found.file(path);

    // the plane's own stiffness: exact for an isotropic family, and of this lattice
    let [k, c] = rows[0].1;
    let lattice = LatticeSolid {
        influence: Influence::Inverse,
        density: 8960.0,
        ..LatticeSolid::new(LatticeKind::Square, A, Horizon::Length(12.1 * A))
    };
    let law = LawSpec::EamLike {
        pair: k,
        volume: c / 3.0,
    };
    let solid = Solid::of_law(2, Plane::Stress, &law).ok_or_else(|| wrong(&"no solid"))?;
    let crystal = lattice.state_based::<2>(solid).map_err(|e| wrong(&e))?;
    // ½κ(3/2 tr ε)² + (β/2)(tr²ε + 2ε:ε)/8 = ½λ tr²ε + μ ε:ε with κ = c/9, β = k/2
    let (lambda, shear) = (c / 4.0 + k / 16.0, k / 16.0);
    let ring = (lambda + 2.0 * shear) / 8960.0;
    // long waves along x
    let wave = 1e-3 / (12.1 * A);
    let squares = crystal.squares([wave, 0.0]);
    let speed = squares.last().map_or(f64::NAN, |s| s.sqrt() / wave);
    let transverse = squares.first().map_or(f64::NAN, |s| s.sqrt() / wave);
    found.number("speed", speed / ring.sqrt());
    found.holds(
        "plane",
        format!(
            "in the plane λ = {:.1} GPa, μ = {:.1} GPa, area modulus λ + μ = {:.1} GPa; (A.26) says K = {:.1} GPa, G = {:.1} GPa; the lattice has {:.1} GPa for shear, waves run {:.0} m/s",
            lambda / 1e9,
            shear / 1e9,
            (lambda + shear) / 1e9,
            rows[0].2.bulk() / 1e9,
            rows[0].2.shear() / 1e9,
            8960.0 * transverse * transverse / 1e9,
            speed
        ),
        (8960.0 * transverse * transverse / shear - 1.0).abs() < 0.01,
    );
    let sum = lattice.moments::<2>().map_err(|e| wrong(&e))?.second;
    found.holds(
        "scale",
        format!(
            "ρ_0/f_0 of (4.4) is {sum:.3e} m³: taken as 1, waves would run {:.0} m/s and go {:.1e} m in T",
            speed * sum.sqrt(),
            speed * sum.sqrt() * plate::T
        ),
        speed * sum.sqrt() * plate::T < A,
    );
    let limit = crystal
        .largest(if context.small { 10 } else { 24 })
        .time_step();
    found.measured("largest stable step far from edges", limit, "s");
    found.measured("that over Δt0 = 1.25e-9", limit / 1.25e-9, "");
    Ok(found)
}
