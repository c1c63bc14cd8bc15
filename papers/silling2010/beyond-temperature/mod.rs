//! Atoms at a temperature (section 7): force states from the frames of a run, against stress and strain of runs.

use peridyne::run::{Options as Build, Simulation, Watched, build};
use peridyne::space::Point;
use peridyne::spec::{BodySpec, Cloud, LinearBody, Spec, TimeStep};
use peridyne_io::deck::Deck;
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::thermal::{Frames, Options, Thermal, constants_of, thermal};

use crate::silling2010::compare::failed;
use crate::silling2010::crystal::deck;
use crate::{Context, Failure, Findings};

experiment!(
    BeyondTemperature,
    "beyond-temperature",
    "Atoms at a temperature",
    ["../compare.rs", "../crystal.rs", "deck.toml"],
    Minutes
);

const DECK: &str = include_str!("deck.toml");
/// kT (energy).
const HEAT: f64 = 0.1;
/// Edge of the cubic cell (length).
const SPACING: f64 = 1.57;
const STEP: f64 = 0.005;
/// Steps between draws of all velocities (Andersen 1980): the ensemble is canonical.
const DRAW: usize = 200;
/// Steps before anything is measured.
const BEFORE: usize = 4000;
/// Steps between stresses, and between frames.
const STRESS: usize = 10;
const FRAME: usize = 100;
const STRAIN: f64 = 0.005;
/// Parts of a run whose means are told apart.
const PARTS: usize = 20;

struct Random(u64);

impl Random {
    /// Evenly in (0, 1), splitmix64.
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// Box and Muller.
    fn normal(&mut self) -> f64 {
        let (x, y) = (self.even(), self.even());
        (-2.0 * libm::log(x)).sqrt() * libm::cos(std::f64::consts::TAU * y)
    }
}

/// Atoms of a crystal in a box of so many cells, along the axes of the cube or, `turned`, along [110], [1̄10] and [001], stretched.
fn crystal(cells: [usize; 3], turned: bool, strain: [f64; 3]) -> (Vec<Point>, Point) {
    let root = 0.5f64.sqrt();
    let (edges, basis): (Point, Vec<Point>) = match turned {
        false => (
            [SPACING; 3],
            vec![
                [0.0, 0.0, 0.0],
                [0.0, 0.5, 0.5],
                [0.5, 0.0, 0.5],
                [0.5, 0.5, 0.0],
            ],
        ),
        true => (
            [SPACING * root, SPACING * root, SPACING],
            vec![[0.0; 3], [0.5; 3]],
        ),
    };
    let edges: Point = std::array::from_fn(|a| edges[a] * (1.0 + strain[a]));
    let mut sites = vec![];
    for n in 0..cells.iter().product() {
        let cell = [
            n % cells[0],
            n / cells[0] % cells[1],
            n / cells[0] / cells[1],
        ];
        for b in &basis {
            sites.push(std::array::from_fn(|a| edges[a] * (cell[a] as f64 + b[a])));
        }
    }
    (sites, std::array::from_fn(|a| edges[a] * cells[a] as f64))
}

/// The deck's atoms at these sites.
fn spec((sites, box_): &(Vec<Point>, Point)) -> Result<Spec, Failure> {
    let deck: Deck = deck(DECK, &[])?;
    let mut spec = deck.spec;
    let n = sites.len();
    let volume = box_.iter().product::<f64>() / n as f64;
    spec.body = BodySpec::Cloud(Cloud {
        position: sites.clone(),
        volume: vec![volume; n],
        density: vec![1.0 / volume; n],
        ..Cloud::default()
    });
    spec.space.periodic = box_.map(Some);
    spec.loading.thermal = None;
    spec.run.schedule.time_step = TimeStep::Fixed(STEP);
    Ok(spec)
}

fn model(spec: &Spec) -> Result<Box<dyn Simulation>, Failure> {
    build(spec, Build::default()).map_err(failed)
}

/// A canonical run: what is seen every so many steps.
fn canonical(
    sim: &mut dyn Simulation,
    steps: usize,
    every: usize,
    seed: u64,
    mut see: impl FnMut(&mut dyn Simulation),
) -> Result<(), Failure> {
    let n = sim.info().points as usize;
    let mut random = Random(seed);
    let draw = |sim: &mut dyn Simulation, random: &mut Random| {
        let v: Vec<Point> = (0..n)
            .map(|_| std::array::from_fn(|_| HEAT.sqrt() * random.normal()))
            .collect();
        let mut mean = [0.0; 3];
        for v in &v {
            (0..3).for_each(|a| mean[a] += v[a] / n as f64);
        }
        let v: Vec<Point> = (v.iter())
            .map(|v| std::array::from_fn(|a| v[a] - mean[a]))
            .collect();
        sim.set_velocities(&v);
        sim.start(true);
    };
    for step in 0..BEFORE + steps {
        if step % DRAW == 0 {
            draw(sim, &mut random);
        }
        let seen = step >= BEFORE && (step + 1) % every == 0;
        if seen {
            sim.watch(Watched::Virial);
        }
        sim.step().map_err(failed)?;
        if seen {
            see(sim);
        }
    }
    Ok(())
}

/// Mean stress of a crystal and its standard error, xx yy zz. Momenta are drawn, so that their part is known.
fn stress(
    cells: [usize; 3],
    turned: bool,
    strain: [f64; 3],
    steps: usize,
    seed: u64,
) -> Result<[Vec<f64>; 2], Failure> {
    let crystal = crystal(cells, turned, strain);
    let volume: f64 = crystal.1.iter().product();
    let mut sim = model(&spec(&crystal)?)?;
    let mut all: Vec<Point> = vec![];
    canonical(sim.as_mut(), steps, STRESS, seed, |sim| {
        let w = sim.virial();
        all.push([w[0], w[1], w[2]].map(|w| -w / volume));
    })?;
    let kinetic = (crystal.0.len() - 1) as f64 * HEAT / volume;
    let part = all.len() / PARTS;
    let means: Vec<Point> = (0..PARTS)
        .map(|p| {
            let some = &all[p * part..(p + 1) * part];
            std::array::from_fn(|a| some.iter().map(|s| s[a]).sum::<f64>() / part as f64)
        })
        .collect();
    let mean = |a: usize| means.iter().map(|m| m[a]).sum::<f64>() / PARTS as f64;
    let error = |a: usize| {
        let each = means.iter().map(|m| (m[a] - mean(a)).powi(2));
        (each.sum::<f64>() / (PARTS * (PARTS - 1)) as f64).sqrt()
    };
    Ok([
        (0..3).map(|a| mean(a) - kinetic).collect(),
        (0..3).map(error).collect(),
    ])
}

/// C11, C12, C44 by difference quotients of stress and strain, and their standard errors.
fn by_strain(context: &Context, steps: usize) -> Result<[[f64; 2]; 3], Failure> {
    let run = |name: &str, cells, turned, strain: [f64; 3], seed| {
        context.part(name, || stress(cells, turned, strain, steps, seed))
    };
    let e = STRAIN;
    let cube = [4, 4, 4];
    let [p, dp] = run("stretched", cube, false, [e, 0.0, 0.0], 1)?;
    let [m, dm] = run("compressed", cube, false, [-e, 0.0, 0.0], 2)?;
    // stretched along [110] and compressed along [1̄10]: sheared along the axes of the cube, σ_1 − σ_2 = 4 C44 ε
    let cell = [6, 6, 4];
    let [s, ds] = run("sheared", cell, true, [e, -e, 0.0], 3)?;
    let [t, dt] = run("sheared-back", cell, true, [-e, e, 0.0], 4)?;
    let sum = |all: &[f64]| all.iter().map(|x| x * x).sum::<f64>().sqrt();
    Ok([
        [(p[0] - m[0]) / (2.0 * e), sum(&[dp[0], dm[0]]) / (2.0 * e)],
        [
            (p[1] + p[2] - m[1] - m[2]) / (4.0 * e),
            sum(&[dp[1], dp[2], dm[1], dm[2]]) / (4.0 * e),
        ],
        [
            (s[0] - s[1] - t[0] + t[1]) / (8.0 * e),
            sum(&[ds[0], ds[1], dt[0], dt[1]]) / (8.0 * e),
        ],
    ])
}

/// Frames of the crystal without strain.
struct Seen {
    sites: LinearBody<3>,
    displacement: Vec<Vec<Point>>,
    force: Vec<Vec<Point>>,
    /// C11, C12, C44 of the mean of Hessians.
    born: [f64; 3],
}

fn cubic(s: &peridyne_theory::voigt::Stiffness) -> [f64; 3] {
    let mean = |all: [f64; 3]| all.iter().sum::<f64>() / 3.0;
    [
        mean([s.c[0][0], s.c[1][1], s.c[2][2]]),
        mean([s.c[0][1], s.c[0][2], s.c[1][2]]),
        mean([s.c[3][3], s.c[4][4], s.c[5][5]]),
    ]
}

fn three(any: peridyne::spec::AnyLinearBody) -> Result<LinearBody<3>, Failure> {
    any.of::<3>()
        .ok_or_else(|| Failure::new("the deck is not three-dimensional"))
}

fn seen(steps: usize) -> Result<Seen, Failure> {
    let spec = spec(&crystal([4, 4, 4], false, [0.0; 3]))?;
    let mut sim = model(&spec)?;
    let mut still = model(&spec)?;
    let sites = three(still.linear_body())?;
    let (mut displacement, mut force) = (vec![], vec![]);
    canonical(sim.as_mut(), steps, FRAME, 5, |sim| {
        let u = sim.displacements();
        let f = sim.vectors("force_density").into_iter();
        force.push(
            f.zip(&sites.volume)
                .map(|(f, v)| f.map(|f| f * v))
                .collect::<Vec<Point>>(),
        );
        displacement.push(u);
    })?;
    // some forty are enough for a mean over as many bonds
    let (mut born, mut count) = ([0.0; 3], 0.0);
    for u in displacement.iter().step_by(displacement.len().div_ceil(40)) {
        still.set_displacements(u);
        still.start(true);
        let hessian = LinearBody {
            position: sites.position.clone(),
            ..three(still.linear_body())?
        };
        let c = cubic(&constants_of(&hessian, &[[0.0; 3]; 3]));
        (0..3).for_each(|k| born[k] += c[k]);
        count += 1.0;
    }
    Ok(Seen {
        sites,
        displacement,
        force,
        born: born.map(|c| c / count),
    })
}

fn fitted(seen: &Seen, radius: f64) -> Result<Thermal<3>, Failure> {
    let frames = Frames {
        sites: &seen.sites,
        kind: &vec![0; seen.sites.points()],
        displacement: &seen.displacement,
        force: &seen.force,
        virial: None,
    };
    let options = Options {
        radius,
        symmetry: true,
    };
    thermal(&frames, &options).map_err(failed)
}

/// Largest difference of the blocks of small motions and of the Hessian over the largest block; pairs of frames with opposite
/// displacements, so that forces of second order cancel.
fn hessian() -> Result<f64, Failure> {
    let spec = spec(&crystal([4, 4, 4], false, [0.0; 3]))?;
    let mut sim = model(&spec)?;
    let sites = three(sim.linear_body())?;
    let mut random = Random(6);
    let u: Vec<Point> = (0..sites.points())
        .map(|_| std::array::from_fn(|_| 1e-6 * random.normal()))
        .collect();
    let displacement: [Vec<Point>; 2] =
        [1.0, -1.0].map(|s| u.iter().map(|u| u.map(|c| s * c)).collect());
    let force = (displacement.iter())
        .map(|u: &Vec<Point>| {
            let f = sim.forces_under(u).into_iter();
            f.zip(&sites.volume)
                .map(|(f, v)| f.map(|f| f * v))
                .collect()
        })
        .collect();
    let seen = Seen {
        displacement: displacement.to_vec(),
        force,
        born: [0.0; 3],
        sites,
    };
    let found = fitted(&seen, 2.5)?.body;
    let (mut off, mut size) = (0.0f64, 0.0f64);
    for i in 0..found.points() {
        let (partners, blocks) = seen.sites.row(i);
        for (j, exact) in partners.iter().zip(blocks) {
            let fitted = found.micromodulus(i, *j as usize);
            let fitted = fitted.map_or([f64::NAN; 9], |b| std::array::from_fn(|k| b[k / 3][k % 3]));
            for (x, y) in fitted.iter().zip(exact.as_flattened()) {
                off = off.max(if x.is_nan() {
                    f64::INFINITY
                } else {
                    (x - y).abs()
                });
                size = size.max(y.abs());
            }
        }
    }
    Ok(off / size)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    found.number("hessian", hessian()?);
    let steps = if context.small { 2_000 } else { 400_000 };
    let radii = [2.5, 3.1];
    type Row = ([f64; 3], [f64; 3], f64, f64);
    let (rows, born): (Vec<Row>, [f64; 3]) = context.part("frames", || {
        let seen = seen(steps)?;
        let mut rows = vec![];
        for radius in radii {
            let made = fitted(&seen, radius)?;
            let elastic = made.elastic.map_err(Failure::new)?;
            let e = elastic.error.unwrap_or([[f64::NAN; 6]; 6]);
            let error = [e[0][0], e[0][1], e[3][3]];
            rows.push((
                cubic(&elastic.stiffness),
                error,
                made.temperature,
                made.residual,
            ));
        }
        Ok((rows, seen.born))
    })?;
    // a quarter longer than those of the potential
    let Some((fit, error, temperature, residual)) = rows.last().copied() else {
        return Err(Failure::new("no radius"));
    };
    found.measured(
        "forces that displacements do not explain",
        100.0 * residual,
        "%",
    );
    found.holds(
        "temperature",
        format!("{temperature:.4} by forces and displacements"),
        (temperature / HEAT - 1.0).abs() < if context.small { 0.1 } else { 0.01 },
    );
    let names = ["C11", "C12", "C44"];
    let told = |c: [f64; 3]| format!("{:.2}, {:.2}, {:.2}", c[0], c[1], c[2]);
    if context.small {
        return Ok(found);
    }
    found.holds(
        "born",
        format!(
            "{} of the mean Hessian, {} of the fit",
            told(born),
            told(fit)
        ),
        (0..3).all(|k| born[k] > 1.05 * fit[k]),
    );
    let strained = by_strain(context, 3 * steps / 2)?;
    let mut table = Table::new()
        .text("constant", names)
        .column("stress and strain", "", strained.map(|s| s[0]))
        .column("its standard error", "", strained.map(|s| s[1]));
    for ((c, e, ..), radius) in rows.iter().zip(radii) {
        table = table.column(&format!("fit up to {radius}"), "", *c).column(
            &format!("standard error up to {radius}"),
            "",
            *e,
        );
    }
    table = table.column("mean Hessian", "", born);
    let path = context.out.join("constants.csv");
    table.save(&path)?;
    found.file(path);
    for (k, name) in names.into_iter().enumerate() {
        let [exact, own] = strained[k];
        found.number(&name.to_lowercase(), 100.0 * (fit[k] / exact - 1.0));
        found.measured(
            &format!("{name} by stress and strain, its standard error, and that of the fit"),
            format!("{exact:.2}, {own:.2}, {:.2}", error[k]),
            "",
        );
        found.measured(
            &format!("{name} of the potential's own bonds, and its standard error"),
            format!("{:.2}, {:.2}", rows[0].0[k], rows[0].1[k]),
            "",
        );
    }
    Ok(found)
}
