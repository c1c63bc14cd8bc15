//! Fig. 2: initial displacement, displacement at the end, energies over time.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;

use super::chain::{Family, Wave};
use crate::measure::{change, largest, relative_difference};
use crate::{Context, Failure, Findings};

experiment!(
    Figure2,
    "figure-2",
    "Displacements and energies of the embedded-atom wave",
    ["../chain.rs", "../figure-1/chain.toml"]
);

/// What the paper adds to the net change of strain energy, so that it lies beside the kinetic energy.
const SHIFT: f64 = 280.0;

fn run(context: &Context) -> Result<Findings, Failure> {
    let names = ["MD", "NCM, h = 2a", "NCM, h = 4a"];
    let waves = [
        Wave::run(1.0, Family::Now)?,
        Wave::run(2.0, Family::Chain)?,
        Wave::run(4.0, Family::Chain)?,
    ];
    let md = &waves[0];
    let mut found = Findings::new();
    let out = &context.out;

    let mut plot = Plot::new("Initial displacement").x("x", "").y("u", "");
    plot = plot.line("", &md.x, &md.u[0]);
    found.picture(plot.save(out, "initial")?);

    let mut plot = Plot::new("Displacement at T = 120").x("x", "").y("u", "");
    for (name, wave) in names.iter().zip(&waves) {
        plot = plot.line(name, &wave.x, wave.last());
    }
    found.picture(plot.save(out, "displacement")?);

    let mut plot = Plot::new("Energies (of the strain: change since the start, shifted by 280)")
        .x("t", "")
        .y("energy", "");
    for (k, (name, wave)) in names.iter().zip(&waves).enumerate() {
        let strain: Vec<f64> = wave
            .strain
            .iter()
            .map(|s| s - wave.strain[0] + SHIFT)
            .collect();
        let sum = wave.kinetic.iter().zip(&strain).map(|(k, s)| k + s);
        let total: Vec<f64> = sum.collect();
        let columns = [
            ("kinetic", &wave.kinetic),
            ("strain", &strain),
            ("total", &total),
        ];
        let stroke = [Stroke::Solid, Stroke::Dotted, Stroke::Dashed][k];
        for (what, values) in columns {
            let label = format!("{what}, {name}");
            plot = plot.series(&label, &wave.time, values, stroke, Mark::None);
        }
    }
    found.picture(plot.save(out, "energies")?);

    for (wave, h) in waves.iter().zip([1, 2, 4]) {
        let path = out.join(format!("displacement-{h}.csv"));
        Table::new()
            .column("x", "", wave.x.clone())
            .column("initial displacement", "", wave.u[0].clone())
            .column("displacement", "", wave.last().to_vec())
            .save(&path)?;
        found.file(path);
        let path = out.join(format!("energies-{h}.csv"));
        Table::new()
            .column("time", "", wave.time.clone())
            .column("kinetic energy", "", wave.kinetic.clone())
            .column(
                "strain energy",
                "",
                wave.strain.iter().map(|s| s - wave.at_rest),
            )
            .column("total energy", "", wave.total())
            .save(&path)?;
        found.file(path);
    }

    found.number("height", largest(md.u[0].iter().copied()));
    // on the points that all three have
    let shared = |wave: &Wave| -> Vec<f64> {
        let every = 4 / wave.h as usize;
        wave.last().iter().step_by(every).copied().collect()
    };
    let reference = shared(md);
    for (key, wave) in ["displacement-2", "displacement-4"].iter().zip(&waves[1..]) {
        let difference = relative_difference(&shared(wave), &reference);
        found.holds(
            key,
            format!("{:.2} % (root of the squares)", 100.0 * difference),
            difference < 0.1,
        );
    }
    let drift = largest(waves.iter().map(|wave| change(wave.total())));
    found.holds(
        "conserved",
        format!("largest change of the total: {drift:.1e} of it"),
        drift < 0.01,
    );
    let spread = |of: &dyn Fn(&Wave) -> f64| change(waves.iter().map(of));
    let kinetic = spread(&|w| w.kinetic[w.steps()]);
    let total = spread(&|w| w.total()[0]);
    found.holds(
        "preserved",
        format!("kinetic energy at T within {kinetic:.1e}, total energy within {total:.1e}"),
        kinetic < 0.01 && total < 0.01,
    );
    let exchange = md
        .kinetic
        .iter()
        .zip(&md.strain)
        .map(|(k, s)| k + s - md.strain[0]);
    let exchange = largest(exchange.map(f64::abs)) / md.kinetic[md.steps()];
    found.holds(
        "complementary",
        format!("kinetic energy and loss of strain energy agree within {exchange:.1e}"),
        exchange < 0.02,
    );
    Ok(found)
}
