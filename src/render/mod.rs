//! Pictures of solids, meshes and volumes.
//!
//! A picture consists of [layers](Layer), each of which draws into small tiles. Surfaces hide each other by
//! their depth, and volumes are visible before, between and behind them. Tiles are independent of each other,
//! so a picture is the same for any number of threads. With the feature `png`, `write_png` returns the PNG
//! file of a picture.

mod bins;
mod camera;
mod cast;
mod clip;
mod clipped;
mod coverage;
mod crease;
mod facets;
mod kept;
mod legend;
mod light;
mod lines;
mod mapped;
mod mesh;
mod normals;
mod occupancy;
mod octree;
mod outline;
mod picture;
mod place_cache;
mod plane;
#[cfg(feature = "png")]
mod png;
mod sight;
mod slice;
mod solid;
mod stage;
mod stroke;
mod surface;
mod tile;
mod told;
mod transfer;
mod volume;
mod window;

pub use camera::{Camera, FIELD_OF_VIEW, Lens};
pub use clip::Clip;
pub use clipped::ClippedLayer;
pub use legend::{LegendBox, LegendSide, draw_colour_bar, draw_names, draw_scale_bar};
pub use light::{Light, Tones};
pub use lines::LinesLayer;
pub use mesh::{MeshEdges, MeshLayer};
pub use octree::OctreeLayer;
pub use outline::Outline;
pub use picture::Picture;
#[cfg(feature = "png")]
pub use png::write_png;
pub use sight::Finish;
pub use slice::{SliceLayer, SlicePlane, TAG_COLOURS};
pub use solid::SolidLayer;
pub use stage::Layer;
pub use transfer::{ColourMap, Transfer};
pub use volume::{Compositing, VolumeLayer};

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::memory;
use crate::parallel::each;
use camera::View;

use picture::check_size;
use stage::{Pass, Stage};
use tile::{TILE, Tile};

/// The greatest number of samples of a pixel along each axis.
const MOST_GRID: u32 = 8;

/// The settings of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// The camera.
    pub camera: Camera,
    /// Width and height in pixels, 1 to 16384 each.
    pub size: [u32; 2],
    /// Samples per pixel: 1, 4, 9, 16, 25, 36, 49 or 64, on a grid.
    pub samples: u32,
    /// The clip planes.
    pub clip: Clip,
    /// The background: red, green, blue (sRGB) and opacity.
    pub background: [u8; 4],
}

impl Shot {
    /// Creates the settings of a picture of this size with four samples per pixel, without clip planes, on
    /// white.
    pub fn new(camera: Camera, size: [u32; 2]) -> Shot {
        Shot { camera, size, samples: 4, clip: Clip::new(), background: [255; 4] }
    }

    /// Returns the line of sight of a place in the picture, in pixels from its upper left corner (the middle
    /// of the first pixel is ½, ½): its start and its direction. The point that is visible there at the depth
    /// d is start + d · direction.
    ///
    /// ```
    /// use leafless::render::{Camera, Lens, Shot};
    /// let camera = Camera::new([0.0, -5.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0], Lens::Parallel(2.0))?;
    /// let (from, direction) = Shot::new(camera, [200, 100]).line_of_sight([150.0, 0.0]);
    /// assert_eq!((from, direction), ([1.0, -5.0, 1.0], [0.0, 1.0, 0.0]));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn line_of_sight(&self, [x, y]: [f64; 2]) -> ([f64; 3], [f64; 3]) {
        let (from, direction) = View::new(&self.camera, self.size).line(x, y);
        (from.to_array(), direction.to_array())
    }

    fn grid(&self) -> Result<u32, Error> {
        let grid = (1..=MOST_GRID).find(|grid| grid * grid == self.samples);
        grid.ok_or(Error::Argument { name: "samples", problem: "must be 1, 4, 9, 16, 25, 36, 49 or 64" })
    }
}

/// Draws a picture of layers. Surfaces hide the surfaces behind them, whichever layer they belong to. At
/// equal depth the surface of the first layer is visible. O(pixels · samples), plus the cost of each layer.
///
/// # Errors
/// [`Error::Argument`] for an invalid size or number of samples; the errors of the layers;
/// [`Error::OutOfMemory`], [`Error::Cancelled`].
pub fn render(shot: &Shot, layers: &[&dyn Layer], control: &Control<'_>) -> Result<Picture, Error> {
    let grid = shot.grid()?;
    let [width, height] = shot.size;
    check_size(shot.size)?;
    let job = &Job::new(control);
    job.check()?;
    let count = width as usize * height as usize;
    let (mut colours, mut depths) = (memory::filled(count, [0; 4])?, memory::filled(count, f32::INFINITY)?);
    let view = &View::new(&shot.camera, shot.size);
    let stage = Stage { view, clip: &shot.clip, job };
    let mut painters = memory::with_capacity(layers.len())?;
    for layer in layers {
        painters.push(layer.prepare(&stage)?);
    }
    let columns = width.div_ceil(TILE);
    let tiles = columns * height.div_ceil(TILE);
    let (background, tones) = (Light::of(shot.background), Tones::new());
    let one = |i: u32| {
        job.check()?;
        let first = [i % columns * TILE, i / columns * TILE];
        let size = [TILE.min(width - first[0]), TILE.min(height - first[1])];
        let mut tile = Tile::new(view, first, size, grid)?;
        for painter in painters.iter().filter(|painter| painter.pass() == Pass::Surfaces) {
            painter.paint(&mut tile)?;
        }
        tile.sort();
        for painter in painters.iter().filter(|painter| painter.pass() == Pass::Volumes) {
            painter.paint(&mut tile)?;
        }
        let mut pixels = memory::with_capacity((size[0] * size[1]) as usize)?;
        tile.resolve(background, |light, depth| pixels.push((tones.rgba(light), depth as f32)));
        job.advance(WHOLE / tiles as usize);
        Ok((first, size, pixels))
    };
    let done = control.run(tiles > 1, |parallel| each(parallel, 0..tiles, one))?;
    for (first, size, pixels) in done {
        for (row, pixels) in (first[1]..).zip(pixels.chunks_exact(size[0] as usize)) {
            let start = row as usize * width as usize + first[0] as usize;
            for (i, &(colour, depth)) in (start..).zip(pixels) {
                (colours[i], depths[i]) = (colour, depth);
            }
        }
    }
    Ok(Picture { width, height, colours, depths })
}
