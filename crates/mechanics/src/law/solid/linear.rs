//! What the laws of the fast families say of themselves: keys, and the law that follows of them.

use crate::columns::Dimension;
use crate::law::descriptor::{self, Bounds, Descriptor, Key, MODULI, Need, Value, number};
use crate::spec::{Influence, LawSpec, Parameters, PmbStiffness};

/// A law that a kernel of its own runs.
pub trait Linear {
    /// Lower case with underscores; the same in decks and programs.
    const NAME: &'static str;

    fn descriptor() -> Descriptor;

    /// From parameters that fit the descriptor.
    ///
    /// # Errors
    /// What of the parameters is wrong.
    fn law(parameters: &Parameters) -> Result<LawSpec, String>;

    /// The other way round; `None`: another law.
    fn parameters(law: &LawSpec) -> Option<Parameters>;
}

/// Who wants to see all of them ([`each`]).
pub trait Laws {
    fn linear<L: Linear>(&mut self);
}

/// All there are, a line each.
pub fn each(laws: &mut impl Laws) {
    laws.linear::<Pmb>();
    laws.linear::<Lps>();
    laws.linear::<Lps3d>();
    laws.linear::<EamLike>();
    laws.linear::<Springs>();
    laws.linear::<Micromoduli>();
}

/// Keys of bond-based laws.
pub(crate) const ONE_STIFFNESS: [Key; 5] = [
    one_of("young", Dimension::PRESSURE, "Young's modulus E."),
    one_of("bulk", Dimension::PRESSURE, "Bulk modulus K of the solid."),
    one_of(
        "micromodulus",
        Dimension::MICROMODULUS,
        "c, force / volume².",
    ),
    refused("poisson"),
    refused("shear"),
];

const fn one_of(name: &'static str, dimension: Dimension, doc: &'static str) -> Key {
    number(name, dimension, Bounds::POSITIVE, doc).need(Need::OneOf)
}

const fn refused(name: &'static str) -> Key {
    Key {
        name,
        value: Value::Number(Dimension::NUMBER, Bounds::ANY),
        need: Need::Refused,
        doc: "takes one modulus: Poisson's ratio of a bond-based law is 1/4 (plane stress 1/3); use lps to choose it",
    }
}

pub(crate) fn stiffness(p: &Parameters) -> Result<PmbStiffness, String> {
    let given = [
        p.number("young"),
        p.number("bulk"),
        p.number("micromodulus"),
    ];
    match given {
        [Some(young), None, None] => Ok(PmbStiffness::Young(young)),
        [None, Some(bulk), None] => Ok(PmbStiffness::Bulk(bulk)),
        [None, None, Some(c)] => Ok(PmbStiffness::Micromodulus(c)),
        _ => Err("expected one of young, bulk, micromodulus".into()),
    }
}

/// The parameters that say it.
pub(crate) fn of_stiffness(stiffness: PmbStiffness) -> Parameters {
    Parameters::numbers(&[match stiffness {
        PmbStiffness::Young(young) => ("young", young),
        PmbStiffness::Bulk(bulk) => ("bulk", bulk),
        PmbStiffness::Micromodulus(c) => ("micromodulus", c),
    }])
}

/// The prototype microelastic brittle material.
pub struct Pmb;

impl Linear for Pmb {
    const NAME: &'static str = "pmb";

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Bond-based, prototype microelastic brittle: f = c ω ν V s. One of young, bulk, micromodulus; Poisson ratio 1/4, plane stress 1/3.",
        )
        .source("Silling & Askari 2005")
        .example("{ young = \"72 GPa\" }")
        .keys(&ONE_STIFFNESS)
    }

    fn law(p: &Parameters) -> Result<LawSpec, String> {
        stiffness(p).map(LawSpec::Pmb)
    }

    fn parameters(law: &LawSpec) -> Option<Parameters> {
        match law {
            LawSpec::Pmb(stiffness) => Some(of_stiffness(*stiffness)),
            _ => None,
        }
    }
}

/// Linear springs.
pub struct Springs;

impl Linear for Springs {
    const NAME: &'static str = "springs";

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Linear springs, the bond-based law linearised about the reference: one of young, bulk, micromodulus.",
        )
        .source("Silling 2000")
        .example("{ young = \"72 GPa\" }")
        .keys(&ONE_STIFFNESS)
    }

    fn law(p: &Parameters) -> Result<LawSpec, String> {
        stiffness(p).map(LawSpec::Springs)
    }

    fn parameters(law: &LawSpec) -> Option<Parameters> {
        match law {
            LawSpec::Springs(stiffness) => Some(of_stiffness(*stiffness)),
            _ => None,
        }
    }
}

/// The linear peridynamic solid.
pub struct Lps;

impl Linear for Lps {
    const NAME: &'static str = "lps";

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Linear peridynamic solid, state-based: W = ½ κ θ² + β/(2m) Σ ω ν V e². Two of young, poisson, bulk, shear.",
        )
        .source("Silling, Epton, Weckner, Xu & Askari 2007")
        .example("{ young = \"72 GPa\", poisson = 0.22 }")
        .influence(Influence::Inverse)
        .keys(&MODULI)
    }

    fn law(p: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(p).map(LawSpec::Lps)
    }

    fn parameters(law: &LawSpec) -> Option<Parameters> {
        match law {
            LawSpec::Lps(m) => {
                let of = [("young", m.young), ("poisson", m.poisson)];
                Some(Parameters::numbers(&of))
            }
            _ => None,
        }
    }
}

/// The linear peridynamic solid of LAMMPS.
pub struct Lps3d;

impl Linear for Lps3d {
    const NAME: &'static str = "lps_3d";

    fn descriptor() -> Descriptor {
        let pressure = Dimension::PRESSURE;
        Descriptor::new(
            Self::NAME,
            "The linear peridynamic solid with the three-dimensional formulas in any dimension: bulk and shear.",
        )
        .source("LAMMPS peri/lps; Parks, Seleson, Plimpton, Silling & Lehoucq 2011")
        .example("{ bulk = \"14.9 GPa\", shear = \"8.9 GPa\" }")
        .influence(Influence::Inverse)
        .number("bulk", pressure, Bounds::POSITIVE, "Bulk modulus K.")
        .number("shear", pressure, Bounds::POSITIVE, "Shear modulus G.")
    }

    fn law(p: &Parameters) -> Result<LawSpec, String> {
        let [bulk, shear] = p.all(["bulk", "shear"])?;
        Ok(LawSpec::Lps3d { bulk, shear })
    }

    fn parameters(law: &LawSpec) -> Option<Parameters> {
        match law {
            LawSpec::Lps3d { bulk, shear } => {
                Some(Parameters::numbers(&[("bulk", *bulk), ("shear", *shear)]))
            }
            _ => None,
        }
    }
}

/// The solid that embedded atoms become.
pub struct EamLike;

impl Linear for EamLike {
    const NAME: &'static str = "eam_like";

    fn descriptor() -> Descriptor {
        let pressure = Dimension::PRESSURE;
        Descriptor::new(Self::NAME, "W = E(θ) + bonds, with the two stiffnesses.")
            .source("seleson2014 (A.14)–(A.24)")
            .example("{ pair = \"1 GPa\", volume = \"1 GPa\" }")
            .number(
                "pair",
                pressure,
                Bounds::POSITIVE,
                "Stiffness k of the bonds.",
            )
            .number(
                "volume",
                pressure,
                Bounds::ANY,
                "Stiffness p of the volume.",
            )
    }

    fn law(p: &Parameters) -> Result<LawSpec, String> {
        let [pair, volume] = p.all(["pair", "volume"])?;
        // of a swelling ε in any dimension: W = (9κ + β) ε²/2
        let bulk = (3.0 * volume + 0.5 * pair) / 9.0;
        if !(bulk > 0.0) {
            return Err(format!(
                "pair and volume give a bulk modulus of {bulk:e}, expected a positive one: `volume` is above −pair/6"
            ));
        }
        Ok(LawSpec::EamLike { pair, volume })
    }

    fn parameters(law: &LawSpec) -> Option<Parameters> {
        match law {
            LawSpec::EamLike { pair, volume } => {
                Some(Parameters::numbers(&[("pair", *pair), ("volume", *volume)]))
            }
            _ => None,
        }
    }
}

/// The blocks of a linear body, which are data and no keys.
pub struct Micromoduli;

impl Linear for Micromoduli {
    const NAME: &'static str = "micromoduli";

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "The blocks of a linear body, which is the body's file (.npz).",
        )
        .source("Silling 2010")
    }

    fn law(_: &Parameters) -> Result<LawSpec, String> {
        Err("there are no micromoduli: the body is no linear body from a file".into())
    }

    fn parameters(law: &LawSpec) -> Option<Parameters> {
        law.micromoduli().map(|_| Parameters::default())
    }
}
