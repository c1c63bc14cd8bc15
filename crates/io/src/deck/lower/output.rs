//! What a run writes: what `[output]` asks for, and what is made of it.

use super::context::{Context, Result};
use crate::deck::document::{Checkpoint, Output, Picture, SpaceTimes};
use crate::deck::quantity::Measure;
use crate::deck::units::clock_time;
use crate::deck::value::{At, Or, Quantity};
use crate::write::checkpoint::CheckpointSchedule;
use crate::write::folder::stays;
use crate::write::picture::animate::FilmFormat;
use crate::write::space_time::Window;
use crate::write::trajectory::Format;
use std::path::PathBuf;

/// What a run writes.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSpec {
    /// Folder; `None`: chosen by the caller.
    pub dir: Option<PathBuf>,
    /// Steps between frames; `None`: first and last state.
    pub every: Option<u64>,
    /// Or how many frames there are after the first.
    pub frames: Option<u64>,
    /// VTU series with PVD.
    pub vtu: bool,
    /// Exodus II file of this name.
    pub exodus: Option<PathBuf>,
    /// VTKHDF file of this name.
    pub vtkhdf: Option<PathBuf>,
    /// Unbroken bonds in the VTU.
    pub bonds: bool,
    /// The linear body about the last state.
    pub linear_body: bool,
    /// Write `fragments.csv` of the last state.
    pub fragments: bool,
    /// LAMMPS dump of points of this name; that of atoms is a trajectory.
    pub dump: Option<PathBuf>,
    /// Steps between rows of `history.csv`; `None`: chosen by the caller.
    pub history: Option<u64>,
    /// Pictures of the last state.
    pub pictures: Vec<PictureSpec>,
    /// Fields of a body on a line over place and time.
    pub space_time: Vec<SpaceTimeSpec>,
    /// `report.html` at the end.
    pub report: bool,
    /// Files of all frames of atoms.
    pub trajectories: Vec<(PathBuf, Format)>,
    /// LAMMPS data file of the last state of atoms.
    pub data: Option<PathBuf>,
    /// When states to go on from are written; `None`: only where a run is ended early.
    pub checkpoints: Option<CheckpointSchedule>,
    /// Keys whose names lead out of the folder they belong in, and the names.
    pub outside: Vec<(&'static str, String)>,
}

impl OutputSpec {
    /// Leaves histories and states to go on from, and nothing else.
    pub fn quiet(&mut self) {
        *self = OutputSpec {
            dir: self.dir.take(),
            every: None,
            frames: None,
            vtu: false,
            exodus: None,
            vtkhdf: None,
            bonds: false,
            linear_body: false,
            fragments: false,
            dump: None,
            history: self.history,
            pictures: vec![],
            space_time: vec![],
            report: false,
            trajectories: vec![],
            data: None,
            checkpoints: self.checkpoints.take(),
            outside: vec![],
        };
    }

    /// Steps between frames of a run of `steps`; `None`: first and last state.
    pub fn every(&self, steps: u64) -> Option<u64> {
        let shared = |frames: u64| steps.div_ceil(frames).max(1);
        self.every.or(self.frames.map(shared))
    }
}

/// A picture that a deck asks for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PictureSpec {
    /// `None`: what the run is about.
    pub field: Option<String>,
    pub component: Option<String>,
    pub scale: Option<f64>,
    /// Plain numbers of the deck.
    pub range: Option<[f64; 2]>,
    /// A vector field.
    pub arrows: Option<String>,
    pub film: Option<FilmFormat>,
}

/// A field over place and time that a deck asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceTimeSpec {
    /// [`DENSITY`](crate::write::space_time::DENSITY) or a field of points.
    pub field: String,
    pub component: Option<String>,
    /// Plain numbers of the deck.
    pub range: Option<[f64; 2]>,
    pub window: Window,
}

impl SpaceTimeSpec {
    /// The whole of a field.
    pub fn of(field: String) -> SpaceTimeSpec {
        SpaceTimeSpec {
            field,
            component: None,
            range: None,
            window: Window::default(),
        }
    }
}

pub(super) fn output(
    context: &Context,
    written: &Output,
    [atoms, moves]: [bool; 2],
) -> Result<OutputSpec> {
    let positive = |number: &Option<At<u64>>, what: &str| match number {
        Some(n) if n.value == 0 => Err(context.error_with(
            &n.span,
            format!("{what} counts steps from 1"),
            "leave it out to get the ends only",
        )),
        other => Ok(other.as_ref().map(|n| n.value)),
    };
    let data = match &written.data {
        Some(name) if !atoms => {
            return Err(context.error_with(
                &name.span,
                "a LAMMPS data file is one of atoms",
                "points have VTU series and dumps: output.vtu, output.dump",
            ));
        }
        name => name.as_ref().map(|n| n.value.clone().into()),
    };
    if let (Some(_), Some(frames)) = (&written.every, &written.frames) {
        return Err(context.error_with(
            &frames.span,
            "every says how often there are frames, and frames says how many",
            "keep one of them",
        ));
    }
    if let Some(name) = &written.exodus {
        let ends = [".e", ".exo", ".ex2"];
        if !ends.iter().any(|end| name.value.ends_with(end)) {
            return Err(context.error_with(
                &name.span,
                format!("an Exodus file is called .e or .exo, not {:?}", name.value),
                "name it results.e",
            ));
        }
    }
    if let Some(name) = &written.vtkhdf
        && !name.value.ends_with(".vtkhdf")
    {
        return Err(context.error_with(
            &name.span,
            format!("a VTKHDF file is called .vtkhdf, not {:?}", name.value),
            "name it results.vtkhdf",
        ));
    }
    super::names::distinct(context, written)?;
    let checkpoints = checkpoints(context, written)?;
    let names = [
        ("dir", written.dir.as_ref()),
        ("dump", written.dump.as_ref().map(|n| &n.value)),
        ("exodus", written.exodus.as_ref().map(|n| &n.value)),
        ("vtkhdf", written.vtkhdf.as_ref().map(|n| &n.value)),
        ("trajectory", written.trajectory.as_ref().map(|n| &n.value)),
        ("data", written.data.as_ref().map(|n| &n.value)),
    ];
    let outside = names
        .into_iter()
        .filter_map(|(key, name)| Some((key, name?.clone())))
        .filter(|(_, name)| !stays(name.as_ref()))
        .collect();
    let mut pictures = vec![];
    if written
        .picture
        .unwrap_or(!atoms && written.pictures.is_empty())
    {
        pictures.push(PictureSpec::default());
    }
    for picture in &written.pictures {
        pictures.push(self::picture(context, picture)?);
    }
    Ok(OutputSpec {
        outside,
        dir: written.dir.clone().map(Into::into),
        every: positive(&written.every, "every")?,
        frames: positive(&written.frames, "frames")?,
        vtu: written.vtu.unwrap_or(true),
        exodus: written.exodus.as_ref().map(|n| n.value.clone().into()),
        vtkhdf: written.vtkhdf.as_ref().map(|n| n.value.clone().into()),
        bonds: written.bonds,
        linear_body: written.linear_body,
        fragments: written.fragments,
        dump: written
            .dump
            .as_ref()
            .filter(|_| !atoms)
            .map(|n| n.value.clone().into()),
        history: positive(&written.history, "history")?,
        pictures,
        space_time: space_times(context, written, moves)?,
        report: written.report.unwrap_or(true),
        checkpoints,
        trajectories: trajectories(context, written, atoms)?,
        data,
    })
}

/// Files of all frames of atoms.
fn trajectories(
    context: &Context,
    written: &Output,
    atoms: bool,
) -> Result<Vec<(PathBuf, Format)>> {
    let mut trajectories: Vec<(PathBuf, Format)> = Vec::new();
    trajectories.extend(match &written.trajectory {
        None => None,
        Some(name) if !atoms => {
            return Err(context.error_with(
                &name.span,
                "a trajectory is one of atoms",
                "points have VTU series and dumps: output.vtu, output.dump",
            ));
        }
        Some(name) if name.value.ends_with(".extxyz") || name.value.ends_with(".xyz") => {
            Some((name.value.clone().into(), Format::Extxyz))
        }
        Some(name) if name.value.ends_with(".lammpstrj") || name.value.ends_with(".dump") => {
            Some((name.value.clone().into(), Format::Dump))
        }
        Some(name) => {
            return Err(context.error_with(
                &name.span,
                format!("unknown kind of trajectory {:?}", name.value),
                "name it trajectory.extxyz or trajectory.lammpstrj",
            ));
        }
    });
    if let Some(name) = written.dump.as_ref().filter(|_| atoms) {
        trajectories.push((PathBuf::from(&name.value), Format::Dump));
    }
    Ok(trajectories)
}

/// When states are written.
///
/// # Errors
/// A time that is none, or not a single one stays.
fn checkpoints(context: &Context, written: &Output) -> Result<Option<CheckpointSchedule>> {
    let mut schedule = CheckpointSchedule::default();
    match written.checkpoint.as_ref().map(|at| &at.value) {
        Some(Or::Bare(false)) => return Ok(None),
        None | Some(Or::Bare(true)) => {}
        Some(Or::Table(Checkpoint { every, keep })) => {
            if let Some(every) = every {
                schedule.every = clock_time(&every.value).map_err(|why| {
                    context.error_with(&every.span, why, "write every = \"10 min\"")
                })?;
            }
            match keep {
                Some(keep) if keep.value == 0 => {
                    return Err(context.error_with(
                        &keep.span,
                        "no state stays",
                        "write keep = 1 or more, or checkpoint = false",
                    ));
                }
                Some(keep) => schedule.keep = keep.value as usize,
                None => {}
            }
        }
    }
    Ok(Some(schedule))
}

/// Fields over place and time.
///
/// # Errors
/// The body lies on no line, or nothing moves; a range is none.
fn space_times(context: &Context, written: &Output, moves: bool) -> Result<Vec<SpaceTimeSpec>> {
    let (mut named, mut given) = (vec![], vec![]);
    match &written.space_time {
        None => return Ok(vec![]),
        Some(at) => {
            let refused = match (context.dimension, moves) {
                (1, true) => None,
                (1, false) => Some((
                    "space_time is a field over time, and in statics there is none",
                    "give the deck a [run], or leave space_time out",
                )),
                _ => Some((
                    "space_time is a field over one axis and time, and this body has more axes",
                    "leave it out: pictures with film = true show a body in the plane or in space over time",
                )),
            };
            if let Some((why, help)) = refused {
                return Err(context.error_with(&at.span, why, help));
            }
            match &at.value {
                Or::Bare(SpaceTimes::Field(field)) => named.push(field.clone()),
                Or::Bare(SpaceTimes::All(all)) => given.extend(all.iter().map(|at| &at.value)),
                Or::Table(one) => given.push(one),
            }
        }
    }
    let mut all: Vec<SpaceTimeSpec> = named.into_iter().map(SpaceTimeSpec::of).collect();
    for one in given {
        all.push(SpaceTimeSpec {
            component: one.component.as_ref().map(|c| c.value.clone()),
            range: colours(context, one.range.as_ref())?,
            window: Window {
                x: ends(context, &one.x, "x")?,
                t: ends(context, &one.t, "t")?,
            },
            ..SpaceTimeSpec::of(one.field.value.clone())
        });
    }
    Ok(all)
}

/// From where to where a space-time picture goes.
fn ends<K: Measure>(
    context: &Context,
    ends: &Option<At<[Quantity<K>; 2]>>,
    what: &str,
) -> Result<[f64; 2]> {
    let Some(at) = ends else {
        return Ok([f64::NEG_INFINITY, f64::INFINITY]);
    };
    let [low, high] = &at.value;
    let ends = [context.limit(low)?, context.limit(high)?];
    match ends[0] < ends[1] {
        true => Ok(ends),
        false => Err(context.error(
            &at.span,
            format!("{what} of space_time is [from, to], of which the first is lower"),
        )),
    }
}

/// Ends of the colours of a picture.
fn colours(context: &Context, range: Option<&At<[f64; 2]>>) -> Result<Option<[f64; 2]>> {
    if let Some(range) = range
        && !(range.value[0] < range.value[1] && range.value.iter().all(|x| x.is_finite()))
    {
        let message =
            "the range of a picture is [low, high], two numbers of which the first is lower";
        return Err(context.error(&range.span, message));
    }
    Ok(range.map(|r| r.value))
}

fn picture(context: &Context, at: &At<Picture>) -> Result<PictureSpec> {
    let p = &at.value;
    let scale = p.scale.as_ref();
    let scale = scale.map(|s| context.value(s));
    let text = |t: &Option<At<String>>| t.as_ref().map(|t| t.value.clone());
    Ok(PictureSpec {
        field: text(&p.field),
        component: text(&p.component),
        scale: scale.transpose()?,
        range: colours(context, p.range.as_ref())?,
        arrows: text(&p.arrows),
        film: p.film.0,
    })
}
