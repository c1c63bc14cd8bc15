//! A model of the engine as increments see it, and linear bodies.

use super::nonlinear::{Load, Nonlinear};
use peridyne::expression::Expression;
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::spec::{ConditionKind, LawSpec, LinearBody, Measure, Spec, Stepper, TimeStep};

/// A set whose displacement is prescribed.
#[derive(Debug, Clone)]
pub struct Support {
    pub set: String,
    /// Numbers of its points.
    pub points: Vec<u32>,
    /// By axis: is it held there?
    pub held: [bool; 3],
}

/// A body whose law, loads and supports are those of a specification. Nothing moves it but who asks.
pub struct Model<const D: usize> {
    sim: Box<dyn Simulation>,
    /// `[N]` where points are in the reference (length).
    sites: Vec<[f64; D]>,
    period: [Option<f64>; D],
    /// `[N]`
    volume: Vec<f64>,
    /// A linear body has this in place of its law.
    linear: Option<Linear<D>>,
    /// Prescribed displacements in the order of the specification.
    prescribed: Vec<(Vec<u32>, [Option<Expression>; 3])>,
    supports: Vec<Support>,
    /// `[N]`: do loads act there? `None`: everywhere.
    loaded: Option<Vec<bool>>,
}

/// What of a specification is built for a [`Model`]: the body with its loads. Supports are prescribed by increments, nothing moves by
/// itself, and reactions are those of the coarse equations.
pub fn alone(spec: &Spec) -> Spec {
    let mut spec = spec.clone();
    for initial in &mut spec.loading.initial {
        initial.velocity = [None, None, None];
    }
    spec.loading.thermal = None;
    spec.loading.conditions.retain(|c| match c.kind {
        ConditionKind::BodyForce(_) | ConditionKind::Traction { .. } => true,
        ConditionKind::Displacement(_)
        | ConditionKind::Velocity(_)
        | ConditionKind::SetForce(_)
        | ConditionKind::Damping(_)
        | ConditionKind::Force(_) => false,
    });
    spec.run.probes.retain(|p| match p.measure {
        Measure::Energy
        | Measure::Over { .. }
        | Measure::Value { .. }
        | Measure::Opening { .. } => true,
        Measure::Reaction
        | Measure::Moment { .. }
        | Measure::RigidBody { .. }
        | Measure::JIntegral(_)
        | Measure::CrackTip(_)
        | Measure::Fragments { .. } => false,
    });
    spec.run.schedule.stepper = Stepper::Verlet;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec
}

fn padded<const D: usize>(u: &[[f64; D]]) -> Vec<Point> {
    let point = |u: &[f64; D]| std::array::from_fn(|a| if a < D { u[a] } else { 0.0 });
    u.iter().map(point).collect()
}

fn cut<const D: usize>(u: &[Point]) -> Vec<[f64; D]> {
    u.iter().map(|u| std::array::from_fn(|a| u[a])).collect()
}

/// The linear body about the displacements of now.
fn about<const D: usize>(sim: &mut dyn Simulation) -> LinearBody<D> {
    let body = sim.linear_body().of();
    LinearBody {
        load_map: None,
        ..body.unwrap_or_else(LinearBody::nothing)
    }
}

impl<const D: usize> Model<D> {
    /// `sim` is made of what [`alone`] leaves of the specification, trusting its time step. `linear`: the body is the linear one about
    /// the reference, whatever its law. `None`: a condition names a set that is not there, or the dimension is another.
    pub fn new(spec: &Spec, mut sim: Box<dyn Simulation>, linear: bool) -> Option<Self> {
        if spec.space.dimension != D {
            return None;
        }
        let begin = sim.displacements();
        let rest = vec![[0.0; D]; begin.len()];
        sim.set_displacements(&padded(&rest));
        let body = about(sim.as_mut());
        sim.set_displacements(&begin);
        let (mut prescribed, mut supports) = (vec![], Vec::<Support>::new());
        for c in &spec.loading.conditions {
            let ConditionKind::Displacement(all) = &c.kind else {
                continue;
            };
            let points = sim.members(&c.set)?;
            let held: [bool; 3] = std::array::from_fn(|a| a < D && all[a].is_some());
            match supports.iter_mut().find(|s| s.set == c.set) {
                Some(known) => (0..3).for_each(|a| known.held[a] |= held[a]),
                None => supports.push(Support {
                    set: c.set.clone(),
                    points: points.clone(),
                    held,
                }),
            }
            prescribed.push((points, all.clone()));
        }
        let mut laws = spec.materials.iter().map(|m| &m.law);
        let linear =
            linear || laws.all(|law| matches!(law, LawSpec::Micromoduli(_) | LawSpec::Springs(_)));
        let mut model = Model {
            sites: cut(&sim.vectors("reference")),
            period: body.period,
            volume: body.volume.clone(),
            linear: None,
            prescribed,
            supports,
            loaded: None,
            sim,
        };
        if linear {
            model.linear = Some(Linear {
                forces: model.forces(&rest),
                about: rest,
                body,
            });
        }
        Some(model)
    }

    /// `[N]` where points are in the reference (length).
    pub fn sites(&self) -> &[[f64; D]] {
        &self.sites
    }

    pub fn period(&self) -> [Option<f64>; D] {
        self.period
    }

    pub fn supports(&self) -> &[Support] {
        &self.supports
    }

    /// Is it linear, by its law or by how it is solved?
    pub fn is_linear(&self) -> bool {
        self.linear.is_some()
    }

    /// Loads act on these points alone, as in the paper.
    pub fn load_only(&mut self, points: &[u32]) {
        let mut loaded = vec![false; self.sites.len()];
        points.iter().for_each(|q| loaded[*q as usize] = true);
        self.loaded = Some(loaded);
    }

    /// Displacements that increments begin with. Points know what they bear once they were asked.
    pub fn begin(&mut self) -> Vec<[f64; D]> {
        let u = cut(&self.sim.displacements());
        self.arrive(&u);
        u
    }

    /// What acts at t.
    pub fn load(&mut self, t: f64) -> Load<D> {
        let n = self.sites.len();
        self.sim.set_time(0, t);
        // without bonds the forces are those of loads
        self.sim.start(false);
        let mut force = vec![[0.0; D]; n];
        let mut density = vec![0.0; n];
        for a in 0..D {
            self.sim.read("force_density", a, 0, &mut density);
            for (i, f) in force.iter_mut().enumerate() {
                let acts = self.loaded.as_ref().is_none_or(|l| l[i]);
                f[a] = if acts {
                    density[i] * self.volume[i]
                } else {
                    0.0
                };
            }
        }
        let mut held = vec![[None; D]; n];
        let reference = padded(&self.sites);
        for (points, all) in &self.prescribed {
            for i in points.iter().map(|i| *i as usize) {
                for a in 0..D {
                    if let Some(expression) = &all[a] {
                        held[i][a] = Some(expression.eval(&reference[i], t));
                    }
                }
            }
        }
        Load { force, held }
    }

    /// Strain energy of where the body arrived (energy).
    pub fn energy(&mut self) -> f64 {
        if let Some(linear) = &self.linear {
            return linear.energy(&cut(&self.sim.displacements()));
        }
        let seen = self.sim.observed();
        let mut energy = 0.0;
        for (i, v) in self.volume.iter().enumerate() {
            energy += v * (seen.strain[i] + seen.repulsion.get(i).copied().unwrap_or(0.0));
        }
        energy
    }

    /// Where it arrived, for who wants to measure there.
    pub fn simulation(&mut self) -> &mut dyn Simulation {
        self.sim.as_mut()
    }

    /// Forces that supports exert on the body, summed over each of [`Model::supports`] (force): of the coarse equations, from the reactions of retained points.
    pub fn reactions(&self, retained: &[u32], reaction: &[[f64; D]]) -> Vec<[f64; 3]> {
        let mut all = vec![[0.0; D]; self.sites.len()];
        for (q, r) in retained.iter().zip(reaction) {
            all[*q as usize] = *r;
        }
        self.summed(&all)
    }

    /// The same of another run of the specification, from its displacements at t.
    pub fn reactions_of(&mut self, run: &mut dyn Simulation, t: f64) -> Vec<[f64; 3]> {
        let u = run.displacements();
        let mut missing = match &self.linear {
            Some(linear) => linear.forces_at(&cut(&u)),
            None => self.per_point(&run.forces_under(&u)),
        };
        let load = self.load(t);
        for ((r, f), held) in missing.iter_mut().zip(&load.force).zip(&load.held) {
            for a in 0..D {
                r[a] = if held[a].is_some() { -r[a] - f[a] } else { 0.0 };
            }
        }
        self.summed(&missing)
    }

    fn summed(&self, all: &[[f64; D]]) -> Vec<[f64; 3]> {
        let sum = |s: &Support| {
            let mut sum = [0.0; 3];
            for i in &s.points {
                for a in (0..D).filter(|a| s.held[*a]) {
                    sum[a] += all[*i as usize][a];
                }
            }
            sum
        };
        self.supports.iter().map(sum).collect()
    }

    fn per_point(&self, density: &[Point]) -> Vec<[f64; D]> {
        let both = density.iter().zip(&self.volume);
        both.map(|(f, v)| std::array::from_fn(|a| f[a] * v))
            .collect()
    }
}

impl<const D: usize> Nonlinear<D> for Model<D> {
    fn forces(&mut self, u: &[[f64; D]]) -> Vec<[f64; D]> {
        match &self.linear {
            Some(linear) => linear.forces_at(u),
            None => {
                let density = self.sim.forces_under(&padded(u));
                self.per_point(&density)
            }
        }
    }

    fn tangent(&mut self, u: &[[f64; D]]) -> LinearBody<D> {
        if let Some(linear) = &self.linear {
            return linear.body.clone();
        }
        self.sim.set_displacements(&padded(u));
        let mut body = about(self.sim.as_mut());
        for ((x, site), u) in body.position.iter_mut().zip(&self.sites).zip(u) {
            *x = std::array::from_fn(|a| site[a] + u[a]);
        }
        body
    }

    fn arrive(&mut self, u: &[[f64; D]]) -> u64 {
        let before = self.sim.broken();
        self.sim.set_displacements(&padded(u));
        self.sim.start(true);
        let broken = self.sim.broken() - before;
        if broken > 0
            && let Some(linear) = self.linear.take()
        {
            let rest = linear.about;
            self.sim.set_displacements(&padded(&rest));
            let body = about(self.sim.as_mut());
            self.linear = Some(Linear {
                forces: self.forces(&rest),
                about: rest,
                body,
            });
            self.sim.set_displacements(&padded(u));
        }
        broken
    }
}

/// A body that is linear about a state.
pub struct Linear<const D: usize> {
    pub body: LinearBody<D>,
    /// `[N]` displacements of that state (length), and forces there (force).
    pub about: Vec<[f64; D]>,
    pub forces: Vec<[f64; D]>,
}

impl<const D: usize> Linear<D> {
    /// About a state of a nonlinear body.
    pub fn of(body: &mut dyn Nonlinear<D>, u: &[[f64; D]]) -> Self {
        Linear {
            forces: body.forces(u),
            about: u.to_vec(),
            body: body.tangent(u),
        }
    }

    fn forces_at(&self, u: &[[f64; D]]) -> Vec<[f64; D]> {
        let moved: Vec<[f64; D]> = (u.iter().zip(&self.about))
            .map(|(u, v)| std::array::from_fn(|a| u[a] - v[a]))
            .collect();
        (self.forces.iter().enumerate())
            .map(|(i, rest)| {
                let f = self.body.force(&moved, i);
                std::array::from_fn(|a| rest[a] + self.body.volume[i] * f[a])
            })
            .collect()
    }

    /// Less that of the state it is about.
    fn energy(&self, u: &[[f64; D]]) -> f64 {
        let mut energy = 0.0;
        let forces = self.forces_at(u).into_iter().zip(&self.forces);
        for ((f, rest), (u, v)) in forces.zip(u.iter().zip(&self.about)) {
            for a in 0..D {
                energy -= 0.5 * (f[a] + rest[a]) * (u[a] - v[a]);
            }
        }
        energy
    }
}

impl<const D: usize> Nonlinear<D> for Linear<D> {
    fn forces(&mut self, u: &[[f64; D]]) -> Vec<[f64; D]> {
        self.forces_at(u)
    }

    fn tangent(&mut self, _: &[[f64; D]]) -> LinearBody<D> {
        self.body.clone()
    }

    fn arrive(&mut self, _: &[[f64; D]]) -> u64 {
        0
    }
}
