//! From scenes to solids.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::grammar::push;
use super::{Node, Scene};
use crate::error::Error;
use crate::lattice::exact::two_sum;
use crate::lattice::{Affine, Frame, MAX_DEPTH};
use crate::octree::Octree;
use crate::solid::{AnySolid, Csg, FillRule, MeshSolid, Transform, TriangleMesh};

/// Of a box, the lower and the upper one.
type Corners = ([f64; 3], [f64; 3]);

impl Scene {
    /// A box (lower and upper corner) that holds the solid, if one is known; an empty scene has none. It may be larger
    /// than the solid.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn bounds(&self) -> Result<Option<Corners>, Error> {
        Ok(self.lower(None)?.bounds())
    }

    /// The solid, to be asked on this frame. Solids of scenes without meshes and octrees can be asked on any.
    ///
    /// Octrees that are placed, or lie on another frame, blur by about a cell: see [`Transform`].
    ///
    /// # Errors
    /// As [`MeshSolid::new`]; [`Error::OutOfMemory`].
    pub fn solid(&self, frame: &Frame) -> Result<Csg, Error> {
        self.lower(Some(frame))
    }

    /// The scene moved as a whole.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn placed(mut self, placement: &Affine) -> Result<Scene, Error> {
        if let Some(whole) = self.nodes.len().checked_sub(1) {
            push(&mut self.nodes, Node::Placed(whole, *placement))?;
        }
        Ok(self)
    }

    /// The solid; without a frame boxes take the place of meshes and octrees.
    fn lower(&self, frame: Option<&Frame>) -> Result<Csg, Error> {
        let nodes = &self.nodes;
        // What is bound to a frame, which its placements then go down to.
        let mut bound = Vec::new();
        bound.try_reserve_exact(nodes.len()).map_err(|_| Error::OutOfMemory)?;
        for node in nodes {
            bound.push(match node {
                Node::Solid(_) => false,
                Node::Mesh(..) | Node::Octree(_) => true,
                Node::Union(parts) | Node::Intersection(parts) | Node::Difference(parts) => {
                    parts.iter().any(|&part| bound[part])
                }
                Node::Placed(part, _) => bound[*part],
            });
        }
        let placements = self.placements(&bound)?;
        let mut solids: Vec<Csg> = Vec::new();
        solids.try_reserve_exact(nodes.len()).map_err(|_| Error::OutOfMemory)?;
        for (index, node) in nodes.iter().enumerate() {
            let part = |part: &usize| solids[*part].clone();
            let solid = match node {
                Node::Solid(csg) => csg.clone(),
                Node::Mesh(mesh, fill) => mesh_leaf(mesh, *fill, placements.of(index), frame)?,
                Node::Octree(octree) => octree_leaf(octree, placements.of(index), frame)?,
                Node::Union(parts) => Csg::union_of(parts.iter().map(part))?,
                Node::Intersection(parts) => Csg::intersection_of(parts.iter().map(part))?,
                Node::Difference(parts) => {
                    let others = Csg::union_of(parts.iter().skip(1).map(part))?;
                    parts.first().map_or_else(Csg::empty, part).difference(&others)?
                }
                Node::Placed(inner, placement) if !bound[index] => solids[*inner].placed(placement)?,
                Node::Placed(inner, _) => solids[*inner].clone(),
            };
            solids.push(if bound[index] { solid } else { placed(solid, placements.of(index))? });
        }
        Ok(solids.pop().unwrap_or_else(Csg::empty))
    }

    /// The placements that go down: to what is bound to a frame, and to what is joined with that.
    fn placements(&self, bound: &[bool]) -> Result<Placements, Error> {
        let mut placements = Placements { links: Vec::new(), innermost: Vec::new() };
        let innermost = &mut placements.innermost;
        innermost.try_reserve_exact(bound.len()).map_err(|_| Error::OutOfMemory)?;
        innermost.resize(bound.len(), None);
        for (index, node) in self.nodes.iter().enumerate().rev().filter(|(index, _)| bound[*index]) {
            let outer = innermost[index];
            match node {
                Node::Union(parts) | Node::Intersection(parts) | Node::Difference(parts) => {
                    parts.iter().for_each(|&part| innermost[part] = outer);
                }
                Node::Placed(part, placement) => {
                    let nesting = outer.map_or(0, |outer: usize| placements.links[outer].nesting) + 1;
                    if nesting > MOST_NESTED {
                        let what = "matrices around a mesh or octree";
                        return Err(Error::Limit { what, limit: MOST_NESTED });
                    }
                    push(&mut placements.links, Link { placement: *placement, outer, nesting })?;
                    innermost[*part] = Some(placements.links.len() - 1);
                }
                Node::Solid(_) | Node::Mesh(..) | Node::Octree(_) => {}
            }
        }
        Ok(placements)
    }
}

/// Matrices around each other that a mesh may be under; each has to be applied to all that it contains.
const MOST_NESTED: u64 = 256;

/// Placements of nodes.
struct Placements {
    links: Vec<Link>,
    /// Of each node the innermost one, if there is any.
    innermost: Vec<Option<usize>>,
}

struct Link {
    placement: Affine,
    /// Index of the next one.
    outer: Option<usize>,
    /// How many there are from here on.
    nesting: u64,
}

impl Placements {
    /// Those of a node, from the inside out.
    fn of(&self, node: usize) -> impl Iterator<Item = &Affine> {
        let link = |index: Option<usize>| index.map(|index| &self.links[index]);
        core::iter::successors(link(self.innermost[node]), move |last| link(last.outer))
            .map(|link| &link.placement)
    }
}

fn placed<'a>(solid: Csg, mut placements: impl Iterator<Item = &'a Affine>) -> Result<Csg, Error> {
    placements.try_fold(solid, |solid, placement| solid.placed(placement))
}

/// A box as a stand-in.
fn stand_in<'a>(
    (min, max): ([f64; 3], [f64; 3]),
    placements: impl Iterator<Item = &'a Affine>,
) -> Result<Csg, Error> {
    // Only its bounds count, and that those of its complement are not known.
    placed(Csg::half_space([1.0, 0.0, 0.0], 0.0)?.within(min, max), placements)
}

fn mesh_leaf<'a>(
    mesh: &Arc<TriangleMesh>,
    fill: FillRule,
    mut placements: impl Iterator<Item = &'a Affine>,
    frame: Option<&Frame>,
) -> Result<Csg, Error> {
    let Some(frame) = frame else { return stand_in(mesh.bounds(), placements) };
    let mesh = placements.try_fold(mesh.clone(), |mesh, placement| mesh.placed(placement).map(Arc::new))?;
    Ok(Csg::solid(AnySolid::new(MeshSolid::new(mesh, frame, fill)?)))
}

fn octree_leaf<'a>(
    octree: &Octree,
    placements: impl Iterator<Item = &'a Affine>,
    frame: Option<&Frame>,
) -> Result<Csg, Error> {
    let mut own = *octree.frame();
    let top = own.origin().map(|low| match two_sum(low, own.edge()) {
        (sum, error) if error > 0.0 => sum.next_up(),
        (sum, _) => sum,
    });
    let mut bounds = (own.origin(), top);
    let Some(frame) = frame else { return stand_in(bounds, placements) };
    let mut solid = AnySolid::new(octree.clone());
    let mut placements = placements.peekable();
    if placements.peek().is_none() && own != *frame {
        solid = AnySolid::new(Transform::new(solid, &own, &Affine::IDENTITY));
    }
    while let Some(placement) = placements.next() {
        bounds = stand_in(bounds, core::iter::once(placement))?.bounds().unwrap_or(bounds);
        solid = AnySolid::new(Transform::new(solid, &own, placement));
        if placements.peek().is_some() {
            own = own_frame(bounds, frame)?;
        }
    }
    Ok(Csg::solid(solid))
}

/// A frame for an octree that is to be placed again, whose cells are no larger than those of the last one.
fn own_frame((min, max): Corners, frame: &Frame) -> Result<Frame, Error> {
    let own = Frame::around(min, max, 1)?;
    let fits = |&depth: &u8| own.edge() / f64::from(1u32 << depth) <= frame.cell_size();
    own.with_depth((1..=MAX_DEPTH).find(fits).unwrap_or(MAX_DEPTH))
}
