//! Channels: values inside a solid, in a tree of their own.

mod value;

pub use value::{ScalarType, ValueType};
