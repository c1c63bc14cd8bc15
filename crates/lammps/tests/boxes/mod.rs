//! A box that follows its atoms does so when LAMMPS rebuilds its neighbour lists, not whenever it is asked for: pressures, volumes and
//! temperatures of one script in every system of units, against what LAMMPS printed.

use super::{Paper, numbers};
use peridyne_lammps::model::ModelHost;
use peridyne_lammps::{Options, run_text};

const SCRIPT: &str = include_str!("in.boxes");
const PRINTED: &str = include_str!("lammps.txt");
/// Columns of pressures: at rest one of them is far below the others, which are its measure.
const PRESSURES: std::ops::Range<usize> = 4..7;
/// The row at the start of a run with `pre no` after atoms were displaced: LAMMPS prints the virial of before, here it is that of now.
const DISPLACED: usize = 4;
/// Columns that are made of the virial's trace.
const OF_VIRIAL: [usize; 4] = [4, 5, 6, 8];

fn rows<'a>(lines: impl Iterator<Item = &'a str>) -> Vec<Vec<f64>> {
    lines
        .filter_map(|l| numbers(l.trim_start_matches("> ")))
        .filter(|row| row.len() == 1 || row.len() == 14)
        .collect()
}

#[test]
fn shrink_wrapped_boxes_are_those_of_the_last_rebuild() {
    for part in PRINTED.split("units ").skip(1) {
        let (head, body) = part.split_once('\n').unwrap();
        let (units, stiffness) = head.split_once(' ').unwrap();
        let theirs = rows(body.lines());
        assert_eq!(theirs.len(), 10, "{units}");
        let script = { SCRIPT.replace("UNITS", units) }.replace("STIFF", stiffness);
        let output = tempfile::tempdir().unwrap();
        let options = Options {
            output: output.path().into(),
            ..Options::default()
        };
        let mut paper = Paper::default();
        let ran = run_text(
            "in.boxes",
            &script,
            &options,
            &mut ModelHost::default(),
            &mut paper,
        );
        if let Err(e) = ran {
            panic!("{units}: {e} ({:?})\n{}", e.help, paper.0.join("\n"));
        }
        let ours = rows(paper.0.iter().map(String::as_str));
        assert_eq!(ours.len(), theirs.len(), "{units}: {:?}", paper.0);
        for (row, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
            assert_eq!(ours.len(), theirs.len());
            let pressure = theirs
                .get(PRESSURES)
                .map_or(0.0, |p| p.iter().fold(0.0f64, |m, x| m.max(x.abs())));
            for (k, (a, b)) in ours.iter().zip(theirs).enumerate() {
                if row == DISPLACED && OF_VIRIAL.contains(&k) {
                    continue;
                }
                let scale = match PRESSURES.contains(&k) {
                    true => pressure,
                    false => b.abs(),
                };
                assert!(
                    (a - b).abs() <= 1e-9 * scale,
                    "{units}: {k}: {a} {b} in {theirs:?}"
                );
            }
        }
    }
}
