//! `reproduce` keeps what the same program has computed, and nothing that another one has.

use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Time of the report of a small figure, after running it with a program.
fn reproduced(program: &Path, out: &Path) -> std::time::SystemTime {
    let output = Command::new(program)
        .args(["reproduce", "eriksson2020/table-1", "--small", "--out"])
        .arg(out)
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{errors}");
    let report = out.join("eriksson2020/table-1/report.json");
    report.metadata().unwrap().modified().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn another_program_runs_finished_figures_again() {
    use std::io::Write;
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("out");
    let program = Path::new(env!("CARGO_BIN_EXE_peridyne"));
    let first = reproduced(program, &out);
    assert_eq!(
        reproduced(program, &out),
        first,
        "the same program keeps it"
    );
    // the same code with other bytes, as any change of it would make
    let other = dir.path().join("peridyne");
    std::fs::copy(program, &other).unwrap();
    let mut file = std::fs::File::options().append(true).open(&other).unwrap();
    file.write_all(b"changed").unwrap();
    drop(file);
    let again = reproduced(&other, &out);
    assert!(again > first, "another program must not keep it");
    assert_eq!(reproduced(&other, &out), again);
}

fn run(arguments: &[&str], out: &Path) {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {errors}");
}

/// The pictures over space and time of seleson2009 and seleson2014 are those of their decks, bit for bit where they have one title.
#[test]
fn decks_alone_draw_the_figures_over_space_and_time() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("papers");
    let papers = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../papers");
    let lj = |n: u32, m: u32| format!("constants.n={n} constants.N={m}");
    let cases: [(&str, &str, String, &str, &[[&str; 2]]); 5] = [
        (
            "seleson2009/figure-5-1",
            "deck.toml",
            lj(1, 4),
            "MD: 1001 points, N = 4",
            &[
                ["space_time_density", "density-md"],
                ["space_time_density_2", "corner-md"],
            ],
        ),
        (
            "seleson2009/figure-5-1",
            "deck.toml",
            lj(4, 1),
            "coarse PD: 251 points, N = 1",
            &[["space_time_density_2", "corner-pd-4"]],
        ),
        (
            "seleson2009/figure-4-5",
            "deck.toml",
            String::new(),
            "MD: 1001 points, N = 1",
            &[["space_time_density", "density-local"]],
        ),
        (
            "seleson2014/figure-1",
            "chain.toml",
            "family=neighbours".into(),
            "MD, 1001 atoms",
            &[
                ["space_time_density", "a-md"],
                ["space_time_density_2", "b-md"],
            ],
        ),
        (
            "seleson2014/figure-1",
            "chain.toml",
            "constants.h=2".into(),
            "NCM, h = 2a, 501 points",
            &[["space_time_density_2", "d-ncm-2"]],
        ),
    ];
    for figure in [
        "seleson2009/figure-5-1",
        "seleson2009/figure-4-5",
        "seleson2014/figure-1",
    ] {
        run(&["reproduce", figure, "--small"], &out);
    }
    for (n, (figure, deck, set, title, pictures)) in cases.iter().enumerate() {
        let here = dir.path().join(n.to_string());
        let deck = papers.join(figure).join(deck);
        let title = format!("title={title:?}");
        let mut arguments = vec!["run", deck.to_str().unwrap(), "--set", &title];
        for one in set.split_whitespace() {
            arguments.extend(["--set", one]);
        }
        run(&arguments, &here);
        for [own, paper] in *pictures {
            let [own, paper] = [here.join(own), out.join(figure).join(paper)].map(|path| {
                let path = path.with_extension("png");
                (
                    std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())),
                    path,
                )
            });
            assert!(
                own.0 == paper.0,
                "{} {}",
                own.1.display(),
                paper.1.display()
            );
            assert!(own.0.len() > 10_000, "{}", own.1.display());
        }
    }
}
