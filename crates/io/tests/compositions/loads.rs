//! Steps, equilibria, heat.

use crate::breaking::cut;
use crate::case::{
    Answer, Case, Deck, Keeps, SHARE, Stop, balanced, finite, go, hold, largest, moved, settle,
    wrong,
};
use peridyne::observe::Ledger;
use peridyne::run::Simulation;

pub fn motion(case: &Case) -> Answer {
    let mut deck = case.deck();
    deck.tables += &case.pull(0.05);
    let mut sim = deck.model()?;
    go(&mut *sim, case.time(), Keeps::Momentum, [SHARE, 0.0])?;
    hold(largest(&sim.displacements()) > 0.0, || {
        "nothing moved".into()
    })
}

/// Implicit steps of a quarter of the time from neighbour to neighbour: the body is where explicit steps bring it. An oscillation with ω dt < 1 lags by
/// (ω dt)²/12 of its phase, within a tenth of the largest displacement in these steps; the work of forces by the trapezoidal rule is theirs but for
/// strains.
pub fn implicit(case: &Case, integrator: &str) -> Answer {
    let part = 0.05;
    let mut deck = case.deck();
    deck.tables += &case.pull(part);
    let mut exact = deck.clone();
    deck.run = format!(
        "[run]\nintegrator = \"{integrator}\"\nsteps = 12\ntime_step = {:e}\n",
        0.25 * case.law.place.time
    );
    let mut sim = deck.model()?;
    let until = case.time() * (1.0 - 1e-9);
    let share = case.law.strain;
    go(&mut *sim, until, Keeps::Momentum, [share, 0.0])?;
    exact.run = format!(
        "[run]\nsteps = 10\ntime_step = {:e}\n",
        0.025 * case.law.place.time
    );
    let mut exact = exact.model()?;
    go(&mut *exact, until, Keeps::Momentum, [SHARE, 0.0])?;
    let off = crate::case::apart(&exact.displacements(), 1.0, &sim.displacements());
    hold(off < 0.1, || format!("{off} away from explicit steps"))
}

pub fn newmark(case: &Case) -> Answer {
    implicit(case, "newmark")
}

pub fn hht(case: &Case) -> Answer {
    implicit(case, "hht")
}

/// Supports 2e-3 apart by the length, with what a method needs more.
fn stretched(case: &Case, statics: &str) -> Deck {
    let mut deck = case.deck();
    let right = format!("{:e}*t", 0.002 * case.law.place.length);
    deck.tables += &case.grips("", &right);
    deck.run = format!("[statics]\n{statics}");
    deck
}

/// By the trapezoidal rule work and energy differ by some strains of 2e-3, between grips three times as much.
const STRAINS: f64 = 0.02;

pub fn newton(case: &Case) -> Answer {
    let mut sim = stretched(case, "method = \"newton\"\nincrements = 3\n").model()?;
    settle(case, &mut *sim, 3, STRAINS).map(|_| ())
}

pub fn relaxation(case: &Case) -> Answer {
    let statics = "method = \"relaxation\"\nincrements = 2\ntolerance = 1e-7\n";
    let mut sim = stretched(case, statics).model()?;
    settle(case, &mut *sim, 2, STRAINS).map(|_| ())
}

/// Reactions grow alike with each part of the load, from what they are without any, and supports balance; what they do is in the energy, which is quadratic
/// in the displacements, whether bonds pull in the reference or not.
pub fn linear(case: &Case) -> Answer {
    let mut sim = stretched(case, "method = \"linear\"\nincrements = 3\n").model()?;
    sim.start(true);
    let d = case.law.place.dimension;
    let first = sim.ledger().map_err(wrong)?;
    let mut all = vec![];
    for _ in 0..3 {
        sim.step().map_err(wrong)?;
        all.push(sim.measure());
    }
    finite(&mut *sim)?;
    let last = sim.ledger().map_err(wrong)?;
    balanced(&last, 1e-7 * moved(&first, &last))?;
    let right: Vec<f64> = all.iter().map(|r| r[d]).collect();
    let most = right.iter().fold(0.0f64, |m, r| m.max(r.abs()));
    let bend = (right[2] - 2.0 * right[1] + right[0]).abs();
    let sum = (all[2][0] + right[2]).abs();
    let grows = (right[2] - right[1]).abs() > 1e-6 * most;
    hold(grows && bend < 1e-8 * most && sum < 1e-8 * most, || {
        format!("reactions {all:?}")
    })
}

/// A body is stretched and let go.
pub fn preload(case: &Case) -> Answer {
    let mut deck = case.deck();
    let right = format!("{:e}*t", 0.002 * case.law.place.length);
    deck.tables += &case.grips("stage = \"statics\"\n", &right);
    deck.run = format!(
        "[statics]\nmethod = \"newton\"\nincrements = 2\n{}",
        deck.run
    );
    let mut sim = deck.model()?;
    let share = match case.law.calm {
        true => SHARE + STRAINS,
        // forces of the reference did work before supports did
        false => f64::INFINITY,
    };
    go(&mut *sim, case.time(), Keeps::Nothing, [share, 0.0])?;
    let moving = sim.ledger().map_err(wrong)?.kinetic;
    let (sum, size) = crate::case::momentum(&mut *sim, None);
    let off = sum.iter().fold(0.0f64, |m, p| m.max(p.abs()));
    hold(moving > 0.0 && off < 1e-6 * size, || {
        format!("kinetic energy {moving:e}, momentum {off:e} of {size:e}")
    })
}

/// A body that is held at one end: all squares above 0, lowest first, and `Σ m φ² = 1`.
pub fn modes(case: &Case) -> Answer {
    let mut sim = stretched(case, "increments = 0\nmodes = 3\n").model()?;
    sim.start(true);
    let modes = sim.modes(3).map_err(wrong)?;
    let squares: Vec<f64> = modes.iter().map(|m| m.square).collect();
    let rises = squares.is_sorted() && squares.first().is_some_and(|s| *s > 0.0);
    let (density, volume) = (sim.scalars("density"), sim.scalars("volume"));
    let mass = |i: usize| density[i] * volume[i];
    let norm = |m: &peridyne::run::ModeShape| -> f64 {
        let each = m.shape.iter().enumerate();
        each.map(|(i, x)| mass(i) * x.iter().map(|x| x * x).sum::<f64>())
            .sum()
    };
    let off = modes
        .iter()
        .fold(0.0f64, |m, s| m.max((norm(s) - 1.0).abs()));
    hold(rises && off < 1e-8, || {
        format!("squares {squares:?}, masses off by {off:e}")
    })
}

/// Two increments go twice as far as one, but for their bend.
pub fn arc_length(case: &Case) -> Answer {
    let arc = 0.001 * case.law.place.length;
    let statics = format!(
        "method = \"newton\"\ncontrol = \"arc_length\"\narc_length = {arc:e}\nincrements = 2\n"
    );
    let mut sim = stretched(case, &statics).model()?;
    settle(case, &mut *sim, 2, STRAINS)?;
    let u = sim.displacements();
    let square: f64 = u.as_flattened().iter().map(|u| u * u).sum();
    let way = (square / u.len() as f64).sqrt();
    hold((way / (2.0 * arc) - 1.0).abs() < 0.02, || {
        format!("went {way:e} in two increments of {arc:e}")
    })
}

fn in_turn(case: &Case, statics: &str, tables: &str) -> Result<Box<dyn Simulation>, Stop> {
    let mut deck = stretched(case, statics);
    deck.tables += tables;
    deck.fracture = Some(format!("critical_stretch = {}", case.limit()));
    let mut sim = deck.model()?;
    settle(case, &mut *sim, 3, case.law.strain)?;
    Ok(sim)
}

/// Bond after bond.
pub fn breaking(case: &Case) -> Answer {
    let sim = in_turn(
        case,
        "method = \"linear\"\ncontrol = \"sequentially_linear\"\nincrements = 3\n",
        "",
    )?;
    hold(sim.broken() > 0, || "no bond broke".into())
}

/// Of laws that soften, at a cut through half of the body: bonds that are all alike soften anywhere, and no one path is theirs. An opening of half of the
/// onset is an increment of the trapezoidal rule.
pub fn opening(case: &Case) -> Answer {
    let open = 0.025 * case.law.strain;
    let mut sim = in_turn(
        case,
        &format!(
            "method = \"newton\"\ncontrol = \"indirect_displacement\"\nopening = {open:e}\nincrements = 3\n"
        ),
        &cut(case, 0.5),
    )?;
    let Ledger {
        work_boundary_conditions: work,
        dissipated: lost,
        ..
    } = sim.ledger().map_err(wrong)?;
    hold(work > lost && lost > 0.0, || {
        format!("softening took {lost:e} of a work of {work:e}")
    })
}

const HEAT: &str = ", heat = { conductivity = 1, capacity = 1, expansion = EXPANSION }";

fn warm(case: &Case, expansion: f64, initial: &str) -> Deck {
    let mut deck = case.deck();
    deck.material += &HEAT.replace("EXPANSION", &expansion.to_string());
    deck.tables += &format!("[heat]\n[[initial]]\ntemperature = \"{initial}\"\n");
    deck
}

/// Heat flows until nothing is hotter than it was, and none is lost.
pub fn heat(case: &Case) -> Answer {
    let mut deck = warm(case, 0.0, &format!("1 + x/{}", case.law.place.length));
    deck.material = deck.material.replace(", expansion = 0", "");
    let mut sim = deck.model()?;
    let spread = |sim: &mut dyn Simulation| {
        let all = sim.scalars("temperature");
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        all.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
    };
    let before = spread(&mut *sim);
    go(
        &mut *sim,
        case.time(),
        Keeps::Momentum,
        [f64::INFINITY, 0.0],
    )?;
    let after = spread(&mut *sim);
    let [(_, account)] = &sim.diffusions()[..] else {
        return Err(Stop::Wrong("heat has no account".into()));
    };
    let off = (account.content / account.initial - 1.0).abs();
    hold(after < before && off < 1e-12, || {
        format!("temperatures differ by {before}, then {after}; heat off by {off:e}")
    })
}

/// A free body that is 10 warmer is longer and wider by `α ΔT` in the mean when it has come to rest: damped as the slowest motion along it asks for,
/// 2 ρ π c/L, until that has fallen by e^(-40). Between plates (plane strain) a fluid is so by `(1 + ν) α ΔT` with ν = ½: its volume grows by `3 α ΔT`, and which
/// way nothing says.
pub fn expansion(case: &Case) -> Answer {
    let alpha = 1e-4;
    let mut deck = warm(case, alpha, "10");
    let place = &case.law.place;
    let slowest = std::f64::consts::PI * place.near / (place.time * place.length);
    deck.tables += &format!("[[boundary_condition]]\ndamping = {:e}\n", 2.0 * slowest);
    deck.run = "[run]\nsteps = 10\ntime_step = { safety = 0.3 }\n".into();
    let mut sim = deck.model()?;
    go(
        &mut *sim,
        40.0 / slowest,
        Keeps::Nothing,
        [f64::INFINITY, 0.0],
    )?;
    let (x, u) = (sim.vectors("reference"), sim.displacements());
    let across = match case.law.place.top.contains("plane = \"strain\"") {
        true => 1.5,
        false => 1.0,
    };
    let asked = across * alpha * 10.0;
    let grown = |a: usize, size: f64| {
        let (mut along, mut square) = (0.0, 0.0);
        for (x, u) in x.iter().zip(&u) {
            along += (x[a] - 0.5 * size) * u[a];
            square += (x[a] - 0.5 * size).powi(2);
        }
        along / square
    };
    let strain = 0.5 * (grown(0, place.length) + grown(1, place.width));
    hold((strain / asked - 1.0).abs() < 0.05, || {
        format!("grew by {strain:e}, expected {asked:e}")
    })
}
