//! From terms of the energy to bonds: what a block of centres adds between pairs of atoms.
//!
//! Atoms that are near a centre have a bond with it from the start, each pair of the block once, so that terms about their centre find it by
//! the place of the neighbour. Pairs of neighbours of a centre are found by a map.

use crate::FieldsError;
use crate::bonds::{Block, Bonds};
use crate::method::STOPPED;
use crate::molecules::Molecules;
use crate::neighbours::Partner;
use crate::workspace::{Collector, Here, NONE, Workspace};
use peridyne::law::terms::Near;

/// Workspace that one block after the other uses.
#[derive(Default)]
pub struct Spare {
    rows: Rows,
    pub bonds: Bonds,
}

/// Neighbours of the centres of a block, row by row.
#[derive(Default)]
struct Rows {
    first: Vec<usize>,
    here: Vec<Here>,
}

impl Rows {
    /// The bond of a centre of an earlier row with an atom.
    fn find(&self, row: usize, atom: u32, image: [i32; 3]) -> Option<u32> {
        let end = self.first.get(row + 1).copied().unwrap_or(self.here.len());
        let row = &self.here[self.first[row]..end];
        let found = row.iter().find(|h| h.atom == atom && h.image == image)?;
        Some(found.bond / 2)
    }
}

impl Collector<'_> {
    /// All that some centres say.
    ///
    /// # Errors
    /// A term that is not finite, or weights that do not add up.
    pub fn collect(&self, centres: &[u32], spare: &mut Spare) -> Result<Block, FieldsError> {
        let mut workspace = Workspace::new(self, std::mem::take(&mut spare.bonds));
        for i in centres {
            workspace
                .out
                .bonds
                .centre(self.neighbours.wrapped[*i as usize]);
        }
        let rows = &mut spare.rows;
        self.rows(centres, &mut workspace, rows);
        let mut near: Vec<Near> = vec![];
        for (row, &i) in centres.iter().enumerate() {
            if (self.stop)() {
                return Err(FieldsError(STOPPED.into()));
            }
            let end = rows.first.get(row + 1).copied().unwrap_or(rows.here.len());
            workspace.here.clear();
            workspace.here.push(Here {
                atom: i,
                image: [0; 3],
                y: [0.0; 3],
                share: row as u32,
                bond: NONE,
            });
            workspace.here.extend(&rows.here[rows.first[row]..end]);
            near.clear();
            near.extend(workspace.here[1..].iter().map(|h| Near {
                kind: self.frame.kind[h.atom as usize],
                y: h.y,
            }));
            let mut wrong = None;
            let x = self.neighbours.wrapped[i as usize];
            self.sites
                .terms(self.frame.kind[i as usize], &near, &mut |term| {
                    if wrong.is_none() {
                        wrong = workspace.term(x, term).err();
                    }
                });
            if let Some(molecules) = self.molecules
                && wrong.is_none()
            {
                wrong = self.bonded(i, molecules, &mut workspace).err();
            }
            if let Some(message) = wrong {
                let FieldsError(message) = message;
                return Err(FieldsError(format!("particle {}: {message}", i + 1)));
            }
        }
        let mut out = workspace.out;
        out.bonds.compact(self.parts);
        (out.virial, out.churns) = out.bonds.virial(self.parts);
        Ok(out)
    }

    /// Neighbours of all centres, with a bond for each pair; the centres are the first of the shares.
    fn rows(&self, centres: &[u32], workspace: &mut Workspace, rows: &mut Rows) {
        for &i in centres {
            workspace.share(i);
        }
        rows.first.clear();
        rows.here.clear();
        let mut partners: Vec<Partner> = vec![];
        for (row, &i) in centres.iter().enumerate() {
            rows.first.push(rows.here.len());
            self.neighbours.near(i as usize, &mut partners);
            if row == 0 {
                let most = centres.len() * (partners.len() + 4);
                rows.here.reserve(most);
                workspace.out.bonds.reserve(3 * most / 4, self.parts);
            }
            let x = self.neighbours.wrapped[i as usize];
            for p in &partners {
                let share = workspace.share(p.atom);
                let earlier = match (share as usize) <= row {
                    true => rows.find(share as usize, i, p.image.map(|c| -c)),
                    false => None,
                };
                let bond = match earlier {
                    Some(bond) => (bond, true),
                    None => {
                        let end = std::array::from_fn(|c| x[c] + p.y[c]);
                        let bonds = &mut workspace.out.bonds;
                        let own = bonds.add(row as u32, end, p.y.map(|c| -c), self.parts);
                        (own, false)
                    }
                };
                rows.here.push(Here {
                    atom: p.atom,
                    image: p.image,
                    y: p.y,
                    share,
                    bond: 2 * bond.0 + u32::from(bond.1),
                });
            }
        }
    }

    /// What a centre is bonded to, the nearest images of it.
    fn bonded(
        &self,
        i: u32,
        molecules: &Molecules,
        workspace: &mut Workspace,
    ) -> Result<(), FieldsError> {
        let x = self.neighbours.wrapped[i as usize];
        let mut all = vec![];
        molecules.partners(i, &mut all);
        let mut places: Vec<(u32, u32, [f64; 3])> = vec![];
        for atom in all {
            let (image, y) = self
                .frame
                .cell
                .nearest(x, self.neighbours.wrapped[atom as usize]);
            let share = workspace.share(atom);
            places.push((atom, workspace.here.len() as u32, y));
            workspace.here.push(Here {
                atom,
                image,
                y,
                share,
                bond: NONE,
            });
        }
        let at = |atom: u32| match places.binary_search_by_key(&atom, |p| p.0) {
            Ok(n) => (places[n].1, places[n].2),
            Err(_) => (0, [0.0; 3]),
        };
        let mut outcome = Ok(());
        let kind = self.frame.kind[i as usize];
        let first = self.sites.parts().len();
        let of = (self.sites, first);
        molecules.terms((i, kind), &self.frame.kind, &at, of, &mut |term| {
            if outcome.is_ok() {
                outcome = workspace.term(x, term);
            }
        });
        outcome
    }
}
