//! Files.

mod exchange;

pub use exchange::{read_stl, write_stl};
