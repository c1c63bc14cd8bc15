//! Continuum fields of the running model.

use super::{AxisName, Film, KernelName, PairForceName, PartitionName};
use crate::deck::quantity::{Length, Positive};
use crate::deck::value::{At, Or, Quantity, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// Nodes that carry atoms along: `u(X_j) = Σ_g w_g(X_j) u_g`, w_g of φ about each atom, so that quadratic displacements are exact.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Smooth {
    /// Localization function φ.
    pub kernel: At<KernelName>,
    /// S of it: two to three spacings of nodes or more.
    pub width: Quantity<Positive<Length>>,
    /// Of polynomials, 0 to 7: one derivative less is continuous; 3 by default.
    pub smoothness: Option<At<u32>>,
    /// Of the nodes, on a square or cubic lattice; along periodic axes a whole part of the period. By default nodes are at the places of the
    /// atoms.
    pub spacing: Option<Quantity<Positive<Length>>>,
}

/// Density, momentum, stress and heat flux at points that stay where they are, of atoms or of a peridynamic body, as `peridyne fields` makes
/// them of files. Exactly one of grid, points, line, plane says where.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fields {
    /// Folder inside that of the results; "fields" by default.
    pub name: Option<At<String>>,
    /// Localization function.
    pub kernel: At<KernelName>,
    /// S of it: what a particle is spread over.
    pub width: Quantity<Positive<Length>>,
    /// Of polynomials, 0 to 7: one derivative less is continuous; 3 by default.
    pub smoothness: Option<At<u32>>,
    /// Axes of the box to average over, ["y", "z"] for a profile along x; those beyond the dimension always are.
    pub average: Option<At<Vec<At<AxisName>>>>,
    /// Counts along each axis: the centres of so many equal pieces of the box.
    pub grid: Option<At<Vec<At<usize>>>>,
    /// Two opposite corners of the box; by default that of the body at the start, on periodic axes the period (and
    /// nothing else there).
    pub corners: Option<At<Vec<Vector<Length>>>>,
    /// A list of points.
    pub points: Option<At<Vec<Vector<Length>>>>,
    /// Points evenly on a line, both ends included.
    pub line: Option<At<Line>>,
    /// Points evenly on a parallelogram, borders included.
    pub plane: Option<At<Flat>>,
    /// Steps between frames, of which the first is the start; by default only the last state is one.
    pub every: Option<At<u64>>,
    /// Frames to pass over first; 0 by default.
    pub skip: Option<u64>,
    /// Write the fields of each frame, too; false by default. Else they are means over frames alone.
    #[serde(default)]
    pub each: bool,
    /// Pictures of the slice of a grid in all frames as a film, too, as in `output.pictures`: stress_film.png, of atoms temperature_film.png; false
    /// by default. Needs `every`.
    pub film: Option<At<Film>>,
    /// Write the pressure, too: minus a third of the trace of the Cauchy stress; false by default.
    #[serde(default)]
    pub pressure: bool,
    /// Write the material coordinate y, too, its flux and the angular momentum ρ y × v; false by default.
    #[serde(default)]
    pub coordinate: bool,
    /// Whose a term's energy is, of atoms: site by default, equal, or { centre = 0.5 }.
    pub partition: Option<At<Or<PartitionName, Centre>>>,
    /// Of atoms; distances by default. A peridynamic body has that of its force states, differences.
    pub pair_force: Option<At<PairForceName>>,
    /// Keep the parts of the potential apart, of atoms.
    pub parts: Option<At<bool>>,
    /// Points at which the residuals of the balance laws are measured; 16 by default.
    pub residuals: Option<usize>,
}

/// Points at equal distances from one place to another, ends included.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// One end.
    pub from: Vector<Length>,
    /// The other.
    pub to: Vector<Length>,
    /// How many points.
    pub count: At<usize>,
}

/// Points of a parallelogram, at equal distances along its edges.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flat {
    /// One corner.
    pub corner: Vector<Length>,
    /// Two edges from it.
    pub edges: At<Vec<Vector<Length>>>,
    /// How many points along each edge.
    pub counts: At<[usize; 2]>,
}

/// How the energy of a term is shared among its atoms.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Centre {
    /// So much of a term to its centre, the rest in equal parts to the others.
    pub centre: Quantity,
}
