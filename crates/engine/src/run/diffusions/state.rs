//! What a model keeps of what spreads.

use crate::body::Body;
use crate::diffusion::{Diffusion, Places};
use crate::spec::{DiffusionMethod, Quantity};
use crate::state::Archive;

/// What is told of a quantity that spreads.
#[derive(Debug, Clone, PartialEq)]
pub struct DiffusionInfo {
    pub quantity: Quantity,
    pub method: DiffusionMethod,
    /// Diffusivity `k/(ρ c)` per material (length² / time).
    pub diffusivity: Vec<f64>,
    /// The longest explicit step (time).
    pub stable_step: f64,
    /// Square of the body's longest extent over the least diffusivity (time).
    pub spread: f64,
}

/// The transfers of a model.
#[derive(Debug, Clone, Default)]
pub(in crate::run) struct Diffusions {
    pub all: Vec<Diffusion>,
    pub(super) places: Places,
    /// Directed bonds broken when bonds were looked at last.
    pub(super) seen: u64,
    /// What expands: place of the transfer, its reference, and strain per value of each material.
    pub(super) grown: Vec<(usize, f64, Vec<f64>)>,
    /// Strain per slot now and before the last step; empty: nothing expands.
    pub(super) strain: Vec<f64>,
    pub(super) past: Vec<f64>,
    /// Work of the last step's expansion.
    pub(super) price: f64,
    /// What flow softens by and heats; `None`: no law knows a temperature, or no heat is conducted.
    pub(super) warmth: Option<Warmth>,
    /// The transfer that deformation heats, by its place, and its strain per value of each material.
    pub(super) heated: Option<(usize, Vec<f64>)>,
}

impl Diffusions {
    /// Passes what spreads through an archive.
    pub fn archive<const D: usize>(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        let places = &self.places;
        archive.each("each", &mut self.all, |t, a| t.archive(body, places, a));
        let mut grows = !self.past.is_empty();
        if !self.grown.is_empty() {
            archive.one("grows", &mut grows);
        }
        self.past.resize(if grows { body.len() } else { 0 }, 0.0);
        for (name, strain) in [
            ("strain", &mut self.strain),
            ("strain_before", &mut self.past),
        ] {
            body.archive_points(archive, name, (strain, 1), |slot, _| slot);
        }
        archive.one("price", &mut self.price);
        archive.given("warmth", &mut self.warmth, |warmth, archive| {
            body.archive_points(archive, "above", (&mut warmth.above, 1), |slot, _| slot);
        });
        if archive.loads() {
            for strain in [&mut self.strain, &mut self.past] {
                if !strain.is_empty() {
                    body.exchange().fill(strain);
                }
            }
        }
    }
}

/// The temperature that laws share with the body.
#[derive(Debug, Clone)]
pub(in crate::run) struct Warmth {
    /// Place of the heat among what spreads.
    pub(super) heat: usize,
    /// T_r of each material.
    pub(super) reference: Vec<f64>,
    /// T − T_r per slot, as laws had it at the start of their step.
    pub(super) above: Vec<f64>,
}
