//! The moments of the region that a mesh encloses, by the divergence theorem.
//!
//! A point belongs to the solid if the winding number w at that point has the property that the fill rule
//! demands. If no two triangles intersect, this property changes in one way across each triangle: from inside
//! to outside, the other way round, or not at all (`sheets`). The integral of a polynomial over the solid is
//! then a sum of integrals over signed tetrahedra. Each triangle at which the property changes is the base of
//! one tetrahedron, and all have a common tip.
//!
//! **Rounding.** A triangle is stored as a corner, relative to the centre of the mesh, and two edges. All are
//! scaled by a power of two, so that coordinates are at most 2 in magnitude and nothing overflows. A term is
//! a polynomial of them. Beside the sum of terms runs the sum of their *sizes*: the same polynomials of
//! magnitudes. A term has a chain of at most 32 roundings, so its error is at most 40 half units of its size.
//! The sums are kept in two doubles. For parts with few and round dimensions, nothing is rounded at all; the
//! sizes show this.
//!
//! **Displacement.** The surface may have been moved by some distance r. The solid changes by at most the
//! volume within r of the surface. This volume is at most the sum over all triangles of 2 A r + π/2 P r² +
//! 4/3 π r³, for an area A and a perimeter P (Steiner's formula). The solid grows by at most the part of this
//! volume that lies outside, and shrinks by at most the part that lies inside. Each part is at most the sum
//! of A r + π/4 P r² + 4/3 π r³: a point whose nearest surface point lies within a triangle lies on one side
//! of it; a point whose nearest surface point lies on an edge lies in the half cylinders of all triangles at
//! that edge, at least two; and at a corner there are at least three.

use super::intersections::{corners, intersections};
use super::sheets::{Sense, sheets};
use super::signs::Point;
use super::tree::{Grid, Search};
use super::triangle_mesh::{FillRule, TriangleMesh};
use crate::control::Control;
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{sqrt, two_sum};
use crate::lattice::{Interval, VolumeMoments};
use core::array::from_fn as array;
use core::f64::consts::FRAC_PI_2;

/// The moments of the region that a mesh encloses, or the reason why they cannot be computed without
/// splitting cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeshMoments {
    /// The moments are known, up to rounding and to the mesh's displacement.
    Known(VolumeMoments),
    /// The mesh is empty, not closed, or not oriented consistently as the fill rule demands.
    /// [`TriangleMesh::check_closed`] reports which.
    Open,
    /// Two triangles intersect, for instance these. [`TriangleMesh::intersecting_pairs`] counts all.
    Intersecting([u32; 2]),
    /// Too many triangles lie close to each other to determine whether any intersect, or all triangles of a
    /// body are slivers.
    Undecided,
}

impl TriangleMesh {
    /// Returns the volume and the moments of the region that the mesh encloses by a fill rule, exact up to
    /// rounding: usually to 14 digits. They are known if the mesh is closed and no two triangles intersect.
    /// Nested bodies, cavities, and inverted bodies count as the rule says.
    ///
    /// If vertices were moved, or a [`deviation`](Self::with_deviation) was stated, the intervals contain the
    /// moments of each solid whose surface lies within that distance ([`displacement`](Self::displacement)).
    ///
    /// O(t log t) time for triangles that lie apart, and the mesh keeps a tree of 36 bytes a triangle. Work
    /// is limited as in [`intersecting_pairs`](Self::intersecting_pairs).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] or [`Error::Cancelled`].
    ///
    /// ```
    /// use leafless::{Control, FillRule, TriangleMesh, mesh::MeshMoments};
    /// let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
    /// let MeshMoments::Known(moments) = mesh.moments(FillRule::NonZero, &Control::default())? else { panic!() };
    /// assert!(moments.volume.contains(1.0 / 6.0) && moments.volume.width() < 1e-14);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn moments(&self, rule: FillRule, control: &Control<'_>) -> Result<MeshMoments, Error> {
        match self.check_closed(rule) {
            Ok(()) => {}
            Err(Error::Mesh(MeshError::Empty | MeshError::Open { .. } | MeshError::Unoriented { .. })) => {
                return Ok(MeshMoments::Open);
            }
            Err(error) => return Err(error),
        }
        let mut pair = [0; 2];
        let search = intersections(self, control, &mut |a, b| {
            pair = [a, b];
            Ok(false)
        })?;
        match search {
            Search::Finished => {}
            Search::Ended => return Ok(MeshMoments::Intersecting(pair)),
            Search::Exhausted => return Ok(MeshMoments::Undecided),
        }
        let sheets = sheets(self, self.tree(control)?, rule, |_| false)?;
        let grid = Grid::around(self.bounds());
        let mut sums = Sums::default();
        for (triangle, &sheet) in (0..).zip(&sheets.of_triangles) {
            match sheets.senses[sheet as usize] {
                Sense::Known(0) | Sense::Flat => {}
                Sense::Known(sense) => {
                    sums.add(&grid.triangle(&corners(self, triangle)), f64::from(sense));
                }
                Sense::Unknown => return Ok(MeshMoments::Undecided),
            }
        }
        Ok(MeshMoments::Known(sums.finish(&grid, grid.bits(self.vertices()), self.tube(&grid))))
    }

    /// Returns the size of the region in which the true surface may lie.
    fn tube(&self, grid: &Grid) -> Tube {
        let mut tube = Tube::default();
        if self.radius() == 0.0 {
            return tube;
        }
        // Covers the rounding of this function.
        const SLACK: f64 = 1.0 + 1e-6;
        // Upper bound of the errors of lengths and areas for coordinates up to 2.
        const ERROR: f64 = 1e-14;
        let r = SLACK * self.radius() * grid.scale();
        for triangle in 0..self.triangles().len() as u32 {
            let [_, u, v] = grid.triangle(&corners(self, triangle));
            let length = |u: Point| sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
            let twice_area =
                length([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]);
            let perimeter = length(u) + length(v) + length(array(|k| v[k] - u[k]));
            let (area, round) = (0.5 * twice_area + ERROR, FRAC_PI_2 * (perimeter + ERROR));
            tube.volume += SLACK * r * (2.0 * area + r * (round + 4.1888 * r));
            tube.on_a_side += SLACK * r * (area + r * (0.5 * round + 4.1888 * r));
        }
        Tube { reach: r, ..tube }
    }
}

/// The region in which the true surface may lie, in units of the grid: upper bounds.
#[derive(Default)]
struct Tube {
    /// Maximum distance from the mesh.
    reach: f64,
    /// The volume within that distance, and the volume of its part outside, or inside, of the surface.
    volume: f64,
    on_a_side: f64,
}

/// Number of moments: volume, first and second moments.
const COUNT: usize = 10;

/// Sums of terms in the units of the grid: 6 times the volume, 24 times the first and 120 times the second
/// moments.
#[derive(Default)]
struct Sums {
    /// The sums, and the parts lost by rounding them.
    values: [f64; COUNT],
    lost: [f64; COUNT],
    sizes: [f64; COUNT],
    terms: f64,
}

impl Sums {
    /// Adds the tetrahedron of a triangle and the grid's centre, `sense` times.
    fn add(&mut self, triangle: &[Point; 3], sense: f64) {
        let values = moments_of(triangle, |x, y| x - y);
        let sizes = moments_of(&triangle.each(|p| p.each(f64::abs)), |x, y| x + y);
        for k in 0..COUNT {
            let (sum, lost) = two_sum(self.values[k], sense * values[k]);
            self.values[k] = sum;
            self.lost[k] += lost;
            self.sizes[k] += sizes[k];
        }
        self.terms += 1.0;
    }

    /// Returns the moments. `bits` is the number of bits of the coordinates behind the point, if they are
    /// exact. Points in `tube` may belong to the solid or not.
    fn finish(&self, grid: &Grid, bits: Option<i32>, tube: Tube) -> VolumeMoments {
        const HALF_UNIT: f64 = f64::EPSILON / 2.0;
        let unit = Interval::exactly(1.0 / grid.scale());
        let of = |k: usize, factor: f64, degree: usize| {
            // The error of the terms, the error of adding up the lost parts, and underflow.
            let of_sums = HALF_UNIT * self.terms;
            let share = 40.0 * HALF_UNIT + of_sums * of_sums;
            // Multiples of a power of two are not rounded if none comes near 2^53 times that power.
            let is_exact = bits.is_some_and(|bits| {
                let grain = f64::from_bits(((1023 - bits * degree as i32) as u64) << 52);
                self.sizes[k] < grain * (1u64 << 51) as f64
            });
            let error = if is_exact { 0.0 } else { 1.0001 * share * self.sizes[k] + 1e-300 * self.terms };
            let sum = Interval::exactly(self.values[k]).plus(Interval::exactly(self.lost[k]));
            let sum = sum.plus(around_zero(error)).over(Interval::exactly(factor));
            // No point of the tube is further away from the centre along an axis.
            let farthest = (1.0 + tube.reach) * (1.0 + 1e-6);
            let in_tube = match degree {
                3 => tube.on_a_side,
                _ => (3..degree).fold(tube.volume, |product, _| product * farthest) * (1.0 + 1e-6),
            };
            let sum = sum.plus(around_zero(in_tube));
            (0..degree).fold(sum, |product, _| product.times(unit))
        };
        let volume = of(0, 6.0, 3);
        VolumeMoments {
            point: grid.centre,
            volume: volume.not_negative(),
            first: [1, 2, 3].each(|k| of(k, 24.0, 4)),
            second: [4, 5, 6, 7, 8, 9].each(|k| of(k, 120.0, 5)),
        }
    }
}

fn around_zero(radius: f64) -> Interval {
    Interval::between(-radius, radius)
}

/// Returns 6 times the volume, 24 times the first and 120 times the second moments of the tetrahedron with
/// the tip 0, in the order of [`VolumeMoments`]; or their sizes, if `minus` adds. The base has the corner `a`
/// and from there the edges `u` and `v`. The edges are short, so the sizes are little more than the
/// magnitudes.
#[inline(always)]
fn moments_of([a, u, v]: &[Point; 3], minus: impl Fn(f64, f64) -> f64) -> [f64; COUNT] {
    let [b, c]: [Point; 2] = [u, v].each(|edge| array(|k| a[k] + edge[k]));
    let minor = |i: usize, j: usize| minus(u[i] * v[j], u[j] * v[i]);
    let six_fold = a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1);
    let [x, y, z] = axes(|k| a[k] + b[k] + c[k]);
    let second =
        |i: usize, j: usize, of_sums: f64| six_fold * (of_sums + (a[i] * a[j] + b[i] * b[j] + c[i] * c[j]));
    [
        six_fold,
        six_fold * x,
        six_fold * y,
        six_fold * z,
        second(0, 0, x * x),
        second(1, 1, y * y),
        second(2, 2, z * z),
        second(0, 1, x * y),
        second(0, 2, x * z),
        second(1, 2, y * z),
    ]
}
