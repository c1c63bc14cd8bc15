//! The linear peridynamic solid in general sweeps, as where bodies expand: `W = ½κθ² + (α/2) Σ ω e²`, `α = β/m`, `θ = (n/m) Σ ω |ξ| e` of
//! [`Solid`], with the extension e counted, as for every law of this folder, from the length that the ends' temperature or concentration gives a bond.
//! `T⟨ξ⟩ = ω ((nκθ/m) |ξ| + α e)` along the bond, over its whole bonds, with the m of the family as it was.

use super::{Along, Bond, End, Material, ReferenceFamily, Site};
use crate::law::descriptor::{self, Descriptor, Given, Key, MODULI, Registered, word};
use crate::law::number::Number;
use crate::law::solid::eam_like::Solid;
use crate::law::solid::linear::{EamLike, Linear, Lps, Lps3d};
use crate::spec::{Influence, LawSpec, Parameters, Plane};

/// See the module.
#[derive(Debug, Clone)]
pub struct ThermoelasticSolid {
    /// Per material.
    pub materials: Vec<Solid>,
}

/// n²κ and β.
const VOLUME: usize = 0;
const PAIR: usize = 1;
/// `nκθ/m` and α, which bonds read, and θ/n.
const PRESSURE: usize = 0;
const ALPHA: usize = 1;
const DILATED: usize = 2;

type Ends<'a, N> = End<'a, [N; 2], [N; 3], [N; 0]>;

/// Whose κ and β the moduli give.
const FORMULAS: Key = word(
    ThermoelasticSolid::FORMULAS,
    &[
        (
            Lps::NAME,
            "those of a solid of as many dimensions as the body has",
        ),
        (
            Lps3d::NAME,
            "those of three dimensions in any body: κ = K − 5G/3, β = 15 G",
        ),
        (
            EamLike::NAME,
            "the same, with contact as stiff as in a body of as many dimensions",
        ),
    ],
    "The law whose constants the moduli give.",
);

impl ThermoelasticSolid {
    pub const NAME: &'static str = "thermoelastic_solid";
    pub(crate) const FORMULAS: &'static str = "formulas";
}

impl<const D: usize> Material<D> for ThermoelasticSolid {
    type Constants<N: Number> = [N; 2];
    /// 1/m
    type Form<N: Number> = N;
    /// `Σ ω|ξ|e`
    type Sum<N: Number> = N;
    type Point<N: Number> = [N; 3];
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 1;
    const OF_FAMILY: bool = true;

    fn constants(&self, material: usize, _: f64) -> [f64; 2] {
        let m = &self.materials[material];
        [m.n * m.n * m.kappa, m.beta]
    }

    fn form(&self, _: usize, reference: ReferenceFamily<D>) -> f64 {
        reference.inverse_weight()
    }

    #[inline(always)]
    fn pair_pass<N: Number>(&self, _: usize, bond: &Bond<N, D>, _: &Ends<N>) -> N {
        bond.omega * bond.length * bond.extension()
    }

    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        _: usize,
        site: &Site<N, [N; 2], N, [N; 0]>,
        sum: N,
        point: &mut [N; 3],
    ) {
        let (c, per_m) = (site.constants, *site.form);
        point[DILATED] = per_m * sum;
        point[ALPHA] = c[PAIR] * per_m;
        point[PRESSURE] = c[VOLUME] * per_m * point[DILATED];
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> Along<N> {
        let along = end.point[PRESSURE] * bond.length;
        let t = end.point[ALPHA].fma(bond.extension(), along);
        Along(bond.omega * t * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let e = bond.extension();
        N::constant(0.5) * end.point[ALPHA] * bond.omega * e * e
    }

    #[inline(always)]
    fn point_energy<N: Number>(
        &self,
        site: &Site<N, [N; 2], N, [N; 0]>,
        _: N,
        point: &[N; 3],
    ) -> N {
        N::constant(0.5) * site.constants[VOLUME] * point[DILATED] * point[DILATED]
    }
}

impl Registered for ThermoelasticSolid {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Linear peridynamic solid, W = ½ κ θ² + β/(2m) Σ ω ν V e², between points that may expand: e is counted from the length that their temperature or concentration gives a bond. lps is swept so where a material expands. Two of young, poisson, bulk, shear.",
        )
        .source("Silling, Epton, Weckner, Xu & Askari 2007; Kilic & Madenci 2010")
        .example("{ young = \"72 GPa\", poisson = 0.22 }")
        .influence(Influence::Inverse)
        .keys(&MODULI)
        .keys(&[FORMULAS])
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        let moduli = descriptor::moduli(parameters)?;
        let typed = ["bulk", "shear"].map(|key| parameters.number(key));
        let [bulk, shear] = match typed {
            [Some(bulk), Some(shear)] => [bulk, shear],
            _ => [moduli.bulk(), moduli.shear()],
        };
        Ok(match parameters.word(Self::FORMULAS) {
            Some(Lps3d::NAME) => LawSpec::Lps3d { bulk, shear },
            Some(EamLike::NAME) => LawSpec::EamLike {
                pair: 30.0 * shear,
                volume: 3.0 * bulk - 5.0 * shear,
            },
            _ => LawSpec::Lps(moduli),
        })
    }

    fn make(_: usize, _: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let of = |m: &Given| m.solid.ok_or("a state-based solid needs its moduli".into());
        let materials = descriptor::each(materials, of)?;
        Ok(ThermoelasticSolid { materials })
    }
}
