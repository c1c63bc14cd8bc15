//! Figs. 2 and 4: seven points, δ = 3Δ, pulled at both ends.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;
use peridyne_theory::homogenize::bar::{Bar, Ends};

use super::{STRAIN, bar, kind};
use crate::{Context, Failure, Findings};

const M: usize = 3;
const POINTS: usize = 7;

/// The bar of the figure and what is found of it.
pub struct Pulled {
    /// Not homogenized, homogenized.
    pub bars: [Bar; 2],
    /// Displacements in metres of a bar of one metre.
    pub u: [Vec<f64>; 2],
    pub x: Vec<f64>,
}

impl Pulled {
    /// Solves, draws displacements and relative errors, and writes their table.
    pub fn new(context: &Context, ends: Ends, found: &mut Findings) -> Result<Pulled, Failure> {
        let spacing = 1.0 / (POINTS - 1) as f64;
        let x: Vec<f64> = (0..POINTS).map(|i| i as f64 * spacing - 0.5).collect();
        let bars = [bar(M, POINTS, ends, false)?, bar(M, POINTS, ends, true)?];
        let u = bars.map(|b| {
            let u = b.displacements::<f64>();
            u.iter().map(|u| u * spacing * STRAIN).collect::<Vec<f64>>()
        });
        let pulled = Pulled { bars, u, x };
        let weight = match ends {
            Ends::Full => "full",
            Ends::Half => "half",
        };
        let title = format!("δ = 3Δ, N = 7, {weight}-weight ends");
        let classical: Vec<f64> = pulled.x.iter().map(|x| x * STRAIN).collect();
        let scale = |u: &[f64]| u.iter().map(|u| u * 1e3).collect::<Vec<f64>>();
        // room for the legends above
        let top = 1e3 * pulled.u[0][POINTS - 1];
        let mut plot = Plot::new(&title)
            .x("x", "m")
            .y("displacement", "mm")
            .y_range(-1.1 * top, 1.8 * top)
            .line("classical", &pulled.x, &scale(&classical));
        let most = 150.0 * pulled.errors(0)[0];
        let mut errors = Plot::new(&title)
            .x("x", "m")
            .y("(u − u0)/u0", "%")
            .y_range(-0.3 * most, most);
        let mut table =
            Table::new()
                .column("x", "m", pulled.x.clone())
                .column("classical", "m", classical);
        for (k, mark) in [Mark::Disc, Mark::Square].into_iter().enumerate() {
            let label = kind(k == 1);
            plot = plot.series(label, &pulled.x, &scale(&pulled.u[k]), Stroke::Dashed, mark);
            let error = pulled.errors(k);
            let percent: Vec<f64> = error.iter().map(|e| 100.0 * e).collect();
            errors = errors.series(label, &pulled.x, &percent, Stroke::Dashed, mark);
            table = table.column(label, "m", pulled.u[k].clone()).column(
                &format!("error, {label}"),
                "",
                error,
            );
        }
        found.picture(plot.save(&context.out, "a-displacement")?);
        found.picture(errors.save(&context.out, "b-error")?);
        let path = context.out.join("displacements.csv");
        table.save(&path)?;
        found.file(path);
        Ok(pulled)
    }

    /// `(u − u0)/u0`; not a number in the middle, which does not move.
    pub fn errors(&self, k: usize) -> Vec<f64> {
        let pairs = self.u[k].iter().zip(&self.x);
        let error = |(u, x): (&f64, &f64)| {
            if *x == 0.0 {
                f64::NAN
            } else {
                u / (STRAIN * x) - 1.0
            }
        };
        pairs.map(error).collect()
    }

    /// Largest distance of the homogenized bar's relative errors from a number.
    pub fn off(&self, expected: f64) -> f64 {
        let errors = self.errors(1);
        let off = errors.iter().filter(|e| !e.is_nan());
        off.fold(0.0, |w, e| w.max((e - expected).abs()))
    }

    /// Strains of the bar that is not homogenized over σ/E.
    pub fn strains(&self) -> Vec<f64> {
        self.bars[0].strains()
    }
}

/// A caption's α and β beside those that are right: what it leaves in the rows of the points next to the end.
pub fn caption(found: &mut Findings, ends: Ends, [alpha, beta]: [f64; 2]) -> Result<(), Failure> {
    let right: Vec<f64> = bar(M, POINTS, ends, true)?.factors();
    found.holds(
        "caption",
        format!(
            "solved for: {} between points 1 and 2, {} between 1 and 3",
            right[0], right[1]
        ),
        right == [beta, alpha],
    );
    Ok(())
}
