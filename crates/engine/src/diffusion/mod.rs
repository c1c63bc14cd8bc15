//! What spreads through the bonds of the reference: heat, a species.
//!
//! `C_i dT_i/dt = Σ_j g_ij (T_j − T_i) + P_i`, with `g_ij = D k ω ν (1/m_i + 1/m_j) V_i V_j` (power / temperature),
//! `m_i = Σ_j ω ν |ξ|² V_j` over the family and `C_i = ρ c V_i`. It is the slope of the energy
//! `½ Σ_i V_i Σ_j (D k/m_i) ω ν (T_j − T_i)² V_j`: as for the bond-based conduction of Bobaru and Duangpanya (2010), with each end's own
//! weighted volume in place of that of a full ball, a linear field has the energy `½ k |∇T|²` at every point whose family is symmetric to
//! each plane through it, those of flat faces included, and inside the flux `k ∇T`. State-based models (Oterkus, Madenci & Agwai 2014)
//! come to the same for isotropic conduction. Points in contact conduct by [`Touching`].

mod account;
mod condition;
mod implicit;
mod places;
mod rows;
mod touching;

pub use account::DiffusionAccount;
pub use condition::Condition;
pub use places::Places;
pub use rows::{Conduction, Rows, Surface};
pub use touching::{Met, Touching};

use crate::body::Body;
use crate::error::SolveError;
use crate::execute::exact::Exact;
use crate::execute::for_each_piece;
use crate::spec::{DiffusionMethod, Quantity};
use crate::state::Archive;
use account::Gained;

/// A scalar on the points of a body, its bonds, and what is done to it.
#[derive(Debug, Clone)]
pub struct Diffusion {
    pub quantity: Quantity,
    pub method: DiffusionMethod,
    /// Do bonds that break in the run go on conducting?
    pub across_broken: bool,
    pub rows: Rows,
    /// What contact conducts now; `None`: contact conducts nothing.
    pub touching: Option<Touching>,
    pub conditions: Vec<Condition>,
    /// C_i (energy / temperature)
    capacity: Vec<f64>,
    held: Vec<bool>,
    held_places: Vec<u32>,
    /// Of all [`Places`].
    value: Vec<f64>,
    /// Since the start, by the points of this rank.
    gained: Gained,
    /// Values and account before the last step.
    before: (Vec<f64>, Gained),
    flow: Vec<f64>,
}

impl Diffusion {
    /// Passes values and account through an archive.
    pub fn archive<const D: usize>(
        &mut self,
        body: &Body<D>,
        places: &Places,
        archive: &mut Archive<'_>,
    ) {
        body.archive_points(archive, "values", (&mut self.value, 1), |slot, _| {
            places.at(slot)
        });
        archive.part("account", &mut self.gained);
        if archive.loads() {
            places.fill(body, &mut self.value);
        }
    }

    /// Values, of all places, and capacities stand in the order of the rows.
    pub fn new(
        quantity: Quantity,
        (method, across_broken): (DiffusionMethod, bool),
        rows: Rows,
        capacity: Vec<f64>,
        conditions: Vec<Condition>,
        value: Vec<f64>,
    ) -> Diffusion {
        let mut held = vec![false; capacity.len()];
        for i in conditions.iter().flat_map(Condition::holds) {
            held[*i as usize] = true;
        }
        let places = 0..held.len() as u32;
        Diffusion {
            quantity,
            method,
            across_broken,
            rows,
            touching: None,
            conditions,
            held_places: places.filter(|i| held[*i as usize]).collect(),
            held,
            before: (value.clone(), Gained::default()),
            flow: vec![0.0; capacity.len()],
            value,
            gained: Gained::default(),
            capacity,
        }
    }

    /// Contact conducts, too.
    pub fn with_contact(&mut self, touching: Touching) {
        self.touching = Some(touching);
    }

    pub fn values(&self) -> &[f64] {
        &self.value
    }

    /// New values of points that are here, from outside; the account begins anew with the next [`Diffusion::start`]. All ranks ask at once, as below.
    pub fn set_values<const D: usize>(&mut self, body: &Body<D>, places: &Places, value: &[f64]) {
        self.value[..value.len()].copy_from_slice(value);
        places.fill(body, &mut self.value);
    }

    /// Of all ranks.
    pub fn account<const D: usize>(&self, body: &Body<D>) -> DiffusionAccount {
        let Gained {
            initial,
            supplied,
            exchanged,
            held,
            made,
            through_contact,
        } = self.gained.clone();
        let all = [
            self.content(),
            initial,
            supplied,
            exchanged,
            held,
            made,
            through_contact,
        ];
        let [content, initial, supplied, exchanged, held, made, through] = body.sums(all);
        DiffusionAccount {
            content,
            initial,
            supplied,
            exchanged,
            held,
            made,
            through_contact: self.touching.as_ref().map(|_| through),
        }
    }

    /// Of the points that are here.
    fn content(&self) -> Exact {
        let each = self.capacity.iter().zip(&self.value);
        each.map(|(c, t)| c * t).collect()
    }

    /// Held values at time `t`, and an account from there on.
    pub fn start<const D: usize>(&mut self, body: &Body<D>, places: &Places, t: f64) {
        self.place(body, places, t);
        self.gained = Gained {
            initial: self.content(),
            ..Gained::default()
        };
    }

    /// Held values are those of time `t`.
    fn place<const D: usize>(&mut self, body: &Body<D>, places: &Places, t: f64) {
        for c in &self.conditions {
            c.place(&mut self.value, t);
        }
        places.fill(body, &mut self.value);
    }

    /// Slopes `−∂P/∂T` of what depends on values.
    fn slopes(&self, t: f64) -> Vec<f64> {
        let mut slope = vec![0.0; self.capacity.len()];
        for c in &self.conditions {
            c.add_slope(&self.value, t, &mut slope);
        }
        slope
    }

    /// The longest explicit step that makes no new extremes, `min C_i/(Σ_j g_ij − ∂P_i/∂T_i)` over the free points, with what touches among the j: at most the limit of
    /// stability `2/λ`, since `λ ≤ 2 max Σ_j g_ij/C_i` (Gershgorin). Infinite where nothing flows.
    pub fn stable_step<const D: usize>(&self, body: &Body<D>, t: f64) -> f64 {
        let mut slopes = self.slopes(t);
        if let Some(touching) = &self.touching {
            touching.add_totals(&mut slopes);
        }
        let each = self.capacity.iter().zip(self.rows.totals()).zip(&slopes);
        let own = each
            .zip(&self.held)
            .filter(|(((_, g), slope), held)| !**held && **g + **slope > 0.0)
            .map(|(((c, g), slope), _)| c / (g + slope))
            .fold(f64::INFINITY, f64::min);
        body.least(own)
    }

    /// From time `t` on for a time `dt`; in none nothing flows.
    ///
    /// # Errors
    /// Equations of implicit or steady values were not solved.
    pub fn advance<const D: usize>(
        &mut self,
        body: &Body<D>,
        places: &Places,
        t: f64,
        dt: f64,
    ) -> Result<(), SolveError> {
        match self.method {
            DiffusionMethod::Explicit { safety } => {
                let parts = (dt / (safety * self.stable_step(body, t))).ceil().max(1.0);
                let part = dt / parts;
                for n in 0..parts as u64 {
                    self.explicit((body, places), t + n as f64 * part, part);
                }
                Ok(())
            }
            DiffusionMethod::Implicit { .. } if dt == 0.0 => Ok(()),
            DiffusionMethod::Implicit { theta, tolerance } => {
                self.implicit((body, places), (t, dt), theta, tolerance)
            }
            DiffusionMethod::Steady { tolerance } => self.steady((body, places), t + dt, tolerance),
        }
    }

    /// Remembers where [`Diffusion::retreat`] goes back to.
    pub fn keep(&mut self) {
        self.before.0.copy_from_slice(&self.value);
        self.before.1.clone_from(&self.gained);
    }

    /// Gives points so much, by their places and values; held ones keep what they have.
    pub fn give<const D: usize>(
        &mut self,
        (body, places): (&Body<D>, &Places),
        each: impl Fn(usize, f64) -> f64,
    ) {
        for i in (0..self.capacity.len()).filter(|i| !self.held[*i]) {
            let given = each(i, self.value[i]);
            self.value[i] += given / self.capacity[i];
            self.gained.made.add(given);
        }
        places.fill(body, &mut self.value);
    }

    /// Warms points by so much each, by their places; held ones keep what they have.
    pub fn warm<const D: usize>(&mut self, (body, places): (&Body<D>, &Places), by: &[f64]) {
        for i in (0..self.capacity.len()).filter(|i| !self.held[*i]) {
            self.value[i] += by[i];
            self.gained.made.add(self.capacity[i] * by[i]);
        }
        places.fill(body, &mut self.value);
    }

    /// Back to where it was kept.
    pub fn retreat(&mut self) {
        self.value.copy_from_slice(&self.before.0);
        self.gained.clone_from(&self.before.1);
    }

    /// What comes into every point at its value now.
    fn powers<const D: usize>(&mut self, body: &Body<D>, t: f64, time: f64) {
        let value = &self.value;
        self.rows.flow(|i| value[i], &mut self.flow);
        if let Some(touching) = &self.touching {
            let power = touching.flow(body, |i| value[i], &mut self.flow);
            self.gained.through_contact.add(time * power);
        }
        for c in &self.conditions {
            c.add(value, (t, time), &mut self.flow, &mut self.gained);
        }
    }

    fn explicit<const D: usize>(&mut self, (body, places): (&Body<D>, &Places), t: f64, dt: f64) {
        self.powers(body, t, dt);
        let (flow, capacity, held) = (&self.flow, &self.capacity, &self.held);
        for_each_piece(&mut self.value[..capacity.len()], |first, piece| {
            for (n, value) in piece.iter_mut().enumerate() {
                let i = first + n;
                if !held[i] {
                    *value += dt / capacity[i] * flow[i];
                }
            }
        });
        let last: Vec<f64> = { self.held_places.iter() }
            .map(|i| self.value[*i as usize])
            .collect();
        self.place(body, places, t + dt);
        // what held points gain beyond that comes from who holds them
        for (i, last) in self.held_places.iter().zip(last) {
            let i = *i as usize;
            let gained = self.capacity[i] * (self.value[i] - last);
            self.gained.held.add(gained - dt * self.flow[i]);
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let touching = self.touching.as_ref().map_or(0, Touching::bytes);
        self.rows.bytes() + touching + 33 * self.value.len()
    }
}
