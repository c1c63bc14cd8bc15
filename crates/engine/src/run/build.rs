//! From a specification to a model: the only place that matches on dimension, law and family.

use super::model::Model;
use super::probe;
use super::recipe::{Laws, Recipe};
use super::{Info, Simulation};
use crate::body::{Body, Layout, Values, zeros};
use crate::condition::still::Still;
use crate::dynamics::verlet::Verlet;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::stencil::Stencil;
use crate::fracture::precrack::Crack;
use crate::interaction::contact::Contact;
use crate::law::influence::influence;
use crate::law::micromodulus::Moments;
use crate::space::fill::fill;
use crate::space::lattice::{Lattice, LatticeKind};
use crate::space::{AXES, Point};
use crate::spec::{
    BodySpec, Calibration, CrackKind, FamilyChoice, Horizon, LawSpec, MaterialSpec, Members,
    Perturbation, PmbStiffness, Spec, TimeStep,
};

/// How to build, as opposed to what.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Instruction set; `None` takes the widest there is.
    pub simd: Option<Simd>,
    /// Leave the stability limit unmeasured (a fixed step is then taken as it is).
    pub trust_time_step: bool,
}

/// Build the model of a spec.
pub fn build(spec: &Spec, options: Options) -> Result<Box<dyn Simulation>, BuildError> {
    if let Some(simd) = options.simd
        && !Simd::available().contains(&simd)
    {
        return Err(BuildError::new(
            "simd",
            format!("this machine has no {}", simd.name()),
        ));
    }
    match spec.dimension {
        1 => Ok(Box::new(build_in::<1>(spec, options)?)),
        2 => Ok(Box::new(build_in::<2>(spec, options)?)),
        3 => Ok(Box::new(build_in::<3>(spec, options)?)),
        d => Err(BuildError::new(
            "dimension",
            format!("{d} dimensions; expected 1, 2 or 3"),
        )),
    }
}

/// Build the model of a spec in D dimensions.
pub fn build_in<const D: usize>(spec: &Spec, options: Options) -> Result<Model<D>, BuildError> {
    let simd = options.simd.unwrap_or_else(Simd::detect);
    let mut warnings = vec![];
    let Reference {
        mut body,
        stencil,
        bulk,
        horizon,
    } = reference::<D>(spec)?;
    let cell = cell(spec, &body);
    let from_modulus = |m: &MaterialSpec| {
        use PmbStiffness::{Bulk, Young};
        matches!(m.law, LawSpec::Pmb(Bulk(_) | Young(_)))
    };
    if bulk.is_none()
        && spec.calibration == Calibration::Discrete
        && spec.materials.iter().any(from_modulus)
    {
        warnings.push(
            "a cloud of points has no lattice family to calibrate to: the constants are those of the continuum".into(),
        );
    }
    let discrete =
        bulk.unwrap_or_else(|| Moments::continuum(D, horizon, spec.section, spec.influence));
    let sets = sets(spec, &body)?;
    assign_materials(spec, &mut body, &sets)?;
    if let BodySpec::Cloud(cloud) = &spec.body
        && !cloud.density.is_empty()
    {
        body.density = Values::from_points(&cloud.density, &body.slots, body.len, 1.0);
    }
    let ends = stencil.as_ref().map_or(0, |s| s.near_horizon as u64);
    let mut recipe = Recipe::new::<D>(spec, stencil, horizon, cell, discrete, simd)?;
    let mut interaction = recipe.interaction(&body, None)?;
    // a ratio is meant inclusively; only a length leaves the decision to round-off
    let near_horizon = if recipe.ratio {
        0
    } else {
        ends.max(interaction.near_horizon())
    };
    if near_horizon > 0 {
        let what = if ends > 0 {
            "bonds of the stencil"
        } else {
            "directed bonds"
        };
        warnings.push(format!(
            "{near_horizon} {what} end within round-off of the horizon {horizon:e}: a larger or smaller number in its last digits changes the family; write the horizon as a whole number of spacings (m_ratio), or well between two distances"
        ));
    }
    let mut cut = 0;
    for kind in [CrackKind::Absent, CrackKind::Broken] {
        if kind == CrackKind::Broken {
            interaction.prepare(&body);
        }
        for (n, crack) in spec
            .precracks
            .iter()
            .enumerate()
            .filter(|(_, c)| c.kind == kind)
        {
            let shape = Crack::new(&crack.shape, body.period).map_err(|e| BuildError {
                path: format!("precracks[{n}]"),
                ..e
            })?;
            let count = interaction.cut(&body, kind, &|from, to| shape.crosses(&from, &to));
            if count == 0 {
                warnings.push(format!("pre-crack {} cuts no bond", n + 1));
            }
            cut += count;
        }
    }
    let directed_bonds = interaction.directed_bonds();
    if directed_bonds == 0 && body.points() > 1 {
        return Err(BuildError::new(
            "horizon",
            format!(
                "no two of the {} points are within the horizon {horizon:e}",
                body.points()
            ),
        )
        .help(format!(
            "the spacing is {:e}: a horizon of three spacings is usual",
            body.spacing
        )));
    }
    let stable_step = if options.trust_time_step {
        f64::INFINITY
    } else {
        probe::stable_step(&recipe, &body, interaction.as_mut(), spec)?
    };
    let dt = match spec.schedule.time_step {
        TimeStep::Fraction(x) if stable_step.is_finite() => x * stable_step,
        TimeStep::Fraction(_) if body.points() == 1 => {
            return Err(BuildError::new(
                "body",
                "the body has one point, and a point alone has no bonds",
            )
            .help("a larger region or a smaller spacing"));
        }
        TimeStep::Fraction(_) => {
            return Err(BuildError::new(
                "schedule.time_step",
                "nothing resists: no stable step can be derived",
            )
            .help("give time_step as a number"));
        }
        TimeStep::Fixed(dt) => dt,
    };
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(BuildError::new(
            "schedule.time_step",
            format!("the time step is {dt}, expected a positive number"),
        ));
    }
    if dt > stable_step {
        let message = format!(
            "the time step {dt:.4e} is above the stability limit {stable_step:.4e} of this body"
        );
        if !spec.schedule.force_unstable {
            return Err(BuildError::new("schedule.time_step", message)
                .help(format!("write time_step = {:.3e} or \"auto\"; force_unstable = true under [run] runs it all the same", 0.8 * stable_step)));
        }
        warnings.push(message);
    }
    let sizes = body
        .slots
        .iter()
        .map(|s| interaction.family_size(*s as usize));
    let (smallest, largest) = sizes.fold((usize::MAX, 0), |(a, b), n| (a.min(n), b.max(n)));
    let u = body.at_rest();
    recipe.stencil = None; // the interaction has it
    let mut model = Model {
        info: Info {
            dimension: D,
            points: body.points() as u64,
            directed_bonds,
            family: (
                smallest,
                directed_bonds as f64 / body.points() as f64,
                largest,
            ),
            family_kind: if matches!(body.layout, Layout::Grid(_)) {
                "stencil"
            } else {
                "list"
            },
            near_horizon,
            horizon,
            spacing: body.spacing,
            section: spec.section,
            mass: body.mass(),
            volume: body.slots.iter().map(|s| body.volume.at(*s as usize)).sum(),
            micromodulus: if let Laws::Bond(c) = &recipe.laws {
                c.clone()
            } else {
                vec![]
            },
            critical_stretch: recipe.toughness.iter().map(|t| t.s00).collect(),
            time_step: dt,
            stable_step,
            cut,
            bytes: 0,
            simd: simd.name(),
            warnings,
        },
        v: zeros(body.len),
        f: zeros(body.len),
        u,
        verlet: Verlet::new(simd, &body),
        contact: recipe.repulsion.map(|r| Contact::new(r, &body, horizon)),
        recipe,
        interaction,
        body,
        loads: vec![],
        constraints: vec![],
        driven: vec![],
        still: Still::new(vec![]),
        watch: false,
        watched: None,
        watch_virial: false,
        virial: None,
        indenters: vec![],
        sets,
        dt,
        step: 0,
        origin: (0, 0.0),
        pending: false,
        broken: 0,
        released: 0.0,
        past_work: [0.0; 3],
        initial_energy: None,
    };
    model.info.bytes = model.bytes();
    initial(spec, &mut model)?;
    let sets = std::mem::take(&mut model.sets);
    model.set_conditions(&spec.conditions, &sets, &spec.indenters)?;
    model.sets = sets;
    Ok(model)
}

/// Where the points are, and what their family is.
struct Reference<const D: usize> {
    body: Body<D>,
    /// The family, if it is a stencil.
    stencil: Option<Stencil>,
    /// Sums over a full family of the lattice that the points come from, whatever the family is.
    bulk: Option<Moments>,
    /// Length.
    horizon: f64,
}

/// Distance over which the horizon cuts cells.
fn cell<const D: usize>(spec: &Spec, body: &Body<D>) -> f64 {
    match &spec.body {
        BodySpec::Lattice {
            kind: LatticeKind::Cubic | LatticeKind::Square | LatticeKind::Chain,
            spacing,
            ..
        } => *spacing,
        _ => body.spacing,
    }
}

fn reference<const D: usize>(spec: &Spec) -> Result<Reference<D>, BuildError> {
    let on_lattice = |kind: LatticeKind,
                      spacing: f64,
                      origin: [f64; 3],
                      quarters: &[[i32; 3]],
                      volume: Option<f64>| {
        if kind.dimension() != D {
            return Err(BuildError::new(
                "body.lattice",
                format!(
                    "a {} lattice has {} dimensions, the run has {D}",
                    kind.name(),
                    kind.dimension()
                ),
            ));
        }
        let stencil = Stencil::new(kind, spacing, spec.horizon);
        let periodic: [bool; D] = std::array::from_fn(|a| spec.periodic[a].is_some());
        let volume = volume.unwrap_or(kind.site_volume() * spacing.powi(D as i32) * spec.section);
        let horizon = horizon_length(spec, spacing);
        if horizon < spacing * kind.nearest() {
            return Err(BuildError::new(
                "horizon",
                format!(
                    "the horizon {horizon:e} is below the distance {:e} of nearest points",
                    spacing * kind.nearest()
                ),
            )
            .help("three spacings are usual: horizon = { m_ratio = 3 }"));
        }
        if stencil.bonds() > crate::interaction::stencil::MOST {
            return Err(BuildError::new(
                "horizon",
                format!(
                    "{} bonds per point; at most {}",
                    stencil.bonds(),
                    crate::interaction::stencil::MOST
                ),
            )
            .help("choose a shorter horizon: three to six spacings are usual"));
        }
        let body = Body::<D>::on_lattice(
            Lattice {
                kind,
                spacing,
                origin,
            },
            quarters,
            stencil.reach,
            periodic,
            volume,
        )?;
        for a in 0..D {
            if let (Some(given), Some(p)) = (spec.periodic[a], body.period[a])
                && given > 0.0
                && (given - p).abs() > 1e-9 * p
            {
                return Err(BuildError::new(
                    "periodic",
                    format!(
                        "the period along {} is {given:e}, the lattice body repeats after {p:e}",
                        AXES[a]
                    ),
                ));
            }
        }
        let bulk = stencil_moments::<D>(spec, &body, &stencil, horizon, cell(spec, &body));
        Ok(Reference {
            body,
            stencil: Some(stencil),
            bulk: Some(bulk),
            horizon,
        })
    };
    let list_if_asked = |r: Reference<D>| {
        if spec.family == FamilyChoice::List {
            Ok(Reference {
                body: r.body.to_cloud()?,
                stencil: None,
                ..r
            })
        } else {
            Ok(r)
        }
    };
    match &spec.body {
        BodySpec::Lattice {
            kind,
            spacing,
            origin,
            region,
            perturb,
        } => {
            if !(*spacing > 0.0 && spacing.is_finite()) {
                return Err(BuildError::new(
                    "body.spacing",
                    format!("the spacing is {spacing}, expected a positive length"),
                ));
            }
            let lattice = Lattice {
                kind: *kind,
                spacing: *spacing,
                origin: *origin,
            };
            let sites = fill(&lattice, region)?;
            match perturb {
                Some(p) => {
                    let r = on_lattice(*kind, *spacing, *origin, &sites.quarters, None)?;
                    Ok(Reference {
                        body: perturbed(&r.body, p)?,
                        stencil: None,
                        ..r
                    })
                }
                None => list_if_asked(on_lattice(*kind, *spacing, *origin, &sites.quarters, None)?),
            }
        }
        BodySpec::Sites {
            kind,
            spacing,
            origin,
            quarters,
            volume,
        } => list_if_asked(on_lattice(*kind, *spacing, *origin, quarters, *volume)?),
        BodySpec::Cloud(cloud) => {
            if spec.family == FamilyChoice::Stencil {
                return Err(BuildError::new(
                    "family",
                    "a stencil needs a lattice body, this is a cloud of points",
                ));
            }
            let mean =
                cloud.volume.iter().sum::<f64>() / cloud.volume.len().max(1) as f64 / spec.section;
            let spacing = cloud.spacing.unwrap_or(mean.powf(1.0 / D as f64));
            let period = std::array::from_fn(|a| spec.periodic[a]);
            let body = Body::<D>::from_cloud(
                &cloud.position,
                &cloud.volume,
                &cloud.mark,
                spacing,
                period,
            )?;
            Ok(Reference {
                body,
                stencil: None,
                bulk: None,
                horizon: horizon_length(spec, spacing),
            })
        }
    }
}

/// Every site moved by a uniform random vector in ±amplitude per axis.
fn perturbed<const D: usize>(body: &Body<D>, p: &Perturbation) -> Result<Body<D>, BuildError> {
    if !(p.amplitude >= 0.0 && p.amplitude < 0.5 * body.spacing) {
        return Err(BuildError::new(
            "body.perturb",
            format!(
                "the amplitude {} must be below half the spacing {}",
                p.amplitude, body.spacing
            ),
        ));
    }
    let mut random = SplitMix(p.seed);
    let position: Vec<Point> = body
        .slots
        .iter()
        .map(|s| {
            let mut x = body.position(*s as usize);
            for c in x.iter_mut().take(D) {
                *c += p.amplitude * (2.0 * random.unit() - 1.0);
            }
            x
        })
        .collect();
    let volume = vec![body.volume.uniform().unwrap_or(1.0); position.len()];
    Body::from_cloud(&position, &volume, &body.mark, body.spacing, body.period)
}

/// SplitMix64 (Steele, Lea & Flood 2014): a seed gives the same body on every machine.
struct SplitMix(u64);

impl SplitMix {
    /// Uniform in [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn horizon_length(spec: &Spec, spacing: f64) -> f64 {
    match spec.horizon {
        Horizon::Ratio(m) => m as f64 * spacing,
        Horizon::Length(d) => d,
    }
}

/// Sums over a full family of the lattice, averaged over the sublattices.
fn stencil_moments<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    stencil: &Stencil,
    horizon: f64,
    cell: f64,
) -> Moments {
    let Layout::Grid(grid) = &body.layout else {
        unreachable!("stencils live on grids")
    };
    let volume = body.volume.uniform().unwrap_or(0.0);
    let mut sum = Moments {
        first: 0.0,
        second: 0.0,
    };
    for o in stencil.offsets.iter().flatten() {
        let r0 = grid.lattice.spacing * (o.squared as f64).sqrt() / 4.0;
        let nu = if spec.volume_scaling {
            crate::family::volume_fraction(r0, horizon, cell)
        } else {
            1.0
        };
        let w = nu * influence(spec.influence, r0, horizon) * volume / stencil.offsets.len() as f64;
        sum.first += w * r0;
        sum.second += w * r0 * r0;
    }
    sum
}

/// Does a point (index, reference position) belong?
type Member<'a> = Box<dyn Fn(usize, &Point) -> bool + 'a>;

/// Point ids of every named set.
fn sets<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
) -> Result<Vec<(String, Vec<u32>)>, BuildError> {
    let mut out = vec![];
    for set in &spec.sets {
        let member: Member = match &set.members {
            Members::All => Box::new(|_, _| true),
            Members::Region(region) => {
                let slack = 1e-9 * body.spacing;
                Box::new(move |_, x| region.contains(x) || near(region, x, slack))
            }
            Members::Mark(mark) => {
                Box::new(|id, _| body.mark.get(id).copied().unwrap_or(0) == *mark)
            }
        };
        let ids: Vec<u32> = body
            .slots
            .iter()
            .enumerate()
            .filter(|(id, s)| member(*id, &body.position(**s as usize)))
            .map(|(id, _)| id as u32)
            .collect();
        if ids.is_empty() {
            return Err(BuildError::new(
                format!("sets.{}", set.name),
                format!("set `{}` has no points", set.name),
            )
            .help("check its region against the body's extent: `peridyne check` prints it"));
        }
        out.push((set.name.clone(), ids));
    }
    Ok(out)
}

/// Points within round-off of a region's boundary belong to it.
fn near(region: &crate::space::region::Region, x: &Point, slack: f64) -> bool {
    (0..3).any(|a| {
        [-slack, slack].into_iter().any(|d| {
            let mut y = *x;
            y[a] += d;
            region.contains(&y)
        })
    })
}

fn assign_materials<const D: usize>(
    spec: &Spec,
    body: &mut Body<D>,
    sets: &[(String, Vec<u32>)],
) -> Result<(), BuildError> {
    let materials = &spec.materials;
    if let [only] = materials.as_slice()
        && only.set == "all"
    {
        body.density = Values::Uniform(only.density);
        return Ok(());
    }
    if materials.len() > u8::MAX as usize {
        return Err(BuildError::new(
            "materials",
            format!("{} materials; at most 255", materials.len()),
        ));
    }
    let mut of: Vec<Option<u8>> = vec![None; body.points()];
    for (n, m) in materials.iter().enumerate() {
        let all: Vec<u32>;
        let ids = if m.set == "all" {
            all = (0..body.points() as u32).collect();
            &all
        } else {
            let Some((_, ids)) = sets.iter().find(|(name, _)| *name == m.set) else {
                return Err(BuildError::new(
                    format!("materials[{n}].set"),
                    format!(
                        "material `{}` is on set `{}`, which does not exist",
                        m.name, m.set
                    ),
                ));
            };
            ids
        };
        for &id in ids {
            if let Some(other) = of[id as usize].replace(n as u8) {
                let x = body.position(body.slots[id as usize] as usize);
                return Err(BuildError::new(
                    format!("materials[{n}].set"),
                    format!(
                        "point {} at {x:?} belongs to material `{}` and to material `{}`",
                        id + 1,
                        materials[other as usize].name,
                        m.name
                    ),
                )
                .help("make the materials' sets disjoint"));
            }
        }
    }
    if let Some(id) = of.iter().position(Option::is_none) {
        let x = body.position(body.slots[id] as usize);
        return Err(BuildError::new(
            "materials",
            format!("point {} at {x:?} belongs to no material", id + 1),
        )
        .help("make the materials' sets cover the body"));
    }
    body.material = vec![0; body.len];
    let mut density = vec![];
    for (m, s) in of.iter().zip(&body.slots) {
        let m = m.unwrap_or(0);
        body.material[*s as usize] = m;
        density.push(materials[m as usize].density);
    }
    body.density = Values::from_points(&density, &body.slots, body.len, 1.0);
    if body.mark.is_empty() {
        body.mark = of.iter().map(|m| i32::from(m.unwrap_or(0))).collect();
    }
    Ok(())
}

fn initial<const D: usize>(spec: &Spec, model: &mut Model<D>) -> Result<(), BuildError> {
    for (n, init) in spec.initial.iter().enumerate() {
        let sets = std::mem::take(&mut model.sets);
        let members = model.members(&init.set, &sets).map_err(|e| BuildError {
            path: format!("initial[{n}].set"),
            ..e
        });
        model.sets = sets;
        let (slots, points) = members?;
        for a in 0..D {
            for (field, e) in [
                (&mut model.u[a], &init.displacement[a]),
                (&mut model.v[a], &init.velocity[a]),
            ] {
                let Some(e) = e else { continue };
                for (s, x) in slots.iter().zip(&points) {
                    let value = e.eval(x, 0.0);
                    if !value.is_finite() {
                        return Err(BuildError::new(
                            format!("initial[{n}]"),
                            format!("`{}` is {value} at {x:?}", e.source()),
                        ));
                    }
                    field[*s as usize] = value;
                }
            }
        }
    }
    Ok(())
}
