//! What a fit says: on the terminal, and in `calibrate.json`, `calibrate.csv` and a plot.

use super::{Calibrated, Evaluation, size, why};
use crate::numbers::whole;
use peridyne_io::deck::rounded;
use peridyne_io::write::WriteError;
use peridyne_io::write::atomic::write_file;
use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

const SOURCE: &str = "D. M. Bates and D. G. Watts, Nonlinear Regression Analysis and Its Applications (1988), sections 2.1 and 2.2";

impl Calibrated<'_> {
    /// Value, standard error and ends of the interval of 95 % of a key.
    fn of(&self, k: usize) -> (f64, Option<f64>, Option<[f64; 2]>) {
        let key = &self.keys[k];
        let value = key.real(self.fit.at[k]);
        let sure = self.sure.as_ref();
        let error = sure.and_then(|s| Some(s.errors[k]? * (key.high - key.low)));
        let half = sure.and_then(|s| Some(s.factor * error?));
        (value, error, half.map(|half| [value - half, value + half]))
    }

    /// The unit of residuals.
    fn unit(&self) -> &str {
        match self.curve.sigma {
            Some(_) => "",
            None => &self.curve.of[1].unit,
        }
    }
}

pub fn report(c: &Calibrated) -> String {
    let (residuals, unit) = (&c.fit.residuals, c.unit());
    let show = |x: f64| format!("{} {unit}", rounded(x, 4)).trim_end().to_string();
    let mut t = format!(
        "\n{} points, {} runs, {} steps",
        whole(residuals.len() as u64),
        c.fit.evaluations,
        c.fit.steps
    );
    for (k, key) in c.keys.iter().enumerate() {
        let (value, error, ends) = c.of(k);
        t += &format!("\n{} = {}", key.name, key.told(value));
        if let (Some(error), Some([low, high])) = (error, ends) {
            t += &format!(
                ", standard error {}, 95 % from {} to {}",
                key.told(rounded(error, 4).parse().unwrap_or(error)),
                rounded(low, 6),
                key.told(high)
            );
        }
    }
    t += &format!(
        "\nresidual  root mean square {}",
        show(size(residuals) / (residuals.len() as f64).sqrt())
    );
    if let Some(sure) = &c.sure {
        let (s, freedom) = (show(sure.deviation), sure.freedom);
        t += &format!(", s = {s} with {freedom} degrees of freedom");
        for (k, row) in sure.correlation.iter().enumerate() {
            for (j, r) in row[..k].iter().enumerate().filter(|(_, r)| r.is_finite()) {
                let [one, other] = [j, k].map(|k| &c.keys[k].name);
                t += &format!("\ncorrelation of {one} and {other}: {}", rounded(*r, 4));
            }
        }
    }
    for warning in &c.warnings {
        t += &format!("\nwarning: {warning}");
    }
    t + &format!("\nrun it:   {}", c.command)
}

fn name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into()
}

fn evaluated(evaluation: &Evaluation) -> Value {
    let values = evaluation
        .row
        .setting
        .iter()
        .map(|(_, value)| value.trim_matches('"'));
    json!({
        "folder": name(&evaluation.row.dir),
        "values": values.collect::<Vec<_>>(),
        "status": evaluation.row.status,
        "residual_norm": evaluation.norm.as_ref().ok(),
        "why": evaluation.norm.as_ref().err(),
    })
}

fn json(c: &Calibrated) -> Value {
    let arguments = c.arguments;
    let keys = c.keys.iter().enumerate().map(|(k, key)| {
        let (value, error, ends) = c.of(k);
        json!({
            "key": key.name,
            "unit": key.unit,
            "low": key.low,
            "high": key.high,
            "start": key.real(key.start),
            "value": value,
            "standard_error": error,
            "interval_95": ends,
            "at_bound": c.sure.as_ref().map(|s| s.held[k]),
        })
    });
    let sure = c.sure.as_ref();
    json!({
        "deck": arguments.study.input.file,
        "measured": arguments.curve.measured,
        "columns": { "x": arguments.curve.x, "y": arguments.curve.y, "sigma": arguments.curve.sigma },
        "points": c.fit.residuals.len(),
        "keys": keys.collect::<Vec<_>>(),
        "correlation": sure.map(|s| &s.correlation),
        "residual_norm": size(&c.fit.residuals),
        "residual_unit": c.unit(),
        "s": sure.map(|s| s.deviation),
        "degrees_of_freedom": sure.map(|s| s.freedom),
        "students_t": sure.map(|s| s.factor),
        "uncertainty": format!("s² (JᵀJ)⁻¹: {SOURCE}"),
        "runs": c.fit.evaluations,
        "steps": c.fit.steps,
        "converged": why(c.keys, &c.fit).is_none(),
        "warnings": c.warnings,
        "folder": name(&c.folder),
        "command": c.command,
        "evaluations": c.evaluations.iter().map(evaluated).collect::<Vec<_>>(),
    })
}

fn table(c: &Calibrated) -> Table {
    let all = &c.evaluations;
    let mut table = Table::new().text("folder", all.iter().map(|e| name(&e.row.dir)));
    for (k, key) in c.keys.iter().enumerate() {
        let number = |e: &Evaluation| {
            let value = crate::sweep::design::quantity(&e.row.setting[k].1);
            value.map_or(f64::NAN, |(number, _)| number)
        };
        table = table.column(&key.name, &key.unit, all.iter().map(number));
    }
    let norm = |e: &Evaluation| *e.norm.as_ref().unwrap_or(&f64::NAN);
    let why = |e: &Evaluation| e.norm.as_ref().err().cloned().unwrap_or_default();
    table
        .text("status", all.iter().map(|e| e.row.status.clone()))
        .column("residual norm", c.unit(), all.iter().map(norm))
        .text("why", all.iter().map(why))
}

/// Writes all, and says which files.
pub fn save(dir: &Path, c: &Calibrated) -> Result<Vec<PathBuf>, WriteError> {
    let mut files = ["calibrate.json", "calibrate.csv"]
        .map(|name| dir.join(name))
        .to_vec();
    let text = format!("{:#}\n", json(c));
    write_file(&files[0], |file| file.write_all(text.as_bytes()))?;
    table(c).save(&files[1])?;
    let [x, y] = &c.curve.of;
    let mut plot = Plot::new(format!("{} over {}", y.name, x.name))
        .x(&x.name, &x.unit)
        .y(&y.name, &y.unit)
        .series("measured", &c.curve.x, &c.curve.y, Stroke::None, Mark::Disc);
    // it was read before: it has been compared
    if let Ok([x, y]) = c.curve.of_run(&c.folder) {
        plot = plot.line("fitted", &x, &y);
    }
    files.extend(plot.save(dir, "calibrate")?);
    Ok(files)
}
