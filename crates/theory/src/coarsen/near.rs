//! Which of some points lie near a place: cells, periodic where the body is.

use std::collections::HashMap;

pub(super) struct Near<const D: usize> {
    position: Vec<[f64; D]>,
    period: [Option<f64>; D],
    size: [f64; D],
    /// Cells per period.
    cells: [Option<i64>; D],
    members: HashMap<[i64; D], Vec<u32>>,
}

impl<const D: usize> Near<D> {
    pub fn new(size: f64, period: [Option<f64>; D]) -> Near<D> {
        let cells = period.map(|p| p.map(|p| ((p / size).floor() as i64).max(1)));
        let size = std::array::from_fn(|a| match (period[a], cells[a]) {
            (Some(p), Some(n)) => p / n as f64,
            _ => size,
        });
        Near {
            position: vec![],
            period,
            size,
            cells,
            members: HashMap::new(),
        }
    }

    pub fn of(
        points: impl Iterator<Item = [f64; D]>,
        size: f64,
        period: [Option<f64>; D],
    ) -> Near<D> {
        let mut near = Near::new(size, period);
        points.for_each(|x| near.push(x));
        near
    }

    fn cell(&self, x: [f64; D]) -> [i64; D] {
        std::array::from_fn(|a| {
            let c = (x[a] / self.size[a]).floor() as i64;
            self.cells[a].map_or(c, |n| c.rem_euclid(n))
        })
    }

    /// Adds a point, numbered in the order of adding.
    pub fn push(&mut self, x: [f64; D]) {
        let n = self.position.len() as u32;
        self.position.push(x);
        self.members.entry(self.cell(x)).or_default().push(n);
    }

    /// From `x` to point `k`, the nearest image.
    pub fn xi(&self, x: [f64; D], k: u32) -> [f64; D] {
        std::array::from_fn(|a| {
            let d = self.position[k as usize][a] - x[a];
            self.period[a].map_or(d, |p| d - p * (d / p).round())
        })
    }

    /// Points within `radius` (closed), ascending, with the vectors to them.
    pub fn within(&self, x: [f64; D], radius: f64) -> Vec<(u32, [f64; D])> {
        let home = self.cell(x);
        let reach: [i64; D] = std::array::from_fn(|a| (radius / self.size[a]).ceil() as i64);
        // no cell of a period twice
        let wide: [i64; D] = std::array::from_fn(|a| {
            self.cells[a].map_or(2 * reach[a] + 1, |n| n.min(2 * reach[a] + 1))
        });
        let mut found = vec![];
        for k in 0..wide.iter().product::<i64>() {
            let mut rest = k;
            let cell = std::array::from_fn(|a| {
                let c = home[a] - reach[a] + rest % wide[a];
                rest /= wide[a];
                self.cells[a].map_or(c, |n| c.rem_euclid(n))
            });
            for &k in self.members.get(&cell).into_iter().flatten() {
                let xi = self.xi(x, k);
                if inside(&xi, radius) {
                    found.push((k, xi));
                }
            }
        }
        found.sort_unstable_by_key(|f| f.0);
        found
    }
}

/// Is a point at `xi` in a closed ball? Round-off decides nothing.
pub(super) fn inside<const D: usize>(xi: &[f64; D], radius: f64) -> bool {
    xi.iter().map(|x| x * x).sum::<f64>() <= radius * radius * (1.0 + 4e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_find_what_a_search_over_all_finds() {
        let points: Vec<[f64; 2]> = (0..200)
            .map(|k| [f64::from(k * 37 % 101) * 0.1, f64::from(k * 53 % 97) * 0.1])
            .collect();
        for (period, size) in [
            ([None, None], 1.3),
            ([Some(10.1), None], 2.0),
            ([Some(10.1), Some(9.7)], 7.0),
        ] {
            let near = Near::of(points.iter().copied(), size, period);
            for x in [[0.05, 0.0], [5.0, 9.6]] {
                for radius in [0.4, 2.5, 4.8] {
                    let found: Vec<u32> = near.within(x, radius).iter().map(|f| f.0).collect();
                    let all: Vec<u32> = (0..200)
                        .filter(|k| inside(&near.xi(x, *k), radius))
                        .collect();
                    assert_eq!(found, all, "{period:?} {x:?} {radius}");
                }
            }
        }
    }
}
