//! Materials: laws, moduli, fracture.

use super::atoms::AtomsPotentials;
use super::bodies;
use super::context::{Context, Result};
use crate::deck::document::{
    BreakageName, CriterionName, Document, Fatigue, Fracture, Law, Material,
};
use crate::deck::quantity::Positive;
use crate::deck::value::{At, Quantity};
use peridyne::law::solid::linear::{Linear, Micromoduli};
use peridyne::run::Registry;
use peridyne::spec::{
    BodySpec, Breakage, Cloud, Criterion, FatigueSpec, FractureSpec, LawSpec, MaterialSpec,
    Members, PieceSpec, RateSpec, SetSpec,
};
use std::collections::BTreeMap;

/// A material of atoms that names no set, where the others do, has the atoms that they leave: as a set of its name.
pub(super) fn what_is_left(
    document: &Document,
    potentials: &AtomsPotentials,
    sets: &mut Vec<SetSpec>,
) {
    let set_of = |name: &String| {
        let given = document.material[name].value.set.as_ref();
        let own = sets.iter().find(|s| s.name == *name).map(|s| &s.name);
        given.map(|set| &set.value).or(own).cloned()
    };
    let (named, without): (Vec<_>, Vec<_>) = potentials.keys().partition(|n| set_of(n).is_some());
    if let ([one], false) = (&without[..], named.is_empty()) {
        let others = named.into_iter().filter_map(set_of).collect();
        sets.push(SetSpec {
            name: one.to_string(),
            members: Members::Outside(others),
        });
    }
}

pub(super) fn materials(
    context: &Context,
    document: &Document,
    sets: &[SetSpec],
    body: &mut BodySpec,
    potentials: &AtomsPotentials,
) -> Result<Vec<MaterialSpec>> {
    let written = &document.material;
    let several = written.len() > 1;
    // bodies of a material that is on several: one entry each, at the end
    let mut others: Vec<MaterialSpec> = Vec::new();
    let point = point_volume(body, context.dimension);
    let mut users: BTreeMap<&String, Vec<String>> = written
        .keys()
        .map(|name| {
            let bodies = bodies::made_of(document, body, name);
            (name, bodies.map(str::to_string).collect())
        })
        .collect();
    let of_file = densities(context, written, body)?;
    let mut materials: Vec<MaterialSpec> = Vec::new();
    for (name, material) in written {
        let given = &material.value;
        let mut users = users.remove(name).unwrap_or_default().into_iter();
        let first_user = users.next();
        let set = match &given.set {
            Some(set) if first_user.is_some() => {
                let message = "a body names this material: it needs no set besides";
                return Err(context.error(&set.span, message));
            }
            Some(set) => context.known_set(set, sets)?,
            None if let Some(body) = first_user => body,
            // a mesh names its parts: the material of the same name belongs there
            None if several && sets.iter().any(|s| s.name == *name) => name.clone(),
            None if several => {
                let message = format!("the material \"{name}\" is one of several and needs `set`");
                return Err(context.error_with(
                    &material.span,
                    message,
                    "say which set is made of it: set = \"NAME\"",
                ));
            }
            None => "all".to_string(),
        };
        let potential = potentials.get(name);
        let law = match potential {
            Some(potential) => LawSpec::Atoms(potential.spec.clone()),
            None if given.law.value.name == Micromoduli::NAME
                && let Some(linear) = context.linear_bodies.get(&set) =>
            {
                LawSpec::Micromoduli(linear.clone())
            }
            None => law(context, &given.law)?,
        };
        // each of several bodies has one kind, which the engine sees to
        if let Some(first) = materials.first()
            && !bodies::several(document)
            && std::mem::discriminant(&first.law) != std::mem::discriminant(&law)
        {
            let message = format!(
                "the materials \"{}\" and \"{name}\" have different kinds of law",
                first.name
            );
            return Err(context.error_with(
                &given.law.span,
                message,
                "all materials of a body use the same kind of law",
            ));
        }
        let by_mass = |mass: f64| match point {
            Some(volume) => Ok(mass / volume),
            None => Err(context.error_with(
                &material.span,
                "the points of this body have different volumes: a mass gives no density",
                "give the density",
            )),
        };
        let density = match (&given.density, &of_file) {
            _ if let Some(mass) = &given.mass => {
                if let Some(density) = &given.density {
                    return Err(context.error(&density.span, "give one of density and mass"));
                }
                by_mass(context.value(mass)?)?
            }
            (None, None) if let Some(mass) = potential.and_then(|p| p.mass) => by_mass(mass)?,
            (Some(density), _) => context.value(density)?,
            (None, Some(cloud)) => mean_density(cloud, &set, sets),
            (None, None) => {
                let message = "the key `density` is missing";
                return Err(context.error_with(
                    &material.span,
                    message,
                    "write for example density = \"2200 kg/m^3\"",
                ));
            }
        };
        let made = MaterialSpec {
            name: name.clone(),
            set,
            density,
            law,
            fracture: given
                .fracture
                .as_ref()
                .map(|f| fracture(context, f))
                .transpose()?,
        };
        others.extend(users.map(|set| MaterialSpec {
            set,
            ..made.clone()
        }));
        materials.push(made);
    }
    materials.extend(others);
    Ok(materials)
}

/// The cloud whose densities are taken; those of the deck take their place in `body`.
fn densities<'b>(
    context: &Context,
    written: &BTreeMap<String, At<Material>>,
    body: &'b mut BodySpec,
) -> Result<Option<&'b Cloud>> {
    if let BodySpec::Several(pieces) = body {
        // where there are several bodies, materials have the densities
        for piece in pieces {
            if let BodySpec::Cloud(cloud) = &mut piece.body {
                cloud.density.clear();
            }
        }
        return Ok(None);
    }
    let BodySpec::Cloud(cloud) = body else {
        return Ok(None);
    };
    if cloud.density.is_empty() {
        return Ok(None);
    }
    let given = |m: &&At<Material>| m.value.density.is_some();
    match written.values().find(|m| !given(m)) {
        None => {
            cloud.density.clear();
            Ok(None)
        }
        Some(without) if written.values().any(|m| given(&m)) => Err(context.error_with(
            &without.span,
            "this material has no `density`, another has",
            "give every material a density, or none: then each point has that of the file",
        )),
        Some(_) => Ok(Some(cloud)),
    }
}

/// Of the points of a set given by a mark, else of all.
fn mean_density(cloud: &Cloud, set: &str, sets: &[SetSpec]) -> f64 {
    let only = sets.iter().find(|s| s.name == set).map(|s| &s.members);
    let points = (0..cloud.density.len()).filter(|i| match only {
        Some(Members::Mark(mark)) => cloud.mark.get(*i) == Some(mark),
        Some(Members::Points(ids)) => ids.binary_search(&(*i as u32)).is_ok(),
        _ => true,
    });
    let (sum, count) = points.fold((0.0, 0), |(s, n), i| (s + cloud.density[i], n + 1));
    // a mark that no point has is an error of its own, later
    if count == 0 {
        cloud.density[0]
    } else {
        sum / f64::from(count)
    }
}

pub(super) fn law(context: &Context, written: &At<Law>) -> Result<LawSpec> {
    let name = &*written.value.name;
    if Registry::standard().is_potential(name) {
        return Err(context.error(
            &written.span,
            "an interatomic potential is the law of atoms alone",
        ));
    }
    if name == Micromoduli::NAME {
        return match &context.micromoduli {
            Some(body) => Ok(LawSpec::Micromoduli(body.clone())),
            None => Err(context.error_with(
                &written.span,
                "there are no micromoduli: the body is no linear body from a file",
                "write body = { file = \"coarse.npz\" }, as `peridyne coarsen` makes it",
            )),
        };
    }
    super::law::solid(context, written)
}

/// Volume of every point (length^D), if it is the same.
pub(in crate::deck) fn point_volume(body: &BodySpec, dimension: usize) -> Option<f64> {
    match body {
        BodySpec::Lattice { kind, spacing, .. } | BodySpec::Sites { kind, spacing, .. } => {
            Some(kind.site_volume() * spacing.powi(dimension as i32))
        }
        BodySpec::Cloud(cloud) => {
            let first = cloud.volume.first()?;
            cloud.volume.iter().all(|v| v == first).then_some(*first)
        }
        BodySpec::Several(pieces) => {
            let first = point_volume(&pieces.first()?.body, dimension)?;
            let same = |p: &PieceSpec| point_volume(&p.body, dimension) == Some(first);
            pieces.iter().all(same).then_some(first)
        }
    }
}

/// Do bonds of all materials break before or after the force evaluation?
pub(super) fn breakage(
    context: &Context,
    written: &BTreeMap<String, At<Material>>,
) -> Result<Breakage> {
    let fracture = written.values().filter_map(|m| m.value.fracture.as_ref());
    let mut all = fracture.map(|f| match &f.value.breakage {
        None => (BreakageName::BeforeForce, &f.span),
        Some(breakage) => (breakage.value, &breakage.span),
    });
    let first = all.next().map_or(BreakageName::BeforeForce, |(r, _)| r);
    if let Some((_, span)) = all.find(|(r, _)| *r != first) {
        return Err(context.error_with(
            span,
            "materials differ in fracture.breakage",
            "give all materials with fracture the same: \"before_force\" (the default) or \"after_force\"",
        ));
    }
    Ok(match first {
        BreakageName::BeforeForce => Breakage::BeforeForce,
        BreakageName::AfterForce => Breakage::AfterForce,
    })
}

pub(super) fn fracture(context: &Context, fracture: &At<Fracture>) -> Result<FractureSpec> {
    let f = &fracture.value;
    let given = [
        ("critical_stretch", f.critical_stretch.is_some()),
        ("energy", f.energy.is_some()),
        ("von_mises", f.von_mises.is_some()),
        ("plastic_strain", f.plastic_strain.is_some()),
    ];
    context.one_of(&fracture.span, "fracture", &given)?;
    let criterion = if let Some(stretch) = &f.critical_stretch {
        Criterion::Stretch(context.value(stretch)?)
    } else if let Some(energy) = &f.energy {
        let energy = context.value(energy)?;
        match f.criterion.as_ref().map(|c| c.value) {
            None | Some(CriterionName::Stretch) => Criterion::Energy(energy),
            Some(CriterionName::BondEnergy) => Criterion::BondEnergy(energy),
        }
    } else if let Some(stress) = &f.von_mises {
        Criterion::VonMises(context.value(stress)?)
    } else if let Some(strain) = &f.plastic_strain {
        Criterion::PlasticStrain(context.value(strain)?)
    } else {
        return Err(context.error(&fracture.span, "fracture needs a criterion"));
    };
    if let (Some(name), None) = (&f.criterion, &f.energy) {
        return Err(context.error_with(
            &name.span,
            "criterion says what a fracture energy is made of, and there is none",
            "give energy, or leave criterion out",
        ));
    }
    let stretch = matches!(criterion, Criterion::Stretch(_) | Criterion::Energy(_));
    let rate = match &f.rate {
        Some(rate) if !stretch => {
            return Err(context.error_with(
                &rate.coefficient.span,
                "a rate is of the critical stretch",
                "give critical_stretch, or energy without criterion",
            ));
        }
        Some(rate) => Some(RateSpec {
            coefficient: context.value(&rate.coefficient)?,
            reference: context.value(&rate.reference)?,
        }),
        None => None,
    };
    let fatigue = { f.fatigue.as_ref() }
        .map(|fatigue| wear(context, fatigue))
        .transpose()?;
    Ok(FractureSpec {
        criterion,
        alpha: context.value_or(&f.alpha, 0.0)?,
        rate,
        fatigue,
    })
}

/// How bonds wear.
fn wear(context: &Context, at: &At<Fatigue>) -> Result<FatigueSpec> {
    let written = &at.value;
    let law = |list: &Option<At<Vec<Quantity<Positive>>>>| match list {
        None => Ok(None),
        Some(At {
            value: list, span, ..
        }) => {
            let [a, m] = &list[..] else {
                let message = format!("expected [A, m], there are {} numbers", list.len());
                return Err(context.error(span, message));
            };
            Ok(Some([context.value(a)?, context.value(m)?]))
        }
    };
    let (nucleation, growth) = (law(&written.nucleation)?, law(&written.growth)?);
    if nucleation.is_none() && growth.is_none() {
        return Err(context.error_with(
            &at.span,
            "fatigue needs nucleation or growth",
            "write for example fatigue = { growth = [1e6, 4] }",
        ));
    }
    Ok(FatigueSpec {
        nucleation,
        limit: context.value_or(&written.limit, 0.0)?,
        growth,
        crack: context.value_or(&written.crack, CRACK)?,
    })
}

/// Damage that is a crack where nobody says: a straight one through a lattice has a little more.
const CRACK: f64 = 0.35;
