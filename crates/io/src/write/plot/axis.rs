//! Where numbers lie on an axis, and which of them are written.

use std::io;

use super::super::picture::label;
use super::invalid;

/// From values to 0…1 along the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    pub low: f64,
    pub high: f64,
    pub log: bool,
}

impl Scale {
    /// Around the values that are finite (and positive if `log`); `margin`: part of the range left free on each side.
    ///
    /// # Errors
    /// `InvalidInput` when there is none.
    pub fn around(values: impl Iterator<Item = f64>, log: bool, margin: f64) -> io::Result<Scale> {
        let usable = values.filter(|v| v.is_finite() && (!log || *v > 0.0));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in usable {
            (low, high) = (low.min(v), high.max(v));
        }
        if low > high {
            let what = if log { "positive finite" } else { "finite" };
            return Err(invalid(format!("there is no {what} value to plot")));
        }
        if log {
            let pad = libm::pow(high / low, margin).max(if low == high { 2.0 } else { 1.0 });
            (low, high) = (low / pad, high * pad);
        } else {
            // round-off around one value is no range
            let flat = high - low <= 1e-12 * high.abs().max(low.abs());
            let pad = if flat {
                0.5 * high.abs().max(1e-300)
            } else {
                margin * (high - low)
            };
            (low, high) = (low - pad, high + pad);
        }
        Ok(Scale { low, high, log })
    }

    /// Part of the axis before the value; not finite where the value has no place.
    pub fn part(&self, value: f64) -> f64 {
        if self.log {
            libm::log(value / self.low) / libm::log(self.high / self.low)
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Round values with their texts: about `wanted` of them.
    pub fn ticks(&self, wanted: usize) -> Vec<(f64, String)> {
        let span = self.high - self.low;
        if !(span > 0.0 && span.is_finite()) {
            return Vec::new();
        }
        if self.log {
            let (first, last) = (
                libm::log10(self.low).ceil() as i32,
                libm::log10(self.high).floor() as i32,
            );
            if last > first {
                let every = ((last - first) as usize / wanted.max(1) + 1) as i32;
                return (first..=last)
                    .filter(|p| (p - first) % every == 0)
                    .map(|p| (10f64.powi(p), power(p)))
                    .collect();
            }
        }
        let step = label::round_down(span / wanted.max(1) as f64 * 2.0).max(f64::MIN_POSITIVE);
        let first = (self.low / step - 1e-9).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        let decimals = (-libm::log10(step).floor()).clamp(0.0, 12.0) as usize;
        let largest = self.high.abs().max(self.low.abs());
        (first..=last)
            .map(|k| k as f64 * step)
            .filter(|v| !self.log || *v > 0.0)
            .map(|v| {
                let plain = (1e-4..1e6).contains(&largest);
                let text = if plain {
                    format!("{v:.decimals$}")
                } else {
                    label::number(v)
                };
                (v, text.replace('-', "−"))
            })
            .collect()
    }
}

/// 10ⁿ.
fn power(n: i32) -> String {
    if (0..=3).contains(&n) {
        return 10i64.pow(n as u32).to_string();
    }
    let digits = n.to_string();
    let raised = digits.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32(0x2070 + c as u32 - 48).unwrap_or(c),
    });
    format!("10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64, log: bool) -> Vec<String> {
        let scale = Scale { low, high, log };
        scale.ticks(8).into_iter().map(|t| t.1).collect()
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(
            texts(0.0, 1000.0, false),
            ["0", "200", "400", "600", "800", "1000"]
        );
        assert_eq!(
            texts(-0.11, 0.31, false),
            ["−0.1", "0.0", "0.1", "0.2", "0.3"]
        );
        assert_eq!(
            texts(0.5e-9, 2.1e-9, false),
            [
                "6e−10", "8e−10", "1e−9", "1.2e−9", "1.4e−9", "1.6e−9", "1.8e−9", "2e−9"
            ]
        );
        assert_eq!(texts(1e-3, 20.0, true), ["10⁻³", "10⁻²", "10⁻¹", "1", "10"]);
        assert_eq!(
            texts(2.0, 9.0, true),
            ["2", "3", "4", "5", "6", "7", "8", "9"]
        );
    }

    #[test]
    fn a_scale_spans_its_values() {
        let scale =
            Scale::around([3.0, f64::NAN, 1.0, f64::INFINITY].into_iter(), false, 0.0).unwrap();
        assert_eq!(
            (scale.part(1.0), scale.part(2.0), scale.part(3.0)),
            (0.0, 0.5, 1.0)
        );
        let log = Scale::around([0.0, 1.0, 100.0].into_iter(), true, 0.0).unwrap();
        assert!((log.part(10.0) - 0.5).abs() < 1e-15);
        let flat = Scale::around([7.0; 3].into_iter(), false, 0.05).unwrap();
        assert!((flat.part(7.0) - 0.5).abs() < 1e-15);
        assert!(Scale::around([-1.0].into_iter(), true, 0.0).is_err());
    }
}
