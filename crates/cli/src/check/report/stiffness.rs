//! What the body resists with.

use crate::check::directions::percent;
use crate::check::{Findings, Material, directions, mean};
use crate::numbers::digits;
use peridyne::spec::{LawSpec, Moduli, PmbStiffness};
use peridyne_io::deck::{Dim, UnitSystem};
use peridyne_theory::patch_test::{PatchTest, Place};
use peridyne_theory::voigt::{Stiffness, components};
use std::fmt::Write;

pub(super) fn stiffness(found: &Findings) -> String {
    let Some(patch) = &found.patch else {
        return String::from(
            "Stiffness\n  not measured: a patch test of this body would take minutes; check a smaller body of the same lattice and horizon\n",
        );
    };
    let by_waves = patch.classes.iter().any(|c| c.long_waves);
    let mut out = String::from(match found.spec.potential() {
        None if by_waves => {
            "Effective moduli by long waves, as the bonds of this linear body are not invariant under rotation\n"
        }
        None => "Effective moduli of this body, by place (patch test)\n",
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
    let d = found.info.dimension;
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
                Some(a) if value.is_finite() && a.is_finite() && a != 0.0 => percent(value, a),
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
        let _ = writeln!(out, "{}", line("target", nominal, None, ""));
    }
    let mut without = vec![];
    for class in patch.classes.iter().filter(|c| c.material == n) {
        let Some(stiffness) = &class.stiffness else {
            without.push(class.place.name(d));
            continue;
        };
        let real = mean(found, stiffness);
        let more = stiffness.anisotropy().map_or(String::new(), |a| {
            let universal = a.universal.map_or("–".into(), |u| format!("{u:.3}"));
            format!("{:>8.3}{universal:>8}", a.zener)
        });
        let text = line(class.place.name(d), real, m.nominal, &more);
        let _ = writeln!(out, "{text}");
    }
    if !without.is_empty() {
        let _ = writeln!(
            out,
            "  none of their own, as long waves are of the bulk: {}",
            without.join(", ")
        );
    }
    let number = |value: f64| digits(value / scale.factor);
    for line in directions::lines(found, patch, n, m, &number) {
        let _ = writeln!(out, "{line}");
    }
    if let Some((class, stiffness)) = patch.best(n) {
        tensor(out, class.place, stiffness, &scale);
    }
    if matches!(
        found.spec.materials[n].law,
        LawSpec::Pmb(PmbStiffness::Micromodulus(_))
    ) {
        let _ = writeln!(
            out,
            "  target: what the micromodulus {} means in a full {}",
            units.show(
                found.info.micromodulus.get(n).copied().unwrap_or(f64::NAN),
                Dim::MICROMODULUS
            ),
            ["segment", "disk", "ball"][d - 1]
        );
    }
}

/// Stiffness in Voigt's notation.
fn tensor(out: &mut String, place: Place, stiffness: &Stiffness, scale: &Scale) {
    let d = stiffness.dimension;
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
        place.name(d),
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
    let largest = (0..n).map(|i| stiffness.c[i][i]).fold(0.0, f64::max);
    let whole = digits(largest / scale.factor);
    let decimals = whole.split_once('.').map_or(0, |(_, d)| d.len());
    for (i, name) in names.iter().enumerate() {
        let cells: String = (0..=i)
            .map(|j| {
                let c = stiffness.c[i][j];
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
                    .filter_map(|c| Some(c.stiffness.as_ref()?.c[0][0]))
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
