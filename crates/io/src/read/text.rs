//! Plain text: `x y z volume [block_id]` per line, `#` starts a comment; a first line of names puts the columns into another order.

use super::Cells;
use super::body::Sourced;
use super::error::ReadError;
use super::lines::Lines;
use super::number::{comma, decimal_commas, number};
use super::spacing::Spacing;
use peridyne::spec::Cloud;

/// What a column is, and how it may be called.
const NAMES: [(Column, &[&str]); 6] = [
    (Column::X, &["x"]),
    (Column::Y, &["y"]),
    (Column::Z, &["z"]),
    (Column::Volume, &["volume", "vol", "v"]),
    (Column::Mark, &["mark", "block", "block_id", "material"]),
    (Column::Id, &["id", "number", "point"]),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    X,
    Y,
    Z,
    Volume,
    Mark,
    Id,
}

const USUAL: [Column; 5] = [
    Column::X,
    Column::Y,
    Column::Z,
    Column::Volume,
    Column::Mark,
];

/// The columns that a line names; `None`: it says something else.
fn named(line: &str) -> Option<Vec<Column>> {
    let line = line.trim().trim_start_matches('#').trim();
    let line = line.strip_prefix("header:").unwrap_or(line);
    let of = |word: &str| {
        let word = word.to_lowercase();
        let found = NAMES.iter().find(|(_, names)| names.contains(&&*word));
        found.map(|(column, _)| *column)
    };
    let words = fields(line).into_iter();
    let all: Vec<Column> = words.map(of).collect::<Option<_>>()?;
    let needed = [Column::X, Column::Y, Column::Volume];
    let once = |c: &Column| all.iter().filter(|a| *a == c).count() == 1;
    (needed.iter().all(once) && all.iter().all(once)).then_some(all)
}

fn fields(line: &str) -> Vec<&str> {
    let all = line.split([' ', '\t', ',', ';']);
    all.filter(|f| !f.is_empty()).collect()
}

/// How to say which column is which.
const SAY: &str = "name the columns in the first line if they are others, in their order: `# x y z volume block_id` (id: one that says nothing)";

#[derive(Default)]
struct Reader {
    cloud: Cloud,
    /// Lines of the points.
    sources: Vec<usize>,
    /// The mark as a number.
    marks: Vec<f64>,
}

pub(super) fn parse(text: &str, name: &str) -> Result<Sourced, ReadError> {
    let mut lines = Lines::new(text, name);
    let mut reader = Reader::default();
    let (mut columns, mut told) = (None, false);
    while let Some(line) = lines.next() {
        if columns.is_none()
            && (line.starts_with('#') || line.starts_with("header:"))
            && let Some(all) = named(line)
        {
            (columns, told) = (Some(all), true);
            continue;
        }
        let line = line.split('#').next().unwrap_or("");
        let words = fields(line);
        if words.is_empty() {
            continue;
        }
        if columns.is_none() && words.iter().all(|f| number(f).is_none()) && comma(line).is_empty()
        {
            return Err(lines.error(format!(
                "expected `x y z volume [block_id]` as numbers, found the words `{}`: a header begins with #, write `# {}`",
                line.trim(),
                line.trim()
            )));
        }
        if decimal_commas(line) {
            return Err(lines.error(format!(
                "found `{}`: are these decimal commas? Numbers have a point: 1.5, not 1,5",
                line.trim()
            )));
        }
        if !told && !(4..=5).contains(&words.len()) {
            return Err(lines.error(format!(
                "expected `x y z volume [block_id]`, found {} columns; {SAY}",
                words.len()
            )));
        }
        let columns = columns.get_or_insert_with(|| USUAL[..words.len()].to_vec());
        if words.len() != columns.len() {
            let (count, wanted) = (words.len(), columns.len());
            return Err(lines.error(match told {
                true => format!("{count} columns, where the first line names {wanted}"),
                false => format!("{count} columns, where the lines before have {wanted}"),
            }));
        }
        reader.point(&lines, columns, &words, told)?;
    }
    if reader.sources.is_empty() {
        return Err(ReadError {
            file: name.into(),
            line: None,
            message: "the file has no points".into(),
        });
    }
    if !told && let Some(lint) = reader.lint() {
        return Err(lines.error_at(reader.sources[0], format!("{lint}; {SAY}")));
    }
    Ok(Sourced {
        atoms: None,
        cloud: reader.cloud,
        dimension: None,
        ends: None,
        cells: Cells::default(),
        lines: reader.sources,
        notes: vec![],
    })
}

impl Reader {
    fn point(
        &mut self,
        lines: &Lines,
        columns: &[Column],
        words: &[&str],
        told: bool,
    ) -> Result<(), ReadError> {
        let mut x = [0.0; 3];
        let say = match told {
            true => String::new(),
            false => format!("; the columns are taken as x y z volume [block_id]: {SAY}"),
        };
        for (column, word) in columns.iter().zip(words) {
            match column {
                Column::X => x[0] = lines.finite(Some(word), "x")?,
                Column::Y => x[1] = lines.finite(Some(word), "y")?,
                Column::Z => x[2] = lines.finite(Some(word), "z")?,
                Column::Volume => {
                    let volume = lines.finite(Some(word), "the volume")?;
                    if volume <= 0.0 {
                        return Err(lines
                            .error(format!("the volume must be positive, it is {volume}{say}")));
                    }
                    self.cloud.volume.push(volume);
                }
                Column::Mark => {
                    let what = "a whole number as block id";
                    // programs that write every number alike write 1.0
                    let mark = number(word).filter(|m| m.fract() == 0.0 && m.abs() < 2e9);
                    let mark = mark.ok_or_else(|| {
                        lines.error(format!("expected {what}, found `{word}`{say}"))
                    })?;
                    self.marks.push(mark);
                    self.cloud.mark.push(mark as i32);
                }
                Column::Id => {}
            }
        }
        self.cloud.position.push(x);
        self.sources.push(lines.number);
        Ok(())
    }

    /// Why the columns are likely others than `x y z volume [block_id]`.
    fn lint(&self) -> Option<String> {
        let Cloud {
            position, volume, ..
        } = &self.cloud;
        let spacing = Spacing::new(position);
        let counts = { position.windows(2) }.all(|w| w[1][0] - w[0][0] == 1.0);
        if position.len() > 3 && counts && spacing.dimension() > 1 {
            return Some(format!(
                "the first column counts the lines ({}, {}, …), and is taken as x",
                position[0][0], position[1][0]
            ));
        }
        if let Some(lint) = self.doubtful_z() {
            return Some(lint);
        }
        let whole = |v: &f64| v.fract() == 0.0;
        let least = volume.iter().copied().fold(f64::INFINITY, f64::min);
        let blocks = least == 1.0 || volume.iter().any(|v| *v != volume[0]);
        if !blocks
            || self.marks.is_empty()
            || !volume.iter().all(whole)
            || !self.marks.iter().all(|m| *m > 0.0)
        {
            return None;
        }
        // as x y z block volume, the order of Peridigm
        let own = spacing.excess(volume, Some(volume)).abs();
        let other = spacing.excess(&self.marks, Some(volume)).abs();
        (own > other + FITS).then(|| {
            format!(
                "the fourth column, taken as volumes, has only whole numbers, and the fifth fits the distances of the points better ({} and {} in this line): is the order x y z block volume, as in Peridigm's text meshes?",
                volume[0], self.marks[0]
            )
        })
    }

    /// Numbers of blocks in place of z: few, whole, and no two points above each other.
    fn doubtful_z(&self) -> Option<String> {
        let position = &self.cloud.position;
        let whole = |a: usize| position.iter().all(|x| x[a].fract() == 0.0);
        let mut z: Vec<f64> = position.iter().map(|x| x[2]).collect();
        z.sort_by(f64::total_cmp);
        z.dedup();
        let few = (2..=100).contains(&z.len()) && 2 * z.len() <= position.len();
        if !few || z[0] < 0.0 || !whole(2) || (whole(0) && whole(1)) {
            return None;
        }
        let bits = |x: &[f64; 3]| [x[0] + 0.0, x[1] + 0.0].map(f64::to_bits);
        let below: std::collections::HashSet<_> = position.iter().map(bits).collect();
        (below.len() == position.len()).then(|| {
            format!(
                "the third column, taken as z, has only the whole numbers {} to {}, and no two points lie above each other: are they blocks of a plane (x y block volume, as in PeriLab's text meshes)?",
                z[0],
                z[z.len() - 1]
            )
        })
    }
}

/// Logarithm of a factor by which volumes may well differ from the cube of a distance.
const FITS: f64 = 0.3;
