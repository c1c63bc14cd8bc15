//! Coulomb's law of one pair or one point on a surface: the elastic part of a path along a face, cut where it slips.

use crate::expression::Expression;
use crate::spec::FrictionSpec;

/// Stiffness of contact along faces over that across them: the usual choice of granular mechanics (LAMMPS, `pair_style gran`).
pub const TANGENTIAL: f64 = 2.0 / 7.0;

/// A speed of sliding over the speeds that it is the difference of, up to which it is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Coefficients of a law at a time; what is below 0 counts as 0.
#[derive(Debug, Clone, Copy, Default)]
pub struct Coefficients {
    /// μ_k
    kinetic: f64,
    /// μ_s − μ_k
    more: f64,
    /// 1/v_c
    slowness: f64,
}

impl Coefficients {
    pub fn new(law: &FrictionSpec, t: f64) -> Coefficients {
        let at = |e: &Expression| match e.eval(&[0.0; 3], t) {
            x if x < 0.0 => 0.0,
            x => x,
        };
        let kinetic = at(&law.kinetic);
        let (more, slowness) = match &law.at_rest {
            None => (0.0, 0.0),
            Some(rest) => (at(&rest.coefficient) - kinetic, 1.0 / rest.speed),
        };
        Coefficients {
            kinetic,
            more,
            slowness,
        }
    }

    /// μ at a sliding speed.
    pub fn at(&self, speed: f64) -> f64 {
        match self.more {
            0.0 => self.kinetic,
            more => self.kinetic + more * libm::exp(-speed * self.slowness),
        }
    }
}

pub fn length<const D: usize>(x: &[f64; D]) -> f64 {
    x.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// What of a way lies in a face of normal n (of length 1).
pub fn along<const D: usize>(normal: &[f64; D], way: &[f64; D]) -> [f64; D] {
    let across: f64 = (0..D).map(|a| way[a] * normal[a]).sum();
    crate::array::from_fn(|a| way[a] - across * normal[a])
}

/// The velocity of sliding along a face of normal n (of length 1); none where it is the round-off of speeds whose difference it is: what rolls
/// has no direction in which to slide.
pub fn sliding<const D: usize>(normal: &[f64; D], relative: &[f64; D], speeds: f64) -> [f64; D] {
    let w = along(normal, relative);
    match length(&w) <= ROUND_OFF * speeds {
        true => [0.0; D],
        false => w,
    }
}

/// The elastic path of what begins in touch and slides with `w`: as if it had slid before.
pub fn begun<const D: usize>(w: &[f64; D], most: f64) -> [f64; D] {
    match length(w) {
        0.0 => [0.0; D],
        speed => w.map(|c| c * most / speed),
    }
}

/// The elastic path after another piece of path along a face of normal n (of length 1), no longer than `most`, and what part of it is left.
pub fn slipped<const D: usize>(
    before: &[f64; D],
    normal: &[f64; D],
    path: &[f64; D],
    most: f64,
) -> ([f64; D], f64) {
    // what turns with the faces keeps its length
    let turned = along(normal, before);
    let kept = match length(&turned) {
        0.0 => 0.0,
        short => length(before) / short,
    };
    let path = along(normal, path);
    let way: [f64; D] = crate::array::from_fn(|a| kept * turned[a] + path[a]);
    let long = length(&way);
    match long > most {
        true => (way.map(|c| c * most / long), most / long),
        false => (way, 1.0),
    }
}

/// How the elastic path follows a small path in a face: what slips follows across its own direction alone. What pressure does to it is
/// left out, which would not be symmetric.
pub fn follows<const D: usize>(normal: &[f64; D], way: &[f64; D], kept: f64) -> [[f64; D]; D] {
    let long = length(way);
    let slips = kept < 1.0 && long > 0.0;
    crate::array::from_fn(|a| {
        crate::array::from_fn(|b| {
            let one = if a == b { 1.0 } else { 0.0 };
            let slip = if slips {
                way[a] * way[b] / (long * long)
            } else {
                0.0
            };
            kept * (one - normal[a] * normal[b] - slip)
        })
    })
}
