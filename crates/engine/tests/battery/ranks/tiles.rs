//! What points are walked together with.

use super::{STEPS, made, place, said, torn};
use crate::sample::*;
use peridyne::run::Simulation;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

/// Eight points are walked together. Others beside them, of a body far away, change no bit of theirs.
#[test]
fn what_the_others_of_a_tile_do_does_not_show() {
    let kinds = [LatticeKind::Square, LatticeKind::Cubic, LatticeKind::Chain];
    let (mut tried, mut parted) = (0, 0);
    for (n, material) in materials().into_iter().enumerate() {
        let lives = |kind: &&LatticeKind| (material.lives)(kind.dimension(), Plane::Stress);
        let kinds: Vec<_> = kinds.iter().filter(lives).collect();
        let Some(kind) = kinds.get(n % 2 % kinds.len().max(1)) else {
            continue;
        };
        let mut place = place(**kind);
        place.cells = match kind.dimension() {
            1 => [300, 1, 1],
            2 => [21, 17, 1],
            _ => [9, 8, 7],
        };
        let case = Case { place, material };
        let ends = [0, 1].map(|others| {
            let mut spec = torn(&case, false);
            let BodySpec::Sites { quarters, .. } = &mut spec.body else {
                panic!("a body of sites");
            };
            let corner: Vec<[i32; 3]> = { quarters.iter() }
                .filter(|q| others > 0 && q.iter().all(|q| *q < 4 * 5))
                .map(|q| [q[0] - 4 * 27, q[1], q[2]])
                .collect();
            let points = quarters.len();
            quarters.extend(corner);
            spec.interactions.contact = None;
            let run = |sim: &mut dyn Simulation| (said(sim, None, STEPS), points, sim.info().parts);
            run(made(&spec).as_mut())
        });
        let [(alone, points, parts), (beside, _, parts_beside)] = ends;
        tried += 1;
        // steps in parts are so for all
        if parts != parts_beside {
            println!(
                "{}: {parts} parts, {parts_beside} beside others",
                case.name()
            );
            parted += 1;
            continue;
        }
        let moved = ["displacement", "velocity", "force_density", "damage"];
        for column in ["places"].into_iter().chain(moved) {
            let (alone, beside) = (&alone.columns[column], &beside.columns[column]);
            assert!(beside.len() > alone.len() && alone.len() % points == 0);
            let off = alone.iter().zip(beside).position(|(a, b)| a != b);
            assert_eq!(off, None, "{}: {column}", case.name());
        }
    }
    assert!(tried > 35 && parted < 4, "{tried} {parted}");
}
