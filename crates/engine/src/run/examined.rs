//! What may be asked of a model beside its motion.

use super::model::Model;
use super::{AtomBond, Examined, Families, ModeShape};
use crate::body::zeros;
use crate::error::{RunError, SolveError};
use crate::interaction::Sweep;
use crate::observe::{Observed, PointForce, State};
use crate::space::Point;
use crate::spec::{AnyLinearBody, LinearBody};
use crate::statics::Solved;

impl<const D: usize> Examined for Model<D> {
    fn families(&self) -> Families {
        self.count_families()
    }

    fn energy_under_strain(&self, strain: [[f64; 3]; 3]) -> Vec<f64> {
        self.strained(strain)
    }

    fn bonds_of_atoms(&mut self, visit: &mut dyn FnMut(AtomBond)) -> Option<Vec<f64>> {
        Model::bonds_of_atoms(self, visit)
    }

    fn forces_under(&mut self, displacement: &[Point]) -> Vec<Point> {
        let mut u = self.body.at_rest();
        Self::scatter(&self.body, &mut u, displacement);
        for c in &mut u {
            self.body.fill_images(c);
        }
        let mut f = zeros(self.body.len);
        self.interaction
            .forces(&self.body, &u, &mut f, Sweep::Hold, None);
        self.vectors(&f)
    }

    fn observed(&mut self) -> Observed {
        self.refresh_images();
        let mut out = self.seen_now();
        if let Some(pairs) = &mut self.contact {
            pairs.find(&self.body, &self.u, self.interaction.as_ref());
            let repulsion = &mut out.repulsion;
            pairs
                .central
                .add_energy_density(&self.body, &self.u, repulsion);
        }
        self.observed_of(&out)
    }

    fn each_force(&mut self, visit: &mut dyn FnMut(PointForce)) -> bool {
        self.view().each_force(visit)
    }

    fn virial(&mut self) -> [f64; 6] {
        match self.virial {
            Some(virial) => virial,
            None => self.virial_now(),
        }
    }

    fn relax(&mut self, tolerance: f64) -> Result<Solved, RunError> {
        self.finish();
        self.settle_free(tolerance)
    }

    fn linear_body(&mut self) -> AnyLinearBody {
        let body = LinearBody {
            carriers: self.carriers.clone(),
            ..self.linear_now()
        };
        AnyLinearBody::new(body).expect("there are three dimensions")
    }

    fn modes(&mut self, count: usize) -> Result<Vec<ModeShape>, SolveError> {
        let found = self.lowest_modes(count)?;
        Ok(found
            .iter()
            .map(|m| ModeShape {
                square: m.square,
                frequency: m.frequency(),
                shape: Self::padded(&m.shape),
            })
            .collect())
    }
}
