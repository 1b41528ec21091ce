//! Writers of polygons.
//!
//! The formats have no holes. A face with holes is triangulated, and the triangles are merged again: a
//! polygon begins as a triangle and absorbs neighbours across its edges, as long as there is one whose third
//! corner is new to the polygon. The polygon therefore stays a disc without repeated corners, and all corners
//! of the face stay corners.

use super::attributes::line_of;
use super::lines::{Lines, Point};
use super::{WriteOptions, stated};
use crate::error::{Error, PolyhedronError};
use crate::exchange::MeshFormat;
use crate::exchange::stated::Line;
use crate::lattice::Each;
use crate::memory;
use crate::mesh::polygon::{PolygonDefect, triangulate};
use crate::mesh::{Polyhedron, PolyhedronArrays};
use alloc::vec::Vec;
use hashbrown::HashMap;

/// Returns an OBJ or OFF file of a polyhedron, with its faces as polygons. A face with holes, which these
/// formats do not have, is divided into a few polygons without holes; all other faces are written as given.
/// No vertex is added, and vertices keep their order.
///
/// The faces are checked as in [`Polyhedron::new`], so that [`read_obj`](crate::exchange::read_obj) and
/// [`read_off`](crate::exchange::read_off) return a closed mesh of the same solids. Only the option
/// `deviation` is used. Needs the feature `std`.
///
/// O(n log n) expected.
///
/// # Errors
/// [`Error::Argument`] for other formats, and for a deviation that
/// [`TriangleMesh::with_deviation`](crate::TriangleMesh::with_deviation) refuses; the errors of
/// [`Polyhedron::new`]; [`Error::OutOfMemory`].
///
/// ```
/// use leafless::exchange::{MeshFormat, WriteOptions, read_obj, write_polygons};
/// use leafless::mesh::PolyhedronArrays;
/// // A pyramid with a square base.
/// let pyramid = PolyhedronArrays {
///     vertices: &[[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [1., 1., 3.]],
///     corners: &[3, 2, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4],
///     loops: &[0, 4, 7, 10, 13, 16],
///     faces: &[0, 1, 2, 3, 4, 5],
///     shells: &[0, 5],
///     solids: &[0, 1],
/// };
/// let file = write_polygons(&pyramid, MeshFormat::Obj, &WriteOptions::default())?;
/// assert!(file.ends_with(b"v 1 1 3\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"));
/// assert_eq!(read_obj(&file)?.volume(), 4.0);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn write_polygons(
    arrays: &PolyhedronArrays<'_>,
    format: MeshFormat,
    options: &WriteOptions,
) -> Result<Vec<u8>, Error> {
    write_grouped_polygons(arrays, &[], format, options)
}

/// Writes polygons as [`write_polygons`] does, with groups in an OBJ. Each entry of `groups` applies to the
/// faces from its number up to the next entry. These faces belong to all groups whose names are in the entry,
/// separated by blanks. The numbers ascend. An OFF has no groups.
///
/// # Errors
/// The errors of [`write_polygons`].
pub fn write_grouped_polygons(
    arrays: &PolyhedronArrays<'_>,
    groups: &[(u32, &str)],
    format: MeshFormat,
    options: &WriteOptions,
) -> Result<Vec<u8>, Error> {
    stated::check(options.deviation)?;
    if !matches!(format, MeshFormat::Obj | MeshFormat::Off) {
        return Err(Error::Argument { name: "format", problem: "must be OBJ or OFF, which have polygons" });
    }
    Polyhedron::new(arrays)?;
    let mut polygons = Polygons::default();
    // The number of polygons before each face.
    let mut starts = memory::with_capacity(arrays.faces.len())?;
    for (face, loops) in arrays.faces.windows(2).enumerate() {
        starts.push(polygons.ends.len());
        // (The offsets were checked.)
        let loops = &arrays.loops[loops[0] as usize..=loops[1] as usize];
        let corners = &arrays.corners[loops[0] as usize..loops[loops.len() - 1] as usize];
        if loops.len() == 2 {
            polygons.push(corners)?;
        } else {
            let ends = memory::collected(loops[1..].iter().map(|&end| (end - loops[0]) as usize))?;
            polygons.push_cut(arrays.vertices, corners, &ends, face as u64)?;
        }
    }
    let mut lines = Lines::default();
    let mark = |lines: &mut Lines| match options.deviation {
        Some(deviation) => lines.add(format_args!("{}", Line("# ", deviation))),
        None => Ok(()),
    };
    let is_obj = format == MeshFormat::Obj;
    if is_obj {
        mark(&mut lines)?;
    } else {
        lines.add(format_args!("OFF\n"))?;
        mark(&mut lines)?;
        lines.add(format_args!("{} {} 0\n", arrays.vertices.len(), polygons.ends.len()))?;
    }
    for &vertex in arrays.vertices {
        lines.add(format_args!("{}{}\n", if is_obj { "v " } else { "" }, Point(vertex)))?;
    }
    let (mut start, mut group) = (0, groups.iter());
    let mut next = group.next();
    for (number, &end) in polygons.ends.iter().enumerate() {
        while let Some((face, name)) = next
            && starts.get(*face as usize).is_none_or(|&first| first <= number)
        {
            if is_obj {
                lines.add(format_args!("g {}\n", line_of(name, *face as usize)?))?;
            }
            next = group.next();
        }
        match is_obj {
            true => lines.add(format_args!("f"))?,
            false => lines.add(format_args!("{}", end - start))?,
        }
        for &corner in &polygons.corners[start..end] {
            lines.add(format_args!(" {}", u64::from(corner) + u64::from(is_obj)))?;
        }
        lines.add(format_args!("\n"))?;
        start = end;
    }
    Ok(lines.bytes())
}

/// Simple polygons, one after another.
#[derive(Default)]
struct Polygons {
    corners: Vec<u32>,
    ends: Vec<usize>,
}

impl Polygons {
    fn push(&mut self, corners: &[u32]) -> Result<(), Error> {
        self.corners.try_reserve(corners.len())?;
        self.corners.extend_from_slice(corners);
        memory::push(&mut self.ends, self.corners.len())
    }

    /// Adds a face of several loops, divided into polygons.
    fn push_cut(
        &mut self,
        vertices: &[[f64; 3]],
        corners: &[u32],
        ends: &[usize],
        face: u64,
    ) -> Result<(), Error> {
        let mut triangles = Vec::new();
        triangulate(vertices, corners, ends, &mut triangles).map_err(|defect| match defect {
            PolygonDefect::OutOfMemory => Error::OutOfMemory,
            // (The triangulation succeeded before.)
            _ => PolyhedronError::Loops { face }.into(),
        })?;
        // The triangle to the left of each edge.
        let mut sides = HashMap::new();
        sides.try_reserve(3 * triangles.len())?;
        for (number, [a, b, c]) in triangles.iter().enumerate() {
            for edge in [[a, b], [b, c], [c, a]] {
                sides.insert(edge.each(|&vertex| vertex), number);
            }
        }
        let mut is_taken = memory::filled(triangles.len(), false)?;
        // The next corner after each corner of the polygon, and the edges that are not yet processed.
        let (mut next, mut open) = (HashMap::new(), Vec::new());
        for first in 0..triangles.len() {
            if core::mem::replace(&mut is_taken[first], true) {
                continue;
            }
            let [a, b, c] = triangles[first];
            next.clear();
            next.try_reserve(3)?;
            open.clear();
            for (from, to) in [(a, b), (b, c), (c, a)] {
                next.insert(from, to);
                memory::push(&mut open, (from, to))?;
            }
            let mut looked = 0;
            while let Some(&(from, to)) = open.get(looked) {
                looked += 1;
                let Some(&number) = sides.get(&[to, from]).filter(|&&number| !is_taken[number]) else {
                    continue;
                };
                let apex = triangles[number].into_iter().find(|&vertex| vertex != from && vertex != to);
                let Some(apex) = apex.filter(|apex| !next.contains_key(apex)) else { continue };
                is_taken[number] = true;
                next.try_reserve(1)?;
                next.insert(from, apex);
                next.insert(apex, to);
                memory::push(&mut open, (from, apex))?;
                memory::push(&mut open, (apex, to))?;
            }
            self.corners.try_reserve(next.len())?;
            let mut at = a;
            for _ in 0..next.len() {
                self.corners.push(at);
                at = next.get(&at).copied().unwrap_or(a);
            }
            memory::push(&mut self.ends, self.corners.len())?;
        }
        Ok(())
    }
}
