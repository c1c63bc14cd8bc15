//! Points with horizons of their own: action and reaction, energy, what a uniform strain leaves, and what a wave sees of it.

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn text(e: &str) -> Option<Expression> {
    Some(Expression::parse(e, &[]).unwrap())
}

fn solid(size: &[f64], longest: f64, own: Option<&str>) -> Spec {
    let d = size.len();
    let kind = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][d - 1];
    let high = std::array::from_fn(|a| size.get(a).copied().unwrap_or(0.0));
    let body = BodySpec::lattice(
        kind,
        1.0,
        Region::Block {
            low: [0.0; 3],
            high,
        },
    );
    let mut spec = Spec::new(d, body, 1.0, LawSpec::Pmb(PmbStiffness::Young(1.0)));
    spec.bonds.horizon = Horizon::Length(longest);
    spec.bonds.family = FamilyChoice::List;
    spec.bonds.calibration = Calibration::Continuum;
    spec.bonds.partial_volume_correction = true;
    spec.bonds.variable_horizon = own.and_then(text);
    spec
}

/// Laws whose stiffness their families make, of one E and ν.
fn of_families(d: usize) -> Vec<LawSpec> {
    let moduli = Moduli {
        young: 1.0,
        poisson: 0.3,
    };
    let named = |name: &str, more: &[(&str, f64)]| {
        let mut all = Parameters::numbers(&[("young", 1.0), ("poisson", 0.3)]);
        more.iter()
            .for_each(|(k, v)| all.set(k, Parameter::Number(*v)));
        LawSpec::named(name, all)
    };
    let mut laws = vec![LawSpec::Lps(moduli)];
    if d > 1 {
        laws.push(named("correspondence", &[]));
    }
    if d == 2 {
        laws.extend([of_bond_gradients(), turning()]);
    }
    if d == 3 {
        laws.push(named("elastic_plastic", &[("yield_stress", 1e3)]));
    }
    laws
}

/// A classical law of a gradient for each bond.
fn of_bond_gradients() -> LawSpec {
    let moduli = Parameters::numbers(&[("young", 1.0), ("poisson", 0.3)]);
    let gradient = Parameter::Word("bond".into());
    LawSpec::named("correspondence", moduli.with("gradient", gradient))
}

/// Bonds of two stiffnesses, along and across.
fn turning() -> LawSpec {
    let moduli = Parameters::numbers(&[("young", 1.0), ("poisson", 0.2)]);
    LawSpec::named("bond_rotation", moduli)
}

fn with_law(mut spec: Spec, law: &LawSpec) -> Spec {
    spec.materials[0].law = law.clone();
    if matches!(law, LawSpec::Lps(_)) {
        spec.bonds.influence = Influence::Inverse;
    }
    spec
}

fn started(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    sim
}

fn bent(sim: &mut dyn Simulation) -> Vec<[f64; 3]> {
    let d = sim.info().dimension;
    let x = sim.vectors("reference");
    let u = |x: &[f64; 3]| -> [f64; 3] {
        let all = [
            0.02 * (x[0] - 0.3 * x[1]).sin(),
            0.03 * (0.7 * x[1] + x[2]).cos(),
            0.01 * (x[0] * 0.4 + x[2]).sin(),
        ];
        std::array::from_fn(|a| if a < d { all[a] } else { 0.0 })
    };
    x.iter().map(u).collect()
}

const GRADED: &str = "2.05 + 1.5*clamp((x-3)/6, 0, 1)";

#[test]
fn alike_horizons_are_those_of_the_body() {
    // no pair is further apart than the horizon by less than half a spacing
    let cases = [(&[20.0][..], 2.45, "2.45"), (&[9.0, 8.0], 2.3, "2.3")];
    let pmb = [LawSpec::Pmb(PmbStiffness::Young(1.0))];
    let each = cases.into_iter().flat_map(|case| {
        let laws = pmb.iter().cloned().chain(of_families(case.0.len()));
        laws.map(move |law| (case, law)).collect::<Vec<_>>()
    });
    let each = each.flat_map(|case| influences().map(move |influence| (case.clone(), influence)));
    for (((size, horizon, own), law), influence) in each {
        let of = |own: Option<&str>| {
            let mut spec = with_law(solid(size, horizon, own), &law);
            spec.bonds.influence = influence;
            started(&spec)
        };
        let (mut one, mut own) = (of(None), of(Some(own)));
        assert_eq!(one.info().directed_bonds, own.info().directed_bonds);
        let u = bent(one.as_mut());
        let (f, g) = (one.forces_under(&u), own.forces_under(&u));
        let most = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for (f, g) in f.iter().zip(&g) {
            for a in 0..3 {
                assert!(
                    (f[a] - g[a]).abs() < 1e-12 * most,
                    "{law:?} {influence:?}: {f:?} {g:?}"
                );
            }
        }
    }
}

/// Words, and expressions of the length, of the horizon and of the direction.
fn influences() -> impl Iterator<Item = Influence> + Clone {
    let written = |e: &str| Influence::Formula(Formula::parse(e, &[]).unwrap());
    let all = [
        written("exp(-r/delta)"),
        written("(1 + 0.4*xi_x/r)*(1.2 - r/delta)"),
        written("exp(-r/3)"),
    ];
    Influence::ALL.into_iter().chain(all)
}

/// The force on every point of a line by `Σ_j ½ (c_i ω_i ν_i + c_j ω_j ν_j) s sign ξ`, with `c = 2E/∫ω|ξ|dξ` at the horizon of each end.
#[test]
fn both_ends_of_a_bond_weigh_it_by_their_variable_horizon() {
    // ∫ω|ξ|dξ over the segment, and ω within the horizon
    type Closed = (&'static str, fn(f64) -> f64, fn(f64, f64) -> f64);
    let cases: [Closed; 4] = [
        ("1", |d| d * d, |_, _| 1.0),
        ("1 - r/delta", |d| d * d / 3.0, |r, d| 1.0 - r.min(d) / d),
        ("1/r", |d| 2.0 * d, |r, _| 1.0 / r),
        (
            "exp(-r/delta)",
            |d| 2.0 * d * d * (1.0 - 2.0 * (-1.0f64).exp()),
            |r, d| (-r.min(d) / d).exp(),
        ),
    ];
    for (influence, first, omega) in cases {
        let mut spec = solid(&[20.0], 3.6, Some(GRADED));
        spec.bonds.influence = Influence::Formula(Formula::parse(influence, &[]).unwrap());
        let mut sim = started(&spec);
        let x: Vec<f64> = sim.vectors("reference").iter().map(|x| x[0]).collect();
        let u = bent(sim.as_mut());
        let f = sim.forces_under(&u);
        let most = f.iter().fold(0.0f64, |m, f| m.max(f[0].abs()));
        let horizon = |x: f64| 2.05 + 1.5 * ((x - 3.0) / 6.0).clamp(0.0, 1.0);
        for (i, found) in f.iter().map(|f| f[0]).enumerate() {
            let mut exact = 0.0;
            for j in (0..x.len()).filter(|j| *j != i) {
                let (xi, eta) = (x[j] - x[i], u[j][0] - u[i][0]);
                let r = xi.abs();
                let half = |at: f64| {
                    let d = horizon(at);
                    let nu = (0.5 + d - r).clamp(0.0, 1.0);
                    2.0 / first(d) * omega(r, d) * nu
                };
                let stretch = ((xi + eta).abs() - r) / r;
                exact += 0.5 * (half(x[i]) + half(x[j])) * stretch * (xi + eta).signum();
            }
            assert!(
                (found - exact).abs() < 1e-12 * most,
                "{influence} at {}: {found:e} {exact:e}",
                x[i]
            );
        }
    }
}

/// Parts of cells beyond a horizon at which ω is 0 bear nothing: they are no bonds, whose damage would count.
#[test]
fn a_point_has_no_bonds_that_weigh_nothing() {
    for law in [
        LawSpec::Pmb(PmbStiffness::Young(1.0)),
        of_families(2).remove(0),
    ] {
        for influence in [Influence::Linear, Influence::CubicSpline] {
            let mut spec = with_law(solid(&[9.0, 8.0], 2.9, Some("2.9")), &law);
            spec.bonds.influence = influence;
            let mut sim = started(&spec);
            let x = sim.vectors("reference");
            let square = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum();
            let within = |r2: f64| r2 > 0.0 && r2 <= 2.9 * 2.9;
            let near = x.iter().flat_map(|a| x.iter().map(move |b| square(a, b)));
            let bonds = near.filter(|r2| within(*r2)).count();
            assert_eq!(
                sim.info().directed_bonds,
                bonds as u64,
                "{law:?} {influence:?}"
            );
        }
    }
}

#[test]
fn unlike_horizons_keep_momentum_and_energy() {
    let sizes = [&[20.0][..], &[12.0, 8.0], &[12.0, 5.0, 5.0]];
    let pmb = [LawSpec::Pmb(PmbStiffness::Young(1.0))];
    let each = sizes.into_iter().flat_map(|size| {
        let laws = pmb.iter().cloned().chain(of_families(size.len()));
        laws.map(move |law| (size, law)).collect::<Vec<_>>()
    });
    for (size, law) in each {
        let mut sim = started(&with_law(solid(size, 3.6, Some(GRADED)), &law));
        let u = bent(sim.as_mut());
        let x = sim.vectors("reference");
        let f = sim.forces_under(&u);
        let (mut force, mut moment, mut most) = ([0.0; 3], [0.0; 3], 0.0f64);
        for ((f, x), u) in f.iter().zip(&x).zip(&u) {
            let y: [f64; 3] = std::array::from_fn(|a| x[a] + u[a]);
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                force[a] += f[a];
                moment[a] += y[b] * f[c] - y[c] * f[b];
                most = most.max(f[a].abs());
            }
        }
        let round_off = 1e-12 * most * f.len() as f64;
        for a in 0..3 {
            assert!(force[a].abs() < round_off, "{force:?}");
            assert!(moment[a].abs() < 20.0 * round_off, "{moment:?}");
        }
        // forces are the slope of the energy: it is kept, and to second order in the step
        let off = |fraction: f64| {
            let mut spec = with_law(solid(size, 3.6, Some(GRADED)), &law);
            spec.run.schedule.time_step = TimeStep::Fraction(fraction);
            let mut sim = started(&spec);
            sim.set_displacements(&u);
            sim.start(true);
            let mut worst = 0.0f64;
            while sim.time() < 20.0 {
                sim.step().unwrap();
                let l = sim.ledger().unwrap();
                worst = worst.max((l.residual() / l.initial).abs());
            }
            worst
        };
        let (coarse, fine) = (off(0.2), off(0.1));
        assert!(coarse < 5e-2, "{law:?}: {coarse}");
        assert!(fine < 0.35 * coarse, "{law:?}: {coarse} {fine}");
    }
}

/// Tangents are those of the forces.
#[test]
fn a_body_of_unlike_horizons_has_an_equilibrium() {
    for law in [LawSpec::Pmb(PmbStiffness::Young(1.0))]
        .into_iter()
        .chain(of_families(2))
    {
        has_an_equilibrium(&law);
    }
}

fn has_an_equilibrium(law: &LawSpec) {
    let mut spec = with_law(solid(&[14.0, 6.0], 3.6, Some(GRADED)), law);
    let end = |name: &str, sign: f64, x: f64| SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [x, 0.0, 0.0],
            normal: [sign, 0.0, 0.0],
        }),
    };
    spec.sets = vec![end("low", 1.0, 1.1), end("high", -1.0, 12.9)];
    for (set, u) in [("low", "0"), ("high", "0.2")] {
        spec.loading.conditions.push(ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Displacement([text(u), text("0"), None]),
        });
    }
    spec.run.schedule.steps = 1;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        tolerance: 1e-11,
        ..Statics::default()
    });
    let mut sim = started(&spec);
    sim.step().unwrap();
    // quadratic convergence takes a handful of steps
    assert!(
        sim.solved().unwrap().iterations <= 8,
        "{law:?}: {:?}",
        sim.solved()
    );
}

/// A point sees a uniform strain as it is, whatever its own horizon and those around it: its own family measures it.
#[test]
fn every_point_knows_the_dilatation_of_a_uniform_strain() {
    let sizes = [&[20.0][..], &[12.0, 8.0], &[12.0, 5.0, 5.0]].into_iter();
    for (size, influence) in sizes.flat_map(|size| influences().map(move |i| (size, i))) {
        let law = &of_families(size.len())[0];
        let mut spec = with_law(solid(size, 3.6, Some(GRADED)), law);
        spec.bonds.influence = influence;
        let mut sim = started(&spec);
        let x = sim.vectors("reference");
        let d = size.len();
        let uniform: Vec<[f64; 3]> = x
            .iter()
            .map(|x| std::array::from_fn(|a| if a < d { 1e-6 * x[a] } else { 0.0 }))
            .collect();
        sim.set_displacements(&uniform);
        sim.start(true);
        for theta in sim.scalars("dilatation") {
            assert!(
                (theta / (1e-6 * d as f64) - 1.0).abs() < 1e-5,
                "{d}: {theta}"
            );
        }
    }
}

/// What every point stores under a uniform strain is that of its own family. Of gradients of bonds it is `½λ tr²ε + G ε:ε` of plane stress to round-off, at
/// surfaces too. Of bonds along and across it is `½ Σ ν |ξ| ½ (c s² + κ γ²)` where the family is whole, with `s = n·εn`, `γ² = |εn|² − s²`, and
/// `c = 2D(Dλ + 2G)/M1`, `κ = 4D(G − λ)/M1`, `M1 = 2πδ³/3` of the disk of each point: the classical energy within 12 %, as the lattice has it.
#[test]
fn every_point_stores_the_energy_of_a_uniform_strain() {
    let strain = [[1e-6, 0.3e-6], [0.3e-6, -0.4e-6]];
    for (law, poisson) in [(of_bond_gradients(), 0.3), (turning(), 0.2)] {
        let turns = matches!(&law, LawSpec::Named(law) if law.name == "bond_rotation");
        let mut spec = with_law(solid(&[18.0, 12.0], 3.6, Some(GRADED)), &law);
        spec.space.plane = Plane::Stress;
        let mut sim = started(&spec);
        let x = sim.vectors("reference");
        let [shear, lame] = [0.5 / (1.0 + poisson), poisson / (1.0 - poisson * poisson)];
        let square: f64 = strain.as_flattened().iter().map(|e| e * e).sum();
        let trace = strain[0][0] + strain[1][1];
        let classical = 0.5 * lame * trace * trace + shear * square;
        let moved = |x: &[f64; 3]| -> [f64; 3] {
            std::array::from_fn(|a| match strain.get(a) {
                Some(row) => row[0] * x[0] + row[1] * x[1],
                None => 0.0,
            })
        };
        let u: Vec<[f64; 3]> = x.iter().map(moved).collect();
        sim.set_displacements(&u);
        sim.start(true);
        let found = sim.scalars("strain_energy_density");
        let mut bulk = 0;
        for (x, found) in x.iter().zip(found) {
            if !turns {
                assert!((found / classical - 1.0).abs() < 1e-5, "{x:?}: {found:e}");
                continue;
            }
            let own = 2.05 + 1.5 * ((x[0] - 3.0) / 6.0).clamp(0.0, 1.0);
            let inside = |a: usize, size: f64| x[a].min(size - x[a]) > own + 0.5;
            if !inside(0, 18.0) || !inside(1, 12.0) {
                continue;
            }
            bulk += 1;
            let first = 2.0 * std::f64::consts::PI * own.powi(3) / 3.0;
            let along = 4.0 * (2.0 * lame + 2.0 * shear) / first;
            let across = 8.0 * (shear - lame) / first;
            let mut exact = 0.0;
            for n in (0..81).filter(|n| *n != 40) {
                let xi = [f64::from(n % 9 - 4), f64::from(n / 9 - 4)];
                let r = xi[0].hypot(xi[1]);
                let part = (0.5 + own - r).clamp(0.0, 1.0);
                let of = strain.map(|row| (row[0] * xi[0] + row[1] * xi[1]) / r);
                let s = (of[0] * xi[0] + of[1] * xi[1]) / r;
                let beside = of[0] * of[0] + of[1] * of[1] - s * s;
                exact += 0.25 * part * r * (along * s * s + across * beside);
            }
            assert!(
                (found / exact - 1.0).abs() < 1e-5,
                "{x:?}: {found:e} {exact:e}"
            );
            assert!((exact / classical - 1.0).abs() < 0.12, "{x:?}");
        }
        assert_eq!(turns, bulk > 40, "{bulk}");
    }
}

/// `W = E(ϑ) + ½ Σ w ν V` of functions that each family normalises: grown by e in all directions ϑ/ϑ₀ − 1 is e, and `Σ ω (r − r₀)² ν V/ϑ₀` is e², so that every
/// point stores `0.1 e² + ½ e²`, whatever its horizon.
#[test]
fn embedded_points_store_what_their_own_families_say() {
    let function = |variables: &'static [&'static str], text: &str| {
        Parameter::Formula(Expression::of(variables, text, &[]).unwrap())
    };
    const OF_BONDS: &[&str] = &["r", "r0", "omega", "delta", "theta0"];
    let law = |weight: &str| {
        let all = Parameters::numbers(&[("bulk", 1.0)])
            .with(
                "energy",
                function(&["theta", "theta0"], "0.1*(theta/theta0 - 1)^2"),
            )
            .with("weight", function(&OF_BONDS[..4], weight))
            .with("pair", function(OF_BONDS, "omega*(r - r0)^2/theta0"));
        LawSpec::named("embedded_solid", all)
    };
    for influence in influences() {
        let mut spec = with_law(solid(&[12.0, 8.0], 3.6, Some(GRADED)), &law("omega*r0*r"));
        spec.bonds.influence = influence;
        let mut sim = started(&spec);
        let grown = 1e-3;
        let x = sim.vectors("reference");
        let u: Vec<[f64; 3]> = x.iter().map(|x| x.map(|c| grown * c)).collect();
        sim.set_displacements(&u);
        sim.start(true);
        let exact = 0.6 * grown * grown;
        for (x, found) in x.iter().zip(sim.scalars("strain_energy_density")) {
            assert!(
                (found / exact - 1.0).abs() < 1e-9,
                "{influence:?} {x:?}: {found:e}"
            );
        }
    }
    let knows = with_law(
        solid(&[12.0, 8.0], 3.6, Some(GRADED)),
        &law("omega*r0*r/delta"),
    );
    let error = build(&knows, Options::default()).err().unwrap();
    assert!(error.message.contains("know one horizon"), "{error}");
}

/// What a uniform strain leaves in the bulk, over the force of the strain at the end of the body, and what of a pulse comes back from
/// where the horizon changes from 2 to 4 spacings.
#[test]
fn a_graded_bar_lets_a_wave_through() {
    let graded = |over: f64| format!("2.05 + 2*clamp((x-200)/{over} + 0.5, 0, 1)");
    for (over, patch, back) in [(1.0, 0.3, 2e-3), (40.0, 0.02, 5e-4)] {
        let own = graded(over);
        let mut spec = solid(&[400.0], 4.1, Some(&own));
        spec.loading.initial.push(InitialSpec {
            set: "all".into(),
            displacement: [text("0.01*exp(-((x-100)/12)^2)"), None, None],
            velocity: [
                text("-0.01*exp(-((x-100)/12)^2)*(-2*(x-100)/144)"),
                None,
                None,
            ],
        });
        let mut sim = started(&spec);
        let x = sim.vectors("reference");
        let strained: Vec<[f64; 3]> = x.iter().map(|x| [1e-3 * x[0], 0.0, 0.0]).collect();
        let f = sim.forces_under(&strained);
        let inside = |x: &[f64; 3]| x[0] > 10.0 && x[0] < 390.0;
        let bulk = x.iter().zip(&f).filter(|(x, _)| inside(x));
        let bulk = bulk.fold(0.0f64, |m, (_, f)| m.max(f[0].abs()));
        let left = bulk / f[0][0].abs();
        let first = sim.ledger().unwrap().initial;
        // long enough to be through, and back to where it came from
        while sim.time() < 190.0 {
            sim.step().unwrap();
        }
        let energy = |sim: &mut dyn Simulation, name: &str| {
            let w = sim.scalars(name);
            let of = x.iter().zip(&w).filter(|(x, _)| x[0] < 180.0);
            of.map(|(_, w)| w).sum::<f64>()
        };
        let reflected = energy(sim.as_mut(), "kinetic_energy_density")
            + energy(sim.as_mut(), "strain_energy_density");
        println!(
            "over {over}: a uniform strain leaves {left:.3e}, {:.3e} of the pulse come back",
            reflected / first
        );
        assert!(left < patch, "{over}: {left}");
        assert!(reflected < back * first, "{over}: {}", reflected / first);
    }
}

#[test]
fn what_knows_one_horizon_is_refused() {
    let spec = solid(&[9.0, 9.0], 3.6, Some(GRADED));
    let said = |change: &dyn Fn(&mut Spec)| {
        let mut spec = spec.clone();
        change(&mut spec);
        build(&spec, Options::default()).err().unwrap().path
    };
    assert_eq!(
        said(&|s| s.bonds.variable_horizon = text("5")),
        "variable_horizon"
    );
    assert_eq!(
        said(&|s| s.bonds.variable_horizon = text("x-1")),
        "variable_horizon"
    );
    assert_eq!(
        said(&|s| s.bonds.variable_horizon = text("2+t")),
        "variable_horizon"
    );
    assert_eq!(
        said(&|s| s.bonds.family = FamilyChoice::Auto),
        "variable_horizon"
    );
    assert_eq!(
        said(&|s| s.bonds.partial_volume_correction = false),
        "partial_volume_correction"
    );
    assert_eq!(
        said(&|s| s.bonds.calibration = Calibration::Discrete),
        "calibration"
    );
    let moduli = Parameters::numbers(&[("young", 1.0), ("poisson", 0.3)]);
    assert_eq!(
        said(&|s| s.materials[0].law = LawSpec::named("pals", moduli.clone())),
        "variable_horizon"
    );
    let softening = Parameters::numbers(&[("young", 1.0), ("onset", 0.2)]);
    assert_eq!(
        said(&|s| {
            s.materials[0].law = LawSpec::named("softening", softening.clone());
            s.materials[0].fracture = Some(FractureSpec::new(Criterion::Energy(0.1)));
        }),
        "variable_horizon"
    );
}

/// Bonds that expand, that soften later, and those of two materials of the same constants are those of pmb, whatever the horizons.
#[test]
fn laws_of_bonds_answer_at_every_horizon_as_pmb_does() {
    for size in [&[20.0][..], &[12.0, 8.0], &[12.0, 5.0, 5.0]] {
        let pmb = solid(size, 3.6, Some(GRADED));
        let mut expanding = pmb.clone();
        expanding.materials[0].law =
            LawSpec::named("thermoelastic", Parameters::numbers(&[("young", 1.0)]));
        let mut softening = pmb.clone();
        softening.materials[0].law = LawSpec::named(
            "softening",
            Parameters::numbers(&[("young", 1.0), ("onset", 0.5)]),
        );
        softening.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(1.0)));
        let mut two = pmb.clone();
        for (n, text) in ["x < 7", "x >= 7"].into_iter().enumerate() {
            let name = ["low", "high"][n].to_string();
            two.sets.push(SetSpec {
                name: name.clone(),
                members: Members::Where(Expression::parse(text, &[]).unwrap()),
            });
            if n > 0 {
                two.materials.push(two.materials[0].clone());
            }
            two.materials[n].set = name;
        }
        let mut expected = started(&pmb);
        let u = bent(expected.as_mut());
        let f = expected.forces_under(&u);
        expected.set_displacements(&u);
        expected.start(true);
        let energy = expected.ledger().unwrap().strain;
        let most = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for (name, spec) in [
            ("thermoelastic", &expanding),
            ("softening", &softening),
            ("two materials", &two),
        ] {
            let mut sim = started(spec);
            for (f, g) in f.iter().zip(&sim.forces_under(&u)) {
                for a in 0..3 {
                    assert!((f[a] - g[a]).abs() < 1e-12 * most, "{name}: {f:?} {g:?}");
                }
            }
            sim.set_displacements(&u);
            sim.start(true);
            let found = sim.ledger().unwrap().strain;
            assert!(
                (found / energy - 1.0).abs() < 1e-12,
                "{name}: {found:e} {energy:e}"
            );
        }
    }
}

/// Two materials, the second three times as stiff.
fn of_two(mut spec: Spec, rule: BondMixing) -> Spec {
    spec.interactions.interface = rule;
    spec.materials.push(spec.materials[0].clone());
    spec.materials[1].law = LawSpec::Pmb(PmbStiffness::Young(3.0));
    for (n, condition) in ["x < 4.5", "x >= 4.5"].into_iter().enumerate() {
        let name = ["low", "high"][n].to_string();
        spec.materials[n].set.clone_from(&name);
        spec.sets.push(SetSpec {
            name,
            members: Members::Where(Expression::parse(condition, &[]).unwrap()),
        });
    }
    spec
}

/// What a bond between micromoduli 1 and 3 has.
const RULES: [(BondMixing, f64); 3] = [
    (BondMixing::Harmonic, 1.5),
    (BondMixing::Arithmetic, 2.0),
    (BondMixing::Minimum, 1.0),
];

#[test]
fn two_materials_of_alike_horizons_are_those_of_the_body() {
    for (rule, _) in RULES {
        for (size, horizon, own) in [(&[20.0][..], 2.45, "2.45"), (&[9.0, 8.0], 2.3, "2.3")] {
            let mut one = started(&of_two(solid(size, horizon, None), rule));
            let mut other = started(&of_two(solid(size, horizon, Some(own)), rule));
            let u = bent(one.as_mut());
            let [f, g] = [&mut one, &mut other].map(|sim| sim.forces_under(&u));
            let most = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
            for (f, g) in f.iter().flatten().zip(g.iter().flatten()) {
                assert!((f - g).abs() < 1e-12 * most, "{rule:?} {size:?}: {f} {g}");
            }
            let energies = [one, other].map(|mut sim| {
                sim.set_displacements(&u);
                sim.start(true);
                sim.ledger().unwrap().strain
            });
            assert!(
                (energies[0] / energies[1] - 1.0).abs() < 1e-12,
                "{rule:?} {size:?}: {energies:?}"
            );
        }
    }
}

/// Where one half moves as a whole nothing but bonds across are stretched: they have so many times what they have of the softer material alone.
#[test]
fn bonds_across_follow_their_rule_at_every_horizon() {
    for size in [&[12.0][..], &[10.0, 6.0], &[9.0, 4.0, 4.0]] {
        let alone = solid(size, 3.6, Some(GRADED));
        let across = |spec: &Spec| {
            let mut sim = started(spec);
            let moved = |x: &[f64; 3]| match x[0] < 4.5 {
                true => [0.0; 3],
                false => std::array::from_fn(|a| if a < size.len() { 0.02 } else { 0.0 }),
            };
            let u: Vec<[f64; 3]> = sim.vectors("reference").iter().map(moved).collect();
            let f = sim.forces_under(&u);
            sim.set_displacements(&u);
            sim.start(true);
            (f, sim.ledger().unwrap().strain)
        };
        let (f, energy) = across(&alone);
        let most = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for (rule, times) in RULES {
            let (g, found) = across(&of_two(alone.clone(), rule));
            for (f, g) in f.iter().flatten().zip(g.iter().flatten()) {
                assert!(
                    (times * f - g).abs() < 1e-12 * most,
                    "{rule:?} {size:?}: {f} {g}"
                );
            }
            assert!(
                (found / energy / times - 1.0).abs() < 1e-12,
                "{rule:?} {size:?}: {found:e} {energy:e}"
            );
        }
    }
}

/// Laws that compute from a horizon or a family what each of their points uses, and what shows it.
fn of_points() -> Vec<(LawSpec, &'static str)> {
    let all = |name: &str, numbers: &[(&str, f64)], words: &[(&str, &str)]| {
        let mut all = Parameters::numbers(numbers);
        for (key, word) in words {
            all.set(key, Parameter::Word((*word).into()));
        }
        LawSpec::named(name, all)
    };
    let state = [
        ("hugoniot_slope", 1.5),
        ("gruneisen", 1.9),
        ("linear_viscosity", 0.3),
        ("quadratic_viscosity", 1.5),
    ];
    let mut fluid = state.to_vec();
    fluid.push(("bulk", 2.0));
    let mut metal = state.to_vec();
    metal.extend([("bulk", 2.0), ("shear", 0.7), ("yield_stress", 0.01)]);
    let plastic = [("young", 1.0), ("poisson", 0.3), ("yield_stress", 0.003)];
    vec![
        (all("fluid", &fluid, &[]), "shock_pressure"),
        (
            all(
                "hypoelastic_plastic",
                &metal,
                &[("equation_of_state", "mie_gruneisen")],
            ),
            "shock_pressure",
        ),
        (all("elastic_plastic", &plastic, &[]), "plastic_strain"),
    ]
}

/// A plate in plane strain all of whose points are told a uniform strain that grows with time.
fn told(law: &LawSpec, longest: f64, own: Option<&str>) -> Spec {
    let mut spec = with_law(solid(&[18.0, 8.0], longest, own), law);
    spec.space.plane = Plane::Strain;
    if own.is_none() {
        // a yield surface of each family, as points with horizons of their own have it
        spec.bonds.calibration = Calibration::Discrete;
    }
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::Displacement([text("0.01*t*x + 0.004*t*y"), text("-0.03*t*y"), None]),
    }];
    spec.run.schedule.time_step = TimeStep::Fixed(0.1);
    spec.run.schedule.force_unstable = true;
    spec
}

/// A column after some steps.
fn after(spec: &Spec, steps: usize, column: &str) -> Vec<f64> {
    let mut sim = started(spec);
    for _ in 0..steps {
        sim.step().unwrap();
    }
    sim.scalars(column)
}

/// Points of one horizon answer alike, whether it is that of the body or each has it for itself, and however long others of the body might be;
/// no pair is further apart than the horizon by less than half a spacing. A step of J of 2e-3 has 13 digits.
#[test]
fn one_horizon_point_by_point_is_that_of_the_body() {
    for (law, column) in of_points() {
        for horizon in [1.45, 2.3] {
            let own = horizon.to_string();
            let body = after(&told(&law, horizon, None), 8, column);
            let most = body.iter().fold(0.0f64, |m, x| m.max(*x));
            assert!(most > 1e-4, "{law:?}: {most:e}");
            for longest in [horizon, 4.6] {
                let each = after(&told(&law, longest, Some(&own)), 8, column);
                for (a, b) in body.iter().zip(&each) {
                    assert!(
                        (a - b).abs() < 1e-11 * most,
                        "{law:?} {longest}: {a:e} {b:e}"
                    );
                }
            }
        }
    }
}

/// Where horizons are graded, each point yields, and spreads shocks, as in a body of its own one.
#[test]
fn graded_points_answer_as_in_a_body_of_their_variable_horizon() {
    let graded = "1.45 + 0.85*clamp((x-7)/4, 0, 1)";
    for (law, column) in of_points() {
        let spec = told(&law, 2.3, Some(graded));
        let x = started(&spec).vectors("reference");
        let found = after(&spec, 8, column);
        for (horizon, low, high) in [(1.45, -1.0, 7.0), (2.3, 11.0, 20.0)] {
            let one = after(&told(&law, horizon, None), 8, column);
            let most = one.iter().fold(0.0f64, |m, x| m.max(*x));
            let mut count = 0;
            for ((x, a), b) in x.iter().zip(&one).zip(&found) {
                if (low..=high).contains(&x[0]) {
                    count += 1;
                    assert!(
                        (a - b).abs() < 1e-11 * most,
                        "{law:?} at {x:?}: {a:e} {b:e}"
                    );
                }
            }
            assert!(count > 40, "{count}");
        }
    }
}

/// `q = ρ δ D (C_q δ D + C_l c)` with the horizon of each point, of the first step from rest: `D = −ΔJ/(Δt J)`, `ρ = ρ₀/J` in its middle, `ρ₀ c = √(ρ₀ K)`.
#[test]
fn viscosity_of_shocks_has_the_horizon_of_each_point() {
    let [linear, quadratic, density, bulk]: [f64; 4] = [0.3, 1.5, 1.0, 2.0];
    for (law, column) in of_points().into_iter().take(2) {
        let spec = told(&law, 3.6, Some(GRADED));
        let x = started(&spec).vectors("reference");
        let found = after(&spec, 1, column);
        let dt = 0.1;
        let volume = (1.0 + 0.01 * dt) * (1.0 - 0.03 * dt);
        let middle = 0.5 * (1.0 + volume);
        let rate = (1.0 - volume) / (dt * middle);
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        for (x, q) in x.iter().zip(&found) {
            let own = 2.05 + 1.5 * ((x[0] - 3.0) / 6.0).clamp(0.0, 1.0);
            let wide = own * rate;
            let exact =
                wide * (linear * (density * bulk).sqrt() + quadratic * density * wide / middle);
            // ΔJ of 2e-3 has so many digits
            assert!(
                (q / exact - 1.0).abs() < 1e-11,
                "{law:?} at {x:?}: {q:e} {exact:e}"
            );
            least = least.min(*q);
            most = most.max(*q);
        }
        assert!(most > 1.7 * least);
    }
}

/// Bonds of points with the longest horizon reach as far as they do below a longer one.
#[test]
fn the_longest_horizon_loses_no_bonds() {
    let pmb = [LawSpec::Pmb(PmbStiffness::Young(1.0))];
    for law in pmb.into_iter().chain(of_families(2)) {
        // √13 = 3.6 spacings is within 3.2 and a half
        let of = |longest: f64| started(&with_law(solid(&[14.0, 9.0], longest, Some("3.2")), &law));
        let (mut longest, mut shorter) = (of(3.2), of(5.0));
        assert_eq!(
            longest.info().directed_bonds,
            shorter.info().directed_bonds,
            "{law:?}"
        );
        let u = bent(longest.as_mut());
        let (f, g) = (longest.forces_under(&u), shorter.forces_under(&u));
        let most = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for (f, g) in f.iter().zip(&g) {
            for a in 0..2 {
                assert!((f[a] - g[a]).abs() < 1e-12 * most, "{law:?}: {f:?} {g:?}");
            }
        }
    }
}

/// Points push each other by the stiffness of their own bonds, `15 c/δ` with `c ∝ δ^−(D+1)`, in and out of families, and the step knows it.
#[test]
fn contact_is_as_stiff_as_the_bonds_of_each_point() {
    let pmb = [LawSpec::Pmb(PmbStiffness::Young(1.0))];
    for law in pmb.into_iter().chain(of_families(2)) {
        let squeezed = |longest: f64, own: Option<&str>| {
            let mut spec = with_law(solid(&[14.0, 5.0], longest, own), &law);
            spec.interactions.contact = Some(ContactSpec {
                bonded: 0.9,
                free: 1.35,
                stiffness: ContactStiffness::Laws,
                friction: None,
                cohesion: None,
                conductance: None,
            });
            spec.loading.initial = vec![InitialSpec {
                set: "all".into(),
                displacement: [text("-0.6*x"), None, None],
                velocity: [None, None, None],
            }];
            spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
            let mut sim = started(&spec);
            let contact_step = sim.info().contact_step;
            sim.step().unwrap();
            (sim.velocities(), contact_step)
        };
        let (body, step) = squeezed(2.3, None);
        let most = body.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for longest in [2.3, 4.6] {
            let (each, own_step) = squeezed(longest, Some("2.3"));
            for (v, w) in body.iter().zip(&each) {
                for a in 0..2 {
                    assert!(
                        (v[a] - w[a]).abs() < 1e-11 * most,
                        "{law:?} {longest}: {v:?} {w:?}"
                    );
                }
            }
            // by Lanczos' method
            assert!(
                (own_step / step - 1.0).abs() < 1e-3,
                "{law:?}: {own_step} {step}"
            );
        }
    }
}

/// A fracture energy is that of the horizon of each point: bonds bear `√(δ/δ_i)` of what they do at the longest one.
#[test]
fn a_fracture_energy_is_one_of_every_horizon() {
    let pmb = LawSpec::Pmb(PmbStiffness::Young(1.0));
    let lps = LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.3,
    });
    let energy = |energy: f64| Some(FractureSpec::new(Criterion::Energy(energy)));
    let falls = Influence::Formula(Formula::parse("exp(-r/2)", &[]).unwrap());
    for (size, law, influence) in [
        (&[24.0][..], &pmb, Influence::Constant),
        (&[24.0, 6.0], &pmb, Influence::Constant),
        (&[24.0, 6.0], &lps, Influence::Constant),
        (&[24.0], &pmb, Influence::Linear),
        (&[24.0], &pmb, falls),
    ] {
        let of = |horizon: f64, own: Option<&str>, g: f64| {
            let mut spec = solid(size, horizon, own);
            spec.materials[0].law = law.clone();
            spec.materials[0].fracture = energy(g);
            spec.bonds.influence = influence;
            spec
        };
        let critical = |horizon: f64, g: f64| {
            let sim = build(&of(horizon, None, g), Options::default()).unwrap();
            sim.info().critical_stretch[0]
        };
        // the longest horizon bears 2 %
        let g = (0.02 / critical(4.6, 1.0)).powi(2);
        let [first, second] = [4.6, 2.3].map(|horizon| critical(horizon, g));
        assert!((first - 0.02).abs() < 1e-9, "{first}");
        // a function with a length of its own has another law
        let root = (second / first - 2f64.sqrt()).abs() < 1e-6;
        assert_eq!(root, influence != falls, "{second}");
        let mut spec = of(4.6, Some("x < 12 ? 2.3 : 4.6"), g);
        let rate = 1e-3;
        let across = text("0").filter(|_| size.len() > 1);
        spec.loading.conditions = vec![ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::Displacement([text("1e-3*t*x"), across, None]),
        }];
        spec.run.schedule.time_step = TimeStep::Fixed(0.1);
        spec.run.schedule.force_unstable = true;
        let mut sim = started(&spec);
        let x = sim.vectors("reference");
        let [short, long] = [0.1, 23.9].map(|at| {
            let near = |x: &[f64; 3]| (x[0] - at).abs() < 0.2;
            x.iter().position(near).unwrap()
        });
        let mut when = [None; 2];
        while sim.time() * rate < 1.2 * second {
            sim.step().unwrap();
            let damage = sim.scalars("damage");
            for (when, n) in when.iter_mut().zip([long, short]) {
                if damage[n] > 0.0 {
                    when.get_or_insert(sim.time());
                }
            }
        }
        for (when, exact) in when.into_iter().zip([first, second]) {
            let late = when.unwrap() * rate - exact;
            assert!((-1e-9..1.5e-4).contains(&late), "{law:?}: {late:e}");
        }
    }
}

/// Whatever bonds break by that knows no horizon, they break as in a body of the one horizon that all points have.
#[test]
fn stress_flow_and_rates_break_alike_at_every_horizon() {
    let lps = LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.3,
    });
    let numbers = [("young", 1.0), ("poisson", 0.3), ("yield_stress", 0.003)];
    let plastic = LawSpec::named("elastic_plastic", Parameters::numbers(&numbers));
    let fast = FractureSpec {
        rate: Some(RateSpec {
            coefficient: 0.05,
            reference: 1e-4,
        }),
        ..FractureSpec::new(Criterion::Stretch(0.01))
    };
    let pmb = LawSpec::Pmb(PmbStiffness::Young(1.0));
    for (law, fracture) in [
        (&pmb, FractureSpec::new(Criterion::VonMises(0.012))),
        (&pmb, fast),
        (&lps, FractureSpec::new(Criterion::VonMises(0.012))),
        (&plastic, FractureSpec::new(Criterion::PlasticStrain(0.005))),
        (&lps, fast),
    ] {
        let broken = |longest: f64, own: Option<&str>| {
            let mut spec = told(law, longest, own);
            spec.bonds.calibration = Calibration::Continuum;
            spec.materials[0].fracture = Some(fracture);
            let mut sim = started(&spec);
            let each = (0..15).map(|_| {
                sim.step().unwrap();
                sim.broken()
            });
            each.collect::<Vec<_>>()
        };
        let one = broken(2.3, Some("2.3"));
        assert!(
            one[0] == 0 && one[14] > 100,
            "{law:?} {fracture:?}: {one:?}"
        );
        assert_eq!(one, broken(4.6, Some("2.3")), "{law:?} {fracture:?}");
    }
}

/// A notched plate under cycles of load: cycles after each increment, bonds that are broken then, and what is left of all lives, in order of size.
fn worn(longest: f64, own: Option<&str>) -> (Vec<f64>, Vec<u64>, Vec<f64>) {
    let law = LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.3,
    });
    let mut spec = with_law(solid(&[18.0, 10.0], longest, own), &law);
    spec.materials[0].fracture = Some(FractureSpec {
        fatigue: Some(FatigueSpec {
            nucleation: Some([1e5, 3.0]),
            limit: 1e-3,
            growth: Some([1e6, 3.0]),
            crack: 0.35,
        }),
        ..FractureSpec::new(Criterion::Stretch(1.0))
    });
    spec.damage.precracks = vec![PrecrackSpec {
        shape: CrackShape::Segment {
            from: [-1.0, 5.5, 0.0],
            to: [6.5, 5.5, 0.0],
        },
        kind: CrackKind::Broken,
    }];
    for (name, y, way, u) in [("low", 1.1, 1.0, "0"), ("high", 8.9, -1.0, "0.02")] {
        spec.sets.push(SetSpec {
            name: name.into(),
            members: Members::Region(Region::HalfSpace {
                point: [0.0, y, 0.0],
                normal: [0.0, way, 0.0],
            }),
        });
        spec.loading.conditions.push(ConditionSpec {
            set: name.into(),
            kind: ConditionKind::Displacement([text("0"), text(u), None]),
        });
    }
    spec.run.schedule.steps = 7;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        tolerance: 1e-11,
        cycles: Some(Cycles {
            load_ratio: 0.1,
            bonds: 4,
            most: f64::INFINITY,
        }),
        ..Statics::default()
    });
    let mut sim = started(&spec);
    let (mut cycles, mut broken) = (vec![], vec![]);
    for _ in 0..7 {
        sim.step().unwrap();
        cycles.push(sim.cycles().unwrap());
        broken.push(sim.broken());
    }
    let mut lives = sim.scalars("remaining_life");
    lives.sort_by(f64::total_cmp);
    (cycles, broken, lives)
}

/// Cycles wear bonds by their stretch alone, which knows no horizon: a crack grows as in a body of the one horizon that all points have.
#[test]
fn bonds_live_as_long_at_every_horizon() {
    let (cycles, broken, lives) = worn(2.3, None);
    assert!(cycles.is_sorted() && cycles[1] > 0.0, "{cycles:?}");
    assert!(broken[6] >= broken[0] + 40, "{broken:?}");
    assert!(lives.iter().any(|l| *l > 0.1 && *l < 0.9));
    for longest in [2.3, 4.6] {
        let own = worn(longest, Some("2.3"));
        assert_eq!(broken, own.1, "{longest}");
        for (one, own) in [(&cycles, &own.0), (&lives, &own.2)] {
            assert_eq!(one.len(), own.len(), "{longest}");
            for (a, b) in one.iter().zip(own) {
                assert!(
                    (a - b).abs() <= 1e-7 * a.abs().max(1e-2),
                    "{longest}: {a} {b}"
                );
            }
        }
    }
}

/// Bonds of laws that remember weigh as those of pmb do, by the influence function at the horizon of each end.
#[test]
fn laws_of_bonds_weigh_as_pmb_does() {
    for influence in influences() {
        let mut pmb = solid(&[12.0, 8.0], 3.6, Some(GRADED));
        pmb.bonds.influence = influence;
        let mut general = pmb.clone();
        general.materials[0].law =
            LawSpec::named("thermoelastic", Parameters::numbers(&[("young", 1.0)]));
        let (mut one, mut other) = (started(&pmb), started(&general));
        let u = bent(one.as_mut());
        let (f, g) = (one.forces_under(&u), other.forces_under(&u));
        let most = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for (f, g) in f.iter().flatten().zip(g.iter().flatten()) {
            assert!((f - g).abs() < 1e-12 * most, "{influence:?}: {f:e} {g:e}");
        }
    }
}
