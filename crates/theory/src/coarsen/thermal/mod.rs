//! Level 0 of atoms at a temperature: force constants of the free energy, from the frames of a run (silling2010, section 7;
//! sandia2010, chapter 1).
//!
//! What stands for moving atoms is how their mean places answer small forces. In the canonical ensemble that is `K = k_B T ⟨u ⊗ u⟩⁻¹`, u from
//! the mean places (Campañá & Müser 2006), and as `⟨F ⊗ u⟩ = −k_B T 1` there (equipartition), `K = −⟨F ⊗ u⟩ ⟨u ⊗ u⟩⁻¹`: the least-squares
//! fit of forces to displacements (Hellman, Abrikosov & Simak 2011), which needs fewer frames, and no temperature. The mean of Hessians is not it: that is
//! Born's term alone, and too stiff by what atoms yield beyond the mean strain.
//!
//! The fit is over bonds within a radius, `F_i = Σ_j K_ij (u_j − u_i)` (the sum rule is in the form), one block for all bonds between atoms
//! with the same surroundings, `K_ji = K_ijᵀ`, `Σ_j K_ij` symmetric; where all atoms are alike, with the point group of their lattice. Small displacements give the Hessian if the radius holds all
//! of it.
//!
//! `C` follows from the blocks as they answer long waves (`Stiffness::of_waves`): isothermal, of stress against strain under the stress of
//! the frames. Errors are those of blocks of frames (Σ over blocks of what their residuals say, White 1980).

mod alike;
mod constants;
mod error;
mod fit;
#[cfg(test)]
pub(crate) mod tests;

pub use error::ThermalError;

use super::block::{Block, scaled};
use super::check::affine;
use crate::elastic_constants::Cubic;
use crate::voigt::{Stiffness, axes, components};
use alike::Alike;
pub use constants::CONSTANTS_LIMIT;
use constants::Constants;
use fit::{Centred, fit};
use peridyne::spec::LinearBody;

/// Equations for each constant at least.
const EQUATIONS: usize = 2;
/// Blocks of frames that errors are taken from, and fewest frames of one.
const BLOCKS: usize = 20;
const BLOCK: usize = 2;
/// Fewest blocks that say something of an error.
const ENOUGH: usize = 5;

/// What atoms did. All frames are of the same box.
#[derive(Debug, Clone, Copy)]
pub struct Frames<'a, const D: usize> {
    /// Sites, volumes, densities, periods; micromoduli are not read.
    pub sites: &'a LinearBody<D>,
    /// `[N]` of which material each atom is.
    pub kind: &'a [u32],
    /// `[F][N]` from the sites (length), without what the body drifts as a whole.
    pub displacement: &'a [Vec<[f64; D]>],
    /// `[F][N]` forces of the potential there (force).
    pub force: &'a [Vec<[f64; D]>],
    /// Mean of Σ over pairs of distance ⊗ force, positive where pairs repel (energy); `None`: the stress is taken to be a pressure, which elastic constants of
    /// cubic crystals do not depend on.
    pub virial: Option<[[f64; D]; D]>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Of the bonds (length), closed. All of the potential's range: its cut-off, of embedded atoms twice. Motion couples atoms further apart, mostly in pressure: without a quarter
    /// more C12 of a crystal at a third of its melting temperature is some percent too stiff.
    pub radius: f64,
    /// Use the point group of a lattice whose atoms are all alike?
    pub symmetry: bool,
}

/// Elastic constants, isothermal, stress against strain (energy / volume).
#[derive(Debug, Clone, PartialEq)]
pub struct Elastic {
    pub stiffness: Stiffness,
    /// Standard errors; `None`: too few frames.
    pub error: Option<[[f64; 6]; 6]>,
    /// Where the crystal is square or cubic.
    pub cubic: Option<Cubic>,
    /// Mean stress (energy / volume), where the virial was given.
    pub stress: Option<Vec<f64>>,
}

/// A linear body made of frames, and what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Thermal<const D: usize> {
    /// About the mean places.
    pub body: LinearBody<D>,
    /// `[N]` mean displacements from the sites (length): of atoms that are alike the same, their sum 0.
    pub moved: Vec<[f64; D]>,
    pub frames: usize,
    /// Kinds of surroundings.
    pub classes: usize,
    /// Constants that were fitted.
    pub constants: usize,
    /// Rotations and reflections that were used.
    pub symmetries: usize,
    /// Root mean square of the forces that displacements do not explain, over that of the forces: 0 for small motions.
    pub residual: f64,
    /// `k_B T = −⟨F·u⟩` per degree of freedom (energy).
    pub temperature: f64,
    /// Or why there are none.
    pub elastic: Result<Elastic, &'static str>,
}

/// The linear body of frames.
///
/// # Errors
/// [`ThermalError`]: no bonds, a radius that the box does not hold, too few frames, too many constants.
pub fn thermal<const D: usize>(
    frames: &Frames<D>,
    options: &Options,
) -> Result<Thermal<D>, ThermalError> {
    let sites = frames.sites;
    let (n, count) = (sites.points(), frames.force.len());
    let whole = |all: &[Vec<[f64; D]>]| {
        all.len() == count
            && all.iter().all(|f| f.len() == n)
            && all.iter().flatten().flatten().all(|x| x.is_finite())
    };
    if !whole(frames.displacement) || !whole(frames.force) || frames.kind.len() != n {
        return Err(ThermalError::Frames);
    }
    let radius = options.radius;
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(ThermalError::Radius(radius));
    }
    let shortest = sites.period.iter().flatten().copied();
    let period = shortest.fold(f64::INFINITY, f64::min);
    if radius > 0.5 * period * (1.0 - 1e-6) {
        return Err(ThermalError::Box { radius, period });
    }
    let alike = Alike::new(&sites.position, frames.kind, sites.period, radius);
    let alike = alike.ok_or(ThermalError::Alone { radius })?;
    let constants = Constants::new(&alike, options.symmetry);
    enough(&alike, &constants, count)?;
    let (centred, mean) = Centred::new(frames.displacement, frames.force);
    let blocks = (count / BLOCK).clamp(1, BLOCKS);
    let found = fit(&alike, &constants, &centred, blocks).ok_or(ThermalError::Singular)?;
    let moved = moved(&alike, &mean);
    let body = body(sites, &alike, &constants.blocks(&found.constants), &moved);
    let work: f64 = (centred.force.iter().flatten())
        .zip(centred.displacement.iter().flatten())
        .map(|(f, u)| (0..D).map(|a| f[a] * u[a]).sum::<f64>())
        .sum();
    // the means take one frame, the sum rule one atom
    let temperature = -work / ((D * (n - 1)) as f64 * (count - 1) as f64);
    let elastic = match (alike.members.len(), sites.period.contains(&None)) {
        (1, false) => Ok(elastic(
            frames,
            &alike,
            &constants,
            &found,
            temperature,
            &body,
        )),
        (1, true) => Err("the body is not periodic along all axes"),
        _ => Err(
            "its atoms do not all have the same surroundings, so that they do not just follow a strain",
        ),
    };
    Ok(Thermal {
        moved,
        frames: count,
        classes: alike.members.len(),
        constants: constants.count,
        symmetries: constants.group.len(),
        residual: found.residual,
        temperature,
        elastic,
        body,
    })
}

/// Do the frames have equations for the constants, class by class?
fn enough<const D: usize>(
    alike: &Alike<D>,
    constants: &Constants<D>,
    frames: usize,
) -> Result<(), ThermalError> {
    if constants.count > CONSTANTS_LIMIT {
        return Err(ThermalError::Many {
            constants: constants.count,
            classes: alike.members.len(),
        });
    }
    let mut needed = 2;
    for (class, atoms) in alike.members.iter().enumerate() {
        let own = alike.kinds.iter().zip(&constants.of);
        let own = own.filter(|(k, _)| k.from as usize == class);
        let mut own: Vec<u32> = own.flat_map(|(_, of)| of.iter().map(|f| f.0)).collect();
        own.sort_unstable();
        own.dedup();
        // one frame goes into the means
        needed = needed.max(1 + (EQUATIONS * own.len()).div_ceil(D * atoms.len()));
    }
    match frames < needed {
        true => Err(ThermalError::Few { frames, needed }),
        false => Ok(()),
    }
}

/// Means over the atoms of a class, less the mean of all.
fn moved<const D: usize>(alike: &Alike<D>, mean: &[[f64; D]]) -> Vec<[f64; D]> {
    let over = |atoms: &mut dyn Iterator<Item = usize>| -> [f64; D] {
        let (mut sum, mut count) = ([0.0; D], 0.0);
        for i in atoms {
            (0..D).for_each(|a| sum[a] += mean[i][a]);
            count += 1.0;
        }
        sum.map(|s| s / count)
    };
    let mut moved = vec![[0.0; D]; mean.len()];
    if alike.members.len() == 1 {
        return moved;
    }
    let all = over(&mut (0..mean.len()));
    for atoms in &alike.members {
        let own = over(&mut atoms.iter().map(|i| *i as usize));
        for i in atoms {
            moved[*i as usize] = std::array::from_fn(|a| own[a] - all[a]);
        }
    }
    moved
}

/// The body whose bonds have these blocks (force / length), atoms at their mean places.
fn body<const D: usize>(
    sites: &LinearBody<D>,
    alike: &Alike<D>,
    blocks: &[Block<D>],
    moved: &[[f64; D]],
) -> LinearBody<D> {
    let place = |(x, u): (&[f64; D], &[f64; D])| std::array::from_fn(|a| x[a] + u[a]);
    let mut block = Vec::with_capacity(alike.partner.len());
    for i in 0..alike.atoms() {
        let each = alike.bonds(i);
        block.extend(each.map(|(_, k)| scaled(1.0 / sites.volume[i], &blocks[k])));
    }
    LinearBody {
        position: sites.position.iter().zip(moved).map(place).collect(),
        volume: sites.volume.clone(),
        density: sites.density.clone(),
        period: sites.period,
        start: alike.start.clone(),
        partner: alike.partner.clone(),
        block,
        load_map: None,
        mass: None,
    }
}

/// Elastic constants of a crystal of equal atoms that a linear body is, periodic along all axes: of stress against strain, under this stress (energy / volume).
pub fn constants_of<const D: usize>(body: &LinearBody<D>, stress: &Block<D>) -> Stiffness {
    let volume: f64 = body.volume.iter().sum();
    let all = affine(body).into_iter();
    let brackets: Vec<f64> = all.map(|x| x / (2.0 * volume)).collect();
    Stiffness::of_waves(&brackets, stress).under_stress(stress)
}

fn elastic<const D: usize>(
    frames: &Frames<D>,
    alike: &Alike<D>,
    constants: &Constants<D>,
    found: &fit::Fit,
    temperature: f64,
    made: &LinearBody<D>,
) -> Elastic {
    let volume: f64 = made.volume.iter().sum();
    let stress = frames.virial.map(|virial| {
        let kinetic = (made.points() - 1) as f64 * temperature;
        let each: Block<D> = std::array::from_fn(|a| {
            std::array::from_fn(|b| -(virial[a][b] + if a == b { kinetic } else { 0.0 }) / volume)
        });
        constants.mean(&each)
    });
    let none = [[0.0; D]; D];
    let stiffness = constants_of(made, &stress.unwrap_or(none));
    let blocks = found.changes.len();
    let still = vec![[0.0; D]; made.points()];
    let error = (blocks >= ENOUGH).then(|| {
        let mut sum = [[0.0; 6]; 6];
        for change in &found.changes {
            let change = body(frames.sites, alike, &constants.blocks(change), &still);
            let change = constants_of(&change, &none);
            for (s, c) in sum
                .as_flattened_mut()
                .iter_mut()
                .zip(change.c.as_flattened())
            {
                *s += c * c * blocks as f64 / (blocks - 1) as f64;
            }
        }
        sum.map(|row| row.map(f64::sqrt))
    });
    // without the point group equal up to their errors
    let tolerance = match constants.group.len() > 1 {
        true => 1e-6,
        false => 0.05,
    };
    Elastic {
        cubic: (D > 1).then(|| stiffness.cubic(tolerance)).flatten(),
        stiffness,
        error,
        stress: stress.map(|s| {
            let each = (0..components(D)).map(|v| axes(D, v));
            each.map(|(a, b)| s[a][b]).collect()
        }),
    }
}
