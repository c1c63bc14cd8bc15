//! Fibre-reinforced laminae of bonds (Hu, Ha & Bobaru 2012; Oterkus & Madenci 2012; Kilic, Agwai & Madenci 2009): bonds along the fibre and all
//! others, those of the matrix, are springs with constants of their own, and break at critical stretches of their own. Each is a bond of `pmb`:
//! `T⟨ξ⟩ = ½ c ω s` along itself, `W_i = ½ Σ_j ½ c ω s² |ξ| ν V_j`, c = c_f along the fibre, else c_m.
//!
//! With the weights `w = ½ ω ν V |ξ|` of a full family a uniform strain has `C_ijkl = Σ w c n_i n_j n_k n_l`. Let axis 1 be the fibre,
//! `f = Σ w` over fibre bonds and `A_ijkl = Σ w n_i n_j n_k n_l` over the others: `C = c_m A + c_f f e₁⊗e₁⊗e₁⊗e₁`. Fibre bonds add to
//! nothing but C₁₁. Let a, d, b be `A₁₁, A₁₂, A₂₂` of a solid whose other stresses are free (the Schur complement; where the family is its own mirror image
//! about the fibre, in the plane, `Σ w n₁⁴`, `Σ w n₁² n₂²`, `Σ w n₂⁴`). Then, with these stresses free, `C₁₁ = c_f f + c_m a`, `C₁₂ = c_m d`,
//! `C₂₂ = c_m b`, and of `E₁ = C₁₁ − C₁₂²/C₂₂`, `E₂ = C₂₂ − C₁₂²/C₁₁`
//!
//! `c_m = E₂ / (b − (E₂/E₁) d²/b)`, `c_f = (E₁ − c_m (a − d²/b)) / f`.
//!
//! A ply of such bonds has two constants: `ν₁₂ = d/b` and G₁₂ follow. In the plane A₁₂₁₂ is A₁₁₂₂ (Cauchy), so `G₁₂ = ν₁₂ C₂₂`. c_f ≥ 0 is
//! `E₁ ≥ (a/b) E₂`, c_m > 0 is `E₂ < (b/d)² E₁`.
//!
//! Fibre bonds are rows of a lattice, so the sums are those of the lattice, never of the continuum, in which no bond lies along a direction.

use super::fibres::{Fibres, of_kind};
use super::non_ordinary::stiffness::PAIRS;
use super::{Along, Bond, End, Material, Partner};
use crate::columns::Dimension;
use crate::law::descriptor::{self, Bounds, Descriptor, Given, Key, Need, Registered, Value};
use crate::law::number::Number;
use crate::quantity::rounded;
use crate::space::{Point, length};
use crate::spec::{LawSpec, Parameters, Plane, PmbStiffness};

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaminaConstants {
    /// c_f, of bonds along the fibre (force / volume²).
    pub fibre: f64,
    /// c_m, of all others.
    pub matrix: f64,
    /// Of length one, along a row of the lattice.
    pub direction: Point,
    /// Stretch at which fibre bonds break; ∞: no bond breaks.
    pub critical: f64,
}

/// See the module.
#[derive(Debug, Clone)]
pub struct Lamina {
    /// Per material.
    pub materials: Vec<LaminaConstants>,
}

type Ends<'a, N, const D: usize> = End<'a, ([N; 2], [N; D]), [N; 0], [N; 0]>;

/// ½c of a bond.
#[inline(always)]
fn half<N: Number, const D: usize>(bond: &Bond<N, D>, end: &Ends<N, D>) -> N {
    let ([fibre, matrix], direction) = end.constants;
    of_kind(direction, &bond.xi, *fibre, *matrix)
}

fn in_space<const D: usize>(direction: &Point) -> [f64; D] {
    crate::array::from_fn(|a| direction[a])
}

impl<const D: usize> Material<D> for Lamina {
    /// ½c_f and ½c_m, and the fibre.
    type Constants<N: Number> = ([N; 2], [N; D]);
    type Form<N: Number> = [N; 0];
    type Sum<N: Number> = [N; 0];
    type Point<N: Number> = [N; 0];
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 0;
    const ALIKE: bool = true;

    fn constants(&self, material: usize, _: f64) -> ([f64; 2], [f64; D]) {
        let m = &self.materials[material];
        ([0.5 * m.fibre, 0.5 * m.matrix], in_space(&m.direction))
    }

    fn fibres(&self) -> Vec<Fibres<D>> {
        let of = |m: &LaminaConstants| Fibres {
            direction: in_space(&m.direction),
            critical: m.critical,
        };
        self.materials.iter().map(of).collect()
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N, D>) -> Along<N> {
        Along(half(bond, end) * bond.omega * bond.stretch * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N, D>) -> N {
        let s = bond.stretch;
        half(bond, end) * bond.omega * bond.length * (N::constant(0.5) * s * s)
    }
}

const YOUNG: &str = "young";
const FIBRE: &str = "fibre";
const CRITICAL: &str = "fibre_critical_stretch";

/// E₁ and E₂ of the keys (pressure).
fn young(parameters: &Parameters) -> Result<[f64; 2], String> {
    match parameters.list(YOUNG) {
        Some(&[along, across]) => Ok([along, across]),
        Some(_) | None => Err("a lamina needs young = [E1, E2]".into()),
    }
}

/// A row of the family along a direction, of length one.
fn row(family: &[Partner<3>], fibre: Point, d: usize) -> Result<Point, String> {
    let size = length(&fibre);
    if size == 0.0 {
        return Err("`fibre` is a direction: it cannot be 0".into());
    }
    if d == 2 && fibre[2] != 0.0 {
        return Err("`fibre` leaves the plane of the body, expected [x, y, 0]".into());
    }
    let fibre = fibre.map(|x| x / size);
    let cosine = |p: &Partner<3>| {
        let along: f64 = (0..3).map(|a| fibre[a] * p.xi[a]).sum();
        along / length(&p.xi)
    };
    // some influence functions end at 0
    let family = || family.iter().filter(|p| p.omega * p.volume > 0.0);
    let lies = |p: &&Partner<3>| of_kind(&fibre, &p.xi, 1.0, 0.0) == 1.0 && cosine(p) > 0.0;
    if let Some(bond) = family().find(lies) {
        return Ok(bond.xi.map(|x| x / length(&bond.xi)));
    }
    let mut near: Vec<&Partner<3>> = family().collect();
    // the nearest ones, each row by its shortest bond
    let by = |p: &Partner<3>| (-(1e9 * cosine(p)).round(), length(&p.xi));
    near.sort_by(|p, q| {
        by(p)
            .partial_cmp(&by(q))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    near.dedup_by(|p, q| (cosine(p) - cosine(q)).abs() < 1e-9);
    let written = near.iter().take(4).map(|p| {
        let sizes = p.xi.iter().map(|x| x.abs());
        let least = sizes.filter(|x| *x > 1e-9 * length(&p.xi));
        let unit = least.fold(f64::INFINITY, f64::min);
        let each = p.xi.map(|x| rounded(x / unit, 6));
        format!("[{}]", each.join(", "))
    });
    Err(format!(
        "no bond of a family lies along `fibre`: fibre bonds are rows of the lattice; the rows nearest to it are {}",
        written.collect::<Vec<_>>().join(", ")
    ))
}

/// Sums over a full family about the axes of the ply: f, then a, d, b.
fn sums(family: &[Partner<3>], fibre: &Point, d: usize) -> Option<[f64; 4]> {
    // axis 3 is across the ply; of fibres that are across themselves it is x
    let across = match fibre[2].abs() < 0.999 {
        true => [0.0, 0.0, 1.0],
        false => [1.0, 0.0, 0.0],
    };
    let cross = |a: &Point, b: &Point| -> Point {
        crate::array::from_fn(|k| {
            let [l, m] = [(k + 1) % 3, (k + 2) % 3];
            a[l] * b[m] - a[m] * b[l]
        })
    };
    let second = cross(&across, fibre);
    let second = second.map(|x| x / length(&second));
    let axes = [*fibre, second, cross(fibre, &second)];
    let (mut f, mut matrix) = (0.0, [[0.0; 6]; 6]);
    for p in family {
        let r = length(&p.xi);
        let w = 0.5 * p.omega * p.volume * r;
        if of_kind(fibre, &p.xi, 1.0, 0.0) == 1.0 {
            f += w;
            continue;
        }
        let n = axes.map(|e| (0..3).map(|a| e[a] * p.xi[a]).sum::<f64>() / r);
        let pair = PAIRS.map(|[i, j]| n[i] * n[j]);
        for (row, x) in matrix.iter_mut().zip(pair) {
            for (sum, y) in row.iter_mut().zip(pair) {
                *sum += w * x * y;
            }
        }
    }
    let others: &[usize] = if d == 2 { &[5] } else { &[2, 3, 4, 5] };
    for &k in others {
        let pivot = matrix[k];
        if !(pivot[k] > 0.0) {
            return None;
        }
        for row in &mut matrix {
            let part = row[k] / pivot[k];
            row.iter_mut()
                .zip(pivot)
                .for_each(|(x, of)| *x -= part * of);
        }
    }
    let [a, d, b] = [matrix[0][0], matrix[0][1], matrix[1][1]];
    (f > 0.0 && b > 0.0 && a * b > d * d).then_some([f, a, d, b])
}

/// c_f and c_m with these moduli.
fn microconstants([f, a, d, b]: [f64; 4], [along, across]: [f64; 2]) -> Result<[f64; 2], String> {
    let matrix = across / (b - across / along * d * d / b);
    if !(matrix > 0.0) {
        return Err(format!(
            "E2 is {} E1, expected less than {}: no matrix bonds have it",
            rounded(across / along, 4),
            rounded(b * b / (d * d), 4)
        ));
    }
    let fibre = (along - matrix * (a - d * d / b)) / f;
    if fibre.abs() < 1e-12 * matrix {
        return Ok([0.0, matrix]);
    }
    if !(fibre > 0.0) {
        return Err(format!(
            "E1 is {} E2, expected {} or more: bonds of the matrix alone are stiffer along the fibre, and fibre bonds would have a negative stiffness",
            rounded(along / across, 4),
            rounded(a / b, 4)
        ));
    }
    Ok([fibre, matrix])
}

fn constants(d: usize, plane: Plane, given: &Given) -> Result<LaminaConstants, String> {
    let young = young(given.parameters)?;
    if d == 2 && plane == Plane::Strain {
        return Err("a lamina is in plane stress: E1 and E2 say nothing of what is across a slice; write plane = \"stress\"".into());
    }
    if given.family.is_empty() {
        return Err("fibre bonds are rows of a lattice, and the points of this body lie on none; take `anisotropic` with gradient = \"bond\", which has a fibre on any points".into());
    }
    if given.weighted_volume.is_some() {
        return Err("in the continuum no bond lies along the fibre: constants of a lamina are sums over the lattice; leave `calibration` out".into());
    }
    let fibre = match given.parameters.list(FIBRE) {
        Some(list) => [list[0], list[1], list[2]],
        None => [1.0, 0.0, 0.0],
    };
    let direction = row(given.family, fibre, d)?;
    let sums = sums(given.family, &direction, d).ok_or(
        "bonds beside the fibre do not hold the points together in all directions; a larger horizon has more",
    )?;
    let [fibre, matrix] = microconstants(sums, young)?;
    let critical = given.parameters.number(CRITICAL);
    let critical = match (given.breaks, critical) {
        (true, Some(s)) => s,
        (false, None) => f64::INFINITY,
        (true, None) => {
            return Err(format!(
                "at which stretch do fibre bonds break? Give `{CRITICAL}`; critical_stretch of `fracture` is that of the matrix bonds"
            ));
        }
        (false, Some(_)) => {
            return Err(format!(
                "`{CRITICAL}` goes with a `fracture`: give its critical_stretch, at which matrix bonds break"
            ));
        }
    };
    Ok(LaminaConstants {
        fibre,
        matrix,
        direction,
        critical,
    })
}

impl Registered for Lamina {
    const ISOTROPIC: bool = false;
    const BOND_CLASSES: bool = true;

    fn descriptor() -> Descriptor {
        let list = |name, value, need, doc| Key {
            name,
            value,
            need,
            doc,
        };
        Descriptor::new(
            "lamina",
            "Fibre-reinforced lamina, bond-based: bonds along the fibre and all others (matrix) have a micromodulus each and break at a critical stretch each. From E1 and E2, by sums over the lattice; a ply of bonds has two constants, ν12 and G12 follow (in a plane about 1/3 and E2/(3 − E2/(3 E1)), in space 1/4 and 6 E2/(16 − E2/E1); `check` has what they come out as). On lattices, plane stress or three dimensions, with the fibre along rows of bonds.",
        )
        .source("Oterkus & Madenci 2012; Hu, Ha & Bobaru 2012; Kilic, Agwai & Madenci 2009")
        .example("{ young = [\"140 GPa\", \"10 GPa\"], fibre = [1, 0, 0], fibre_critical_stretch = 0.02 }")
        .keys(&[
            list(
                YOUNG,
                Value::List(2, Dimension::PRESSURE, Bounds::POSITIVE),
                Need::Given,
                "Young's moduli E1 along the fibre and E2 across it.",
            ),
            list(
                FIBRE,
                Value::List(3, Dimension::NUMBER, Bounds::ANY),
                Need::Optional,
                "Direction of the fibre, three numbers, along which the lattice has bonds; [1, 0, 0] by default.",
            ),
            descriptor::number(
                CRITICAL,
                Dimension::NUMBER,
                Bounds::POSITIVE,
                "Stretch at which fibre bonds break; matrix bonds break at critical_stretch of the fracture.",
            )
            .need(Need::Optional),
        ])
    }

    /// Bonds that are all alike and as stiff as these when a sheet grows in all directions: `C₁₁ + 2C₁₂ + C₂₂ = 3E` of an isotropic
    /// family, `b = 3d`. Contact alone asks for it.
    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        let [along, across] = young(parameters)?;
        let [_, matrix] = microconstants([1.0, 0.0, 1.0, 3.0], [along, across])?;
        Ok(LawSpec::Pmb(PmbStiffness::Young(
            (along + 16.0 / 3.0 * matrix) / 3.0,
        )))
    }

    fn of_one_horizon(_: &Parameters) -> Option<&'static str> {
        Some(
            "constants of a lamina are sums over the rows of a lattice, whose points have one horizon",
        )
    }

    fn make(d: usize, plane: Plane, all: &[Given]) -> Result<Self, (usize, String)> {
        let materials = descriptor::each(all, |given| constants(d, plane, given))?;
        Ok(Lamina { materials })
    }
}
