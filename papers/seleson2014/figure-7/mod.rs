//! Fig. 7: the taxonomy, each arrow as two programs that give the same forces under random displacements.

mod states;
mod structureless;

use peridyne::law::potential::Described;
use peridyne::law::potential::mei::EamForm;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::{
    BodySpec, FamilyChoice, Formula, Horizon, Influence, LawSpec, Moduli, PmbStiffness, Spec,
};
use peridyne_io::write::table::Table;

use crate::measure::{apart, largest};
use crate::seleson2014::chain::{Family, parsed};
use crate::{Context, Failure, Findings};
use states::{Family as Bonds, Solid};

experiment!(
    Figure7,
    "figure-7",
    "The taxonomy of peridynamic models, as equivalences",
    [
        "states.rs",
        "structureless.rs",
        "../chain.rs",
        "../figure-1/chain.toml"
    ]
);

/// K, G of an arbitrary solid.
const BULK: f64 = 2.3;
const SHEAR: f64 = 0.7;

/// Numbers between −1 and 1 from a linear congruence.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = (self.0.wrapping_mul(6_364_136_223_846_793_005))
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn body(kind: LatticeKind, points: usize, spacing: f64) -> BodySpec {
    let top = spacing * (points - 1) as f64;
    let high = std::array::from_fn(|a| if a < kind.dimension() { top } else { 0.0 });
    BodySpec::Lattice {
        kind,
        spacing,
        origin: [0.0; 3],
        region: Region::Block {
            low: [0.0; 3],
            high,
        },
        perturb: None,
    }
}

/// Force densities by the engine, on a periodic lattice of `points` per axis.
fn engine(
    bonds: &Bonds,
    law: LawSpec,
    influence: Influence,
    u: &[[f64; 3]],
) -> Result<Vec<[f64; 3]>, Failure> {
    let kind = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][bonds.dimension - 1];
    let mut spec = Spec::new(
        bonds.dimension,
        body(kind, bonds.points, bonds.spacing),
        1.0,
        law,
    );
    spec.bonds.horizon = Horizon::Ratio(bonds.reach as u32);
    spec.bonds.influence = influence;
    for a in 0..bonds.dimension {
        spec.space.periodic[a] = Some(bonds.points as f64 * bonds.spacing);
    }
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    spec.run.schedule.time_step = peridyne::spec::TimeStep::Fixed(1e-3);
    let mut sim = build(&spec, options).map_err(|e| Failure::new(e.to_string()))?;
    Ok(sim.forces_under(u))
}

/// Largest difference relative to the largest force.
fn relative(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let (a, b) = (a.as_flattened(), b.as_flattened());
    apart(a, b) / largest(b.iter().map(|x| x.abs()))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let mut table: Vec<(String, f64)> = vec![];
    let mut note = |found: &mut Findings, key: String, value: f64| {
        found.number(&key, value);
        table.push((key, value));
    };
    for (dimension, points, reach) in [(2, 11, 3), (3, 8, 2)] {
        let bonds = Bonds::periodic(dimension, points, reach, 0.1);
        let mut noise = Noise(7 + dimension as u64);
        let mut u = vec![[0.0; 3]; bonds.len()];
        for x in &mut u {
            x[..dimension].fill_with(|| 0.02 * noise.next());
        }
        let d = |name: &str| format!("{name}-{dimension}d");
        let inverse = |r: f64| 1.0 / r;
        let as_typed = LawSpec::Lps3d {
            bulk: BULK,
            shear: SHEAR,
        };

        // (A.6) in (A.1), and (A.13) with (A.14)-(A.16): for ω = 1 and ω = 1/ξ
        let mut worst = [0.0f64; 2];
        for (influence, omega) in [
            (Influence::Constant, &(|_: f64| 1.0) as &dyn Fn(f64) -> f64),
            (Influence::Inverse, &inverse),
        ] {
            let solid = Solid::new(&bonds, omega, BULK, SHEAR);
            let lps = solid.lps(&u);
            let typed = engine(&bonds, as_typed.clone(), influence, &u)?;
            worst[0] = largest([worst[0], relative(&solid.eam_like(&u), &lps)]);
            worst[1] = largest([worst[1], relative(&typed, &lps)]);
        }
        note(&mut found, d("eam-like"), worst[0]);
        note(&mut found, d("engine"), worst[1]);

        // (4.10) written out, against (A.26) in the LPS, p = 1 and p = 2
        let (k, c) = (30.0 * SHEAR, 9.0 * BULK - 15.0 * SHEAR);
        let mut worst = 0.0f64;
        for p in [0, 1, 2] {
            let structured = states::structured(&bonds, p, k, c, &u);
            let omega = move |r: f64| r.powi(-p);
            let lps = Solid::new(&bonds, &omega, BULK, SHEAR).lps(&u);
            worst = largest([worst, relative(&structured, &lps)]);
        }
        note(&mut found, d("structured"), worst);
        let law = LawSpec::EamLike {
            pair: k,
            volume: c / 3.0,
        };
        let mut worst = 0.0f64;
        for p in [0, 1, 2] {
            let structured = states::structured(&bonds, p, k, c, &u);
            let formula =
                Formula::parse(&format!("r^-{p}"), &[]).map_err(|e| Failure::new(e.to_string()))?;
            let run = engine(&bonds, law.clone(), Influence::Formula(formula), &u)?;
            worst = largest([worst, relative(&run, &structured)]);
        }
        note(&mut found, d("deck"), worst);

        // ν = 1/4: P = 0, and with ω = 1/ξ it is PMB with c = 30 G/m
        let solid = Solid::new(&bonds, &inverse, 5.0 / 3.0 * SHEAR, SHEAR);
        let lps = solid.lps(&u);
        note(
            &mut found,
            d("bond-based"),
            relative(&solid.pairs(&u), &lps),
        );
        let micromodulus = 30.0 * SHEAR / solid.m;
        let pmb = LawSpec::Pmb(PmbStiffness::Micromodulus(micromodulus));
        let run = engine(&bonds, pmb, Influence::Constant, &u)?;
        note(&mut found, d("pmb"), relative(&run, &lps));
        if dimension == 3 {
            let moduli = Moduli {
                young: 1.0,
                poisson: 0.25,
            };
            let lps = engine(&bonds, LawSpec::Lps(moduli), Influence::Inverse, &u)?;
            let micromodulus = 30.0 * moduli.shear() / solid.m;
            let pmb = LawSpec::Pmb(PmbStiffness::Micromodulus(micromodulus));
            let pmb = engine(&bonds, pmb, Influence::Constant, &u)?;
            note(&mut found, "pmb-quarter".into(), relative(&pmb, &lps));
        }
        // what would hide an error of the volume term
        let without = Solid::new(&bonds, &inverse, BULK, SHEAR);
        let difference = relative(&without.pairs(&u), &without.lps(&u));
        found.holds(
            &d("not-bond-based"),
            format!(
                "forces of the pairs alone differ by {:.0} %",
                100.0 * difference
            ),
            difference > 0.01,
        );
    }

    // (3.4), (3.5) by hand against the generalised EAM-like model with j = f and w = φ, for h = 1 and 4
    let mut worst = 0.0f64;
    for h in [1.0, 4.0] {
        let deck = parsed(h, Family::Chain)?;
        let mut spec = deck.spec.clone();
        let points = 40;
        spec.body = body(LatticeKind::Chain, points, h);
        spec.space.periodic[0] = Some(points as f64 * h);
        spec.bonds.family = FamilyChoice::Stencil;
        spec.sets.clear();
        spec.loading.initial.clear();
        spec.loading.conditions.clear();
        let read = spec.potential().map(|p| EamForm::read(&p.parameters));
        let Some(Ok(mei)) = read else {
            return Err(Failure::new("the deck has another potential"));
        };
        let mut noise = Noise(3);
        let u: Vec<f64> = (0..points).map(|_| 0.08 * h * noise.next()).collect();
        let by_hand = structureless::forces(&mei, h, &u);
        let mut sim = build(&spec, Options::default()).map_err(|e| Failure::new(e.to_string()))?;
        let u: Vec<[f64; 3]> = u.iter().map(|u| [*u, 0.0, 0.0]).collect();
        worst = largest([worst, relative(&sim.forces_under(&u), &by_hand)]);
    }
    note(&mut found, "structureless".into(), worst);

    let path = context.out.join("differences.csv");
    Table::new()
        .text("equivalence", table.iter().map(|t| t.0.clone()))
        .column(
            "largest difference of forces, relative",
            "",
            table.iter().map(|t| t.1),
        )
        .save(&path)?;
    found.file(path);
    Ok(found)
}
