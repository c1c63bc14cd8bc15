//! A linear peridynamic body: points and micromoduli, whatever they came from.
//!
//! Force density at i: `L_i = Σ_j C_ij (u_j − u_i)` (silling2010, section 4, with `C_ij` the volume of j included).
//! State-based laws fit too: their rows reach two horizons.

use super::rows::rows;
use super::{LoadMap, MassMatrix};
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
    pub load_map: Option<LoadMap<D>>,
    /// Inertia that couples points; `None`: every point has its own mass alone, volume times density. These are its masses lumped.
    pub mass: Option<MassMatrix<D>>,
}

/// A linear body of any dimension.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyLinearBody {
    One(LinearBody<1>),
    Two(LinearBody<2>),
    Three(LinearBody<3>),
}

impl AnyLinearBody {
    /// Does it say where loads act, or which masses couple points?
    pub fn is_coupled(&self) -> bool {
        match self {
            Self::One(b) => b.load_map.is_some() || b.mass.is_some(),
            Self::Two(b) => b.load_map.is_some() || b.mass.is_some(),
            Self::Three(b) => b.load_map.is_some() || b.mass.is_some(),
        }
    }

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

    /// Do the lists belong to each other?
    ///
    /// # Errors
    /// What does not fit.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::One(b) => b.check(),
            Self::Two(b) => b.check(),
            Self::Three(b) => b.check(),
        }
    }

    /// Has it a mass matrix that couples its points?
    pub fn couples_masses(&self) -> bool {
        match self {
            Self::One(b) => b.mass.is_some(),
            Self::Two(b) => b.mass.is_some(),
            Self::Three(b) => b.mass.is_some(),
        }
    }

    /// Longest bond, whether it acts or not (length).
    pub fn longest(&self) -> f64 {
        match self {
            Self::One(b) => b.longest(),
            Self::Two(b) => b.longest(),
            Self::Three(b) => b.longest(),
        }
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
        let padded = |p: &[Option<f64>]| crate::array::from_fn(|a| p.get(a).copied().flatten());
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
            load_map: None,
            mass: None,
        }
    }

    pub fn points(&self) -> usize {
        self.position.len()
    }

    /// Do the lists belong to each other: one volume and density for each point, rows within the partners, partners that exist?
    ///
    /// # Errors
    /// What does not fit.
    pub fn check(&self) -> Result<(), String> {
        let n = self.points();
        for (what, count) in [
            ("volumes", self.volume.len()),
            ("densities", self.density.len()),
        ] {
            if count != n {
                return Err(format!("{count} {what} of {n} points"));
            }
        }
        rows(&self.start, n, &self.partner, n)?;
        if self.partner.len() != self.block.len() {
            let (blocks, partners) = (self.block.len(), self.partner.len());
            return Err(format!("{blocks} micromoduli of {partners} partners"));
        }
        if let Some(mass) = &self.mass {
            mass.check(&self.masses())?;
        }
        match &self.load_map {
            Some(load_map) => load_map.check(n),
            None => Ok(()),
        }
    }

    /// `[N]` volume times density.
    pub fn masses(&self) -> Vec<f64> {
        let each = self.volume.iter().zip(&self.density);
        each.map(|(v, rho)| v * rho).collect()
    }

    /// Partners and micromoduli of point `i`.
    pub fn row(&self, i: usize) -> (&[u32], &[[[f64; D]; D]]) {
        let row = self.start[i]..self.start[i + 1];
        (&self.partner[row.clone()], &self.block[row])
    }

    /// Longest bond, whether it acts or not (length).
    pub fn longest(&self) -> f64 {
        let points = 0..self.points();
        let each = points.flat_map(|i| self.row(i).0.iter().map(move |j| self.xi(i, *j as usize)));
        let squares = each.map(|xi| xi.iter().map(|x| x * x).sum::<f64>());
        squares.fold(0.0, f64::max).sqrt()
    }

    /// `C_ij`, if j is a partner of i.
    pub fn micromodulus(&self, i: usize, j: usize) -> Option<&[[f64; D]; D]> {
        let (partners, blocks) = self.row(i);
        let k = partners.binary_search(&(j as u32)).ok()?;
        Some(&blocks[k])
    }

    /// From `i` to `j`: the nearest image where axes are periodic (length).
    pub fn xi(&self, i: usize, j: usize) -> [f64; D] {
        crate::array::from_fn(|a| {
            let x = self.position[j][a] - self.position[i][a];
            self.period[a].map_or(x, |p| x - p * (x / p).round())
        })
    }

    /// Longest bond that acts (length).
    pub fn range(&self) -> f64 {
        let mut range = 0.0f64;
        for i in 0..self.points() {
            let (partners, blocks) = self.row(i);
            for (&j, c) in partners.iter().zip(blocks) {
                if c.iter().flatten().any(|x| *x != 0.0) {
                    let xi = self.xi(i, j as usize);
                    range = range.max(xi.iter().map(|x| x * x).sum::<f64>());
                }
            }
        }
        range.sqrt()
    }

    pub fn bytes(&self) -> usize {
        8 * (D + 2) * self.points()
            + 8 * self.start.len()
            + 4 * self.partner.len()
            + 8 * D * D * self.block.len()
            + self.load_map.as_ref().map_or(0, LoadMap::bytes)
            + self.mass.as_ref().map_or(0, MassMatrix::bytes)
    }
}
