//! Lower bounds of a surface's size, known before extraction.

use super::samples::Samples;
use crate::control::Control;
use crate::error::{Error, MeshError};
use crate::octree::{CellFilter, OctreeRef, Tag};

/// The least memory and vertices of a surface per edge between neighbouring samples of which one lies inside.
pub(super) struct Least {
    /// Bytes per edge.
    pub bytes: u64,
    /// The greatest number of these edges per vertex.
    pub edges_a_vertex: u64,
}

impl Least {
    /// Marching cubes: a vertex for each edge. A closed surface around one sample has six vertices and eight
    /// triangles, and no closed surface has fewer triangles per vertex.
    pub const CUBES: Least = Least { bytes: 24 + 4 * 12 / 3, edges_a_vertex: 1 };
    /// Surface nets: two triangles for each edge, and a vertex for at most twelve edges, each of which
    /// belongs to four cubes.
    pub const NETS: Least = Least { bytes: 24 + 24 / 3, edges_a_vertex: 3 };
    /// Vertices at samples: each sample is the end of at most six edges.
    pub const SAMPLES: Least = Least { bytes: 4, edges_a_vertex: 6 };
    /// Few triangles for many edges: only blocks count.
    pub const REGIONS: Least = Least { bytes: 0, edges_a_vertex: u64::MAX };
}

/// Refuses a surface that is certainly larger than the caller allows, or has more vertices than 32 bits can
/// number. `block` is the size of a block of samples, which has at most 192 edges.
///
/// O(elements of the tree). Edges are counted only if the cells, each with all its faces, could have too many
/// edges.
pub(super) fn afford(
    samples: &Samples<'_>,
    least: &Least,
    block: u64,
    control: &Control<'_>,
) -> Result<(), Error> {
    let (tree, partial) = (samples.tree(), samples.counts_partial());
    let needed = |edges: u64| edges.saturating_mul(least.bytes).saturating_add(edges / 192 * block);
    let too_many = |edges: u64| edges / least.edges_a_vertex > u64::from(u32::MAX);
    let most = most_edges(tree, partial);
    let limit = control.max_bytes.unwrap_or(u64::MAX);
    if !too_many(most) && needed(most) <= limit {
        return Ok(());
    }
    let edges = cut_edges(tree, partial, samples.end());
    control.afford("the surface", needed(edges))?;
    if too_many(edges) { Err(MeshError::TooMany.into()) } else { Ok(()) }
}

/// An upper bound of the cut edges: every face of every inside cell counts as a part of the surface.
fn most_edges(tree: &OctreeRef<'_>, partial: bool) -> u64 {
    // (The level counts of a mapped file may be wrong.)
    let counts = tree.count_levels();
    let depth = u32::from(tree.frame().depth());
    counts.iter().zip(0..=depth).fold(0u64, |sum, (count, level)| {
        let cells = count.full.saturating_add(if partial { count.partial } else { 0 });
        // A face has at most 4^19 edges in a tree of depth 19, and 4^20 in one of depth 20.
        sum.saturating_add(cells.saturating_mul(6 << (2 * (depth - level))))
    })
}

/// The number of cut edges between neighbouring samples in the box of the first `end` samples on each axis.
/// The number including the edges that leave the box is at least as large.
fn cut_edges(tree: &OctreeRef<'_>, partial: bool, end: u32) -> u64 {
    // Everything around the universe is outside.
    let tree = OctreeRef { exterior: Tag::Empty, ..*tree };
    let tags: &[Tag] = if partial { &[Tag::Full, Tag::Partial] } else { &[Tag::Full] };
    let depth = tree.frame().depth();
    let faces = tree.boundary_faces(CellFilter::tags(tags).within([0; 3], [end; 3]));
    faces.fold(0u64, |sum, face| {
        let smaller = face.smaller();
        let size = 1u64 << (depth - smaller.level);
        let steps = face.direction.steps();
        let edges = (0..3).filter(|&axis| steps[axis] == 0).fold(1, |edges, axis| {
            let low = u64::from(smaller.at[axis]) * size;
            edges * u64::from(end).saturating_sub(low).min(size)
        });
        sum.saturating_add(edges)
    })
}

#[cfg(test)]
mod tests {
    use super::super::blocks::Blocks;
    use super::*;
    use crate::control::Job;
    use crate::lattice::Frame;
    use crate::op::{Rule, build};
    use crate::solid::Csg;

    #[test]
    fn as_many_edges_are_counted_as_the_walk_finds() {
        let control = Control::default();
        for depth in 1..=6 {
            let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
            let ball = Csg::ball([0.1, 0.2, 0.0], 0.75).unwrap();
            let holed = Csg::cuboid([-2.0; 3], [0.5, 2.0, 2.0]).unwrap().difference(&ball).unwrap();
            for (solid, rule) in
                [(&ball, Rule::Certified), (&holed, Rule::Certified), (&holed, Rule::Sampled)]
            {
                let tree = build(solid, &frame, rule, &control).unwrap();
                for (partial, end) in [(false, u32::MAX), (true, u32::MAX), (true, frame.cells() / 2 + 1)] {
                    let samples = Samples::new(tree.view(), partial, end).unwrap();
                    let blocks = Blocks::find(&samples, &Least::CUBES, &Job::new(&control), false).unwrap();
                    let (edges, most) =
                        (cut_edges(tree.view(), partial, samples.end()), most_edges(tree.view(), partial));
                    assert!(edges <= blocks.vertices as u64 && blocks.vertices as u64 <= most);
                    if end == u32::MAX {
                        assert_eq!(edges, blocks.vertices as u64);
                    }
                    // The lower bound does not exceed the actual size.
                    assert!(blocks.triangles >= blocks.vertices * 4 / 3);
                }
            }
        }
    }

    #[test]
    fn a_cell_that_is_huge_is_refused_at_once() {
        let frame = Frame::new([0.0; 3], 1.0, 20).unwrap();
        let tree =
            build(&Csg::cuboid([0.0; 3], [1.0; 3]).unwrap(), &frame, Rule::Certified, &Control::default());
        let tree = tree.unwrap();
        let samples = Samples::new(tree.view(), false, u32::MAX).unwrap();
        let edges = 6u64 << 40;
        let limited = Control { max_bytes: Some(1 << 30), ..Control::default() };
        for (least, needed) in [
            (Least::CUBES, edges * 40 + edges / 192 * 56),
            (Least::NETS, edges * 32 + edges / 192 * 56),
            (Least::SAMPLES, edges * 4 + edges / 192 * 56),
            (Least::REGIONS, edges / 192 * 56),
        ] {
            match afford(&samples, &least, 56, &limited) {
                Err(Error::TooLarge { needed: told, limit, .. }) => {
                    assert_eq!((told, limit), (needed, 1 << 30))
                }
                other => panic!("{other:?}"),
            }
        }
        let unlimited = Control::default();
        assert!(matches!(
            afford(&samples, &Least::CUBES, 56, &unlimited),
            Err(Error::Mesh(MeshError::TooMany))
        ));
    }
}
