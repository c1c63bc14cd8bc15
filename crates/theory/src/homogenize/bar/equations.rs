//! The equations of a bar: its stiffness with the factors of its ends, and the corner that its matrix is made of.

use super::Bar;
use super::parameters::parameters;
use super::stiffness_matrix::{StiffnessMatrix, common_denominator};
use crate::exact::{Field, Q};
use num_bigint::BigInt;

impl Bar {
    /// Coefficients in fractions or floating-point numbers, in units of cA.
    pub fn stiffness<F: Field>(&self) -> StiffnessMatrix<F> {
        StiffnessMatrix::new(self.m, self.points, self.ends, &self.factors())
    }

    /// Factors of the bonds between an end point and the m−1 points next to it, nearest first; 1 if not homogenized.
    pub fn factors<F: Field>(&self) -> Vec<F> {
        if self.homogenized {
            parameters(self.m, self.ends)
        } else {
            vec![F::one(); self.m - 1]
        }
    }
}

/// The first rows and columns: all that a bar's matrix is made of, and of which the rest is a copy or a mirror image.
#[derive(Debug, Clone, PartialEq)]
pub struct Corner {
    /// `S = corner/scale`, in units of cA; the least number that makes the matrix of the bar with all factors 1 whole.
    pub scale: BigInt,
    /// m+1 rows and columns.
    pub rows: Vec<Vec<Q>>,
}

impl Bar {
    /// The upper left corner with the scale of the paper's examples (24), (41), (57), (76), (79), (82).
    pub fn corner(&self) -> Corner {
        let plain = StiffnessMatrix::<Q>::new(self.m, self.points, self.ends, &[]);
        let scale = common_denominator(plain.inner.iter().chain(&plain.to_end));
        let stiffness = self.stiffness::<Q>();
        let row = |i: usize| {
            let entry = |j| stiffness.entry(i, j) * Q::from_integer(scale.clone());
            (0..=self.m).map(entry).collect()
        };
        Corner {
            rows: (0..=self.m).map(row).collect(),
            scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Ends;
    use super::*;
    use crate::exact::q;

    fn corner(m: usize, ends: Ends, homogenized: bool) -> (String, Vec<Vec<Q>>) {
        let corner = Bar::new(m, 2 * m + 1, ends, homogenized).unwrap().corner();
        (corner.scale.to_string(), corner.rows)
    }

    fn halves<const K: usize>(rows: [[i64; K]; K]) -> Vec<Vec<Q>> {
        rows.map(|r| r.map(|x| q(x, 2)).to_vec()).to_vec()
    }

    #[track_caller]
    fn is<const K: usize>(
        m: usize,
        ends: Ends,
        homogenized: bool,
        scale: &str,
        rows: [[i64; K]; K],
    ) {
        let (found, corner) = corner(m, ends, homogenized);
        assert_eq!(found, scale);
        // printed corners of homogenized bars have m rows
        let printed: Vec<Vec<Q>> = corner[..K].iter().map(|r| r[..K].to_vec()).collect();
        assert_eq!(printed, halves(rows.map(|r| r.map(|x| 2 * x))));
    }

    #[test]
    fn corners_are_those_printed() {
        use Ends::{Full, Half};
        is(2, Full, false, "4", [[-5, 4, 1], [4, -9, 4], [1, 4, -10]]);
        is(2, Full, true, "4", [[-7, 6], [6, -11]]);
        is(
            3,
            Full,
            false,
            "6",
            [
                [-10, 6, 3, 1],
                [6, -16, 6, 3],
                [3, 6, -19, 6],
                [1, 3, 6, -20],
            ],
        );
        is(
            4,
            Full,
            false,
            "24",
            [
                [-47, 24, 12, 8, 3],
                [24, -71, 24, 12, 8],
                [12, 24, -83, 24, 12],
                [8, 12, 24, -91, 24],
                [3, 8, 12, 24, -94],
            ],
        );
        is(
            4,
            Full,
            true,
            "24",
            [
                [-129, 84, 30, 12],
                [84, -131, 24, 12],
                [30, 24, -101, 24],
                [12, 12, 24, -95],
            ],
        );
        is(2, Half, false, "4", [[-5, 4, 1], [2, -7, 4], [1, 4, -10]]);
        is(2, Half, true, "4", [[-13, 12], [6, -11]]);
        is(
            3,
            Half,
            false,
            "12",
            [
                [-20, 12, 6, 2],
                [6, -26, 12, 6],
                [3, 12, -35, 12],
                [2, 6, 12, -40],
            ],
        );
        is(
            3,
            Half,
            true,
            "12",
            [[-80, 60, 18], [30, -50, 12], [9, 12, -41]],
        );
        is(
            4,
            Half,
            false,
            "24",
            [
                [-47, 24, 12, 8, 3],
                [12, -59, 24, 12, 8],
                [6, 24, -77, 24, 12],
                [4, 12, 24, -87, 24],
                [3, 8, 12, 24, -94],
            ],
        );
        is(
            4,
            Half,
            true,
            "24",
            [
                [-255, 168, 60, 24],
                [84, -131, 24, 12],
                [30, 24, -101, 24],
                [12, 12, 24, -95],
            ],
        );
        // (41): half of whole numbers
        let (scale, rows) = corner(3, Full, true);
        assert_eq!(scale, "6");
        let printed = halves([[-41, 30, 9], [30, -50, 12], [9, 12, -41]]);
        assert!((0..3).all(|i| rows[i][..3] == printed[i]));
    }

    /// Rows 2…m and N−m+1…N−1 of a half-weight bar come from those of a full one by (85)–(88), others do not change:
    /// an end point on the horizon weighs ½, not ¼.
    #[test]
    fn half_weights_change_rows_two_to_m_only() {
        for m in 1..=6 {
            let points = 2 * m + 4;
            let matrix = |ends| Bar::new(m, points, ends, false).unwrap().stiffness::<Q>();
            let (full, half) = (matrix(Ends::Full), matrix(Ends::Half));
            let last = points - 1;
            for i in 0..points {
                for j in 0..points {
                    let changes = |end: usize| (1..m).contains(&i.abs_diff(end));
                    let mut expected = full.entry(i, j);
                    for end in [0, last].into_iter().filter(|end| changes(*end)) {
                        let halved = full.entry(i, end) * q(1, 2);
                        if j == end {
                            expected = halved;
                        } else if j == i {
                            expected += halved;
                        }
                    }
                    assert_eq!(half.entry(i, j), expected, "m = {m}, ({i}, {j})");
                }
            }
            assert_eq!(half.entry(m, 0), q(1, 2 * m as i64));
        }
    }

    /// Rows sum to 0; full bars obey action and reaction, half ones break it between points 1 and m+1 alone:
    /// there the volumes ½ and 1 do not balance equal coefficients.
    #[test]
    fn action_and_reaction() {
        for (m, homogenized) in [(2, false), (3, true), (5, true)] {
            let bar = |ends| Bar::new(m, 2 * m + 3, ends, homogenized).unwrap();
            let (full, half) = (bar(Ends::Full), bar(Ends::Half));
            let (f, h) = (full.stiffness::<Q>(), half.stiffness::<Q>());
            let n = full.points();
            let volume = |i: usize| {
                if i == 0 || i == n - 1 {
                    q(1, 2)
                } else {
                    q(1, 1)
                }
            };
            for i in 0..n {
                assert_eq!((0..n).fold(q(0, 1), |s, j| s + h.entry(i, j)), q(0, 1));
                for j in 0..n {
                    assert_eq!(f.entry(i, j), f.entry(j, i));
                    let broken =
                        i.abs_diff(j) == m && [i, j].iter().any(|k| [0, n - 1].contains(k));
                    let balance = volume(i) * h.bond(i, j) == volume(j) * h.bond(j, i);
                    assert_eq!(balance, !broken, "({i}, {j})");
                }
            }
        }
    }
}
