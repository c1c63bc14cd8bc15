//! `peridyne fields`: what it writes, from flags and from a file, and what it refuses.

use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Exit code, standard output and error of `peridyne fields …`, run in a folder.
fn fields(dir: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("fields")
        .args(arguments)
        .current_dir(dir)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.code(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// A tilted box of argon, as a LAMMPS dump with scaled or plain coordinates.
fn dump(frames: usize, scaled: bool, velocities: bool) -> String {
    let [lx, ly, lz, xy, xz, yz] = [4.0, 4.2, 4.4, 0.6, -0.4, 0.3];
    let mut text = String::new();
    for frame in 0..frames {
        text += &format!(
            "ITEM: TIMESTEP\n{frame}\nITEM: NUMBER OF ATOMS\n27\nITEM: BOX BOUNDS xy xz yz pp pp pp\n"
        );
        text += &format!("{:?} {:?} {xy:?}\n", -0.4, lx + 0.6);
        text += &format!("{:?} {:?} {xz:?}\n{:?} {lz:?} {yz:?}\n", 0.0, ly + 0.3, 0.0);
        let names = if scaled { "xs ys zs" } else { "xu yu zu" };
        let moving = if velocities { " vx vy vz" } else { "" };
        text += &format!("ITEM: ATOMS id type {names}{moving}\n");
        for i in 0..27 {
            let wobble = |k: usize| 0.02 * (((i * 7 + k * 5 + frame * 3) % 11) as f64 - 5.0);
            let s: Vec<f64> = [i / 9, i / 3 % 3, i % 3]
                .iter()
                .enumerate()
                .map(|(k, n)| (*n as f64 + 0.5) / 3.0 + 0.3 * wobble(k))
                .collect();
            let x = match scaled {
                true => [s[0], s[1], s[2]],
                false => [
                    s[0] * lx + s[1] * xy + s[2] * xz,
                    s[1] * ly + s[2] * yz,
                    s[2] * lz,
                ],
            };
            text += &format!("{} 1 {:?} {:?} {:?}", i + 1, x[0], x[1], x[2]);
            if velocities {
                text += &format!(
                    " {:?} {:?} {:?}",
                    3.0 * wobble(4) + 1.0,
                    2.0 * wobble(6),
                    wobble(9)
                );
            }
            text += "\n";
        }
    }
    text
}

const LJ: [&str; 14] = [
    "--potential",
    "lj",
    "--with",
    "epsilon=1",
    "--with",
    "sigma=1",
    "--with",
    "cutoff=2",
    "--units",
    "lj",
    "--kernel",
    "polynomial",
    "--width",
    "1.5",
];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&LJ[..], more].concat()
}

fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .map(|l| l.split(',').map(str::to_string).collect())
        .collect()
}

fn listing(dir: &Path) -> Vec<String> {
    let mut all: Vec<String> = std::fs::read_dir(dir)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    all.sort();
    all
}

#[test]
fn points_of_packed_scaled_and_plain_frames_are_the_same() {
    let dir = TempDir::new().unwrap();
    let dir = dir.path();
    std::fs::write(dir.join("a.dump"), dump(1, false, true)).unwrap();
    let mut packed = GzEncoder::new(vec![], Compression::default());
    packed.write_all(dump(1, true, true).as_bytes()).unwrap();
    std::fs::write(dir.join("b.dump.gz"), packed.finish().unwrap()).unwrap();
    std::fs::write(
        dir.join("points.txt"),
        "x y z\n1 1 1 # here\n\n2.5, 0.5, 3\n",
    )
    .unwrap();
    for (frames, out) in [("a.dump", "a"), ("b.dump.gz", "b")] {
        let (code, text, error) = fields(
            dir,
            &with(&["--frames", frames, "--points", "points.txt", "--out", out]),
        );
        assert_eq!(code, Some(0), "{error}");
        assert!(text.contains("1 frame"), "{text}");
    }
    let [a, b] = ["a", "b"].map(|out| rows(&dir.join(out).join("points.csv")));
    let head = "x,y,z,rho,px,py,pz,vx,vy,vz,T,e,sK_xx,sK_xy,sK_xz,sK_yx,sK_yy,sK_yz,sK_zx,sK_zy,sK_zz,sU_xx";
    assert!(a[0].join(",").starts_with(head), "{:?}", a[0]);
    for name in [
        "s_zz", "z_xy", "qK_x", "qU_y", "qC_z", "e_int", "e_pot", "zv",
    ] {
        assert!(a[0].iter().any(|c| c == name), "{name}");
    }
    assert_eq!((a.len(), b.len()), (3, 3));
    for (a, b) in a[1..].iter().flatten().zip(b[1..].iter().flatten()) {
        let [a, b] = [a, b].map(|t| t.parse::<f64>().unwrap());
        assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{a} {b}");
    }
    assert_eq!(
        listing(&dir.join("a")),
        ["fields.json", "fields.npz", "points.csv"]
    );
    let text = std::fs::read_to_string(dir.join("a/fields.json")).unwrap();
    let about: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(about["quantities"]["s"]["columns"][5], "s_yz");
    assert_eq!(about["quantities"]["sU"]["equation"], "(4.0.84)");
    assert_eq!(
        (&about["partition"], &about["pair_force"]),
        (&"site".into(), &"distances".into())
    );
    let left = |law: &str| about["residuals"][law].as_f64().unwrap();
    assert!(
        left("momentum") < 1e-2 && left("momentum_extrapolated") < 1e-3,
        "{about}"
    );
    assert!(left("energy_extrapolated") < 1e-3 && left("mass_extrapolated") < 1e-3);
    let asymmetry = about["each_frame"][0]["asymmetry_of_stress"].as_f64();
    assert!(asymmetry.unwrap() < 1e-14, "{about}");
}

#[test]
fn grids_are_images_with_means_and_each_frame() {
    let dir = TempDir::new().unwrap();
    let dir = dir.path();
    std::fs::write(dir.join("a.dump"), dump(3, true, true)).unwrap();
    let (code, _, error) = fields(
        dir,
        &with(&[
            "--frames",
            "a.dump",
            "--grid",
            "6,5,4",
            "--out",
            "out",
            "--each",
            "--threads",
            "2",
        ]),
    );
    assert_eq!(code, Some(0), "{error}");
    assert_eq!(
        listing(&dir.join("out")),
        [
            "fields.json",
            "fields.npz",
            "fields.vts",
            "frame.000000.vts",
            "frame.000001.vts",
            "frame.000002.vts",
            "frames.pvd",
            "stress.png",
            "stress.svg",
            "temperature.png",
            "temperature.svg"
        ]
    );
    let about: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(dir.join("out/fields.json")).unwrap())
            .unwrap();
    assert_eq!(about["frames_read"], 3);
    for frame in about["each_frame"].as_array().unwrap() {
        assert!(
            frame["mean_churning_over_stress"].as_f64().unwrap() < 1e-12,
            "{frame}"
        );
    }
    // the same from a file of keys, and a flag that wins over it
    let deck = "frames = \"a.dump\"\npotential = \"lennard_jones\"\nunits = \"lj\"\nkernel = \"polynomial\"\nwidth = 9.9\n\
                grid = [6, 5, 4]\nout = \"other\"\nwith = { epsilon = 1, sigma = 1.0, cutoff = 2 }\n";
    std::fs::write(dir.join("fields.toml"), deck).unwrap();
    let (code, _, error) = fields(dir, &["fields.toml", "--width", "1.5", "--threads", "1"]);
    assert_eq!(code, Some(0), "{error}");
    let [a, b] =
        ["out", "other"].map(|out| std::fs::read(dir.join(out).join("fields.npz")).unwrap());
    assert!(
        a == b,
        "flags and keys, and any number of threads, give the same arrays"
    );
}

/// Lines and planes are lists of points, and the pressure is a third of the trace.
#[test]
fn lines_planes_and_pressure() {
    let dir = TempDir::new().unwrap();
    let dir = dir.path();
    std::fs::write(dir.join("a.dump"), dump(2, true, true)).unwrap();
    let run = |more: &[&str], out: &str| {
        let all = [&["--frames", "a.dump", "--out", out][..], more].concat();
        let (code, _, error) = fields(dir, &with(&all));
        assert_eq!(code, Some(0), "{error}");
        rows(&dir.join(out).join("points.csv"))
    };
    let line = run(
        &["--line", "-1,0,0.5", "1,2,0.5", "5", "--pressure"],
        "line",
    );
    let plane = ["--plane", "-1,0,0.5", "0,0,1", "2,2,0", "2,5"];
    let plane = run(&plane, "plane");
    assert_eq!((line.len(), plane.len()), (6, 11));
    let number = |rows: &[Vec<String>], n: usize, name: &str| -> f64 {
        let place = rows[0].iter().position(|c| c == name).unwrap();
        rows[n][place].parse().unwrap()
    };
    for n in 1..6 {
        for name in ["x", "y", "z", "rho", "s_xy", "qU_z"] {
            // the first edge is the fastest
            let [a, b] = [number(&line, n, name), number(&plane, 2 * n - 1, name)];
            assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "{name}: {a} {b}");
        }
        let trace: f64 = ["s_xx", "s_yy", "s_zz"]
            .map(|s| number(&line, n, s))
            .iter()
            .sum();
        let pressure = number(&line, n, "pressure");
        assert!((pressure + trace / 3.0).abs() < 1e-12 * (1.0 + pressure.abs()));
    }
    assert!(!plane[0].contains(&"pressure".to_string()));
    let text = std::fs::read_to_string(dir.join("line/fields.json")).unwrap();
    assert!(text.contains("-(s_xx + s_yy + s_zz)/3"));
    // the same from a file of keys
    let deck = "frames = \"a.dump\"\npotential = \"lj\"\nunits = \"lj\"\nkernel = \"polynomial\"\nwidth = 1.5\nout = \"keys\"\n\
                with = { epsilon = 1, sigma = 1.0, cutoff = 2 }\npressure = true\n\
                line = { from = [-1, 0, 0.5], to = [1, 2, 0.5], points = 5 }\n";
    std::fs::write(dir.join("fields.toml"), deck).unwrap();
    let (code, _, error) = fields(dir, &["fields.toml"]);
    assert_eq!(code, Some(0), "{error}");
    assert_eq!(rows(&dir.join("keys/points.csv")), line);
}

/// Without velocities: what can be had is there, the rest is empty, and the first line says why.
#[test]
fn frames_without_velocities_have_fewer_fields() {
    let dir = TempDir::new().unwrap();
    let dir = dir.path();
    std::fs::write(dir.join("a.dump"), dump(1, true, false)).unwrap();
    std::fs::write(dir.join("p"), "1 1 1\n").unwrap();
    let (code, text, error) = fields(
        dir,
        &with(&["--frames", "a.dump", "--points", "p", "--out", "out"]),
    );
    assert_eq!(code, Some(0), "{error}");
    assert!(text.contains("velocities"), "{text}");
    let rows = rows(&dir.join("out/points.csv"));
    let last = rows[0].last().unwrap();
    assert!(
        last.contains("no p v T e") && last.contains("velocities"),
        "{last}"
    );
    assert_eq!(rows[0].len(), rows[1].len());
    for (name, value) in rows[0].iter().zip(&rows[1]) {
        let there = ["x", "y", "z", "rho", "e_pot"].contains(&name.as_str())
            || name.starts_with("sU_")
            || name.starts_with("z_");
        assert_eq!(!value.is_empty(), there, "{name}: {value}");
    }
}

#[test]
fn what_is_wrong_is_said_and_nothing_is_written() {
    let dir = TempDir::new().unwrap();
    let dir = dir.path();
    let good = dump(2, true, true);
    std::fs::write(dir.join("good.dump"), &good).unwrap();
    std::fs::write(dir.join("p"), "1 1 1\n").unwrap();
    std::fs::write(dir.join("bad"), "1 1 1\n1 1\n").unwrap();
    let mut packed = GzEncoder::new(vec![], Compression::default());
    packed.write_all(good.repeat(20).as_bytes()).unwrap();
    let packed = packed.finish().unwrap();
    std::fs::write(dir.join("cut.dump.gz"), &packed[..packed.len() / 2]).unwrap();
    let mut flipped = packed.clone();
    let middle = flipped.len() / 2;
    flipped[middle] ^= 0x55;
    std::fs::write(dir.join("flipped.dump.gz"), flipped).unwrap();
    std::fs::write(dir.join("cut.dump"), &good[..good.len() - 100]).unwrap();
    let fewer = dump(1, true, true).replace("ATOMS\n27", "ATOMS\n26");
    let fewer = fewer.trim_end().rsplit_once('\n').unwrap().0.to_string();
    std::fs::write(
        dir.join("changing.dump"),
        format!("{}{fewer}\n", dump(1, true, true)),
    )
    .unwrap();
    let xyz = |name: &str| {
        format!(
            "2\nLattice=\"5 0 0 0 5 0 0 0 5\" Properties=species:S:1:pos:R:3\n{name} 0 0 0\nCu 1 1 1\n"
        )
    };
    std::fs::write(dir.join("unknown.xyz"), xyz("Cu").replace("Cu", "Qq")).unwrap();
    std::fs::write(dir.join("two.xyz"), xyz("Ni")).unwrap();
    std::fs::write(dir.join("same.xyz"), xyz("Cu").replace("1 1 1", "0 0 0")).unwrap();
    std::fs::write(
        dir.join("typo.toml"),
        "frames = \"good.dump\"\nkernal = \"gaussian\"\n",
    )
    .unwrap();
    let frames = |name: &'static str| with(&["--frames", name, "--points", "p", "--out", "out"]);
    let without = |flag: &str| {
        let mut all = frames("good.dump");
        let at = all.iter().position(|a| *a == flag).unwrap();
        all.drain(at..at + 2);
        all
    };
    let changed = |flag: &str, value: &'static str| {
        let mut all = frames("good.dump");
        let at = all.iter().position(|a| *a == flag).unwrap();
        all[at + 1] = value;
        all
    };
    let metal = |name: &'static str| {
        let mut all = frames(name);
        let at = all.iter().position(|a| *a == "--units").unwrap();
        all[at + 1] = "metal";
        all
    };
    let cases: Vec<(Vec<&str>, &str)> = vec![
        (without("--units"), "--units is missing"),
        (without("--kernel"), "--kernel is missing"),
        (without("--width"), "--width is missing"),
        (without("--out"), "--out is missing"),
        (without("--points"), "--grid is missing"),
        (without("--potential"), "--potential is missing"),
        (without("--frames"), "--frames is missing"),
        (
            changed("--units", "inches"),
            "expected metal, real, lj, si or none",
        ),
        (
            changed("--kernel", "gauss"),
            "--kernel gauss: expected polynomial",
        ),
        (changed("--width", "-1"), "must be positive"),
        (
            changed("--potential", "lenard"),
            "no potential named lenard",
        ),
        (changed("--points", "bad"), "bad:2: expected x y z"),
        // a box of a few, and a reach of thousands
        (
            frames("good.dump")
                .iter()
                .map(|a| if *a == "cutoff=2" { "cutoff=4000" } else { a })
                .collect(),
            "is many times the cell",
        ),
        (
            with(&[
                "--frames",
                "good.dump",
                "--line",
                "0,0,0",
                "1,1",
                "5",
                "--out",
                "out",
            ]),
            "--line: expected x,y,z, three finite numbers, found `1,1`",
        ),
        (
            with(&[
                "--frames",
                "good.dump",
                "--line",
                "0,0,0",
                "1,1,1",
                "1",
                "--out",
                "out",
            ]),
            "--line: expected a number of points from 2",
        ),
        (
            with(&[
                "--frames",
                "good.dump",
                "--plane",
                "0,0,0",
                "1,0,0",
                "0,1,0",
                "5",
                "--out",
                "out",
            ]),
            "--plane: expected N,M",
        ),
        (
            with(&[
                "--frames",
                "good.dump",
                "--line",
                "0,0,0",
                "1,1,1",
                "3",
                "--grid",
                "2,2,2",
                "--out",
                "out",
            ]),
            "--grid and --line: give one of them",
        ),
        (
            with(&[
                "--frames",
                "good.dump",
                "--points",
                "p",
                "--molecules",
                "good.data",
                "--out",
                "out",
            ]),
            "--special is missing",
        ),
        (
            with(&[
                "--frames",
                "good.dump",
                "--points",
                "p",
                "--molecules",
                "good.data",
                "--special",
                "0,0",
                "--out",
                "out",
            ]),
            "--special 0,0: expected three numbers",
        ),
        (
            with(&[
                "--frames",
                "good.dump",
                "--points",
                "p",
                "--molecules",
                "none.data",
                "--special",
                "0,0,0",
                "--out",
                "out",
            ]),
            "none.data",
        ),
        (changed("--points", "nowhere"), "nowhere: cannot read it"),
        (changed("--frames", "nowhere.dump"), "cannot read it"),
        (changed("--with", "epsilom=1"), "epsilom"),
        (
            with(&["--frames", "good.dump", "--grid", "4,4", "--out", "out"]),
            "--grid 4,4: expected three",
        ),
        (
            with(&[
                "--frames",
                "good.dump",
                "--grid",
                "4,4,4",
                "--average",
                "z",
                "--out",
                "out",
            ]),
            "tilted",
        ),
        (frames("cut.dump.gz"), "damaged or cut off"),
        (frames("cut.dump"), "cut.dump:"),
        (frames("changing.dump"), "frame 1: it has 26 atoms"),
        // frames that were written go too
        (
            with(&[
                "--frames",
                "changing.dump",
                "--grid",
                "2,2,2",
                "--each",
                "--out",
                "out",
            ]),
            "frame 1: it has 26 atoms",
        ),
        (frames("flipped.dump.gz"), "flipped.dump.gz"),
        (metal("unknown.xyz"), "Qq has no mass"),
        (frames("two.xyz"), "Ni, Cu"),
        (frames("same.xyz"), "coincide"),
        (vec!["typo.toml"], "typo.toml:2: unknown field `kernal`"),
    ];
    for (arguments, part) in cases {
        let (code, _, error) = fields(dir, &arguments);
        // long messages are broken into lines
        let error = error
            .replace("\n  │ ", " ")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        assert_eq!(code, Some(2), "{arguments:?}: {error}");
        assert!(error.contains(part), "{part}: {error}");
        assert!(!dir.join("out").exists(), "{part}: something was written");
    }
    // a potential without an end reaches everywhere
    let endless: Vec<&str> = frames("good.dump")
        .into_iter()
        .filter(|a| *a != "cutoff=2")
        .collect();
    let at = endless.iter().rposition(|a| *a == "--with").unwrap();
    let endless = [&endless[..at], &endless[at + 1..]].concat();
    let (code, _, error) = fields(dir, &endless);
    assert_eq!(code, Some(2));
    assert!(error.contains("cut-off"), "{error}");
}

/// `--coordinate` adds y, its flux and the angular momentum; without it they are not there, and residuals of all laws are.
#[test]
fn the_material_coordinate_is_written_where_it_is_asked_for() {
    let dir = TempDir::new().unwrap();
    let dir = dir.path();
    std::fs::write(dir.join("a.dump"), dump(1, false, true)).unwrap();
    std::fs::write(dir.join("points.txt"), "1 1 1\n2.5 0.5 3\n").unwrap();
    let mut heads = vec![];
    for (out, more) in [("with", &["--coordinate"][..]), ("without", &[])] {
        let own = ["--frames", "a.dump", "--points", "points.txt", "--out", out];
        let (code, _, error) = fields(dir, &with(&[&own, more].concat()));
        assert_eq!(code, Some(0), "{error}");
        heads.push(rows(&dir.join(out).join("points.csv")));
        let text = std::fs::read_to_string(dir.join(out).join("fields.json")).unwrap();
        let about: serde_json::Value = serde_json::from_str(&text).unwrap();
        for law in ["internal_energy", "coordinate", "angular_momentum"] {
            let of = &about["each_frame"][0]["residuals"][law];
            let [value, expected] = ["value", "expected"].map(|k| of[k].as_f64().unwrap());
            assert!((value / expected - 1.0).abs() < 0.5, "{law}: {of}");
        }
    }
    let [with, without] = [&heads[0], &heads[1]];
    let more = "yx,yy,yz,ud_xx,ud_xy,ud_xz,ud_yx,ud_yy,ud_yz,ud_zx,ud_zy,ud_zz,lx,ly,lz";
    assert_eq!(
        with[0].join(","),
        format!("{},{more}", without[0].join(","))
    );
    for row in &with[1..] {
        let of = |name: &str| -> f64 {
            let place = with[0].iter().position(|c| c == name).unwrap();
            row[place].parse().unwrap()
        };
        let l = of("rho") * (of("yx") * of("vy") - of("yy") * of("vx"));
        assert!((of("lz") - l).abs() < 1e-12 * (1.0 + l.abs()));
        // the mass at a point is centred near it
        assert!((of("yx") - of("x")).abs() < 1.0 && of("yx") != of("x"));
    }
}
