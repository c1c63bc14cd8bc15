//! The colours of numbers.

use super::image::Color;

/// "inferno" by van der Walt and Smith (matplotlib, released under CC0), perceptually uniform, from dark to light,
/// sampled at 33 equal steps: linear interpolation is within 1.5/255 of the full table.
const INFERNO: [u32; 33] = [
    0x000004, 0x040312, 0x0b0724, 0x150b37, 0x210c4a, 0x2e0a5a, 0x3c0965, 0x4a0c6b, 0x57106d,
    0x63146e, 0x70196e, 0x7d1e6d, 0x89226a, 0x962766, 0xa32b61, 0xaf315c, 0xbb3755, 0xc63e4d,
    0xd14644, 0xdb4f3b, 0xe35932, 0xeb6528, 0xf1711e, 0xf67f14, 0xf98d0a, 0xfb9c06, 0xfcab0f,
    0xfbba1f, 0xf9ca32, 0xf5d949, 0xf2e865, 0xf3f586, 0xfcffa4,
];
/// Part of the table that is left out at its dark end, where light and shade would not show.
const DARKEST: f64 = 0.18;

/// "Cool to warm" (K. Moreland, Diverging color maps for scientific visualization, 2009), for numbers of both signs, at nine equal steps.
const COOL_WARM: [u32; 9] = [
    0x3b4cc0, 0x6282ea, 0x8db0fe, 0xb8d0f9, 0xdddddd, 0xf5c4ad, 0xf49a7b, 0xde604d, 0xb40426,
];

/// Which colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Map {
    /// From dark to light.
    Sequential,
    /// From blue by grey to red.
    Diverging,
}

/// Numbers are of both signs if the lesser end is at least this part of the other.
const SIGNED: f64 = 0.1;

impl Map {
    /// Numbers of both signs diverge.
    pub fn for_range([low, high]: [f64; 2]) -> Map {
        match (-low).min(high) > SIGNED * (-low).max(high) {
            true => Map::Diverging,
            false => Map::Sequential,
        }
    }

    /// Colour of a part, 0 to 1.
    pub fn color(self, part: f64) -> Color {
        match self {
            Map::Sequential => color(part),
            Map::Diverging => between(
                &COOL_WARM,
                if part.is_nan() {
                    0.5
                } else {
                    part.clamp(0.0, 1.0)
                },
            ),
        }
    }
}

/// Colour of a damage; values outside 0…1 are clamped, what is no number counts as 0.
pub fn color(damage: f64) -> Color {
    let damage = if damage.is_nan() {
        0.0
    } else {
        damage.clamp(0.0, 1.0)
    };
    between(&INFERNO, DARKEST + (1.0 - DARKEST) * damage)
}

/// A table between its steps.
fn between(table: &[u32], part: f64) -> Color {
    let at = part * (table.len() - 1) as f64;
    let low = (at as usize).min(table.len() - 2);
    let part = at - low as f64;
    let channel = |rgb: u32, shift: u32| f64::from((rgb >> shift) & 255);
    [16, 8, 0].map(|shift| {
        let (a, b) = (channel(table[low], shift), channel(table[low + 1], shift));
        (a + (b - a) * part).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lightness L* (CIE 1976) of an sRGB colour, 0…100.
    fn lightness(c: Color) -> f64 {
        let linear = c.map(|v| {
            let v = f64::from(v) / 255.0;
            if v <= 0.04045 {
                v / 12.92
            } else {
                ((v + 0.055) / 1.055).powf(2.4)
            }
        });
        let y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        if y > 216.0 / 24389.0 {
            116.0 * y.cbrt() - 16.0
        } else {
            y * 24389.0 / 27.0
        }
    }

    #[test]
    fn lightness_grows_evenly_with_damage() {
        let at = |i: i32| lightness(color(f64::from(i) / 20.0));
        let mean = (at(20) - at(0)) / 20.0;
        for i in 0..20 {
            let step = at(i + 1) - at(i);
            assert!((step / mean - 1.0).abs() < 0.35, "{i}: {step} of {mean}");
        }
    }

    #[test]
    fn ends_and_nonsense() {
        assert_eq!(color(1.0), [0xfc, 0xff, 0xa4]);
        assert_eq!(color(7.0), color(1.0));
        assert_eq!(color(-1.0), color(0.0));
        assert_eq!(color(f64::NAN), color(0.0));
    }
}
