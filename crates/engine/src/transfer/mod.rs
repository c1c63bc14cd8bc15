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
mod rows;
mod touching;

pub use account::TransferAccount;
pub use condition::Condition;
pub use rows::{Conduction, Rows, Surface};
pub use touching::Touching;

use crate::error::SolveError;
use crate::execute::for_each_piece;
use crate::spec::{Quantity, TransferMethod};
use crate::state::{Archive, Owner};

/// A scalar on the points of a body, its bonds, and what is done to it.
#[derive(Debug, Clone)]
pub struct Transfer {
    pub quantity: Quantity,
    pub method: TransferMethod,
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
    value: Vec<f64>,
    account: TransferAccount,
    /// Values and account before the last step.
    before: (Vec<f64>, TransferAccount),
    flow: Vec<f64>,
}

impl Owner for Transfer {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.all("values", &mut self.value);
        archive.one("account", &mut self.account);
    }
}

impl Transfer {
    /// Values and capacities stand in the order of the rows.
    pub fn new(
        quantity: Quantity,
        (method, across_broken): (TransferMethod, bool),
        rows: Rows,
        capacity: Vec<f64>,
        conditions: Vec<Condition>,
        value: Vec<f64>,
    ) -> Transfer {
        let mut held = vec![false; value.len()];
        for i in conditions.iter().flat_map(Condition::holds) {
            held[*i as usize] = true;
        }
        let places = 0..held.len() as u32;
        Transfer {
            quantity,
            method,
            across_broken,
            rows,
            touching: None,
            conditions,
            capacity,
            held_places: places.filter(|i| held[*i as usize]).collect(),
            held,
            before: (value.clone(), TransferAccount::default()),
            flow: vec![0.0; value.len()],
            value,
            account: TransferAccount::default(),
        }
    }

    /// Contact conducts, too.
    pub fn with_contact(&mut self, touching: Touching) {
        self.touching = Some(touching);
        self.account.through_contact = Some(0.0);
    }

    pub fn values(&self) -> &[f64] {
        &self.value
    }

    /// New values from outside; the account begins anew with the next [`Transfer::start`].
    pub fn set_values(&mut self, value: &[f64]) {
        self.value.copy_from_slice(value);
    }

    pub fn account(&self) -> TransferAccount {
        TransferAccount {
            content: self.content(),
            ..self.account
        }
    }

    fn content(&self) -> f64 {
        let each = self.capacity.iter().zip(&self.value);
        each.map(|(c, t)| c * t).sum()
    }

    /// Held values at time `t`, and an account from there on.
    pub fn start(&mut self, t: f64) {
        for c in &self.conditions {
            c.place(&mut self.value, t);
        }
        self.account = TransferAccount {
            initial: self.content(),
            through_contact: self.touching.as_ref().map(|_| 0.0),
            ..TransferAccount::default()
        };
    }

    /// Slopes `−∂P/∂T` of what depends on values.
    fn slopes(&self, t: f64) -> Vec<f64> {
        let mut slope = vec![0.0; self.value.len()];
        for c in &self.conditions {
            c.add_slope(&self.value, t, &mut slope);
        }
        slope
    }

    /// The longest explicit step that makes no new extremes, `min C_i/(Σ_j g_ij − ∂P_i/∂T_i)` over the free points, with what touches among the j: at most the limit of
    /// stability `2/λ`, since `λ ≤ 2 max Σ_j g_ij/C_i` (Gershgorin). Infinite where nothing flows.
    pub fn stable_step(&self, t: f64) -> f64 {
        let mut slopes = self.slopes(t);
        if let Some(touching) = &self.touching {
            touching.add_totals(&mut slopes);
        }
        let each = self.capacity.iter().zip(self.rows.totals()).zip(&slopes);
        each.zip(&self.held)
            .filter(|(((_, g), slope), held)| !**held && **g + **slope > 0.0)
            .map(|(((c, g), slope), _)| c / (g + slope))
            .fold(f64::INFINITY, f64::min)
    }

    /// From time `t` on for a time `dt`; in none nothing flows.
    ///
    /// # Errors
    /// Equations of implicit or steady values were not solved.
    pub fn advance(&mut self, t: f64, dt: f64) -> Result<(), SolveError> {
        match self.method {
            TransferMethod::Explicit { safety } => {
                let parts = (dt / (safety * self.stable_step(t))).ceil().max(1.0);
                let part = dt / parts;
                for n in 0..parts as u64 {
                    self.explicit(t + n as f64 * part, part);
                }
                Ok(())
            }
            TransferMethod::Implicit { .. } if dt == 0.0 => Ok(()),
            TransferMethod::Implicit { theta, tolerance } => {
                self.implicit((t, dt), theta, tolerance)
            }
            TransferMethod::Steady { tolerance } => self.steady(t + dt, tolerance),
        }
    }

    /// Remembers where [`Transfer::retreat`] goes back to.
    pub fn keep(&mut self) {
        self.before.0.copy_from_slice(&self.value);
        self.before.1 = self.account;
    }

    /// Gives points so much, by their places and values; held ones keep what they have.
    pub fn give(&mut self, each: impl Fn(usize, f64) -> f64) {
        for i in (0..self.value.len()).filter(|i| !self.held[*i]) {
            let given = each(i, self.value[i]);
            self.value[i] += given / self.capacity[i];
            self.account.made += given;
        }
    }

    /// Warms points by so much each, by their places; held ones keep what they have.
    pub fn warm(&mut self, by: &[f64]) {
        for i in (0..self.value.len()).filter(|i| !self.held[*i]) {
            self.value[i] += by[i];
            self.account.made += self.capacity[i] * by[i];
        }
    }

    /// Back to where it was kept.
    pub fn retreat(&mut self) {
        self.value.copy_from_slice(&self.before.0);
        self.account = self.before.1;
    }

    /// What comes into every point at its value now.
    fn powers(&mut self, t: f64, time: f64) {
        let value = &self.value;
        self.rows.flow(|i| value[i], &mut self.flow);
        if let Some(touching) = &self.touching {
            let power = touching.flow(|i| value[i], &mut self.flow);
            self.account.through_contact =
                { self.account.through_contact }.map(|w| w + time * power);
        }
        for c in &self.conditions {
            c.add(value, (t, time), &mut self.flow, None, &mut self.account);
        }
    }

    fn explicit(&mut self, t: f64, dt: f64) {
        self.powers(t, dt);
        let (flow, capacity, held) = (&self.flow, &self.capacity, &self.held);
        for_each_piece(&mut self.value, |first, piece| {
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
        for c in &self.conditions {
            c.place(&mut self.value, t + dt);
        }
        // what held points gain beyond that comes from who holds them
        for (i, last) in self.held_places.iter().zip(last) {
            let i = *i as usize;
            self.account.held += self.capacity[i] * (self.value[i] - last) - dt * self.flow[i];
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let touching = self.touching.as_ref().map_or(0, Touching::bytes);
        self.rows.bytes() + touching + 33 * self.value.len()
    }
}
