//! Equations of state, p(J, E) of the volume ratio J and the internal energy E per reference volume, and the viscosity that spreads shocks.
//!
//! Mie & Grüneisen about the Hugoniot `U_s = c₀ + s u_p` with Γρ = Γ₀ρ₀ and `η = 1 − J`:
//! `p = ρ₀c₀²η (1 − Γ₀η/2)/(1 − sη)² + Γ₀E`, and in tension `p = ρ₀c₀² (1/J − 1) + Γ₀E` (Meyers 1994, (4.29) and (5.27); Hallquist 2006). A perfect gas:
//! `p = (γ − 1) E/J`. Both are linear in E, `p = a(J) + b(J) E`, so a step finds E in closed form.
//!
//! Where the volume shrinks, `D = −J̇/J > 0`, pressure gets `q = ρ δ D (C_q δ D + C_l c)`: quadratic of von Neumann & Richtmyer (1950), linear of
//! Landshoff (1955), over the length in which peridynamics spreads a shock, the horizon δ of the point. c is the speed of sound of that state, before the step.

use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{self, Bounds, Given, Key, Need, Value};
use crate::law::number::Number;
use crate::spec::Parameters;

/// Which one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// No equation of state: elastic, without heat.
    Elastic,
    MieGruneisen,
    PerfectGas,
}

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquationOfState {
    /// ρ₀c₀² (pressure); of a gas γ times its pressure.
    pub bulk: f64,
    /// s and Γ₀; of a gas 0 and γ − 1.
    pub slope: f64,
    pub gruneisen: f64,
    /// E in the reference (pressure).
    pub energy: f64,
    /// `C_l δ √ρ₀` and `C_q δ² ρ₀` of the material's horizon.
    pub viscosity: [f64; 2],
}

/// Numbers of a material.
pub type Constants<N> = [N; 7];
const BULK: usize = 0;
const SLOPE: usize = 1;
const GRUNEISEN: usize = 2;
const ENERGY: usize = 3;
const LINEAR: usize = 4;
const QUADRATIC: usize = 5;
/// 1/Δt; 0: time stands still.
const RATE: usize = 6;

/// `p = a + b E`, and `−∂p/∂J`, at a J.
#[derive(Debug, Clone, Copy)]
pub struct State<N> {
    pub own: N,
    pub per_energy: N,
    /// −∂a/∂J and −∂b/∂J
    stiffness: [N; 2],
}

impl<N: Number> State<N> {
    pub fn pressure(&self, energy: N) -> N {
        self.per_energy.fma(energy, self.own)
    }

    /// `ρ₀c²/J²`: at constant entropy energy grows by `−p dJ`.
    #[inline(always)]
    fn stiffness(&self, energy: N) -> N {
        let still = self.stiffness[1].fma(energy, self.stiffness[0]);
        let all = self.per_energy.fma(self.pressure(energy), still);
        all.most(N::constant(0.0))
    }
}

impl EquationOfState {
    pub fn constants(&self, dt: f64) -> Constants<f64> {
        [
            self.bulk,
            self.slope,
            self.gruneisen,
            self.energy,
            self.viscosity[0],
            self.viscosity[1],
            if dt > 0.0 { dt.recip() } else { 0.0 },
        ]
    }
}

/// E in the reference.
#[inline(always)]
pub fn energy_at_rest<N: Number>(c: &Constants<N>) -> N {
    c[ENERGY]
}

impl Kind {
    /// At `J = 1 + beyond`.
    #[inline(always)]
    pub fn at<N: Number>(self, c: &Constants<N>, beyond: N) -> State<N> {
        let (zero, one, half) = (N::constant(0.0), N::constant(1.0), N::constant(0.5));
        let inverse = (one + beyond).recip();
        match self {
            Kind::MieGruneisen => {
                let eta = zero - beyond;
                let rest = one - c[SLOPE] * eta;
                // beyond the pole of the Hugoniot there is no state: not a number
                let per = zero.choose(rest, rest, N::constant(f64::NAN)).recip();
                let hugoniot = c[BULK] * eta * per * per;
                let growth = c[BULK] * (one + c[SLOPE] * eta) * per * per * per;
                let part = one - half * c[GRUNEISEN] * eta;
                let squeezed = [
                    hugoniot * part,
                    growth * part - half * c[GRUNEISEN] * hugoniot,
                ];
                let pulled = [c[BULK] * eta * inverse, c[BULK] * inverse * inverse];
                let pick = |k: usize| zero.choose(eta, squeezed[k], pulled[k]);
                State {
                    own: pick(0),
                    per_energy: c[GRUNEISEN],
                    stiffness: [pick(1), zero],
                }
            }
            Kind::PerfectGas => {
                let per = c[GRUNEISEN] * inverse;
                State {
                    own: zero,
                    per_energy: per,
                    stiffness: [zero, per * inverse],
                }
            }
            Kind::Elastic => State {
                own: zero,
                per_energy: zero,
                stiffness: [zero; 2],
            },
        }
    }

    /// q of a step from `J = 1 + before` to `1 + now`, from a state of this energy, of a point whose horizon is `reach` times the material's; `old` where
    /// time stands still.
    #[inline(always)]
    pub fn viscosity<N: Number>(
        self,
        c: &Constants<N>,
        [before, now]: [N; 2],
        energy: N,
        reach: N,
        old: N,
    ) -> N {
        let (zero, one, half) = (N::constant(0.0), N::constant(1.0), N::constant(0.5));
        // D = −J̇/J of the middle
        let middle = one + half * (before + now);
        let rate = ((before - now) * c[RATE]).div(middle).most(zero);
        let stiffness = self.at(c, before).stiffness(energy);
        // ρ c = √(ρ₀ stiffness) as ρ = ρ₀/J; at rest a root has no slope: the least number has none either
        let sound = stiffness.most(N::constant(f64::MIN_POSITIVE)).sqrt();
        let wide = reach * rate;
        let q = wide * c[LINEAR].fma(sound, (c[QUADRATIC] * wide).div(middle));
        zero.choose(c[RATE], q, old)
    }
}

/// The column of what the viscosity adds.
pub fn column() -> Declaration {
    Declaration::of_points(
        "shock_pressure",
        Shape::Scalar,
        Dimension::PRESSURE,
        "What viscosity of shocks adds to the pressure where the volume shrinks.",
    )
}

/// The keys of Mie and Grüneisen.
pub const HUGONIOT: [Key; 2] = [
    descriptor::number(
        "hugoniot_slope",
        Dimension::NUMBER,
        Bounds::NOT_NEGATIVE,
        "s of the Hugoniot U_s = c₀ + s u_p, ρ₀c₀² = K.",
    )
    .need(Need::Optional),
    descriptor::number(
        "gruneisen",
        Dimension::NUMBER,
        Bounds::NOT_NEGATIVE,
        "Grüneisen's Γ₀; Γρ stays as it is.",
    )
    .need(Need::Optional),
];

/// The keys of viscosity; left out these values, as they are usual over the length of a cell.
pub const VISCOSITY: [Key; 2] = [
    descriptor::number(
        "linear_viscosity",
        Dimension::NUMBER,
        Bounds::NOT_NEGATIVE,
        "C_l of the viscosity q = ρ δ D (C_q δ D + C_l c) of shocks (Landshoff 1955).",
    )
    .need(Need::Optional),
    descriptor::number(
        "quadratic_viscosity",
        Dimension::NUMBER,
        Bounds::NOT_NEGATIVE,
        "C_q of it (von Neumann & Richtmyer 1950).",
    )
    .need(Need::Optional),
];

/// The words of a law that may be without.
pub const EQUATION: Key = Key {
    name: "equation_of_state",
    value: Value::Word(&[
        ("elastic", "the mean stress grows with the dilation, K tr d"),
        (
            "mie_gruneisen",
            "p = ρ₀c₀²η (1 − Γ₀η/2)/(1 − sη)² + Γ₀E about the Hugoniot U_s = c₀ + s u_p",
        ),
    ]),
    need: Need::Word("elastic"),
    doc: "Pressure of the volume, with viscosity of shocks (Meyers 1994; von Neumann & Richtmyer 1950).",
};

/// Is there one?
pub fn is_pressed(parameters: &Parameters) -> bool {
    parameters.word(EQUATION.name) == Some("mie_gruneisen")
}

/// C_l and C_q where nobody says.
const USUAL: [f64; 2] = [0.1, 0.5];

impl EquationOfState {
    /// Of Mie and Grüneisen, with this bulk modulus.
    ///
    /// # Errors
    /// What is missing.
    pub fn of_hugoniot(given: &Given, bulk: f64) -> Result<EquationOfState, String> {
        let number = |key: &Key| {
            given
                .parameters
                .number(key.name)
                .ok_or_else(|| format!("mie_gruneisen needs `{}`", key.name))
        };
        Ok(EquationOfState {
            bulk,
            slope: number(&HUGONIOT[0])?,
            gruneisen: number(&HUGONIOT[1])?,
            energy: 0.0,
            viscosity: viscosity(given),
        })
    }

    /// Of a perfect gas with this pressure and γ.
    pub fn of_gas(given: &Given, pressure: f64, heat_ratio: f64) -> EquationOfState {
        EquationOfState {
            bulk: heat_ratio * pressure,
            slope: 0.0,
            gruneisen: heat_ratio - 1.0,
            energy: pressure / (heat_ratio - 1.0),
            viscosity: viscosity(given),
        }
    }

    /// Where there is none.
    pub const NONE: EquationOfState = EquationOfState {
        bulk: 0.0,
        slope: 0.0,
        gruneisen: 0.0,
        energy: 0.0,
        viscosity: [0.0; 2],
    };
}

fn viscosity(given: &Given) -> [f64; 2] {
    let of = |n: usize| {
        given
            .parameters
            .number(VISCOSITY[n].name)
            .unwrap_or(USUAL[n])
    };
    let (length, density) = (given.horizon, given.density);
    [
        of(0) * length * density.sqrt(),
        of(1) * length * length * density,
    ]
}

/// A key of an equation of state that is given to a law without.
pub fn stray(parameters: &Parameters) -> Option<&'static str> {
    let all = HUGONIOT.iter().chain(&VISCOSITY);
    let given = |k: &&Key| parameters.get(k.name).is_some();
    let found = all.clone().find(given);
    found.map(|k| k.name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::number::Dual;

    const COPPER: EquationOfState = EquationOfState {
        bulk: 8930.0 * 3940.0 * 3940.0,
        slope: 1.489,
        gruneisen: 1.96,
        energy: 0.0,
        viscosity: [0.0; 2],
    };

    /// A state behind a shock: with E = ½ρ₀u² and p = ρ₀Uu Rankine and Hugoniot's conditions hold for U = c₀ + s u.
    #[test]
    fn the_hugoniot_is_the_line_of_speeds() {
        let (rho, c0) = (8930.0, 3940.0);
        let c = COPPER.constants(0.0);
        for speed in [1.0, 100.0, 500.0, 1500.0] {
            let shock = c0 + COPPER.slope * speed;
            let beyond = -speed / shock;
            let p = Kind::MieGruneisen
                .at(&c, beyond)
                .pressure(0.5 * rho * speed * speed);
            let exact = rho * shock * speed;
            assert!((p / exact - 1.0).abs() < 1e-13, "{speed}: {p:e} {exact:e}");
        }
    }

    /// Stiffness at constant entropy, by dual numbers: `−dp/dJ` with `dE = −p dJ`; the reference has `ρ₀c₀²`, a gas γp/J.
    #[test]
    fn sound_is_the_slope_of_pressure() {
        let gas = EquationOfState {
            gruneisen: 0.4,
            energy: 2.5,
            ..EquationOfState::NONE
        };
        for (kind, of, energy) in [
            (Kind::MieGruneisen, COPPER, 3e9),
            (Kind::PerfectGas, gas, 2.5),
        ] {
            let c = of.constants(0.0);
            for beyond in [0.0, -0.2, 0.15] {
                let state = kind.at(&c, beyond);
                let p = state.pressure(energy);
                let moved = Dual {
                    value: energy,
                    slope: -p,
                };
                let d = kind
                    .at(&c.map(Dual::constant), Dual::variable(beyond))
                    .pressure(moved);
                let off = (d.slope + state.stiffness(energy)).abs();
                assert!(off < 1e-12 * d.slope.abs(), "{kind:?} {beyond}: {off:e}");
                if kind == Kind::PerfectGas {
                    let exact = 1.4 * p / (1.0 + beyond);
                    assert!((state.stiffness(energy) / exact - 1.0).abs() < 1e-14);
                }
            }
        }
        let at_rest = Kind::MieGruneisen.at(&COPPER.constants(0.0), 0.0);
        assert!((at_rest.stiffness(0.0) / COPPER.bulk - 1.0).abs() < 1e-15);
    }

    /// Beyond the pole of the Hugoniot there is nothing.
    #[test]
    fn the_pole_is_not_passed() {
        let c = COPPER.constants(0.0);
        let near = Kind::MieGruneisen.at(&c, -0.67).pressure(0.0);
        assert!(near > 0.0 && near.is_finite());
        assert!(Kind::MieGruneisen.at(&c, -0.68).pressure(0.0).is_nan());
    }

    /// `q = ρ δ D (C_q δ D + C_l c)` where the volume shrinks, nothing where it grows, and what was where time stands still.
    #[test]
    fn viscosity_is_that_of_the_rate() {
        let of = EquationOfState {
            viscosity: [0.3 * 2.0 * 5.0f64.sqrt(), 1.5 * 4.0 * 5.0],
            bulk: 20.0,
            slope: 1.0,
            gruneisen: 0.0,
            energy: 0.0,
        };
        let c = of.constants(0.1);
        let at = |ends| Kind::MieGruneisen.viscosity(&c, ends, 0.0, 1.0, 7.0);
        assert_eq!(at([0.0, 0.02]), 0.0);
        let middle: f64 = 1.0 - 0.005;
        let (rate, sound) = (0.1 / middle, 2.0);
        let exact = 5.0 * 2.0 * rate * (1.5 * 2.0 * rate / middle + 0.3 * sound);
        assert!((at([0.0, -0.01]) / exact - 1.0).abs() < 1e-14);
        // half the horizon
        let half = Kind::MieGruneisen.viscosity(&c, [0.0, -0.01], 0.0, 0.5, 7.0);
        let exact = 5.0 * 1.0 * rate * (1.5 * 1.0 * rate / middle + 0.3 * sound);
        assert!((half / exact - 1.0).abs() < 1e-14);
        let still = of.constants(0.0);
        assert_eq!(
            Kind::MieGruneisen.viscosity(&still, [0.0, -0.01], 0.0, 1.0, 7.0),
            7.0
        );
    }
}
