//! Completions for shells, and the manual page.

use crate::failure::{Failure, say};
use clap_complete::Shell;

#[derive(clap::Args)]
pub struct CompletionsArguments {
    pub shell: Shell,
}

/// Text in what a generator wrote.
fn print(text: Vec<u8>) {
    say(String::from_utf8_lossy(&text).trim_end());
}

pub fn completions(arguments: &CompletionsArguments, mut program: clap::Command) {
    let mut text = vec![];
    clap_complete::generate(arguments.shell, &mut program, "peridyne", &mut text);
    print(text);
}

/// The manual page, in roff: the program, and each verb as a section of its own.
pub fn man(program: clap::Command) -> Result<(), Failure> {
    let failed = |e: std::io::Error| Failure::Run(e.to_string());
    let mut text = vec![];
    let verbs: Vec<clap::Command> = program.get_subcommands().cloned().collect();
    clap_mangen::Man::new(program)
        .render(&mut text)
        .map_err(failed)?;
    for verb in verbs {
        let title = format!(".SH PERIDYNE {}\n", verb.get_name().to_uppercase());
        text.extend(title.bytes());
        let man = clap_mangen::Man::new(verb);
        man.render_description_section(&mut text).map_err(failed)?;
        man.render_options_section(&mut text).map_err(failed)?;
    }
    print(text);
    Ok(())
}
