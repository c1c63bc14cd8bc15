//! `dispersion.csv`, its pictures, `velocities.csv`, `waves.json`.

use super::{Found, units};
use peridyne_io::write::WriteError;
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::lattice_dynamics::{Branch, Row};
use peridyne_theory::voigt::{Stiffness, components};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// `1/unit`, or nothing without units.
fn per(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!("1/{unit}")
    }
}

fn velocity([length, time]: [&str; 2]) -> String {
    if length.is_empty() {
        String::new()
    } else {
        format!("{length}/{time}")
    }
}

/// Columns of every branch.
fn branches(mut table: Table, rows: &[&Row], found: &Found) -> Table {
    let unit = units(found.deck.units);
    let count = rows.first().map_or(0, |r| r.branches.len());
    for b in 0..count {
        let column = |f: &dyn Fn(&Branch) -> f64| -> Vec<f64> {
            rows.iter().map(|r| f(&r.branches[b])).collect()
        };
        let name = |what: &str| format!("{what} {}", b + 1);
        table = table
            .column(&name("omega"), &per(unit[1]), column(&Branch::signed))
            .column(
                &name("omega of Verlet"),
                &per(unit[1]),
                column(&|b| b.verlet.unwrap_or(f64::NAN)),
            )
            .column(
                &name("phase velocity"),
                &velocity(unit),
                column(&|b| b.phase.unwrap_or(f64::NAN)),
            )
            .column(
                &name("group velocity"),
                &velocity(unit),
                column(&|b| b.group.unwrap_or(f64::NAN)),
            );
    }
    table
}

fn wave_columns(table: Table, rows: &[&Row], found: &Found) -> Table {
    let unit = per(units(found.deck.units)[0]);
    let axes = ["kx", "ky", "kz"].into_iter().enumerate();
    axes.take(found.dynamics.dimension)
        .fold(table, |t, (a, name)| {
            t.column(name, &unit, rows.iter().map(|r| r.wave[a]))
        })
}

/// Writes all into `dir`.
pub fn write(dir: &Path, found: &Found, json: &Value) -> Result<Vec<PathBuf>, WriteError> {
    let s = &found.dynamics;
    let unit = units(found.deck.units);
    create_directory(dir)?;
    let mut files = vec![
        dir.join("waves.json"),
        dir.join("dispersion.csv"),
        dir.join("velocities.csv"),
    ];
    write_file(&files[0], |w| Ok(serde_json::to_writer_pretty(w, json)?))?;
    let rows: Vec<&Row> = s.path.iter().collect();
    let table = Table::new()
        .column("path", &per(unit[0]), rows.iter().map(|r| r.distance))
        .text("point", rows.iter().map(|r| r.name.unwrap_or("")));
    branches(wave_columns(table, &rows, found), &rows, found).save(&files[1])?;
    let (names, rows): (Vec<&str>, Vec<&Row>) = s
        .directions
        .iter()
        .flat_map(|d| d.rows.iter().map(|r| (d.name.as_str(), r)))
        .unzip();
    let table = Table::new().text("direction", names).column(
        "k",
        &per(unit[0]),
        rows.iter().map(|r| r.distance),
    );
    branches(wave_columns(table, &rows, found), &rows, found).save(&files[2])?;
    files.extend(dispersion(found).save(dir, "dispersion")?);
    files.extend(velocities(found).save(dir, "velocities")?);
    Ok(files)
}

fn dispersion(found: &Found) -> Plot {
    let s = &found.dynamics;
    let unit = units(found.deck.units);
    let mut plot = Plot::new(format!("Dispersion, {} lattice", s.kind.name()))
        .x("along the path of the zone", &per(unit[0]))
        .y("ω (below 0: growth rate)", &per(unit[1]));
    let x: Vec<f64> = s.path.iter().map(|r| r.distance).collect();
    for r in &s.path {
        if let Some(name) = r.name {
            plot = plot.name_x(r.distance, name);
        }
    }
    let count = s.path.first().map_or(0, |r| r.branches.len());
    let each = |b: usize, f: &dyn Fn(&Branch) -> f64| -> Vec<f64> {
        s.path.iter().map(|r| f(&r.branches[b])).collect()
    };
    for b in 0..count {
        plot = plot.line(&format!("branch {}", b + 1), &x, &each(b, &Branch::signed));
    }
    for b in 0..count {
        let verlet = each(b, &|b| b.verlet.unwrap_or(f64::NAN));
        plot = plot.dashed(
            &format!("branch {}, with the deck's step", b + 1),
            &x,
            &verlet,
        );
    }
    plot
}

fn velocities(found: &Found) -> Plot {
    let s = &found.dynamics;
    let unit = units(found.deck.units);
    let mut plot = Plot::new("Velocities along symmetry directions: phase (solid), group (dashed)")
        .x("k", &per(unit[0]))
        .y("velocity", &velocity(unit));
    for d in &s.directions {
        let x: Vec<f64> = d.rows.iter().map(|r| r.distance).collect();
        let count = d.rows.first().map_or(0, |r| r.branches.len());
        // the fastest branch; the table has all
        let each = |f: &dyn Fn(&Branch) -> Option<f64>| -> Vec<f64> {
            d.rows
                .iter()
                .map(|r| f(&r.branches[count - 1]).unwrap_or(f64::NAN))
                .collect()
        };
        plot = plot
            .line(
                &format!("{}, branch {count}", d.name),
                &x,
                &each(&|b| b.phase),
            )
            .dashed("", &x, &each(&|b| b.group));
    }
    plot
}

fn stiffness(s: &Stiffness) -> Value {
    let n = components(s.dimension);
    let rows: Vec<&[f64]> = s.c.iter().take(n).map(|r| &r[..n]).collect();
    let cubic = s.cubic(1e-9).filter(|_| s.dimension > 1).map(|c| {
        json!({
            "c11": c.c11, "c12": c.c12, "c44": c.c44, "zener_ratio": c.zener(),
            "bulk": c.bulk(s.dimension), "c12_minus_c44": c.cauchy(),
        })
    });
    json!({ "C": rows, "cubic": cubic })
}

pub fn json(found: &Found) -> Value {
    let s = &found.dynamics;
    let [length, time] = units(found.deck.units);
    json!({
        "units": { "length": length, "time": time, "system": found.deck.units.name() },
        "dimension": s.dimension,
        "lattice": s.kind.name(),
        "spacing": s.spacing,
        "density": s.density,
        "bonds_per_point": s.bonds,
        "sites_per_cell": s.sites,
        "reference": {
            "pressure": s.pressure,
            "net_force_on_a_site": s.residual,
            "energy_per_atom": s.reference.map(|r| r.energy),
            "density_rho_h": s.reference.map(|r| r.density),
        },
        "special_points": s.path.iter().filter_map(|r| r.name.map(|name| json!({
            "name": name, "path": r.distance, "wave": &r.wave[..s.dimension],
            "omega": r.branches.iter().map(Branch::signed).collect::<Vec<_>>(),
            "omega_of_verlet": r.branches.iter().map(|b| b.verlet).collect::<Vec<_>>(),
        }))).collect::<Vec<_>>(),
        "directions": s.directions.iter().map(|d| json!({
            "name": d.name,
            "unit_vector": d.unit,
            "long_wave_speeds": d.sound,
            "gradient_coefficients": d.gradients,
            "longitudinal_gradient_coefficients": d.longitudinal(),
            "length_scale": d.length_scale(),
        })).collect::<Vec<_>>(),
        "gradient_fractions": s.fractions.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "nonlinear_gradient_equation": s.nonlinear.iter().map(|(stretch, equation)| json!({
            "stretch": stretch,
            "terms": equation.orders.iter().enumerate().flat_map(|(p, order)| {
                order.terms().map(move |(m, c)| json!({
                    "order": 2 * p + 2, "term": m.to_string(), "coefficient": c,
                }))
            }).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "stability": {
            "unstable_part": s.unstable_part,
            "growing_waves": s.growing.iter().map(|g| json!({
                "point": g.name, "wave": g.wave, "rate": g.rate,
            })).collect::<Vec<_>>(),
            "bound": s.bound,
            "largest_omega_squared": s.largest,
            "at_wave": s.largest_wave,
            "sharp_limit": s.sharp,
            "estimate_of_the_run": found.estimate,
            "time_step": s.time_step,
            "time_step_over_sharp_limit": s.time_step / s.sharp,
        },
        "elastic": {
            "sites_relaxed": s.relaxed,
            "lattice": stiffness(&s.stiffness),
            "stress_strain": s.stress_strain.as_ref().map(stiffness),
            "continuum": s.continuum.as_ref().map(stiffness),
            "asked": s.nominal.map(|m| json!({
                "young": m.young,
                "poisson": m.poisson.is_finite().then_some(m.poisson),
            })),
        },
    })
}
