//! What is seen of a run: snapshots of named fields, numbers over time.

/// The state of all points at one instant, for writers. Arrays are in order of point id (0-based here,
/// 1-based in files).
#[derive(Debug, Clone, Default)]
pub struct Snapshot {
    pub step: u64,
    pub time: f64,
    /// 1, 2 or 3; unused components are 0.
    pub dimension: usize,
    /// Typical distance of points (length).
    pub spacing: f64,
    /// `[N]` reference positions.
    pub reference: Vec<[f64; 3]>,
    /// `[N]` displacements.
    pub displacement: Vec<[f64; 3]>,
    /// `[N]` velocities.
    pub velocity: Vec<[f64; 3]>,
    /// `[N]` 1 − unbroken volume / family volume.
    pub damage: Vec<f64>,
    /// `[N]` dilatation θ.
    pub dilatation: Vec<f64>,
    /// `[N]` strain energy density.
    pub energy_density: Vec<f64>,
    /// `[N]` set mark or material index.
    pub mark: Vec<i32>,
    /// `[N]` which of several bodies; empty where there is one.
    pub body: Vec<u32>,
    /// `[N]` fragment numbers (0 is the largest), when asked for.
    pub fragment: Option<Vec<u32>>,
    /// Unbroken bonds `(i, j)`, i < j, when asked for.
    pub bonds: Option<Vec<(u32, u32)>>,
}

/// Energies (energy; volume-weighted sums) whose balance
/// `kinetic + strain + contact + released + dissipated − work = const` closes up to the error of the time step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Ledger {
    pub kinetic: f64,
    pub strain: f64,
    pub contact: f64,
    /// Energy stored in bonds at the moment they broke, summed since the start.
    pub released: f64,
    /// Work done by damping on its surroundings.
    pub dissipated: f64,
    /// Work done on the body by body forces, tractions and prescribed motion since the start.
    pub work_conditions: f64,
    /// Work done on the body by indenters since the start.
    pub work_indenter: f64,
    /// Energy at the start.
    pub initial: f64,
}

impl Ledger {
    /// What the balance misses: 0 in exact time.
    pub fn residual(&self) -> f64 {
        self.kinetic + self.strain + self.contact + self.released + self.dissipated
            - self.work_conditions
            - self.work_indenter
            - self.initial
    }
}
