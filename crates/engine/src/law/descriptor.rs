//! What a law on the shelf says of itself: its keys with dimensions, defaults and bounds, from which decks, schemas, lists and
//! reference pages follow; and how constants come of them.

use crate::columns::Dimension;
use crate::law::solid::eam_like::Solid;
use crate::spec::{Influence, LawSpec, Moduli, Parameter, Parameters, Plane};
use std::borrow::Cow;

/// A law as its users see it.
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
    /// And how fast: equilibrium in increments of load means nothing to it.
    Time,
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
    /// A number from the first bound (included if true) to the second.
    Number(Dimension, Bounds),
    /// Rows of numbers, a dimension and bounds for each column.
    Rows(&'static [(&'static str, Dimension, Bounds)]),
    /// One of these.
    Word(&'static [(&'static str, &'static str)]),
}

/// Where a number may lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub least: f64,
    /// Is the least one allowed?
    pub inclusive: bool,
    /// Not beyond this.
    pub most: f64,
}

impl Bounds {
    pub const ANY: Bounds = Bounds {
        least: f64::NEG_INFINITY,
        inclusive: false,
        most: f64::INFINITY,
    };
    pub const POSITIVE: Bounds = Bounds {
        least: 0.0,
        inclusive: false,
        most: f64::INFINITY,
    };
    pub const NOT_NEGATIVE: Bounds = Bounds {
        least: 0.0,
        inclusive: true,
        most: f64::INFINITY,
    };
    /// From above 0 to 1.
    pub const PART: Bounds = Bounds {
        least: 0.0,
        inclusive: false,
        most: 1.0,
    };

    pub fn hold(&self, x: f64) -> bool {
        let above = x > self.least || (self.inclusive && x == self.least);
        above && x <= self.most && x.is_finite()
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
    /// Any two of the keys with this need are given.
    TwoOf,
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
                most: 0.5 - f64::EPSILON,
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

impl Key {
    /// The same with a default.
    pub const fn or(mut self, default: f64) -> Key {
        self.need = Need::Default(default);
        self
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
            poisson: 0.5 - young / (6.0 * k),
        },
        (Some(young), _, _, Some(g)) => Moduli {
            young,
            poisson: 0.5 * young / g - 1.0,
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
            "Young's modulus {:e} and Poisson's ratio {} are those of no stable solid: E > 0, −1 < ν < ½",
            made.young, made.poisson
        ));
    }
    Ok(made)
}

impl Descriptor {
    pub fn key(&self, name: &str) -> Option<&Key> {
        self.keys.iter().find(|k| k.name == name)
    }

    /// Do parameters fit the keys? Defaults are filled in.
    ///
    /// # Errors
    /// The key that does not fit, and why.
    pub fn check(&self, parameters: &mut Parameters) -> Result<(), (String, String)> {
        for (name, given) in &parameters.0 {
            let wrong = |message: String| Err((name.clone(), message));
            let Some(key) = self.key(name) else {
                let known: Vec<&str> = self.keys.iter().map(|k| k.name).collect();
                let known = known.join(", ");
                return wrong(format!(
                    "the law {} has no key `{name}`; it has {known}",
                    self.name
                ));
            };
            match (key.value, given) {
                (Value::Number(_, bounds), Parameter::Number(x)) => {
                    if !bounds.hold(*x) {
                        let words = bounds.words();
                        return wrong(format!("`{name}` is {x}, expected {words}"));
                    }
                }
                (Value::Rows(columns), Parameter::Rows(rows)) => {
                    for row in rows {
                        let fits = row.len() == columns.len()
                            && row.iter().zip(columns).all(|(x, c)| c.2.hold(*x));
                        if !fits {
                            let of: Vec<String> = columns
                                .iter()
                                .map(|(name, _, b)| format!("{name} ({})", b.words()))
                                .collect();
                            return wrong(format!(
                                "a row of `{name}` is {row:?}, expected [{}]",
                                of.join(", ")
                            ));
                        }
                    }
                }
                (Value::Word(words), Parameter::Word(word)) => {
                    if !words.iter().any(|(w, _)| w == word) {
                        let words: Vec<&str> = words.iter().map(|(w, _)| *w).collect();
                        let words = words.join(", ");
                        return wrong(format!("`{name}` is \"{word}\", expected one of {words}"));
                    }
                }
                (Value::Number(..), _) => return wrong(format!("`{name}` is a number")),
                (Value::Rows(_), _) => return wrong(format!("`{name}` is a list of rows")),
                (Value::Word(_), _) => return wrong(format!("`{name}` is a word")),
            }
        }
        for key in &self.keys {
            if parameters.0.iter().any(|(name, _)| name == key.name) {
                continue;
            }
            let default = match key.need {
                Need::Given => {
                    return Err((
                        key.name.into(),
                        format!("the law {} needs `{}`", self.name, key.name),
                    ));
                }
                Need::TwoOf => continue,
                Need::Default(x) => Parameter::Number(x),
                Need::Word(word) => Parameter::Word(word.into()),
            };
            parameters.0.push((key.name.into(), default));
        }
        if self.keys.iter().any(|k| k.need == Need::TwoOf) {
            moduli(parameters).map_err(|message| (String::new(), message))?;
        }
        Ok(())
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
    /// ∞: bonds never break.
    pub critical_stretch: f64,
    /// Of the full ball, where constants are those of the continuum (length² volume).
    pub weighted_volume: Option<f64>,
}

/// A law that can stand on a shelf.
pub trait Shelved: Sized {
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

    /// The law of all materials of a body in `d` dimensions.
    ///
    /// # Errors
    /// Which material, and why.
    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)>;
}
