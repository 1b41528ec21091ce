//! Channels: values inside a solid, in a separate tree.
//!
//! [`ChannelRef`] describes the storage of values, and does all reading; [`Channel`] owns or shares the
//! arrays; the writer (crate-internal) is the one place where channels are made.

mod check;
mod owned;
mod point;
mod value;
mod view;
pub(crate) mod writer;

pub use owned::Channel;
pub(crate) use value::Bits;
pub use value::{ScalarType, ValueType};
pub use view::ChannelRef;
pub(crate) use view::Spot;
