//! Table 4.1: steps and costs of the molecular dynamics and of the coarse peridynamics of Fig. 4.3.

use peridyne_io::write::table::Table;

use super::chain::Chain;
use crate::{Context, Experiment, Failure, Findings};

/// Safety factor of (4.13).
const SAFETY: f64 = 0.85;
/// End of the runs: what the printed numbers of steps imply.
const END: f64 = 300.0;

pub struct Table41;

impl Experiment for Table41 {
    fn key(&self) -> &'static str {
        "seleson2009"
    }

    fn figure(&self) -> &'static str {
        "table-4-1"
    }

    fn title(&self) -> &'static str {
        "Cost of molecular dynamics and of peridynamics"
    }

    fn claims(&self) -> &'static str {
        include_str!("claims.toml")
    }

    fn readme(&self) -> &'static str {
        include_str!("README.md")
    }

    fn sources(&self) -> &'static [&'static str] {
        &[include_str!("mod.rs"), include_str!("../chain.rs")]
    }

    fn run(&self, context: &Context) -> Result<Findings, Failure> {
        let models = [
            ("MD", Chain::thousand(4001, 20)),
            ("PD (coarse)", Chain::thousand(2001, 10)),
        ];
        let steps = models.map(|(_, c)| c.steps(SAFETY, END));
        let cost = |k: usize| {
            let c = models[k].1;
            f64::from(c.points) * f64::from(c.neighbours) * f64::from(steps[k])
        };
        let relative = [cost(0) / cost(0), cost(1) / cost(0)];
        let horizons = models.map(|(_, c)| f64::from(c.neighbours) * c.spacing);

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
        found.number("cost-md", relative[0]);
        found.number("cost-pd", relative[1]);
        found.holds(
            "same-horizon",
            format!("N Δx = {} and {}", horizons[0], horizons[1]),
            horizons == [5.0, 5.0],
        );
        found.file(path);
        Ok(found)
    }
}
