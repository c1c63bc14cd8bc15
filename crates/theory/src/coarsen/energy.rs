//! From the energy of the body below: retained points carry the shapes that silling2010's resolvent gives removed points, and
//! the coarse body has the energy of these shapes.
//!
//! `u_p = Σ_q S_pq u_q`, `K¹ = Sᵀ K S`. The shape of q solves the equilibrium of the removed points within its ball, held at its
//! edge: the adjoint solution of [`super::ball`]. What the edge cuts off is put right by the least change (weighted by the
//! shapes) that carries every rigid motion, so that for any law K¹ is symmetric, positive semidefinite and free of force
//! under translation and rotation, and errors of shapes enter its energies squared.

use super::ball::{Beyond, Scratch};
use super::balls::{Eliminated, Task};
use super::block::{Block, add_product, largest, scaled, transposed, unit};
use super::coupling::Coupling;
use super::error::CoarsenError;
use super::shapes::Shapes;
use super::small::solve_semidefinite;
use rayon::prelude::*;

pub(super) fn energy<const D: usize>(
    task: &Task<D>,
    radius: f64,
) -> Result<Eliminated<D>, CoarsenError> {
    let balls = task.balls(radius, Beyond::Held)?;
    let mut rows: Vec<Vec<(u32, Block<D>)>> = vec![vec![]; task.body.points()];
    let mut scratch = Scratch::new(task.body.points());
    for (k, &q) in task.retained.iter().enumerate() {
        rows[q as usize].push((k as u32, unit()));
        let walk = task.walk(k, radius, &mut scratch);
        let adjoint = &balls.solved[balls.class[k]].adjoint;
        for (&p, x) in walk.removed.iter().zip(adjoint) {
            rows[p as usize].push((k as u32, transposed(x)));
        }
    }
    if let Some(point) = rows.iter().position(Vec::is_empty) {
        return Err(CoarsenError::Uncovered { point, radius });
    }
    rows.par_iter_mut().enumerate().for_each(|(p, row)| {
        if !task.marked[p] {
            carry_rigid_motions(task, p, radius, row);
        }
    });
    // the work of a force on p is that of Sᵀ times it
    let pass = (rows.iter().zip(task.loaded))
        .map(|(row, loaded)| match loaded {
            true => row.iter().map(|(k, s)| (*k, transposed(s))).collect(),
            false => vec![],
        })
        .collect();
    let shapes = Shapes { rows };
    Ok(Eliminated {
        coupling: stiffness(task, &shapes),
        work: balls.work,
        pass,
        shapes: Some(shapes),
    })
}

/// Rigid motions about a point at `xi` from it: translations, then spins in the planes of two axes (over `length`).
fn rigid<const D: usize>(xi: &[f64; D], length: f64) -> Vec<[f64; D]> {
    let mut motions: Vec<[f64; D]> = unit::<D>().to_vec();
    for m in 0..D {
        for n in m + 1..D {
            let mut spin = [0.0; D];
            spin[m] = -xi[n] / length;
            spin[n] = xi[m] / length;
            motions.push(spin);
        }
    }
    motions
}

/// The least change of `S_pq` after which `Σ_q S_pq t_q = t_p` for every rigid motion t.
fn carry_rigid_motions<const D: usize>(
    task: &Task<D>,
    p: usize,
    length: f64,
    row: &mut [(u32, Block<D>)],
) {
    let motions: Vec<Vec<[f64; D]>> = row
        .iter()
        .map(|(q, _)| {
            rigid(
                &task.body.xi(p, task.retained[*q as usize] as usize),
                length,
            )
        })
        .collect();
    let here = rigid(&[0.0; D], length);
    let n = here.len();
    // a shape that hardly reaches p is hardly changed
    let weight: Vec<f64> = row.iter().map(|(_, s)| largest(s).powi(2)).collect();
    let mut g = vec![0.0; n * n];
    for (t, w) in motions.iter().zip(&weight) {
        for m in 0..n {
            for k in 0..n {
                g[m * n + k] += w * (0..D).map(|b| t[m][b] * t[k][b]).sum::<f64>();
            }
        }
    }
    for a in 0..D {
        let lack: Vec<f64> = (0..n)
            .map(|m| {
                let carried: f64 = (row.iter().zip(&motions))
                    .map(|((_, s), t)| (0..D).map(|b| s[a][b] * t[m][b]).sum::<f64>())
                    .sum();
                here[m][a] - carried
            })
            .collect();
        let factor = solve_semidefinite(g.clone(), &lack);
        for ((s, t), w) in row.iter_mut().zip(&motions).zip(&weight) {
            for b in 0..D {
                s.1[a][b] += w * (0..n).map(|m| factor[m] * t[m][b]).sum::<f64>();
            }
        }
    }
}

/// `Sᵀ K S`
fn stiffness<const D: usize>(task: &Task<D>, shapes: &Shapes<D>) -> Coupling<D> {
    let body = task.body;
    let mut rows = shapes.galerkin(task.retained.len(), |p, s, force| {
        let (partners, blocks) = body.row(p as usize);
        let v = body.volume[p as usize];
        for (&j, c) in partners.iter().zip(blocks) {
            let c = scaled(v, c);
            add_product(force.at(j), &transposed(&c), s);
            add_product(force.at(p), &scaled(-1.0, &c), s);
        }
    });
    for (k, row) in (0..).zip(&mut rows) {
        row.retain(|(q, _)| *q != k);
    }
    Coupling { rows }
}
