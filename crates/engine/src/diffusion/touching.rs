//! Conductances of points that touch.
//!
//! Of a body that ranks share every rank knows all pairs, which are few, and what all points have that touch: what pairs conduct is found everywhere, in the order
//! of one process.

use super::Places;
use crate::body::Body;
use bytemuck::{Pod, Zeroable};

/// Rounds in which faces are shared; the second shares what the first left over.
const ROUNDS: usize = 2;
/// Partners whose weights cover this part of a face take all of it.
const COVERED: f64 = 0.5;

/// In place of a place of a point that another rank has.
const ELSEWHERE: u32 = u32::MAX;

/// A pair that touches, of a body that ranks share.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Met {
    /// Of its points among all, in the order of slots.
    pub order: [u64; 2],
    pub ids: [u32; 2],
    /// Which body has which end.
    pub bodies: [u32; 2],
    pub weight: f64,
}

// SAFETY, both: numbers without gaps between them, and all bits are some
unsafe impl Zeroable for Met {}
unsafe impl Pod for Met {}

/// Who touches on any rank, by number among these.
#[derive(Debug, Clone, Default)]
struct OfAll {
    /// Places of those that are here.
    places: Vec<u32>,
    /// These once more, in order of numbers, and the numbers of those of all ranks, one rank after the other.
    own: Vec<u32>,
    told: Vec<u32>,
}

/// A pair that touches, by the places of its points, or by their numbers.
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
    /// A_i (area), by place, and of those that touch on any rank by number.
    face: Vec<f64>,
    faces_of_all: Vec<f64>,
    of_all: Option<OfAll>,
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
            faces_of_all: vec![],
            of_all: None,
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

    /// The same of all pairs of a body that ranks share, of which each rank tells some: those that it counts. All ranks come here at once.
    pub fn share_among<const D: usize>(&mut self, body: &Body<D>, places: &Places, met: &[Met]) {
        let mut all = body.all_of(met).concat();
        all.sort_unstable_by_key(|m| m.order);
        let mut ids: Vec<u32> = all.iter().flat_map(|m| m.ids).collect();
        ids.sort_unstable();
        ids.dedup();
        let whose = body.whose();
        let place = |id: &u32| {
            whose
                .place(*id)
                .map(|n| places.at(body.slots()[n] as usize) as u32)
        };
        let here: Vec<u32> = ids
            .iter()
            .map(|id| place(id).unwrap_or(ELSEWHERE))
            .collect();
        let numbers = (0..here.len()).filter(|n| here[*n] != ELSEWHERE);
        let own: Vec<u32> = numbers.clone().map(|n| here[n]).collect();
        let each = numbers
            .zip(&own)
            .map(|(n, place)| [n as f64, self.face[*place as usize]]);
        let told = body.all_of(&each.collect::<Vec<_>>()).concat();
        self.faces_of_all = vec![0.0; ids.len()];
        told.iter()
            .for_each(|[n, face]| self.faces_of_all[*n as usize] = *face);
        for room in [&mut self.left, &mut self.sum, &mut self.taken] {
            room.resize(ids.len(), 0.0);
        }
        let number = |id: u32| ids.partition_point(|other| *other < id) as u32;
        self.pairs.clear();
        for m in &all {
            self.add(m.ids.map(number), m.bodies, m.weight);
        }
        self.of_all = Some(OfAll {
            places: here,
            own,
            told: told.iter().map(|[n, _]| *n as u32).collect(),
        });
        self.share();
    }

    /// What all that were added conduct. The same bits for the same order.
    pub fn share(&mut self) {
        let face = match &self.of_all {
            None => &self.face,
            Some(_) => &self.faces_of_all,
        };
        // stable, so in the order in which they came
        self.pairs.sort_by_key(|p| p.bodies);
        for pairs in self.pairs.chunk_by_mut(|p, q| p.bodies == q.bodies) {
            for end in pairs.iter().flat_map(|p| p.ends) {
                self.left[end as usize] = face[end as usize];
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

    /// Where an end lies, if it is here.
    fn place(&self, end: u32) -> Option<usize> {
        let place = match &self.of_all {
            None => end,
            Some(of) => of.places[end as usize],
        };
        (place != ELSEWHERE).then_some(place as usize)
    }

    /// Adds Σ_j g_ij of every point that is here.
    pub fn add_totals(&self, into: &mut [f64]) {
        for p in &self.pairs {
            for place in p.ends.iter().filter_map(|end| self.place(*end)) {
                into[place] += p.conductance;
            }
        }
    }

    /// Adds what comes into every point: what one end gets is what the other gives, to the last bit. Returns the sum from the warmer to the
    /// colder end of every pair (power), of all ranks on the first. All ranks come here at once.
    pub fn flow<const D: usize>(
        &self,
        body: &Body<D>,
        value: impl Fn(usize) -> f64,
        into: &mut [f64],
    ) -> f64 {
        let mut of_all = vec![];
        if let Some(of) = self.of_all.as_ref().filter(|of| !of.told.is_empty()) {
            let own: Vec<f64> = of.own.iter().map(|place| value(*place as usize)).collect();
            of_all.resize(of.places.len(), 0.0);
            for (n, value) in of.told.iter().zip(body.all_of(&own).concat()) {
                of_all[*n as usize] = value;
            }
        }
        let value = |end: u32| match of_all.get(end as usize) {
            None => value(end as usize),
            Some(value) => *value,
        };
        let mut sum = 0.0;
        for p in &self.pairs {
            let [i, j] = p.ends;
            let power = p.conductance * (value(j) - value(i));
            if let Some(place) = self.place(i) {
                into[place] += power;
            }
            if let Some(place) = self.place(j) {
                into[place] -= power;
            }
            sum += power.abs();
        }
        if body.is_first() { sum } else { 0.0 }
    }

    pub fn bytes(&self) -> usize {
        size_of::<Pair>() * self.pairs.capacity() + 32 * self.face.len()
    }
}
