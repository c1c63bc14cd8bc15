//! Values of points: from the slots that they lie in to the order of ids, and back.

use super::{Body, Field};
use crate::error::BuildError;
use crate::space::Point;

impl<const D: usize> Body<D> {
    /// What each point has, asked by its slot, in order of ids.
    pub fn by_id<T>(&self, value: impl Fn(usize) -> T) -> Vec<T> {
        self.slots.iter().map(|&s| value(s as usize)).collect()
    }

    /// Id of every slot of a point; 0 of the others.
    pub fn ids_by_slot(&self) -> Vec<u32> {
        let mut id = vec![0u32; self.len];
        for (n, &s) in self.slots.iter().enumerate() {
            id[s as usize] = n as u32;
        }
        id
    }

    /// Number of the point in a slot among those of all ranks, from 1 on; 0: there is none.
    pub fn number(&self, slot: usize) -> u64 {
        if let Some(of) = self.subdomain() {
            return u64::from(of.of_slots()[slot]) + 1;
        }
        let place = self.slots.iter().position(|s| *s as usize == slot);
        place.map_or(0, |i| i as u64 + 1)
    }

    /// `[N]` vectors of points.
    pub fn values(&self, field: &Field<D>) -> Vec<[f64; D]> {
        self.by_id(|i| crate::array::from_fn(|a| field[a][i]))
    }

    /// The same, padded to three components.
    pub fn vectors(&self, field: &Field<D>) -> Vec<Point> {
        self.by_id(|i| crate::array::from_fn(|a| if a < D { field[a][i] } else { 0.0 }))
    }

    /// `[N]` forces of force densities.
    pub fn per_point(&self, f: &Field<D>) -> Vec<[f64; D]> {
        self.by_id(|i| {
            let volume = self.volume.at(i);
            crate::array::from_fn(|a| volume * f[a][i])
        })
    }

    /// `[N]` reference positions.
    pub fn places(&self) -> Vec<[f64; D]> {
        self.by_id(|i| {
            let x = self.position(i);
            crate::array::from_fn(|a| x[a])
        })
    }

    /// What each point has, asked by its slot, where it lies and in its copies.
    pub fn set_points<T: bytemuck::Pod>(&self, column: &mut [T], value: impl Fn(usize) -> T) {
        for &s in &self.slots {
            column[s as usize] = value(s as usize);
        }
        self.exchange.fill(column);
    }

    /// The same of vectors, asked by id and slot.
    pub fn set_vectors(&self, field: &mut Field<D>, value: impl Fn(usize, usize) -> [f64; D]) {
        for (id, &s) in self.slots.iter().enumerate() {
            let of = value(id, s as usize);
            (0..D).for_each(|a| field[a][s as usize] = of[a]);
        }
        self.exchange.fill_field(field);
    }

    /// Puts vectors by id where their points lie.
    pub fn scatter(&self, field: &mut Field<D>, values: &[Point]) {
        for (x, &s) in values.iter().zip(&self.slots) {
            for a in 0..D {
                field[a][s as usize] = x[a];
            }
        }
    }

    /// Slots and reference positions of a set.
    ///
    /// # Errors
    /// There is no set of this name.
    pub fn slots_of(
        &self,
        set: &str,
        sets: &[(String, Vec<u32>)],
    ) -> Result<(Vec<u32>, Vec<Point>), BuildError> {
        let slots: Vec<u32> = if set == "all" {
            self.slots.clone()
        } else {
            let Some((_, ids)) = sets.iter().find(|(n, _)| n == set) else {
                return Err(BuildError::unknown(
                    "",
                    set,
                    format!("there is no set `{set}`"),
                ));
            };
            ids.iter().map(|id| self.slots[*id as usize]).collect()
        };
        let points = slots.iter().map(|s| self.position(*s as usize)).collect();
        Ok((slots, points))
    }
}
