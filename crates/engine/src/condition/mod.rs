//! What the world does to a body: loads that add force, constraints that prescribe motion, rigid indenters.
//! Each keeps the account of its own work.

pub mod carried;
pub mod constraint;
pub mod driven;
pub mod indenter;
pub mod load;
pub(crate) mod still;

use crate::expression::Expression;
use crate::space::Point;

/// Up to D expressions on a list of points; those that do not depend on time are evaluated once.
#[derive(Debug, Clone)]
pub struct Program<const D: usize> {
    component: [Component; D],
    scale: f64,
}

#[derive(Debug, Clone)]
enum Component {
    Free,
    Fixed(Vec<f64>),
    Changing(Expression),
    /// The same everywhere, set from outside.
    Given(f64),
}

impl<const D: usize> Program<D> {
    /// `points`: reference positions.
    pub fn new(expressions: &[Option<Expression>; 3], points: &[Point]) -> Self {
        Program {
            component: std::array::from_fn(|a| match &expressions[a] {
                None => Component::Free,
                Some(e) if e.depends_on_time() => Component::Changing(e.clone()),
                Some(e) => Component::Fixed(points.iter().map(|x| e.eval(x, 0.0)).collect()),
            }),
            scale: 1.0,
        }
    }

    /// Values that are the same on all points and change from outside.
    pub fn given(values: [Option<f64>; 3]) -> Self {
        Program {
            component: std::array::from_fn(|a| values[a].map_or(Component::Free, Component::Given)),
            scale: 1.0,
        }
    }

    /// New values for [`Program::given`].
    pub fn give(&mut self, values: [Option<f64>; 3]) {
        for (c, v) in self.component.iter_mut().zip(values) {
            *c = v.map_or(Component::Free, Component::Given);
        }
    }

    /// The same program, every value multiplied.
    pub fn scaled(self, scale: f64) -> Self {
        Program {
            scale: self.scale * scale,
            ..self
        }
    }

    pub fn acts(&self, axis: usize) -> bool {
        !matches!(self.component[axis], Component::Free)
    }

    /// Value at point `k` of the list, whose reference position is `x`.
    pub fn at(&self, axis: usize, k: usize, x: &Point, t: f64) -> f64 {
        match &self.component[axis] {
            Component::Free => 0.0,
            Component::Fixed(v) => self.scale * v[k],
            Component::Changing(e) => self.scale * e.eval(x, t),
            Component::Given(v) => self.scale * v,
        }
    }
}
