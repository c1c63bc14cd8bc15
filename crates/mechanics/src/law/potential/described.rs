//! What a potential says of itself, and those that are known by their names.

use super::cut::Ends;
use super::{Potential, each};
use crate::family::stencil::Stencil;
use crate::law::descriptor::{Descriptor, Wrong};
use crate::law::many_body;
use crate::law::scaled::by_dimension;
use crate::space::lattice::LatticeKind;
use crate::spec::{End, Mixing, Parameters, PotentialSpec};

/// The constants of a potential, by which decks and programs name it.
pub trait Described: Sized + Send + Sync + 'static {
    /// Lower case with underscores; the same in decks and programs.
    const NAME: &'static str;

    /// What it is with its end.
    type Made: Potential;

    fn descriptor() -> Descriptor;

    /// From parameters that fit the descriptor, with defaults.
    ///
    /// # Errors
    /// The key that is wrong, and why.
    fn read(parameters: &Parameters) -> Result<Self, Wrong>;

    /// The other way round.
    fn parameters(&self) -> Parameters;

    fn made(self, ends: Ends) -> Self::Made;

    /// Where it ends by itself (length); ∞: nowhere.
    fn reach(&self) -> f64 {
        f64::INFINITY
    }

    /// Constants that are left out and follow from the lattice that the atoms lie on, of this spacing (length).
    fn on_lattice(_parameters: &mut Parameters, _kind: LatticeKind, _spacing: f64) {}

    /// Parameters of the same potential with lengths times `length` and energies times `energy`: of each number as its dimension
    /// says.
    fn scaled(parameters: &mut Parameters, length: f64, energy: f64) {
        by_dimension(&Self::descriptor(), parameters, length, energy);
    }

    /// Where the constants of unlike atoms come from.
    const UNLIKE: Unlike = Unlike::Given;

    /// Between atoms of two kinds, the first of them in the middle, by the constants that each has with its own.
    ///
    /// # Errors
    /// The key of one of them that is wrong, and why.
    fn mixed(_own: [(Self, Ends); 2], _rule: Option<Mixing>) -> Result<Self::Made, Wrong> {
        let message = format!("{} has no rule of mixing", Self::NAME);
        Err((String::new(), message))
    }

    /// The constants at a coarser spacing that keep the reach on fixed neighbours, where the form of the potential allows it.
    fn keeping_reach(&self, _: &KeptReach) -> Option<Self> {
        None
    }
}

/// Where the constants of pairs of unlike atoms come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unlike {
    /// They are given.
    Given,
    /// They are given, or follow by a rule of mixing.
    Mixed,
    /// All atoms that have the potential have it with each other.
    Whole,
}

/// Two lattices of one kind with the same reach.
#[derive(Debug, Clone, Copy)]
pub struct KeptReach<'a> {
    /// Coarse spacing over fine.
    pub factor: f64,
    pub dimension: usize,
    pub fine: &'a Stencil,
    pub coarse: &'a Stencil,
}

/// What is done with a potential of a known kind.
pub trait Visitor {
    type Out;
    fn visit<P: Potential>(self, potential: P) -> Self::Out;
}

/// Who wants to see all kinds of potentials ([`each`]).
pub trait Kinds {
    fn kind<P: Described>(&mut self);
}

/// The kind of a name, and what to do with it.
trait Of {
    type Out;
    fn of<P: Described>(self) -> Self::Out;
}

struct Find<'a, O: Of> {
    name: &'a str,
    known: Vec<&'static str>,
    todo: Option<O>,
    done: Option<O::Out>,
}

impl<O: Of> Kinds for Find<'_, O> {
    fn kind<P: Described>(&mut self) {
        self.known.push(P::NAME);
        if self.name == P::NAME
            && let Some(todo) = self.todo.take()
        {
            self.done = Some(todo.of::<P>());
        }
    }
}

fn find<O: Of>(name: &str, todo: O) -> Result<O::Out, String> {
    let mut find = Find {
        name,
        known: vec![],
        todo: Some(todo),
        done: None,
    };
    each(&mut find);
    let known = find.known.join(", ");
    let unknown = || match many_body::is_known(name) {
        true => format!(
            "{name} has terms of more than two atoms, and this is known for pairs and densities only: {known}"
        ),
        false => format!("there is no potential named {name}; known are {known}"),
    };
    find.done.ok_or_else(unknown)
}

/// What parameters make, with its end. What is left out and has a default is filled in.
///
/// # Errors
/// The key that is wrong, and why.
pub(crate) fn make<P: Described>(parameters: &Parameters) -> Result<P::Made, Wrong> {
    let mut parameters = parameters.clone();
    P::descriptor().check(&mut parameters)?;
    Ok(P::read(&parameters)?.made(Ends::of(&parameters)?))
}

/// The potential of parameters, which are checked and filled up.
///
/// # Errors
/// The key that is wrong, and why.
pub(crate) fn look_up<P: Described>(mut parameters: Parameters) -> Result<PotentialSpec, Wrong> {
    P::descriptor().check(&mut parameters)?;
    let (read, ends) = (P::read(&parameters)?, Ends::of(&parameters)?);
    Ok(PotentialSpec {
        name: P::NAME.into(),
        reach: read.reach().min(ends.cutoff),
        parameters,
    })
}

impl PotentialSpec {
    /// A potential by its constants.
    pub fn of<P: Described>(constants: P) -> PotentialSpec {
        let parameters = constants.parameters();
        PotentialSpec {
            name: P::NAME.into(),
            reach: constants.reach(),
            parameters,
        }
    }

    /// The same pair potential, ended.
    pub fn ended(mut self, cutoff: f64, end: End) -> PotentialSpec {
        self.reach = self.reach.min(cutoff);
        (Ends { cutoff, end }).put(&mut self.parameters);
        self
    }

    /// What the engine's potential of this name is with these constants.
    ///
    /// # Errors
    /// The engine has none of this name, or the constants do not fit it.
    pub fn apply<V: Visitor>(&self, visitor: V) -> Result<V::Out, String> {
        struct Apply<'a, V>(&'a Parameters, V);
        impl<V: Visitor> Of for Apply<'_, V> {
            type Out = Result<V::Out, String>;
            fn of<P: Described>(self) -> Self::Out {
                let made = make::<P>(self.0).map_err(|(_, message)| message)?;
                Ok(self.1.visit(made))
            }
        }
        find(&self.name, Apply(&self.parameters, visitor))?
    }

    /// The same with lengths times `length` and energies times `energy`.
    ///
    /// # Errors
    /// The engine has none of this name.
    pub fn scaled(&self, length: f64, energy: f64) -> Result<PotentialSpec, String> {
        struct Scaled(Parameters, f64, f64);
        impl Of for Scaled {
            type Out = Parameters;
            fn of<P: Described>(mut self) -> Parameters {
                P::scaled(&mut self.0, self.1, self.2);
                self.0
            }
        }
        if let Some(many_body) = self.scaled_many_body(length, energy) {
            return Ok(many_body);
        }
        let parameters = self.parameters.clone();
        Ok(PotentialSpec {
            name: self.name.clone(),
            parameters: find(&self.name, Scaled(parameters, length, energy))?,
            reach: self.reach * length,
        })
    }

    /// The same at a coarser spacing with the same reach; `None`: its form does not allow that.
    ///
    /// # Errors
    /// As [`PotentialSpec::apply`].
    pub fn keeping_reach(&self, kept: &KeptReach) -> Result<Option<PotentialSpec>, String> {
        struct Keeping<'a, 'b>(&'a PotentialSpec, &'a KeptReach<'b>);
        impl Of for Keeping<'_, '_> {
            type Out = Result<Option<PotentialSpec>, String>;
            fn of<P: Described>(self) -> Self::Out {
                let read = P::read(&self.0.parameters).map_err(|(_, message)| message)?;
                Ok(read.keeping_reach(self.1).map(PotentialSpec::of))
            }
        }
        find(&self.name, Keeping(self, kept))?
    }
}
