//! Fluids: a pressure that follows from an [equation of state](super::equation_of_state), and no shear, `P = −(p + q) cof F`.
//!
//! The work done on a point is its internal energy: in a step E grows by `−½ (p + q + p′ + q′) ΔJ`, which is linear in E′. So what viscosity takes from a
//! shock heats the point, and nothing is lost. What the gradient of the family does not see is held by a control, as stiff as that of a solid
//! of the same bulk modulus and Poisson's ratio ¼: a pressure alone would leave it free.

use super::equation_of_state::{self, EquationOfState, HUGONIOT, Kind, VISCOSITY, energy_at_rest};
use super::{Classical, Stressed, Unseen};
use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{
    self, Bounds, Descriptor, Given, Key, Memory, Need, Registered, Value,
};
use crate::law::material::tensor::Matrix;
use crate::law::number::Number;
use crate::spec::{LawSpec, Moduli, Parameters, Plane};

/// See the module. All materials have the same equation of state.
#[derive(Debug, Clone)]
pub struct Fluid {
    pub kind: Kind,
    /// Per material.
    pub materials: Vec<EquationOfState>,
}

/// What a point remembers: J − 1, p, q, and how much energy it got.
const DILATION: usize = 0;
const PRESSURE: usize = 1;
const SHOCK: usize = 2;
const GAINED: usize = 3;

impl<const D: usize> Classical<D> for Fluid {
    type Constants<N: Number> = equation_of_state::Constants<N>;
    type Past<N: Number> = [N; 4];
    const POTENTIAL: bool = false;
    const ACROSS: bool = true;

    fn columns(&self) -> Vec<Declaration> {
        let scalar =
            |name, dimension, doc| Declaration::of_points(name, Shape::Scalar, dimension, doc);
        vec![
            scalar(
                "volume_change",
                Dimension::NUMBER,
                "J − 1 of the deformation gradient.",
            ),
            scalar(
                "pressure",
                Dimension::PRESSURE,
                "Pressure of the equation of state, without viscosity; 0 before the first step.",
            ),
            equation_of_state::column(),
            scalar(
                "energy_gained",
                Dimension::PRESSURE,
                "Internal energy per reference volume beyond that of the reference.",
            ),
        ]
    }

    fn constants(&self, material: usize, dt: f64) -> equation_of_state::Constants<f64> {
        self.materials[material].constants(dt)
    }

    fn shear(&self, material: usize) -> f64 {
        0.6 * self.materials[material].bulk
    }

    /// The pressure is the same in all directions; less what it is in the reference, as in the plane.
    #[inline(always)]
    fn across<N: Number>(&self, past: &[N; 4]) -> N {
        let all = past[PRESSURE] + past[SHOCK];
        N::constant(0.0) - all * (N::constant(1.0) + past[DILATION])
    }

    #[inline(always)]
    fn stress<N: Number>(
        &self,
        c: &equation_of_state::Constants<N>,
        past: &[N; 4],
        h: &Matrix<N, D>,
        unseen: &Unseen<N>,
    ) -> Stressed<N, [N; 4], D> {
        let (zero, one, half) = (N::constant(0.0), N::constant(1.0), N::constant(0.5));
        let at_rest = energy_at_rest(c);
        let (cofactors, beyond) = unseen.space(h);
        let before = at_rest + past[GAINED];
        let old = self.kind.at(c, past[DILATION]).pressure(before);
        let ends = [past[DILATION], beyond];
        let q = self
            .kind
            .viscosity(c, ends, before, unseen.reach, past[SHOCK]);
        let state = self.kind.at(c, beyond);
        // E′ (1 + ½ b ΔJ) = E − ½ (p + q + a + q′) ΔJ
        let shrunk = half * (past[DILATION] - beyond);
        let gained = shrunk * (old + past[SHOCK] + state.own + q + state.per_energy * at_rest);
        let above = past[GAINED] + gained;
        let gained = above.div(one - state.per_energy * shrunk);
        let pressure = state.pressure(at_rest + gained);
        let all = zero - (pressure + q);
        let mut p = cofactors;
        for r in 0..D {
            for k in 0..D {
                p[r][k] = all * cofactors[r][k];
            }
            p[r][r] = p[r][r] + all;
        }
        Stressed {
            stress: p,
            across: zero,
            energy: gained,
            past: [beyond, pressure, q, gained],
        }
    }
}

/// Keys beside those of the Hugoniot and of viscosity.
const KEYS: [Key; 4] = [
    Key {
        name: "equation_of_state",
        value: Value::Word(&[
            (
                "mie_gruneisen",
                "p = ρ₀c₀²η (1 − Γ₀η/2)/(1 − sη)² + Γ₀E about the Hugoniot U_s = c₀ + s u_p",
            ),
            ("perfect_gas", "p = (γ − 1) E/J"),
        ]),
        need: Need::Word("mie_gruneisen"),
        doc: "Pressure of volume and internal energy.",
    },
    descriptor::number(
        "bulk",
        Dimension::PRESSURE,
        Bounds::POSITIVE,
        "Bulk modulus K = ρ₀c₀² of mie_gruneisen.",
    )
    .need(Need::Optional),
    descriptor::number(
        "initial_pressure",
        Dimension::PRESSURE,
        Bounds::POSITIVE,
        "Pressure of a perfect_gas in the reference.",
    )
    .need(Need::Optional),
    descriptor::number(
        "heat_ratio",
        Dimension::NUMBER,
        Bounds {
            least: 1.0,
            inclusive: false,
            most: f64::INFINITY,
            below: false,
        },
        "γ of a perfect_gas.",
    )
    .need(Need::Optional),
];

const NONE: &str = "the equation of state is mie_gruneisen or perfect_gas";

fn kind(parameters: &Parameters) -> Result<Kind, String> {
    match parameters.word(KEYS[0].name) {
        Some("mie_gruneisen") => Ok(Kind::MieGruneisen),
        Some("perfect_gas") => Ok(Kind::PerfectGas),
        _ => Err(NONE.into()),
    }
}

/// The numbers that its equation of state needs, and none of the other's.
fn numbers(parameters: &Parameters) -> Result<[f64; 2], String> {
    let (own, foreign): (&[&Key], &[&Key]) = match kind(parameters)? {
        Kind::PerfectGas => (
            &[&KEYS[2], &KEYS[3]],
            &[&KEYS[1], &HUGONIOT[0], &HUGONIOT[1]],
        ),
        Kind::MieGruneisen | Kind::Elastic => (
            &[&KEYS[1], &HUGONIOT[0], &HUGONIOT[1]],
            &[&KEYS[2], &KEYS[3]],
        ),
    };
    let word = parameters.word(KEYS[0].name).unwrap_or_default();
    if let Some(key) = foreign.iter().find(|k| parameters.get(k.name).is_some()) {
        return Err(format!("`{}` is no constant of {word}", key.name));
    }
    let mut found = [0.0; 2];
    for (n, key) in own.iter().enumerate() {
        let number = parameters.number(key.name);
        let number = number.ok_or_else(|| format!("{word} needs `{}`", key.name))?;
        if n < 2 {
            found[n] = number;
        }
    }
    Ok(found)
}

impl Registered for Fluid {
    /// There is no shear.
    const ISOTROPIC: bool = false;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            "fluid",
            "Non-ordinary, without shear: P = −(p + q) cof F, p of volume and internal energy (Mie-Grüneisen, perfect gas), q the viscosity of shocks; energy is kept. In the plane nothing moves across.",
        )
        .source("Meyers 1994; von Neumann & Richtmyer 1950; Landshoff 1955; Silling et al. 2007")
        .example("{ bulk = \"138.6 GPa\", hugoniot_slope = 1.489, gruneisen = 1.96 }")
        .memory(Memory::Shock)
        .keys(&KEYS)
        .keys(&HUGONIOT)
        .keys(&VISCOSITY)
    }

    /// What contact sees: a solid of this bulk modulus and Poisson's ratio ¼.
    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        let bulk = match (kind(parameters)?, numbers(parameters)?) {
            (Kind::PerfectGas, [pressure, heat_ratio]) => heat_ratio * pressure,
            (_, [bulk, _]) => bulk,
        };
        Ok(LawSpec::Lps(Moduli::from_bulk_shear(bulk, 0.6 * bulk)))
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let first = materials
            .first()
            .ok_or((0, "there is no material".into()))?;
        let kind_of = kind(first.parameters).map_err(|why| (0, why))?;
        let of = |m: &Given| {
            if d == 2 && plane == Plane::Stress {
                return Err("a pressure is the same in all directions, and a sheet of fluid with free faces sustains none: write plane = \"strain\"".into());
            }
            if m.breaks {
                return Err("a fluid has no bonds that break: its volume is that of its family, whole or not; leave `fracture` out".into());
            }
            if m.parameters.word("gradient") == Some("bond") {
                return Err("a fluid has the gradient of its family: that of a bond differs in shape alone, on which a pressure does not depend; leave `gradient` out".into());
            }
            if kind(m.parameters)? != kind_of {
                return Err("all materials of a body have the same equation of state".into());
            }
            let [first, second] = numbers(m.parameters)?;
            match kind_of {
                Kind::PerfectGas => Ok(EquationOfState::of_gas(m, first, second)),
                Kind::MieGruneisen => EquationOfState::of_hugoniot(m, first),
                Kind::Elastic => Err(NONE.into()),
            }
        };
        Ok(Fluid {
            kind: kind_of,
            materials: descriptor::each(materials, of)?,
        })
    }
}
