//! Enclosures of the boundary in a PARTIAL cell, to second order.

use crate::lattice::Each;

/// A region between two parallel planes that contains the boundary. All points of the cell on one side belong
/// to the solid, and no point on the other side does.
///
/// x is measured from the cell's centre, in half edges of the cell, so that the cell is [-1, 1]³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// The direction n out of the solid, of any length. Zero means that there is no slab.
    pub normal: [f64; 3],
    /// The inner bound: a point x with n · x < inner lies in the solid. It may be −∞, and is at most `outer`.
    pub inner: f64,
    /// The outer bound: a point x with n · x > outer lies outside the solid. It may be ∞.
    pub outer: f64,
}

impl Slab {
    /// The absent slab.
    pub(crate) const NONE: Slab = Slab { normal: [0.0; 3], inner: f64::NEG_INFINITY, outer: f64::INFINITY };

    /// The offset as a share of the greatest offset of a point of the cell.
    fn share(&self, offset: f64) -> f64 {
        offset / self.normal.iter().map(|c| c.abs()).sum::<f64>()
    }

    /// The slab of the complement.
    #[must_use]
    pub fn complement(&self) -> Slab {
        Slab { normal: self.normal.each(|c| -c), inner: -self.outer, outer: -self.inner }
    }
}

/// The way in which slabs are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlabJoin {
    /// A point is inside if it is inside all slabs, and outside if it is outside one slab.
    All,
    /// A point is inside if it is inside one slab, and outside if it is outside all slabs.
    Any,
}

/// One to three slabs that enclose the boundary of a solid in an open cell.
///
/// # Law
/// With [`SlabJoin::All`] the solid contains { x in the open cell : n · x < inner for all slabs } and does
/// not meet { x in the open cell : n · x > outer for some slab }. With [`SlabJoin::Any`], *some* and *all*
/// change places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure {
    /// The slabs. A slab with normal zero does not count.
    pub slabs: [Slab; 3],
    /// The way in which the slabs are joined.
    pub join: SlabJoin,
    /// The greatest angle (radians) between a normal of the boundary in the cell and the normal of the first
    /// slab; ∞ if it is unknown.
    pub cone: f64,
}

impl Enclosure {
    /// The enclosure by one slab with its cone; `None` if the slab is invalid or encloses nothing.
    pub(crate) fn of_one(slab: Slab, cone: f64) -> Option<Enclosure> {
        let Slab { normal, inner, outer } = slab;
        let is_slab = normal.iter().all(|c| c.is_finite()) && normal != [0.0; 3] && inner <= outer;
        let is_known = inner > f64::NEG_INFINITY || outer < f64::INFINITY;
        let slabs = [slab, Slab::NONE, Slab::NONE];
        (is_slab && is_known).then_some(Enclosure { slabs, join: SlabJoin::All, cone })
    }

    /// The enclosure of an intersection, from the enclosures of its operands. An operand without an enclosure
    /// leaves the inner side open. So do more than three slabs: then the slabs that cut off most are kept.
    pub(crate) fn of_intersection(operands: impl Iterator<Item = Option<Enclosure>>) -> Option<Enclosure> {
        let mut slabs = [Slab::NONE; 3];
        let (mut count, mut is_whole) = (0, true);
        for operand in operands {
            let Some(known) = operand else {
                is_whole = false;
                continue;
            };
            let is_slab = |slab: &Slab| slab.normal != [0.0; 3];
            let mut own = known.slabs;
            is_whole &= own.iter().any(is_slab);
            if known.join == SlabJoin::Any && own.iter().filter(|slab| is_slab(slab)).count() > 1 {
                // Each slab of a union proves that some points lie inside. The slab with most of these points
                // is kept.
                let best = own
                    .into_iter()
                    .filter(is_slab)
                    .max_by(|a, b| a.share(a.inner).total_cmp(&b.share(b.inner)));
                own = [Slab { outer: f64::INFINITY, ..best.unwrap_or(Slab::NONE) }, Slab::NONE, Slab::NONE];
            }
            for slab in own.into_iter().filter(is_slab) {
                if count < 3 {
                    slabs[count] = slab;
                    count += 1;
                    continue;
                }
                is_whole = false;
                let widest = slabs.iter_mut().max_by(|a, b| a.share(a.outer).total_cmp(&b.share(b.outer)));
                if let Some(widest) =
                    widest.filter(|widest| slab.share(slab.outer) < widest.share(widest.outer))
                {
                    *widest = slab;
                }
            }
        }
        if !is_whole {
            slabs.iter_mut().for_each(|slab| slab.inner = f64::NEG_INFINITY);
        }
        let is_known =
            slabs[..count].iter().any(|slab| slab.inner > f64::NEG_INFINITY || slab.outer < f64::INFINITY);
        is_known.then_some(Enclosure { slabs, join: SlabJoin::All, cone: f64::INFINITY })
    }

    /// The enclosure of the complement; its complement is this one, bit for bit.
    #[must_use]
    pub fn complement(&self) -> Enclosure {
        let join = match self.join {
            SlabJoin::All => SlabJoin::Any,
            SlabJoin::Any => SlabJoin::All,
        };
        Enclosure { slabs: self.slabs.each(|slab| slab.complement()), join, cone: self.cone }
    }
}

/// A segment between two points, in model units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// The first end point.
    pub from: [f64; 3],
    /// The second end point.
    pub to: [f64; 3],
}

/// A crossing of a segment with the boundary of a solid.
///
/// # Law
/// The bits of the crossing are the same whichever cell is queried for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The parameter of the point from + t (to − from), 0 ≤ t ≤ 1.
    pub t: f64,
    /// A direction out of the solid at that point, of any length.
    pub normal: [f64; 3],
}

impl Crossing {
    /// The crossing with the complement.
    #[must_use]
    pub fn complement(&self) -> Crossing {
        Crossing { t: self.t, normal: self.normal.each(|c| -c) }
    }
}
