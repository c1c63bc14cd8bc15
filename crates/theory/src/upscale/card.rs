//! The error card of an upscaling: what both models say of the same crystal, side by side.

use super::atoms::{Atoms, has_basis_or_many_body};
use super::crystal::crystal;
use super::error::UpscaleError;
use super::kernels::Kernel;
use super::reference::lattice;
use super::scale::Rule;
use super::verdict::{EQUAL, directions, linear_differences, shortest};
use crate::crystal::Crystal;
use crate::exact::polynomial::Monomial;
use crate::gradient::comparison::{Verdict, compare};
use crate::gradient::{Expansion, length_scale, nonlinear};
use crate::lattice_dynamics::{NONLINEAR_TERMS, STRETCHES};
use peridyne::message;
use peridyne::quantity::{Dimension, Message, rounded};
use peridyne::run::{Options, build};
use peridyne::spec::{BodySpec, Criterion, FamilyChoice, Horizon, MaterialSpec, Spec, TimeStep};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// One of the two models.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    pub spacing: f64,
    /// Bonds of a point.
    pub bonds: usize,
    /// Points per volume.
    pub points: f64,
    /// Largest stable step (time).
    pub stable_step: f64,
    /// Pressure of the reference (energy / volume); 0 for solids.
    pub pressure: f64,
    /// Energy density of the reference (energy / volume); 0 for solids.
    pub energy: f64,
    /// Stiffness in Voigt's notation, with the first D(D+1)/2 rows and columns (energy / volume).
    pub stiffness: Vec<Vec<f64>>,
    /// Zener's ratio 2 c44/(c11 − c12) of cubic crystals.
    pub anisotropy: Option<f64>,
    /// √|c₄/c₂| of longitudinal waves along x (length); `None` with several sites per cell.
    pub length_scale: Option<f64>,
    /// Slowest growing wave that does not oscillate but grows: its part of all waves, if there is one.
    pub unstable: Option<f64>,
}

/// Energy density under a strain, less that of the reference.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyRow {
    pub mode: &'static str,
    pub strain: f64,
    pub fine: f64,
    pub coarse: f64,
}

/// A gradient coefficient of longitudinal waves along x: `ρ ü = Σ c_k ∂^k u`.
#[derive(Debug, Clone, PartialEq)]
pub struct GradientRow {
    pub order: usize,
    pub fine: f64,
    pub coarse: f64,
}

/// A term of the nonlinear gradient equation of a chain of atoms, `ρ ÿ = Σ P(y′, y″, …)`, at a stretch y′.
#[derive(Debug, Clone, PartialEq)]
pub struct NonlinearRow {
    pub stretch: f64,
    pub order: usize,
    /// As `y(4) y''`.
    pub term: String,
    pub fine: f64,
    pub coarse: f64,
}

/// Frequencies of all branches along a direction, from long waves to the coarse model's shortest.
#[derive(Debug, Clone, PartialEq)]
pub struct Dispersion {
    pub direction: String,
    /// Wave numbers (1 / length).
    pub wave: Vec<f64>,
    /// `[wave][branch]` (1 / time); NaN where a wave grows.
    pub fine: Vec<Vec<f64>>,
    pub coarse: Vec<Vec<f64>>,
    /// Tolerance and the wavelength below which frequencies differ by more; `None`: nowhere.
    pub wavelengths: Vec<(f64, Option<f64>)>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    pub factor: u32,
    pub dimension: usize,
    pub rule: Rule,
    pub fine: Side,
    pub coarse: Side,
    /// Are they upscalings of each other? By the gradient equations along all symmetry directions; of chains of atoms by the nonlinear ones, too; with
    /// several sites per cell by the elastic constants alone.
    pub verdict: Verdict,
    /// Influence functions for the coarse model; empty where nobody asked.
    pub kernels: Vec<Kernel>,
    pub energies: Vec<EnergyRow>,
    pub gradients: Vec<GradientRow>,
    pub nonlinear: Vec<NonlinearRow>,
    pub dispersion: Vec<Dispersion>,
    /// Points × bonds × steps of the fine model over those of the coarse, both at their stable steps; in statics points × bonds.
    pub cost: f64,
    pub statics: bool,
    /// Where the upscaling is not valid, in words.
    pub notes: Vec<Message>,
}

/// Tolerances for which wavelengths are given.
const TOLERANCES: [f64; 2] = [0.01, 0.05];
const STRAINS: [f64; 7] = [-0.02, -0.01, -0.005, 0.005, 0.01, 0.02, 0.05];
const WAVES: usize = 200;

/// Compare a model with its upscaling.
pub fn card(fine: &Spec, coarse: &Spec, factor: u32, rule: Rule) -> Result<Card, UpscaleError> {
    match fine.space.dimension {
        1 => card_in::<1>(fine, coarse, factor, rule),
        2 => card_in::<2>(fine, coarse, factor, rule),
        _ => card_in::<3>(fine, coarse, factor, rule),
    }
}

/// A critical stretch that is kept means another fracture energy where the horizon δ is another one: `G0 ~ s0² δ` of equal moduli (Silling &
/// Askari 2005).
fn toughness(coarse: &Spec, rule: Rule, spacings: [f64; 2]) -> Option<Message> {
    let ratio = match rule {
        Rule::Horizon => return None,
        // all lengths of a family grow with the spacing
        Rule::Shells | Rule::Reduced => spacings[1] / spacings[0],
    };
    let stretch = |m: &MaterialSpec| match m.fracture.map(|f| f.criterion) {
        Some(Criterion::Stretch(s)) => Some(s),
        Some(
            Criterion::Energy(_)
            | Criterion::BondEnergy(_)
            | Criterion::VonMises(_)
            | Criterion::PlasticStrain(_),
        )
        | None => None,
    };
    let kept: Vec<f64> = coarse.materials.iter().filter_map(stretch).collect();
    if kept.is_empty() {
        return None;
    }
    let give = kept.iter().map(|s| rounded(s / ratio.sqrt(), 4));
    Some(Message::from(format!(
        "The critical stretch is kept, and with a horizon {} times as long a crack takes {} times the energy: for the same fracture energy give critical_stretch = {}.",
        rounded(ratio, 4),
        rounded(ratio, 4),
        give.collect::<Vec<_>>().join(", ")
    )))
}

fn card_in<const D: usize>(
    fine: &Spec,
    coarse: &Spec,
    factor: u32,
    rule: Rule,
) -> Result<Card, UpscaleError> {
    let mut notes: Vec<Message> = vec![];
    let (a, a_reference) = crystal::<D>(fine)?;
    let (b, b_reference) = crystal::<D>(coarse)?;
    let left = side(fine, &a, a_reference)?;
    let right = side(coarse, &b, b_reference)?;
    if a_reference.is_some() {
        let scale = left.stiffness[0][0].abs();
        if left.pressure.abs() > 1e-4 * scale {
            notes.push(message![
                "The reference is under a pressure of ",
                Dimension::PRESSURE.of(left.pressure),
                format!(
                    ", {:.2} % of c11: ends and surfaces must be held, and constants contain it.",
                    100.0 * left.pressure / scale
                ),
            ]);
        }
    }
    for (name, side) in [("fine", &left), ("coarse", &right)] {
        if let Some(part) = side.unstable {
            notes.push(Message::from(format!(
                "The reference state of the {name} model is unstable: {:.1} % of all waves grow. Nothing that follows from it can be trusted.",
                100.0 * part
            )));
        }
    }
    if rule == Rule::Horizon && right.bonds <= 2 * D {
        notes.push(
            "Only nearest neighbours are left: h is as large as the horizon, and the nonlocality of the model is lost.".into(),
        );
    }
    if rule == Rule::Reduced {
        notes.push("The length scale of Lennard-Jones is the spacing: shocks and their oscillations change with h.".into());
    }
    if a.basis.len() > 1 {
        notes.push(optical(&a, factor));
    }
    let current = has_basis_or_many_body(fine) && super::reference::current(fine);
    if current {
        notes.push("The coarse atoms interact with their current neighbours, as the fine ones do: the coarse crystal is the fine one, larger and heavier; defects, surfaces and thermal motion of it are not those of the fine one.".into());
    }
    if rule == Rule::Shells && a_reference.is_some() && !current {
        notes.push("Neighbours are those of the reference: beyond a compression of a tenth some that would enter are missing; bonds never change partners (no diffusion, melting, slip).".into());
    }
    notes.extend(toughness(coarse, rule, [left.spacing, right.spacing]));
    let energies = energies(fine, coarse, &mut notes);
    let directions = directions::<D>();
    let end = shortest(coarse)?;
    let dispersion = directions
        .iter()
        .map(|(name, n)| waves(name, *n, &a, &b, end))
        .collect();
    let gradients = match (
        a.gradient_coefficients(directions[0].1, 3),
        b.gradient_coefficients(directions[0].1, 3),
    ) {
        (Some(x), Some(y)) => x
            .iter()
            .zip(&y)
            .enumerate()
            .map(|(p, (x, y))| GradientRow {
                order: 2 * p + 2,
                fine: x[0][0] / fine.space.section,
                coarse: y[0][0] / fine.space.section,
            })
            .collect(),
        _ => vec![],
    };
    let statics = fine.run.schedule.statics().is_some();
    let cost = |s: &Side| match statics {
        true => s.points * s.bonds as f64,
        false => s.points * s.bonds as f64 / s.stable_step,
    };
    let stretched = match (D, &a_reference) {
        (1, Some(_)) => of_stretches(fine, coarse)?,
        _ => vec![],
    };
    let mut apart = linear_differences(&a, &b, [&left.stiffness, &right.stiffness]);
    for (_, fine, coarse) in &stretched {
        apart.extend(compare(fine, coarse, EQUAL).differences());
    }
    Ok(Card {
        factor,
        dimension: D,
        rule,
        cost: cost(&left) / cost(&right),
        statics,
        verdict: Verdict::of(&apart, EQUAL, rule == Rule::Horizon),
        kernels: vec![],
        fine: left,
        coarse: right,
        energies,
        gradients,
        nonlinear: nonlinear_rows(&stretched),
        dispersion,
        notes,
    })
}

/// What becomes of the waves in which the sites of a cell move against each other.
fn optical<const D: usize>(fine: &Crystal<D>, factor: u32) -> Message {
    let squares = fine.squares([0.0; D]);
    let mut each = Message::default();
    for (n, s) in squares.iter().skip(D).enumerate() {
        each.add(if n > 0 { ", " } else { "" });
        each.add(Dimension::FREQUENCY.of(s.abs().sqrt().copysign(*s)));
    }
    message![
        format!(
            "The cell has {} sites. Acoustic waves are kept, and so are mass density and elastic constants with sites relaxed; the {} optical branches of the fine model, ω = ",
            fine.basis.len(),
            squares.len() - D
        ),
        each,
        format!(
            " where all cells move alike, are lost: those of the coarse model lie at 1/{factor} of these and stand for nothing."
        ),
    ]
}

/// A stretch y′ and the nonlinear gradient equations of both models there.
type Stretched = (f64, Expansion<f64>, Expansion<f64>);

/// Where both have a value.
fn of_stretches(fine: &Spec, coarse: &Spec) -> Result<Vec<Stretched>, UpscaleError> {
    let [fine, coarse] =
        [fine, coarse].map(|spec| nonlinear::of_spec(spec, &STRETCHES, NONLINEAR_TERMS));
    let coarse = coarse?;
    let both = fine?.into_iter().filter_map(|(stretch, fine)| {
        let (_, coarse) = coarse.iter().find(|(s, _)| *s == stretch)?;
        Some((stretch, fine, coarse.clone()))
    });
    Ok(both.collect())
}

fn nonlinear_rows(stretched: &[Stretched]) -> Vec<NonlinearRow> {
    let mut rows = vec![];
    for (stretch, fine, coarse) in stretched {
        for (p, (a, b)) in fine.orders.iter().zip(&coarse.orders).enumerate() {
            let terms: BTreeSet<&Monomial> = a.terms().chain(b.terms()).map(|(m, _)| m).collect();
            rows.extend(terms.into_iter().map(|m| NonlinearRow {
                stretch: *stretch,
                order: 2 * p + 2,
                term: m.to_string(),
                fine: a.of(m),
                coarse: b.of(m),
            }));
        }
    }
    rows
}

fn side<const D: usize>(
    spec: &Spec,
    crystal: &Crystal<D>,
    reference: Option<crate::crystal::Reference>,
) -> Result<Side, UpscaleError> {
    let (kind, spacing) = lattice(spec)?;
    let volume = kind.site_volume() * spacing.powi(D as i32) * spec.space.section;
    let stiffness = crystal
        .elastic_constants()
        .unwrap_or_else(|| crystal.rigid_elastic_constants());
    let n = D * (D + 1) / 2;
    Ok(Side {
        spacing,
        bonds: crystal.bonds.len() / crystal.basis.len(),
        points: 1.0 / volume,
        stable_step: crystal.largest(if D == 3 { 8 } else { 32 }).time_step(),
        pressure: reference.map_or(0.0, |r| r.pressure / spec.space.section),
        energy: reference.map_or(0.0, |r| r.energy / volume),
        stiffness: (0..n)
            .map(|i| {
                (0..n)
                    .map(|j| stiffness.c[i][j] / spec.space.section)
                    .collect()
            })
            .collect(),
        anisotropy: if D == 1 {
            None
        } else {
            stiffness.cubic(1e-6).map(|c| c.zener())
        },
        length_scale: crystal
            .gradient_coefficients(directions::<D>()[0].1, 2)
            .and_then(|c| length_scale(&[c[0][0][0], c[1][0][0]])),
        unstable: crystal
            .instability(if D == 3 { 8 } else { 64 })
            .map(|i| i.part),
    })
}

/// Energy density of a homogeneous strain.
type Strained<'a> = Box<dyn Fn([[f64; 3]; 3]) -> f64 + 'a>;

/// Of a perfect crystal, its sites carried along; where neighbours are fixed, of a periodic block.
fn strained(spec: &Spec) -> Option<Strained<'_>> {
    if has_basis_or_many_body(spec) {
        return match spec.space.dimension {
            1 => cell_under_strain::<1>(spec),
            2 => cell_under_strain::<2>(spec),
            _ => cell_under_strain::<3>(spec),
        };
    }
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let block = build(&block(spec)?, options).ok()?;
    Some(Box::new(move |strain| block.energy_under_strain(strain)[0]))
}

fn cell_under_strain<const D: usize>(spec: &Spec) -> Option<Strained<'_>> {
    let atoms = Atoms::<D>::of(spec).ok()?;
    Some(Box::new(move |strain| {
        atoms.energy_density(strain).unwrap_or(f64::NAN) / spec.space.section
    }))
}

/// Energies of both models under homogeneous strains.
fn energies(fine: &Spec, coarse: &Spec, notes: &mut Vec<Message>) -> Vec<EnergyRow> {
    let d = fine.space.dimension;
    let [Some(a), Some(b)] = [fine, coarse].map(strained) else {
        notes.push(
            "Energies under strain are missing: no periodic block holds the neighbours.".into(),
        );
        return vec![];
    };
    let mut modes: Vec<(&'static str, [[f64; 3]; 3])> = vec![];
    let mut isotropic = [[0.0; 3]; 3];
    for (x, row) in isotropic.iter_mut().enumerate().take(d) {
        row[x] = 1.0;
    }
    modes.push(("isotropic", isotropic));
    if d > 1 {
        let (mut uniaxial, mut shear) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        uniaxial[0][0] = 1.0;
        (shear[0][1], shear[1][0]) = (0.5, 0.5);
        modes.push(("uniaxial", uniaxial));
        modes.push(("shear", shear));
    }
    let [rest_a, rest_b] = [&a, &b].map(|energy| energy([[0.0; 3]; 3]));
    let mut rows = vec![];
    for (mode, shape) in modes {
        for strain in STRAINS {
            let tensor = shape.map(|row| row.map(|x| strain * x));
            let (fine, coarse) = (a(tensor) - rest_a, b(tensor) - rest_b);
            if !(fine.is_finite() && coarse.is_finite()) {
                let told =
                    format!("Under a {mode} strain of {strain} the energy has no value (ρ_h ≤ 0).");
                notes.push(told.into());
                continue;
            }
            rows.push(EnergyRow {
                mode,
                strain,
                fine,
                coarse,
            });
        }
    }
    rows
}

/// A periodic block of the spec's lattice that its family fits into, on fixed neighbours.
fn block(spec: &Spec) -> Option<Spec> {
    let (kind, spacing) = lattice(spec).ok()?;
    let d = kind.dimension();
    let horizon = match (spec.potential(), spec.bonds.family) {
        (Some(p), FamilyChoice::Auto | FamilyChoice::Neighbours) => {
            Horizon::Length(super::reference::REACH * p.cut_off())
        }
        _ => spec.bonds.horizon,
    };
    let length = horizon.length(spacing);
    let cells = (length / spacing).ceil() as usize + 1;
    let count = cells.pow(d as u32) * kind.basis().len();
    if count > 200_000 {
        return None;
    }
    let mut quarters = Vec::with_capacity(count);
    for i in 0..cells.pow(d as u32) {
        let cell: [usize; 3] = std::array::from_fn(|a| {
            if a < d {
                i / cells.pow(a as u32) % cells
            } else {
                0
            }
        });
        for b in kind.basis() {
            quarters.push(std::array::from_fn(|a| 4 * cell[a] as i32 + b[a]));
        }
    }
    let law = spec.materials[0].law.clone();
    let body = BodySpec::Sites {
        kind,
        spacing,
        origin: [0.0; 3],
        quarters,
        volume: None,
    };
    let mut block = Spec::new(d, body, spec.materials[0].density, law);
    block.space.plane = spec.space.plane;
    block.space.section = spec.space.section;
    block.bonds.horizon = horizon;
    block.bonds.influence = spec.bonds.influence;
    block.bonds.partial_volume_correction = spec.bonds.partial_volume_correction;
    block.bonds.calibration = spec.bonds.calibration;
    block.bonds.family = FamilyChoice::Stencil;
    block.run.schedule.time_step = TimeStep::Fixed(1.0);
    block.space.periodic =
        std::array::from_fn(|a| (a < d).then(|| spacing * kind.edges()[a] * cells as f64));
    Some(block)
}

fn waves<const D: usize>(
    name: &str,
    n: [f64; D],
    a: &Crystal<D>,
    b: &Crystal<D>,
    end: f64,
) -> Dispersion {
    // the acoustic branches: of several sites per cell the lowest
    let branches = |c: &Crystal<D>, k: f64| -> Vec<f64> {
        let squares = c.squares(n.map(|x| k * x));
        squares.iter().take(D).map(|s| s.sqrt()).collect()
    };
    let wave: Vec<f64> = (1..=WAVES).map(|i| end * i as f64 / WAVES as f64).collect();
    let fine: Vec<Vec<f64>> = wave.iter().map(|k| branches(a, *k)).collect();
    let coarse: Vec<Vec<f64>> = wave.iter().map(|k| branches(b, *k)).collect();
    let wavelengths = TOLERANCES
        .iter()
        .map(|t| {
            // an unstable wave has no frequency and is never near
            let near = |x: f64, y: f64| (x - y).abs() <= t * y.abs().max(x.abs());
            let apart =
                |(x, y): (&Vec<f64>, &Vec<f64>)| x.iter().zip(y).any(|(x, y)| !near(*x, *y));
            let first = fine.iter().zip(&coarse).position(apart);
            (*t, first.map(|i| 2.0 * PI / wave[i]))
        })
        .collect();
    Dispersion {
        direction: name.to_string(),
        wave,
        fine,
        coarse,
        wavelengths,
    }
}
