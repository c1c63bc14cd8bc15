//! A model whose body many ranks share: each moves its own points, and their numbers are the same bits as if one rank had all.
//!
//! So far what runs is a lattice body of one piece with bonds of any law on a stencil, by velocity Verlet with a step that is given, from initial
//! values; what breaks does by its stretch. [`shared`] says of anything else that it does not yet.

use super::build::made_among;
use super::{Model, Options, Shelf, Simulation};
use crate::body::Subdomain;
use crate::columns::{Declaration, Life, On};
use crate::error::{BuildError, RunError};
use crate::observe::Column;
use crate::spec::{
    BodySpec, Criterion, FamilyChoice, FractureSpec, LawSpec, Members, Spec, Stepper, TimeStep,
};
use peridyne_comm::Comm;
use std::sync::Arc;

/// The part of a model that one rank has.
pub struct RankModel<const D: usize> {
    model: Model<D>,
}

impl<const D: usize> RankModel<D> {
    /// All ranks come here at once, with the same spec.
    ///
    /// # Errors
    /// As of [`build`](super::build), and what ranks do not share yet.
    pub fn new(
        spec: &Spec,
        options: Options,
        shelf: &Shelf,
        comm: &Arc<Comm>,
    ) -> Result<RankModel<D>, BuildError> {
        shared(spec)?;
        let model = made_among(spec, options, shelf, Some(comm))?;
        Ok(RankModel { model })
    }

    fn subdomain(&self) -> &Subdomain {
        let subdomain = self.model.system.body.subdomain();
        subdomain.expect("made of a part of a body")
    }

    /// Ids among all points of those that are here, in the order of columns.
    pub fn ids(&self) -> &[u32] {
        self.subdomain().ids()
    }

    /// Points of all ranks.
    pub fn points(&self) -> usize {
        self.subdomain().points()
    }

    /// Forces of the state that the run begins from, and what breaks by them. All ranks at once, as below.
    pub fn start(&mut self) {
        self.model.start(true);
    }

    /// One step.
    ///
    /// # Errors
    /// As of [`Simulation::step`]. The other ranks wait for this one then: all must end.
    pub fn step(&mut self) -> Result<(), RunError> {
        self.model.step()
    }

    /// Columns of points that a state is made of. What is derived from them may walk over bonds from one end, of which the other may be elsewhere.
    pub fn columns(&mut self) -> Vec<Declaration> {
        let mut all = self.model.columns();
        all.retain(|c| c.on == On::Points && c.life == Life::Persistent);
        all
    }

    /// One of these, of the points that are here; `None`: there is none of that name.
    pub fn column(&mut self, name: &str) -> Option<Column> {
        let known = self.columns().iter().any(|c| c.name == name);
        self.model.column(name).filter(|_| known)
    }

    /// Strain energy of the bonds of all ranks, and energy of repulsion inside the family (energy).
    pub fn energy(&mut self) -> [f64; 2] {
        let system = &mut self.model.system;
        system.refresh_images();
        system
            .interaction
            .energy(&system.body, crate::body::view(&system.u))
    }

    /// Bytes that this rank has sent for copies of its points, and copies that it has of others'.
    pub fn halo(&self) -> (u64, usize) {
        let exchange = self.model.system.body.exchange();
        (exchange.sent(), exchange.received_slots())
    }
}

/// Can ranks share the model of a spec?
///
/// # Errors
/// What they do not share yet.
pub fn shared(spec: &Spec) -> Result<(), BuildError> {
    let lattice = matches!(
        spec.body,
        BodySpec::Lattice { perturb: None, .. } | BodySpec::Sites { .. }
    );
    let bonds = |law: &LawSpec| match law {
        LawSpec::Pmb(_)
        | LawSpec::Lps(_)
        | LawSpec::LpsAsTyped { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Named(_) => true,
        LawSpec::Springs(_) | LawSpec::Micromoduli(_) | LawSpec::Atoms(_) => false,
    };
    let stretch = |f: &FractureSpec| {
        matches!(f.criterion, Criterion::Stretch(_)) && f.rate.is_none() && f.fatigue.is_none()
    };
    let places = |members: &Members| {
        matches!(
            members,
            Members::All | Members::Region(_) | Members::Where(_)
        )
    };
    let (bonded, run) = (&spec.bonds, &spec.run);
    let limits = [
        ("body", "bodies other than one lattice", !lattice),
        (
            "bonds.family",
            "bonds in lists",
            !matches!(bonded.family, FamilyChoice::Auto | FamilyChoice::Stencil)
                || !spec.interactions.pairs.is_empty(),
        ),
        (
            "bonds",
            "horizons of points, factors of bonds and surfaces",
            bonded.own_horizon.is_some()
                || bonded.surface.is_some()
                || !bonded.factors.is_empty()
                || bonded.smooth.is_some(),
        ),
        (
            "materials",
            "bonds that break by more than their stretch",
            !{ spec.materials.iter() }.all(|m| m.fracture.as_ref().is_none_or(stretch)),
        ),
        (
            "materials",
            "potentials and linear springs",
            !spec.materials.iter().all(|m| bonds(&m.law)),
        ),
        (
            "sets",
            "sets that are not of a place",
            !spec.sets.iter().all(|set| places(&set.members)),
        ),
        (
            "interactions",
            "contact, interfaces and potentials beside bonds",
            spec.interactions.contact.is_some()
                || !spec.interactions.interfaces.is_empty()
                || !spec.interactions.potentials.is_empty()
                || spec.interactions.bonded.is_some(),
        ),
        (
            "interactions.transfers",
            "heat and other quantities",
            !spec.interactions.transfers.is_empty(),
        ),
        (
            "damage",
            "pre-cracks, fields of toughness and healing",
            !spec.damage.precracks.is_empty()
                || !spec.damage.toughness.is_empty()
                || spec.damage.healing.is_some(),
        ),
        (
            "loading",
            "conditions, indenters and velocities by temperature",
            !spec.loading.conditions.is_empty()
                || !spec.loading.indenters.is_empty()
                || spec.loading.thermal.is_some(),
        ),
        (
            "run.schedule.time_step",
            "steps that follow from the body",
            !matches!(run.schedule.time_step, TimeStep::Fixed(_)),
        ),
        (
            "run.schedule.stepper",
            "steppers other than velocity Verlet",
            run.schedule.stepper != Stepper::default(),
        ),
        (
            "run",
            "preloads and probes",
            run.preload.is_some() || !run.probes.is_empty(),
        ),
    ];
    match limits.into_iter().find(|(_, _, wrong)| *wrong) {
        None => Ok(()),
        Some((path, what, _)) => Err(BuildError::unsupported(
            path,
            format!("ranks do not share {what} yet"),
        )
        .help("run it in one process, on as many threads as there are")),
    }
}
