//! Is one kernel better than another (seleson2009 section 3)? Influence functions and horizons of the coarse model, each fitted to the same moduli,
//! by how far their waves are those of the fine model.

use super::crystal::crystal;
use super::error::UpscaleError;
use super::verdict::{EQUAL, directions, linear_differences, shortest};
use crate::crystal::Crystal;
use crate::dispersion::agreement::shortest_wavelength;
use crate::gradient::comparison::Verdict;
use crate::gradient::length_scale;
use peridyne::family::stencil::Stencil;
use peridyne::spec::{Horizon, Influence, LawSpec, PmbStiffness, Spec};

/// Relative error of the frequency up to which waves count as alike.
pub const TOLERANCE: f64 = 0.01;

/// Steps on which the first wave that is off is looked for, before it is refined.
const STEPS: usize = 100;

/// An influence function and a horizon for the coarse model.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    pub influence: Influence,
    /// Length.
    pub horizon: f64,
    /// Is it the horizon of the coarse deck?
    pub kept: bool,
    /// Bonds of a point.
    pub bonds: usize,
    pub verdict: Verdict,
    /// c₄ of longitudinal waves along x over that of the fine model, less 1; `None` with several sites per cell.
    pub fourth: Option<f64>,
    /// √|c₄/c₂| (length).
    pub length_scale: Option<f64>,
    /// Waves shorter than this have a frequency more than [`TOLERANCE`] off, along any symmetry direction, of any branch (length); `None`: none.
    pub wavelength: Option<f64>,
}

/// All influence functions at the horizon of the coarse model, and each at that number of spacings, up to twice as many, where its waves are best; in
/// order of agreement: by gradient order, then by wavelength, then by bonds.
///
/// # Errors
/// The law has no influence function, or constants that belong to one.
pub fn kernels(fine: &Spec, coarse: &Spec) -> Result<Vec<Kernel>, UpscaleError> {
    for material in &fine.materials {
        match &material.law {
            LawSpec::Atoms(_) | LawSpec::Micromoduli(_) => return Err(UpscaleError::NoKernels),
            LawSpec::Pmb(PmbStiffness::Micromodulus(_))
            | LawSpec::Springs(PmbStiffness::Micromodulus(_)) => {
                return Err(UpscaleError::OneKernel);
            }
            LawSpec::Pmb(_)
            | LawSpec::Springs(_)
            | LawSpec::Lps(_)
            | LawSpec::Lps3d { .. }
            | LawSpec::EamLike { .. }
            | LawSpec::Named(_) => {}
        }
    }
    match fine.space.dimension {
        1 => kernels_in::<1>(fine, coarse),
        2 => kernels_in::<2>(fine, coarse),
        _ => kernels_in::<3>(fine, coarse),
    }
}

fn kernels_in<const D: usize>(fine: &Spec, coarse: &Spec) -> Result<Vec<Kernel>, UpscaleError> {
    let (reference, _) = crystal::<D>(fine)?;
    let (lattice, spacing) = super::reference::lattice(coarse)?;
    let family = |horizon| Stencil::new(lattice, spacing, horizon);
    let end = shortest(coarse)?;
    let kept = coarse.bonds.horizon.length(spacing);
    let most = (2.0 * kept / spacing).floor() as u32;
    let mut all = vec![];
    let mut influences = Influence::ALL.to_vec();
    // the deck's own, where it has none of these
    if !influences.contains(&coarse.bonds.influence) {
        influences.push(coarse.bonds.influence);
    }
    for influence in influences {
        let one = |horizon: Horizon, kept: bool| -> Result<Option<Kernel>, UpscaleError> {
            let mut spec = coarse.clone();
            spec.bonds.influence = influence;
            spec.bonds.horizon = horizon;
            let (found, _) = crystal::<D>(&spec)?;
            Ok(
                kernel(&reference, &found, &spec, fine, end).map(|k| Kernel {
                    horizon: horizon.length(spacing),
                    kept,
                    ..k
                }),
            )
        };
        let at_kept = one(coarse.bonds.horizon, true)?;
        let mut best = at_kept.clone();
        for m in 1..=most {
            // the same family again
            if family(Horizon::Ratio(m)) == family(coarse.bonds.horizon) {
                continue;
            }
            if let Some(k) = one(Horizon::Ratio(m), false)?
                && best.as_ref().is_none_or(|b| rank(&k, b).is_lt())
            {
                best = Some(k);
            }
        }
        all.extend(at_kept);
        all.extend(best.filter(|b| !b.kept));
    }
    all.sort_by(rank);
    Ok(all)
}

/// The better one first.
fn rank(a: &Kernel, b: &Kernel) -> std::cmp::Ordering {
    let shortest = |k: &Kernel| k.wavelength.unwrap_or(0.0);
    let order = b.verdict.order.cmp(&a.verdict.order);
    let waves = || shortest(a).total_cmp(&shortest(b));
    order.then_with(waves).then_with(|| a.bonds.cmp(&b.bonds))
}

/// `None`: all weights of the family are zero, so that nothing fits the moduli.
fn kernel<const D: usize>(
    fine: &Crystal<D>,
    coarse: &Crystal<D>,
    spec: &Spec,
    fine_spec: &Spec,
    end: f64,
) -> Option<Kernel> {
    let bonds: Vec<_> = coarse.bonds.iter().filter(|b| b.stiffness != 0.0).collect();
    if bonds.is_empty() || bonds.iter().any(|b| !b.stiffness.is_finite()) {
        return None;
    }
    let stiffness = |c: &Crystal<D>, section: f64| -> Vec<Vec<f64>> {
        let s = c
            .elastic_constants()
            .unwrap_or_else(|| c.rigid_elastic_constants());
        s.c.iter()
            .map(|row| row.iter().map(|x| x / section).collect())
            .collect()
    };
    let (a, b) = (
        stiffness(fine, fine_spec.space.section),
        stiffness(coarse, spec.space.section),
    );
    let along = directions::<D>();
    let first = |c: &Crystal<D>| -> Option<[f64; 2]> {
        let all = c.gradient_coefficients(along[0].1, 2)?;
        Some([all[0][0][0], all[1][0][0]])
    };
    let frequency = |c: &Crystal<D>, k: f64, n: [f64; D], branch: usize| {
        let squared = *c.squares(n.map(|x| k * x)).get(branch)?;
        (squared >= 0.0).then(|| squared.sqrt())
    };
    let mut wavelength: Option<f64> = None;
    for (_, n) in &along {
        for branch in 0..D {
            let found = shortest_wavelength(
                |k| frequency(coarse, k, *n, branch),
                |k| frequency(fine, k, *n, branch),
                end,
                STEPS,
                TOLERANCE,
            );
            wavelength = match (wavelength, found) {
                (Some(a), Some(b)) => Some(a.max(b)),
                (a, b) => a.or(b),
            };
        }
    }
    Some(Kernel {
        influence: spec.bonds.influence,
        horizon: f64::NAN,
        kept: false,
        bonds: bonds.len() / coarse.basis.len(),
        verdict: Verdict::of(&linear_differences(fine, coarse, [&a, &b]), EQUAL, false),
        fourth: first(fine)
            .zip(first(coarse))
            .map(|(a, b)| b[1] / a[1] - 1.0),
        length_scale: first(coarse).and_then(|c| length_scale(&c)),
        wavelength,
    })
}
