//! The bar of the examples: length 1, v = 0.005, and its coarse levels.

use peridyne::spec::LinearBody;
use peridyne_theory::coarsen::lattice::LatticeBlock;
use peridyne_theory::coarsen::{Options, Radius, Scheme, Selection, Volume, coarsen, schur};

use super::compare::failed;
use crate::Failure;

/// Spacing and volume of a node.
pub const V: f64 = 0.005;
/// Nodes per length of the bar, of a stripe, of r0.
pub const LENGTH: i64 = 200;
pub const STRIPE: i64 = 10;
/// Bonds are shorter than r0 = 10 v (open): decided by whole numbers.
pub const REACH: i64 = 9;

/// Where the nodes lie (erratum 6).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nodes {
    /// At (i + ½)v: 200 nodes, none on the border of a stripe or on the defect.
    Centred,
    /// At i v: 201 nodes, some on borders, which count to the stripe on their right, and one on the defect.
    OnBorders,
}

impl Nodes {
    pub const ALL: [Nodes; 2] = [Nodes::Centred, Nodes::OnBorders];

    pub fn name(self) -> &'static str {
        match self {
            Nodes::Centred => "centred",
            Nodes::OnBorders => "on-borders",
        }
    }

    fn block(self) -> LatticeBlock<1> {
        let (n, first) = match self {
            Nodes::Centred => (LENGTH, 0.5 * V),
            Nodes::OnBorders => (LENGTH + 1, 0.0),
        };
        LatticeBlock {
            first: [first],
            ..LatticeBlock::new([n as usize], V, REACH as f64)
        }
    }

    /// `C_ij = v C(i, j)`; both take numbers of nodes.
    pub fn bar(self, c: impl Fn(i64, i64) -> f64) -> LinearBody<1> {
        self.block().body(|_| true, |[i], [n]| V * c(i, i + n))
    }

    /// Twice the place of a node, in v.
    pub fn twice(self, i: i64) -> i64 {
        match self {
            Nodes::Centred => 2 * i + 1,
            Nodes::OnBorders => 2 * i,
        }
    }
}

/// `1 − |q − x|/r0` (example 1).
pub fn tent(i: i64, j: i64) -> f64 {
    1.0 - (j - i).abs() as f64 / 10.0
}

/// Is a node in a hard stripe? The first one is hard.
pub fn hard(i: i64) -> bool {
    i.div_euclid(STRIPE) % 2 == 0
}

/// 10 between nodes of hard stripes, 1 else (example 2).
pub fn striped(i: i64, j: i64) -> f64 {
    if hard(i) && hard(j) { 10.0 } else { 1.0 }
}

/// A coarse level.
pub struct Level {
    pub body: LinearBody<1>,
    /// Numbers of its nodes at level 0.
    pub node: Vec<usize>,
}

impl Level {
    pub fn x(&self) -> Vec<f64> {
        self.body.position.iter().map(|x| x[0]).collect()
    }
}

/// How levels are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Way {
    /// As published: free balls of 40 v and 80 v, rows as they come.
    Published,
    /// From the energy of the level below, balls of 16 v and 48 v.
    Energy,
    Exact,
}

/// Radii of levels 1 and 2 (v): not given; these reproduce the figures (erratum 4).
pub const RADII: [i64; 2] = [40, 80];
/// Of [`Way::Energy`]: coarse bonds are as long as two balls.
pub const ENERGY_RADII: [i64; 2] = [16, 48];

/// Options of a level of a given radius (v).
pub fn options(scheme: Scheme, radius: i64) -> Options {
    Options {
        scheme,
        radius: Radius::Fixed(radius as f64 * V),
        // the same body force density means the same force at every level
        volume: Volume::Kept,
        symmetrise: false,
        ..Options::default()
    }
}

/// Levels 0, 1, 2: every so many nodes of the level before, the first included.
pub fn levels(fine: LinearBody<1>, every: [u32; 2], way: Way) -> Result<[Level; 3], Failure> {
    let zero = Level {
        node: (0..fine.points()).collect(),
        body: fine,
    };
    let radii = match way {
        Way::Energy => ENERGY_RADII,
        Way::Published | Way::Exact => RADII,
    };
    let one = next(&zero, every[0], radii[0], way)?;
    let two = next(&one, every[1], radii[1], way)?;
    Ok([zero, one, two])
}

fn next(below: &Level, every: u32, radius: i64, way: Way) -> Result<Level, Failure> {
    let keep = Selection::every(every)
        .choose(&below.body)
        .map_err(failed)?;
    let body = match way {
        Way::Published => coarsen(&below.body, &keep, &options(Scheme::Rows, radius)).map(|c| c.0),
        Way::Energy => coarsen(&below.body, &keep, &options(Scheme::Energy, radius)).map(|c| c.0),
        Way::Exact => schur(&below.body, &keep).map(|(mut body, _)| {
            // back to v per node
            for i in 0..body.points() {
                let factor = body.volume[i] / V;
                let row = body.start[i]..body.start[i + 1];
                body.block[row].iter_mut().for_each(|c| c[0][0] *= factor);
                body.volume[i] = V;
            }
            body
        }),
    }
    .map_err(failed)?;
    Ok(Level {
        node: keep.iter().map(|k| below.node[*k as usize]).collect(),
        body,
    })
}

/// `½ Σ_j C_ij ξ²` of the node nearest to the middle, per length: a node of a coarse level stands for `stands` of level 0.
pub fn modulus(body: &LinearBody<1>, stands: f64) -> f64 {
    let i = body.points() / 2;
    let (partners, blocks) = body.row(i);
    let sum: f64 = (partners.iter().zip(blocks))
        .map(|(j, c)| c[0][0] * body.xi(i, *j as usize)[0].powi(2))
        .sum();
    0.5 * sum / stands
}
