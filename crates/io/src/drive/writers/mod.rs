//! What writes of a run while it goes on: one file each, and a line in [`all`].

mod exodus;
mod fields;
mod last;
mod modes;
mod paths;
mod rows;
mod series;
mod space_time;
mod trajectories;
mod vtkhdf;
mod writer;

use super::plan::Plan;
use crate::write::history::Column;
use std::path::PathBuf;
pub(super) use writer::{Due, Known, Made, Now, Writer};

/// All of a plan, in the order in which they look.
pub(super) fn all(columns: &[Column]) -> Vec<Box<dyn Writer>> {
    vec![
        Box::new(rows::Rows::new(columns)),
        Box::new(trajectories::Trajectories::default()),
        Box::new(fields::LiveFields::default()),
        Box::new(series::Frames::default()),
        Box::new(exodus::ExodusFrames::new(columns)),
        Box::new(vtkhdf::VtkHdfFrames::default()),
        Box::new(space_time::SpaceTimes::default()),
        Box::new(modes::Modes),
        Box::new(paths::Paths::default()),
        Box::new(last::LastState),
    ]
}

/// A file in the folder of the results.
fn inside(plan: &Plan, name: &str) -> PathBuf {
    plan.dir.join(name)
}
