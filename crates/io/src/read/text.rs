//! Plain text: `x y z volume [mark]` per line, `#` starts a comment.

use super::lines::Lines;
use super::{ReadError, Sourced};
use peridyne::spec::Cloud;

pub(super) fn parse(text: &str, name: &str) -> Result<Sourced, ReadError> {
    let mut lines = Lines::new(text, name);
    let mut cloud = Cloud::default();
    let mut sources = Vec::new();
    let mut columns = None;
    while let Some(line) = lines.next() {
        let line = line.split('#').next().unwrap_or("");
        let fields: Vec<&str> = line
            .split([' ', '\t', ',', ';'])
            .filter(|f| !f.is_empty())
            .collect();
        if fields.is_empty() {
            continue;
        }
        if columns.is_none() && fields.iter().all(|f| f.parse::<f64>().is_err()) {
            return Err(lines.error(format!(
                "expected `x y z volume [mark]` as numbers, found the words `{}`: a header begins with #, write `# {}`",
                line.trim(),
                line.trim()
            )));
        }
        let first = *columns.get_or_insert(fields.len());
        if !(4..=5).contains(&fields.len()) {
            return Err(lines.error(format!(
                "expected `x y z volume [mark]`, found {} columns",
                fields.len()
            )));
        }
        if fields.len() != first {
            return Err(lines.error(format!(
                "{} columns, where the lines before have {first}",
                fields.len()
            )));
        }
        let mut x = [0.0; 3];
        for (a, c) in x.iter_mut().enumerate() {
            *c = lines.finite(Some(fields[a]), ["x", "y", "z"][a])?;
        }
        let volume = lines.finite(Some(fields[3]), "the volume")?;
        if volume <= 0.0 {
            return Err(lines.error(format!("the volume must be positive, it is {volume}")));
        }
        if let Some(mark) = fields.get(4) {
            cloud
                .mark
                .push(lines.parse(Some(mark), "a whole number as mark")?);
        }
        cloud.position.push(x);
        cloud.volume.push(volume);
        sources.push(lines.number);
    }
    if sources.is_empty() {
        return Err(ReadError {
            file: name.into(),
            line: None,
            message: "the file has no points".into(),
        });
    }
    Ok(Sourced {
        atoms: None,
        cloud,
        dimension: None,
        lines: sources,
        notes: vec![],
    })
}
