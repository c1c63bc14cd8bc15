//! Points that no stepper moves: they stay where they are with the velocity they have (LAMMPS's atoms without
//! `fix nve`).

use super::prescribed::Prescribed;
use crate::body::Field;

#[derive(Debug, Clone, Default)]
pub struct Still<const D: usize> {
    slots: Vec<u32>,
    /// Their velocities, while those of the field are 0.
    velocity: Vec<[f64; D]>,
}

impl<const D: usize> Still<D> {
    pub fn new(slots: Vec<u32>) -> Self {
        Still {
            velocity: vec![[0.0; D]; slots.len()],
            slots,
        }
    }
}

impl<const D: usize> Prescribed<D> for Still<D> {
    fn before_drift(
        &mut self,
        _: &Field<D>,
        v: &mut Field<D>,
        f: &mut Field<D>,
        _: [f64; 2],
        whole: bool,
    ) {
        for (kept, &s) in self.velocity.iter_mut().zip(&self.slots) {
            let i = s as usize;
            for a in 0..D {
                if whole {
                    kept[a] = v[a][i];
                }
                v[a][i] = 0.0;
                f[a][i] = 0.0;
            }
        }
    }

    /// No drift moved them.
    fn after_drift(&self, _: &mut Field<D>, _: [f64; 2]) {}

    fn whole_velocity(&self, v: &mut Field<D>, _: [f64; 2]) {
        for (kept, &s) in self.velocity.iter().zip(&self.slots) {
            for a in 0..D {
                v[a][s as usize] = kept[a];
            }
        }
    }

    fn each_held(&self, visit: &mut dyn FnMut(usize, usize)) {
        for s in &self.slots {
            (0..D).for_each(|a| visit(*s as usize, a));
        }
    }

    fn retain(&mut self, keep: &dyn Fn(u32) -> bool) {
        let mut kept = self.slots.iter().map(|s| keep(*s));
        self.velocity.retain(|_| kept.next().unwrap_or(false));
        self.slots.retain(|s| keep(*s));
    }
}
