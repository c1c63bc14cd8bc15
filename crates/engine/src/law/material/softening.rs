//! A bond that softens: linear up to a stretch s0, then falling linearly to nothing at the critical stretch s_c; it unloads to the
//! origin and remembers its greatest stretch. Pushed together it is linear.
//!
//! Each end answers `½ c ω (1 − d) s` along the bond, with `(1 − d) s = s0 (s_c − s)/(s_c − s0)` on the way down (bilinear
//! law of cohesive zones, Petersson 1981, on bonds; Zaccariotto et al. 2015). At s_c the bond has dissipated `½ c ω s0 s_c |ξ|`:
//! the fracture energy is s0/s_c times that of a brittle bond with the same critical stretch.

use super::{Along, Bond, Columns, End, Material};
use crate::columns::{Declaration, Dimension};
use crate::law::descriptor::{self, Bounds, Descriptor, Given, Memory, Shelved};
use crate::law::number::Number;
use crate::spec::{Influence, LawSpec, Parameters, Plane, PmbStiffness};

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SofteningConstants {
    /// Micromodulus c (force / volume²).
    pub micromodulus: f64,
    /// Stretch at which softening begins.
    pub onset: f64,
    /// Stretch at which nothing is left; above the onset.
    pub critical: f64,
}

/// See the module.
#[derive(Debug, Clone)]
pub struct Softening {
    /// Per material.
    pub materials: Vec<SofteningConstants>,
}

const C: usize = 0; // ½c
const ONSET: usize = 1;
const CRITICAL: usize = 2;
const SLOPE: usize = 3; // s0/(s_c − s0)

type Ends<'a, N> = End<'a, [N; 4], [N; 0], [N; 1]>;

/// Force and greatest stretch so far.
struct Branch<N> {
    /// `(1 − d) s`
    force: N,
    peak: N,
    /// `(1 − d) s` at the greatest stretch.
    envelope: N,
}

#[inline(always)]
fn branch<N: Number>(s: N, c: &[N; 4], past: N) -> Branch<N> {
    let zero = N::constant(0.0);
    let peak = past.most(s);
    let down = (c[SLOPE] * (c[CRITICAL] - peak)).most(zero);
    // at most the onset nothing has softened
    let envelope = c[ONSET].choose(peak, down, peak);
    let part = c[ONSET].choose(peak, envelope.div(peak), N::constant(1.0));
    let force = zero.choose(s, part * s, s);
    Branch {
        force,
        peak,
        envelope,
    }
}

/// Dissipated at a greatest stretch, per `½ c ω |ξ|`: the triangle of origin, onset and envelope.
#[inline(always)]
fn lost<N: Number>(c: &[N; 4], peak: N, envelope: N) -> N {
    // beyond the critical stretch nothing is left to lose
    let peak = peak.least(c[CRITICAL]);
    let area = N::constant(0.5) * (peak * c[ONSET] - c[ONSET] * envelope);
    c[ONSET].choose(peak, area, N::constant(0.0))
}

impl<const D: usize> Material<D> for Softening {
    type Constants<N: Number> = [N; 4];
    type Form<N: Number> = [N; 0];
    type Sum<N: Number> = [N; 0];
    type Point<N: Number> = [N; 0];
    type Past<N: Number> = [N; 0];
    /// Greatest stretch.
    type Memory<N: Number> = [N; 1];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 0;
    const ALIKE: bool = true;

    fn columns(&self) -> Columns {
        Columns {
            memory: vec![Declaration::of_bonds(
                "greatest_stretch",
                Dimension::NUMBER,
                "Greatest stretch that a bond has seen.",
            )],
            ..Columns::default()
        }
    }

    fn constants(&self, material: usize, _: f64) -> [f64; 4] {
        let m = &self.materials[material];
        [
            0.5 * m.micromodulus,
            m.onset,
            m.critical,
            m.onset / (m.critical - m.onset),
        ]
    }

    #[inline(always)]
    fn answer<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> Along<N> {
        let b = branch(bond.stretch, end.constants, end.memory[0]);
        Along(end.constants[C] * bond.omega * b.force * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let (c, past) = (end.constants, end.memory[0]);
        let b = branch(bond.stretch, c, past);
        let before = branch(past, c, past);
        let more = lost(c, b.peak, b.envelope) - lost(c, past, before.envelope);
        let stored = N::constant(0.5).fma(b.force * bond.stretch, more);
        c[C] * bond.omega * bond.length * stored
    }

    #[inline(always)]
    fn advance<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>, memory: &mut [N; 1]) -> N {
        let (c, past) = (end.constants, end.memory[0]);
        let b = branch(bond.stretch, c, past);
        let before = branch(past, c, past);
        memory[0] = b.peak;
        let more = lost(c, b.peak, b.envelope) - lost(c, past, before.envelope);
        c[C] * bond.omega * bond.length * more
    }
}

impl Shelved for Softening {
    fn descriptor() -> Descriptor {
        Descriptor {
            name: "softening".into(),
            doc: "Bond-based, f = c ω ν V (1 − d) s: linear up to the onset, then falling linearly to nothing at the critical stretch; Poisson ratio 1/4, plane stress 1/3. With a fracture energy the critical stretch follows from the area under the curve.".into(),
            source: "bilinear cohesive law, Petersson 1981; on bonds Zaccariotto, Luongo, Sarego & Galvanetto 2015".into(),
            example: "{ young = \"30 GPa\", onset = 0.1 }".into(),
            influence: Influence::Constant,
            memory: Memory::Path,
            keys: vec![
                descriptor::number(
                    "young",
                    Dimension::PRESSURE,
                    Bounds::POSITIVE,
                    "Young's modulus E.",
                ),
                descriptor::number(
                    "onset",
                    Dimension::NUMBER,
                    Bounds {
                        most: 1.0 - 1e-9,
                        ..Bounds::PART
                    },
                    "Stretch at which softening begins, over the critical stretch.",
                ),
            ],
        }
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        match parameters.number("young") {
            Some(young) => Ok(LawSpec::Pmb(PmbStiffness::Young(young))),
            None => Err("a softening bond needs young".into()),
        }
    }

    /// The area under the curve is `½ c s0 s_c`, that of a brittle bond `½ c s_c²`.
    fn brittle_energy(parameters: &Parameters, energy: f64) -> f64 {
        energy / parameters.number("onset").unwrap_or(1.0)
    }

    fn make(_: usize, _: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let mut made = vec![];
        for (n, m) in materials.iter().enumerate() {
            let (Some(c), Some(onset)) = (m.micromodulus, m.parameters.number("onset")) else {
                return Err((n, "a softening bond needs young and onset".into()));
            };
            if !m.critical_stretch.is_finite() {
                return Err((
                    n,
                    "a softening bond ends at its critical stretch: give the material a fracture with critical_stretch or energy".into(),
                ));
            }
            made.push(SofteningConstants {
                micromodulus: c,
                onset: onset * m.critical_stretch,
                critical: m.critical_stretch,
            });
        }
        Ok(Softening { materials: made })
    }
}
