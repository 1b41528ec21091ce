//! Plane sections of octrees and other solids in pictures.

use super::camera::View;
use super::clip::holds;
use super::light::Light;
use super::stage::{Colouring, Draw, Painter, Stage};
use super::tile::Tile;
use crate::attribute::Attribute;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::valid::numbers;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::{Cursor, OctreeRef, Tag};
use crate::solid::{Classifier, DynSolid, Worker};
use crate::walk::Trail;
use alloc::boxed::Box;
use alloc::vec::Vec;
use glam::DVec3;

/// The default colours of EMPTY, FULL and PARTIAL cells in a slice: sky blue (hardly visible), blue and
/// orange of the palette that Okabe and Ito designed for colour-blind readers (*Color Universal Design*,
/// 2002).
pub const TAG_COLOURS: [[u8; 4]; 3] = [[86, 180, 233, 40], [0, 114, 178, 255], [230, 159, 0, 255]];

/// The size of a cell in pixels: up to the first number it has no outline, and from the second one on its
/// full outline.
const FADING: [f64; 2] = [2.0, 5.0];

/// A plane through the scene of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlicePlane {
    /// The unit normal.
    normal: DVec3,
    /// Minus n · p of its points p.
    offset: f64,
    /// The axis to which the plane is perpendicular, if there is one, and its coordinate on that axis.
    across: Option<(usize, f64)>,
}

impl SlicePlane {
    /// Creates the plane of the points p with `normal` · p + `offset` = 0 (model units times the normal's
    /// length).
    ///
    /// # Errors
    /// [`Error::Argument`] if a number is not zero and not between 2^-256 and 2^256 in magnitude, or if the
    /// normal is zero.
    pub fn new(normal: [f64; 3], offset: f64) -> Result<SlicePlane, Error> {
        numbers("normal", &normal)?;
        numbers("offset", &[offset])?;
        let vector = DVec3::from(normal);
        let length = vector.length();
        if length == 0.0 {
            return Err(Error::Argument { name: "normal", problem: "must not be zero" });
        }
        let mut others = (0..3).filter(|&axis| normal[axis] != 0.0);
        let across = match (others.next(), others.next()) {
            (Some(axis), None) => Some((axis, -offset / normal[axis])),
            _ => None,
        };
        Ok(SlicePlane { normal: vector / length, offset: offset / length, across })
    }

    /// Creates the plane across an axis (0 to 2 for x, y and z) at a coordinate (model units). If it is a
    /// plane of the lattice, it cuts the cells above it.
    ///
    /// # Errors
    /// [`Error::Argument`] if the axis is invalid, or the coordinate is not zero and not between 2^-256 and
    /// 2^256 in magnitude.
    pub fn across(axis: usize, coordinate: f64) -> Result<SlicePlane, Error> {
        if axis > 2 {
            return Err(Error::Argument { name: "axis", problem: "must be 0, 1 or 2" });
        }
        SlicePlane::new(axes(|k| f64::from(u8::from(k == axis))), -coordinate)
    }

    /// The intersection of a line and the plane: the depth and the point. `None` if there is none in front of
    /// the eye.
    fn meet(&self, from: DVec3, along: DVec3) -> Option<(f64, DVec3)> {
        let depth = -(self.normal.dot(from) + self.offset) / self.normal.dot(along);
        let is_seen = depth > 0.0 && depth.is_finite();
        let mut point = from + along * depth;
        if let Some((axis, coordinate)) = self.across {
            // On a plane of the lattice, rounding would choose between the cells on both sides.
            point[axis] = coordinate;
        }
        is_seen.then_some((depth, point))
    }

    /// The change of each coordinate from a pixel to the next one, in model units.
    fn steps(&self, view: &View, along: DVec3, depth: f64) -> DVec3 {
        let camera = &view.camera;
        let pixel = view.pixel_at(depth);
        let [x, y] = [camera.right(), camera.up()].each(|side| {
            let side = DVec3::from(side);
            side - along * (self.normal.dot(side) / self.normal.dot(along))
        });
        (x * x + y * y).map(libm::sqrt) * pixel
    }
}

/// A layer that shows a plane section of a solid on a frame. Each sample shows the tag of the cell in which
/// the line of sight meets the plane, or the value of an attribute there, and the outlines of the cells that
/// the plane cuts. Nothing is shown outside the universe.
///
/// Drawing an octree takes O(samples), plus O(depth) for each change of the cell; drawing another solid takes
/// as many splits.
pub struct SliceLayer<'a> {
    source: Box<dyn Source + 'a>,
    plane: SlicePlane,
    colours: [[u8; 4]; 3],
    outlines: Option<[u8; 4]>,
    values: Option<(&'a dyn Attribute, Colouring<'a>)>,
}

impl core::fmt::Debug for SliceLayer<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("SliceLayer").field("plane", &self.plane).finish_non_exhaustive()
    }
}

impl<'a> SliceLayer<'a> {
    /// Creates a section of an octree in [`TAG_COLOURS`], with outlines of its cells.
    pub fn new(tree: &OctreeRef<'a>, plane: SlicePlane) -> SliceLayer<'a> {
        SliceLayer::of_source(Box::new(*tree), plane)
    }

    /// Creates a section of a solid on a frame, whose cells are split down to the frame's depth. Otherwise as
    /// [`new`](Self::new).
    pub fn of_solid(solid: &'a dyn DynSolid, frame: &Frame, plane: SlicePlane) -> SliceLayer<'a> {
        SliceLayer::of_source(Box::new(SolidOnFrame { solid, frame: *frame }), plane)
    }

    fn of_source(source: Box<dyn Source + 'a>, plane: SlicePlane) -> SliceLayer<'a> {
        SliceLayer { source, plane, colours: TAG_COLOURS, outlines: Some([40, 40, 40, 255]), values: None }
    }

    /// Sets the colours of EMPTY, FULL and PARTIAL cells: red, green, blue (sRGB) and opacity.
    #[must_use]
    pub fn colours(self, colours: [[u8; 4]; 3]) -> SliceLayer<'a> {
        SliceLayer { colours, ..self }
    }

    /// Sets the colour of outlines, or removes them. The outline of a cell that is only a few pixels large is
    /// fainter, and that of a smaller cell is not drawn.
    #[must_use]
    pub fn outlines(self, colour: Option<[u8; 4]>) -> SliceLayer<'a> {
        SliceLayer { outlines: colour, ..self }
    }

    /// Shows the values of an attribute, for example a channel, where cells are FULL or PARTIAL: `colour`
    /// returns the colour of a value, and of a missing value.
    #[must_use]
    pub fn values(self, attribute: &'a dyn Attribute, colour: Colouring<'a>) -> SliceLayer<'a> {
        SliceLayer { values: Some((attribute, colour)), ..self }
    }
}

/// A source of cells, before it is put on its frame.
trait Source: Sync {
    fn frame(&self) -> &Frame;

    fn ready<'s>(&'s self, control: &Control<'_>) -> Result<Box<dyn Ready + 's>, Error>;
}

/// A source of cells, on its frame.
trait Ready: Sync {
    /// Returns a finder for one thread.
    fn finder<'r>(&'r self, control: &'r Control<'r>) -> Result<Box<dyn Finder + 'r>, Error>;
}

/// A search for cells.
trait Finder {
    /// Returns the unsplit cell that contains a finest cell of the universe, and its tag.
    fn find(&mut self, at: [u32; 3]) -> Result<(Cell, Tag), Error>;
}

impl Source for OctreeRef<'_> {
    fn frame(&self) -> &Frame {
        OctreeRef::frame(self)
    }

    fn ready<'s>(&'s self, _: &Control<'_>) -> Result<Box<dyn Ready + 's>, Error> {
        Ok(Box::new(*self))
    }
}

impl Ready for OctreeRef<'_> {
    fn finder<'r>(&'r self, _: &'r Control<'r>) -> Result<Box<dyn Finder + 'r>, Error> {
        Ok(Box::new(InTree { cursor: Cursor::new(self), depth: OctreeRef::frame(self).depth() }))
    }
}

/// A cursor that moves from a cell to the next one through their common ancestor.
struct InTree<'t> {
    cursor: Cursor<'t>,
    depth: u8,
}

impl Finder for InTree<'_> {
    fn find(&mut self, at: [u32; 3]) -> Result<(Cell, Tag), Error> {
        let finest = Cell { level: self.depth, at };
        while finest.ancestor(self.cursor.cell().level) != self.cursor.cell() {
            self.cursor.ascend();
        }
        while self.cursor.tag() == Tag::Branch && self.cursor.cell().level < self.depth {
            let octant = finest.ancestor(self.cursor.cell().level + 1).octant();
            self.cursor.descend(octant);
        }
        Ok((self.cursor.cell(), self.cursor.tag()))
    }
}

/// A solid and the frame on which it is cut.
struct SolidOnFrame<'a> {
    solid: &'a dyn DynSolid,
    frame: Frame,
}

impl Source for SolidOnFrame<'_> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn ready<'s>(&'s self, control: &Control<'_>) -> Result<Box<dyn Ready + 's>, Error> {
        Ok(Box::new(Classified(self.solid.on(&self.frame, control)?)))
    }
}

struct Classified<C>(C);

impl<C: Classifier> Ready for Classified<C> {
    fn finder<'r>(&'r self, control: &'r Control<'r>) -> Result<Box<dyn Finder + 'r>, Error> {
        let trail = Trail::new(self.0.worker()?)?;
        Ok(Box::new(InSolid { trail, depth: self.0.frame().depth(), control }))
    }
}

/// The splits on the path to the last cell.
struct InSolid<'r, W: Worker> {
    trail: Trail<W>,
    depth: u8,
    control: &'r Control<'r>,
}

impl<W: Worker> Finder for InSolid<'_, W> {
    fn find(&mut self, at: [u32; 3]) -> Result<(Cell, Tag), Error> {
        let finest = Cell { level: self.depth, at };
        self.trail.follow(finest.parent(), self.control)?;
        Ok((finest.ancestor(self.trail.level()), self.trail.verdict(finest).tag()))
    }
}

impl Draw for SliceLayer<'_> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        let ready = self.source.ready(stage.job.control())?;
        let colours = self.colours.each(Light::of);
        let outlines = self.outlines.map(Light::of);
        Ok(Box::new(Slice { layer: self, stage: *stage, ready, colours, outlines }))
    }
}

/// A slice that is ready to be drawn.
struct Slice<'a> {
    layer: &'a SliceLayer<'a>,
    stage: Stage<'a>,
    ready: Box<dyn Ready + 'a>,
    colours: [Light; 3],
    outlines: Option<Light>,
}

/// A sample that shows the plane.
struct Met {
    sample: usize,
    depth: f64,
    /// The part of the sample that the outline of its cell covers.
    outline: f32,
    /// The light; `None` if an attribute determines it.
    light: Option<Light>,
}

impl Painter for Slice<'_> {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let control = self.stage.job.control();
        let mut finder = None;
        let mut row_met: Vec<Met> = memory::with_capacity(tile.width())?;
        let (mut points, mut values) = (Vec::new(), Vec::new());
        let mut last = None;
        for row in 0..tile.height() {
            self.stage.job.check()?;
            row_met.clear();
            points.clear();
            for column in 0..tile.width() {
                let (from, along) = tile.line(column, row);
                let sample = row * tile.width() + column;
                let Some((depth, point)) = self.layer.plane.meet(from, along) else { continue };
                let Some(at) = self.layer.source.frame().cell_of(point.to_array()) else { continue };
                if depth >= tile.opaque[sample].depth || !self.shows(from, along, depth) {
                    continue;
                }
                let (cell, tag) = match last {
                    Some((finest, found)) if finest == at => found,
                    _ => {
                        if finder.is_none() {
                            finder = Some(self.ready.finder(control)?);
                        }
                        let Some(finder) = &mut finder else { continue };
                        finder.find(at)?
                    }
                };
                last = Some((at, (cell, tag)));
                let light = match tag {
                    Tag::Empty => Some(self.colours[0]),
                    _ if self.layer.values.is_some() => None,
                    Tag::Full => Some(self.colours[1]),
                    Tag::Partial | Tag::Branch => Some(self.colours[2]),
                };
                if light.is_none() {
                    memory::push(&mut points, point.to_array())?;
                }
                let outline = match self.outlines {
                    Some(_) => self.outline(along, depth, point, cell),
                    None => 0.0,
                };
                memory::push(&mut row_met, Met { sample, depth, outline, light })?;
            }
            values.clear();
            values.try_reserve(points.len())?;
            values.resize(points.len(), None);
            if let Some((attribute, _)) = self.layer.values
                && !points.is_empty()
            {
                attribute.values(&points, &mut values)?;
            }
            let mut values = values.iter();
            for met in &row_met {
                let light = met.light.unwrap_or_else(|| {
                    let value = values.next().copied().flatten();
                    self.layer.values.map_or(Light::NONE, |(_, colour)| Light::of(colour(value)))
                });
                let outline = self.outlines.unwrap_or(Light::NONE);
                let light = light * (1.0 - met.outline) + outline.over(light) * met.outline;
                if light.0.w > 0.0 {
                    tile.put(met.sample, met.depth, light)?;
                }
            }
        }
        Ok(())
    }
}

impl Slice<'_> {
    fn shows(&self, from: DVec3, along: DVec3, depth: f64) -> bool {
        let clip = self.stage.clip;
        clip.is_empty() || clip.shown(from, along).is_some_and(|shown| holds([shown.from, shown.to], depth))
    }

    /// The part of a sample at a point that the outline of a cell covers: all of it if the outline is less
    /// than half a pixel away, so that the outlines of two neighbours together are a pixel wide.
    fn outline(&self, along: DVec3, depth: f64, point: DVec3, cell: Cell) -> f32 {
        let frame = self.layer.source.frame();
        let steps = self.layer.plane.steps(self.stage.view, along, depth);
        let greatest = steps.max_element();
        let shift = frame.depth() - cell.level;
        let side = f64::from(1_u32 << shift);
        // In pixels.
        let (mut away, mut size) = (f64::INFINITY, f64::INFINITY);
        for axis in 0..3 {
            // Along a face that lies in the plane, no pixel leads away from the face.
            if steps[axis] <= 1e-9 * greatest {
                continue;
            }
            let step = frame.scaled_length(steps[axis]);
            let from = frame.scaled(axis, point[axis]) - f64::from(cell.at[axis]) * side;
            away = away.min(from.min(side - from) / step);
            size = size.min(side / step);
        }
        if away > 0.5 {
            return 0.0;
        }
        ((size - FADING[0]) / (FADING[1] - FADING[0])).clamp(0.0, 1.0) as f32
    }
}
