//! Fig. 5: f(N) of bars with half-weight ends.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::exact::{Field, q};
use peridyne_theory::homogenize::bar::Ends;
use peridyne_theory::homogenize::bar::limit::decimals;

use super::bar;
use crate::{Context, Failure, Findings};

experiment!(
    Figure5,
    "figure-5",
    "f(N) of bars with half-weight ends",
    []
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let most = if context.small { 40 } else { 200 };
    let mut limits = vec![];
    for (m, name) in [(2, "a"), (3, "b"), (4, "c")] {
        let (mut n, mut plain, mut homogenized) = (vec![], vec![], vec![]);
        for points in 2 * m + 1..=most {
            n.push(points as f64);
            plain.push(bar(m, points, Ends::Half, false)?.f().value());
            homogenized.push(bar(m, points, Ends::Half, true)?.f().value());
        }
        let limit = bar(m, most, Ends::Half, false)?.f_limit().value;
        let across = [n[0], n[n.len() - 1]];
        let plot = Plot::new(format!("Half-weight ends, δ = {m}Δ"))
            .x("N", "")
            .y("f(N)", "")
            .line("not homogenized", &n, &plain)
            .line("homogenized", &n, &homogenized)
            .dashed("limit, not homogenized", &across, &[limit.value(); 2])
            .dashed("classical", &across, &[1.0; 2]);
        found.picture(plot.save(&context.out, &format!("{name}-f"))?);
        let path = context.out.join(format!("{name}-f.csv"));
        Table::new()
            .column("N", "", n)
            .column("not homogenized", "", plain.iter().copied())
            .column("homogenized", "", homogenized.iter().copied())
            .save(&path)?;
        found.file(path);
        let square = (m * m) as i64;
        let constant = bar(m, most, Ends::Half, true)?.f();
        // printed as a decimal where m = 4
        match m {
            4 => found.number("constant-4", constant.value()),
            m => found.text(&format!("constant-{m}"), constant.to_string()),
        }
        let same = homogenized.iter().all(|f| *f == constant.value());
        let closed = constant == q(2 * square, 2 * square - 1);
        let falls =
            plain.windows(2).all(|w| w[1] < w[0]) && plain.iter().all(|f| *f > limit.value());
        found.holds(
            &format!("shape-{m}"),
            format!(
                "not homogenized falls from {:.4} to {:.4} towards {}",
                plain[0],
                plain[plain.len() - 1],
                decimals(&limit, 10)
            ),
            same && closed && falls,
        );
        limits.push([limit.value(), constant.value()]);
    }
    let closer = |k: usize| limits.windows(2).all(|w| w[1][k] < w[0][k]);
    found.holds(
        "least",
        format!(
            "limits over 1: {:.4}, {:.4}, {:.4}; homogenized {:.4}, {:.4}, {:.4}",
            limits[0][0], limits[1][0], limits[2][0], limits[0][1], limits[1][1], limits[2][1]
        ),
        closer(0) && closer(1) && limits.iter().flatten().all(|f| *f > 1.03),
    );
    Ok(found)
}
