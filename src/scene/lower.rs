//! From scenes to solids.

use alloc::vec::Vec;

use super::{Node, Scene};
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Frame};
use crate::memory;
use crate::solid::{AnySolid, Csg, Solid, Transform};

/// Of a box, the lower and the upper one.
type Corners = ([f64; 3], [f64; 3]);

/// Matrices around each other that a mesh or an octree may be under; each has to be applied to all that it
/// contains.
const MOST_NESTED: usize = 256;

impl Scene {
    /// A box (lower and upper corner) that holds the solid, if one is known; an empty scene has none. It may
    /// be larger than the solid.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn bounds(&self) -> Result<Option<Corners>, Error> {
        Ok(self.lower(None)?.bounds().map(|Bounds { min, max }| (min, max)))
    }

    /// Whether the scene is known to be empty: there is nothing in it, or what is intersected lies apart.
    ///
    /// # Errors
    /// As [`bounds`](Self::bounds).
    pub fn is_empty(&self) -> Result<bool, Error> {
        Ok(self.lower(None)?.is_known_empty())
    }

    /// The solid, to be asked on this frame. Solids of scenes without octrees can be asked on any.
    ///
    /// Octrees that are placed, or lie on another frame, blur by about a cell: see [`Transform`].
    ///
    /// # Errors
    /// As [`MeshSolid::new`](crate::MeshSolid::new) and [`Csg::placed`]; [`Error::OutOfMemory`].
    pub fn solid(&self, frame: &Frame) -> Result<Csg, Error> {
        self.lower(Some(frame))
    }

    /// The scene moved as a whole.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn placed(mut self, placement: &Affine) -> Result<Scene, Error> {
        if let Some(whole) = self.nodes.len().checked_sub(1) {
            memory::push(&mut self.nodes, Node::Placed(whole, *placement))?;
        }
        Ok(self)
    }

    /// The solid; without a frame boxes take the place of meshes and octrees.
    fn lower(&self, frame: Option<&Frame>) -> Result<Csg, Error> {
        // Of each node the solid, and how many matrices its meshes and octrees are under, if it has any.
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

/// A mesh or an octree; without a frame a stand-in, of which only the bounds count.
fn leaf(node: &Node, frame: Option<&Frame>) -> Result<Csg, Error> {
    let Some(frame) = frame else {
        let Some(Bounds { min, max }) = (match node {
            Node::Mesh(mesh) => mesh.bounds(),
            Node::Octree(octree) => Some(Bounds::of(octree.frame())),
            _ => None,
        }) else {
            return Ok(Csg::everything());
        };
        // (Bounds of the complement are not known.)
        return Ok(Csg::half_space([1.0, 0.0, 0.0], 0.0)?.within(min, max));
    };
    Ok(Csg::solid(match node {
        Node::Mesh(mesh) => AnySolid::new(mesh.clone()),
        Node::Octree(octree) if octree.frame().same_universe(frame) => AnySolid::new((**octree).clone()),
        Node::Octree(octree) => AnySolid::new(Transform::of((**octree).clone(), &Affine::IDENTITY)),
        _ => return Ok(Csg::empty()),
    }))
}
