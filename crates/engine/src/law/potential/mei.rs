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

use super::Potential;
use super::cut::switch;
use crate::law::number::Number;
use crate::spec::MeiSpec;

/// The model, ready to be evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Mei {
    spec: MeiSpec,
    near: f64,
    inverse_width: f64,
}

impl Mei {
    pub fn new(spec: MeiSpec) -> Mei {
        Mei {
            near: spec.near,
            inverse_width: 1.0 / (spec.cutoff - spec.near),
            spec,
        }
    }

    pub fn spec(&self) -> &MeiSpec {
        &self.spec
    }

    #[inline(always)]
    fn g<N: Number>(&self, r: N) -> N {
        switch(r.plus(-self.near).times(self.inverse_width))
    }
}

impl Potential for Mei {
    const EMBEDDED: bool = true;

    fn cutoff(&self) -> f64 {
        self.spec.cutoff
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        let s = &self.spec;
        let r = q.sqrt();
        let x = r.times(1.0 / s.pair_length).plus(-1.0);
        let line = x.times(s.lambda).plus(1.0);
        (line * x.times(-s.gamma).exp()).times(-s.pair) * self.g(r)
    }

    #[inline(always)]
    fn density<N: Number>(&self, q: N) -> N {
        let s = &self.spec;
        let r = q.sqrt();
        let x = r.recip().times(s.density_length);
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
