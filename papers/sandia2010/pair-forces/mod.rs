//! (4.0.24) to (4.0.50): which pair forces there are, and what stress makes of them.

use peridyne::law::terms::{Near, Sites, Term};
use peridyne_fields::residuals::of_frame;
use peridyne_fields::specimen::{Chiral, Random, cluster};
use peridyne_fields::{Fields, Frame, Method, PairForce, Quantity, Shape, Targets, evaluate};

use super::particles::{
    DIAMOND, Vector, cross, crystal, dot, failed, less, method, plus, silicon, size, times,
};
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    PairForces,
    "pair-forces",
    "Pair forces of particles, and symmetric stress",
    ["../particles.rs"]
);

fn run(_: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    chiral(&mut found);
    products(&mut found);
    disordered(&mut found)?;
    symmetry(&mut found)?;
    Ok(found)
}

/// (4.0.28).
fn volume(x: &[Vector]) -> f64 {
    let [a, b, c] = [1, 2, 3].map(|k| less(x[k], x[0]));
    dot(a, cross(b, c))
}

/// −∂U/∂x by differences, which are exact up to round-off of an energy that is linear in each coordinate.
fn slopes(energy: impl Fn(&[Vector]) -> f64, x: &[Vector]) -> Vec<Vector> {
    let slope = |i: usize, a: usize| {
        let at = |h: f64| {
            let mut y = x.to_vec();
            y[i][a] += h;
            energy(&y)
        };
        -0.5 * (at(1.0) - at(-1.0))
    };
    (0..x.len())
        .map(|i| std::array::from_fn(|a| slope(i, a)))
        .collect()
}

/// Forces as sums of central pair forces −x_jk G_jk.
fn central(x: &[Vector]) -> Vec<Vector> {
    let near: Vec<Near> = (1..x.len())
        .map(|k| Near {
            kind: k as u32,
            y: less(x[k], x[0]),
        })
        .collect();
    let mut force = vec![[0.0; 3]; x.len()];
    Chiral.terms(0, &near, &mut |term: &Term| {
        for &(a, b, g) in &term.pulls {
            let pull = times(-g, less(x[a as usize], x[b as usize]));
            force[a as usize] = plus(force[a as usize], pull);
            force[b as usize] = less(force[b as usize], pull);
        }
    });
    force
}

fn apart(a: &[Vector], b: &[Vector]) -> f64 {
    let [a, b] = [a, b].map(|of| of.as_flattened());
    crate::measure::apart(a, b) / size(a)
}

fn chiral(found: &mut Findings) {
    let mut random = Random(1);
    let x: Vec<Vector> = (0..4).map(|_| random.vector()).collect();
    let [x01, x02, x03] = [1, 2, 3].map(|k| less(x[k], x[0]));
    let printed = [
        times(-1.0, cross(x02, x03)),
        cross(x01, x03),
        times(-1.0, cross(x01, x02)),
    ];
    let force = slopes(volume, &x);
    let others = apart(&force[1..], &printed);
    let opposite = printed.map(|f| times(-1.0, f));
    found.holds(
        "4.0.29",
        format!("the forces on 1, 2 and 3 and what is printed differ by {others:.1e}"),
        others < 1e-13 && apart(&force[1..], &opposite) > 1.0,
    );
    let sum = printed.iter().fold([0.0; 3], |s, f| less(s, *f));
    let [whole, half] = [1.0, 0.5].map(|c| apart(&[force[0]], &[times(c, sum)]));
    found.holds(
        "4.0.26",
        format!("the force on particle 0 is missed by {whole:.1e}, with the ½ by {half:.2}"),
        whole < 1e-13 && half > 0.4,
    );
    let mut worst = vec![];
    for _ in 0..100 {
        let x: Vec<Vector> = (0..4).map(|_| random.vector()).collect();
        worst.push(apart(&slopes(volume, &x), &central(&x)) * flatness(&x));
    }
    // x01 and x02 in a plane, x03 normal to it
    let own = [[0.0; 3], [1.0, 0.0, 0.0], [0.3, 0.8, 0.0], [0.0, 0.0, 0.7]];
    let special = apart(&slopes(volume, &own), &central(&own));
    worst.push(special);
    let worst = largest(worst);
    found.number("4.0.33", worst);
    found.holds(
        "4.0.30",
        format!("central pair forces add up to the forces within {worst:.1e}"),
        worst < 1e-12,
    );
}

/// How much of a volume is left: what round-off grows by where four particles are nearly in a plane.
fn flatness(x: &[Vector]) -> f64 {
    let edges = [1, 2, 3].map(|k| less(x[k], x[0]));
    let all: f64 = edges.iter().map(|e| dot(*e, *e).sqrt()).product();
    (volume(x) / all).powi(2)
}

/// (4.0.41).
fn products(found: &mut Findings) {
    let mut random = Random(2);
    let mut worst = vec![];
    for _ in 0..100 {
        let x: [Vector; 3] = std::array::from_fn(|_| random.vector());
        let [d12, d13, d23] = [(0, 1), (0, 2), (1, 2)].map(|(a, b)| less(x[a], x[b]));
        let exact = slopes(|x| dot(less(x[0], x[2]), less(x[1], x[2])), &x);
        let differences = [[0.0; 3], times(-1.0, d23), times(-1.0, d13)];
        let distances = [d12, times(-1.0, d13), times(-1.0, d23)];
        for [f12, f13, f23] in [differences, distances] {
            let sums = [plus(f12, f13), less(f23, f12), times(-1.0, plus(f13, f23))];
            worst.push(crate::measure::apart(
                exact.as_flattened(),
                sums.as_flattened(),
            ));
        }
    }
    found.number("4.0.42", largest(worst));
}

fn with(pair_force: PairForce, shape: Shape, width: f64) -> Result<Method, Failure> {
    Ok(Method {
        pair_force,
        ..method(shape, width)?
    })
}

fn stress(fields: &Fields) -> &[f64] {
    fields.get(Quantity::StressPotential).unwrap_or_default()
}

const BOTH: [PairForce; 2] = [PairForce::Distances, PairForce::Differences];

fn disordered(found: &mut Findings) -> Result<(), Failure> {
    let frame = crystal(&DIAMOND, 2, 2.59, 0.1)?;
    let sites = silicon()?;
    let points = points();
    let mut all = vec![];
    let mut left = vec![];
    for pair_force in BOTH {
        let method = with(pair_force, Shape::Polynomial(5), 1.6)?;
        let targets = Targets::Points(points.clone());
        all.push(evaluate(&frame, &*sites, &targets, &method).map_err(failed)?);
        let residuals = of_frame(&frame, &*sites, &method, &points, 0.04).map_err(failed)?;
        left.push(residuals.momentum.extrapolated / residuals.momentum.scale);
    }
    found.number("same-divergence", largest(left));
    let off = crate::measure::apart(stress(&all[0]), stress(&all[1])) / size(stress(&all[0]));
    let forces = apart(&all[0].force, &all[1].force);
    let [a, b] = [&all[0], &all[1]].map(|f| f.totals.virial);
    let mean = crate::measure::apart(&a, &b) / size(&a);
    found.holds(
        "not-unique",
        format!("stress differs by {off:.2}, forces by {forces:.1e}, mean stress by {mean:.1e}"),
        off > 0.01 && forces < 1e-10 && mean < 1e-10,
    );
    Ok(())
}

fn points() -> Vec<Vector> {
    let mut random = Random(5);
    (0..8).map(|_| plus(random.vector(), [2.6; 3])).collect()
}

/// Parts of a tensor that are not symmetric, over its largest component.
fn asymmetry(s: &[f64]) -> f64 {
    largest([(1, 3), (2, 6), (5, 7)].map(|(a, b)| (s[a] - s[b]).abs())) / size(s)
}

fn symmetry(found: &mut Findings) -> Result<(), Failure> {
    let frame: Frame = cluster(4, 8);
    let mut seen = vec![];
    for pair_force in BOTH {
        let method = with(pair_force, Shape::Gaussian, 0.5)?;
        let targets = Targets::Points(vec![[0.1, 0.2, 0.1], [-0.3, 0.1, 0.4]]);
        let fields = evaluate(&frame, &Chiral, &targets, &method).map_err(failed)?;
        let s = stress(&fields);
        seen.push(largest(s.chunks_exact(9).map(asymmetry)));
        if pair_force == PairForce::Differences {
            let torques = fields.force.iter().zip(&frame.position);
            let torques: Vec<Vector> = torques.map(|(f, x)| cross(*x, *f)).collect();
            let sum = torques.iter().fold([0.0; 3], |s, t| plus(s, *t));
            found.number(
                "angular-momentum",
                size(&sum) / size(torques.as_flattened()),
            );
            found.number("angular-sum", asymmetry(&fields.totals.virial));
        }
    }
    found.holds(
        "symmetric",
        format!(
            "asymmetry {:.1e} with distances, {:.2} with differences",
            seen[0], seen[1]
        ),
        seen[0] < 1e-12 && seen[1] > 0.01,
    );
    Ok(())
}
