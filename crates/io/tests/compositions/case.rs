//! One cell of the table: a deck, the model of it, and what must hold of all of them.

use crate::laws::Law;
use peridyne::observe::Ledger;
use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::Deck as Read;
use std::path::Path;

/// Why a cell is not that the feature ran, and did what it is there for.
#[derive(Debug, Clone)]
pub enum Stop {
    /// By the reader of decks or by the engine, before anything moved.
    Refused(String),
    /// What does not hold, with its numbers.
    Wrong(String),
}

pub type Answer = Result<(), Stop>;

pub fn hold(holds: bool, else_: impl FnOnce() -> String) -> Answer {
    match holds {
        true => Ok(()),
        false => Err(Stop::Wrong(else_())),
    }
}

pub fn wrong(error: impl std::fmt::Display) -> Stop {
    Stop::Wrong(error.to_string())
}

/// A law in a family.
#[derive(Clone, Copy)]
pub struct Case {
    pub law: &'static Law,
    pub family: &'static str,
}

/// A deck in parts: keys of its top come before its tables.
#[derive(Clone)]
pub struct Deck {
    pub top: String,
    /// Without its origin; empty: `tables` has bodies.
    pub body: String,
    /// Keys of the one material; empty: `tables` has several.
    pub material: String,
    pub fracture: Option<String>,
    pub tables: String,
    pub run: String,
}

/// Part of the stable step: a linear oscillation whose period is that of the stability limit has its energy to `s²/(1 − s²)` of it by velocity Verlet,
/// all others nearer: kinetic plus potential energy of `v² + ω² x² (1 − s²)`, which the method keeps, with ω dt = 2 s.
pub const SAFETY: f64 = 0.1;
pub const SHARE: f64 = SAFETY * SAFETY / (1.0 - SAFETY * SAFETY);

/// Steps of a run at most.
const MOST: u64 = 4000;

impl Case {
    /// A body in motion, without anything else.
    pub fn deck(&self) -> Deck {
        let place = &self.law.place;
        Deck {
            top: format!("{}family = \"{}\"\n", place.top, self.family),
            body: place.body.to_string(),
            material: format!("{}, {}", place.density, self.law()),
            fracture: self.law.fracture.map(str::to_string),
            tables: String::new(),
            run: format!("[run]\nsteps = 10\ntime_step = {{ safety = {SAFETY} }}\n"),
        }
    }

    pub fn law(&self) -> String {
        format!("law = {{ {} = {{ {} }} }}", self.law.name, self.law.keys)
    }

    /// Initial velocities that pull: so much of the strain of the law is there where waves from the ends have not come by [`Case::time`].
    pub fn pull(&self, part: f64) -> String {
        let rate = part * self.rate();
        let middle = 0.5 * self.law.place.length;
        format!("[[initial]]\nvelocity = {{ x = \"{rate:e}*(x - {middle})\" }}\n")
    }

    /// Rate of strain of a full pull.
    pub fn rate(&self) -> f64 {
        self.law.strain / self.time()
    }

    /// Critical stretch that the load passes.
    pub fn limit(&self) -> f64 {
        self.law.part * self.law.strain
    }

    pub fn time(&self) -> f64 {
        3.0 * self.law.place.time
    }

    /// Sets at the ends, which are held in all axes, the right one so far along x.
    pub fn grips(&self, stage: &str, right: &str) -> String {
        let length = self.law.place.length;
        let across = ["", ", y = 0", ", y = 0, z = 0"][self.law.place.dimension - 1];
        format!(
            "[sets.left]\nwhere = \"x < {0}\"\n[sets.right]\nwhere = \"x > {1}\"\n\
             [[boundary_condition]]\nset = \"left\"\n{stage}displacement = {{ x = 0{across} }}\n\
             [[boundary_condition]]\nset = \"right\"\n{stage}displacement = {{ x = \"{right}\"{across} }}\n\
             [[probe]]\nname = \"left\"\nset = \"left\"\nmeasure = \"reaction\"\n\
             [[probe]]\nname = \"right\"\nset = \"right\"\nmeasure = \"reaction\"\n",
            0.15 * length,
            0.85 * length
        )
    }

    /// Energy that breaking bonds may miss: what they held is known to a step, in which stretches of the limit grow by `rate dt`.
    pub fn jump(&self, sim: &dyn Simulation) -> f64 {
        2.0 * self.rate() * sim.info().time_step / self.limit()
    }
}

impl Deck {
    fn text(&self) -> String {
        let Deck { top, body, .. } = self;
        let mut text = top.clone();
        if !body.is_empty() {
            text += &format!("body = {{ {body} }}\n");
        }
        if !top.contains("contact = ") {
            text += "contact = false\n";
        }
        if !self.material.is_empty() {
            let fracture = self.fracture();
            text += &format!("material = {{ {}{fracture} }}\n", self.material);
        }
        text + &self.tables + &self.run
    }

    /// As a key of a material, with a comma before it.
    pub fn fracture(&self) -> String {
        let of = |fracture: &String| format!(", fracture = {{ {fracture} }}");
        self.fracture.as_ref().map_or(String::new(), of)
    }

    /// # Errors
    /// Why there is no such model.
    pub fn model(&self) -> Result<Box<dyn Simulation>, Stop> {
        // files are those beside the good decks
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/table.toml");
        let deck = Read::parse(&self.text(), file.to_str().unwrap(), &[])
            .map_err(|e| Stop::Refused(e.message))?;
        build(&deck.spec, Options::default()).map_err(|e| Stop::Refused(deck.explain(&e).message))
    }
}

/// What a motion must keep beside its energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keeps {
    Momentum,
    /// It is held, or damped.
    Nothing,
}

/// `Σ m v`, and `Σ m |v|`.
pub fn momentum(sim: &mut dyn Simulation, of: Option<&[u32]>) -> ([f64; 3], f64) {
    let (density, volume) = (sim.scalars("density"), sim.scalars("volume"));
    let velocity = sim.velocities();
    let all: Vec<u32> = (0..velocity.len() as u32).collect();
    let (mut sum, mut size) = ([0.0; 3], 0.0);
    for i in of.unwrap_or(&all).iter().map(|i| *i as usize) {
        let mass = density[i] * volume[i];
        for (sum, v) in sum.iter_mut().zip(velocity[i]) {
            *sum += mass * v;
            size += mass * v.abs();
        }
    }
    (sum, size)
}

/// Starts the model and moves it up to that time. Momentum stays; the energy balance holds to a share of the largest energy that came and went, and of
/// what bonds that broke held.
///
/// # Errors
/// What does not hold.
pub fn go(sim: &mut dyn Simulation, time: f64, keeps: Keeps, [share, jump]: [f64; 2]) -> Answer {
    sim.start(true);
    let (before, _) = momentum(sim, None);
    let first = sim.ledger().map_err(wrong)?;
    let (mut last, mut scale, mut size, mut steps) = (first, 0.0f64, 0.0f64, 0);
    while sim.clock() < time && steps < MOST {
        sim.step().map_err(wrong)?;
        last = sim.ledger().map_err(wrong)?;
        scale = scale.max(moved(&first, &last));
        size = size.max(momentum(sim, None).1);
        steps += 1;
    }
    hold(sim.clock() >= time, || {
        format!("is at {} of {time} after {steps} steps", sim.clock())
    })?;
    finite(sim)?;
    let (after, _) = momentum(sim, None);
    let off = (0..3).fold(0.0f64, |m, a| m.max((after[a] - before[a]).abs()));
    hold(keeps == Keeps::Nothing || off <= 1e-11 * size, || {
        format!("momentum is off by {off:e} of {size:e}")
    })?;
    // infinite: it is not asked for
    match share.is_finite() {
        true => balanced(&last, share * scale + jump * (last.released + last.made)),
        false => Ok(()),
    }
}

/// Energy that has come and gone.
pub fn moved(first: &Ledger, l: &Ledger) -> f64 {
    let stored = (l.strain - first.strain).abs() + l.kinetic + l.contact;
    stored + l.released + l.dissipated.abs() + l.work_boundary_conditions.abs()
}

pub fn balanced(l: &Ledger, bound: f64) -> Answer {
    let off = l.residual().abs();
    // of nothing, round-off
    hold(off <= bound + 1e-15, || {
        format!("the energy balance error is {off:e}, bound {bound:e}: {l:?}")
    })
}

/// Are all numbers of points finite?
pub fn finite(sim: &mut dyn Simulation) -> Answer {
    for name in ["displacement", "velocity", "force_density"] {
        let all = sim.vectors(name);
        let bad = all.iter().flatten().filter(|x| !x.is_finite()).count();
        hold(bad == 0, || {
            format!("{bad} numbers of {name} are not finite")
        })?;
    }
    Ok(())
}

/// All increments of an equilibrium; forces of its supports cancel, and are there. Answers that of the right grip along x.
///
/// # Errors
/// What does not hold: reactions to 1e-5, which is above every tolerance of equilibrium that is asked for; the balance to `share` of what came and went.
pub fn settle(
    case: &Case,
    sim: &mut dyn Simulation,
    increments: usize,
    share: f64,
) -> Result<f64, Stop> {
    sim.start(true);
    let first = sim.ledger().map_err(wrong)?;
    let mut scale = 0.0f64;
    let mut last = first;
    for _ in 0..increments {
        sim.step().map_err(wrong)?;
        last = sim.ledger().map_err(wrong)?;
        scale = scale.max(moved(&first, &last));
    }
    finite(sim)?;
    let reactions = sim.measure();
    let d = case.law.place.dimension;
    let right = reactions[d];
    for a in 0..d {
        let off = (reactions[a] + reactions[d + a]).abs();
        hold(off <= 1e-5 * right.abs(), || {
            format!("supports miss {off:e} along axis {a}: {reactions:?}")
        })?;
    }
    hold(right != 0.0, || "supports bear nothing".into())?;
    if case.law.calm {
        balanced(&last, share * scale)?;
    }
    Ok(right)
}

/// Displacements without order, so small.
pub fn stirred(sim: &mut dyn Simulation, d: usize, size: f64) -> Vec<[f64; 3]> {
    let part = |k: usize, a: usize| ((k + 1) as f64 * [0.618_034, 0.414_214, 0.732_051][a]).fract();
    let one = |k| {
        std::array::from_fn(|a| {
            if a < d {
                size * (part(k, a) - 0.5)
            } else {
                0.0
            }
        })
    };
    (0..sim.info().points as usize).map(one).collect()
}

pub fn largest(all: &[[f64; 3]]) -> f64 {
    all.as_flattened().iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Largest difference over the largest of the first, each times its factor.
pub fn apart(a: &[[f64; 3]], by: f64, b: &[[f64; 3]]) -> f64 {
    let each = a.as_flattened().iter().zip(b.as_flattened());
    each.fold(0.0, |m: f64, (a, b)| m.max((by * a - b).abs())) / (by * largest(a)).abs()
}
