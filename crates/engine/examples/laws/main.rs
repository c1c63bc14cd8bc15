//! Time per directed bond and step of laws of the registry beside the linear solid, whole steps in 3-D, on one thread or as many as asked for:
//! `cargo run --release --example laws [threads] [words]`. Only rows with every word run, for example `laws avx2 stencil plastic`. A word
//! `cells=20` makes the cube smaller than the 60 cells along an edge that no cache holds. The first rows are what such arithmetic costs alone
//! ([`limit`]), on one thread; the last ones are of a chain of 200 points, whose step is so short that calls are most of it.
use peridyne::execute::simd::Simd;
use peridyne::expression::Expression;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use std::time::Instant;

mod limit;

/// A cube of so many cells along an edge, whose families have 122 bonds.
fn spec(cells: i32, law: LawSpec, breaks: bool, family: FamilyChoice) -> Spec {
    let mut quarters = vec![];
    for z in 0..cells {
        for y in 0..cells {
            for x in 0..cells {
                quarters.push([4 * x, 4 * y, 4 * z]);
            }
        }
    }
    spec_of(LatticeKind::Cubic, quarters, law, breaks, family)
}

/// The bench of what a step costs beside its bonds.
const CHAIN: &str = "chain of 200, pmb";

/// Its points have families of 6 bonds.
fn chain(breaks: bool, family: FamilyChoice) -> Spec {
    let quarters = (0..200).map(|x| [4 * x, 0, 0]).collect();
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(1.0));
    spec_of(LatticeKind::Chain, quarters, law, breaks, family)
}

fn spec_of(
    kind: LatticeKind,
    quarters: Vec<[i32; 3]>,
    law: LawSpec,
    breaks: bool,
    family: FamilyChoice,
) -> Spec {
    let body = BodySpec::Sites {
        kind,
        spacing: 1.0,
        origin: [0.0; 3],
        quarters,
        volume: None,
    };
    let mut spec = Spec::new(kind.dimension(), body, 1.0, law);
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.bonds.influence = Influence::Inverse;
    spec.bonds.partial_volume_correction = true;
    spec.bonds.family = family;
    spec.run.schedule.time_step = TimeStep::Fraction(0.1);
    if breaks {
        spec.materials[0].fracture = Some(FractureSpec {
            criterion: Criterion::Stretch(0.5),
            alpha: 0.0,
            rate: None,
            fatigue: None,
        });
    }
    spec
}

/// Rows: name, law.
fn laws() -> Vec<(&'static str, LawSpec)> {
    let elastic = || Parameters::numbers(&[("young", 1.0), ("poisson", 0.3)]);
    let plastic = |yields: f64| {
        let all = elastic()
            .with("yield_stress", Parameter::Number(yields))
            .with("hardening", Parameter::Number(0.1));
        LawSpec::named("elastic_plastic", all)
    };
    let metal = |yields: f64| {
        let all = elastic()
            .with("yield_stress", Parameter::Number(yields))
            .with("hardening", Parameter::Number(0.1));
        LawSpec::named("hypoelastic_plastic", all)
    };
    let branches = |count: usize| {
        let rows = (0..count)
            .map(|b| vec![0.2, 10f64.powi(b as i32)])
            .collect();
        LawSpec::named(
            "viscoelastic",
            elastic().with("branches", Parameter::Rows(rows)),
        )
    };
    let correspondence = |stress: &str| {
        let all = elastic().with("stress", Parameter::Word(stress.into()));
        LawSpec::named("correspondence", all)
    };
    // E = 1, ν = 0.3
    let energy = Expression::of(
        &["I1", "I2", "J"],
        "mu/2*(I1 - 3) - mu*ln(J) + l/2*ln(J)^2",
        &[("mu", 1.0 / 2.6), ("l", 0.3 / 0.52)],
    )
    .expect("an energy");
    let written = Parameters::default().with("energy", Parameter::Formula(energy));
    let fluid = [("bulk", 1.0), ("hugoniot_slope", 1.5), ("gruneisen", 2.0)];
    let ply = |fibre: Parameter, gradient: &str| {
        let list = |x: [f64; 3]| Parameter::List(x.to_vec());
        let all = Parameters::default()
            .with("young", list([4.0, 1.0, 0.8]))
            .with("poisson", list([0.3, 0.25, 0.4]))
            .with("shear", list([0.5, 0.4, 0.35]))
            .with("fibre", fibre)
            .with("gradient", Parameter::Word(gradient.into()));
        LawSpec::named("anisotropic", all)
    };
    let straight = || Parameter::List(vec![1.0, 1.0, 0.0]);
    let bent = || {
        let component = |text: &str| Expression::parse(text, &[]).expect("an expression");
        Parameter::Direction(["-y - 1", "x + 1", "0"].map(component))
    };
    let softening = Parameters::numbers(&[("young", 1.0), ("onset", 0.1)]);
    let lamina = Parameters::numbers(&[("fibre_critical_stretch", 0.5)])
        .with("young", Parameter::List(vec![4.0, 1.0]));
    vec![
        (
            "lps",
            LawSpec::Lps(Moduli {
                young: 1.0,
                poisson: 0.3,
            }),
        ),
        ("plastic, elastic yet", plastic(1e3)),
        ("plastic, flowing", plastic(1e-9)),
        ("viscoelastic, 1 branch", branches(1)),
        ("viscoelastic, 4 branches", branches(4)),
        ("correspondence, linear", correspondence("linear")),
        ("correspondence, neo_hookean", correspondence("neo_hookean")),
        (
            "neo_hookean, written",
            LawSpec::named("hyperelastic", written),
        ),
        (
            "fluid",
            LawSpec::named("fluid", Parameters::numbers(&fluid)),
        ),
        ("pals", LawSpec::named("pals", elastic())),
        (
            "bond_rotation",
            LawSpec::named(
                "bond_rotation",
                Parameters::numbers(&[("young", 1.0), ("poisson", 0.15)]),
            ),
        ),
        ("hypoelastic", LawSpec::named("hypoelastic", elastic())),
        ("metal, elastic yet", metal(1e3)),
        ("metal, flowing", metal(1e-9)),
        ("softening", LawSpec::named("softening", softening)),
        ("lamina", LawSpec::named("lamina", lamina)),
        ("ply, straight", ply(straight(), "family")),
        ("ply, bent", ply(bent(), "family")),
        ("ply of bonds, straight", ply(straight(), "bond")),
        ("ply of bonds, bent", ply(bent(), "bond")),
    ]
}

fn main() {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let threads = words.first().and_then(|w| w.parse().ok());
    if threads.is_some() {
        words.remove(0);
    }
    let size = words.iter().position(|w| w.starts_with("cells="));
    let cells = size.map_or(60, |n| {
        let word = words.remove(n);
        word["cells=".len()..].parse().expect("a number of cells")
    });
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(1))
        .build()
        .expect("a pool of threads");
    #[cfg(target_arch = "x86_64")]
    limit::print();
    for simd in Simd::available() {
        let cubes = laws().into_iter().map(|(name, law)| (name, Some(law)));
        for (name, law) in cubes.chain([(CHAIN, None)]) {
            for family in [FamilyChoice::Stencil, FamilyChoice::List] {
                for breaks in [false, true] {
                    // they must be able to break
                    if ["softening", "lamina"].contains(&name) && !breaks {
                        continue;
                    }
                    let row = format!(
                        "{:8} {:8} {:6} {name}",
                        simd.name(),
                        format!("{family:?}").to_lowercase(),
                        if breaks { "breaks" } else { "intact" }
                    );
                    if words.iter().all(|w| row.contains(w.as_str())) {
                        let spec = match &law {
                            Some(law) => spec(cells, law.clone(), breaks, family),
                            None => chain(breaks, family),
                        };
                        pool.install(|| time(&row, &spec, simd));
                    }
                }
            }
        }
    }
}

fn time(row: &str, spec: &Spec, simd: Simd) {
    let options = Options {
        simd: Some(simd),
        ..Options::default()
    };
    let mut sim = match build(spec, options) {
        Ok(sim) => sim,
        Err(error) => {
            println!("{row:55} {error}");
            return;
        }
    };
    let n = sim.info().points as usize;
    let wave = |i: usize, a: usize| 1e-3 * (0.37 * i as f64 + 2.0 * a as f64).sin();
    let v: Vec<[f64; 3]> = (0..n)
        .map(|i| std::array::from_fn(|a| wave(i, a)))
        .collect();
    sim.set_velocities(&v);
    sim.start(false);
    let mut best = f64::MAX;
    let steps = match simd {
        _ if spec.space.dimension == 1 => 2000,
        Simd::Portable => 3,
        _ => 16,
    };
    for _ in 0..steps {
        let start = Instant::now();
        sim.step().expect("a step");
        best = best.min(start.elapsed().as_secs_f64());
    }
    let bonds = sim.info().directed_bonds as f64;
    println!(
        "{row:55} {:7.3} ns/bond {:10.4} ms {:5} B/point",
        best * 1e9 / bonds,
        best * 1e3,
        sim.info().bytes / n
    );
}
