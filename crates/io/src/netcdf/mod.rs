//! netCDF classic: the header of a file and where its numbers stand, in the three variants (CDF-1, 64-bit offset, CDF-5).
//!
//! Format: Unidata, "NetCDF file format specifications", "The NetCDF classic format"; CDF-5 as PnetCDF defines it. Numbers are
//! big-endian; what is neither a record nor a multiple of 4 bytes is filled up. Records, of the one dimension without length, stand
//! one after another at the end.

mod format;
mod header;
mod parse;
#[cfg(test)]
pub mod tests;
mod value;

pub use format::{Header, Version};
pub use header::lay_out;
pub use parse::Reader;
pub use value::{Attribute, Type};
