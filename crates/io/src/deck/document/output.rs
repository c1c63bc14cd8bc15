//! What is written.

use crate::deck::quantity::{Length, Positive, Time};
use crate::deck::value::{At, Or, Quantity};
use crate::write::picture::animate::FilmFormat;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};
use std::borrow::Cow;
use std::fmt;

/// Which files a run writes, how often, and with which fields.
#[derive(Debug, Default, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Folder of the results, relative to the deck; out/NAME for NAME.toml, in the working folder, by default.
    pub dir: Option<String>,
    /// Steps between frames; only the first and the last state by default.
    pub every: Option<At<u64>>,
    /// Frames after the first, evenly in steps, in place of `every`; one fewer or a few fewer where steps are no multiple.
    pub frames: Option<At<u64>>,
    /// Point fields of a frame, by name (`peridyne laws` lists them), displacements always; displacement, velocity, damage,
    /// energy_density, dilatation, block by default.
    pub fields: Option<Vec<At<String>>>,
    /// VTU series for ParaView; true by default.
    pub vtu: Option<bool>,
    /// Exodus II file of this name (.e), in the folder of the results: all frames with their fields, for ParaView and the tools of
    /// Sandia.
    pub exodus: Option<At<String>>,
    /// VTKHDF file of this name (.vtkhdf), in the folder of the results: the points of all frames with their fields in one file, as the VTU
    /// series has them, for ParaView, pyvista and h5py; `vtu = false` leaves the series out.
    pub vtkhdf: Option<At<String>>,
    /// Intact bonds as lines, too.
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
    /// Steps between rows of history.csv; a hundredth of the run by default.
    pub history: Option<At<u64>>,
    /// PNG of the last state, named after the field that it shows: damage if bonds broke, else displacement in statics and velocity in
    /// motion. By default true, and false for atoms or where pictures are listed.
    pub picture: Option<bool>,
    /// Pictures of fields of your choice.
    #[serde(default)]
    pub pictures: Vec<At<Picture>>,
    /// Bodies on a line that move: a field over x of the reference and t, which goes down, as space_time_FIELD.png and .svg, its numbers as
    /// space_time_FIELD.npz. "density" is 1/y', reference over current distance of the points beside a point; or the name of a field of points.
    /// Of several a list of tables.
    pub space_time: Option<At<Or<SpaceTimes, SpaceTime>>>,
    /// report.html at the end, the run in one file for browsers; true by default.
    pub report: Option<bool>,
    /// How often a state is written from which `peridyne resume` goes on, in the folder `checkpoint` of the results: { every = "10 min",
    /// keep = 2 } by default, so that runs which are shorter write none; false: only where a run is ended early.
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
    /// Time on the clock of the machine between two, such as "10 min" or "2 h"; 10 min by default.
    pub every: Option<At<String>>,
    /// How many stay, the newest; 2 by default.
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
    /// xx, … of a tensor; of vectors x, of tensors the magnitude by default.
    pub component: Option<At<String>>,
    /// What the ends of the colours mean, in plain numbers of the field; by default those of its values, of the density as far from 1 on
    /// either side.
    #[schemars(extend("dimension" = "that of the field"))]
    pub range: Option<At<[f64; 2]>>,
    /// From where to where in the reference; the whole body by default.
    pub x: Option<At<[Quantity<Length>; 2]>>,
    /// From when to when; the whole motion by default.
    pub t: Option<At<[Quantity<Time>; 2]>>,
}

/// A PNG of a field at the end, FIELD.png or FIELD_COMPONENT.png, with cracks, rigid bodies, supports and loads.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    /// Name of a field of points (`peridyne laws` lists them); by default what the run is about, as `picture` says.
    pub field: Option<At<String>>,
    /// x, xy, … or magnitude; the magnitude by default.
    pub component: Option<At<String>>,
    /// Displacements are drawn so many times as large; by default 1, in statics so that they are seen.
    pub scale: Option<Quantity<Positive>>,
    /// What the ends of the colours mean, in plain numbers of the field; those of its values by default.
    #[schemars(extend("dimension" = "that of the field"))]
    pub range: Option<At<[f64; 2]>>,
    /// Name of a vector field that is drawn as arrows over the colours, in 2-D and 3-D: displacement, velocity, …; none by
    /// default.
    pub arrows: Option<At<String>>,
    /// All frames as a film, too: true or "png" for an animated PNG, FIELD_film.png, "gif" for FIELD_film.gif.
    #[serde(default)]
    pub film: Film,
}

/// Whether there is a film, and what it is written as.
#[derive(Debug, Clone, Copy, Default)]
pub struct Film(pub Option<FilmFormat>);

impl<'de> Deserialize<'de> for Film {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Asked;
        impl Visitor<'_> for Asked {
            type Value = Film;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("true or false, \"png\" or \"gif\"")
            }
            fn visit_bool<E: serde::de::Error>(self, v: bool) -> Result<Film, E> {
                Ok(Film(v.then_some(FilmFormat::Png)))
            }
            fn visit_str<E: serde::de::Error>(self, v: &str) -> Result<Film, E> {
                let known = [FilmFormat::Png, FilmFormat::Gif];
                let found = known.into_iter().find(|format| format.ending() == v);
                found
                    .map(|format| Film(Some(format)))
                    .ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(v), &self))
            }
        }
        deserializer.deserialize_any(Asked)
    }
}

impl JsonSchema for Film {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "Film".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "boolean" }, { "enum": ["png", "gif"] }] })
    }
}
