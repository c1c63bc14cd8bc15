//! netCDF: [`Reader`] reads the classic variants (CDF-1, 64-bit offset, CDF-5) and netCDF-4, the rest writes the last two classic
//! ones: the header of a file and where its numbers stand, so that records can be added to it one by one.
//!
//! Format of what is written: Unidata, "NetCDF file format specifications", "The NetCDF classic format"; CDF-5 as PnetCDF defines
//! it. Numbers are big-endian; what is neither a record nor a multiple of 4 bytes is filled up. Records, of the one dimension
//! without length, stand one after another at the end.

mod format;
mod header;
mod read;
#[cfg(test)]
pub mod tests;
mod value;

pub use format::{Header, Version};
pub use header::lay_out;
pub use read::Reader;
pub use value::{Attribute, Type};
