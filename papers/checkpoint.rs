//! Long runs in parts: after each part the state is kept, and a run that was cut off goes on from there, bit for bit. States are those of
//! `peridyne resume` ([`peridyne_io::write::checkpoint`]), in the folder `.parts/NAME`.

use std::path::Path;
use std::time::Instant;

use peridyne::run::Simulation;
use peridyne::state::{Archive, Owner, words};
use peridyne_io::write::checkpoint::{Asked, Checkpoint, CheckpointSchedule, Checkpoints};

use crate::experiment::{Context, Failure};
use crate::measure::{change, stepper_energy};

/// How a run is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    pub steps: u64,
    /// Steps between rows of energies.
    pub row: u64,
    /// Steps after which the state is kept; 0: never.
    pub part: u64,
}

/// Energies of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    pub step: u64,
    pub kinetic: f64,
    pub strain: f64,
    /// That of [`stepper_energy`].
    pub scheme: f64,
}

words!([] Row { step: u64, kinetic: f64, strain: f64, scheme: f64 });

impl Row {
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain
    }
}

/// What is known of a run beside its state.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    pub rows: Vec<Row>,
    /// Time spent in steps alone, over all parts.
    pub seconds: f64,
}

impl Owner for Record {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.list("rows", &mut self.rows);
        archive.one("seconds", &mut self.seconds);
    }
}

impl Record {
    /// Largest relative change of the energy.
    pub fn drift(&self) -> f64 {
        change(self.rows.iter().map(Row::total))
    }

    /// The same of what the time stepper conserves where forces are linear.
    pub fn invariant_drift(&self) -> f64 {
        change(self.rows.iter().map(|r| r.total() - r.scheme))
    }

    /// Nanoseconds of a directed bond in a step.
    pub fn ns(&self, bonds: u64, steps: u64) -> f64 {
        1e9 * self.seconds / (bonds as f64 * steps as f64)
    }
}

/// Runs a model to its end, from the last state that was kept of the same inputs.
///
/// # Errors
/// Those of the run; a state cannot be written.
pub fn run(
    context: &Context,
    name: &str,
    sim: &mut dyn Simulation,
    plan: Plan,
) -> Result<Record, Failure> {
    let folder = context.out.join(".parts").join(name);
    let mut record = Record::default();
    let of = identity(&context.inputs, sim);
    let state = kept(&folder, &of);
    let goes_on = state.is_some();
    match state {
        Some(mut state) => {
            state
                .load(|archive| pass(sim, &mut record, archive))
                .map_err(|e| Failure::new(format!("{e}; remove {}", folder.display())))?;
            context.say(&format!("{name}: goes on at step {}", sim.step_number()));
        }
        None => {
            sim.start(true);
            record.rows.push(row(sim)?);
        }
    }
    // they are large
    let schedule = CheckpointSchedule {
        keep: 1,
        ..CheckpointSchedule::default()
    };
    let mut states = Checkpoints::new(&folder, Some(schedule), goes_on)?;
    while sim.step_number() < plan.steps {
        let begin = Instant::now();
        sim.step().map_err(|e| Failure::new(e.to_string()))?;
        record.seconds += begin.elapsed().as_secs_f64();
        let step = sim.step_number();
        if step.is_multiple_of(plan.row) || step == plan.steps {
            record.rows.push(row(sim)?);
        }
        if plan.part > 0 && (step.is_multiple_of(plan.part) || step == plan.steps) {
            let mut asked = Asked {
                version: env!("CARGO_PKG_VERSION").into(),
                name: name.into(),
                text: of.clone(),
                step,
                steps: plan.steps,
                ..Asked::default()
            };
            states.write(&mut asked, |archive| pass(sim, &mut record, archive))?;
            context.say(&format!(
                "{name}: step {step} of {}, {:.0} s",
                plan.steps, record.seconds
            ));
        }
    }
    Ok(record)
}

/// What tells runs of one name apart: their inputs, points and time step.
fn identity(inputs: &str, sim: &dyn Simulation) -> String {
    let info = sim.info();
    let (points, step) = (info.points, info.time_step.to_bits());
    format!("{inputs} {} {points} {step:016x}", info.dimension)
}

/// The last state of such a run; one that cannot be read, or of another, is as none.
fn kept(folder: &Path, of: &str) -> Option<Checkpoint> {
    let state = Checkpoint::newest(folder).ok()?;
    (state.asked.text == of).then_some(state)
}

fn pass(sim: &mut dyn Simulation, record: &mut Record, archive: &mut Archive<'_>) {
    archive.part("model", sim);
    archive.part("record", record);
}

fn row(sim: &mut dyn Simulation) -> Result<Row, Failure> {
    let ledger = sim.ledger().map_err(|e| Failure::new(e.to_string()))?;
    Ok(Row {
        step: sim.step_number(),
        kinetic: ledger.kinetic,
        strain: ledger.strain,
        scheme: stepper_energy(sim),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::run::{Options, build};
    use peridyne_io::deck::Deck;

    const DECK: &str = r#"
horizon = { m_ratio = 3 }
influence = "inverse"
contact = false
body = { lattice = "square", spacing = 1, region = { block = { low = [0, 0], high = [11, 9] } } }
material = { density = 1, law = { eam_like = { pair = 2, volume = 0.7 } } }
initial = [{ displacement = ["0.1*exp(-((x-5)^2+(y-4)^2)/4)", "0.02*x"] }]
run = { steps = 60, time_step = { safety = 0.7 } }
"#;

    fn context(out: &Path, inputs: &str) -> Context<'static> {
        Context {
            out: out.to_path_buf(),
            small: true,
            threads: 1,
            inputs: inputs.into(),
            progress: &|_| {},
        }
    }

    fn sim() -> Box<dyn Simulation> {
        let deck = Deck::parse(DECK, "test.toml", &[]).unwrap();
        build(&deck.spec, Options::default()).unwrap()
    }

    fn plan(steps: u64, part: u64) -> Plan {
        Plan {
            steps,
            row: 7,
            part,
        }
    }

    fn bits(sim: &mut dyn Simulation) -> Vec<u64> {
        let (u, v) = (sim.displacements(), sim.velocities());
        u.iter().chain(&v).flatten().map(|x| x.to_bits()).collect()
    }

    #[test]
    fn a_run_in_parts_is_the_run_bit_for_bit() {
        let dir = tempfile::tempdir().unwrap();
        let mut whole = sim();
        let record = run(
            &context(dir.path(), "a"),
            "whole",
            whole.as_mut(),
            plan(60, 0),
        )
        .unwrap();
        assert!(!dir.path().join(".parts").exists());
        // cut off after 20 and 45 steps: a new model each time
        for steps in [20, 45, 60] {
            let mut part = sim();
            let context = context(dir.path(), "a");
            let found = run(&context, "cut", part.as_mut(), plan(steps, 10)).unwrap();
            assert_eq!(part.step_number(), steps);
            if steps == 60 {
                assert_eq!(bits(part.as_mut()), bits(whole.as_mut()));
                let regular: Vec<_> = found.rows.iter().filter(|r| r.step % 7 == 0).collect();
                assert!(record.rows.iter().filter(|r| r.step % 7 == 0).eq(regular));
                assert!(found.seconds > 0.0);
            }
        }
    }

    #[test]
    fn a_state_of_other_inputs_or_of_another_model_is_as_none() {
        let dir = tempfile::tempdir().unwrap();
        run(&context(dir.path(), "a"), "p", sim().as_mut(), plan(10, 10)).unwrap();
        let folder = dir.path().join(".parts/p");
        let there = |inputs: &str, sim: &dyn Simulation| {
            kept(&folder, &identity(inputs, sim)).map(|state| state.asked.step)
        };
        let mut other = sim();
        other.set_time_step(0.01);
        assert_eq!(there("a", sim().as_ref()), Some(10));
        assert_eq!(there("b", sim().as_ref()), None);
        assert_eq!(there("a", other.as_ref()), None);
        // that run begins anew, and its states take the place of the others
        let record = run(&context(dir.path(), "a"), "p", other.as_mut(), plan(7, 7)).unwrap();
        assert_eq!((record.rows[0].step, record.rows.len()), (0, 2));
        assert_eq!(there("a", other.as_ref()), Some(7));
        assert_eq!(there("a", sim().as_ref()), None);
    }
}
