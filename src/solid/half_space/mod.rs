//! Half-spaces: the building blocks of all primitives.

pub(crate) mod bounds;
mod bytes;
pub(crate) mod contact;
pub(crate) mod function;
mod host;
pub(crate) mod identity;
pub(crate) mod joined;
mod likeness;
pub(crate) mod linear;
pub(crate) mod lines;
pub(crate) mod literals;
pub(crate) mod map;
mod open;
mod pencil;
mod plane;
pub(crate) mod points;
pub(crate) mod possible;
pub(crate) mod power;
pub(crate) mod quadric;
mod quantised;
pub(crate) mod record;
pub(crate) mod residue;
mod round;
mod shape;
mod slab;
pub(crate) mod sweep;
pub(crate) mod table;
pub(crate) mod tangent;
mod terms;
pub(crate) mod torus;

use crate::cut::Taylor;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{DoubleDouble, Dyadic, sign};
use crate::lattice::{Frame, Interval, valid};
use crate::octree::cuts::{CellSlab, Origin};
use crate::solid::Fingerprint;
use alloc::boxed::Box;
use alloc::sync::Arc;
use bounds::{Octants, Sides, mask};
use host::{Host, PlacedHost};
use map::ExactMap;
pub use open::{OpenSurfaces, PlacedHalfSpace};
use plane::Plane;
use power::{PlacedPowers, Powers};
use quadric::{Coefficients, Quadric};
pub(crate) use round::{Form, Round};
pub use shape::SurfaceShape;
use slab::{PlacedSlab, SlabIdentity, ThickPlane};
use tangent::Tangent;
use torus::{PlacedTorus, Torus};
use wide::f64x4;

/// The points with f(x, y, z) ≥ 0, for one function f. Cheap to clone.
///
/// f has exactly the given doubles as its numbers, and its signs are exact: no rounding decides anything.
/// (For a host program's function, the program is responsible for the signs.)
#[derive(Clone)]
pub struct HalfSpace(pub(crate) Arc<Surface>);

/// The function of a half-space, in the space in which it was given.
pub(crate) enum Surface {
    /// a x + b y + c z + d.
    Plane([Dyadic; 4]),
    /// A polynomial of degree two.
    Quadric(Box<Coefficients>),
    Powers(Powers),
    Torus(Torus),
    Host(Arc<Host>),
    Slab(ThickPlane),
}

/// The largest exponent of a power.
const LARGEST_EXPONENT: u32 = 64;

impl HalfSpace {
    /// Returns the half-space `normal` · p + `offset` ≥ 0. The normal, of any length, points into the
    /// half-space.
    ///
    /// # Errors
    /// [`Error::Argument`] if the normal is zero, or if a number is neither zero nor of a magnitude between
    /// 2^-256 and 2^256.
    pub fn plane(normal: [f64; 3], offset: f64) -> Result<HalfSpace, Error> {
        if normal == [0.0; 3] {
            return Err(Error::Argument { name: "normal", problem: "must not be zero" });
        }
        valid::numbers("normal", &normal)?;
        valid::numbers("offset", &[offset])?;
        let [x, y, z] = normal;
        Ok(HalfSpace::linear([x, y, z, offset].each(Dyadic::new)))
    }

    /// Returns the half-space a x² + b y² + c z² + d xy + e yz + f zx + g x + h y + i z + j ≥ 0 for the
    /// `coefficients` a to j.
    ///
    /// # Errors
    /// [`Error::Argument`] if all coefficients but the last are zero, or if one is neither zero nor of a
    /// magnitude between 2^-256 and 2^256.
    pub fn quadric(coefficients: [f64; 10]) -> Result<HalfSpace, Error> {
        valid::numbers("coefficients", &coefficients)?;
        if coefficients[..9].iter().all(|&c| c == 0.0) {
            let problem = "must not all be zero but the last: the function would be constant";
            return Err(Error::Argument { name: "coefficients", problem });
        }
        Ok(HalfSpace::exactly(coefficients.each(Dyadic::new)))
    }

    /// Returns the half-space A (x − a)^n + B (y − b)^m + C (z − c)^k + `constant` ≥ 0, for the `terms` (A,
    /// a, n), (B, b, m) and (C, c, k). A coefficient of 0 omits its term.
    ///
    /// Least and greatest values over a cell are exact under placements that map axes to axes, and bounded
    /// outward under other placements.
    ///
    /// # Errors
    /// [`Error::Argument`] if all coefficients are zero, if an exponent is not 1 to 64, or if a number is
    /// neither zero nor of a magnitude between 2^-256 and 2^256.
    pub fn power(terms: [(f64, f64, u32); 3], constant: f64) -> Result<HalfSpace, Error> {
        valid::numbers("terms", terms.each(|(coefficient, centre, _)| [coefficient, centre]).as_flattened())?;
        valid::numbers("constant", &[constant])?;
        if !terms.iter().all(|&(.., exponent)| (1..=LARGEST_EXPONENT).contains(&exponent)) {
            return Err(Error::Argument { name: "terms", problem: "every exponent must be 1 to 64" });
        }
        if terms.iter().all(|&(coefficient, ..)| coefficient == 0.0) {
            let problem = "must have a coefficient that is not zero: the function would be constant";
            return Err(Error::Argument { name: "terms", problem });
        }
        let is_quadratic =
            |&(coefficient, _, exponent): &(f64, f64, u32)| coefficient == 0.0 || exponent <= 2;
        if !terms.iter().all(is_quadratic) {
            return Ok(HalfSpace(Arc::new(Surface::Powers(Powers { terms, constant }))));
        }
        let [mut squares, mut linear] = [0.0; 2].each(|c| [c; 3].each(Dyadic::new));
        let mut constant = Dyadic::new(constant);
        for (axis, (coefficient, centre, exponent)) in terms.into_iter().enumerate() {
            let (coefficient, centre) = (Dyadic::new(coefficient), Dyadic::new(centre));
            let times_centre = &coefficient * &centre;
            if exponent == 1 {
                constant = &constant - &times_centre;
                linear[axis] = coefficient;
            } else {
                constant = &constant + &(&times_centre * &centre);
                linear[axis] = -&times_centre.shifted(1);
                squares[axis] = coefficient;
            }
        }
        Ok(HalfSpace::separable(squares, linear, constant))
    }

    /// Returns the torus around the z axis: all points at most `minor` from the circle of radius `major` in
    /// the plane z = 0. Where `minor` is greater than `major`, the ring is closed in the middle, and there is
    /// no hollow core.
    ///
    /// # Errors
    /// [`Error::Argument`] if a radius is not between 2^-256 and 2^256; `major` may also be 0, which makes a
    /// ball.
    pub fn torus(major: f64, minor: f64) -> Result<HalfSpace, Error> {
        valid::length("minor", minor)?;
        if major != 0.0 {
            valid::length("major", major)?;
        } else {
            let [squares, linear] = [-1.0, 0.0].each(|c| [c; 3].each(Dyadic::new));
            return Ok(HalfSpace::separable(squares, linear, Dyadic::new(minor).pow(2)));
        }
        let [major, minor, scale, shift] = [major, minor, 1.0, 0.0].each(Dyadic::new);
        Ok(HalfSpace::ring(Torus { major, square: minor.pow(2), scale, shift }))
    }

    /// Returns a torus whose numbers need not be doubles.
    pub(crate) fn ring(torus: Torus) -> HalfSpace {
        HalfSpace(Arc::new(Surface::Torus(torus)))
    }

    /// Returns a half-space that a host program supplies. f is given by its `value` at a point and its
    /// `range` over a box (lower and upper corner), in model units; under a placement, in the space of the
    /// half-space.
    ///
    /// A range must contain all values that f has in the box. Only ranges prove anything: a cell is FULL if
    /// its range is nowhere negative, and EMPTY if its range is nowhere positive. The range is taken over a
    /// box around the cell (the cell itself, if its corners are doubles). Values are evaluated first. A cell
    /// with vertices on both sides needs no range, so values need not be exact. Values also decide single
    /// points, at the point's rounded image, where zero is inside. A NaN value, and a range with a NaN or
    /// with `lower > upper`, decide nothing.
    ///
    /// Several threads call both functions at once, and the functions must give the same answer to the same
    /// arguments. An error, such as [`Error::Callback`], ends the operation, which returns it. The
    /// `fingerprint` is the promise that functions with the same fingerprint are the same. Without one, no
    /// expression that contains the half-space has a fingerprint.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Interval, Rule, build, solid::HalfSpace};
    /// // z ≤ exp(−x²), whose extremes over a box lie where |x| is least and greatest.
    /// let hill = HalfSpace::host(
    ///     |[x, _, z]| Ok((-x * x).exp() - z),
    ///     |min, max| {
    ///         let far = min[0].abs().max(max[0].abs());
    ///         let near = if min[0] <= 0.0 && max[0] >= 0.0 { 0.0 } else { min[0].abs().min(max[0].abs()) };
    ///         // A margin of some last places for rounding.
    ///         Ok(Interval::new((-far * far).exp() - max[2] - 1e-14, (-near * near).exp() - min[2] + 1e-14).unwrap())
    ///     },
    ///     None,
    /// );
    /// let part = Csg::intersection_of([hill.into(), Csg::cuboid([-1.0, 0.0, 0.0], [1.0, 1.0, 2.0])?])?;
    /// let tree = build(&part, &Frame::new([-1.0; 3], 2.0, 6)?, Rule::Certified, &Control::default())?;
    /// assert!(tree.statistics().volume().contains(1.493648));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn host(
        value: impl Fn([f64; 3]) -> Result<f64, Error> + Send + Sync + 'static,
        range: impl Fn([f64; 3], [f64; 3]) -> Result<Interval, Error> + Send + Sync + 'static,
        fingerprint: Option<Fingerprint>,
    ) -> HalfSpace {
        let host = Host { value: Box::new(value), range: Box::new(range), fingerprint };
        HalfSpace(Arc::new(Surface::Host(Arc::new(host))))
    }

    /// Returns the points with `normal` · p ≤ `inner`, and perhaps others with `normal` · p ≤ `outer`.
    pub(crate) fn slab(
        normal: [f64; 3],
        inner: f64,
        outer: f64,
        identity: Option<SlabIdentity>,
    ) -> HalfSpace {
        HalfSpace(Arc::new(Surface::Slab(ThickPlane { normal, inner, outer, identity, cell_slab: None })))
    }

    /// Returns whether the half-space is a layer: a plane with a width.
    pub(crate) fn is_layer(&self) -> bool {
        matches!(&*self.0, Surface::Slab(_))
    }

    /// Returns the slab with the given identity: its origin and its number there, or `None` if these are
    /// unknown. Returns any other half-space unchanged.
    pub(crate) fn identified(&self, identity: Option<(Origin, u64)>) -> HalfSpace {
        match &*self.0 {
            &Surface::Slab(ThickPlane { normal, inner, outer, cell_slab, .. }) => {
                let identity = identity.map(|(origin, number)| SlabIdentity { origin, number });
                let slab = ThickPlane { normal, inner, outer, identity, cell_slab };
                HalfSpace(Arc::new(Surface::Slab(slab)))
            }
            _ => self.clone(),
        }
    }

    /// Returns the number of a slab among all slabs of its origin, if it is known.
    pub(crate) fn slab_number(&self) -> Option<u64> {
        match &*self.0 {
            Surface::Slab(ThickPlane { identity, cell_slab, .. }) => {
                cell_slab.map(CellSlab::number).or(identity.as_ref().map(|identity| identity.number))
            }
            _ => None,
        }
    }

    /// Returns the half-space of coefficients in the order of [`quadric`](Self::quadric). They need not be
    /// doubles, and one of them besides the last must not be zero.
    pub(crate) fn exactly(coefficients: Coefficients) -> HalfSpace {
        if coefficients[..6].iter().all(Dyadic::is_zero) {
            let [.., x, y, z, one] = coefficients;
            return HalfSpace::linear([x, y, z, one]);
        }
        HalfSpace(Arc::new(Surface::Quadric(Box::new(coefficients))))
    }

    /// Returns the half-space of a sum: `squares` times x², y² and z², `linear` times x, y and z, and a
    /// constant. A coefficient besides the constant must not be zero.
    pub(crate) fn separable(squares: [Dyadic; 3], linear: [Dyadic; 3], constant: Dyadic) -> HalfSpace {
        let ([xx, yy, zz], [x, y, z], zero) = (squares, linear, Dyadic::zero);
        HalfSpace::exactly([xx, yy, zz, zero(), zero(), zero(), x, y, z, constant])
    }

    /// Returns a x + b y + c z + d ≥ 0 for the coefficients a to d. One of them besides the last must not be
    /// zero.
    pub(crate) fn linear(coefficients: [Dyadic; 4]) -> HalfSpace {
        HalfSpace(Arc::new(Surface::Plane(coefficients)))
    }
}

/// A half-space on a universe: f in unit coordinates, up to a positive factor.
pub(crate) enum Placed {
    Plane(Plane),
    Quadric(Box<Quadric>),
    Powers(Box<PlacedPowers>),
    Torus(Box<PlacedTorus>),
    Host(Box<PlacedHost>),
    Slab(Box<PlacedSlab>),
}

impl Surface {
    /// Returns the image of the half-space under `map` on the universe of `frame`.
    pub(crate) fn on(&self, map: &ExactMap, frame: &Frame) -> Placed {
        match self {
            Surface::Plane(plane) => Placed::Plane(Plane::new(plane, map, frame.depth())),
            Surface::Quadric(coefficients) => {
                Placed::Quadric(Box::new(Quadric::new(coefficients, map, frame.depth())))
            }
            Surface::Powers(powers) => Placed::Powers(Box::new(PlacedPowers::new(powers, map))),
            Surface::Torus(torus) => Placed::Torus(Box::new(PlacedTorus::new(torus, map))),
            Surface::Host(host) => Placed::Host(Box::new(PlacedHost::new(host, map, frame))),
            Surface::Slab(slab) => Placed::Slab(Box::new(PlacedSlab::new(slab, map))),
        }
    }
}

impl Placed {
    /// Returns for which of the cells `wanted` f is proven not negative, and not positive; counts the
    /// evaluations.
    #[inline(always)]
    pub(crate) fn sides(&self, at: &Octants, wanted: u8, evaluations: &mut u64) -> Result<Sides, Error> {
        *evaluations += wanted.count_ones() as u64;
        Ok(match self {
            Placed::Plane(plane) => plane.sides(at),
            Placed::Quadric(quadric) => quadric.sides(at),
            _ => return self.sides_of_others(at, wanted, evaluations),
        })
    }

    /// [`sides`](Self::sides) for all kinds except planes and quadrics, which are the fastest by far.
    #[inline(never)]
    fn sides_of_others(&self, at: &Octants, wanted: u8, evaluations: &mut u64) -> Result<Sides, Error> {
        Ok(match self {
            Placed::Powers(powers) => powers.sides(at),
            Placed::Torus(torus) => torus.sides(at),
            Placed::Host(host) => {
                // The host counts its own calls.
                *evaluations -= wanted.count_ones() as u64;
                host.sides(at, wanted, evaluations)?
            }
            Placed::Slab(slab) => slab.sides(at),
            Placed::Plane(_) | Placed::Quadric(_) => Sides { inside: 0, outside: 0 },
        })
    }

    /// Returns linear bounds of f over the cube of half edge `half` around `centre`, both in unit
    /// coordinates. `None` for functions of the host.
    #[inline]
    pub(crate) fn tangent(&self, centre: [f64; 3], half: f64) -> Option<Tangent> {
        Some(match self {
            Placed::Plane(plane) => plane.tangent(centre, half),
            Placed::Quadric(quadric) => quadric.tangent(centre, half),
            Placed::Powers(powers) => powers.tangent(centre, half),
            Placed::Torus(torus) => torus.tangent(centre, half),
            Placed::Slab(slab) => slab.tangent(centre, half),
            Placed::Host(_) => return None,
        })
    }

    /// Returns f to second order over the cube of half edge `half` around `centre`, both in unit coordinates.
    /// `None` for functions of the host, and for slabs, because the normals of a slab's surface are unknown.
    #[inline]
    pub(crate) fn taylor(&self, centre: [f64; 3], half: f64) -> Option<Taylor> {
        Some(match self {
            Placed::Plane(plane) => plane.taylor(centre, half),
            Placed::Quadric(quadric) => quadric.taylor(centre, half),
            Placed::Powers(powers) => powers.taylor(centre, half),
            Placed::Torus(torus) => torus.taylor(centre, half),
            Placed::Host(_) | Placed::Slab(_) => return None,
        })
    }

    /// The most points in which a line that does not lie in the surface meets it. `None` for functions of the
    /// host and for slabs.
    pub(crate) fn degree(&self) -> Option<u32> {
        Some(match self {
            Placed::Plane(_) => 1,
            Placed::Quadric(_) => 2,
            Placed::Powers(powers) => powers.degree(),
            Placed::Torus(_) => 4,
            Placed::Host(_) | Placed::Slab(_) => return None,
        })
    }

    /// Returns whether the function is linear, or constant, along all lines parallel to an axis.
    pub(crate) fn is_linear_along(&self, axis: usize) -> bool {
        match self {
            Placed::Plane(_) => true,
            Placed::Quadric(quadric) => quadric.is_linear_along(axis),
            _ => false,
        }
    }

    /// Returns whether a piece of the surface may lie in a plane of the lattice, which has 2^depth cells
    /// along an axis.
    pub(crate) fn may_hold_lattice_plane(&self, depth: u8) -> bool {
        match self {
            Placed::Plane(plane) => plane.is_of_lattice(depth),
            Placed::Quadric(quadric) => quadric.may_hold_lattice_plane(),
            Placed::Powers(powers) => powers.may_hold_lattice_plane(),
            Placed::Torus(_) => false,
            Placed::Host(_) | Placed::Slab(_) => true,
        }
    }

    /// For a plane with a width: more than the distance by which its ends are moved outward to cover the
    /// rounding of a value. `None` for others.
    pub(crate) fn layer_slack(&self) -> Option<f64> {
        match self {
            Placed::Slab(slab) => Some(slab.slack()),
            _ => None,
        }
    }

    /// Returns whether a piece of the surface may lie in a face of a cell that the surface crosses. (A plane
    /// in a face does not cross the cell.)
    pub(crate) fn may_hold_face(&self) -> bool {
        !matches!(self, Placed::Plane(_)) && self.may_hold_lattice_plane(0)
    }

    /// Returns in which of the eight cells the centre is surely inside, and in which surely outside, if this
    /// is cheap to decide.
    #[inline(always)]
    pub(crate) fn centres(&self, at: &Octants) -> (u8, u8) {
        let (values, error) = match self {
            Placed::Plane(plane) => plane.centres(at),
            Placed::Quadric(quadric) => quadric.centres(at),
            _ => return (0, 0),
        };
        (
            mask(values.each(|v| v.simd_gt(f64x4::splat(error)))),
            mask(values.each(|v| v.simd_lt(f64x4::splat(-error)))),
        )
    }

    /// Returns the exact sign of f at a point of the universe. `None` if the host does not know it, or if the
    /// point lies in a slab.
    #[inline]
    pub(crate) fn sign_at(&self, t: [f64; 3]) -> Result<Option<i32>, Error> {
        Ok(Some(match self {
            Placed::Plane(plane) => plane.sign_at(t),
            Placed::Quadric(quadric) => quadric.sign_at(t),
            Placed::Powers(powers) => powers.sign_at(t),
            Placed::Torus(torus) => torus.sign_at(t),
            Placed::Host(host) => return Ok(host.value_at(t)?.map(sign)),
            Placed::Slab(slab) => return Ok(slab.sign_at(t)),
        }))
    }

    /// Returns whether the centre `t` of a cell is inside, shifted by (ε, ε², ε³) if it lies on the surface.
    /// `None` if the host does not know.
    #[inline]
    pub(crate) fn contains(&self, t: [f64; 3]) -> Result<Option<bool>, Error> {
        self.decided(t, self.sign_at(t)?)
    }

    /// Returns the answer of [`contains`](Self::contains) for any point of the universe.
    pub(crate) fn contains_off_lattice(&self, t: [f64; 3]) -> Result<Option<bool>, Error> {
        let sign = match self {
            Placed::Plane(plane) => Some(plane.sign_off_lattice(t)),
            Placed::Quadric(quadric) => Some(quadric.sign_off_lattice(t)),
            _ => self.sign_at(t)?,
        };
        self.decided(t, sign)
    }

    /// Returns f on a ray along `axis` through a point as a polynomial of degree two: the factors of 1, s and
    /// s² for the coordinate s, and more than the error of its values on the universe. `None` for surfaces
    /// that are neither planes nor quadrics.
    #[inline]
    pub(crate) fn along(&self, axis: usize, point: [f64; 3]) -> Option<([f64; 3], f64)> {
        match self {
            Placed::Plane(plane) => Some((plane.along(axis, point), plane.rounding())),
            Placed::Quadric(quadric) => Some((quadric.along(axis, point), quadric.rounding())),
            _ => None,
        }
    }

    /// Returns the polynomial of a quadric on a ray in numbers of 106 bits.
    pub(crate) fn finely_along(&self, axis: usize, point: [f64; 3]) -> Option<([DoubleDouble; 3], f64)> {
        match self {
            Placed::Quadric(quadric) => {
                Some((quadric.finely_along(axis, point), 64.0 * DoubleDouble::EPSILON * quadric.size()))
            }
            _ => None,
        }
    }

    /// More than the error of the values of planes and quadrics at points off the lattice.
    #[inline]
    pub(crate) fn rounding(&self) -> f64 {
        match self {
            Placed::Plane(plane) => plane.rounding(),
            Placed::Quadric(quadric) => quadric.rounding(),
            // The errors of other surfaces hold everywhere.
            _ => 0.0,
        }
    }

    #[inline]
    fn decided(&self, t: [f64; 3], sign: Option<i32>) -> Result<Option<bool>, Error> {
        let sign = match sign {
            Some(0) => match self {
                Placed::Plane(plane) => plane.shifted_sign(),
                Placed::Quadric(quadric) => quadric.shifted_sign_at(t),
                Placed::Powers(powers) => powers.shifted_sign_at(t),
                Placed::Torus(torus) => torus.shifted_sign_at(t),
                // The gradient is not known.
                Placed::Host(_) | Placed::Slab(_) => 1,
            },
            Some(sign) => sign,
            None => return Ok(None),
        };
        Ok(Some(sign > 0))
    }
}
