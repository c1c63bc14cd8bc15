//! `region`: which positions belong, with LAMMPS's floating-point tests.

/// Stands for infinity, as in LAMMPS.
pub const INF: f64 = 1e20;

/// The shape of a region; lengths are in box units already.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    Block {
        low: [f64; 3],
        high: [f64; 3],
    },
    /// Along `axis`, around `center` (the two other axes in ascending order, y-axis: x, z).
    Cylinder {
        axis: usize,
        center: [f64; 2],
        radius: f64,
        low: f64,
        high: f64,
    },
    Sphere {
        center: [f64; 3],
        radius: f64,
    },
    Union(Vec<Region>),
    Intersect(Vec<Region>),
}

/// A shape, or everything outside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    pub shape: Shape,
    pub outside: bool,
}

/// The two axes across `axis`.
fn across(axis: usize) -> [usize; 2] {
    match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

impl Region {
    /// Is `x` in the region? Surfaces belong to the inside.
    pub fn contains(&self, x: [f64; 3]) -> bool {
        let inside = match &self.shape {
            Shape::Block { low, high } => (0..3).all(|a| x[a] >= low[a] && x[a] <= high[a]),
            Shape::Cylinder {
                axis,
                center,
                radius,
                low,
                high,
            } => {
                let [p, q] = across(*axis);
                let (d, e) = (x[p] - center[0], x[q] - center[1]);
                (d * d + e * e).sqrt() <= *radius && x[*axis] >= *low && x[*axis] <= *high
            }
            Shape::Sphere { center, radius } => {
                let d = [0, 1, 2].map(|a| x[a] - center[a]);
                (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() <= *radius
            }
            Shape::Union(parts) => parts.iter().any(|r| r.contains(x)),
            Shape::Intersect(parts) => parts.iter().all(|r| r.contains(x)),
        };
        inside != self.outside
    }

    /// Smallest box around it, if it is bounded.
    pub fn bounds(&self) -> Option<([f64; 3], [f64; 3])> {
        if self.outside {
            return None;
        }
        let bounds = match &self.shape {
            Shape::Block { low, high } => (*low, *high),
            Shape::Cylinder {
                axis,
                center,
                radius,
                low,
                high,
            } => {
                let [p, q] = across(*axis);
                let (mut a, mut b) = ([0.0; 3], [0.0; 3]);
                (a[p], b[p]) = (center[0] - radius, center[0] + radius);
                (a[q], b[q]) = (center[1] - radius, center[1] + radius);
                (a[*axis], b[*axis]) = (*low, *high);
                (a, b)
            }
            Shape::Sphere { center, radius } => {
                (center.map(|c| c - radius), center.map(|c| c + radius))
            }
            Shape::Union(parts) => {
                let all: Option<Vec<_>> = parts.iter().map(Region::bounds).collect();
                all?.into_iter()
                    .reduce(|a, b| pick(a, b, f64::min, f64::max))?
            }
            Shape::Intersect(parts) => parts
                .iter()
                .filter_map(Region::bounds)
                .reduce(|a, b| pick(a, b, f64::max, f64::min))?,
        };
        let finite = bounds.0.iter().chain(&bounds.1).all(|x| x.abs() < INF);
        finite.then_some(bounds)
    }
}

type Corners = ([f64; 3], [f64; 3]);

fn pick(a: Corners, b: Corners, low: fn(f64, f64) -> f64, high: fn(f64, f64) -> f64) -> Corners {
    (
        [0, 1, 2].map(|k| low(a.0[k], b.0[k])),
        [0, 1, 2].map(|k| high(a.1[k], b.1[k])),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inside(shape: Shape) -> Region {
        Region {
            shape,
            outside: false,
        }
    }

    /// i² + k² = 74² in units of half a millimetre: four of these points lose to rounding, two do not.
    #[test]
    fn the_edge_of_a_cylinder_is_decided_by_rounding() {
        let c = inside(Shape::Cylinder {
            axis: 1,
            center: [0.0; 2],
            radius: 0.037,
            low: -0.0025,
            high: 0.0,
        });
        let at = |i: f64, k: f64| c.contains([i * 0.0005, 0.0, k * 0.0005]);
        assert!(at(74.0, 0.0) && at(0.0, -74.0));
        assert!(!at(24.0, 70.0) && !at(-70.0, 24.0));
    }

    #[test]
    fn bounds_of_combinations() {
        let b = |x: f64| {
            inside(Shape::Block {
                low: [x, 0.0, 0.0],
                high: [x + 2.0, 1.0, 1.0],
            })
        };
        let union = inside(Shape::Union(vec![b(0.0), b(1.0)]));
        assert_eq!(union.bounds(), Some(([0.0; 3], [3.0, 1.0, 1.0])));
        let both = inside(Shape::Intersect(vec![b(0.0), b(1.0)]));
        assert_eq!(both.bounds(), Some(([1.0, 0.0, 0.0], [2.0, 1.0, 1.0])));
        assert!(both.contains([1.5, 0.5, 0.5]) && !both.contains([0.5, 0.5, 0.5]));
        assert_eq!(
            Region {
                outside: true,
                ..b(0.0)
            }
            .bounds(),
            None
        );
    }
}
