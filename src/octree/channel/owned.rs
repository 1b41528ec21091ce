//! The owned, shared, immutable channel.

use super::value::ValueType;
use super::view::ChannelRef;
use crate::error::Error;
use crate::lattice::Frame;
use crate::octree::Metadata;
use crate::octree::arrays::Arrays;
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use once_cell::race::OnceBox;
use yoke::Yoke;
use yoke::erased::ErasedArcCart;

/// A named array of values inside a cube: a colour, a temperature, a material at every point.
///
/// A channel belongs to the solid that it is [attached](crate::Octree::with_channel) to, and is stored in its
/// file. It has its own tree, which may be finer or coarser than the solid's. A channel is immutable, a clone
/// costs two reference counts, and any number of threads may read it at once. [`ChannelRef`] describes the
/// storage of values; all reading goes through the [`view`](Channel::view).
#[derive(Clone)]
pub struct Channel {
    arrays: Yoke<ChannelRef<'static>, ErasedArcCart>,
    metadata: Arc<Metadata>,
    /// The result of checking the links: those of a mapped file are checked when the channel is first read.
    checked: Option<Arc<OnceBox<bool>>>,
}

/// The arrays behind a channel in memory.
pub(super) struct ChannelArrays {
    pub arrays: Arrays,
    pub value_type: ValueType,
    pub value_rel: Vec<u16>,
    pub value_base: Vec<u64>,
    pub values: Vec<u8>,
}

impl Channel {
    pub(super) fn new(arrays: ChannelArrays, metadata: Metadata) -> Channel {
        let attached = Yoke::<ChannelRef<'static>, Arc<ChannelArrays>>::attach_to_cart(
            Arc::new(arrays),
            |arrays: &ChannelArrays| ChannelRef {
                tree: arrays.arrays.view(),
                value_type: arrays.value_type,
                value_rel: &arrays.value_rel,
                value_base: &arrays.value_base,
                values: &arrays.values,
            },
        );
        Channel { arrays: attached.erase_arc_cart(), metadata: Arc::new(metadata), checked: None }
    }

    /// Makes a channel whose arrays lie in `owner`. Its links are checked on first use, unless they are
    /// `verified`.
    pub(crate) fn attach<C: Send + Sync + 'static, E>(
        owner: Arc<C>,
        metadata: Metadata,
        verified: bool,
        view: impl for<'a> FnOnce(&'a C) -> Result<ChannelRef<'a>, E>,
    ) -> Result<Channel, E> {
        Ok(Channel {
            arrays: Yoke::<ChannelRef<'static>, Arc<C>>::try_attach_to_cart(owner, view)?.erase_arc_cart(),
            metadata: Arc::new(metadata),
            checked: if verified { None } else { Some(Arc::new(OnceBox::new())) },
        })
    }

    /// Returns the name of the channel within a solid: the value of `name` in its metadata; empty if there is
    /// none.
    pub fn name(&self) -> &str {
        self.metadata.get("name").unwrap_or("")
    }

    /// Returns the same channel with another name; the arrays are shared.
    #[must_use]
    pub fn with_name(&self, name: &str) -> Channel {
        let mut metadata = (*self.metadata).clone();
        metadata.insert("name", name);
        self.with_metadata(metadata)
    }

    /// Returns the facts about the channel that its file stores. Names in use: `name`, `unit` (of the
    /// values), `meaning` (such as `colour` or `density`).
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// Returns the same channel with other metadata; the arrays are shared.
    #[must_use]
    pub fn with_metadata(&self, metadata: Metadata) -> Channel {
        Channel { metadata: Arc::new(metadata), ..self.clone() }
    }

    /// Returns the same channel with the metadata of another channel, which are shared.
    #[must_use]
    pub fn with_metadata_from(&self, other: &Channel) -> Channel {
        Channel { metadata: other.metadata.clone(), ..self.clone() }
    }

    /// Returns the frame of the channel: the solid's cube, and the channel's own depth, which limits the
    /// resolution of its values.
    pub fn frame(&self) -> &Frame {
        self.arrays.get().frame()
    }

    /// Returns the type of the values.
    pub fn value_type(&self) -> ValueType {
        self.arrays.get().value_type()
    }

    /// Returns the number of stored values: one for each run of equal values.
    pub fn value_count(&self) -> u64 {
        self.arrays.get().value_count()
    }

    /// Returns the bytes of the channel's arrays: elements, bricks, ranks and values.
    pub fn bytes(&self) -> u64 {
        let ChannelRef { tree, value_rel, value_base, values, .. } = self.arrays.get();
        let links = size_of_val(tree.planes) + size_of_val(tree.rel) + size_of_val(tree.base);
        let ranks = size_of_val(*value_rel) + size_of_val(*value_base);
        (links + ranks + values.len()) as u64 + tree.bricks.bytes() as u64
    }

    /// Returns the view through which all reading goes. Free, except for a channel of a file that was mapped
    /// without verification: the first call checks the links of all elements in one pass.
    ///
    /// # Errors
    ///
    /// [`Error::Damaged`] for a channel of a mapped file whose links are damaged.
    pub fn view(&self) -> Result<&ChannelRef<'_>, Error> {
        let view = self.arrays.get();
        if let Some(checked) = &self.checked
            && !checked.get_or_init(|| Box::new(view.check_links().is_ok()))
        {
            view.check_links()?;
        }
        Ok(view)
    }
}

impl core::fmt::Debug for Channel {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Channel")
            .field("name", &self.name())
            .field("frame", self.frame())
            .field("value_type", &self.value_type())
            .field("values", &self.value_count())
            .finish_non_exhaustive()
    }
}

/// Channels are equal if they are the same function on cells: the same frame, type and values in the same
/// cells. Metadata does not count. O(n).
impl PartialEq for Channel {
    fn eq(&self, other: &Channel) -> bool {
        let (a, b) = (self.arrays.get(), other.arrays.get());
        let (c, d) = (&a.tree, &b.tree);
        a.value_type == b.value_type
            && a.values == b.values
            && (c.frame, c.root) == (d.frame, d.root)
            && c.planes == d.planes
            && c.bricks.len() == d.bricks.len()
            && (0..c.bricks.len()).all(|i| c.bricks.get(i) == d.bricks.get(i))
    }
}
