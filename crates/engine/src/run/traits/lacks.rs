//! What the parts of a spec have not.

use super::{Lack, Property};
use crate::constitutive::{Registry, Stiffness};
use crate::law::descriptor::Memory;
use crate::law::solid::eam_like::Solid;
use crate::run::reference::{current_neighbours, listed};
use crate::spec::{
    BodySpec, Breakage, Calibration, Control, CrackKind, Criterion, DiffusionMethod, DiffusionSpec,
    FamilyChoice, FractureSpec, InterfaceSpec, LawSpec, MaterialSpec, Measure, Method, PreloadSpec,
    Quantity, RigidBodyMotion, Solver, Spec, Stepper, ToughnessFactor,
};

pub(super) fn of(spec: &Spec, registry: &Registry) -> Vec<Lack> {
    let mut all = of_bodies(spec, registry);
    all.extend(of_families(spec));
    all.extend(of_horizons(spec, registry));
    all.extend(of_probes(spec));
    all.extend(of_diffusions(spec));
    all.extend(of_statics(spec));
    all.extend(of_atoms(spec));
    all.extend(of_strength(spec));
    for (n, m) in spec.materials.iter().enumerate() {
        all.extend(of_material(n, m, spec, registry));
    }
    all
}

fn of_bodies(spec: &Spec, registry: &Registry) -> Vec<Lack> {
    let mut all = vec![];
    if !spec.interactions.pairs.is_empty() {
        let says = "the constants of pairs of materials are one table for all bonds of a body";
        all.push(Lack::new(
            Property::ConstantsOfPoints,
            says,
            "leave pairs out",
        ));
    }
    if !mirrored(spec) {
        let says = "materials of unlike constants with each other pull at each other unlike: action is not reaction";
        all.push(Lack::new(Property::Symmetric, says, ""));
    }
    if spec.bonds.surface.is_some() {
        let says = "surface corrections are those of the points of one lattice";
        let instead = "give each body its own";
        all.push(Lack::new(Property::SideBySide, says, instead).at("surface"));
    }
    if spec.bonds.variable_horizon.is_some() {
        let says = "points have horizons of their own";
        all.push(
            Lack::new(Property::OneHorizon, says, "leave variable_horizon out")
                .at("variable_horizon"),
        );
    }
    if !spec.interactions.interfaces.is_empty() {
        let says = "an interface bonds points of two bodies";
        let instead = "take the interfaces away";
        all.push(Lack::new(Property::Unbonded, says, instead));
    }
    let interfaces = &spec.interactions.interfaces;
    let rated = |i: &InterfaceSpec| i.fracture.is_some_and(|f| f.rate.is_some());
    if let Some(n) = interfaces.iter().position(rated) {
        let path = format!("interface[{n}].fracture.rate");
        let says = "bonds of this interface break by how fast they are stretched";
        for property in [Property::Timeless, Property::PresentStretch] {
            all.push(Lack::new(property, says, "leave rate out").at(&*path));
        }
    }
    let lets_go = |i: &InterfaceSpec| {
        let fades = matches!(&i.law, LawSpec::Named(law) if registry.softens_to_zero(&law.name));
        i.fracture.is_some() && !fades
    };
    if interfaces.iter().any(lets_go) {
        let says = "this interface breaks bonds abruptly: path following needs a softening law";
        let instead =
            "leave the fracture of the interface out, or write control = \"sequentially_linear\"";
        all.push(Lack::new(Property::Fades, says, instead).at("statics.control"));
    }
    if let BodySpec::Several(pieces) = &spec.body {
        if let Some(loose) = pieces.iter().find(|p| !p.bonded) {
            let says = format!("`{}` has unbonded particles", loose.name);
            all.push(Lack::new(Property::Faces, says, "leave bonded = false out"));
        }
        if spec.interactions.contact.is_some() {
            let says = "contact forces are not proportional to the load";
            let instead = "write contact = false and bond them";
            all.push(Lack::new(Property::InProportion, says, instead));
        }
    }
    if !spec.loading.rigid_bodies.is_empty() {
        let says = "contact forces of a rigid body are not proportional to the load";
        all.push(Lack::new(
            Property::InProportion,
            says,
            "leave the rigid bodies out",
        ));
    }
    if let Some(n) = (spec.loading.conditions.iter()).position(|c| c.kind.depends_on_time()) {
        let says = "this boundary condition depends on t";
        let instead = "leave t out of it; increments count cycles, whose number is in history.csv";
        let lack = Lack::new(Property::SameInCycles, says, instead);
        all.push(lack.at(format!("conditions[{n}]")));
    }
    all
}

/// Of families, and of what goes with some of them.
fn of_families(spec: &Spec) -> Vec<Lack> {
    let mut all = vec![];
    match spec.bonds.family {
        FamilyChoice::List => {
            let says = "a list stores bonds of peridynamic laws";
            let instead = "write family = \"reference\": those within the horizon in the reference, for ever; or leave it out: those that are near now";
            all.push(Lack::new(Property::Potentials, says, instead).at("family"));
        }
        FamilyChoice::Reference => {
            let says = "family = \"reference\" belongs to interatomic potentials: the families of this law are always those of the reference";
            all.push(Lack::new(Property::Solids, says, "leave family out").at("family"));
        }
        FamilyChoice::Auto | FamilyChoice::Stencil | FamilyChoice::Neighbours => {}
    }
    if current_neighbours(spec) {
        let says = "atoms interact with their current neighbours, and who comes near again is a neighbour again: no bond can break or be cut";
        let instead =
            "write family = \"reference\" with a horizon, or remove fracture and pre-cracks";
        all.push(Lack::new(Property::Breaks, says, instead));
    }
    if spec.bonds.smooth.is_some() {
        let says =
            "smoothing averages the force states of a potential, which are those of the reference";
        let instead = "write family = \"reference\", with an interatomic potential as the law";
        for property in [Property::Solids, Property::OfNow] {
            all.push(Lack::new(property, says, instead).at("smooth"));
        }
    }
    if spec.interactions.bonded.is_some() {
        let says = "bonds, angles and dihedrals stand beside a potential of atoms";
        let instead = "give the material a pair potential";
        all.push(Lack::new(Property::Solids, says, instead).at("bonded"));
        let says = "molecules have no stencil";
        let instead = "remove family = \"stencil\": atoms interact with their current neighbours, or with family = \"reference\" those of the reference";
        all.push(Lack::new(Property::OfStencil, says, instead).at("bonded"));
        let says = "the bonds of a molecule are terms of its force field, which hold at any length";
        let instead = "remove fracture and pre-cracks";
        all.push(Lack::new(Property::Breaks, says, instead));
    }
    all
}

/// Of what stands in the way of horizons of points.
fn of_horizons(spec: &Spec, registry: &Registry) -> Vec<Lack> {
    let mut all = vec![];
    let mut lack = |path: &str, says: &str, instead| {
        all.push(Lack::new(Property::VariableHorizons, says, instead).at(path));
    };
    if !listed(spec)
        && matches!(
            spec.body,
            BodySpec::Lattice { perturb: None, .. } | BodySpec::Sites { .. }
        )
    {
        lack(
            "variable_horizon",
            "a variable horizon belongs to a cloud: a lattice has one stencil",
            "write family = \"list\", or take the points from a file",
        );
    }
    for m in &spec.materials {
        match registry.stiffness(&m.law) {
            Some(Stiffness::Family | Stiffness::Bonds) => {}
            Some(Stiffness::Horizon(why)) => lack(
                "variable_horizon",
                why,
                "take pmb, lps or another law of sums over families, or leave variable_horizon out",
            ),
            None => lack(
                "variable_horizon",
                "points with horizons of their own are a body of pmb, or of laws that their families normalise",
                "take lps, or leave variable_horizon out",
            ),
        }
    }
    if !spec.bonds.partial_volume_correction {
        lack(
            "partial_volume_correction",
            "volumes fade at the horizon of a point: else its stiffness jumps wherever that passes another point",
            "leave partial_volume_correction out",
        );
    }
    if spec.bonds.calibration != Calibration::Continuum {
        lack(
            "calibration",
            "the constants of points with horizons of their own are those of the continuum",
            "write calibration = \"continuum\"",
        );
    }
    all
}

/// Of what is measured.
fn of_probes(spec: &Spec) -> Vec<Lack> {
    let first = |which: &dyn Fn(&Measure) -> bool| {
        let probes = &mut spec.run.probes.iter();
        let n = probes.position(|p| which(&p.measure))?;
        Some(move |property, says, instead| {
            Lack::new(property, says, instead).at(format!("probes[{n}]"))
        })
    };
    let mut all = vec![];
    let bonds = |m: &Measure| matches!(m, Measure::CrackTip(_) | Measure::Fragments { .. });
    let atoms = spec.potential().is_some();
    all.extend(first(&bonds).filter(|_| atoms).map(|lack| {
        lack(
            Property::OfNow,
            "cracks and fragments are of bonds of the reference, and these atoms are near each other now",
            "leave the probe out",
        )
    }));
    let Some(lack) = first(&|m| matches!(m, Measure::JIntegral(_))) else {
        return all;
    };
    all.push(lack(
        Property::Inertia,
        "a contour integral needs equilibrium: in motion the inertia inside it counts, too",
        "write [statics] instead of [run]",
    ));
    if spec.bonds.smooth.is_none() {
        all.push(lack(
            Property::Potentials,
            "a contour goes through a solid",
            "leave it out",
        ));
    }
    all
}

/// Has every pair of materials the same constants both ways round?
fn mirrored(spec: &Spec) -> bool {
    let n = spec.materials.len();
    let fits = spec.interactions.pairs.len() == n * n;
    let alike = |a: usize, b: usize| {
        spec.interactions.pairs[a * n + b].law == spec.interactions.pairs[b * n + a].law
    };
    !fits || (0..n).all(|a| (0..a).all(|b| alike(a, b)))
}

fn of_diffusions(spec: &Spec) -> Vec<Lack> {
    let mut all = vec![];
    if !spec.interactions.diffusions.is_empty() {
        let says = "heat or a species spreads in time";
        let instead = "leave out heat and species";
        all.push(Lack::new(Property::Proportional, says, instead));
    }
    for t in &spec.interactions.diffusions {
        if t.conditions.iter().any(|c| c.kind.depends_on_time()) {
            let name = t.quantity.name();
            let says = format!("a boundary condition of {name} depends on t");
            let lack = Lack::new(Property::TwoStages, says, "leave t out of it");
            all.push(lack.at(name));
        }
    }
    let mut diffusions = spec.interactions.diffusions.iter();
    if diffusions.any(DiffusionSpec::expands) {
        let says = "a body that expands has left its reference";
        let instead = "leave expansion and swelling out";
        all.push(Lack::new(Property::Memoryless, says, instead));
    }
    let steady = |t: &DiffusionSpec| {
        t.quantity == Quantity::Heat && matches!(t.method, DiffusionMethod::Steady { .. })
    };
    if spec.interactions.diffusions.iter().any(steady) {
        let says = "a steady temperature is that which the held places and the bonds of now say";
        let instead = "write method = \"implicit\" in [heat] with steps as long as you like";
        all.push(Lack::new(Property::Transient, says, instead));
    }
    all
}

/// Of statics, and of what is in equilibrium before it moves.
fn of_statics(spec: &Spec) -> Vec<Lack> {
    let mut all = vec![];
    if let Some(preload) = &spec.run.preload {
        all.extend(of_preload(preload));
        let free = |motion: &RigidBodyMotion| matches!(motion, RigidBodyMotion::Free(_));
        if let Some(n) = (preload.rigid_bodies.iter()).position(|i| free(&i.motion)) {
            let says = "a rigid body with a mass is moved by forces";
            let instead = "leave mass and density out, or write stage = \"dynamics\"";
            let lack = Lack::new(Property::Motionless, says, instead);
            all.push(lack.at(format!("preload.rigid_bodies[{n}]")));
        }
    }
    let Some(statics) = spec.run.schedule.statics() else {
        return all;
    };
    let says = "statics looks for one state that is at rest";
    all.push(Lack::new(
        Property::Motion,
        says,
        "take [run] with integrator = \"verlet\" or \"newmark\"",
    ));
    let newton = "write method = \"newton\"";
    match statics.method {
        Method::Linear => {
            let says = "linear statics is about the reference";
            all.push(Lack::new(Property::Newton, says, newton));
            all.push(Lack::new(Property::BeyondReference, says, newton));
        }
        Method::Newton | Method::Relaxation | Method::Fire => {
            let says = "this method goes beyond the reference";
            let instead = "write method = \"linear\", or leave it out";
            all.push(Lack::new(Property::AboutReference, says, instead));
        }
    }
    if statics.method.minimizes() {
        let says = "this method finds states under loads that are given";
        all.push(Lack::new(Property::Newton, says, newton));
    }
    if statics.solver == Solver::ConjugateGradients {
        let says = "conjugate gradients solve equations of one sign";
        let lack = Lack::new(Property::AnySign, says, "leave solver out");
        all.push(lack.at("statics.solver"));
    }
    if statics.cycles.is_some() {
        let says = "cycles say the greatest load";
        let lack = Lack::new(Property::KnownLoad, says, "leave cycles out");
        all.push(lack.at("statics.cycles"));
    }
    all
}

/// Of statics that motion follows.
fn of_preload(preload: &PreloadSpec) -> Vec<Lack> {
    let mut all = vec![];
    if preload.statics.method == Method::Linear {
        let says = "a linear solution is no equilibrium of the law that moves the body: motion would begin with a jolt";
        let instead = "leave method out, or write method = \"newton\"";
        let lack = Lack::new(Property::Nonlinear, says, instead);
        all.push(lack.at("preload.statics.method"));
    }
    if preload.statics.control != Control::Load {
        let says = "statics that follows a path ends at any load";
        let lack = Lack::new(Property::TwoStages, says, "leave control out");
        all.push(lack.at("preload.statics.control"));
    }
    if preload.statics.cycles.is_some() {
        let says = "cycles of fatigue do not move a body";
        let lack = Lack::new(Property::TwoStages, says, "leave cycles out");
        all.push(lack.at("preload.statics.cycles"));
    }
    if let Some(n) = (preload.cuts.iter()).position(|c| c.kind == CrackKind::Excluded) {
        let says = "bonds that are loaded cannot be made never to have been";
        let instead = "write kind = \"broken\", or leave it out";
        let lack = Lack::new(Property::TwoStages, says, instead);
        all.push(lack.at(format!("preload.cuts[{n}]")));
    }
    all
}

/// Of atoms that nodes carry along.
fn of_atoms(spec: &Spec) -> Vec<Lack> {
    let mut all = vec![];
    if spec.materials.len() > 1 {
        let says = "several materials have no nodes in common";
        all.push(Lack::new(
            Property::KinematicPoints,
            says,
            "give the atoms one material",
        ));
    }
    if spec.loading.thermal.is_some() {
        let says = "atoms that are carried along have no thermal motion of their own";
        all.push(
            Lack::new(
                Property::KinematicPoints,
                says,
                "leave initial_velocities out",
            )
            .at("initial_velocities"),
        );
    }
    let says = "what breaks are bonds between the atoms, and points are nodes";
    for (path, there) in [
        ("toughness[0]", !spec.damage.toughness.is_empty()),
        ("healing", spec.damage.healing.is_some()),
    ] {
        if there {
            all.push(Lack::new(Property::KinematicPoints, says, "leave it out").at(path));
        }
    }
    if matches!(&spec.body, BodySpec::Cloud(cloud) if !cloud.velocity.is_empty()) {
        let says = "the file has velocities of atoms";
        let instead = "give the places alone; velocities of nodes are those of [[initial]]";
        all.push(Lack::new(Property::KinematicPoints, says, instead));
    }
    all
}

/// Of what bonds bear, in all materials alike.
fn of_strength(spec: &Spec) -> Vec<Lack> {
    let mut all = vec![];
    let changes = |factor: &ToughnessFactor| match factor {
        ToughnessFactor::Stretch(e) | ToughnessFactor::Energy(e) => e.depends_on_time(),
        ToughnessFactor::Temperature(_) => true,
        ToughnessFactor::NoFailure => false,
    };
    if let Some(n) = (spec.damage.toughness.iter()).position(|t| changes(&t.factor)) {
        let says = "this toughness changes with t";
        let lack = Lack::new(Property::ConstantStrength, says, "leave t out of it");
        all.push(lack.at(format!("toughness[{n}]")));
    }
    let breaks = spec.materials.iter().any(|m| m.fracture.is_some())
        || spec
            .interactions
            .interfaces
            .iter()
            .any(|i| i.fracture.is_some());
    if breaks && spec.damage.breakage == Breakage::AfterForce {
        let says = "bonds that act once more in the step in which they break";
        let lack = Lack::new(Property::EndsAtOnce, says, "leave breakage out");
        all.push(lack.at("materials[0].fracture"));
    }
    if spec.run.schedule.stepper == Stepper::Still {
        let says = "points stand still";
        let instead = "take [run] with integrator = \"verlet\" or \"newmark\"";
        for property in [Property::Motion, Property::Deformation] {
            all.push(Lack::new(property, says, instead));
        }
    }
    all
}

fn of_material(n: usize, m: &MaterialSpec, spec: &Spec, registry: &Registry) -> Vec<Lack> {
    let mut all = vec![];
    let name = match &m.law {
        LawSpec::Atoms(_) | LawSpec::Micromoduli(_) => {
            all.extend(beside_others(&m.law).map(|l| l.at(format!("materials[{n}].law"))));
            let says = "atoms and given micromoduli conduct nothing: their bonds are not those of a continuum";
            let instead = "take a law of solids (pmb, lps, …)";
            all.push(Lack::new(Property::Continuum, says, instead));
            ""
        }
        LawSpec::Named(law) => law.name.as_str(),
        LawSpec::Pmb(_)
        | LawSpec::Lps(_)
        | LawSpec::Lps3d { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_) => "",
    };
    all.extend(of_linear_laws(n, m, spec));
    if registry.own_critical_stretch(name) {
        let says = format!("the law {name} has its critical stretch among its constants");
        all.push(Lack::new(Property::StrengthOfPoints, says, ""));
    }
    if registry.bond_classes(name) {
        let says = format!(
            "bonds of the law {name} break at stretches of two kinds, and a factor is of one"
        );
        all.push(Lack::new(Property::StrengthTimesFactor, says, ""));
    }
    if let Some(fracture) = m.fracture {
        let path = format!("materials[{n}].fracture");
        all.extend(of_fracture(fracture, &path));
        if !registry.softens_to_zero(name) {
            let says = "this law breaks bonds abruptly: path following needs a softening law";
            let instead = "take a law whose bonds soften to nothing, or control = \"sequentially_linear\", which follows linear bodies bond after bond";
            all.push(Lack::new(Property::Fades, says, instead).at(path));
        }
    }
    all
}

/// What atoms and given micromoduli have not beside other bodies.
fn beside_others(law: &LawSpec) -> Option<Lack> {
    if let Some(linear) = law.micromoduli() {
        let says = "loads or masses of a condensed body are those of all its points together";
        let instead = "condense it without loads, with lumped masses";
        return linear
            .is_coupled()
            .then(|| Lack::new(Property::SideBySide, says, instead));
    }
    let says = "how atoms act on each other is what their potential says, and neither a stiffness of contact nor one of bonds with a continuum follows from it";
    let instead =
        "make one body of the atoms, with a [[pair]] for unlike ones, or take pmb, lps or springs";
    Some(Lack::new(Property::Meets, says, instead))
}

/// Of laws with kernels of their own, and of potentials.
fn of_linear_laws(n: usize, m: &MaterialSpec, spec: &Spec) -> Vec<Lack> {
    let mut all = vec![];
    let path = format!("materials[{n}].law");
    if Solid::of_law(spec.space.dimension, spec.space.plane, &m.law).is_some() {
        let says = "in a state-based law a bond also acts through the pressure of its ends";
        let instead = "write law = { pmb = ... } or springs, or give parts of the body materials of their own";
        all.push(Lack::new(Property::BondByBond, says, instead));
    }
    match &m.law {
        LawSpec::Springs(_) | LawSpec::Micromoduli(_) => {
            let says =
                "springs and micromoduli have no bonds that break and no contact of their own";
            let instead = "remove fracture, contact and pre-cracks, or take pmb or lps";
            all.push(Lack::new(Property::Separates, says, instead).at(path));
            if m.law.micromoduli().is_some_and(|b| b.couples_masses()) {
                let says = "points whose masses are coupled have no velocities that are independent of each other";
                let instead = "take a body with lumped masses: peridyne coarsen --mass lumped";
                all.push(Lack::new(Property::Independent, says, instead));
            }
        }
        LawSpec::Atoms(_) => {
            if (m.fracture).is_some_and(|f| matches!(f.criterion, Criterion::BondEnergy(_))) {
                let says =
                    "the work on bonds of a potential is known where atoms move, step by step";
                let instead = "give critical_stretch";
                all.push(Lack::new(Property::PresentStretch, says, instead).at(&*path));
            }
            let says = "how strongly atoms act on each other at every distance is what their potential says";
            let instead = "take a law of solids (pmb, lps, …)";
            all.push(Lack::new(Property::Weighed, says, instead));
            if spec.interactions.contact.is_some() {
                let says = "how atoms repel each other is what their potential says, and no stiffness of contact follows from it";
                let instead = "remove contact: of family = \"neighbours\" all atoms that are near repel; or take pmb or lps";
                all.push(Lack::new(Property::Separates, says, instead).at(path));
            }
        }
        LawSpec::Pmb(_)
        | LawSpec::Lps(_)
        | LawSpec::Lps3d { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Named(_) => {}
    }
    all
}

/// Of the law of a material, for what its own bonds break by; `path` is where that is said.
pub(super) fn of_law(m: &MaterialSpec, path: &str, registry: &Registry) -> Vec<Lack> {
    let mut all = vec![];
    let mut lack = |property, says: String, instead| {
        all.push(Lack::new(property, says, instead).at(path));
    };
    let stretch = |c: Criterion| matches!(c, Criterion::Stretch(_) | Criterion::Energy(_));
    if (m.fracture).is_some_and(|f| f.alpha != 0.0 && !stretch(f.criterion)) {
        let says = "strengthening under compression (alpha) is of critical stretches alone: no law is known of a work, stress or strain that grows with it";
        lack(Property::OtherMeasures, says.into(), "leave alpha out");
    }
    match &m.law {
        LawSpec::Named(law) => {
            let name = law.name.as_str();
            if registry.own_critical_stretch(name) || registry.bond_classes(name) {
                let says = format!(
                    "the law {name} has a critical stretch among its constants: its bonds break by nothing else"
                );
                let instead = "leave criterion, rate and fatigue out";
                lack(Property::OtherMeasures, says, instead);
            }
            if registry.own_critical_stretch(name) {
                let says = format!(
                    "the law {name} has its critical stretch among its constants, where its bonds have softened to nothing"
                );
                let instead = "take a law whose bonds are brittle";
                lack(Property::StrengthOfPressed, says, instead);
            }
            if !law.isotropic {
                let says =
                    format!("a bond of the law {name} has another energy in every direction");
                let instead = "give critical_stretch instead";
                lack(Property::EnergyOfStretch, says, instead);
            }
            if registry.tangential_stiffness(name) {
                let says = format!("bonds of the law {name} store energy by turning, too");
                let instead =
                    "write criterion = \"bond_energy\" beside energy, or give critical_stretch";
                lack(Property::EnergyOfStretch, says, instead);
            }
            let memory = registry.descriptor(name).map(|d| d.memory);
            let elastic = law.isotropic && memory == Some(Memory::Nothing);
            if !elastic && !registry.across(name) {
                let says = "the stress across plane strain does not follow from that in the plane: this law is anisotropic, or its bonds soften";
                let instead = "give another criterion, or take three dimensions";
                lack(Property::StressAcross, says.into(), instead);
            }
        }
        LawSpec::Atoms(_) => {
            let works = |f: FractureSpec| {
                let plain = f.rate.is_none() && f.fatigue.is_none();
                plain && matches!(f.criterion, Criterion::BondEnergy(_))
            };
            if !m.fracture.is_none_or(works) {
                let says = "the bonds of a potential know how far they are stretched and the work that was done on them, and no stress, rate or age";
                let instead = "give critical_stretch, or energy with criterion = \"bond_energy\"";
                lack(Property::OtherMeasures, says.into(), instead);
            }
            let says = "the energy of a stretched bond of a potential is no square of its stretch";
            let instead =
                "write criterion = \"bond_energy\" beside energy, or give critical_stretch";
            lack(Property::EnergyOfStretch, says.into(), instead);
        }
        LawSpec::Pmb(_)
        | LawSpec::Lps(_)
        | LawSpec::Lps3d { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_)
        | LawSpec::Micromoduli(_) => {}
    }
    all
}

/// Of bonds between bodies, for what they break by; `path` is where that is said.
pub(super) fn of_interface(i: &InterfaceSpec, path: &str, registry: &Registry) -> Vec<Lack> {
    let mut all = of_law(&i.material(), path, registry);
    let points = |f: FractureSpec| {
        matches!(
            f.criterion,
            Criterion::VonMises(_) | Criterion::PlasticStrain(_)
        )
    };
    if i.fracture.is_some_and(points) {
        let says = "stress and plastic strain are of points in a body, and bonds of an interface join those of two";
        let instead = "give critical_stretch or energy";
        all.push(Lack::new(Property::OtherMeasures, says, instead).at(path));
    }
    all
}

fn of_fracture(fracture: FractureSpec, path: &str) -> Vec<Lack> {
    let mut all = vec![];
    if fracture.alpha != 0.0 {
        let says =
            "strengthening under compression (alpha) makes critical stretches follow the load";
        for property in [Property::ConstantStrength, Property::StrengthOfPoints] {
            all.push(Lack::new(property, says, "leave alpha out").at(path));
        }
    }
    // the work on a bond of a linear body is that of the load
    let of_load = matches!(
        fracture.criterion,
        Criterion::VonMises(_) | Criterion::BondEnergy(_)
    );
    let of_now = !fracture.remembers() || of_load;
    if !of_now || fracture.rate.is_some() || fracture.fatigue.is_some() {
        let says = "these bonds break by more than the stretch that they have now";
        let instead = "give critical_stretch or energy without criterion, rate and fatigue";
        let lack = Lack::new(Property::PresentStretch, says, instead);
        all.push(lack.at(path));
    }
    if fracture.rate.is_some() {
        let says = "these bonds break by how fast they are stretched";
        let lack = Lack::new(Property::Timeless, says, "leave rate out");
        all.push(lack.at(format!("{path}.rate")));
    }
    match fracture.criterion {
        Criterion::VonMises(_) | Criterion::PlasticStrain(_) => {
            let says = "a limit of stress or of plastic strain has no factors";
            all.push(Lack::new(Property::StrengthTimesFactor, says, ""));
        }
        Criterion::BondEnergy(_) => {
            let says = "these bonds break by a work, their part of a fracture energy";
            let instead = "give critical_stretch, or energy without criterion";
            let lack = Lack::new(Property::StretchAtEveryHorizon, says, instead);
            all.push(lack.at(path));
        }
        Criterion::Stretch(_) | Criterion::Energy(_) => {}
    }
    all
}
