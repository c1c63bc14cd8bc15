//! From a script's set-up to a specification.

use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{
    BodySpec, Calibration, Cloud, ContactSpec, ContactStiffness, Criterion, FamilyChoice,
    FractureSpec, Horizon, Influence, InterfaceRule, MaterialSpec, Members, Plane, Schedule,
    SetSpec, Spec, TimeStep,
};

use super::in_plane;
use super::types::Types;
use crate::lammps::atoms::{Atoms, Column, Reference};
use crate::lammps::host::{HostError, Pair, Setup};

/// Distances below which LAMMPS's points repel: fraction of the reference distance, and lattice constants.
const CONTACT: ContactSpec = ContactSpec {
    bonded: 0.9,
    free: 1.35,
    stiffness: ContactStiffness::Laws,
};

/// The specification of a script's model, without motion and conditions; `rule` says what bonds between unlike types
/// have.
///
/// # Errors
/// Something that the engine has not.
pub fn spec(setup: &Setup, types: &Types, rule: InterfaceRule) -> Result<Spec, HostError> {
    let influence = match &setup.pair {
        Pair::Pmb(_) => Influence::Constant,
        Pair::Lps(_) => Influence::Inverse,
    };
    let domain = &setup.domain;
    let periodic =
        [0, 1, 2].map(|a| (a < setup.dimension && domain.periodic(a)).then(|| domain.edge(a)));
    let several = types.materials().len() > 1;
    let body = match sites(setup, periodic) {
        // sites have no marks
        Some(body) if !several => body,
        _ => cloud(setup, several)?,
    };
    let density = setup.atoms.density.get(0);
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
            }),
        }
    };
    let set = |kind: &usize| SetSpec {
        name: kind.to_string(),
        members: Members::Mark(*kind as i32),
    };
    Ok(Spec {
        potential: None,
        micromoduli: None,
        thermal: None,
        title: setup.title.clone(),
        dimension: setup.dimension,
        plane: Plane::Stress,
        section: 1.0,
        body,
        sets: if several {
            types.materials().iter().map(set).collect()
        } else {
            vec![]
        },
        materials: types.materials().iter().map(material).collect(),
        interface: rule,
        horizon: Horizon::Length(types.horizon()),
        volume_scaling: true,
        calibration: Calibration::Continuum,
        influence,
        periodic,
        surface: None,
        bonds: vec![],
        precracks: vec![],
        contact: Some(CONTACT),
        initial: vec![],
        conditions: vec![],
        indenters: vec![],
        family: FamilyChoice::Auto,
        schedule: Schedule {
            steps: setup.steps,
            time_step: TimeStep::Fixed(setup.time_step),
            // LAMMPS runs any step; a warning is given at the start of the run
            force_unstable: true,
            statics: None,
        },
    })
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

/// Sites of the script's lattice, if that is what the atoms are.
fn sites(setup: &Setup, periodic: [Option<f64>; 3]) -> Option<BodySpec> {
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
    Some(BodySpec::Sites {
        kind: if plane {
            LatticeKind::Square
        } else {
            LatticeKind::Cubic
        },
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
            None => (0..n).map(|i| atoms.density.get(i)).collect(),
        },
        mark: if marked {
            (0..n).map(|i| atoms.types.get(i) as i32).collect()
        } else {
            vec![]
        },
        names: vec![],
        spacing: Some(setup.lattice_constant),
    }))
}
