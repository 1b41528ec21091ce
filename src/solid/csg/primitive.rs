//! Named primitives that are round, and the box.

use super::dyadic::Dyadic;
use super::{Csg, HalfSpace};
use crate::error::Error;
use crate::lattice::exact::two_sum;
use crate::solid::is_moderate;

/// Refuses a length that is not between 2^-256 and 2^256.
pub(super) fn length(name: &'static str, value: f64) -> Result<(), Error> {
    if value > 0.0 && is_moderate(value) {
        Ok(())
    } else {
        Err(Error::Argument { name, problem: "must be between 2^-256 and 2^256" })
    }
}

/// Refuses coordinates that are not zero and not of such a magnitude.
pub(super) fn coordinates(name: &'static str, values: &[f64]) -> Result<(), Error> {
    if values.iter().all(|&c| c == 0.0 || is_moderate(c)) {
        Ok(())
    } else {
        let problem = "every coordinate must be zero or of a magnitude between 2^-256 and 2^256";
        Err(Error::Argument { name, problem })
    }
}

/// The largest double that is not greater than a + b.
fn sum_down(a: f64, b: f64) -> f64 {
    let (sum, error) = two_sum(a, b);
    if error < 0.0 { sum.next_down() } else { sum }
}

/// The half-space below (`side` −1) or above (1) a coordinate.
pub(super) fn axis_plane(axis: usize, side: f64, at: f64) -> HalfSpace {
    let mut c = [0.0; 10];
    (c[6 + axis], c[9]) = (side, -side * at);
    HalfSpace::exactly(c.map(Dyadic::new))
}

/// Between two coordinates of an axis.
pub(super) fn slab(axis: usize, low: f64, high: f64) -> [Csg; 2] {
    [axis_plane(axis, 1.0, low).into(), axis_plane(axis, -1.0, high).into()]
}

impl Csg {
    /// The box between two corners (model units), `min < max` on every axis.
    ///
    /// # Errors
    /// [`Error::Argument`] if that does not hold, or a coordinate is not zero and not of a magnitude between 2^-256 and
    /// 2^256.
    pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> Result<Csg, Error> {
        coordinates("min", &min)?;
        coordinates("max", &max)?;
        if (0..3).any(|axis| min[axis] >= max[axis]) {
            return Err(Error::Argument { name: "max", problem: "must be greater than min on every axis" });
        }
        let planes = (0..3).flat_map(|axis| slab(axis, min[axis], max[axis]));
        Ok(Csg::intersection_of(planes)?.within(min, max))
    }

    /// The ball of all points at most `radius` (model units) from `centre`.
    ///
    /// # Errors
    /// [`Error::Argument`] if the radius is not between 2^-256 and 2^256, or a coordinate not zero and not of such a
    /// magnitude.
    pub fn ball(centre: [f64; 3], radius: f64) -> Result<Csg, Error> {
        Csg::ellipsoid(centre, [radius; 3])
    }

    /// The ellipsoid around `centre` with the semi-axes `radii` along x, y and z (model units).
    ///
    /// # Errors
    /// As [`ball`](Self::ball).
    pub fn ellipsoid(centre: [f64; 3], radii: [f64; 3]) -> Result<Csg, Error> {
        coordinates("centre", &centre)?;
        for radius in radii {
            length("radius", radius)?;
        }
        // Σ (x − c)² / r² ≤ 1, times all r².
        let squares = radii.map(|radius| Dyadic::new(radius).pow(2));
        let all = &(&squares[0] * &squares[1]) * &squares[2];
        let zero = Dyadic::zero;
        let mut c = [zero(), zero(), zero(), zero(), zero(), zero(), zero(), zero(), zero(), all];
        for axis in 0..3 {
            let weight = -&(&squares[(axis + 1) % 3] * &squares[(axis + 2) % 3]);
            let at = Dyadic::new(centre[axis]);
            c[6 + axis] = -&(&weight * &at.shifted(1));
            c[9] = &c[9] + &(&weight * &at.pow(2));
            c[axis] = weight;
        }
        let min = [0, 1, 2].map(|axis| sum_down(centre[axis], -radii[axis]));
        let max = [0, 1, 2].map(|axis| -sum_down(-centre[axis], -radii[axis]));
        Ok(Csg::from(HalfSpace::exactly(c)).within(min, max))
    }

    /// The cylinder of `radius` around the z axis between z = `low` and z = `high` (model units).
    ///
    /// # Errors
    /// [`Error::Argument`] if the radius is not between 2^-256 and 2^256, a coordinate not zero and not of such a
    /// magnitude, or `low` not less than `high`.
    pub fn cylinder(radius: f64, low: f64, high: f64) -> Result<Csg, Error> {
        length("radius", radius)?;
        Csg::frustum(radius, radius, low, high)
    }

    /// The frustum of a cone around the z axis: of radius `bottom` at z = `low` and `top` at z = `high` (model units).
    /// One of the radii may be 0, which makes a cone.
    ///
    /// # Errors
    /// [`Error::Argument`] if both radii are 0 or one is not between 2^-256 and 2^256, a coordinate not zero and not of
    /// such a magnitude, or `low` not less than `high`.
    pub fn frustum(bottom: f64, top: f64, low: f64, high: f64) -> Result<Csg, Error> {
        for radius in [bottom, top] {
            if radius != 0.0 || bottom == top {
                length("radius", radius)?;
            }
        }
        coordinates("height", &[low, high])?;
        if low >= high {
            return Err(Error::Argument { name: "high", problem: "must be greater than low" });
        }
        // x² + y² ≤ r(z)², times the square of the height: h r(z) = (top − bottom) z + (bottom high − top low), which is
        // not negative between the planes.
        let [r, s, a, b] = [bottom, top, low, high].map(Dyadic::new);
        let slope = &s - &r;
        let offset = &(&r * &b) - &(&s * &a);
        let weight = -&(&b - &a).pow(2);
        let zero = Dyadic::zero;
        let cone = HalfSpace::exactly([
            weight.clone(),
            weight,
            slope.pow(2),
            zero(),
            zero(),
            zero(),
            zero(),
            zero(),
            (&slope * &offset).shifted(1),
            offset.pow(2),
        ]);
        let radius = bottom.max(top);
        let [bottom, top] = slab(2, low, high);
        let parts = Csg::intersection_of([cone.into(), bottom, top])?;
        Ok(parts.within([-radius, -radius, low], [radius, radius, high]))
    }

    /// The torus around the z axis: all points at most `minor` from the circle of radius `major` in the plane z = 0
    /// (model units). See [`HalfSpace::torus`].
    ///
    /// # Errors
    /// As [`HalfSpace::torus`].
    pub fn torus(major: f64, minor: f64) -> Result<Csg, Error> {
        let outer = (major + minor).next_up();
        let torus = Csg::from(HalfSpace::torus(major, minor)?);
        Ok(torus.within([-outer, -outer, -minor], [outer, outer, minor]))
    }
}
