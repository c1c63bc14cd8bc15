//! What acts and what it acts on: a body with its bonds, its state, and all that adds to it. Steppers move it.

mod archive;
mod forces;
mod linear;
mod regime;
mod stressed;
mod watch;

pub(super) use regime::Regime;
pub(super) use watch::Watch;

use self::stressed::Stressed;
use super::Info;
use super::accounts::state::Accounts;
use super::clock::Clock;
use super::diffusions::state::Diffusions;
use super::healing::state::Healing;
use super::inertia::state::Inertia;
use crate::body::{Body, Field};
use crate::boundary_condition::applied::AppliedForces;
use crate::boundary_condition::constraint::Constraint;
use crate::boundary_condition::prescribed_motion::PrescribedMotion;
use crate::boundary_condition::toughness::SpatialToughness;
use crate::constitutive::ConstitutiveModels;
use crate::diffusion::Diffusion;
use crate::interaction::{ContactForces, Interaction, PointEnergies};
use crate::observe::Observed;
use crate::run::fault::KnownFault;
use crate::spec::Breakage;
use crate::statics::Masses;

/// A body in D dimensions, and all that acts on it.
pub(super) struct System<const D: usize> {
    pub info: Info,
    pub body: Body<D>,
    pub interaction: Box<dyn Interaction<D>>,
    /// Between points that are not in each other's family.
    pub contact: Option<ContactForces<D>>,
    /// `None`: that of the materials.
    pub toughness: Option<SpatialToughness>,
    /// `None`: what is broken stays so.
    pub healing: Option<Healing>,
    pub u: Field<D>,
    pub v: Field<D>,
    pub f: Field<D>,
    /// Where masses couple points.
    pub inertia: Option<Inertia<D>>,
    pub prescribed: PrescribedMotion<D>,
    pub applied: AppliedForces<D>,
    /// What spreads through the bonds.
    pub diffusions: Diffusions,
    /// Laws and constants, for what is computed pair by pair.
    pub constitutive: ConstitutiveModels,
    pub clock: Clock,
    pub accounts: Accounts,
    /// What is kept of the next evaluation of forces.
    pub watch: Watch,
    /// When a bond past its critical stretch breaks.
    pub breakage: Breakage,
    /// Has somebody had enough of a search for an equilibrium?
    pub stop: fn() -> bool,
    /// The last forces mean nothing.
    pub fault: Option<KnownFault>,
    /// The linear body about a reference in which bonds pull, where somebody asked for it.
    pub stressed: Option<Stressed<D>>,
    /// What its states mean under the stepper that moves it.
    pub regime: Regime,
}

impl<const D: usize> System<D> {
    /// Bytes held: body, bonds, and the state of nine numbers per slot in 3-D.
    pub fn bytes(&self) -> usize {
        self.body.bytes()
            + self.interaction.bytes()
            + self.contact.as_ref().map_or(0, ContactForces::bytes)
            + self
                .inertia
                .as_ref()
                .map_or(0, |i| i.masses.whole().map_or(0, Masses::bytes))
            + 3 * D * 8 * self.body.len()
            + self
                .diffusions
                .all
                .iter()
                .map(Diffusion::bytes)
                .sum::<usize>()
    }

    pub fn refresh_images(&mut self) {
        self.body.exchange().fill_field(&mut self.u);
    }

    pub fn observed_of(&self, energies: &PointEnergies) -> Observed {
        let field = |f: &[f64]| self.body.by_id(|i| f.get(i).copied().unwrap_or(0.0));
        Observed {
            strain: field(&energies.strain),
            repulsion: field(&energies.repulsion),
            dilatation: field(&energies.dilatation),
            whole: field(&energies.whole),
        }
    }

    /// Points may be anywhere now: whoever keeps track of what is near forgets it.
    pub fn invalidate_neighbours(&mut self) {
        if let Some(contact) = &mut self.contact {
            contact.central.invalidate_neighbours();
        }
        self.applied.all().for_each(|x| x.moved(f64::INFINITY));
    }

    /// Displacements of a trial, in order of ids.
    pub fn set_values(&mut self, x: &[[f64; D]]) {
        let mut square = 0.0f64;
        for (x, &s) in x.iter().zip(self.body.slots()) {
            let mut path = 0.0;
            for a in 0..D {
                let u = &mut self.u[a][s as usize];
                path += (x[a] - *u) * (x[a] - *u);
                *u = x[a];
            }
            square = square.max(path);
        }
        self.refresh_images();
        // who keeps track of what is near is told of every trial
        let path = square.sqrt();
        if let Some(contact) = &mut self.contact {
            // ranks look again at once
            contact.central.moved(self.body.most(path));
        }
        self.applied.all().for_each(|x| x.moved(path));
    }

    /// Loads and constraints from now on; what those of before did is in the past.
    pub fn set_acting(&mut self, forces: AppliedForces<D>, constraints: Vec<Constraint<D>>) {
        let now = self.energy_now();
        self.accounts.pass(&now);
        // it goes on; what it took is in the past now
        if let Some(friction) = self.contact.as_mut().and_then(|c| c.friction.as_mut()) {
            friction.forget();
        }
        self.applied = forces;
        self.prescribed.constraints = constraints;
    }
}
