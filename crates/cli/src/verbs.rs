//! The verbs in groups, as `peridyne --help` and the manual list them; and what is said of a word that is no verb.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, CommandFactory};
use std::ffi::OsString;
use std::fmt::Write;
use std::path::Path;

/// Verbs by what they are for.
pub const GROUPS: [(&str, &[&str]); 7] = [
    ("Run", &["new", "check", "run", "resume", "report"]),
    ("Understand", &["laws", "doc", "waves", "bar"]),
    ("Studies", &["sweep", "calibrate", "converge", "reproduce"]),
    ("Atoms to continuum", &["upscale", "coarsen", "fields"]),
    ("Clusters", &["plan", "ranks"]),
    ("Files", &["convert", "schema"]),
    ("Shell", &["completions", "man", "help"]),
];

/// Columns of a help text.
const WIDTH: usize = 100;
/// Columns before what a verb does.
const INDENT: usize = 15;

/// What a verb does, in a sentence.
pub fn about(program: &Command, verb: &str) -> String {
    if verb == "help" {
        return "Print this list, or the flags of a verb".into();
    }
    let command = program.find_subcommand(verb);
    let about = command.and_then(|c| c.get_about());
    about.map(ToString::to_string).unwrap_or_default()
}

/// A text in lines of the width, those after the first moved in.
fn wrapped(text: &str) -> String {
    let (mut out, mut column) = (String::new(), INDENT);
    for (n, word) in text.split_whitespace().enumerate() {
        let length = word.chars().count();
        if n > 0 && column + 1 + length > WIDTH {
            let _ = write!(out, "\n{:INDENT$}{word}", "");
            column = INDENT + length;
        } else {
            let blank = if n > 0 { " " } else { "" };
            let _ = write!(out, "{blank}{word}");
            column += blank.len() + length;
        }
    }
    out
}

/// The list of all verbs.
fn list(program: &Command) -> String {
    let mut text = String::new();
    for (group, verbs) in GROUPS {
        let _ = writeln!(text, "{group}:");
        for verb in verbs {
            let said = wrapped(&about(program, verb));
            let _ = writeln!(text, "  {verb:<width$}{said}", width = INDENT - 2);
        }
        text.push('\n');
    }
    text
}

/// The command line, whose help has the verbs in groups.
pub fn command() -> Command {
    let program = crate::Arguments::command();
    let verbs = list(&program);
    program.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{verbs}Options:\n{{options}}\n\n\
         Flags of a verb: peridyne VERB --help; its manual page: man peridyne-VERB, or peridyne man VERB"
    ))
}

/// The verb that was meant: the nearest of those that are near.
fn nearest(word: &str) -> Option<&'static str> {
    let verbs = GROUPS.iter().flat_map(|(_, verbs)| verbs.iter());
    let near = verbs.map(|verb| (strsim::damerau_levenshtein(word, verb), *verb));
    let near = near.min()?;
    let far = (word.chars().count() / 3).max(1);
    // the beginning of one verb alone, too: calib
    let mut begun = { GROUPS.iter() }
        .flat_map(|(_, verbs)| verbs.iter())
        .filter(|verb| word.len() > 2 && verb.starts_with(word));
    match (begun.next(), begun.next()) {
        (Some(verb), None) => Some(verb),
        (_, _) => (near.0 <= far && near.0 < near.1.len()).then_some(near.1),
    }
}

/// What is said of a word that is no verb, or of a flag that its verb has not, if that is what is wrong.
pub fn mistaken(answer: &clap::Error, words: &[OsString]) -> Option<String> {
    let told = |kind| match answer.get(kind) {
        Some(ContextValue::String(word)) => Some(word.as_str()),
        _ => None,
    };
    if let (ErrorKind::InvalidSubcommand, Some(word)) =
        (answer.kind(), told(ContextKind::InvalidSubcommand))
    {
        let ends = [".toml", ".lmp", ".lammps"];
        let file = Path::new(word).is_file() || ends.iter().any(|end| word.ends_with(end));
        return Some(match file {
            true => format!(
                "there is no verb `{word}`: `peridyne run {word}` runs a file, `peridyne check {word}` says what it would run"
            ),
            false => unknown(word),
        });
    }
    let (ErrorKind::UnknownArgument, Some(flag)) = (answer.kind(), told(ContextKind::InvalidArg))
    else {
        return None;
    };
    let name = flag.strip_prefix("--")?.split('=').next()?;
    let program = command();
    let given = words.iter().skip(1).find_map(|w| w.to_str());
    let verb = program.find_subcommand(given?)?;
    Some(format!(
        "`peridyne {}` has no flag `--{name}`; {}",
        verb.get_name(),
        instead(verb, name)
    ))
}

/// What may have been meant by a flag that there is not.
fn instead(verb: &Command, name: &str) -> String {
    let flags = verb.get_arguments().filter_map(clap::Arg::get_long);
    let near = flags
        .map(|flag| (strsim::damerau_levenshtein(name, flag), flag))
        .min();
    if let Some((distance, flag)) = near
        && distance <= 1 + name.chars().count() / 4
    {
        return format!("did you mean `--{flag}`?");
    }
    let sets = verb.get_arguments().any(|a| a.get_long() == Some("set"));
    let name = name.replace('-', "_");
    let slips = usize::from(name.len() > 3);
    let keys = crate::keys::paths().into_iter();
    let near = |key: &str| {
        let own = key.rsplit('.').next().unwrap_or(key);
        strsim::damerau_levenshtein(own, &name) <= slips
    };
    let mut keys = keys.filter(|key| sets && near(key));
    // the shortest is the one that is meant most often
    let first = keys
        .by_ref()
        .min_by_key(|key| (key.matches('.').count(), key.len()));
    match first {
        Some(key) => format!("a key of the deck is set by `--set {key}=…`"),
        None => format!(
            "`peridyne {} --help` lists those that it has",
            verb.get_name()
        ),
    }
}

/// There is no such verb.
pub fn unknown(word: &str) -> String {
    match nearest(word) {
        Some(verb) => format!("there is no verb `{word}`; did you mean `{verb}`?"),
        None => format!("there is no verb `{word}`; `peridyne --help` lists them"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_verb_stands_in_one_group() {
        let program = crate::Arguments::command();
        let mut verbs: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
        verbs.push("help");
        let mut listed: Vec<&str> = { GROUPS.iter() }
            .flat_map(|(_, verbs)| verbs.iter().copied())
            .collect();
        verbs.sort_unstable();
        listed.sort_unstable();
        assert_eq!(verbs, listed);
        for verb in listed {
            assert!(!about(&program, verb).is_empty(), "{verb}");
        }
    }

    #[test]
    fn a_verb_that_is_nearly_right_is_known() {
        for (word, verb) in [
            ("rnu", Some("run")),
            ("chekc", Some("check")),
            ("calib", Some("calibrate")),
            ("calibrat", Some("calibrate")),
            ("law", Some("laws")),
            ("resum", Some("resume")),
            ("docs", Some("doc")),
            ("sweeps", Some("sweep")),
            ("xyzzy", None),
            ("simulate", None),
        ] {
            assert_eq!(nearest(word), verb, "{word}");
        }
    }

    #[test]
    fn lines_are_no_longer_than_a_screen() {
        let text = list(&crate::Arguments::command());
        assert!(text.lines().all(|l| l.chars().count() <= WIDTH), "{text}");
    }
}
