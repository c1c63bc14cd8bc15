//! Solutions of the local laws, to compare with: along characteristics, by Cole and Hopf, of Riemann's problem, and the viscous shock.

mod characteristics;
mod cole_hopf;
mod primitive;
mod reference;
mod riemann;

pub use characteristics::{characteristics, shock_time, viscous_shock};
pub use cole_hopf::ColeHopf;
pub use primitive::Primitive;
pub use reference::{Reference, Solution};
pub use riemann::riemann;
