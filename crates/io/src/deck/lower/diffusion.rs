//! What spreads through the bonds: heat, a species.

use super::context::{Context, Result};
use crate::deck::document::{Condition, DiffusionName, Document, Initial};
use crate::deck::quantity::Positive;
use crate::deck::units::{Dim, short};
use crate::deck::value::{self, At, Number};
use peridyne::expression::Expression;
use peridyne::spec::{
    DiffusionCondition, DiffusionKind, DiffusionMaterial, DiffusionMethod, DiffusionSpec, Exchange,
    MaterialSpec, Quantity,
};
use std::ops::Range;

/// Constant of Stefan and Boltzmann (W/m²/K⁴), exact since 2019.
const STEFAN_BOLTZMANN: f64 = 5.670374419e-8;
const RADIATION: Dim = Dim([0, 1, -3, -4]);

/// Something of a quantity that spreads, and where the deck says it.
pub(super) struct Said<T> {
    pub quantity: Quantity,
    pub what: T,
    pub span: Range<usize>,
}

/// Values at the start, on a set.
pub(super) fn initial(
    context: &Context,
    written: &Initial,
    set: &str,
    said: &mut Vec<Said<(String, Expression)>>,
) -> Result<()> {
    let temperature = context.said(&written.temperature)?;
    let concentration = context.said(&written.concentration)?;
    let each = [
        (Quantity::Heat, temperature),
        (Quantity::Species, concentration),
    ];
    for (quantity, value) in each {
        if let Some((value, span)) = value {
            said.push(Said {
                quantity,
                what: (set.to_string(), value),
                span,
            });
        }
    }
    Ok(())
}

/// Does a condition say anything through the surface of its set, whose area may be given?
pub(super) fn has_surface(c: &Condition) -> bool {
    c.heat_flux.is_some()
        || c.convection.is_some()
        || c.radiation.is_some()
        || c.species_flux.is_some()
        || c.species_exchange.is_some()
}

/// What a condition does to what spreads.
pub(super) fn conditions(
    context: &Context,
    c: &Condition,
    set: &str,
    area: Option<f64>,
    said: &mut Vec<Said<DiffusionCondition>>,
) -> Result<()> {
    let mut add = |quantity, kind, span: &Range<usize>| {
        said.push(Said {
            quantity,
            what: DiffusionCondition {
                set: set.to_string(),
                kind,
            },
            span: span.clone(),
        });
    };
    let values = [
        (Quantity::Heat, context.said(&c.temperature)?),
        (Quantity::Species, context.said(&c.concentration)?),
    ];
    for (quantity, value) in values {
        if let Some((value, span)) = value {
            add(quantity, DiffusionKind::Value(value), &span);
        }
    }
    let fluxes = [
        (Quantity::Heat, context.said(&c.heat_flux)?),
        (Quantity::Species, context.said(&c.species_flux)?),
    ];
    for (quantity, value) in fluxes {
        if let Some((value, span)) = value {
            add(quantity, DiffusionKind::Flux { value, area }, &span);
        }
    }
    let sources = [
        (Quantity::Heat, context.said(&c.heat_source)?),
        (Quantity::Species, context.said(&c.species_source)?),
    ];
    for (quantity, value) in sources {
        if let Some((value, span)) = value {
            add(quantity, DiffusionKind::Source(value), &span);
        }
    }
    if let Some(at) = &c.convection {
        let law = Exchange::Convection {
            coefficient: context.expression(&at.value.coefficient)?,
            ambient: context.expression(&at.value.ambient)?,
        };
        add(
            Quantity::Heat,
            DiffusionKind::Exchange { law, area },
            &at.span,
        );
    }
    if let Some(at) = &c.radiation {
        let written = &at.value;
        let emissivity = context.value(&written.emissivity)?;
        if !context.units.has_units() {
            return Err(context.error_with(
                &at.span,
                "radiation has a constant with units, and this deck has none",
                "write units = \"si\"",
            ));
        }
        let sigma = STEFAN_BOLTZMANN * context.units.from_si(RADIATION);
        let law = Exchange::Radiation {
            coefficient: Expression::constant(emissivity * sigma),
            ambient: context.expression(&written.ambient)?,
        };
        add(
            Quantity::Heat,
            DiffusionKind::Exchange { law, area },
            &at.span,
        );
    }
    if let Some(at) = &c.species_exchange {
        let law = Exchange::Convection {
            coefficient: context.expression(&at.value.coefficient)?,
            ambient: context.expression(&at.value.ambient)?,
        };
        add(
            Quantity::Species,
            DiffusionKind::Exchange { law, area },
            &at.span,
        );
    }
    Ok(())
}

/// Keys that `[heat]` and `[species]` have alike.
struct Table<'a> {
    quantity: Quantity,
    span: &'a Range<usize>,
    method: &'a Option<At<DiffusionName>>,
    safety: &'a Option<value::Quantity<Positive>>,
    tolerance: &'a Option<value::Quantity<Positive>>,
    /// Its measure is that of the quantity.
    reference: Option<Number>,
    across_broken: bool,
    deformation: bool,
}

fn tables(document: &Document) -> Vec<Table<'_>> {
    let mut all = vec![];
    if let Some(at) = &document.heat {
        let h = &at.value;
        all.push(Table {
            quantity: Quantity::Heat,
            span: &at.span,
            method: &h.method,
            safety: &h.safety,
            tolerance: &h.tolerance,
            reference: h.reference.as_ref().map(value::Quantity::number),
            across_broken: h.across_broken,
            deformation: h.deformation,
        });
    }
    if let Some(at) = &document.species {
        let s = &at.value;
        all.push(Table {
            quantity: Quantity::Species,
            span: &at.span,
            method: &s.method,
            safety: &s.safety,
            tolerance: &s.tolerance,
            reference: s.reference.as_ref().map(value::Quantity::number),
            across_broken: s.across_broken,
            deformation: false,
        });
    }
    all
}

/// All that spreads.
pub(super) fn diffusions(
    context: &Context,
    document: &Document,
    materials: &[MaterialSpec],
    initial: Vec<Said<(String, Expression)>>,
    conditions: Vec<Said<DiffusionCondition>>,
) -> Result<Vec<DiffusionSpec>> {
    let tables = tables(document);
    let spreads = |q: Quantity| tables.iter().any(|t| t.quantity == q);
    let heat = document.material.values().find_map(|m| {
        let span = m.value.heat.as_ref().map(|h| h.span.clone());
        span.map(|s| (Quantity::Heat, s))
    });
    let species = document.material.values().find_map(|m| {
        let span = m.value.species.as_ref().map(|s| s.span.clone());
        span.map(|s| (Quantity::Species, s))
    });
    let said = initial.iter().map(|s| (s.quantity, s.span.clone()));
    let said = said.chain(conditions.iter().map(|s| (s.quantity, s.span.clone())));
    for (quantity, span) in heat.into_iter().chain(species).chain(said) {
        if !spreads(quantity) {
            let name = quantity.name();
            return Err(context.error_with(
                &span,
                format!("this belongs to {name}, which does not spread in this deck"),
                format!("add [{name}], or leave it out"),
            ));
        }
    }
    let (mut initial, mut conditions) = (initial, conditions);
    let mut all = vec![];
    for table in tables {
        let of = |q: Quantity| q == table.quantity;
        let dim = match table.quantity {
            Quantity::Heat => Dim::TEMPERATURE,
            Quantity::Species => Dim::CONCENTRATION,
        };
        let each = materials.iter();
        let each = each.map(|m| material(context, document, &table, &m.name));
        all.push(DiffusionSpec {
            quantity: table.quantity,
            method: method(context, &table)?,
            reference: match &table.reference {
                Some(number) => context.finite(number, dim)?,
                None if table.quantity == Quantity::Heat => {
                    context.has_reference(table.quantity.name())?;
                    0.0
                }
                None => 0.0,
            },
            across_broken: table.across_broken,
            deformation: table.deformation,
            materials: each.collect::<Result<_>>()?,
            initial: { initial.extract_if(.., |s| of(s.quantity)) }
                .map(|s| s.what)
                .collect(),
            conditions: { conditions.extract_if(.., |s| of(s.quantity)) }
                .map(|s| s.what)
                .collect(),
        });
    }
    Ok(all)
}

fn material(
    context: &Context,
    document: &Document,
    table: &Table,
    name: &str,
) -> Result<DiffusionMaterial> {
    let quantity = table.quantity;
    let missing = |span: &Range<usize>, example: &str| {
        Err(context.error_with(
            span,
            format!(
                "the material \"{name}\" does not say what it does with {}",
                quantity.name()
            ),
            format!("write {} = {example} in it", quantity.name()),
        ))
    };
    let Some(written) = document.material.get(name) else {
        return missing(table.span, "{ … }");
    };
    match quantity {
        Quantity::Heat => {
            let Some(heat) = &written.value.heat else {
                return missing(
                    &written.span,
                    "{ conductivity = \"45 W/m/K\", capacity = \"460 J/kg/K\" }",
                );
            };
            let h = &heat.value;
            Ok(DiffusionMaterial {
                conductivity: context.value(&h.conductivity)?,
                capacity: context.value(&h.capacity)?,
                expansion: match &h.expansion {
                    Some(number) => context.value(number)?,
                    None => 0.0,
                },
            })
        }
        Quantity::Species => {
            let Some(species) = &written.value.species else {
                return missing(&written.span, "{ diffusivity = \"1e-9 m^2/s\" }");
            };
            let s = &species.value;
            Ok(DiffusionMaterial {
                conductivity: context.value(&s.diffusivity)?,
                capacity: 1.0,
                expansion: match &s.swelling {
                    Some(number) => context.value(number)?,
                    None => 0.0,
                },
            })
        }
    }
}

fn method(context: &Context, table: &Table) -> Result<DiffusionMethod> {
    let named = table.method.as_ref().map(|m| m.value);
    let explicit = matches!(named, None | Some(DiffusionName::Explicit));
    let foreign = match explicit {
        true => table
            .tolerance
            .as_ref()
            .map(|n| (n, "tolerance", "the other methods")),
        false => table
            .safety
            .as_ref()
            .map(|n| (n, "safety", "the explicit method")),
    };
    if let Some((number, key, whose)) = foreign {
        return Err(context.error_with(
            &number.span,
            format!("{key} belongs to {whose}"),
            "leave it out",
        ));
    }
    let tolerance = context.value_or(table.tolerance, 1e-12)?;
    Ok(match named {
        None | Some(DiffusionName::Explicit) => {
            let safety = context.value_or(table.safety, 0.9)?;
            if let Some(number) = table.safety
                && safety > 1.0
            {
                return Err(context.error_with(
                    &number.span,
                    format!(
                        "a safety factor of {} is above the stable step",
                        short(safety)
                    ),
                    "write 0.9, or method = \"implicit\", which is stable at any step",
                ));
            }
            DiffusionMethod::Explicit { safety }
        }
        Some(DiffusionName::Implicit) => DiffusionMethod::Implicit {
            theta: 1.0,
            tolerance,
        },
        Some(DiffusionName::CrankNicolson) => DiffusionMethod::Implicit {
            theta: 0.5,
            tolerance,
        },
        Some(DiffusionName::Steady) => DiffusionMethod::Steady { tolerance },
    })
}
