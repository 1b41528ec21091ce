//! Expressions of solids by their definition, and random ones.

mod model;
mod random;

pub use model::{Model, Other, Point, Probe};
pub use random::Maker;
