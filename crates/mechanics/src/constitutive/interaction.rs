//! Law and family become an interaction on a body.

use super::registry::{AnyPotentials, Neighbours, Place};
use super::{ConstitutiveModel, Laws};
use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::family::horizon::HorizonList;
use crate::family::links::Links;
use crate::interaction::atoms::breaking::Breaks;
use crate::interaction::linear::LinearInteraction;
use crate::interaction::list::{ListInteraction, ListParts};
use crate::interaction::micromoduli::MicromoduliInteraction;
use crate::interaction::pairs::BondTable;
use crate::interaction::stencil::{StencilInteraction, StencilParts};
use crate::interaction::weight::BondWeight;
use crate::interaction::{Interaction, PointConstants, Repulsion, Toughness};
use crate::law::influence::InfluenceFunction;
use crate::law::solid::bond_based::{BondBased, BondBasedMixed};
use crate::law::solid::dual_horizon::DualHorizon;
use crate::law::solid::eam_like::{EamLike, Solid};
use crate::message;
use crate::quantity::{Dimension, rounded};
use crate::spec::{AnyLinearBody, Influence};
use std::sync::Arc;

/// Of all materials, or of the only one.
fn picked<T: Copy>(all: &[T], only: Option<usize>) -> Vec<T> {
    match only {
        Some(n) => all.get(n).copied().into_iter().collect(),
        None => all.to_vec(),
    }
}

impl ConstitutiveModel {
    /// The interaction on `body`; `only` makes everything of one material.
    pub fn interaction<const D: usize>(
        &self,
        body: &Body<D>,
        only: Option<usize>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let made = self.made(body, only)?;
        self.weighed(body, made)
    }

    /// Whether an influence function that somebody wrote is one, on the bonds that there are.
    fn weighed<const D: usize>(
        &self,
        body: &Body<D>,
        made: Box<dyn Interaction<D>>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let Influence::Formula(formula) = self.influence else {
            return Ok(made);
        };
        let (mut wrong, mut most, mut bonds) = (None, 0.0f64, 0);
        let function = InfluenceFunction::new(self.influence, self.horizon);
        made.each_bond(body, &mut |i, j, xi, _| {
            let r = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            let turned = xi.map(|x| -x);
            let ends = self.horizons(body, [i, j]);
            for (xi, horizon) in [xi, turned].iter().flat_map(|xi| ends.map(|d| (xi, d))) {
                let omega = match horizon {
                    None => function.at(xi, r, 1.0 / r),
                    Some(horizon) => function.within(xi, r, 1.0 / r, horizon),
                };
                if !(omega >= 0.0 && omega.is_finite()) {
                    wrong.get_or_insert((r, omega));
                }
                most = most.max(omega);
            }
            bonds += 1;
        });
        let invalid = |message| {
            Err(BuildError::invalid("influence", message).help(
                "an influence function is 0 or positive on every bond: r from above 0 to delta",
            ))
        };
        let text = formula.source();
        let (elsewhere, most) = (body.exchange.any(wrong.is_some()), body.most(most));
        let bonds = body.count(bonds);
        match wrong {
            None if elsewhere => Err(BuildError::elsewhere(0)),
            Some((r, omega)) => invalid(message![
                format!("ω = {text} is {} at the bond length ", rounded(omega, 4)),
                Dimension::LENGTH.of(r),
                ", expected a positive number",
            ]),
            None if bonds > 0 && !(most > 0.0) => {
                invalid(message![format!("ω = {text} is 0 on every bond")])
            }
            None => Ok(made),
        }
    }

    /// Horizons of their own that the ends of a bond have (length).
    fn horizons<const D: usize>(&self, body: &Body<D>, ends: [usize; 2]) -> [Option<f64>; 2] {
        match &self.pairs {
            None => ends.map(|s| body.horizon.get(s).copied()),
            Some(pairs) => {
                let [a, b] = ends.map(|s| body.material_of(s));
                [Some(pairs.get(a, b).horizon); 2]
            }
        }
    }

    fn made<const D: usize>(
        &self,
        body: &Body<D>,
        only: Option<usize>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let toughness = picked(&self.toughness, only);
        if let (Some(pairs), None) = (&self.pairs, only) {
            return self.interaction_of_pairs(body, pairs, toughness);
        }
        let repulsion = match (&self.repulsion, only) {
            (Some(all), Some(n)) => Some(all.only(n)),
            (all, _) => all.clone(),
        };
        if let Some(named) = &self.named {
            return named.bind(Place {
                body,
                stencil: self.stencil.as_ref(),
                horizon: self.reach(),
                list: None,
                weight: BondWeight::new(self.influence, self.horizon, self.scaling()),
                toughness,
                criteria: match only {
                    Some(n) => self.criteria.only(n),
                    None => self.criteria.clone(),
                },
                repulsion,
                simd: self.simd,
                only,
            });
        }
        match &self.laws {
            Laws::Springs(c) => self.of_springs(body, *c),
            Laws::Micromoduli(linear) => self.of_micromoduli(body, linear),
            Laws::Atoms(potential) => self.of_atoms(body, potential, toughness),
            Laws::Bond(c) => self.of_bonds(body, picked(c, only), toughness, repulsion),
            Laws::Solid(s) => {
                let s = picked(s, only);
                let law = EamLike {
                    ratio: s[0].ratio(),
                };
                self.bind(body, law, PointConstants::Solid(s), toughness, repulsion)
            }
        }
    }

    fn of_springs<const D: usize>(
        &self,
        body: &Body<D>,
        c: f64,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let links = self.links(body)?;
        let volume = body.volume.uniform().unwrap_or(1.0);
        let modulus = |xi: [f64; D]| {
            let r0 = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            let k = c * self.weight(&xi, r0) * volume / (r0 * r0 * r0);
            crate::array::from_fn(|a| crate::array::from_fn(|b| k * xi[a] * xi[b]))
        };
        Ok(Box::new(LinearInteraction::new(
            body, links, self.simd, self.slice, modulus,
        )))
    }

    fn of_micromoduli<const D: usize>(
        &self,
        body: &Body<D>,
        linear: &AnyLinearBody,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let Some(linear) = linear.clone().of::<D>() else {
            let found = linear.dimension();
            return Err(BuildError::conflict(
                "micromoduli",
                format!("the micromoduli are those of a {found}-D body, this one has {D}"),
            ));
        };
        if linear.points() != body.all_points() {
            return Err(BuildError::conflict(
                "micromoduli",
                format!(
                    "there are micromoduli of {} points, the body has {}",
                    linear.points(),
                    body.all_points()
                ),
            ));
        }
        Ok(Box::new(MicromoduliInteraction::new(
            body, &linear, self.simd,
        )))
    }

    fn of_atoms<const D: usize>(
        &self,
        body: &Body<D>,
        potential: &AnyPotentials,
        toughness: Vec<Toughness>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        match (&body.layout, &self.stencil) {
            (Layout::Grid(_), Some(_)) => {
                let links = Neighbours::Linked(self.links(body)?);
                potential.bind(body, links, self.simd)
            }
            _ if self.held => {
                let breaks = self.breaks.then(|| Breaks {
                    toughness,
                    measure: self.criteria.measure.clone(),
                });
                let horizon = self.reach();
                potential.bind(body, Neighbours::Reference { horizon, breaks }, self.simd)
            }
            _ => potential.bind(body, Neighbours::Current, self.simd),
        }
    }

    fn of_bonds<const D: usize>(
        &self,
        body: &Body<D>,
        c: Vec<f64>,
        toughness: Vec<Toughness>,
        repulsion: Option<Repulsion>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        if !body.horizon.is_empty() {
            return self.of_variable_horizons(body, c[0], toughness, repulsion);
        }
        if c.iter().all(|x| *x == c[0]) {
            let law = BondBased { c: c[0] };
            self.bind(body, law, PointConstants::None, toughness, repulsion)
        } else {
            let law = BondBasedMixed { rule: self.rule };
            let constants = PointConstants::PerMaterial(c);
            self.bind(body, law, constants, toughness, repulsion)
        }
    }

    /// Length up to which pairs are bonds: whole multiples of the spacing are meant inclusively.
    pub fn reach(&self) -> f64 {
        match self.ratio {
            true => self.horizon * (1.0 + 1e-9),
            false => self.horizon,
        }
    }

    /// `ω ν` of bonds that weigh alike at both ends.
    fn bond_weight(&self) -> BondWeight {
        BondWeight::new(self.influence, self.horizon, self.scaling()).mean()
    }

    /// Length over which volumes fade at the horizon.
    fn scaling(&self) -> Option<f64> {
        self.scaling.then_some(self.spacing)
    }

    /// Bonds of a bond-based law between those slots of a cloud for which `across` holds; points repel by contact.
    pub fn interaction_across<const D: usize>(
        &self,
        body: &Body<D>,
        across: impl Fn(usize, usize) -> bool + Sync,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let Laws::Bond(c) = &self.laws else {
            return Err(BuildError::unsupported(
                "law",
                "an interface is made of bonds, and this law acts through its points",
            )
            .help("write law = { pmb = { ... } }"));
        };
        let reach = self.reach();
        let of = |i: usize, j: usize| if across(i, j) { reach } else { 0.0 };
        let list = HorizonList::within(body, reach, of)?;
        if let Some(named) = &self.named {
            let made = named.bind(Place {
                body,
                stencil: None,
                horizon: reach,
                list: Some(list),
                weight: BondWeight::new(self.influence, self.horizon, self.scaling()),
                toughness: self.toughness.clone(),
                criteria: self.criteria.clone(),
                repulsion: None,
                simd: self.simd,
                only: None,
            })?;
            return self.weighed(body, made);
        }
        let made = Box::new(ListInteraction::new(ListParts {
            body,
            list,
            law: BondBased { c: c[0] },
            weight: self.bond_weight(),
            point_constants: PointConstants::None,
            toughness: self.toughness.clone(),
            repulsion: None,
            simd: self.simd,
        }));
        self.weighed(body, made)
    }

    fn links<const D: usize>(&self, body: &Body<D>) -> Result<Links<D>, BuildError> {
        match (&body.layout, &self.stencil) {
            (Layout::Grid(grid), Some(stencil)) => Ok(Links::new(body, grid, stencil)),
            _ => Err(BuildError::unsupported(
                "family",
                "springs live on a lattice, this is a cloud of points",
            )
            .help("take a lattice body, or the law pmb")),
        }
    }

    fn bind<const D: usize, W: crate::law::Law>(
        &self,
        body: &Body<D>,
        law: W,
        point_constants: PointConstants,
        toughness: Vec<Toughness>,
        repulsion: Option<Repulsion>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        match (&body.layout, &self.stencil) {
            (Layout::Grid(_), Some(stencil)) => {
                Ok(Box::new(StencilInteraction::new(StencilParts {
                    body,
                    stencil,
                    law,
                    weight: &|xi, r0| self.weight(xi, r0),
                    point_constants,
                    toughness,
                    repulsion,
                    simd: self.simd,
                })))
            }
            _ => Ok(Box::new(ListInteraction::new(ListParts {
                body,
                list: HorizonList::new(body, self.reach())?,
                law,
                weight: self.bond_weight(),
                point_constants,
                toughness,
                repulsion,
                simd: self.simd,
            }))),
        }
    }

    /// Bonds of points with horizons of their own: at equal moduli c goes as the inverse of `∫ ω r dV`, `δ^−(D+1)` where nothing else is a length.
    fn of_variable_horizons<const D: usize>(
        &self,
        body: &Body<D>,
        c: f64,
        toughness: Vec<Toughness>,
        repulsion: Option<Repulsion>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let own = |i: usize| body.horizon[i];
        let half = self.bond_weight().fringe(self.spacing);
        let over = self.bond_weight().stiffnesses(body);
        let constants = (0..body.len).map(|i| match own(i) > 0.0 {
            true => [c * over[i], 0.5 + own(i) / self.spacing],
            // slots without a point
            false => [0.0, 0.5 + self.horizon / self.spacing],
        });
        let constants = constants.collect();
        let reach = |i: usize, j: usize| own(i).max(own(j)) + half;
        Ok(Box::new(ListInteraction::new(ListParts {
            body,
            list: HorizonList::within(body, self.horizon + half, reach)?,
            law: DualHorizon {
                rate: self.spacing.recip(),
                influence: InfluenceFunction::new(self.influence, self.horizon).mean(),
            },
            // ends weigh by their own
            weight: BondWeight::new(Influence::Constant, self.horizon, None),
            point_constants: PointConstants::PerPoint(constants),
            toughness,
            repulsion,
            simd: self.simd,
        })))
    }

    /// Laws of unit constants, with what pairs of materials have.
    fn interaction_of_pairs<const D: usize>(
        &self,
        body: &Body<D>,
        pairs: &Arc<BondTable>,
        toughness: Vec<Toughness>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        match &self.laws {
            Laws::Solid(solids) => {
                let unit = Solid {
                    kappa: 1.0,
                    beta: 1.0,
                    ..solids[0]
                };
                let law = EamLike {
                    ratio: unit.ratio(),
                };
                let constants = PointConstants::Solid(vec![unit; solids.len()]);
                self.list_of_pairs(body, pairs, law, constants, toughness)
            }
            // tables are of bonds or of solids
            Laws::Bond(_) | Laws::Springs(_) | Laws::Atoms(_) | Laws::Micromoduli(_) => {
                let law = BondBased { c: 1.0 };
                self.list_of_pairs(body, pairs, law, PointConstants::None, toughness)
            }
        }
    }

    fn list_of_pairs<const D: usize, W: crate::law::Law>(
        &self,
        body: &Body<D>,
        pairs: &Arc<BondTable>,
        law: W,
        point_constants: PointConstants,
        toughness: Vec<Toughness>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let horizon = |i: usize, j: usize| {
            let pair = pairs.get(body.material_of(i), body.material_of(j));
            pair.horizon
        };
        let parts = ListParts {
            body,
            list: HorizonList::within(body, self.horizon, horizon)?,
            law,
            weight: self.bond_weight(),
            point_constants,
            toughness,
            repulsion: self.repulsion.clone(),
            simd: self.simd,
        };
        Ok(Box::new(ListInteraction::of_pairs(parts, pairs.clone())))
    }
}
