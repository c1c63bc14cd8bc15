//! From bonds and particles to sums at points.
//!
//! The bonds about a place are put side by side once. Each brick of points near it finds which of them reach it, β of these at its eight
//! points, and adds them to sums of its own. Fused products and sums, in one order: the bits are those of any instruction set.

use crate::bonds::{Bonds, WIDTH};
use crate::kernel::{Kernel, dot};
use crate::patch::{EIGHT, Lanes, NONE, Patch, Seen};
use crate::segment::View;
use crate::segments::Segments;
use crate::wide::widest;

/// Numbers that a bond adds at a point, for each part: `−x⊗f`, `x (D·v)`, `x⊗E`, times β.
pub const BOND: usize = 21;

/// Which of them there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// Central forces that do not churn, at rest: xx, yy, zz, yz, xz, xy of the stress.
    Still,
    /// The same with velocities.
    Moving,
    /// All.
    Whole,
}

/// Places of a symmetric tensor's nine components in xx, yy, zz, yz, xz, xy.
pub(crate) const SYMMETRIC: [usize; 9] = [0, 5, 4, 5, 1, 3, 4, 3, 2];
/// Rows and columns of these.
const OF_SIX: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]];

impl Form {
    /// Numbers for each part.
    fn width(self) -> usize {
        match self {
            Form::Still => 6,
            Form::Moving => 9,
            Form::Whole => BOND,
        }
    }

    /// All numbers of a part from those that there are.
    fn whole(self, sums: &[f64]) -> [f64; BOND] {
        let mut all = [0.0; BOND];
        match self {
            Form::Whole => all.copy_from_slice(&sums[..BOND]),
            Form::Still | Form::Moving => {
                (0..9).for_each(|n| all[n] = sums[SYMMETRIC[n]]);
                if self == Form::Moving {
                    all[9..12].copy_from_slice(&sums[6..9]);
                }
            }
        }
        all
    }
}

/// Sums over bonds at the points of a patch: of each brick, for each part and number, eight points.
#[derive(Debug)]
pub(crate) struct BondSums {
    form: Form,
    values: Vec<Lanes>,
}

impl BondSums {
    /// Adds them to all sums, `BOND` numbers for each part of a point.
    pub fn add_to(&self, sums: &mut [f64], index: &[u32], parts: usize) {
        let width = self.form.width();
        let mut one = vec![0.0; width];
        for (points, own) in
            { index.chunks_exact(EIGHT) }.zip(self.values.chunks_exact(parts * width))
        {
            for (k, p) in points.iter().enumerate().filter(|(_, p)| **p != NONE) {
                let sums = &mut sums[*p as usize * parts * BOND..][..parts * BOND];
                for (sums, own) in sums.chunks_exact_mut(BOND).zip(own.chunks_exact(width)) {
                    for (one, own) in one.iter_mut().zip(own) {
                        *one = own[k];
                    }
                    let own = self.form.whole(&one);
                    sums.iter_mut().zip(own).for_each(|(sum, x)| *sum += x);
                }
            }
        }
    }
}

// what is compiled for an instruction set has no closures: these would be compiled for none
widest!(pub(crate) bonds, (kernel: &Kernel, patch: &Patch, bonds: &Bonds, parts: usize, form: Form) -> BondSums, all_bonds);
widest!(pub(crate) particles, (kernel: &Kernel, patch: &Patch, of: &Particles) -> ParticleSums, all_particles);

/// What a bond multiplies with β: of its vector and its numbers.
#[inline(always)]
fn numbers(form: Form, d: [f64; 3], v: &[f64], factor: f64, out: &mut Vec<f64>) {
    let d = [factor * d[0], factor * d[1], factor * d[2]];
    match form {
        Form::Still | Form::Moving => {
            for [a, b] in OF_SIX {
                out.push(-d[a] * v[b]);
            }
        }
        Form::Whole => {
            for m in 0..9 {
                out.push(-d[m / 3] * v[m % 3]);
            }
        }
    }
    if form != Form::Still {
        for m in 0..3 {
            out.push(d[m] * v[6]);
        }
    }
    if form == Form::Whole {
        for m in 0..9 {
            out.push(d[m / 3] * v[3 + m % 3]);
        }
    }
}

/// Sums over bonds at the points of a patch.
#[inline(always)]
fn all_bonds(kernel: &Kernel, patch: &Patch, bonds: &Bonds, parts: usize, form: Form) -> BondSums {
    let width = parts * form.width();
    let mut values = vec![Lanes::ZERO; patch.bricks.len() * width];
    let mut segments = Segments::default();
    let mut terms = vec![];
    let mut seen: Vec<Seen> = vec![];
    let mut list = vec![];
    let mut beta = vec![];
    let mut first = 0;
    while first < bonds.len() {
        let some = bonds.about_one_place(first);
        let origin = patch.project(bonds.origin(first));
        let reach = kernel.radius() + bonds.span(some.clone());
        patch.near(bonds.origin(first), reach, &mut seen);
        first = some.end;
        if seen.is_empty() {
            continue;
        }
        segments.begin(kernel);
        terms.clear();
        for n in some {
            let (end, bond) = (patch.project(bonds.end[n]), bonds.bond[n]);
            let from = [end[0] - origin[0], end[1] - origin[1], end[2] - origin[2]];
            segments.add(kernel, from, patch.project(bond));
            let factor = segments.factor[segments.len() - 1];
            for part in 0..parts {
                let v = &bonds.value[(n * parts + part) * WIDTH..][..WIDTH];
                numbers(form, bond, v, factor, &mut terms);
            }
        }
        for (n, Seen { brick, shift }) in seen.iter().enumerate() {
            if n.is_multiple_of(ASKED) && patch.stopped() {
                return BondSums { form, values };
            }
            let [centre, half] = patch.middle(*brick);
            let mut from = [0.0; 3];
            let mut middle = [0.0; 3];
            for a in 0..3 {
                from[a] = origin[a] - shift[a];
                middle[a] = centre[a] - from[a];
            }
            segments.near(middle, half, &mut list);
            if list.is_empty() {
                continue;
            }
            let view = View::new(&patch.bricks[*brick as usize], from, segments.over());
            if beta.len() < list.len() {
                beta.resize(2 * list.len(), Lanes::ZERO);
            }
            let beta = &mut beta[..list.len()];
            segments.beta(kernel, &view, &list, beta);
            let own = &mut values[*brick as usize * width..][..width];
            match form {
                Form::Still => add::<6>(own, &terms, &list, beta),
                Form::Moving => add::<9>(own, &terms, &list, beta),
                Form::Whole => add::<7>(own, &terms, &list, beta),
            }
        }
    }
    BondSums { form, values }
}

/// All bonds for some numbers at a time, which then stay in registers.
#[inline(always)]
fn add<const W: usize>(own: &mut [Lanes], terms: &[f64], list: &[u32], beta: &[Lanes]) {
    let (own, terms) = (own.as_chunks_mut::<W>().0, terms.as_chunks::<W>().0);
    let pieces = own.len();
    for (c, own) in own.iter_mut().enumerate() {
        let mut sums = *own;
        for (n, beta) in list.iter().zip(beta) {
            let term = &terms[*n as usize * pieces + c];
            for c in 0..W {
                for k in 0..EIGHT {
                    sums[c][k] = term[c].mul_add(beta[k], sums[c][k]);
                }
            }
        }
        *own = sums;
    }
}

/// What particles of a block add: `width` numbers each times φ, and where they are given numbers for each component of ∇φ and of d φ, d from the particle to the point, and
/// vectors c of `(c·∇φ) d`.
pub(crate) struct Particles<'a> {
    pub position: &'a [[f64; 3]],
    pub width: usize,
    pub value: &'a [f64],
    /// What is multiplied with the components of ∇φ.
    pub slopes: Option<&'a [f64]>,
    pub slope_width: usize,
    /// What is multiplied with the components of d φ.
    pub moments: &'a [f64],
    pub moment_width: usize,
    /// Three for each particle, or none.
    pub carried: &'a [f64],
}

impl Particles<'_> {
    /// Numbers that are more than φ times something.
    fn rest(&self) -> usize {
        let slopes = self.slopes.map_or(0, |_| self.slope_width);
        let carried = usize::from(!self.carried.is_empty());
        3 * (slopes + self.moment_width + carried)
    }
}

/// Sums over particles at the points of a patch, of each brick those of eight points: `width` numbers and what fills up the last six of
/// them, then three for each of `slope_width` and of `moment_width`, and three of what is carried.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct ParticleSums {
    width: usize,
    rest: usize,
    values: Vec<Lanes>,
}

/// Bricks after which somebody may have had enough.
const ASKED: usize = 256;
/// Numbers that are summed at once.
const SIX: usize = 6;
/// Particles that look for bricks together.
const GROUP: usize = 16;

impl ParticleSums {
    fn stride(&self) -> usize {
        self.width.next_multiple_of(SIX) + self.rest
    }

    /// Adds them to all sums.
    pub fn add_to(&self, sums: &mut [f64], index: &[u32]) {
        let (stride, width) = (self.stride().max(1), self.width + self.rest);
        for (points, own) in { index.chunks_exact(EIGHT) }.zip(self.values.chunks_exact(stride)) {
            for (k, p) in points.iter().enumerate().filter(|(_, p)| **p != NONE) {
                let sums = &mut sums[*p as usize * width..][..width];
                let (times_phi, rest) = sums.split_at_mut(self.width);
                for (sum, own) in times_phi.iter_mut().zip(own) {
                    *sum += own[k];
                }
                for (sum, own) in rest.iter_mut().zip(&own[stride - self.rest..]) {
                    *sum += own[k];
                }
            }
        }
    }
}

/// Sums over particles at the points of a patch.
#[inline(always)]
fn all_particles(kernel: &Kernel, patch: &Patch, of: &Particles) -> ParticleSums {
    let mut out = ParticleSums {
        width: of.width,
        rest: of.rest(),
        values: vec![],
    };
    let stride = out.stride();
    let padded = stride - out.rest;
    out.values = vec![Lanes::ZERO; patch.bricks.len() * stride];
    let radius = kernel.radius();
    let mut seen = vec![];
    let mut list: Vec<u32> = vec![];
    let mut phi = vec![Lanes::ZERO; GROUP];
    let mut terms = vec![];
    let mut first = 0;
    while first < of.position.len() {
        let some = &of.position[first..(first + GROUP).min(of.position.len())];
        let (middle, span) = about(some);
        patch.near(middle, radius + span, &mut seen);
        terms.clear();
        for n in first..first + some.len() {
            terms.extend_from_slice(&of.value[n * of.width..][..of.width]);
            terms.resize((n + 1 - first) * padded, 0.0);
        }
        for (n, Seen { brick, shift }) in seen.iter().enumerate() {
            if n.is_multiple_of(ASKED) && patch.stopped() {
                return out;
            }
            let points = &patch.bricks[*brick as usize];
            let [centre, half] = patch.middle(*brick);
            let wide = dot(half, half).sqrt() + radius * (1.0 + 1e-9);
            list.clear();
            for (n, x) in some.iter().enumerate() {
                let x = patch.project(*x);
                let mut d = [0.0; 3];
                for a in 0..3 {
                    d[a] = centre[a] + shift[a] - x[a];
                }
                if dot(d, d) > wide * wide {
                    continue;
                }
                let mut d = [Lanes::ZERO; 3];
                for a in 0..3 {
                    let from = x[a] - shift[a];
                    for k in 0..EIGHT {
                        d[a][k] = points[a][k] - from;
                    }
                }
                kernel.values(&d, &mut phi[list.len()]);
                let here = phi[list.len()];
                list.push(n as u32);
                if out.rest == 0 {
                    continue;
                }
                let rest = &mut out.values[*brick as usize * stride + padded..][..out.rest];
                let width = of.slopes.map_or(0, |_| of.slope_width);
                let (sloped, rest) = rest.split_at_mut(3 * width);
                if let Some(all) = of.slopes {
                    let own = &all[(first + n) * width..][..width];
                    add_vectors(&gradients(kernel, &d), own, sloped);
                }
                let width = of.moment_width;
                let (moments, carried) = rest.split_at_mut(3 * width);
                if width > 0 {
                    let own = &of.moments[(first + n) * width..][..width];
                    let moment = [
                        product(d[0], here),
                        product(d[1], here),
                        product(d[2], here),
                    ];
                    add_vectors(&moment, own, moments);
                }
                if !of.carried.is_empty() {
                    let own = &of.carried[3 * (first + n)..][..3];
                    let gradient = gradients(kernel, &d);
                    for a in 0..3 {
                        for k in 0..EIGHT {
                            let mut along = 0.0;
                            for b in 0..3 {
                                along = own[b].mul_add(gradient[b][k], along);
                            }
                            carried[a][k] = along.mul_add(d[a][k], carried[a][k]);
                        }
                    }
                }
            }
            let own = &mut out.values[*brick as usize * stride..][..padded];
            add::<SIX>(own, &terms, &list, &phi[..list.len()]);
        }
        first += GROUP;
    }
    out
}

/// ∇φ at eight points.
#[inline(always)]
fn gradients(kernel: &Kernel, d: &[Lanes; 3]) -> [Lanes; 3] {
    let mut gradient = [Lanes::ZERO; 3];
    for k in 0..EIGHT {
        let one = kernel.gradient([d[0][k], d[1][k], d[2][k]]);
        for a in 0..3 {
            gradient[a][k] = one[a];
        }
    }
    gradient
}

#[inline(always)]
fn product(a: Lanes, b: Lanes) -> Lanes {
    let mut out = Lanes::ZERO;
    for k in 0..EIGHT {
        out[k] = a[k] * b[k];
    }
    out
}

/// Numbers times a vector at eight points.
#[inline(always)]
fn add_vectors(vector: &[Lanes; 3], own: &[f64], rest: &mut [Lanes]) {
    for (rest, value) in rest.as_chunks_mut::<3>().0.iter_mut().zip(own) {
        for a in 0..3 {
            for k in 0..EIGHT {
                rest[a][k] = value.mul_add(vector[a][k], rest[a][k]);
            }
        }
    }
}

/// A ball about some places: its centre and radius.
fn about(some: &[[f64; 3]]) -> ([f64; 3], f64) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for x in some {
        for a in 0..3 {
            (low[a], high[a]) = (low[a].min(x[a]), high[a].max(x[a]));
        }
    }
    let middle: [f64; 3] = std::array::from_fn(|a| 0.5 * (low[a] + high[a]));
    let mut square = 0.0f64;
    for x in some {
        let d = std::array::from_fn(|a| x[a] - middle[a]);
        square = square.max(dot(d, d));
    }
    (middle, square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Cell;
    use crate::kernel::Shape;
    use crate::targets::{Bins, Targets};

    /// Numbers from −1 to 1.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    }

    /// What this machine's widest instructions give is what single numbers give, to the last bit.
    #[test]
    fn instructions_do_not_show() {
        let seed = &mut 5u64;
        let cell = Cell::orthogonal([0.0; 3], [9.0, 8.0, 7.0], [true, true, false]).unwrap();
        let mut of = Bonds::default();
        for origin in 0..6 {
            let mut x = [4.0, 4.0, 3.0];
            x.iter_mut().for_each(|c| *c += random(seed));
            of.centre(x);
            for _ in 0..7 {
                let bond: [f64; 3] = std::array::from_fn(|_| 2.0 * random(seed));
                let end = std::array::from_fn(|a| x[a] - bond[a]);
                let n = of.add(origin, end, bond, 1) as usize;
                for v in &mut of.value[n * WIDTH..] {
                    *v = random(seed);
                }
            }
        }
        let mut some = [0.0; 60];
        some.iter_mut().for_each(|x| *x = random(seed));
        for shape in (0..=Shape::SMOOTHEST).map(Shape::Polynomial).chain([
            Shape::CubicSpline,
            Shape::Gaussian,
            Shape::Cell,
        ]) {
            let width = if shape == Shape::Gaussian { 0.3 } else { 2.3 };
            let kernel = Kernel::new(shape, width).unwrap();
            let list = (0..90).map(|_| std::array::from_fn(|_| 4.0 + 3.0 * random(seed)));
            let list = Targets::Points(list.collect());
            for targets in [Targets::Grid([13, 11, 9]), list] {
                let bins = Bins::new(&targets, &cell, &kernel).unwrap();
                let patch = Patch::of(&bins, [[0.2; 3], [0.8; 3]]);
                for form in [Form::Still, Form::Moving, Form::Whole] {
                    let [wide, single] =
                        [bonds, all_bonds].map(|run| run(&kernel, &patch, &of, 1, form).values);
                    assert!(wide.iter().any(|x| *x != Lanes::ZERO), "{shape:?}");
                    assert!(wide == single, "{shape:?} {form:?}");
                }
                let particles_of = Particles {
                    position: &[[4.0, 4.1, 3.2], [3.0, 4.5, 3.3]],
                    width: 20,
                    value: &some[..40],
                    slopes: Some(&some[40..48]),
                    slope_width: 4,
                    moments: &some[48..54],
                    moment_width: 3,
                    carried: &some[54..60],
                };
                let wide = particles(&kernel, &patch, &particles_of);
                assert!(
                    wide == all_particles(&kernel, &patch, &particles_of),
                    "{shape:?}"
                );
            }
        }
    }
}
