//! State-based models written out bond by bond, without the engine.

/// All bonds of a periodic lattice of `points` per axis.
pub struct Family {
    pub dimension: usize,
    pub points: usize,
    pub reach: usize,
    pub spacing: f64,
    /// Volume of a point.
    pub volume: f64,
    /// Partner and ξ of each bond of each point.
    bonds: Vec<Vec<(usize, [f64; 3])>>,
}

impl Family {
    pub fn periodic(dimension: usize, points: usize, reach: usize, spacing: f64) -> Family {
        let (n, r) = (points as i64, reach as i64);
        let range = |a: usize| if a < dimension { r } else { 0 };
        let mut offsets = vec![];
        for k in -range(2)..=range(2) {
            for j in -range(1)..=range(1) {
                for i in -r..=r {
                    if (1..=r * r).contains(&(i * i + j * j + k * k)) {
                        offsets.push([i, j, k]);
                    }
                }
            }
        }
        // x runs fastest, as the engine counts
        let id = |x: [i64; 3]| {
            let at = |a: usize| if a < dimension { x[a].rem_euclid(n) } else { 0 };
            ((at(2) * n + at(1)) * n + at(0)) as usize
        };
        let mut bonds = vec![vec![]; points.pow(dimension as u32)];
        let layers = |a: usize| if a < dimension { n } else { 1 };
        for z in 0..layers(2) {
            for y in 0..layers(1) {
                for x in 0..n {
                    let from = match dimension {
                        2 => (y * n + x) as usize,
                        _ => id([x, y, z]),
                    };
                    for o in &offsets {
                        let to = match dimension {
                            2 => ((y + o[1]).rem_euclid(n) * n + (x + o[0]).rem_euclid(n)) as usize,
                            _ => id([x + o[0], y + o[1], z + o[2]]),
                        };
                        bonds[from].push((to, o.map(|o| o as f64 * spacing)));
                    }
                }
            }
        }
        Family {
            dimension,
            points,
            reach,
            spacing,
            volume: spacing.powi(dimension as i32),
            bonds,
        }
    }

    pub fn len(&self) -> usize {
        self.bonds.len()
    }

    /// `f(ξ, |ξ|, |ξ+η|)` summed over the bonds of a point, times the volume.
    fn sum(&self, u: &[[f64; 3]], i: usize, f: impl Fn(f64, f64) -> f64) -> f64 {
        let all = self.bonds[i].iter().map(|(j, xi)| {
            let y: [f64; 3] = std::array::from_fn(|a| xi[a] + u[*j][a] - u[i][a]);
            f(norm(xi), norm(&y))
        });
        all.sum::<f64>() * self.volume
    }

    /// `Σ_j f(i, j, |ξ|, |ξ+η|) (ξ+η)/|ξ+η| V` of every point.
    fn forces(&self, u: &[[f64; 3]], f: impl Fn(usize, usize, f64, f64) -> f64) -> Vec<[f64; 3]> {
        let mut forces = vec![[0.0; 3]; self.len()];
        for (i, force) in forces.iter_mut().enumerate() {
            for (j, xi) in &self.bonds[i] {
                let y: [f64; 3] = std::array::from_fn(|a| xi[a] + u[*j][a] - u[i][a]);
                let (r0, r) = (norm(xi), norm(&y));
                for a in 0..3 {
                    force[a] += f(i, *j, r0, r) * y[a] / r * self.volume;
                }
            }
        }
        forces
    }
}

fn norm(x: &[f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The linear peridynamic solid with the formulas of three dimensions.
pub struct Solid<'a> {
    family: &'a Family,
    omega: &'a dyn Fn(f64) -> f64,
    bulk: f64,
    shear: f64,
    /// Weighted volume (A.7).
    pub m: f64,
}

impl<'a> Solid<'a> {
    pub fn new(family: &'a Family, omega: &'a dyn Fn(f64) -> f64, bulk: f64, shear: f64) -> Self {
        let rest = vec![[0.0; 3]; family.len()];
        Solid {
            family,
            omega,
            bulk,
            shear,
            m: family.sum(&rest, 0, |r0, _| omega(r0) * r0 * r0),
        }
    }

    /// (A.1) with (A.3) and the force scalar state (A.6).
    pub fn lps(&self, u: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let (omega, m) = (self.omega, self.m);
        let theta: Vec<f64> = (0..self.family.len())
            .map(|i| 3.0 / m * self.family.sum(u, i, |r0, r| omega(r0) * r0 * (r - r0)))
            .collect();
        let state = |theta: f64, r0: f64, r: f64| {
            let deviatoric = r - r0 - theta * r0 / 3.0;
            3.0 * self.bulk * theta / m * omega(r0) * r0
                + 15.0 * self.shear / m * omega(r0) * deviatoric
        };
        let both = |i: usize, j: usize, r0, r| state(theta[i], r0, r) + state(theta[j], r0, r);
        self.family.forces(u, both)
    }

    /// (A.11) with ϑ of (A.10), κ of (A.14), j of (A.15) and P = −E′ of (A.16).
    pub fn eam_like(&self, u: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let (omega, m) = (self.omega, self.m);
        let j = |r0: f64| omega(r0) * r0;
        let stiffness = (3.0 * self.bulk - 5.0 * self.shear) / m;
        let pressure: Vec<f64> = (0..self.family.len())
            .map(|i| {
                let volume = self.family.sum(u, i, |r0, r| j(r0) * r);
                -stiffness * (3.0 / m * volume - 3.0)
            })
            .collect();
        self.family.forces(u, |i, k, r0, r| {
            let kappa = 30.0 * self.shear / m * j(r0) * (r - r0) / r0;
            -(pressure[i] + pressure[k]) * j(r0) + kappa
        })
    }

    /// (A.5) with κ of (A.14): P = 0.
    pub fn pairs(&self, u: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let (omega, m) = (self.omega, self.m);
        self.family.forces(u, |_, _, r0, r| {
            30.0 * self.shear / m * omega(r0) * (r - r0)
        })
    }
}

/// The structured EAM (4.10) with ρ_0/f_0 of (4.4).
pub fn structured(family: &Family, p: i32, k: f64, c: f64, u: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let rest = vec![[0.0; 3]; family.len()];
    let reference = family.sum(&rest, 0, |r0, _| r0.powi(2 - p));
    let excess: Vec<f64> = (0..family.len())
        .map(|i| family.sum(u, i, |r0, r| r / r0.powi(p - 1)) / reference - 1.0)
        .collect();
    family.forces(u, |i, j, r0, r| {
        c / reference * (excess[i] + excess[j]) / r0.powi(p - 1)
            + k / reference * (r - r0) / r0.powi(p)
    })
}
