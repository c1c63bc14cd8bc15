//! `write_data` for `atom_style peri`.

use std::fs::File;
use std::io::{BufWriter, Write};

use super::error::{Problem, Result};
use super::host::Quantity;
use super::particles::Field;
use super::printf::shortest;
use super::session::Session;

impl Session<'_> {
    /// Writes a data file, complete or not at all.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write_data(&mut self, name: &str) -> Result<()> {
        self.shrink_box()?;
        let path = self.output_path(name);
        let io = |e: std::io::Error| Problem::new(format!("cannot write {}: {e}", path.display()));
        // a half-written file must not look like a whole one
        let mut part = path.clone().into_os_string();
        part.push(".part");
        let mut out = BufWriter::new(File::create(&part).map_err(io)?);
        let domain = *self.domain()?;
        let n = self.count();
        let step = self.progress.step;
        let mut text = format!(
            "LAMMPS data file via write_data, peridyne {}, timestep = {step}, units = {}\n\n{n} atoms\n{} atom types\n\n",
            env!("CARGO_PKG_VERSION"),
            self.units.name(),
            self.types
        );
        for (a, axis) in ["x", "y", "z"].iter().enumerate() {
            text += &format!(
                "{} {} {axis}lo {axis}hi\n",
                shortest(domain.low[a]),
                shortest(domain.high[a])
            );
        }
        text += "\nAtoms # peri\n\n";
        let atom_fields = [Quantity::Type, Quantity::Volume, Quantity::Density].map(Field::Raw);
        let places = [0, 1, 2]
            .map(Field::Wrapped)
            .into_iter()
            .chain([0, 1, 2].map(Field::Image));
        let fields: Vec<Field> = atom_fields.into_iter().chain(places).collect();
        self.write_rows(&fields, &mut text, &mut out)
            .map_err(|e| e.unwrap_or_else(io))?;
        text += "\nVelocities\n\n";
        let fields = [0, 1, 2].map(|a| Field::Raw(Quantity::Velocity(a)));
        self.write_rows(&fields, &mut text, &mut out)
            .map_err(|e| e.unwrap_or_else(io))?;
        out.flush().map_err(io)?;
        std::fs::rename(&part, &path).map_err(io)?;
        Ok(())
    }

    fn write_rows(
        &self,
        fields: &[Field],
        text: &mut String,
        out: &mut dyn Write,
    ) -> std::result::Result<(), RowError> {
        let view = self.view().map_err(RowError::Problem)?;
        let n = self.count();
        let block = super::host::BLOCK;
        let mut values = vec![vec![0.0; block]; fields.len()];
        for first in (0..n).step_by(block) {
            let m = block.min(n - first);
            for (f, v) in fields.iter().zip(&mut values) {
                view.read(*f, first, &mut v[..m])
                    .map_err(RowError::Problem)?;
            }
            for i in 0..m {
                *text += &self.ids.get(first + i).to_string();
                for v in &values {
                    text.push(' ');
                    *text += &shortest(v[i]);
                }
                text.push('\n');
            }
            out.write_all(text.as_bytes()).map_err(RowError::Io)?;
            text.clear();
        }
        out.write_all(text.as_bytes()).map_err(RowError::Io)?;
        text.clear();
        Ok(())
    }
}

enum RowError {
    Problem(Box<Problem>),
    Io(std::io::Error),
}

impl RowError {
    fn unwrap_or_else(self, io: impl FnOnce(std::io::Error) -> Box<Problem>) -> Box<Problem> {
        match self {
            RowError::Problem(p) => p,
            RowError::Io(e) => io(e),
        }
    }
}
