//! A voxel, drawn along the lines of sight that meet it.

use super::coordinates::{Coordinates, Place};
use super::layer::VolumeLayer;
use super::light_path::LightPath;
use super::sides::reach;
use crate::error::Error;
use crate::lattice::Cell;
use crate::render::clip::Clip;
use crate::render::tile::Tile;
use crate::render::transfer::{Looks, absorbed};
use crate::voxel::VoxelKind;
use core::ops::Range;
use glam::DVec3;

/// The voxels of a layer, ready to be drawn.
pub(super) struct Voxels<'a> {
    pub layer: &'a VolumeLayer<'a>,
    pub coordinates: Coordinates,
    pub clip: &'a Clip,
    looks: Looks,
}

impl<'a> Voxels<'a> {
    pub fn new(layer: &'a VolumeLayer<'a>, clip: &'a Clip) -> Result<Voxels<'a>, Error> {
        let coordinates = Coordinates::new(layer.records.frame());
        Ok(Voxels { layer, coordinates, clip, looks: Looks::new(&layer.transfer)? })
    }

    /// Draws a voxel, by exact paths or as published. Its optical depth is that of its value per `length`.
    /// Returns the number of samples at which nothing beyond the voxel is visible.
    pub fn draw<const EXACT: bool>(
        &self,
        tile: &Tile<'_>,
        place: &Place,
        paths: &mut [LightPath],
        index: usize,
        cell: Cell,
        length: f64,
    ) -> usize {
        let records = &self.layer.records;
        let usual = match records.kind_at(index) {
            VoxelKind::Inside => 1.0,
            VoxelKind::Boundary => 0.5,
            VoxelKind::Outside | VoxelKind::Refined => return 0,
        };
        let weight = self.layer.weights.map_or(usual, |weights| weights[index]);
        let (colour, depth) = self.looks.of(records.numbers_at(index));
        if weight == 0.0 || depth == 0.0 {
            return 0;
        }
        let (centre, half) = self.coordinates.cube(cell);
        // The optical depth of a model unit, or of the voxel.
        let depth = depth * weight / length * if EXACT { 1.0 } else { 2.0 * half };
        if !EXACT && !self.clip.keeps(centre + self.coordinates.origin) {
            return 0;
        }
        let opacity = if EXACT { 0.0 } else { absorbed(depth) };
        let corners = self.coordinates.corners(cell);
        let [columns, rows] = covered(tile, place, centre, half);
        let mut closed = 0;
        for row in rows {
            let first = row * tile.width();
            for path in &mut paths[first + columns.start..first + columns.end] {
                let depths = path.within(corners);
                closed += usize::from(if EXACT {
                    path.cross(depths, colour, depth, &tile.fragments)
                } else {
                    path.enter(depths, colour, opacity, &tile.fragments)
                });
            }
        }
        closed
    }
}

/// The columns and rows of samples that may see a cube.
fn covered(tile: &Tile<'_>, place: &Place, centre: DVec3, half: f64) -> [Range<usize>; 2] {
    /// In pixels: far more than rounding, far less than a sample.
    const SLACK: f64 = 1e-3;
    let from = centre - place.eye;
    let at = DVec3::new(from.dot(place.right), from.dot(place.up), from.dot(place.forward));
    let size = half * DVec3::new(reach(place.right), reach(place.up), reach(place.forward));
    let (near, far) = (at.z - size.z, at.z + size.z);
    if tile.view.is_perspective() && near <= far * 1e-9 {
        return [0..tile.width(), 0..tile.height()];
    }
    let corner = |x: f64, y: f64, z: f64| tile.view.place(DVec3::new(x, y, z));
    let (left, right, bottom, top) = (at.x - size.x, at.x + size.x, at.y - size.y, at.y + size.y);
    let ([x0, y0], [x1, y1]) = (corner(left, top, near), corner(right, bottom, near));
    let ([u0, v0], [u1, v1]) = (corner(left, top, far), corner(right, bottom, far));
    [
        tile.between(0, x0.min(u0) - SLACK, x1.max(u1) + SLACK),
        tile.between(1, y0.min(v0) - SLACK, y1.max(v1) + SLACK),
    ]
}
