//! Gaps between bodies, and gaps inside one that bonds reach across.

use super::Gap;
use super::near::points_near;
use crate::body::{Body, zeros};
use crate::fracture::fragments::Fragments;
use crate::interaction::{BondStatus, Interaction};
use crate::message;
use crate::quantity::{Dimension, Message, place};
use crate::space::cells::Cells;
use crate::spec::{BodySpec, PieceSpec, Spec};
use std::collections::BTreeMap;

/// Points further apart than so many spacings are not next to each other: diagonal neighbours are up to √3 apart, the
/// other side of a missing layer is 2.
const NEXT: f64 = 1.9;
/// Bonds to the next points lead so far to one side, on the mean, of a point at a surface; 0.48 on the face of a square lattice.
const SURFACE: f64 = 0.35;
/// Cosine between a surface's normal and a bond that leads across a gap: at a right angle inside a body it is 0.71.
const FACING: f64 = 0.85;
/// Less bonds than these are a dent.
const FEW: u64 = 4;
/// Nearer than this part of a spacing, the cells of two points overlap.
const OVERLAP: f64 = 0.9;

/// The shortest distance (length) between every two bodies that come nearer to each other than `reach`. All ranks ask at once.
pub(super) fn between<const D: usize>(body: &Body<D>, reach: f64) -> Vec<([usize; 2], f64)> {
    let count = body.pieces().len();
    if count < 2 {
        return vec![];
    }
    let half = body
        .period()
        .iter()
        .flatten()
        .fold(f64::INFINITY, |m, p| m.min(0.49 * p));
    let reach = reach.min(half);
    let points = points_near(body, reach, |_| true).0;
    let x: [Vec<f64>; D] = crate::array::from_fn(|a| points.iter().map(|(.., x)| x[a]).collect());
    let slots: Vec<u32> = (0..points.len() as u32).collect();
    let mut nearest = BTreeMap::new();
    if !points.is_empty() {
        let x = crate::array::from_fn(|a| x[a].as_slice());
        let cells = Cells::new(x, &slots, body.period(), reach);
        for (i, (_, own, _)) in points.iter().enumerate() {
            cells.candidates(i, |j, square| {
                let other = points[j as usize].1;
                if *own < other && square <= reach * reach {
                    keep_least(&mut nearest, [*own, other], square);
                }
            });
        }
    }
    let found: Vec<[f64; 3]> = { nearest.into_iter() }
        .map(|([a, b], square)| [a as f64, b as f64, square])
        .collect();
    let mut nearest = BTreeMap::new();
    for [a, b, square] in body.all_of(&found).concat() {
        keep_least(&mut nearest, [a as usize, b as usize], square);
    }
    let root = |(bodies, square): ([usize; 2], f64)| (bodies, square.sqrt());
    nearest.into_iter().map(root).collect()
}

fn keep_least(nearest: &mut BTreeMap<[usize; 2], f64>, bodies: [usize; 2], square: f64) {
    let least = nearest.entry(bodies).or_insert(square);
    *least = least.min(square);
}

/// What is wrong with them.
pub(super) fn warnings(spec: &Spec, gaps: &[Gap], spacing: impl Fn(usize) -> f64) -> Vec<Message> {
    let BodySpec::Several(pieces) = &spec.body else {
        return vec![];
    };
    let name = |n: usize| pieces.get(n).map_or("", |p: &PieceSpec| p.name.as_str());
    let length = |x: f64| Dimension::LENGTH.of(x);
    let told = gaps.iter().filter_map(|gap| {
        let [a, b] = gap.bodies;
        let (own, distance) = (0.5 * (spacing(a) + spacing(b)), gap.distance);
        let bodies = format!("bodies `{}` and `{}`", name(a), name(b));
        let joined = |a: usize, b: usize| {
            let ends = [name(a), name(b)];
            let mut joints = spec.interactions.interfaces.iter();
            joints.any(|i| i.bodies.iter().all(|end| ends.contains(&end.as_str())))
        };
        if distance < OVERLAP * own {
            Some(message![
                bodies,
                " overlap: their nearest points are ",
                length(distance),
                " apart, their spacing is ",
                length(own),
            ])
        } else if joined(a, b) {
            None
        } else if spec.interactions.contact.is_none() {
            Some(message![
                bodies,
                " are ",
                length(distance),
                " apart and there is no contact: they go through each other",
            ])
        } else if distance < gap.contact {
            Some(message![
                bodies,
                " are ",
                length(distance),
                " apart, nearer than the distance of contact ",
                length(gap.contact),
                format!(
                    ": such points begin to repel when they are nearer than {} of their distance now",
                    spec.interactions.contact.as_ref().map_or(0.0, |c| c.bonded)
                ),
            ])
        } else {
            None
        }
    });
    told.collect()
}

/// The shortest of bonds that somebody found, of equally long ones that of the first points, and how many there are.
#[derive(Default)]
struct Shortest {
    bonds: u64,
    /// Length and ids of the ends.
    first: Option<(f64, [u32; 2])>,
}

impl Shortest {
    fn take(&mut self, r: f64, mut ends: [u32; 2]) {
        ends.sort_unstable();
        self.bonds += 1;
        let found = (r, ends);
        self.first = Some(self.first.map_or(found, |first| sooner(first, found)));
    }

    /// Of all ranks: how many, the length of the shortest and where its ends are. All ask at once.
    fn of_all<const D: usize>(self, body: &Body<D>) -> Option<(u64, f64, [usize; 2])> {
        let bonds = body.count(self.bonds);
        let own = self
            .first
            .map(|(r, [i, j])| [r, f64::from(i), f64::from(j)]);
        let all = body.all_of(own.as_slice()).concat().into_iter();
        let all = all.map(|[r, i, j]| (r, [i as u32, j as u32]));
        let (r, ends) = all.reduce(sooner)?;
        Some((bonds, r, ends.map(|id| id as usize)))
    }
}

fn sooner(one: (f64, [u32; 2]), other: (f64, [u32; 2])) -> (f64, [u32; 2]) {
    match one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)) {
        std::cmp::Ordering::Greater => other,
        _ => one,
    }
}

/// Whole bonds between surfaces that face each other: across a slot or hole that is narrower than the horizon. Call after bonds are cut.
pub(super) fn bridged<const D: usize>(
    body: &Body<D>,
    interaction: &dyn Interaction<D>,
) -> Option<Message> {
    let length = |s: usize| body.spacing_at(s);
    let square = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
    // mean direction to the nearest neighbours
    let mut inward = zeros::<D>(body.len());
    let mut count = vec![0u32; body.len()];
    interaction.each_partner(body, &mut |i, j, xi, _| {
        let (reach, r2) = (NEXT * length(i).max(length(j)), square(&xi));
        if r2 < reach * reach {
            let r = r2.sqrt();
            count[i] += 1;
            (0..D).for_each(|a| inward[a][i] += xi[a] / r);
        }
    });
    for &slot in body.slots() {
        let s = slot as usize;
        let size = square(&crate::array::from_fn(|a| inward[a][s])).sqrt();
        let surface = size > SURFACE * f64::from(count[s]);
        for x in &mut inward {
            x[s] = if surface { x[s] / size } else { 0.0 };
        }
    }
    body.exchange().fill_field(&mut inward);
    let id = body.id_of();
    let mut found = Shortest::default();
    interaction.each_bond(body, &mut |i, j, xi, state| {
        let along = |s: usize| (0..D).map(|a| inward[a][s] * xi[a]).sum::<f64>();
        // most points are inside
        let [from, to] = [-along(i), along(j)];
        if !(from > 0.0 && to > 0.0 && state == BondStatus::Whole) {
            return;
        }
        let r = square(&xi).sqrt();
        if from.min(to) > FACING * r && r > NEXT * length(i).max(length(j)) {
            found.take(r, [id(i), id(j)]);
        }
    });
    let (bonds, r, ends) = found.of_all(body).filter(|(bonds, ..)| *bonds >= FEW)?;
    let [from, to] = ends.map(|id| body.position_of(id));
    Some(message![
        format!(
            "{bonds} bonds reach across a gap in the body that is narrower than the horizon, the shortest of them ("
        ),
        Dimension::LENGTH.of(r),
        ") from ",
        place(&from[..D]),
        " to ",
        place(&to[..D]),
        ": for them there is no gap. Cut them by a pre-crack in its middle, or choose a smaller spacing",
    ])
}

/// Separate pieces of one body that bonds join; call before bonds are cut.
pub(super) fn across<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    interaction: &dyn Interaction<D>,
) -> Vec<Message> {
    let length = |s: usize| {
        let own = libm::pow(body.volume().at(s) / spec.space.section, 1.0 / D as f64);
        body.spacing_at(s).max(own)
    };
    let square = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
    let near = Fragments::by(body, interaction, &|i, j, xi, state| {
        let next = NEXT * length(i).max(length(j));
        state == BondStatus::Whole && square(xi) < next * next
    });
    if near.count() == 1 || near.count() == Fragments::of(body, interaction).count() {
        return vec![];
    }
    let mut label = vec![0; body.len()];
    for (l, s) in near.label.iter().zip(body.slots()) {
        label[*s as usize] = *l;
    }
    body.exchange().fill(&mut label);
    let id = body.id_of();
    let mut found = Shortest::default();
    interaction.each_bond(body, &mut |i, j, xi, state| {
        if state == BondStatus::Whole && label[i] != label[j] {
            found.take(square(&xi).sqrt(), [id(i), id(j)]);
        }
    });
    let Some((bonds, r, ends)) = found.of_all(body) else {
        return vec![];
    };
    // lengths and body are those of whoever has the points
    let of = body.whose();
    let here = ends.map(|id| of.place(id as u32).map(|n| body.slots()[n] as usize));
    let longest = here.iter().flatten().map(|s| length(*s));
    let spacing = body.most(longest.fold(0.0, f64::max));
    let piece = body.most(here[0].map_or(0.0, |s| body.piece_of(s) as f64)) as usize;
    let [from, to] = ends.map(|id| body.position_of(id));
    let of = match &spec.body {
        BodySpec::Several(pieces) => format!("body `{}`", pieces[piece].name),
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => "the body".into(),
    };
    vec![message![
        format!(
            "{of} is in separate pieces that {bonds} bonds join across a gap: the shortest of them, from "
        ),
        place(&from[..D]),
        " to ",
        place(&to[..D]),
        ", is ",
        Dimension::LENGTH.of(r),
        format!(
            " long, {:.2} spacings. If the pieces should only touch, write [[body]] for each",
            r / spacing
        ),
    ]]
}
