//! A fan term by term: pairs and triples where that is what it is, else each bond with all that weaken it.

use super::{Arm, ManyBody};
use crate::law::number::{Dual, Number};
use crate::law::slopes::Slopes;
use crate::law::terms::{Near, Sites, Term};

/// A fan as terms of sites.
#[derive(Debug, Clone)]
pub struct ManyBodySites<F>(pub F);

/// A particle within the cut-off.
struct End<'a> {
    /// Number in the term.
    number: u32,
    near: &'a Near,
    arm: Arm<Dual<f64>>,
}

/// ξ between two that are near.
pub(super) fn closing(a: &Near, b: &Near) -> f64 {
    let square: f64 = (0..3).map(|c| (a.y[c] - b.y[c]).powi(2)).sum();
    0.5 * square
}

impl<F: ManyBody> ManyBodySites<F> {
    /// Rows of a kind; constants of one kind do not tell kinds apart.
    fn place(&self, kind: u32) -> usize {
        match self.0.table().kinds() {
            1 => 0,
            _ => kind as usize,
        }
    }

    fn ends<'a>(&self, kind: usize, near: &'a [Near]) -> Vec<End<'a>> {
        let limit = self.0.cutoff() * self.0.cutoff();
        let all = near.iter().enumerate();
        all.filter(|(_, n)| n.square() < limit)
            .map(|(n, near)| {
                let other = self.place(near.kind);
                let row = self.0.table().at([kind, other, other]);
                let xi = Dual::variable(0.5 * near.square());
                End {
                    number: n as u32 + 1,
                    near,
                    arm: self.0.arm::<f64, _>(xi, row),
                }
            })
            .collect()
    }

    /// z of two ends, by ξ of both and of what closes the triangle.
    fn share(&self, kind: usize, j: &End, k: &End) -> Slopes<f64, 3> {
        let kinds = [kind, self.place(j.near.kind), self.place(k.near.kind)];
        let closing = Slopes::nth(closing(j.near, k.near), 2);
        let (ij, ik) = (j.arm.along(0), k.arm.along(1));
        self.0
            .share::<f64, _>(&ij, &ik, closing, self.0.table().at(kinds))
    }

    /// h of an end, by ξ and ζ.
    fn bond(&self, kind: usize, j: &End, zeta: f64) -> Slopes<f64, 2> {
        let other = self.place(j.near.kind);
        let row = self.0.table().at([kind, other, other]);
        self.0
            .bond::<f64, _>(&j.arm.along(0), Slopes::nth(zeta, 1), row)
    }
}

fn ordered(a: u32, b: u32, g: f64) -> (u32, u32, f64) {
    (a.min(b), a.max(b), g)
}

impl<F: ManyBody> Sites for ManyBodySites<F> {
    fn reach(&self) -> f64 {
        self.0.cutoff()
    }

    fn parts(&self) -> Vec<String> {
        match F::TRIPLES {
            Some(_) => vec!["pair".into(), "triple".into()],
            None => vec!["bond".into()],
        }
    }

    fn terms(&self, kind: u32, near: &[Near], visit: &mut dyn FnMut(&Term)) {
        let kind = self.place(kind);
        let ends = self.ends(kind, near);
        let mut term = Term::default();
        for (n, j) in ends.iter().enumerate() {
            if j.arm.weight.value == 0.0 {
                continue;
            }
            let others = || ends.iter().enumerate().filter(|(m, _)| *m != n);
            if let Some(multiple) = F::TRIPLES {
                let pair = self.bond(kind, j, 0.0);
                term.begin(0);
                term.energy = pair.value;
                term.particles.push(j.number);
                term.pulls.push((0, j.number, pair.slope[0]));
                visit(&term);
                for (_, k) in others().filter(|(m, _)| *m < n) {
                    if k.arm.weight.value == 0.0 {
                        continue;
                    }
                    let z = self.share(kind, j, k).times(2.0 * multiple);
                    term.begin(1);
                    term.energy = z.value;
                    term.particles.extend([j.number, k.number]);
                    term.pulls.push((0, j.number, z.slope[0]));
                    term.pulls.push((0, k.number, z.slope[1]));
                    term.pulls.push(ordered(j.number, k.number, z.slope[2]));
                    visit(&term);
                }
                continue;
            }
            let mut shares: Vec<_> = others()
                .map(|(_, k)| (k.number, self.share(kind, j, k)))
                .collect();
            let zeta = shares.iter().map(|(_, z)| z.value).sum();
            let h = self.bond(kind, j, zeta);
            // the bond depends on those alone that weaken it: the cut-off of its triples may be shorter than that of others
            let counts = |x: &f64| *x != 0.0;
            shares.retain(|(_, z)| {
                counts(&h.slope[1]) && (counts(&z.value) || z.slope.iter().any(counts))
            });
            term.begin(0);
            term.energy = h.value;
            term.particles.push(j.number);
            let own: f64 = shares.iter().map(|(_, z)| z.slope[0]).sum();
            term.pulls
                .push((0, j.number, h.slope[0] + h.slope[1] * own));
            for (k, z) in shares {
                term.particles.push(k);
                term.pulls.push((0, k, h.slope[1] * z.slope[1]));
                term.pulls
                    .push(ordered(j.number, k, h.slope[1] * z.slope[2]));
            }
            visit(&term);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::described::make;
    use super::super::stillinger_weber::StillingerWeber;
    use super::super::tangents;
    use super::super::tersoff::Tersoff;
    use super::*;
    use crate::samples::Random;
    use crate::spec::Parameters;

    const SILICON: [(&str, f64); 10] = [
        ("epsilon", 2.1683),
        ("sigma", 2.0951),
        ("a", 1.80),
        ("lambda", 21.0),
        ("gamma", 1.20),
        ("cos_theta0", -0.333333333333),
        ("A", 7.049556277),
        ("B", 0.6022245584),
        ("p", 4.0),
        ("q", 0.0),
    ];
    /// Tersoff 1988.
    const T2: [(&str, f64); 14] = [
        ("m", 3.0),
        ("gamma", 1.0),
        ("lambda3", 1.3258),
        ("c", 4.8381),
        ("d", 2.0417),
        ("cos_theta0", 0.0),
        ("n", 22.956),
        ("beta", 0.33675),
        ("lambda2", 1.3258),
        ("B", 95.373),
        ("R", 3.0),
        ("D", 0.2),
        ("lambda1", 3.2394),
        ("A", 3264.7),
    ];

    fn weber() -> ManyBodySites<StillingerWeber> {
        ManyBodySites(make(&Parameters::numbers(&SILICON)).unwrap())
    }

    fn tersoff() -> ManyBodySites<Tersoff> {
        ManyBodySites(make(&Parameters::numbers(&T2)).unwrap())
    }

    /// Five atoms about a centre, two of them far enough for cut-offs to count.
    fn near() -> Vec<Near> {
        let mut random = Random(3);
        let mut at = |y: [f64; 3]| Near {
            kind: 0,
            y: y.map(|y| 1.3 * (y + 0.1 * random.next())),
        };
        vec![
            at([1.0, 1.0, 1.1]),
            at([-1.0, -1.0, 1.0]),
            at([1.0, -1.0, -1.1]),
            at([-1.2, 1.3, -1.2]),
            at([0.1, 2.3, 0.2]),
            at([9.0, 0.0, 0.0]),
        ]
    }

    fn energy(sites: &dyn Sites, near: &[Near]) -> f64 {
        let mut sum = 0.0;
        sites.terms(0, near, &mut |t| sum += t.energy);
        sum
    }

    /// Forces on the centre and on all that are near.
    fn forces(sites: &dyn Sites, near: &[Near]) -> Vec<[f64; 3]> {
        let mut force = vec![[0.0; 3]; near.len() + 1];
        let place = |n: u32| match n {
            0 => [0.0; 3],
            n => near[n as usize - 1].y,
        };
        sites.terms(0, near, &mut |t| {
            for &(a, b, g) in &t.pulls {
                assert!(a < b && t.particles.contains(&a) && t.particles.contains(&b));
                let (x, y) = (place(a), place(b));
                for c in 0..3 {
                    let f = -g * (x[c] - y[c]);
                    force[a as usize][c] += f;
                    force[b as usize][c] -= f;
                }
            }
        });
        force
    }

    fn moved(near: &[Near], n: usize, c: usize, step: f64) -> Vec<Near> {
        let mut near = near.to_vec();
        near[n].y[c] += step;
        near
    }

    /// Terms against differences of the energy, and tangents against those of forces.
    fn check<F: ManyBody>(sites: &ManyBodySites<F>) {
        let near = near();
        assert!(energy(sites, &near).abs() > 0.1);
        let force = forces(sites, &near);
        let mut blocks = vec![[[0.0; 3]; 3]; 49];
        let mut pulled = [[0.0; 3]; 7];
        tangents(&sites.0, 0, &near, &mut |t| {
            let (a, b) = (t.a as usize, t.b as usize);
            for c in 0..3 {
                pulled[a][c] += t.pull * t.y[c];
                pulled[b][c] -= t.pull * t.y[c];
                for d in 0..3 {
                    blocks[7 * a + b][c][d] += t.block[c][d];
                    blocks[7 * b + a][d][c] += t.block[c][d];
                }
            }
        });
        for n in 0..near.len() {
            for c in 0..3 {
                let at = |h: f64| energy(sites, &moved(&near, n, c, h));
                let slope = (8.0 * (at(1e-4) - at(-1e-4)) - (at(2e-4) - at(-2e-4))) / 12e-4;
                assert!(
                    (slope + force[n + 1][c]).abs() < 2e-9 * (1.0 + slope.abs()),
                    "{n} {c}: {slope} {}",
                    force[n + 1][c]
                );
                let at = |h: f64| forces(sites, &moved(&near, n, c, h));
                let [p, m] = [at(1e-4), at(-1e-4)];
                let [pp, mm] = [at(2e-4), at(-2e-4)];
                for a in 0..=near.len() {
                    for d in 0..3 {
                        assert!((pulled[a][d] - force[a][d]).abs() < 1e-12);
                        if a == n + 1 {
                            continue;
                        }
                        let by = (8.0 * (p[a][d] - m[a][d]) - (pp[a][d] - mm[a][d])) / 12e-4;
                        let block = blocks[7 * a + n + 1][d][c];
                        assert!(
                            (by - block).abs() < 2e-8 * (1.0 + by.abs()),
                            "{a} {d} by {n} {c}: {by} {block}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn pulls_and_tangents_are_slopes() {
        check(&weber());
        check(&tersoff());
    }

    /// Two materials may have the same constants, and masses of their own.
    #[test]
    fn isotopes_are_of_one_kind() {
        let sites = weber();
        let mut other = near();
        other.iter_mut().step_by(2).for_each(|n| n.kind = 1);
        let mut sum = 0.0;
        sites.terms(1, &other, &mut |t| sum += t.energy);
        assert_eq!(sum, energy(&sites, &near()));
    }

    /// Who writes slopes out means those of the text.
    fn slopes_of_shares<F: ManyBody>(sites: &ManyBodySites<F>) {
        let near = near();
        let ends = sites.ends(0, &near);
        for (j, k) in ends.iter().flat_map(|j| ends.iter().map(move |k| (j, k))) {
            if j.number == k.number {
                continue;
            }
            let (text, row) = (sites.share(0, j, k), sites.0.table().at([0; 3]));
            let closing = closing(j.near, k.near);
            let written = sites.0.share_slopes::<f64>(&j.arm, &k.arm, closing, row);
            let scale = 1e-14 * (1.0 + text.value.abs());
            assert!((written.value - text.value).abs() < scale);
            for (a, b) in written.slope.iter().zip(text.slope) {
                assert!((a - b).abs() < 1e-13 * (1.0 + b.abs()), "{a} {b}");
            }
        }
    }

    #[test]
    fn slopes_are_those_of_the_text() {
        slopes_of_shares(&weber());
        slopes_of_shares(&tersoff());
    }

    /// sandia2010 (4.0.155) is 0·∞ there as printed.
    #[test]
    fn a_perfect_tetrahedron_is_at_rest() {
        let sites = weber();
        let r = 0.25 * 5.431;
        let corners = [
            [1.0, 1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ];
        let near = corners.map(|y| Near {
            kind: 0,
            y: y.map(|y| r * y),
        });
        let mut triples = 0;
        sites.terms(0, &near, &mut |t| {
            assert!(t.pulls.iter().all(|p| p.2.is_finite()));
            if t.part == 1 {
                triples += 1;
                assert_eq!(t.particles.len(), 3);
                assert!(t.energy.abs() < 1e-20);
            }
        });
        assert_eq!(triples, 6);
        // the cohesive energy is 2 ε, to the digits of the constants
        assert!((energy(&sites, &near) + 2.0 * 2.1683).abs() < 1e-4);
        for f in forces(&sites, &near)[0] {
            assert!(f.abs() < 1e-12);
        }
    }

    /// A bond that nobody weakens is one of two atoms, however far the longest cut-off reaches.
    #[test]
    fn terms_are_of_those_that_they_depend_on() {
        let of = |sites: &ManyBodySites<Tersoff>, near: &[[f64; 3]]| {
            let near: Vec<Near> = near.iter().map(|y| Near { kind: 0, y: *y }).collect();
            let mut all = vec![];
            sites.terms(0, &near, &mut |t| all.push(t.particles.clone()));
            all
        };
        let mut sites = tersoff();
        assert_eq!(
            of(&sites, &[[2.4, 0.0, 0.0], [0.0, 2.5, 0.0]]),
            [[0, 1, 2], [0, 2, 1]]
        );
        // as if another kind of atom reached farther
        sites.0 = sites.0.reaching(5.0);
        assert_eq!(of(&sites, &[[2.0, 0.0, 0.0], [0.0, 4.0, 0.0]]), [[0, 1]]);
    }

    /// The cut-off is smooth: beyond it nothing, just before it next to nothing.
    #[test]
    fn cut_offs_leave_nothing() {
        let sites = tersoff();
        let at = |r: f64| {
            [Near {
                kind: 0,
                y: [r, 0.0, 0.0],
            }]
        };
        assert_eq!(energy(&sites, &at(3.2)), 0.0);
        // f_C is ¼ (½π x/D)² so near to its end, and half a bond less than an eV
        assert!(energy(&sites, &at(3.2 - 1e-6)).abs() < 0.25 * (1.571e-6 / 0.2f64).powi(2));
        let sites = weber();
        let edge = 1.8 * 2.0951;
        assert!(energy(&sites, &at(edge - 1e-3)).abs() < 1e-12);
        assert_eq!(energy(&sites, &at(edge + 1e-9)), 0.0);
    }
}
