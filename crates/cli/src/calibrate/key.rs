//! Keys between their bounds.

use crate::failure::Failure;
use crate::study::Setting;
use crate::sweep::design::{Values, quantity, value};
use peridyne_io::deck::rounded;

/// Digits of a value that is run.
const DIGITS: usize = 12;

/// A key that is fitted; its values are parts of its interval, from 0 to 1.
pub struct Key {
    pub name: String,
    pub unit: String,
    pub low: f64,
    pub high: f64,
    pub start: f64,
}

impl Key {
    pub fn real(&self, part: f64) -> f64 {
        self.low + (self.high - self.low) * part
    }

    /// The number that is run.
    pub fn number(&self, part: f64) -> String {
        rounded(self.real(part), DIGITS)
    }

    /// A value with its unit, for people.
    pub fn told(&self, value: f64) -> String {
        format!("{} {}", rounded(value, 6), self.unit)
            .trim_end()
            .into()
    }
}

pub fn setting(keys: &[Key], place: &[f64]) -> Setting {
    let one = |(key, part): (&Key, &f64)| (key.name.clone(), value(&key.number(*part), &key.unit));
    keys.iter().zip(place).map(one).collect()
}

pub fn names<'a>(keys: impl Iterator<Item = &'a Key>) -> String {
    keys.map(|k| k.name.as_str()).collect::<Vec<_>>().join(", ")
}

/// Bounds and where to begin.
///
/// # Errors
/// Values in place of bounds, bounds the wrong way round, a key twice, a start that is not between or of a key that is not fitted.
pub fn keys(fit: &[(String, Values)], start: &[(String, String)]) -> Result<Vec<Key>, Failure> {
    let mut keys: Vec<Key> = vec![];
    for (name, values) in fit {
        let Values::Between([low, high], unit) = values else {
            return Err(Failure::input(format!(
                "--fit {name}: a key is fitted between two bounds, {name}=low:high"
            )));
        };
        if low >= high {
            return Err(Failure::input(format!(
                "--fit {name}: the lower bound comes first, and the upper one is above it"
            )));
        }
        if keys.iter().any(|k| k.name == *name) {
            return Err(Failure::input(format!("--fit {name}: twice")));
        }
        keys.push(Key {
            name: name.clone(),
            unit: unit.clone(),
            low: *low,
            high: *high,
            start: 0.5,
        });
    }
    for (n, (name, text)) in start.iter().enumerate() {
        if start[..n].iter().any(|(other, _)| other == name) {
            return Err(Failure::input(format!("--start {name}: twice")));
        }
        let Some(key) = keys.iter_mut().find(|k| k.name == *name) else {
            return Err(Failure::input(format!(
                "--start {name}: this key is not fitted; --set gives a value that stays"
            )));
        };
        let value = quantity(text).filter(|(_, unit)| unit.is_empty() || *unit == key.unit);
        let Some((value, _)) = value else {
            return Err(Failure::input(format!(
                "--start {name}={text}: expected a number in the unit of the bounds{}",
                match key.unit.as_str() {
                    "" => ", which have none".into(),
                    unit => format!(", {unit}"),
                }
            )));
        };
        if !(key.low..=key.high).contains(&value) {
            return Err(Failure::input(format!(
                "--start {name}={text}: it is not between {} and {}",
                key.told(key.low),
                key.told(key.high)
            )));
        }
        key.start = (value - key.low) / (key.high - key.low);
    }
    Ok(keys)
}
