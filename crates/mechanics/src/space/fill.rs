//! The sites of a lattice inside a region.

use super::lattice::Lattice;
use super::membership::Membership;
use super::region::Region;
use super::{AXES, Point};
use crate::error::BuildError;
use crate::execute::memory;
use crate::quantity::rounded;
use std::ops::Range;

/// The least that a point takes (bytes): its place, displacement, velocity and force.
const POINT: f64 = 88.0;
/// Places per axis at which a large region is looked at to guess how many points it holds.
const SAMPLES: usize = 24;

/// Sites of a lattice, in quarters of the cell's edges, ordered by cell (z, y, x with x fastest), then basis.
#[derive(Debug, Clone, PartialEq)]
pub struct Sites {
    pub lattice: Lattice,
    pub quarters: Vec<[i32; 3]>,
}

impl Sites {
    pub fn len(&self) -> usize {
        self.quarters.len()
    }
    pub fn is_empty(&self) -> bool {
        self.quarters.is_empty()
    }
    pub fn position(&self, site: usize) -> Point {
        self.lattice.position(self.quarters[site])
    }
}

/// All sites of `lattice` in `region`, boundaries included as [`Membership`] decides them.
///
/// # Errors
/// A region without end along an axis of the lattice, one that holds no site, or one that spans more cells than
/// points can be numbered; numbers that make no region or lattice.
pub fn fill(lattice: &Lattice, region: &Region) -> Result<Sites, BuildError> {
    let search = Search::new(lattice, region)?;
    search.affordable(1)?;
    let workspace = search.cells as usize * lattice.kind.basis().len();
    let mut quarters = Vec::new();
    // room for the whole box is only address space until it is written, and saves copying while growing
    quarters.try_reserve_exact(workspace).map_err(|_| {
        BuildError::too_large(
            "body.spacing",
            (
                (workspace * size_of::<[i32; 3]>()) as f64,
                memory::available(),
            ),
            format!(
                "no memory for the sites of {} lattice cells",
                rounded(search.cells, 3)
            ),
        )
    })?;
    search.each(search.layers(), |q| quarters.push(q));
    if quarters.is_empty() {
        return Err(search.empty());
    }
    quarters.shrink_to_fit();
    Ok(Sites {
        lattice: *lattice,
        quarters,
    })
}

/// The cells of a lattice that may have sites in a region, layer by layer along the last axis.
#[derive(Debug)]
pub struct Search {
    lattice: Lattice,
    membership: Membership,
    /// Of the region.
    ends: [Point; 2],
    first: [i32; 3],
    last: [i32; 3],
    /// How many.
    cells: f64,
}

impl Search {
    /// # Errors
    /// As of [`fill`], but that nothing is found.
    pub fn new(lattice: &Lattice, region: &Region) -> Result<Search, BuildError> {
        let membership = Membership::new(lattice, region)?;
        let dimension = lattice.kind.dimension();
        let (low, high) = region.bounds();
        let edges = lattice.kind.edges();
        let (mut first, mut last) = ([0i32; 3], [0i32; 3]);
        let mut cells = 1.0f64;
        for a in 0..dimension {
            let axis = AXES[a];
            if !(low[a].is_finite() && high[a].is_finite()) && low[a] <= high[a] {
                return Err(BuildError::invalid(
                    "body.region",
                    format!("the body has no end along {axis}"),
                )
                .help("clip the region with a block that is finite along every axis"));
            }
            let cell = |x: f64| (x - lattice.origin[a]) / (lattice.spacing * edges[a]);
            // one cell of margin: membership decides, and it rounds
            let (from, to) = (cell(low[a]).floor() - 1.0, cell(high[a]).ceil() + 1.0);
            if low[a] <= high[a] && !(from > -5e8 && to < 5e8) {
                return Err(BuildError::too_many(
                    "body.spacing",
                    format!("the body spans more than 5e8 lattice cells along {axis}"),
                )
                .help("check the units of the spacing and of the region"));
            }
            (first[a], last[a]) = (from as i32, to as i32);
            cells *= (to - from + 1.0).max(0.0);
        }
        if cells > f64::from(u32::MAX) {
            return Err(BuildError::too_many(
                "body.spacing",
                format!("the region spans {} lattice cells", rounded(cells, 3)),
            )
            .help("points are numbered up to 4.29e9: use a larger spacing or a smaller region"));
        }
        Ok(Search {
            lattice: *lattice,
            membership,
            ends: [low, high],
            first,
            last,
            cells,
        })
    }

    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Is there memory for one of so many parts?
    ///
    /// # Errors
    /// There is less.
    pub fn affordable(&self, parts: usize) -> Result<(), BuildError> {
        let all = self.cells * self.lattice.kind.basis().len() as f64;
        if memory::available().is_some_and(|left| all * POINT > left * parts as f64) {
            let points = all * self.held();
            memory::afford(
                "body.spacing",
                &format!("a body of {} points", rounded(points, 3)),
                points * POINT / parts as f64,
                "check the units of the spacing and of the region; a larger spacing or a smaller region makes fewer points",
            )?;
        }
        Ok(())
    }

    /// About which part of the cells the region holds: of those in the middle of equal parts of the box.
    fn held(&self) -> f64 {
        let dimension = self.lattice.kind.dimension();
        let all = SAMPLES.pow(dimension as u32);
        let mut found = 0usize;
        for i in 0..all {
            let mut rest = i;
            let q = crate::array::from_fn(|a| {
                if a >= dimension {
                    return 0;
                }
                let k = rest % SAMPLES;
                rest /= SAMPLES;
                let cells = i64::from(self.last[a]) - i64::from(self.first[a]) + 1;
                let part = cells * (2 * k as i64 + 1) / (2 * SAMPLES) as i64;
                4 * (i64::from(self.first[a]) + part) as i32
            });
            found += usize::from(self.contains(q));
        }
        found as f64 / all as f64
    }

    /// Is this site of the lattice in the region?
    pub fn contains(&self, quarter: [i32; 3]) -> bool {
        self.membership.contains(quarter)
    }

    /// Cells along the last axis of the lattice.
    pub fn layers(&self) -> Range<i32> {
        let a = self.lattice.kind.dimension() - 1;
        self.first[a]..self.last[a].saturating_add(1)
    }

    /// The sites in these layers, cell by cell (z, y, x with x fastest).
    pub fn each(&self, layers: Range<i32>, mut site: impl FnMut([i32; 3])) {
        let (basis, whole) = (self.lattice.kind.basis(), self.layers());
        let layers = layers.start.max(whole.start)..layers.end.min(whole.end);
        let along = |a: usize| match a + 1 == self.lattice.kind.dimension() {
            true => layers.clone(),
            false => self.first[a]..self.last[a].saturating_add(1),
        };
        for k in along(2) {
            for j in along(1) {
                for i in along(0) {
                    for b in basis {
                        let q = [4 * i + b[0], 4 * j + b[1], 4 * k + b[2]];
                        if self.contains(q) {
                            site(q);
                        }
                    }
                }
            }
        }
    }

    /// Says how far the region reaches and where the lattice has its next site.
    pub fn empty(&self) -> BuildError {
        let [low, high] = self.ends;
        empty(&self.lattice, low, high)
    }
}

fn empty(lattice: &Lattice, low: Point, high: Point) -> BuildError {
    let dimension = lattice.kind.dimension();
    let kind = lattice.kind.name();
    let error = |extent: String| {
        BuildError::empty(
            "body.region",
            format!("the region holds no site of the {kind} lattice: {extent}"),
        )
    };
    if (0..dimension).any(|a| low[a] > high[a]) {
        return error("its parts have nothing in common".into());
    }
    let extent: Vec<String> = (0..dimension)
        .map(|a| format!("{} from {} to {}", AXES[a], low[a], high[a]))
        .collect();
    let middle: Point = crate::array::from_fn(|a| (low[a] + high[a]) / 2.0);
    let edges = lattice.kind.edges();
    let base: [f64; 3] = crate::array::from_fn(|a| {
        if a < dimension {
            ((middle[a] - lattice.origin[a]) / (lattice.spacing * edges[a])).floor()
        } else {
            0.0
        }
    });
    let mut best = (f64::INFINITY, [0.0; 3]);
    for corner in 0..27 {
        let shift = [corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1];
        for b in lattice.kind.basis() {
            let q = crate::array::from_fn(|a| {
                if a < dimension {
                    4 * (base[a] as i32 + shift[a]) + b[a]
                } else {
                    0
                }
            });
            let x = lattice.position(q);
            let distance = (0..dimension)
                .map(|a| (x[a] - middle[a]).powi(2))
                .sum::<f64>();
            if distance < best.0 {
                best = (distance, x);
            }
        }
    }
    let site: Vec<String> = best.1[..dimension]
        .iter()
        .map(|c| format!("{c:.6}"))
        .collect();
    error(format!(
        "it reaches {}, and the spacing is {}",
        extent.join(", "),
        lattice.spacing
    ))
    .help(format!(
        "the site nearest to its middle is ({}): move the region or the origin",
        site.join(", ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::lattice::LatticeKind;

    fn lattice(kind: LatticeKind, spacing: f64) -> Lattice {
        Lattice {
            kind,
            spacing,
            origin: [0.0; 3],
        }
    }

    fn block(low: [f64; 3], high: [f64; 3]) -> Region {
        Region::Block { low, high }
    }

    #[test]
    fn the_disk_keeps_its_circle() {
        let disk = Region::Cylinder {
            axis: 1,
            center: [0.0; 3],
            radius: 0.037,
            low: 0.0,
            high: 0.0025,
        };
        let sites = fill(&lattice(LatticeKind::Cubic, 0.0005), &disk).unwrap();
        assert_eq!(sites.len(), 6 * 17_193);
        // Gauss's circle: the same count from plain integers
        let layer = (-74i32..=74)
            .flat_map(|i| (-74i32..=74).map(move |k| i * i + k * k <= 74 * 74))
            .filter(|x| *x)
            .count();
        assert_eq!(layer, 17_193);
    }

    #[test]
    fn counts_and_order_of_every_lattice() {
        // [0, 4]³ cells closed on all sides
        for (kind, count) in [
            (LatticeKind::Chain, 5),
            (LatticeKind::Square, 25),
            (LatticeKind::Cubic, 125),
            (LatticeKind::Bcc, 125 + 64),
            (LatticeKind::Fcc, 125 + 3 * 80),
            (LatticeKind::Diamond, 125 + 240 + 4 * 64),
        ] {
            let sites = fill(&lattice(kind, 0.1), &block([0.0; 3], [0.4; 3])).unwrap();
            assert_eq!(sites.len(), count, "{}", kind.name());
            let cell = |q: &[i32; 3]| {
                let b = q.map(|c| c.rem_euclid(4));
                (
                    q[2].div_euclid(4),
                    q[1].div_euclid(4),
                    q[0].div_euclid(4),
                    kind.basis().iter().position(|s| *s == b),
                )
            };
            assert!(sites.quarters.is_sorted_by_key(cell), "{}", kind.name());
        }
    }

    #[test]
    fn what_cannot_be_filled_says_why() {
        let cubic = lattice(LatticeKind::Cubic, 0.1);
        let error = |region: Region| fill(&cubic, &region).unwrap_err();
        let open = error(Region::HalfSpace {
            point: [0.0; 3],
            normal: [1.0, 0.0, 0.0],
        });
        assert!(open.message.contains("no end along x"), "{open}");
        let small = error(block([0.02; 3], [0.04; 3]));
        assert!(
            small.message.contains("x from 0.02 to 0.04")
                && small.help.unwrap().contains("(0.000000, "),
            "{}",
            small.message
        );
        let nothing = error(Region::Intersection(vec![
            block([0.0; 3], [1.0; 3]),
            block([2.0; 3], [3.0; 3]),
        ]));
        assert!(nothing.message.contains("nothing in common"), "{nothing}");
        assert!(
            error(block([0.0; 3], [1e6; 3]))
                .message
                .contains("spans 1e21 lattice cells")
        );
        assert!(error(block([0.0; 3], [1e12; 3])).message.contains("5e8"));
        let flat = fill(
            &lattice(LatticeKind::Cubic, -1.0),
            &block([0.0; 3], [1.0; 3]),
        )
        .unwrap_err();
        assert_eq!(flat.path, "body.spacing");
        // a 2-D lattice ends where its axes end
        assert_eq!(
            fill(
                &lattice(LatticeKind::Square, 1.0),
                &block([0.0, 0.0, -f64::INFINITY], [1.0, 1.0, f64::INFINITY])
            )
            .unwrap()
            .len(),
            4
        );
    }

    #[test]
    fn a_set_inside_a_difference_and_a_union() {
        let ring = Region::Difference(
            Box::new(Region::Sphere {
                center: [0.0; 3],
                radius: 0.5,
            }),
            vec![Region::Sphere {
                center: [0.0; 3],
                radius: 0.4,
            }],
        );
        // 21 + ... points with 16 < i² + k² ≤ 25: the circle of 5 has 12 points, 17, 18, 20 have 8, 4, 8
        assert_eq!(
            fill(&lattice(LatticeKind::Square, 0.1), &ring)
                .unwrap()
                .len(),
            12 + 8 + 4 + 8
        );
        let two = Region::Union(vec![block([0.0; 3], [0.1; 3]), block([0.1; 3], [0.2; 3])]);
        assert_eq!(
            fill(&lattice(LatticeKind::Cubic, 0.1), &two).unwrap().len(),
            8 + 8 - 1
        );
    }
}
