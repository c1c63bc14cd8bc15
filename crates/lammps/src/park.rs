//! The generator behind `velocity create`, `create_atoms random`, `displace_atoms random` and `set type/fraction`: the
//! minimal standard generator of Park and Miller (Communications of the ACM 31, 1988), `s ← 16807 s mod (2³¹ − 1)`.

use super::random::polar;

#[derive(Debug, Clone)]
pub struct Park {
    seed: u64,
    spare: Option<f64>,
}

const MODULUS: u64 = 2_147_483_647;

impl Park {
    /// `seed` from 1 on; anything else is `None`.
    pub fn new(seed: i64) -> Option<Park> {
        let seed = u64::try_from(seed)
            .ok()
            .filter(|s| (1..MODULUS).contains(s))?;
        Some(Park { seed, spare: None })
    }

    /// The generator of the atom at `x`: its seed is Jenkins's one-at-a-time hash of the bytes of `seed` and of the
    /// coordinates, 27 bits of it, so that an atom's numbers do not depend on any other atom.
    pub fn at(seed: i64, x: [f64; 3]) -> Park {
        let mut hash = 0u32;
        // bytes count as signed
        let mut mix = |byte: u8| {
            hash = hash.wrapping_add(i32::from(byte as i8) as u32);
            hash = hash.wrapping_add(hash << 10);
            hash ^= hash >> 6;
        };
        (seed as i32).to_ne_bytes().into_iter().for_each(&mut mix);
        for x in x {
            x.to_ne_bytes().into_iter().for_each(&mut mix);
        }
        hash = hash.wrapping_add(hash << 3);
        hash ^= hash >> 11;
        hash = hash.wrapping_add(hash << 15);
        let mut park = Park {
            seed: u64::from(hash & 0x07ff_ffff).max(1),
            spare: None,
        };
        park.skip(5);
        park
    }

    /// Throws numbers away.
    pub fn skip(&mut self, count: usize) {
        for _ in 0..count {
            self.uniform();
        }
    }

    /// Uniform in (0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.seed = self.seed * 16_807 % MODULUS;
        1.0 / MODULUS as f64 * self.seed as f64
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

    /// Park and Miller: from the seed 1 the 10,001st seed is 1043618065.
    #[test]
    fn is_the_minimal_standard() {
        let mut park = Park::new(1).unwrap();
        park.skip(10_000);
        assert_eq!(park.seed, 1_043_618_065);
        assert!(Park::new(0).is_none());
    }
}
