//! Moduli along the axes of the body: a thin plate has none that are the same in all directions.

use super::{Findings, Material};
use peridyne::spec::Plane;
use peridyne_theory::patch_test::PatchTest;
use peridyne_theory::voigt::{Directional, Stiffness};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Young's modulus that bars along the axes would have if the body were what was asked for: of a slice in plane strain that of
/// the plane.
pub fn nominal_along(found: &Findings, m: &Material) -> Option<f64> {
    let nominal = m.nominal?;
    let slice = found.info.dimension == 2 && found.spec.space.plane == Plane::Strain;
    Some(match slice {
        true => nominal.young / (1.0 - nominal.poisson * nominal.poisson),
        false => nominal.young,
    })
}

/// `E x 109.2 +56.0 %, …; ν xy 0.33, …; G yz …` per place and of the whole body; `number` writes a modulus.
pub fn lines(
    found: &Findings,
    patch: &PatchTest,
    n: usize,
    m: &Material,
    number: &dyn Fn(f64) -> String,
) -> Vec<String> {
    let d = found.info.dimension;
    if d == 1 {
        return vec![];
    }
    let nominal = nominal_along(found, m);
    let places = patch.classes.iter().filter(|c| c.material == n);
    let mut all: Vec<(&str, Stiffness)> = places
        .filter_map(|c| Some((c.place.name(d), c.stiffness.clone()?)))
        .collect();
    if all.len() > 1
        && let Some(whole) = patch.whole(n)
    {
        all.push(("all points", whole));
    }
    if all.is_empty() {
        return vec![];
    }
    let mut lines = vec!["  along the axes, sides free".to_string()];
    for (name, stiffness) in all {
        let text = match stiffness.directional() {
            Some(directional) => told(&directional, nominal, number),
            None => "no moduli: not stable".into(),
        };
        lines.push(format!("  {name:<12}{text}"));
    }
    lines
}

fn told(directional: &Directional, nominal: Option<f64>, number: &dyn Fn(f64) -> String) -> String {
    let d = directional.young.len();
    let young = directional.young.iter().zip(AXES).map(|(e, axis)| {
        let percent = nominal.map_or(String::new(), |a| format!(" {}", percent(*e, a)));
        format!("E {axis} {}{percent}", number(*e))
    });
    let pairs: &[(usize, usize)] = if d == 2 {
        &[(0, 1)]
    } else {
        &[(1, 2), (2, 0), (0, 1)]
    };
    let poisson = pairs.iter().map(|&(a, b)| {
        let nu = directional.poisson[a][b];
        let nu = match nu.is_finite() {
            true => format!("{nu:.4}"),
            false => "–".into(),
        };
        format!("ν {}{} {nu}", AXES[a], AXES[b])
    });
    let shear = (pairs.iter().zip(&directional.shear))
        .map(|(&(a, b), g)| format!("G {}{} {}", AXES[a], AXES[b], number(*g)));
    [
        young.collect::<Vec<_>>().join(", "),
        poisson.collect::<Vec<_>>().join(", "),
        shear.collect::<Vec<_>>().join(", "),
    ]
    .join("; ")
}

/// `+56.0 %` more than asked for; what is nothing in tenths has no sign of less.
pub fn percent(value: f64, nominal: f64) -> String {
    // + 0.0 makes −0 and 0 one
    let tenths = (1000.0 * (value / nominal - 1.0)).round() + 0.0;
    format!("{:+.1} %", 0.1 * tenths)
}

/// `x +56.0 %, y +56.0 %, z −20.1 %` of Young's moduli against one.
pub fn against(young: &[f64], nominal: f64) -> String {
    let each = young.iter().zip(AXES);
    let each = each.map(|(e, axis)| format!("{axis} {}", percent(*e, nominal)));
    each.collect::<Vec<_>>().join(", ")
}
