//! LAMMPS text dump (`dump custom`) of a snapshot or of atoms: what reads LAMMPS's dumps reads it.

use std::io::{self, Write};

use peridyne::observe::{Snapshot, Values};

use super::extxyz::check;
use super::fields::{fields, positions};
use crate::read::Atoms;

/// The box of a dump: along a periodic axis one period (length), along others as far as the points go and half a spacing
/// more on each side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DumpBox {
    /// Lower and upper bound of each periodic axis.
    pub periods: [Option<[f64; 2]>; 3],
}

impl DumpBox {
    /// Periods from a lower corner on.
    pub fn periodic(corner: [f64; 3], periods: [Option<f64>; 3]) -> Self {
        DumpBox {
            periods: std::array::from_fn(|a| periods[a].map(|p| [corner[a], corner[a] + p])),
        }
    }
}

/// Writes one frame: `id type x y z`, velocities as `vx vy vz`, and every other column of the snapshot by
/// its name, with the names of its components (`stress_xx`).
///
/// Types count from 1: the mark, less the smallest mark, plus 1. Numbers read back to the same f64. A trajectory
/// is frames one after another in one file.
///
/// # Errors
/// Those of `w`; `InvalidInput` for arrays of unequal lengths.
pub fn write_frame<W: Write>(w: &mut W, s: &Snapshot, cell: &DumpBox) -> io::Result<()> {
    let mut columns = fields(s)?;
    // x, y, z say it already
    columns.retain(|c| c.name() != "displacement");
    let flags = cell.periods.map(|p| if p.is_some() { "pp" } else { "ss" });
    let shrunk = shrunk(s);
    let bounds = std::array::from_fn(|a| cell.periods[a].unwrap_or(shrunk[a]));
    head(w, s.step, s.reference.len(), flags, bounds)?;
    for column in &columns {
        match (column.name(), column.values.shape().components()) {
            ("velocity", _) => write!(w, " vx vy vz")?,
            (name, []) => write!(w, " {name}")?,
            (name, components) => components
                .iter()
                .try_for_each(|c| write!(w, " {name}_{c}"))?,
        }
    }
    writeln!(w)?;
    let mark: &[i32] = match s.column("block").map(|c| &c.values) {
        Some(Values::Integers(mark)) => mark,
        _ => &[],
    };
    let first = i64::from(mark.iter().copied().min().unwrap_or(0));
    for (i, [x, y, z]) in positions(s).enumerate() {
        let kind = mark.get(i).map_or(1, |&mark| i64::from(mark) - first + 1);
        write!(w, "{} {kind} {x:?} {y:?} {z:?}", i + 1)?;
        for column in &columns {
            let mut row = |v: &[f64]| v.iter().try_for_each(|c| write!(w, " {c:?}"));
            match &column.values {
                Values::Scalars(v) => row(&v[i..=i])?,
                Values::Vectors(v) => row(&v[i])?,
                Values::Symmetric(v) => row(&v[i])?,
                Values::Tensors(v) => row(&v[i])?,
                Values::Integers(v) => write!(w, " {}", v[i])?,
                Values::Counts(v) => write!(w, " {}", v[i])?,
            }
        }
        writeln!(w)?;
    }
    Ok(())
}

/// All up to the columns `id type x y z`.
fn head<W: Write>(
    w: &mut W,
    step: u64,
    count: usize,
    flags: [&str; 3],
    bounds: [[f64; 2]; 3],
) -> io::Result<()> {
    writeln!(w, "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{count}")?;
    writeln!(w, "ITEM: BOX BOUNDS {}", flags.join(" "))?;
    for [low, high] in bounds {
        writeln!(w, "{low:?} {high:?}")?;
    }
    write!(w, "ITEM: ATOMS id type x y z")
}

/// Writes one frame of atoms: `id type x y z`, and `vx vy vz`, `fx fy fz` and `c_pe` (energy) where they are known, of several species
/// also `element` and, where all are known, `mass`. Positions
/// are written as they are; see [`Atoms::wrap`].
///
/// # Errors
/// Those of `w`; `InvalidInput` for arrays of unequal lengths.
pub fn write_atoms<W: Write>(w: &mut W, atoms: &Atoms) -> io::Result<()> {
    check(atoms)?;
    if let Some(time) = atoms.time {
        writeln!(w, "ITEM: TIME\n{time:?}")?;
    }
    let flags = atoms.periodic.map(|p| if p { "pp" } else { "ff" });
    // a box without length along an axis gets length 1, as 2-D boxes of LAMMPS have
    let bounds = std::array::from_fn(|a| match atoms.low[a] == atoms.high[a] {
        true => [atoms.low[a] - 0.5, atoms.high[a] + 0.5],
        false => [atoms.low[a], atoms.high[a]],
    });
    head(w, atoms.step.unwrap_or(0), atoms.len(), flags, bounds)?;
    let vectors = [(&atoms.velocity, "vx vy vz"), (&atoms.force, "fx fy fz")];
    for (_, names) in vectors.iter().filter(|v| v.0.is_some()) {
        write!(w, " {names}")?;
    }
    if atoms.energy.is_some() {
        write!(w, " c_pe")?;
    }
    let several = atoms.species.len() > 1;
    let masses: Option<Vec<f64>> = atoms.species.iter().map(|s| s.mass).collect();
    let masses = masses.filter(|_| several);
    if several {
        write!(w, " element")?;
    }
    if masses.is_some() {
        write!(w, " mass")?;
    }
    writeln!(w)?;
    for (i, [x, y, z]) in atoms.position.iter().enumerate() {
        write!(w, "{} {} {x:?} {y:?} {z:?}", i + 1, atoms.kind[i] + 1)?;
        for v in vectors.iter().filter_map(|v| v.0.as_ref()) {
            v[i].iter().try_for_each(|c| write!(w, " {c:?}"))?;
        }
        if let Some(e) = &atoms.energy {
            write!(w, " {:?}", e[i])?;
        }
        if several {
            write!(w, " {}", atoms.name(i))?;
        }
        if let Some(masses) = &masses {
            write!(w, " {:?}", masses[atoms.kind[i] as usize])?;
        }
        writeln!(w)?;
    }
    Ok(())
}

fn shrunk(s: &Snapshot) -> [[f64; 2]; 3] {
    let half = if s.spacing > 0.0 {
        0.5 * s.spacing
    } else {
        0.5
    };
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for x in positions(s).filter(|x| x.iter().all(|c| c.is_finite())) {
        for (b, c) in bounds.iter_mut().zip(x) {
            *b = [b[0].min(c), b[1].max(c)];
        }
    }
    bounds.map(|[low, high]| {
        if low <= high {
            [low - half, high + half]
        } else {
            [-half, half]
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::fields::tests::{small, with};
    use super::*;

    #[test]
    fn a_frame_reads_back() {
        let s = small();
        let mut file = Vec::new();
        write_frame(&mut file, &s, &DumpBox::default()).unwrap();
        let text = String::from_utf8(file).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[..4],
            ["ITEM: TIMESTEP", "7", "ITEM: NUMBER OF ATOMS", "3"]
        );
        assert_eq!(lines[4], "ITEM: BOX BOUNDS ss ss ss");
        assert_eq!(lines[5], "-0.25 0.75");
        let columns = "vx vy vz damage energy_density dilatation block body fragment";
        assert_eq!(lines[8], format!("ITEM: ATOMS id type x y z {columns}"));
        let rows: Vec<Vec<f64>> = lines[9..]
            .iter()
            .map(|l| l.split(' ').map(|c| c.parse().unwrap()).collect())
            .collect();
        let x: Vec<[f64; 3]> = positions(&s).collect();
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(row[0], i as f64 + 1.0);
            assert_eq!(row[2..5], x[i]);
            assert_eq!(row[5..8], s.vectors("velocity").unwrap()[i]);
            let others = &s.columns[2..];
            assert_eq!(row.len(), 8 + others.len());
            for (value, column) in row[8..].iter().zip(others) {
                assert_eq!(*value, column.values.at(i, 0), "{}", column.name());
            }
        }
        assert_eq!(
            rows.iter().map(|r| r[1]).collect::<Vec<_>>(),
            [1.0, 2.0, 6.0]
        );
    }

    #[test]
    fn a_given_box_is_kept() {
        let cell = DumpBox::periodic([0.0; 3], [Some(1.0), None, Some(2.0)]);
        let mut file = Vec::new();
        write_frame(&mut file, &small(), &cell).unwrap();
        let text = String::from_utf8(file).unwrap();
        assert!(text.contains("BOX BOUNDS pp ss pp\n0.0 1.0\n"));
        assert!(text.contains("\n0.0 2.0\nITEM: ATOMS"));
    }

    #[test]
    fn a_point_gone_to_infinity_does_not_take_the_box_along() {
        let mut u = small().displacement().to_vec();
        u[2][0] = f64::INFINITY;
        let s = with(small(), "displacement", Values::Vectors(u));
        assert_eq!(shrunk(&s)[0], [-0.15, 0.75]);
    }
}
