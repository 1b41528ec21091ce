//! Dense arrays of tags, trees and statistics as they follow from them, and random arrays.

use super::{alone, cubes, lattice_frame};
use leafless::lattice::Cube;
use leafless::octree::{Cursor, LevelStatistics};
use leafless::{Cell, Control, Error, Frame, Octree, OctreeRef, Rule, Tag, Verdict, build};
use proptest::prelude::*;

pub const TAGS: [Tag; 3] = [Tag::Empty, Tag::Partial, Tag::Full];

/// Combines two tags by Kleene's three-valued logic: PARTIAL if different choices for undecided operands give
/// different results.
pub fn kleene(op: fn(bool, bool) -> bool, a: Tag, b: Tag) -> Tag {
    let choices = |tag| match tag {
        Tag::Empty => vec![false],
        Tag::Full => vec![true],
        Tag::Partial => vec![false, true],
        Tag::Branch => panic!("a dense array has no branches"),
    };
    let mut seen = [false; 2];
    for x in choices(a) {
        for y in choices(b) {
            seen[op(x, y) as usize] = true;
        }
    }
    match seen {
        [true, false] => Tag::Empty,
        [false, true] => Tag::Full,
        _ => Tag::Partial,
    }
}

/// A dense array of the tags of all finest cells.
#[derive(Clone, PartialEq, Eq)]
pub struct Dense {
    pub depth: u8,
    pub tags: Vec<Tag>,
}

/// Prints rows along x and slices along z: `.` EMPTY, `?` PARTIAL, `#` FULL.
impl std::fmt::Debug for Dense {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let row = |row: &[Tag]| row.iter().map(|&tag| b".x?#"[tag as usize] as char).collect::<String>();
        let rows: Vec<String> = self.tags.chunks(1 << self.depth).map(row).collect();
        let slices: Vec<String> = rows.chunks(1 << self.depth).map(|slice| slice.join(" ")).collect();
        write!(f, "depth {}\n{}\n", self.depth, slices.join("\n"))
    }
}

impl Dense {
    pub fn from_fn(depth: u8, tag: impl Fn([u32; 3]) -> Tag) -> Dense {
        Dense { depth, tags: positions(depth).map(tag).collect() }
    }

    pub fn uniform(depth: u8, tag: Tag) -> Dense {
        Dense::from_fn(depth, |_| tag)
    }

    /// Returns the tags of a tree's finest cells.
    pub fn of(tree: &OctreeRef<'_>) -> Dense {
        Dense::from_fn(tree.frame().depth(), |at| tree.tag_at(at))
    }

    pub fn at(&self, [x, y, z]: [u32; 3]) -> Tag {
        self.tags[((((z << self.depth) | y) << self.depth) | x) as usize]
    }

    pub fn set(&mut self, [x, y, z]: [u32; 3], tag: Tag) {
        self.tags[((((z << self.depth) | y) << self.depth) | x) as usize] = tag;
    }

    pub fn combine(&self, other: &Dense, op: fn(bool, bool) -> bool) -> Dense {
        assert_eq!(self.depth, other.depth);
        let tags = self.tags.iter().zip(&other.tags).map(|(&a, &b)| kleene(op, a, b)).collect();
        Dense { depth: self.depth, tags }
    }

    pub fn complement(&self) -> Dense {
        self.combine(&Dense::uniform(self.depth, Tag::Full), |a, b| b & !a)
    }

    /// Returns a copy in which every PARTIAL cell has the tag `tag`.
    pub fn resolved(&self, tag: Tag) -> Dense {
        let resolve = |&cell: &Tag| if cell == Tag::Partial { tag } else { cell };
        Dense { depth: self.depth, tags: self.tags.iter().map(resolve).collect() }
    }

    pub fn count(&self, tag: Tag) -> u64 {
        self.tags.iter().filter(|&&cell| cell == tag).count() as u64
    }

    pub fn is_binary(&self) -> bool {
        self.count(Tag::Partial) == 0
    }

    /// Returns the tag of all finest cells in `cell`, if they agree.
    pub fn tag_of(&self, cell: Cell) -> Option<Tag> {
        let edge = 1 << (self.depth - cell.level);
        let [x, y, z] = cell.at.map(|a| a * edge);
        let first = self.at([x, y, z]);
        let same =
            (z..z + edge).all(|z| (y..y + edge).all(|y| (x..x + edge).all(|x| self.at([x, y, z]) == first)));
        same.then_some(first)
    }

    /// Returns the same universe with 2^depth cells per axis. A cell whose finest cells differ becomes
    /// PARTIAL.
    pub fn cut(&self, depth: u8) -> Dense {
        Dense::from_fn(depth, |at| self.tag_of(Cell { level: depth, at }).unwrap_or(Tag::Partial))
    }

    /// Returns the same cells on a finer lattice.
    pub fn refined(&self, depth: u8) -> Dense {
        Dense::from_fn(depth, |at| self.at(at.map(|a| a >> (depth - self.depth))))
    }

    pub fn classical(&self) -> Classical {
        Classical::of(self, Cell::ROOT)
    }

    /// Builds the tree on the frame of [`lattice_frame`].
    pub fn octree(&self) -> Octree {
        self.octree_with(Tag::Empty, &alone()).unwrap()
    }

    pub fn octree_with(&self, exterior: Tag, control: &Control<'_>) -> Result<Octree, Error> {
        build(&DenseSolid { dense: self, exterior }, &lattice_frame(self.depth), Rule::Certified, control)
    }
}

/// Returns the coordinates of all finest cells in the order of [`Dense::tags`].
pub fn positions(depth: u8) -> impl Iterator<Item = [u32; 3]> {
    let n = 1u32 << depth;
    (0..n).flat_map(move |z| (0..n).flat_map(move |y| (0..n).map(move |x| [x, y, z])))
}

/// A dense array as a solid.
#[derive(Clone, Copy)]
pub struct DenseSolid<'a> {
    pub dense: &'a Dense,
    pub exterior: Tag,
}

impl cubes::Cubes for DenseSolid<'_> {
    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error> {
        Ok(match self.dense.tag_of(cube.cell) {
            Some(Tag::Empty) => Verdict::Empty,
            Some(Tag::Full) => Verdict::Full,
            Some(_) => Verdict::Undecided,
            None => Verdict::Partial(()),
        })
    }

    fn exterior(&self, _: &Frame) -> Tag {
        self.exterior
    }
}

crate::solid_of_cubes!(DenseSolid<'a>: 'a);

/// A textbook octree with explicit leaves.
#[derive(Debug)]
pub enum Classical {
    Leaf(Tag),
    Node(Box<[Classical; 8]>),
}

impl Classical {
    fn of(dense: &Dense, cell: Cell) -> Classical {
        match dense.tag_of(cell) {
            Some(tag) => Classical::Leaf(tag),
            None => Classical::Node(Box::new(
                [0, 1, 2, 3, 4, 5, 6, 7].map(|k| Classical::of(dense, cell.child(k))),
            )),
        }
    }

    pub fn tag(&self) -> Tag {
        match self {
            Classical::Leaf(tag) => *tag,
            Classical::Node(_) => Tag::Branch,
        }
    }

    /// Returns the numbers of internal nodes and of leaves.
    pub fn nodes(&self) -> (u64, u64) {
        match self {
            Classical::Leaf(_) => (0, 1),
            Classical::Node(children) => {
                children.iter().map(Classical::nodes).fold((1, 0), |sum, n| (sum.0 + n.0, sum.1 + n.1))
            }
        }
    }

    /// Returns for each level 0..=depth the numbers of internal nodes and of EMPTY, FULL and PARTIAL leaves.
    pub fn levels(&self, depth: u8) -> Vec<[u64; 4]> {
        fn walk(tree: &Classical, level: usize, sums: &mut [[u64; 4]]) {
            match tree {
                Classical::Node(children) => {
                    sums[level][0] += 1;
                    children.iter().for_each(|child| walk(child, level + 1, sums));
                }
                Classical::Leaf(Tag::Empty) => sums[level][1] += 1,
                Classical::Leaf(Tag::Full) => sums[level][2] += 1,
                Classical::Leaf(_) => sums[level][3] += 1,
            }
        }
        let mut sums = vec![[0; 4]; depth as usize + 1];
        walk(self, 0, &mut sums);
        sums
    }

    /// Asserts that the subtree at a cursor equals this tree. The cursor returns to its cell.
    pub fn assert_same(&self, cursor: &mut Cursor<'_>) {
        let cell = cursor.cell();
        assert_eq!(cursor.tag(), self.tag(), "{cell:?}");
        match self {
            Classical::Leaf(_) => {
                assert_eq!(cursor.node(), None);
                assert!(!cursor.descend(0));
                assert_eq!(cursor.cell(), cell);
            }
            Classical::Node(children) => {
                let tags = [0, 1, 2, 3, 4, 5, 6, 7].map(|k: usize| children[k].tag());
                assert_eq!(cursor.node().unwrap().tags(), tags, "{cell:?}");
                assert!(!cursor.descend(8));
                for k in 0..8 {
                    assert!(cursor.descend(k));
                    assert_eq!(cursor.cell(), cell.child(k));
                    children[k as usize].assert_same(cursor);
                    assert!(cursor.ascend());
                    assert_eq!((cursor.cell(), cursor.tag()), (cell, Tag::Branch));
                }
                // The node must be unchanged after the walk below it.
                assert_eq!(cursor.node().unwrap().tags(), tags, "{cell:?}");
            }
        }
    }
}

/// Asserts that a tree and its statistics equal a dense array.
pub fn assert_is(tree: &Octree, dense: &Dense) {
    tree.view().check().unwrap();
    assert_eq!(tree.frame().depth(), dense.depth);
    assert_eq!(&Dense::of(tree.view()), dense);
    let classical = dense.classical();
    assert_eq!(tree.view().root_tag(), classical.tag());
    assert_eq!(tree.view().is_binary(), dense.is_binary());
    assert_statistics(tree, dense, &classical);
}

fn assert_statistics(tree: &Octree, dense: &Dense, classical: &Classical) {
    let statistics = tree.statistics();
    let (nodes, leaves) = classical.nodes();
    assert_eq!(statistics.nodes(), nodes);
    assert_eq!(nodes + leaves, 8 * nodes + 1);
    let expected = classical.levels(dense.depth);
    assert_eq!(statistics.levels().len(), expected.len());
    for (level, (found, expected)) in statistics.levels().iter().zip(&expected).enumerate() {
        let LevelStatistics { nodes, empty, full, partial, .. } = *found;
        assert_eq!(found.level as usize, level);
        assert_eq!([nodes, empty, full, partial], *expected, "level {level}");
        let cut = dense.cut(level as u8);
        let cells = 1u64 << (3 * (dense.depth as usize - level));
        let (lower, undecided) = (cut.count(Tag::Full) * cells, cut.count(Tag::Partial) * cells);
        assert_eq!((found.lower_cells, found.upper_cells), (lower, lower + undecided), "level {level}");
        let cell = tree.frame().cell_size();
        assert!(found.volume.lower <= lower as f64 * cell.powi(3) * (1.0 + 1e-15));
        assert!(found.volume.upper >= (lower + undecided) as f64 * cell.powi(3) * (1.0 - 1e-15));
    }
    for (tag, i) in [(Tag::Branch, 0), (Tag::Empty, 1), (Tag::Full, 2), (Tag::Partial, 3)] {
        assert_eq!(statistics.cells(tag), expected.iter().map(|level| level[i]).sum::<u64>());
    }
    assert_eq!(
        statistics.volume_cells(),
        (dense.count(Tag::Full), dense.count(Tag::Full) + dense.count(Tag::Partial))
    );
}

/// A random solid as a tape of decisions, applied level by level. Short tapes are simple solids, so that
/// failures shrink to solids that can be drawn.
#[derive(Clone, Debug)]
pub struct Shape {
    pub depth: u8,
    pub tape: Vec<u8>,
}

impl Shape {
    pub fn dense(&self) -> Dense {
        let mut dense = Dense::uniform(self.depth, Tag::Empty);
        let mut queue = std::collections::VecDeque::from([Cell::ROOT]);
        let mut tape = self.tape.iter();
        while let (Some(cell), Some(&code)) = (queue.pop_front(), tape.next()) {
            match code % 16 {
                0 => {}
                1 | 2 => fill(&mut dense, cell, |_| Tag::Full),
                3 | 4 => fill(&mut dense, cell, |_| Tag::Partial),
                // Fine grain: binary, three-valued, or mostly undecided.
                5 => fill(&mut dense, cell, |at| [Tag::Empty, Tag::Full][(noise(code, at) % 2) as usize]),
                6 => fill(&mut dense, cell, |at| TAGS[(noise(code, at) % 3) as usize]),
                7 => fill(&mut dense, cell, |at| match noise(code, at) % 40 {
                    0 => Tag::Full,
                    1 => Tag::Empty,
                    _ => Tag::Partial,
                }),
                // A plane: cut cells along a surface, as in real solids.
                8 => fill(&mut dense, cell, |[x, y, z]| match (x + 2 * y + 3 * z) as i64 {
                    s if s < 3 << (self.depth - 1) => Tag::Full,
                    s if s < (3 << (self.depth - 1)) + 3 => Tag::Partial,
                    _ => Tag::Empty,
                }),
                _ if cell.level < self.depth => queue.extend((0..8).map(|k| cell.child(k))),
                _ => fill(&mut dense, cell, |_| TAGS[(code / 16 % 3) as usize]),
            }
        }
        dense
    }
}

fn fill(dense: &mut Dense, cell: Cell, tag: impl Fn([u32; 3]) -> Tag) {
    let edge = 1 << (dense.depth - cell.level);
    let [x, y, z] = cell.at.map(|a| a * edge);
    for z in z..z + edge {
        for y in y..y + edge {
            for x in x..x + edge {
                dense.set([x, y, z], tag([x, y, z]));
            }
        }
    }
}

/// Returns a hash of a seed and a cell.
pub fn noise(seed: u8, [x, y, z]: [u32; 3]) -> u64 {
    let mut h = (seed as u64) << 60 ^ (x as u64) << 40 ^ (y as u64) << 20 ^ z as u64;
    for _ in 0..2 {
        h = (h ^ h >> 31).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
    h >> 33
}

/// Generates random tapes for a depth, mostly with a root that is cut.
pub fn shapes_of(depth: u8) -> impl Strategy<Value = Shape> {
    let tape = proptest::collection::vec(any::<u8>(), 0..150);
    (tape, 0..16u8).prop_map(move |(mut tape, root)| {
        if root > 0 {
            tape.insert(0, 9);
        }
        Shape { depth, tape }
    })
}

/// Generates two solids on one lattice. Half of the pairs nearly coincide, so that results collapse.
pub fn pairs_of(depth: u8) -> impl Strategy<Value = (Dense, Dense)> {
    let edits = proptest::collection::vec((0..8u8.pow(2), any::<u32>(), 0..3usize), 0..4);
    (shapes_of(depth), shapes_of(depth), any::<bool>(), edits).prop_map(move |(a, b, near, edits)| {
        let a = a.dense();
        let mut b = if near { a.clone() } else { b.dense() };
        for (coarse, fine, tag) in edits {
            let level = coarse % (depth + 1);
            let at = [0, 10, 20].map(|shift| fine >> shift & ((1 << level) - 1));
            fill(&mut b, Cell { level, at }, |_| TAGS[tag]);
        }
        (a, b)
    })
}

pub fn pairs(depths: std::ops::RangeInclusive<u8>) -> impl Strategy<Value = (Dense, Dense)> {
    depths.prop_flat_map(pairs_of)
}

pub fn shapes(depths: std::ops::RangeInclusive<u8>) -> impl Strategy<Value = Shape> {
    depths.prop_flat_map(shapes_of)
}
