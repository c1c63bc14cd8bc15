//! A small body of every law.

/// A law, and what a body of it is measured by. Solids have modulus, density and spacing 1.
pub struct Law {
    pub name: &'static str,
    pub keys: &'static str,
    pub place: Place,
    /// Strain of a load under which bonds end.
    pub strain: f64,
    /// Where they end, as a part of that strain: bonds of diamond turn, too, where it is pulled along an axis of its cell, `s = √(1 + (2 ε + ε²)/3) − 1`.
    pub part: f64,
    /// Fracture energy for the same, over `E s² δ`: a bond that softens from a tenth of its critical stretch on has a tenth of what a brittle one has, and
    /// surfaces of crystals pass 1 when they relax.
    pub toughness: f64,
    /// Are forces zero in the reference, at surfaces too?
    pub calm: bool,
    /// A law that is not without a fracture: that of bodies that do not break.
    pub fracture: Option<&'static str>,
}

/// Where the points are.
#[derive(Debug)]
pub struct Place {
    pub dimension: usize,
    /// Units, plane, horizon: the first lines of a deck.
    pub top: &'static str,
    /// Keys of the body, without its origin.
    pub body: &'static str,
    pub density: &'static str,
    /// From the first to the last point along x and y.
    pub length: f64,
    pub width: f64,
    /// Distance of nearest neighbours.
    pub near: f64,
    /// What a wave takes from one to the next, about.
    pub time: f64,
    /// Young's modulus, about.
    pub young: f64,
    pub families: &'static [&'static str],
}

const SOLID: Place = Place {
    dimension: 2,
    top: "units = \"none\"\nplane = \"stress\"\nhorizon = { m_ratio = 2 }\n",
    body: "lattice = \"square\", spacing = 1, cells = [9, 5]",
    density: "density = 1",
    length: 8.0,
    width: 4.0,
    near: 1.0,
    time: 1.0,
    young: 1.0,
    families: &["stencil", "list"],
};

const FLUID: Place = Place {
    top: "units = \"none\"\nplane = \"strain\"\nhorizon = { m_ratio = 2 }\n",
    ..SOLID
};

/// Nearest neighbours of a triangular lattice at the bottom of their well.
const ATOMS: Place = Place {
    top: "units = \"none\"\nhorizon = 1.5\n",
    body: "lattice = \"triangular\", spacing = 1, cells = [9, 3]",
    density: "mass = 1",
    length: 8.5,
    width: 4.33,
    time: 0.12,
    young: 60.0,
    families: &["reference"],
    ..SOLID
};

const COPPER: Place = Place {
    dimension: 3,
    top: "units = \"metal\"\nhorizon = 5.1\n",
    body: "lattice = \"fcc\", spacing = 3.6147, cells = [3, 3, 3]",
    density: "mass = 63.546",
    length: 9.03,
    width: 9.03,
    near: 2.556,
    time: 0.06,
    young: 0.8,
    families: &["reference"],
};

const SILICON: Place = Place {
    top: "units = \"metal\"\nhorizon = 3.8\n",
    body: "lattice = \"diamond\", spacing = 5.43094978, cells = [3, 2, 2]",
    density: "mass = 28.0855",
    length: 14.93,
    width: 9.5,
    near: 2.352,
    time: 0.03,
    ..COPPER
};

const fn solid(name: &'static str, keys: &'static str) -> Law {
    Law {
        name,
        keys,
        place: SOLID,
        strain: 0.06,
        part: 0.5,
        toughness: 1.0,
        calm: true,
        fracture: None,
    }
}

const fn atoms(name: &'static str, keys: &'static str) -> Law {
    Law {
        place: ATOMS,
        ..solid(name, keys)
    }
}

/// Atoms whose surfaces relax.
const fn crystal(place: Place, part: f64, name: &'static str, keys: &'static str) -> Law {
    Law {
        place,
        strain: 0.3,
        part,
        toughness: 2.0,
        calm: false,
        ..solid(name, keys)
    }
}

/// Laws of the registry that have no line: the blocks of a file, and a potential without forces.
pub const LEFT_OUT: &[&str] = &["micromoduli", "no_potential"];

const ELASTIC: &str = "young = 1, poisson = 0.25";

pub const LAWS: &[Law] = &[
    solid("pmb", "young = 1"),
    solid("springs", "young = 1"),
    solid("lps", ELASTIC),
    solid("lps_3d", "bulk = 0.7, shear = 0.4"),
    solid("eam_like", "pair = 2, volume = 0.1"),
    solid(
        "embedded_solid",
        "energy = \"0.1*(theta/theta0 - 1)^2\", weight = \"omega*r0*r\", pair = \"omega*(r - r0)^2/theta0\", bulk = 0.5",
    ),
    solid("thermoelastic", "young = 1"),
    solid("thermoelastic_solid", ELASTIC),
    Law {
        fracture: Some("critical_stretch = 0.5"),
        toughness: 0.1,
        ..solid("softening", "young = 1, onset = 0.1")
    },
    Law {
        fracture: Some("critical_stretch = 0.5"),
        ..solid(
            "lamina",
            "young = [2, 1], fibre = [1, 0, 0], fibre_critical_stretch = 0.03",
        )
    },
    solid("bond_rotation", "young = 1, poisson = 0.1"),
    solid("pals", ELASTIC),
    solid(
        "elastic_plastic",
        "young = 1, poisson = 0.25, yield_stress = 0.01, hardening = 0.1",
    ),
    solid(
        "viscoelastic",
        "young = 1, poisson = 0.25, branches = [[0.3, 2]]",
    ),
    solid("correspondence", ELASTIC),
    solid(
        "anisotropic",
        "young = [2, 1, 1], poisson = [0.25, 0.25, 0.25], shear = [0.5, 0.5, 0.4]",
    ),
    solid(
        "hyperelastic",
        "energy = \"0.2*(I1 - 3 - 2*ln(J)) + 0.2*ln(J)^2\"",
    ),
    solid("hypoelastic", ELASTIC),
    solid(
        "hypoelastic_plastic",
        "young = 1, poisson = 0.25, yield_stress = 0.01, hardening = 0.1",
    ),
    Law {
        place: FLUID,
        ..solid("fluid", "bulk = 1, hugoniot_slope = 1, gruneisen = 0")
    },
    atoms(
        "lennard_jones",
        "epsilon = 1, sigma = 0.890898718140339, cutoff = 1.6",
    ),
    atoms("morse", "depth = 1, alpha = 5, distance = 1, cutoff = 1.6"),
    // d/dr (A e^(-r/ρ) - C/r⁶) = 0 at 1: A e^(-10) = 6 ρ C
    atoms(
        "buckingham",
        "strength = 13215.8794768841, range = 0.1, dispersion = 1, cutoff = 1.6",
    ),
    atoms(
        "born_mayer",
        "strength = 0.6, sigma = 1, range = 0.1, dispersion = 1, cutoff = 1.6",
    ),
    crystal(COPPER, 0.5, "eam", "file = \"copper.eam.alloy\""),
    crystal(
        COPPER,
        0.5,
        "eam_form",
        "cohesive = 3.54, pair = 0.1217, alpha = 5.082, beta = 5.85, gamma = 6.82054, lambda = 12.06, density = [0.14095, -1.93222, 9.60043, -21.23718, 20.18581, -5.81656], density_scale = \"1/12\", nearest = 2.556, near = 1.75, cutoff = 1.95",
    ),
    crystal(SILICON, 0.2, "stillinger_weber", "file = \"Si.sw\""),
    crystal(
        SILICON,
        0.2,
        "tersoff",
        "file = \"SiC.tersoff\", element = \"Si\"",
    ),
];
