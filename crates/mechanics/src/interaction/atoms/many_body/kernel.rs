//! The many-body energies of a tile of atoms: lanes run over centres, loops over the pairs of their bonds.

use super::back::{Back, Ends, FAR};
use crate::body::Values;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::family::neighbours::near::NearList;
use crate::interaction::atoms::Places;
use crate::interaction::bond::VIRIAL;
use crate::law::many_body::{Arm, ManyBody, Row};
use crate::law::number::{Dual, Over};
use crate::law::slopes::Slopes;

pub(super) struct View<'a, F> {
    pub list: &'a NearList<3>,
    /// `[atoms][4]`, the fourth the kind.
    pub position: *const f64,
    pub many_body: &'a F,
    /// Squared length.
    pub limit: f64,
    /// Where forces on ends go, if they are asked for; those on centres, force densities, then go to `f`.
    pub ends: Option<Ends>,
    pub back: &'a Back,
    pub f: [Shared; 3],
    /// What own atoms say, if it is asked for.
    pub said: Option<Places>,
    pub volume: &'a Values,
}

// SAFETY: the pointer is into the list that the view borrows
unsafe impl<F: Sync> Sync for View<'_, F> {}

/// `MANY`: there are several kinds of atom.
pub(super) struct Centres<'a, F, const MANY: bool>(pub View<'a, F>);

/// A line of bonds of a tile that are within the cut-off.
#[derive(Clone, Copy)]
struct Bond<L> {
    y: [L; 3],
    kind: [u8; TILE],
    arm: Arm<Dual<L>>,
    zeta: L,
    /// `∂h/∂ζ`.
    along: L,
    /// Σ of the pulls at its end.
    pull: L,
    /// Σ of the pulls between its end and others, times these.
    across: [L; 3],
}

/// z of two lines by ξ of both and of what closes the triangle.
#[derive(Clone, Copy)]
struct Share<L>([L; 3]);

/// Workspace of a tile.
struct Workspace<L> {
    bonds: Vec<Bond<L>>,
    shares: Vec<Share<L>>,
    /// Neighbours line by line, those within the cut-off only.
    near: Vec<[u32; TILE]>,
}

impl<F: ManyBody> View<'_, F> {
    /// Positions and kinds of atoms.
    #[inline(always)]
    fn at<L: Lane>(&self, index: &[u32; TILE]) -> [L; 4] {
        // SAFETY: listed atoms have positions
        unsafe { L::gather4(self.position, index.as_ptr()) }
    }

    #[inline(always)]
    fn kinds<L: Lane, const MANY: bool>(kind: L) -> [u8; TILE] {
        match MANY {
            true => kind.to_array().map(|k| k as u8),
            false => [0; TILE],
        }
    }

    /// The lines of a tile without what is beyond the cut-off.
    #[inline(always)]
    fn compress<L: Lane>(
        &self,
        tile: usize,
        lines: &[[u32; TILE]],
        i: &[L; 4],
        near: &mut Vec<[u32; TILE]>,
    ) {
        let nowhere = self.list.nowhere();
        // lanes without an atom have neighbours at no distance
        let own_lanes = (1u32 << self.list.lanes(tile)) - 1;
        let mut count = [0usize; TILE];
        near.clear();
        for (n, line) in lines.iter().enumerate() {
            let j = self.at::<L>(line);
            let mut q = L::splat(0.0);
            for a in 0..3 {
                let y = j[a] - i[a];
                q = y.fma(y, q);
            }
            let mut bits = L::bits(q.lt(L::splat(self.limit))) & own_lanes;
            if let Some(ends) = self.ends {
                let own = self.back.place(tile) + n * TILE;
                for l in 0..TILE {
                    let skipped = match bits >> l & 1 {
                        1 => (n - count[l]) as u16,
                        _ => FAR,
                    };
                    // SAFETY: every tile has its own places
                    unsafe { *ends.before.at(own + l) = skipped };
                }
            }
            while bits != 0 {
                let l = bits.trailing_zeros() as usize;
                if count[l] == near.len() {
                    near.push([nowhere; TILE]);
                }
                near[count[l]][l] = line[l];
                count[l] += 1;
                bits &= bits - 1;
            }
        }
    }
}

impl<F: ManyBody, const MANY: bool> Centres<'_, F, MANY> {
    #[inline(always)]
    fn arm<L: Lane>(&self, i: &[u8; TILE], kind: &[u8; TILE], xi: L) -> Arm<Dual<L>> {
        let (many_body, xi) = (self.0.many_body, Dual::variable(xi));
        match MANY {
            true => many_body.arm::<L, _>(xi, many_body.table().each(i, kind, kind)),
            false => many_body.arm::<L, _>(xi, many_body.table().same()),
        }
    }

    /// h by ξ and ζ.
    #[inline(always)]
    fn bond<L: Lane>(&self, i: &[u8; TILE], bond: &Bond<L>) -> Slopes<L, 2> {
        let (arm, zeta) = (bond.arm.along(0), Slopes::nth(bond.zeta, 1));
        let many_body = self.0.many_body;
        let k = &bond.kind;
        match MANY {
            true => many_body.bond::<L, _>(&arm, zeta, many_body.table().each(i, k, k)),
            false => many_body.bond::<L, _>(&arm, zeta, many_body.table().same()),
        }
    }

    /// h with its slope by ξ, where that by ζ is known.
    #[inline(always)]
    fn pair<L: Lane>(&self, i: &[u8; TILE], bond: &Bond<L>) -> Dual<L> {
        let (many_body, zeta) = (self.0.many_body, Dual::lane(bond.zeta));
        let k = &bond.kind;
        match MANY {
            true => many_body.bond::<L, _>(&bond.arm, zeta, many_body.table().each(i, k, k)),
            false => many_body.bond::<L, _>(&bond.arm, zeta, many_body.table().same()),
        }
    }

    #[inline(always)]
    fn share<L: Lane>(&self, i: &[u8; TILE], j: &Bond<L>, k: &Bond<L>) -> Slopes<L, 3> {
        let many_body = self.0.many_body;
        match MANY {
            true => Self::shared(many_body, j, k, many_body.table().each(i, &j.kind, &k.kind)),
            false => Self::shared(many_body, j, k, many_body.table().same()),
        }
    }

    #[inline(always)]
    fn shared<L: Lane>(many_body: &F, j: &Bond<L>, k: &Bond<L>, of: impl Row) -> Slopes<L, 3> {
        let mut q = L::splat(0.0);
        for a in 0..3 {
            let y = j.y[a] - k.y[a];
            q = y.fma(y, q);
        }
        many_body.share_slopes::<L>(&j.arm, &k.arm, q * L::splat(0.5), of)
    }

    /// Bonds of a tile with their pulls; the energy of its centres.
    #[inline(always)]
    fn evaluate<L: Lane>(&self, i: &[L; 4], workspace: &mut Workspace<L>) -> L {
        let zero = L::splat(0.0);
        let own = View::<F>::kinds::<L, MANY>(i[3]);
        workspace.bonds.clear();
        for line in &workspace.near {
            let j = self.0.at::<L>(line);
            let mut y = [zero; 3];
            let mut q = zero;
            for a in 0..3 {
                y[a] = j[a] - i[a];
                q = y[a].fma(y[a], q);
            }
            let kind = View::<F>::kinds::<L, MANY>(j[3]);
            workspace.bonds.push(Bond {
                y,
                kind,
                arm: self.arm(&own, &kind, q * L::splat(0.5)),
                zeta: zero,
                along: zero,
                pull: zero,
                across: [zero; 3],
            });
        }
        match F::TRIPLES {
            Some(multiple) => self.triples(&own, &mut workspace.bonds, multiple),
            None => self.weakened(&own, workspace),
        }
    }

    /// A sum of pairs and triples: what a triple says is known when it is met.
    #[inline(always)]
    fn triples<L: Lane>(&self, own: &[u8; TILE], bonds: &mut [Bond<L>], multiple: f64) -> L {
        let along = L::splat(2.0 * multiple);
        for j in 0..bonds.len() {
            let (before, rest) = bonds.split_at_mut(j);
            let first = &mut rest[0];
            for second in before {
                let z = self.share(own, first, second);
                first.zeta = first.zeta + z.value;
                second.zeta = second.zeta + z.value;
                pull(first, second, along, z.slope);
            }
        }
        let mut energy = L::splat(0.0);
        for bond in bonds {
            let h = self.pair(own, bond);
            energy = energy + h.value;
            bond.pull = bond.pull + h.slope;
        }
        energy
    }

    /// Bonds that others weaken: all of them are asked before a bond is known.
    #[inline(always)]
    fn weakened<L: Lane>(&self, own: &[u8; TILE], workspace: &mut Workspace<L>) -> L {
        workspace.shares.clear();
        let count = workspace.bonds.len();
        for j in 0..count {
            for k in 0..count {
                if k == j {
                    continue;
                }
                let z = self.share(own, &workspace.bonds[j], &workspace.bonds[k]);
                workspace.bonds[j].zeta = workspace.bonds[j].zeta + z.value;
                workspace.shares.push(Share(z.slope));
            }
        }
        let mut energy = L::splat(0.0);
        for bond in &mut workspace.bonds {
            let h = self.bond(own, bond);
            energy = energy + h.value;
            bond.pull = h.slope[0];
            bond.along = h.slope[1];
        }
        let mut next = 0;
        for j in 0..count {
            let mut first = workspace.bonds[j];
            let along = first.along;
            for k in 0..count {
                if k == j {
                    continue;
                }
                let Share(slope) = workspace.shares[next];
                next += 1;
                pull(&mut first, &mut workspace.bonds[k], along, slope);
            }
            workspace.bonds[j] = first;
        }
        energy
    }
}

/// What `along` times a share pulls at two ends.
#[inline(always)]
fn pull<L: Lane>(first: &mut Bond<L>, second: &mut Bond<L>, along: L, slope: [L; 3]) {
    let across = along * slope[2];
    first.pull = along.fma(slope[0], first.pull) + across;
    second.pull = along.fma(slope[1], second.pull) + across;
    for a in 0..3 {
        first.across[a] = across.fma(second.y[a], first.across[a]);
        second.across[a] = across.fma(first.y[a], second.across[a]);
    }
}

impl<F: ManyBody, const MANY: bool> Kernel for Centres<'_, F, MANY> {
    type Out = ();
    type Home = F;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let view = &self.0;
        let zero = L::splat(0.0);
        let mut workspace = Workspace::<L> {
            bonds: vec![],
            shares: vec![],
            near: vec![],
        };
        for (t, lines) in view.list.tiles(block) {
            let mut here = [(t * TILE) as u32; TILE];
            for (l, n) in here.iter_mut().enumerate() {
                *n += l as u32;
            }
            let i = view.at::<L>(&here);
            view.compress(t, lines, &i, &mut workspace.near);
            let energy = self.evaluate(&i, &mut workspace);
            let mut virial = [zero; 6];
            let mut centre = [zero; 3];
            for (n, bond) in workspace.bonds.iter().enumerate() {
                // on the end: −Σ G (x_end − x_other)
                let mut force = [zero; 3];
                for a in 0..3 {
                    force[a] = bond.across[a] - bond.pull * bond.y[a];
                    centre[a] = centre[a] - force[a];
                }
                for (v, (m, n)) in virial.iter_mut().zip(VIRIAL) {
                    *v = bond.y[m].fma(force[n], *v);
                }
                if let Some(ends) = view.ends {
                    let [x, y, z] = [
                        force[0].to_array(),
                        force[1].to_array(),
                        force[2].to_array(),
                    ];
                    for l in 0..TILE {
                        let at = view.back.place(t) + n * TILE + l;
                        // SAFETY: every tile has its own places, and no more current bonds than lines
                        unsafe { *ends.force.at(at) = [x[l], y[l], z[l], 0.0] };
                    }
                }
            }
            let slots = view.list.slots(t);
            if let Some(said) = view.said {
                // SAFETY: every slot belongs to one atom
                unsafe { said.put(slots, energy, virial, 1.0) };
            }
            if view.ends.is_none() {
                continue;
            }
            let centre = [
                centre[0].to_array(),
                centre[1].to_array(),
                centre[2].to_array(),
            ];
            for (l, &slot) in slots.iter().enumerate() {
                let slot = slot as usize;
                let scale = 1.0 / view.volume.at(slot);
                for a in 0..3 {
                    // SAFETY: as above
                    unsafe { *view.f[a].at(slot) = scale * centre[a][l] };
                }
            }
        }
    }
}
