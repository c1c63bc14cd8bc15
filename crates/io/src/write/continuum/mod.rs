//! Continuum fields at points: a table, NumPy arrays, a VTK image, pictures, and what all of it is.

mod arrays;
mod collected;
mod columns;
mod describe;
mod image;
mod profile;
mod slice;
mod table;

pub use arrays::write_arrays;
pub use collected::{Collected, Made, Origin, examined};
pub use columns::{Column, ORDER, Table};
pub use describe::{About, Frame, describe};
pub use image::write_image;
pub use profile::write_profiles;
pub use slice::write_slice;
pub use table::write_table;
