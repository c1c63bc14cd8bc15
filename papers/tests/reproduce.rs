//! The framework with experiments of its own, and every experiment of the papers in its small variant.

use peridyne_papers::reproduce::{Options, Outcome, list, reproduce, reproduce_of, select};
use peridyne_papers::{Context, Experiment, Failure, Findings, Takes, all, papers};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

fn options(out: &Path) -> Options<'static> {
    Options {
        out: out.to_path_buf(),
        small: true,
        force: false,
        threads: 2,
        progress: &|_| {},
    }
}

/// Counts how often it runs and how often its part is computed.
struct Counted {
    figure: &'static str,
    runs: AtomicUsize,
    parts: AtomicUsize,
    /// Fails after the part this many times.
    failures: AtomicUsize,
    value: f64,
    time: f64,
    takes: Takes,
}

impl Counted {
    fn new(figure: &'static str, value: f64, failures: usize) -> Counted {
        Counted {
            figure,
            runs: AtomicUsize::new(0),
            parts: AtomicUsize::new(0),
            failures: AtomicUsize::new(failures),
            value,
            time: 1.5,
            takes: Takes::Minutes,
        }
    }

    fn counts(&self) -> (usize, usize) {
        (
            self.runs.load(Ordering::Relaxed),
            self.parts.load(Ordering::Relaxed),
        )
    }
}

impl Experiment for Counted {
    fn key(&self) -> &'static str {
        "author2001"
    }
    fn figure(&self) -> &'static str {
        self.figure
    }
    fn title(&self) -> &'static str {
        "A | test"
    }
    fn claims(&self) -> &'static str {
        "[[claim]]\nkey = \"a\"\nwhat = \"an answer\"\npublished = 42\ntolerance = { relative = 0.01 }\nkind = \"digitised\"\n"
    }
    fn readme(&self) -> &'static str {
        "# Title\n\nUnsaid: all.\n"
    }
    fn sources(&self) -> &'static [&'static str] {
        &["v1"]
    }
    fn takes(&self) -> Takes {
        self.takes
    }
    fn run(&self, context: &Context) -> Result<Findings, Failure> {
        self.runs.fetch_add(1, Ordering::Relaxed);
        let value = context.part("long", || {
            self.parts.fetch_add(1, Ordering::Relaxed);
            Ok(self.value)
        })?;
        if self.failures.load(Ordering::Relaxed) > 0 {
            self.failures.fetch_sub(1, Ordering::Relaxed);
            return Err(Failure::new("cut off"));
        }
        let path = context.out.join("p.png");
        std::fs::write(&path, b"png").map_err(|e| Failure::new(e.to_string()))?;
        let mut found = Findings::new();
        found.number("a", value);
        found.measured("time | all", self.time, "s");
        found.measured("threads", "two", "");
        found.file(path);
        Ok(found)
    }
}

#[test]
fn a_finished_figure_is_kept_until_forced() {
    let dir = tempfile::tempdir().unwrap();
    let experiment = Counted::new("figure-1", 42.3, 0);
    let all: [&dyn Experiment; 1] = [&experiment];
    let run = |options: &Options| reproduce_of(&all, None, options).unwrap().remove(0);
    assert!(matches!(run(&options(dir.path())), Outcome::Ran(r) if r.pass));
    assert!(matches!(run(&options(dir.path())), Outcome::Kept(r) if r.pass && r.claims.len() == 1));
    assert_eq!(experiment.counts(), (1, 1));
    let full = Options {
        small: false,
        ..options(dir.path())
    };
    assert!(matches!(run(&full), Outcome::Ran(_)));
    assert_eq!(experiment.counts(), (2, 2));
    std::fs::remove_file(dir.path().join("author2001/figure-1/p.png")).unwrap();
    assert!(matches!(run(&full), Outcome::Ran(_)));
    // its part was kept
    assert_eq!(experiment.counts(), (3, 2));
    let forced = Options {
        force: true,
        ..full
    };
    assert!(matches!(run(&forced), Outcome::Ran(_)));
    assert_eq!(experiment.counts(), (4, 3));
}

#[test]
fn a_run_that_is_cut_off_goes_on_and_others_are_run() {
    let dir = tempfile::tempdir().unwrap();
    let (broken, wrong) = (
        Counted::new("figure-1", 42.0, 1),
        Counted::new("figure-2", 40.0, 0),
    );
    let all: [&dyn Experiment; 2] = [&broken, &wrong];
    let outcomes = reproduce_of(&all, Some("author2001"), &options(dir.path())).unwrap();
    assert!(
        matches!(&outcomes[0], Outcome::Failed { failure, .. } if failure.to_string() == "cut off")
    );
    assert!(!outcomes[1].pass());
    let index = std::fs::read_to_string(dir.path().join("index.md")).unwrap();
    assert!(
        index.contains("| author2001/figure-1 | **failed**: cut off |"),
        "{index}"
    );
    assert!(index.contains("| [author2001/figure-2](author2001/figure-2/page.md) | A \\| test | **0 of 1** | small |"), "{index}");
    let outcomes = reproduce_of(&all, Some("author2001/figure-1"), &options(dir.path())).unwrap();
    assert!(outcomes.len() == 1 && outcomes[0].pass());
    assert_eq!(broken.counts(), (2, 1));
    let folder = dir.path().join("author2001/figure-1");
    let page = std::fs::read_to_string(folder.join("page.md")).unwrap();
    assert!(
        page.contains("| an answer | 42 |  | 42 | 1 % | digitised | yes |  |"),
        "{page}"
    );
    assert!(
        page.contains("![p.png](p.png)") && page.ends_with("\nUnsaid: all.\n"),
        "{page}"
    );
    assert!(
        page.contains("| time \\| all | 1.5 | s |\n| threads | two |  |\n"),
        "{page}"
    );
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("report.json")).unwrap()).unwrap();
    assert_eq!(
        report["measurements"][0],
        serde_json::json!({ "key": "time | all", "value": 1.5, "unit": "s" })
    );
    assert!(report["measurements"][0].get("pass").is_none());
    // the other one is still in the index
    let index = std::fs::read_to_string(dir.path().join("index.md")).unwrap();
    assert!(
        index.contains("figure-1/page.md") && index.contains("figure-2/page.md"),
        "{index}"
    );
}

#[test]
fn a_measurement_without_a_value_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let broken = Counted {
        time: f64::NAN,
        ..Counted::new("figure-1", 42.0, 0)
    };
    let all: [&dyn Experiment; 1] = [&broken];
    let outcomes = reproduce_of(&all, None, &options(dir.path())).unwrap();
    let Outcome::Failed { failure, .. } = &outcomes[0] else {
        panic!("{outcomes:?}")
    };
    assert_eq!(
        failure.to_string(),
        "the measurement `time | all` is not a finite number"
    );
}

#[test]
fn what_takes_hours_is_asked_for_by_its_whole_name() {
    let dir = tempfile::tempdir().unwrap();
    let long = Counted {
        takes: Takes::Hours,
        ..Counted::new("figure-2", 42.0, 0)
    };
    let all: [&dyn Experiment; 2] = [&Counted::new("figure-1", 42.0, 0), &long];
    let full = Options {
        small: false,
        ..options(dir.path())
    };
    let run = |name, options| reproduce_of(&all, name, options).unwrap().len();
    assert_eq!(run(None, &full), 1);
    assert_eq!(run(Some("all"), &full), 1);
    assert_eq!(run(Some("author2001"), &full), 1);
    assert_eq!(long.counts(), (0, 0));
    assert_eq!(run(Some("author2001/figure-2"), &full), 1);
    assert_eq!(long.counts(), (1, 1));
    assert_eq!(run(None, &options(dir.path())), 2);
}

#[test]
fn an_unknown_name_tells_the_closest_and_all() {
    let told = |name: &str| match select(&all(), Some(name)) {
        Ok(chosen) => panic!("{name}: {}", chosen.len()),
        Err(e) => e.to_string(),
    };
    let text = told("seleson2009/tabel-4-1");
    assert!(
        text.contains("did you mean seleson2009/table-4-1"),
        "{text}"
    );
    let text = told("zzz");
    assert!(
        text.starts_with("there is no experiment `zzz`: There are seleson2009, seleson2009/"),
        "{text}"
    );
    assert!(!select(&all(), Some("seleson2009/")).unwrap().is_empty());
}

#[test]
fn the_list_has_every_figure_and_what_it_takes() {
    let text = list(None).unwrap();
    assert_eq!(text.lines().count(), all().len());
    let line = |name: &str| {
        let found = text.lines().find(|l| l.starts_with(&format!("{name} ")));
        found.unwrap_or_else(|| panic!("{name}: {text}"))
    };
    for paper in papers() {
        for e in paper.figures {
            assert_eq!(e.key(), paper.key);
            let claims = e.claims().matches("[[claim]]").count();
            let line = line(&format!("{}/{}", e.key(), e.figure()));
            assert!(
                line.contains(&format!(" {claims} claims  {} ", e.takes())),
                "{line}"
            );
            assert!(line.ends_with(e.title()), "{line}");
        }
    }
    assert!(line("seleson2014/figure-6-paper-step").contains(" hours "));
    let one = list(Some("seleson2009/table-4-1")).unwrap();
    assert_eq!(one.lines().count(), 1, "{one}");
    let told = list(Some("seleson2009/tabel-4-1")).unwrap_err().to_string();
    assert!(
        told.contains("did you mean seleson2009/table-4-1"),
        "{told}"
    );
}

#[test]
fn the_small_variants_of_all_papers_pass() {
    let dir = tempfile::tempdir().unwrap();
    let outcomes = reproduce(None, &options(dir.path())).unwrap();
    assert_eq!(outcomes.len(), all().len());
    for outcome in &outcomes {
        assert!(outcome.pass(), "{outcome:?}");
    }
    let folder = dir.path().join("seleson2009/table-4-1");
    let table = std::fs::read_to_string(folder.join("costs.csv")).unwrap();
    assert!(
        table.starts_with(
            "model,Nx,N,spacing,time step,Nt,Nx N Nt,relative cost\nMD,4001,20,0.25,1.62"
        ),
        "{table}"
    );
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("report.json")).unwrap()).unwrap();
    assert_eq!(report["claims"][1]["computed"], 162.0);
    assert_eq!(report["claims"][2]["kind"], "exact");
}

#[test]
fn names_are_unique_and_folders_are_complete() {
    let mut seen = std::collections::HashSet::new();
    for e in all() {
        assert!(
            seen.insert((e.key(), e.figure())),
            "{}/{} is there twice",
            e.key(),
            e.figure()
        );
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join(e.key())
            .join(e.figure());
        for (file, text) in [("claims.toml", e.claims()), ("README.md", e.readme())] {
            let there = std::fs::read_to_string(folder.join(file)).unwrap();
            assert_eq!(there, text, "{}", folder.display());
        }
        assert!(!e.sources().is_empty() && !e.title().is_empty());
        decked(&folder, e.readme());
    }
}

/// A figure has a deck, or names that of another (`../figure-1/chain.toml`), or is arithmetic and says so.
fn decked(folder: &Path, readme: &str) {
    let own = std::fs::read_dir(folder).unwrap();
    let own = own.map(|f| f.unwrap().file_name());
    let is_deck = |name: &str| name.ends_with(".toml") && name != "claims.toml";
    let has = own.into_iter().any(|f| f.to_str().is_some_and(is_deck));
    let named: Vec<&str> = { readme.split('`') }
        .filter(|word| word.starts_with("../") && is_deck(word))
        .collect();
    for deck in &named {
        assert!(folder.join(deck).is_file(), "{}: {deck}", folder.display());
    }
    assert!(
        has || !named.is_empty() || readme.contains("arithmetic"),
        "{}: write a deck, name one in the README, or say there why it is arithmetic",
        folder.display()
    );
}
