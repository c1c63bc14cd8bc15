//! What an observable may look at.

use crate::space::Point;

/// What a force evaluation sees of every point, in order of point id.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Observed {
    /// `[N]` strain energy densities of bonds (energy / volume).
    pub strain: Vec<f64>,
    /// `[N]` energy densities of repulsion, half of a pair's at either end (energy / volume).
    pub repulsion: Vec<f64>,
    /// `[N]` dilatations θ (–).
    pub dilatation: Vec<f64>,
    /// `[N]` weighted volume of whole bonds over that of the family, of state-based laws (–).
    pub whole: Vec<f64>,
}

/// A bond of the reference family, from one of its points.
#[derive(Debug, Clone, Copy)]
pub struct FamilyBond {
    /// Id of the point.
    pub id: usize,
    /// To the partner in the reference, and how far the partner has moved against the point (lengths).
    pub xi: Point,
    pub eta: Point,
    /// `ω ν`: influence function times volume fraction.
    pub weight: f64,
    /// Volume of the partner.
    pub volume: f64,
    pub whole: bool,
}

/// What a point gets from a partner.
#[derive(Debug, Clone, Copy)]
pub struct PointForce {
    /// Id of the point.
    pub id: usize,
    /// Id of the partner; through a periodic boundary it may be the same.
    pub partner: usize,
    /// To the partner now; of linear models in the reference (length).
    pub y: Point,
    /// Force density (force / volume).
    pub force: Point,
    /// What of it the energy of the point alone has for a slope: with the volume V_i of the point, `V_i own = ∂(W_i V_i)/∂x_partner`
    /// with the memory of the law held. `None`: the law has no potential, or terms of more than two points.
    pub own: Option<Point>,
}

/// The state of a model of any dimension, by point id. Components of axes beyond the dimension are 0.
pub trait State {
    /// 1, 2 or 3.
    fn dimension(&self) -> usize;
    fn points(&self) -> usize;
    /// Reference position (length).
    fn reference(&self, id: usize) -> Point;
    fn displacement(&self, id: usize) -> Point;
    fn velocity(&self, id: usize) -> Point;
    /// Of the last sweep with all that acts (force / volume).
    fn force_density(&self, id: usize) -> Point;
    fn volume(&self, id: usize) -> f64;
    fn density(&self, id: usize) -> f64;
    fn material(&self, id: usize) -> usize;
    fn mark(&self, id: usize) -> i32;
    /// Number of bodies side by side, 1 where nobody named any.
    fn bodies(&self) -> usize;
    /// Which of them.
    fn body(&self, id: usize) -> usize;
    /// Is it made of atoms, whose neighbours are those of now?
    fn is_atomic(&self) -> bool;
    /// Boltzmann's constant (energy / temperature).
    fn boltzmann(&self) -> f64;
    /// Energy densities and dilatations, those of contact included. Computed once for a state.
    fn energies(&mut self) -> &Observed;
    fn damage(&mut self) -> Vec<f64>;
    /// `½ ρ v·v` of each point; of masses that couple points `½ v·(M v)/V`.
    fn kinetic_energy_density(&mut self) -> Vec<f64>;
    /// Number of the fragment of each point, 0 is the largest.
    fn fragments(&mut self) -> Vec<u32>;
    /// Every bond of the reference family from each of its points, but for those that a pre-crack made absent.
    fn each_bond(&mut self, visit: &mut dyn FnMut(FamilyBond));
    /// Every force of a pair, seen from each of its points: bonds, repulsion inside families, contact. False: a law has no forces
    /// of single bonds.
    fn each_force(&mut self, visit: &mut dyn FnMut(PointForce)) -> bool;
}
