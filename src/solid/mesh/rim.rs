//! Winding numbers of caps, from the rim alone.
//!
//! The winding numbers of all surfaces over the same loops differ by integers only. For cones from a point at
//! infinity, the winding number is a sum over the loops' edges that is smooth near the caps, too. The sum has
//! rounding errors only, so that it locates the place where a winding number passes one half, however slowly
//! the number changes.

use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::memory;
use alloc::vec::Vec;
use core::f64::consts::PI;
use glam::DVec3;

/// The directions of the cones' apexes: directions that hardly any model contains. The others serve points
/// that an edge hides from the first.
pub(super) const DIRECTIONS: [DVec3; 3] = [
    DVec3::new(0.267_261_241_912_424_4, 0.534_522_483_824_848_8, 0.801_783_725_737_273_2),
    DVec3::new(-0.811_107_105_653_812_7, 0.324_442_842_261_525_1, 0.486_664_263_392_287_6),
    DVec3::new(0.455_842_305_838_551_8, -0.569_802_882_298_189_7, -0.683_763_458_757_827_6),
];

/// A cone of smaller modulus than this belongs to a point that an edge hides.
const HIDDEN: f64 = 1e-6;

/// The edges of a surface's boundary, reversed, in the orientation that its caps have.
#[derive(Default)]
pub(super) struct Rim {
    edges: Vec<[DVec3; 2]>,
    /// One ball for each closed loop.
    loops: Vec<Patch>,
    /// A bound of the error of a vertex's position along each axis.
    pub(super) vertex_error: f64,
}

/// A ball around a loop. It contains a cap: cones from the middle over the edges.
struct Patch {
    middle: DVec3,
    radius: f64,
    /// The loop's edges are `first..end`.
    first: usize,
    end: usize,
    /// The cap's area is at most the loop's length times half the radius. This is that bound over 4π.
    area: f64,
}

impl Patch {
    /// A bound of the cap's winding number at this distance from the ball's middle, and at any greater
    /// distance.
    #[inline(always)]
    fn most(&self, distance: f64) -> f64 {
        let gap = distance - self.radius;
        // (False for NaN, too.)
        let is_clear = gap > 0.0;
        if is_clear { self.area / (gap * gap) } else { f64::INFINITY }
    }
}

/// A half-line, or its whole line.
pub(super) struct Course {
    from: DVec3,
    way: DVec3,
    is_line: bool,
}

impl Course {
    pub(super) fn new(from: DVec3, way: DVec3, is_line: bool) -> Course {
        Course { from, way: way / sqrt(way.length_squared()), is_line }
    }

    /// A lower bound of the distance of a point from the course.
    #[inline(always)]
    fn gap(&self, point: DVec3) -> f64 {
        let to = point - self.from;
        let along = to.dot(self.way);
        let along = if self.is_line { along } else { along.max(0.0) };
        sqrt((to - along * self.way).length_squared()) - 1e-12 * to.abs().element_sum()
    }
}

/// A margin for rounding in lengths.
const SLACK: f64 = 1.0 + 1e-9;

/// The distance of the origin from an edge whose ends are given relative to it.
#[inline(always)]
fn distance([from, to]: [DVec3; 2]) -> f64 {
    let edge = to - from;
    let along = -from.dot(edge) / edge.length_squared();
    let along = if along.is_nan() { 0.0 } else { along.clamp(0.0, 1.0) };
    sqrt((from + along * edge).length_squared())
}

/// A winding number modulo 1, with a bound of its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fraction {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// Half a solid angle as a complex number of modulus 1, and a bound of its error.
struct Cone {
    real: f64,
    imaginary: f64,
    error: f64,
}

/// Bounds of the change of the caps' winding number around a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slope {
    /// The distance to the rim.
    pub(super) distance: f64,
    /// The greatest magnitude of the gradient within half that distance.
    pub(super) most: f64,
}

impl Rim {
    pub(super) fn bytes(&self) -> usize {
        memory::bytes_of(&self.edges) + memory::bytes_of(&self.loops)
    }

    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn push(&mut self, edge: [DVec3; 2]) -> Result<(), Error> {
        memory::push(&mut self.edges, edge)
    }

    /// Closes a loop that consists of all edges from `first` on.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn close(&mut self, first: usize) -> Result<(), Error> {
        let edges = &self.edges[first..];
        let corners = || edges.iter().map(|edge| edge[0]);
        let (low, high) = corners()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let middle = 0.5 * low + 0.5 * high;
        let far = |p: DVec3| sqrt((p - middle).length_squared());
        let radius = corners().map(far).fold(0.0, f64::max) * SLACK + 2.0 * self.vertex_error;
        let length = |edge: &[DVec3; 2]| sqrt((edge[1] - edge[0]).length_squared()) + 4.0 * self.vertex_error;
        let area = edges.iter().map(length).sum::<f64>() * SLACK * radius / (8.0 * PI);
        let end = self.edges.len();
        memory::push(&mut self.loops, Patch { middle, radius, first, end, area })
    }

    /// Returns a bound of the winding number of caps that lie in balls around their loops, for a place whose
    /// least distance to a ball's middle is given by `gap`. Infinite if the place may meet one of the balls.
    /// O(n) in the loops.
    fn most(&self, gap: impl Fn(DVec3) -> f64) -> f64 {
        let most = self.loops.iter().map(|patch| patch.most(gap(patch.middle))).sum::<f64>();
        if most.is_nan() { f64::INFINITY } else { most * SLACK }
    }

    /// Returns the bound of [`most`](Self::most) on a half-line, or on its whole line. If the bound is
    /// finite, the half-line meets none of these caps, so that the winding number of cones back along the
    /// line is the caps' number.
    pub(super) fn most_along(&self, course: &Course) -> f64 {
        self.most(|middle| course.gap(middle))
    }

    /// Calls `visit` with the edges of each loop whose bound is at least `least`. Returns the bound of the
    /// other loops.
    pub(super) fn near_loops<'r>(
        &'r self,
        course: &Course,
        least: f64,
        mut visit: impl FnMut(&'r [[DVec3; 2]]),
    ) -> f64 {
        let mut most = 0.0;
        for patch in &self.loops {
            let here = patch.most(course.gap(patch.middle));
            if here < least {
                most += here;
            } else {
                visit(&self.edges[patch.first..patch.end]);
            }
        }
        most * SLACK
    }

    /// Returns the bound of [`most`](Self::most) in a ball.
    pub(super) fn most_within(&self, point: [f64; 3], radius: f64) -> f64 {
        self.most(|middle| {
            let to = middle - DVec3::from(point);
            sqrt(to.length_squared()) - radius * SLACK - 1e-12 * to.abs().element_sum()
        })
    }

    /// Returns the caps' winding number modulo 1 at a point (in finest cells from the frame's origin). `None`
    /// on the rim itself. O(n) in the edges.
    pub(super) fn fraction(&self, point: [f64; 3]) -> Option<Fraction> {
        let point = DVec3::from(point);
        DIRECTIONS.into_iter().find_map(|towards| self.fraction_of_cones(point, towards))
    }

    /// Computes the fraction with cones from one direction: the product of their complex numbers has the sum
    /// of their angles as its argument.
    fn fraction_of_cones(&self, point: DVec3, towards: DVec3) -> Option<Fraction> {
        let (mut real, mut imaginary, mut error) = (1.0f64, 0.0f64, 0.0);
        for &[from, to] in &self.edges {
            let cone = self.cone([from - point, to - point], towards)?;
            error += cone.error;
            (real, imaginary) = (
                real * cone.real - imaginary * cone.imaginary,
                real * cone.imaginary + imaginary * cone.real,
            );
        }
        Some(Fraction { value: libm::atan2(imaginary, real) / (2.0 * PI), error: error + 4.0 * f64::EPSILON })
    }

    /// Returns the full winding number, integers included, of the cones from one of the [`DIRECTIONS`] at a
    /// point. The surface's own number is the integer count of triangles on the way to the opposite side,
    /// minus this number. `None` if the point may lie on a cone or on the rim. O(n) in the edges.
    pub(super) fn of_cones(&self, point: DVec3, towards: DVec3) -> Option<Fraction> {
        let (mut real, mut imaginary, mut error, mut turns) = (1.0f64, 0.0f64, 0.0, 0.0);
        for &[from, to] in &self.edges {
            let cone = self.cone([from - point, to - point], towards)?;
            // Beside a cone, its angle is nearly half a turn to one side or to the other.
            if cone.real < 0.0 && cone.imaginary.abs() <= 4.0 * cone.error {
                return None;
            }
            error += cone.error;
            let was_up = (imaginary >= 0.0, imaginary <= 0.0);
            (real, imaginary) = (
                real * cone.real - imaginary * cone.imaginary,
                real * cone.imaginary + imaginary * cone.real,
            );
            // Adding an angle of less than half a turn: a change of sign shows that the sum has passed half a
            // turn.
            if cone.imaginary > 0.0 && was_up.0 && imaginary < 0.0 {
                turns += 1.0;
            } else if cone.imaginary < 0.0 && was_up.1 && imaginary > 0.0 {
                turns -= 1.0;
            }
        }
        let value = libm::atan2(imaginary, real) / (2.0 * PI) + turns;
        Some(Fraction { value, error: error + 4.0 * f64::EPSILON * (1.0 + turns.abs()) })
    }

    /// Half the solid angle of an edge's triangle with its third corner at infinity, as a complex number of
    /// modulus 1 (van Oosterom and Strackee 1983). `None` if the edge hides the point.
    #[inline(always)]
    fn cone(&self, [a, b]: [DVec3; 2], towards: DVec3) -> Option<Cone> {
        let (far, farther) = (sqrt(a.length_squared()), sqrt(b.length_squared()));
        // Multiplied by the product of both distances, so that one division suffices.
        let (x, y) = (
            far * farther + a.dot(b) + b.dot(towards) * far + a.dot(towards) * farther,
            towards.dot(a.cross(b)),
        );
        let size = sqrt(x * x + y * y);
        // This is false for NaN, too.
        let is_seen = size > HIDDEN * (far * farther);
        let inverse = 1.0 / size;
        // The same bound as for a cap (`Angle::undivided`) with two corners at these distances.
        let wrong = 64.0 * f64::EPSILON * (far * farther) + 8.0 * self.vertex_error * (far + farther);
        is_seen.then_some(Cone { real: x * inverse, imaginary: y * inverse, error: wrong * inverse })
    }

    /// Returns the distance to the rim, and a bound of the gradient: the gradient is the magnetic field of a
    /// current along the rim. O(n) in the edges.
    pub(super) fn slope(&self, point: [f64; 3]) -> Slope {
        let point = DVec3::from(point);
        let (mut least, mut most) = (f64::INFINITY, 0.0);
        for &[from, to] in &self.edges {
            let distance = distance([from - point, to - point]);
            least = distance.min(least);
            // ∫ ds / distance², at half the distance, is at most the integral along the edge's whole line.
            let inverse = 2.0 / distance;
            most += (sqrt((to - from).length_squared()) * inverse).min(PI) * inverse;
        }
        Slope { distance: least, most: most / (4.0 * PI) }
    }

    /// Returns by how much the caps' winding number may change within `radius` of a point, jumps on caps
    /// excluded. Infinite if the rim may be as near. O(n) in the edges.
    pub(super) fn change_within(&self, point: [f64; 3], radius: f64) -> f64 {
        let point = DVec3::from(point);
        let reach = radius * SLACK + 2.0 * self.vertex_error;
        let mut most = 0.0;
        for &[from, to] in &self.edges {
            let ends = [from - point, to - point];
            let nearest = distance(ends) - reach - 1e-12 * (ends[0].abs() + ends[1].abs()).element_sum();
            if nearest <= 0.0 {
                return f64::INFINITY;
            }
            // ∫ ds / distance² along the edge.
            let length = sqrt((to - from).length_squared()) + 4.0 * self.vertex_error;
            most += (length / nearest).min(PI) / nearest;
        }
        let most = most * radius * SLACK / (4.0 * PI);
        if most.is_nan() { f64::INFINITY } else { most }
    }

    /// Returns the gradient of the caps' winding number, with rounding errors: the magnetic field of a
    /// current along the rim. O(n) in the edges.
    pub(super) fn gradient(&self, point: [f64; 3]) -> DVec3 {
        let point = DVec3::from(point);
        let mut sum = DVec3::ZERO;
        for &[from, to] in &self.edges {
            let (a, b) = (from - point, to - point);
            let (far, farther) = (sqrt(a.length_squared()), sqrt(b.length_squared()));
            let field = a.cross(b) * ((1.0 / far + 1.0 / farther) / (far * farther + a.dot(b)));
            // (On an edge itself its field is undefined. Where loops run to and fro, the other edges give the
            // field.)
            if field.is_finite() {
                sum += field;
            }
        }
        if sum.is_finite() { sum / (4.0 * PI) } else { DVec3::ZERO }
    }

    /// The edges, each from its start to its end.
    pub(super) fn edges(&self) -> &[[DVec3; 2]] {
        &self.edges
    }
}
