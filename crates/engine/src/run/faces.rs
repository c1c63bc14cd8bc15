//! The one place that knows on what area tractions, fluxes and exchanges act.

use super::reference::displacement;
use crate::body::Body;
use crate::error::BuildError;
use crate::space::Point;
use crate::space::face::{NoFace, Site, Sites};
use crate::space::lattice::{Lattice, LatticeKind};
use crate::spec::{
    BodySpec, ConditionKind, ConditionSpec, DiffusionKind, LoadMap, Members, Perturbation, Spec,
};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Part of a spacing by which points may be off the sites of a lattice.
const TOLERANCE: f64 = 1e-6;

/// Where the points of one of the bodies are.
#[derive(Debug, Clone)]
enum Origin {
    On(Lattice),
    /// Of whose sites points were moved away.
    Moved(Lattice, Perturbation),
    /// On a lattice perhaps, which is looked for.
    Given,
}

impl Origin {
    /// Where the point of an id, whose place is this, was before it was moved.
    fn home<const D: usize>(&self, id: usize, x: Point) -> Point {
        match self {
            Origin::On(_) | Origin::Given => x,
            Origin::Moved(_, p) => {
                let by = displacement::<D>(p, id);
                crate::array::from_fn(|a| x[a] - by[a])
            }
        }
    }
}

/// What faces follow from.
#[derive(Debug, Clone, Default)]
pub(super) struct Faces {
    origins: Vec<Origin>,
    /// Sets whose faces a mesh knows: the area that each of their points has.
    named: Vec<(String, Arc<[f64]>)>,
    /// Bodies end at their outer points.
    ends_at_points: bool,
    section: f64,
}

impl Faces {
    pub fn new(spec: &Spec) -> Faces {
        let origin = |body: &BodySpec| match body {
            BodySpec::Lattice {
                kind,
                spacing,
                origin,
                perturb,
                ..
            } => {
                let lattice = Lattice {
                    kind: *kind,
                    spacing: *spacing,
                    origin: *origin,
                };
                match perturb {
                    None => Origin::On(lattice),
                    Some(by) => Origin::Moved(lattice, *by),
                }
            }
            BodySpec::Sites {
                kind,
                spacing,
                origin,
                ..
            } => Origin::On(Lattice {
                kind: *kind,
                spacing: *spacing,
                origin: *origin,
            }),
            BodySpec::Cloud(_) | BodySpec::Several(_) => Origin::Given,
        };
        let origins = match &spec.body {
            BodySpec::Several(pieces) => pieces.iter().map(|p| origin(&p.body)).collect(),
            one => vec![origin(one)],
        };
        let named = { spec.sets.iter() }
            .filter_map(|set| Some((set.name.clone(), of_mesh(&spec.body, &set.members)?)))
            .collect();
        Faces {
            origins,
            named,
            ends_at_points: spec
                .bonds
                .surface
                .as_ref()
                .is_some_and(|f| f.ends_at_points()),
            section: spec.space.section,
        }
    }

    /// The share of the loaded face that each point of a set has (area), `slots` in the order of its ids.
    ///
    /// All of `given` by volume; else what the mesh says of the set; else the face of the layer that these sites of the lattice are.
    ///
    /// # Errors
    /// None of them: the area must be given.
    pub fn areas<const D: usize>(
        &self,
        body: &Body<D>,
        set: &str,
        slots: &[u32],
        given: Option<f64>,
    ) -> Result<Vec<f64>, BuildError> {
        let volume = |s: &u32| body.volume().at(*s as usize);
        if let Some(area) = given {
            let all = body.sum(slots.iter().map(volume));
            return Ok(slots.iter().map(|s| area * volume(s) / all).collect());
        }
        if let Some((_, areas)) = self.named.iter().find(|(name, _)| name == set)
            && areas.len() == slots.len()
        {
            return Ok(areas.to_vec());
        }
        if body.subdomain().is_some() {
            return self.areas_of_all(body, set, slots);
        }
        let mut areas = vec![0.0; slots.len()];
        let ids = match body.pieces() {
            [] => std::iter::once(0..body.points()).collect(),
            _ => body.ids(),
        };
        for (n, (ids, origin)) in ids.into_iter().zip(&self.origins).enumerate() {
            let own: Vec<usize> = (0..slots.len())
                .filter(|k| body.piece_of(slots[*k] as usize) == n)
                .collect();
            if own.is_empty() {
                continue;
            }
            let first = body.pieces().get(n);
            let spacing = first.map_or(body.spacing(), |p| p.body.spacing());
            let all: Vec<usize> = body.slots()[ids].iter().map(|s| *s as usize).collect();
            let points: Vec<(Point, f64)> = { all.iter().enumerate() }
                .map(|(id, s)| {
                    (
                        origin.home::<D>(id, body.position(*s)),
                        body.volume().at(*s),
                    )
                })
                .collect();
            let mut place = vec![0u32; body.len()];
            for (k, slot) in all.iter().enumerate() {
                place[*slot] = k as u32;
            }
            let members = own.iter().map(|k| place[slots[*k] as usize] as usize);
            let members: Vec<usize> = members.collect();
            let shares = self
                .shares(origin, spacing, &body.period(), &points, &members)
                .map_err(|why| unknown(set, why))?;
            for (k, share) in own.into_iter().zip(shares) {
                areas[k] = share;
            }
        }
        Ok(areas)
    }

    /// The same of lattices that ranks share: all know all points of a face, and those beside them. All ask at once.
    fn areas_of_all<const D: usize>(
        &self,
        body: &Body<D>,
        set: &str,
        slots: &[u32],
    ) -> Result<Vec<f64>, BuildError> {
        let firsts: Vec<usize> = match body.pieces() {
            [] => vec![0],
            _ => body.ids().iter().map(|ids| ids.start).collect(),
        };
        let mut areas = vec![0.0; slots.len()];
        for (n, (first, origin)) in firsts.into_iter().zip(&self.origins).enumerate() {
            let is_own = |slot: &u32| body.piece_of(*slot as usize) == n;
            let own: Vec<usize> = (0..slots.len()).filter(|k| is_own(&slots[*k])).collect();
            let here: Vec<u32> = body.slots().iter().copied().filter(is_own).collect();
            let of: Vec<u32> = own.iter().map(|k| slots[*k]).collect();
            let shares = self.areas_of_one(body, origin, first, (&here, &of));
            for (k, share) in own
                .into_iter()
                .zip(shares.map_err(|why| unknown(set, why))?)
            {
                areas[k] = share;
            }
        }
        Ok(areas)
    }

    /// Of one of the bodies, whose ids begin at `first`: the points in `slots` of those that are `here`; what is wrong with them.
    fn areas_of_one<const D: usize>(
        &self,
        body: &Body<D>,
        origin: &Origin,
        first: usize,
        (here, slots): (&[u32], &[u32]),
    ) -> Result<Vec<f64>, &'static str> {
        let ids = body.ids_of_all();
        let home = |slot: usize| origin.home::<D>(ids[slot] as usize - first, body.position(slot));
        let point = |slot: &u32| {
            let (s, [x, y, z]) = (*slot as usize, home(*slot as usize));
            [f64::from(ids[s]), x, y, z, body.volume().at(s)]
        };
        let all = |own: Vec<[f64; 5]>| body.all_of(&own).concat();
        let mut face = all(slots.iter().map(point).collect());
        if face.is_empty() {
            return Ok(vec![]);
        }
        let (Origin::On(lattice) | Origin::Moved(lattice, _)) = origin else {
            return Err("ranks have parts of it");
        };
        face.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let period = quarters(lattice, &body.period());
        let site = |x: &Point, moved: Site| -> Site {
            let q = lattice.quarter(x);
            wrapped(crate::array::from_fn(|a| q[a] + moved[a]), &period)
        };
        let members = face
            .iter()
            .map(|[_, x, y, z, _]| site(&[*x, *y, *z], [0; 3]));
        let members: HashSet<Site> = members.collect();
        // the next ones along the axes are all that matter
        let is_beside = |slot: &&u32| {
            let x = home(**slot as usize);
            let mut next = (0..D).flat_map(|a| {
                [-4, 4].map(|by| crate::array::from_fn(|b| if b == a { by } else { 0 }))
            });
            !members.contains(&site(&x, [0; 3])) && next.any(|by| members.contains(&site(&x, by)))
        };
        let beside = all(here.iter().filter(is_beside).map(point).collect());
        let points = face.iter().chain(&beside);
        let points: Vec<_> = points.map(|[_, x, y, z, v]| ([*x, *y, *z], *v)).collect();
        let numbers: Vec<usize> = (0..face.len()).collect();
        let shares = self.shares(
            origin,
            lattice.distance(),
            &body.period(),
            &points,
            &numbers,
        )?;
        let share = |slot: &u32| {
            let id = f64::from(ids[*slot as usize]);
            shares[face.partition_point(|of| of[0] < id)]
        };
        Ok(slots.iter().map(share).collect())
    }

    /// Finds the areas that tractions, fluxes and exchanges act on, of sets of a body that ranks share or will share.
    ///
    /// # Errors
    /// As of [`Faces::areas`].
    pub fn find<'a, const D: usize>(
        &mut self,
        spec: &'a Spec,
        body: &Body<D>,
        sets: &[(String, Vec<u32>)],
    ) -> Result<(), BuildError> {
        let of = |path: &'static str, conditions: &'a [ConditionSpec]| {
            conditions.iter().enumerate().filter_map(move |(n, c)| {
                let ConditionKind::Traction { area: None, .. } = &c.kind else {
                    return None;
                };
                Some((format!("{path}[{n}]"), &c.set))
            })
        };
        let before =
            { spec.run.preload.iter() }.flat_map(|p| of("preload.conditions", &p.conditions));
        let tractions = of("conditions", &spec.loading.conditions).chain(before);
        let spreads = spec.interactions.diffusions.iter().flat_map(|t| {
            t.conditions.iter().filter_map(|c| match &c.kind {
                DiffusionKind::Flux { area, .. } | DiffusionKind::Exchange { area, .. } => area
                    .is_none()
                    .then(|| (t.quantity.name().to_string(), &c.set)),
                DiffusionKind::Value(_) | DiffusionKind::Source(_) => None,
            })
        });
        for (path, set) in tractions.chain(spreads) {
            let here = |e: BuildError| e.at(path.clone());
            let (slots, _) = body.slots_of(set, sets).map_err(here)?;
            let areas = self.areas(body, set, &slots, None).map_err(here)?;
            self.named.retain(|(name, _)| name != set);
            self.named.push((set.to_string(), areas.into()));
        }
        Ok(())
    }

    /// Keeps the areas of points that are here: of each id of before, its id now.
    pub fn keep(&mut self, sets: &[(String, Vec<u32>)], here: &[Option<u32>]) {
        for (name, areas) in &mut self.named {
            let members = sets.iter().find(|(set, _)| set == name);
            let id = |k: usize| members.map_or(k, |(_, ids)| ids[k] as usize);
            let kept = (0..areas.len()).filter(|k| here[id(*k)].is_some());
            *areas = kept.map(|k| areas[k]).collect();
        }
    }

    /// The same of points of the finer body from which this one was condensed.
    pub fn condensed<const D: usize>(
        &self,
        load_map: &LoadMap<D>,
        period: &[Option<f64>; D],
        set: &str,
        members: &[u32],
        given: Option<f64>,
    ) -> Result<Vec<f64>, BuildError> {
        let volume = |p: &u32| load_map.volume[*p as usize];
        if let Some(area) = given {
            let all: f64 = members.iter().map(volume).sum();
            return Ok(members.iter().map(|p| area * volume(p) / all).collect());
        }
        let points: Vec<(Point, f64)> = { load_map.position.iter().zip(&load_map.volume) }
            .map(|(x, v)| (crate::space::full(x), *v))
            .collect();
        let members: Vec<usize> = members.iter().map(|p| *p as usize).collect();
        self.shares::<D>(&Origin::Given, load_map.spacing, period, &points, &members)
            .map_err(|why| unknown(set, why))
    }

    /// Shares of some of the points of one body, by the places that they have at [home](Origin::home); what is wrong with them.
    fn shares<const D: usize>(
        &self,
        origin: &Origin,
        spacing: f64,
        period: &[Option<f64>; D],
        points: &[(Point, f64)],
        members: &[usize],
    ) -> Result<Vec<f64>, &'static str> {
        let (lattice, sites): (Lattice, Vec<Site>) = match origin {
            Origin::On(lattice) | Origin::Moved(lattice, _) => {
                let sites = points.iter().map(|(x, _)| lattice.quarter(x));
                (*lattice, sites.collect())
            }
            Origin::Given => regular::<D>(spacing, self.section, points)
                .ok_or("its points come with volumes, and their faces are not known")?,
        };
        let period = quarters(&lattice, period);
        let set: Vec<Site> = members.iter().map(|n| sites[*n]).collect();
        // what is further away than a cell does not matter
        let bounds: [(i32, i32); D] = crate::array::from_fn(|a| {
            let ends = set.iter().map(|s| s[a]);
            ends.fold((i32::MAX, i32::MIN), |(l, h), x| (l.min(x), h.max(x)))
        });
        let near = |q: &Site| {
            (0..D).all(|a| {
                let (low, high) = bounds[a];
                period[a].is_some() || (low - 4 <= q[a] && q[a] <= high + 4)
            })
        };
        let body: HashMap<Site, f64> = { sites.iter().zip(points) }
            .filter(|(q, _)| near(q))
            .map(|(q, (_, v))| (wrapped(*q, &period), *v))
            .collect();
        let sites = Sites {
            kind: lattice.kind,
            spacing: lattice.spacing,
            body: &body,
            period,
            ends_at_points: self.ends_at_points,
        };
        sites.shares(&set).map_err(NoFace::reason)
    }
}

/// Periods (length) in quarters of the cell's edges.
fn quarters<const D: usize>(lattice: &Lattice, period: &[Option<f64>; D]) -> [Option<i32>; 3] {
    let edges = lattice.kind.edges();
    crate::array::from_fn(|a| {
        let p = (*period.get(a)?)?;
        Some((4.0 * p / (edges[a] * lattice.spacing)).round() as i32)
    })
}

/// The site within the periods (quarters) that one is an image of.
fn wrapped(q: Site, period: &[Option<i32>; 3]) -> Site {
    crate::array::from_fn(|a| period[a].map_or(q[a], |p| q[a].rem_euclid(p)))
}

/// A chain, square or cubic lattice on whose sites all these points lie, none with more than its cell.
fn regular<const D: usize>(
    spacing: f64,
    section: f64,
    points: &[(Point, f64)],
) -> Option<(Lattice, Vec<Site>)> {
    let kind = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][D - 1];
    let lattice = Lattice {
        kind,
        spacing,
        origin: points.first()?.0,
    };
    let cell = section * spacing.powi(D as i32);
    let mut largest = 0.0f64;
    let mut sites = Vec::with_capacity(points.len());
    for (x, volume) in points {
        largest = largest.max(*volume);
        let mut site = [0; 3];
        for a in 0..D {
            let cells = (x[a] - lattice.origin[a]) / spacing;
            if (cells - cells.round()).abs() > TOLERANCE * (1.0 + cells.abs()) || cells.abs() > 1e8
            {
                return None;
            }
            site[a] = 4 * cells.round() as i32;
        }
        sites.push(site);
    }
    // some point has a whole cell, else the cells are others
    ((largest / cell - 1.0).abs() < TOLERANCE).then_some((lattice, sites))
}

/// Areas that a mesh gives the points of a set of its own.
fn of_mesh(body: &BodySpec, members: &Members) -> Option<Arc<[f64]>> {
    match (body, members) {
        (BodySpec::Cloud(cloud), Members::Points(ids)) => {
            let (name, _) = cloud.sets.iter().find(|(_, set)| Arc::ptr_eq(set, ids))?;
            let faces = cloud.faces.iter().find(|(of, _)| of == name);
            faces.map(|(_, areas)| areas.clone())
        }
        (BodySpec::Several(pieces), Members::Within { body, members }) => {
            let piece = pieces.iter().find(|p| p.name == *body)?;
            of_mesh(&piece.body, members)
        }
        _ => None,
    }
}

fn unknown(set: &str, why: &str) -> BuildError {
    BuildError::missing(
        "",
        format!("the area of the face that `{set}` stands for does not follow from its points: {why}"),
    )
    .help("write `area` = the whole area of that face beside the load; a curve, surface or side set that a mesh names has its own")
}
