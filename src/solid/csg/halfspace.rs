//! Half-spaces: what all primitives are made of.

use super::bounds::{Octants, Sides};
use super::dyadic::Dyadic;
use super::map::ExactMap;
use super::quadric::{Coefficients, Quadric};
use crate::error::Error;
use crate::lattice::Frame;
use crate::solid::is_moderate;
use alloc::boxed::Box;
use alloc::sync::Arc;

/// The points with f(x, y, z) ≥ 0, for one function f. Cheap to clone.
///
/// f is that of exactly the doubles given, and its signs are exact: no rounding decides anything.
#[derive(Clone)]
pub struct HalfSpace(pub(super) Arc<Surface>);

/// The function of a half-space, in the space in which it was given.
pub(super) enum Surface {
    /// Of degree one or two.
    Quadric(Box<Coefficients>),
}

impl HalfSpace {
    /// `normal` · p + `offset` ≥ 0; the normal, of any length, points into the half-space.
    ///
    /// # Errors
    /// [`Error::Argument`] if the normal is zero, or a number is not zero and not of a magnitude between 2^-256 and
    /// 2^256.
    pub fn plane(normal: [f64; 3], offset: f64) -> Result<HalfSpace, Error> {
        if normal == [0.0; 3] {
            return Err(Error::Argument { name: "normal", problem: "must not be zero" });
        }
        let problem = "every number must be zero or of a magnitude between 2^-256 and 2^256";
        for (name, numbers) in [("normal", &normal[..]), ("offset", &[offset])] {
            if !numbers.iter().all(|&c| c == 0.0 || is_moderate(c)) {
                return Err(Error::Argument { name, problem });
            }
        }
        let [x, y, z] = normal;
        HalfSpace::quadric([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, x, y, z, offset])
    }

    /// a x² + b y² + c z² + d xy + e yz + f zx + g x + h y + i z + j ≥ 0 for the `coefficients` a to j.
    ///
    /// # Errors
    /// [`Error::Argument`] if all but the last are zero, or one is not zero and not of a magnitude between 2^-256 and
    /// 2^256.
    pub fn quadric(coefficients: [f64; 10]) -> Result<HalfSpace, Error> {
        let refuse = |problem| Err(Error::Argument { name: "coefficients", problem });
        if !coefficients.iter().all(|&c| c == 0.0 || is_moderate(c)) {
            return refuse("every number must be zero or of a magnitude between 2^-256 and 2^256");
        }
        if coefficients[..9].iter().all(|&c| c == 0.0) {
            return refuse("must not all be zero but the last: the function would be constant");
        }
        Ok(HalfSpace::exactly(coefficients.map(Dyadic::new)))
    }

    /// Of coefficients in the order of [`quadric`](Self::quadric) that need not be doubles, of which one but the last
    /// is not zero.
    pub(super) fn exactly(coefficients: Coefficients) -> HalfSpace {
        HalfSpace(Arc::new(Surface::Quadric(Box::new(coefficients))))
    }
}

/// A half-space on a universe: f in unit coordinates, times something positive.
pub(super) enum Placed {
    Quadric(Quadric),
}

impl Surface {
    /// The half-space as `map` shows it on the universe of `frame`.
    pub(super) fn on(&self, map: &ExactMap, frame: &Frame) -> Placed {
        match self {
            Surface::Quadric(coefficients) => Placed::Quadric(Quadric::new(coefficients, map, frame.depth())),
        }
    }
}

impl Placed {
    /// For which of the eight cells f is proven not negative, and not positive.
    #[inline(always)]
    pub(super) fn sides(&self, at: &Octants) -> Sides {
        match self {
            Placed::Quadric(quadric) => quadric.sides(at),
        }
    }

    /// Exact sign of f at a point of the universe.
    #[inline]
    pub(super) fn sign_at(&self, t: [f64; 3]) -> i32 {
        match self {
            Placed::Quadric(quadric) => quadric.sign_at(t),
        }
    }

    /// Whether the centre `t` of a cell is inside, shifted by (ε, ε², ε³) if it lies on the surface.
    #[inline]
    pub(super) fn contains(&self, t: [f64; 3]) -> bool {
        match self.sign_at(t) {
            0 => match self {
                Placed::Quadric(quadric) => quadric.shifted_sign_at(t) > 0,
            },
            sign => sign > 0,
        }
    }
}
