//! VTK UnstructuredGrid (`.vtu`), raw appended binary, little-endian, 64-bit headers: ParaView, pyvista, VTK.
//!
//! Everything is streamed; nothing of the size of the body is allocated. Format: VTK file formats, "XML file
//! formats", appended data with `encoding="raw"`; every block is its length in bytes (u64) and its bytes.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::ops::Range;

use peridyne::observe::{Snapshot, Values};
use peridyne::run::ranks::Share;

use super::fields::{SYMMETRIC, fields, integers, invalid, rows, write_positions, write_values};
use super::grown::{Seal, Summed};
use crate::deck::{Dim, UnitSystem};
use crate::read::Cells;

const VERTEX: u8 = 1;
const LINE: u8 = 3;

/// What one block of appended data holds.
enum Block<'a> {
    Positions,
    Field(&'a Values),
    /// Numbers of the points, from 1 on, of those with these ids.
    Ids(Range<usize>),
    /// Corners of the points' cells, moved as the points are.
    Corners(&'a Shapes<'a>),
    /// Point numbers of cells that share no points.
    Vertices(Range<usize>),
    Lines(&'a [(u32, u32)]),
    /// Ends of these cells with `width` points each.
    Offsets {
        cells: Range<usize>,
        width: usize,
    },
    Types {
        cells: usize,
        kind: u8,
    },
    /// Ends and types of the cells of points.
    Ends(&'a Shapes<'a>),
    Kinds(&'a Shapes<'a>),
}

/// The cell of each point; one without is a vertex.
struct Shapes<'a> {
    cells: &'a Cells,
    of: Vec<Option<usize>>,
}

impl Shapes<'_> {
    /// Kind, corners in the reference, and number of a point.
    fn each(&self) -> impl Iterator<Item = (u8, Option<&[[f64; 3]]>, usize)> {
        self.of.iter().enumerate().map(|(i, cell)| match cell {
            Some(n) => {
                let (kind, corners) = self.cells.cell(*n);
                (kind, Some(corners), i)
            }
            None => (VERTEX, None, i),
        })
    }

    fn corners(&self) -> usize {
        let each = self.each();
        each.map(|(_, c, _)| c.map_or(1, <[_]>::len)).sum()
    }
}

/// What a grid is made of.
struct Topology<'a> {
    /// Points and cells in the file.
    points: usize,
    cells: usize,
    /// Where the fields of points go.
    section: &'static str,
    ids: Block<'a>,
    places: Block<'a>,
    connectivity: Block<'a>,
    offsets: Block<'a>,
    types: Block<'a>,
}

/// An array of the file: where it goes, name, what it measures, and contents. Blocks follow in the order of the header.
struct Array<'a> {
    section: &'static str,
    name: &'a str,
    dimension: Dim,
    block: Block<'a>,
}

/// Writes the points at their current positions as vertex cells, with all arrays the snapshot carries and `id`.
///
/// # Errors
/// Those of `w`; `InvalidInput` for arrays of unequal lengths.
pub fn write_points<W: Write>(w: &mut W, s: &Snapshot, units: UnitSystem) -> io::Result<()> {
    write_grid(w, s, of_points(0..s.reference.len()), units)
}

/// Vertices at the points with these ids.
fn of_points<'a>(ids: Range<usize>) -> Topology<'a> {
    Topology {
        points: ids.len(),
        cells: ids.len(),
        section: "PointData",
        ids: Block::Ids(ids.clone()),
        places: Block::Positions,
        connectivity: Block::Vertices(ids.clone()),
        types: Block::Types {
            cells: ids.len(),
            kind: VERTEX,
        },
        offsets: Block::Offsets {
            cells: ids,
            width: 1,
        },
    }
}

/// Bytes of a file from a place on, and what is in them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    pub at: u64,
    pub seal: Seal,
}

/// Writes, of the file that [`write_points`] would write of so many points, what is said of those of a snapshot, which are this share; whoever has the first
/// point writes what is said of all. The parts that it has written.
///
/// # Errors
/// The operating system's; `InvalidInput` for arrays of unequal lengths.
pub fn write_share(
    file: &mut File,
    s: &Snapshot,
    units: UnitSystem,
    Share { first, points }: Share,
) -> io::Result<Vec<Part>> {
    let own = s.reference.len();
    if own == 0 {
        return Ok(vec![]);
    }
    let (whole, topology) = (
        arrays(s, of_points(0..points))?,
        of_points(first..first + own),
    );
    let mut header = vec![];
    write_header(&mut header, s, (points, (points, points)), &whole, units)?;
    let mut parts = vec![];
    let mut put = |at: u64, write: &dyn Fn(&mut dyn Write) -> io::Result<()>| {
        file.seek(SeekFrom::Start(at))?;
        let mut summed = Summed::new(&mut *file);
        let mut room = BufWriter::with_capacity(1 << 18, &mut summed);
        write(&mut room)?;
        room.flush()?;
        drop(room);
        parts.push(Part {
            at,
            seal: summed.seal(),
        });
        io::Result::Ok(())
    };
    let speaks = first == 0;
    if speaks {
        put(0, &|w| w.write_all(&header))?;
    }
    let mut at = header.len() as u64;
    for (whole, of) in whole.iter().zip(arrays(s, topology)?) {
        let length = whole.block.bytes(points);
        if speaks {
            put(at, &|w| w.write_all(&length.to_le_bytes()))?;
        }
        // of every point as many
        let before = length / points as u64 * first as u64;
        put(at + 8 + before, &|w| of.block.write(&mut &mut *w, s))?;
        at += 8 + length;
    }
    if speaks {
        put(at, &|w| w.write_all(END))?;
    }
    Ok(parts)
}

/// Writes the cells of meshes that the points stand for, each moved as its point without turning, with all arrays the snapshot
/// carries and `id` on the cells. Cells share no corners: what breaks gapes. Points without a cell are vertices.
///
/// # Errors
/// Those of `w`; `InvalidInput` for arrays of unequal lengths.
pub fn write_cells<W: Write>(
    w: &mut W,
    s: &Snapshot,
    cells: &Cells,
    units: UnitSystem,
) -> io::Result<()> {
    let of = cells.of_points(&s.reference);
    let shapes = Shapes { cells, of };
    let corners = shapes.corners();
    let topology = Topology {
        points: corners,
        cells: s.reference.len(),
        section: "CellData",
        ids: Block::Ids(0..s.reference.len()),
        places: Block::Corners(&shapes),
        connectivity: Block::Vertices(0..corners),
        offsets: Block::Ends(&shapes),
        types: Block::Kinds(&shapes),
    };
    write_grid(w, s, topology, units)
}

/// Writes the unbroken bonds as line cells between the current positions, with the same arrays on the points.
/// A bond through a periodic boundary is a line across the body.
///
/// # Errors
/// Those of `w`; `InvalidInput` when the snapshot carries no bonds or arrays of unequal lengths.
pub fn write_bonds<W: Write>(w: &mut W, s: &Snapshot, units: UnitSystem) -> io::Result<()> {
    let bonds = s
        .bonds
        .as_deref()
        .ok_or_else(|| invalid("the snapshot carries no bonds".to_string()))?;
    let n = bonds.len();
    let topology = Topology {
        points: s.reference.len(),
        cells: n,
        section: "PointData",
        ids: Block::Ids(0..s.reference.len()),
        places: Block::Positions,
        connectivity: Block::Lines(bonds),
        offsets: Block::Offsets {
            cells: 0..n,
            width: 2,
        },
        types: Block::Types {
            cells: n,
            kind: LINE,
        },
    };
    write_grid(w, s, topology, units)
}

/// What comes after all arrays.
const END: &[u8] = b"\n</AppendedData>\n</VTKFile>\n";

fn write_grid<W: Write>(
    w: &mut W,
    s: &Snapshot,
    topology: Topology,
    units: UnitSystem,
) -> io::Result<()> {
    let (n, size) = (s.reference.len(), (topology.points, topology.cells));
    let arrays = arrays(s, topology)?;
    write_header(w, s, (n, size), &arrays, units)?;
    for array in &arrays {
        w.write_all(&array.block.bytes(n).to_le_bytes())?;
        array.block.write(w, s)?;
    }
    w.write_all(END)
}

/// The arrays of a file, in their order.
fn arrays<'a>(s: &'a Snapshot, topology: Topology<'a>) -> io::Result<Vec<Array<'a>>> {
    let mut arrays = Vec::new();
    for column in fields(s)? {
        arrays.push(Array {
            section: topology.section,
            name: column.name(),
            dimension: column.declaration.dimension,
            block: Block::Field(&column.values),
        });
    }
    arrays.push(Array {
        section: topology.section,
        name: "id",
        dimension: Dim::NUMBER,
        block: topology.ids,
    });
    arrays.push(Array {
        section: "Points",
        name: "position",
        dimension: Dim::LENGTH,
        block: topology.places,
    });
    for (name, block) in [
        ("connectivity", topology.connectivity),
        ("offsets", topology.offsets),
        ("types", topology.types),
    ] {
        arrays.push(Array {
            section: "Cells",
            name,
            dimension: Dim::NUMBER,
            block,
        });
    }
    Ok(arrays)
}

fn write_header<W: Write>(
    w: &mut W,
    s: &Snapshot,
    (n, (points, cells)): (usize, (usize, usize)),
    arrays: &[Array],
    units: UnitSystem,
) -> io::Result<()> {
    writeln!(w, r#"<?xml version="1.0"?>"#)?;
    writeln!(
        w,
        r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#
    )?;
    writeln!(w, "<UnstructuredGrid>\n<FieldData>")?;
    // `TimeValue` is the name by which ParaView and VTK know the time of a file
    let array = r#"<DataArray NumberOfTuples="1" format="ascii""#;
    writeln!(
        w,
        r#"{array} type="Float64" Name="TimeValue">{:?}</DataArray>"#,
        s.time
    )?;
    writeln!(
        w,
        r#"{array} type="Int64" Name="step">{}</DataArray>"#,
        s.step
    )?;
    writeln!(
        w,
        "</FieldData>\n<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">"
    )?;
    let mut offset = 0;
    let mut section = "";
    for a in arrays {
        if a.section != section {
            if !section.is_empty() {
                writeln!(w, "</{section}>")?;
            }
            section = a.section;
            let active = match section {
                "PointData" | "CellData" if s.column("damage").is_some() => {
                    r#" Scalars="damage" Vectors="displacement""#
                }
                "PointData" | "CellData" => r#" Vectors="displacement""#,
                _ => "",
            };
            writeln!(w, "<{section}{active}>")?;
        }
        let (kind, components) = a.block.kind();
        let end = match units.unit(a.dimension) {
            unit if unit.is_empty() => "/>".to_string(),
            // where VTK keeps the unit of an array
            unit => format!(
                r#"><InformationKey name="UNITS_LABEL" location="vtkDataArray">{unit}</InformationKey></DataArray>"#
            ),
        };
        writeln!(
            w,
            r#"<DataArray type="{kind}" Name="{}" NumberOfComponents="{components}"{} format="appended" offset="{offset}"{end}"#,
            a.name,
            a.block.names()
        )?;
        offset += 8 + a.block.bytes(n);
    }
    write!(
        w,
        "</{section}>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_"
    )
}

impl Block<'_> {
    /// VTK's name of the number type, and the number of components.
    fn kind(&self) -> (&'static str, usize) {
        match self {
            Block::Positions | Block::Corners(_) => ("Float64", 3),
            Block::Field(values) => match values {
                Values::Scalars(_) => ("Float64", 1),
                Values::Vectors(_) => ("Float64", 3),
                Values::Symmetric(_) => ("Float64", 6),
                Values::Tensors(_) => ("Float64", 9),
                Values::Integers(_) => ("Int32", 1),
                Values::Counts(_) => ("UInt32", 1),
            },
            Block::Ids(_)
            | Block::Vertices(_)
            | Block::Lines(_)
            | Block::Offsets { .. }
            | Block::Ends(_) => ("Int64", 1),
            Block::Types { .. } | Block::Kinds(_) => ("UInt8", 1),
        }
    }

    /// What the components of tensors are called.
    fn names(&self) -> String {
        let Block::Field(values) = self else {
            return String::new();
        };
        let names = values.shape().components();
        let order: Vec<usize> = match values {
            Values::Symmetric(_) => SYMMETRIC.to_vec(),
            Values::Tensors(_) => (0..names.len()).collect(),
            Values::Scalars(_) | Values::Vectors(_) | Values::Integers(_) | Values::Counts(_) => {
                vec![]
            }
        };
        let named = order.iter().enumerate();
        let of = |(k, c): (usize, &usize)| format!(r#" ComponentName{k}="{}""#, names[*c]);
        named.map(of).collect()
    }

    /// Length in bytes, for `n` points.
    fn bytes(&self, n: usize) -> u64 {
        let bytes = match self {
            Block::Positions => 24 * n,
            Block::Field(values) => match values {
                Values::Scalars(_) => 8 * n,
                Values::Vectors(_) => 24 * n,
                Values::Symmetric(_) => 48 * n,
                Values::Tensors(_) => 72 * n,
                Values::Integers(_) | Values::Counts(_) => 4 * n,
            },
            Block::Ids(ids) | Block::Vertices(ids) => 8 * ids.len(),
            Block::Lines(bonds) => 16 * bonds.len(),
            Block::Offsets { cells, .. } => 8 * cells.len(),
            Block::Types { cells, .. } => *cells,
            Block::Corners(shapes) => 24 * shapes.corners(),
            Block::Ends(shapes) => 8 * shapes.of.len(),
            Block::Kinds(shapes) => shapes.of.len(),
        };
        bytes as u64
    }

    /// Its numbers, without their length before them.
    fn write<W: Write>(&self, w: &mut W, s: &Snapshot) -> io::Result<()> {
        match self {
            Block::Positions => write_positions(w, s),
            Block::Field(values) => write_values(w, values),
            Block::Ids(ids) => integers(w, ids.clone().map(|id| id as i64 + 1)),
            Block::Vertices(ids) => integers(w, ids.clone().map(|id| id as i64)),
            Block::Lines(bonds) => {
                integers(w, bonds.iter().flat_map(|&(i, j)| [i.into(), j.into()]))
            }
            Block::Offsets { cells, width } => {
                integers(w, cells.clone().map(|c| ((c + 1) * width) as i64))
            }
            Block::Types { cells, kind } => (0..*cells).try_for_each(|_| w.write_all(&[*kind])),
            Block::Corners(shapes) => {
                let (x, u) = (&s.reference, s.displacement());
                let moved = shapes.each().flat_map(|(_, corners, i)| {
                    let corners = corners.unwrap_or(std::slice::from_ref(&x[i]));
                    let by = u[i];
                    corners.iter().map(move |c| [0, 1, 2].map(|a| c[a] + by[a]))
                });
                rows(w, moved)
            }
            Block::Ends(shapes) => {
                let mut end = 0;
                let ends = shapes.each().map(|(_, corners, _)| {
                    end += corners.map_or(1, <[_]>::len) as i64;
                    end
                });
                integers(w, ends)
            }
            Block::Kinds(shapes) => shapes
                .each()
                .try_for_each(|(kind, ..)| w.write_all(&[kind])),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::fields::positions;
    use super::super::fields::tests::{put, small};
    use super::*;
    use crate::deck::Constants;

    /// Reads an attribute of the `<DataArray>` with this name.
    fn attribute<'a>(header: &'a str, array: &str, key: &str) -> &'a str {
        let at = header
            .find(&format!("Name=\"{array}\""))
            .unwrap_or_else(|| panic!("no {array}"));
        let start = header[..at].rfind('<').unwrap();
        let tag = &header[start..start + header[start..].find('>').unwrap()];
        let value = tag.find(&format!("{key}=\"")).unwrap() + key.len() + 2;
        &tag[value..value + tag[value..].find('"').unwrap()]
    }

    /// The bytes of an appended array, read through its offset as a reader does.
    pub fn appended(file: &[u8], array: &str) -> Vec<u8> {
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let start = file.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
        let header = std::str::from_utf8(&file[..start]).unwrap();
        let at = start + attribute(header, array, "offset").parse::<usize>().unwrap();
        let length = u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
        file[at + 8..at + 8 + length].to_vec()
    }

    pub fn floats(file: &[u8], array: &str) -> Vec<f64> {
        let bytes = appended(file, array);
        bytes
            .chunks_exact(8)
            .map(|b| f64::from_le_bytes(b.try_into().unwrap()))
            .collect()
    }

    fn integers(file: &[u8], array: &str) -> Vec<i64> {
        let bytes = appended(file, array);
        bytes
            .chunks_exact(8)
            .map(|b| i64::from_le_bytes(b.try_into().unwrap()))
            .collect()
    }

    #[test]
    fn points_come_back() {
        let s = small();
        let mut file = Vec::new();
        write_points(&mut file, &s, UnitSystem::Si).unwrap();
        assert_eq!(
            floats(&file, "position"),
            positions(&s).flatten().collect::<Vec<_>>()
        );
        for name in ["displacement", "velocity"] {
            assert_eq!(floats(&file, name), s.vectors(name).unwrap().concat());
        }
        for name in ["damage", "energy_density", "dilatation"] {
            assert_eq!(floats(&file, name), s.scalars(name).unwrap());
        }
        assert_eq!(
            appended(&file, "block"),
            [[255; 4], [0; 4], [4, 0, 0, 0]].concat()
        );
        assert_eq!(
            appended(&file, "body"),
            [[0; 4], [1, 0, 0, 0], [1, 0, 0, 0]].concat()
        );
        assert_eq!(
            appended(&file, "fragment"),
            [[0; 4], [0; 4], [1, 0, 0, 0]].concat()
        );
        assert_eq!(integers(&file, "id"), [1, 2, 3]);
        assert_eq!(integers(&file, "connectivity"), [0, 1, 2]);
        assert_eq!(integers(&file, "offsets"), [1, 2, 3]);
        assert_eq!(appended(&file, "types"), [1, 1, 1]);
        assert!(file.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));
    }

    #[test]
    fn cells_of_a_mesh_move_with_their_points() {
        let s = small();
        let mut cells = Cells::default();
        let triangle = [[-0.1, 0.4, 0.25], [0.2, 0.4, 0.25], [-0.1, 0.7, 0.25]];
        cells.push(5, triangle.into_iter(), s.reference[2]);
        let square = [
            [-0.2, -0.2, 0.0],
            [0.2, -0.2, 0.0],
            [0.2, 0.2, 0.0],
            [-0.2, 0.2, 0.0],
        ];
        cells.push(9, square.into_iter(), [-0.0; 3]);
        let mut file = Vec::new();
        write_cells(&mut file, &s, &cells, UnitSystem::Si).unwrap();
        let header = String::from_utf8_lossy(&file);
        assert!(header.contains(r#"NumberOfPoints="8" NumberOfCells="3""#));
        assert!(header.contains("<CellData ") && !header.contains("PointData"));
        // the second point has no cell
        assert_eq!(appended(&file, "types"), [9, 1, 5]);
        assert_eq!(integers(&file, "offsets"), [4, 5, 8]);
        assert_eq!(integers(&file, "connectivity"), (0..8).collect::<Vec<_>>());
        let u = s.displacement();
        let moved = |x: [f64; 3], i: usize| [x[0] + u[i][0], x[1] + u[i][1], x[2] + u[i][2]];
        let all = square.map(|x| moved(x, 0)).into_iter();
        let all = all.chain([moved(s.reference[1], 1)]);
        let all: Vec<f64> = all.chain(triangle.map(|x| moved(x, 2))).flatten().collect();
        assert_eq!(floats(&file, "position"), all);
        assert_eq!(floats(&file, "damage"), s.scalars("damage").unwrap());
    }

    #[test]
    fn tensors_stand_in_the_order_of_vtk() {
        let mut s = small();
        put(
            &mut s,
            "stress",
            Values::Symmetric(vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]; 3]),
        );
        let rows = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        put(&mut s, "gradient", Values::Tensors(vec![rows; 3]));
        let mut file = Vec::new();
        write_points(&mut file, &s, UnitSystem::Si).unwrap();
        assert_eq!(floats(&file, "stress")[..6], [1.0, 2.0, 3.0, 4.0, 6.0, 5.0]);
        assert_eq!(floats(&file, "gradient")[9..18], rows);
        let header = String::from_utf8_lossy(&file);
        assert_eq!(attribute(&header, "stress", "ComponentName4"), "yz");
        assert_eq!(attribute(&header, "gradient", "ComponentName3"), "yx");
    }

    #[test]
    fn header_says_what_is_there() {
        let mut file = Vec::new();
        write_bonds(&mut file, &small(), UnitSystem::Si).unwrap();
        let header = String::from_utf8_lossy(&file);
        assert!(header.contains(r#"NumberOfPoints="3" NumberOfCells="2""#));
        assert!(header.contains(r#"byte_order="LittleEndian" header_type="UInt64""#));
        assert!(header.contains(r#"Name="TimeValue">1.5e-7<"#));
        assert_eq!(
            attribute(&header, "displacement", "NumberOfComponents"),
            "3"
        );
        assert_eq!(attribute(&header, "block", "type"), "Int32");
    }

    #[test]
    fn arrays_say_their_units() {
        let mut s = small();
        let of = |name: &str, dimension| {
            let column = s.columns.iter().find(|c| c.name() == name).unwrap();
            let mut column = column.clone();
            column.declaration.dimension = dimension;
            column
        };
        s.columns = vec![
            of("displacement", Dim::LENGTH),
            of("velocity", Dim::VELOCITY),
            of("damage", Dim::NUMBER),
        ];
        let units = |units: UnitSystem| -> Vec<String> {
            let mut file = Vec::new();
            write_points(&mut file, &s, units).unwrap();
            let header = String::from_utf8_lossy(&file).into_owned();
            let of = |name: &str| {
                let (_, tag) = header.split_once(&format!("Name=\"{name}\"")).unwrap();
                let (line, _) = tag.split_once('\n').unwrap();
                let key = r#"<InformationKey name="UNITS_LABEL" location="vtkDataArray">"#;
                line.split_once(key)
                    .map(|(_, rest)| rest.split_once('<').unwrap().0.to_string())
                    .unwrap_or_default()
            };
            ["displacement", "velocity", "damage", "position", "id"]
                .map(of)
                .into()
        };
        assert_eq!(units(UnitSystem::Si), ["m", "m/s", "", "m", ""]);
        let metal = UnitSystem::Metal(Constants::default());
        assert_eq!(units(metal), ["Å", "Å ps^-1", "", "Å", ""]);
        assert_eq!(units(UnitSystem::None), [""; 5]);
    }

    #[test]
    fn bonds_come_back() {
        let mut file = Vec::new();
        write_bonds(&mut file, &small(), UnitSystem::Si).unwrap();
        assert_eq!(integers(&file, "connectivity"), [0, 1, 1, 2]);
        assert_eq!(integers(&file, "offsets"), [2, 4]);
        assert_eq!(appended(&file, "types"), [3, 3]);
        let none = Snapshot {
            bonds: None,
            ..small()
        };
        assert!(
            write_bonds(&mut Vec::new(), &none, UnitSystem::Si)
                .unwrap_err()
                .to_string()
                .contains("no bonds")
        );
    }

    #[test]
    fn a_full_disk_stops_the_writer_wherever_it_strikes() {
        struct Limited(usize);
        impl Write for Limited {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                match self.0.min(bytes.len()) {
                    0 => Err(io::ErrorKind::StorageFull.into()),
                    n => {
                        self.0 -= n;
                        Ok(n)
                    }
                }
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let mut whole = Vec::new();
        write_points(&mut whole, &small(), UnitSystem::Si).unwrap();
        for room in 0..whole.len() {
            let error = write_points(&mut Limited(room), &small(), UnitSystem::Si).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::StorageFull);
        }
        write_points(&mut Limited(whole.len()), &small(), UnitSystem::Si).unwrap();
    }
}
