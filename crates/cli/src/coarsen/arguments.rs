//! What `peridyne coarsen` is asked for.

use crate::Input;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct CoarsenArguments {
    /// Deck of any law; what is coarsened is its linear body about the reference. Atoms, whose lattice pulls at surfaces and
    /// vacancies, are relaxed first, and displacements are counted from there.
    #[command(flatten)]
    pub input: Input,
    /// Retain every k-th point of the lattice along each axis; of a triangular or centred lattice the one with k times its spacing.
    #[arg(long, value_name = "K", conflicts_with_all = ["spacing", "keep"])]
    pub every: Option<u32>,
    /// Retain points no two of which are nearer than this (in units of the deck), evenly spread; for clouds.
    #[arg(long, value_name = "LENGTH", conflicts_with = "keep")]
    pub spacing: Option<f64>,
    /// Retain the points of this set of the deck.
    #[arg(long, value_name = "SET")]
    pub keep: Option<String>,
    /// So many times, each level from the one before.
    #[arg(long, default_value_t = 1)]
    pub levels: usize,
    /// Accepted error of the effective modulus, by which the radius of balls is chosen.
    #[arg(long, default_value_t = 0.01, conflicts_with = "radius")]
    pub tolerance: f64,
    /// Radius of the balls of the first level (in units of the deck); it grows with the spacing of points from level to level.
    #[arg(long, value_name = "LENGTH")]
    pub radius: Option<f64>,
    /// energy (shapes cut off by balls, symmetric), rows (as published), or schur (exact and full).
    #[arg(long, default_value = "energy")]
    pub scheme: String,
    /// Makes action reaction where rows do not (`K_ij ← ½ (K_ij + K_jiᵀ)`): yes or no. As published they are not symmetric; where they
    /// are made so, rotations of plates and blocks may meet forces.
    #[arg(long, default_value = "no", value_name = "YES|NO")]
    pub symmetrise: String,
    /// condensed: body forces and tractions on removed points go where the condensation leads them, none is lost. silling: a body force
    /// density acts on retained points alone, which keep their own volumes, so that it is the same force on them at every level.
    #[arg(long, default_value = "condensed", value_name = "CONVENTION")]
    pub loads: String,
    /// What moves with a retained point. blend: half lumped mass, half that of the shapes that the removed points have in equilibrium, or,
    /// in lattices, so much of it that long waves are right; waves of 25 coarse spacings are then a few tenths of a percent slow, of 10 some
    /// percent. lumped: 4 and 18 % slow. consistent: the shapes alone, up to 4 and 18 % fast, with the shorter stable step. Shorter waves than some ten coarse spacings have no remedy but more points:
    /// the removed points are taken to be in equilibrium at every moment, and in such waves they are not. Of statics it changes nothing.
    #[arg(long, default_value = "blend", value_name = "MASS")]
    pub mass: String,
    /// kept: points whose displacement or velocity is prescribed are retained besides the others, so that the body is held as it was.
    /// thinned: only those of them that are retained anyway.
    #[arg(long, default_value = "kept", value_name = "KEPT|THINNED")]
    pub supports: String,
    /// Nonlinear bodies, in so many equal increments of the load of a deck of [statics]: the linear body is taken about the state of each, is coarsened, and takes what is missing there at the load of the increment's end. Law, supports and loads are those of the deck; bonds may
    /// break, and laws may be history-dependent. Writes increments.csv, the displacements of all points after every increment (points.pvd), and the
    /// levels about the last state. Into `out/<name of the deck>-increments` if --out is not given.
    #[arg(long, value_name = "N")]
    pub increments: Option<usize>,
    /// With --increments: solutions after the first at most, until what is missing on retained points is `statics.tolerance` of loads and
    /// reactions. Without, an increment leaves what the next one takes up.
    #[arg(long, default_value_t = 0, value_name = "M", requires = "increments")]
    pub corrections: usize,
    /// With --increments, what removed points do. carried: they move with the shapes of each increment, of first order in it. relaxed: after
    /// every solution they come to rest between retained ones; with corrections the solution is that of Newton's method on all points.
    #[arg(
        long,
        default_value = "carried",
        value_name = "CARRIED|RELAXED",
        requires = "increments"
    )]
    pub removed: String,
    /// Largest force under a rigid rotation, relative to the stiffness, that is accepted.
    #[arg(long, default_value_t = 1e-3, value_name = "FRACTION")]
    pub rotation: f64,
    /// Atoms at a temperature: level 0 is not the Hessian about the sites, but what forces in the frames of a run of this deck say of the bonds, with the
    /// least-squares fit of forces to displacements from the mean places. Extended XYZ or a LAMMPS dump, of the deck's box; the deck's potential evaluates the forces. Bonds between atoms of the same surroundings
    /// are alike. Prints temperature, unexplained forces, and of perfect crystals the isothermal elastic constants with their errors; `thermal.json` has them.
    #[arg(long, value_name = "FRAMES")]
    pub average: Option<PathBuf>,
    /// Frames at the beginning that are skipped: a run that is not yet in equilibrium.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "average")]
    pub average_skip: usize,
    /// Longest bonds of the fit (in units of the deck), less than half of every period. If not given a quarter longer than those of the Hessian, as motion
    /// couples atoms that the potential does not, where the box holds them and the frames are enough. Elastic constants are found with bonds that are longer by another quarter, too.
    #[arg(long, value_name = "LENGTH", requires = "average")]
    pub average_radius: Option<f64>,
    /// lattice: where all atoms are alike, bonds are alike that a symmetry of the lattice maps on each other. none: they are not taken to be.
    #[arg(
        long,
        value_name = "SYMMETRY",
        default_value = "lattice",
        requires = "average"
    )]
    pub average_symmetry: String,
    /// Run the deck and all levels, and measure error and cost. A body that moves and is more than 5 % off is warned of.
    #[arg(long)]
    pub run: bool,
    /// Folder for the results; `out/<name of the deck>-coarsened` if not given.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}
