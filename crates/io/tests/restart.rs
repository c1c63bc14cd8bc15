//! Every good deck goes on from its saved state, in a model that was never started, bit for bit.

use peridyne::run::{Options, Simulation, build};
use peridyne::state::Archive;
use peridyne_io::deck::Deck;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Steps before and after the state is saved, at most; `PERIDYNE_RESTART_STEPS` says others.
const STEPS: u64 = 12;

/// Decks whose state is not whole yet: this list may only shrink.
const NOT_YET: &[&str] = &[];

fn most_steps() -> u64 {
    let asked = std::env::var("PERIDYNE_RESTART_STEPS");
    asked.map_or(STEPS, |n| n.parse().unwrap())
}

fn saved(sim: &mut dyn Simulation) -> Vec<u8> {
    let mut to = vec![];
    let mut archive = Archive::save(&mut to);
    archive.part("model", sim);
    archive.done().unwrap();
    to
}

/// What is seen of a model: vectors of points and, bit by bit, its ledger.
fn seen(sim: &mut dyn Simulation) -> Vec<u64> {
    let mut all = vec![];
    for name in ["displacement", "velocity", "force_density"] {
        all.extend(sim.vectors(name).as_flattened().iter().map(|x| x.to_bits()));
    }
    all.extend(sim.measure().iter().map(|x| x.to_bits()));
    all.push(sim.broken());
    all.push(sim.clock().to_bits());
    if let Ok(l) = sim.ledger() {
        let account = [
            l.kinetic,
            l.strain,
            l.contact,
            l.released,
            l.dissipated,
            l.made,
            l.numerical,
            l.work_boundary_conditions,
            l.work_rigid_bodies,
            l.initial,
        ];
        all.extend(account.map(f64::to_bits));
    }
    all
}

/// The first array that differs.
fn differs(a: &[u8], b: &[u8]) -> String {
    let (mut at, mut same) = (0, true);
    let mut name = String::new();
    while at < a.len() && same {
        let long = usize::from(a[at]);
        name = String::from_utf8_lossy(&a[at + 1..at + 1 + long]).into_owned();
        let head = at + 1 + long;
        let bytes = u32::from_le_bytes(a[head..head + 4].try_into().unwrap()) as usize;
        let count = u64::from_le_bytes(a[head + 4..head + 12].try_into().unwrap()) as usize;
        let end = head + 12 + bytes * count;
        same = a.get(at..end) == b.get(at..end);
        at = end;
    }
    name
}

fn goes_on(path: &Path) -> Result<(), String> {
    let text = std::fs::read_to_string(path).unwrap();
    let Ok(deck) = Deck::parse(&text, path.to_str().unwrap(), &[]) else {
        // a conservation law
        return Ok(());
    };
    let model = || build(&deck.spec, Options::default()).unwrap();
    let mut whole = model();
    let steps = deck.steps(whole.info().time_step);
    // in statics before motion, and beyond it
    let (before, most) = (deck.increments(), most_steps());
    let stops = match before {
        0 => vec![(steps / 3).min(most)],
        n => vec![n / 2, n, n + (steps - n).min(most) / 2],
    };
    let end = (before + 2 * most).min(steps);
    whole.start(true);
    let mut states = vec![];
    for step in 0..end {
        if stops.contains(&step) {
            states.push((step, saved(&mut *whole), seen(&mut *whole)));
        }
        whole.step().map_err(|e| format!("step {step}: {e}"))?;
    }
    let last = (seen(&mut *whole), saved(&mut *whole));
    for (step, state, here) in states {
        let mut again = model();
        let mut from = state.as_slice();
        let mut archive = Archive::load(&mut from);
        archive.part("model", &mut *again);
        archive.done().map_err(|e| format!("from {step}: {e}"))?;
        if again.step_number() != step {
            return Err(format!("from {step}: at {}", again.step_number()));
        }
        let restored = saved(&mut *again);
        if restored != state {
            return Err(format!(
                "from {step}: `{}` is not what was saved",
                differs(&state, &restored)
            ));
        }
        if seen(&mut *again) != here {
            return Err(format!("from {step}: another state is seen"));
        }
        for _ in step..end {
            again.step().map_err(|e| format!("from {step}: {e}"))?;
        }
        let (sees, now) = (seen(&mut *again), saved(&mut *again));
        if now != last.1 {
            return Err(format!(
                "from {step}: `{}` differs at {end}",
                differs(&last.1, &now)
            ));
        }
        if sees != last.0 {
            return Err(format!("from {step}: another end is seen"));
        }
    }
    // saving changes nothing
    let mut unsaved = model();
    unsaved.start(true);
    for _ in 0..end {
        unsaved.step().map_err(|e| e.to_string())?;
    }
    let sees = seen(&mut *unsaved);
    let now = saved(&mut *unsaved);
    match now == last.1 && sees == last.0 {
        true => Ok(()),
        false => Err(format!("saving changes `{}`", differs(&last.1, &now))),
    }
}

#[test]
fn every_good_deck_goes_on_from_its_saved_state_bit_for_bit() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    let only = std::env::var("PERIDYNE_DECKS").unwrap_or_default();
    let mut decks: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .filter(|p| p.to_str().unwrap().contains(&only))
        .collect();
    decks.sort();
    let (next, found) = (AtomicUsize::new(0), Mutex::new(vec![]));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(deck) = decks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let name = deck.file_stem().unwrap().to_str().unwrap().to_string();
                    let begin = std::time::Instant::now();
                    let went = catch_unwind(AssertUnwindSafe(|| goes_on(deck)));
                    let went = went.unwrap_or_else(|_| Err("panics".into()));
                    println!("{name} {:.1} s {went:?}", begin.elapsed().as_secs_f64());
                    if went.is_err() != NOT_YET.contains(&name.as_str()) {
                        found.lock().unwrap().push((name, went));
                    }
                }
            });
        }
    });
    let found = found.into_inner().unwrap();
    assert!(found.is_empty(), "{found:#?}");
}
