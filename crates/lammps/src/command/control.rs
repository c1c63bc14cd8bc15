//! Commands that steer the script: `if`, `print`, `label`, `jump`, `next`, `include`, `run`, `quit`.

use std::time::Instant;

use super::Args;
use crate::boolean;
use crate::error::{Problem, Result};
use crate::script::Script;
use crate::text::{Text, Word, words};

const NAMES: [&str; 9] = [
    "if", "print", "label", "jump", "next", "include", "run", "quit", "clear",
];

/// Characters of a line after substitution.
const LONGEST_LINE: usize = 1 << 20;

/// Is it a command of [`Script::control`]?
fn is_control(name: &str) -> bool {
    NAMES.contains(&name)
}

impl Script<'_> {
    /// Runs a command that steers the script.
    ///
    /// # Errors
    /// Wrong arguments, or an error of a command run by it.
    pub fn control(&mut self, args: &mut Args) -> Result<()> {
        match args.command.as_str() {
            "if" => self.conditional(args),
            "print" => self.print(args),
            "label" => {
                args.next("a label")?;
                args.finish()
            }
            "jump" => self.jump_command(args),
            "next" => self.next_value(args),
            "include" => {
                let word = args.next("a file name")?;
                args.finish()?;
                self.include(word.as_str()).map_err(|p| p.or_at(word.span))
            }
            "run" => self.run(args),
            "quit" => {
                if let Some(word) = args.optional().filter(|w| w.as_str() != "0") {
                    return Err(Problem::at(
                        word.span,
                        format!("the script quits with status {}", word.as_str()),
                    ));
                }
                self.stop();
                Ok(())
            }
            _ => {
                args.finish()?;
                self.session.clear();
                Ok(())
            }
        }
    }

    fn conditional(&mut self, args: &mut Args) -> Result<()> {
        let condition = args.next("a condition")?;
        let mut holds = self.condition(condition)?;
        let then = args.next("`then`")?;
        if then.as_str() != "then" {
            return Err(Problem::at(
                then.span,
                format!("expected `then`, found `{}`", then.as_str()),
            )
            .help("put the condition into quotes: if \"${x} > 1\" then \"command\""));
        }
        let mut done = false;
        loop {
            let mut commands: Vec<&Word> = Vec::new();
            let mut next = None;
            while let Some(word) = args.optional() {
                if ["elif", "else"].contains(&word.as_str()) {
                    next = Some(word);
                    break;
                }
                commands.push(word);
            }
            if commands.is_empty() {
                args.next("a command in quotes")?;
            }
            if holds && !done {
                done = true;
                for command in commands {
                    self.line(&command.text)?;
                }
            }
            match next.map(Word::as_str) {
                None => return Ok(()),
                Some("elif") => {
                    let condition = args.next("a condition")?;
                    holds = !done && self.condition(condition)?;
                }
                Some(_) => holds = true,
            }
        }
    }

    fn condition(&mut self, word: &Word) -> Result<bool> {
        let text = self.substitute(&word.text)?;
        boolean::evaluate(text.as_str()).map_err(|e| Problem::at(word.span, e))
    }

    fn print(&mut self, args: &mut Args) -> Result<()> {
        let word = args.next("a text")?;
        let text = self.substitute(&word.text)?.as_str().to_string();
        let (mut screen, mut file) = (true, None);
        while let Some(option) = args.optional() {
            match option.as_str() {
                "file" | "append" => {
                    file = Some((args.next("a file name")?, option.as_str() == "append"))
                }
                "screen" => screen = args.yes("screen")?,
                _ => {
                    return Err(args
                        .unknown(option, "the option", ["file", "append", "screen"])
                        .help("put a text with blanks into quotes; options: file NAME, append NAME, screen yes|no"));
                }
            }
        }
        if screen {
            self.session.console.print(&text);
        }
        if let Some((name, append)) = file {
            let opened = self.session.folder.open(name.as_str(), append);
            let mut file = opened.map_err(|p| p.or_at(name.span))?;
            file.line(&text)?;
            file.flush()?;
        }
        Ok(())
    }

    fn jump_command(&mut self, args: &mut Args) -> Result<()> {
        let file = args.next("SELF or a file name")?;
        let label = args.optional().cloned();
        args.finish()?;
        if std::mem::take(&mut self.skip_jump) {
            return Ok(());
        }
        self.jump(file.as_str(), label.as_ref().map(Word::as_str))
            .map_err(|p| p.or_at(label.as_ref().unwrap_or(file).span))
    }

    fn next_value(&mut self, args: &mut Args) -> Result<()> {
        let mut names = vec![args.next("a variable")?];
        while let Some(word) = args.optional() {
            names.push(word);
        }
        let mut exhausted = false;
        for word in &names {
            let name = word.as_str();
            let variables = &mut self.session.formulas.variables;
            match variables.get_mut(name) {
                None => self
                    .session
                    .variable_exists(name)
                    .map_err(|p| p.or_at(word.span))?,
                Some(kind) if !["index", "loop", "file"].contains(&kind.style()) => {
                    let style = kind.style();
                    return Err(Problem::at(
                        word.span,
                        format!("variable `{name}` has the style {style}"),
                    )
                    .help("`next` works on index, loop and file variables"));
                }
                Some(kind) => exhausted |= !kind.advance(),
            }
        }
        if exhausted {
            names
                .iter()
                .for_each(|w| self.session.formulas.variables.delete(w.as_str()));
            self.skip_jump = true;
        }
        Ok(())
    }

    fn run(&mut self, args: &mut Args) -> Result<()> {
        let plan = self.session.run_plan(args)?;
        if self.session.from.is_some() {
            return self.go_on(&plan);
        }
        let begin = self.session.progress.step;
        let end = begin + plan.steps;
        let Some((every, commands)) = &plan.every else {
            self.session.start_run(&plan)?;
            self.end_of_step(true)?;
            self.session.first_output()?;
            return self.run_until(end, plan.report);
        };
        self.session.progress.whole = Some((begin, end));
        while self.session.progress.step < end {
            let steps = (*every).min(end - self.session.progress.step);
            let first = self.session.progress.step == begin;
            let part = super::run::RunPlan {
                steps,
                setup: plan.setup || first,
                report: false,
                every: None,
            };
            self.session.start_run(&part)?;
            self.end_of_step(true)?;
            self.session.first_output()?;
            let clock = Instant::now();
            let target = self.session.progress.step + steps;
            self.steps_until(target, false)?;
            self.session.end_run(false, clock.elapsed().as_secs_f64());
            for command in commands {
                self.line(&command.text)?;
            }
        }
        self.session.progress.whole = None;
        Ok(())
    }

    /// Steps of a `run`, and the lines after it.
    ///
    /// # Errors
    /// As [`steps_until`](Script::steps_until).
    pub fn run_until(&mut self, end: u64, report: bool) -> Result<()> {
        let clock = Instant::now();
        self.steps_until(end, report)?;
        self.session.end_run(report, clock.elapsed().as_secs_f64());
        Ok(())
    }

    /// Replaces `$x`, `${name}` and `$(formula)` outside quotes.
    ///
    /// # Errors
    /// No such variable; a formula without a value.
    pub fn substitute(&mut self, line: &Text) -> Result<Text> {
        let text = line.as_str();
        if !text.contains('$') {
            return Ok(line.clone());
        }
        let mut out = Text::default();
        let mut quotes = crate::text::Quotes::default();
        let mut k = 0;
        while k < text.len() {
            let rest = &text[k..];
            let mark = quotes.mark(rest);
            let width = if mark > 0 {
                mark
            } else {
                rest.chars().next().map_or(1, char::len_utf8)
            };
            if mark > 0 || quotes.inside() || !rest.starts_with('$') {
                for (o, c) in rest[..width].char_indices() {
                    out.push(c, line.span(k + o, k + o + 1).0);
                }
                k += width;
                continue;
            }
            let (value, used) = self.dollar(line, k)?;
            if out.as_str().len() + value.len() > LONGEST_LINE {
                return Err(Problem::at(
                    line.span(k, k + 1),
                    format!("the line is longer than {LONGEST_LINE} characters with its variables"),
                ));
            }
            out.push_str(&value, line.span(k, k + 1).0);
            k += used;
        }
        Ok(out)
    }

    /// Value of the substitution that starts at byte `k`, and its length.
    fn dollar(&mut self, line: &Text, k: usize) -> Result<(String, usize)> {
        let rest = &line.as_str()[k..];
        let open = |what: &str| {
            Problem::at(
                line.span(k, k + 2),
                format!("`{}` is not closed by `{what}`", &rest[..2]),
            )
        };
        if rest.starts_with("${") {
            let end = rest.find('}').ok_or_else(|| open("}"))?;
            let span = line.span(k, k + end + 1);
            let value = self
                .session
                .variable_text(&rest[2..end])
                .map_err(|p| p.or_at(span))?;
            return Ok((value, end + 1));
        }
        if rest.starts_with("$(") {
            let mut depth = 0usize;
            let end = rest.char_indices().find_map(|(i, c)| {
                depth += usize::from(c == '(');
                depth -= usize::from(c == ')' && depth > 0);
                (c == ')' && depth == 0).then_some(i)
            });
            let end = end.ok_or_else(|| open(")"))?;
            let span = line.span(k, k + end + 1);
            let inner = &rest[2..end];
            let (formula, format) = match inner.rfind(":%") {
                Some(colon) => (&inner[..colon], &inner[colon + 1..]),
                None => (inner, "%.20g"),
            };
            let format =
                crate::session::Session::check_format(format).map_err(|p| p.or_at(span))?;
            let value = self.session.immediate(formula).map_err(|p| p.or_at(span))?;
            return Ok((format.print(crate::printf::Value::Float(value)), end + 1));
        }
        match rest[1..].chars().next() {
            Some(c) if c.is_ascii_alphanumeric() || c == '_' => {
                let span = line.span(k, k + 2);
                Ok((
                    self.session
                        .variable_text(&c.to_string())
                        .map_err(|p| p.or_at(span))?,
                    2,
                ))
            }
            _ => Err(Problem::at(
                line.span(k, k + 1),
                "`$` must be followed by a letter, {name} or (formula)",
            )
            .help("put the text into quotes to keep the `$`")),
        }
    }

    /// Runs one logical line.
    ///
    /// # Errors
    /// That of the command.
    pub fn line(&mut self, line: &Text) -> Result<()> {
        let line = crate::text::without_comment(line);
        let line = self.substitute(&line)?;
        let mut words = words(&line)?;
        self.session.without_suffix(&mut words);
        let Some((command, rest)) = words.split_first() else {
            return Ok(());
        };
        let mut args = Args::new(command, rest);
        self.depth += 1;
        let result = if self.depth > 50 {
            Err(Problem::new("commands are nested in more than 50 levels"))
        } else if is_control(command.as_str()) {
            self.control(&mut args)
        } else {
            let done = self.session.command(args);
            if done.is_ok() {
                self.session.note_command(command.as_str(), line.as_str());
            }
            done
        };
        self.depth -= 1;
        let result = result.and_then(|()| self.session.console.check());
        result.map_err(|p| p.or_at(line.whole()))
    }
}
