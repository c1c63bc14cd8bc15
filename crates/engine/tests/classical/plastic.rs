//! Uniaxial tension beyond yield, unloading, and yield on the way back.

use super::{block, led, stress};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

const YOUNG: f64 = 1.0;
const POISSON: f64 = 0.3;
/// So small that stretches are linear in it.
const YIELD: f64 = 1e-7;
const HARDENING: f64 = 0.25;

/// The classical bar of J2 plasticity with isotropic hardening: axial and lateral strain and stress, at the corners of its curve in
/// units of the yield strain.
struct Corner {
    strain: f64,
    lateral: f64,
    stress: f64,
}

/// Pulled to five times the yield strain, then pushed until it has yielded the other way.
fn corners() -> Vec<Corner> {
    let yields = YIELD / YOUNG;
    let mut all = vec![Corner {
        strain: 0.0,
        lateral: 0.0,
        stress: 0.0,
    }];
    let mut go = |strain: f64, flows: bool| {
        let last = &all[all.len() - 1];
        let step = strain - last.strain;
        let plastic = if flows {
            step * YOUNG / (YOUNG + HARDENING)
        } else {
            0.0
        };
        let corner = Corner {
            strain,
            lateral: last.lateral - POISSON * (step - plastic) - 0.5 * plastic,
            stress: last.stress + YOUNG * (step - plastic),
        };
        all.push(corner);
    };
    go(yields, false);
    go(5.0 * yields, true);
    // what it bears has grown, and it bears as much in compression
    let grown = YIELD + 4.0 * yields * YOUNG * HARDENING / (YOUNG + HARDENING);
    let back = 5.0 * yields - 2.0 * grown / YOUNG;
    go(back, false);
    go(back - 2.0 * yields, true);
    all
}

/// Steps between two corners.
const STEPS: usize = 20;

/// A function of time that is straight between corners.
fn broken_line(values: &[f64], axis: &str) -> String {
    let mut text = String::new();
    let mut slope = 0.0;
    for (n, pair) in values.windows(2).enumerate() {
        let next = (pair[1] - pair[0]) / STEPS as f64;
        text += &format!("+({:e})*max(t-{}, 0)", next - slope, n * STEPS);
        slope = next;
    }
    format!("{axis}*({})", text.trim_start_matches('+'))
}

/// The same bar of families that are not round. On this path strains keep their axes and extensions their pattern, so that all there is
/// of the lattice is the ratio a of its shear modulus along the axes to the nominal G: the deviator of x (1, −½, −½) has the stress
/// `q = 3Ga x`, its norm is worth the stress `3G√a x`, and `x` flows by `Δε̄/√a`.
struct Lattice {
    a: f64,
    flown: f64,
    hardened: f64,
}

impl Lattice {
    const SHEAR: f64 = YOUNG / (2.0 + 2.0 * POISSON);

    /// Axial and lateral stress.
    fn step(&mut self, axial: f64, lateral: f64) -> [f64; 2] {
        let mean = (axial + 2.0 * lateral) / 3.0;
        let root = self.a.sqrt();
        let trial = axial - mean - self.flown;
        let stress = 3.0 * Self::SHEAR * root * trial.abs();
        let beyond = stress - YIELD - HARDENING * self.hardened;
        if beyond > 0.0 {
            let flow = beyond / (3.0 * Self::SHEAR + HARDENING);
            self.hardened += flow;
            self.flown += trial.signum() * flow / root;
        }
        let q = 3.0 * Self::SHEAR * self.a * (axial - mean - self.flown);
        let pressure = YOUNG / (1.0 - 2.0 * POISSON) * mean;
        [pressure + 2.0 / 3.0 * q, pressure - q / 3.0]
    }
}

/// Largest deviation of axial and lateral stress from the classical bar, and from that of the lattice, over the yield stress.
fn deviation(ratio: u32) -> [f64; 2] {
    let corners = corners();
    let law = LawSpec::named(
        "elastic_plastic",
        Parameters::numbers(&[
            ("young", YOUNG),
            ("poisson", POISSON),
            ("yield_stress", YIELD),
            ("hardening", HARDENING),
        ]),
    );
    // the point in the middle and all its partners have full families
    let sites = 4 * ratio as i32 + 1;
    let mut spec = block(LatticeKind::Cubic, [sites; 3], ratio, law);
    let axial: Vec<f64> = corners.iter().map(|c| c.strain).collect();
    let lateral: Vec<f64> = corners.iter().map(|c| c.lateral).collect();
    let [x, y, z] = [
        broken_line(&axial, "x"),
        broken_line(&lateral, "y"),
        broken_line(&lateral, "z"),
    ];
    let mut sim = led(&mut spec, [&x, &y, &z]);
    let mut worst = [0.0f64; 2];
    let mut lattice: Option<Lattice> = None;
    for pair in corners.windows(2) {
        for n in 1..=STEPS {
            sim.step().unwrap();
            let part = n as f64 / STEPS as f64;
            let classical = pair[0].stress + part * (pair[1].stress - pair[0].stress);
            let between = |a: f64, b: f64| a + part * (b - a);
            let axial = between(pair[0].strain, pair[1].strain);
            let lateral = between(pair[0].lateral, pair[1].lateral);
            let found = ["xx", "yy"].map(|c| stress(sim.as_mut(), c));
            // the first step is elastic
            let x = (axial - lateral) / 1.5;
            let lattice = lattice.get_or_insert_with(|| Lattice {
                a: (found[0] - found[1]) / (3.0 * Lattice::SHEAR * x),
                flown: 0.0,
                hardened: 0.0,
            });
            let exact = lattice.step(axial, lateral);
            for (found, (classical, exact)) in
                found.iter().zip([(classical, exact[0]), (0.0, exact[1])])
            {
                worst[0] = worst[0].max((found - classical).abs() / YIELD);
                worst[1] = worst[1].max((found - exact).abs() / YIELD);
            }
        }
    }
    worst
}

#[test]
fn a_bar_flows_unloads_and_flows_back_as_the_classical_one() {
    let found = [2, 3].map(deviation);
    println!("horizons of 2 and 3 spacings: {found:?} of the yield stress");
    for [classical, exact] in found {
        assert!(exact < 1e-5, "{found:?}");
        // families of 3 spacings are the least round
        assert!(classical < 0.15, "{found:?}");
    }
}
