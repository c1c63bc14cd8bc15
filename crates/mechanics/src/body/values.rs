//! A number per slot that is often the same everywhere.

#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    Uniform(f64),
    PerSlot(Vec<f64>),
}

impl Values {
    #[inline]
    pub fn at(&self, slot: usize) -> f64 {
        match self {
            Values::Uniform(v) => *v,
            Values::PerSlot(v) => v[slot],
        }
    }

    pub fn uniform(&self) -> Option<f64> {
        match self {
            Values::Uniform(v) => Some(*v),
            Values::PerSlot(_) => None,
        }
    }

    pub fn bytes(&self) -> usize {
        match self {
            Values::Uniform(_) => 0,
            Values::PerSlot(v) => v.len() * 8,
        }
    }

    /// From one value per point and the points' slots; uniform if they are all the same.
    pub fn from_points(values: &[f64], slots: &[u32], len: usize, absent: f64) -> Values {
        match values.first() {
            Some(&first) if values.iter().all(|v| *v == first) => Values::Uniform(first),
            _ => {
                let mut all = vec![absent; len];
                for (v, s) in values.iter().zip(slots) {
                    all[*s as usize] = *v;
                }
                Values::PerSlot(all)
            }
        }
    }
}
