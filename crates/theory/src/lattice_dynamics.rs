//! Lattice dynamics: what the linear model of a lattice says, for reports: waves along the path of the Brillouin zone and along
//! symmetry directions, stability, elastic constants, gradient coefficients. Per volume of the three-dimensional body.

mod waves;

use crate::crystal::{Crystal, LatticeSolid, Reference};
use crate::dispersion::zone::{special_points, special_points_of};
use crate::elastic_constants::continuum;
use crate::exact::{Field, Q};
use crate::gradient::fractions::fractions;
use crate::gradient::linear::LinearChain;
use crate::gradient::{Expansion, nonlinear};
use crate::nominal::nominal_moduli;
use crate::stability::Limit;
use crate::upscale::{UpscaleError, crystal, lattice};
use crate::voigt::Stiffness;
use peridyne::law::micromodulus::Moments;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{Moduli, Spec};
use std::f64::consts::PI;
pub use waves::{Branch, Direction, Row};
use waves::{along_path, directions, scaled, size};

/// A wave that does not oscillate but grows.
#[derive(Debug, Clone, PartialEq)]
pub struct Growing {
    /// Name, if it is a special point; else of the worst wave of the zone.
    pub name: Option<&'static str>,
    pub wave: Vec<f64>,
    /// √−ω² (1 / time).
    pub rate: f64,
}

/// What [`lattice_dynamics`] finds.
#[derive(Debug, Clone, PartialEq)]
pub struct LatticeDynamics {
    pub dimension: usize,
    pub kind: LatticeKind,
    pub spacing: f64,
    pub density: f64,
    pub bonds: usize,
    pub sites: usize,
    pub time_step: f64,
    pub path: Vec<Row>,
    pub directions: Vec<Direction>,
    /// Part of all waves of the zone that grow.
    pub unstable_part: f64,
    pub growing: Vec<Growing>,
    /// A step below which nothing can blow up.
    pub bound: f64,
    /// The shortest wave's frequency squared, and where it is.
    pub largest: f64,
    pub largest_wave: Vec<f64>,
    /// `2/ω_max`
    pub sharp: f64,
    /// Sites relaxed, or rigid if they are unstable against each other.
    pub stiffness: Stiffness,
    pub relaxed: bool,
    /// Stress against strain, under pressure.
    pub stress_strain: Option<Stiffness>,
    /// What the law is made for.
    pub nominal: Option<Moduli>,
    pub continuum: Option<Stiffness>,
    pub pressure: f64,
    /// Largest net force on a site.
    pub residual: f64,
    pub reference: Option<Reference>,
    /// Of a chain of atoms: stretches y′ and the nonlinear gradient equation there.
    pub nonlinear: Vec<(f64, Expansion<f64>)>,
    /// Of a bond-based chain: `c_{2p+2}/(c_2 a^{2p})`; empty where they are no fractions.
    pub fractions: Vec<Q>,
}

/// Gradient coefficients per direction if nobody says otherwise: up to ∂⁸.
pub const TERMS: usize = 4;

/// Stretches and gradient orders of nonlinear equations.
pub const STRETCHES: [f64; 3] = [0.98, 1.0, 1.02];

pub const NONLINEAR_TERMS: usize = 3;

/// What waves a lattice spec carries, with steps of `time_step`, and so many gradient coefficients.
pub fn lattice_dynamics(
    spec: &Spec,
    time_step: f64,
    terms: usize,
) -> Result<LatticeDynamics, UpscaleError> {
    match spec.space.dimension {
        1 => dynamics_in::<1>(spec, time_step, terms),
        2 => dynamics_in::<2>(spec, time_step, terms),
        _ => dynamics_in::<3>(spec, time_step, terms),
    }
}

fn dynamics_in<const D: usize>(
    spec: &Spec,
    dt: f64,
    terms: usize,
) -> Result<LatticeDynamics, UpscaleError> {
    let (kind, spacing) = lattice(spec)?;
    let (crystal, reference) = crystal::<D>(spec)?;
    let (points, unit) = match spec.materials.len() {
        1 => (special_points(kind), spacing),
        _ => special_points_of(&crystal),
    };
    let per_axis = grid(&crystal, spacing);
    let limit = largest(&crystal, spec, per_axis);
    let scale = limit.squared.abs();
    let relaxed = crystal.elastic_constants();
    let section = spec.space.section;
    let per_section = |mut s: Stiffness| {
        s.c.iter_mut().flatten().for_each(|c| *c /= section);
        s
    };
    let moments = {
        let mut solid = LatticeSolid::new(kind, spacing, spec.bonds.horizon);
        solid.section = section;
        Moments::continuum(D, solid.delta(), section, spec.bonds.influence)
    };
    let nominal = nominal_moduli(&spec.materials[0].law, D, spec.space.plane, moments);
    let instability = crystal.instability(per_axis);
    let mut growing: Vec<Growing> = vec![];
    if let Some(worst) = &instability {
        for p in &points {
            let wave: [f64; D] = scaled(&p.wave, 2.0 * PI / unit);
            let squared = crystal.squares(wave)[0];
            if squared < -1e-10 * scale && growing.iter().all(|g| g.name != Some(p.name)) {
                growing.push(Growing {
                    name: Some(p.name),
                    wave: wave.to_vec(),
                    rate: (-squared).sqrt(),
                });
            }
        }
        growing.push(Growing {
            name: None,
            wave: nearest_to_centre(&crystal, worst.wave).to_vec(),
            rate: worst.growth,
        });
    }
    let directions = directions(&crystal, &points, unit, dt, scale, section, terms);
    // the fractions are of this very chain
    let same = |all: &Vec<Q>| {
        let c = directions
            .first()
            .map(Direction::longitudinal)
            .unwrap_or_default();
        all.len() == c.len()
            && all.iter().enumerate().all(|(p, q)| {
                let found = c[p] / c[0] / spacing.powi(2 * p as i32);
                (found - q.value()).abs() <= 1e-9 * q.value().abs()
            })
    };
    let fractions = fractions(spec, terms).filter(same).unwrap_or_default();
    Ok(LatticeDynamics {
        dimension: D,
        kind,
        spacing,
        density: crystal.density() / section,
        bonds: crystal.bonds.len() / crystal.basis.len(),
        sites: crystal.basis.len(),
        time_step: dt,
        path: along_path(&crystal, &points, unit, dt, scale),
        directions,
        fractions,
        unstable_part: instability.map_or(0.0, |i| i.part),
        growing,
        bound: crystal.bound(),
        largest: limit.squared,
        largest_wave: nearest_to_centre(&crystal, limit.wave).to_vec(),
        sharp: limit.time_step(),
        relaxed: relaxed.is_some(),
        stiffness: per_section(relaxed.unwrap_or_else(|| crystal.rigid_elastic_constants())),
        stress_strain: crystal.stress_strain().map(per_section),
        continuum: nominal.map(|m| continuum(D, spec.space.plane, m)),
        nominal,
        pressure: crystal.pressure() / section,
        residual: crystal.residual(),
        nonlinear: match (D, &reference) {
            (1, Some(_)) => nonlinear::of_spec(spec, &STRETCHES, NONLINEAR_TERMS)?,
            _ => vec![],
        },
        reference,
    })
}

/// Points along a reciprocal vector that show every wave of bonds that span many cells.
fn grid<const D: usize>(crystal: &Crystal<D>, spacing: f64) -> usize {
    let far = crystal.bonds.iter().map(|b| b.length()).fold(0.0, f64::max) / spacing;
    let reach = far.ceil() as usize;
    match D {
        1 => (32 * reach).max(64),
        2 => (4 * reach).clamp(24, 64),
        _ => (2 * reach + 4).clamp(8, 16),
    }
}

/// In 1-D to round-off, by the chain.
fn largest<const D: usize>(crystal: &Crystal<D>, spec: &Spec, per_axis: usize) -> Limit<D> {
    let chain = (D == 1)
        .then(|| self::crystal::<1>(spec).ok())
        .flatten()
        .and_then(|(c, _)| LinearChain::of_crystal(&c));
    match chain {
        Some(chain) => {
            let limit = chain.largest(crystal.density());
            Limit {
                squared: limit.squared,
                wave: [limit.wave[0]; D],
            }
        }
        None => crystal.largest(per_axis),
    }
}

/// The same wave by the vector nearest to Γ: in the first zone.
fn nearest_to_centre<const D: usize>(crystal: &Crystal<D>, wave: [f64; D]) -> [f64; D] {
    let b = crystal.reciprocal();
    let mut best = wave;
    loop {
        let from = best;
        for code in 0..3usize.pow(D as u32) {
            let n: [f64; D] =
                std::array::from_fn(|i| (code / 3usize.pow(i as u32) % 3) as f64 - 1.0);
            let moved: [f64; D] =
                std::array::from_fn(|a| from[a] + (0..D).map(|i| n[i] * b[i][a]).sum::<f64>());
            // on the border of the zone the vector given stays
            if size(&moved) < size(&best) * (1.0 - 1e-9) {
                best = moved;
            }
        }
        if best == from {
            return best;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::space::region::Region;
    use peridyne::spec::{BodySpec, Horizon, LawSpec, PmbStiffness};

    fn spec(kind: LatticeKind, law: LawSpec, m: u32) -> Spec {
        let mut spec = Spec::new(
            kind.dimension(),
            BodySpec::Lattice {
                kind,
                spacing: 0.5,
                origin: [0.0; 3],
                region: Region::Everything,
                perturb: None,
            },
            2.0,
            law,
        );
        spec.bonds.horizon = Horizon::Ratio(m);
        spec.space.section = 0.3;
        spec
    }

    #[test]
    fn springs_of_one_neighbour_are_the_textbook_chain() {
        let law = LawSpec::Springs(PmbStiffness::Young(8.0));
        let found =
            lattice_dynamics(&spec(LatticeKind::Chain, law.clone(), 1), 0.2, TERMS).unwrap();
        // c = 2, ω_max = 2c/a = 8; at the edge sin(ω Δt/2) = ω Δt/2 of the wave
        assert!((found.sharp - 0.25).abs() < 1e-14);
        let edge = found.path.last().unwrap();
        assert_eq!(edge.name, Some("X"));
        let b = edge.branches[0];
        assert!((b.signed() - 8.0).abs() < 1e-12);
        assert!((b.verlet.unwrap() - 10.0 * 0.8f64.asin()).abs() < 1e-10);
        assert!(b.group.unwrap().abs() < 1e-7);
        let x = &found.directions[0];
        assert!((x.sound[0].unwrap() - 2.0).abs() < 1e-13);
        // ρ ü = E u'' + E a²/12 u''''
        let c = x.longitudinal();
        assert!((c[0] - 8.0).abs() < 1e-12 && (c[1] - 8.0 * 0.25 / 12.0).abs() < 1e-12);
        assert!((found.stiffness.c[0][0] - 8.0).abs() < 1e-12);
        assert!((found.continuum.unwrap().c[0][0] - 8.0).abs() < 1e-12);
        assert!(found.growing.is_empty());
        // beyond the limit the shortest waves have no frequency
        let fast = lattice_dynamics(&spec(LatticeKind::Chain, law, 1), 0.26, TERMS).unwrap();
        assert_eq!(fast.path.last().unwrap().branches[0].verlet, None);
        assert!(fast.path[1].branches[0].verlet.is_some());
    }

    #[test]
    fn waves_are_named_by_the_vector_of_the_first_zone() {
        let body = LatticeSolid::new(LatticeKind::Fcc, 2.0, Horizon::Ratio(1));
        let crystal = body.bond_based::<3>(1.0).unwrap();
        // 2π/a (1, 1, 0) is X: less b = 2π/a (1, 1, −1) and its like
        let x = nearest_to_centre(&crystal, [PI, PI, 0.0]);
        assert!((size(&x) - PI).abs() < 1e-12, "{x:?}");
        let k = [0.1, -0.2, 0.3];
        let far: [f64; 3] = std::array::from_fn(|a| k[a] + 2.0 * PI * [2.0, -1.0, 0.0][a]);
        let near = nearest_to_centre(&crystal, far);
        assert!((0..3).all(|a| (near[a] - k[a]).abs() < 1e-12), "{near:?}");
    }

    #[test]
    fn directions_are_the_lines_from_the_centre() {
        let law = LawSpec::Lps(Moduli {
            young: 3.0,
            poisson: 0.3,
        });
        let found = lattice_dynamics(&spec(LatticeKind::Square, law, 3), 0.01, TERMS).unwrap();
        let names: Vec<&str> = found.directions.iter().map(|d| d.name.as_str()).collect();
        assert_eq!(names, ["Γ–X", "Γ–M"]);
        assert!(found.bound <= found.sharp * (1.0 + 1e-9));
        for d in &found.directions {
            // long waves: group and phase velocity are the speed of sound
            for (b, v) in d.rows[0].branches.iter().zip(&d.sound) {
                let v = v.unwrap();
                assert!((b.phase.unwrap() / v - 1.0).abs() < 0.01);
                assert!((b.group.unwrap() / v - 1.0).abs() < 0.02);
            }
        }
        let c11 = found.directions[0].longitudinal()[0];
        assert!((c11 / found.stiffness.c[0][0] - 1.0).abs() < 1e-12);
    }
}
