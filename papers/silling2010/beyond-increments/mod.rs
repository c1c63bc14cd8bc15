//! Increments of a nonlinear body (section 7): how far a coarse sheet of rubber is from that of all points, and how the error falls.

use peridyne::run::{Options as Build, Simulation, build};
use peridyne::spec::LinearBody;
use peridyne_io::deck::Deck;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::increments::{
    Increment, Increments, Linear, Model, Plan, Removed, alone,
};
use peridyne_theory::coarsen::{Options, Radius, Scheme, Selection};

use crate::silling2010::compare::failed;
use crate::{Context, Failure, Findings};

experiment!(
    BeyondIncrements,
    "beyond-increments",
    "A sheet of rubber in increments",
    ["../compare.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");

fn model(deck: &Deck) -> Result<Model<2>, Failure> {
    let options = Build {
        trust_time_step: true,
        ..Build::default()
    };
    let sim = build(&alone(&deck.spec), options).map_err(failed)?;
    Model::new(&deck.spec, sim, false).ok_or_else(|| Failure::new("the deck is not a sheet"))
}

/// Every second point along both axes, and all that are held.
fn retained(model: &Model<2>) -> Result<Vec<u32>, Failure> {
    let among = LinearBody {
        position: model.sites().to_vec(),
        ..LinearBody::nothing()
    };
    let mut chosen = Selection::every(2).choose(&among).map_err(failed)?;
    for support in model.supports() {
        chosen.extend(&support.points);
    }
    chosen.sort_unstable();
    chosen.dedup();
    Ok(chosen)
}

/// Displacements and reactions of all points, by Newton's method.
struct Truth {
    u: Vec<[f64; 2]>,
    pull: f64,
}

impl Truth {
    fn of(deck: &Deck, model: &mut Model<2>) -> Result<Truth, Failure> {
        let mut sim: Box<dyn Simulation> = build(&deck.spec, Build::default()).map_err(failed)?;
        sim.start(true);
        for _ in 0..deck.spec.run.schedule.steps {
            sim.step().map_err(failed)?;
        }
        let all = model.reactions_of(sim.as_mut(), 1.0);
        let u = sim.displacements().iter().map(|u| [u[0], u[1]]).collect();
        Ok(Truth { u, pull: all[1][0] })
    }
}

/// Errors (%): displacements of retained and of removed points over the largest, and the pull.
#[derive(Clone, Copy)]
struct Off([f64; 3]);

impl Off {
    fn of(truth: &Truth, u: &[[f64; 2]], kept: &[u32], pull: f64) -> Off {
        let size = |x: [f64; 2]| x[0].hypot(x[1]);
        let most = truth.u.iter().map(|u| size(*u)).fold(0.0, f64::max);
        let mut off = [0.0, 0.0, 100.0 * (pull / truth.pull - 1.0).abs()];
        for (i, (u, v)) in (0..).zip(u.iter().zip(&truth.u)) {
            let kind = usize::from(kept.binary_search(&i).is_err());
            off[kind] = f64::max(off[kind], 100.0 * size([u[0] - v[0], u[1] - v[1]]) / most);
        }
        Off(off)
    }

    fn told(self) -> String {
        let [kept, removed, pull] = self.0;
        format!("{kept:.2e}, {removed:.2e}, {pull:.2e} %")
    }

    fn below(self, bound: f64) -> bool {
        self.0.iter().all(|x| *x < bound)
    }
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let deck = Deck::parse(DECK, "deck.toml", &[]).map_err(failed)?;
    let mut first = model(&deck)?;
    let kept = retained(&first)?;
    let truth = Truth::of(&deck, &mut first)?;
    let balls = Options {
        radius: Radius::Tolerance(0.01),
        ..Options::default()
    };
    let exact = Options {
        scheme: Scheme::Schur,
        ..Options::default()
    };
    let plan = |options, corrections, removed| Plan {
        levels: vec![(kept.clone(), options)],
        corrections,
        tolerance: 1e-10,
        removed,
    };
    let pull = |model: &Model<2>, done: &Increment<2>| model.reactions(&kept, &done.reaction)[1][0];
    let go = |plan: Plan, increments: usize| -> Result<Off, Failure> {
        let mut model = model(&deck)?;
        let begin = model.begin();
        let mut way = Increments::new(&mut model, plan, begin);
        let mut last = f64::NAN;
        for n in 1..=increments {
            let load = model.load(n as f64 / increments as f64);
            let done = way.step(&mut model, &load).map_err(failed)?;
            last = pull(&model, &done);
        }
        Ok(Off::of(&truth, way.displacements(), &kept, last))
    };

    // all at once, linear about the reference
    let begin = first.begin();
    let load = first.load(1.0);
    let mut linear = Linear::of(&mut first, &begin);
    let once = plan(balls, 0, Removed::KinematicPoints);
    let mut way = Increments::new(&mut linear, once, begin);
    let done = way.step(&mut linear, &load).map_err(failed)?;
    let plain = Off::of(&truth, way.displacements(), &kept, pull(&first, &done));
    found.holds(
        "linear",
        plain.told(),
        plain.0[0].max(plain.0[1]) > 1.0 && plain.0[2] > 5.0,
    );

    let counts: &[usize] = match context.small {
        true => &[5, 10],
        false => &[5, 10, 20, 40],
    };
    let ways = [
        ("balls, carried", balls, 0, Removed::KinematicPoints),
        (
            "exact, carried, corrected",
            exact,
            20,
            Removed::KinematicPoints,
        ),
        ("exact, relaxed", exact, 0, Removed::Relaxed),
    ];
    let mut table = Table::new().column("increments", "", counts.iter().map(|n| *n as f64));
    let mut plot = Plot::new("A sheet of rubber in increments, every second point")
        .x("increments", "")
        .y("largest error of displacement", "%");
    let mut all = vec![];
    for (name, options, corrections, removed) in ways {
        let mut each = vec![];
        for n in counts {
            context.say(&format!("{name}, {n} increments"));
            each.push(go(plan(options, corrections, removed), *n)?);
        }
        for (k, what) in ["retained", "removed", "pull"].into_iter().enumerate() {
            let values: Vec<f64> = each.iter().map(|off| off.0[k]).collect();
            table = table.column(&format!("{name}, {what}"), "%", values.iter().copied());
            if k < 2 {
                let x: Vec<f64> = counts.iter().map(|n| *n as f64).collect();
                plot = plot.line(&format!("{name}, {what}"), &x, &values);
            }
        }
        all.push(each);
    }
    found.picture(plot.save(&context.out, "errors")?);
    let path = context.out.join("errors.csv");
    table.save(&path)?;
    found.file(path);

    let ten = all[0][1];
    found.holds("ten", ten.told(), ten.below(1.0));
    let order = |each: &[Off], k: usize| {
        let [coarse, fine] = [each[each.len() - 2], each[each.len() - 1]];
        (coarse.0[k] / fine.0[k]).log2()
    };
    let carried = order(&all[1], 1);
    found.holds(
        "first-order",
        format!("{carried:.2}"),
        (carried - 1.0).abs() < 0.25,
    );
    let relaxed = [0, 1].map(|k| order(&all[2], k));
    found.holds(
        "second-order",
        format!("{:.2}, {:.2}", relaxed[0], relaxed[1]),
        relaxed.iter().all(|o| (o - 2.0).abs() < 0.35),
    );
    let corrected = go(plan(balls, 20, Removed::KinematicPoints), 10)?;
    found.holds("corrected", corrected.told(), corrected.below(1.0));
    let newton = go(plan(balls, 60, Removed::Relaxed), 2)?;
    found.holds("newton", newton.told(), newton.below(1e-5));
    Ok(found)
}
