//! Crystals of a peridynamic solid: points on a lattice, each with the volume of its cell.
//!
//! Forces per point are force densities times the volume; masses are ρV.

use super::cells::{links, primitive};
use super::error::{CrystalError, positive};
use super::lattice::{Bond, Crystal};
use peridyne::family::volume_fraction;
use peridyne::law::influence::mean_influence;
use peridyne::law::micromodulus::{Moments, micromodulus};
use peridyne::law::solid::eam_like::Solid;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{Calibration, Horizon, Influence, LawSpec, Plane};

/// A body of one material on a lattice, without boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeSolid {
    pub kind: LatticeKind,
    pub spacing: f64,
    pub horizon: Horizon,
    /// Thickness (2-D) or cross-section (1-D); 1 in 3-D.
    pub section: f64,
    /// Mass per volume.
    pub density: f64,
    pub influence: Influence,
    /// Partners' volumes fade at the horizon.
    pub partial_volume_correction: bool,
}

impl LatticeSolid {
    /// With ω = 1, unit section and density, and whole volumes.
    pub fn new(kind: LatticeKind, spacing: f64, horizon: Horizon) -> Self {
        LatticeSolid {
            kind,
            spacing,
            horizon,
            section: 1.0,
            density: 1.0,
            influence: Influence::Constant,
            partial_volume_correction: false,
        }
    }

    /// δ (length).
    pub fn delta(&self) -> f64 {
        self.horizon.length(self.spacing)
    }

    /// Volume of a point.
    pub fn volume(&self) -> f64 {
        self.kind.site_volume() * self.spacing.powi(self.kind.dimension() as i32) * self.section
    }

    /// Edge of a cube (square) of the volume of a point: over which the horizon cuts volumes.
    fn point(&self) -> f64 {
        let d = self.kind.dimension() as f64;
        self.spacing * libm::pow(self.kind.site_volume(), 1.0 / d)
    }

    /// `ω ν V` of a bond, the mean of both ends.
    fn weight<const D: usize>(&self, xi: &[f64; D], r0: f64) -> f64 {
        let omega = mean_influence(self.influence, xi, r0, self.delta());
        omega * self.fraction(r0) * self.volume()
    }

    /// ν
    fn fraction(&self, r0: f64) -> f64 {
        match self.partial_volume_correction {
            true => volume_fraction(r0, self.delta(), self.point()),
            false => 1.0,
        }
    }

    /// Sums over a family: `Σ ω ν V r0`, `Σ ω ν V r0²`, `Σ ν V r0`.
    pub fn moments<const D: usize>(&self) -> Result<Moments, CrystalError> {
        let bare = self.bonds::<D>(|_, _| [0.0; 2])?;
        let mut m = Moments {
            first: 0.0,
            second: 0.0,
            bare: 0.0,
        };
        for b in bare.bonds.iter().filter(|b| b.from == 0) {
            let r = b.length();
            let weight = self.weight(&b.xi, r);
            m.first += weight * r;
            m.second += weight * r * r;
            m.bare += self.fraction(r) * self.volume() * r;
        }
        Ok(m)
    }

    /// Bonds with `[stiffness, share]` by ξ and its length.
    fn bonds<const D: usize>(
        &self,
        law: impl Fn(&[f64; D], f64) -> [f64; 2],
    ) -> Result<Crystal<D>, CrystalError> {
        positive("the lattice spacing", self.spacing)?;
        positive("the density", self.density)?;
        positive("the section", self.section)?;
        positive("the horizon", self.delta())?;
        let (cell, sites) = primitive::<D>(self.kind)?;
        let links = links::<D>(self.kind, self.spacing, self.horizon)?;
        if links.is_empty() {
            return Err(CrystalError::NoNeighbours {
                reach: self.delta(),
                nearest: self.kind.nearest() * self.spacing,
            });
        }
        Ok(Crystal {
            cell: cell.map(|row| row.map(|x| x * self.spacing)),
            mass: vec![self.density * self.volume(); sites.len()],
            couplings: vec![],
            curvature: vec![0.0; sites.len()],
            basis: sites.iter().map(|s| s.map(|x| x * self.spacing)).collect(),
            bonds: links
                .iter()
                .map(|l| {
                    let xi = l.offset.map(|x| x * self.spacing);
                    let length = self.spacing * (l.squared as f64).sqrt() / 4.0;
                    let [stiffness, share] = law(&xi, length);
                    Bond {
                        from: l.from,
                        to: l.to,
                        xi,
                        tension: 0.0,
                        stiffness,
                        share,
                    }
                })
                .collect(),
        })
    }

    /// Bond-based (PMB) solid of micromodulus c: `stiffness = c ω ν V² / r0`.
    pub fn bond_based<const D: usize>(&self, c: f64) -> Result<Crystal<D>, CrystalError> {
        let v = self.volume();
        self.bonds(|xi, r| [c * self.weight(xi, r) * v / r, 0.0])
    }

    /// EAM-like solid (LPS): `stiffness = 2β ω ν V²/m`, `share = n ω ν V r0/m`, `F″ = κV`.
    pub fn state_based<const D: usize>(&self, solid: Solid) -> Result<Crystal<D>, CrystalError> {
        // the shares of a bond's ends would differ, which waves do not know
        if self.influence.is_directed() {
            return Err(CrystalError::Directed);
        }
        let v = self.volume();
        let m = self.moments::<D>()?.second;
        let mut crystal = self.bonds::<D>(|xi, r| {
            let w = self.weight(xi, r);
            [2.0 * solid.beta * w * v / m, solid.n * w * r / m]
        })?;
        crystal.curvature.fill(solid.kappa * v);
        Ok(crystal)
    }

    /// Any law of the engine's specification.
    pub fn of_law<const D: usize>(
        &self,
        law: &LawSpec,
        plane: Plane,
        calibration: Calibration,
    ) -> Result<Crystal<D>, CrystalError> {
        if let Some(solid) = Solid::of_law(D, plane, law) {
            return self.state_based(solid);
        }
        match law {
            // springs are the bond-based solid linearised, and so is every crystal
            LawSpec::Pmb(stiffness) | LawSpec::Springs(stiffness) => {
                let moments = match calibration {
                    Calibration::Discrete => self.moments::<D>()?,
                    Calibration::Continuum => {
                        Moments::continuum(D, self.delta(), self.section, self.influence)
                    }
                };
                self.bond_based(micromodulus(D, plane, *stiffness, moments))
            }
            LawSpec::Lps(_)
            | LawSpec::Lps3d { .. }
            | LawSpec::EamLike { .. }
            | LawSpec::Atoms(_)
            | LawSpec::Micromoduli(_) => Err(CrystalError::NotASolid),
            LawSpec::Named(law) => Err(CrystalError::Registered(law.name.clone())),
        }
    }
}
