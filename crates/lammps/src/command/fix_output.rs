//! `fix print`, `fix ave/time`.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use super::Args;
use super::thermo::number_format;
use crate::error::{Problem, Result};
use crate::fix::FixKind;
use crate::fix::average::{Ave, Average, Source};
use crate::printf::Format;
use crate::session::Session;
use crate::text::Word;
use crate::thermo::columns::Column;

/// Steps that anybody takes.
const MOST_STEPS: u64 = 1 << 52;

impl Session<'_> {
    /// `N "text" [file|append NAME] [screen yes|no] [title TEXT]`
    pub(super) fn fix_print(&mut self, args: &mut Args, id: &str) -> Result<FixKind> {
        let every = args.count("the number of steps", 1)?;
        let text = args.next("a text in quotes")?.as_str().to_string();
        let (mut screen, mut file, mut title) = (true, None, None);
        while let Some(word) = args.optional() {
            match word.as_str() {
                "file" | "append" => {
                    file = Some((args.next("a file name")?, word.as_str() == "append"));
                }
                "screen" => screen = args.yes("screen")?,
                "title" => title = Some(args.next("a title")?.as_str().to_string()),
                _ => {
                    let known = ["file", "append", "screen", "title"];
                    return Err(args.unknown(word, "the option", known));
                }
            }
        }
        let file = match file {
            None => None,
            Some((name, append)) => {
                let opened = self.folder.open(name.as_str(), append);
                let mut sink = opened.map_err(|p| p.or_at(name.span))?;
                let title = title.unwrap_or_else(|| format!("# Fix print output for fix {id}"));
                sink.line(&title)?;
                sink.flush()?;
                Some(Rc::new(RefCell::new(sink)))
            }
        };
        Ok(FixKind::Print {
            every,
            text,
            screen,
            file,
        })
    }

    /// `EVERY REPEAT FREQUENCY values... [options]`
    pub(super) fn average(&mut self, args: &mut Args, id: &str) -> Result<Average> {
        let every = args.count("every so many steps a sample", 1)?;
        let repeat = args.count("the number of samples of a mean", 1)?;
        let frequency = args.count("every so many steps a mean", 1)?;
        if frequency > MOST_STEPS {
            return Err(Problem::new(format!(
                "`fix ave/time`: {frequency} steps are more than {MOST_STEPS}"
            )));
        }
        if !frequency.is_multiple_of(every) || repeat.saturating_mul(every) > frequency.max(every) {
            return Err(Problem::new(format!(
                "`fix ave/time {every} {repeat} {frequency}`: {repeat} samples, {every} steps apart, do not fit into {frequency} steps"
            ))
            .help("the third number must be a multiple of the first, and not less than the product of the first two"));
        }
        let mut words = Vec::new();
        while let Some(word) = args
            .peek()
            .filter(|w| ["c_", "f_", "v_"].iter().any(|p| w.starts_with(p)))
        {
            words.push(word.to_string());
            args.optional();
        }
        if words.is_empty() {
            args.next("a value: c_ID, c_ID[i], f_ID, f_ID[i] or v_name")?;
        }
        let options = Options::read(args, words.len())?;
        let vector = options.vector;
        let mut inputs = Vec::new();
        for (word, plain) in words.iter().zip(&options.plain) {
            let column = Column::parse(word)?;
            if vector {
                self.column_vector(&column).map(drop).or_else(later)?;
            } else {
                self.check_column(&column)?;
            }
            inputs.push(Source {
                column,
                plain: *plain,
            });
        }
        let file = match options.file {
            None => None,
            Some(name) => {
                let opened = self.folder.open(name.as_str(), false);
                let mut sink = opened.map_err(|p| p.or_at(name.span))?;
                let [first, second, third] = options.titles;
                let all = words.join(" ");
                sink.line(&first.unwrap_or_else(|| format!("# Time-averaged data for fix {id}")))?;
                let default = if vector {
                    "# TimeStep Number-of-rows".to_string()
                } else {
                    format!("# TimeStep {all}")
                };
                sink.line(&second.unwrap_or(default))?;
                if vector {
                    sink.line(&third.unwrap_or_else(|| format!("# Row {all}")))?;
                }
                sink.flush()?;
                Some(sink)
            }
        };
        Ok(Average {
            inputs,
            vector,
            every,
            repeat,
            frequency,
            ave: options.ave,
            next: Average::first(every, repeat, frequency, self.progress.step, options.start),
            taken: 0,
            sum: Vec::new(),
            total: Vec::new(),
            outputs: 0,
            window: VecDeque::new(),
            result: Vec::new(),
            format: options.format,
            file,
        })
    }
}

/// What may be said after the values of `fix ave/time`.
struct Options<'a> {
    vector: bool,
    ave: Ave,
    start: u64,
    file: Option<&'a Word>,
    titles: [Option<String>; 3],
    format: Format,
    /// Of each value: is it taken as it is, without a mean?
    plain: Vec<bool>,
}

impl<'a> Options<'a> {
    fn read(args: &mut Args<'a>, values: usize) -> Result<Options<'a>> {
        let mut all = Options {
            vector: false,
            ave: Ave::One,
            start: 0,
            file: None,
            titles: [None, None, None],
            format: Format::parse(" %g").map_err(Problem::new)?,
            plain: vec![false; values],
        };
        while let Some(word) = args.optional() {
            match word.as_str() {
                "mode" => all.vector = is_vector(args)?,
                "ave" => all.ave = ave(args)?,
                "start" => all.start = args.count("a step", 0)?.min(MOST_STEPS),
                "off" => {
                    let k = args.count("the number of a value", 1)? as usize;
                    match all.plain.get_mut(k - 1) {
                        Some(slot) => *slot = true,
                        None => {
                            return Err(Problem::at(
                                word.span,
                                format!("there are {} values, not {k}", values),
                            ));
                        }
                    }
                }
                "file" => all.file = Some(args.next("a file name")?),
                "format" => all.format = number_format(args.next("a format")?)?,
                "title1" => all.titles[0] = Some(args.next("a title")?.as_str().to_string()),
                "title2" => all.titles[1] = Some(args.next("a title")?.as_str().to_string()),
                "title3" => all.titles[2] = Some(args.next("a title")?.as_str().to_string()),
                _ => {
                    let known = [
                        "mode", "ave", "start", "off", "file", "format", "title1", "title2",
                        "title3",
                    ];
                    return Err(args.unknown(word, "the option", known));
                }
            }
        }
        Ok(all)
    }
}

fn is_vector(args: &mut Args) -> Result<bool> {
    let mode = args.next("scalar or vector")?;
    match mode.as_str() {
        "scalar" => Ok(false),
        "vector" => Ok(true),
        _ => Err(args.unknown(mode, "the mode", ["scalar", "vector"])),
    }
}

/// Which mean.
fn ave(args: &mut Args) -> Result<Ave> {
    let how = args.next("one, running or window")?;
    match how.as_str() {
        "one" => Ok(Ave::One),
        "running" => Ok(Ave::Running),
        "window" => Ok(Ave::Window(args.count("the number of means", 1)? as usize)),
        _ => Err(args.unknown(how, "the mean", ["one", "running", "window"])),
    }
}

/// What does not exist before the first run may be asked for later.
fn later(problem: Box<Problem>) -> Result<()> {
    match problem.help.as_deref() {
        Some("write `run 0` before" | "write `run 0` first") => Ok(()),
        _ => Err(problem),
    }
}
