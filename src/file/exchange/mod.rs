//! Formats of other programs.

mod stl;

pub use stl::{read_stl, write_stl};
