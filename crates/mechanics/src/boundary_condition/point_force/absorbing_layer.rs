//! A layer that waves run into and do not come back from: viscosity that grows toward the end of the body, slowly at first, so that the layer
//! itself reflects little (M. Israeli and S. A. Orszag 1981, Approximation of radiation boundary conditions, J. Comput. Phys. 41, 115–135).
//!
//! The profile is that of perfectly matched layers (F. Collino and C. Tsogka 2001, Application of the perfectly matched absorbing layer
//! model to the linear elastodynamic problem in anisotropic heterogeneous media, Geophysics 66, 294–307): at a depth d of a layer that is L
//! thick, `c(d) = (n + 1) ρ v ln(1/R)/L · (d/L)ⁿ`. A wave of speed v that is short beside L loses `∫ c/(2ρv)` of the logarithm of its
//! amplitude on its way to the end, and as much on its way back: R of it comes out again, R² of its energy. A layer that is viscous reflects
//! besides, at any depth, what is long beside it: of these waves more comes back.

use super::{Described, LocalForce, Placed, PointForce, Seen, Stiffness};
use crate::columns::Dimension;
use crate::law::descriptor::{Bounds, Descriptor, Need, Wrong, number, word};
use crate::spec::{Parameter, Parameters};

/// Directions in which it may grow.
const TOWARD: [(&str, &str); 6] = [
    ("x+", "toward larger x"),
    ("x-", "toward smaller x"),
    ("y+", "toward larger y"),
    ("y-", "toward smaller y"),
    ("z+", "toward larger z"),
    ("z-", "toward smaller z"),
];

#[derive(Debug, Clone)]
pub struct AbsorbingLayer {
    /// c of each point (mass / volume / time).
    viscosity: Vec<f64>,
}

impl PointForce for AbsorbingLayer {
    fn memory(&self) -> usize {
        0
    }
    fn force(&self, _: usize, _: &Seen, _: &mut [f64]) -> LocalForce {
        LocalForce {
            force: [0.0; 3],
            stiffness: [[0.0; 3]; 3],
        }
    }
    fn stiffness(&self) -> Stiffness {
        Stiffness::None
    }
    fn viscosity(&self, k: usize) -> f64 {
        self.viscosity[k]
    }
}

impl Described for AbsorbingLayer {
    const NAME: &'static str = "absorbing_layer";

    fn descriptor() -> Descriptor {
        let part = Bounds {
            below: true,
            ..Bounds::PART
        };
        let speed = "Speed v of the waves that it absorbs.";
        let reflection =
            "Part R of the amplitude that comes back, of waves that are short beside the layer.";
        let exponent = "n of the profile: how slowly it begins.";
        Descriptor::new(
            Self::NAME,
            "Viscosity that grows toward an end, −(n+1) ρ v ln(1/R)/L (d/L)ⁿ times the velocity, at a depth d of a layer that is L thick.",
        )
        .source("Israeli & Orszag 1981; profile of Collino & Tsogka 2001")
        .example("{ toward = \"x+\", speed = \"5 km/s\" }")
        .keys(&[word("toward", &TOWARD, "The direction of the end.").need(Need::Given)])
        .number("speed", Dimension::VELOCITY, Bounds::POSITIVE, speed)
        .keys(&[
            number("reflection", Dimension::NUMBER, part, reflection).or(1e-3),
            number("exponent", Dimension::NUMBER, Bounds::NOT_NEGATIVE, exponent).or(3.0),
        ])
    }

    fn new(p: &Parameters, on: &Placed) -> Result<Self, Wrong> {
        let whole = |message: String| (String::new(), message);
        let [speed, reflection, exponent] =
            p.all(["speed", "reflection", "exponent"]).map_err(whole)?;
        let direction = TOWARD
            .iter()
            .position(|(word, _)| matches!(p.get("toward"), Some(Parameter::Word(w)) if w == word));
        let direction = direction.ok_or_else(|| whole("the word `toward` is missing".into()))?;
        let (axis, toward) = (direction / 2, TOWARD[direction].0);
        if axis >= on.dimension {
            let message = format!(
                "the layer grows toward {toward}, and the dimension of the body is {}",
                on.dimension
            );
            return Err(("toward".into(), message));
        }
        let sign = [1.0, -1.0][direction % 2];
        let along = || on.points.iter().map(|x| sign * x[axis]);
        // points stand in the middle of their cells
        let begin = along().fold(f64::INFINITY, f64::min) - 0.5 * on.spacing;
        let end = along().fold(f64::NEG_INFINITY, f64::max) + 0.5 * on.spacing;
        let thickness = end - begin;
        let most = (exponent + 1.0) * speed * libm::log(1.0 / reflection) / thickness;
        let both = along().zip(on.density);
        let viscosity =
            both.map(|(x, rho)| most * rho * libm::pow((x - begin) / thickness, exponent));
        Ok(AbsorbingLayer {
            viscosity: viscosity.collect(),
        })
    }
}
