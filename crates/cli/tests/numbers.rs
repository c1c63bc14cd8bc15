//! What people read has numbers for people, whatever command says it; files for machines keep all digits.

use std::path::{Path, PathBuf};
use std::process::Command;

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks/good")
        .join(name)
}

/// A number that nobody would write so: `5.72e0`, `3.000000000e-3`.
fn odd_number(text: &str) -> Option<&str> {
    let around = |c: char| "(),;:|=`".contains(c);
    text.split(|c: char| c.is_whitespace() || around(c))
        .map(|word| word.trim_end_matches('.'))
        .find(|word| {
            let Some((digits, power)) = word.split_once('e') else {
                return false;
            };
            let count = digits.chars().filter(char::is_ascii_digit).count();
            let number = word.parse::<f64>().is_ok();
            number && (count > 6 || digits.ends_with(".0") || power.trim_start_matches('+') == "0")
        })
}

#[test]
fn odd_numbers_are_found() {
    for odd in ["of 1.047570e0 in", "(3.000000000e-3)", "| 2.0e-5 |"] {
        assert!(odd_number(odd).is_some(), "{odd}");
    }
    assert_eq!(odd_number("8.791e18 N/m^6, 2e-4, the, 0.000301"), None);
}

#[test]
fn numbers_of_commands_are_for_people() {
    let cases: &[(&str, &str, &[&str])] = &[
        (
            "check",
            "ten_lines.toml",
            &["--set", "body.spacing='2.5 mm'", "--set", "run.steps=3"],
        ),
        ("check", "conservation/riemann.toml", &[]),
        ("run", "exact_plate.toml", &[]),
        (
            "run",
            "implicit_bar.toml",
            &["--set", "output.report=false"],
        ),
        ("coarsen", "fibre_plate.toml", &["--every", "2"]),
        ("coarsen", "crystal_with_vacancy.toml", &["--every", "2"]),
        (
            "converge",
            "convergence_bar.toml",
            &["--study", "m", "--levels", "3"],
        ),
        ("upscale", "copper_bar.toml", &["--factor", "2"]),
        ("upscale", "spring_chain.toml", &["--factor", "2", "--run"]),
        ("waves", "copper_bar.toml", &[]),
        ("waves", "silicon.toml", &[]),
        ("waves", "spring_chain.toml", &[]),
        (
            "bar",
            "",
            &[
                "--m",
                "3",
                "--points",
                "20",
                "--ends",
                "full",
                "--homogenize",
            ],
        ),
    ];
    for (verb, name, more) in cases {
        let dir = tempfile::tempdir().unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_peridyne"));
        command.current_dir(dir.path()).arg(verb).args(*more);
        if !name.is_empty() {
            command.arg(deck(name));
        }
        let done = command.output().unwrap();
        let read = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let mut said = read(&done.stdout) + &read(&done.stderr);
        assert!(done.status.success(), "{verb} {name}: {said}");
        if *verb == "upscale" {
            let stem = name.trim_end_matches(".toml");
            let card = dir.path().join(format!("out/{stem}-upscaled/h2/card.md"));
            said += &std::fs::read_to_string(card).unwrap();
        }
        if let Some(odd) = odd_number(&said) {
            panic!("{verb} {name}: `{odd}` in:\n{said}");
        }
    }
}
