//! The set algebra of models on one lattice.
//!
//! Half-open intervals on a ray are closed under the set operations, so that all laws of sets hold exactly,
//! as for point sets. The data of intervals follows: an end keeps its surface and normal, and a subtraction
//! that shows the other side reverses the normal. Where both operands contain a place, the first one's
//! material counts.

use super::arrays::{Form, ModelArrays, OwnedRows};
use super::assemble::{Piece, assembled};
use super::format::{DexelEnds, DexelFormat};
use super::item::Item;
use super::merge::{SetOp, complement, merge, merge_plain, merge_single};
use super::model::TriDexel;
use super::place::{DoubleSpan, FixedSpan, Place, Span};
use super::view::{Rows, RowsRef, TriDexelRef, Window, with_rows};
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::memory;
use crate::parallel::each;
use core::ops::Range;

/// The number of rows of rays in one task of a thread.
const ROWS: u32 = 64;

impl TriDexelRef<'_> {
    /// Computes the union: the places that lie in this model, in `other`, or in both. O(rays + intervals).
    /// The result is the same for any number of threads.
    ///
    /// # Errors
    /// - [`Error::FrameMismatch`] if the models lie on different lattices.
    /// - [`Error::Argument`] if they have different directions.
    /// - [`Error::Limit`] for 2^32 intervals in one direction, and for 2^32 rays in the window of the result,
    ///   as where two models lie far apart at a depth of 16 or more.
    /// - [`Error::TooLarge`] if these rays alone take more than `control.max_bytes`.
    /// - [`Error::DamagedRays`] if a model comes from an unverified file and is damaged.
    /// - [`Error::OutOfMemory`]; [`Error::Cancelled`].
    pub fn union(&self, other: &TriDexelRef<'_>, control: &Control<'_>) -> Result<TriDexel, Error> {
        combined(SetOp::Union, self, other, control)
    }

    /// Computes the intersection: the places that lie in both models. Cost and materials as for
    /// [`union`](Self::union).
    ///
    /// # Errors
    /// As [`union`](Self::union).
    pub fn intersection(&self, other: &TriDexelRef<'_>, control: &Control<'_>) -> Result<TriDexel, Error> {
        combined(SetOp::Intersection, self, other, control)
    }

    /// Computes the difference: the places that lie in this model and not in `other`. Cost and materials as
    /// for [`union`](Self::union).
    ///
    /// # Errors
    /// As [`union`](Self::union).
    pub fn difference(&self, other: &TriDexelRef<'_>, control: &Control<'_>) -> Result<TriDexel, Error> {
        combined(SetOp::Difference, self, other, control)
    }

    /// Computes the symmetric difference: the places that lie in exactly one of the models. Cost and
    /// materials as for [`union`](Self::union).
    ///
    /// # Errors
    /// As [`union`](Self::union).
    pub fn xor(&self, other: &TriDexelRef<'_>, control: &Control<'_>) -> Result<TriDexel, Error> {
        combined(SetOp::Xor, self, other, control)
    }

    /// Computes the complement: the places in the universe that do not lie in this model. Cost as for
    /// [`union`](Self::union).
    ///
    /// # Errors
    /// As [`union`](Self::union).
    pub fn complement(&self, control: &Control<'_>) -> Result<TriDexel, Error> {
        self.sound()?;
        let depth = self.frame.depth();
        each_direction(self.frame, self.format, self.directions(), control, |axis, lot| {
            let Some(rows) = &self.rays[axis] else { unreachable!("only directions that exist") };
            with_rows!(rows, rows => complemented(rows, depth, &self.format, lot))
        })
    }

    /// Converts the model to another format. Data that this model does not store is unknown in the result: no
    /// surface, no normal, material 0.
    ///
    /// # Errors
    /// [`Error::DamagedRays`], [`Error::OutOfMemory`], [`Error::Cancelled`].
    pub fn to_format(&self, format: DexelFormat, control: &Control<'_>) -> Result<TriDexel, Error> {
        self.sound()?;
        let depth = self.frame.depth();
        each_direction(self.frame, format, self.directions(), control, |axis, lot| {
            let Some(rows) = &self.rays[axis] else { unreachable!("only directions that exist") };
            with_rows!(rows, rows => match format.ends {
                DexelEnds::Fixed => converted::<_, FixedSpan>(rows, &format, depth, lot),
                DexelEnds::Double => converted::<_, DoubleSpan>(rows, &format, depth, lot),
            })
        })
    }

    /// Sets the material of the whole model.
    ///
    /// # Errors
    /// As [`to_format`](Self::to_format).
    pub fn with_material(&self, material: u32, control: &Control<'_>) -> Result<TriDexel, Error> {
        self.sound()?;
        let format = DexelFormat { materials: true, ..self.format };
        each_direction(self.frame, format, self.directions(), control, |axis, lot| {
            let Some(rows) = &self.rays[axis] else { unreachable!("only directions that exist") };
            with_rows!(rows, rows => painted(rows, material, &format, lot))
        })
    }

    /// Returns whether all stored data is equal, bit for bit. O(n).
    pub(crate) fn equals(&self, other: &TriDexelRef<'_>) -> bool {
        fn same<S: Span>(a: &RowsRef<'_, S>, b: &RowsRef<'_, S>) -> bool {
            let count = a.columns.spans.len();
            a.window == b.window
                && a.starts == b.starts
                && a.columns.spans == b.columns.spans
                && (0..count).all(|i| {
                    let (a, b) = (a.columns.item(i), b.columns.item(i));
                    a.marks == b.marks && a.material == b.material
                })
        }
        self.frame == other.frame
            && self.format == other.format
            && (0..3).all(|axis| match (&self.rays[axis], &other.rays[axis]) {
                (None, None) => true,
                (Some(Rows::Fixed(a)), Some(Rows::Fixed(b))) => same(a, b),
                (Some(Rows::Double(a)), Some(Rows::Double(b))) => same(a, b),
                _ => false,
            })
    }
}

impl TriDexel {
    /// Computes the union of several models: the places that lie in any of them. Where several models contain
    /// a place, the first one's material counts. An empty list is an error, because its lattice is unknown.
    /// O(rays + intervals · log models).
    ///
    /// # Errors
    /// [`Error::Argument`] for an empty list; otherwise as [`TriDexelRef::union`].
    pub fn union_of(models: &[TriDexelRef<'_>], control: &Control<'_>) -> Result<TriDexel, Error> {
        combined_of(SetOp::Union, models, control)
    }

    /// Computes the intersection of several models: the places that lie in all of them. Cost and materials as
    /// for [`union_of`](Self::union_of).
    ///
    /// # Errors
    /// [`Error::Argument`] for an empty list; otherwise as [`TriDexelRef::union`].
    pub fn intersection_of(models: &[TriDexelRef<'_>], control: &Control<'_>) -> Result<TriDexel, Error> {
        combined_of(SetOp::Intersection, models, control)
    }

    /// Computes the places that lie in the first of the models and in none of the others. Cost and materials
    /// as for [`union_of`](Self::union_of).
    ///
    /// # Errors
    /// [`Error::Argument`] for an empty list; otherwise as [`TriDexelRef::union`].
    pub fn difference_of(models: &[TriDexelRef<'_>], control: &Control<'_>) -> Result<TriDexel, Error> {
        match models {
            [first, others @ ..] if others.len() > 1 => {
                check_all(models)?;
                let share = 0.9 * others.len() as f64 / models.len() as f64;
                let away = control.share([0.0, share], |control| TriDexel::union_of(others, control))?;
                control.share([share, 1.0], |control| first.difference(away.view(), control))
            }
            _ => combined_of(SetOp::Difference, models, control),
        }
    }

    /// Computes the places that lie in an odd number of the models. Cost and materials as for
    /// [`union_of`](Self::union_of).
    ///
    /// # Errors
    /// [`Error::Argument`] for an empty list; otherwise as [`TriDexelRef::union`].
    pub fn xor_of(models: &[TriDexelRef<'_>], control: &Control<'_>) -> Result<TriDexel, Error> {
        combined_of(SetOp::Xor, models, control)
    }
}

/// Combines neighbours in pairs until one model is left: for n operands each interval is copied log n times.
fn combined_of(op: SetOp, models: &[TriDexelRef<'_>], control: &Control<'_>) -> Result<TriDexel, Error> {
    match models {
        [] => Err(Error::Argument { name: "models", problem: "must be at least one" }),
        [one] => one.to_format(one.format, control),
        [a, b] => combined(op, a, b, control),
        _ => {
            check_all(models)?;
            let (first, second) = models.split_at(models.len().div_ceil(2));
            let share = first.len() as f64 / models.len() as f64 * 0.9;
            let a = control.share([0.0, share], |control| combined_of(op, first, control))?;
            let b = control.share([share, 0.9], |control| combined_of(op, second, control))?;
            control.share([0.9, 1.0], |control| combined(op, a.view(), b.view(), control))
        }
    }
}

/// Rejects operands that do not fit, before any work is done.
fn check_all(models: &[TriDexelRef<'_>]) -> Result<(), Error> {
    models.iter().try_for_each(|model| check_operands(&models[0].frame, models[0].directions(), model))
}

/// Rejects an operand that does not fit.
pub(crate) fn check_operands(
    frame: &Frame,
    directions: [bool; 3],
    other: &TriDexelRef<'_>,
) -> Result<(), Error> {
    if *frame != other.frame {
        return Err(frame.mismatch(&other.frame));
    }
    if directions != other.directions() {
        return Err(Error::Argument { name: "other", problem: "must have rays in the same directions" });
    }
    Ok(())
}

fn combined(
    op: SetOp,
    a: &TriDexelRef<'_>,
    b: &TriDexelRef<'_>,
    control: &Control<'_>,
) -> Result<TriDexel, Error> {
    check_operands(&a.frame, a.directions(), b)?;
    a.sound()?;
    b.sound()?;
    let format = a.format.join(b.format);
    if a.kind() != b.kind() {
        let double = |model: &TriDexelRef<'_>, share| {
            let format = DexelFormat { ends: DexelEnds::Double, ..model.format };
            control.share(share, |control| model.to_format(format, control))
        };
        let (a, b) = (double(a, [0.0, 0.3])?, double(b, [0.3, 0.6])?);
        return control.share([0.6, 1.0], |control| combined(op, a.view(), b.view(), control));
    }
    each_direction(a.frame, format, a.directions(), control, |axis, lot| {
        match (&a.rays[axis], &b.rays[axis]) {
            (Some(Rows::Fixed(a)), Some(Rows::Fixed(b))) => of_rows(op, a, b, &format, lot),
            (Some(Rows::Double(a)), Some(Rows::Double(b))) => of_rows(op, a, b, &format, lot),
            _ => unreachable!("operands of one kind, and only directions that exist"),
        }
    })
}

/// The work on the rays of one direction.
struct Lot<'a> {
    job: &'a Job<'a>,
    parallel: bool,
    /// Its share of the progress.
    parts: usize,
}

/// Makes a model; `work` makes its directions, one after the other.
fn each_direction(
    frame: Frame,
    format: DexelFormat,
    directions: [bool; 3],
    control: &Control<'_>,
    work: impl Fn(usize, &Lot<'_>) -> Result<OwnedRows, Error> + Send + Sync,
) -> Result<TriDexel, Error> {
    let job = Job::new(control);
    job.check()?;
    control.run(frame.depth() > 6, |parallel| {
        let mut rays = [const { None }; 3];
        let count = directions.iter().filter(|&&has| has).count();
        for (i, axis) in (0..3).filter(|&axis| directions[axis]).enumerate() {
            let parts = WHOLE * (i + 1) / count - WHOLE * i / count;
            let rows = work(axis, &Lot { job: &job, parallel, parts })?;
            job.spend(0, bytes(&rows, &format))?;
            rays[axis] = Some(rows);
        }
        Ok(TriDexel::new(ModelArrays { frame, format, rays }))
    })
}

fn bytes(rows: &OwnedRows, format: &DexelFormat) -> usize {
    let (starts, count) = match rows {
        OwnedRows::Fixed(rows) => (rows.starts.len(), rows.columns.spans.len()),
        OwnedRows::Double(rows) => (rows.starts.len(), rows.columns.spans.len()),
    };
    4 * starts + count * format.bytes_per_interval()
}

/// Makes the rays of a window row by row. `begin` is called with each range of rows before `work` makes them.
fn by_rows<S: Form>(
    window: Window,
    format: &DexelFormat,
    lot: &Lot<'_>,
    begin: impl Fn(Range<u32>, &mut Piece<S>) -> Result<(), Error> + Send + Sync,
    work: impl Fn(u32, &mut Piece<S>) -> Result<(), Error> + Send + Sync,
) -> Result<OwnedRows, Error> {
    let Lot { job, parallel, parts } = *lot;
    const MOST: u64 = u32::MAX as u64 - 1;
    if window.count() > MOST {
        return Err(Error::Limit { what: "rays in one direction", limit: MOST });
    }
    // Each ray stores the index of its first interval.
    job.control().afford("the rays", window.count() * size_of::<u32>() as u64)?;
    let rows = window.range(1);
    let each_row = parts.checked_div(rows.len()).unwrap_or(0);
    job.advance(parts - each_row * rows.len());
    let one = |range: Range<u32>| {
        let mut piece = Piece::new(format, range.len() * window.size[0] as usize)?;
        begin(range.clone(), &mut piece)?;
        for v in range {
            job.check()?;
            work(v, &mut piece)?;
            job.advance(each_row);
        }
        Ok::<_, Error>(piece)
    };
    if parallel && rows.len() > ROWS as usize {
        let count = (rows.end - rows.start).div_ceil(ROWS) as usize;
        let tiles = (0..count).map(|i| {
            let first = rows.start + i as u32 * ROWS;
            first..rows.end.min(first + ROWS)
        });
        return Ok(S::own(assembled(window, format, each(true, tiles, one)?)?));
    }
    let mut pieces = memory::with_capacity(1)?;
    pieces.push(one(rows)?);
    Ok(S::own(assembled(window, format, pieces)?))
}

/// Rows need no preparation.
fn nothing<S: Form>(_: Range<u32>, _: &mut Piece<S>) -> Result<(), Error> {
    Ok(())
}

fn of_rows<S: Form>(
    op: SetOp,
    a: &RowsRef<'_, S>,
    b: &RowsRef<'_, S>,
    format: &DexelFormat,
    lot: &Lot<'_>,
) -> Result<OwnedRows, Error> {
    let window = match op {
        SetOp::Union | SetOp::Xor => a.window.hull(&b.window),
        SetOp::Intersection => a.window.intersection(&b.window),
        SetOp::Difference => a.window,
    };
    let begin = |range: Range<u32>, piece: &mut Piece<S>| {
        let [most_a, most_b] = [a, b].each(|rows| rows.within(range.clone()).len());
        piece.columns.reserve(most_a + most_b, true)
    };
    by_rows(window, format, lot, begin, |v, piece| {
        for (run, from) in runs(window.range(0), v, a, b) {
            match from {
                [true, true] => both(op, [run, v..v + 1], a, b, format, piece)?,
                [true, false] if op.keeps()[0] => copy(run, v, a, piece)?,
                [false, true] if op.keeps()[1] => copy(run, v, b, piece)?,
                _ => piece.skip(run.len())?,
            }
        }
        Ok(())
    })
}

/// Divides a row at the ends of the operands' windows. Each run comes with the windows that contain it.
fn runs<S>(
    all: Range<u32>,
    v: u32,
    a: &RowsRef<'_, S>,
    b: &RowsRef<'_, S>,
) -> impl Iterator<Item = (Range<u32>, [bool; 2])> {
    let windows = [a.window, b.window];
    let mut cuts = [all.start, all.end, all.end, all.end, all.end];
    for (i, window) in windows.iter().enumerate() {
        cuts[1 + 2 * i] = window.range(0).start.clamp(all.start, all.end);
        cuts[2 + 2 * i] = window.range(0).end.clamp(all.start, all.end);
    }
    cuts.sort_unstable();
    let ends = [1, 2, 3, 4, 5].each(|i| cuts.get(i).copied().unwrap_or(all.end));
    (0..5).filter_map(move |i| {
        let run = cuts[i]..ends[i];
        let has = |window: &Window| window.index([run.start, v]).is_some();
        (!run.is_empty()).then(|| (run.clone(), [has(&windows[0]), has(&windows[1])]))
    })
}

/// Copies the rays of a run.
fn copy<S: Span>(run: Range<u32>, v: u32, from: &RowsRef<'_, S>, piece: &mut Piece<S>) -> Result<(), Error> {
    let Some(first) = from.window.index([run.start, v]) else { return Ok(()) };
    piece.copy(from, first..first + run.len())
}

/// Merges the rays of a run.
fn both<S: Span>(
    op: SetOp,
    [run, row]: [Range<u32>; 2],
    a: &RowsRef<'_, S>,
    b: &RowsRef<'_, S>,
    format: &DexelFormat,
    piece: &mut Piece<S>,
) -> Result<(), Error> {
    let (Some(i), Some(j)) = (a.window.index([run.start, row.start]), b.window.index([run.start, row.start]))
    else {
        return Ok(());
    };
    let [keeps_a, keeps_b] = op.keeps();
    for k in 0..run.len() {
        let (range_a, range_b) = (a.at(i + k), b.at(j + k));
        let out = &mut piece.columns;
        match (range_a.len(), range_b.len()) {
            (0, 0) => {}
            (_, 0) => {
                if keeps_a {
                    out.copy(&a.columns, range_a)?;
                }
            }
            (0, _) => {
                if keeps_b {
                    out.copy(&b.columns, range_b)?;
                }
            }
            (1, 1) if format.is_plain() => {
                merge_single(
                    op,
                    a.columns.spans[range_a.start],
                    b.columns.spans[range_b.start],
                    &mut out.spans,
                )?;
            }
            _ if format.is_plain() => {
                merge_plain(op, &a.columns.spans[range_a], &b.columns.spans[range_b], &mut out.spans)?;
            }
            _ => merge(op, (&a.columns, range_a), (&b.columns, range_b), out)?,
        }
        piece.end_ray()?;
    }
    Ok(())
}

/// Converts rows to another form of ends and to other columns.
fn converted<S: Span, T: Form>(
    rows: &RowsRef<'_, S>,
    format: &DexelFormat,
    depth: u8,
    lot: &Lot<'_>,
) -> Result<OwnedRows, Error> {
    by_rows(rows.window, format, lot, nothing, |v, piece: &mut Piece<T>| {
        for u in rows.window.range(0) {
            for item in rows.items([u, v]) {
                // Without materials, or after rounding, intervals may touch that did not touch before.
                let ends = item.ends.each(|end| T::Place::rounded(end.cells(depth), depth));
                piece.add(&Item { ends, marks: item.marks, material: item.material })?;
            }
            piece.end_ray()?;
        }
        Ok(())
    })
}

/// The complement of all rays.
fn complemented<S: Form>(
    rows: &RowsRef<'_, S>,
    depth: u8,
    format: &DexelFormat,
    lot: &Lot<'_>,
) -> Result<OwnedRows, Error> {
    by_rows(Window::all(depth), format, lot, nothing, |v, piece| {
        for u in 0..1 << depth {
            complement(&rows.columns, rows.ray([u, v]), depth, &mut piece.columns)?;
            piece.end_ray()?;
        }
        Ok(())
    })
}

/// Rows of one material. Intervals touch only where their materials differ, so that touching intervals are
/// joined.
fn painted<S: Form>(
    rows: &RowsRef<'_, S>,
    material: u32,
    format: &DexelFormat,
    lot: &Lot<'_>,
) -> Result<OwnedRows, Error> {
    by_rows(rows.window, format, lot, nothing, |v, piece: &mut Piece<S>| {
        for u in rows.window.range(0) {
            for item in rows.items([u, v]) {
                piece.add(&Item { material, ..item })?;
            }
            piece.end_ray()?;
        }
        Ok(())
    })
}
