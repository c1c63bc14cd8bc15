//! Values of a column.

use crate::columns::{Declaration, Shape};
use crate::space::Point;

/// One value per point, in order of point id; of columns over bonds one per bond. Components of axes beyond the dimension are 0.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    Scalars(Vec<f64>),
    Vectors(Vec<Point>),
    /// xx yy zz xy xz yz
    Symmetric(Vec<[f64; 6]>),
    /// Row by row.
    Tensors(Vec<[f64; 9]>),
    /// Whole numbers that may be negative.
    Integers(Vec<i32>),
    Counts(Vec<u32>),
}

impl Values {
    pub fn len(&self) -> usize {
        match self {
            Values::Scalars(v) => v.len(),
            Values::Vectors(v) => v.len(),
            Values::Symmetric(v) => v.len(),
            Values::Tensors(v) => v.len(),
            Values::Integers(v) => v.len(),
            Values::Counts(v) => v.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub fn shape(&self) -> Shape {
        match self {
            Values::Scalars(_) | Values::Integers(_) | Values::Counts(_) => Shape::Scalar,
            Values::Vectors(_) => Shape::Vector,
            Values::Symmetric(_) => Shape::Symmetric,
            Values::Tensors(_) => Shape::Tensor,
        }
    }

    /// Component `c` of value `i`, in the order of their [names](Shape::components).
    pub fn at(&self, i: usize, c: usize) -> f64 {
        match self {
            Values::Scalars(v) => v[i],
            Values::Vectors(v) => v[i][c],
            Values::Symmetric(v) => v[i][c],
            Values::Tensors(v) => v[i][c],
            Values::Integers(v) => f64::from(v[i]),
            Values::Counts(v) => f64::from(v[i]),
        }
    }

    /// Size of value `i`: of a vector its length, of a tensor `√(T:T)`.
    pub fn size(&self, i: usize) -> f64 {
        let square = |c: &[f64]| c.iter().map(|x| x * x).sum::<f64>();
        match self {
            Values::Scalars(_) | Values::Integers(_) | Values::Counts(_) => self.at(i, 0).abs(),
            Values::Vectors(v) => square(&v[i]).sqrt(),
            Values::Symmetric(v) => (square(&v[i][..3]) + 2.0 * square(&v[i][3..])).sqrt(),
            Values::Tensors(v) => square(&v[i]).sqrt(),
        }
    }

    /// Numbers as laws store them in `d` dimensions, as [`unpacked`](Values::unpacked) takes them.
    pub fn packed(&self, shape: Shape, d: usize) -> Vec<f64> {
        let axes = &b"xyz"[..d];
        let there = |name: &&str| name.bytes().all(|axis| axes.contains(&axis));
        let names = shape.components().iter().enumerate();
        let kept: Vec<usize> = match shape {
            Shape::Scalar => vec![0],
            Shape::Vector | Shape::Symmetric | Shape::Tensor => {
                names.filter(|(_, n)| there(n)).map(|(c, _)| c).collect()
            }
        };
        let each = (0..self.len()).flat_map(|i| kept.iter().map(move |c| self.at(i, *c)));
        each.collect()
    }

    /// From numbers as laws store them, [`Shape::stored`] for each value in `d` dimensions.
    pub fn unpacked(shape: Shape, d: usize, stored: &[f64]) -> Values {
        let rows = stored.chunks_exact(shape.stored(d));
        match shape {
            Shape::Scalar => Values::Scalars(stored.to_vec()),
            Shape::Vector => {
                let of =
                    |row: &[f64]| crate::array::from_fn(|a| row.get(a).copied().unwrap_or(0.0));
                Values::Vectors(rows.map(of).collect())
            }
            Shape::Symmetric => {
                // the pairs of axes that there are, in the order of three dimensions
                let places: &[usize] = match d {
                    1 => &[0],
                    2 => &[0, 1, 3],
                    _ => &[0, 1, 2, 3, 4, 5],
                };
                let of = |row: &[f64]| {
                    let mut all = [0.0; 6];
                    places.iter().zip(row).for_each(|(p, x)| all[*p] = *x);
                    all
                };
                Values::Symmetric(rows.map(of).collect())
            }
            Shape::Tensor => {
                let of = |row: &[f64]| {
                    let mut all = [0.0; 9];
                    for (k, x) in row.iter().enumerate() {
                        all[3 * (k / d) + k % d] = *x;
                    }
                    all
                };
                Values::Tensors(rows.map(of).collect())
            }
        }
    }
}

/// A declared column and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    pub declaration: Declaration,
    pub values: Values,
}

impl Column {
    pub fn name(&self) -> &str {
        &self.declaration.name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_laws_store_comes_back() {
        for d in 1..=3 {
            for shape in [
                Shape::Scalar,
                Shape::Vector,
                Shape::Symmetric,
                Shape::Tensor,
            ] {
                let count = 2 * shape.stored(d);
                let stored: Vec<f64> = (0..count).map(|n| n as f64 - 0.5).collect();
                let values = Values::unpacked(shape, d, &stored);
                assert_eq!(values.packed(shape, d), stored, "{shape:?} {d}");
            }
        }
    }

    #[test]
    fn components_stand_where_their_names_are() {
        let numbers = [1.0, 2.0, 3.0, 4.0];
        let symmetric = Values::unpacked(Shape::Symmetric, 2, &numbers[..3]);
        assert_eq!(
            symmetric,
            Values::Symmetric(vec![[1.0, 2.0, 0.0, 3.0, 0.0, 0.0]])
        );
        assert_eq!(Shape::Symmetric.components()[3], "xy");
        assert_eq!(symmetric.size(0), (1.0f64 + 4.0 + 2.0 * 9.0).sqrt());
        let tensor = Values::unpacked(Shape::Tensor, 2, &numbers);
        let yx = Shape::Tensor
            .components()
            .iter()
            .position(|n| *n == "yx")
            .unwrap();
        assert_eq!((tensor.at(0, 1), tensor.at(0, yx)), (2.0, 3.0));
        let vectors = Values::unpacked(Shape::Vector, 1, &numbers);
        assert_eq!(
            (vectors.len(), vectors.at(3, 0), vectors.at(3, 1)),
            (4, 4.0, 0.0)
        );
        for shape in [Shape::Vector, Shape::Symmetric, Shape::Tensor] {
            assert_eq!(shape.components().len(), shape.numbers());
        }
    }
}
