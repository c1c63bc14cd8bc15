//! The linear peridynamic solid of `lps` as a law of this folder, whose bonds may remember: `lps` becomes this where they break by more than
//! the stretch that they have now.
//!
//! `W = ½κθ² + (β/2m) Σ ω ν V e²`, `θ = (n/m) Σ ω |ξ| ν V e`, `t = ω (nκθ|ξ|/m + βe/m)` along the bond (Silling et al. 2007; constants of
//! [`Solid`]). The weighted volume m is that of the family as it was.

use super::{Along, Bond, End, Material, Site};
use crate::law::descriptor::{self, Descriptor, Given, MODULI, Shelved};
use crate::law::number::Number;
use crate::law::solid::eam_like::Solid;
use crate::spec::{Influence, LawSpec, Parameters, Plane};

/// See the module.
#[derive(Debug, Clone)]
pub struct LinearSolid {
    /// Per material.
    pub materials: Vec<Solid>,
}

const BULK: usize = 0; // n²κ
const BETA: usize = 1;

const ALONG: usize = 0; // nκθ/m
const STIFF: usize = 1; // β/m

type Ends<'a, N> = End<'a, [N; 2], [N; 2], [N; 0]>;

impl LinearSolid {
    pub const NAME: &'static str = "linear_solid";
}

impl<const D: usize> Material<D> for LinearSolid {
    type Constants<N: Number> = [N; 2];
    /// 1/m
    type Form<N: Number> = N;
    /// `Σ ω|ξ|e`
    type Sum<N: Number> = N;
    type Point<N: Number> = [N; 2];
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 1;

    fn constants(&self, material: usize, _: f64) -> [f64; 2] {
        let Solid { n, kappa, beta } = self.materials[material];
        [n * n * kappa, beta]
    }

    fn form(&self, _: usize, shape: [[f64; D]; D]) -> f64 {
        super::inverse_weight(&shape)
    }

    #[inline(always)]
    fn share<N: Number>(&self, _: usize, bond: &Bond<N, D>, _: &Ends<N>) -> N {
        bond.omega * bond.length * bond.extension()
    }

    #[inline(always)]
    fn settle<N: Number>(
        &self,
        _: usize,
        site: &Site<[N; 2], N, [N; 0]>,
        sum: N,
        point: &mut [N; 2],
    ) {
        let per_m = *site.form;
        point[ALONG] = site.constants[BULK] * per_m * per_m * sum;
        point[STIFF] = site.constants[BETA] * per_m;
    }

    #[inline(always)]
    fn answer<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> Along<N> {
        let t = end.point[STIFF].fma(bond.extension(), end.point[ALONG] * bond.length);
        Along(bond.omega * t * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let e = bond.extension();
        N::constant(0.5) * end.point[STIFF] * bond.omega * e * e
    }

    /// ½κθ²
    #[inline(always)]
    fn point_energy<N: Number>(&self, site: &Site<[N; 2], N, [N; 0]>, sum: N, _: &[N; 2]) -> N {
        let dilated = *site.form * sum;
        N::constant(0.5) * site.constants[BULK] * dilated * dilated
    }
}

impl Shelved for LinearSolid {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "The linear peridynamic solid of lps, W = ½ κ θ² + β/(2m) Σ ω ν V e², whose bonds may remember; lps becomes this where fracture asks for more than the stretch of now. Two of young, poisson, bulk, shear.",
        )
        .source("Silling, Epton, Weckner, Xu & Askari 2007")
        .example("{ young = \"72 GPa\", poisson = 0.22 }")
        .influence(Influence::Inverse)
        .keys(&MODULI)
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(_: usize, _: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let all = materials.iter().enumerate().map(|(n, m)| {
            let missing = || (n, "a linear solid needs its moduli".to_string());
            m.solid.ok_or_else(missing)
        });
        Ok(LinearSolid {
            materials: all.collect::<Result<_, _>>()?,
        })
    }
}
