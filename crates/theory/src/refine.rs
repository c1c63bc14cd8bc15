//! The same body with finer points: the levels of a convergence study.
//!
//! Level k has 1/2^k of the spacing. The cells of all levels fill the same body: those of a block are divided, others fill their region anew;
//! so points are the middles of other cells, but for periodic axes and bodies that end at their points. With m = δ/Δx:
//!
//! | study | δ | m |
//! |---|---|---|
//! | δ | δ/2^k | m |
//! | m | δ | 2^k m |
//! | δm | δ/√2^k | √2^k m, rounded |

use crate::convergence::Kind;
use peridyne::quantity::Message;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::measure::ends;
use peridyne::space::region::Region;
use peridyne::spec::{BodySpec, Horizon, Spec};

/// Why a body has no finer levels.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RefineError {
    #[error(
        "only an unperturbed lattice body can be refined: its points are points of the finer bodies, too. Give the body as `lattice` with `spacing`"
    )]
    NoLattice,
    #[error(
        "points of a diamond lattice are not points of a finer one: take chain, square, triangular, cubic, bcc or fcc"
    )]
    Diamond,
    #[error(
        "atoms have a distance of their own and are not refined: take a solid (springs, pmb, lps), or `peridyne upscale` for coarser models"
    )]
    Atoms,
    #[error(
        "random velocities differ from level to level: take [[initial]] velocities instead of a temperature"
    )]
    Thermal,
    #[error(
        "a periodic body is refined by whole cells: give it as `cells`, or its region as a block"
    )]
    Periodic,
    #[error(
        "δm-convergence lets m = δ/Δx grow by √2 per level, from 2 or more: m_ratio is {0}, take 2 or more"
    )]
    FewNeighbours(u32),
    #[error(
        "bonds that break or are cut leave displacements that jump, and no order with which their error falls: leave `fracture` and `precrack` out, or run at two spacings and compare what you want to know"
    )]
    Fracture,
    #[error("level {0} has too many points or neighbours to be counted: take fewer levels")]
    TooFine(u32),
    #[error("{0}")]
    Surface(#[from] crate::homogenize::surface::SurfaceError),
}

impl RefineError {
    /// What it says, its numbers with what they measure.
    pub fn message(&self) -> Message {
        match self {
            RefineError::Surface(e) => e.message(),
            other => other.to_string().into(),
        }
    }
}

/// The body of level `level` (0: as it is).
pub fn refine(spec: &Spec, kind: Kind, level: u32) -> Result<Spec, RefineError> {
    if spec.loading.thermal.is_some() {
        return Err(RefineError::Thermal);
    }
    if spec.potential().is_some() {
        return Err(RefineError::Atoms);
    }
    if spec.materials.iter().any(|m| m.fracture.is_some()) || !spec.damage.precracks.is_empty() {
        return Err(RefineError::Fracture);
    }
    let BodySpec::Lattice {
        kind: lattice,
        spacing,
        origin,
        region,
        perturb: None,
    } = &spec.body
    else {
        return Err(RefineError::NoLattice);
    };
    if *lattice == LatticeKind::Diamond {
        return Err(RefineError::Diamond);
    }
    if level > 20 {
        return Err(RefineError::TooFine(level));
    }
    let factor = 1u32 << level;
    let root = libm::pow(2f64, 0.5 * f64::from(level));
    let times = |m: u32, by: u32| m.checked_mul(by).ok_or(RefineError::TooFine(level));
    let horizon = match (kind, spec.bonds.horizon) {
        (Kind::Delta, Horizon::Ratio(m)) => Horizon::Ratio(m),
        (Kind::Delta, Horizon::Length(d)) => Horizon::Length(d / f64::from(factor)),
        (Kind::M, Horizon::Ratio(m)) => Horizon::Ratio(times(m, factor)?),
        (Kind::M, Horizon::Length(d)) => Horizon::Length(d),
        (Kind::DeltaM, Horizon::Ratio(m)) if m < 2 => return Err(RefineError::FewNeighbours(m)),
        (Kind::DeltaM, Horizon::Ratio(m)) => Horizon::Ratio((f64::from(m) * root).round() as u32),
        (Kind::DeltaM, Horizon::Length(d)) => Horizon::Length(d / root),
    };
    let (low, _) = region.bounds();
    let layer: [f64; 3] =
        std::array::from_fn(|a| spacing * lattice.edges()[a] / f64::from(lattice.planes(a)));
    let ends_at_points =
        { spec.bonds.surface.as_ref() }.is_some_and(|f| f.part.iter().any(|p| *p != 1.0));
    let divided: [bool; 3] = std::array::from_fn(|a| {
        a < spec.space.dimension && spec.space.periodic[a].is_none() && !ends_at_points
    });
    let moved = 0.5 * (1.0 / f64::from(factor) - 1.0);
    let fine_origin: [f64; 3] = std::array::from_fn(|a| match divided[a] {
        true => origin[a] + moved * layer[a],
        false => origin[a],
    });
    let region = &match ends(region) {
        Some(block) => {
            let beyond = if ends_at_points { 0.0 } else { 0.5 };
            let free = |a: usize| a < spec.space.dimension && spec.space.periodic[a].is_none();
            let beyond = std::array::from_fn(|a| free(a).then_some(beyond));
            hull(block, origin, &layer, beyond)
        }
        None => region.clone(),
    };
    let cells = Cells {
        origin: *origin,
        edge: lattice.edges().map(|e| e * spacing),
        clip: std::array::from_fn(|a| spec.space.periodic[a].map(|p| low[a] + p)),
        factor: f64::from(factor),
        dimension: spec.space.dimension,
    };
    let region = match region {
        Region::Block { .. } => cells.whole(region)?,
        other => {
            let mut clipped = [false; 3];
            let region = cells.finer(other, &mut clipped);
            if (0..3).any(|a| spec.space.periodic[a].is_some() && !clipped[a]) {
                return Err(RefineError::Periodic);
            }
            region
        }
    };
    let mut fine = spec.clone();
    fine.body = BodySpec::Lattice {
        kind: *lattice,
        spacing: spacing / f64::from(factor),
        origin: fine_origin,
        region,
        perturb: None,
    };
    fine.bonds.horizon = horizon;
    crate::homogenize::surface::renew(&mut fine)?;
    Ok(fine)
}

/// A block as long as the body whose middles of cells it holds: between the outer faces of these where they are divided, else between
/// the outer points; along periodic axes as it is.
fn hull(
    [low, high]: [[f64; 3]; 2],
    origin: &[f64; 3],
    layer: &[f64; 3],
    beyond: [Option<f64>; 3],
) -> Region {
    let (mut from, mut to) = (low, high);
    for a in (0..3).filter(|a| low[*a].is_finite() && high[*a].is_finite()) {
        let Some(beyond) = beyond[a] else { continue };
        let layers = |x: f64| (x - origin[a]) / layer[a];
        from[a] = origin[a] + layer[a] * ((layers(low[a]) - 1e-6).ceil() - beyond);
        to[a] = origin[a] + layer[a] * ((layers(high[a]) + 1e-6).floor() + beyond);
    }
    Region::Block {
        low: from,
        high: to,
    }
}

/// The coarse cells of a body.
struct Cells {
    origin: [f64; 3],
    edge: [f64; 3],
    /// Where the next period begins; decks end blocks an eighth of a cell before.
    clip: [Option<f64>; 3],
    factor: f64,
    dimension: usize,
}

impl Cells {
    /// A block along a period keeps its extent, from just below its first site up to just below the next period.
    fn whole(&self, region: &Region) -> Result<Region, RefineError> {
        let Region::Block { mut low, mut high } = region.clone() else {
            return Ok(region.clone());
        };
        for a in (0..self.dimension).filter(|a| self.clip[*a].is_some()) {
            let edge = self.edge[a];
            let cells = |x: f64| (x - self.origin[a]) / edge;
            let (from, to) = (cells(low[a]), cells(high[a]));
            if !(from.is_finite() && to.is_finite()) {
                return Err(RefineError::Periodic);
            }
            let first = (from - 1e-9).ceil();
            let next = (to + 1e-9).floor() + 1.0;
            low[a] = self.origin[a] + edge * (first - 0.125 / self.factor);
            high[a] = self.origin[a] + edge * (next - 0.125 / self.factor);
        }
        Ok(Region::Block { low, high })
    }

    /// Blocks that end a period end as much closer to the next as cells are smaller: decks end them at most an eighth of a cell before.
    fn finer(&self, region: &Region, clipped: &mut [bool; 3]) -> Region {
        let mut each = |parts: &[Region]| -> Vec<Region> {
            parts.iter().map(|r| self.finer(r, clipped)).collect()
        };
        match region {
            Region::Block { low, high } => {
                let mut high = *high;
                for a in 0..self.dimension {
                    let Some(next) = self.clip[a] else { continue };
                    let eighth = self.edge[a] / 8.0;
                    let before = next - high[a];
                    if before > 0.0 && before < (1.0 + 1e-6) * eighth {
                        high[a] = next - before / self.factor;
                        clipped[a] = true;
                    }
                }
                Region::Block { low: *low, high }
            }
            Region::Union(parts) => Region::Union(each(parts)),
            Region::Intersection(parts) => Region::Intersection(each(parts)),
            Region::Difference(from, minus) => {
                let minus = each(minus);
                Region::Difference(Box::new(self.finer(from, clipped)), minus)
            }
            other => other.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::law::potential::lennard_jones::LennardJones;
    use peridyne::spec::{End, LawSpec, PmbStiffness, PotentialSpec};

    fn bar(low: f64, high: f64, periodic: bool) -> Spec {
        let mut spec = Spec::new(
            1,
            BodySpec::Lattice {
                kind: LatticeKind::Chain,
                spacing: 0.5,
                origin: [0.0; 3],
                region: Region::Block {
                    low: [low, f64::NEG_INFINITY, f64::NEG_INFINITY],
                    high: [high, f64::INFINITY, f64::INFINITY],
                },
                perturb: None,
            },
            1.0,
            LawSpec::Springs(PmbStiffness::Young(1.0)),
        );
        spec.bonds.horizon = Horizon::Ratio(3);
        spec.space.periodic[0] = periodic.then_some(0.0);
        spec
    }

    fn bounds(spec: &Spec) -> [f64; 3] {
        match &spec.body {
            BodySpec::Lattice {
                spacing,
                region: Region::Block { low, high },
                ..
            } => [low[0], high[0], *spacing],
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn horizons_and_spacings_shrink_as_the_studies_say() {
        for (kind, expected) in [
            (Kind::Delta, [3, 3, 3, 3]),
            (Kind::M, [3, 6, 12, 24]),
            (Kind::DeltaM, [3, 4, 6, 8]),
        ] {
            let spec = bar(0.0, 4.0, false);
            let pairs: Vec<[f64; 2]> = (0..4)
                .map(|k| {
                    let fine = refine(&spec, kind, k).unwrap();
                    let m = expected[k as usize];
                    assert_eq!(fine.bonds.horizon, Horizon::Ratio(m));
                    let [low, high, spacing] = bounds(&fine);
                    // nine cells of 0.5 about points from 0 to 4
                    assert_eq!([low, high], [-0.25, 4.25]);
                    [f64::from(m) * spacing, spacing]
                })
                .collect();
            assert_eq!(Kind::of(&pairs), Some(kind));
        }
    }

    #[test]
    fn whole_cells_keep_their_extent() {
        // eight cells, as a periodic block with both ends
        let [low, high, spacing] = bounds(&refine(&bar(0.0, 3.5, true), Kind::Delta, 2).unwrap());
        let first = (low / spacing).ceil();
        let last = (high / spacing).floor();
        assert_eq!([first, last, spacing], [0.0, 31.0, 0.125]);
    }

    #[test]
    fn the_cells_of_all_levels_fill_the_same_body() {
        use peridyne::run::{Options, build};
        let plate = |kind: LatticeKind, spacing: f64, origin: f64| {
            let body = BodySpec::Lattice {
                kind,
                spacing,
                origin: [origin; 3],
                region: Region::Block {
                    low: [0.0; 3],
                    high: [4.0, 3.0, 2.0],
                },
                perturb: None,
            };
            let mut spec = Spec::new(
                kind.dimension(),
                body,
                1.0,
                LawSpec::Pmb(PmbStiffness::Young(1.0)),
            );
            spec.bonds.horizon = Horizon::Ratio(2);
            spec
        };
        // filled, with faces through points, of two sublattices, and as cells
        for (spec, wanted) in [
            (plate(LatticeKind::Square, 0.5, 0.25), 12.0),
            (plate(LatticeKind::Square, 0.5, 0.0), 4.5 * 3.5),
            (plate(LatticeKind::Cubic, 1.0, 0.5), 24.0),
            (plate(LatticeKind::Bcc, 1.0, 0.25), 24.0),
            (bar(-0.0625, 3.9375, false), 4.0),
        ] {
            for level in 0..3 {
                let fine = refine(&spec, Kind::Delta, level).unwrap();
                let volume = build(&fine, Options::default()).unwrap().info().volume;
                assert!(
                    (volume / wanted - 1.0).abs() < 1e-12,
                    "{level}: {volume} {wanted}"
                );
            }
        }
    }

    #[test]
    fn periods_of_decks_are_cut_just_below_the_next() {
        let mut spec = bar(0.0, 4.0, true);
        spec.space.periodic[0] = Some(4.0);
        let BodySpec::Lattice { region, .. } = &mut spec.body else {
            panic!("no lattice")
        };
        let mut cut = region.clone();
        if let Region::Block { high, .. } = &mut cut {
            high[0] = 4.0 - 0.0625;
        }
        *region = Region::Intersection(vec![region.clone(), cut]);
        let fine = refine(&spec, Kind::Delta, 2).unwrap();
        let BodySpec::Lattice { region, .. } = fine.body else {
            panic!("no lattice")
        };
        let inside = (0..40).filter(|n| region.contains(&[0.125 * f64::from(*n), 0.0, 0.0]));
        assert_eq!(inside.count(), 32);
    }

    #[test]
    fn what_has_no_finer_level_is_said() {
        let spec = bar(0.0, 4.0, false);
        let told = |spec: &Spec, kind, level, words: &str| {
            let error = refine(spec, kind, level).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        let mut near = spec.clone();
        near.bonds.horizon = Horizon::Ratio(1);
        told(&near, Kind::DeltaM, 1, "take 2 or more");
        let mut cracked = spec.clone();
        cracked.damage.precracks.push(peridyne::spec::PrecrackSpec {
            shape: peridyne::spec::CrackShape::Point { x: 1.0 },
            kind: peridyne::spec::CrackKind::Excluded,
        });
        told(&cracked, Kind::Delta, 1, "displacements that jump");
        let mut cloud = spec.clone();
        cloud.body = BodySpec::Cloud(Default::default());
        told(&cloud, Kind::M, 1, "only an unperturbed lattice body");
        told(&spec, Kind::M, 40, "fewer levels");
        let mut atoms = spec.clone();
        atoms.materials[0].law = LawSpec::Atoms(
            PotentialSpec::of(LennardJones {
                epsilon: 1.0,
                sigma: 1.0,
            })
            .ended(2.5, End::Shifted),
        );
        told(&atoms, Kind::M, 1, "peridyne upscale");
        told(&bar(0.0, f64::INFINITY, true), Kind::M, 1, "whole cells");
    }
}
