//! What is written.

use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Or};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};
use std::borrow::Cow;
use std::fmt;

#[derive(Debug, Default, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Folder of the results, relative to the deck; when left out, out/NAME in the working folder for the deck NAME.toml.
    pub dir: Option<String>,
    /// Steps between frames; only the first and the last state when left out.
    pub every: Option<At<u64>>,
    /// Frames after the first, evenly in steps, in place of `every`; one fewer or a few fewer where steps are no multiple.
    pub frames: Option<At<u64>>,
    /// Point fields of a frame, by name (`peridyne laws` lists them), displacements always; displacement, velocity, damage,
    /// energy_density, dilatation, mark when left out.
    pub fields: Option<Vec<At<String>>>,
    /// VTU series for ParaView; true when left out.
    pub vtu: Option<bool>,
    /// Exodus II file of this name (.e), in the folder of the results: all frames with their fields, for ParaView and the tools of
    /// Sandia.
    pub exodus: Option<At<String>>,
    /// VTKHDF file of this name (.vtkhdf), in the folder of the results: the points of all frames with their fields in one file, as the VTU
    /// series has them, for ParaView, pyvista and h5py; `vtu = false` leaves the series out.
    pub vtkhdf: Option<At<String>>,
    /// Unbroken bonds as lines, too.
    #[serde(default)]
    pub bonds: bool,
    /// The linear body about the last state as linear_body.npz (NumPy): points and micromoduli.
    #[serde(default)]
    pub linear_body: bool,
    /// The pieces of the last state as fragments.csv: number of points, mass, place and velocity of the centre of mass of each.
    #[serde(default)]
    pub fragments: bool,
    /// LAMMPS dump of this name, in the folder of the results: frames of points with their fields, of atoms with velocities,
    /// forces and energies.
    pub dump: Option<At<String>>,
    /// Steps between rows of history.csv; a hundredth of the run when left out.
    pub history: Option<At<u64>>,
    /// PNG of the last state, named after the field that it shows: damage if bonds broke, else displacement in statics and velocity in
    /// motion. When left out true, and false for atoms or where pictures are listed.
    pub picture: Option<bool>,
    /// Pictures of fields of your choice.
    #[serde(default)]
    pub pictures: Vec<At<Picture>>,
    /// Bodies on a line that move: a field over x of the reference and t, which goes down, as space_time_FIELD.png and .svg, its numbers as
    /// space_time_FIELD.npz. "density" is 1/y', reference over current distance of the points beside a point; or the name of a field of points.
    /// Of several a list of tables.
    pub space_time: Option<At<Or<SpaceTimes, SpaceTime>>>,
    /// report.html at the end, the run in one file for browsers; true when left out.
    pub report: Option<bool>,
    /// How often a state is written from which `peridyne resume` goes on, in the folder `checkpoint` of the results: { every = "10 min",
    /// keep = 2 } when left out, so that runs which are shorter write none; false: only where a run is ended early.
    pub checkpoint: Option<At<Or<bool, Checkpoint>>>,
    /// Atoms only: one file with all frames, positions, velocities, forces and energies; .extxyz, or .lammpstrj for a
    /// LAMMPS dump.
    pub trajectory: Option<At<String>>,
    /// Atoms only: LAMMPS data file (`atom_style atomic`, with velocities) of the last state.
    pub data: Option<At<String>>,
}

/// States from which a run goes on.
#[derive(Debug, Default, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// Time on the clock of the machine between two, such as "10 min" or "2 h"; 10 min when left out.
    pub every: Option<At<String>>,
    /// How many stay, the newest; 2 when left out.
    pub keep: Option<At<u64>>,
}

/// One field by name, or tables of several.
#[derive(Debug)]
pub enum SpaceTimes {
    Field(String),
    All(Vec<At<SpaceTime>>),
}

impl<'de> Deserialize<'de> for SpaceTimes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Each;
        impl<'de> Visitor<'de> for Each {
            type Value = SpaceTimes;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a field, or a list of tables { field = \"density\" }")
            }
            fn visit_str<E: serde::de::Error>(self, v: &str) -> Result<SpaceTimes, E> {
                Ok(SpaceTimes::Field(v.to_string()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<SpaceTimes, A::Error> {
                let mut all = vec![];
                while let Some(one) = seq.next_element()? {
                    all.push(one);
                }
                Ok(SpaceTimes::All(all))
            }
        }
        deserializer.deserialize_any(Each)
    }
}

impl JsonSchema for SpaceTimes {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "SpaceTimes".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<SpaceTime>();
        json_schema!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": one }] })
    }
}

/// A field of a body on a line over place and time. Of several of one field the second is called space_time_FIELD_2.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpaceTime {
    /// "density", or the name of a field of points (`peridyne laws` lists them).
    pub field: At<String>,
    /// xx, … of a tensor; when left out, of vectors x, of tensors the magnitude.
    pub component: Option<At<String>>,
    /// What the ends of the colours mean, in plain numbers of the field; when left out those of its values, of the density as far from 1 on
    /// either side.
    #[schemars(extend("dimension" = "that of the field"))]
    pub range: Option<At<[f64; 2]>>,
    /// From where to where in the reference; the whole body when left out.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub x: Option<At<[Number; 2]>>,
    /// From when to when; the whole motion when left out.
    #[schemars(extend("dimension" = Dim::TIME.name()))]
    pub t: Option<At<[Number; 2]>>,
}

/// A PNG of a field at the end, FIELD.png or FIELD_COMPONENT.png, with cracks, indenters, supports and loads.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    /// Name of a field of points (`peridyne laws` lists them); when left out what the run is about, as `picture` says.
    pub field: Option<At<String>>,
    /// x, xy, … or magnitude; the magnitude when left out.
    pub component: Option<At<String>>,
    /// Displacements are drawn so many times as large; when left out 1, in statics so that they are seen.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub scale: Option<Number>,
    /// What the ends of the colours mean, in plain numbers of the field; those of its values when left out.
    #[schemars(extend("dimension" = "that of the field"))]
    pub range: Option<At<[f64; 2]>>,
    /// Name of a vector field that is drawn as arrows over the colours, in 2-D and 3-D: displacement, velocity, …; none when left
    /// out.
    pub arrows: Option<At<String>>,
    /// All frames as an animated PNG, too: FIELD_film.png.
    #[serde(default)]
    pub film: bool,
}
