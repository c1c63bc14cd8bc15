//! What the world does to a body: loads that add force, constraints that prescribe motion, rigid bodies (rigid_bodies).
//! Each keeps the account of its own work.

pub mod applied;
pub mod condensed;
pub mod constraint;
pub mod driven;
pub mod external;
pub(crate) mod force_field;
pub mod kinematic;
pub mod load;
pub mod point_force;
pub(crate) mod prescribed;
pub mod prescribed_motion;
pub mod reaction;
pub mod rigid;
pub mod rigid_body;
pub mod still;
pub mod toughness;

use self::external::ExternalValues;
use crate::expression::Expression;
use crate::space::Point;
use std::sync::Arc;

/// Up to D expressions on a list of points; those that do not depend on time are evaluated once.
#[derive(Debug, Clone)]
pub struct Program<const D: usize> {
    component: [Component; D],
    scale: f64,
    /// One more factor for each point; empty: 1.
    weight: Vec<f64>,
}

#[derive(Debug, Clone)]
enum Component {
    Free,
    Fixed(Vec<f64>),
    Changing(Expression),
    /// The same everywhere, set from outside.
    Given(f64),
    /// One for each point that it acts on, set from outside.
    Listed(Vec<Option<f64>>),
    /// Somebody outside answers; places of the points in the list that they know.
    ExternalValues(Arc<dyn ExternalValues>, Vec<usize>),
}

impl<const D: usize> Program<D> {
    /// `points`: reference positions.
    pub fn new(expressions: &[Option<Expression>; 3], points: &[Point]) -> Self {
        Program {
            component: crate::array::from_fn(|a| match &expressions[a] {
                None => Component::Free,
                Some(e) if e.depends_on_time() => Component::Changing(e.clone()),
                Some(e) => Component::Fixed(points.iter().map(|x| e.eval(x, 0.0)).collect()),
            }),
            scale: 1.0,
            weight: vec![],
        }
    }

    /// Values that are the same on all points and change from outside.
    pub fn given(values: [Option<f64>; 3]) -> Self {
        Program {
            component: crate::array::from_fn(|a| {
                values[a].map_or(Component::Free, Component::Given)
            }),
            scale: 1.0,
            weight: vec![],
        }
    }

    /// Values of each point, set from outside.
    pub fn listed(values: &[[Option<f64>; 3]]) -> Self {
        Program {
            component: crate::array::from_fn(|a| {
                Component::Listed(values.iter().map(|v| v[a]).collect())
            }),
            scale: 1.0,
            weight: vec![],
        }
    }

    /// Values of `count` points that somebody answers at any time, on these axes.
    pub fn external(source: &Arc<dyn ExternalValues>, axes: [bool; 3], count: usize) -> Self {
        Program {
            component: crate::array::from_fn(|a| match axes[a] {
                true => Component::ExternalValues(source.clone(), (0..count).collect()),
                false => Component::Free,
            }),
            scale: 1.0,
            weight: vec![],
        }
    }

    /// The points of the list become those at these places of it.
    pub fn pick(&mut self, kept: &[usize]) {
        if !self.weight.is_empty() {
            self.weight = kept.iter().map(|k| self.weight[*k]).collect();
        }
        for c in &mut self.component {
            match c {
                Component::Fixed(v) => *v = kept.iter().map(|k| v[*k]).collect(),
                Component::Listed(v) => *v = kept.iter().map(|k| v[*k]).collect(),
                Component::ExternalValues(_, of) => *of = kept.iter().map(|k| of[*k]).collect(),
                Component::Free | Component::Changing(_) | Component::Given(_) => {}
            }
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

    /// The same program, the values of each point multiplied by its own weight.
    pub fn weighted(self, weight: Vec<f64>) -> Self {
        Program { weight, ..self }
    }

    pub fn acts(&self, axis: usize) -> bool {
        !matches!(self.component[axis], Component::Free)
    }

    /// Does it act on point `k` of the list?
    pub fn acts_on(&self, axis: usize, k: usize) -> bool {
        match &self.component[axis] {
            Component::Free => false,
            Component::Listed(v) => v[k].is_some(),
            Component::Fixed(_)
            | Component::Changing(_)
            | Component::Given(_)
            | Component::ExternalValues(..) => true,
        }
    }

    /// Is there a list of values that has none for point `k`?
    pub fn leaves(&self, k: usize) -> bool {
        self.component
            .iter()
            .all(|c| matches!(c, Component::Listed(v) if v[k].is_none()))
    }

    /// Value at point `k` of the list, whose reference position is `x`.
    pub fn at(&self, axis: usize, k: usize, x: &Point, t: f64) -> f64 {
        let scale = self.weight.get(k).map_or(self.scale, |w| self.scale * w);
        match &self.component[axis] {
            Component::Free => 0.0,
            Component::Fixed(v) => scale * v[k],
            Component::Changing(e) => scale * e.eval(x, t),
            Component::Given(v) => scale * v,
            Component::Listed(v) => scale * v[k].unwrap_or(0.0),
            Component::ExternalValues(source, of) => scale * source.at(axis, of[k], t),
        }
    }
}
