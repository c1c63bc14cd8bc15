//! A grid as VTK cells, each with the fields at its centre: an image (`.vti`) where the cell is along the axes, else a structured grid
//! (`.vts`). Raw appended binary, little-endian, 64-bit headers; every block is its length in bytes and its numbers.

use super::columns::Table;
use crate::write::atomic::WriteError;
use crate::write::grown::{Seal, write_sealed};
use peridyne_fields::Cell;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes `stem.vti` or `stem.vts` into the folder and says which, and what is in it; nothing for points that are no grid.
///
/// # Errors
/// The operating system's.
pub fn write_image(
    dir: &Path,
    stem: &str,
    table: &Table,
    time: Option<f64>,
) -> Result<Option<(PathBuf, Seal)>, WriteError> {
    let Some((n, cell)) = &table.grid else {
        return Ok(None);
    };
    let image = cell.is_orthogonal() && (0..3).all(|a| cell.edges[a][a] > 0.0);
    let path = dir.join(format!("{stem}.{}", if image { "vti" } else { "vts" }));
    let seal = write_sealed(&path, |w| grid(w, table, *n, cell, image, time))?;
    Ok(Some((path, seal)))
}

fn grid<W: Write>(
    w: &mut W,
    table: &Table,
    n: [usize; 3],
    cell: &Cell,
    image: bool,
    time: Option<f64>,
) -> io::Result<()> {
    let kind = if image { "ImageData" } else { "StructuredGrid" };
    let extent = format!("0 {} 0 {} 0 {}", n[0], n[1], n[2]);
    writeln!(w, r#"<?xml version="1.0"?>"#)?;
    writeln!(
        w,
        r#"<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#
    )?;
    match image {
        true => {
            let step: [f64; 3] = std::array::from_fn(|a| cell.edges[a][a] / n[a] as f64);
            let o = cell.origin;
            writeln!(
                w,
                r#"<ImageData WholeExtent="{extent}" Origin="{:?} {:?} {:?}" Spacing="{:?} {:?} {:?}">"#,
                o[0], o[1], o[2], step[0], step[1], step[2]
            )?;
        }
        false => writeln!(w, r#"<StructuredGrid WholeExtent="{extent}">"#)?,
    }
    if let Some(time) = time {
        writeln!(
            w,
            r#"<FieldData><DataArray NumberOfTuples="1" format="ascii" type="Float64" Name="TimeValue">{time:?}</DataArray></FieldData>"#
        )?;
    }
    writeln!(w, r#"<Piece Extent="{extent}"><CellData>"#)?;
    let there = || {
        let columns = table.columns.iter();
        columns.filter_map(|c| c.values.as_ref().ok().map(|v| (c, v)))
    };
    let mut offset = 0;
    for (column, values) in there() {
        writeln!(
            w,
            r#"<DataArray type="Float64" Name="{}" NumberOfComponents="{}" format="appended" offset="{offset}"/>"#,
            column.name,
            column.quantity.components()
        )?;
        offset += 8 + 8 * values.len();
    }
    writeln!(w, "</CellData>")?;
    if !image {
        writeln!(
            w,
            r#"<Points><DataArray type="Float64" Name="position" NumberOfComponents="3" format="appended" offset="{offset}"/></Points>"#
        )?;
    }
    write!(w, "</Piece>\n</{kind}>\n<AppendedData encoding=\"raw\">\n_")?;
    for (_, values) in there() {
        w.write_all(&(8 * values.len() as u64).to_le_bytes())?;
        for value in values {
            w.write_all(&value.to_le_bytes())?;
        }
    }
    if !image {
        let corners = (n[0] + 1) * (n[1] + 1) * (n[2] + 1);
        w.write_all(&(24 * corners as u64).to_le_bytes())?;
        for k in 0..=n[2] {
            for j in 0..=n[1] {
                for i in 0..=n[0] {
                    let part = |k: usize, n: usize| k as f64 / n as f64;
                    for c in cell.at([part(i, n[0]), part(j, n[1]), part(k, n[2])]) {
                        w.write_all(&c.to_le_bytes())?;
                    }
                }
            }
        }
    }
    w.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}
