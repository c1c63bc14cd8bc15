//! The embedded-atom model in closed form of Mei, Davenport & Fernando (1991), with the cut-off function explicit
//! (seleson2014 (3.6)–(3.9)).
//!
//! `φ = −φe [1 + λ(r/μ − 1)] e^(−γ(r/μ − 1)) g`, `f = fe Σ_l c_l (μf/r)^l g`, and F makes the energy of the perfect
//! crystal that of Rose et al. (1984) under every uniform expansion:
//! `F = −Ec [1 − (α/β) ln x] x^(α/β) + ½ φe Σ_m s_m [1 + (p_m − 1)λ − p_m (λ/β) ln x] e^(−(p_m − 1)γ) x^(p_m γ/β) g_m`,
//! `x = ρ/ρe`, `g_m = g((p_m (1 − ln x / β) − n)/(c − n))`, over shells until g_m = 0.
//!
//! The length scales of φ and f, μ and μf, are separate: with the single scale printed the density of the paper's chain is
//! negative where it is compressed (the c_l are a fit to fcc in 3-D). g acts at the distances r_n and r_c. Shells lie at
//! p_m nearest distances; elsewhere in F p_m is multiplied by `shell_scale`, which is nearest distance over μ if F is to
//! follow φ (the paper prints p_m itself, with μ of two nearest distances).

use super::cut::{Ends, numbers, switch};
use super::{Described, Potential};
use crate::columns::Dimension;
use crate::family::stencil::Stencil;
use crate::law::descriptor::{Bounds, Descriptor, Key, Need, Value, Wrong, number};
use crate::law::number::Number;
use crate::space::lattice::LatticeKind;
use crate::spec::{Horizon, Parameter, Parameters};
use std::collections::BTreeMap;

/// Constants of the model; lengths but `nearest` are in units of that.
#[derive(Debug, Clone, PartialEq)]
pub struct EamForm {
    /// Cohesive energy Ec (energy).
    pub cohesive: f64,
    /// Energy φe of the pair term (energy).
    pub pair: f64,
    pub alpha: f64,
    pub beta: f64,
    pub gamma: f64,
    pub lambda: f64,
    /// c_0 … c_5.
    pub density: [f64; 6],
    /// fe/ρe: densities are in units of ρe.
    pub density_scale: f64,
    /// μ of the pair term.
    pub pair_length: f64,
    /// μf of the density.
    pub density_length: f64,
    /// r_n and r_c: where g begins to fall, and is 0.
    pub near: f64,
    pub cutoff: f64,
    /// Shells of the crystal that F is made for: number of atoms s_m and distance p_m.
    pub shells: Vec<(f64, f64)>,
    /// Nearest distance of the crystal at equilibrium (length).
    pub nearest: f64,
    /// p_m is multiplied by this where it is not a distance.
    pub shell_scale: f64,
}

/// The model, ready to be evaluated; all lengths are lengths.
#[derive(Debug, Clone, PartialEq)]
pub struct Mei {
    spec: EamForm,
    pair_length: f64,
    density_length: f64,
    near: f64,
    cutoff: f64,
    inverse_width: f64,
}

impl Mei {
    pub fn new(spec: EamForm) -> Mei {
        let [near, cutoff] = [spec.near, spec.cutoff].map(|x| spec.nearest * x);
        Mei {
            pair_length: spec.nearest * spec.pair_length,
            density_length: spec.nearest * spec.density_length,
            near,
            cutoff,
            inverse_width: 1.0 / (cutoff - near),
            spec,
        }
    }

    pub fn spec(&self) -> &EamForm {
        &self.spec
    }

    #[inline(always)]
    fn g<N: Number>(&self, r: N) -> N {
        switch(r.plus(-self.near).times(self.inverse_width))
    }
}

impl Potential for Mei {
    const EMBEDDED: bool = true;

    fn length(&self) -> f64 {
        self.spec.nearest
    }

    /// Its embedding energy says nothing far from there.
    fn made_for(&self) -> Option<f64> {
        Some(self.spec.nearest)
    }

    fn cutoff(&self) -> f64 {
        self.cutoff
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        let s = &self.spec;
        let r = q.sqrt();
        let x = r.times(1.0 / self.pair_length).plus(-1.0);
        let line = x.times(s.lambda).plus(1.0);
        (line * x.times(-s.gamma).exp()).times(-s.pair) * self.g(r)
    }

    #[inline(always)]
    fn density<N: Number>(&self, q: N) -> N {
        let s = &self.spec;
        let r = q.sqrt();
        let x = r.recip().times(self.density_length);
        let mut sum = N::constant(s.density[5]);
        for c in s.density[..5].iter().rev() {
            sum = (sum * x).plus(*c);
        }
        sum.times(s.density_scale) * self.g(r)
    }

    #[inline(always)]
    fn embedding<N: Number>(&self, density: N) -> N {
        let s = &self.spec;
        let log = density.ln();
        let well = log.times(-s.alpha / s.beta).plus(1.0) * log.times(s.alpha / s.beta).exp();
        let mut sum = N::constant(0.0);
        for &(count, distance) in &s.shells {
            let p = distance * s.shell_scale;
            let line = log
                .times(-p * s.lambda / s.beta)
                .plus(1.0 + (p - 1.0) * s.lambda);
            let decay = log
                .times(p * s.gamma / s.beta)
                .plus(-(p - 1.0) * s.gamma)
                .exp();
            // the shell's distance under the uniform expansion that gives this density
            let r = log
                .times(-1.0 / s.beta)
                .plus(1.0)
                .times(distance * s.nearest);
            sum = sum + (line * decay * self.g(r)).times(count);
        }
        sum.times(0.5 * s.pair) - well.times(s.cohesive)
    }

    fn least_density(&self) -> f64 {
        0.0
    }
}

const PLAIN: Dimension = Dimension::NUMBER;

/// Keys in the order in which they are listed.
const KEYS: [Key; 15] = [
    number("cohesive", Dimension::ENERGY, Bounds::POSITIVE, "Cohesive energy."),
    number("pair", Dimension::ENERGY, Bounds::ANY, "Energy of the pair term."),
    number("alpha", PLAIN, Bounds::ANY, "α"),
    number("beta", PLAIN, Bounds::POSITIVE, "β"),
    number("gamma", PLAIN, Bounds::ANY, "γ"),
    number("lambda", PLAIN, Bounds::ANY, "λ"),
    Key {
        name: "density",
        value: Value::List(6, PLAIN, Bounds::ANY),
        need: Need::Given,
        doc: "c_0 to c_5.",
    },
    number("density_scale", PLAIN, Bounds::POSITIVE, "f_e/ρ_e"),
    number(
        "nearest",
        Dimension::LENGTH,
        Bounds::POSITIVE,
        "Nearest distance of the crystal at equilibrium; the lattice's by default.",
    )
    .need(Need::Optional),
    number(
        "pair_length",
        PLAIN,
        Bounds::POSITIVE,
        "Length scale μ of the pair term in nearest distances; 1 by default.",
    )
    .or(1.0),
    number(
        "density_length",
        PLAIN,
        Bounds::POSITIVE,
        "Length scale of the density in nearest distances; 1 by default.",
    )
    .or(1.0),
    number(
        "shell_scale",
        PLAIN,
        Bounds::POSITIVE,
        "What the shells' distances are multiplied by in the embedding energy; 1/pair_length by default.",
    )
    .need(Need::Optional),
    number(
        "near",
        PLAIN,
        Bounds::POSITIVE,
        "Where the cut-off function begins to fall, in nearest distances.",
    ),
    number(
        "cutoff",
        PLAIN,
        Bounds::POSITIVE,
        "Where the cut-off function is 0, in nearest distances.",
    ),
    Key {
        name: "shells",
        value: Value::Rows(&[
            ("atoms", PLAIN, Bounds::POSITIVE),
            ("distance", PLAIN, Bounds::POSITIVE),
        ]),
        need: Need::Optional,
        doc: "[atoms, distance in nearest distances] of each shell that the embedding energy is made for; those of the lattice by default.",
    },
];

/// Cut-offs lie below this many nearest distances.
const LONGEST: f64 = 50.0;

impl Described for EamForm {
    const NAME: &'static str = "eam_form";
    type Made = Mei;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Atoms: embedded-atom model in closed form, with a cut-off function.",
        )
        .source("Mei, Davenport & Fernando 1991; seleson2014 (3.6)–(3.9)")
        .example("{ cohesive = 1, pair = 1, … }")
        .keys(&KEYS)
    }

    fn read(p: &Parameters) -> Result<Self, Wrong> {
        let [cohesive, pair, alpha, beta, gamma, lambda] =
            numbers(p, ["cohesive", "pair", "alpha", "beta", "gamma", "lambda"])?;
        let [density_scale, pair_length, density_length, near, cutoff] = numbers(
            p,
            [
                "density_scale",
                "pair_length",
                "density_length",
                "near",
                "cutoff",
            ],
        )?;
        if near >= cutoff || cutoff > LONGEST {
            let message = format!(
                "the cut-off {cutoff} must lie beyond near = {near} and below {LONGEST} nearest distances"
            );
            return Err(("cutoff".into(), message));
        }
        let (Some(nearest), Some(shells)) = (p.number("nearest"), p.rows("shells")) else {
            let message = "the embedding energy in closed form is made for a lattice: take a lattice body, or give nearest and shells, or take a table";
            return Err((String::new(), message.into()));
        };
        let Some(density) = p.list("density").and_then(|c| c.try_into().ok()) else {
            return Err(("density".into(), "density has c_0 to c_5: 6 numbers".into()));
        };
        Ok(EamForm {
            cohesive,
            pair,
            alpha,
            beta,
            gamma,
            lambda,
            density,
            density_scale,
            pair_length,
            density_length,
            near,
            cutoff,
            shells: shells.iter().map(|s| (s[0], s[1])).collect(),
            nearest,
            shell_scale: p.number("shell_scale").unwrap_or(1.0 / pair_length),
        })
    }

    fn parameters(&self) -> Parameters {
        let shells = self.shells.iter().map(|s| vec![s.0, s.1]).collect();
        Parameters::numbers(&[
            ("cohesive", self.cohesive),
            ("pair", self.pair),
            ("alpha", self.alpha),
            ("beta", self.beta),
            ("gamma", self.gamma),
            ("lambda", self.lambda),
            ("density_scale", self.density_scale),
            ("nearest", self.nearest),
            ("pair_length", self.pair_length),
            ("density_length", self.density_length),
            ("shell_scale", self.shell_scale),
            ("near", self.near),
            ("cutoff", self.cutoff),
        ])
        .with("density", Parameter::List(self.density.to_vec()))
        .with("shells", Parameter::Rows(shells))
    }

    fn made(self, _: Ends) -> Mei {
        Mei::new(self)
    }

    fn reach(&self) -> f64 {
        self.nearest * self.cutoff
    }

    fn on_lattice(parameters: &mut Parameters, kind: LatticeKind, spacing: f64) {
        if parameters.number("nearest").is_none() {
            parameters.set("nearest", Parameter::Number(spacing * kind.nearest()));
        }
        let cutoff = parameters.number("cutoff").unwrap_or(0.0);
        if parameters.rows("shells").is_none() && cutoff > 0.0 && cutoff <= LONGEST {
            let shells = shells(kind, 2.0 * cutoff).into_iter();
            let rows = shells.map(|s| vec![s.0, s.1]).collect();
            parameters.set("shells", Parameter::Rows(rows));
        }
    }
}

/// Shells of a lattice around a site: number of atoms and distance in nearest distances, up to `limit` of those.
pub fn shells(kind: LatticeKind, limit: f64) -> Vec<(f64, f64)> {
    let nearest = kind.nearest();
    let stencil = Stencil::new(kind, 1.0, Horizon::Length(limit * nearest));
    let mut counts: BTreeMap<i64, f64> = BTreeMap::new();
    for offset in &stencil.offsets[0] {
        *counts.entry(offset.squared).or_default() += 1.0;
    }
    let shell = |(squared, count): (i64, f64)| (count, (squared as f64).sqrt() / 4.0 / nearest);
    counts.into_iter().map(shell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shells_of_lattices() {
        assert_eq!(
            shells(LatticeKind::Chain, 3.5),
            [(2.0, 1.0), (2.0, 2.0), (2.0, 3.0)]
        );
        let fcc = shells(LatticeKind::Fcc, 2.05);
        let counts: Vec<f64> = fcc.iter().map(|s| s.0).collect();
        assert_eq!(counts, [12.0, 6.0, 24.0, 12.0]);
        for (m, s) in fcc.iter().enumerate() {
            assert!((s.1 - ((m + 1) as f64).sqrt()).abs() < 1e-14);
        }
    }
}
