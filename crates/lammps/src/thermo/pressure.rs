//! Temperature and pressure as LAMMPS's `peri` styles give them: masses are densities there, but the virial is an
//! energy, so both say little.

use super::BUILT_IN;
use super::columns::Column;
use crate::atoms::Members;
use crate::error::{Problem, Result};
use crate::host::{BLOCK, Quantity};
use crate::session::{Session, Store};
use crate::variable::Kind;

/// What a virial is needed for.
const WANTED: [&str; 8] = [
    "press", "pxx", "pyy", "pzz", "pxy", "pxz", "pyz", "enthalpy",
];
/// Components in LAMMPS's order.
const COMPONENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

impl Session<'_> {
    /// Will the coming output ask for a pressure?
    pub fn pressure_wanted(&self) -> bool {
        let column = |c: &Column| match c {
            Column::Keyword(k) => WANTED.contains(k),
            Column::Compute(_, id, _) => id == "thermo_press",
            Column::Fix(..) | Column::Variable(_) => false,
        };
        let formula = |name: &str| match self.formulas.variables.get(name) {
            Some(Kind::Equal(f) | Kind::Atom(f)) => WANTED.iter().any(|w| f.text.contains(w)),
            _ => false,
        };
        self.watch.thermo.columns.iter().any(column) || self.formulas.variables.names().any(formula)
    }

    pub(super) fn temperature(&self) -> Result<f64> {
        self.temperature_of(&Members::All, self.progress.counted)
    }

    fn virial(&mut self) -> Result<[f64; 6]> {
        match &mut self.population.store {
            Store::Engine(e) => Ok(e.virial()?),
            Store::Atoms(_) => Ok([f64::NAN; 6]),
        }
    }

    pub(super) fn pressure(&mut self) -> Result<f64> {
        let virial: f64 = self.virial()?[..self.space.dimension].iter().sum();
        let volume = self.thermo_value("vol")?;
        let moving = if self.population.count() > 1 {
            self.kinetic()?
        } else {
            0.0
        };
        Ok(
            (2.0 * moving + virial) / (self.space.dimension as f64 * volume)
                * self.space.units.pressure(),
        )
    }

    pub(super) fn pressure_component(&mut self, a: usize, b: usize) -> Result<f64> {
        if a.max(b) >= self.space.dimension {
            return Ok(0.0);
        }
        let place = COMPONENTS.iter().position(|c| *c == (a, b)).unwrap_or(0);
        let virial = self.virial()?[place];
        let volume = self.thermo_value("vol")?;
        Ok((self.momentum_flux(a, b)? + virial) / volume * self.space.units.pressure())
    }

    /// Σ ρ v_a v_b.
    fn momentum_flux(&self, a: usize, b: usize) -> Result<f64> {
        let (atoms, n) = (self.population.store.particles(), self.population.count());
        let mut sum = 0.0;
        let mut values = [[0.0; BLOCK]; 3];
        let quantities = [
            Quantity::Density,
            Quantity::Velocity(a),
            Quantity::Velocity(b),
        ];
        for first in (0..n).step_by(BLOCK) {
            let m = BLOCK.min(n - first);
            for (values, quantity) in values.iter_mut().zip(quantities) {
                atoms.read(quantity, first, &mut values[..m])?;
            }
            sum += (0..m)
                .map(|i| values[0][i] * values[1][i] * values[2][i])
                .sum::<f64>();
        }
        Ok(self.space.units.kinetic() * sum)
    }

    /// # Errors
    /// A built-in compute has no such value.
    pub fn check_built_in(&self, id: &str, index: &[f64]) -> Result<()> {
        match index {
            [] => Ok(()),
            [k] if id == "thermo_press" && (1.0..=6.0).contains(k) => Ok(()),
            _ => Err(Problem::new(format!("compute `{id}` has no such value"))
                .help("supported: c_thermo_temp, c_thermo_press, c_thermo_press[1] to [6], c_thermo_pe")),
        }
    }

    /// Value of a built-in compute; `None`: it is none.
    ///
    /// # Errors
    /// It has no such value (yet).
    pub fn built_in(&mut self, id: &str, index: &[f64]) -> Result<Option<f64>> {
        if !BUILT_IN.contains(&id) {
            return Ok(None);
        }
        self.check_built_in(id, index)?;
        Ok(Some(match (id, index) {
            ("thermo_temp", _) => self.temperature()?,
            ("thermo_press", [k]) => {
                let (a, b) = COMPONENTS[(*k as usize).clamp(1, 6) - 1];
                self.pressure_component(a, b)?
            }
            ("thermo_press", _) => self.pressure()?,
            _ => self.population.engine()?.energies()?.potential,
        }))
    }
}
