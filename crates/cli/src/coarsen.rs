//! `peridyne coarsen`: linear bodies level by level.

use crate::Input;
use crate::deck;
use crate::failure::{Failure, say};
use crate::run::with_threads;
use crate::side_by_side::{compare, run, save};
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::spec::{
    AnyLinearBody, Carriers, ConditionKind, LinearBody, Method, Stepper, TimeStep,
};
use peridyne::statics::SYMMETRIC;
use peridyne_io::deck::Deck;
use peridyne_io::deck::coarsened::coarsened;
use peridyne_io::deck::upscaled::{Rewritten, copied};
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::linear::write_linear;
use peridyne_theory::coarsen::{self, Radius, Report, Scheme, Selection, Stability, Volume};
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
    /// Makes action reaction where rows do not (`K_ij ← ½ (K_ij + K_jiᵀ)`): yes or no. As published they are not symmetric; where they
    /// are made so, rotations of plates and blocks may meet forces.
    #[arg(long, default_value = "no", value_name = "YES|NO")]
    pub symmetrise: String,
    /// condensed: body forces and tractions on removed points go where the condensation leads them, none is lost. silling: a body force
    /// density acts on retained points alone, which keep their own volumes, so that it is the same force on them at every level.
    #[arg(long, default_value = "condensed", value_name = "CONVENTION")]
    pub loads: String,
    /// kept: points whose displacement or velocity is prescribed are retained besides the others, so that the body is held as it was.
    /// thinned: only those of them that are retained anyway.
    #[arg(long, default_value = "kept", value_name = "KEPT|THINNED")]
    pub supports: String,
    /// Largest force under a rigid rotation, relative to the stiffness, that is accepted.
    #[arg(long, default_value_t = 1e-3, value_name = "FRACTION")]
    pub rotation: f64,
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
    spec.schedule.stepper = Stepper::Verlet;
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
    let way = Way::of(arguments)?;
    let ids = |act: fn(&ConditionKind) -> bool| -> Result<Vec<bool>, Failure> {
        let mut marked = vec![false; sim.info().points as usize];
        for c in deck.spec.conditions.iter().filter(|c| act(&c.kind)) {
            let members = sim
                .members(&c.set)
                .ok_or_else(|| Failure::input(format!("{} has no set `{}`", deck.file(), c.set)))?;
            members.iter().for_each(|i| marked[*i as usize] = true);
        }
        Ok(marked)
    };
    let acting = Acting {
        loaded: ids(adds_force)?,
        held: ids(prescribes)?,
        spacing: sim.info().spacing,
        way,
    };
    let out = arguments.out.clone().unwrap_or_else(|| {
        let name = arguments.input.file.file_stem();
        let name = name.map_or("deck".into(), |n| n.to_string_lossy());
        Path::new("out").join(format!("{name}-coarsened"))
    });
    let relaxed = match spec.potential() {
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
        AnyLinearBody::One(body) => levels(arguments, deck, &out, body, relaxed, kept, acting),
        AnyLinearBody::Two(body) => levels(arguments, deck, &out, body, relaxed, kept, acting),
        AnyLinearBody::Three(body) => levels(arguments, deck, &out, body, relaxed, kept, acting),
    }
}

/// How the flags want it.
#[derive(Clone, Copy)]
struct Way {
    scheme: Scheme,
    symmetrise: bool,
    /// Are loads condensed, or as in the paper?
    condensed: bool,
    /// Are all prescribed points retained?
    supports: bool,
}

impl Way {
    fn of(arguments: &CoarsenArguments) -> Result<Way, Failure> {
        let one_of = |flag: &str, value: &str, names: &[&str]| {
            names.iter().position(|n| *n == value).ok_or_else(|| {
                let (last, first) = names.split_last().unwrap_or((&"", &[]));
                Failure::input(format!(
                    "--{flag} {value}: expected {} or {last}",
                    first.join(", ")
                ))
            })
        };
        let schemes = [Scheme::Energy, Scheme::Rows, Scheme::Schur];
        let scheme = one_of("scheme", &arguments.scheme, &["energy", "rows", "schur"])?;
        if !(arguments.rotation >= 0.0) {
            return Err(Failure::input(format!(
                "--rotation {}: expected a fraction of the stiffness, such as 0.001",
                arguments.rotation
            )));
        }
        Ok(Way {
            scheme: schemes[scheme],
            symmetrise: one_of("symmetrise", &arguments.symmetrise, &["no", "yes"])? == 1,
            condensed: one_of("loads", &arguments.loads, &["condensed", "silling"])? == 0,
            supports: one_of("supports", &arguments.supports, &["kept", "thinned"])? == 0,
        })
    }
}

/// What the conditions of a deck do, point by point.
struct Acting {
    /// `[N]`
    loaded: Vec<bool>,
    held: Vec<bool>,
    spacing: f64,
    way: Way,
}

/// Does a condition add force densities, which are condensed?
fn adds_force(kind: &ConditionKind) -> bool {
    match kind {
        ConditionKind::BodyForce(_) | ConditionKind::Traction { .. } => true,
        ConditionKind::Displacement(_)
        | ConditionKind::Velocity(_)
        | ConditionKind::SetForce(_)
        | ConditionKind::Damping(_) => false,
    }
}

/// Does it prescribe motion?
fn prescribes(kind: &ConditionKind) -> bool {
    match kind {
        ConditionKind::Displacement(_) | ConditionKind::Velocity(_) => true,
        ConditionKind::BodyForce(_)
        | ConditionKind::Traction { .. }
        | ConditionKind::SetForce(_)
        | ConditionKind::Damping(_) => false,
    }
}

/// A level that was made.
struct Level<const D: usize> {
    name: String,
    body: LinearBody<D>,
    report: Report,
    text: Rewritten,
    seconds: f64,
    /// Points that are retained only because they are held.
    supports: usize,
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
    acting: Acting,
) -> Result<(), Failure> {
    let way = acting.way;
    // atoms are where they rest; files, sets and conditions know them by their sites
    let mut sites = body.position.clone();
    for (x, u) in body.position.iter_mut().zip(relaxed.iter().flatten()) {
        for a in 0..D {
            x[a] += u[a];
        }
    }
    if !way.condensed && body.carriers.is_some() {
        return Err(Failure::input(
            "--loads silling: this body was condensed with its loads; begin with the deck of the whole body",
        ));
    }
    if way.condensed && body.carriers.is_none() && acting.loaded.contains(&true) {
        let (position, volume) = (sites.clone(), body.volume.clone());
        let carriers = Carriers::of(position, volume, acting.spacing, &acting.loaded);
        body.carriers = Some(carriers);
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
    let mut made: Vec<Level<D>> = vec![];
    // of the level below: points among which the next ones are chosen, and points that stay because they are held
    let mut regular: Vec<u32> = (0..body.points() as u32).collect();
    let mut held: Vec<u32> = regular.clone();
    held.retain(|i| way.supports && acting.held[*i as usize]);
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
            scheme: way.scheme,
            symmetrise: way.symmetrise,
            rotation: arguments.rotation,
            volume: match way.condensed {
                true => Volume::Lumped,
                false => Volume::Kept,
            },
            radius: match arguments.radius {
                Some(radius) => Radius::Fixed(radius * f64::from(step)),
                None => Radius::Tolerance(arguments.tolerance),
            },
        };
        let began = Instant::now();
        let among = LinearBody {
            position: regular.iter().map(|i| sites[*i as usize]).collect(),
            period: body.period,
            ..LinearBody::nothing()
        };
        let chosen = selection.choose(&among).map_err(wrong)?;
        let chosen: Vec<u32> = chosen.iter().map(|k| regular[*k as usize]).collect();
        let mut retained = [chosen.as_slice(), &held].concat();
        retained.sort_unstable();
        retained.dedup();
        let place = |i: &u32| retained.partition_point(|r| r < i) as u32;
        regular = chosen.iter().map(place).collect();
        held = held.iter().map(place).collect();
        let (coarse, report) = coarsen::coarsen(&body, &retained, &options).map_err(wrong)?;
        let seconds = began.elapsed().as_secs_f64();
        let name = format!("level{level}");
        let text = coarsened(deck, &format!("{name}.npz"), level).map_err(Failure::input)?;
        sites = retained.iter().map(|i| sites[*i as usize]).collect();
        let made_of = Level {
            name,
            body: at_sites(&coarse, &sites),
            report,
            text,
            seconds,
            supports: retained.len() - regular.len(),
        };
        say(&told(level, &made_of, way));
        if let Stability::Stable { growth } = made_of.report.stability
            && growth > 0.0
            && deck.spec.schedule.statics().is_none()
        {
            say(&format!(
                "note: without symmetry there is no energy: in dynamics the free vibrations of level {level} grow by a factor e in {:.3e}",
                1.0 / growth
            ));
        }
        made.push(made_of);
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
    for level in &made {
        let name = &level.name;
        write_linear(&out.join(format!("{name}.npz")), &level.body).map_err(failed)?;
        save(out, &format!("{name}.toml"), &level.text)?;
        let json = serde_json::to_string_pretty(&record(level, way))
            .map_err(|e| Failure::Run(e.to_string()))?;
        write_file(&out.join(format!("{name}.json")), |w| {
            w.write_all(json.as_bytes())
        })
        .map_err(failed)?;
    }
    say(&format!(
        "decks in {}: level0.toml to {}.toml",
        out.display(),
        made.last().map_or("level0", |m| &m.name)
    ));
    if !arguments.run {
        return Ok(());
    }
    if level0.is_some() {
        say("note: level 0 is the linear body about the relaxed crystal");
    } else if deck
        .spec
        .schedule
        .statics()
        .is_some_and(|s| s.method != Method::Linear)
    {
        say("note: level 0 is run as its deck says, nonlinear; the levels are linear");
    }
    let fine = run(&out.join("level0.toml"), None)?;
    for Level { name, .. } in &made {
        let coarse = run(&out.join(format!("{name}.toml")), Some(fine.time))?;
        let m = compare(&fine, &coarse);
        if !m.error.is_finite() {
            say(&format!(
                "{name}: nothing moves at the {} points that both have: no error can be told",
                m.points
            ));
            continue;
        }
        say(&format!(
            "{name}: displacement error {} % at {} points, {:.1} times as fast ({:.3} s against {:.3} s)",
            match 100.0 * m.error {
                small if small < 1e-3 => format!("{small:.1e}"),
                error => format!("{error:.3}"),
            },
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

fn told<const D: usize>(level: usize, made: &Level<D>, way: Way) -> String {
    let (body, report) = (&made.body, &made.report);
    let n = body.points();
    let mut lines = vec![format!(
        "level {level}: {n} points{}, {:.1} bonds each, {}, {:.2} s",
        match made.supports {
            0 => String::new(),
            k => format!(" ({k} only because they are held)"),
        },
        body.partner.len() as f64 / n.max(1) as f64,
        match way.scheme {
            Scheme::Schur => "all others eliminated at once".to_string(),
            Scheme::Energy | Scheme::Rows => format!(
                "balls of radius {:.4e} ({} solved{})",
                report.radius,
                report.work.solved,
                match report.work.direct {
                    0 => String::new(),
                    k => format!(", {k} by LU"),
                }
            ),
        },
        made.seconds
    )];
    for tried in report.convergence.iter().filter(|t| t.radius.is_finite()) {
        lines.push(format!(
            "  radius {:.4e}: effective modulus {:.8e}{}",
            tried.radius,
            tried.modulus,
            match tried.left.is_finite() || tried.change > 0.0 {
                true => format!(", changed by {:.1e}", tried.change),
                // the first of all has nothing to be compared with
                false => String::new(),
            }
        ));
    }
    let asymmetry = match report.soundness.asymmetry == report.asymmetry {
        true => format!("asymmetry {:.1e}", report.asymmetry),
        false => format!(
            "asymmetry {:.1e}, repaired to {:.1e}",
            report.asymmetry, report.soundness.asymmetry
        ),
    };
    lines.push(format!(
        "  {asymmetry}, rotation {:.1e}, {}, mass kept to {:.1e}",
        report.soundness.rotation,
        match report.stability {
            Stability::Definite => "no unstable mode",
            Stability::Stable { .. } => "no unstable mode of the operator as it is",
            Stability::Positive => "no unstable mode (by its symmetric part)",
            Stability::Unknown => "too large to look for unstable modes",
        },
        (report.mass[1] / report.mass[0] - 1.0).abs(),
    ));
    lines.push(match (way.condensed, report.loss) {
        (true, Some(loss)) => format!("  loads condensed with the body, kept to {loss:.1e}"),
        (true, None) => "  no loads to condense".into(),
        (false, _) => {
            "  loads as in the paper: the same force density on the volumes of level 0".into()
        }
    });
    lines.join("\n")
}

fn record<const D: usize>(level: &Level<D>, way: Way) -> serde_json::Value {
    let (body, report) = (&level.body, &level.report);
    let (stability, growth) = match report.stability {
        Stability::Definite => ("definite", None),
        Stability::Stable { growth } => ("stable", Some(growth)),
        Stability::Positive => ("stable by the symmetric part", None),
        Stability::Unknown => ("not looked at", None),
    };
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
        "balls_solved_by_lu": report.work.direct,
        "symmetrised": way.symmetrise,
        "symmetric": report.soundness.asymmetry < SYMMETRIC,
        "stability": stability,
        "growth_rate": growth,
        "loads": if way.condensed { "condensed" } else { "silling" },
        "loads_lost": report.loss,
        "supports": if way.supports { "kept" } else { "thinned" },
        "support_points": level.supports,
        "flops": report.work.flops,
        "asymmetry_before_repair": report.asymmetry,
        "asymmetry": report.soundness.asymmetry,
        "rotation": report.soundness.rotation,
        "checked_positive_semidefinite": report.definite,
        "mass": report.mass,
        "range": report.range,
        "seconds": level.seconds,
    })
}
