//! The fingerprint of an expression, computed from its parts without recursion.

use super::{Csg, Join, Kind, MOST, Node};
use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use crate::memory;
use crate::solid::half_space::torus::Torus;
use crate::solid::half_space::{HalfSpace, Surface};
use crate::solid::{Fingerprint, Fingerprinter, Solid};
use alloc::vec::Vec;

impl Csg {
    /// Returns the fingerprint of all numbers of the expression in their order; `None` if a part has none.
    /// O(n) in the expression written out.
    pub(super) fn fingerprint_of_expression(&self) -> Option<Fingerprint> {
        if self.root.size > MOST {
            return None;
        }
        let mut tasks: Vec<(&Node, bool)> = Vec::new();
        let mut found: Vec<Fingerprint> = Vec::new();
        memory::push(&mut tasks, (&self.root, false)).ok()?;
        while let Some((node, parts_found)) = tasks.pop() {
            let parts = match &node.kind {
                Kind::HalfSpace(_) | Kind::Solid(_) => &[][..],
                Kind::Join(_, parts) => parts,
                Kind::Complement(part) | Kind::Placed(part, _) => core::slice::from_ref(part),
            };
            if !parts_found && !parts.is_empty() {
                memory::push(&mut tasks, (node, true)).ok()?;
                tasks.try_reserve(parts.len()).ok()?;
                tasks.extend(parts.iter().rev().map(|part| (&**part, false)));
                continue;
            }
            let fingerprint = match &node.kind {
                Kind::HalfSpace(half_space) => half_space.fingerprint()?,
                Kind::Solid(solid) => solid.fingerprint()?,
                Kind::Join(join, _) => {
                    let name = match join {
                        Join::Intersection => "csg intersection",
                        Join::Union => "csg union",
                        Join::Parity => "csg parity",
                    };
                    let own = found.len() - parts.len();
                    found.drain(own..).fold(Fingerprinter::new(name), Fingerprinter::part).finish()
                }
                Kind::Complement(_) => Fingerprinter::new("csg complement").part(found.pop()?).finish(),
                Kind::Placed(_, placement) => {
                    let rows = placement.rows().as_flattened();
                    Fingerprinter::new("csg placed").part(found.pop()?).numbers(rows).finish()
                }
            };
            memory::push(&mut found, fingerprint).ok()?;
        }
        let whole = Fingerprinter::new("csg").part(found.pop()?).integers(&[self.touch as u64]);
        Some(whole.finish())
    }
}

impl HalfSpace {
    fn fingerprint(&self) -> Option<Fingerprint> {
        let all = match &*self.0 {
            // A plane counts as a quadric without squares and products.
            Surface::Plane(plane) => {
                let zero = Dyadic::zero();
                let all = core::iter::repeat_n(&zero, 6).chain(plane);
                all.fold(Fingerprinter::new("quadric"), |all, c| c.taken_in(all))
            }
            Surface::Quadric(coefficients) => {
                coefficients.iter().fold(Fingerprinter::new("quadric"), |all, c| c.taken_in(all))
            }
            Surface::Powers(powers) => {
                let terms = powers
                    .terms
                    .each(|(coefficient, centre, exponent)| [coefficient, centre, exponent as f64]);
                Fingerprinter::new("powers").numbers(terms.as_flattened()).numbers(&[powers.constant])
            }
            Surface::Torus(Torus { major, square, scale, shift }) => [major, square, scale, shift]
                .iter()
                .fold(Fingerprinter::new("torus"), |all, c| c.taken_in(all)),
            // (Slabs occur only in stored octrees, never in expressions.)
            Surface::Slab(_) => return None,
            Surface::Host(host) => Fingerprinter::new("host half-space").part(host.fingerprint?),
        };
        Some(all.finish())
    }
}

impl Dyadic {
    /// Returns the fingerprint with this number added.
    fn taken_in(&self, all: Fingerprinter) -> Fingerprinter {
        let (mantissa, exponent) = self.bytes();
        all.bytes(&mantissa).integers(&[exponent as u64])
    }
}
