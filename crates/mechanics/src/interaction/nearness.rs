//! Which points touch: those that repel, and those whose cells meet.
//!
//! Points are middles of cells, so faces that just meet are a spacing apart, and bodies that lie side by side in the reference do not repel there.
//! A pair touches fully below `D = max(h, d)`, with h the mean of both spacings and d the distance below which it repels, and not at all
//! from `R = min(D + 0.35 H, max(r0, h + 0.35 H))` on, with H the greater spacing and r0 the distance in the reference. Between them its
//! weight is `((R − r)/(R − D))²`: contact that opens does not switch.

use super::PairTable;

/// How far beyond the distance of full touch a weight reaches, in spacings. Faces of one lattice that meet have their nearest points up to √1.5 = 1.22
/// spacings apart (shifted by half a spacing both ways), points that face each other's neighbours are √2 = 1.41 apart: 1.35 takes in the first alone.
const FADE: f64 = 0.35;

/// Who can touch whom.
#[derive(Debug, Clone)]
pub struct Nearness {
    /// Per row of the tables of repulsion (length).
    pub spacing: Vec<f64>,
    /// Points of one body that were nearer than this in the reference are bonded or were cut from each other: they never touch (length).
    pub horizon: f64,
}

/// Distances from which on a pair touches fully, and no longer (length).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    full: f64,
    reach: f64,
}

impl Bounds {
    const NEVER: Bounds = Bounds {
        full: 0.0,
        reach: 0.0,
    };

    /// 1 for points that touch, 0 for points that are apart.
    pub fn weight(&self, r: f64) -> f64 {
        if r < self.full {
            1.0
        } else if r < self.reach {
            ((self.reach - r) / (self.reach - self.full)).powi(2)
        } else {
            0.0
        }
    }
}

impl Nearness {
    /// Of a pair in rows of the tables, `r0` apart in the reference, which repels below `d` (lengths).
    pub fn bounds(&self, kinds: [usize; 2], same_body: bool, r0: f64, d: f64) -> Bounds {
        if same_body && r0 < self.horizon * (1.0 + 1e-6) {
            return Bounds::NEVER;
        }
        let (mean, fade) = self.of(kinds);
        let full = d.max(mean);
        Bounds {
            full,
            reach: (full + fade).min(r0.max(mean + fade)),
        }
    }

    /// The longest reach of any pair (length), which repels within these ranges.
    pub fn longest(&self, range: &PairTable) -> f64 {
        let kinds = 0..self.spacing.len();
        let pairs = kinds
            .clone()
            .flat_map(|a| kinds.clone().map(move |b| [a, b]));
        let reach = |[a, b]: [usize; 2]| {
            let (mean, fade) = self.of([a, b]);
            mean.max(range.at(a, b)) + fade
        };
        pairs.map(reach).fold(0.0, f64::max)
    }

    fn of(&self, kinds: [usize; 2]) -> (f64, f64) {
        let [a, b] = kinds.map(|k| self.spacing[k]);
        (0.5 * (a + b), FADE * a.max(b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearness() -> Nearness {
        Nearness {
            spacing: vec![1.0, 0.5],
            horizon: 3.0,
        }
    }

    #[test]
    fn cells_that_meet_touch_and_the_next_across_do_not() {
        let at = |r0: f64, r: f64| nearness().bounds([0, 0], false, r0, 0.9 * r0).weight(r);
        assert_eq!([at(1.0, 1.0), at(1.0, 0.9), at(1.0, 1.35)], [1.0, 1.0, 0.0]);
        // four partners, shifted by half a spacing both ways, are worth more than one
        assert!(4.0 * at(1.5f64.sqrt(), 1.5f64.sqrt()) > 1.0);
        assert_eq!(at(2f64.sqrt(), 2f64.sqrt()), 0.0);
        // bodies that come from afar are held apart at 1.35 spacings, and touch there
        let far = nearness().bounds([0, 0], false, 9.0, 1.35);
        assert_eq!([far.weight(1.349), far.weight(1.701)], [1.0, 0.0]);
        assert!((far.weight(1.525) - 0.25).abs() < 1e-12);
    }

    #[test]
    fn points_of_one_body_that_were_near_never_touch() {
        let own = |r0: f64| nearness().bounds([0, 0], true, r0, 1.35).weight(0.5);
        assert_eq!([own(2.9), own(3.1)], [0.0, 1.0]);
    }

    #[test]
    fn the_longest_reach_is_that_of_the_coarsest() {
        let longest = nearness().longest(&PairTable::uniform(1.2));
        assert!((longest - 1.55).abs() < 1e-12);
        let (unlike, alike) = (nearness().of([0, 1]), nearness().of([1, 1]));
        assert_eq!([unlike, alike], [(0.75, 0.35), (0.5, 0.175)]);
    }
}
