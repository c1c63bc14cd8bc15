//! Bodies for tests, and what is done with them.

use super::super::block::{add, largest};
use super::super::lattice::LatticeBlock;
use peridyne::spec::LinearBody;
use peridyne::statics::{Direct, Support};

/// Points of a lattice of unit spacing, bonds up to `reach` (closed) of stiffness `k(i, j)/|ξ|`, volumes 1.
pub fn lattice<const D: usize>(
    size: [usize; D],
    reach: f64,
    periodic: bool,
    k: impl Fn([i64; D], [i64; D]) -> f64,
) -> LinearBody<D> {
    let block = LatticeBlock::new(size, 1.0, reach);
    let block = if periodic { block.periodic() } else { block };
    block.body(
        |_| true,
        |i, n| {
            let j = block.wrapped(std::array::from_fn(|a| i[a] + n[a])).unwrap();
            k(i, j) / (n.iter().map(|n| n * n).sum::<i64>() as f64).sqrt()
        },
    )
}

/// A chain of unit spacing, `springs[j − 1]` between points j apart.
pub fn chain(points: usize, springs: &[f64]) -> LinearBody<1> {
    LatticeBlock::new([points], 1.0, springs.len() as f64)
        .body(|_| true, |_, n| springs[n[0].unsigned_abs() as usize - 1])
}

/// The tent of example 1 in units of v: `1 − j/10`.
pub fn tent(points: usize) -> LinearBody<1> {
    let springs: Vec<f64> = (1..10).map(|j| 1.0 - f64::from(j) / 10.0).collect();
    chain(points, &springs)
}

/// Hard and soft at random, from a seed.
pub fn random<const D: usize>(size: [usize; D], periodic: bool, contrast: f64) -> LinearBody<D> {
    let hard = |x: [i64; D]| {
        let key = x
            .iter()
            .fold(7u64, |h, x| super::super::select::mixed(h ^ *x as u64));
        key.is_multiple_of(2)
    };
    lattice(size, 2.5, periodic, |x, y| match hard(x) && hard(y) {
        true => contrast,
        false => 1.0,
    })
}

/// A plate of a state-based law on a free square lattice: bonds of stiffness 1 and a pressure on the mean stretch of each point's
/// family, whose micromoduli are not central and reach two horizons.
pub fn state_based(size: [usize; 2], bulk: f64) -> LinearBody<2> {
    let bonds = lattice(size, 2.0, false, |_, _| 1.0);
    let n = bonds.points();
    let mut k = vec![vec![[[0.0; 2]; 2]; n]; n];
    for i in 0..n {
        let (partners, blocks) = bonds.row(i);
        for (j, c) in partners.iter().zip(blocks) {
            add(&mut k[i][*j as usize], c);
        }
        // ϑ_i = Σ_j n_ij·(u_j − u_i), energy ½ bulk ϑ²: force on p is −bulk ϑ g_p, g_j = n_ij, g_i = −Σ n_ij
        let mut g: Vec<(usize, [f64; 2])> = vec![(i, [0.0; 2])];
        for j in partners {
            let xi = bonds.xi(i, *j as usize);
            let r = (xi[0] * xi[0] + xi[1] * xi[1]).sqrt();
            let unit = xi.map(|x| x / r);
            g[0].1[0] -= unit[0];
            g[0].1[1] -= unit[1];
            g.push((*j as usize, unit));
        }
        for (p, a) in &g {
            for (q, b) in &g {
                for (m, a) in a.iter().enumerate() {
                    for (l, b) in b.iter().enumerate() {
                        k[*p][*q][m][l] -= bulk * a * b;
                    }
                }
            }
        }
    }
    let mut body = LinearBody {
        start: vec![0],
        partner: vec![],
        block: vec![],
        ..bonds
    };
    for (i, row) in k.iter().enumerate() {
        for (j, c) in row.iter().enumerate() {
            if i != j && largest(c) > 0.0 {
                body.partner.push(j as u32);
                body.block.push(*c);
            }
        }
        body.start.push(body.partner.len());
    }
    body
}

/// Equilibrium under body force densities with some points held at given displacements.
pub fn equilibrium<const D: usize>(
    body: &LinearBody<D>,
    held: &[(usize, [f64; D])],
    density: &[[f64; D]],
) -> Vec<[f64; D]> {
    let mut support = Support::none(body.points());
    let mut given = vec![[0.0; D]; body.points()];
    for (i, u) in held {
        support.free[*i] = [false; D];
        given[*i] = *u;
    }
    let force: Vec<[f64; D]> = (0..body.points())
        .map(|i| {
            let f = body.force(&given, i);
            std::array::from_fn(|a| body.volume[i] * (f[a] + density[i][a]))
        })
        .collect();
    let mut u = Direct::new(body, &support, 0.0).unwrap().solve(&force);
    for (i, given) in held {
        u[*i] = *given;
    }
    u
}

/// Largest difference of components over the largest of `b`.
pub fn apart<const D: usize>(a: &[[f64; D]], b: &[[f64; D]]) -> f64 {
    let most = b.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let off = a.as_flattened().iter().zip(b.as_flattened());
    off.fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) / most
}

/// Largest difference of micromoduli of any two points over the largest.
pub fn unlike<const D: usize>(a: &LinearBody<D>, b: &LinearBody<D>) -> f64 {
    assert_eq!(a.position, b.position);
    let most = b.block.iter().map(largest).fold(0.0, f64::max);
    let mut off = 0.0f64;
    for i in 0..a.points() {
        for j in (0..a.points()).filter(|j| *j != i) {
            let c = |x: &LinearBody<D>| x.micromodulus(i, j).copied().unwrap_or([[0.0; D]; D]);
            let mut difference = c(a);
            add(&mut difference, &c(b).map(|r| r.map(|x| -x)));
            off = off.max(largest(&difference));
        }
    }
    off / most
}
