//! The zones in which a lazy octree is refined.

use crate::error::Error;
use crate::lattice::{Cube, Frame, Window, valid};

/// A part of model space in which cells are to be refined. Anything outside the universe is ignored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Zone {
    /// The whole universe.
    Whole,
    /// The cells whose interiors meet a box (model units, min ≤ max). For a box without thickness: the cells
    /// that contain it.
    Box {
        /// Lower corner.
        min: [f64; 3],
        /// Upper corner.
        max: [f64; 3],
    },
    /// The cells that contain a point (model units), by the rule of point queries: a point between two cells
    /// lies in the upper one.
    Point([f64; 3]),
    /// All cells that the points origin + t·direction with from ≤ t ≤ to touch, even at a corner only, and
    /// perhaps some cells that they narrowly miss.
    Ray {
        /// A point of the ray (model units); each coordinate zero or of a magnitude between 2^-256 and 2^256.
        origin: [f64; 3],
        /// Its direction, of any length but zero; the coordinates have the same range as those of the origin.
        direction: [f64; 3],
        /// The parameter of its first point; any number, also −∞.
        from: f64,
        /// The parameter of its last point, not below `from`; any number, also ∞.
        to: f64,
    },
}

/// A zone on the lattice of a frame.
pub(crate) struct Reach {
    window: Window,
    ray: Option<Ray>,
}

struct Ray {
    origin: [f64; 3],
    direction: [f64; 3],
    from: f64,
    to: f64,
}

impl Reach {
    /// Returns the cells of `zone`, or `None` if there are none.
    ///
    /// # Errors
    /// [`Error::Argument`] if a number of the zone is out of range.
    pub(crate) fn new(frame: &Frame, zone: &Zone) -> Result<Option<Reach>, Error> {
        let whole = Window { first: [0; 3], last: [frame.cells() - 1; 3] };
        let without_ray = |window| Reach { window, ray: None };
        Ok(match *zone {
            Zone::Whole => Some(without_ray(whole)),
            Zone::Box { min, max } => Window::new(frame, min, max)?.map(|(window, _)| without_ray(window)),
            Zone::Point(point) => frame.cell_of(point).map(|at| without_ray(Window { first: at, last: at })),
            Zone::Ray { origin, direction, from, to } => {
                let ray = Ray::new(origin, direction, from, to)?;
                Some(Reach { window: whole, ray: Some(ray) })
            }
        })
    }

    /// Returns whether the zone has a cell in common with `cube`.
    #[inline]
    pub(crate) fn meets(&self, cube: &Cube<'_>) -> bool {
        self.window.meets(cube) && self.ray.as_ref().is_none_or(|ray| ray.meets(cube))
    }

    /// The mask (exclusive or) that turns octant numbers into the order of the zone: along a ray from its
    /// beginning.
    pub(crate) fn order(&self) -> Option<u8> {
        let ray = self.ray.as_ref()?;
        Some((0..3).fold(0, |order, axis| order | ((ray.direction[axis] < 0.0) as u8) << axis))
    }
}

impl Ray {
    fn new(origin: [f64; 3], direction: [f64; 3], from: f64, to: f64) -> Result<Ray, Error> {
        let refuse = |name, problem| Err(Error::Argument { name, problem });
        valid::numbers("origin", &origin)?;
        valid::numbers("direction", &direction)?;
        if direction == [0.0; 3] {
            return refuse("direction", "must not be zero");
        }
        if from.is_nan() || to.is_nan() || from > to {
            return refuse("to", "must be a number not below from");
        }
        Ok(Ray { origin, direction, from, to })
    }

    /// Returns whether the ray touches a cube, from the intervals of t in which the ray is between the cube's
    /// planes (Kay and Kajiya, *Ray tracing complex scenes*, 1986), with every number rounded outward.
    fn meets(&self, cube: &Cube<'_>) -> bool {
        let (min, max) = cube.bounds();
        let (mut enters, mut leaves) = (self.from, self.to);
        for axis in 0..3 {
            let (origin, direction) = (self.origin[axis], self.direction[axis]);
            if direction == 0.0 {
                if origin < min[axis] || max[axis] < origin {
                    return false;
                }
                continue;
            }
            let (near, far) = (min[axis] - origin, max[axis] - origin);
            // In the negative direction, the upper plane comes first.
            let (near, far) = if direction > 0.0 {
                (near.next_down(), far.next_up())
            } else {
                (far.next_up(), near.next_down())
            };
            enters = enters.max((near / direction).next_down());
            leaves = leaves.min((far / direction).next_up());
        }
        enters <= leaves
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Cell;

    fn reach(zone: Zone) -> Option<Reach> {
        // Neither the cell size nor most of the planes are representable.
        Reach::new(&Frame::new([0.1, -7.3, 1.0 / 3.0], 10.0 / 3.0, 4).unwrap(), &zone).unwrap()
    }

    #[test]
    fn what_is_refused() {
        let frame = Frame::new([0.0; 3], 1.0, 4).unwrap();
        let ray = |origin, direction, from, to| Zone::Ray { origin, direction, from, to };
        let nan = f64::NAN;
        for zone in [
            Zone::Box { min: [0.0, 1.0, 0.0], max: [1.0, 0.5, 1.0] },
            Zone::Box { min: [0.0, nan, 0.0], max: [1.0; 3] },
            ray([nan, 0.0, 0.0], [1.0; 3], 0.0, 1.0),
            ray([0.0; 3], [0.0, -0.0, 0.0], 0.0, 1.0),
            ray([0.0; 3], [1.0, f64::INFINITY, 0.0], 0.0, 1.0),
            ray([0.0; 3], [1.0, 1e-200, 0.0], 0.0, 1.0),
            ray([1e200, 0.0, 0.0], [1.0; 3], 0.0, 1.0),
            ray([0.0; 3], [1.0; 3], 1.0, 0.5),
            ray([0.0; 3], [1.0; 3], nan, 0.5),
            ray([0.0; 3], [1.0; 3], 0.0, nan),
        ] {
            assert!(matches!(Reach::new(&frame, &zone), Err(Error::Argument { .. })), "{zone:?}");
        }
    }

    #[test]
    fn what_lies_outside_has_no_cell() {
        assert!(reach(Zone::Point([0.0; 3])).is_none());
        assert!(reach(Zone::Point([f64::NAN; 3])).is_none());
        assert!(reach(Zone::Box { min: [-1.0, -7.0, 1.0], max: [0.1, -6.0, 2.0] }).is_none());
        assert!(reach(Zone::Box { min: [f64::NEG_INFINITY; 3], max: [f64::INFINITY; 3] }).is_some());
    }

    /// Rays through the corners of cells touch all cells around the corner.
    #[test]
    fn rays_touch_the_cells_around_a_corner() {
        let frame = Frame::new([-4.0, 2.0, 0.5], 8.0, 3).unwrap();
        let corner = [-1.0, 5.0, 3.5];
        let directions = [
            [1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [3.0, -1.0, 0.125],
            [-1.0, -1.0, -1.0],
            [1.0, -7.0, 1e-9],
        ];
        for direction in directions {
            for start in [0.0, -0.5, -2.0, -1e3] {
                // Exact, because the numbers are small.
                let origin = [0, 1, 2].map(|axis| corner[axis] + start * direction[axis]);
                if direction[2] == 1e-9 && start != 0.0 {
                    continue;
                }
                for (from, to) in [(0.0, -start), (-start, f64::INFINITY), (f64::NEG_INFINITY, -start)] {
                    let zone = Zone::Ray { origin, direction, from, to };
                    let reach = Reach::new(&frame, &zone).unwrap().unwrap();
                    for k in 0..8u32 {
                        let at = [2 + (k & 1), 2 + (k >> 1 & 1), 2 + (k >> 2 & 1)];
                        let cube = Cube { frame: &frame, cell: Cell { level: 3, at } };
                        assert!(reach.meets(&cube), "{zone:?} {at:?}");
                    }
                    let far = Cube { frame: &frame, cell: Cell { level: 3, at: [7, 0, 7] } };
                    assert!(!reach.meets(&far) || direction[1] == -7.0 || direction[0] == 3.0);
                }
            }
        }
    }

    /// Points that a ray is known to pass lie in cells that the ray touches, whatever the roundings.
    #[test]
    fn no_cell_on_the_way_is_missed() {
        let frame = Frame::new([0.1, -7.3, 1.0 / 3.0], 10.0 / 3.0, 20).unwrap();
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as i64 - (1 << 30)
        };
        for _ in 0..20_000 {
            // Dyadic numbers of 30 bits: origin, direction and their sum are exact.
            let middle = [1.75, -5.6, 2.0].map(|c: f64| (c * 1024.0).round() / 1024.0);
            let passed: [f64; 3] = middle.map(|c| c + random() as f64 / (1u64 << 31) as f64);
            let direction = [random(), random(), random()].map(|c| c as f64 / (1u64 << 28) as f64);
            let steps = (random() % 8) as f64;
            let origin = [0, 1, 2].map(|axis| passed[axis] - steps * direction[axis]);
            let Some(at) = frame.cell_of(passed) else { continue };
            let zone = Zone::Ray { origin, direction, from: steps, to: steps };
            let Some(reach) = Reach::new(&frame, &zone).unwrap() else { panic!("{zone:?}") };
            for level in 0..=20 {
                let cell = Cell { level, at: at.map(|a| a >> (20 - level)) };
                assert!(reach.meets(&Cube { frame: &frame, cell }), "{zone:?} {cell:?}");
            }
        }
    }
}
