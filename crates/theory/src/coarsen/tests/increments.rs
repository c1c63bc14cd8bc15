//! Increments of nonlinear bodies: networks of springs `T = k g(λ)`, λ their stretch, that turn as they like.

use super::super::block::Block;
use super::super::increments::{
    Increment, IncrementError, Increments, Linear, Load, Nonlinear, Plan, Removed,
};
use super::super::{CoarsenError, Options, Radius, Scheme, Selection, coarsen};
use super::bodies::{apart, equilibrium, random};
use peridyne::error::SolveError;
use peridyne::spec::{LinearBody, LoadMap};

/// `g` and `g′`.
type Law = fn(f64) -> [f64; 2];

/// Of a thread of rubber: `λ − λ⁻²`.
fn rubber(x: f64) -> [f64; 2] {
    [x - 1.0 / (x * x), 1.0 + 2.0 / (x * x * x)]
}

/// It bears at most 1/(4 e), at λ = 1 + 1/4.
fn soft(x: f64) -> [f64; 2] {
    let (s, fades) = (x - 1.0, f64::exp(-4.0 * (x - 1.0)));
    [s * fades, (1.0 - 4.0 * s) * fades]
}

/// A network of springs; points have volume 1.
struct Net<const D: usize> {
    position: Vec<[f64; D]>,
    /// Ends, and k.
    springs: Vec<(usize, usize, f64)>,
    law: Law,
    /// Stretch at which a spring breaks.
    critical: f64,
}

impl<const D: usize> Net<D> {
    /// End to end at displacements u: unit vector and λ, and the length at rest.
    fn stretched(&self, u: &[[f64; D]], i: usize, j: usize) -> ([f64; D], f64, f64) {
        let xi: [f64; D] = std::array::from_fn(|a| self.position[j][a] - self.position[i][a]);
        let y: [f64; D] = std::array::from_fn(|a| xi[a] + u[j][a] - u[i][a]);
        let size = |x: &[f64; D]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (rest, now) = (size(&xi), size(&y));
        (y.map(|y| y / now), now / rest, rest)
    }
}

impl<const D: usize> Nonlinear<D> for Net<D> {
    fn forces(&mut self, u: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut f = vec![[0.0; D]; u.len()];
        for &(i, j, k) in &self.springs {
            let (n, stretch, _) = self.stretched(u, i, j);
            let pull = k * (self.law)(stretch)[0];
            for a in 0..D {
                f[i][a] += pull * n[a];
                f[j][a] -= pull * n[a];
            }
        }
        f
    }

    fn tangent(&mut self, u: &[[f64; D]]) -> LinearBody<D> {
        let mut rows: Vec<Vec<(u32, Block<D>)>> = vec![vec![]; u.len()];
        for &(i, j, k) in &self.springs {
            let (n, stretch, rest) = self.stretched(u, i, j);
            let [pull, slope] = (self.law)(stretch).map(|x| k * x);
            let block: Block<D> = std::array::from_fn(|a| {
                std::array::from_fn(|b| {
                    let across = f64::from(u8::from(a == b)) - n[a] * n[b];
                    slope / rest * n[a] * n[b] + pull / (rest * stretch) * across
                })
            });
            rows[i].push((j as u32, block));
            rows[j].push((i as u32, block));
        }
        let mut body = LinearBody {
            position: (self.position.iter().zip(u))
                .map(|(x, u)| std::array::from_fn(|a| x[a] + u[a]))
                .collect(),
            volume: vec![1.0; u.len()],
            density: vec![1.0; u.len()],
            start: vec![0],
            ..LinearBody::nothing()
        };
        for mut row in rows {
            row.sort_unstable_by_key(|r| r.0);
            for (j, block) in row {
                body.partner.push(j);
                body.block.push(block);
            }
            body.start.push(body.partner.len());
        }
        body
    }

    fn arrive(&mut self, u: &[[f64; D]]) -> u64 {
        let all = self.springs.clone();
        self.springs
            .retain(|&(i, j, _)| Net::stretched_of(&self.position, u, i, j) <= self.critical);
        2 * (all.len() - self.springs.len()) as u64
    }
}

impl<const D: usize> Net<D> {
    fn stretched_of(position: &[[f64; D]], u: &[[f64; D]], i: usize, j: usize) -> f64 {
        let (mut rest, mut now) = (0.0, 0.0);
        for a in 0..D {
            let xi = position[j][a] - position[i][a];
            rest += xi * xi;
            now += (xi + u[j][a] - u[i][a]).powi(2);
        }
        f64::sqrt(now / rest)
    }
}

/// Springs one after the other.
fn chain(stiffness: &[f64], law: Law) -> Net<1> {
    Net {
        position: (0..=stiffness.len()).map(|i| [i as f64]).collect(),
        springs: (stiffness.iter().enumerate())
            .map(|(i, k)| (i, i + 1, *k))
            .collect(),
        law,
        critical: f64::INFINITY,
    }
}

/// A plate of rubber springs to the nearest eight points, soft and hard at random, with a hole.
fn plate(size: [usize; 2]) -> Net<2> {
    let mut position = vec![];
    for y in 0..size[1] {
        for x in 0..size[0] {
            let hole = [x as f64 - 7.0, y as f64 - 4.0];
            if hole[0].abs().max(hole[1].abs()) > 0.5 {
                position.push([x as f64, y as f64]);
            }
        }
    }
    let mut springs = vec![];
    for i in 0..position.len() {
        for j in i + 1..position.len() {
            let d: [f64; 2] = std::array::from_fn(|a| position[j][a] - position[i][a]);
            if d[0].abs().max(d[1].abs()) < 1.5 {
                let key = super::super::select::mixed((i * 1000 + j) as u64);
                springs.push((i, j, if key.is_multiple_of(2) { 3.0 } else { 1.0 }));
            }
        }
    }
    Net {
        position,
        springs,
        law: rubber,
        critical: f64::INFINITY,
    }
}

fn plan(levels: Vec<Vec<u32>>, options: Options, corrections: usize, removed: Removed) -> Plan {
    Plan {
        levels: levels.into_iter().map(|kept| (kept, options)).collect(),
        corrections,
        tolerance: 1e-12,
        removed,
    }
}

fn exact() -> Options {
    Options {
        scheme: Scheme::Schur,
        rotation: 1.0,
        ..Options::default()
    }
}

/// All increments: displacements, and what each did.
fn gone<const D: usize>(
    body: &mut dyn Nonlinear<D>,
    points: usize,
    plan: &Plan,
    increments: usize,
    load: impl Fn(f64) -> Load<D>,
) -> Result<(Vec<[f64; D]>, Vec<Increment<D>>), IncrementError> {
    let mut way = Increments::new(body, plan.clone(), vec![[0.0; D]; points]);
    let mut done = vec![];
    for k in 1..=increments {
        done.push(way.step(body, &load(k as f64 / increments as f64))?);
    }
    Ok((way.displacements().to_vec(), done))
}

/// Held at the first point, pulled at the last by a dead load.
fn pulled(points: usize, force: f64) -> impl Fn(f64) -> Load<1> {
    move |t| {
        let mut load = Load {
            force: vec![[0.0]; points],
            held: vec![[None]; points],
        };
        load.held[0] = [Some(0.0)];
        load.force[points - 1] = [t * force];
        load
    }
}

/// λ at which `k (λ − λ⁻²) = F`, by bisection.
fn stretch(k: f64, force: f64) -> f64 {
    let (mut low, mut high) = (1.0, 10.0);
    for _ in 0..200 {
        let mid = 0.5 * (low + high);
        match k * rubber(mid)[0] < force {
            true => low = mid,
            false => high = mid,
        }
    }
    low
}

/// Displacements of a chain in closed form.
fn closed(stiffness: &[f64], force: f64) -> Vec<[f64; 1]> {
    let mut u = vec![[0.0]];
    for k in stiffness {
        u.push([u[u.len() - 1][0] + stretch(*k, force) - 1.0]);
    }
    u
}

#[test]
fn equal_springs_in_series_are_exact_whatever_the_increment() {
    // F = 0.5: λ − λ⁻² = 0.5 has λ = 1.1974…, a stretch of 20 %
    let stiffness = [1.0; 12];
    let force = 0.5;
    let truth = closed(&stiffness, force);
    assert!((truth[12][0] / 12.0 - 0.1974).abs() < 1e-4);
    let levels = vec![vec![0, 2, 4, 6, 8, 10, 12], vec![0, 2, 4, 6]];
    let balls = Options {
        radius: Radius::Fixed(4.0),
        ..Options::default()
    };
    for options in [exact(), balls] {
        for increments in [1, 3, 10] {
            let plan = plan(levels.clone(), options, 20, Removed::KinematicPoints);
            let mut net = chain(&stiffness, rubber);
            let load = pulled(13, force);
            let (u, done) = gone(&mut net, 13, &plan, increments, load).unwrap();
            let off = apart(&u, &truth);
            assert!(off < 1e-11, "{increments}: {off}");
            let last = done.last().unwrap();
            assert!(last.unbalanced < 1e-12 && last.removed < 1e-10, "{last:?}");
            // what holds it bears the load
            assert!((last.reaction[0][0] + force).abs() < 1e-11, "{last:?}");
        }
    }
    // without corrections it is not exact, and comes nearer with the square of the increment
    let off = |increments| {
        let plan = plan(levels.clone(), exact(), 0, Removed::KinematicPoints);
        let (u, _) = gone(
            &mut chain(&stiffness, rubber),
            13,
            &plan,
            increments,
            pulled(13, force),
        )
        .unwrap();
        apart(&u, &truth)
    };
    let [ten, twenty] = [off(10), off(20)];
    assert!(ten > 1e-6 && (ten / twenty).log2() > 1.8, "{ten} {twenty}");
}

/// Largest errors of retained and of removed points over the largest displacement.
fn errors<const D: usize>(u: &[[f64; D]], truth: &[[f64; D]], retained: &[u32]) -> [f64; 2] {
    let mut off = [0.0f64; 2];
    let most = truth.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    for (i, (u, v)) in (0..).zip(u.iter().zip(truth)) {
        let kind = usize::from(!retained.contains(&i));
        for a in 0..D {
            off[kind] = off[kind].max((u[a] - v[a]).abs() / most);
        }
    }
    off
}

#[test]
fn unlike_springs_in_series_have_the_orders_that_theory_says() {
    // pairs of a soft and a hard spring, the point between them removed: du_e = S(u) dq by Euler's method
    let stiffness: Vec<f64> = (0..12)
        .map(|i| if i % 2 == 0 { 1.0 } else { 3.0 })
        .collect();
    let force = 0.5;
    let truth = closed(&stiffness, force);
    let retained: Vec<u32> = (0..=12).step_by(2).collect();
    let off = |increments, corrections, removed| {
        let plan = plan(vec![retained.clone()], exact(), corrections, removed);
        let mut net = chain(&stiffness, rubber);
        let (u, _) = gone(&mut net, 13, &plan, increments, pulled(13, force)).unwrap();
        errors(&u, &truth, &retained)
    };
    let order = |corrections, removed, kind: usize| {
        let [one, two] = [20, 40].map(|n| off(n, corrections, removed)[kind]);
        (one / two).log2()
    };
    // an independent program (NumPy, dense) has these errors after 40 increments
    for (corrections, removed, numbers) in [
        (
            0,
            Removed::KinematicPoints,
            [9.912_373_728e-5, 1.813_164_510e-4],
        ),
        (0, Removed::Relaxed, [9.646_955_534e-5, 9.307_153_730e-5]),
        (
            30,
            Removed::KinematicPoints,
            [2.696_657_736e-6, 8.830_888_158e-5],
        ),
    ] {
        let found = off(40, corrections, removed);
        for (a, b) in found.iter().zip(numbers) {
            assert!((a / b - 1.0).abs() < 1e-6, "{found:?} {numbers:?}");
        }
    }
    // removed points: first order. Retained ones: second, as the work of SᵀK on them is 0
    let carried = order(30, Removed::KinematicPoints, 1);
    assert!((carried - 1.0).abs() < 0.1, "{carried}");
    for corrections in [0, 30] {
        let kept = order(corrections, Removed::KinematicPoints, 0);
        assert!((kept - 2.0).abs() < 0.05, "{corrections}: {kept}");
    }
    // relaxed ones do not lag behind: Newton's method on all points
    assert!((order(0, Removed::Relaxed, 1) - 2.0).abs() < 0.05);
    for increments in [1, 4] {
        let [kept, removed] = off(increments, 30, Removed::Relaxed);
        assert!(kept.max(removed) < 1e-10, "{increments}: {kept} {removed}");
    }
}

#[test]
fn a_linear_body_has_the_answer_of_its_levels_whatever_the_increments() {
    let body = random([13, 13], false, 10.0);
    let n = body.points();
    let held = |i: usize| body.position[i][0] == 0.0;
    let mut one = Selection::every(2).choose(&body).unwrap();
    one.extend((0..n as u32).filter(|i| held(*i as usize)));
    one.sort_unstable();
    one.dedup();
    // every second of these again, and what is held
    let two: Vec<u32> = (0..one.len() as u32)
        .filter(|k| {
            let x = body.position[one[*k as usize] as usize];
            x[0] == 0.0 || x.iter().all(|x| x % 4.0 == 0.0)
        })
        .collect();
    let density = |x: &[f64; 2]| [0.01 + 0.002 * x[1], 0.003 * x[0] - 0.001 * x[1]];
    let loaded: Vec<bool> = body.position.iter().map(|x| x[0] >= 6.0).collect();
    for options in [
        exact(),
        Options {
            radius: Radius::Tolerance(0.05),
            ..Options::default()
        },
    ] {
        // today's way: loads are passed on level by level
        let mut whole = body.clone();
        let (position, volume) = (body.position.clone(), body.volume.clone());
        whole.load_map = Some(LoadMap::of(position, volume, 1.0, &loaded));
        let (level1, first) = coarsen(&whole, &one, &options).unwrap();
        let (level2, _) = coarsen(&level1, &two, &options).unwrap();
        let load_map = level2.load_map.as_ref().unwrap();
        let mut forces = vec![[0.0; 2]; level2.points()];
        for p in 0..load_map.points() {
            let f = density(&load_map.position[p]).map(|f| f * load_map.volume[p]);
            let (targets, blocks) = load_map.row(p);
            for (q, t) in targets.iter().zip(blocks) {
                for a in 0..2 {
                    forces[*q as usize][a] += t[a][0] * f[0] + t[a][1] * f[1];
                }
            }
        }
        let densities: Vec<[f64; 2]> = (forces.iter().zip(&level2.volume))
            .map(|(f, v)| f.map(|f| f / v))
            .collect();
        let fixed: Vec<(usize, [f64; 2])> = (0..level2.points())
            .filter(|i| level2.position[*i][0] == 0.0)
            .map(|i| (i, [0.0, 0.1]))
            .collect();
        let expected = equilibrium(&level2, &fixed, &densities);
        for (increments, corrections) in [(1, 0), (3, 0), (7, 2)] {
            let plan = plan(
                vec![one.clone(), two.clone()],
                options,
                corrections,
                Removed::KinematicPoints,
            );
            let load = |t: f64| Load {
                force: (0..n)
                    .map(|i| match loaded[i] {
                        true => density(&body.position[i]).map(|f| t * f * body.volume[i]),
                        false => [0.0; 2],
                    })
                    .collect(),
                held: (0..n)
                    .map(|i| match held(i) {
                        true => [Some(0.0), Some(0.1 * t)],
                        false => [None; 2],
                    })
                    .collect(),
            };
            let mut linear = Linear {
                body: body.clone(),
                about: vec![[0.0; 2]; n],
                forces: vec![[0.0; 2]; n],
            };
            let (u, done) = gone(&mut linear, n, &plan, increments, load).unwrap();
            let found: Vec<[f64; 2]> = (two.iter()).map(|k| u[one[*k as usize] as usize]).collect();
            let off = apart(&found, &expected);
            assert!(off < 1e-11, "{increments} {corrections}: {off}");
            assert!(done.iter().all(|d| d.unbalanced < 1e-11), "{done:?}");
        }
        assert!(first.loss.is_some());
    }
}

/// Both ends held, the right one drawn out by 20 %.
fn drawn(net: &Net<2>) -> impl Fn(f64) -> Load<2> {
    let length = net.position.iter().fold(0.0f64, |m, x| m.max(x[0]));
    let position = net.position.clone();
    move |t| Load {
        force: vec![[0.0; 2]; position.len()],
        held: position
            .iter()
            .map(|x| match x[0] {
                0.0 => [Some(0.0); 2],
                x if x == length => [Some(0.2 * t * length), Some(0.0)],
                _ => [None; 2],
            })
            .collect(),
    }
}

/// Every second point along both axes, and what is held.
fn second(net: &Net<2>) -> Vec<u32> {
    let length = net.position.iter().fold(0.0f64, |m, x| m.max(x[0]));
    let stays = |x: &[f64; 2]| x[0] == 0.0 || x[0] == length || x.iter().all(|x| x % 2.0 == 0.0);
    (0..net.position.len() as u32)
        .filter(|i| stays(&net.position[*i as usize]))
        .collect()
}

/// Force on the right end along x.
fn pull<const D: usize>(done: &Increment<D>, retained: &[u32], net: &Net<D>) -> f64 {
    let length = net.position.iter().fold(0.0f64, |m, x| m.max(x[0]));
    let at = |q: &u32| net.position[*q as usize][0] == length;
    let both = retained.iter().zip(&done.reaction);
    both.filter(|(q, _)| at(q)).map(|(_, r)| r[0]).sum()
}

#[test]
fn a_plate_of_rubber_is_followed_to_a_fifth() {
    let size = [17, 9];
    let net = plate(size);
    let n = net.position.len();
    let load = drawn(&net);
    let retained = second(&net);
    let balls = Options {
        radius: Radius::Fixed(5.0),
        ..Options::default()
    };
    let run = |levels, options, corrections, removed, increments| {
        let plan = plan(levels, options, corrections, removed);
        gone(&mut plate(size), n, &plan, increments, &load).unwrap()
    };
    // Newton's method on all points: nothing is missing
    let (truth, done) = run(vec![], exact(), 50, Removed::KinematicPoints, 4);
    let all: Vec<u32> = (0..n as u32).collect();
    let force = pull(done.last().unwrap(), &all, &net);
    let mut missing = plate(size).forces(&truth);
    let held = load(1.0).held;
    for (r, held) in missing.iter_mut().zip(&held) {
        *r = std::array::from_fn(|a| if held[a].is_some() { 0.0 } else { r[a] });
    }
    let left = missing.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(left < 1e-10 * force, "{left} {force}");
    let off = |(u, done): &(Vec<[f64; 2]>, Vec<Increment<2>>)| {
        let [kept, removed] = errors(u, &truth, &retained);
        let reaction = pull(done.last().unwrap(), &retained, &net) / force - 1.0;
        [kept, removed, reaction.abs()]
    };
    let coarse = vec![retained.clone()];
    let each: Vec<[f64; 3]> = [5, 10, 20, 40]
        .map(|increments| {
            off(&run(
                coarse.clone(),
                balls,
                0,
                Removed::KinematicPoints,
                increments,
            ))
        })
        .to_vec();
    let corrected = off(&run(
        coarse.clone(),
        balls,
        10,
        Removed::KinematicPoints,
        10,
    ));
    let relaxed: Vec<[f64; 3]> = [5, 10, 20]
        .map(|increments| {
            off(&run(
                coarse.clone(),
                exact(),
                0,
                Removed::Relaxed,
                increments,
            ))
        })
        .to_vec();
    let whole = off(&run(coarse.clone(), balls, 40, Removed::Relaxed, 2));
    let told = format!("{each:?}\n{corrected:?}\n{relaxed:?}\n{whole:?}");
    eprintln!("{told}");
    // within 1 %, pull and displacements
    assert!(each[1].iter().all(|e| *e < 0.01), "{told}");
    assert!(corrected.iter().all(|e| *e < 0.01), "{told}");
    // exact shapes and relaxed points: Newton's method with one iteration an increment, of second order
    let order = (relaxed[1][0] / relaxed[2][0]).log2();
    assert!(order > 1.7, "{order}\n{told}");
    // with corrections they end at Newton's own answer, whatever the balls cut off
    assert!(whole.iter().all(|e| *e < 1e-9), "{told}");
}

#[test]
fn uniform_stretches_are_exact_without_corrections() {
    // all of the boundary moves as a uniform stretch says, and springs are alike: so does all else
    let mut net = plate([12, 7]);
    net.springs.iter_mut().for_each(|s| s.2 = 1.0);
    let position: Vec<[f64; 2]> = (0..7 * 9)
        .map(|i| [f64::from(i % 9), f64::from(i / 9)])
        .collect();
    let mut springs = vec![];
    for i in 0..position.len() {
        for j in i + 1..position.len() {
            let d: [f64; 2] = std::array::from_fn(|a| position[j][a] - position[i][a]);
            if d[0].abs().max(d[1].abs()) < 1.5 {
                springs.push((i, j, 1.0));
            }
        }
    }
    (net.position, net.springs) = (position.clone(), springs);
    let edge = |x: &[f64; 2]| x[0] == 0.0 || x[0] == 8.0 || x[1] == 0.0 || x[1] == 6.0;
    let uniform = |x: &[f64; 2], t: f64| [t * (0.3 * x[0] + 0.1 * x[1]), -0.1 * t * x[1]];
    let retained: Vec<u32> = (0..63)
        .filter(|i| {
            let x = &position[*i as usize];
            edge(x) || x.iter().all(|x| x % 2.0 == 0.0)
        })
        .collect();
    let load = |t: f64| Load {
        force: vec![[0.0; 2]; 63],
        held: (position.iter())
            .map(|x| match edge(x) {
                true => uniform(x, t).map(Some),
                false => [None; 2],
            })
            .collect(),
    };
    let truth: Vec<[f64; 2]> = position.iter().map(|x| uniform(x, 1.0)).collect();
    for increments in [1, 3] {
        let plan = plan(vec![retained.clone()], exact(), 0, Removed::KinematicPoints);
        let (u, _) = gone(&mut net, 63, &plan, increments, load).unwrap();
        let off = apart(&u, &truth);
        assert!(off < 1e-12, "{increments}: {off}");
    }
}

#[test]
fn broken_springs_are_counted_and_what_falls_apart_is_refused() {
    // between hard ends a soft and a harder spring, and one that spans both: at 40 % of a length the soft one would be at λ = 1.29
    let spanned = |critical| {
        let mut net = chain(&[30.0, 1.0, 3.0, 30.0], rubber);
        net.springs.push((1, 3, 1.0));
        net.critical = critical;
        net
    };
    let kept = vec![vec![0, 1, 3, 4]];
    let drawn = |t: f64| Load {
        force: vec![[0.0]; 5],
        held: vec![[Some(0.0)], [None], [None], [None], [Some(0.4 * t)]],
    };
    let plan = plan(kept, exact(), 20, Removed::Relaxed);
    let (u, done) = gone(&mut spanned(f64::INFINITY), 5, &plan, 4, drawn).unwrap();
    assert!(u[2][0] - u[1][0] > 0.25 && done.iter().all(|d| d.broken == 0));
    let mut torn = spanned(1.25);
    let (u, done) = gone(&mut torn, 5, &plan, 4, drawn).unwrap();
    let broken: Vec<u64> = done.iter().map(|d| d.broken).collect();
    assert_eq!(broken, [0, 0, 0, 2]);
    // in equilibrium after it, at the same load: the point between hangs on one side
    let left = torn.forces(&u);
    assert!(left[1..4].iter().all(|f| f[0].abs() < 1e-10), "{left:?}");
    assert!((u[2][0] - u[3][0]).abs() < 1e-10, "{u:?}");
    // ends: 30 g(1 + a) = g(1 + b) with 2 a + 2 b = 0.4
    let pull = 30.0 * rubber(1.0 + u[1][0])[0];
    let span = rubber(1.0 + 0.5 * (u[3][0] - u[1][0]))[0];
    assert!((pull - span).abs() < 1e-10 && (done[3].reaction[3][0] - pull).abs() < 1e-10);
    // a removed point that loses both its springs has no retained one beside it
    let mut lost = chain(&[1.0; 4], rubber);
    lost.critical = 1.05;
    let end = gone(&mut lost, 5, &plan, 4, drawn).unwrap_err();
    assert!(
        matches!(
            end,
            IncrementError::Coarsen {
                level: 1,
                error: CoarsenError::Unrepresented { .. }
            }
        ),
        "{end}"
    );
}

#[test]
fn loads_beyond_the_limit_are_refused() {
    // springs that bear 1/(4 e) = 0.092 at most, pulled by 0.12
    let mut net = chain(&[1.0; 4], soft);
    let plan = plan(vec![vec![0, 2, 4]], exact(), 20, Removed::KinematicPoints);
    let load = pulled(5, 0.12);
    let mut way = Increments::new(&mut net, plan, vec![[0.0]; 5]);
    let mut end = None;
    for k in 1..=12 {
        let before = way.displacements().to_vec();
        if let Err(error) = way.step(&mut net, &load(f64::from(k) / 12.0)) {
            assert_eq!(way.displacements(), before);
            end = Some((k, error));
            break;
        }
    }
    // 0.01 k > 0.092 first at k = 10
    let (k, error) = end.unwrap();
    assert_eq!(k, 10, "{error}");
    let told = error.to_string();
    assert!(
        matches!(
            error,
            IncrementError::Solve(SolveError::Indefinite { .. })
                | IncrementError::Coarsen { .. }
                | IncrementError::NotFinite
        ),
        "{told}"
    );
}
