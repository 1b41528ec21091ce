//! The owned, shared, immutable octree.

use super::Channel;
use super::arrays::Arrays;
use super::brick::{Brick, BrickArray, Bricks, OwnedArray, OwnedBricks};
use super::cuts::CutsRef;
use super::dictionary;
use super::metadata::Metadata;
use super::proof::Proof;
use super::stats::Statistics;
use super::tag::Tag;
use super::view::{LevelCounts, MAX_ELEMENT_LEVELS, OctreeRef};
use crate::error::Error;
use crate::lattice::Frame;
use crate::memory;
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;
use once_cell::race::OnceBox;
use yoke::Yoke;
use yoke::erased::ErasedArcCart;

/// An octree that owns its arrays, or shares the mapping of a file.
///
/// An octree is immutable, a clone costs two reference counts, and any number of threads may read it at once.
/// All reading goes through its [`view`](Octree::view).
///
/// # Extended octrees
///
/// An octree may have *cuts* ([`build_extended`](crate::build_extended)): a PARTIAL cell then keeps the
/// surfaces that cross it, up to three, and the function of their sides that describes the solid. So the
/// octree is as exact as its source. Without its cuts it is an ordinary certified octree in canonical form.
///
/// *Surfaces* are planes, quadrics, sums of powers and tori in exact numbers, under any placements, and
/// *slabs*, planes with a width, where nothing exact is known. They are stored in one table, in the order of
/// their first use. Two exact surfaces are the same surface if their polynomials are proportional, or if
/// their figures and placements are the same; a complement uses the same surface negated. A slab stands for
/// an unknown set: two slabs are the same only if they have the same origin, a fingerprint of the source and
/// the build, and the same number there.
///
/// *The law* of a cut: consider a point of the open cell that lies on no surface. It has a side with respect
/// to each surface, except the slabs that contain the point in their width. If the function has the same
/// value for all possible sides of these slabs, that value is the answer; otherwise the point is undecided.
/// On a surface either answer is right.
///
/// *Split records.* Where all descendants of a cell are PARTIAL, the tree has no node for them. If the cell's
/// function needs more than three surfaces, its cut is a split into eight cuts, and so on, down to the
/// frame's depth. A finest cell that is still crossed by more surfaces is *given up*: it is PARTIAL, and
/// nothing is known about it ([`CutCounts::given_up`](crate::octree::CutCounts::given_up)).
///
/// *Normal form.* A function depends on each of its surfaces; the surfaces of a cut ascend; nothing is stored
/// for decided cells, and surfaces that no cell uses are not kept. Equality and fingerprints include cuts,
/// and the bytes are the same for any number of threads.
///
/// Functions that take octrees treat cuts in one of four ways:
///
/// | | functions | |
/// |---|---|---|
/// | in place | [`contains`](OctreeRef::contains), [`contains_many`](OctreeRef::contains_many), [`PointCursor`](crate::query::PointCursor), [`PointTable`](crate::query::PointTable), [`cast_ray`](OctreeRef::cast_ray), [`cast_rays`](OctreeRef::cast_rays), [`ray_spans`](OctreeRef::ray_spans), [`classify_box`](OctreeRef::classify_box) | without a worker and without allocation; next to a surface, rounding leaves points undecided |
/// | as a solid | functions of a [`Solid`](crate::Solid): [`build`](crate::build), [`build_extended`](crate::build_extended), [`contains`](crate::contains), [`cast_rays`](crate::cast_rays), [`measure`](crate::measure), [`surface_area`](crate::query::surface_area), [`section_area`](crate::query::section_area), [`bounding_box`](crate::query::bounding_box), [`distances`](crate::query::distances), [`interference`](crate::interference), [`clearance`](crate::clearance), [`Adaptive`](crate::solid::Adaptive), [`LazyOctree`], [`dexelize`](crate::dexelize), dual contouring of solids, and pictures, also those of trees | the same answers as from the source; cells split below the tree's depth |
/// | set operations | [`union`](crate::union), [`intersection`](crate::intersection), [`difference`](crate::difference), [`xor`](crate::xor), [`complement`](crate::complement), [`union_of`](crate::op::union_of), [`intersection_of`](crate::op::intersection_of), [`difference_of`](crate::op::difference_of), [`xor_of`](crate::op::xor_of) | the result keeps the operands' surfaces |
/// | of cells | [`tag_at`](OctreeRef::tag_at), [`statistics`](Octree::statistics), [`Cursor`](crate::octree::Cursor), [`cells`](OctreeRef::cells), [`BoundaryFaces`](crate::octree::BoundaryFaces), [`bitmap`](OctreeRef::bitmap), [`columns`](OctreeRef::columns), [`heights`](OctreeRef::heights), [`cells_in_box`](OctreeRef::cells_in_box), [`volume_in_box`](OctreeRef::volume_in_box), [`cells_in`](OctreeRef::cells_in), [`volume_in`](OctreeRef::volume_in), [`distance`](OctreeRef::distance), [`nearest_cells`](OctreeRef::nearest_cells), voxels, components, slices, surfaces of trees, and pictures of the faces of cells | cuts are ignored. The answers are true, but coarse: use the tree of [`plain`](crate::op::plain) |
///
/// [`resolve`](crate::op::resolve) refuses trees with cuts, because their cells are few and large.
/// [`compact`](crate::compact) keeps the cuts.
///
/// ## Set operations
///
/// Set operations keep surfaces if at least one operand does. A tree without cuts takes part as a certified
/// octree: nothing is known in its PARTIAL cells, or in the cells of the result that depend on them.
///
/// *The end of cells.* All operands are walked at once. Subtrees that only one operand cuts are copied as
/// runs of its arrays, with their cuts. Where several operands end with functions, these are combined into
/// one function, and the cell ends as soon as three surfaces are left in it. Otherwise the cell is split,
/// down to the frame's depth, where it is given up. A cell that an operand has given up is given up in the
/// result, unless another operand decides it.
///
/// *Identity.* Equal surfaces are recognised as one surface: a pin fits into a bore of its own radius, and
/// the two touch. `A ∖ A` is EMPTY where nothing was given up in `A`. Slabs are equal only if they have the
/// same origin and number. `A ∪ A` is `A`, `A ∪ B` is `B ∪ A`, and `¬¬A` is `A`, byte for byte. Associativity
/// and distributivity hold for the sets, except in cells that are given up.
///
/// *Planes and functions.* Eight cells that one function describes become one cell. So the planes of a result
/// may be coarser than Kleene's logic of the operands' planes. The function then contains the decisions about
/// those cells.
///
/// *Cutting a batch.* An operation on two trees copies the larger one.
/// [`difference_of`](crate::op::difference_of) walks the stock and all tools at once, and copies only the
/// result. It is the way to cut a part with many tools.
///
/// *Cost.* Time and memory are linear in the cells where operands meet. Curved surfaces that nearly coincide,
/// but are not equal, may meet in very many cells of a great depth: set
/// [`Control::max_bytes`](crate::Control::max_bytes) if the operands come from others.
///
/// Marching cubes and coplanar shrink of solids sample the corners of cells on a lattice on which stored
/// trees are not known, so they refuse extended trees, too. Instead use
/// [`marching_cubes_dexels`](crate::surface::marching_cubes_dexels) of [`dexelize`](crate::dexelize), whose
/// vertices lie on the surfaces, or the surface of the tree of [`plain`](crate::op::plain) with
/// [`Rule::Sampled`](crate::Rule::Sampled). The program does so, too.
///
/// [`LazyOctree`]: crate::LazyOctree
#[derive(Clone)]
pub struct Octree {
    arrays: Yoke<OctreeRef<'static>, ErasedArcCart>,
    counts: Arc<OnceBox<Vec<LevelCounts>>>,
    metadata: Arc<Metadata>,
    /// The channels, in ascending order of their names, which are distinct.
    channels: Arc<Vec<Channel>>,
}

/// Most channels of an octree, so that its file has no more sections than a reader accepts.
const MOST_CHANNELS: usize = 256;

impl Octree {
    pub(crate) fn new(arrays: Arrays) -> Octree {
        Octree::attach(Arc::new(arrays), Metadata::default(), |arrays| Ok(arrays.view()))
            .unwrap_or_else(|_: core::convert::Infallible| unreachable!())
    }

    /// Returns the bytes of the arrays of the tree, its cuts and its channels, in memory or in a mapped file.
    /// Arrays may be shared: a clone has the same ones.
    pub fn bytes(&self) -> u64 {
        let OctreeRef { planes, rel, base, bricks, table, .. } = self.view();
        let links = size_of_val(*planes) + size_of_val(*rel) + size_of_val(*base);
        let tree = links + bricks.bytes() + table.map_or(0, size_of_val);
        let cuts = self.view().cuts().map_or(0, |cuts| cuts.bytes);
        tree as u64 + cuts + self.channels.iter().map(Channel::bytes).sum::<u64>()
    }

    /// Makes an octree whose arrays lie in `owner`.
    pub(crate) fn attach<C: Send + Sync + 'static, E>(
        owner: Arc<C>,
        metadata: Metadata,
        view: impl for<'a> FnOnce(&'a C) -> Result<OctreeRef<'a>, E>,
    ) -> Result<Octree, E> {
        Ok(Octree {
            arrays: Yoke::<OctreeRef<'static>, Arc<C>>::try_attach_to_cart(owner, view)?.erase_arc_cart(),
            counts: Arc::new(OnceBox::new()),
            metadata: Arc::new(metadata),
            channels: Arc::new(Vec::new()),
        })
    }

    /// Returns an octree whose whole universe has one `tag`, and the space around it the tag `exterior`;
    /// neither may be BRANCH.
    pub fn uniform(frame: Frame, tag: Tag, exterior: Tag) -> Result<Octree, Error> {
        if tag == Tag::Branch || exterior == Tag::Branch {
            return Err(Error::Argument { name: "tag", problem: "must be EMPTY, FULL or PARTIAL" });
        }
        let bricks = match tag {
            Tag::Partial => OwnedBricks::Two(OwnedArray::Raw(Vec::new())),
            _ => OwnedBricks::One(OwnedArray::Raw(Vec::new())),
        };
        let starts = [0; MAX_ELEMENT_LEVELS + 1];
        Ok(Octree::new(Arrays::link(frame, tag, exterior, Vec::new(), bricks, starts)?))
    }

    /// Returns a copy of `tree` with its bricks in the encoding of a file.
    pub(crate) fn recoded(tree: &OctreeRef<'_>) -> Result<Octree, Error> {
        let recoded = Octree::new(Arrays {
            frame: tree.frame,
            root: tree.root,
            exterior: tree.exterior,
            planes: memory::copied(tree.planes)?,
            rel: memory::copied(tree.rel)?,
            base: memory::copied(tree.base)?,
            bricks: match dictionary::encode(&tree.bricks)? {
                Some(bricks) => bricks,
                None => copy_raw(&tree.bricks)?,
            },
            starts: tree.starts,
            is_linked: tree.is_linked,
            cuts: tree.cuts.as_ref().map(CutsRef::copied).transpose()?,
        });
        Ok(recoded.with_proof(tree.proof))
    }

    /// Returns the view through which all reading goes. Free.
    #[inline(always)]
    pub fn view(&self) -> &OctreeRef<'_> {
        self.arrays.get()
    }

    /// Returns the frame of the tree.
    pub fn frame(&self) -> &Frame {
        self.view().frame()
    }

    /// Returns the statistics of each level: nodes, cells of each tag, volumes. O(depth) once the counts are
    /// known. They are known for a tree from a file; for a new tree they take one pass over its arrays.
    ///
    /// A classical octree has a node for every cell, cut or not: with n leaves and m internal nodes, it has
    /// m + n = 8 m + 1 nodes. A leaf is only EMPTY or FULL, which its parent can store as well. So the
    /// leaf-free octree has m nodes. The example in the publication of the method has 25 nodes with leaves
    /// and 3 without. A bar of three cells is such a solid:
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, Tag, build};
    /// let frame = Frame::new([0.0; 3], 4.0, 2)?;
    /// let bar = Csg::cuboid([0.0; 3], [3.0, 1.0, 1.0])?;
    /// let statistics = build(&bar, &frame, Rule::Certified, &Control::default())?.statistics();
    ///
    /// let m = statistics.nodes();
    /// let n = statistics.cells(Tag::Empty) + statistics.cells(Tag::Full);
    /// assert_eq!((m, n, m + n, 8 * m + 1), (3, 22, 25, 25));
    /// // The universe, and the two of its octants that the bar cuts.
    /// let nodes: Vec<u64> = statistics.levels().iter().map(|level| level.nodes).collect();
    /// assert_eq!(nodes, [1, 2, 0]);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn statistics(&self) -> Statistics {
        Statistics::new(self.frame(), self.counts())
    }

    pub(crate) fn counts(&self) -> &[LevelCounts] {
        match self.view().table {
            Some(table) => table,
            None => self.counts.get_or_init(|| Box::new(self.view().count_levels())),
        }
    }

    /// Returns the proof: which tags hold for the solid that the tree was made from.
    pub fn proof(&self) -> Proof {
        self.view().proof
    }

    /// Returns the same tree with another proof; the arrays are shared. This is for trees that are made by
    /// other means than this library. With [`Proof::CERTIFIED`] the cells themselves count as the solid:
    /// measures of a sampled tree then are those of its cells, and not of the sampled solid.
    #[must_use]
    pub fn with_proof(&self, proof: Proof) -> Octree {
        let mut octree = self.clone();
        octree.arrays.with_mut(move |view| view.proof = proof);
        octree
    }

    /// Returns the same tree without cuts, with its planes only; the arrays are shared.
    #[must_use]
    pub fn without_cuts(&self) -> Octree {
        let mut octree = self.clone();
        octree.arrays.with_mut(|view| view.cuts = None);
        octree
    }

    /// Returns the same tree without the moments of the solid that it may store ([`OctreeRef::moments`]), so
    /// that [`measure`](crate::measure) evaluates cells and surfaces; the arrays are shared.
    #[must_use]
    pub fn without_moments(&self) -> Octree {
        let mut octree = self.clone();
        octree.arrays.with_mut(|view| {
            if let Some(cuts) = &mut view.cuts {
                cuts.moments = None;
            }
        });
        octree
    }

    /// Returns the facts about the tree that its file stores: units, name, source.
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// Returns the channels of the solid, in ascending order of their names.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Returns the channel with this name.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.place_of(name).ok().and_then(|at| self.channels.get(at))
    }

    fn place_of(&self, name: &str) -> Result<usize, usize> {
        self.channels.binary_search_by(|channel| channel.name().cmp(name))
    }

    /// Returns the same tree with one more channel, which replaces a channel of the same name; the arrays are
    /// shared.
    ///
    /// # Errors
    ///
    /// [`Error::FrameMismatch`] if the channel lies in another cube than the tree; [`Error::Argument`] if
    /// there are 256 channels already; [`Error::OutOfMemory`].
    pub fn with_channel(&self, channel: Channel) -> Result<Octree, Error> {
        if !channel.frame().same_universe(self.frame()) {
            return Err(self.frame().mismatch(channel.frame()));
        }
        let mut channels = memory::with_capacity(self.channels.len() + 1)?;
        channels.extend(self.channels.iter().cloned());
        match self.place_of(channel.name()) {
            Ok(at) => channels[at] = channel,
            Err(_) if channels.len() >= MOST_CHANNELS => {
                return Err(Error::Argument { name: "channel", problem: "must not be one of more than 256" });
            }
            Err(at) => channels.insert(at, channel),
        }
        Ok(Octree { channels: Arc::new(channels), ..self.clone() })
    }

    /// Returns the same tree with these channels, which lie in its cube, in ascending order of their names.
    pub(crate) fn with_all_channels(&self, channels: Vec<Channel>) -> Octree {
        Octree { channels: Arc::new(channels), ..self.clone() }
    }

    /// Returns the same tree without channels; the arrays are shared.
    #[must_use]
    pub fn without_channels(&self) -> Octree {
        Octree { channels: Arc::new(Vec::new()), ..self.clone() }
    }

    /// Returns the same tree without the channel of this name; the arrays are shared.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfMemory`].
    pub fn without_channel(&self, name: &str) -> Result<Octree, Error> {
        let mut channels = memory::with_capacity(self.channels.len())?;
        channels.extend(self.channels.iter().filter(|channel| channel.name() != name).cloned());
        Ok(Octree { channels: Arc::new(channels), ..self.clone() })
    }

    /// Returns the same tree with the channels of another tree in the same cube; the channels are shared.
    #[must_use]
    pub fn with_channels_from(&self, other: &Octree) -> Octree {
        Octree { channels: other.channels.clone(), ..self.clone() }
    }

    /// Returns the same tree with the metadata of another tree, which are shared.
    #[must_use]
    pub fn with_metadata_from(&self, other: &Octree) -> Octree {
        Octree { metadata: other.metadata.clone(), ..self.clone() }
    }

    /// Returns the same tree with other metadata; the arrays are shared.
    #[must_use]
    pub fn with_metadata(&self, metadata: Metadata) -> Octree {
        Octree { metadata: Arc::new(metadata), ..self.clone() }
    }
}

impl core::fmt::Debug for Octree {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Octree")
            .field("frame", self.frame())
            .field("root", &self.view().root_tag())
            .field("elements", &self.view().element_count())
            .field("bricks", &self.view().brick_count())
            .finish_non_exhaustive()
    }
}

/// Octrees are equal if they have the same frame, and the same cells with the same tags and cuts. Trees are
/// canonical, so their arrays agree, however the bricks are encoded. Metadata and proofs do not count. O(n).
impl PartialEq for Octree {
    fn eq(&self, other: &Octree) -> bool {
        let (a, b) = (self.view(), other.view());
        a.frame == b.frame
            && (a.root, a.exterior) == (b.root, b.exterior)
            && a.planes == b.planes
            && a.cuts == b.cuts
            && a.bricks.len() == b.bricks.len()
            && (0..a.bricks.len()).all(|i| a.bricks.get(i) == b.bricks.get(i))
    }
}

/// Returns a copy of bricks that are raw.
fn copy_raw(bricks: &Bricks<'_>) -> Result<OwnedBricks, Error> {
    fn copy<T: Brick>(bricks: &BrickArray<'_, T>) -> Result<OwnedArray<T>, Error> {
        let mut copy = memory::with_capacity(bricks.len())?;
        bricks.extend(0..bricks.len(), &mut copy, |brick| brick);
        Ok(OwnedArray::Raw(copy))
    }
    Ok(match bricks {
        Bricks::One(bricks) => OwnedBricks::One(copy(bricks)?),
        Bricks::Two(bricks) => OwnedBricks::Two(copy(bricks)?),
    })
}
