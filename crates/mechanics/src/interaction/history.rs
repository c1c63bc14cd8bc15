//! What bonds remember: the next critical stretch, and the energy of those that just broke.

use super::bond::{Crosses, Toughness, critical_stretch, relative_square_stretch};
use crate::body::Body;
use crate::columns::{Declaration, Dimension, Shape};
use crate::execute::lane::{Lane, TILE};
use crate::law::Law;

/// Name of the column of whole bonds.
pub const WHOLE: &str = "whole";
/// Column of critical values of `e`.
pub const ELONGATION: &str = "critical_elongation";
/// Critical `e` of points whose bonds never break, whatever their partners say. (∞ leaves it to them.)
pub const NEVER: f64 = f64::MAX;
/// Column of critical works of bonds, of laws that break by it.
pub const WORK: &str = "critical_bond_work";
/// Column of works that are done on bonds.
pub const DONE: &str = "bond_work";
const CRITICAL: &str = "critical_stretch";
/// Energy / volume².
const OF_BONDS: Dimension = Dimension([-4, 1, -2, 0]);

/// What peridynamic laws of bits remember; `breaks`: do bonds break?
pub fn columns(breaks: bool) -> Vec<Declaration> {
    let whole = Declaration::of_bonds(
        WHOLE,
        Dimension::NUMBER,
        "1: the bond is intact, 0: broken.",
    );
    let elongation = Declaration::of_points(
        ELONGATION,
        Shape::Scalar,
        Dimension::NUMBER,
        "e0 = s0 (2 + s0) of the critical stretch s0: what bonds are compared with, (r² − r0²)/r0².",
    );
    let critical = Declaration::of_points(
        CRITICAL,
        Shape::Scalar,
        Dimension::NUMBER,
        "Stretch s0 = s00 − α s_min beyond which a bond of the point breaks (Silling, Askari 2005); ∞: not known yet, or no bond is left.",
    );
    match breaks {
        true => vec![whole, elongation, critical.derived()],
        false => vec![whole],
    }
}

/// What laws remember whose bonds break by the work that is done on them.
pub fn of_work() -> [Declaration; 2] {
    [
        Declaration::of_bonds(
            DONE,
            OF_BONDS,
            "Work ∫ (T_i − T_j)·dη that force states have done on a bond (Foster, Silling & Chen 2011).",
        ),
        Declaration::of_points(
            WORK,
            Shape::Scalar,
            OF_BONDS,
            "Work at which a bond of the point breaks, the lower one of both ends.",
        ),
    ]
}

/// [`read_column`](super::Interaction::read_column) of critical stretches, of critical values of `e` for each slot.
pub fn read_critical<const D: usize>(
    body: &Body<D>,
    critical: &[f64],
    name: &str,
    out: &mut Vec<f64>,
) -> bool {
    out.clear();
    let of: fn(f64) -> f64 = match name {
        ELONGATION | WORK => |e| e,
        CRITICAL => |e| match e {
            NEVER => f64::INFINITY,
            e => critical_stretch(e),
        },
        _ => return false,
    };
    if critical.is_empty() {
        return false;
    }
    out.resize(body.len, 0.0);
    for &s in &body.slots {
        out[s as usize] = of(critical[s as usize]);
    }
    true
}

/// [`write_column`](super::Interaction::write_column) of the same.
pub fn write_critical<const D: usize>(
    body: &Body<D>,
    critical: &mut [f64],
    name: &str,
    values: &[f64],
) -> bool {
    if !matches!(name, ELONGATION | WORK) || critical.is_empty() || values.len() != body.len {
        return false;
    }
    for &s in &body.slots {
        critical[s as usize] = values[s as usize];
    }
    true
}

/// `e` of the bond ξ whose ends have moved by η against each other; of both directions the same bits.
pub fn relative<const D: usize>(xi: &[f64; D], eta: [f64; D]) -> f64 {
    relative_square_stretch(eta, *xi, 2.0 / xi.iter().map(|x| x * x).sum::<f64>())
}

/// Marks the bond of a lane as whole or broken.
pub fn set(bits: &mut u8, lane: usize, whole: bool) {
    match whole {
        true => *bits |= 1 << lane,
        false => *bits &= !(1 << lane),
    }
}

/// `1 − whole/family`; 0 of a point without a family.
pub fn damage(whole: f64, family: f64) -> f64 {
    if family == 0.0 {
        0.0
    } else {
        1.0 - whole / family
    }
}

/// Does a crack cross the bond ξ of a point at `from`? Through a periodic face it is in two places, and ends at `to` in the other
/// one; either end must see the same.
pub fn crossed<const D: usize>(
    crosses: &Crosses<D>,
    from: [f64; D],
    xi: [f64; D],
    to: Option<[f64; D]>,
) -> bool {
    let other = |to: [f64; D]| crosses(crate::array::from_fn(|a| to[a] - xi[a]), to);
    crosses(from, crate::array::from_fn(|a| from[a] + xi[a])) || to.is_some_and(other)
}

/// `s` of `e`.
#[inline(always)]
pub fn stretch<L: Lane>(e: L) -> L {
    let one = L::splat(1.0);
    e.div(one + (one + e).sqrt())
}

/// The critical `e` of a critical stretch.
#[inline(always)]
pub fn critical<L: Lane>(s0: L) -> L {
    L::select(
        s0.lt(L::splat(-1.0)),
        L::splat(-1.0),
        s0 * (L::splat(2.0) + s0),
    )
}

/// Ends whose bond never breaks.
#[inline(always)]
pub fn spared<L: Lane>(a: L, b: L) -> L::Mask {
    L::or(never(a), never(b))
}

/// Not a closure: what is no function of its own is made without the instruction set, and would call every operation.
#[inline(always)]
fn never<L: Lane>(x: L) -> L::Mask {
    let known = L::select(x.lt(L::splat(f64::INFINITY)), x, L::splat(0.0));
    known.ge(L::splat(NEVER))
}

/// The critical `e` of a bond from those of its ends: the lower one, unless one of them never fails.
#[inline(always)]
pub fn limit<L: Lane>(a: L, b: L) -> L {
    L::select(spared(a, b), L::splat(f64::INFINITY), a.min(b))
}

/// What points without whole bonds have: nothing, of laws without a point scalar; of those with one what they had.
/// No bond asks for it, but people do, and LAMMPS answers like this.
#[inline(always)]
pub fn alone<L: Lane, W: Law>(before: L) -> L {
    if W::SHARES {
        before
    } else {
        L::splat(f64::INFINITY)
    }
}

/// The critical `e` of `s0 = s00 − α s_min` for the points of `material(lane)`, from the lowest `e` of their whole
/// bonds (∞ where there are none: those get what is said of points that are `alone`).
#[inline(always)]
pub fn next_critical<L: Lane>(
    toughness: &[Toughness],
    material: impl Fn(usize) -> usize,
    lowest: L,
    alone: L,
) -> L {
    let smin = stretch(lowest);
    let (s00, alpha) = match toughness {
        [t] => (L::splat(t.s00), L::splat(t.alpha)),
        many => {
            let pick = |field: fn(&Toughness) -> f64| {
                let t: [f64; TILE] = crate::array::from_fn(|l| field(&many[material(l)]));
                // SAFETY: a number per lane
                unsafe { L::load(t.as_ptr()) }
            };
            (pick(|t| t.s00), pick(|t| t.alpha))
        }
    };
    let lonely = lowest.ge(L::splat(f64::INFINITY));
    let s0 = s00 - alpha * L::select(lonely, L::splat(0.0), smin);
    L::select(lonely, alone, critical(s0))
}

/// Energy density that points lose with bonds, from `Σ x` and `Σ k r0² s` over those bonds, the points' fields, their
/// pressure factor `q`, and by how much `Σ k r0² s` of the bonds that they keep grows in half a step: so long these still pull
/// with the pressure of before.
#[inline(always)]
pub fn released<L: Lane, W: Law>(q: L, own: [L; 2], lost: [L; 2], growth: L) -> L {
    if W::SHARES {
        // ½ q (S² − (S − L)²) = L P − ½ q L², with P = q S
        lost[0] + lost[1] * (own[0] + q * (growth - L::splat(0.5) * lost[1]))
    } else {
        lost[0]
    }
}
