//! Corrections of bonds near the surface of a lattice body.
//!
//! [`SurfaceMethod::Exact`]: one factor per bond near the surface, so that *every* uniform strain is in equilibrium
//! under its own uniform traction: no residual at inner points, and at points of the surface the exact traction times
//! their area. The surface runs through the outermost points, which hold the half, quarter, eighth of a cell that lies
//! inside ([`sites`]); docs/decisions/0003-surface.md says why no such factors exist for a surface half a spacing
//! outside. The equations (`equations`) are solved for the factors nearest to 1 that are not negative ([`solve`]), one
//! unknown per kind of bond ([`neighbourhoods`]): the size of the body does not count, only how many different places
//! its surface has. State-based solids have a second factor per directed bond, of what it adds to the dilatation; these
//! may be negative, because the energy `½κθ²` is not. Conductances have a factor of their own, so that every constant gradient of a
//! temperature is steady. [`published`] has what users know already, for bond-based laws.

mod equations;
mod neighbourhoods;
mod published;
mod sites;
mod solve;

use equations::{Equations, StencilBond, conductances, equations, shares};
use neighbourhoods::{Bonds, Kinds, Neighbourhoods};
use peridyne::family::stencil::Stencil;
use peridyne::family::volume_fraction;
use peridyne::law::influence::mean_influence;
use peridyne::law::solid::eam_like::Solid;
use peridyne::message;
use peridyne::quantity::{Message, place, rounded};
use peridyne::space::fill::fill;
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::spec::{
    BodySpec, FamilyChoice, LawSpec, MaterialSpec, Spec, SurfaceFactor, SurfaceFactors,
    SurfaceMethod,
};
use sites::Sites;

/// Kinds of bonds that a quadratic programme is tried for.
const MOST_UNKNOWNS: usize = 60_000;
/// A factor this close to 1 is 1.
const ONE: f64 = 1e-15;

/// Why a body has no surface correction.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    #[error(
        "a surface correction multiplies the forces of single bonds, of pmb, springs, lps, lps_3d and eam_like: atoms have no horizon to be missing in, and the bonds of correspondence and history-dependent laws depend on their whole family"
    )]
    Law,
    #[error(
        "a surface correction of a state-based solid is known where its influence function is the same from both ends of a bond, ω(ξ) = ω(−ξ)"
    )]
    Directed,
    #[error(
        "this surface correction is for bond-based laws (pmb or springs); the bonds of a state-based solid do not act alone"
    )]
    Published,
    #[error(
        "a surface correction needs points on a chain, square or cubic lattice: a cloud has no surface that could be known exactly"
    )]
    Lattice,
    #[error(
        "{}", loose(*.count, .first)
    )]
    Loose { count: usize, first: [f64; 3] },
    #[error("the surface has {0} different kinds of bonds, more than can be solved for")]
    TooManyKinds(usize),
    #[error("{0}")]
    Build(String),
    #[error("the quadratic programme of the surface failed: {0}")]
    Solver(String),
}

fn loose(count: usize, first: &[f64; 3]) -> Message {
    message![
        format!("{count} points, the first at "),
        place(first),
        ", are corners of no whole cell: they hold nothing of the body",
    ]
}

impl SurfaceError {
    /// What it says, its numbers with what they measure.
    pub fn message(&self) -> Message {
        match self {
            SurfaceError::Loose { count, first } => loose(*count, first),
            other => other.to_string().into(),
        }
    }

    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            SurfaceError::Law => "leave surface out, or take one of these",
            SurfaceError::Directed => "leave surface out, or take pmb",
            SurfaceError::Published => "write surface = \"exact\", or take pmb",
            SurfaceError::Lattice => {
                "take a lattice body without perturbation and without family = \"list\", or leave surface out"
            }
            SurfaceError::Loose { .. } => {
                "change the region or the origin a little, so that no single point sticks out; surface = \"volume\" takes any body"
            }
            SurfaceError::TooManyKinds(_) => {
                "take a region with flat faces along the axes, or surface = \"volume\""
            }
            SurfaceError::Build(_) | SurfaceError::Solver(_) => {
                "surface = \"volume\" takes any lattice body"
            }
        }
    }
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Is every uniform strain exact?
    pub exact: bool,
    /// Bonds with an end within so many layers of an empty site were free to change.
    pub layers: i32,
    /// Kinds of bonds and of equations.
    pub unknowns: usize,
    pub equations: usize,
    /// Lowest factor that was allowed, of those that need not vanish.
    pub floor: f64,
    /// Kinds of bonds with factor 0.
    pub vanishing: usize,
    pub lowest: f64,
    pub highest: f64,
    /// Lowest and highest factor of the dilatation; of laws without one `None`.
    pub shares: Option<[f64; 2]>,
    /// Largest residual over the largest stiffness coefficient, and the point where it is left (length).
    pub residual: f64,
    pub worst: [f64; 3],
}

/// A lattice body and the bonds of a point.
struct LatticeBody {
    lattice: Lattice,
    sites: Sites,
    bonds: Vec<StencilBond>,
    /// Does the law have a dilatation?
    state_based: bool,
    /// Does anything spread through the bonds?
    conducts: bool,
}

impl LatticeBody {
    fn new(spec: &Spec) -> Result<LatticeBody, SurfaceError> {
        let solid = |m: &MaterialSpec| {
            Solid::of_law(spec.space.dimension, spec.space.plane, &m.law).is_some()
        };
        let bond_based = |m: &MaterialSpec| matches!(m.law, LawSpec::Pmb(_) | LawSpec::Springs(_));
        let state_based = spec.materials.iter().all(solid);
        if !state_based && !spec.materials.iter().all(bond_based) {
            return Err(SurfaceError::Law);
        }
        if state_based && spec.bonds.influence.is_directed() {
            return Err(SurfaceError::Directed);
        }
        if !matches!(
            spec.bonds.family,
            FamilyChoice::Auto | FamilyChoice::Stencil
        ) {
            return Err(SurfaceError::Lattice);
        }
        let (lattice, quarters) = match &spec.body {
            BodySpec::Lattice {
                kind,
                spacing,
                origin,
                region,
                perturb: None,
            } => {
                let lattice = Lattice {
                    kind: *kind,
                    spacing: *spacing,
                    origin: *origin,
                };
                let sites =
                    fill(&lattice, region).map_err(|e| SurfaceError::Build(e.to_string()))?;
                (lattice, sites.quarters)
            }
            BodySpec::Sites {
                kind,
                spacing,
                origin,
                quarters,
                ..
            } => {
                let lattice = Lattice {
                    kind: *kind,
                    spacing: *spacing,
                    origin: *origin,
                };
                (lattice, quarters.clone())
            }
            BodySpec::Lattice { .. } | BodySpec::Cloud(_) | BodySpec::Several(_) => {
                return Err(SurfaceError::Lattice);
            }
        };
        use LatticeKind::{Chain, Cubic, Square};
        if !matches!(lattice.kind, Chain | Square | Cubic) {
            return Err(SurfaceError::Lattice);
        }
        let h = lattice.spacing;
        let horizon = spec.bonds.horizon.length(h);
        let stencil = Stencil::new(lattice.kind, h, spec.bonds.horizon);
        let bonds = stencil.offsets()[0]
            .iter()
            .map(|o| {
                let r = h * (o.squared as f64).sqrt() / 4.0;
                let nu = match spec.bonds.partial_volume_correction {
                    true => volume_fraction(r, horizon, h),
                    false => 1.0,
                };
                let xi = o.cell.map(|c| h * f64::from(c));
                let omega = mean_influence(spec.bonds.influence, &xi, r, horizon);
                let (weight, length) = (nu * omega, r / h);
                StencilBond {
                    offset: o.cell,
                    weight: if state_based { weight * length } else { weight },
                    share: weight * length,
                }
            })
            .collect();
        let points: Vec<[i32; 3]> = quarters
            .iter()
            .map(|q| q.map(|q| q.div_euclid(4)))
            .collect();
        let periodic = spec.space.periodic.map(|p| p.is_some());
        Ok(LatticeBody {
            sites: Sites::new(spec.space.dimension, &points, periodic),
            lattice,
            bonds,
            state_based,
            conducts: !spec.interactions.diffusions.is_empty(),
        })
    }

    fn position(&self, place: usize) -> [f64; 3] {
        let c = self.sites.coordinates(place);
        self.lattice.position(c.map(|c| 4 * c))
    }

    fn offsets(&self) -> Vec<[i32; 3]> {
        self.bonds.iter().map(|b| b.offset).collect()
    }

    fn longest(&self) -> i32 {
        let all = self.bonds.iter().flat_map(|b| b.offset);
        all.map(i32::abs).max().unwrap_or(1)
    }

    /// Points that are corners of no whole cell.
    fn loose(&self) -> Result<(), SurfaceError> {
        let near = self.sites.near_void(1);
        let places = self.sites.place.iter().map(|p| *p as usize);
        let mut loose = places.filter(|p| near[*p] && self.sites.cell_share(*p).0 == 0.0);
        match loose.next() {
            None => Ok(()),
            Some(first) => Err(SurfaceError::Loose {
                count: 1 + loose.count(),
                first: self.position(first),
            }),
        }
    }
}

/// A system of equations that was tried.
struct Attempt {
    around: Neighbourhoods,
    kinds: Kinds,
    system: Equations,
    /// Of the factors of the dilatation, and these.
    shares: Option<(Equations, Vec<f64>)>,
    /// Factors of conductances of bonds with an end in so many layers; none where nothing spreads.
    conductances: Option<(i32, Vec<f64>)>,
    layers: i32,
}

impl Attempt {
    fn new(body: &LatticeBody, layers: i32, reach: i32) -> Attempt {
        let mut around = Neighbourhoods::new(&body.sites, reach);
        let kinds = Kinds::new(&body.sites, &around, &body.offsets());
        let system = equations(&body.sites, &body.bonds, &mut around, &kinds, layers);
        Attempt {
            around,
            kinds,
            system,
            shares: None,
            conductances: None,
            layers,
        }
    }

    /// Finds the factors of the dilatation, where there is one: are they exact?
    fn share(&mut self, body: &LatticeBody) -> bool {
        if !body.state_based {
            return true;
        }
        let around = &mut self.around;
        let system = shares(&body.sites, &body.bonds, around, &self.kinds, self.layers);
        let (x, exact) = solve::shortest(&system);
        self.shares = Some((system, x));
        exact
    }

    /// Finds the factors of conductances, where they are asked for, with as few layers as go; what they leave of the flux where none are exact.
    fn conduct(&mut self, body: &LatticeBody) -> Result<Option<f64>, SurfaceError> {
        if !body.conducts {
            return Ok(None);
        }
        for layers in 1..=self.around.reach() {
            let (sites, bonds) = (&body.sites, &body.bonds);
            let system = conductances(sites, bonds, &mut self.around, &self.kinds, layers);
            if system.unknowns > MOST_UNKNOWNS {
                break;
            }
            if let Some(found) = solve::exact(&system).map_err(SurfaceError::Solver)? {
                self.conductances = Some((layers, found.factors));
                return Ok(None);
            }
        }
        let (sites, bonds) = (&body.sites, &body.bonds);
        let system = conductances(sites, bonds, &mut self.around, &self.kinds, 1);
        let factors = solve::nearest(&system).map_err(SurfaceError::Solver)?;
        let largest = |all: &[f64]| all.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let left = largest(&system.residual(&factors)) / largest(&system.right);
        self.conductances = Some((1, factors));
        Ok(Some(left))
    }

    /// Factors of the bonds of the point at `place`.
    fn row(&mut self, body: &LatticeBody, x: &[f64], place: usize) -> Vec<SurfaceFactor> {
        let own = self.around.of(place);
        let own_near = self.around.near(own, self.layers);
        let mut row = Vec::with_capacity(body.bonds.len());
        for bond in &body.bonds {
            let mut factor = SurfaceFactor::ONE;
            if let Some(to) = body.sites.step(place, bond.offset) {
                let other = self.around.of(to);
                if own_near || self.around.near(other, self.layers) {
                    let mut class = |bonds| self.around.class(bonds, own, other, bond.offset);
                    let mutual = class(Bonds::Mutual);
                    factor.pair = x[mutual];
                    if let Some((_, y)) = &self.shares {
                        factor.share = y[class(Bonds::Directed)];
                    }
                }
                if let Some((layers, y)) = &self.conductances
                    && [own, other]
                        .iter()
                        .any(|end| self.around.near(*end, *layers))
                {
                    factor.conductance =
                        y[self.around.class(Bonds::Mutual, own, other, bond.offset)];
                }
            }
            row.push(factor);
        }
        row
    }
}

/// Factors of the bonds of a body near its surface. `exact` says what was found; the other methods find nothing.
///
/// # Errors
/// [`SurfaceError`]; a body without exact factors is not one: it gets those that leave the least residual, and a warning.
pub fn correct(
    spec: &Spec,
    method: SurfaceMethod,
) -> Result<(SurfaceFactors, Option<Report>), SurfaceError> {
    let body = LatticeBody::new(spec)?;
    if method != SurfaceMethod::Exact {
        if body.state_based {
            return Err(SurfaceError::Published);
        }
        let around = Neighbourhoods::new(&body.sites, body.longest());
        let kinds = Kinds::new(&body.sites, &around, &body.offsets());
        let row = |place: usize| {
            let row = published::row(&body.sites, &body.bonds, method, place);
            let factor = |pair| SurfaceFactor {
                pair,
                ..SurfaceFactor::ONE
            };
            row.into_iter().map(factor).collect()
        };
        return Ok((table(&body, method, &kinds, row, |_| 1.0, None), None));
    }
    body.loose()?;
    let longest = body.longest();
    let mut fewest = usize::MAX;
    for (layers, reach) in [
        (1, longest),
        (1, longest + 1),
        (2, longest.max(2)),
        (2, longest + 1),
        (longest.max(3), longest.max(3)),
    ] {
        let mut attempt = Attempt::new(&body, layers, reach);
        let unknowns = attempt.system.unknowns;
        fewest = fewest.min(unknowns);
        if unknowns > MOST_UNKNOWNS {
            continue;
        }
        if !attempt.share(&body) {
            continue;
        }
        if let Some(found) = solve::exact(&attempt.system).map_err(SurfaceError::Solver)? {
            let report = report(&body, &attempt, &found.factors, Some(found.floor));
            let warning = attempt.conduct(&body)?.map(|left| {
                format!(
                    "surface = \"exact\": no factors without negative ones make every constant gradient of this body steady; those taken leave at most {} of a flux",
                    rounded(left, 2)
                )
                .into()
            });
            return Ok((
                finish(&body, &mut attempt, &found.factors, warning),
                Some(report),
            ));
        }
    }
    if fewest > MOST_UNKNOWNS {
        return Err(SurfaceError::TooManyKinds(fewest));
    }
    let mut attempt = Attempt::new(&body, 1, longest);
    attempt.share(&body);
    let also = match attempt.conduct(&body)? {
        None => "",
        Some(_) => " (nor every constant gradient steady)",
    };
    let x = solve::nearest(&attempt.system).map_err(SurfaceError::Solver)?;
    let report = report(&body, &attempt, &x, None);
    let warning = message![
        format!(
            "surface = \"exact\": no factors without negative ones make every uniform strain of this body exact{also}; those taken leave at most {} of the stiffness, at ",
            rounded(report.residual, 2)
        ),
        place(&report.worst),
    ];
    Ok((finish(&body, &mut attempt, &x, Some(warning)), Some(report)))
}

/// The factors of a spec whose body or horizon has changed since, made anew.
///
/// # Errors
/// As [`correct`].
pub fn renew(spec: &mut Spec) -> Result<(), SurfaceError> {
    if let Some(old) = &spec.bonds.surface {
        spec.bonds.surface = Some(correct(spec, old.method)?.0);
    }
    Ok(())
}

fn report(body: &LatticeBody, attempt: &Attempt, x: &[f64], floor: Option<f64>) -> Report {
    let system = &attempt.system;
    let scale = equations::stiffness(&body.bonds)[0][0][0][0];
    let third: f64 = body.bonds.iter().map(|b| b.share * b.direction().0).sum();
    let third = third / body.sites.dimension as f64;
    let mut left = vec![(system, system.residual(x), scale)];
    left.extend((attempt.shares.iter()).map(|(system, y)| (system, system.residual(y), third)));
    let worst = left
        .iter()
        .flat_map(|(system, r, scale)| {
            let place = system.place.iter();
            r.iter().zip(place).map(move |(r, p)| (r.abs() / scale, *p))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(r, place)| (r, body.position(place as usize)));
    let (residual, worst) = worst.unwrap_or_default();
    let range = |y: &Vec<f64>| {
        let low = y.iter().copied().fold(f64::INFINITY, f64::min);
        [low, y.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
    };
    Report {
        exact: floor.is_some(),
        layers: attempt.layers,
        unknowns: system.unknowns,
        equations: system.rows.len(),
        floor: floor.unwrap_or(0.0),
        vanishing: x.iter().filter(|x| **x == 0.0).count(),
        lowest: x.iter().copied().fold(f64::INFINITY, f64::min),
        highest: x.iter().copied().fold(0.0, f64::max),
        shares: attempt.shares.as_ref().map(|(_, y)| range(y)),
        residual,
        worst,
    }
}

fn finish(
    body: &LatticeBody,
    attempt: &mut Attempt,
    x: &[f64],
    warning: Option<Message>,
) -> SurfaceFactors {
    let kinds = Kinds {
        of_point: std::mem::take(&mut attempt.kinds.of_point),
        example: std::mem::take(&mut attempt.kinds.example),
    };
    let part = |place: usize| body.sites.cell_share(place).0;
    let row = |place: usize| attempt.row(body, x, place);
    table(body, SurfaceMethod::Exact, &kinds, row, part, warning)
}

fn table(
    body: &LatticeBody,
    method: SurfaceMethod,
    kinds: &Kinds,
    mut row: impl FnMut(usize) -> Vec<SurfaceFactor>,
    part: impl Fn(usize) -> f64,
    warning: Option<Message>,
) -> SurfaceFactors {
    let mut rows = vec![vec![]];
    let mut parts = vec![1.0];
    for place in kinds.examples() {
        let factors = row(place);
        let changed = body.bonds.iter().zip(factors);
        rows.push(
            changed
                .filter(|(_, x)| {
                    let all = [x.pair, x.share, x.conductance];
                    all.iter().any(|x| (x - 1.0).abs() > ONE)
                })
                .map(|(b, x)| (b.offset, x))
                .collect(),
        );
        parts.push(part(place));
    }
    SurfaceFactors {
        method,
        row: kinds.of_point.clone(),
        rows,
        part: parts,
        warning,
    }
}

#[cfg(test)]
mod tests;
