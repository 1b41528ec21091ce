//! Edges of surfaces that are only known by lines of sight: silhouettes, and creases between faces.
//!
//! A sample lies on a silhouette if a nearby sample shows nothing, or a surface behind. It lies on a crease
//! if the planes of the surface on both sides meet there. The sides are examined beyond the distance over
//! which normals are blurred, because the normals of a surface that is known by its cells turn slowly at an
//! edge.

use super::light::Light;
use super::lines::check_width;
use super::tile::Tile;
use super::window::Window;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::memory;
use alloc::vec::Vec;
use glam::DVec3;

/// The style of edges that are drawn as lines: silhouettes, and creases, at which faces meet.
///
/// Edges are found at the samples of the picture. A round edge counts as a crease if it turns within two
/// pixels, or within six cells where only cells are known. Where cells are larger than two pixels, only
/// silhouettes are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline {
    /// The width in pixels: above 0, at most 8.
    pub width: f64,
    /// Red, green, blue (sRGB) and opacity.
    pub colour: [u8; 4],
    /// The least angle of a crease in degrees, 0 to 180.
    pub crease: f64,
}

impl Default for Outline {
    /// Dark lines of one and a half pixels, where faces meet at 30 degrees or more.
    fn default() -> Outline {
        Outline { width: 1.5, colour: [30, 30, 30, 255], crease: 30.0 }
    }
}

/// The greatest width of outlines, in pixels.
const WIDEST: f64 = 8.0;

impl Outline {
    /// Refuses an invalid outline.
    ///
    /// # Errors
    /// [`Error::Argument`] for a width or an angle out of range.
    pub fn check(&self) -> Result<(), Error> {
        check_width(self.width)?;
        if self.width > WIDEST {
            return Err(Error::Argument {
                name: "width",
                problem: "must be at most 8 for the edges of a surface",
            });
        }
        if !(0.0..=180.0).contains(&self.crease) {
            return Err(Error::Argument { name: "crease", problem: "must be 0 to 180 degrees" });
        }
        Ok(())
    }
}

/// The least and the greatest distance, in pixels, from an edge to the places where its sides are examined.
const REACH: [f64; 2] = [2.0, 12.0];

/// The part of the turn that two sides at half the distance from the edge must show. For a round edge it is
/// half.
const SUDDEN: f64 = 0.72;

/// The step of a surface that does not count as an edge, in pixels, or in thirds of the blur.
const STEP: f64 = 2.0;

/// The point of the surface at a sample.
#[derive(Clone, Copy)]
pub struct Point {
    pub place: DVec3,
    /// The outward unit normal.
    pub normal: DVec3,
    pub depth: f64,
}

/// The points of the surface at the samples of a tile and around it.
pub struct Field<'v> {
    pub window: Window<'v>,
    points: Vec<Option<Point>>,
    outline: Outline,
    blur: f64,
    /// Offsets to the samples within half the width, as columns and rows.
    near: Vec<[i32; 2]>,
}

impl<'v> Field<'v> {
    /// `blur`: the length over which normals turn at an edge.
    pub fn new(tile: &Window<'v>, outline: &Outline, blur: f64, frame: &Frame) -> Result<Field<'v>, Error> {
        let nearest = tile.view.nearest(frame);
        // An eye in the universe may be arbitrarily near to the surface.
        let is_inside = blur > 0.0 && nearest <= frame.edge() / 16.0;
        let reach =
            if is_inside { REACH[1] } else { (blur / tile.view.pixel_at(nearest)).clamp(REACH[0], REACH[1]) };
        let window = tile.widened(libm::ceil(reach.max(0.5 * outline.width)) as u32);
        let points = memory::filled(window.width() * window.height(), None)?;
        let half = 0.5 * outline.width * f64::from(tile.grid);
        // (At least the adjacent samples.)
        let most = libm::floor(half.max(1.0)) as i32;
        let mut near = memory::with_capacity(((2 * most + 1) * (2 * most + 1)) as usize)?;
        for y in -most..=most {
            for x in -most..=most {
                let square = x * x + y * y;
                if square > 0 && f64::from(square) <= (half * half).max(1.0) {
                    near.push([x, y]);
                }
            }
        }
        Ok(Field { window, points, outline: *outline, blur, near })
    }

    pub fn put(&mut self, sample: usize, point: Point) {
        self.points[sample] = Some(point);
    }

    /// The sample of a tile that corresponds to a sample of the field.
    pub fn sample_of_tile(&self, sample: usize, tile: &Window<'_>) -> Option<usize> {
        let [left, top] = self.corner(tile);
        let column =
            (sample % self.window.width()).checked_sub(left).filter(|&column| column < tile.width())?;
        let row = (sample / self.window.width()).checked_sub(top).filter(|&row| row < tile.height())?;
        Some(row * tile.width() + column)
    }

    /// The place of the tile's first sample in the field.
    fn corner(&self, tile: &Window<'_>) -> [usize; 2] {
        [0, 1].each(|k| ((tile.first[k] - self.window.first[k]) * tile.grid) as usize)
    }

    /// Draws the edges.
    pub fn draw(&self, tile: &mut Tile<'_>, job: &Job<'_>) -> Result<(), Error> {
        let ink = Light::of(self.outline.colour);
        let [left, top] = self.corner(tile);
        for row in 0..tile.height() {
            job.check()?;
            for column in 0..tile.width() {
                let at = [(left + column) as i32, (top + row) as i32];
                let Some(here) = self.point(at) else { continue };
                if self.is_silhouette(at, here) || self.is_crease(at, here) {
                    // In front of the surface.
                    tile.put(row * tile.width() + column, here.depth * (1.0 - 1e-12), ink)?;
                }
            }
        }
        Ok(())
    }

    fn point(&self, [column, row]: [i32; 2]) -> Option<&Point> {
        let (column, row) = (usize::try_from(column).ok()?, usize::try_from(row).ok()?);
        let is_inside = column < self.window.width() && row < self.window.height();
        is_inside.then(|| self.points[row * self.window.width() + column].as_ref())?
    }

    /// The greatest step of the surface here without an edge.
    fn step(&self, here: &Point) -> f64 {
        STEP * self.window.view.pixel_at(here.depth).max(self.blur / 3.0)
    }

    fn is_silhouette(&self, [column, row]: [i32; 2], here: &Point) -> bool {
        let (wide, high) = (self.window.width() as i32, self.window.height() as i32);
        let step = self.step(here);
        self.near.iter().any(|[x, y]| {
            let at = [column + x, row + y];
            // Samples beyond the picture do not count.
            let is_inside = (0..wide).contains(&at[0]) && (0..high).contains(&at[1]);
            is_inside
                && self.point(at).is_none_or(|there| {
                    there.depth > here.depth + step && (there.place - here.place).dot(here.normal) < -step
                })
        })
    }

    fn is_crease(&self, at: [i32; 2], here: &Point) -> bool {
        let pixel = self.window.view.pixel_at(here.depth);
        // At a smaller distance, normals only show single cells.
        if self.blur > REACH[1] * pixel {
            return false;
        }
        let reach = (self.blur / pixel).max(REACH[0]) * f64::from(self.window.grid);
        [[1.0, 0.0], [0.0, 1.0], [DIAGONAL, DIAGONAL], [DIAGONAL, -DIAGONAL]]
            .iter()
            .any(|direction| self.turns(at, here, direction.each(|along| along * reach)))
    }

    /// Returns whether the sides at both ends of a line through a sample meet at the sample.
    fn turns(&self, at: [i32; 2], here: &Point, offset: [f64; 2]) -> bool {
        let place = |share: f64| [0, 1].each(|k| at[k] + libm::round(offset[k] * share) as i32);
        let all = [-1.0, -0.5, 0.5, 1.0].each(|share| self.point(place(share)));
        let [Some(first), Some(before), Some(after), Some(last)] = all else { return false };
        let turn = angle(first.normal, last.normal);
        if turn < self.outline.crease.to_radians() || angle(before.normal, after.normal) < SUDDEN * turn {
            return false;
        }
        // Both sides lead to this sample, so they are not surfaces one behind the other. (A surface that is
        // seen from its side is long.)
        let (_, along) = self.window.line_at(at);
        let step = self.step(here) / (here.normal.dot(along).abs() / along.length()).max(0.1);
        if [first, last].iter().any(|side| (here.place - side.place).dot(side.normal).abs() > step) {
            return false;
        }
        // The distance of one side's plane behind the other's at a sample, in a quantity that is linear on
        // the picture: depth, or one over the depth for a perspective.
        let is_perspective = self.window.view.is_perspective();
        let gap = |at: [i32; 2]| {
            let (from, along) = self.window.line_at(at);
            let [a, b] = [first, last].each(|side| {
                let (height, rise) = (side.normal.dot(side.place - from), side.normal.dot(along));
                if is_perspective { rise / height } else { height / rise }
            });
            a - b
        };
        let (middle, ends) = (gap(at), [gap(place(-1.0)), gap(place(1.0))]);
        let slope = libm::hypot(gap([at[0] + 1, at[1]]) - middle, gap([at[0], at[1] + 1]) - middle);
        let half = 0.5 * self.outline.width * f64::from(self.window.grid);
        ends[0] * ends[1] < 0.0 && middle.abs() <= slope * half.max(0.5)
    }
}

const DIAGONAL: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// The angle in radians.
fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::acos(a.dot(b).clamp(-1.0, 1.0))
}
