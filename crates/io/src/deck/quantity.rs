//! What numbers of a deck measure and where they may lie: types for the fields of its document.

use super::units::Dim;
use peridyne::law::descriptor::Bounds;
use std::marker::PhantomData;

/// What a number of a deck measures, and where it may lie: said once, in the document, from where parsing, errors, `schema` and the
/// reference take it.
pub trait Measure {
    const DIM: Dim;
    const BOUNDS: Bounds = Bounds::ANY;
}

/// A type for each dimension that keys have.
macro_rules! measures {
    ($($name:ident: $dim:expr,)*) => {
        $(
            #[doc = concat!("`", stringify!($dim), "`")]
            #[derive(Debug, Clone, Copy)]
            pub struct $name;
            impl Measure for $name {
                const DIM: Dim = $dim;
            }
        )*
    };
}

measures! {
    Pure: Dim::NUMBER,
    Length: Dim::LENGTH,
    Area: Dim::AREA,
    Volume: Dim::VOLUME,
    Mass: Dim::MASS,
    Time: Dim::TIME,
    Temperature: Dim::TEMPERATURE,
    Velocity: Dim::VELOCITY,
    Acceleration: Dim::ACCELERATION,
    Frequency: Dim::FREQUENCY,
    Density: Dim::DENSITY,
    Force: Dim::FORCE,
    Energy: Dim::ENERGY,
    Pressure: Dim::PRESSURE,
    FractureEnergy: Dim::FRACTURE_ENERGY,
    ForceDensity: Dim::FORCE_DENSITY,
    ContactStiffness: Dim::CONTACT_STIFFNESS,
    RigidBodyStiffness: Dim::RIGID_BODY_STIFFNESS,
    Damping: Dim::DAMPING,
    Conductivity: Dim::CONDUCTIVITY,
    HeatCapacity: Dim::HEAT_CAPACITY,
    HeatFlux: Dim::HEAT_FLUX,
    HeatSource: Dim::HEAT_SOURCE,
    HeatTransfer: Dim::HEAT_TRANSFER,
    Expansion: Dim::EXPANSION,
    Diffusivity: Dim::DIFFUSIVITY,
    Concentration: Dim::CONCENTRATION,
    SpeciesFlux: Dim::SPECIES_FLUX,
    SpeciesSource: Dim::SPECIES_SOURCE,
    Inertia: Dim([2, 1, 0, 0]),
}

/// Types for where numbers may lie.
macro_rules! bounds {
    ($($(#[$about:meta])* $name:ident: $bounds:expr,)*) => {
        $(
            $(#[$about])*
            #[derive(Debug, Clone, Copy)]
            pub struct $name<K = Pure>(PhantomData<K>);
            impl<K: Measure> Measure for $name<K> {
                const DIM: Dim = K::DIM;
                const BOUNDS: Bounds = $bounds;
            }
        )*
    };
}

bounds! {
    Positive: Bounds::POSITIVE,
    NotNegative: Bounds::NOT_NEGATIVE,
    /// Above 0, to 1.
    Part: Bounds::PART,
    /// From 0 to 1.
    Fraction: Bounds { inclusive: true, ..Bounds::PART },
    /// Between 0 and 1.
    Within: Bounds { below: true, ..Bounds::PART },
    /// The least load of a cycle over the greatest.
    LoadRatio: Bounds { least: -1.0, inclusive: true, most: 1.0, below: true },
    /// α of Hilber, Hughes and Taylor.
    Hht: Bounds { least: -1.0 / 3.0, inclusive: true, most: 0.0, below: false },
}
