//! Was this process started by a launcher, with how many others? Launchers say so in the environment, before any MPI is there.

use std::fmt;

/// Says which MPI to take, and no other is tried; or that each process is alone, whatever launched it.
pub(crate) const ASKED: &str = "PERIDYNE_MPI";
pub(crate) const OFF: &str = "off";

/// What a launcher says of this process.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Launched {
    /// The variable that says so.
    pub by: &'static str,
    pub rank: usize,
    pub ranks: usize,
}

impl fmt::Display for Launched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "this is one of {} processes ({})", self.ranks, self.by)
    }
}

/// Names of the number of processes and of this one's: Hydra (MPICH, Intel MPI), Open MPI, Slurm's steps (a batch script that is no step has no
/// such size and is one process), PALS of Cray (whose size comes with its PMI).
const LAUNCHERS: [(&str, &str); 3] = [
    ("PMI_SIZE", "PMI_RANK"),
    ("OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"),
    ("SLURM_STEP_NUM_TASKS", "SLURM_PROCID"),
];

/// The launcher of this process.
pub fn launched() -> Option<Launched> {
    of(&|name| std::env::var(name).ok())
}

/// The same of an environment.
fn of(environment: &dyn Fn(&str) -> Option<String>) -> Option<Launched> {
    let number = |name| environment(name)?.trim().parse::<usize>().ok();
    LAUNCHERS.iter().find_map(|&(size, rank)| {
        let (ranks, rank) = (number(size)?, number(rank)?);
        (rank < ranks).then_some(Launched {
            by: size,
            rank,
            ranks,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn environment<'a>(of: &'a [(&str, &str)]) -> impl Fn(&str) -> Option<String> + 'a {
        move |name| {
            let found = of.iter().find(|(n, _)| *n == name)?;
            Some(found.1.to_string())
        }
    }

    #[test]
    fn launchers_are_known_by_size_and_rank() {
        let hydra = [("PMI_SIZE", "4"), ("PMI_RANK", "3")];
        let found = of(&environment(&hydra)).unwrap();
        assert_eq!((found.by, found.rank, found.ranks), ("PMI_SIZE", 3, 4));
        let said = found.to_string();
        assert_eq!(said, "this is one of 4 processes (PMI_SIZE)");
        let open = [("OMPI_COMM_WORLD_SIZE", "2"), ("OMPI_COMM_WORLD_RANK", "0")];
        assert_eq!(of(&environment(&open)).unwrap().ranks, 2);
        // a batch script is no step
        let batch = [("SLURM_NTASKS", "64"), ("SLURM_PROCID", "0")];
        assert_eq!(of(&environment(&batch)), None);
        let nonsense = [("PMI_SIZE", "4"), ("PMI_RANK", "4")];
        assert_eq!(of(&environment(&nonsense)), None);
    }
}
