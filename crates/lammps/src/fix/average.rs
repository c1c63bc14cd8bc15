//! `fix ave/time`: means over steps, in a file and as values.

use crate::error::{Problem, Result};
use crate::files::Sink;
use crate::printf::{Format, Value};
use crate::thermo::columns::Column;
use std::collections::VecDeque;

/// What a mean is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ave {
    /// The samples before this output.
    One,
    /// All samples so far.
    Running,
    /// The last so many outputs.
    Window(usize),
}

#[derive(Debug)]
pub struct Average {
    /// Values: one number each (`mode scalar`), or lists of numbers of one length (`mode vector`).
    pub inputs: Vec<Source>,
    pub vector: bool,
    pub every: u64,
    pub repeat: u64,
    pub frequency: u64,
    pub ave: Ave,
    /// Next step to sample.
    pub next: u64,
    /// Samples taken for the coming output.
    pub taken: u64,
    /// `[row][input]`
    pub sum: Vec<Vec<f64>>,
    /// Sums and number of the outputs that the mean is of.
    pub total: Vec<Vec<f64>>,
    pub outputs: u64,
    pub window: VecDeque<Vec<Vec<f64>>>,
    pub result: Vec<Vec<f64>>,
    pub format: Format,
    pub file: Option<Sink>,
}

/// A value as written, and whether it is never averaged (`off`).
#[derive(Debug, Clone)]
pub struct Source {
    pub column: Column,
    pub plain: bool,
}

impl Average {
    pub fn samples_at(&self, step: u64) -> bool {
        self.next == step
    }

    /// First step to sample from `now` on; outputs begin at `start`.
    pub fn first(every: u64, repeat: u64, frequency: u64, now: u64, start: u64) -> u64 {
        let mut next = now / frequency * frequency + frequency;
        next += start.saturating_sub(next).div_ceil(frequency) * frequency;
        if next - frequency == now && repeat == 1 {
            return now;
        }
        let first = next - (repeat - 1) * every;
        if first < now {
            first + frequency
        } else {
            first
        }
    }

    /// `f_ID`, `f_ID[i]`, `f_ID[i][j]`.
    ///
    /// # Errors
    /// No such value.
    pub fn value(&self, id: &str, index: &[f64]) -> Result<f64> {
        let place = |x: f64| (x >= 1.0).then_some(x as usize - 1);
        let columns = self.inputs.len();
        let value = match (self.vector, columns, index) {
            (false, 1, []) => self.result.first().map(|r| r[0]),
            (false, n, [k]) if n > 1 => place(*k).filter(|k| *k < n).and_then(|k| {
                let row = self.result.first();
                row.map(|r| r[k])
            }),
            (true, 1, [k]) => place(*k).and_then(|k| Some(self.result.get(k)?[0])),
            (true, n, [k, c]) if n > 1 => place(*k)
                .zip(place(*c).filter(|c| *c < n))
                .and_then(|(k, c)| Some(self.result.get(k)?[c])),
            _ => {
                return Err(Problem::new(format!("fix `{id}` has no such value")).help(
                    match (self.vector, columns) {
                        (false, 1) => format!("it is one number: f_{id}"),
                        (false, n) => format!("it has the numbers f_{id}[1] to f_{id}[{n}]"),
                        (true, 1) => format!("it is a list: f_{id}[1] and on"),
                        (true, n) => format!("it is a table: f_{id}[row][1] to f_{id}[row][{n}]"),
                    },
                ));
            }
        };
        Ok(value.unwrap_or(0.0))
    }
}

impl Average {
    pub(super) fn take(&mut self, step: u64, now: Vec<Vec<f64>>) -> Result<()> {
        let add = |sum: &mut Vec<Vec<f64>>, more: &[Vec<f64>], plain: &[bool]| {
            if sum.is_empty() {
                *sum = vec![vec![0.0; plain.len()]; more.len()];
            }
            for (s, m) in sum.iter_mut().zip(more) {
                for ((s, m), plain) in s.iter_mut().zip(m).zip(plain) {
                    *s = if *plain { *m } else { *s + m };
                }
            }
        };
        let plain: Vec<bool> = self.inputs.iter().map(|i| i.plain).collect();
        add(&mut self.sum, &now, &plain);
        self.taken += 1;
        if self.taken < self.repeat {
            self.next += self.every;
            return Ok(());
        }
        self.next = step + self.frequency - (self.repeat - 1) * self.every;
        let repeat = self.taken as f64;
        self.taken = 0;
        let mut mean = std::mem::take(&mut self.sum);
        for row in &mut mean {
            for (x, plain) in row.iter_mut().zip(&plain) {
                *x /= if *plain { 1.0 } else { repeat };
            }
        }
        let outputs = match self.ave {
            Ave::One => {
                self.total = mean;
                1
            }
            Ave::Running => {
                add(&mut self.total, &mean, &plain);
                self.outputs += 1;
                self.outputs
            }
            Ave::Window(most) => {
                self.window.push_back(mean);
                if self.window.len() > most {
                    self.window.pop_front();
                }
                self.total.clear();
                for m in &self.window {
                    add(&mut self.total, m, &plain);
                }
                self.window.len() as u64
            }
        };
        self.result = self.total.clone();
        for row in &mut self.result {
            for (x, plain) in row.iter_mut().zip(&plain) {
                *x /= if *plain { 1.0 } else { outputs as f64 };
            }
        }
        self.write(step)
    }

    fn write(&mut self, step: u64) -> Result<()> {
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        let numbers = |row: &[f64]| -> String {
            row.iter()
                .map(|x| self.format.print(Value::Float(*x)))
                .collect()
        };
        if self.vector {
            file.line(&format!("{step} {}", self.result.len()))?;
            for (k, row) in self.result.iter().enumerate() {
                file.line(&format!("{}{}", k + 1, numbers(row)))?;
            }
        } else {
            for row in &self.result {
                file.line(&format!("{step}{}", numbers(row)))?;
            }
        }
        file.flush()
    }
}
