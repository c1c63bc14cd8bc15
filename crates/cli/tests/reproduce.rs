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
