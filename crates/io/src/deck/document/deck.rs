//! All of a deck.

use super::condition::{Condition, Contact, Initial};
use super::crack::{BondFactor, Healing, Precrack, Toughness};
use super::diffusion::{Heat, HeatMaterial, Species, SpeciesMaterial};
use super::fields::{Fields, Smooth};
use super::influence::InfluenceWritten;
use super::law::Law;
use super::molecules::Molecules;
use super::names::{
    BondMixingName, CalibrationName, CriterionName, FamilyName, LatticeName, MixingName, PlaneName,
    SurfaceName,
};
use super::output::Output;
use super::region::{Periodic, Set, Shape};
use super::rigid_body::RigidBody;
use super::run::{BreakageName, Probe, Run, Statics};
use super::thermal::Thermal;
use super::units::{UnitName, Units};
use crate::deck::quantity::{
    Area, Density, FractureEnergy, Frequency, Length, Mass, NotNegative, Positive, Pressure, Within,
};
use crate::deck::value::{At, Measured, Named, Number, Or, Quantity, Vector};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A peridyne deck.
///
/// Numbers are plain (in the deck's units), carry a unit ("0.5 mm"), or are expressions of the constants.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// One line for headers and pictures.
    pub title: Option<String>,
    /// What plain numbers mean: "si" by default, or { system = "metal", constants = "lammps" }.
    pub units: Option<At<Or<UnitName, Units>>>,
    /// Space dimensions, 1 to 3; follows from the lattice or the mesh by default.
    pub dimension: Option<At<usize>>,
    /// Plane stress or plane strain, 2-D only; stress by default.
    pub plane: Option<At<PlaneName>>,
    /// Thickness of a 2-D body; 1 by default.
    pub thickness: Option<Quantity<Positive<Length>>>,
    /// Cross-section of a 1-D body; 1 by default.
    pub area: Option<Quantity<Positive<Area>>>,
    /// Named numbers for use in any number.
    #[serde(default)]
    pub constants: BTreeMap<String, Number>,
    /// `[body]`, or `[[body]]` several times: bonds inside each, contact between them.
    #[schemars(with = "Or<Vec<Body>, Body>")]
    pub body: At<Body>,
    /// Those after the first, under the name that [`locate`](super::super::locate) gives them.
    #[serde(default, rename = "[[body]]")]
    #[schemars(skip)]
    pub more_bodies: Vec<At<Body>>,
    /// Named sets of points; "all" always exists.
    #[serde(default)]
    pub sets: BTreeMap<String, At<Set>>,
    /// `[material]`, or `[material.NAME]` for each of several.
    #[schemars(with = "Or<Material, Named<Material>>")]
    pub material: BTreeMap<String, At<Material>>,
    /// How constants of pairs of unlike atoms follow where no [[pair]] gives them (lennard_jones).
    pub mixing: Option<At<MixingName>>,
    /// Potentials between atoms of two materials, or on top of that of one: energies are added.
    #[serde(default)]
    pub pair: Vec<At<Pair>>,
    /// Constant of a bond of pmb (one that expands or has another breaking criterion, too) between unlike materials of one body, and of the factors of its
    /// ends; harmonic by default. Ends of other laws have their own constants, which is arithmetic.
    pub bond_mixing: Option<At<BondMixingName>>,
    /// Bonded interfaces: bonds between two of several bodies.
    #[serde(default)]
    pub interface: Vec<At<Interface>>,
    /// { m_ratio = 3 } in lattice spacings, or a length.
    /// Not needed by atoms that interact with their current neighbours.
    pub horizon: Option<At<Or<Measured<Positive<Length>>, HorizonRatio>>>,
    /// Horizon of each point, an expression of x, y, z, at most `horizon` (dual horizon): on clouds, with family = "list" of lattices, too, of pmb, lps and
    /// other laws that their families normalise; with calibration = "continuum". Of several bodies that of all, or in a `[[body]]` its own.
    pub variable_horizon: Option<Quantity<Length>>,
    /// Weight ω of a bond by its length; constant for pmb and inverse for lps by default.
    pub influence: Option<At<InfluenceWritten>>,
    /// Scale the partner's volume where its cell straddles the horizon; true by default.
    pub partial_volume_correction: Option<bool>,
    /// How constants follow from moduli: discrete, by the sums of a full family of this body, so that the effective modulus in the bulk is the target, or by integrals; discrete by default.
    pub calibration: Option<CalibrationName>,
    /// auto by default: a stencil on lattices, a list of a cloud, current neighbours of atoms. "reference" makes a potential of any kind a
    /// peridynamic material: atoms keep those that are within `horizon` in the reference, whatever they do, and members beyond the cut-off
    /// add nothing. Atoms on a "stencil" keep the neighbours they have in the lattice.
    pub family: Option<FamilyName>,
    /// Nodes that move the atoms of family = "reference" along: the smoothed material. By default the atoms themselves move.
    pub smooth: Option<At<Smooth>>,
    /// ["x"]: the body's region spans one period; or { x = "50 mm" }.
    pub periodic: Option<At<Periodic>>,
    /// Factors of bonds near the surface of a lattice body, of bond-based laws (pmb, springs) and, with exact, state-based solids (lps, lps_3d,
    /// eam_like); none by default. exact: every uniform strain is in equilibrium under its uniform traction, and the surface runs through the
    /// outermost points. Of several bodies that of all, or in a `[[body]]` its own.
    pub surface: Option<At<SurfaceName>>,
    /// Scaling of the stiffness of bonds (pmb, springs on lattices), of those of interfaces, too; all factors that concern a bond are multiplied.
    #[serde(default)]
    pub bond_stiffness: Vec<At<BondFactor>>,
    /// Factors of the toughness of sets, by place and time, and sets that never fail; all that concern a point are multiplied.
    #[serde(default)]
    pub toughness: Vec<At<Toughness>>,
    /// Healing: broken bonds that become intact again, in explicit motion; none by default.
    pub healing: Option<At<Healing>>,
    /// Bonds that cross a shape: excluded from the families, or broken at the start.
    #[serde(default)]
    pub precrack: Vec<At<Precrack>>,
    /// On when a material can fracture or there are several bodies; false turns it off.
    pub contact: Option<Or<bool, Contact>>,
    /// What bonds the atoms of `body.file`, beside their pair potential; { } takes the file's as it is.
    pub molecules: Option<At<Molecules>>,
    /// Velocities at the start drawn from the Maxwell–Boltzmann distribution of a temperature.
    pub initial_velocities: Option<Thermal>,
    /// Heat that the bonds conduct.
    pub heat: Option<At<Heat>>,
    /// A species that diffuses through the bonds.
    pub species: Option<At<Species>>,
    /// Displacements, velocities, temperatures and concentrations at t = 0.
    #[serde(default)]
    pub initial: Vec<At<Initial>>,
    /// Boundary conditions and loads: what is held, moved, loaded, damped, heated or cooled during the run.
    #[serde(default)]
    pub boundary_condition: Vec<At<Condition>>,
    /// Rigid bodies (spheres, boxes, cylinders, planes, surfaces of triangles), with prescribed motion or free.
    #[serde(default)]
    pub rigid_body: Vec<At<RigidBody>>,
    /// Measurements over time: columns of history.csv.
    #[serde(default)]
    pub probe: Vec<At<Probe>>,
    /// Continuum fields of the running model: density, momentum, stress, heat flux.
    #[serde(default)]
    pub fields: Vec<At<Fields>>,
    /// Motion in time; instead of statics, or from the last equilibrium of [statics] on.
    pub run: Option<At<Run>>,
    /// Equilibrium under boundary conditions that grow with t; instead of run, or before it.
    pub statics: Option<At<Statics>>,
    /// Files of the results.
    #[serde(default)]
    pub output: Output,
}

/// Where the points come from: a lattice in a region, or a file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// For messages, and as a set of its points; of several bodies only.
    pub name: Option<At<String>>,
    /// The [material.NAME] that the whole body is made of; of several bodies only.
    pub material: Option<At<String>>,
    /// false: points without bonds, which meet by contact only (powder, a single point); true by default.
    pub bonded: Option<bool>,
    /// Its own, instead of that of the deck, which counts spacings of each body; of several bodies only.
    pub horizon: Option<At<Or<Measured<Positive<Length>>, HorizonRatio>>>,
    /// Its own, instead of that of the deck; of several bodies only.
    pub influence: Option<At<InfluenceWritten>>,
    /// Its own, stencil or list, instead of that of the deck; of several bodies only.
    pub family: Option<At<FamilyName>>,
    /// Horizon of each of its points, instead of that of the deck, at most its `horizon`; of several bodies only.
    pub variable_horizon: Option<Quantity<Length>>,
    /// Factors of its bonds near the surface, instead of those of the deck; of several bodies only.
    pub surface: Option<At<SurfaceName>>,
    /// Lattice that fills the region; instead of a file.
    pub lattice: Option<At<LatticeName>>,
    /// Edge of the lattice cell; with a file, the typical distance of points.
    pub spacing: Option<Quantity<Positive<Length>>>,
    /// Position of the first site of a cell. By default cells fill the region, points in their middles (with surface = "exact" the outer
    /// points lie on its faces); 0 of atoms, with cells, and of lattices with several sites in a cell where the region is no whole number of layers.
    pub origin: Option<Vector<Length>>,
    /// Where there are points: sites of the lattice inside it.
    pub region: Option<At<Shape>>,
    /// Whole cells along each axis from the origin on, instead of a region.
    pub cells: Option<At<Vec<At<u32>>>>,
    /// Points `x y z volume [block_id]` (.txt; a first line `# x y z block_id volume` names columns in another order), a mesh (Abaqus .inp, gmsh .msh as text or binary, Exodus II .g or .e; its groups are sets), a linear body with its micromoduli (.npz), LAMMPS data of `atom_style peri` (.data, .lmp: volume
    /// and density of each point, the atom type as block id), or atoms: LAMMPS data of `atom_style atomic`, `molecular`, or `full` with charges of 0, a LAMMPS dump
    /// (.lammpstrj, .dump), extended XYZ (.extxyz). Relative to the deck.
    pub file: Option<At<String>>,
    /// Time step of the frame to take from a dump or extended XYZ; the last frame by default.
    pub file_step: Option<At<u64>>,
    /// What one unit of the file's coordinates is; the deck's unit of length by default. Densities of a file are in
    /// the deck's units.
    pub file_unit: Option<Quantity<Positive<Length>>>,
    /// Sites moved at random; the body is a cloud then.
    pub perturb: Option<Perturb>,
}

/// Random displacement of every site.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Perturb {
    /// Each coordinate moves by at most so much.
    pub amplitude: Quantity<Length>,
    /// The same number gives the same points.
    pub seed: u64,
}

/// Bonds between the points of two bodies that are within a horizon of each other in the reference. Without them bodies meet by
/// contact alone.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Interface {
    /// For messages.
    pub name: Option<At<String>>,
    /// Names of the two bodies.
    pub bodies: At<Vec<At<String>>>,
    /// A law of bonds (pmb, thermoelastic, softening); moduli are those of a full family of the first body at this horizon.
    pub law: At<Law>,
    /// { m_ratio = 3 } in spacings of the first body, or a length; that of the first body by default.
    pub horizon: Option<At<Or<Measured<Positive<Length>>, HorizonRatio>>>,
    /// Weight ω of a bond by its length; constant by default.
    pub influence: Option<At<InfluenceWritten>>,
    /// When its bonds break; never by default.
    pub fracture: Option<At<Fracture>>,
}

/// A potential between atoms of two materials.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pair {
    /// Names of the two; the same twice: on top of the law of one.
    pub between: At<Vec<At<String>>>,
    /// A pair potential; "no_potential" if they do not interact.
    pub law: At<Law>,
}

/// What points are made of: a law with its constants, a density or mass, and when bonds break. `[material]` is the only one, `[material.NAME]` one of several.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Set that is made of it; all by default. Of several, that of the same name by default; of atoms, one may be what the others
    /// leave. Kinds of atoms in a file are sets of their names, or of the numbers of their types.
    pub set: Option<At<String>>,
    /// Left out, the densities in the LAMMPS data file are taken; given, it takes their place.
    pub density: Option<Quantity<Positive<Density>>>,
    /// Mass of a point, instead of the density; of atoms taken from their file or an eam file by default.
    pub mass: Option<Quantity<Positive<Mass>>>,
    /// Its constitutive law: the name of a law with its constants.
    pub law: At<Law>,
    /// When its bonds break; never by default.
    pub fracture: Option<At<Fracture>>,
    /// What it does with heat, where that spreads ([heat]).
    pub heat: Option<At<HeatMaterial>>,
    /// What it does with a species, where that spreads ([species]).
    pub species: Option<At<SpeciesMaterial>>,
}

/// One of critical_stretch, energy, von_mises, plastic_strain; the same kind in all materials of a body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fracture {
    /// Stretch s00 = (length − reference length) / reference length past which a bond breaks.
    pub critical_stretch: Option<Quantity<Positive>>,
    /// Fracture energy per area.
    pub energy: Option<Quantity<Positive<FractureEnergy>>>,
    /// What the energy is made of: stretch by default.
    pub criterion: Option<At<CriterionName>>,
    /// Von Mises stress, the mean of both ends, at which a bond breaks.
    pub von_mises: Option<Quantity<Positive<Pressure>>>,
    /// Equivalent plastic strain, the mean of both ends, at which a bond breaks; of elastic_plastic and hypoelastic_plastic.
    pub plastic_strain: Option<Quantity<Positive>>,
    /// Growth of the critical stretch with the rate at which a bond is stretched.
    pub rate: Option<FractureRate>,
    /// Fatigue damage of bonds in cycles of load, with [statics] cycles.
    pub fatigue: Option<At<Fatigue>>,
    /// Strengthening under compression, s0 = s00 − α s_min; 0 by default.
    pub alpha: Option<Quantity<NotNegative>>,
    /// Whether a bond past its critical stretch still acts in the step that breaks it; before_force by default; the same for all materials.
    pub breakage: Option<At<BreakageName>>,
}

/// The critical stretch of a bond is s0 (1 + C ln(ṡ/ṡ0)) where it is stretched faster than ṡ0.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FractureRate {
    /// C.
    pub coefficient: Quantity<Positive>,
    /// ṡ0.
    pub reference: Quantity<Positive<Frequency>>,
}

/// Cycles take A ε^m each of the life of a bond, 1 at first, ε the range of its stretch (Silling & Askari 2014).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fatigue {
    /// [A, m] far from any crack, of the part of ε that is above the limit; no cracks begin by default.
    pub nucleation: Option<At<Vec<Quantity<Positive>>>>,
    /// Range of stretch up to which bonds far from any crack live for ever; 0 by default.
    pub limit: Option<Quantity<NotNegative>>,
    /// [A, m] near a crack; none grows by default. m is the exponent of Paris's law.
    pub growth: Option<At<Vec<Quantity<Positive>>>>,
    /// Part of a family's volume that is cut off at a crack: bonds of points with such a point in their family are near one. 0.35 by
    /// default, of a straight crack through a lattice it is 0.39.
    pub crack: Option<Quantity<Within>>,
}

/// The horizon in spacings of the body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HorizonRatio {
    /// Horizon over spacing.
    pub m_ratio: Quantity<Positive>,
}
