//! The space around a container, as a solid.

use super::item::on_any_frame;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Bounds, axes};
use crate::memory;
use crate::mesh::{FillRule, MeshMoments, TriangleMesh};
use crate::solid::{AnySolid, Csg, MeshSolid};
use alloc::vec::Vec;

/// Returns a block minus the container, which lies within the block. If the container is a good mesh, the
/// result is a mesh, too, so that triangles determine the distance of other meshes.
pub(super) fn wall(container: &AnySolid, outer: &Bounds, control: &Control<'_>) -> Result<AnySolid, Error> {
    if let Some(mesh) = container.get::<MeshSolid>().map(|solid| solid.mesh())
        && is_good(mesh, control)?
    {
        return Ok(AnySolid::new(MeshSolid::new(turned_out(mesh, outer)?, FillRule::Positive)?));
    }
    let wall = Csg::cuboid(outer.min, outer.max)?.difference(&Csg::solid(on_any_frame(container)))?;
    Ok(AnySolid::new(wall))
}

/// Returns a block minus a smaller one, as a mesh.
pub(super) fn wall_of_box(bounds: &Bounds, outer: &Bounds) -> Result<AnySolid, Error> {
    let (vertices, triangles) = block(bounds, 0, 0)?;
    let mesh = turned_out(&TriangleMesh::new(vertices, triangles)?, outer)?;
    Ok(AnySolid::new(MeshSolid::new(mesh, FillRule::Positive)?))
}

/// True if the winding number of each point is known to agree with the solid by every rule except the
/// even-odd rule: no triangles intersect, and no body is inside out.
fn is_good(mesh: &TriangleMesh, control: &Control<'_>) -> Result<bool, Error> {
    let own = Control { progress: None, ..*control };
    let is_known = matches!(mesh.moments(FillRule::NonZero, &own)?, MeshMoments::Known(_));
    Ok(is_known && mesh.report()?.inside_out_bodies == 0)
}

/// Returns the triangles of a block, and the inverted triangles of a mesh.
fn turned_out(mesh: &TriangleMesh, outer: &Bounds) -> Result<TriangleMesh, Error> {
    let (mut vertices, mut triangles) = block(outer, mesh.vertices().len(), mesh.triangles().len())?;
    vertices.extend(mesh.vertices());
    triangles.extend(mesh.triangles().iter().map(|&[a, b, c]| [a + 8, c + 8, b + 8]));
    TriangleMesh::new(vertices, triangles)?.with_deviation(mesh.displacement())
}

/// A block as a mesh.
pub(super) fn block_mesh(bounds: &Bounds) -> Result<AnySolid, Error> {
    let (vertices, triangles) = block(bounds, 0, 0)?;
    Ok(AnySolid::new(MeshSolid::new(TriangleMesh::new(vertices, triangles)?, FillRule::NonZero)?))
}

/// Corners, and triangles between them.
type Parts = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// Returns the corners of a block and its triangles. Both lists have room for the given number of further
/// elements.
fn block(bounds: &Bounds, more_vertices: usize, more_triangles: usize) -> Result<Parts, Error> {
    /// The faces of a block by their corners. Bit k of a corner selects the upper side along axis k.
    const FACES: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut vertices = memory::with_capacity(8 + more_vertices)?;
    let mut triangles = memory::with_capacity(12 + more_triangles)?;
    for corner in 0..8 {
        vertices.push(axes(|k| if corner >> k & 1 == 0 { bounds.min[k] } else { bounds.max[k] }));
    }
    for [a, b, c, d] in FACES {
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    Ok((vertices, triangles))
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    #[test]
    fn a_wall_has_the_volume_that_the_container_leaves() {
        let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
        let outer = Bounds::new([-1.0; 3], [2.0; 3]).unwrap();
        let container = AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).unwrap());
        let wall = wall(&container, &outer, &Control::threads(1)).unwrap();
        let mesh = wall.get::<MeshSolid>().unwrap().mesh();
        let MeshMoments::Known(moments) = mesh.moments(FillRule::Positive, &Control::threads(1)).unwrap()
        else {
            panic!("the wall is a good mesh");
        };
        assert!(moments.volume.contains(27.0 - 1.0 / 6.0), "{moments:?}");
        // A mesh that is inside out is not good.
        let turned = mesh.triangles()[12..].iter().map(|own| own.map(|vertex| vertex - 8)).collect();
        let turned = TriangleMesh::new(mesh.vertices()[8..].to_vec(), turned).unwrap();
        let container = AnySolid::new(MeshSolid::new(turned, FillRule::NonZero).unwrap());
        assert!(super::wall(&container, &outer, &Control::threads(1)).unwrap().get::<MeshSolid>().is_none());
    }
}
