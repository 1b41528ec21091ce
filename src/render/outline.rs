//! Edges of surfaces of which lines of sight are all that is known: silhouettes, and creases between faces.
//!
//! A sample lies on a silhouette if a sample near by shows nothing, or something that lies behind. It lies on
//! a crease if the planes of the surface on both sides meet there. The sides are sought beyond what normals
//! are blurred over: where a surface is known by its cells, its normals turn slowly at an edge.

use super::light::Light;
use super::lines::check_width;
use super::tile::Tile;
use super::window::Window;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Frame;
use crate::memory;
use alloc::vec::Vec;
use glam::DVec3;

/// The edges of a surface that are drawn as lines: silhouettes, and creases, at which faces meet.
///
/// Edges are found at the samples of the picture. A round edge counts as a crease if it turns within two
/// pixels, or within six cells where only cells are known. Where these are larger than two pixels, only
/// silhouettes are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline {
    /// In pixels: above 0, at most 8.
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

/// Widest outlines, in pixels.
const WIDEST: f64 = 8.0;

impl Outline {
    /// Refuses what is no outline.
    ///
    /// # Errors
    /// [`Error::Argument`] for a width or an angle out of range.
    pub fn check(&self) -> Result<(), Error> {
        check_width(self.width)?;
        if self.width > WIDEST {
            return Err(Error::Argument {
                name: "width",
                problem: "of the edges of a surface must be at most 8",
            });
        }
        if !(0.0..=180.0).contains(&self.crease) {
            return Err(Error::Argument { name: "crease", problem: "must be 0 to 180 degrees" });
        }
        Ok(())
    }
}

/// From an edge to where its sides are sought, in pixels: at least, and at most.
const REACH: [f64; 2] = [2.0, 12.0];

/// How much of the turn between two sides half as far from the edge must show. Of a round edge it is half.
const SUDDEN: f64 = 0.72;

/// Pixels, or thirds of the blur, by which a surface may step without an edge.
const STEP: f64 = 2.0;

/// What is seen at a sample.
#[derive(Clone, Copy)]
pub struct Point {
    pub place: DVec3,
    /// Outward, of length 1.
    pub normal: DVec3,
    pub depth: f64,
}

/// What is seen at the samples of a tile and about it.
pub struct Field<'v> {
    pub window: Window<'v>,
    points: Vec<Option<Point>>,
    outline: Outline,
    blur: f64,
    /// Offsets to the samples within half the width, columns and rows.
    near: Vec<[i32; 2]>,
}

impl<'v> Field<'v> {
    /// `blur`: the length over which normals turn at an edge.
    pub fn new(tile: &Window<'v>, outline: &Outline, blur: f64, frame: &Frame) -> Result<Field<'v>, Error> {
        let nearest = tile.view.nearest(frame);
        // An eye in the universe may be as near to the surface as can be.
        let is_inside = blur > 0.0 && nearest <= frame.edge() / 16.0;
        let reach =
            if is_inside { REACH[1] } else { (blur / tile.view.pixel_at(nearest)).clamp(REACH[0], REACH[1]) };
        let window = tile.widened(libm::ceil(reach.max(0.5 * outline.width)) as u32);
        let points = memory::filled(window.width() * window.height(), None)?;
        let half = 0.5 * outline.width * f64::from(tile.grid);
        // (At least the samples beside it.)
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

    /// The sample of a tile that is a sample of the field.
    pub fn sample_of_tile(&self, sample: usize, tile: &Window<'_>) -> Option<usize> {
        let [left, top] = self.corner(tile);
        let column =
            (sample % self.window.width()).checked_sub(left).filter(|&column| column < tile.width())?;
        let row = (sample / self.window.width()).checked_sub(top).filter(|&row| row < tile.height())?;
        Some(row * tile.width() + column)
    }

    /// Where the tile's first sample lies in the field.
    fn corner(&self, tile: &Window<'_>) -> [usize; 2] {
        [0, 1].map(|k| ((tile.first[k] - self.window.first[k]) * tile.grid) as usize)
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

    /// By how much a surface may step here.
    fn step(&self, here: &Point) -> f64 {
        STEP * self.window.view.pixel_at(here.depth).max(self.blur / 3.0)
    }

    fn is_silhouette(&self, [column, row]: [i32; 2], here: &Point) -> bool {
        let (wide, high) = (self.window.width() as i32, self.window.height() as i32);
        let step = self.step(here);
        self.near.iter().any(|[x, y]| {
            let at = [column + x, row + y];
            // What lies beyond the picture does not count.
            let is_inside = (0..wide).contains(&at[0]) && (0..high).contains(&at[1]);
            is_inside
                && self.point(at).is_none_or(|there| {
                    there.depth > here.depth + step && (there.place - here.place).dot(here.normal) < -step
                })
        })
    }

    fn is_crease(&self, at: [i32; 2], here: &Point) -> bool {
        let pixel = self.window.view.pixel_at(here.depth);
        // Nearer than that normals only tell of single cells.
        if self.blur > REACH[1] * pixel {
            return false;
        }
        let reach = (self.blur / pixel).max(REACH[0]) * f64::from(self.window.grid);
        [[1.0, 0.0], [0.0, 1.0], [DIAGONAL, DIAGONAL], [DIAGONAL, -DIAGONAL]]
            .iter()
            .any(|direction| self.turns(at, here, direction.map(|along| along * reach)))
    }

    /// Whether the sides on both ends of a line through a sample meet at the sample.
    fn turns(&self, at: [i32; 2], here: &Point, offset: [f64; 2]) -> bool {
        let place = |share: f64| [0, 1].map(|k| at[k] + libm::round(offset[k] * share) as i32);
        let all = [-1.0, -0.5, 0.5, 1.0].map(|share| self.point(place(share)));
        let [Some(first), Some(before), Some(after), Some(last)] = all else { return false };
        let turn = angle(first.normal, last.normal);
        if turn < self.outline.crease.to_radians() || angle(before.normal, after.normal) < SUDDEN * turn {
            return false;
        }
        // Both sides lead here: they are no surfaces one behind the other. (A surface that is seen from its
        // side is long.)
        let (_, along) = self.window.line_at(at);
        let step = self.step(here) / (here.normal.dot(along).abs() / along.length()).max(0.1);
        if [first, last].iter().any(|side| (here.place - side.place).dot(side.normal).abs() > step) {
            return false;
        }
        // By how much one side's plane lies behind the other's at a sample, in what is linear on the picture:
        // depths, or under a perspective one over them.
        let is_perspective = self.window.view.is_perspective();
        let gap = |at: [i32; 2]| {
            let (from, along) = self.window.line_at(at);
            let [a, b] = [first, last].map(|side| {
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

/// In radians.
fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::acos(a.dot(b).clamp(-1.0, 1.0))
}
