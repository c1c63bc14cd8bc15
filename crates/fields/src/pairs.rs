//! Fields of particles that say themselves what they do to each other, pair by pair: peridynamic bodies.
//!
//! A peridynamic body is a system of particles of mass `m_i = ρ_i V_i` whose parts of the energy are `U^(i) = W_i V_i`. With force states T,
//! `∂U^(i)/∂x_k = V_i V_k T_i⟨ξ_ik⟩` and `f_ik = V_i V_k (T_i⟨ξ_ik⟩ − T_k⟨ξ_ki⟩) = ∂U^(i)/∂x_k − ∂U^(k)/∂x_i`: the pair force (4.0.26) of
//! differences with the partition by sites, central or not. So nothing churns, and with β along the segments between the points
//! as they are now, density, stress and heat flux are those of any other particles ([`crate::evaluate`]).

use crate::FieldsError;
use crate::accumulate::{self, BOND, Form};
use crate::bonds::{Bonds, WIDTH};
use crate::effort::Effort;
use crate::fields::{Fields, Layout, NO_POTENTIAL, Quantity, Sums, Totals};
use crate::frame::Frame;
use crate::kernel::dot;
use crate::method::Method;
use crate::neighbours::Neighbours;
use crate::partition::{PairForce, Partition};
use crate::patch::Patch;
use crate::sums::{Moving, Own};
use crate::targets::{Bins, Targets};
use rayon::prelude::*;

/// What a particle gets from a partner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pull {
    pub i: u32,
    pub k: u32,
    /// From i to the image of k that pulls; what it is off the positions by does not matter below half a period (length).
    pub y: [f64; 3],
    /// On i (force).
    pub force: [f64; 3],
    /// `∂U^(i)/∂x_k` (force). `None`: there is no such energy.
    pub own: Option<[f64; 3]>,
}

/// Calls what it is given with every pull, from both particles of a pair.
pub type Pulls<'a> = dyn FnMut(&mut dyn FnMut(Pull)) + 'a;

/// The choices that a body of particles with force states leaves: those that they are.
pub fn method(method: Method) -> Method {
    Method {
        partition: Partition::Site,
        pair_force: PairForce::Differences,
        by_part: false,
        molecules: None,
        families: None,
        ..method
    }
}

/// Bonds of a point, each once, about.
pub const FAMILY: f64 = 60.0;
/// Pairs that are held at a time, and those of a block.
const HELD: usize = 1 << 16;
const BLOCK: usize = 1 << 10;

/// Fields of a frame whose particles have these energies `U^(i)` and pulls. Of `method` the choices that [`method`] makes are not read.
///
/// # Errors
/// A frame that makes no sense, energies of another number of particles, a pull that is not finite.
pub fn evaluate(
    frame: &Frame,
    energy: &[f64],
    pulls: &mut Pulls,
    targets: &Targets,
    method: &Method,
) -> Result<Fields, FieldsError> {
    frame.check()?;
    if energy.len() != frame.len() {
        return Err(FieldsError(format!(
            "{} energies of {} particles",
            energy.len(),
            frame.len()
        )));
    }
    // those of a family of three spacings, about
    Effort::of(frame, FAMILY * frame.len() as f64, 0.0, targets, method).check(targets, method)?;
    // for blocks of particles alone
    let neighbours = Neighbours::new(frame, method.kernel.width())?;
    let mut bins = Bins::new(targets, &frame.cell, &method.kernel)?;
    bins.stop = method.stop;
    let drift = frame.drift();
    let velocity = frame.velocities_beside(drift);
    let layout = Layout {
        parts: 1,
        moving: !velocity.is_empty(),
        rates: method.rates && !velocity.is_empty(),
        churns: false,
        places: method.coordinate,
        averaged: method.kernel.averaged_axes().map(|a| a.is_some()),
    };
    let mut gather = Gather {
        frame,
        wrapped: &neighbours.wrapped,
        velocity: &velocity,
        bins: &bins,
        method,
        own: Own {
            energy: energy.to_vec(),
            ..Own::new(frame.len(), 1)
        },
        totals: Totals::new(frame),
        held: vec![],
        sums: vec![0.0; targets.len() * BOND],
        potential: true,
        wrong: None,
    };
    pulls(&mut |pull| gather.take(&pull));
    gather.flush();
    method.go_on()?;
    let Gather {
        own,
        mut totals,
        sums,
        potential,
        wrong,
        ..
    } = gather;
    if let Some(wrong) = wrong {
        return Err(wrong);
    }
    totals.energy = own.energy.iter().sum();
    let moving = Moving {
        frame,
        velocity: &velocity,
        drift,
        layout: &layout,
    };
    let sums = Sums {
        particles: moving.sums(&neighbours, &bins, &own, method)?,
        bonds: sums,
    };
    let mut fields = Fields::finish(
        targets.positions(&frame.cell),
        vec!["all".into()],
        layout,
        &sums,
        drift,
        method.boltzmann,
        totals,
        own.force,
    );
    if !potential {
        let lost = [
            Quantity::Churning,
            Quantity::HeatPotential,
            Quantity::HeatChurning,
            Quantity::ChurningSource,
        ];
        fields.leave_out(&lost, NO_POTENTIAL);
    }
    Ok(fields)
}

/// A pair that waits.
struct Held {
    i: u32,
    y: [f64; 3],
    force: [f64; 3],
    power: f64,
}

/// Pulls as they come, and what has been made of them.
struct Gather<'a> {
    frame: &'a Frame,
    wrapped: &'a [[f64; 3]],
    velocity: &'a [[f64; 3]],
    bins: &'a Bins<'a>,
    method: &'a Method,
    own: Own,
    totals: Totals,
    held: Vec<Held>,
    sums: Vec<f64>,
    potential: bool,
    wrong: Option<FieldsError>,
}

impl Gather<'_> {
    fn take(&mut self, pull: &Pull) {
        if self.held.is_empty() && (self.method.stop)() {
            return;
        }
        let [i, k] = [pull.i, pull.k].map(|n| n as usize);
        let Pull { force, .. } = *pull;
        if !(force.iter().chain(&pull.y).all(|c| c.is_finite())) {
            self.wrong.get_or_insert_with(|| {
                FieldsError(format!("the force on particle {} is not finite", i + 1))
            });
            return;
        }
        for c in 0..3 {
            self.own.force[i][c] += force[c];
        }
        self.potential &= pull.own.is_some();
        let own = pull.own.unwrap_or([0.0; 3]);
        let velocity = |n: usize| self.velocity.get(n).copied().unwrap_or([0.0; 3]);
        let (vi, vk) = (velocity(i), velocity(k));
        let apart: [f64; 3] = std::array::from_fn(|c| vk[c] - vi[c]);
        self.own.power[i] += dot(own, apart);
        // a pair once; one of a particle and its own image from the side that looks ahead
        let ahead = || pull.y.iter().find(|c| **c != 0.0).is_some_and(|c| *c > 0.0);
        if i > k || (i == k && !ahead()) {
            return;
        }
        let x = self.frame.position[i];
        let at = std::array::from_fn(|c| x[c] + pull.y[c]);
        let (_, off) = self.frame.cell.nearest(at, self.frame.position[k]);
        let y: [f64; 3] = std::array::from_fn(|c| pull.y[c] + off[c]);
        for n in 0..9 {
            self.totals.virial[n] -= y[n / 3] * force[n % 3];
        }
        // f = D_ik − D_ki
        let back: [f64; 3] = std::array::from_fn(|c| own[c] - force[c]);
        self.held.push(Held {
            i: pull.i,
            y,
            force,
            power: dot(own, vk) - dot(back, vi),
        });
        if self.held.len() == HELD {
            self.flush();
        }
    }

    /// What a block of pairs holds, those of a particle about its place.
    fn block(&self, held: &[Held]) -> Bonds {
        let mut bonds = Bonds::default();
        let (mut centres, mut last) = (0, None);
        for pair in held {
            let x = self.wrapped[pair.i as usize];
            if last != Some(pair.i) {
                bonds.centre(x);
                (centres, last) = (centres + 1, Some(pair.i));
            }
            let end = std::array::from_fn(|c| x[c] + pair.y[c]);
            let n = bonds.add(centres - 1, end, pair.y.map(|c| -c), 1) as usize;
            let value = &mut bonds.value[n * WIDTH..][..WIDTH];
            // nothing churns
            value[..3].copy_from_slice(&pair.force);
            value[6] = pair.power;
        }
        bonds
    }

    /// Adds the pairs that are held to the points.
    fn flush(&mut self) {
        let held = std::mem::take(&mut self.held);
        let (bins, kernel, cell) = (self.bins, &self.method.kernel, &self.frame.cell);
        let some: Vec<_> = held
            .par_chunks(BLOCK)
            .map(|some| {
                let bonds = self.block(some);
                let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
                for (end, bond) in bonds.end.iter().zip(&bonds.bond) {
                    let other = std::array::from_fn(|c| end[c] + bond[c]);
                    for s in [cell.fraction(*end), cell.fraction(other)] {
                        for a in 0..3 {
                            (low[a], high[a]) = (low[a].min(s[a]), high[a].max(s[a]));
                        }
                    }
                }
                let patch = Patch::of(bins, [low, high]);
                let found = (!patch.is_empty())
                    .then(|| accumulate::bonds(kernel, &patch, &bonds, 1, Form::Whole));
                (patch.index, found)
            })
            .collect();
        for (index, found) in some {
            if let Some(found) = found {
                found.add_to(&mut self.sums, &index, 1);
            }
        }
    }
}
