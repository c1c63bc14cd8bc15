//! What several figures say of their runs, in numbers.

use peridyne::run::Simulation;

/// Points that are read at once.
const BLOCK: usize = 8192;

/// The largest of values from 0 on; not a number if one is none, so that no claim passes for want of values.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |m: f64, x: f64| if m.is_nan() || x <= m { m } else { x };
    values.into_iter().fold(0.0, larger)
}

/// Largest change since the first value, relative to it.
pub fn change(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values = values.into_iter();
    let first = values.next().unwrap_or(f64::NAN);
    largest(
        std::iter::once(first)
            .chain(values)
            .map(|x| (x / first - 1.0).abs()),
    )
}

/// Largest `|a − b|`.
pub fn apart(a: &[f64], b: &[f64]) -> f64 {
    largest(a.iter().zip(b).map(|(a, b)| (a - b).abs()))
}

/// `√(Σ (a − b)² / Σ b²)`
pub fn relative_difference(a: &[f64], b: &[f64]) -> f64 {
    let difference: f64 = a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum();
    let size: f64 = b.iter().map(|y| y * y).sum();
    (difference / size).sqrt()
}

/// (Δt²/8) Σ m a² of the last forces. Velocity Verlet conserves the energy less this exactly where forces are linear in
/// displacements; the energy alone changes by as much as this does.
pub fn stepper_energy(sim: &mut dyn Simulation) -> f64 {
    let info = sim.info();
    let (points, dimension, dt) = (info.points as usize, info.dimension, info.time_step);
    let mut sum = 0.0;
    let [mut volume, mut density, mut force] = [0; 3].map(|_| vec![0.0; BLOCK.min(points)]);
    for first in (0..points).step_by(BLOCK) {
        let n = BLOCK.min(points - first);
        sim.read("volume", 0, first, &mut volume[..n]);
        sim.read("density", 0, first, &mut density[..n]);
        for axis in 0..dimension {
            sim.read("force_density", axis, first, &mut force[..n]);
            // force densities: m a² = V f²/ρ
            sum += (0..n)
                .map(|i| volume[i] * force[i] * force[i] / density[i])
                .sum::<f64>();
        }
    }
    dt * dt / 8.0 * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_the_largest() {
        assert_eq!(largest([1.0, 3.0, 2.0]), 3.0);
        assert!(largest([1.0, f64::NAN, 2.0]).is_nan());
        assert!((change([2.0, 2.5, 1.0]) - 0.5).abs() < 1e-15);
        assert!(change([]).is_nan() && change([2.0, f64::NAN]).is_nan());
        assert!(apart(&[1.0, f64::NAN], &[1.0, 0.0]).is_nan());
    }
}
