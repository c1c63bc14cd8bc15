//! Primitive cells of the lattices and their bonds.

use super::error::{CrystalError, same_dimension};
use peridyne::family::stencil::Stencil;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::Horizon;
use std::f64::consts::PI;

/// Lattice vectors (rows) and sites.
pub type Cell<const D: usize> = ([[f64; D]; D], Vec<[f64; D]>);

/// The primitive cell, in units of the spacing.
pub fn primitive<const D: usize>(kind: LatticeKind) -> Result<Cell<D>, CrystalError> {
    same_dimension::<D>(kind)?;
    let h = 0.5;
    let rows: [[f64; 3]; 3] = match kind {
        LatticeKind::Chain | LatticeKind::Square | LatticeKind::Cubic => {
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        }
        LatticeKind::Triangular => [[1.0, 0.0, 0.0], [h, 0.75f64.sqrt(), 0.0], [0.0, 0.0, 1.0]],
        LatticeKind::Bcc => [[-h, h, h], [h, -h, h], [h, h, -h]],
        LatticeKind::Fcc | LatticeKind::Diamond => [[0.0, h, h], [h, 0.0, h], [h, h, 0.0]],
    };
    let mut sites = vec![[0.0; D]];
    if kind == LatticeKind::Diamond {
        sites.push([0.25; D]);
    }
    Ok((
        std::array::from_fn(|i| std::array::from_fn(|j| rows[i][j])),
        sites,
    ))
}

/// One bond of the primitive cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link<const D: usize> {
    pub from: usize,
    pub to: usize,
    /// Vector in units of the spacing.
    pub offset: [f64; D],
    /// Squared length in `spacing²/16`.
    pub squared: i64,
}

/// All bonds of the primitive cell within a horizon, by the integers of the engine's stencil.
pub fn links<const D: usize>(
    kind: LatticeKind,
    spacing: f64,
    horizon: Horizon,
) -> Result<Vec<Link<D>>, CrystalError> {
    same_dimension::<D>(kind)?;
    Stencil::fits(kind, spacing, horizon)
        .map_err(|e| CrystalError::TooManyBonds(e.message.into()))?;
    let stencil = Stencil::new(kind, spacing, horizon);
    let edges = kind.edges();
    // sites of the conventional cell that stand for those of the primitive one
    let site = |b: usize| usize::from(kind == LatticeKind::Diamond && b >= 4);
    let sources: &[usize] = match kind {
        LatticeKind::Diamond => &[0, 4],
        LatticeKind::Chain
        | LatticeKind::Square
        | LatticeKind::Triangular
        | LatticeKind::Cubic
        | LatticeKind::Bcc
        | LatticeKind::Fcc => &[0],
    };
    Ok(sources
        .iter()
        .flat_map(|&b| stencil.offsets()[b].iter().map(move |o| (b, o)))
        .map(|(b, o)| Link {
            from: site(b),
            to: site(o.to),
            offset: std::array::from_fn(|a| edges[a] * o.quarter[a] as f64 / 4.0),
            squared: o.squared,
        })
        .collect())
}

/// Determinant of a matrix of 1, 2 or 3 rows.
pub fn determinant<const D: usize>(m: &[[f64; D]; D]) -> f64 {
    match D {
        1 => m[0][0],
        2 => m[0][0] * m[1][1] - m[0][1] * m[1][0],
        _ => (0..3)
            .map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j])
            })
            .sum(),
    }
}

/// `2π` times the transposed inverse.
pub fn reciprocal<const D: usize>(m: &[[f64; D]; D]) -> [[f64; D]; D] {
    let scale = 2.0 * PI / determinant(m);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            scale
                * match D {
                    1 => 1.0,
                    2 => {
                        let sign = if i == j { 1.0 } else { -1.0 };
                        sign * m[1 - i][1 - j]
                    }
                    _ => {
                        let at = |a: usize, b: usize| m[(i + a) % 3][(j + b) % 3];
                        at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)
                    }
                }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<const D: usize>(kind: LatticeKind) {
        let (cell, sites) = primitive::<D>(kind).unwrap();
        let volume = determinant(&cell).abs() / sites.len() as f64;
        assert!((volume - kind.site_volume()).abs() < 1e-15, "{kind:?}");
        let b = reciprocal(&cell);
        for i in 0..D {
            for j in 0..D {
                let dot: f64 = (0..D).map(|a| cell[i][a] * b[j][a]).sum();
                let expected = if i == j { 2.0 * PI } else { 0.0 };
                assert!((dot - expected).abs() < 1e-14, "{kind:?}");
            }
        }
        // every bond leads from a site to a site of another cell
        for link in links::<D>(kind, 1.0, Horizon::Ratio(2)).unwrap() {
            for j in 0..D {
                let s: f64 = (0..D)
                    .map(|a| {
                        let cells = link.offset[a] - sites[link.to][a] + sites[link.from][a];
                        cells * b[j][a] / (2.0 * PI)
                    })
                    .sum();
                assert!((s - s.round()).abs() < 1e-13, "{kind:?} {link:?}");
            }
        }
    }

    #[test]
    fn primitive_cells_hold_every_site_once() {
        check::<1>(LatticeKind::Chain);
        check::<2>(LatticeKind::Square);
        check::<2>(LatticeKind::Triangular);
        for kind in [
            LatticeKind::Cubic,
            LatticeKind::Bcc,
            LatticeKind::Fcc,
            LatticeKind::Diamond,
        ] {
            check::<3>(kind);
        }
        let error = primitive::<2>(LatticeKind::Fcc).unwrap_err();
        assert_eq!(error.to_string(), "a fcc lattice has 3 dimensions, not 2");
    }
}
