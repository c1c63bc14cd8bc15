//! Thermo lines and snapshots, letter by letter as LAMMPS wrote them.

use peridyne_lammps::Options;

use super::host::run;

const SCRIPT: &str = "units si
boundary s f p
atom_style peri
atom_modify map array
neighbor 0.001 bin
lattice sc 0.0005
region b block -2 2 -3 3 0 8 units lattice
region c block -2 2 -1 1 0 8 units lattice
create_box 2 b
create_atoms 1 region c
pair_style peri/pmb
pair_coeff * * 1.6863e22 0.0015001 0.0005 0.25
set group all density 2200 volume 1.25e-10
velocity all set 1.0 2.0 -0.5 units box
fix 1 all nve
timestep 1.0e-7
compute d all damage/atom
compute ra all reduce sum c_d x
thermo 5
thermo_style custom step temp pe ke etotal press vol dt time elapsed atoms c_ra[1] c_ra[2] enthalpy
dump 1 all custom 5 d.custom id type x y z vx vy vz fx c_d
dump 2 all atom 5 d.atom
dump 3 all custom 5 d.fmt id mass x xs xu ix iy iz proc
dump_modify 3 sort id format float %20.15e
run 10
write_data data.out
write_dump all custom w.dump id x y modify sort id format line \"%d %.3f %e\"
thermo_style custom step pe time atoms
thermo_modify line multi format 2 \"%12.3e\"
run 0
";

#[test]
fn lines_and_files() {
    let output = tempfile::tempdir().unwrap();
    let ran = run(
        "in.test",
        SCRIPT,
        &Options {
            output: output.path().into(),
            ..Options::default()
        },
    );
    if let Err(e) = &ran.outcome {
        panic!("{e}");
    }
    for line in [
        "Lattice spacing in x,y,z = 0.0005 0.0005 0.0005",
        "Created orthogonal box = (-0.001 -0.0015 0) to (0.001 0.0015 0.004)",
        "Created 120 atoms",
        "  using lattice units in orthogonal box = (-0.0010002 -0.0015 0) to (0.0010002 0.0015 0.004)",
        "  120 settings made for density",
        "   Step          Temp          PotEng         KinEng         TotEng         Press          Volume           Dt            Time        Elapsed      Atoms       c_ra[1]        c_ra[2]        Enthalpy   ",
        "         0   2.8119739e+26  0              693000         693000         1.9246151e+13  2.40048e-08    1e-07          0                      0         120   0              0              1155000      ",
        "         5   2.8119739e+26  0              693000         693000         1.9246151e+13  2.40048e-08    1e-07          5e-07                  5         120   0              6e-05          1155000      ",
        "------------ Step             10 ----- CPU =            0 (sec) -------------",
        "Step     =             10 PotEng   =    0.000e+00 Time     =         0.0000 ",
        "Atoms    =            120",
    ] {
        assert!(
            ran.lines.iter().any(|l| l == line),
            "missing:\n{line}\nin:\n{}",
            ran.lines.join("\n")
        );
    }
    let read = |name: &str| std::fs::read_to_string(output.path().join(name)).unwrap();
    let head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n120\nITEM: BOX BOUNDS ss ff pp\n\
        -1.0001999999999999e-03 1.0001999999999999e-03\n-1.5000000000000000e-03 1.5000000000000000e-03\n\
        0.0000000000000000e+00 4.0000000000000001e-03\n";
    let custom = format!(
        "{head}ITEM: ATOMS id type x y z vx vy vz fx c_d\n\
        1 1 -0.001 -0.0005 0 1 2 -0.5 0 0\n2 1 -0.0005 -0.0005 0 1 2 -0.5 0 0\n3 1 0 -0.0005 0 1 2 -0.5 0 0\n"
    );
    assert!(
        read("d.custom").starts_with(&custom),
        "{}",
        read("d.custom")
    );
    let atom = format!(
        "{head}ITEM: ATOMS id type xs ys zs\n1 1 9.998e-05 0.333333 0\n2 1 0.25005 0.333333 0\n"
    );
    assert!(read("d.atom").starts_with(&atom), "{}", read("d.atom"));
    let fmt = format!(
        "{head}ITEM: ATOMS id mass x xs xu ix iy iz proc\n1 2.200000000000000e+03 -1.000000000000000e-03 \
        9.998000399914840e-05 -1.000000000000000e-03 0 0 0 0\n"
    );
    assert!(read("d.fmt").starts_with(&fmt), "{}", read("d.fmt"));
    assert_eq!(read("d.fmt").matches("ITEM: TIMESTEP").count(), 3);
    let dump = read("w.dump");
    assert!(
        dump.contains("\n-9.9919999999999935e-04 1.0012000000000005e-03\n"),
        "{dump}"
    );
    assert!(
        dump.contains("ITEM: ATOMS id x y\n1 -0.001 -4.980000e-04\n2 -0.000 -4.980000e-04\n"),
        "{dump}"
    );
    let data = read("data.out");
    assert!(
        data.contains("-0.0009991999999999994 0.0010012000000000005 xlo xhi\n"),
        "{data}"
    );
    assert!(
        data.contains(
            "\n1 1 1.25e-10 2200 -0.0009989999999999995 -0.000498 0.0039995000000000005 0 0 -1\n"
        ),
        "{data}"
    );
    assert!(data.contains("Velocities\n\n1 1 2 -0.5\n"), "{data}");
}

/// The centre follows the formula at the end of each step, and the reaction opposes the force on the atoms.
#[test]
fn a_rigid_body_pushes() {
    let script = "units si
boundary f f f
atom_style peri
lattice sc 0.5
region b block -1 1 -1 1 -1 1 units box
create_box 1 b
create_atoms 1 single 0 0 0
pair_style peri/pmb
pair_coeff * * 1e9 1.6 10 0.25
set group all density 2 volume 0.125
fix 1 all nve
variable y equal 0.75-100*step*dt
fix 2 all indent 1000 sphere 0 v_y 0 1 units box
compute f all reduce sum fx fy
timestep 0.001
thermo_style custom step f_2 f_2[2] c_f[2] v_y
thermo 1
thermo_modify format float %.6g
run 1
";
    let ran = run("in.test", script, &Options::default());
    if let Err(e) = &ran.outcome {
        panic!("{e}");
    }
    // K (R − r)² = 1000 · 0.25² at the start, K/3 (R − r)³ its energy
    let line = "         0  5.20833 62.5 -62.5 0.75";
    assert!(
        ran.lines.iter().any(|l| l == line),
        "{}",
        ran.lines.join("\n")
    );
    let last = ran
        .lines
        .iter()
        .rev()
        .find(|l| l.starts_with("         1 "))
        .unwrap();
    assert!(last.ends_with(" 0.65"), "{last}");
}
