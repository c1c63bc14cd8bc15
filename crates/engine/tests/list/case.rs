//! The bodies, laws and displacements that lists are tried on.

use peridyne::body::{Body, Field};
use peridyne::execute::simd::Simd;
use peridyne::family::{horizon::HorizonList, stencil::Stencil};
use peridyne::interaction::list::{ListInteraction, ListParts};
use peridyne::interaction::pairs::BondTable;
use peridyne::interaction::weight::BondWeight;
use peridyne::interaction::{Interaction, PointConstants, Repulsion, Toughness};
use peridyne::law::Law;
use peridyne::law::solid::eam_like::Solid;
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::spec::{Horizon, Influence};
use std::sync::Arc;

/// Uniform numbers in ±1 (splitmix64).
pub struct Random(pub u64);
impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

pub const H: f64 = 0.0005;

/// What a case is made of besides its law.
#[derive(Clone)]
pub struct Case<const D: usize> {
    pub kind: LatticeKind,
    pub ratio: u32,
    pub cells: [i32; D],
    pub periodic: [bool; D],
    pub influence: Influence,
    pub materials: bool,
    pub toughness: Vec<Toughness>,
    pub repulsion: Option<Repulsion>,
    pub amplitude: f64,
}

impl<const D: usize> Case<D> {
    pub fn new(kind: LatticeKind, ratio: u32, cells: [i32; D]) -> Self {
        Case {
            kind,
            ratio,
            cells,
            periodic: [false; D],
            influence: Influence::Constant,
            materials: false,
            toughness: vec![Toughness {
                s00: f64::INFINITY,
                alpha: 0.0,
            }],
            repulsion: None,
            amplitude: 0.01 * H,
        }
    }
    pub fn breaking(mut self) -> Self {
        self.toughness = vec![Toughness {
            s00: 0.006,
            alpha: 0.25,
        }];
        if self.materials {
            self.toughness.push(Toughness {
                s00: 0.009,
                alpha: 0.1,
            });
        }
        self
    }
    pub fn contact(mut self) -> Self {
        self.repulsion = Some(Repulsion::uniform(3.0, 0.9, 1.35 * H));
        self.amplitude = 0.15 * H;
        self
    }

    pub fn body(&self) -> Body<D> {
        let mut quarters = vec![];
        let n: [i32; 3] = std::array::from_fn(|a| if a < D { self.cells[a] } else { 1 });
        for z in 0..n[2] {
            for y in 0..n[1] {
                for x in 0..n[0] {
                    // a free corner is missing
                    if self.periodic == [false; D] && x + y + z < 2 {
                        continue;
                    }
                    for s in self.kind.basis() {
                        quarters.push([4 * x + s[0], 4 * y + s[1], 4 * z + s[2]]);
                    }
                }
            }
        }
        let lattice = Lattice {
            kind: self.kind,
            spacing: H,
            origin: [0.1 * H, -0.3 * H, 0.0],
        };
        let reach = self.stencil().reach();
        let volume = self.kind.site_volume() * H.powi(D as i32);
        let mut body =
            Body::<D>::on_lattice(lattice, &quarters, reach, self.periodic, volume).unwrap();
        if self.materials {
            let mut material = vec![0; body.len()];
            for (id, s) in body.slots().iter().enumerate() {
                material[*s as usize] = (id / 5 % 2) as u8;
            }
            body.set_materials(material);
        }
        body
    }

    /// The same points, moved off their sites.
    pub fn perturbed_cloud(&self) -> Body<D> {
        let mut body = self.body().to_cloud().unwrap();
        let mut random = Random(5);
        let axes = body.coordinates_mut().unwrap();
        axes.into_iter()
            .flatten()
            .for_each(|x| *x += 0.2 * H * random.next());
        body
    }
    pub fn stencil(&self) -> Stencil {
        Stencil::new(self.kind, H, Horizon::Ratio(self.ratio))
    }
    pub fn delta(&self) -> f64 {
        self.ratio as f64 * H
    }

    pub fn list<W: Law>(
        &self,
        body: &Body<D>,
        law: W,
        point_constants: PointConstants,
        simd: Simd,
    ) -> ListInteraction<D, W> {
        self.list_of_pairs(body, law, point_constants, simd, Arc::default())
    }

    /// With constants of pairs of materials, where the law reads them.
    pub fn list_of_pairs<W: Law>(
        &self,
        body: &Body<D>,
        law: W,
        point_constants: PointConstants,
        simd: Simd,
        pairs: Arc<BondTable>,
    ) -> ListInteraction<D, W> {
        let parts = ListParts {
            body,
            list: HorizonList::new(body, self.delta() * (1.0 + 1e-9)).unwrap(),
            law,
            weight: BondWeight::new(self.influence, self.delta(), Some(H)),
            point_constants,
            toughness: self.toughness.clone(),
            repulsion: self.repulsion.clone(),
            simd,
        };
        let mut it = ListInteraction::of_pairs(parts, pairs);
        it.prepare(body);
        it
    }
}

/// A displacement per id, the same for every body of these points.
pub fn displace<const D: usize>(body: &Body<D>, amplitude: f64, seed: u64) -> Field<D> {
    let mut u = body.at_rest();
    let mut random = Random(seed);
    for &s in body.slots() {
        for c in &mut u {
            c[s as usize] = amplitude * random.next();
        }
    }
    body.exchange().fill_field(&mut u);
    u
}

/// Values of points in order of id.
pub fn by_id<const D: usize>(body: &Body<D>, field: &[f64]) -> Vec<f64> {
    body.slots().iter().map(|s| field[*s as usize]).collect()
}

pub fn close(what: &str, a: &[f64], b: &[f64], tolerance: f64) {
    let scale = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    assert_eq!(a.len(), b.len());
    for (id, (x, y)) in a.iter().zip(b).enumerate() {
        assert!(
            (x - y).abs() <= tolerance * scale,
            "{what} of point {id}: {x:e} and {y:e}, scale {scale:e}"
        );
    }
}

/// A soft and a stiff solid.
pub fn lps(d: usize) -> [Solid; 2] {
    [Solid::lps(d, 3.0, 1.0), Solid::lps(d, 1.5, 2.0)]
}
