//! Keys and words of decks that were called otherwise before: old decks go on being read, with a note.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Where (keys of the tables around it, `*`: any), the old key, the key of today.
const KEYS: [(&str, &str, &str); 23] = [
    ("", "condition", "boundary_condition"),
    ("", "indenter", "rigid_body"),
    ("", "bond_factor", "bond_stiffness"),
    ("bond_stiffness", "value", "factor"),
    ("", "thermal", "initial_velocities"),
    ("", "volume_scaling", "partial_volume_correction"),
    ("", "own_horizon", "variable_horizon"),
    ("body", "own_horizon", "variable_horizon"),
    ("toughness", "stretch_factor", "critical_stretch_factor"),
    ("contact", "bonded", "reference_fraction"),
    ("contact", "free", "spacing_multiple"),
    ("material.fracture", "release", "breakage"),
    ("material.*.fracture", "release", "breakage"),
    ("interface.fracture", "release", "breakage"),
    ("rigid_body", "spin", "angular_velocity"),
    ("probe", "indenter", "rigid_body"),
    ("sets.*", "mark", "block"),
    ("material.law", "lps_as_typed", "lps_3d"),
    ("material.law", "position_aware", "pals"),
    ("material.*.law", "lps_as_typed", "lps_3d"),
    ("material.*.law", "position_aware", "pals"),
    ("interface.law", "lps_as_typed", "lps_3d"),
    ("interface.law", "position_aware", "pals"),
];

/// The key that was `interface` as long as it is a word; `[[interface]]` is another.
const MIXING: (&str, &str) = ("interface", "bond_mixing");

/// Where, the old word, the word of today; of lists of words each.
const WORDS: [(&str, &str, &str); 25] = [
    ("influence", "conical", "linear"),
    ("body.influence", "conical", "linear"),
    ("interface.influence", "conical", "linear"),
    ("bond_mixing", "series", "harmonic"),
    ("bond_mixing", "parallel", "arithmetic"),
    ("precrack.kind", "absent", "excluded"),
    ("precrack.stage", "motion", "dynamics"),
    ("boundary_condition.stage", "motion", "dynamics"),
    ("rigid_body.stage", "motion", "dynamics"),
    ("run.integrator", "still", "none"),
    ("statics.control", "breaking", "sequentially_linear"),
    ("statics.control", "opening", "indirect_displacement"),
    ("material.fracture.breakage", "at_once", "before_force"),
    ("material.*.fracture.breakage", "at_once", "before_force"),
    ("interface.fracture.breakage", "at_once", "before_force"),
    ("probe.measure", "contour", "j_integral"),
    ("probe.measure", "indenter", "rigid_body"),
    ("probe.of", "turn", "rotation"),
    ("probe.of", "spin", "angular_velocity"),
    ("probe.of", "mark", "block"),
    ("output.fields", "mark", "block"),
    ("output.pictures.field", "mark", "block"),
    ("output.pictures.fields", "mark", "block"),
    ("output.space_time", "mark", "block"),
    ("output.space_time.field", "mark", "block"),
];

/// What has been renamed in a deck: the place of the first of each, and what to write.
#[derive(Debug, Default)]
pub(super) struct Renames(Vec<(Range<usize>, String)>);

/// Both names of a key stand in one table.
#[derive(Debug)]
pub(super) struct Twice {
    pub span: Range<usize>,
    pub old: &'static str,
    pub new: &'static str,
}

impl Renames {
    fn add(&mut self, span: Range<usize>, old: &str, new: &str) {
        let text = format!("`{old}` is called `{new}` now");
        if self.0.iter().all(|(_, said)| *said != text) {
            self.0.push((span, text));
        }
    }

    /// Where each is, and what a user should know of it.
    pub fn all(&self) -> impl Iterator<Item = &(Range<usize>, String)> {
        self.0.iter()
    }

    /// Gives all that a deck says its name of today.
    ///
    /// # Errors
    /// A key stands there by both of its names.
    pub fn give(&mut self, deck: &mut DeTable) -> Result<(), Twice> {
        self.table(deck, &mut vec![])
    }

    fn table(&mut self, table: &mut DeTable, path: &mut Vec<String>) -> Result<(), Twice> {
        let text = |value: &Spanned<DeValue>| value.get_ref().is_str();
        let old: Vec<String> = table.keys().map(|key| key.get_ref().to_string()).collect();
        for key in old {
            let listed = KEYS.iter().find(|(at, old, _)| *old == key && is(at, path));
            let mixing =
                path.is_empty() && key == MIXING.0 && table.get(MIXING.0).is_some_and(text);
            let names = listed.map(|(_, old, new)| (*old, *new));
            if let Some((old, new)) = names.or(mixing.then_some(MIXING))
                && let Some((key, value)) = table.remove_entry(old)
            {
                if table.contains_key(new) {
                    let span = key.span();
                    return Err(Twice { span, old, new });
                }
                self.add(key.span(), old, new);
                table.insert(Spanned::new(key.span(), new.into()), value);
            }
        }
        for (key, value) in table.iter_mut() {
            path.push(key.get_ref().to_string());
            self.value(value, path)?;
            path.pop();
        }
        Ok(())
    }

    fn value(&mut self, at: &mut Spanned<DeValue>, path: &mut Vec<String>) -> Result<(), Twice> {
        let span = at.span();
        match at.get_mut() {
            DeValue::Table(table) => self.table(table, path),
            DeValue::Array(items) => items.iter_mut().try_for_each(|i| self.value(i, path)),
            DeValue::String(word) => {
                let found = WORDS
                    .iter()
                    .find(|(at, old, _)| *old == *word && is(at, path));
                if let Some((_, old, new)) = found {
                    self.add(span, old, new);
                    *word = (*new).into();
                }
                Ok(())
            }
            DeValue::Integer(_)
            | DeValue::Float(_)
            | DeValue::Boolean(_)
            | DeValue::Datetime(_) => Ok(()),
        }
    }
}

/// Is this the place of a list? Entries that `--set` numbers do not count.
fn is(at: &str, path: &[String]) -> bool {
    let mut path = path.iter().filter(|key| key.parse::<usize>().is_err());
    let mut at = at.split('.').filter(|key| !key.is_empty());
    loop {
        match (at.next(), path.next()) {
            (None, None) => return true,
            (Some("*"), Some(_)) => {}
            (Some(a), Some(b)) if a == b => {}
            _ => return false,
        }
    }
}

/// The dotted key of today of a key from the top of a deck, if a part of it was called otherwise.
pub(super) fn path(key: &str) -> Option<String> {
    let mut path: Vec<String> = vec![];
    let mut changed = false;
    for part in key.split('.') {
        let found = KEYS
            .iter()
            .find(|(at, old, _)| *old == part && is(at, &path));
        changed |= found.is_some();
        path.push(found.map_or(part, |(_, _, new)| new).to_string());
    }
    changed.then(|| path.join("."))
}

/// What a key, with the tables around it or alone, is called today, if it was called otherwise.
#[must_use]
pub fn renamed(key: &str) -> Option<String> {
    let alone = || {
        let mut known = KEYS.iter().filter(|(_, old, _)| *old == key);
        known.next().map(|(_, _, new)| (*new).to_string())
    };
    path(key).or_else(alone)
}
