//! The colours and attributes of a PLY's elements.

use alloc::vec::Vec;

use crate::error::Error;
use crate::exchange::colours::{self, Colours};
use crate::exchange::declared::Declared;
use crate::memory;
use crate::mesh::MeshAttribute;

/// The colours and attributes of a PLY's elements.
#[derive(Default)]
pub(super) struct Palette<'a> {
    pub vertices: Option<Colours>,
    pub faces: Option<Colours>,
    /// The colour of each triangle, for faces that have colours.
    pub rows: Vec<u32>,
    /// The announced attributes of faces.
    pub declared: Vec<Declared<'a>>,
}

impl Palette<'_> {
    pub fn unreadable(&self) -> u64 {
        [&self.vertices, &self.faces].into_iter().flatten().map(|colours| colours.unreadable).sum()
    }

    /// Returns the attributes of triangles with these vertices.
    pub fn attributes(mut self, triangles: &[[u32; 3]]) -> Result<Vec<MeshAttribute>, Error> {
        let mut attributes = Vec::new();
        let face = if self.vertices.is_some() { "face_colour" } else { "colour" };
        if let Some(colours) = self.vertices {
            memory::push(&mut attributes, colours.of_corners("colour", memory::copied(triangles)?)?)?;
        }
        if let Some(colours) = self.faces {
            colours::fill(&mut self.rows, triangles.len(), MeshAttribute::NO_ROW)?;
            memory::push(&mut attributes, colours.of_triangles(face, self.rows)?)?;
        }
        for attribute in self.declared.into_iter().filter(Declared::is_found) {
            memory::push(&mut attributes, attribute.finish(triangles.len())?)?;
        }
        Ok(attributes)
    }
}
