//! Columns of several bodies: those of each side by side, then those of the bonds between them.

use super::{MultiBodyInteraction, pieces};
use crate::body::{Body, FieldView, view};
use crate::columns::On;
use crate::interaction::Interaction;

impl<const D: usize> MultiBodyInteraction<D> {
    /// Bodies that have no such column have 0 at their points, and no bonds in it.
    pub(super) fn read_named(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        name: &str,
        out: &mut Vec<f64>,
    ) -> bool {
        out.clear();
        let Some(column) = self.columns().into_iter().find(|c| c.name == name) else {
            return false;
        };
        let numbers = column.shape.stored(D);
        let mut own = vec![];
        if column.on == On::Points {
            out.resize(numbers * body.len, 0.0);
        }
        for (p, bonds) in self.each(body) {
            if bonds.read_column(&p.body, p.part(u), name, &mut own) {
                match column.on {
                    On::Points => {
                        out[numbers * p.first..][..own.len()].copy_from_slice(&own);
                    }
                    On::Bonds => out.extend_from_slice(&own),
                }
            }
        }
        if column.on == On::Bonds {
            for interface in &self.interfaces {
                if interface.read_bonds(name, &mut own) {
                    out.extend_from_slice(&own);
                }
            }
        }
        true
    }

    pub(super) fn write_named(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        let Some(column) = self.columns().into_iter().find(|c| c.name == name) else {
            return false;
        };
        let numbers = column.shape.stored(D);
        let mut first = 0;
        let mut parts = vec![];
        for (n, (p, own)) in pieces(body).iter().zip(&self.own).enumerate() {
            let Some(bonds) = &own.bonds else { continue };
            if !bonds.columns().iter().any(|c| c.name == name) {
                continue;
            }
            let range = match column.on {
                On::Points => numbers * p.first..numbers * (p.first + p.body.len),
                On::Bonds => {
                    let (begin, mut own) = (first, vec![]);
                    bonds.read_column(&p.body, view(&p.body.at_rest()), name, &mut own);
                    first += own.len();
                    begin..first
                }
            };
            parts.push((n, range));
        }
        let mut ends = vec![];
        if column.on == On::Bonds {
            let mut own = vec![];
            for (n, interface) in self.interfaces.iter().enumerate() {
                if interface.read_bonds(name, &mut own) {
                    ends.push((n, first..first + own.len()));
                    first += own.len();
                }
            }
        }
        let length = match column.on {
            On::Points => numbers * body.len,
            On::Bonds => first,
        };
        if values.len() != length {
            return false;
        }
        let pieces = pieces(body);
        let inside = parts.into_iter().all(|(n, range)| {
            let bonds = self.own[n].bonds.as_mut().expect("it has the column");
            bonds.write_column(&pieces[n].body, name, &values[range])
        });
        let mut ends = ends.into_iter();
        inside && ends.all(|(n, range)| self.interfaces[n].write_bonds(name, &values[range]))
    }
}
