//! Probes: what is measured of a set of points, as columns of a history.

use super::crack;
use super::state::{Kind, Probe};
use crate::body::Body;
use crate::columns::{Dimension, Shape};
use crate::error::BuildError;
use crate::execute::exact::Exact;
use crate::message;
use crate::observe::{Column, ProbeColumn};
use crate::run::model::Model;
use crate::run::system::System;
use crate::space::Point;
use crate::spec::{Fold, Measure, Part, ProbeSpec};

/// Pairs of axes of the moments about z, and in 3-D about x and y before it.
const TURNS: [(&str, [usize; 2]); 3] = [("x", [1, 2]), ("y", [2, 0]), ("z", [0, 1])];

impl<const D: usize> Model<D> {
    /// Probes of a specification.
    ///
    /// # Errors
    /// What they ask for does not exist.
    pub(in crate::run) fn probes_of(
        &mut self,
        specs: &[ProbeSpec],
    ) -> Result<Vec<Probe>, BuildError> {
        let mut all = Vec::with_capacity(specs.len());
        for (n, spec) in specs.iter().enumerate() {
            let probe = self.probe_of(spec, &format!("probes[{n}]"))?;
            let taken = |p: &Probe, c: &ProbeColumn| p.columns.iter().any(|o| o.name == c.name);
            let twice = probe
                .columns
                .iter()
                .find(|c| all.iter().any(|p| taken(p, c)));
            if let Some(column) = twice {
                let message = format!("two probes write the column `{}`", column.name);
                return Err(BuildError::conflict(format!("probes[{n}].name"), message)
                    .help("give them different names"));
            }
            all.push(probe);
        }
        Ok(all)
    }

    fn probe_of(&mut self, spec: &ProbeSpec, path: &str) -> Result<Probe, BuildError> {
        let at = |key: &str| format!("{path}.{key}");
        let Some(mut ids) = self.members_of(&spec.set) else {
            let known: Vec<&str> = self
                .names
                .sets
                .iter()
                .map(|(name, _)| name.as_str())
                .collect();
            let message = format!("there is no set `{}`", spec.set);
            let help = format!(
                "known are all{}{}",
                if known.is_empty() { "" } else { ", " },
                known.join(", ")
            );
            return Err(BuildError::unknown(at("set"), &spec.set, message).help(help));
        };
        if self.system.body.count(ids.len() as u64) == 0 {
            return Err(BuildError::empty(
                at("set"),
                format!("the set `{}` has no points", spec.set),
            ));
        }
        let name = |part: &str| match part {
            "" => spec.name.clone(),
            part => format!("{}_{part}", spec.name),
        };
        let column = |part: &str, dimension| ProbeColumn::new(name(part), dimension);
        let (kind, columns) = match &spec.measure {
            Measure::Reaction => {
                let axes = &Shape::Vector.components()[..D];
                let columns = axes.iter().map(|a| column(a, Dimension::FORCE));
                (Kind::Reaction, columns.collect())
            }
            Measure::Moment { about } => {
                if D == 1 {
                    let message = "there are no moments in one dimension";
                    return Err(BuildError::unsupported(at("about"), message));
                }
                let turns = TURNS.iter().filter(|(_, axes)| axes.iter().all(|a| *a < D));
                // a moment is no energy, though it has the dimension of one
                let columns = turns.map(|(a, _)| column(a, Dimension::ENERGY).moment());
                (Kind::Moment(*about), columns.collect())
            }
            Measure::Energy => {
                let parts = ["kinetic", "strain", "repulsion"];
                let columns = parts.map(|p| column(p, Dimension::ENERGY));
                (Kind::Energy, columns.to_vec())
            }
            Measure::Over { fold, of, part } => {
                let (parts, columns) = self.parts(of, part, path, &column)?;
                (Kind::Over(*fold, of.clone(), parts), columns)
            }
            Measure::Value { at, of, part } => {
                ids = self.nearest_of(&ids, at);
                let (parts, columns) = self.parts(of, part, path, &column)?;
                (Kind::Over(Fold::Sum, of.clone(), parts), columns)
            }
            Measure::RigidBody { rigid_body, of } => {
                self.system.rigid_probe(&spec.name, rigid_body, *of, path)?
            }
            Measure::JIntegral(j_integral) => {
                let j_integral = self.system.j_integral_of(j_integral, path)?;
                let columns = vec![
                    column("J", Dimension::FRACTURE_ENERGY),
                    // K² = J E′
                    column("K", Dimension::FRACTURE_ENERGY * Dimension::PRESSURE).rooted(),
                ];
                (Kind::JIntegral(Box::new(j_integral)), columns)
            }
            Measure::CrackTip(crack) => {
                self.look().check_column("damage", &at("measure"))?;
                let horizon = self.system.info.horizon;
                let far = least_square(&self.system.body, &ids, &crack.from);
                if far > horizon * horizon {
                    let message = message![
                        "no point that is measured lies within a horizon of it: the nearest is ",
                        Dimension::LENGTH.of(far.sqrt()),
                        " away",
                    ];
                    return Err(BuildError::invalid(at("from"), message)
                        .help("write where the crack starts in the reference"));
                }
                let axes = &Shape::Vector.components()[..D];
                let mut columns: Vec<_> = { axes.iter() }
                    .map(|a| column(a, Dimension::LENGTH))
                    .collect();
                let length = column("length", Dimension::LENGTH);
                columns.push(length.with_speed(name("speed"), crack::SPEED_OVER * horizon));
                columns.push(column("branches", Dimension::NUMBER));
                (Kind::CrackTip(*crack), columns)
            }
            Measure::Opening { between } => {
                let ends = between.map(|place| self.nearest_of(&ids, &place));
                let apart = self.system.body.exchange().any(ends[0] != ends[1]);
                if !apart {
                    let message = "both places have the same nearest point";
                    return Err(BuildError::invalid(at("between"), message)
                        .help("write two places that are farther apart"));
                }
                let axes = &Shape::Vector.components()[..D];
                let mut columns = vec![column("", Dimension::LENGTH)];
                columns.extend(axes.iter().map(|a| column(a, Dimension::LENGTH)));
                (Kind::Opening(ends), columns)
            }
            Measure::Fragments { points } => {
                let columns = vec![
                    column("count", Dimension::NUMBER),
                    column("largest", Dimension::MASS),
                    column("others", Dimension::MASS),
                ];
                (Kind::Fragments(*points), columns)
            }
        };
        Ok(Probe { ids, kind, columns })
    }

    /// The point of these, of all ranks, that is nearest to a place in the reference, the first of several; nothing on the other ranks.
    fn nearest_of(&self, ids: &[u32], at: &Point) -> Vec<u32> {
        let body = &self.system.body;
        let far = |id: &u32| square(body, *id, at);
        let nearest = least_square(body, ids, at);
        let own = ids.iter().find(|id| far(id) == nearest);
        let of_all = |id: &u32| body.id_of_all(*id as usize) as f64;
        let first = body.least(own.map_or(f64::INFINITY, of_all));
        own.copied()
            .filter(|id| of_all(id) == first)
            .into_iter()
            .collect()
    }

    /// Which components of a column are asked for, and what they are called.
    #[allow(clippy::type_complexity)] // two lists side by side
    fn parts(
        &mut self,
        of: &str,
        part: &Part,
        path: &str,
        column: &dyn Fn(&str, Dimension) -> ProbeColumn,
    ) -> Result<(Vec<Option<usize>>, Vec<ProbeColumn>), BuildError> {
        let declared = self.look().check_column(of, &format!("{path}.of"))?;
        let names = declared.shape.components();
        // components of axes that are not there are 0
        let there = |name: &&&str| name.bytes().all(|b| usize::from(b - b'x') < D);
        let whole: Vec<usize> = match names {
            [] => vec![0],
            names => (0..names.len()).filter(|n| there(&&names[*n])).collect(),
        };
        let titled = |n: usize| column(names.get(n).copied().unwrap_or(""), declared.dimension);
        Ok(match part {
            Part::All => {
                let columns = whole.iter().map(|n| titled(*n)).collect();
                (whole.into_iter().map(Some).collect(), columns)
            }
            Part::Magnitude => {
                let part = if names.is_empty() { "" } else { "magnitude" };
                (vec![None], vec![column(part, declared.dimension)])
            }
            Part::Component(name) => {
                let Some(n) = whole
                    .iter()
                    .find(|n| names.get(**n) == Some(&name.as_str()))
                else {
                    let known: Vec<&str> = whole
                        .iter()
                        .filter_map(|n| names.get(*n).copied())
                        .collect();
                    let message = format!("`{of}` has no component `{name}`");
                    let help = match known.is_empty() {
                        true => format!("`{of}` is one number: leave component out"),
                        false => format!("components are {}, and magnitude", known.join(", ")),
                    };
                    return Err(
                        BuildError::invalid(format!("{path}.component"), message).help(help)
                    );
                };
                (vec![Some(*n)], vec![titled(*n)])
            }
        })
    }

    /// What probes measure now, in the order of their columns.
    pub(in crate::run) fn probed(&mut self) -> Vec<f64> {
        if self.probes.is_empty() {
            return vec![];
        }
        let probes = std::mem::take(&mut self.probes);
        // columns that several probes look at are computed once
        let mut wanted: Vec<&str> = vec![];
        for probe in &probes {
            let of: &[&str] = match &probe.kind {
                Kind::Over(_, of, _) => &[of.as_str()],
                Kind::Energy => &ENERGIES,
                Kind::CrackTip(_) => &["damage"],
                Kind::JIntegral(_)
                | Kind::Reaction
                | Kind::Moment(_)
                | Kind::Opening(_)
                | Kind::Fragments(_)
                | Kind::Rigid(..) => &[],
            };
            wanted.extend(
                of.iter()
                    .filter(|name| !wanted.contains(name))
                    .collect::<Vec<_>>(),
            );
        }
        let columns = self.columns_of(wanted.into_iter());
        let mut values = vec![];
        for probe in &probes {
            match &probe.kind {
                Kind::Reaction => values.extend(self.system.reaction_of(&probe.ids)),
                Kind::Moment(about) => values.extend(self.system.moment_of(&probe.ids, about)),
                Kind::Energy => {
                    let energy = |name: &str| {
                        let of_point = |id: &u32| {
                            let volume = self
                                .system
                                .body
                                .volume()
                                .at(self.system.body.slots()[*id as usize] as usize);
                            volume * named(&columns, name).values.at(*id as usize, 0)
                        };
                        self.system.body.sum(probe.ids.iter().map(of_point))
                    };
                    values.extend(ENERGIES.map(energy));
                }
                Kind::Over(fold, of, parts) => {
                    let column = &named(&columns, of).values;
                    values.extend(parts.iter().map(|part| {
                        let each = probe.ids.iter().map(|id| match part {
                            Some(c) => column.at(*id as usize, *c),
                            None => column.size(*id as usize),
                        });
                        folded(*fold, &self.system.body, each)
                    }));
                }
                Kind::JIntegral(j_integral) => values.extend(self.integral(j_integral)),
                Kind::CrackTip(spec) => {
                    let damage = &named(&columns, "damage").values;
                    let points = { probe.ids.iter() }.map(|id| (*id, damage.at(*id as usize, 0)));
                    let system = &self.system;
                    let tip = crack::tip(&system.body, spec, system.info.horizon, points);
                    values.extend(&tip.place[..D]);
                    values.extend([tip.length, tip.branches]);
                }
                Kind::Opening(ends) => values.extend(crack::opening(&self.system, ends)),
                Kind::Fragments(points) => values.extend(crack::pieces(&self.system, *points)),
                Kind::Rigid(n, of) => values.extend(self.system.rigid_values(*n, of)),
            }
        }
        self.probes = probes;
        values
    }
}

impl<const D: usize> System<D> {
    /// Force of the constraints on each point that they hold: ids' slots and forces.
    fn reactions(&self, ids: &[u32]) -> Vec<(usize, [f64; D])> {
        let wanted: std::collections::HashMap<usize, usize> = ids
            .iter()
            .enumerate()
            .map(|(n, id)| (self.body.slots()[*id as usize] as usize, n))
            .collect();
        // a component that two constraints hold is held once
        let mut held: Vec<[Option<f64>; D]> = vec![[None; D]; ids.len()];
        let t = self.clock.time();
        for constraint in &self.prescribed.constraints {
            for (k, slot, a) in constraint.each() {
                let Some(n) = wanted.get(&slot) else { continue };
                let acceleration = match self.regime.equilibrium {
                    true => 0.0,
                    false => constraint.acceleration(a, k, t, self.clock.dt()),
                };
                held[*n][a] = Some(acceleration);
            }
        }
        let mut forces = vec![];
        for (id, held) in ids.iter().zip(held) {
            let s = self.body.slots()[*id as usize] as usize;
            let (rho, volume) = (self.body.density().at(s), self.body.volume().at(s));
            let of = |a: usize| {
                held[a].map_or(0.0, |acceleration| {
                    let taken = match &self.inertia {
                        Some(inertia) if !self.regime.equilibrium => inertia.taken[0][a][s],
                        _ => rho * acceleration,
                    };
                    volume * (taken - self.f[a][s])
                })
            };
            if held.iter().any(Option::is_some) {
                forces.push((s, crate::array::from_fn(of)));
            }
        }
        forces
    }

    fn reaction_of(&self, ids: &[u32]) -> Vec<f64> {
        let forces = self.reactions(ids);
        let along = |a: usize| forces.iter().map(|(_, force)| force[a]).collect();
        let sums: [Exact; D] = crate::array::from_fn(along);
        self.body.sums(sums).to_vec()
    }

    fn moment_of(&self, ids: &[u32], about: &Point) -> Vec<f64> {
        let reactions = self.reactions(ids);
        let turns = TURNS.iter().filter(|(_, axes)| axes.iter().all(|a| *a < D));
        let moment = |(_, [a, b]): &(&str, [usize; 2])| {
            let of = |(s, force): &(usize, [f64; D])| {
                let x = self.body.position(*s);
                // in a linear solution the body stays where it was
                let moved = |c: usize| match self.is_linear() {
                    true => 0.0,
                    false => self.u[c][*s],
                };
                let arm = |c: usize| x[c] + moved(c) - about[c];
                arm(*a) * force[*b] - arm(*b) * force[*a]
            };
            self.body.sum(reactions.iter().map(of))
        };
        turns.map(moment).collect()
    }
}

/// Square of the distance of a point from a place in the reference.
fn square<const D: usize>(body: &Body<D>, id: u32, at: &Point) -> f64 {
    let x = body.position(body.slots()[id as usize] as usize);
    (0..D).map(|a| (x[a] - at[a]).powi(2)).sum()
}

/// The least of these, of the points of all ranks.
fn least_square<const D: usize>(body: &Body<D>, ids: &[u32], at: &Point) -> f64 {
    let squares = ids.iter().map(|id| square(body, *id, at));
    body.least(squares.fold(f64::INFINITY, f64::min))
}

const ENERGIES: [&str; 3] = [
    "kinetic_energy_density",
    "strain_energy_density",
    "repulsion_energy_density",
];

fn named<'a>(columns: &'a [Column], name: &str) -> &'a Column {
    let found = columns.iter().find(|c| c.name() == name);
    found.expect("looked at when the probe was made")
}

/// Of the values of all ranks.
fn folded<const D: usize>(
    fold: Fold,
    body: &Body<D>,
    values: impl ExactSizeIterator<Item = f64>,
) -> f64 {
    let count = values.len() as u64;
    match fold {
        Fold::Mean => body.sum(values) / body.count(count) as f64,
        Fold::Sum => body.sum(values),
        Fold::Min => body.least(values.fold(f64::INFINITY, f64::min)),
        Fold::Max => body.most(values.fold(f64::NEG_INFINITY, f64::max)),
    }
}
