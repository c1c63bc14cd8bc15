//! Fields: one column of numbers per component, each beginning on a cache line of its own choice.

use crate::state::{Archive, Owner};
use std::ops::{Deref, DerefMut};

/// Numbers per cache line and lines per page.
const LINE: usize = 8;
const PAGE: usize = 64;

/// `[slots]`: a number per slot, beginning on a given line of a memory page.
///
/// Sweeps read the same slots of several columns at once. Columns that begin at the same place of a page compete for
/// the same few lines of the cache, and loads wait for stores that only look like theirs; the allocator puts all large
/// arrays at the same place.
#[derive(Debug, Default)]
pub struct Column {
    data: Vec<f64>,
    /// Where the numbers begin.
    start: usize,
    len: usize,
    line: usize,
}

impl Column {
    /// `len` copies of `value`, the first on line `line` (mod 64) of a page.
    pub fn new(len: usize, value: f64, line: usize) -> Column {
        let mut data = Vec::with_capacity(len + (PAGE + 1) * LINE);
        let at = data.as_ptr() as usize / size_of::<f64>();
        let page = PAGE * LINE;
        let start = (line % PAGE * LINE + page - at % page) % page;
        data.resize(start + len, value);
        Column {
            data,
            start,
            len,
            line,
        }
    }
}

impl Column {
    /// As many zeros, on its line of a page.
    pub fn renew(&mut self, len: usize) {
        *self = Column::new(len, 0.0, self.line);
    }
}

/// As long as the state says.
impl Owner for Column {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let mut values = match archive.loads() {
            true => vec![],
            false => self.to_vec(),
        };
        archive.list("values", &mut values);
        if archive.loads() {
            self.renew(values.len());
            self.copy_from_slice(&values);
        }
    }
}

impl Clone for Column {
    fn clone(&self) -> Column {
        let mut new = Column::new(self.len, 0.0, self.line);
        new.copy_from_slice(self);
        new
    }
}

impl PartialEq for Column {
    fn eq(&self, other: &Column) -> bool {
        **self == **other
    }
}

impl<'a> IntoIterator for &'a Column {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl Deref for Column {
    type Target = [f64];
    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.data[self.start..self.start + self.len]
    }
}

impl DerefMut for Column {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.data[self.start..self.start + self.len]
    }
}

/// `[D][slots]`: a vector per slot.
pub type Field<const D: usize> = [Column; D];

/// `[D][slots]`: the columns of a field, or those of a range of its slots, to read.
///
/// A body among several has its slots one after another, so that its field is a part of each column of the whole.
pub type FieldView<'a, const D: usize> = [&'a [f64]; D];

/// [`FieldView`], to write.
pub type FieldViewMut<'a, const D: usize> = [&'a mut [f64]; D];

/// A field, or what is seen of one, to read.
#[inline(always)]
pub fn view<const D: usize>(field: &[impl Deref<Target = [f64]>; D]) -> FieldView<'_, D> {
    field.each_ref().map(|column| &**column)
}

/// A field, or what is seen of one, to write.
#[inline(always)]
pub fn view_mut<const D: usize>(
    field: &mut [impl DerefMut<Target = [f64]>; D],
) -> FieldViewMut<'_, D> {
    field.each_mut().map(|column| &mut **column)
}

/// A vector field of zeros.
pub fn zeros<const D: usize>(slots: usize) -> Field<D> {
    filled(slots, 0.0)
}

/// A vector field whose components all are `value`.
pub fn filled<const D: usize>(slots: usize, value: f64) -> Field<D> {
    crate::array::from_fn(|a| Column::new(slots, value, line(a)))
}

/// The line on which column `n` of those that a sweep reads together begins.
pub fn line(n: usize) -> usize {
    9 * n
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_begins_on_its_line_wherever_it_lies() {
        for line in [0, 9, 63, 70] {
            let mut c = Column::new(1000, 2.5, line);
            c[3] = 1.0;
            for c in [c.clone(), c] {
                assert_eq!(c.as_ptr() as usize % 4096, line % 64 * 64);
                assert_eq!((c.len(), c[0], c[3], c[999]), (1000, 2.5, 1.0, 2.5));
            }
        }
        assert_eq!(Column::default().len(), 0);
    }
}
