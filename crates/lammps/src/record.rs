//! What a script printed and wrote, for whoever tells of it afterwards.

use std::path::{Path, PathBuf};

use peridyne_io::write::run_json::MovingBall;

use super::host::{Condition, Form, Push};

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
    /// Spheres that push out, where they were when a line was printed.
    pub spheres: Vec<MovingBall>,
}

impl Record {
    /// Takes a line; of another set of columns, or of a step before the last, a new table begins.
    pub fn line(&mut self, columns: Vec<String>, row: Row) {
        let later = self.rows.last().is_none_or(|r| r.step <= row.step);
        if columns != self.columns || !later {
            self.columns = columns;
            self.rows.clear();
            self.spheres.clear();
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

    /// Where the spheres of these conditions are now.
    pub fn place(&mut self, time: f64, acting: &[Condition]) {
        let spheres = acting.iter().filter_map(|c| match c {
            Condition::Indent {
                form: Form::Sphere,
                push: Push::Out,
                center,
                radius,
                ..
            } => Some((center, radius)),
            _ => None,
        });
        for (n, (center, radius)) in spheres.enumerate() {
            if self.spheres.len() <= n {
                self.spheres.push(MovingBall::default());
            }
            let ball = &mut self.spheres[n];
            ball.radius = *radius;
            ball.path.retain(|p| p[0] < time);
            ball.path.push([time, center[0], center[1], center[2]]);
        }
    }
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
    fn only_spheres_that_push_out_are_balls() {
        let mut record = Record::default();
        let of = |form, push| Condition::Indent {
            members: std::sync::Arc::new(crate::atoms::Members::All),
            stiffness: 1.0,
            form,
            push,
            center: [1.0, 2.0, 3.0],
            radius: 0.5,
        };
        let acting = [
            of(Form::Plane(1), Push::Out),
            of(Form::Sphere, Push::In),
            of(Form::Sphere, Push::Out),
        ];
        record.place(0.0, &acting);
        record.place(0.0, &acting);
        record.place(1.0, &acting);
        assert_eq!(record.spheres.len(), 1);
        assert_eq!(record.spheres[0].path.len(), 2);
    }
}
