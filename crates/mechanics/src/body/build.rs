//! Bodies from lattice sites and from clouds.

use super::grid::Ends;
use super::{Body, Exchange, Grid, Identity, Layout, Values};
use crate::error::BuildError;
use crate::execute::lane::TILE;
use crate::space::lattice::Lattice;

impl<const D: usize> Body<D> {
    /// A body on the sites of a lattice (`[N][3]` quarters of the cell's edges).
    ///
    /// Point ids follow the order of `quarters`. `reach` is the number of cells a bond spans; on `periodic` axes the
    /// period is the extent of the sites in whole cells. `volume` is per point.
    pub fn on_lattice(
        lattice: Lattice,
        quarters: &[[i32; 3]],
        reach: usize,
        periodic: [bool; D],
        volume: f64,
    ) -> Result<Self, BuildError> {
        if quarters.is_empty() {
            return Err(BuildError::empty("body", "the body has no points"));
        }
        let mut ends = Ends::none();
        quarters.iter().for_each(|q| ends.reach(*q));
        let mut grid = Grid::around(lattice, &ends, reach, periodic)?;
        if grid.slots() > u32::MAX as usize {
            return Err(BuildError::too_many(
                "body",
                format!("{} lattice slots are more than 2³² − 1", grid.slots()),
            ));
        }
        grid.owned = vec![0; grid.tiles()];
        let mut slots = Vec::with_capacity(quarters.len());
        for q in quarters {
            let Some((b, cell)) = grid.find(*q) else {
                return Err(BuildError::invalid(
                    "body",
                    format!("{q:?} quarters is not a site of the lattice"),
                ));
            };
            let i = b * grid.stride + cell;
            if grid.owned[i / TILE] >> (i % TILE) & 1 == 1 {
                return Err(BuildError::conflict(
                    "body",
                    format!("two points on one lattice site {q:?}"),
                ));
            }
            grid.owned[i / TILE] |= 1 << (i % TILE);
            slots.push((grid.guard + i) as u32);
        }
        grid.present = grid.owned.clone();
        let exchange = images(&mut grid);
        let period = grid.period(periodic);
        Ok(Self::of_grid(grid, slots, exchange, period, volume))
    }

    /// Points in these slots of a grid, all alike.
    pub(super) fn of_grid(
        grid: Grid<D>,
        slots: Vec<u32>,
        exchange: Exchange,
        period: [Option<f64>; D],
        volume: f64,
    ) -> Body<D> {
        let lattice = grid.lattice();
        Body {
            identity: Identity::new(),
            slots,
            len: grid.slots(),
            spacing: lattice.distance(),
            volume: Values::Uniform(volume),
            density: Values::Uniform(1.0),
            period,
            material: vec![],
            horizon: vec![],
            mark: vec![],
            exchange,
            subdomain: None,
            beside: vec![],
            layout: Layout::Grid(grid),
        }
    }

    /// A body of free points (`[N]` positions and volumes), stored in an order that keeps neighbours close.
    pub fn from_cloud(
        position: &[[f64; 3]],
        volume: &[f64],
        mark: &[i32],
        spacing: f64,
        period: [Option<f64>; D],
    ) -> Result<Self, BuildError> {
        let n = position.len();
        if n == 0 {
            return Err(BuildError::empty("body", "the body has no points"));
        }
        if let Some(i) = position
            .iter()
            .position(|x| x[..D].iter().any(|c| !c.is_finite()))
        {
            return Err(BuildError::invalid(
                "body",
                format!(
                    "the position of point {} is not finite: {:?}",
                    i + 1,
                    position[i]
                ),
            ));
        }
        if let Some(i) = volume.iter().position(|v| !(*v > 0.0 && v.is_finite())) {
            return Err(BuildError::invalid(
                "body",
                format!(
                    "the volume of point {} is {}, expected a positive number",
                    i + 1,
                    volume[i]
                ),
            ));
        }
        let order = spatial_order::<D>(position, spacing);
        let len = n.div_ceil(TILE) * TILE;
        let mut slots = vec![0u32; n];
        // absent slots of the last tile repeat the last point; their bonds are dead
        let mut x: [Vec<f64>; D] =
            crate::array::from_fn(|a| vec![position[*order.last().unwrap_or(&0) as usize][a]; len]);
        for (slot, &id) in order.iter().enumerate() {
            slots[id as usize] = slot as u32;
            for a in 0..D {
                x[a][slot] = position[id as usize][a];
            }
        }
        let volume = Values::from_points(volume, &slots, len, 0.0);
        Ok(Body {
            identity: Identity::new(),
            layout: Layout::Cloud(x),
            slots,
            len,
            spacing,
            volume,
            density: Values::Uniform(1.0),
            period,
            material: vec![],
            horizon: vec![],
            mark: mark.to_vec(),
            exchange: Exchange::default(),
            subdomain: None,
            beside: vec![],
        })
    }
}

impl<const D: usize> Body<D> {
    /// The same points (ids, volumes, densities, materials, marks, periods) as a cloud, for families that are lists.
    ///
    /// # Errors
    /// It is a part of a body, whose copies a cloud does not have.
    pub fn to_cloud(&self) -> Result<Self, BuildError> {
        if self.subdomain.is_some() {
            return Err(BuildError::unsupported(
                "ranks",
                "a part of a body is no cloud of its own",
            ));
        }
        let points = self.slots.iter().map(|s| *s as usize);
        let position: Vec<_> = points.clone().map(|s| self.position(s)).collect();
        let volume: Vec<_> = points.clone().map(|s| self.volume.at(s)).collect();
        let density: Vec<_> = points.clone().map(|s| self.density.at(s)).collect();
        let mut cloud =
            Body::from_cloud(&position, &volume, &self.mark, self.spacing, self.period)?;
        cloud.density = Values::from_points(&density, &cloud.slots, cloud.len, 1.0);
        if !self.material.is_empty() {
            cloud.give_materials(points.map(|s| self.material[s]));
        }
        Ok(cloud)
    }
}

/// Periodic images: every halo cell copies the cell one period away.
fn images<const D: usize>(grid: &mut Grid<D>) -> Exchange {
    let mut images = Exchange::default();
    if grid.halo == [0; D] {
        return images;
    }
    let count: usize = grid.cells.iter().product();
    for b in 0..grid.basis() {
        let first = grid.guard + b * grid.stride;
        for cell in 0..count {
            let from = grid.original(cell);
            if from != cell && grid.is_owned(first + from) {
                let k = first + cell - grid.guard;
                grid.present[k / TILE] |= 1 << (k % TILE);
                images.push(first + cell, first + from);
            }
        }
    }
    images
}

/// Ids sorted by the [cells](cell_of) of their points.
fn spatial_order<const D: usize>(position: &[[f64; 3]], spacing: f64) -> Vec<u32> {
    let mut order: Vec<(([i64; 3], u32),)> = position
        .iter()
        .enumerate()
        .map(|(i, x)| ((cell_of::<D>(x, spacing), i as u32),))
        .collect();
    order.sort_unstable();
    order.into_iter().map(|((_, i),)| i).collect()
}

/// The cell of a point among those that order a cloud, the last axis first: four spacings wide, in serpentine-free lexicographic order. Cells are those of
/// space, not of the body: the order of points, and so of the bonds of each, is the same in a part of a body as in the whole.
pub(super) fn cell_of<const D: usize>(x: &[f64; 3], spacing: f64) -> [i64; 3] {
    let mut cell = [0i64; 3];
    for a in 0..D {
        cell[2 - a] = (x[a] / (4.0 * spacing)).floor() as i64;
    }
    cell
}
