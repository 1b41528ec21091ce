//! Statistics of a tree, level by level.

use super::tag::Tag;
use super::view::{LevelCounts, OctreeRef, starts_half_way};
use super::word::Planes;
use crate::dispatch::{Hot, with_popcount};
use crate::lattice::exact::{product_down, product_up};
use crate::lattice::{Frame, Interval};
use alloc::vec;
use alloc::vec::Vec;

/// Statistics of one level of the canonical octree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelStatistics {
    /// Level; 0 is the universe.
    pub level: u8,
    /// Number of internal nodes at this level: cells that are cut and split.
    pub nodes: u64,
    /// Number of EMPTY cells of this level.
    pub empty: u64,
    /// Number of FULL cells of this level.
    pub full: u64,
    /// Number of PARTIAL cells of this level.
    pub partial: u64,
    /// Surely solid volume of the tree cut at this level, in finest cells.
    pub lower_cells: u64,
    /// Possibly solid volume of the tree cut at this level, in finest cells.
    pub upper_cells: u64,
    /// Both volumes in cubic model units, rounded outward.
    pub volume: Interval,
}

/// Nodes, cells and certified volumes of an octree, for each level and in total.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    levels: Vec<LevelStatistics>,
}

impl Statistics {
    pub(crate) fn new(frame: &Frame, counts: &[LevelCounts]) -> Statistics {
        let depth = frame.depth();
        let mut levels = Vec::with_capacity(counts.len());
        let (mut lower, mut undecided) = (0u64, 0u64);
        // A mapped level table may contain anything: nothing here may overflow.
        let mut above = None;
        for (level, count) in counts.iter().enumerate().take(depth as usize + 1) {
            let cells = 1u64 << (3 * (depth as usize - level));
            let all = above.map_or(1, |nodes: u64| nodes.saturating_mul(8));
            lower = lower.saturating_add(count.full.saturating_mul(cells));
            undecided = undecided.saturating_add(count.partial.saturating_mul(cells));
            let upper = lower.saturating_add(undecided).saturating_add(count.nodes.saturating_mul(cells));
            let kept = count.nodes.saturating_add(count.full).saturating_add(count.partial);
            levels.push(LevelStatistics {
                level: level as u8,
                nodes: count.nodes,
                empty: all.saturating_sub(kept),
                full: count.full,
                partial: count.partial,
                lower_cells: lower,
                upper_cells: upper,
                volume: volume_of(frame, lower, upper),
            });
            above = Some(count.nodes);
        }
        Statistics { levels }
    }

    /// Builds the statistics from given counts: for each level of the frame, from the universe on, the
    /// numbers of nodes, of FULL and of PARTIAL cells.
    pub fn of_counts(frame: &Frame, counts: &[[u64; 3]]) -> Statistics {
        let level = |&[nodes, full, partial]: &[u64; 3]| LevelCounts { nodes, full, partial };
        Statistics::new(frame, &counts.iter().map(level).collect::<Vec<_>>())
    }

    /// Returns the levels, from the universe to the finest cells.
    pub fn levels(&self) -> &[LevelStatistics] {
        &self.levels
    }

    /// Returns the number m of internal nodes of the leaf-free octree; a classical octree of the same solid
    /// has 8 m + 1 nodes.
    pub fn nodes(&self) -> u64 {
        self.levels.iter().fold(0, |sum, level| sum.saturating_add(level.nodes))
    }

    /// Returns the number of cells of one tag over all levels; BRANCH counts the nodes.
    pub fn cells(&self, tag: Tag) -> u64 {
        let of = |level: &LevelStatistics| match tag {
            Tag::Empty => level.empty,
            Tag::Branch => level.nodes,
            Tag::Partial => level.partial,
            Tag::Full => level.full,
        };
        self.levels.iter().fold(0, |sum, level| sum.saturating_add(of(level)))
    }

    /// Returns the certified volume of the part of the solid inside the universe, in cubic model units: at
    /// least `lower` and at most `upper`.
    pub fn volume(&self) -> Interval {
        self.levels.last().map_or(Interval::exactly(0.0), |level| level.volume)
    }

    /// Returns the certified volume in finest cells: surely and possibly solid.
    pub fn volume_cells(&self) -> (u64, u64) {
        self.levels.last().map_or((0, 0), |level| (level.lower_cells, level.upper_cells))
    }
}

/// Returns numbers of finest cells as cubic model units, rounded outward.
pub(crate) fn volume_of(frame: &Frame, lower: u64, upper: u64) -> Interval {
    let size = frame.cell_size();
    let down = |cells: f64| product_down(product_down(product_down(cells, size), size), size);
    let up = |cells: f64| product_up(product_up(product_up(cells, size), size), size);
    // Cell counts beyond 2^53 are rounded when they become doubles.
    let (least, most) = (lower as f64, upper as f64);
    let least = if least as u64 > lower { least.next_down() } else { least };
    let most = if (most as u64) < upper { most.next_up() } else { most };
    Interval::between(down(least), up(most))
}

impl OctreeRef<'_> {
    /// Counts every level in one pass over the arrays.
    pub(crate) fn count_levels(&self) -> Vec<LevelCounts> {
        let depth = self.frame.depth();
        let mut counts = vec![LevelCounts::default(); depth as usize + 1];
        match self.root {
            Tag::Full => counts[0].full = 1,
            Tag::Partial => counts[0].partial = 1,
            Tag::Empty | Tag::Branch => {}
        }
        if self.root != Tag::Branch {
            return counts;
        }
        with_popcount(Count { tree: self, counts: &mut counts });
        counts
    }
}

/// One pass over the arrays.
struct Count<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    counts: &'t mut [LevelCounts],
}

impl Hot for Count<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Count { tree, counts } = self;
        let (levels, half) = (tree.levels(), starts_half_way(tree.frame.depth()));
        for e in 0..levels {
            let mut sum = ElementCounts::default();
            let (first, end) = (tree.starts[e], tree.starts[e + 1]);
            if e + 1 < levels {
                tree.planes.get(first..end).unwrap_or(&[]).iter().for_each(|&planes| sum.add(planes));
            } else {
                for b in 0..end.saturating_sub(first) {
                    // A damaged brick reads as undecided.
                    sum.add(tree.bricks.get(b).unwrap_or(Planes::uniform(Tag::Partial)));
                }
            }
            let cells = tree.cell_level(e) as usize;
            counts[cells].full += sum.full_cells;
            counts[cells].partial += sum.partial_cells;
            if half && e == 0 {
                // The root starts half-way: its only real octant is the universe itself.
                counts[0].nodes = 1;
                continue;
            }
            counts[cells - 1].full += sum.full_octants;
            counts[cells - 1].partial += sum.partial_octants;
            counts[cells - 1].nodes += 8 * sum.elements - sum.uniform_octants;
            counts[cells - 2].nodes += sum.elements;
        }
    }
}

/// Sums over elements.
#[derive(Default)]
struct ElementCounts {
    elements: u64,
    uniform_octants: u64,
    full_octants: u64,
    partial_octants: u64,
    full_cells: u64,
    partial_cells: u64,
}

impl ElementCounts {
    #[inline(always)]
    fn add(&mut self, planes: Planes) {
        let [empty, full, partial] = planes.octants();
        let (full_octants, partial_octants) = (full.count_ones() as u64, partial.count_ones() as u64);
        self.elements += 1;
        self.uniform_octants += empty.count_ones() as u64 + full_octants + partial_octants;
        self.full_octants += full_octants;
        self.partial_octants += partial_octants;
        // The cells of a uniform octant are not cells of the octree: the octant is.
        self.full_cells += planes.full().count_ones() as u64 - 8 * full_octants;
        self.partial_cells += planes.partial().count_ones() as u64 - 8 * partial_octants;
    }
}
