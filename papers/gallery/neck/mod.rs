//! A bar necks: its load against Considère's, what the neck does and what the rest of the bar does, Bridgman's tension.

use peridyne_io::write::picture::shown::About;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    Neck,
    "neck",
    "A bar necks (Considère, Bridgman)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (SI): Young's modulus, Poisson's ratio, yield stress, ε₀ and n of Swift's law; width of the bar, its thickness, half of the
/// distance of the marks.
const E: f64 = 200e9;
const NU: f64 = 0.3;
const YIELD: f64 = 300e6;
const REFERENCE: f64 = 0.002;
const N: f64 = 0.2;
const WIDTH: f64 = 0.012;
const THICKNESS: f64 = 0.001;
const MARK: f64 = 0.016;
/// What of its width is left where Bridgman's tension is asked for.
const LEFT: [f64; 2] = [2.0 / 3.0, 0.5];

/// Yield stress at a plastic strain.
fn flow(strain: f64) -> f64 {
    YIELD * (1.0 + strain / REFERENCE).powf(N)
}

/// Logarithmic strain and nominal stress of a strip that is extended evenly in plane strain, at a plastic strain. The stress across its
/// plane is half of that along it.
fn uniform(plastic: f64) -> [f64; 2] {
    let stress = 2.0 / 3f64.sqrt() * flow(plastic);
    let strain = 0.5 * 3f64.sqrt() * plastic + (1.25 - NU) * stress / E;
    let volume = 1.5 * (1.0 - 2.0 * NU) * stress / E;
    [strain, stress * (volume - strain).exp()]
}

/// The same nominal stress at a logarithmic strain.
fn nominal(strain: f64) -> f64 {
    let [mut low, mut high] = [0.0, 2.0];
    for _ in 0..60 {
        let half = 0.5 * (low + high);
        if uniform(half)[0] < strain {
            low = half;
        } else {
            high = half;
        }
    }
    uniform(low)[1]
}

/// Considère's strain and nominal stress at the greatest load, without elastic strains.
fn considere() -> [f64; 2] {
    let strain = N - 0.5 * 3f64.sqrt() * REFERENCE;
    let plastic = 2.0 * N / 3f64.sqrt() - REFERENCE;
    [strain, 2.0 / 3f64.sqrt() * flow(plastic) * (-strain).exp()]
}

/// A strip of points across the bar.
struct Section {
    at: f64,
    /// Half of its width, of which half a spacing is as long as the bonds beside it.
    half: f64,
}

/// Sections of the straight part now: of columns of the lattice.
fn sections(bench: &mut Bench) -> Vec<Section> {
    let x = bench.sim.vectors("reference");
    let u = bench.sim.vectors("displacement");
    let h = bench.sim.info().spacing;
    let of = |x: f64| (x / h).floor() as i64;
    let reach = of(MARK * 1.4);
    let columns = -reach..reach;
    columns
        .map(|k| {
            let mut all: Vec<[f64; 2]> = (0..x.len())
                .filter(|i| of(x[*i][0]) == k)
                .map(|i| [x[i][0] + u[i][0], x[i][1] + u[i][1]])
                .collect();
            all.sort_by(|a, b| a[1].total_cmp(&b[1]));
            let n = all.len();
            let ends = 0.5 * (all[1][1] - all[0][1] + all[n - 1][1] - all[n - 2][1]);
            Section {
                at: 0.5 * (all[0][0] + all[n - 1][0]),
                half: 0.5 * (all[n - 1][1] - all[0][1] + ends),
            }
        })
        .collect()
}

fn narrowest(sections: &[Section]) -> usize {
    let all = (0..sections.len()).min_by(|a, b| sections[*a].half.total_cmp(&sections[*b].half));
    all.unwrap_or(0)
}

/// Radius of the surface where the bar is narrowest: of the parabola through the sections within half of that width.
fn radius(sections: &[Section]) -> f64 {
    let least = &sections[narrowest(sections)];
    let near = sections.iter().map(|s| [s.at - least.at, s.half]);
    let near: Vec<[f64; 2]> = near.filter(|s| s[0].abs() < least.half).collect();
    // half = a + x²/2R by least squares; the linear part is left out, a neck is symmetric
    let n = near.len() as f64;
    let [square, height] = [
        near.iter().map(|s| s[0] * s[0]).sum::<f64>() / n,
        near.iter().map(|s| s[1]).sum::<f64>() / n,
    ];
    let both = near
        .iter()
        .map(|s| (s[0] * s[0] - square) * (s[1] - height));
    let own = near.iter().map(|s| (s[0] * s[0] - square).powi(2));
    0.5 * own.sum::<f64>() / both.sum::<f64>()
}

/// What is measured now and then.
#[derive(Default)]
struct Course {
    strain: Vec<f64>,
    stress: Vec<f64>,
    /// Plastic strain in the middle and at the marks.
    middle: Vec<f64>,
    outside: Vec<f64>,
}

fn mean(values: &[f64], of: &[usize]) -> f64 {
    of.iter().map(|k| values[*k]).sum::<f64>() / of.len() as f64
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let set: &[(&str, &str)] = match context.small {
        true => &[("constants.h", "1 mm"), ("run.duration", "1.7 ms")],
        false => &[],
    };
    let mut bench = Bench::new(DECK, set)?;
    let x = bench.places();
    let h = bench.sim.info().spacing;
    let near = |place: f64| {
        let all = (0..x.len()).filter(|k| (x[*k][0].abs() - place).abs() < h);
        all.collect::<Vec<usize>>()
    };
    let [marks, middle] = [near(MARK), near(0.0)];
    let core: Vec<usize> = { middle.iter().copied() }
        .filter(|k| x[*k][1].abs() < h)
        .collect();
    let steps = bench.steps();
    let every = (steps / 300).max(1);
    let mut course = Course::default();
    let mut tension: Vec<[f64; 3]> = vec![];
    for n in 1..=steps {
        bench.step()?;
        if n % every != 0 {
            continue;
        }
        let stretch = bench.probe("mark_x")? - bench.probe("other_x")?;
        course.strain.push((stretch / (2.0 * MARK)).ln_1p());
        let stress = bench.probe("pull_x")?.abs() / (WIDTH * THICKNESS);
        course.stress.push(stress);
        let plastic = bench.values("plastic_strain", 0)?;
        course.middle.push(mean(&plastic, &middle));
        course.outside.push(mean(&plastic, &marks));
        if tension.len() < LEFT.len() && !context.small {
            let all = sections(&mut bench);
            let half = all[narrowest(&all)].half;
            if half < 0.5 * LEFT[tension.len()] * WIDTH {
                let p = bench.values("mean_stress", 0)?;
                let own = mean(&p, &core) / flow(mean(&plastic, &core));
                tension.push([own, half, radius(&all)]);
            }
        }
    }

    let top =
        (0..course.stress.len()).max_by(|a, b| course.stress[*a].total_cmp(&course.stress[*b]));
    let top = top.ok_or_else(|| Failure::new("no load"))?;
    let [strain, stress] = considere();
    found.number("load", course.stress[top] / stress);
    found.number("strain", course.strain[top] / strain);
    let last = 0.9 * course.strain[top].exp_m1();
    let part = (0..top).filter(|k| (0.02..last).contains(&course.strain[*k].exp_m1()));
    let apart = part.map(|k| (course.stress[k] / nominal(course.strain[k]) - 1.0).abs());
    found.number("curve", apart.fold(0.0, f64::max));
    found.measured(
        "greatest load over the width",
        1e-6 * course.stress[top],
        "MPa",
    );
    found.measured("Considère's", 1e-6 * stress, "MPa");
    found.measured("elongation there", course.strain[top].exp_m1(), "");
    found.measured("Considère's elongation", strain.exp_m1(), "");
    if !context.small {
        let end = course.stress.len() - 1;
        let fallen = (top..=end).find(|k| course.stress[*k] < 0.95 * course.stress[top]);
        let fallen = fallen.ok_or_else(|| Failure::new("the load does not fall by 5 %"))?;
        let grown = |of: &[f64]| of[end] - of[fallen];
        let [neck, rest] = [grown(&course.middle), grown(&course.outside)];
        found.holds(
            "outside",
            format!("{rest:.4} at the marks, {neck:.3} in the neck"),
            rest < 0.02 * neck,
        );
        let all = sections(&mut bench);
        let least = &all[narrowest(&all)];
        found.holds(
            "middle",
            format!("{:.2} mm from the middle", 1e3 * least.at.abs()),
            least.at.abs() < 0.25 * WIDTH,
        );
        found.measured("width of the neck at the end", 2e3 * least.half, "mm");
        found.measured(
            "load at the end over the greatest",
            course.stress[end] / course.stress[top],
            "",
        );
        if tension.len() < LEFT.len() {
            return Err(Failure::new("the neck stays wide"));
        }
        let left = ["two thirds", "half"].into_iter().zip(["bridgman", "deep"]);
        for ((words, key), [own, half, radius]) in left.zip(tension) {
            let bridgman = (1.0 + 2.0 * (1.0 + half / (2.0 * radius)).ln()) / 3f64.sqrt();
            found.number(key, own / bridgman);
            found.measured(
                &format!("mean stress over yield stress in the middle of the neck, {words} of the width left"),
                own,
                "",
            );
            found.measured(&format!("Bridgman's, {words} left"), bridgman, "");
            found.measured(
                &format!("radius of the surface over half of the width there, {words} left"),
                radius / half,
                "",
            );
        }
    }
    bench.drawn(
        context,
        "strain",
        ["plastic_strain", ""],
        About::Motion,
        &mut found,
    )?;

    let percent = |all: &[f64]| all.iter().map(|e| 100.0 * e.exp_m1()).collect::<Vec<f64>>();
    let mega = |all: &[f64]| all.iter().map(|s| 1e-6 * s).collect::<Vec<f64>>();
    let along: Vec<f64> = (0..=300).map(|k| 0.001 * f64::from(k)).skip(4).collect();
    let exact: Vec<f64> = along.iter().map(|e| nominal(*e)).collect();
    let plot = Plot::new("Load of a bar that necks")
        .x("elongation between the marks", "%")
        .y("load over the first width", "MPa")
        .line("uniform extension", &percent(&along), &mega(&exact))
        .line("computed", &percent(&course.strain), &mega(&course.stress))
        .points("Considère", &[100.0 * strain.exp_m1()], &[1e-6 * stress]);
    found.picture(plot.save(&context.out, "load")?);
    let path = context.out.join("load.csv");
    Table::new()
        .column("logarithmic strain between the marks", "", course.strain)
        .column("nominal stress", "Pa", course.stress)
        .column("plastic strain in the middle", "", course.middle)
        .column("plastic strain at the marks", "", course.outside)
        .save(&path)?;
    found.file(path);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greatest_load_is_where_the_slope_of_the_stress_is_the_stress() {
        let [strain, stress] = considere();
        let plastic = 2.0 * strain / 3f64.sqrt();
        let slope = (flow(plastic + 1e-6) - flow(plastic - 1e-6)) / 2e-6 * 2.0 / 3f64.sqrt();
        assert!((slope / flow(plastic) - 1.0).abs() < 1e-6);
        // with elastic strains the greatest load is nearly the same
        let most = (1..400).map(|k| uniform(0.001 * f64::from(k))[1]);
        let most = most.fold(0.0, f64::max);
        assert!((most / stress - 1.0).abs() < 2e-3, "{}", most / stress);
    }
}
