//! What looks wrong with atoms: cut-off, stability, time step, temperature.

use super::Findings;
use peridyne::spec::BodySpec;
use peridyne_io::deck::Dim;
use peridyne_theory::voigt::{Stiffness, components};

/// Above this part of the stability limit steps are coarse: 15 in the shortest period.
const COARSE: f64 = 0.2;
/// Below this part of what would be chosen steps are wasted.
const WASTED: f64 = 0.05;

pub fn advice(found: &Findings, say: &mut dyn FnMut(String, &str)) {
    let (spec, info) = (found.spec, &found.info);
    let d = info.dimension;
    let few = [2.0, 6.0, 12.0][d - 1];
    if info.family.1 < 0.5 * few {
        say(
            format!(
                "atoms have {:.1} neighbours in the mean within the cut-off {}: a dense crystal has {few} nearest ones",
                info.family.1,
                found.units.write(info.horizon, Dim::LENGTH)
            ),
            "a longer cut-off, or a smaller spacing: 2.5 σ is usual for Lennard-Jones",
        );
    }
    let fraction = info.time_step / info.stable_step;
    if fraction > COARSE {
        say(
            format!(
                "the time step is {:.0} % of the stability limit: {:.1} steps in the shortest period, so that energy wobbles \
                 and hard collisions are missed",
                100.0 * fraction,
                std::f64::consts::PI / fraction
            ),
            "leave run.time_step out (31 steps in the shortest period, more where atoms are fast)",
        );
    }
    if fraction < WASTED * 0.1 {
        say(
            format!(
                "the time step is {:.2} % of the stability limit: {:.0} steps in the shortest period",
                100.0 * fraction,
                std::f64::consts::PI / fraction
            ),
            "a longer step, unless atoms are very fast; about 30 steps in the shortest period are usual",
        );
    }
    let resting = match &spec.body {
        BodySpec::Cloud(cloud) => cloud.velocity.is_empty(),
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Several(_) => true,
    };
    if resting && spec.loading.thermal.is_none() && spec.loading.initial.is_empty() {
        say(
            "the atoms start at rest, at 0 K".into(),
            "write initial_velocities = { temperature = \"300 K\", seed = 1 }; a crystal shares it out: half of it stays as kinetic energy",
        );
    }
    let Some(patch) = &found.patch else { return };
    for class in &patch.classes {
        let Some(Stiffness { c, .. }) = &class.stiffness else {
            continue;
        };
        if let Some(v) = (0..components(d)).find(|v| c[*v][*v] < 0.0) {
            say(
                format!(
                    "C{0}{0} of the atoms ({1}) is negative: the state is unstable and will not stay",
                    v + 1,
                    class.place.name(d)
                ),
                "a spacing nearer to that without pressure: `peridyne upscale --potential … --lattice …` finds it",
            );
            break;
        }
    }
}
