//! Cohesion: attraction between points of different bodies, whatever they were in the reference.
//!
//! Two points at a distance r below the range L attract each other with the force density `c V_j (1 − r/L)`: a central force that falls to
//! nothing, as bonds of long-range peridynamic adhesion do (Silling & Bobaru 2005), and the sum over half-spaces is the traction
//! between their faces (Derjaguin 1934). `c` is chosen for the work of adhesion w, what it takes to pull faces of unit area apart that lie
//! where they begin to repel: of rows of points parallel to the faces, h_a and h_b apart in the bodies and d between the faces,
//! `w = h_a h_b c Σ_n Σ_m ψ(d + n h_a + m h_b)`, with ψ(z) what a point has of a plane (or line) of unit density at the distance z. That is the mean over all
//! ways in which the faces can lie on each other; as h → 0 it is `w = π c L⁵/120` in space, `t c L⁴/30` in the plane and `A c L³/24` on a line.

use super::pull::Pull;
use crate::body::{Body, Field, view};
use crate::family::neighbours::ghosts::Ghosts;
use crate::family::neighbours::{Neighbours, base};

/// How far cohesion reaches, in distances of faces that touch: shorter, and it would depend on how faces lie on each other; longer, and each
/// point would have thousands of partners.
pub const RANGES: [f64; 2] = [2.0, 20.0];

/// Range of two kinds of points that attract each other, and how strongly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adhesion {
    /// c (force / volume²)
    pub strength: f64,
    /// L (length)
    pub range: f64,
}

/// Rows of two bodies that lie on each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Faces {
    /// Distance of the rows of each body, and of the faces where they begin to repel (length).
    pub spacing: [f64; 2],
    pub apart: f64,
    /// Thickness in the plane, section on a line (length^(3 − D)).
    pub section: f64,
}

impl Adhesion {
    /// With the work of adhesion `energy` (energy / area) between such faces, of a range beyond `faces.apart`.
    pub fn new<const D: usize>(energy: f64, range: f64, faces: Faces) -> Adhesion {
        let unit = Adhesion {
            strength: 1.0,
            range,
        };
        Adhesion {
            strength: energy / unit.between::<D>(faces, |z| unit.of_plane::<D>(z)),
            range,
        }
    }

    /// With that work and this traction of faces that touch (force / area), about `4 w/L` as h → 0; `None`: its range would not be from
    /// [`RANGES`] of `faces.apart`.
    pub fn of_strength<const D: usize>(
        energy: f64,
        traction: f64,
        faces: Faces,
    ) -> Option<Adhesion> {
        let of = |range: f64| Adhesion::new::<D>(energy, range, faces);
        let [mut short, mut long] = RANGES.map(|x| x * faces.apart);
        let falls = |range: f64| of(range).traction::<D>(faces) > traction;
        if !falls(short) || falls(long) {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (short + long);
            match falls(middle) {
                true => short = middle,
                false => long = middle,
            }
        }
        Some(of(long))
    }

    /// Traction between faces where they begin to repel (force / area), the mean over all ways to lie on each other.
    pub fn traction<const D: usize>(&self, faces: Faces) -> f64 {
        // to round-off of the difference
        let by = 1e-5 * self.range;
        let at = |z: f64| self.of_plane::<D>(z);
        self.between::<D>(faces, |z| (at(z - by) - at(z + by)) / (2.0 * by))
    }

    fn between<const D: usize>(&self, faces: Faces, of: impl Fn(f64) -> f64) -> f64 {
        let [own, other] = faces.spacing;
        let rows = |h: f64| (0..).map(move |n| f64::from(n) * h);
        let near = |z: &f64| faces.apart + z < self.range;
        let sum: f64 = rows(own)
            .take_while(near)
            .flat_map(|a| rows(other).map(move |b| a + b).take_while(near))
            .map(|z| of(faces.apart + z))
            .sum();
        own * other * faces.section * sum
    }

    /// Energy that a point has of a plane (a line, a point) of unit density at a distance, positive (energy / volume^(1 + 1/D)).
    fn of_plane<const D: usize>(&self, z: f64) -> f64 {
        let l = self.range;
        if z >= l {
            return 0.0;
        }
        let left = 1.0 - z / l;
        let integral = match D {
            1 => left.powi(2),
            // ∫ (1 − ρ/L)² dy with ρ² = y² + z²
            2 => {
                let y = (l * l - z * z).sqrt();
                let bent = y * l + z * z * libm::asinh(y / z);
                2.0 * (y - bent / l + (z * z * y + y.powi(3) / 3.0) / (l * l))
            }
            // ∫ (1 − r/L)² 2π r dr from z
            _ => std::f64::consts::TAU * l * l * (left.powi(3) / 3.0 - left.powi(4) / 4.0),
        };
        0.5 * self.strength * l * integral
    }

    /// A bound on what the attraction of half a ball of points, from the distance d on, resists or assists displacements with (force density / length).
    pub fn stiffness<const D: usize>(&self, faces: Faces) -> f64 {
        let (l, d) = (self.range, faces.apart.min(self.range));
        // ∫ (1 − r/L)/r over the half ball; the slope 1/L is less than that at most distances and added
        let (central, slope) = match D {
            1 => (libm::log(l / d) - (l - d) / l, (l - d) / l),
            2 => {
                let plane = std::f64::consts::PI;
                let central = (l - d) - (l * l - d * d) / (2.0 * l);
                (plane * central, plane * (l * l - d * d) / (2.0 * l))
            }
            _ => {
                let space = std::f64::consts::TAU;
                let central = (l * l - d * d) / 2.0 - (l.powi(3) - d.powi(3)) / (3.0 * l);
                (space * central, space * (l.powi(3) - d.powi(3)) / (3.0 * l))
            }
        };
        self.strength * faces.section * (central + slope)
    }
}

/// Attraction between the bodies that a body is made of.
#[derive(Debug, Clone)]
pub struct Cohesion<const D: usize> {
    neighbours: Neighbours<D>,
    /// `[kinds][kinds]`
    table: Vec<Adhesion>,
    kinds: usize,
    /// `[slots]`: which row of the table a point has.
    kind: Vec<u16>,
    /// Of every listed pair: from i to j in the reference, to the image of j that is near.
    bases: Vec<[f64; D]>,
    ghosts: Ghosts<D>,
    /// Of ghosts: rows of the table, and volumes.
    kinds_there: Vec<u16>,
    volumes_there: Vec<f64>,
}

impl<const D: usize> Cohesion<D> {
    /// `table(a, b)` of kinds of points, `kind` that of every slot.
    pub fn new(
        body: &Body<D>,
        kinds: usize,
        kind: Vec<u16>,
        table: impl Fn(usize, usize) -> Adhesion,
    ) -> Self {
        let pairs = (0..kinds).flat_map(|a| (0..kinds).map(move |b| (a.min(b), a.max(b))));
        let table: Vec<Adhesion> = pairs.map(|(a, b)| table(a, b)).collect();
        let range = table.iter().map(|t| t.range).fold(0.0, f64::max);
        let group = (0..body.len).map(|s| body.piece_of(s) as u16).collect();
        Cohesion {
            // points of one body are left out wherever they are
            neighbours: Neighbours::new(body, range, 0.25 * range)
                .apart(f64::MAX.sqrt())
                .groups(group),
            table,
            kinds,
            kind,
            bases: vec![],
            ghosts: Ghosts::default(),
            kinds_there: vec![],
            volumes_there: vec![],
        }
    }

    pub fn moved(&mut self, path: f64) {
        self.neighbours.moved(path);
    }

    pub fn invalidate_neighbours(&mut self) {
        self.neighbours.invalidate_neighbours();
    }

    /// Find the pairs anew if points may have moved too far.
    pub fn update(&mut self, body: &Body<D>, u: &Field<D>) {
        // copies are of one body
        let apart = |i: usize, j: usize| body.piece_of(i) != body.piece_of(j);
        let ghosts = &mut self.ghosts;
        if self.neighbours.update(body, ghosts, view(u), &apart) {
            self.look(body, u);
        }
        self.ghosts.follow(view(u));
    }

    /// At the pairs as they are when they are found.
    fn look(&mut self, body: &Body<D>, u: &Field<D>) {
        self.kinds_there = self.ghosts.ask(|s| self.kind[s]);
        self.volumes_there = self.ghosts.ask(|s| body.volume.at(s));
        self.bases.clear();
        for (i, row) in self.neighbours.rows() {
            let (p, ui) = (
                self.ghosts.position(body, i),
                self.ghosts.displacement(u, i),
            );
            let each = row.iter().map(|j| {
                let j = *j as usize;
                let (q, uj) = (
                    self.ghosts.position(body, j),
                    self.ghosts.displacement(u, j),
                );
                let xi = crate::array::from_fn(|a| q[a] - p[a]);
                base(body, &xi, &crate::array::from_fn(|a| uj[a] - ui[a]))
            });
            self.bases.extend(each);
        }
    }

    /// Visit the pairs that attract each other, at the `u` of the last [`Cohesion::update`] or near it.
    pub fn each_pull(&self, body: &Body<D>, u: &Field<D>, mut visit: impl FnMut(Pull<D>)) {
        let of = |n: usize| match n.checked_sub(body.len) {
            None => (self.kind[n] as usize, body.volume.at(n)),
            Some(ghost) => (self.kinds_there[ghost] as usize, self.volumes_there[ghost]),
        };
        let mut bases = self.bases.iter();
        for (i, row) in self.neighbours.rows() {
            let (ui, (a, vi)) = (self.ghosts.displacement(u, i), of(i));
            for (&j, base) in row.iter().zip(&mut bases) {
                let j = j as usize;
                let (uj, (b, vj)) = (self.ghosts.displacement(u, j), of(j));
                let y: [f64; D] = crate::array::from_fn(|a| base[a] + (uj[a] - ui[a]));
                let r = y.iter().map(|c| c * c).sum::<f64>().sqrt();
                let Adhesion { strength, range } = self.table[a * self.kinds + b];
                if r >= range || r == 0.0 {
                    continue;
                }
                let left = 1.0 - r / range;
                visit(Pull {
                    i: self.ghosts.name(body, i),
                    j: self.ghosts.name(body, j),
                    volumes: [vi, vj],
                    y,
                    r,
                    pull: strength * left / r,
                    slope: -strength / range,
                    energy: -0.5 * strength * range * left * left,
                });
            }
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.neighbours.bytes()
            + self.ghosts.bytes()
            + 2 * self.kind.capacity()
            + size_of::<[f64; D]>() * self.bases.capacity()
    }
}
