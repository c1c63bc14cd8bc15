//! Stencils: on a lattice every point has the same bonds, given by integers.

use crate::error::BuildError;
use crate::message;
use crate::quantity::{Dimension, rounded};
use crate::space::ball_volume;
use crate::space::lattice::LatticeKind;
use crate::spec::Horizon;

/// One bond of a stencil, between sublattices, in integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Offset {
    /// Cells from here to there.
    pub cell: [i32; 3],
    /// Sublattice there.
    pub to: usize,
    /// Quarters of the cell's edges from here to there.
    pub quarter: [i32; 3],
    /// Squared length in `spacing²/16`.
    pub squared: i64,
}

/// Bonds per sublattice, nearest rows first in memory order (z, y, x). Kernels go where these lead, so that nobody changes them:
///
/// ```compile_fail,E0616
/// use peridyne_mechanics::family::stencil::Stencil;
/// use peridyne_mechanics::space::lattice::LatticeKind;
/// use peridyne_mechanics::spec::Horizon;
/// let mut stencil = Stencil::new(LatticeKind::Square, 1.0, Horizon::Ratio(2));
/// stencil.offsets[0][3].to = 1 << 20;
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stencil {
    pub(crate) kind: LatticeKind,
    pub(crate) offsets: Vec<Vec<Offset>>,
    pub(crate) reach: usize,
    pub(crate) near_horizon: usize,
}

/// Most bonds of a point; kernels have room for so many.
pub const MOST: usize = 32_768;

impl Stencil {
    pub fn kind(&self) -> LatticeKind {
        self.kind
    }

    /// Per sublattice.
    pub fn offsets(&self) -> &[Vec<Offset>] {
        &self.offsets
    }

    /// Cells that the longest bond spans.
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// Number of (directed, per cell) bonds whose length is within round-off (1e-9) of a horizon given as a length.
    pub fn near_horizon(&self) -> usize {
        self.near_horizon
    }

    /// Would [`Stencil::new`] find at most [`MOST`] bonds, by the volume of the ball? To be asked before: a horizon in the
    /// wrong unit makes more bonds than any memory holds.
    ///
    /// # Errors
    /// It has far more.
    pub fn fits(kind: LatticeKind, spacing: f64, horizon: Horizon) -> Result<(), BuildError> {
        let spacings = match horizon {
            Horizon::Ratio(m) => f64::from(m),
            Horizon::Length(d) => d / spacing,
        };
        let bonds = ball_volume(kind.dimension(), spacings) / kind.site_volume();
        // the ball's surface blurs small counts
        if bonds <= 1.5 * MOST as f64 {
            return Ok(());
        }
        Err(too_many(bonds, horizon, spacings))
    }

    /// All sites within the horizon, inclusive. A ratio is decided by integers; a length by comparison in floating
    /// point, and bonds that round-off could decide are counted in `near_horizon`.
    pub fn new(kind: LatticeKind, spacing: f64, horizon: Horizon) -> Stencil {
        let squares = kind.edge_squared();
        let (limit, length) = match horizon {
            Horizon::Ratio(m) => (16 * (m as i64) * (m as i64), None),
            Horizon::Length(d) => (
                ((d / spacing) * (d / spacing) * 16.0).ceil() as i64 + 1,
                Some(d),
            ),
        };
        let dimension = kind.dimension();
        let span: [i32; 3] = crate::array::from_fn(|a| {
            if a < dimension {
                ((limit as f64 / squares[a] as f64).sqrt() / 4.0).floor() as i32 + 1
            } else {
                0
            }
        });
        let basis = kind.basis();
        let mut near_horizon = 0;
        let mut reach = 0;
        let mut offsets = vec![];
        for from in basis {
            let mut list = vec![];
            for z in -span[2]..=span[2] {
                for y in -span[1]..=span[1] {
                    for (to, site) in basis.iter().enumerate() {
                        for x in -span[0]..=span[0] {
                            let cell = [x, y, z];
                            let quarter: [i32; 3] =
                                crate::array::from_fn(|a| 4 * cell[a] + site[a] - from[a]);
                            let squared: i64 = (0..3)
                                .map(|a| squares[a] * (quarter[a] as i64).pow(2))
                                .sum();
                            if squared == 0 || squared > limit {
                                continue;
                            }
                            if let Some(d) = length {
                                let r = spacing * (squared as f64).sqrt() / 4.0;
                                if (r - d).abs() <= 1e-9 * d {
                                    near_horizon += 1;
                                }
                                if r > d {
                                    continue;
                                }
                            }
                            reach = cell
                                .iter()
                                .map(|c| c.unsigned_abs() as usize)
                                .fold(reach, usize::max);
                            list.push(Offset {
                                cell,
                                to,
                                quarter,
                                squared,
                            });
                        }
                    }
                }
            }
            offsets.push(list);
        }
        Stencil {
            kind,
            offsets,
            reach,
            near_horizon,
        }
    }

    /// Longest family of the sublattices.
    pub fn bonds(&self) -> usize {
        self.offsets.iter().map(Vec::len).max().unwrap_or(0)
    }
}

/// A point has too many bonds.
pub fn too_many(bonds: f64, horizon: Horizon, spacings: f64) -> BuildError {
    let cause = match horizon {
        Horizon::Ratio(_) => {
            "write horizon = { m_ratio = 3 }: three to six spacings are usual".into()
        }
        Horizon::Length(d) => message![
            "the horizon ",
            Dimension::LENGTH.of(d),
            format!(
                " is {spacings:.1} spacings: check its unit and its decimal point, and those of the spacing; three to six spacings are usual"
            ),
        ],
    };
    BuildError::too_many(
        "horizon",
        format!(
            "{} bonds per point are too many: at most {MOST}",
            rounded(bonds, 4)
        ),
    )
    .help(cause)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn family_sizes_are_lattice_counts() {
        let count = |kind, m| {
            Stencil::new(kind, 1.0, Horizon::Ratio(m))
                .offsets
                .iter()
                .map(Vec::len)
                .collect::<Vec<_>>()
        };
        assert_eq!(count(LatticeKind::Chain, 3), [6]);
        assert_eq!(count(LatticeKind::Square, 3), [28]);
        assert_eq!(count(LatticeKind::Square, 6), [112]);
        assert_eq!(count(LatticeKind::Cubic, 3), [122]);
        // fcc: 12 + 6 neighbours up to one cell edge; bcc: 8 + 6; diamond: 4 + 12 + 12 (√11/4 < 1) + 6
        assert_eq!(count(LatticeKind::Fcc, 1), [18; 4]);
        assert_eq!(count(LatticeKind::Bcc, 1), [14; 2]);
        assert_eq!(count(LatticeKind::Diamond, 1), [34; 8]);
        // triangular: 6 + 6 + 6 neighbours up to two spacings
        assert_eq!(count(LatticeKind::Triangular, 2), [18; 2]);
    }

    #[test]
    fn a_horizon_in_length_reports_bonds_at_round_off() {
        let exact = Stencil::new(LatticeKind::Cubic, 0.0005, Horizon::Length(0.0015));
        assert_eq!(exact.near_horizon, 6 + 24);
        let clear = Stencil::new(LatticeKind::Cubic, 0.0005, Horizon::Length(0.0015001));
        assert_eq!((clear.near_horizon, clear.bonds()), (0, 122));
    }
}
