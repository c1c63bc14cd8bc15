//! Factors of bonds: heterogeneous bodies and weak planes.

use super::agreed::agreed;
use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::family::periods;
use crate::fracture::precrack::Crack;
use crate::interaction::Interaction;
use crate::law::BondFactors;
use crate::law::solid::bond_based::between;
use crate::spec::{BondFactorSpec, BondMixing, Spec};
use std::cell::Cell;

/// Scale the bonds of `interaction` as the spec says, and what to warn of. Call before [`Interaction::prepare`] and any
/// sweep.
pub(super) fn scale<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
) -> Result<Vec<String>, BuildError> {
    let mut warnings = vec![];
    for (n, factor) in spec.bonds.factors.iter().enumerate() {
        let path = format!("bonds[{n}]");
        let named = |e: BuildError| e.at(path.clone());
        match factor {
            BondFactorSpec::Field(field) => {
                let mut at = vec![1.0; body.len()];
                let mut wrong = Ok(());
                for &s in body.slots() {
                    let x = body.position(s as usize);
                    let value = field.eval(&x, 0.0);
                    if !(value >= 0.0 && value.is_finite()) {
                        let message = format!(
                            "the factor `{}` is {value} at {:?}, expected 0 or a positive number",
                            field.source(),
                            &x[..D]
                        );
                        wrong = Err(BuildError::invalid(path.clone(), message)
                            .help("exp(…) and max(…, 0) are never negative"));
                        break;
                    }
                    at[s as usize] = value;
                }
                agreed(body, wrong)?;
                body.exchange().fill(&mut at);
                let scaled =
                    |i: usize, j: usize, _| pair(mean(spec.interactions.interface, at[i], at[j]));
                interaction.scale_bonds(body, &scaled).map_err(named)?;
            }
            BondFactorSpec::Crossing { shape, factor } => {
                let crack = Crack::new(shape, body.period()).map_err(named)?;
                if !(*factor >= 0.0 && factor.is_finite()) {
                    let message =
                        format!("the factor is {factor}, expected 0 or a positive number");
                    return Err(BuildError::invalid(path, message));
                }
                let found = Cell::new(false);
                let scaled = |i: usize, j: usize, _| {
                    let [x, y]: [[f64; D]; 2] = [i, j].map(|s| {
                        let x = body.position(s);
                        crate::array::from_fn(|a| x[a])
                    });
                    let y = match listed(body, [i, j]) {
                        true => {
                            let back = periods(body, &crate::array::from_fn(|a| y[a] - x[a]));
                            crate::array::from_fn(|a| y[a] - back[a])
                        }
                        false => y,
                    };
                    let crosses = crack.crosses(&x, &y);
                    found.set(found.get() || crosses);
                    pair(if crosses { *factor } else { 1.0 })
                };
                interaction.scale_bonds(body, &scaled).map_err(named)?;
                if !body.exchange().any(found.get()) {
                    warnings.push(format!(
                        "no bond crosses the shape of bonds entry {}",
                        n + 1
                    ));
                }
            }
        }
    }
    Ok(warnings)
}

/// Is a bond one of a list, which knows no images, or of an interface?
fn listed<const D: usize>(body: &Body<D>, ends: [usize; 2]) -> bool {
    let [a, b] = ends.map(|s| body.piece_of(s));
    let own = body.pieces().get(a).map_or(body, |p| &p.body);
    a != b || matches!(own.layout(), Layout::Cloud(_))
}

fn pair(factor: f64) -> BondFactors<f64> {
    BondFactors {
        pair: factor,
        ..BondFactors::ONE
    }
}

/// The same for both ends gives the same; 0 in series gives 0.
fn mean(rule: BondMixing, a: f64, b: f64) -> f64 {
    match rule {
        BondMixing::Harmonic if a * b == 0.0 => 0.0,
        BondMixing::Harmonic | BondMixing::Arithmetic | BondMixing::Minimum => between(rule, a, b),
    }
}
