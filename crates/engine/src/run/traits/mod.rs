//! Which parts of a spec do not go together. Each says what it has not ([`Lack`]) or what it asks for ([`Need`]), whoever else is there: that two of them
//! meet in a property is found here, and written down nowhere.

mod lacks;
mod needs;
mod system;

pub(super) use system::{of_control, of_implicit_steps, of_statics};

use crate::constitutive::Registry;
use crate::error::BuildError;
use crate::message;
use crate::quantity::Message;
use crate::spec::{BodySpec, Spec};

/// What parts of a spec ask for and others have not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Property {
    /// Forces have slopes.
    Tangent,
    /// Action is reaction: forces are the slope of an energy.
    Symmetric,
    /// Goes without motion.
    Motionless,
    /// May come to an equilibrium at all.
    Balance,
    /// Answers alike however fast it is deformed.
    Timeless,
    /// Remembers nothing.
    Memoryless,
    /// Loads are what they are wherever points go.
    DeadLoads,
    /// Slopes do not jump: Newton's method converges without inertia.
    Continuous,
    /// Stays about the reference.
    AboutReference,
    /// Sees states beyond the reference.
    BeyondReference,
    /// Is Newton's method.
    Newton,
    /// Solves equations of any sign.
    AnySign,
    /// Nothing pulls in the reference.
    ForceFree,
    /// Proportional to a factor of the load.
    Proportional,
    /// The greatest load is known before.
    KnownLoad,
    /// Forces do not jump where bonds end.
    Fades,
    /// Bonds bear the same whatever acts on the body.
    ConstantStrength,
    /// Bonds end by the stretch or the stress that they have now.
    PresentStretch,
    /// What bonds bear is known whatever the horizon.
    StretchAtEveryHorizon,
    /// Bonds may break by more than their stretch of now.
    OtherMeasures,
    /// Bonds may break, or be cut, and points touch.
    Separates,
    /// Bonds end for good where they break or are cut.
    Breaks,
    /// The energy of a bond is that of the square of its stretch.
    EnergyOfStretch,
    /// The stress across plane strain is known.
    StressAcross,
    /// Goes with laws of solids.
    Solids,
    /// Goes with interatomic potentials.
    Potentials,
    /// Goes with those that are near now.
    OfNow,
    /// Its family may be the stencil of a lattice.
    OfStencil,
    /// Goes with laws that are not linear.
    Nonlinear,
    /// Goes where points have inertia.
    Inertia,
    /// Points move independently of each other.
    Independent,
    /// What a bond pulls is its own.
    BondByBond,
    /// What bonds bear may be another one at every point.
    StrengthOfPoints,
    /// What bonds bear may grow where points are pushed together.
    StrengthOfPressed,
    /// What bonds bear may be multiplied.
    StrengthTimesFactor,
    /// Ends within the step in which it is found.
    EndsAtOnce,
    /// May be part of statics that motion follows.
    TwoStages,
    /// May be carried along by nodes.
    KinematicPoints,
    /// Bonds are those of a continuum.
    Continuum,
    /// Bonds may be weighed by an influence function.
    Weighed,
    /// All points have the horizon of the body.
    OneHorizon,
    /// Every point may have another horizon.
    VariableHorizons,
    /// Bonds are those of their points, not of a table of pairs.
    ConstantsOfPoints,
    /// May stand beside other bodies.
    SideBySide,
    /// May touch other bodies, or be bonded to them.
    Meets,
    /// No bonds between bodies.
    Unbonded,
    /// Points go away and come back.
    Motion,
    /// Points go anywhere.
    Deformation,
    /// Its faces are known.
    Faces,
    /// Values at the end of a step follow from those at its beginning.
    Transient,
    /// The same in every cycle of a load.
    SameInCycles,
    /// Answers to a part of a load by that part.
    InProportion,
}

impl Property {
    /// Does one of several bodies have it, whatever the others have?
    fn is_of_a_body(self) -> bool {
        matches!(
            self,
            Property::OneHorizon
                | Property::VariableHorizons
                | Property::OfStencil
                | Property::Nonlinear
                | Property::StretchAtEveryHorizon
                | Property::OtherMeasures
                | Property::Separates
                | Property::ConstantsOfPoints
                | Property::Weighed
        )
    }
}

/// A part of a spec that has not some property.
pub(super) struct Lack {
    pub property: Property,
    /// `None`: what asks for it is where the mistake is.
    pub path: Option<String>,
    /// Who it is and how it is: the first half of a sentence.
    pub says: Message,
    /// What to write in its place.
    pub instead: &'static str,
}

/// A part of a spec that asks for one.
pub(super) struct Need {
    pub property: Property,
    pub path: String,
    /// Why: the second half of the sentence.
    pub why: &'static str,
    pub instead: &'static str,
}

impl Lack {
    fn new(property: Property, says: impl Into<Message>, instead: &'static str) -> Lack {
        Lack {
            property,
            path: None,
            says: says.into(),
            instead,
        }
    }

    /// The mistake is there, whoever asks.
    fn at(self, path: impl Into<String>) -> Lack {
        Lack {
            path: Some(path.into()),
            ..self
        }
    }
}

impl Need {
    fn new(
        property: Property,
        path: impl Into<String>,
        why: &'static str,
        instead: &'static str,
    ) -> Need {
        Need {
            property,
            path: path.into(),
            why,
            instead,
        }
    }
}

/// Does everybody have what others ask for?
///
/// # Errors
/// The first need that somebody does not meet: both, and what to write in place of either.
pub(super) fn met(needs: Vec<Need>, lacks: &[Lack]) -> Result<(), BuildError> {
    for need in needs {
        if let Some(lack) = lacks.iter().find(|l| l.property == need.property) {
            let path = lack.path.clone().unwrap_or(need.path);
            let both = [need.instead, lack.instead];
            let instead: Vec<&str> = both.into_iter().filter(|i| !i.is_empty()).collect();
            let message = message![lack.says.clone(), need.why];
            return Err(BuildError::unsupported(path, message).help(instead.join(", or ")));
        }
    }
    Ok(())
}

/// Do the parts of a spec go together, and those of each of its materials and interfaces? Of several bodies what they share; each is asked alone what is
/// its own, its materials among that.
pub(super) fn agree(spec: &Spec, registry: &Registry) -> Result<(), BuildError> {
    let several = matches!(spec.body, BodySpec::Several(_));
    let mut needs = needs::of(spec);
    needs.retain(|n| !(several && n.property.is_of_a_body()));
    met(needs, &lacks::of(spec, registry))?;
    for (n, m) in spec.materials.iter().enumerate().filter(|_| !several) {
        let path = format!("materials[{n}].fracture");
        let needs = needs::of_fracture(spec, m.fracture, &path);
        met(needs, &lacks::of_law(m, &path, registry))?;
    }
    for (n, i) in spec.interactions.interfaces.iter().enumerate() {
        let path = format!("interface[{n}].fracture");
        let needs = needs::of_fracture(spec, i.fracture, &path);
        met(needs, &lacks::of_interface(i, &path, registry))?;
    }
    Ok(())
}
