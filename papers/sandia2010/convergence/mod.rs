//! (2.0.18) and its viscous form towards the local equation as the horizon shrinks: before the shock, with viscosity, and past the shock without.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_transport::exact::{ColeHopf, characteristics};
use peridyne_transport::{
    Bump, Evolution, Flux, Kernel, Method, Parity, Profile, StepSize, measure,
};

use super::laws::{digits, failed, law, places, run_to};
use crate::{Context, Failure, Findings};

experiment!(
    Convergence,
    "convergence",
    "Nonlocal Burgers towards the local equation",
    ["../laws.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Before the shock of sin x, which is at t = 1, and past it.
const BEFORE: f64 = 0.6;
const PAST: f64 = 1.6;
/// ε of the viscous runs.
const VISCOSITY: f64 = 0.1;

fn burgers(delta: f64, flux: &str, viscosity: f64, points: usize) -> Result<Evolution, Failure> {
    law(
        DECK,
        &[
            ("horizon", delta.to_string()),
            ("advection.flux", flux.to_string()),
            ("diffusion.viscosity", viscosity.to_string()),
            ("points", points.to_string()),
        ],
    )
}

/// Points for a horizon of eight spacings or more.
fn points(delta: f64) -> usize {
    let least = 8.0 * std::f64::consts::TAU / delta;
    (least as usize).next_power_of_two().max(256)
}

/// The entropy solution of sin x past the shock, which stands at π: by the characteristics from its own side.
fn entropy(x: f64, t: f64) -> f64 {
    let side = |x: f64| {
        let (mut low, mut high) = (0.0, std::f64::consts::PI);
        for _ in 0..80 {
            let foot: f64 = 0.5 * (low + high);
            // on the outer branch feet and places are in the same order
            let rises = 1.0 + t * foot.cos() > 0.0;
            match rises && foot + t * foot.sin() < x {
                true => low = foot,
                false => high = foot,
            }
        }
        (0.5 * (low + high)).sin()
    };
    match x < std::f64::consts::PI {
        true => side(x),
        false => -side(std::f64::consts::TAU - x),
    }
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let deltas: Vec<f64> = match context.small {
        true => vec![0.1, 0.05],
        false => vec![0.2, 0.1, 0.05, 0.025],
    };
    let mut table = Table::new().column("delta", "", deltas.clone());
    let mut plot = Plot::new("error against the horizon")
        .x("δ", "")
        .y("largest error", "")
        .log_x()
        .log_y();
    for (key, flux) in [
        ("before", "burgers"),
        ("before-energy", "energy_conserving"),
    ] {
        let mut errors = vec![];
        for delta in &deltas {
            let mut e = burgers(*delta, flux, 0.0, points(*delta))?;
            run_to(&mut e, BEFORE)?;
            let local = Flux::burgers();
            let x = places(&e);
            let exact: Vec<f64> = { x.iter() }
                .map(|x| characteristics(&local, f64::sin, 1.0, *x, BEFORE))
                .collect();
            errors.push(measure::distance(&e.u, &exact));
        }
        let orders = measure::orders(&deltas, &errors);
        found.number(key, orders[orders.len() - 1]);
        plot = plot.line(&format!("{flux}, t = {BEFORE}"), &deltas, &errors);
        table = table.column(&format!("{flux} t = {BEFORE}"), "", errors);
    }
    let cole_hopf = ColeHopf::new(|y: f64| -y.cos(), 1.0, VISCOSITY).map_err(failed)?;
    let mut errors = vec![];
    for delta in &deltas {
        let mut e = burgers(*delta, "burgers", VISCOSITY, points(*delta))?;
        run_to(&mut e, PAST)?;
        let x = places(&e);
        let some = (0..x.len()).step_by(x.len() / 64);
        let off = some.map(|n| (e.u[n] - cole_hopf.value(x[n], PAST)).abs());
        errors.push(off.fold(0.0, f64::max));
    }
    let orders = measure::orders(&deltas, &errors);
    found.number("viscous", orders[orders.len() - 1]);
    plot = plot.line(&format!("ε = {VISCOSITY}, t = {PAST}"), &deltas, &errors);
    table = table.column(&format!("viscous t = {PAST}"), "", errors);
    let errors = past(context, &deltas, &mut found)?;
    plot = plot.dashed("mean error past the shock, ε = 0", &deltas, &errors);
    table = table.column(&format!("mean error t = {PAST}"), "", errors);
    let errors = galilean(&deltas, &mut found)?;
    plot = plot.dashed("u + c in a moving frame from u", &deltas, &errors);
    table = table.column("u + c in a moving frame", "", errors);
    found.picture(plot.save(&context.out, "errors")?);
    let path = context.out.join("errors.csv");
    table.save(&path)?;
    found.file(path);
    Ok(found)
}

/// Speed of the frame; over [`MOVED`] a whole number of cells of every grid.
const FRAME: f64 = std::f64::consts::FRAC_PI_2;
const MOVED: f64 = 0.5;

/// The local equation does not know a frame: u(x − ct, t) + c solves it with u. Of both nonlocal fluxes F(u + c, v + c) = F(u, v) + c(u + v)/2 + c²/2, so that the frame leaves
/// c (A − ∂_x)w, A the linear operator with the symbol ik b̂(kδ): waves disperse. Largest differences for each δ.
fn galilean(deltas: &[f64], found: &mut Findings) -> Result<Vec<f64>, Failure> {
    let start = |delta: f64, flux: &str, c: f64, points: usize| {
        law(
            DECK,
            &[
                ("horizon", delta.to_string()),
                ("advection.flux", flux.to_string()),
                ("initial", format!("{c} + sin(x)")),
                ("points", points.to_string()),
            ],
        )
    };
    let run = |delta: f64, flux: &str, c: f64, points: usize| -> Result<Vec<f64>, Failure> {
        let mut e = start(delta, flux, c, points)?;
        run_to(&mut e, MOVED)?;
        let cells = (c * MOVED / std::f64::consts::TAU * points as f64).round() as usize;
        e.u.rotate_left(cells);
        Ok(e.u.iter().map(|u| u - c).collect())
    };
    let off = |delta: f64, flux: &str, c: f64, points: usize| -> Result<f64, Failure> {
        let [moved, own] = [run(delta, flux, c, points)?, run(delta, flux, 0.0, points)?];
        Ok(measure::distance(&moved, &own))
    };
    let mut errors = vec![];
    for delta in deltas {
        errors.push(off(*delta, "burgers", FRAME, points(*delta))?);
    }
    let orders = measure::orders(deltas, &errors);
    found.number("galilean-delta", orders[orders.len() - 1]);
    let (delta, n) = (deltas[1], points(deltas[1]));
    found.number(
        "galilean-h",
        off(delta, "burgers", FRAME, 2 * n)? / errors[1],
    );
    found.number(
        "galilean-c",
        errors[1] / off(delta, "burgers", 0.5 * FRAME, n)?,
    );
    let energy = off(delta, "energy_conserving", FRAME, n)?;
    found.measured(
        "difference of the moved frame, burgers",
        digits(&errors),
        "",
    );
    found.measured("the same of energy_conserving, second δ", energy, "");
    // what the frame leaves at t = 0, of sin x
    let rate = |c: f64| -> Result<Vec<f64>, Failure> {
        let mut e = start(delta, "burgers", c, n)?;
        let mut rate = vec![0.0; n];
        e.operator.rate(&e.u, 0.0, &mut rate);
        Ok(rate)
    };
    let x = places(&start(delta, "burgers", 0.0, n)?);
    let [moved, own] = [rate(FRAME)?, rate(0.0)?];
    let left = { moved.iter().zip(&own).zip(&x) }.map(|((a, b), x)| a - b + FRAME * x.cos());
    let part = 2.0 / n as f64 * left.zip(&x).map(|(l, x)| l * x.cos()).sum::<f64>();
    let kernel = Kernel::new(
        Parity::Odd,
        Profile::Slope(Bump::Smooth),
        delta,
        1,
        false,
        "kernel",
    );
    let symbol = kernel.map_err(failed)?.symbol(1.0);
    found.number("galilean-rate", part / (FRAME * (1.0 - symbol)));
    Ok(errors)
}

/// Past the shock, without viscosity, with the flux that conserves energy and the one that does not: mean errors of the first.
fn past(context: &Context, deltas: &[f64], found: &mut Findings) -> Result<Vec<f64>, Failure> {
    let mut kept = vec![];
    let mut profiles = Plot::new("past the shock, without viscosity")
        .x("x", "")
        .y("u", "");
    let mut variations = vec![];
    for flux in ["energy_conserving", "burgers"] {
        let mut errors = vec![];
        let mut energies = vec![];
        for delta in deltas {
            let mut e = burgers(*delta, flux, 0.0, points(*delta))?;
            let grid = e.operator.law().grid;
            let begin = measure::energy(&e.u, grid.cell());
            let ended = run_to(&mut e, PAST);
            if ended.is_err() {
                // where it blows up there is no distance
                break;
            }
            let x = places(&e);
            let exact: Vec<f64> = x.iter().map(|x| entropy(*x, PAST)).collect();
            errors.push(measure::mean_distance(&e.u, &exact, grid.cell()));
            energies.push(measure::energy(&e.u, grid.cell()) / begin - 1.0);
            variations.push(measure::total_variation(
                &e.u,
                grid.cells,
                grid.spacing,
                true,
            ));
            if *delta == deltas[1] {
                profiles = profiles.line(flux, &x, &e.u);
                if flux == "burgers" {
                    profiles = profiles.dashed("entropy solution", &x, &exact);
                }
            }
        }
        found.measured(
            &format!("mean errors past the shock, {flux}"),
            digits(&errors),
            "",
        );
        found.measured(
            &format!("change of ∫u²/2 from t = 0 to {PAST}, {flux}"),
            digits(&energies),
            "",
        );
        if flux == "energy_conserving" {
            found.holds(
                "no-limit",
                format!("mean errors {errors:.3?} for δ = {deltas:?}"),
                errors.len() == deltas.len() && errors[errors.len() - 1] > 0.5 * errors[0],
            );
            // half the step
            let mut e = burgers(deltas[0], flux, 0.0, points(deltas[0]))?;
            let cell = e.operator.law().grid.cell();
            let begin = measure::energy(&e.u, cell);
            let mut finer = Evolution::new(e.operator, e.u, Method::Rk4, StepSize::Part(0.125));
            run_to(&mut finer, PAST)?;
            e = finer;
            let half = measure::energy(&e.u, cell) / begin - 1.0;
            found.measured("the same in steps half as long, first δ", half, "");
            found.holds(
                "energy-kept",
                format!(
                    "{:.3e} and {half:.3e}, order {:.2}",
                    energies[0],
                    (energies[0] / half).log2()
                ),
                (energies[0] / half).log2() > 3.8,
            );
            kept = errors;
        } else {
            found.holds(
                "energy-grows",
                digits(&energies),
                !energies.is_empty() && energies.iter().all(|e| *e > 0.0),
            );
        }
    }
    let least = variations.iter().copied().fold(f64::INFINITY, f64::min);
    found.holds(
        "oscillates",
        format!("total variations {variations:.2?}, of the entropy solution below 4"),
        least > 6.0,
    );
    found.picture(profiles.save(&context.out, "past")?);
    Ok(kept)
}
