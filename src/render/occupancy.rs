//! The occupancy of the parts of a stored octree.

use super::place_cache::Places;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::morton;
use crate::octree::links::Step;
use crate::octree::view::OctreeRef;
use crate::octree::{Planes, Tag};

/// The occupancy of an octree: two for each FULL cell, one for each PARTIAL one.
pub struct Occupancy<'a> {
    tree: OctreeRef<'a>,
    /// Words along each axis of the universe. A word has 4³ cells.
    words: i32,
    outside: Planes,
    parts: Places<Part>,
}

/// 4³ words.
struct Part {
    source: Source,
    /// The occupancy of each word, in Morton order.
    shares: [u8; 64],
}

#[derive(Clone, Copy)]
enum Source {
    /// All words are equal.
    Alike(Planes),
    /// An element of the level above the bricks.
    Element(usize, Planes),
}

impl<'a> Occupancy<'a> {
    pub fn new(tree: &OctreeRef<'a>) -> Occupancy<'a> {
        // A picture shows the FULL cells up to the universe's faces.
        let outside = Planes::uniform(Tag::Empty);
        let words = tree.frame().cells().div_ceil(4) as i32;
        Occupancy { tree: *tree, words, outside, parts: Places::new() }
    }

    /// The tags of a word of 4³ cells; `at` is counted in words.
    pub fn word(&mut self, at: [i32; 3]) -> Result<Planes, Error> {
        if !self.is_inside(at) {
            return Ok(self.outside);
        }
        let part = self.part(at.each(|i| i >> 2))?;
        Ok(word_of(&self.tree, self.parts.item(part).source, index(at)))
    }

    /// The occupancy of the octants of 3³ blocks, each in one byte, eight octants to a block. The blocks have
    /// 4³ cells, or 8³ if `large`. The middle block is `at`, counted in blocks.
    pub fn window(&mut self, at: [i32; 3], large: bool) -> Result<[u64; 27], Error> {
        // Blocks of a part along each axis: 2^shift.
        let shift = if large { 1 } else { 2 };
        let low = at.each(|i| i - 1);
        let [first, last] = [0, 2].each(|more| low.each(|i| (i + more) >> shift));
        let mut window = [0; 27];
        for part_z in first[2]..=last[2] {
            for part_y in first[1]..=last[1] {
                for part_x in first[0]..=last[0] {
                    let part_at = [part_x, part_y, part_z];
                    let part = self.part(part_at)?;
                    let Part { source, shares } = self.parts.item(part);
                    let range = |axis: usize| {
                        let start = part_at[axis] << shift;
                        low[axis].max(start)..(low[axis] + 3).min(start + (1 << shift))
                    };
                    for z in range(2) {
                        for y in range(1) {
                            for x in range(0) {
                                let place = (z - low[2]) * 9 + (y - low[1]) * 3 + x - low[0];
                                window[place as usize] = if large {
                                    let octant = ((x & 1) | (y & 1) << 1 | (z & 1) << 2) as usize;
                                    let shares = &shares[8 * octant..8 * octant + 8];
                                    shares.iter().rev().fold(0, |all, &share| all << 8 | u64::from(share))
                                } else {
                                    let block = [x, y, z];
                                    let word = if self.is_inside(block) {
                                        word_of(&self.tree, *source, index(block))
                                    } else {
                                        self.outside
                                    };
                                    set_bits_by_byte(word.upper) + set_bits_by_byte(word.full())
                                };
                            }
                        }
                    }
                }
            }
        }
        Ok(window)
    }

    #[inline]
    fn is_inside(&self, word: [i32; 3]) -> bool {
        word.iter().all(|i| (0..self.words).contains(i))
    }

    fn part(&mut self, at: [i32; 3]) -> Result<usize, Error> {
        match self.parts.find(at) {
            Some(part) => Ok(part),
            None => self.parts.keep(at, self.found(at)),
        }
    }

    #[inline(never)]
    fn found(&self, at: [i32; 3]) -> Part {
        let first = at.each(|i| 4 * i);
        if !self.is_inside(first) {
            let shares = [set_bits(self.outside); 64];
            return Part { source: Source::Alike(self.outside), shares };
        }
        let source = self.source(at.each(|i| i as u32));
        let all_inside = self.is_inside(first.each(|i| i + 3));
        let mut shares = [0; 64];
        for (c, share) in (0..).zip(&mut shares) {
            let place = morton::position(c);
            let is_inside = all_inside || self.is_inside(axes(|axis| first[axis] + place[axis] as i32));
            *share = set_bits(if is_inside { word_of(&self.tree, source, c) } else { self.outside });
        }
        Part { source, shares }
    }

    /// Descends to a part. Damaged parts and cells above the finest level count as uniform.
    fn source(&self, at: [u32; 3]) -> Source {
        let tree = &self.tree;
        if tree.root_tag() != Tag::Branch {
            return Source::Alike(Planes::uniform(tree.root_tag()));
        }
        let (mut e, mut index) = (0, 0);
        loop {
            let planes = tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
            // The number of levels from here to that of the bricks.
            match tree.levels() - 1 - e {
                0 => return Source::Alike(planes),
                1 => return Source::Element(index, planes),
                more => {
                    let [x, y, z] = at.each(|i| i >> (2 * (more - 2)));
                    match tree.step(e, index, planes, morton::index(x, y, z)) {
                        Step::Into(child) => (e, index) = (e + 1, child),
                        Step::Settled(tag) => return Source::Alike(Planes::uniform(tag)),
                    }
                }
            }
        }
    }
}

/// Word `c` of a part.
#[inline]
fn word_of(tree: &OctreeRef<'_>, source: Source, c: u32) -> Planes {
    match source {
        Source::Alike(planes) => planes,
        Source::Element(index, planes) => match tree.step(tree.levels() - 2, index, planes, c) {
            Step::Into(brick) => tree.entry(brick).unwrap_or(Planes::uniform(Tag::Partial)),
            Step::Settled(tag) => Planes::uniform(tag),
        },
    }
}

/// The place of a word in its part, in Morton order.
#[inline]
fn index(word: [i32; 3]) -> u32 {
    let [x, y, z] = word.each(|i| i as u32);
    morton::index(x, y, z)
}

fn set_bits(word: Planes) -> u8 {
    (word.upper.count_ones() + word.full().count_ones()) as u8
}

/// The number of set bits in each byte.
fn set_bits_by_byte(word: u64) -> u64 {
    let pairs = word - (word >> 1 & 0x5555_5555_5555_5555);
    let fours = (pairs & 0x3333_3333_3333_3333) + (pairs >> 2 & 0x3333_3333_3333_3333);
    (fours + (fours >> 4)) & 0x0F0F_0F0F_0F0F_0F0F
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;
    use crate::lattice::Frame;
    use crate::octree::Octree;
    use crate::op::{Rule, build};
    use crate::solid::Csg;

    /// The occupancy of a cube of cells, counted cell by cell.
    fn counted(tree: &Octree, low: [i32; 3], edge: i32) -> u8 {
        let cells = tree.frame().cells() as i32;
        let mut sum = 0;
        for z in low[2]..low[2] + edge {
            for y in low[1]..low[1] + edge {
                for x in low[0]..low[0] + edge {
                    let at = [x, y, z];
                    let is_inside = at.iter().all(|i| (0..cells).contains(i));
                    sum += match is_inside.then(|| tree.view().tag_at(at.map(|i| i as u32))) {
                        // For any exterior.
                        None => 0,
                        Some(Tag::Full) => 2,
                        Some(Tag::Empty) => 0,
                        Some(_) => 1,
                    };
                }
            }
        }
        sum
    }

    #[test]
    fn windows_are_as_full_as_their_cells() {
        let ball = Csg::ball([0.1, 0.0, -0.1], 0.75).unwrap();
        let around = ball.complement();
        for depth in 2..=6 {
            let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
            for solid in [&ball, &around] {
                let tree = build(solid, &frame, Rule::Certified, &Control::threads(1)).unwrap();
                let mut occupancy = Occupancy::new(tree.view());
                for (large, edge) in [(true, 8), (false, 4)] {
                    let blocks = (frame.cells() as i32 + edge - 1) / edge;
                    for at in (0..(blocks + 4).pow(3)).step_by(7) {
                        let at = [1, blocks + 4, (blocks + 4).pow(2)].map(|by| at / by % (blocks + 4) - 2);
                        let window = occupancy.window(at, large).unwrap();
                        for (k, octants) in (0..).zip(window) {
                            let block = [k % 3, k / 3 % 3, k / 9];
                            let low = axes(|axis| edge * (at[axis] + block[axis] - 1));
                            for (octant, share) in (0..).zip(octants.to_le_bytes()) {
                                let half = edge / 2;
                                let low = axes(|axis| low[axis] + half * (octant >> axis & 1));
                                assert_eq!(share, counted(&tree, low, half), "{depth} {at:?} {k} {octant}");
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn bits_are_counted_by_byte() {
        for word in [0, !0, 0x0123_4567_89AB_CDEF, 0x8000_0000_0000_0001] {
            let expected = u64::to_le_bytes(word).map(|byte| byte.count_ones() as u8);
            assert_eq!(set_bits_by_byte(word).to_le_bytes(), expected);
        }
    }
}
