//! The dynamics of a lattice as text.

use super::Found;
use peridyne_io::deck::Dim;
use peridyne_theory::voigt::{Stiffness, components};
use std::f64::consts::PI;
use std::fmt::Write;

pub fn text(found: &Found) -> String {
    let s = &found.dynamics;
    let units = found.deck.units;
    let write = |v: f64, d: Dim| units.write(v, d);
    let mut t = String::new();
    // writing to a String does not fail
    let _ = writeln!(
        t,
        "lattice   {} of {}, {} bonds per point, density {}",
        s.kind.name(),
        write(s.spacing, Dim::LENGTH),
        s.bonds,
        write(s.density, Dim::DENSITY)
    );
    let pressure = match s.pressure.abs() <= 1e-12 * s.stiffness.c[0][0].abs() {
        true => "without stress".to_string(),
        false => format!(
            "under a pressure of {} ({:.3} % of c11)",
            write(s.pressure, Dim::PRESSURE),
            100.0 * s.pressure / s.stiffness.c[0][0]
        ),
    };
    let _ = write!(t, "reference {pressure}");
    if let Some(r) = &s.reference {
        let _ = write!(t, ", energy per atom {}", write(r.energy, Dim::ENERGY));
    }
    if s.sites > 1 {
        t += &cell(found);
    }
    if found.deck.spec.loading.thermal.is_some() {
        t += "\n          the lattice at rest: without the deck's temperature";
    }
    t += "\n\nwaves along\n";
    for d in &s.directions {
        let speeds: Vec<String> = d
            .sound
            .iter()
            .map(|v| v.map_or("grows".into(), |v| write(v, Dim::VELOCITY)))
            .collect();
        let _ = writeln!(t, "  {}  long waves {}", d.name, speeds.join(", "));
        for part in [0.25, 0.5, 1.0] {
            let n = ((d.rows.len() as f64 * part) as usize).clamp(1, d.rows.len()) - 1;
            let row = &d.rows[n];
            let wavelength = 2.0 * PI / row.distance;
            let each: Vec<String> = row
                .branches
                .iter()
                .map(|b| match (b.phase, b.group) {
                    (Some(p), Some(g)) => format!(
                        "{} (group {})",
                        write(p, Dim::VELOCITY),
                        // standing waves move to round-off only
                        write(if g.abs() < 1e-9 * p { 0.0 } else { g }, Dim::VELOCITY)
                    ),
                    (Some(p), None) => write(p, Dim::VELOCITY),
                    _ => "grows".into(),
                })
                .collect();
            let _ = writeln!(
                t,
                "       wavelength {:.2} spacings: {}",
                wavelength / s.spacing,
                each.join(", ")
            );
        }
    }
    stability(&mut t, found);
    elastic(&mut t, found);
    gradients(&mut t, found);
    nonlinear(&mut t, found);
    t
}

/// What a cell with several sites is, and its waves in which these move against each other.
fn cell(found: &Found) -> String {
    let s = &found.dynamics;
    let at_rest = s.path.iter().find(|r| r.name == Some("Γ"));
    let mut optical: Vec<(f64, usize)> = vec![];
    for b in at_rest
        .iter()
        .flat_map(|r| r.branches.iter().skip(s.dimension))
    {
        match optical.last_mut() {
            Some((w, count)) if (b.signed() - *w).abs() <= 1e-9 * w.abs() => *count += 1,
            _ => optical.push((b.signed(), 1)),
        }
    }
    let each: Vec<String> = { optical.iter() }
        .map(|(w, count)| {
            let period = found.deck.units.write(2.0 * PI / w.abs(), Dim::TIME);
            let grows = if *w < 0.0 { ", growing" } else { "" };
            format!(
                "ω = {}, period {period}{grows} ({count})",
                found.deck.units.show(*w, Dim::FREQUENCY)
            )
        })
        .collect();
    format!(
        "\ncell      {} sites: {} acoustic and {} optical branches; optical waves without end: {}",
        s.sites,
        s.dimension,
        s.dimension * (s.sites - 1),
        each.join("; ")
    )
}

/// Components in units of 2π/a.
fn reduced(wave: &[f64], spacing: f64) -> String {
    let each: Vec<String> = wave
        .iter()
        // + 0.0: no negative zeros
        .map(|k| {
            format!(
                "{:.4}",
                (k * spacing / (2.0 * PI) * 1e4).round() / 1e4 + 0.0
            )
        })
        .collect();
    each.join(", ")
}

fn stability(t: &mut String, found: &Found) {
    let s = &found.dynamics;
    let time = |v: f64| found.deck.units.write(v, Dim::TIME);
    *t += "\nstability\n";
    if s.growing.is_empty() {
        *t += "  all waves of the zone oscillate\n";
    } else {
        let _ = writeln!(
            t,
            "  UNSTABLE: {:.2} % of all waves of the zone grow",
            100.0 * s.unstable_part
        );
        for g in &s.growing {
            let wave = reduced(&g.wave, s.spacing);
            let _ = writeln!(
                t,
                "    {} k = ({}) 2π/a, e-fold in {}",
                g.name.unwrap_or("worst:"),
                wave,
                time(1.0 / g.rate)
            );
        }
    }
    let wave = reduced(&s.largest_wave, s.spacing);
    let _ = writeln!(t, "  bound                 {}", time(s.bound));
    let _ = writeln!(
        t,
        "  sharp limit 2/ω_max   {}, at k = ({}) 2π/a",
        time(s.sharp),
        wave
    );
    if let Some(estimate) = found.estimate {
        let _ = writeln!(t, "  estimate of the run   {}", time(estimate));
    }
    let ratio = s.time_step / s.sharp;
    let _ = writeln!(
        t,
        "  step of the deck      {}, {:.4} of the sharp limit{}",
        time(s.time_step),
        ratio,
        if ratio > 1.0 { ": UNSTABLE" } else { "" }
    );
    if ratio <= 1.0 && ratio > 0.0 {
        // half of ω_max Δt
        let x = ratio;
        let _ = writeln!(
            t,
            "  its velocity Verlet raises the highest frequency by {:.3} %",
            100.0 * (libm::asin(x) / x - 1.0)
        );
    }
}

fn table(t: &mut String, name: &str, s: &Stiffness, pressure: &dyn Fn(f64) -> String) {
    let d = s.dimension;
    if d == 1 {
        let _ = writeln!(t, "  {name}: E = {}", pressure(s.c[0][0]));
        return;
    }
    match s.cubic(1e-9) {
        Some(c) => {
            // pair laws have none but for round-off
            let cauchy = match c.cauchy().abs() < 1e-12 * c.c11.abs() {
                true => 0.0,
                false => c.cauchy(),
            };
            let _ = writeln!(
                t,
                "  {name}: c11 = {}, c12 = {}, c44 = {}; bulk {}, Zener's ratio {:.6}, c12 − c44 = {}",
                pressure(c.c11),
                pressure(c.c12),
                pressure(c.c44),
                pressure(c.bulk(d)),
                c.zener(),
                pressure(cauchy)
            );
        }
        None => {
            let _ = writeln!(t, "  {name}:");
            for row in s.c.iter().take(components(d)) {
                let row: Vec<String> = row
                    .iter()
                    .take(components(d))
                    .map(|c| pressure(*c))
                    .collect();
                let _ = writeln!(t, "    {}", row.join("  "));
            }
        }
    }
}

fn elastic(t: &mut String, found: &Found) {
    let s = &found.dynamics;
    let pressure = |v: f64| found.deck.units.write(v, Dim::PRESSURE);
    *t += "\nelastic constants\n";
    let name = if s.relaxed {
        "lattice"
    } else {
        "lattice, sites held"
    };
    table(t, name, &s.stiffness, &pressure);
    let stressed = s.pressure.abs() > 1e-12 * s.stiffness.c[0][0].abs();
    if let (true, Some(b)) = (stressed, &s.stress_strain) {
        table(t, "stress against strain under this pressure", b, &pressure);
    }
    if let Some(c) = &s.continuum {
        table(t, "target continuum", c, &pressure);
        let (a, b) = (s.stiffness.c[0][0], c.c[0][0]);
        let _ = writeln!(t, "  lattice over continuum, c11: {:.6}", a / b);
    }
}

fn gradients(t: &mut String, found: &Found) {
    let s = &found.dynamics;
    if s.directions.iter().all(|d| d.gradients.is_empty()) {
        *t += "\nno gradient coefficients: the cell has several sites";
        return;
    }
    *t += "\ngradient coefficients of longitudinal waves, ρ ü = Σ c ∂ⁿu, as c/c₂ in powers of the spacing\n";
    for d in &s.directions {
        let c = d.longitudinal();
        let first = c.first().copied().unwrap_or(f64::NAN);
        let each: Vec<String> = c
            .iter()
            .enumerate()
            .map(|(p, c)| match p {
                0 => format!("∂²: {}", found.deck.units.write(*c, Dim::PRESSURE)),
                _ => {
                    let part = match s.fractions.get(p) {
                        Some(fraction) => fraction.to_string(),
                        None => format!("{:.8}", c / first / s.spacing.powi(2 * p as i32)),
                    };
                    format!("∂^{}: {part} a^{}", 2 * p + 2, 2 * p)
                }
            })
            .collect();
        let _ = writeln!(t, "  {}  {}", d.name, each.join(", "));
        if let Some(l) = d.length_scale() {
            let length = found.deck.units.write(l, Dim::LENGTH);
            let _ = writeln!(t, "       length scale √|c₄/c₂| = {length}");
        }
    }
}

/// Of a chain of atoms.
fn nonlinear(t: &mut String, found: &Found) {
    let s = &found.dynamics;
    if s.nonlinear.is_empty() {
        return;
    }
    *t += "\nnonlinear gradient equation, ρ ÿ = Σ c (y″, y‴, … at the stretch y′), as c/c₂ in powers of the spacing\n";
    let first = s.stiffness.c[0][0];
    for (stretch, equation) in &s.nonlinear {
        let orders = equation.orders.iter().enumerate().map(|(p, order)| {
            let unit = s.spacing.powi(2 * p as i32) * first;
            let terms: Vec<String> = order
                .terms()
                .map(|(m, c)| format!("{:.6} {m}", c / unit))
                .collect();
            let power = match p {
                0 => String::new(),
                p => format!("a^{} ", 2 * p),
            };
            format!("{power}({})", terms.join(" + "))
        });
        let orders: Vec<String> = orders.collect();
        let _ = writeln!(t, "  y′ = {stretch}: {}", orders.join(" + "));
    }
}
