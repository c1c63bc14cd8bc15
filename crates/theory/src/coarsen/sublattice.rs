//! The Bravais lattice that points lie on: what "every k-th point" means on triangular and centred lattices.

/// Whole vectors, in echelon form: row a begins at axis a.
pub(super) struct Sublattice<const D: usize> {
    row: [Option<[i64; D]>; D],
}

impl<const D: usize> Sublattice<D> {
    /// Of all sums of these vectors.
    pub fn spanned(vectors: impl Iterator<Item = [i64; D]>) -> Self {
        let mut lattice = Sublattice { row: [None; D] };
        for v in vectors {
            lattice.add(v);
        }
        lattice
    }

    fn add(&mut self, mut v: [i64; D]) {
        let mut changed = false;
        for a in 0..D {
            if v[a] == 0 {
                continue;
            }
            let Some(mut b) = self.row[a] else {
                self.row[a] = Some(v);
                changed = true;
                break;
            };
            // Euclid on component a
            let pivot = b[a];
            while v[a] != 0 {
                let times = b[a].div_euclid(v[a]);
                for c in a..D {
                    b[c] -= times * v[c];
                }
                std::mem::swap(&mut b, &mut v);
            }
            changed |= b[a].abs() != pivot.abs();
            self.row[a] = Some(b);
        }
        if changed {
            self.reduce();
        }
    }

    /// Keeps the numbers small.
    fn reduce(&mut self) {
        for a in (0..D).rev() {
            let Some(mut v) = self.row[a] else { continue };
            for (b, row) in self.row.iter().enumerate().skip(a + 1) {
                if let Some(row) = row {
                    let times = v[b].div_euclid(row[b]);
                    for c in b..D {
                        v[c] -= times * row[c];
                    }
                }
            }
            self.row[a] = Some(v);
        }
    }

    /// Is it `k` times a vector of the lattice?
    pub fn has_multiple(&self, mut v: [i64; D], k: i64) -> bool {
        for a in 0..D {
            if v[a] == 0 {
                continue;
            }
            let Some(row) = self.row[a] else { return false };
            if v[a] % (k * row[a]) != 0 {
                return false;
            }
            let times = v[a] / row[a];
            for c in a..D {
                v[c] -= times * row[c];
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count<const D: usize>(sites: &[[i64; D]], k: i64) -> usize {
        let lattice = Sublattice::spanned(sites.iter().copied());
        assert!(sites.iter().all(|s| lattice.has_multiple(*s, 1)));
        sites
            .iter()
            .filter(|s| lattice.has_multiple(**s, k))
            .count()
    }

    fn sites<const D: usize>(n: i64, keep: impl Fn([i64; D]) -> bool) -> Vec<[i64; D]> {
        let at = |mut k: i64| -> [i64; D] {
            std::array::from_fn(|_| {
                let x = k % n;
                k /= n;
                x
            })
        };
        (0..n.pow(D as u32)).map(at).filter(|x| keep(*x)).collect()
    }

    #[test]
    fn a_kth_of_every_bravais_lattice_is_one_of_it() {
        let square = sites::<2>(9, |_| true);
        assert_eq!(count(&square, 2), 25);
        let triangular = sites::<2>(8, |[x, y]| (x + y) % 2 == 0);
        // one of k² of 32, the lattice of the points twice as far apart
        assert_eq!(count(&triangular, 2), 8);
        let lattice = Sublattice::spanned(triangular.iter().copied());
        assert!(lattice.has_multiple([2, 2], 2) && lattice.has_multiple([4, 0], 2));
        assert!(!lattice.has_multiple([2, 0], 2) && !lattice.has_multiple([1, 0], 1));
        let fcc = sites::<3>(8, |x| x.iter().sum::<i64>() % 2 == 0);
        assert_eq!((fcc.len(), count(&fcc, 2), count(&fcc, 4)), (256, 32, 4));
        let bcc = sites::<3>(8, |x| x.iter().all(|c| c % 2 == x[0] % 2));
        assert_eq!((bcc.len(), count(&bcc, 2)), (128, 16));
        // a line in space, and negative vectors in any order
        let line = [[6, -4], [-9, 6], [0, 0]];
        assert_eq!(count(&line, 2), 2);
    }
}
