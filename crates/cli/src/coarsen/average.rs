//! `peridyne coarsen --average`: level 0 of atoms at a temperature, from the frames of a run.

use super::arguments::CoarsenArguments;
use crate::failure::{Failure, note, say};
use peridyne::observe::{Values, temperature_of};
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::spec::LinearBody;
use peridyne_io::deck::{Deck, Dim, UnitSystem, rounded};
use peridyne_io::read::Atoms;
use peridyne_io::read::frames::Frames;
use peridyne_io::read::source::room;
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_theory::coarsen::thermal::{self, Elastic, Thermal, ThermalError, thermal};
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// Periods of frames and of the deck may differ by this part: digits of files.
const PERIOD: f64 = 1e-5;
/// Temperatures by velocities and by equipartition that differ by more are told of.
const APART: f64 = 0.1;
/// Bonds of the fit over the longest of the Hessian, so that round-off leaves none out.
const LEAST: f64 = 1.0 + 1e-4;
/// Motion couples atoms that the potential does not (papers/silling2010/beyond-temperature): bonds are so much longer where the box holds them, and constants are told of
/// bonds that are longer once more.
const LONGER: f64 = 1.25;
/// Part of a period that bonds may be long, and by how much longer ones must be longer to say something.
const MOST: f64 = 0.4999;
const MORE: f64 = 1.05;
/// Bytes that stand in memory for a number of a frame: displacement and force, and both centred.
const COPIES: f64 = 4.0 * 8.0;

/// A linear body at a temperature, and how far its atoms are from the sites of the deck.
pub(super) fn averaged<const D: usize>(
    arguments: &CoarsenArguments,
    deck: &Deck,
    sim: &mut dyn Simulation,
    sites: &LinearBody<D>,
    path: &Path,
    out: &Path,
) -> Result<(LinearBody<D>, Vec<Point>), Failure> {
    let began = Instant::now();
    let mut run = Run::new(deck, sim, sites, path)?;
    run.take_all(path, arguments.average_skip)?;
    let periods = sites.period.iter().flatten();
    let most = periods.fold(f64::INFINITY, |m, p| m.min(MOST * p));
    let least = LEAST * sites.range();
    let chosen = arguments.average_radius;
    let mut options = thermal::Options {
        radius: chosen.unwrap_or((LONGER * least).min(most).max(least)),
        symmetry: symmetry(arguments)?,
    };
    let n = run.displacement.len() as f64;
    let data = thermal::Frames {
        sites,
        kind: &run.kind,
        displacement: &run.displacement,
        force: &run.force,
        virial: Some(run.virial.map(|row| row.map(|w| w / n))),
    };
    let mut made = thermal(&data, &options);
    // of atoms with surroundings of their own there may be too many constants, or too few frames
    if let (Err(ThermalError::Few { .. } | ThermalError::Many { .. }), None) = (&made, chosen)
        && options.radius > least
    {
        options.radius = least;
        made = thermal(&data, &options);
    }
    let radius = options.radius;
    let made = made.map_err(|e| {
        let told = deck.units.tell(&e.message());
        Failure::input(format!("{}: {told}", path.display()))
    })?;
    let longer = (LONGER * radius).min(most);
    let beside = match made.elastic.is_ok() && longer > MORE * radius {
        // an opinion beside the fit: too few frames for it are no mistake
        true => thermal(
            &data,
            &thermal::Options {
                radius: longer,
                ..options
            },
        )
        .ok()
        .and_then(|t| t.elastic.ok())
        .map(|elastic| (longer, elastic)),
        false => None,
    };
    let measured = run.kinetic.map(|k| k / n);
    let temperature = Temperature {
        equipartition: made.temperature / deck.boltzmann(),
        velocities: measured.map(|k| {
            // the body does not drift
            temperature_of(k, D, sites.points() as u64, deck.boltzmann())
        }),
    };
    say(&told(
        &made,
        beside.as_ref(),
        temperature,
        radius,
        deck.units,
        began.elapsed().as_secs_f64(),
    ));
    if let Some(v) = temperature.velocities
        && (temperature.equipartition / v - 1.0).abs() > APART
    {
        note(&format!(
            "warning: the temperature is {} by velocities and {} by equipartition: is the run in equilibrium, long enough, and of this potential? Leave its beginning out (--average-skip)",
            shown(v, deck.units),
            shown(temperature.equipartition, deck.units),
        ));
    }
    create_directory(out).map_err(|e| Failure::Run(e.to_string()))?;
    let json =
        serde_json::to_string_pretty(&record(&made, beside.as_ref(), temperature, radius, path))
            .map_err(|e| Failure::Run(e.to_string()))?;
    write_file(&out.join("thermal.json"), |w| w.write_all(json.as_bytes()))
        .map_err(|e| Failure::Run(e.to_string()))?;
    let moved = made.moved.iter().map(pad).collect();
    // displacements are added to the sites where levels are made
    let body = LinearBody {
        position: sites.position.clone(),
        ..made.body
    };
    Ok((body, moved))
}

/// Are constants alike that the lattice makes alike?
fn symmetry(arguments: &CoarsenArguments) -> Result<bool, Failure> {
    match arguments.average_symmetry.as_str() {
        "lattice" => Ok(true),
        "none" => Ok(false),
        other => Err(Failure::input(format!(
            "--average-symmetry {other}: expected lattice or none"
        ))),
    }
}

fn pad<const D: usize>(x: &[f64; D]) -> Point {
    std::array::from_fn(|a| if a < D { x[a] } else { 0.0 })
}

#[derive(Clone, Copy)]
struct Temperature {
    equipartition: f64,
    velocities: Option<f64>,
}

/// The frames of a run, one after the other.
struct Run<'a, const D: usize> {
    deck: &'a Deck,
    sim: &'a mut dyn Simulation,
    sites: &'a LinearBody<D>,
    kind: Vec<u32>,
    /// Half of the shortest distance of sites: an atom that is further away is at another site.
    near: f64,
    /// Site of each atom of the file.
    site: Option<Vec<usize>>,
    drift: [f64; D],
    displacement: Vec<Vec<[f64; D]>>,
    force: Vec<Vec<[f64; D]>>,
    /// Sums over frames.
    virial: [[f64; D]; D],
    /// `None`: a frame has no velocities.
    kinetic: Option<f64>,
}

impl<'a, const D: usize> Run<'a, D> {
    fn new(
        deck: &'a Deck,
        sim: &'a mut dyn Simulation,
        sites: &'a LinearBody<D>,
        path: &Path,
    ) -> Result<Self, Failure> {
        let shortest = (0..sites.points()).flat_map(|i| {
            let (partners, _) = sites.row(i);
            partners.iter().map(move |j| sites.xi(i, *j as usize))
        });
        let shortest = shortest
            .map(|xi| xi.iter().map(|c| c * c).sum::<f64>())
            .fold(f64::INFINITY, f64::min)
            .sqrt();
        if !shortest.is_finite() {
            return Err(Failure::input(format!(
                "--average {}: no two atoms of {} are within the reach of its potential",
                path.display(),
                deck.file()
            )));
        }
        let kind = match sim.column("material").map(|c| c.values) {
            Some(Values::Counts(of)) => of,
            _ => vec![0; sites.points()],
        };
        Ok(Run {
            deck,
            sim,
            sites,
            kind,
            near: 0.5 * shortest,
            site: None,
            drift: [0.0; D],
            displacement: vec![],
            force: vec![],
            virial: [[0.0; D]; D],
            kinetic: Some(0.0),
        })
    }

    /// From a place to another, the nearest image.
    fn nearest(&self, x: [f64; D]) -> [f64; D] {
        std::array::from_fn(|a| match self.sites.period[a] {
            Some(p) => x[a] - p * (x[a] / p).round(),
            None => x[a],
        })
    }

    /// All frames of a file but the first so many.
    fn take_all(&mut self, path: &Path, skip: usize) -> Result<(), Failure> {
        let count = Frames::count(path).map_err(|e| Failure::input(e.to_string()))?;
        if count <= skip {
            return Err(Failure::input(format!(
                "--average-skip {skip}: {} has {count} frames",
                path.display()
            )));
        }
        let numbers = (count - skip) as f64 * (D * self.sites.points()) as f64;
        room("what is kept of the frames", COPIES * numbers)
            .map_err(|e| Failure::input(format!("{}: {e}: give fewer frames", path.display())))?;
        let mut frames = Frames::open(path).map_err(|e| Failure::input(e.to_string()))?;
        let mut index = 0;
        while let Some(atoms) = frames
            .next_frame()
            .map_err(|e| Failure::input(e.to_string()))?
        {
            if index >= skip {
                let wrong =
                    |m: String| Failure::input(format!("{}: frame {index}: {m}", path.display()));
                self.take(&atoms).map_err(wrong)?;
            }
            index += 1;
        }
        Ok(())
    }

    fn take(&mut self, atoms: &Atoms) -> Result<(), String> {
        self.same_box(atoms)?;
        let n = self.sites.points();
        let place = |k: usize| -> [f64; D] { std::array::from_fn(|a| atoms.position[k][a]) };
        let site = match self.site.take() {
            Some(site) => site,
            None => self.match_sites(&place)?,
        };
        let mut u = vec![[0.0; D]; n];
        for (k, i) in site.iter().enumerate() {
            let (x, at) = (place(k), self.sites.position[*i]);
            let from = std::array::from_fn(|a| x[a] - at[a] - self.drift[a]);
            u[*i] = self.nearest(from);
        }
        let mut mean = [0.0; D];
        for u in &u {
            (0..D).for_each(|a| mean[a] += u[a] / n as f64);
        }
        for u in &mut u {
            (0..D).for_each(|a| u[a] -= mean[a]);
        }
        (0..D).for_each(|a| self.drift[a] += mean[a]);
        let away = |i: &usize| u[*i].iter().map(|c| c * c).sum::<f64>() > self.near * self.near;
        if let Some(i) = (0..n).find(away) {
            let k = site.iter().position(|s| *s == i).unwrap_or(i);
            return Err(format!(
                "atom {} has left its site: it is nearer to others, and a linear body is of atoms that stay; give frames of a solid{}",
                k + 1,
                if self.displacement.is_empty() {
                    ", and the deck that they are of"
                } else {
                    " below its melting point, before atoms diffuse"
                }
            ));
        }
        let padded: Vec<Point> = u.iter().map(pad).collect();
        let density = self.sim.forces_under(&padded);
        let force = density.iter().zip(&self.sites.volume);
        let force = force.map(|(f, v)| std::array::from_fn(|a| f[a] * v));
        self.force.push(force.collect());
        self.sim.set_displacements(&padded);
        let [xx, yy, zz, xy, xz, yz] = self.sim.virial();
        let all = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        for a in 0..D {
            (0..D).for_each(|b| self.virial[a][b] += all[a][b]);
        }
        self.kinetic = match (self.kinetic, &atoms.velocity) {
            (Some(sum), Some(v)) => Some(sum + self.kinetic_energy(&site, v, atoms.from_momenta)),
            _ => None,
        };
        self.displacement.push(u);
        self.site = Some(site);
        Ok(())
    }

    /// Without that of the body as a whole.
    fn kinetic_energy(&self, site: &[usize], velocity: &[[f64; 3]], from_momenta: bool) -> f64 {
        let factor = match from_momenta {
            true => self.deck.units.ase_velocity(),
            false => 1.0,
        };
        let (mut energy, mut momentum, mut all) = (0.0, [0.0; D], 0.0);
        for (i, v) in site.iter().zip(velocity) {
            let mass = self.sites.volume[*i] * self.sites.density[*i];
            all += mass;
            for a in 0..D {
                let v = factor * v[a];
                energy += 0.5 * mass * v * v;
                momentum[a] += mass * v;
            }
        }
        energy - momentum.iter().map(|p| p * p).sum::<f64>() / (2.0 * all)
    }

    /// Is the frame of the deck's atoms, box and units?
    fn same_box(&self, atoms: &Atoms) -> Result<(), String> {
        let n = self.sites.points();
        if atoms.len() != n {
            return Err(format!(
                "it has {} atoms, and {} has {n}: give the deck that the frames are of",
                atoms.len(),
                self.deck.file()
            ));
        }
        let own = self.deck.units;
        if let Some(units) = { atoms.units.as_deref() }.filter(|units| *units != own.name())
            && own != UnitSystem::None
        {
            return Err(format!(
                "it says that it is in {units} units, and {} is in {}",
                self.deck.file(),
                own.name()
            ));
        }
        if atoms.edges.is_some() {
            return Err("its box is tilted, and those of decks are along the axes".into());
        }
        for (a, axis) in ["x", "y", "z"].into_iter().enumerate().take(D) {
            let length = atoms.high[a] - atoms.low[a];
            match self.sites.period[a] {
                Some(p) if (length / p - 1.0).abs() > PERIOD => {
                    let show = |x| own.show(x, Dim::LENGTH);
                    return Err(format!(
                        "its box is {} long along {axis}, and the period of {} is {}: give the deck the lattice spacing of the run",
                        show(length),
                        self.deck.file(),
                        show(p)
                    ));
                }
                Some(_) | None => {}
            }
        }
        Ok(())
    }

    /// The site of every atom: that of its place in the file if they go by order, else the nearest.
    fn match_sites(&self, place: &dyn Fn(usize) -> [f64; D]) -> Result<Vec<usize>, String> {
        let n = self.sites.points();
        let away = |k: usize, i: usize| -> f64 {
            let (x, at) = (place(k), self.sites.position[i]);
            let from = self.nearest(std::array::from_fn(|a| x[a] - at[a]));
            from.iter().map(|c| c * c).sum()
        };
        let near = self.near * self.near;
        if (0..n).all(|k| away(k, k) < near) {
            return Ok((0..n).collect());
        }
        let mut taken = vec![false; n];
        let mut site = vec![];
        for k in 0..n {
            let found = (0..n).find(|i| away(k, *i) < near);
            match found {
                Some(i) if !taken[i] => {
                    taken[i] = true;
                    site.push(i);
                }
                _ => {
                    return Err(format!(
                        "atom {} is at no site of {}, or at that of another atom: give the deck of this crystal, at the same place, and frames of a solid",
                        k + 1,
                        self.deck.file()
                    ));
                }
            }
        }
        Ok(site)
    }
}

fn shown(temperature: f64, units: UnitSystem) -> String {
    units.show(temperature, Dim::TEMPERATURE)
}

fn told<const D: usize>(
    made: &Thermal<D>,
    beside: Option<&(f64, Elastic)>,
    temperature: Temperature,
    radius: f64,
    units: UnitSystem,
    seconds: f64,
) -> String {
    let mut lines = vec![format!(
        "thermal force states of {} frames: {} constants of bonds up to {}{}, {seconds:.2} s",
        made.frames,
        made.constants,
        units.show(radius, Dim::LENGTH),
        match (made.symmetries, made.classes) {
            (g, 1) if g > 1 => format!(", alike under {g} rotations and reflections"),
            (_, 1) => String::new(),
            (_, classes) => format!(", {classes} kinds of surroundings"),
        },
    )];
    let by = shown(temperature.equipartition, units);
    lines.push(match temperature.velocities {
        Some(v) => format!(
            "  temperature {} by velocities, {by} by equipartition of forces and displacements",
            shown(v, units)
        ),
        None => format!(
            "  temperature {by} by equipartition of forces and displacements; the frames have no velocities"
        ),
    });
    lines.push(format!(
        "  forces that displacements do not explain: {} % (root mean squares)",
        rounded(100.0 * made.residual, 3)
    ));
    match &made.elastic {
        Ok(elastic) => {
            let all = constants(elastic, units);
            lines.push(format!(
                "  isothermal elastic constants, stress against strain: {all}"
            ));
            if let Some((longer, elastic)) = beside {
                let longer = units.show(*longer, Dim::LENGTH);
                let all = constants(elastic, units);
                lines.push(format!("  with bonds up to {longer}: {all}"));
            }
            if let Some(stress) = &elastic.stress {
                let pressure = -stress[..D].iter().sum::<f64>() / D as f64;
                let pressure = units.show(pressure, Dim::PRESSURE);
                lines.push(format!("  mean pressure {pressure}"));
            }
        }
        Err(why) => lines.push(format!("  no elastic constants: {why}")),
    }
    lines.join("\n")
}

fn constants(elastic: &Elastic, units: UnitSystem) -> String {
    let c = &elastic.stiffness.c;
    let d = elastic.stiffness.dimension;
    let show = |name: &str, x: f64, v: usize, w: usize| {
        let error = elastic.error.map(|e| rounded(e[v][w] / x.abs() * 100.0, 2));
        let error = error.map_or(String::new(), |e| format!(" ± {e} %"));
        format!("{name} = {}{error}", units.show(x, Dim::PRESSURE))
    };
    let shear = if d == 3 { "C44" } else { "C66" };
    let all = match (elastic.cubic, d) {
        (Some(cubic), _) => vec![
            show("C11", cubic.c11, 0, 0),
            show("C12", cubic.c12, 0, 1),
            show(shear, cubic.c44, d, d),
        ],
        (None, 1) => vec![show("C11", c[0][0], 0, 0)],
        (None, 2) => vec![
            show("C11", c[0][0], 0, 0),
            show("C22", c[1][1], 1, 1),
            show("C12", c[0][1], 0, 1),
            show("C66", c[2][2], 2, 2),
        ],
        (None, _) => (0..6)
            .map(|v| show(&format!("C{0}{0}", v + 1), c[v][v], v, v))
            .chain([show("C12", c[0][1], 0, 1), show("C13", c[0][2], 0, 2)])
            .chain([show("C23", c[1][2], 1, 2)])
            .collect(),
    };
    all.join(", ")
}

fn record<const D: usize>(
    made: &Thermal<D>,
    beside: Option<&(f64, Elastic)>,
    temperature: Temperature,
    radius: f64,
    path: &Path,
) -> serde_json::Value {
    let rows = |c: &[[f64; 6]; 6]| -> Vec<Vec<f64>> {
        let n = D * (D + 1) / 2;
        c[..n].iter().map(|row| row[..n].to_vec()).collect()
    };
    let told = |e: &Elastic| {
        let cubic = e.cubic;
        serde_json::json!({
            "voigt": rows(&e.stiffness.c),
            "standard_error": e.error.as_ref().map(rows),
            "cubic": cubic.map(|c| serde_json::json!({ "c11": c.c11, "c12": c.c12, "c44": c.c44 })),
            "stress": e.stress,
        })
    };
    let elastic = match &made.elastic {
        Ok(e) => told(e),
        Err(why) => serde_json::json!({ "unknown": why }),
    };
    serde_json::json!({
        "of": path.display().to_string(),
        "frames": made.frames,
        "radius": radius,
        "constants": made.constants,
        "kinds_of_surroundings": made.classes,
        "symmetries": made.symmetries,
        "temperature_by_velocities": temperature.velocities,
        "temperature_by_equipartition": temperature.equipartition,
        "unexplained_force": made.residual,
        "elastic_constants": elastic,
        "longer_bonds": beside.map(|(longer, e)| serde_json::json!({ "radius": longer, "elastic_constants": told(e) })),
    })
}
