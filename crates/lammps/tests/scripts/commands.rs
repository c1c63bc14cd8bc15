//! What commands write, letter by letter as LAMMPS (22 Jul 2025) wrote it, and where they may write.

use std::path::Path;

use peridyne_lammps::Options;

use super::host::{Ran, run};

const BODY: &str = "units si
boundary f f f
atom_style peri
lattice sc 0.0005
region box block -10 10 -10 10 -10 10
region body block -2 2 -2 2 -2 2
create_box 2 box
create_atoms 1 region body
pair_style peri/pmb
pair_coeff * * 1.6863e22 0.0015001 0.02 0.25
set group all density 2200 volume 1.25e-10
velocity all set 1 0 0
fix F1 all nve
timestep 1e-7
";

/// Runs the body with more commands; what it printed, and the folder it wrote to.
fn with(commands: &str) -> (Ran, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let options = Options {
        output: folder.path().into(),
        ..Options::default()
    };
    let ran = run("in.test", &format!("{BODY}{commands}"), &options);
    if let Err(e) = &ran.outcome {
        panic!("{e} ({:?})", e.help);
    }
    (ran, folder)
}

fn read(folder: &tempfile::TempDir, name: &str) -> String {
    std::fs::read_to_string(folder.path().join(name)).unwrap()
}

#[test]
fn fixes_print_and_average() {
    let (ran, folder) = with("compute c all reduce sum x vx
variable v equal step*2
variable k equal step+0.5
fix P all print 2 \"s $(step) v ${v}\" file p.txt
fix P2 all print 2 \"t ${v}\" append p2.txt screen no title \"# hello\"
fix A all ave/time 1 2 4 c_c[1] v_v file a.txt
fix A2 all ave/time 2 1 2 v_v v_k ave running file a2.txt mode scalar start 2 title1 \"# one\" format \" %.3f\"
fix A3 all ave/time 1 2 2 v_k ave window 3 file a3.txt
fix A4 all ave/time 4 1 4 c_c mode vector file a4.txt
thermo 4
thermo_style custom step f_A[1] f_A[2] f_A2[1] f_A3
run 4
run 4
");
    assert_eq!(
        read(&folder, "p.txt"),
        "# Fix print output for fix P\ns 0 v 0\ns 2 v 4\ns 4 v 8\ns 4 v 8\ns 6 v 12\ns 8 v 16\n"
    );
    assert_eq!(
        read(&folder, "p2.txt"),
        "# hello\nt 0\nt 4\nt 8\nt 8\nt 12\nt 16\n"
    );
    assert_eq!(
        read(&folder, "a.txt"),
        "# Time-averaged data for fix A\n# TimeStep c_c[1] v_v\n4 2.1875e-08 7\n8 4.6875e-08 15\n"
    );
    assert_eq!(
        read(&folder, "a2.txt"),
        "# one\n# TimeStep v_v v_k\n0 0.000 0.500\n2 2.000 1.500\n4 4.000 2.500\n6 6.000 3.500\n8 8.000 4.500\n"
    );
    assert_eq!(
        read(&folder, "a3.txt"),
        "# Time-averaged data for fix A3\n# TimeStep v_k\n2 2\n4 3\n6 4\n8 6\n"
    );
    assert!(
        read(&folder, "a4.txt").ends_with("\n4 2\n1 2.5e-08\n2 0.0625\n8 2\n1 5e-08\n2 0.0625\n"),
        "{}",
        read(&folder, "a4.txt")
    );
    for line in [
        "         4   2.1875e-08     7              4              3            ",
        "         8   4.6875e-08     15             8              6            ",
    ] {
        assert!(
            ran.lines.iter().any(|l| l == line),
            "{line}\n{}",
            ran.lines.join("\n")
        );
    }
    // before the heading, as in LAMMPS
    let at = |line: &str| ran.lines.iter().position(|l| l.starts_with(line)).unwrap();
    assert!(at("s 0 v 0") < at("   Step"));
}

#[test]
fn thermo_as_yaml_and_the_log() {
    let (ran, folder) = with(
        "log run.log
thermo_style custom step time
thermo_modify line yaml
thermo 1
run 1
log none
thermo_modify format float %.3e
run 1
",
    );
    let head = "---\nkeywords: ['Step', 'Time', ]\ndata:\n  - [0, 0, ]\n  - [1, 1e-07, ]\n...\n";
    assert!(
        ran.lines.join("\n").contains(head),
        "{}",
        ran.lines.join("\n")
    );
    assert!(ran.lines.iter().any(|l| l == "  - [2, 2.000e-07, ]"));
    let log = read(&folder, "run.log");
    assert!(log.contains(head) && !log.contains("2.000e-07"), "{log}");
}

#[test]
fn dumps_choose_and_sort() {
    let (_, folder) = with(
        "dump A all custom 2 a.dump id x y
dump_modify A thresh x < 0 thresh y >= 0.0005 sort -1
dump B all custom 2 b.dump id
variable e equal stride(1,100,3)
dump_modify B every v_e
dump C all xyz 2 c.xyz
dump_modify C element Fe B format line \"%s %.3f %.3f %.3e\"
dump D all custom 2 d.dump id element x
dump_modify D sort id thresh id <= 3 element X Y
run 8
",
    );
    let a = read(&folder, "a.dump");
    assert!(
        a.starts_with("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n20\n"),
        "{a}"
    );
    let rows = "ITEM: ATOMS id x y\n122 -0.0005 0.001\n121 -0.001 0.001\n117 -0.0005 0.0005\n116 -0.001 0.0005\n97 ";
    assert!(a.contains(rows), "{a}");
    let steps = |text: &str| -> Vec<u64> {
        let lines: Vec<&str> = text.lines().collect();
        let after = lines.windows(2).filter(|w| w[0] == "ITEM: TIMESTEP");
        after.map(|w| w[1].parse().unwrap()).collect()
    };
    assert_eq!(steps(&read(&folder, "b.dump")), [1, 4, 7]);
    let c = read(&folder, "c.xyz");
    let first = "125\n Atoms. Timestep: 0\nFe -0.001 -0.001 -1.000e-03\nFe -0.001 -0.001 -1.000e-03\nFe 0.000 -0.001 -1.000e-03\n";
    assert!(c.starts_with(first), "{c}");
    let d = read(&folder, "d.dump");
    assert!(
        d.contains("ITEM: ATOMS id element x\n1 X -0.001\n2 X -0.0005\n3 X 0\nITEM: TIMESTEP\n2\n"),
        "{d}"
    );
}

#[test]
fn variables_of_files_and_of_the_environment() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("values.txt"),
        "# speeds\n1.5\n\n2.5 # fast\n",
    )
    .unwrap();
    let name = folder.path().join("in.test").display().to_string();
    let script = "variable v file values.txt\nlabel again\nprint \"> ${v} $(2*v_v)\"\nnext v\njump SELF again\nvariable h getenv PATH\nprint \"> $(v_h == v_h)\"\nclear\nunits si\nvariable w equal 3\nprint \"> ${w}\"\n";
    let script = script.replace("print \"> $(v_h == v_h)\"\n", "");
    let ran = run(&name, &script, &Options::default());
    if let Err(e) = &ran.outcome {
        panic!("{e}");
    }
    let said: Vec<&String> = ran.lines.iter().filter(|l| l.starts_with("> ")).collect();
    assert_eq!(said, ["> 1.5 3", "> 2.5 5", "> 3"]);
}

/// As many terms as anybody likes, for one number and for each atom.
#[test]
fn long_formulas_do_not_nest() {
    let terms = vec!["1"; 5000].join("+");
    let (ran, _) = with(&format!(
        "variable n equal {terms}\nvariable a atom x*0+{terms}\nprint \"> ${{n}} $(v_a[3])\"\n"
    ));
    assert!(
        ran.lines.iter().any(|l| l == "> 5000 5000"),
        "{}",
        ran.lines.join("\n")
    );
}

#[test]
fn scripts_write_where_they_may() {
    let folder = tempfile::tempdir().unwrap();
    let (inside, outside) = (folder.path().join("in"), folder.path().join("out"));
    std::fs::create_dir_all(&inside).unwrap();
    std::fs::create_dir_all(&outside).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(&outside, inside.join("link")).unwrap();
    let target = outside.join("x.txt");
    let options = |allow_outside, dry| Options {
        output: inside.clone(),
        allow_outside,
        dry,
        ..Options::default()
    };
    let script = |name: &Path| format!("print hello file {}\n", name.display());
    let mut names = vec![target.clone(), Path::new("../out/x.txt").to_path_buf()];
    if cfg!(unix) {
        names.push(Path::new("link/x.txt").to_path_buf());
    }
    for name in &names {
        let ran = run("in.test", &script(name), &options(false, false));
        let Err(e) = ran.outcome else {
            panic!("{} was written", name.display());
        };
        assert!(e.message.contains("lies outside the output folder"), "{e}");
        assert!(e.help.unwrap().contains("--allow-outside"));
    }
    assert!(!target.exists());
    run(
        "in.test",
        &script(Path::new("y.txt")),
        &options(false, false),
    )
    .outcome
    .unwrap();
    assert_eq!(
        std::fs::read_to_string(inside.join("y.txt")).unwrap(),
        "hello\n"
    );
    run("in.test", &script(&target), &options(true, false))
        .outcome
        .unwrap();
    assert_eq!(std::fs::read_to_string(&target).unwrap(), "hello\n");
    // a check writes nothing, whatever the script says
    let all = format!(
        "{BODY}log z.log\nprint hello file z.txt\nwrite_data z.data\nwrite_dump all custom z.dump id x\ndump d all custom 1 z2.dump id\nfix P all print 1 hello file z3.txt\nrun 1\n"
    );
    run("in.test", &all, &options(false, true)).outcome.unwrap();
    let mut left: Vec<String> = std::fs::read_dir(&inside)
        .unwrap()
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    left.sort();
    left.retain(|n| n != "link");
    assert_eq!(left, ["y.txt"]);
}

#[test]
fn lost_atoms_are_ignored_or_told() {
    for (how, notes) in [("ignore", 0), ("warn", 1)] {
        let (ran, folder) = with(&format!(
            "neighbor 0.0005 bin\nregion e block 1.9 INF INF INF INF INF\ngroup e region e
velocity e set 60000 0 0 units box
thermo_style custom step atoms
thermo_modify lost {how}
dump d all custom 3 d.dump id
thermo 1\nrun 3\nprint \"> $(atoms) $(count(e)) $(count(all))\"\n"
        ));
        assert!(
            ran.lines.iter().any(|l| l == "> 100 0 100"),
            "{}",
            ran.lines.join("\n")
        );
        let told = ran
            .lines
            .iter()
            .filter(|l| l.contains("lost atoms: original 125 current 100"));
        assert_eq!(told.count(), notes, "{}", ran.lines.join("\n"));
        assert!(
            read(&folder, "d.dump").contains("ITEM: TIMESTEP\n3\nITEM: NUMBER OF ATOMS\n100\n")
        );
    }
}
