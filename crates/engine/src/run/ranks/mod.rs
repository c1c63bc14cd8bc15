//! A model whose body many ranks share: each moves its own points, and their numbers are the same bits as if one rank had all.
//!
//! The model of all is an [`AllRanks`] on the first rank, which [answers](AllRanks) as any model; the other ranks [follow](RankModel::follow) it.

mod all;
mod ask;
mod co_simulation;
mod here;
mod model;
mod plan;

pub use all::{AllRanks, Before, build, build_from};
pub use model::{RankModel, Share, WriteShare};
pub use plan::{Meanwhile, Shares, StepCost, plan};
