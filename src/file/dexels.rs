//! Files of tri-dexel models: the functions of [`file`](super) for [`TriDexel`](crate::TriDexel) in place of
//! [`Octree`](crate::Octree).
//!
//! The format is the same, version 0.3: header, section table, and sections, which are the model's arrays as
//! they lie in memory. A file holds either an octree or a tri-dexel model. The functions for one refuse a
//! file of the other with [`FormatError::OtherModel`](crate::error::FormatError::OtherModel).
//! [`file::probe`](super::probe) and [`file::verify`](super::verify) accept both.
//!
//! | function | reads | checks | cost |
//! |---|---|---|---|
//! | [`map`], [`view`], [`from_static`] (bytes) | in place | header, section table, bounds, objects, windows | O(sections + objects) |
//! | [`map_verified`], [`verify`](super::verify) (bytes) | in place | everything | O(n) |
//! | [`open`], [`from_bytes`] | a copy | everything | O(n) |
//!
//! After [`view`], [`map`] or [`from_static`] the intervals are unchecked. Queries about single rays and
//! cells are safe whatever the intervals are, and visit each interval at most once; they return what the file
//! contains. Operations on the whole model, such as Booleans, [check](crate::dexel::TriDexelRef::check) it
//! first and return [`Error::DamagedRays`](crate::Error::DamagedRays) if it is damaged.
//!
//! ```no_run
//! use leafless::{Control, file::dexels, dexel::DexelEditor};
//! let part = dexels::open("part.lfl")?;
//! let tool = dexels::open("tool.lfl")?;
//! let mut editor = DexelEditor::new(part.view())?;
//! editor.subtract(tool.view(), &Control::default())?;
//! dexels::save(&editor.freeze(&Control::default())?, "cut.lfl")?;
//! # Ok::<(), leafless::Error>(())
//! ```

pub use super::tridexel::{from_bytes, from_static, to_bytes, view};
#[cfg(feature = "mmap")]
pub use super::tridexel::{map, map_verified};
#[cfg(feature = "std")]
pub use super::tridexel::{open, save, write_to};
