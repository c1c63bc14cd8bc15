//! What acts between surfaces that touch.

use crate::deck::units::Dim;
use crate::deck::value::Number;
use schemars::JsonSchema;
use serde::Deserialize;

/// Friction that falls from rest to sliding, `μ = kinetic + (static − kinetic) exp(−v/speed)` at a sliding speed v.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coefficient of fast sliding, a number or an expression of t.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub kinetic: Number,
    /// Coefficient at rest, a number or an expression of t; kinetic when left out.
    #[serde(rename = "static")]
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub at_rest: Option<Number>,
    /// Speed at which the difference is 1/e of that at rest; goes with static.
    #[schemars(extend("dimension" = Dim::VELOCITY.name()))]
    pub speed: Option<Number>,
}

/// What pulls points that are near. Of a rigid surface a traction of `27/4 strength s (1 − s)²` at a gap of s times its range 16 energy/(9 strength);
/// between bodies of points central forces that fall to nothing over a range of about 4 energy/strength.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cohesion {
    /// Work of adhesion: energy per area that pulling off takes.
    #[schemars(extend("dimension" = Dim::FRACTURE_ENERGY.name()))]
    pub energy: Number,
    /// Greatest traction of a rigid surface, whose range is then at most the spacing of the points; of bodies that of faces that touch, whose range is
    /// then 2 to 20 times their distance.
    #[schemars(extend("dimension" = Dim::PRESSURE.name()))]
    pub strength: Number,
}
