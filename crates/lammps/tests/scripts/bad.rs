//! Each script in `decks/bad/lammps` fails with the message and at the line that its first comments say.

use peridyne_lammps::Options;

use super::host::run;

#[test]
fn bad_scripts_say_what_is_wrong_and_where() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../decks/bad/lammps");
    let mut tried = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let comment = |key: &str| {
            let line = text.lines().find_map(|l| l.strip_prefix(key));
            line.unwrap_or_else(|| panic!("{} lacks `{key}`", path.display()))
                .trim()
                .to_string()
        };
        let (message, line) = (comment("# expect:"), comment("# line:"));
        let name = path.display().to_string();
        let output = tempfile::tempdir().unwrap();
        let ran = run(
            &name,
            &text,
            &Options {
                output: output.path().into(),
                ..Options::default()
            },
        );
        let error = ran.outcome.map(|_| ()).expect_err(&name);
        assert!(
            error.message.contains(&message),
            "{name}: `{}`",
            error.message
        );
        assert_eq!(error.line.to_string(), line, "{name}: {error}");
        let shown = format!("{:?}", miette::Report::new(*error));
        assert!(
            shown.contains("here"),
            "{name}: the place is not marked:\n{shown}"
        );
        tried += 1;
    }
    assert!(tried >= 35, "{tried} scripts");
}
