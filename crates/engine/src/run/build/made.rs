//! The system of a spec: its bodies and bonds at rest, and all that begins and acts.

use super::bodies::Bodies;
use super::bonds::Bonds;
use crate::body::{view, zeros};
use crate::boundary_condition::applied::AppliedForces;
use crate::boundary_condition::prescribed_motion::PrescribedMotion;
use crate::constitutive::AnyPotentials;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::interaction::ContactForces;
use crate::quantity::Warnings;
use crate::run::accounts::state::Accounts;
use crate::run::agreed::agreed;
use crate::run::bind::names;
use crate::run::clock::Clock;
use crate::run::clouds::own_velocities;
use crate::run::conditions::tell_loads;
use crate::run::contact::Rules;
use crate::run::diffusions::make::Maker;
use crate::run::diffusions::state::Diffusions;
use crate::run::inertia::state::Inertia;
use crate::run::names::Names;
use crate::run::observation::View;
use crate::run::overloaded::overloaded;
use crate::run::sets::initial;
use crate::run::system::{Regime, System, Watch};
use crate::run::time_step::{Limits, time_step};
use crate::run::{Gap, Info, atoms, contact, gaps, precracks, rigid_bodies};
use crate::spec::{LawSpec, Spec, TimeStep};
use crate::statics::SYMMETRIC;

/// A system, and how long its steps may be.
pub(super) struct Made<const D: usize> {
    pub system: System<D>,
    pub names: Names<D>,
    pub limits: Limits,
    /// Of the body at rest (time).
    pub dt: f64,
}

impl<const D: usize> Made<D> {
    /// At rest, and nothing acts; `trust`: leave the stability limit unmeasured.
    pub fn new(
        spec: &Spec,
        (simd, trust): (Simd, bool),
        bodies: Bodies<'_, D>,
        mut bonds: Bonds<D>,
        mut warnings: Warnings,
    ) -> Result<Self, BuildError> {
        let (parts, body) = (&bodies.parts, &bodies.body);
        let repulsion = contact::repulsion(spec, parts, &bonds.constitutive, body)?;
        let range = |a: usize, b: usize| repulsion.as_ref().map_or(0.0, |r| r.range(a, b));
        let gap = |&([a, b], distance): &([usize; 2], f64)| Gap {
            bodies: [a, b],
            distance,
            contact: range(a, b),
        };
        let gaps: Vec<Gap> = bodies.nearest.iter().map(gap).collect();
        let spacing = |n: usize| body.pieces()[n].body.spacing();
        warnings.extend(gaps::warnings(spec, &gaps, spacing));
        let measured = limits(spec, trust, &bodies, &mut bonds, repulsion.as_ref())?;
        let (inertia, limits) = measured;
        let points = body.all_points();
        let dt = time_step(spec, points, &limits, repulsion.as_ref(), &mut warnings)?;
        bonds.constitutive.forget_stencils(); // the interaction has them
        let info = info(
            spec,
            simd,
            (&bodies, &bonds),
            (&limits, dt),
            repulsion.as_ref(),
        );
        let info = Info {
            gaps,
            warnings,
            ..info
        };
        let contact = match repulsion {
            None => None,
            Some(r) => {
                let pairs = bonds.constitutive.all().filter_map(|m| m.pairs.as_ref());
                let horizon = pairs
                    .map(|p| p.shortest())
                    .fold(bodies.least_horizon, f64::min);
                Some(ContactForces {
                    central: r.contact(parts, body, horizon),
                    friction: contact::friction(spec, body)?,
                })
            }
        };
        let system = System {
            info,
            v: zeros(body.len()),
            f: zeros(body.len()),
            u: body.at_rest(),
            inertia,
            contact,
            toughness: None,
            healing: None,
            breakage: spec.damage.breakage,
            stop: || false,
            constitutive: bonds.constitutive,
            interaction: bonds.interaction,
            body: bodies.body,
            prescribed: PrescribedMotion::default(),
            applied: AppliedForces::default(),
            watch: Watch::default(),
            clock: Clock::new(dt),
            accounts: Accounts::default(),
            fault: None,
            stressed: None,
            regime: Regime::default(),
            diffusions: Diffusions::default(),
        };
        Ok(Made {
            system,
            names: bodies.names,
            limits,
            dt,
        })
    }

    /// What points begin with, and what spreads.
    pub fn begin(
        &mut self,
        spec: &Spec,
        potentials: Option<&AnyPotentials>,
    ) -> Result<(), BuildError> {
        let (system, names) = (&mut self.system, &self.names);
        if let Some(thermal) = &spec.loading.thermal {
            atoms::heat(system, thermal)?;
        }
        if let Some(velocity) = own_velocities(spec, &system.body) {
            system.body.scatter(&mut system.v, &velocity);
        }
        let begun = initial(spec, names, system);
        agreed(&system.body, begun)?;
        if let (TimeStep::Auto, Some(potentials)) = (spec.run.schedule.time_step, potentials) {
            let dt = self.dt.min(atoms::step_of_speeds(system, potentials)?);
            system.clock = Clock::new(dt);
            system.info.time_step = dt;
        }
        let mut maker = Maker { system, names };
        maker.make(spec)?;
        if spec.run.schedule.stepper.rests() {
            maker.stand_for(spec)?;
        }
        system.info.bytes = system.body.count(system.bytes() as u64) as usize;
        let fields = spec.run.fields.as_deref().unwrap_or_default();
        View::of(system, &names.registry, spec.loading.boltzmann).check_fields(fields)
    }

    /// What acts.
    pub fn act(&mut self, spec: &Spec) -> Result<(), BuildError> {
        let (system, names) = (&mut self.system, &self.names);
        rigid_bodies::check(spec, &system.body)?;
        let (conditions, sets) = (&spec.loading.conditions, &names.sets);
        let acting = names.acting(&system.body, conditions, &spec.loading.rigid_bodies, sets)?;
        let (forces, constraints) = acting;
        system.set_acting(forces, constraints);
        system.toughness = system.toughness_of(spec, sets)?;
        system.healing = system.healing_of(spec, sets)?;
        // how long a run of a given duration is, its caller knows
        let steps = match spec.run.schedule.steps {
            0 => 1000,
            steps => steps,
        };
        let end = steps as f64 * self.dt;
        agreed(&system.body, system.check_agreement(conditions, end))?;
        let loads = &mut system.applied.loads;
        let told = tell_loads(&system.body, loads, conditions, end);
        system.info.loads.extend(told);
        let overloaded = overloaded(system, end);
        system.info.warnings.extend(overloaded);
        Ok(())
    }
}

/// Masses that couple points, and the longest steps of the body when all bonds are whole; bonds learn of the steps.
fn limits<const D: usize>(
    spec: &Spec,
    trust: bool,
    bodies: &Bodies<'_, D>,
    bonds: &mut Bonds<D>,
    repulsion: Option<&Rules>,
) -> Result<(Option<Inertia<D>>, Limits), BuildError> {
    let (body, interaction) = (&bodies.body, bonds.interaction.as_mut());
    if spec.damage.healing.is_some() {
        // a step is stable when all is whole again
        let rest = body.at_rest();
        interaction.mend(body, view(&rest), &|_, _, _| true);
    }
    let inertia = Inertia::of(spec, body)?;
    let limits = match trust || !spec.run.schedule.stepper.has_inertia() {
        true => Limits::UNKNOWN,
        false => Limits::of(
            spec,
            (&bodies.parts, &bonds.constitutive),
            (body, inertia.as_ref()),
            interaction,
            bonds.cell_volume,
            repulsion,
        )?,
    };
    interaction.begin_steps(body);
    if spec.damage.healing.is_some() {
        precracks::cut(spec, body, interaction, &mut Warnings::default())?;
    }
    Ok((inertia, limits))
}

/// What the system is, but for what lies between bodies and what there is to be warned of.
fn info<const D: usize>(
    spec: &Spec,
    simd: Simd,
    (bodies, bonds): (&Bodies<'_, D>, &Bonds<D>),
    (limits, dt): (&Limits, f64),
    repulsion: Option<&Rules>,
) -> Info {
    let (body, interaction) = (&bodies.body, bonds.interaction.as_ref());
    let constitutive = &bonds.constitutive;
    let sizes = body.slots().iter();
    let sizes = sizes.map(|s| interaction.family_size(body, *s as usize));
    let (smallest, largest) = sizes.fold((usize::MAX, 0), |(a, b), n| (a.min(n), b.max(n)));
    let (smallest, largest) = (body.least(smallest as f64), body.most(largest as f64));
    let points = body.all_points();
    let sweeps = { constitutive.all().zip(&bodies.parts) }
        .map(|(m, part)| m.sweeps.clone().filter(|_| part.bonded));
    let registry = &bodies.names.registry;
    let kinds =
        |law: &LawSpec| matches!(law, LawSpec::Named(law) if registry.bond_classes(&law.name));
    Info {
        dimension: D,
        points: points as u64,
        directed_bonds: bonds.directed,
        family: (
            smallest as usize,
            bonds.directed as f64 / points as f64,
            largest as usize,
        ),
        family_kind: interaction.family(),
        sweeps: sweeps.collect(),
        near_horizon: bonds.near_horizon,
        horizon: bodies.horizon,
        spacing: body.spacing(),
        section: spec.space.section,
        mass: body.mass(),
        volume: body.sum({ body.slots().iter() }.map(|s| body.volume().at(*s as usize))),
        // bonds of several kinds have no single one
        micromodulus: match spec.materials.iter().any(|m| kinds(&m.law)) {
            true => vec![],
            false => constitutive.micromoduli(spec.materials.len()),
        },
        critical_stretch: constitutive.critical_stretches(spec.materials.len()),
        families: constitutive.families(spec.materials.len()),
        time_step: dt,
        stepper: spec.run.schedule.stepper,
        stable_step: limits.stable(),
        contact_step: limits.contact,
        contact_stiffness: repulsion.map_or(vec![], |r| r.stiffness()),
        parts: 1,
        conserves: bonds.asymmetry <= SYMMETRIC && !spec.run.schedule.force_unstable,
        bodies: names(spec, body),
        gaps: vec![],
        diffusions: vec![],
        loads: vec![],
        cut: bonds.cut,
        idle_ranks: body.count(u64::from(body.points() == 0)),
        bytes: 0,
        simd: simd.name(),
        warnings: Warnings::default(),
    }
}
