//! The stability limit of a body, measured on the body itself, or on a block of its lattice where that is smaller.

use super::surface;
use crate::body::{Body, Layout};
use crate::constitutive::ConstitutiveModel;
use crate::dynamics::stable_step::{largest_eigenvalue, row_bound};
use crate::error::BuildError;
use crate::interaction::Interaction;
use crate::spec::Spec;
use crate::statics::SYMMETRIC;

/// Above this a lattice body is represented by a block of itself.
const LARGE: usize = 20_000;
/// Cells per axis of that block: eight horizons of the usual family; the spectrum's top no longer changes.
const BLOCK: usize = 24;
/// Cells per neighbour on one side, where families are larger than that.
const PER_REACH: usize = 8;

/// Largest eigenvalue of `M⁻¹K` of the bonds (1 / time²); 0 if nothing resists.
///
/// A large lattice body is probed on a block with the same lattice, periodic axes and thickness, once per material:
/// it has the bulk and every kind of flat surface, edge and corner.
pub(super) fn bonds<const D: usize>(
    model: &ConstitutiveModel,
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
    spec: &Spec,
    cell_volume: Option<f64>,
) -> Result<f64, BuildError> {
    let lambda = match body.layout() {
        // no block has all the factors of a body, nor all its places
        Layout::Grid(grid)
            if body.all_points() > LARGE && spec.bonds.factors.is_empty() && !model.varies() =>
        {
            let reach = model.stencil.as_ref().map_or(1, |s| s.reach());
            // in the plane and in space a block of many large families would cost more than the run
            let block = match D {
                1 => BLOCK.max(PER_REACH * reach),
                _ => BLOCK,
            };
            let extent: [usize; D] =
                crate::array::from_fn(|a| (grid.cells()[a] - 2 * grid.halo()[a]).min(block));
            let basis = grid.lattice().kind.basis();
            let mut quarters = vec![];
            for i in 0..extent.iter().product::<usize>() {
                let mut rest = i;
                let cell: [usize; D] = crate::array::from_fn(|a| {
                    let c = rest % extent[a];
                    rest /= extent[a];
                    c
                });
                quarters.extend(basis.iter().map(|b| -> [i32; 3] {
                    crate::array::from_fn(|a| if a < D { 4 * cell[a] as i32 + b[a] } else { 0 })
                }));
            }
            let periodic = crate::array::from_fn(|a| body.period()[a].is_some());
            let whole = Body::<D>::on_lattice(
                *grid.lattice(),
                &quarters,
                reach,
                periodic,
                cell_volume.unwrap_or(1.0),
            )?;
            let factors = match &spec.bonds.surface {
                None => None,
                Some(all) => match surface::of_block(all, body, &whole) {
                    Some(factors) => Some(factors),
                    // no block has all its places
                    None => return Ok(largest_eigenvalue(body, interaction)),
                },
            };
            let mut lambda = 0.0f64;
            for (n, m) in spec.materials.iter().enumerate() {
                let mut block = whole.clone();
                block.set_density(m.density);
                let mut it = model.interaction(&block, Some(n))?;
                if let Some(factors) = &factors {
                    surface::scale(factors, &mut block, it.as_mut())?;
                }
                it.prepare(&block);
                lambda = lambda.max(largest_eigenvalue(&block, it.as_mut()));
            }
            lambda
        }
        Layout::Grid(_) | Layout::Cloud(_) | Layout::Several(_)
            if body.most(interaction.asymmetry()) > SYMMETRIC =>
        {
            row_bound(body, interaction)
        }
        Layout::Grid(_) | Layout::Cloud(_) | Layout::Several(_) => {
            largest_eigenvalue(body, interaction)
        }
    };
    Ok(lambda)
}

/// Largest stable step of velocity Verlet at a largest eigenvalue (time); ∞ if nothing resists.
pub(super) fn step(lambda: f64) -> f64 {
    if lambda > 0.0 {
        2.0 / lambda.sqrt()
    } else {
        f64::INFINITY
    }
}
