//! `read_dump`: positions and velocities from a snapshot of a dump file.

use std::io::BufRead;

use peridyne_io::read::lammps::{Lines, Result, finite};

/// The asked columns of one snapshot.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    pub low: [f64; 3],
    pub high: [f64; 3],
    pub ids: Vec<u64>,
    /// `[column][atom]`
    pub columns: Vec<Vec<f64>>,
}

/// Reads the snapshot of `step`; a wanted column has alternatives, the first that the file has is taken and
/// its place among the alternatives is told.
///
/// # Errors
/// File and line of the first mistake; no such step.
pub fn read_frame(
    reader: impl BufRead,
    path: &str,
    step: u64,
    wanted: &[Vec<String>],
) -> Result<(Frame, Vec<usize>)> {
    let mut lines = Lines::new(reader, path);
    let mut seen: Vec<u64> = Vec::new();
    loop {
        let Some(now) = next_step(&mut lines)? else {
            let known: Vec<String> = seen
                .iter()
                .rev()
                .take(10)
                .rev()
                .map(u64::to_string)
                .collect();
            lines.text.clear();
            return Err(lines
                .fail(format!("there is no snapshot of step {step}"))
                .help(format!("the last steps in the file: {}", known.join(", "))));
        };
        seen.push(now);
        expect_item(&mut lines, "ITEM: NUMBER OF ATOMS")?;
        let count: usize = number(&mut lines)?;
        let item = expect_item(&mut lines, "ITEM: BOX BOUNDS")?;
        if item.contains("xy") || item.contains("abc") {
            return Err(lines.fail("tilted boxes are not supported"));
        }
        let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
        for a in 0..3 {
            let line = take(&mut lines)?;
            let words: Vec<&str> = line.split_whitespace().collect();
            let [l, h] = words[..] else {
                return Err(lines.fail("expected two bounds"));
            };
            low[a] = finite(l).map_err(|e| lines.fail(e))?;
            high[a] = finite(h).map_err(|e| lines.fail(e))?;
        }
        let item = expect_item(&mut lines, "ITEM: ATOMS")?;
        let names: Vec<&str> = item.split_whitespace().collect();
        if now != step {
            for _ in 0..count {
                take(&mut lines)?;
            }
            continue;
        }
        let find = |name: &str| names.iter().position(|n| *n == name);
        let id = find("id").ok_or_else(|| lines.fail("the dump has no column `id`"))?;
        let (mut places, mut choices) = (Vec::new(), Vec::new());
        for alternatives in wanted {
            let found = alternatives
                .iter()
                .enumerate()
                .find_map(|(k, n)| Some((k, find(n)?)));
            let (choice, place) = found.ok_or_else(|| {
                lines.fail(format!(
                    "the dump has no column `{}`",
                    alternatives.join("` or `")
                ))
            })?;
            places.push(place);
            choices.push(choice);
        }
        let mut frame = Frame {
            low,
            high,
            ids: Vec::new(),
            columns: vec![Vec::new(); wanted.len()],
        };
        for k in 0..count {
            let line = match lines.advance()? {
                Some(line) => line.to_string(),
                None => return Err(lines.fail(format!("the file ends after {k} of {count} atoms"))),
            };
            let words: Vec<&str> = line.split_whitespace().collect();
            if words.len() != names.len() {
                return Err(lines.fail(format!(
                    "expected {} columns, found {}",
                    names.len(),
                    words.len()
                )));
            }
            let atom = words[id]
                .parse()
                .map_err(|_| lines.fail(format!("`{}` is not an atom id", words[id])))?;
            frame.ids.push(atom);
            for (column, place) in frame.columns.iter_mut().zip(&places) {
                column.push(finite(words[*place]).map_err(|e| lines.fail(e))?);
            }
        }
        return Ok((frame, choices));
    }
}

/// Step of the next snapshot.
fn next_step<R: BufRead>(lines: &mut Lines<R>) -> Result<Option<u64>> {
    loop {
        match lines.advance()? {
            None => return Ok(None),
            Some("ITEM: TIMESTEP") => return number(lines).map(Some),
            Some("ITEM: UNITS" | "ITEM: TIME") => {
                take(lines)?;
            }
            Some("") => {}
            Some(_) => {
                return Err(lines.fail("expected `ITEM: TIMESTEP`; is this a LAMMPS dump file?"));
            }
        }
    }
}

fn take<R: BufRead>(lines: &mut Lines<R>) -> Result<String> {
    match lines.advance()? {
        Some(line) => Ok(line.to_string()),
        None => Err(lines.fail("the file ends within a snapshot")),
    }
}

fn number<R: BufRead, T: std::str::FromStr>(lines: &mut Lines<R>) -> Result<T> {
    let line = take(lines)?;
    line.parse()
        .map_err(|_| lines.fail(format!("expected a whole number, found `{line}`")))
}

fn expect_item<R: BufRead>(lines: &mut Lines<R>, item: &str) -> Result<String> {
    let line = take(lines)?;
    match line.strip_prefix(item) {
        Some(rest) => Ok(rest.to_string()),
        None => Err(lines.fail(format!("expected `{item}`"))),
    }
}
