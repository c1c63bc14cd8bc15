//! `pair_style`, `pair_coeff`.

use super::Args;
use crate::error::{Place, Problem, Result};
use crate::host::{LpsCoefficients, PmbCoefficients};
use crate::session::{PairState, Session, Store};

impl Session<'_> {
    fn pairs_may_change(&self) -> Result<()> {
        match self.store {
            Store::Atoms(_) => Ok(()),
            Store::Engine(_) => Err(Problem::new(
                "the material is fixed since the first `run`, which built the bonds",
            )
            .help("move this command before the first `run`")),
        }
    }

    pub(super) fn pair_style(&mut self, args: &mut Args) -> Result<()> {
        let style = args.next("`peri/pmb` or `peri/lps`")?;
        let pairs = self.types * self.types;
        let pair = match style.as_str() {
            "peri/pmb" => PairState::Pmb(vec![None; pairs]),
            "peri/lps" => PairState::Lps(vec![None; pairs]),
            _ => return Err(args.unknown(style, "the pair style", ["peri/pmb", "peri/lps"])),
        };
        args.finish()?;
        self.pairs_may_change()?;
        self.pair = Some(pair);
        Ok(())
    }

    /// The first pairs without coefficients, for messages.
    pub(super) fn pairs_missing(&self) -> String {
        let types = self.types;
        let given = |place: usize| match &self.pair {
            Some(PairState::Pmb(table)) => table.get(place).is_some_and(Option::is_some),
            Some(PairState::Lps(table)) => table.get(place).is_some_and(Option::is_some),
            None => false,
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
        self.domain()?;
        let types = self.types;
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
        let pmb = match &self.pair {
            None => {
                return Err(Problem::new("`pair_coeff` needs a pair style")
                    .help("write `pair_style peri/pmb` before"));
            }
            Some(PairState::Pmb(_)) => true,
            Some(PairState::Lps(_)) => false,
        };
        let names: &[&str] = if pmb {
            &[
                "the micromodulus c",
                "the horizon",
                "the critical stretch s00",
                "alpha",
            ]
        } else {
            &[
                "the bulk modulus K",
                "the shear modulus G",
                "the horizon",
                "the critical stretch s00",
                "alpha",
            ]
        };
        let mut v = Vec::new();
        for (k, name) in names.iter().enumerate() {
            let needed = args.number(name).and_then(|x| match x {
                // a horizon of 0 bonds nothing
                x if k + 3 == names.len() && !(x >= 0.0) => Err(Problem::new(format!(
                    "{name} must not be negative, it is {x}"
                ))),
                x => Ok(x),
            });
            v.push(needed.map_err(|p| {
                if p.help.is_some() {
                    return p;
                }
                p.help(if pmb {
                    "pair_coeff I J c horizon s00 alpha"
                } else {
                    "pair_coeff I J K G horizon s00 alpha"
                })
            })?);
        }
        args.finish()?;
        // a pair may be given either way round; LAMMPS takes I <= J
        let both = |i: usize, j: usize| [i * types + j, j * types + i];
        let (path, text, span) = &self.here;
        let here = Place::line(path, text, *span);
        self.pair_places.resize(types * types, Place::Command);
        for i in ranges[0].clone() {
            for j in ranges[1].clone().filter(|j| *j >= i) {
                for place in both(i, j) {
                    self.pair_places[place] = here.clone();
                    match &mut self.pair {
                        Some(PairState::Pmb(table)) => {
                            grow(table, types);
                            table[place] = Some(PmbCoefficients {
                                micromodulus: v[0],
                                horizon: v[1],
                                critical_stretch: v[2],
                                alpha: v[3],
                            });
                        }
                        Some(PairState::Lps(table)) => {
                            grow(table, types);
                            table[place] = Some(LpsCoefficients {
                                bulk: v[0],
                                shear: v[1],
                                horizon: v[2],
                                critical_stretch: v[3],
                                alpha: v[4],
                            });
                        }
                        None => {}
                    }
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

/// `pair_style` may come before the box, when the number of types is not known.
fn grow<T>(table: &mut Vec<Option<T>>, types: usize) {
    if table.len() != types * types {
        table.clear();
        table.resize_with(types * types, || None);
    }
}
