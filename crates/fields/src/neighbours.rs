//! Who is near whom, in any cell: bins of fractional coordinates, walked through as often as the reach asks, so that every image of a
//! particle is found once also in a cell smaller than the reach.

use crate::FieldsError;
use crate::frame::Frame;
use std::collections::HashSet;

/// A particle near a centre, or an image of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Partner {
    pub atom: u32,
    /// Periods from the particle in the cell to this image.
    pub image: [i32; 3],
    /// From the centre (length).
    pub y: [f64; 3],
}

/// Bins of the particles of a frame.
pub struct Neighbours<'a> {
    frame: &'a Frame,
    reach: f64,
    /// In the cell along periodic axes.
    pub wrapped: Vec<[f64; 3]>,
    /// Bins along each axis, and where they begin and end, in fractions.
    pub bins: [i32; 3],
    low: [f64; 3],
    extent: [f64; 3],
    /// First place of each bin in `order`.
    start: Vec<u32>,
    order: Vec<u32>,
    /// Where those of `order` are.
    sorted: Vec<[f64; 3]>,
    /// Bins to look through on each side.
    span: [i32; 3],
    /// Who alone can be near, and the period that each particle is in.
    held: Option<(&'a Families, Vec<[i32; 3]>)>,
}

/// Who was near to whom in a reference: partners, and how many periods each is off the particle's own positions as they are, unwrapped.
#[derive(Debug, Clone)]
pub struct Families(Vec<Vec<(u32, [i32; 3])>>);

impl Families {
    /// Of a frame that is the reference, all that are nearer than `horizon` (length).
    ///
    /// # Errors
    /// A horizon that is not finite, or many times the cell.
    pub fn new(reference: &Frame, horizon: f64) -> Result<Families, FieldsError> {
        let near = Neighbours::new(reference, horizon)?;
        let home = near.periods();
        let mut all = vec![];
        let family = |i: usize| {
            near.near(i, &mut all);
            let whole = |p: &Partner| {
                let off = |a: usize| p.image[a] + home[i][a] - home[p.atom as usize][a];
                (p.atom, std::array::from_fn(off))
            };
            all.iter().map(whole).collect()
        };
        Ok(Families((0..reference.len()).map(family).collect()))
    }

    /// Of these the bonds that are whole: pairs of particles, the lower one first.
    pub fn of_whole(&self, bonds: &[(u32, u32)]) -> Families {
        let whole: HashSet<(u32, u32)> = bonds.iter().copied().collect();
        let left = |(i, all): (usize, &Vec<(u32, [i32; 3])>)| {
            let i = i as u32;
            let of = |j: u32| whole.contains(&(i.min(j), i.max(j)));
            all.iter().copied().filter(|(j, _)| of(*j)).collect()
        };
        Families(self.0.iter().enumerate().map(left).collect())
    }
}

/// Bins per reach.
const FINENESS: f64 = 2.0;
/// Bins along an axis at most.
const MOST: f64 = 1000.0;

impl<'a> Neighbours<'a> {
    /// # Errors
    /// The reach is not finite, or so many times the cell that no list of images can be made.
    pub fn new(frame: &'a Frame, reach: f64) -> Result<Neighbours<'a>, FieldsError> {
        if !(reach > 0.0 && reach.is_finite()) {
            return Err(FieldsError(format!(
                "the potential has a reach of {reach}: give it a cut-off (`cutoff`)"
            )));
        }
        let cell = &frame.cell;
        let wrapped: Vec<[f64; 3]> = frame.position.iter().map(|x| cell.wrap(*x)).collect();
        let (mut low, mut high) = ([0.0; 3], [1.0; 3]);
        for a in (0..3).filter(|a| !cell.periodic[*a]) {
            (low[a], high[a]) = (f64::INFINITY, f64::NEG_INFINITY);
        }
        for x in &wrapped {
            let s = cell.fraction(*x);
            for a in (0..3).filter(|a| !cell.periodic[*a]) {
                low[a] = low[a].min(s[a]);
                high[a] = high[a].max(s[a]);
            }
        }
        let extent: [f64; 3] = std::array::from_fn(|a| (high[a] - low[a]).max(1e-9));
        let thickness: [f64; 3] = std::array::from_fn(|a| extent[a] * cell.height(a));
        // no more bins than particles
        let most = MOST.min(libm::cbrt(8.0 * frame.len() as f64) + 64.0);
        let bins: [i32; 3] = std::array::from_fn(|a| {
            (FINENESS * thickness[a] / reach).floor().clamp(1.0, most) as i32
        });
        let span = std::array::from_fn(|a| {
            (reach * f64::from(bins[a]) / thickness[a] * (1.0 + 1e-12))
                .ceil()
                .min(1e6) as i32
        });
        let images: f64 = (0..3)
            .filter(|a| cell.periodic[*a])
            .map(|a| 2.0 * reach / thickness[a] + 1.0)
            .product();
        if images * frame.len() as f64 > 1e9 {
            return Err(FieldsError(format!(
                "the reach of the potential, {reach}, is many times the cell: are the units right?"
            )));
        }
        let mut all = Neighbours {
            frame,
            reach,
            wrapped,
            bins,
            low,
            extent,
            start: vec![0; bins.iter().product::<i32>() as usize + 1],
            order: vec![0; frame.len()],
            sorted: vec![],
            span,
            held: None,
        };
        let place: Vec<u32> = all.wrapped.iter().map(|x| all.bin(*x)).collect();
        for p in &place {
            all.start[*p as usize + 1] += 1;
        }
        for b in 1..all.start.len() {
            all.start[b] += all.start[b - 1];
        }
        let mut next = all.start.clone();
        for (i, p) in place.iter().enumerate() {
            let next = &mut next[*p as usize];
            all.order[*next as usize] = i as u32;
            *next += 1;
        }
        let sorted = all.order.iter().map(|i| all.wrapped[*i as usize]);
        all.sorted = sorted.collect();
        Ok(all)
    }

    /// Of these families alone those that are near.
    ///
    /// # Errors
    /// Families of another number of particles.
    pub fn held(mut self, families: &'a Families) -> Result<Neighbours<'a>, FieldsError> {
        if families.0.len() != self.frame.len() {
            return Err(FieldsError(format!(
                "families of {} particles, the frame has {}",
                families.0.len(),
                self.frame.len()
            )));
        }
        self.held = Some((families, self.periods()));
        Ok(self)
    }

    /// The period that each particle's position is in.
    fn periods(&self) -> Vec<[i32; 3]> {
        let cell = &self.frame.cell;
        let both = self.frame.position.iter().zip(&self.wrapped);
        both.map(|(x, wrapped)| {
            let (s, t) = (cell.fraction(*x), cell.fraction(*wrapped));
            std::array::from_fn(|a| (s[a] - t[a]).round() as i32)
        })
        .collect()
    }

    fn triple(&self, x: [f64; 3]) -> [i32; 3] {
        let s = self.frame.cell.fraction(x);
        std::array::from_fn(|a| {
            let t = (s[a] - self.low[a]) / self.extent[a] * f64::from(self.bins[a]);
            (t.floor().max(0.0) as i32).min(self.bins[a] - 1)
        })
    }

    fn place(&self, b: [i32; 3]) -> usize {
        ((b[0] * self.bins[1] + b[1]) * self.bins[2] + b[2]) as usize
    }

    fn bin(&self, x: [f64; 3]) -> u32 {
        self.place(self.triple(x)) as u32
    }

    /// The particles of a bin.
    pub fn members(&self, b: [i32; 3]) -> &[u32] {
        let place = self.place(b);
        &self.order[self.start[place] as usize..self.start[place + 1] as usize]
    }

    /// Fractions between which the bins from `from` to before `to` lie.
    pub fn bounds(&self, from: [i32; 3], to: [i32; 3]) -> [[f64; 3]; 2] {
        [from, to].map(|b| {
            std::array::from_fn(|a| {
                self.low[a] + self.extent[a] * f64::from(b[a]) / f64::from(self.bins[a])
            })
        })
    }

    /// All that are nearer to a particle than the reach, in an order of their own; of held families their members alone.
    pub fn near(&self, i: usize, out: &mut Vec<Partner>) {
        out.clear();
        let x = self.wrapped[i];
        let limit = self.reach * self.reach;
        if let Some((Families(of), period)) = &self.held {
            for &(atom, off) in &of[i] {
                let k = atom as usize;
                let image = std::array::from_fn(|a| off[a] + period[k][a] - period[i][a]);
                let shift = self.frame.cell.shift(image);
                let y: [f64; 3] = std::array::from_fn(|a| self.wrapped[k][a] + shift[a] - x[a]);
                if y.iter().map(|c| c * c).sum::<f64>() < limit {
                    out.push(Partner { atom, image, y });
                }
            }
            return;
        }
        let home = self.triple(x);
        for (b0, m0) in self.line(0, home[0]) {
            for (b1, m1) in self.line(1, home[1]) {
                let row = (b0 * self.bins[1] + b1) * self.bins[2];
                for [from, to, m2] in self.runs(home[2]) {
                    let image = [m0, m1, m2];
                    let shift = match image == [0; 3] {
                        true => [0.0; 3],
                        false => self.frame.cell.shift(image),
                    };
                    let off: [f64; 3] = std::array::from_fn(|a| shift[a] - x[a]);
                    let [from, to] = [from, to].map(|b| self.start[(row + b) as usize] as usize);
                    let all = self.order[from..to].iter().zip(&self.sorted[from..to]);
                    for (&atom, other) in all {
                        let y: [f64; 3] = std::array::from_fn(|a| other[a] + off[a]);
                        let q = y[0] * y[0] + y[1] * y[1] + y[2] * y[2];
                        if q < limit && !(atom as usize == i && image == [0; 3]) {
                            out.push(Partner { atom, image, y });
                        }
                    }
                }
            }
        }
    }

    /// Bins of an axis to look through, wrapped, with the image they stand for.
    fn line(&self, a: usize, home: i32) -> impl Iterator<Item = (i32, i32)> + use<'_> {
        let (count, repeats) = (self.bins[a], self.frame.cell.periodic[a]);
        (home - self.span[a]..=home + self.span[a]).filter_map(move |n| match repeats {
            true => Some((n.rem_euclid(count), n.div_euclid(count))),
            false => (0..count).contains(&n).then_some((n, 0)),
        })
    }

    /// Bins of the last axis to look through, from and to before, in pieces of an image each.
    fn runs(&self, home: i32) -> impl Iterator<Item = [i32; 3]> + use<'_> {
        let (count, repeats) = (self.bins[2], self.frame.cell.periodic[2]);
        let (mut next, mut end) = (home - self.span[2], home + self.span[2] + 1);
        if !repeats {
            (next, end) = (next.max(0), end.min(count));
        }
        std::iter::from_fn(move || {
            let (at, image) = (next.rem_euclid(count), next.div_euclid(count));
            let here = (end - next).min(count - at);
            next += here;
            (here > 0).then_some([at, at + here, image])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Cell;

    /// Against all images of all particles, in cells larger and smaller than the reach, tilted and open.
    #[test]
    fn every_image_is_found_once() {
        let edges = [[3.0, 0.0, 0.0], [1.1, 2.5, 0.0], [-0.8, 0.6, 2.8]];
        let mut seed = 3u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        for periodic in [[true; 3], [true, false, true], [false; 3]] {
            for reach in [0.7, 1.4, 5.0] {
                let cell = Cell::new([0.3, 0.1, -1.0], edges, periodic).unwrap();
                // some outside, as unwrapped coordinates are
                let position: Vec<_> = (0..7)
                    .map(|_| cell.at([2.0 * random() - 0.5, random(), 3.0 * random() - 1.0]))
                    .collect();
                let n = position.len();
                let frame = Frame {
                    cell,
                    position,
                    velocity: None,
                    mass: vec![1.0; n],
                    kind: vec![0; n],
                    time: None,
                };
                let bins = Neighbours::new(&frame, reach).unwrap();
                let mut near = vec![];
                for i in 0..n {
                    bins.near(i, &mut near);
                    let mut found: Vec<_> = near.iter().map(|p| (p.atom, p.image)).collect();
                    found.sort();
                    let mut expected = vec![];
                    let range = |a: usize| if periodic[a] { -6..=6 } else { 0..=0 };
                    for a in range(0) {
                        for b in range(1) {
                            for c in range(2) {
                                let shift = frame.cell.shift([a, b, c]);
                                for j in 0..n {
                                    let d: f64 = (0..3)
                                        .map(|k| {
                                            let y =
                                                bins.wrapped[j][k] + shift[k] - bins.wrapped[i][k];
                                            y * y
                                        })
                                        .sum();
                                    let own = i == j && [a, b, c] == [0; 3];
                                    if d < reach * reach && !own {
                                        expected.push((j as u32, [a, b, c]));
                                    }
                                }
                            }
                        }
                    }
                    expected.sort();
                    assert_eq!(found, expected, "{periodic:?} {reach}");
                }
            }
        }
    }
}
