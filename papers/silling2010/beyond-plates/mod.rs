//! Plates: a fibre composite across its fibres, a random medium, a hole, a crack; coarsened 3 and 9 times.

use peridyne::spec::LinearBody;
use peridyne_io::write::plot::{ColorMap, Map};
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::lattice::LatticeBlock;
use peridyne_theory::coarsen::{Options, Radius, Scheme};

use crate::silling2010::compare::{Levels, Pulled, costs};
use crate::{Context, Failure, Findings};

experiment!(
    BeyondPlates,
    "beyond-plates",
    "Plates coarsened 3 and 9 times",
    ["../compare.rs"]
);

const STRAIN: f64 = 0.01;
/// Longest bond, in steps.
const REACH: f64 = 3.0;

/// A square plate of `side` + 1 points along each side.
struct Plate {
    side: i64,
}

impl Plate {
    fn body(
        &self,
        present: impl Fn([i64; 2]) -> bool,
        stiff: impl Fn([i64; 2], [i64; 2]) -> f64,
    ) -> LinearBody<2> {
        let n = self.side as usize + 1;
        LatticeBlock::new([n, n], 1.0, REACH).body(present, |i, n| {
            let j = [i[0] + n[0], i[1] + n[1]];
            stiff(i, j) / ((n[0] * n[0] + n[1] * n[1]) as f64).sqrt()
        })
    }

    /// Four times the square of the distance from the middle.
    fn off_middle(&self, [x, y]: [i64; 2]) -> i64 {
        (2 * x - self.side).pow(2) + (2 * y - self.side).pow(2)
    }

    /// Round fibres of radius 4, 12 apart, ten times as stiff.
    fn fibres(&self) -> LinearBody<2> {
        let in_fibre = |[x, y]: [i64; 2]| {
            let off = |x: i64| (x - 6).rem_euclid(12).min((6 - x).rem_euclid(12));
            off(x).pow(2) + off(y).pow(2) <= 16
        };
        self.body(
            |_| true,
            |i, j| {
                if in_fibre(i) && in_fibre(j) {
                    10.0
                } else {
                    1.0
                }
            },
        )
    }

    /// Squares of 3 by 3 points, every other one at random ten times as stiff.
    fn random(&self) -> LinearBody<2> {
        let hard = |[x, y]: [i64; 2]| {
            // bits of a multiplicative hash
            let h =
                ((x / 3 * 7919 + y / 3 * 104_729 + 1) as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            (h >> 40).is_multiple_of(2)
        };
        self.body(|_| true, |i, j| if hard(i) && hard(j) { 10.0 } else { 1.0 })
    }

    /// A round hole of a sixth of the width, between the points that are retained last.
    fn hole(&self) -> LinearBody<2> {
        let radius = self.side / 13;
        self.body(|i| self.off_middle(i) > (2 * radius).pow(2), |_, _| 1.0)
    }

    /// Bonds across a segment in the middle, a third of the width long, are cut.
    fn crack(&self) -> LinearBody<2> {
        let (low, high) = (self.side / 3, 2 * self.side / 3);
        let cut = |i: [i64; 2], j: [i64; 2]| {
            // 2 x − side changes its sign; there y (j − i)_x is
            let (a, b) = (2 * i[0] - self.side, 2 * j[0] - self.side);
            let width = b - a;
            let y = i[1] * width - a * (j[1] - i[1]);
            let (y, width) = (y * width.signum(), width.abs());
            a.signum() * b.signum() < 0 && (low * width..=high * width).contains(&y)
        };
        self.body(|_| true, |i, j| if cut(i, j) { 0.0 } else { 1.0 })
    }
}

/// Displacement along x beyond that of a homogeneous plate, at the points of a level.
fn map(levels: &Levels<2>, pulled: &Pulled<2>, m: usize, title: &str) -> Map {
    let x = &levels.body[m].position;
    let excess = |m: usize| -> Vec<f64> {
        let u = pulled.u[m].iter().zip(&levels.body[m].position);
        u.map(|(u, x)| u[0] - STRAIN * x[0]).collect()
    };
    let bound = excess(0).iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let step = 3f64.powi(m as i32);
    let side = x.iter().fold(0.0f64, |m, x| m.max(x[0])) + 0.5 * step;
    Map::new(title)
        .x("x", "", [-0.5 * step, side])
        .y("y", "", [-0.5 * step, side])
        .value("u_x − ε x", "")
        .between(-bound, bound)
        .colors(ColorMap::Diverging)
        .equal()
        .points(x, &excess(m), step)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let plate = Plate {
        side: if context.small { 27 } else { 81 },
    };
    let options = Options {
        scheme: Scheme::Energy,
        radius: if context.small {
            Radius::Fixed(9.0)
        } else {
            Radius::Tolerance(0.003)
        },
        ..Options::default()
    };
    let mut rows: [Vec<f64>; 5] = Default::default();
    let mut names = vec![];
    for (key, body) in [
        ("fibres", plate.fibres()),
        ("random", plate.random()),
        ("hole", plate.hole()),
        ("crack", plate.crack()),
    ] {
        context.say(key);
        // the second level's bonds are longer than the small plate's fixed radius
        let times = if context.small { 1 } else { 2 };
        let levels = Levels::thirds(body, times, &options)?;
        let pulled = levels.pulled(STRAIN)?;
        let mut said = vec![];
        let mut close = true;
        for m in 0..=times {
            let title = format!("{key}, level {m}, {} points", levels.body[m].points());
            found.picture(
                map(&levels, &pulled, m, &title).save(&context.out, &format!("{key}-{m}"))?,
            );
            if m > 0 {
                let (error, report) = (levels.error(&pulled, m), &levels.report[m - 1]);
                said.push(format!(
                    "{}: {:.2} % (r = {:.1})",
                    3i32.pow(m as u32),
                    100.0 * error,
                    report.radius
                ));
                close &= error < 0.01 && report.soundness.rotation < 1e-10 && report.definite;
                for (row, value) in rows.iter_mut().zip([
                    m as f64,
                    levels.body[m].points() as f64,
                    report.radius,
                    report.range,
                    error,
                ]) {
                    row.push(value);
                }
                names.push(key);
            }
        }
        found.holds(
            key,
            format!(
                "largest difference of displacement, coarsened {}",
                said.join(", ")
            ),
            close,
        );
        if key == "fibres" {
            found.measured(
                "solution at each level (section 6: dense elimination L^(nM) times less; coarse bonds are many, so that a sparse solver gains less)",
                costs(&levels, &pulled),
                "",
            );
        }
    }
    let path = context.out.join("plates.csv");
    let mut table = Table::new().text("plate", names);
    for (name, row) in ["level", "points", "r", "range", "error"]
        .into_iter()
        .zip(rows)
    {
        table = table.column(name, "", row);
    }
    table.save(&path)?;
    found.file(path);
    Ok(found)
}
