//! The findings as a table for people.

mod continuum;
mod loads;
mod look;
mod points;
mod row;
mod spread;
mod stiffness;
mod waves;

use super::Findings;
use super::advice::advice;
use crate::numbers::{digits, duration, memory};
use loads::loads;
use look::look;
use peridyne_io::deck::{counted, describe};
use points::{families, points};
use row::row;
use spread::spread;
use std::fmt::Write;
use stiffness::stiffness;
use waves::{contact, fracture, waves};

/// What is known at once: what would run, its points and loads.
pub fn first(found: &Findings) -> String {
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
    out.push('\n');
    out.push_str(&points(found));
    if !found.info.loads.is_empty() && !found.script {
        out.push('\n');
        out.push_str(&loads(found));
    }
    out
}

/// What takes work: a patch test, trial steps.
pub fn rest(found: &Findings) -> String {
    let mut out = String::new();
    for section in [
        families(found),
        stiffness(found),
        waves(found),
        spread(found),
        fracture(found),
        contact(found),
        continuum::fields(found),
        cost(found),
        warnings(found),
        look(found),
    ] {
        if !section.is_empty() {
            if !out.is_empty() {
                out.push('\n');
            }
            out.push_str(&section);
        }
    }
    out.trim_end().to_string()
}

fn cost(found: &Findings) -> String {
    let info = &found.info;
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
    if let Some(seconds) = found.trial.seconds_per_increment {
        row(
            &mut out,
            "statics",
            format!(
                "about {} for {}",
                duration(found.load()),
                counted(found.increments, "increment")
            ),
        );
        if seconds > 0.0 && found.trial.seconds_per_step.is_none() {
            row(&mut out, "speed", "motion was not reached in the trial");
        }
    }
    let shared = "share the run, one for each 256 points at most, with bitwise the same results (mpiexec -n)";
    row(&mut out, "ranks", shared);
    if let Some(why) = &found.untried {
        row(&mut out, "not tried", why);
    }
    let Some(seconds) = found.trial.seconds_per_step else {
        return out;
    };
    row(
        &mut out,
        "speed",
        format!(
            "{} steps/s with {} threads of {} ({}), {:.2} ns per bond and step",
            digits(1.0 / seconds),
            found.threads,
            info.simd,
            counted(found.trial.steps, "trial step"),
            1e9 * seconds / info.directed_bonds.max(1) as f64
        ),
    );
    row(
        &mut out,
        "time of the run",
        format!(
            "about {}, without writing",
            duration(found.load() + seconds * found.steps as f64)
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
