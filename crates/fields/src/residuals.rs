//! How well the balance laws hold: what is left of `∂ρ/∂t + ∇·π`, `∂π/∂t + ∇·(ρ v⊗v − σ)` and `∂e/∂t + ∇·(e v − σ·v + q)` (4.0.6) to (4.0.9).
//!
//! Rates are exact sums over particles at the instant (velocities and the forces −∂U/∂x, which know nothing of β), or differences
//! of frames before and after. Divergences are centred differences of the fields over ±h and ±2h, so that the error of the
//! difference is known: it falls as h², `(r(2h) − r(h))/3` is its size, and the two steps together leave one of h⁴. A residual
//! that is larger than this size says that frame, potential and formulas do not belong together.

use crate::FieldsError;
use crate::fields::{Fields, Quantity, Rates};
use crate::frame::Frame;
use crate::method::Method;
use crate::sums::evaluate;
use crate::targets::Targets;
use peridyne::law::terms::Sites;

/// What is left of a balance law, as root mean squares over the points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residual {
    /// With steps h.
    pub value: f64,
    /// Of the rates and of the divergences: what cancels.
    pub scale: f64,
    /// The size that the differences alone would leave.
    pub expected: f64,
    /// With the steps h and 2h combined.
    pub extrapolated: f64,
}

impl Residual {
    /// Relative to what cancels; 0 where nothing happens, not a number where it was not measured.
    pub fn relative(&self) -> f64 {
        if self.scale > 0.0 {
            self.value / self.scale
        } else {
            0.0 * self.value
        }
    }
}

/// Of the three laws.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residuals {
    pub mass: Residual,
    pub momentum: Residual,
    pub energy: Residual,
    /// Points at which they were measured: those with mass all around.
    pub points: usize,
    /// h (length).
    pub step: f64,
}

/// Fluxes that are summed up, so that tests can leave parts of them out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signs {
    pub stress: f64,
    pub heat_kinetic: f64,
    pub heat_potential: f64,
    pub heat_churning: f64,
}

/// As they are in the laws.
pub const RIGHT: Signs = Signs {
    stress: 1.0,
    heat_kinetic: 1.0,
    heat_potential: 1.0,
    heat_churning: 1.0,
};

/// Residuals of a frame at points, with rates of the instant.
///
/// # Errors
/// As [`evaluate`]; no velocities; a localization function whose gradient jumps.
pub fn of_frame(
    frame: &Frame,
    sites: &dyn Sites,
    method: &Method,
    points: &[[f64; 3]],
    step: f64,
) -> Result<Residuals, FieldsError> {
    of(frame, None, sites, method, points, step, RIGHT)
}

/// The same with any signs, and with rates from the frames before and after where they are given, which lie as far in time.
///
/// # Errors
/// As [`of_frame`]; frames without times or at unequal steps.
pub fn of(
    frame: &Frame,
    around: Option<[&Frame; 2]>,
    sites: &dyn Sites,
    method: &Method,
    points: &[[f64; 3]],
    step: f64,
    signs: Signs,
) -> Result<Residuals, FieldsError> {
    let (targets, method) = asked(frame, method, points, step)?;
    let fields = evaluate(frame, sites, &targets, &method)?;
    let rates: Vec<Rates> = match around {
        None => of_instant(&fields),
        Some([before, after]) => {
            let times = [before.time, frame.time, after.time];
            let [Some(a), Some(b), Some(c)] = times else {
                return Err(FieldsError(
                    "rates from frames need the times of the frames".into(),
                ));
            };
            if !(c > b) || ((c - b) - (b - a)).abs() > 1e-9 * (c - a) {
                return Err(FieldsError(format!(
                    "rates need frames at equal steps of time, not at {a}, {b}, {c}"
                )));
            }
            let targets = Targets::Points(points.to_vec());
            let [before, after] = [before, after].map(|f| evaluate(f, sites, &targets, &method));
            differences(&before?, &after?, c - a)
        }
    };
    Ok(measure(&fields, &rates, step, signs))
}

/// Residuals of a frame whose fields somebody else makes, at the points and by the method that they are then told, with rates of the instant.
///
/// # Errors
/// As [`of_frame`].
pub fn of_fields(
    frame: &Frame,
    method: &Method,
    points: &[[f64; 3]],
    step: f64,
    fields: &mut dyn FnMut(&Targets, &Method) -> Result<Fields, FieldsError>,
) -> Result<Residuals, FieldsError> {
    let (targets, method) = asked(frame, method, points, step)?;
    let fields = fields(&targets, &method)?;
    Ok(measure(&fields, &of_instant(&fields), step, RIGHT))
}

/// Where fields are needed, and how.
fn asked(
    frame: &Frame,
    method: &Method,
    points: &[[f64; 3]],
    step: f64,
) -> Result<(Targets, Method), FieldsError> {
    if frame.velocity.is_none() {
        return Err(FieldsError(
            "balance laws need velocities, which the frame does not have".into(),
        ));
    }
    if !method.kernel.is_smooth() {
        return Err(FieldsError(format!(
            "balance laws at points need a smooth localization function, not a {}",
            method.kernel.shape().name()
        )));
    }
    let mut all = vec![];
    for x in points {
        all.push(*x);
        for axis in 0..3 {
            for n in [1.0, -1.0, 2.0, -2.0] {
                let mut y = *x;
                y[axis] += n * step;
                all.push(y);
            }
        }
    }
    let method = Method {
        rates: true,
        by_part: false,
        ..method.clone()
    };
    Ok((Targets::Points(all), method))
}

fn of_instant(fields: &Fields) -> Vec<Rates> {
    fields.rates.iter().step_by(STENCIL).copied().collect()
}

/// A point and its twelve neighbours.
const STENCIL: usize = 13;

fn at(fields: &Fields, quantity: Quantity, p: usize) -> &[f64] {
    let n = quantity.components();
    fields.get(quantity).map_or(&[], |all| &all[p * n..][..n])
}

fn differences(before: &Fields, after: &Fields, time: f64) -> Vec<Rates> {
    let slope = |q: Quantity, p: usize, c: usize| (at(after, q, p)[c] - at(before, q, p)[c]) / time;
    let rate = |p: usize| Rates {
        density: slope(Quantity::Density, p, 0),
        momentum: std::array::from_fn(|c| slope(Quantity::Momentum, p, c)),
        energy: slope(Quantity::Energy, p, 0),
    };
    (0..before.len()).map(rate).collect()
}

/// Fluxes of mass, of the three momenta, and of energy at a point: `[5][3]`.
fn fluxes(fields: &Fields, p: usize, signs: Signs) -> [[f64; 3]; 5] {
    let of = |q| at(fields, q, p);
    let (rho, v, pi) = (
        of(Quantity::Density)[0],
        of(Quantity::Velocity),
        of(Quantity::Momentum),
    );
    let (stress, e) = (of(Quantity::Stress), of(Quantity::Energy)[0]);
    let heat = [
        (Quantity::HeatKinetic, signs.heat_kinetic),
        (Quantity::HeatPotential, signs.heat_potential),
        (Quantity::HeatChurning, signs.heat_churning),
    ];
    let mut all = [[0.0; 3]; 5];
    for a in 0..3 {
        all[0][a] = pi[a];
        for b in 0..3 {
            let s = signs.stress * stress[3 * a + b];
            all[1 + b][a] = rho * v[a] * v[b] - s;
            all[4][a] -= s * v[b];
        }
        all[4][a] += e * v[a];
        for (q, sign) in heat {
            // what is left out says nothing of energy
            all[4][a] += sign * of(q).get(a).copied().unwrap_or(f64::NAN);
        }
    }
    all
}

fn measure(fields: &Fields, rates: &[Rates], step: f64, signs: Signs) -> Residuals {
    // squares of residual, scale, expected, extrapolated
    let mut sums = [[0.0; 4]; 5];
    let mut points = 0;
    for (k, rate) in rates.iter().enumerate() {
        let here: Vec<_> = (0..STENCIL)
            .map(|n| fluxes(fields, k * STENCIL + n, signs))
            .collect();
        // where there is no mass there is no velocity
        let momenta = here.iter().flat_map(|fluxes| &fluxes[..4]);
        if momenta.flatten().any(|x| !x.is_finite()) {
            continue;
        }
        points += 1;
        let rate = [
            rate.density,
            rate.momentum[0],
            rate.momentum[1],
            rate.momentum[2],
            rate.energy,
        ];
        for (q, rate) in rate.into_iter().enumerate() {
            let divergence = |wide: usize| -> f64 {
                let of = |a: usize, sign: usize| here[1 + 4 * a + 2 * wide + sign][q][a];
                let width = 2.0 * step * (wide + 1) as f64;
                (0..3).map(|a| (of(a, 0) - of(a, 1)) / width).sum()
            };
            let near = rate + divergence(0);
            let far = rate + divergence(1);
            sums[q][0] += near * near;
            sums[q][1] += rate * rate;
            sums[q][2] += ((far - near) / 3.0).powi(2);
            sums[q][3] += ((4.0 * near - far) / 3.0).powi(2);
        }
    }
    let root = |all: &[[f64; 4]]| {
        let sum =
            |n: usize| (all.iter().map(|s| s[n]).sum::<f64>() / f64::from(points.max(1))).sqrt();
        Residual {
            value: sum(0),
            scale: sum(1),
            expected: sum(2),
            extrapolated: sum(3),
        }
    };
    Residuals {
        mass: root(&sums[..1]),
        momentum: root(&sums[1..4]),
        energy: root(&sums[4..]),
        points: points as usize,
        step,
    }
}
