//! Fig. 5.2: kinetic, potential and total energy of the Lennard-Jones chain and of its coarse peridynamics.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;

use super::motion::{Energies, Motion, Wanted};
use super::runs::{self, Name};
use crate::measure::{self, largest};
use crate::{Context, Failure, Findings};

experiment!(
    Figure52,
    "figure-5-2",
    "Energies of a Lennard-Jones chain and of its upscaling",
    [
        "../chain.rs",
        "../deck.rs",
        "../modes.rs",
        "../motion.rs",
        "../runs.rs",
        "deck.toml"
    ]
);

const DECK: &str = include_str!("deck.toml");
/// Names of the runs in the deck, and what they are called.
const RUNS: [Name; 3] = [
    ("md", "MD"),
    ("pd-2", "coarse PD, Δx = 2"),
    ("pd-4", "coarse PD, Δx = 4"),
];
/// ε̄ and σ̄⁶ of all runs.
const EPSILON: f64 = 1.0 / 72.0;
const SIGMA6: f64 = 0.5;

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let runs = runs::all(
        context,
        DECK,
        &RUNS,
        |_| vec![],
        |_, _| Wanted {
            energies: 300,
            ..Wanted::default()
        },
    )?;
    let rest: Vec<f64> = runs.iter().map(|m| at_rest(m).1).collect();
    let series = |k: usize, of: fn(&Energies) -> f64| -> Vec<f64> {
        runs[k].energies.iter().map(of).collect()
    };
    let kinetic: Vec<Vec<f64>> = (0..3).map(|k| series(k, |e| e.kinetic)).collect();
    // above the reference state, which is the binding energy
    let potential: Vec<Vec<f64>> = (0..3)
        .map(|k| {
            series(k, |e| e.potential)
                .iter()
                .map(|p| p - rest[k])
                .collect()
        })
        .collect();
    let total: Vec<Vec<f64>> = (0..3)
        .map(|k| {
            kinetic[k]
                .iter()
                .zip(&potential[k])
                .map(|(a, b)| a + b)
                .collect()
        })
        .collect();
    let t = series(0, |e| e.time);

    let density: Vec<f64> = runs.iter().map(|m| at_rest(m).0).collect();
    let off = density.iter().map(|d| (d / -EPSILON - 1.0).abs());
    found.number("binding", largest(off));
    let scale = total[0][0];
    let spread = |e: &[f64]| largest(e.iter().map(|x| (x - e[0]).abs())) / scale;
    let drifts: Vec<f64> = total.iter().map(|e| spread(e)).collect();
    found.holds(
        "total-is-conserved",
        format!(
            "largest change over the energy of the pulse: MD {:.1e}, Δx = 2 {:.1e}, Δx = 4 {:.1e}",
            drifts[0], drifts[1], drifts[2]
        ),
        drifts.iter().all(|d| *d < 1e-3),
    );
    let apart = |a: &[f64], b: &[f64]| measure::apart(a, b) / scale;
    let text = |of: &[Vec<f64>]| {
        format!(
            "Δx = 2 {:.2} %, Δx = 4 {:.2} %",
            100.0 * apart(&of[1], &of[0]),
            100.0 * apart(&of[2], &of[0])
        )
    };
    for (key, of) in [
        ("kinetic-agrees", &kinetic),
        ("potential-agrees", &potential),
        ("total-agrees", &total),
    ] {
        found.holds(
            key,
            text(of),
            apart(&of[1], &of[0]) < 0.02 && apart(&of[2], &of[0]) < 0.05,
        );
    }
    let share = kinetic[0][t.len() - 1] / scale;
    found.holds(
        "halves",
        format!("kinetic part of MD: 0 at the start, {share:.3} at the end"),
        kinetic[0][0] == 0.0 && (0.45..0.55).contains(&share),
    );

    for (name, title, of) in [
        ("kinetic", "Kinetic energy", &kinetic),
        (
            "potential",
            "Potential energy above the reference state",
            &potential,
        ),
        ("total", "Total energy above the reference state", &total),
    ] {
        let plot = Plot::new(title).x("t", "").y("energy", "");
        let plot = plot.y_range(-0.05 * scale, 1.2 * scale);
        let plot = plot
            .line(RUNS[0].1, &t, &of[0])
            .dashed(RUNS[1].1, &t, &of[1])
            .series(RUNS[2].1, &t, &of[2], Stroke::Dotted, Mark::None);
        found.picture(plot.save(&context.out, name)?);
    }
    let path = context.out.join("energies.csv");
    let mut table = Table::new().column("t", "", t);
    for (k, (_, label)) in RUNS.iter().enumerate() {
        table = table
            .column(&format!("{label}: kinetic"), "", kinetic[k].clone())
            .column(
                &format!("{label}: potential above rest"),
                "",
                potential[k].clone(),
            )
            .column(&format!("{label}: total above rest"), "", total[k].clone())
            .column(&format!("{label}: total"), "", series(k, Energies::total));
    }
    table.save(&path)?;
    found.file(path);
    Ok(found)
}

/// Energy per length of the endless chain at rest, and the energy of the chain with its free ends: every bond once.
fn at_rest(m: &Motion) -> (f64, f64) {
    let n = i32::try_from(m.neighbours).unwrap_or(i32::MAX);
    let z = |p: i32| (1..=n).map(|j| f64::from(j).powi(-p)).sum::<f64>();
    let epsilon = EPSILON * m.spacing * z(12) / z(6).powi(2);
    let sigma6 = SIGMA6 * z(6) / z(12);
    let bond = |j: i32| {
        let s6 = sigma6 / f64::from(j).powi(6);
        4.0 * epsilon * (s6 * s6 - s6)
    };
    let bulk = (1..=n).map(bond).sum::<f64>() / m.spacing;
    let whole = (1..=n)
        .map(|j| (m.points as f64 - f64::from(j)) * bond(j))
        .sum();
    (bulk, whole)
}
