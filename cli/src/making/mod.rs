//! What is made of sources.

pub mod dexel_boolean;
pub mod dexel_surface;
pub mod operands;
pub mod part;
pub mod picture;
