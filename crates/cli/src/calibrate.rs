//! `peridyne calibrate`: values of a deck's keys with which its runs come nearest to a measured curve.

mod curve;
mod files;
mod key;

use crate::failure::{Failure, note, say};
use crate::numbers::duration;
use crate::signals;
use crate::study::{Row, Setting, Study, StudyArguments};
use crate::sweep::design::{Values, vary};
use curve::{Curve, CurveArguments};
use key::Key;
use peridyne_io::deck::{Deck, rounded};
use peridyne_theory::fit::{Effort, Ended, Fit, Sure, Unfit, fit, sure};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;

/// Steps of less than this part of an interval are none.
const TOLERANCE: f64 = 1e-7;
/// Correlations beyond this are told.
const CORRELATED: f64 = 0.99;

#[derive(clap::Args)]
pub struct CalibrateArguments {
    #[command(flatten)]
    pub study: StudyArguments,
    /// A key and its bounds, e.g. `--fit 'material.law.pmb.young=50 GPa:90 GPa'`; may be repeated.
    #[arg(long, value_name = "KEY=LOW:HIGH", required = true, value_parser = vary)]
    pub fit: Vec<(String, Values)>,
    /// Where a key begins, e.g. `--start 'material.law.pmb.young=60 GPa'`; the middle of its bounds if not given.
    #[arg(long, value_name = "KEY=VALUE", value_parser = crate::pair)]
    pub start: Vec<(String, String)>,
    #[command(flatten)]
    pub curve: CurveArguments,
    /// Runs at most, those of an earlier part among them.
    #[arg(long, default_value_t = 100)]
    pub evaluations: usize,
    /// Slopes are differences over this part of each interval, to both sides: more where curves jump.
    #[arg(long, default_value_t = 1e-3)]
    pub difference: f64,
}

/// One run and how far its curve is from the measured one.
struct Evaluation {
    row: Row,
    /// Root of the sum of squared residuals, or why there is none.
    norm: Result<f64, String>,
}

/// Runs as a fit asks for them.
struct Runs<'a> {
    study: &'a Study<'a>,
    keys: &'a [Key],
    curve: &'a Curve,
    done: Vec<Evaluation>,
}

impl Runs<'_> {
    fn setting(&self, place: &[f64]) -> Setting {
        key::setting(self.keys, place)
    }

    /// The folder of a run has the name of its values.
    fn folder(&self, place: &[f64]) -> PathBuf {
        let names = self
            .keys
            .iter()
            .zip(place)
            .map(|(key, part)| key.number(*part));
        self.study.dir.join(names.collect::<Vec<_>>().join("_"))
    }

    /// Residuals at each of these places.
    fn at(&mut self, places: &[Vec<f64>]) -> Result<Vec<Option<Vec<f64>>>, Failure> {
        let study = self.study;
        let settings: Vec<Setting> = places.iter().map(|p| self.setting(p)).collect();
        let decks = settings.iter().map(|setting| study.deck(setting));
        let decks = decks.collect::<Result<Vec<Deck>, Failure>>()?;
        let folders: Vec<PathBuf> = places.iter().map(|p| self.folder(p)).collect();
        let work = |n: usize| study.one(&decks[n], &settings[n], folders[n].clone());
        let rows = study.side_by_side(places.len(), &work)?;
        let whole = rows.len() == places.len() && rows.iter().all(|r| r.status != "ended");
        let mut all = vec![];
        for row in rows {
            let found = match (&*row.status, &row.why) {
                ("done", _) => self.curve.residuals(&row.dir),
                (status, why) => Err(why.clone().unwrap_or(status.into())),
            };
            let norm = found.as_ref().map(|r| size(r)).map_err(String::clone);
            let evaluation = Evaluation { row, norm };
            say(&self.told(&evaluation));
            self.done.push(evaluation);
            all.push(found.ok());
        }
        match (signals::received(), whole) {
            (_, true) => Ok(all),
            (Some(signal), false) => Err(Failure::Ended(signal)),
            (None, false) => Err(Failure::Run(
                "a run was ended: the same command goes on".into(),
            )),
        }
    }

    /// A line of the terminal.
    fn told(&self, evaluation: &Evaluation) -> String {
        let values = evaluation.row.told();
        let outcome = match &evaluation.norm {
            Ok(norm) => format!("residual {}", rounded(*norm, 5)),
            Err(why) => why.clone(),
        };
        format!("{:>3}  {values}: {outcome}", self.done.len() + 1)
    }
}

fn size(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum::<f64>().sqrt()
}

/// A fit and what it says.
struct Calibrated<'a> {
    arguments: &'a CalibrateArguments,
    keys: &'a [Key],
    curve: &'a Curve,
    fit: Fit,
    sure: Option<Sure>,
    evaluations: Vec<Evaluation>,
    /// Of the fitted values.
    folder: PathBuf,
    command: String,
    warnings: Vec<String>,
}

pub fn calibrate(arguments: &CalibrateArguments) -> Result<(), Failure> {
    let study = Study::of(&arguments.study, "calibrate")?;
    if !(1e-8..=0.1).contains(&arguments.difference) {
        return Err(Failure::input(format!(
            "--difference {}: take a part of the interval from 1e-8 to 0.1",
            arguments.difference
        )));
    }
    let keys = key::keys(&arguments.fit, &arguments.start)?;
    let fewest = 2 * keys.len() + 2;
    if arguments.evaluations < fewest {
        return Err(Failure::input(format!(
            "--evaluations {}: one step of so many keys takes {fewest} runs",
            arguments.evaluations
        )));
    }
    // every mistake before the first run
    let start: Vec<f64> = keys.iter().map(|k| k.start).collect();
    for end in [0.0, 1.0] {
        study.deck(&key::setting(&keys, &vec![end; keys.len()]))?;
    }
    let setting = key::setting(&keys, &start);
    let columns = study.columns(&study.deck(&setting)?, &setting)?;
    let curve = Curve::read(&arguments.curve, &columns)?;
    if curve.x.len() < keys.len() {
        return Err(Failure::input(format!(
            "{}: {} points do not determine {} keys: measure more, or fit fewer",
            arguments.curve.measured.display(),
            curve.x.len(),
            keys.len()
        )));
    }
    let own = keys
        .iter()
        .map(|k| json!({ "key": k.name, "unit": k.unit }));
    study.claim("study.json", ("keys", own.collect()))?;
    say(&format!(
        "fitting {} of {} to {} points of {}, results in {}",
        key::names(keys.iter()),
        arguments.study.input.name(),
        curve.x.len(),
        arguments.curve.measured.display(),
        study.dir.display()
    ));
    curve
        .notes
        .iter()
        .for_each(|text| say(&format!("note: {text}")));
    let begun = Instant::now();
    let mut runs = Runs {
        study: &study,
        keys: &keys,
        curve: &curve,
        done: vec![],
    };
    let effort = Effort {
        tolerance: TOLERANCE,
        difference: arguments.difference,
        evaluations: arguments.evaluations,
    };
    let found = fit(&start, &effort, &mut |places| runs.at(places));
    let fit = found.map_err(|e| unfit(e, &runs))?;
    let (folder, setting) = (runs.folder(&fit.at), runs.setting(&fit.at));
    let slopes = fit.slopes.as_ref();
    let sure = slopes.and_then(|s| sure(&fit.at, &fit.residuals, s));
    let calibrated = Calibrated {
        arguments,
        keys: &keys,
        curve: &curve,
        warnings: warnings(&keys, &fit, sure.as_ref()),
        fit,
        sure,
        evaluations: runs.done,
        folder,
        command: study.command(&setting),
    };
    say(&files::report(&calibrated));
    let files = files::save(&study.dir, &calibrated).map_err(|e| Failure::Run(e.to_string()))?;
    for file in files {
        say(&format!("wrote     {}", file.display()));
    }
    match why(&keys, &calibrated.fit) {
        None => {
            say(&format!(
                "done in {}",
                duration(begun.elapsed().as_secs_f64())
            ));
            Ok(())
        }
        Some(why) => Err(Failure::Run(format!("it has not converged: {why}"))),
    }
}

/// Why there is no fit.
fn unfit(error: Unfit<Failure>, runs: &Runs) -> Failure {
    let last = |what: String| {
        let why = runs.done.iter().rev().find_map(|e| e.norm.as_ref().err());
        let why = why.map_or(String::new(), |why| format!(": {why}"));
        Failure::Run(format!("{what}{why}"))
    };
    match error {
        Unfit::Model(failure) => {
            if matches!(failure, Failure::Ended(_)) {
                note("ended: the same command goes on");
            }
            failure
        }
        Unfit::Start => last("the first run cannot be compared with what was measured".into()),
        Unfit::Slope(k) => last(format!(
            "no run with a little more or less of {} can be compared with what was measured",
            runs.keys[k].name
        )),
        Unfit::Step(why) => Failure::Run(format!("no step is found: {why}")),
    }
}

/// Why a fit has not converged.
fn why(keys: &[Key], fit: &Fit) -> Option<String> {
    match fit.ended {
        Ended::Converged => None,
        Ended::Stalled => Some("no step comes nearer, and slopes say one should: where curves jump, a larger --difference helps".into()),
        Ended::Spent => Some("--evaluations are spent: the same command with more goes on".into()),
        Ended::Flat(k) => Some(format!(
            "the curve does not depend on {} here: begin elsewhere with --start, or leave it out",
            keys[k].name
        )),
    }
}

/// What to doubt.
fn warnings(keys: &[Key], fit: &Fit, sure: Option<&Sure>) -> Vec<String> {
    let mut all: Vec<String> = why(keys, fit).into_iter().collect();
    let Some(sure) = sure else {
        all.push(match fit.slopes {
            Some(_) => "as many keys as points: there are no standard errors".into(),
            None => "no slopes were found at the end: there are no standard errors".into(),
        });
        return all;
    };
    for (k, key) in keys.iter().enumerate().filter(|(k, _)| sure.held[*k]) {
        all.push(format!(
            "{} ends at its bound, {}: the best value may lie beyond; it has no interval, and those of others are with it there",
            key.name,
            key.told(key.real(fit.at[k]))
        ));
    }
    for alike in &sure.alike {
        let names = key::names(alike.iter().map(|k| &keys[*k]));
        all.push(match alike.len() {
            1 => format!("{names} hardly changes this curve: it is not known"),
            _ => format!(
                "{names} are not determined by this curve, only a combination of them is; give one by --set, or measure something else besides"
            ),
        });
    }
    for (k, row) in sure.correlation.iter().enumerate() {
        for (j, r) in row[..k]
            .iter()
            .enumerate()
            .filter(|(_, r)| r.abs() > CORRELATED)
        {
            all.push(format!(
                "{} and {} are correlated by {}: this curve hardly separates them",
                keys[j].name,
                keys[k].name,
                rounded(*r, 5)
            ));
        }
    }
    all
}
