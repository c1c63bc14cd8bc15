//! The findings as a table for people.

use super::advice::advice;
use super::{Findings, Material, directions, mean};
use peridyne::spec::{Criterion, LawSpec, Method, Moduli, PmbStiffness, Stepper};
use peridyne_io::deck::{Dim, UnitSystem, describe};
use peridyne_theory::patch_test::{Class, PatchTest, Place};
use peridyne_theory::voigt::components;
use std::fmt::Write;

const AXES: [&str; 3] = ["x", "y", "z"];
/// Width of the names of rows.
const NAME: usize = 18;

pub fn write(found: &Findings) -> String {
    let mut out = String::new();
    for line in describe(found.spec, found.units).lines() {
        // conditions of a script come and go with its fixes
        let fixes = found.script && line.starts_with("acting ");
        out.push_str(if fixes {
            "acting     the fixes of the script, not checked here"
        } else {
            line
        });
        out.push('\n');
    }
    for section in [
        points(found),
        families(found),
        stiffness(found),
        waves(found),
        fracture(found),
        cost(found),
        warnings(found),
    ] {
        if !section.is_empty() {
            out.push('\n');
            out.push_str(&section);
        }
    }
    out.trim_end().to_string()
}

fn row(out: &mut String, name: &str, value: impl std::fmt::Display) {
    // writing to a String cannot fail
    let _ = writeln!(out, "  {name:NAME$}{value}");
}

fn points(found: &Findings) -> String {
    let (info, units) = (found.sim.info(), found.units);
    let d = info.dimension;
    let mut out = String::from("Points and bonds\n");
    row(&mut out, "points", whole(info.points));
    let span = |a: usize| {
        format!(
            "{} {} to {}",
            AXES[a],
            units.write(found.low[a], Dim::LENGTH),
            units.write(found.high[a], Dim::LENGTH)
        )
    };
    let spans: Vec<String> = (0..d).map(span).collect();
    row(&mut out, "extent", spans.join(", "));
    row(
        &mut out,
        "volume, mass",
        format!(
            "{}, {}",
            units.write(info.volume, Dim::VOLUME),
            units.write(info.mass, Dim::MASS)
        ),
    );
    let atoms = found.spec.potential().is_some();
    row(
        &mut out,
        if atoms { "cut-off" } else { "horizon" },
        format!(
            "{} = {:.4} spacings of {}",
            units.write(info.horizon, Dim::LENGTH),
            info.horizon / info.spacing,
            units.write(info.spacing, Dim::LENGTH)
        ),
    );
    row(
        &mut out,
        "bonds",
        format!(
            "{} directed, as a {}",
            whole(info.directed_bonds),
            info.family_kind
        ),
    );
    let (least, mean, most) = info.family;
    row(
        &mut out,
        "family size",
        format!("{least} to {most}, mean {mean:.2}"),
    );
    for (n, (name, points)) in info.bodies.iter().enumerate() {
        let gaps = info.gaps.iter().filter_map(|g| {
            let other = match g.bodies {
                [a, b] if a == n => b,
                [a, b] if b == n => a,
                _ => return None,
            };
            let distance = units.write(g.distance, Dim::LENGTH);
            Some(format!("{distance} from {}", info.bodies[other].0))
        });
        let gaps: Vec<String> = gaps.collect();
        let near = match gaps.is_empty() {
            true => "no other within the horizon or the range of contact".to_string(),
            false => gaps.join(", "),
        };
        row(
            &mut out,
            "body",
            format!("{name}: {} points, {near}", whole(*points)),
        );
    }
    let near = match info.near_horizon {
        0 => "none".to_string(),
        n => format!("{} bonds within round-off of it", whole(n)),
    };
    if !atoms {
        row(&mut out, "near the horizon", near);
    }
    if info.cut > 0 {
        row(
            &mut out,
            "pre-cracks cut",
            format!("{} directed bonds", whole(info.cut)),
        );
    }
    out
}

/// Where points are, by the part of a full family that they have, as a histogram.
fn families(found: &Findings) -> String {
    let Some(patch) = &found.patch else {
        return String::new();
    };
    let d = found.sim.info().dimension;
    let total = found.sim.info().points.max(1) as f64;
    let mut out = String::from(
        "Families (a place is told by the part of a full family that a point has)\n  place             points   share  mean size  of a full one\n",
    );
    for place in Place::ALL {
        let classes: Vec<&Class> = patch.classes.iter().filter(|c| c.place == place).collect();
        let count: usize = classes.iter().map(|c| c.points).sum();
        if count == 0 {
            continue;
        }
        let mean = |value: fn(&Class) -> f64| {
            classes
                .iter()
                .map(|c| value(c) * c.points as f64)
                .sum::<f64>()
                / count as f64
        };
        let share = count as f64 / total;
        let _ = writeln!(
            out,
            "  {:<12}{:>12}{:>6.1} %{:>11.1}{:>13.1} %  {}",
            place.name(d),
            whole(count as u64),
            100.0 * share,
            mean(|c| c.family),
            100.0 * mean(|c| c.part),
            "▇".repeat((30.0 * share).ceil() as usize)
        );
    }
    out
}

fn stiffness(found: &Findings) -> String {
    let Some(patch) = &found.patch else {
        return String::from(
            "Stiffness\n  not measured: a patch test of this body would take minutes; check a smaller body of the same lattice and horizon\n",
        );
    };
    let mut out = String::from(match found.spec.potential() {
        None => "Stiffness that this body really has, by place (patch test)\n",
        Some(_) => {
            "Stiffness of the state that the run starts from, stress against strain, all atoms carried along, by place\n"
        }
    });
    for (n, m) in found.materials.iter().enumerate() {
        material(&mut out, found, patch, n, m);
    }
    out
}

fn material(out: &mut String, found: &Findings, patch: &PatchTest, n: usize, m: &Material) {
    let d = found.sim.info().dimension;
    let units = found.units;
    let scale = Scale::of(found);
    if found.materials.len() > 1 {
        let _ = writeln!(out, "  {}", m.name);
    }
    let pressure = scale.unit;
    let in_unit = |name: &str| {
        if pressure.is_empty() {
            name.to_string()
        } else {
            format!("{name} [{pressure}]")
        }
    };
    let _ = if d == 1 {
        writeln!(out, "  {:<12}{:>20}", "", in_unit("E"))
    } else {
        writeln!(
            out,
            "  {:<12}{:>20}{:>20}{:>20}{:>18}{:>8}{:>8}",
            "",
            in_unit("E"),
            in_unit("K"),
            in_unit("G"),
            "ν",
            "Zener",
            "A^U"
        )
    };
    let line = |name: &str, real: Moduli, nominal: Option<Moduli>, more: &str| {
        let cell = |value: f64, nominal: Option<f64>, width: usize, scale: f64| {
            let percent = match nominal {
                // + 0.0 makes −0 and 0 one
                Some(a) if value.is_finite() && a.is_finite() && a != 0.0 => {
                    let tenths = (1000.0 * (value / a - 1.0)).round() + 0.0;
                    format!("{:+.1} %", 0.1 * tenths)
                }
                _ => String::new(),
            };
            format!("{:>w$}{percent:>10}", digits(value / scale), w = width - 10)
        };
        let mut text = format!("  {name:<12}");
        text += &cell(real.young, nominal.map(|a| a.young), 20, scale.factor);
        if d > 1 {
            text += &cell(real.bulk(), nominal.map(|a| a.bulk()), 20, scale.factor);
            text += &cell(real.shear(), nominal.map(|a| a.shear()), 20, scale.factor);
            text += &cell(real.poisson, nominal.map(|a| a.poisson), 18, 1.0);
        }
        (text + more).trim_end().to_string()
    };
    if let Some(nominal) = m.nominal {
        let _ = writeln!(out, "{}", line("asked", nominal, None, ""));
    }
    for class in patch.classes.iter().filter(|c| c.material == n) {
        let real = mean(found, &class.stiffness);
        let more = class.stiffness.anisotropy().map_or(String::new(), |a| {
            let universal = a.universal.map_or("–".into(), |u| format!("{u:.3}"));
            format!("{:>8.3}{universal:>8}", a.zener)
        });
        let text = line(class.place.name(d), real, m.nominal, &more);
        let _ = writeln!(out, "{text}");
    }
    let number = |value: f64| digits(value / scale.factor);
    for line in directions::lines(found, patch, n, m, &number) {
        let _ = writeln!(out, "{line}");
    }
    if let Some(class) = patch.best(n) {
        tensor(out, class, &scale);
    }
    if matches!(
        found.spec.materials[n].law,
        LawSpec::Pmb(PmbStiffness::Micromodulus(_))
    ) {
        let _ = writeln!(
            out,
            "  asked: what the micromodulus {} means in a full {}",
            units.write(
                found
                    .sim
                    .info()
                    .micromodulus
                    .get(n)
                    .copied()
                    .unwrap_or(f64::NAN),
                Dim::MICROMODULUS
            ),
            ["segment", "disk", "ball"][d - 1]
        );
    }
}

/// Stiffness in Voigt's notation.
fn tensor(out: &mut String, class: &Class, scale: &Scale) {
    let d = class.stiffness.dimension;
    if d == 1 {
        return;
    }
    let names: &[&str] = if d == 2 {
        &["xx", "yy", "xy"]
    } else {
        &["xx", "yy", "zz", "yz", "zx", "xy"]
    };
    let n = components(d);
    let _ = writeln!(
        out,
        "  C of the {}{}",
        class.place.name(d),
        if scale.unit.is_empty() {
            String::new()
        } else {
            format!(" [{}]", scale.unit)
        }
    );
    let _ = writeln!(
        out,
        "      {}",
        names.iter().map(|n| format!("{n:>10}")).collect::<String>()
    );
    // as many decimals as the largest entry has
    let largest = (0..n).map(|i| class.stiffness.c[i][i]).fold(0.0, f64::max);
    let whole = digits(largest / scale.factor);
    let decimals = whole.split_once('.').map_or(0, |(_, d)| d.len());
    for (i, name) in names.iter().enumerate() {
        let cells: String = (0..=i)
            .map(|j| {
                let c = class.stiffness.c[i][j];
                if c.abs() < 1e-6 * largest {
                    format!("{:>10}", "0")
                } else if whole.contains('e') {
                    format!("{:>10}", digits(c / scale.factor))
                } else {
                    format!("{:>10.decimals$}", c / scale.factor)
                }
            })
            .collect();
        let _ = writeln!(out, "  {name:>4}{cells}");
    }
}

fn waves(found: &Findings) -> String {
    let (info, units) = (found.sim.info(), found.units);
    let mut out = String::from("Waves and step\n");
    let long = (0..info.dimension)
        .map(|a| found.high[a] - found.low[a] + info.spacing)
        .fold(0.0, f64::max);
    for m in &found.materials {
        if !m.pressure_wave.is_finite() {
            continue;
        }
        let prefix = if found.materials.len() > 1 {
            format!("{}: ", m.name)
        } else {
            String::new()
        };
        let shear = m.shear_wave.map_or(String::new(), |c| {
            format!(", shear {}", units.write(c, Dim::VELOCITY))
        });
        let kind = if m.shear_wave.is_some() {
            "pressure "
        } else {
            ""
        };
        let speeds = units.write(m.pressure_wave, Dim::VELOCITY);
        row(
            &mut out,
            "wave speeds",
            format!("{prefix}{kind}{speeds}{shear}"),
        );
        let crossing = long / m.pressure_wave;
        let steps = match found.spec.schedule.statics() {
            Some(_) => String::new(),
            None => format!(
                " = {} steps",
                whole((crossing / info.time_step).ceil() as u64)
            ),
        };
        row(
            &mut out,
            "crossing",
            format!(
                "{prefix}{}{steps} through the longest side",
                units.write(crossing, Dim::TIME)
            ),
        );
    }
    if let Some(statics) = found.spec.schedule.statics() {
        let how = match statics.method {
            Method::Linear => "linear about the reference",
            Method::Newton => "by Newton's method",
            Method::Relaxation => "by relaxation, which finds its own step",
        };
        row(
            &mut out,
            "equilibrium",
            format!("{} increments of load, {how}", whole(found.steps)),
        );
        return out;
    }
    if let Stepper::Newmark(n) = found.spec.schedule.stepper {
        row(
            &mut out,
            "integrator",
            format!(
                "implicit, Newmark's method with beta = {}, gamma = {}",
                n.beta, n.gamma
            ),
        );
        let ratio = info.time_step / info.stable_step;
        row(
            &mut out,
            "time step",
            format!(
                "{}, {ratio:.3} times the limit {} of explicit steps",
                units.write(info.time_step, Dim::TIME),
                units.write(info.stable_step, Dim::TIME)
            ),
        );
        row(
            &mut out,
            "run",
            format!(
                "{} steps = {}",
                whole(found.steps),
                units.write(found.steps as f64 * info.time_step, Dim::TIME)
            ),
        );
        return out;
    }
    row(&mut out, "integrator", "velocity Verlet");
    row(
        &mut out,
        "time step",
        format!(
            "{}, {:.1} % of the stability limit {}{}",
            units.write(info.time_step, Dim::TIME),
            100.0 * info.time_step / info.stable_step,
            units.write(info.stable_step, Dim::TIME),
            if info.contact_step <= info.stable_step && info.contact_step.is_finite() {
                ", which contact sets"
            } else {
                ""
            }
        ),
    );
    row(
        &mut out,
        "run",
        format!(
            "{} steps = {}",
            whole(found.steps),
            units.write(found.steps as f64 * info.time_step, Dim::TIME)
        ),
    );
    out
}

fn fracture(found: &Findings) -> String {
    let units = found.units;
    let mut out = String::new();
    for (m, spec) in found.materials.iter().zip(&found.spec.materials) {
        let Some((s00, energy)) = m.fracture else {
            continue;
        };
        let prefix = if found.materials.len() > 1 {
            format!("{}: ", m.name)
        } else {
            String::new()
        };
        let energy = energy.map_or("no formula for this law".to_string(), |e| {
            units.write(e, Dim::FRACTURE_ENERGY)
        });
        let given = matches!(
            spec.fracture.map(|f| f.criterion),
            Some(Criterion::Energy(_))
        );
        let (a, b) = if given {
            ("from the energy", "asked")
        } else {
            ("asked", "from the stretch")
        };
        row(
            &mut out,
            "critical stretch",
            format!("{prefix}{:.4} % ({a})", 100.0 * s00),
        );
        row(
            &mut out,
            "fracture energy",
            format!("{prefix}{energy} ({b})"),
        );
    }
    if out.is_empty() {
        out
    } else {
        format!("Fracture\n{out}")
    }
}

fn cost(found: &Findings) -> String {
    let info = found.sim.info();
    let mut out = String::from("Cost\n");
    let bytes = info.bytes as f64;
    row(
        &mut out,
        "memory",
        format!(
            "{}, {:.0} bytes per point, {:.2} per bond",
            memory(bytes),
            bytes / info.points.max(1) as f64,
            bytes / info.directed_bonds.max(1) as f64
        ),
    );
    let Some(seconds) = found.trial.seconds_per_step else {
        return out;
    };
    row(
        &mut out,
        "speed",
        format!(
            "{} steps/s with {} threads of {} ({} trial steps), {:.2} ns per bond and step",
            digits(1.0 / seconds),
            found.threads,
            info.simd,
            found.trial.steps,
            1e9 * seconds / info.directed_bonds.max(1) as f64
        ),
    );
    row(
        &mut out,
        "time of the run",
        format!(
            "about {}, without writing",
            duration(seconds * found.steps as f64)
        ),
    );
    out
}

fn warnings(found: &Findings) -> String {
    let all = advice(found);
    if all.is_empty() {
        return "No warnings\n".into();
    }
    let mut out = format!("Warnings: {}\n", all.len());
    for a in all {
        let _ = writeln!(out, "  - {}", a.what);
        if let Some(fix) = a.fix {
            let _ = writeln!(out, "    {fix}");
        }
    }
    out
}

/// The unit in which pressures of a body are told.
struct Scale {
    factor: f64,
    unit: &'static str,
}

impl Scale {
    fn of(found: &Findings) -> Scale {
        let plain = Scale {
            factor: 1.0,
            unit: "",
        };
        match found.units {
            UnitSystem::Si => {
                let largest = found
                    .patch
                    .iter()
                    .flat_map(|p| &p.classes)
                    .map(|c| c.stiffness.c[0][0])
                    .fold(0.0, f64::max);
                let (factor, unit) = match largest {
                    p if p >= 1e9 => (1e9, "GPa"),
                    p if p >= 1e6 => (1e6, "MPa"),
                    p if p >= 1e3 => (1e3, "kPa"),
                    _ => (1.0, "Pa"),
                };
                Scale { factor, unit }
            }
            UnitSystem::Metal(_) => Scale {
                factor: 1.0 / 160.2176634,
                unit: "GPa",
            },
            UnitSystem::Lj | UnitSystem::None => plain,
        }
    }
}

/// A number in about five digits.
fn digits(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        "–".into()
    } else if value != 0.0 && !(1e-3..1e6).contains(&size) {
        format!("{value:.3e}")
    } else {
        let before = if size < 1.0 {
            1
        } else {
            size.log10().floor() as usize + 1
        };
        format!("{value:.*}", 5usize.saturating_sub(before))
    }
}

/// A count in groups of three.
fn whole(n: u64) -> String {
    let text = n.to_string();
    let mut out = String::new();
    for (i, c) in text.chars().enumerate() {
        if i > 0 && (text.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

fn memory(bytes: f64) -> String {
    match bytes {
        b if b >= 1e9 => format!("{:.2} GB", b / 1e9),
        b if b >= 1e6 => format!("{:.1} MB", b / 1e6),
        b => format!("{:.1} kB", b / 1e3),
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => format!("{:.0} ms", (1e3 * s).max(1.0)),
        s if s < 60.0 => format!("{s:.1} s"),
        s if s < 3600.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_readable() {
        assert_eq!(whole(12_345_678), "12,345,678");
        assert_eq!(whole(12), "12");
        assert_eq!(digits(14.9), "14.900");
        assert_eq!(digits(0.25), "0.2500");
        assert_eq!(digits(123456.7), "123457");
        assert_eq!(digits(f64::NAN), "–");
        assert_eq!(duration(90.0), "1.5 min");
    }
}
