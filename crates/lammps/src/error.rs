//! What is wrong with a script, and where.

use miette::SourceSpan;
use peridyne_io::excerpt::Excerpt;
use peridyne_io::read::lammps::FileError;

/// A mistake in a script or in a file that it reads; `miette` prints it with the source line and a caret.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[error("{path}:{line}: {message}")]
pub struct ScriptError {
    /// File as the user named it.
    pub path: String,
    /// Line of `path`, from 1 (0: the file as a whole).
    pub line: usize,
    pub message: String,
    #[help]
    pub help: Option<String>,
    /// Did the state go bad in the middle of a run, as opposed to a mistake in the input?
    pub while_running: bool,
    #[source_code]
    source_code: Excerpt,
    #[label("here")]
    span: Option<SourceSpan>,
}

/// Byte range of a file.
pub type Span = (usize, usize);

/// Where a [`Problem`] lies.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Place {
    /// The command being executed.
    #[default]
    Command,
    /// Bytes of the running script.
    Span(Span),
    /// A line (from 1; 0: unknown) of another file.
    File {
        path: String,
        line: usize,
        text: String,
    },
}

impl Place {
    /// The line of `source`, in the file `path`, where `span` begins.
    pub fn line(path: &str, source: &str, span: Span) -> Place {
        let line = line_of(source, span.0);
        Place::File {
            path: path.to_string(),
            line,
            text: source.lines().nth(line - 1).unwrap_or("").to_string(),
        }
    }
}

/// A mistake as a command sees it; the interpreter adds the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    pub message: String,
    pub help: Option<String>,
    pub place: Place,
    /// As in [`ScriptError`].
    pub while_running: bool,
}

/// Boxed: errors are rare, results are not.
pub type Result<T> = std::result::Result<T, Box<Problem>>;

impl Problem {
    pub fn new(message: impl Into<String>) -> Box<Self> {
        Box::new(Problem {
            message: message.into(),
            help: None,
            place: Place::Command,
            while_running: false,
        })
    }

    pub fn at(span: Span, message: impl Into<String>) -> Box<Self> {
        Box::new(Problem {
            message: message.into(),
            help: None,
            place: Place::Span(span),
            while_running: false,
        })
    }

    pub fn in_file(path: &str, line: usize, text: &str, message: impl Into<String>) -> Box<Self> {
        Box::new(Problem {
            message: message.into(),
            help: None,
            place: Place::File {
                path: path.to_string(),
                line,
                text: text.to_string(),
            },
            while_running: false,
        })
    }

    #[must_use]
    pub fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }

    /// Points at `span` unless the place is known already.
    #[must_use]
    pub fn or_at(mut self: Box<Self>, span: Span) -> Box<Self> {
        if self.place == Place::Command {
            self.place = Place::Span(span);
        }
        self
    }
}

impl From<Box<FileError>> for Box<Problem> {
    fn from(e: Box<FileError>) -> Self {
        let FileError {
            path,
            line,
            message,
            help,
        } = *e;
        let problem = match line {
            Some((line, text)) => Problem::in_file(&path, line, &text, message),
            None => Problem::new(message),
        };
        match help {
            Some(help) => problem.help(help),
            None => problem,
        }
    }
}

impl ScriptError {
    /// A whole-file error: it cannot be read.
    pub fn unreadable(path: &str, reason: &std::io::Error) -> Box<Self> {
        Box::new(ScriptError {
            path: path.to_string(),
            line: 0,
            message: format!("cannot read the script: {reason}"),
            help: None,
            while_running: false,
            source_code: Excerpt::of_line(path, 0, ""),
            span: None,
        })
    }

    /// Gives `problem` its place in `source`; `command` is the span of the command that failed.
    pub fn locate(problem: Problem, path: &str, source: &str, command: Span) -> Box<Self> {
        let (path, line, excerpt) = match problem.place {
            Place::File { path, line, text } => {
                let excerpt = Excerpt::of_line(&path, line, &text);
                (path, line, excerpt)
            }
            place => {
                let (start, end) = match place {
                    Place::Span(span) => span,
                    _ => command,
                };
                let excerpt = Excerpt::new(path, source, start..end);
                (path.to_string(), line_of(source, start), excerpt)
            }
        };
        let span = excerpt.span();
        Box::new(ScriptError {
            message: problem.message,
            help: problem.help,
            while_running: problem.while_running,
            source_code: excerpt,
            path,
            line,
            span: Some((span.start, span.len()).into()),
        })
    }
}

fn line_of(source: &str, offset: usize) -> usize {
    1 + source.bytes().take(offset).filter(|&b| b == b'\n').count()
}

/// `"did you mean X?"` or the list of what there is.
pub fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let best = known
        .iter()
        .map(|k| (strsim::damerau_levenshtein(word, k), *k))
        .min()
        .filter(|(d, k)| *d <= 2 && *d * 2 <= k.len().max(2));
    match best {
        Some((_, k)) => format!("did you mean `{k}`? Supported: {}", known.join(", ")),
        None => format!("supported: {}", known.join(", ")),
    }
}
