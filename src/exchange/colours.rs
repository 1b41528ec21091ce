//! Colours of files, collected for an attribute of a mesh.

use crate::lattice::Each;
use alloc::vec::Vec;

use crate::error::Error;
use crate::mesh::MeshAttribute;

/// A table of colours: red, green, blue and alpha, from 0 to 255.
#[derive(Default)]
pub(super) struct Colours {
    values: Vec<f64>,
    /// Number of colours that could not be read.
    pub unreadable: u64,
}

impl Colours {
    /// Adds a colour. If a channel is not a number that rounds to 0 to 255, the element has no colour.
    #[inline]
    pub fn push(&mut self, channels: [f64; 4]) -> Result<(), Error> {
        let is_channel = |channel: &f64| (-0.5..=255.5).contains(channel);
        let colour = if channels.iter().all(is_channel) {
            channels.each(|channel| channel.clamp(0.0, 255.0))
        } else {
            self.unreadable += 1;
            [f64::NAN; 4]
        };
        self.values.try_reserve(4)?;
        self.values.extend(colour);
        Ok(())
    }

    /// Returns the number of colours.
    pub fn len(&self) -> usize {
        self.values.len() / 4
    }

    /// Returns the colours as an attribute of corners.
    pub fn of_corners(self, name: &str, rows: Vec<[u32; 3]>) -> Result<MeshAttribute, Error> {
        MeshAttribute::by_corner(name, 4, self.values, rows)
    }

    /// Returns the colours as an attribute of triangles.
    pub fn of_triangles(self, name: &str, rows: Vec<u32>) -> Result<MeshAttribute, Error> {
        MeshAttribute::by_triangle(name, 4, self.values, rows)
    }
}

/// Fills a list up to a length with a row.
#[inline]
pub(super) fn fill(rows: &mut Vec<u32>, length: usize, row: u32) -> Result<(), Error> {
    rows.try_reserve(length.saturating_sub(rows.len()))?;
    rows.resize(length.max(rows.len()), row);
    Ok(())
}
