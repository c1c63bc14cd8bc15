//! Points whose surroundings look alike, and bonds between them: one unknown per kind instead of one per bond.

use super::sites::Sites;
use std::collections::HashMap;

/// A place of the box without a point.
const VOID: u32 = u32::MAX;

/// A symmetry of the lattice: axis a goes to axis `to[a]`, turned around where `sign[a]` is −1.
#[derive(Debug, Clone, Copy)]
struct Symmetry {
    to: [usize; 3],
    sign: [i32; 3],
}

impl Symmetry {
    fn all(dimension: usize) -> Vec<Symmetry> {
        let orders: &[[usize; 3]] = match dimension {
            1 => &[[0, 1, 2]],
            2 => &[[0, 1, 2], [1, 0, 2]],
            _ => &[
                [0, 1, 2],
                [0, 2, 1],
                [1, 0, 2],
                [1, 2, 0],
                [2, 0, 1],
                [2, 1, 0],
            ],
        };
        let turned = |n: usize| std::array::from_fn(|a| 1 - 2 * ((n >> a & 1) as i32));
        orders
            .iter()
            .flat_map(|&to| (0..1 << dimension).map(move |n| (to, n)))
            .map(|(to, n)| Symmetry {
                to,
                sign: turned(n),
            })
            .collect()
    }

    fn of(&self, o: [i32; 3]) -> [i32; 3] {
        let mut image = [0; 3];
        for a in 0..3 {
            image[self.to[a]] = self.sign[a] * o[a];
        }
        image
    }
}

/// Which points of a body see the same sites around them, within so many layers along all axes.
pub struct Neighbourhoods {
    reach: i32,
    cube: Vec<[i32; 3]>,
    /// Per symmetry: where each site of the cube goes.
    images: Vec<Vec<u32>>,
    symmetries: Vec<Symmetry>,
    names: HashMap<Box<[u64]>, u32>,
    patterns: Vec<Box<[u64]>>,
    /// Names of the images of patterns, where they were asked for.
    turned: Vec<Vec<u32>>,
    /// `[places]`: name of the pattern around each; 0 is full.
    of_place: Vec<u32>,
    classes: [Classes; 2],
}

/// Kinds of bonds by the names of their ends.
#[derive(Default)]
struct Classes {
    first: HashMap<(u32, u32, [i32; 3]), u32>,
    known: HashMap<(u32, u32, [i32; 3]), u32>,
}

/// What makes two bonds alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bonds {
    /// A symmetry, or reading one from its other end.
    Mutual,
    /// A symmetry.
    Directed,
}

impl Neighbourhoods {
    pub fn new(sites: &Sites, reach: i32) -> Neighbourhoods {
        let d = sites.dimension;
        let side = 2 * reach + 1;
        let count = (side as usize).pow(d as u32);
        let cube: Vec<[i32; 3]> = (0..count as i32)
            .map(|n| {
                std::array::from_fn(|a| {
                    if a < d {
                        n / side.pow(a as u32) % side - reach
                    } else {
                        0
                    }
                })
            })
            .collect();
        let number = |o: [i32; 3]| {
            (0..d)
                .map(|a| (o[a] + reach) * side.pow(a as u32))
                .sum::<i32>() as u32
        };
        let symmetries = Symmetry::all(d);
        let images = symmetries
            .iter()
            .map(|s| cube.iter().map(|o| number(s.of(*o))).collect())
            .collect();
        let mut made = Neighbourhoods {
            reach,
            cube,
            images,
            symmetries,
            names: HashMap::new(),
            patterns: vec![],
            turned: vec![],
            of_place: vec![VOID; sites.places()],
            classes: Default::default(),
        };
        let mut full = vec![0u64; count.div_ceil(64)];
        for k in 0..count {
            full[k / 64] |= 1 << (k % 64);
        }
        made.name(full.into());
        let near = sites.near_void(reach);
        for &place in &sites.place {
            let place = place as usize;
            made.of_place[place] = if near[place] {
                let mut pattern = vec![0u64; count.div_ceil(64)];
                for (k, o) in made.cube.iter().enumerate() {
                    pattern[k / 64] |= u64::from(sites.step(place, *o).is_some()) << (k % 64);
                }
                made.name(pattern.into())
            } else {
                0
            };
        }
        made
    }

    fn name(&mut self, pattern: Box<[u64]>) -> u32 {
        if let Some(name) = self.names.get(&pattern) {
            return *name;
        }
        let name = self.patterns.len() as u32;
        self.patterns.push(pattern.clone());
        self.turned.push(vec![]);
        self.names.insert(pattern, name);
        name
    }

    /// Name of the pattern around a place with a point.
    pub fn of(&self, place: usize) -> u32 {
        self.of_place[place]
    }

    /// Sites that a name tells of, along each axis.
    pub fn reach(&self) -> i32 {
        self.reach
    }

    /// Is a site within `layers` (at most the reach) of such a point empty?
    pub fn near(&self, name: u32, layers: i32) -> bool {
        let pattern = &self.patterns[name as usize];
        debug_assert!(layers <= self.reach);
        self.cube.iter().enumerate().any(|(k, o)| {
            o.iter().all(|c| c.abs() <= layers) && pattern[k / 64] >> (k % 64) & 1 == 0
        })
    }

    fn turn(&mut self, name: u32) {
        if !self.turned[name as usize].is_empty() {
            return;
        }
        let pattern = self.patterns[name as usize].clone();
        let mut names = Vec::with_capacity(self.symmetries.len());
        for s in 0..self.symmetries.len() {
            let mut image = vec![0u64; pattern.len()];
            for (k, &to) in self.images[s].iter().enumerate() {
                image[to as usize / 64] |= (pattern[k / 64] >> (k % 64) & 1) << (to % 64);
            }
            names.push(self.name(image.into()));
        }
        self.turned[name as usize] = names;
    }

    /// Kind of the bond along `o` between points of these names: the same for all bonds that a symmetry of the lattice
    /// carries into each other, and of [`Bonds::Mutual`] those read from the other end.
    pub fn class(&mut self, bonds: Bonds, from: u32, to: u32, o: [i32; 3]) -> usize {
        if let Some(class) = self.classes[bonds as usize].known.get(&(from, to, o)) {
            return *class as usize;
        }
        self.turn(from);
        self.turn(to);
        let (ours, theirs) = (&self.turned[from as usize], &self.turned[to as usize]);
        let all = self.symmetries.iter().zip(ours).zip(theirs);
        let first = all
            .flat_map(|((s, &i), &j)| {
                let xi = s.of(o);
                let here = (i, j, xi);
                match bonds {
                    Bonds::Mutual => [here, (j, i, xi.map(|c| -c))],
                    Bonds::Directed => [here; 2],
                }
            })
            .min()
            .unwrap_or((from, to, o));
        let classes = &mut self.classes[bonds as usize];
        let new = classes.first.len() as u32;
        let class = *classes.first.entry(first).or_insert(new);
        classes.known.insert((from, to, o), class);
        class as usize
    }

    /// Number of kinds of bonds that were asked for.
    pub fn classes(&self, bonds: Bonds) -> usize {
        self.classes[bonds as usize].first.len()
    }
}

/// Points with the same surroundings of all their partners: one row of factors each.
pub struct Kinds {
    /// `[N]` per point; 0: no site is missing anywhere near.
    pub of_point: Vec<u32>,
    /// `[kinds]` a place of that kind; of kind 0 any, or none.
    pub example: Vec<u32>,
}

impl Kinds {
    /// `offsets` are the bonds of a point.
    pub fn new(sites: &Sites, around: &Neighbourhoods, offsets: &[[i32; 3]]) -> Kinds {
        let longest = offsets.iter().flatten().map(|c| c.abs()).max().unwrap_or(0);
        let near = sites.near_void(around.reach + longest);
        let mut names: HashMap<Vec<u32>, u32> = HashMap::new();
        let mut example = vec![VOID];
        let of_point = sites
            .place
            .iter()
            .map(|&place| {
                if !near[place as usize] {
                    return 0;
                }
                let mut key = vec![around.of(place as usize)];
                key.extend(offsets.iter().map(|o| {
                    sites
                        .step(place as usize, *o)
                        .map_or(VOID, |j| around.of(j))
                }));
                let new = example.len() as u32;
                *names.entry(key).or_insert_with(|| {
                    example.push(place);
                    new
                })
            })
            .collect();
        Kinds { of_point, example }
    }

    /// A place of each kind, except of those inside.
    pub fn examples(&self) -> impl Iterator<Item = usize> + '_ {
        self.example[1..].iter().map(|p| *p as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_one_kind_of_corner_and_of_edge() {
        let points: Vec<[i32; 3]> = (0..144).map(|n| [n % 12, n / 12, 0]).collect();
        let sites = Sites::new(2, &points, [false; 3]);
        let mut around = Neighbourhoods::new(&sites, 1);
        let at = |x: i32, y: i32| (y * 12 + x) as usize;
        assert_eq!(around.of(at(5, 5)), 0);
        assert_ne!(around.of(at(0, 0)), around.of(at(11, 0)));
        let mut class = |a: usize, b: usize, o| {
            let (a, b) = (around.of(a), around.of(b));
            around.class(Bonds::Mutual, a, b, o)
        };
        let corner = class(at(0, 0), at(1, 0), [1, 0, 0]);
        assert_eq!(corner, class(at(11, 11), at(11, 10), [0, -1, 0]));
        assert_eq!(corner, class(at(0, 10), at(0, 11), [0, 1, 0]));
        let edge = class(at(4, 0), at(5, 0), [1, 0, 0]);
        assert_ne!(edge, corner);
        assert_eq!(edge, class(at(0, 7), at(0, 6), [0, -1, 0]));
        assert_ne!(edge, class(at(4, 0), at(4, 1), [0, 1, 0]));
        assert!(around.near(around.of(at(0, 4)), 1) && !around.near(0, 1));
        // corner, next to it and edge, along both axes, and their mirrors; bonds of one spacing
        let bonds = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]];
        let kinds = Kinds::new(&sites, &around, &bonds);
        assert_eq!(kinds.examples().count(), 24);
        assert_eq!(kinds.of_point[at(6, 3)], 0);
        assert_ne!(kinds.of_point[at(6, 1)], 0);
    }
}
