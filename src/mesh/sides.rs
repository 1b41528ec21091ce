//! The side of each triangle on which the solid lies, for integrals over parts of the triangle.

use super::intersections::{corners, intersections};
use super::sheets::{Sense, sheets};
use super::signs::volume_sign;
use super::tree::Search;
use super::triangle_mesh::{FillRule, TriangleMesh};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Interval;
use crate::memory;
use alloc::vec::Vec;

/// The known sides of triangles.
pub(crate) struct Sides {
    /// For each triangle: 1 if the solid lies behind all of it and not in front, −1 if the other way round, 0
    /// if on both sides or on neither; or [`Sides::UNKNOWN`] or [`Sides::FLAT`].
    senses: Vec<i8>,
    /// The pairs of triangles that intersect, each in both orders, ascending.
    pairs: Vec<[u32; 2]>,
}

impl Sides {
    /// Returns the bytes that the lists take.
    pub(crate) fn bytes(&self) -> usize {
        memory::bytes_of(&self.senses) + memory::bytes_of(&self.pairs)
    }

    /// A triangle that intersects others, or that belongs to an open surface.
    const UNKNOWN: i8 = 2;
    /// A triangle without area for which nothing else is known.
    const FLAT: i8 = 4;

    /// Returns the side of a triangle on which the solid lies, if it is the same everywhere on the triangle.
    #[inline(always)]
    pub(crate) fn of(&self, triangle: u32) -> Option<i8> {
        let sense = self.senses[triangle as usize];
        (sense < Sides::UNKNOWN).then_some(sense)
    }

    pub(crate) fn is_flat(&self, triangle: u32) -> bool {
        self.senses[triangle as usize] == Sides::FLAT
    }

    /// Returns for each triangle whether it belongs to the boundary of the solid; an empty list if all do.
    /// `None` if this is not known for all.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn boundary(&self) -> Result<Option<Vec<bool>>, Error> {
        // A triangle without area lies on the edges of others.
        let is_known = |&sense: &i8| sense < Sides::UNKNOWN || sense == Sides::FLAT;
        if !self.senses.iter().all(is_known) {
            return Ok(None);
        }
        let bounds = |&sense: &i8| matches!(sense, 1 | -1);
        if self.senses.iter().all(bounds) {
            return Ok(Some(Vec::new()));
        }
        Ok(Some(memory::collected(self.senses.iter().map(bounds))?))
    }

    /// Returns for each triangle of a closed mesh whether it lies in the closed solid and may bound it,
    /// provided that all triangles with an area lie in the closed solid. `None` if that is not known.
    ///
    /// This holds if the rule has an inside on at least one side of each step of the winding number by one,
    /// and if no two triangles lie on each other: then the number changes by one almost everywhere on a
    /// triangle. (On a fin of two triangles it does not change.)
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    pub(crate) fn walls(
        &self,
        mesh: &TriangleMesh,
        rule: FillRule,
        control: &Control<'_>,
    ) -> Result<Option<Vec<bool>>, Error> {
        // (If vertices were moved, it is unknown whether triangles lie on each other.)
        if rule == FillRule::Positive || mesh.displacement() > 0.0 {
            return Ok(None);
        }
        if self.lie_on_each_other(mesh, control)? {
            return Ok(None);
        }
        let (senses, triangles) = (self.senses.iter(), mesh.triangles());
        let is_wall = |(&sense, corners): (&i8, &[u32; 3])| {
            sense != 0 && sense != Sides::FLAT && (sense < Sides::UNKNOWN || !mesh.is_flat(corners))
        };
        Ok(Some(memory::collected(senses.zip(triangles).map(is_wall))?))
    }

    /// Returns whether two intersecting triangles lie in one plane.
    ///
    /// # Errors
    /// [`Error::Cancelled`] by `control`.
    pub(super) fn lie_on_each_other(
        &self,
        mesh: &TriangleMesh,
        control: &Control<'_>,
    ) -> Result<bool, Error> {
        for (k, &[a, b]) in self.pairs.iter().enumerate() {
            if k % 4096 == 0 {
                control.check()?;
            }
            let [[p, q, r], other] = [a, b].each(|triangle| corners(mesh, triangle));
            if a < b && other.iter().all(|x| volume_sign(&p, &q, &r, x) == 0) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns the triangles that intersect a triangle beyond common vertices and edges.
    pub(super) fn meeting(&self, triangle: u32) -> impl Iterator<Item = u32> {
        let first = self.pairs.partition_point(|pair| pair[0] < triangle);
        self.pairs[first..].iter().take_while(move |pair| pair[0] == triangle).map(|pair| pair[1])
    }

    /// Returns for each triangle whether it is known to belong to the boundary of the solid.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn bounding(&self) -> Result<Vec<bool>, Error> {
        memory::collected(self.senses.iter().map(|sense| matches!(sense, 1 | -1)))
    }

    /// Returns whether two triangles intersect beyond common vertices and edges.
    pub(crate) fn is_pair(&self, a: u32, b: u32) -> bool {
        self.pairs.binary_search(&[a, b]).is_ok()
    }
}

impl TriangleMesh {
    /// Returns the sides of all triangles. `None` if too many triangles lie close to each other to find all
    /// intersections.
    ///
    /// O(t log t) for triangles that lie apart. Memory as [`moments`](Self::moments), and 1 byte a triangle.
    pub(crate) fn sides(&self, rule: FillRule, control: &Control<'_>) -> Result<Option<Sides>, Error> {
        let mut pairs = Vec::new();
        let search = intersections(self, control, &mut |a, b| {
            memory::push(&mut pairs, [a, b])?;
            memory::push(&mut pairs, [b, a])?;
            Ok(true)
        })?;
        if search != Search::Finished {
            return Ok(None);
        }
        pairs.sort_unstable();
        let mut senses = memory::filled(self.triangles().len(), 0)?;
        pairs.iter().for_each(|&[a, _]| senses[a as usize] = Sides::UNKNOWN);
        match self.check_closed(rule) {
            Ok(()) => {
                let sheets =
                    sheets(self, self.tree(control)?, rule, |t| senses[t as usize] == Sides::UNKNOWN)?;
                for (sense, &sheet) in senses.iter_mut().zip(&sheets.of_triangles) {
                    *sense = match sheets.senses[sheet as usize] {
                        Sense::Known(sense) => sense,
                        Sense::Flat => Sides::FLAT,
                        Sense::Unknown => Sides::UNKNOWN,
                    };
                }
            }
            Err(Error::Mesh(_)) => {
                for (sense, triangle) in senses.iter_mut().zip(self.triangles()) {
                    *sense = if self.is_flat(triangle) { Sides::FLAT } else { Sides::UNKNOWN };
                }
            }
            Err(error) => return Err(error),
        }
        Ok(Some(Sides { senses, pairs }))
    }

    /// Returns the area of the triangles at which the solid ends. `None` if this is not known for all
    /// triangles, or if vertices were moved.
    pub(crate) fn boundary_area(&self, sides: &Sides) -> Option<Interval> {
        if self.displacement() > 0.0 || sides.senses.contains(&Sides::UNKNOWN) {
            return None;
        }
        let zero = Interval::exactly(0.0);
        let ends = (0..).zip(&sides.senses).filter(|(_, sense)| matches!(sense, 1 | -1));
        let sum = ends.fold(zero, |sum, (triangle, _)| {
            let [a, b, c] = corners(self, triangle).each(|p| p.each(Interval::exactly));
            let minor = |i: usize, j: usize| {
                let edge = |p: &[Interval; 3], axis: usize| p[axis].minus(a[axis]);
                edge(&b, i).times(edge(&c, j)).minus(edge(&b, j).times(edge(&c, i)))
            };
            let squares = [(1, 2), (2, 0), (0, 1)].each(|(i, j)| minor(i, j).square());
            sum.plus(squares[0].plus(squares[1]).plus(squares[2]).root())
        });
        Some(sum.times(Interval::exactly(0.5)))
    }
}
