//! The text of pictures: DejaVu Sans (free licence of Bitstream Vera and Arev), embedded, so that every machine draws the same.

use std::collections::BTreeSet;
use std::sync::Mutex;

use fontdue::{Font, FontSettings};

/// How thick the letters are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    Regular,
    Bold,
}

/// A font with the characters that it knows; no font only if the embedded file were damaged.
type Loaded = (BTreeSet<char>, Option<Font>);

/// The font with the characters of this text. Outlines of all 5,900 take 16 MB, those of texts hardly any.
fn with<T>(weight: Weight, text: &str, none: T, work: impl FnOnce(&Font) -> T) -> T {
    static FONTS: [Mutex<Loaded>; 2] = [const { Mutex::new((BTreeSet::new(), None)) }; 2];
    let (place, file): (usize, fn() -> &'static [u8]) = match weight {
        Weight::Regular => (0, dejavu::sans::regular),
        Weight::Bold => (1, dejavu::sans::bold),
    };
    let mut held = FONTS[place].lock().unwrap_or_else(|e| e.into_inner());
    let (known, font) = &mut *held;
    if font.is_none() || text.chars().any(|c| !known.contains(&c)) {
        known.extend((' '..='~').chain(text.chars()));
        let settings = FontSettings {
            load_substitutions: false,
            ..FontSettings::default()
        };
        *font = of_characters(file(), known).and_then(|f| Font::from_bytes(f, settings).ok());
    }
    font.as_ref().map_or(none, work)
}

/// The file of a font with a table of characters (`cmap`, format 12) that has these alone.
fn of_characters(file: &[u8], characters: &BTreeSet<char>) -> Option<Vec<u8>> {
    let face = ttf_parser::Face::parse(file, 0).ok()?;
    let tables = face.tables().cmap?.subtables;
    // the last table that knows it counts
    let glyph = |c: char| {
        let each = tables.into_iter().filter_map(|t| t.glyph_index(c.into()));
        each.filter(|g| g.0 != 0).last()
    };
    let known = characters.iter().filter_map(|c| Some((*c, glyph(*c)?)));
    let groups: Vec<[u32; 3]> = known
        .map(|(c, g)| [c.into(), c.into(), g.0.into()])
        .collect();
    let count = u32::try_from(groups.len()).ok()?;
    let mut table: Vec<u8> = vec![];
    // version 0, 1 table: of Windows for all of Unicode, 12 bytes from here on; format 12
    let head = [0u16, 1, 3, 10, 0, 12, 12, 0];
    let numbers = [16 + 12 * count, 0, count];
    table.extend(head.iter().flat_map(|n| n.to_be_bytes()));
    let numbers = numbers.iter().chain(groups.as_flattened());
    table.extend(numbers.flat_map(|n| n.to_be_bytes()));
    let mut made = file.to_vec();
    made.resize(file.len().next_multiple_of(4), 0);
    let place = [made.len(), table.len()];
    made.extend(table);
    // the list of tables: 16 bytes each, after 12
    let tables = u16::from_be_bytes([*file.get(4)?, *file.get(5)?]);
    let mut records = made.get_mut(12..)?.chunks_exact_mut(16);
    let record = { records.by_ref().take(tables.into()) }.find(|r| r.starts_with(b"cmap"))?;
    for (bytes, number) in record[8..].chunks_exact_mut(4).zip(place) {
        bytes.copy_from_slice(&u32::try_from(number).ok()?.to_be_bytes());
    }
    Some(made)
}

/// Width of a text of this size (pixels).
pub fn width(text: &str, size: f64, weight: Weight) -> f64 {
    with(weight, text, 0.0, |font| {
        text.chars()
            .map(|c| f64::from(font.metrics(c, size as f32).advance_width))
            .sum()
    })
}

/// Gives every inked pixel of a line of text with its coverage, 0 to 1: along the text from its beginning, and below its base line.
pub fn pixels(text: &str, size: f64, weight: Weight, mut put: impl FnMut(i64, i64, f64)) {
    with(weight, text, (), |font| {
        let mut pen = 0.0f64;
        for c in text.chars() {
            let (m, coverage) = font.rasterize(c, size as f32);
            let left = pen.round() as i64 + i64::from(m.xmin);
            // rows are from the top
            let top = -(m.height as i64) - i64::from(m.ymin);
            for (k, value) in coverage.iter().enumerate().filter(|(_, v)| **v > 0) {
                let (along, down) = ((k % m.width) as i64, (k / m.width) as i64);
                put(left + along, top + down, f64::from(*value) / 255.0);
            }
            pen += f64::from(m.advance_width);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Letters are those of the whole font, whatever texts came before; what no font has is the same box.
    #[test]
    fn characters_are_those_of_the_whole_font() {
        let text = "Aµ–Åσ∂²√ж字";
        for (weight, file) in [
            (Weight::Regular, dejavu::sans::regular()),
            (Weight::Bold, dejavu::sans::bold()),
        ] {
            let whole = Font::from_bytes(file, FontSettings::default()).unwrap();
            width("first", 20.0, weight);
            with(weight, text, (), |font| {
                for c in text.chars() {
                    assert_eq!(font.rasterize(c, 22.0), whole.rasterize(c, 22.0), "{c}");
                }
                assert!(font.chars().len() < 200);
            });
        }
    }
}
