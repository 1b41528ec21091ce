//! Tri-directional dexel models: intervals along lattice rays that lie inside a solid.
//!
//! The rays run through the centres of finest cells, along x, y and z. A ray holds sorted, disjoint
//! intervals, so that Booleans are merges of short lists, and a crossing of the surface is as exact as a
//! fixed-point number. (Van Hook 1986; in three directions Benouamer and Michelucci 1997, Gao, Zhang and Hou
//! 2007.)
//!
//! **Half-open intervals.** An interval contains its start and not its end. The centre of a cell lies inside
//! if an interval contains it; if there are rays in several directions, the highest axis decides. An
//! algorithm that makes intervals moves an end by at most one unit, so that the centres beside the end are on
//! the same side as in the source. Then the three directions agree on all centres, and remain in agreement
//! through every Boolean.
//!
//! From the bottom up, each file uses only files named before it: `place` (positions on a ray), `normal`
//! (unit vectors in 16 or 32 bits), `line` (places in model units), `format` (the stored data), `item` (an
//! interval with all its data), `columns` (arrays of intervals), `view` (borrowed arrays, for all reading),
//! `centres` (the centres of cells that lie inside), `occupied` (the blocks that contain such centres),
//! `check` (checks of arrays), `arrays` (owned arrays), `model` (the tri-dexel model), `assemble` (models
//! from rows of rays), `from_rays` (models from a host's intervals), `beam` (rays that a solid fills),
//! `merge` (two rays), `boolean` (models), `change` (the effect of a change in place), `editor` (changes in
//! place), `statistics`.

mod arrays;
mod assemble;
mod beam;
mod boolean;
mod centres;
mod change;
mod check;
mod columns;
mod editor;
mod format;
mod from_rays;
mod item;
mod line;
mod merge;
mod model;
mod normal;
mod occupied;
mod place;
mod statistics;
mod view;

pub(crate) use arrays::{Form, ModelArrays};
pub(crate) use assemble::{Piece, assembled};
pub use beam::{Beam, BeamEnd};
pub(crate) use beam::{Scratch, first_above};
pub(crate) use centres::{BLOCK, Passage};
pub use change::DexelChange;
pub(crate) use columns::{ColumnsRef, NormalsRef};
pub use editor::DexelEditor;
pub use format::{DexelEnds, DexelFormat, DexelNormals};
pub(crate) use item::Mark;
pub use model::TriDexel;
pub(crate) use normal::{decoded, encoded};
pub(crate) use occupied::Occupied;
pub(crate) use place::{DoubleSpan, FixedSpan, Place, Span, within};
pub use statistics::DexelStatistics;
pub use view::{Dexel, DexelEnd, DexelRays, TriDexelRef};
pub(crate) use view::{OTHERS, Rows, RowsRef, Window, with_rows};
