//! Fields at points, made of sums.

use crate::accumulate::{BOND, SYMMETRIC};
use crate::bonds::Block;
use crate::frame::{Frame, cross};
use crate::kernel::dot;
pub use crate::quantity::{Powers, Quantity};
use peridyne::state::words;

/// Why a field is not there.
pub const NO_VELOCITIES: &str = "the frame has no velocities";
/// The same.
pub const NO_POTENTIAL: &str = "the law has no potential whose slopes its forces are";
/// The same.
pub const NO_TEMPERATURE: &str = "points of a peridynamic body are no atoms";

/// Exact rates at fixed points, from velocities and forces of the instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rates {
    /// `∂ρ/∂t`, `∂π/∂t`, `∂e/∂t`.
    pub density: f64,
    pub momentum: [f64; 3],
    pub energy: f64,
    /// `∂(ρy)/∂t`; not a number where y was not asked for.
    pub coordinate: [f64; 3],
}

/// Sums over the whole frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    pub mass: f64,
    pub momentum: [f64; 3],
    pub kinetic: f64,
    /// Of the potential.
    pub energy: f64,
    /// `Σ m v⊗v` (energy).
    pub flow: [f64; 9],
    /// `Σ x_jk ⊗ f_jk` over pairs (energy): `−∫σ_U`.
    pub virial: [f64; 9],
    /// `∫z` (energy): 0, up to round-off.
    pub churning: [f64; 9],
    /// Were all particles visited? Far from all points some are not; then energy and virial are of those that were.
    pub complete: bool,
}

words!([] Totals {
    mass: f64,
    momentum: [f64; 3],
    kinetic: f64,
    energy: f64,
    flow: [f64; 9],
    virial: [f64; 9],
    churning: [f64; 9],
    complete: bool,
});

impl Totals {
    pub(crate) fn new(frame: &Frame) -> Totals {
        let mut all = Totals {
            mass: frame.mass.iter().sum(),
            momentum: [0.0; 3],
            kinetic: 0.0,
            energy: 0.0,
            flow: [0.0; 9],
            virial: [0.0; 9],
            churning: [0.0; 9],
            complete: true,
        };
        for (v, m) in frame.velocity.iter().flatten().zip(&frame.mass) {
            all.kinetic += 0.5 * m * dot(*v, *v);
            (0..3).for_each(|a| all.momentum[a] += m * v[a]);
            (0..9).for_each(|n| all.flow[n] += m * v[n / 3] * v[n % 3]);
        }
        all
    }

    pub(crate) fn take(&mut self, block: &Block, seen: bool) {
        self.complete &= seen;
        for n in 0..9 {
            self.virial[n] += block.virial[0][n];
            self.churning[n] += block.virial[1][n];
        }
    }
}

/// Fields of a part of the potential.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    pub name: String,
    pub stress: Vec<f64>,
    pub churning: Vec<f64>,
    /// q_U; empty without velocities.
    pub heat: Vec<f64>,
    pub energy: Vec<f64>,
}

/// Fields at points. What is not defined at a point is not a number there.
#[derive(Debug, Clone, PartialEq)]
pub struct Fields {
    pub points: Vec<[f64; 3]>,
    /// In the order of [`Quantity::ALL`]; empty where the frame does not allow it.
    columns: Vec<Vec<f64>>,
    /// What was left out, and why.
    missing: Vec<(Quantity, &'static str)>,
    /// One for each part of the potential, if they were to be kept apart.
    pub parts: Vec<Part>,
    /// Where they were asked for.
    pub rates: Vec<Rates>,
    pub totals: Totals,
    /// On the particles, where those were visited.
    pub force: Vec<[f64; 3]>,
}

/// What the sums of particles hold, one after the other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    pub parts: usize,
    pub moving: bool,
    pub rates: bool,
    /// Is there anything that churns?
    pub churns: bool,
    /// Are there y, its flux and the angular momentum?
    pub places: bool,
    /// Along these axes a mean has no place.
    pub averaged: [bool; 3],
}

impl Layout {
    /// Numbers times φ: n, m, U; m v, m v⊗v, m v² v, U v; F, ε̇.
    pub fn width(&self) -> usize {
        2 + self.parts + if self.moving { 15 } else { 0 } + if self.rates { 4 } else { 0 }
    }

    /// Numbers times ∇φ: m, m v (of what churns and for rates); m v⊗v, ε v.
    pub fn slopes(&self) -> usize {
        match (self.moving, self.rates) {
            (true, true) => 13,
            (true, false) if self.churns => 4,
            (true | false, _) => 0,
        }
    }

    /// Numbers times d φ, d from the particle to the point: m, m v.
    pub fn moments(&self) -> usize {
        match (self.places, self.moving) {
            (true, true) => 4,
            (true, false) => 1,
            (false, _) => 0,
        }
    }

    /// Three numbers for each of the slopes and moments, and `Σ m (v·∇φ) d` for rates of y.
    pub fn stride(&self) -> usize {
        let carried = usize::from(self.places && self.rates);
        self.width() + 3 * (self.slopes() + self.moments() + carried)
    }
}

/// Sums at the points.
pub(crate) struct Sums {
    pub bonds: Vec<f64>,
    pub particles: Vec<f64>,
}

fn three(s: &[f64]) -> [f64; 3] {
    [s[0], s[1], s[2]]
}

impl Fields {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Components point by point; `None` if the frame does not allow it.
    pub fn get(&self, quantity: Quantity) -> Option<&[f64]> {
        let place = Quantity::ALL.iter().position(|q| *q == quantity)?;
        let column = &self.columns[place];
        (column.len() == self.len() * quantity.components()).then_some(column)
    }

    /// Why there is no field of a quantity, if there is none.
    pub fn why_not(&self, quantity: Quantity) -> &'static str {
        let own = self.missing.iter().find(|(q, _)| *q == quantity);
        own.map_or(NO_VELOCITIES, |(_, why)| why)
    }

    /// Takes fields away that the particles do not allow, and says why.
    pub fn leave_out(&mut self, quantities: &[Quantity], why: &'static str) {
        for (place, quantity) in Quantity::ALL.iter().enumerate() {
            if quantities.contains(quantity) {
                self.columns[place].clear();
                self.missing.push((*quantity, why));
            }
        }
    }

    #[allow(clippy::too_many_arguments)]
    pub(crate) fn finish(
        points: Vec<[f64; 3]>,
        names: Vec<String>,
        layout: Layout,
        sums: &Sums,
        drift: [f64; 3],
        boltzmann: f64,
        totals: Totals,
        force: Vec<[f64; 3]>,
    ) -> Fields {
        let apart = layout.parts > 1;
        let part = |name: String| Part {
            name,
            stress: vec![],
            churning: vec![],
            heat: vec![],
            energy: vec![],
        };
        let mut fields = Fields {
            columns: vec![vec![]; Quantity::ALL.len()],
            missing: vec![],
            parts: match apart {
                true => names.into_iter().map(part).collect(),
                false => vec![],
            },
            rates: vec![],
            totals,
            force,
            points,
        };
        for p in 0..fields.points.len() {
            let bonds = &sums.bonds[p * layout.parts * BOND..][..layout.parts * BOND];
            let own = &sums.particles[p * layout.stride()..][..layout.stride()];
            fields.point(p, &layout, bonds, own, drift, boltzmann);
        }
        fields
    }

    fn put(&mut self, quantity: Quantity, values: &[f64]) {
        if let Some(place) = Quantity::ALL.iter().position(|q| *q == quantity) {
            self.columns[place].extend_from_slice(values);
        }
    }

    /// Fields of the parts of the potential, where they are kept apart.
    #[inline]
    fn put_parts(&mut self, layout: &Layout, bonds: &[f64], own: &[f64], velocity: [f64; 3]) {
        for (k, part) in self.parts.iter_mut().enumerate() {
            let b = &bonds[k * BOND..][..BOND];
            part.stress.extend_from_slice(&b[..9]);
            part.churning.extend_from_slice(&b[12..]);
            part.energy.push(own[2 + k]);
            if layout.moving {
                part.heat.extend(heat(b, velocity));
            }
        }
    }

    /// `∂(ρy)/∂t = Σ m (v − x_j v·∇)φ`.
    #[inline]
    fn coordinate_rate(
        &self,
        p: usize,
        layout: &Layout,
        momentum: [f64; 3],
        density: f64,
        carried: &[f64],
    ) -> [f64; 3] {
        std::array::from_fn(|a| match carried.get(a) {
            Some(carried) if !layout.averaged[a] => {
                momentum[a] + self.points[p][a] * density + carried
            }
            _ => f64::NAN,
        })
    }

    fn point(
        &mut self,
        p: usize,
        layout: &Layout,
        bonds: &[f64],
        own: &[f64],
        drift: [f64; 3],
        boltzmann: f64,
    ) {
        use Quantity as Q;
        let (count, density) = (own[0], own[1]);
        let potential: f64 = own[2..2 + layout.parts].iter().sum();
        // sums of all parts: σ_U, Σ x (D·v), z
        let mut all = [0.0; BOND];
        for part in bonds.chunks_exact(BOND) {
            (0..BOND).for_each(|n| all[n] += part[n]);
        }
        let stress: [f64; 9] = std::array::from_fn(|n| all[n]);
        let churning: [f64; 9] = std::array::from_fn(|n| all[12 + n]);
        self.put(Q::Density, &[density]);
        self.put(Q::PotentialEnergy, &[potential]);
        self.put(Q::StressPotential, &stress);
        self.put(Q::Churning, &churning);
        let empty = !(density > 0.0);
        // from the drift
        let rest = &own[2 + layout.parts..];
        let velocity = match layout.moving && !empty {
            true => three(rest).map(|p| p / density),
            false => [f64::NAN; 3],
        };
        self.put_parts(layout, bonds, own, velocity);
        let (slopes, moments) = own[layout.width()..].split_at(3 * layout.slopes());
        let place = layout.places.then(|| {
            // y = x − Σ m d φ/ρ
            let y = |a: usize| self.points[p][a] - moments[a] / density;
            std::array::from_fn(|a| if layout.averaged[a] { f64::NAN } else { y(a) })
        });
        if let Some(y) = place {
            self.put(Q::Coordinate, &y);
        }
        if !layout.moving {
            return;
        }
        let momentum: [f64; 3] = std::array::from_fn(|a| rest[a] + density * drift[a]);
        self.put(Q::Momentum, &momentum);
        let whole: [f64; 3] = std::array::from_fn(|a| velocity[a] + drift[a]);
        self.put(Q::Velocity, &whole);
        let (v, flow) = (velocity, &rest[3..9]);
        let square = dot(v, v);
        // Σ m u⊗u φ = Σ m v⊗v φ − ρ v⊗v
        let kinetic: [f64; 9] =
            std::array::from_fn(|n| density * v[n / 3] * v[n % 3] - flow[SYMMETRIC[n]]);
        let random = -(kinetic[0] + kinetic[4] + kinetic[8]);
        self.put(Q::Temperature, &[random / (3.0 * boltzmann * count)]);
        self.put(Q::InternalEnergy, &[0.5 * random + potential]);
        let speed = dot(whole, whole);
        let energy = match empty {
            // nothing is there, and so is its energy
            true => potential,
            false => 0.5 * random + potential + 0.5 * density * speed,
        };
        self.put(Q::Energy, &[energy]);
        self.put(Q::StressKinetic, &kinetic);
        self.put(
            Q::Stress,
            &std::array::from_fn::<f64, 9, _>(|n| kinetic[n] + stress[n]),
        );
        let normal: f64 = [0, 4, 8].iter().map(|n| kinetic[*n] + stress[*n]).sum();
        self.put(Q::Pressure, &[-normal / 3.0]);
        let trace = flow[0] + flow[1] + flow[2];
        let (third, carried) = (&rest[9..12], &rest[12..15]);
        let heat_kinetic: [f64; 3] = std::array::from_fn(|a| {
            let along: f64 = (0..3).map(|b| flow[SYMMETRIC[3 * a + b]] * v[b]).sum();
            // Σ ½ m u² u φ, and the potential energy that is carried along
            let motion = third[a] - v[a] * trace - 2.0 * along + 2.0 * density * square * v[a];
            0.5 * motion + carried[a] - potential * v[a]
        });
        self.put(Q::HeatKinetic, &heat_kinetic);
        self.put(Q::HeatPotential, &heat(&all, v));
        let churned: [f64; 3] =
            std::array::from_fn(|a| (0..3).map(|b| churning[3 * a + b] * whole[b]).sum());
        self.put(Q::HeatChurning, &churned);
        // ∂v_b/∂x_a = (∂π_b/∂x_a − v_b ∂ρ/∂x_a)/ρ
        let source = |n: usize| {
            let (a, b) = (n / 3, n % 3);
            churning[n] * (slopes[3 * (1 + b) + a] - v[b] * slopes[a]) / density
        };
        let source: f64 = match slopes.is_empty() {
            // 0, where there is a velocity
            true => 0.0 / density,
            false => (0..9).map(source).sum(),
        };
        self.put(Q::ChurningSource, &[source]);
        if let Some(y) = place {
            // Σ m u^a d^b φ with d = x_j − y: Σ m v^a (x_j − x)^b φ and what the mean of both has of it
            let spread = |n: usize| {
                let (a, b) = (n / 3, n % 3);
                match layout.averaged[b] {
                    true => f64::NAN,
                    false => v[a] * moments[b] - moments[3 * (1 + a) + b],
                }
            };
            self.put(Q::CoordinateFlux, &std::array::from_fn::<f64, 9, _>(spread));
            self.put(Q::AngularMomentum, &cross(y, whole).map(|l| density * l));
        }
        if layout.rates {
            let mut rates = rates(&rest[15..], slopes, drift);
            let carried = moments.get(3 * layout.moments()..).unwrap_or_default();
            rates.coordinate = self.coordinate_rate(p, layout, momentum, rates.density, carried);
            self.rates.push(rates);
        }
    }
}

/// `q_U^a = Σ x^a (D·v) β − v^b B^ab`, B = z − σ_U.
fn heat(bonds: &[f64], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|a| {
        let back: f64 = (0..3)
            .map(|b| (bonds[12 + 3 * a + b] - bonds[3 * a + b]) * v[b])
            .sum();
        bonds[9 + a] - back
    })
}

/// `∂ρ/∂t = −Σ m v·∇φ`, `∂π/∂t = Σ (F φ − m v v·∇φ)`, `∂e/∂t = Σ (ε̇ φ − ε v·∇φ)`.
fn rates(own: &[f64], slopes: &[f64], drift: [f64; 3]) -> Rates {
    let slope = |m: usize, a: usize| slopes[3 * m + a];
    let density = (0..3)
        .map(|a| -slope(1 + a, a) - drift[a] * slope(0, a))
        .sum();
    let momentum = std::array::from_fn(|b| {
        let carried: f64 = (0..3).map(|a| slope(4 + SYMMETRIC[3 * a + b], a)).sum();
        own[b] - carried
    });
    let carried: f64 = (0..3).map(|a| slope(10 + a, a)).sum();
    Rates {
        density,
        momentum,
        energy: own[3] - carried,
        coordinate: [f64::NAN; 3],
    }
}
