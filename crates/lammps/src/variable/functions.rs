//! The functions of formulas.

use std::f64::consts::{PI, TAU};

pub const CONSTANTS: [&str; 8] = ["PI", "version", "yes", "on", "true", "no", "off", "false"];

/// LAMMPS's version number whose behaviour is followed.
const VERSION: f64 = 20_250_722.0;

pub fn constant(name: &str) -> Option<f64> {
    Some(match name {
        "PI" => PI,
        "version" => VERSION,
        "yes" | "on" | "true" => 1.0,
        "no" | "off" | "false" => 0.0,
        _ => return None,
    })
}

/// Functions of numbers and how many arguments they take.
pub const NAMES: [(&str, usize); 27] = [
    ("sqrt", 1),
    ("exp", 1),
    ("ln", 1),
    ("log", 1),
    ("abs", 1),
    ("sign", 1),
    ("sin", 1),
    ("cos", 1),
    ("tan", 1),
    ("asin", 1),
    ("acos", 1),
    ("atan", 1),
    ("atan2", 2),
    ("ceil", 1),
    ("floor", 1),
    ("round", 1),
    ("ternary", 3),
    ("ramp", 2),
    ("stagger", 2),
    ("logfreq", 3),
    ("logfreq2", 3),
    ("logfreq3", 3),
    ("stride", 3),
    ("stride2", 6),
    ("vdisplace", 2),
    ("swiggle", 3),
    ("cwiggle", 3),
];

pub const MOST_ARGUMENTS: usize = 6;

/// Functions of a group of atoms.
pub const GROUP: [&str; 12] = [
    "count", "mass", "xcm", "vcm", "fcm", "bound", "ke", "gyration", "angmom", "torque", "omega",
    "inertia",
];

/// What functions of time need to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    pub step: u64,
    /// First and last step of the run (equal between runs).
    pub begin: u64,
    pub end: u64,
    pub time_step: f64,
}

impl Clock {
    /// Steps since the run began.
    fn done(&self) -> f64 {
        (self.step - self.begin.min(self.step)) as f64
    }
}

/// Value of function `name` of [`NAMES`].
///
/// # Errors
/// An argument outside the function's domain.
pub fn apply(name: &str, a: &[f64], clock: &Clock) -> Result<f64, String> {
    let wrong = |what: &str| {
        Err(format!(
            "{name}({}) {what}",
            a.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
        ))
    };
    let step = clock.step as i64;
    Ok(match (name, a) {
        ("sqrt", [x]) if *x < 0.0 => return wrong("is the root of a negative number"),
        ("sqrt", [x]) => x.sqrt(),
        ("exp", [x]) => libm::exp(*x),
        ("ln" | "log", [x]) if *x <= 0.0 => {
            return wrong("is the logarithm of a number that is not positive");
        }
        ("ln", [x]) => libm::log(*x),
        ("log", [x]) => libm::log10(*x),
        ("abs", [x]) => x.abs(),
        ("sign", [x]) => {
            if *x >= 0.0 {
                1.0
            } else {
                -1.0
            }
        }
        ("sin", [x]) => libm::sin(*x),
        ("cos", [x]) => libm::cos(*x),
        ("tan", [x]) => libm::tan(*x),
        ("asin" | "acos", [x]) if !(-1.0..=1.0).contains(x) => {
            return wrong("needs an argument from -1 to 1");
        }
        ("asin", [x]) => libm::asin(*x),
        ("acos", [x]) => libm::acos(*x),
        ("atan", [x]) => libm::atan(*x),
        ("atan2", [y, x]) => libm::atan2(*y, *x),
        ("ceil", [x]) => x.ceil(),
        ("floor", [x]) => x.floor(),
        // halves go up, also below zero
        ("round", [x]) => {
            if x - x.floor() >= 0.5 {
                x.ceil()
            } else {
                x.floor()
            }
        }
        ("ternary", [c, x, y]) => {
            if *c != 0.0 {
                *x
            } else {
                *y
            }
        }
        ("ramp", [x, y]) => {
            let (done, all) = (
                clock.step.saturating_sub(clock.begin),
                clock.end.saturating_sub(clock.begin),
            );
            let fraction = if all == 0 {
                0.0
            } else {
                done as f64 / all as f64
            };
            x + (y - x) * fraction
        }
        ("vdisplace", [x, v]) => x + v * clock.done() * clock.time_step,
        ("swiggle" | "cwiggle", [_, _, p]) if *p == 0.0 => {
            return wrong("needs a period other than 0");
        }
        ("swiggle", [x, amplitude, period]) => {
            x + amplitude * libm::sin(TAU / period * clock.done() * clock.time_step)
        }
        ("cwiggle", [x, amplitude, period]) => {
            x + amplitude * (1.0 - libm::cos(TAU / period * clock.done() * clock.time_step))
        }
        _ => match next_step(name, &a.iter().map(|x| *x as i64).collect::<Vec<_>>(), step) {
            Some(next) => next as f64,
            None => return wrong("has arguments that do not go together"),
        },
    })
}

/// What LAMMPS gives when there is no next step.
const NEVER: i64 = 9_223_372_036_854_774_784;

/// The next output step after `step`.
fn next_step(name: &str, a: &[i64], step: i64) -> Option<i64> {
    let multiple = |s: i64, n: i64| (s / n + 1).saturating_mul(n);
    // larger counts cannot be steps and would overflow below
    if a.iter().any(|x| x.unsigned_abs() > 1 << 52) {
        return None;
    }
    match (name, a) {
        ("stagger", &[x, y]) if x > 0 && y > 0 && x > y => {
            let low = step / x * x;
            Some(if step - low >= y { low + x } else { low + y })
        }
        ("stride", &[x, y, z]) if x >= 0 && y >= 0 && z > 0 && x <= y => {
            let next = if step < x {
                x
            } else {
                x + multiple(step - x, z)
            };
            Some(if next > y { NEVER } else { next })
        }
        ("stride2", &[x, y, z, u, v, w])
            if x >= 0
                && y >= 0
                && z > 0
                && u >= 0
                && v >= 0
                && w > 0
                && x <= y
                && u <= v
                && u >= x
                && v <= y =>
        {
            let outer = |s: i64| {
                let next = x + multiple(s - x, z);
                if next > y { NEVER } else { next }
            };
            Some(if step < x {
                x
            } else if step < u {
                outer(step).min(u)
            } else if step < v {
                let inner = u + multiple(step - u, w);
                if inner > v { outer(v) } else { inner }
            } else {
                outer(step)
            })
        }
        ("logfreq" | "logfreq2", &[x, y, z])
            if x > 0 && y > 0 && z > 0 && (name == "logfreq2" || y < z) =>
        {
            if step < x {
                return Some(x);
            }
            let mut low = x;
            while step >= low.checked_mul(z)? {
                low = low.checked_mul(z)?;
            }
            if name == "logfreq" {
                let k = step / low;
                return Some(if k < y {
                    low.checked_mul(k + 1)?
                } else {
                    low.checked_mul(z)?
                });
            }
            let high = low.checked_mul(z)?;
            let width = (high - low) as f64 / y as f64;
            let mut k = 1;
            while k <= y && low + (width * k as f64) as i64 <= step {
                k += 1;
            }
            Some(low + (width * k as f64) as i64)
        }
        ("logfreq3", &[x, n, y]) if x > 0 && n > 1 && y > x => {
            if step < x {
                return Some(x);
            }
            let factor = libm::pow(y as f64 / x as f64, 1.0 / (n - 1) as f64);
            let mut value = x as f64;
            while value.ceil() as i64 <= step && (value as i64) < y {
                value *= factor;
            }
            Some(if step >= y {
                NEVER
            } else {
                (value.ceil() as i64).min(y)
            })
        }
        _ => None,
    }
}
