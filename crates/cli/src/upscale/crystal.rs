//! `peridyne upscale` without a deck: a law and a lattice on the command line are the keys of a deck, which takes the way
//! of all decks. What a command line leaves out — the spacing without pressure, a block that holds the coarse neighbours,
//! a pulse that crosses it — is found here.

use crate::failure::Failure;
use peridyne::law::descriptor::{Descriptor, Key, Need, Value};
use peridyne::law::many_body;
use peridyne::law::solid::linear::{EamLike, Linear, Lps, Pmb, Springs};
use peridyne::run::Registry;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{FamilyChoice, Spec};
use peridyne_io::deck::{Deck, Dim, Flag};
use peridyne_theory::crystal::Crystal;
use peridyne_theory::upscale::{self, REACH, equilibrium_spacing, lattice};

#[derive(clap::Args)]
#[command(next_help_heading = "Without a deck")]
pub struct CrystalArguments {
    /// springs, structured_eam, lps, pmb, or any potential that `peridyne laws` lists; those of files as setfl=FILE, funcfl=FILE, stillinger_weber=FILE, tersoff=FILE.
    #[arg(long, value_name = "LAW", value_parser = law)]
    pub potential: Option<Law>,
    /// A constant of the law by the name it has in decks, e.g. `--with epsilon=1 --with sigma=1`; may be repeated.
    #[arg(long, value_name = "KEY=VALUE", value_parser = crate::pair, requires = "potential")]
    pub with: Vec<(String, String)>,
    /// Element of a file that has several.
    #[arg(long, requires = "potential")]
    pub element: Option<String>,
    /// chain, square, triangular, cubic, bcc, fcc or diamond.
    #[arg(long, requires = "potential")]
    pub lattice: Option<String>,
    /// Edge of the lattice cell; of atoms, if not given, that without pressure.
    #[arg(long, allow_negative_numbers = true, requires = "potential")]
    pub spacing: Option<String>,
    /// Neighbours up to so many spacings. Atoms then keep those of the lattice.
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "N",
        requires = "potential"
    )]
    pub m_ratio: Option<String>,
    /// The same as a length.
    #[arg(
        long,
        value_name = "LENGTH",
        requires = "potential",
        conflicts_with = "m_ratio"
    )]
    pub horizon: Option<String>,
    /// Of an atom; from the file, and 1 in reduced or no units, if not given.
    #[arg(long, allow_negative_numbers = true, requires = "potential")]
    pub mass: Option<String>,
    /// Instead of a mass; 1 in reduced or no units, if not given.
    #[arg(
        long,
        allow_negative_numbers = true,
        requires = "potential",
        conflicts_with = "mass"
    )]
    pub density: Option<String>,
    /// Cells of the periodic block along each axis, e.g. `80,8,8`; if not given, as many as the coarse models need.
    #[arg(long, value_name = "N,N,N", requires = "potential")]
    pub cells: Option<String>,
    /// si, metal, lj or none; if not given metal for files, lj for Lennard-Jones, else none.
    #[arg(long, requires = "potential")]
    pub units: Option<String>,
}

/// A law of decks, and the file it reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    descriptor: Descriptor,
    file: Option<String>,
    solid: bool,
    /// seleson2014 (4.2)–(4.6): weights fall with the distance.
    structured: bool,
}

/// Other names of laws, and those in decks.
const ALSO: [(&str, &str); 2] = [("structured_eam", EamLike::NAME), ("lj", REDUCED)];

/// The law that reduced units are those of.
const REDUCED: &str = "lennard_jones";

/// Kinds of files; the law is the one that takes them.
const FILES: [&str; 2] = ["setfl", "funcfl"];

/// The key that takes a file.
fn file_key(of: &Descriptor) -> Option<&Key> {
    of.keys.iter().find(|k| k.value.is_file())
}

/// Is it made of tables of a file, which has the mass, too?
fn is_tabulated(of: &Descriptor) -> bool {
    of.keys.iter().any(|k| k.value == Value::Table)
}

impl Law {
    pub fn name(&self) -> &str {
        &self.descriptor.name
    }

    fn is_solid(&self) -> bool {
        self.solid
    }

    fn units(&self) -> &'static str {
        match self.file {
            Some(_) => "metal",
            None if self.name() == REDUCED => "lj",
            None => "none",
        }
    }
}

fn law(text: &str) -> Result<Law, String> {
    let (written, file) = match text.split_once('=') {
        Some((name, file)) => (name, Some(file.to_string())),
        None => (text, None),
    };
    let registry = Registry::standard();
    let tabulated = || { registry.descriptors() }.find(|d| is_tabulated(d));
    let also = ALSO.iter().find(|(other, _)| *other == written);
    let name = match FILES.contains(&written) {
        true => tabulated().map_or(written, |d| &d.name),
        false => also.map_or(written, |(_, name)| name),
    };
    let solids = [Springs::NAME, EamLike::NAME, Lps::NAME, Pmb::NAME];
    let known = |name: &str| solids.contains(&name) || registry.is_potential(name);
    let Some(descriptor) = registry.descriptor(name).filter(|_| known(name)) else {
        let all = registry
            .descriptors()
            .filter(|d| known(&d.name) && !is_tabulated(d));
        let all = all.map(|d| match file_key(d) {
            Some(_) => format!("{}=FILE", d.name),
            None => d.name.to_string(),
        });
        let all: Vec<String> = all.collect();
        return Err(format!(
            "expected {}, structured_eam, setfl=FILE or funcfl=FILE",
            all.join(", ")
        ));
    };
    let law = Law {
        descriptor: descriptor.clone(),
        file,
        solid: !registry.is_potential(name),
        structured: written == "structured_eam",
    };
    match (file_key(&law.descriptor), &law.file) {
        (Some(key), None) if key.need == Need::Given => Err(format!("write {written}=FILE")),
        (None, Some(_)) => Err(format!(
            "{written} reads no file: give its constants by --with KEY=VALUE"
        )),
        (Some(_), _) | (None, None) => Ok(law),
    }
}

fn flag(name: &str, key: &str, value: impl ToString) -> Flag {
    Flag {
        name: format!("--{name}"),
        key: key.into(),
        value: value.to_string(),
    }
}

/// What the flags say by themselves.
fn said(arguments: &CrystalArguments, law: &Law) -> Result<Vec<Flag>, Failure> {
    let needed = |name: &str, why: &str| Failure::input(format!("--{name} is missing: {why}"));
    let key = law.name();
    let mut flags = vec![
        flag(
            "units",
            "units",
            arguments.units.as_deref().unwrap_or(law.units()),
        ),
        flag("potential", &format!("material.law.{key}"), "{}"),
    ];
    if let (Some(file), Some(of)) = (&law.file, file_key(&law.descriptor)) {
        // a name like 1.eam is still a name
        let name = format!("{file:?}");
        let of = format!("material.law.{key}.{}", of.name);
        flags.push(flag("potential", &of, name));
    }
    if law.structured {
        flags.push(flag("potential", "influence", "inverse"));
    }
    if let Some(element) = &arguments.element {
        flags.push(flag(
            "element",
            &format!("material.law.{key}.element"),
            format!("{element:?}"),
        ));
    }
    for (name, value) in &arguments.with {
        let mut with = flag("with", &format!("material.law.{key}.{name}"), value);
        with.name = format!("--with {name}");
        flags.push(with);
    }
    match &arguments.lattice {
        Some(lattice) => flags.push(flag("lattice", "body.lattice", format!("{lattice:?}"))),
        None => {
            return Err(needed(
                "lattice",
                "chain, square, triangular, cubic, bcc, fcc or diamond",
            ));
        }
    }
    match (&arguments.m_ratio, &arguments.horizon) {
        (Some(m), _) => flags.push(flag("m-ratio", "horizon.m_ratio", m)),
        (None, Some(length)) => flags.push(flag("horizon", "horizon", length)),
        (None, None) if law.is_solid() => {
            return Err(needed(
                "m-ratio",
                "springs and solids have a horizon, in spacings or (--horizon) as a length",
            ));
        }
        (None, None) => {}
    }
    let fixed = arguments.m_ratio.is_some() || arguments.horizon.is_some();
    if fixed && many_body::is_known(law.name()) {
        return Err(Failure::input(format!(
            "{} lives on current neighbours: leave --m-ratio and --horizon out",
            law.name()
        )));
    }
    if fixed && !law.is_solid() {
        flags.push(flag("m-ratio", "family", "stencil"));
    }
    let plain = !matches!(
        arguments.units.as_deref().unwrap_or(law.units()),
        "si" | "metal"
    );
    match (&arguments.mass, &arguments.density) {
        (Some(mass), _) => flags.push(flag("mass", "material.mass", mass)),
        (None, Some(density)) => flags.push(flag("density", "material.density", density)),
        (None, None) if plain && law.is_solid() => {
            flags.push(flag("density", "material.density", 1))
        }
        (None, None) if plain => flags.push(flag("mass", "material.mass", 1)),
        (None, None) if is_tabulated(&law.descriptor) => {}
        (None, None) => {
            return Err(needed(
                "mass",
                "the law does not contain it (or give --density)",
            ));
        }
    }
    match &arguments.spacing {
        Some(spacing) => flags.push(flag("spacing", "body.spacing", spacing)),
        None if law.is_solid() => {
            return Err(needed("spacing", "springs and solids rest at any spacing"));
        }
        None if arguments.horizon.is_some() => {
            return Err(needed(
                "spacing",
                "a horizon in units of length does not say how many neighbours there are",
            ));
        }
        None if law.descriptor.key("nearest").is_some()
            && arguments.with.iter().all(|(k, _)| k != "nearest") =>
        {
            return Err(needed(
                "spacing",
                "the law is made for a nearest distance (or give it, --with nearest=LENGTH)",
            ));
        }
        None => {}
    }
    Ok(flags)
}

/// The deck that the flags make, with what was found in words.
pub fn deck(
    arguments: &CrystalArguments,
    law: &Law,
    set: &[(String, String)],
    factors: &[u32],
) -> Result<(Deck, Vec<String>), Failure> {
    let mut flags = said(arguments, law)?;
    let understood = |more: &[Flag], flags: &[Flag]| {
        let set = set.iter().map(|(key, value)| Flag {
            name: format!("--set {key}"),
            key: key.clone(),
            value: value.clone(),
        });
        let all: Vec<Flag> = flags.iter().chain(more).cloned().chain(set).collect();
        Deck::of_flags(&all).map_err(|e| Failure::Input(e.into()))
    };
    let dimension = arguments
        .lattice
        .as_deref()
        .and_then(|name| LatticeKind::ALL.into_iter().find(|k| k.name() == name))
        .map_or(3, LatticeKind::dimension);
    // a deck is whole with any body and any run
    let cells = |n: [u32; 3]| format!("{:?}", &n[..dimension]);
    let mut whole = vec![
        flag("cells", "body.cells", cells([1; 3])),
        flag("steps", "run.steps", 1),
    ];
    let mut notes = vec![];
    if arguments.spacing.is_none() {
        whole.push(flag("spacing", "body.spacing", 1));
        let deck = understood(&whole, &flags)?;
        let Some(rest) = equilibrium_spacing(&deck.spec) else {
            return Err(Failure::input(format!(
                "--spacing is missing: no spacing was found at which a {} lattice of {} has no pressure{}",
                arguments.lattice.as_deref().unwrap_or_default(),
                law.name(),
                match deck
                    .spec
                    .potential()
                    .is_some_and(|p| p.cut_off().is_infinite())
                    && deck.spec.bonds.family != FamilyChoice::Stencil
                {
                    true =>
                        "; the law needs a cut-off (--with cutoff=LENGTH) or fixed neighbours (--m-ratio N)",
                    false => "",
                }
            )));
        };
        whole.pop();
        let plain = rest / deck.units.plain_factor(Dim::LENGTH);
        notes.push(format!(
            "spacing {}: the lattice has no pressure there",
            deck.units.write(rest, Dim::LENGTH)
        ));
        flags.push(flag("spacing", "body.spacing", format!("{plain:?}")));
    }
    let deck = understood(&whole, &flags)?;
    let block = block(&deck.spec, factors);
    let size = match &arguments.cells {
        Some(written) => format!("[{written}]"),
        None => cells(block),
    };
    flags.push(flag("cells", "body.cells", size));
    flags.push(flag(
        "cells",
        "periodic",
        format!("{:?}", &["x", "y", "z"][..dimension]),
    ));
    flags.push(flag(
        "potential",
        "title",
        format!(
            "\"{} on a {} lattice\"",
            law.name(),
            arguments.lattice.as_deref().unwrap_or("")
        ),
    ));
    whole = vec![flag("steps", "run.steps", 1)];
    let deck = understood(&whole, &flags)?;
    flags.extend(motion(&deck, factors));
    Ok((understood(&[], &flags)?, notes))
}

/// Coarse spacings that the pulse is wide, and the block long.
const WIDTH: f64 = 4.0;
const LENGTH: f64 = 40.0;

/// Cells along each axis: multiples of all factors that hold every model's neighbours, and along x a pulse.
fn block(spec: &Spec, factors: &[u32]) -> [u32; 3] {
    let Ok((kind, spacing)) = lattice(spec) else {
        return [1; 3];
    };
    let most = factors.iter().copied().max().unwrap_or(1);
    let whole = factors
        .iter()
        .fold(1u32, |l, f| (l / gcd(l, *f)).saturating_mul(*f))
        .max(1);
    let reach = match (spec.potential(), spec.bonds.family) {
        (Some(p), FamilyChoice::Auto | FamilyChoice::Neighbours) => REACH * p.cut_off(),
        (Some(_), FamilyChoice::Stencil | FamilyChoice::List | FamilyChoice::Reference)
        | (None, _) => spec.bonds.horizon.length(spacing),
    };
    let reach = reach * f64::from(most);
    let edges = kind.edges();
    std::array::from_fn(|a| {
        let long = if a == 0 {
            LENGTH * f64::from(most) * spacing
        } else {
            0.0
        };
        // twice the reach, and a cell to spare
        let length = (2.0 * reach).max(long) / (spacing * edges[a]);
        let cells = (length.min(1e6) as u32 + 1)
            .div_ceil(whole)
            .saturating_mul(whole);
        cells.max(whole)
    })
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a.max(1) } else { gcd(b, a % b) }
}

/// A smooth longitudinal pulse about the middle, and the time in which its halves run a quarter of the block.
fn motion(deck: &Deck, factors: &[u32]) -> Vec<Flag> {
    let spec = &deck.spec;
    let Ok((_, spacing)) = lattice(spec) else {
        return vec![];
    };
    let most = factors.iter().copied().max().unwrap_or(1);
    let plain = deck.units.plain_factor(Dim::LENGTH);
    let length = spec.space.periodic[0].unwrap_or(LENGTH * f64::from(most) * spacing);
    let width = WIDTH * f64::from(most) * spacing;
    let (middle, w) = (0.5 * length / plain, width / plain);
    let pulse = format!("{:?}*exp(-((x-{middle:?})/{w:?})^2)", 0.01 * w);
    let mut components = vec![format!("{pulse:?}")];
    components.resize(spec.space.dimension, "0".into());
    let mut flags = vec![
        flag(
            "cells",
            "initial",
            format!("[{{ displacement = [{}] }}]", components.join(", ")),
        ),
        flag("cells", "run.time_step.safety", 0.5),
    ];
    let speed = match spec.space.dimension {
        1 => sound::<1>(spec),
        2 => sound::<2>(spec),
        _ => sound::<3>(spec),
    };
    flags.push(match speed {
        Some(c) => {
            let time = 0.25 * length / c / deck.units.plain_factor(Dim::TIME);
            flag("cells", "run.duration", format!("{time:?}"))
        }
        None => flag("cells", "run.steps", 100),
    });
    flags.push(flag("cells", "output.vtu", false));
    flags
}

/// Speed of long waves along x, if they do not grow.
fn sound<const D: usize>(spec: &Spec) -> Option<f64> {
    let (crystal, _): (Crystal<D>, _) = upscale::crystal(spec).ok()?;
    let stiffness = crystal.elastic_constants()?.c[0][0];
    (stiffness > 0.0).then(|| (stiffness / crystal.density()).sqrt())
}
