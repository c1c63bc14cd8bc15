//! Fig. 5.1: a shock in a Lennard-Jones chain, by molecular dynamics and by peridynamics at three resolutions.

use peridyne::error::RunError;

use super::deck;
use super::lennard_jones::Paper;
use super::motion::{Motion, Wanted, record};
use super::runs::{self, Name};
use crate::measure::{apart, largest};
use crate::{Context, Failure, Findings};

experiment!(
    Figure51,
    "figure-5-1",
    "A shock in a Lennard-Jones chain",
    [
        "../chain.rs",
        "../deck.rs",
        "../modes.rs",
        "../motion.rs",
        "../runs.rs",
        "../lennard_jones.rs",
        "deck.toml"
    ]
);

const DECK: &str = include_str!("deck.toml");
/// Names of the runs in the deck, and what they are called.
const RUNS: [Name; 4] = [
    ("md", "MD"),
    ("pd-1", "PD"),
    ("pd-2", "coarse PD"),
    ("pd-4", "coarse PD"),
];
/// Where the corner that the deck shows larger begins in x.
const CORNER: f64 = 850.0;

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let runs = runs::all(
        context,
        DECK,
        &RUNS,
        |_| vec![],
        |steps, _| Wanted {
            images: true,
            profiles: vec![0, steps / 100, steps],
            energies: 0,
        },
    )?;
    // the whole of the molecular dynamics, the corner of all
    runs::densities(context, &runs[..1], &RUNS, &mut found)?;
    for (motion, (name, label)) in runs.iter().zip(RUNS) {
        for corner in motion.images.iter().skip(1) {
            let map = corner.map(&motion.titled(label));
            found.picture(map.save(&context.out, &format!("corner-{name}"))?);
        }
    }
    let (md, fine) = (&runs[0], &runs[1]);
    let last = |m: &Motion| -> Result<Vec<f64>, Failure> { Ok(m.profile(m.steps)?.u.clone()) };
    let ends: Vec<Vec<f64>> = runs.iter().map(last).collect::<Result<_, _>>()?;

    let counts: Vec<String> = runs[1..]
        .iter()
        .map(|m| format!("{} and {}", m.points, m.neighbours))
        .collect();
    found.text("points", counts.join(", "));
    let same = md
        .profiles
        .iter()
        .zip(&fine.profiles)
        .all(|(a, b)| a.u == b.u);
    found.holds(
        "pd-is-md-at-one-resolution",
        format!(
            "displacements at {} steps: the same bits: {same}",
            md.profiles.len()
        ),
        same,
    );
    // (5.3) as it is printed, in a stepper of its own
    let mut off = vec![];
    for m in &runs[1..] {
        let [start, some] = [m.profile(0)?, m.profile(m.steps / 100)?];
        let paper = Paper {
            neighbours: m.neighbours as usize,
            spacing: m.spacing,
            epsilon: 1.0 / 72.0,
            sigma6: 0.5,
        };
        let u = paper.displacements(&start.u, m.time_step, some.step);
        off.push(apart(&u, &some.u));
    }
    found.number("equation-5-3", largest(off));
    // the shock: steepest front in the half that runs to the right
    let slope = |m: &Motion, u: &[f64]| {
        let steep = u
            .windows(2)
            .skip(u.len() / 2)
            .map(|w| (w[0] - w[1]) / m.spacing);
        largest(steep)
    };
    let start = slope(md, &md.profile(0)?.u) / 2.0;
    let steepest = slope(md, &ends[0]);
    let front = front(&ends[0]);
    found.holds(
        "shock",
        format!("largest compression of the right pulse: {start:.4} as it starts, {steepest:.4} at the end, at x = {front:.0}"),
        steepest > 1.5 * start && front > CORNER,
    );
    let waves: Vec<f64> = ends
        .iter()
        .zip(&runs)
        .map(|(u, m)| wavelength(u, m.spacing))
        .collect();
    found.holds(
        "resolution-changes-the-front",
        format!(
            "distance of the two foremost waves: {:.2}, {:.2}, {:.2} for Δx = 1, 2, 4",
            waves[1], waves[2], waves[3]
        ),
        waves[2] > 1.3 * waves[1] && waves[3] > 1.3 * waves[2],
    );
    let smooth = |k: usize| {
        let every = (runs[k].spacing / md.spacing).round() as usize;
        let apart = ends[k]
            .iter()
            .enumerate()
            .map(|(j, u)| (u - ends[0][j * every]).abs());
        largest(apart)
    };
    let displacement = largest(ends[0].iter().copied());
    found.holds(
        "coarse-away-from-the-front",
        format!(
            "largest difference of displacements from MD: {:.3} (Δx = 2), {:.3} (Δx = 4), of {displacement:.2}",
            smooth(2),
            smooth(3)
        ),
        smooth(2) < 0.1 * displacement && smooth(3) < 0.25 * displacement,
    );
    let (text, stopped) = literal()?;
    found.holds("literal-pulse-crosses", text, stopped);

    let path = context.out.join("displacements.csv");
    let column = |k: usize| {
        let every = (runs[k].spacing / md.spacing).round() as usize;
        (0..md.points).map(move |j| (j % every == 0).then(|| j / every))
    };
    let mut table = peridyne_io::write::table::Table::new().column("x", "", md.x());
    for (k, (name, _)) in RUNS.iter().enumerate() {
        let values: Vec<f64> = column(k)
            .map(|j| j.map_or(f64::NAN, |j| ends[k][j]))
            .collect();
        table = table.column(&format!("{name} at 300"), "", values);
    }
    table.save(&path)?;
    found.file(path);
    Ok(found)
}

/// Where the pulse that runs to the right begins: the last point displaced by a hundredth of its height.
fn front(u: &[f64]) -> f64 {
    let top = u.iter().copied().fold(0.0, f64::max);
    u.iter().rposition(|u| *u > 0.01 * top).unwrap_or(0) as f64
}

/// Distance of the two foremost waves of the front: of the two rightmost deep minima of the strain.
fn wavelength(u: &[f64], spacing: f64) -> f64 {
    let strain: Vec<f64> = u.windows(2).map(|w| w[1] - w[0]).collect();
    let deepest = strain.iter().copied().fold(0.0, f64::min);
    let mut dips = (1..strain.len() - 1)
        .rev()
        .filter(|j| strain[*j] < 0.3 * deepest)
        .filter(|j| strain[*j] < strain[j - 1] && strain[*j] <= strain[j + 1]);
    match (dips.next(), dips.next()) {
        (Some(first), Some(second)) => (first - second) as f64 * spacing,
        _ => f64::NAN,
    }
}

/// The pulse as the paper's words have it, support [490, 510] and height 2: what the program says, and whether it stops in
/// its first step.
fn literal() -> Result<(String, bool), Failure> {
    let deck = deck::deck(DECK, "literal", &[])?;
    let sim = deck::model(&deck)?;
    match record(4, sim, 10, &Wanted::default(), &[]) {
        Ok(_) => Ok(("it ran".into(), false)),
        Err(e) => {
            let first = match &e {
                RunError::TooFast { step, .. } => *step == 1,
                RunError::Crossing { step, .. } => *step <= 1,
                _ => false,
            };
            Ok((e.to_string(), first))
        }
    }
}
