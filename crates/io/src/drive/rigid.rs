//! Rigid bodies of a run: where they are in a frame, and their paths for the report.

use crate::write::picture::rigid::{Form, Placed};
use peridyne::boundary_condition::rigid::Rigid;
use peridyne::run::Simulation;
use peridyne::space::length;
use peridyne::space::rotation::Quaternion;
use peridyne::spec::{Measure, ProbeSpec, RigidBodyMotion, RigidBodySpec, RigidQuantity, Spec};
use std::borrow::Cow;

/// Those of statics before motion, and those of the run.
#[derive(Debug, Clone, Default)]
pub struct RigidBodies {
    statics: Vec<Tracked>,
    motion: Vec<Tracked>,
    dimension: usize,
    /// Probes that are of pictures alone, the last of the model.
    probes: usize,
}

#[derive(Debug, Clone)]
struct Tracked {
    spec: RigidBodySpec,
    form: Form,
    /// Which of these probes has its rotation.
    probe: Option<usize>,
}

impl RigidBodies {
    /// Of a spec; and the spec with probes of how free bodies are turned, for whoever builds the model.
    pub fn watched(spec: &Spec) -> (RigidBodies, Cow<'_, Spec>) {
        let mut bodies = RigidBodies {
            dimension: spec.space.dimension,
            ..RigidBodies::default()
        };
        let form = |i: &RigidBodySpec| Form::of(&i.shape, spec.space.dimension);
        let tracked = |i: &RigidBodySpec| Tracked {
            spec: i.clone(),
            form: form(i),
            probe: None,
        };
        let before = spec.run.preload.iter().flat_map(|p| &p.rigid_bodies);
        bodies.statics = before.map(tracked).collect();
        bodies.motion = spec.loading.rigid_bodies.iter().map(tracked).collect();
        let mut whole = Cow::Borrowed(spec);
        for (n, body) in bodies.motion.iter_mut().enumerate() {
            let free = matches!(body.spec.motion, RigidBodyMotion::Free(_));
            // nobody sees a ball turn
            if !free || !matches!(body.form, Form::Surface(_)) || spec.space.dimension < 2 {
                continue;
            }
            let whole = whole.to_mut();
            if whole.loading.rigid_bodies[n].name.is_empty() {
                whole.loading.rigid_bodies[n].name = format!("rigid body {}", n + 1);
            }
            whole.run.probes.push(ProbeSpec {
                name: format!("rotation of rigid body {}", n + 1),
                set: "all".into(),
                measure: Measure::RigidBody {
                    rigid_body: whole.loading.rigid_bodies[n].name.clone(),
                    of: Some(RigidQuantity::Turn),
                },
            });
            body.probe = Some(bodies.probes);
            bodies.probes += 1;
        }
        (bodies, whole)
    }

    /// Columns that are of pictures alone, the last that the model measures.
    pub fn columns(&self) -> usize {
        self.probes * self.parts()
    }

    /// Numbers of a rotation: about three axes, in a plane about one.
    fn parts(&self) -> usize {
        if self.dimension == 3 { 3 } else { 1 }
    }

    /// Where they are now; has the motion begun that follows statics?
    pub(super) fn placed(&self, sim: &mut dyn Simulation, begun: bool) -> Vec<Placed> {
        let all = if begun { &self.motion } else { &self.statics };
        if all.is_empty() {
            return vec![];
        }
        let (time, parts) = (sim.time(), self.parts());
        let measured = match begun && self.probes > 0 {
            true => sim.measure(),
            false => vec![],
        };
        let own = &measured[measured.len().saturating_sub(self.columns())..];
        let centers = sim.rigid_bodies();
        let each = all.iter().zip(centers);
        each.map(|(body, center)| {
            let mut rigid = Rigid::<3>::new(&body.spec);
            rigid.place(time);
            let turn = body.probe.and_then(|n| own.get(n * parts..(n + 1) * parts));
            let axes = match turn {
                Some([x, y, z]) => turned([*x, *y, *z]),
                Some([z]) => turned([0.0, 0.0, *z]),
                _ => rigid.axes,
            };
            Placed {
                form: body.form.clone(),
                center,
                axes,
            }
        })
        .collect()
    }
}

/// Axes of a rotation vector.
fn turned(vector: [f64; 3]) -> [[f64; 3]; 3] {
    let angle = length(&vector);
    match angle > 0.0 {
        true => Quaternion::about(&vector.map(|c| c / angle), angle).axes(),
        false => Quaternion::ONE.axes(),
    }
}
