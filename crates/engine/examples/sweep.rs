//! Time per directed bond of the force sweep: `cargo run --release --example sweep [simd [threads]]`.
use peridyne::body::{Body, Layout, zeros};
use peridyne::execute::simd::Simd;
use peridyne::family::{horizon::HorizonList, stencil::Stencil};
use peridyne::interaction::list::{ListInteraction, ListParts};
use peridyne::interaction::stencil::*;
use peridyne::interaction::weight::BondWeight;
use peridyne::interaction::*;
use peridyne::law::Law;
use peridyne::law::solid::{bond_based::BondBased, eam_like::*};
use peridyne::space::lattice::*;
use peridyne::spec::{Horizon, Influence};
use std::time::Instant;

const H: f64 = 0.0005;

/// Quarters of the disk of the impact, or of a cube.
fn sites(disk: bool) -> Vec<[i32; 3]> {
    let mut q = vec![];
    if disk {
        for z in -74..=74 {
            for y in -5..=0 {
                for x in -74..=74i32 {
                    if x * x + z * z <= 74 * 74 {
                        q.push([4 * x, 4 * y, 4 * z])
                    }
                }
            }
        }
    } else {
        for z in 0..60 {
            for y in 0..60 {
                for x in 0..60 {
                    q.push([4 * x, 4 * y, 4 * z])
                }
            }
        }
    }
    q
}

fn toughness(fracture: bool) -> Vec<Toughness> {
    vec![Toughness {
        s00: if fracture { 0.0005 } else { f64::INFINITY },
        alpha: 0.25,
    }]
}

fn repulsion(contact: bool) -> Option<Repulsion> {
    contact.then_some(Repulsion {
        stiffness: 1e26,
        bonded: 0.9,
        range: 1.35 * H,
    })
}

fn time<W: Law>(
    name: &str,
    law: W,
    pc: PointConstants,
    fracture: bool,
    contact: bool,
    simd: Simd,
    disk: bool,
) {
    let h = H;
    let lattice = Lattice {
        kind: LatticeKind::Cubic,
        spacing: h,
        origin: [0.0; 3],
    };
    let q = sites(disk);
    let st = Stencil::new(LatticeKind::Cubic, h, Horizon::Ratio(3));
    let body = Body::<3>::on_lattice(lattice, &q, st.reach, [false; 3], h * h * h).unwrap();
    let Layout::Grid(grid) = &body.layout else {
        panic!()
    };
    let weight = |r0: f64| peridyne::family::volume_fraction(r0, 3.0 * h, h);
    let it = StencilInteraction::new(StencilParts {
        body: &body,
        grid,
        stencil: &st,
        law,
        weight: &weight,
        point_constants: pc,
        toughness: toughness(fracture),
        repulsion: repulsion(contact),
        simd,
    });
    measure(name, it, &body, fracture, contact, simd);
}

/// The same for a cloud: the sites moved by up to a fifth of the spacing.
fn time_list<W: Law>(
    name: &str,
    law: W,
    pc: PointConstants,
    influence: Influence,
    fracture: bool,
    contact: bool,
    simd: Simd,
    sites: &[[i32; 3]],
) {
    let mut state = 1u64;
    let mut random = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 30) as f64 - 1.0
    };
    let position: Vec<[f64; 3]> = sites
        .iter()
        .map(|q| q.map(|q| H * (q as f64 / 4.0 + 0.2 * random())))
        .collect();
    let volume = vec![H * H * H; sites.len()];
    let body = Body::<3>::from_cloud(&position, &volume, &[], H, [None; 3]).unwrap();
    let t = Instant::now();
    let list = HorizonList::new(&body, 3.0 * H).unwrap();
    let search = t.elapsed().as_secs_f64();
    let padding = (list.partner.len() as u64 - list.directed) as f64 / list.directed as f64;
    if !fracture {
        println!("search {search:.3} s, padding {:.1} %", 100.0 * padding);
    }
    let it = ListInteraction::new(ListParts {
        body: &body,
        list,
        law,
        weight: BondWeight::new(influence, 3.0 * H, Some(H)),
        point_constants: pc,
        toughness: toughness(fracture),
        repulsion: repulsion(contact),
        simd,
    });
    measure(name, it, &body, fracture, contact, simd);
}

fn measure(
    name: &str,
    mut it: impl Interaction<3>,
    body: &Body<3>,
    fracture: bool,
    contact: bool,
    simd: Simd,
) {
    let h = H;
    it.prepare(body);
    let mut u = body.at_rest();
    for &s in &body.slots {
        let p = body.position(s as usize);
        for a in 0..3 {
            u[a][s as usize] = 2e-5 * h * ((p[a] + 2.0 * p[(a + 1) % 3]) * 300.0).sin();
        }
    }
    let mut f = zeros::<3>(body.len);
    let still = zeros::<3>(body.len);
    let mut best = f64::MAX;
    for _ in 0..if simd == Simd::Portable { 2 } else { 15 } {
        let t = Instant::now();
        it.forces(body, &u, &mut f, Sweep::Evolve { v: &still, dt: 0.0 });
        best = best.min(t.elapsed().as_secs_f64());
    }
    println!(
        "{name:14} {:9} fracture {fracture:5} contact {contact:5} {} points: {:.3} ns/bond  {:.2} ms  {} B/point",
        simd.name(),
        body.points(),
        best * 1e9 / it.directed_bonds() as f64,
        best * 1e3,
        (it.bytes() + body.bytes()) / body.points()
    );
}

fn main() {
    let pick = std::env::args().nth(1);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(std::env::args().nth(2).map_or(1, |n| n.parse().unwrap()))
        .build()
        .unwrap();
    pool.install(|| {
        for simd in Simd::available() {
            if pick.as_ref().is_some_and(|p| p != simd.name()) {
                continue;
            }
            for disk in [true, false] {
                for (f, c) in [(false, false), (true, false), (true, true)] {
                    time(
                        "pmb",
                        BondBased { c: 1.6863e22 },
                        PointConstants::None,
                        f,
                        c,
                        simd,
                        disk,
                    );
                    let s = Solid::lps(3, 14.9e9 * (1.0 - 2.0 / 3.0), 14.9e9);
                    time(
                        "lps",
                        EamLike { ratio: s.ratio() },
                        PointConstants::Solid(vec![s]),
                        f,
                        c,
                        simd,
                        disk,
                    );
                    let q = sites(disk);
                    let constants = PointConstants::None;
                    let one = Influence::Constant;
                    let law = BondBased { c: 1.6863e22 };
                    time_list("pmb list", law, constants, one, f, c, simd, &q);
                    let law = EamLike { ratio: s.ratio() };
                    let constants = PointConstants::Solid(vec![s]);
                    let inverse = Influence::Inverse;
                    time_list("lps list", law, constants, inverse, f, c, simd, &q);
                }
            }
        }
    });
}
