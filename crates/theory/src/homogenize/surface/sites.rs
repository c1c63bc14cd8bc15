//! The points of a lattice body, and the cells between them.
//!
//! The body is the union of the cells whose corners are all there: its surface runs through its outermost points. A
//! point holds the part of a cell that its neighbouring cells give it (½ at faces, ¼ at edges, ⅛ at corners of blocks),
//! and its area is `∫ ∇N` over those cells, `N` its multilinear shape function: outward, zero inside, whatever the shape.

/// Points of a chain, square or cubic lattice.
#[derive(Debug, Clone)]
pub struct Sites {
    pub dimension: usize,
    low: [i32; 3],
    size: [i32; 3],
    periodic: [bool; 3],
    present: Vec<bool>,
    /// `[N]` place in the box of every point, in the order given.
    pub place: Vec<u32>,
}

impl Sites {
    /// Of integer coordinates; on periodic axes the period is the extent.
    pub fn new(dimension: usize, points: &[[i32; 3]], periodic: [bool; 3]) -> Sites {
        let low = std::array::from_fn(|a| points.iter().map(|p| p[a]).min().unwrap_or(0));
        let high: [i32; 3] =
            std::array::from_fn(|a| points.iter().map(|p| p[a]).max().unwrap_or(0));
        let size: [i32; 3] = std::array::from_fn(|a| high[a] - low[a] + 1);
        let mut sites = Sites {
            dimension,
            low,
            size,
            periodic,
            present: vec![false; size.iter().map(|n| *n as usize).product()],
            place: Vec::with_capacity(points.len()),
        };
        for p in points {
            let c: [i32; 3] = std::array::from_fn(|a| p[a] - low[a]);
            let i = (c[2] * size[1] + c[1]) as usize * size[0] as usize + c[0] as usize;
            sites.present[i] = true;
            sites.place.push(i as u32);
        }
        sites
    }

    /// Places of the box.
    pub fn places(&self) -> usize {
        self.present.len()
    }

    fn cell(&self, place: usize) -> [i32; 3] {
        let (x, y) = (self.size[0] as usize, self.size[1] as usize);
        [place % x, place / x % y, place / (x * y)].map(|c| c as i32)
    }

    /// Lattice coordinates of a place.
    pub fn coordinates(&self, place: usize) -> [i32; 3] {
        let c = self.cell(place);
        std::array::from_fn(|a| c[a] + self.low[a])
    }

    /// The place `o` away, if a point is there.
    pub fn step(&self, place: usize, o: [i32; 3]) -> Option<usize> {
        self.at(self.cell(place), o)
    }

    fn at(&self, c: [i32; 3], o: [i32; 3]) -> Option<usize> {
        let mut to = [0; 3];
        for a in 0..3 {
            to[a] = c[a] + o[a];
            if self.periodic[a] {
                to[a] = to[a].rem_euclid(self.size[a]);
            } else if to[a] < 0 || to[a] >= self.size[a] {
                return None;
            }
        }
        let i = (to[2] * self.size[1] + to[1]) as usize * self.size[0] as usize + to[0] as usize;
        self.present[i].then_some(i)
    }

    /// Part of a cell that a point holds, and its outward area (both of a whole cell of edge 1).
    pub fn cell_share(&self, place: usize) -> (f64, [f64; 3]) {
        let d = self.dimension;
        let c = self.cell(place);
        let corners = 1 << d;
        let bit = |n: usize, a: usize| if a < d { (n >> a & 1) as i32 } else { 0 };
        let (mut part, mut area) = (0.0, [0.0; 3]);
        for side in 0..corners {
            // the cell below the point along axis a if the bit is set
            let whole = (0..corners).all(|k| {
                let o = std::array::from_fn(|a| bit(k, a) - bit(side, a));
                self.at(c, o).is_some()
            });
            if whole {
                part += 1.0 / corners as f64;
                for (a, area) in area.iter_mut().enumerate().take(d) {
                    let sign = if bit(side, a) == 1 { 1.0 } else { -1.0 };
                    *area += sign * 2.0 / corners as f64;
                }
            }
        }
        (part, area)
    }

    /// Per place of the box: is any place within `reach` along all axes empty? Outside the box all are.
    pub fn near_void(&self, reach: i32) -> Vec<bool> {
        let mut near: Vec<bool> = self.present.iter().map(|p| !p).collect();
        let stride = [1, self.size[0], self.size[0] * self.size[1]].map(|s| s as usize);
        for a in 0..self.dimension {
            let n = self.size[a];
            let mut line = vec![false; n as usize];
            for first in 0..self.places() {
                if self.cell(first)[a] != 0 {
                    continue;
                }
                for (k, l) in line.iter_mut().enumerate() {
                    *l = near[first + k * stride[a]];
                }
                for k in 0..n {
                    near[first + k as usize * stride[a]] = (k - reach..=k + reach).any(|k| {
                        if self.periodic[a] {
                            line[k.rem_euclid(n) as usize]
                        } else {
                            k < 0 || k >= n || line[k as usize]
                        }
                    });
                }
            }
        }
        near
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(n: [i32; 3]) -> Vec<[i32; 3]> {
        let mut all = vec![];
        for z in 0..n[2] {
            for y in 0..n[1] {
                for x in 0..n[0] {
                    all.push([x, y, z]);
                }
            }
        }
        all
    }

    #[test]
    fn parts_and_areas_are_those_of_the_body_between_the_points() {
        let sites = Sites::new(3, &block([4, 5, 6]), [false; 3]);
        let mut volume = 0.0;
        let mut moment = [[0.0; 3]; 3];
        for &i in &sites.place {
            let (part, area) = sites.cell_share(i as usize);
            volume += part;
            let x = sites.coordinates(i as usize);
            for a in 0..3 {
                for b in 0..3 {
                    moment[a][b] += area[a] * f64::from(x[b]);
                }
            }
        }
        assert_eq!(volume, 60.0);
        // divergence theorem
        for a in 0..3 {
            for b in 0..3 {
                assert_eq!(moment[a][b], if a == b { 60.0 } else { 0.0 });
            }
        }
        let (part, area) = sites.cell_share(0);
        assert_eq!((part, area), (0.125, [-0.25; 3]));
    }

    #[test]
    fn steps_and_periods() {
        // an L of three cells: the inner corner holds ¾ of a cell and looks outward
        let mut points = block([3, 3, 1]);
        points.retain(|p| *p != [2, 2, 0]);
        let sites = Sites::new(2, &points, [false; 3]);
        let middle = points.iter().position(|p| *p == [1, 1, 0]).unwrap();
        let (part, area) = sites.cell_share(sites.place[middle] as usize);
        assert_eq!((part, area), (0.75, [0.5, 0.5, 0.0]));
        let ring = Sites::new(2, &block([4, 3, 1]), [true, false, false]);
        assert_eq!(ring.cell_share(0), (0.5, [0.0, -1.0, 0.0]));
        assert_eq!(ring.step(0, [-1, 0, 0]), Some(3));
        assert_eq!(
            ring.near_void(0),
            vec![false; 12],
            "the box is full, and no place outside it is asked for"
        );
        assert_eq!(
            ring.near_void(1),
            [[true; 4], [false; 4], [true; 4]].concat()
        );
    }
}
