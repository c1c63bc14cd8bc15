//! What the parts of a spec ask for.

use super::{Need, Property};
use crate::constitutive::{breaking, breaks};
use crate::spec::{
    BodySpec, Control, Criterion, FamilyChoice, FractureSpec, Influence, LawSpec, MaterialSpec,
    Method, Plane, Spec, Statics, Stepper, ToughnessFactor,
};

pub(super) fn of(spec: &Spec) -> Vec<Need> {
    let mut all = of_bodies(spec);
    all.extend(of_atoms(spec));
    all.extend(of_contact(spec));
    all.extend(of_strength(spec));
    all.extend(of_stages(spec));
    if let Some(statics) = spec.run.schedule.statics() {
        all.extend(of_statics(statics));
    }
    all
}

fn of_bodies(spec: &Spec) -> Vec<Need> {
    let mut all = vec![];
    if matches!(spec.body, BodySpec::Several(_)) {
        let why = ", and several bodies have bonds of their own each";
        all.push(Need::new(Property::SideBySide, "body", why, ""));
        let why = ", and several bodies meet by these alone";
        all.push(Need::new(Property::Meets, "body", why, ""));
    }
    if !spec.bonds.factors.is_empty() {
        let why = ", and bond stiffness scaling needs a bond-based law";
        all.push(Need::new(Property::BondByBond, "bonds[0]", why, ""));
    }
    if spec.bonds.influence != Influence::Constant {
        let why = ", and an influence function weighs bonds of a continuum";
        let instead = "leave influence out";
        all.push(Need::new(Property::Weighed, "influence", why, instead));
    }
    if spec.interactions.contact.is_some() || breaks(spec) {
        all.push(Need::new(Property::Separates, "materials", "", ""));
    }
    if let Some(path) = breaking(spec) {
        all.push(Need::new(Property::Breaks, path, "", ""));
    }
    if spec.bonds.family == FamilyChoice::Stencil {
        all.push(Need::new(Property::OfStencil, "family", "", ""));
    }
    for diffusion in &spec.interactions.diffusions {
        let why = ", through which heat and species go";
        let name = diffusion.quantity.name();
        all.push(Need::new(Property::Continuum, name, why, ""));
    }
    if spec.bonds.smooth.is_some() {
        let why = ", and these are carried along by nodes";
        all.push(Need::new(
            Property::KinematicPoints,
            "smooth",
            why,
            "leave smooth out",
        ));
    }
    if let Some(heat) = spec.interactions.diffusions.iter().find(|t| t.deformation) {
        all.push(Need::new(
            Property::Deformation,
            heat.quantity.name(),
            ", and heat of deformation is made where they move",
            "leave deformation out",
        ));
    }
    let of_one = |path: &str, why, instead| Need::new(Property::OneHorizon, path, why, instead);
    if spec.bonds.surface.is_some() {
        let why = ", and exact surfaces are those of the stencil of a lattice";
        all.push(of_one("variable_horizon", why, "leave surface out"));
    }
    if !spec.interactions.pairs.is_empty() {
        let why = ", and so have pairs of materials: a bond has one";
        all.push(of_one("variable_horizon", why, ""));
    }
    if spec.bonds.variable_horizon.is_some() {
        all.push(Need::new(
            Property::VariableHorizons,
            "variable_horizon",
            "",
            "",
        ));
        all.push(Need::new(
            Property::StretchAtEveryHorizon,
            "variable_horizon",
            ", which follows from one horizon, and every point has another",
            "leave variable_horizon out",
        ));
    }
    all
}

/// Of laws of solids, of potentials and of atoms that move.
fn of_atoms(spec: &Spec) -> Vec<Need> {
    let mut all = vec![];
    let path = "materials[0].law";
    let mut laws = spec.materials.iter().map(|m| &m.law);
    if laws.any(|l| l.potential().is_none()) {
        all.push(Need::new(Property::Solids, path, "", ""));
    } else if !spec.materials.is_empty() {
        let why = ", and this law is an interatomic potential";
        all.push(Need::new(Property::Potentials, path, why, ""));
    }
    if spec.bonds.family != FamilyChoice::Reference {
        all.push(Need::new(Property::OfNow, "family", "", ""));
    }
    if spec.loading.thermal.is_some() {
        let why = ", which a Maxwell-Boltzmann distribution of points is";
        all.push(Need::new(
            Property::Independent,
            "initial_velocities",
            why,
            "",
        ));
    }
    let linear = |l: &LawSpec| matches!(l, LawSpec::Springs(_) | LawSpec::Micromoduli(_));
    let mut laws = spec.materials.iter().map(|m| &m.law);
    if !laws.all(linear) {
        all.push(Need::new(Property::Nonlinear, "materials", "", ""));
    }
    all
}

/// Of what bonds of a material, or of an interface, break by; `path` is where that is said.
pub(super) fn of_fracture(spec: &Spec, fracture: Option<FractureSpec>, path: &str) -> Vec<Need> {
    let mut all = vec![];
    let Some(fracture) = fracture else {
        return all;
    };
    if fracture.remembers() {
        let why = ", and the criterion needs more than the present stretch";
        all.push(Need::new(Property::OtherMeasures, path, why, ""));
    }
    if fracture.alpha != 0.0 {
        let why = ", and strengthening under compression (alpha) would raise it";
        let instead = "leave alpha out";
        all.push(Need::new(Property::StrengthOfPressed, path, why, instead));
    }
    let in_plane_strain = spec.space.dimension == 2 && spec.space.plane == Plane::Strain;
    match fracture.criterion {
        Criterion::Energy(_) => {
            let why = ": a fracture energy gives no critical stretch";
            all.push(Need::new(Property::EnergyOfStretch, path, why, ""));
        }
        Criterion::VonMises(_) if in_plane_strain => {
            all.push(Need::new(Property::StressAcross, path, "", ""));
        }
        Criterion::VonMises(_)
        | Criterion::Stretch(_)
        | Criterion::BondEnergy(_)
        | Criterion::PlasticStrain(_) => {}
    }
    all
}

fn of_contact(spec: &Spec) -> Vec<Need> {
    let mut all = vec![];
    let Some(contact) = &spec.interactions.contact else {
        return all;
    };
    if contact.cohesion.is_some() {
        all.push(Need::new(
            Property::Unbonded,
            "contact.cohesion",
            ", which would attract each other as well",
            "leave out cohesion",
        ));
    }
    if contact.conductance.is_some() {
        let need = |property, why| {
            let instead = "leave conductance out";
            Need::new(property, "contact.conductance", why, instead)
        };
        all.extend([
            need(
                Property::Transient,
                ", and contact comes and goes: a body that nothing else holds has none without it",
            ),
            need(
                Property::Unbonded,
                ": its bonds conduct, and contact would conduct beside them",
            ),
            need(
                Property::Faces,
                ", and contact does not know which way the faces of such points look",
            ),
        ]);
    }
    all
}

/// Of what bonds bear, and of bonds that heal.
fn of_strength(spec: &Spec) -> Vec<Need> {
    let mut all = vec![];
    if let Some(n) = (spec.materials.iter()).position(|m| m.fracture.is_some_and(|f| f.remembers()))
    {
        let path = format!("materials[{n}].fracture");
        all.push(Need::new(
            Property::ConstantsOfPoints,
            path,
            ", with critical stretches and no other measure",
            "give critical_stretch or energy alone",
        ));
    }
    if !spec.damage.toughness.is_empty() {
        let why = ", which a toughness of places gives to points";
        let need = |property| {
            let instead = "leave toughness out";
            Need::new(property, "toughness[0]", why, instead)
        };
        all.push(need(Property::ConstantsOfPoints));
        all.push(need(Property::StrengthOfPoints));
    }
    let energy = |m: &MaterialSpec| {
        m.fracture
            .is_some_and(|f| matches!(f.criterion, Criterion::Energy(_)))
    };
    // of several bodies each is asked alone
    let alone = spec.body.pieces().is_empty();
    if alone && spec.bonds.variable_horizon.is_some() && spec.materials.iter().any(energy) {
        let why = ", and what a fracture energy means follows the horizon of each point";
        let instead = "give critical_stretch, or leave variable_horizon out";
        all.push(Need::new(
            Property::StrengthOfPoints,
            "variable_horizon",
            why,
            instead,
        ));
    }
    let factor = |factor: &ToughnessFactor| !matches!(factor, ToughnessFactor::NoFailure);
    if let Some(n) = (spec.damage.toughness.iter()).position(|t| factor(&t.factor)) {
        all.push(Need::new(
            Property::StrengthTimesFactor,
            format!("toughness[{n}]"),
            ": only no_failure goes with it",
            "write no_failure = true, or leave toughness out",
        ));
    }
    if spec.damage.healing.is_some() {
        all.push(Need::new(
            Property::Motion,
            "healing",
            ", and bonds heal in motion, which brings their points back",
            "leave healing out",
        ));
    }
    all
}

/// Of statics before motion, and of implicit steps.
fn of_stages(spec: &Spec) -> Vec<Need> {
    let mut all = vec![];
    if spec.run.preload.is_some() {
        all.push(Need::new(
            Property::TwoStages,
            "preload.statics",
            ", and in motion, which begins where statics ends, t begins again",
            "leave [statics] out and load the body in time",
        ));
        all.push(Need::new(
            Property::Motionless,
            "preload.statics",
            ", and in equilibrium nothing moves",
            "",
        ));
    }
    let explicit = spec.run.schedule.stepper == Stepper::Verlet && spec.run.preload.is_none();
    if !explicit {
        all.push(Need::new(
            Property::Symmetric,
            "pairs",
            ", and without an energy explicit steps alone know where that goes",
            "take integrator = \"verlet\" without [statics]",
        ));
    }
    // motion that follows on statics is measured by the same probes
    if spec.run.schedule.statics().is_none() {
        all.push(Need::new(Property::Inertia, "schedule", "", ""));
    }
    match spec.run.schedule.stepper {
        Stepper::Newmark(_) => all.push(Need::new(
            Property::EndsAtOnce,
            "schedule.integrator",
            " have no place in an implicit step",
            "take integrator = \"verlet\"",
        )),
        Stepper::Verlet | Stepper::Statics(_) | Stepper::Still => {}
    }
    all
}

fn of_statics(statics: Statics) -> Vec<Need> {
    let mut all = vec![Need::new(
        Property::Timeless,
        "statics",
        ", and in equilibrium nothing moves",
        "write [run]",
    )];
    if statics.method == Method::Linear {
        all.push(Need::new(
            Property::Memoryless,
            "statics.method",
            ", and a linear solution knows the reference alone",
            "write method = \"newton\"",
        ));
    }
    if statics.cycles.is_some() {
        all.extend([
            Need::new(
                Property::BeyondReference,
                "statics.method",
                ", and fatigue changes its bonds",
                "",
            ),
            Need::new(
                Property::InProportion,
                "statics.cycles",
                ", and a cycle is known by its greatest load and the ratio of its least to that",
                "leave cycles out",
            ),
            Need::new(
                Property::SameInCycles,
                "statics.cycles",
                ": boundary conditions are the greatest of each cycle, and stay as they are",
                "",
            ),
        ]);
    }
    all.extend(of_control(statics.control));
    all
}

fn of_control(control: Control) -> Vec<Need> {
    let leave = "leave control out";
    let sought = [
        Need::new(
            Property::Proportional,
            "statics.control",
            ", and t is the load factor, which is sought",
            leave,
        ),
        Need::new(
            Property::PresentStretch,
            "statics.control",
            ", by which alone the load at which they break is known",
            leave,
        ),
        Need::new(
            Property::KnownLoad,
            "statics.control",
            ", which is sought here",
            leave,
        ),
    ];
    let own = match control {
        Control::Load => return vec![],
        Control::SequentiallyLinear => vec![
            Need::new(
                Property::AboutReference,
                "statics.control",
                ", and sequentially linear analysis needs a body that is linear about the reference",
                "",
            ),
            Need::new(
                Property::ConstantStrength,
                "statics.control",
                ", and sequentially linear analysis needs strengths that are known before any load",
                "",
            ),
        ],
        Control::IndirectDisplacement(_) | Control::ArcLength(_) => vec![
            Need::new(
                Property::Newton,
                "statics.method",
                ", and the path of a body is followed by Newton's method",
                "",
            ),
            Need::new(
                Property::AnySign,
                "statics.solver",
                ", and where the load falls tangents have any",
                "",
            ),
            Need::new(
                Property::Fades,
                "statics.control",
                ": the load jumps there, and has no path",
                "",
            ),
        ],
    };
    own.into_iter().chain(sought).collect()
}
