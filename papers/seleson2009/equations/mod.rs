//! Equations (4.2) to (4.9), (5.2), (5.4): gradient equations and dispersion relations, derived and compared with the print.

mod printed;

use std::io::Write;

use peridyne_io::write::atomic::write_file;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::dispersion::chain::{SpringContinuum, cin};
use peridyne_theory::exact::{Field, Q, q};
use peridyne_theory::gradient::Expansion;
use peridyne_theory::gradient::comparison::{Comparison, compare};
use peridyne_theory::gradient::inner;
use peridyne_theory::gradient::linear::{
    LinearChain, dispersion_series, springs_closed, springs_continuum, springs_excess,
};
use peridyne_theory::gradient::power_law::{PowerLawChain, orders};

use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Equations,
    "equations",
    "Gradient equations and dispersion relations",
    ["printed.rs"]
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    springs(&mut found)?;
    let verdicts = [upscaling_of_springs(&mut found), lennard_jones(&mut found)];
    dispersion(context, &mut found)?;
    let path = context.out.join("equations.md");
    let text = format!("{}\n{}", derived(), verdicts.concat());
    write_file(&path, |w| w.write_all(text.as_bytes()))?;
    found.file(path);
    Ok(found)
}

fn fractions(values: &[Q]) -> String {
    let texts: Vec<String> = values.iter().map(Q::to_string).collect();
    texts.join(", ")
}

/// (4.2) to (4.9): coefficients in units of K1/ρ and of the length that they hold, δ = Na or a.
fn springs(found: &mut Findings) -> Result<(), Failure> {
    let one = || q(1, 1);
    let nonlocal = springs_continuum(one(), one(), 4);
    let md = many_neighbours(4);
    found.text("4.2", fractions(&md[..3]));
    let far = |n: i64| springs_closed(&one(), &q(1, n), n as usize, 3);
    let (near, off) = (far(1000), far(2000));
    let rest = |c: &[Q], p: usize| (c[p].clone() - nonlocal[p].clone()).value().abs();
    let halves = [1, 2].map(|p| rest(&near, p) / rest(&off, p));
    found.number("4.2-limit", largest(halves.map(|h| (h - 2.0).abs())));
    found.text("4.2-finite", fractions(&springs_excess(20, 3)));
    found.text("4.4", fractions(&nonlocal[..3]));
    found.text("4.4-next", nonlocal[3].to_string());
    let local = LinearChain::springs(one(), one(), 1).coefficients(4);
    found.text("4.6", fractions(&local[..3]));
    let series =
        |c: &[Q]| dispersion_series(c).ok_or_else(|| Failure::new("long waves have no speed"));
    let [_, root] = series(&md)?;
    found.text("4.8", fractions(&root.0[..3]));
    let [square, root] = series(&nonlocal)?;
    found.text("4.9", fractions(&root.0[..3]));
    found.text("4.9-square", fractions(&square.0[..3]));
    // K(N) = 2 K1/(N (N+1)): the same long waves for every N
    let same =
        (1..=40).all(|n| LinearChain::springs(one(), q(1, 3), n).coefficients(1)[0] == one());
    found.holds("a-1", format!("c₂ = K1 for N = 1 … 40: {same}"), same);
    Ok(())
}

/// Coefficients of the chain with Na = 1 in the limit N → ∞: they are polynomials of 1/N, of degree 2p, so that 2p + 1
/// chains determine them.
fn many_neighbours(terms: usize) -> Vec<Q> {
    let chains = 1..2 * terms as i64;
    let of = |n: i64| LinearChain::springs(q(1, 1), q(1, n), n as usize).coefficients(terms);
    let mut limit = vec![q(0, 1); terms];
    for n in chains.clone() {
        // Lagrange's polynomial of 1/N at 0
        let others = chains.clone().filter(|m| *m != n);
        let weight = others.fold(q(1, 1), |w, m| w * q(-1, m) / (q(1, n) - q(1, m)));
        for (l, c) in limit.iter_mut().zip(of(n)) {
            *l += c * weight.clone();
        }
    }
    limit
}

/// The four-step test of section 3 on the springs; its verdicts in words.
fn upscaling_of_springs(found: &mut Findings) -> String {
    let horizon = || q(5, 1);
    let limit = Expansion::linear(&springs_continuum(q(1, 1), horizon(), 8));
    // Na = 5: order 2p + 2 holds (Na)^2p
    let md: Vec<Q> = many_neighbours(8)
        .into_iter()
        .enumerate()
        .map(|(p, c)| c * horizon().to(2 * p as i32))
        .collect();
    let md = Expansion::linear(&md);
    let same = compare(&md, &limit, 0.0);
    found.text("upscaling-limits", verdict(&same));
    let chain =
        |n: i64, spacing: Q| LinearChain::springs(q(1, 1), spacing, n as usize).expansion(4);
    let resolved = compare(&chain(20, q(1, 4)), &chain(10, q(1, 2)), 0.0);
    found.text("upscaling-finite", verdict(&resolved));
    let local = compare(&chain(1, q(1, 4)), &chain(20, q(1, 4)), 0.0);
    found.text("upscaling-local", verdict(&local));
    format!(
        "## Springs, δ = 5\n\nMD and PD, both N ≫ 1: {}\n\nMD with N = 20 and PD with N = 10:\n\n{resolved}\n\nNearest neighbours and N = 20:\n\n{local}\n\n",
        verdict(&same)
    )
}

/// The last line of a comparison.
fn verdict(c: &Comparison<Q>) -> String {
    let text = c.to_string();
    text.lines().last().unwrap_or_default().to_string()
}

/// (5.2) and (5.4), and what follows from them.
fn lennard_jones(found: &mut Findings) -> String {
    let (epsilon, sigma6, a) = (q(3, 7), q(5, 11), q(4, 3));
    let (mut right, mut terms, mut routes) = (true, 0, true);
    let mut upscaled = true;
    for n in [1usize, 2, 4, 7] {
        let chain = PowerLawChain::lennard_jones(epsilon.clone(), sigma6.clone(), a.clone(), n);
        let [e, s6] =
            PowerLawChain::upscaled_parameters(epsilon.clone(), sigma6.clone(), a.clone(), n);
        let derived = chain.expansion(3);
        let print = printed::gradient_equation(&e, &s6, &a, n);
        right &= derived.orders == print;
        terms = print.iter().map(|p| p.terms().count()).sum();
        routes &= inner::expansion(&chain, 3) == derived;
        // (5.3) with M = N and Δx = a
        upscaled &=
            PowerLawChain::lennard_jones_upscaled(e, s6, a.clone(), n).expansion(3) == derived;
    }
    found.holds(
        "5.2",
        format!("{terms} terms, N = 1, 2, 4, 7: the same fractions: {right}; by energies and by forces: {routes}"),
        right && routes && terms == 22,
    );
    found.holds(
        "5.4",
        format!("the equation of (5.3) with M = N and Δx = a is that of (5.1): {upscaled}"),
        upscaled,
    );
    let paper = |n: i64, m: usize| {
        PowerLawChain::lennard_jones_upscaled(q(1, 1), q(1, 2), q(n, 1), m).expansion(4)
    };
    // waves about y′ = 1: the coefficient of y″
    let speed = paper(1, 4).orders[0].at(&[1.0, 1.0]);
    found.number("5.2-speed", speed);
    // the force in the chain at rest is the slope of its energy density
    let pull = [1, 2, 4, 7].map(|n| {
        let chain = PowerLawChain::lennard_jones_upscaled(q(1, 1), q(1, 2), q(1, 1), n);
        inner::energy(&chain, 1)[0].partial(1).at(&[1.0]).abs()
    });
    found.number("a-5", largest(pull));
    let md = paper(1, 4);
    let mut text = String::from("## Lennard-Jones, σ̄⁶ = ½, ε̄ = 1\n\n");
    for (key, n, m) in [
        ("upscaling-n-1", 1, 4),
        ("upscaling-n-2", 2, 2),
        ("upscaling-n-4", 4, 1),
    ] {
        let c = compare(&md, &paper(n, m), 0.0);
        found.text(key, verdict(&c));
        let differ: Vec<String> = c
            .rows
            .iter()
            .map(|r| format!("order {}: {:.3}", r.order, r.relative))
            .collect();
        text += &format!(
            "MD with N = 4 and PD with Δx = {n} a, M = {m}: {}; largest relative differences of coefficients: {}\n\n",
            verdict(&c),
            differ.join(", ")
        );
    }
    text
}

/// The exact dispersion of (4.3), against its integral, its series and finite chains.
fn dispersion(context: &Context, found: &mut Findings) -> Result<(), Failure> {
    let horizon = 5.0;
    let exact = SpringContinuum {
        k1: 1.0,
        density: 1.0,
        horizon,
    };
    // ω² = ∫₀^δ 2c (1 − cos kε)/(ρε) dε by Simpson's rule
    let integral = |k: f64| {
        let n = 4000;
        let f = |e: f64| match e {
            0.0 => 0.0,
            e => 4.0 / horizon.powi(2) * 2.0 * (0.5 * k * e).sin().powi(2) / e,
        };
        let h = horizon / f64::from(n);
        let sum: f64 = (0..n)
            .map(|i| {
                let e = h * f64::from(i);
                h / 6.0 * (f(e) + 4.0 * f(e + 0.5 * h) + f(e + h))
            })
            .sum();
        sum.sqrt()
    };
    let waves = [0.05, 0.3, 1.0, 3.0];
    let off = waves.map(|k| (exact.frequency(k) / integral(k) - 1.0).abs());
    found.number("dispersion-integral", largest(off));
    let series = |x: f64| x * (1.0 - x * x / 48.0 + 17.0 / 69120.0 * x.powi(4)) / horizon;
    // what the series leaves is of order (kδ)⁷
    let rest = |x: f64| (exact.frequency(x / horizon) - series(x)).abs();
    found.number("4.9-order", (rest(0.8) / rest(0.4)).log2());
    let chain = |n: usize| LinearChain::springs(1.0, horizon / n as f64, n);
    let apart = |n: usize| {
        let ratio = waves
            .map(|k| chain(n).frequency(k, 1.0).unwrap_or(f64::NAN) / exact.frequency(k) - 1.0);
        largest(ratio.map(f64::abs))
    };
    found.holds(
        "dispersion-converges",
        format!("largest relative difference for k ≤ 3: {:.2e} (N = 10), {:.2e} (N = 20), {:.2e} (N = 500)", apart(10), apart(20), apart(500)),
        (1.8..2.6).contains(&(apart(250) / apart(500))),
    );
    let one = cin(1.0);
    found.number("cin", one);

    let k: Vec<f64> = (1..=400).map(|i| 0.01 * f64::from(i)).collect();
    let of = |n: usize, spacing: f64| -> Vec<f64> {
        let chain = LinearChain::springs(1.0, spacing, n);
        let edge = std::f64::consts::PI / spacing;
        k.iter()
            .map(|k| match chain.frequency(*k, 1.0) {
                Some(w) if *k <= edge => w,
                _ => f64::NAN,
            })
            .collect()
    };
    let columns = [
        (
            "PD, exact: √(4 Cin(kδ))/δ",
            k.iter().map(|k| exact.frequency(*k)).collect(),
        ),
        ("MD: Δx = 0.25, N = 20", of(20, 0.25)),
        ("coarse PD: Δx = 0.5, N = 10", of(10, 0.5)),
        ("N = 1, Δx = 0.25", of(1, 0.25)),
        ("CCM: ω = k", k.clone()),
        (
            "(4.9)",
            k.iter()
                .map(|k| {
                    if *k < 0.7 {
                        series(k * horizon)
                    } else {
                        f64::NAN
                    }
                })
                .collect::<Vec<f64>>(),
        ),
    ];
    let mut plot = Plot::new("Dispersion of springs with δ = 5")
        .x("k", "")
        .y("ω", "")
        .y_range(0.0, 1.6);
    let mut table = Table::new().column("k", "", k.clone());
    for (label, omega) in columns {
        plot = match label {
            "(4.9)" | "coarse PD: Δx = 0.5, N = 10" => plot.dashed(label, &k, &omega),
            _ => plot.line(label, &k, &omega),
        };
        table = table.column(label, "", omega);
    }
    found.picture(plot.save(&context.out, "dispersion")?);
    let path = context.out.join("dispersion.csv");
    table.save(&path)?;
    found.file(path);
    Ok(())
}

/// The gradient equations as the program derives them.
fn derived() -> String {
    let mut text = String::from("# Derived equations\n\n## Springs\n\n");
    let list = |c: &[Q]| -> String {
        let terms = c
            .iter()
            .enumerate()
            .map(|(p, c)| format!("{c} L^{} y({})", 2 * p, 2 * p + 2));
        terms.collect::<Vec<_>>().join(" + ")
    };
    let c = springs_continuum(q(1, 1), q(1, 1), 6);
    text += &format!("(4.2), (4.4), L = δ: ρ ÿ/K1 = {} + …\n\n", list(&c));
    let c = LinearChain::springs(q(1, 1), q(1, 1), 1).coefficients(6);
    text += &format!("(4.6), L = a: ρ ÿ/K1 = {} + …\n\n", list(&c));
    let c = LinearChain::springs(q(1, 1), q(1, 20), 20).coefficients(6);
    text += &format!("N = 20 as it is, L = Na: ρ ÿ/K1 = {} + …\n\n", list(&c));
    text += "## One power of (5.2): force density of ϕ = r^-n, by orders\n\n";
    for n in [12, 6] {
        for (p, order) in orders::<Q>(n, 4).iter().enumerate() {
            text += &format!("n = {n}, order {}: {order}\n\n", 2 * p + 2);
        }
    }
    text
}
