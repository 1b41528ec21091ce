//! The owned, shared, immutable tri-dexel model.

use super::arrays::ModelArrays;
use super::view::TriDexelRef;
use crate::lattice::Frame;
use crate::octree::Metadata;
use alloc::sync::Arc;
use yoke::Yoke;
use yoke::erased::ErasedArcCart;

/// A solid as intervals along the rays of a lattice, in one to three directions.
///
/// Rays run through the centres of the finest cells of a frame. Each ray has the sorted, disjoint intervals
/// in which it runs inside the solid. An interval contains its start, not its end. All directions agree about
/// the centres of cells.
///
/// **Directions.** Rays along one axis do not see the parts of a solid beside the outermost rays. For a
/// sphere in its bounding box, rays along y lose four caps, rays along x and y lose two, and rays along all
/// three axes lose only the parts beyond the rays nearest to the poles. The table shows the parts of the
/// volume that are lost. (Figure 2 of Gao, Zhang and Hou 2007; a test makes this table.)
///
/// | rays to an axis | y | x, y | x, y, z |
/// |---|---|---|---|
/// | 8 | 4.529197 % | 2.320113 % | 0.111028 % |
/// | 16 | 1.149756 % | 0.578320 % | 0.006884 % |
/// | 32 | 0.290060 % | 0.145245 % | 0.000429 % |
/// | 64 | 0.072870 % | 0.036448 % | 0.000027 % |
/// | 128 | 0.018263 % | 0.009133 % | 0.000002 % |
/// | 256 | 0.004572 % | 0.002286 % | 0.000000 % |
/// | 512 | 0.001144 % | 0.000572 % | 0.000000 % |
///
/// A model is immutable, a clone costs two reference counts, and any number of threads may read it at once.
/// All reading is done through its [`view`](TriDexel::view). [`DexelEditor`](crate::dexel::DexelEditor)
/// changes a copy in place.
#[derive(Clone)]
pub struct TriDexel {
    arrays: Yoke<TriDexelRef<'static>, ErasedArcCart>,
    metadata: Arc<Metadata>,
}

impl TriDexel {
    pub(crate) fn new(arrays: ModelArrays) -> TriDexel {
        let attached = Yoke::<TriDexelRef<'static>, Arc<ModelArrays>>::attach_to_cart(
            Arc::new(arrays),
            |arrays: &ModelArrays| arrays.view(),
        );
        TriDexel { arrays: attached.erase_arc_cart(), metadata: Arc::new(Metadata::default()) }
    }

    /// Makes a model whose arrays lie in `owner`, anywhere in it.
    pub(crate) fn attach<C: Send + Sync + 'static, E>(
        owner: Arc<C>,
        metadata: Metadata,
        view: impl for<'a> FnOnce(&'a C) -> Result<TriDexelRef<'a>, E>,
    ) -> Result<TriDexel, E> {
        Ok(TriDexel {
            arrays: Yoke::<TriDexelRef<'static>, Arc<C>>::try_attach_to_cart(owner, view)?.erase_arc_cart(),
            metadata: Arc::new(metadata),
        })
    }

    /// The view for all reading. Free.
    pub fn view(&self) -> &TriDexelRef<'_> {
        self.arrays.get()
    }

    /// The lattice.
    pub fn frame(&self) -> &Frame {
        self.view().frame()
    }

    /// Facts about the solid that are stored in its file. Names in use: `name`, `units`.
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// The same model with other metadata; the arrays are shared.
    #[must_use]
    pub fn with_metadata(&self, metadata: Metadata) -> TriDexel {
        TriDexel { metadata: Arc::new(metadata), ..self.clone() }
    }
}

impl core::fmt::Debug for TriDexel {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("TriDexel")
            .field("frame", self.frame())
            .field("format", &self.view().format())
            .field("directions", &self.view().directions())
            .field("intervals", &self.view().interval_count())
            .finish_non_exhaustive()
    }
}

/// Models are equal if all stored data is equal, bit for bit. Metadata is not compared. O(n).
impl PartialEq for TriDexel {
    fn eq(&self, other: &TriDexel) -> bool {
        self.view().equals(other.view())
    }
}
