//! From a spec to what spreads.

use super::state::DiffusionInfo;
use crate::body::Body;
use crate::diffusion::{Condition, Conduction, Diffusion, Places, Rows, Surface};
use crate::error::BuildError;
use crate::family::stencil::Stencil;
use crate::message;
use crate::quantity::Dimension;
use crate::run::LoadInfo;
use crate::run::agreed::agreed;
use crate::run::clock::Clock;
use crate::run::names::Names;
use crate::run::surface::Factors;
use crate::run::system::System;
use crate::space::Point;
use crate::spec::{
    BodySpec, DiffusionCondition, DiffusionKind, DiffusionMethod, DiffusionSpec, Exchange, Horizon,
    Quantity, Spec, SurfaceFactors, TimeStep,
};

/// Makes what spreads, of a system at rest.
pub(in crate::run) struct Maker<'a, const D: usize> {
    pub system: &'a mut System<D>,
    pub names: &'a Names<D>,
}

impl<const D: usize> Maker<'_, D> {
    /// All that spreads, from a spec.
    pub(in crate::run) fn make(&mut self, spec: &Spec) -> Result<(), BuildError> {
        let diffusions = &spec.interactions.diffusions;
        for (n, t) in diffusions.iter().enumerate() {
            if diffusions[..n].iter().any(|o| o.quantity == t.quantity) {
                let name = t.quantity.name();
                return Err(BuildError::conflict(name, format!("there is {name} twice")));
            }
        }
        if diffusions.is_empty() {
            return self.make_contact(spec);
        }
        self.system.diffusions.places = Places::new(&self.system.body);
        for t in diffusions {
            let (body, interaction) = (&self.system.body, self.system.interaction.as_ref());
            agreed(body, Rows::fit(body, interaction, t.quantity.name()))?;
            let made = self.diffusion(spec, t)?;
            if let DiffusionMethod::Steady { .. } = t.method {
                steady(&made, &self.system.body, &self.system.diffusions.places)?;
            }
            let info = self.told(spec, t, &made);
            self.system.diffusions.all.push(made);
            self.system.info.diffusions.push(info);
        }
        self.make_contact(spec)?;
        self.make_expansion(spec)?;
        self.make_warmth(spec)?;
        self.make_heated(spec)
    }

    /// Points stand still: how long a step is, and that nothing is asked to move.
    pub(in crate::run) fn stand_for(&mut self, spec: &Spec) -> Result<(), BuildError> {
        let system = &mut *self.system;
        let refused = |path: &str, what: &str| {
            Err(
                BuildError::conflict(path, format!("points stand still, and {what}")).help(
                    "leave it out, or take integrator = \"verlet\", \"newmark\" or [statics]",
                ),
            )
        };
        if system.diffusions.all.is_empty() {
            return Err(BuildError::missing(
                "schedule.integrator",
                "points stand still and nothing spreads: there is nothing to do",
            )
            .help("add [heat] or [species], or take another integrator"));
        }
        if !spec.loading.conditions.is_empty() {
            return refused("conditions[0]", "this moves or loads them");
        }
        if !spec.loading.rigid_bodies.is_empty() {
            return refused("rigid_bodies[0]", "this pushes them");
        }
        let part = match spec.run.schedule.time_step {
            TimeStep::Fixed(_) => return Ok(()),
            TimeStep::Fraction(part) => part,
            TimeStep::Auto => 1.0,
        };
        let mut dt = f64::INFINITY;
        for (t, info) in system.diffusions.all.iter().zip(&system.info.diffusions) {
            match t.method {
                DiffusionMethod::Explicit { safety } => {
                    dt = dt.min(part * safety * info.stable_step);
                }
                DiffusionMethod::Implicit { .. } | DiffusionMethod::Steady { .. } => {}
            }
        }
        if !dt.is_finite() {
            return Err(BuildError::missing(
                "schedule.time_step",
                "implicit and steady values have steps of any length: how long they are must be said",
            )
            .help(message![
                "write time_step as a number: what is here spreads over the body in about ",
                Dimension::TIME.of(system.info.diffusions[0].spread),
            ]));
        }
        system.clock = Clock::new(dt);
        system.info.time_step = dt;
        Ok(())
    }

    fn diffusion(&mut self, spec: &Spec, t: &DiffusionSpec) -> Result<Diffusion, BuildError> {
        let name = t.quantity.name();
        let (body, interaction) = (&self.system.body, self.system.interaction.as_ref());
        let places = &self.system.diffusions.places;
        let slots = places.here();
        let of = |slot: usize| &t.materials[body.material_of(slot)];
        let weight = |slot: usize, xi: &[f64], r: f64| {
            let model = self.system.constitutive.at(body, slot);
            let own = body.horizons().get(slot);
            model.weight_within(own.copied().unwrap_or(model.horizon), xi, r)
        };
        let exact = exact_surfaces(spec, body);
        let factor = |i: usize, j: usize, xi: &[f64; D]| {
            let of = exact.iter().find(|of| of.slots.contains(&i));
            of.filter(|of| of.slots.contains(&j)).map_or(1.0, |of| {
                let (factors, [i, j]) = (&of.factors, [i, j].map(|s| s - of.slots.start));
                let to = xi.map(|x| (x / of.spacing).round() as i32);
                factors.of(i, to).conductance / (factors.part(i) * factors.part(j))
            })
        };
        let moment = |slot: usize| {
            let of = exact.iter().find(|of| of.slots.contains(&slot))?;
            let cell = body.volume().at(slot) / of.factors.part(slot - of.slots.start);
            let term = |xi: &[f64; D]| {
                let square: f64 = xi.iter().map(|x| x * x).sum();
                weight(slot, xi, square.sqrt()) * square * cell
            };
            Some(of.bonds.iter().map(term).sum())
        };
        let rows = Rows::new(
            body,
            interaction,
            &Conduction {
                conductivity: &|slot| of(slot).conductivity,
                weight: &|i, j, xi, r| 0.5 * (weight(i, xi, r) + weight(j, xi, r)),
                places,
                surface: (!exact.is_empty()).then_some(Surface {
                    factor: &factor,
                    moment: &moment,
                }),
            },
        );
        let capacity = slots.iter().map(|s| {
            let i = *s as usize;
            let volume = body.volume().at(i);
            match t.quantity {
                Quantity::Heat => body.density().at(i) * of(i).capacity * volume,
                Quantity::Species => volume,
            }
        });
        let mut value = vec![t.reference; places.count()];
        for (set, e) in &t.initial {
            let (places, points) = self.places(set, name)?;
            for (i, x) in places.iter().zip(&points) {
                value[*i as usize] = e.eval(x, 0.0);
            }
        }
        let begins = value[..slots.len()].iter().position(|v| !v.is_finite());
        let begins = match begins {
            None => Ok(()),
            Some(n) => Err(BuildError::invalid(
                name,
                format!(
                    "the {} at the start is {} at {:?}",
                    t.quantity.column(),
                    value[n],
                    &body.position(slots[n] as usize)[..D]
                ),
            )),
        };
        let (mut conditions, mut loads) = (vec![], vec![]);
        for c in &t.conditions {
            let (made, told) = self.condition(c, t.quantity)?;
            conditions.push(made);
            loads.extend(told);
        }
        let made = Diffusion::new(
            t.quantity,
            (t.method, t.across_broken),
            rows,
            capacity.collect(),
            conditions,
            value,
        );
        self.system.info.loads.extend(loads);
        // which one rank may say: all have made theirs by now
        agreed(&self.system.body, begins)?;
        Ok(made)
    }

    /// Places and reference positions of a set.
    fn places(&self, set: &str, path: &str) -> Result<(Vec<u32>, Vec<Point>), BuildError> {
        let system = &*self.system;
        let found = system.body.slots_of(set, &self.names.sets);
        let (slots, points) = found.map_err(|e| e.at(path))?;
        let places = &system.diffusions.places;
        let place = slots.iter().map(|s| places.at(*s as usize) as u32);
        Ok((place.collect(), points))
    }

    /// A condition, and what it comes to.
    fn condition(
        &self,
        c: &DiffusionCondition,
        quantity: Quantity,
    ) -> Result<(Condition, Option<LoadInfo>), BuildError> {
        let system = &*self.system;
        let path = quantity.name();
        let (places, points) = self.places(&c.set, path)?;
        let slots = system.body.slots_of(&c.set, &self.names.sets)?.0;
        let area = |area: &Option<f64>| -> Result<Vec<f64>, BuildError> {
            let areas = self.names.faces.areas(&system.body, &c.set, &slots, *area);
            areas.map_err(|e| e.at(path))
        };
        let (what, sizes) = match (&c.kind, quantity) {
            (DiffusionKind::Value(_), _) => ("", vec![]),
            (DiffusionKind::Source(_), Quantity::Heat) => ("heat source", vec![]),
            (DiffusionKind::Source(_), Quantity::Species) => ("species source", vec![]),
            (DiffusionKind::Flux { area: a, .. }, Quantity::Heat) => ("heat flux", area(a)?),
            (DiffusionKind::Flux { area: a, .. }, Quantity::Species) => ("species flux", area(a)?),
            (DiffusionKind::Exchange { law, area: a }, quantity) => (
                match (law, quantity) {
                    (Exchange::Radiation { .. }, _) => "radiation",
                    (Exchange::Convection { .. }, Quantity::Heat) => "convection",
                    (Exchange::Convection { .. }, Quantity::Species) => "species exchange",
                },
                area(a)?,
            ),
        };
        let has_area = matches!(
            c.kind,
            DiffusionKind::Flux { .. } | DiffusionKind::Exchange { .. }
        );
        let volumes = || slots.iter().map(|s| system.body.volume().at(*s as usize));
        let power = match &c.kind {
            DiffusionKind::Flux { value, .. } => Some((value, sizes.clone())),
            DiffusionKind::Source(value) => Some((value, volumes().collect())),
            DiffusionKind::Value(_) | DiffusionKind::Exchange { .. } => None,
        };
        let told = (!what.is_empty()).then(|| LoadInfo {
            what,
            set: c.set.clone(),
            area: (has_area).then(|| system.body.sum(sizes.iter().copied())),
            force: None,
            power: power.as_ref().map(|(value, sizes)| {
                let each = points.iter().zip(sizes);
                system
                    .body
                    .sum(each.map(|(x, size)| size * value.eval(x, 0.0)))
            }),
            varies: power.is_some_and(|(value, _)| value.depends_on_time()),
        });
        let made = match &c.kind {
            DiffusionKind::Value(e) => Condition::held(e, places, points),
            DiffusionKind::Flux { value, .. } => Condition::power(value, sizes, places, points),
            DiffusionKind::Source(e) => {
                let volume = slots.iter().map(|s| system.body.volume().at(*s as usize));
                Condition::power(e, volume.collect(), places, points)
            }
            DiffusionKind::Exchange { law, .. } => match law {
                Exchange::Convection {
                    coefficient,
                    ambient,
                } => {
                    let law = [coefficient, ambient];
                    Condition::convection(law, sizes, places, points)
                }
                Exchange::Radiation {
                    coefficient,
                    ambient,
                } => {
                    let law = [coefficient, ambient];
                    Condition::radiation(law, sizes, places, points)
                }
            },
        };
        Ok((made, told))
    }

    fn told(&self, spec: &Spec, t: &DiffusionSpec, made: &Diffusion) -> DiffusionInfo {
        let system = &*self.system;
        let each = t.materials.iter().zip(&spec.materials);
        let diffusivity: Vec<f64> = each
            .map(|(t_m, m)| match t.quantity {
                Quantity::Heat => t_m.conductivity / (m.density * t_m.capacity),
                Quantity::Species => t_m.conductivity,
            })
            .collect();
        let extent = |a: usize| {
            let along = system
                .body
                .slots()
                .iter()
                .map(|s| system.body.position(*s as usize)[a]);
            let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                (l.min(x), h.max(x))
            });
            let (low, high) = (system.body.least(low), system.body.most(high));
            high - low + system.body.spacing()
        };
        let longest = (0..D).map(extent).fold(0.0, f64::max);
        let least = diffusivity.iter().copied().fold(f64::INFINITY, f64::min);
        DiffusionInfo {
            quantity: t.quantity,
            method: t.method,
            stable_step: made.stable_step(&system.body, 0.0),
            spread: longest * longest / least,
            diffusivity,
        }
    }
}

/// Is every part held, or in exchange with something? All ranks ask at once.
fn steady<const D: usize>(
    made: &Diffusion,
    body: &Body<D>,
    places: &Places,
) -> Result<(), BuildError> {
    let held = made.conditions.iter().flat_map(Condition::holds);
    let exchanged = made.conditions.iter().flat_map(Condition::exchanges);
    let name = made.quantity.name();
    match made.rows.are_tied(body, places, held.chain(exchanged).copied()) {
        true => Ok(()),
        false => Err(BuildError::ill_posed(
            name,
            format!(
                "a part of the body has no steady {}: nothing there holds it",
                made.quantity.column()
            ),
        )
        .help("hold it, or exchange with the surroundings, somewhere on every connected part; or take an implicit step in time")),
    }
}

/// A body whose surface runs through its outermost points.
struct ExactSurface<'a, const D: usize> {
    slots: std::ops::Range<usize>,
    factors: Factors<'a, D>,
    bonds: Vec<[f64; D]>,
    spacing: f64,
}

/// All bodies with such a surface.
fn exact_surfaces<'a, const D: usize>(spec: &'a Spec, all: &Body<D>) -> Vec<ExactSurface<'a, D>> {
    let made = |first: usize, f: &'a SurfaceFactors, body: &Body<D>, of: (&BodySpec, Horizon)| {
        f.ends_at_points().then(|| ExactSurface {
            slots: first..first + body.len(),
            factors: Factors::new(f, body),
            bonds: family(of.0, body.spacing(), of.1),
            spacing: body.spacing(),
        })
    };
    let horizon = spec.bonds.horizon;
    let single = spec.bonds.surface.iter();
    let single = single.filter_map(|f| made(0, f, all, (&spec.body, horizon)));
    let pieces = spec.body.pieces().iter().zip(all.pieces());
    let several = pieces.filter_map(|(piece, own)| {
        let of = (&piece.body, piece.horizon.unwrap_or(horizon));
        made(own.first, piece.surface.as_ref()?, &own.body, of)
    });
    single.chain(several).collect()
}

/// Bonds of a point inside a body on a chain, square or cubic lattice.
fn family<const D: usize>(body: &BodySpec, spacing: f64, horizon: Horizon) -> Vec<[f64; D]> {
    match body {
        BodySpec::Lattice { kind, .. } | BodySpec::Sites { kind, .. } => {
            let stencil = Stencil::new(*kind, spacing, horizon);
            let cells = stencil.offsets()[0].iter().map(|o| o.cell);
            cells
                .map(|c| crate::array::from_fn(|a| spacing * f64::from(c[a])))
                .collect()
        }
        BodySpec::Cloud(_) | BodySpec::Several(_) => vec![],
    }
}
