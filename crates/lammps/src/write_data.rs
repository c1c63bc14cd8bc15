//! `write_data` for `atom_style peri`.

use super::error::Result;
use super::files::Sink;
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
        // a half-written file must not look like a whole one
        let mut out = self.folder.open_part(name)?;
        let domain = *self.space.domain()?;
        let n = self.population.count();
        let step = self.progress.step;
        let mut text = format!(
            "LAMMPS data file via write_data, peridyne {}, timestep = {step}, units = {}\n\n{n} atoms\n{} atom types\n\n",
            env!("CARGO_PKG_VERSION"),
            self.space.units.name(),
            self.population.types
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
        self.write_rows(&fields, &mut text, &mut out)?;
        text += "\nVelocities\n\n";
        let fields = [0, 1, 2].map(|a| Field::Raw(Quantity::Velocity(a)));
        self.write_rows(&fields, &mut text, &mut out)?;
        self.folder.whole(name, out)
    }

    fn write_rows(&self, fields: &[Field], text: &mut String, out: &mut Sink) -> Result<()> {
        let view = self.view()?;
        let n = self.population.count();
        let block = super::host::BLOCK;
        let mut values = vec![vec![0.0; block]; fields.len()];
        for first in (0..n).step_by(block) {
            let m = block.min(n - first);
            for (f, v) in fields.iter().zip(&mut values) {
                view.read(*f, first, &mut v[..m])?;
            }
            for i in 0..m {
                *text += &self.population.ids.get(first + i).to_string();
                for v in &values {
                    text.push(' ');
                    *text += &shortest(v[i]);
                }
                text.push('\n');
            }
            out.write(text)?;
            text.clear();
        }
        out.write(text)?;
        text.clear();
        Ok(())
    }
}
