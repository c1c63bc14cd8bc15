//! (4.0.116) to (4.0.133): the churning tensor.

use peridyne::law::terms::{Near, Sites, Term};
use peridyne_fields::specimen::{Cluster, cluster};
use peridyne_fields::{
    Fields, Frame, Method, PairForce, Partition, Quantity, Shape, Targets, evaluate,
};

use super::particles::{
    DIAMOND, FCC, Vector, crystal, failed, lennard_jones, less, method, plus, silicon, size,
    square_root, times,
};
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Churning,
    "churning",
    "Churning of potentials of many particles",
    ["../particles.rs"]
);

fn run(_: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    nothing(&mut found)?;
    three(&mut found)?;
    any(&mut found)?;
    many(&mut found)?;
    source(&mut found)?;
    Ok(found)
}

fn column(fields: &Fields, of: Quantity) -> &[f64] {
    fields.get(of).unwrap_or_default()
}

fn at(
    frame: &Frame,
    sites: &dyn Sites,
    points: &[Vector],
    method: &Method,
) -> Result<Fields, Failure> {
    evaluate(frame, sites, &Targets::Points(points.to_vec()), method).map_err(failed)
}

/// Largest component of z over that of the potential stress.
fn relative(fields: &Fields) -> f64 {
    size(column(fields, Quantity::Churning)) / size(column(fields, Quantity::StressPotential))
}

const POINTS: [Vector; 3] = [[0.1, 0.2, 0.1], [-0.4, 0.3, 0.2], [0.5, -0.6, -0.3]];

fn nothing(found: &mut Findings) -> Result<(), Failure> {
    let frame = crystal(&FCC, 3, 1.6, 0.08)?;
    let method = method(Shape::Polynomial(3), 1.5)?;
    let pairs = at(&frame, &*lennard_jones()?, &POINTS, &method)?;
    let embedded = at(&frame, &square_root(), &POINTS, &method)?;
    found.number("pairs", relative(&pairs).max(relative(&embedded)));
    let frame = crystal(&DIAMOND, 2, 2.59, 0.08)?;
    let star = Method {
        pair_force: PairForce::Differences,
        ..method
    };
    found.number(
        "choice",
        relative(&at(&frame, &*silicon()?, &POINTS, &star)?),
    );
    Ok(())
}

/// G of the three pairs ab, ac, bc.
fn pulls(sites: &Cluster, x: &[Vector]) -> [f64; 3] {
    let near = [1, 2].map(|k| Near {
        kind: k as u32,
        y: less(x[k], x[0]),
    });
    let mut pulls = [0.0; 3];
    sites.terms(0, &near, &mut |term: &Term| {
        for &(a, b, g) in &term.pulls {
            pulls[(a + b) as usize - 1] += g;
        }
    });
    pulls
}

/// What is printed in (4.0.133).
fn three(found: &mut Findings) -> Result<(), Failure> {
    let method = Method {
        partition: Partition::Equal,
        ..method(Shape::Gaussian, 0.5)?
    };
    let mut off = vec![];
    for seed in 0..10 {
        let sites = Cluster { count: 3, seed };
        let frame = cluster(3, 50 + seed);
        let x = &frame.position;
        let [ab, ac, bc] = pulls(&sites, x);
        let [xab, xac] = [1, 2].map(|k| less(x[0], x[k]));
        let fields = at(&frame, &sites, &POINTS, &method)?;
        let z = column(&fields, Quantity::Churning);
        for (point, z) in POINTS.iter().zip(z.chunks_exact(9)) {
            let beta =
                |a: usize, b: usize| method.kernel.bond(less(*point, x[b]), less(x[a], x[b]));
            let [bab, bac, bbc] = [beta(0, 1), beta(0, 2), beta(1, 2)];
            let printed: [f64; 9] = std::array::from_fn(|n| {
                let (m, v) = (n / 3, n % 3);
                (xab[m] * xab[v] * (ab - bc) * (bab - bbc)
                    + xac[m] * xac[v] * (ac - bc) * (bac - bbc)
                    + xab[m] * xac[v] * (bc - ac) * (bab - bbc)
                    + xac[m] * xab[v] * (bc - ab) * (bac - bbc))
                    / 3.0
            });
            off.push(crate::measure::apart(z, &printed) / size(&printed));
        }
    }
    found.number("4.0.133", largest(off));
    Ok(())
}

/// What is printed in (4.0.132), K from 3 to 8.
fn any(found: &mut Findings) -> Result<(), Failure> {
    let method = Method {
        partition: Partition::Equal,
        ..method(Shape::Gaussian, 0.5)?
    };
    let mut off = vec![];
    for count in 3..=8 {
        let sites = Cluster {
            count,
            seed: 40 + count as u64,
        };
        let frame = cluster(count, 60 + count as u64);
        let x = &frame.position;
        let near: Vec<Near> = (1..count)
            .map(|k| Near {
                kind: k as u32,
                y: less(x[k], x[0]),
            })
            .collect();
        let mut pull = vec![vec![0.0; count]; count];
        sites.terms(0, &near, &mut |term: &Term| {
            for &(a, b, g) in &term.pulls {
                pull[a as usize][b as usize] += g;
                pull[b as usize][a as usize] += g;
            }
        });
        let fields = at(&frame, &sites, &POINTS, &method)?;
        let z = column(&fields, Quantity::Churning);
        for (point, z) in POINTS.iter().zip(z.chunks_exact(9)) {
            let mut printed = [0.0; 9];
            for (j, k) in (0..count).flat_map(|j| (0..count).map(move |k| (j, k))) {
                if j == k {
                    continue;
                }
                let xjk = less(x[j], x[k]);
                let beta = method.kernel.bond(less(*point, x[k]), xjk);
                let mut sum = [0.0; 3];
                for p in (0..count).filter(|p| *p != j && *p != k) {
                    let ends = less(
                        times(pull[k][p], less(x[k], x[p])),
                        times(pull[j][p], less(x[j], x[p])),
                    );
                    sum = plus(sum, plus(times(pull[j][k], xjk), ends));
                }
                for (n, of) in printed.iter_mut().enumerate() {
                    *of += beta * xjk[n / 3] * sum[n % 3] / (2.0 * count as f64);
                }
            }
            off.push(crate::measure::apart(z, &printed) / size(&printed));
        }
    }
    found.number("4.0.132", largest(off));
    Ok(())
}

fn many(found: &mut Findings) -> Result<(), Failure> {
    let partitions = [Partition::Site, Partition::Equal, Partition::Centre(-0.7)];
    let (mut sums, mut orders, mut here, mut uneven) = (vec![], vec![], vec![], vec![]);
    for count in 3..=8 {
        let sites = Cluster {
            count,
            seed: 40 + count as u64,
        };
        let frame = cluster(count, 2);
        for partition in &partitions {
            let method = Method {
                partition: partition.clone(),
                ..method(Shape::Gaussian, 0.4)?
            };
            let fields = at(&frame, &sites, &POINTS, &method)?;
            sums.push(size(&fields.totals.churning) / size(&fields.totals.virial));
            here.push(relative(&fields));
            let z = column(&fields, Quantity::Churning);
            let odd = z
                .chunks_exact(9)
                .flat_map(|z| [(1, 3), (2, 6), (5, 7)].map(|(a, b)| 0.5 * (z[a] - z[b]).abs()));
            uneven.push(largest(odd) / size(z));
        }
        let wide = |width: f64| -> Result<f64, Failure> {
            let method = Method {
                partition: Partition::Equal,
                ..method(Shape::Gaussian, width)?
            };
            Ok(relative(&at(&frame, &sites, &POINTS[..1], &method)?))
        };
        orders.push(((wide(20.0)? / wide(40.0)?).log2() - 2.0).abs());
    }
    let least = |of: &[f64]| of.iter().fold(f64::INFINITY, |m, x| m.min(*x));
    let sum = largest(sums);
    found.holds(
        "conjecture",
        format!("∫z over ∫σ_U: {sum:.1e} at most"),
        sum < 1e-12,
    );
    found.number("order", largest(orders));
    let (small, odd) = (least(&here), least(&uneven));
    found.holds(
        "microscopic",
        format!("at least {small:.2} of stress, antisymmetric at least {odd:.2} of it"),
        small > 0.01 && odd > 0.01,
    );
    Ok(())
}

/// Derivatives of a column of the fields at a point and its neighbours at ±h and ±2h along each axis.
fn slope(column: &[f64], n: usize, c: usize, axis: usize, h: f64) -> f64 {
    let of = |k: usize| column[(1 + 4 * axis + k) * n + c];
    (8.0 * (of(0) - of(1)) - (of(2) - of(3))) / (12.0 * h)
}

fn source(found: &mut Findings) -> Result<(), Failure> {
    let frame = crystal(&DIAMOND, 2, 2.59, 0.08)?;
    let method = Method {
        partition: Partition::Equal,
        ..method(Shape::Polynomial(5), 1.6)?
    };
    let h = 0.01;
    let x = [2.4, 2.5, 2.9];
    let mut points = vec![x];
    for axis in 0..3 {
        for n in [1.0, -1.0, 2.0, -2.0] {
            let unit = std::array::from_fn(|a| if a == axis { 1.0 } else { 0.0 });
            points.push(plus(x, times(n * h, unit)));
        }
    }
    let fields = at(&frame, &*silicon()?, &points, &method)?;
    let z = column(&fields, Quantity::Churning);
    let (mut divergence, mut gradient) = (vec![], vec![]);
    for b in 0..3 {
        divergence.push(
            (0..3)
                .map(|a| slope(z, 9, 3 * a + b, a, h))
                .sum::<f64>()
                .abs(),
        );
        gradient.extend((0..9).map(|n| slope(z, 9, 3 * (n / 3) + b, n % 3, h).abs()));
    }
    found.number("4.0.119", largest(divergence) / largest(gradient));
    let q = column(&fields, Quantity::HeatChurning);
    let flux: f64 = (0..3).map(|a| slope(q, 3, a, a, h)).sum();
    let source = column(&fields, Quantity::ChurningSource);
    let source = source.first().copied().unwrap_or(f64::NAN);
    found.number("4.0.143", ((flux - source) / source).abs());
    Ok(())
}
