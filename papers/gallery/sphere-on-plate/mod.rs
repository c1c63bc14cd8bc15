//! A rigid sphere hits a brittle disk: broken bonds and energy against LAMMPS, step by step.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    SphereOnPlate,
    "sphere-on-plate",
    "A rigid sphere hits a brittle disk (LAMMPS)",
    [
        "../bench.rs",
        "deck.toml",
        "../../../verify/lammps/impact_pmb.csv"
    ]
);

const DECK: &str = include_str!("deck.toml");
/// LAMMPS's: step, broken directed bonds, particles with one, pe, ke (sums of densities).
const LAMMPS: &str = include_str!("../../../verify/lammps/impact_pmb.csv");
/// Volume of a particle (m³).
const VOLUME: f64 = 1.25e-10;
/// Of a disk of 10.1 mm after 300 steps, by the same script: broken directed bonds, and ke.
const SMALL: [f64; 2] = [404_586.0, 26_368_222_685.753_754];

/// Rows of step, broken directed bonds and kinetic energy (J).
fn rows() -> Vec<[f64; 3]> {
    let numbers = LAMMPS
        .lines()
        .filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
    numbers
        .map(|line| {
            let row: Vec<f64> = line.split(',').filter_map(|x| x.parse().ok()).collect();
            [row[0], row[1], row[4] * VOLUME]
        })
        .collect()
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let (set, theirs): (&[(&str, &str)], _) = if context.small {
        let set = &[("constants.r", "10.1 mm"), ("run.steps", "300")];
        (set, vec![[300.0, SMALL[0], SMALL[1] * VOLUME]])
    } else {
        (&[], rows())
    };
    let mut bench = Bench::new(DECK, set)?;
    let mut ours = vec![];
    for n in 1..=bench.steps() {
        bench.step()?;
        if theirs.iter().any(|row| row[0] == n as f64) {
            if n % 100 == 0 {
                context.say(&format!("step {n}"));
            }
            let ledger = bench
                .sim
                .ledger()
                .map_err(|e| Failure::new(e.to_string()))?;
            ours.push([n as f64, bench.sim.broken() as f64, ledger.kinetic]);
        }
    }
    let theirs: Vec<[f64; 3]> = theirs.into_iter().filter(|row| row[0] > 0.0).collect();
    let unlike = ours
        .iter()
        .zip(&theirs)
        .filter(|(a, b)| a[1] != b[1])
        .count();
    found.holds(
        "broken",
        format!("{} of {} rows differ", unlike, ours.len()),
        unlike == 0 && ours.len() == theirs.len(),
    );
    let last = ours.len() - 1;
    let apart = (0..=last).map(|k| (ours[k][2] / theirs[k][2] - 1.0).abs());
    found.number("energy", apart.fold(0.0, f64::max));
    found.measured("broken directed bonds at the end", ours[last][1], "");
    let ledger = bench
        .sim
        .ledger()
        .map_err(|e| Failure::new(e.to_string()))?;
    found.measured("work of the sphere", ledger.work_indenter, "J");
    found.measured("kinetic energy of the pieces", ledger.kinetic, "J");
    found.measured("energy of the broken bonds", ledger.released, "J");
    found.measured("fragments", bench.sim.fragments() as f64, "");
    bench.damage(context, "damage", &mut found)?;
    let column = |rows: &[[f64; 3]], c: usize| rows.iter().map(|r| r[c]).collect::<Vec<f64>>();
    let micro = |rows: &[[f64; 3]]| rows.iter().map(|r| 0.1 * r[0]).collect::<Vec<f64>>();
    let million = |rows: &[[f64; 3]]| rows.iter().map(|r| 1e-6 * r[1]).collect::<Vec<f64>>();
    let plot = Plot::new("Broken bonds of the disk")
        .x("t", "µs")
        .y("directed bonds", "million")
        .points("LAMMPS", &micro(&theirs), &million(&theirs))
        .line("peridyne", &micro(&ours), &million(&ours));
    found.picture(plot.save(&context.out, "broken")?);
    let path = context.out.join("broken.csv");
    Table::new()
        .column("step", "", column(&ours, 0))
        .column("broken directed bonds", "", column(&ours, 1))
        .column("of LAMMPS", "", column(&theirs, 1))
        .column("kinetic energy", "J", column(&ours, 2))
        .column("of LAMMPS", "J", column(&theirs, 2))
        .save(&path)?;
    found.file(path);
    Ok(found)
}
