//! How a file is laid out: what is in the head, what stays, and where frames and the nodes that find them come to be.

use std::io::{self, Write};

use peridyne::observe::{Snapshot, Values};

use crate::hdf5::{Attribute, Chunks, Dataset, Head, Number, Storage, Tree};
use crate::write::fields::{fields, integers, invalid};

/// Vertices, as VTK numbers cells.
const VERTEX: u8 = 1;
/// The version of the format that is written, of which the last thing that is needed are `Attribute`s of fields.
const VERSION: [i64; 2] = [2, 6];
/// Rows of a chunk of what has one number per frame.
pub const PART: u64 = 64;
/// Bytes that a chunk of a frame has at most; the format counts them in 32 bits.
pub const LARGEST: u64 = 1 << 31;
/// What a disk writes whole or not at all.
pub const SECTOR: usize = 512;
/// Columns of numbers of frames: where points and field data begin, steps, times.
pub const COUNTED: u64 = 4;

/// A column of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    name: String,
    number: Number,
    components: u64,
}

impl Column {
    pub fn of(name: &str, values: &Values) -> Column {
        let number = match values {
            Values::Integers(_) => Number::I32,
            Values::Counts(_) => Number::U32,
            Values::Scalars(_) | Values::Vectors(_) | Values::Symmetric(_) | Values::Tensors(_) => {
                Number::F64
            }
        };
        Column {
            name: name.to_string(),
            number,
            components: values.shape().components().len().max(1) as u64,
        }
    }

    /// Bytes of a row.
    pub fn width(&self) -> u64 {
        self.number.size() * self.components
    }

    pub fn dimensions(&self, rows: u64) -> Vec<u64> {
        match self.components {
            1 => vec![rows],
            n => vec![rows, n],
        }
    }
}

/// What every frame has.
#[derive(Debug)]
pub struct Frame {
    pub points: u64,
    /// Positions, then fields.
    pub columns: Vec<Column>,
    /// Chunks of a column, and their rows: together at least as many as points.
    pub chunks: u64,
    pub rows: u64,
}

impl Frame {
    pub fn of(s: &Snapshot, largest: u64) -> io::Result<Frame> {
        let mut columns = vec![Column {
            name: "position".into(),
            number: Number::F64,
            components: 3,
        }];
        let all = fields(s)?;
        columns.extend(all.iter().map(|c| Column::of(c.name(), &c.values)));
        // a name is a link in a group
        let odd = |name: &str| name.is_empty() || name.contains('/') || name.len() > 255;
        if let Some(column) = all.iter().find(|c| odd(c.name())) {
            let name = column.name();
            return Err(invalid(format!("{name:?} is no name of a dataset")));
        }
        let points = s.reference.len() as u64;
        let widest = columns.iter().map(Column::width).max().unwrap_or(1);
        let chunks = (points * widest).div_ceil(largest).max(1);
        let rows = points.div_ceil(chunks).max(1);
        Ok(Frame {
            points,
            columns,
            chunks,
            rows,
        })
    }

    pub fn fields(&self) -> &[Column] {
        &self.columns[1..]
    }

    /// Rows of a frame in a column.
    pub fn all_rows(&self) -> u64 {
        self.chunks * self.rows
    }

    /// Bytes of a column in a frame.
    pub fn bytes(&self, column: &Column) -> u64 {
        (self.all_rows() * column.width()).next_multiple_of(8)
    }

    /// Bytes of a frame.
    pub fn all_bytes(&self) -> u64 {
        self.columns.iter().map(|c| self.bytes(c)).sum()
    }

    /// Chunks of a column.
    pub fn chunks_of(&self, column: &Column) -> Chunks {
        Chunks {
            rank: column.dimensions(0).len() as u64,
            rows: self.rows,
            bytes: self.rows * column.width(),
        }
    }
}

/// Chunks of columns that have one number per frame.
pub const PARTS: Chunks = Chunks {
    rank: 1,
    rows: PART,
    bytes: 8 * PART,
};

/// Where what grows is in the file.
#[derive(Debug, Clone, Default)]
pub struct Places {
    /// Trees of the columns of a frame, side by side.
    pub frames: Tree,
    /// Trees of what has one number per frame.
    pub parts: Tree,
    /// Chunks of these.
    pub part: Vec<u64>,
    /// Numbers of each frame.
    pub frame: Vec<u64>,
    /// Length of the file.
    pub end: u64,
}

impl Places {
    /// Makes room for a frame.
    pub fn grow(&mut self, of: &Frame) {
        let end = &mut self.end;
        let mut room = |bytes: u64| {
            let at = *end;
            *end += bytes;
            at
        };
        let nodes = of.columns.iter().map(|c| of.chunks_of(c).node()).sum();
        self.frames.grow(of.chunks, || room(nodes));
        if (self.frame.len() as u64).is_multiple_of(PART) {
            self.parts.grow(1, || room(COUNTED * PARTS.node()));
            self.part.push(room(COUNTED * PARTS.bytes));
        }
        self.frame.push(room(of.all_bytes()));
    }
}

/// Bytes of what stays, in its order: how many points, ends of cells, points of cells, ids, types.
fn fixed_bytes(points: u64) -> [u64; 5] {
    [8, 8 * (points + 1), 8 * points, 8 * points, points]
}

/// Length of what stays.
pub fn fixed(points: u64) -> u64 {
    fixed_bytes(points).iter().sum::<u64>().next_multiple_of(8)
}

/// Writes what stays.
///
/// # Errors
/// Those of `w`.
pub fn write_fixed(w: &mut impl Write, points: u64) -> io::Result<()> {
    let n = points as i64;
    integers(w, [n].into_iter())?;
    integers(w, 0..=n)?;
    integers(w, 0..n)?;
    integers(w, 1..=n)?;
    (0..n).try_for_each(|_| w.write_all(&[VERTEX]))?;
    let rest = fixed(points) - fixed_bytes(points).iter().sum::<u64>();
    (0..rest).try_for_each(|_| w.write_all(&[0]))
}

/// The head of a file in which what stays begins at `start`, for so many frames, and so many that are told as steps. Heads that tell of other
/// numbers of steps differ in one sector: VTK takes all times there are and room for as many as there are steps.
pub fn head(frame: &Frame, places: &Places, start: u64, [there, told]: [u64; 2]) -> Vec<u8> {
    let mut head = Head::new();
    let mut at = start;
    let [count, offsets, connectivity, ids, types] = fixed_bytes(frame.points).map(|bytes| {
        at += bytes;
        at - bytes
    });
    let mut piece = |number, length, address, links| {
        head.dataset(&Dataset {
            number,
            dimensions: &[length],
            storage: Storage::Piece(address),
            attributes: &[],
            links,
        })
    };
    let n = frame.points;
    // a vertex is of one point: as many points, cells and points of cells
    let count = piece(Number::I64, 1, count, 3);
    let offsets = piece(Number::I64, n + 1, offsets, 1);
    let connectivity = piece(Number::I64, n, connectivity, 1);
    let ids = piece(Number::I64, n, ids, 1);
    let types = piece(Number::U8, n, types, 1);
    let (points, mut data) = columns(&mut head, frame, places, there);
    data.push(("id", ids));
    let data = head.group(&[], &data);
    let steps = Counted::of(&mut head, frame, places, there);
    let field = head.group(&[], &[("step", steps.step)]);
    let steps = steps.group(&mut head, frame, places, told);
    let attributes = [
        ("Version", Attribute::Many(&VERSION)),
        ("Type", Attribute::Text("UnstructuredGrid")),
    ];
    let children = [
        ("NumberOfPoints", count),
        ("NumberOfCells", count),
        ("NumberOfConnectivityIds", count),
        ("Points", points),
        ("Connectivity", connectivity),
        ("Offsets", offsets),
        ("Types", types),
        ("PointData", data),
        ("FieldData", field),
        ("Steps", steps),
    ];
    let grid = head.group(&attributes, &children);
    let root = head.group(&[], &[("VTKHDF", grid)]);
    head.finish(root, places.end)
}

/// Positions, and fields by name.
fn columns<'a>(
    head: &mut Head,
    frame: &'a Frame,
    places: &Places,
    there: u64,
) -> (u64, Vec<(&'a str, u64)>) {
    let mut behind = 0;
    let mut points = 0;
    let mut data = vec![];
    for (k, column) in frame.columns.iter().enumerate() {
        // as in a VTU, what ParaView shows first
        let attributes = match &*column.name {
            "damage" => &[("Attribute", Attribute::Text("Scalars"))][..],
            "displacement" => &[("Attribute", Attribute::Text("Vectors"))],
            _ => &[],
        };
        let address = head.dataset(&Dataset {
            number: column.number,
            dimensions: &column.dimensions(there * frame.all_rows()),
            storage: Storage::Chunks {
                rows: frame.rows,
                tree: places.frames.root(behind),
            },
            attributes,
            links: 1,
        });
        behind += frame.chunks_of(column).node();
        match k {
            0 => points = address,
            _ => data.push((&*column.name, address)),
        }
    }
    (points, data)
}

/// Datasets with one number per frame.
struct Counted {
    /// Where its points begin, and its field data.
    points: u64,
    numbers: u64,
    step: u64,
    /// The same for all frames.
    zero: u64,
    one: u64,
    sizes: u64,
}

/// The dataset of one of the columns of numbers of frames, of so many frames.
fn counted(
    head: &mut Head,
    places: &Places,
    (n, number): (u64, Number),
    frames: u64,
    links: u32,
) -> u64 {
    let tree = places.parts.root(n * PARTS.node());
    head.dataset(&Dataset {
        number,
        dimensions: &[frames],
        storage: Storage::Chunks { rows: PART, tree },
        attributes: &[],
        links,
    })
}

impl Counted {
    fn of(head: &mut Head, frame: &Frame, places: &Places, there: u64) -> Counted {
        let fields = frame.fields().len() as u32;
        let mut column = |n, links| counted(head, places, (n, Number::I64), there, links);
        let points = column(0, 1 + fields);
        let numbers = column(1, 1);
        let step = column(2, 1);
        let mut all = |number, dimensions: &[u64], links| {
            head.dataset(&Dataset {
                number: Number::I64,
                dimensions,
                storage: Storage::All(number),
                attributes: &[],
                links,
            })
        };
        Counted {
            points,
            numbers,
            step,
            zero: all(0, &[there], 4),
            one: all(1, &[there], 1),
            sizes: all(1, &[there, 2], 1),
        }
    }

    /// The group that says what is of which frame.
    fn group(&self, head: &mut Head, frame: &Frame, places: &Places, told: u64) -> u64 {
        let fields = frame.fields().iter().map(|c| (&*c.name, self.points));
        let data: Vec<_> = fields.chain([("id", self.zero)]).collect();
        let data = head.group(&[], &data);
        let field = head.group(&[], &[("step", self.numbers)]);
        let sizes = head.group(&[], &[("step", self.sizes)]);
        head.align(SECTOR);
        let times = counted(head, places, (3, Number::F64), told, 1);
        let children = [
            ("Values", times),
            ("PartOffsets", self.zero),
            ("NumberOfParts", self.one),
            ("PointOffsets", self.points),
            ("CellOffsets", self.zero),
            ("ConnectivityIdOffsets", self.zero),
            ("PointDataOffsets", data),
            ("FieldDataOffsets", field),
            ("FieldDataSizes", sizes),
        ];
        let steps = [("NSteps", Attribute::One(told as i64))];
        head.group(&steps, &children)
    }
}
