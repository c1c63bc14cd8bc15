//! Whatever is written, a script ends with an outcome or an error, never with a panic.

use std::io::Cursor;

use peridyne_io::read::lammps::read_data;
use peridyne_lammps::{Options, read_frame};
use proptest::prelude::*;

use super::host::run;
use super::values::BOX;

const WORDS: &str = "variable x equal atom index loop string internal format delete print if then else elif \
    set group all region type id union v_x c_1 f_1 $x ${x} $(x) $(v_x) $(1+2) $ ${ $( ( ) [ ] \" ' \"\"\" & # 0 1 -1 \
    1e308 1e-400 nan inf x*x+1 sqrt(x) 1/0 2^-1 random(0,1,5) stride2(1,2,3,4,5,6) logfreq2(1,3,9) density volume vx \
    velocity sum yes no units box lattice sc sq origin block cylinder sphere INF EDGE fix nve indent sphere setforce \
    NULL unfix compute reduce min damage/atom property/atom thermo thermo_style custom one multi thermo_modify format \
    float %g %d %s %5.3f line step pe undump dump_modify timestep neighbor reset_timestep next label jump SELF é * 1:2 displace_atoms \
    move ramp rotate random create scale zero dist gaussian loop geom mom rot plane cone ellipsoid prism side out in \
    delete_atoms create_atoms single addforce viscous wiggle linear wall/reflect xlo EDGE momentum angular ave/time \
    running c_1[1] f_1[2] com displace/atom stress/atom reduce/region temp type/fraction thresh sort every xyz yaml \
    lost ignore neigh_modify clear log file getenv y z 7 0.5 -2 NULL";

/// Nothing is written.
fn dry() -> Options {
    Options {
        dry: true,
        ..Options::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn scripts(words in prop::collection::vec((0usize..220, prop::bool::weighted(0.2)), 1..40)) {
        let vocabulary: Vec<&str> = WORDS.split_whitespace().collect();
        let mut script = BOX.to_string();
        for (w, end) in words {
            script += vocabulary[w % vocabulary.len()];
            script.push(if end { '\n' } else { ' ' });
        }
        // a jump back would loop for ever, as written
        let script = script.replace("jump", "junp");
        let _ = run("in.fuzz", &script, &dry());
    }

    #[test]
    fn formulas(text in "[-+*/%^()!<>=&|.,xyzvc_e0-9\\[\\] ]{0,40}") {
        let script = format!("{BOX}variable q atom \"{text}\"\nset group all vx v_q\n");
        let _ = run("in.fuzz", &script, &dry());
    }

    #[test]
    fn files(text in "([A-Za-z0-9.: -]{0,12}\n){0,12}", cut in 0usize..400) {
        let _ = read_data(Cursor::new(&text), "a");
        let _ = read_frame(Cursor::new(&text), "a", 0, &[vec!["x".into()]]);
        let whole = "t\n\n1 atoms\n1 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms\n\n1 1 1 1 0 0 0\n";
        let _ = read_data(Cursor::new(&whole[..cut.min(whole.len())]), "a");
    }
}
