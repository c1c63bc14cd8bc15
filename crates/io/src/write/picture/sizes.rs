//! How large points of plates are drawn that lie anyhow: cells of a mesh are neither squares nor alike, and squares of one size leave holes.

use std::collections::HashMap;

/// Of the mean distance to its nearest neighbours.
const WIDE: f64 = 1.7;
const NEAREST: usize = 3;
/// Sites of one of several square lattices: the nearest two as near as each other, to this part, and the fourth no further than a diagonal, or
/// at a corner the third on one. Of triangles both are √3 away.
const ALIKE: f64 = 1e-3;
const DIAGONAL: [f64; 2] = [1.3, 1.5];
/// Sites of lattices are so many parts of a spacing apart along an axis, to within this part of it.
const PARTS: f64 = 4.0;
const TOLERANCE: f64 = 1e-3;

type Cells = HashMap<[i64; 3], Vec<u32>>;

/// Edge of each point (length) from the reference positions; `None`: they are sites of a lattice, and all alike.
pub fn edges(reference: &[[f64; 3]], spacing: f64) -> Option<Vec<f64>> {
    let first = *reference.first()?;
    let site = |x: &[f64; 3]| {
        x.iter().zip(first).all(|(x, first)| {
            let n = PARTS * (x - first) / spacing;
            (n - n.round()).abs() < PARTS * TOLERANCE
        })
    };
    if !(spacing > 0.0) || reference.iter().all(site) {
        return None;
    }
    let edge = 2.0 * spacing;
    let cell = |x: &[f64; 3]| x.map(|c| (c / edge).floor() as i64);
    let mut cells = Cells::new();
    for (i, x) in reference.iter().enumerate() {
        cells.entry(cell(x)).or_default().push(i as u32);
    }
    let of = |x: &[f64; 3]| {
        // the squares of the nearest, rising, the point itself first
        let mut near = [f64::INFINITY; NEAREST + 2];
        let c = cell(x);
        for n in 0..27 {
            let at = [c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1];
            for &j in cells.get(&at).into_iter().flatten() {
                let y = &reference[j as usize];
                let mut square = (0..3).map(|a| (x[a] - y[a]).powi(2)).sum();
                for kept in &mut near {
                    if square < *kept {
                        std::mem::swap(&mut square, kept);
                    }
                }
            }
        }
        let near = near.map(f64::sqrt);
        let [low, high] = DIAGONAL.map(|d| d * near[1]);
        let square = near[4] < high || (low < near[3] && near[3] < high);
        if square && near[2] < (1.0 + ALIKE) * near[1] {
            return near[1];
        }
        let found = near[1..=NEAREST].iter().filter(|r| r.is_finite());
        let (sum, count) = found.fold((0.0, 0.0), |(sum, n), r| (sum + r, n + 1.0));
        match count > 0.0 {
            true => WIDE * sum / count,
            false => spacing,
        }
    };
    Some(reference.iter().map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattices_are_all_alike_and_cells_of_meshes_as_far_as_their_neighbours() {
        let square: Vec<[f64; 3]> = (0..12)
            .map(|n| [0.1 + 0.2 * f64::from(n % 4), 0.2 * f64::from(n / 4), 0.0])
            .collect();
        assert_eq!(edges(&square, 0.2), None);
        assert_eq!(edges(&[], 0.2), None);
        // two lattices side by side
        let mut both = square.clone();
        both.extend(square.iter().map(|x| [1.0 + 0.5 * x[0], 0.5 * x[1], 0.0]));
        let all = edges(&both, 0.15).unwrap();
        assert!(all[..12].iter().all(|e| (e - 0.2).abs() < 1e-12), "{all:?}");
        assert!(all[12..].iter().all(|e| (e - 0.1).abs() < 1e-12), "{all:?}");
        // centroids of equilateral triangles of edge 1 are honeycombs: three neighbours 1/√3 away
        let h = 3f64.sqrt();
        let mut centroids = vec![];
        for row in 0..5 {
            for n in 0..6 {
                let (x, y) = (
                    f64::from(n) + 0.5 * f64::from(row),
                    0.5 * h * f64::from(row),
                );
                centroids.push([x + 0.5, y + h / 6.0, 0.0]);
                centroids.push([x + 1.0, y + h / 3.0, 0.0]);
            }
        }
        let spacing = (h / 4.0).sqrt();
        let all = edges(&centroids, spacing).unwrap();
        let inner = all
            .iter()
            .filter(|e| (**e - WIDE / h).abs() < 1e-12)
            .count();
        assert!(inner >= 24, "{inner}");
        assert!(
            all.iter()
                .all(|e| *e >= WIDE / h - 1e-12 && *e < 2.0 * spacing * WIDE)
        );
    }
}
