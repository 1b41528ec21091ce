//! Models from intervals that a host program provides.

use super::arrays::{Form, ModelArrays, OwnedRows};
use super::assemble::{Piece, assembled};
use super::format::{DexelEnds, DexelFormat};
use super::item::{Item, Mark, NO_SURFACE};
use super::line::{Line, is_place};
use super::model::TriDexel;
use super::normal::{NO_NORMAL, encoded};
use super::place::{DoubleSpan, FixedSpan, Place, Span};
use super::view::{Dexel, DexelEnd, Window};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::memory;
use alloc::vec::Vec;

impl TriDexel {
    /// Makes a model of given intervals, ray by ray: those of another program, of a machine, of a test.
    ///
    /// For each axis of `directions` and each ray, `dexels` is called with the axis, the indices of the ray's
    /// cells on the other two axes (the lower axis first, which varies faster), and an empty list. `dexels`
    /// appends the ray's intervals in model units, in ascending order and disjoint. Parts beyond the universe
    /// are cut off. Data that `format` does not store is dropped.
    ///
    /// Ends are rounded to the format, and keep their side of every centre of a cell. A centre is the real
    /// number origin + (k + ½) · edge / 2^depth, and the side is decided exactly. An end on a centre stays on
    /// this centre: intervals are half-open, so that a start there includes the centre, while an end does
    /// not. Intervals that are empty after rounding are dropped. Intervals that touch are joined, unless both
    /// have materials and these differ.
    ///
    /// An end from [`DexelRays::dexels`](crate::dexel::DexelRays::dexels) returns to its original place,
    /// because it [stores this place](DexelEnd::cells). So a model of all intervals of another model, on the
    /// same frame and in the same format, is equal to that model. [`DexelEnd::in_cells`] makes such ends.
    ///
    /// The directions are not compared with each other. Where they disagree about a centre, the highest axis
    /// decides ([`TriDexelRef::contains_cell`](crate::dexel::TriDexelRef::contains_cell)).
    ///
    /// O(rays + intervals), by the calling thread.
    ///
    /// # Errors
    /// [`Error::Argument`] if an interval's end is NaN or not greater than its start, or if an interval
    /// begins before the previous one ends; [`Error::Limit`] for 2^32 rays (a depth of 16) or intervals in
    /// one direction; [`Error::OutOfMemory`]; [`Error::Cancelled`]; and the errors of `dexels`.
    ///
    /// ```
    /// use leafless::{Control, Frame, TriDexel, dexel::{Dexel, DexelEnd, DexelFormat}};
    /// let frame = Frame::new([0.0; 3], 8.0, 3)?;
    /// let end = DexelEnd::new;
    /// // A plate between z = 2 and z = 3.25, by rays along z alone.
    /// let plate = |_axis: usize, _ray: [u32; 2], list: &mut Vec<Dexel>| {
    ///     list.push(Dexel { start: end(2.0), end: end(3.25), material: 0 });
    ///     Ok(())
    /// };
    /// let directions = [false, false, true];
    /// let model =
    ///     TriDexel::from_rays(&frame, DexelFormat::default(), directions, plate, &Control::default())?;
    /// assert!(model.view().contains_cell([0, 0, 2]) && !model.view().contains_cell([0, 0, 3]));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn from_rays(
        frame: &Frame,
        format: DexelFormat,
        directions: [bool; 3],
        mut dexels: impl FnMut(usize, [u32; 2], &mut Vec<Dexel>) -> Result<(), Error>,
        control: &Control<'_>,
    ) -> Result<TriDexel, Error> {
        let mut rays = [const { None }; 3];
        let mut list = Vec::new();
        for axis in (0..3).filter(|&axis| directions[axis]) {
            let source = Source { frame, format: &format, axis, control };
            rays[axis] = Some(match format.ends {
                DexelEnds::Fixed => source.rows::<FixedSpan>(&mut list, &mut dexels)?,
                DexelEnds::Double => source.rows::<DoubleSpan>(&mut list, &mut dexels)?,
            });
        }
        Ok(TriDexel::new(ModelArrays { frame: *frame, format, rays }))
    }
}

/// One direction to be read.
struct Source<'a> {
    frame: &'a Frame,
    format: &'a DexelFormat,
    axis: usize,
    control: &'a Control<'a>,
}

impl Source<'_> {
    fn rows<S: Form>(
        &self,
        list: &mut Vec<Dexel>,
        dexels: &mut impl FnMut(usize, [u32; 2], &mut Vec<Dexel>) -> Result<(), Error>,
    ) -> Result<OwnedRows, Error> {
        const MOST: u64 = u32::MAX as u64 - 1;
        let window = Window::all(self.frame.depth());
        if window.count() > MOST {
            return Err(Error::Limit { what: "rays in one direction", limit: MOST });
        }
        let mut piece = Piece::<S>::new(self.format, window.count() as usize)?;
        for v in window.range(1) {
            self.control.check()?;
            for u in window.range(0) {
                list.clear();
                dexels(self.axis, [u, v], list)?;
                self.append(list, &mut piece)?;
                if piece.columns.spans.len() as u64 > MOST {
                    return Err(Error::Limit { what: "intervals in one direction", limit: MOST });
                }
                piece.end_ray()?;
            }
        }
        let mut pieces = memory::with_capacity(1)?;
        pieces.push(piece);
        Ok(S::own(assembled(window, self.format, pieces)?))
    }

    /// Appends the intervals of a ray.
    fn append<S: Span>(&self, list: &[Dexel], piece: &mut Piece<S>) -> Result<(), Error> {
        let refused = |problem| Err(Error::Argument { name: "dexels", problem });
        let mut last: Option<(Given, S::Place)> = None;
        for dexel in list {
            let given = [self.given(&dexel.start), self.given(&dexel.end)];
            if !given[0].is_before(&given[1]) {
                return refused("the end of an interval must be greater than its start");
            }
            let mut ends = given.each(|end| end.place::<S::Place>());
            if let Some((reached, place)) = last {
                if given[0].is_before(&reached) {
                    return refused("the intervals of a ray must be in ascending order and disjoint");
                }
                // Ends that are given in two forms may be rounded past each other, but not past a centre.
                if ends[0] < place {
                    ends[0] = place;
                }
            }
            // (So may the two ends of one interval, which is then empty.)
            let end = if ends[1] < ends[0] { ends[0] } else { ends[1] };
            last = Some((given[1], end));
            let marks = [dexel.start, dexel.end].each(mark);
            piece.add(&Item { ends, marks, material: dexel.material })?;
        }
        Ok(())
    }

    fn given(&self, end: &DexelEnd) -> Given<'_> {
        let line = Line { frame: self.frame, axis: self.axis };
        let is_own = |&cells: &f64| is_place(cells, self.frame.depth()) && line.coordinate(cells) == end.at;
        Given { line, at: end.at, cells: end.cells.filter(is_own) }
    }
}

/// An end in its given form.
#[derive(Clone, Copy)]
struct Given<'a> {
    line: Line<'a>,
    at: f64,
    /// The place in cells, if it is known and agrees with the coordinate.
    cells: Option<f64>,
}

impl Given<'_> {
    /// Returns whether this end comes before the other one. (A NaN is not before another number.)
    fn is_before(&self, other: &Given<'_>) -> bool {
        match (self.cells, other.cells) {
            (Some(cells), Some(others)) => cells < others,
            _ => self.at < other.at,
        }
    }

    fn place<P: Place>(&self) -> P {
        match self.cells {
            Some(cells) => P::rounded(cells, self.line.frame.depth()),
            None => self.line.place(self.at),
        }
    }
}

fn mark(end: DexelEnd) -> Mark {
    Mark { surface: end.surface.unwrap_or(NO_SURFACE), normal: end.normal.map_or(NO_NORMAL, encoded) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dexel::DexelNormals;

    fn at(at: f64) -> DexelEnd {
        DexelEnd { surface: Some(3), normal: Some([0.0, 0.0, 1.0]), ..DexelEnd::new(at) }
    }

    fn one_ray(format: DexelFormat, intervals: &[(f64, f64, u32)]) -> Result<Vec<Dexel>, Error> {
        let frame = Frame::new([-1.0; 3], 8.0, 3).unwrap();
        let control = Control::default();
        let rays = |axis: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
            assert_eq!(axis, 2);
            if ray == [3, 5] {
                list.extend(intervals.iter().map(|&(start, end, material)| Dexel {
                    start: at(start),
                    end: at(end),
                    material,
                }));
            }
            Ok(())
        };
        let model = TriDexel::from_rays(&frame, format, [false, false, true], rays, &control)?;
        model.view().check()?;
        let rays = model.view().rays(2).unwrap();
        assert!(rays.interval_count() == 0 || rays.window() == [3..4, 5..6]);
        Ok(rays.dexels([3, 5]).collect())
    }

    #[test]
    fn intervals_come_out_as_they_went_in() {
        let all = DexelFormat {
            ends: DexelEnds::Double,
            normals: DexelNormals::Bits32,
            surfaces: true,
            materials: true,
        };
        for format in [all, DexelFormat { ends: DexelEnds::Fixed, ..all }] {
            let list = one_ray(format, &[(-9.0, -0.25, 4), (0.5, 1.0, 7), (1.0, 2.0, 8)]).unwrap();
            let said: Vec<_> = list.iter().map(|d| (d.start.at, d.end.at, d.material)).collect();
            assert_eq!(said, [(-1.0, -0.25, 4), (0.5, 1.0, 7), (1.0, 2.0, 8)]);
            assert_eq!((list[0].start.surface, list[1].end.normal), (Some(3), Some([0.0, 0.0, 1.0])));
        }
        // Touching intervals become one, and parts outside the universe are dropped.
        let plain = DexelFormat::default();
        let list = one_ray(plain, &[(-9.0, -4.0, 0), (0.5, 1.0, 7), (1.0, 2.0, 8), (7.0, 9.0, 0)]).unwrap();
        assert_eq!(list.len(), 1);
        assert_eq!((list[0].start.at, list[0].end.at, list[0].material), (0.5, 2.0, 0));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        for bad in [
            &[(1.0, 1.0, 0)][..],
            &[(2.0, 1.0, 0)],
            &[(f64::NAN, 1.0, 0)],
            &[(1.0, f64::NAN, 0)],
            &[(1.0, 3.0, 0), (2.0, 4.0, 0)],
            &[(3.0, 4.0, 0), (1.0, 2.0, 0)],
        ] {
            let error = one_ray(DexelFormat::default(), bad).unwrap_err();
            assert!(matches!(error, Error::Argument { name: "dexels", .. }), "{bad:?}: {error}");
        }
        // An interval from −∞ to ∞ is valid.
        assert_eq!(
            one_ray(DexelFormat::default(), &[(f64::NEG_INFINITY, f64::INFINITY, 0)]).unwrap().len(),
            1
        );
    }
}
