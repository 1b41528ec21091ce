//! The approximate memory of half-spaces. Exact numbers count by their digits, without spare capacity.

use super::{HalfSpace, Placed, Surface};
use crate::lattice::exact::Dyadic;
use crate::solid::half_space::host::Host;
use crate::solid::half_space::torus::Torus;

fn digits<'d>(numbers: impl IntoIterator<Item = &'d Dyadic>) -> usize {
    numbers.into_iter().map(Dyadic::heap_bytes).sum()
}

impl HalfSpace {
    /// The bytes of the function. The memory that a host's function holds is unknown.
    pub(crate) fn bytes(&self) -> usize {
        let beyond = match &*self.0 {
            Surface::Plane(plane) => digits(plane),
            Surface::Quadric(coefficients) => size_of_val(&**coefficients) + digits(&**coefficients),
            Surface::Torus(Torus { major, square, scale, shift }) => digits([major, square, scale, shift]),
            Surface::Host(_) => size_of::<Host>(),
            Surface::Powers(_) | Surface::Slab(_) => 0,
        };
        size_of::<Surface>() + beyond
    }
}

impl Placed {
    /// The bytes beside the value itself.
    pub(crate) fn heap_bytes(&self) -> usize {
        match self {
            Placed::Plane(plane) => plane.heap_bytes(),
            Placed::Quadric(quadric) => size_of_val(&**quadric) + quadric.heap_bytes(),
            Placed::Powers(powers) => size_of_val(&**powers) + powers.heap_bytes(),
            Placed::Torus(torus) => size_of_val(&**torus) + torus.heap_bytes(),
            Placed::Host(host) => size_of_val(&**host),
            Placed::Slab(slab) => size_of_val(&**slab),
        }
    }
}
