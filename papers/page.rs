//! Reports as Markdown.

use crate::claim::{Bound, Claim, Kind, Value};
use crate::reproduce::{Outcome, Report};

/// A cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// Eight digits are enough to read; `report.json` has all.
fn computed(value: &Value) -> String {
    match value {
        Value::Number(x) if x.is_finite() && *x != 0.0 => {
            let short: f64 = format!("{x:.7e}").parse().unwrap_or(*x);
            let plain = (1e-4..1e9).contains(&short.abs());
            if plain {
                short.to_string()
            } else {
                format!("{short:e}")
            }
        }
        value => value.to_string(),
    }
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Exact => "exact",
        Kind::Digitised => "digitised",
        Kind::Qualitative => "qualitative",
        Kind::Own => "own",
        Kind::Pin => "pin",
    }
}

fn row(c: &Claim) -> String {
    let pass = if c.pass { "yes" } else { "**no**" };
    let number = matches!(c.computed, Value::Number(_));
    let mut tolerance = if number {
        c.tolerance.to_string()
    } else {
        String::new()
    };
    if c.bound == Bound::After {
        tolerance = format!("{tolerance} set after").trim_start().to_string();
    }
    let said = |value: &Option<Value>| value.as_ref().map_or(String::new(), Value::to_string);
    let printed = match &c.erratum {
        None => said(&c.published),
        Some(right) => format!("{} (erratum: {right})", said(&c.published)),
    };
    let cells = [
        c.what.clone(),
        printed,
        said(&c.expected),
        computed(&c.computed),
        tolerance,
        kind(c.kind).to_string(),
        pass.to_string(),
        c.note.clone(),
    ];
    format!("| {} |\n", cells.map(|t| cell(&t)).join(" | "))
}

/// `page.md` of a figure.
pub fn page(report: &Report, readme: &str) -> String {
    let Report { paper, figure, .. } = report;
    let variant = if report.small { "small variant, " } else { "" };
    let mut text = format!(
        "# {}\n\n{paper}/{figure}, {variant}{:.1} s, peridyne {}\n\n",
        report.title, report.seconds, report.version
    );
    text += "| claim | published | expected here | computed | bound | kind | holds | note |\n|---|---|---|---|---|---|---|---|\n";
    report.claims.iter().for_each(|c| text += &row(c));
    text.push('\n');
    if !report.measurements.is_empty() {
        text += "| measured, no claim | value | unit |\n|---|---|---|\n";
        for m in &report.measurements {
            let cells = [m.key.clone(), computed(&m.value), m.unit.clone()];
            text += &format!("| {} |\n", cells.map(|t| cell(&t)).join(" | "));
        }
        text.push('\n');
    }
    for file in report.files.iter().filter(|f| f.ends_with(".png")) {
        text += &format!("![{file}]({file})\n\n");
    }
    let links: Vec<String> = report.files.iter().map(|f| format!("[{f}]({f})")).collect();
    if !links.is_empty() {
        text += &format!("Files: {}\n\n", links.join(", "));
    }
    // the page has a title of its own
    let body = readme
        .trim_start()
        .lines()
        .skip_while(|l| l.starts_with("# ") || l.is_empty());
    text += &body.collect::<Vec<_>>().join("\n");
    text.push('\n');
    text
}

/// `index.md`: all figures that have a report, and those that failed now.
pub fn index(reports: &[Report], outcomes: &[Outcome]) -> String {
    let mut text = String::from(
        "# The papers' experiments\n\n| experiment | title | claims that hold | variant | time |\n|---|---|---|---|---|\n",
    );
    for r in reports {
        let name = format!("{}/{}", r.paper, r.figure);
        let held = r.claims.iter().filter(|c| c.pass).count();
        let held = format!("{held} of {}", r.claims.len());
        let held = if r.pass { held } else { format!("**{held}**") };
        let variant = if r.small { "small" } else { "full" };
        text += &format!(
            "| [{name}]({name}/page.md) | {} | {held} | {variant} | {:.1} s |\n",
            cell(&r.title),
            r.seconds
        );
    }
    for outcome in outcomes {
        if let Outcome::Failed {
            paper,
            figure,
            failure,
        } = outcome
        {
            text += &format!(
                "| {paper}/{figure} | **failed**: {} | | | |\n",
                cell(&failure.to_string())
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_cells_stay_in_their_table() {
        let texts = [184.0, 0.2201637090727318, 1.0 / 3e12, -2e9, 0.0, f64::NAN]
            .map(|x| computed(&Value::Number(x)));
        assert_eq!(
            texts,
            ["184", "0.22016371", "3.3333333e-13", "-2e9", "0", "NaN"]
        );
        assert_eq!(cell("a | b\nc"), "a \\| b c");
    }
}
