//! Round primitives along an axis of any direction, given by two points.

use super::{Csg, HalfSpace};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{Dyadic, dot};
use crate::lattice::valid::{self, length};
use crate::lattice::{Affine, Bounds, Interval};

impl Csg {
    /// Returns the cylinder of `radius` around the segment between two points (model units), with flat ends
    /// through the points.
    ///
    /// Nothing is rounded: the coefficients of its surface are exact for every direction of the axis. Along a
    /// coordinate axis the solid equals a [`cylinder`](Self::cylinder) that is moved there.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, measure};
    /// let hole = Csg::cylinder_between([0.1, 0.2, 0.3], [0.4, 0.6, 0.3], 0.25)?;
    /// let found = measure(&hole, &Frame::new([-1.0; 3], 2.0, 8)?, 1e-6, &Control::default())?;
    /// assert!(found.volume.contains(core::f64::consts::PI * 0.25 * 0.25 * 0.5));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] if the points are equal, if the radius is not between 2^-256 and 2^256, or if a
    /// coordinate is neither zero nor of such a magnitude.
    pub fn cylinder_between(from: [f64; 3], to: [f64; 3], radius: f64) -> Result<Csg, Error> {
        length("radius", radius)?;
        Csg::frustum_between(from, to, [radius; 2])
    }

    /// Returns the frustum of a cone around the segment between two points (model units), with radius
    /// `radii[0]` at `from` and `radii[1]` at `to`, and flat ends through both points. One of the radii may
    /// be 0, which makes a cone.
    ///
    /// Nothing is rounded, as in [`cylinder_between`](Self::cylinder_between).
    ///
    /// # Errors
    /// [`Error::Argument`] if the points are equal, if both radii are 0, if a non-zero radius is not between
    /// 2^-256 and 2^256, or if a coordinate is neither zero nor of such a magnitude.
    pub fn frustum_between(from: [f64; 3], to: [f64; 3], radii: [f64; 2]) -> Result<Csg, Error> {
        for radius in radii {
            if radius != 0.0 || radii[0] == radii[1] {
                length("radius", radius)?;
            }
        }
        valid::numbers("from", &from)?;
        valid::numbers("to", &to)?;
        if from == to {
            return Err(Error::Argument { name: "to", problem: "must be another point than from" });
        }
        let [a, b] = [from, to].each(|point| point.each(Dyadic::new));
        let d = axes(|axis| &b[axis] - &a[axis]);
        let square = dot(d.each_ref(), d.each_ref());
        // The place of a point p along the axis, times |d|: t = d · p − start, which is 0 to |d|² between the
        // ends.
        let start = dot(d.each_ref(), a.each_ref());
        let [r, s] = radii.each(Dyadic::new);
        let slope = &s - &r;
        // The distance of p from the axis is at most r + slope t / |d|². Squared, times |d|⁴:
        // |d|² (|d|² |p − a|² − t²) ≤ (r |d|² + slope t)². If the slope is zero, a factor |d|² cancels.
        let [along, around, mixed, most] = match slope.is_zero() {
            true => [Dyadic::new(1.0), square.clone(), Dyadic::zero(), &r.pow(2) * &square],
            false => {
                [&slope.pow(2) + &square, square.pow(2), &(&r * &slope) * &square, &r.pow(2) * &square.pow(2)]
            }
        };
        // along t² + 2 mixed t + most − around |p − a|² ≥ 0.
        let product = |i: usize, j: usize| &along * &(&d[i] * &d[j]);
        let squares = axes(|i| &product(i, i) - &around);
        let of_t = &mixed - &(&along * &start);
        let linear = axes(|i| (&(&of_t * &d[i]) + &(&around * &a[i])).shifted(1));
        let constant = &(&along * &start.pow(2)) - &(&mixed * &start).shifted(1);
        let constant = &(&constant + &most) - &(&around * &dot(a.each_ref(), a.each_ref()));
        let [xx, yy, zz] = squares;
        let [x, y, z] = linear;
        let [xy, yz, zx] = [product(0, 1), product(1, 2), product(2, 0)].each(|product| product.shifted(1));
        let mantle = HalfSpace::exactly([xx, yy, zz, xy, yz, zx, x, y, z, constant]);
        let bottom = HalfSpace::linear([d[0].clone(), d[1].clone(), d[2].clone(), -&start]);
        let top = HalfSpace::linear([-&d[0], -&d[1], -&d[2], &square + &start]);
        let parts = Csg::intersection_of([mantle.into(), bottom.into(), top.into()])?;
        let Bounds { min, max } = bounds(from, to, radii);
        Ok(parts.within(min, max))
    }
}

impl Csg {
    /// Returns the torus around the axis through `centre` (model units) in the direction `axis`, of any
    /// length: all points at most `minor` from the circle of radius `major` around the centre.
    ///
    /// Along a coordinate axis nothing is rounded. Any other direction is rounded to doubles, and the torus
    /// is the image of the exact torus under the matrix of these doubles: its error is some 2^-52 of its
    /// size.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, measure};
    /// let ring = Csg::torus_around([0.1, 0.0, 0.0], [1.0, 1.0, 0.0], 0.5, 0.25)?;
    /// let found = measure(&ring, &Frame::new([-1.0; 3], 2.0, 8)?, 1e-4, &Control::default())?;
    /// assert!(found.volume.contains(2.0 * (core::f64::consts::PI * 0.25).powi(2) * 0.5));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] as for [`torus`](Self::torus), if the axis is zero, or if a coordinate is neither
    /// zero nor of a magnitude between 2^-256 and 2^256.
    pub fn torus_around(centre: [f64; 3], axis: [f64; 3], major: f64, minor: f64) -> Result<Csg, Error> {
        valid::numbers("centre", &centre)?;
        valid::numbers("axis", &axis)?;
        let greatest = axis.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if greatest == 0.0 {
            return Err(Error::Argument { name: "axis", problem: "must not be zero" });
        }
        let unit = |v: [f64; 3]| {
            let length = libm::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            v.each(|x| x / length)
        };
        let cross = |a: [f64; 3], b: [f64; 3]| {
            axes(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
        };
        let w = unit(axis.each(|x| x / greatest));
        // The coordinate axis at the greatest angle to `w`.
        let least = (0..3).fold(0, |least, k| if w[k].abs() < w[least].abs() { k } else { least });
        let u = unit(cross(axes(|k| f64::from(u8::from(k == least))), w));
        let v = cross(w, u);
        let matrix = Affine::new(axes(|k| [u[k], v[k], w[k], centre[k]]))?;
        Csg::torus(major, minor)?.placed(&matrix)
    }
}

/// The bounding box of both ends, which are discs.
fn bounds(from: [f64; 3], to: [f64; 3], radii: [f64; 2]) -> Bounds {
    let d = axes(|axis| to[axis] - from[axis]);
    let whole = libm::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    // A disc reaches its radius times the sine of the angle between the axis and the disc's normal.
    let reach = |axis: usize, radius: f64| {
        let (u, v) = (d[(axis + 1) % 3], d[(axis + 2) % 3]);
        if u == 0.0 && v == 0.0 {
            return Interval::exactly(0.0);
        }
        if d[axis] == 0.0 {
            return Interval::exactly(radius);
        }
        // Some roundings of 2^-53 each.
        Interval::exactly(radius * (libm::sqrt(u * u + v * v) / whole) * (1.0 + 1e-14))
    };
    let end = |axis: usize, k: usize| {
        let (at, reach) = (Interval::exactly([from, to][k][axis]), reach(axis, radii[k]));
        (at.minus(reach).lower, at.plus(reach).upper)
    };
    Bounds {
        min: axes(|axis| end(axis, 0).0.min(end(axis, 1).0)),
        max: axes(|axis| end(axis, 0).1.max(end(axis, 1).1)),
    }
}
