//! Formulas, conditions and loops, against numbers and lines that LAMMPS printed.

use peridyne_lammps::Options;

use super::host::run;

pub const BOX: &str = "units si
boundary f f f
atom_style peri
atom_modify map array
lattice sc 0.5
region b block -2 2 -3 3 0 4 units lattice
create_box 1 b
create_atoms 1 box
pair_style peri/pmb
pair_coeff * * 1.6863e22 1.6 0.0005 0.25
set group all density 2200 volume 1.25e-10
";

/// Lines that `script` prints with `print` (each must begin with `> `).
fn printed(script: &str) -> Vec<String> {
    let ran = run("in.test", script, &Options::default());
    if let Err(e) = &ran.outcome {
        panic!("{e} ({:?})", e.help);
    }
    ran.lines
        .iter()
        .filter_map(|l| l.strip_prefix("> "))
        .map(str::to_string)
        .collect()
}

#[test]
fn formulas() {
    let table: Vec<Vec<&str>> = include_str!("values.txt")
        .lines()
        .filter(|l| !l.starts_with('#'))
        .map(|l| l.split(" ; ").collect())
        .collect();
    assert!(table.len() > 100);
    let mut script = BOX.to_string();
    for (k, row) in table.iter().enumerate() {
        script += &format!(
            "variable q{k} equal \"{}\"\nprint \"> $(v_q{k})\"\nprint \"> ${{q{k}}}\"\n",
            row[0]
        );
    }
    let lines = printed(&script);
    for (row, lines) in table.iter().zip(lines.chunks(2)) {
        assert_eq!(lines, &row[1..], "{}", row[0]);
    }
}

#[test]
fn functions_of_the_step() {
    let mut script = format!("{BOX}timestep 1e-3\n");
    let mut expected = Vec::new();
    let mut formulas = Vec::new();
    for line in include_str!("steps.txt").lines() {
        if let Some(names) = line.strip_prefix("# step ; ") {
            let names = names
                .split(", as LAMMPS")
                .next()
                .unwrap()
                .replace(" time", "");
            formulas = names
                .trim_end_matches(',')
                .split(' ')
                .map(str::to_string)
                .collect();
            formulas.push("time".into());
            continue;
        }
        let (step, values) = line.split_once(" ; ").unwrap();
        let print: Vec<String> = formulas
            .iter()
            .map(|f| format!("$({})", f.trim_end_matches(',')))
            .collect();
        script += &format!("reset_timestep {step}\nprint \"> {}\"\n", print.join(" "));
        expected.push(values.to_string());
    }
    assert!(expected.len() > 20);
    let said = printed(&script);
    assert_eq!(said.len(), expected.len());
    // sines and roots of two libraries differ in the last place
    let numbers = |line: &str| -> Vec<f64> {
        let words = line.split(' ').map(|word| word.parse().unwrap());
        words.collect()
    };
    for (ours, lammps) in said.iter().zip(&expected) {
        let (a, b) = (numbers(ours), numbers(lammps));
        assert_eq!(a.len(), b.len(), "{ours}");
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-15 * b.abs();
        assert!(a.iter().zip(&b).all(near), "{ours}\n{lammps}");
    }
}

#[test]
fn texts_loops_and_conditions() {
    let script = r#"
variable s string "hello world"
variable i index a b c
variable l loop 3
variable l2 loop 2 4
variable l3 loop 8 10 pad
variable in internal 2.5
variable n equal 1.23456
variable f format n %5.2f
print "> $s/$f/${i}/${l}/${l2}/${l3}/${in}/$n"
print "> x $(v_n:%8.3f)| x"
next i
print '> $i'
print "> A 'in' $(1+1)"
print """> triple "x" 'y' $(2*3)"""
label loop
print "> loop $l"
next l
jump SELF loop
if "$n > 1 && (1 == 2 || 3 <= 3)" then "print '> yes $n'" "print '> two'" else "print '> no'"
if "${i} == b" then "print '> isb'"
if "1 > 2" then "print '> a'" elif "2>1" "print '> b'" else "print '> c'"
variable a equal 2
variable b equal $a+1
variable c equal "v_a*2"
variable a equal 7
print "> $b $c" # a comment
variable k loop 2
print &
"> $k&
c"
print "> $(1e-5*3) $(100000*10) $(1e20)"
"#;
    // the words in single quotes of a condition's command are substituted when the line is read
    let expected = [
        "hello world/ 1.23/a/1/2/08/2.5/1.23456",
        "x    1.235| x",
        "b",
        "A 'in' 2",
        "triple \"x\" 'y' 6",
        "loop 1",
        "loop 2",
        "loop 3",
        "yes 1.23456",
        "two",
        "isb",
        "b",
        "3 14",
        "1c",
        "3.0000000000000004148e-05 1000000 1e+20",
    ];
    assert_eq!(printed(script), expected);
}

#[test]
fn atoms_groups_and_settings() {
    let script = format!(
        "{BOX}
velocity all set 1 2 3
print \"> $(vx[1]) $(vz[7])\"
variable w atom x+8
velocity all set 4 v_w NULL
print \"> $(vx[1]) $(vy[1]) $(vz[1])\"
velocity all set 1 1 1 sum yes units box
print \"> $(vx[1]) $(vy[1])\"
group g id 1 3:5 9
group h region b
group d subtract h g
group u union d g
group n intersect d g
group t id 1:10:3
print \"> $(count(g)) $(count(h)) $(count(d)) $(count(u)) $(count(n)) $(count(t))\"
variable nx atom x*2
variable ny atom x+100
set group g x v_nx y v_ny
print \"> $(x[1]) $(y[1]) $(x[2])\"
variable r atom random(0,1,12345)
set group all x v_r
print \"> $(x[1]:%.17g) $(x[2]:%.17g) $(x[3]:%.17g)\"
"
    );
    let expected = [
        "0.5 1.5",
        "2 7 1.5",
        "3 8",
        "5 96 91 96 0 4",
        "-2 98 -0.5",
        "0.86995309591293335 0.010425925254821777 0.29356783628463745",
    ];
    assert_eq!(printed(&script), expected);
}

#[test]
fn runs_in_parts_ramp_over_the_whole() {
    let script = format!(
        "{BOX}fix 1 all nve
variable t equal ramp(0,1)
variable n equal step
run 4 every 2 \"print '> at $n'\"
print \"> $(step) $(time:%g)\"
run 10 upto post no
thermo_style custom step elapsed
print \"> $(step) $(elapsed)\"
fix 2 all indent 0 sphere v_t 0 0 1
run 2
"
    );
    assert_eq!(printed(&script), ["at 2", "at 4", "4 4e-08", "10 0"]);
}
