//! Equilibrium, and how far two levels are apart.

use std::time::Instant;

use peridyne::spec::{AnyLinearBody, LinearBody};
use peridyne::statics::{Direct, Support};
use peridyne_theory::coarsen::{Options, Report, Selection, coarsen};

use crate::gallery::bench::Bench;
use crate::measure::apart;
use crate::{Failure, Findings};

/// The claims `deck` and `deck-moves`: how far a deck's level 0 is from that of a formula in micromoduli over v, and in equilibrium.
pub fn off_deck(
    text: &str,
    body: &LinearBody<1>,
    u: &[f64],
    found: &mut Findings,
) -> Result<(), Failure> {
    let mut bench = Bench::finished(text, &[])?;
    let AnyLinearBody::One(own) = bench.sim.linear_body() else {
        return Err(Failure::new("the deck is not a bar"));
    };
    let all = |of: &LinearBody<1>| -> Vec<f64> {
        let n = of.points();
        let pairs = (0..n * n).filter(|k| k / n != k % n);
        let c = |k: usize| of.micromodulus(k / n, k % n).map_or(0.0, |c| c[0][0]);
        pairs.map(c).collect()
    };
    if own.points() != body.points() {
        return Err(Failure::new("the deck has other nodes"));
    }
    let moved = bench.values("displacement", 0)?;
    found.number("deck", apart(&all(&own), &all(body)) / body.volume[0]);
    found.number("deck-moves", apart(&moved, u));
    Ok(())
}

pub fn failed(e: impl std::fmt::Display) -> Failure {
    Failure::new(e.to_string())
}

/// Displacements of a body with some points held, under body force densities.
pub fn equilibrium<const D: usize>(
    body: &LinearBody<D>,
    held: &[(usize, [f64; D])],
    density: &[(usize, [f64; D])],
) -> Result<Vec<[f64; D]>, Failure> {
    let mut support = Support::none(body.points());
    let mut given = vec![[0.0; D]; body.points()];
    for (i, u) in held {
        support.free[*i] = [false; D];
        given[*i] = *u;
    }
    let mut force: Vec<[f64; D]> = (0..body.points()).map(|i| body.force(&given, i)).collect();
    for (i, b) in density {
        for a in 0..D {
            force[*i][a] += b[a];
        }
    }
    for (f, v) in force.iter_mut().zip(&body.volume) {
        *f = f.map(|f| f * v);
    }
    let factors = Direct::new(body, &support, 0.0).map_err(failed)?;
    let mut u = factors.solve(&force);
    for (i, given) in held {
        u[*i] = *given;
    }
    Ok(u)
}

/// Largest difference of components over the largest of `b`.
pub fn largest<const D: usize>(a: &[[f64; D]], b: &[[f64; D]]) -> f64 {
    let most = b.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let off = a.as_flattened().iter().zip(b.as_flattened());
    off.fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) / most
}

/// A body, its levels, and where their points are in it.
pub struct Levels<const D: usize> {
    pub body: Vec<LinearBody<D>>,
    /// Numbers in the finest body.
    pub point: Vec<Vec<usize>>,
    /// Of levels 1, 2, …
    pub report: Vec<Report>,
    /// Time of making levels 1, 2, …
    pub seconds: Vec<f64>,
}

impl<const D: usize> Levels<D> {
    /// Every third point of the level before, so many times.
    pub fn thirds(fine: LinearBody<D>, times: usize, options: &Options) -> Result<Self, Failure> {
        Levels::made(fine, times, options, |below, _| {
            Selection::every(3).choose(below).map_err(failed)
        })
    }

    /// The points that `choose` takes of a level, given also their numbers in the finest body; so many times.
    pub fn made(
        fine: LinearBody<D>,
        times: usize,
        options: &Options,
        choose: impl Fn(&LinearBody<D>, &[usize]) -> Result<Vec<u32>, Failure>,
    ) -> Result<Self, Failure> {
        let mut levels = Levels {
            point: vec![(0..fine.points()).collect()],
            body: vec![fine],
            report: vec![],
            seconds: vec![],
        };
        for m in 0..times {
            let (below, point) = (&levels.body[m], &levels.point[m]);
            let keep = choose(below, point)?;
            let begin = Instant::now();
            let (body, report) = coarsen(below, &keep, options).map_err(failed)?;
            levels.seconds.push(begin.elapsed().as_secs_f64());
            let point = keep.iter().map(|k| point[*k as usize]).collect();
            levels.body.push(body);
            levels.point.push(point);
            levels.report.push(report);
        }
        Ok(levels)
    }

    /// Displacements of every level, its ends along x held and pulled apart by `strain` at the points of the last level there.
    pub fn pulled(&self, strain: f64) -> Result<Pulled<D>, Failure> {
        let last = self.point.len() - 1;
        let x = |k: &usize| self.body[0].position[*k][0];
        let far = self.point[last].iter().map(x).fold(0.0, f64::max);
        let ends: Vec<usize> = (self.point[last].iter().copied())
            .filter(|k| x(k) < 1e-9 * far || x(k) > far * (1.0 - 1e-9))
            .collect();
        let stretched = |k: &usize| {
            let mut u = [0.0; D];
            u[0] = strain * x(k);
            (*k, u)
        };
        let held: Vec<_> = ends.iter().map(stretched).collect();
        self.solved(&held, &[])
    }

    /// Displacements of every level, displacements and forces given at points of the last level, by their numbers in the finest body.
    pub fn solved(
        &self,
        held: &[(usize, [f64; D])],
        force: &[(usize, [f64; D])],
    ) -> Result<Pulled<D>, Failure> {
        let mut pulled = Pulled {
            u: vec![],
            seconds: vec![],
        };
        for (body, point) in self.body.iter().zip(&self.point) {
            let here = |(k, x): &(usize, [f64; D])| {
                let i = point.binary_search(k);
                i.map(|i| (i, *x))
                    .map_err(|_| Failure::new(format!("point {k} is not in every level")))
            };
            let held: Vec<_> = held.iter().map(here).collect::<Result<_, _>>()?;
            let force: Vec<_> = force.iter().map(here).collect::<Result<_, _>>()?;
            let density: Vec<_> = (force.iter())
                .map(|(i, f)| (*i, f.map(|f| f / body.volume[*i])))
                .collect();
            let begin = Instant::now();
            pulled.u.push(equilibrium(body, &held, &density)?);
            pulled.seconds.push(begin.elapsed().as_secs_f64());
        }
        Ok(pulled)
    }

    /// The force along x that holds some points of a level, by their numbers in the finest body.
    pub fn reaction(&self, pulled: &Pulled<D>, m: usize, points: &[usize]) -> f64 {
        let (body, u) = (&self.body[m], &pulled.u[m]);
        let held = points
            .iter()
            .filter_map(|k| self.point[m].binary_search(k).ok());
        held.map(|i| -body.volume[i] * body.force(u, i)[0]).sum()
    }

    /// Largest difference of the points of a level from the finest body's, over the largest displacement.
    pub fn error(&self, pulled: &Pulled<D>, m: usize) -> f64 {
        let fine: Vec<[f64; D]> = self.point[m].iter().map(|k| pulled.u[0][*k]).collect();
        largest(&pulled.u[m], &fine)
    }
}

pub struct Pulled<const D: usize> {
    /// Per level.
    pub u: Vec<Vec<[f64; D]>>,
    /// Time of the solution by a sparse direct solver, per level.
    pub seconds: Vec<f64>,
}

/// What the solution costs at each level; dense elimination by the law of section 6, (K0/Km)³.
pub fn costs<const D: usize>(levels: &Levels<D>, pulled: &Pulled<D>) -> String {
    let per_level = levels.body.iter().zip(&pulled.seconds).map(|(body, s)| {
        let k = (levels.body[0].points() as f64 / body.points() as f64).powi(3);
        format!(
            "{} points, {} bonds, {:.1} ms sparse, dense elimination {:.0} times less",
            body.points(),
            body.partner.len(),
            1e3 * s,
            k
        )
    });
    per_level.collect::<Vec<_>>().join("; ")
}
