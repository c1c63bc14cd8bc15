//! Horizon lists: all pairs of a cloud that are within the horizon in the reference, stored.
//!
//! Eight points advance together, so bonds are kept in *lines*: line k of a slice of eight rows holds partner k of
//! each of them (sliced ELLPACK). Rows are the slots, sorted by family size within small windows: points of one
//! slice have families of nearly one size, and little of a line is padding. Four bytes and a bit per bond.

use crate::body::{Body, Identity, Layout};
use crate::error::BuildError;
use crate::execute::lane::TILE;
use crate::execute::memory;
use crate::message;
use crate::quantity::{Dimension, place, rounded};
use crate::space::AXES;
use crate::space::cells::Cells;
use rayon::prelude::*;
use std::ops::Range;

/// Rows that are sorted together: about one cell of the order in which a cloud is stored.
const WINDOW: usize = 64;

/// Partners of every point of a cloud.
#[derive(Debug, Clone)]
pub struct HorizonList {
    /// The body whose pairs these are.
    pub(crate) body: Identity,
    /// Slot of each row; every slot of the body has one, copies of other ranks' points excepted.
    pub(crate) rows: Vec<u32>,
    /// The first slot that has a row.
    first: usize,
    /// First line of each slice, and the end.
    pub(crate) start: Vec<usize>,
    /// `[lines][TILE]` slots; the row's own slot where there is no bond. Partners of a row ascend.
    pub(crate) partner: Vec<u32>,
    /// Directed bonds.
    pub(crate) directed: u64,
    /// Directed pairs within 1e-9 of the horizon, in or out: round-off decides about them.
    pub(crate) near_horizon: u64,
}

impl HorizonList {
    /// All pairs of a cloud body with `r0 ≤ horizon`, nearest images on periodic axes.
    ///
    /// A horizon of exactly m spacings on lattice sites should be passed times 1 + 1e-9, to include all of them.
    /// Refused: a period of at most two horizons, and points in one place.
    pub fn new<const D: usize>(body: &Body<D>, horizon: f64) -> Result<Self, BuildError> {
        Self::within(body, horizon, |_, _| horizon)
    }

    /// All pairs of slots i and j with `r0 ≤ of(i, j)`, which is at most `horizon`.
    pub fn within<const D: usize>(
        body: &Body<D>,
        horizon: f64,
        of: impl Fn(usize, usize) -> f64 + Sync,
    ) -> Result<Self, BuildError> {
        let Layout::Cloud(x) = &body.layout else {
            return Err(BuildError::unsupported(
                "family",
                "a horizon list needs a cloud of points, not a lattice body",
            )
            .help("convert the body with `to_cloud`"));
        };
        if !(horizon > 0.0 && horizon.is_finite()) {
            return Err(BuildError::invalid(
                "horizon",
                format!("the horizon is {horizon}, expected a positive length"),
            ));
        }
        for (a, period) in body.period.iter().enumerate() {
            if let Some(p) = period.filter(|p| *p <= 2.0 * horizon) {
                return Err(BuildError::conflict(
                    "periodic",
                    message![
                        format!("the period along {} is ", AXES[a]),
                        Dimension::LENGTH.of(p),
                        ", not more than two horizons of ",
                        Dimension::LENGTH.of(horizon),
                        ": a point would meet two images of the same partner",
                    ],
                )
                .help("make the body longer along this axis, or the horizon shorter"));
            }
        }
        let limit = |i: usize, j: u32| {
            let horizon = of(i, j as usize);
            horizon * horizon
        };
        let own = body.own_slots();
        let mut there: Vec<u32> = body.slots.clone();
        there.extend(body.exchange.copies().map(|s| s as u32));
        there.sort_unstable();
        let cells = Cells::new(
            crate::array::from_fn(|a| x[a].as_slice()),
            &there,
            body.period,
            horizon,
        );

        let counted = match body.len < 1 << 29 {
            true => count(&cells, body, horizon, &limit),
            // vector gathers count numbers of four-number records with 31 bits
            false => Err(BuildError::too_many(
                "body",
                format!("{} points are too many for a list (2²⁹)", body.len),
            )),
        };
        let laid = counted.and_then(|(size, near)| {
            let (rows, start) = lines(own.clone(), &size);
            affordable(&size, start[start.len() - 1], horizon, body.spacing)?;
            Ok((rows, start, size.iter().map(|s| *s as u64).sum(), near))
        });
        let (rows, start, directed, near) = match body.exchange.any(laid.is_err()) {
            true => laid.and(Err(BuildError::elsewhere(0)))?,
            false => laid?,
        };
        let lines = start[start.len() - 1];
        let mut list = HorizonList {
            body: body.identity,
            rows,
            first: own.start,
            start,
            partner: vec![0; lines * TILE],
            directed,
            near_horizon: near,
        };
        list.fill(&cells, own.start + body.points(), &limit);
        Ok(list)
    }

    /// Write the lines, slices in parallel; points end at a slot.
    fn fill<const D: usize>(
        &mut self,
        cells: &Cells<D>,
        end: usize,
        limit: &(impl Fn(usize, u32) -> f64 + Sync),
    ) {
        let mut slices = Vec::with_capacity(self.start.len() - 1);
        let mut partner = self.partner.as_mut_slice();
        for (slice, rows) in self.rows.chunks(TILE).enumerate() {
            let lines = self.start[slice + 1] - self.start[slice];
            let (p, rest) = partner.split_at_mut(lines * TILE);
            partner = rest;
            slices.push((rows, p));
        }
        slices
            .into_par_iter()
            .for_each_init(Vec::new, |family, (rows, partner)| {
                for (l, &i) in rows.iter().enumerate() {
                    family.clear();
                    if (i as usize) < end {
                        cells.candidates(i as usize, |j, square| {
                            if j != i && square <= limit(i as usize, j) {
                                family.push(j);
                            }
                        });
                    }
                    family.sort_unstable();
                    for (k, line) in partner.chunks_mut(TILE).enumerate() {
                        line[l] = *family.get(k).unwrap_or(&i);
                    }
                }
            });
    }

    /// Directed bonds.
    pub fn directed(&self) -> u64 {
        self.directed
    }

    /// Slot of each row; every slot of the body has one, copies of other ranks' points excepted.
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// Directed pairs within 1e-9 of the horizon, in or out.
    pub fn near_horizon(&self) -> u64 {
        self.near_horizon
    }

    /// Lines of all slices: bytes that a bit per bond takes.
    pub fn line_count(&self) -> usize {
        self.partner.len() / TILE
    }

    /// Number of slices of eight rows.
    pub fn slices(&self) -> usize {
        self.start.len() - 1
    }

    /// Row of a slot of the body.
    pub fn row(&self, slot: usize) -> usize {
        let first = (slot - self.first) / WINDOW * WINDOW;
        let is_slot = |s: &u32| *s as usize == slot;
        first + self.rows[first..].iter().position(is_slot).unwrap_or(0)
    }

    /// Lines of the slice of a row.
    pub fn lines(&self, row: usize) -> std::ops::Range<usize> {
        self.start[row / TILE]..self.start[row / TILE + 1]
    }

    /// `(line, slot)` of every partner of a row, in the row's order.
    pub fn partners(&self, row: usize) -> impl Iterator<Item = (usize, usize)> {
        let slot = self.rows[row];
        self.lines(row)
            .map(move |line| (line, self.partner[line * TILE + row % TILE]))
            .take_while(move |(_, j)| *j != slot)
            .map(|(line, j)| (line, j as usize))
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * self.rows.len() + 8 * self.start.len() + 4 * self.partner.len()
    }
}

/// Slots in the order of rows, by the sizes of their families, and where the lines of each slice begin and end.
fn lines(own: Range<usize>, size: &[u32]) -> (Vec<u32>, Vec<usize>) {
    let mut rows: Vec<u32> = own.map(|slot| slot as u32).collect();
    for window in rows.chunks_mut(WINDOW) {
        window.sort_by_key(|s| (std::cmp::Reverse(size[*s as usize]), *s));
    }
    let mut start = vec![0];
    for slice in rows.chunks(TILE) {
        let lines = slice.iter().map(|s| size[*s as usize]).max().unwrap_or(0);
        start.push(start[start.len() - 1] + lines as usize);
    }
    (rows, start)
}

/// Is there memory for so many lines?
fn affordable(size: &[u32], lines: usize, horizon: f64, spacing: f64) -> Result<(), BuildError> {
    memory::afford(
        "horizon",
        &format!(
            "{} bonds",
            rounded(size.iter().map(|s| f64::from(*s)).sum::<f64>(), 3)
        ),
        lines as f64 * (4 * TILE + 1) as f64,
        message![
            "the horizon ",
            Dimension::LENGTH.of(horizon),
            format!(
                " is {:.1} spacings: check its unit and its decimal point; three to six spacings are usual",
                horizon / spacing
            ),
        ],
    )
}

/// Family size of every slot, and the number of pairs at the horizon.
fn count<const D: usize>(
    cells: &Cells<D>,
    body: &Body<D>,
    horizon: f64,
    limit: &(impl Fn(usize, u32) -> f64 + Sync),
) -> Result<(Vec<u32>, u64), BuildError> {
    let mut size = vec![0u32; body.len];
    let first = body.own_slots().start;
    let near = size[first..first + body.points()]
        .par_iter_mut()
        .enumerate()
        .map(|(i, size)| {
            let i = first + i;
            let mut near = 0;
            let mut twin = None;
            cells.candidates(i, |j, square| {
                let (other, limit) = (j as usize != i, limit(i, j));
                *size += (square <= limit && other) as u32;
                near += (limit > 0.0 && (square - limit).abs() <= 2e-9 * limit) as u64;
                if square <= 1e-20 * horizon * horizon && other {
                    twin = Some((i, j as usize));
                }
            });
            match twin {
                Some(pair) => Err(pair),
                None => Ok(near),
            }
        })
        .try_reduce(|| 0, |a, b| Ok(a + b));
    match near {
        Ok(near) => Ok((size, near)),
        Err((i, j)) => {
            let (i_th, j_th) = (body.number(i), body.number(j));
            let (a, b) = (i_th.min(j_th), i_th.max(j_th));
            let p = body.position(i);
            Err(BuildError::conflict(
                "body",
                message![format!("points {a} and {b} are in one place, "), place(&p)],
            )
            .help("remove one of them: two points of a body must be apart"))
        }
    }
}
