//! What a paper says, what was computed, and whether they agree.

use serde::{Deserialize, Serialize};

use crate::experiment::{Computed, Failure};

/// Where a claim comes from, and how firmly it can be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The paper prints it: a formula, a count or a number.
    Exact,
    /// Read off a picture of the paper.
    Digitised,
    /// A statement of the paper in words; the code says whether it holds.
    Qualitative,
    /// Not in the paper: what its equations, or theory, demand. Words with a verdict of the code, or a number.
    Own,
    /// Not in the paper, and demanded by nothing: what was computed here before, so that a change shows.
    Pin,
}

impl Kind {
    /// Does the paper say it?
    pub fn is_published(self) -> bool {
        match self {
            Kind::Exact | Kind::Digitised | Kind::Qualitative => true,
            Kind::Own | Kind::Pin => false,
        }
    }
}

/// When the bound of a claim (its tolerance, or a number in what the code asks) was set.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Bound {
    /// By the digits that are printed, by round-off, or by theory.
    #[default]
    Before,
    /// When a result was known.
    After,
}

/// A number or words.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    Number(f64),
    Text(String),
}

impl From<f64> for Value {
    fn from(number: f64) -> Value {
        Value::Number(number)
    }
}

impl From<String> for Value {
    fn from(text: String) -> Value {
        Value::Text(text)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Value {
        Value::Text(text.to_string())
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Value::Number(x) => write!(f, "{x}"),
            Value::Text(text) => f.write_str(text),
        }
    }
}

/// How far a number may be from the published one; the wider of both counts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    #[serde(default)]
    pub absolute: f64,
    #[serde(default)]
    pub relative: f64,
}

impl Tolerance {
    fn allows(self, computed: f64, published: f64) -> bool {
        let room = self.absolute.max(self.relative * published.abs());
        (computed - published).abs() <= room
    }
}

impl std::fmt::Display for Tolerance {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match (self.absolute, self.relative) {
            (0.0, 0.0) => f.write_str("0"),
            (a, 0.0) => write!(f, "{a}"),
            (0.0, r) => write!(f, "{} %", 100.0 * r),
            (a, r) => write!(f, "{a} or {} %", 100.0 * r),
        }
    }
}

/// An entry of `claims.toml`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// By which the code gives the computed value.
    pub key: String,
    pub what: String,
    /// What the paper prints, of the kinds that it does.
    pub published: Option<Value>,
    /// What is expected, of the kinds that are not in the paper.
    pub expected: Option<Value>,
    /// What is right where the paper is wrong: the claim holds if this is found, and not what is published. Words if a
    /// verdict of the code says so.
    pub erratum: Option<Value>,
    #[serde(default)]
    pub tolerance: Tolerance,
    pub kind: Kind,
    #[serde(default)]
    pub bound: Bound,
    #[serde(default)]
    pub note: String,
    /// Not asked of the small variant.
    #[serde(default)]
    pub full_only: bool,
}

impl Published {
    /// What the paper says, or what is expected: the parser sees to it that there is one.
    fn said(&self) -> Result<&Value, Failure> {
        let said = match self.kind.is_published() {
            true => &self.published,
            false => &self.expected,
        };
        said.as_ref()
            .ok_or_else(|| Failure::new(format!("the claim `{}` says nothing", self.key)))
    }

    /// Are words compared as they are, or may (must) the code say whether they hold?
    fn words(&self) -> (bool, bool) {
        match self.kind {
            Kind::Qualitative => (false, true),
            Kind::Own => (true, true),
            Kind::Exact | Kind::Digitised | Kind::Pin => (true, false),
        }
    }
}

/// A claim with its answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    pub key: String,
    pub what: String,
    pub published: Option<Value>,
    pub expected: Option<Value>,
    pub erratum: Option<Value>,
    pub computed: Value,
    pub tolerance: Tolerance,
    pub kind: Kind,
    pub bound: Bound,
    pub pass: bool,
    pub note: String,
}

/// Reads `claims.toml`.
///
/// # Errors
/// Line and column; a key that is there twice; `published` and `expected` not as the kind has them; words with a tolerance;
/// a tolerance that is negative or no number; an erratum that is what was published.
pub fn parse(text: &str) -> Result<Vec<Published>, Failure> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct File {
        claim: Vec<Published>,
    }
    let file: File = toml::from_str(text).map_err(|e| Failure::new(format!("claims.toml: {e}")))?;
    for (k, claim) in file.claim.iter().enumerate() {
        let key = &claim.key;
        let wrong = |what: &str| Err(Failure::new(format!("claims.toml: `{key}` {what}")));
        if file.claim[..k].iter().any(|c| c.key == *key) {
            return wrong("is there twice");
        }
        let Tolerance { absolute, relative } = claim.tolerance;
        if !(absolute >= 0.0 && relative >= 0.0 && absolute.is_finite() && relative.is_finite()) {
            return wrong("has a tolerance that is negative or not finite");
        }
        let right = match (claim.kind.is_published(), &claim.published, &claim.expected) {
            (true, Some(said), None) | (false, None, Some(said)) => said,
            (true, ..) => return wrong("is of the paper: write `published`, and no `expected`"),
            (false, ..) => {
                return wrong("is not of the paper: write `expected`, and no `published`");
            }
        };
        if claim.erratum.is_some() && !claim.kind.is_published() {
            return wrong("has an erratum, and is not of the paper");
        }
        if claim.erratum.as_ref() == Some(right) {
            return wrong("has an erratum that is what was published");
        }
        let right = claim.erratum.as_ref().unwrap_or(right);
        let words = matches!(right, Value::Text(_));
        if words && claim.tolerance != Tolerance::default() {
            return wrong(
                "is in words and has a tolerance; write the number or leave the tolerance out",
            );
        }
        if !words && claim.kind == Kind::Qualitative {
            return wrong(
                "is qualitative and a number; write words, or kind = \"exact\" or \"digitised\"",
            );
        }
    }
    Ok(file.claim)
}

/// Compares claims with computed values: exactly one value for each claim, none for others.
///
/// # Errors
/// Names all keys without value, without claim, or with two values; values of another kind than published.
pub fn compare(
    published: &[Published],
    computed: &[(String, Computed)],
    small: bool,
) -> Result<Vec<Claim>, Failure> {
    let due: Vec<&Published> = published
        .iter()
        .filter(|p| !(small && p.full_only))
        .collect();
    let values = |key: &str| computed.iter().filter(|(k, _)| k == key).count();
    let quoted = |keys: Vec<&str>| keys.join("`, `");
    let mut problems = Vec::new();
    let missing: Vec<&str> = due
        .iter()
        .map(|p| p.key.as_str())
        .filter(|k| values(k) == 0)
        .collect();
    if !missing.is_empty() {
        problems.push(format!(
            "claims without a computed value: `{}`",
            quoted(missing)
        ));
    }
    let mut twice: Vec<&str> = computed
        .iter()
        .map(|(k, _)| k.as_str())
        .filter(|k| values(k) > 1)
        .collect();
    twice.dedup();
    if !twice.is_empty() {
        problems.push(format!("more than one value for: `{}`", quoted(twice)));
    }
    let unknown: Vec<&str> = computed
        .iter()
        .map(|(k, _)| k.as_str())
        .filter(|k| !due.iter().any(|p| p.key == *k))
        .collect();
    if !unknown.is_empty() {
        problems.push(format!(
            "values without a claim in claims.toml: `{}`",
            quoted(unknown)
        ));
    }
    if !problems.is_empty() {
        return Err(Failure::new(problems.join("; ")));
    }
    due.into_iter()
        .filter_map(|p| Some((p, &computed.iter().find(|(k, _)| *k == p.key)?.1)))
        .map(|(p, value)| judged(p, value))
        .collect()
}

fn judged(p: &Published, value: &Computed) -> Result<Claim, Failure> {
    let said = p.said()?;
    let right = p.erratum.as_ref().unwrap_or(said);
    let same = |found: &Value, other: &Value| match (found, other) {
        (Value::Number(x), Value::Number(y)) => p.tolerance.allows(*x, *y),
        (x, y) => x == y,
    };
    // an erratum that the printed value would pass, too, says nothing
    let passes = |found: &Value| same(found, right) && (p.erratum.is_none() || !same(found, said));
    let (pass, computed) = match (right, value) {
        (Value::Number(_), Computed::Number(x)) => {
            let found = Value::Number(*x);
            (passes(&found), found)
        }
        (Value::Text(_), Computed::Text(text)) if p.words().0 => {
            let found = Value::Text(text.clone());
            (passes(&found), found)
        }
        (Value::Text(_), Computed::Holds(text, holds)) if p.words().1 => {
            (*holds, Value::Text(text.clone()))
        }
        _ => {
            let wants = match (right, p.words().1) {
                (Value::Number(_), _) => "a number: use Findings::number",
                (Value::Text(_), true) => "whether it holds: use Findings::holds",
                (Value::Text(_), false) => "words: use Findings::text",
            };
            return Err(Failure::new(format!("the claim `{}` takes {wants}", p.key)));
        }
    };
    Ok(Claim {
        key: p.key.clone(),
        what: p.what.clone(),
        published: p.published.clone(),
        expected: p.expected.clone(),
        erratum: p.erratum.clone(),
        computed,
        tolerance: p.tolerance,
        kind: p.kind,
        bound: p.bound,
        pass,
        note: p.note.clone(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLAIMS: &str = r#"
[[claim]]
key = "n"
what = "steps"
published = 184
kind = "exact"

[[claim]]
key = "cost"
what = "relative cost"
published = 0.22
tolerance = { absolute = 0.005 }
kind = "digitised"
full_only = true

[[claim]]
key = "limit"
what = "f for m = 2"
published = "8/7"
kind = "exact"

[[claim]]
key = "shape"
what = "two pulses"
published = "the pulse splits"
kind = "qualitative"
"#;

    fn values(n: f64, cost: f64, limit: &str, holds: bool) -> Vec<(String, Computed)> {
        vec![
            ("n".into(), Computed::Number(n)),
            ("cost".into(), Computed::Number(cost)),
            ("limit".into(), Computed::Text(limit.into())),
            ("shape".into(), Computed::Holds("two maxima".into(), holds)),
        ]
    }

    fn passes(values: &[(String, Computed)]) -> Vec<bool> {
        let claims = compare(&parse(CLAIMS).unwrap(), values, false).unwrap();
        claims.iter().map(|c| c.pass).collect()
    }

    #[test]
    fn values_are_compared_with_their_tolerance() {
        assert_eq!(passes(&values(184.0, 0.2202, "8/7", true)), [true; 4]);
        assert_eq!(passes(&values(184.1, 0.226, "8/9", false)), [false; 4]);
        assert_eq!(
            passes(&values(f64::NAN, f64::INFINITY, "", true)),
            [false, false, false, true]
        );
        assert!(
            Tolerance {
                absolute: 0.0,
                relative: 0.01
            }
            .allows(99.1, 100.0)
        );
        assert!(
            !Tolerance {
                absolute: 0.5,
                relative: 0.01
            }
            .allows(98.9, 100.0)
        );
    }

    #[test]
    fn an_erratum_holds_where_the_printed_value_does_not() {
        let text = "[[claim]]\nkey = \"f\"\nwhat = \"limit\"\npublished = 1.082\nerratum = 1.0802\n\
                    tolerance = { absolute = 5e-5 }\nkind = \"exact\"\n";
        let published = parse(text).unwrap();
        let pass = |x: f64| {
            let values = [("f".to_string(), Computed::Number(x))];
            compare(&published, &values, false).unwrap()[0].pass
        };
        assert!(pass(1.08018) && !pass(1.082) && !pass(1.0815));
        // a tolerance so wide that both pass
        let wide = parse(&text.replace("5e-5", "5e-3")).unwrap();
        let values = [("f".to_string(), Computed::Number(1.0802))];
        assert!(!compare(&wide, &values, false).unwrap()[0].pass);
    }

    #[test]
    fn own_findings_and_pins_expect() {
        let text = "[[claim]]\nkey = \"a\"\nwhat = \"words\"\nexpected = \"below 1\"\nkind = \"own\"\n\
                    [[claim]]\nkey = \"b\"\nwhat = \"number\"\nexpected = 2\nkind = \"own\"\n\
                    [[claim]]\nkey = \"c\"\nwhat = \"before\"\nexpected = 3\nkind = \"pin\"\nbound = \"after\"\n";
        let values = [
            ("a".to_string(), Computed::Holds("0.5".into(), true)),
            ("b".to_string(), Computed::Number(2.0)),
            ("c".to_string(), Computed::Number(4.0)),
        ];
        let claims = compare(&parse(text).unwrap(), &values, false).unwrap();
        assert_eq!(
            claims.iter().map(|c| c.pass).collect::<Vec<_>>(),
            [true, true, false]
        );
        assert_eq!(claims[2].bound, Bound::After);
        assert!(claims.iter().all(|c| c.published.is_none()));
    }

    #[test]
    fn every_claim_has_one_value_and_every_value_a_claim() {
        let published = parse(CLAIMS).unwrap();
        let told = |values: &[(String, Computed)], small: bool| {
            compare(&published, values, small).unwrap_err().to_string()
        };
        let good = values(1.0, 1.0, "", true);
        assert_eq!(
            told(&good[..2], false),
            "claims without a computed value: `limit`, `shape`"
        );
        // the small variant is not asked for the cost, and must not answer
        assert_eq!(
            told(&good, true),
            "values without a claim in claims.toml: `cost`"
        );
        let small: Vec<_> = good.iter().filter(|v| v.0 != "cost").cloned().collect();
        assert_eq!(compare(&published, &small, true).unwrap().len(), 3);
        let mut twice = good.clone();
        twice.push(("n".into(), Computed::Number(2.0)));
        assert!(told(&twice, false).contains("more than one value for: `n`"));
        let mut kind = good;
        kind[0].1 = Computed::Text("184".into());
        assert_eq!(
            told(&kind, false),
            "the claim `n` takes a number: use Findings::number"
        );
    }

    #[test]
    fn mistakes_in_claims_are_named() {
        for (change, message) in [
            (
                ("published = 184", "published = 184\nnumber = 3"),
                "unknown field `number`",
            ),
            (("key = \"cost\"", "key = \"n\""), "`n` is there twice"),
            (
                ("absolute = 0.005", "absolute = -1"),
                "`cost` has a tolerance that is negative",
            ),
            (
                (
                    "published = \"8/7\"",
                    "published = \"8/7\"\ntolerance = { relative = 0.1 }",
                ),
                "`limit` is in words and has a tolerance",
            ),
            (
                ("kind = \"exact\"", "kind = \"qualitative\""),
                "`n` is qualitative and a number",
            ),
            (
                ("kind = \"exact\"", "kind = \"exakt\""),
                "unknown variant `exakt`",
            ),
            (
                ("kind = \"exact\"", "kind = \"pin\""),
                "`n` is not of the paper: write `expected`",
            ),
            (
                ("published = 184", "expected = 184"),
                "`n` is of the paper: write `published`",
            ),
            (
                ("published = 184", "published = 184\nerratum = 184"),
                "`n` has an erratum that is what was published",
            ),
        ] {
            let text = CLAIMS.replacen(change.0, change.1, 1);
            let told = parse(&text).unwrap_err().to_string();
            assert!(told.contains(message), "{told}");
        }
    }
}
