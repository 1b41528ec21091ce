//! The trait of solids that a file can store.

use super::compose::Section;
use super::header::{Header, Model};
use super::layout::Layout;
use crate::error::{Error, FormatError};
use crate::octree::{Channel, Metadata};
use alloc::sync::Arc;
use alloc::vec::Vec;

/// A solid whose arrays are the sections of a file.
///
/// The trait covers the differences between solids. The common code exists once for all of them: reading in
/// `read.rs`, writing in `write.rs`.
pub(super) trait Stored: Sized {
    /// The kind of the solid in the header.
    const MODEL: Model;

    /// Whether such solids have channels.
    const CHANNELS: bool = false;

    /// A view of the arrays, wherever they lie.
    type View<'a>;

    /// The data needed besides the [`Layout`] to read the arrays in place.
    type Shape;

    /// The data of a file that replaces arrays with another layout in memory.
    type Prepared;

    /// Reads the shape, and checks everything that views rely on. `bytes` are in the file's byte order and
    /// may have any alignment.
    fn shape(layout: &Layout, bytes: &[u8]) -> Result<Self::Shape, Error>;

    /// Returns a view of the solid in `bytes`, whose numbers have this machine's byte order.
    fn view<'a>(layout: &Layout, shape: &Self::Shape, bytes: &'a [u8])
    -> Result<Self::View<'a>, FormatError>;

    /// Returns the view after checking all of its arrays.
    fn checked(view: Self::View<'_>) -> Result<Self::View<'_>, Error>;

    /// Makes a solid whose arrays lie in `owner`.
    fn attach<C: Send + Sync + 'static>(
        owner: Arc<C>,
        metadata: Metadata,
        view: impl for<'a> FnOnce(&'a C) -> Result<Self::View<'a>, Error>,
    ) -> Result<Self, Error>;

    /// Returns a view of the solid.
    fn as_view(&self) -> Self::View<'_>;

    /// Returns the metadata of its file.
    fn metadata(&self) -> &Metadata;

    /// Returns the channels, in the order of its file.
    fn channels(&self) -> &[Channel] {
        &[]
    }

    /// Returns the solid with the channels of its file.
    fn with_channels(self, _: Vec<Channel>) -> Self {
        self
    }

    /// Prepares the data for writing.
    fn prepare(&self) -> Result<Self::Prepared, Error>;

    /// Appends the sections of the arrays, in ascending order; returns the header without lengths and
    /// checksums.
    fn append_sections<'a>(&'a self, prepared: &'a Self::Prepared, sections: &mut Vec<Section<'a>>)
    -> Header;
}
