//! Conductances of points that touch.

/// Rounds in which faces are shared; the second shares what the first left over.
const ROUNDS: usize = 2;
/// Partners whose weights cover this part of a face take all of it.
const COVERED: f64 = 0.5;

/// A pair that touches, by the places of its points.
#[derive(Debug, Clone, Copy)]
struct Pair {
    ends: [u32; 2],
    /// Which body has which end.
    bodies: [u32; 2],
    /// w_ij
    weight: f64,
    /// g_ij (power / temperature)
    conductance: f64,
}

/// Pairs that touch, and what they conduct.
///
/// A pair conducts `g_ij = h_c A_ij`. Towards each other body a point has one face `A_i`, which it shares among those that it touches there: with
/// `l_i = A_i` at first, every round adds `l_i l_j w_ij / max(s_i, s_j, l_i/2, l_j/2)`, `s_i = Σ_k l_k w_ik`, to `A_ij` and takes it from l_i and l_j.
/// So `A_ij = A_ji`, `Σ_j A_ij ≤ A_i`, both faces of one lattice share all they have, and `A_ij` goes to 0 with `w_ij`. Two flat faces at
/// uniform temperatures exchange `h_c A ΔT` (the definition of h_c: Incropera & DeWitt, Fundamentals of Heat and Mass
/// Transfer, section 3.1.4).
#[derive(Debug, Clone)]
pub struct Touching {
    /// h_c (power / area / temperature)
    coefficient: f64,
    /// A_i (area)
    face: Vec<f64>,
    pairs: Vec<Pair>,
    left: Vec<f64>,
    sum: Vec<f64>,
    taken: Vec<f64>,
}

impl Touching {
    /// Of a contact conductance (power / area / temperature) and one face (area) of every point; nobody touches.
    pub fn new(coefficient: f64, face: Vec<f64>) -> Touching {
        let points = face.len();
        Touching {
            coefficient,
            face,
            pairs: vec![],
            left: vec![0.0; points],
            sum: vec![0.0; points],
            taken: vec![0.0; points],
        }
    }

    /// Nobody touches.
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Two points of these bodies touch with a weight from 0 to 1.
    pub fn add(&mut self, ends: [u32; 2], bodies: [u32; 2], weight: f64) {
        self.pairs.push(Pair {
            ends,
            bodies,
            weight,
            conductance: 0.0,
        });
    }

    /// What all that were added conduct. The same bits for the same order.
    pub fn share(&mut self) {
        // stable, so in the order in which they came
        self.pairs.sort_by_key(|p| p.bodies);
        for pairs in self.pairs.chunk_by_mut(|p, q| p.bodies == q.bodies) {
            for end in pairs.iter().flat_map(|p| p.ends) {
                self.left[end as usize] = self.face[end as usize];
            }
            for _ in 0..ROUNDS {
                for end in pairs.iter().flat_map(|p| p.ends) {
                    (self.sum[end as usize], self.taken[end as usize]) = (0.0, 0.0);
                }
                for p in pairs.iter() {
                    let [i, j] = p.ends.map(|e| e as usize);
                    self.sum[i] += self.left[j] * p.weight;
                    self.sum[j] += self.left[i] * p.weight;
                }
                for p in pairs.iter_mut() {
                    let [i, j] = p.ends.map(|e| e as usize);
                    let most = [i, j].map(|e| self.sum[e].max(COVERED * self.left[e]));
                    let most = most[0].max(most[1]);
                    if most > 0.0 {
                        let area = self.left[i] * self.left[j] * p.weight / most;
                        p.conductance += self.coefficient * area;
                        self.taken[i] += area;
                        self.taken[j] += area;
                    }
                }
                for end in pairs.iter().flat_map(|p| p.ends) {
                    let i = end as usize;
                    self.left[i] = (self.left[i] - self.taken[i]).max(0.0);
                    self.taken[i] = 0.0;
                }
            }
        }
    }

    /// Adds Σ_j g_ij of every point.
    pub fn add_totals(&self, into: &mut [f64]) {
        for p in &self.pairs {
            for end in p.ends {
                into[end as usize] += p.conductance;
            }
        }
    }

    /// Adds what comes into every point: what one end gets is what the other gives, to the last bit. Returns the sum from the warmer to the
    /// colder end of every pair (power).
    pub fn flow(&self, value: impl Fn(usize) -> f64, into: &mut [f64]) -> f64 {
        let mut sum = 0.0;
        for p in &self.pairs {
            let [i, j] = p.ends.map(|e| e as usize);
            let power = p.conductance * (value(j) - value(i));
            into[i] += power;
            into[j] -= power;
            sum += power.abs();
        }
        sum
    }

    pub fn bytes(&self) -> usize {
        size_of::<Pair>() * self.pairs.capacity() + 32 * self.face.len()
    }
}
