//! The fragmenting cylinder: broken bonds and energy against LAMMPS, and its pieces.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    FragmentingCylinder,
    "fragmenting-cylinder",
    "A cylinder flies apart (LAMMPS, Grady)",
    ["../bench.rs", "deck.toml", "lammps.csv"]
);

const DECK: &str = include_str!("deck.toml");
/// LAMMPS's: spacing in mm, step, broken directed bonds, sum of the densities of kinetic energy.
const LAMMPS: &str = include_str!("lammps.csv");
/// Of the deck (SI): density, bulk modulus, horizon, critical stretch, rate of the circumference's strain, mean radius, length.
const RHO: f64 = 7800.0;
const BULK: f64 = 130e9;
const HORIZON: f64 = 3e-3;
const STRETCH: f64 = 0.02;
const RATE: f64 = 200.0 / 0.0225;
const RADIUS: f64 = 0.0225;
/// Pieces of fewer points are dust.
const DUST: usize = 20;

/// Rows of step, broken directed bonds and kinetic energy (J) of a spacing in mm.
fn rows(spacing: f64) -> Vec<[f64; 3]> {
    let numbers = LAMMPS
        .lines()
        .filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
    let rows = numbers.map(|line| {
        let row: Vec<f64> = line.split(',').filter_map(|x| x.parse().ok()).collect();
        [row[0], row[1], row[2], row[3]]
    });
    rows.filter(|row| row[0] == spacing)
        .map(|row| [row[1], row[2], row[3] * (1e-3 * spacing).powi(3)])
        .collect()
}

/// Pieces around the circumference: Grady (1982) has the energy of a crack from the motion of the halves of a piece; Griffith's
/// least, from all of the strain at the critical stretch.
fn pieces() -> [f64; 2] {
    let energy = 9.0 * BULK * HORIZON * STRETCH * STRETCH / 5.0;
    let around = 2.0 * std::f64::consts::PI * RADIUS;
    let grady = (24.0 * energy / (RHO * RATE * RATE)).cbrt();
    // uniaxial: E = 1.5 K with a Poisson's ratio of 1/4
    let strain = 0.5 * 1.5 * BULK * STRETCH * STRETCH;
    [around / grady, around / (energy / strain)]
}

/// Pieces other than dust that a circle of points of the outer wall belongs to, on average over the length.
fn around(bench: &mut Bench) -> Result<f64, Failure> {
    let piece = bench.values("fragment", 0)?;
    let x = bench.sim.vectors("reference");
    let mut size = std::collections::BTreeMap::<u64, usize>::new();
    for p in &piece {
        *size.entry(*p as u64).or_default() += 1;
    }
    let mut rings = std::collections::BTreeMap::<i64, Vec<(f64, u64)>>::new();
    for (x, p) in x.iter().zip(&piece) {
        let outer = x[0].hypot(x[1]) > 0.0235;
        if outer && size[&(*p as u64)] >= DUST {
            let ring = rings.entry((x[2] * 1e5).round() as i64).or_default();
            ring.push((x[1].atan2(x[0]), *p as u64));
        }
    }
    let mut changes = 0;
    for ring in rings.values_mut() {
        ring.sort_by(|a, b| a.0.total_cmp(&b.0));
        changes += (0..ring.len())
            .filter(|k| ring[*k].1 != ring[(k + 1) % ring.len()].1)
            .count();
    }
    Ok(changes as f64 / rings.len() as f64)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let (set, theirs): (&[(&str, &str)], _) = if context.small {
        let set = &[
            ("constants.a", "2 mm"),
            ("run.time_step", "200 ns"),
            ("run.duration", "40 us"),
        ];
        (set, rows(2.0))
    } else {
        (&[], rows(1.0))
    };
    let mut bench = Bench::new(DECK, set)?;
    let steps = bench.steps();
    let mut ours = vec![];
    for n in 1..=steps {
        bench.step()?;
        if n % 50 == 0 {
            context.say(&format!("step {n} of {steps}"));
            let ledger = bench
                .sim
                .ledger()
                .map_err(|e| Failure::new(e.to_string()))?;
            ours.push([n as f64, bench.sim.broken() as f64, ledger.kinetic]);
        }
    }
    let kept = theirs.iter().filter(|r| r[0] > 0.0 && r[0] <= steps as f64);
    let theirs: Vec<[f64; 3]> = kept.copied().collect();
    let unlike = ours
        .iter()
        .zip(&theirs)
        .filter(|(a, b)| a[1] != b[1])
        .count();
    found.holds(
        "broken",
        format!("{unlike} of {} rows differ", ours.len()),
        unlike == 0 && ours.len() == theirs.len(),
    );
    let last = ours.len() - 1;
    let apart = (0..=last).map(|k| (ours[k][2] / theirs[k][2] - 1.0).abs());
    found.number("energy", apart.fold(0.0, f64::max));
    found.measured("broken directed bonds at the end", ours[last][1], "");
    let mut size = std::collections::BTreeMap::<u64, usize>::new();
    for p in bench.values("fragment", 0)? {
        *size.entry(p as u64).or_default() += 1;
    }
    let large: Vec<usize> = size.values().copied().filter(|n| *n >= DUST).collect();
    found.measured("fragments", size.len() as f64, "");
    found.measured("of 20 points and more", large.len() as f64, "");
    let points = bench.sim.info().points as f64;
    let mass = large.iter().sum::<usize>() as f64 / points;
    found.measured("part of the mass in these", mass, "");
    let biggest = large.iter().max().map_or(0, |n| *n) as f64 / points;
    found.measured("part of the mass in the largest", biggest, "");
    let [grady, griffith] = pieces();
    found.measured("pieces around the circumference, Grady", grady, "");
    found.measured("with all strain energy, Griffith", griffith, "");
    if !context.small {
        let seen = around(&mut bench)?;
        found.holds(
            "pieces",
            format!("{seen:.1} around the circumference; {grady:.1} and {griffith:.1}"),
            seen > grady && seen < griffith,
        );
    }
    bench.damage(context, "damage", &mut found)?;
    let column = |rows: &[[f64; 3]], c: usize| rows.iter().map(|r| r[c]).collect::<Vec<f64>>();
    let dt = 1e6 * bench.sim.info().time_step;
    let micro = |rows: &[[f64; 3]]| rows.iter().map(|r| dt * r[0]).collect::<Vec<f64>>();
    let million = |rows: &[[f64; 3]]| rows.iter().map(|r| 1e-6 * r[1]).collect::<Vec<f64>>();
    let plot = Plot::new("Broken bonds of the cylinder")
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
