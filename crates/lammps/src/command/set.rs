//! `set`.

use super::Args;
use crate::atoms::Members;
use crate::error::{Problem, Result};
use crate::fix::Input;
use crate::host::{BLOCK, Quantity};
use crate::park::Park;
use crate::session::Session;
use crate::text::Word;
use crate::variable::tree::Tree;

impl Session<'_> {
    pub(super) fn set_atoms(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let style = args.next("`group`, `atom`, `type` or `region`")?;
        let word = args.next("an ID or range")?;
        let members = self.chosen(args, style, word)?;
        if args.left() == 0 {
            args.next("a property")?;
        }
        self.console.print("Setting atom values ...");
        while let Some(word) = args.optional() {
            let name = word.as_str();
            if name.starts_with("type/") {
                self.set_some_types(args, word, &members)?;
                continue;
            }
            let quantity = quantity(args, word)?;
            let value = args.input(name)?;
            self.set_values(word, quantity, &value, &members)?;
            self.console.print(&format!(
                "  {} settings made for {name}",
                members.count(self.population.count())
            ));
        }
        Ok(())
    }

    /// The atoms that `STYLE WORD` means.
    fn chosen(&mut self, args: &Args, style: &Word, word: &Word) -> Result<Members> {
        Ok(match style.as_str() {
            "group" => self
                .population
                .group(word.as_str())
                .map_err(|p| p.or_at(word.span))?
                .as_ref()
                .clone(),
            "region" => {
                let region = self
                    .region(word.as_str())
                    .map_err(|p| p.or_at(word.span))?
                    .clone();
                let x = self.positions()?;
                Members::collect(x.len(), |i| region.contains(x[i]))
            }
            "atom" => {
                let range = self.range(
                    word,
                    self.population
                        .ids
                        .get(self.population.count().saturating_sub(1)),
                )?;
                Members::collect(self.population.count(), |i| {
                    range.contains(&self.population.ids.get(i))
                })
            }
            "type" => {
                let range = self.range(word, self.population.types as u64)?;
                self.with_type(|t| range.contains(&t))?
            }
            _ => return Err(args.unknown(style, "the style", ["group", "atom", "type", "region"])),
        })
    }

    /// Gives these atoms a number each: one for all, or that of a formula.
    fn set_values(
        &mut self,
        word: &Word,
        quantity: Quantity,
        value: &Input,
        members: &Members,
    ) -> Result<()> {
        let types = self.population.types as f64;
        let (allowed, what) = allowed(quantity, types);
        let wrong = |x: f64, who: String| {
            Problem::at(
                word.span,
                format!("{} must {what}, found {x}{who}", word.as_str()),
            )
        };
        let tree = match value {
            Input::Number(x) => Tree::Number(*x),
            Input::Variable(v) => self.variable_tree(v)?,
        };
        if let (Tree::Number(x), Members::All) = (&tree, members) {
            if !allowed(*x) {
                return Err(wrong(*x, String::new()));
            }
            self.population.store.particles_mut().fill(quantity, *x)?;
            return Ok(());
        }
        let n = self.population.count();
        let mut old = vec![0.0; BLOCK];
        let mut new = vec![0.0; BLOCK];
        // all values first: a formula may use what is being set
        let mut all = vec![0.0; n];
        for first in (0..n).step_by(BLOCK) {
            let m = BLOCK.min(n - first);
            self.population
                .store
                .particles()
                .read(quantity, first, &mut old[..m])?;
            tree.fill(&self.view()?, &self.progress.clock(), first, &mut new[..m])?;
            for k in 0..m {
                let mine = members.contains(first + k);
                if mine && !allowed(new[k]) {
                    let id = self.population.ids.get(first + k);
                    return Err(wrong(new[k], format!(" for the atom with id {id}")));
                }
                all[first + k] = if mine { new[k] } else { old[k] };
            }
        }
        self.population
            .store
            .particles_mut()
            .write(quantity, 0, &all)?;
        Ok(())
    }

    /// `type/fraction TYPE FRACTION SEED`: atoms become this type with a probability. Each draws its own number, which
    /// depends on its place.
    fn set_some_types(&mut self, args: &mut Args, word: &Word, members: &Members) -> Result<()> {
        if word.as_str() != "type/fraction" {
            return Err(args.unknown(word, "the property", ["type/fraction"]).help(
                "type/ratio and type/subset pick atoms in LAMMPS's order; type/fraction does not",
            ));
        }
        let kind = args.count("an atom type", 1)?;
        if kind > self.population.types as u64 {
            return Err(Problem::at(
                word.span,
                format!(
                    "atom type {kind} is not between 1 and {}",
                    self.population.types
                ),
            ));
        }
        let fraction = args.number("the fraction")?;
        if !(0.0..=1.0).contains(&fraction) {
            return Err(Problem::at(
                word.span,
                format!("the fraction must be from 0 to 1, found {fraction}"),
            ));
        }
        let seed = args.seed()?;
        let x = self.positions()?;
        let mut types = self.population.raw(Quantity::Type)?;
        let mut made = 0;
        for i in (0..types.len()).filter(|i| members.contains(*i)) {
            if Park::at(seed, x[i]).uniform() <= fraction {
                types[i] = kind as f64;
                made += 1;
            }
        }
        self.population
            .store
            .particles_mut()
            .write(Quantity::Type, 0, &types)?;
        self.console
            .print(&format!("  {made} settings made for type/fraction"));
        Ok(())
    }
}

/// Words of what `set` sets.
const SETTABLE: [(&str, Quantity); 10] = [
    ("density", Quantity::Density),
    ("mass", Quantity::Density),
    ("volume", Quantity::Volume),
    ("type", Quantity::Type),
    ("x", Quantity::Position(0)),
    ("y", Quantity::Position(1)),
    ("z", Quantity::Position(2)),
    ("vx", Quantity::Velocity(0)),
    ("vy", Quantity::Velocity(1)),
    ("vz", Quantity::Velocity(2)),
];

fn quantity(args: &Args, word: &Word) -> Result<Quantity> {
    if let Some((_, quantity)) = SETTABLE.iter().find(|(name, _)| *name == word.as_str()) {
        return Ok(*quantity);
    }
    let known = [
        "density",
        "volume",
        "type",
        "type/fraction",
        "x",
        "y",
        "z",
        "vx",
        "vy",
        "vz",
    ];
    Err(args.unknown(word, "the property", known))
}

/// Which numbers a quantity may have, and what others are told to be.
fn allowed(quantity: Quantity, types: f64) -> (impl Fn(f64) -> bool, String) {
    enum Kind {
        Positive,
        Type,
        Finite,
    }
    let (kind, what) = match quantity {
        Quantity::Density | Quantity::Volume => (Kind::Positive, "be positive".to_string()),
        Quantity::Type => (Kind::Type, format!("be a whole number from 1 to {types}")),
        Quantity::Position(_)
        | Quantity::Reference(_)
        | Quantity::Velocity(_)
        | Quantity::Force(_)
        | Quantity::Damage
        | Quantity::Dilatation
        | Quantity::CriticalStretch
        | Quantity::Energy
        | Quantity::Virial(_) => (Kind::Finite, "be finite".to_string()),
    };
    let allowed = move |x: f64| match kind {
        Kind::Positive => x > 0.0 && x.is_finite(),
        Kind::Type => x >= 1.0 && x <= types && x.fract() == 0.0,
        Kind::Finite => x.is_finite(),
    };
    (allowed, what)
}
