//! How a run of the program ended.

use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time of a run.
pub const LONGEST: Duration = Duration::from_secs(10);
/// Room of a run in kB.
const ROOM: u64 = 4_000_000;
/// Lines and characters of a message.
const LINES: usize = 60;
const CHARACTERS: usize = 8000;

/// The exit code 0, 1 or 2, or what is wrong.
pub type Verdict = Result<i32, String>;

/// Runs `program` in a folder; what it prints goes to `said`, which is no part of it.
pub fn run(program: &str, arguments: &[String], folder: &Path, said: &Path) -> Verdict {
    let file = File::create(said).unwrap();
    let mut child = Command::new("sh")
        .args([
            "-c",
            &format!("ulimit -v {ROOM}; exec \"$0\" \"$@\""),
            program,
        ])
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(file.try_clone().unwrap())
        .stderr(file)
        .spawn()
        .unwrap();
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if begin.elapsed() > LONGEST {
            child.kill().unwrap();
            child.wait().unwrap();
            return Err(format!("goes on for {} s", LONGEST.as_secs()));
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let told = std::fs::read(said).unwrap();
    match status.code() {
        Some(code @ 0..=2) => printed(code, &told),
        Some(101) => Err(format!("panics: {}", String::from_utf8_lossy(&told).trim())),
        _ => Err(format!("ends by {status}")),
    }
}

/// What was printed is text for a terminal, says why it is an error, and fits on a screen or two if it is one.
fn printed(code: i32, told: &[u8]) -> Verdict {
    let Ok(text) = std::str::from_utf8(told) else {
        return Err("prints what is no text".into());
    };
    let steers = |c: &char| {
        (c.is_control() && !"\n\t".contains(*c)) || ('\u{202a}'..='\u{202e}').contains(c)
    };
    if let Some(c) = text.chars().find(steers) {
        return Err(format!("prints {c:?}"));
    }
    if code == 2 && text.trim().is_empty() {
        return Err("is refused in silence".into());
    }
    let (lines, characters) = (text.lines().count(), text.chars().count());
    if code == 2 && (lines > LINES || characters > CHARACTERS) {
        return Err(format!(
            "is refused in {lines} lines, {characters} characters"
        ));
    }
    Ok(code)
}
