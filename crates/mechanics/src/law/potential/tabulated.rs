//! Embedded-atom models from tables, as eam/alloy, eam/fs and eam files hold them.

use super::cut::{Ends, numbers};
use super::{Described, Potential, Unlike};
use crate::columns::Dimension;
use crate::law::descriptor::{Bounds, Descriptor, Key, Need, Value, Wrong, number};
use crate::law::number::Number;
use crate::law::spline::{Spline, Twin};
use crate::spec::{Mixing, Parameter, Parameters, PartnerTable, TableSpec};
use std::sync::Arc;

/// Tables, and what their lengths and energies are multiplied by.
#[derive(Debug, Clone, PartialEq)]
pub struct Eam {
    pub table: Arc<TableSpec>,
    pub length_scale: f64,
    pub energy_scale: f64,
}

impl Eam {
    /// The tables as they are.
    pub fn new(table: TableSpec) -> Eam {
        Eam {
            table: Arc::new(table),
            length_scale: 1.0,
            energy_scale: 1.0,
        }
    }
}

impl Described for Eam {
    const NAME: &'static str = "eam";
    type Made = Arc<Tabulated>;

    fn descriptor() -> Descriptor {
        let scale = |name, doc| number(name, Dimension::NUMBER, Bounds::POSITIVE, doc).or(1.0);
        Descriptor::new(
            Self::NAME,
            "Atoms: embedded-atom model from a table, eam/alloy (setfl), eam/fs (.fs) or .eam (funcfl).",
        )
        .source("Daw & Baskes 1984")
        .example("{ file = \"Cu.eam.alloy\" }")
        .keys(&[
            Key {
                name: "file",
                value: Value::Table,
                need: Need::Given,
                doc: "Relative to the deck; names that end in .eam are funcfl files, one element each, those in .fs eam/fs files. In eV and Å.",
            },
            Key {
                name: "element",
                value: Value::Name,
                need: Need::Optional,
                doc: "Needed where the file has several.",
            },
            scale(
                "length_scale",
                "Lengths of the table are multiplied by this; 1 by default.",
            ),
            scale(
                "energy_scale",
                "Energies of the table are multiplied by this; 1 by default.",
            ),
        ])
    }

    fn read(p: &Parameters) -> Result<Self, Wrong> {
        let Some(table) = p.table("file").cloned() else {
            return Err(("file".into(), "the tables are missing".into()));
        };
        let [length_scale, energy_scale] = numbers(p, ["length_scale", "energy_scale"])?;
        Ok(Eam {
            table,
            length_scale,
            energy_scale,
        })
    }

    fn parameters(&self) -> Parameters {
        let scales = [
            ("length_scale", self.length_scale),
            ("energy_scale", self.energy_scale),
        ];
        Parameters::numbers(&scales).with("file", Parameter::Table(self.table.clone()))
    }

    fn made(self, _: Ends) -> Arc<Tabulated> {
        let scaled = self.table.scaled(self.length_scale, self.energy_scale);
        Arc::new(Tabulated::new(&scaled))
    }

    fn reach(&self) -> f64 {
        self.length_scale * self.table.cutoff
    }

    const UNLIKE: Unlike = Unlike::Whole;

    fn mixed(own: [(Self, Ends); 2], _: Option<Mixing>) -> Result<Arc<Tabulated>, Wrong> {
        let [(here, _), (there, _)] = own;
        let scales = |e: &Eam| [e.length_scale, e.energy_scale];
        if scales(&here) != scales(&there) {
            let message = "elements of one embedded-atom model have the same scales";
            return Err(("length_scale".into(), message.into()));
        }
        let scaled = |e: &Eam| e.table.scaled(e.length_scale, e.energy_scale);
        let (here, there) = (scaled(&here), scaled(&there));
        match Tabulated::between(&here, &there) {
            Some(made) => Ok(Arc::new(made)),
            None => {
                let message = format!(
                    "the tables of {} and {} say nothing of each other: name both from one file, or from .eam files",
                    here.element, there.element
                );
                Err(("file".into(), message))
            }
        }
    }

    fn scaled(parameters: &mut Parameters, length: f64, energy: f64) {
        for (key, factor) in [("length_scale", length), ("energy_scale", energy)] {
            let old = parameters.number(key).unwrap_or(1.0);
            parameters.set(key, Parameter::Number(old * factor));
        }
    }
}

/// F(ρ), f(r) and r φ(r) as piecewise cubics.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    embedding: Spline,
    /// f and r φ (energy · length).
    bonds: Twin,
    /// What an atom here adds at one of another element there.
    given: Option<Spline>,
    cutoff: f64,
}

impl Tabulated {
    /// Splines through the values. Beyond the last density F goes on as a straight line.
    ///
    /// # Panics
    /// If a table has fewer than five values, or f and r φ differ in number.
    pub fn new(table: &TableSpec) -> Tabulated {
        Tabulated {
            embedding: Spline::new(0.0, table.density_step, &table.embedding, true),
            bonds: Twin::new(
                &Spline::new(0.0, table.step, &table.density, false),
                &Spline::new(0.0, table.step, &table.pair, false),
            ),
            given: None,
            cutoff: table.cutoff,
        }
    }

    /// Between an atom of one element and those of another; `None`: the tables do not know each other.
    pub fn between(here: &TableSpec, there: &TableSpec) -> Option<Tabulated> {
        let find = |of: &TableSpec, name: &str| {
            let found = of.partners.iter().find(|p| p.element == name);
            match of.element == name {
                // of its own element, in a material of its own
                true => Some(PartnerTable {
                    element: of.element.clone(),
                    density: of.density.clone(),
                    pair: of.pair.clone(),
                }),
                false => found.cloned(),
            }
        };
        let (near, far) = (find(here, &there.element)?, find(there, &here.element)?);
        let knots = |t: &TableSpec| (t.step, t.pair.len(), t.cutoff);
        if knots(here) != knots(there) || near.pair != far.pair {
            return None;
        }
        let spline = |values: &[f64]| Spline::new(0.0, here.step, values, false);
        Some(Tabulated {
            bonds: Twin::new(&spline(&near.density), &spline(&near.pair)),
            given: Some(spline(&far.density)),
            ..Tabulated::new(here)
        })
    }
}

impl Potential for Tabulated {
    const EMBEDDED: bool = true;

    fn cutoff(&self) -> f64 {
        self.cutoff
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        let r = q.sqrt();
        r.of_twin(&self.bonds, 1) * r.recip()
    }

    #[inline(always)]
    fn density<N: Number>(&self, q: N) -> N {
        q.sqrt().of_twin(&self.bonds, 0)
    }

    #[inline(always)]
    fn both<N: Number>(&self, q: N) -> [N; 2] {
        let r = q.sqrt();
        let [density, pair] = r.twin(&self.bonds);
        [pair * r.recip(), density]
    }

    #[inline(always)]
    fn given<N: Number>(&self, q: N) -> N {
        match &self.given {
            Some(given) => q.sqrt().table(given),
            None => self.density(q),
        }
    }

    #[inline(always)]
    fn embedding<N: Number>(&self, density: N) -> N {
        density.table(&self.embedding)
    }
}
