//! Bodies that end: factors of bonds near the surface that make uniform strain exact.
//!
//! [`bar`] is the peristatic bar of Eriksson and Stenström (2020); [`banded`] solves its equations, in fractions or `f64`.
//! [`surface`] does the same for plates and blocks of any shape on a lattice.

pub mod banded;
pub mod bar;
pub mod surface;
