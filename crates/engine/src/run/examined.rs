//! What may be asked of a model beside its motion.

use super::equilibrium::problem::Problem;
use super::equilibrium::whole::whole_support;
use super::model::Model;
use super::system::System;
use super::{AtomBond, Examined, Families, ModeShape, record};
use crate::body::{view, view_mut, zeros};
use crate::boundary_condition::load::Load;
use crate::error::{RunError, SolveError};
use crate::interaction::Sweep;
use crate::observe::{Observed, PointForce, State};
use crate::space::Point;
use crate::spec::{AnyLinearBody, LinearBody};
use crate::statics::Solved;
use crate::statics::modes::{self, Mode};

impl<const D: usize> Examined for Model<D> {
    fn families(&self) -> Families {
        record::count_families(&self.system)
    }

    fn energy_under_strain(&self, strain: [[f64; 3]; 3]) -> Vec<f64> {
        record::strained(&self.system, strain)
    }

    fn bonds_of_atoms(&mut self, visit: &mut dyn FnMut(AtomBond)) -> Option<Vec<f64>> {
        record::bonds_of_atoms(&mut self.system, visit)
    }

    fn forces_under(&mut self, displacement: &[Point]) -> Vec<Point> {
        let System {
            body, interaction, ..
        } = &mut self.system;
        let mut u = body.at_rest();
        body.scatter(&mut u, displacement);
        body.exchange().fill_field(&mut u);
        let mut f = zeros(body.len());
        interaction.forces(body, view(&u), view_mut(&mut f), Sweep::Hold, None);
        body.vectors(&f)
    }

    fn observed(&mut self) -> Observed {
        self.system.observed()
    }

    fn each_force(&mut self, visit: &mut dyn FnMut(PointForce)) -> bool {
        self.view().each_force(visit)
    }

    fn relax(&mut self, tolerance: f64) -> Result<Solved, RunError> {
        self.finish();
        Problem::of(&mut self.system).settle_free(tolerance)
    }

    fn linear_body(&mut self) -> AnyLinearBody {
        linear_of_all(self).expect("this rank has it")
    }

    fn modes(&mut self, count: usize) -> Result<Vec<ModeShape>, SolveError> {
        Ok(modes_of_all(self, count)?.expect("this rank has them"))
    }
}

/// [`Examined::linear_body`] of all ranks, on the first.
pub(super) fn linear_of_all<const D: usize>(model: &mut Model<D>) -> Option<AnyLinearBody> {
    let body = LinearBody {
        load_map: model.names.load_map.clone(),
        ..model.system.linear_now()?
    };
    Some(AnyLinearBody::new(body).expect("there are three dimensions"))
}

/// [`Examined::modes`] of all ranks, on the first.
pub(super) fn modes_of_all<const D: usize>(
    model: &mut Model<D>,
    count: usize,
) -> Result<Option<Vec<ModeShape>>, SolveError> {
    // the linear body is that of bonds
    let mut loads = model.system.applied.loads.iter();
    if loads.any(Load::changes_with_place) {
        return Err(SolveError::PointStiffness);
    }
    // of a body that was loaded those of the motion that follows
    let next = model.stages.due(model.system.clock.step());
    let prescribed = next.map_or(&model.system.prescribed, |next| &next.prescribed);
    let support = model.system.held_by(prescribed);
    let support = whole_support(&model.system.body, &support);
    let Some((body, support)) = model.system.linear_now().zip(support) else {
        return Ok(None);
    };
    let padded = |x: &[f64; D]| crate::array::from_fn(|a| if a < D { x[a] } else { 0.0 });
    let shape = |m: &Mode<D>| ModeShape {
        square: m.square,
        frequency: m.frequency(),
        shape: m.shape.iter().map(padded).collect(),
    };
    let found = modes::lowest(&body, &support, count)?;
    Ok(Some(found.iter().map(shape).collect()))
}
