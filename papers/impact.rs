//! The impact of Algorithm 7 of the guide to peridynamics in LAMMPS (sandia2010, chapter 3), row by row against LAMMPS: `verify/lammps/impact_*.csv`.

use std::collections::{HashMap, HashSet};

use peridyne::observe::{Column, Ledger, Snapshot, Values};
use peridyne_io::deck::UnitSystem;
use peridyne_io::write::picture::rigid::Placed;
use peridyne_io::write::picture::shown::About;
use peridyne_io::write::picture::{self, PictureOptions};
use peridyne_io::write::plot::{ColorMap, Map, Plot};
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::measure::largest;
use crate::{Context, Failure, Findings};

/// Volume of a particle (m³), by which LAMMPS's sums of densities are joules.
pub const VOLUME: f64 = 1.25e-10;

/// Until then counts are asked to be equal; later round-off has grown to bonds, here and in LAMMPS.
pub const EQUAL: u64 = 1000;

/// Step, broken directed bonds and kinetic energy (J).
pub type Row = [f64; 3];

/// LAMMPS's rows after the start up to a step, from a file of step, broken directed bonds, particles with one, pe, ke.
pub fn rows(csv: &str, last: u64) -> Vec<Row> {
    let numbers = csv
        .lines()
        .filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
    let row = |line: &str| {
        let row: Vec<f64> = line.split(',').filter_map(|x| x.parse().ok()).collect();
        [row[0], row[1], row[4] * VOLUME]
    };
    let all = numbers.map(row);
    all.filter(|r| r[0] > 0.0 && r[0] <= last as f64).collect()
}

pub fn ledger(bench: &mut Bench) -> Result<Ledger, Failure> {
    bench.sim.ledger().map_err(|e| Failure::new(e.to_string()))
}

/// Runs a deck to its end, and the claims `broken` and `energy` with their table and picture; `seen` looks at every step.
pub fn against_lammps(
    context: &Context,
    bench: &mut Bench,
    theirs: &[Row],
    found: &mut Findings,
    mut seen: impl FnMut(u64, &mut Bench, &mut Findings) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut ours: Vec<Row> = vec![];
    for n in 1..=bench.steps() {
        bench.step()?;
        seen(n, bench, found)?;
        if theirs.iter().any(|row| row[0] == n as f64) {
            if n % 100 == 0 {
                context.say(&format!("step {n}"));
            }
            ours.push([n as f64, bench.sim.broken() as f64, ledger(bench)?.kinetic]);
        }
    }
    let pairs = || ours.iter().zip(theirs);
    let early = pairs().filter(|(a, _)| a[0] <= EQUAL as f64);
    let (rows, unlike) = early.fold((0, 0), |(rows, unlike), (a, b)| {
        (rows + 1, unlike + usize::from(a[1] != b[1]))
    });
    found.holds(
        "broken",
        format!("{unlike} of {rows} rows differ"),
        unlike == 0 && ours.len() == theirs.len() && rows > 0,
    );
    if rows < ours.len() {
        let late = pairs().skip(rows).map(|(a, b)| (a[1] / b[1] - 1.0).abs());
        found.number("broken-after", largest(late));
    }
    found.number(
        "energy",
        largest(pairs().map(|(a, b)| (a[2] / b[2] - 1.0).abs())),
    );
    let last = ours.last().map_or(f64::NAN, |row| row[1]);
    found.measured("broken directed bonds at the end", last, "");
    let of = ledger(bench)?;
    found.measured("work of the sphere", of.work_rigid_bodies, "J");
    found.measured("kinetic energy of the pieces", of.kinetic, "J");
    found.measured("energy of the broken bonds", of.released, "J");
    found.measured("fragments", bench.sim.fragments() as f64, "");
    let column = |rows: &[Row], c: usize| rows.iter().map(|r| r[c]).collect::<Vec<f64>>();
    let micro = |rows: &[Row]| rows.iter().map(|r| 0.1 * r[0]).collect::<Vec<f64>>();
    let million = |rows: &[Row]| rows.iter().map(|r| 1e-6 * r[1]).collect::<Vec<f64>>();
    let plot = Plot::new("Broken bonds of the disk")
        .x("t", "µs")
        .y("directed bonds", "million")
        .points("LAMMPS", &micro(theirs), &million(theirs))
        .line("peridyne", &micro(&ours), &million(&ours));
    found.picture(plot.save(&context.out, "broken")?);
    let path = context.out.join("broken.csv");
    Table::new()
        .column("step", "", column(&ours, 0))
        .column("broken directed bonds", "", column(&ours, 1))
        .column("of LAMMPS", "", column(theirs, 1))
        .column("kinetic energy", "J", column(&ours, 2))
        .column("of LAMMPS", "J", column(theirs, 2))
        .save(&path)?;
    found.file(path);
    Ok(())
}

/// The points of a plane (`across`: its axis and place) as a body of two dimensions, which has the plane's axes.
fn layer(s: &Snapshot, across: (usize, f64), axes: [usize; 2]) -> Snapshot {
    let inside = |x: &[f64; 3]| (x[across.0] - across.1).abs() < 0.25 * s.spacing;
    let chosen: Vec<usize> = (0..s.reference.len())
        .filter(|i| inside(&s.reference[*i]))
        .collect();
    let flat = |x: &[f64; 3]| [x[axes[0]], x[axes[1]], 0.0];
    let vectors = |of: &[[f64; 3]]| chosen.iter().map(|i| flat(&of[*i])).collect();
    let columns = s.columns.iter().filter_map(|c| {
        let values = match &c.values {
            Values::Vectors(v) => Values::Vectors(vectors(v)),
            Values::Scalars(v) => Values::Scalars(chosen.iter().map(|i| v[*i]).collect()),
            Values::Counts(v) => Values::Counts(chosen.iter().map(|i| v[*i]).collect()),
            Values::Symmetric(_) | Values::Tensors(_) | Values::Integers(_) => return None,
        };
        Some(Column {
            declaration: c.declaration.clone(),
            values,
        })
    });
    Snapshot {
        dimension: 2,
        reference: vectors(&s.reference),
        columns: columns.collect(),
        bonds: None,
        ..*s
    }
}

/// Fig. 3.2 (a): the points of the plane z = 0 where they are now, coloured by damage, and the sphere.
pub fn cut(context: &Context, bench: &mut Bench, found: &mut Findings) -> Result<(), Failure> {
    let whole = bench.sim.snapshot(&["damage"], false);
    let shown = layer(&whole, (2, 0.0), [0, 1]);
    let spec = &bench.deck.spec;
    let bodies: Vec<Placed> = {
        spec.loading
            .rigid_bodies
            .iter()
            .zip(bench.sim.rigid_bodies())
    }
    .map(|(body, center)| Placed {
        center,
        ..Placed::at(body, 2, shown.time)
    })
    .collect();
    let options = PictureOptions {
        title: "Cut during the impact".into(),
        length_unit: "m".into(),
        time_unit: "s".into(),
        units: UnitSystem::Si,
        field: Some("damage".into()),
        range: Some([0.0, 1.0]),
        scale: Some(1.0),
        ..PictureOptions::default()
    };
    let path = context.out.join("a-cut.png");
    picture::write(&path, &shown, &bodies, &options, About::Fracture)?;
    found.file(path);
    Ok(())
}

/// The top layer, y = 0.
pub struct Top {
    /// x, z
    pub at: Vec<[f64; 2]>,
    pub damage: Vec<f64>,
    pub piece: Vec<u32>,
    spacing: f64,
}

impl Top {
    pub fn of(bench: &mut Bench) -> Result<Top, Failure> {
        let whole = bench.sim.snapshot(&["damage", "fragment"], false);
        let s = layer(&whole, (1, 0.0), [0, 2]);
        let (Some(damage), Some(Values::Counts(piece))) =
            (s.scalars("damage"), s.column("fragment").map(|c| &c.values))
        else {
            return Err(Failure::new("damage and fragments are columns of the body"));
        };
        Ok(Top {
            at: s.reference.iter().map(|x| [x[0], x[1]]).collect(),
            damage: damage.to_vec(),
            piece: piece.clone(),
            spacing: s.spacing,
        })
    }

    /// Particles whose damage is not that of all their images in the mirrors of the square lattice.
    pub fn unlike(&self) -> usize {
        let site = |x: &[f64; 2]| x.map(|x| (x / self.spacing).round() as i64);
        let places = self.at.iter().map(site);
        let damage: HashMap<[i64; 2], f64> = places.zip(self.damage.iter().copied()).collect();
        let unlike = damage.iter().filter(|([x, z], d)| {
            let images = [[-x, *z], [*x, -z], [*z, *x]];
            images.iter().any(|image| damage.get(image) != Some(d))
        });
        unlike.count()
    }

    pub fn pieces(&self) -> usize {
        self.piece.iter().collect::<HashSet<_>>().len()
    }

    /// Fig. 3.2 (b), (c): by fragment, and by damage from 0 to 100 %, where the particles were.
    pub fn draw(&self, context: &Context, found: &mut Findings) -> Result<(), Failure> {
        let reach = 0.5 * self.spacing + largest(self.at.iter().map(|x| x[0].abs()));
        let map = |title: &str, value: [&str; 2], end: f64, values: &[f64]| {
            Map::new(title)
                .x("x", "m", [-reach, reach])
                .y("z", "m", [-reach, reach])
                .value(value[0], value[1])
                .between(0.0, end)
                .colors(ColorMap::Sequential)
                .equal()
                .points(&self.at, values, self.spacing)
        };
        // numbers that follow each other get unlike colours by multiples of the golden ratio
        let colour = |piece: &u32| (f64::from(*piece) * 0.618_033_988_749_894_9).fract();
        let colours: Vec<f64> = self.piece.iter().map(colour).collect();
        let by_piece = map(
            "Top layer, a colour for each piece",
            ["piece", ""],
            1.0,
            &colours,
        );
        found.picture(by_piece.save(&context.out, "b-fragments")?);
        let percent: Vec<f64> = self.damage.iter().map(|d| 100.0 * d).collect();
        let by_damage = map("Top layer", ["broken bonds", "%"], 100.0, &percent);
        found.picture(by_damage.save(&context.out, "c-damage")?);
        Ok(())
    }
}
