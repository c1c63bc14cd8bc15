//! Table 4.1: steps and costs of the molecular dynamics and of the coarse peridynamics of Fig. 4.3.

use peridyne::spec::Horizon;
use peridyne_io::write::table::Table;

use super::chain::Chain;
use super::deck;
use super::runs::SAFETY;
use crate::{Context, Failure, Findings};

experiment!(
    Table41,
    "table-4-1",
    "Cost of molecular dynamics and of peridynamics",
    [
        "../chain.rs",
        "../deck.rs",
        "../runs.rs",
        "../figure-4-3/deck.toml"
    ]
);

const DECK: &str = include_str!("../figure-4-3/deck.toml");
/// End of the runs: what the printed numbers of steps imply.
const END: f64 = 300.0;

fn run(context: &Context) -> Result<Findings, Failure> {
    let models = [
        ("MD", in_deck("md")?),
        ("PD (coarse)", in_deck("pd-coarse")?),
    ];
    let steps = models.map(|(_, c)| c.steps(SAFETY, END));
    let cost = |k: usize| {
        let c = models[k].1;
        f64::from(c.points) * f64::from(c.neighbours) * f64::from(steps[k])
    };
    let relative = [cost(0) / cost(0), cost(1) / cost(0)];

    let path = context.out.join("costs.csv");
    let column = |f: &dyn Fn(&Chain) -> f64| models.map(|(_, c)| f(&c));
    Table::new()
        .text("model", models.map(|(name, _)| name))
        .column("Nx", "", column(&|c| f64::from(c.points)))
        .column("N", "", column(&|c| f64::from(c.neighbours)))
        .column("spacing", "", column(&|c| c.spacing))
        .column("time step", "", column(&|c| c.time_step(SAFETY)))
        .column("Nt", "", steps.map(f64::from))
        .column("Nx N Nt", "", [cost(0), cost(1)])
        .column("relative cost", "", relative)
        .save(&path)?;

    let mut found = Findings::new();
    found.number("steps-md", f64::from(steps[0]));
    found.number("steps-pd", f64::from(steps[1]));
    found.number("cost-pd", relative[1]);
    found.file(path);
    Ok(found)
}

/// The chain of a run of Fig. 4.3.
fn in_deck(run: &str) -> Result<Chain, Failure> {
    let deck = deck::deck(DECK, run, &[])?;
    let Horizon::Ratio(neighbours) = deck.spec.bonds.horizon else {
        return Err(Failure::new(format!("{run}: write the horizon as m_ratio")));
    };
    let info = deck::model(&deck)?.info().clone();
    Ok(Chain {
        spacing: info.spacing,
        ..Chain::thousand(info.points as u32, neighbours)
    })
}
