//! Forces between the points of a coarse body per relative displacement, `K_ij = V_i C_ij`.

use super::block::{Block, add, scaled, transposed, zero};
use peridyne::spec::LinearBody;

/// Rows of partners, ascending, by number in the coarse body.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Coupling<const D: usize> {
    pub rows: Vec<Vec<(u32, Block<D>)>>,
}

impl<const D: usize> Coupling<D> {
    /// From rows that name partners by their number in the body below, in any order.
    pub fn new(retained: &[u32], mut rows: Vec<Vec<(u32, Block<D>)>>) -> Coupling<D> {
        for row in &mut rows {
            row.sort_unstable_by_key(|r| r.0);
            for (p, _) in row.iter_mut() {
                *p = retained.partition_point(|r| r < p) as u32;
            }
        }
        Coupling { rows }
    }

    fn get(&self, i: usize, j: usize) -> Option<&Block<D>> {
        let row = &self.rows[i];
        let k = row.binary_search_by_key(&(j as u32), |r| r.0).ok()?;
        Some(&row[k].1)
    }

    /// `K_ij ← ½ (K_ij + K_jiᵀ)`
    pub fn symmetrised(&self) -> Coupling<D> {
        let mut rows: Vec<Vec<(u32, Block<D>)>> = vec![vec![]; self.rows.len()];
        for (i, row) in self.rows.iter().enumerate() {
            for (j, k) in row {
                let other = self.get(*j as usize, i);
                // from the lower end, or by the end that alone knows the other
                if (*j as usize) < i && other.is_some() {
                    continue;
                }
                let mut mean = scaled(0.5, k);
                add(
                    &mut mean,
                    &scaled(0.5, &transposed(other.unwrap_or(&zero()))),
                );
                rows[i].push((*j, mean));
                rows[*j as usize].push((i as u32, transposed(&mean)));
            }
        }
        for row in &mut rows {
            row.sort_unstable_by_key(|r| r.0);
        }
        Coupling { rows }
    }

    /// As a body of the points, with the volumes of that body.
    pub fn body(
        &self,
        below: &LinearBody<D>,
        retained: &[u32],
        volume: Vec<f64>,
        mass: &[f64],
    ) -> LinearBody<D> {
        let mut body = LinearBody {
            position: retained
                .iter()
                .map(|i| below.position[*i as usize])
                .collect(),
            density: mass.iter().zip(&volume).map(|(m, v)| m / v).collect(),
            volume,
            period: below.period,
            start: vec![0],
            partner: vec![],
            block: vec![],
            load_map: None,
            mass: None,
        };
        for (row, v) in self.rows.iter().zip(&body.volume) {
            for (j, k) in row {
                body.partner.push(*j);
                body.block.push(scaled(1.0 / v, k));
            }
            body.start.push(body.partner.len());
        }
        body
    }
}
