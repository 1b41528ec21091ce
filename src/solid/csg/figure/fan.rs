//! Polygons that replace circles, as OpenSCAD draws them.
//!
//! The corners of the polygon of radius 1 are doubles, and all computations with them are exact: a polygon of
//! another radius has each corner times the radius.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{Dyadic, sign_of_products};
use crate::memory;
use crate::solid::csg::Csg;
use crate::solid::half_space::HalfSpace;
use alloc::vec::Vec;

/// A fan of triangles around the origin: the corners of a convex polygon, or of a part of one,
/// counter-clockwise.
pub(crate) struct Fan {
    corners: Vec<[f64; 2]>,
    /// Whether the last corner is joined to the first.
    is_closed: bool,
}

impl Fan {
    /// Returns the regular polygon of radius 1 with `count` corners. The first corner is at the angle `start`
    /// in degrees. `None` if there are fewer than three corners.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn regular(start: f64, count: u32) -> Result<Option<Fan>, Error> {
        let angle = |i: u32| start + 360.0 * f64::from(i) / f64::from(count);
        Fan::of((0..count).map(angle).map(direction), true)
    }

    /// Returns the corners at `count` + 1 angles from `start` on, over `angle` degrees in all. `None` if two
    /// neighbours are half a turn or more apart, or so close that the corners in doubles are not convex.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn part(start: f64, angle: f64, count: u32) -> Result<Option<Fan>, Error> {
        let at = |i: u32| start + angle * f64::from(i) / f64::from(count);
        let corner = |i: u32| direction(at(if angle < 0.0 { count - i } else { i }));
        if angle.abs() / f64::from(count) >= 180.0 {
            return Ok(None);
        }
        Fan::of((0..count + 1).map(corner), false)
    }

    fn of(found: impl ExactSizeIterator<Item = [f64; 2]>, is_closed: bool) -> Result<Option<Fan>, Error> {
        let fan = Fan { corners: memory::collected(found)?, is_closed };
        let count = fan.corners.len();
        let at = |i: usize| fan.corners[i % count];
        let last = if is_closed { count } else { count.saturating_sub(2) };
        let is_convex = (0..last).all(|i| turn(at(i), at(i + 1), at(i + 2)) > 0);
        let is_around = count > 1 && fan.edges().all(|[a, b]| side(a, b) > 0);
        Ok(Some(fan).filter(|_| is_convex && is_around && (count > 2 || !is_closed)))
    }

    pub(crate) fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// Returns the fan turned by half a turn.
    pub(crate) fn opposite(mut self) -> Fan {
        self.corners.iter_mut().for_each(|corner| *corner = corner.each(|c| 0.0 - c));
        self
    }

    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let next = self.corners.iter().skip(1).chain(self.corners.first().filter(|_| self.is_closed));
        self.corners.iter().zip(next).map(|(&a, &b)| [a, b])
    }

    /// Returns the solid that a half-plane x ρ + y z + 1 ≥ 0 sweeps. ρ is a point's distance from the axis,
    /// relative to the polygon's radius in the point's direction. The result is valid only within the fan's
    /// directions.
    ///
    /// In each triangle of the fan ρ is linear. Because the polygon is convex, ρ is the maximum of those
    /// linear functions. So the swept half-plane is an intersection or a union of half-spaces, and the sides
    /// of the triangles do not occur.
    pub(crate) fn sweep(&self, [x, y, one]: [Dyadic; 3]) -> Result<Csg, Error> {
        if x.is_zero() {
            return Ok(HalfSpace::linear([Dyadic::zero(), Dyadic::zero(), y, one]).into());
        }
        let is_inward = x.sign() < 0;
        if y.is_zero() {
            match (is_inward, one.sign()) {
                (false, 0..) => return Ok(Csg::everything()),
                (true, ..=0) => return Ok(Csg::empty()),
                _ => {}
            }
        }
        let mut parts = memory::with_capacity(self.corners.len())?;
        parts.extend(self.edges().map(|[a, b]| {
            let [[ax, ay], [bx, by]] = [a, b].each(|corner| corner.each(Dyadic::new));
            // ρ times this scale is p × (b − a).
            let scale = &(&ax * &by) - &(&ay * &bx);
            let (along_x, along_y) = (&bx - &ax, &by - &ay);
            let plane = [&x * &along_y, -&(&x * &along_x), &y * &scale, &one * &scale];
            Csg::from(HalfSpace::linear(plane))
        }));
        if is_inward { Csg::intersection_of(parts) } else { Csg::union_of(parts) }
    }

    /// Returns the wedge of the fan's directions around the z axis; `None` if the fan covers all directions.
    pub(crate) fn wedge(&self) -> Result<Option<Csg>, Error> {
        let (Some(&first), Some(&last), false) = (self.corners.first(), self.corners.last(), self.is_closed)
        else {
            return Ok(None);
        };
        let beside =
            |[x, y]: [f64; 2], sense: f64| HalfSpace::plane([-sense * y, sense * x, 0.0], 0.0).map(Csg::from);
        let sides = [beside(first, 1.0)?, beside(last, -1.0)?];
        Ok(Some(match side(first, last) {
            1 => Csg::intersection_of(sides)?,
            -1 => Csg::union_of(sides)?,
            _ => beside(first, 1.0)?,
        }))
    }
}

/// Returns the exact sign of a × b.
fn side(a: [f64; 2], b: [f64; 2]) -> i32 {
    sign_of_products(&[(a[0], b[1]), (-a[1], b[0])])
}

/// Returns 1 if the way from a over b to c turns left, −1 if it turns right; exact.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i32 {
    let cross = |p: [f64; 2], q: [f64; 2]| [(p[0], q[1]), (-p[1], q[0])];
    sign_of_products([cross(a, b), cross(b, c), cross(c, a)].as_flattened())
}

/// Returns the point of the unit circle at an angle in degrees.
fn direction(degrees: f64) -> [f64; 2] {
    [cos_degrees(degrees), sin_degrees(degrees)]
}

/// Returns the sine of an angle in degrees, by the reductions of OpenSCAD: 30°, 45°, 60° and their mirror
/// images have equal sines to the last bit.
pub(crate) fn sin_degrees(degrees: f64) -> f64 {
    let mut x = turned(degrees);
    let is_below = x >= 180.0;
    if is_below {
        x -= 180.0;
    }
    let sine = sine_of_half_turn(x);
    if is_below { 0.0 - sine } else { sine }
}

/// Returns the cosine of an angle in degrees, with the reductions of [`sin_degrees`].
pub(crate) fn cos_degrees(degrees: f64) -> f64 {
    let mut x = turned(degrees);
    let mut is_left = x >= 180.0;
    if is_left {
        x -= 180.0;
    }
    if x > 90.0 {
        x = 180.0 - x;
        is_left = !is_left;
    }
    let cosine = if x > 45.0 {
        if x == 60.0 { 0.5 } else { libm::sin((90.0 - x).to_radians()) }
    } else if x == 45.0 {
        core::f64::consts::FRAC_1_SQRT_2
    } else if x == 30.0 {
        HALF_SQRT_3
    } else {
        libm::cos(x.to_radians())
    };
    if is_left { 0.0 - cosine } else { cosine }
}

const HALF_SQRT_3: f64 = 0.866_025_403_784_438_6;

/// Returns the angle reduced to 0 ≤ angle < 360.
fn turned(degrees: f64) -> f64 {
    if (0.0..360.0).contains(&degrees) { degrees } else { degrees - 360.0 * libm::floor(degrees / 360.0) }
}

fn sine_of_half_turn(mut x: f64) -> f64 {
    if x > 90.0 {
        x = 180.0 - x;
    }
    if x < 45.0 {
        if x == 30.0 { 0.5 } else { libm::sin(x.to_radians()) }
    } else if x == 45.0 {
        core::f64::consts::FRAC_1_SQRT_2
    } else if x == 60.0 {
        HALF_SQRT_3
    } else {
        libm::cos((90.0 - x).to_radians())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_of_round_angles_are_exact() {
        for (degrees, sine) in
            [(0.0, 0.0), (30.0, 0.5), (90.0, 1.0), (150.0, 0.5), (180.0, 0.0), (210.0, -0.5), (-90.0, -1.0)]
        {
            assert_eq!(sin_degrees(degrees), sine);
            assert_eq!(cos_degrees(degrees - 90.0), sine);
            assert_eq!(cos_degrees(degrees + 270.0), sine);
        }
        for degrees in [45.0, 60.0, 17.0, 0.25, 89.0] {
            assert_eq!(sin_degrees(degrees), -sin_degrees(degrees + 180.0));
            assert!((sin_degrees(degrees) - libm::sin(degrees.to_radians())).abs() < 1e-15);
            assert!((cos_degrees(degrees) - libm::cos(degrees.to_radians())).abs() < 1e-15);
        }
    }

    #[test]
    fn fans_are_convex_and_around_the_origin() {
        assert!(Fan::regular(0.0, 2).unwrap().is_none());
        for count in [3, 4, 5, 6, 7, 12, 360, 1024] {
            assert_eq!(Fan::regular(180.0, count).unwrap().unwrap().corners().len(), count as usize);
        }
        assert!(Fan::part(0.0, 270.0, 1).unwrap().is_none());
        assert!(Fan::part(0.0, 180.0, 1).unwrap().is_none());
        assert!(Fan::part(0.0, 1e-9, 1000).unwrap().is_none());
        assert_eq!(Fan::part(30.0, -90.0, 3).unwrap().unwrap().corners().len(), 4);
    }
}
