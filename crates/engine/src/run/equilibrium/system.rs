//! The linear equations of a step of Newton's method, bordered by those of rigid bodies.

use crate::condition::rigid::Wrench;
use crate::error::SolveError;
use crate::spec::LinearBody;
use crate::state::Archive;
use crate::statics::{Block, Direct, Support, dot};
use peridyne_algebra::Factors;

/// Of the points, and what rigid bodies with mass add.
pub(super) struct Equations<const D: usize> {
    /// The tangent; `None`: sweeps about the reference.
    pub body: Option<LinearBody<D>>,
    pub factors: Option<Direct<D>>,
    /// Of equilibrium: what is free and meets any resistance.
    pub resisted: Option<Support<D>>,
    /// `[N]` what inertia and rigid bodies add at points; empty: nothing.
    pub added: Vec<Block<D>>,
    /// What rigid bodies with mass add.
    pub border: Option<Border<D>>,
    /// `∂a/∂u` of the step in time that it was made for; 0 of equilibrium.
    pub acceleration: f64,
    /// Of no minimum of the energy.
    pub unstable: bool,
    /// Of an earlier state.
    pub old: bool,
}

impl<const D: usize> Equations<D> {
    /// Those of no body.
    pub fn none(period: [Option<f64>; D]) -> Self {
        Equations {
            body: Some(LinearBody {
                position: vec![],
                volume: vec![],
                density: vec![],
                period,
                start: vec![],
                partner: vec![],
                block: vec![],
                carriers: None,
                mass: None,
            }),
            factors: None,
            resisted: None,
            added: vec![],
            border: None,
            acceleration: 0.0,
            unstable: false,
            old: true,
        }
    }

    /// Equations with factors, of a step in time.
    pub fn archive(&mut self, held: &Support<D>, archive: &mut Archive<'_>) {
        archive.given("tangent", &mut self.body, |body, archive| {
            archive.list("position", &mut body.position);
            archive.list("volume", &mut body.volume);
            archive.list("density", &mut body.density);
            archive.list("start", &mut body.start);
            archive.list("partner", &mut body.partner);
            archive.list("block", &mut body.block);
        });
        archive.list("added", &mut self.added);
        let border = || Border {
            columns: vec![],
            own: vec![],
            inertia: vec![],
            radius: vec![],
        };
        archive.option("border", &mut self.border, border, |border, archive| {
            archive.lists("columns", &mut border.columns);
            archive.lists("own", &mut border.own);
            archive.list("inertia", &mut border.inertia);
            archive.list("radius", &mut border.radius);
        });
        archive.one("acceleration", &mut self.acceleration);
        if !archive.loads() {
            return;
        }
        let made = self
            .body
            .as_ref()
            .filter(|b| b.check().is_ok())
            .map(|body| {
                // as they were made
                Direct::against(body, held, &self.added)
            });
        match made {
            Some(Ok(factors)) => self.factors = Some(factors),
            Some(Err(_)) | None => archive.refuse("tangent"),
        }
    }

    pub fn factored(&self) -> bool {
        self.factors.is_some()
    }
}

/// Unknowns of a rigid body in D dimensions, by their place among the six of a [`Wrench`].
pub(super) const fn unknowns(d: usize) -> &'static [usize] {
    match d {
        1 => &[0],
        2 => &[0, 1, 5],
        _ => &[0, 1, 2, 3, 4, 5],
    }
}

/// What rigid bodies add to the equations.
pub(super) struct Border<const D: usize> {
    /// A column of C for each unknown.
    pub columns: Vec<Vec<[f64; D]>>,
    /// S, by columns.
    pub own: Vec<Vec<f64>>,
    /// `∂(m a, dL/dt)/∂X` of every body.
    pub inertia: Vec<[[f64; 6]; 6]>,
    /// Radii of gyration (length).
    pub radius: Vec<f64>,
}

impl<const D: usize> Border<D> {
    /// How far points and bodies go: `y = A⁻¹ r`, and Z of `A⁻¹ C`; y becomes the step of the points. What bodies do, and the longest way of any, turns at
    /// radii of gyration.
    pub fn solve(
        &self,
        y: &mut [[f64; D]],
        z: &[Vec<[f64; D]>],
        rest: &[Wrench],
    ) -> Result<(Vec<Wrench>, f64), SolveError> {
        let n = self.columns.len();
        let each = unknowns(D);
        let mut entries = vec![];
        for (row, c) in self.columns.iter().enumerate() {
            for (column, z) in z.iter().enumerate() {
                entries.push((row, column, self.own[column][row] - dot(c, z)));
            }
        }
        let mut x: Vec<f64> = (0..n)
            .map(|k| rest[k / each.len()][each[k % each.len()]] - dot(&self.columns[k], y))
            .collect();
        let factors = Factors::general(n, &entries).map_err(|_| SolveError::Singular)?;
        factors.solve(&mut x);
        for (z, x) in z.iter().zip(&x) {
            for (y, z) in y.iter_mut().zip(z) {
                for a in 0..D {
                    y[a] -= x * z[a];
                }
            }
        }
        let of = |(body, inertia): (usize, &[[f64; 6]; 6])| {
            let mut out = [0.0; 6];
            for row in 0..6 {
                for (k, &column) in each.iter().enumerate() {
                    out[row] += inertia[row][column] * x[body * each.len() + k];
                }
            }
            out
        };
        let way = |(k, x): (usize, &f64)| match each[k % each.len()] < 3 {
            true => x.abs(),
            false => self.radius[k / each.len()] * x.abs(),
        };
        let far = x.iter().enumerate().map(way).fold(0.0, f64::max);
        Ok((self.inertia.iter().enumerate().map(of).collect(), far))
    }
}
