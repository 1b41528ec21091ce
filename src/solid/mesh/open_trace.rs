//! Rays of open meshes, without a descent through cells.
//!
//! An open mesh bounds the solid at its triangles, and where its winding number is one half. The triangles
//! ahead of a point of the ray count the winding number of the surface with cones over the rim. The cones'
//! own number (`rim_line`) is subtracted. Where the cones' number is less than one half in magnitude all
//! along the ray, the ray is traced as for a closed mesh. Otherwise the number is bounded from triangle to
//! triangle: by the sums at both ends, by its change around the middle (an interval Newton step), and by
//! bisection.

use super::direct::{Direct, Touched, Tracer, together};
use super::rim::{self, Rim};
use super::rim_line::{RimLine, Sums};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Interval, Ray, axes};
use crate::mesh::{FillRule, Hit, Shift, Wanted};
use crate::solid::{RayCrossing, RayQuestion, RayTrace};
use glam::DVec3;

/// The most evaluations of the rim for one ray.
const MOST_LOOKS: usize = 256;

/// A stretch shorter than this fraction of the distance to the rim is not divided further.
const SHORTEST: f64 = 1.0 / (1 << 20) as f64;

impl Tracer<'_> {
    /// Finds where a ray enters and leaves the solid of an open mesh. The trace stays unknown if the ray
    /// comes very near to the rim, or if many evaluations leave the winding number open.
    pub(super) fn trace_open(
        &self,
        direct: &mut Direct,
        rim: &Rim,
        question: RayQuestion<'_>,
    ) -> Result<(), Error> {
        let RayQuestion { ray, is_first_enough, trace } = question;
        trace.clear();
        // For a ray from outside, the winding number is zero far back on its line, and does not change until
        // the mesh.
        let is_outside = self.tree.way_out(&ray.from).is_none();
        let way = DVec3::from(ray.direction.each(|[high, _]| high));
        let course = rim::Course::new(DVec3::from(ray.from), way, is_outside);
        // Far loops are skipped, unless they matter.
        let mut is_plain = rim.most_along(&course) < 0.49;
        for least in [0.05, 0.0] {
            if is_plain {
                return self.trace(direct, RayQuestion { ray, is_first_enough, trace });
            }
            if !direct.line.look(rim, ray, &course, least)? {
                return Ok(());
            }
            let all = direct.line.sums(if is_outside { f64::NEG_INFINITY } else { 0.0 });
            is_plain = all.left.max(-all.right) + all.error + direct.line.others() < 0.49;
        }
        if !self.tree.pierced(ray, Wanted::All, Shift::ALL[0], &mut direct.hits)? {
            return Ok(());
        }
        let follow = |direct: &mut Direct, is_first_enough: bool, trace: &mut RayTrace| {
            direct.arrange()?;
            let Direct { hits, touched, line } = direct;
            let touched = Touched { hits: touched, tree: &self.tree };
            let mut course = Course {
                tracer: self,
                rim,
                line,
                ray,
                is_first_enough,
                looks: 0,
                found: Found { trace, touched, before: None, since: -1.0, open: None },
            };
            let is_known = course.follow(hits)?;
            if !is_known {
                trace.clear();
            }
            Ok::<bool, Error>(is_known)
        };
        if !follow(direct, is_first_enough, trace)? || !trace.has_touches() {
            return Ok(());
        }
        // A closed mesh takes the same path: points that the ray only touches may be inside on another side.
        if trace.until < f64::INFINITY {
            trace.clear();
            // (The touches were moved to their own list.)
            self.tree.pierced(ray, Wanted::All, Shift::ALL[0], &mut direct.hits)?;
            if !follow(direct, false, trace)? {
                return Ok(());
            }
        }
        for shift in &Shift::ALL[1..] {
            if !trace.has_touches() {
                break;
            }
            self.tree.pierced(ray, Wanted::All, *shift, &mut direct.hits)?;
            let mut other = RayTrace::UNKNOWN;
            if !follow(direct, false, &mut other)? {
                break;
            }
            *trace = trace.united(&other)?;
        }
        Ok(())
    }
}

/// The result for a ray so far.
struct Found<'t> {
    trace: &'t mut RayTrace,
    touched: Touched<'t>,
    /// The side on which the ray was last known to be: whether inside.
    before: Option<bool>,
    /// The time since which this side has been known.
    since: f64,
    /// A crossing during which the ray may be on either side.
    open: Option<RayCrossing>,
}

impl Found<'_> {
    /// Notes that the ray is on one side from a time on.
    fn known(&mut self, from: f64, is_inside: bool) -> Result<(), Error> {
        if self.open.is_none() {
            match self.before {
                Some(before) if before == is_inside => return Ok(()),
                Some(_) => self.unknown(RayCrossing {
                    t: Interval::exactly(from),
                    is_inside_after: false,
                    is_met: false,
                    normal: [0.0; 3],
                    surface: None,
                })?,
                None => {
                    (self.trace.begins_inside, self.before) = (is_inside, Some(is_inside));
                    return Ok(());
                }
            }
        }
        let Some(mut open) = self.open.take() else { return Ok(()) };
        open.is_met |= is_inside || self.before == Some(true);
        open.is_inside_after = is_inside;
        self.trace.push(open)?;
        (self.before, self.since) = (Some(is_inside), from.max(open.t.upper));
        Ok(())
    }

    /// Ends the trace where the ray has just entered the solid, or where it begins.
    fn end(&mut self) {
        self.trace.until = self.trace.crossings.last().map_or(0.0, |crossing| crossing.t.upper);
    }

    /// Notes that the ray may be on either side during the time of a crossing.
    fn unknown(&mut self, crossing: RayCrossing) -> Result<(), Error> {
        let t = Interval::between(crossing.t.lower.max(0.0), crossing.t.upper.max(0.0));
        match &mut self.open {
            Some(open) => {
                let (t, is_met) = (open.t.joined(t), open.is_met || crossing.is_met);
                // The first crossing of the time may only be a touch, unless the ray came from inside.
                let kept = if self.before == Some(true) { *open } else { crossing };
                *open = RayCrossing { t, is_met, ..kept };
            }
            none => {
                if self.before == Some(false) {
                    self.touched.note(self.since, t.lower, self.trace)?;
                }
                *none = Some(RayCrossing { t, ..crossing });
            }
        }
        Ok(())
    }
}

/// A ray that is followed from triangle to triangle.
struct Course<'c> {
    tracer: &'c Tracer<'c>,
    rim: &'c Rim,
    line: &'c RimLine,
    ray: &'c Ray,
    is_first_enough: bool,
    looks: usize,
    found: Found<'c>,
}

/// The outcome of a stretch.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Next {
    GoOn,
    /// The rest of the ray is not needed.
    Enough,
    /// The stretch took too many evaluations.
    GiveUp,
}

impl Course<'_> {
    /// Follows the winding number along the hits, in order. Returns `false` if the number stays undecided.
    fn follow(&mut self, hits: &[Hit]) -> Result<bool, Error> {
        let mut winding = -hits.iter().map(|hit| hit.step).sum::<i32>();
        let (mut now, mut rest) = (self.look(0.0), hits);
        loop {
            let next = match rest.first() {
                Some(hit) => self.look(hit.t.lower.max(now.at)),
                None => Sums::END,
            };
            // (No time passes before a triangle on which the ray begins: an error of its time belongs to the
            // hit.)
            match self.stretch(winding, &now, &next)? {
                Next::GoOn => {}
                Next::Enough => return Ok(true),
                Next::GiveUp => return Ok(false),
            }
            if rest.is_empty() {
                break;
            }
            let (count, until) = together(rest);
            let (met, behind) = rest.split_at(count);
            rest = behind;
            now = if until > next.at { self.look(until) } else { next };
            self.pass(winding, met, &next, &now)?;
            winding += met.iter().map(|hit| hit.step).sum::<i32>();
        }
        let Found { trace, touched, before, since, open } = &mut self.found;
        if open.is_some() {
            return Ok(false);
        }
        if *before == Some(false) {
            touched.note(*since, f64::INFINITY, trace)?;
        }
        trace.until = f64::INFINITY;
        Ok(true)
    }

    fn look(&mut self, at: f64) -> Sums {
        self.looks += 1;
        self.line.sums(at)
    }

    /// Returns the side of the ray between two times. Triangles between them may change the number by `falls`
    /// to `rises`. `None` if unsure.
    fn side(&self, winding: i32, [falls, rises]: [i32; 2], from: &Sums, to: &Sums) -> Option<bool> {
        let [least, most] = from.until(to);
        let (low, high) = (f64::from(winding + falls) - most, f64::from(winding + rises) - least);
        self.tracer.fill.encloses_all(low, high)
    }

    /// Passes triangles that have the same time, up to rounding.
    fn pass(&mut self, winding: i32, met: &[Hit], from: &Sums, to: &Sums) -> Result<(), Error> {
        let falls = met.iter().map(|hit| hit.step.min(0)).sum::<i32>();
        let rises = met.iter().map(|hit| hit.step.max(0)).sum::<i32>();
        if let Some(is_inside) = self.side(winding, [falls, rises], from, to) {
            return self.found.known(from.at, is_inside);
        }
        let fill = self.tracer.fill;
        let holds = |winding: i32| fill.excess(f64::from(winding) - from.value()) > 0.0;
        let before = holds(winding);
        let mut after = winding;
        let first = met.iter().find(|hit| {
            after += hit.step;
            holds(after) != before
        });
        let first = first.unwrap_or(&met[0]);
        let normal = self.tracer.tree.normal(first.triangle);
        // A ray that leaves the solid through the back of a triangle leaves along the triangle's normal.
        let normal = if (first.step < 0) == before { normal } else { normal.each(|n| -n) };
        let tree = &self.tracer.tree;
        // Each first step leads inside. (With a displacement, it is unknown which triangles lie in one
        // plane.)
        let is_met = tree.displacement() == 0.0
            && met.iter().all(|first| {
                let plane = met.iter().filter(|hit| tree.are_coplanar(first.triangle, hit.triangle));
                let step = plane.map(|hit| hit.step).sum::<i32>();
                self.side(winding, [step; 2], from, to) == Some(true)
            });
        let t = self.found.touched.joined(Interval::between(from.at, to.at));
        let surface = Some(first.triangle);
        self.found.unknown(RayCrossing { t, is_inside_after: false, is_met, normal, surface })
    }

    /// Goes from one time to another without a triangle between them.
    fn stretch(&mut self, winding: i32, from: &Sums, to: &Sums) -> Result<Next, Error> {
        if let Some(is_inside) = self.side(winding, [0; 2], from, to) {
            self.found.known(from.at, is_inside)?;
            if is_inside && self.is_first_enough {
                self.found.end();
                return Ok(Next::Enough);
            }
            return Ok(Next::GoOn);
        }
        if self.looks >= MOST_LOOKS {
            return Ok(Next::GiveUp);
        }
        if to.at == f64::INFINITY {
            // Far away the number vanishes.
            let further = from.at + (from.at - 0.5 * self.line.end()).abs() + 1.0 / self.line.speed();
            let middle = self.look(self.line.end().max(further));
            return self.halves(winding, [from, &middle, to]);
        }
        let middle = self.look(0.5 * from.at + 0.5 * to.at);
        let Some(threshold) = self.threshold(winding, from, to) else {
            return self.halves(winding, [from, &middle, to]);
        };
        let Some(mut root) = self.root(winding, threshold, Interval::between(from.at, to.at), &middle) else {
            // Bisection is useless where it would not narrow the number.
            let is_short = to.at - from.at <= 4.0 * f64::EPSILON * to.at || {
                let reach = (to.at - from.at) * self.line.speed();
                reach <= SHORTEST * self.line.change(middle.at).distance()
            };
            if is_short {
                self.unknown(threshold, Interval::between(from.at, to.at))?;
                return Ok(Next::GoOn);
            }
            return self.halves(winding, [from, &middle, to]);
        };
        while self.looks < MOST_LOOKS {
            let middle = self.look(0.5 * root.t.lower + 0.5 * root.t.upper);
            match self.root(winding, threshold, root.t, &middle) {
                // (Bisect instead where the change is not known well.)
                Some(next) if next.t.width() < 0.75 * root.t.width() => root.t = next.t,
                _ => break,
            }
        }
        // Positive numbers are inside above one half, negative ones below minus one half.
        let is_inside_after = root.rises == (threshold > 0.0);
        if root.t.lower > from.at {
            self.found.known(from.at, !is_inside_after)?;
            if !is_inside_after && self.is_first_enough {
                self.found.end();
                return Ok(Next::Enough);
            }
        }
        if root.t.lower < root.t.upper || from.at < root.t.lower && root.t.upper < to.at {
            self.unknown(threshold, root.t)?;
        }
        if root.t.upper < to.at {
            self.found.known(root.t.upper, is_inside_after)?;
            if is_inside_after && self.is_first_enough {
                self.found.end();
                return Ok(Next::Enough);
            }
        }
        Ok(Next::GoOn)
    }

    fn halves(&mut self, winding: i32, [from, middle, to]: [&Sums; 3]) -> Result<Next, Error> {
        match self.stretch(winding, from, middle)? {
            Next::GoOn => self.stretch(winding, middle, to),
            next => Ok(next),
        }
    }

    /// Returns the only threshold between inside and outside that the number may pass between two times.
    /// `None` if it may pass both.
    fn threshold(&self, winding: i32, from: &Sums, to: &Sums) -> Option<f64> {
        let [least, most] = from.until(to);
        let (low, high) = (f64::from(winding) - most, f64::from(winding) - least);
        if self.tracer.fill == FillRule::Positive || low > -0.5 {
            Some(0.5)
        } else if high < 0.5 {
            Some(-0.5)
        } else {
            None
        }
    }

    /// Returns when the winding number passes a threshold in a stretch around a look. The number must surely
    /// rise, or surely fall, in the whole stretch. The result is an interval with different sides before and
    /// behind it. `None` if unsure.
    fn root(&self, winding: i32, threshold: f64, stretch: Interval, middle: &Sums) -> Option<Root> {
        let speed = self.line.speed();
        let reach = (middle.at - stretch.lower).max(stretch.upper - middle.at) * speed;
        let reach = reach * (1.0 + 1e-12) + f64::EPSILON;
        let change = self.line.change(middle.at);
        // (This is false for NaN, too.)
        let is_near = reach < 0.5 * change.distance();
        if !is_near {
            return None;
        }
        let [least, most] = change.within(reach);
        // The change of the winding number per unit of time.
        let slope = Interval::new(-most, -least)?.times(Interval::exactly(speed));
        let slope = slope.times(Interval::new(1.0 - 1e-12, 1.0 + 1e-12)?);
        if slope.contains(0.0) {
            return None;
        }
        let excess = f64::from(winding) - middle.value() - threshold;
        let wide = middle.error + 1e-15 * (1.0 + excess.abs());
        let excess = Interval::new(excess - wide, excess + wide)?;
        let rises = slope.lower > 0.0;
        let (fallen, steepness) = if rises { (excess, slope) } else { (excess.negated(), slope.negated()) };
        let t = Interval::exactly(middle.at).minus(fallen.over(steepness));
        // (If the threshold is passed before or after the stretch, the whole stretch is on one side.)
        let lower = t.lower.clamp(stretch.lower, stretch.upper);
        let upper = t.upper.clamp(stretch.lower, stretch.upper);
        Some(Root { t: Interval::new(lower, upper)?, rises })
    }

    /// Notes that the ray may pass the surface where the winding number is a threshold.
    fn unknown(&mut self, threshold: f64, t: Interval) -> Result<(), Error> {
        let middle = 0.5 * t.lower + 0.5 * t.upper;
        let at = axes(|axis| {
            let [high, low] = self.ray.direction[axis];
            self.ray.from[axis] + middle * high + middle * low
        });
        // The surface's own number changes opposite to the caps'.
        let normal = self.rim.gradient(at).to_array();
        let normal = if threshold > 0.0 { normal } else { normal.each(|n| -n) };
        self.found.unknown(RayCrossing { t, is_inside_after: false, is_met: false, normal, surface: None })
    }
}

/// The time at which a winding number passes a threshold.
struct Root {
    t: Interval,
    /// Whether the number rises.
    rises: bool,
}
