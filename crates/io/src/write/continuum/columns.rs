//! Fields as columns with names and units.

use crate::continuum::Units;
use peridyne::state::{Archive, Owner};
use peridyne_fields::average::Average;
use peridyne_fields::fields::{NO_VELOCITIES, Part};
use peridyne_fields::{Cell, Fields, Quantity};

/// A field at points, in the user's units.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    pub quantity: Quantity,
    /// Short name; of a part of the potential with the part's name.
    pub name: String,
    pub unit: String,
    /// Components point by point, not a number where they are not defined; or why there are none.
    pub values: Result<Vec<f64>, &'static str>,
    /// Standard errors, of means over frames.
    pub errors: Option<Vec<f64>>,
}

/// Fields at points, of a frame or as means over several.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    pub points: Vec<[f64; 3]>,
    /// Of a grid: its size, and the cell that it divides.
    pub grid: Option<([usize; 3], Cell)>,
    pub columns: Vec<Column>,
}

/// In the order of the table's columns; pressure, and those of [`Quantity::PLACES`] follow where they are asked for.
pub const ORDER: [Quantity; 15] = [
    Quantity::Density,
    Quantity::Momentum,
    Quantity::Velocity,
    Quantity::Temperature,
    Quantity::Energy,
    Quantity::StressKinetic,
    Quantity::StressPotential,
    Quantity::Stress,
    Quantity::Churning,
    Quantity::HeatKinetic,
    Quantity::HeatPotential,
    Quantity::HeatChurning,
    Quantity::InternalEnergy,
    Quantity::PotentialEnergy,
    Quantity::ChurningSource,
];

/// Quantities of a table; those of places are made only where they are asked for.
fn asked(pressure: bool, places: bool) -> impl Iterator<Item = Quantity> {
    let more = pressure.then_some(Quantity::Pressure);
    let of_places = Quantity::PLACES.into_iter().filter(move |_| places);
    ORDER.into_iter().chain(more).chain(of_places)
}

impl Owner for Column {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let all = Quantity::ALL;
        let mut number = all.iter().position(|q| *q == self.quantity).unwrap_or(0);
        archive.one("quantity", &mut number);
        match all.get(number) {
            Some(quantity) => self.quantity = *quantity,
            None => archive.refuse("quantity"),
        }
        archive.text("name", &mut self.name);
        archive.text("unit", &mut self.unit);
        let mut values = self.values.as_ref().ok().cloned();
        let mut why = self.values.as_ref().err().map_or("", |w| w).to_string();
        archive.option("values", &mut values, Vec::new, |x, a| a.list("all", x));
        archive.text("why_none", &mut why);
        if archive.loads() {
            // a few sentences, once
            self.values = values.ok_or_else(|| &*why.leak());
        }
        archive.option("errors", &mut self.errors, Vec::new, |x, a| {
            a.list("all", x)
        });
    }
}

impl Owner for Table {
    /// The grid is the caller's.
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.list("points", &mut self.points);
        let none = || Column {
            quantity: Quantity::Density,
            name: String::new(),
            unit: String::new(),
            values: Err(""),
            errors: None,
        };
        archive.items("columns", &mut self.columns, none, |c, a| c.archive(a));
    }
}

impl Table {
    /// Of one frame, with the pressure if it is asked for.
    pub fn of_frame(
        fields: &Fields,
        units: Units,
        grid: Option<([usize; 3], Cell)>,
        pressure: bool,
    ) -> Table {
        let column = |quantity: Quantity| {
            let values = fields.get(quantity).map(<[f64]>::to_vec);
            let values = values.ok_or_else(|| fields.why_not(quantity));
            of(quantity, units, values, None)
        };
        let places = fields.get(Quantity::Coordinate).is_some();
        let mut columns: Vec<Column> = asked(pressure, places).map(column).collect();
        for part in &fields.parts {
            columns.extend(of_part(part, units));
        }
        Table {
            points: fields.points.clone(),
            grid,
            columns,
        }
    }

    /// Means over frames.
    pub fn of_average(
        average: &Average,
        points: Vec<[f64; 3]>,
        units: Units,
        grid: Option<([usize; 3], Cell)>,
        pressure: bool,
    ) -> Table {
        let column = |quantity: Quantity| {
            let errors = average.error(quantity).filter(|_| average.frames() > 1);
            let values = average.mean(quantity);
            let values = values.ok_or_else(|| average.why_not(quantity));
            of(quantity, units, values, errors)
        };
        let places = average.mean(Quantity::Coordinate).is_some();
        Table {
            points,
            grid,
            columns: asked(pressure, places).map(column).collect(),
        }
    }
}

fn of(
    quantity: Quantity,
    units: Units,
    values: Result<Vec<f64>, &'static str>,
    errors: Option<Vec<f64>>,
) -> Column {
    let factor = units.factor(quantity);
    let scaled = |all: Vec<f64>| all.into_iter().map(|x| x * factor).collect();
    Column {
        quantity,
        name: quantity.symbol().into(),
        unit: units.unit(quantity),
        values: values.map(scaled),
        errors: errors.map(scaled),
    }
}

/// Stress, churning, heat flux and energy of a part of the potential, named after it.
fn of_part(part: &Part, units: Units) -> Vec<Column> {
    [
        (Quantity::StressPotential, &part.stress),
        (Quantity::Churning, &part.churning),
        (Quantity::HeatPotential, &part.heat),
        (Quantity::PotentialEnergy, &part.energy),
    ]
    .into_iter()
    .map(|(quantity, values)| {
        let values = match values.is_empty() {
            true => Err(NO_VELOCITIES),
            false => Ok(values.clone()),
        };
        let own = of(quantity, units, values, None);
        Column {
            name: format!("{}({})", own.name, part.name),
            ..own
        }
    })
    .collect()
}

/// Names of a quantity's components, with its own before them.
pub(crate) fn components(name: &str, quantity: Quantity) -> Vec<String> {
    const AXES: [&str; 3] = ["x", "y", "z"];
    match quantity.components() {
        3 => {
            // momentum and velocity are px, vx; heat fluxes qK_x
            let joint = if name.len() == 1 { "" } else { "_" };
            AXES.iter().map(|a| format!("{name}{joint}{a}")).collect()
        }
        9 => (0..9)
            .map(|n| format!("{name}_{}{}", AXES[n / 3], AXES[n % 3]))
            .collect(),
        _ => vec![name.to_string()],
    }
}
