//! The same body with finer points: the levels of a convergence study.
//!
//! Level k has 1/2^k of the spacing, so that lattice points stay points. With m = δ/Δx:
//!
//! | study | δ | m |
//! |---|---|---|
//! | δ | δ/2^k | m |
//! | m | δ | 2^k m |
//! | δm | δ/√2^k | √2^k m, rounded |

use crate::convergence::Kind;
use peridyne::quantity::Message;
use peridyne::space::lattice::LatticeKind;
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
    if spec.thermal.is_some() {
        return Err(RefineError::Thermal);
    }
    if spec.potential().is_some() {
        return Err(RefineError::Atoms);
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
    let root = 2f64.powf(0.5 * f64::from(level));
    let times = |m: u32, by: u32| m.checked_mul(by).ok_or(RefineError::TooFine(level));
    let horizon = match (kind, spec.horizon) {
        (Kind::Delta, Horizon::Ratio(m)) => Horizon::Ratio(m),
        (Kind::Delta, Horizon::Length(d)) => Horizon::Length(d / f64::from(factor)),
        (Kind::M, Horizon::Ratio(m)) => Horizon::Ratio(times(m, factor)?),
        (Kind::M, Horizon::Length(d)) => Horizon::Length(d),
        (Kind::DeltaM, Horizon::Ratio(m)) if m < 2 => return Err(RefineError::FewNeighbours(m)),
        (Kind::DeltaM, Horizon::Ratio(m)) => Horizon::Ratio((f64::from(m) * root).round() as u32),
        (Kind::DeltaM, Horizon::Length(d)) => Horizon::Length(d / root),
    };
    let (low, _) = region.bounds();
    let cells = Cells {
        origin: *origin,
        edge: lattice.edges().map(|e| e * spacing),
        clip: std::array::from_fn(|a| spec.periodic[a].map(|p| low[a] + p)),
        factor: f64::from(factor),
        dimension: spec.dimension,
    };
    let region = match region {
        Region::Block { .. } => cells.whole(region)?,
        other => {
            let mut clipped = [false; 3];
            let region = cells.finer(other, &mut clipped);
            if (0..3).any(|a| spec.periodic[a].is_some() && !clipped[a]) {
                return Err(RefineError::Periodic);
            }
            region
        }
    };
    let mut fine = spec.clone();
    fine.body = BodySpec::Lattice {
        kind: *lattice,
        spacing: spacing / f64::from(factor),
        origin: *origin,
        region,
        perturb: None,
    };
    fine.horizon = horizon;
    crate::homogenize::surface::renew(&mut fine)?;
    Ok(fine)
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
    /// A block of whole cells keeps its extent, up to just below the next cell; other ends stay where they are.
    fn whole(&self, region: &Region) -> Result<Region, RefineError> {
        let Region::Block { mut low, mut high } = region.clone() else {
            return Ok(region.clone());
        };
        for a in 0..self.dimension {
            let edge = self.edge[a];
            let cells = |x: f64| (x - self.origin[a]) / edge;
            let (from, to) = (cells(low[a]), cells(high[a]));
            let eighth = |x: f64| ((x + 0.125) - (x + 0.125).round()).abs() < 1e-9;
            // blocks written as `cells` begin an eighth of a cell before the first and end as much before the next
            if self.clip[a].is_some() || (eighth(from) && eighth(to)) {
                if !(from.is_finite() && to.is_finite()) {
                    return Err(RefineError::Periodic);
                }
                let first = (from - 1e-9).ceil();
                let next = (to + 1e-9).floor() + 1.0;
                low[a] = self.origin[a] + edge * (first - 0.125 / self.factor);
                high[a] = self.origin[a] + edge * (next - 0.125 / self.factor);
            }
        }
        Ok(Region::Block { low, high })
    }

    /// Blocks that end a period end as much closer to the next as cells are smaller.
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
                    if (high[a] - (next - eighth)).abs() < 1e-6 * eighth {
                        high[a] = next - eighth / self.factor;
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
        spec.horizon = Horizon::Ratio(3);
        spec.periodic[0] = periodic.then_some(0.0);
        spec
    }

    fn ends(spec: &Spec) -> [f64; 3] {
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
                    assert_eq!(fine.horizon, Horizon::Ratio(m));
                    let [low, high, spacing] = ends(&fine);
                    assert_eq!([low, high], [0.0, 4.0]);
                    [f64::from(m) * spacing, spacing]
                })
                .collect();
            assert_eq!(Kind::of(&pairs), Some(kind));
        }
    }

    #[test]
    fn whole_cells_keep_their_extent() {
        // eight cells, written as cells, and as a periodic block with both ends
        for spec in [bar(-0.0625, 3.9375, false), bar(0.0, 3.5, true)] {
            let [low, high, spacing] = ends(&refine(&spec, Kind::Delta, 2).unwrap());
            let first = (low / spacing).ceil();
            let last = (high / spacing).floor();
            assert_eq!([first, last, spacing], [0.0, 31.0, 0.125]);
        }
    }

    #[test]
    fn periods_of_decks_are_cut_just_below_the_next() {
        let mut spec = bar(0.0, 4.0, true);
        spec.periodic[0] = Some(4.0);
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
        near.horizon = Horizon::Ratio(1);
        told(&near, Kind::DeltaM, 1, "take 2 or more");
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
