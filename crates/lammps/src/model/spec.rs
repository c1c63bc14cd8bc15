//! From a script's set-up to a specification.

use peridyne::family::stencil::Stencil;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{
    BodySpec, BondsSpec, Breakage, Calibration, Cloud, ContactSpec, Criterion, DamageSpec,
    FractureSpec, Horizon, Influence, InteractionsSpec, LoadingSpec, MaterialSpec, Members,
    RunSpec, Schedule, SetSpec, SpaceSpec, Spec, Stepper, TimeStep,
};

use super::engine::in_plane;
use super::types::Types;
use crate::atoms::{Atoms, Column, Reference};
use crate::host::{HostError, Pair, Setup};

/// The specification of a script's model, without motion and conditions.
///
/// # Errors
/// Something that the engine has not.
pub fn spec(setup: &Setup, types: &Types) -> Result<Spec, HostError> {
    let influence = match &setup.pair {
        Pair::Pmb(_) => Influence::Constant,
        Pair::Lps(_) | Pair::Ves(_) | Pair::Eps(_) => Influence::Inverse,
    };
    let domain = &setup.domain;
    let periodic =
        [0, 1, 2].map(|a| (a < setup.dimension && domain.periodic(a)).then(|| domain.edge(a)));
    let several = types.materials().len() > 1;
    let body = match sites(setup, periodic, types.horizon()) {
        // sites have no marks
        Some(body) if !several => body,
        _ => cloud(setup, several)?,
    };
    let density = inertia(setup, 0);
    let material = |kind: &usize| {
        let own = types.get(*kind, *kind);
        MaterialSpec {
            name: kind.to_string(),
            set: if several {
                kind.to_string()
            } else {
                "all".into()
            },
            density,
            law: own.law,
            fracture: Some(FractureSpec {
                criterion: Criterion::Stretch(own.critical_stretch),
                alpha: own.alpha,
                rate: None,
                fatigue: None,
            }),
        }
    };
    let set = |kind: &usize| SetSpec {
        name: kind.to_string(),
        members: Members::Mark(*kind as i32),
    };
    Ok(Spec {
        title: setup.title.clone(),
        space: SpaceSpec {
            dimension: setup.dimension,
            periodic,
            ..SpaceSpec::default()
        },
        body,
        sets: if several {
            types.materials().iter().map(set).collect()
        } else {
            vec![]
        },
        materials: types.materials().iter().map(material).collect(),
        bonds: BondsSpec {
            horizon: Horizon::Length(types.horizon()),
            partial_volume_correction: true,
            calibration: Calibration::Continuum,
            influence,
            ..BondsSpec::default()
        },
        interactions: InteractionsSpec {
            pairs: types.table(),
            contact: Some(ContactSpec {
                // distances below which LAMMPS's points repel: fraction of the reference distance, and lattice constants
                bonded: 0.9,
                free: 1.35,
                stiffness: types.contact(),
                friction: None,
                cohesion: None,
                conductance: None,
            }),
            ..InteractionsSpec::default()
        },
        damage: DamageSpec {
            breakage: Breakage::AfterForce,
            ..DamageSpec::default()
        },
        loading: LoadingSpec::default(),
        run: RunSpec {
            schedule: Schedule {
                steps: setup.steps,
                time_step: TimeStep::Fixed(setup.time_step),
                // LAMMPS runs any step; a warning is given at the start of the run
                force_unstable: true,
                stepper: Stepper::Verlet,
            },
            ..RunSpec::default()
        },
    })
}

/// Force density over acceleration of an atom: its density, in units in which that of energy is density · velocity².
fn inertia(setup: &Setup, i: usize) -> f64 {
    setup.atoms.density.get(i) / setup.units.acceleration()
}

/// The value all atoms have.
fn same(column: &Column<f64>) -> Option<f64> {
    match column {
        Column::Uniform(v) => Some(*v),
        Column::Each(v) => {
            let first = *v.first()?;
            v.iter().all(|x| *x == first).then_some(first)
        }
    }
}

/// Sites of the script's lattice, if that is what the atoms are and no bond ends within round-off of the horizon: where
/// one does, LAMMPS's positions decide about every bond of its own.
fn sites(setup: &Setup, periodic: [Option<f64>; 3], horizon: f64) -> Option<BodySpec> {
    let atoms = &setup.atoms;
    let Reference::Sites { lattice, sites } = &atoms.reference else {
        return None;
    };
    let (volume, _) = (same(&atoms.volume)?, same(&atoms.density)?);
    if atoms.moved.is_some() || lattice.spacing != setup.lattice_constant {
        return None;
    }
    for a in 0..3 {
        let indices = || sites.iter().map(|s| s[a]);
        let extent = indices().max()? - indices().min()? + 1;
        // the box must be a whole number of cells, all of them taken
        let fits = match periodic[a] {
            Some(edge) => {
                (f64::from(extent) * lattice.spacing - edge).abs() <= 1e-9 * lattice.spacing
            }
            None => a < setup.dimension || extent == 1,
        };
        if !fits {
            return None;
        }
    }
    let plane = setup.dimension == 2;
    let kind = if plane {
        LatticeKind::Square
    } else {
        LatticeKind::Cubic
    };
    // a horizon over everything is refused by the engine, before its bonds are listed
    let length = Horizon::Length(horizon);
    if Stencil::fits(kind, lattice.spacing, length).is_ok()
        && Stencil::new(kind, lattice.spacing, length).near_horizon() > 0
    {
        return None;
    }
    Some(BodySpec::Sites {
        kind,
        spacing: lattice.spacing,
        origin: lattice.offset,
        quarters: sites
            .iter()
            .map(|s| [4 * s[0], 4 * s[1], if plane { 0 } else { 4 * s[2] }])
            .collect(),
        volume: Some(volume),
    })
}

fn cloud(setup: &Setup, marked: bool) -> Result<BodySpec, HostError> {
    let atoms: &Atoms = &setup.atoms;
    let n = atoms.len();
    let position: Vec<[f64; 3]> = (0..n).map(|i| atoms.position(i)).collect();
    if setup.dimension == 2 {
        for x in &position {
            in_plane("position", &x[2..], position[0][2])?;
        }
    }
    Ok(BodySpec::Cloud(Cloud {
        velocity: vec![],
        position,
        volume: (0..n).map(|i| atoms.volume.get(i)).collect(),
        density: match same(&atoms.density) {
            Some(_) => vec![],
            None => (0..n).map(|i| inertia(setup, i)).collect(),
        },
        mark: if marked {
            (0..n).map(|i| atoms.types.get(i) as i32).collect()
        } else {
            vec![]
        },
        names: vec![],
        sets: vec![],
        faces: vec![],
        spacing: Some(setup.lattice_constant),
    }))
}
