//! A tree of boxes around triangles: what is near a point or a segment, without a look at the others.

use crate::space::Point;

/// Triangles of a leaf.
const LEAF: usize = 4;

/// Box of a node, and what is in it.
#[derive(Debug, Clone)]
struct Node {
    low: Point,
    high: Point,
    inside: Inside,
}

#[derive(Debug, Clone)]
enum Inside {
    /// Two nodes.
    Halves([u32; 2]),
    /// Places in the order of the tree.
    Leaf(std::ops::Range<u32>),
}

/// A tree of triangles, halved at the middle one along the longest side.
#[derive(Debug, Clone)]
pub struct Tree {
    nodes: Vec<Node>,
    /// Numbers of triangles, leaf by leaf.
    order: Vec<u32>,
}

impl Tree {
    /// Of triangles by their corners.
    pub fn new(count: usize, corners: impl Fn(usize) -> [Point; 3]) -> Tree {
        let middle: Vec<Point> = (0..count)
            .map(|n| {
                let [a, b, c] = corners(n);
                crate::array::from_fn(|k| a[k] + b[k] + c[k])
            })
            .collect();
        let mut tree = Tree {
            nodes: vec![],
            order: (0..count as u32).collect(),
        };
        if count > 0 {
            tree.split(0..count as u32, &corners, &middle);
        }
        tree
    }

    fn split(
        &mut self,
        range: std::ops::Range<u32>,
        corners: &impl Fn(usize) -> [Point; 3],
        middle: &[Point],
    ) -> u32 {
        let part = range.start as usize..range.end as usize;
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for n in &self.order[part.clone()] {
            for x in corners(*n as usize) {
                for a in 0..3 {
                    low[a] = low[a].min(x[a]);
                    high[a] = high[a].max(x[a]);
                }
            }
        }
        let node = self.nodes.len();
        self.nodes.push(Node {
            low,
            high,
            inside: Inside::Leaf(range.clone()),
        });
        if part.len() > LEAF {
            let longest = (0..3)
                .max_by(|a, b| (high[*a] - low[*a]).total_cmp(&(high[*b] - low[*b])))
                .unwrap_or(0);
            let half = part.len() / 2;
            self.order[part].select_nth_unstable_by(half, |a, b| {
                let at = |n: &u32| middle[*n as usize][longest];
                // equal ones in the order of their numbers: the same tree everywhere
                at(a).total_cmp(&at(b)).then(a.cmp(b))
            });
            let cut = range.start + half as u32;
            let first = self.split(range.start..cut, corners, middle);
            let second = self.split(cut..range.end, corners, middle);
            self.nodes[node].inside = Inside::Halves([first, second]);
        }
        node as u32
    }

    /// The triangle at the least distance from `x`, of equal ones that of the lowest number; `square(n)` is the square of that of
    /// triangle n.
    pub fn nearest(&self, x: &Point, mut square: impl FnMut(usize) -> f64) -> Option<usize> {
        let away = |node: u32| -> f64 {
            let node = &self.nodes[node as usize];
            (0..3)
                .map(|a| {
                    (node.low[a] - x[a])
                        .max(x[a] - node.high[a])
                        .max(0.0)
                        .powi(2)
                })
                .sum()
        };
        let mut best: Option<(f64, u32)> = None;
        // as deep as a tree of 2^32 halved triangles, one waiting half a level
        let mut waiting = [(0u32, 0.0f64); 40];
        let mut count = usize::from(!self.nodes.is_empty());
        if count > 0 {
            waiting[0] = (0, away(0));
        }
        while count > 0 {
            count -= 1;
            let (node, far) = waiting[count];
            if best.is_some_and(|(least, _)| far > least) {
                continue;
            }
            match &self.nodes[node as usize].inside {
                Inside::Leaf(range) => {
                    for n in &self.order[range.start as usize..range.end as usize] {
                        let found = (square(*n as usize), *n);
                        if best.is_none_or(|(least, m)| {
                            found.0 < least || (found.0 == least && *n < m)
                        }) {
                            best = Some(found);
                        }
                    }
                }
                Inside::Halves([a, b]) => {
                    let (a, b) = ((*a, away(*a)), (*b, away(*b)));
                    let (near, other) = if a.1 <= b.1 { (a, b) } else { (b, a) };
                    waiting[count] = other;
                    waiting[count + 1] = near;
                    count += 2;
                }
            }
        }
        best.map(|(_, n)| n as usize)
    }

    /// Does one of the triangles whose leaf meets the box from `low` to `high` fulfil something?
    pub fn any(&self, low: &Point, high: &Point, holds: &mut dyn FnMut(usize) -> bool) -> bool {
        !self.nodes.is_empty() && self.any_of(0, low, high, holds)
    }

    fn any_of(
        &self,
        node: u32,
        low: &Point,
        high: &Point,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        let node = &self.nodes[node as usize];
        if (0..3).any(|a| low[a] > node.high[a] || high[a] < node.low[a]) {
            return false;
        }
        match &node.inside {
            Inside::Leaf(range) => self.order[range.start as usize..range.end as usize]
                .iter()
                .any(|n| holds(*n as usize)),
            Inside::Halves(halves) => halves.iter().any(|h| self.any_of(*h, low, high, holds)),
        }
    }
}
