//! Round primitives, and the box.

use super::{Csg, HalfSpace};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Interval;
use crate::lattice::axes;
use crate::lattice::exact::Dyadic;
use crate::lattice::valid::{self, length};

/// Refuses heights that are not a bottom below a top.
pub(super) fn heights(low: f64, high: f64) -> Result<(), Error> {
    valid::numbers("height", &[low, high])?;
    if low >= high {
        return Err(Error::Argument { name: "high", problem: "must be greater than low" });
    }
    Ok(())
}

/// Returns the half-space below (`side` −1) or above (1) a coordinate.
pub(super) fn axis_plane(axis: usize, side: f64, at: f64) -> HalfSpace {
    let mut c = [0.0, 0.0, 0.0, -side * at];
    c[axis] = side;
    HalfSpace::linear(c.each(Dyadic::new))
}

/// Returns the two half-spaces between two coordinates of an axis.
pub(super) fn slab(axis: usize, low: f64, high: f64) -> [Csg; 2] {
    [axis_plane(axis, 1.0, low).into(), axis_plane(axis, -1.0, high).into()]
}

impl Csg {
    /// Returns the box between two corners (model units), with `min < max` on every axis.
    ///
    /// # Errors
    /// [`Error::Argument`] if `min` is not less than `max` on every axis, or if a coordinate is neither zero
    /// nor of a magnitude between 2^-256 and 2^256.
    pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> Result<Csg, Error> {
        valid::numbers("min", &min)?;
        valid::numbers("max", &max)?;
        if (0..3).any(|axis| min[axis] >= max[axis]) {
            return Err(Error::Argument { name: "max", problem: "must be greater than min on every axis" });
        }
        let planes = (0..3).flat_map(|axis| slab(axis, min[axis], max[axis]));
        Ok(Csg::intersection_of(planes)?.within(min, max))
    }

    /// Returns the ball of all points at most `radius` (model units) from `centre`.
    ///
    /// # Errors
    /// [`Error::Argument`] if the radius is not between 2^-256 and 2^256, or if a coordinate is neither zero
    /// nor of such a magnitude.
    pub fn ball(centre: [f64; 3], radius: f64) -> Result<Csg, Error> {
        Csg::ellipsoid(centre, [radius; 3])
    }

    /// Returns the ellipsoid around `centre` with the semi-axes `radii` along x, y and z (model units).
    ///
    /// # Errors
    /// As [`ball`](Self::ball).
    pub fn ellipsoid(centre: [f64; 3], radii: [f64; 3]) -> Result<Csg, Error> {
        valid::numbers("centre", &centre)?;
        for radius in radii {
            length("radius", radius)?;
        }
        // Σ (x − c)² / r² ≤ 1, times all r².
        let squares = radii.each(|radius| Dyadic::new(radius).pow(2));
        let weights = axes(|axis| -&(&squares[(axis + 1) % 3] * &squares[(axis + 2) % 3]));
        let linear = axes(|axis| -&(&weights[axis] * &Dyadic::new(centre[axis]).shifted(1)));
        let constant = (0..3).fold(&(&squares[0] * &squares[1]) * &squares[2], |sum, axis| {
            &sum + &(&weights[axis] * &Dyadic::new(centre[axis]).pow(2))
        });
        let [centre, radii] = [centre, radii].each(|all| all.each(Interval::exactly));
        let min = axes(|axis| centre[axis].minus(radii[axis]).lower);
        let max = axes(|axis| centre[axis].plus(radii[axis]).upper);
        Ok(Csg::from(HalfSpace::separable(weights, linear, constant)).within(min, max))
    }

    /// Returns the cylinder of `radius` around the z axis between z = `low` and z = `high` (model units).
    ///
    /// # Errors
    /// [`Error::Argument`] if the radius is not between 2^-256 and 2^256, if a coordinate is neither zero nor
    /// of such a magnitude, or if `low` is not less than `high`.
    pub fn cylinder(radius: f64, low: f64, high: f64) -> Result<Csg, Error> {
        length("radius", radius)?;
        Csg::frustum(radius, radius, low, high)
    }

    /// Returns the frustum of a cone around the z axis, with radius `bottom` at z = `low` and `top` at z =
    /// `high` (model units). One of the radii may be 0, which makes a cone.
    ///
    /// # Errors
    /// [`Error::Argument`] if both radii are 0, if a non-zero radius is not between 2^-256 and 2^256, if a
    /// coordinate is neither zero nor of such a magnitude, or if `low` is not less than `high`.
    pub fn frustum(bottom: f64, top: f64, low: f64, high: f64) -> Result<Csg, Error> {
        for radius in [bottom, top] {
            if radius != 0.0 || bottom == top {
                length("radius", radius)?;
            }
        }
        heights(low, high)?;
        // x² + y² ≤ r(z)², times the square of the height: h r(z) = (top − bottom) z + (bottom high − top
        // low), which is not negative between the planes.
        let [r, s, a, b] = [bottom, top, low, high].each(Dyadic::new);
        let slope = &s - &r;
        let offset = &(&r * &b) - &(&s * &a);
        let weight = -&(&b - &a).pow(2);
        let zero = Dyadic::zero;
        let squares = [weight.clone(), weight, slope.pow(2)];
        let linear = [zero(), zero(), (&slope * &offset).shifted(1)];
        let cone = HalfSpace::separable(squares, linear, offset.pow(2));
        let radius = bottom.max(top);
        let [bottom, top] = slab(2, low, high);
        let parts = Csg::intersection_of([cone.into(), bottom, top])?;
        Ok(parts.within([-radius, -radius, low], [radius, radius, high]))
    }

    /// Returns the torus around the z axis: all points at most `minor` from the circle of radius `major` in
    /// the plane z = 0 (model units). See [`HalfSpace::torus`].
    ///
    /// # Errors
    /// As [`HalfSpace::torus`].
    pub fn torus(major: f64, minor: f64) -> Result<Csg, Error> {
        let outer = (major + minor).next_up();
        let torus = Csg::from(HalfSpace::torus(major, minor)?);
        Ok(torus.within([-outer, -outer, -minor], [outer, outer, minor]))
    }
}
