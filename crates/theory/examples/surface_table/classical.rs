//! Classical plane solutions, and the forces of their tractions on points of a plate.

/// What is done to a plate.
#[derive(Debug, Clone, Copy)]
pub enum Load {
    /// Tension along x.
    Uniaxial,
    /// Tension along both axes.
    Biaxial,
    Shear,
    /// Bending by tractions along x that grow with y.
    Bending,
    /// Tension along x of an endless plate with a hole of this radius at the middle (Kirsch 1898).
    Hole(f64),
}

/// Plane moduli: `σ_xx = c11 ε_xx + c12 ε_yy`, `σ_xy = 2 c66 ε_xy`.
#[derive(Debug, Clone, Copy)]
pub struct Moduli {
    pub c11: f64,
    pub c12: f64,
    pub c66: f64,
}

impl Moduli {
    /// Compliances: `ε_xx = s11 σ_xx + s12 σ_yy`.
    fn compliance(&self) -> (f64, f64) {
        let det = self.c11 * self.c11 - self.c12 * self.c12;
        (self.c11 / det, -self.c12 / det)
    }
}

impl Load {
    /// Stresses xx, yy, xy at a place, the middle of the plate being the origin.
    pub fn stress(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        match *self {
            Load::Uniaxial => [1.0, 0.0, 0.0],
            Load::Biaxial => [1.0, 1.0, 0.0],
            Load::Shear => [0.0, 0.0, 1.0],
            Load::Bending => [y, 0.0, 0.0],
            Load::Hole(a) => {
                let (r2, q) = (x * x + y * y, y.atan2(x));
                let (k, k2) = (a * a / r2, (a * a / r2).powi(2));
                let (c2, c4, s2, s4) = (
                    (2.0 * q).cos(),
                    (4.0 * q).cos(),
                    (2.0 * q).sin(),
                    (4.0 * q).sin(),
                );
                [
                    1.0 - k * (1.5 * c2 + c4) + 1.5 * k2 * c4,
                    -k * (0.5 * c2 - c4) - 1.5 * k2 * c4,
                    -k * (0.5 * s2 + s4) + 1.5 * k2 * s4,
                ]
            }
        }
    }

    /// Displacement at a place.
    pub fn displacement(&self, m: Moduli, [x, y]: [f64; 2]) -> [f64; 2] {
        let (s11, s12) = m.compliance();
        match *self {
            Load::Uniaxial => [s11 * x, s12 * y],
            Load::Biaxial => [(s11 + s12) * x, (s11 + s12) * y],
            Load::Shear => [0.5 * y / m.c66, 0.5 * x / m.c66],
            Load::Bending => [s11 * x * y, 0.5 * (s12 * y * y - s11 * x * x)],
            Load::Hole(a) => {
                // isotropic: Young's modulus and Poisson's ratio along the axes
                let (e, nu) = (1.0 / s11, -s12 / s11);
                let (mu, kappa) = (0.5 * e / (1.0 + nu), (3.0 - nu) / (1.0 + nu));
                let (r, q) = (x.hypot(y), y.atan2(x));
                let f = a / (8.0 * mu);
                let (ra, ar) = (r / a, a / r);
                [
                    f * (ra * (kappa + 1.0) * q.cos()
                        + 2.0 * ar * ((1.0 + kappa) * q.cos() + (3.0 * q).cos())
                        - 2.0 * ar.powi(3) * (3.0 * q).cos()),
                    f * (ra * (kappa - 3.0) * q.sin()
                        + 2.0 * ar * ((1.0 - kappa) * q.sin() + (3.0 * q).sin())
                        - 2.0 * ar.powi(3) * (3.0 * q).sin()),
                ]
            }
        }
    }

    /// Force on a point by the tractions on the straight edge from it to its neighbour: `∫ N t` with the linear N that is 1
    /// at the point, by three Gauss points. `normal` points outward, edges are 1 long.
    pub fn edge_force(&self, from: [f64; 2], to: [f64; 2], normal: [f64; 2]) -> [f64; 2] {
        let mut force = [0.0; 2];
        let root = 0.6f64.sqrt();
        for (s, w) in [
            (0.5 - 0.5 * root, 5.0 / 18.0),
            (0.5, 4.0 / 9.0),
            (0.5 + 0.5 * root, 5.0 / 18.0),
        ] {
            let at = [
                from[0] + s * (to[0] - from[0]),
                from[1] + s * (to[1] - from[1]),
            ];
            let [xx, yy, xy] = self.stress(at);
            let shape = w * (1.0 - s);
            force[0] += shape * (xx * normal[0] + xy * normal[1]);
            force[1] += shape * (xy * normal[0] + yy * normal[1]);
        }
        force
    }
}
