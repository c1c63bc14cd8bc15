//! (2.0.3) and (2.0.15): frequency and decay of waves under the linear operators, against the symbols of their kernels.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_transport::noll::Noll;
use peridyne_transport::quadrature::Gauss;
use peridyne_transport::{Bump, Flux, Kernel, Parity, Profile};

use super::laws::{failed, law, places};
use crate::{Context, Failure, Findings};

experiment!(
    Dispersion,
    "dispersion",
    "Waves of the linear operators, and Noll's flux",
    ["../laws.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// δ of the deck.
const DELTA: f64 = std::f64::consts::PI / 8.0;

const BUMPS: [(&str, Bump); 3] = [
    ("hat", Bump::Hat),
    ("cosine", Bump::Cosine),
    ("smooth", Bump::Smooth),
];

/// ω/k and decay/k² of a wave under the operator.
fn measured(name: &str, k: f64, points: usize) -> Result<[f64; 2], Failure> {
    let changes = [
        ("constants.k", k.to_string()),
        ("points", points.to_string()),
        ("advection.kernel.bump", name.to_string()),
        ("diffusion.kernel.bump", name.to_string()),
    ];
    let mut wave = law(DECK, &changes)?;
    let x = places(&wave);
    let (mut carried, mut spread) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    wave.operator.carry(&wave.u, 0.0, &mut carried);
    wave.operator.spread(&wave.u, 0.0, &mut spread);
    let part = |f: fn(f64) -> f64, v: &[f64]| {
        let sum: f64 = x.iter().zip(v).map(|(x, v)| f(k * x) * v).sum();
        2.0 * sum / x.len() as f64
    };
    Ok([
        part(f64::sin, &carried) / k,
        -part(f64::cos, &spread) / (k * k),
    ])
}

/// `∫ (u(y) − u(x)) φ_s dy` over u_xx of a wave cos kx, with (2.0.15) mollified: −b″, b = (315/256)(1 − s²)⁴ over a horizon of 1.
fn viscosity(k: f64) -> f64 {
    let kernel = |s: f64| {
        let rest = 1.0 - s * s;
        // b″ of the bump, by hand
        -(315.0 / 256.0) * (48.0 * s * s * rest.powi(2) - 8.0 * rest.powi(3))
    };
    // cos ks − 1 without cancellation; u_xx is −k² at a crest
    let bent = |s: f64| -2.0 * (0.5 * k * s).sin().powi(2) * kernel(s);
    Gauss::new(4).integral(-1.0, 1.0, bent) / (-k * k)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let points = if context.small { 256 } else { 1024 };
    let waves: Vec<f64> = (1..=20).map(|n| f64::from(2 * n)).collect();
    let mut plot = Plot::new("speed of waves under −2b′, of the local law 1")
        .x("kδ", "")
        .y("ω/k", "");
    let mut decays = Plot::new("decay of waves, of the local law 1")
        .x("kδ", "")
        .y("decay/k²", "");
    let mut table = Table::new().column("k delta", "", waves.iter().map(|k| k * DELTA));
    let mut worst = [0.0f64; 3];
    let mut finer = [0.0f64; 2];
    for (name, bump) in BUMPS {
        let kernel = |parity, profile| {
            Kernel::new(parity, profile, DELTA, 1, false, "kernel").map_err(failed)
        };
        let odd = kernel(Parity::Odd, Profile::Slope(bump))?;
        let even = kernel(Parity::Even, Profile::Value(bump))?;
        let (mut speeds, mut rates, mut symbols, mut bends) = (vec![], vec![], vec![], vec![]);
        for k in &waves {
            let [speed, rate] = measured(name, *k, points)?;
            let (symbol, bend) = (odd.symbol(*k) / k, -even.symbol(*k) / (k * k));
            worst[0] = worst[0].max((speed - symbol).abs());
            worst[1] = worst[1].max((rate - bend).abs());
            let [speed_finer, rate_finer] = measured(name, *k, 2 * points)?;
            finer[0] = finer[0].max((speed_finer - symbol).abs());
            finer[1] = finer[1].max((rate_finer - bend).abs());
            if let Some(closed) = bump.transform(k * DELTA) {
                worst[2] = worst[2].max((symbol - closed).abs());
            }
            speeds.push(speed);
            rates.push(rate);
            symbols.push(symbol);
            bends.push(bend);
        }
        let kd: Vec<f64> = waves.iter().map(|k| k * DELTA).collect();
        plot = plot.line(name, &kd, &symbols).points("", &kd, &speeds);
        decays = decays.line(name, &kd, &bends).points("", &kd, &rates);
        table = table
            .column(&format!("{name} speed"), "", speeds)
            .column(&format!("{name} symbol"), "", symbols)
            .column(&format!("{name} decay"), "", rates)
            .column(&format!("{name} symbol of decay"), "", bends);
    }
    found.number("speed", (worst[0] / finer[0]).log2());
    found.number("decay", (worst[1] / finer[1]).log2());
    found.measured("largest difference of speeds", worst[0], "");
    found.measured("largest difference of decays over k²", worst[1], "");
    found.number("closed", worst[2]);
    let flux = Flux::burgers();
    let kernel = Kernel::new(
        Parity::Odd,
        Profile::Slope(Bump::Smooth),
        DELTA,
        1,
        false,
        "kernel",
    );
    let kernel = kernel.map_err(failed)?;
    let noll = Noll {
        flux: &flux,
        kernel: &kernel,
        u: |x: f64| x.sin() + 0.3 * (2.0 * x).cos(),
        gauss: Gauss::new(6),
    };
    let [flow, integral] = noll.identity(0.3, 1.7);
    found.number("noll", (flow - integral).abs());
    // the moment of −δ′: (2.0.7) has the whole flux, the integral half of it
    let printed = Kernel::new(
        Parity::Odd,
        Profile::Function(std::sync::Arc::new(|z| 1.5 * z / DELTA.powi(3))),
        DELTA,
        1,
        true,
        "kernel",
    );
    let scale = printed.map_err(failed)?.value(0.5 * DELTA) / (0.75 / (DELTA * DELTA));
    found.number("half", 1.0 / scale);
    found.number("2.0.15", viscosity(1e-2));
    found.picture(plot.save(&context.out, "speed")?);
    found.picture(decays.save(&context.out, "decay")?);
    let path = context.out.join("waves.csv");
    table.save(&path)?;
    found.file(path);
    Ok(found)
}
