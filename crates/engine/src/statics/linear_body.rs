//! A linear peridynamic body: points and micromoduli, whatever they came from.
//!
//! Force density at i: `L_i = Σ_j C_ij (u_j − u_i)` (silling2010, section 4, with `C_ij` the volume of j included).
//! State-based laws fit too: their rows reach two horizons.

use super::carriers::Carriers;
use std::any::Any;

/// Points, and which of them talk to which.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearBody<const D: usize> {
    /// `[N]` reference positions (length).
    pub position: Vec<[f64; D]>,
    /// `[N]` (length^D times the section).
    pub volume: Vec<f64>,
    /// `[N]` mass per volume.
    pub density: Vec<f64>,
    /// Period per axis, if periodic.
    pub period: [Option<f64>; D],
    /// `[N + 1]`: where each point's partners begin.
    pub start: Vec<usize>,
    /// Partners of each point, in ascending order, itself left out.
    pub partner: Vec<u32>,
    /// `C_ij` (force density / length) per partner.
    pub block: Vec<[[f64; D]; D]>,
    /// Of a condensed body: where its loads act.
    pub carriers: Option<Carriers<D>>,
}

/// A linear body of any dimension.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyLinearBody {
    One(LinearBody<1>),
    Two(LinearBody<2>),
    Three(LinearBody<3>),
}

impl AnyLinearBody {
    /// `None`: a dimension that there is not.
    pub fn new<const D: usize>(body: LinearBody<D>) -> Option<Self> {
        let mut body: Box<dyn Any> = Box::new(body);
        let made = match D {
            1 => Self::One(std::mem::replace(
                body.downcast_mut()?,
                LinearBody::nothing(),
            )),
            2 => Self::Two(std::mem::replace(
                body.downcast_mut()?,
                LinearBody::nothing(),
            )),
            _ => Self::Three(std::mem::replace(
                body.downcast_mut()?,
                LinearBody::nothing(),
            )),
        };
        Some(made)
    }

    /// Longest bond that acts (length).
    pub fn range(&self) -> f64 {
        match self {
            Self::One(b) => b.range(),
            Self::Two(b) => b.range(),
            Self::Three(b) => b.range(),
        }
    }

    /// Period per axis.
    pub fn period(&self) -> [Option<f64>; 3] {
        let padded = |p: &[Option<f64>]| std::array::from_fn(|a| p.get(a).copied().flatten());
        match self {
            Self::One(b) => padded(&b.period),
            Self::Two(b) => padded(&b.period),
            Self::Three(b) => padded(&b.period),
        }
    }

    pub fn dimension(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
            Self::Three(_) => 3,
        }
    }

    /// The body, if it has D dimensions.
    pub fn of<const D: usize>(self) -> Option<LinearBody<D>> {
        let body: Box<dyn Any> = match self {
            Self::One(b) => Box::new(b),
            Self::Two(b) => Box::new(b),
            Self::Three(b) => Box::new(b),
        };
        body.downcast().ok().map(|b| *b)
    }
}

/// How far a body is from what an elastic one must be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Soundness {
    /// Largest `|V_i C_ij − V_j C_jiᵀ|` over the largest `|V_i C_ij|`: 0 where action is reaction.
    pub asymmetry: f64,
    /// Largest force density under a rigid rotation (per radian) over the largest `Σ_j |C_ij||ξ|`: 0 for free bodies, about the
    /// reference without stress.
    pub rotation: f64,
}

fn largest<const D: usize>(c: &[[f64; D]; D]) -> f64 {
    c.iter().flatten().fold(0.0, |m, x| x.abs().max(m))
}

impl<const D: usize> LinearBody<D> {
    /// Without points.
    pub fn nothing() -> Self {
        LinearBody {
            position: vec![],
            volume: vec![],
            density: vec![],
            period: [None; D],
            start: vec![0],
            partner: vec![],
            block: vec![],
            carriers: None,
        }
    }

    pub fn points(&self) -> usize {
        self.position.len()
    }

    /// Partners and micromoduli of point `i`.
    pub fn row(&self, i: usize) -> (&[u32], &[[[f64; D]; D]]) {
        let row = self.start[i]..self.start[i + 1];
        (&self.partner[row.clone()], &self.block[row])
    }

    /// `C_ij`, if j is a partner of i.
    pub fn micromodulus(&self, i: usize, j: usize) -> Option<&[[f64; D]; D]> {
        let (partners, blocks) = self.row(i);
        let k = partners.binary_search(&(j as u32)).ok()?;
        Some(&blocks[k])
    }

    /// From `i` to `j`: the nearest image where axes are periodic (length).
    pub fn xi(&self, i: usize, j: usize) -> [f64; D] {
        std::array::from_fn(|a| {
            let x = self.position[j][a] - self.position[i][a];
            self.period[a].map_or(x, |p| x - p * (x / p).round())
        })
    }

    /// Force density on point `i` at displacements `u`.
    #[inline]
    pub fn force(&self, u: &[[f64; D]], i: usize) -> [f64; D] {
        let (partners, blocks) = self.row(i);
        let mut f = [0.0; D];
        for (&j, c) in partners.iter().zip(blocks) {
            for b in 0..D {
                let eta = u[j as usize][b] - u[i][b];
                for a in 0..D {
                    f[a] += c[a][b] * eta;
                }
            }
        }
        f
    }

    /// Longest bond that acts (length).
    pub fn range(&self) -> f64 {
        let mut range = 0.0f64;
        for i in 0..self.points() {
            let (partners, blocks) = self.row(i);
            for (&j, c) in partners.iter().zip(blocks) {
                if largest(c) > 0.0 {
                    let xi = self.xi(i, j as usize);
                    range = range.max(xi.iter().map(|x| x * x).sum::<f64>());
                }
            }
        }
        range.sqrt()
    }

    /// Is action reaction, and is a rotation free of force?
    pub fn soundness(&self) -> Soundness {
        let (mut most, mut apart, mut torque, mut scale) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for i in 0..self.points() {
            let (partners, blocks) = self.row(i);
            let mut turned = [[[0.0; D]; D]; D];
            let mut sum = 0.0;
            for (&j, c) in partners.iter().zip(blocks) {
                let j = j as usize;
                let back = self.micromodulus(j, i);
                for a in 0..D {
                    for b in 0..D {
                        let here = self.volume[i] * c[a][b];
                        let there = back.map_or(0.0, |back| self.volume[j] * back[b][a]);
                        most = most.max(here.abs());
                        apart = apart.max((here - there).abs());
                    }
                }
                let xi = self.xi(i, j);
                sum += largest(c) * xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                // spin in the plane of axes m < n: η = (−ξ_n, ξ_m)
                for m in 0..D {
                    for n in m + 1..D {
                        for a in 0..D {
                            turned[m][n][a] += c[a][n] * xi[m] - c[a][m] * xi[n];
                        }
                    }
                }
            }
            scale = scale.max(sum);
            torque = torque.max(turned.iter().flatten().map(|f| norm(f)).fold(0.0, f64::max));
        }
        let over = |x: f64, y: f64| if y > 0.0 { x / y } else { 0.0 };
        Soundness {
            asymmetry: over(apart, most),
            rotation: over(torque, scale),
        }
    }

    pub fn bytes(&self) -> usize {
        8 * (D + 2) * self.points()
            + 8 * self.start.len()
            + 4 * self.partner.len()
            + 8 * D * D * self.block.len()
            + self.carriers.as_ref().map_or(0, Carriers::bytes)
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three points of a chain, springs 1 and 2 between them.
    fn chain() -> LinearBody<1> {
        LinearBody {
            position: vec![[0.0], [1.0], [3.0]],
            volume: vec![1.0, 2.0, 1.0],
            density: vec![1.0; 3],
            period: [None],
            start: vec![0, 1, 3, 4],
            partner: vec![1, 0, 2, 1],
            block: [1.0, 0.5, 1.0, 2.0].map(|c| [[c]]).to_vec(),
            carriers: None,
        }
    }

    #[test]
    fn forces_are_those_of_springs() {
        let body = chain();
        let f = [0, 1, 2].map(|i| body.force(&[[0.0], [0.1], [0.4]], i));
        let expected = [0.1, -0.05 + 0.3, -0.6];
        assert!(
            f.iter()
                .zip(expected)
                .all(|(f, e)| (f[0] - e).abs() < 1e-15),
            "{f:?}"
        );
        assert_eq!(body.range(), 2.0);
        assert_eq!(
            body.soundness(),
            Soundness {
                asymmetry: 0.0,
                rotation: 0.0
            }
        );
        let mut unlike = chain();
        unlike.block[0][0][0] = 1.5;
        assert_eq!(unlike.soundness().asymmetry, 0.25);
    }

    #[test]
    fn a_rotation_needs_central_bonds() {
        // two points along x: a bond that resists shear alone turns against a rotation
        let bond = |c: [[f64; 2]; 2]| LinearBody::<2> {
            position: vec![[0.0, 0.0], [1.0, 0.0]],
            volume: vec![1.0; 2],
            density: vec![1.0; 2],
            period: [None; 2],
            start: vec![0, 1, 2],
            partner: vec![1, 0],
            block: vec![c; 2],
            carriers: None,
        };
        assert_eq!(bond([[3.0, 0.0], [0.0, 0.0]]).soundness().rotation, 0.0);
        assert_eq!(bond([[3.0, 0.0], [0.0, 3.0]]).soundness().rotation, 1.0);
    }
}
