//! Values of the columns.

use super::columns::Column;
use super::keyword;
use crate::error::{Problem, Result, suggestion};
use crate::session::Session;

impl Session<'_> {
    /// Does what the column refers to exist?
    ///
    /// # Errors
    /// It does not.
    pub fn check_column(&mut self, column: &Column) -> Result<()> {
        match column {
            Column::Compute(_, id, index) if super::BUILT_IN.contains(&id.as_str()) => {
                let index: Vec<f64> = index.iter().map(|i| *i as f64).collect();
                self.check_built_in(id, &index)?;
            }
            Column::Compute(_, id, _) if self.compute(id)?.kind.columns().is_some() => {
                return Err(
                    Problem::new(format!("compute `{id}` has a value for each atom"))
                        .help(format!("reduce it: compute NAME all reduce sum c_{id}")),
                );
            }
            Column::Fix(_, id, i) => {
                let index: Vec<f64> = i.iter().map(|i| *i as f64).collect();
                self.fix_value(id, &index)?;
            }
            Column::Variable(name) if self.formulas.variables.get(name).is_none() => {
                return Err(Problem::new(format!("there is no variable `{name}`"))
                    .help(suggestion(name, self.formulas.variables.names())));
            }
            Column::Compute(..) | Column::Variable(_) | Column::Keyword(_) => {}
        }
        Ok(())
    }

    pub fn column_value(&mut self, column: &Column) -> Result<f64> {
        let index = |i: &Option<usize>| i.iter().map(|i| *i as f64).collect::<Vec<f64>>();
        Ok(match column {
            Column::Keyword(k) => {
                let value = self.thermo_value(k)?;
                let normalize = self
                    .watch
                    .thermo
                    .normalize
                    .unwrap_or(self.space.units == crate::units::Units::Lj);
                if normalize && keyword::is_extensive(k) {
                    value / self.population.count().max(1) as f64
                } else {
                    value
                }
            }
            Column::Compute(_, id, i) => self.compute_scalar(id, &index(i))?,
            Column::Fix(_, id, i) => self.fix_value(id, &index(i))?,
            Column::Variable(name) => self.variable_number(name)?,
        })
    }
}
