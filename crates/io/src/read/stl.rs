//! STL: triangles of a surface, as text (`solid NAME`, `facet normal`, `outer loop`, three `vertex`, …) or binary (a header of 80 bytes, the number
//! of triangles, and 50 bytes for each; 3D Systems 1988).
//!
//! Normals of the file are passed over: a triangle turns counter-clockwise when it is seen from outside.

use super::error::ReadError;
use super::lines::Lines;
use peridyne::space::Point;
use peridyne::space::triangles::Triangles;
use std::path::Path;

const HEADER: usize = 80;
/// Normal, three corners of three numbers of four bytes each, and two bytes.
const TRIANGLE: usize = 50;

/// The triangles of a file, lengths times `unit`.
///
/// # Errors
/// The file cannot be read, is truncated, is no STL, has numbers that are not finite or triangles without area.
pub fn stl(path: &Path, unit: f64) -> Result<Triangles, ReadError> {
    let name = path.display().to_string();
    let fail = |message: String| ReadError::file(path, message);
    let bytes = super::source::bytes(path).map_err(|e| fail(format!("cannot read it: {e}")))?;
    let mut all = match binary_count(&bytes) {
        Some(count) => binary(&bytes, count).map_err(fail)?,
        None => match super::whole::text(bytes.clone(), &name, 1) {
            Ok(text) if text.trim_start().starts_with("solid") => ascii(&text, &name)?,
            Err(wrong) if bytes.trim_ascii_start().starts_with(b"solid") => return Err(wrong),
            Ok(_) | Err(_) => {
                let told = word(&bytes, HEADER).map(|n| n as usize);
                let holds = bytes.len().saturating_sub(HEADER + 4) / TRIANGLE;
                return Err(fail(match told {
                    Some(told) if holds < told => format!(
                        "the file is truncated, or no STL: as a binary STL it has {told} triangles, of which {holds} are in the file"
                    ),
                    _ => "this is no STL: it begins neither with `solid` nor with a binary header and the number of triangles".into(),
                }));
            }
        },
    };
    for x in all.iter_mut().flatten() {
        *x = x.map(|c| c * unit);
    }
    Triangles::new(&all).map_err(fail)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let word = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
}

/// The number of triangles of a binary file that is as long as it says; text may begin like anything, but not be of just that length.
fn binary_count(bytes: &[u8]) -> Option<usize> {
    let count = word(bytes, HEADER)? as usize;
    (bytes.len() == HEADER + 4 + count.checked_mul(TRIANGLE)?).then_some(count)
}

fn binary(bytes: &[u8], count: usize) -> Result<Vec<[Point; 3]>, String> {
    let number = |at: usize| -> Result<f64, String> {
        let bits = word(bytes, at).ok_or("the file is truncated")?;
        Ok(f64::from(f32::from_bits(bits)))
    };
    let mut all = Vec::with_capacity(count);
    for n in 0..count {
        let mut corners = [[0.0; 3]; 3];
        for (k, x) in corners.iter_mut().flatten().enumerate() {
            // behind the normal
            *x = number(HEADER + 4 + TRIANGLE * n + 12 + 4 * k)?;
        }
        all.push(corners);
    }
    Ok(all)
}

fn ascii(text: &str, name: &str) -> Result<Vec<[Point; 3]>, ReadError> {
    let mut lines = Lines::new(text, name);
    let (mut all, mut open, mut ended) = (vec![], vec![], false);
    while let Some(line) = lines.next() {
        let mut words = line.split_whitespace();
        let first = words.next().unwrap_or("");
        match first {
            "solid" => ended = false,
            "endsolid" => ended = true,
            "facet" | "endfacet" | "endloop" if !open.is_empty() => {
                return Err(lines.error(format!(
                    "a triangle has {} corners, expected three",
                    open.len()
                )));
            }
            "facet" | "outer" | "endloop" | "endfacet" => {}
            "vertex" => {
                let mut x = [0.0; 3];
                for (a, c) in x.iter_mut().enumerate() {
                    *c = lines.finite(words.next(), ["x", "y", "z"][a])?;
                }
                open.push(x);
                if let [a, b, c] = open[..] {
                    all.push([a, b, c]);
                    open.clear();
                }
            }
            _ => {
                return Err(lines.error(format!(
                    "expected a line of an STL (facet, outer loop, vertex, endloop, endfacet, endsolid), found `{line}`"
                )));
            }
        }
    }
    match ended && open.is_empty() {
        true => Ok(all),
        false => Err(lines.error(format!(
            "the file ends after {} triangles without `endsolid`: it is truncated",
            all.len()
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(name: &str, bytes: &[u8]) -> Result<Triangles, String> {
        let path = std::env::temp_dir().join(format!("peridyne-{}-{name}.stl", std::process::id()));
        std::fs::write(&path, bytes).unwrap();
        let read = stl(&path, 0.5);
        std::fs::remove_file(&path).unwrap();
        read.map_err(|e| e.message)
    }

    fn text(corners: &[[f64; 3]]) -> String {
        let mut text = String::from("solid t\n");
        for triangle in corners.chunks(3) {
            text += "facet normal 0 0 1\n outer loop\n";
            for [x, y, z] in triangle {
                text += &format!("  vertex {x:e} {y:e} {z:e}\n");
            }
            text += " endloop\nendfacet\n";
        }
        text + "endsolid t\n"
    }

    fn bytes(header: &[u8], corners: &[[f64; 3]]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend((corners.len() as u32 / 3).to_le_bytes());
        for triangle in corners.chunks(3) {
            bytes.extend([0u8; 12]);
            for c in triangle.iter().flatten() {
                bytes.extend((*c as f32).to_le_bytes());
            }
            bytes.extend([0u8; 2]);
        }
        bytes
    }

    const TWO: [[f64; 3]; 6] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [1.0, 0.0, -0.0],
        [1.0, 2.0, 0.25],
        [0.0, 2.0, 0.0],
    ];

    #[test]
    fn text_and_binary_files_hold_the_same() {
        let read = written("text", text(&TWO).as_bytes()).unwrap();
        assert_eq!(read.face, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(read.corner[3], [0.5, 1.0, 0.125]);
        // writers of binary files begin them with `solid`, too
        for header in [&b"made by hand"[..], b"solid binary"] {
            assert_eq!(written("binary", &bytes(header, &TWO)).unwrap(), read);
        }
    }

    #[test]
    fn what_is_no_whole_file_is_refused() {
        let said = |bytes: &[u8]| written("wrong", bytes).unwrap_err();
        let whole = text(&TWO);
        let cut = &whole[..whole.len() - 20];
        assert!(
            said(cut.as_bytes()).contains("truncated"),
            "{}",
            said(cut.as_bytes())
        );
        let corner_lost = whole.replacen("  vertex 1e0 0e0 0e0\n", "", 1);
        assert!(
            said(corner_lost.as_bytes()).contains("2 corners"),
            "{}",
            said(corner_lost.as_bytes())
        );
        let nan = whole.replacen("vertex 1e0", "vertex nan", 1);
        assert!(said(nan.as_bytes()).contains("x is NaN"));
        let odd = whole.replacen("outer loop", "loop", 1);
        assert!(said(odd.as_bytes()).contains("expected a line of an STL"));
        assert!(said(b"{}").contains("no STL"));
        assert!(said(b"solid nothing\nendsolid\n").contains("no triangles"));
        let binary = bytes(b"b", &TWO);
        assert!(said(&binary[..150]).contains("has 2 triangles, of which 1 are in the file"));
        let infinite = TWO.map(|x| x.map(|c| c / 0.0));
        assert!(said(&bytes(b"b", &infinite)).contains("has the coordinate"));
    }
}
