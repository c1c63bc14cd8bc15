//! What the operator costs: nanoseconds per point and evaluation, direct and by Fourier transforms, against the horizon, beside their limits.
//! `cargo run --release -p peridyne-transport --example cost`
//!
//! The limit of direct sums is two loads of eight bytes per bond pair, point and convolution from the first cache; that of Fourier transforms four real transforms of
//! the grid (two there, two back) done by themselves.

use peridyne_transport::operator::Transform;
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Flux, Grid, Kernel, Law, Operator, Parity, Profile,
};
use std::hint::black_box;
use std::time::Instant;

fn best(mut work: impl FnMut()) -> f64 {
    let once = |work: &mut dyn FnMut()| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64()
    };
    let first = once(&mut work).max(1e-7);
    let rounds = (0.2 / first).clamp(3.0, 2000.0) as usize;
    (0..rounds).map(|_| once(&mut work)).fold(first, f64::min)
}

/// Loads of both ends of `pairs` bonds from the first cache, nothing else, in the instruction set that the operator takes.
fn loads(pairs: usize) -> f64 {
    let v = vec![1.0; 2048];
    let time = best(|| {
        let mut sum = [0.0; 64];
        for _ in 0..pairs {
            pass(black_box(&v), &mut sum);
        }
        black_box(sum);
    });
    time / (v.len() / 2) as f64
}

fn pass(v: &[f64], sum: &mut [f64; 64]) {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: just detected
            return unsafe { with_avx512(v, sum) };
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: just detected
            return unsafe { with_avx2(v, sum) };
        }
    }
    add(v, sum);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn with_avx512(v: &[f64], sum: &mut [f64; 64]) {
    add(v, sum);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2(v: &[f64], sum: &mut [f64; 64]) {
    add(v, sum);
}

#[inline(always)]
fn add(v: &[f64], sum: &mut [f64; 64]) {
    let mut own = *sum;
    for part in v.chunks_exact(64) {
        for l in 0..64 {
            own[l] += part[l];
        }
    }
    *sum = own;
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let n = 1 << 15;
    let grid = Grid::line(0.0, 1.0, n)?;
    let u = grid.sample(|x| (std::f64::consts::TAU * x[0]).sin());
    let mut out = vec![0.0; n];
    let mut transform = Transform::new([n, 1]);
    let mut spectrum = transform.spectrum();
    let mut back = vec![0.0; n];
    let transforms = 2.0
        * best(|| {
            transform.to_spectrum(&u, &mut spectrum);
            transform.to_values(&mut spectrum, &mut back);
        });
    println!("Burgers on {n} points, one evaluation of the operator; ns per point");
    println!("  transforms alone {:.2}", transforms * 1e9 / n as f64);
    println!("  spacings   direct   its loads   fourier");
    for m in [3, 4, 8, 16, 32, 64, 256, 1024, 8192] {
        let kernel = Kernel::new(
            Parity::Odd,
            Profile::Slope(Bump::Smooth),
            f64::from(m) * grid.spacing,
            1,
            false,
            "kernel",
        )?;
        let law = Law::new(
            grid,
            Boundary::Periodic,
            Some((Flux::burgers(), Direction::Constant([1.0, 0.0]), &kernel)),
            None,
        )?;
        let mut cost = |evaluation| -> Result<f64, Box<dyn std::error::Error>> {
            let mut operator = Operator::new(law.clone(), evaluation)?;
            Ok(best(|| operator.rate(black_box(&u), 0.0, &mut out)) * 1e9 / n as f64)
        };
        let direct = if m <= 1024 {
            cost(Evaluation::Direct)?
        } else {
            f64::NAN
        };
        let fourier = cost(Evaluation::Fourier)?;
        // two convolutions
        let limit = 2.0 * loads(m as usize) * 1e9;
        println!("  {m:8} {direct:8.2} {limit:11.2} {fourier:9.2}");
    }
    Ok(())
}
