//! What a fan says of itself, its constants as rows of a file or as keys, and those that are known by their names.

use super::{ManyBody, each};
use crate::columns::Dimension;
use crate::law::descriptor::{Bounds, Descriptor, Key, Need, Value, Wrong, number};
use crate::law::potential::mixture::{Between, Given};
use crate::law::scaled::by_dimension;
use crate::spec::{Parameter, Parameters, PotentialSpec};

/// The constants of a fan, by which decks and programs name it.
pub trait Described: ManyBody {
    /// Lower case with underscores; the same in decks and programs.
    const NAME: &'static str;

    fn descriptor() -> Descriptor;

    /// From parameters that fit the descriptor, with defaults.
    ///
    /// # Errors
    /// The key that is wrong, and why.
    fn read(parameters: &Parameters) -> Result<Self, Wrong>;
}

/// Who wants to see all many-body potentials ([`each`]).
pub trait Kinds {
    fn many_body<F: Described>(&mut self);
}

/// A column of a file of constants.
pub(super) const fn constant(name: &'static str, dimension: Dimension, doc: &'static str) -> Key {
    number(name, dimension, Bounds::ANY, doc)
}

/// Key of rows of constants.
pub const FILE: &str = "file";

/// A file of entries, or a number for each of the columns where there is one kind of atom.
pub(super) fn keys(columns: &'static [Key]) -> Vec<Key> {
    let mut all = vec![
        Key {
            name: FILE,
            value: Value::Entries(columns),
            need: Need::Optional,
            doc: "LAMMPS's file of constants, relative to the deck, in eV and Å; or give them as keys.",
        },
        Key {
            name: "element",
            value: Value::Name,
            need: Need::Optional,
            doc: "Needed where the file has several.",
        },
    ];
    all.extend(columns.iter().map(|c| c.clone().need(Need::Optional)));
    all
}

/// Constants of every triple of kinds, as they were given.
pub(super) struct Entries {
    kinds: usize,
    columns: &'static [Key],
    /// By i, j, k.
    rows: Vec<Option<Vec<f64>>>,
    /// Is each number a key of its own?
    keys: bool,
}

impl Entries {
    pub fn of(parameters: &Parameters, columns: &'static [Key]) -> Result<Entries, Wrong> {
        let given = |c: &&Key| parameters.get(c.name).is_some();
        let Some(rows) = parameters.rows(FILE) else {
            let number = |c: &Key| {
                let default = match c.need {
                    Need::Default(x) => Some(x),
                    _ => None,
                };
                let missing = || {
                    let message = format!("`{}` is missing: give a file, or every number", c.name);
                    (c.name.to_string(), message)
                };
                parameters.number(c.name).or(default).ok_or_else(missing)
            };
            let row = columns.iter().map(number).collect::<Result<Vec<_>, _>>()?;
            return Ok(Entries {
                kinds: 1,
                columns,
                rows: vec![Some(row)],
                keys: true,
            });
        };
        if let Some(c) = columns.iter().find(given) {
            let message = format!("the file says `{}`: leave one of them out", c.name);
            return Err((c.name.into(), message));
        }
        let most = rows
            .iter()
            .flat_map(|r| &r[..3])
            .fold(-1.0, |m, x| x.max(m));
        let kinds = (most + 1.0) as usize;
        if kinds == 0 {
            return Err((FILE.into(), "there is no entry".into()));
        }
        let mut all = vec![None; kinds * kinds * kinds];
        for row in rows {
            let n = row[..3].iter().fold(0, |n, x| n * kinds + *x as usize);
            if all[n].replace(row[3..].to_vec()).is_some() {
                let message = format!("the kinds {:?} have two entries", &row[..3]);
                return Err((FILE.into(), message));
            }
        }
        Ok(Entries {
            kinds,
            columns,
            rows: all,
            keys: false,
        })
    }

    pub fn kinds(&self) -> usize {
        self.kinds
    }

    /// All i, j, k.
    pub fn all(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let n = self.kinds;
        (0..n * n * n).map(move |m| [m / (n * n), m / n % n, m % n])
    }

    pub fn row(&self, [i, j, k]: [usize; 3]) -> Result<&[f64], Wrong> {
        let found = self.rows[(i * self.kinds + j) * self.kinds + k].as_deref();
        found.ok_or_else(|| {
            let message = format!("there is no entry for the kinds {i}, {j}, {k}");
            (FILE.to_string(), message)
        })
    }

    /// What is wrong with an entry.
    pub fn wrong(&self, [i, j, k]: [usize; 3], message: &str) -> Wrong {
        match self.keys {
            true => (String::new(), message.into()),
            false => (
                FILE.into(),
                format!("the entry of the kinds {i}, {j}, {k}: {message}"),
            ),
        }
    }
}

/// Two entries must have some numbers in common: what they say would depend on who looks.
pub(super) fn alike(
    entries: &Entries,
    [a, b]: [[usize; 3]; 2],
    columns: &[usize],
) -> Result<(), Wrong> {
    let (one, other) = (entries.row(a)?, entries.row(b)?);
    match columns.iter().find(|c| one[**c] != other[**c]) {
        None => Ok(()),
        Some(c) => {
            let name = entries.columns[*c].name;
            let (x, y) = (one[*c], other[*c]);
            let message = format!(
                "{name} is {x}, and {y} in that of the kinds {}, {}, {}: they must be the same",
                b[0], b[1], b[2]
            );
            Err(entries.wrong(a, &message))
        }
    }
}

/// What parameters make. What is left out and has a default is filled in.
///
/// # Errors
/// The key that is wrong, and why.
pub(crate) fn make<F: Described>(parameters: &Parameters) -> Result<F, Wrong> {
    let mut parameters = parameters.clone();
    F::descriptor().check(&mut parameters)?;
    F::read(&parameters)
}

/// The fan of all kinds of atoms: its constants know all of them, and are the same for each.
///
/// # Errors
/// The key that is wrong, and why.
pub fn of_kinds<F: Described>(given: &Given) -> Result<F, Wrong> {
    let own = |kind| match given.at(kind, kind) {
        Between::Given(parameters) => Some(parameters),
        Between::Nothing | Between::Mixed => None,
    };
    match own(0).filter(|first| (1..given.kinds).all(|k| own(k) == Some(first))) {
        Some(parameters) => make::<F>(parameters),
        None => {
            let message = format!(
                "{} knows all atoms of a body by one set of constants: give all materials the same file, with their elements",
                F::NAME
            );
            Err((String::new(), message))
        }
    }
}

/// The potential of parameters, which are checked.
///
/// # Errors
/// The key that is wrong, and why.
pub(crate) fn look_up<F: Described>(mut parameters: Parameters) -> Result<PotentialSpec, Wrong> {
    F::descriptor().check(&mut parameters)?;
    Ok(PotentialSpec {
        name: F::NAME.into(),
        reach: F::read(&parameters)?.cutoff(),
        parameters,
    })
}

/// What a fan of the engine says of itself.
pub(in crate::law) fn descriptor(name: &str) -> Option<Descriptor> {
    struct Find<'a>(&'a str, Option<Descriptor>);
    impl Kinds for Find<'_> {
        fn many_body<F: Described>(&mut self) {
            if F::NAME == self.0 {
                self.1 = Some(F::descriptor());
            }
        }
    }
    let mut find = Find(name, None);
    each(&mut find);
    find.1
}

/// Is it a fan of the engine?
pub fn is_known(name: &str) -> bool {
    descriptor(name).is_some()
}

impl PotentialSpec {
    /// A fan of one kind of atom by a number for each of its columns.
    ///
    /// # Errors
    /// The key that is wrong, and why.
    pub fn of_many_body<F: Described>(constants: &[(&str, f64)]) -> Result<PotentialSpec, Wrong> {
        look_up::<F>(Parameters::numbers(constants))
    }

    /// A fan by rows: the kinds i, j and k, and a number for each column.
    ///
    /// # Errors
    /// The key that is wrong, and why.
    pub fn of_entries<F: Described>(rows: Vec<Vec<f64>>) -> Result<PotentialSpec, Wrong> {
        look_up::<F>(Parameters::default().with(FILE, Parameter::Rows(rows)))
    }

    /// The same fan with lengths times `length` and energies times `energy`; `None`: it is none.
    pub(in crate::law) fn scaled_many_body(
        &self,
        length: f64,
        energy: f64,
    ) -> Option<PotentialSpec> {
        let descriptor = descriptor(&self.name)?;
        let mut made = self.clone();
        by_dimension(&descriptor, &mut made.parameters, length, energy);
        made.reach *= length;
        Some(made)
    }
}
