//! Plates of the engine, their equilibrium by conjugate gradients, their lowest frequency.

use crate::classical::{Load, Moduli};
use peridyne::law::solid::eam_like::Solid;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::LinearBody;
use peridyne::spec::*;
use peridyne::statics::{Assembled, Goal, Support, cg};
use peridyne_theory::homogenize::surface::correct;

pub struct Plate {
    sim: Box<dyn Simulation>,
    factors: (f64, f64),
    /// From the middle.
    place: Vec<[f64; 2]>,
    size: [i32; 2],
    moduli: Moduli,
    /// Does the body end half a spacing outside its outermost points?
    whole_cells: bool,
    /// Radius of a circle with the area of the hole.
    hole: f64,
}

fn spec(
    points: &[[i32; 2]],
    m: u32,
    periodic: [Option<f64>; 3],
    law: LawSpec,
    method: Option<SurfaceMethod>,
) -> Spec {
    let body = BodySpec::Sites {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.0; 3],
        quarters: points.iter().map(|p| [4 * p[0], 4 * p[1], 0]).collect(),
        volume: None,
    };
    let mut spec = Spec::new(2, body, 1.0, law);
    spec.bonds.horizon = Horizon::Ratio(m);
    spec.space.periodic = periodic;
    spec.bonds.surface = method.map(|method| {
        let (factors, report) = correct(&spec, method).expect("a lattice body");
        if let Some(report) = report.filter(|r| !r.exact) {
            eprintln!("not exact: {report:?}");
        }
        factors
    });
    spec
}

fn dot(a: &[Point], b: &[Point]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (0..2).map(|k| a[k] * b[k]).sum::<f64>())
        .sum()
}

/// Solve `K u = b` for loads in equilibrium; rigid motion is left as it comes.
fn equilibrium(sim: &mut dyn Simulation, b: &[Point]) -> Vec<Point> {
    let body: LinearBody<2> = sim.linear_body().of().expect("a plate");
    let b: Vec<[f64; 2]> = b.iter().map(|b| [b[0], b[1]]).collect();
    let mut u = vec![[0.0; 2]; b.len()];
    let goal = Goal {
        stop: || false,
        tolerance: 1e-12,
        most_iterations: 20_000,
    };
    let free = Support::none(b.len());
    cg::solve(&mut Assembled(&body), &free, &b, &mut u, goal).expect("the plate is sound");
    u.iter().map(|u| [u[0], u[1], 0.0]).collect()
}

impl Plate {
    pub fn new(
        size: [i32; 2],
        m: u32,
        law: LawSpec,
        hole: Option<f64>,
        method: Option<SurfaceMethod>,
    ) -> Plate {
        let middle = size.map(|n| 0.5 * f64::from(n - 1));
        let place = |p: &[i32; 2]| [f64::from(p[0]) - middle[0], f64::from(p[1]) - middle[1]];
        let points: Vec<[i32; 2]> = (0..size[1])
            .flat_map(|y| (0..size[0]).map(move |x| [x, y]))
            .filter(|p| {
                let x = place(p);
                hole.is_none_or(|r| x[0].hypot(x[1]) >= r)
            })
            .collect();
        let spec = spec(&points, m, [None; 3], law.clone(), method);
        let factors = match &spec.bonds.surface {
            None => (1.0, 1.0),
            Some(s) => s
                .rows
                .iter()
                .flatten()
                .fold((1.0f64, 1.0f64), |(a, b), (_, x)| {
                    (a.min(x.pair).min(x.share), b.max(x.pair).max(x.share))
                }),
        };
        let mut sim = build(&spec, Options::default()).expect("the plate is sound");
        let moduli = moduli(sim.as_mut(), &law, m);
        let whole_cells = method != Some(SurfaceMethod::Exact);
        let box_area: f64 = size
            .iter()
            .map(|n| f64::from(*n - i32::from(!whole_cells)))
            .product();
        let hole = ((box_area - sim.info().volume).max(0.0) / std::f64::consts::PI).sqrt();
        Plate {
            whole_cells,
            hole,
            place: points.iter().map(place).collect(),
            sim,
            factors,
            size,
            moduli,
        }
    }

    pub fn stable_step(&self) -> f64 {
        self.sim.info().stable_step
    }

    /// Lowest and highest factor.
    pub fn factors(&self) -> (f64, f64) {
        self.factors
    }

    /// The radius that the classical hole must have.
    pub fn hole(&self) -> f64 {
        self.hole
    }

    /// Forces of the tractions on the outer edges: exact on the outermost points if the body ends there; else those on the
    /// faces of the cells of these points. The second leave a couple, which inertia of the body takes up.
    fn loads(&self, load: Load) -> Vec<Point> {
        let half = self.size.map(|n| 0.5 * f64::from(n - 1));
        let force = |&x: &[f64; 2]| {
            let mut force = [0.0; 3];
            for a in (0..2).filter(|a| x[*a].abs() == half[*a]) {
                let mut normal = [0.0; 2];
                normal[a] = x[a].signum();
                let mut add = |f: [f64; 2]| {
                    force[0] += f[0];
                    force[1] += f[1];
                };
                if self.whole_cells {
                    let mut middle = x;
                    middle[a] += 0.5 * normal[a];
                    let (mut from, mut to) = (middle, middle);
                    from[1 - a] -= 0.5;
                    to[1 - a] += 0.5;
                    add(load.edge_force(from, to, normal));
                    add(load.edge_force(to, from, normal));
                } else {
                    for side in [-1.0, 1.0] {
                        let mut to = x;
                        to[1 - a] += side;
                        if to[1 - a].abs() <= half[1 - a] {
                            add(load.edge_force(x, to, normal));
                        }
                    }
                }
            }
            force
        };
        let all: Vec<Point> = self.place.iter().map(force).collect();
        let flat: Vec<[f64; 2]> = all.iter().map(|f| [f[0], f[1]]).collect();
        without_rigid_motion(&self.place, &flat)
            .iter()
            .map(|f| [f[0], f[1], 0.0])
            .collect()
    }

    /// Largest difference from the classical displacement, over its largest, without rigid motion.
    pub fn error(&mut self, load: Load) -> f64 {
        let b = self.loads(load);
        let u = equilibrium(self.sim.as_mut(), &b);
        let classical: Vec<[f64; 2]> = self
            .place
            .iter()
            .map(|x| load.displacement(self.moduli, *x))
            .collect();
        let size = |u: &[[f64; 2]]| u.iter().map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
        let found: Vec<[f64; 2]> = u.iter().map(|u| [u[0], u[1]]).collect();
        let without = |u: &[[f64; 2]]| without_rigid_motion(&self.place, u);
        let difference: Vec<[f64; 2]> = found
            .iter()
            .zip(&classical)
            .map(|(a, b)| [a[0] - b[0], a[1] - b[1]])
            .collect();
        size(&without(&difference)) / size(&without(&classical))
    }
}

/// Stiffness of a full family.
fn moduli(sim: &mut dyn Simulation, law: &LawSpec, m: u32) -> Moduli {
    let m = m as i32;
    let family = (-m..=m).flat_map(|y| (-m..=m).map(move |x| (f64::from(x), f64::from(y))));
    let within = |(x, y): &(f64, f64)| *x * x + y * y > 0.0 && *x * x + y * y <= f64::from(m * m);
    let family: Vec<(f64, f64)> = family.filter(within).collect();
    let solid = Solid::of_law(2, Plane::Stress, law);
    let weighted: f64 = family.iter().map(|(x, y)| x * x + y * y).sum();
    let (mut c11, mut c12) = (0.0, 0.0);
    for (x, y) in family {
        let r2 = x * x + y * y;
        // ½ t r n⊗n⊗n⊗n, t the force of a bond per its stretch
        let tension = match solid {
            Some(solid) => 2.0 * solid.beta / weighted * r2.sqrt(),
            None => sim.info().micromodulus[0],
        };
        let w = 0.5 * tension * r2.sqrt() / (r2 * r2);
        c11 += w * x.powi(4);
        c12 += w * x * x * y * y;
    }
    let kappa = solid.map_or(0.0, |s| s.kappa);
    Moduli {
        c11: c11 + kappa,
        c12: c12 + kappa,
        c66: c12,
    }
}

fn without_rigid_motion(place: &[[f64; 2]], u: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n = place.len() as f64;
    let mean = |v: &[[f64; 2]]| -> [f64; 2] {
        std::array::from_fn(|a| v.iter().map(|v| v[a]).sum::<f64>() / n)
    };
    let (x0, u0) = (mean(place), mean(u));
    let (mut turn, mut inertia) = (0.0, 0.0);
    for (x, u) in place.iter().zip(u) {
        let [x, y] = [x[0] - x0[0], x[1] - x0[1]];
        turn += x * (u[1] - u0[1]) - y * (u[0] - u0[0]);
        inertia += x * x + y * y;
    }
    let turn = turn / inertia;
    place
        .iter()
        .zip(u)
        .map(|(x, u)| {
            let [x, y] = [x[0] - x0[0], x[1] - x0[1]];
            [u[0] - u0[0] + turn * y, u[1] - u0[1] - turn * x]
        })
        .collect()
}

/// Error of the lowest frequency of a strip of `n` points between free faces, along the other axis endless:
/// `ω = π √(c11/ρ) / L`. With exact factors the strip ends at its outermost points, else half a spacing outside.
pub fn frequency_error(n: i32, m: u32, law: LawSpec, method: Option<SurfaceMethod>) -> f64 {
    let points: Vec<[i32; 2]> = (0..8).flat_map(|y| (0..n).map(move |x| [x, y])).collect();
    let spec = spec(&points, m, [None, Some(8.0), None], law.clone(), method);
    let mut sim = build(&spec, Options::default()).expect("the strip is sound");
    let (volumes, densities) = (sim.scalars("volume"), sim.scalars("density"));
    let mass: Vec<f64> = volumes.iter().zip(&densities).map(|(v, d)| v * d).collect();
    let total: f64 = mass.iter().sum();
    let length = if method == Some(SurfaceMethod::Exact) {
        f64::from(n - 1)
    } else {
        f64::from(n)
    };
    let middle = 0.5 * f64::from(n - 1);
    let x = sim.vectors("reference");
    let mut u: Vec<Point> = x
        .iter()
        .map(|x| {
            [
                (std::f64::consts::PI * (x[0] - middle) / length).sin(),
                0.0,
                0.0,
            ]
        })
        .collect();
    let mut square = 0.0;
    // inverse iteration
    for _ in 0..6 {
        let mean = u.iter().zip(&mass).map(|(u, m)| u[0] * m).sum::<f64>() / total;
        let load: Vec<Point> = u
            .iter()
            .zip(&mass)
            .map(|(u, m)| [m * (u[0] - mean), 0.0, 0.0])
            .collect();
        u = equilibrium(sim.as_mut(), &load);
        let mean = u.iter().zip(&mass).map(|(u, m)| u[0] * m).sum::<f64>() / total;
        u.iter_mut().for_each(|u| u[0] -= mean);
        let work = dot(&u, &load);
        let kinetic: f64 = u.iter().zip(&mass).map(|(u, m)| m * u[0] * u[0]).sum();
        square = work / kinetic;
        let size = u.iter().fold(0.0f64, |s, u| s.max(u[0].abs()));
        u.iter_mut().for_each(|u| u[0] /= size);
    }
    let c11 = moduli(sim.as_mut(), &law, m).c11;
    let classical = std::f64::consts::PI * c11.sqrt() / length;
    (square.sqrt() / classical - 1.0).abs()
}
