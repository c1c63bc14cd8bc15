//! What bonds know of their law and ask it, one point at a time.

use crate::law::material::fibres::Fibres;
use crate::law::material::{Columns, Material, Numbers, ReferenceFamily};
use crate::space::Point;
use std::sync::Arc;

/// What bonds ask of their law beside its functions: the same at all times.
pub struct LawProperties<const D: usize> {
    /// Do its sweeps break bonds where they find them, with numbers of their own?
    pub fused: bool,
    /// How many numbers it has of a material, of a point (three kinds of them), and of a directed bond.
    pub constants: usize,
    pub form: usize,
    pub point: usize,
    pub past: usize,
    pub memory: usize,
    /// Constants, functions and flags of [`Material`].
    pub passes: usize,
    pub stretches: bool,
    pub section: bool,
    pub across: bool,
    pub potential: bool,
    pub form_of_whole: bool,
    pub stiffens: bool,
    pub stiffens_damaged: bool,
    pub gathers: bool,
    pub columns: Columns,
    pub failure: Option<usize>,
    pub temperature: Option<usize>,
    pub fibres: Vec<Fibres<D>>,
    /// The law itself, point by point.
    pub asked: Arc<dyn PointLaw<D>>,
}

impl<const D: usize> LawProperties<D> {
    pub fn of<M: Material<D>>(law: &M, asked: Arc<dyn PointLaw<D>>) -> Self {
        LawProperties {
            fused: false,
            constants: <M::Constants<f64> as Numbers<f64>>::COUNT,
            form: <M::Form<f64> as Numbers<f64>>::COUNT,
            point: <M::Point<f64> as Numbers<f64>>::COUNT,
            past: <M::Past<f64> as Numbers<f64>>::COUNT,
            memory: <M::Memory<f64> as Numbers<f64>>::COUNT,
            passes: M::PASSES,
            stretches: M::STRETCHES,
            section: M::SECTION,
            across: M::ACROSS,
            potential: M::POTENTIAL,
            form_of_whole: M::FORM_OF_WHOLE,
            stiffens: M::STIFFENS,
            stiffens_damaged: M::STIFFENS_DAMAGED,
            gathers: M::GATHERS,
            columns: law.columns(),
            failure: law.failure(),
            temperature: law.temperature(),
            fibres: law.fibres(),
            asked,
        }
    }
}

/// What a law says of places, and of the families of points.
pub trait PointLaw<const D: usize>: Send + Sync {
    /// [`Material::form`], number by number.
    fn form(&self, material: usize, reference: ReferenceFamily<D>, numbers: &mut [f64]);
    /// [`Material::stiffness`]
    fn stiffness(&self, material: usize, reference: ReferenceFamily<D>) -> f64;
    /// [`Material::at_place`]
    fn at_place(&self, material: usize, place: &Point) -> Vec<f64>;
}
