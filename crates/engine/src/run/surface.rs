//! Factors of bonds near a surface, put into a body and its interaction.

use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::interaction::Interaction;
use crate::law::BondFactors;
use crate::spec::{Spec, SurfaceFactor, SurfaceFactors};
use std::collections::HashMap;

/// Factors of the bonds of a body by its slots.
pub(super) struct Factors<'a, const D: usize> {
    surface: &'a SurfaceFactors,
    /// Which of the rows a slot has.
    row: Vec<u32>,
    table: Vec<HashMap<[i32; D], SurfaceFactor>>,
}

impl<'a, const D: usize> Factors<'a, D> {
    pub fn new(surface: &'a SurfaceFactors, body: &Body<D>) -> Factors<'a, D> {
        let ids = body.ids_of_all();
        let mut row = vec![0u32; body.len()];
        body.set_points(&mut row, |slot| surface.row[ids[slot] as usize]);
        let of_row = |bonds: &Vec<([i32; 3], SurfaceFactor)>| {
            let bonds = bonds.iter();
            bonds
                .map(|(o, x)| (crate::array::from_fn(|a| o[a]), *x))
                .collect()
        };
        Factors {
            surface,
            row,
            table: surface.rows.iter().map(of_row).collect(),
        }
    }

    /// Of the bond of a slot that leads so many cells away.
    pub fn of(&self, slot: usize, to: [i32; D]) -> SurfaceFactor {
        let row = &self.table[self.row[slot] as usize];
        row.get(&to).copied().unwrap_or(SurfaceFactor::ONE)
    }

    /// Part of its cell that the point of a slot holds.
    pub fn part(&self, slot: usize) -> f64 {
        self.surface.part[self.row[slot] as usize]
    }
}

/// Scale the bonds of `interaction`, made for whole cells, and give the points of `body` the part of their cells that
/// they hold. Call before [`Interaction::prepare`] and any sweep.
pub(super) fn scale<const D: usize>(
    surface: &SurfaceFactors,
    body: &mut Body<D>,
    interaction: &mut dyn Interaction<D>,
) -> Result<(), BuildError> {
    let (points, rows) = (body.all_points(), surface.rows.len());
    if !(fits(surface, body) && matches!(body.layout(), Layout::Grid(_))) {
        return Err(BuildError::conflict(
            "surface",
            format!(
                "the bond stiffness factors are for {} points of {rows} kinds on a lattice, and do not fit this body of {points} points",
                surface.row.len()
            ),
        ));
    }
    let factors = Factors::new(surface, body);
    interaction
        .scale_bonds(body, &|i, j, to| {
            let own = factors.of(i, to);
            let part = factors.part(i);
            BondFactors {
                pair: own.pair / part,
                own: own.share,
                other: factors.part(j) * factors.of(j, to.map(|c| -c)).share / part,
            }
        })
        .map_err(|e| e.at("surface"))?;
    end_at_points(surface, body);
    Ok(())
}

/// Are factors for as many points as a body has, whose cells are alike?
fn fits<const D: usize>(surface: &SurfaceFactors, body: &Body<D>) -> bool {
    let rows = surface.rows.len();
    surface.row.len() == body.all_points()
        && surface.part.len() == rows
        && surface.row.iter().all(|r| (*r as usize) < rows)
        && surface.part.iter().all(|p| *p > 0.0 && *p <= 1.0)
        && body.volume().uniform().is_some()
}

/// Points of a body that ends at its outermost ones get the part of their cells that they hold.
fn end_at_points<const D: usize>(surface: &SurfaceFactors, body: &mut Body<D>) {
    let cell = { body.volume().uniform() }.filter(|_| surface.ends_at_points());
    let Some(cell) = cell.filter(|_| fits(surface, body)) else {
        return;
    };
    let ids = body.ids_of_all();
    let part = |slot: usize| surface.part[surface.row[ids[slot] as usize] as usize];
    let mut volume = vec![0.0; body.len()];
    body.set_points(&mut volume, |slot| cell * part(slot));
    drop(ids);
    body.set_volumes(volume);
}

/// A whole body with the volumes that its points have once the bonds near its surfaces are [scaled](scale), which says of factors that do not fit;
/// `None`: it has them.
pub(super) fn ended<const D: usize>(spec: &Spec, body: &Body<D>) -> Option<Body<D>> {
    let surfaces = spec.body.pieces().iter().map(|p| p.surface.as_ref());
    let surfaces: Vec<_> = surfaces.chain([spec.bonds.surface.as_ref()]).collect();
    if !surfaces.iter().flatten().any(|s| s.ends_at_points()) {
        return None;
    }
    let mut body = body.clone();
    match &spec.bonds.surface {
        Some(surface) => end_at_points(surface, &mut body),
        None => {
            for (n, surface) in surfaces.iter().enumerate() {
                let Some(surface) = surface else { continue };
                body.change_piece(n, |piece| end_at_points(surface, piece));
            }
            body.join_volumes();
        }
    }
    Some(body)
}

/// The factors of a block that has the corners of a body filling its box: the same distance from the nearest face along
/// every axis. `None` if the body does not fill its box. All ranks ask at once.
pub(super) fn of_block<const D: usize>(
    surface: &SurfaceFactors,
    body: &Body<D>,
    block: &Body<D>,
) -> Option<SurfaceFactors> {
    let (Layout::Grid(whole), Layout::Grid(small)) = (body.layout(), block.layout()) else {
        return None;
    };
    let own = |grid: &crate::body::Grid<D>, a: usize| (grid.cells()[a] - 2 * grid.halo()[a]) as i64;
    let full: i64 = (0..D).map(|a| own(whole, a)).product();
    if full != body.all_points() as i64 {
        return None;
    }
    let ids = body.ids_of_all();
    let mut here = vec![false; body.len()];
    body.slots().iter().for_each(|s| here[*s as usize] = true);
    let of = |slot: u32| {
        let (c, _) = small.cell(slot as usize);
        let there = crate::array::from_fn(|a| {
            let c = c[a] - small.halo()[a] as i64;
            let (n, m) = (own(whole, a), own(small, a));
            whole.halo()[a] as i64 + if 2 * c < m { c } else { n - m + c }
        });
        let slot = whole.slot(there, 0).filter(|slot| here[*slot])?;
        Some(surface.row[ids[slot] as usize])
    };
    // each is of a point that one of the ranks has
    let own = block.slots().iter().enumerate();
    let own: Vec<[u32; 2]> = own.filter_map(|(n, s)| Some([n as u32, of(*s)?])).collect();
    let found = body.all_of(&own).concat();
    let mut row = vec![0; block.points()];
    found.iter().for_each(|[n, r]| row[*n as usize] = *r);
    (found.len() == row.len()).then(|| SurfaceFactors {
        row,
        ..surface.clone()
    })
}
