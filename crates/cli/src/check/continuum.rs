//! What continuum fields a deck will make.

use crate::failure::Failure;
use peridyne::run::Simulation;
use peridyne_fields::Quantity;
use peridyne_io::continuum::plan::FieldsSpec;
use peridyne_io::continuum::run::{FieldsPlan, efforts, foresee};

/// Points above which no frame is made to see what it is and takes.
const PATIENCE: u64 = 200_000;
/// The same of seconds that it would take.
const LONG: f64 = 20.0;

/// The fields of a table `[[fields]]`.
#[derive(Clone)]
pub(super) struct Found {
    pub asked: FieldsSpec,
    pub frames: u64,
    /// At most (bytes).
    pub bytes: f64,
    /// `None`: there was no patience for a frame.
    pub seen: Option<Seen>,
}

/// What a frame of the start showed.
#[derive(Clone)]
pub(super) enum Seen {
    Made {
        /// Distance of the points of a grid along its axes (length).
        grid: Vec<f64>,
        made: Vec<Quantity>,
        missing: Vec<(Quantity, &'static str)>,
        /// For a frame.
        seconds: f64,
    },
    /// Why there are none.
    Nothing(String),
}

pub(super) fn find(
    sim: &mut dyn Simulation,
    plan: &FieldsPlan,
    steps: u64,
    file: &str,
) -> Result<Vec<Found>, Failure> {
    let most = plan.asked.iter().map(|a| a.place.points()).max();
    let efforts =
        efforts(sim, plan).map_err(|e| Failure::input(format!("{file}: [[fields]] {e}")))?;
    let seconds = efforts.iter().fold(0.0, |s: f64, e| s + e.seconds);
    let few = sim.info().points.max(most.unwrap_or(0)) <= PATIENCE;
    let patient = few && seconds <= LONG;
    let mut seen = match patient {
        true => {
            foresee(sim, plan).map_err(|e| Failure::input(format!("{file}: [[fields]] {e}")))?
        }
        false => vec![],
    }
    .into_iter();
    let found = plan.asked.iter().map(|asked| Found {
        frames: asked.frames(steps),
        bytes: asked.bytes(steps),
        seen: seen.next().map(|one| match one {
            Ok(f) => Seen::Made {
                grid: f.grid,
                made: f.made,
                missing: f.missing,
                seconds: f.seconds,
            },
            Err(why) => Seen::Nothing(why.to_string()),
        }),
        asked: asked.clone(),
    });
    Ok(found.collect())
}
