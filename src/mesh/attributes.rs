//! Data on the triangles of a mesh: colours, materials, numbers of any kind.
//!
//! An attribute is a table of values, and a row number for each triangle or for each of its corners. A value
//! that many triangles share is stored once. A corner can have its own value although its vertex was welded
//! to others. When a triangle is dropped, its rows are dropped with it, and nothing else changes.

use alloc::string::String;
use alloc::vec::Vec;

use crate::error::Error;
use crate::memory;

/// The elements that bear the values of a [`MeshAttribute`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AttributeDomain {
    /// Each triangle has a value, which holds everywhere on it.
    Triangle,
    /// Each corner of each triangle has a value. Between the corners values are interpolated linearly.
    Corner,
}

/// Named values of one to four numbers on the triangles of a mesh, or on their corners.
///
/// A mesh [carries attributes](crate::TriangleMesh::with_attributes) through welding, sewing, scaling and
/// placing. When a triangle is dropped, its values are dropped too. When a triangle's orientation is
/// reversed, the values stay at their corners.
///
/// ```
/// use leafless::{TriangleMesh, mesh::MeshAttribute};
///
/// // A square of two triangles, and a triangle without extent between them.
/// let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let heat = MeshAttribute::per_triangle("heat", 1, &[20.0, 99.0, 35.0])?;
/// let mesh = TriangleMesh::with_attributes(vertices, vec![[0, 1, 2], [1, 2, 1], [0, 2, 3]], vec![heat])?;
///
/// let heat = mesh.attribute("heat").unwrap();
/// assert_eq!((mesh.triangles().len(), heat.len()), (2, 2));
/// assert_eq!(heat.value(1, 0), Some([35.0, 0.0, 0.0, 0.0]));
/// # Ok::<(), leafless::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MeshAttribute {
    name: String,
    components: usize,
    table: Table,
    rows: Rows,
    names: Vec<String>,
}

#[derive(Debug, Clone, PartialEq)]
enum Table {
    /// The value of a row is its number.
    Labels,
    /// The rows, one after another.
    Values(Vec<f64>),
}

/// A row number for each triangle, or for each corner.
#[derive(Debug, Clone, PartialEq)]
enum Rows {
    Triangles(Vec<u32>),
    Corners(Vec<[u32; 3]>),
}

impl MeshAttribute {
    /// Returns the bytes of memory that the attribute keeps.
    pub fn bytes(&self) -> u64 {
        let table = match &self.table {
            Table::Labels => 0,
            Table::Values(values) => memory::bytes_of(values),
        };
        let rows = match &self.rows {
            Rows::Triangles(rows) => memory::bytes_of(rows),
            Rows::Corners(rows) => memory::bytes_of(rows),
        };
        let names = memory::bytes_of(&self.names) + self.names.iter().map(String::capacity).sum::<usize>();
        (self.name.capacity() + table + rows + names) as u64
    }

    /// A row number that stands for "no value".
    pub const NO_ROW: u32 = u32::MAX;

    /// Builds an attribute with a value of `components` numbers for each triangle. `values` has the numbers
    /// of the first triangle, then of the second, and so on. A value with a number that is not finite counts
    /// as no value.
    ///
    /// O(t). 8 bytes a number and 4 a triangle.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there are 1 to 4 components, and `values` is a multiple of that;
    /// [`Error::OutOfMemory`].
    pub fn per_triangle(name: &str, components: usize, values: &[f64]) -> Result<Self, Error> {
        let rows = memory::collected(0..row_count(values, components)?)?;
        Self::by_triangle(name, components, memory::copied(values)?, rows)
    }

    /// Builds an attribute with a value of `components` numbers for each corner. `values` has the numbers of
    /// the three corners of the first triangle, then of the second, and so on. A value with a number that is
    /// not finite counts as no value.
    ///
    /// O(t). 8 bytes a number and 12 a triangle.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there are 1 to 4 components, and `values` is a multiple of three times
    /// that; [`Error::OutOfMemory`].
    pub fn per_corner(name: &str, components: usize, values: &[f64]) -> Result<Self, Error> {
        let corners = row_count(values, components)?;
        if corners % 3 != 0 {
            return refused("values", "must have a value for each of the three corners of each triangle");
        }
        let rows = memory::collected((0..corners / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]))?;
        Self::by_corner(name, components, memory::copied(values)?, rows)
    }

    /// Builds an attribute with, for each triangle, a row of a table of values, or [`NO_ROW`](Self::NO_ROW).
    /// With the [bodies](crate::TriangleMesh::bodies) of a mesh as row numbers, the table has a value for
    /// each body.
    ///
    /// O(t). A row with a number that is not finite counts as no value.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there are 1 to 4 components, `table` is a multiple of that, and every row
    /// is one of the table; [`Error::OutOfMemory`].
    pub fn by_triangle(
        name: &str,
        components: usize,
        table: Vec<f64>,
        rows: Vec<u32>,
    ) -> Result<Self, Error> {
        check_rows(&rows, row_count(&table, components)?)?;
        Self::with(name, components, Table::Values(table), Rows::Triangles(rows))
    }

    /// Builds an attribute with, for each corner of each triangle, a row of a table of values, or
    /// [`NO_ROW`](Self::NO_ROW).
    ///
    /// O(t). A row with a number that is not finite counts as no value.
    ///
    /// # Errors
    /// As [`by_triangle`](Self::by_triangle).
    pub fn by_corner(
        name: &str,
        components: usize,
        table: Vec<f64>,
        rows: Vec<[u32; 3]>,
    ) -> Result<Self, Error> {
        check_rows(rows.as_flattened(), row_count(&table, components)?)?;
        Self::with(name, components, Table::Values(table), Rows::Corners(rows))
    }

    /// Builds an attribute whose values are the given numbers, one for each triangle: the number of a body, a
    /// face or a material. The greatest `u32` means no value.
    ///
    /// O(1). 4 bytes a triangle.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn labels(name: &str, labels: Vec<u32>) -> Result<Self, Error> {
        Self::with(name, 1, Table::Labels, Rows::Triangles(labels))
    }

    fn with(name: &str, components: usize, table: Table, rows: Rows) -> Result<Self, Error> {
        Ok(Self { name: memory::text(name)?, components, table, rows, names: Vec::new() })
    }

    /// Returns the same attribute with names for the values 0, 1, 2 …, such as names of materials.
    #[must_use]
    pub fn named(self, names: Vec<String>) -> Self {
        Self { names, ..self }
    }

    /// Returns the name. All attributes of a mesh have different names.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of components of a value: 1 to 4.
    pub fn components(&self) -> usize {
        self.components
    }

    /// Returns the elements that bear values: triangles or corners.
    pub fn domain(&self) -> AttributeDomain {
        match self.rows {
            Rows::Triangles(_) => AttributeDomain::Triangle,
            Rows::Corners(_) => AttributeDomain::Corner,
        }
    }

    /// Returns the number of triangles.
    pub fn len(&self) -> usize {
        match &self.rows {
            Rows::Triangles(rows) => rows.len(),
            Rows::Corners(rows) => rows.len(),
        }
    }

    /// Returns whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the names of the values 0, 1, 2 …, if they have names. There may be more values than names.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the value at a corner (0, 1 or 2) of a triangle, filled up with zeros; `None` if there is no
    /// value or no such corner. O(1).
    #[inline]
    pub fn value(&self, triangle: usize, corner: usize) -> Option<[f64; 4]> {
        let row = match &self.rows {
            Rows::Triangles(rows) if corner < 3 => *rows.get(triangle)?,
            Rows::Triangles(_) => return None,
            Rows::Corners(rows) => *rows.get(triangle)?.get(corner)?,
        };
        self.row(row)
    }

    /// Returns the values at the three corners of a triangle; `None` unless all three have a value. O(1).
    #[inline]
    pub(crate) fn corners(&self, triangle: usize) -> Option<[[f64; 4]; 3]> {
        match &self.rows {
            Rows::Triangles(rows) => self.row(*rows.get(triangle)?).map(|value| [value; 3]),
            Rows::Corners(rows) => {
                let &[a, b, c] = rows.get(triangle)?;
                Some([self.row(a)?, self.row(b)?, self.row(c)?])
            }
        }
    }

    #[inline]
    fn row(&self, row: u32) -> Option<[f64; 4]> {
        if row == Self::NO_ROW {
            return None;
        }
        match &self.table {
            Table::Labels => Some([f64::from(row), 0.0, 0.0, 0.0]),
            Table::Values(values) => {
                let start = row as usize * self.components;
                let numbers = values.get(start..start + self.components)?;
                let mut value = [0.0; 4];
                value[..self.components].copy_from_slice(numbers);
                value.iter().all(|number| number.is_finite()).then_some(value)
            }
        }
    }

    /// Returns whether the values are the row numbers themselves, as given to [`labels`](Self::labels).
    pub(crate) fn is_label(&self) -> bool {
        matches!((&self.table, &self.rows), (Table::Labels, Rows::Triangles(_)))
    }

    /// Keeps the triangles for which `is_kept` returns true.
    pub(crate) fn retain(&mut self, mut is_kept: impl FnMut(usize) -> bool) {
        let mut next = 0..;
        // The iterator is endless.
        let mut keeps = || next.next().is_some_and(&mut is_kept);
        match &mut self.rows {
            Rows::Triangles(rows) => rows.retain(|_| keeps()),
            Rows::Corners(rows) => rows.retain(|_| keeps()),
        }
    }

    /// Returns the row numbers of the triangles; for [`labels`](Self::labels) these are the given values.
    #[cfg(feature = "std")]
    pub(super) fn into_labels(self) -> Vec<u32> {
        match self.rows {
            Rows::Triangles(rows) => rows,
            Rows::Corners(_) => Vec::new(),
        }
    }

    /// Follows triangles whose orientation is reversed by swapping their last two corners.
    pub(super) fn turn_round(&mut self) {
        if let Rows::Corners(rows) = &mut self.rows {
            rows.iter_mut().for_each(|[_, b, c]| core::mem::swap(b, c));
        }
    }

    /// Returns a copy.
    pub(crate) fn try_clone(&self) -> Result<Self, Error> {
        let table = match &self.table {
            Table::Labels => Table::Labels,
            Table::Values(values) => Table::Values(memory::copied(values)?),
        };
        let rows = match &self.rows {
            Rows::Triangles(rows) => Rows::Triangles(memory::copied(rows)?),
            Rows::Corners(rows) => Rows::Corners(memory::copied(rows)?),
        };
        let mut names = memory::with_capacity(self.names.len())?;
        for name in &self.names {
            names.push(memory::text(name)?);
        }
        Ok(Self { name: memory::text(&self.name)?, components: self.components, table, rows, names })
    }
}

/// Returns copies of attributes.
pub(super) fn copies(attributes: &[MeshAttribute]) -> Result<Vec<MeshAttribute>, Error> {
    let mut copies = memory::with_capacity(attributes.len())?;
    for attribute in attributes {
        copies.push(attribute.try_clone()?);
    }
    Ok(copies)
}

/// Checks that each attribute has this number of triangles and a unique name.
pub(super) fn check(attributes: &[MeshAttribute], triangles: usize) -> Result<(), Error> {
    if attributes.iter().any(|attribute| attribute.len() != triangles) {
        return refused("attributes", "must have as many triangles as the mesh");
    }
    let is_repeated = |(k, attribute): (usize, &MeshAttribute)| {
        attributes[..k].iter().any(|other| other.name == attribute.name)
    };
    if attributes.iter().enumerate().any(is_repeated) {
        return refused("attributes", "must have different names");
    }
    Ok(())
}

/// Returns the number of rows of a table.
fn row_count(table: &[f64], components: usize) -> Result<u32, Error> {
    if !(1..=4).contains(&components) {
        return refused("components", "must be 1 to 4");
    }
    if !table.len().is_multiple_of(components) {
        return refused("values", "must be a multiple of the components");
    }
    match u32::try_from(table.len() / components) {
        Ok(rows) if rows < MeshAttribute::NO_ROW => Ok(rows),
        _ => refused("values", "must be fewer than 2^32 - 1"),
    }
}

fn check_rows(rows: &[u32], count: u32) -> Result<(), Error> {
    if rows.iter().any(|&row| row >= count && row != MeshAttribute::NO_ROW) {
        return refused("rows", "must be rows of the table");
    }
    Ok(())
}

fn refused<T>(name: &'static str, problem: &'static str) -> Result<T, Error> {
    Err(Error::Argument { name, problem })
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    const NAN: f64 = f64::NAN;

    #[test]
    fn values_and_what_is_none() {
        let heat = MeshAttribute::per_triangle("heat", 2, &[1.0, 2.0, 3.0, NAN]).unwrap();
        assert_eq!((heat.len(), heat.components(), heat.domain()), (2, 2, AttributeDomain::Triangle));
        for corner in 0..3 {
            assert_eq!(heat.value(0, corner), Some([1.0, 2.0, 0.0, 0.0]));
            assert_eq!(heat.value(1, corner), None);
        }
        assert_eq!((heat.value(0, 3), heat.value(2, 0), heat.value(usize::MAX, 0)), (None, None, None));
        let corners = [0.0, 1.0, 2.0, 3.0, 4.0, NAN];
        let shade = MeshAttribute::per_corner("shade", 1, &corners).unwrap();
        assert_eq!((shade.len(), shade.domain()), (2, AttributeDomain::Corner));
        assert_eq!(shade.value(0, 2), Some([2.0, 0.0, 0.0, 0.0]));
        assert_eq!((shade.value(1, 1).is_some(), shade.value(1, 2), shade.value(1, 3)), (true, None, None));
        assert!(shade.corners(0).is_some() && shade.corners(1).is_none() && shade.corners(2).is_none());
        let labels = MeshAttribute::labels("part", vec![7, u32::MAX]).unwrap();
        assert_eq!((labels.value(0, 1), labels.value(1, 1)), (Some([7.0, 0.0, 0.0, 0.0]), None));
        let rows = vec![1, MeshAttribute::NO_ROW, 0, 1];
        let shared = MeshAttribute::by_triangle("shared", 1, vec![5.0, 6.0], rows).unwrap();
        let values: Vec<_> = (0..4).map(|t| shared.value(t, 0).map(|value| value[0])).collect();
        assert_eq!(values, [Some(6.0), None, Some(5.0), Some(6.0)]);
        assert_eq!(shared.try_clone().unwrap(), shared);
    }

    #[test]
    fn what_is_refused() {
        let refused = |result: Result<MeshAttribute, Error>, expected| match result {
            Err(Error::Argument { name, .. }) => assert_eq!(name, expected),
            other => panic!("{other:?}"),
        };
        refused(MeshAttribute::per_triangle("a", 0, &[]), "components");
        refused(MeshAttribute::per_triangle("a", 5, &[0.0; 5]), "components");
        refused(MeshAttribute::per_triangle("a", 2, &[0.0; 3]), "values");
        refused(MeshAttribute::per_corner("a", 1, &[0.0; 4]), "values");
        refused(MeshAttribute::by_triangle("a", 2, vec![0.0; 4], vec![2]), "rows");
        refused(MeshAttribute::by_corner("a", 1, vec![], vec![[0; 3]]), "rows");
        assert!(MeshAttribute::by_corner("a", 1, vec![], vec![[u32::MAX; 3]]).is_ok());
    }
}
