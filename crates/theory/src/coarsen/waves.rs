//! How fast a coarse body vibrates against the one that it was made from (silling2010, section 7: the time scale of a level).
//!
//! Waves `exp(i k·x)` along an axis of a lattice have `ω² = K(k)/M(k)`, `K(k) = Σ_j V_i C_ij (1 − cos k·ξ_ij)`,
//! `M(k) = Σ_j M_ij cos k·ξ_ij`, exact for a point whose neighbours have the same row. Of other bodies the lowest modes are compared.

use peridyne::run::{Options, build};
use peridyne::spec::{LinearBody, Spec};
use peridyne::statics::modes::lowest;
use peridyne::statics::{SYMMETRIC, Support};
use std::f64::consts::{PI, TAU};

/// Lengths of waves that are looked at (coarse spacings).
pub const LENGTHS: [f64; 8] = [50.0, 25.0, 20.0, 16.0, 12.5, 10.0, 8.0, 5.0];
/// How far rows of neighbours may differ to count as the interior of a lattice, in parts of a row.
const ALIKE: f64 = 1e-3;
/// Modes that are compared where there are no waves.
const MODES: usize = 6;
/// Largest body whose modes are looked for (unknowns).
const MODES_LIMIT: usize = 12_000;
/// A frequency below this part of the highest that was found is that of a rigid motion.
const RIGID: f64 = 1e-3;

/// A wave along an axis of both bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    pub axis: usize,
    /// The axis along which points move.
    pub moves: usize,
    /// In coarse spacings, and as it is (length).
    pub spacings: f64,
    pub length: f64,
    /// Cycles per time.
    pub fine: f64,
    pub coarse: f64,
}

impl Wave {
    pub fn error(&self) -> f64 {
        self.coarse / self.fine - 1.0
    }
}

/// What is known of the frequencies of a coarse body.
#[derive(Debug, Clone, PartialEq)]
pub enum Frequencies {
    /// Of waves in the interior of a lattice.
    Waves(Vec<Wave>),
    /// Of the lowest modes of the free bodies (cycles per time): fine and coarse.
    Modes(Vec<[f64; 2]>),
    /// Neither, and why.
    Unknown(&'static str),
}

/// The longest stable step of velocity Verlet, `2/ω` of the greatest frequency as the engine finds it (time); `None`: nothing resists.
pub fn stable_step<const D: usize>(body: &LinearBody<D>) -> Option<f64> {
    if body.points() < 2 || body.density.iter().any(|rho| !(*rho > 0.0)) {
        return None;
    }
    let model = build(&Spec::of_linear(body), Options::default()).ok()?;
    let step = model.info().stable_step;
    step.is_finite().then_some(step)
}

/// The greatest frequency (cycles per time) that goes with a stable step.
pub fn greatest_frequency(stable_step: f64) -> f64 {
    1.0 / (PI * stable_step)
}

/// Frequencies of a coarse body against those of the finest one, some of whose points it has.
pub fn frequencies<const D: usize>(fine: &LinearBody<D>, coarse: &LinearBody<D>) -> Frequencies {
    let massive = |b: &LinearBody<D>| b.density.iter().all(|rho| *rho > 0.0);
    if !massive(fine) || !massive(coarse) {
        return Frequencies::Unknown("points without mass have no frequency");
    }
    if let Some(waves) = waves(fine, coarse) {
        return Frequencies::Waves(waves);
    }
    let asymmetric = |b: &LinearBody<D>| b.soundness().asymmetry > SYMMETRIC;
    if asymmetric(fine) || asymmetric(coarse) {
        return Frequencies::Unknown(
            "the body is no lattice that repeats about its middle, and one whose action is not reaction has no modes",
        );
    }
    if D * fine.points() > MODES_LIMIT {
        return Frequencies::Unknown(
            "the body is no lattice that repeats about its middle, and it is too large to look for its modes",
        );
    }
    match (modes(fine), modes(coarse)) {
        (Some(fine), Some(coarse)) => {
            Frequencies::Modes(fine.into_iter().zip(coarse).map(|(f, c)| [f, c]).collect())
        }
        _ => Frequencies::Unknown(
            "the body is no lattice that repeats about its middle, and its modes were not found",
        ),
    }
}

/// Frequencies of the lowest modes of a free body that are no rigid motions, lowest first.
fn modes<const D: usize>(body: &LinearBody<D>) -> Option<Vec<f64>> {
    let rigid = D * (D + 1) / 2;
    let found = lowest(body, &Support::none(body.points()), MODES + rigid).ok()?;
    let f: Vec<f64> = found.iter().map(|m| m.frequency()).collect();
    let most = f.last().copied()?;
    let mut f: Vec<f64> = f.into_iter().filter(|f| *f > RIGID * most).collect();
    f.truncate(MODES);
    Some(f)
}

/// A point in the middle of a lattice: how far its nearest neighbours along the axes are.
struct Interior<'a, const D: usize> {
    body: &'a LinearBody<D>,
    point: usize,
    spacing: [f64; D],
}

impl<'a, const D: usize> Interior<'a, D> {
    /// The point nearest to a place; `None`: its neighbours along the axes are not like it.
    fn at(body: &'a LinearBody<D>, place: [f64; D]) -> Option<Interior<'a, D>> {
        let away = |i: usize| -> f64 {
            let x = &body.position[i];
            (0..D).map(|a| (x[a] - place[a]).powi(2)).sum()
        };
        let point = (0..body.points()).min_by(|i, j| away(*i).total_cmp(&away(*j)))?;
        let mut spacing = [f64::INFINITY; D];
        let mut near = [point; D];
        for &j in body.row(point).0 {
            let xi = body.xi(point, j as usize);
            let size = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            for a in 0..D {
                if xi[a] > 0.999_999 * size && size < spacing[a] {
                    (spacing[a], near[a]) = (size, j as usize);
                }
            }
        }
        let interior = Interior {
            body,
            point,
            spacing,
        };
        let least = spacing.iter().copied().fold(f64::INFINITY, f64::min);
        let alike =
            (0..D).all(|a| spacing[a].is_finite() && interior.unlike(near[a], least) < ALIKE);
        alike.then_some(interior)
    }

    /// How much the row of another point differs from that of this one, in parts of the row.
    fn unlike(&self, other: usize, grain: f64) -> f64 {
        let key = |i: usize, j: u32| {
            let xi = self.body.xi(i, j as usize);
            xi.map(|x| (x / (1e-3 * grain)).round() as i64)
        };
        let row = |i: usize| {
            let (partners, blocks) = self.body.row(i);
            let each = partners.iter().zip(blocks);
            let volume = self.body.volume[i];
            each.map(move |(j, c)| (key(i, *j), c.map(|row| row.map(|c| volume * c))))
        };
        let mut left: std::collections::HashMap<_, _> = row(other).collect();
        let (mut off, mut size) = (0.0, 0.0);
        for (at, here) in row(self.point) {
            let there = left.remove(&at).unwrap_or([[0.0; D]; D]);
            for (h, t) in here.as_flattened().iter().zip(there.as_flattened()) {
                off += (h - t).abs();
                size += h.abs();
            }
        }
        off += left
            .values()
            .flat_map(|c| c.as_flattened())
            .map(|c| c.abs())
            .sum::<f64>();
        off / size
    }

    /// Cycles per time of a wave along an axis with points that move along another; `None`: no wave moves so.
    fn frequency(&self, axis: usize, moves: usize, length: f64) -> Option<f64> {
        let (body, i) = (self.body, self.point);
        let phase = |j: u32| TAU * body.xi(i, j as usize)[axis] / length;
        let (partners, blocks) = body.row(i);
        let mut stiff = [0.0; D];
        for (&j, c) in partners.iter().zip(blocks) {
            let part = body.volume[i] * (1.0 - libm::cos(phase(j)));
            for b in 0..D {
                stiff[b] += part * c[b][moves];
            }
        }
        let mut heavy = [0.0; D];
        match &body.mass {
            None => heavy[moves] = body.volume[i] * body.density[i],
            Some(mass) => {
                let (partners, blocks) = mass.row(i);
                for (&j, m) in partners.iter().zip(blocks) {
                    for b in 0..D {
                        heavy[b] += libm::cos(phase(j)) * m[b][moves];
                    }
                }
            }
        }
        let across = (0..D).filter(|b| *b != moves);
        let pure = across.into_iter().all(|b| {
            stiff[b].abs() < 1e-6 * stiff[moves].abs() && heavy[b].abs() < 1e-6 * heavy[moves]
        });
        let square = stiff[moves] / heavy[moves];
        (pure && square > 0.0).then(|| square.sqrt() / TAU)
    }
}

/// The part of the shapes' mass with which waves along the axes that are [`LENGTHS`]`[0]` coarse spacings long have the frequency that
/// they have in the body below; `None`: as [`waves`]. `1/ω²` goes with the mass: between that of lumped masses and of the shapes'.
pub(super) fn part<const D: usize>(
    below: &LinearBody<D>,
    [lumped, carried]: [&LinearBody<D>; 2],
) -> Option<f64> {
    let longest = |waves: Vec<Wave>| -> Vec<[f64; 2]> {
        let long = waves
            .into_iter()
            .filter(|w| w.spacings == LENGTHS[0] && w.moves == w.axis);
        long.map(|w| [w.fine.powi(-2), w.coarse.powi(-2)]).collect()
    };
    let [l, c] = [
        longest(waves(below, lumped)?),
        longest(waves(below, carried)?),
    ];
    let each = l
        .iter()
        .zip(&c)
        .map(|([fine, l], [_, c])| (l - fine) / (l - c));
    let part = each.sum::<f64>() / D as f64;
    part.is_finite().then_some(part.clamp(0.0, 1.0))
}

/// Waves along the axes; `None`: the middle of one of the bodies is not that of a lattice, or no wave moves along an axis.
fn waves<const D: usize>(fine: &LinearBody<D>, coarse: &LinearBody<D>) -> Option<Vec<Wave>> {
    let n = coarse.points() as f64;
    let middle = std::array::from_fn(|a| coarse.position.iter().map(|x| x[a]).sum::<f64>() / n);
    let coarse = Interior::at(coarse, middle)?;
    let fine = Interior::at(fine, coarse.body.position[coarse.point])?;
    let mut waves = vec![];
    for axis in 0..D {
        for moves in 0..D {
            for spacings in LENGTHS {
                let length = spacings * coarse.spacing[axis];
                waves.push(Wave {
                    axis,
                    moves,
                    spacings,
                    length,
                    fine: fine.frequency(axis, moves, length)?,
                    coarse: coarse.frequency(axis, moves, length)?,
                });
            }
        }
    }
    Some(waves)
}
