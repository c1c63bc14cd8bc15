//! Columns of thermodynamic output.

use super::keyword;
use crate::error::{Problem, Result, suggestion};

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
