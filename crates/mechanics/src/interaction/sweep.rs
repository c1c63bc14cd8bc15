//! What a sweep over all bonds may change, and what it reports besides forces.

use crate::body::FieldView;
use crate::execute::exact::Exact;
use crate::execute::lane::Lane;
use crate::spec::Breakage;
use crate::state::words;
use std::ops::AddAssign;

/// May bonds break in this sweep?
#[derive(Debug, Clone, Copy)]
pub enum Sweep<'a, const D: usize> {
    /// Forces, test and break, then the new critical stretch. A bond that lets go at once missed the half step that
    /// ends here, one that does after its force pulls over half the next step, and the others pull over that half step
    /// with pressures of before; `v` (velocity of the step's middle, images too) and `steps`, the time steps that end
    /// and begin here, say what that costs. The first evaluation of a run ends no step: 0.
    Evolve {
        v: FieldView<'a, D>,
        steps: [f64; 2],
        breakage: Breakage,
    },
    /// Forces only; the memory stays as it is.
    Hold,
}
/// The motion of a sweep in which bonds break.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<'a, const D: usize> {
    pub v: FieldView<'a, D>,
    /// Time steps that end and begin here.
    pub steps: [f64; 2],
    pub breakage: Breakage,
}

impl<const D: usize> Motion<'_, D> {
    /// Energy density that a breaking bond takes from the motion, by pulling over half a step once more, or gives to it by not
    /// doing so over half a step: half of `½Δt F·(v_j − v_i)`, the other half is the partner's. `rate` is
    /// `(ξ+η)·(v_j − v_i)`.
    #[inline(always)]
    pub(super) fn breaking_correction<L: Lane>(&self, pull: L, rate: L) -> L {
        let time = match self.breakage {
            Breakage::BeforeForce => -0.25 * self.steps[0],
            Breakage::AfterForce => 0.25 * self.steps[1],
        };
        L::splat(time) * pull * rate
    }

    /// Half the step that begins (time).
    pub(super) fn half_step(&self) -> f64 {
        0.5 * self.steps[1]
    }
}

impl<'a, const D: usize> Sweep<'a, D> {
    /// `None`: nothing breaks.
    pub(super) fn motion(self) -> Option<Motion<'a, D>> {
        match self {
            Sweep::Evolve { v, steps, breakage } => Some(Motion { v, steps, breakage }),
            Sweep::Hold => None,
        }
    }
}

/// What breaking did to the energy of points (energy).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Released {
    /// That of points that have less without their bonds.
    pub lost: f64,
    /// What others have more: not below 0.
    pub made: f64,
}

words!([] Released { lost: f64, made: f64 });

impl Released {
    /// The same of bonds that may be on their own: these hold no less than nothing, and what half a step seems to make is its error.
    #[inline(always)]
    pub(super) fn of(&mut self, shares: bool, energy: f64) {
        match shares {
            true => self.book(energy),
            false => self.lost += energy,
        }
    }

    /// Books what somebody lost.
    pub fn book(&mut self, energy: f64) {
        match energy < 0.0 {
            true => self.made -= energy,
            false => self.lost += energy,
        }
    }
}

impl AddAssign for Released {
    fn add_assign(&mut self, o: Released) {
        self.lost += o.lost;
        self.made += o.made;
    }
}

/// What a block of a sweep reports besides its forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockTally {
    /// Directed bonds that broke.
    pub broken: u64,
    /// Energy that points lost with them.
    pub released: Released,
    /// What laws with memory dissipated (energy).
    pub dissipated: f64,
    /// The lowest critical `e` of any point from now on, where that is counted.
    pub least_critical: f64,
    /// Why these forces mean nothing.
    pub fault: Option<Fault>,
}

/// What a sweep does: that of its blocks, in any order, and of the points of this rank.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    /// Directed bonds that broke.
    pub broken: u64,
    /// What breaking did to the energy of points (energy), as [`Released`].
    pub lost: Exact,
    pub made: Exact,
    /// What laws with memory dissipated (energy).
    pub dissipated: Exact,
    /// Why these forces mean nothing.
    pub fault: Option<Fault>,
}

/// A state that a law has no answer to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// The embedding energy has no meaning at this density of this slot.
    Density { slot: usize, density: f64 },
    /// Neighbours of a chain went through each other (slots).
    Crossing { i: usize, j: usize },
}

impl Fault {
    /// The same of other slots.
    pub(super) fn at(self, slot_of: impl Fn(usize) -> usize) -> Fault {
        match self {
            Fault::Density { slot, density } => Fault::Density {
                slot: slot_of(slot),
                density,
            },
            Fault::Crossing { i, j } => Fault::Crossing {
                i: slot_of(i),
                j: slot_of(j),
            },
        }
    }
}

impl Default for BlockTally {
    fn default() -> BlockTally {
        BlockTally {
            broken: 0,
            released: Released::default(),
            dissipated: 0.0,
            least_critical: f64::INFINITY,
            fault: None,
        }
    }
}

impl AddAssign<&BlockTally> for Tally {
    fn add_assign(&mut self, o: &BlockTally) {
        self.broken += o.broken;
        self.lost.add(o.released.lost);
        self.made.add(o.released.made);
        self.dissipated.add(o.dissipated);
        self.fault = self.fault.or(o.fault);
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, o: Tally) {
        self.broken += o.broken;
        self.lost.merge(&o.lost);
        self.made.merge(&o.made);
        self.dissipated.merge(&o.dissipated);
        self.fault = self.fault.or(o.fault);
    }
}
