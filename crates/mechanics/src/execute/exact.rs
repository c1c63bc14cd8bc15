//! Sums that do not depend on the order of what is added: all bits are kept, and rounded once.
//!
//! A number is a multiple of 2⁻¹⁰⁷⁴ below 2¹⁰²⁴, so an integer of 2100 bits holds any sum (U. Kulisch, *Computer Arithmetic and Validity*, 2nd ed. 2013,
//! chapter 8). Its digits of 32 bits have room for carries, so that an addition touches three of them.

use peridyne_comm::Comm;

/// Digits: 2⁻¹⁰⁷⁴ to 2¹⁰²⁴, and the carries of 2⁶⁴ numbers.
const DIGITS: usize = 68;
const BITS: usize = 32;
const MASK: u128 = u32::MAX as u128;
/// Additions that a digit has room for.
const ROOM: u32 = 1 << 30;

/// A sum as it is, without a rounding.
#[derive(Debug, Clone)]
pub struct Exact {
    digits: [i64; DIGITS],
    /// The first digit that may not be 0, and the one after the last.
    low: usize,
    high: usize,
    /// Additions since carries were moved.
    added: u32,
    /// What is not a finite number.
    other: f64,
}

impl Exact {
    pub const ZERO: Exact = Exact {
        digits: [0; DIGITS],
        low: DIGITS,
        high: 0,
        added: 0,
        other: 0.0,
    };

    /// One more number.
    pub fn add(&mut self, x: f64) {
        if x == 0.0 {
            return;
        }
        if !x.is_finite() {
            self.other += x;
            return;
        }
        if self.added == ROOM {
            self.carry();
        }
        self.added += 1;
        let bits = x.to_bits();
        let (exponent, fraction) = ((bits >> 52) as usize & 0x7ff, bits & ((1 << 52) - 1));
        // subnormal numbers have no leading one
        let whole = match exponent {
            0 => fraction,
            _ => fraction | 1 << 52,
        };
        let place = exponent.max(1) - 1;
        let wide = u128::from(whole) << (place % BITS);
        let first = place / BITS;
        for n in 0..3 {
            let digit = (wide >> (BITS * n) & MASK) as i64;
            self.digits[first + n] += if x < 0.0 { -digit } else { digit };
        }
        self.low = self.low.min(first);
        self.high = self.high.max(first + 3);
    }

    /// All that another sum has.
    pub fn merge(&mut self, other: &Exact) {
        self.carry();
        let mut other = other.clone();
        other.carry();
        for n in other.low..other.high {
            self.digits[n] += other.digits[n];
        }
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
        self.added = 2;
        self.other += other.other;
    }

    /// Moves carries on, so that every digit but the last used one is from 0 to 2³² − 1.
    fn carry(&mut self) {
        let mut carry = 0;
        for n in self.low..DIGITS {
            if n >= self.high && carry == 0 {
                break;
            }
            let sum = self.digits[n] + carry;
            // a sum below 0 shows in its last digit
            let last = n + 1 == DIGITS;
            self.digits[n] = if last { sum } else { sum & MASK as i64 };
            carry = if last { 0 } else { sum >> BITS };
            self.high = self.high.max(n + 1);
        }
        self.added = 1;
    }

    /// The nearest number, the even one of two (as one addition rounds); what is not finite as its own sum.
    pub fn value(&self) -> f64 {
        if self.other != 0.0 {
            return self.other;
        }
        let mut sum = self.clone();
        sum.carry();
        let below = sum.digits[DIGITS - 1] < 0;
        if below {
            sum.digits.iter_mut().for_each(|digit| *digit = -*digit);
            sum.carry();
        }
        let Some(top) = (sum.low..sum.high).rev().find(|n| sum.digits[*n] != 0) else {
            return 0.0;
        };
        // the three highest digits, and whether there is anything below them
        let low = top.saturating_sub(2);
        let head = (low..=top)
            .rev()
            .fold(0u128, |head, n| head << BITS | sum.digits[n] as u128);
        let rest = sum.digits[..low].iter().any(|digit| *digit != 0);
        let highest = 127 - head.leading_zeros() as usize;
        // places below the 53 that a number has, of which none is below the first of all
        let cut = (highest + 1).saturating_sub(53);
        let mut bits = ((BITS * low + cut) as u64) << 52;
        bits += (head >> cut) as u64;
        if cut > 0 {
            let lost = head & ((1 << cut) - 1);
            let half = 1 << (cut - 1);
            if lost > half || lost == half && (rest || bits & 1 == 1) {
                bits += 1;
            }
        }
        // what is beyond the largest number is infinite
        let value = f64::from_bits(bits.min(f64::INFINITY.to_bits()));
        if below { -value } else { value }
    }

    /// One number less.
    pub fn take(&mut self, x: f64) {
        self.add(-x);
    }

    /// Numbers whose sum it is: the nearest one, what is nearest to the rest, and so on; few, as long as what was added is of like size.
    pub fn parts(&self) -> Vec<f64> {
        let (mut rest, mut parts) = (self.clone(), vec![]);
        loop {
            let x = rest.value();
            if x == 0.0 {
                return parts;
            }
            parts.push(x);
            if !x.is_finite() {
                return parts;
            }
            rest.take(x);
        }
    }

    /// The sums of all ranks, on all of them.
    pub fn of_all(sums: &mut [Exact], ranks: &Comm) {
        let own: Vec<u8> = sums.iter().flat_map(Exact::to_bytes).collect();
        let all = ranks.all_as_long(&own);
        let all = all.unwrap_or_else(|failure| ranks.end(failure));
        let all = all.chunks(own.len().max(1)).enumerate();
        let others = all.filter(|(rank, _)| *rank != ranks.rank());
        for (_, bytes) in others {
            for (sum, bytes) in sums.iter_mut().zip(bytes.chunks_exact(Exact::BYTES)) {
                sum.merge(&Exact::from_bytes(bytes));
            }
        }
    }

    /// As bytes, for other ranks.
    fn to_bytes(&self) -> Vec<u8> {
        let numbers = self.digits.iter().map(|digit| digit.to_le_bytes());
        let own = [i64::from(self.added), self.low as i64, self.high as i64];
        let more = own
            .map(i64::to_le_bytes)
            .into_iter()
            .chain([self.other.to_le_bytes()]);
        numbers.chain(more).flatten().collect()
    }

    /// The bytes of one.
    const BYTES: usize = 8 * (DIGITS + 4);

    /// From them.
    fn from_bytes(bytes: &[u8]) -> Exact {
        assert_eq!(bytes.len(), Exact::BYTES);
        let word = |n: usize| -> [u8; 8] { bytes[8 * n..][..8].try_into().expect("eight bytes") };
        let number = |n: usize| i64::from_le_bytes(word(n));
        Exact {
            digits: std::array::from_fn(number),
            added: number(DIGITS) as u32,
            low: number(DIGITS + 1) as usize,
            high: number(DIGITS + 2) as usize,
            other: f64::from_le_bytes(word(DIGITS + 3)),
        }
    }
}

impl Default for Exact {
    fn default() -> Exact {
        Exact::ZERO
    }
}

impl FromIterator<f64> for Exact {
    fn from_iter<I: IntoIterator<Item = f64>>(all: I) -> Exact {
        let mut sum = Exact::ZERO;
        all.into_iter().for_each(|x| sum.add(x));
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::Exact;
    use crate::samples::Random;

    fn exact(all: &[f64]) -> Exact {
        let mut sum = Exact::ZERO;
        all.iter().for_each(|x| sum.add(*x));
        sum
    }

    fn sum(all: &[f64]) -> f64 {
        exact(all).value()
    }

    #[test]
    fn sums_are_those_of_integers_rounded_once() {
        let mut random = Random(7);
        for bits in [1, 20, 53, 60, 90, 120] {
            for count in [1, 2, 3, 17, 200] {
                for scale in [-1074, -1040, -60, 0, 800] {
                    let integers: Vec<i128> = (0..count)
                        .map(|_| {
                            let leading = (random.next() * (1u64 << 52) as f64) as i128;
                            let place = (random.next().abs() * f64::from(bits)) as u32;
                            if place >= 52 {
                                leading << (place - 52)
                            } else {
                                leading >> (52 - place)
                            }
                        })
                        .collect();
                    let power = |n: i32| 2.0f64.powi(n / 2) * 2.0f64.powi(n - n / 2);
                    let scaled = |n: i128| n as f64 * power(scale);
                    let all: Vec<f64> = integers.iter().map(|n| scaled(*n)).collect();
                    let wanted = scaled(integers.iter().sum());
                    assert_eq!(
                        sum(&all).to_bits(),
                        wanted.to_bits(),
                        "{count} of 2^{bits} by 2^{scale}"
                    );
                }
            }
        }
    }

    #[test]
    fn order_and_parts_do_not_show() {
        let mut random = Random(3);
        let mut all: Vec<f64> = (0..3000)
            .map(|_| random.next() * 2.0f64.powi((random.next() * 1000.0) as i32))
            .collect();
        let wanted = sum(&all);
        for _ in 0..5 {
            for n in (1..all.len()).rev() {
                all.swap(n, (random.next().abs() * n as f64) as usize);
            }
            assert_eq!(sum(&all).to_bits(), wanted.to_bits());
            let mut parts = Exact::ZERO;
            for part in all.chunks(1 + (random.next().abs() * 700.0) as usize) {
                parts.merge(&Exact::from_bytes(&exact(part).to_bytes()));
            }
            assert_eq!(parts.value().to_bits(), wanted.to_bits());
        }
        // a few numbers are the sum, to the last bit
        let mut again: Exact = exact(&all).parts().into_iter().collect();
        assert_eq!(again.value().to_bits(), wanted.to_bits());
        all.iter().for_each(|x| again.take(*x));
        assert_eq!(again.value().to_bits(), 0);
        // all but one of them taken away again
        let one = all[0];
        let back: Vec<f64> = all[1..].iter().map(|x| -x).collect();
        assert_eq!(sum(&[&all[..], &back].concat()), one);
    }

    #[test]
    fn ends_of_the_range() {
        let (most, least) = (f64::MAX, f64::from_bits(1));
        assert_eq!(sum(&[]).to_bits(), 0);
        assert_eq!(sum(&[-0.0, 0.0]).to_bits(), 0);
        assert_eq!(sum(&[most, most, -most]), most);
        assert_eq!(sum(&[-most, -most, most]), -most);
        assert_eq!(sum(&[most, most]), f64::INFINITY);
        assert_eq!(sum(&[-most, -most]), f64::NEG_INFINITY);
        assert_eq!(sum(&[most, -most, least]), least);
        assert_eq!(sum(&[-least, -least, -least]), -3.0 * least);
        assert_eq!(sum(&[1.0, most, -least, -most]), 1.0);
        // halfway between two numbers, and beside it
        let half = f64::EPSILON / 2.0;
        assert_eq!(sum(&[1.0, half]), 1.0);
        assert_eq!(sum(&[1.0 + f64::EPSILON, half]), 1.0 + 2.0 * f64::EPSILON);
        assert_eq!(sum(&[1.0, half, least]), 1.0 + f64::EPSILON);
        assert_eq!(sum(&[1.0, half, -least]), 1.0);
        assert_eq!(sum(&[f64::INFINITY, 1.0]), f64::INFINITY);
        assert!(sum(&[f64::INFINITY, f64::NEG_INFINITY]).is_nan());
        assert!(sum(&[f64::NAN, 1.0]).is_nan());
    }
}
