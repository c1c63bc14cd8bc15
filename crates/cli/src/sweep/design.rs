//! Which values the runs of a study have.

use crate::failure::Failure;
use crate::study::Setting;

/// How values of several keys meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Design {
    /// Each value of a key with each of the others; the last key runs first.
    Grid,
    /// The first values of all keys, then the second ones, and so on.
    List,
    /// Between the ends of each key, each of as many parts of equal size once (McKay, Beckman and Conover 1979).
    Latin,
}

/// Values of a key.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// As TOML, or bare words.
    These(Vec<String>),
    /// Ends of an interval, and the unit of both.
    Between([f64; 2], String),
}

/// `KEY=A,B,C` or `KEY=LOW:HIGH`.
pub fn vary(text: &str) -> Result<(String, Values), String> {
    let (key, values) = { text.split_once('=') }
        .filter(|(key, _)| !key.trim().is_empty())
        .ok_or_else(|| format!("`{text}` is not of the form key=value,value or key=low:high"))?;
    let key = key.trim().to_string();
    if let Some((low, high)) = values.split_once(':')
        && let (Some((low, unit)), Some((high, other))) = (quantity(low), quantity(high))
    {
        if !unit.is_empty() && !other.is_empty() && unit != other {
            return Err(format!(
                "`{text}`: both ends in the same unit, `{unit}` or `{other}`"
            ));
        }
        let unit = if unit.is_empty() { other } else { unit };
        return Ok((key, Values::Between([low, high], unit)));
    }
    let all = split(values);
    match all.iter().any(String::is_empty) {
        true => Err(format!("`{text}`: a value is missing")),
        false => Ok((key, Values::These(all))),
    }
}

/// A number with its unit as `--set` takes it.
pub fn value(number: &str, unit: &str) -> String {
    match unit {
        "" => number.into(),
        unit => format!("\"{number} {unit}\""),
    }
}

/// A number and its unit.
pub fn quantity(text: &str) -> Option<(f64, String)> {
    let text = text.trim().trim_matches('"');
    let number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    // of "1e5 Pa" all that can be a number
    let mut end = text.find(|c| !number(c)).unwrap_or(text.len());
    while end > 0 && text[..end].parse::<f64>().is_err() {
        end -= 1;
    }
    let value: f64 = text[..end].parse().ok()?;
    value
        .is_finite()
        .then(|| (value, text[end..].trim().to_string()))
}

/// Between commas that stand in no bracket and no quote.
fn split(text: &str) -> Vec<String> {
    let (mut all, mut deep, mut quote) = (vec![String::new()], 0i32, None);
    for c in text.chars() {
        match (quote, c) {
            (None, ',') if deep == 0 => {
                all.push(String::new());
                continue;
            }
            (None, '[' | '{' | '(') => deep += 1,
            (None, ']' | '}' | ')') => deep -= 1,
            (None, '"' | '\'') => quote = Some(c),
            (Some(q), c) if q == c => quote = None,
            _ => {}
        }
        all.last_mut().expect("one at least").push(c);
    }
    all.iter().map(|value| value.trim().to_string()).collect()
}

/// The runs of a study.
///
/// # Errors
/// Lists of unlike lengths, ends where values are asked for or the other way round, a key twice.
pub fn settings(
    vary: &[(String, Values)],
    design: Design,
    (samples, seed): (usize, u64),
) -> Result<Vec<Setting>, Failure> {
    for (n, (key, values)) in vary.iter().enumerate() {
        if vary[..n].iter().any(|(other, _)| other == key) {
            return Err(Failure::input(format!("--vary {key}: twice")));
        }
        match (design, values) {
            (Design::Grid | Design::List, Values::Between(..)) => {
                return Err(Failure::input(format!(
                    "--vary {key}: an interval is drawn from by --design latin; give values, {key}=1,2,3"
                )));
            }
            (Design::Latin, Values::These(_)) => {
                return Err(Failure::input(format!(
                    "--vary {key}: a Latin hypercube is drawn between two ends, {key}=low:high"
                )));
            }
            (Design::Grid | Design::List, Values::These(_)) => {}
            (Design::Latin, Values::Between(..)) => {}
        }
    }
    let these = |values: &Values| match values {
        Values::These(all) => all.clone(),
        Values::Between(..) => vec![],
    };
    let each: Vec<(&String, Vec<String>)> = vary.iter().map(|(k, v)| (k, these(v))).collect();
    match design {
        Design::Grid => {
            let mut all: Vec<Setting> = vec![vec![]];
            for (key, values) in &each {
                let with = |setting: &Setting| -> Vec<Setting> {
                    let one = |v: &String| [setting.clone(), vec![((*key).clone(), v.clone())]];
                    values.iter().map(|v| one(v).concat()).collect()
                };
                all = all.iter().flat_map(with).collect();
            }
            Ok(all)
        }
        Design::List => {
            let count = each[0].1.len();
            if let Some((key, values)) = each.iter().find(|(_, v)| v.len() != count) {
                return Err(Failure::input(format!(
                    "--vary {key}: {} values, and {} has {count}: a list takes as many of each",
                    values.len(),
                    each[0].0
                )));
            }
            let run = |n: usize| {
                let of = each.iter().map(|(k, v)| ((*k).clone(), v[n].clone()));
                of.collect()
            };
            Ok((0..count).map(run).collect())
        }
        Design::Latin if samples == 0 => Err(Failure::input("--samples 0: one run at least")),
        Design::Latin => {
            let mut all: Vec<Setting> = vec![vec![]; samples];
            let mut random = Random(seed);
            for (key, values) in vary {
                let Values::Between([low, high], unit) = values else {
                    continue;
                };
                let mut parts: Vec<usize> = (0..samples).collect();
                for n in (1..samples).rev() {
                    parts.swap(n, (random.part() * (n + 1) as f64) as usize);
                }
                for (setting, part) in all.iter_mut().zip(parts) {
                    let at = (part as f64 + random.part()) / samples as f64;
                    let x = low + (high - low) * at;
                    setting.push((key.clone(), value(&x.to_string(), unit)));
                }
            }
            Ok(all)
        }
    }
}

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers on every machine.
struct Random(u64);

impl Random {
    /// From 0 up to 1, without it.
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Values {
        vary(text).unwrap().1
    }

    #[test]
    fn values_are_told_apart() {
        let these = |all: &[&str]| Values::These(all.iter().map(|v| v.to_string()).collect());
        assert_eq!(values("a.b=2,3, 4"), these(&["2", "3", "4"]));
        assert_eq!(values("m=[1, 2],[3, 4]"), these(&["[1, 2]", "[3, 4]"]));
        assert_eq!(
            values("y=\"70 GPa\",\"1, 2\""),
            these(&["\"70 GPa\"", "\"1, 2\""])
        );
        assert_eq!(
            values("y=60 GPa:80 GPa"),
            Values::Between([60.0, 80.0], "GPa".into())
        );
        assert_eq!(
            values("y=1e-3:2.5e2"),
            Values::Between([1e-3, 250.0], String::new())
        );
        assert_eq!(values("l=1:3 mm"), Values::Between([1.0, 3.0], "mm".into()));
        for wrong in ["a", "=1", "a=1,,2", "y=1 mm:2 m"] {
            assert!(vary(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn designs_have_their_runs() {
        let of = |all: &[&str]| -> Vec<(String, Values)> {
            all.iter().map(|text| vary(text).unwrap()).collect()
        };
        let seen = |settings: Vec<Setting>| -> Vec<String> {
            let one = |s: Setting| -> String { s.into_iter().map(|(_, v)| v).collect() };
            settings.into_iter().map(one).collect()
        };
        let two = of(&["a=1,2,3", "b=x,y"]);
        let grid = settings(&two, Design::Grid, (0, 0)).ok().unwrap();
        assert_eq!(seen(grid), ["1x", "1y", "2x", "2y", "3x", "3y"]);
        assert!(settings(&two, Design::List, (0, 0)).is_err());
        let list = settings(&of(&["a=1,2", "b=x,y"]), Design::List, (0, 0));
        assert_eq!(seen(list.ok().unwrap()), ["1x", "2y"]);
        assert!(settings(&of(&["a=1,2", "a=3"]), Design::Grid, (0, 0)).is_err());
        assert!(settings(&of(&["a=1:2"]), Design::Grid, (0, 0)).is_err());
        let ends = of(&["a=0:10", "b=5 mm:6 mm"]);
        let latin = |seed| settings(&ends, Design::Latin, (10, seed)).ok().unwrap();
        let (first, again, other) = (latin(3), latin(3), latin(4));
        assert!(first == again && first != other);
        // each part of each key once
        for (n, (low, size)) in [(0.0, 1.0), (5.0, 0.1)].into_iter().enumerate() {
            let number = |s: &Setting| quantity(&s[n].1).unwrap().0;
            let mut parts: Vec<usize> = { first.iter() }
                .map(|s| ((number(s) - low) / size) as usize)
                .collect();
            parts.sort_unstable();
            assert!(parts.into_iter().eq(0..10));
        }
    }
}
