//! Where the points of a spec are, and what their family is.

use crate::body::Body;
use crate::body::cut::Counted;
use crate::error::BuildError;
use crate::family::stencil::{MOST, Stencil, too_many};
use crate::law::influence::mean_influence;
use crate::law::material::Partner;
use crate::law::micromodulus::Moments;
use crate::message;
use crate::quantity::Dimension;
use crate::run::agreed::agreed_among;
use crate::space::fill::{Search, fill};
use crate::space::lattice::{Lattice, LatticeKind};
use crate::space::{AXES, Point};
use crate::spec::{BodySpec, Cloud, FamilyChoice, Horizon, Perturbation, Spec};
use peridyne_comm::Comm;
use std::sync::Arc;

/// Where the points are, and what their family is; `B` is a [`Body`], or a [`Counted`] one that ranks will share.
pub(super) struct Reference<B> {
    pub body: B,
    /// The family, if it is a stencil.
    pub stencil: Option<Stencil>,
    /// Sums over a full family of the lattice that the points come from, whatever the family is.
    pub bulk: Option<Moments>,
    /// That family, of several sublattices their mean; empty where points lie on no lattice.
    pub family: Vec<Partner<3>>,
    /// Length.
    pub horizon: f64,
}

/// Distance over which the horizon cuts cells.
pub(super) fn cell<const D: usize>(spec: &Spec, body: &Body<D>) -> f64 {
    cell_of(spec, body.spacing())
}

/// The same of points of this typical distance (length).
fn cell_of(spec: &Spec, distance: f64) -> f64 {
    match &spec.body {
        BodySpec::Lattice {
            kind: LatticeKind::Cubic | LatticeKind::Square | LatticeKind::Chain,
            spacing,
            ..
        } => *spacing,
        BodySpec::Lattice {
            kind:
                LatticeKind::Triangular | LatticeKind::Bcc | LatticeKind::Fcc | LatticeKind::Diamond,
            ..
        }
        | BodySpec::Sites { .. }
        | BodySpec::Cloud(_)
        | BodySpec::Several(_) => distance,
    }
}

/// Do the points talk to those that are near now?
pub(super) fn current_neighbours(spec: &Spec) -> bool {
    spec.potential().is_some()
        && matches!(
            spec.bonds.family,
            FamilyChoice::Auto | FamilyChoice::Neighbours
        )
}

/// Sums over a full family of the lattice, averaged over the sublattices; and this family.
fn bulk_family(
    spec: &Spec,
    (lattice, volume): (&Lattice, f64),
    stencil: &Stencil,
    horizon: f64,
) -> (Moments, Vec<Partner<3>>) {
    let cell = cell_of(spec, lattice.distance());
    let mut sum = Moments {
        first: 0.0,
        second: 0.0,
        bare: 0.0,
    };
    let mut family = vec![];
    for o in stencil.offsets().iter().flatten() {
        let r0 = lattice.spacing * (o.squared as f64).sqrt() / 4.0;
        let nu = if spec.bonds.partial_volume_correction {
            crate::family::volume_fraction(r0, horizon, cell)
        } else {
            1.0
        };
        let edges = lattice.kind.edges();
        let xi: [f64; 3] =
            crate::array::from_fn(|a| 0.25 * lattice.spacing * edges[a] * f64::from(o.quarter[a]));
        let omega = mean_influence(spec.bonds.influence, &xi, r0, horizon);
        let w = nu * omega * volume / stencil.offsets().len() as f64;
        sum.bare += nu * volume / stencil.offsets().len() as f64 * r0;
        sum.first += w * r0;
        sum.second += w * r0 * r0;
        family.push(Partner {
            xi,
            omega,
            volume: nu * volume / stencil.offsets().len() as f64,
        });
    }
    (sum, family)
}

/// The lattice that a spec says.
fn lattice_of(kind: LatticeKind, spacing: f64, origin: Point) -> Result<Lattice, BuildError> {
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(BuildError::invalid(
            "body.spacing",
            format!("the spacing is {spacing}, expected a positive length"),
        ));
    }
    Ok(Lattice {
        kind,
        spacing,
        origin,
    })
}

/// The reference of a spec of one body.
pub(super) fn reference<const D: usize>(spec: &Spec) -> Result<Reference<Body<D>>, BuildError> {
    match &spec.body {
        BodySpec::Lattice {
            kind,
            spacing,
            origin,
            region,
            perturb,
        } => {
            let lattice = lattice_of(*kind, *spacing, *origin)?;
            let sites = fill(&lattice, region)?;
            let make = |reach, periodic, volume| {
                Body::on_lattice(lattice, &sites.quarters, reach, periodic, volume)
            };
            let r = on_lattice(spec, lattice, None, make, Body::period)?;
            match perturb {
                Some(p) => Ok(Reference {
                    body: perturbed(&r.body, p)?,
                    stencil: None,
                    family: vec![],
                    ..r
                }),
                None => listed_if_asked(spec, r),
            }
        }
        BodySpec::Sites {
            kind,
            spacing,
            origin,
            quarters,
            volume,
        } => {
            let lattice = Lattice {
                kind: *kind,
                spacing: *spacing,
                origin: *origin,
            };
            let make = |reach, periodic, volume| {
                Body::on_lattice(lattice, quarters, reach, periodic, volume)
            };
            let r = on_lattice(spec, lattice, *volume, make, Body::period)?;
            listed_if_asked(spec, r)
        }
        BodySpec::Cloud(cloud) => of_cloud(spec, cloud),
        BodySpec::Several(_) => Err(BuildError::unsupported(
            "body",
            "several bodies inside one of several bodies",
        )),
    }
}

/// The reference of a spec of one body, without its points where these are sites in a region.
pub(super) fn outlined<const D: usize>(
    spec: &Spec,
) -> Result<Reference<Option<Body<D>>>, BuildError> {
    let BodySpec::Lattice {
        kind,
        spacing,
        origin,
        ..
    } = &spec.body
    else {
        let r = reference(spec)?;
        return Ok(Reference {
            body: Some(r.body),
            stencil: r.stencil,
            bulk: r.bulk,
            family: r.family,
            horizon: r.horizon,
        });
    };
    let lattice = lattice_of(*kind, *spacing, *origin)?;
    // whoever has made its points has seen whether the periods fit
    on_lattice(spec, lattice, None, |_, _, _| Ok(None), |_| [None; D])
}

/// Can ranks share this one body without that one of them lists its points?
pub(super) fn countable(spec: &Spec) -> bool {
    let alone = spec.bonds.smooth.is_none()
        // how far terms between atoms reach follows from all of them
        && !(current_neighbours(spec) && spec.interactions.bonded.is_some());
    alone && matches!(spec.body, BodySpec::Lattice { .. })
}

/// The reference of a spec of one body that is [`countable`]: how many points it has where. All ranks ask at once.
pub(super) fn counted<const D: usize>(
    spec: &Spec,
    ranks: &Arc<Comm>,
) -> Result<Reference<Counted<D>>, BuildError> {
    let BodySpec::Lattice {
        kind,
        spacing,
        origin,
        region,
        perturb,
    } = &spec.body
    else {
        unreachable!("a body on a lattice");
    };
    let lattice = lattice_of(*kind, *spacing, *origin)?;
    let search = Search::new(&lattice, region)?;
    agreed_among(ranks, search.affordable(ranks.ranks()))?;
    let listed = listed(spec);
    let make = |reach, periodic, volume| {
        let reach = (reach, periodic);
        match *perturb {
            Some(p) => {
                possible(&p, lattice.distance())?;
                let moved = move |id, site: Point| {
                    let by = displacement::<D>(&p, id);
                    crate::array::from_fn(|a| site[a] + by[a])
                };
                Counted::cloud(ranks, search, reach, volume, Box::new(moved))
            }
            None if listed => {
                Counted::cloud(ranks, search, reach, volume, Box::new(|_, site| site))
            }
            None => Counted::lattice(ranks, search, reach, volume),
        }
    };
    let r = on_lattice(spec, lattice, None, make, Counted::period)?;
    Ok(match (perturb, listed) {
        (Some(_), _) => Reference {
            stencil: None,
            family: vec![],
            ..r
        },
        (None, true) => Reference { stencil: None, ..r },
        (None, false) => r,
    })
}

/// Points on sites of a lattice, each of `volume` or of that of its cell, and their stencil; `body` of cells that a bond spans, periodic axes and that volume.
fn on_lattice<const D: usize, B>(
    spec: &Spec,
    lattice: Lattice,
    volume: Option<f64>,
    body: impl FnOnce(usize, [bool; D], f64) -> Result<B, BuildError>,
    period: impl FnOnce(&B) -> [Option<f64>; D],
) -> Result<Reference<B>, BuildError> {
    let Lattice { kind, spacing, .. } = lattice;
    if kind.dimension() != D {
        return Err(BuildError::conflict(
            "body.lattice",
            format!(
                "a {} lattice has {} dimensions, the run has {D}",
                kind.name(),
                kind.dimension()
            ),
        ));
    }
    let (stencil, horizon) = stencil_of(spec, kind, spacing)?;
    let periodic: [bool; D] = crate::array::from_fn(|a| spec.space.periodic[a].is_some());
    let volume = volume.unwrap_or(kind.site_volume() * spacing.powi(D as i32) * spec.space.section);
    let body = body(stencil.reach(), periodic, volume)?;
    periods_fit(spec, period(&body))?;
    let (bulk, family) = bulk_family(spec, (&lattice, volume), &stencil, horizon);
    Ok(Reference {
        body,
        stencil: Some(stencil),
        bulk: Some(bulk),
        family,
        horizon,
    })
}

/// The family of a site, and its horizon as a length.
fn stencil_of(spec: &Spec, kind: LatticeKind, spacing: f64) -> Result<(Stencil, f64), BuildError> {
    let horizon = match current_neighbours(spec) {
        // only the lattice is wanted
        true => Horizon::Length(spacing * kind.nearest()),
        false => spec.bonds.horizon,
    };
    Stencil::fits(kind, spacing, horizon)?;
    let stencil = Stencil::new(kind, spacing, horizon);
    let horizon = horizon.length(spacing);
    if horizon < spacing * kind.nearest() {
        return Err(BuildError::conflict(
            "horizon",
            message![
                "the horizon ",
                Dimension::LENGTH.of(horizon),
                " is below the distance ",
                Dimension::LENGTH.of(spacing * kind.nearest()),
                " of nearest points",
            ],
        )
        .help("three spacings are usual: horizon = { m_ratio = 3 }"));
    }
    if stencil.bonds() > MOST {
        return Err(too_many(
            stencil.bonds() as f64,
            spec.bonds.horizon,
            horizon / spacing,
        ));
    }
    Ok((stencil, horizon))
}

/// Are the periods that somebody gave those of the lattice?
fn periods_fit<const D: usize>(spec: &Spec, period: [Option<f64>; D]) -> Result<(), BuildError> {
    for a in 0..D {
        if let (Some(given), Some(p)) = (spec.space.periodic[a], period[a])
            && given > 0.0
            && (given - p).abs() > 1e-9 * p
        {
            return Err(BuildError::conflict(
                "periodic",
                message![
                    format!("the period along {} is ", AXES[a]),
                    Dimension::LENGTH.of(given),
                    ", the lattice body repeats after ",
                    Dimension::LENGTH.of(p),
                ],
            ));
        }
    }
    Ok(())
}

/// Does the spec want lists of neighbours, wherever its points lie?
pub(super) fn listed(spec: &Spec) -> bool {
    let listed = matches!(
        spec.bonds.family,
        FamilyChoice::List | FamilyChoice::Reference
    );
    listed || !spec.interactions.pairs.is_empty() || current_neighbours(spec)
}

/// As a cloud, where the spec wants lists of neighbours.
fn listed_if_asked<const D: usize>(
    spec: &Spec,
    r: Reference<Body<D>>,
) -> Result<Reference<Body<D>>, BuildError> {
    if listed(spec) {
        Ok(Reference {
            body: r.body.to_cloud()?,
            stencil: None,
            ..r
        })
    } else {
        Ok(r)
    }
}

fn of_cloud<const D: usize>(spec: &Spec, cloud: &Cloud) -> Result<Reference<Body<D>>, BuildError> {
    if spec.bonds.family == FamilyChoice::Stencil {
        return Err(BuildError::unsupported(
            "family",
            "a stencil needs a lattice body, this is a cloud of points",
        ));
    }
    let mean =
        cloud.volume.iter().sum::<f64>() / cloud.volume.len().max(1) as f64 / spec.space.section;
    let spacing = cloud.spacing.unwrap_or(libm::pow(mean, 1.0 / D as f64));
    let period = crate::array::from_fn(|a| spec.space.periodic[a]);
    let body = Body::<D>::from_cloud(&cloud.position, &cloud.volume, &cloud.mark, spacing, period)?;
    Ok(Reference {
        body,
        stencil: None,
        bulk: None,
        family: vec![],
        horizon: spec.bonds.horizon.length(spacing),
    })
}

/// Every site moved by its [`displacement`].
fn perturbed<const D: usize>(body: &Body<D>, p: &Perturbation) -> Result<Body<D>, BuildError> {
    possible(p, body.spacing())?;
    let site = |(id, slot): (usize, &u32)| -> Point {
        let (x, by) = (body.position(*slot as usize), displacement::<D>(p, id));
        crate::array::from_fn(|a| x[a] + by[a])
    };
    let position: Vec<Point> = body.slots().iter().enumerate().map(site).collect();
    let volume = vec![body.volume().uniform().unwrap_or(1.0); position.len()];
    Body::from_cloud(
        &position,
        &volume,
        body.marks(),
        body.spacing(),
        body.period(),
    )
}

/// Sites may be moved so far.
fn possible(p: &Perturbation, spacing: f64) -> Result<(), BuildError> {
    if !(p.amplitude >= 0.0 && p.amplitude < 0.5 * spacing) {
        return Err(BuildError::invalid(
            "body.perturb",
            format!(
                "the amplitude {} must be below half the spacing {spacing}",
                p.amplitude
            ),
        ));
    }
    Ok(())
}

/// By what a site is moved, by its id: a uniform random vector in ±amplitude per axis, the same whoever asks.
pub(super) fn displacement<const D: usize>(p: &Perturbation, id: usize) -> Point {
    crate::array::from_fn(|a| match a < D {
        true => p.amplitude * (2.0 * SplitMix::number(p.seed, (D * id + a) as u64) - 1.0),
        false => 0.0,
    })
}

/// SplitMix64 (Steele, Lea & Flood 2014): a seed gives the same body on every machine.
pub(super) struct SplitMix(pub u64);

impl SplitMix {
    /// Number `n`, from 0 on, of a seed.
    pub fn number(seed: u64, n: u64) -> f64 {
        SplitMix(seed.wrapping_add(n.wrapping_mul(Self::STEP))).unit()
    }

    const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(Self::STEP);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
