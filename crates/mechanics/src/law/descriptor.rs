//! What a law on the registry says of itself: its keys with dimensions, defaults and bounds, from which decks, schemas, lists and
//! reference pages follow; and how constants come of them.

use crate::columns::Dimension;
use crate::expression::Expression;
use crate::law::partner::Partner;
use crate::law::solid::eam_like::Solid;
use crate::quantity::rounded;
use crate::spec::{BondMixing, Influence, LawSpec, Moduli, Parameter, Parameters, Plane};
use std::borrow::Cow;

/// A law, or what else a spec names, as its users see it.
#[derive(Debug, Clone, PartialEq)]
pub struct Descriptor {
    /// Lower case with underscores; the same in decks and programs.
    pub name: Cow<'static, str>,
    /// One or two sentences, with the equation.
    pub doc: Cow<'static, str>,
    pub source: Cow<'static, str>,
    /// Keys as one would write them.
    pub example: Cow<'static, str>,
    /// The customary influence function.
    pub influence: Influence,
    pub memory: Memory,
    pub keys: Vec<Key>,
}

/// What a law remembers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Memory {
    Nothing,
    /// The path of deformation, however fast it was gone.
    Path,
    /// And how fast: equilibrium in increments of load means nothing to it, where they take no time.
    Time,
    /// And how fast, without a shear that rest could hold.
    Shock,
}

/// A constant of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    pub name: &'static str,
    pub value: Value,
    pub need: Need,
    pub doc: &'static str,
}

/// What a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    Number(Dimension, Bounds),
    /// So many numbers.
    List(usize, Dimension, Bounds),
    /// Three components, numbers or expressions of x, y, z: where to, however long.
    Direction,
    /// Rows of numbers, a dimension and bounds for each column.
    Rows(&'static [(&'static str, Dimension, Bounds)]),
    /// Rows of constants for triples of kinds: three kinds of atom, counted from 0, and a number for each column; in decks the name of a
    /// file that has them.
    Entries(&'static [Key]),
    /// One of these.
    Word(&'static [(&'static str, &'static str)]),
    /// Any word.
    Name,
    /// An expression of these variables, that measures this; `None`: whatever they make of it.
    Formula(&'static [&'static str], Option<Dimension>),
    /// Tables of functions: in decks the name of a file that has them, eam/alloy (setfl) or .eam (funcfl).
    Table,
}

/// Where a number may lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub least: f64,
    /// Is the least one allowed?
    pub inclusive: bool,
    /// Not beyond this.
    pub most: f64,
    /// Nor this itself?
    pub below: bool,
}

impl Bounds {
    pub const ANY: Bounds = Bounds {
        least: f64::NEG_INFINITY,
        inclusive: false,
        most: f64::INFINITY,
        below: false,
    };
    pub const POSITIVE: Bounds = Bounds {
        least: 0.0,
        inclusive: false,
        most: f64::INFINITY,
        below: false,
    };
    pub const NOT_NEGATIVE: Bounds = Bounds {
        least: 0.0,
        inclusive: true,
        most: f64::INFINITY,
        below: false,
    };
    /// From above 0 to 1.
    pub const PART: Bounds = Bounds {
        least: 0.0,
        inclusive: false,
        most: 1.0,
        below: false,
    };

    pub fn hold(&self, x: f64) -> bool {
        let above = x > self.least || (self.inclusive && x == self.least);
        let under = x < self.most || (!self.below && x == self.most);
        above && under && x.is_finite()
    }

    /// In words: `positive`, `from 0 on`, `above 0, at most 1`.
    pub fn words(&self) -> String {
        let low = match (self.least, self.inclusive) {
            (l, _) if l == f64::NEG_INFINITY => String::new(),
            (0.0, false) if self.most == f64::INFINITY => "positive".into(),
            (l, true) => format!("{l} or more"),
            (l, false) => format!("above {l}"),
        };
        let high = match self.most {
            m if m == f64::INFINITY => String::new(),
            m if self.below => format!("below {m}"),
            m => format!("at most {m}"),
        };
        match (low.is_empty(), high.is_empty()) {
            (true, true) => "any finite number".into(),
            (false, true) => low,
            (true, false) => high,
            (false, false) => format!("{low}, {high}"),
        }
    }
}

/// Must a key be given?
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Need {
    Given,
    /// Left out it is this.
    Default(f64),
    /// Left out it is this word.
    Word(&'static str),
    /// It may be left out, which is no number.
    Optional,
    /// One of the keys with this need is given.
    OneOf,
    /// Any two of the keys with this need are given.
    TwoOf,
    /// It is not taken, though one might expect it; the key's text says why, after the name of the law.
    Refused,
}

/// Isotropic elasticity: two of four.
pub const MODULI: [Key; 4] = [
    modulus("young", "Young's modulus E."),
    Key {
        name: "poisson",
        value: Value::Number(
            Dimension::NUMBER,
            Bounds {
                least: -1.0,
                inclusive: false,
                most: 0.5,
                below: true,
            },
        ),
        need: Need::TwoOf,
        doc: "Poisson's ratio ν, below ½.",
    },
    modulus("bulk", "Bulk modulus K of the solid."),
    modulus("shear", "Shear modulus G."),
];

const fn modulus(name: &'static str, doc: &'static str) -> Key {
    Key {
        name,
        value: Value::Number(Dimension::PRESSURE, Bounds::POSITIVE),
        need: Need::TwoOf,
        doc,
    }
}

/// A number that must be given.
pub const fn number(
    name: &'static str,
    dimension: Dimension,
    bounds: Bounds,
    doc: &'static str,
) -> Key {
    Key {
        name,
        value: Value::Number(dimension, bounds),
        need: Need::Given,
        doc,
    }
}

/// One of some words, the first by default.
pub const fn word(
    name: &'static str,
    words: &'static [(&'static str, &'static str)],
    doc: &'static str,
) -> Key {
    Key {
        name,
        value: Value::Word(words),
        need: Need::Word(words[0].0),
        doc,
    }
}

impl Key {
    /// The same with a default.
    pub const fn or(mut self, default: f64) -> Key {
        self.need = Need::Default(default);
        self
    }

    /// The same with another need.
    pub const fn need(mut self, need: Need) -> Key {
        self.need = need;
        self
    }

    /// What it measures, where it is made of numbers.
    pub fn dimension(&self) -> Option<Dimension> {
        match self.value {
            Value::Number(dimension, _) | Value::List(_, dimension, _) => Some(dimension),
            Value::Formula(_, dimension) => dimension,
            Value::Direction
            | Value::Rows(_)
            | Value::Entries(_)
            | Value::Word(_)
            | Value::Name
            | Value::Table => None,
        }
    }
}

/// The moduli among parameters.
///
/// # Errors
/// Not two of the four, or no stable solid has them.
pub fn moduli(parameters: &Parameters) -> Result<Moduli, String> {
    let get = |key| parameters.number(key);
    let (e, nu, k, g) = (get("young"), get("poisson"), get("bulk"), get("shear"));
    let given = [e, nu, k, g].iter().flatten().count();
    if given != 2 {
        return Err(format!(
            "{given} of young, poisson, bulk and shear are given, expected two"
        ));
    }
    let made = match (e, nu, k, g) {
        (Some(young), Some(poisson), ..) => Moduli { young, poisson },
        (Some(young), _, Some(k), _) => Moduli {
            young,
            poisson: (3.0 * k - young) / (6.0 * k),
        },
        (Some(young), _, _, Some(g)) => Moduli {
            young,
            poisson: young / (2.0 * g) - 1.0,
        },
        (_, Some(poisson), Some(k), _) => Moduli {
            young: 3.0 * k * (1.0 - 2.0 * poisson),
            poisson,
        },
        (_, Some(poisson), _, Some(g)) => Moduli {
            young: 2.0 * g * (1.0 + poisson),
            poisson,
        },
        (_, _, Some(k), Some(g)) => Moduli::from_bulk_shear(k, g),
        _ => return Err("expected two of young, poisson, bulk and shear".into()),
    };
    let stable = made.young > 0.0 && made.poisson > -1.0 && made.poisson < 0.5;
    if !stable {
        return Err(format!(
            "{} Young's modulus and Poisson's ratio {} are those of no stable solid: E > 0, −1 < ν < ½",
            if made.young > 0.0 {
                "a positive"
            } else {
                "no positive"
            },
            rounded(made.poisson, 6)
        ));
    }
    Ok(made)
}

/// The key that is wrong, empty if it is not one alone; and why.
pub type Wrong = (String, String);

impl Descriptor {
    /// A law without keys and memory, whose customary influence function is constant.
    pub fn new(name: &'static str, doc: &'static str) -> Descriptor {
        Descriptor {
            name: name.into(),
            doc: doc.into(),
            source: "".into(),
            example: "".into(),
            influence: Influence::Constant,
            memory: Memory::Nothing,
            keys: vec![],
        }
    }

    pub fn source(mut self, source: &'static str) -> Descriptor {
        self.source = source.into();
        self
    }

    pub fn example(mut self, example: &'static str) -> Descriptor {
        self.example = example.into();
        self
    }

    pub fn influence(mut self, influence: Influence) -> Descriptor {
        self.influence = influence;
        self
    }

    pub fn memory(mut self, memory: Memory) -> Descriptor {
        self.memory = memory;
        self
    }

    pub fn keys(mut self, keys: &[Key]) -> Descriptor {
        self.keys.extend_from_slice(keys);
        self
    }

    /// A number that must be given.
    pub fn number(
        self,
        name: &'static str,
        dimension: Dimension,
        bounds: Bounds,
        doc: &'static str,
    ) -> Descriptor {
        self.keys(&[number(name, dimension, bounds, doc)])
    }

    pub fn key(&self, name: &str) -> Option<&Key> {
        self.keys.iter().find(|k| k.name == name)
    }

    /// Keys that may be given.
    pub fn taken(&self) -> impl Iterator<Item = &Key> + Clone {
        self.keys.iter().filter(|k| k.need != Need::Refused)
    }

    fn names(&self, need: Need) -> Vec<&'static str> {
        let with = self.keys.iter().filter(|k| k.need == need);
        with.map(|k| k.name).collect()
    }

    /// Do parameters fit the keys? Defaults are filled in.
    ///
    /// # Errors
    /// The key that does not fit, and why.
    pub fn check(&self, parameters: &mut Parameters) -> Result<(), Wrong> {
        self.check_of("law", parameters)
    }

    /// The same of something else that is called `what`.
    pub(crate) fn check_of(&self, what: &str, parameters: &mut Parameters) -> Result<(), Wrong> {
        for (name, given) in &parameters.0 {
            let wrong = |message: String| (name.clone(), message);
            match self.key(name) {
                None => {
                    let known: Vec<&str> = self.taken().map(|k| k.name).collect();
                    let known = known.join(", ");
                    return Err(wrong(format!(
                        "the {} {} has no key `{name}`; it has {known}",
                        what, self.name
                    )));
                }
                Some(key) if key.need == Need::Refused => {
                    return Err(wrong(format!("{} {}", self.name, key.doc)));
                }
                Some(key) => key.value.check(name, given).map_err(wrong)?,
            }
        }
        let given = |name: &&str| parameters.get(name).is_some();
        let whole = |message: String| Err((String::new(), message));
        let one_of = self.names(Need::OneOf);
        let of: Vec<&str> = one_of.iter().copied().filter(given).collect();
        match of.len() {
            0 if !one_of.is_empty() => {
                return whole(format!("{} needs one of {}", self.name, one_of.join(", ")));
            }
            0 | 1 => {}
            _ => {
                let both = of.join(" and ");
                return whole(format!("{} has {both}: give one of them", self.name));
            }
        }
        let two_of = self.names(Need::TwoOf);
        if !two_of.is_empty() {
            if two_of.iter().filter(|k| given(k)).count() != 2 {
                return whole(format!("{} takes two of {}", self.name, two_of.join(", ")));
            }
            moduli(parameters).map_err(|message| (String::new(), message))?;
        }
        for key in &self.keys {
            if parameters.get(key.name).is_some() {
                continue;
            }
            let default = match key.need {
                Need::Given => {
                    let message = format!("the {} {} needs `{}`", what, self.name, key.name);
                    return Err((key.name.into(), message));
                }
                Need::Optional | Need::OneOf | Need::TwoOf | Need::Refused => continue,
                Need::Default(x) => Parameter::Number(x),
                Need::Word(word) => Parameter::Word(word.into()),
            };
            parameters.0.push((key.name.into(), default));
        }
        Ok(())
    }
}

impl Value {
    /// Is it the name of a file in decks?
    pub fn is_file(&self) -> bool {
        matches!(self, Value::Table | Value::Entries(_))
    }

    fn check(&self, name: &str, given: &Parameter) -> Result<(), String> {
        match (self, given) {
            (Value::Number(_, bounds), Parameter::Number(x)) => match bounds.hold(*x) {
                true => Ok(()),
                false => Err(format!("`{name}` is {x}, expected {}", bounds.words())),
            },
            (Value::List(count, _, bounds), Parameter::List(list)) => {
                if list.len() != *count {
                    let found = list.len();
                    return Err(format!("`{name}` has {found} numbers, expected {count}"));
                }
                match list.iter().find(|x| !bounds.hold(**x)) {
                    None => Ok(()),
                    Some(x) => Err(format!("`{name}` has {x}, expected {}", bounds.words())),
                }
            }
            (Value::Direction, Parameter::List(list)) => match list[..] {
                [0.0, 0.0, 0.0] => Err(format!("`{name}` is a direction: it cannot be 0")),
                [_, _, _] if list.iter().all(|x| x.is_finite()) => Ok(()),
                [_, _, _] => Err(format!("`{name}` has {list:?}, expected finite numbers")),
                _ => {
                    let found = list.len();
                    Err(format!("`{name}` has {found} components, expected 3"))
                }
            },
            (Value::Direction, Parameter::Direction(components)) => {
                match components.iter().any(Expression::depends_on_time) {
                    true => Err(format!(
                        "`{name}` is one of the reference: it does not depend on t"
                    )),
                    false => Ok(()),
                }
            }
            (Value::Rows(columns), Parameter::Rows(rows)) => {
                let fits = |row: &&Vec<f64>| {
                    let each = || row.iter().zip(*columns).all(|(x, c)| c.2.hold(*x));
                    row.len() == columns.len() && each()
                };
                let Some(row) = rows.iter().find(|r| !fits(r)) else {
                    return Ok(());
                };
                let of = columns.iter();
                let of: Vec<String> = of
                    .map(|(name, _, b)| format!("{name} ({})", b.words()))
                    .collect();
                let of = of.join(", ");
                Err(format!("a row of `{name}` is {row:?}, expected [{of}]"))
            }
            (Value::Entries(columns), Parameter::Rows(rows)) => {
                let kind = |x: &f64| *x >= 0.0 && *x < 255.0 && x.fract() == 0.0;
                let fits = |row: &&Vec<f64>| {
                    let kinds = row.iter().take(3).all(kind);
                    kinds && row.len() == columns.len() + 3 && row.iter().all(|x| x.is_finite())
                };
                let Some(row) = rows.iter().find(|r| !fits(r)) else {
                    return Ok(());
                };
                let names: Vec<&str> = columns.iter().map(|c| c.name).collect();
                let names = names.join(", ");
                Err(format!(
                    "a row of `{name}` is {row:?}, expected three kinds, {names}"
                ))
            }
            (Value::Word(words), Parameter::Word(word)) => {
                if words.iter().any(|(w, _)| w == word) {
                    return Ok(());
                }
                let words: Vec<&str> = words.iter().map(|(w, _)| *w).collect();
                let words = words.join(", ");
                Err(format!("`{name}` is \"{word}\", expected one of {words}"))
            }
            (Value::Name, Parameter::Word(_)) => Ok(()),
            (Value::Formula(..), Parameter::Formula(_)) => Ok(()),
            (Value::Table, Parameter::Table(table)) => table.check(),
            (Value::Number(..), _) => Err(format!("`{name}` is a number")),
            (Value::List(..), _) => Err(format!("`{name}` is a list of numbers")),
            (Value::Direction, _) => Err(format!(
                "`{name}` is a direction, three numbers or expressions of x, y, z"
            )),
            (Value::Entries(_), _) => Err(format!("`{name}` is a list of rows")),
            (Value::Rows(_), _) => Err(format!("`{name}` is a list of rows")),
            (Value::Formula(variables, _), _) => Err(format!(
                "`{name}` is an expression of {}",
                variables.join(", ")
            )),
            (Value::Word(_) | Value::Name, _) => Err(format!("`{name}` is a word")),
            (Value::Table, _) => Err(format!("`{name}` is a table of functions")),
        }
    }
}

/// A material that is to be made of a law.
#[derive(Debug, Clone)]
pub struct Given<'a> {
    /// Checked, with defaults.
    pub parameters: &'a Parameters,
    /// Of the linear law of the same elasticity, if that is state-based.
    pub solid: Option<Solid>,
    /// Micromodulus of the linear law of the same elasticity, if that is bond-based (force / volume²).
    pub micromodulus: Option<f64>,
    /// ∞: bonds never break by their stretch.
    pub critical_stretch: f64,
    /// Do bonds break, by whatever?
    pub breaks: bool,
    /// Mass per reference volume.
    pub density: f64,
    /// Of the full ball, where constants are those of the continuum (length² volume).
    pub weighted_volume: Option<f64>,
    /// `Σ ω ν V |ξ|` of the family that stiffnesses are calibrated to (length volume).
    pub first_moment: f64,
    /// Radius of its families (length).
    pub horizon: f64,
    /// A full family of the lattice that the points lie on, of several sublattices their mean; empty: they lie on none.
    pub family: &'a [Partner<3>],
}

/// What a law makes of each material.
///
/// # Errors
/// The number of the first that it makes nothing of, and why.
pub(crate) fn each<T>(
    materials: &[Given],
    of: impl Fn(&Given) -> Result<T, String>,
) -> Result<Vec<T>, (usize, String)> {
    let numbered = materials.iter().enumerate();
    let made = numbered.map(|(n, m)| of(m).map_err(|why| (n, why)));
    made.collect()
}

/// A law that can stand on a registry.
pub trait Registered: Sized {
    /// Is [`Registered::linear`] its own elasticity? Of anisotropic laws it is a mean.
    const ISOTROPIC: bool = true;
    /// Do its constants hold the critical stretch, so that toughness cannot depend on place and time?
    const OWN_CRITICAL_STRETCH: bool = false;
    /// Do its bonds bear nothing any more where they break?
    const SOFTENS_TO_ZERO: bool = false;
    /// Do its bonds store energy by turning, too? Then a fracture energy gives no critical stretch.
    const TANGENTIAL_STIFFNESS: bool = false;
    /// Do some of its bonds break at a stretch of their own? Then bonds break by nothing else, and toughness of places spares points at most.
    const BOND_CLASSES: bool = false;
    /// May its bonds pull in the reference, as those of atoms do? Then its tangents are not sweeps at tiny displacements.
    const PULLS_AT_REST: bool = false;

    fn descriptor() -> Descriptor;

    /// The brittle linear law of the same elasticity about the reference. It gives contact its stiffness and a fracture energy its critical
    /// stretch, and stands for the law where only linear ones are known.
    ///
    /// # Errors
    /// What of the parameters is wrong.
    fn linear(parameters: &Parameters) -> Result<LawSpec, String>;

    /// The fracture energy of a brittle bond with the critical stretch that one of this law has at this fracture energy.
    fn brittle_energy(_: &Parameters, energy: f64) -> f64 {
        energy
    }

    /// Why points of a body of these parameters have one horizon; `None`: the law says how its stiffness follows that of each
    /// ([`OF_FAMILY`](crate::law::material::Material::OF_FAMILY) and beside).
    fn of_one_horizon(_: &Parameters) -> Option<&'static str> {
        None
    }

    /// The law of all materials of a body in `d` dimensions.
    ///
    /// # Errors
    /// Which material, and why.
    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)>;

    /// The same with this rule for bonds between unlike materials; most laws answer for each end by itself.
    fn meeting(self, _: BondMixing) -> Self {
        self
    }
}
