//! Rays of solids that compute a ray's entries and exits themselves.

use super::line::{Line, Passage};
use super::search::unit;
use super::{Obstacle, RayHit, RaySpans};
use crate::error::Error;
use crate::lattice::{Cell, Interval, axes};
use crate::memory;
use crate::solid::RayTrace;
use alloc::vec::Vec;

/// A piece of a ray between two crossings.
#[derive(Clone, Copy)]
struct Piece {
    from: f64,
    to: f64,
    /// `None` if the piece may be inside or outside.
    is_inside: Option<bool>,
    /// Whether the ray is proven to be inside at some time of the piece.
    is_met: bool,
    /// The outward normal, and the number, of the surface by which the ray enters from outside.
    entry: Option<([f64; 3], Option<u32>)>,
}

/// Passes the pieces of a ray to `visit`, in order, until `visit` returns `false`.
fn each_piece(trace: &RayTrace, mut visit: impl FnMut(Piece) -> bool) {
    let is_met = trace.begins_inside;
    let mut now = Piece { from: 0.0, to: 0.0, is_inside: Some(is_met), is_met, entry: None };
    for crossing in &trace.crossings {
        now.to = crossing.t.lower;
        let within = Piece {
            from: crossing.t.lower,
            to: crossing.t.upper,
            is_inside: None,
            is_met: crossing.is_met,
            // A surface by which the ray leaves, even for no time, is not an entry.
            entry: (now.is_inside == Some(false)).then_some((crossing.normal, crossing.surface)),
        };
        if !visit(now) || !visit(within) {
            return;
        }
        let is_met = crossing.is_inside_after;
        now = Piece { from: crossing.t.upper, is_inside: Some(is_met), is_met, ..within };
    }
    now.to = trace.until;
    visit(now);
}

/// The first places where a ray is stopped in the universe.
#[derive(Default)]
pub(super) struct Stops {
    /// The stop by the possible solid, at its least t.
    outer: Option<RayHit>,
    /// The stop by the proven solid, at its least t.
    inner: Option<RayHit>,
}

impl Stops {
    pub(super) fn new(trace: &RayTrace, line: &Line<'_>) -> Stops {
        // Usually the ray is stopped well within the universe, or not at all.
        if let Some(stay) = rough_stay(line) {
            let begins_within = stay[0] == Interval::exactly(0.0);
            let (stops, is_known) = Stops::within(trace, line, stay, begins_within.then_some([0.0; 3]));
            if is_known {
                return stops;
            }
        }
        let Some(Passage { entry, exit }) = line.passage(Cell::ROOT) else { return Stops::default() };
        Stops::within(trace, line, [entry.t, exit.t], Some(line.face(&entry))).0
    }

    /// Returns the stops during a stay between two times, each known as an interval, and whether narrower
    /// intervals would give the same result. `face` is the normal of the face where the stay begins.
    fn within(
        trace: &RayTrace,
        line: &Line<'_>,
        [entry, exit]: [Interval; 2],
        face: Option<[f64; 3]>,
    ) -> (Stops, bool) {
        let mut stops = Stops::default();
        let mut is_known = true;
        let mut hit = |t: f64, piece: &Piece, begins: f64| {
            // (A surface may lie in the face by which the ray enters the universe.)
            let is_in_face = face.is_some() && entry.upper > 0.0 && piece.from >= entry.lower;
            let (normal, surface) = match piece.entry {
                Some((normal, surface)) if piece.from > begins || is_in_face => (unit(normal), surface),
                _ => {
                    is_known &= face.is_some();
                    (face.unwrap_or_default(), None)
                }
            };
            RayHit { t: Interval::exactly(t), cell: cell_at(line, t), normal, surface }
        };
        let mut is_late = false;
        each_piece(trace, |piece| {
            if piece.from > exit.upper {
                return false;
            }
            is_late |= piece.is_inside != Some(false) && piece.from >= exit.lower;
            if piece.is_inside != Some(false) && stops.outer.is_none() && piece.to >= entry.lower {
                let t = piece.from.max(entry.lower);
                stops.outer = Some(hit(t, &piece, if face.is_some() { entry.lower } else { entry.upper }));
            }
            if piece.is_inside == Some(true) {
                let (t, until) = (piece.from.max(entry.upper), piece.to.min(exit.lower));
                if t < until || t == until && piece.from == piece.to {
                    stops.inner = Some(hit(t, &piece, entry.upper));
                }
            } else if piece.is_met && entry.upper <= piece.from && piece.to <= exit.lower {
                stops.inner = Some(hit(piece.to, &piece, entry.upper));
            }
            stops.inner.is_none()
        });
        (stops, is_known && !is_late)
    }

    /// Returns the answer to a query.
    pub(super) fn hit(self, on: Obstacle) -> Option<RayHit> {
        let Stops { outer, inner } = self;
        let found = match on {
            Obstacle::Full => inner?,
            Obstacle::Upper => outer?,
        };
        let upper = inner.map_or(f64::INFINITY, |hit| hit.t.upper);
        let lower = outer?.t.lower.min(upper);
        Some(RayHit { t: Interval::between(lower, upper), ..found })
    }

    /// Returns whether the ray is surely stopped, and whether it may be stopped.
    pub(super) fn are(&self) -> (bool, bool) {
        (self.inner.is_some(), self.outer.is_some())
    }
}

/// Returns the times at which a ray enters and leaves the universe, in rough intervals. `None` for a ray that
/// misses the universe, or that comes near to a face along which it runs.
fn rough_stay(line: &Line<'_>) -> Option<[Interval; 2]> {
    let (frame, ray) = (line.frame, &line.ray);
    let (mut entry, mut exit) = (Interval::exactly(0.0), Interval::exactly(ray.last));
    for axis in 0..3 {
        let (low, from, along) = (frame.origin()[axis], ray.from[axis], ray.direction[axis][0]);
        let high = low + frame.edge();
        let magnitude = low.abs() + frame.edge() + from.abs();
        if along == 0.0 {
            let is_within = (from - low).min(high - from) > 1e-12 * magnitude;
            if !is_within {
                return None;
            }
            continue;
        }
        // A bound above all rounding errors here.
        let wrong = 1e-12 * magnitude / along.abs();
        let about = |plane: f64| {
            let t = (plane - from) / along;
            Interval::new(t - wrong, t + wrong)
        };
        let (low, high) = (about(low)?, about(high)?);
        let [near, far] = if along > 0.0 { [low, high] } else { [high, low] };
        entry = Interval::new(entry.lower.max(near.lower), entry.upper.max(near.upper))?;
        exit = Interval::new(exit.lower.min(far.lower), exit.upper.min(far.upper))?;
    }
    (entry.upper < exit.lower).then_some([entry, exit])
}

/// True if nothing is known of a ray from its entry into the universe on.
pub(super) fn ends_before(trace: &RayTrace, line: &Line<'_>) -> bool {
    let is_after = |entry: Interval| trace.until > entry.upper;
    if trace.until == f64::INFINITY || rough_stay(line).is_some_and(|[entry, _]| is_after(entry)) {
        return false;
    }
    line.passage(Cell::ROOT).is_some_and(|Passage { entry, .. }| trace.until < entry.t.upper)
}

/// Returns the finest cell of the universe at the ray's place at a time, up to rounding.
fn cell_at(line: &Line<'_>, t: f64) -> Cell {
    let frame = line.frame;
    let at = axes(|axis| {
        let [along, rest] = line.ray.direction[axis];
        let at = frame.scaled(axis, line.ray.from[axis] + t * along + t * rest);
        // (NaN is placed at the lower end.)
        (at.max(0.0) as u32).min(frame.cells() - 1)
    });
    Cell { level: frame.depth(), at }
}

/// Returns the intervals in which a ray is in the solid and in the universe.
pub(super) fn spans(trace: &RayTrace, line: &Line<'_>) -> Result<RaySpans, Error> {
    let mut spans = RaySpans { inner: Vec::new(), outer: Vec::new() };
    let Some(Passage { entry, exit }) = line.passage(Cell::ROOT) else { return Ok(spans) };
    let mut added = Ok(());
    each_piece(trace, |piece| {
        if piece.is_inside != Some(false) {
            let outer = Interval::new(piece.from.max(entry.t.lower), piece.to.min(exit.t.upper));
            added = add(&mut spans.outer, outer);
        }
        let is_point = piece.is_met && piece.from == piece.to;
        if (piece.is_inside == Some(true) || is_point) && added.is_ok() {
            let inner = Interval::new(piece.from.max(entry.t.upper), piece.to.min(exit.t.lower));
            added = add(&mut spans.inner, inner);
        }
        added.is_ok()
    });
    added.map(|()| spans)
}

/// Adds a span, which usually begins where the last one ended.
fn add(spans: &mut Vec<Interval>, span: Option<Interval>) -> Result<(), Error> {
    match (span, spans.last_mut()) {
        (None, _) => Ok(()),
        (Some(span), Some(last)) if span.lower <= last.upper => {
            *last = last.joined(span);
            Ok(())
        }
        (Some(span), _) => memory::push(spans, span),
    }
}
