//! Normals of surfaces of which only cells are known.
//!
//! Cells of one size say little of a direction: a plane that rises by less than a cell over five of them looks level. So a
//! plane is fitted to the surface about each block of 8³ cells, in a window of 24³, and the planes of the 27 blocks about a
//! point are blended. Where the surface is not plane there, it is blocks of 4³ in windows of 12³; and where it is not plane
//! there either, about edges and thin walls, the gradient of the occupancy over 5³ cells.

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
    fits: [HashMap<[i32; 3], Fit>; 2],
}

/// A plane through the surface about a block.
#[derive(Clone, Copy, Default)]
struct Fit {
    /// Outward; of length 1.
    normal: DVec3,
    /// 1 if the surface is plane there, 0 if it is not.
    confidence: f64,
}

/// Edges of blocks, large and small.
const EDGES: [i32; 2] = [8, 4];

/// Root mean squares of the distances from the plane, in cells, up to which a surface counts as plane, and from which on not at
/// all. (In small windows rounding to cells alone makes some 0.3.)
const PLANE: [[f64; 2]; 2] = [[0.25, 0.45], [0.45, 0.8]];

/// Confidences below which planes do not say anything.
const LEAST: [f64; 2] = [0.7, 0.3];

impl<'a> Normals<'a> {
    pub fn new(tree: &OctreeRef<'a>) -> Normals<'a> {
        let outside = Planes::uniform(if tree.exterior() == Tag::Full { Tag::Full } else { Tag::Empty });
        let blocks = (tree.frame().cells() as i32 + 3) / 4;
        Normals {
            tree: *tree,
            blocks,
            outside,
            words: HashMap::new(),
            fits: [HashMap::new(), HashMap::new()],
        }
    }

    /// The outward normal at a point of the surface, in cells from the universe's lower corner, that lies in or on the finest
    /// cell `at`; of length 1, or zero if nothing is known.
    pub fn at(&mut self, point: DVec3, at: [u32; 3]) -> Result<DVec3, Error> {
        for size in [0, 1] {
            if let Some(normal) = self.blended(size, point)? {
                return Ok(normal);
            }
        }
        self.gradient(at)
    }

    /// The mean of the planes about a point.
    fn blended(&mut self, size: usize, point: DVec3) -> Result<Option<DVec3>, Error> {
        let place = point / f64::from(EDGES[size]);
        let middle = place.floor();
        // Quadratic splines over three blocks along each axis.
        let from = place - middle - 0.5;
        let (low, high) = (0.5 - from, 0.5 + from);
        let weights = [0.5 * low * low, 0.75 - from * from, 0.5 * high * high];
        let block = [middle.x as i32, middle.y as i32, middle.z as i32];
        let (mut sum, mut confidence, mut total) = (DVec3::ZERO, 0.0, 0.0);
        for (z, wz) in (-1..).zip(weights.map(|w| w.z)) {
            for (y, wy) in (-1..).zip(weights.map(|w| w.y * wz)) {
                for (x, weight) in (-1..).zip(weights.map(|w| w.x * wy)) {
                    let fit = self.fit(size, [block[0] + x, block[1] + y, block[2] + z])?;
                    sum += fit.normal * (weight * fit.confidence);
                    confidence += weight * fit.confidence;
                    // (Blocks without a surface do not count.)
                    total += if fit.normal == DVec3::ZERO { 0.0 } else { weight };
                }
            }
        }
        // Planes that disagree have a short sum.
        let is_plane = confidence > LEAST[size] * total && sum.length() > 0.9 * confidence && total > 0.2;
        Ok(is_plane.then(|| sum.normalize()))
    }

    fn fit(&mut self, size: usize, block: [i32; 3]) -> Result<Fit, Error> {
        if let Some(fit) = self.fits[size].get(&block) {
            return Ok(*fit);
        }
        let mut filled = [[[0; COARSE]; COARSE]; COARSE];
        if size == 0 {
            for (z, plane) in (-2..).zip(&mut filled) {
                for (y, row) in (-2..).zip(plane) {
                    for (x, share) in (-2..).zip(row) {
                        let word = self.word([2 * block[0] + x, 2 * block[1] + y, 2 * block[2] + z])?;
                        *share = (word.upper.count_ones() + word.full().count_ones()) as u8;
                    }
                }
            }
        } else {
            for (z, y, x) in (0..27).map(|k| (k / 9, k / 3 % 3, k % 3)) {
                let at = [x, y, z].map(|k| k as i32 - 1);
                let word = self.word([block[0] + at[0], block[1] + at[1], block[2] + at[2]])?;
                let shares = set_bits_by_byte(word.upper) + set_bits_by_byte(word.full());
                for (octant, share) in shares.to_le_bytes().into_iter().enumerate() {
                    filled[2 * z + (octant >> 2)][2 * y + (octant >> 1 & 1)][2 * x + (octant & 1)] = share;
                }
            }
        }
        // Two for each FULL cell of those that are counted together.
        let fit =
            if size == 0 { fitted(&filled, 128, 4.0, PLANE[0]) } else { fitted(&filled, 16, 2.0, PLANE[1]) };
        self.fits[size].try_reserve(1)?;
        self.fits[size].insert(block, fit);
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

/// What is counted together, along each axis of a window.
const COARSE: usize = 6;

/// Where lines along one axis cross the surface: how many, and the sums of their places and of the products of these.
#[derive(Clone, Copy, Default)]
struct Crossings {
    count: f64,
    sum: DVec3,
    squares: DVec3,
    /// y z, z x, x y.
    products: DVec3,
    /// From inside to outside, added up.
    out: f64,
}

impl Crossings {
    /// `half`: how much is half full.
    #[inline(always)]
    fn add(&mut self, axis: usize, [x, y, z]: [usize; 3], [here, next]: [u8; 2], half: u8) {
        if (here < half) == (next < half) {
            return;
        }
        let (here, next) = (f64::from(here), f64::from(next));
        let mut at = DVec3::new(x as f64, y as f64, z as f64) - 0.5 * (COARSE as f64 - 1.0);
        at[axis] += (here - f64::from(half)) / (here - next);
        self.count += 1.0;
        self.sum += at;
        self.squares += at * at;
        self.products += DVec3::new(at.y * at.z, at.z * at.x, at.x * at.y);
        self.out += here - next;
    }
}

/// The plane about the block in the middle of a window, of which is given how full each part is, `full` at the most; parts are
/// `edge` cells long.
fn fitted(filled: &[[[u8; COARSE]; COARSE]; COARSE], full: u8, edge: f64, plane: [f64; 2]) -> Fit {
    let mut all = filled.iter().flatten().flatten();
    let half = full / 2;
    let first = filled[0][0][0] < half;
    if all.all(|&share| (share < half) == first) {
        return Fit::default();
    }
    let mut crossings = [Crossings::default(); 3];
    for z in 0..COARSE {
        for y in 0..COARSE {
            for x in 0..COARSE {
                let (at, here) = ([x, y, z], filled[z][y][x]);
                if x + 1 < COARSE {
                    crossings[0].add(0, at, [here, filled[z][y][x + 1]], half);
                }
                if y + 1 < COARSE {
                    crossings[1].add(1, at, [here, filled[z][y + 1][x]], half);
                }
                if z + 1 < COARSE {
                    crossings[2].add(2, at, [here, filled[z + 1][y][x]], half);
                }
            }
        }
    }
    let count: f64 = crossings.iter().map(|found| found.count).sum();
    let out = DVec3::from(crossings.map(|found| found.out)).normalize_or_zero();
    // Crossings of lines that run along the surface are no good.
    let weights = (out * out).to_array();
    let total: f64 = (0..3).map(|axis| weights[axis] * crossings[axis].count).sum();
    let is_known = count >= 3.0 && total > 1e-9;
    if !is_known {
        return Fit::default();
    }
    let mean = |part: fn(&Crossings) -> DVec3| {
        (0..3).map(|axis| part(&crossings[axis]) * weights[axis]).sum::<DVec3>() / total
    };
    let middle = mean(|found| found.sum);
    let squares = mean(|found| found.squares) - middle * middle;
    let products = mean(|found| found.products)
        - DVec3::new(middle.y * middle.z, middle.z * middle.x, middle.x * middle.y);
    let spread = DMat3::from_cols(
        DVec3::new(squares.x, products.z, products.y),
        DVec3::new(products.z, squares.y, products.x),
        DVec3::new(products.y, products.x, squares.z),
    );
    // The direction in which the points spread least: eight inverse iterations, by squaring.
    let mut inverse = (spread + DMat3::from_diagonal(DVec3::splat(2.5e-4))).inverse();
    for _ in 0..3 {
        let scale = inverse.x_axis.x.abs().max(inverse.y_axis.y.abs()).max(inverse.z_axis.z.abs());
        inverse *= 1.0 / scale;
        inverse = inverse * inverse;
    }
    let normal = (inverse * out).normalize_or_zero();
    let off = edge * libm::sqrt(normal.dot(spread * normal).max(0.0));
    let is_sound = normal.is_finite() && normal != DVec3::ZERO;
    if !is_sound {
        return Fit::default();
    }
    let confidence = ((plane[1] - off) / (plane[1] - plane[0])).clamp(0.0, 1.0);
    Fit { normal: if normal.dot(out) < 0.0 { -normal } else { normal }, confidence }
}

/// How many bits of each byte are set.
fn set_bits_by_byte(word: u64) -> u64 {
    let pairs = word - (word >> 1 & 0x5555_5555_5555_5555);
    let fours = (pairs & 0x3333_3333_3333_3333) + (pairs >> 2 & 0x3333_3333_3333_3333);
    (fours + (fours >> 4)) & 0x0F0F_0F0F_0F0F_0F0F
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_counted_by_byte() {
        for word in [0, !0, 0x0123_4567_89AB_CDEF, 0x8000_0000_0000_0001] {
            let expected = u64::to_le_bytes(word).map(|byte| byte.count_ones() as u8);
            assert_eq!(set_bits_by_byte(word).to_le_bytes(), expected);
        }
    }
}
