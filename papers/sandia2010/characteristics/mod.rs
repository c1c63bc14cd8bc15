//! (2.0.10)–(2.0.13), the algorithm by characteristics that the report proposes, and the sign of (2.0.15).

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_transport::quadrature::Gauss;
use peridyne_transport::{Bump, Kernel, Parity, Profile, measure};

use super::laws::{digits, failed, law, places};
use crate::{Context, Failure, Findings};

experiment!(
    Characteristics,
    "characteristics",
    "Characteristics of the nonlocal Burgers equation",
    ["../laws.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
const END: f64 = 0.5;
/// Steps until then, an even number.
const STEPS: usize = 200;
/// Where curves begin: on the slopes of sin x.
const STARTS: [f64; 5] = [0.3, 0.8, 2.5, 3.5, 5.5];
/// Least |u_x| at which G is looked at.
const STEEP: f64 = 0.05;

/// Values on a ring of equal cells from 0 to 2π.
struct Ring(Vec<f64>);

impl Ring {
    /// By the polynomial through the eight values around x.
    fn at(&self, x: f64) -> f64 {
        let n = self.0.len() as isize;
        let place = x / std::f64::consts::TAU * n as f64 - 0.5;
        let first = place.floor() as isize - 3;
        let s = place - first as f64;
        let value = |k: isize| self.0[(first + k).rem_euclid(n) as usize];
        let weight = |k: isize| -> f64 {
            let others = (0..8).filter(|m| *m != k);
            others.map(|m| (s - m as f64) / (k - m) as f64).product()
        };
        (0..8).map(|k| value(k) * weight(k)).sum()
    }

    /// Differences of order 8 (Fornberg 1988).
    fn slope(&self) -> Ring {
        const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
        let n = self.0.len();
        let h = std::f64::consts::TAU / n as f64;
        let at = |i: usize| {
            let each = WEIGHTS.iter().zip(1..);
            let sum = each.map(|(w, m)| w * (self.0[(i + m) % n] - self.0[(i + n - m) % n]));
            sum.sum::<f64>() / h
        };
        Ring((0..n).map(at).collect())
    }
}

/// u, f_x of (2.0.9b) and u_x at a time.
struct State {
    u: Ring,
    flux: Ring,
    slope: Ring,
}

impl State {
    /// f′ of (2.0.13).
    fn speed(&self, x: f64) -> f64 {
        self.flux.at(x) / self.slope.at(x)
    }
}

/// The solution of (2.0.5) at all steps until the end.
fn solved(delta: f64) -> Result<(Vec<f64>, Vec<State>), Failure> {
    let least = 8.0 * std::f64::consts::TAU / delta;
    let points = (least as usize).next_power_of_two();
    let changes = [
        ("horizon", delta.to_string()),
        ("points", points.to_string()),
    ];
    let mut e = law(DECK, &changes)?;
    let mut states = vec![];
    loop {
        let mut rate = vec![0.0; points];
        e.operator.rate(&e.u, e.time, &mut rate);
        let u = Ring(e.u.clone());
        states.push(State {
            slope: u.slope(),
            flux: Ring(rate.iter().map(|r| -r).collect()),
            u,
        });
        if states.len() > STEPS {
            return Ok((places(&e), states));
        }
        e.step(END / STEPS as f64).map_err(failed)?;
    }
}

/// Along (2.0.10) from x0: changes of u and of f′ until the end.
fn along(states: &[State], x0: f64) -> [f64; 2] {
    let dt = 2.0 * END / STEPS as f64;
    let mut x = x0;
    for three in states.windows(3).step_by(2) {
        let k1 = three[0].speed(x);
        let k2 = three[1].speed(x + 0.5 * dt * k1);
        let k3 = three[1].speed(x + 0.5 * dt * k2);
        let k4 = three[2].speed(x + dt * k3);
        x += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    let (first, last) = (&states[0], &states[states.len() - 1]);
    [last.u.at(x) - x0.sin(), last.speed(x) - first.speed(x0)]
}

/// G of (2.0.12) at the end where u is steep, its places first.
fn residual(x: &[f64], last: &State) -> [Vec<f64>; 2] {
    let all = x
        .iter()
        .zip(&last.u.0)
        .zip(last.flux.0.iter().zip(&last.slope.0));
    let steep = all.filter(|(_, (_, slope))| slope.abs() > STEEP);
    let (x, g) = steep
        .map(|((x, u), (flux, slope))| (*x, (x - END * flux / slope).sin() - u))
        .unzip();
    [x, g]
}

/// f_x at the crest, where u_x = 0.
fn crest(last: &State) -> f64 {
    let (mut low, mut high) = (1.5, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match last.slope.at(middle) > 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    last.flux.at(low)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let deltas: Vec<f64> = match context.small {
        true => vec![0.1, 0.05],
        false => vec![0.4, 0.2, 0.1, 0.05],
    };
    let mut plot = Plot::new("G of (2.0.12) of the nonlocal solution")
        .x("x", "")
        .y("G", "");
    let (mut residuals, mut bent, mut crests, mut carried) = (vec![], vec![], vec![], vec![]);
    for delta in &deltas {
        let (x, states) = solved(*delta)?;
        let last = &states[STEPS];
        let [at, g] = residual(&x, last);
        let square = g.iter().map(|g| g * g).sum::<f64>() / g.len() as f64;
        residuals.push(square.sqrt());
        crests.push(crest(last).abs());
        let changes = STARTS.map(|x0| along(&states, x0));
        let most = |k: usize| changes.iter().map(|c| c[k].abs()).fold(0.0, f64::max);
        carried.push(most(0));
        bent.push(most(1));
        plot = plot.line(&format!("δ = {delta}"), &at, &g);
    }
    let number = deltas.iter().position(|d| *d == 0.1).unwrap_or_default();
    found.number("carried", carried[number]);
    found.number("residual", residuals[number]);
    for (key, values) in [
        ("residual-order", &residuals),
        ("bent-order", &bent),
        ("crest-order", &crests),
    ] {
        let orders = measure::orders(&deltas, values);
        found.number(key, orders[orders.len() - 1]);
        found.measured(&format!("{key}: values"), digits(values), "");
    }
    found.measured("change of u along the curves", digits(&carried), "");
    found.number("sign", sign()?);
    found.picture(plot.save(&context.out, "residual")?);
    let path = context.out.join("residual.csv");
    Table::new()
        .column("delta", "", deltas)
        .column("G rms", "", residuals)
        .column("change of f'", "", bent)
        .column("f_x at the crest", "", crests)
        .save(&path)?;
    found.file(path);
    Ok(found)
}

/// `−∫ (u(x + z) − u(x)) b″(z) dz` over u_xx, u = sin.
fn sign() -> Result<f64, Failure> {
    let profile = Profile::Curvature(Bump::Polynomial(2));
    let kernel = Kernel::new(Parity::Even, profile, 0.01, 1, false, "kernel").map_err(failed)?;
    let x: f64 = 0.7;
    let both = |z: f64| (x + z).sin() + (x - z).sin() - 2.0 * x.sin();
    let integral = Gauss::new(8).integral(0.0, kernel.horizon(), |z| -kernel.value(z) * both(z));
    Ok(integral / -x.sin())
}
