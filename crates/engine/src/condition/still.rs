//! Points that no stepper moves: they stay where they are with the velocity they have (LAMMPS's atoms without
//! `fix nve`).

use crate::body::Field;

#[derive(Debug, Clone, Default)]
pub(crate) struct Still<const D: usize> {
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

    /// Points have the slots that `keep` holds for only, from now on.
    pub fn retain(&mut self, keep: impl Fn(u32) -> bool) {
        let mut kept = self.slots.iter().map(|s| keep(*s));
        self.velocity.retain(|_| kept.next().unwrap_or(false));
        self.slots.retain(|s| keep(*s));
    }

    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    /// Let the coming pass leave the points alone. `whole`: does `v` hold the velocities of the whole step?
    pub fn begin(&mut self, v: &mut Field<D>, f: &mut Field<D>, whole: bool) {
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

    /// Velocities of the whole step.
    pub fn settle(&self, v: &mut Field<D>) {
        for (kept, &s) in self.velocity.iter().zip(&self.slots) {
            for a in 0..D {
                v[a][s as usize] = kept[a];
            }
        }
    }
}
