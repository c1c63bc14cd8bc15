//! Continuum fields of running models: peridynamic bodies are systems of particles.

use peridyne::run::{Options, Simulation, build};
use peridyne_fields::residuals::Residuals;
use peridyne_fields::{Fields, Quantity, Shape};
use peridyne_io::continuum::live::Live;
use peridyne_io::continuum::plan::{FieldsSpec, Place};
use peridyne_io::deck::Deck;
use std::path::Path;

struct Case {
    sim: Box<dyn Simulation>,
    live: Live,
    asked: FieldsSpec,
}

impl Case {
    /// A deck's model at rest, with the fields that it asks for; files are those beside the good decks.
    fn new(text: &str) -> Case {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/test.toml");
        let deck = Deck::parse(text, file.to_str().unwrap(), &[]).unwrap();
        let mut sim = build(&deck.spec, Options::default()).unwrap();
        let live = Live::new(sim.as_mut(), &deck.spec, deck.corner).unwrap();
        let asked = deck.fields[0].clone();
        Case { sim, live, asked }
    }

    fn fields(&mut self, points: &[[f64; 3]]) -> Fields {
        self.asked.place = Place::Points(points.to_vec());
        let cell = self.live.cell(&self.asked.place).unwrap();
        let (targets, mut method) = self.live.method(&self.asked, &cell).unwrap();
        method.rates = true;
        let frame = self.live.frame(self.sim.as_mut(), &cell);
        self.live
            .fields(self.sim.as_mut(), &frame, &targets, &method)
            .unwrap()
    }

    fn residuals(&mut self, points: &[[f64; 3]], step: f64) -> Residuals {
        let cell = self.live.cell(&self.asked.place).unwrap();
        let (_, method) = self.live.method(&self.asked, &cell).unwrap();
        let frame = self.live.frame(self.sim.as_mut(), &cell);
        self.live
            .residuals(self.sim.as_mut(), &frame, &method, points, step)
            .unwrap()
    }

    /// Moves every point by what a function of its reference says.
    fn displace(&mut self, u: impl FnMut([f64; 3]) -> [f64; 3]) {
        let moved: Vec<_> = self.sim.vectors("reference").into_iter().map(u).collect();
        self.sim.set_displacements(&moved);
    }

    /// Random displacements and velocities of these sizes.
    fn stir(&mut self, displacement: f64, velocity: f64, axes: usize) {
        let mut random = Random(7);
        let mut vector =
            |size: f64| std::array::from_fn(|a| if a < axes { size * random.next() } else { 0.0 });
        let n = self.sim.info().points as usize;
        let u: Vec<[f64; 3]> = (0..n).map(|_| vector(displacement)).collect();
        let v: Vec<[f64; 3]> = (0..n).map(|_| vector(velocity)).collect();
        self.sim.set_displacements(&u);
        self.sim.set_velocities(&v);
        self.sim.start(true);
    }
}

struct Random(u64);

impl Random {
    /// From −1 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A body of unit spacing in plain numbers, with fields at its origin.
fn body(lattice: &str, cells: &str, ratio: u32, law: &str, more: &str) -> String {
    let d = cells.split(',').count();
    let at = vec!["0"; d].join(", ");
    format!(
        "units = \"none\"\nhorizon = {{ m_ratio = {ratio} }}\n{more}\n\
         [body]\nlattice = \"{lattice}\"\nspacing = 1\ncells = [{cells}]\n\
         [material]\ndensity = 2\nlaw = {law}\n\
         [run]\nsteps = 1\ntime_step = 1e-3\n\
         [[fields]]\nkernel = \"polynomial\"\nsmoothness = 5\nwidth = 3\npoints = [[{at}]]\n"
    )
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// On a line every section between two points is crossed by k bonds of k spacings, whatever φ and its width: `σ = E s`, to the last digits.
#[test]
fn a_stretched_bar_has_its_classical_stress() {
    let (young, area, stretch) = (10.0, 0.25, 0.01);
    let law = format!("{{ pmb = {{ young = {young} }} }}");
    let mut case = Case::new(&body("chain", "90", 3, &law, &format!("area = {area}")));
    case.displace(|x| [stretch * x[0], 0.0, 0.0]);
    for shape in [
        Shape::Polynomial(3),
        Shape::CubicSpline,
        Shape::Gaussian,
        Shape::Cell,
    ] {
        for width in [1.3, 2.0, 3.7] {
            (case.asked.shape, case.asked.width) = (shape, width);
            let found = case.fields(&[[44.0, 0.0, 0.0], [45.37, 3.0, -1.0]]);
            for stress in found.get(Quantity::Stress).unwrap().chunks_exact(9) {
                let off = (stress[0] / (young * stretch) - 1.0).abs();
                assert!(off < 1e-12, "{shape:?} {width}: {stress:?}");
                assert!(largest(&stress[1..]) < 1e-15, "{stress:?}");
            }
            let churning = found.get(Quantity::Churning).unwrap();
            assert_eq!(largest(churning), 0.0);
        }
    }
    // of a spline whose pieces are as long as the spacing the density is even
    case.asked.shape = Shape::CubicSpline;
    case.asked.width = 2.0 * (1.0 + stretch);
    let found = case.fields(&[[45.37, 0.0, 0.0]]);
    let rho = found.get(Quantity::Density).unwrap()[0];
    assert!((rho * (1.0 + stretch) / 2.0 - 1.0).abs() < 1e-13, "{rho}");
    assert!(found.get(Quantity::Temperature).is_none());
    let why = found.why_not(Quantity::Temperature);
    assert!(why.contains("no atoms"), "{why}");
}

/// In space the sum over parallel bonds is a quadrature across them: it converges with the width of φ to the lattice sum, which is the
/// stress that the engine observes, over det F; for an even expansion that is 3 K ε.
#[test]
fn a_strained_cube_has_the_stress_of_the_engine() {
    let law = "{ lps = { bulk = 9, shear = 5 } }";
    let mut case = Case::new(&body("cubic", "21, 21, 21", 2, law, ""));
    let h = [
        [0.012, 0.004, 0.0],
        [-0.003, -0.006, 0.002],
        [0.001, 0.005, 0.009],
    ];
    let middle = [10.0; 3];
    let stretched = move |x: [f64; 3]| {
        h.map(|row: [f64; 3]| (0..3).map(|a| row[a] * (x[a] - middle[a])).sum::<f64>())
    };
    case.displace(stretched);
    let f = |a: usize, b: usize| h[a][b] + if a == b { 1.0 } else { 0.0 };
    let det = f(0, 0) * (f(1, 1) * f(2, 2) - f(1, 2) * f(2, 1))
        - f(0, 1) * (f(1, 0) * f(2, 2) - f(1, 2) * f(2, 0))
        + f(0, 2) * (f(1, 0) * f(2, 1) - f(1, 1) * f(2, 0));
    // the middle point of 21³
    let n = 10 + 21 * (10 + 21 * 10);
    assert!(case.sim.vectors("reference")[n] == middle);
    let Some(peridyne::observe::Values::Symmetric(all)) =
        case.sim.column("stress").map(|c| c.values)
    else {
        panic!("stress of the engine");
    };
    let s = all[n].map(|x| x / det);
    // xx, yy, zz, then the pairs as the engine orders them
    let mut errors = vec![];
    for width in [2.0, 3.0, 4.0, 5.0] {
        case.asked.width = width;
        let found = case.fields(&[[10.13, 9.9, 10.2]]);
        let own = found.get(Quantity::Stress).unwrap();
        let exact = [s[0], s[1], s[2]];
        let off = (0..3).map(|a| (own[4 * a] - exact[a]).abs());
        let off = off.fold(0.0, f64::max) / largest(&exact);
        // along the bonds: symmetric
        assert!((own[1] - own[3]).abs() < 1e-14 * largest(own));
        errors.push(off);
    }
    println!("against the lattice sum, widths 2 to 5: {errors:?}");
    assert!(errors.windows(2).all(|e| e[1] < 0.5 * e[0]), "{errors:?}");
    assert!(errors[3] < 1e-3, "{errors:?}");
    let expansion = 1e-6;
    case.displace(|x| std::array::from_fn(|a| expansion * (x[a] - middle[a])));
    let found = case.fields(&[middle]);
    let own = found.get(Quantity::Stress).unwrap();
    for a in 0..3 {
        let off = own[4 * a] / (27.0 * expansion) - 1.0;
        assert!(off.abs() < 1e-3, "{own:?}");
    }
}

/// Pure bending: `σ_xx = −E κ y`, for φ sees both sides of a line alike.
#[test]
fn a_bent_plate_has_the_stress_of_its_fibres() {
    let (young, curvature) = (8.0, 1e-6);
    let law = format!("{{ pmb = {{ young = {young} }} }}");
    let mut case = Case::new(&body("square", "41, 31", 3, &law, "thickness = 0.5"));
    let poisson = 1.0 / 3.0;
    case.displace(|x| {
        let [x, y] = [x[0] - 20.0, x[1] - 15.0];
        let across = 0.5 * curvature * (x * x + poisson * y * y);
        [-curvature * x * y, across, 0.0]
    });
    case.asked.width = 5.0;
    let points: Vec<_> = [-4.0, -2.0, 0.0, 2.0, 4.0]
        .map(|y| [20.0, 15.0 + y, 0.0])
        .to_vec();
    let found = case.fields(&points);
    let all = found.get(Quantity::Stress).unwrap();
    for (p, stress) in points.iter().zip(all.chunks_exact(9)) {
        let exact = -young * curvature * (p[1] - 15.0);
        println!("{} {:e} {:e}", p[1] - 15.0, stress[0], exact);
        let off = (stress[0] - exact).abs() / (4.0 * young * curvature);
        assert!(off < 2e-2, "{p:?}: {} of {exact}", stress[0]);
        assert!(stress[4].abs() < 2e-2 * 4.0 * young * curvature);
    }
}

/// Laws in the plane, and whether they have a potential.
const LAWS: [(&str, bool); 8] = [
    ("{ pmb = { young = 8 } }", true),
    ("{ lps = { young = 8, poisson = 0.2 } }", true),
    ("{ springs = { young = 8 } }", true),
    ("{ correspondence = { young = 8, poisson = 0.3 } }", true),
    (
        "{ elastic_plastic = { young = 8, poisson = 0.3, yield_stress = 0.02 } }",
        true,
    ),
    (
        "{ viscoelastic = { young = 8, poisson = 0.3, branches = [[0.5, 1]] } }",
        true,
    ),
    (
        "{ softening = { young = 8, onset = 0.01 } }\nfracture = { critical_stretch = 0.5 }",
        true,
    ),
    ("{ hypoelastic = { young = 8, poisson = 0.3 } }", false),
];

fn plane(law: &str) -> Case {
    let mut case = Case::new(&body("square", "9, 8", 2, law, "plane = \"strain\""));
    case.stir(0.02, 0.1, 2);
    case
}

/// `∂(W_i V_i)/∂x_j` by differences is what the bond from i to j says of its own end.
#[test]
fn own_forces_are_slopes_of_the_energy_of_points() {
    for (law, potential) in LAWS {
        let mut case = plane(law);
        let volume = case.sim.scalars("volume");
        let n = volume.len();
        let mut own = vec![[0.0; 2]; n * n];
        let mut known = 0;
        case.sim.each_force(&mut |bond| {
            let Some(of) = bond.own else { return };
            known += 1;
            for a in 0..2 {
                own[bond.id * n + bond.partner][a] += volume[bond.id] * of[a];
            }
        });
        assert_eq!(known > 0, potential, "{law}");
        if !potential {
            continue;
        }
        let rest: Vec<_> = case.sim.displacements();
        // short: a law that flows has slopes with kinks
        let h = 1e-5;
        for j in [0, 21, 40] {
            for a in 0..2 {
                let mut at = |step: f64| {
                    let mut u = rest.clone();
                    u[j][a] += step;
                    case.sim.set_displacements(&u);
                    case.sim.observed()
                };
                let seen = [at(h), at(-h), at(2.0 * h), at(-2.0 * h)];
                for i in (0..n).filter(|i| *i != j) {
                    let e = |k: usize| (seen[k].strain[i] + seen[k].repulsion[i]) * volume[i];
                    let slope = (8.0 * (e(0) - e(1)) - (e(2) - e(3))) / (12.0 * h);
                    let said = own[i * n + j][a];
                    assert!((slope - said).abs() < 2e-6, "{law} {i} {j}: {slope} {said}");
                }
            }
        }
    }
}

/// Mass, momentum and energy balance at points, for every law: what is left falls as the square of the step, and what the step does not
/// explain is round-off.
#[test]
fn balance_laws_hold_for_every_law() {
    let points = [[4.1, 3.3, 0.0], [3.2, 4.4, 0.0], [6.0, 2.5, 0.0]];
    for (law, potential) in LAWS {
        let mut case = plane(law);
        let wide = case.residuals(&points, 0.15);
        let narrow = case.residuals(&points, 0.075);
        assert_eq!(narrow.points, 3);
        let mut laws = vec![(wide.mass, narrow.mass), (wide.momentum, narrow.momentum)];
        match potential {
            true => laws.push((wide.energy, narrow.energy)),
            false => assert!(narrow.energy.relative().is_nan(), "{law}"),
        }
        for (wide, narrow) in laws {
            let ratio = wide.value / narrow.value;
            assert!((3.8..4.2).contains(&ratio), "{law}: {ratio}");
            let left = narrow.extrapolated / narrow.scale;
            assert!(left < 1e-3, "{law}: {left:e}");
        }
        let found = case.fields(&points);
        let heat = found.get(Quantity::HeatPotential);
        assert_eq!(heat.is_some(), potential, "{law}");
        if !potential {
            let why = found.why_not(Quantity::HeatPotential);
            assert!(why.contains("potential"), "{why}");
            assert!(found.get(Quantity::HeatKinetic).is_some());
        }
    }
}

/// `∂π/∂t` from three steps of a run against the fluxes of the middle one: second order in the step.
#[test]
fn momentum_of_a_run_changes_as_its_stress_says() {
    let points = [[4.1, 3.3, 0.0], [3.2, 4.4, 0.0]];
    let mut errors = vec![];
    for (steps, dt) in [(10, 0.02), (20, 0.01), (40, 0.005)] {
        let text = body("square", "9, 8", 2, LAWS[1].0, "plane = \"strain\"");
        let mut case = Case::new(&text.replace("time_step = 1e-3", &format!("time_step = {dt}")));
        case.stir(0.02, 0.05, 2);
        for _ in 0..steps - 1 {
            case.sim.step().unwrap();
        }
        let momentum = |case: &mut Case| {
            let found = case.fields(&points);
            let all = found.get(Quantity::Momentum).unwrap().to_vec();
            (all, found.rates)
        };
        let (before, _) = momentum(&mut case);
        case.sim.step().unwrap();
        let (_, rates) = momentum(&mut case);
        case.sim.step().unwrap();
        let (after, _) = momentum(&mut case);
        let mut off = 0.0f64;
        let mut size = 0.0f64;
        for (p, rate) in rates.iter().enumerate() {
            for a in 0..2 {
                let slope = (after[3 * p + a] - before[3 * p + a]) / (2.0 * dt);
                off = off.max((slope - rate.momentum[a]).abs());
                size = size.max(rate.momentum[a].abs());
            }
        }
        errors.push(off / size);
    }
    println!("momentum over three steps: {errors:?}");
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((3.5..4.5).contains(&ratio), "{errors:?}");
    }
}

/// Chapter 4's circle: embedded atoms that keep their neighbours are a peridynamic body with force states from the potential; read so, and as
/// atoms with their current neighbours, they have the same fields.
#[test]
fn embedded_atoms_are_a_peridynamic_body() {
    let copper = |family: &str| {
        let text = format!(
            "units = \"metal\"\nperiodic = [\"x\", \"y\", \"z\"]\n{family}\n\
             body = {{ lattice = \"fcc\", spacing = 3.6147, cells = [4, 4, 4] }}\n\
             material.law = {{ eam = {{ file = \"copper.eam.alloy\" }} }}\n\
             run = {{ steps = 1, time_step = 1e-3 }}\n\
             [[fields]]\nkernel = \"bspline\"\nwidth = 4\npoints = [[0, 0, 0]]\n"
        );
        let mut case = Case::new(&text);
        case.stir(0.02, 3.0, 3);
        case
    };
    let mut random = Random(3);
    let points: Vec<[f64; 3]> = (0..20)
        .map(|_| std::array::from_fn(|_| 7.0 * (1.0 + random.next())))
        .collect();
    let mut fixed = copper("family = \"stencil\"\nhorizon = 4.9");
    let mut current = copper("");
    assert!(fixed.asked.choice.is_none() && current.asked.choice.is_some());
    let (body, atoms) = (fixed.fields(&points), current.fields(&points));
    let places = |q: &Quantity| Quantity::PLACES.contains(q);
    for quantity in Quantity::ALL.into_iter().filter(|q| !places(q)) {
        let (a, b) = (body.get(quantity).unwrap(), atoms.get(quantity).unwrap());
        let size = match quantity {
            // 0 but for round-off: beside stress
            Quantity::Churning | Quantity::HeatChurning | Quantity::ChurningSource => {
                largest(atoms.get(Quantity::Stress).unwrap())
            }
            _ => largest(b),
        };
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max);
        assert!(
            size > 0.0 && off < 1e-11 * size,
            "{}: {off:e} of {size:e}",
            quantity.name()
        );
    }
}

/// What passes through a section 5 mm above a crack of 16 mm, over the load; `lim σ_yy √(2πr)` as a line in r, over K of J.
fn crack(spacing: f64) -> [f64; 2] {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/crack_fields.toml");
    let deck = std::fs::read_to_string(file).unwrap();
    let own = format!("d = \"{spacing} mm\"");
    let mut case = Case::new(&deck.replace("d = \"0.5 mm\"", &own));
    case.sim.start(true);
    case.sim.step().unwrap();
    let measured = case.sim.measure();
    let (young, poisson) = (70e9, 0.22);
    let k = (measured[0] * young / (1.0 - poisson * poisson)).sqrt();
    let step = 0.05e-3;
    let line: Vec<_> = (0..880)
        .map(|n| [-2e-3 + step * (f64::from(n) + 0.5), 5e-3, 0.0])
        .collect();
    let found = case.fields(&line);
    let all = found.get(Quantity::StressPotential).unwrap();
    let force = step * all.chunks_exact(9).map(|s| s[4]).sum::<f64>();
    let load = 1e6 / 2e-3 * 4.0 * 1e-3 * spacing * 40e-3;
    let radius: Vec<f64> = (0..11).map(|n| 3e-3 + 0.5e-3 * f64::from(n)).collect();
    let points: Vec<_> = radius.iter().map(|r| [16e-3 + r, 0.0, 0.0]).collect();
    let found = case.fields(&points);
    let stress = found.get(Quantity::Stress).unwrap();
    let scaled: Vec<f64> = radius
        .iter()
        .zip(stress.chunks_exact(9))
        .map(|(r, s)| s[4] * (2.0 * std::f64::consts::PI * r).sqrt())
        .collect();
    let mean =
        |x: &dyn Fn(usize) -> f64| (0..radius.len()).map(x).sum::<f64>() / radius.len() as f64;
    let (r, s) = (mean(&|i| radius[i]), mean(&|i| scaled[i]));
    let slope = mean(&|i| (radius[i] - r) * (scaled[i] - s)) / mean(&|i| (radius[i] - r).powi(2));
    [force / load, (s - slope * r) / k]
}

/// The flux of momentum through a section is the load, whatever the horizon. Ahead of the tip stress falls with the root of the distance, by
/// a K that goes to that of J, which knows nothing of fields, as the horizon (three spacings) does to 0.
#[test]
fn stress_ahead_of_a_crack_is_that_of_its_j() {
    let [wide, narrow] = [1.0, 0.5].map(crack);
    println!("force over load, K over that of J: {wide:?} {narrow:?}");
    for [force, _] in [wide, narrow] {
        assert!((force - 1.0).abs() < 1e-4, "{force}");
    }
    let [wide, narrow] = [wide, narrow].map(|c| (c[1] - 1.0).abs());
    assert!(narrow < 0.6 * wide && narrow < 0.12, "{wide} {narrow}");
}
