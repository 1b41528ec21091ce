//! What a file can hold as its solid.

use super::compose::Section;
use super::header::{Header, Model};
use super::layout::Layout;
use crate::error::{Error, FormatError};
use crate::octree::{Channel, Metadata};
use alloc::sync::Arc;
use alloc::vec::Vec;

/// A solid whose arrays are the sections of a file.
///
/// The trait is what solids differ in. All that they have in common is written once, for any of them: the
/// ways in are in `read.rs`, the ways out in `write.rs`.
pub(super) trait Stored: Sized {
    /// What a header says of files with such solids.
    const MODEL: Model;

    /// Whether such solids have channels.
    const CHANNELS: bool = false;

    /// A view of the arrays, wherever they lie.
    type View<'a>;

    /// What must be known besides the [`Layout`] to read the arrays in place.
    type Shape;

    /// What a file has in the place of arrays that lie in memory otherwise.
    type Prepared;

    /// Reads the shape, and checks all of it that views rely on. `bytes` are in the file's order and may have
    /// any alignment.
    fn shape(layout: &Layout, bytes: &[u8]) -> Result<Self::Shape, Error>;

    /// The solid in `bytes`, whose numbers have this machine's order.
    fn view<'a>(layout: &Layout, shape: &Self::Shape, bytes: &'a [u8])
    -> Result<Self::View<'a>, FormatError>;

    /// The same view, once all of its arrays have been found right.
    fn checked(view: Self::View<'_>) -> Result<Self::View<'_>, Error>;

    /// A solid whose arrays lie in `owner`.
    fn attach<C: Send + Sync + 'static>(
        owner: Arc<C>,
        metadata: Metadata,
        view: impl for<'a> FnOnce(&'a C) -> Result<Self::View<'a>, Error>,
    ) -> Result<Self, Error>;

    /// The view of the solid.
    fn as_view(&self) -> Self::View<'_>;

    /// The facts that its file carries along.
    fn metadata(&self) -> &Metadata;

    /// The channels, in the order in which its file has them.
    fn channels(&self) -> &[Channel] {
        &[]
    }

    /// The same solid with the channels of its file.
    fn with_channels(self, _: Vec<Channel>) -> Self {
        self
    }

    /// Prepares writing.
    fn prepare(&self) -> Result<Self::Prepared, Error>;

    /// Appends the sections of the arrays, in ascending order; returns the header, in which only lengths and
    /// checksums are missing.
    fn append_sections<'a>(&'a self, prepared: &'a Self::Prepared, sections: &mut Vec<Section<'a>>)
    -> Header;
}
