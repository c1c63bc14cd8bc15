//! Can a spec be built at all? What is looked at before anything is made.

use super::{preload, traits};
use crate::body::Body;
use crate::constitutive::{Registry, criteria};
use crate::error::BuildError;
use crate::execute::memory;
use crate::execute::simd::{NEITHER, Simd};
use crate::family::stencil::Stencil;
use crate::message;
use crate::quantity::{Dimension, rounded};
use crate::space::ball_volume;
use crate::spec::{LawSpec, Spec};

/// Stages and instruction sets that there are not.
pub(super) fn possible(spec: &Spec, simd: Option<Simd>) -> Result<(), BuildError> {
    if let Some(preload) = &spec.run.preload {
        preload::possible(spec, preload)?;
    }
    let available = Simd::available();
    if available.is_empty() {
        return Err(BuildError::unsupported("simd", NEITHER));
    }
    if let Some(simd) = simd
        && !available.contains(&simd)
    {
        return Err(BuildError::unsupported(
            "simd",
            format!("this machine has no {}", simd.name()),
        ));
    }
    Ok(())
}

/// Does the model fit into memory? Of bonds a stencil keeps bits, a list partners and bits, and atoms about the partners
/// of their cut-off.
pub(super) fn enough_memory<const D: usize>(
    body: &Body<D>,
    stencil: Option<&Stencil>,
    horizon: f64,
    atoms: bool,
) -> Result<(), BuildError> {
    let slots = body.len() as f64;
    let spacings = horizon / body.spacing();
    let (bonds, each) = match stencil {
        Some(s) => (slots * s.bonds() as f64, 0.125),
        None => {
            // no point has more partners than the ball holds, or the body
            let ball = ball_volume(D, spacings);
            // the estimate may be some times too high where bodies are thin: the list itself is counted before it is made
            let doubt = if atoms { 1.0 } else { 4.0 };
            (slots * ball.min(body.points() as f64) / doubt, 4.125)
        }
    };
    let (what, path, help) = if bonds * each > slots * 24.0 * D as f64 {
        (
            format!(
                "{} bonds of {} points",
                rounded(bonds, 3),
                rounded(body.points() as f64, 3)
            ),
            "horizon",
            message![
                "the horizon ",
                Dimension::LENGTH.of(horizon),
                format!(
                    " is {spacings:.1} spacings: check its unit and its decimal point, and those of the spacing; three to six spacings are usual"
                ),
            ],
        )
    } else {
        (
            format!("a body of {} points", rounded(body.points() as f64, 3)),
            "body.spacing",
            "check the units of the spacing and of the region; a larger spacing makes fewer points"
                .into(),
        )
    };
    memory::afford(path, &what, slots * 24.0 * D as f64 + bonds * each, help)
}

/// Do its parts go together, and lists that it gives belong to each other?
pub(super) fn consistent(spec: &Spec, registry: &Registry) -> Result<(), BuildError> {
    traits::agree(spec, registry)?;
    criteria::consistent(spec)?;
    for (n, m) in spec.materials.iter().enumerate() {
        let fits = match &m.law {
            LawSpec::Micromoduli(body) => body.check(),
            LawSpec::Pmb(_)
            | LawSpec::Lps(_)
            | LawSpec::Lps3d { .. }
            | LawSpec::EamLike { .. }
            | LawSpec::Springs(_)
            | LawSpec::Atoms(_)
            | LawSpec::Named(_) => Ok(()),
        };
        fits.map_err(|message| BuildError::invalid(format!("materials[{n}].law"), message))?;
    }
    Ok(())
}
