//! Continuum fields of a running model: its points as particles, its forces pair by pair.

use super::plan::{FieldsSpec, Place};
use super::potential::beyond;
use peridyne::error::BuildError;
use peridyne::law::terms::Sites;
use peridyne::observe::Values;
use peridyne::run::{Registry, Simulation};
use peridyne::spec::{FamilyChoice, Spec};
use peridyne_fields::effort::{Effort, bonds_within};
use peridyne_fields::fields::NO_TEMPERATURE;
use peridyne_fields::molecules::Molecules;
use peridyne_fields::neighbours::Families;
use peridyne_fields::pairs::{self, Pull};
use peridyne_fields::residuals::{self, Residuals};
use peridyne_fields::{Cell, Fields, FieldsError, Frame, Kernel, Method, Quantity, Targets};
use std::sync::Arc;

/// What forces are made of.
enum Forces {
    /// Atoms, and what they keep: bonds of molecules, families of the reference.
    Sites {
        sites: Box<dyn Sites>,
        molecules: Option<Arc<Molecules>>,
        families: Option<Arc<Families>>,
    },
    /// Bonds of a body.
    Bonds,
}

/// What of a model makes fields.
pub struct Live {
    forces: Forces,
    /// Do points have a temperature?
    atoms: bool,
    boltzmann: f64,
    dimension: usize,
    section: f64,
    spacing: f64,
    corner: [f64; 3],
    periodic: [Option<f64>; 3],
    resting: bool,
    /// Do bonds break, or are some cut?
    breaks: bool,
    /// Of the body at the start, with half a spacing around it.
    bounds: [[f64; 3]; 2],
}

fn words(error: impl ToString) -> FieldsError {
    FieldsError(error.to_string())
}

impl Live {
    /// Of a model and its specification; `corner` is the lower one of its periods.
    ///
    /// # Errors
    /// A potential that makes no sense.
    pub fn new(
        sim: &mut dyn Simulation,
        spec: &Spec,
        corner: [f64; 3],
    ) -> Result<Live, FieldsError> {
        let atoms = spec.potential().is_some() && spec.bonds.smooth.is_none();
        let by_sites = match spec.bonds.family {
            FamilyChoice::Auto | FamilyChoice::Neighbours | FamilyChoice::Reference => atoms,
            FamilyChoice::Stencil | FamilyChoice::List => false,
        };
        let forces = match by_sites {
            false => Forces::Bonds,
            true => {
                let sites = Registry::standard()
                    .sites_of(spec)
                    .map_err(|e: BuildError| words(e))?;
                let count = sim.info().points as usize;
                let bonded = spec.interactions.bonded.as_deref().cloned();
                let molecules = bonded.map(|b| Molecules::new(b, count)).transpose()?;
                Forces::Sites {
                    sites,
                    molecules: molecules.map(Arc::new),
                    families: None,
                }
            }
        };
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let half = 0.5 * sim.info().spacing;
        for x in sim.vectors("position") {
            for a in 0..3 {
                bounds[0][a] = bounds[0][a].min(x[a] - half);
                bounds[1][a] = bounds[1][a].max(x[a] + half);
            }
        }
        let mut live = Live {
            forces,
            atoms,
            boltzmann: spec.loading.boltzmann,
            dimension: spec.space.dimension,
            section: spec.space.section,
            spacing: sim.info().spacing,
            corner,
            periodic: spec.space.periodic,
            resting: spec.run.schedule.statics().is_some(),
            breaks: !spec.damage.precracks.is_empty()
                || spec.materials.iter().any(|m| m.fracture.is_some()),
            bounds,
        };
        if spec.bonds.family == FamilyChoice::Reference && atoms {
            let mut reference = live.frame(sim, &live.cell(&Place::Points(vec![]))?);
            reference.position = sim.vectors("reference");
            // a whole number of spacings is meant inclusively
            let horizon = sim.info().horizon * (1.0 + 1e-9);
            let made = Families::new(&reference, horizon)?;
            if let Forces::Sites { families, .. } = &mut live.forces {
                *families = Some(Arc::new(made));
            }
        }
        Ok(live)
    }

    /// Are its steps increments of load?
    pub fn is_static(&self) -> bool {
        self.resting
    }

    /// Name of what pulls, for descriptions.
    pub fn source(&self) -> &'static str {
        match self.forces {
            Forces::Sites { families: None, .. } => "potential of the model, current neighbours",
            Forces::Sites { .. } => "potential of the model, families of the reference",
            Forces::Bonds => "bonds of the model",
        }
    }

    /// The box that a grid divides: periods, else the corners that are asked for, else the body at the start. Along axes beyond the dimension
    /// it has the extent of the section.
    ///
    /// # Errors
    /// A box without volume.
    pub fn cell(&self, place: &Place) -> Result<Cell, FieldsError> {
        let asked = match place {
            Place::Grid { corners, .. } => *corners,
            Place::Points(_) => None,
        };
        let [mut low, mut high] = asked.unwrap_or(self.bounds);
        let beyond = beyond(self.dimension, self.section);
        for a in 0..3 {
            if a >= self.dimension {
                (low[a], high[a]) = (-0.5 * beyond, 0.5 * beyond);
            } else if let Some(period) = self.periodic[a] {
                let whole = [self.corner[a], self.corner[a] + period];
                let off = |x: f64, y: f64| (x - y).abs() > 1e-6 * period;
                if asked.is_some() && (off(low[a], whole[0]) || off(high[a], whole[1])) {
                    return Err(FieldsError(format!(
                        "corners: {} is periodic, and a grid divides the whole period, from {} to {}: give these, or leave corners out, or ask for points or a plane",
                        ["x", "y", "z"][a],
                        whole[0],
                        whole[1]
                    )));
                }
                [low[a], high[a]] = whole;
            } else if !(high[a] > low[a]) {
                high[a] = low[a] + self.spacing.max(f64::MIN_POSITIVE);
            }
        }
        Cell::orthogonal(low, high, self.periodic.map(|p| p.is_some()))
    }

    /// Points, and the way that they are made.
    ///
    /// # Errors
    /// A localization function that makes no sense.
    pub fn method(
        &self,
        asked: &FieldsSpec,
        cell: &Cell,
    ) -> Result<(Targets, Method), FieldsError> {
        let extents = cell.extents(asked.averaged)?;
        let made = Method {
            boltzmann: self.boltzmann,
            coordinate: asked.coordinate,
            ..Method::new(Kernel::averaged(asked.shape, asked.width, extents)?)
        };
        let method = match (&asked.choice, &self.forces) {
            (
                Some(choice),
                Forces::Sites {
                    molecules,
                    families,
                    ..
                },
            ) => Method {
                partition: choice.partition.clone(),
                pair_force: choice.pair_force,
                by_part: choice.parts,
                molecules: molecules.clone(),
                families: families.clone(),
                ..made
            },
            (Some(_), Forces::Bonds) | (None, _) => pairs::method(made),
        };
        let targets = match &asked.place {
            Place::Grid { counts, .. } => Targets::Grid(*counts),
            Place::Points(points) => Targets::Points(points.clone()),
        };
        Ok((targets, method))
    }

    /// What a frame will take.
    pub fn effort(
        &self,
        sim: &mut dyn Simulation,
        cell: &Cell,
        targets: &Targets,
        method: &Method,
    ) -> Effort {
        let frame = self.frame(sim, cell);
        let (bonds, reach) = match &self.forces {
            Forces::Sites { sites, .. } => (bonds_within(&frame, sites.reach()), sites.reach()),
            Forces::Bonds => (0.5 * sim.info().directed_bonds as f64, 0.0),
        };
        Effort::of(&frame, bonds, reach, targets, method)
    }

    /// The points of now.
    pub fn frame(&self, sim: &mut dyn Simulation, cell: &Cell) -> Frame {
        let position = sim.vectors("position");
        let (density, volume) = (sim.scalars("density"), sim.scalars("volume"));
        let kind = match sim.column("material").map(|c| c.values) {
            Some(Values::Counts(of)) => of,
            _ => vec![0; position.len()],
        };
        Frame {
            cell: cell.clone(),
            velocity: Some(sim.velocities()),
            mass: density.iter().zip(&volume).map(|(d, v)| d * v).collect(),
            position,
            kind,
            time: Some(sim.clock()),
        }
    }

    /// Fields of now.
    ///
    /// # Errors
    /// As [`peridyne_fields::evaluate`]; a law without forces of single bonds.
    pub fn fields(
        &self,
        sim: &mut dyn Simulation,
        frame: &Frame,
        targets: &Targets,
        method: &Method,
    ) -> Result<Fields, FieldsError> {
        let mut fields = match &self.forces {
            Forces::Sites {
                sites,
                families: Some(families),
                ..
            } if self.breaks => {
                let bonds = sim.snapshot(&[], true).bonds.unwrap_or_default();
                let method = Method {
                    families: Some(Arc::new(families.of_whole(&bonds))),
                    ..method.clone()
                };
                peridyne_fields::evaluate(frame, sites.as_ref(), targets, &method)?
            }
            Forces::Sites { sites, .. } => {
                peridyne_fields::evaluate(frame, sites.as_ref(), targets, method)?
            }
            Forces::Bonds => of_bonds(sim, frame, targets, method)?,
        };
        if !self.atoms {
            fields.leave_out(&[Quantity::Temperature], NO_TEMPERATURE);
        }
        Ok(fields)
    }

    /// How well the balance laws hold at points.
    ///
    /// # Errors
    /// As [`residuals::of_frame`].
    pub fn residuals(
        &self,
        sim: &mut dyn Simulation,
        frame: &Frame,
        method: &Method,
        points: &[[f64; 3]],
        step: f64,
    ) -> Result<Residuals, FieldsError> {
        residuals::of_fields(frame, method, points, step, &mut |targets, method| {
            self.fields(sim, frame, targets, method)
        })
    }
}

/// Of a body whose points say themselves what they do to each other: `m = ρ V`, `U = W V`, forces on points.
fn of_bonds(
    sim: &mut dyn Simulation,
    frame: &Frame,
    targets: &Targets,
    method: &Method,
) -> Result<Fields, FieldsError> {
    let volume = sim.scalars("volume");
    let seen = sim.observed();
    let densities = seen.strain.iter().zip(&seen.repulsion);
    let energy: Vec<f64> = densities
        .zip(&volume)
        .map(|((s, r), v)| (s + r) * v)
        .collect();
    let mut known = true;
    let mut pulls = |visit: &mut dyn FnMut(Pull)| {
        known = sim.each_force(&mut |bond| {
            let of = |density: [f64; 3]| density.map(|f| f * volume[bond.id]);
            visit(Pull {
                i: bond.id as u32,
                k: bond.partner as u32,
                y: bond.y,
                force: of(bond.force),
                own: bond.own.map(of),
            });
        });
    };
    let fields = pairs::evaluate(frame, &energy, &mut pulls, targets, method)?;
    match known {
        true => Ok(fields),
        false => Err(FieldsError(
            "the law has no forces of single bonds, of which stress is made".into(),
        )),
    }
}
