//! Table 4: what the plate of Fig. 4 costs.

use std::time::Instant;

use peridyne_io::write::table::Table;

use crate::seleson2014::plate::{MESHES, Plate, Step, bonds, family};
use crate::{Context, Failure, Findings};

experiment!(
    Table4,
    "table-4",
    "Cost of the plate",
    ["../plate.rs", "../figure-4/plate.toml"]
);

/// Points, full families, bonds and steps of a mesh in the paper's variant.
struct Counted {
    points: u64,
    family: u64,
    bonds: u64,
    steps: u64,
}

fn counted(context: &Context, mesh: u32) -> Result<Counted, Failure> {
    let plate = Plate {
        small: false,
        ..Plate::new(context, mesh, Step::Paper)
    };
    let info = plate.model(false)?.info().clone();
    Ok(Counted {
        points: info.points,
        family: family(plate.horizon / f64::from(mesh)),
        bonds: info.directed_bonds,
        steps: plate.steps(),
    })
}

/// Seconds of a step at the paper's step (mean over about two seconds or twenty steps), and bytes held.
fn measured(plate: Plate) -> Result<[f64; 2], Failure> {
    let mut sim = plate.model(false)?;
    sim.start(true);
    let begin = Instant::now();
    let mut steps = 0;
    while steps < 20 || begin.elapsed().as_secs_f64() < 2.0 {
        sim.step().map_err(|e| Failure::new(e.to_string()))?;
        steps += 1;
    }
    let seconds = begin.elapsed().as_secs_f64() / f64::from(steps);
    Ok([seconds, sim.info().bytes as f64])
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let [a, b, c] = MESHES.map(|mesh| counted(context, mesh));
    let all = [a?, b?, c?];
    for (mesh, c) in MESHES.iter().zip(&all) {
        found.number(&format!("points-{mesh}"), c.points as f64);
        found.number(&format!("bonds-{mesh}"), (c.points * c.family) as f64);
    }
    let exact = all.each_ref().map(|c| c.bonds);
    let edges = |c: &Counted, mesh: u32| {
        let n = c.points.isqrt();
        n * n == c.points && c.bonds == bonds(n as i64, 12.1 / f64::from(mesh))
    };
    found.holds(
        "edges",
        format!("{}, {}, {} with the edges", exact[0], exact[1], exact[2]),
        all.iter().zip(MESHES).all(|(c, mesh)| edges(c, mesh)),
    );
    // distances are roots of whole numbers
    let fits = |square: u32| {
        let r = f64::from(square).sqrt();
        [1.0, 2.0, 4.0].map(|m| family(r / m)) == [464, 112, 28]
    };
    let squares: Vec<u32> = (100..200).filter(|s| fits(*s)).collect();
    let (low, high) = (squares.first(), squares.last());
    found.holds(
        "horizon",
        format!(
            "12a has {} bonds; 464, 112 and 28 need √{} ≤ ε/a < √{}",
            family(12.0),
            low.copied().unwrap_or(0),
            high.map_or(0, |s| s + 1)
        ),
        low.is_some_and(|s| *s > 144) && family(12.0) == 440,
    );
    let work = |c: &Counted| (c.points * c.family * c.steps) as f64;
    let ratios = all.each_ref().map(|c| work(&all[0]) / work(c));
    for (h, ratio, printed) in [(2, ratios[1], 32.62), (4, ratios[2], 1005.82)] {
        let key = format!("speedup by bonds and steps, h = {h}a; printed, by times: {printed}");
        found.measured(&key, ratio, "");
    }
    if context.small {
        return Ok(found);
    }
    let mut times = vec![];
    let mut bytes = vec![];
    for mesh in MESHES {
        let [seconds, held] = measured(Plate::new(context, mesh, Step::Paper))?;
        times.push(seconds);
        bytes.push(held);
    }
    let totals: Vec<f64> = times
        .iter()
        .zip(&all)
        .map(|(t, c)| t * c.steps as f64)
        .collect();
    let path = context.out.join("costs.csv");
    Table::new()
        .text("model", ["MD, NCM (h = a)", "NCM (h = 2a)", "NCM (h = 4a)"])
        .column("points", "", all.iter().map(|c| c.points as f64))
        .column(
            "bonds of full families",
            "",
            all.iter().map(|c| (c.points * c.family) as f64),
        )
        .column("directed bonds", "", all.iter().map(|c| c.bonds as f64))
        .column("steps", "", all.iter().map(|c| c.steps as f64))
        .column("memory", "MB", bytes.iter().map(|b| b / 1e6))
        .column("time of a step", "s", times.clone())
        .column("total time", "s", totals.clone())
        .column("speedup", "", totals.iter().map(|t| totals[0] / t))
        .save(&path)?;
    found.file(path);
    found.holds(
        "speedup",
        format!(
            "{:.1} and {:.0} (steps of {:.1}, {:.2}, {:.3} ms; {:.0} s in all for h = a on {} threads)",
            totals[0] / totals[1],
            totals[0] / totals[2],
            1e3 * times[0],
            1e3 * times[1],
            1e3 * times[2],
            totals[0],
            context.threads
        ),
        totals[0] > 15.0 * totals[1] && totals[0] > 300.0 * totals[2],
    );
    found.holds(
        "memory",
        format!(
            "{:.1}, {:.1}, {:.1} MB: reduced by {:.1} %",
            bytes[0] / 1e6,
            bytes[1] / 1e6,
            bytes[2] / 1e6,
            100.0 * (1.0 - bytes[2] / bytes[0])
        ),
        (92.5..97.5).contains(&(100.0 * (1.0 - bytes[2] / bytes[0]))),
    );
    Ok(found)
}
