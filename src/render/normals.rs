//! Normals of surfaces that are only known by their cells.
//!
//! Cells of one size say little about a direction: a plane that rises by less than a cell over five cells
//! looks level. So a plane is fitted to the surface around each block of 8³ cells, in a window of 24³ cells,
//! and the planes of the 27 blocks around a point are blended. Where the surface is not plane there, blocks
//! of 4³ in windows of 12³ are used. Where it is not plane there either, near edges and thin walls, the
//! gradient of the occupancy over 5³ cells is used.

use super::occupancy::Occupancy;
use super::place_cache::Places;
use super::plane::{Fitting, Plane};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::lattice::axes;
use crate::lattice::morton;
use crate::octree::view::OctreeRef;
use crate::query::TouchedCell;
use glam::{DVec3, Vec3A, Vec4};

/// Normals of a stored octree. Results are cached, because most samples lie in the block of the previous
/// sample.
pub struct Normals<'a> {
    occupancy: Occupancy<'a>,
    sizes: [Blocks; 2],
}

/// Results for blocks of one size.
struct Blocks {
    planes: Places<Plane>,
    about: Places<About>,
}

/// The planes of the 27 blocks around a point in the middle block.
struct About {
    /// The blocks that have a surface, as bits.
    present: u32,
    /// Normals times their confidences, and the confidences.
    planes: [Vec4; 27],
}

/// The edges of large and of small blocks.
const EDGES: [f64; 2] = [8.0, 4.0];

/// The fitting of planes around large blocks and around small ones. (In small windows, rounding to cells
/// alone makes root mean squares of about 0.3.)
const FITTINGS: [Fitting; 2] = [
    Fitting { full: 128, edge: 4.0, plane: [0.25, 0.45] },
    Fitting { full: 16, edge: 2.0, plane: [0.45, 0.8] },
];

/// The confidences below which planes are ignored.
const LEAST: [f32; 2] = [0.7, 0.3];

impl<'a> Normals<'a> {
    pub fn new(tree: &OctreeRef<'a>) -> Normals<'a> {
        let blocks = || Blocks { planes: Places::new(), about: Places::new() };
        Normals { occupancy: Occupancy::new(tree), sizes: [blocks(), blocks()] }
    }

    /// Returns the outward unit normal at a point of the surface, or zero if nothing is known. The point is
    /// given in cells from the universe's lower corner, and lies in or on the finest cell `at`.
    pub fn at(&mut self, point: DVec3, at: [u32; 3]) -> Result<DVec3, Error> {
        for size in [0, 1] {
            if let Some(normal) = self.blended(size, point)? {
                return Ok(normal);
            }
        }
        self.gradient(at)
    }

    /// The mean of the planes around a point.
    fn blended(&mut self, size: usize, point: DVec3) -> Result<Option<DVec3>, Error> {
        let place = point / EDGES[size];
        let middle = place.floor();
        // Quadratic splines over three blocks along each axis.
        let from = (place - middle).as_vec3a() - 0.5;
        let (low, high) = (0.5 - from, 0.5 + from);
        let weights = [0.5 * low * low, 0.75 - from * from, 0.5 * high * high];
        let block = [middle.x as i32, middle.y as i32, middle.z as i32];
        let blocks = &mut self.sizes[size].about;
        let found = match blocks.find(block) {
            Some(found) => found,
            None => {
                let about = self.about(size, block)?;
                self.sizes[size].about.keep(block, about)?
            }
        };
        let (sum, total) = self.sizes[size].about.item(found).blended(weights);
        let (confidence, sum) = (sum.w, sum.truncate());
        // Planes that disagree have a short sum.
        let is_plane = confidence > LEAST[size] * total && sum.length() > 0.9 * confidence && total > 0.2;
        Ok(is_plane.then(|| sum.as_dvec3().normalize()))
    }

    fn about(&mut self, size: usize, block: [i32; 3]) -> Result<About, Error> {
        let mut about = About { present: 0, planes: [Vec4::ZERO; 27] };
        for (k, found) in (0..).zip(&mut about.planes) {
            let at = [k % 3, k / 3 % 3, k / 9];
            let plane = self.plane(size, axes(|axis| block[axis] + at[axis] - 1))?;
            if plane != Plane::default() {
                about.present |= 1 << k;
                *found = plane.normal.extend(1.0) * plane.confidence;
            }
        }
        Ok(about)
    }

    fn plane(&mut self, size: usize, block: [i32; 3]) -> Result<Plane, Error> {
        let planes = &mut self.sizes[size].planes;
        let found = match planes.find(block) {
            Some(found) => found,
            None => {
                let window = self.occupancy.window(block, size == 0)?;
                planes.keep(block, FITTINGS[size].plane(&window))?
            }
        };
        Ok(*planes.item(found))
    }

    /// The gradient of the occupancy over 5³ cells.
    fn gradient(&mut self, at: [u32; 3]) -> Result<DVec3, Error> {
        let mut sum = DVec3::ZERO;
        let low = at.each(|a| a as i32 - 2);
        let (first, last) = (low.each(|a| a >> 2), low.each(|a| (a + 4) >> 2));
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                for x in first[0]..=last[0] {
                    let word = self.occupancy.word([x, y, z])?;
                    if word.upper == 0 {
                        continue;
                    }
                    let range = |axis: usize, block: i32| {
                        low[axis].max(4 * block)..(low[axis] + 5).min(4 * block + 4)
                    };
                    for k in range(2, z) {
                        for j in range(1, y) {
                            for i in range(0, x) {
                                let c = morton::index(i as u32, j as u32, k as u32);
                                let solid =
                                    f64::from((word.upper >> c & 1) as u32 + (word.full() >> c & 1) as u32);
                                let from = DVec3::from(
                                    [i - low[0] - 2, j - low[1] - 2, k - low[2] - 2].each(f64::from),
                                );
                                sum -= from * (solid * WEIGHTS[from.length_squared() as usize]);
                            }
                        }
                    }
                }
            }
        }
        // Contributions that cancel out have no direction.
        Ok(if sum.length() < LEAST_GRADIENT { DVec3::ZERO } else { sum.normalize() })
    }
}

/// Shorter sums are rounding errors of zero: a single cell makes a sum of at least 0.07.
const LEAST_GRADIENT: f64 = 1e-6;

/// exp(−r² / (2 · 1.5²)) for r² = 0 … 12.
const WEIGHTS: [f64; 13] = [
    1.0, 0.800_737, 0.641_180, 0.513_417, 0.411_112, 0.329_193, 0.263_597, 0.211_072, 0.169_013, 0.135_335,
    0.108_368, 0.086_774, 0.069_483,
];

impl About {
    /// The sum of the planes, weighted by their blocks along each axis, and the sum of the weights of the
    /// blocks that have a plane.
    #[inline]
    fn blended(&self, weights: [Vec3A; 3]) -> (Vec4, f32) {
        let mut of_blocks = [0.0; 27];
        for (k, weight) in of_blocks.iter_mut().enumerate() {
            *weight = weights[k % 3].x * (weights[k / 3 % 3].y * weights[k / 9].z);
        }
        let (mut sum, mut total) = (Vec4::ZERO, 0.0);
        let mut rest = self.present;
        while rest != 0 {
            let k = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            sum += self.planes[k] * of_blocks[k];
            total += of_blocks[k];
        }
        (sum, total)
    }
}

/// The normal at a point of the surface that lies on a cell.
pub fn normal_of_cells(
    normals: &mut Normals<'_>,
    frame: &Frame,
    point: DVec3,
    hit: &TouchedCell,
) -> Result<DVec3, Error> {
    let scaled = DVec3::from(axes(|axis| frame.scaled(axis, point[axis])));
    let shift = frame.depth() - hit.cell.level;
    let at = axes(|axis| {
        let (low, high) = (hit.cell.at[axis] << shift, ((hit.cell.at[axis] + 1) << shift) - 1);
        // (A cast saturates.)
        (scaled[axis] as u32).clamp(low, high)
    });
    let low = DVec3::from(at.each(f64::from));
    normals.at(scaled.clamp(low, low + 1.0), at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;
    use crate::lattice::Frame;
    use crate::octree::{Octree, Tag};
    use crate::op::{Rule, build};
    use crate::solid::Csg;

    /// A block with a dome and a bore: with plane and curved parts, and edges.
    fn part() -> Octree {
        let block = Csg::cuboid([-0.9, -0.9, -0.4], [0.9, 0.9, 0.4]).unwrap();
        let ball = Csg::ball([0.0, 0.0, 0.3], 0.8).unwrap();
        let bore = Csg::cylinder(0.3, -2.0, 2.0).unwrap();
        let solid = Csg::union_of([block, ball]).unwrap().difference(&bore).unwrap();
        let frame = Frame::new([-1.125; 3], 2.25, 7).unwrap();
        build(&solid, &frame, Rule::Certified, &Control::threads(1)).unwrap()
    }

    #[test]
    fn what_was_found_before_changes_nothing() {
        let tree = part();
        let cells = tree.frame().cells();
        let (mut normals, mut seed, mut found) = (Normals::new(tree.view()), 1u64, 0);
        while found < 500 {
            let mut random = || {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (seed >> 40) as f64 / f64::from(1 << 24)
            };
            let point = DVec3::new(random(), random(), random()) * f64::from(cells);
            let at = point.to_array().map(|x| x as u32);
            if tree.view().tag_at(at) != Tag::Partial {
                continue;
            }
            let fresh = Normals::new(tree.view()).at(point, at).unwrap();
            assert_eq!(normals.at(point, at).unwrap(), fresh, "{point}");
            assert!((fresh.length() - 1.0).abs() < 1e-6);
            found += 1;
        }
    }

    #[test]
    fn gradients_are_those_of_all_cells() {
        let tree = part();
        let (outside, cells) = (0.0, tree.frame().cells() as i32);
        let mut normals = Normals::new(tree.view());
        for at in [[0, 0, 0], [12, 12, 40], [64, 64, 104], [51, 77, 41], [115, 20, 41], [127, 3, 64]] {
            let mut sum = DVec3::ZERO;
            for k in 0..125 {
                let from = [k % 5 - 2, k / 5 % 5 - 2, k / 25 - 2];
                let cell = axes(|axis| at[axis] as i32 + from[axis]);
                let is_inside = cell.iter().all(|i| (0..cells).contains(i));
                let solid = match is_inside.then(|| tree.view().tag_at(cell.map(|i| i as u32))) {
                    None => outside,
                    Some(Tag::Full) => 2.0,
                    Some(Tag::Empty) => 0.0,
                    Some(_) => 1.0,
                };
                let from = DVec3::from(from.map(f64::from));
                sum -= from * solid * libm::exp(-from.length_squared() / (2.0 * 1.5 * 1.5));
            }
            let found = normals.gradient(at).unwrap();
            assert!((found - sum.normalize_or_zero()).length() < 1e-5, "{at:?} {found} {sum}");
        }
    }
}
