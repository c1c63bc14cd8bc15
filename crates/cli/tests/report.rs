//! `report.html` at the end of runs, and by `peridyne report`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn deck(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    root.join(name).to_str().unwrap().to_string()
}

fn peridyne(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Runs a deck into a folder; what it says.
fn run(out: &Path, name: &str, sets: &[&str]) -> String {
    let (file, out) = (deck(name), out.to_str().unwrap());
    let mut arguments = vec!["run", &file, "--out", out, "--threads", "1"];
    for set in sets {
        arguments.extend(["--set", set]);
    }
    let done = peridyne(&arguments);
    let said = String::from_utf8_lossy(&done.stdout).to_string();
    assert!(done.status.success(), "{said}");
    said
}

fn page(out: &Path) -> (PathBuf, String) {
    let path = out.join("report.html");
    let html = fs::read_to_string(&path).unwrap();
    assert!(html.ends_with("</html>\n") && !html.contains("https:"));
    (path, html)
}

#[test]
fn a_folder_gives_the_report_that_its_run_gave() {
    let dir = tempfile::tempdir().unwrap();
    let said = run(dir.path(), "kalthoff.toml", &["body.spacing=5 mm"]);
    assert!(said.contains("report: "), "{said}");
    let (path, html) = page(dir.path());
    for text in [
        "Kalthoff-Winkler",
        "--set 'body.spacing=5 mm'",
        "square lattice of 5 mm",
        "Silling",
        "\"name\":\"displacement\"",
    ] {
        assert!(html.contains(text), "{text}");
    }
    fs::remove_file(&path).unwrap();
    let done = peridyne(&["report", dir.path().to_str().unwrap()]);
    assert!(done.status.success());
    assert_eq!(page(dir.path()).1, html);
}

#[test]
fn atoms_and_laws_have_reports_and_decks_can_do_without() {
    let dir = tempfile::tempdir().unwrap();
    run(&dir.path().join("a"), "alloy.toml", &[]);
    let (_, html) = page(&dir.path().join("a"));
    assert!(html.contains("\"names\":[\"Aa\",\"Bb\",\"gas\"]"));
    run(&dir.path().join("b"), "conservation/diffusion.toml", &[]);
    let (_, html) = page(&dir.path().join("b"));
    assert!(html.contains("\"kind\":\"law\"") && html.contains("nonlocal diffusion"));
    let said = run(
        &dir.path().join("c"),
        "bar_wave.toml",
        &["output.report=false"],
    );
    assert!(!said.contains("report: ") && !dir.path().join("c/report.html").exists());
}

#[test]
fn a_folder_without_a_run_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let done = peridyne(&["report", dir.path().to_str().unwrap()]);
    let said = String::from_utf8_lossy(&done.stderr).to_string();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("no run.json"), "{said}");
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

/// A disk that a sphere strikes, as a script with a dump.
const SCRIPT: &str = "units si
dimension 3
boundary s s s
atom_style peri
atom_modify map array
neighbor 0.001 bin
lattice sc 0.0005
region target cylinder y 0.0 0.0 0.003 -0.0015 0.0 units box
create_box 1 target
create_atoms 1 region target
pair_style peri/pmb
pair_coeff * * 1.6863e22 0.0015001 0.0005 0.25
set group all density 2200
set group all volume 1.25e-10
velocity all set 0.0 0.0 0.0 sum no units box
fix F1 all nve
variable y equal \"0.00110 - 100*step*dt\"
fix F2 all indent 1e17 sphere 0.0 v_y 0.0 0.001 units box
compute C1 all damage/atom
timestep 1.0e-7
thermo 40
dump D1 all custom 40 dump.peri id type x y z c_C1
run 120
run 80
";

fn meta(html: &str) -> serde_json::Value {
    let (_, rest) = html.split_once("id=\"meta\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn a_script_has_a_report_of_its_dump_and_its_thermo_output() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("in.disk");
    fs::write(&file, SCRIPT).unwrap();
    let out = dir.path().join("out");
    let done = peridyne(&[
        "run",
        file.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ]);
    let said = String::from_utf8_lossy(&done.stdout).to_string();
    assert!(done.status.success() && said.contains("report: "), "{said}");
    let (path, html) = page(&out);
    let told = meta(&html);
    let [dumped, last] = [&told["scenes"][0], &told["scenes"][1]];
    let times: Vec<f64> = { dumped["frames"].as_array().unwrap().iter() }
        .map(|f| f["value"].as_f64().unwrap())
        .collect();
    let expected: Vec<f64> = (0..6).map(|n| 4e-6 * f64::from(n)).collect();
    assert!(
        times
            .iter()
            .zip(&expected)
            .all(|(a, b)| (a - b).abs() < 1e-12),
        "{times:?}"
    );
    assert_eq!((times.len(), &dumped["first"]), (6, &"damage".into()));
    assert_eq!(last["frames"].as_array().unwrap().len(), 1);
    // the sphere comes down by 100 m/s
    let ball = &dumped["balls"][0];
    assert_eq!(ball["path"].as_array().unwrap().len(), 6);
    assert!(
        (ball["path"][5][2].as_f64().unwrap() + 9e-4).abs() < 1e-12,
        "{ball}"
    );
    let columns = told["history"]["columns"].as_array().unwrap();
    let names: Vec<&str> = columns
        .iter()
        .map(|c| c["name"].as_str().unwrap())
        .collect();
    assert_eq!(names[..3], ["step", "time", "Temp"]);
    assert!(html.contains("pair_style peri/pmb") && html.contains("cubic lattice"));
    fs::remove_file(&path).unwrap();
    assert!(
        peridyne(&["report", out.to_str().unwrap()])
            .status
            .success()
    );
    assert_eq!(page(&out).1, html);
}

#[test]
fn loads_supports_cracks_free_balls_and_slices_are_in_reports() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    run(&at("k"), "kalthoff.toml", &["body.spacing=5 mm"]);
    let scene = &meta(&page(&at("k")).1)["scenes"][0];
    let loads = scene["marks"]["loads"].as_array().unwrap();
    assert_eq!((loads.len(), &loads[0]["toward"][0]), (7, &1.0.into()));
    assert_eq!(loads[0]["says"], "velocity of struck: 22 m/s at most");
    assert_eq!(scene["marks"]["cracks"].as_array().unwrap().len(), 2);
    run(&at("b"), "layered_block.toml", &["run.steps=40"]);
    let scene = &meta(&page(&at("b")).1)["scenes"][0];
    let path = scene["balls"][0]["path"].as_array().unwrap();
    let heights: Vec<f64> = path.iter().map(|p| p[3].as_f64().unwrap()).collect();
    assert!(
        heights.len() > 10 && heights.windows(2).all(|h| h[1] < h[0]),
        "{heights:?}"
    );
    run(&at("f"), "arrows_and_films.toml", &["run.duration=4 us"]);
    let told = meta(&page(&at("f")).1);
    assert_eq!(told["pictures"].as_array().unwrap().len(), 1);
    assert_eq!(told["pictures"][0]["name"], "smooth/stress.png");
    for name in [
        "smooth/stress_film.gif",
        "velocity.png",
        "velocity_film.png",
    ] {
        assert!(at("f").join(name).is_file(), "{name}");
    }
}

#[test]
fn arrows_want_a_vector() {
    let dir = tempfile::tempdir().unwrap();
    for (name, set, told) in [
        (
            "pulled_plate.toml",
            "damage",
            "damage has no direction: it is no vector",
        ),
        ("pulled_plate.toml", "wind", "there is no field `wind`"),
        (
            "bar_wave.toml",
            "velocity",
            "arrows are drawn in 2-D and 3-D",
        ),
    ] {
        let set = format!("output.pictures=[{{ arrows = \"{set}\" }}]");
        let (file, out) = (deck(name), dir.path().to_str().unwrap().to_string());
        let done = peridyne(&["run", &file, "--out", &out, "--set", &set]);
        let said = String::from_utf8_lossy(&done.stderr).to_string();
        assert_eq!(done.status.code(), Some(2), "{said}");
        assert!(said.contains(told), "{said}");
    }
}
