//! From a script's set-up to a specification.

use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{
    BodySpec, Calibration, Cloud, ContactSpec, Criterion, FamilyChoice, FractureSpec, Horizon,
    Influence, InterfaceRule, LawSpec, MaterialSpec, Plane, PmbStiffness, Schedule, Spec, TimeStep,
};

use super::in_plane;
use crate::lammps::atoms::{Atoms, Column, Reference};
use crate::lammps::host::{HostError, Pair, PairTable, Setup};

/// Distances below which LAMMPS's points repel: fraction of the reference distance, and lattice constants.
const CONTACT: ContactSpec = ContactSpec {
    bonded: 0.9,
    free: 1.35,
    stiffness: None,
};

/// The specification of a script's model, without motion and conditions.
///
/// # Errors
/// Something that the engine has not.
pub fn spec(setup: &Setup) -> Result<Spec, HostError> {
    let (law, influence, horizon, critical, alpha) = match &setup.pair {
        Pair::Pmb(table) => {
            let c = uniform(table)?;
            let law = LawSpec::Pmb(PmbStiffness::Micromodulus(c.micromodulus));
            (
                law,
                Influence::Constant,
                c.horizon,
                c.critical_stretch,
                c.alpha,
            )
        }
        Pair::Lps(table) => {
            let c = uniform(table)?;
            let law = LawSpec::LpsAsTyped {
                bulk: c.bulk,
                shear: c.shear,
            };
            (
                law,
                Influence::Inverse,
                c.horizon,
                c.critical_stretch,
                c.alpha,
            )
        }
    };
    let domain = &setup.domain;
    let periodic =
        [0, 1, 2].map(|a| (a < setup.dimension && domain.periodic(a)).then(|| domain.edge(a)));
    let body = match sites(setup, periodic) {
        Some(body) => body,
        None => cloud(setup)?,
    };
    Ok(Spec {
        title: setup.title.clone(),
        dimension: setup.dimension,
        plane: Plane::Stress,
        section: 1.0,
        body,
        sets: vec![],
        materials: vec![MaterialSpec {
            name: "1".into(),
            set: "all".into(),
            density: setup.atoms.density.get(0),
            law,
            fracture: Some(FractureSpec {
                criterion: Criterion::Stretch(critical),
                alpha,
            }),
        }],
        interface: InterfaceRule::Series,
        horizon: Horizon::Length(horizon),
        volume_scaling: true,
        calibration: Calibration::Continuum,
        influence,
        periodic,
        precracks: vec![],
        contact: Some(CONTACT),
        initial: vec![],
        conditions: vec![],
        indenters: vec![],
        family: FamilyChoice::Auto,
        schedule: Schedule {
            steps: 0,
            time_step: TimeStep::Fixed(setup.time_step),
            // LAMMPS runs any step; a warning is given at the start of the run
            force_unstable: true,
        },
    })
}

/// The coefficients that all pairs of types have.
fn uniform<T: Copy + PartialEq>(table: &PairTable<T>) -> Result<T, HostError> {
    let first = table.get(1, 1);
    for i in 1..=table.types() {
        for j in i..=table.types() {
            if table.get(i, j) != first {
                return Err(HostError::new(format!(
                    "`pair_coeff {i} {j}` differs from `pair_coeff 1 1`: all pairs of types need the same coefficients"
                ))
                .help("several materials run from a deck (TOML), with `interface` saying how bonds between them get their stiffness"));
            }
        }
    }
    Ok(first)
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

fn cloud(setup: &Setup) -> Result<BodySpec, HostError> {
    let atoms: &Atoms = &setup.atoms;
    let n = atoms.len();
    let position: Vec<[f64; 3]> = (0..n).map(|i| atoms.position(i)).collect();
    if setup.dimension == 2 {
        for x in &position {
            in_plane("position", &x[2..], position[0][2])?;
        }
    }
    Ok(BodySpec::Cloud(Cloud {
        position,
        volume: (0..n).map(|i| atoms.volume.get(i)).collect(),
        density: match same(&atoms.density) {
            Some(_) => vec![],
            None => (0..n).map(|i| atoms.density.get(i)).collect(),
        },
        mark: vec![],
        names: vec![],
        spacing: Some(setup.lattice_constant),
    }))
}
