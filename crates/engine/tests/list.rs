//! Horizon lists: the same mechanics as stencils on lattices, the textbook's formulas on random clouds, the same bits
//! in every width and on any number of threads, little memory and no allocation.

use peridyne::body::{Body, Field, Layout, zeros};
use peridyne::execute::simd::Simd;
use peridyne::family::{horizon::HorizonList, stencil::Stencil, volume_fraction};
use peridyne::interaction::list::{ListInteraction, ListParts};
use peridyne::interaction::stencil::{StencilInteraction, StencilParts};
use peridyne::interaction::weight::BondWeight;
use peridyne::interaction::{
    BondState, Interaction, PointConstants, PointEnergies, Repulsion, Sweep, Tally, Toughness,
};
use peridyne::law::Law;
use peridyne::law::influence::influence;
use peridyne::law::solid::bond_based::{BondBased, BondBasedMixed};
use peridyne::law::solid::eam_like::{EamLike, Solid};
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::spec::{CrackKind, Horizon, Influence, InterfaceRule};
use std::alloc::{GlobalAlloc, Layout as Memory, System};
use std::cell::Cell;
use std::collections::BTreeSet;

struct Counting;
thread_local!(static ALLOCATIONS: Cell<u64> = const { Cell::new(0) });

// SAFETY: hands everything to the system
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Memory) -> *mut u8 {
        let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, p: *mut u8, layout: Memory) {
        unsafe { System.dealloc(p, layout) }
    }
}
#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Uniform numbers in ±1 (splitmix64).
struct Random(u64);
impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

const H: f64 = 0.0005;

/// What a case is made of besides its law.
#[derive(Clone)]
struct Case<const D: usize> {
    kind: LatticeKind,
    ratio: u32,
    cells: [i32; D],
    periodic: [bool; D],
    influence: Influence,
    materials: bool,
    toughness: Vec<Toughness>,
    repulsion: Option<Repulsion>,
    amplitude: f64,
}

impl<const D: usize> Case<D> {
    fn new(kind: LatticeKind, ratio: u32, cells: [i32; D]) -> Self {
        Case {
            kind,
            ratio,
            cells,
            periodic: [false; D],
            influence: Influence::Constant,
            materials: false,
            toughness: vec![Toughness {
                s00: f64::INFINITY,
                alpha: 0.0,
            }],
            repulsion: None,
            amplitude: 0.01 * H,
        }
    }
    fn breaking(mut self) -> Self {
        self.toughness = vec![Toughness {
            s00: 0.006,
            alpha: 0.25,
        }];
        if self.materials {
            self.toughness.push(Toughness {
                s00: 0.009,
                alpha: 0.1,
            });
        }
        self
    }
    fn contact(mut self) -> Self {
        self.repulsion = Some(Repulsion {
            stiffness: 3.0,
            bonded: 0.9,
            range: 1.35 * H,
        });
        self.amplitude = 0.15 * H;
        self
    }

    fn body(&self) -> Body<D> {
        let mut quarters = vec![];
        let n: [i32; 3] = std::array::from_fn(|a| if a < D { self.cells[a] } else { 1 });
        for z in 0..n[2] {
            for y in 0..n[1] {
                for x in 0..n[0] {
                    // a free corner is missing
                    if self.periodic == [false; D] && x + y + z < 2 {
                        continue;
                    }
                    for s in self.kind.basis() {
                        quarters.push([4 * x + s[0], 4 * y + s[1], 4 * z + s[2]]);
                    }
                }
            }
        }
        let lattice = Lattice {
            kind: self.kind,
            spacing: H,
            origin: [0.1 * H, -0.3 * H, 0.0],
        };
        let reach = self.stencil().reach;
        let volume = self.kind.site_volume() * H.powi(D as i32);
        let mut body =
            Body::<D>::on_lattice(lattice, &quarters, reach, self.periodic, volume).unwrap();
        if self.materials {
            body.material = vec![0; body.len];
            for (id, s) in body.slots.iter().enumerate() {
                body.material[*s as usize] = (id / 5 % 2) as u8;
            }
        }
        body
    }

    /// The same points, moved off their sites.
    fn perturbed_cloud(&self) -> Body<D> {
        let mut body = self.body().to_cloud().unwrap();
        let mut random = Random(5);
        if let Layout::Cloud(x) = &mut body.layout {
            x.iter_mut()
                .flatten()
                .for_each(|x| *x += 0.2 * H * random.next());
        }
        body
    }
    fn stencil(&self) -> Stencil {
        Stencil::new(self.kind, H, Horizon::Ratio(self.ratio))
    }
    fn delta(&self) -> f64 {
        self.ratio as f64 * H
    }

    fn list<W: Law>(
        &self,
        body: &Body<D>,
        law: W,
        point_constants: PointConstants,
        simd: Simd,
    ) -> ListInteraction<D, W> {
        let mut it = ListInteraction::new(ListParts {
            body,
            list: HorizonList::new(body, self.delta() * (1.0 + 1e-9)).unwrap(),
            law,
            weight: BondWeight::new(self.influence, self.delta(), Some(H)),
            point_constants,
            toughness: self.toughness.clone(),
            repulsion: self.repulsion,
            simd,
        });
        it.prepare(body);
        it
    }
}

/// A displacement per id, the same for every body of these points.
fn displace<const D: usize>(body: &Body<D>, amplitude: f64, seed: u64) -> Field<D> {
    let mut u = body.at_rest();
    let mut random = Random(seed);
    for &s in &body.slots {
        for c in &mut u {
            c[s as usize] = amplitude * random.next();
        }
    }
    u.iter_mut().for_each(|c| body.fill_images(c));
    u
}

/// Values of points in order of id.
fn by_id<const D: usize>(body: &Body<D>, field: &[f64]) -> Vec<f64> {
    body.slots.iter().map(|s| field[*s as usize]).collect()
}

fn close(what: &str, a: &[f64], b: &[f64], tolerance: f64) {
    let scale = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    assert_eq!(a.len(), b.len());
    for (id, (x, y)) in a.iter().zip(b).enumerate() {
        assert!(
            (x - y).abs() <= tolerance * scale,
            "{what} of point {id}: {x:e} and {y:e}, scale {scale:e}"
        );
    }
}

/// Bonds as pairs of ids, and whether they are whole.
fn bonds<const D: usize>(
    body: &Body<D>,
    it: &dyn Interaction<D>,
) -> BTreeSet<(usize, usize, bool)> {
    let mut id = vec![usize::MAX; body.len];
    for (n, s) in body.slots.iter().enumerate() {
        id[*s as usize] = n;
    }
    let mut all = BTreeSet::new();
    it.each_bond(body, &mut |i, j, _, state| {
        let (i, j) = (id[i].min(id[j]), id[i].max(id[j]));
        let new = all.insert((i, j, state == BondState::Whole));
        assert!(new, "twice: {i}-{j}");
    });
    all
}

/// Energies seen along with the forces are those of `observe`, and the forces are the same bits.
fn watching_changes_nothing<const D: usize>(
    it: &mut impl Interaction<D>,
    body: &Body<D>,
    u: &Field<D>,
) {
    let (mut f, mut g) = (zeros(body.len), zeros(body.len));
    let (mut seen, mut observed) = (PointEnergies::default(), PointEnergies::default());
    it.forces(body, u, &mut f, Sweep::Hold, None);
    it.observe(body, u, &mut observed);
    it.forces(body, u, &mut g, Sweep::Hold, Some(&mut seen));
    for a in 0..D {
        assert!(by_id(body, &f[a]) == by_id(body, &g[a]), "axis {a}");
    }
    assert!(seen.strain.iter().any(|e| *e > 0.0));
    assert!(seen.strain == observed.strain, "strain");
    assert!(seen.repulsion == observed.repulsion, "repulsion");
    assert!(seen.dilatation == observed.dilatation, "dilatation");
}

fn same_as_stencil<const D: usize, W: Law>(
    case: &Case<D>,
    law: W,
    constants: PointConstants,
) -> Tally {
    let body = case.body();
    let cloud = body.to_cloud().unwrap();
    let Layout::Grid(grid) = &body.layout else {
        unreachable!()
    };
    let weight = |r0: f64| {
        influence(case.influence, r0, case.delta()) * volume_fraction(r0, case.delta(), H)
    };
    let mut stencil = StencilInteraction::new(StencilParts {
        body: &body,
        grid,
        stencil: &case.stencil(),
        law,
        weight: &weight,
        point_constants: constants.clone(),
        toughness: case.toughness.clone(),
        repulsion: case.repulsion,
        simd: Simd::detect(),
    });
    let mut list = case.list(&cloud, law, constants, Simd::detect());
    assert_eq!(stencil.directed_bonds(), list.directed_bonds());
    // a crack that ends inside, its tip absent, the rest broken
    for (kind, from, to) in [(CrackKind::Absent, 2.2, 3.2), (CrackKind::Broken, 0.5, 2.2)] {
        let crosses = |a: [f64; D], b: [f64; D]| {
            let x = (0.13 + 0.5 * case.cells[0] as f64) * H;
            let last = 0.5 * (a[D - 1] + b[D - 1]) / H;
            let split = a[0].min(b[0]) < x && x < a[0].max(b[0]);
            split && (D == 1 || (from..to).contains(&last))
        };
        let before = list.directed_bonds();
        let cut = list.cut(&cloud, kind, &crosses);
        assert_eq!(stencil.cut(&body, kind, &crosses), cut);
        assert!(cut > 0 || (D == 1 && kind == CrackKind::Broken));
        let absent = (kind == CrackKind::Absent) as u64 * cut;
        assert_eq!(list.directed_bonds(), before - absent);
    }
    stencil.prepare(&body);
    list.prepare(&cloud);
    let mut total = Tally::default();
    let mut f = (zeros(body.len), zeros(cloud.len));
    for step in 0..4 {
        let amplitude = case.amplitude * (1.0 + 0.5 * step as f64);
        let u = (
            displace(&body, amplitude, step),
            displace(&cloud, amplitude, step),
        );
        watching_changes_nothing(&mut stencil, &body, &u.0);
        watching_changes_nothing(&mut list, &cloud, &u.1);
        let a = stencil.forces(
            &body,
            &u.0,
            &mut f.0,
            Sweep::Evolve {
                v: &zeros(body.len),
                dt: 0.0,
            },
            None,
        );
        let b = list.forces(
            &cloud,
            &u.1,
            &mut f.1,
            Sweep::Evolve {
                v: &zeros(cloud.len),
                dt: 0.0,
            },
            None,
        );
        for axis in 0..D {
            let (a, b) = (by_id(&body, &f.0[axis]), by_id(&cloud, &f.1[axis]));
            close("force", &a, &b, 1e-13);
        }
        assert_eq!(a.broken, b.broken, "step {step}");
        assert!((a.released - b.released).abs() <= 1e-12 * a.released.abs());
        total += b;

        let mut seen = (PointEnergies::default(), PointEnergies::default());
        stencil.observe(&body, &u.0, &mut seen.0);
        list.observe(&cloud, &u.1, &mut seen.1);
        for (what, a, b) in [
            ("strain", &seen.0.strain, &seen.1.strain),
            ("repulsion", &seen.0.repulsion, &seen.1.repulsion),
            ("dilatation", &seen.0.dilatation, &seen.1.dilatation),
        ] {
            close(what, &by_id(&body, a), &by_id(&cloud, b), 2e-13);
        }
        let repelled = seen.1.repulsion.iter().any(|e| *e > 0.0);
        assert_eq!(repelled, case.repulsion.is_some());
        let mut damage = (vec![0.0; body.len], vec![0.0; cloud.len]);
        stencil.damage(&body, &mut damage.0);
        list.damage(&cloud, &mut damage.1);
        let (a, b) = (by_id(&body, &damage.0), by_id(&cloud, &damage.1));
        close("damage", &a, &b, 1e-14);
        for (g, c) in body.slots.iter().zip(&cloud.slots) {
            let (g, c) = (*g as usize, *c as usize);
            assert_eq!(stencil.family_size(&body, g), list.family_size(&cloud, c));
            let (a, b) = (stencil.critical_stretch(g), list.critical_stretch(c));
            assert!(a == b || (a - b).abs() <= 1e-14, "{a} {b}");
        }
    }
    let (a, b) = (bonds(&body, &stencil), bonds(&cloud, &list));
    let different: Vec<_> = a.symmetric_difference(&b).take(9).collect();
    assert!(
        different.is_empty(),
        "{different:?} of {} {}",
        a.len(),
        b.len()
    );
    for id in 1..body.points() {
        let pair = |b: &Body<D>| (b.slots[0] as usize, b.slots[id] as usize);
        let ((gi, gj), (ci, cj)) = (pair(&body), pair(&cloud));
        assert_eq!(
            stencil.in_family(&body, gi, gj),
            list.in_family(&cloud, ci, cj)
        );
    }
    total
}

fn lps(d: usize) -> [Solid; 2] {
    [Solid::lps(d, 3.0, 1.0), Solid::lps(d, 1.5, 2.0)]
}

/// PMB, mixed PMB, LPS, mixed LPS: intact and breaking, without and with repulsion.
fn all_laws<const D: usize>(case: Case<D>) {
    let [soft, hard] = lps(D);
    let series = BondBasedMixed {
        rule: InterfaceRule::Series,
    };
    let solid = EamLike {
        ratio: soft.ratio(),
    };
    for contact in [false, true] {
        for breaking in [false, true] {
            let dress = |materials| {
                let c = Case {
                    materials,
                    ..case.clone()
                };
                let c = if contact { c.contact() } else { c };
                if breaking { c.breaking() } else { c }
            };
            let (plain, mixed) = (dress(false), dress(true));
            let two = PointConstants::PerMaterial(vec![2.0, 5.0]);
            for t in [
                same_as_stencil(&plain, BondBased { c: 2.0 }, PointConstants::None),
                same_as_stencil(&mixed, series, two),
                same_as_stencil(&plain, solid, PointConstants::Solid(vec![soft])),
                same_as_stencil(&mixed, solid, PointConstants::Solid(vec![soft, hard])),
            ] {
                assert_eq!(t.broken > 0, breaking);
            }
        }
    }
}

#[test]
fn list_is_stencil_in_one_dimension() {
    all_laws(Case::new(LatticeKind::Chain, 3, [41]));
    all_laws(Case {
        periodic: [true],
        ..Case::new(LatticeKind::Chain, 4, [23])
    });
}

#[test]
fn list_is_stencil_in_two_dimensions() {
    all_laws(Case {
        influence: Influence::Inverse,
        ..Case::new(LatticeKind::Square, 3, [13, 11])
    });
    all_laws(Case {
        periodic: [false, true],
        influence: Influence::Gaussian,
        ..Case::new(LatticeKind::Triangular, 2, [9, 7])
    });
}

#[test]
fn list_is_stencil_in_three_dimensions() {
    all_laws(Case {
        influence: Influence::Gaussian,
        ..Case::new(LatticeKind::Cubic, 3, [9, 8, 7])
    });
    all_laws(Case {
        periodic: [true, false, true],
        influence: Influence::Inverse,
        ..Case::new(LatticeKind::Fcc, 1, [4, 4, 4])
    });
    all_laws(Case {
        influence: Influence::Gaussian,
        ..Case::new(LatticeKind::Diamond, 1, [3, 4, 5])
    });
}

/// These vanish at the horizon, where round-off would decide alone about points with no other bonds left: intact only.
#[test]
fn list_is_stencil_with_fading_influence() {
    for influence in [Influence::Conical, Influence::CubicSpline] {
        let case = Case {
            influence,
            ..Case::new(LatticeKind::Cubic, 3, [8, 6, 7])
        };
        let [solid, _] = lps(3);
        let law = EamLike {
            ratio: solid.ratio(),
        };
        same_as_stencil(&case, BondBased { c: 2.0 }, PointConstants::None);
        same_as_stencil(&case, law, PointConstants::Solid(vec![solid]));
    }
}

/// ξ to the nearest image along y, and its square.
fn distance<const D: usize>(a: [f64; 3], b: [f64; 3], period: f64) -> ([f64; 3], f64) {
    let mut xi = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    if D > 1 && xi[1].abs() > 0.5 * period {
        xi[1] -= period * xi[1].signum();
    }
    (xi, xi.iter().map(|x| x * x).sum())
}

/// A cloud without order: positions, volumes, the body, and its period along y.
fn random_cloud<const D: usize>(n: usize) -> (Vec<[f64; 3]>, Vec<f64>, Body<D>, f64) {
    let mut random = Random(D as u64);
    let volume: Vec<f64> = (0..n).map(|_| 1.0 + 0.4 * random.next()).collect();
    let edge = 0.6 * (n as f64).powf(1.0 / D as f64);
    let period = 2.0 * edge;
    let mut position: Vec<[f64; 3]> = vec![];
    while position.len() < n {
        let x = std::array::from_fn(|a| if a < D { edge * random.next() } else { 0.0 });
        let free = |p: &[f64; 3]| distance::<D>(*p, x, period).1 > 0.1;
        if position.iter().all(free) {
            position.push(x);
        }
    }
    let periods = std::array::from_fn(|a| (a == 1).then_some(period));
    let body = Body::<D>::from_cloud(&position, &volume, &[], 1.0, periods).unwrap();
    (position, volume, body, period)
}

fn norm(x: [f64; 3]) -> f64 {
    x.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// The formulas as printed, over all pairs: PMB (sandia2010 (3.0.5)-(3.0.7)) and LPS (Algorithm 2).
fn textbook<const D: usize>() {
    let n = [30, 300, 500][D - 1];
    let (x, volume, body, period) = random_cloud::<D>(n);
    let delta = 2.3;
    let (c, bulk, shear) = (2.0, 3.0, 1.3);
    let mut random = Random(99);
    let u: Vec<[f64; 3]> = (0..n)
        .map(|_| std::array::from_fn(|a| if a < D { 0.02 * random.next() } else { 0.0 }))
        .collect();
    // partner, reference distance, bond vector
    let family: Vec<Vec<(usize, f64, [f64; 3])>> = (0..n)
        .map(|i| {
            let others = (0..n).filter(|j| *j != i);
            let pair = |j: usize| {
                let (xi, square) = distance::<D>(x[i], x[j], period);
                let y = std::array::from_fn(|a| xi[a] + u[j][a] - u[i][a]);
                (square <= delta * delta).then(|| (j, square.sqrt(), y))
            };
            others.filter_map(pair).collect()
        })
        .collect();
    let nu = |r0: f64| {
        if (r0 - delta).abs() <= 0.5 {
            (delta - r0) + 0.5
        } else {
            1.0
        }
    };
    let sum = |i: usize, of: &dyn Fn(f64, f64) -> f64| -> f64 {
        let term = |(j, r0, y): &(usize, f64, [f64; 3])| of(*r0, norm(*y)) * nu(*r0) * volume[*j];
        family[i].iter().map(term).sum()
    };
    // ω = 1/r0: m = Σ ω r0² ν V, θ = 3/m Σ ω r0 e ν V
    let m: Vec<f64> = (0..n).map(|i| sum(i, &|r0, _| r0)).collect();
    let theta: Vec<f64> = (0..n)
        .map(|i| 3.0 / m[i] * sum(i, &|r0, r| r - r0))
        .collect();
    let mut expected = [vec![[0.0; 3]; n], vec![[0.0; 3]; n]];
    for i in 0..n {
        for &(j, r0, y) in &family[i] {
            let (r, w) = (norm(y), 1.0 / r0);
            let pmb = c * (r - r0) / r0;
            let lps = (3.0 * bulk - 5.0 * shear) * (theta[i] / m[i] + theta[j] / m[j]) * w * r0
                + 15.0 * shear * (w / m[i] + w / m[j]) * (r - r0);
            for a in 0..3 {
                expected[0][i][a] += pmb * nu(r0) * volume[j] * y[a] / r;
                expected[1][i][a] += lps * nu(r0) * volume[j] * y[a] / r;
            }
        }
    }

    let mut field = body.at_rest();
    for (s, u) in body.slots.iter().zip(&u) {
        for a in 0..D {
            field[a][*s as usize] = u[a];
        }
    }
    // Algorithm 2 is three-dimensional: n = 3, κ = K − 5G/3, β = 15 G
    let solid = Solid {
        n: 3.0,
        kappa: bulk - 5.0 / 3.0 * shear,
        beta: 15.0 * shear,
    };
    let list = HorizonList::new(&body, delta).unwrap();
    let bonds: usize = family.iter().map(Vec::len).sum();
    assert_eq!(list.directed, bonds as u64);
    let mut pmb = ListInteraction::new(ListParts {
        body: &body,
        list: list.clone(),
        law: BondBased { c },
        weight: BondWeight::new(Influence::Constant, delta, Some(1.0)),
        point_constants: PointConstants::None,
        toughness: vec![],
        repulsion: None,
        simd: Simd::detect(),
    });
    let mut lps = ListInteraction::new(ListParts {
        body: &body,
        list,
        law: EamLike {
            ratio: solid.ratio(),
        },
        weight: BondWeight::new(Influence::Inverse, delta, Some(1.0)),
        point_constants: PointConstants::Solid(vec![solid]),
        toughness: vec![],
        repulsion: None,
        simd: Simd::detect(),
    });
    let laws: [&mut dyn Interaction<D>; 2] = [&mut pmb, &mut lps];
    for (law, expected) in laws.into_iter().zip(expected) {
        law.prepare(&body);
        let mut f = zeros(body.len);
        law.forces(
            &body,
            &field,
            &mut f,
            Sweep::Evolve {
                v: &zeros(body.len),
                dt: 0.0,
            },
            None,
        );
        for a in 0..D {
            let plain: Vec<f64> = expected.iter().map(|f| f[a]).collect();
            let force = by_id(&body, &f[a]);
            close("force", &plain, &force, 1e-12);
            let momentum: f64 = force.iter().zip(&volume).map(|(f, v)| f * v).sum();
            let size: f64 = force.iter().map(|f| f.abs()).sum();
            assert!(momentum.abs() <= 1e-14 * size, "{momentum:e} of {size:e}");
        }
        let mut damage = vec![1.0; body.len];
        law.damage(&body, &mut damage);
        assert!(damage.iter().all(|d| *d == 0.0));
        // with volumes that differ: half of the body falls off
        let half = |a: [f64; D], b: [f64; D]| (a[0] < 0.0) != (b[0] < 0.0);
        law.cut(&body, CrackKind::Broken, &half);
        law.damage(&body, &mut damage);
        let plain: Vec<f64> = (0..n)
            .map(|i| {
                let whole = |j: usize| (x[i][0] < 0.0) == (x[j][0] < 0.0);
                let all: f64 = family[i].iter().map(|b| volume[b.0]).sum();
                let whole = family[i].iter().filter(|b| whole(b.0));
                1.0 - whole.map(|b| volume[b.0]).sum::<f64>() / all
            })
            .collect();
        close("damage", &plain, &by_id(&body, &damage), 1e-13);
    }
    let mut lps = {
        let list = HorizonList::new(&body, delta).unwrap();
        ListInteraction::new(ListParts {
            body: &body,
            list,
            law: EamLike {
                ratio: solid.ratio(),
            },
            weight: BondWeight::new(Influence::Inverse, delta, Some(1.0)),
            point_constants: PointConstants::Solid(vec![solid]),
            toughness: vec![],
            repulsion: None,
            simd: Simd::detect(),
        })
    };
    lps.prepare(&body);
    let mut seen = PointEnergies::default();
    lps.observe(&body, &field, &mut seen);
    close("dilatation", &theta, &by_id(&body, &seen.dilatation), 1e-12);
}

#[test]
fn random_clouds_follow_the_textbook() {
    textbook::<1>();
    textbook::<2>();
    textbook::<3>();
}

/// Everything that a few breaking steps leave behind.
fn trace<W: Law>(law: W, constants: PointConstants, simd: Simd, threads: usize) -> Vec<u64> {
    let case = Case {
        influence: Influence::Inverse,
        materials: true,
        ..Case::new(LatticeKind::Cubic, 3, [17, 11, 9])
    };
    let case = case.contact().breaking();
    let body = case.perturbed_cloud();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(|| {
        let mut it = case.list(&body, law, constants, simd);
        let mut bits = vec![];
        let mut f = zeros(body.len);
        for step in 0..3 {
            let u = displace(&body, case.amplitude * (step as f64 + 0.05), step);
            let tally = it.forces(
                &body,
                &u,
                &mut f,
                Sweep::Evolve {
                    v: &zeros(body.len),
                    dt: 0.0,
                },
                None,
            );
            assert_eq!(tally.broken > 0, step > 0);
            bits.extend([tally.broken, tally.released.to_bits()]);
            bits.extend(f.iter().flatten().map(|x| x.to_bits()));
            let mut seen = PointEnergies::default();
            it.observe(&body, &u, &mut seen);
            bits.extend(seen.strain.iter().map(|x| x.to_bits()));
            let (alive, critical) = it.memory();
            bits.extend(alive.iter().map(|b| *b as u64));
            bits.extend(critical.iter().map(|x| x.to_bits()));
        }
        bits
    })
}

#[test]
fn every_width_and_number_of_threads_gives_the_same_bits() {
    let solids = lps(3).to_vec();
    let solid = EamLike {
        ratio: solids[0].ratio(),
    };
    let mixed = BondBasedMixed {
        rule: InterfaceRule::Parallel,
    };
    let both = |simd, threads| {
        let per = PointConstants::PerMaterial(vec![1.0, 2.0]);
        let eam = PointConstants::Solid(solids.clone());
        (
            trace(mixed, per, simd, threads),
            trace(solid, eam, simd, threads),
        )
    };
    let portable = both(Simd::Portable, 1);
    for simd in Simd::available() {
        for threads in [1, 3] {
            let same = both(simd, threads) == portable;
            assert!(same, "{} on {threads} threads", simd.name());
        }
    }
}

#[test]
fn forces_allocate_nothing_and_a_bond_takes_eight_bytes() {
    let case = Case::new(LatticeKind::Cubic, 3, [30, 30, 30]).breaking();
    let body = case.perturbed_cloud();
    let list = HorizonList::new(&body, case.delta()).unwrap();
    let stored = (list.bytes() + list.present.len()) as f64 / list.directed as f64;
    assert!(stored < 5.5, "{stored} bytes per bond in the list");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        let solid = lps(3)[0];
        let law = EamLike {
            ratio: solid.ratio(),
        };
        let constants = PointConstants::Solid(vec![solid]);
        let mut it = case.list(&body, law, constants, Simd::detect());
        let bytes = it.bytes() as f64 / it.directed_bonds() as f64;
        assert!(bytes <= 8.0, "{bytes} bytes per bond in all");
        let mut f = zeros(body.len);
        let u = displace(&body, case.amplitude, 3);
        let still = zeros(body.len);
        let evolve = Sweep::Evolve { v: &still, dt: 0.0 };
        it.forces(&body, &u, &mut f, evolve, None);
        let before = ALLOCATIONS.with(Cell::get);
        it.forces(&body, &u, &mut f, evolve, None);
        assert_eq!(ALLOCATIONS.with(Cell::get), before);
    });
}

#[test]
fn a_body_at_rest_has_exactly_no_force() {
    let (_, _, body, _) = random_cloud::<3>(200);
    let mut it = ListInteraction::new(ListParts {
        body: &body,
        list: HorizonList::new(&body, 2.0).unwrap(),
        law: BondBased { c: 1.0 },
        weight: BondWeight::new(Influence::Constant, 2.0, None),
        point_constants: PointConstants::None,
        toughness: vec![Toughness {
            s00: 0.1,
            alpha: 0.25,
        }],
        repulsion: None,
        simd: Simd::detect(),
    });
    let mut f = zeros(body.len);
    for _ in 0..2 {
        it.forces(
            &body,
            &body.at_rest(),
            &mut f,
            Sweep::Evolve {
                v: &zeros(body.len),
                dt: 0.0,
            },
            None,
        );
        assert!(f.iter().flatten().all(|f| *f == 0.0));
    }
    assert!((it.critical_stretch(0) - 0.1).abs() < 1e-16);
}

#[test]
fn bad_clouds_are_refused_with_help() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let cloud = |period| Body::<3>::from_cloud(&points, &[1.0; 4], &[], 1.0, [period, None, None]);
    let body = cloud(None).unwrap();
    let error = HorizonList::new(&body, 1.5).unwrap_err();
    assert!(error.message.starts_with("points 2 and 4 are in one place"));
    let body = cloud(Some(3.0)).unwrap();
    let error = HorizonList::new(&body, 1.5).unwrap_err();
    assert!(error.message.contains("period along x is 3e0"), "{error}");
    assert!(error.help.is_some());
    assert!(HorizonList::new(&body, f64::NAN).is_err());
}

#[test]
fn bonds_at_the_horizon_are_inclusive_and_counted() {
    let points: Vec<[f64; 3]> = (0..10).map(|i| [i as f64, 0.0, 0.0]).collect();
    let body = Body::<1>::from_cloud(&points, &[1.0; 10], &[], 1.0, [Some(10.0)]).unwrap();
    let counts = |horizon| {
        let list = HorizonList::new(&body, horizon).unwrap();
        (list.directed, list.near_horizon)
    };
    assert_eq!(counts(3.0), (60, 20));
    assert_eq!(counts(3.5), (60, 0));
    assert_eq!(counts(3.0 - 1e-10), (40, 20));
}
