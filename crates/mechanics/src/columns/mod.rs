//! State says what it is: every column of numbers over points or bonds is declared by whoever owns it. Writers, probes, pictures and
//! whatever stores or sends a state read the declarations; nobody lists columns by hand.

pub use crate::quantity::Dimension;
use std::borrow::Cow;

/// What a column is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum On {
    /// A value per point.
    Points,
    /// A value per directed bond.
    Bonds,
}

/// What one value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shape {
    Scalar,
    /// A component per axis.
    Vector,
    /// Symmetric, a component per pair of axes: xx yy zz xy xz yz.
    Symmetric,
    /// Any tensor, row by row.
    Tensor,
}

impl Shape {
    /// Numbers of a value written in three dimensions.
    pub const fn numbers(self) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector => 3,
            Shape::Symmetric => 6,
            Shape::Tensor => 9,
        }
    }

    /// Names of the numbers of a value; none of a scalar.
    pub const fn components(self) -> &'static [&'static str] {
        match self {
            Shape::Scalar => &[],
            Shape::Vector => &["x", "y", "z"],
            Shape::Symmetric => &["xx", "yy", "zz", "xy", "xz", "yz"],
            Shape::Tensor => &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
        }
    }

    /// Numbers of a value in `d` dimensions, in the order of their names without those of axes that are not there.
    pub const fn stored(self, d: usize) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector => d,
            Shape::Symmetric => d * (d + 1) / 2,
            Shape::Tensor => d * d,
        }
    }
}

/// How long a column lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Life {
    /// Part of the state: a run that goes on elsewhere needs it.
    Persistent,
    /// Follows from the persistent columns at any time.
    Derived,
}

/// A column as its owner declares it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Declaration {
    /// Lower case with underscores; the same in decks, files and programs.
    pub name: Cow<'static, str>,
    pub on: On,
    pub shape: Shape,
    pub dimension: Dimension,
    pub life: Life,
    /// One sentence, with the equation and its source where there is one.
    pub doc: Cow<'static, str>,
}

impl Declaration {
    /// Of points, persistent.
    pub const fn of_points(
        name: &'static str,
        shape: Shape,
        dimension: Dimension,
        doc: &'static str,
    ) -> Declaration {
        Declaration {
            name: Cow::Borrowed(name),
            on: On::Points,
            shape,
            dimension,
            life: Life::Persistent,
            doc: Cow::Borrowed(doc),
        }
    }

    /// Of bonds, persistent.
    pub const fn of_bonds(
        name: &'static str,
        dimension: Dimension,
        doc: &'static str,
    ) -> Declaration {
        Declaration {
            name: Cow::Borrowed(name),
            on: On::Bonds,
            shape: Shape::Scalar,
            dimension,
            life: Life::Persistent,
            doc: Cow::Borrowed(doc),
        }
    }

    /// The same, following from other columns.
    pub const fn derived(mut self) -> Declaration {
        self.life = Life::Derived;
        self
    }
}
