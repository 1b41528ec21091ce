//! The winding number of caps along a line, from the rim alone.
//!
//! Consider cones over the rim that lead back along the line, to a point at infinity behind it. They meet the
//! line only where it passes the rim itself. So their winding number changes smoothly along the line, and it
//! is zero infinitely far ahead. The surface's number differs from it only by the count of the triangles
//! ahead.
//!
//! Seen along the line, a corner of the rim lies at the complex number ρ across it, and at a height. Let r be
//! its distance from a point of the line, and s the distance by which it lies behind. Then half the solid
//! angle of an edge's cone is the argument of g g' + ρ̄ ρ', where g = r + s. Along the line g grows and ρ
//! stays constant, so that each angle tends monotonically to zero. Therefore the sum of the positive angles
//! and the sum of the negative angles bound the winding number between any two points of the line.
//!
//! **Errors.** A corner with an error of δ changes g by less than 2δ. To first order, it changes the angle by
//! δ (|ρ| + |ρ'|) / |g g' + ρ̄ ρ'|. All corners lie much further from the line than δ, and twice that bound
//! covers the higher orders.

use super::rim::{Course, Rim};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Ray;
use crate::lattice::exact::sqrt;
use crate::memory;
use alloc::vec::Vec;
use core::f64::consts::TAU;
use glam::{DVec2, DVec3};

/// The error of positions, as a fraction of the distance from the line's start.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The least distance of corners from the line, in errors of a corner.
const APART: f64 = 64.0;

/// Beyond this many times the rim's distance, the winding number is zero.
const FAR: f64 = 1e60;

/// The side on which the line passes an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// The corner is the first of a walk, or the edge's angle is negligible.
    None,
    Left,
    Right,
}

/// A corner of the rim as seen along the line, with its edge from the corner before.
#[derive(Debug, Clone, Copy)]
struct Corner {
    across: DVec2,
    square: f64,
    height: f64,
    side: Side,
    /// ρ̄ ρ' of the edge.
    real: f64,
    imaginary: f64,
    /// |ρ| + |ρ'| and |ρ| |ρ'|, or slightly more.
    sum: f64,
    product: f64,
}

/// The rim of a mesh along a line. The unit of length is such that its corners lie within about 1 of the
/// line's start.
#[derive(Default)]
pub(super) struct RimLine {
    corners: Vec<Corner>,
    /// The error of corners.
    error: f64,
    /// The contribution of edges in the line's plane, in turns.
    unsure: f64,
    /// Lengths per unit of time.
    speed: f64,
    /// The time when the line has passed all corners.
    end: f64,
    /// A bound of the contribution of loops that are skipped.
    others: f64,
}

/// The sums of the angles at one time, in turns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums {
    pub(super) at: f64,
    /// The sum of the positive angles, which only falls with time, and the sum of the negative angles, which
    /// only rises.
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) error: f64,
}

/// The rate of change of the sums.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    left: f64,
    right: f64,
    error: f64,
    /// The distance to the rim.
    distance: f64,
}

/// A sum of angles between 0 and half a turn.
struct Angles {
    real: f64,
    imaginary: f64,
    turns: f64,
}

impl Angles {
    const NONE: Angles = Angles { real: 1.0, imaginary: 0.0, turns: 0.0 };

    /// Adds the angle of a number of modulus 1.
    #[inline(always)]
    fn add(&mut self, real: f64, imaginary: f64) {
        let Angles { real: x, imaginary: y, .. } = *self;
        self.real = x * real - y * imaginary;
        self.imaginary = x * imaginary + y * real;
        // Beyond half a turn. (Near zero turns, rounding may change the sign, too.)
        if self.imaginary < 0.0 && y >= 0.0 && (x < 0.0 || self.real < 0.0) {
            self.turns += 1.0;
        }
    }

    fn in_turns(&self) -> f64 {
        libm::atan2(self.imaginary + 0.0, self.real) / TAU + self.turns
    }
}

impl Sums {
    /// The sums infinitely far ahead.
    pub(super) const END: Sums = Sums { at: f64::INFINITY, left: 0.0, right: 0.0, error: 0.0 };

    /// The caps' winding number.
    pub(super) fn value(&self) -> f64 {
        self.left + self.right
    }

    /// Returns the least and the greatest winding number from this time until the time of `later`.
    pub(super) fn until(&self, later: &Sums) -> [f64; 2] {
        let error = self.error + later.error;
        [later.left + self.right - error, self.left + later.right + error]
    }
}

impl RimLine {
    /// Prepares a ray: projects the loops of a rim whose caps' winding number may reach `least` on the ray's
    /// course. Returns `false` if the ray comes too near to such a loop, or numbers are too large. O(n) in
    /// the edges.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn look(&mut self, rim: &Rim, ray: &Ray, course: &Course, least: f64) -> Result<bool, Error> {
        self.corners.clear();
        let from = DVec3::from(ray.from);
        let mut reach = DVec3::ZERO;
        self.others = rim.near_loops(course, least, |edges| {
            reach = edges.iter().fold(reach, |most, [p, _]| most.max((*p - from).abs()));
        });
        let reach = reach.max_element();
        if reach == 0.0 {
            (self.error, self.unsure, self.speed, self.end) = (0.0, 0.0, 1.0, 0.0);
            return Ok(true);
        }
        // About the next power of two.
        let scale = f64::from_bits((2045 - (reach.to_bits() >> 52 & 0x7FF).clamp(1, 2044)) << 52);
        let way = DVec3::from(ray.direction.each(|[high, _]| high));
        let length = sqrt(way.length_squared());
        let along = way / length;
        let speed = length * scale;
        let is_usual = (1e-100..1e100).contains(&reach) && (1e-200..1e200).contains(&speed);
        if !is_usual {
            return Ok(false);
        }
        let size = along.abs();
        let axis = if size.x <= size.y && size.x <= size.z {
            DVec3::X
        } else if size.y <= size.z {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let u = axis.cross(along);
        let u = u / sqrt(u.length_squared());
        let v = along.cross(u);
        (self.error, self.speed) = (2.0 * ROUNDING + 2.0 * rim.vertex_error * scale, speed);
        (self.unsure, self.end) = (0.0, 0.0);
        let nearest = APART * APART * self.error * self.error;
        let mut end = f64::NEG_INFINITY;
        let mut before: Option<(DVec3, Corner)> = None;
        let mut meet = |&[to, start]: &[DVec3; 2]| -> Result<bool, Error> {
            let seen = |p: DVec3| {
                let p = (p - from) * scale;
                let across = DVec2::new(p.dot(u), p.dot(v));
                Corner {
                    across,
                    square: across.length_squared(),
                    height: p.dot(along),
                    side: Side::None,
                    real: 0.0,
                    imaginary: 0.0,
                    sum: 0.0,
                    product: 0.0,
                }
            };
            let first = match before {
                Some((place, corner)) if place == start => corner,
                _ => {
                    let corner = seen(start);
                    memory::push(&mut self.corners, corner)?;
                    corner
                }
            };
            let mut corner = seen(to);
            end = corner.height.max(end);
            // (No less than the magnitudes.)
            let [one, other] = [first.across, corner.across].each(|across| across.abs().element_sum());
            (corner.sum, corner.product) = (one + other, one * other);
            corner.real = first.across.dot(corner.across);
            corner.imaginary = first.across.perp_dot(corner.across);
            let wrong = 2.0 * (self.error * corner.sum + 4.0 * f64::EPSILON * corner.product);
            if corner.square <= nearest || first.square <= nearest {
                return Ok(false);
            }
            if corner.imaginary > wrong {
                corner.side = Side::Left;
            } else if corner.imaginary < -wrong {
                corner.side = Side::Right;
            } else if corner.real > 0.0 {
                self.unsure += 2.0 * wrong / corner.real;
            } else {
                return Ok(false);
            }
            memory::push(&mut self.corners, corner)?;
            before = Some((to, corner));
            Ok(true)
        };
        let mut seen = Ok(true);
        rim.near_loops(course, least, |edges| {
            for edge in edges {
                if matches!(seen, Ok(true)) {
                    seen = meet(edge);
                }
            }
        });
        if !seen? {
            return Ok(false);
        }
        self.end = end.max(0.0) / speed;
        // (In turns, the limit would be a sixth of this.)
        Ok(self.unsure < 0.25)
    }

    /// A bound of the contribution of loops that are skipped.
    pub(super) fn others(&self) -> f64 {
        self.others
    }

    /// The time when the ray has passed all corners.
    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// Lengths per unit of time.
    pub(super) fn speed(&self) -> f64 {
        self.speed
    }

    /// Returns g of a corner at a point of the line (the corner's distance plus the length by which it lies
    /// behind), and its distance.
    #[inline(always)]
    fn seen(corner: &Corner, at: f64) -> [f64; 2] {
        let behind = at - corner.height;
        let distance = sqrt(corner.square + behind * behind);
        let sum = distance + behind.abs();
        [if behind >= 0.0 { sum } else { corner.square / sum }, distance]
    }

    /// The error of positions along the ray.
    fn error_at(&self, at: f64) -> f64 {
        self.error + ROUNDING * at
    }

    /// Returns the sums at a time, which must not be negative unless the ray is far before the rim. O(n) in
    /// the edges.
    pub(super) fn sums(&self, time: f64) -> Sums {
        let at = time * self.speed;
        if at > FAR {
            return Sums { at: time, left: 0.0, right: 0.0, error: 1e-50 };
        }
        let is_before = at == f64::NEG_INFINITY;
        let off = 2.0 * if is_before { self.error } else { self.error_at(at) };
        let (mut left, mut right, mut error) = (Angles::NONE, Angles::NONE, 0.0);
        let mut before = 0.0;
        for corner in &self.corners {
            let g = if is_before { 0.0 } else { RimLine::seen(corner, at)[0] };
            if corner.side != Side::None {
                let (x, y) = (g * before + corner.real, corner.imaginary);
                let inverse = 1.0 / sqrt(x * x + y * y);
                error += (off * corner.sum + 16.0 * f64::EPSILON * (g * before + corner.product)) * inverse;
                let (x, y) = (x * inverse, y * inverse);
                match corner.side {
                    Side::Left => left.add(x, y),
                    _ => right.add(x, -y),
                }
            }
            before = g;
        }
        let count = self.corners.len() as f64;
        let error = (error + 16.0 * f64::EPSILON * count + self.unsure) / TAU;
        // (For larger errors the bounds would not hold.)
        let error = if error < 0.02 { error } else { f64::INFINITY };
        Sums { at: time, left: left.in_turns(), right: -right.in_turns(), error }
    }

    /// Returns the rates of change of the sums with the length, at a time. O(n) in the edges.
    pub(super) fn change(&self, time: f64) -> Change {
        let at = time * self.speed;
        let off = 2.0 * self.error_at(at);
        let mut change = Change { left: 0.0, right: 0.0, error: 0.0, distance: f64::INFINITY };
        let (mut before, mut place) = ([0.0, 1.0], DVec3::ZERO);
        for (k, corner) in self.corners.iter().enumerate() {
            let seen = RimLine::seen(corner, at);
            let here = corner.across.extend(corner.height - at);
            // (The very first corner begins a walk.)
            if k > 0 && corner.sum > 0.0 {
                let edge = here - place;
                let part = (-place.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
                let nearest = place + if part.is_nan() { 0.0 } else { part } * edge;
                change.distance = change.distance.min(sqrt(nearest.length_squared()));
                let g = seen[0] * before[0];
                let x = g + corner.real;
                let square = x * x + corner.imaginary * corner.imaginary;
                let times = g * (1.0 / seen[1] + 1.0 / before[1]) / square;
                let slope = -corner.imaginary * times;
                let wrong = off * corner.sum + 16.0 * f64::EPSILON * (g + corner.product);
                change.error += wrong * times * (1.0 + 4.0 * corner.imaginary.abs() / sqrt(square));
                match corner.side {
                    Side::Left => change.left += slope,
                    Side::Right => change.right += slope,
                    Side::None => change.error += slope.abs(),
                }
            }
            (before, place) = (seen, here);
        }
        change.distance = (change.distance - off).max(0.0) * (1.0 - 1e-12);
        let error = change.error + 1e-12 * (change.right - change.left);
        Change { left: change.left / TAU, right: change.right / TAU, error: error / TAU, ..change }
    }
}

impl Change {
    /// The distance to the rim.
    pub(super) fn distance(&self) -> f64 {
        self.distance
    }

    /// Returns the least and the greatest rate of change of the winding number with the length, within
    /// `reach`, which must be less than half the rim's distance. (The rate of each angle is an integral of
    /// constant sign over the inverse cubes of distances, which change by at most `reach`.)
    pub(super) fn within(&self, reach: f64) -> [f64; 2] {
        let part = reach / self.distance;
        let cube = |x: f64| 1.0 / (x * x * x);
        let (least, most) = (cube(1.0 + part) * (1.0 - 1e-9), cube(1.0 - part) * (1.0 + 1e-9));
        let range = |value: f64| {
            let scaled = [value * least, value * most];
            [scaled[0].min(scaled[1]), scaled[0].max(scaled[1])]
        };
        let (left, right) = (range(self.left), range(self.right));
        let error = self.error * most;
        [left[0] + right[0] - error, left[1] + right[1] + error]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use leafless_testkit::Random;

    fn vector(random: &mut Random) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| random.between(-1.0, 1.0)))
    }

    fn ray(random: &mut Random) -> (Ray, DVec3, DVec3) {
        let (from, way) = (vector(random) * 2.0, vector(random));
        let ray = Ray::new(from.to_array(), way.to_array()).unwrap();
        (ray, from, way)
    }

    /// A jagged loop around a random axis, and a triangle somewhere.
    fn rim(random: &mut Random, corners: usize) -> Rim {
        let mut rim = Rim::default();
        let [u, v, middle] = [0; 3].map(|_| vector(random));
        for count in [corners, 3] {
            let first = rim.edges().len();
            let points: Vec<DVec3> = (0..count)
                .map(|k| {
                    let angle = TAU * k as f64 / count as f64;
                    middle + u * libm::cos(angle) + v * libm::sin(angle) + 0.3 * vector(random)
                })
                .collect();
            for k in 0..count {
                rim.push([points[(k + 1) % count], points[k]]).unwrap();
            }
            rim.close(first).unwrap();
        }
        rim
    }

    #[test]
    fn sums_are_those_of_cones_and_bound_what_lies_between() {
        let mut random = Random(1);
        let mut line = RimLine::default();
        let (mut seen, mut told) = (0, 0);
        for round in 0..400 {
            let rim = rim(&mut random, 3 + round % 40);
            let (ray, from, way) = ray(&mut random);
            if !line.look(&rim, &ray, &Course::new(from, way, true), 0.0).unwrap() {
                continue;
            }
            seen += 1;
            let towards = -way / sqrt(way.length_squared());
            let times = [0.0, 0.1, 0.5, 1.0, 1.7, 3.0, 10.0, 1e3, 1e9];
            let all: Vec<Sums> = times.iter().map(|&t| line.sums(t)).collect();
            for sums in &all {
                let cones = rim.of_cones(from + sums.at * way, towards);
                if let Some(cones) = cones.filter(|_| sums.at < 100.0) {
                    let off = (cones.value - sums.value()).abs();
                    assert!(off <= cones.error + sums.error + 1e-9, "{round} {sums:?} {cones:?}");
                    assert!(sums.error < 1e-8, "{round} {sums:?}");
                }
                assert!(sums.left >= 0.0 && sums.right <= 0.0, "{round} {sums:?}");
            }
            assert!(all[8].value().abs() < 1e-6, "{:?}", all[8]);
            for pair in all.windows(2) {
                let [least, most] = pair[0].until(&pair[1]);
                for k in 0..=16 {
                    let value =
                        line.sums(pair[0].at + (pair[1].at - pair[0].at) * f64::from(k) / 16.0).value();
                    assert!(least - 1e-12 <= value && value <= most + 1e-12, "{round} {pair:?} {value}");
                }
            }
            // The interval Newton bounds of the change around a time.
            let t = random.between(0.0, 4.0);
            let change = line.change(t);
            let value = line.sums(t).value();
            for part in [0.4, 0.1, 1e-3] {
                let reach = part * change.distance();
                let [least, most] = change.within(reach);
                for k in [-1.0, -0.5, 0.3, 0.9] {
                    let way = k * reach;
                    let there = line.sums((t + way / line.speed()).max(0.0));
                    let way = (there.at - t) * line.speed();
                    let off = there.value() - value;
                    let (low, high) = ((least * way).min(most * way), (least * way).max(most * way));
                    assert!(
                        low - 1e-12 <= off && off <= high + 1e-12,
                        "{round} {part} {k}: {low} {off} {high}"
                    );
                    told += usize::from(least * most > 0.0);
                }
            }
        }
        assert!(seen > 300 && told > 1000, "{seen} {told}");
    }

    #[test]
    fn caps_in_balls_wind_no_more_than_their_bound() {
        let mut random = Random(2);
        let mut line = RimLine::default();
        let mut bounded = 0;
        for round in 0..2000 {
            let rim = rim(&mut random, 3 + round % 20);
            let (mut ray, from, way) = ray(&mut random);
            ray.from = (from * 5.0).to_array();
            let course = Course::new(from * 5.0, way, round % 2 == 0);
            let most = rim.most_along(&course);
            if most == f64::INFINITY || !line.look(&rim, &ray, &course, 0.0).unwrap() {
                continue;
            }
            bounded += 1;
            for t in [0.0, 1.0, 3.0, 7.0, 20.0] {
                let sums = line.sums(t);
                assert!(sums.value().abs() <= most + sums.error, "{round} {t} {sums:?} {most}");
            }
        }
        assert!(bounded > 500, "{bounded}");
    }

    #[test]
    fn the_gradient_is_what_the_sums_change_by() {
        let mut random = Random(3);
        let mut line = RimLine::default();
        for round in 0..100 {
            let rim = rim(&mut random, 3 + round % 20);
            let (ray, from, way) = ray(&mut random);
            if !line.look(&rim, &ray, &Course::new(from, way, true), 0.0).unwrap() {
                continue;
            }
            let gradient = rim.gradient((from + 0.5 * way).to_array());
            let [least, most] = line.change(0.5).within(0.0);
            let slope =
                gradient.dot(way) / sqrt(way.length_squared()) * sqrt(way.length_squared()) / line.speed();
            assert!(
                (slope - 0.5 * (least + most)).abs() < 1e-6 * (1.0 + slope.abs()),
                "{slope} {least} {most}"
            );
        }
    }
}
