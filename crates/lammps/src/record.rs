//! What a script printed and wrote, for whoever tells of it afterwards.

use std::path::{Path, PathBuf};

use peridyne::boundary_condition::rigid_body;
use peridyne::space::rigid::RigidShape;
use peridyne_io::write::picture::rigid::{Form, Placed};
use peridyne_io::write::run_json::RigidNote;

use super::host::{Condition, Push};

/// Half of what is shown of a cylinder without end, over its radius.
const LONG: f64 = 50.0;

/// A line of numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    pub step: u64,
    pub time: f64,
    /// In the order of the columns.
    pub values: Vec<f64>,
}

/// Since the script began, or since its last `clear`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    /// Headings of thermo output as it was last.
    pub columns: Vec<String>,
    pub rows: Vec<Row>,
    /// Files with snapshots of atoms, in the order in which they were begun.
    pub dumps: Vec<PathBuf>,
    /// Columns of snapshots that are a field of the model: heading, and field.
    pub fields: Vec<(String, &'static str)>,
    /// What pushes atoms out: where it is, and where it was when a line was printed.
    pub rigid: Vec<Placed>,
    pub notes: Vec<RigidNote>,
}

impl Record {
    /// Takes a line; of another set of columns, or of a step before the last, a new table begins.
    pub fn line(&mut self, columns: Vec<String>, row: Row) {
        let later = self.rows.last().is_none_or(|r| r.step <= row.step);
        if columns != self.columns || !later {
            self.columns = columns;
            self.rows.clear();
            self.notes.clear();
        }
        // the end of a run is the beginning of the next
        if self.rows.last().is_some_and(|r| r.step == row.step) {
            self.rows.pop();
        }
        self.rows.push(row);
    }

    pub fn field(&mut self, heading: &str, field: &'static str) {
        if !self.fields.iter().any(|(h, _)| h == heading) {
            self.fields.push((heading.into(), field));
        }
    }

    pub fn snapshot(&mut self, path: &Path) {
        if !self.dumps.iter().any(|p| p == path) {
            self.dumps.push(path.into());
        }
    }

    /// Names of fields that columns can be.
    pub const FIELDS: [&str; 2] = ["damage", "dilatation"];

    /// Where what pushes atoms out is now.
    pub fn stand(&mut self, acting: &[Condition]) {
        self.rigid = acting.iter().filter_map(pushes).collect();
    }

    /// The same, and for ever.
    pub fn place(&mut self, time: f64, acting: &[Condition]) {
        self.stand(acting);
        for (n, body) in self.rigid.iter().enumerate() {
            if self.notes.len() <= n {
                self.notes.push(RigidNote::of(&body.form));
            }
            let note = &mut self.notes[n];
            if let Form::Ball(radius) = body.form {
                note.radius = radius;
            }
            note.path.retain(|p| p[0] < time);
            note.push(time, body);
        }
    }
}

/// An rigid_body as a rigid body; of one that atoms lie in nothing is seen.
fn pushes(condition: &Condition) -> Option<Placed> {
    let Condition::Indent {
        form,
        push,
        center,
        radius,
        ..
    } = condition
    else {
        return None;
    };
    let unit = |axis: usize, way: f64| -> [f64; 3] {
        std::array::from_fn(|a| if a == axis { way } else { 0.0 })
    };
    let seen = match (form, push) {
        (rigid_body::Form::Sphere, Push::Out) => Form::Ball(*radius),
        (rigid_body::Form::Cylinder(axis), Push::Out) => {
            let shape = RigidShape::Cylinder {
                radius: *radius,
                half: LONG * radius,
                axis: unit(*axis, 1.0),
            };
            Form::of(&shape, 3)
        }
        (rigid_body::Form::Plane(axis), push) => {
            let way = if *push == Push::Out { 1.0 } else { -1.0 };
            Form::Plane(unit(*axis, way))
        }
        (rigid_body::Form::Sphere | rigid_body::Form::Cylinder(_), Push::In) => return None,
    };
    Some(Placed::new(seen, *center))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(step: u64, value: f64) -> Row {
        Row {
            step,
            time: step as f64,
            values: vec![value],
        }
    }

    #[test]
    fn runs_that_go_on_are_one_table_and_others_begin_anew() {
        let mut record = Record::default();
        let columns = || vec!["Temp".to_string()];
        for (step, value) in [(0, 1.0), (10, 2.0), (10, 3.0), (20, 4.0)] {
            record.line(columns(), row(step, value));
        }
        let values: Vec<f64> = record.rows.iter().map(|r| r.values[0]).collect();
        assert_eq!(values, [1.0, 3.0, 4.0]);
        record.line(columns(), row(0, 5.0));
        assert_eq!(record.rows, [row(0, 5.0)]);
        record.line(vec!["Press".into()], row(10, 6.0));
        assert_eq!(record.rows, [row(10, 6.0)]);
    }

    #[test]
    fn what_pushes_out_is_a_body_where_it_is() {
        let mut record = Record::default();
        let of = |form, push, x| Condition::Indent {
            members: std::sync::Arc::new(crate::atoms::Members::All),
            stiffness: 1.0,
            form,
            push,
            center: [x, 2.0, 3.0],
            radius: 0.5,
        };
        let acting = |x: f64| {
            [
                of(rigid_body::Form::Sphere, Push::In, x),
                of(rigid_body::Form::Sphere, Push::Out, x),
                of(rigid_body::Form::Plane(1), Push::In, x),
            ]
        };
        for (time, x) in [(0.0, 1.0), (0.0, 1.0), (1.0, 4.0)] {
            record.place(time, &acting(x));
        }
        assert_eq!(record.rigid.len(), 2);
        assert_eq!(
            record.rigid[0],
            Placed::new(Form::Ball(0.5), [4.0, 2.0, 3.0])
        );
        assert_eq!(record.rigid[1].form, Form::Plane([0.0, -1.0, 0.0]));
        assert_eq!(
            record.notes[0].path,
            [[0.0, 1.0, 2.0, 3.0], [1.0, 4.0, 2.0, 3.0]]
        );
    }
}
