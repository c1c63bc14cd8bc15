//! Conductances of points in contact.

/// Pairs in contact and what they conduct; points by their places.
///
/// A pair conducts `g_ij = h_c A_ij` with `A_ij = ½ A_i A_j (1/S_i + 1/S_j)`, `A_i` the face of a point and `S_i = Σ_k A_k` over
/// the points that it touches: each point shares its own face among those, so that `Σ A_ij` is the mean of the areas of both sides that touch,
/// however many pairs there are. Two flat faces at uniform temperatures exchange `h_c A ΔT` (the definition of h_c: Incropera &
/// DeWitt, Fundamentals of Heat and Mass Transfer, section 3.1.4).
#[derive(Debug, Clone, Default)]
pub struct Touching {
    pairs: Vec<(u32, u32, f64)>,
    /// Σ_j g_ij; empty: nothing was ever in contact.
    total: Vec<f64>,
}

impl Touching {
    /// Of pairs in contact, with a contact conductance (power / area / temperature) and the face (area) of every point.
    pub fn set(&mut self, conductance: f64, pairs: &[(u32, u32)], face: impl Fn(usize) -> f64) {
        let points = self.total.len();
        let mut touched = vec![0.0; points];
        for (i, j) in pairs {
            let (i, j) = (*i as usize, *j as usize);
            touched[i] += face(j);
            touched[j] += face(i);
        }
        self.total.fill(0.0);
        self.pairs.clear();
        for (i, j) in pairs {
            let (a, b) = (*i as usize, *j as usize);
            let area = 0.5 * face(a) * face(b) * (1.0 / touched[a] + 1.0 / touched[b]);
            let g = conductance * area;
            self.total[a] += g;
            self.total[b] += g;
            self.pairs.push((*i, *j, g));
        }
    }

    pub fn resize(&mut self, points: usize) {
        self.total.resize(points, 0.0);
    }

    /// Σ_j g_ij of a point.
    pub fn total(&self, point: usize) -> f64 {
        self.total.get(point).copied().unwrap_or(0.0)
    }

    /// Adds what comes into every point: what one end gets is what the other gives, to the last bit. Returns the sum from the warmer to the
    /// colder end of every pair (power).
    pub fn flow(&self, value: &[f64], into: &mut [f64]) -> f64 {
        let mut sum = 0.0;
        for (i, j, g) in &self.pairs {
            let (i, j) = (*i as usize, *j as usize);
            let power = g * (value[j] - value[i]);
            into[i] += power;
            into[j] -= power;
            sum += power.abs();
        }
        sum
    }

    pub fn bytes(&self) -> usize {
        16 * self.pairs.capacity() + 8 * self.total.len()
    }
}
