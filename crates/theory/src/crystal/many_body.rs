//! Crystals of many-body potentials: second derivatives of the one text by pairs of its particles.

use super::atoms::{Atom, Near, neighbours};
use super::cells::determinant;
use super::error::CrystalError;
use super::lattice::{Bond, Crystal};
use super::{Coupling, Span};
use peridyne::law::blocks::place;
use peridyne::law::many_body::sites::ManyBodySites;
use peridyne::law::many_body::{ManyBody, second_derivatives};
use peridyne::law::terms::{self, Sites};

impl<const D: usize> Crystal<D> {
    /// A periodic crystal whose cell has these rows (length) and atoms, and its energy per cell. Force constants reach as far as two
    /// arms of a fan.
    ///
    /// # Errors
    /// No neighbours; a mass that is none; distances at which the potential has no value.
    pub fn of_many_body<F: ManyBody>(
        many_body: &F,
        cell: [[f64; D]; D],
        atoms: &[Atom<D>],
    ) -> Result<(Self, f64), CrystalError> {
        let near = neighbours(&cell, atoms, many_body.cutoff(), |_, _| many_body.cutoff())?;
        let mut crystal = Crystal {
            cell,
            basis: atoms.iter().map(|a| a.place).collect(),
            mass: atoms.iter().map(|a| a.mass).collect(),
            bonds: vec![],
            curvature: vec![0.0; atoms.len()],
            couplings: vec![],
        };
        let sites = ManyBodySites(many_body.clone());
        let mut energy = 0.0;
        for (s, atom) in atoms.iter().enumerate() {
            let mut ends = vec![(s, [0.0; D])];
            ends.extend(near.iter().filter(|n| n.from == s).map(|n| (n.to, n.xi)));
            let many_body_of = many_body_of(s, &near, atoms);
            let kind = atom.kind as u32;
            sites.terms(kind, &many_body_of, &mut |t| energy += t.energy);
            let found = second_derivatives(many_body, kind, &many_body_of);
            if found
                .first
                .iter()
                .chain(&found.second)
                .any(|x| !x.is_finite())
            {
                let distance = { near.iter() }.fold(f64::INFINITY, |d, n| d.min(n.r));
                return Err(CrystalError::Distance { distance });
            }
            let mut spans = vec![];
            // in the order of `place`
            for b in 1..ends.len() {
                for a in 0..b {
                    let span = Span {
                        sites: [ends[a].0, ends[b].0],
                        at: [ends[a].1, ends[b].1],
                    };
                    crystal.pull(&span, found.first[place(a, b)]);
                    spans.push(span);
                }
            }
            let k = found.second;
            crystal.couplings.push(Coupling { spans, k });
        }
        Ok((crystal, energy))
    }

    /// `G` along a span (energy / length²), both ways: `½ G |η|²` of it.
    fn pull(&mut self, span: &Span<D>, pull: f64) {
        if pull == 0.0 {
            return;
        }
        let [a, b] = span.sites;
        let xi = span.vector();
        for (from, to, xi) in [(a, b, xi), (b, a, xi.map(|x| -x))] {
            let size: f64 = xi.iter().map(|x| x.abs()).sum();
            let same = |o: &&mut Bond<D>| {
                let apart: f64 = (0..D).map(|a| (o.xi[a] - xi[a]).abs()).sum();
                o.from == from && o.to == to && apart <= 1e-9 * size
            };
            match self.bonds.iter_mut().find(same) {
                Some(bond) => {
                    bond.tension += pull;
                    bond.stiffness += pull;
                }
                None => self.bonds.push(Bond {
                    from,
                    to,
                    xi,
                    tension: pull,
                    stiffness: pull,
                    share: 0.0,
                }),
            }
        }
    }
}

/// The neighbours of a site, as many-body potentials see them.
fn many_body_of<const D: usize>(
    site: usize,
    near: &[Near<D>],
    atoms: &[Atom<D>],
) -> Vec<terms::Near> {
    let own = near.iter().filter(|n| n.from == site);
    own.map(|n| terms::Near {
        kind: atoms[n.to].kind as u32,
        y: std::array::from_fn(|a| if a < D { n.xi[a] } else { 0.0 }),
    })
    .collect()
}

/// Energy per cell and pressure of a crystal of a many-body potential (energy / length^D).
pub(super) fn state<const D: usize, F: ManyBody>(
    many_body: &F,
    cell: [[f64; D]; D],
    atoms: &[Atom<D>],
) -> Result<[f64; 2], CrystalError> {
    let near = neighbours(&cell, atoms, many_body.cutoff(), |_, _| many_body.cutoff())?;
    let sites = ManyBodySites(many_body.clone());
    let (mut energy, mut virial) = (0.0, 0.0);
    for (s, atom) in atoms.iter().enumerate() {
        let many_body_of = many_body_of(s, &near, atoms);
        let at = |n: u32| match n {
            0 => [0.0; 3],
            n => many_body_of[n as usize - 1].y,
        };
        sites.terms(atom.kind as u32, &many_body_of, &mut |t| {
            energy += t.energy;
            for &(a, b, pull) in &t.pulls {
                let (x, y) = (at(a), at(b));
                virial -= pull * (0..3).map(|c| (y[c] - x[c]).powi(2)).sum::<f64>();
            }
        });
    }
    Ok([energy, virial / (D as f64 * determinant(&cell).abs())])
}
