//! Energies of points.

use super::group::Kept;
use super::law::LawView;
use crate::body::Values;
use crate::execute::lane::series::{Series, Stretch};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::EnergyFields;
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::bonds::family::{Family, Slots, put};
use crate::interaction::bonds::repulsion::Pushed;

/// Energy pass: strain and repulsion energy densities, `Σ ω ν V |ξ|² s` and `Σ ω ν V |ξ|²` over intact bonds.
pub struct Energies<'a, const D: usize, F> {
    pub law: LawView<'a, D, F>,
    /// Is s a stretch to the law, or e ([`Material::STRETCHES`](crate::law::material::Material::STRETCHES))?
    pub stretches: bool,
    /// What a section stores that is held, per material; empty: nothing ([`held_energies`](crate::interaction::bonds::BondState::held_energies)).
    pub held: &'a [f64],
    pub pushed: Option<Pushed<'a, D>>,
    pub volume: &'a Values,
    pub fields: Option<EnergyFields>,
}

impl<const D: usize, F: Family<D>> Kernel for Energies<'_, D, F> {
    type Out = [f64; 2];
    type Home = Self;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let v = &self.law.bonds;
        let mut sums = [0.0; 2];
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.points::<L>(group);
                let bits = v.bits(group);
                let mut all = self.law.energy(
                    group,
                    Kept {
                        bits,
                        form: None,
                        drift: None,
                    },
                );
                let repulsion = match &self.pushed {
                    Some(pushed) => pushed.energy::<L, F>(v.family, &v.moved, group),
                    None => [0.0; TILE],
                };
                for l in 0..TILE {
                    if v.family.is_point(group, l) {
                        if !self.held.is_empty() {
                            let slot = at.rows.slot(l);
                            let material = v.material.get(slot).map_or(0, |m| usize::from(*m));
                            all[l] += self.held[material] * v.expansion[slot].powi(2);
                        }
                        let volume = self.volume.at(at.rows.slot(l));
                        sums[0] += all[l] * volume;
                        sums[1] += repulsion[l] * volume;
                    }
                }
                let Some(out) = self.fields else { continue };
                let (mut share, mut weight) = (L::splat(0.0), L::splat(0.0));
                for k in 0..v.family.bonds(group) {
                    let (r, eta) = v.stretched::<L>(&at, k, L::dead(bits[k]));
                    let mut stretch = relative_square_stretch(eta, r.xi, r.two_by_square);
                    if self.stretches {
                        stretch = Series::<Stretch>::new().at(stretch);
                    }
                    let part = r.weight * r.omega.zero_if(L::dead(bits[k])) * r.length * r.length;
                    share = part.fma(stretch, share);
                    weight = weight + part;
                }
                put(L::load(all.as_ptr()), out.strain, at.rows);
                for l in 0..TILE {
                    *out.repulsion.at(at.rows.slot(l)) = repulsion[l];
                }
                put(share, out.share, at.rows);
                put(weight, out.weight, at.rows);
            }
        }
        sums
    }
}
