//! The faces, shells and solids of a polyhedron, and values on them.

use alloc::vec::Vec;

use super::attributes::MeshAttribute;
use super::polyhedron::Polyhedron;
use crate::error::Error;
use crate::memory;

/// The kinds of parts of a polyhedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PolyhedronPart {
    /// The faces of its solids.
    Face,
    /// The shells of its solids: the outer one and the voids of each.
    Shell,
    /// The solids.
    Solid,
}

impl Polyhedron {
    /// Returns the number of faces, shells or solids.
    pub fn part_count(&self, part: PolyhedronPart) -> usize {
        // Offsets begin with 0, and end with the number of parts below.
        let below = |offsets: &[u32]| offsets.last().map_or(0, |&count| count as usize);
        match part {
            PolyhedronPart::Face => below(&self.shells),
            PolyhedronPart::Shell => below(&self.solids),
            PolyhedronPart::Solid => self.solids.len().saturating_sub(1),
        }
    }

    /// Returns the face, shell or solid to which each triangle of the [mesh](Self::mesh) belongs, numbered as
    /// in the [arrays](crate::mesh::PolyhedronArrays) from which the polyhedron was made. Triangles are in
    /// the order of faces.
    ///
    /// O(t).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn parts(&self, part: PolyhedronPart) -> Result<Vec<u32>, Error> {
        let mut parts = memory::copied(&self.faces)?;
        if part != PolyhedronPart::Face {
            raise(&mut parts, &self.shells);
        }
        if part == PolyhedronPart::Solid {
            raise(&mut parts, &self.solids);
        }
        Ok(parts)
    }

    /// Builds an attribute of the [mesh](Self::mesh) from values of faces, shells or solids. `values` has
    /// `components` numbers for the first part, then for the second, and so on. A value with a number that is
    /// not finite counts as no value.
    ///
    /// O(t + n).
    ///
    /// ```
    /// use leafless::{
    ///     attribute::{Attribute, SurfaceAttribute}, mesh::{Polyhedron, PolyhedronArrays, PolyhedronPart},
    /// };
    ///
    /// # let vertices = [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [1., 1., 3.]];
    /// # let corners = [3, 2, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
    /// # let pyramid = Polyhedron::new(&PolyhedronArrays {
    /// #     vertices: &vertices, corners: &corners, loops: &[0, 4, 7, 10, 13, 16],
    /// #     faces: &[0, 1, 2, 3, 4, 5], shells: &[0, 5], solids: &[0, 1],
    /// # })?;
    /// // The base of a pyramid is warm, its four sides are not.
    /// let heat = pyramid.attribute(PolyhedronPart::Face, "heat", 1, &[60.0, 20.0, 20.0, 20.0, 20.0])?;
    /// let heat = SurfaceAttribute::new(pyramid.into_mesh(), heat)?;
    /// assert_eq!(heat.value([1.0, 1.0, 0.1])?, Some([60.0, 0.0, 0.0, 0.0]));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] unless there are 1 to 4 components and a value for each part;
    /// [`Error::OutOfMemory`].
    pub fn attribute(
        &self,
        part: PolyhedronPart,
        name: &str,
        components: usize,
        values: &[f64],
    ) -> Result<MeshAttribute, Error> {
        if self.part_count(part).checked_mul(components) != Some(values.len()) {
            return Err(Error::Argument { name: "values", problem: "must have a value for each part" });
        }
        MeshAttribute::by_triangle(name, components, memory::copied(values)?, self.parts(part)?)
    }

    /// Adds an attribute to the [mesh](Self::mesh) of the polyhedron.
    ///
    /// # Errors
    /// As [`TriangleMesh::add_attribute`](crate::TriangleMesh::add_attribute).
    pub fn add_attribute(&mut self, attribute: MeshAttribute) -> Result<(), Error> {
        self.mesh.add_attribute(attribute)
    }
}

/// Replaces ascending numbers of parts by the numbers of the wholes that contain them.
fn raise(parts: &mut [u32], offsets: &[u32]) {
    let mut whole = 0;
    for part in parts {
        while offsets.get(whole as usize + 1).is_some_and(|&end| end <= *part) {
            whole += 1;
        }
        *part = whole;
    }
}
