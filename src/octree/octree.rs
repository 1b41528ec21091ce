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
/// It is immutable, a clone costs two reference counts, and any number of threads may read it at once. All
/// reading is done through its [`view`](Octree::view).
#[derive(Clone)]
pub struct Octree {
    arrays: Yoke<OctreeRef<'static>, ErasedArcCart>,
    counts: Arc<OnceBox<Vec<LevelCounts>>>,
    metadata: Arc<Metadata>,
    /// In ascending order of their names, which differ.
    channels: Arc<Vec<Channel>>,
}

/// Most channels that an octree can have, so that its file has no more sections than a reader takes.
const MOST_CHANNELS: usize = 256;

impl Octree {
    pub(crate) fn new(arrays: Arrays) -> Octree {
        Octree::attach(Arc::new(arrays), Metadata::default(), |arrays| Ok(arrays.view()))
            .unwrap_or_else(|_: core::convert::Infallible| unreachable!())
    }

    /// Bytes that the arrays of the tree, its cuts and its channels take, in memory or where a file is mapped. Arrays may be
    /// shared: a clone has the same.
    pub fn bytes(&self) -> u64 {
        let OctreeRef { planes, rel, base, bricks, table, .. } = self.view();
        let links = size_of_val(*planes) + size_of_val(*rel) + size_of_val(*base);
        let tree = links + bricks.bytes() + table.map_or(0, size_of_val);
        let cuts = self.view().cuts().map_or(0, |cuts| cuts.bytes);
        tree as u64 + cuts + self.channels.iter().map(Channel::bytes).sum::<u64>()
    }

    /// An octree whose arrays lie in `owner`, wherever that has them.
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

    /// An octree whose whole universe has one `tag`, and the space around it the tag `exterior`; neither may
    /// be BRANCH.
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

    /// A copy of `tree` with its bricks in the encoding that a file would give them.
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

    /// The view that all reading goes through. Free.
    #[inline(always)]
    pub fn view(&self) -> &OctreeRef<'_> {
        self.arrays.get()
    }

    /// Where the tree lies.
    pub fn frame(&self) -> &Frame {
        self.view().frame()
    }

    /// What is known level by level: nodes, cells of each tag, volumes. O(depth) once the counts are known,
    /// which for a tree from a file they are and for a new one takes one pass over its arrays.
    ///
    /// A classical octree has a node for every cell, cut or not: of n leaves and m internal nodes
    /// m + n = 8 m + 1 in all. A leaf says only EMPTY or FULL, which its parent can say as well. So the
    /// leaf-free octree has m nodes. The example that the method was published with has 25 nodes with their
    /// leaves and 3 without; a bar of three cells is such a solid:
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

    /// What the cells prove of the solid that the tree was made from.
    pub fn proof(&self) -> Proof {
        self.view().proof
    }

    /// The same tree, of whose cells this is said; the arrays are shared. Whoever makes trees otherwise than
    /// by this library knows what they prove. With [`Proof::CERTIFIED`] the cells themselves are taken for
    /// the solid: measures of a sampled tree then are those of its cells, and not of what was sampled.
    #[must_use]
    pub fn with_proof(&self, proof: Proof) -> Octree {
        let mut octree = self.clone();
        octree.arrays.with_mut(move |view| view.proof = proof);
        octree
    }

    /// The same tree without cuts: what its planes say; the arrays are shared.
    #[must_use]
    pub fn without_cuts(&self) -> Octree {
        let mut octree = self.clone();
        octree.arrays.with_mut(|view| view.cuts = None);
        octree
    }

    /// Facts about the tree that its file carries along: units, name, source.
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// The channels of the solid, in ascending order of their names.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The channel with this name.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.place_of(name).ok().and_then(|at| self.channels.get(at))
    }

    fn place_of(&self, name: &str) -> Result<usize, usize> {
        self.channels.binary_search_by(|channel| channel.name().cmp(name))
    }

    /// The same tree with one more channel, in the place of one of the same name, if there is one; the arrays
    /// are shared.
    ///
    /// # Errors
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

    /// The same tree with these channels, which lie in its cube, in ascending order of their names.
    pub(crate) fn with_all_channels(&self, channels: Vec<Channel>) -> Octree {
        Octree { channels: Arc::new(channels), ..self.clone() }
    }

    /// The same tree without channels; the arrays are shared.
    #[must_use]
    pub fn without_channels(&self) -> Octree {
        Octree { channels: Arc::new(Vec::new()), ..self.clone() }
    }

    /// The same tree without the channel of this name; the arrays are shared.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn without_channel(&self, name: &str) -> Result<Octree, Error> {
        let mut channels = memory::with_capacity(self.channels.len())?;
        channels.extend(self.channels.iter().filter(|channel| channel.name() != name).cloned());
        Ok(Octree { channels: Arc::new(channels), ..self.clone() })
    }

    /// The same tree with the channels of another, which lies in the same cube; they are shared.
    #[must_use]
    pub fn with_channels_from(&self, other: &Octree) -> Octree {
        Octree { channels: other.channels.clone(), ..self.clone() }
    }

    /// The same tree with the metadata of another, which are shared.
    #[must_use]
    pub fn with_metadata_from(&self, other: &Octree) -> Octree {
        Octree { metadata: other.metadata.clone(), ..self.clone() }
    }

    /// The same tree with other metadata; the arrays are shared.
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

/// Equal as sets of cells with the same tags and cuts on the same frame: trees are canonical, so their arrays agree
/// however the bricks are encoded. Metadata does not count, nor what the cells prove. O(n).
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

/// A copy of bricks that are raw.
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
