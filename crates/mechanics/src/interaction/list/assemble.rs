//! A list interaction from a body, its list of pairs and a law.

use super::ListInteraction;
use crate::body::Body;
use crate::execute::simd::Simd;
use crate::family::horizon::HorizonList;
use crate::interaction::bonds::family::Family;
use crate::interaction::bonds::law::LawProperties;
use crate::interaction::bonds::state::BondParts;
use crate::interaction::bonds::store::Store;
use crate::interaction::bonds::{BondState, CloudFamily};
use crate::interaction::criterion::Criteria;
use crate::interaction::pairs::BondTable;
use crate::interaction::weight::BondWeight;
use crate::interaction::{PointConstants, Repulsion, Toughness, laws_fields};
use crate::law::Law;
use std::sync::Arc;

/// Everything a list interaction is made of.
pub struct ListParts<'a, const D: usize, W> {
    pub body: &'a Body<D>,
    /// All pairs of this body within the horizon.
    pub list: HorizonList,
    pub law: W,
    /// `ω ν` of a bond.
    pub weight: BondWeight,
    pub point_constants: PointConstants,
    pub toughness: Vec<Toughness>,
    pub repulsion: Option<Repulsion>,
    pub simd: Simd,
}

impl<const D: usize, W: Law> ListInteraction<D, W> {
    pub fn new(parts: ListParts<D, W>) -> Self {
        Self::of_pairs(parts, Arc::default())
    }

    /// With constants of pairs of materials; the law is that of unit constants, `c = 1`, or `n = 3, κ = β = 1`.
    ///
    /// # Panics
    /// If the list is that of another body, or a material has no constants.
    pub fn of_pairs(parts: ListParts<D, W>, pairs: Arc<BondTable>) -> Self {
        laws_fields::<W>();
        let ListParts {
            body,
            list,
            law,
            weight,
            point_constants,
            toughness,
            repulsion,
            simd,
        } = parts;
        assert!(
            list.body == body.identity,
            "the list of another body: make one for this body"
        );
        let paired = pairs.materials() > 0;
        let alike = |r: &Repulsion| r.stiffness.one().is_some();
        let materials: Vec<u8> = match !paired && repulsion.as_ref().is_none_or(alike) {
            true => vec![],
            false => (0..body.len).map(|s| body.material_of(s) as u8).collect(),
        };
        if paired {
            let known = |m: &u8| (*m as usize) < pairs.materials();
            assert!(materials.iter().all(known), "constants of every material");
        }
        let parts = BondParts {
            body,
            near_horizon: list.near_horizon,
            family: CloudFamily::plain(body, list, weight),
            kind: "list",
            toughness,
            criteria: Criteria::default(),
            repulsion,
            held: vec![],
            simd,
        };
        let numbers = Store::zeros(parts.family.layout(0));
        let mut bonds = BondState::new(parts, LawProperties::fused(), numbers);
        bonds.material = materials;
        ListInteraction {
            bonds,
            law,
            scale: vec![],
            fields: vec![0.0; if W::FIELDS > 0 { 2 * body.len } else { 0 }],
            pressure: vec![],
            point_constants,
            pairs,
            spares: false,
        }
    }
}
