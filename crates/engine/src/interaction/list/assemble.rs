//! A list interaction from a body, its list of pairs and a law.

use super::ListInteraction;
use super::kernel::BLOCK;
use crate::body::Body;
use crate::execute::blocks::PerBlock;
use crate::execute::simd::Simd;
use crate::family::horizon::HorizonList;
use crate::interaction::pairs::BondTable;
use crate::interaction::weight::BondWeight;
use crate::interaction::{PointConstants, Repulsion, Tally, Toughness, history, laws_fields};
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
        let mut reference = vec![0.0; 4 * body.len];
        for (slot, record) in reference.chunks_mut(4).enumerate() {
            record[..3].copy_from_slice(&body.position(slot));
            record[3] = body.volume.at(slot);
        }
        let critical = if history::remembers(repulsion.as_ref(), &toughness) {
            vec![f64::INFINITY; body.len]
        } else {
            vec![]
        };
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
        let blocks = list.slices().div_ceil(BLOCK);
        ListInteraction {
            body: body.identity,
            law,
            simd,
            weight,
            alive: list.present.clone(),
            scale: vec![],
            list,
            reference,
            moved: vec![0.0; 4 * body.len],
            fields: vec![0.0; if W::FIELDS > 0 { 2 * body.len } else { 0 }],
            pressure: vec![],
            point_constants,
            toughness,
            repulsion,
            materials,
            pairs,
            next: critical.clone(),
            critical,
            spares: false,
            period: body.period.map(|p| p.unwrap_or(0.0)),
            inv_period: body.period.map(|p| p.map_or(0.0, f64::recip)),
            tallies: PerBlock::new(blocks, Tally::default()),
            sums: PerBlock::sums(blocks),
        }
    }
}
