//! Which numbers of a snapshot a picture shows: one for each point, their range, and their colours.

use std::io;

use peridyne::columns::{Dimension, Shape};
use peridyne::observe::{Column, Snapshot, Values};

use super::super::fields::invalid;
use super::colormap::Map;
use super::extent::strays;

/// What a run was about, where nobody says what to show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum About {
    /// Bonds broke.
    Fracture,
    Equilibrium,
    /// Points move and nothing breaks.
    Motion,
    /// Nothing moves, and what this column is of spreads.
    Spread(&'static str),
}

impl About {
    /// The field that shows it.
    pub fn field(self) -> &'static str {
        match self {
            About::Fracture => "damage",
            About::Equilibrium => "displacement",
            About::Motion => "velocity",
            About::Spread(column) => column,
        }
    }

    /// Are displacements magnified, if they are small beside the body?
    pub fn magnified(self) -> bool {
        match self {
            About::Equilibrium => true,
            About::Fracture | About::Motion | About::Spread(_) => false,
        }
    }
}

/// A number for each point.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// As one would read it, `stress yy`.
    pub name: String,
    pub dimension: Dimension,
    pub values: Vec<f64>,
    /// Lowest and highest of these, but for points that have flown away.
    pub ends: [f64; 2],
    /// What the ends of the colours mean.
    pub range: [f64; 2],
    pub map: Map,
}

impl Shown {
    /// Of a column; the magnitude of vectors where no component is named, of tensors that of the whole (√(A : A)).
    ///
    /// # Errors
    /// `InvalidInput`: there is no such column, or it has no such component.
    pub fn of(s: &Snapshot, field: &str, component: Option<&str>) -> io::Result<Shown> {
        let column = s
            .column(field)
            .filter(|c| c.values.len() == s.reference.len());
        let column = column.ok_or_else(|| invalid(format!("the snapshot carries no {field}")))?;
        // on a line a vector is a number with a sign
        let along = (s.dimension == 1 && column.declaration.shape == Shape::Vector).then_some("x");
        let values = values(column, component.or(along))?;
        let name = match component {
            None => field.replace('_', " "),
            Some(part) => format!("{} {part}", field.replace('_', " ")),
        };
        let ends = |all: &mut dyn Iterator<Item = f64>| {
            let finite = all.filter(|v| v.is_finite());
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            })
        };
        // points that have flown away do not set the colours of the others
        let strays = strays(s);
        let (mut low, mut high) = ends(
            &mut values
                .iter()
                .zip(&strays)
                .filter(|(_, stray)| !**stray)
                .map(|(v, _)| *v),
        );
        if low > high {
            (low, high) = ends(&mut values.iter().copied());
        }
        let range = range(field, low, high);
        Ok(Shown {
            name,
            dimension: column.declaration.dimension,
            map: Map::for_range(range),
            ends: [low, high],
            values,
            range,
        })
    }

    /// With the ends of the colours given.
    pub fn between(mut self, range: [f64; 2]) -> Shown {
        self.range = range;
        self.map = Map::for_range(range);
        self
    }

    /// Where a value lies in the map, 0 to 1: between the ends; of a diverging map 0 in its middle, as far on either side. What is no number
    /// lies at the lower end.
    pub fn part(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        if value.is_nan() {
            return self.part(low);
        }
        let value = value.clamp(low, high);
        match self.map {
            Map::Sequential => (value - low) / (high - low),
            Map::Diverging => 0.5 + 0.5 * value / low.abs().max(high),
        }
    }
}

/// Ends of the colours: of damage always 0 and 1, of others from 0 where that is near.
pub fn range(field: &str, low: f64, high: f64) -> [f64; 2] {
    if field == "damage" || low > high {
        return [0.0, 1.0];
    }
    let size = low.abs().max(high.abs());
    match (low < 0.0 && high > 0.0, low == high) {
        (true, _) => [low, high],
        (false, true) if size == 0.0 => [0.0, 1.0],
        (false, _) if high > 0.0 && low < 0.5 * high => [0.0, high],
        (false, _) if high <= 0.0 && high > 0.5 * low => [low, 0.0],
        (false, true) => [low.min(0.0), high.max(0.0)],
        (false, false) => [low, high],
    }
}

/// Is there such a component?
pub fn component_of(shape: Shape, component: Option<&str>) -> Result<Option<usize>, String> {
    let Some(part) = component.filter(|p| *p != "magnitude") else {
        return Ok(None);
    };
    let known = shape.components();
    match known.iter().position(|k| *k == part) {
        Some(n) => Ok(Some(n)),
        None if known.is_empty() => Err(format!("it is one number: there is no component {part}")),
        None => Err(format!(
            "it has no component {part}, but {} and magnitude",
            known.join(", ")
        )),
    }
}

fn values(column: &Column, component: Option<&str>) -> io::Result<Vec<f64>> {
    let part = component_of(column.declaration.shape, component)
        .map_err(|why| invalid(format!("{}: {why}", column.name())))?;
    let pick = |v: &[f64], weights: &[f64]| match part {
        Some(n) => v[n],
        None => v
            .iter()
            .zip(weights)
            .map(|(x, w)| w * x * x)
            .sum::<f64>()
            .sqrt(),
    };
    Ok(match &column.values {
        Values::Scalars(v) => v.clone(),
        Values::Integers(v) => v.iter().map(|x| f64::from(*x)).collect(),
        Values::Counts(v) => v.iter().map(|x| f64::from(*x)).collect(),
        Values::Vectors(v) => v.iter().map(|x| pick(x, &[1.0; 3])).collect(),
        // off the diagonal each stands for two
        Values::Symmetric(v) => v
            .iter()
            .map(|x| pick(x, &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0]))
            .collect(),
        Values::Tensors(v) => v.iter().map(|x| pick(x, &[1.0; 9])).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::fields::tests::{of_columns, small};
    use super::*;

    #[test]
    fn ends_of_colours() {
        assert_eq!(range("damage", 0.2, 0.3), [0.0, 1.0]);
        assert_eq!(range("stress", -1.0, 3.0), [-1.0, 3.0]);
        assert_eq!(range("velocity", 0.1, 3.0), [0.0, 3.0]);
        assert_eq!(range("stress", -3.0, -0.1), [-3.0, 0.0]);
        assert_eq!(range("density", 9.0, 10.0), [9.0, 10.0]);
        assert_eq!(range("energy", 0.0, 0.0), [0.0, 1.0]);
        assert_eq!(range("block", 4.0, 4.0), [0.0, 4.0]);
        assert_eq!(
            range("nothing", f64::INFINITY, f64::NEG_INFINITY),
            [0.0, 1.0]
        );
    }

    #[test]
    fn zero_is_neutral_and_no_colour_stands_for_values_that_are_not_there() {
        let of = |range: [f64; 2]| {
            let values = Values::Scalars(range.to_vec());
            let still = Values::Vectors(vec![[0.0; 3]; 2]);
            let places = vec![[0.0; 3], [1.0, 0.0, 0.0]];
            let columns = vec![("displacement", still), ("stress", values)];
            Shown::of(&of_columns(places, columns), "stress", None).unwrap()
        };
        // both signs: the key ends where the values do, 0 is grey, the same size has the same depth of colour
        for range in [[-1.0, 3.0], [-4.0, 1.0], [-2.0, 2.0]] {
            let shown = of(range);
            assert_eq!((shown.map, shown.range), (Map::Diverging, range));
            assert_eq!(shown.part(0.0), 0.5);
            let [up, down] = [0.7, -0.7].map(|v| shown.part(v) - 0.5);
            assert!((up + down).abs() < 1e-15, "{up} {down}");
            let most = range.map(|v| (shown.part(v) - 0.5).abs());
            assert_eq!(most[0].max(most[1]), 0.5);
            assert_eq!(shown.part(9.0), shown.part(range[1]));
        }
        // of one sign, or nearly: all of the colours
        for range in [[0.0, 5.0], [-0.2, 5.0], [-5.0, 0.3]] {
            let shown = of(range);
            assert_eq!(shown.map, Map::Sequential);
            assert_eq!(range.map(|v| shown.part(v)), [0.0, 1.0]);
        }
        let told = of([-1.0, 1.0]).between([-1.0, 3.0]);
        assert_eq!((told.part(0.0), told.part(3.0)), (0.5, 1.0));
    }

    #[test]
    fn components_and_magnitudes() {
        let tensors = Values::Symmetric(vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]; 3]);
        let still = Values::Vectors(vec![[0.0; 3]; 3]);
        let columns = vec![("displacement", still), ("stress", tensors)];
        let s = of_columns(small().reference, columns);
        let shown = Shown::of(&s, "stress", Some("xz")).unwrap();
        assert_eq!((shown.values[0], &*shown.name), (5.0, "stress xz"));
        let whole = Shown::of(&s, "stress", None).unwrap().values[0];
        assert!((whole * whole - (14.0 + 2.0 * 77.0)).abs() < 1e-12);
        let wrong = Shown::of(&s, "stress", Some("q")).unwrap_err().to_string();
        assert!(wrong.contains("no component q, but xx"), "{wrong}");
        assert!(Shown::of(&s, "strain", None).is_err());
    }
}
