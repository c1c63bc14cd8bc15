//! Published corrections of bonds near a surface, as factors between whole cells.
//!
//! | method | factor of bond i–j | source |
//! |---|---|---|
//! | volume | `2 V₀ / (V_i + V_j)`, V the volume of a family | Bobaru, Foster, Geubelle & Silling 2016, ch. 2; Le & Bobaru 2018 |
//! | energy | `(Σ_a (n_a / S̄_a)²)^(−½)`, `S̄_a = ½ (S_a(i) + S_a(j))`, `S_a = W₀/W` under uniaxial stretch along a | Madenci & Oterkus 2014, section 4.2 |
//! | force | `2 ‖P₀‖ / (‖P_i‖ + ‖P_j‖)`, `P = Σ ω ν V n⊗n / r` and its largest eigenvalue | after Macek & Silling 2007; Le & Bobaru 2018 |
//!
//! The index 0 is a full family of the lattice, so that all factors are 1 inside.

use super::equations::StencilBond;
use super::sites::Sites;
use peridyne::spec::SurfaceMethod;

/// What a point is judged by: up to one number per axis, those of a full family as 1.
type Measure = [f64; 3];

fn sum(bonds: impl Iterator<Item = StencilBond>, method: SurfaceMethod) -> Measure {
    let mut tensor = [[0.0; 3]; 3];
    let mut total = [0.0; 3];
    for bond in bonds {
        let (r, n) = bond.direction();
        match method {
            SurfaceMethod::Energy => {
                for a in 0..3 {
                    total[a] += bond.weight * r * n[a].powi(4);
                }
            }
            SurfaceMethod::Force => {
                for a in 0..3 {
                    for b in 0..3 {
                        tensor[a][b] += bond.weight / r * n[a] * n[b];
                    }
                }
            }
            SurfaceMethod::Volume | SurfaceMethod::Exact => total[0] += bond.weight,
        }
    }
    if method == SurfaceMethod::Force {
        total[0] = largest_eigenvalue(tensor);
    }
    total
}

/// Of a symmetric matrix without negative eigenvalues: repeated squaring of `M/tr M` leaves the projector on the
/// largest.
fn largest_eigenvalue(matrix: [[f64; 3]; 3]) -> f64 {
    let trace = |m: &[[f64; 3]; 3]| m[0][0] + m[1][1] + m[2][2];
    let times = |x: &[[f64; 3]; 3], y: &[[f64; 3]; 3]| -> [[f64; 3]; 3] {
        std::array::from_fn(|a| {
            std::array::from_fn(|b| (0..3).map(|c| x[a][c] * y[c][b]).sum::<f64>())
        })
    };
    let mut p = matrix;
    for _ in 0..60 {
        let t = trace(&p);
        if t == 0.0 {
            return 0.0;
        }
        p = p.map(|row| row.map(|x| x / t));
        p = times(&p, &p);
    }
    trace(&times(&p, &matrix)) / trace(&p)
}

/// Factors of the bonds of the point at `place`, in the order of `bonds`; 1 where there is no partner.
pub fn row(sites: &Sites, bonds: &[StencilBond], method: SurfaceMethod, place: usize) -> Vec<f64> {
    let full = sum(bonds.iter().copied(), method);
    // how much softer than a full family
    let softness = |at: usize| -> Measure {
        let there = bonds.iter().filter(|b| sites.step(at, b.offset).is_some());
        let own = sum(there.copied(), method);
        std::array::from_fn(|a| if own[a] > 0.0 { full[a] / own[a] } else { 1.0 })
    };
    let own = softness(place);
    bonds
        .iter()
        .map(|bond| {
            let Some(to) = sites.step(place, bond.offset) else {
                return 1.0;
            };
            let other = softness(to);
            match method {
                SurfaceMethod::Energy => {
                    let (_, n) = bond.direction();
                    libm::pow(
                        (0..3)
                            .map(|a| (2.0 * n[a] / (own[a] + other[a])).powi(2))
                            .sum::<f64>(),
                        -0.5,
                    )
                }
                // of the sums, not of their inverses
                SurfaceMethod::Volume | SurfaceMethod::Force | SurfaceMethod::Exact => {
                    2.0 / (1.0 / own[0] + 1.0 / other[0])
                }
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues() {
        let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-14 * y.abs(), "{x} is not {y}");
        near(
            largest_eigenvalue([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]),
            2.0,
        );
        // 2 ± 1 in a plane
        near(
            largest_eigenvalue([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0; 3]]),
            3.0,
        );
    }

    #[test]
    fn factors_at_the_edge_of_a_square_of_nearest_bonds() {
        let points: Vec<[i32; 3]> = (0..25).map(|n| [n % 5, n / 5, 0]).collect();
        let sites = Sites::new(2, &points, [false; 3]);
        let bonds = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]].map(|offset| StencilBond {
            share: 1.0,
            offset,
            weight: 1.0,
        });
        let of = |method| row(&sites, &bonds, method, 2);
        // edge points have 3 of 4 partners: along the edge 2·4/(3+3), inward 2·4/(3+4)
        assert_eq!(
            of(SurfaceMethod::Volume),
            [4.0 / 3.0, 4.0 / 3.0, 8.0 / 7.0, 1.0]
        );
        // one of two bonds across is missing at the edge alone
        assert_eq!(of(SurfaceMethod::Energy), [1.0, 1.0, 1.5, 1.0]);
        // P keeps its largest eigenvalue
        let force = of(SurfaceMethod::Force);
        assert!(force.iter().all(|f| (f - 1.0).abs() < 1e-14), "{force:?}");
    }
}
