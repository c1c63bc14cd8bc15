//! The EAM-like solid of any functions (seleson2014, appendix A): `W_i = E(ϑ_i) + ½ Σ_j w ν V_j` with `ϑ_i = Σ_j j ν V_j` ((A.9), (A.19)),
//! j and w functions of the distance `r = |ξ+η|` and of what the bond has in the reference.
//!
//! `T⟨ξ⟩ = E′(ϑ) ∂j/∂r + ½ ∂w/∂r` along the bond, whose two ends are (A.21) (with `P = −E′`, (A.12)); with `j = j(|ξ|) r` it is (A.13). Energies
//! are counted from the reference (the C of (A.16)), where bonds may pull, as those of embedded atoms do. A broken bond stays in ϑ with what
//! it had in the reference, as in lps the weighted volume stays that of the family; bonds of no weight are none.

use super::{Along, Bond, End, Material, ReferenceFamily, Site};
use crate::columns::Dimension;
use crate::expression::Expression;
use crate::law::descriptor::{
    self, Bounds, Descriptor, Given, Key, Need, Registered, Value, number,
};
use crate::law::function::Function;
use crate::law::number::Number;
use crate::law::partner::Partner;
use crate::spec::{LawSpec, Parameters, Plane};

/// Variables of the functions.
const OF_VOLUME: &[&str] = &["theta", "theta0"];
const OF_WEIGHT: &[&str] = &["r", "r0", "omega", "delta"];
const OF_PAIR: &[&str] = &["r", "r0", "omega", "delta", "theta0"];
/// Which of those of bonds is the horizon.
const DELTA: usize = 3;

/// E, j and w of a material.
#[derive(Debug, Clone)]
struct Functions {
    energy: Function,
    weight: Function,
    pair: Function,
}

/// See the module.
#[derive(Debug, Clone)]
pub struct EmbeddedSolid {
    /// Per material.
    materials: Vec<Functions>,
    horizon: f64,
}

/// E′ and ϑ₀, which bonds read, and ϑ.
const SLOPE: usize = 0;
const AT_REST: usize = 1;
const NOW: usize = 2;

/// Number of the material; E′, ϑ₀ and ϑ.
type Ends<'a, N> = End<'a, [N; 1], [N; 3], [N; 0]>;

impl EmbeddedSolid {
    pub const NAME: &'static str = "embedded_solid";

    /// E and E′ where ϑ is `now` and was `rest`.
    #[inline(always)]
    fn volume<N: Number>(&self, material: N, now: N, rest: N) -> [N; 2] {
        let mut out = [N::constant(0.0); 2];
        for (n, m) in self.materials.iter().enumerate() {
            let found = m.energy.at([now, rest], 0);
            out = chosen(material, n, found, out);
        }
        out
    }

    /// j and its slope at the distance r.
    #[inline(always)]
    fn weight<N: Number, const D: usize>(&self, material: N, r: N, bond: &Bond<N, D>) -> [N; 2] {
        let mut out = [N::constant(0.0); 2];
        let of = [r, bond.length, bond.omega, N::constant(self.horizon)];
        for (n, m) in self.materials.iter().enumerate() {
            out = chosen(material, n, m.weight.at(of, 0), out);
        }
        weighed(bond, out)
    }

    /// w and its slope.
    #[inline(always)]
    fn pair<N: Number, const D: usize>(
        &self,
        material: N,
        r: N,
        rest: N,
        bond: &Bond<N, D>,
    ) -> [N; 2] {
        let mut out = [N::constant(0.0); 2];
        let horizon = N::constant(self.horizon);
        let of = [r, bond.length, bond.omega, horizon, rest];
        for (n, m) in self.materials.iter().enumerate() {
            out = chosen(material, n, m.pair.at(of, 0), out);
        }
        weighed(bond, out)
    }
}

/// What was found of material n where that is this one.
#[inline(always)]
fn chosen<N: Number>(material: N, n: usize, found: [N; 2], before: [N; 2]) -> [N; 2] {
    if n == 0 {
        return found;
    }
    let limit = N::constant(n as f64 - 0.5);
    let mut out = found;
    for k in 0..2 {
        out[k] = material.choose(limit, before[k], found[k]);
    }
    out
}

/// Nothing of a bond that weighs nothing.
#[inline(always)]
fn weighed<N: Number, const D: usize>(bond: &Bond<N, D>, found: [N; 2]) -> [N; 2] {
    let zero = N::constant(0.0);
    let mut out = found;
    for k in 0..2 {
        out[k] = zero.choose(bond.omega, found[k], zero);
    }
    out
}

/// `|ξ+η|`
#[inline(always)]
fn distance<N: Number, const D: usize>(bond: &Bond<N, D>) -> N {
    bond.length + bond.extension()
}

/// ϑ₀ of a family.
fn at_rest<'a, const D: usize>(
    weight: &Function,
    horizon: f64,
    family: impl Iterator<Item = &'a Partner<D>>,
) -> f64 {
    let each = family.filter(|p| p.omega > 0.0).map(|p| {
        let r = length(&p.xi);
        weight.at([r, r, p.omega, horizon], 0)[0] * p.volume
    });
    each.sum()
}

fn length<const D: usize>(xi: &[f64; D]) -> f64 {
    xi.iter().map(|x| x * x).sum::<f64>().sqrt()
}

impl<const D: usize> Material<D> for EmbeddedSolid {
    type Constants<N: Number> = [N; 1];
    /// ϑ₀
    type Form<N: Number> = N;
    /// ϑ − ϑ₀
    type Sum<N: Number> = N;
    type Point<N: Number> = [N; 3];
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 1;
    /// Whatever its functions make of them.
    const OF_FAMILY: bool = true;

    fn constants(&self, material: usize, _: f64) -> [f64; 1] {
        [material as f64]
    }

    fn form(&self, material: usize, reference: ReferenceFamily<D>) -> f64 {
        let mut family = vec![];
        reference.each(|p| family.push(*p));
        let weight = &self.materials[material].weight;
        at_rest(weight, self.horizon, family.iter())
    }

    #[inline(always)]
    fn pair_pass<N: Number>(&self, _: usize, bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let [material] = *end.constants;
        let [now, _] = self.weight(material, distance(bond), bond);
        let [rest, _] = self.weight(material, bond.length, bond);
        now - rest
    }

    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        _: usize,
        site: &Site<N, [N; 1], N, [N; 0]>,
        sum: N,
        point: &mut [N; 3],
    ) {
        let (rest, zero) = (*site.form, N::constant(0.0));
        point[AT_REST] = rest;
        point[NOW] = rest + sum;
        let [_, slope] = self.volume(site.constants[0], point[NOW], rest);
        // a point without bonds has no ϑ
        point[SLOPE] = zero.choose(rest * rest, slope, zero);
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> Along<N> {
        let ([material], r) = (*end.constants, distance(bond));
        let [_, weight] = self.weight(material, r, bond);
        let [_, pair] = self.pair(material, r, end.point[AT_REST], bond);
        let t = end.point[SLOPE].fma(weight, pair.times(0.5));
        Along(t * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let ([material], rest) = (*end.constants, end.point[AT_REST]);
        let [now, _] = self.pair(material, distance(bond), rest, bond);
        let [before, _] = self.pair(material, bond.length, rest, bond);
        (now - before).times(0.5)
    }

    #[inline(always)]
    fn point_energy<N: Number>(
        &self,
        site: &Site<N, [N; 1], N, [N; 0]>,
        _: N,
        point: &[N; 3],
    ) -> N {
        let (rest, zero) = (point[AT_REST], N::constant(0.0));
        let [now, _] = self.volume(site.constants[0], point[NOW], rest);
        let [before, _] = self.volume(site.constants[0], rest, rest);
        zero.choose(rest * rest, now - before, zero)
    }
}

const fn formula(
    name: &'static str,
    variables: &'static [&'static str],
    dimension: Option<Dimension>,
    doc: &'static str,
) -> Key {
    Key {
        name,
        value: Value::Formula(variables, dimension),
        need: Need::Given,
        doc,
    }
}

const KEYS: [Key; 4] = [
    formula(
        "energy",
        OF_VOLUME,
        Some(Dimension::PRESSURE),
        "E(ϑ) per volume, of theta = ϑ and theta0, its value in the reference.",
    ),
    formula(
        "weight",
        OF_WEIGHT,
        None,
        "j, whose sum over the family is ϑ = Σ j ν V: of the distance r, that of the reference r0, the influence function omega and the horizon delta. j = j(|ξ|) r of the paper is \"omega*r0*r\" or the like.",
    ),
    formula(
        "pair",
        OF_PAIR,
        None,
        "w, energy per volume² of a bond, whose ends have half of it each: of the same, and of theta0 of each end.",
    ),
    number(
        "bulk",
        Dimension::PRESSURE,
        Bounds::POSITIVE,
        "Bulk modulus of small strains, as contact and checks take it: forces of bonds are those of the functions.",
    ),
];

impl Registered for EmbeddedSolid {
    /// Moduli of small strains are those of the functions, whatever `bulk` says.
    const ISOTROPIC: bool = false;
    const PULLS_AT_REST: bool = true;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            EmbeddedSolid::NAME,
            "EAM-like, of any functions: W = E(ϑ) + ½ Σ w ν V, ϑ = Σ j ν V, which are expressions with + − * / ^ exp ln sqrt abs min max, comparisons, choices and [constants]; what carries no unit is in the deck's units. lps and structured and structureless embedded atoms are such solids.",
        )
        .source("Silling 2000; seleson2014 (A.9)–(A.13), (A.19)–(A.21)")
        .example("{ energy = \"0.5*c*(theta/theta0 - 1)^2\", weight = \"omega*r0*r\", pair = \"0.5*k*omega*(r - r0)^2/theta0\", bulk = \"1 GPa\" }")
        .keys(&KEYS)
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        let [bulk] = parameters.all(["bulk"])?;
        // bonds alone: K = k/18
        Ok(LawSpec::EamLike {
            pair: 18.0 * bulk,
            volume: 0.0,
        })
    }

    fn of_one_horizon(parameters: &Parameters) -> Option<&'static str> {
        let written = ["weight", "pair"].map(|key| parameters.formula(key));
        let knows = written.into_iter().flatten().any(|e| e.depends_on(DELTA));
        knows.then_some("functions that are written with delta know one horizon")
    }

    fn make(_: usize, _: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        Ok(EmbeddedSolid {
            horizon: materials.first().map_or(0.0, |m| m.horizon),
            materials: descriptor::each(materials, functions)?,
        })
    }
}

/// The functions of a material, with values and slopes in the reference.
fn functions(m: &Given) -> Result<Functions, String> {
    let [energy, weight, pair] = ["energy", "weight", "pair"].map(|key| {
        let text = m
            .parameters
            .formula(key)
            .ok_or_else(|| format!("it has no {key}"))?;
        let made = Function::new(text).map_err(|why| format!("`{key}`: {why}"))?;
        Ok::<_, String>((text, made))
    });
    let (energy, weight, pair) = (energy?, weight?, pair?);
    // of a cloud nobody knows the bonds yet
    let some: Vec<Partner<3>> = match m.family.is_empty() {
        true => (1..=8)
            .map(|k| along(0.125 * f64::from(k) * m.horizon))
            .collect(),
        false => m.family.to_vec(),
    };
    let rest = at_rest(&weight.1, m.horizon, some.iter());
    let finite = |key: &str, text: &Expression, at: f64, what: &str, found: [f64; 2]| match found
        .iter()
        .all(|x| x.is_finite())
    {
        true => Ok(()),
        false => Err(format!(
            "`{key}`, {}, has the value {} and the slope {} in the reference, at {what} = {at}: expected finite numbers",
            text.source(),
            found[0],
            found[1]
        )),
    };
    for p in some.iter().filter(|p| p.omega > 0.0) {
        let r = length(&p.xi);
        let of = [r, r, p.omega, m.horizon];
        finite("weight", weight.0, r, "r", weight.1.at(of, 0))?;
        let of = [r, r, p.omega, m.horizon, rest];
        finite("pair", pair.0, r, "r", pair.1.at(of, 0))?;
    }
    if !m.family.is_empty() {
        finite("energy", energy.0, rest, "theta", energy.1.at([rest; 2], 0))?;
    }
    Ok(Functions {
        energy: energy.1,
        weight: weight.1,
        pair: pair.1,
    })
}

fn along(r: f64) -> Partner<3> {
    Partner {
        xi: [r, 0.0, 0.0],
        omega: 1.0,
        volume: r * r * r,
    }
}
