//! Rotations of space: as rows of a matrix, and as quaternions of length 1.

use super::Point;
use crate::state::Word;

/// Rows of a rotation, from axes of the shape to space.
pub type Axes = [Point; 3];

/// From axes of the shape to space.
pub fn times(m: &Axes, x: &Point) -> Point {
    crate::array::from_fn(|r| m[r][0] * x[0] + m[r][1] * x[1] + m[r][2] * x[2])
}

/// From space to axes of the shape.
pub fn transposed_times(m: &Axes, x: &Point) -> Point {
    crate::array::from_fn(|c| m[0][c] * x[0] + m[1][c] * x[1] + m[2][c] * x[2])
}

/// A turn: cos(φ/2), and sin(φ/2) along its axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quaternion([f64; 4]);

impl Word for Quaternion {
    const BYTES: usize = <[f64; 4]>::BYTES;

    fn put(&self, to: &mut [u8]) {
        self.0.put(to);
    }

    fn take(from: &[u8]) -> Self {
        Quaternion(Word::take(from))
    }
}

impl Quaternion {
    pub const ONE: Quaternion = Quaternion([1.0, 0.0, 0.0, 0.0]);

    pub fn about(axis: &Point, angle: f64) -> Quaternion {
        let (sine, cosine) = libm::sincos(0.5 * angle);
        Quaternion([cosine, sine * axis[0], sine * axis[1], sine * axis[2]])
    }

    /// First `other`, then this.
    pub fn after(self, other: Quaternion) -> Quaternion {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Quaternion([
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e,
        ])
    }

    pub fn normalized(self) -> Quaternion {
        let size = self.0.iter().map(|c| c * c).sum::<f64>().sqrt();
        Quaternion(self.0.map(|c| c / size))
    }

    pub fn axes(self) -> Axes {
        let [w, x, y, z] = self.0;
        [
            [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y - w * z),
                2.0 * (x * z + w * y),
            ],
            [
                2.0 * (x * y + w * z),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z - w * x),
            ],
            [
                2.0 * (x * z - w * y),
                2.0 * (y * z + w * x),
                1.0 - 2.0 * (x * x + y * y),
            ],
        ]
    }

    /// Of a rotation (Shepperd 1978).
    pub fn of(m: &Axes) -> Quaternion {
        let trace = m[0][0] + m[1][1] + m[2][2];
        let k = (0..3)
            .max_by(|a, b| m[*a][*a].total_cmp(&m[*b][*b]))
            .unwrap_or(0);
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let mut q = [0.0; 4];
        if trace > m[k][k] {
            q[0] = 1.0 + trace;
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                q[1 + a] = m[c][b] - m[b][c];
            }
        } else {
            q[0] = m[j][i] - m[i][j];
            q[1 + k] = 1.0 + 2.0 * m[k][k] - trace;
            q[1 + i] = m[i][k] + m[k][i];
            q[1 + j] = m[j][k] + m[k][j];
        }
        Quaternion(q).normalized()
    }

    /// Axis times angle, which is from 0 to π.
    pub fn vector(self) -> Point {
        let [w, x, y, z] = self.0;
        let sine = (x * x + y * y + z * z).sqrt();
        if sine == 0.0 {
            return [0.0; 3];
        }
        let angle = 2.0 * libm::atan2(sine, w.abs());
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        [x, y, z].map(|c| sign * angle * c / sine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_go_to_axes_and_back() {
        for (axis, angle) in [
            ([0.0, 0.6, 0.8], 0.4),
            ([1.0, 0.0, 0.0], 3.1),
            ([-0.6, 0.0, 0.8], 2.0),
        ] {
            let q = Quaternion::about(&axis, angle);
            let back = Quaternion::of(&q.axes()).vector();
            for a in 0..3 {
                assert!(
                    (back[a] - angle * axis[a]).abs() < 1e-12,
                    "{axis:?} {angle}: {back:?}"
                );
            }
        }
    }
}
