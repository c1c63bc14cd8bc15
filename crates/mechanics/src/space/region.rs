//! Regions: which points of space belong to a body or a set.

/// A region of space. Boundaries belong to the region.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    Everything,
    /// Axis-parallel box; ±∞ allowed.
    Block {
        low: [f64; 3],
        high: [f64; 3],
    },
    /// Cylinder along `axis` (0, 1, 2) around `center` (the component along the axis is ignored), from `low` to `high`.
    Cylinder {
        axis: usize,
        center: [f64; 3],
        radius: f64,
        low: f64,
        high: f64,
    },
    Sphere {
        center: [f64; 3],
        radius: f64,
    },
    /// Points with `normal · (x − point) ≤ 0`.
    HalfSpace {
        point: [f64; 3],
        normal: [f64; 3],
    },
    Union(Vec<Region>),
    /// The first minus all others.
    Difference(Box<Region>, Vec<Region>),
    Intersection(Vec<Region>),
}

impl Region {
    /// Whether the point is inside or on the boundary, in floating point as written.
    ///
    /// Lattice sites are better asked through [`super::membership::Membership`], which is exact on boundaries.
    pub fn contains(&self, x: &[f64; 3]) -> bool {
        match self {
            Region::Everything => true,
            Region::Block { low, high } => (0..3).all(|a| low[a] <= x[a] && x[a] <= high[a]),
            Region::Cylinder {
                axis,
                center,
                radius,
                low,
                high,
            } => {
                let across: f64 = (0..3)
                    .filter(|a| a != axis)
                    .map(|a| (x[a] - center[a]).powi(2))
                    .sum();
                *low <= x[*axis] && x[*axis] <= *high && across <= radius * radius
            }
            Region::Sphere { center, radius } => {
                (0..3).map(|a| (x[a] - center[a]).powi(2)).sum::<f64>() <= radius * radius
            }
            Region::HalfSpace { point, normal } => {
                (0..3).map(|a| normal[a] * (x[a] - point[a])).sum::<f64>() <= 0.0
            }
            Region::Union(parts) => parts.iter().any(|part| part.contains(x)),
            Region::Difference(from, minus) => {
                from.contains(x) && !minus.iter().any(|part| part.contains(x))
            }
            Region::Intersection(parts) => parts.iter().all(|part| part.contains(x)),
        }
    }

    /// Corners of a box around the region; ±∞ where it has no end, low > high where it is empty.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        const INF: f64 = f64::INFINITY;
        match self {
            Region::Everything => ([-INF; 3], [INF; 3]),
            Region::Block { low, high } => (*low, *high),
            Region::Cylinder {
                axis,
                center,
                radius,
                low,
                high,
            } => {
                let (mut from, mut to) = (center.map(|c| c - radius), center.map(|c| c + radius));
                (from[*axis], to[*axis]) = (*low, *high);
                (from, to)
            }
            Region::Sphere { center, radius } => {
                (center.map(|c| c - radius), center.map(|c| c + radius))
            }
            Region::HalfSpace { point, normal } => {
                let (mut from, mut to) = ([-INF; 3], [INF; 3]);
                for a in 0..3 {
                    if (0..3).all(|b| (normal[b] != 0.0) == (a == b)) {
                        let end = if normal[a] > 0.0 { &mut to } else { &mut from };
                        end[a] = point[a];
                    }
                }
                (from, to)
            }
            Region::Union(parts) => parts.iter().map(Region::bounds).fold(
                ([INF; 3], [-INF; 3]),
                |(from, to), (low, high)| {
                    (
                        crate::array::from_fn(|a| from[a].min(low[a])),
                        crate::array::from_fn(|a| to[a].max(high[a])),
                    )
                },
            ),
            Region::Difference(from, _) => from.bounds(),
            Region::Intersection(parts) => parts.iter().map(Region::bounds).fold(
                ([-INF; 3], [INF; 3]),
                |(from, to), (low, high)| {
                    (
                        crate::array::from_fn(|a| from[a].max(low[a])),
                        crate::array::from_fn(|a| to[a].min(high[a])),
                    )
                },
            ),
        }
    }

    /// Refuses numbers that make no region: NaN, infinite centres, radii that are not positive, empty boxes,
    /// axes beyond z, zero normals, unions of nothing. The message names the shape.
    pub fn check(&self) -> Result<(), String> {
        let finite = |what: &str, v: &[f64; 3]| {
            if v.iter().all(|c| c.is_finite()) {
                Ok(())
            } else {
                Err(format!("{what} must be finite, it is {v:?}"))
            }
        };
        let span = |what: &str, low: f64, high: f64| {
            if low <= high {
                Ok(())
            } else {
                Err(format!("{what}: low = {low} is not below high = {high}"))
            }
        };
        let round = |what: &str, radius: f64| {
            if radius > 0.0 && radius.is_finite() {
                Ok(())
            } else {
                Err(format!("{what} must be positive, it is {radius}"))
            }
        };
        match self {
            Region::Everything => Ok(()),
            Region::Block { low, high } => (0..3).try_for_each(|a| {
                span(&format!("block along {}", super::AXES[a]), low[a], high[a])
            }),
            Region::Cylinder {
                axis,
                center,
                radius,
                low,
                high,
            } => {
                if *axis > 2 {
                    return Err(format!(
                        "cylinder: axis {axis} does not exist, x, y, z are 0, 1, 2"
                    ));
                }
                finite("the centre of a cylinder", center)?;
                round("the radius of a cylinder", *radius)?;
                span("cylinder along its axis", *low, *high)
            }
            Region::Sphere { center, radius } => {
                finite("the centre of a sphere", center)?;
                round("the radius of a sphere", *radius)
            }
            Region::HalfSpace { point, normal } => {
                finite("the point of a half-space", point)?;
                finite("the normal of a half-space", normal)?;
                if normal.iter().all(|n| *n == 0.0) {
                    Err("the normal of a half-space is zero".into())
                } else {
                    Ok(())
                }
            }
            Region::Union(parts) | Region::Intersection(parts) if parts.is_empty() => {
                Err("a union or intersection needs at least one part".into())
            }
            Region::Union(parts) | Region::Intersection(parts) => {
                parts.iter().try_for_each(Region::check)
            }
            Region::Difference(from, minus) => {
                from.check()?;
                minus.iter().try_for_each(Region::check)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boundaries_belong() {
        let ball = Region::Sphere {
            center: [1.0, 0.0, 0.0],
            radius: 2.0,
        };
        assert!(ball.contains(&[3.0, 0.0, 0.0]) && !ball.contains(&[3.0, 0.1, 0.0]));
        let rod = Region::Cylinder {
            axis: 2,
            center: [0.0, 0.0, 9.0],
            radius: 5.0,
            low: 0.0,
            high: 1.0,
        };
        assert!(rod.contains(&[3.0, 4.0, 1.0]) && !rod.contains(&[3.0, 4.0, 1.1]));
        let below = Region::HalfSpace {
            point: [0.0, 1.0, 0.0],
            normal: [0.0, 2.0, 0.0],
        };
        assert!(below.contains(&[7.0, 1.0, 7.0]) && !below.contains(&[0.0, 1.1, 0.0]));
        // what is taken away takes its boundary along
        let shell = Region::Difference(
            Box::new(ball.clone()),
            vec![Region::Sphere {
                center: [1.0, 0.0, 0.0],
                radius: 1.0,
            }],
        );
        assert!(!shell.contains(&[2.0, 0.0, 0.0]) && shell.contains(&[2.5, 0.0, 0.0]));
        let both = Region::Intersection(vec![ball.clone(), below.clone()]);
        assert!(both.contains(&[1.0, 1.0, 0.0]) && !both.contains(&[1.0, 1.5, 0.0]));
        assert_eq!(both.bounds(), ([-1.0, -2.0, -2.0], [3.0, 1.0, 2.0]));
        let either = Region::Union(vec![ball, rod]);
        assert_eq!(either.bounds(), ([-5.0, -5.0, -2.0], [5.0, 5.0, 2.0]));
    }

    #[test]
    fn nonsense_is_refused() {
        for (region, message) in [
            (
                Region::Sphere {
                    center: [0.0; 3],
                    radius: -1.0,
                },
                "radius of a sphere must be positive",
            ),
            (
                Region::Sphere {
                    center: [f64::NAN; 3],
                    radius: 1.0,
                },
                "centre of a sphere must be finite",
            ),
            (
                Region::Block {
                    low: [0.0, 2.0, 0.0],
                    high: [1.0; 3],
                },
                "block along y: low = 2 is not below high = 1",
            ),
            (
                Region::Block {
                    low: [f64::NAN; 3],
                    high: [1.0; 3],
                },
                "block along x",
            ),
            (
                Region::HalfSpace {
                    point: [0.0; 3],
                    normal: [0.0; 3],
                },
                "normal of a half-space is zero",
            ),
            (
                Region::Cylinder {
                    axis: 3,
                    center: [0.0; 3],
                    radius: 1.0,
                    low: 0.0,
                    high: 1.0,
                },
                "axis 3",
            ),
            (
                Region::Difference(Box::new(Region::Everything), vec![Region::Union(vec![])]),
                "at least one part",
            ),
        ] {
            let error = region.check().unwrap_err();
            assert!(error.contains(message), "{error}");
        }
    }
}
