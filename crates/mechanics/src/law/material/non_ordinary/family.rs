//! Laws that take the deformation gradient of a family (Silling et al. 2007), with control of zero-energy modes (Silling 2017): any
//! [`Classical`] law on any family.
//!
//! `H = (Σ ω ν V η⊗ξ) K⁻¹`, `F = 1 + H`, `T⟨ξ⟩ = ω (P K⁻¹ ξ + g z)` with the part of the deformation that F does not see,
//! `z = η − Hξ`, and `g = G_z β/m`, `β = D(D+2) μ`: a control of G_z = 1 resists it as the linear peridynamic solid of the same shear
//! modulus would. `Σ ω ν V z⊗ξ = 0`, so it does no work on F: `W = ψ + (g/2) Σ ω ν V z²`. Of a law that flows the control softens as the
//! secant modulus of its flow does: else what F does not see would stay elastic, and hold many times the yield stress.
//! K is that of the whole bonds. Points whose bonds span no space have no P, but keep the control.

use super::{Asked, Classical, GRADIENT, Unseen, answered, on_a_family};
use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{self, Bounds, Descriptor, Given, Key, Need, Registered};
use crate::law::material::tensor::{self, Matrix};
use crate::law::material::{
    Bond, Columns, End, Free, Material, Numbers, ReferenceFamily, Site, Source, inverse_weight,
};
use crate::law::number::Number;
use crate::space::Point as Place;
use crate::spec::{LawSpec, Parameters, Plane};

/// A classical law on a family.
#[derive(Debug, Clone)]
pub struct NonOrdinary<L> {
    pub law: L,
    /// G_z of each material (–).
    pub control: Vec<f64>,
}

/// `K⁻¹`, 1/m, 1 where K can be inverted, and [`ReferenceFamily::reach`].
type Form<N, const D: usize> = (Matrix<N, D>, [N; 3]);
/// `P K⁻¹ − g H`, g.
type Answers<N, const D: usize> = (Matrix<N, D>, N);
/// `G_z β`, and what the stress reads.
type Constants<N, C> = (N, C);
/// What force states are made of, and what is remembered at the end of the step.
type Point<N, P, const D: usize> = (Answers<N, D>, P);
type EndOf<'a, N, L, const D: usize> = End<
    'a,
    Constants<N, <L as Classical<D>>::Constants<N>>,
    Point<N, <L as Classical<D>>::Past<N>, D>,
    [N; 0],
>;
type SiteOf<'a, N, L, const D: usize> = Site<
    'a,
    N,
    Constants<N, <L as Classical<D>>::Constants<N>>,
    Form<N, D>,
    <L as Classical<D>>::Past<N>,
>;

/// `Σ ω ν V η⊗ξ`, and `Σ ω ν V η²` where somebody asks for it.
type Sum<N, const D: usize> = (Matrix<N, D>, N);

/// H from the sum of the shares.
#[inline(always)]
fn gradient<N: Number, const D: usize>(form: &Form<N, D>, sum: &Sum<N, D>) -> Matrix<N, D> {
    tensor::product(&sum.0, &form.0)
}

/// What H does not see, `H K Hᵀ = S Hᵀ` taken away.
#[inline(always)]
fn unseen<N: Number, const D: usize>(
    form: &Form<N, D>,
    (control, across): (N, N),
    sum: &Sum<N, D>,
    h: &Matrix<N, D>,
) -> Unseen<N> {
    Unseen {
        stiffness: control * form.1[0],
        square: (sum.1 - tensor::contraction(&sum.0, h)).most(N::constant(0.0)),
        across,
        reach: form.1[2],
    }
}

/// η²
#[inline(always)]
fn square<N: Number, const D: usize>(eta: &[N; D]) -> N {
    let mut square = eta[0] * eta[0];
    for a in 1..D {
        square = eta[a].fma(eta[a], square);
    }
    square
}

/// `x` of a point whose bonds span the space, else `otherwise`: where F is not known a stress may be anything.
#[inline(always)]
fn known<N: Number, const D: usize>(form: &Form<N, D>, x: N, otherwise: N) -> N {
    form.1[1].choose(N::constant(0.5), otherwise, x)
}

/// What is remembered: the new where F is known, else what was before.
struct Either<'a, N, P, const D: usize> {
    form: &'a Form<N, D>,
    now: &'a P,
    before: &'a P,
}

impl<N: Number, P: Numbers<N>, const D: usize> Source<N> for Either<'_, N, P, D> {
    #[inline(always)]
    fn number(&self, n: usize) -> N {
        known(self.form, self.now.get(n), self.before.get(n))
    }
}

impl<L> NonOrdinary<L> {
    /// `G_z β` of a material (pressure).
    fn resistance<const D: usize>(&self, material: usize) -> f64
    where
        L: Classical<D>,
    {
        let d = D as f64;
        let beta = d * (d + 2.0) * self.law.shear(material);
        self.control[material] * beta
    }
}

impl<const D: usize, L: Classical<D>> Material<D> for NonOrdinary<L> {
    type Constants<N: Number> = Constants<N, L::Constants<N>>;
    type Form<N: Number> = Form<N, D>;
    type Sum<N: Number> = Sum<N, D>;
    type Point<N: Number> = Point<N, L::Past<N>, D>;
    type Past<N: Number> = L::Past<N>;
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Free<N, D>;
    const PASSES: usize = 1;
    const OF_FAMILY: bool = true;
    const SECTION: bool = true;
    const ACROSS: bool = L::ACROSS;
    const STRETCHES: bool = false;
    const POTENTIAL: bool = L::POTENTIAL;
    const STIFFENS: bool = true;
    const STIFFENS_DAMAGED: bool = true;
    const FORM_OF_WHOLE: bool = true;
    const PLACED: bool = L::PLACED;
    const READS: bool = false;

    fn columns(&self) -> Columns {
        let answers = Declaration::of_points(
            "force_state_gradient",
            Shape::Tensor,
            Dimension([-6, 1, -2, 0]),
            "P K⁻¹ − g H: what the force state of a bond is linear in ξ with (Silling et al. 2007).",
        );
        Columns {
            past: self.law.columns(),
            point: vec![answers.derived()],
            places: self.law.places(),
            ..Columns::default()
        }
    }

    fn failure(&self) -> Option<usize> {
        self.law.failure()
    }

    fn temperature(&self) -> Option<usize> {
        self.law.temperature()
    }

    fn constants(&self, material: usize, dt: f64) -> Self::Constants<f64> {
        let control = self.resistance::<D>(material);
        (control, self.law.constants(material, dt))
    }

    fn varies(&self) -> bool {
        self.law.varies()
    }

    fn constants_at(&self, material: usize, place: &Place) -> Result<Self::Constants<f64>, String> {
        let control = self.resistance::<D>(material);
        Ok((control, self.law.constants_at(material, place)?))
    }

    fn at_place(&self, material: usize, place: &Place) -> Vec<f64> {
        self.law.at_place(material, place)
    }

    fn form(&self, _: usize, reference: ReferenceFamily<D>) -> Form<f64, D> {
        let shape = reference.shape();
        let (inverse, whole) = tensor::inverse(shape);
        let sound = if whole { 1.0 } else { 0.0 };
        (inverse, [inverse_weight(&shape), sound, reference.reach])
    }

    /// `|δF|² ≤ |K⁻¹| Σ ω ν V |η|²`; of points without F the control alone, which goes with 1/m.
    fn stiffness(&self, _: usize, reference: ReferenceFamily<D>) -> f64 {
        tensor::greatest_of_inverse(reference.shape())
    }

    /// `ω η⊗ξ`, and `ω η²`
    #[inline(always)]
    fn pair_pass<N: Number>(&self, _: usize, bond: &Bond<N, D>, _: &EndOf<N, L, D>) -> Sum<N, D> {
        let mut sum = tensor::zero();
        for r in 0..D {
            let eta = bond.omega * bond.eta[r];
            for c in 0..D {
                sum[r][c] = eta * bond.xi[c];
            }
        }
        let whole = match L::SOFTENS {
            true => bond.omega * square(&bond.eta),
            false => N::constant(0.0),
        };
        (sum, whole)
    }

    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        _: usize,
        site: &SiteOf<N, L, D>,
        sum: Sum<N, D>,
        point: &mut Self::Point<N>,
    ) {
        let (form, (control, constants)) = (site.form, site.constants);
        let h = gradient(form, &sum);
        let now = answered(Asked {
            law: &self.law,
            constants,
            past: site.past,
            h: &h,
            unseen: unseen(form, (*control, site.around.section), &sum, &h),
        });
        let along = tensor::product(&now.stress, &form.0);
        let either = Either {
            form,
            now: &now.past,
            before: site.past,
        };
        let ((out, slope), past) = point;
        *past = <L::Past<N> as Numbers<N>>::read(&either, 0);
        let mut g = *control * form.1[0];
        if L::SOFTENS {
            g = g * self.law.control(past);
        }
        *slope = g;
        for r in 0..D {
            for c in 0..D {
                out[r][c] = known(form, along[r][c], N::constant(0.0)) - g * h[r][c];
            }
        }
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &EndOf<N, L, D>) -> Free<N, D> {
        let (along, g) = &end.point.0;
        let mut t = tensor::times(along, &bond.xi);
        for a in 0..D {
            t[a] = bond.omega * g.fma(bond.eta[a], t[a]);
        }
        Free(t)
    }

    /// `(g/2) ω η²`, of which the point takes back what F sees.
    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &EndOf<N, L, D>) -> N {
        N::constant(0.5) * end.point.0.1 * bond.omega * square(&bond.eta)
    }

    #[inline(always)]
    fn point_energy<N: Number>(
        &self,
        site: &SiteOf<N, L, D>,
        sum: Sum<N, D>,
        point: &Self::Point<N>,
    ) -> N {
        let h = gradient(site.form, &sum);
        let strained = answered(Asked {
            law: &self.law,
            constants: &site.constants.1,
            past: site.past,
            h: &h,
            unseen: unseen(site.form, (site.constants.0, site.around.section), &sum, &h),
        });
        let energy = strained.energy;
        let seen = N::constant(0.5) * point.0.1 * tensor::contraction(&sum.0, &h);
        known(site.form, energy, N::constant(0.0)) - seen
    }

    #[inline(always)]
    fn across<N: Number>(&self, _: &SiteOf<N, L, D>, point: &Self::Point<N>) -> N {
        self.law.across(&point.1)
    }

    #[inline(always)]
    fn remember<N: Number>(
        &self,
        site: &SiteOf<N, L, D>,
        point: &Self::Point<N>,
        past: &mut L::Past<N>,
    ) -> N {
        *past = point.1;
        self.law.dissipated(site.past, past)
    }
}

/// The key of `G_z`.
pub(super) const CONTROL: Key = descriptor::number(
    "control",
    Dimension::NUMBER,
    Bounds::NOT_NEGATIVE,
    "Stiffness G_z of the zero-energy-mode stabilisation, 1: that of the linear peridynamic solid; 0.1 by default.",
)
.need(Need::Optional);

/// G_z where nobody says.
const USUAL: f64 = 0.1;

impl<L: Registered> Registered for NonOrdinary<L> {
    const ISOTROPIC: bool = L::ISOTROPIC;
    const OWN_CRITICAL_STRETCH: bool = L::OWN_CRITICAL_STRETCH;

    fn descriptor() -> Descriptor {
        on_a_family::<L>()
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        L::linear(parameters)
    }

    fn brittle_energy(parameters: &Parameters, energy: f64) -> f64 {
        L::brittle_energy(parameters, energy)
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let control = |m: &Given| m.parameters.number(CONTROL.name).unwrap_or(USUAL);
        let law = L::make(d, plane, materials)?;
        if let Some(n) = materials
            .iter()
            .position(|m| super::takes_bonds(m.parameters))
        {
            return Err((
                n,
                format!(
                    "`{}` must be the same in all materials of a body: bonds across have one",
                    GRADIENT.name
                ),
            ));
        }
        Ok(NonOrdinary {
            law,
            control: materials.iter().map(control).collect(),
        })
    }
}
