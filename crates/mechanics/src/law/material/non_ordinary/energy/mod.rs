//! Energies that are expressions of the invariants `I₁ = tr C`, `I₂ = ½ (tr² C − tr C²)`, `J = det F` of `C = FᵀF`, with their slopes.
//!
//! Every part of an expression is known as `f = f₀ + g·ΔI + r`: its value and slope at the reference, plain numbers that are found once, and
//! what is beyond them, r, with the change h of the slope, `∂f = g + h`. Sums, products and functions carry r and h on without ever taking
//! the large f₀ away from a number near it: `r_ab = a₀ r_b + b₀ r_a + Δa Δb`, `r_f(a) = f′(a₀) r_a + (f(a₀ + Δa) − f₀ − f′(a₀) Δa)`. So stresses
//! of small strains have all their digits, and about the reference the law is linear to the last of them.

mod reader;

use super::rest::{exp_rest, ln_rest};
use crate::expression::Expression;
use crate::law::number::Number;

/// The variables of an energy.
pub const INVARIANTS: &[&str] = &["I1", "I2", "J"];
/// Of no strain.
const AT_REST: [f64; 3] = [3.0, 3.0, 1.0];

/// Most parts that wait for their operator, and highest power that is a polynomial.
const DEPTH: usize = 10;
const HIGHEST: usize = 8;

/// A part at the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
struct At {
    value: f64,
    slope: [f64; 3],
}

/// What is done later with the topmost parts.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    Variable,
    Scale(f64),
    Add,
    Subtract,
    Multiply(At, At),
    Inverse(At),
    Root(At),
    Exp(At),
    Log(At),
    /// `Σ c_k Δᵏ`, k from 2 on.
    Polynomial(At, [f64; HIGHEST + 1]),
    Power(At, f64),
}

/// An energy (energy / volume) of the three invariants.
#[derive(Debug, Clone, PartialEq)]
pub struct Energy {
    steps: Vec<Step>,
    /// Slopes at the reference.
    pub slope: [f64; 3],
}

/// What is beyond the slope at the reference.
#[derive(Debug, Clone, Copy)]
pub struct Beyond<N> {
    /// `f − f₀ − g·ΔI`
    pub rest: N,
    /// `∂f/∂I − g`
    pub slope: [N; 3],
}

impl At {
    /// `f(a)` with `f(a₀)` and `f′(a₀)`.
    fn chain(&self, value: f64, slope: f64) -> At {
        At {
            value,
            slope: self.slope.map(|g| slope * g),
        }
    }

    fn times(&self, b: &At) -> At {
        At {
            value: self.value * b.value,
            slope: crate::array::from_fn(|k| self.value * b.slope[k] + b.value * self.slope[k]),
        }
    }

    fn plus(&self, sign: f64, b: &At) -> At {
        At {
            value: self.value + sign * b.value,
            slope: crate::array::from_fn(|k| self.slope[k] + sign * b.slope[k]),
        }
    }
}

impl Energy {
    /// # Errors
    /// It is no smooth function of the invariants about the reference.
    pub fn new(expression: &Expression) -> Result<Energy, String> {
        let (steps, at) = reader::read(expression)?;
        if !at.slope.iter().all(|g| g.is_finite()) {
            return Err("it has no finite slope in the reference".into());
        }
        let (mut height, mut most) = (0usize, 0);
        for step in &steps {
            match step {
                Step::Variable => height += 1,
                Step::Add | Step::Subtract | Step::Multiply(..) => height -= 1,
                Step::Scale(_)
                | Step::Inverse(_)
                | Step::Root(_)
                | Step::Exp(_)
                | Step::Log(_)
                | Step::Polynomial(..)
                | Step::Power(..) => {}
            }
            most = most.max(height);
        }
        if most > DEPTH {
            return Err(format!(
                "{most} parts wait for their operator, expected at most {DEPTH}: write sums from left to right"
            ));
        }
        Ok(Energy {
            steps,
            slope: at.slope,
        })
    }

    /// Where the invariants are those of the reference and these.
    #[inline(always)]
    pub fn beyond<N: Number>(&self, change: &[N; 3]) -> Beyond<N> {
        let zero = N::constant(0.0);
        let nothing = Beyond {
            rest: zero,
            slope: [zero; 3],
        };
        let mut stack = [nothing; DEPTH];
        let mut n = 0;
        for step in &self.steps {
            match step {
                Step::Variable => {
                    stack[n] = nothing;
                    n += 1;
                }
                Step::Scale(c) => {
                    let a = stack[n - 1];
                    stack[n - 1] = sum(&nothing, *c, &a);
                }
                Step::Add => {
                    n -= 1;
                    stack[n - 1] = sum(&stack[n - 1], 1.0, &stack[n]);
                }
                Step::Subtract => {
                    n -= 1;
                    stack[n - 1] = sum(&stack[n - 1], -1.0, &stack[n]);
                }
                Step::Multiply(a, b) => {
                    n -= 1;
                    stack[n - 1] = product(&stack[n - 1], a, &stack[n], b, change);
                }
                Step::Inverse(at)
                | Step::Root(at)
                | Step::Exp(at)
                | Step::Log(at)
                | Step::Polynomial(at, ..)
                | Step::Power(at, _) => {
                    let a = stack[n - 1];
                    stack[n - 1] = function(step, &a, at, strain_change(&a, at, change));
                }
            }
        }
        stack[0]
    }
}

/// Δa of a part.
#[inline(always)]
fn strain_change<N: Number>(a: &Beyond<N>, at: &At, change: &[N; 3]) -> N {
    let mut all = a.rest;
    for k in 0..3 {
        if at.slope[k] != 0.0 {
            all = change[k].fma(N::constant(at.slope[k]), all);
        }
    }
    all
}

/// `a + c b`
#[inline(always)]
fn sum<N: Number>(a: &Beyond<N>, c: f64, b: &Beyond<N>) -> Beyond<N> {
    let c = N::constant(c);
    let mut out = *a;
    out.rest = c.fma(b.rest, a.rest);
    for k in 0..3 {
        out.slope[k] = c.fma(b.slope[k], a.slope[k]);
    }
    out
}

#[inline(always)]
fn product<N: Number>(
    a: &Beyond<N>,
    at_a: &At,
    b: &Beyond<N>,
    at_b: &At,
    change: &[N; 3],
) -> Beyond<N> {
    let (da, db) = (
        strain_change(a, at_a, change),
        strain_change(b, at_b, change),
    );
    let (a0, b0) = (N::constant(at_a.value), N::constant(at_b.value));
    let mut out = *a;
    out.rest = da.fma(db, a0.fma(b.rest, b0 * a.rest));
    for k in 0..3 {
        let both = (a0 + da).fma(b.slope[k], (b0 + db) * a.slope[k]);
        let (ga, gb) = (N::constant(at_a.slope[k]), N::constant(at_b.slope[k]));
        out.slope[k] = da.fma(gb, db.fma(ga, both));
    }
    out
}

/// A function of a part that is d away from the reference.
#[inline(always)]
fn function<N: Number>(step: &Step, a: &Beyond<N>, at: &At, d: N) -> Beyond<N> {
    let zero = N::constant(0.0);
    let a0 = N::constant(at.value);
    // f′(a₀), what is beyond it, and the change of f′
    let (first, rest, change) = match step {
        Step::Inverse(_) => {
            let now = (a0 + d).recip();
            let square = at.value.powi(-2);
            let rest = (d * d * now).times(square);
            let change = d * (a0 + a0 + d) * (now * now).times(square);
            (-square, rest, change)
        }
        Step::Root(_) => {
            let before = at.value.sqrt();
            let now = (a0 + d).sqrt();
            let both = now.plus(before);
            let share = (d.times(-0.5 / before)).div(both);
            (0.5 / before, (share * d).div(both), share.div(now))
        }
        Step::Exp(_) => {
            let before = libm::exp(at.value);
            let (rest, change) = (exp_rest(d), d.exp_m1());
            (before, rest.times(before), change.times(before))
        }
        Step::Log(_) => {
            let x = d.times(at.value.recip());
            (at.value.recip(), ln_rest(x), (zero - x).div(a0 + d))
        }
        Step::Polynomial(_, c) => {
            let (mut rest, mut change) = (zero, zero);
            for k in (2..=HIGHEST).rev() {
                rest = rest.fma(d, N::constant(c[k]));
                change = change.fma(d, N::constant(k as f64 * c[k]));
            }
            (c[1], rest * d * d, change * d)
        }
        Step::Power(_, p) => {
            let x = d.times(at.value.recip());
            let log = x.ln_1p();
            let first = p * libm::pow(at.value, p - 1.0);
            let rest = exp_rest(log.times(*p)) + ln_rest(x).times(*p);
            let change = log.times(p - 1.0).exp_m1();
            (
                first,
                rest.times(libm::pow(at.value, *p)),
                change.times(first),
            )
        }
        Step::Variable | Step::Scale(_) | Step::Add | Step::Subtract | Step::Multiply(..) => {
            (1.0, zero, zero)
        }
    };
    let slope = change.plus(first);
    let mut out = *a;
    out.rest = a.rest.times(first) + rest;
    for k in 0..3 {
        out.slope[k] = slope.fma(a.slope[k], change.times(at.slope[k]));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::material::non_ordinary::tried::slope;
    use crate::law::number::Dual;

    fn energy(text: &str) -> Energy {
        Energy::new(&Expression::of(INVARIANTS, text, &[]).unwrap()).unwrap()
    }

    /// Value and slopes against the interpreter and dual numbers of plain arithmetic, far from the reference.
    #[test]
    fn values_and_slopes_are_those_of_the_expression() {
        let texts = [
            "I1 - 3 - 2*ln(J)",
            "(J - 1)^2*I2/7 + 2^(I1/3)",
            "I1*J^(-2/3) + 0.3*I2*J^(-4/3)",
            "exp(0.2*(I1 - 3)^2) - sqrt(I2 + J)/(2 + I1)",
            "1/J - 3*(J^2 - 1)^3 + (I1*I2)^0.5 - J^0*I1^1",
            "-(4 - I1)*(I2 - 3)/J",
        ];
        for text in texts {
            let expression = Expression::of(INVARIANTS, text, &[]).unwrap();
            let made = energy(text);
            for d in [[0.7, -0.4, 0.2], [-0.6, 0.5, -0.35], [3.0, 5.0, 0.9]] {
                let at = |d: [f64; 3]| {
                    let x: [f64; 3] = crate::array::from_fn(|k| AT_REST[k] + d[k]);
                    expression.eval(&x, 0.0)
                };
                let found = made.beyond(&d);
                let line: f64 = (0..3).map(|k| made.slope[k] * d[k]).sum();
                let value = at(d) - at([0.0; 3]);
                let scale = 1.0 + value.abs();
                assert!(
                    (found.rest + line - value).abs() < 1e-13 * scale,
                    "{text}: {} {value}",
                    found.rest + line
                );
                for k in 0..3 {
                    let by = |step: f64| {
                        let mut d = d;
                        d[k] += step;
                        at(d)
                    };
                    let slope = slope(by);
                    let off = (found.slope[k] + made.slope[k] - slope).abs();
                    assert!(off < 1e-9 * (1.0 + slope.abs()), "{text} {k}: {off:e}");
                }
            }
        }
    }

    /// The second derivatives of dual numbers are the slopes of the slopes.
    #[test]
    fn slopes_have_slopes() {
        let made = energy("exp(0.2*(I1 - 3)^2)*J^(-1.5) - I2*ln(J)/(1 + I1) + sqrt(I1)");
        let d = [0.4, -0.3, 0.15];
        for k in 0..3 {
            let dual = |n: usize| Dual {
                value: d[n],
                slope: if n == k { 1.0 } else { 0.0 },
            };
            let found = made.beyond(&[dual(0), dual(1), dual(2)]);
            for r in 0..3 {
                let by = |step: f64| {
                    let mut d = d;
                    d[k] += step;
                    made.beyond(&d).slope[r]
                };
                let slope = slope(by);
                assert!((found.slope[r].slope - slope).abs() < 1e-9, "{k} {r}");
            }
            // of the value beyond its first slope
            let slope = found.slope[k].value;
            assert!((found.rest.slope - slope).abs() < 1e-14, "{k}");
        }
    }

    /// However small the strain is: `ln J + 1/J` is `½ ΔJ²` beyond the reference.
    #[test]
    fn nothing_is_lost_to_the_reference() {
        let made = energy("ln(J) + 1/J + I1*J - I1 - 3*J");
        assert_eq!(made.slope, [0.0, 0.0, 0.0]);
        for small in [1e-3, 1e-9, 1e-60] {
            let found = made.beyond(&[0.0, 0.0, small]);
            assert!((found.rest / (0.5 * small * small) - 1.0).abs() < 2.0 * small + 1e-14);
            assert!((found.slope[2] / small - 1.0).abs() < 4.0 * small + 1e-14);
        }
    }

    #[test]
    fn what_is_no_energy() {
        let refused = |text: &str, part: &str| {
            let expression = Expression::of(INVARIANTS, text, &[]).unwrap();
            let message = Energy::new(&expression).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        };
        refused("abs(I1 - 3)", "smooth");
        refused("max(I1, 3)", "smooth");
        refused("J > 1 ? J : 1", "smooth");
        refused("ln(J - 1)", "logarithm");
        refused("sqrt(I1 - 3)", "root");
        refused("(I1 - 3)^1.5", "power of 1.5");
        refused("(J - 1)/(I1 - 3)", "divides by what is 0");
        refused("J^I1", "exponent");
        refused("7", "none of I1, I2, J");
        refused("I1^(I1*0 + 2)", "exponent");
        assert!(Expression::of(INVARIANTS, "x + J", &[]).is_err());
        assert!(Expression::of(INVARIANTS, "t + J", &[]).is_err());
    }
}
