//! All of a deck.

use super::condition::{Condition, Contact, Initial};
use super::crack::{BondFactor, Healing, Precrack, Toughness};
use super::fields::{Fields, Smooth};
use super::indenter::Indenter;
use super::influence::InfluenceWritten;
use super::law::Law;
use super::molecules::Molecules;
use super::names::{
    CalibrationName, CriterionName, FamilyName, InterfaceName, LatticeName, MixingName, PlaneName,
    SurfaceName,
};
use super::output::Output;
use super::region::{Periodic, Set, Shape};
use super::run::{Probe, ReleaseName, Run, Statics};
use super::thermal::Thermal;
use super::transfer::{Heat, HeatMaterial, Species, SpeciesMaterial};
use super::units::{UnitName, Units};
use crate::deck::units::Dim;
use crate::deck::value::{At, Named, Number, Or, Vector, Written};
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
    /// What plain numbers mean: "si" when left out, or { system = "metal", constants = "lammps" }.
    pub units: Option<At<Or<UnitName, Units>>>,
    /// Space dimensions, 1 to 3; follows from the lattice or the mesh when left out.
    pub dimension: Option<At<usize>>,
    /// 2-D only; stress when left out.
    pub plane: Option<At<PlaneName>>,
    /// Thickness of a 2-D body; 1 when left out.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub thickness: Option<Number>,
    /// Cross-section of a 1-D body; 1 when left out.
    #[schemars(extend("dimension" = Dim::AREA.name()))]
    pub area: Option<Number>,
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
    /// Bonds of pmb (that expand or break by whatever, too) between unlike materials of one body, and factors of bonds between unlike ends; series when
    /// left out. Ends of other laws answer for themselves, which is parallel. Or `[[interface]]`, bonds between two of several bodies.
    #[schemars(with = "Option<Or<Vec<Interface>, InterfaceName>>")]
    pub interface: Option<At<InterfaceName>>,
    /// `[[interface]]`, under the name that [`locate`](super::super::locate) gives them.
    #[serde(default, rename = "[[interface]]")]
    #[schemars(skip)]
    pub interfaces: Vec<At<Interface>>,
    /// { m_ratio = 3 } in lattice spacings, or a length.
    /// Not needed by atoms that talk to their current neighbours.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub horizon: Option<At<Or<Written, HorizonRatio>>>,
    /// Horizon of each point, an expression of x, y, z, at most `horizon` (dual horizon): on clouds, with family = "list" of lattices, too, of pmb, lps and
    /// other laws that their families normalise; with calibration = "continuum". Of several bodies that of all, or in a `[[body]]` its own.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub own_horizon: Option<Number>,
    /// constant for pmb and inverse for lps when left out.
    pub influence: Option<At<InfluenceWritten>>,
    /// Scale the partner's volume where its cell straddles the horizon; true when left out.
    pub volume_scaling: Option<bool>,
    /// discrete (the body really has the modulus asked for) when left out.
    pub calibration: Option<CalibrationName>,
    /// auto when left out: a stencil on lattices, a list of a cloud, current neighbours of atoms. "reference" makes a potential of any kind a
    /// peridynamic material: atoms keep those that are within `horizon` in the reference, whatever they do, and members beyond the cut-off
    /// add nothing. Atoms on a "stencil" keep the neighbours they have in the lattice.
    pub family: Option<FamilyName>,
    /// Nodes that carry the atoms of family = "reference" along: the smoothed material. Left out: the atoms themselves move.
    pub smooth: Option<At<Smooth>>,
    /// ["x"]: the body's region spans one period; or { x = "50 mm" }.
    pub periodic: Option<At<Periodic>>,
    /// Factors of bonds near the surface of a lattice body, of bond-based laws (pmb, springs) and, with exact, state-based solids (lps, lps_as_typed,
    /// eam_like); none when left out. exact: every uniform strain is in equilibrium under its uniform traction, and the surface runs through the
    /// outermost points. Of several bodies that of all, or in a `[[body]]` its own.
    pub surface: Option<At<SurfaceName>>,
    /// Factors of the stiffness of bonds (pmb, springs on lattices), of those of interfaces, too; all that concern a bond are multiplied.
    #[serde(default)]
    pub bond_factor: Vec<At<BondFactor>>,
    /// Factors of the toughness of sets, by place and time, and sets that never fail; all that concern a point are multiplied.
    #[serde(default)]
    pub toughness: Vec<At<Toughness>>,
    /// Broken bonds that become whole again, in explicit motion; none when left out.
    pub healing: Option<At<Healing>>,
    /// Bonds that never were, or are broken, where they cross a shape.
    #[serde(default)]
    pub precrack: Vec<At<Precrack>>,
    /// On when a material can fracture or there are several bodies; false turns it off.
    pub contact: Option<Or<bool, Contact>>,
    /// What bonds the atoms of `body.file`, beside their pair potential; { } takes the file's as it is.
    pub molecules: Option<At<Molecules>>,
    /// Maxwellian velocities.
    pub thermal: Option<Thermal>,
    /// Heat that the bonds conduct.
    pub heat: Option<At<Heat>>,
    /// A species that diffuses through the bonds.
    pub species: Option<At<Species>>,
    /// Displacements, velocities, temperatures and concentrations at t = 0.
    #[serde(default)]
    pub initial: Vec<At<Initial>>,
    /// What is held, moved, pushed, damped, heated or cooled during the run.
    #[serde(default)]
    pub condition: Vec<At<Condition>>,
    /// Rigid bodies (spheres, boxes, cylinders, planes, surfaces of triangles), driven or free.
    #[serde(default)]
    pub indenter: Vec<At<Indenter>>,
    /// Measurements over time: columns of history.csv.
    #[serde(default)]
    pub probe: Vec<At<Probe>>,
    /// Continuum fields of the running model: density, momentum, stress, heat flux.
    #[serde(default)]
    pub fields: Vec<At<Fields>>,
    /// Motion in time; instead of statics, or from the last equilibrium of [statics] on.
    pub run: Option<At<Run>>,
    /// Equilibrium under conditions that grow with t; instead of run, or before it.
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
    /// false: points without bonds, which meet by contact only (powder, a single point); true when left out.
    pub bonded: Option<bool>,
    /// Its own, instead of that of the deck, which counts spacings of each body; of several bodies only.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub horizon: Option<At<Or<Written, HorizonRatio>>>,
    /// Its own, instead of that of the deck; of several bodies only.
    pub influence: Option<At<InfluenceWritten>>,
    /// Its own, stencil or list, instead of that of the deck; of several bodies only.
    pub family: Option<At<FamilyName>>,
    /// Horizon of each of its points, instead of that of the deck, at most its `horizon`; of several bodies only.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub own_horizon: Option<Number>,
    /// Factors of its bonds near the surface, instead of those of the deck; of several bodies only.
    pub surface: Option<At<SurfaceName>>,
    /// Lattice that fills the region; instead of a file.
    pub lattice: Option<At<LatticeName>>,
    /// Edge of the lattice cell; with a file, the typical distance of points.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub spacing: Option<Number>,
    /// Position of the first site of a cell. When left out cells fill the region, points in their middles (with surface = "exact" the outer
    /// points lie on its faces); 0 of atoms, with cells, and of lattices with several sites in a cell where the region is no whole number of layers.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub origin: Option<Vector>,
    /// Where there are points: sites of the lattice inside it.
    pub region: Option<At<Shape>>,
    /// Whole cells along each axis from the origin on, instead of a region.
    pub cells: Option<At<Vec<At<u32>>>>,
    /// Points `x y z volume [mark]` (.txt; a first line `# x y z block_id volume` names columns in another order), a mesh (Abaqus .inp, gmsh .msh as text or binary, Exodus II .g or .e in netCDF-3; its groups are sets), a linear body with its micromoduli (.npz), LAMMPS data of `atom_style peri` (.data, .lmp: volume
    /// and density of each point, the atom type as mark), or atoms: LAMMPS data of `atom_style atomic`, `molecular`, or `full` with charges of 0, a LAMMPS dump
    /// (.lammpstrj, .dump), extended XYZ (.extxyz). Relative to the deck.
    pub file: Option<At<String>>,
    /// Time step of the frame to take from a dump or extended XYZ; the last frame when left out.
    pub file_step: Option<At<u64>>,
    /// What one unit of the file's coordinates is; the deck's unit of length when left out. Densities of a file are in
    /// the deck's units.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub file_unit: Option<Number>,
    /// Sites moved at random; the body is a cloud then.
    pub perturb: Option<Perturb>,
}

/// Random displacement of every site.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Perturb {
    /// Each coordinate moves by at most so much.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub amplitude: Number,
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
    /// { m_ratio = 3 } in spacings of the first body, or a length; that of the first body when left out.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub horizon: Option<At<Or<Written, HorizonRatio>>>,
    /// constant when left out.
    pub influence: Option<At<InfluenceWritten>>,
    /// When its bonds break; never when left out.
    pub fracture: Option<At<Fracture>>,
}

/// A potential between atoms of two materials.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pair {
    /// Names of the two; the same twice: on top of the law of one.
    pub between: At<Vec<At<String>>>,
    /// A pair potential; "no_potential" if they do not feel each other.
    pub law: At<Law>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Set that is made of it; all when left out. Of several, that of the same name when left out; of atoms, one may be what the others
    /// leave. Kinds of atoms in a file are sets of their names, or of the numbers of their types.
    pub set: Option<At<String>>,
    /// Left out, the densities in the LAMMPS data file are taken; given, it takes their place.
    #[schemars(extend("dimension" = Dim::DENSITY.name()))]
    pub density: Option<Number>,
    /// Mass of a point, instead of the density; of atoms taken from their file or an eam file when left out.
    #[schemars(extend("dimension" = Dim::MASS.name()))]
    pub mass: Option<Number>,
    /// What its bonds answer: the name of a law with its constants.
    pub law: At<Law>,
    /// When its bonds break; never when left out.
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
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub critical_stretch: Option<Number>,
    /// Fracture energy per area.
    #[schemars(extend("dimension" = Dim::FRACTURE_ENERGY.name()))]
    pub energy: Option<Number>,
    /// What the energy is made of: stretch when left out.
    pub criterion: Option<At<CriterionName>>,
    /// Von Mises stress, the mean of both ends, at which a bond breaks.
    #[schemars(extend("dimension" = Dim::PRESSURE.name()))]
    pub von_mises: Option<Number>,
    /// Equivalent plastic strain, the mean of both ends, at which a bond breaks; of elastic_plastic and hypoelastic_plastic.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub plastic_strain: Option<Number>,
    /// Growth of the critical stretch with the rate at which a bond is stretched.
    pub rate: Option<FractureRate>,
    /// Wear of bonds in cycles of load, with [statics] cycles.
    pub fatigue: Option<At<Fatigue>>,
    /// Strengthening under compression, s0 = s00 − α s_min; 0 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub alpha: Option<Number>,
    /// at_once when left out; the same for all materials.
    pub release: Option<At<ReleaseName>>,
}

/// The critical stretch of a bond is s0 (1 + C ln(ṡ/ṡ0)) where it is stretched faster than ṡ0.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FractureRate {
    /// C.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub coefficient: Number,
    /// ṡ0.
    #[schemars(extend("dimension" = Dim::FREQUENCY.name()))]
    pub reference: Number,
}

/// Cycles take A ε^m each of the life of a bond, 1 at first, ε the range of its stretch (Silling & Askari 2014).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fatigue {
    /// [A, m] far from any crack, of the part of ε that is above the limit; no cracks begin when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub nucleation: Option<At<Vec<Number>>>,
    /// Range of stretch up to which bonds far from any crack live for ever; 0 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub limit: Option<Number>,
    /// [A, m] near a crack; none grows when left out. m is the exponent of Paris's law.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub growth: Option<At<Vec<Number>>>,
    /// Part of a family's volume that is cut off at a crack: bonds of points with such a point in their family are near one. 0.35 when left
    /// out, of a straight crack through a lattice it is 0.39.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub crack: Option<Number>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HorizonRatio {
    /// Horizon over spacing.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub m_ratio: Number,
}
