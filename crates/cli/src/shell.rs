//! Completions for shells, and the manual pages.

use crate::failure::{Failure, say};
use crate::verbs::{GROUPS, about};
use clap::Command;
use clap_complete::Shell;
use clap_mangen::Man;
use peridyne_io::write::atomic::{create_directory, write_file};
use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct CompletionsArguments {
    pub shell: Shell,
}

#[derive(clap::Args)]
pub struct ManArguments {
    /// The page of this verb, peridyne-VERB(1); of the program, peridyne(1), if not given.
    pub verb: Option<String>,
    /// Write all pages into this folder: peridyne.1, and peridyne-VERB.1 of each verb.
    #[arg(long, value_name = "DIR", conflicts_with = "verb")]
    pub out: Option<PathBuf>,
}

/// Flags behind which a key of a deck stands.
const KEYED: [&str; 4] = ["set", "vary", "fit", "start"];

/// Behind the functions of clap for bash: keys of decks, which the program itself lists. `=` parts words.
const BASH: &str = r#"
_peridyne_keys() {
    local word="${COMP_WORDS[COMP_CWORD]}" flag="${COMP_WORDS[COMP_CWORD-1]}"
    if [[ "$word" == "=" ]]; then
        word=""
    elif [[ "$flag" == "=" ]]; then
        flag="${COMP_WORDS[COMP_CWORD-2]}"
    fi
    case "$flag" in
        FLAGS)
            COMPREPLY=($(compgen -S = -W "$("${COMP_WORDS[0]}" doc --keys 2>/dev/null)" -- "$word"))
            compopt -o nospace 2>/dev/null
            ;;
        *)
            _peridyne "$@"
            ;;
    esac
}

complete -F _peridyne_keys -o bashdefault -o default peridyne
"#;

/// The same for zsh, in the place of files behind such flags.
const ZSH: &str = r#"
(( $+functions[_peridyne_keys] )) ||
_peridyne_keys() {
    local -a keys
    keys=(${(f)"$(_call_program keys peridyne doc --keys 2>/dev/null)"})
    compadd -S = -a keys
}

"#;

pub fn completions(arguments: &CompletionsArguments, mut program: Command) {
    let mut text = vec![];
    clap_complete::generate(arguments.shell, &mut program, "peridyne", &mut text);
    let mut text = String::from_utf8_lossy(&text).trim_end().to_string();
    match arguments.shell {
        Shell::Bash => {
            text.push('\n');
            text += &BASH.replace("FLAGS", &KEYED.map(|flag| format!("--{flag}")).join("|"));
        }
        Shell::Zsh => {
            text = { text.lines() }
                .map(
                    |line| match KEYED.iter().any(|f| line.contains(&format!("--{f}=["))) {
                        true => line.replace(":_default'", ":_peridyne_keys'"),
                        false => line.to_string(),
                    },
                )
                .collect::<Vec<_>>()
                .join("\n");
            if let Some(end) = text.rfind("\nif [ \"$funcstack[1]\"") {
                text.insert_str(end, ZSH);
            }
        }
        Shell::Fish => {
            for flag in KEYED {
                let _ = write!(
                    text,
                    "\ncomplete -c peridyne -l {flag} -x -a \"(peridyne doc --keys 2>/dev/null)=\""
                );
            }
        }
        // keys of decks are left to who writes them
        _ => {}
    }
    say(text.trim_end());
}

/// Text for roff, in which dashes are those of flags and no line is an order.
fn roff(text: &str) -> String {
    let text = text.replace('\\', "\\e").replace('-', "\\-");
    let safe = text
        .lines()
        .map(|line| match line.starts_with(['.', '\'']) {
            true => format!("\\&{line}"),
            false => line.to_string(),
        });
    safe.collect::<Vec<_>>().join("\n")
}

/// The name of a verb's page.
fn page(verb: &str) -> String {
    format!("peridyne-{verb}")
}

/// Exit codes.
const ENDS: &str = ".SH \"EXIT STATUS\"
.TP
\\fB0\\fR
Done.
.TP
\\fB1\\fR
Failed while running; the last good state is written.
.TP
\\fB2\\fR
The input or the command line is wrong; nothing is written.
.TP
\\fB129\\fR, \\fB130\\fR, \\fB143\\fR
Ended by SIGHUP, SIGINT, SIGTERM; the last state is written.
";

/// Other pages, with commas.
fn see(names: impl Iterator<Item = String>) -> String {
    let all: Vec<String> = names
        .map(|name| format!("\\fB{}\\fR(1)", roff(&name)))
        .collect();
    format!(".SH \"SEE ALSO\"\n{}\n", all.join(",\n"))
}

/// A page up to its options.
fn begun(command: Command) -> io::Result<Vec<u8>> {
    let mut text = vec![];
    let man = Man::new(command)
        .manual("peridyne")
        .source(concat!("peridyne ", env!("CARGO_PKG_VERSION")));
    man.render_title(&mut text)?;
    man.render_name_section(&mut text)?;
    man.render_synopsis_section(&mut text)?;
    man.render_description_section(&mut text)?;
    man.render_options_section(&mut text)?;
    Ok(text)
}

/// The page of the program: its verbs in groups, with their pages.
fn of_program(program: &Command) -> io::Result<Vec<u8>> {
    let mut text = begun(program.clone())?;
    writeln!(text, ".SH VERBS")?;
    for (group, verbs) in GROUPS {
        writeln!(text, ".SS \"{}\"", roff(group))?;
        for verb in verbs {
            let name = match *verb {
                "help" => format!("\\fB{verb}\\fR"),
                _ => format!("\\fB{}\\fR(1)", roff(&page(verb))),
            };
            writeln!(text, ".TP\n{name}\n{}", roff(&about(program, verb)))?;
        }
    }
    write!(text, "{ENDS}")?;
    let verbs = program.get_subcommands().map(|v| page(v.get_name()));
    write!(text, "{}", see(verbs))?;
    Ok(text)
}

/// The page of a verb.
fn of_verb(verb: &Command) -> io::Result<Vec<u8>> {
    let name = verb.get_name().to_string();
    let called = verb
        .clone()
        .bin_name(format!("peridyne {name}"))
        .display_name(page(&name));
    let mut text = begun(called)?;
    write!(text, "{ENDS}")?;
    // its group
    let group = { GROUPS.iter() }.find(|(_, verbs)| verbs.contains(&&*name));
    let beside = { group.into_iter() }
        .flat_map(|(_, verbs)| verbs.iter())
        .filter(|verb| **verb != name && **verb != "help")
        .map(|verb| page(verb));
    write!(
        text,
        "{}",
        see(std::iter::once("peridyne".into()).chain(beside))
    )?;
    Ok(text)
}

/// The manual page of the program or of a verb, in roff; or all of them in a folder.
pub fn man(arguments: &ManArguments, program: &Command) -> Result<(), Failure> {
    let failed = |e: io::Error| Failure::Run(e.to_string());
    if let Some(out) = &arguments.out {
        let failed_to = |e: peridyne_io::write::WriteError| Failure::Run(e.to_string());
        create_directory(out).map_err(failed_to)?;
        let mut pages = vec![("peridyne".to_string(), of_program(program).map_err(failed)?)];
        for verb in program.get_subcommands() {
            pages.push((page(verb.get_name()), of_verb(verb).map_err(failed)?));
        }
        for (name, text) in &pages {
            let path = out.join(format!("{name}.1"));
            write_file(&path, |file| file.write_all(text)).map_err(failed_to)?;
        }
        say(&format!("wrote {} pages to {}", pages.len(), out.display()));
        return Ok(());
    }
    let text = match &arguments.verb {
        None => of_program(program),
        Some(name) => {
            let own = name.strip_prefix("peridyne-").unwrap_or(name);
            match program.find_subcommand(own) {
                Some(verb) => of_verb(verb),
                None => return Err(Failure::input(crate::verbs::unknown(own))),
            }
        }
    };
    let text = text.map_err(failed)?;
    say(String::from_utf8_lossy(&text).trim_end());
    Ok(())
}
