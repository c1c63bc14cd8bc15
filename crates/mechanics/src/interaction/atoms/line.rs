//! What a line of pairs says: pairs of one pair of kinds, or of each lane its own; and what atoms gather of it.

use crate::execute::lane::Lane;
use crate::interaction::bond::VIRIAL;
use crate::law::number::Dual;
use crate::law::potential::Potential;
use crate::law::potential::constants::{MOST, Rows};

/// Energies and pulls of eight pairs by squared length q; `own` and `other` are the fourth numbers of their atoms.
pub trait Line<L: Lane> {
    /// φ; 0 beyond the cut-off.
    fn energy(&self, q: L, other: L) -> L;
    /// What the second adds to the density at the first; 0 beyond the cut-off.
    fn density(&self, q: L) -> L;
    /// `dφ/dq + (F′_i + F′_j) df/dq`, of unlike atoms `dφ/dq + F′_i df_ij/dq + F′_j df_ji/dq`; 0 beyond the cut-off.
    fn pull(&self, q: L, own: L, other: L) -> L;
}

/// Pairs of one pair of kinds.
pub struct Alike<'a, P, const UNLIKE: bool> {
    pub potential: &'a P,
    /// Squared length.
    pub limit: f64,
}

impl<L: Lane, P: Potential, const UNLIKE: bool> Line<L> for Alike<'_, P, UNLIKE> {
    #[inline(always)]
    fn energy(&self, q: L, _: L) -> L {
        let phi = self.potential.pair(Dual::variable(q)).value;
        phi.zero_if(q.ge(L::splat(self.limit)))
    }

    #[inline(always)]
    fn density(&self, q: L) -> L {
        let f = self.potential.density(Dual::variable(q)).value;
        f.zero_if(q.ge(L::splat(self.limit)))
    }

    #[inline(always)]
    fn pull(&self, q: L, own: L, other: L) -> L {
        let at = Dual::variable(q);
        let pull = if P::EMBEDDED {
            let [pair, density] = self.potential.both(at);
            if UNLIKE {
                let given = self.potential.given(at).slope;
                given.fma(other, density.slope.fma(own, pair.slope))
            } else {
                density.slope.fma(own + other, pair.slope)
            }
        } else {
            self.potential.pair(at).slope
        };
        pull.zero_if(q.ge(L::splat(self.limit)))
    }
}

/// Constants of every pair of kinds, for pairs side by side.
pub struct Table {
    kinds: usize,
    /// `[i][j]`: those of the potential, and the squared cut-off.
    rows: Vec<[f64; MOST + 1]>,
}

impl Table {
    /// Of what pairs of kinds 0 to `kinds` − 1 have, `None`: nothing.
    pub fn new<'a, P: Potential>(
        kinds: usize,
        of: impl Fn(usize, usize) -> Option<&'a P>,
    ) -> Table {
        let row = |n: usize| {
            let mut row = [0.0; MOST + 1];
            if let Some(potential) = of(n / kinds, n % kinds) {
                row[..MOST].copy_from_slice(&potential.constants());
                row[MOST] = potential.cutoff() * potential.cutoff();
            }
            row
        };
        Table {
            kinds,
            rows: (0..kinds * kinds).map(row).collect(),
        }
    }

    pub fn kinds(&self) -> usize {
        self.kinds
    }

    /// Of atoms of these kinds, with each of K kinds; beyond the last with that.
    #[inline(always)]
    fn rows<L: Lane, const K: usize>(&self, own: L, count: usize) -> Rows<L, K> {
        let last = self.kinds - 1;
        let mut rows = [[L::splat(0.0); MOST + 1]; K];
        for (k, row) in rows.iter_mut().enumerate() {
            let of = |own: usize| &self.rows[own * self.kinds + k.min(last)];
            for n in (0..count).chain([MOST]) {
                // what is nowhere is of the last kind
                row[n] = L::splat(of(last)[n]);
                for kind in (0..last).rev() {
                    let up_to = own.lt(L::splat(kind as f64 + 0.5));
                    row[n] = L::select(up_to, L::splat(of(kind)[n]), row[n]);
                }
            }
        }
        Rows(rows)
    }
}

/// Each lane has the constants of its own pair of kinds; fourth numbers are kinds.
pub struct Mixed<'a, P, L, const K: usize> {
    /// Of any pair: all differ in constants alone.
    potential: &'a P,
    rows: Rows<L, K>,
}

impl<'a, P: Potential, L: Lane, const K: usize> Mixed<'a, P, L, K> {
    /// Of atoms of these kinds.
    #[inline(always)]
    pub fn new(potential: &'a P, table: &Table, own: L) -> Self {
        Mixed {
            potential,
            rows: table.rows(own, P::CONSTANTS),
        }
    }
}

impl<P: Potential, L: Lane, const K: usize> Line<L> for Mixed<'_, P, L, K> {
    #[inline(always)]
    fn energy(&self, q: L, other: L) -> L {
        let of = self.rows.with(other);
        let phi = self.potential.pair_of(of, Dual::variable(q)).value;
        phi.zero_if(q.ge(of.get(MOST)))
    }

    /// Such potentials have none.
    #[inline(always)]
    fn density(&self, _: L) -> L {
        L::splat(0.0)
    }

    #[inline(always)]
    fn pull(&self, q: L, _: L, other: L) -> L {
        let of = self.rows.with(other);
        let pull = self.potential.pair_of(of, Dual::variable(q)).slope;
        pull.zero_if(q.ge(of.get(MOST)))
    }
}

/// What is gathered from the pairs of a tile.
pub trait Sum<L: Lane, const D: usize> {
    /// Vectors, squared lengths and fourth numbers of a line.
    fn add(&mut self, line: &impl Line<L>, y: &[L; D], q: L, fourth: [L; 2]);
}

/// Σ of pulls times vectors.
pub struct Pulls<L, const D: usize>(pub [L; D]);

impl<L: Lane, const D: usize> Sum<L, D> for Pulls<L, D> {
    #[inline(always)]
    fn add(&mut self, line: &impl Line<L>, y: &[L; D], q: L, [own, other]: [L; 2]) {
        let pull = line.pull(q, own, other);
        for a in 0..D {
            self.0[a] = pull.fma(y[a], self.0[a]);
        }
    }
}

/// Energies and virials.
pub struct Sums<L> {
    pub energy: L,
    /// Is the virial asked for?
    pub asked: bool,
    pub virial: [L; 6],
}

impl<L: Lane> Sums<L> {
    #[inline(always)]
    pub fn zero(asked: bool) -> Self {
        Sums {
            energy: L::splat(0.0),
            asked,
            virial: [L::splat(0.0); 6],
        }
    }
}

impl<L: Lane, const D: usize> Sum<L, D> for Sums<L> {
    #[inline(always)]
    fn add(&mut self, line: &impl Line<L>, y: &[L; D], q: L, [own, other]: [L; 2]) {
        self.energy = self.energy + line.energy(q, other);
        if !self.asked {
            return;
        }
        let pull = line.pull(q, own, other);
        for (v, (m, n)) in self.virial.iter_mut().zip(VIRIAL) {
            if n < D {
                *v = (pull * y[m]).fma(y[n], *v);
            }
        }
    }
}
