//! From bonds and particles to sums at points.
//!
//! Points near an atom are packed side by side, in registers of eight. Each of its bonds finds β at them and adds to sums that belong to
//! these registers; when the atom is done they are added to the points. Fused products and sums, in one order: the bits are those of any
//! instruction set.

use crate::bonds::{Bonds, WIDTH};
use crate::kernel::Kernel;
use crate::patch::{EIGHT, Patch, Runs};
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

/// Sums over bonds at the points of a patch.
#[derive(Debug)]
pub(crate) struct BondSums {
    form: Form,
    values: Vec<f64>,
}

impl BondSums {
    /// Adds them to all sums, `BOND` numbers for each part of a point.
    pub fn add_to(&self, sums: &mut [f64], index: &[u32], parts: usize) {
        let width = self.form.width();
        for (p, own) in index.iter().zip(self.values.chunks_exact(parts * width)) {
            let sums = &mut sums[*p as usize * parts * BOND..][..parts * BOND];
            for (sums, own) in sums.chunks_exact_mut(BOND).zip(own.chunks_exact(width)) {
                let own = self.form.whole(own);
                sums.iter_mut().zip(own).for_each(|(sum, x)| *sum += x);
            }
        }
    }
}

/// Points near a place, with the vectors to them, in whole registers.
#[derive(Default)]
struct Candidates {
    /// Of the points, and of the registers.
    count: usize,
    eights: usize,
    place: Vec<u32>,
    d: [Vec<f64>; 3],
    /// Lowest and highest z of each register.
    ends: Vec<[f64; 2]>,
    value: Vec<f64>,
    runs: Runs,
}

// what is compiled for an instruction set has no closures: these would be compiled for none
impl Candidates {
    #[inline(always)]
    fn find(&mut self, patch: &Patch, x: [f64; 3], reach: f64) {
        patch.near(x, reach, &mut self.runs);
        let most = self.runs.points() + 2 * EIGHT;
        if self.place.len() < most {
            self.place.resize(2 * most, 0);
            self.value.resize(2 * most, 0.0);
            for column in &mut self.d {
                column.resize(2 * most, 0.0);
            }
        }
        let x = patch.project(x);
        let mut count = 0;
        for run in &self.runs.all {
            let shift = patch.project(run.shift);
            let length = (run.to - run.from) as usize;
            // whole registers; what is too much is written over by the next
            let mut first = 0;
            while first < length {
                let (n, p) = (count + first, run.from as usize + first);
                for a in 0..3 {
                    let off = shift[a] - x[a];
                    let to = &mut self.d[a][n..n + EIGHT];
                    let from = &patch.x[a][p..p + EIGHT];
                    for k in 0..EIGHT {
                        to[k] = from[k] + off;
                    }
                }
                let place = &mut self.place[n..n + EIGHT];
                for k in 0..EIGHT {
                    place[k] = (p + k) as u32;
                }
                first += EIGHT;
            }
            count += length;
        }
        self.count = count;
        self.eights = count.div_ceil(EIGHT);
        // the last register ends with what is near nothing
        for n in count..self.eights * EIGHT {
            self.place[n] = 0;
            for column in &mut self.d {
                column[n] = 4.0 * reach;
            }
        }
    }

    #[inline(always)]
    fn measure(&mut self) {
        self.ends.clear();
        for z in self.d[2][..self.eights * EIGHT].as_chunks::<EIGHT>().0 {
            let (mut low, mut high) = (z[0], z[0]);
            for z in z {
                low = if *z < low { *z } else { low };
                high = if *z > high { *z } else { high };
            }
            self.ends.push([low, high]);
        }
    }

    /// Registers from and to before, beyond which all points are below or above.
    #[inline(always)]
    fn between(&self, low: f64, high: f64) -> [usize; 2] {
        let (mut from, mut to) = (0, self.eights);
        while from < to && !(self.ends[from][0] < high && self.ends[from][1] > low) {
            from += 1;
        }
        while to > from && !(self.ends[to - 1][0] < high && self.ends[to - 1][1] > low) {
            to -= 1;
        }
        [from, to]
    }

    /// The vectors of some registers, and room for a value of each.
    #[inline(always)]
    fn columns(&mut self, [from, to]: [usize; 2]) -> ([&[f64]; 3], &mut [f64]) {
        let (from, to) = (from * EIGHT, to * EIGHT);
        let [x, y, z] = &self.d;
        (
            [&x[from..to], &y[from..to], &z[from..to]],
            &mut self.value[from..to],
        )
    }
}

widest!(pub(crate) bonds, (kernel: &Kernel, patch: &Patch, bonds: &Bonds, parts: usize, form: Form) -> BondSums, all_bonds);
widest!(pub(crate) particles, (kernel: &Kernel, patch: &Patch, of: &Particles) -> Vec<f64>, all_particles);

/// Sums over bonds at the points of a patch.
#[inline(always)]
fn all_bonds(kernel: &Kernel, patch: &Patch, bonds: &Bonds, parts: usize, form: Form) -> BondSums {
    let mut values = vec![0.0; patch.index.len() * parts * form.width()];
    if !patch.index.is_empty() {
        match form {
            Form::Still => of_form::<Still, 6>(kernel, patch, bonds, parts, &mut values),
            Form::Moving => of_form::<Moving, 9>(kernel, patch, bonds, parts, &mut values),
            Form::Whole => of_form::<Whole, BOND>(kernel, patch, bonds, parts, &mut values),
        }
    }
    BondSums { form, values }
}

/// What is multiplied with β.
trait Numbers<const W: usize> {
    /// Of a vector and the numbers of a bond.
    fn of(d: [f64; 3], v: &[f64]) -> [f64; W];
}

struct Still;
struct Moving;
struct Whole;

impl Numbers<6> for Still {
    #[inline(always)]
    fn of(d: [f64; 3], v: &[f64]) -> [f64; 6] {
        OF_SIX.map(|[a, b]| -d[a] * v[b])
    }
}

impl Numbers<9> for Moving {
    #[inline(always)]
    fn of(d: [f64; 3], v: &[f64]) -> [f64; 9] {
        let [a, b, c, e, f, g] = Still::of(d, v);
        [a, b, c, e, f, g, d[0] * v[6], d[1] * v[6], d[2] * v[6]]
    }
}

impl Numbers<BOND> for Whole {
    #[inline(always)]
    fn of(d: [f64; 3], v: &[f64]) -> [f64; BOND] {
        let mut term = [0.0; BOND];
        for m in 0..9 {
            term[m] = -d[m / 3] * v[m % 3];
            term[12 + m] = d[m / 3] * v[3 + m % 3];
        }
        for m in 0..3 {
            term[9 + m] = d[m] * v[6];
        }
        term
    }
}

#[inline(always)]
fn of_form<T: Numbers<W>, const W: usize>(
    kernel: &Kernel,
    patch: &Patch,
    bonds: &Bonds,
    parts: usize,
    sums: &mut [f64],
) {
    let sums = sums.as_chunks_mut::<W>().0;
    let mut near = Candidates::default();
    // of each register and part
    let mut own = vec![];
    let mut first = 0;
    while first < bonds.len() {
        let some = bonds.about_one_place(first);
        let origin = bonds.origin(first);
        near.find(patch, origin, kernel.radius() + bonds.span(some.clone()));
        near.measure();
        own.clear();
        own.resize(near.eights * parts, [[0.0; EIGHT]; W]);
        first = some.end;
        if near.count == 0 {
            continue;
        }
        for n in some {
            let (end, bond) = (bonds.end[n], bonds.bond[n]);
            let mut off = [0.0; 3];
            for a in 0..3 {
                off[a] = origin[a] - end[a];
            }
            let off = patch.project(off);
            let z = patch.project(bond)[2];
            let (low, high) = if z < 0.0 { (z, 0.0) } else { (0.0, z) };
            let radius = kernel.radius();
            let [from, to] = near.between(low - off[2] - radius, high - off[2] + radius);
            let (d, out) = near.columns([from, to]);
            kernel.along(d, off, bond, out);
            for part in 0..parts {
                let term = T::of(bond, &bonds.value[(n * parts + part) * WIDTH..][..WIDTH]);
                let beta = near.value[from * EIGHT..to * EIGHT].as_chunks::<EIGHT>().0;
                let own = &mut own[part * near.eights..][from..to];
                for (own, beta) in own.iter_mut().zip(beta) {
                    add(own, &term, beta);
                }
            }
        }
        for (part, own) in own.chunks_exact(near.eights).enumerate() {
            for n in 0..near.count {
                let sums = &mut sums[near.place[n] as usize * parts + part];
                let own = &own[n / EIGHT];
                for c in 0..W {
                    sums[c] += own[c][n % EIGHT];
                }
            }
        }
    }
}

#[inline(always)]
fn add<const W: usize>(own: &mut [[f64; EIGHT]; W], term: &[f64; W], beta: &[f64; EIGHT]) {
    for c in 0..W {
        let mut all = own[c];
        for k in 0..EIGHT {
            all[k] = term[c].mul_add(beta[k], all[k]);
        }
        own[c] = all;
    }
}

/// What particles of a block add: `width` numbers each times φ, and where `slopes` is given numbers for each component of ∇φ.
pub(crate) struct Particles<'a> {
    pub position: &'a [[f64; 3]],
    pub width: usize,
    pub value: &'a [f64],
    /// What is multiplied with the components of ∇φ.
    pub slopes: Option<&'a [f64]>,
    pub slope_width: usize,
}

/// Sums over particles at the points of a patch: `width` numbers, then three for each of `slope_width`.
#[inline(always)]
fn all_particles(kernel: &Kernel, patch: &Patch, of: &Particles) -> Vec<f64> {
    let slopes = of.slopes.map_or(0, |_| 3 * of.slope_width);
    let stride = of.width + slopes;
    let mut sums = vec![0.0; patch.index.len() * stride];
    if patch.index.is_empty() {
        return sums;
    }
    let mut near = Candidates::default();
    for (n, x) in of.position.iter().enumerate() {
        near.find(patch, *x, kernel.radius());
        if let Some(all) = of.slopes {
            let own = &all[n * of.slope_width..][..of.slope_width];
            for k in 0..near.count {
                let gradient = kernel.gradient([near.d[0][k], near.d[1][k], near.d[2][k]]);
                let rest = &mut sums[near.place[k] as usize * stride + of.width..][..slopes];
                for (rest, value) in rest.chunks_exact_mut(3).zip(own) {
                    for a in 0..3 {
                        rest[a] = gradient[a].mul_add(*value, rest[a]);
                    }
                }
            }
        }
        let (d, out) = near.columns([0, near.eights]);
        kernel.values(d, out);
        let own = &of.value[n * of.width..][..of.width];
        for (place, phi) in near.place[..near.count].iter().zip(&near.value) {
            let sums = &mut sums[*place as usize * stride..][..of.width];
            for (sum, value) in sums.iter_mut().zip(own) {
                *sum = value.mul_add(*phi, *sum);
            }
        }
    }
    sums
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
                    assert!(wide.iter().any(|x| *x != 0.0), "{shape:?}");
                    assert!(wide == single, "{shape:?} {form:?}");
                }
                let particles_of = Particles {
                    position: &[[4.0, 4.1, 3.2], [3.0, 4.5, 3.3]],
                    width: 20,
                    value: &some[..40],
                    slopes: Some(&some[40..48]),
                    slope_width: 4,
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
