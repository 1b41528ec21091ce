//! Results of one proof that hold in the next: distances of triangles that both meshes have, and distances of
//! the boundary in a cell from such triangles.

use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// A triangle by the bits of its corners, the least corner first, and its surface.
type Key = ([[u64; 3]; 3], u32);

/// Facts about triangles and cells that hold for any mesh.
#[derive(Default)]
pub(in super::super) struct Known {
    /// A name for each triangle of any mesh.
    names: HashMap<Key, u32>,
    /// A bound of the distance of each triangle from the boundary, by its name.
    near: Vec<Option<f64>>,
    /// Whether the current mesh has the triangle.
    is_there: Vec<bool>,
    /// The names of the mesh's triangles.
    of_mesh: Vec<u32>,
    cells: HashMap<Cell, Shown>,
}

/// A bound of the distance of the boundary in a cell from some triangles, with their names.
struct Shown {
    most: f64,
    by: Vec<u32>,
}

impl Known {
    /// Changes to another mesh.
    pub(super) fn turn_to(
        &mut self,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        surfaces: &[u32],
    ) -> Result<(), Error> {
        self.is_there.fill(false);
        self.of_mesh.clear();
        for (triangle, &surface) in triangles.iter().zip(surfaces) {
            let mut corners = triangle.each(|v| vertices[v as usize].each(f64::to_bits));
            let first = (0..3).fold(0, |best, k| if corners[k] < corners[best] { k } else { best });
            corners.rotate_left(first);
            self.names.try_reserve(1)?;
            let next = self.near.len() as u32;
            let name = *self.names.entry((corners, surface)).or_insert(next);
            if name == next {
                memory::push(&mut self.near, None)?;
                memory::push(&mut self.is_there, false)?;
            }
            self.is_there[name as usize] = true;
            memory::push(&mut self.of_mesh, name)?;
        }
        Ok(())
    }

    /// The bound of a triangle's distance from the boundary, if it is known.
    pub(super) fn of_triangle(&self, number: u32) -> Option<f64> {
        self.near[self.of_mesh[number as usize] as usize]
    }

    pub(super) fn keep_triangle(&mut self, number: u32, most: f64) {
        self.near[self.of_mesh[number as usize] as usize] = Some(most);
    }

    /// The bound of the distance of the boundary in a cell from the mesh, if it is known.
    pub(super) fn of_cell(&self, cell: Cell) -> Option<f64> {
        let shown = self.cells.get(&cell)?;
        shown.by.iter().all(|&name| self.is_there[name as usize]).then_some(shown.most)
    }

    /// Stores a bound of the distance of the boundary in a cell from triangles of the mesh.
    pub(super) fn keep_cell(&mut self, cell: Cell, most: f64, mut by: Vec<u32>) -> Result<(), Error> {
        by.iter_mut().for_each(|number| *number = self.of_mesh[*number as usize]);
        self.cells.try_reserve(1)?;
        self.cells.insert(cell, Shown { most, by });
        Ok(())
    }
}
