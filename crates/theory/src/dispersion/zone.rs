//! Brillouin zones: special points, paths through them, grids.

use crate::crystal::Crystal;
use crate::crystal::arrangement::bravais;
use peridyne::space::lattice::LatticeKind;
use std::f64::consts::PI;

/// A wave vector with a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpecialPoint {
    pub name: &'static str,
    /// In units of `2π/spacing`, Cartesian.
    pub wave: [f64; 3],
}

/// A point of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station<const D: usize> {
    /// Distance along the path (1 / length).
    pub distance: f64,
    /// Wave vector (1 / length).
    pub wave: [f64; D],
    /// Name, where it is a special point.
    pub name: Option<&'static str>,
}

const THIRD: f64 = 1.0 / 3.0;

/// The points of the usual path, in order.
pub fn special_points(kind: LatticeKind) -> Vec<SpecialPoint> {
    // M of the triangular zone: half of b2 = 2π/a (0, 2/√3)
    let m = 1.0 / 3f64.sqrt();
    let points: &[(&'static str, [f64; 3])] = match kind {
        LatticeKind::Chain => &[("Γ", [0.0; 3]), ("X", [0.5, 0.0, 0.0])],
        LatticeKind::Square => &[
            ("Γ", [0.0; 3]),
            ("X", [0.5, 0.0, 0.0]),
            ("M", [0.5, 0.5, 0.0]),
            ("Γ", [0.0; 3]),
        ],
        LatticeKind::Triangular => &[
            ("Γ", [0.0; 3]),
            ("M", [0.0, m, 0.0]),
            ("K", [THIRD, m, 0.0]),
            ("Γ", [0.0; 3]),
        ],
        LatticeKind::Cubic => &[
            ("Γ", [0.0; 3]),
            ("X", [0.5, 0.0, 0.0]),
            ("M", [0.5, 0.5, 0.0]),
            ("Γ", [0.0; 3]),
            ("R", [0.5, 0.5, 0.5]),
            ("X", [0.5, 0.0, 0.0]),
        ],
        LatticeKind::Bcc => &[
            ("Γ", [0.0; 3]),
            ("H", [1.0, 0.0, 0.0]),
            ("N", [0.5, 0.5, 0.0]),
            ("Γ", [0.0; 3]),
            ("P", [0.5, 0.5, 0.5]),
            ("H", [1.0, 0.0, 0.0]),
        ],
        LatticeKind::Fcc | LatticeKind::Diamond => &[
            ("Γ", [0.0; 3]),
            ("X", [1.0, 0.0, 0.0]),
            ("W", [1.0, 0.5, 0.0]),
            ("K", [0.75, 0.75, 0.0]),
            ("Γ", [0.0; 3]),
            ("L", [0.5, 0.5, 0.5]),
            ("U", [1.0, 0.25, 0.25]),
        ],
    };
    points
        .iter()
        .map(|(name, wave)| SpecialPoint { name, wave: *wave })
        .collect()
}

/// Special points of any cell, and the length in whose inverse they count: those of its lattice, or halves of its reciprocal vectors.
pub fn special_points_of<const D: usize>(crystal: &Crystal<D>) -> (Vec<SpecialPoint>, f64) {
    if let Some((kind, spacing)) = bravais(&crystal.cell) {
        return (special_points(kind), spacing);
    }
    let b = crystal.reciprocal();
    let half = |of: &[usize]| -> [f64; 3] {
        let sum = |a: usize| of.iter().map(|i| b[*i][a]).sum::<f64>();
        std::array::from_fn(|a| {
            if a < D {
                0.5 * sum(a) / (2.0 * PI)
            } else {
                0.0
            }
        })
    };
    let point = |name, of: &[usize]| SpecialPoint {
        name,
        wave: half(of),
    };
    let centre = point("Γ", &[]);
    let points = match D {
        1 => vec![centre, point("½b₁", &[0])],
        2 => vec![
            point("½b₁", &[0]),
            centre,
            point("½b₂", &[1]),
            point("½(b₁+b₂)", &[0, 1]),
            centre,
        ],
        _ => vec![
            point("½b₁", &[0]),
            centre,
            point("½b₂", &[1]),
            point("½(b₁+b₂+b₃)", &[0, 1, 2]),
            centre,
            point("½b₃", &[2]),
        ],
    };
    (points, 1.0)
}

/// Straight lines through the special points, with `per_line` steps each.
pub fn path<const D: usize>(
    points: &[SpecialPoint],
    spacing: f64,
    per_line: usize,
) -> Vec<Station<D>> {
    let per_line = per_line.max(1);
    let wave =
        |p: &SpecialPoint| -> [f64; D] { std::array::from_fn(|a| 2.0 * PI / spacing * p.wave[a]) };
    let mut out = vec![];
    let mut distance = 0.0;
    if let Some(first) = points.first() {
        out.push(Station {
            distance,
            wave: wave(first),
            name: Some(first.name),
        });
    }
    for pair in points.windows(2) {
        let (from, to) = (wave(&pair[0]), wave(&pair[1]));
        let length = (0..D)
            .map(|a| (to[a] - from[a]).powi(2))
            .sum::<f64>()
            .sqrt();
        for n in 1..=per_line {
            let s = n as f64 / per_line as f64;
            out.push(Station {
                distance: distance + s * length,
                wave: std::array::from_fn(|a| from[a] + s * (to[a] - from[a])),
                name: (n == per_line).then_some(pair[1].name),
            });
        }
        distance += length;
    }
    out
}

/// Every wave vector of a grid over the zone that is not the negative of another (ω² is even), Γ included.
pub fn grid<const D: usize>(crystal: &Crystal<D>, per_axis: usize, mut see: impl FnMut([f64; D])) {
    let b = crystal.reciprocal();
    let n = per_axis.max(1);
    for index in 0..n.pow(D as u32) {
        let mut rest = index;
        let part: [usize; D] = std::array::from_fn(|_| {
            let digit = rest % n;
            rest /= n;
            digit
        });
        let opposite = part.map(|p| (n - p) % n);
        if part > opposite {
            continue;
        }
        see(std::array::from_fn(|a| {
            (0..D).map(|i| part[i] as f64 / n as f64 * b[i][a]).sum()
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crystal::cells::{primitive, reciprocal};

    /// Zone-boundary points are as far from Γ as from some reciprocal lattice vector, and from none farther.
    fn on_the_boundary<const D: usize>(kind: LatticeKind) {
        let b = reciprocal(&primitive::<D>(kind).unwrap().0);
        for p in special_points(kind).iter().filter(|p| p.name != "Γ") {
            let mut nearest = f64::INFINITY;
            for index in 1..5usize.pow(D as u32) {
                let c: [f64; D] =
                    std::array::from_fn(|i| (index / 5usize.pow(i as u32) % 5) as f64 - 2.0);
                if c == [0.0; D] {
                    continue;
                }
                let d: f64 = (0..D)
                    .map(|a| {
                        let g: f64 = (0..D).map(|i| c[i] * b[i][a]).sum();
                        (g / (2.0 * PI) - p.wave[a]).powi(2)
                    })
                    .sum();
                nearest = nearest.min(d);
            }
            let own: f64 = p.wave.iter().map(|x| x * x).sum();
            assert!((nearest / own - 1.0).abs() < 1e-12, "{kind:?} {}", p.name);
        }
    }

    #[test]
    fn special_points_lie_on_the_boundary_of_the_zone() {
        on_the_boundary::<1>(LatticeKind::Chain);
        on_the_boundary::<2>(LatticeKind::Square);
        on_the_boundary::<2>(LatticeKind::Triangular);
        for kind in [
            LatticeKind::Cubic,
            LatticeKind::Bcc,
            LatticeKind::Fcc,
            LatticeKind::Diamond,
        ] {
            on_the_boundary::<3>(kind);
        }
    }

    #[test]
    fn paths_visit_their_points() {
        let points = special_points(LatticeKind::Square);
        let stations = path::<2>(&points, 2.0, 10);
        assert_eq!(stations.len(), 31);
        let names: Vec<_> = stations.iter().filter_map(|s| s.name).collect();
        assert_eq!(names, ["Γ", "X", "M", "Γ"]);
        assert_eq!(stations[10].wave, [0.5 * PI, 0.0]);
        let length = 0.5 * PI * (2.0 + 2f64.sqrt());
        assert!((stations[30].distance - length).abs() < 1e-14);
    }
}
