//! The parameters of metals and soils that flow.

use super::{HypoelasticPlastic, HypoelasticPlasticConstants};
use crate::columns::Dimension;
use crate::law::descriptor::{
    self, Bounds, Descriptor, Given, Key, MODULI, Memory, Need, Registered, Value,
};
use crate::law::material::non_ordinary::equation_of_state::{
    self, EQUATION, EquationOfState, HUGONIOT, VISCOSITY,
};
use crate::law::material::non_ordinary::hardening::{self, Hardening};
use crate::law::material::non_ordinary::rate::{INCREMENT, Increment};
use crate::spec::{LawSpec, Parameters, Plane};

/// Keys beside the moduli and those of hardening.
const KEYS: [Key; 5] = [
    descriptor::number(
        "friction",
        Dimension::NUMBER,
        Bounds::NOT_NEGATIVE,
        "a in the yield surface q + a p = σ_y (Drucker & Prager 1952); 0: von Mises.",
    )
    .or(0.0),
    descriptor::number(
        "dilatancy",
        Dimension::NUMBER,
        Bounds::NOT_NEGATIVE,
        "b: dilation per equivalent plastic strain; `friction` makes the flow associated.",
    )
    .or(0.0),
    descriptor::number(
        "heat_capacity",
        Dimension([2, 0, -2, -1]),
        Bounds::POSITIVE,
        "Heat capacity c per mass; no heating by plastic work by default.",
    )
    .need(Need::Optional),
    descriptor::number(
        "heated_part",
        Dimension::NUMBER,
        Bounds::PART,
        "Part β of the plastic work that becomes heat (Taylor & Quinney 1934).",
    )
    .or(0.9),
    Key {
        name: "damage",
        value: Value::List(5, Dimension::NUMBER, Bounds::ANY),
        need: Need::Optional,
        doc: "D₁ to D₅ of the strain at fracture (D₁ + D₂ exp(D₃ p/q)) (1 + D₄ ln(ε̄̇/ε̇₀)) (1 + D₅ T*) (Johnson & Cook 1985).",
    },
];

impl Registered for HypoelasticPlastic {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            "hypoelastic_plastic",
            "Non-ordinary, in rate form, with flow: q + a p = σ_y = g(ε̄) r(ε̄̇) (1 − T*ᵐ), von Mises, Drucker-Prager, Johnson-Cook, Needleman; under impact with an equation of state. Two of young, poisson, bulk, shear; in plane stress the thickness gives way.",
        )
        .source("Simo & Hughes 1998; Johnson & Cook 1983, 1985; Drucker & Prager 1952; Silling et al. 2007")
        .example("{ young = \"117 GPa\", poisson = 0.35, yield_stress = \"400 MPa\", hardening = \"100 MPa\" }")
        .memory(Memory::Path)
        .keys(&MODULI)
        .keys(&[INCREMENT])
        .keys(&hardening::KEYS)
        .keys(&KEYS)
        .keys(&[EQUATION])
        .keys(&HUGONIOT)
        .keys(&VISCOSITY)
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let words = |m: &Given| {
            let kind = hardening::kind(m.parameters)?;
            let increment = Increment::of(m.parameters).ok_or("the increment is middle or end")?;
            let state = match m.parameters.word(EQUATION.name) {
                Some("mie_gruneisen") => equation_of_state::Kind::MieGruneisen,
                Some(_) | None => equation_of_state::Kind::Elastic,
            };
            Ok((
                (kind, increment),
                m.parameters.list("damage").is_some(),
                state,
            ))
        };
        let first = materials
            .first()
            .ok_or((0, "there is no material".into()))?;
        let all = words(first).map_err(|m: String| (0, m))?;
        let ((kind, increment), damages, equation) = all;
        let of = |m: &Given| {
            if words(m)? != all {
                return Err("all materials of a body have the same increment, hardening_law, rate_law and equation_of_state, and all melt or none, are damaged or none".into());
            }
            let moduli = descriptor::moduli(m.parameters)?;
            let hardening = Hardening::of(m, kind)?;
            let number = |key| m.parameters.number(key);
            let heating = match (number("heat_capacity"), number("heated_part")) {
                (Some(capacity), Some(part)) => part / (m.density * capacity),
                _ => 0.0,
            };
            let (friction, dilatancy) = (
                number("friction").unwrap_or(0.0),
                number("dilatancy").unwrap_or(0.0),
            );
            if dilatancy > friction {
                return Err(format!(
                    "a dilatancy of {dilatancy} above a friction of {friction} would give energy away"
                ));
            }
            let state = match (equation, equation_of_state::stray(m.parameters)) {
                (equation_of_state::Kind::Elastic, Some(key)) => {
                    return Err(format!(
                        "`{key}` is of an equation of state: write equation_of_state = \"mie_gruneisen\", or leave it out"
                    ));
                }
                (equation_of_state::Kind::Elastic, None) => EquationOfState::NONE,
                (equation_of_state::Kind::PerfectGas, _) => {
                    return Err("a perfect gas sustains no shear: write a fluid".into());
                }
                (equation_of_state::Kind::MieGruneisen, _) if friction > 0.0 => {
                    return Err("`friction` reads the elastic mean stress: with an equation of state flow is von Mises's; leave it out".into());
                }
                (equation_of_state::Kind::MieGruneisen, _) => {
                    EquationOfState::of_hugoniot(m, moduli.bulk())?
                }
            };
            Ok(HypoelasticPlasticConstants {
                lame: moduli.lame(),
                shear: moduli.shear(),
                friction,
                dilatancy,
                heating,
                damage: damage(m.parameters, kind.heats)?,
                hardening,
                state,
            })
        };
        Ok(HypoelasticPlastic {
            sheet: d == 2 && plane == Plane::Stress,
            increment,
            kind,
            damages,
            state: equation,
            materials: descriptor::each(materials, of)?,
        })
    }
}

/// D₁ to D₅.
fn damage(parameters: &Parameters, heats: bool) -> Result<[f64; 5], String> {
    let Some(list) = parameters.list("damage") else {
        return Ok([0.0; 5]);
    };
    let mut d = [0.0; 5];
    d.copy_from_slice(list);
    if d[3] != 0.0 && parameters.number("reference_rate").is_none() {
        return Err("the fourth number of `damage` needs `reference_rate`".into());
    }
    if d[4] != 0.0 && !heats {
        return Err("the fifth number of `damage` needs `melting_temperature`".into());
    }
    // at the mean stresses of tension, shear and compression
    let strains = [1.0 / 3.0, 0.0, -1.0 / 3.0].map(|x| d[0] + d[1] * libm::exp(d[2] * x));
    if strains.iter().any(|s| *s <= 0.0) {
        return Err(format!(
            "`damage` gives strains at fracture of {strains:?} in tension, shear and compression, expected positive ones"
        ));
    }
    Ok(d)
}
