//! `peridyne coarsen`: linear bodies level by level.

use crate::Input;
use crate::deck;
use crate::failure::{Failure, say};
use crate::run::with_threads;
use crate::side_by_side::{compare, run, save};
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::spec::{Method, TimeStep};
use peridyne::statics::{AnyLinearBody, LinearBody};
use peridyne_io::deck::Deck;
use peridyne_io::deck::coarsened::coarsened;
use peridyne_io::deck::upscaled::copied;
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::linear::write_linear;
use peridyne_theory::coarsen::{self, Radius, Report, Scheme, Selection};
use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(clap::Args)]
pub struct CoarsenArguments {
    /// Deck of any law; what is coarsened is its linear body about the reference. Atoms, whose lattice pulls at surfaces and
    /// vacancies, are relaxed first, and displacements are counted from there.
    #[command(flatten)]
    pub input: Input,
    /// Retain every k-th point of the lattice along each axis; of a triangular or centred lattice the one with k times its spacing.
    #[arg(long, value_name = "K", conflicts_with_all = ["spacing", "keep"])]
    pub every: Option<u32>,
    /// Retain points no two of which are nearer than this (in units of the deck), evenly spread; for clouds.
    #[arg(long, value_name = "LENGTH", conflicts_with = "keep")]
    pub spacing: Option<f64>,
    /// Retain the points of this set of the deck.
    #[arg(long, value_name = "SET")]
    pub keep: Option<String>,
    /// So many times, each level from the one before.
    #[arg(long, default_value_t = 1)]
    pub levels: usize,
    /// Accepted error of the effective modulus, by which the radius of balls is chosen.
    #[arg(long, default_value_t = 0.01, conflicts_with = "radius")]
    pub tolerance: f64,
    /// Radius of the balls of the first level (in units of the deck); it grows with the spacing of points from level to level.
    #[arg(long, value_name = "LENGTH")]
    pub radius: Option<f64>,
    /// energy (shapes cut off by balls, symmetric), rows (as published), or schur (exact and full).
    #[arg(long, default_value = "energy")]
    pub scheme: String,
    /// Run the deck and all levels, and measure error and cost.
    #[arg(long)]
    pub run: bool,
    /// Folder for the results; `out/<name of the deck>-coarsened` if not given.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}

pub fn coarsen(arguments: &CoarsenArguments) -> Result<(), Failure> {
    if !deck::is_deck(&arguments.input) {
        return Err(Failure::input("coarsen takes a deck (.toml)"));
    }
    let deck = deck::read(&arguments.input)?;
    with_threads(arguments.threads, |_| all(arguments, &deck))
}

fn all(arguments: &CoarsenArguments, deck: &Deck) -> Result<(), Failure> {
    let mut spec = deck.spec.clone();
    // motion, conditions and steps play no part in the linear body
    spec.initial.clear();
    spec.thermal = None;
    spec.conditions.clear();
    spec.schedule.statics = None;
    spec.schedule.time_step = TimeStep::Fixed(1.0);
    let options = Options {
        trust_time_step: true,
        simd: deck::simd(&arguments.input)?,
    };
    let mut sim = build(&spec, options).map_err(|e| Failure::Input(deck.explain(&e).into()))?;
    let kept = match &arguments.keep {
        None => None,
        Some(name) => Some(sim.members(name).ok_or_else(|| {
            Failure::input(format!("--keep {name}: {} has no such set", deck.file()))
        })?),
    };
    let out = arguments.out.clone().unwrap_or_else(|| {
        let name = arguments.input.file.file_stem();
        let name = name.map_or("deck".into(), |n| n.to_string_lossy());
        Path::new("out").join(format!("{name}-coarsened"))
    });
    let relaxed = match spec.potential {
        None => None,
        Some(_) => Some(relaxed(sim.as_mut(), deck)?),
    };
    let began = Instant::now();
    let body = sim.linear_body();
    say(&format!(
        "linear body of {} points: {:.2} s",
        sim.info().points,
        began.elapsed().as_secs_f64()
    ));
    drop(sim);
    match body {
        AnyLinearBody::One(body) => levels(arguments, deck, &out, body, relaxed, kept),
        AnyLinearBody::Two(body) => levels(arguments, deck, &out, body, relaxed, kept),
        AnyLinearBody::Three(body) => levels(arguments, deck, &out, body, relaxed, kept),
    }
}

/// Residual forces over those at the lattice sites.
const RELAXED: f64 = 1e-10;

/// Displacements of a crystal that is left to itself.
fn relaxed(sim: &mut dyn Simulation, deck: &Deck) -> Result<Vec<Point>, Failure> {
    let began = Instant::now();
    sim.relax(RELAXED).map_err(|e| {
        Failure::input(format!(
            "{}: the crystal does not come to rest by itself, so that there is no linear body ({e}): take the lattice spacing at which it has no pressure, and a potential that ends smoothly",
            deck.file()
        ))
    })?;
    let u = sim.displacements();
    let far = u.iter().map(|u| u.iter().map(|c| c * c).sum::<f64>());
    say(&format!(
        "relaxed without load: atoms move by at most {:.2e} spacings, {:.2} s",
        far.fold(0.0, f64::max).sqrt() / deck.spec.body.spacing().unwrap_or(sim.info().spacing),
        began.elapsed().as_secs_f64()
    ));
    Ok(u)
}

fn levels<const D: usize>(
    arguments: &CoarsenArguments,
    deck: &Deck,
    out: &Path,
    mut body: LinearBody<D>,
    relaxed: Option<Vec<Point>>,
    kept: Option<Vec<u32>>,
) -> Result<(), Failure> {
    // atoms are where they rest; files, sets and conditions know them by their sites
    let mut sites = body.position.clone();
    for (x, u) in body.position.iter_mut().zip(relaxed.iter().flatten()) {
        for a in 0..D {
            x[a] += u[a];
        }
    }
    let level0 = relaxed.is_some().then(|| at_sites(&body, &sites));
    let selection = match (arguments.every, arguments.spacing, kept) {
        (Some(every), _, _) => Selection::Sublattice { every, through: 0 },
        (_, Some(spacing), _) => Selection::BlueNoise { spacing, seed: 1 },
        (_, _, Some(points)) => Selection::Marked(points),
        _ => {
            return Err(Failure::input(
                "say which points to retain: --every K on a lattice, --spacing LENGTH of a cloud, or --keep SET",
            ));
        }
    };
    if matches!(selection, Selection::Marked(_)) && arguments.levels > 1 {
        return Err(Failure::input("--keep SET retains one set: --levels 1"));
    }
    let scheme = match arguments.scheme.as_str() {
        "energy" => Scheme::Energy,
        "rows" => Scheme::Rows,
        "schur" => Scheme::Schur,
        other => {
            return Err(Failure::input(format!(
                "--scheme {other}: expected energy, rows or schur"
            )));
        }
    };
    let mut made = vec![];
    for level in 1..=arguments.levels {
        let wrong = |e: coarsen::CoarsenError| {
            Failure::input(format!("{}, level {level}: {e}", deck.file()))
        };
        let step = arguments.every.unwrap_or(2).pow(level as u32 - 1);
        let selection = match &selection {
            Selection::BlueNoise { spacing, seed } => Selection::BlueNoise {
                spacing: spacing * f64::from(step),
                seed: *seed,
            },
            other => other.clone(),
        };
        let options = coarsen::Options {
            scheme,
            radius: match arguments.radius {
                Some(radius) => Radius::Fixed(radius * f64::from(step)),
                None => Radius::Tolerance(arguments.tolerance),
            },
            ..coarsen::Options::default()
        };
        let began = Instant::now();
        std::mem::swap(&mut body.position, &mut sites);
        let chosen = selection.choose(&body);
        std::mem::swap(&mut body.position, &mut sites);
        let retained = chosen.map_err(wrong)?;
        let (coarse, report) = coarsen::coarsen(&body, &retained, &options).map_err(wrong)?;
        let seconds = began.elapsed().as_secs_f64();
        let name = format!("level{level}");
        let text = coarsened(deck, &format!("{name}.npz"), level).map_err(Failure::input)?;
        say(&told(level, &coarse, &report, seconds));
        sites = retained.iter().map(|i| sites[*i as usize]).collect();
        made.push((name, at_sites(&coarse, &sites), report, text, seconds));
        body = coarse;
    }
    create_directory(out).map_err(|e| Failure::Run(e.to_string()))?;
    let failed = |e: peridyne_io::write::WriteError| Failure::Run(e.to_string());
    let finest = match &level0 {
        None => copied(deck),
        Some(body) => {
            write_linear(&out.join("level0.npz"), body).map_err(failed)?;
            coarsened(deck, "level0.npz", 0)
        }
    };
    save(out, "level0.toml", &finest.map_err(Failure::input)?)?;
    for (name, body, report, text, seconds) in &made {
        write_linear(&out.join(format!("{name}.npz")), body).map_err(failed)?;
        save(out, &format!("{name}.toml"), text)?;
        let json = serde_json::to_string_pretty(&record(body, report, *seconds))
            .map_err(|e| Failure::Run(e.to_string()))?;
        write_file(&out.join(format!("{name}.json")), |w| {
            w.write_all(json.as_bytes())
        })
        .map_err(failed)?;
    }
    say(&format!(
        "decks in {}: level0.toml to {}.toml",
        out.display(),
        made.last().map_or("level0", |m| &m.0)
    ));
    if !arguments.run {
        return Ok(());
    }
    if level0.is_some() {
        say("note: level 0 is the linear body about the relaxed crystal");
    } else if deck
        .spec
        .schedule
        .statics
        .is_some_and(|s| s.method != Method::Linear)
    {
        say("note: level 0 is run as its deck says, nonlinear; the levels are linear");
    }
    let fine = run(&out.join("level0.toml"), None)?;
    for (name, ..) in &made {
        let coarse = run(&out.join(format!("{name}.toml")), Some(fine.time))?;
        let m = compare(&fine, &coarse);
        say(&format!(
            "{name}: displacement error {:.3} % at {} points, {:.1} times as fast ({:.3} s against {:.3} s)",
            100.0 * m.error,
            m.points,
            m.seconds[0] / m.seconds[1],
            m.seconds[1],
            m.seconds[0],
        ));
    }
    Ok(())
}

/// A body whose points are looked for at other places.
fn at_sites<const D: usize>(body: &LinearBody<D>, sites: &[[f64; D]]) -> LinearBody<D> {
    LinearBody {
        position: sites.to_vec(),
        ..body.clone()
    }
}

fn told<const D: usize>(
    level: usize,
    body: &LinearBody<D>,
    report: &Report,
    seconds: f64,
) -> String {
    let n = body.points();
    let mut lines = vec![format!(
        "level {level}: {n} points, {:.1} bonds each, balls of radius {:.4e} ({} solved), {seconds:.2} s",
        body.partner.len() as f64 / n.max(1) as f64,
        report.radius,
        report.work.solved,
    )];
    for tried in &report.convergence {
        lines.push(format!(
            "  radius {:.4e}: effective modulus {:.8e}, changed by {:.1e}",
            tried.radius, tried.modulus, tried.change
        ));
    }
    lines.push(format!(
        "  asymmetry {:.1e} before repair, rotation {:.1e}, {}, mass kept to {:.1e}",
        report.asymmetry,
        report.soundness.rotation,
        if report.definite {
            "no unstable mode"
        } else {
            "too large to look for unstable modes"
        },
        (report.mass[1] / report.mass[0] - 1.0).abs(),
    ));
    lines.join("\n")
}

fn record<const D: usize>(
    body: &LinearBody<D>,
    report: &Report,
    seconds: f64,
) -> serde_json::Value {
    let distinct: HashSet<usize> = body.start.windows(2).map(|w| w[1] - w[0]).collect();
    serde_json::json!({
        "points": body.points(),
        "directed_bonds": body.partner.len(),
        "different_family_sizes": distinct.len(),
        "radius": report.radius.is_finite().then_some(report.radius),
        "convergence": report.convergence.iter().map(|t| serde_json::json!({
            "radius": t.radius, "modulus": t.modulus, "change": t.change,
            "left": t.left.is_finite().then_some(t.left),
        })).collect::<Vec<_>>(),
        "balls_solved": report.work.solved,
        "flops": report.work.flops,
        "asymmetry_before_repair": report.asymmetry,
        "asymmetry": report.soundness.asymmetry,
        "rotation": report.soundness.rotation,
        "checked_positive_semidefinite": report.definite,
        "mass": report.mass,
        "range": report.range,
        "seconds": seconds,
    })
}
