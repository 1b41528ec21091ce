//! Constructive solid geometry: half-spaces and other solids, joined by set operations.
//!
//! The split of a cell, the counting of its work and the classification of half-spaces follow Dai, Zha and
//! Ni, *A fast decomposition algorithm of octree node in 3D-packing* (1994), with proofs in place of their
//! approximations: see [`Csg`].

mod between;
mod bytes;
mod extent;
mod faceted;
mod figure;
mod fingerprint;
mod primitive;
mod program;
mod support;

use crate::solid::HalfSpace;
#[cfg(feature = "scene")]
pub(crate) use figure::{Fan, Figure, cos_degrees, sin_degrees, wedge};

use super::Motion;
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Frame};
use crate::memory;
use crate::mesh::TriangleMesh;
use crate::solid::{AnySolid, Solid};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicU64, Ordering::Relaxed};
use extent::Extent;
use hashbrown::HashMap;

/// The most half-spaces, other solids, operations and placements of an expression that is written out. (A
/// quadric takes a kilobyte, and nodes that contain another node twice, nested, soon exceed all memory.)
const MOST: u64 = 1 << 22;

/// The rule of touching: whether a cell that meets the solid's boundary, but not its interior, is EMPTY.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Touch {
    /// Contact is not overlap: a cell is EMPTY if the interiors are disjoint.
    #[default]
    Exact,
    /// The rule of the published method: a vertex on the surface counts as inside, so that a cell that
    /// touches a primitive with a vertex from outside is PARTIAL. It reproduces the published tables and has
    /// no other use.
    Paper,
}

/// A solid made of half-spaces and other solids by union, intersection, symmetric difference, complement and
/// placement. Immutable; cloning costs nothing.
///
/// A cell costs only the half-spaces that still cut it: a child inherits the half-spaces of its parent that
/// are undecided there. So in a scene of ten thousand primitives, each cell costs only the primitives near
/// it. Verdicts are proofs: over a box, the extremes of planes and of quadrics without mixed terms are exact,
/// and all others are bounded outward.
///
/// ```
/// use leafless::{Control, Csg, Frame, Rule, build};
/// let plate = Csg::cuboid([-1.0, -1.0, 0.0], [1.0, 1.0, 0.5])?;
/// let hole = Csg::cylinder(0.5, -1.0, 1.0)?;
/// let part = plate.difference(&hole)?;
/// let tree = build(&part, &Frame::new([-1.0; 3], 2.0, 7)?, Rule::Certified, &Control::default())?;
/// let volume = tree.statistics().volume();
/// let truth = 2.0 - core::f64::consts::PI * 0.25 * 0.5;
/// assert!(volume.contains(truth) && volume.width() < 0.05);
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Clone)]
pub struct Csg {
    root: Arc<Node>,
    touch: Touch,
}

/// A node of an expression, with bounding boxes of its solid and of the solid's complement.
struct Node {
    kind: Kind,
    /// The number of half-spaces, other solids, operations and placements in the node when it is written out.
    size: u64,
    /// Whether other solids occur in the node, and their greatest nesting depth.
    mixed: bool,
    nesting: u32,
    /// The greatest nesting depth of placements in the node.
    placements: u32,
    /// The frame of a stored octree in the node, if there is one.
    home: Option<Arc<Frame>>,
    extent: Extent,
    opposite: Extent,
    /// The number of evaluations for expressions whose root this is.
    evaluations: AtomicU64,
}

enum Kind {
    HalfSpace(HalfSpace),
    Solid(AnySolid),
    Join(Join, Vec<Arc<Node>>),
    Complement(Arc<Node>),
    Placed(Arc<Node>, Affine),
}

/// The set operations that join any number of operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Join {
    Intersection,
    Union,
    /// The symmetric difference: the points in an odd number of operands.
    Parity,
}

impl Csg {
    fn new(kind: Kind, extent: Extent, opposite: Extent) -> Csg {
        let (size, mixed, nesting, home) = match &kind {
            Kind::HalfSpace(_) => (1, false, 0, None),
            Kind::Solid(solid) => (1, true, solid.nesting(), solid.home().map(Arc::new)),
            Kind::Complement(part) | Kind::Placed(part, _) => {
                (part.size.saturating_add(1), part.mixed, part.nesting, part.home.clone())
            }
            Kind::Join(_, parts) => (
                parts.iter().fold(1, |sum: u64, part| sum.saturating_add(part.size)),
                parts.iter().any(|part| part.mixed),
                parts.iter().map(|part| part.nesting).max().unwrap_or(0),
                parts.iter().find_map(|part| part.home.clone()),
            ),
        };
        let placements = match &kind {
            Kind::HalfSpace(_) | Kind::Solid(_) => 0,
            Kind::Complement(part) => part.placements,
            Kind::Placed(part, _) => part.placements.saturating_add(1),
            Kind::Join(_, parts) => parts.iter().map(|part| part.placements).max().unwrap_or(0),
        };
        let evaluations = AtomicU64::new(0);
        let node = Node { kind, size, mixed, nesting, placements, home, extent, opposite, evaluations };
        Csg { root: Arc::new(node), touch: Touch::Exact }
    }

    fn join(join: Join, parts: impl IntoIterator<Item = Csg>) -> Result<Csg, Error> {
        let mut nodes = Vec::new();
        for part in parts {
            memory::push(&mut nodes, part.root)?;
        }
        let (extent, opposite) = join.boxes(nodes.iter().map(|node| (node.extent, node.opposite)));
        Ok(Csg::new(Kind::Join(join, nodes), extent, opposite))
    }

    /// Returns the half-space `normal` · p + `offset` ≥ 0. The normal, of any length, points into the solid.
    ///
    /// # Errors
    /// As [`HalfSpace::plane`].
    pub fn half_space(normal: [f64; 3], offset: f64) -> Result<Csg, Error> {
        Ok(HalfSpace::plane(normal, offset)?.into())
    }

    /// Returns the empty solid.
    pub fn empty() -> Csg {
        Csg::new(Kind::Join(Join::Union, Vec::new()), Extent::Nothing, Extent::Unbounded)
    }

    /// Returns the solid that is all of space.
    pub fn everything() -> Csg {
        Csg::new(Kind::Join(Join::Intersection, Vec::new()), Extent::Unbounded, Extent::Nothing)
    }

    /// Makes an expression of any solid. The solid is queried in the frame of the whole expression, and must
    /// be able to answer in it. If the solid is an expression itself, it is returned unchanged.
    pub fn solid(solid: AnySolid) -> Csg {
        if let Some(csg) = solid.get::<Csg>() {
            return csg.clone();
        }
        let extent = Extent::of(solid.bounds());
        Csg::new(Kind::Solid(solid), extent, Extent::Unbounded)
    }

    /// Returns the union: the points that lie in at least one part. The union of no parts is empty. O(parts).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn union_of(parts: impl IntoIterator<Item = Csg>) -> Result<Csg, Error> {
        Csg::join(Join::Union, parts)
    }

    /// Returns the intersection: the points that lie in all parts. The intersection of no parts is all of
    /// space. O(parts).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn intersection_of(parts: impl IntoIterator<Item = Csg>) -> Result<Csg, Error> {
        Csg::join(Join::Intersection, parts)
    }

    /// Returns the symmetric difference: the points that lie in an odd number of parts. For two parts, these
    /// are the points in exactly one of them. O(parts).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn xor_of(parts: impl IntoIterator<Item = Csg>) -> Result<Csg, Error> {
        Csg::join(Join::Parity, parts)
    }

    /// Returns the difference: the points that lie in this solid and not in `other`.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn difference(&self, other: &Csg) -> Result<Csg, Error> {
        Csg::intersection_of([self.clone(), other.complement()])
    }

    /// Returns the complement: the points that do not lie in this solid. (A solid and its complement share
    /// their boundary.)
    #[must_use]
    pub fn complement(&self) -> Csg {
        Csg::new(Kind::Complement(self.root.clone()), self.root.opposite, self.root.extent)
    }

    /// Returns the solid moved by `placement`. Half-spaces are moved exactly, and each other solid as
    /// [`AnySolid::placed`] moves it; [`motion`](Solid::motion) reports the effect. O(1), plus the time for
    /// other solids and for the parts of the expression that contain them.
    ///
    /// # Errors
    /// As [`AnySolid::placed`].
    pub fn placed(&self, placement: &Affine) -> Result<Csg, Error> {
        if placement.is_identity() {
            return Ok(Csg { root: self.root.clone(), touch: Touch::Exact });
        }
        if !self.root.mixed {
            return Ok(Csg { root: Node::placed(&self.root, placement)?, touch: Touch::Exact });
        }
        // The moved nodes, by address: a part that occurs twice is moved once.
        let mut moved: HashMap<*const Node, Arc<Node>> = HashMap::new();
        let mut tasks: Vec<(&Arc<Node>, bool)> = Vec::new();
        memory::push(&mut tasks, (&self.root, false))?;
        while let Some((node, parts_moved)) = tasks.pop() {
            if moved.contains_key(&Arc::as_ptr(node)) {
                continue;
            }
            let parts = match &node.kind {
                Kind::Join(_, parts) if node.mixed => parts.as_slice(),
                Kind::Complement(part) if node.mixed => core::slice::from_ref(part),
                _ => &[],
            };
            if !parts_moved && !parts.is_empty() {
                memory::push(&mut tasks, (node, true))?;
                tasks.try_reserve(parts.len())?;
                tasks.extend(parts.iter().map(|part| (part, false)));
                continue;
            }
            let part =
                |part: &Arc<Node>| Csg { root: moved[&Arc::as_ptr(part)].clone(), touch: Touch::Exact };
            let result = match &node.kind {
                Kind::Solid(solid) => Csg::solid(solid.placed(placement)?).root,
                Kind::Join(join, parts) if node.mixed => Csg::join(*join, parts.iter().map(part))?.root,
                Kind::Complement(inner) if node.mixed => part(inner).complement().root,
                _ => Node::placed(node, placement)?,
            };
            moved.try_reserve(1)?;
            moved.insert(Arc::as_ptr(node), result);
        }
        Ok(Csg { root: moved[&Arc::as_ptr(&self.root)].clone(), touch: Touch::Exact })
    }

    /// Returns the mesh if the expression is nothing but one mesh.
    fn mesh_of_expression(&self) -> Option<&TriangleMesh> {
        let mut node = &self.root;
        loop {
            match &node.kind {
                Kind::Solid(solid) => return solid.sole_mesh(),
                Kind::Join(_, parts) if parts.len() == 1 => node = &parts[0],
                _ => return None,
            }
        }
    }

    /// Returns the effect of a placement: the worst effect on any part.
    fn motion_of_expression(&self) -> Motion {
        let (mut worst, mut rest) = (Motion::Exact, Vec::new());
        let mut seen: HashMap<*const Node, ()> = HashMap::new();
        rest.push(&self.root);
        while let Some(node) = rest.pop() {
            if !node.mixed || seen.insert(Arc::as_ptr(node), ()).is_some() {
                continue;
            }
            match &node.kind {
                Kind::HalfSpace(_) => {}
                Kind::Solid(solid) => worst = worst.max(solid.motion()),
                Kind::Join(_, parts) => rest.extend(parts),
                Kind::Complement(part) | Kind::Placed(part, _) => rest.push(part),
            }
        }
        worst
    }

    /// The nesting depth of [`AnySolid`]s in the expression: 0 for half-spaces alone.
    pub fn nesting(&self) -> u32 {
        self.root.nesting
    }

    /// Returns how many evaluations of half-spaces, each at a point or over a box, this expression and its
    /// clones have needed so far. Workers add their counts when they are dropped, so that the number is
    /// complete once an operation has returned. (Expressions that contain this one, or that it contains, have
    /// their own counts.)
    pub fn evaluations(&self) -> u64 {
        self.root.evaluations.load(Relaxed)
    }

    fn count(&self, evaluations: u64) {
        self.root.evaluations.fetch_add(evaluations, Relaxed);
    }

    /// Returns the same solid with another rule of touching. The rule applies to the whole expression; within
    /// a larger expression, the rule of the larger one applies.
    #[must_use]
    pub fn with_touch(&self, touch: Touch) -> Csg {
        Csg { root: self.root.clone(), touch }
    }

    /// Returns a box that surely contains the solid, if one is known. An empty solid has none.
    fn bounds_of_expression(&self) -> Option<Bounds> {
        match self.root.extent {
            Extent::Box(bounds) => Some(bounds),
            _ => None,
        }
    }

    /// Returns whether the bounds of its parts prove that the solid is empty.
    #[cfg(feature = "scene")]
    pub(crate) fn is_known_empty(&self) -> bool {
        self.root.extent == Extent::Nothing
    }

    /// Returns the same solid with the knowledge that it lies in a box.
    pub(crate) fn within(mut self, min: [f64; 3], max: [f64; 3]) -> Csg {
        if let Some(node) = Arc::get_mut(&mut self.root) {
            node.extent = node.extent.common(Extent::of(Bounds::new(min, max)));
        }
        self
    }
}

impl Node {
    /// Makes a node of half-spaces under a placement.
    fn placed(node: &Arc<Node>, placement: &Affine) -> Result<Arc<Node>, Error> {
        let (extent, opposite) = extent::placed(node, placement)?;
        Ok(Csg::new(Kind::Placed(node.clone(), *placement), extent, opposite).root)
    }
}

impl From<HalfSpace> for Csg {
    fn from(half_space: HalfSpace) -> Csg {
        Csg::new(Kind::HalfSpace(half_space), Extent::Unbounded, Extent::Unbounded)
    }
}

impl Drop for Node {
    /// Takes a deep expression apart without recursion.
    fn drop(&mut self) {
        let mut rest = Vec::new();
        let take = |kind: &mut Kind, rest: &mut Vec<Arc<Node>>| match core::mem::replace(
            kind,
            Kind::Join(Join::Union, Vec::new()),
        ) {
            // Without memory for the list, the recursion remains.
            Kind::Join(_, parts) if rest.try_reserve(parts.len()).is_ok() => rest.extend(parts),
            Kind::Complement(part) | Kind::Placed(part, _) if rest.try_reserve(1).is_ok() => rest.push(part),
            _ => {}
        };
        take(&mut self.kind, &mut rest);
        while let Some(node) = rest.pop() {
            if let Some(mut node) = Arc::into_inner(node) {
                take(&mut node.kind, &mut rest);
            }
        }
    }
}
