//! Plates that vibrate: NAFEMS test 21, simply supported, and Leissa's clamped square.

use std::f64::consts::PI;

use peridyne_io::write::plot::{ColorMap, Map};
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    VibratingPlate,
    "vibrating-plate",
    "Plates that vibrate (NAFEMS, Leissa)",
    ["../bench.rs", "deck.toml", "clamped.toml"]
);

const DECK: &str = include_str!("deck.toml");
const CLAMPED: &str = include_str!("clamped.toml");
/// Leissa (1973): ω a² √(ρ t/D) of the clamped square.
const LEISSA: [f64; 3] = [35.99, 73.41, 108.27];

/// The lowest modes, lowest first.
fn frequencies(bench: &mut Bench, count: usize) -> Result<Vec<peridyne::run::ModeShape>, Failure> {
    let modes = bench.sim.modes(count);
    modes.map_err(|e| Failure::new(e.to_string()))
}

/// ω a² √(ρ t/D) of the clamped plate, lowest first.
fn clamped(context: &Context, n: usize, found: &mut Findings) -> Result<Vec<f64>, Failure> {
    let mut bench = Bench::new(CLAMPED, &[("constants.n", &n.to_string())])?;
    let (e, rho, t, a, nu) = (200e9, 7850.0, 1e-3, 20e-3, 0.25);
    let d = e * f64::powi(t, 3) / (12.0 * (1.0 - nu * nu));
    let modes = frequencies(&mut bench, 4)?;
    // that with waves along both sides, on the upper face
    let x = bench.sim.vectors("reference");
    let top: Vec<usize> = (0..x.len()).filter(|k| x[*k][2] > 0.999 * t).collect();
    let places: Vec<[f64; 2]> = top.iter().map(|k| [x[*k][0], x[*k][1]]).collect();
    let most = top.iter().map(|k| modes[3].shape[*k][2].abs());
    let most = most.fold(0.0, f64::max);
    let values: Vec<f64> = top.iter().map(|k| modes[3].shape[*k][2] / most).collect();
    let map = Map::new("The fourth mode of a clamped square plate")
        .x("x", "m", [0.0, a])
        .y("y", "m", [0.0, a])
        .value("deflection", "of the largest")
        .between(-1.0, 1.0)
        .colors(ColorMap::Diverging)
        .equal()
        .points(&places, &values, t / n as f64);
    found.picture(map.save(&context.out, "mode")?);
    let scale = 2.0 * PI * a * a * (rho * t / d).sqrt();
    Ok(modes.iter().map(|m| scale * m.frequency).collect())
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let layers: &[usize] = if context.small { &[2] } else { &[2, 3, 4] };
    let mut table = Table::new();
    let mut all = vec![];
    for n in layers {
        context.say(&format!(
            "simply supported, {n} spacings across the thickness"
        ));
        let mut bench = Bench::new(DECK, &[("constants.n", &n.to_string())])?;
        let modes = frequencies(&mut bench, 6)?;
        let f: Vec<f64> = modes.iter().map(|m| m.frequency).collect();
        let label = format!("simply supported, {n} spacings across");
        found.measured(&label, format!("{f:.2?}"), "Hz");
        table = table.column(&label, "Hz", f.clone());
        all.push(f);
    }
    let path = context.out.join("supported.csv");
    table.save(&path)?;
    found.file(path);
    let end = all.len() - 1;
    found.number("sliding", all[end][3]);
    if !context.small {
        for (key, k) in [("first", 0), ("second", 1), ("fourth", 5)] {
            found.number(key, all[end][k]);
            // bending is too stiff by a part that falls with the square of the spacing
            let near = (16.0 * all[end][k] - 9.0 * all[end - 1][k]) / 7.0;
            found.number(&format!("{key} limit"), near);
        }
    }
    let layers: &[usize] = if context.small { &[2] } else { &[2, 3] };
    let mut factor = vec![];
    for n in layers {
        context.say(&format!("clamped, {n} spacings across the thickness"));
        let mut own = Findings::new();
        factor = clamped(context, *n, &mut own)?;
        found.measured(
            &format!("clamped, a/t = 20, {n} spacings across: ω a² √(ρ t/D)"),
            format!("{factor:.2?}"),
            "",
        );
        if n == &layers[layers.len() - 1] {
            own.files.into_iter().for_each(|p| found.file(p));
        }
    }
    for (key, k) in [
        ("clamped first", 0),
        ("clamped second", 1),
        ("clamped fourth", 3),
    ] {
        found.number(key, factor[k] / LEISSA[k.min(2)]);
    }
    Ok(found)
}
