//! Second derivatives of a fan, by pairs of its particles.

use super::sites::closing;
use super::{Arm, ManyBody};
use crate::law::blocks::{PairTangent, Quadratic, place};
use crate::law::slopes::Curved;
use crate::law::terms::Near;

/// Every pair of particles of a fan that is within its cut-off, once; 0 is the centre, n + 1 the n-th of those that are near.
pub fn tangents<F: ManyBody>(
    many_body: &F,
    kind: u32,
    near: &[Near],
    visit: &mut dyn FnMut(PairTangent<3>),
) {
    let limit = many_body.cutoff() * many_body.cutoff();
    let within = |n: &usize| near[*n].square() < limit;
    let ends: Vec<usize> = (0..near.len()).filter(within).collect();
    let inside: Vec<Near> = ends.iter().map(|n| near[*n]).collect();
    let mut at = vec![[0.0; 3]];
    at.extend(inside.iter().map(|n| n.y));
    let number = |a: u32| match a {
        0 => 0,
        a => ends[a as usize - 1] as u32 + 1,
    };
    second_derivatives(many_body, kind, &inside).visit(&at, &mut |pair| {
        visit(PairTangent {
            a: number(pair.a),
            b: number(pair.b),
            ..pair
        });
    });
}

/// Derivatives of a fan's energy by ξ of all pairs of its particles: 0 is the centre, n + 1 the n-th of those that are near, all of
/// which are within the cut-off.
pub fn second_derivatives<F: ManyBody>(many_body: &F, kind: u32, near: &[Near]) -> Quadratic {
    let n = near.len();
    let mut all = Quadratic::new(n + 1);
    let pairs = all.pairs();
    let table = many_body.table();
    let kinds = |j: usize, k: usize| {
        let of = [kind, near[j].kind, near[k].kind];
        table.at(of.map(|k| k as usize))
    };
    let xi = |j: usize| 0.5 * near[j].square();
    for j in 0..n {
        let arm = |k: usize, number: usize| -> Arm<Curved<3>> {
            many_body.arm::<f64, _>(Curved::variable(xi(k), number), kinds(k, k))
        };
        let share = |k: usize| {
            let closing = Curved::variable(closing(&near[j], &near[k]), 2);
            many_body.share::<f64, _>(&arm(j, 0), &arm(k, 1), closing, kinds(j, k))
        };
        let others = (0..n).filter(|k| *k != j);
        let shares: Vec<(usize, Curved<3>)> = others.map(|k| (k, share(k))).collect();
        let zeta: f64 = shares.iter().map(|(_, z)| z.value).sum();
        let own = many_body.arm::<f64, _>(Curved::<2>::variable(xi(j), 0), kinds(j, j));
        let h = many_body.bond::<f64, _>(&own, Curved::variable(zeta, 1), kinds(j, j));
        // particles are counted from the centre on
        let bond = place(0, j + 1);
        // ζ by all ξ
        let mut slope = vec![0.0; pairs];
        for (k, z) in &shares {
            let of = [bond, place(0, k + 1), place(j + 1, k + 1)];
            for (p, s) in of.iter().zip(z.slope) {
                slope[*p] += s;
            }
            all.add(&of, &z.slope, |m, n| z.curvature[m][n], h.slope[1]);
        }
        all.add(&[bond], &h.slope[..1], |_, _| h.curvature[0][0], 1.0);
        for p in 0..pairs {
            all.second[p * pairs + bond] += h.curvature[0][1] * slope[p];
            all.second[bond * pairs + p] += h.curvature[0][1] * slope[p];
            for q in 0..pairs {
                all.second[p * pairs + q] += h.curvature[1][1] * slope[p] * slope[q];
            }
        }
    }
    all
}
