//! Sod's shock tube: a shock, a contact and a fan of a perfect gas beside the exact solution.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    ShockTube,
    "shock-tube",
    "Sod's shock tube",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck: ratio of heats; pressure and density on the left and on the right.
const HEATS: f64 = 1.4;
const LEFT: [f64; 2] = [1.0, 1.0];
const RIGHT: [f64; 2] = [0.1, 0.125];

/// The exact solution (Toro 2009, 4.3).
struct Sod {
    /// Of both sides of the contact: pressure and velocity.
    pressure: f64,
    velocity: f64,
    /// Density behind the contact, where the gas came through the fan, and before it, where it came through the shock.
    behind: f64,
    before: f64,
    /// Speed of the shock; of the fan's head and foot, to the left.
    shock: f64,
    head: f64,
    foot: f64,
}

impl Sod {
    fn new() -> Sod {
        let g = HEATS;
        let ([pl, rl], [pr, rr]) = (LEFT, RIGHT);
        let [al, ar] = [LEFT, RIGHT].map(|[p, r]| (g * p / r).sqrt());
        let fan = |p: f64| 2.0 * al / (g - 1.0) * ((p / pl).powf((g - 1.0) / (2.0 * g)) - 1.0);
        let shock = |p: f64| {
            let (a, b) = (2.0 / ((g + 1.0) * rr), (g - 1.0) / (g + 1.0) * pr);
            (p - pr) * (a / (p + b)).sqrt()
        };
        let (mut low, mut high) = (pr, pl);
        for _ in 0..200 {
            let p = 0.5 * (low + high);
            if fan(p) + shock(p) > 0.0 {
                high = p;
            } else {
                low = p;
            }
        }
        let p = 0.5 * (low + high);
        let u = 0.5 * (shock(p) - fan(p));
        let k = (g - 1.0) / (g + 1.0);
        Sod {
            pressure: p,
            velocity: u,
            behind: rl * (p / pl).powf(1.0 / g),
            before: rr * (p / pr + k) / (k * p / pr + 1.0),
            shock: ar * ((g + 1.0) / (2.0 * g) * p / pr + (g - 1.0) / (2.0 * g)).sqrt(),
            head: -al,
            foot: u - al * (p / pl).powf((g - 1.0) / (2.0 * g)),
        }
    }

    /// Velocity, pressure and density at x/t.
    fn at(&self, s: f64) -> [f64; 3] {
        let ([pl, rl], [pr, rr]) = (LEFT, RIGHT);
        if s > self.shock {
            [0.0, pr, rr]
        } else if s > self.velocity {
            [self.velocity, self.pressure, self.before]
        } else if s > self.foot {
            [self.velocity, self.pressure, self.behind]
        } else if s > self.head {
            let u = 2.0 / (HEATS + 1.0) * (s - self.head);
            let a = 1.0 + 0.5 * (HEATS - 1.0) * u / self.head;
            let p = pl * a.powf(2.0 * HEATS / (HEATS - 1.0));
            [u, p, rl * a.powf(2.0 / (HEATS - 1.0))]
        } else {
            [0.0, pl, rl]
        }
    }
}

/// A point of the first row: where it is, velocity, pressure with that of viscosity, density, and length of the tube that it stands for.
struct Gas {
    x: f64,
    values: [f64; 3],
    length: f64,
}

fn row(bench: &mut Bench) -> Result<Vec<Gas>, Failure> {
    let h = bench.sim.info().spacing;
    let (places, u) = (bench.places(), bench.values("displacement", 0)?);
    let v = bench.values("velocity", 0)?;
    let (p, q) = (
        bench.values("pressure", 0)?,
        bench.values("shock_pressure", 0)?,
    );
    let stretch = bench.values("volume_change", 0)?;
    let mut row: Vec<Gas> = (0..places.len())
        .filter(|n| places[*n][1] < h)
        .map(|n| {
            let j = 1.0 + stretch[n];
            let [_, density] = if places[n][0] < 0.0 { LEFT } else { RIGHT };
            Gas {
                x: places[n][0] + u[n],
                values: [v[n], p[n] + q[n], density / j],
                length: h * j,
            }
        })
        .collect();
    row.sort_by(|a, b| a.x.total_cmp(&b.x));
    Ok(row)
}

/// Where the pressure is half of that behind the shock and of that before it.
fn front(row: &[Gas], exact: &Sod) -> f64 {
    let half = 0.5 * (exact.pressure + RIGHT[0]);
    let Some(n) = row.iter().rposition(|g| g.values[1] > half) else {
        return f64::NAN;
    };
    let Some(next) = row.get(n + 1) else {
        return f64::NAN;
    };
    let part = (row[n].values[1] - half) / (row[n].values[1] - next.values[1]);
    row[n].x + part * (next.x - row[n].x)
}

/// The gas at the end, when that is, its mean errors, and the speed of the shock in the second half.
struct Tube {
    row: Vec<Gas>,
    time: f64,
    errors: [f64; 3],
    speed: f64,
}

fn tube(cells: u32, exact: &Sod) -> Result<Tube, Failure> {
    let mut bench = Bench::new(DECK, &[("constants.n", &cells.to_string())])?;
    let mut half = None;
    for _ in 0..bench.steps() {
        bench.step()?;
        let t = bench.sim.time();
        if half.is_none() && t >= 0.1 {
            half = Some([t, front(&row(&mut bench)?, exact)]);
        }
    }
    let (time, row) = (bench.sim.time(), row(&mut bench)?);
    let mut errors = [0.0; 3];
    for gas in &row {
        for (n, known) in exact.at(gas.x / time).into_iter().enumerate() {
            errors[n] += gas.length * (gas.values[n] - known).abs();
        }
    }
    let [t, x] = half.unwrap_or([f64::NAN; 2]);
    Ok(Tube {
        speed: (front(&row, exact) - x) / (time - t),
        row,
        time,
        errors,
    })
}

/// Mean of a value over the middle half of a stretch between two speeds.
fn plateau(tube: &Tube, value: usize, [from, to]: [f64; 2]) -> f64 {
    let quarter = 0.25 * (to - from);
    let inside = tube.row.iter().filter(|g| {
        let s = g.x / tube.time;
        s > from + quarter && s < to - quarter
    });
    let (sum, length) = inside.fold((0.0, 0.0), |(sum, length), g| {
        (sum + g.length * g.values[value], length + g.length)
    });
    sum / length
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let exact = Sod::new();
    let [few, many] = if context.small { [50, 100] } else { [200, 400] };
    let (coarse, fine) = (tube(few, &exact)?, tube(many, &exact)?);
    let names = ["velocity", "pressure", "density"];
    let mut least = f64::INFINITY;
    for (n, name) in names.into_iter().enumerate() {
        let order = (coarse.errors[n] / fine.errors[n]).log2();
        least = least.min(order);
        for (cells, tube) in [(few, &coarse), (many, &fine)] {
            let key = format!("mean error of {name}, {cells} spacings");
            found.measured(&key, tube.errors[n], "");
        }
        found.measured(&format!("order of {name}"), order, "");
    }
    found.number("order", least);
    let contact = exact.velocity;
    let told = [
        ("shock", fine.speed),
        ("pressure", plateau(&fine, 1, [exact.foot, exact.shock])),
        ("velocity", plateau(&fine, 0, [exact.foot, exact.shock])),
        ("before", plateau(&fine, 2, [contact, exact.shock])),
        ("behind", plateau(&fine, 2, [exact.foot, contact])),
    ];
    for (key, value) in told {
        match context.small {
            true => found.measured(key, value, ""),
            false => found.number(key, value),
        }
    }
    let column = |tube: &Tube, of: fn(&Gas) -> f64| tube.row.iter().map(of).collect::<Vec<_>>();
    let x = column(&fine, |g| g.x);
    let known: Vec<[f64; 3]> = x.iter().map(|x| exact.at(x / fine.time)).collect();
    let density: Vec<f64> = known.iter().map(|k| k[2]).collect();
    let plot = Plot::new("Sod's shock tube")
        .x("x", "")
        .y("density", "")
        .points(
            &format!("{few} spacings"),
            &column(&coarse, |g| g.x),
            &column(&coarse, |g| g.values[2]),
        )
        .line(
            &format!("{many} spacings"),
            &x,
            &column(&fine, |g| g.values[2]),
        )
        .dashed("exact", &x, &density);
    found.picture(plot.save(&context.out, "density")?);
    let mut table = Table::new().column("x", "", x);
    let of: [fn(&Gas) -> f64; 3] = [|g| g.values[0], |g| g.values[1], |g| g.values[2]];
    for (n, name) in names.into_iter().enumerate() {
        let closed: Vec<f64> = known.iter().map(|k| k[n]).collect();
        table = table.column(name, "", column(&fine, of[n])).column(
            &format!("{name}, exact"),
            "",
            closed,
        );
    }
    let path = context.out.join("tube.csv");
    table.save(&path)?;
    found.file(path);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rankine and Hugoniot at the shock; entropy and Riemann's invariant through the fan; p and u across the contact are one number each.
    #[test]
    fn mass_momentum_and_energy_go_through_the_shock_and_entropy_through_the_fan() {
        let exact = Sod::new();
        let enthalpy = |p: f64, r: f64| HEATS / (HEATS - 1.0) * p / r;
        let flux = |u: f64, p: f64, r: f64| {
            let w = exact.shock - u;
            [r * w, p + r * w * w, enthalpy(p, r) + 0.5 * w * w]
        };
        let before = flux(0.0, RIGHT[0], RIGHT[1]);
        let after = flux(exact.velocity, exact.pressure, exact.before);
        for (a, b) in before.into_iter().zip(after) {
            assert!((a / b - 1.0).abs() < 1e-12, "{before:?} {after:?}");
        }
        for s in [-1.1, -0.8, -0.5, -0.2, 0.3] {
            let [u, p, r] = exact.at(s);
            assert!((p / r.powf(HEATS) - 1.0).abs() < 1e-12);
            let sound = (HEATS * p / r).sqrt();
            assert!((u + 2.0 * sound / (HEATS - 1.0) + 5.0 * exact.head).abs() < 1e-12);
            // in the fan its own characteristic passes
            assert!(s > exact.foot || (u - sound - s).abs() < 1e-12);
        }
    }
}
