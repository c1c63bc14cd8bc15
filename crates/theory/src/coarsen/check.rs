//! Is a coarse body one that can be used?

use super::coupling::Coupling;
use super::error::CoarsenError;
use peridyne::statics::LinearBody;
use peridyne_algebra::Factors;

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

/// Is the energy of every displacement at least 0? By Cholesky of the stiffness with a part `slack` of its norm added; `false`: too many
/// unknowns for that.
///
/// # Errors
/// It is not: an eigenvalue is below `low`, relative to the norm.
pub(super) fn definite<const D: usize>(
    coupling: &Coupling<D>,
    slack: f64,
) -> Result<bool, CoarsenError> {
    let n = D * coupling.rows.len();
    if n > DEFINITE_LIMIT {
        return Ok(false);
    }
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
    let holds = |shift: f64| {
        let diagonal = (0..n).map(|k| (k, k, shift * norm));
        let lower = entries.iter().copied().filter(|(i, j, _)| j <= i);
        let all: Vec<_> = lower.chain(diagonal).collect();
        Factors::symmetric(n, &all).is_ok()
    };
    let mut low = slack;
    while norm > 0.0 && !holds(low) {
        low *= 10.0;
        if low > 10.0 {
            break;
        }
    }
    match low > slack {
        true => Err(CoarsenError::Unstable { low: -low / 10.0 }),
        false => Ok(true),
    }
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
