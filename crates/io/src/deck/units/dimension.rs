//! Dimensions by name, each with an example.

use peridyne::columns::Dimension as Dim;

/// How one would write a quantity of a kind.
pub(super) const EXAMPLES: &[(Dim, &str)] = &[
    (Dim::NUMBER, "0.25"),
    (Dim::LENGTH, "0.5 mm"),
    (Dim::AREA, "2 mm^2"),
    (Dim::VOLUME, "1 mm^3"),
    (Dim::MASS, "2 kg"),
    (Dim::TIME, "20 us"),
    (Dim::TEMPERATURE, "300 K"),
    (Dim::VELOCITY, "100 m/s"),
    (Dim::ACCELERATION, "9.81 m/s^2"),
    (Dim::INVERSE_LENGTH, "1.4/mm"),
    (Dim::FREQUENCY, "1 kHz"),
    (Dim::DENSITY, "2200 kg/m^3"),
    (Dim::FORCE, "10 N"),
    (Dim::ENERGY, "1 J"),
    (Dim::POWER, "1 W"),
    (Dim::PRESSURE, "14.9 GPa"),
    (Dim::FRACTURE_ENERGY, "10 J/m^2"),
    (Dim::FORCE_DENSITY, "1e6 N/m^3"),
    (Dim::MICROMODULUS, "1.6e22 N/m^6"),
    (Dim::CONTACT_STIFFNESS, "1e26 N/m^7"),
    (Dim::RIGID_BODY_STIFFNESS, "1e17 N/m^5"),
    (Dim::DAMPING, "1e6 kg/m^3/s"),
    (Dim::CONDUCTIVITY, "45 W/m/K"),
    (Dim::HEAT_CAPACITY, "460 J/kg/K"),
    (Dim::HEAT_FLUX, "1e4 W/m^2"),
    (Dim::HEAT_SOURCE, "1e6 W/m^3"),
    (Dim::HEAT_TRANSFER, "25 W/m^2/K"),
    (Dim::EXPANSION, "12e-6 K^-1"),
    (Dim::DIFFUSIVITY, "1e-9 m^2/s"),
    (Dim::CONCENTRATION, "100 mol/m^3"),
    (Dim::SPECIES_FLUX, "1e-3 mol/m^2/s"),
    (Dim::SPECIES_SOURCE, "1e-3 mol/m^3/s"),
];

/// How one would write a quantity of this dimension, if it is a usual one.
pub fn example(dim: Dim) -> Option<&'static str> {
    EXAMPLES.iter().find(|n| n.0 == dim).map(|n| n.1)
}

/// The dimension of this [name](Dim::name), if it is a usual one.
pub fn named(name: &str) -> Option<Dim> {
    usual().find(|dim| dim.name() == Some(name))
}

/// The usual dimensions.
pub fn usual() -> impl Iterator<Item = Dim> {
    EXAMPLES.iter().map(|(dim, _)| *dim)
}

/// How usual a dimension is: its place among those with examples.
pub(super) fn place(dim: Dim) -> Option<usize> {
    EXAMPLES.iter().position(|n| n.0 == dim)
}
