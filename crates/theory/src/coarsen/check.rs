//! Is a coarse body one that can be used?

use super::coupling::Coupling;
use super::error::CoarsenError;
use peridyne::spec::LinearBody;
use peridyne_algebra::{Factors, eigenvalues};

/// Parts of a body that no bond connects: the number of each point's part.
pub(super) fn parts(points: usize, bonds: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    let mut up: Vec<usize> = (0..points).collect();
    fn root(up: &mut [usize], mut k: usize) -> usize {
        while up[k] != k {
            up[k] = up[up[k]];
            k = up[k];
        }
        k
    }
    for (i, j) in bonds {
        let (i, j) = (root(&mut up, i), root(&mut up, j));
        up[i.max(j)] = i.min(j);
    }
    (0..points).map(|k| root(&mut up, k)).collect()
}

/// Bonds of a body that act.
pub(super) fn bonds<const D: usize>(body: &LinearBody<D>) -> impl Iterator<Item = (usize, usize)> {
    (0..body.points()).flat_map(|i| {
        let (partners, blocks) = body.row(i);
        let acting = partners.iter().zip(blocks);
        acting
            .filter(|(_, c)| c.as_flattened().iter().any(|x| *x != 0.0))
            .map(move |(j, _)| (i, *j as usize))
    })
}

/// Every part of the body below has a retained point.
pub(super) fn represented(parts: &[usize], marked: &[bool]) -> Result<(), CoarsenError> {
    let mut has = vec![false; parts.len()];
    for (part, marked) in parts.iter().zip(marked) {
        has[*part] |= marked;
    }
    match (0..parts.len()).find(|k| !has[parts[*k]]) {
        None => Ok(()),
        Some(point) => Err(CoarsenError::Unrepresented {
            point,
            points: parts.iter().filter(|p| **p == parts[point]).count(),
        }),
    }
}

/// Retained points that bonds connect below are connected.
pub(super) fn connected<const D: usize>(
    coupling: &Coupling<D>,
    retained: &[u32],
    below: &[usize],
    radius: f64,
) -> Result<(), CoarsenError> {
    let rows = &coupling.rows;
    let bonds =
        (rows.iter().enumerate()).flat_map(|(i, row)| row.iter().map(move |r| (i, r.0 as usize)));
    let coarse = parts(rows.len(), bonds);
    let mut first = std::collections::HashMap::new();
    for (k, i) in retained.iter().enumerate() {
        let seen = *first.entry(below[*i as usize]).or_insert(k);
        if coarse[k] != coarse[seen] {
            let lonely = [k, seen].into_iter().find(|k| rows[*k].is_empty());
            return Err(match lonely {
                Some(k) => CoarsenError::Alone {
                    point: retained[k] as usize,
                    radius,
                },
                None => CoarsenError::Disconnected {
                    a: retained[seen] as usize,
                    b: *i as usize,
                },
            });
        }
    }
    Ok(())
}

/// Unknowns up to which definiteness is decided by factorising.
pub const DEFINITE_LIMIT: usize = 30_000;
/// Unknowns up to which the eigenvalues of a body without symmetry are computed.
pub const EIGEN_LIMIT: usize = 1_500;
/// Growth of vibrations over the highest frequency that is round-off of eigenvalues.
const NO_GROWTH: f64 = 1e-7;

/// Are there motions that run away?
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stability {
    /// Action is reaction, and no displacement has an energy below 0.
    Definite,
    /// Action is not reaction; no eigenvalue λ of M⁻¹K has a real part below 0: equilibria are stable. Free vibrations grow at the
    /// rate `growth = max |Im √λ|` (1 / time); 0 if all eigenvalues are real.
    Stable { growth: f64 },
    /// The same by the symmetric part, which has no negative eigenvalue: too many unknowns for the growth.
    Positive,
    /// Too many unknowns to look.
    Unknown,
}

/// The entries of K, row by row, and the norm of the largest row.
fn entries<const D: usize>(coupling: &Coupling<D>) -> (Vec<(usize, usize, f64)>, f64) {
    let mut entries = vec![];
    let mut norm = 0.0f64;
    for (i, row) in coupling.rows.iter().enumerate() {
        let mut sum = [[0.0; D]; D];
        let mut size = [0.0; D];
        for (j, k) in row {
            for a in 0..D {
                for b in 0..D {
                    sum[a][b] += k[a][b];
                    size[a] += 2.0 * k[a][b].abs();
                    entries.push((D * i + a, D * *j as usize + b, -k[a][b]));
                }
            }
        }
        for a in 0..D {
            norm = norm.max(size[a]);
            for b in 0..D {
                entries.push((D * i + a, D * i + b, sum[a][b]));
            }
        }
    }
    (entries, norm)
}

/// The lowest of `slack`, 10 `slack` … of which, times its norm, makes a symmetric matrix (lower triangle) positive definite.
fn least_shift(n: usize, lower: &[(usize, usize, f64)], norm: f64, slack: f64) -> f64 {
    let holds = |shift: f64| {
        let diagonal = (0..n).map(|k| (k, k, shift * norm));
        let all: Vec<_> = lower.iter().copied().chain(diagonal).collect();
        Factors::symmetric(n, &all, |_| true).is_ok()
    };
    let mut low = slack;
    while norm > 0.0 && !holds(low) {
        low *= 10.0;
        if low > 10.0 {
            break;
        }
    }
    low
}

/// Is the energy of every displacement at least 0? By Cholesky of the stiffness with a part `slack` of its norm added.
///
/// # Errors
/// It is not: an eigenvalue is below `low`, relative to the norm.
pub(super) fn definite<const D: usize>(
    coupling: &Coupling<D>,
    slack: f64,
) -> Result<Stability, CoarsenError> {
    let n = D * coupling.rows.len();
    if n > DEFINITE_LIMIT {
        return Ok(Stability::Unknown);
    }
    let (mut lower, norm) = entries(coupling);
    lower.retain(|(i, j, _)| j <= i);
    match least_shift(n, &lower, norm, slack) {
        low if low > slack => Err(CoarsenError::Unstable { low: -low / 10.0 }),
        _ => Ok(Stability::Definite),
    }
}

/// The eigenvalues of the operator as it is, K not symmetric: of M⁻¹K with the masses of the points (volumes, where points without
/// mass are among them).
///
/// # Errors
/// A real part is below `−slack` of the largest magnitude.
pub(super) fn stable<const D: usize>(
    coupling: &Coupling<D>,
    body: &LinearBody<D>,
    slack: f64,
) -> Result<Stability, CoarsenError> {
    let n = D * coupling.rows.len();
    if n > DEFINITE_LIMIT {
        return Ok(Stability::Unknown);
    }
    let (entries, norm) = entries(coupling);
    if n > EIGEN_LIMIT {
        // x*Kx = λ x*Mx: what the symmetric part does to an eigenvector is the real part
        let half = |(i, j, v): &(usize, usize, f64)| match i == j {
            true => (*i, *j, *v),
            false => (*i.max(j), *i.min(j), 0.5 * v),
        };
        let lower: Vec<_> = entries.iter().map(half).collect();
        return Ok(match least_shift(n, &lower, norm, slack) > slack {
            true => Stability::Unknown,
            false => Stability::Positive,
        });
    }
    let massive = body.density.iter().all(|rho| *rho > 0.0);
    let mass = |i: usize| match massive {
        true => body.volume[i] * body.density[i],
        false => body.volume[i],
    };
    let mut dense = vec![0.0; n * n];
    let coupled = body.mass.as_ref().filter(|_| massive);
    for (i, j, v) in entries {
        dense[i * n + j] += match coupled {
            Some(_) => v,
            None => v / mass(i / D),
        };
    }
    if let Some(masses) = coupled {
        let mut lower = vec![];
        for i in 0..body.points() {
            let (partners, blocks) = masses.row(i);
            for (&j, m) in partners.iter().zip(blocks) {
                let all = (0..D * D).map(|k| (D * i + k / D, D * j as usize + k % D, k));
                let of = |(r, c, k): (usize, usize, usize)| (r, c, m[k / D][k % D]);
                lower.extend(all.map(of).filter(|(r, c, _)| c <= r));
            }
        }
        let Ok(factors) = Factors::symmetric(n, &lower, |_| true) else {
            return Ok(Stability::Unknown);
        };
        for j in 0..n {
            let mut column: Vec<f64> = (0..n).map(|i| dense[i * n + j]).collect();
            factors.solve(&mut column);
            (0..n).for_each(|i| dense[i * n + j] = column[i]);
        }
    }
    let Some(values) = eigenvalues(n, |i, j| dense[i * n + j]) else {
        return Ok(Stability::Unknown);
    };
    let size = |z: &[f64; 2]| libm::hypot(z[0], z[1]);
    let most = values.iter().map(size).fold(0.0, f64::max);
    let low = values.iter().map(|z| z[0]).fold(0.0, f64::min);
    if low < -slack * most {
        return Err(CoarsenError::Repelled { low: low / most });
    }
    // |Im √λ| = √((|λ| − Re λ)/2); what is 0 but for round-off has no root
    let growth = (values.iter().filter(|z| size(z) > slack * most))
        .map(|z| (0.5 * (size(z) - z[0]).max(0.0)).sqrt())
        .fold(0.0, f64::max);
    Ok(Stability::Stable {
        growth: match growth > NO_GROWTH * most.sqrt() {
            true if massive => growth,
            _ => 0.0,
        },
    })
}

/// `Σ_ij V_i C_ij[a][b] ξ_c ξ_d`, `[a][c][b][d]`: four times the energy of affine displacements.
pub(super) fn affine<const D: usize>(body: &LinearBody<D>) -> Vec<f64> {
    let mut sum = vec![0.0; D * D * D * D];
    for i in 0..body.points() {
        let (partners, blocks) = body.row(i);
        for (&j, block) in partners.iter().zip(blocks) {
            let xi = body.xi(i, j as usize);
            let mut k = 0;
            for a in 0..D {
                for c in 0..D {
                    for b in 0..D {
                        for d in 0..D {
                            sum[k] += body.volume[i] * block[a][b] * xi[c] * xi[d];
                            k += 1;
                        }
                    }
                }
            }
        }
    }
    sum
}
