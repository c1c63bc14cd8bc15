//! What an interaction is made of, apart from the body: laws with their constants, weights, toughness.

use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::horizon::HorizonList;
use crate::family::links::Links;
use crate::family::stencil::Stencil;
use crate::family::volume_fraction;
use crate::interaction::atoms::current::CurrentAtoms;
use crate::interaction::atoms::fixed::FixedAtoms;
use crate::interaction::linear::LinearInteraction;
use crate::interaction::list::{ListInteraction, ListParts};
use crate::interaction::micromoduli::MicromoduliInteraction;
use crate::interaction::pairs::{BondConstants, BondTable};
use crate::interaction::stencil::{StencilInteraction, StencilParts};
use crate::interaction::weight::BondWeight;
use crate::interaction::{Interaction, PairTable, PointConstants, Repulsion, Toughness};
use crate::law::influence::influence;
use crate::law::micromodulus::{self, Moments, micromodulus};
use crate::law::potential::{Potential, PotentialSpec, Visitor};
use crate::law::solid::bond_based::{BondBased, BondBasedMixed};
use crate::law::solid::eam_like::{EamLike, Solid};
use crate::spec::{
    Calibration, ContactStiffness, Criterion, Influence, LawSpec, MaterialSpec, PmbStiffness, Spec,
};
use crate::statics::AnyLinearBody;
use std::sync::Arc;

/// Constants of all materials.
#[derive(Debug, Clone)]
pub(super) enum Laws {
    Bond(Vec<f64>),
    Solid(Vec<Solid>),
    /// Micromodulus of linear springs.
    Springs(f64),
    Atoms(PotentialSpec),
    /// Of the points in order of their ids.
    Micromoduli(Arc<AnyLinearBody>),
}

pub(super) struct Recipe {
    pub laws: Laws,
    pub toughness: Vec<Toughness>,
    pub repulsion: Option<Repulsion>,
    /// Stiffness of contact between points of a material, from its law (force / volume² / length).
    pub contact: Vec<f64>,
    pub stencil: Option<Stencil>,
    pub horizon: f64,
    /// Distance over which the horizon cuts cells.
    pub spacing: f64,
    pub influence: Influence,
    pub scaling: bool,
    /// Was the horizon given in spacings?
    pub ratio: bool,
    pub rule: crate::spec::InterfaceRule,
    /// Constants of pairs of materials, where they do not follow from the two.
    pub pairs: Option<Arc<BondTable>>,
    pub simd: Simd,
}

/// The recipes of all bodies.
pub(super) struct Recipes {
    /// First slot, places of the materials in the spec, recipe.
    of: Vec<(usize, Vec<usize>, Recipe)>,
}

impl Recipes {
    /// Of a single body.
    pub fn one(recipe: Recipe) -> Recipes {
        Recipes {
            of: vec![(0, (0..recipe.contact.len()).collect(), recipe)],
        }
    }

    /// `(first slot, places of its materials in the spec, recipe)` of each body, in order.
    pub fn several(of: Vec<(usize, Vec<usize>, Recipe)>) -> Recipes {
        Recipes { of }
    }

    pub fn first(&self) -> &Recipe {
        &self.of[0].2
    }

    pub fn all(&self) -> impl Iterator<Item = &Recipe> {
        self.of.iter().map(|(_, _, r)| r)
    }

    /// The recipe of the body that a slot belongs to, and the first slot of that.
    pub fn at(&self, slot: usize) -> (&Recipe, usize) {
        let n = self.of.partition_point(|(first, _, _)| *first <= slot) - 1;
        (&self.of[n].2, self.of[n].0)
    }

    pub fn forget_stencils(&mut self) {
        self.of.iter_mut().for_each(|(_, _, r)| r.stencil = None);
    }

    /// A number per material of the spec, from the first body that is made of it.
    fn per_material(&self, count: usize, of: impl Fn(&Recipe) -> Vec<f64>) -> Vec<f64> {
        let mut all = vec![None; count];
        for (_, materials, recipe) in &self.of {
            for (m, x) in materials.iter().zip(of(recipe)) {
                all[*m].get_or_insert(x);
            }
        }
        all.into_iter().flatten().collect()
    }

    /// Micromoduli of bond-based materials.
    pub fn micromoduli(&self, count: usize) -> Vec<f64> {
        self.per_material(count, |r| match &r.laws {
            Laws::Bond(c) => c.clone(),
            Laws::Solid(_) | Laws::Springs(_) | Laws::Atoms(_) | Laws::Micromoduli(_) => vec![],
        })
    }

    pub fn critical_stretches(&self, count: usize) -> Vec<f64> {
        self.per_material(count, |r| r.toughness.iter().map(|t| t.s00).collect())
    }
}

impl Recipe {
    /// Constants from a spec; `discrete` are the sums over a bulk family of this body.
    pub fn new<const D: usize>(
        spec: &Spec,
        stencil: Option<Stencil>,
        horizon: f64,
        spacing: f64,
        discrete: Moments,
        simd: Simd,
    ) -> Result<Recipe, BuildError> {
        let continuum = Moments::continuum(D, horizon, spec.section, spec.influence);
        let moments = match spec.calibration {
            Calibration::Continuum => continuum,
            Calibration::Discrete => discrete,
        };
        let at = |n: usize, key: &str| format!("materials[{n}].{key}");
        let mut bond = vec![];
        let mut solid = vec![];
        let mut springs = vec![];
        let mut atoms = vec![];
        let mut given = None;
        let mut repulsive = vec![];
        for (n, m) in spec.materials.iter().enumerate() {
            solid.extend(Solid::of_law(D, spec.plane, m.law));
            if !(m.density > 0.0 && m.density.is_finite()) {
                return Err(BuildError::new(
                    at(n, "density"),
                    format!("density is {}, expected a positive number", m.density),
                ));
            }
            let c = |stiffness| micromodulus(D, spec.plane, stiffness, moments);
            let plain = matches!(
                m.law,
                LawSpec::Springs(_) | LawSpec::Atoms | LawSpec::Micromoduli
            );
            if plain
                && (m.fracture.is_some() || spec.contact.is_some() || !spec.precracks.is_empty())
            {
                return Err(BuildError::new(
                    at(n, "law"),
                    "springs, micromoduli and potentials have no bonds that break and no contact of their own",
                )
                .help("remove fracture, contact and pre-cracks, or take pmb or lps"));
            }
            let hard = |stiffness| micromodulus(D, spec.plane, stiffness, continuum);
            let (value, contact) = match m.law {
                LawSpec::Pmb(stiffness) => {
                    bond.push(c(stiffness));
                    (c(stiffness), c(stiffness))
                }
                LawSpec::Lps(moduli) => {
                    let k = if D == 1 { moduli.young } else { moduli.bulk() };
                    (moduli.shear().min(k), hard(PmbStiffness::Bulk(k)))
                }
                LawSpec::LpsAsTyped { bulk, shear } => (
                    shear.min(bulk),
                    18.0 * bulk / (std::f64::consts::PI * horizon.powi(4)),
                ),
                LawSpec::EamLike { pair, volume } => (
                    pair,
                    hard(PmbStiffness::Bulk((3.0 * volume + 0.5 * pair) / 9.0)),
                ),
                LawSpec::Springs(stiffness) => {
                    springs.push(c(stiffness));
                    (c(stiffness), 0.0)
                }
                LawSpec::Atoms => {
                    let Some(potential) = &spec.potential else {
                        return Err(BuildError::new(at(n, "law"), "the spec has no potential"));
                    };
                    atoms.push(potential.clone());
                    (1.0, 0.0)
                }
                LawSpec::Micromoduli => {
                    let Some(body) = &spec.micromoduli else {
                        return Err(BuildError::new(at(n, "law"), "the spec has no micromoduli"));
                    };
                    given = Some(body.clone());
                    (1.0, 0.0)
                }
            };
            if !(value > 0.0 && value.is_finite()) {
                return Err(
                    BuildError::new(at(n, "law"), "stiffness must be positive and finite")
                        .help("check the moduli: K > 0, G > 0, −1 < ν < ½"),
                );
            }
            repulsive.push(15.0 * contact / horizon);
        }
        let kinds = [
            &bond.is_empty(),
            &solid.is_empty(),
            &springs.is_empty(),
            &atoms.is_empty(),
            &given.is_none(),
        ];
        match kinds.iter().filter(|none| !**none).count() {
            0 => return Err(BuildError::new("materials", "the body has no material")),
            1 => {}
            _ => {
                return Err(BuildError::new(
                    "materials",
                    "different kinds of law in one body, such as bond-based and state-based",
                )
                .help("give all materials the same kind of law: bonds across need one"));
            }
        }
        if springs.iter().any(|c| *c != springs[0]) {
            return Err(
                BuildError::new("materials", "springs of unlike stiffness in one body")
                    .help("give all materials the same springs"),
            );
        }
        let laws = if let Some(potential) = atoms.pop() {
            Laws::Atoms(potential)
        } else if let Some(body) = given {
            Laws::Micromoduli(body)
        } else if let Some(c) = springs.pop() {
            Laws::Springs(c)
        } else if solid.is_empty() {
            Laws::Bond(bond)
        } else {
            Laws::Solid(solid)
        };
        let toughness = spec
            .materials
            .iter()
            .enumerate()
            .map(|(n, m)| toughness::<D>(spec, m, moments, &at(n, "fracture")))
            .collect::<Result<Vec<_>, _>>()?;
        let repulsion = match &spec.contact {
            Some(contact) => Some(Repulsion {
                stiffness: contact_stiffness(&contact.stiffness, &repulsive)?,
                bonded: contact.bonded,
                range: PairTable::uniform(contact.free * spacing),
            }),
            None => None,
        };
        let pairs = bond_table(spec, &laws, horizon, spacing)?.map(Arc::new);
        Ok(Recipe {
            laws,
            toughness,
            repulsion,
            contact: repulsive,
            stencil,
            horizon,
            spacing,
            influence: spec.influence,
            scaling: spec.volume_scaling,
            ratio: matches!(spec.horizon, crate::spec::Horizon::Ratio(_)),
            rule: spec.interface,
            pairs,
            simd,
        })
    }

    /// `ω ν` of a bond of length r0.
    pub fn weight(&self, r0: f64) -> f64 {
        let nu = if self.scaling {
            volume_fraction(r0, self.horizon, self.spacing)
        } else {
            1.0
        };
        nu * influence(self.influence, r0, self.horizon)
    }

    /// The interaction on `body`; `only` makes everything of one material.
    pub fn interaction<const D: usize>(
        &self,
        body: &Body<D>,
        only: Option<usize>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let pick = |n: usize| only.is_none_or(|o| o == n);
        let toughness: Vec<Toughness> = self
            .toughness
            .iter()
            .enumerate()
            .filter(|(n, _)| pick(*n))
            .map(|(_, t)| *t)
            .collect();
        if let (Some(pairs), None) = (&self.pairs, only) {
            return self.interaction_of_pairs(body, pairs, toughness);
        }
        let repulsion = match (&self.repulsion, only) {
            (Some(all), Some(n)) => Some(all.only(n)),
            (all, _) => all.clone(),
        };
        match &self.laws {
            Laws::Springs(c) => {
                let links = self.links(body)?;
                let volume = body.volume.uniform().unwrap_or(1.0);
                let modulus = |xi: [f64; D]| {
                    let r0 = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let k = c * self.weight(r0) * volume / (r0 * r0 * r0);
                    std::array::from_fn(|a| std::array::from_fn(|b| k * xi[a] * xi[b]))
                };
                Ok(Box::new(LinearInteraction::new(links, self.simd, modulus)))
            }
            Laws::Micromoduli(linear) => {
                let Some(linear) = (**linear).clone().of::<D>() else {
                    let found = linear.dimension();
                    return Err(BuildError::new(
                        "micromoduli",
                        format!("the micromoduli are those of a {found}-D body, this one has {D}"),
                    ));
                };
                if linear.points() != body.points() {
                    return Err(BuildError::new(
                        "micromoduli",
                        format!(
                            "there are micromoduli of {} points, the body has {}",
                            linear.points(),
                            body.points()
                        ),
                    ));
                }
                Ok(Box::new(MicromoduliInteraction::new(
                    body, &linear, self.simd,
                )))
            }
            Laws::Atoms(potential) => match (&body.layout, &self.stencil) {
                (Layout::Grid(_), Some(_)) => {
                    let links = self.links(body)?;
                    Ok(potential.apply(Fixed {
                        body,
                        links,
                        simd: self.simd,
                    }))
                }
                _ => Ok(potential.apply(Current {
                    body,
                    simd: self.simd,
                })),
            },
            Laws::Bond(c) => {
                let c: Vec<f64> = c
                    .iter()
                    .enumerate()
                    .filter(|(n, _)| pick(*n))
                    .map(|(_, c)| *c)
                    .collect();
                if c.iter().all(|x| *x == c[0]) {
                    let law = BondBased { c: c[0] };
                    self.bind(body, law, PointConstants::None, toughness, repulsion)
                } else {
                    self.bind(
                        body,
                        BondBasedMixed { rule: self.rule },
                        PointConstants::PerMaterial(c),
                        toughness,
                        repulsion,
                    )
                }
            }
            Laws::Solid(s) => {
                let s: Vec<Solid> = s
                    .iter()
                    .enumerate()
                    .filter(|(n, _)| pick(*n))
                    .map(|(_, s)| *s)
                    .collect();
                self.bind(
                    body,
                    EamLike {
                        ratio: s[0].ratio(),
                    },
                    PointConstants::Solid(s),
                    toughness,
                    repulsion,
                )
            }
        }
    }

    fn links<const D: usize>(&self, body: &Body<D>) -> Result<Links<D>, BuildError> {
        match (&body.layout, &self.stencil) {
            (Layout::Grid(grid), Some(stencil)) => Ok(Links::new(body, grid, stencil)),
            _ => Err(BuildError::new(
                "family",
                "springs live on a lattice, this is a cloud of points",
            )
            .help("take a lattice body, or the law pmb")),
        }
    }

    fn bind<const D: usize, W: crate::law::Law>(
        &self,
        body: &Body<D>,
        law: W,
        point_constants: PointConstants,
        toughness: Vec<Toughness>,
        repulsion: Option<Repulsion>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        match (&body.layout, &self.stencil) {
            (Layout::Grid(grid), Some(stencil)) => {
                Ok(Box::new(StencilInteraction::new(StencilParts {
                    body,
                    grid,
                    stencil,
                    law,
                    weight: &|r0| self.weight(r0),
                    point_constants,
                    toughness,
                    repulsion,
                    simd: self.simd,
                })))
            }
            _ => {
                let scaling = self.scaling.then_some(self.spacing);
                // whole multiples of the spacing are meant inclusively
                let reach = if self.ratio {
                    self.horizon * (1.0 + 1e-9)
                } else {
                    self.horizon
                };
                Ok(Box::new(ListInteraction::new(ListParts {
                    body,
                    list: HorizonList::new(body, reach)?,
                    law,
                    weight: BondWeight::new(self.influence, self.horizon, scaling),
                    point_constants,
                    toughness,
                    repulsion,
                    simd: self.simd,
                })))
            }
        }
    }

    /// Laws of unit constants, with what pairs of materials have.
    fn interaction_of_pairs<const D: usize>(
        &self,
        body: &Body<D>,
        pairs: &Arc<BondTable>,
        toughness: Vec<Toughness>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        match &self.laws {
            Laws::Solid(solids) => {
                let unit = Solid {
                    kappa: 1.0,
                    beta: 1.0,
                    ..solids[0]
                };
                let law = EamLike {
                    ratio: unit.ratio(),
                };
                let constants = PointConstants::Solid(vec![unit; solids.len()]);
                self.list_of_pairs(body, pairs, law, constants, toughness)
            }
            Laws::Bond(_) => self.list_of_pairs(
                body,
                pairs,
                BondBased { c: 1.0 },
                PointConstants::None,
                toughness,
            ),
            Laws::Springs(_) | Laws::Atoms(_) | Laws::Micromoduli(_) => Err(BuildError::new(
                "pairs",
                "springs, potentials and micromoduli have no constants of pairs of materials",
            )),
        }
    }

    fn list_of_pairs<const D: usize, W: crate::law::Law>(
        &self,
        body: &Body<D>,
        pairs: &Arc<BondTable>,
        law: W,
        point_constants: PointConstants,
        toughness: Vec<Toughness>,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        let horizon = |i: usize, j: usize| {
            let pair = pairs.get(body.material_of(i), body.material_of(j));
            pair.horizon
        };
        let scaling = self.scaling.then_some(self.spacing);
        let parts = ListParts {
            body,
            list: HorizonList::within(body, self.horizon, horizon)?,
            law,
            weight: BondWeight::new(self.influence, self.horizon, scaling),
            point_constants,
            toughness,
            repulsion: self.repulsion.clone(),
            simd: self.simd,
        };
        Ok(Box::new(ListInteraction::of_pairs(parts, pairs.clone())))
    }
}

/// What pairs of materials have, checked.
fn bond_table(
    spec: &Spec,
    laws: &Laws,
    horizon: f64,
    spacing: f64,
) -> Result<Option<BondTable>, BuildError> {
    let materials = spec.materials.len();
    if spec.pairs.is_empty() {
        return Ok(None);
    }
    let error = |message: String| Err(BuildError::new("pairs", message));
    if spec.pairs.len() != materials * materials {
        return error(format!(
            "{} pairs of {materials} materials, expected {}",
            spec.pairs.len(),
            materials * materials
        ));
    }
    if !matches!(spec.influence, Influence::Constant | Influence::Inverse) {
        return error(
            "an influence function that ends at the horizon, with horizons of pairs".into(),
        );
    }
    let mut pairs = vec![];
    for (n, p) in spec.pairs.iter().enumerate() {
        let (of, with) = (n / materials, n % materials);
        let (stiffness, volume) = match (laws, p.law) {
            (Laws::Bond(_), LawSpec::Pmb(PmbStiffness::Micromodulus(c))) => (c, 0.0),
            (Laws::Solid(_), law @ LawSpec::LpsAsTyped { .. }) => {
                let Some(solid) = Solid::of_law(spec.dimension, spec.plane, law) else {
                    return error("a law that is no solid".into());
                };
                (solid.beta, solid.kappa)
            }
            _ => {
                return error(
                    "pairs have a micromodulus (pmb) or moduli as typed (lps), of the law of the materials"
                        .into(),
                );
            }
        };
        let mirrored = &spec.pairs[with * materials + of];
        let fine = |x: f64| x >= 0.0 && x.is_finite();
        if !fine(stiffness) || !fine(p.horizon) || p.horizon > horizon * (1.0 + 1e-9) {
            return error(format!(
                "materials {of} and {with} have the stiffness {stiffness:e} and the horizon {:e}; that of the body is {horizon:e}",
                p.horizon
            ));
        }
        if p.horizon != mirrored.horizon {
            return error(format!(
                "materials {of} and {with} must have the same horizon both ways round"
            ));
        }
        pairs.push(BondConstants {
            horizon: p.horizon,
            stiffness,
            volume,
            toughness: Toughness {
                s00: p.critical_stretch,
                alpha: p.alpha,
            },
        });
    }
    let scaling = spec.volume_scaling.then_some(spacing);
    Ok(Some(BondTable::new(materials, pairs, scaling)))
}

/// Makes a potential an interaction on fixed lattice neighbours.
struct Fixed<'a, const D: usize> {
    body: &'a Body<D>,
    links: Links<D>,
    simd: Simd,
}

impl<const D: usize> Visitor for Fixed<'_, D> {
    type Out = Box<dyn Interaction<D>>;
    fn visit<P: Potential>(self, potential: P) -> Self::Out {
        Box::new(FixedAtoms::new(self.body, self.links, potential, self.simd))
    }
}

/// Makes a potential an interaction on current neighbours.
struct Current<'a, const D: usize> {
    body: &'a Body<D>,
    simd: Simd,
}

impl<const D: usize> Visitor for Current<'_, D> {
    type Out = Box<dyn Interaction<D>>;
    fn visit<P: Potential>(self, potential: P) -> Self::Out {
        Box::new(CurrentAtoms::new(self.body, potential, self.simd))
    }
}

/// The table of all pairs of materials, whose own stiffnesses are `own`.
pub(super) fn contact_stiffness(
    asked: &ContactStiffness,
    own: &[f64],
) -> Result<PairTable, BuildError> {
    let table = match asked {
        ContactStiffness::Same(stiffness) => PairTable::uniform(*stiffness),
        ContactStiffness::Laws => PairTable::new(own.len(), |a, b| {
            // two in series; alike ones exactly their own
            if own[a] == own[b] {
                own[a]
            } else {
                2.0 * own[a] * own[b] / (own[a] + own[b])
            }
        }),
        ContactStiffness::Pairs(rows) => {
            let fits = rows.len() == own.len() && rows.iter().all(|r| r.len() == own.len());
            let symmetric = || (0..rows.len()).all(|a| (0..a).all(|b| rows[a][b] == rows[b][a]));
            if !fits || !symmetric() {
                return Err(BuildError::new(
                    "contact.stiffness",
                    format!(
                        "expected a symmetric table of {0} by {0} numbers, one for every pair of materials",
                        own.len()
                    ),
                ));
            }
            PairTable::new(own.len(), |a, b| rows[a][b])
        }
    };
    Ok(table)
}

fn toughness<const D: usize>(
    spec: &Spec,
    m: &MaterialSpec,
    moments: Moments,
    path: &str,
) -> Result<Toughness, BuildError> {
    let Some(fracture) = m.fracture else {
        return Ok(Toughness {
            s00: f64::INFINITY,
            alpha: 0.0,
        });
    };
    let s00 = match fracture.criterion {
        Criterion::Stretch(s) => s,
        Criterion::Energy(energy) => {
            // the bond-based constant of the same bulk; for state-based solids of the same K
            let stiffness = match m.law {
                LawSpec::Pmb(s) => s,
                LawSpec::Lps(m) if D == 1 => PmbStiffness::Young(m.young),
                LawSpec::Lps(m) => {
                    return lps_toughness::<D>(spec, m, energy, fracture.alpha, path);
                }
                LawSpec::LpsAsTyped { .. }
                | LawSpec::EamLike { .. }
                | LawSpec::Springs(_)
                | LawSpec::Atoms
                | LawSpec::Micromoduli => {
                    return Err(BuildError::new(
                        path,
                        "a fracture energy is known for pmb and lps materials only",
                    )
                    .help("give critical_stretch instead"));
                }
            };
            let c = micromodulus(D, spec.plane, stiffness, moments);
            micromodulus::critical_stretch(D, energy, c, moments)
        }
    };
    if !(s00 > 0.0) || !(fracture.alpha >= 0.0) {
        return Err(BuildError::new(
            path,
            format!(
                "critical stretch {s00} and alpha {} must be positive",
                fracture.alpha
            ),
        ));
    }
    Ok(Toughness {
        s00,
        alpha: fracture.alpha,
    })
}

/// Critical stretch of LPS from a fracture energy: Madenci & Oterkus 2014 (6.19) in 3-D,
/// `s0² = G0 / ((3G + (3/4)⁴ (K − 5G/3)) δ)`, and (6.20) in 2-D, `s0² = G0 / ((6G/π + 16 (K₂ − 2G)/(9π²)) δ)`.
fn lps_toughness<const D: usize>(
    spec: &Spec,
    m: crate::spec::Moduli,
    energy: f64,
    alpha: f64,
    path: &str,
) -> Result<Toughness, BuildError> {
    let horizon = match spec.horizon {
        crate::spec::Horizon::Length(d) => d,
        crate::spec::Horizon::Ratio(r) => r as f64 * spec.body.spacing().unwrap_or(1.0),
    };
    let (k, g) = (m.bulk(), m.shear());
    let stiffness = if D == 3 {
        3.0 * g + 0.75f64.powi(4) * (k - 5.0 * g / 3.0)
    } else {
        let l = m.lame();
        let plane = match spec.plane {
            crate::spec::Plane::Strain => l + g,
            crate::spec::Plane::Stress => 2.0 * l * g / (l + 2.0 * g) + g,
        };
        6.0 * g / std::f64::consts::PI
            + 16.0 * (plane - 2.0 * g) / (9.0 * std::f64::consts::PI.powi(2))
    };
    let s00 = (energy / (stiffness * horizon)).sqrt();
    if !(s00 > 0.0) {
        return Err(BuildError::new(
            path,
            format!("a fracture energy of {energy} gives no critical stretch"),
        ));
    }
    Ok(Toughness { s00, alpha })
}
