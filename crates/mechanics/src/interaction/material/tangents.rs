//! Tangents by dual numbers: every derivative of a law is that of its own functions.
//!
//! With direct sums `d_p = Σ_k ν V share_p′(η_k) δη_k` of each pass, the point is changed by `δ(point) = Σ_p G_p d_p`: a pass adds
//! `J (d_p + Q δ(point)) + M δ(point)`, J and M the derivatives of `point_update` by sum and point, Q that of the sum by the point.

use super::slopes::{Bent, LawSlopes, PlainEnd};
use crate::body::{Body, FieldView};
use crate::interaction::bonds::BondState;
use crate::interaction::bonds::family::{Family, Slots};
use crate::interaction::bonds::points::PlainPoint;
use crate::interaction::{BondTangent, Channel, EachTangent};

/// A point with its bonds.
struct Node<const D: usize> {
    /// Group and place in it.
    place: (usize, usize),
    at: PlainPoint,
    point: Vec<f64>,
    /// What is left of its force state.
    integrity: f64,
    /// `[point numbers][channels]`
    gain: Vec<Vec<f64>>,
    bonds: Vec<Bent<D>>,
    /// `[bonds][channels][D]`
    shares: Vec<Vec<[f64; D]>>,
}

/// Bonds about displacements, and their law.
pub struct Tangents<'a, const D: usize, F> {
    pub law: &'a dyn LawSlopes<D>,
    pub bonds: &'a BondState<D, F>,
    /// `[materials][numbers]`
    pub constants: &'a [f64],
    pub u: FieldView<'a, D>,
}

impl<const D: usize, F: Family<D>> Tangents<'_, D, F> {
    fn node(&self, group: usize, l: usize) -> Node<D> {
        let (bonds, family) = (self.bonds, &self.bonds.family);
        let u = self.u;
        let slot = family.rows(group).slot(l);
        let bent = |(k, xi, omega, weight): (usize, [f64; D], f64, f64)| {
            let end = family.ends(group, k).slot(l);
            let moved: [f64; D] = crate::array::from_fn(|a| u[a][end] - u[a][slot]);
            let of = |s: usize| bonds.expansion.get(s).copied().unwrap_or(0.0);
            let strain = 0.5 * (of(slot) + of(end));
            let per_length = 1.0 / (1.0 + strain);
            Bent {
                k,
                end,
                xi,
                eta: crate::array::from_fn(|a| (moved[a] - strain * xi[a]) * per_length),
                moved,
                per_length,
                omega: [omega, family.plain(group, k, l).omega_back],
                weight,
                memory: bonds.memory_at(group, k, l),
            }
        };
        let all: Vec<Bent<D>> = bonds.bonds_of(group, l).into_iter().map(bent).collect();
        let mut node = Node {
            place: (group, l),
            at: bonds.plain_point(self.constants, slot),
            point: vec![0.0; bonds.law.point],
            integrity: bonds.integrity_at(slot),
            gain: vec![vec![]; bonds.law.point],
            shares: vec![vec![]; all.len()],
            bonds: all,
        };
        for pass in 0..bonds.law.passes {
            self.pass(pass, &mut node);
        }
        node
    }

    /// One pass: point, shares and gains.
    fn pass(&self, pass: usize, node: &mut Node<D>) {
        let slopes = (self.law).pass_slopes(&node.at, pass, &node.point, &node.bonds);
        let (points, sums) = (slopes.point.len(), slopes.by_sum.len());
        let before = node.gain.clone();
        let known = before.first().map_or(0, Vec::len);
        for (n, gain) in node.gain.iter_mut().enumerate() {
            for c in 0..known {
                let kept: f64 = (0..points)
                    .map(|m| slopes.by_point[m][n] * before[m][c])
                    .sum();
                let again: f64 = (0..sums)
                    .map(|s| {
                        let through = &slopes.through[s];
                        let grown: f64 = (0..points).map(|m| through[m] * before[m][c]).sum();
                        slopes.by_sum[s][n] * grown
                    })
                    .sum();
                gain[c] = kept + again;
            }
            gain.extend((0..sums).map(|s| slopes.by_sum[s][n]));
        }
        node.point = slopes.point;
        for (all, share) in node.shares.iter_mut().zip(slopes.shares) {
            all.extend(share);
        }
    }

    /// Derivatives of the force state of one end of a node's bond, as the force density on i: by η, and by the channels of that end;
    /// with the constants of the `other`.
    fn force_state(
        &self,
        node: &Node<D>,
        b: &Bent<D>,
        (end, other): (&Node<D>, &Node<D>),
        own: bool,
    ) -> ([[f64; D]; D], Vec<[f64; D]>, [f64; D]) {
        let channels = end.gain.first().map_or(0, Vec::len);
        let mut through = vec![[0.0; D]; channels];
        if end.integrity == 0.0 {
            // whatever its law would say, that may have no answer
            return ([[0.0; D]; D], through, [0.0; D]);
        }
        let (group, l) = node.place;
        let back = match own {
            true => vec![],
            false => self.bonds.memory_back(group, b.k, l),
        };
        let end_of = PlainEnd {
            constants: &end.at.constants,
            others: &other.at.constants,
            point: &end.point,
            memory: if own { &b.memory } else { &back },
        };
        let slopes = self.law.answer_slopes(b, end_of, own);
        let weight = end.integrity * b.weight * b.per_length;
        let stiffness = (slopes.by_eta).map(|row| row.map(|x| weight * b.per_length * x));
        for (gain, slopes) in end.gain.iter().zip(&slopes.by_point) {
            for (c, through) in through.iter_mut().enumerate() {
                for r in 0..D {
                    through[r] += weight * slopes[r] * gain[c];
                }
            }
        }
        (stiffness, through, slopes.force.map(|x| weight * x))
    }

    /// What other ranks' points make of their sums, in their copies.
    fn hear_of_copies(&self, body: &Body<D>, nodes: &mut [Option<Node<D>>]) {
        if !body.exchange.is_shared() {
            return;
        }
        let own = { nodes.iter().flatten().next() }.map(|n| n.gain.iter().map(Vec::len).sum());
        let gains = body.most(own.unwrap_or(0) as f64) as usize;
        let points = self.bonds.law.point;
        let each = points + gains + 1;
        let mut numbers = vec![0.0; each * body.len];
        for (slot, node) in nodes.iter().enumerate() {
            let Some(node) = node else { continue };
            let of = node.point.iter().chain(node.gain.iter().flatten());
            let of = of.chain([&node.integrity]);
            for (number, x) in numbers[each * slot..].iter_mut().zip(of) {
                *number = *x;
            }
        }
        body.exchange
            .fill_numbers(&mut numbers, each, |slot, n| each * slot + n);
        for copy in body.exchange.copies() {
            let numbers = &numbers[each * copy..each * (copy + 1)];
            let gain = numbers[points..each - 1].chunks(gains.div_ceil(points.max(1)).max(1));
            nodes[copy] = Some(Node {
                place: (0, 0),
                at: self.bonds.plain_point(self.constants, copy),
                point: numbers[..points].to_vec(),
                integrity: numbers[each - 1],
                gain: gain.map(<[f64]>::to_vec).collect(),
                bonds: vec![],
                shares: vec![],
            });
        }
    }

    pub fn each(&self, body: &Body<D>, visit: &mut EachTangent<D>) {
        let mut nodes: Vec<Option<Node<D>>> = (0..body.len).map(|_| None).collect();
        for &s in &body.slots {
            if let Some((group, l)) = self.bonds.family.find(s as usize) {
                nodes[s as usize] = Some(self.node(group, l));
            }
        }
        self.hear_of_copies(body, &mut nodes);
        for &s in &body.slots {
            let i = s as usize;
            let Some(node) = &nodes[i] else { continue };
            for (b, shares) in node.bonds.iter().zip(&node.shares) {
                let j = body.exchange.original(b.end);
                let Some(partner) = &nodes[j] else { continue };
                let (own, pull, force) = self.force_state(node, b, (node, partner), true);
                let (other, partner_pull, more) = self.force_state(node, b, (partner, node), false);
                let y: [f64; D] = crate::array::from_fn(|a| b.xi[a] + b.moved[a]);
                let square: f64 = y.iter().map(|c| c * c).sum();
                let along: f64 = (0..D).map(|a| (force[a] + more[a]) * y[a]).sum();
                let channels = shares.iter().enumerate().map(|(c, share)| Channel {
                    share: *share,
                    pull: [pull[c], partner_pull[c]],
                });
                visit(BondTangent {
                    tension: along / square,
                    stiffness: crate::array::from_fn(|r| {
                        crate::array::from_fn(|c| own[r][c] + other[r][c])
                    }),
                    channels: channels.collect(),
                    ..BondTangent::direct(i, j, y, [[0.0; D]; D])
                });
            }
        }
    }
}
