//! Which fields there are, with their names, equations and units.

/// A field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    Density,
    Momentum,
    Velocity,
    Temperature,
    Energy,
    InternalEnergy,
    PotentialEnergy,
    StressKinetic,
    StressPotential,
    Stress,
    Churning,
    HeatKinetic,
    HeatPotential,
    HeatChurning,
    ChurningSource,
    Pressure,
    Coordinate,
    CoordinateFlux,
    AngularMomentum,
}

/// Powers of units; mass and energy are apart, as users write them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Powers {
    pub mass: i32,
    pub energy: i32,
    pub length: i32,
    pub time: i32,
    pub temperature: i32,
}

impl Quantity {
    pub const ALL: [Quantity; 19] = [
        Quantity::Density,
        Quantity::Momentum,
        Quantity::Velocity,
        Quantity::Temperature,
        Quantity::Energy,
        Quantity::InternalEnergy,
        Quantity::PotentialEnergy,
        Quantity::StressKinetic,
        Quantity::StressPotential,
        Quantity::Stress,
        Quantity::Churning,
        Quantity::HeatKinetic,
        Quantity::HeatPotential,
        Quantity::HeatChurning,
        Quantity::ChurningSource,
        Quantity::Pressure,
        Quantity::Coordinate,
        Quantity::CoordinateFlux,
        Quantity::AngularMomentum,
    ];

    /// Those of where what is at a point comes from, which are made where they are asked for.
    pub const PLACES: [Quantity; 3] = [
        Quantity::Coordinate,
        Quantity::CoordinateFlux,
        Quantity::AngularMomentum,
    ];

    /// Numbers of all fields at a point, with those of places or without.
    pub fn numbers(places: bool) -> usize {
        let made = Quantity::ALL.into_iter();
        made.filter(|q| places || !Quantity::PLACES.contains(q))
            .map(Quantity::components)
            .sum()
    }

    /// Short name, in columns of tables.
    pub fn symbol(self) -> &'static str {
        match self {
            Quantity::Density => "rho",
            Quantity::Momentum => "p",
            Quantity::Velocity => "v",
            Quantity::Temperature => "T",
            Quantity::Energy => "e",
            Quantity::InternalEnergy => "e_int",
            Quantity::PotentialEnergy => "e_pot",
            Quantity::StressKinetic => "sK",
            Quantity::StressPotential => "sU",
            Quantity::Stress => "s",
            Quantity::Churning => "z",
            Quantity::HeatKinetic => "qK",
            Quantity::HeatPotential => "qU",
            Quantity::HeatChurning => "qC",
            Quantity::ChurningSource => "zv",
            Quantity::Pressure => "pressure",
            Quantity::Coordinate => "y",
            Quantity::CoordinateFlux => "ud",
            Quantity::AngularMomentum => "l",
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Quantity::Density => "mass density",
            Quantity::Momentum => "momentum density",
            Quantity::Velocity => "velocity",
            Quantity::Temperature => "kinetic temperature",
            Quantity::Energy => "energy density",
            Quantity::InternalEnergy => "internal energy density",
            Quantity::PotentialEnergy => "potential energy density",
            Quantity::StressKinetic => "kinetic stress",
            Quantity::StressPotential => "potential stress",
            Quantity::Stress => "Cauchy stress",
            Quantity::Churning => "churning tensor",
            Quantity::HeatKinetic => "kinetic heat flux",
            Quantity::HeatPotential => "potential heat flux",
            Quantity::HeatChurning => "churning heat flux",
            Quantity::ChurningSource => "churning heat source",
            Quantity::Pressure => "pressure",
            Quantity::Coordinate => "material coordinate",
            Quantity::CoordinateFlux => "flux of the material coordinate",
            Quantity::AngularMomentum => "angular momentum density",
        }
    }

    /// Of chapter 4.
    pub fn equation(self) -> &'static str {
        match self {
            Quantity::Density => "(4.0.60)",
            Quantity::Momentum => "(4.0.62)",
            Quantity::Velocity => "(4.0.67)",
            Quantity::Temperature => "3/2 n k T = 1/2 sum m u^2 phi, n = sum phi",
            Quantity::Energy => "(4.0.63)",
            Quantity::InternalEnergy => "(4.0.11)",
            Quantity::PotentialEnergy => "(4.0.63), without velocities",
            Quantity::StressKinetic => "(4.0.78)",
            Quantity::StressPotential => "(4.0.84)",
            Quantity::Stress => "(4.0.83), kinetic + potential",
            Quantity::Churning => "(4.0.116)",
            Quantity::HeatKinetic => "(4.0.104)",
            Quantity::HeatPotential => "(4.0.114)",
            Quantity::HeatChurning => "(4.0.115)",
            Quantity::ChurningSource => "(4.0.120), z^ab dv^b/dx^a",
            Quantity::Pressure => "-(s_xx + s_yy + s_zz)/3 of the Cauchy stress",
            Quantity::Coordinate => "(4.0.70)",
            Quantity::CoordinateFlux => "(4.0.72), sum m u^a d^b phi, d = x_j - y",
            Quantity::AngularMomentum => "(4.0.91)",
        }
    }

    /// Numbers at a point: 1, 3, or 9 row by row, the first index that of the divergence.
    pub fn components(self) -> usize {
        match self {
            Quantity::Density
            | Quantity::Temperature
            | Quantity::Energy
            | Quantity::InternalEnergy
            | Quantity::PotentialEnergy
            | Quantity::ChurningSource
            | Quantity::Pressure => 1,
            Quantity::Momentum
            | Quantity::Velocity
            | Quantity::HeatKinetic
            | Quantity::HeatPotential
            | Quantity::HeatChurning
            | Quantity::Coordinate
            | Quantity::AngularMomentum => 3,
            Quantity::StressKinetic
            | Quantity::StressPotential
            | Quantity::Stress
            | Quantity::Churning
            | Quantity::CoordinateFlux => 9,
        }
    }

    pub fn powers(self) -> Powers {
        let of = |mass, energy, length, time, temperature| Powers {
            mass,
            energy,
            length,
            time,
            temperature,
        };
        match self {
            Quantity::Density => of(1, 0, -3, 0, 0),
            Quantity::Momentum => of(1, 0, -2, -1, 0),
            Quantity::Coordinate => of(0, 0, 1, 0, 0),
            Quantity::CoordinateFlux | Quantity::AngularMomentum => of(1, 0, -1, -1, 0),
            Quantity::Velocity => of(0, 0, 1, -1, 0),
            Quantity::Temperature => of(0, 0, 0, 0, 1),
            Quantity::Energy
            | Quantity::InternalEnergy
            | Quantity::PotentialEnergy
            | Quantity::StressKinetic
            | Quantity::StressPotential
            | Quantity::Stress
            | Quantity::Churning
            | Quantity::Pressure => of(0, 1, -3, 0, 0),
            Quantity::HeatKinetic | Quantity::HeatPotential | Quantity::HeatChurning => {
                of(0, 1, -2, -1, 0)
            }
            Quantity::ChurningSource => of(0, 1, -3, -1, 0),
        }
    }

    /// Is it a force per area?
    pub fn is_stress(self) -> bool {
        match self {
            Quantity::StressKinetic
            | Quantity::StressPotential
            | Quantity::Stress
            | Quantity::Pressure
            | Quantity::Churning => true,
            Quantity::Density
            | Quantity::Momentum
            | Quantity::Velocity
            | Quantity::Temperature
            | Quantity::Energy
            | Quantity::InternalEnergy
            | Quantity::PotentialEnergy
            | Quantity::HeatKinetic
            | Quantity::HeatPotential
            | Quantity::HeatChurning
            | Quantity::ChurningSource
            | Quantity::Coordinate
            | Quantity::CoordinateFlux
            | Quantity::AngularMomentum => false,
        }
    }

    /// Does it need velocities?
    pub fn moves(self) -> bool {
        match self {
            Quantity::Density
            | Quantity::PotentialEnergy
            | Quantity::StressPotential
            | Quantity::Churning
            | Quantity::Coordinate => false,
            Quantity::Momentum
            | Quantity::Velocity
            | Quantity::Temperature
            | Quantity::Energy
            | Quantity::InternalEnergy
            | Quantity::StressKinetic
            | Quantity::Stress
            | Quantity::HeatKinetic
            | Quantity::HeatPotential
            | Quantity::HeatChurning
            | Quantity::ChurningSource
            | Quantity::Pressure
            | Quantity::CoordinateFlux
            | Quantity::AngularMomentum => true,
        }
    }
}
