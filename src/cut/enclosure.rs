//! What may be known of a PARTIAL cell beyond its verdict: where the boundary lies in it, to second order.

/// What lies on one side of a plane belongs to the solid, and what lies on the other side of a parallel one
/// does not.
///
/// x is measured from the cell's centre, in half edges of the cell, so that the cell is [-1, 1]³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// The direction n that leads out of the solid, of any length. Zero: there is no slab.
    pub normal: [f64; 3],
    /// Where n · x is less, x lies in the solid. It may be −∞, and is at most `outer`.
    pub inner: f64,
    /// Where n · x is greater, x lies outside. It may be ∞.
    pub outer: f64,
}

impl Slab {
    /// No slab.
    pub(crate) const NONE: Slab = Slab { normal: [0.0; 3], inner: f64::NEG_INFINITY, outer: f64::INFINITY };

    /// An offset in units of the greatest one that a point of the cell has.
    fn share(&self, offset: f64) -> f64 {
        offset / self.normal.iter().map(|c| c.abs()).sum::<f64>()
    }

    /// The slab of the complement.
    #[must_use]
    pub fn complement(&self) -> Slab {
        Slab { normal: self.normal.map(|c| -c), inner: -self.outer, outer: -self.inner }
    }
}

/// How slabs are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlabJoin {
    /// A point is inside if all slabs say so, and outside if one does.
    All,
    /// A point is inside if one slab says so, and outside if all do.
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
    /// The slabs; those of normal zero do not count.
    pub slabs: [Slab; 3],
    /// How they are joined.
    pub join: SlabJoin,
    /// Every normal of the boundary in the cell lies within this angle (radians) of that of the first slab; ∞
    /// if nothing is known.
    pub cone: f64,
}

impl Enclosure {
    /// One slab with its cone; `None` if it says nothing, or is none.
    pub(crate) fn of_one(slab: Slab, cone: f64) -> Option<Enclosure> {
        let Slab { normal, inner, outer } = slab;
        let is_slab = normal.iter().all(|c| c.is_finite()) && normal != [0.0; 3] && inner <= outer;
        let is_known = inner > f64::NEG_INFINITY || outer < f64::INFINITY;
        let slabs = [slab, Slab::NONE, Slab::NONE];
        (is_slab && is_known).then_some(Enclosure { slabs, join: SlabJoin::All, cone })
    }

    /// What is known of an intersection by what is known of its operands. An operand of which nothing is
    /// known leaves the inner side open; so do more slabs than three, of which those are kept that cut off
    /// most.
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
                // Each slab of a union tells of points that lie inside. That one counts which holds most of
                // them.
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
        Enclosure { slabs: self.slabs.map(|slab| slab.complement()), join, cone: self.cone }
    }
}

/// A straight way between two points, in model units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Where it begins.
    pub from: [f64; 3],
    /// Where it ends.
    pub to: [f64; 3],
}

/// Where a segment crosses the boundary of a solid.
///
/// # Law
/// The bits are the same from whichever cell the crossing is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The point from + t (to − from), 0 ≤ t ≤ 1.
    pub t: f64,
    /// A direction that leads out of the solid there, of any length.
    pub normal: [f64; 3],
}

impl Crossing {
    /// The crossing as the complement has it.
    #[must_use]
    pub fn complement(&self) -> Crossing {
        Crossing { t: self.t, normal: self.normal.map(|c| -c) }
    }
}
