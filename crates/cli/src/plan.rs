//! `peridyne plan`: how long a deck takes on many machines, what each holds, and how well they share it, before anybody queues for them.

use crate::Input;
use crate::deck::{read, simd};
use crate::failure::{Failure, say};
use crate::numbers::{duration, memory};
use crate::run::with_threads;
use peridyne::run::ranks::{Shares, StepCost, plan as planned};
use peridyne::run::{Info, Options};
use peridyne_io::deck::{counted, each_once};
use serde_json::json;
use std::fmt::Write;

#[derive(clap::Args)]
pub struct PlanArguments {
    #[command(flatten)]
    pub input: Input,
    /// Numbers of machines, each with one rank.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_values_t = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024])]
    pub nodes: Vec<usize>,
    /// Cores of a machine, each as fast as those here; as many as ran here if not given.
    #[arg(long)]
    pub cores: Option<usize>,
    /// Time of a message between two machines (microseconds).
    #[arg(long, default_value_t = 3.0)]
    pub latency: f64,
    /// Bytes that go from one machine to another (GB/s).
    #[arg(long, default_value_t = 25.0)]
    pub bandwidth: f64,
    /// Steps that are done here to see what one costs.
    #[arg(long, default_value_t = 20)]
    pub steps: usize,
    /// Threads here; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
    /// As JSON.
    #[arg(long)]
    pub json: bool,
}

/// A network between machines.
#[derive(Clone, Copy)]
struct Network {
    /// Seconds.
    latency: f64,
    /// Bytes per second.
    bandwidth: f64,
}

/// Seconds of a step of ranks that share a body so, whose points take so long each: work of the one that has most, what it tells its neighbours as far as that
/// takes longer than what it does meanwhile, then what all hear of all, in `⌈log₂ N⌉` exchanges of two messages.
fn step(shares: &Shares, per_point: f64, cost: &StepCost, network: Network) -> f64 {
    let (points, copies) = (shares.points as f64, shares.copies as f64);
    let during = &cost.meanwhile;
    let told = |messages: f64, bytes: f64| {
        let neighbours = shares.neighbours() as f64;
        messages * neighbours * network.latency + bytes * copies / network.bandwidth
    };
    let ahead = told(during.messages, during.bytes_per_copy);
    let rest = told(
        cost.messages - during.messages,
        cost.bytes_per_copy - during.bytes_per_copy,
    );
    // as many points have partners elsewhere as there are copies of others'
    let inside = during.part * per_point * (points - copies).max(0.0);
    let deep = libm::log2(shares.ranks as f64).ceil();
    let rounds = cost.rounds * 2.0 * deep * network.latency;
    per_point * points + (ahead - inside).max(0.0) + rest + rounds
}

/// Of a step.
fn brief(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.1} µs", 1e6 * s),
        s if s < 1.0 => format!("{:.2} ms", 1e3 * s),
        s => duration(s),
    }
}

/// A number of machines, and what a step takes there.
struct Row {
    shares: Shares,
    seconds: f64,
    efficiency: f64,
    /// Bytes that a machine holds.
    held: f64,
}

/// What was measured and foreseen.
struct Plan {
    info: Info,
    cost: StepCost,
    steps: u64,
    threads: usize,
    cores: usize,
    /// Of two ranks of one thread each, without what they tell each other.
    foreseen: f64,
    rows: Vec<Row>,
}

impl Plan {
    fn of(
        arguments: &PlanArguments,
        (info, cost, shares): (Info, StepCost, Vec<Shares>),
        (steps, threads): (u64, usize),
    ) -> Plan {
        let cores = arguments.cores.unwrap_or(threads);
        let network = Network {
            latency: 1e-6 * arguments.latency,
            bandwidth: 1e9 * arguments.bandwidth,
        };
        let points = info.points as f64;
        let of_core = cost.seconds * threads as f64;
        let one = of_core / cores as f64;
        let per_slot = info.bytes as f64 / points;
        let row = |shares: Shares| {
            let seconds = step(&shares, one / points, &cost, network);
            Row {
                seconds,
                efficiency: one / (shares.ranks as f64 * seconds),
                held: per_slot * (shares.points + shares.copies) as f64,
                shares,
            }
        };
        Plan {
            rows: shares.into_iter().map(row).collect(),
            foreseen: 0.5 * of_core,
            info,
            cost,
            steps,
            threads,
            cores,
        }
    }

    fn json(&self) -> serde_json::Value {
        let rows = self.rows.iter().map(|row| {
            let s = &row.shares;
            json!({
                "nodes": s.ranks, "idle": s.ranks - s.working, "points": s.points, "copies": s.copies, "neighbours": s.neighbours(), "bytes": row.held,
                "seconds_per_step": row.seconds, "efficiency": row.efficiency, "seconds": row.seconds * self.steps as f64,
            })
        });
        let cost = &self.cost;
        json!({
            "points": self.info.points, "bonds": each_once(self.info.directed_bonds), "steps": self.steps, "threads": self.threads, "cores": self.cores,
            "seconds_per_step": cost.seconds, "messages": cost.messages, "bytes_per_copy": cost.bytes_per_copy, "rounds": cost.rounds,
            "meanwhile": { "messages": cost.meanwhile.messages, "bytes_per_copy": cost.meanwhile.bytes_per_copy, "part": cost.meanwhile.part },
            "two_ranks": { "seconds_per_step": cost.seconds_of_two, "foreseen": self.foreseen },
            "nodes": rows.collect::<Vec<_>>(),
        })
    }

    fn text(&self, arguments: &PlanArguments) -> String {
        let cost = &self.cost;
        let per_bond = 1e9 * cost.seconds / self.info.directed_bonds as f64;
        let mut text = format!(
            "step      {} here on {}, {per_bond:.2} ns per bond; two ranks of one thread {}, foreseen {}\n",
            brief(cost.seconds),
            counted(self.threads as u64, "thread"),
            brief(cost.seconds_of_two),
            brief(self.foreseen),
        );
        let _ = writeln!(
            text,
            "tells     each neighbour {:.1} messages, {:.0} bytes per copy, of which {:.1} and {:.0} while it works; all hear of all {:.1} times",
            cost.messages,
            cost.bytes_per_copy,
            cost.meanwhile.messages,
            cost.meanwhile.bytes_per_copy,
            cost.rounds
        );
        let _ = writeln!(
            text,
            "machines  of {}, {} µs and {} GB/s between them\n",
            counted(self.cores as u64, "core"),
            arguments.latency,
            arguments.bandwidth
        );
        let _ = write!(
            text,
            "{:>6} {:>12} {:>10} {:>10} {:>10} {:>11} {:>10}",
            "nodes", "points", "copies", "memory", "step", "efficiency", "run"
        );
        for row in &self.rows {
            let s = &row.shares;
            let idle = match s.ranks - s.working {
                0 => String::new(),
                idle => format!("  {idle} idle"),
            };
            let _ = write!(
                text,
                "\n{:>6} {:>12} {:>10} {:>10} {:>10} {:>10.1}% {:>10}{idle}",
                s.ranks,
                s.points,
                s.copies,
                memory(row.held),
                brief(row.seconds),
                100.0 * row.efficiency,
                duration(row.seconds * self.steps as f64),
            );
        }
        text
    }
}

pub fn plan(arguments: &PlanArguments) -> Result<(), Failure> {
    let wrong = [
        (
            arguments.nodes.contains(&0) || arguments.nodes.is_empty(),
            "--nodes: at least one machine runs it",
        ),
        (
            arguments.cores == Some(0),
            "--cores: a machine has one core at least",
        ),
        (
            !(arguments.latency >= 0.0),
            "--latency: expected microseconds, 0 or more",
        ),
        (
            !(arguments.bandwidth > 0.0),
            "--bandwidth: expected GB/s, more than 0",
        ),
        (
            arguments.steps == 0,
            "--steps: one step at least shows what it costs",
        ),
    ];
    if let Some((_, why)) = wrong.into_iter().find(|(wrong, _)| *wrong) {
        return Err(Failure::input(why));
    }
    let deck = read(&arguments.input)?;
    let options = Options {
        simd: simd(&arguments.input)?,
        ..Options::default()
    };
    with_threads(arguments.threads.or(deck.threads), |threads| {
        let made = planned(&deck.spec, options, arguments.steps, &arguments.nodes);
        let made = made.map_err(|e| Failure::Input(deck.explain(&e).into()))?;
        let steps = deck.steps(made.0.time_step);
        let plan = Plan::of(arguments, made, (steps, threads));
        say(&match arguments.json {
            true => format!("{:#}", plan.json()),
            false => plan.text(arguments),
        });
        Ok(())
    })
}
