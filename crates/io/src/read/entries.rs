//! Constants of triples of elements, as LAMMPS's potential files have them (`.sw`, `.tersoff`): three names and so many numbers for
//! each entry, which begins on a line of its own and may go on over several. `#` starts a comment.

use super::error::ReadError;
use super::lines::Lines;
use super::number::number;
use std::path::Path;

/// Of three elements: the centre i, and j and k about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    pub elements: [String; 3],
    pub numbers: Vec<f64>,
}

/// Reads entries with numbers of these names.
///
/// # Errors
/// File and line: an entry is cut off, goes on too long, or has something else than a finite number; there is none.
pub fn entries(path: &Path, columns: &[&str]) -> Result<Vec<Entry>, ReadError> {
    let (text, name) = super::whole::text_of(path)?;
    parse_entries(&text, &name, columns)
}

/// The same from a text; `name` is for messages.
pub fn parse_entries(text: &str, name: &str, columns: &[&str]) -> Result<Vec<Entry>, ReadError> {
    let mut lines = Lines::new(text, name);
    let mut all: Vec<Entry> = vec![];
    let mut words: Vec<&str> = vec![];
    let whole = 3 + columns.len();
    while let Some(line) = lines.next() {
        words.extend(line.split('#').next().unwrap_or("").split_whitespace());
        if words.is_empty() || words.len() < whole {
            continue;
        }
        if words.len() > whole {
            return Err(lines.error(format!(
                "an entry has {} numbers here, expected {}: {}",
                words.len() - 3,
                columns.len(),
                columns.join(", ")
            )));
        }
        let mut numbers = vec![];
        for (word, column) in words[3..].iter().zip(columns) {
            numbers.push(lines.finite(Some(word), column)?);
        }
        let elements = [0, 1, 2].map(|n| words[n].to_string());
        if let Some(name) = elements.iter().find(|e| number(e).is_some()) {
            return Err(lines.error(format!(
                "an entry begins with the names of three elements, found the number `{name}`"
            )));
        }
        all.push(Entry { elements, numbers });
        words.clear();
    }
    if !words.is_empty() {
        return Err(lines.error(format!(
            "the file ends within an entry of {}: {} of its {} numbers are there",
            words[0],
            words.len().saturating_sub(3),
            columns.len()
        )));
    }
    match all.is_empty() {
        true => Err(lines.error("the file has no entry".to_string())),
        false => Ok(all),
    }
}

/// Names of the centres of all entries, each once.
pub fn names(entries: &[Entry]) -> Vec<&str> {
    let mut all: Vec<&str> = vec![];
    for entry in entries {
        let name = entry.elements[0].as_str();
        if !all.contains(&name) {
            all.push(name);
        }
    }
    all
}

/// Rows of the kinds i, j, k and the numbers, of those entries whose elements are among `kinds`, where one may stand several times.
pub fn rows(entries: &[Entry], kinds: &[&str]) -> Vec<Vec<f64>> {
    let of = |name: &String| -> Vec<f64> {
        let all = kinds.iter().enumerate().filter(|(_, k)| *k == name);
        all.map(|(n, _)| n as f64).collect()
    };
    let mut all = vec![];
    for entry in entries {
        let [first, second, third] = [0, 1, 2].map(|n| of(&entry.elements[n]));
        for i in &first {
            for j in &second {
                for k in &third {
                    all.push([&[*i, *j, *k][..], &entry.numbers[..]].concat());
                }
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_go_on_over_lines() {
        let text = "# a comment\nSi Si C 1 2\n 3 # more\n\nC C C 4 5 6\n";
        let all = parse_entries(text, "x", &["a", "b", "c"]).unwrap();
        assert_eq!(names(&all), ["Si", "C"]);
        assert_eq!(all[0].numbers, [1.0, 2.0, 3.0]);
        assert_eq!(
            rows(&all, &["Si", "C"]),
            [
                [0.0, 0.0, 1.0, 1.0, 2.0, 3.0],
                [1.0, 1.0, 1.0, 4.0, 5.0, 6.0]
            ]
        );
        assert_eq!(rows(&all, &["C"]), [[0.0, 0.0, 0.0, 4.0, 5.0, 6.0]]);
        // an element may stand twice
        let twice = rows(&all, &["C", "Si", "C"]);
        let kinds = |row: &Vec<f64>| [0, 1, 2].map(|n| row[n] as usize);
        let of = |a: f64| twice.iter().filter(move |r| r[3] == a).map(kinds);
        assert_eq!(of(1.0).collect::<Vec<_>>(), [[1, 1, 0], [1, 1, 2]]);
        assert_eq!(of(4.0).count(), 8);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let error = |text| {
            let found = parse_entries(text, "x.sw", &["a", "b"]);
            found.unwrap_err().to_string()
        };
        assert!(error("Si Si Si 1 2 3\n").contains("3 numbers here, expected 2: a, b"));
        assert!(error("\nSi Si Si 1 two\n").contains('2'));
        assert!(error("Si Si Si 1\n").contains("1 of its 2 numbers"));
        assert!(error("Si Si 1 2 3\n").contains("found the number `1`"));
        assert!(error("# nothing\n").contains("no entry"));
    }
}
