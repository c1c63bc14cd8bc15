//! The bonds of `pmb` in general sweeps, as where bodies expand: `t(s) = s`, with the stretch counted, as for every law of this folder, from the
//! length that the ends' temperature or concentration gives a bond.

use super::bonds::BondLaw;
use crate::law::descriptor::{Descriptor, Key};
use crate::law::number::Number;

/// See the module.
pub struct Thermoelastic;

impl Thermoelastic {
    pub const NAME: &'static str = "thermoelastic";
}

impl BondLaw<0> for Thermoelastic {
    const NUMBERS: [Key; 0] = [];
    const RULED: bool = true;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Bond-based, f = c ω ν V s between points that may expand: s is counted from the length that their temperature or concentration gives a bond. pmb is swept so where a material expands. One of young, bulk, micromodulus; Poisson ratio 1/4, plane stress 1/3.",
        )
        .source("Silling & Askari 2005; Kilic & Madenci 2010")
        .example("{ young = \"72 GPa\" }")
    }

    #[inline(always)]
    fn tension<N: Number>(_: [N; 0], stretch: N) -> N {
        stretch
    }

    #[inline(always)]
    fn energy<N: Number>(_: [N; 0], stretch: N) -> N {
        N::constant(0.5) * stretch * stretch
    }
}
