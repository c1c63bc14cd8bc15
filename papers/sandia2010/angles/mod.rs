//! (4.0.144) to (4.0.155): angles as functions of distances.

use peridyne::law::terms::{Near, Sites, Term};
use peridyne::spec::Form;
use peridyne_fields::specimen::Random;
use peridyne_fields::{Method, Quantity, Shape, Targets, evaluate};

use super::particles::{
    DIAMOND, SILICON, Vector, cross, crystal, dot, failed, less, method, silicon, size, times,
};
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Angles,
    "angles",
    "Angles, torsion and silicon by distances",
    ["../particles.rs"]
);

fn run(_: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let mut random = Random(3);
    let states: Vec<[Vector; 4]> = (0..1000)
        .map(|_| std::array::from_fn(|_| random.vector()))
        .collect();
    products(&mut found, &states);
    sizes(&mut found, &states);
    bond_angles(&mut found, &states);
    torsion(&mut found, &states);
    triplets(&mut found, &states)?;
    diamond(&mut found)?;
    Ok(found)
}

fn xi(a: Vector, b: Vector) -> f64 {
    let d = less(a, b);
    0.5 * dot(d, d)
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

fn products(found: &mut Findings, states: &[[Vector; 4]]) {
    let off = states.iter().map(|&[a, b, c, d]| {
        let four = xi(a, d) - xi(a, c) + xi(b, c) - xi(b, d) - dot(less(a, b), less(c, d));
        let three = xi(a, c) + xi(b, c) - xi(a, b) - dot(less(a, c), less(b, c));
        four.abs().max(three.abs())
    });
    found.number("4.0.144", largest(off));
}

/// Heron's area of a triangle and Piero della Francesca's volume of a tetrahedron, both by ξ = d²/2 of their edges.
fn sizes(found: &mut Findings, states: &[[Vector; 4]]) {
    let (mut areas, mut volumes) = (vec![], vec![]);
    for &[a, b, c, d] in states {
        let [ab, ac, bc] = [xi(a, b), xi(a, c), xi(b, c)];
        let heron = 0.25 * (4.0 * ab * ac - (ab + ac - bc).powi(2));
        let normal = cross(less(b, a), less(c, a));
        areas.push((heron - 0.25 * dot(normal, normal)).abs());
        // Gram's determinant of the edges at a, whose products are ξ + ξ − ξ
        let [ad, bd, cd] = [xi(a, d), xi(b, d), xi(c, d)];
        let [x, y, z] = [ab + ac - bc, ab + ad - bd, ac + ad - cd];
        let gram = 8.0 * ab * ac * ad + 2.0 * (x * y * z - ab * z * z - ac * y * y - ad * x * x);
        let volume = dot(normal, less(d, a));
        volumes.push((gram - volume * volume).abs() / 36.0);
    }
    found.number("heron", largest(areas));
    found.number("piero", largest(volumes));
}

/// The angle at c, between a and b; its ξ in the order of the engine.
fn bond_angles(found: &mut Findings, states: &[[Vector; 4]]) {
    // K (1 + cos θ) with K = 1
    let form = Form::CosineAngle { stiffness: 1.0 };
    let (mut values, mut slopes) = (vec![], vec![]);
    for &[a, b, c, _] in states {
        let [ac, bc] = [less(a, c), less(b, c)];
        let [d1, d2] = [length(ac), length(bc)];
        let cosine = dot(ac, bc) / (d1 * d2);
        let of = form.pulls(&[xi(a, c), xi(a, b), xi(b, c)]);
        values.push((of.energy - 1.0 - cosine).abs());
        let both = 1.0 / (d1 * d2);
        let printed = [both - cosine / (d1 * d1), -both, both - cosine / (d2 * d2)];
        slopes.push(crate::measure::apart(&of.pulls[..3], &printed) / size(&printed));
    }
    found.number("4.0.146", largest(values));
    found.number("4.0.147", largest(slopes));
}

/// Cosine of the angle between the half planes of a and d about the axis from b to c.
fn turned([a, b, c, d]: [Vector; 4]) -> f64 {
    let axis = less(c, b);
    let axis = times(1.0 / length(axis), axis);
    let across = |x: Vector| {
        let from = less(x, b);
        let out = less(from, times(dot(from, axis), axis));
        times(1.0 / length(out), out)
    };
    dot(across(a), across(d))
}

fn torsion(found: &mut Findings, states: &[[Vector; 4]]) {
    // cos φ alone
    let form = Form::Dihedral {
        powers: vec![0.0, 1.0],
    };
    let mut engine = vec![];
    let [mut lengths, mut areas, mut printed, mut right] = [const { vec![] }; 4];
    for &state in states {
        let [a, b, c, d] = state;
        let exact = turned(state);
        let [x12, x13, x23] = [xi(a, b), xi(a, c), xi(b, c)];
        let [x14, x24, x34] = [xi(a, d), xi(b, d), xi(c, d)];
        engine.push((form.pulls(&[x12, x13, x23, x14, x24, x34]).energy - exact).abs());
        let normals = [cross(less(a, b), less(a, c)), cross(less(d, b), less(d, c))];
        let top = dot(normals[0], normals[1]);
        let edges = [less(a, b), less(a, c), less(d, b), less(d, c)].map(length);
        lengths.push((top / edges.iter().product::<f64>() - exact).abs());
        areas.push((top / (length(normals[0]) * length(normals[1])) - exact).abs());
        let first = x12 * (x34 - x24 + x23) + x13 * (x24 - x34 + x23);
        let [short, whole] = [
            first - x23 * x23,
            first + x23 * (x24 + x34 - x23) - 2.0 * x14 * x23,
        ];
        printed.push((short - top).abs());
        right.push((whole - top).abs());
    }
    let [lengths, areas, printed, right] = [lengths, areas, printed, right].map(largest);
    found.number("torsion", largest(engine));
    found.holds(
        "4.0.148",
        format!("by areas within {areas:.1e} of geometry, by lengths {lengths:.2}"),
        areas < 1e-10 && lengths > 0.1,
    );
    found.holds(
        "4.0.149",
        format!("within {right:.1e} of the normals' product, as printed {printed:.2}"),
        right < 1e-12 && printed > 0.1,
    );
}

/// A constant of silicon.
fn constant(name: &str) -> f64 {
    let of = SILICON.iter().find(|(key, _)| *key == name);
    of.map_or(f64::NAN, |(_, x)| *x)
}

/// The triplet of a centre and two others in the engine.
fn triplet(sites: &dyn Sites, ends: [Vector; 2]) -> Option<Term> {
    let near = ends.map(|y| Near { kind: 0, y });
    let mut triple = None;
    sites.terms(0, &near, &mut |term| {
        if term.particles.len() == 3 {
            triple = Some(term.clone());
        }
    });
    triple
}

fn triplets(found: &mut Findings, states: &[[Vector; 4]]) -> Result<(), Failure> {
    let sites = silicon()?;
    let [lambda, gamma, a] = ["lambda", "gamma", "a"].map(constant);
    let mut off = vec![];
    for [y, z, ..] in states {
        // about 1.2 from the centre
        let ends = [y, z].map(|y| times((1.1 + 0.2 * length(*y)) / length(*y), *y));
        let [d12, d13] = ends.map(length);
        let cosine = dot(ends[0], ends[1]) / (d12 * d13);
        let ideal = cosine + 1.0 / 3.0;
        if ideal.abs() < 0.05 {
            continue;
        }
        let f = |d: f64| (gamma / (d - a)).exp();
        let h = lambda * f(d12) * f(d13) * ideal * ideal;
        let both = 1.0 / (d12 * d13);
        let own = |d: f64| {
            let angle = 2.0 / ideal * (both - cosine / (d * d));
            (angle - gamma / (d * (d - a) * (d - a))) * h
        };
        let printed = [own(d12), own(d13), -2.0 / ideal * both * h];
        let term = triplet(&*sites, ends)
            .ok_or_else(|| Failure::new("the engine has no term of three atoms"))?;
        let mut engine = [0.0; 3];
        for (a, b, g) in term.pulls {
            engine[(a + b) as usize - 1] += g;
        }
        off.push(crate::measure::apart(&engine, &printed) / size(&printed));
    }
    if off.len() < states.len() / 2 {
        return Err(Failure::new("too few triplets were compared"));
    }
    found.number("4.0.154", largest(off));
    Ok(())
}

/// A perfect crystal.
fn diamond(found: &mut Findings) -> Result<(), Failure> {
    let mut frame = crystal(&DIAMOND, 2, 2.59, 0.0)?;
    frame.mass.fill(1.0);
    let sites = silicon()?;
    let ends = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0]].map(|y| times(0.65, y));
    let term = triplet(&*sites, ends)
        .ok_or_else(|| Failure::new("the engine has no term of three atoms"))?;
    let ideal = term.energy.abs() / constant("lambda");
    found.holds(
        "4.0.150",
        format!("energy of a triplet at the ideal angle over λ: {ideal:.1e}; with −1/3 it would be 4/9 f²"),
        ideal < 1e-20,
    );
    let method = Method {
        coordinate: true,
        ..method(Shape::Polynomial(3), 2.0)?
    };
    let mut finite = true;
    let mut uneven = vec![];
    for velocity in [[0.0; 3], [0.3, -0.2, 0.1]] {
        frame.velocity = Some(vec![velocity; frame.position.len()]);
        let fields = evaluate(&frame, &*sites, &Targets::Grid([6; 3]), &method).map_err(failed)?;
        for quantity in Quantity::ALL {
            let values = fields.get(quantity).unwrap_or_default();
            finite &= !values.is_empty() && values.iter().all(|x| x.is_finite());
        }
        let stress = fields.get(Quantity::Stress).unwrap_or_default();
        let mean: [f64; 9] = std::array::from_fn(|c| {
            stress.iter().skip(c).step_by(9).sum::<f64>() / fields.len() as f64
        });
        let pressure = (mean[0] + mean[4] + mean[8]) / 3.0;
        let off = |c: usize| mean[c] - if c.is_multiple_of(4) { pressure } else { 0.0 };
        uneven.push(largest((0..9).map(|c| off(c).abs())) / pressure.abs());
    }
    let uneven = largest(uneven);
    found.holds(
        "4.0.155",
        format!("fields finite: {finite}; stress off the isotropic by {uneven:.1e}"),
        finite && uneven < 1e-12,
    );
    Ok(())
}
