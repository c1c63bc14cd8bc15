//! Periodic images of the atoms within reach of the box, as atoms of their own.

use crate::execute::blocks::for_each_piece;
use rayon::prelude::*;

/// Atoms that one thread takes at a time.
const PIECE: usize = 2048;

/// A copy of an atom of the box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Image<const D: usize> {
    /// The atom.
    pub of: u32,
    /// From there to here (length): whole periods.
    shift: [f64; D],
}

/// All images of so many atoms of the box, in their order: `atom` says which listed one it is, and where.
pub(super) fn find<const D: usize>(
    atoms: usize,
    atom: impl Fn(usize) -> (u32, [f64; 4]) + Sync,
    period: &[Option<f64>; D],
    reach: f64,
) -> Vec<Image<D>> {
    let pieces = (0..atoms.div_ceil(PIECE)).into_par_iter();
    let images = pieces.flat_map_iter(|n| {
        let mut found = vec![];
        for n in n * PIECE..((n + 1) * PIECE).min(atoms) {
            let (of, y) = atom(n);
            add_images(of, &y, period, reach, &mut found);
        }
        found
    });
    images.collect()
}

/// The images of one atom that are within reach of the box.
pub(super) fn add_images<const D: usize>(
    of: u32,
    y: &[f64; 4],
    period: &[Option<f64>; D],
    reach: f64,
    found: &mut Vec<Image<D>>,
) {
    let first = found.len();
    for a in 0..D {
        let Some(p) = period[a] else { continue };
        let before = found.len();
        for shift in [p, -p] {
            let there = y[a] + shift;
            if there >= -reach && there < p + reach {
                let mut image = Image {
                    of,
                    shift: [0.0; D],
                };
                image.shift[a] = shift;
                found.push(image);
                // and images along earlier axes of this image
                for n in first..before {
                    let mut image = found[n];
                    image.shift[a] = shift;
                    found.push(image);
                }
            }
        }
    }
}

impl<const D: usize> Image<D> {
    /// Where it is, of an atom that is at `y`.
    #[inline(always)]
    pub fn at(&self, y: &[f64; 4]) -> [f64; 4] {
        let mut there = *y;
        for a in 0..D {
            there[a] += self.shift[a];
        }
        there
    }
}

/// Write positions and fourth numbers of images, which begin at `first`, from those of the atoms of the box.
pub(super) fn refresh<const D: usize>(
    images: &[Image<D>],
    first: usize,
    position: &mut [[f64; 4]],
) {
    let (atoms, copies) = position.split_at_mut(first);
    for_each_piece(&mut copies[..images.len()], |n, piece| {
        for (copy, image) in piece.iter_mut().zip(&images[n..]) {
            *copy = image.at(&atoms[image.of as usize]);
        }
    });
}
