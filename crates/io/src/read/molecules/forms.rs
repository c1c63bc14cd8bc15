//! Coefficients of LAMMPS's styles.

use crate::read::error::ReadError;
use crate::read::lines::Lines;
use peridyne::law::bonded::{Wave, cosine_powers};
use peridyne::spec::Form;

const BONDS: &str = "harmonic";
const ANGLES: &str = "harmonic, cosine, cosine/squared";
const IMPROPERS: &str = "harmonic";
const DIHEDRALS: &str = "opls, harmonic, charmm, fourier, multi/harmonic, nharmonic";

/// The form of a part ([`peridyne::law::bonded::PARTS`]) that words of a style mean.
pub(super) fn form(
    lines: &Lines,
    part: usize,
    style: &str,
    words: &[&str],
    length: f64,
    energy: f64,
) -> Result<Form, ReadError> {
    let mut numbers = vec![];
    for word in words {
        numbers.push(lines.finite(Some(word), "a coefficient")?);
    }
    let made = match (part, style, &numbers[..]) {
        (0, "harmonic", &[k, r]) => Form::HarmonicBond {
            stiffness: k * energy / (length * length),
            length: r * length,
        },
        (1, "harmonic", &[k, degrees]) => Form::HarmonicAngle {
            stiffness: k * energy,
            angle: degrees.to_radians(),
        },
        (1, "cosine", &[k]) => Form::CosineAngle {
            stiffness: k * energy,
        },
        (1, "cosine/squared", &[k, degrees]) => Form::CosineSquaredAngle {
            stiffness: k * energy,
            cosine: libm::cos(degrees.to_radians()),
        },
        (3, "harmonic", &[k, degrees]) => Form::HarmonicImproper {
            stiffness: k * energy,
            angle: degrees.to_radians(),
        },
        (2, _, numbers) => {
            let powers = dihedral(lines, style, numbers)?;
            Form::Dihedral {
                powers: powers.iter().map(|p| p * energy).collect(),
            }
        }
        (0 | 3, "harmonic", _) | (1, "harmonic" | "cosine" | "cosine/squared", _) => {
            return Err(other_number(lines, style, numbers.len()));
        }
        _ => {
            let known = [BONDS, ANGLES, DIHEDRALS, IMPROPERS];
            return Err(unknown(lines, style, known[part]));
        }
    };
    Ok(made)
}

fn other_number(lines: &Lines, style: &str, found: usize) -> ReadError {
    lines.error(format!(
        "{found} coefficients, which is not what the style `{style}` has"
    ))
}

fn unknown(lines: &Lines, style: &str, known: &str) -> ReadError {
    let found = match style {
        "" => "the section does not say its style behind a #".to_string(),
        style => format!("the style `{style}` is not known"),
    };
    lines.error(format!("{found}; known are {known}"))
}

/// Powers of the cosine.
fn dihedral(lines: &Lines, style: &str, numbers: &[f64]) -> Result<Vec<f64>, ReadError> {
    let wave = |strength: f64, times: f64, opposite: bool| {
        let fits = (0.0..=20.0).contains(&times) && times.fract() == 0.0;
        let wrong = || lines.error(format!("a wave has {times} periods, expected 0, 1, 2, …"));
        let wave = Wave {
            strength,
            times: times as u32,
            opposite,
        };
        fits.then_some(wave).ok_or_else(wrong)
    };
    let turned = |degrees: f64| {
        match degrees {
        0.0 => Ok(false),
        180.0 | -180.0 => Ok(true),
        _ => Err(lines.error(format!(
            "the phase {degrees} knows left from right, and energies of distances cannot: 0 and 180 are read"
        ))),
    }
    };
    let waves = match (style, numbers) {
        ("multi/harmonic", [_, _, _, _, _]) => return Ok(numbers.to_vec()),
        ("nharmonic", [count, powers @ ..]) if *count == powers.len() as f64 => {
            return Ok(powers.to_vec());
        }
        ("opls", &[a, b, c, d]) => vec![
            wave(0.5 * a, 1.0, false)?,
            wave(0.5 * b, 2.0, true)?,
            wave(0.5 * c, 3.0, false)?,
            wave(0.5 * d, 4.0, true)?,
        ],
        ("harmonic", &[k, sign, times]) if sign == 1.0 || sign == -1.0 => {
            vec![wave(k, times, sign < 0.0)?]
        }
        ("charmm", &[k, times, phase, weight]) => {
            if weight != 0.0 {
                return Err(lines.error(format!(
                    "the weight {weight} asks for a potential of its own between the ends; 0 is read"
                )));
            }
            vec![wave(k, times, turned(phase)?)?]
        }
        ("fourier", [count, rest @ ..]) if 3.0 * count == rest.len() as f64 => {
            let each = rest.chunks(3);
            let waves = each.map(|w| wave(w[0], w[1], turned(w[2])?));
            waves.collect::<Result<_, _>>()?
        }
        ("multi/harmonic" | "nharmonic" | "opls" | "harmonic" | "charmm" | "fourier", _) => {
            return Err(other_number(lines, style, numbers.len()));
        }
        _ => return Err(unknown(lines, style, DIHEDRALS)),
    };
    Ok(cosine_powers(&waves))
}
