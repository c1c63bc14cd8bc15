//! `history.csv`: numbers over time, one row per output.
//!
//! A file that grows cannot be replaced whole at every row, so it is atomic row by row instead ([`Grown`]): the header
//! replaces an older file atomically, and the operating system keeps every row when the run is killed.

use std::path::Path;

use peridyne::diffusion::DiffusionAccount;
use peridyne::observe::Ledger;
use peridyne::spec::Quantity;
use peridyne::state::{Archive, Owner};

use super::Grown;
use super::atomic::WriteError;
use super::fields::invalid;

/// A column: name, and unit ("" for pure numbers). The header shows `name [unit]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    pub name: String,
    pub unit: String,
}

impl Column {
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Column {
            name: name.into(),
            unit: unit.into(),
        }
    }

    /// The cell of the header.
    pub(super) fn header(&self) -> String {
        match self.unit.as_str() {
            "" => quoted(&self.name),
            unit => quoted(&format!("{} [{unit}]", self.name)),
        }
    }
}

/// An open `history.csv`.
#[derive(Debug)]
pub struct History {
    file: Grown,
    columns: usize,
}

impl History {
    /// Starts the file with its header: `step` and the columns.
    pub fn create(path: &Path, columns: &[Column]) -> Result<Self, WriteError> {
        let mut header = String::from("step");
        for column in columns {
            header += ",";
            header += &column.header();
        }
        header += "\n";
        Ok(History {
            file: Grown::create(path, header.as_bytes())?,
            columns: columns.len(),
        })
    }

    /// The file of a run that goes on; its state must be read, and [`rewind`](History::rewind) called, before a row comes.
    pub fn reopen(path: &Path, columns: &[Column]) -> Result<Self, WriteError> {
        Ok(History {
            file: Grown::open(path)?,
            columns: columns.len(),
        })
    }

    /// [`Grown::rewind`].
    pub fn rewind(&mut self) -> Result<(), WriteError> {
        self.file.rewind()
    }

    /// Appends a row; it is in the file when this returns. Numbers are written with the fewest digits that
    /// read back to the same f64.
    ///
    /// # Errors
    /// The operating system's; `InvalidInput` when the number of values is not that of the columns.
    pub fn push(&mut self, step: u64, values: &[f64]) -> Result<(), WriteError> {
        if values.len() != self.columns {
            let (got, want) = (values.len(), self.columns);
            let error = invalid(format!("{got} values for {want} columns"));
            return Err(WriteError::at("append to", self.file.path())(error));
        }
        let mut row = step.to_string();
        for value in values {
            row += &format!(",{value:?}");
        }
        row += "\n";
        self.file.push(|w| w.write_all(row.as_bytes()))
    }

    /// Waits until all rows are on the disk.
    pub fn finish(self) -> Result<(), WriteError> {
        self.file.finish()
    }
}

impl Owner for History {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.part("file", &mut self.file);
    }
}

/// A CSV cell (RFC 4180).
pub(super) fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_string()
    }
}

/// Columns of the energy ledger, in the order of [`ledger_values`].
pub fn ledger_columns(unit: &str) -> Vec<Column> {
    let names = [
        "kinetic energy",
        "strain energy",
        "contact energy",
        "energy dissipated by bond breakage",
        "energy created by bond breakage",
        "dissipated energy",
        "work of boundary conditions",
        "work of rigid bodies",
        "energy balance error",
    ];
    names.map(|name| Column::new(name, unit)).to_vec()
}

/// Columns that had another name in version 0.1: as they were, as they are.
const RENAMED: [(&str, &str); 5] = [
    ("released energy", "energy dissipated by bond breakage"),
    ("energy made by breaking", "energy created by bond breakage"),
    ("work of conditions", "work of boundary conditions"),
    ("work of indenters", "work of rigid bodies"),
    ("energy residual", "energy balance error"),
];

/// The name of today of a column.
#[must_use]
pub fn today(name: &str) -> &str {
    let found = RENAMED.iter().find(|(old, _)| *old == name);
    found.map_or(name, |(_, new)| new)
}

/// The ledger as a row: its entries without the constant `initial`, and what the balance misses.
pub fn ledger_values(l: &Ledger) -> [f64; 9] {
    [
        l.kinetic,
        l.strain,
        l.contact,
        l.released,
        l.made,
        l.dissipated,
        l.work_boundary_conditions,
        l.work_rigid_bodies,
        l.residual(),
    ]
}

/// Columns of the account of what spreads, in the order of [`diffusion_values`]; amounts of a species are plain numbers.
pub fn diffusion_columns(
    quantity: Quantity,
    a: &DiffusionAccount,
    energy_unit: &str,
) -> Vec<Column> {
    let unit = match quantity {
        Quantity::Heat => energy_unit,
        Quantity::Species => "",
    };
    let name = |(n, _): (&str, f64)| Column::new(format!("{} {n}", quantity.name()), unit);
    diffusion_entries(a).map(name).collect()
}

/// The account as a row: its entries without the constant `initial`, and what the balance misses.
pub fn diffusion_values(a: &DiffusionAccount) -> Vec<f64> {
    diffusion_entries(a).map(|(_, value)| value).collect()
}

fn diffusion_entries(a: &DiffusionAccount) -> impl Iterator<Item = (&'static str, f64)> {
    [
        ("content", a.content),
        ("supplied", a.supplied),
        ("exchanged", a.exchanged),
        ("held", a.held),
        ("made", a.made),
    ]
    .into_iter()
    .chain(a.through_contact.map(|x| ("through contact", x)))
    .chain([("residual", a.residual())])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn columns() -> Vec<Column> {
        vec![
            Column::new("time", "s"),
            Column::new("broken bonds", ""),
            Column::new("a,b \"c\"", "m/s"),
        ]
    }

    #[test]
    fn header_names_units_and_rows_are_there_at_once() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("history.csv");
        std::fs::write(&path, "a longer file of an older run\n").unwrap();
        let mut history = History::create(&path, &columns()).unwrap();
        let header = "step,time [s],broken bonds,\"a,b \"\"c\"\" [m/s]\"\n";
        assert_eq!(std::fs::read_to_string(&path).unwrap(), header);
        history.push(3, &[1e-7, 0.1 + 0.2, -1e300]).unwrap();
        // read while the run goes on: nothing waits in a buffer
        let rows = std::fs::read_to_string(&path).unwrap();
        assert_eq!(rows, format!("{header}3,1e-7,0.30000000000000004,-1e300\n"));
        assert!(
            history
                .push(4, &[1.0])
                .unwrap_err()
                .to_string()
                .contains("1 values for 3 columns")
        );
        history.finish().unwrap();
    }

    #[test]
    fn ledger_has_a_name_for_every_value() {
        let ledger = Ledger {
            kinetic: 3.0,
            strain: 2.0,
            initial: 4.5,
            ..Ledger::default()
        };
        assert_eq!(ledger_columns("J").len(), ledger_values(&ledger).len());
        assert_eq!(ledger_values(&ledger)[8], 0.5);
    }

    proptest! {
        #[test]
        fn numbers_round_trip(value in proptest::num::f64::ANY) {
            let dir = tempfile::tempdir().unwrap();
            let path = dir.path().join("history.csv");
            let mut history = History::create(&path, &[Column::new("x", "")]).unwrap();
            history.push(0, &[value]).unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            let back: f64 = text.trim_end().rsplit(',').next().unwrap().parse().unwrap();
            prop_assert!(back.to_bits() == value.to_bits() || back.is_nan() && value.is_nan());
        }
    }
}
