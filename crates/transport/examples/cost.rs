//! What conservation laws cost, beside limits that are measured in the same run: nanoseconds per point and evaluation of the operator, and per point and step.
//! `cargo run --release --example cost`
//!
//! Direct sums: a bond pair of a convolution takes two loads of eight bytes and a subtraction, a product and a sum; the limit is the slower of such loads from the first
//! cache and such arithmetic in registers, by themselves, in the instruction set that the operator takes. Fourier: the real transforms that an evaluation needs, by `realfft` alone.

use peridyne::expression::Expression;
use peridyne_transport::operator::Transform;
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Evolution, Flux, Formula, Grid, Kernel, Law, Method,
    Operator, Parity, Profile, StepSize,
};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Points of the line.
const POINTS: usize = 1 << 13;
/// Cells along an edge of the plane.
const EDGE: usize = 128;

/// Seconds that this thread has been running, not waiting for others, where the system says it.
fn running() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split(' ').next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

/// The shortest time; of long work on one thread its mean running time if that is less, as others may use the machine.
fn best(mut work: impl FnMut()) -> f64 {
    let once = |work: &mut dyn FnMut()| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64()
    };
    let first = once(&mut work).max(1e-7);
    let rounds = (0.3 / first).clamp(100.0, 4000.0);
    let before = running();
    let shortest = (0..rounds as usize)
        .map(|_| once(&mut work))
        .fold(first, f64::min);
    match (before, running()) {
        (Some(before), Some(after)) if shortest > 1e-3 && rayon::current_num_threads() == 1 => {
            shortest.min((after - before) / rounds)
        }
        _ => shortest,
    }
}

/// Sums of values that stay in registers, as the operator has them.
type Sums = [f64; 32];

/// Both ends of a bond pair for 1024 points, from the first cache.
#[inline(always)]
fn load(v: &[f64], sums: &mut Sums) {
    let mut own = *sums;
    for part in v.chunks_exact(32) {
        for l in 0..32 {
            own[l] += part[l];
        }
    }
    *sums = own;
}

/// A subtraction, a product and a sum for each of 1024 points, in registers.
#[inline(always)]
fn compute(v: &[f64], sums: &mut Sums) {
    let mut own = *sums;
    let w = v[0];
    for k in 0..32 {
        let c = v[k];
        for l in 0..32 {
            own[l] += w * (own[l] - c);
        }
    }
    *sums = own;
}

macro_rules! widest {
    ($name:ident, $loop:ident) => {
        fn $name(v: &[f64], sums: &mut Sums) {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f")]
                fn with_avx512(v: &[f64], sums: &mut Sums) {
                    $loop(v, sums);
                }
                #[target_feature(enable = "avx2")]
                fn with_avx2(v: &[f64], sums: &mut Sums) {
                    $loop(v, sums);
                }
                if is_x86_feature_detected!("avx512f") {
                    // SAFETY: just detected
                    return unsafe { with_avx512(v, sums) };
                }
                if is_x86_feature_detected!("avx2") {
                    // SAFETY: just detected
                    return unsafe { with_avx2(v, sums) };
                }
            }
            $loop(v, sums);
        }
    };
}
widest!(loads, load);
widest!(arithmetic, compute);

/// Nanoseconds of a bond pair and point: loads, arithmetic.
fn pair() -> [f64; 2] {
    const ROUNDS: usize = 200;
    let v = vec![1e-3; 2048];
    [loads, arithmetic].map(|work| {
        let mut sums = [0.0; 32];
        let time = best(|| {
            for _ in 0..ROUNDS {
                work(black_box(&v), black_box(&mut sums));
            }
        });
        time * 1e9 / (ROUNDS * 1024) as f64
    })
}

/// Nanoseconds per point of a transform there and back.
fn transforms(grid: &Grid, u: &[f64]) -> f64 {
    let mut transform = Transform::new(grid.cells);
    let mut spectrum = transform.spectrum();
    let mut back = vec![0.0; u.len()];
    let time = best(|| {
        transform.to_spectrum(u, &mut spectrum);
        transform.to_values(&mut spectrum, &mut back);
    });
    time * 1e9 / u.len() as f64
}

fn kernel(grid: &Grid, parity: Parity, spacings: usize) -> Outcome<Kernel> {
    let profile = match parity {
        Parity::Odd => Profile::Slope(Bump::Smooth),
        Parity::Even => Profile::Value(Bump::Smooth),
    };
    let horizon = spacings as f64 * grid.spacing;
    let made = Kernel::new(parity, profile, horizon, grid.dimension, false, "kernel")?;
    Ok(made)
}

fn law(grid: &Grid, flux: Flux, spacings: usize, viscosity: f64) -> Outcome<Law> {
    let odd = kernel(grid, Parity::Odd, spacings)?;
    let even = kernel(grid, Parity::Even, spacings)?;
    let flux = (flux, Direction::Constant([1.0, 0.0]), &odd);
    let spreads = (viscosity > 0.0).then_some((viscosity, &even));
    Ok(Law::new(*grid, Boundary::Periodic, Some(flux), spreads)?)
}

/// Nanoseconds per point of an evaluation and of a step of RK4, its choice of length with it.
fn cost(law: &Law, evaluation: Evaluation, u: &[f64]) -> Outcome<[f64; 2]> {
    let mut operator = Operator::new(law.clone(), evaluation)?;
    let mut out = vec![0.0; u.len()];
    let once = best(|| operator.rate(black_box(u), 0.0, &mut out));
    let mut e = Evolution::new(operator, u.to_vec(), Method::Rk4, StepSize::Part(1e-3));
    let mut failed = None;
    let step = best(|| {
        let done = e.next_step(1e9).and_then(|dt| e.step(dt));
        failed = failed.take().or(done.err());
    });
    match failed {
        Some(error) => Err(error.into()),
        None => Ok([once, step].map(|t| t * 1e9 / u.len() as f64)),
    }
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Outcome<T> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    Ok(pool.build()?.install(work))
}

/// Against the horizon on a line; with viscosity there is a convolution more.
fn horizons(grid: &Grid, u: &[f64], viscosity: f64) -> Outcome<()> {
    let [loads, arithmetic] = pair();
    let there_and_back = transforms(grid, u);
    // Burgers: u² and u there, two sums back; diffusion: one of each
    let pairs_of_transforms = if viscosity > 0.0 { 3.0 } else { 2.0 };
    let convolutions = pairs_of_transforms;
    let bare = pairs_of_transforms * there_and_back;
    println!(
        "| spacings | direct, evaluation | step | limit of a step | ratio | Fourier, evaluation | step | limit of a step | ratio |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for m in [3, 4, 8, 16, 32, 64, 256, 1024, 8192] {
        let law = law(grid, Flux::burgers(), m, viscosity)?;
        let fourier = cost(&law, Evaluation::Fourier, u)?;
        let of_fourier = format!(
            "{:.2} | {:.1} | {:.1} | {:.2}",
            fourier[0],
            fourier[1],
            4.0 * bare,
            fourier[1] / (4.0 * bare)
        );
        let limit = 4.0 * convolutions * m as f64 * loads.max(arithmetic);
        let of_direct = match m <= 1024 {
            true => {
                let direct = cost(&law, Evaluation::Direct, u)?;
                let ratio = direct[1] / limit;
                format!(
                    "{:.2} | {:.1} | {limit:.1} | {ratio:.2}",
                    direct[0], direct[1]
                )
            }
            false => format!(" | | {limit:.0} | "),
        };
        println!("| {m} | {of_direct} | {of_fourier} |");
    }
    println!(
        "a bond pair and point: {loads:.4} ns of loads, {arithmetic:.4} ns of arithmetic; a transform there and back {there_and_back:.2} ns per point"
    );
    Ok(())
}

fn main() -> Outcome<()> {
    let line = Grid::line(0.0, 1.0, POINTS)?;
    let u = line.sample(|x| (std::f64::consts::TAU * x[0]).sin());
    println!("ns per point; a step is one of RK4, four evaluations; one thread");
    println!("\nBurgers on {POINTS} points");
    on_threads(1, || horizons(&line, &u, 0.0).map_err(|e| e.to_string()))??;
    println!("\nBurgers with viscosity on {POINTS} points");
    on_threads(1, || horizons(&line, &u, 1e-4).map_err(|e| e.to_string()))??;

    let plane = Grid::plane([0.0; 2], [1.0; 2], EDGE)?;
    let v = plane.sample(|x| (std::f64::consts::TAU * (x[0] + 2.0 * x[1])).sin());
    println!("\nBurgers in a plane of {EDGE} × {EDGE}, ns per point and step");
    println!(
        "| spacings | direct, 1 thread | 2 threads | Fourier, 1 thread | 2 threads | limit on 1 thread | ratio |"
    );
    println!("|---|---|---|---|---|---|---|");
    for m in [3, 8, 16] {
        let law = law(&plane, Flux::burgers(), m, 0.0)?;
        let of = |threads, way| {
            on_threads(threads, || {
                cost(&law, way, &v).map(|c| c[1]).map_err(|e| e.to_string())
            })
        };
        let [a, b] = [of(1, Evaluation::Direct)??, of(2, Evaluation::Direct)??];
        let [c, d] = [of(1, Evaluation::Fourier)??, of(2, Evaluation::Fourier)??];
        let bare = 8.0 * on_threads(1, || transforms(&plane, &v))?;
        println!(
            "| {m} | {a:.0} | {b:.0} | {c:.0} | {d:.0} | {bare:.0} | {:.2} |",
            c / bare
        );
    }
    let wide = law(&line, Flux::burgers(), 256, 0.0)?;
    print!("\nBurgers on {POINTS} points, 256 spacings, direct, ns per point and step:");
    for threads in [1, 2] {
        let [_, step] = on_threads(threads, || {
            cost(&wide, Evaluation::Direct, &u).map_err(|e| e.to_string())
        })??;
        print!(" {step:.0} on {threads},");
    }

    println!(
        "\n\nfluxes by expression on {POINTS} points, 32 spacings, ns per point and evaluation, one thread"
    );
    println!(
        "| ψ | bond by bond through the interpreter | many at a time | as a polynomial, direct | Fourier |"
    );
    println!("|---|---|---|---|---|");
    for text in [
        "x^2/2",
        "x - x^3/3 + 0.1*x^4",
        "sin(x)",
        "abs(x)*x/2",
        "x^2/(x^2 + 0.5*(1-x)^2)",
    ] {
        let expression = Expression::parse(text, &[]).map_err(|e| e.to_string())?;
        let formula = Formula::new(text, &[]).map_err(|e| e.to_string())?;
        let bond_by_bond =
            Flux::Function(Arc::new(move |u: f64| expression.eval(&[u, 0.0, 0.0], 0.0)));
        let arrays = Flux::Function(Arc::new(formula.clone()));
        let found = Flux::of_formula(formula, -1.0, 1.0);
        let mut fluxes = vec![
            (bond_by_bond, Evaluation::Direct),
            (arrays, Evaluation::Direct),
        ];
        if matches!(found, Flux::Polynomial(_)) {
            fluxes.push((found.clone(), Evaluation::Direct));
            fluxes.push((found, Evaluation::Fourier));
        }
        print!("| `{}` |", text.replace('x', "u"));
        for column in 0..4 {
            let Some((flux, way)) = fluxes.get(column) else {
                print!(" |");
                continue;
            };
            let law = law(&line, flux.clone(), 32, 0.0)?;
            let once = on_threads(1, || {
                let mut operator = Operator::new(law.clone(), *way).map_err(|e| e.to_string())?;
                let mut out = vec![0.0; u.len()];
                let time = best(|| operator.rate(black_box(&u), 0.0, &mut out));
                Ok::<_, String>(time * 1e9 / u.len() as f64)
            })??;
            print!(" {once:.1} |");
        }
        println!();
    }
    Ok(())
}
