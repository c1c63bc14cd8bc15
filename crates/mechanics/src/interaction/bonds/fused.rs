//! Bonds of laws that are fused with their sweeps: bits and critical values are kept for them, numbers of a law they have themselves.

use super::law::{LawProperties, PointLaw};
use crate::law::material::{Columns, ReferenceFamily};
use crate::space::Point;
use std::sync::Arc;

impl<const D: usize> LawProperties<D> {
    /// Of a law that is fused with its sweeps.
    pub fn fused() -> Self {
        LawProperties {
            fused: true,
            constants: 0,
            form: 0,
            point: 0,
            past: 0,
            memory: 0,
            passes: 0,
            stretches: true,
            section: false,
            across: false,
            potential: true,
            form_of_whole: false,
            stiffens: false,
            stiffens_damaged: false,
            gathers: false,
            columns: Columns::default(),
            failure: None,
            temperature: None,
            fibres: vec![],
            asked: Arc::new(Fused),
        }
    }
}

/// What such a law says of places and families where nobody asks its sweeps: nothing.
struct Fused;

impl<const D: usize> PointLaw<D> for Fused {
    fn form(&self, _: usize, _: ReferenceFamily<D>, _: &mut [f64]) {}

    fn stiffness(&self, _: usize, _: ReferenceFamily<D>) -> f64 {
        1.0
    }

    fn at_place(&self, _: usize, _: &Point) -> Vec<f64> {
        vec![]
    }
}
