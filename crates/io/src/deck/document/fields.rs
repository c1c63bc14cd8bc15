//! Continuum fields of the running model.

use super::{AxisName, KernelName, PairForceName, PartitionName};
use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Or, Vector};
use schemars::JsonSchema;
use serde::Deserialize;

/// Nodes that carry atoms along: `u(X_j) = Σ_g w_g(X_j) u_g`, w_g of φ about each atom, so that quadratic displacements are exact.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Smooth {
    /// Localization function φ.
    pub kernel: At<KernelName>,
    /// S of it: two to three spacings of nodes or more.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub width: Number,
    /// Of polynomials, 0 to 7: one derivative less is continuous; 3 when left out.
    pub smoothness: Option<At<u32>>,
    /// Of the nodes, on a square or cubic lattice; along periodic axes a whole part of the period. When left out nodes are at the places of the
    /// atoms.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub spacing: Option<Number>,
}

/// Density, momentum, stress and heat flux at points that stay where they are, of atoms or of a peridynamic body, as `peridyne fields` makes
/// them of files; docs/fields.md. Exactly one of grid, points, line, plane says where.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fields {
    /// Folder inside that of the results; "fields" when left out.
    pub name: Option<At<String>>,
    /// Localization function.
    pub kernel: At<KernelName>,
    /// S of it: what a particle is spread over.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub width: Number,
    /// Of polynomials, 0 to 7: one derivative less is continuous; 3 when left out.
    pub smoothness: Option<At<u32>>,
    /// Axes of the box to average over, ["y", "z"] for a profile along x; those beyond the dimension always are.
    pub average: Option<At<Vec<At<AxisName>>>>,
    /// Counts along each axis: the centres of so many equal pieces of the box.
    pub grid: Option<At<Vec<At<usize>>>>,
    /// Two opposite corners of the box; when left out, that of the body at the start, on periodic axes the period (and
    /// nothing else there).
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub corners: Option<At<Vec<Vector>>>,
    /// A list of points.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub points: Option<At<Vec<Vector>>>,
    /// Points evenly on a line, both ends included.
    pub line: Option<At<Line>>,
    /// Points evenly on a parallelogram, borders included.
    pub plane: Option<At<Flat>>,
    /// Steps between frames, of which the first is the start; when left out only the last state is one.
    pub every: Option<At<u64>>,
    /// Frames to pass over first; 0 when left out.
    pub skip: Option<u64>,
    /// Write the fields of each frame, too; false when left out. Else they are means over frames alone.
    #[serde(default)]
    pub each: bool,
    /// Pictures of the slice of a grid in all frames as an animated PNG, too: stress_film.png, of atoms temperature_film.png; false
    /// when left out. Needs `every`.
    pub film: Option<At<bool>>,
    /// Write the pressure, too: minus a third of the trace of the Cauchy stress; false when left out.
    #[serde(default)]
    pub pressure: bool,
    /// Write the material coordinate y, too, its flux and the angular momentum ρ y × v; false when left out.
    #[serde(default)]
    pub coordinate: bool,
    /// Whose a term's energy is, of atoms: site when left out, equal, or { centre = 0.5 }.
    pub partition: Option<At<Or<PartitionName, Centre>>>,
    /// Of atoms; distances when left out. A peridynamic body has that of its force states, differences.
    pub pair_force: Option<At<PairForceName>>,
    /// Keep the parts of the potential apart, of atoms.
    pub parts: Option<At<bool>>,
    /// Points at which the residuals of the balance laws are measured; 16 when left out.
    pub residuals: Option<usize>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// One end.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub from: Vector,
    /// The other.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub to: Vector,
    /// How many points.
    pub count: At<usize>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flat {
    /// One corner.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub corner: Vector,
    /// Two edges from it.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub edges: At<Vec<Vector>>,
    /// How many points along each edge.
    pub counts: At<[usize; 2]>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Centre {
    /// So much of a term to its centre, the rest in equal parts to the others.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub centre: Number,
}
