//! The generator behind `random()` and `normal()`: RANMAR.
//!
//! Marsaglia, Zaman and Tsang, Toward a universal random number generator (1990): a lagged Fibonacci sequence
//! (97, 33) minus an arithmetic sequence, both exact in 24 bits. LAMMPS makes one generator per run from the
//! first seed that it meets and ignores later seeds.

use peridyne::state::{Archive, Owner};

#[derive(Debug, Clone)]
pub struct Ranmar {
    u: [f64; 97],
    c: f64,
    i: usize,
    j: usize,
    spare: Option<f64>,
}

const UNIT: f64 = 16_777_216.0;

/// Two standard normal numbers of uniform ones (polar method), in the order in which LAMMPS gives them.
pub fn polar(mut uniform: impl FnMut() -> f64) -> [f64; 2] {
    loop {
        let a = 2.0 * uniform() - 1.0;
        let b = 2.0 * uniform() - 1.0;
        let r = a * a + b * b;
        if r < 1.0 && r != 0.0 {
            let f = (-2.0 * libm::log(r) / r).sqrt();
            return [b * f, a * f];
        }
    }
}

impl Default for Ranmar {
    /// One whose numbers are still to be read.
    fn default() -> Self {
        Ranmar {
            u: [0.0; 97],
            c: 0.0,
            i: 96,
            j: 32,
            spare: None,
        }
    }
}

impl Owner for Ranmar {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.all("u", &mut self.u);
        archive.one("c", &mut self.c);
        archive.one("i", &mut self.i);
        archive.one("j", &mut self.j);
        archive.one("spare", &mut self.spare);
    }
}

impl Ranmar {
    /// `seed` from 1 to 900,000,000; anything else is `None`.
    pub fn new(seed: i64) -> Option<Ranmar> {
        if !(1..=900_000_000).contains(&seed) {
            return None;
        }
        let (ij, kl) = ((seed - 1) / 30_082, (seed - 1) % 30_082);
        let mut a = [(ij / 177) % 177 + 2, ij % 177 + 2, (kl / 169) % 178 + 1];
        let mut l = kl % 169;
        let mut u = [0.0; 97];
        for slot in &mut u {
            let (mut s, mut bit) = (0.0, 0.5);
            for _ in 0..24 {
                let m = a[0] * a[1] % 179 * a[2] % 179;
                a = [a[1], a[2], m];
                l = (53 * l + 1) % 169;
                if l * m % 64 >= 32 {
                    s += bit;
                }
                bit *= 0.5;
            }
            *slot = s;
        }
        let mut generator = Ranmar {
            u,
            c: 362_436.0 / UNIT,
            i: 96,
            j: 32,
            spare: None,
        };
        generator.uniform(); // LAMMPS drops the first number
        Some(generator)
    }

    /// Uniform in (0, 1).
    pub fn uniform(&mut self) -> f64 {
        let mut x = self.u[self.i] - self.u[self.j];
        if x < 0.0 {
            x += 1.0;
        }
        self.u[self.i] = x;
        self.i = (self.i + 96) % 97;
        self.j = (self.j + 96) % 97;
        self.c -= 7_654_321.0 / UNIT;
        if self.c < 0.0 {
            self.c += 16_777_213.0 / UNIT;
        }
        x -= self.c;
        if x < 0.0 { x + 1.0 } else { x }
    }

    /// Standard normal.
    pub fn normal(&mut self) -> f64 {
        self.spare.take().unwrap_or_else(|| {
            let [now, later] = polar(|| self.uniform());
            self.spare = Some(later);
            now
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that LAMMPS (22 Jul 2025) gave for `random(0,1,12345)`, three atoms in a row.
    #[test]
    fn is_the_generator_of_lammps() {
        let mut r = Ranmar::new(12345).unwrap();
        for expected in [
            0.869_953_095_912_933_3,
            0.010_425_925_254_821_777,
            0.293_567_836_284_637_45,
        ] {
            assert_eq!(r.uniform(), expected);
        }
        assert!(Ranmar::new(0).is_none());
    }
}
