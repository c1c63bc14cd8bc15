//! `group`.

use std::ops::RangeInclusive;
use std::sync::Arc;

use super::Args;
use crate::atoms::Members;
use crate::error::{Problem, Result};
use crate::host::Quantity;
use crate::particles::Field;
use crate::session::Session;
use crate::text::Word;

/// LAMMPS's limit.
const MOST: usize = 32;

impl Session<'_> {
    /// Numbers of `3`, `*`, `2*`, `*5`, `2*5`, `2:5`.
    pub(super) fn range(&self, word: &Word, last: u64) -> Result<RangeInclusive<u64>> {
        let text = word.as_str();
        let bad = || {
            Problem::at(
                word.span,
                format!("`{text}` is not a number or a range like 1:5, 2* or *"),
            )
        };
        let number = |t: &str, default: u64| {
            if t.is_empty() {
                Ok(default)
            } else {
                t.parse().map_err(|_| bad())
            }
        };
        match text.split_once([':', '*']) {
            Some((a, b)) => Ok(number(a, 1)?..=number(b, last)?),
            None => number(text, 0).and_then(|n: u64| if n == 0 { Err(bad()) } else { Ok(n..=n) }),
        }
    }

    /// Atoms whose type passes `test`.
    pub(super) fn with_type(&self, test: impl Fn(u64) -> bool) -> Result<Members> {
        let mut types = vec![0u32; self.population.count()];
        self.scan(Field::Raw(Quantity::Type), |first, block| {
            types[first..]
                .iter_mut()
                .zip(block)
                .for_each(|(t, x)| *t = *x as u32);
        })?;
        Ok(Members::collect(types.len(), |i| test(u64::from(types[i]))))
    }

    pub(super) fn set_group(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let name = args.next("a group ID")?;
        let id = name.as_str().to_string();
        if id == "all" {
            return Err(Problem::at(name.span, "the group `all` cannot be changed"));
        }
        let style = args.next("a group style")?;
        let n = self.population.count();
        let old = self.population.group(&id).ok();
        let mut new = match style.as_str() {
            "delete" => {
                self.population.group(&id)?;
                if self
                    .fixes
                    .all
                    .iter()
                    .any(|f| Some(&f.members) == old.as_ref())
                {
                    return Err(Problem::new(format!("group `{id}` is used by a fix")));
                }
                self.population.groups.retain(|(g, _)| *g != id);
                return args.finish();
            }
            "clear" => Members::collect(n, |_| false),
            "empty" => Members::collect(n, |_| false),
            "region" => {
                let word = args.next("a region ID")?;
                let region = self
                    .region(word.as_str())
                    .map_err(|p| p.or_at(word.span))?
                    .clone();
                let x = self.positions()?;
                Members::collect(n, |i| region.contains(x[i]))
            }
            "type" | "id" => self.by_number(args, style.as_str() == "type")?,
            "union" | "subtract" | "intersect" => {
                let mut groups = Vec::new();
                while let Some(word) = args.optional() {
                    groups.push(
                        self.population
                            .group(word.as_str())
                            .map_err(|p| p.or_at(word.span))?,
                    );
                }
                let [first, rest @ ..] = groups.as_slice() else {
                    args.next("a group ID")?;
                    return Ok(());
                };
                Members::collect(n, |i| match style.as_str() {
                    "union" => groups.iter().any(|g| g.contains(i)),
                    "intersect" => groups.iter().all(|g| g.contains(i)),
                    _ => first.contains(i) && !rest.iter().any(|g| g.contains(i)),
                })
            }
            _ => {
                let known = [
                    "region",
                    "type",
                    "id",
                    "union",
                    "subtract",
                    "intersect",
                    "empty",
                    "clear",
                    "delete",
                ];
                return Err(args.unknown(style, "the group style", known));
            }
        };
        args.finish()?;
        // a second definition adds, except `clear`
        if let (Some(old), true) = (&old, style.as_str() != "clear") {
            let more = new;
            new = Members::collect(n, |i| old.contains(i) || more.contains(i));
        }
        let count = new.count(n);
        let new = Arc::new(new);
        let known = self.population.groups.len();
        match self.population.groups.iter_mut().find(|(g, _)| *g == id) {
            Some((_, m)) => *m = new,
            None if known >= MOST => return Err(Problem::new(format!("more than {MOST} groups"))),
            None => self.population.groups.push((id.clone(), new)),
        }
        self.console.print(&format!("{count} atoms in group {id}"));
        Ok(())
    }

    /// `type`/`id` with numbers, ranges `a:b`, `a:b:step`, or a comparison.
    fn by_number(&mut self, args: &mut Args, by_type: bool) -> Result<Members> {
        let numbers: Vec<u64> = if by_type {
            let mut types = Vec::with_capacity(self.population.count());
            self.scan(Field::Raw(Quantity::Type), |_, block| {
                types.extend(block.iter().map(|x| *x as u64))
            })?;
            types
        } else {
            (0..self.population.count())
                .map(|i| self.population.ids.get(i))
                .collect()
        };
        let number = |i: usize| numbers[i];
        let n = self.population.count();
        let first = args.next("a number, a range or a comparison")?;
        if ["<", ">", "<=", ">=", "==", "!=", "<>"].contains(&first.as_str()) {
            let a = args.count("a number", 0)?;
            let b = if first.as_str() == "<>" {
                args.count("a number", 0)?
            } else {
                0
            };
            return Ok(Members::collect(n, |i| {
                let x = number(i);
                match first.as_str() {
                    "<" => x < a,
                    ">" => x > a,
                    "<=" => x <= a,
                    ">=" => x >= a,
                    "==" => x == a,
                    "!=" => x != a,
                    _ => x >= a && x <= b,
                }
            }));
        }
        let mut ranges = Vec::new();
        let mut next = Some(first);
        while let Some(word) = next {
            let parts: Option<Vec<u64>> =
                word.as_str().split(':').map(|p| p.parse().ok()).collect();
            ranges.push(match parts.as_deref() {
                Some([a]) => (*a, *a, 1),
                Some([a, b]) if a <= b => (*a, *b, 1),
                Some([a, b, s]) if a <= b && *s > 0 => (*a, *b, *s),
                _ => {
                    return Err(Problem::at(
                        word.span,
                        format!("`{}` is not N, N:M or N:M:STEP", word.as_str()),
                    ));
                }
            });
            next = args.optional();
        }
        Ok(Members::collect(n, |i| {
            let x = number(i);
            ranges
                .iter()
                .any(|(a, b, s)| x >= *a && x <= *b && (x - a).is_multiple_of(*s))
        }))
    }
}
