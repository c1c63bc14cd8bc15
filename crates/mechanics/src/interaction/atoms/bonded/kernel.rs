//! Bonded terms one by one, and what each atom gathers from its own.

use crate::body::{Body, FieldView};
use crate::execute::blocks::Shared;
use crate::execute::lane::Lane;
use crate::execute::simd::Kernel;
use crate::family::neighbours::periods;
use crate::interaction::bond::VIRIAL;
use crate::law::bonded::{Pulls, Tangents};
use crate::spec::Form;

/// A pair potential of kinds of atoms: value, first and second derivative by `q = r²`; `None`: nothing, beyond its cut-off.
pub type PairEnergy = dyn Fn([usize; 2], f64) -> Option<[f64; 3]> + Send + Sync;

/// Terms, or atoms, per block of work.
pub(super) const BLOCK: usize = 256;

#[derive(Debug, Clone, Copy)]
pub(super) enum Says {
    /// The number of a form.
    Form(u32),
    /// So many times the pair potential.
    Pair(f64),
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub count: usize,
    pub slots: [u32; 4],
    pub says: Says,
    /// Is its first particle this rank's? It counts there.
    pub first: bool,
}

impl Term {
    /// Is it a bond between two atoms, and not what is taken of the potential?
    pub fn is_bond(&self) -> bool {
        self.count == 2 && matches!(self.says, Says::Form(_))
    }

    /// Slots of the first two particles.
    pub fn ends(&self) -> [usize; 2] {
        [0, 1].map(|n| self.slots[n] as usize)
    }

    pub fn pairs(&self) -> usize {
        self.count * (self.count - 1) / 2
    }
}

/// Where the particles of a term are, seen from the first, each by the nearest image of that before it, and the ξ of their pairs.
pub(super) fn places<const D: usize>(
    body: &Body<D>,
    u: FieldView<D>,
    term: &Term,
) -> ([[f64; D]; 4], [f64; 6]) {
    let mut at = [[0.0; D]; 4];
    let place = |slot: u32| -> [f64; D] {
        // of a part of a lattice a copy may stand a period away
        let x = match body.subdomain() {
            None => body.position(slot as usize),
            Some(_) => body.home(slot as usize),
        };
        crate::array::from_fn(|a| x[a] + u[a][slot as usize])
    };
    for n in 1..term.count {
        // bonded neighbours are near, whatever the length of the chain
        let (before, own) = (place(term.slots[n - 1]), place(term.slots[n]));
        let y: [f64; D] = crate::array::from_fn(|a| own[a] - before[a]);
        let back = periods(body, &y);
        for a in 0..D {
            at[n][a] = at[n - 1][a] + (y[a] - back[a]);
        }
    }
    let mut xi = [0.0; 6];
    let mut p = 0;
    for b in 1..term.count {
        for a in 0..b {
            xi[p] = 0.5 * (0..D).map(|c| (at[a][c] - at[b][c]).powi(2)).sum::<f64>();
            p += 1;
        }
    }
    (at, xi)
}

/// Derivatives by ξ of so many times a pair energy, from those by `q = 2ξ`.
fn taken(factor: f64, [value, first, second]: [f64; 3]) -> Tangents {
    let (mut pulls, mut curvature) = ([0.0; 6], [[0.0; 6]; 6]);
    pulls[0] = 2.0 * factor * first;
    curvature[0][0] = 4.0 * factor * second;
    Tangents {
        first: Pulls {
            energy: factor * value,
            pulls,
        },
        second: curvature,
    }
}

/// What is taken of the pair of a term, by ξ.
pub(super) fn left_out<const D: usize>(
    body: &Body<D>,
    pair: &PairEnergy,
    term: &Term,
    factor: f64,
    xi: f64,
) -> Option<Tangents> {
    let kinds = [term.slots[0], term.slots[1]].map(|s| body.material_of(s as usize));
    pair(kinds, 2.0 * xi).map(|said| taken(factor, said))
}

pub(super) struct Evaluate<'a, const D: usize> {
    pub body: &'a Body<D>,
    pub u: FieldView<'a, D>,
    pub forms: &'a [Form],
    pub pair: &'a PairEnergy,
    pub terms: &'a [Term],
    /// Where forces on the particles go, if anywhere.
    pub force: Shared<[[f64; D]; 4]>,
    /// Where energies and virials of terms go, if anywhere.
    pub said: Shared<[f64; 7]>,
}

impl<const D: usize> Evaluate<'_, D> {
    fn pulls(&self, term: &Term, xi: &[f64; 6]) -> Pulls {
        match term.says {
            Says::Form(form) => self.forms[form as usize].pulls(&xi[..term.pairs()]),
            Says::Pair(factor) => {
                let nothing = Pulls {
                    energy: 0.0,
                    pulls: [0.0; 6],
                };
                let said = left_out(self.body, self.pair, term, factor, xi[0]);
                said.map_or(nothing, |t| t.first)
            }
        }
    }

    fn work(&self, block: usize) {
        let first = block * BLOCK;
        for t in first..(first + BLOCK).min(self.terms.len()) {
            let term = &self.terms[t];
            let (at, xi) = places(self.body, self.u, term);
            let found = self.pulls(term, &xi);
            let mut force = [[0.0; D]; 4];
            let mut p = 0;
            for b in 1..term.count {
                for a in 0..b {
                    for c in 0..D {
                        let f = -found.pulls[p] * (at[a][c] - at[b][c]);
                        force[a][c] += f;
                        force[b][c] -= f;
                    }
                    p += 1;
                }
            }
            // SAFETY, both: every term has its own place
            if !self.force.0.is_null() {
                unsafe { *self.force.at(t) = force };
            }
            if self.said.0.is_null() {
                continue;
            }
            let mut said = [found.energy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            for (said, (m, n)) in said[1..].iter_mut().zip(VIRIAL) {
                if n < D {
                    *said = (0..term.count).map(|b| at[b][m] * force[b][n]).sum();
                }
            }
            unsafe { *self.said.at(t) = said };
        }
    }
}

impl<const D: usize> Kernel for Evaluate<'_, D> {
    type Out = ();
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        // one by one: the same code for every instruction set
        self.work(block);
    }
}

pub(super) struct Gather<'a, const D: usize> {
    pub body: &'a Body<D>,
    pub first: &'a [u32],
    pub of: &'a [u32],
    pub force: &'a [[[f64; D]; 4]],
    pub f: [Shared; D],
}

impl<const D: usize> Kernel for Gather<'_, D> {
    type Out = ();
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let first = block * BLOCK;
        for n in first..(first + BLOCK).min(self.body.points()) {
            let slot = self.body.slots[n] as usize;
            let mut sum = [0.0; D];
            for place in &self.of[self.first[n] as usize..self.first[n + 1] as usize] {
                let force = &self.force[*place as usize / 4][*place as usize % 4];
                for a in 0..D {
                    sum[a] += force[a];
                }
            }
            let scale = 1.0 / self.body.volume.at(slot);
            for a in 0..D {
                // SAFETY: every slot belongs to one point
                unsafe { *self.f[a].at(slot) += scale * sum[a] };
            }
        }
    }
}
