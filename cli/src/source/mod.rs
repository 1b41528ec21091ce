//! Sources: from a file of any kind to a solid on a frame.
//!
//! A name becomes an `input`, the `content` says what kind of file it is, and a `file` that was looked at is
//! taken as a `mesh`, a `scene`, a `volume` or a stored solid. A `placing` says where it is moved to, and
//! `moved` makes stored solids anew there. A `solid` is any of them; a `target` is one that questions are put
//! to, and a `stock` what is laid out by a `plan`.

pub mod content;
pub mod corners;
pub mod expression;
pub mod file;
pub mod histogram;
pub mod input;
pub mod mesh;
pub mod moved;
pub mod placing;
pub mod plan;
pub mod scene;
pub mod solid;
pub mod stock;
pub mod target;
pub mod values;
pub mod volume;
