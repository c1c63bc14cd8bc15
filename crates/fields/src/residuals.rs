//! How well the balance laws hold: what is left of `∂ρ/∂t + ∇·π`, `∂π/∂t + ∇·(ρ v⊗v − σ)` and `∂e/∂t + ∇·(e v − σ·v + q)` (4.0.6) to (4.0.9).
//!
//! Of these follow, with ε = e − ½ρv² the internal energy (4.0.10), `∂ε/∂t + ∇·(ε v + q) = σ:∇v`; and, with the flux `D = Σ m u⊗d φ` of the material coordinate y (4.0.72),
//! `∂(ρy)/∂t + ∇·(ρ v y + D) = ρ v`, which is printed with the other sign of D and without the density of v. As D is not 0, y is not material, and angular momentum l = ρ y × v
//! obeys `∂l/∂t + ∇·(v l) = y × ∇·σ − (∇·D) × v`: without the last term, as (4.0.92) would have it, something is left that is no error of differences.
//!
//! Rates are exact sums over particles at the instant (velocities and the forces −∂U/∂x, which know nothing of β), or differences
//! of frames before and after. Divergences are centred differences of the fields over ±h and ±2h, so that the error of the
//! difference is known: it falls as h², `(r(2h) − r(h))/3` is its size, and the two steps together leave one of h⁴. A residual
//! that is larger than this size says that frame, potential and formulas do not belong together.

use crate::FieldsError;
use crate::fields::{Fields, Quantity, Rates};
use crate::frame::{Frame, cross};
use crate::kernel::dot;
use crate::method::Method;
use crate::sums::evaluate;
use crate::targets::Targets;
use peridyne::law::terms::Sites;
use peridyne::state::words;

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

words!([] Residual { value: f64, scale: f64, expected: f64, extrapolated: f64 });

words!([] Residuals {
    mass: Residual,
    momentum: Residual,
    energy: Residual,
    internal_energy: Residual,
    coordinate: Residual,
    angular_momentum: Residual,
    points: usize,
    step: f64,
});

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

/// Of the laws.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residuals {
    pub mass: Residual,
    pub momentum: Residual,
    pub energy: Residual,
    /// (4.0.10)
    pub internal_energy: Residual,
    /// (4.0.72); of the components that are not averaged over.
    pub coordinate: Residual,
    /// (4.0.91), with what y is short of a material coordinate.
    pub angular_momentum: Residual,
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
    /// Of D in (4.0.72).
    pub coordinate: f64,
    /// Of D in the balance of angular momentum.
    pub torque: f64,
}

/// As they are in the laws.
pub const RIGHT: Signs = Signs {
    stress: 1.0,
    heat_kinetic: 1.0,
    heat_potential: 1.0,
    heat_churning: 1.0,
    coordinate: 1.0,
    torque: 1.0,
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
        coordinate: true,
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
        coordinate: std::array::from_fn(|c| {
            let of =
                |f: &Fields| at(f, Quantity::Density, p)[0] * at(f, Quantity::Coordinate, p)[c];
            (of(after) - of(before)) / time
        }),
    };
    (0..before.len()).map(rate).collect()
}

/// Numbers that are balanced: mass, momentum, energy, internal energy, ρy, angular momentum.
const BALANCED: usize = 12;
/// The first of internal energy, of ρy and of angular momentum.
const INTERNAL: usize = 5;
const PLACE: usize = 6;
const TURNING: usize = 9;

/// What the laws need to know of a point.
struct Here {
    /// Of all that is balanced.
    flux: [[f64; 3]; BALANCED],
    velocity: [f64; 3],
    stress: [f64; 9],
    /// D
    spread: [f64; 9],
    place: [f64; 3],
}

fn here(fields: &Fields, p: usize, signs: Signs) -> Here {
    let of = |q| at(fields, q, p);
    // what is left out says nothing of energy, and what was not made nothing of places
    let number = |q, n: usize| of(q).get(n).copied().unwrap_or(f64::NAN);
    let vector = |q| -> [f64; 3] { std::array::from_fn(|a| number(q, a)) };
    let tensor = |q| -> [f64; 9] { std::array::from_fn(|n| number(q, n)) };
    let (rho, e) = (number(Quantity::Density, 0), number(Quantity::Energy, 0));
    let internal = number(Quantity::InternalEnergy, 0);
    let (v, pi) = (vector(Quantity::Velocity), vector(Quantity::Momentum));
    let stress = tensor(Quantity::Stress).map(|s| signs.stress * s);
    let spread = tensor(Quantity::CoordinateFlux);
    let (y, l) = (
        vector(Quantity::Coordinate),
        vector(Quantity::AngularMomentum),
    );
    let heat = [
        (Quantity::HeatKinetic, signs.heat_kinetic),
        (Quantity::HeatPotential, signs.heat_potential),
        (Quantity::HeatChurning, signs.heat_churning),
    ];
    let mut flux = [[0.0; 3]; BALANCED];
    for a in 0..3 {
        flux[0][a] = pi[a];
        for b in 0..3 {
            let s = stress[3 * a + b];
            flux[1 + b][a] = rho * v[a] * v[b] - s;
            flux[4][a] -= s * v[b];
            flux[PLACE + b][a] = rho * v[a] * y[b] + signs.coordinate * spread[3 * a + b];
            flux[TURNING + b][a] = v[a] * l[b];
        }
        flux[4][a] += e * v[a];
        flux[INTERNAL][a] = internal * v[a];
        for (q, sign) in heat {
            let q = sign * number(q, a);
            flux[4][a] += q;
            flux[INTERNAL][a] += q;
        }
    }
    Here {
        flux,
        velocity: v,
        stress,
        spread,
        place: y,
    }
}

/// Rates of all that is balanced: those of internal energy and of angular momentum follow from the others.
fn rates_of(rate: &Rates, here: &Here) -> [f64; BALANCED] {
    let v = here.velocity;
    let along = |of: &[f64; 3]| dot(v, *of);
    let internal = rate.energy - along(&rate.momentum) + 0.5 * along(&v) * rate.density;
    // ρ ∂v/∂t
    let pushed = std::array::from_fn(|a| rate.momentum[a] - v[a] * rate.density);
    let (moved, turned) = (cross(rate.coordinate, v), cross(here.place, pushed));
    let (m, y) = (rate.momentum, rate.coordinate);
    let l: [f64; 3] = std::array::from_fn(|a| moved[a] + turned[a]);
    [
        rate.density,
        m[0],
        m[1],
        m[2],
        rate.energy,
        internal,
        y[0],
        y[1],
        y[2],
        l[0],
        l[1],
        l[2],
    ]
}

fn measure(fields: &Fields, rates: &[Rates], step: f64, signs: Signs) -> Residuals {
    // squares of residual, scale, expected, extrapolated
    let mut sums = [[0.0; 4]; BALANCED];
    let mut points = 0;
    for (k, rate) in rates.iter().enumerate() {
        let all: Vec<Here> = (0..STENCIL)
            .map(|n| here(fields, k * STENCIL + n, signs))
            .collect();
        // where there is no mass there is no velocity
        let momenta = all.iter().flat_map(|here| &here.flux[..4]);
        if momenta.flatten().any(|x| !x.is_finite()) {
            continue;
        }
        points += 1;
        let rate = rates_of(rate, &all[0]);
        // ∂_a of what is seen of a point, over 2h or 4h
        let slope = |wide: usize, a: usize, of: &dyn Fn(&Here) -> f64| -> f64 {
            let [up, down] = [0, 1].map(|sign| of(&all[1 + 4 * a + 2 * wide + sign]));
            (up - down) / (2.0 * step * (wide + 1) as f64)
        };
        let left = |wide: usize| -> [f64; BALANCED] {
            let divergence =
                |q: usize| -> f64 { (0..3).map(|a| slope(wide, a, &|h| h.flux[q][a])).sum() };
            let of_rows = |of: fn(&Here) -> &[f64; 9]| -> [f64; 3] {
                std::array::from_fn(|b| (0..3).map(|a| slope(wide, a, &|h| of(h)[3 * a + b])).sum())
            };
            let made = sources(
                &all[0],
                signs,
                &|a, b| slope(wide, a, &|h| h.velocity[b]),
                [of_rows(|h| &h.stress), of_rows(|h| &h.spread)],
            );
            std::array::from_fn(|q| rate[q] + divergence(q) - made[q])
        };
        let (near, far) = (left(0), left(1));
        for (q, sums) in sums.iter_mut().enumerate() {
            sums[0] += near[q] * near[q];
            sums[1] += rate[q] * rate[q];
            sums[2] += ((far[q] - near[q]) / 3.0).powi(2);
            sums[3] += ((4.0 * near[q] - far[q]) / 3.0).powi(2);
        }
    }
    let root = |all: &[[f64; 4]]| {
        // axes that are averaged over have no place
        let known = |sums: &&[f64; 4]| sums.iter().all(|s| s.is_finite());
        let some = all.iter().any(|sums| known(&sums));
        let sum = |n: usize| {
            let those = all.iter().filter(|sums| !some || known(sums));
            (those.map(|s| s[n]).sum::<f64>() / f64::from(points.max(1))).sqrt()
        };
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
        energy: root(&sums[4..INTERNAL]),
        internal_energy: root(&sums[INTERNAL..PLACE]),
        coordinate: root(&sums[PLACE..TURNING]),
        angular_momentum: root(&sums[TURNING..]),
        points: points as usize,
        step,
    }
}

/// What is made at a point: σ:∇v, π, y × ∇·σ − (∇·D) × v.
fn sources(
    here: &Here,
    signs: Signs,
    slope: &dyn Fn(usize, usize) -> f64,
    [pushed, spread]: [[f64; 3]; 2],
) -> [f64; BALANCED] {
    let mut made = [0.0; BALANCED];
    made[INTERNAL] = (0..9).map(|n| here.stress[n] * slope(n / 3, n % 3)).sum();
    let (torque, moved) = (cross(here.place, pushed), cross(spread, here.velocity));
    for b in 0..3 {
        made[PLACE + b] = here.flux[0][b];
        made[TURNING + b] = torque[b] - signs.torque * moved[b];
    }
    made
}
