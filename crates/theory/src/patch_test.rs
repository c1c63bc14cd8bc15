//! Patch test: the stiffness that a given set of points really has, in the bulk and where families are cut.
//!
//! Under homogeneous strains the strain energy density of every point is a quadratic form, whose coefficients the
//! D(D+1)/2 unit strains and their pair sums give. Points are sorted by how much of a full family they have. Where a rotation costs
//! energy, too, that of strains is no measure, and long waves are ([`long_waves`]).

mod long_waves;

use crate::crystal::Bond;
use crate::voigt::{Stiffness, axes, components};
use peridyne::family::stencil::Stencil;
use peridyne::run::{Info, Simulation};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::Horizon;
use std::f64::consts::PI;

/// So small that laws are linear, so large that round-off of positions does not count.
const STRAIN: f64 = 1e-6;
/// Of differences of energies that do not vanish at rest: their fourth derivatives and round-off both stay below a millionth.
const STEP: f64 = 1e-4;
/// A family with this part of a full one counts as full.
const FULL: f64 = 0.9;

/// Where a point is, by how much of a full family it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// 90 % or more.
    Bulk,
    /// As at a flat face or below it: about half and more. In 2-D an edge of the sheet, in 1-D an end.
    Face,
    /// As at an edge: about a quarter to a half. In 2-D a corner.
    Edge,
    /// As at a corner: less.
    Corner,
    /// Partners of another material.
    Interface,
}

impl Place {
    pub const ALL: [Place; 5] = [
        Place::Bulk,
        Place::Face,
        Place::Edge,
        Place::Corner,
        Place::Interface,
    ];

    /// What it is called in a body of `dimension` dimensions.
    pub fn name(self, dimension: usize) -> &'static str {
        match (self, dimension) {
            (Place::Bulk, _) => "bulk",
            (Place::Face, 1) => "end",
            (Place::Face, 2) => "edge",
            (Place::Face, _) => "face",
            (Place::Edge, 2) => "corner",
            (Place::Edge, _) => "edge",
            (Place::Corner, _) => "corner",
            (Place::Interface, _) => "interface",
        }
    }
}

/// Points of one material in one kind of place.
#[derive(Debug, Clone, PartialEq)]
pub struct Class {
    pub material: usize,
    pub place: Place,
    pub points: usize,
    /// Of these points (length^D times the section).
    pub volume: f64,
    /// Mean size of their families.
    pub family: f64,
    /// Mean part of a full family.
    pub part: f64,
    /// Mean stiffness, weighted by volume. `None`: by long waves, of which points near a surface have none of their own.
    pub stiffness: Option<Stiffness>,
    /// Is it by long waves, as the bonds of this material cost energy when the body rotates?
    pub long_waves: bool,
}

/// What a patch test finds.
#[derive(Debug, Clone, PartialEq)]
pub struct PatchTest {
    /// Volume of a full family: the median of those that come near the ball's, else near the endless lattice's, or the ball's if none does.
    pub full: f64,
    /// Classes that have points, by material, then from bulk to interface.
    pub classes: Vec<Class>,
}

impl PatchTest {
    /// The class nearest to the bulk of a material, with its stiffness; `None`: no point is of it, or none has a stiffness of its own.
    pub fn best(&self, material: usize) -> Option<(&Class, &Stiffness)> {
        let mut of = self.classes.iter().filter(|c| c.material == material);
        of.find_map(|c| Some((c, c.stiffness.as_ref()?)))
    }

    /// Mean stiffness of all points of a material, weighted by volume: that of the body where they share their strains, as the
    /// layers of a plate in its plane do. `None`: no point is of it, or some have no stiffness of their own.
    pub fn whole(&self, material: usize) -> Option<Stiffness> {
        let of = || self.classes.iter().filter(|c| c.material == material);
        let volume: f64 = of().map(|c| c.volume).sum();
        let mut mean = Stiffness {
            dimension: of().next()?.stiffness.as_ref()?.dimension,
            c: [[0.0; 6]; 6],
        };
        for class in of() {
            let stiffness = class.stiffness.as_ref()?;
            for i in 0..6 {
                for j in 0..6 {
                    mean.c[i][j] += class.volume / volume * stiffness.c[i][j];
                }
            }
        }
        Some(mean)
    }
}

/// Stiffness of every class of points. Takes one pass over the bonds per coefficient: 1, 6 or 21; of atoms one in all.
///
/// Atoms at rest have energy and may be under stress, so that the energy of a strain is no measure of stiffness; theirs is `B`
/// of [`crate::elastic_constants`] about the displacements of now, stress against strain with all atoms carried along. Of atoms whose
/// potential is no sum of bonds it is that about the reference.
///
/// `lattice` and its spacing are those of the body, where its points lie on one: the few neighbours of a crystal like diamond fill no ball.
pub fn patch_test(sim: &mut dyn Simulation, lattice: Option<(LatticeKind, f64)>) -> PatchTest {
    let info = sim.info().clone();
    let info = &info;
    let mut found = classes(sim, info, lattice);
    let atoms = match info.dimension {
        1 => of_atoms::<1>(sim, &found),
        2 => of_atoms::<2>(sim, &found),
        _ => of_atoms::<3>(sim, &found),
    };
    match atoms {
        Some(stiffness) => {
            for (class, stiffness) in found.classes.iter_mut().zip(stiffness) {
                class.stiffness = Some(stiffness);
            }
        }
        None => {
            let rest = sim.energy_under_strain([[0.0; 3]; 3]);
            match rest.iter().all(|e| *e == 0.0) && !is_stressed(sim, &found) {
                true => {
                    by_strains(sim, &mut found);
                    long_waves::where_rotations_cost(sim, &mut found);
                }
                false => by_differences(sim, &mut found),
            }
        }
    }
    found.classes.sort_by_key(|c| (c.material, c.place));
    PatchTest {
        full: found.full,
        classes: found.classes,
    }
}

/// Classes whose stiffness is not known yet, and the class of every point.
struct Sorted {
    full: f64,
    classes: Vec<Class>,
    /// `[N]`
    of_point: Vec<usize>,
    /// `[N]` volumes of points.
    volume: Vec<f64>,
    /// `[classes]` volumes.
    weight: Vec<f64>,
    /// Have all points families of one size, as in a crystal that is periodic along all axes?
    even: bool,
}

impl Sorted {
    /// `[classes]` mean energy density under a homogeneous displacement gradient.
    fn energies(&self, sim: &dyn Simulation, gradient: [[f64; 3]; 3]) -> Vec<f64> {
        let mut sum = vec![0.0; self.weight.len()];
        let of = sim.energy_under_strain(gradient);
        for ((w, &k), v) in of.iter().zip(&self.of_point).zip(&self.volume) {
            sum[k] += w * v / self.weight[k];
        }
        sum
    }
}

fn classes(sim: &mut dyn Simulation, info: &Info, lattice: Option<(LatticeKind, f64)>) -> Sorted {
    let d = info.dimension;
    let families = sim.families();
    let volume = sim.scalars("volume");
    let full = full_family(info, &families.volume, lattice);
    let cell = info.volume / info.points.max(1) as f64 / info.section;
    let m = info.horizon / libm::pow(cell, 1.0 / d as f64);
    let part: Vec<f64> = families.volume.iter().map(|v| v / full).collect();
    let mut of_point = Vec::with_capacity(part.len());
    let mut keys: Vec<(usize, Place)> = vec![];
    for i in 0..part.len() {
        let place = if families.foreign[i] {
            Place::Interface
        } else {
            place(d, m, part[i])
        };
        let key = (families.material[i] as usize, place);
        let k = keys.iter().position(|k| *k == key).unwrap_or_else(|| {
            keys.push(key);
            keys.len() - 1
        });
        of_point.push(k);
    }
    let mut classes: Vec<Class> = keys
        .iter()
        .map(|&(material, place)| Class {
            material,
            place,
            points: 0,
            volume: 0.0,
            family: 0.0,
            part: 0.0,
            stiffness: None,
            long_waves: false,
        })
        .collect();
    let mut weight = vec![0.0; classes.len()];
    for (i, &k) in of_point.iter().enumerate() {
        weight[k] += volume[i];
        classes[k].volume += volume[i];
        classes[k].points += 1;
        classes[k].family += families.size[i] as f64;
        classes[k].part += part[i];
    }
    for class in &mut classes {
        class.family /= class.points as f64;
        class.part /= class.points as f64;
    }
    let size = &families.volume;
    Sorted {
        full,
        classes,
        of_point,
        volume,
        weight,
        even: size.iter().all(|v| (v - size[0]).abs() <= 1e-9 * size[0]),
    }
}

/// Does a small stretch cost work against a stress at rest, as of a gas under pressure, far more than against stiffness? Laws that resist tension and
/// compression unlike have energies of one sign.
fn is_stressed(sim: &dyn Simulation, found: &Sorted) -> bool {
    let [plus, minus] = [STRAIN, -STRAIN].map(|s| {
        let stretch =
            std::array::from_fn(|a| std::array::from_fn(|b| if a == b { s } else { 0.0 }));
        found.energies(sim, stretch)
    });
    (plus.iter().zip(&minus)).any(|(p, m)| (p - m).abs() > 10.0 * (p + m).abs())
}

/// From the energies of homogeneous strains.
fn by_strains(sim: &dyn Simulation, found: &mut Sorted) {
    let d = sim.info().dimension;
    let mut energy = vec![[[0.0; 6]; 6]; found.classes.len()];
    for i in 0..components(d) {
        for j in 0..=i {
            let mut strain = [0.0; 6];
            strain[i] += STRAIN;
            if j < i {
                strain[j] += STRAIN;
            }
            let energies = found.energies(sim, tensor(d, strain));
            for (of, energy) in energy.iter_mut().zip(energies) {
                of[i][j] = energy / (STRAIN * STRAIN);
            }
        }
    }
    for (class, energy) in found.classes.iter_mut().zip(energy) {
        let mut c = [[0.0; 6]; 6];
        for i in 0..components(d) {
            for j in 0..i {
                c[i][j] = energy[i][j] - energy[i][i] - energy[j][j];
                c[j][i] = c[i][j];
            }
            c[i][i] = 2.0 * energy[i][i];
        }
        class.stiffness = Some(Stiffness { dimension: d, c });
    }
}

/// From the energies of homogeneous strains of both signs, for points that have energy and stress at rest.
fn by_differences(sim: &dyn Simulation, found: &mut Sorted) {
    let dimension = sim.info().dimension;
    let n = components(dimension);
    let at = |i: usize, a: f64, j: usize, b: f64| {
        let mut strain = [0.0; 6];
        strain[i] += a * STEP;
        strain[j] += b * STEP;
        found.energies(sim, tensor(dimension, strain))
    };
    let mut stress = vec![[[0.0; 3]; 3]; found.weight.len()];
    let mut second = vec![[[0.0; 6]; 6]; found.weight.len()];
    for i in 0..n {
        let (plus, minus) = (at(i, 0.5, i, 0.5), at(i, -0.5, i, -0.5));
        for (k, stress) in stress.iter_mut().enumerate() {
            let (a, b) = axes(dimension, i);
            stress[a][b] = (plus[k] - minus[k]) / (2.0 * STEP);
            stress[b][a] = stress[a][b];
        }
        for j in 0..=i {
            let (pp, mm) = (at(i, 1.0, j, 1.0), at(i, -1.0, j, -1.0));
            let (pm, mp) = (at(i, 1.0, j, -1.0), at(i, -1.0, j, 1.0));
            for (k, second) in second.iter_mut().enumerate() {
                second[i][j] = (pp[k] - pm[k] - mp[k] + mm[k]) / (4.0 * STEP * STEP);
                second[j][i] = second[i][j];
            }
        }
    }
    for ((class, c), s) in found.classes.iter_mut().zip(second).zip(&stress) {
        let second = Stiffness { dimension, c };
        class.stiffness = Some(match dimension {
            1 => of_stretches(second, &corner::<1>(s)),
            2 => of_stretches(second, &corner::<2>(s)),
            _ => of_stretches(second, s),
        });
    }
}

fn corner<const D: usize>(s: &[[f64; 3]; 3]) -> [[f64; D]; D] {
    std::array::from_fn(|a| std::array::from_fn(|b| s[a][b]))
}

/// `B` under the stress `s` from the second derivatives of the energy by stretches ε: those by Lagrange's strain `ε + ½ε²`, which `C` are,
/// have ½ Σ (δ_ik s_jl + …)/2 less.
fn of_stretches<const D: usize>(second: Stiffness, s: &[[f64; D]; D]) -> Stiffness {
    let zero = Stiffness {
        dimension: D,
        c: [[0.0; 6]; 6],
    };
    let mut found = second.under_stress(s);
    // what a stress adds without its trace is twice what the stretches have too much
    let added = zero.under_stress(s);
    for v in 0..components(D) {
        for w in 0..components(D) {
            let ((i, j), (k, l)) = (axes(D, v), axes(D, w));
            let trace = if k == l { s[i][j] } else { 0.0 };
            found.c[v][w] -= 0.5 * (added.c[v][w] + trace);
        }
    }
    found
}

/// From the bonds of atoms; `None` if the points are no atoms.
fn of_atoms<const D: usize>(sim: &mut dyn Simulation, found: &Sorted) -> Option<Vec<Stiffness>> {
    let none = Stiffness {
        dimension: D,
        c: [[0.0; 6]; 6],
    };
    let mut stiffness = vec![none; found.classes.len()];
    let mut stress = vec![[[0.0; D]; D]; stiffness.len()];
    let mut shares = vec![[0.0; 6]; found.of_point.len()];
    let curvature = sim.bonds_of_atoms(&mut |bond| {
        let (from, to) = (bond.from as usize, bond.to as usize);
        let class = found.of_point[from];
        let v = found.weight[class];
        let bond = Bond {
            from,
            to,
            xi: std::array::from_fn(|a| bond.xi[a]),
            tension: bond.tension,
            stiffness: bond.stiffness,
            share: bond.share,
        };
        stiffness[class].add_bond::<D>(&bond, &mut shares[from], v);
        bond.add_stress(&mut stress[class], v);
    })?;
    for ((share, curvature), class) in shares.iter().zip(curvature).zip(&found.of_point) {
        stiffness[*class].add_site(share, curvature, found.weight[*class]);
    }
    let both = stiffness.into_iter().zip(&stress);
    Some(both.map(|(c, s)| c.under_stress(s)).collect())
}

/// Strain tensor of Voigt components with engineering shears.
fn tensor(d: usize, voigt: [f64; 6]) -> [[f64; 3]; 3] {
    let mut strain = [[0.0; 3]; 3];
    for (c, e) in voigt.iter().enumerate().take(components(d)) {
        let (a, b) = axes(d, c);
        if a == b {
            strain[a][a] = *e;
        } else {
            strain[a][b] = 0.5 * e;
            strain[b][a] = 0.5 * e;
        }
    }
    strain
}

/// Length, area or volume of the ball of radius r in `d` dimensions.
fn ball(d: usize, r: f64) -> f64 {
    match d {
        1 => 2.0 * r,
        2 => PI * r * r,
        _ => 4.0 / 3.0 * PI * r * r * r,
    }
}

/// Volume of a full family: of a ball, or where none comes near that, as where few shells of a crystal with a basis lie within a cut-off, that of
/// the endless lattice.
fn full_family(info: &Info, families: &[f64], lattice: Option<(LatticeKind, f64)>) -> f64 {
    let cell = info.volume / info.points.max(1) as f64;
    let by_ball = ball(info.dimension, info.horizon) * info.section - cell;
    let median_near = |full: f64| {
        let mut near: Vec<f64> = { families.iter().copied() }
            .filter(|v| *v >= FULL * full)
            .collect();
        near.sort_by(f64::total_cmp);
        near.get(near.len() / 2).copied()
    };
    let of_lattice = |(kind, spacing): (LatticeKind, f64)| {
        let family = Stencil::new(kind, spacing, Horizon::Length(info.horizon));
        cell * family.bonds() as f64
    };
    median_near(by_ball)
        .or_else(|| lattice.map(of_lattice).and_then(median_near))
        .unwrap_or(by_ball)
}

/// A point on a flat face of a body with m spacings in a horizon keeps half of its family and half of the layer that
/// it lies in, `φ`; at a square edge it keeps φ², at a corner φ³. The borders are halfway between, in powers.
fn place(d: usize, m: f64, part: f64) -> Place {
    let layer = match d {
        1 => 0.0,
        2 => 2.0 / (PI * m),
        _ => 0.75 / m,
    };
    let face = 0.5 * (1.0 + layer.min(1.0));
    if part >= FULL {
        Place::Bulk
    } else if d == 1 || part >= libm::pow(face, 1.5) {
        Place::Face
    } else if d == 2 || part >= libm::pow(face, 2.5) {
        Place::Edge
    } else {
        Place::Corner
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_of_three_spacings_has_its_places() {
        // whole families, and those of the outermost points of a block: 122, 75, 46, 28 of 122
        for (size, expected) in [
            (122.0, Place::Bulk),
            (121.0, Place::Bulk),
            (100.0, Place::Face),
            (75.0, Place::Face),
            (46.0, Place::Edge),
            (28.0, Place::Corner),
        ] {
            assert_eq!(place(3, 3.0, size / 122.0), expected, "{size}");
        }
        assert_eq!(place(2, 3.0, 17.0 / 28.0), Place::Face);
        assert_eq!(place(2, 3.0, 10.0 / 28.0), Place::Edge);
        assert_eq!(place(1, 3.0, 0.5), Place::Face);
    }

    /// Atoms of a diamond crystal with four neighbours each: periodic all are bulk; of a slab those of the outer layers are not.
    #[test]
    fn crystals_with_a_basis_have_full_families() {
        use peridyne::law::potential::lennard_jones::LennardJones;
        use peridyne::run::{Options, build};
        use peridyne::spec::*;
        for kind in [LatticeKind::Diamond, LatticeKind::Bcc, LatticeKind::Fcc] {
            let cells = 3;
            let mut quarters = vec![];
            for n in 0..cells * cells * cells {
                let cell = [n % cells, n / cells % cells, n / cells / cells];
                for b in kind.basis() {
                    quarters.push(std::array::from_fn(|a| 4 * cell[a] + b[a]));
                }
            }
            let body = BodySpec::Sites {
                kind,
                spacing: 1.0,
                origin: [0.0; 3],
                quarters,
                volume: None,
            };
            let lj = LennardJones {
                epsilon: 1.0,
                sigma: kind.nearest(),
            };
            // nearest neighbours alone
            let end = 1.05 * kind.nearest();
            let law = LawSpec::Atoms(PotentialSpec::of(lj).ended(end, End::Truncated));
            let mut spec = Spec::new(3, body, 1.0, law);
            spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
            spec.run.schedule.force_unstable = true;
            for periodic in [true, false] {
                spec.space.periodic = [Some(f64::from(cells)), Some(f64::from(cells)), None];
                spec.space.periodic[2] = periodic.then_some(f64::from(cells));
                let mut sim = build(&spec, Options::default()).unwrap();
                let found = patch_test(sim.as_mut(), Some((kind, 1.0)));
                let bulk = found.classes.iter().filter(|c| c.place == Place::Bulk);
                let (mut points, mut part) = (0, 0.0f64);
                for c in bulk {
                    points += c.points;
                    part = part.max((c.part - 1.0).abs());
                }
                let total = sim.info().points as usize;
                assert_eq!(points == total, periodic, "{kind:?}: {points} of {total}");
                assert!(
                    points > total / 2 && part < 1e-9,
                    "{kind:?}: {points} {part}"
                );
            }
        }
    }

    /// Of a compressed crystal of pairs, both ways.
    #[test]
    fn differences_say_what_bonds_say() {
        use peridyne::law::potential::lennard_jones::LennardJones;
        use peridyne::run::{Options, build};
        use peridyne::spec::*;
        let (edge, cells) = (1.5, 4);
        let mut quarters = vec![];
        for n in 0..64 {
            for b in LatticeKind::Fcc.basis() {
                let cell = [n % cells, n / cells % cells, n / cells / cells];
                quarters.push(std::array::from_fn(|a| 4 * cell[a] + b[a]));
            }
        }
        let body = BodySpec::Sites {
            kind: LatticeKind::Fcc,
            spacing: edge,
            origin: [0.0; 3],
            quarters,
            volume: None,
        };
        let lj = LennardJones {
            epsilon: 1.0,
            sigma: 1.0,
        };
        let law = LawSpec::Atoms(PotentialSpec::of(lj).ended(2.5, End::Truncated));
        let mut spec = Spec::new(3, body, 1.0, law);
        spec.space.periodic = [Some(edge * f64::from(cells)); 3];
        spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
        spec.run.schedule.force_unstable = true;
        let mut sim = build(&spec, Options::default()).unwrap();
        let info = sim.info().clone();
        let mut found = classes(sim.as_mut(), &info, None);
        let exact = of_atoms::<3>(sim.as_mut(), &found).unwrap();
        by_differences(sim.as_ref(), &mut found);
        for (class, exact) in found.classes.iter().zip(&exact) {
            // far from rest, so that stress counts
            assert!(exact.c[0][0] > 100.0);
            for i in 0..6 {
                for j in 0..6 {
                    let found = class.stiffness.as_ref().unwrap();
                    let off = (found.c[i][j] - exact.c[i][j]).abs();
                    assert!(off < 1e-5 * exact.c[0][0], "{i} {j}: {off}");
                }
            }
        }
    }

    #[test]
    fn voigt_components_are_engineering_strains() {
        let e = tensor(3, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(e, [[1.0, 3.0, 2.5], [3.0, 2.0, 2.0], [2.5, 2.0, 3.0]]);
        assert_eq!(tensor(2, [1.0, 2.0, 6.0, 0.0, 0.0, 0.0])[0][1], 3.0);
    }
}
