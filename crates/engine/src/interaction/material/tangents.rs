//! Tangents by dual numbers: every derivative of a law is that of its own functions.
//!
//! With direct sums `d_p = Σ_k ν V share_p′(η_k) δη_k` of each pass, the point is changed by `δ(point) = Σ_p G_p d_p`: a pass adds
//! `J (d_p + Q δ(point)) + M δ(point)`, J and M the derivatives of `settle` by sum and point, Q that of the sum by the point.

use super::family::{Family, Slots};
use super::view::mirrored;
use super::{MaterialInteraction, Room};
use crate::body::{Body, FieldView};
use crate::interaction::{BondTangent, Channel};
use crate::law::material::{Around, Bond, End, ForceState, Material, Numbers, Site};
use crate::law::number::Dual;

type Real = Dual<f64>;

fn still(x: f64) -> Real {
    Dual {
        value: x,
        slope: 0.0,
    }
}

/// Numbers without slopes, but that `moved` has 1.
fn lift<A: Numbers<f64>, B: Numbers<Real>>(of: &A, moved: Option<usize>) -> B {
    let mut out = B::constant(0.0);
    for n in 0..A::COUNT {
        out.set(
            n,
            Dual {
                value: of.get(n),
                slope: if moved == Some(n) { 1.0 } else { 0.0 },
            },
        );
    }
    out
}

/// A bond about η; `moved`: the axis along which η grows.
fn bent<const D: usize>(
    xi: &[f64; D],
    eta: &[f64; D],
    [omega, back]: [f64; 2],
    moved: Option<usize>,
) -> Bond<Real, D> {
    let mut change = eta.map(still);
    if let Some(a) = moved {
        change[a].slope = 1.0;
    }
    let mut bond = Bond::new(xi.map(still), change, still(omega));
    bond.omega_back = still(back);
    bond
}

/// A point with its bonds.
struct Node<const D: usize, M: Material<D>> {
    constants: M::Constants<f64>,
    point: M::Point<f64>,
    /// What is left of its force state.
    integrity: f64,
    /// `[point numbers][channels]`
    gain: Vec<Vec<f64>>,
    bonds: Vec<Half<D, M>>,
}

struct Half<const D: usize, M: Material<D>> {
    /// Place among the group's bonds, and slot of the other end (an image, maybe).
    k: usize,
    end: usize,
    xi: [f64; D],
    /// As the law sees it, and without the strain by temperature or swelling.
    eta: [f64; D],
    moved: [f64; D],
    /// `1/(1 + ε)` of that strain.
    per_length: f64,
    /// Of both ends.
    omega: [f64; 2],
    weight: f64,
    memory: M::Memory<f64>,
    /// `[channels][D]`
    share: Vec<[f64; D]>,
}

impl<const D: usize, F: Family<D>, M: Material<D>> MaterialInteraction<D, F, M> {
    fn node(&self, u: FieldView<D>, room: &Room, group: usize, l: usize) -> Node<D, M> {
        let view = self.view(u, room);
        let rows = self.family.rows(group).from(l);
        let slot = rows.slot(0);
        // SAFETY: rows of the family
        let (constants, form, past, around) = unsafe {
            (
                view.constants_at::<f64>(rows),
                rows.load::<f64, M::Form<f64>>(view.form),
                rows.load::<f64, M::Past<f64>>(view.past),
                view.around::<f64>(rows),
            )
        };
        let half = |(k, xi, omega, weight): (usize, [f64; D], f64, f64)| {
            let end = self.family.ends(group, k).slot(l);
            let moved: [f64; D] = std::array::from_fn(|a| u[a][end] - u[a][slot]);
            let of = |s: usize| self.expansion.get(s).copied().unwrap_or(0.0);
            let strain = 0.5 * (of(slot) + of(end));
            let per_length = 1.0 / (1.0 + strain);
            Half {
                k,
                end,
                xi,
                eta: std::array::from_fn(|a| (moved[a] - strain * xi[a]) * per_length),
                moved,
                per_length,
                omega: [omega, self.family.plain(group, k, l).omega_back],
                weight,
                // SAFETY: a bond of the family
                memory: unsafe { view.memory::<f64>(group, k, l) },
                share: vec![],
            }
        };
        let bonds = self.bonds_of(group, l).into_iter().map(half);
        let mut node = Node {
            constants,
            integrity: self.integrity_at(slot),
            point: <M::Point<f64> as Numbers<f64>>::constant(0.0),
            gain: vec![vec![]; <M::Point<f64> as Numbers<f64>>::COUNT],
            bonds: bonds.collect(),
        };
        for pass in 0..M::PASSES {
            self.pass(pass, &mut node, (&form, &past, around));
        }
        node
    }

    /// One pass: point, shares and gains.
    fn pass(
        &self,
        pass: usize,
        node: &mut Node<D, M>,
        (form, past, around): (&M::Form<f64>, &M::Past<f64>, Around<f64>),
    ) {
        let points = <M::Point<f64> as Numbers<f64>>::COUNT;
        let sums = <M::Sum<f64> as Numbers<f64>>::COUNT;
        let constants: M::Constants<Real> = lift(&node.constants, None);
        let share = |b: &Half<D, M>, axis: Option<usize>, number: Option<usize>| {
            let bond = bent(&b.xi, &b.eta, b.omega, axis);
            let point: M::Point<Real> = lift(&node.point, number);
            let memory: M::Memory<Real> = lift(&b.memory, None);
            let end = End {
                constants: &constants,
                point: &point,
                memory: &memory,
            };
            self.law.share(pass, &bond, &end)
        };
        let mut sum = <M::Sum<f64> as Numbers<f64>>::constant(0.0);
        // what the sum gains from the point
        let mut through = vec![vec![0.0; points]; sums];
        let mut shares = vec![];
        for b in &node.bonds {
            let mut own = vec![[0.0; D]; sums];
            for a in 0..D {
                let slopes = share(b, Some(a), None);
                for (s, own) in own.iter_mut().enumerate() {
                    own[a] = b.weight * b.per_length * slopes.get(s).slope;
                    if a == 0 {
                        sum.set(s, sum.get(s) + b.weight * slopes.get(s).value);
                    }
                }
            }
            if pass > 0 {
                for n in 0..points {
                    let slopes = share(b, None, Some(n));
                    for (s, through) in through.iter_mut().enumerate() {
                        through[n] += b.weight * slopes.get(s).slope;
                    }
                }
            }
            shares.push(own);
        }
        let lifted_form: M::Form<Real> = lift(form, None);
        let lifted_past: M::Past<Real> = lift(past, None);
        let settle = |by_sum: Option<usize>, by_point: Option<usize>| {
            let site = Site {
                constants: &constants,
                form: &lifted_form,
                past: &lifted_past,
                around: Around {
                    section: still(around.section),
                },
            };
            let mut point: M::Point<Real> = lift(&node.point, by_point);
            self.law.settle(pass, &site, lift(&sum, by_sum), &mut point);
            point
        };
        let by_sum: Vec<M::Point<Real>> = (0..sums).map(|s| settle(Some(s), None)).collect();
        let by_point: Vec<M::Point<Real>> = (0..points).map(|n| settle(None, Some(n))).collect();
        let before = node.gain.clone();
        let known = before.first().map_or(0, Vec::len);
        for (n, gain) in node.gain.iter_mut().enumerate() {
            for c in 0..known {
                let kept: f64 = (0..points)
                    .map(|m| by_point[m].get(n).slope * before[m][c])
                    .sum();
                let again: f64 = (0..sums)
                    .map(|s| {
                        let grown: f64 = (0..points).map(|m| through[s][m] * before[m][c]).sum();
                        by_sum[s].get(n).slope * grown
                    })
                    .sum();
                gain[c] = kept + again;
            }
            gain.extend((0..sums).map(|s| by_sum[s].get(n).slope));
        }
        let values = settle(None, None);
        for n in 0..points {
            node.point.set(n, values.get(n).value);
        }
        for (b, share) in node.bonds.iter_mut().zip(shares) {
            b.share.extend(share);
        }
    }

    /// Derivatives of what one end answers, as the force density on i: by η, and by the channels of that end.
    fn answer(
        &self,
        node: &Node<D, M>,
        b: &Half<D, M>,
        memory: &M::Memory<f64>,
        own: bool,
    ) -> ([[f64; D]; D], Vec<[f64; D]>, [f64; D]) {
        let channels = node.gain.first().map_or(0, Vec::len);
        if node.integrity == 0.0 {
            // whatever its law would say, that may have no answer
            return ([[0.0; D]; D], vec![[0.0; D]; channels], [0.0; D]);
        }
        let constants: M::Constants<Real> = lift(&node.constants, None);
        let memory: M::Memory<Real> = lift(memory, None);
        let pull = |axis: Option<usize>, number: Option<usize>| -> [Real; D] {
            let bond = bent(&b.xi, &b.eta, b.omega, axis);
            let point: M::Point<Real> = lift(&node.point, number);
            let end = End {
                constants: &constants,
                point: &point,
                memory: &memory,
            };
            if own {
                let state = self.law.answer(&bond, &end);
                state.alone(&bond)
            } else {
                let state = self.law.answer(&mirrored(&bond), &end);
                state.alone(&mirrored(&bond)).map(|x| still(0.0) - x)
            }
        };
        let weight = node.integrity * b.weight * b.per_length;
        let mut stiffness = [[0.0; D]; D];
        for c in 0..D {
            let slopes = pull(Some(c), None);
            for r in 0..D {
                stiffness[r][c] = weight * b.per_length * slopes[r].slope;
            }
        }
        let mut through = vec![[0.0; D]; channels];
        for (n, gain) in node.gain.iter().enumerate() {
            let slopes = pull(None, Some(n));
            for (c, through) in through.iter_mut().enumerate() {
                for r in 0..D {
                    through[r] += weight * slopes[r].slope * gain[c];
                }
            }
        }
        let value = pull(None, None).map(|x| weight * x.value);
        (stiffness, through, value)
    }

    pub(super) fn each_tangent(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        let room = Room {
            constants: self.constants(self.step),
            ..Room::default()
        };
        let original = body.originals();
        let mut nodes: Vec<Option<Node<D, M>>> = (0..body.len).map(|_| None).collect();
        for &s in &body.slots {
            if let Some((group, l)) = self.family.find(s as usize) {
                nodes[s as usize] = Some(self.node(u, &room, group, l));
            }
        }
        let view = self.view(u, &room);
        for &s in &body.slots {
            let i = s as usize;
            let (Some(node), Some((group, l))) = (&nodes[i], self.family.find(i)) else {
                continue;
            };
            for b in &node.bonds {
                let j = original(b.end);
                let Some(partner) = &nodes[j] else { continue };
                // SAFETY: a bond of the family
                let back = unsafe { view.memory_back::<f64>(group, b.k, l) };
                let (own, pull, force) = self.answer(node, b, &b.memory, true);
                let (other, partner_pull, more) = self.answer(partner, b, &back, false);
                let y: [f64; D] = std::array::from_fn(|a| b.xi[a] + b.moved[a]);
                let square: f64 = y.iter().map(|c| c * c).sum();
                let along: f64 = (0..D).map(|a| (force[a] + more[a]) * y[a]).sum();
                let channels = b.share.iter().enumerate().map(|(c, share)| Channel {
                    share: *share,
                    pull: [pull[c], partner_pull[c]],
                });
                visit(BondTangent {
                    tension: along / square,
                    stiffness: std::array::from_fn(|r| {
                        std::array::from_fn(|c| own[r][c] + other[r][c])
                    }),
                    channels: channels.collect(),
                    ..BondTangent::direct(i, j, y, [[0.0; D]; D])
                });
            }
        }
    }
}
