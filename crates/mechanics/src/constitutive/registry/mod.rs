//! The registry: laws by their names, each a file of its own and a line in the list of its folder. A program may put its own beside them.

mod atoms;
mod materials;

pub use atoms::{AnyPotentials, Neighbours};
pub(super) use materials::chosen;
pub use materials::{Chosen, Place, Softens, Stiffness};

use crate::boundary_condition::point_force::{self, OfFunction, Placed, PointForce, Seen};
use crate::constitutive::sweeps::general;
use crate::error::BuildError;
use crate::law::descriptor::{Descriptor, Registered, Wrong};
use crate::law::many_body;
use crate::law::material::{self, Kinds as _, Material};
use crate::law::potential::{self, Described, Kinds};
use crate::law::solid::linear::{self, Linear};
use crate::observe::Observable;
use crate::observe::observables;
use crate::space::Point;
use crate::space::lattice::LatticeKind;
use crate::spec::{ForceSpec, LawSpec, NamedLaw, Parameters, Spec};
use atoms::Atoms;
use materials::Materials;
use std::sync::Arc;

/// A law on the registry.
struct Entry {
    descriptor: Descriptor,
    runs: Runs,
}

/// What runs it.
enum Runs {
    /// A kernel of its own.
    Linear {
        law: fn(&Parameters) -> Result<LawSpec, String>,
        parameters: fn(&LawSpec) -> Option<Parameters>,
    },
    Material(Materials),
    /// It is a potential between atoms.
    Atoms(Atoms),
}

/// A force on the registry.
struct Force {
    descriptor: Descriptor,
    make: Box<MakeForce>,
}

type MakeForce = dyn Fn(&Parameters, &Placed) -> Result<Arc<dyn PointForce>, Wrong> + Send + Sync;

/// All that a spec can name: laws, potentials, observables, and forces on points.
#[derive(Clone)]
pub struct Registry {
    entries: Vec<Arc<Entry>>,
    observables: Vec<&'static Observable>,
    forces: Vec<Arc<Force>>,
}

impl Default for Registry {
    fn default() -> Registry {
        Registry::standard()
    }
}

impl Kinds for Registry {
    fn kind<P: Described>(&mut self) {
        self.put(P::descriptor(), Runs::Atoms(Atoms::of::<P>()));
    }
}

impl many_body::Kinds for Registry {
    fn many_body<F: many_body::Described>(&mut self) {
        self.put(F::descriptor(), Runs::Atoms(Atoms::of_many_body::<F>()));
    }
}

impl material::Kinds for Registry {
    fn law<M>(&mut self)
    where
        M: Registered + Material<1> + Material<2> + Material<3>,
    {
        self.put(M::descriptor(), Runs::Material(Materials::of::<M>()));
    }

    fn law_or_smaller<M, S>(&mut self, fits: fn(&Parameters) -> bool)
    where
        M: Registered + Material<1> + Material<2> + Material<3>,
        S: Registered + Material<1> + Material<2> + Material<3>,
    {
        let runs = Materials::of::<M>().or(fits, Materials::of::<S>());
        self.put(M::descriptor(), Runs::Material(runs));
    }

    fn solid<M>(&mut self)
    where
        M: Registered + Material<2> + Material<3>,
    {
        self.put(M::descriptor(), Runs::Material(Materials::of_solid::<M>()));
    }

    fn solid_or<M, O>(&mut self, fits: fn(&Parameters) -> bool)
    where
        M: Registered + Material<2> + Material<3>,
        O: Registered + Material<2> + Material<3>,
    {
        let other = Materials::of_solid::<O>();
        let runs = Materials::of_solid::<M>().or(fits, other);
        self.put(M::descriptor(), Runs::Material(runs));
    }
}

impl point_force::Kinds for Registry {
    fn force<F: point_force::Described>(&mut self) {
        let make = |p: &Parameters, on: &Placed| -> Result<Arc<dyn PointForce>, Wrong> {
            Ok(Arc::new(F::new(p, on)?))
        };
        self.put_force(F::descriptor(), Box::new(make));
    }
}

impl linear::Laws for Registry {
    fn linear<L: Linear>(&mut self) {
        let runs = Runs::Linear {
            law: L::law,
            parameters: L::parameters,
        };
        self.put(L::descriptor(), runs);
    }
}

impl Registry {
    /// The laws that come with the engine.
    pub fn standard() -> Registry {
        let mut registry = Registry {
            entries: vec![],
            observables: observables::ALL.to_vec(),
            forces: vec![],
        };
        linear::each(&mut registry);
        potential::each(&mut registry);
        many_body::each(&mut registry);
        material::each(&mut registry);
        point_force::each(&mut registry);
        registry
    }

    /// And one more; it takes the place of one of the same name.
    pub fn with<M>(mut self) -> Registry
    where
        M: Registered + Material<1> + Material<2> + Material<3>,
    {
        self.law::<M>();
        self
    }

    /// The same of a law that means nothing on a line.
    pub fn with_solid<M>(mut self) -> Registry
    where
        M: Registered + Material<2> + Material<3>,
    {
        self.solid::<M>();
        self
    }

    /// The same of a potential between atoms.
    pub fn with_potential<P: Described>(mut self) -> Registry {
        self.kind::<P>();
        self
    }

    /// The same of a column that follows from the state.
    pub fn with_observable(mut self, observable: &'static Observable) -> Registry {
        let name = &observable.declaration.name;
        self.observables.retain(|o| o.declaration.name != *name);
        self.observables.push(observable);
        self
    }

    /// The same of a force on the points of a set, for [`ConditionKind::Force`](crate::spec::ConditionKind::Force).
    pub fn with_force<F: point_force::Described>(mut self) -> Registry {
        point_force::Kinds::force::<F>(&mut self);
        self
    }

    /// The same of a force (force / volume) that is a function of what it sees. Its work is accounted for. What it does to the stability of
    /// explicit steps, the engine does not know.
    pub fn with_force_of(
        mut self,
        name: &'static str,
        force: impl Fn(&Seen) -> Point + Send + Sync + 'static,
    ) -> Registry {
        let force: Arc<dyn PointForce> = Arc::new(OfFunction(force));
        let make = move |_: &Parameters, _: &Placed| Ok(force.clone());
        let doc = "A force of the program.";
        self.put_force(Descriptor::new(name, doc), Box::new(make));
        self
    }

    fn put_force(&mut self, descriptor: Descriptor, make: Box<MakeForce>) {
        self.forces.retain(|f| f.descriptor.name != descriptor.name);
        self.forces.push(Arc::new(Force { descriptor, make }));
    }

    /// What the forces on points say of themselves.
    pub fn forces(&self) -> impl Iterator<Item = &Descriptor> {
        self.forces.iter().map(|f| &f.descriptor)
    }

    /// All observables, in the order in which they are listed.
    pub fn observables(&self) -> &[&'static Observable] {
        &self.observables
    }

    /// The observable of this name.
    pub fn observable(&self, name: &str) -> Option<&'static Observable> {
        let mut all = self.observables.iter().copied();
        all.find(|o| o.declaration.name == name)
    }

    fn force_of(&self, name: &str) -> Result<&Force, BuildError> {
        let found = self.forces.iter().find(|f| f.descriptor.name == name);
        found.map(Arc::as_ref).ok_or_else(|| {
            let known: Vec<&str> = self.forces().map(|d| d.name.as_ref()).collect();
            let known = known.join(", ");
            let message = format!("there is no force named {name}; the registry has {known}");
            BuildError::unknown("", name, message)
                .help("put it there: Registry::standard().with_force::<..>()")
        })
    }

    /// Do its constants fit a force? Defaults are filled in.
    ///
    /// # Errors
    /// There is none of this name, or constants that do not fit it; the path is the constant that is wrong, empty if it is not one alone.
    pub fn check_force(&self, force: &mut ForceSpec) -> Result<(), BuildError> {
        let descriptor = &self.force_of(&force.name)?.descriptor;
        let checked = descriptor.check_of("force", &mut force.parameters);
        checked.map_err(|(key, message)| BuildError::invalid(key, message))
    }

    /// A force of a spec, for the points of its set.
    ///
    /// # Errors
    /// As of [`Registry::check_force`], and what does not fit these points.
    pub fn force(&self, force: &ForceSpec, on: &Placed) -> Result<Arc<dyn PointForce>, BuildError> {
        let mut force = force.clone();
        self.check_force(&mut force)?;
        let made = (self.force_of(&force.name)?.make)(&force.parameters, on);
        made.map_err(|(key, message)| BuildError::invalid(key, message))
    }

    fn put(&mut self, descriptor: Descriptor, runs: Runs) {
        self.entries
            .retain(|e| e.descriptor.name != descriptor.name);
        self.entries.push(Arc::new(Entry { descriptor, runs }));
    }

    pub fn descriptors(&self) -> impl Iterator<Item = &Descriptor> {
        self.entries.iter().map(|e| &e.descriptor)
    }

    /// What a law says of itself.
    pub fn descriptor(&self, name: &str) -> Option<&Descriptor> {
        self.entry(name).map(|e| &e.descriptor)
    }

    /// Is it a potential between atoms?
    pub fn is_potential(&self, name: &str) -> bool {
        self.entry(name).is_some_and(|e| e.atoms().is_some())
    }

    fn entry(&self, name: &str) -> Option<&Arc<Entry>> {
        self.entries.iter().find(|e| e.descriptor.name == name)
    }

    fn material(&self, name: &str) -> Option<&Materials> {
        match &self.entry(name)?.runs {
            Runs::Material(material) => Some(material),
            Runs::Linear { .. } | Runs::Atoms(_) => None,
        }
    }

    /// Fill up what a potential takes from the lattice that its atoms lie on, of this spacing (length).
    pub fn on_lattice(&self, law: &mut NamedLaw, kind: LatticeKind, spacing: f64) {
        if let Some(atoms) = self.entry(&law.name).and_then(|e| e.atoms()) {
            (atoms.on_lattice)(&mut law.parameters, kind, spacing);
        }
    }

    /// Look up the laws that materials name: their parameters with defaults, and the linear laws of the same elasticity.
    ///
    /// # Errors
    /// No such law, or parameters that do not fit it.
    pub fn resolve(&self, spec: &mut Spec) -> Result<(), BuildError> {
        for (n, m) in spec.materials.iter_mut().enumerate() {
            self.look_up(&mut m.law)
                .map_err(|e| e.at(format!("materials[{n}].law")))?;
        }
        for (n, acting) in spec.interactions.potentials.iter_mut().enumerate() {
            let mut law = LawSpec::Atoms(acting.potential.clone());
            self.look_up(&mut law)
                .map_err(|e| e.at(format!("potentials[{n}].potential")))?;
            if let LawSpec::Atoms(potential) = law {
                acting.potential = potential;
            }
        }
        Ok(())
    }

    /// Look up the law of one material; laws that need none are left alone.
    ///
    /// # Errors
    /// As of [`Registry::resolve`]; its path is the key that is wrong, empty if it is not one alone.
    pub fn look_up(&self, law: &mut LawSpec) -> Result<(), BuildError> {
        let (name, parameters) = match law {
            LawSpec::Named(law) => (&law.name, &mut law.parameters),
            LawSpec::Atoms(potential) => (&potential.name, &mut potential.parameters),
            LawSpec::Pmb(_)
            | LawSpec::Lps(_)
            | LawSpec::Lps3d { .. }
            | LawSpec::EamLike { .. }
            | LawSpec::Springs(_)
            | LawSpec::Micromoduli(_) => return Ok(()),
        };
        let Some(entry) = self.entry(name) else {
            let known: Vec<&str> = self.descriptors().map(|d| d.name.as_ref()).collect();
            let message = format!(
                "there is no law named {name}; the registry has {}",
                known.join(", ")
            );
            return Err(BuildError::unknown("", name, message));
        };
        let invalid = |(key, message): Wrong| BuildError::invalid(key, message);
        let whole = |message: String| BuildError::invalid("", message);
        let mut parameters = std::mem::take(parameters);
        *law = match &entry.runs {
            Runs::Atoms(atoms) => LawSpec::Atoms((atoms.look_up)(parameters).map_err(invalid)?),
            Runs::Linear { law, .. } => {
                entry.descriptor.check(&mut parameters).map_err(invalid)?;
                law(&parameters).map_err(whole)?
            }
            Runs::Material(material) => {
                entry.descriptor.check(&mut parameters).map_err(invalid)?;
                let linear = (material.linear)(&parameters).map_err(whole)?;
                LawSpec::Named(NamedLaw {
                    name: name.clone(),
                    parameters,
                    linear: Some(Box::new(linear)),
                    isotropic: material.isotropic,
                })
            }
        };
        Ok(())
    }

    /// What stands on the registry for a law, and its constants by their keys.
    pub fn written(&self, law: &LawSpec) -> Option<(&Descriptor, Parameters)> {
        let named = |name: &str, parameters: &Parameters| {
            let found = self.descriptor(name);
            found.map(|d| (d, parameters.clone()))
        };
        match law {
            LawSpec::Named(law) => named(&law.name, &law.parameters),
            LawSpec::Atoms(potential) => named(&potential.name, &potential.parameters),
            LawSpec::Pmb(_)
            | LawSpec::Lps(_)
            | LawSpec::Lps3d { .. }
            | LawSpec::EamLike { .. }
            | LawSpec::Springs(_)
            | LawSpec::Micromoduli(_) => self.entries.iter().find_map(|e| match &e.runs {
                Runs::Linear { parameters, .. } => Some((&e.descriptor, parameters(law)?)),
                Runs::Material(_) | Runs::Atoms(_) => None,
            }),
        }
    }

    /// Does a law have its critical stretch among its constants?
    pub fn own_critical_stretch(&self, name: &str) -> bool {
        self.material(name).is_some_and(|m| m.own_critical_stretch)
    }

    /// Do some of its bonds break at a stretch of their own?
    pub fn bond_classes(&self, name: &str) -> bool {
        self.material(name).is_some_and(|m| m.bond_classes)
    }

    /// [`Registered::SOFTENS_TO_ZERO`](crate::law::descriptor::Registered::SOFTENS_TO_ZERO) of a law.
    pub fn softens_to_zero(&self, name: &str) -> bool {
        self.material(name).is_some_and(|m| m.softens_to_zero)
    }

    /// What makes the stiffness of a law in the general sweeps; `None`: it has none there.
    pub fn stiffness(&self, law: &LawSpec) -> Option<Stiffness> {
        let (_, parameters) = self.written(law)?;
        Some(self.material(general(law)?)?.stiffness(&parameters))
    }

    /// Does a law say what the stress across plane strain is?
    pub fn across(&self, name: &str) -> bool {
        self.material(name).is_some_and(|m| m.across)
    }

    /// Do its bonds store energy by turning, too?
    pub fn tangential_stiffness(&self, name: &str) -> bool {
        self.material(name).is_some_and(|m| m.tangential_stiffness)
    }

    /// The fracture energy of a brittle bond with the critical stretch of this law's (see [`Registered::brittle_energy`]).
    pub(crate) fn brittle_energy(&self, law: &LawSpec, energy: f64) -> f64 {
        match law {
            LawSpec::Named(law) => { self.material(&law.name) }
                .map_or(energy, |m| (m.brittle_energy)(&law.parameters, energy)),
            _ => energy,
        }
    }
}
