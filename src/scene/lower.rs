//! Converts scenes to solids.

use alloc::vec::Vec;

use super::{Node, Scene};
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Frame};
use crate::memory;
use crate::solid::{AnySolid, Csg, Solid, Transform};

/// The lower and the upper corner of a box.
type Corners = ([f64; 3], [f64; 3]);

/// Maximum number of nested matrices around a mesh or an octree; each has to be applied to everything inside
/// of it.
const MOST_NESTED: usize = 256;

impl Scene {
    /// Returns a box (lower and upper corner) that contains the solid, if one is known; `None` for an empty
    /// scene. The box may be larger than the solid.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn bounds(&self) -> Result<Option<Corners>, Error> {
        Ok(self.lower(None)?.bounds().map(|Bounds { min, max }| (min, max)))
    }

    /// Returns whether the scene is known to be empty: it has no content, or the parts of an intersection lie
    /// apart.
    ///
    /// # Errors
    /// The errors of [`bounds`](Self::bounds).
    pub fn is_empty(&self) -> Result<bool, Error> {
        Ok(self.lower(None)?.is_known_empty())
    }

    /// Returns the solid for use on this frame. The solid of a scene without octrees can be used on any
    /// frame.
    ///
    /// Octrees that are placed, or that lie on another frame, blur by about a cell: see [`Transform`].
    ///
    /// # Errors
    /// The errors of [`MeshSolid::new`](crate::MeshSolid::new) and [`Csg::placed`]; [`Error::OutOfMemory`].
    pub fn solid(&self, frame: &Frame) -> Result<Csg, Error> {
        self.lower(Some(frame))
    }

    /// Returns the scene moved as a whole.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn placed(mut self, placement: &Affine) -> Result<Scene, Error> {
        if let Some(whole) = self.nodes.len().checked_sub(1) {
            memory::push(&mut self.nodes, Node::Placed(whole, *placement))?;
        }
        Ok(self)
    }

    /// Returns the solid; without a frame, boxes replace meshes and octrees.
    fn lower(&self, frame: Option<&Frame>) -> Result<Csg, Error> {
        // For each node the solid, and the number of matrices around its meshes and octrees, if it has any.
        let mut solids: Vec<(Csg, Option<usize>)> = memory::with_capacity(self.nodes.len())?;
        for node in &self.nodes {
            let part = |part: &usize| solids[*part].0.clone();
            let deepest = |parts: &[usize]| parts.iter().filter_map(|&part| solids[part].1).max();
            let lowered = match node {
                Node::Solid(csg) => (csg.clone(), None),
                Node::Mesh(_) | Node::Octree(_) => (leaf(node, frame)?, Some(0)),
                Node::Union(parts) => (Csg::union_of(parts.iter().map(part))?, deepest(parts)),
                Node::Intersection(parts) => (Csg::intersection_of(parts.iter().map(part))?, deepest(parts)),
                Node::Difference(parts) => {
                    let others = Csg::union_of(parts.iter().skip(1).map(part))?;
                    (parts.first().map_or_else(Csg::empty, part).difference(&others)?, deepest(parts))
                }
                Node::Placed(inner, placement) => {
                    let nesting = solids[*inner].1.map(|nesting| nesting + 1);
                    if nesting.is_some_and(|nesting| nesting > MOST_NESTED) {
                        let what = "matrices around a mesh or octree";
                        return Err(Error::Limit { what, limit: MOST_NESTED as u64 });
                    }
                    (solids[*inner].0.placed(placement)?, nesting)
                }
            };
            solids.push(lowered);
        }
        Ok(solids.pop().map_or_else(Csg::empty, |(solid, _)| solid))
    }
}

/// Returns the solid of a mesh or an octree; without a frame a substitute with the right bounds.
fn leaf(node: &Node, frame: Option<&Frame>) -> Result<Csg, Error> {
    let Some(frame) = frame else {
        let Some(Bounds { min, max }) = (match node {
            Node::Mesh(mesh) => mesh.bounds(),
            Node::Octree(octree) => Some(Bounds::of(octree.frame())),
            _ => None,
        }) else {
            return Ok(Csg::everything());
        };
        // (Bounds of the complement are unknown.)
        return Ok(Csg::half_space([1.0, 0.0, 0.0], 0.0)?.within(min, max));
    };
    Ok(Csg::solid(match node {
        Node::Mesh(mesh) => AnySolid::new(mesh.clone()),
        Node::Octree(octree) if octree.frame().same_universe(frame) => AnySolid::new((**octree).clone()),
        Node::Octree(octree) => AnySolid::new(Transform::of((**octree).clone(), &Affine::IDENTITY)),
        _ => return Ok(Csg::empty()),
    }))
}
