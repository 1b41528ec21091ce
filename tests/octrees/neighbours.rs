//! Neighbours of cells, and iterators over cells and boundary faces, against dense arrays.

use leafless::octree::{BoundaryFace, CellFilter, Cursor, Direction, TaggedCell};
use leafless::{Cell, Error, Octree, OctreeRef, Tag, compact, file};
use leafless_testkit::{Aligned, Dense, positions};
use proptest::prelude::*;
use std::collections::{HashMap, HashSet};

const LEAVES: [Tag; 3] = [Tag::Empty, Tag::Full, Tag::Partial];

/// Returns every cell of the canonical octree of a dense array, in Morton order, parents first.
fn cells_of(dense: &Dense) -> Vec<TaggedCell> {
    let mut cells = vec![];
    let mut open = vec![Cell::ROOT];
    while let Some(cell) = open.pop() {
        let tag = dense.tag_of(cell).unwrap_or(Tag::Branch);
        cells.push(TaggedCell { cell, tag });
        if tag == Tag::Branch {
            open.extend((0..8).rev().map(|octant| cell.child(octant)));
        }
    }
    cells
}

/// Returns the range of finest cells that a cell covers: the first, and the first beyond.
fn extent(cell: Cell, depth: u8) -> [[u32; 3]; 2] {
    let shift = depth - cell.level;
    [cell.at.map(|a| a << shift), cell.at.map(|a| (a + 1) << shift)]
}

/// True if a box of finest cells and a cell overlap.
fn reaches(cell: Cell, depth: u8, min: [u32; 3], max: [u32; 3]) -> bool {
    let [low, high] = extent(cell, depth);
    (0..3).all(|axis| low[axis].max(min[axis]) < high[axis].min(max[axis]))
}

/// True if `b` touches `a` in exactly this direction: along an axis with a step, `b` begins where `a` ends;
/// along the other axes the two overlap.
fn touches(a: Cell, b: Cell, direction: Direction, depth: u8) -> bool {
    let ([low, high], [min, max]) = (extent(a, depth), extent(b, depth));
    (0..3).all(|axis| match direction.steps()[axis] {
        1 => min[axis] == high[axis],
        -1 => max[axis] == low[axis],
        _ => low[axis].max(min[axis]) < high[axis].min(max[axis]),
    })
}

/// Returns the neighbour by its definition.
fn neighbour(dense: &Dense, cell: Cell, direction: Direction) -> Option<TaggedCell> {
    let mut at = [0; 3];
    for axis in 0..3 {
        let moved = cell.at[axis] as i64 + direction.steps()[axis] as i64;
        at[axis] = u32::try_from(moved).ok().filter(|&a| a < 1 << cell.level)?;
    }
    let mut found = Cell { level: cell.level, at };
    let Some(tag) = dense.tag_of(found) else { return Some(TaggedCell { cell: found, tag: Tag::Branch }) };
    while found.level > 0 && dense.tag_of(found.parent()).is_some() {
        found = found.parent();
    }
    Some(TaggedCell { cell: found, tag })
}

fn assert_neighbours(tree: &OctreeRef<'_>, dense: &Dense) {
    let all = cells_of(dense);
    let leaves: Vec<TaggedCell> = all.iter().filter(|found| found.tag != Tag::Branch).copied().collect();
    let depth = dense.depth;
    let mut cursor = Cursor::new(tree);
    // A walk in an order that jumps.
    let step = (617..).find(|step| gcd(*step, all.len()) == 1).unwrap();
    for i in 0..all.len().min(50) {
        let TaggedCell { cell, tag } = all[i * step % all.len()];
        assert!(cursor.seek(cell).unwrap());
        assert_eq!((cursor.cell(), cursor.tag()), (cell, tag));
        for direction in Direction::ALL {
            let expected = neighbour(dense, cell, direction);
            assert_eq!(cursor.neighbour(direction), expected, "{cell:?} {direction:?}");
            let found: Vec<TaggedCell> = cursor.neighbours(direction).collect();
            let expected: Vec<TaggedCell> = match expected {
                None => vec![],
                Some(TaggedCell { tag: Tag::Branch, .. }) => {
                    leaves.iter().filter(|leaf| touches(cell, leaf.cell, direction, depth)).copied().collect()
                }
                Some(leaf) => vec![leaf],
            };
            assert_eq!(found, expected, "{cell:?} {direction:?}");
        }
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// A filter, and the same filter for the oracle.
#[derive(Debug, Clone)]
struct Wanted {
    tags: Vec<Tag>,
    levels: [u8; 2],
    min: [u32; 3],
    max: [u32; 3],
}

impl Wanted {
    fn filter(&self) -> CellFilter {
        let [first, last] = self.levels;
        CellFilter::tags(&self.tags).levels(first..=last).within(self.min, self.max)
    }

    fn has(&self, found: &TaggedCell, depth: u8) -> bool {
        self.tags.contains(&found.tag)
            && (self.levels[0]..=self.levels[1]).contains(&found.cell.level)
            && reaches(found.cell, depth, self.min, self.max)
    }
}

fn wanted(depth: u8) -> impl Strategy<Value = Wanted> {
    let tags = prop::collection::vec(
        prop::sample::select(vec![Tag::Empty, Tag::Branch, Tag::Partial, Tag::Full]),
        1..4,
    );
    let corner = move || [0..=1u32 << depth, 0..=1u32 << depth, 0..=1u32 << depth];
    (tags, [0..=depth, 0..=depth], corner(), corner(), any::<[bool; 2]>()).prop_map(
        |(tags, levels, a, b, [whole, deep])| Wanted {
            tags,
            levels: if deep { [0, 20] } else { levels },
            min: if whole { [0; 3] } else { [0, 1, 2].map(|axis| a[axis].min(b[axis])) },
            max: if whole { [u32::MAX; 3] } else { [0, 1, 2].map(|axis| a[axis].max(b[axis])) },
        },
    )
}

/// Returns a cell's key in Morton order, parents first.
fn order(cell: Cell) -> (u64, u8) {
    let [x, y, z] = cell.first_at(20).at;
    let bit = |a: u32, level: u32| (a >> level & 1) as u64;
    let morton = (0..20)
        .rev()
        .fold(0, |morton, level| morton << 3 | bit(z, level) << 2 | bit(y, level) << 1 | bit(x, level));
    (morton, cell.level)
}

fn assert_cells(tree: &OctreeRef<'_>, dense: &Dense, wanted: &Wanted) {
    let depth = dense.depth;
    let all = cells_of(dense);
    let expected: Vec<TaggedCell> = all.iter().filter(|found| wanted.has(found, depth)).copied().collect();
    assert!(expected.is_sorted_by_key(|found| order(found.cell)));
    let mut cells = tree.cells(wanted.filter());
    assert_eq!(cells.by_ref().collect::<Vec<_>>(), expected);
    assert_eq!(cells.next(), None);
    // In bulk, in pieces.
    let mut cells = tree.cells(wanted.filter());
    let mut buffer = [TaggedCell { cell: Cell::ROOT, tag: Tag::Empty }; 7];
    let mut found = vec![];
    loop {
        let count = cells.fill(&mut buffer);
        found.extend_from_slice(&buffer[..count]);
        if count < buffer.len() {
            break;
        }
    }
    assert_eq!(found, expected);
    // Start from any cell, including parts of leaves.
    let finest = positions(depth).step_by(11).map(|at| Cell { level: depth, at });
    let starts = all.iter().map(|found| found.cell).step_by(1 + all.len() / 60).chain(finest.take(60));
    for start in starts {
        let first = (0..=start.level)
            .map(|level| Cell { level, at: start.at.map(|a| a >> (start.level - level)) })
            .find(|&cell| dense.tag_of(cell).is_some())
            .unwrap_or(start);
        let rest = expected.iter().filter(|found| order(found.cell) >= order(first)).copied();
        cells.seek(start).unwrap();
        assert_eq!(cells.by_ref().collect::<Vec<_>>(), rest.collect::<Vec<_>>(), "from {start:?}");
    }
}

/// The unit squares of faces: a finest cell, an axis, and the side.
type Squares = HashSet<([u32; 3], usize, bool)>;

/// Returns the boundary by its definition: the faces of finest cells with these tags towards other cells.
fn squares_of(dense: &Dense, tags: &[Tag], exterior: Tag) -> Squares {
    let n = 1u32 << dense.depth;
    let mut squares = HashSet::new();
    for at in positions(dense.depth).filter(|&at| tags.contains(&dense.at(at))) {
        for axis in 0..3 {
            for up in [false, true] {
                let mut beside = at;
                beside[axis] = if up { at[axis] + 1 } else { at[axis].wrapping_sub(1) };
                let tag = if beside[axis] < n { dense.at(beside) } else { exterior };
                if !tags.contains(&tag) {
                    squares.insert((at, axis, up));
                }
            }
        }
    }
    squares
}

fn assert_faces(tree: &OctreeRef<'_>, dense: &Dense, tags: &[Tag]) {
    let depth = dense.depth;
    let leaves: HashMap<Cell, Tag> = cells_of(dense).iter().map(|found| (found.cell, found.tag)).collect();
    let mut iterator = tree.boundary_faces(CellFilter::tags(tags));
    let faces: Vec<BoundaryFace> = iterator.by_ref().collect();
    let mut squares = HashSet::new();
    for BoundaryFace { inner, outer, direction } in &faces {
        assert!(tags.contains(&inner.tag) && leaves[&inner.cell] == inner.tag);
        let axis = direction.steps().iter().position(|&step| step != 0).unwrap();
        let up = direction.steps()[axis] > 0;
        let [mut low, mut high] = extent(inner.cell, depth);
        if let Some(outer) = outer {
            assert!(!tags.contains(&outer.tag) && leaves[&outer.cell] == outer.tag);
            assert!(touches(inner.cell, outer.cell, *direction, depth));
            let [min, max] = extent(outer.cell, depth);
            for other in (0..3).filter(|&other| other != axis) {
                (low[other], high[other]) = (low[other].max(min[other]), high[other].min(max[other]));
            }
        }
        let layer = if up { high[axis] - 1 } else { low[axis] };
        (low[axis], high[axis]) = (layer, layer + 1);
        for z in low[2]..high[2] {
            for y in low[1]..high[1] {
                for x in low[0]..high[0] {
                    assert!(squares.insert(([x, y, z], axis, up)), "{inner:?} {direction:?} twice");
                }
            }
        }
    }
    assert_eq!(squares, squares_of(dense, tags, tree.exterior()));
    let place = |face: &BoundaryFace| {
        let side = Direction::FACES.iter().position(|side| *side == face.direction).unwrap();
        (order(face.inner.cell), side, face.outer.map(|outer| order(outer.cell)))
    };
    assert!(faces.is_sorted_by(|a, b| place(a) < place(b)));
    for start in faces.iter().step_by(1 + faces.len() / 20).map(|face| face.inner.cell) {
        let rest = faces.iter().filter(|face| order(face.inner.cell) >= order(start)).copied();
        iterator.seek(start).unwrap();
        assert_eq!(iterator.by_ref().collect::<Vec<_>>(), rest.collect::<Vec<_>>());
    }
}

/// Checks the tree in memory, with a dictionary, and over the bytes of its file.
fn in_all_forms(tree: &Octree, mut check: impl FnMut(&OctreeRef<'_>)) {
    check(tree.view());
    check(compact(tree.view()).unwrap().view());
    check(&file::view(Aligned::new(&file::to_bytes(tree).unwrap()).bytes()).unwrap());
}

proptest! {
    #![proptest_config(leafless_testkit::cases(300))]

    #[test]
    fn neighbours_are_those_of_the_dense_array(shape in leafless_testkit::shapes(1..=4)) {
        let dense = shape.dense();
        in_all_forms(&dense.octree(), |tree| assert_neighbours(tree, &dense));
    }

    #[test]
    fn cells_are_those_of_the_dense_array((shape, wanted) in (leafless_testkit::shapes(1..=5), wanted(5))) {
        let dense = shape.dense();
        in_all_forms(&dense.octree(), |tree| assert_cells(tree, &dense, &wanted));
    }

    #[test]
    fn faces_are_those_of_the_dense_array(
        (shape, tags, exterior) in (
            leafless_testkit::shapes(1..=5),
            prop::sample::subsequence(LEAVES.to_vec(), 1..=3),
            prop::sample::select(LEAVES.to_vec()),
        )
    ) {
        let dense = shape.dense();
        let tree = dense.octree_with(exterior, &leafless_testkit::alone()).unwrap();
        in_all_forms(&tree, |tree| assert_faces(tree, &dense, &tags));
    }
}

/// The faces within a box and levels are the faces of the inner cells there.
#[test]
fn faces_of_some_cells() {
    let dense = Dense::from_fn(4, |[x, y, z]| match x * x + y * y + z * z {
        0..90 => Tag::Full,
        90..110 => Tag::Partial,
        _ => Tag::Empty,
    });
    let tree = dense.octree();
    for tags in [&[Tag::Full][..], &[Tag::Full, Tag::Partial], &[Tag::Branch, Tag::Full]] {
        let solid: Vec<Tag> = tags.iter().copied().filter(|&tag| tag != Tag::Branch).collect();
        let all: Vec<BoundaryFace> = tree.view().boundary_faces(CellFilter::tags(&solid)).collect();
        for (levels, min, max) in [
            ([0, 20], [0; 3], [5, 16, 16]),
            ([3, 3], [0; 3], [16; 3]),
            ([2, 4], [3, 2, 1], [4, 9, 13]),
            ([0, 20], [3; 3], [3; 3]),
        ] {
            let wanted = Wanted { tags: solid.clone(), levels, min, max };
            let filter = Wanted { tags: tags.to_vec(), ..wanted.clone() }.filter();
            let faces: Vec<BoundaryFace> = tree.view().boundary_faces(filter).collect();
            let expected = all.iter().filter(|face| wanted.has(&face.inner, 4)).copied();
            assert_eq!(faces, expected.collect::<Vec<_>>());
            assert_eq!(faces.is_empty(), min == max);
        }
    }
}

#[test]
fn cells_that_are_none_are_refused() {
    let tree = Dense::from_fn(3, |[x, ..]| if x < 3 { Tag::Full } else { Tag::Empty }).octree();
    let (mut cursor, mut cells) = (Cursor::new(tree.view()), tree.view().cells(CellFilter::leaves()));
    let mut faces = tree.view().boundary_faces(CellFilter::tags(&[Tag::Full]));
    assert!(cursor.seek(Cell { level: 3, at: [2, 7, 1] }).unwrap());
    for (level, at) in [(4, [0; 3]), (255, [0; 3]), (3, [0, 8, 0]), (0, [0, 0, 1]), (1, [u32::MAX, 0, 0])] {
        let cell = Cell { level, at };
        assert!(matches!(cursor.seek(cell), Err(Error::Argument { name: "cell", .. })));
        assert!(matches!(cells.seek(cell), Err(Error::Argument { name: "cell", .. })));
        assert!(matches!(faces.seek(cell), Err(Error::Argument { name: "cell", .. })));
    }
    assert_eq!(cursor.cell(), Cell { level: 3, at: [2, 7, 1] });
    // A cell within a leaf leads to the leaf.
    assert!(!cursor.seek(Cell { level: 3, at: [7, 7, 7] }).unwrap());
    assert_eq!((cursor.cell(), cursor.tag()), (Cell { level: 1, at: [1, 1, 1] }, Tag::Empty));
}
