//! Fig. 3: the error of the end over the number of points.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;
use peridyne_theory::exact::Field;
use peridyne_theory::homogenize::bar::Ends;

use super::bar;
use crate::{Context, Failure, Findings};

experiment!(
    Figure3,
    "figure-3",
    "Error of bars with full-weight ends over the number of points",
    []
);

const HORIZONS: std::ops::RangeInclusive<usize> = 1..=4;
/// Steps after which a relaxation is looked at, converged or not.
const STEPS: usize = 200;

/// Below it an error is round-off.
const FLOOR: f64 = 1e-16;

/// Relative error of an end's displacement (over Δσ/E).
fn error(u: &[f64]) -> f64 {
    u[u.len() - 1] / (0.5 * (u.len() - 1) as f64) - 1.0
}

/// f(N) − 1 of a bar that is not homogenized.
fn elongated(m: usize, points: usize) -> Result<f64, Failure> {
    Ok(bar(m, points, Ends::Full, false)?.f().value() - 1.0)
}

/// From how many points on the end is less than 1 % off: f falls with N.
fn needed(found: &mut Findings) -> Result<(), Failure> {
    let mut least = vec![];
    for m in 2..=4 {
        let (mut low, mut high) = (2 * m + 1, 1024_usize);
        while high - low > 1 {
            let middle = low.midpoint(high);
            match elongated(m, middle)? < 0.01 {
                true => high = middle,
                false => low = middle,
            }
        }
        least.push(high);
    }
    let order = |n: &usize| (*n as f64).log10().round();
    found.holds(
        "points",
        format!(
            "below 1 % from N = {}, {} and {} on for δ = 2Δ, 3Δ, 4Δ",
            least[0], least[1], least[2]
        ),
        least.iter().all(|n| (2.0..=3.0).contains(&order(n))),
    );
    found.number("ends", 99.0 * elongated(2, 100)?);
    Ok(())
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let mut table = Table::new();
    let mut plot = Plot::new("Not homogenized, static")
        .x("N", "")
        .y("relative error of u", "%")
        .y_range(-1.0, 40.0);
    for m in HORIZONS {
        let n: Vec<usize> = (2 * m + 1..=100).collect();
        let mut errors = vec![];
        for points in &n {
            errors.push(bar(m, *points, Ends::Full, false)?.f().value() - 1.0);
        }
        let x: Vec<f64> = n.iter().map(|n| *n as f64).collect();
        let percent: Vec<f64> = errors.iter().map(|e| 100.0 * e).collect();
        plot = plot.line(&format!("δ = {m}Δ"), &x, &percent);
        // columns are of equal length
        let missing = vec![f64::NAN; 2 * m - 2];
        if m == 1 {
            table = table.column("N", "", x);
        }
        table = table.column(&format!("δ = {m}Δ"), "", [missing, errors].concat());
    }
    found.picture(plot.save(&context.out, "a-static")?);
    let path = context.out.join("static.csv");
    table.save(&path)?;
    found.file(path);
    found.number("printed", bar(3, 100, Ends::Full, false)?.f().value() - 1.0);
    found.text("classical", bar(1, 100, Ends::Full, false)?.f().to_string());
    let f: Vec<f64> = (7..=100)
        .map(|n| Ok(bar(3, n, Ends::Full, false)?.f().value()))
        .collect::<Result<_, Failure>>()?;
    let step = |w: &[f64]| w[1] < w[0];
    let ends = [f[0], f[f.len() - 1]];
    found.holds(
        "falls",
        format!("f(7) = {:.4}, f(100) = {:.4}", ends[0], ends[1]),
        f.windows(2).all(step),
    );

    needed(&mut found)?;

    let points: &[usize] = if context.small {
        &[10, 20, 40, 80]
    } else {
        &[10, 20, 40, 80, 160, 320, 640]
    };
    let x: Vec<f64> = points.iter().map(|n| *n as f64).collect();
    let mut plot = Plot::new(format!(
        "Homogenized, dynamic relaxation: after {STEPS} steps, and at rest"
    ))
    .x("N", "")
    .y("|relative error of u|", "")
    .log_x()
    .log_y()
    .y_range(FLOOR, 1e4);
    let shown = |e: &[f64]| {
        e.iter()
            .map(|e| e.abs().max(2.0 * FLOOR))
            .collect::<Vec<f64>>()
    };
    let mut rested = vec![0.0f64; points.len()];
    let mut table = Table::new().column("N", "", x.clone());
    let (mut worst, mut seen, mut grows) = (0.0f64, vec![], true);
    for m in HORIZONS {
        let (mut early, mut late, mut steps) = (vec![], vec![], vec![]);
        for n in points {
            let bar = bar(m, *n, Ends::Full, true)?;
            early.push(error(&bar.relaxing(STEPS)));
            let rest = bar
                .relax(1e-12, 1_000_000)
                .map_err(|e| Failure::new(e.to_string()))?;
            late.push(error(&rest.displacements));
            steps.push(rest.steps as f64);
        }
        worst = late.iter().fold(worst, |w, e| w.max(e.abs()));
        let label = format!("δ = {m}Δ after {STEPS} steps");
        plot = plot.series(&label, &x, &shown(&early), Stroke::Dashed, Mark::Disc);
        for (most, e) in rested.iter_mut().zip(&late) {
            *most = most.max(e.abs());
        }
        let last = points.len() - 1;
        grows &= early[last].abs() > 100.0 * early[0].abs() && steps[last] > steps[0];
        seen.push(format!(
            "δ = {m}Δ: {:.1e} of N = {} and {:.1e} of N = {} after {STEPS} steps; at rest after {} and {}",
            early[0], points[0], early[last], points[last], steps[0], steps[last]
        ));
        table = table
            .column(&format!("δ = {m}Δ after {STEPS} steps"), "", early)
            .column(&format!("δ = {m}Δ at rest"), "", late)
            .column(&format!("δ = {m}Δ steps"), "", steps);
    }
    let plot = plot.series(
        "at rest, largest of all",
        &x,
        &shown(&rested),
        Stroke::None,
        Mark::Square,
    );
    found.picture(plot.save(&context.out, "b-relaxation")?);
    let path = context.out.join("relaxation.csv");
    table.save(&path)?;
    found.file(path);
    found.number("rest", worst);
    found.holds("on-the-way", seen.join("; "), grows);
    Ok(found)
}
