//! Laws that take a deformation gradient: any [`Classical`] law on any family, with the gradient of the whole family
//! ([`NonOrdinary`]) or one for each bond ([`BondAssociated`]).

pub mod anisotropic;
mod bond;
pub mod correspondence;
mod direction;
pub mod energy;
pub mod equation_of_state;
mod family;
pub mod fluid;
pub mod hardening;
pub mod hyperelastic;
pub mod hypoelastic;
pub mod hypoelastic_plastic;
pub mod rate;
mod rest;
pub mod stiffness;
mod thickness;
#[cfg(test)]
mod tried;

pub use bond::BondAssociated;
pub use family::NonOrdinary;

use super::tensor::{self, Matrix};
use super::{Kinds, Numbers};
use crate::columns::Declaration;
use crate::execute::lane::Piece;
use crate::law::descriptor::{Descriptor, Key, Need, Registered, Value};
use crate::law::number::Number;
use crate::space::Point;
use crate::spec::Parameters;

/// A law of the deformation gradient alone. With [`Registered`] it is on the registry twice: [`NonOrdinary`], and [`BondAssociated`].
pub trait Classical<const D: usize>: Send + Sync + 'static {
    /// Numbers of a material that its stress reads.
    type Constants<N: Number>: Numbers<N>;
    /// What a point remembers.
    type Past<N: Number>: Numbers<N>;
    /// [`Material::POTENTIAL`](super::Material::POTENTIAL)
    const POTENTIAL: bool = true;
    /// Does its control soften?
    const SOFTENS: bool = false;
    /// [`Material::PLACED`](super::Material::PLACED)
    const PLACED: bool = false;

    /// What a point remembers, in the order of its numbers.
    fn columns(&self) -> Vec<Declaration> {
        vec![]
    }

    /// [`Material::failure`](super::Material::failure)
    fn failure(&self) -> Option<usize> {
        None
    }

    /// [`Material::temperature`](super::Material::temperature)
    fn temperature(&self) -> Option<usize> {
        None
    }

    /// Constants of a material for a step of length `dt`; 0: time stands still.
    fn constants(&self, material: usize, dt: f64) -> Self::Constants<f64>;

    /// [`Material::varies`](super::Material::varies)
    fn varies(&self) -> bool {
        false
    }

    /// [`Material::constants_at`](super::Material::constants_at)
    ///
    /// # Errors
    /// What is wrong there.
    fn constants_at(&self, material: usize, _: &Point) -> Result<Self::Constants<f64>, String> {
        Ok(self.constants(material, 0.0))
    }

    /// What it shows of a material and a place of the reference.
    fn places(&self) -> Vec<Declaration> {
        vec![]
    }

    /// [`Material::at_place`](super::Material::at_place)
    fn at_place(&self, _material: usize, _place: &Point) -> Vec<f64> {
        vec![]
    }

    /// Shear modulus of small strains (pressure).
    fn shear(&self, material: usize) -> f64;

    /// What was dissipated between two memories (energy / volume); what is stored then leaves it out.
    #[inline(always)]
    fn dissipated<N: Number>(&self, _before: &Self::Past<N>, _after: &Self::Past<N>) -> N {
        N::constant(0.0)
    }

    /// [`Material::ACROSS`](super::Material::ACROSS)
    const ACROSS: bool = false;

    /// Stress across a body in plane strain, of what is remembered (force / area of the reference).
    #[inline(always)]
    fn across<N: Number>(&self, _past: &Self::Past<N>) -> N {
        N::constant(0.0)
    }

    /// In the plane: is the strain across whatever leaves no stress there ([`Stressed::across`]), as in a sheet whose faces are free?
    fn is_sheet(&self) -> bool {
        false
    }

    /// Where the search for that strain begins, `J − 1` of the plane given.
    #[inline(always)]
    fn thickness<N: Number>(&self, _past: &Self::Past<N>, dilation: N) -> N {
        // half of what would keep the volume
        N::constant(-0.5) * dilation.div(N::constant(1.0) + dilation)
    }

    /// What is left of its control, 1 at first.
    #[inline(always)]
    fn control<N: Number>(&self, _past: &Self::Past<N>) -> N {
        N::constant(1.0)
    }

    /// At `F = 1 + H`, without cancellation where H is small.
    fn stress<N: Number>(
        &self,
        constants: &Self::Constants<N>,
        past: &Self::Past<N>,
        h: &Matrix<N, D>,
        unseen: &Unseen<N>,
    ) -> Stressed<N, Self::Past<N>, D>;
}

/// What F does not see of a deformation: the first two of a law whose control does not soften 0.
#[derive(Debug, Clone, Copy)]
pub struct Unseen<N> {
    /// g of the control that is not softened (pressure / length² volume).
    pub stiffness: N,
    /// `Σ ω ν V z²` (length² volume).
    pub square: N,
    /// Elastic strain across a plane: [`Around::section`](super::Around::section), or that of a sheet.
    pub across: N,
    /// [`ReferenceFamily::reach`](super::ReferenceFamily::reach), 1 of a bond.
    pub reach: N,
}

impl<N: Number> Unseen<N> {
    /// `cof F − 1` and det F − 1 of the solid, from H of a plane.
    #[inline(always)]
    pub fn space<const D: usize>(&self, h: &Matrix<N, D>) -> (Matrix<N, D>, N) {
        let mut cofactors = tensor::cofactor_beyond(h);
        let mut dilation = tensor::dilation(h);
        if D == 2 {
            for r in 0..D {
                for c in 0..D {
                    cofactors[r][c] = self.across.fma(cofactors[r][c], cofactors[r][c]);
                }
                cofactors[r][r] = cofactors[r][r] + self.across;
            }
            dilation = self.across.fma(dilation, dilation) + self.across;
        }
        (cofactors, dilation)
    }
}

/// The stress of a classical law at a deformation gradient.
#[derive(Debug, Clone, Copy)]
pub struct Stressed<N, P, const D: usize> {
    /// First Piola–Kirchhoff stress P.
    pub stress: Matrix<N, D>,
    /// That across a plane (force / area of the reference), of laws that may be a sheet; else 0.
    pub across: N,
    /// What is stored and what the step dissipated, or the work done where nothing is stored (energy / volume).
    pub energy: N,
    /// What is remembered then.
    pub past: P,
}

/// [`Classical::stress`], compiled once for each kind of number, whatever asks for it.
struct Asked<'a, L: Classical<D>, N: Number, const D: usize> {
    law: &'a L,
    constants: &'a L::Constants<N>,
    past: &'a L::Past<N>,
    h: &'a Matrix<N, D>,
    unseen: Unseen<N>,
}

impl<L: Classical<D>, N: Number, const D: usize> Piece for Asked<'_, L, N, D> {
    type Out = Stressed<N, L::Past<N>, D>;

    #[inline(always)]
    fn run(self) -> Self::Out {
        self.law
            .stress(self.constants, self.past, self.h, &self.unseen)
    }
}

/// The stress of a law, which finds the thickness of a sheet itself.
#[inline(always)]
fn answered<N: Number, L: Classical<D>, const D: usize>(
    asked: Asked<'_, L, N, D>,
) -> Stressed<N, L::Past<N>, D> {
    match D == 2 && asked.law.is_sheet() {
        true => thickness::relaxed(&asked),
        false => N::out_of_line(asked),
    }
}

/// All of them, a line each.
pub(super) fn each(kinds: &mut impl Kinds) {
    fn both<L: Registered + Classical<2> + Classical<3>>(kinds: &mut impl Kinds) {
        kinds.solid_or::<NonOrdinary<L>, BondAssociated<L>>(takes_bonds);
    }
    both::<correspondence::Correspondence>(kinds);
    both::<hyperelastic::Hyperelastic>(kinds);
    both::<hypoelastic::Hypoelastic>(kinds);
    both::<hypoelastic_plastic::HypoelasticPlastic>(kinds);
    both::<anisotropic::Anisotropic>(kinds);
    // its bonds see no more than their family
    kinds.solid::<NonOrdinary<fluid::Fluid>>();
}

/// Which deformation gradient a law takes.
const GRADIENT: Key = Key {
    name: "gradient",
    value: Value::Word(&[
        (
            "family",
            "one F for the family, and a zero-energy-mode stabilisation (Silling et al. 2007; Silling 2017)",
        ),
        (
            "bond",
            "one F for each bond, which maps that bond exactly: nothing is unseen (Breitzman & Dayal 2018)",
        ),
    ]),
    need: Need::Word("family"),
    doc: "The deformation gradient of the law.",
};

/// Does a material take the gradients of its bonds?
pub fn takes_bonds(parameters: &Parameters) -> bool {
    parameters.word(GRADIENT.name) == Some("bond")
}

/// What a classical law says of itself, on a family.
fn on_a_family<L: Registered>() -> Descriptor {
    let mut descriptor = L::descriptor();
    descriptor.keys.extend([GRADIENT, family::CONTROL]);
    descriptor
}
