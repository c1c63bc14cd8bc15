//! Files of numbers that another program computed for atoms, and a run beside them.

use peridyne::run::Simulation;
use std::path::Path;

/// Rows of numbers between lines of `#`.
pub fn read(path: &Path) -> Vec<Vec<Vec<f64>>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut parts = vec![];
    for line in text.lines() {
        if line.starts_with('#') {
            parts.push(vec![]);
        } else {
            let row = line.split_whitespace().map(|w| w.parse().unwrap());
            parts.last_mut().unwrap().push(row.collect());
        }
    }
    parts
}

/// A run of 100 steps: energy to 1e-10 per atom, forces to 1e-9 of the largest, pressure to 1e-9, then positions and energies after
/// the steps to 1e-9. `pressure` is what one unit of the engine's pressure is in the file's.
pub fn compare(sim: &mut dyn Simulation, golden: &[Vec<Vec<f64>>], pressure: f64) {
    sim.start(true);
    let first = &golden[0][0];
    let n = sim.info().points as f64;
    let energy = sim.ledger().unwrap().strain;
    assert!(
        ((energy - first[0]) / n).abs() < 1e-10,
        "energy {energy} is not {}",
        first[0]
    );
    let (v, volumes) = (sim.velocities(), sim.scalars("volume"));
    let density = sim.scalars("density");
    let masses: Vec<f64> = volumes.iter().zip(density).map(|(v, d)| v * d).collect();
    let box_volume: f64 = volumes.iter().sum();
    let virial = sim.virial();
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    for (k, (a, b)) in pairs.into_iter().enumerate() {
        let kinetic: f64 = { v.iter().zip(&masses) }
            .map(|(v, m)| m * v[a] * v[b])
            .sum();
        let p = (kinetic + virial[k]) / box_volume * pressure;
        let scale = first[1].abs().max(first[2].abs());
        assert!(
            (p - first[1 + k]).abs() < 1e-9 * scale,
            "pressure {k}: {p} is not {}",
            first[1 + k]
        );
    }
    let forces = sim.vectors("force_density");
    let all = golden[1].iter().flatten();
    let largest = all.fold(0.0f64, |m, f| m.max(f.abs()));
    for (i, exact) in golden[1].iter().enumerate() {
        for a in 0..3 {
            let f = forces[i][a] * volumes[i];
            assert!(
                (f - exact[a]).abs() < 1e-9 * largest,
                "force on {i}: {f} is not {}",
                exact[a]
            );
        }
    }
    for _ in 0..100 {
        sim.step().unwrap();
    }
    let ledger = sim.ledger().unwrap();
    for (what, found, exact) in [
        ("energy", ledger.strain, golden[2][0][0]),
        ("kinetic energy", ledger.kinetic, golden[2][0][1]),
    ] {
        assert!(
            ((found - exact) / n).abs() < 1e-9,
            "{what} after 100 steps: {found} is not {exact}"
        );
    }
    let (x, u) = (sim.vectors("reference"), sim.displacements());
    for (i, exact) in golden[3].iter().enumerate() {
        for a in 0..3 {
            let y = x[i][a] + u[i][a];
            assert!(
                (y - exact[a]).abs() < 1e-9,
                "atom {i}: {y} is not {}",
                exact[a]
            );
        }
    }
}
