//! The linear equations of a step of Newton's method, bordered by those of rigid bodies.

use super::whole::whole_support;
use crate::body::Body;
use crate::boundary_condition::rigid::Wrench;
use crate::error::SolveError;
use crate::spec::LinearBody;
use crate::state::Archive;
use crate::statics::{Assembled, Block, Direct, Goal, Shifted, Solved, Sums, Support, cg, norm};
use peridyne_algebra::Factors;

/// Of the points, and what rigid bodies with mass add.
pub(super) struct Equations<const D: usize> {
    /// Sweeps about the reference are the tangent.
    pub swept: bool,
    /// The tangent and its factors, where the matrix is.
    pub body: Option<LinearBody<D>>,
    pub factors: Option<Direct<D>>,
    /// Of equilibrium, where the matrix is: what is free and meets any resistance.
    pub resisted: Option<Support<D>>,
    /// `[N]` what inertia and rigid bodies add at points, of all points where the matrix is; empty: nothing.
    pub added: Vec<Block<D>>,
    /// What rigid bodies with mass add.
    pub border: Option<Border<D>>,
    /// `∂a/∂u` of the step in time that it was made for; 0 of equilibrium.
    pub acceleration: f64,
    /// The matrix has factors, wherever they are.
    pub factored: bool,
    /// Of no minimum of the energy.
    pub unstable: bool,
    /// Of an earlier state.
    pub old: bool,
}

impl<const D: usize> Equations<D> {
    /// Those of no body.
    pub fn none() -> Self {
        Equations {
            swept: false,
            body: None,
            factors: None,
            resisted: None,
            added: vec![],
            border: None,
            acceleration: 0.0,
            factored: false,
            unstable: false,
            old: false,
        }
    }

    /// Those of an earlier step, which are still to be read.
    pub fn unread(of: &Body<D>) -> Self {
        Equations {
            body: of.is_first().then(|| LinearBody {
                period: of.period(),
                ..LinearBody::nothing()
            }),
            factored: true,
            old: true,
            ..Equations::none()
        }
    }

    /// Equations with factors, of a step in time.
    pub fn archive(&mut self, of: &Body<D>, held: &Support<D>, archive: &mut Archive<'_>) {
        let mut elsewhere = LinearBody::nothing();
        let body = self.body.as_mut().unwrap_or(&mut elsewhere);
        archive.list_of_first("position", &mut body.position);
        archive.list_of_first("volume", &mut body.volume);
        archive.list_of_first("density", &mut body.density);
        archive.list_of_first("start", &mut body.start);
        archive.list_of_first("partner", &mut body.partner);
        archive.list_of_first("block", &mut body.block);
        archive.list_of_first("added", &mut self.added);
        let border = || Border {
            columns: vec![],
            own: vec![],
            inertia: vec![],
            radius: vec![],
        };
        archive.option("border", &mut self.border, border, |border, archive| {
            let none = || vec![[0.0; D]; of.points()];
            archive.items("columns", &mut border.columns, none, |column, archive| {
                archive.points("column", of.whose(), 1, (column, 0..of.points()));
            });
            archive.lists("own", &mut border.own);
            archive.list("inertia", &mut border.inertia);
            archive.list("radius", &mut border.radius);
        });
        archive.one("acceleration", &mut self.acceleration);
        if !archive.loads() {
            return;
        }
        let Some(held) = whole_support(of, held) else {
            return;
        };
        let made = self
            .body
            .as_ref()
            .filter(|b| b.check().is_ok())
            .map(|body| {
                // as they were made
                Direct::against(body, &held, &self.added)
            });
        match made {
            Some(Ok(factors)) => self.factors = Some(factors),
            Some(Err(_)) | None => archive.refuse("tangent"),
        }
    }

    /// Of all points, where the matrix is: with factors, or by conjugate gradients.
    pub fn solve(
        &self,
        support: &Support<D>,
        b: &[[f64; D]],
        x: &mut [[f64; D]],
        goal: Goal,
    ) -> Result<Solved, SolveError> {
        let body = self.body.as_ref().expect("the matrix is here");
        let support = match &self.resisted {
            Some(resisted) => {
                support.rests(resisted, b)?;
                resisted
            }
            None => support,
        };
        // conjugate gradients need something to seek
        if norm(b) == 0.0 {
            return Ok(Solved::default());
        }
        let added = &self.added;
        let solved = match &self.factors {
            None => cg::solve_assembled(body, added, support, b, x, goal)?,
            Some(factors) => {
                let operator = &mut Assembled(body);
                let solved = factors.solve_held(&mut Shifted { operator, added }, support, b, x);
                // LU of a singular matrix says nothing
                if !solved.residual.is_finite() {
                    return Err(SolveError::Singular);
                }
                solved
            }
        };
        Ok(Solved {
            iterations: solved.iterations.max(1),
            ..solved
        })
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
        (y, sums): (&mut [[f64; D]], &Sums),
        z: &[Vec<[f64; D]>],
        rest: &[Wrench],
    ) -> Result<(Vec<Wrench>, f64), SolveError> {
        let n = self.columns.len();
        let each = unknowns(D);
        let mut entries = vec![];
        for (row, c) in self.columns.iter().enumerate() {
            for (column, z) in z.iter().enumerate() {
                entries.push((row, column, self.own[column][row] - sums.dot(c, z)));
            }
        }
        let mut x: Vec<f64> = (0..n)
            .map(|k| rest[k / each.len()][each[k % each.len()]] - sums.dot(&self.columns[k], y))
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
