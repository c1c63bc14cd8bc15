//! How the materials of a lattice body repeat: the smallest cell of atoms of several kinds.

use super::cells::{determinant, primitive, reciprocal};
use super::error::CrystalError;
use peridyne::run::materials_of;
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::spec::{BodySpec, Spec};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// A cell with what lies in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Arrangement<const D: usize> {
    /// Rows: lattice vectors (length).
    pub cell: [[f64; D]; D],
    /// Where (length), and the place of its material in the spec.
    pub sites: Vec<([f64; D], usize)>,
}

/// Quarters of the lattice's cell.
type Quarters = [i32; 3];

/// Translations that are tried, from the shortest on.
const TRIED: usize = 20_000;

/// The points of a lattice body and what they are made of.
struct Points {
    lattice: Lattice,
    material: HashMap<Quarters, usize>,
    /// In quarters, of periodic axes.
    period: [Option<i32>; 3],
}

impl Points {
    fn of(spec: &Spec, lattice: Lattice) -> Result<Points, CrystalError> {
        let all = materials_of(spec).map_err(|e| CrystalError::Potential(e.message.into()))?;
        let edges = lattice.kind.edges();
        let quarters =
            |a: usize, length: f64| (4.0 * length / (lattice.spacing * edges[a])).round();
        Ok(Points {
            material: { all.iter() }
                .map(|(x, material)| (lattice.quarter(x), *material))
                .collect(),
            period: std::array::from_fn(|a| spec.space.periodic[a].map(|p| quarters(a, p) as i32)),
            lattice,
        })
    }

    fn at(&self, q: Quarters) -> Option<usize> {
        let wrapped = std::array::from_fn(|a| match self.period[a] {
            Some(p) if p > 0 => q[a].rem_euclid(p),
            _ => q[a],
        });
        self.material.get(&wrapped).copied()
    }

    /// Does the lattice fall on itself, and are all points that have another there of its material, and are these a quarter of all?
    fn repeats(&self, by: Quarters) -> bool {
        let add = |q: &Quarters| -> Quarters { std::array::from_fn(|a| q[a] + by[a]) };
        let basis = self.lattice.kind.basis();
        let falls = |b: &Quarters| basis.contains(&add(b).map(|q| q.rem_euclid(4)));
        if !basis.iter().all(falls) {
            return false;
        }
        let mut met = 0;
        for (q, material) in &self.material {
            match self.at(add(q)) {
                Some(other) if other != *material => return false,
                Some(_) => met += 1,
                None => {}
            }
        }
        4 * met >= self.material.len()
    }

    fn vector<const D: usize>(&self, q: Quarters) -> [f64; D] {
        let edges = self.lattice.kind.edges();
        std::array::from_fn(|a| self.lattice.spacing * edges[a] * f64::from(q[a]) / 4.0)
    }

    /// All from the one in the middle on, which comes first.
    fn sorted(&self) -> Vec<(Quarters, usize)> {
        let mut all: Vec<(Quarters, usize)> = self.material.iter().map(|(q, m)| (*q, *m)).collect();
        let count = all.len() as f64;
        let middle: [f64; 3] =
            std::array::from_fn(|a| all.iter().map(|(q, _)| f64::from(q[a])).sum::<f64>() / count);
        let far = |q: &Quarters| -> f64 {
            let v = self.vector::<3>(*q);
            let m = self.lattice.kind.edges();
            let scale = |a: usize| self.lattice.spacing * m[a] / 4.0;
            (0..3).map(|a| (v[a] - scale(a) * middle[a]).powi(2)).sum()
        };
        all.sort_by(|(a, _), (b, _)| far(a).total_cmp(&far(b)).then(a.cmp(b)));
        let first = all[0].0;
        let from = |q: &Quarters| -> f64 {
            let apart = std::array::from_fn(|a| q[a] - first[a]);
            self.vector::<3>(apart).iter().map(|x| x * x).sum()
        };
        all.sort_by(|(a, _), (b, _)| from(a).total_cmp(&from(b)).then(a.cmp(b)));
        all
    }
}

/// How the materials of a lattice body repeat.
///
/// # Errors
/// They do not, or the body is too small to tell, or it has points of no material.
pub fn arrangement<const D: usize>(spec: &Spec) -> Result<Arrangement<D>, CrystalError> {
    let (BodySpec::Lattice {
        kind,
        spacing,
        origin,
        ..
    }
    | BodySpec::Sites {
        kind,
        spacing,
        origin,
        ..
    }) = &spec.body
    else {
        return Err(CrystalError::NotPeriodic);
    };
    let lattice = Lattice {
        kind: *kind,
        spacing: *spacing,
        origin: *origin,
    };
    if spec.materials.len() == 1 {
        let (cell, sites) = primitive::<D>(*kind)?;
        let grown = |x: [f64; D]| x.map(|x| x * spacing);
        return Ok(Arrangement {
            cell: cell.map(grown),
            sites: sites.into_iter().map(|x| (grown(x), 0)).collect(),
        });
    }
    let points = Points::of(spec, lattice)?;
    if points.material.is_empty() {
        return Err(CrystalError::NotPeriodic);
    }
    let sorted = points.sorted();
    let (origin, own) = sorted[0];
    let apart = |q: &Quarters| -> Quarters { std::array::from_fn(|a| q[a] - origin[a]) };
    let mut cell: Vec<[f64; D]> = vec![];
    let candidates = sorted.iter().skip(1).take(TRIED);
    for (q, _) in candidates.filter(|(_, material)| *material == own) {
        let by = apart(q);
        let next = points.vector::<D>(by);
        if cell.len() < D && independent(&cell, &next) && points.repeats(by) {
            cell.push(next);
        }
    }
    // the shortest vectors that are independent span the lattice of translations, in up to three dimensions
    let Ok(cell) = <[[f64; D]; D]>::try_from(cell) else {
        return Err(CrystalError::NotPeriodic);
    };
    let b = reciprocal(&cell);
    let whole = |x: [f64; D]| {
        b.iter().all(|b| {
            let n: f64 = (0..D).map(|a| b[a] * x[a]).sum::<f64>() / TAU;
            (n - n.round()).abs() < 1e-6
        })
    };
    let mut sites: Vec<([f64; D], usize)> = vec![];
    for (q, material) in &sorted {
        let x = points.vector::<D>(apart(q));
        let same = |(y, _): &([f64; D], usize)| whole(std::array::from_fn(|a| x[a] - y[a]));
        if !sites.iter().any(same) {
            sites.push((x, *material));
        }
    }
    let site = kind.site_volume() * spacing.powi(D as i32);
    match (determinant(&cell).abs() / site).round() as usize == sites.len() {
        true => Ok(Arrangement { cell, sites }),
        false => Err(CrystalError::NotPeriodic),
    }
}

fn independent<const D: usize>(cell: &[[f64; D]], next: &[f64; D]) -> bool {
    // Gram & Schmidt
    let mut rest = *next;
    let mut spanned: Vec<[f64; D]> = vec![];
    let dot = |x: &[f64; D], y: &[f64; D]| -> f64 { (0..D).map(|a| x[a] * y[a]).sum() };
    for v in cell.iter().chain([next]) {
        rest = *v;
        for s in &spanned {
            let part = dot(&rest, s) / dot(s, s);
            rest = std::array::from_fn(|a| rest[a] - part * s[a]);
        }
        spanned.push(rest);
    }
    dot(&rest, &rest) > 1e-12 * dot(next, next)
}

/// The lattice whose primitive cell spans the same translations, and its spacing (length).
pub fn bravais<const D: usize>(cell: &[[f64; D]; D]) -> Option<(LatticeKind, f64)> {
    let volume = determinant(cell).abs();
    let b = reciprocal(cell);
    let kinds = LatticeKind::ALL.into_iter();
    let mut plain = kinds.filter(|k| k.dimension() == D && *k != LatticeKind::Diamond);
    plain.find_map(|kind| {
        let spacing = libm::pow(volume / kind.site_volume(), 1.0 / D as f64);
        let (rows, _) = primitive::<D>(kind).ok()?;
        let whole = |row: &[f64; D]| {
            b.iter().all(|b| {
                let n: f64 = (0..D).map(|a| spacing * b[a] * row[a]).sum::<f64>() / TAU;
                (n - n.round()).abs() < 1e-6
            })
        };
        rows.iter().all(whole).then_some((kind, spacing))
    })
}
