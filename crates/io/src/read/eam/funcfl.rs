//! `eam` files, one element each: a comment line; `number mass lattice_constant lattice`; `Nrho drho Nr dr cutoff`;
//! then F(ρ), the effective charge Z(r) and the electron density ρ(r).
//!
//! The pair energy of elements i and j is r φ = 27.2 · 0.529 Z_i Z_j (eV Å). LAMMPS brings all files of a run
//! on one grid: the largest steps, and as many knots as steps fit in the longest table, one fewer than the table has
//! knots; in between, cubics through four knots. The same is done here, so that the tables are LAMMPS's.

use super::super::error::ReadError;
use super::file::{EamElement, EamFile};
use super::setfl::{Grid, described};
use super::symbol::symbol;
use super::titled;
use super::values::Values;
use std::path::Path;

/// Hartree (eV) times Bohr radius (Å), with the digits that LAMMPS takes.
const CHARGE: f64 = 27.2 * 0.529;

/// Reads `eam` files, one per element, as one potential.
///
/// # Errors
/// As [`super::setfl()`]; an atomic number that is no element's; an element given twice.
pub fn funcfl<P: AsRef<Path>>(paths: &[P]) -> Result<EamFile, ReadError> {
    let texts: Vec<(String, String)> = paths
        .iter()
        .map(|p| titled(p.as_ref(), 1))
        .collect::<Result<_, _>>()?;
    let borrowed: Vec<(&str, &str)> = texts
        .iter()
        .map(|(t, n)| (t.as_str(), n.as_str()))
        .collect();
    parse_funcfl(&borrowed)
}

/// The same from `(text, name)` pairs.
pub fn parse_funcfl(files: &[(&str, &str)]) -> Result<EamFile, ReadError> {
    let mut parts = Vec::new();
    for (text, name) in files {
        let part = Part::parse(text, name)?;
        let twice = parts
            .iter()
            .any(|p: &Part| p.element.name == part.element.name);
        if twice {
            let message = format!(
                "a second file for {}: give one per element",
                part.element.name
            );
            return Err(super::file::failure(name, None, message));
        }
        parts.push(part);
    }
    Ok(merge(files, &parts))
}

struct Part {
    comment: String,
    element: EamElement,
    grid: Grid,
    embedding: Vec<f64>,
    charge: Vec<f64>,
    density: Vec<f64>,
}

impl Part {
    fn parse(text: &str, name: &str) -> Result<Part, ReadError> {
        let mut values = Values::new(text, name);
        let comment = values.lines.next_raw().unwrap_or("").trim_end().to_string();
        let words = values.header("`number mass lattice_constant lattice`")?;
        let mut element = described(&values, &words, "")?;
        element.name = symbol(element.number)
            .ok_or_else(|| {
                let n = element.number;
                values.lines.error(format!("no element has the atomic number {n}: an eam (funcfl) file has its element by number; setfl files belong to eam/alloy"))
            })?
            .to_string();
        let grid = Grid::read(&mut values, 0.0)?;
        let embedding = values.table("the embedding energy F", grid.nrho)?;
        let charge = values.table("the effective charge Z", grid.nr)?;
        let density = values.table("the electron density", grid.nr)?;
        values.end("")?;
        Ok(Part {
            comment,
            element,
            grid,
            embedding,
            charge,
            density,
        })
    }
}

fn merge(files: &[(&str, &str)], parts: &[Part]) -> EamFile {
    let largest = |f: fn(&Grid) -> f64| parts.iter().map(|p| f(&p.grid)).fold(0.0, f64::max);
    let (dr, drho) = (largest(|g| g.dr), largest(|g| g.drho));
    let rmax = largest(|g| (g.nr - 1) as f64 * g.dr);
    let rhomax = largest(|g| (g.nrho - 1) as f64 * g.drho);
    let (nr, nrho) = ((rmax / dr + 0.5) as usize, (rhomax / drho + 0.5) as usize);
    let charge: Vec<Vec<f64>> = parts
        .iter()
        .map(|p| resampled(&p.charge, p.grid.dr, dr, nr))
        .collect();
    let mut pair = Vec::new();
    for i in 0..parts.len() {
        for j in 0..=i {
            let product = charge[i].iter().zip(&charge[j]);
            pair.push(product.map(|(a, b)| CHARGE * a * b).collect());
        }
    }
    let names: Vec<&str> = files.iter().map(|(_, name)| *name).collect();
    EamFile {
        source: names.join(", "),
        comments: parts.iter().map(|p| p.comment.clone()).collect(),
        elements: parts.iter().map(|p| p.element.clone()).collect(),
        drho,
        dr,
        cutoff: largest(|g| g.cutoff),
        embedding: parts
            .iter()
            .map(|p| resampled(&p.embedding, p.grid.drho, drho, nrho))
            .collect(),
        density: parts
            .iter()
            .map(|p| resampled(&p.density, p.grid.dr, dr, nr))
            .collect(),
        density_at: vec![],
        pair,
    }
}

/// The table at `m step`, m < `count`, by the cubic (Lagrange) through the four knots around; at a knot its value. Beyond
/// the last knot the last cubic's last value stays.
fn resampled(table: &[f64], own: f64, step: f64, count: usize) -> Vec<f64> {
    let n = table.len();
    let at = |m: usize| {
        let x = m as f64 * step / own;
        let k = (x as usize).clamp(1, n - 3);
        let p = (x - k as f64).min(2.0);
        let weight = [
            -p * (p - 1.0) * (p - 2.0) / 6.0,
            (p * p - 1.0) * (p - 2.0) / 2.0,
            -p * (p + 1.0) * (p - 2.0) / 2.0,
            p * (p * p - 1.0) / 6.0,
        ];
        (0..4).map(|i| weight[i] * table[k - 1 + i]).sum()
    };
    (0..count).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::resampled;

    #[test]
    fn cubics_are_kept_and_knots_are_themselves() {
        let cubic = |x: f64| 1.0 + x * (2.0 + x * (-0.5 + 0.25 * x));
        let table: Vec<f64> = (0..12).map(|m| cubic(0.1 * f64::from(m))).collect();
        for (m, v) in resampled(&table, 0.1, 0.1, 11).iter().enumerate() {
            assert!((v - table[m]).abs() < 1e-14 * table[m].abs(), "{m}");
        }
        for (m, v) in resampled(&table, 0.1, 0.07, 16).iter().enumerate() {
            assert!((v - cubic(0.07 * m as f64)).abs() < 1e-14, "{m}");
        }
        assert!((resampled(&table, 0.1, 0.5, 9)[8] - table[11]).abs() < 1e-14);
    }
}
