//! Level after level: made, written, run.

use super::arguments::CoarsenArguments;
use super::level::{Acting, Level};
use super::report::{card, record, told, waves_table};
use super::way::Way;
use crate::failure::{Failure, say};
use crate::side_by_side::{Reference, compare, run, save};
use peridyne::space::Point;
use peridyne::spec::{LinearBody, LoadMap, Method};
use peridyne_io::deck::coarsened::coarsened;
use peridyne_io::deck::upscaled::copied;
use peridyne_io::deck::{Deck, Dim, rounded};
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::linear::write_linear;
use peridyne_theory::coarsen::waves::{frequencies, stable_step};
use peridyne_theory::coarsen::{self, Mass, Radius, Selection, Stability, Volume};
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// Coarsens a body level by level, and writes and runs what was made.
pub(super) fn levels<const D: usize>(
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
    let sites = body.position.clone();
    for (x, u) in body.position.iter_mut().zip(relaxed.iter().flatten()) {
        for a in 0..D {
            x[a] += u[a];
        }
    }
    if !way.condensed && body.load_map.is_some() {
        return Err(Failure::input(
            "--loads silling: this body was condensed with its loads; begin with the deck of the whole body",
        ));
    }
    if way.condensed && body.load_map.is_none() && acting.loaded.contains(&true) {
        let (position, volume) = (sites.clone(), body.volume.clone());
        let load_map = LoadMap::of(position, volume, acting.spacing, &acting.loaded);
        body.load_map = Some(load_map);
    }
    let level0 = relaxed.is_some().then(|| at_sites(&body, &sites));
    let selection = selection(arguments, kept)?;
    let mut made: Vec<Level<D>> = vec![];
    let (finest, finest_step) = (body.clone(), stable_step(&body));
    let held = acting.held.iter().map(|h| way.supports && *h);
    let mut thinning = Thinning::new(selection, sites, body.period, held.collect());
    for level in 1..=arguments.levels {
        let wrong = |e: coarsen::CoarsenError| {
            let told = deck.units.tell(&e.message());
            Failure::input(format!("{}, level {level}: {told}", deck.file()))
        };
        let step = step(arguments, level);
        let options = coarsen::Options {
            mass: way.mass,
            ..options(arguments, way, level)
        };
        let began = Instant::now();
        let retained = thinning.next(step).map_err(wrong)?;
        let (coarse, report) = coarsen::coarsen(&body, &retained, &options).map_err(wrong)?;
        let seconds = began.elapsed().as_secs_f64();
        let name = format!("level{level}");
        let text = coarsened(deck, &format!("{name}.npz"), level).map_err(Failure::input)?;
        let made_of = Level {
            name,
            body: at_sites(&coarse, &thinning.sites),
            report,
            frequencies: frequencies(&finest, &coarse),
            steps: [finest_step, stable_step(&coarse)],
            text,
            seconds,
            supports: retained.len() - thinning.regular.len(),
        };
        say(&told(level, &made_of, way, deck.units));
        say(&card(&made_of, way, deck.units));
        if let Stability::Stable { growth } = made_of.report.stability
            && growth > 0.0
            && deck.spec.run.schedule.statics().is_none()
        {
            say(&format!(
                "note: without symmetry there is no energy: in dynamics the free vibrations of level {level} grow by a factor e in {}",
                deck.units.show(1.0 / growth, Dim::TIME)
            ));
        }
        made.push(made_of);
        body = coarse;
    }
    write_levels(out, deck, level0.as_ref(), &made, way)?;
    if arguments.run {
        run_levels(arguments, out, deck, level0.is_some(), &made)?;
    }
    Ok(())
}

/// Which points the flags retain.
pub(super) fn selection<const D: usize>(
    arguments: &CoarsenArguments,
    kept: Option<Vec<u32>>,
) -> Result<Selection<D>, Failure> {
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
    Ok(selection)
}

/// How much coarser the body below a level is than the first.
pub(super) fn step(arguments: &CoarsenArguments, level: usize) -> u32 {
    arguments.every.unwrap_or(2).pow(level as u32 - 1)
}

/// How a level is made, masses lumped.
pub(super) fn options(arguments: &CoarsenArguments, way: Way, level: usize) -> coarsen::Options {
    coarsen::Options {
        scheme: way.scheme,
        symmetrise: way.symmetrise,
        rotation: arguments.rotation,
        mass: Mass::Lumped,
        volume: match way.condensed {
            true => Volume::Lumped,
            false => Volume::Kept,
        },
        radius: match arguments.radius {
            Some(radius) => Radius::Fixed(radius * f64::from(step(arguments, level))),
            None => Radius::Tolerance(arguments.tolerance),
        },
    }
}

/// Points become fewer, level by level.
pub(super) struct Thinning<const D: usize> {
    selection: Selection<D>,
    period: [Option<f64>; D],
    /// Of the points of the level (length).
    sites: Vec<[f64; D]>,
    /// Points among which the next ones are chosen, and points that stay because they are held.
    regular: Vec<u32>,
    held: Vec<u32>,
}

impl<const D: usize> Thinning<D> {
    pub fn new(
        selection: Selection<D>,
        sites: Vec<[f64; D]>,
        period: [Option<f64>; D],
        held: Vec<bool>,
    ) -> Self {
        let all = 0..sites.len() as u32;
        Thinning {
            selection,
            period,
            regular: all.clone().collect(),
            held: all.filter(|i| held[*i as usize]).collect(),
            sites,
        }
    }

    /// The points of the next level, by their numbers in the one below, which is so many `step`s coarse.
    pub fn next(&mut self, step: u32) -> Result<Vec<u32>, coarsen::CoarsenError> {
        let selection = match &self.selection {
            Selection::BlueNoise { spacing, seed } => Selection::BlueNoise {
                spacing: spacing * f64::from(step),
                seed: *seed,
            },
            other => other.clone(),
        };
        let among = LinearBody {
            position: (self.regular.iter())
                .map(|i| self.sites[*i as usize])
                .collect(),
            period: self.period,
            ..LinearBody::nothing()
        };
        let chosen = selection.choose(&among)?;
        let chosen: Vec<u32> = chosen.iter().map(|k| self.regular[*k as usize]).collect();
        let mut retained = [chosen.as_slice(), &self.held].concat();
        retained.sort_unstable();
        retained.dedup();
        let place = |i: &u32| retained.partition_point(|r| r < i) as u32;
        self.regular = chosen.iter().map(place).collect();
        self.held = self.held.iter().map(place).collect();
        self.sites = { retained.iter() }
            .map(|i| self.sites[*i as usize])
            .collect();
        Ok(retained)
    }
}

/// Decks, linear bodies and records of all levels, in a folder.
fn write_levels<const D: usize>(
    out: &Path,
    deck: &Deck,
    level0: Option<&LinearBody<D>>,
    made: &[Level<D>],
    way: Way,
) -> Result<(), Failure> {
    create_directory(out).map_err(|e| Failure::Run(e.to_string()))?;
    let failed = |e: peridyne_io::write::WriteError| Failure::Run(e.to_string());
    let finest = match level0 {
        None => copied(deck),
        Some(body) => {
            write_linear(&out.join("level0.npz"), body).map_err(failed)?;
            coarsened(deck, "level0.npz", 0)
        }
    };
    save(out, "level0.toml", &finest.map_err(Failure::input)?)?;
    for level in made {
        let name = &level.name;
        write_linear(&out.join(format!("{name}.npz")), &level.body).map_err(failed)?;
        save(out, &format!("{name}.toml"), &level.text)?;
        let json = serde_json::to_string_pretty(&record(level, way))
            .map_err(|e| Failure::Run(e.to_string()))?;
        write_file(&out.join(format!("{name}.json")), |w| {
            w.write_all(json.as_bytes())
        })
        .map_err(failed)?;
        if let Some(table) = waves_table(level, deck.units) {
            let path = out.join(format!("{name}-waves.csv"));
            table.save(&path).map_err(failed)?;
        }
    }
    say(&format!(
        "decks in {}: level0.toml to {}.toml",
        out.display(),
        made.last().map_or("level0", |m| &m.name)
    ));
    Ok(())
}

/// Displacement error of a moving body that is warned of.
const OFF: f64 = 0.05;

/// Runs all levels and tells how far they are from the finest.
fn run_levels<const D: usize>(
    arguments: &CoarsenArguments,
    out: &Path,
    deck: &Deck,
    relaxed: bool,
    made: &[Level<D>],
) -> Result<(), Failure> {
    if arguments.average.is_some() {
        say("note: level 0 is the linear body about the mean places of the atoms");
    } else if relaxed {
        say("note: level 0 is the linear body about the relaxed crystal");
    } else if deck
        .spec
        .run
        .schedule
        .statics()
        .is_some_and(|s| s.method != Method::Linear)
    {
        say("note: level 0 is run as its deck says, nonlinear; the levels are linear");
    }
    let mut fine = Reference::new(out.join("level0.toml"));
    for Level { name, .. } in made {
        let coarse = run(&out.join(format!("{name}.toml")), None)?;
        let m = compare(fine.until(coarse.time)?, &coarse);
        if !m.error.is_finite() {
            say(&format!(
                "{name}: nothing moves at the {} points that both have: there is no error to compute",
                m.points
            ));
            continue;
        }
        say(&format!(
            "{name}: displacement error {} % at {} points, {:.1} times as fast ({:.3} s against {:.3} s)",
            match 100.0 * m.error {
                small if small < 1e-3 => rounded(small, 2),
                error => format!("{error:.3}"),
            },
            m.points,
            m.seconds[0] / m.seconds[1],
            m.seconds[1],
            m.seconds[0],
        ));
        if deck.spec.run.schedule.statics().is_none() && m.error > OFF {
            say(&format!(
                "warning: {name} moves otherwise than level 0, by {:.0} %: removed points are taken to be in equilibrium at every moment, and waves of some ten coarse spacings and less come out slow; retain more points, or let loads and pulses be longer (the errors of frequencies are in {name}.json)",
                100.0 * m.error
            ));
        }
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
