//! Bodies and shapes in words.

use crate::deck::units::{Dim, UnitSystem, short};
use peridyne::space::region::Region;
use peridyne::space::rigid::RigidShape;
use peridyne::spec::BodySpec;

pub(super) fn rigid(shape: &RigidShape, units: UnitSystem, dimension: usize) -> String {
    let length = |x: f64| units.write(x, Dim::LENGTH);
    let place = |x: &[f64]| {
        let each = x.iter().take(dimension).map(|x| length(*x));
        each.collect::<Vec<_>>().join(", ")
    };
    match shape {
        RigidShape::Sphere { radius } => format!("sphere of radius {}", length(*radius)),
        RigidShape::Box { half } => {
            let edges: Vec<String> = { half.iter().take(dimension) }
                .map(|h| length(2.0 * h))
                .collect();
            format!("box of {}", edges.join(" by "))
        }
        RigidShape::Cylinder { radius, half, .. } => format!(
            "cylinder of radius {} and length {}",
            length(*radius),
            length(2.0 * half)
        ),
        RigidShape::Plane { normal } => {
            let normal = normal.iter().take(dimension).map(|n| short(*n));
            format!(
                "plane of normal ({})",
                normal.collect::<Vec<_>>().join(", ")
            )
        }
        RigidShape::Solid(solid) => format!(
            "surface of {} triangles, volume {}, centroid ({})",
            solid.triangles().face.len(),
            units.write(solid.volume(), Dim::VOLUME),
            place(&solid.centroid())
        ),
    }
}

pub(super) fn body(body: &BodySpec, units: UnitSystem, dimension: usize) -> String {
    match body {
        BodySpec::Lattice {
            kind,
            spacing,
            region,
            perturb,
            ..
        } => {
            let perturbed = if perturb.is_some() { ", perturbed" } else { "" };
            let spacing = units.write(*spacing, Dim::LENGTH);
            format!(
                "{} lattice of {spacing}{perturbed}, {}",
                kind.name(),
                extent(region, units, dimension)
            )
        }
        BodySpec::Sites {
            kind,
            spacing,
            quarters,
            ..
        } => {
            format!(
                "{} sites of a {} lattice of {}",
                quarters.len(),
                kind.name(),
                units.write(*spacing, Dim::LENGTH)
            )
        }
        BodySpec::Several(pieces) => {
            let each = pieces.iter().map(|p| {
                let loose = if p.bonded { "" } else { ", unbonded particles" };
                format!(
                    "\n           {}: {}{loose}",
                    p.name,
                    self::body(&p.body, units, dimension)
                )
            });
            let word = if pieces.len() == 1 { "body" } else { "bodies" };
            format!("{} {word}{}", pieces.len(), each.collect::<String>())
        }
        BodySpec::Cloud(cloud) => {
            let own = if cloud.density.is_empty() {
                ""
            } else {
                ", each with the density of the file (below: their mean)"
            };
            format!("{} points{own}", cloud.position.len())
        }
    }
}

fn extent(region: &Region, units: UnitSystem, dimension: usize) -> String {
    let (low, high) = region.bounds();
    let sizes: Vec<String> = (0..dimension)
        .map(|a| units.write(high[a] - low[a], Dim::LENGTH))
        .collect();
    format!("within {}", sizes.join(" × "))
}
