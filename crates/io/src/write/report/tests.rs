use super::quantise::tests::unpacked;
use super::*;
use crate::write::fields::tests::{of_columns, put};
use crate::write::history::{Column, History};
use crate::write::run_json::{FieldNote, UnitNames};
use crate::write::{Series, SeriesOptions};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use peridyne::observe::{Snapshot, Values};
use std::fs;

/// Points of a lattice that move and break.
fn snapshot(step: u64, points: usize) -> Snapshot {
    let place = |i: usize| [(i % 20) as f64, (i / 20) as f64, 0.5 * (i % 7) as f64];
    let t = step as f64;
    let moved = |i: usize| [0.01 * t * (i as f64).sin(), -0.02 * t, 1e-3 * i as f64];
    let columns = vec![
        (
            "displacement",
            Values::Vectors((0..points).map(moved).collect()),
        ),
        (
            "damage",
            Values::Scalars(
                (0..points)
                    .map(|i| (i as f64 * t / 900.0).fract())
                    .collect(),
            ),
        ),
        (
            "block",
            Values::Integers((0..points).map(|i| i as i32 % 5 - 1).collect()),
        ),
    ];
    Snapshot {
        step,
        time: 1e-7 * t,
        spacing: 1.0,
        ..of_columns((0..points).map(place).collect(), columns)
    }
}

fn setting() -> Setting {
    Setting {
        command: "peridyne run a.toml".into(),
        deck_text: "title = \"a </script> b\"\n[body]\nspacing = \"1 mm\" # remark\n".into(),
        understood: "body       3-D\nrun        2 steps".into(),
        dimension: 3,
        spacing: 1.0,
        units: UnitNames {
            length: "m".into(),
            time: "s".into(),
            energy: "J".into(),
        },
        fields: vec![FieldNote {
            name: "damage".into(),
            unit: String::new(),
            says: "Broken part of the bonds.".into(),
        }],
        files: vec!["history.csv".into(), "points.pvd".into()],
        ..Setting::default()
    }
}

/// A folder of results with its snapshots.
fn folder(dir: &Path, points: usize, frames: u64) -> Vec<Snapshot> {
    let options = SeriesOptions {
        pictures: vec![],
        ..SeriesOptions::default()
    };
    let mut series = Series::new(dir, options).unwrap();
    let all: Vec<Snapshot> = (0..frames).map(|n| snapshot(10 * n, points)).collect();
    all.iter().for_each(|s| series.write(s, &[]).unwrap());
    let columns = [Column::new("time", "s"), Column::new("kinetic energy", "J")];
    let mut history = History::create(&dir.join("history.csv"), &columns).unwrap();
    for n in 0..frames {
        history.push(n, &[1e-7 * n as f64, n as f64]).unwrap();
    }
    let run = json!({
        "version": "0.1.0", "title": "a </script> b", "deck": "a.toml", "deck_hash": "sha256:00", "status": "done", "particles": points,
        "bonds": 50, "steps": frames, "time_step": 1e-8, "broken_bonds": 2, "fragments": 1, "threads": 1,
        "energy": {"kinetic": 1.0, "strain": 0.5, "initial": 1.4, "balance_error": 0.1}, "warnings": ["a <warning>"],
        "setting": setting(),
    });
    fs::write(dir.join("run.json"), run.to_string()).unwrap();
    all
}

fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    let (_, rest) = text.split_once(from).unwrap_or_else(|| panic!("no {from}"));
    rest.split_once(to).unwrap().0
}

fn meta(html: &str) -> Value {
    let text = between(html, "id=\"meta\">", "</script>");
    serde_json::from_str(text).unwrap()
}

/// Numbers of a block, as the page reads them.
fn numbers(html: &str, block: &Value, points: usize) -> Vec<f64> {
    let text = between(html, &format!("id=\"b{}\">", block["at"]), "</script>");
    let bytes = STANDARD.decode(text).unwrap();
    let all = |key: &str| -> Vec<f64> {
        let list = block[key].as_array().unwrap();
        list.iter().map(|v| v.as_f64().unwrap()).collect()
    };
    let bits = block["bits"].as_u64().unwrap() as u8;
    unpacked(&bytes, points, bits, &all("low"), &all("high"))
}

#[test]
fn positions_and_values_are_those_of_the_frames() {
    let dir = tempfile::tempdir().unwrap();
    let all = folder(dir.path(), 400, 4);
    let made = write(dir.path()).unwrap();
    let html = fs::read_to_string(&made.path).unwrap();
    let meta = meta(&html);
    let scene = &meta["scenes"][0];
    assert_eq!(scene["points"], 400);
    assert_eq!(scene["first"], "damage");
    let near = |block: &Value, exact: &[f64]| {
        let read = numbers(&html, block, 400);
        let width = exact.len() / 400;
        for (at, (a, b)) in exact.iter().zip(&read).enumerate() {
            let of = |key: &str| block[key][at % width].as_f64().unwrap();
            let levels = f64::from((1u32 << block["bits"].as_u64().unwrap()) - 2);
            let quantum = (of("high") - of("low")) / levels;
            assert!((a - b).abs() <= 0.51 * quantum + 1e-12, "{at}: {a} {b}");
        }
    };
    near(&scene["reference"], &all[0].reference.concat());
    for (f, s) in all.iter().enumerate() {
        near(&scene["moved"][f], &s.displacement().concat());
        let field = |name: &str| {
            let fields = scene["fields"].as_array().unwrap();
            fields.iter().find(|f| f["name"] == name).unwrap().clone()
        };
        near(&field("damage")["blocks"][f], s.damage());
        let mark: Vec<f64> = (0..400).map(|i| f64::from(i % 5 - 1)).collect();
        assert_eq!(numbers(&html, &field("block")["blocks"][f], 400), mark);
        assert_eq!(scene["frames"][f]["step"], s.step);
    }
    assert_eq!(meta["history"]["columns"][2]["values"][3], 3.0);
    assert_eq!(meta["run"]["warnings"][0], "a <warning>");
}

#[test]
fn a_report_needs_no_network_and_nothing_leaves_its_place() {
    let dir = tempfile::tempdir().unwrap();
    folder(dir.path(), 100, 2);
    let made = write(dir.path()).unwrap();
    let html = fs::read_to_string(&made.path).unwrap();
    assert_eq!(made.bytes, html.len());
    assert!((50_000..200_000).contains(&made.bytes), "{}", made.bytes);
    for word in [
        "http:", "https:", "src=\"//", "url(//", "@import", "fetch(", "XMLHttp",
    ] {
        assert!(!html.contains(word), "{word}");
    }
    assert!(html.contains("default-src 'none'"));
    assert!(html.contains("<title>a &lt;/script&gt; b</title>"));
    let opened = html.matches("<script").count();
    assert_eq!(opened, html.matches("</script>").count());
    // the numbers, the program, and one for each block
    assert!(opened > 6, "{opened}");
}

#[test]
fn what_is_large_is_thinned_and_said() {
    let dir = tempfile::tempdir().unwrap();
    let mut all = folder(dir.path(), 40, 2);
    // noise that cannot be packed
    let mut state = 1u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64
    };
    let options = SeriesOptions {
        pictures: vec![],
        ..SeriesOptions::default()
    };
    let mut series = Series::new(dir.path(), options).unwrap();
    let n = 60_000;
    for step in 0..20 {
        let mut s = snapshot(step, n);
        let rows = (0..n).map(|_| [noise(), noise(), noise(), 0.0, noise(), noise()]);
        put(&mut s, "stress", Values::Symmetric(rows.collect()));
        series.write(&s, &[]).unwrap();
        all.push(s);
    }
    let made = write(dir.path()).unwrap();
    assert!(made.bytes <= 5_000_000, "{}", made.bytes);
    assert!(made.bytes > 3_000_000, "{}", made.bytes);
    let said = made.notes.join(" ");
    assert!(
        said.contains("of 20 frames") || said.contains("levels"),
        "{said}"
    );
    let meta = meta(&fs::read_to_string(&made.path).unwrap());
    let frames = meta["scenes"][0]["frames"].as_array().unwrap();
    assert_eq!(frames[frames.len() - 1]["step"], 19);
}

#[test]
fn a_folder_without_a_run_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let text = write(dir.path()).unwrap_err().to_string();
    assert!(
        text.ends_with("is no folder of results: it has no run.json"),
        "{text}"
    );
}

#[test]
fn a_folder_of_an_older_version_has_a_report() {
    let dir = tempfile::tempdir().unwrap();
    folder(dir.path(), 100, 3);
    let path = dir.path().join("run.json");
    let mut run: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    run.as_object_mut().unwrap().remove("setting");
    fs::write(&path, run.to_string()).unwrap();
    let made = write(dir.path()).unwrap();
    let meta = meta(&fs::read_to_string(made.path).unwrap());
    assert_eq!(meta["scenes"][0]["points"], 100);
    assert!(meta["scenes"][0]["spacing"].as_f64().unwrap() > 0.1);
}
