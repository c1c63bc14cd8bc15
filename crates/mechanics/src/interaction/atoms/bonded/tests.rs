use super::*;
use crate::body::{Field, FieldView, view, view_mut};
use crate::interaction::atoms::current::CurrentAtoms;
use crate::law::bonded::{Wave, cosine_powers};
use crate::law::jet::Jet;
use crate::law::potential::Potential;
use crate::law::potential::cut::{Cut, Ends};
use crate::law::potential::lennard_jones::LennardJones;
use crate::law::potential::mixture::Mixture;
use crate::samples::Random;
use crate::spec::{BondedTerm, End, Form};

/// Chains of five in a periodic box, some across its faces, and what bonds them.
fn chains() -> (Body<3>, Arc<BondedSpec>) {
    let (length, chains) = (9.0, 6);
    let mut random = Random(11);
    let mut x = vec![];
    let mut terms = vec![];
    for c in 0..chains {
        // apart from each other, and some across a face
        let start = [
            2.0 * f64::from(c),
            3.0 * f64::from(c % 3),
            4.5 * f64::from(c / 3) + 0.2,
        ];
        for n in 0..5 {
            let zigzag = if n % 2 == 0 { 0.0 } else { 0.8 };
            let at = [1.25 * f64::from(n), zigzag, 0.3 * f64::from(n % 3)];
            x.push(crate::array::from_fn(|a| {
                (start[a] + at[a] + 0.1 * random.next()).rem_euclid(length)
            }));
        }
        let first = 5 * c;
        for n in 0..4 {
            terms.push((0, [first + n, first + n + 1, 0, 0]));
        }
        for n in 0..3 {
            let form = if n == 1 { 2 } else { 1 };
            terms.push((form, [first + n, first + n + 1, first + n + 2, 0]));
        }
        for n in 0..2 {
            terms.push((3, [first + n, first + n + 1, first + n + 2, first + n + 3]));
        }
    }
    let wave = |strength, times, opposite| Wave {
        strength,
        times,
        opposite,
    };
    let spec = BondedSpec {
        forms: vec![
            Form::HarmonicBond {
                stiffness: 80.0,
                length: 1.5,
            },
            Form::HarmonicAngle {
                stiffness: 20.0,
                angle: 1.95,
            },
            Form::CosineSquaredAngle {
                stiffness: 12.0,
                cosine: -0.3,
            },
            Form::Dihedral {
                powers: cosine_powers(&[
                    wave(0.7, 1, false),
                    wave(0.4, 2, true),
                    wave(1.1, 3, false),
                ]),
            },
        ],
        terms: { terms.into_iter() }
            .map(|(form, points)| BondedTerm { form, points })
            .collect(),
        special: [0.0, 0.0, 0.5],
    };
    let volume = vec![1.0; x.len()];
    let body = Body::<3>::from_cloud(&x, &volume, &[], 1.0, [Some(length); 3]).unwrap();
    (body, Arc::new(spec))
}

fn potential() -> Cut<LennardJones> {
    let lj = LennardJones {
        epsilon: 0.4,
        sigma: 1.4,
    };
    let ends = Ends {
        cutoff: 3.5,
        end: End::Smooth(2.5),
    };
    Cut::new(lj, ends)
}

fn bonded(body: &Body<3>, spec: &Arc<BondedSpec>) -> BondedAtoms<3> {
    let simd = Simd::detect();
    let inner = Box::new(CurrentAtoms::new(body, Mixture::one(potential()), simd));
    let pair = potential();
    let pair: Box<PairEnergy> = Box::new(move |_, q| {
        (q < 3.5 * 3.5).then(|| pair.pair(Jet::<3>::variable(q)).derivatives())
    });
    BondedAtoms::new(inner, body, spec.clone(), pair, simd)
}

fn forces(made: &mut BondedAtoms<3>, body: &Body<3>, u: FieldView<3>) -> Vec<[f64; 3]> {
    let mut f = body.at_rest();
    let sweep = Sweep::Hold;
    made.forces(body, u, view_mut(&mut f), sweep, None);
    let slots = body.slots.iter().map(|s| *s as usize);
    slots.map(|s| crate::array::from_fn(|a| f[a][s])).collect()
}

fn moved(u: &Field<3>, slot: usize, a: usize, h: f64) -> Field<3> {
    let mut u = u.clone();
    u[a][slot] += h;
    u
}

#[test]
fn forces_are_slopes_of_the_energy() {
    let (body, spec) = chains();
    let mut made = bonded(&body, &spec);
    let u = body.at_rest();
    let f = forces(&mut made, &body, view(&u));
    let size = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    for (n, f) in f.iter().enumerate() {
        let slot = body.slots[n] as usize;
        for a in 0..3 {
            let mut at = |h| made.energy(&body, view(&moved(&u, slot, a, h)))[0];
            let slope = (8.0 * (at(1e-4) - at(-1e-4)) - (at(2e-4) - at(-2e-4))) / 12e-4;
            assert!(
                (slope + f[a]).abs() < 1e-8 * size,
                "{n} {a}: {slope} {}",
                f[a]
            );
        }
    }
    // the energies of points are all of it
    let mut seen = crate::interaction::PointEnergies::default();
    made.observe(&body, view(&u), &mut seen.for_slots(body.len));
    let sum: f64 = body.slots.iter().map(|s| seen.strain[*s as usize]).sum();
    let whole = made.energy(&body, view(&u))[0];
    assert!((sum - whole).abs() < 1e-11 * whole.abs());
}

#[test]
fn tangents_are_slopes_of_forces() {
    let (body, spec) = chains();
    let mut made = bonded(&body, &spec);
    let u = body.at_rest();
    let n = body.points();
    let mut point = vec![0; body.len];
    for (n, s) in body.slots.iter().enumerate() {
        point[*s as usize] = n;
    }
    let mut block = vec![[[0.0; 3]; 3]; n * n];
    let mut pulled = vec![[0.0; 3]; n];
    made.tangents(&body, view(&u), &mut |bond| {
        let (i, j) = (point[bond.i], point[bond.j]);
        for a in 0..3 {
            pulled[i][a] += bond.tension * bond.y[a];
            for b in 0..3 {
                block[n * i + j][a][b] += bond.stiffness[a][b];
            }
        }
    });
    let f = forces(&mut made, &body, view(&u));
    let size = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let stiff = block
        .iter()
        .flatten()
        .flatten()
        .fold(0.0f64, |m, x| m.max(x.abs()));
    for (f, pulled) in f.iter().zip(&pulled) {
        assert!((0..3).all(|a| (f[a] - pulled[a]).abs() < 1e-10 * size));
    }
    for j in 0..n {
        for b in 0..3 {
            let mut at = |h| {
                forces(
                    &mut made,
                    &body,
                    view(&moved(&u, body.slots[j] as usize, b, h)),
                )
            };
            let [p, m, pp, mm] = [at(1e-4), at(-1e-4), at(2e-4), at(-2e-4)];
            for i in (0..n).filter(|i| *i != j) {
                for a in 0..3 {
                    let by = (8.0 * (p[i][a] - m[i][a]) - (pp[i][a] - mm[i][a])) / 12e-4;
                    let found = block[n * i + j][a][b];
                    assert!((by - found).abs() < 1e-7 * stiff, "{i} {j}: {by} {found}");
                }
            }
        }
    }
}

/// Of a free body, so that all can be stretched.
#[test]
fn the_virial_is_the_slope_by_strain() {
    let (_, spec) = chains();
    let x: Vec<[f64; 3]> = (0..30u32)
        .map(|n| {
            let zigzag = if n % 2 == 0 { 0.0 } else { 0.8 };
            let row = f64::from(n / 5);
            [
                1.25 * f64::from(n % 5),
                zigzag + 2.5 * row,
                0.3 * f64::from(n % 3),
            ]
        })
        .collect();
    let body = Body::<3>::from_cloud(&x, &[1.0; 30], &[], 1.0, [None; 3]).unwrap();
    let mut made = bonded(&body, &spec);
    let virial = made.virial(&body, view(&body.at_rest())).unwrap();
    let size = virial.iter().fold(1.0f64, |m, x| m.max(x.abs()));
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    for (n, (a, b)) in pairs.into_iter().enumerate() {
        let mut at = |h: f64| {
            let mut u = body.at_rest();
            for (x, s) in x.iter().zip(&body.slots) {
                u[a][*s as usize] += h * x[b];
            }
            made.energy(&body, view(&u))[0]
        };
        let slope = (8.0 * (at(1e-5) - at(-1e-5)) - (at(2e-5) - at(-2e-5))) / 12e-5;
        assert!(
            (slope + virial[n]).abs() < 1e-7 * size,
            "{n}: {slope} {}",
            virial[n]
        );
    }
}

#[test]
fn the_number_of_threads_does_not_show() {
    let (body, spec) = chains();
    let of = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let mut made = bonded(&body, &spec);
            forces(&mut made, &body, view(&body.at_rest()))
        })
    };
    assert!(of(1) == of(3));
}
