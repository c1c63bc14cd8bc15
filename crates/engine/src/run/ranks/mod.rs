//! A model whose body many ranks share: each moves its own points, and their numbers are the same bits as if one rank had all.
//!
//! The model of all is on the first rank, which [leads](Rank::lead) and answers as any model; the other ranks [follow](Rank::follow) it.

mod all;
mod ask;
mod co_simulation;
mod here;
mod model;
mod plan;
mod rank;

pub use all::{Before, build, build_from};
pub use model::{Share, WriteShare};
pub use plan::{Meanwhile, Shares, StepCost, plan};
pub use rank::{Rank, join};
