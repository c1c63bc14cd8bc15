//! Long runs in parts: after each part the state is kept, and a run that was cut off goes on from there, bit for bit.
//!
//! A state is `.parts/NAME.state`, little-endian: the eight bytes `pdynpart`, version and dimension (u32), points and step
//! (u64), time step and seconds spent (f64), the hash of the inputs (length as u32, text), rows of energies (number as u64;
//! step, kinetic, strain, scheme), all displacements, then all velocities, one axis after the other (f64), and the CRC-32 of
//! everything before it. It is written whole or not at all.

use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use crc32fast::Hasher;
use peridyne::run::Simulation;
use peridyne_io::write::atomic::{create_directory, write_file};

use crate::experiment::{Context, Failure};
use crate::measure::{change, stepper_energy};

const MAGIC: &[u8; 8] = b"pdynpart";
const VERSION: u32 = 2;
/// Points that are read or written at once.
const BLOCK: usize = 8192;

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
    let folder = context.out.join(".parts");
    let path = folder.join(format!("{name}.state"));
    let mut record = Record::default();
    // a state that cannot be read, or of other inputs, is as none
    match load(&path, &context.inputs, sim) {
        Ok(kept) => {
            context.say(&format!("{name}: goes on at step {}", sim.step_number()));
            record = kept;
            sim.start(true);
        }
        Err(_) => {
            sim.start(true);
            record.rows.push(row(sim)?);
        }
    }
    while sim.step_number() < plan.steps {
        let begin = Instant::now();
        sim.step().map_err(|e| Failure::new(e.to_string()))?;
        record.seconds += begin.elapsed().as_secs_f64();
        let step = sim.step_number();
        if step.is_multiple_of(plan.row) || step == plan.steps {
            record.rows.push(row(sim)?);
        }
        if plan.part > 0 && (step.is_multiple_of(plan.part) || step == plan.steps) {
            create_directory(&folder)?;
            save(&path, &context.inputs, sim, &record)?;
            context.say(&format!(
                "{name}: step {step} of {}, {:.0} s",
                plan.steps, record.seconds
            ));
        }
    }
    Ok(record)
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

/// Writes or reads, and sums what passes.
struct Summed<T> {
    inner: T,
    sum: Hasher,
}

impl<T> Summed<T> {
    fn new(inner: T) -> Summed<T> {
        Summed {
            inner,
            sum: Hasher::new(),
        }
    }
}

impl<W: Write> Summed<W> {
    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sum.update(bytes);
        self.inner.write_all(bytes)
    }

    fn numbers(&mut self, values: &[f64]) -> io::Result<()> {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.put(&bytes)
    }
}

impl<R: Read> Summed<R> {
    fn get<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.inner.read_exact(&mut bytes)?;
        self.sum.update(&bytes);
        Ok(bytes)
    }

    fn bytes(&mut self, n: usize) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; n];
        self.inner.read_exact(&mut bytes)?;
        self.sum.update(&bytes);
        Ok(bytes)
    }

    fn word(&mut self) -> io::Result<u32> {
        self.get().map(u32::from_le_bytes)
    }

    fn long(&mut self) -> io::Result<u64> {
        self.get().map(u64::from_le_bytes)
    }

    fn number(&mut self) -> io::Result<f64> {
        self.get().map(f64::from_le_bytes)
    }
}

/// Displacements, then velocities, axis by axis.
fn fields(dimension: usize) -> Vec<(&'static str, usize)> {
    let of = |name| (0..dimension).map(move |axis| (name, axis));
    of("displacement").chain(of("velocity")).collect()
}

fn save(
    path: &Path,
    inputs: &str,
    sim: &mut dyn Simulation,
    record: &Record,
) -> Result<(), Failure> {
    let info = sim.info();
    let (dimension, points, dt) = (info.dimension, info.points as usize, info.time_step);
    write_file(path, |w| {
        let mut out = Summed::new(w);
        out.put(MAGIC)?;
        out.put(&VERSION.to_le_bytes())?;
        out.put(&(dimension as u32).to_le_bytes())?;
        out.put(&(points as u64).to_le_bytes())?;
        out.put(&sim.step_number().to_le_bytes())?;
        out.numbers(&[dt, record.seconds])?;
        out.put(&(inputs.len() as u32).to_le_bytes())?;
        out.put(inputs.as_bytes())?;
        out.put(&(record.rows.len() as u64).to_le_bytes())?;
        for row in &record.rows {
            out.put(&row.step.to_le_bytes())?;
            out.numbers(&[row.kinetic, row.strain, row.scheme])?;
        }
        let mut block = vec![0.0; BLOCK];
        for field in fields(dimension) {
            for first in (0..points).step_by(BLOCK) {
                let n = BLOCK.min(points - first);
                sim.read(field.0, field.1, first, &mut block[..n]);
                out.numbers(&block[..n])?;
            }
        }
        let sum = out.sum.finalize();
        out.inner.write_all(&sum.to_le_bytes())
    })?;
    Ok(())
}

fn other(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what.to_string())
}

/// Is the sum at the end that of all before it?
fn check(path: &Path) -> io::Result<()> {
    let file = File::open(path)?;
    let mut left = file
        .metadata()?
        .len()
        .checked_sub(4)
        .ok_or_else(|| other("too short"))?;
    let mut reader = Summed::new(BufReader::new(file));
    while left > 0 {
        let n = left.min(1 << 16);
        reader.bytes(n as usize)?;
        left -= n;
    }
    let sum = std::mem::take(&mut reader.sum).finalize();
    match reader.word()? == sum {
        true => Ok(()),
        false => Err(other("the sum does not fit")),
    }
}

/// Sets the state of a model; on an error the model is as it was.
fn load(path: &PathBuf, inputs: &str, sim: &mut dyn Simulation) -> io::Result<Record> {
    check(path)?;
    let info = sim.info();
    let (dimension, points, dt) = (info.dimension, info.points as usize, info.time_step);
    let mut reader = Summed::new(BufReader::new(File::open(path)?));
    let same = reader.get::<8>()? == *MAGIC
        && reader.word()? == VERSION
        && reader.word()? as usize == dimension
        && reader.long()? as usize == points;
    if !same {
        return Err(other("another body"));
    }
    let step = reader.long()?;
    if reader.number()?.to_bits() != dt.to_bits() {
        return Err(other("another time step"));
    }
    let seconds = reader.number()?;
    let length = reader.word()? as usize;
    if length != inputs.len() || reader.bytes(length)? != inputs.as_bytes() {
        return Err(other("other inputs"));
    }
    let mut rows = vec![];
    for _ in 0..reader.long()? {
        rows.push(Row {
            step: reader.long()?,
            kinetic: reader.number()?,
            strain: reader.number()?,
            scheme: reader.number()?,
        });
    }
    for field in fields(dimension) {
        for first in (0..points).step_by(BLOCK) {
            let n = BLOCK.min(points - first);
            let bytes = reader.bytes(8 * n)?;
            let values: Vec<f64> = bytes
                .as_chunks()
                .0
                .iter()
                .map(|b| f64::from_le_bytes(*b))
                .collect();
            sim.write(field.0, field.1, first, &values);
        }
    }
    sim.set_time(step, step as f64 * dt);
    Ok(Record { rows, seconds })
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
    fn a_state_that_does_not_fit_is_left_alone() {
        let dir = tempfile::tempdir().unwrap();
        run(&context(dir.path(), "a"), "p", sim().as_mut(), plan(10, 10)).unwrap();
        let path = dir.path().join(".parts/p.state");
        let told = |inputs: &str| load(&path, inputs, sim().as_mut()).unwrap_err().to_string();
        assert!(load(&path, "a", sim().as_mut()).is_ok());
        assert_eq!(told("b"), "other inputs");
        let mut fresh = sim();
        fresh.set_time_step(0.01);
        assert_eq!(
            load(&path, "a", fresh.as_mut()).unwrap_err().to_string(),
            "another time step"
        );
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[200] ^= 1;
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(told("a"), "the sum does not fit");
        std::fs::write(&path, &bytes[..90]).unwrap();
        assert_eq!(told("a"), "the sum does not fit");
        // the run begins anew
        let mut again = sim();
        let record = run(&context(dir.path(), "a"), "p", again.as_mut(), plan(10, 10)).unwrap();
        assert_eq!(record.rows[0].step, 0);
        assert!(load(&path, "a", sim().as_mut()).is_ok());
    }
}
