//! What acts between surfaces that touch.

use crate::deck::quantity::{FractureEnergy, Positive, Pressure, Velocity};
use crate::deck::value::Quantity;
use schemars::JsonSchema;
use serde::Deserialize;

/// Friction that falls from rest to sliding, `μ = kinetic + (static − kinetic) exp(−v/speed)` at a sliding speed v.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coefficient of fast sliding, a number or an expression of t.
    pub kinetic: Quantity<Positive>,
    /// Coefficient at rest, a number or an expression of t; kinetic by default.
    #[serde(rename = "static")]
    pub at_rest: Option<Quantity<Positive>>,
    /// Speed at which the difference is 1/e of that at rest; goes with static.
    pub speed: Option<Quantity<Positive<Velocity>>>,
}

/// What pulls points that are near. Of a rigid surface a traction of `27/4 strength s (1 − s)²` at a gap of s times its range 16 energy/(9 strength);
/// between bodies of points central forces that fall to nothing over a range of about 4 energy/strength.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cohesion {
    /// Work of adhesion: energy per area that pulling off takes.
    pub energy: Quantity<Positive<FractureEnergy>>,
    /// Greatest traction of a rigid surface, whose range is then at most the spacing of the points; of bodies that of faces that touch, whose range is
    /// then 2 to 20 times their distance.
    pub strength: Quantity<Positive<Pressure>>,
}
