//! Bodies that end: factors of bonds near the surface that make uniform strain exact.
//!
//! [`bar`] is the peristatic bar of Eriksson and Stenström (2020), in fractions or `f64`.
//! [`surface`] does the same for plates and blocks of any shape on a lattice.

pub mod bar;
pub mod surface;
