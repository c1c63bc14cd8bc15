//! Laws of bonds that know nothing but their own stretch: two functions, and all else follows.

use super::{Along, Bond, End, Material};
use crate::law::descriptor::{self, Descriptor, Given, Key, Registered};
use crate::law::number::Number;
use crate::law::solid::linear::{ONE_STIFFNESS, stiffness};
use crate::spec::{BondMixing, LawSpec, Parameters, Plane};
use std::marker::PhantomData;

/// Bonds with a force state along themselves, `T = ½ c ω t(s)` and store `½ c ω |ξ| w(s)` at either end, `w′ = t`, `t = s + …` for small
/// stretches. c is the micromodulus that one of young, bulk, micromodulus gives; `K` numbers beside it are read by the functions.
pub trait BondLaw<const K: usize>: Send + Sync + 'static {
    /// Keys of those numbers.
    const NUMBERS: [Key; K];
    /// Have bonds between unlike materials a micromodulus by the rule of the spec? Else each end has its own half.
    const RULED: bool = false;

    /// Without the keys.
    fn descriptor() -> Descriptor;

    /// t(s)
    fn tension<N: Number>(numbers: [N; K], stretch: N) -> N;

    /// w(s)
    fn energy<N: Number>(numbers: [N; K], stretch: N) -> N;
}

/// Such a law on a body.
pub struct Bonds<L, const K: usize> {
    /// ½ c and the numbers of each material.
    materials: Vec<([f64; 1], [f64; K])>,
    /// What bonds between unlike micromoduli have; in parallel where all are alike.
    rule: BondMixing,
    law: PhantomData<L>,
}

type Constants<N, const K: usize> = ([N; 1], [N; K]);
type Ends<'a, N, const K: usize> = End<'a, Constants<N, K>, [N; 0], [N; 0]>;

impl<L: BondLaw<K>, const K: usize, const D: usize> Material<D> for Bonds<L, K> {
    type Constants<N: Number> = Constants<N, K>;
    type Form<N: Number> = [N; 0];
    type Sum<N: Number> = [N; 0];
    type Point<N: Number> = [N; 0];
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 0;
    const ALIKE: bool = true;
    const OF_BONDS: bool = true;
    const MEETS: bool = L::RULED;

    fn constants(&self, material: usize, _: f64) -> Constants<f64, K> {
        self.materials[material]
    }

    #[inline(always)]
    fn between<N: Number>(
        &self,
        ([own], numbers): Constants<N, K>,
        ([other], _): &Constants<N, K>,
    ) -> Constants<N, K> {
        let half = match self.rule {
            // each end has its own
            _ if !L::RULED => own,
            BondMixing::Arithmetic => N::constant(0.5) * (own + *other),
            BondMixing::Harmonic => (N::constant(2.0) * own * *other).div(own + *other),
            BondMixing::Minimum => own.least(*other),
        };
        ([half], numbers)
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N, K>) -> Along<N> {
        let ([c], numbers) = *end.constants;
        Along(c * bond.omega * L::tension(numbers, bond.stretch) * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N, K>) -> N {
        let ([c], numbers) = *end.constants;
        c * bond.omega * bond.length * L::energy(numbers, bond.stretch)
    }
}

impl<L: BondLaw<K>, const K: usize> Registered for Bonds<L, K> {
    fn descriptor() -> Descriptor {
        L::descriptor().keys(&ONE_STIFFNESS).keys(&L::NUMBERS)
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        stiffness(parameters).map(LawSpec::Pmb)
    }

    fn make(_: usize, _: Plane, all: &[Given]) -> Result<Self, (usize, String)> {
        let of = |given: &Given| {
            let c = { given.micromodulus }.ok_or("the law has no micromodulus")?;
            Ok(([0.5 * c], given.parameters.all(L::NUMBERS.map(|k| k.name))?))
        };
        Ok(Bonds {
            materials: descriptor::each(all, of)?,
            rule: BondMixing::Arithmetic,
            law: PhantomData,
        })
    }

    fn meeting(self, rule: BondMixing) -> Self {
        let mut unlike = self.materials.windows(2).map(|m| m[0].0 != m[1].0);
        match L::RULED && unlike.any(|is| is) {
            true => Bonds { rule, ..self },
            false => self,
        }
    }
}
