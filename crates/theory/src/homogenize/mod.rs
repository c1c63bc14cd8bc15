//! Bodies whose ends deform like their middle: factors on bonds near the surface that make uniform strain exact.
//!
//! [`bar`] is the peristatic bar of Eriksson and Stenström (2020); [`banded`] solves its equations, in fractions or `f64`.

pub mod banded;
pub mod bar;
