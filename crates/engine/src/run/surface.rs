//! Factors of bonds near a surface, put into a body and its interaction.

use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::interaction::Interaction;
use crate::law::BondFactors;
use crate::spec::{SurfaceFactor, SurfaceFactors};
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
        let mut row = vec![0u32; body.len()];
        for (slot, r) in body.slots().iter().zip(&surface.row) {
            row[*slot as usize] = *r;
        }
        body.exchange().fill(&mut row);
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
    let points = body.points();
    let rows = surface.rows.len();
    let fits = surface.row.len() == points
        && surface.part.len() == rows
        && surface.row.iter().all(|r| (*r as usize) < rows)
        && surface.part.iter().all(|p| *p > 0.0 && *p <= 1.0);
    let (true, Layout::Grid(_), Some(cell)) = (fits, body.layout(), body.volume().uniform()) else {
        return Err(BuildError::conflict(
            "surface",
            format!(
                "the factors of bonds are for {} points of {rows} kinds on a lattice, and do not fit this body of {points} points",
                surface.row.len()
            ),
        ));
    };
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
    if surface.ends_at_points() {
        let mut volume = vec![0.0; body.len()];
        body.set_points(&mut volume, |slot| cell * factors.part(slot));
        body.set_volumes(volume);
    }
    Ok(())
}

/// The factors of a block that has the corners of a body filling its box: the same distance from the nearest face along
/// every axis. `None` if the body does not fill its box.
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
    if full != body.points() as i64 {
        return None;
    }
    let mut row = vec![0u32; body.len()];
    for (slot, r) in body.slots().iter().zip(&surface.row) {
        row[*slot as usize] = *r;
    }
    let of = |slot: u32| {
        let (c, _) = small.cell(slot as usize);
        let there = crate::array::from_fn(|a| {
            let c = c[a] - small.halo()[a] as i64;
            let (n, m) = (own(whole, a), own(small, a));
            whole.halo()[a] as i64 + if 2 * c < m { c } else { n - m + c }
        });
        whole.slot(there, 0).map(|slot| row[slot])
    };
    Some(SurfaceFactors {
        row: block
            .slots()
            .iter()
            .map(|s| of(*s))
            .collect::<Option<Vec<_>>>()?,
        ..surface.clone()
    })
}
