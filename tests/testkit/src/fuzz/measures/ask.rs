//! The queries of the target `measures`. Each runs under some budget, and the answer must hold for the unit
//! cells.

use super::dense::Dense;
use super::{Bytes, Scene, control, corners, doubles, universe};
use leafless::query::{
    Ball, Columns, DistanceTo, Obstacle, Overlap, Region, Side, Sight, StopReason, cells_in, classify_box,
    classify_in, columns, distances, heights, line_of_sight, ray_spans, surface_area, volume_in,
};
use leafless::{
    Control, Error, Frame, Interval, Membership, Ray, Tolerance, bounding_box, cast_rays, clearance,
    contains, interference, measure,
};
use std::fmt::Debug;

/// Runs one query about two solids.
pub fn ask(bytes: &mut Bytes<'_>, frame: &Frame, a: &Scene, b: &Scene) {
    let code = bytes.byte();
    let budget = bytes.budget();
    let tolerance = bytes.tolerance();
    let asked = Asked { frame, a, b, budget, tolerance, threads: code >= 192 };
    match code % 15 {
        0 => asked.measured(),
        1 => asked.area(),
        2 => asked.extent(),
        3 => asked.interference(),
        4 => asked.clearance(),
        5 => asked.points(bytes),
        6 => asked.distances(bytes),
        7 => asked.content(),
        8 => asked.rays(bytes),
        9 => asked.sight(bytes),
        10 => asked.columns(bytes),
        11 => asked.box_region(bytes),
        12 => asked.region(),
        13 => asked.spans(bytes),
        _ => asked.measured(),
    }
}

struct Asked<'a> {
    frame: &'a Frame,
    a: &'a Scene,
    b: &'a Scene,
    budget: Option<u64>,
    tolerance: f64,
    /// True if two threads must give the same answer.
    threads: bool,
}

/// A ray, and its pieces between changes of cells: start, end, and whether the piece is in the solid.
struct Known {
    from: [f64; 3],
    direction: [f64; 3],
    ray: Ray,
    pieces: Vec<(f64, f64, bool)>,
}

/// True if an interval contains a rounded number.
fn holds(found: Interval, truth: f64) -> bool {
    let slack = if truth.is_finite() { 1e-12 * (1.0 + truth.abs()) } else { 0.0 };
    found.lower <= truth + slack && truth - slack <= found.upper
}

impl Asked<'_> {
    /// Returns the answer of one thread. If `threads`, two threads must give the same.
    fn by_threads<T: PartialEq + Debug>(&self, ask: impl Fn(&Control<'_>) -> Result<T, Error>) -> T {
        let one = control(self.budget);
        let found = ask(&one).expect("nothing is wrong with the question");
        if self.threads {
            let two = ask(&Control { threads: 2, ..one }).expect("nothing is wrong with the question");
            assert_eq!(found, two);
        }
        found
    }

    fn universe(&self) -> [[f64; 3]; 2] {
        universe(self.frame)
    }

    fn most(&self) -> u64 {
        self.budget.unwrap_or(u64::MAX)
    }

    fn measured(&self) {
        let (solid, truth) = (&self.a.solid, &self.a.truth);
        let tolerance = Tolerance { relative: self.tolerance, absolute: self.tolerance / 8.0 };
        let found = self.by_threads(|control| measure(solid, self.frame, tolerance, control));
        let [min, max] = self.universe();
        let volume = truth.volume([min, max]);
        assert!(holds(found.volume, volume), "{:?}, {volume}", found.volume);
        assert!(found.splits <= self.most());
        assert!(found.clipped || truth.ends_in([min, max]));
        // Moments: sums over boxes.
        let mut first = [0.0; 3];
        let mut second = [[0.0; 3]; 3];
        for (volume, piece) in truth.parts(min, max) {
            let middle = piece.map(|[low, high]| 0.5 * (low + high));
            for i in 0..3 {
                first[i] += volume * middle[i];
                for j in 0..3 {
                    let [low, high] = piece[i];
                    let own = if i == j { (high - low).powi(2) / 12.0 } else { 0.0 };
                    second[i][j] += volume * (middle[i] * middle[j] + own);
                }
            }
        }
        let inertia = |second: &[[f64; 3]; 3], i: usize, j: usize| match i == j {
            true => (0..3).filter(|&k| k != i).map(|k| second[k][k]).sum::<f64>(),
            false => -second[i][j],
        };
        for i in 0..3 {
            for j in 0..3 {
                let about = found.inertia_about_origin[i][j];
                assert!(holds(about, inertia(&second, i, j)), "{i} {j}: {about:?}, {second:?}");
            }
        }
        match found.centroid {
            Some(centroid) => {
                assert!(volume > 0.0);
                for i in 0..3 {
                    assert!(holds(centroid[i], first[i] / volume), "{i}: {centroid:?}, {first:?} / {volume}");
                }
                let mut central = second;
                for (i, row) in central.iter_mut().enumerate() {
                    for (j, entry) in row.iter_mut().enumerate() {
                        *entry -= first[i] * first[j] / volume;
                    }
                }
                for i in 0..3 {
                    for j in 0..3 {
                        let about = found.inertia_about_centroid[i][j];
                        let (truth, slack) = (inertia(&central, i, j), 1e-10 * (1.0 + second[i][i]));
                        assert!(
                            about.lower <= truth + slack && truth - slack <= about.upper,
                            "{about:?}, {truth}"
                        );
                    }
                }
            }
            None => assert!(found.volume.lower <= 0.0),
        }
        if found.stop_reason == StopReason::Tolerance {
            let middle = 0.5 * (found.volume.lower + found.volume.upper);
            let wanted = tolerance.absolute.max(tolerance.relative * middle);
            assert!(
                found.volume.width() <= wanted + 1e-14 * found.volume.upper,
                "{:?}, {wanted}",
                found.volume
            );
        }
    }

    fn area(&self) {
        let (solid, truth) = (&self.a.solid, &self.a.truth);
        let found = self.by_threads(|control| surface_area(solid, self.frame, self.tolerance, control));
        let [closed, open] = truth.area(self.universe());
        let slack = 1e-12 * closed;
        assert!(
            found.area.lower <= closed + slack && open - slack <= found.area.upper,
            "{found:?}, {open} to {closed}"
        );
        if !found.clipped {
            assert!(truth.ends_in(self.universe()) || truth.complement().ends_in(self.universe()));
            assert!(holds(found.area, closed), "{found:?}, {closed}");
        }
        assert!(found.splits <= self.most());
    }

    fn extent(&self) {
        let (solid, truth) = (&self.a.solid, &self.a.truth);
        let found = self.by_threads(|control| bounding_box(solid, self.frame, self.tolerance, control));
        let extent = truth.extent(self.universe());
        assert!(!found.occupied || extent.is_some());
        assert!(found.clipped || truth.ends_in(self.universe()));
        assert!(found.splits <= self.most());
        match (found.corners, extent) {
            (None, extent) => assert!(extent.is_none() && !found.occupied, "{extent:?}"),
            (Some(found), Some(extent)) => {
                for side in 0..6 {
                    let (end, axis) = (side / 3, side % 3);
                    assert!(holds(found[end][axis], extent[end][axis]), "{found:?}, {extent:?}");
                }
            }
            (Some(_), None) => {}
        }
        if let (Some(corners), true, StopReason::Tolerance) =
            (found.corners, found.occupied, found.stop_reason)
        {
            let most = self.tolerance.max(self.frame.edge() * 2f64.powi(-44)) + 1e-13 * self.frame.edge();
            assert!(corners.iter().flatten().all(|side| side.width() <= most), "{corners:?}, {most}");
        }
    }

    fn interference(&self) {
        let (a, b) = (self.a, self.b);
        let found =
            self.by_threads(|control| interference(&a.solid, &b.solid, self.frame, self.tolerance, control));
        let common = a.truth.joined(&b.truth, |a, b| a && b);
        let volume = common.volume(self.universe());
        assert!(found.volume.lower <= volume * (1.0 + 1e-12), "{found:?}, {volume}");
        match common.ends_in(self.universe()) {
            true => assert!(holds(found.volume, volume), "{found:?}, {volume}"),
            false => assert!(found.clipped && found.volume.upper == f64::INFINITY, "{found:?}"),
        }
        match found.verdict {
            Overlap::Disjoint => assert!(common == Dense::empty(), "{found:?}"),
            Overlap::Overlapping => assert!(volume > 0.0, "{found:?}"),
            Overlap::Undecided => {}
        }
        assert_eq!(found.witness.is_some(), found.verdict == Overlap::Overlapping);
        assert!(found.witness.is_none_or(|cell| common.in_cell(self.frame, cell).0), "{found:?}");
        if let Some(Ball { centre, radius }) = found.ball {
            // A cube inside the ball.
            let reach = 0.57 * radius;
            let (min, max) = (centre.map(|c| c - reach), centre.map(|c| c + reach));
            assert!(reach > 0.0 && common.in_box(min, max).1, "{found:?}");
        }
        assert!(found.splits.iter().sum::<u64>() <= self.most(), "{found:?}");
        // The order of the operands does not matter.
        let other = interference(&b.solid, &a.solid, self.frame, self.tolerance, &control(self.budget));
        let other = other.expect("nothing is wrong with the question").verdict;
        let both = [found.verdict, other];
        assert!(!(both.contains(&Overlap::Disjoint) && both.contains(&Overlap::Overlapping)));
    }

    fn clearance(&self) {
        let (a, b) = (self.a, self.b);
        let found =
            self.by_threads(|control| clearance(&a.solid, &b.solid, self.frame, self.tolerance, control));
        let truth = a.truth.distance_to(&b.truth).sqrt();
        assert!(holds(found.distance, truth), "{found:?}, {truth}");
        assert!(!found.clipped || found.distance.lower == 0.0);
        if !a.truth.ends_in(self.universe()) || !b.truth.ends_in(self.universe()) {
            assert!(found.clipped);
        }
        if found.stop_reason == StopReason::Tolerance && found.distance.upper < f64::INFINITY {
            assert!(found.distance.width() <= self.tolerance, "{found:?}");
        }
    }

    /// Points with coordinates in quarters. Some are outside the universe, some on faces.
    fn some_points(&self, bytes: &mut Bytes<'_>) -> Vec<[f64; 3]> {
        (0..1 + bytes.below(6)).map(|_| [0; 3].map(|_: i32| bytes.byte() as f64 / 8.0 - 8.0)).collect()
    }

    fn points(&self, bytes: &mut Bytes<'_>) {
        let points = self.some_points(bytes);
        let found = self.by_threads(|control| {
            let mut answers = vec![Membership::Undecided; points.len()];
            contains(&self.a.solid, self.frame, &points, &mut answers, control)?;
            Ok(answers)
        });
        for (&point, answer) in points.iter().zip(found) {
            let (in_closed, in_open) = self.a.truth.at(point);
            match answer {
                Membership::Inside => assert!(in_closed, "{point:?}"),
                Membership::Outside => assert!(!in_open, "{point:?}"),
                Membership::Undecided => {}
            }
        }
    }

    fn distances(&self, bytes: &mut Bytes<'_>) {
        let to = [DistanceTo::Solid, DistanceTo::Complement, DistanceTo::Boundary][bytes.below(3)];
        let points = self.some_points(bytes);
        let found = self
            .by_threads(|control| distances(&self.a.solid, self.frame, &points, to, self.tolerance, control));
        let hollow = self.a.truth.complement();
        for (&point, found) in points.iter().zip(found) {
            let [solid, empty] = [&self.a.truth, &hollow].map(|dense| dense.distance_from(point).sqrt());
            let truth = match to {
                DistanceTo::Solid => solid,
                DistanceTo::Complement => empty,
                DistanceTo::Boundary if solid > 0.0 => solid,
                DistanceTo::Boundary => -empty,
            };
            assert!(holds(found.distance, truth), "{to:?} of {point:?}: {found:?}, {truth}");
            // A signed distance takes two searches.
            assert!(found.splits <= self.most().saturating_mul(2));
            let is_met = found.distance.width() <= self.tolerance || found.distance.lower.is_infinite();
            assert!(found.stop_reason != StopReason::Tolerance || is_met, "{found:?}");
        }
    }

    fn content(&self) {
        let (a, b) = (self.a, self.b);
        let volume = self.by_threads(|control| volume_in(&a.solid, &b.solid, self.frame, control));
        let truth = a.truth.joined(&b.truth, |a, b| a && b).volume(self.universe());
        assert!(holds(volume, truth), "{volume:?}, {truth}");
        let found = self.by_threads(|control| cells_in(&a.solid, &b.solid, self.frame, control));
        let (mut both_full, mut both_met, mut within) = (0, 0, 0);
        let depth = self.frame.depth();
        for index in 0..1u32 << (3 * depth) {
            let at = [0, 1, 2].map(|axis| index >> (u32::from(depth) * axis) & (self.frame.cells() - 1));
            let cell = leafless::Cell { level: depth, at };
            let [a, b] = [&a.truth, &b.truth].map(|dense| dense.in_cell(self.frame, cell));
            both_full += u64::from(a.1 && b.1);
            both_met += u64::from(a.0 && b.0);
            within += u64::from(b.1);
        }
        assert!(
            found.full_least <= both_full && both_met <= found.upper_most,
            "{found:?}, {both_full}, {both_met}"
        );
        assert!(found.full_least <= found.full_most && found.full_most <= found.upper_most, "{found:?}");
        assert!(found.full_least <= found.upper_least && found.upper_least <= found.upper_most, "{found:?}");
        assert!(found.upper_least <= within, "{found:?}, {within}");
    }

    /// A ray with a direction of small integers, from a point on no edge, with its changes of cells and
    /// whether it is in the solid between them.
    fn some_ray(&self, bytes: &mut Bytes<'_>) -> Option<Known> {
        let from = [0.125, 0.375, 0.6875].map(|part| bytes.below(20) as f64 - 2.0 + part);
        let direction = [0; 3].map(|_: i32| bytes.below(5) as f64 - 2.0);
        let ray = Ray::new(from, direction).ok()?;
        let [min, max] = self.universe();
        // The time range of the ray in the universe.
        let (mut first, mut last) = (0f64, f64::INFINITY);
        let mut places = Vec::new();
        for axis in 0..3 {
            if direction[axis] == 0.0 {
                if !(min[axis]..max[axis]).contains(&from[axis]) {
                    last = -1.0;
                }
                continue;
            }
            let at = |plane: f64| (plane - from[axis]) / direction[axis];
            let [near, far] = [at(min[axis]), at(max[axis])];
            (first, last) = (first.max(near.min(far)), last.min(near.max(far)));
            places.extend((-40..60).map(|plane| at(f64::from(plane))));
        }
        if first >= last {
            return Some(Known { from, direction, ray, pieces: Vec::new() });
        }
        places.retain(|&t| first < t && t < last);
        places.extend([first, last]);
        places.sort_by(f64::total_cmp);
        let pieces = places.windows(2).filter(|pair| pair[0] < pair[1]).map(|pair| {
            let middle = 0.5 * (pair[0] + pair[1]);
            let point = [0, 1, 2].map(|axis| from[axis] + middle * direction[axis]);
            (pair[0], pair[1], self.a.truth.at(point).0)
        });
        Some(Known { from, direction, ray, pieces: pieces.collect() })
    }

    fn rays(&self, bytes: &mut Bytes<'_>) {
        let asked: Vec<_> = (0..1 + bytes.below(4)).filter_map(|_| self.some_ray(bytes)).collect();
        let rays: Vec<Ray> = asked.iter().map(|known| known.ray).collect();
        for on in [Obstacle::Full, Obstacle::Upper] {
            let found = self.by_threads(|control| cast_rays(&self.a.solid, self.frame, &rays, on, control));
            for (known, hit) in asked.iter().zip(found) {
                let ray = known.ray;
                let first = known.pieces.iter().find(|piece| piece.2).map(|piece| piece.0);
                // Before, a ray may touch the solid in a face, an edge or a corner.
                match (hit, first) {
                    (Some(hit), Some(first)) => {
                        let slack = 1e-12 * (1.0 + first);
                        assert!(hit.t.lower <= first + slack, "{on:?}: {ray:?}, {hit:?}, {first}");
                    }
                    (None, Some(_)) => assert!(on == Obstacle::Full, "{ray:?}"),
                    _ => {}
                }
                if let Some(hit) = hit.filter(|hit| hit.t.upper < f64::INFINITY) {
                    assert!(self.touches(known, hit.t.upper), "{on:?}: {ray:?}, {hit:?}");
                }
            }
        }
    }

    /// True if a point of a ray is in the closed solid, up to rounding.
    fn touches(&self, known: &Known, t: f64) -> bool {
        let point = [0, 1, 2].map(|axis| known.from[axis] + t * known.direction[axis]);
        (0..27).any(|k: i32| {
            let near = [k % 3, k / 3 % 3, k / 9].map(|step| f64::from(step - 1) * 1e-9);
            self.a.truth.at([0, 1, 2].map(|axis| point[axis] + near[axis])).0
        })
    }

    fn spans(&self, bytes: &mut Bytes<'_>) {
        let Some(Known { ray, pieces, .. }) = self.some_ray(bytes) else { return };
        let found = self.by_threads(|control| ray_spans(&self.a.solid, self.frame, &ray, control));
        for &(from, to, inside) in &pieces {
            let middle = 0.5 * (from + to);
            let within = |spans: &[Interval]| spans.iter().any(|span| span.contains(middle));
            assert!(!inside || within(&found.outer), "{ray:?} at {middle}: {found:?}");
            assert!(inside || !within(&found.inner), "{ray:?} at {middle}: {found:?}");
        }
        for spans in [&found.inner, &found.outer] {
            assert!(spans.windows(2).all(|pair| pair[0].upper < pair[1].lower), "{found:?}");
        }
        for inner in &found.inner {
            let around = |outer: &Interval| outer.lower <= inner.lower && inner.upper <= outer.upper;
            assert!(found.outer.iter().any(around), "{found:?}");
        }
    }

    fn sight(&self, bytes: &mut Bytes<'_>) {
        let [from, to] = [(); 2].map(|()| [0; 3].map(|_: i32| bytes.below(80) as f64 / 4.0 - 2.0));
        let asked = line_of_sight(&self.a.solid, self.frame, from, to, &control(self.budget));
        let Ok(found) = asked else { return assert_eq!(from, to) };
        // Samples of the segment. Coordinates are quarters, so that these samples are exact.
        let points = (0..=64).map(|k| {
            let t = f64::from(k) / 64.0;
            [0, 1, 2].map(|axis| from[axis] + t * (to[axis] - from[axis]))
        });
        let [min, max] = self.universe();
        let in_universe =
            |point: &[f64; 3]| (0..3).all(|axis| min[axis] < point[axis] && point[axis] < max[axis]);
        match found {
            Sight::Clear => {
                assert!(
                    !points.filter(in_universe).any(|point| self.a.truth.at(point).1),
                    "{from:?}, {to:?}"
                );
            }
            Sight::Blocked => {
                // Some point is in the closed solid, so that the segment's box meets or touches it.
                let low = [0, 1, 2].map(|axis| from[axis].min(to[axis]) - 0.125);
                let high = [0, 1, 2].map(|axis| from[axis].max(to[axis]) + 0.125);
                assert!(self.a.truth.in_box(low, high).0, "{from:?}, {to:?}");
            }
            Sight::Undecided => {}
        }
    }

    fn columns(&self, bytes: &mut Bytes<'_>) {
        let (frame, truth) = (self.frame, &self.a.truth);
        let code = bytes.byte();
        let (axis, cells, depth) = (code % 3, frame.cells(), frame.depth());
        let chosen = match code / 3 % 3 {
            0 => {
                let first = [0; 2].map(|_: i32| bytes.below(cells as usize) as u32);
                Columns::within(axis, first, first.map(|c| (c + 1 + code as u32 / 16).min(cells)))
            }
            _ => Columns::all(frame, axis),
        };
        let chosen = chosen.expect("good columns");
        let found = self.by_threads(|control| columns(&self.a.solid, frame, &chosen, control));
        let side = if code >= 128 { Side::Above } else { Side::Below };
        let reach = self.by_threads(|control| heights(&self.a.solid, frame, &chosen, side, control));
        let across = [[1, 2], [0, 2], [0, 1]][axis];
        for v in 0..chosen.size()[1] {
            for u in 0..chosen.size()[0] {
                let column = [chosen.first()[0] + u, chosen.first()[1] + v];
                let place = chosen.index(column).expect("one of the columns");
                let mut at = [0; 3];
                (at[across[0]], at[across[1]]) = (column[0], column[1]);
                let mut firsts = [None; 2];
                let cells: Vec<u32> =
                    if side == Side::Above { (0..cells).rev().collect() } else { (0..cells).collect() };
                for c in cells {
                    at[axis] = c;
                    let (met, covered) = truth.in_cell(frame, leafless::Cell { level: depth, at });
                    let within = |runs: &[leafless::query::Run]| {
                        runs.iter().any(|run| (run.start..run.start + run.length).contains(&c))
                    };
                    let [full, upper] = [within(found.full.column(place)), within(found.upper.column(place))];
                    assert!((covered || !full) && (upper || !met), "{at:?}: {met} {covered}, {full} {upper}");
                    let plane = if side == Side::Above { c + 1 } else { c };
                    for (first, has) in firsts.iter_mut().zip([full, upper]) {
                        if has && first.is_none() {
                            *first = Some(plane);
                        }
                    }
                }
                // Cells behind a FULL cell are not examined, so that both give the same.
                assert_eq!(
                    firsts,
                    [reach.full_plane(place), reach.upper_plane(place)],
                    "{column:?}, {side:?}"
                );
            }
        }
    }

    fn box_region(&self, bytes: &mut Bytes<'_>) {
        let (min, max) = corners(bytes);
        let shift = [0.0, 0.5, 0.25, -1.5][bytes.below(4)];
        let [min, max] = [min, max].map(|corner| doubles(corner).map(|c| c + shift));
        let found = self.by_threads(|control| classify_box(&self.a.solid, self.frame, min, max, control));
        let (met, covered) = self.a.truth.in_box(min, max);
        self.region_is(found, met, covered);
    }

    fn region(&self) {
        let found = self.by_threads(|control| classify_in(&self.a.solid, &self.b.solid, self.frame, control));
        let common = self.a.truth.joined(&self.b.truth, |a, b| a && b) != Dense::empty();
        let beyond = self.b.truth.joined(&self.a.truth, |a, b| a && !b) != Dense::empty();
        self.region_is(found, common, !beyond);
    }

    fn region_is(&self, found: Region, met: bool, covered: bool) {
        match found {
            Region::Outside => assert!(!met),
            Region::Inside => assert!(covered),
            Region::Crossing => assert!(met && !covered),
            Region::Undecided => {}
        }
    }
}
