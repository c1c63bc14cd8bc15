//! Tables as CSV: a header `name [unit]`, then one row per line.

use std::io::{self, Write};
use std::path::Path;

use super::atomic::{WriteError, write_file};
use super::fields::invalid;
use super::history::{Column, quoted};

enum Values {
    Numbers(Vec<f64>),
    Texts(Vec<String>),
}

/// A table, column by column.
#[derive(Default)]
pub struct Table {
    columns: Vec<(Column, Values)>,
}

impl Table {
    pub fn new() -> Table {
        Table::default()
    }

    /// A column of numbers with its unit ("" for pure numbers).
    #[must_use]
    pub fn column(
        mut self,
        name: &str,
        unit: &str,
        values: impl IntoIterator<Item = f64>,
    ) -> Table {
        let values = Values::Numbers(values.into_iter().collect());
        self.columns.push((Column::new(name, unit), values));
        self
    }

    /// A column of texts.
    #[must_use]
    pub fn text<S: Into<String>>(
        mut self,
        name: &str,
        values: impl IntoIterator<Item = S>,
    ) -> Table {
        let values = Values::Texts(values.into_iter().map(Into::into).collect());
        self.columns.push((Column::new(name, ""), values));
        self
    }

    /// Writes the table, all or nothing. Numbers have the fewest digits that read back to the same f64.
    ///
    /// # Errors
    /// The operating system's; `InvalidInput` for columns of unequal lengths.
    pub fn save(&self, path: &Path) -> Result<(), WriteError> {
        write_file(path, |w| self.write(w))
    }

    /// The same to any writer.
    ///
    /// # Errors
    /// Those of `w`, and those of [`Table::save`].
    pub fn write<W: Write>(&self, w: &mut W) -> io::Result<()> {
        let length = |v: &Values| match v {
            Values::Numbers(v) => v.len(),
            Values::Texts(v) => v.len(),
        };
        let rows = self.columns.first().map_or(0, |c| length(&c.1));
        if let Some((column, v)) = self.columns.iter().find(|c| length(&c.1) != rows) {
            let first = &self.columns[0].0.name;
            return Err(invalid(format!(
                "the column {} has {} rows, {first} has {rows}",
                column.name,
                length(v)
            )));
        }
        let header: Vec<String> = self.columns.iter().map(|(c, _)| c.header()).collect();
        writeln!(w, "{}", header.join(","))?;
        for row in 0..rows {
            for (k, (_, values)) in self.columns.iter().enumerate() {
                if k > 0 {
                    write!(w, ",")?;
                }
                match values {
                    Values::Numbers(v) => write!(w, "{}", number(v[row]))?,
                    Values::Texts(v) => write!(w, "{}", quoted(&v[row]))?,
                }
            }
            writeln!(w)?;
        }
        Ok(())
    }
}

/// Whole numbers without `.0`.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(table: &Table) -> String {
        let mut out = Vec::new();
        table.write(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn a_table_has_a_header_with_units() {
        let table = Table::new()
            .column("t", "s", [0.0, 1.0 / 3.0, 1e-30])
            .column("N", "", [1.0, -2.0, f64::NAN])
            .text("model", ["MD", "PD, \"fine\"", ""]);
        assert_eq!(
            text(&table),
            "t [s],N,model\n0,1,MD\n0.3333333333333333,-2,\"PD, \"\"fine\"\"\"\n1e-30,NaN,\n"
        );
        assert_eq!(
            text(&Table::new().column("a, b", "m", [])),
            "\"a, b [m]\"\n"
        );
    }

    #[test]
    fn unequal_columns_are_not_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("t.csv");
        let table = Table::new()
            .column("a", "", [1.0])
            .column("b", "", [1.0, 2.0]);
        let error = table.save(&path).unwrap_err().to_string();
        assert!(
            error.contains("t.csv") && error.contains("the column b has 2 rows, a has 1"),
            "{error}"
        );
        assert!(!path.exists());
    }
}
