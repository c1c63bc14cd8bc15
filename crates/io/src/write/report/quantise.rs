//! Numbers of points as codes of few bits, and codes as packed bytes that a browser unpacks.
//!
//! A number is `low + code (high − low)/(2^bits − 2)`; the last code, `2^bits − 1`, is no number. Packed are the differences of codes
//! from point to point, or from the frame before (then the bounds of both are the same), folded (0, −1, 1, −2, … become 0, 1, 2, 3, …), of wide codes first all low bytes, then all high ones.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// Codes of 16 bits: the finest that are kept.
pub const FINE: u8 = 16;

/// How many steps there are between the lowest and the highest number.
fn steps(bits: u8) -> u32 {
    (1 << bits) - 2
}

/// Components of a field over the points of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Codes {
    pub bits: u8,
    /// Of each component.
    pub low: Vec<f64>,
    pub high: Vec<f64>,
    /// The bounds of the numbers; those of the codes reach further where whole numbers keep their values.
    pub seen: Vec<[f64; 2]>,
    /// The longest vector, the largest tensor.
    pub size: f64,
    /// Are they whole numbers, which lose nothing?
    whole: bool,
    codes: Vec<Vec<u16>>,
}

impl Codes {
    /// Of `components` numbers for each point, point after point; those of symmetric tensors in VTK's order.
    pub fn of(values: &[f64], components: usize, whole: bool) -> Codes {
        let mut made = Codes {
            bits: FINE,
            low: vec![],
            high: vec![],
            seen: vec![],
            size: size(values, components),
            whole,
            codes: vec![],
        };
        let column = |c: usize| values.iter().skip(c).step_by(components);
        for c in 0..components {
            let finite = || column(c).filter(|v| v.is_finite());
            let low = finite().copied().fold(f64::INFINITY, f64::min);
            let high = finite().copied().fold(f64::NEG_INFINITY, f64::max);
            let seen = if low <= high { [low, high] } else { [0.0; 2] };
            made.seen.push(seen);
        }
        let span = |s: &[f64; 2]| s[1] - s[0];
        let widest = made.seen.iter().map(span).fold(0.0, f64::max);
        // each whole number is a code of its own
        let exact = whole && widest <= f64::from(steps(FINE));
        made.whole = exact;
        if exact && widest <= f64::from(steps(8)) {
            made.bits = 8;
        }
        let steps = f64::from(steps(made.bits));
        let none = (1u32 << made.bits) - 1;
        for (c, &[low, top]) in made.seen.iter().enumerate() {
            let high = if exact { low + steps } else { top };
            let scale = if high > low {
                steps / (high - low)
            } else {
                0.0
            };
            let code = |v: &f64| match v.is_finite() {
                true => ((v - low) * scale).round().clamp(0.0, steps) as u16,
                false => none as u16,
            };
            made.codes.push(column(c).map(code).collect());
            made.low.push(low);
            made.high.push(high);
        }
        made
    }

    /// The largest difference between a number and what its code stands for, by component.
    #[cfg(test)]
    pub fn quantum(&self, bits: u8) -> Vec<f64> {
        let bits = self.bits_of(bits);
        let each = self.low.iter().zip(&self.high);
        each.map(|(l, h)| (h - l) / f64::from(steps(bits)))
            .collect()
    }

    /// Of this many bits; whole numbers keep theirs.
    pub fn bits_of(&self, bits: u8) -> u8 {
        if self.whole { self.bits } else { bits }
    }

    /// Every point that `keep` names.
    pub fn thinned(&self, keep: &[u32]) -> Codes {
        let of = |c: &Vec<u16>| keep.iter().map(|i| c[*i as usize]).collect();
        Codes {
            codes: self.codes.iter().map(of).collect(),
            ..self.clone()
        }
    }

    /// All frames between the bounds of all, so that codes of one follow from those of the one before; `None` where that would
    /// lose too much: bounds that differ a lot.
    pub fn shared(frames: &[Codes], always: bool) -> Option<Vec<Codes>> {
        let first = frames.first().filter(|f| !f.whole)?;
        let components = first.low.len();
        let mut bounds = vec![[f64::INFINITY, f64::NEG_INFINITY]; components];
        for seen in frames.iter().flat_map(|f| f.seen.iter().enumerate()) {
            let (c, [low, high]) = seen;
            bounds[c] = [bounds[c][0].min(*low), bounds[c][1].max(*high)];
        }
        let span = |all: &[[f64; 2]]| all.iter().map(|s| s[1] - s[0]).fold(0.0, f64::max);
        let wide = |f: &&Codes| span(&f.seen) > 0.4 * span(&bounds);
        if !always && 2 * frames.iter().filter(wide).count() < frames.len() {
            return None;
        }
        Some(frames.iter().map(|f| f.between(&bounds)).collect())
    }

    /// The same numbers between other bounds.
    fn between(&self, bounds: &[[f64; 2]]) -> Codes {
        let top = f64::from(steps(FINE));
        let none = u16::MAX;
        let each = self.codes.iter().zip(&self.low).zip(&self.high);
        let codes = each.zip(bounds).map(|(((of, low), high), [from, to])| {
            let quantum = (high - low) / top;
            let scale = if to > from { top / (to - from) } else { 0.0 };
            let code = |code: &u16| match *code == none {
                true => none,
                false => {
                    let v = low + f64::from(*code) * quantum;
                    ((v - from) * scale).round().clamp(0.0, top) as u16
                }
            };
            of.iter().map(code).collect()
        });
        Codes {
            codes: codes.collect(),
            low: bounds.iter().map(|b| b[0]).collect(),
            high: bounds.iter().map(|b| b[1]).collect(),
            ..self.clone()
        }
    }

    /// Packed with `bits` for a number, as zlib: from point to point, or from the frame before, whichever is shorter; and is it
    /// the latter?
    ///
    /// # Errors
    /// None in practice: it is written to memory.
    pub fn pack(&self, bits: u8, before: Option<&Codes>) -> io::Result<(Vec<u8>, bool)> {
        let bits = self.bits_of(bits);
        let own = self.folded(bits, None)?;
        let Some(before) = before else {
            return Ok((own, false));
        };
        let after = self.folded(bits, Some(before))?;
        Ok(match after.len() < own.len() {
            true => (after, true),
            false => (own, false),
        })
    }

    fn folded(&self, bits: u8, before: Option<&Codes>) -> io::Result<Vec<u8>> {
        let mut packer = ZlibEncoder::new(vec![], Compression::new(6));
        let (mut lows, mut highs) = (vec![], vec![]);
        for (c, codes) in self.codes.iter().enumerate() {
            lows.clear();
            highs.clear();
            let mut last = 0u16;
            for (i, code) in codes.iter().enumerate() {
                let code = coarser(*code, self.bits, bits);
                if let Some(before) = before {
                    last = coarser(before.codes[c][i], before.bits, bits);
                }
                let folded = if bits > 8 {
                    let d = code.wrapping_sub(last) as i16;
                    ((d << 1) ^ (d >> 15)) as u16
                } else {
                    let d = code.wrapping_sub(last) as u8 as i8;
                    u16::from(((d << 1) ^ (d >> 7)) as u8)
                };
                last = code;
                let [low, high] = folded.to_le_bytes();
                lows.push(low);
                if bits > 8 {
                    highs.push(high);
                }
            }
            packer.write_all(&lows)?;
            packer.write_all(&highs)?;
        }
        packer.finish()
    }
}

/// A code of fewer bits for the same number.
fn coarser(code: u16, from: u8, to: u8) -> u16 {
    if from == to {
        return code;
    }
    if u32::from(code) == (1 << from) - 1 {
        return ((1u32 << to) - 1) as u16;
    }
    let (old, new) = (steps(from), steps(to));
    ((u32::from(code) * new + old / 2) / old) as u16
}

/// The largest `√Σ c²`; off the diagonal each number of a symmetric tensor stands for two.
fn size(values: &[f64], components: usize) -> f64 {
    let weight = |c: usize| if components == 6 && c > 2 { 2.0 } else { 1.0 };
    let square = |row: &[f64]| -> f64 {
        let all = row.iter().enumerate();
        all.map(|(c, x)| weight(c) * x * x).sum()
    };
    let rows = values.chunks_exact(components.max(1)).map(square);
    rows.filter(|s| s.is_finite()).fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use proptest::prelude::*;
    use std::io::Read;

    /// As the page does it.
    pub fn unpacked(bytes: &[u8], points: usize, bits: u8, low: &[f64], high: &[f64]) -> Vec<f64> {
        let mut all = vec![];
        ZlibDecoder::new(bytes).read_to_end(&mut all).unwrap();
        let wide = bits > 8;
        let none = (1u32 << bits) - 1;
        let mut out = vec![f64::NAN; points * low.len()];
        for c in 0..low.len() {
            let start = c * points * if wide { 2 } else { 1 };
            let mut code = 0u32;
            for i in 0..points {
                let high = if wide { all[start + points + i] } else { 0 };
                let z = i32::from(all[start + i]) | i32::from(high) << 8;
                let d = (z >> 1) ^ -(z & 1);
                code = (code as i32 + d) as u32 & if wide { 0xffff } else { 0xff };
                if code != none {
                    out[i * low.len() + c] = f64::from(code);
                }
            }
        }
        for (at, v) in out.iter_mut().enumerate() {
            let c = at % low.len();
            *v = low[c] + *v * (high[c] - low[c]) / f64::from(none - 1);
        }
        out
    }

    fn back(codes: &Codes, bits: u8) -> Vec<f64> {
        let n = codes.codes[0].len();
        let (bytes, _) = codes.pack(bits, None).unwrap();
        unpacked(&bytes, n, codes.bits_of(bits), &codes.low, &codes.high)
    }

    proptest! {
        #[test]
        fn numbers_come_back_within_a_quantum(values in prop::collection::vec(-1e3f64..1e3, 3..200), bits in 6u8..=16) {
            let n = values.len() / 3 * 3;
            let codes = Codes::of(&values[..n], 3, false);
            // half a quantum of each rounding
            let [fine, coarse] = [FINE, bits].map(|b| codes.quantum(b));
            for (i, (a, b)) in values[..n].iter().zip(back(&codes, bits)).enumerate() {
                let most = 0.501 * (fine[i % 3] + coarse[i % 3]) + 1e-9;
                prop_assert!((a - b).abs() <= most, "{a} {b} {most}");
            }
        }
    }

    #[test]
    fn a_frame_that_hardly_differs_follows_from_the_one_before() {
        let mut state = 1u64;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005);
            state = state.wrapping_add(1);
            (state >> 40) as f64
        };
        let first: Vec<f64> = (0..3000).map(|_| noise()).collect();
        let mut second = first.clone();
        (second[7], second[8]) = (0.0, f64::NAN);
        let frames = [&first, &second].map(|v| Codes::of(v, 1, false));
        let shared = Codes::shared(&frames, false).unwrap();
        let (own, _) = shared[1].pack(12, None).unwrap();
        let (short, after) = shared[1].pack(12, Some(&shared[0])).unwrap();
        assert!(after && short.len() * 20 < own.len(), "{}", short.len());
        assert_eq!(shared[0].low, shared[1].low);
        // bounds that differ a lot are not shared, unless they must be
        let small: Vec<f64> = first.iter().map(|v| 1e-3 * v).collect();
        let frames = [&small, &small, &first].map(|v| Codes::of(v, 1, false));
        assert!(Codes::shared(&frames, false).is_none());
        let shared = Codes::shared(&frames, true).unwrap();
        for (a, b) in small.iter().zip(back(&shared[0], 13)) {
            assert!((a - b).abs() < 0.6 * shared[0].quantum(13)[0]);
        }
    }

    #[test]
    fn whole_numbers_come_back_as_they_are() {
        for values in [vec![-1.0, 0.0, 4.0, 200.0], vec![0.0, 17.0, 60_000.0, 3.0]] {
            let codes = Codes::of(&values, 1, true);
            assert_eq!(back(&codes, 6), values);
        }
    }

    #[test]
    fn what_is_no_number_stays_none_and_a_constant_a_constant() {
        let codes = Codes::of(&[f64::NAN, 1.0, f64::INFINITY, 3.0], 1, false);
        for bits in [6, 8, 16] {
            let all = back(&codes, bits);
            assert!(all[0].is_nan() && all[2].is_nan());
            assert_eq!((all[1], all[3]), (1.0, 3.0));
        }
        let codes = Codes::of(&[2.5; 5], 1, false);
        assert_eq!(back(&codes, 8), [2.5; 5]);
    }

    #[test]
    fn sizes_are_those_of_vectors_and_tensors() {
        assert_eq!(Codes::of(&[3.0, 4.0, 0.0], 3, false).size, 5.0);
        let shear = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        assert_eq!(Codes::of(&shear, 6, false).size, 2f64.sqrt());
    }
}
