//! `pair_style`, `pair_coeff`.

use super::Args;
use crate::error::{Place, Problem, Result};
use crate::host::Style;
use crate::pair::HORIZON;
use crate::session::{PairState, Session, Store};

impl Session<'_> {
    fn pairs_may_change(&self) -> Result<()> {
        match self.population.store {
            Store::Atoms(_) => Ok(()),
            Store::Engine(_) => Err(Problem::new(
                "the material is fixed since the first `run`, which built the bonds",
            )
            .help("move this command before the first `run`")),
        }
    }

    pub(super) fn pair_style(&mut self, args: &mut Args) -> Result<()> {
        let word = args.next("a style such as `peri/lps`")?;
        let named = Style::ALL.into_iter().find(|s| s.name() == word.as_str());
        let Some(style) = named else {
            return Err(args.unknown(word, "the pair style", Style::ALL.map(Style::name)));
        };
        args.finish()?;
        self.pairs_may_change()?;
        self.pairs.state = Some(PairState {
            style,
            values: vec![None; self.population.types * self.population.types],
        });
        Ok(())
    }

    /// The first pairs without coefficients, for messages.
    pub(super) fn pairs_missing(&self) -> String {
        let types = self.population.types;
        let given = |place: usize| {
            let values = self.pairs.state.as_ref().and_then(|p| p.values.get(place));
            values.is_some_and(Option::is_some)
        };
        let pairs = (0..types).flat_map(|i| (i..types).map(move |j| (i, j)));
        let mut missing = pairs.filter(|(i, j)| !given(i * types + j));
        let first: Vec<String> = missing
            .by_ref()
            .take(3)
            .map(|(i, j)| format!("{} {}", i + 1, j + 1))
            .collect();
        match missing.count() {
            0 => first.join(", "),
            more => format!("{} and {more} more", first.join(", ")),
        }
    }

    pub(super) fn pair_coeff(&mut self, args: &mut Args) -> Result<()> {
        self.pairs_may_change()?;
        self.space.domain()?;
        let types = self.population.types;
        let words = [args.next("a type or range")?, args.next("a type or range")?];
        let mut ranges = Vec::new();
        for word in words {
            let range = self.range(word, types as u64)?;
            if *range.start() < 1 || *range.end() > types as u64 || range.is_empty() {
                return Err(Problem::at(
                    word.span,
                    format!("atom types go from 1 to {types}"),
                ));
            }
            ranges.push(*range.start() as usize - 1..*range.end() as usize);
        }
        let Some(PairState { style, values }) = &mut self.pairs.state else {
            return Err(Problem::new("`pair_coeff` needs a pair style")
                .help("write `pair_style peri/pmb` before"));
        };
        let (names, short) = style.coefficients();
        let mut numbers = Vec::new();
        for name in names {
            let needed = args.number(name).and_then(|x| match x {
                // a horizon of 0 bonds nothing
                x if *name == HORIZON && !(x >= 0.0) => Err(Problem::new(format!(
                    "{name} must not be negative, it is {x}"
                ))),
                x => Ok(x),
            });
            numbers.push(needed.map_err(|p| match p.help {
                Some(_) => p,
                None => p.help(format!("pair_coeff I J {short}")),
            })?);
        }
        args.finish()?;
        // a pair may be given either way round; LAMMPS takes I <= J
        let both = |i: usize, j: usize| [i * types + j, j * types + i];
        let (path, text, span) = &self.here;
        let here = Place::line(path, text, *span);
        self.pairs.places.resize(types * types, Place::Command);
        // `pair_style` may come before the box, when the number of types is not known
        if values.len() != types * types {
            *values = vec![None; types * types];
        }
        for i in ranges[0].clone() {
            for j in ranges[1].clone().filter(|j| *j >= i) {
                for place in both(i, j) {
                    self.pairs.places[place] = here.clone();
                    values[place] = Some(numbers.clone());
                }
            }
        }
        if ranges[0].start >= ranges[1].end {
            return Err(Problem::new("no pair I <= J is in these ranges")
                .help("write the smaller type first"));
        }
        Ok(())
    }
}
