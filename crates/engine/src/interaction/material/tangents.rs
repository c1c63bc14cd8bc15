//! Tangents by dual numbers.

use super::MaterialInteraction;
use super::family::Family;
use crate::body::{Body, Field};
use crate::interaction::BondTangent;
use crate::law::material::Material;

impl<const D: usize, F: Family<D>, M: Material<D>> MaterialInteraction<D, F, M> {
    pub(super) fn each_tangent(
        &mut self,
        _body: &Body<D>,
        _u: &Field<D>,
        _visit: &mut dyn FnMut(BondTangent<D>),
    ) {
    }
}
