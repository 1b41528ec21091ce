//! Sources: from a file of any kind to a solid on a frame.
//!
//! A name becomes an `input`, `content` recognises the kind of the file, and a `file` of known kind is read
//! as a `mesh`, a `scene`, a `volume` or a stored solid. A `placing` is a map to a new place; `moved` moves
//! stored solids there. A `solid` is any of them, a `target` is a solid that answers questions, and a `stock`
//! holds the parts that a `plan` lays out. A `density` makes masses of volumes.

pub mod content;
pub mod corners;
pub mod density;
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
