//! Time per directed bond of the force sweep, on one thread or as many as asked for:
//! `cargo run --release --example sweep [threads] [words]`. Only cases whose line has every word run, for example
//! `sweep avx2 cube lps/stencil mixed`; bodies are calm where no word says otherwise.
use peridyne::body::{Body, view, view_mut, zeros};
use peridyne::execute::simd::Simd;
use peridyne::family::{horizon::HorizonList, stencil::Stencil};
use peridyne::interaction::list::{ListInteraction, ListParts};
use peridyne::interaction::stencil::*;
use peridyne::interaction::weight::BondWeight;
use peridyne::interaction::*;
use peridyne::law::Law;
use peridyne::law::solid::{bond_based::BondBased, eam_like::*};
use peridyne::space::lattice::*;
use peridyne::spec::{Breakage, Horizon, Influence};
use std::time::Instant;

/// Spacing (m).
const H: f64 = 0.0005;

/// How far bonds are stretched.
#[derive(Clone, Copy, PartialEq)]
enum State {
    /// Strains of 1e-5.
    Calm,
    /// Strains of 1e-3.
    Strained,
    /// From nothing to a tenth, side by side.
    Mixed,
    /// A third of the body thrown about by tenths of a spacing, the rest mixed.
    Debris,
}

impl State {
    const ALL: [State; 4] = [State::Calm, State::Strained, State::Mixed, State::Debris];

    fn name(self) -> &'static str {
        match self {
            State::Calm => "calm",
            State::Strained => "strained",
            State::Mixed => "mixed",
            State::Debris => "debris",
        }
    }

    /// Of a point (length), from its place and a number of its own in ±1.
    fn displacement(self, p: [f64; 3], a: usize, random: f64) -> f64 {
        let wave = ((p[a] + 2.0 * p[(a + 1) % 3]) * 300.0).sin();
        let mixed = 10f64.powf(-4.0 + 3.5 * (p[2] * 90.0).sin());
        match self {
            State::Calm => 2e-5 * H * wave,
            State::Strained => 2e-3 * H * wave,
            State::Mixed => mixed * H * random,
            State::Debris if (p[0] * 400.0).sin() > 0.5 => 0.3 * H * random,
            State::Debris => mixed * H * random,
        }
    }
}

#[derive(Clone, Copy)]
struct Case {
    simd: Simd,
    /// The disk of the impact, else a cube.
    disk: bool,
    /// Points off the lattice, in a horizon list.
    cloud: bool,
    lps: bool,
    fracture: bool,
    contact: bool,
    state: State,
}

impl Case {
    fn name(&self) -> String {
        format!(
            "{:8} {} {}/{:7} {} {} {:8}",
            self.simd.name(),
            if self.disk { "disk" } else { "cube" },
            if self.lps { "lps" } else { "pmb" },
            if self.cloud { "list" } else { "stencil" },
            if self.fracture { "breaks" } else { "intact" },
            if self.contact { "contact" } else { "free   " },
            self.state.name(),
        )
    }

    /// Sites in quarters of the cell's edges.
    fn sites(&self) -> Vec<[i32; 3]> {
        let (x, y) = if self.disk {
            (-74..75, -5..1)
        } else {
            (0..60, 0..60)
        };
        let mut sites = vec![];
        for k in x.clone() {
            for j in y.clone() {
                for i in x.clone() {
                    if !self.disk || i * i + k * k <= 74 * 74 {
                        sites.push([4 * i, 4 * j, 4 * k]);
                    }
                }
            }
        }
        sites
    }

    fn toughness(&self) -> Vec<Toughness> {
        vec![Toughness {
            s00: if self.fracture { 0.0005 } else { f64::INFINITY },
            alpha: 0.25,
        }]
    }

    fn repulsion(&self) -> Option<Repulsion> {
        self.contact
            .then(|| Repulsion::uniform(1e26, 0.9, 1.35 * H))
    }

    fn time(&self) {
        if self.lps {
            let solid = Solid::lps(3, 14.9e9 * (1.0 - 2.0 / 3.0), 14.9e9);
            let ratio = solid.ratio();
            let constants = PointConstants::Solid(vec![solid]);
            self.on_family(EamLike { ratio }, constants);
        } else {
            self.on_family(BondBased { c: 1.6863e22 }, PointConstants::None);
        }
    }

    fn on_family<W: Law>(&self, law: W, point_constants: PointConstants) {
        if self.cloud {
            self.on_list(law, point_constants);
        } else {
            self.on_stencil(law, point_constants);
        }
    }

    fn on_stencil<W: Law>(&self, law: W, point_constants: PointConstants) {
        let lattice = Lattice {
            kind: LatticeKind::Cubic,
            spacing: H,
            origin: [0.0; 3],
        };
        let stencil = Stencil::new(LatticeKind::Cubic, H, Horizon::Ratio(3));
        let body = Body::<3>::on_lattice(
            lattice,
            &self.sites(),
            stencil.reach(),
            [false; 3],
            H * H * H,
        )
        .unwrap();
        let it = StencilInteraction::new(StencilParts {
            body: &body,
            stencil: &stencil,
            law,
            weight: &|_, r0| peridyne::family::volume_fraction(r0, 3.0 * H, H),
            point_constants,
            toughness: self.toughness(),
            repulsion: self.repulsion(),
            simd: self.simd,
        });
        self.measure(it, &body);
    }

    /// The same sites moved by up to a fifth of the spacing.
    fn on_list<W: Law>(&self, law: W, point_constants: PointConstants) {
        let mut random = random();
        let move_site = |q: &[i32; 3]| q.map(|q| H * (q as f64 / 4.0 + 0.2 * random()));
        let position: Vec<[f64; 3]> = self.sites().iter().map(move_site).collect();
        let volume = vec![H * H * H; position.len()];
        let body = Body::<3>::from_cloud(&position, &volume, &[], H, [None; 3]).unwrap();
        let influence = if self.lps {
            Influence::Inverse
        } else {
            Influence::Constant
        };
        let it = ListInteraction::new(ListParts {
            body: &body,
            list: HorizonList::new(&body, 3.0 * H).unwrap(),
            law,
            weight: BondWeight::new(influence, 3.0 * H, Some(H)),
            point_constants,
            toughness: self.toughness(),
            repulsion: self.repulsion(),
            simd: self.simd,
        });
        self.measure(it, &body);
    }

    fn measure(&self, mut it: impl Interaction<3>, body: &Body<3>) {
        it.prepare(body);
        let mut u = body.at_rest();
        let mut random = random();
        for &s in body.slots() {
            let p = body.position(s as usize);
            for a in 0..3 {
                u[a][s as usize] = self.state.displacement(p, a, random());
            }
        }
        let mut f = zeros::<3>(body.len());
        let v = zeros::<3>(body.len());
        let mut best = f64::MAX;
        for _ in 0..if self.simd == Simd::Portable { 2 } else { 20 } {
            let start = Instant::now();
            it.forces(
                body,
                view(&u),
                view_mut(&mut f),
                Sweep::Evolve {
                    v: view(&v),
                    steps: [0.0; 2],
                    breakage: Breakage::AfterForce,
                },
                None,
            );
            best = best.min(start.elapsed().as_secs_f64());
        }
        println!(
            "{} {} points {:7.3} ns/bond {:8.2} ms {:4} B/point",
            self.name(),
            body.points(),
            best * 1e9 / it.directed_bonds() as f64,
            best * 1e3,
            (it.bytes() + body.bytes()) / body.points()
        );
    }
}

/// Numbers in ±1, the same every time.
fn random() -> impl FnMut() -> f64 {
    let mut state = 1u64;
    move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 30) as f64 - 1.0
    }
}

fn main() {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let threads = words.first().and_then(|w| w.parse().ok());
    if threads.is_some() {
        words.remove(0);
    }
    let named = |s: &State| words.iter().any(|w| w == s.name());
    let mut states: Vec<State> = State::ALL.into_iter().filter(named).collect();
    if states.is_empty() {
        states.push(State::Calm);
    }
    let mut cases = vec![];
    for simd in Simd::available() {
        for disk in [true, false] {
            for cloud in [false, true] {
                for lps in [false, true] {
                    for (fracture, contact) in [(false, false), (true, false), (true, true)] {
                        for &state in &states {
                            cases.push(Case {
                                simd,
                                disk,
                                cloud,
                                lps,
                                fracture,
                                contact,
                                state,
                            });
                        }
                    }
                }
            }
        }
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(1))
        .build()
        .expect("a pool of threads");
    pool.install(|| {
        cases
            .iter()
            .filter(|c| {
                let name = c.name();
                words
                    .iter()
                    .all(|w| name.contains(w.as_str()) || State::ALL.iter().any(|s| w == s.name()))
            })
            .for_each(Case::time)
    });
}
