//! Normals of surfaces of which only cells are known.
//!
//! Cells of one size say little of a direction: a plane that rises by less than a cell over five of them looks level. So a
//! plane is fitted to the surface about each block of 4³ cells, in a window of 12³, and the planes of the eight blocks about a
//! point are blended. Where the surface is not plane there, about edges and thin walls, it is the gradient of the occupancy
//! over 5³ cells instead.

use crate::error::Error;
use crate::lattice::morton;
use crate::octree::links::Step;
use crate::octree::view::OctreeRef;
use crate::octree::{Planes, Tag};
use glam::{DMat3, DVec3};
use hashbrown::HashMap;

/// Normals of a stored octree, with what was found out about blocks before.
pub struct Normals<'a> {
    tree: OctreeRef<'a>,
    /// Blocks along each axis.
    blocks: i32,
    outside: Planes,
    words: HashMap<[i32; 3], Planes>,
    fits: HashMap<[i32; 3], Fit>,
}

/// A plane through the surface about a block.
#[derive(Clone, Copy, Default)]
struct Fit {
    /// Outward; of length 1.
    normal: DVec3,
    /// 1 if the surface is plane there, 0 if it is not.
    confidence: f64,
}

/// Root mean squares of the distances from the plane, in cells, up to which a surface counts as plane, and from which on not at
/// all. (Rounding to cells alone makes some 0.3.)
const PLANE: [f64; 2] = [0.45, 0.8];

/// Confidence below which planes do not say anything.
const LEAST: f64 = 0.3;

impl<'a> Normals<'a> {
    pub fn new(tree: &OctreeRef<'a>) -> Normals<'a> {
        let outside = Planes::uniform(if tree.exterior() == Tag::Full { Tag::Full } else { Tag::Empty });
        let blocks = (tree.frame().cells() as i32 + 3) / 4;
        Normals { tree: *tree, blocks, outside, words: HashMap::new(), fits: HashMap::new() }
    }

    /// The outward normal at a point of the surface, in cells from the universe's lower corner, that lies in or on the finest
    /// cell `at`; of length 1, or zero if nothing is known.
    pub fn at(&mut self, point: DVec3, at: [u32; 3]) -> Result<DVec3, Error> {
        let place = point / 4.0 - 0.5;
        let base = place.floor();
        let part = place - base;
        let base = [base.x as i32, base.y as i32, base.z as i32];
        let (mut sum, mut confidence) = (DVec3::ZERO, 0.0);
        for k in 0..8 {
            let corner = [k & 1, k >> 1 & 1, k >> 2];
            let weight =
                (0..3).fold(1.0, |weight, i| weight * if corner[i] == 1 { part[i] } else { 1.0 - part[i] });
            if weight > 0.0 {
                let fit = self.fit([0, 1, 2].map(|i| base[i] + corner[i]))?;
                sum += fit.normal * (weight * fit.confidence);
                confidence += weight * fit.confidence;
            }
        }
        // Planes that disagree have a short sum.
        if confidence > LEAST && sum.length() > 0.9 * confidence {
            return Ok(sum.normalize());
        }
        self.gradient(at)
    }

    fn fit(&mut self, block: [i32; 3]) -> Result<Fit, Error> {
        if let Some(fit) = self.fits.get(&block) {
            return Ok(*fit);
        }
        let mut words = [[[Planes::uniform(Tag::Empty); 3]; 3]; 3];
        for (z, plane) in (-1..).zip(&mut words) {
            for (y, row) in (-1..).zip(plane) {
                for (x, word) in (-1..).zip(row) {
                    *word = self.word([block[0] + x, block[1] + y, block[2] + z])?;
                }
            }
        }
        let fit = fitted(&words);
        self.fits.try_reserve(1)?;
        self.fits.insert(block, fit);
        Ok(fit)
    }

    /// The tags of a block.
    fn word(&mut self, block: [i32; 3]) -> Result<Planes, Error> {
        if block.iter().any(|i| !(0..self.blocks).contains(i)) {
            return Ok(self.outside);
        }
        if let Some(word) = self.words.get(&block) {
            return Ok(*word);
        }
        let word = self.found(block.map(|i| i as u32));
        self.words.try_reserve(1)?;
        self.words.insert(block, word);
        Ok(word)
    }

    /// Descends to a block. Damage and what lies above the finest level count as uniform.
    fn found(&self, block: [u32; 3]) -> Planes {
        let tree = &self.tree;
        if tree.root_tag() != Tag::Branch {
            return Planes::uniform(tree.root_tag());
        }
        let (mut e, mut index) = (0, 0);
        let last = tree.levels() - 1;
        loop {
            let planes = tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
            if e == last {
                return planes;
            }
            let shift = 2 * (last - e - 1) as u32;
            let c = morton::index(block[0] >> shift, block[1] >> shift, block[2] >> shift);
            match tree.step(e, index, planes, c) {
                Step::Into(child) => (e, index) = (e + 1, child),
                Step::Settled(tag) => return Planes::uniform(tag),
            }
        }
    }

    /// The gradient of the occupancy over 5³ cells.
    fn gradient(&mut self, at: [u32; 3]) -> Result<DVec3, Error> {
        let mut sum = DVec3::ZERO;
        let low = at.map(|a| a as i32 - 2);
        let (first, last) = (low.map(|a| a >> 2), low.map(|a| (a + 4) >> 2));
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                for x in first[0]..=last[0] {
                    let word = self.word([x, y, z])?;
                    if word.upper == 0 {
                        continue;
                    }
                    let range = |axis: usize, block: i32| {
                        low[axis].max(4 * block)..(low[axis] + 5).min(4 * block + 4)
                    };
                    for k in range(2, z) {
                        for j in range(1, y) {
                            for i in range(0, x) {
                                let c = morton::index(i as u32, j as u32, k as u32);
                                let solid =
                                    f64::from((word.upper >> c & 1) as u32 + (word.full() >> c & 1) as u32);
                                let from = DVec3::from(
                                    [i - low[0] - 2, j - low[1] - 2, k - low[2] - 2].map(f64::from),
                                );
                                sum -= from * (solid * WEIGHTS[from.length_squared() as usize]);
                            }
                        }
                    }
                }
            }
        }
        Ok(sum.normalize_or_zero())
    }
}

/// exp(−r² / (2 · 1.5²)) for r² = 0 … 12.
const WEIGHTS: [f64; 13] = [
    1.0, 0.800_737, 0.641_180, 0.513_417, 0.411_112, 0.329_193, 0.263_597, 0.211_072, 0.169_013, 0.135_335,
    0.108_368, 0.086_774, 0.069_483,
];

/// Cells of 2³ along each axis of the window.
const COARSE: usize = 6;

/// The plane about the block in the middle.
fn fitted(words: &[[[Planes; 3]; 3]; 3]) -> Fit {
    let mut filled = [[[0.0f64; COARSE]; COARSE]; COARSE];
    let (mut any, mut all) = (0u64, !0u64);
    for (z, plane) in words.iter().enumerate() {
        for (y, row) in plane.iter().enumerate() {
            for (x, word) in row.iter().enumerate() {
                (any, all) = (any | word.upper, all & word.full());
                for octant in 0..8usize {
                    let bits = |word: u64| f64::from((word >> (8 * octant) & 0xFF).count_ones());
                    let share = (bits(word.upper) + bits(word.full())) / 16.0;
                    filled[2 * z + (octant >> 2)][2 * y + (octant >> 1 & 1)][2 * x + (octant & 1)] = share;
                }
            }
        }
    }
    if any == 0 || all == !0 {
        return Fit::default();
    }
    let mut points = [(DVec3::ZERO, 0usize); 3 * COARSE * COARSE * COARSE];
    let mut count = 0;
    // From inside to outside, added up.
    let mut out = DVec3::ZERO;
    let mut add = |at: [usize; 3], axis: usize, inner: f64, outer: f64| {
        if (inner < 0.5) == (outer < 0.5) {
            return;
        }
        let mut point = DVec3::from(at.map(|a| 2.0 * a as f64 + 1.0));
        point[axis] += 2.0 * (inner - 0.5) / (inner - outer);
        out[axis] += inner - outer;
        points[count] = (point, axis);
        count += 1;
    };
    for z in 0..COARSE {
        for y in 0..COARSE {
            for x in 0..COARSE {
                let here = filled[z][y][x];
                if x + 1 < COARSE {
                    add([x, y, z], 0, here, filled[z][y][x + 1]);
                }
                if y + 1 < COARSE {
                    add([x, y, z], 1, here, filled[z][y + 1][x]);
                }
                if z + 1 < COARSE {
                    add([x, y, z], 2, here, filled[z + 1][y][x]);
                }
            }
        }
    }
    let points = &points[..count];
    let out = out.normalize_or_zero();
    if count < 3 || out == DVec3::ZERO {
        return Fit::default();
    }
    // Crossings of lines that run along the surface are no good.
    let weight = |axis: usize| out[axis] * out[axis];
    let total: f64 = points.iter().map(|&(_, axis)| weight(axis)).sum();
    let middle = points.iter().map(|&(point, axis)| point * weight(axis)).sum::<DVec3>() / total;
    let mut spread = DMat3::ZERO;
    for &(point, axis) in points {
        let from = point - middle;
        let weighted = from * (weight(axis) / total);
        spread += DMat3::from_cols(weighted * from.x, weighted * from.y, weighted * from.z);
    }
    // The direction in which the points spread least: by inverse iteration.
    let inverse = (spread + DMat3::from_diagonal(DVec3::splat(1e-3))).inverse();
    let mut normal = out;
    for _ in 0..16 {
        normal = (inverse * normal).normalize_or_zero();
    }
    let off = libm::sqrt(normal.dot(spread * normal).max(0.0));
    let is_sound = normal.is_finite() && normal != DVec3::ZERO;
    if !is_sound {
        return Fit::default();
    }
    let normal = if normal.dot(out) < 0.0 { -normal } else { normal };
    let confidence = ((PLANE[1] - off) / (PLANE[1] - PLANE[0])).clamp(0.0, 1.0);
    Fit { normal, confidence }
}
