//! `fix ave/time`: samples, and the lines of its file.

use super::average::Average;
use crate::error::{Problem, Result};
use crate::session::Session;
use std::cell::RefCell;
use std::rc::Rc;

impl Session<'_> {
    /// Takes a sample if one is due, and writes a line if that was the last of an output.
    ///
    /// # Errors
    /// A value cannot be computed; the file cannot be written.
    pub fn sample(&mut self, average: &Rc<RefCell<Average>>) -> Result<()> {
        let step = self.progress.step;
        let (inputs, vector) = {
            let a = average.borrow();
            if a.next != step {
                return Ok(());
            }
            (a.inputs.clone(), a.vector)
        };
        let mut columns = Vec::new();
        for input in &inputs {
            columns.push(if vector {
                self.column_vector(&input.column)?
            } else {
                vec![self.column_value(&input.column)?]
            });
        }
        let rows = columns.iter().map(Vec::len).max().unwrap_or(0);
        if columns.iter().any(|c| c.len() != rows) {
            return Err(Problem::new(
                "`fix ave/time mode vector` needs values of one length",
            ));
        }
        let row = |r: usize| columns.iter().map(|c| c[r]).collect::<Vec<f64>>();
        let now: Vec<Vec<f64>> = (0..rows).map(row).collect();
        average.borrow_mut().take(step, now)
    }
}
