//! A film of the frames of a run, as an animated PNG or GIF. Frames wait in a file of their own, small, until the run has ended: then
//! the ends of the colours are known, and how many frames there are.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::time::Duration;

use peridyne::columns::Declaration;
use peridyne::observe::{Column, Snapshot, Values};
use peridyne::space::Point;
use peridyne::space::rotation::Axes;
use peridyne::state::{Archive, Owner};

use super::super::Grown;
use super::super::atomic::{WriteError, create_directory, write_file};
use super::animate::{FilmFormat, animate};
use super::arrows::Arrows;
use super::rigid::{Form, Placed};
use super::shown::{About, Shown, range};
use super::{PictureOptions, Sight, draw, invalid};

/// Width of a frame (pixels); narrower than a picture, so that a film stays small.
const WIDTH: usize = 960;

/// Frames so far.
#[derive(Debug)]
pub struct Film {
    waiting: Grown,
    same: Option<Same>,
    /// Lowest and highest value so far, and the longest arrow.
    ends: [f64; 2],
    longest: f64,
    /// Step and time.
    frames: Vec<(u64, f64)>,
    /// Of each the rigid bodies: which of these forms they have, centres and axes.
    bodies: Vec<Vec<(u32, (Point, Axes))>>,
    forms: Vec<Form>,
}

/// What is the same in all frames.
#[derive(Debug)]
struct Same {
    /// A snapshot without columns.
    still: Snapshot,
    /// Name, dimension and colours of what is shown; the values are those of some frame.
    shown: Shown,
    /// Name and dimension of what is drawn as arrows, the same.
    arrows: Option<Arrows>,
}

impl Same {
    fn of(s: &Snapshot, options: &PictureOptions) -> io::Result<Same> {
        let component = options.component.as_deref();
        let arrows = options.arrows.as_deref();
        Ok(Same {
            shown: Shown::of(s, options.field(About::Motion), component)?,
            arrows: arrows.map(|field| Arrows::of(s, field)).transpose()?,
            still: Snapshot {
                columns: vec![],
                bonds: None,
                ..s.clone()
            },
        })
    }
}

impl Owner for Film {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.part("waiting", &mut self.waiting);
        archive.one("ends", &mut self.ends);
        archive.one("longest", &mut self.longest);
        archive.list("frames", &mut self.frames);
        archive.lists("bodies", &mut self.bodies);
        archive.items(
            "forms",
            &mut self.forms,
            || Form::Ball(0.0),
            |form, a| {
                form.archive(a);
            },
        );
        let forms = self.forms.len();
        let known = self.bodies.iter().flatten().all(|b| (b.0 as usize) < forms);
        if archive.loads() && !(known && self.bodies.len() == self.frames.len()) {
            archive.refuse("bodies");
        }
    }
}

impl Film {
    /// Of frames that wait in this file, whose folder is made.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn new(waiting: &Path) -> Result<Film, WriteError> {
        waiting.parent().map_or(Ok(()), create_directory)?;
        Grown::create(waiting, b"").map(Film::of)
    }

    /// Of a run that goes on; its state must be read, and [`rewind`](Film::rewind) called, before a frame comes.
    ///
    /// # Errors
    /// There is no such file.
    pub fn reopen(waiting: &Path) -> Result<Film, WriteError> {
        Grown::open(waiting).map(Film::of)
    }

    fn of(waiting: Grown) -> Film {
        Film {
            waiting,
            same: None,
            ends: [f64::INFINITY, f64::NEG_INFINITY],
            longest: 0.0,
            frames: vec![],
            bodies: vec![],
            forms: vec![],
        }
    }

    /// Takes away what came after the state that was read; this is the snapshot of that state.
    ///
    /// # Errors
    /// The operating system's; what is left is not what was written.
    pub fn rewind(&mut self, now: &Snapshot, options: &PictureOptions) -> Result<(), WriteError> {
        self.waiting.rewind()?;
        if !self.frames.is_empty() {
            let same = Same::of(now, options);
            self.same = Some(same.map_err(WriteError::at("draw", self.waiting.path()))?);
        }
        Ok(())
    }

    /// The next frame; one of the step of the last is left out.
    ///
    /// # Errors
    /// The snapshot carries no such field, or the disk is full.
    pub fn push(
        &mut self,
        s: &Snapshot,
        bodies: &[Placed],
        options: &PictureOptions,
    ) -> Result<(), WriteError> {
        if self.frames.last().is_some_and(|(step, _)| *step == s.step) {
            return Ok(());
        }
        let now = Same::of(s, options).map_err(WriteError::at("draw", self.waiting.path()))?;
        let arrows = now.arrows.as_ref();
        self.waiting.push(|w| {
            for (u, value) in s.displacement().iter().zip(&now.shown.values) {
                for number in [u[0], u[1], u[2], *value] {
                    w.write_all(&(number as f32).to_le_bytes())?;
                }
            }
            let arrows = arrows.iter().flat_map(|a| a.vectors.iter().flatten());
            arrows
                .map(|x| (*x as f32).to_le_bytes())
                .try_for_each(|x| w.write_all(&x))
        })?;
        let [low, high] = now.shown.ends;
        self.ends = [self.ends[0].min(low), self.ends[1].max(high)];
        self.longest = self.longest.max(arrows.map_or(0.0, |a| a.longest));
        self.same = Some(now);
        self.frames.push((s.step, s.time));
        let placed = bodies.iter().map(|body| {
            let known = self.forms.iter().position(|form| *form == body.form);
            let n = known.unwrap_or_else(|| {
                self.forms.push(body.form.clone());
                self.forms.len() - 1
            });
            (n as u32, (body.center, body.axes))
        });
        let placed = placed.collect();
        self.bodies.push(placed);
        Ok(())
    }

    /// Bytes of a frame of so many points that waits.
    pub fn bytes(points: u64, arrows: bool) -> f64 {
        4.0 * NUMBERS[usize::from(arrows)] as f64 * points as f64
    }

    /// Writes the film, if there was a frame: of all, or of at most so many of them, as evenly as they come.
    ///
    /// # Errors
    /// A file could not be written.
    pub fn finish(
        self,
        path: &Path,
        field: &str,
        options: &PictureOptions,
        scale: f64,
        (format, most): (FilmFormat, Option<usize>),
    ) -> Result<(), WriteError> {
        let Some(mut same) = self.same else {
            return Ok(());
        };
        let failed = WriteError::at("draw", self.waiting.path());
        let file = File::open(self.waiting.path()).map_err(failed)?;
        let ends = options
            .range
            .unwrap_or_else(|| range(field, self.ends[0], self.ends[1]));
        let options = PictureOptions {
            width: WIDTH,
            ..options.clone()
        };
        let forms = &self.forms;
        let bodies = self.bodies.iter().map(|bodies| {
            let placed = bodies.iter().map(|(form, (center, axes))| Placed {
                form: forms[*form as usize].clone(),
                center: *center,
                axes: *axes,
            });
            placed.collect()
        });
        let frames: Vec<Frame> = self.frames.iter().copied().zip(bodies).collect();
        same.shown = same.shown.between(ends);
        if let Some(arrows) = &mut same.arrows {
            arrows.longest = self.longest;
        }
        let step = stride(frames.len(), most);
        let sight = same.sight(&file, &frames, scale);
        let (sight, mut waiting) = sight.map_err(WriteError::at("draw", path))?;
        let images = frames.iter().enumerate().filter_map(|(n, (when, bodies))| {
            let (snapshot, shown, arrows) = match same.next(&mut waiting, *when) {
                Ok(next) => next,
                Err(e) => return Some(Err(e)),
            };
            let what = (&shown, arrows.as_ref());
            let drawn = n.is_multiple_of(step);
            drawn.then(|| Ok(draw(&snapshot, bodies, what, &sight, &options)))
        });
        let count = frames.len().div_ceil(step);
        write_file(path, |w| animate(w, format, count, images))
    }
}

/// Numbers of a point that wait: displacement and what is shown, and an arrow.
const NUMBERS: [usize; 2] = [4, 7];

/// Which of so many frames are drawn, where at most some may be: every so many-th.
pub fn stride(frames: usize, most: Option<usize>) -> usize {
    most.map_or(1, |most| frames.div_ceil(most.max(1)).max(1))
}

/// Time for drawing films of a run that was ended from outside: who ends it waits for some seconds only.
pub const HURRY: Duration = Duration::from_secs(2);

/// Step and time of a frame, and its rigid bodies.
type Frame = ((u64, f64), Vec<Placed>);

/// From the first frame that waits.
fn rewound(mut file: &File) -> io::Result<BufReader<&File>> {
    file.seek(SeekFrom::Start(0))?;
    Ok(BufReader::new(file))
}

/// Numbers of a frame that wait, component after component.
fn numbers(waiting: &mut impl Read, count: usize) -> io::Result<Vec<f64>> {
    let mut bytes = vec![0u8; 4 * count];
    waiting.read_exact(&mut bytes)?;
    let number = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    Ok(bytes.chunks_exact(4).map(number).collect())
}

impl Same {
    /// Of all frames, so that camera and limits stand still; and the frames again from the first.
    fn sight<'f>(
        &self,
        file: &'f File,
        frames: &[Frame],
        scale: f64,
    ) -> io::Result<(Sight, BufReader<&'f File>)> {
        let mut waiting = rewound(file)?;
        let mut all: Option<Sight> = None;
        for (when, bodies) in frames {
            let (snapshot, shown, _) = self.next(&mut waiting, *when)?;
            let own = Sight::of(&snapshot, bodies, &shown, scale);
            all = Some(match all {
                Some(sight) => sight.with(&own),
                None => own,
            });
        }
        let all = all.ok_or_else(|| invalid("a film has frames".into()))?;
        Ok((all, rewound(file)?))
    }

    /// The next frame of those that wait.
    fn next(
        &self,
        waiting: &mut impl Read,
        (step, time): (u64, f64),
    ) -> io::Result<(Snapshot, Shown, Option<Arrows>)> {
        let points = self.still.reference.len();
        let each = numbers(waiting, 4 * points)?;
        let each = each.chunks_exact(4);
        let displacement = Column {
            declaration: Declaration::of_points(
                "displacement",
                peridyne::columns::Shape::Vector,
                peridyne::columns::Dimension::LENGTH,
                "",
            ),
            values: Values::Vectors(each.clone().map(|e| [e[0], e[1], e[2]]).collect()),
        };
        let snapshot = Snapshot {
            step,
            time,
            columns: vec![displacement],
            ..self.still.clone()
        };
        let shown = Shown {
            values: each.map(|e| e[3]).collect(),
            ..self.shown.clone()
        };
        let mut arrows = self.arrows.clone();
        if let Some(arrows) = &mut arrows {
            let vectors = numbers(waiting, 3 * points)?;
            let vectors = vectors.chunks_exact(3);
            arrows.vectors = vectors.map(|v| [v[0], v[1], v[2]]).collect();
        }
        Ok((snapshot, shown, arrows))
    }
}
