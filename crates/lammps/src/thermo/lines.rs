//! Lines of thermodynamic output.

use super::Line;
use super::columns::Column;
use crate::error::Result;
use crate::particles::Field;
use crate::printf::{Format, Value};
use crate::record::Row;
use crate::session::Session;

impl Session<'_> {
    fn thermo_columns(&self) -> Vec<Column> {
        let mut columns = self.watch.thermo.columns.clone();
        if self.watch.thermo.add_volume
            && self
                .space
                .domain
                .as_ref()
                .is_some_and(crate::domain::SimBox::moves)
        {
            columns.push(Column::Keyword("vol"));
        }
        columns
    }

    /// The line above the numbers.
    pub fn thermo_header(&mut self) {
        match self.watch.thermo.line {
            Line::One => {}
            Line::Multi => return,
            Line::Yaml => {
                let columns = self.thermo_columns();
                let names: String = columns
                    .iter()
                    .map(|c| format!("'{}', ", c.heading()))
                    .collect();
                return self
                    .console
                    .print(&format!("---\nkeywords: [{names}]\ndata:"));
            }
        }
        let line: Vec<String> = self
            .thermo_columns()
            .iter()
            .map(|c| {
                let name = c.heading();
                if c.is_integer() {
                    format!("{name:^11}")
                } else {
                    format!("{name:^14}")
                }
            })
            .collect();
        self.console.print(&line.join(" "));
    }

    /// One line (or block) of numbers.
    ///
    /// # Errors
    /// A value cannot be computed; atoms are lost.
    pub fn thermo_line(&mut self) -> Result<()> {
        self.check_lost()?;
        let columns = self.thermo_columns();
        let mut values = Vec::with_capacity(columns.len());
        for column in &columns {
            values.push(self.column_value(column)?);
        }
        let (step, time) = (self.progress.step, self.progress.time());
        let row = Row {
            step,
            time,
            values: values.clone(),
        };
        let headings = columns.iter().map(Column::heading).collect();
        self.watch.record.line(headings, row);
        self.watch.record.place(time, &self.fixes.acting);
        let texts: Vec<String> = columns
            .iter()
            .zip(&values)
            .enumerate()
            .map(|(k, (c, v))| self.thermo_text(k, c, *v))
            .collect();
        match self.watch.thermo.line {
            Line::One => self.console.print(&texts.join(" ")),
            Line::Multi => return self.print_block(&columns, &texts),
            Line::Yaml => {
                let values: String = texts.iter().map(|t| format!("{t}, ")).collect();
                self.console.print(&format!("  - [{values}]"));
            }
        }
        Ok(())
    }

    /// What stands under the lines of a run.
    pub fn thermo_footer(&mut self) {
        if self.watch.thermo.line == Line::Yaml {
            self.console.print("...");
        }
    }

    fn thermo_text(&self, index: usize, column: &Column, value: f64) -> String {
        let integer = column.is_integer();
        let user = self
            .watch
            .thermo
            .single
            .iter()
            .rev()
            .find(|(k, _)| *k == index)
            .map(|(_, f)| f);
        let user = user.or(if integer {
            self.watch.thermo.integer.as_ref()
        } else {
            self.watch.thermo.float.as_ref()
        });
        let value = if integer {
            Value::Integer(value as i64)
        } else {
            Value::Float(value)
        };
        let fallback = match (integer, self.watch.thermo.line) {
            (true, Line::One) => "%10d ",
            (false, Line::One) => "% -14.8g",
            (true, Line::Multi) => "%14d",
            (false, Line::Multi) => "%14.4f",
            (true, Line::Yaml) => "%d",
            (false, Line::Yaml) => "%.15g",
        };
        match user {
            Some(f) => f.print(value),
            None => Format::parse(fallback)
                .map(|f| f.print(value))
                .unwrap_or_default(),
        }
    }

    fn print_block(&mut self, columns: &[Column], texts: &[String]) -> Result<()> {
        let cpu = self.thermo_value("cpu")?;
        let cpu = crate::printf::general(cpu, 7, false);
        let step = self.progress.step;
        self.console.print(&format!(
            "------------ Step {step:14} ----- CPU = {cpu:>12} (sec) -------------"
        ));
        let cells: Vec<String> = columns
            .iter()
            .zip(texts)
            .map(|(c, t)| format!("{:<8} = {t}", c.heading()))
            .collect();
        let rows: Vec<String> = cells.chunks(3).map(|row| row.join(" ")).collect();
        self.console.print(&rows.join(" \n"));
        Ok(())
    }

    /// Value of a thermo keyword.
    ///
    /// # Errors
    /// It does not exist (yet).
    pub fn thermo_value(&mut self, name: &str) -> Result<f64> {
        let step = self.progress.step;
        let axis = |letter: u8| usize::from(letter - b'x');
        let bytes = name.as_bytes();
        Ok(match name {
            "step" => step as f64,
            "elapsed" => (step - self.progress.begin.min(step)) as f64,
            "elaplong" => (step - self.progress.first.min(step)) as f64,
            "dt" => self.progress.time_step,
            "time" => self.progress.time(),
            "cpu" => self.loop_seconds(),
            "spcpu" | "tpcpu" => {
                let done = (step - self.progress.begin.min(step)) as f64;
                let seconds = self.loop_seconds();
                let rate = if seconds > 0.0 { done / seconds } else { 0.0 };
                if name == "spcpu" {
                    rate
                } else {
                    rate * self.progress.time_step
                }
            }
            "cpuremain" => {
                let done = (step - self.progress.begin.min(step)) as f64;
                let left = (self.progress.end - step.min(self.progress.end)) as f64;
                if done > 0.0 {
                    self.loop_seconds() * left / done
                } else {
                    0.0
                }
            }
            "atoms" => self.population.count() as f64,
            "vol" => {
                let d = self.space.domain()?;
                d.edge(0)
                    * d.edge(1)
                    * if self.space.dimension == 3 {
                        d.edge(2)
                    } else {
                        1.0
                    }
            }
            "lx" | "ly" | "lz" => self.space.domain()?.edge(axis(bytes[1])),
            "xlo" | "ylo" | "zlo" => self.space.domain()?.low[axis(bytes[0])],
            "xhi" | "yhi" | "zhi" => self.space.domain()?.high[axis(bytes[0])],
            "temp" => self.temperature()?,
            "press" => self.pressure()?,
            "pxx" | "pyy" | "pzz" | "pxy" | "pxz" | "pyz" => {
                self.pressure_component(axis(bytes[1]), axis(bytes[2]))?
            }
            "ke" => self.kinetic()?,
            "pe" | "epair" | "evdwl" => self.population.engine()?.energies()?.potential,
            "etotal" => self.kinetic()? + self.population.engine()?.energies()?.potential,
            "enthalpy" => {
                let volume = self.thermo_value("vol")?;
                let work = self.pressure()? * volume / self.space.units.pressure();
                self.kinetic()? + self.population.engine()?.energies()?.potential + work
            }
            // no bonded interactions, charges or tilted boxes
            _ => 0.0,
        })
    }

    pub(super) fn kinetic(&self) -> Result<f64> {
        self.reduce(
            crate::compute::Mode::Sum,
            &crate::atoms::Members::All,
            &crate::variable::tree::Tree::Field(Field::Kinetic),
        )
    }

    fn loop_seconds(&self) -> f64 {
        if self.progress.step == self.progress.begin {
            return 0.0;
        }
        self.progress
            .started
            .map_or(0.0, |t| t.elapsed().as_secs_f64())
    }
}
