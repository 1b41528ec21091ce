//! The shapes of surfaces in model space, in the parameters that other programs use.

use super::map::ExactMap;
use super::quadric::{Coefficients, substitute};
use super::slab::ThickPlane;
use super::torus::Torus;
use super::{PlacedHalfSpace, Surface};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::{Dyadic, sqrt};

/// A surface in model space: its kind and its parameters.
///
/// The parameters are those of the exact surface, rounded: their relative error is some 10^-15 of the
/// coordinates. A surface of degree two is reported as a ball, a cylinder or a cone if its coefficients agree
/// with such a shape to 10^-9 of their size.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceShape {
    /// The plane `normal` · p = `offset`. The normal has the length one and points out of the half-space. For
    /// a plane with a width, as in octrees of meshes, this is the middle plane.
    Plane {
        /// The unit normal.
        normal: [f64; 3],
        /// The distance of the plane from the origin, along the normal (model units).
        offset: f64,
    },
    /// The points at a distance of `radius` from `centre`.
    Ball {
        /// The centre, in model space.
        centre: [f64; 3],
        /// The radius (model units).
        radius: f64,
    },
    /// The points at a distance of `radius` from a line.
    Cylinder {
        /// The point of the axis that is nearest to the origin.
        point: [f64; 3],
        /// The direction of the axis, of length one.
        axis: [f64; 3],
        /// The radius (model units).
        radius: f64,
    },
    /// The lines through `apex` at an angle to the axis, on both sides of the apex.
    Cone {
        /// The apex, in model space.
        apex: [f64; 3],
        /// The direction of the axis, of length one.
        axis: [f64; 3],
        /// The angle between axis and surface: between 0 and π/2.
        half_angle: f64,
    },
    /// The points at a distance of `minor` from a circle.
    Torus {
        /// The circle's centre.
        centre: [f64; 3],
        /// The direction across the plane of the circle, of length one.
        axis: [f64; 3],
        /// The radius of the circle (model units).
        major: f64,
        /// The radius of the tube (model units).
        minor: f64,
    },
    /// Any other surface of degree two.
    Quadric {
        /// The factors of x², y², z², xy, yz, zx, x, y, z and 1, in the order of
        /// [`HalfSpace::quadric`](super::HalfSpace::quadric): the sum is positive in the half-space. The
        /// magnitude of the largest factor is between 1/2 and 1.
        coefficients: [f64; 10],
    },
    /// A surface without such parameters: a sum of powers, a stretched torus, a host program's function.
    Other,
}

/// The greatest deviation of coefficients from those of a ball, a cylinder or a cone, relative to their size.
const ALIKE: f64 = 1e-9;

/// The most sweeps of Jacobi's method, which takes some five.
const SWEEPS: usize = 32;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    axes(|i| a[i] - b[i])
}

/// The unit vector; `None` if the vector has no direction.
fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let size = sqrt(dot(a, a));
    let unit = a.each(|c| c / size);
    unit.iter().all(|c| c.is_finite()).then_some(unit)
}

impl SurfaceShape {
    /// Returns `plane`, `ball`, `cylinder`, `cone`, `torus`, `quadric` or `other`.
    pub fn name(&self) -> &'static str {
        match self {
            SurfaceShape::Plane { .. } => "plane",
            SurfaceShape::Ball { .. } => "ball",
            SurfaceShape::Cylinder { .. } => "cylinder",
            SurfaceShape::Cone { .. } => "cone",
            SurfaceShape::Torus { .. } => "torus",
            SurfaceShape::Quadric { .. } => "quadric",
            SurfaceShape::Other => "other",
        }
    }

    /// Returns the unit normal of the surface at a point next to it. It points away from the centre of a
    /// ball, away from the axis or the circle of a cylinder, a cone and a torus, and out of the half-space
    /// for a plane and any other surface. `None` where there is no normal, and for [`Other`](Self::Other).
    pub fn normal(&self, at: [f64; 3]) -> Option<[f64; 3]> {
        match *self {
            SurfaceShape::Plane { normal, .. } => Some(normal),
            SurfaceShape::Ball { centre, .. } => unit(minus(at, centre)),
            SurfaceShape::Cylinder { point, axis, .. } => unit(across(minus(at, point), axis)),
            SurfaceShape::Cone { apex, axis, half_angle } => {
                let from = minus(at, apex);
                let out = unit(across(from, axis))?;
                let along = libm::sin(half_angle).copysign(dot(from, axis));
                Some(axes(|i| libm::cos(half_angle) * out[i] - along * axis[i]))
            }
            SurfaceShape::Torus { centre, axis, major, .. } => {
                let from = minus(at, centre);
                let out = unit(across(from, axis))?;
                unit(minus(from, out.each(|c| major * c)))
            }
            SurfaceShape::Quadric { coefficients: c } => unit(axes(|i| {
                let (next, last) = ((i + 1) % 3, (i + 2) % 3);
                -(2.0 * c[i] * at[i] + c[3 + i] * at[next] + c[3 + last] * at[last] + c[6 + i])
            })),
            SurfaceShape::Other => None,
        }
    }
}

/// The part of a vector across a unit axis.
fn across(vector: [f64; 3], axis: [f64; 3]) -> [f64; 3] {
    let along = dot(vector, axis);
    axes(|i| vector[i] - along * axis[i])
}

impl PlacedHalfSpace {
    /// Returns whether the surface is a plane, with or without a width.
    #[cfg(feature = "std")]
    pub(crate) fn is_flat(&self) -> bool {
        matches!(&*self.half_space.0, Surface::Plane(_) | Surface::Slab(_))
    }

    /// Returns the surface in model space: its kind and its parameters.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, solid::SurfaceShape, surface::boundary};
    /// let rod = Csg::cylinder_between([1.0, 2.0, 0.0], [1.0, 2.0, 4.0], 0.5)?;
    /// let frame = Frame::around([0.0; 3], [2.0, 3.0, 4.0], 12)?;
    /// let found = boundary(&rod, &frame, 0.01, &Control::default())?;
    /// let round = found.surfaces().iter().map(|surface| surface.shape()).find(|shape| {
    ///     matches!(shape, Ok(SurfaceShape::Cylinder { .. }))
    /// });
    /// let Some(Ok(SurfaceShape::Cylinder { point, radius, .. })) = round else { panic!() };
    /// assert_eq!((point, radius), ([1.0, 2.0, 0.0], 0.5));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Limit`] if exact numbers of placements become too long.
    pub fn shape(&self) -> Result<SurfaceShape, Error> {
        let map = || self.map(ExactMap::identity());
        Ok(match &*self.half_space.0 {
            Surface::Plane(plane) => {
                let map = map()?;
                let numbers = map.linear(plane);
                let is_turned = map.w.sign() < 0;
                let [x, y, z, one] = if is_turned { numbers } else { numbers.each(|c| -&c) };
                of_plane([x, y, z], &one)
            }
            Surface::Slab(slab) => of_slab(slab, &map()?),
            Surface::Quadric(quadric) => of_quadric(&substitute(quadric, &map()?)),
            Surface::Torus(torus) => self.of_torus(torus).unwrap_or(SurfaceShape::Other),
            Surface::Powers(_) | Surface::Host(_) => SurfaceShape::Other,
        })
    }

    /// Maps a vector of the half-space's own space to model space; a point has a last coordinate of 1.
    fn moved(&self, own: [f64; 4]) -> [f64; 3] {
        let moved = self.placements.iter().rev().fold(own, |at, placement| {
            let [x, y, z] = axes(|i| (0..4).map(|j| placement.rows()[i][j] * at[j]).sum::<f64>());
            [x, y, z, own[3]]
        });
        axes(|i| moved[i])
    }

    /// Returns the shape of a torus if its placements scale all directions alike.
    fn of_torus(&self, torus: &Torus) -> Option<SurfaceShape> {
        let [major, square, scale, shift] =
            [&torus.major, &torus.square, &torus.scale, &torus.shift].each(Dyadic::rounded);
        let ways: [[f64; 3]; 3] = axes(|i| {
            let [x, y, z] = axes(|j| if i == j { 1.0 } else { 0.0 });
            self.moved([x, y, z, 0.0])
        });
        let size = dot(ways[0], ways[0]);
        let is_alike = (0..3).all(|i| {
            (0..=i).all(|j| {
                let wanted = if i == j { size } else { 0.0 };
                (dot(ways[i], ways[j]) - wanted).abs() <= ALIKE * size
            })
        });
        let longer = sqrt(size) / scale;
        let centre = self.moved([0.0, 0.0, -shift / scale, 1.0]);
        let axis = unit(ways[2])?;
        let (major, minor) = (longer * major, longer * sqrt(square));
        let is_known = is_alike && major.is_finite() && minor.is_finite();
        is_known.then_some(SurfaceShape::Torus { centre, axis, major, minor })
    }
}

/// Returns the plane of the points with `normal` · p = `offset`.
fn of_plane(normal: [Dyadic; 3], offset: &Dyadic) -> SurfaceShape {
    let scale = -normal.iter().filter_map(Dyadic::magnitude).max().unwrap_or(0);
    let normal = normal.each(|c| c.shifted(scale).rounded());
    let size = sqrt(dot(normal, normal));
    // (Adding 0.0 removes the sign of a zero.)
    let offset = 0.0 - offset.shifted(scale).rounded() / size;
    SurfaceShape::Plane { normal: normal.each(|c| c / size + 0.0), offset }
}

fn of_slab(slab: &ThickPlane, map: &ExactMap) -> SurfaceShape {
    let [x, y, z] = slab.normal.each(Dyadic::new);
    let numbers = map.linear(&[x, y, z, Dyadic::zero()]);
    // (An offset is infinite if only one side is known.)
    let ends = [slab.inner, slab.outer];
    let middle = match ends.each(f64::is_finite) {
        [true, true] => ends[0].midpoint(ends[1]),
        [true, false] => ends[0],
        [false, true] => ends[1],
        [false, false] => return SurfaceShape::Other,
    };
    let [x, y, z, one] = numbers;
    let one = &one - &(&Dyadic::new(middle) * &map.w);
    match map.w.sign() < 0 {
        true => of_plane([-&x, -&y, -&z], &-&one),
        false => of_plane([x, y, z], &one),
    }
}

/// Returns doubles in proportion to exact numbers; the largest magnitude is between 1/2 and 1.
fn rounded(exact: &Coefficients) -> [f64; 10] {
    let scale = -exact.iter().filter_map(Dyadic::magnitude).max().unwrap_or(0) - 1;
    exact.each_ref().each(|c| c.shifted(scale).rounded())
}

/// Returns the eigenvalues of a symmetric matrix, and their unit eigenvectors. (Jacobi 1846.)
fn eigen(mut matrix: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut vectors: [[f64; 3]; 3] = axes(|i| axes(|j| if i == j { 1.0 } else { 0.0 }));
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = matrix[p][q];
            if off == 0.0 {
                continue;
            }
            let half = (matrix[q][q] - matrix[p][p]) / (2.0 * off);
            let tangent = 1.0_f64.copysign(half) / (half.abs() + libm::hypot(half, 1.0));
            let cosine = 1.0 / libm::hypot(tangent, 1.0);
            let sine = tangent * cosine;
            let turned = |a: [f64; 3], b: [f64; 3]| {
                (axes(|i| cosine * a[i] - sine * b[i]), axes(|i| sine * a[i] + cosine * b[i]))
            };
            (matrix[p], matrix[q]) = turned(matrix[p], matrix[q]);
            for row in &mut matrix {
                (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
            }
            (matrix[p][q], matrix[q][p]) = (0.0, 0.0);
            (vectors[p], vectors[q]) = turned(vectors[p], vectors[q]);
        }
    }
    (axes(|i| matrix[i][i]), vectors)
}

/// Returns the shape of a polynomial of degree two, from its exact coefficients.
fn of_quadric(exact: &Coefficients) -> SurfaceShape {
    let coefficients = rounded(exact);
    round(exact, &coefficients).unwrap_or(SurfaceShape::Quadric { coefficients })
}

/// Returns the ball, the cylinder or the cone that a polynomial bounds, if it bounds one.
fn round(exact: &Coefficients, coefficients: &[f64; 10]) -> Option<SurfaceShape> {
    let [xx, yy, zz, xy, yz, zx, ..] = *coefficients;
    let matrix = [[xx, 0.5 * xy, 0.5 * zx], [0.5 * xy, yy, 0.5 * yz], [0.5 * zx, 0.5 * yz, zz]];
    let (values, vectors) = eigen(matrix);
    let size = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let is_near = |a: f64, b: f64| (a - b).abs() <= ALIKE * size;
    // The point where the gradient is zero, as near to the origin as possible.
    let still = |linear: [f64; 3]| -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (value, vector) in values.into_iter().zip(vectors).filter(|(value, _)| !is_near(*value, 0.0)) {
            let along = -dot(linear, vector) / (2.0 * value);
            sum = axes(|i| sum[i] + along * vector[i]);
        }
        sum
    };
    let first = still(axes(|i| coefficients[6 + i]));
    if !(size > 0.0 && first.iter().all(|c| c.is_finite())) {
        return None;
    }
    // Expanded around this point, with all digits.
    let mut map = ExactMap::identity();
    (0..3).for_each(|i| map.rows[i][3] = Dyadic::new(first[i]));
    let near = substitute(exact, &map);
    let scale = -exact.iter().filter_map(Dyadic::magnitude).max().unwrap_or(0) - 1;
    let near = near.each_ref().each(|c| c.shifted(scale).rounded());
    let linear = [near[6], near[7], near[8]];
    let rest = still(linear);
    let core: [f64; 3] = axes(|i| first[i] + rest[i] + 0.0);
    let constant = near[9] + 0.5 * dot(linear, rest);

    if values.iter().all(|&value| is_near(value, values[0])) {
        let square = -constant / (values.iter().sum::<f64>() / 3.0);
        return (square > 0.0).then(|| SurfaceShape::Ball { centre: core, radius: sqrt(square) });
    }
    let odd = (0..3).find(|i| is_near(values[(i + 1) % 3], values[(i + 2) % 3]))?;
    let around = 0.5 * (values[(odd + 1) % 3] + values[(odd + 2) % 3]);
    let axis = vectors[odd].each(|c| c + 0.0);
    if is_near(values[odd], 0.0) {
        let square = -constant / around;
        let radius = sqrt(square);
        // (A paraboloid is no cylinder.)
        let is_straight = square > 0.0 && dot(linear, axis).abs() <= ALIKE * around.abs() * radius;
        return is_straight.then_some(SurfaceShape::Cylinder { point: core, axis, radius });
    }
    // A hyperboloid with a vanishing waist is a cone.
    let waist = (constant / around).abs();
    let is_cone = values[odd] * around < 0.0 && waist <= ALIKE * ALIKE * dot(core, core);
    is_cone.then(|| SurfaceShape::Cone {
        apex: core,
        axis,
        half_angle: libm::atan(sqrt(-values[odd] / around)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Affine;
    use crate::solid::HalfSpace;
    use alloc::sync::Arc;

    fn of(half_space: HalfSpace, placements: &[Affine]) -> SurfaceShape {
        PlacedHalfSpace { half_space, placements: Arc::from(placements) }.shape().unwrap()
    }

    fn turn() -> Affine {
        Affine::new([[0.36, 0.48, -0.8, 100.0], [-0.8, 0.6, 0.0, 200.0], [0.48, 0.64, 0.6, 300.0]]).unwrap()
    }

    fn assert_near(a: &[f64], b: &[f64]) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-13 * (1.0 + b.abs())), "{a:?} {b:?}");
    }

    #[test]
    fn planes() {
        let plane = HalfSpace::plane([0.0, 0.0, -2.0], 6.0).unwrap();
        let expected = SurfaceShape::Plane { normal: [0.0, 0.0, 1.0], offset: 3.0 };
        assert_eq!(of(plane.clone(), &[]), expected);
        let SurfaceShape::Plane { normal, offset } = of(plane.clone(), &[turn()]) else { panic!() };
        assert_near(&normal, &[-0.8, 0.0, 0.6]);
        let point = turn().apply([5.0, 7.0, 3.0]);
        assert_near(&[offset], &[dot(normal, point)]);
        // A mirror image keeps the side.
        let mirror =
            Affine::new([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0]]).unwrap();
        let expected = SurfaceShape::Plane { normal: [0.0, 0.0, -1.0], offset: 3.0 };
        assert_eq!(of(plane, &[mirror]), expected);
        let slab = HalfSpace::slab([0.0, 4.0, 0.0], 7.0, 9.0, None);
        assert_eq!(of(slab.clone(), &[]), SurfaceShape::Plane { normal: [0.0, 1.0, 0.0], offset: 2.0 });
        assert_eq!(of(slab, &[mirror]), SurfaceShape::Plane { normal: [0.0, 1.0, 0.0], offset: 2.0 });
    }

    /// Far from the origin, too, the radius has as many digits as the given numbers.
    #[test]
    fn balls_cylinders_cones_and_tori() {
        let far = |at: [f64; 3]| Affine::translation(at).unwrap();
        let ball = HalfSpace::power([(-1.0, 1.0, 2), (-1.0, 0.0, 2), (-1.0, 0.0, 2)], 0.25).unwrap();
        for placements in [&[][..], &[turn()], &[far([1e6, -1e6, 1e6])]] {
            let SurfaceShape::Ball { centre, radius } = of(ball.clone(), placements) else { panic!() };
            let wanted = placements.iter().fold([1.0, 0.0, 0.0], |at, placement| placement.apply(at));
            assert_near(&centre, &wanted);
            assert_near(&[radius], &[0.5]);
        }
        let rod = HalfSpace::power([(1.0, 3.0, 2), (1.0, 0.0, 2), (0.0, 0.0, 2)], -4.0).unwrap();
        let expected = SurfaceShape::Cylinder { point: [3.0, 0.0, 0.0], axis: [0.0, 0.0, 1.0], radius: 2.0 };
        assert_eq!(of(rod.clone(), &[]), expected);
        let SurfaceShape::Cylinder { point, axis, radius } = of(rod.clone(), &[turn(), turn()]) else {
            panic!()
        };
        assert_near(&[radius, dot(point, axis)], &[2.0, 0.0]);
        let [on, other] = [[3.0, 0.0, 0.0], [3.0, 0.0, 1.0]].map(|p| turn().apply(turn().apply(p)));
        assert_near(&across(minus(on, point), axis), &[0.0; 3]);
        assert_near(&[dot(minus(other, on), axis).abs()], &[1.0]);
        // 9 (x² + y²) = 16 (z − 2)².
        let cone = HalfSpace::power([(-9.0, 0.0, 2), (-9.0, 0.0, 2), (16.0, 2.0, 2)], 0.0).unwrap();
        for placements in [&[][..], &[turn()], &[turn(), turn(), turn()]] {
            let SurfaceShape::Cone { apex, half_angle, axis } = of(cone.clone(), placements) else {
                panic!()
            };
            let wanted = placements.iter().rev().fold([0.0, 0.0, 2.0], |at, placement| placement.apply(at));
            assert_near(&apex, &wanted);
            assert_near(&[libm::tan(half_angle), dot(axis, axis)], &[4.0 / 3.0, 1.0]);
        }
        let ring = HalfSpace::torus(5.0, 1.0).unwrap();
        let twice = [[0.0, 0.0, 2.0, 1.0], [2.0, 0.0, 0.0, 2.0], [0.0, 2.0, 0.0, 3.0]];
        let SurfaceShape::Torus { centre, axis, major, minor } =
            of(ring.clone(), &[Affine::new(twice).unwrap()])
        else {
            panic!()
        };
        assert_eq!((centre, axis, major, minor), ([1.0, 2.0, 3.0], [1.0, 0.0, 0.0], 10.0, 2.0));
        let wide = [[1.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        assert_eq!(of(ring, &[Affine::new(wide).unwrap()]), SurfaceShape::Other);
        // Stretched shapes are none of these.
        for shape in [ball, rod, cone].map(|shape| of(shape, &[Affine::new(wide).unwrap()])) {
            assert_eq!(shape.name(), "quadric");
        }
    }

    #[test]
    fn others() {
        let of = |coefficients: [f64; 10]| of(HalfSpace::quadric(coefficients).unwrap(), &[]).name();
        // A paraboloid, two hyperboloids, two planes, no point at all.
        assert_eq!(of([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0]), "quadric");
        assert_eq!(of([1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]), "quadric");
        assert_eq!(of([1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), "quadric");
        assert_eq!(of([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]), "quadric");
        assert_eq!(of([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), "quadric");
        assert_eq!(of([1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), "cone");
        let powers = HalfSpace::power([(1.0, 0.0, 4), (1.0, 0.0, 4), (1.0, 0.0, 4)], -1.0).unwrap();
        assert_eq!(self::of(powers, &[]), SurfaceShape::Other);
    }

    /// Normals are gradients: a short step along them, to either side, crosses the surface.
    #[test]
    fn normals() {
        let cases = [
            (SurfaceShape::Ball { centre: [1.0, 0.0, 0.0], radius: 2.0 }, [3.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
            (
                SurfaceShape::Cylinder { point: [0.0; 3], axis: [0.0, 0.0, 1.0], radius: 2.0 },
                [0.0, -2.0, 9.0],
                [0.0, -1.0, 0.0],
            ),
            (
                SurfaceShape::Torus { centre: [0.0; 3], axis: [0.0, 0.0, 1.0], major: 3.0, minor: 1.0 },
                [2.0, 0.0, 0.0],
                [-1.0, 0.0, 0.0],
            ),
            (
                SurfaceShape::Cone {
                    apex: [0.0; 3],
                    axis: [0.0, 0.0, 1.0],
                    half_angle: core::f64::consts::FRAC_PI_4,
                },
                [1.0, 0.0, -1.0],
                [0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt()],
            ),
            (
                SurfaceShape::Quadric { coefficients: [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0] },
                [1.0, 5.0, 5.0],
                [1.0, 0.0, 0.0],
            ),
        ];
        for (shape, at, wanted) in cases {
            assert_near(&shape.normal(at).unwrap(), &wanted);
        }
        assert_eq!(SurfaceShape::Ball { centre: [0.0; 3], radius: 1.0 }.normal([0.0; 3]), None);
    }
}
