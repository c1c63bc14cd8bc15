//! The inertia of a coarse body: retained points carry removed ones, which move with them.
//!
//! `T = ½ Σ m_p |v_p|²` with `v_p = Σ_q S_pq v_q` gives `M = Sᵀ M⁰ S`, the mass that is consistent with the condensed stiffness (Guyan 1965).
//! Its frequencies are Rayleigh quotients of shapes that are in static equilibrium: they come from above. Lumped masses on the same
//! stiffness come from below. On a chain both errors are the same to the leading order in the wave number, so that half of each has none
//! of it: `ω² = K¹/(½ M_lumped + ½ Sᵀ M⁰ S)`. Shapes that balls cut off have less of it than exact ones; in the interior of a lattice the
//! part is that with which a wave of 50 coarse spacings has the frequency that it has in the body below, elsewhere half (measured in `papers/silling2010/beyond-motion`; K. Kim 1993, A review of mass matrices for
//! eigenproblems, Comput. Struct. 46, 1041, has the same of finite elements).

use super::balls::Task;
use super::block::{Block, add, add_product, scaled, transposed, unit};
use super::shapes::Shapes;
use super::waves;
use peridyne::spec::{LinearBody, MassMatrix};

/// What moves with a retained point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Mass {
    /// Its own mass and shares of those around: statics needs no other.
    #[default]
    Lumped,
    /// `Sᵀ M⁰ S`.
    Consistent,
    /// So much of each that long waves are right: half where shapes are exact.
    Blend,
}

/// Part of the shapes' mass where the body does not say.
const HALF: f64 = 0.5;

/// The mass matrix of a coarse body; `None`: lumped, or there are points without mass.
pub(super) fn matrix<const D: usize>(
    task: &Task<D>,
    shapes: Option<Shapes<D>>,
    coarse: &LinearBody<D>,
    mass: Mass,
) -> Option<MassMatrix<D>> {
    let lumped = &coarse.masses();
    if mass == Mass::Lumped {
        return None;
    }
    if !lumped.iter().all(|m| *m > 0.0) {
        return None;
    }
    let mut shapes = shapes?;
    shapes.carry_translations();
    let body = task.body;
    let consistent = shapes.galerkin(lumped.len(), |p, s, force| match &body.mass {
        None => {
            let own = body.volume[p as usize] * body.density[p as usize];
            add(force.at(p), &scaled(own, s));
        }
        Some(below) => {
            let (partners, blocks) = below.row(p as usize);
            for (&j, m) in partners.iter().zip(blocks) {
                add_product(force.at(j), &transposed(m), s);
            }
        }
    });
    let whole = mixed(&consistent, lumped, 1.0);
    if mass == Mass::Consistent {
        return Some(whole);
    }
    let carried = LinearBody {
        mass: Some(whole),
        ..coarse.clone()
    };
    let part = waves::part(body, [coarse, &carried]).unwrap_or(HALF);
    Some(mixed(&consistent, lumped, part))
}

/// So much of the shapes' mass, and the rest lumped.
fn mixed<const D: usize>(
    consistent: &[Vec<(u32, Block<D>)>],
    lumped: &[f64],
    part: f64,
) -> MassMatrix<D> {
    let mut made = MassMatrix {
        start: vec![0],
        partner: vec![],
        block: vec![],
    };
    for (k, row) in consistent.iter().enumerate() {
        for (q, m) in row {
            // sums have another order from the other end
            let back = &consistent[*q as usize];
            let back = back.binary_search_by_key(&(k as u32), |r| r.0);
            let back = back.map_or(*m, |at| transposed(&consistent[*q as usize][at].1));
            let mut mean: Block<D> = scaled(0.5 * part, m);
            add(&mut mean, &scaled(0.5 * part, &back));
            if *q as usize == k {
                add(&mut mean, &scaled((1.0 - part) * lumped[k], &unit()));
            }
            made.partner.push(*q);
            made.block.push(mean);
        }
        made.start.push(made.partner.len());
    }
    made
}
