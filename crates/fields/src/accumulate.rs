//! From bonds and particles to sums at points.

use crate::bonds::{Bonds, WIDTH};
use crate::kernel::Kernel;
use crate::targets::Patch;

/// Numbers that a bond adds at a point, for each part: `−x⊗f`, `x⊗E`, `x (D·v)`, times β.
pub const BOND: usize = 21;

/// Points near a segment, with the vectors to them.
#[derive(Default)]
struct Candidates {
    place: Vec<u32>,
    d: [Vec<f64>; 3],
    value: Vec<f64>,
    pieces: [Vec<[i32; 3]>; 3],
}

impl Candidates {
    fn find(&mut self, patch: &Patch, end: [f64; 3], bond: [f64; 3]) {
        let Candidates {
            place, d, pieces, ..
        } = self;
        place.clear();
        d.iter_mut().for_each(Vec::clear);
        patch.near(end, bond, pieces, |from, to, shift| {
            place.extend(from as u32..to as u32);
            for a in 0..3 {
                let off = shift[a] - end[a];
                d[a].extend(patch.x[a][from..to].iter().map(|x| x + off));
            }
        });
        self.value.clear();
        self.value.resize(self.place.len(), 0.0);
    }

    fn columns(&self) -> [&[f64]; 3] {
        [&self.d[0], &self.d[1], &self.d[2]]
    }
}

/// Sums over bonds at the points of a patch. Products and sums alone, in one order: the bits are those of any instruction set.
pub(crate) fn bonds(kernel: &Kernel, patch: &Patch, bonds: &Bonds, parts: usize) -> Vec<f64> {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: just detected
        return unsafe { with_avx2(kernel, patch, bonds, parts) };
    }
    all_bonds(kernel, patch, bonds, parts)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2(kernel: &Kernel, patch: &Patch, bonds: &Bonds, parts: usize) -> Vec<f64> {
    all_bonds(kernel, patch, bonds, parts)
}

#[inline(always)]
fn all_bonds(kernel: &Kernel, patch: &Patch, bonds: &Bonds, parts: usize) -> Vec<f64> {
    let mut sums = vec![0.0; patch.index.len() * parts * BOND];
    if patch.index.is_empty() {
        return sums;
    }
    let mut near = Candidates::default();
    let mut terms = vec![[0.0; BOND]; parts];
    for (n, (end, bond)) in bonds.end.iter().zip(&bonds.bond).enumerate() {
        near.find(patch, *end, *bond);
        if near.place.is_empty() {
            continue;
        }
        let mut value = std::mem::take(&mut near.value);
        kernel.bonds(near.columns(), *bond, &mut value);
        // how many of the numbers are not all 0: nothing churns in most potentials
        let mut whole = false;
        for (part, term) in terms.iter_mut().enumerate() {
            let v = &bonds.value[(n * parts + part) * WIDTH..][..WIDTH];
            for m in 0..9 {
                term[m] = -bond[m / 3] * v[m % 3];
                term[12 + m] = bond[m / 3] * v[3 + m % 3];
            }
            for m in 0..3 {
                term[9 + m] = bond[m] * v[6];
            }
            whole |= v[3..6].iter().any(|e| *e != 0.0);
        }
        for (place, beta) in near.place.iter().zip(&value) {
            if *beta == 0.0 {
                continue;
            }
            let sums = &mut sums[*place as usize * parts * BOND..][..parts * BOND];
            for (sums, term) in sums.chunks_exact_mut(BOND).zip(&terms) {
                match whole {
                    true => add::<BOND>(sums, term, *beta),
                    false => add::<12>(sums, term, *beta),
                }
            }
        }
        near.value = value;
    }
    sums
}

#[inline(always)]
fn add<const N: usize>(sums: &mut [f64], term: &[f64; BOND], beta: f64) {
    let sums = &mut sums[..N];
    for (sum, term) in sums.iter_mut().zip(&term[..N]) {
        *sum += beta * term;
    }
}

/// What particles of a block add: `width` numbers each times φ, and where `slopes` is given numbers for each component of ∇φ.
pub(crate) struct Particles<'a> {
    pub position: &'a [[f64; 3]],
    pub width: usize,
    pub value: &'a [f64],
    /// `[.. / slope_width][3]`: what is multiplied with ∇φ and summed over its components, or kept apart.
    pub slopes: Option<&'a [f64]>,
    pub slope_width: usize,
}

/// Sums over particles at the points of a patch: `width` numbers, then three for each of `slope_width`.
pub(crate) fn particles(kernel: &Kernel, patch: &Patch, of: &Particles) -> Vec<f64> {
    let slopes = of.slopes.map_or(0, |_| 3 * of.slope_width);
    let stride = of.width + slopes;
    let mut sums = vec![0.0; patch.index.len() * stride];
    if patch.index.is_empty() {
        return sums;
    }
    let mut near = Candidates::default();
    for (n, x) in of.position.iter().enumerate() {
        near.find(patch, *x, [0.0; 3]);
        let mut value = std::mem::take(&mut near.value);
        kernel.values(near.columns(), &mut value);
        let own = &of.value[n * of.width..][..of.width];
        for (k, (place, phi)) in near.place.iter().zip(&value).enumerate() {
            if *phi == 0.0 {
                continue;
            }
            let sums = &mut sums[*place as usize * stride..][..stride];
            for (sum, value) in sums.iter_mut().zip(own) {
                *sum += phi * value;
            }
            if let Some(all) = of.slopes {
                let gradient = kernel.gradient([near.d[0][k], near.d[1][k], near.d[2][k]]);
                let own = &all[n * of.slope_width..][..of.slope_width];
                let rest = &mut sums[of.width..];
                for (m, value) in own.iter().enumerate() {
                    for a in 0..3 {
                        rest[3 * m + a] += gradient[a] * value;
                    }
                }
            }
        }
        near.value = value;
    }
    sums
}
