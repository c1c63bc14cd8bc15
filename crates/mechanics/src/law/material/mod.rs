//! Laws of any kind: with memory, with tensors, along the bond or not. A law is a few small functions over [`Number`]s; families drive
//! them ([`crate::interaction::material`]), so one text serves lattices and clouds, every instruction set, and tangents.
//!
//! The force density on a point is `f_i = Σ_j ν V_j (T_i⟨ξ⟩ − T_j⟨−ξ⟩)` (Silling et al. 2007, (18)): each end answers for itself,
//! so action is reaction whatever the law says.

pub mod bond_rotation;
pub mod bonds;
pub mod elastic_plastic;
pub mod embedded_solid;
pub mod fibres;
pub mod lamina;
pub mod non_ordinary;
pub mod numbers;
pub mod position_aware;
pub mod section;
pub mod softening;
pub mod tensor;
pub mod thermoelastic;
pub mod thermoelastic_solid;
pub mod viscoelastic;

use crate::columns::Declaration;
use crate::law::descriptor::Registered;
use crate::law::number::Number;
pub use crate::law::partner::Partner;
use crate::space::Point;
use crate::spec::Parameters;
use fibres::Fibres;
pub use non_ordinary::{BondAssociated, NonOrdinary};
pub use numbers::{Numbers, Sink, Source};
pub use thermoelastic::Thermoelastic;
pub use thermoelastic_solid::ThermoelasticSolid;

/// All that come with the engine, a line each.
pub fn each(kinds: &mut impl Kinds) {
    kinds.law::<elastic_plastic::ElasticPlastic>();
    kinds.law_or_smaller::<viscoelastic::Viscoelastic, viscoelastic::Viscoelastic<1>>(
        viscoelastic::one_branch,
    );
    non_ordinary::each(kinds);
    kinds.solid::<position_aware::PositionAware>();
    kinds.solid::<bond_rotation::BondRotation>();
    kinds.solid::<lamina::Lamina>();
    kinds.law::<softening::Softening>();
    kinds.law::<bonds::Bonds<Thermoelastic, 0>>();
    kinds.law::<ThermoelasticSolid>();
    kinds.law::<embedded_solid::EmbeddedSolid>();
}

/// Who wants to see all of them ([`each`]).
pub trait Kinds {
    /// One of every dimension.
    fn law<M>(&mut self)
    where
        M: Registered + Material<1> + Material<2> + Material<3>;

    /// One that a smaller law S takes the place of where that fits the parameters of all materials.
    fn law_or_smaller<M, S>(&mut self, _fits: fn(&Parameters) -> bool)
    where
        M: Registered + Material<1> + Material<2> + Material<3>,
        S: Registered + Material<1> + Material<2> + Material<3>,
    {
        self.law::<M>();
    }

    /// One that means nothing on a line.
    fn solid<M>(&mut self)
    where
        M: Registered + Material<2> + Material<3>;

    /// One that another takes the place of where that fits the parameters of all materials.
    fn solid_or<M, O>(&mut self, _fits: fn(&Parameters) -> bool)
    where
        M: Registered + Material<2> + Material<3>,
        O: Registered + Material<2> + Material<3>,
    {
        self.solid::<M>();
    }
}

/// A bond as a law sees it from one of its ends.
#[derive(Debug, Clone, Copy)]
pub struct Bond<N, const D: usize> {
    /// From this end to the other in the reference (length).
    pub xi: [N; D],
    /// What the displacement of the other end is beyond that of this (length).
    pub eta: [N; D],
    /// |ξ| and its inverse.
    pub length: N,
    pub inv_length: N,
    /// Influence function ω(|ξ|); 0 of a bond that is not whole.
    pub omega: N,
    /// That of the other end, which has another horizon of its own.
    pub omega_back: N,
    /// `(|ξ+η| − |ξ|)/|ξ|`, without cancellation.
    pub stretch: N,
    /// `1/|ξ+η|` (1 / length)
    pub inv_current: N,
}

impl<N: Number, const D: usize> Bond<N, D> {
    /// A bond from ξ and η; slow and plain.
    #[inline(always)]
    pub fn new(xi: [N; D], eta: [N; D], omega: N) -> Self {
        let half = N::constant(0.5);
        let mut square = xi[0] * xi[0];
        let mut change = eta[0] * half.fma(eta[0], xi[0]);
        for a in 1..D {
            square = square + xi[a] * xi[a];
            change = change + eta[a] * half.fma(eta[a], xi[a]);
        }
        let length = square.sqrt();
        let e = (change + change).div(square);
        // the closed form of `execute::lane::series`, over any number
        let one = N::constant(1.0);
        let root = (one + e).sqrt();
        Bond {
            xi,
            eta,
            length,
            inv_length: length.recip(),
            omega,
            omega_back: omega,
            stretch: e.div(one + root),
            inv_current: (length * root).recip(),
        }
    }

    /// `|ξ+η| − |ξ|` (length).
    #[inline(always)]
    pub fn extension(&self) -> N {
        self.stretch * self.length
    }
}

/// What the bonds of a point have in common.
#[derive(Debug, Clone, Copy)]
pub struct End<'a, C, P, M> {
    /// Constants of the material of this end.
    pub constants: &'a C,
    /// What [`Material::point_update`] made.
    pub point: &'a P,
    /// What this end's bond remembers.
    pub memory: &'a M,
}

/// What a point has beside its bonds.
#[derive(Debug, Clone, Copy)]
pub struct Site<'a, N, C, F, H> {
    /// Constants of its material.
    pub constants: &'a C,
    /// What [`Material::form`] made of its family.
    pub form: &'a F,
    /// What the point remembers.
    pub past: &'a H,
    pub around: Around<N>,
}

/// What a point has from outside its body of D dimensions.
#[derive(Debug, Clone, Copy)]
pub struct Around<N> {
    /// Elastic strain across a body in plane strain, `−ε/(1 + ε)` of the strain ε by temperature or swelling; else 0.
    pub section: N,
}

/// The force state T⟨ξ⟩ of one end (force / volume²).
pub trait ForceState<N, const D: usize>: Copy {
    /// `T_i⟨ξ⟩ − T_j⟨−ξ⟩` at i, where `other` is the force state of j, of the bond as j sees it.
    fn pull(self, other: Self, bond: &Bond<N, D>) -> [N; D];
    /// `T⟨ξ⟩`
    fn alone(self, bond: &Bond<N, D>) -> [N; D];
    /// The force state of the other end, which is in the same state.
    fn mirrored(self) -> Self;
    /// So many times as much.
    fn times(self, factor: N) -> Self;
}

/// `factor x`; nothing of what has none left, whatever it would be.
#[inline(always)]
pub(crate) fn part_of<N: Number>(factor: N, x: N) -> N {
    let zero = N::constant(0.0);
    zero.choose(factor, factor * x, zero)
}

/// `T⟨ξ⟩ = t (ξ+η)`: along the bond, `t` over the current length.
#[derive(Debug, Clone, Copy)]
pub struct Along<N>(pub N);

impl<N: Number, const D: usize> ForceState<N, D> for Along<N> {
    #[inline(always)]
    fn pull(self, other: Self, bond: &Bond<N, D>) -> [N; D] {
        let both = self.0 + other.0;
        let mut pull = bond.xi;
        for a in 0..D {
            pull[a] = both * (bond.xi[a] + bond.eta[a]);
        }
        pull
    }
    #[inline(always)]
    fn alone(self, bond: &Bond<N, D>) -> [N; D] {
        self.pull(Along(N::constant(0.0)), bond)
    }
    #[inline(always)]
    fn mirrored(self) -> Self {
        self
    }
    #[inline(always)]
    fn times(self, factor: N) -> Self {
        Along(part_of(factor, self.0))
    }
}

/// `T⟨ξ⟩` in any direction.
#[derive(Debug, Clone, Copy)]
pub struct Free<N, const D: usize>(pub [N; D]);

impl<N: Number, const D: usize> ForceState<N, D> for Free<N, D> {
    #[inline(always)]
    fn pull(self, other: Self, _: &Bond<N, D>) -> [N; D] {
        let mut pull = self.0;
        for a in 0..D {
            pull[a] = self.0[a] - other.0[a];
        }
        pull
    }
    #[inline(always)]
    fn alone(self, _: &Bond<N, D>) -> [N; D] {
        self.0
    }
    #[inline(always)]
    fn mirrored(mut self) -> Self {
        for a in 0..D {
            self.0[a] = N::constant(0.0) - self.0[a];
        }
        self
    }
    #[inline(always)]
    fn times(mut self, factor: N) -> Self {
        for a in 0..D {
            self.0[a] = part_of(factor, self.0[a]);
        }
        self
    }
}

/// The reference family of a point, as a law may ask for it: any sum over its bonds.
#[derive(Clone, Copy)]
pub struct ReferenceFamily<'a, const D: usize> {
    each: &'a dyn Fn(&mut dyn FnMut(&Partner<D>)),
    /// Horizon of the point over that of the material, which has the longest one of the body (–).
    pub reach: f64,
    /// Has it lost any of its bonds?
    pub damaged: bool,
}

impl<'a, const D: usize> ReferenceFamily<'a, D> {
    /// Of what visits every bond, always in the same order.
    pub fn new(each: &'a dyn Fn(&mut dyn FnMut(&Partner<D>))) -> Self {
        ReferenceFamily {
            each,
            reach: 1.0,
            damaged: false,
        }
    }

    /// The same of a point with a horizon of its own.
    pub fn within(self, reach: f64) -> Self {
        ReferenceFamily { reach, ..self }
    }

    /// The same, which has lost bonds or not.
    pub fn damaged(self, damaged: bool) -> Self {
        ReferenceFamily { damaged, ..self }
    }

    /// Visit every bond.
    pub fn each(&self, mut visit: impl FnMut(&Partner<D>)) {
        (self.each)(&mut visit);
    }

    /// The shape tensor `K = Σ ω ν V_j ξ⊗ξ` (length² volume); its trace is the weighted volume m.
    pub fn shape(&self) -> [[f64; D]; D] {
        let mut shape = [[0.0; D]; D];
        self.each(|p| {
            let weight = p.omega * p.volume;
            for a in 0..D {
                for b in 0..D {
                    shape[a][b] += weight * p.xi[a] * p.xi[b];
                }
            }
        });
        shape
    }

    /// 1/m; 0 without bonds.
    pub fn inverse_weight(&self) -> f64 {
        inverse_weight(&self.shape())
    }
}

/// 1/m of a family from its shape tensor; 0 without bonds.
pub(crate) fn inverse_weight<const D: usize>(shape: &[[f64; D]; D]) -> f64 {
    let m = tensor::trace(shape);
    if m > 0.0 { 1.0 / m } else { 0.0 }
}

/// The columns that a law adds to the state, in the order of its numbers.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    /// Of [`Material::Memory`].
    pub memory: Vec<Declaration>,
    /// Of [`Material::Past`].
    pub past: Vec<Declaration>,
    /// Of the first numbers of [`Material::Point`]; others are nobody's business.
    pub point: Vec<Declaration>,
    /// Of [`Material::at_place`].
    pub places: Vec<Declaration>,
}

/// A law.
///
/// # Contract
/// - All functions are pure. Sums are over the intact bonds of a point, each times `ν V_j`.
/// - For every pass p below [`Material::PASSES`]: `S = Σ ν V_j share(p, bond, …)`, then `point_update(p, …, S, point)`. Passes begin with a
///   `point` of zeros; `pair_pass` sees the own point as the pass before left it. Then the force states of both ends of every bond are taken.
/// - [`Material::energy`] and [`Material::point_energy`] add up to a strain energy density `W_i`; with the memory held, the force state is
///   its derivative, `T_i⟨ξ⟩ = ∂W_i/∂(ξ+η) / (ν V_j)`. Energies of broken bonds and tests of force against energy rely on it. A law of
///   rates, which has no potential, has the work of its force state since the reference instead, to second order in the step.
/// - A rigid motion leaves `T` at rest and energies at 0, and turns `T` with the body.
/// - A step ends with [`Material::state_update`] for every whole bond and [`Material::remember`] for every point, at its end's displacements. The
///   force states of before must be those of after with a step of no length: they see the memory of before, and the constants know the step.
/// - Tangents are derivatives of these functions by dual numbers: nothing else about a law is assumed.
pub trait Material<const D: usize>: Send + Sync + 'static {
    /// Numbers of a material that its functions read.
    type Constants<N: Number>: Numbers<N>;
    /// What a point knows of its reference family; at most 32 numbers.
    type Form<N: Number>: Numbers<N>;
    /// What bonds give to their point.
    type Sum<N: Number>: Numbers<N>;
    /// What the point makes of it; the bonds of both ends read it.
    type Point<N: Number>: Numbers<N>;
    /// What a point remembers.
    type Past<N: Number>: Numbers<N>;
    /// What a directed bond remembers; zeros of a new one.
    type Memory<N: Number>: Numbers<N>;
    /// [`Along`] or [`Free`].
    type State<N: Number>: ForceState<N, D>;
    /// Sums before force states are taken.
    const PASSES: usize;
    /// Do its functions read the stretch of bonds?
    const STRETCHES: bool = true;
    /// Is a bond of one material in the same state at both its ends: do force state and memory not depend on points? True saves half.
    const ALIKE: bool = false;
    /// Do the sums of the family make its stiffness, with ω once in each of them and in each force state? Points may have horizons of their own then.
    const OF_FAMILY: bool = false;
    /// Do bonds make its stiffness, each with a micromodulus for all of its force state and ω once in it, and once in each sum? Points may have horizons of their
    /// own then, too: c goes as `1/∫ω|ξ|dV`, of each end its own, of laws that are [`ALIKE`](Material::ALIKE) at both ends the mean.
    const OF_BONDS: bool = false;
    /// Does it look at what is across a body in plane strain ([`Around::section`])? Bonds of a law that does not are expanded by (1 + ν) times
    /// what temperature or swelling gives them there: exact where it is linear and isotropic.
    const SECTION: bool = false;
    /// Does it say what the stress across a body in plane strain is ([`Material::across`])? That of a law that does not is the one of the
    /// linear isotropic solid of its moduli.
    const ACROSS: bool = false;
    /// Does a force state read constants? False saves finding those of the other end.
    const READS: bool = true;
    /// Do bonds between unlike materials have forces and energies by constants of their own ([`Material::between`])?
    const MEETS: bool = false;
    /// Are its force states slopes of its energy? Laws of rates have no potential.
    const POTENTIAL: bool = true;
    /// Does [`Material::form`] see the bonds that are whole now, or the family as it was?
    const FORM_OF_WHOLE: bool = false;
    /// Are bonds stiffer the shorter they are? Then steps that are stable in the reference need not be later.
    const STIFFENS: bool = false;
    /// Are points stiffer the fewer bonds they have ([`Material::stiffness`])? Likewise.
    const STIFFENS_DAMAGED: bool = false;
    /// Does a point remember the sum of what its bonds do ([`Material::gathered`])?
    const GATHERS: bool = false;
    /// May its constants differ from place to place ([`Material::varies`])?
    const PLACED: bool = false;

    /// Names of what the law remembers and makes.
    fn columns(&self) -> Columns {
        Columns::default()
    }

    /// Which number of [`Material::Past`] is a damage: a bond breaks when the mean of its ends reaches 1.
    fn failure(&self) -> Option<usize> {
        None
    }

    /// Which number of [`Material::Past`], and of the [`Material::Memory`] that is [gathered](Material::GATHERS) to it, is a temperature above that of
    /// reference. It grows in a step by what the law heats itself, and a body that conducts heat sets it before.
    fn temperature(&self) -> Option<usize> {
        None
    }

    /// Fibres of every material: bonds along them break at a stretch of their own, all others at that of the material; empty: there are none.
    fn fibres(&self) -> Vec<Fibres<D>> {
        vec![]
    }

    /// Constants of a material for a step of length `dt`; 0: time stands still.
    fn constants(&self, material: usize, dt: f64) -> Self::Constants<f64>;

    /// Do constants of any material differ from place to place? Then they know no step, and every point has its own.
    fn varies(&self) -> bool {
        false
    }

    /// Constants of a material at a place of the reference (length).
    ///
    /// # Errors
    /// What is wrong there.
    fn constants_at(&self, material: usize, _: &Point) -> Result<Self::Constants<f64>, String> {
        Ok(self.constants(material, 0.0))
    }

    /// Numbers of the columns that a law makes of a material and a place of the reference (length), one after the other.
    fn at_place(&self, _material: usize, _place: &Point) -> Vec<f64> {
        vec![]
    }

    /// From its reference family.
    fn form(&self, _material: usize, _reference: ReferenceFamily<D>) -> Self::Form<f64> {
        <Self::Form<f64> as Numbers<f64>>::constant(0.0)
    }

    /// What the stiffness of a point against its bonds goes with, of any measure: the least c of `W ≤ c Σ ω ν V_j |η|²`, or what is above it by a
    /// factor that is the same for intact and damaged families.
    fn stiffness(&self, _material: usize, _reference: ReferenceFamily<D>) -> f64 {
        1.0
    }

    /// What a bond gives to its point.
    #[inline(always)]
    fn pair_pass<N: Number>(
        &self,
        _pass: usize,
        _bond: &Bond<N, D>,
        _end: &End<Self::Constants<N>, Self::Point<N>, Self::Memory<N>>,
    ) -> Self::Sum<N> {
        <Self::Sum<N> as Numbers<N>>::constant(0.0)
    }

    /// What the point makes of the sum.
    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        _pass: usize,
        _site: &Site<N, Self::Constants<N>, Self::Form<N>, Self::Past<N>>,
        _sum: Self::Sum<N>,
        _point: &mut Self::Point<N>,
    ) {
    }

    /// Constants of this end's half of a bond, `own` those of its material and `_other` of the other end's; force states and energies read them.
    #[inline(always)]
    fn between<N: Number>(
        &self,
        own: Self::Constants<N>,
        _other: &Self::Constants<N>,
    ) -> Self::Constants<N> {
        own
    }

    /// The force state of this end.
    fn force_state<N: Number>(
        &self,
        bond: &Bond<N, D>,
        end: &End<Self::Constants<N>, Self::Point<N>, Self::Memory<N>>,
    ) -> Self::State<N>;

    /// What this end's half of the bond stores (energy / volume²), and dissipates in the step, if its constants know one and
    /// [`Material::point_energy`] does not say it.
    fn energy<N: Number>(
        &self,
        bond: &Bond<N, D>,
        end: &End<Self::Constants<N>, Self::Point<N>, Self::Memory<N>>,
    ) -> N;

    /// What the point stores beside that (energy / volume), with the sum of the last pass.
    #[inline(always)]
    fn point_energy<N: Number>(
        &self,
        _site: &Site<N, Self::Constants<N>, Self::Form<N>, Self::Past<N>>,
        _sum: Self::Sum<N>,
        _point: &Self::Point<N>,
    ) -> N {
        N::constant(0.0)
    }

    /// Stress across a body in plane strain, of a point that has settled.
    #[inline(always)]
    fn across<N: Number>(
        &self,
        _site: &Site<N, Self::Constants<N>, Self::Form<N>, Self::Past<N>>,
        _point: &Self::Point<N>,
    ) -> N {
        N::constant(0.0)
    }

    /// Can the memory of these points' bonds, or of the points, have moved in this step? False saves time.
    fn moves<N: Number>(&self, _point: &Self::Point<N>) -> bool {
        true
    }

    /// The bond's memory at the end of a step; returns what that dissipated (energy / volume²), to second order in the step.
    fn state_update<N: Number>(
        &self,
        _bond: &Bond<N, D>,
        _end: &End<Self::Constants<N>, Self::Point<N>, Self::Memory<N>>,
        _memory: &mut Self::Memory<N>,
    ) -> N {
        N::constant(0.0)
    }

    /// What the point remembers of a bond's memory at the end of a step; times `ν V_j`, and all bonds together, it is the `past` that
    /// [`Material::remember`] is given then.
    #[inline(always)]
    fn gathered<N: Number>(
        &self,
        _bond: &Bond<N, D>,
        _end: &End<Self::Constants<N>, Self::Point<N>, Self::Memory<N>>,
        _memory: &Self::Memory<N>,
    ) -> Self::Past<N> {
        <Self::Past<N> as Numbers<N>>::constant(0.0)
    }

    /// The point's memory at the end of a step; returns what that dissipated (energy / volume), to second order in the step.
    #[inline(always)]
    fn remember<N: Number>(
        &self,
        _site: &Site<N, Self::Constants<N>, Self::Form<N>, Self::Past<N>>,
        _point: &Self::Point<N>,
        _past: &mut Self::Past<N>,
    ) -> N {
        N::constant(0.0)
    }
}
