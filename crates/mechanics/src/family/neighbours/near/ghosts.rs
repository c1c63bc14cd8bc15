//! Ghosts: periodic images of the atoms within reach of the box, as atoms of their own.

use crate::execute::blocks::for_each_piece;
use rayon::prelude::*;

/// Atoms that one thread takes at a time.
const PIECE: usize = 2048;

/// A copy of an own atom.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ghost<const D: usize> {
    /// The atom.
    pub of: u32,
    /// From there to here (length): whole periods.
    shift: [f64; D],
}

/// All ghosts of own atoms, in order of these.
pub(super) fn find<const D: usize>(
    own: &[[f64; 4]],
    period: &[Option<f64>; D],
    reach: f64,
) -> Vec<Ghost<D>> {
    let pieces = own.par_chunks(PIECE).enumerate();
    let ghosts = pieces.flat_map_iter(|(n, piece)| {
        let mut found = vec![];
        for (l, y) in piece.iter().enumerate() {
            add_images((n * PIECE + l) as u32, y, period, reach, &mut found);
        }
        found
    });
    ghosts.collect()
}

/// The images of one atom that are within reach of the box.
fn add_images<const D: usize>(
    of: u32,
    y: &[f64; 4],
    period: &[Option<f64>; D],
    reach: f64,
    found: &mut Vec<Ghost<D>>,
) {
    let first = found.len();
    for a in 0..D {
        let Some(p) = period[a] else { continue };
        let before = found.len();
        for shift in [p, -p] {
            let image = y[a] + shift;
            if image >= -reach && image < p + reach {
                let mut ghost = Ghost {
                    of,
                    shift: [0.0; D],
                };
                ghost.shift[a] = shift;
                found.push(ghost);
                // and images along earlier axes of this image
                for n in first..before {
                    let mut ghost = found[n];
                    ghost.shift[a] = shift;
                    found.push(ghost);
                }
            }
        }
    }
}

/// Write positions and fourth numbers of ghosts, which begin at `first`, from those of own atoms.
pub(super) fn refresh<const D: usize>(
    ghosts: &[Ghost<D>],
    first: usize,
    position: &mut [[f64; 4]],
) {
    let (own, copies) = position.split_at_mut(first);
    for_each_piece(&mut copies[..ghosts.len()], |n, piece| {
        for (copy, ghost) in piece.iter_mut().zip(&ghosts[n..]) {
            *copy = own[ghost.of as usize];
            for a in 0..D {
                copy[a] += ghost.shift[a];
            }
        }
    });
}
