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
        let (mut vector, mut ave, mut start) = (false, Ave::One, 0);
        let (mut file, mut titles) = (None, [None, None, None]);
        let mut format = Format::parse(" %g").map_err(Problem::new)?;
        let mut plain = vec![false; words.len()];
        while let Some(word) = args.optional() {
            match word.as_str() {
                "mode" => {
                    let mode = args.next("scalar or vector")?;
                    vector = match mode.as_str() {
                        "scalar" => false,
                        "vector" => true,
                        _ => return Err(args.unknown(mode, "the mode", ["scalar", "vector"])),
                    };
                }
                "ave" => {
                    let how = args.next("one, running or window")?;
                    ave = match how.as_str() {
                        "one" => Ave::One,
                        "running" => Ave::Running,
                        "window" => Ave::Window(args.count("the number of means", 1)? as usize),
                        _ => {
                            return Err(args.unknown(
                                how,
                                "the mean",
                                ["one", "running", "window"],
                            ));
                        }
                    };
                }
                "start" => start = args.count("a step", 0)?.min(MOST_STEPS),
                "off" => {
                    let k = args.count("the number of a value", 1)? as usize;
                    match plain.get_mut(k - 1) {
                        Some(slot) => *slot = true,
                        None => {
                            return Err(Problem::at(
                                word.span,
                                format!("there are {} values, not {k}", words.len()),
                            ));
                        }
                    }
                }
                "file" => file = Some(args.next("a file name")?),
                "format" => format = number_format(args.next("a format")?)?,
                "title1" => titles[0] = Some(args.next("a title")?.as_str().to_string()),
                "title2" => titles[1] = Some(args.next("a title")?.as_str().to_string()),
                "title3" => titles[2] = Some(args.next("a title")?.as_str().to_string()),
                _ => {
                    let known = [
                        "mode", "ave", "start", "off", "file", "format", "title1", "title2",
                        "title3",
                    ];
                    return Err(args.unknown(word, "the option", known));
                }
            }
        }
        let mut inputs = Vec::new();
        for (word, plain) in words.iter().zip(plain) {
            let column = Column::parse(word)?;
            if vector {
                self.column_vector(&column).map(drop).or_else(later)?;
            } else {
                self.check_column(&column)?;
            }
            inputs.push(Source { column, plain });
        }
        let file = match file {
            None => None,
            Some(name) => {
                let opened = self.folder.open(name.as_str(), false);
                let mut sink = opened.map_err(|p| p.or_at(name.span))?;
                let [first, second, third] = titles;
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
            ave,
            next: Average::first(every, repeat, frequency, self.progress.step, start),
            taken: 0,
            sum: Vec::new(),
            total: Vec::new(),
            outputs: 0,
            window: VecDeque::new(),
            result: Vec::new(),
            format,
            file,
        })
    }
}

/// What does not exist before the first run may be asked for later.
fn later(problem: Box<Problem>) -> Result<()> {
    match problem.help.as_deref() {
        Some("write `run 0` before" | "write `run 0` first") => Ok(()),
        _ => Err(problem),
    }
}
