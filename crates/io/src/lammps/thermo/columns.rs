//! Columns of thermodynamic output.

use super::keyword;
use crate::lammps::error::{Problem, Result, suggestion};
use crate::lammps::session::Session;

#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    Keyword(&'static str),
    /// `c_ID`, `c_ID[i]`, as written, ID, index
    Compute(String, String, Option<usize>),
    Fix(String, String, Option<usize>),
    Variable(String),
}

/// `thermo_style one`
pub fn one() -> Vec<Column> {
    ["step", "temp", "epair", "emol", "etotal", "press"]
        .map(Column::Keyword)
        .to_vec()
}

/// `thermo_style multi`
pub fn multi() -> Vec<Column> {
    [
        "etotal", "ke", "temp", "pe", "ebond", "eangle", "edihed", "eimp", "evdwl", "ecoul",
        "elong", "press",
    ]
    .map(Column::Keyword)
    .to_vec()
}

/// `thermo_style yaml`
pub fn yaml() -> Vec<Column> {
    [
        "step", "temp", "ke", "pe", "ebond", "eangle", "edihed", "eimp", "evdwl", "ecoul", "elong",
        "press",
    ]
    .map(Column::Keyword)
    .to_vec()
}

impl Column {
    /// Reads a word of `thermo_style custom`.
    ///
    /// # Errors
    /// No such keyword.
    pub fn parse(word: &str) -> Result<Column> {
        if let Some(k) = keyword::find(word) {
            return Ok(Column::Keyword(k));
        }
        let reference = |rest: &str| -> Option<(String, Option<usize>)> {
            match rest.split_once('[') {
                None => Some((rest.to_string(), None)),
                Some((id, i)) => Some((id.to_string(), Some(i.strip_suffix(']')?.parse().ok()?))),
            }
        };
        let bad = || {
            Problem::new(format!(
                "`{word}` is not a thermo keyword, c_ID, c_ID[i], f_ID, f_ID[i] or v_name"
            ))
        };
        match word.split_at_checked(2) {
            Some(("c_", rest)) => {
                let (id, i) = reference(rest).ok_or_else(bad)?;
                Ok(Column::Compute(word.to_string(), id, i))
            }
            Some(("f_", rest)) => {
                let (id, i) = reference(rest).ok_or_else(bad)?;
                Ok(Column::Fix(word.to_string(), id, i))
            }
            Some(("v_", name)) => Ok(Column::Variable(name.to_string())),
            _ => Err(bad().help(suggestion(word, keyword::names()))),
        }
    }

    pub fn heading(&self) -> String {
        match self {
            Column::Keyword(k) => keyword::heading(k).to_string(),
            Column::Compute(text, _, _) | Column::Fix(text, _, _) => text.clone(),
            Column::Variable(name) => format!("v_{name}"),
        }
    }

    pub fn is_integer(&self) -> bool {
        matches!(self, Column::Keyword(k) if keyword::is_integer(k))
    }
}

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
            Column::Variable(name) if self.variables.get(name).is_none() => {
                return Err(Problem::new(format!("there is no variable `{name}`"))
                    .help(suggestion(name, self.variables.names())));
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
                    .thermo
                    .normalize
                    .unwrap_or(self.units == crate::lammps::units::Units::Lj);
                if normalize && keyword::is_extensive(k) {
                    value / self.count().max(1) as f64
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
