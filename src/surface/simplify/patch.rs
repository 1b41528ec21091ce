//! The triangles around a vertex as a height map, before and after the removal of the vertex.
//!
//! The triangles around a vertex, and those that replace them, are seen along one direction in which no
//! triangle turns away. They lie one above the other. The difference of their heights is linear wherever both
//! are linear, so its maximum lies at a corner of one of them or where sides cross. (Borouchaki and Frey,
//! *Simplification of surface mesh using Hausdorff envelope*, 2005, bound the same distance by cones.)

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use alloc::vec::Vec;

/// The least cosine between normals and the direction in which a patch is seen.
const STEEP: f64 = 0.2;

/// The least area of a projected triangle, as a part of the square of its longest side.
const THIN: f64 = 1e-9;

/// Rings with more vertices are only examined where they are flat.
const LARGE: usize = 24;

/// The surroundings of a vertex, which lies at the origin.
#[derive(Default)]
pub(super) struct Patch {
    /// The ring, projected along the direction, and the heights.
    flat: Vec<[f64; 2]>,
    heights: Vec<f64>,
    /// The least and the greatest height, including that of the vertex.
    span: [f64; 2],
    /// Points of the first surface that belong to the patch, including the vertex: their projections, and
    /// their heights.
    points: Vec<([f64; 2], f64)>,
    /// The axes of the view: two across and the direction.
    view: [[f64; 3]; 3],
    middle: [f64; 3],
    /// The least cosine between the normals and the direction.
    steepest: f64,
}

fn cross2(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn minus2(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    axes(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn scaled(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.each(|c| c * factor)
}

impl Patch {
    /// Examines a vertex and its ring; `false` if no direction shows all its triangles from outside.
    pub(super) fn see(
        &mut self,
        middle: [f64; 3],
        ring: impl ExactSizeIterator<Item = [f64; 3]>,
    ) -> Result<bool, Error> {
        let Patch { flat, heights, span, steepest, points, view, middle: own } = self;
        *own = middle;
        points.clear();
        flat.clear();
        heights.clear();
        flat.try_reserve(ring.len())?;
        heights.try_reserve(ring.len())?;
        let mut spokes = memory::with_capacity(ring.len())?;
        spokes.extend(ring.map(|vertex| -> [f64; 3] { axes(|k| vertex[k] - middle[k]) }));
        let count = spokes.len();
        let mut direction = [0.0; 3];
        for k in 0..count {
            let normal = cross(spokes[k], spokes[(k + 1) % count]);
            let length = dot(normal, normal).sqrt();
            if length > 0.0 {
                direction = axes(|axis| direction[axis] + normal[axis] / length);
            }
        }
        let length = dot(direction, direction).sqrt();
        if length == 0.0 || length.is_nan() {
            return Ok(false);
        }
        let up = scaled(direction, 1.0 / length);
        // Any two directions across.
        let least = (0..3).fold(0, |least, k| if up[k].abs() < up[least].abs() { k } else { least });
        let mut unit = [0.0; 3];
        unit[least] = 1.0;
        let east = cross(unit, up);
        let east = scaled(east, 1.0 / dot(east, east).sqrt());
        let north = cross(up, east);
        *view = [east, north, up];
        *span = [0.0; 2];
        for &spoke in &spokes {
            let height = dot(spoke, up);
            flat.push([dot(spoke, east), dot(spoke, north)]);
            heights.push(height);
            *span = [span[0].min(height), span[1].max(height)];
        }
        *steepest = 1.0;
        let mut turns = 0;
        for k in 0..count {
            let next = (k + 1) % count;
            let normal = cross(spokes[k], spokes[next]);
            let area = cross2(flat[k], flat[next]);
            let whole = dot(normal, normal).sqrt();
            // (Triangles without area do not matter if they are not visible from any side.)
            let is_seen = area > STEEP * whole;
            if !is_seen {
                return Ok(false);
            }
            *steepest = steepest.min(area / whole);
            turns += u32::from(flat[k][1] < 0.0 && flat[next][1] >= 0.0);
        }
        Ok(turns == 1)
    }

    /// Adds a point of the first surface.
    pub(super) fn add(&mut self, point: [f64; 3]) -> Result<(), Error> {
        let way = axes(|k| point[k] - self.middle[k]);
        let [east, north, up] = self.view.each(|axis| dot(axis, way));
        memory::push(&mut self.points, ([east, north], up))
    }

    /// Returns whether no triangle is inverted if the vertex moves to number `onto` of the ring.
    pub(super) fn may_go(&self, onto: usize) -> bool {
        let (flat, heights) = (&self.flat, &self.heights);
        let count = flat.len();
        let target = flat[onto];
        (1..count - 1).all(|step| {
            let k = (onto + step) % count;
            let (a, b) = (minus2(flat[k], target), minus2(flat[(k + 1) % count], target));
            let longest = [a, b, minus2(a, b)].each(|side| side[0] * side[0] + side[1] * side[1]);
            let longest = longest.into_iter().fold(0.0, f64::max);
            let area = cross2(a, b);
            let rise = [heights[k] - heights[onto], heights[(k + 1) % count] - heights[onto]];
            // The gradient of the heights, times the area.
            let gradient = [b[1] * rise[0] - a[1] * rise[1], a[0] * rise[1] - b[0] * rise[0]];
            let slope = gradient[0] * gradient[0] + gradient[1] * gradient[1];
            let least = self.steepest.min(0.5);
            area > THIN * longest && area * area >= least * least * (area * area + slope)
        })
    }

    /// The movement of the surface if the vertex moves to number `onto` of the ring.
    pub(super) fn change(&self, onto: usize) -> f64 {
        let most = self.span[1] - self.span[0];
        if self.flat.len() > LARGE { most } else { self.difference(onto).min(most) }
    }

    /// The triangle over or under which each point lies after the move, as the number of its first vertex in
    /// the ring, and the distance.
    pub(super) fn places(&self, onto: usize) -> impl Iterator<Item = (usize, f64)> {
        let (flat, heights) = (&self.flat, &self.heights);
        let count = flat.len();
        let (target, base) = (flat[onto], heights[onto]);
        self.points.iter().map(move |&(point, height)| {
            let own = minus2(point, target);
            let mut best = (f64::NEG_INFINITY, 0, 0.0);
            for step in 1..count - 1 {
                let (k, next) = ((onto + step) % count, (onto + step + 1) % count);
                let (a, b) = (minus2(flat[k], target), minus2(flat[next], target));
                let area = cross2(a, b);
                let (along_a, along_b) = (cross2(own, b) / area, cross2(a, own) / area);
                let inside = along_a.min(along_b).min(1.0 - along_a - along_b);
                if inside > best.0 {
                    let there = base + along_a * (heights[k] - base) + along_b * (heights[next] - base);
                    best = (inside, k, (height - there).abs());
                    if inside >= 0.0 {
                        break;
                    }
                }
            }
            (best.1, best.2)
        })
    }

    /// The distance of number `k` of the ring from the vertex.
    pub(super) fn length(&self, k: usize) -> f64 {
        let ([east, north], height) = (self.flat[k], self.heights[k]);
        (east * east + north * north + height * height).sqrt()
    }

    /// The greatest difference of heights.
    fn difference(&self, onto: usize) -> f64 {
        let (flat, heights) = (&self.flat, &self.heights);
        let count = flat.len();
        let (target, base) = (flat[onto], heights[onto]);
        let mut most: f64 = 0.0;
        // The vertex itself, which lies in one of the new triangles.
        for step in 1..count - 1 {
            let (k, next) = ((onto + step) % count, (onto + step + 1) % count);
            let (a, b) = (minus2(flat[k], target), minus2(flat[next], target));
            let own = [-target[0], -target[1]];
            let (along_a, along_b) = (cross2(own, b), cross2(a, own));
            if along_a >= 0.0 && along_b >= 0.0 {
                let rise = along_a * (heights[k] - base) + along_b * (heights[next] - base);
                most = most.max((base + rise / cross2(a, b)).abs());
            }
        }
        // Spokes that cross sides from the target.
        for step in 2..count - 1 {
            let k = (onto + step) % count;
            let way = minus2(flat[k], target);
            for (spoke, &height) in flat.iter().zip(heights) {
                // The crossing is `s` along the spoke and `t` along the way.
                let across = cross2(*spoke, way);
                if across == 0.0 {
                    continue;
                }
                let s = cross2(target, way) / across;
                let t = cross2(target, *spoke) / across;
                if s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0 {
                    most = most.max((s * height - (base + t * (heights[k] - base))).abs());
                }
            }
        }
        most
    }
}
