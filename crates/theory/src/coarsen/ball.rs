//! The equilibrium of the removed points in a ball about a retained point (silling2010, section 4).
//!
//! Only what the centre can feel is taken: removed points that are reached from it over removed points within the ball, and
//! the retained points that these talk to.

use super::block::{Block, add, add_product, largest, scaled, zero};
use super::near::inside;
use peridyne::spec::LinearBody;

const NONE: u32 = u32::MAX;

/// What lies beyond the ball.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Beyond {
    /// Nothing: bonds across are left out (equations (3), (4)).
    Free,
    /// Points at rest: removed points keep their whole stiffness.
    Held,
}

/// Places of points in the present ball, kept between balls.
pub(super) struct Scratch {
    place: Vec<u32>,
}

impl Scratch {
    pub fn new(points: usize) -> Scratch {
        Scratch {
            place: vec![NONE; points],
        }
    }
}

/// Points of a ball, by number in the body.
#[derive(Debug, Clone)]
pub(super) struct Walk<const D: usize> {
    pub removed: Vec<u32>,
    /// Retained points, the centre first.
    pub rim: Vec<u32>,
    /// Places from the centre (grains).
    pub removed_at: Vec<[i64; D]>,
    pub rim_at: Vec<[i64; D]>,
}

/// Points that the centre feels, each list in the order of the places in the ball (in steps of `grain`), which is the same for
/// balls that are translations of each other, periodic images or not.
pub(super) fn walk<const D: usize>(
    body: &LinearBody<D>,
    retained: &[bool],
    centre: usize,
    radius: f64,
    grain: f64,
    scratch: &mut Scratch,
) -> Walk<D> {
    let at = |xi: [f64; D]| xi.map(|x| (x / grain).round() as i64);
    scratch.place[centre] = 0;
    let mut removed: Vec<([i64; D], u32)> = vec![];
    let mut rim = vec![];
    let mut next = centre;
    let mut done = 0;
    loop {
        let (partners, blocks) = body.row(next);
        for (&p, c) in partners.iter().zip(blocks) {
            let j = p as usize;
            if scratch.place[j] != NONE || largest(c) == 0.0 {
                continue;
            }
            let xi = body.xi(centre, j);
            if !inside(&xi, radius) {
                continue;
            }
            scratch.place[j] = 0;
            match retained[j] {
                true => rim.push((at(xi), p)),
                false => removed.push((at(xi), p)),
            }
        }
        let Some(&(_, p)) = removed.get(done) else {
            break;
        };
        next = p as usize;
        done += 1;
    }
    scratch.place[centre] = NONE;
    for (_, p) in removed.iter().chain(&rim) {
        scratch.place[*p as usize] = NONE;
    }
    removed.sort_unstable();
    rim.sort_unstable();
    rim.insert(0, ([0; D], centre as u32));
    let (removed_at, removed) = removed.into_iter().unzip();
    let (rim_at, rim) = rim.into_iter().unzip();
    Walk {
        removed,
        rim,
        removed_at,
        rim_at,
    }
}

/// The equations of a ball: `M u_removed = B u_rim`, rows times the volume of their point.
pub(super) struct Ball<'a, const D: usize> {
    body: &'a LinearBody<D>,
    pub walk: &'a Walk<D>,
    pub radius: f64,
    /// `[removed + 1]`
    pub start: Vec<usize>,
    /// Places of partners: removed points first, then the rim.
    pub partner: Vec<u32>,
    /// `V_z C_zp`
    pub block: Vec<Block<D>>,
    /// `Σ_p V_z C_zp`
    pub diagonal: Vec<Block<D>>,
}

impl<'a, const D: usize> Ball<'a, D> {
    pub fn new(
        body: &'a LinearBody<D>,
        walk: &'a Walk<D>,
        radius: f64,
        beyond: Beyond,
        scratch: &mut Scratch,
    ) -> Ball<'a, D> {
        let n = walk.removed.len();
        for (k, &p) in walk.removed.iter().chain(&walk.rim).enumerate() {
            scratch.place[p as usize] = k as u32;
        }
        let mut ball = Ball {
            body,
            walk,
            radius,
            start: Vec::with_capacity(n + 1),
            partner: vec![],
            block: vec![],
            diagonal: Vec::with_capacity(n),
        };
        ball.start.push(0);
        for &z in &walk.removed {
            let z = z as usize;
            let (partners, blocks) = body.row(z);
            let mut sum = zero();
            for (&p, c) in partners.iter().zip(blocks) {
                let place = scratch.place[p as usize];
                let within = place != NONE;
                if within || beyond == Beyond::Held {
                    let k = scaled(body.volume[z], c);
                    add(&mut sum, &k);
                    if within {
                        ball.partner.push(place);
                        ball.block.push(k);
                    }
                }
            }
            ball.diagonal.push(sum);
            ball.start.push(ball.partner.len());
        }
        for &p in walk.removed.iter().chain(&walk.rim) {
            scratch.place[p as usize] = NONE;
        }
        ball
    }

    pub fn removed(&self) -> usize {
        self.walk.removed.len()
    }

    pub fn row(&self, z: usize) -> (&[u32], &[Block<D>]) {
        let row = self.start[z]..self.start[z + 1];
        (&self.partner[row.clone()], &self.block[row])
    }

    /// `V_i C_ie` of the centre i and each removed point e.
    pub fn load(&self) -> Vec<Block<D>> {
        let i = self.walk.rim[0] as usize;
        let of = |e: &u32| self.body.micromodulus(i, *e as usize);
        self.walk
            .removed
            .iter()
            .map(|e| of(e).map_or(zero(), |c| scaled(self.body.volume[i], c)))
            .collect()
    }

    /// Largest `|M_ee − M_eeᵀ|` over the largest `|M_ee|`. A free ball leaves bonds out of these sums: for state-based laws
    /// the `C_ep` are not symmetric one by one, and what is left of the sum is not either.
    pub fn asymmetry(&self) -> f64 {
        let (mut apart, mut most) = (0.0f64, 0.0f64);
        for d in &self.diagonal {
            most = most.max(largest(d));
            for a in 0..D {
                for b in 0..a {
                    apart = apart.max((d[a][b] - d[b][a]).abs());
                }
            }
        }
        if most > 0.0 { apart / most } else { 0.0 }
    }

    /// `V_i C¹_iq` of the centre and every point q of the rim, itself (`q = 0`) included:
    /// `C¹_iq = C_iq + Σ_e C_ie S_eq` (equation (11) with the volume once: erratum 1).
    pub fn coarse_row(&self, x: &[Block<D>]) -> Vec<Block<D>> {
        let i = self.walk.rim[0] as usize;
        let mut row: Vec<Block<D>> = self
            .walk
            .rim
            .iter()
            .map(|q| match self.body.micromodulus(i, *q as usize) {
                Some(c) => scaled(self.body.volume[i], c),
                None => zero(),
            })
            .collect();
        let n = self.removed();
        for (e, x) in x.iter().enumerate() {
            let (partners, blocks) = self.row(e);
            for (&p, k) in partners.iter().zip(blocks) {
                if p as usize >= n {
                    add_product(&mut row[p as usize - n], x, k);
                }
            }
        }
        row
    }

    /// How far from `P_i = Σ_p C_ip` the sum of a coarse row is, relative to its largest block (erratum 2).
    pub fn row_sum(&self, row: &[Block<D>]) -> f64 {
        let i = self.walk.rim[0] as usize;
        let (partners, blocks) = self.body.row(i);
        let mut sum = zero();
        for (&p, c) in partners.iter().zip(blocks) {
            if inside(&self.body.xi(i, p as usize), self.radius) {
                add(&mut sum, &scaled(-self.body.volume[i], c));
            }
        }
        let scale = largest(&sum);
        for k in row {
            add(&mut sum, k);
        }
        if scale > 0.0 {
            largest(&sum) / scale
        } else {
            0.0
        }
    }
}
