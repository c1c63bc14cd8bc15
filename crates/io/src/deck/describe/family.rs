//! Who talks to whom, and how strongly.

use super::material::{criterion, potentials};
use super::words::{influence, length, words};
use crate::deck::units::{Dim, UnitSystem};
use peridyne::spec::{
    BodySpec, BondFactorSpec, Calibration, Criterion, FamilyChoice, PieceSpec, PotentialSpec, Spec,
    SurfaceFactor, SurfaceFactors,
};

/// Families, what is periodic, factors of bonds.
pub(super) fn lines(spec: &Spec, units: UnitSystem) -> Vec<String> {
    let mut lines = vec![reach(spec, units)];
    if let Some(smooth) = &spec.bonds.smooth {
        let nodes = match smooth.spacing {
            Some(spacing) => format!("every {}", units.write(spacing, Dim::LENGTH)),
            None => "at the places of the atoms".into(),
        };
        lines.push(format!(
            "smooth     nodes {nodes} carry the atoms, by a kernel of width {}",
            units.write(smooth.width, Dim::LENGTH)
        ));
    }
    if let BodySpec::Several(pieces) = &spec.body {
        let own = |p: &&PieceSpec| {
            p.horizon.is_some_and(|h| h != spec.bonds.horizon)
                || p.influence.is_some_and(|i| i != spec.bonds.influence)
        };
        lines.extend(pieces.iter().filter(own).map(|p| {
            format!(
                "           of {}: {}, influence {}",
                p.name,
                length(p.horizon.unwrap_or(spec.bonds.horizon), units),
                influence(p.influence.unwrap_or(spec.bonds.influence))
            )
        }));
    }
    if let Some(own) = &spec.bonds.variable_horizon {
        lines.push(format!(
            "           of each point {}, at most that: dual horizon",
            own.source()
        ));
    }
    for piece in spec.body.pieces() {
        if let Some(own) = &piece.variable_horizon {
            lines.push(format!(
                "           of each point of {} {}, at most that: dual horizon",
                piece.name,
                own.source()
            ));
        }
    }
    lines.extend(interfaces(spec, units));
    for (axis, period) in ["x", "y", "z"].iter().zip(spec.space.periodic) {
        if let Some(period) = period {
            lines.push(format!(
                "periodic   {axis} with {}",
                units.write(period, Dim::LENGTH)
            ));
        }
    }
    let spreads = !spec.interactions.diffusions.is_empty();
    let surfaces = spec.bonds.surface.iter().map(|f| ("", f));
    let pieces = spec.body.pieces().iter();
    let each = pieces.filter_map(|p| Some((p.name.as_str(), p.surface.as_ref()?)));
    for (name, factors) in surfaces.chain(each) {
        lines.push(surface(name, factors, spreads));
    }
    for bonds in &spec.bonds.factors {
        lines.push(match bonds {
            BondFactorSpec::Field(field) => format!(
                "bonds      stiffness times {}, between unlike ends {}",
                field.source(),
                words(&spec.interactions.interface)
            ),
            BondFactorSpec::Crossing { factor, .. } => {
                format!("bonds      stiffness times {factor} across a flat shape")
            }
        });
    }
    lines
}

/// How far bonds reach, and what they weigh.
fn reach(spec: &Spec, units: UnitSystem) -> String {
    let horizon = length(spec.bonds.horizon, units);
    match spec.potential() {
        Some(_) => {
            let cutoffs = potentials(spec).map(PotentialSpec::cut_off);
            let cutoff = cutoffs.fold(0.0, f64::max);
            let mut names: Vec<&str> = potentials(spec).map(|p| &*p.name).collect();
            names.dedup();
            let current = matches!(
                spec.bonds.family,
                FamilyChoice::Auto | FamilyChoice::Neighbours
            );
            format!(
                "potential  {}, {}, {}",
                names.join(" and "),
                if cutoff.is_finite() {
                    format!("cut-off {}", units.write(cutoff, Dim::LENGTH))
                } else {
                    "without cut-off".into()
                },
                if current {
                    "between atoms that are near now".into()
                } else {
                    format!("between those within {horizon} in the reference")
                }
            )
        }
        None => format!(
            "horizon    {horizon}, influence {}, partial-volume correction {}, constants {}",
            influence(spec.bonds.influence),
            if spec.bonds.partial_volume_correction {
                "on"
            } else {
                "off"
            },
            match spec.bonds.calibration {
                Calibration::Continuum => "of the continuum",
                Calibration::Discrete => "of this body's own sums",
            }
        ),
    }
}

/// Bonds between bodies.
fn interfaces(spec: &Spec, units: UnitSystem) -> Vec<String> {
    let mut lines = vec![];
    for i in &spec.interactions.interfaces {
        let fracture = match i.fracture.map(|f| f.criterion) {
            None => "never breaks".into(),
            Some(Criterion::Stretch(s)) => format!("critical stretch {s}"),
            Some(Criterion::Energy(e)) => {
                format!("fracture energy {}", units.write(e, Dim::FRACTURE_ENERGY))
            }
            Some(other) => criterion(other, units),
        };
        lines.push(format!(
            "interface  {} bonds {} and {} within {}, {fracture}",
            i.name,
            i.bodies[0],
            i.bodies[1],
            length(i.horizon, units)
        ));
    }
    lines
}

/// Factors of bonds near the surface of a body; `spreads`: does anything spread through bonds?
fn surface(body: &str, surface: &SurfaceFactors, spreads: bool) -> String {
    let of = match body {
        "" => String::new(),
        name => format!("of {name} "),
    };
    let range = |of: fn(&SurfaceFactor) -> f64| {
        let all = surface.rows.iter().flatten().map(|(_, x)| of(x));
        all.fold((1.0f64, 1.0f64), |(a, b), x| (a.min(x), b.max(x)))
    };
    let beside = |what: &str, (least, most): (f64, f64)| match least < most {
        true => format!(", of {what} {least:.2} to {most:.2}"),
        false => String::new(),
    };
    let (low, high) = range(|x| x.pair);
    let mut others = beside("the dilatation", range(|x| x.share));
    if spreads {
        others += &beside("conductances", range(|x| x.conductance));
    }
    format!(
        "surface    {of}{}: {} kinds of points, bond stiffness factors {low:.2} to {high:.2}{others}",
        words(&surface.method),
        surface.rows.len() - 1
    )
}
