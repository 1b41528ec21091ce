//! Any bytes as the arrays of voxel records. Refused arrays are wrong, and for accepted arrays every answer
//! is that of a search through all records.

use super::Bytes;
use leafless::lattice::MAX_DEPTH;
use leafless::voxel::{
    LinearCode, Symmetry, Viewpoint, VoxelKind, VoxelRecords, VoxelRecordsRef, VoxelSolid,
};
use leafless::{Affine, Cell, Control, Csg, Frame, Tag, TriangleMesh, measure};

impl Bytes<'_> {
    fn word(&mut self) -> u64 {
        (0..8).fold(0, |word, _| word << 8 | self.byte() as u64)
    }
}

const CONTROL: Control<'static> = Control {
    threads: 1,
    max_nodes: Some(1 << 14),
    max_bytes: Some(1 << 18),
    max_splits: Some(1 << 10),
    cancel: None,
    progress: None,
};

/// The most records of an input.
const MOST: usize = 64;

#[derive(Default, Clone)]
struct Arrays {
    codes: Vec<u64>,
    levels: Vec<u8>,
    kinds: Vec<u8>,
    values: Vec<f64>,
}

/// Runs the fuzz target.
pub fn records(data: &[u8]) {
    let mut bytes = Bytes(data);
    let bytes = &mut bytes;
    let depth = [1, 2, 2, 3, 3, 3, 4, MAX_DEPTH][bytes.below(8)];
    let frame = Frame::new([-1.0, 0.5, 3.0], 4.0, depth).expect("a good frame");
    let components = bytes.below(6);
    let mut arrays = Arrays::default();
    if bytes.below(8) == 0 {
        for _ in 0..bytes.below(MOST) {
            arrays.codes.push(bytes.word() >> bytes.below(64));
            arrays.levels.push(bytes.byte() as u8);
            arrays.kinds.push(bytes.byte() as u8);
        }
    } else {
        descend(bytes, depth, 0, 0, &mut arrays);
    }
    let special = [f64::NAN, f64::INFINITY, -0.0, 1e300, 5e-324];
    arrays.values = (0..arrays.codes.len() * components)
        .map(|k| special.get(bytes.below(32)).copied().unwrap_or(k as f64))
        .collect();
    for _ in 0..bytes.below(3) {
        damage(bytes, &mut arrays);
    }
    let Arrays { codes, levels, kinds, values } = arrays.clone();
    let found = VoxelRecords::from_arrays(&frame, codes, levels, kinds, components, values);
    assert_eq!(found.is_ok(), is_good(&arrays, depth, components), "{:?}", found.err());
    let Ok(records) = found else { return };
    let records = match bytes.below(4) {
        0 => records.with_exterior(Tag::Empty, leafless::Proof::CERTIFIED).with_boundary(Tag::Full),
        1 => records.with_exterior(Tag::Branch, leafless::Proof::new(true, false)),
        _ => records,
    };
    let view = records.view();
    found_in(bytes, &view);
    turned(bytes, &view);
    ordered(bytes, &view);
    as_solids(bytes, &view);
}

/// Appends records of some of the cells below a cell, in order.
fn descend(bytes: &mut Bytes<'_>, depth: u8, level: u8, code: u64, arrays: &mut Arrays) {
    if arrays.codes.len() >= MOST {
        return;
    }
    let what = bytes.byte();
    let can_split = level < depth;
    let kind = match what % 8 {
        0 => return,
        1 | 2 => VoxelKind::Inside,
        3 => VoxelKind::Outside,
        4 => VoxelKind::Boundary,
        // Split without a record of its own, or with one.
        5 if can_split => return children(bytes, depth, level, code, arrays),
        _ => VoxelKind::Refined,
    };
    arrays.codes.push(code);
    arrays.levels.push(level);
    arrays.kinds.push(kind as u8);
    if kind == VoxelKind::Refined && can_split {
        children(bytes, depth, level, code, arrays);
    }
}

fn children(bytes: &mut Bytes<'_>, depth: u8, level: u8, code: u64, arrays: &mut Arrays) {
    for octant in 0..8 {
        descend(bytes, depth, level + 1, code | octant << (3 * (depth - level - 1)), arrays);
    }
}

/// Makes a change at one place.
fn damage(bytes: &mut Bytes<'_>, arrays: &mut Arrays) {
    let count = arrays.codes.len();
    if count == 0 {
        return;
    }
    let (at, other) = (bytes.below(count), bytes.below(count));
    match bytes.below(9) {
        0 => arrays.codes[at] ^= 1 << bytes.below(64),
        1 => arrays.codes[at] = [0, u64::MAX, 1 << 60, arrays.codes[other]][bytes.below(4)],
        2 => arrays.levels[at] = bytes.byte() as u8,
        3 => arrays.kinds[at] = bytes.byte() as u8,
        4 => arrays.kinds[at] = VoxelKind::Refined as u8,
        5 => arrays.codes.swap(at, other),
        6 => {
            arrays.codes.pop();
        }
        7 => {
            arrays.values.pop();
        }
        _ => arrays.levels[at] = arrays.levels[at].saturating_sub(1),
    }
}

/// True if arrays satisfy the documentation of records, by a check of all pairs.
fn is_good(arrays: &Arrays, depth: u8, components: usize) -> bool {
    let Arrays { codes, levels, kinds, values } = arrays;
    let count = codes.len();
    if components > 4 || [levels.len(), kinds.len()] != [count; 2] || values.len() != count * components {
        return false;
    }
    // As wide as the largest value requires.
    let size = |k: usize| 1u128 << (3 * u32::from(depth - levels[k]));
    let each = (0..count).all(|k| {
        levels[k] <= depth
            && u128::from(codes[k]) < 1 << (3 * u32::from(depth))
            && u128::from(codes[k]).is_multiple_of(size(k))
            && kinds[k] <= 3
    });
    each && (0..count).all(|j| {
        (0..j).all(|i| {
            let ascend = (codes[i], levels[i]) < (codes[j], levels[j]);
            let apart = u128::from(codes[i]) + size(i) <= u128::from(codes[j]);
            ascend && (apart || kinds[i] == VoxelKind::Refined as u8)
        })
    })
}

/// Some cells of every level, and some invalid ones.
fn cells(bytes: &mut Bytes<'_>, view: &VoxelRecordsRef<'_>) -> Vec<Cell> {
    let depth = view.frame().depth();
    let mut cells: Vec<Cell> = view.iter().map(|record| record.cell).collect();
    if depth <= 3 {
        for level in 0..=depth {
            let n = 1u32 << level;
            cells.extend((0..n * n * n).map(|k| Cell { level, at: [k % n, k / n % n, k / n / n] }));
        }
    }
    cells.extend((0..8).map(|_| {
        let mut at = [0; 3].map(|_: u32| bytes.word() as u32 >> bytes.below(32));
        let level = bytes.below(24) as u8;
        if bytes.below(2) == 0 {
            at = at.map(|c| c & ((1u64 << level.min(31)) - 1) as u32);
        }
        Cell { level, at }
    }));
    cells
}

/// True if one cell lies in another.
fn holds(outer: Cell, inner: Cell) -> bool {
    outer.level <= inner.level
        && (0..3).all(|axis| inner.at[axis] >> (inner.level - outer.level) == outer.at[axis])
}

fn found_in(bytes: &mut Bytes<'_>, view: &VoxelRecordsRef<'_>) {
    let all: Vec<_> = view.iter().collect();
    let depth = view.frame().depth();
    for kind in VoxelKind::ALL {
        assert_eq!(view.count(kind), all.iter().filter(|record| record.kind == kind).count() as u64);
    }
    for cell in cells(bytes, view) {
        let is_cell = cell.level <= depth && cell.at.iter().all(|&c| u64::from(c) >> cell.level == 0);
        let found = view.find(cell);
        assert_eq!(found, all.iter().position(|record| is_cell && record.cell == cell), "{cell:?}");
        let within = view.within(cell);
        let inside: Vec<usize> = (0..all.len()).filter(|&k| is_cell && holds(cell, all[k].cell)).collect();
        assert!(within.clone().eq(inside.iter().copied()), "{cell:?}: {within:?}, {inside:?}");
        let containing = view.containing(cell);
        if is_cell {
            let leaf = |k: &usize| all[*k].kind != VoxelKind::Refined && holds(all[*k].cell, cell);
            assert_eq!(containing, (0..all.len()).find(leaf), "{cell:?}");
        }
        for (octant, range) in (0..8).zip(view.children(cell)) {
            assert!(!is_cell || cell.level == depth || range == view.within(cell.child(octant)));
        }
    }
    for k in 0..all.len() {
        let code = view.code(k).expect("one of the records");
        assert_eq!((code.number(), code.level()), (view.codes()[k], view.levels()[k]));
        assert_eq!(
            LinearCode::from_number(code.number(), code.level(), depth).map(LinearCode::cell).ok(),
            Some(all[k].cell)
        );
    }
}

/// Returns the numbers of all arrays as bits, so that NaNs can be compared.
fn numbers(view: &VoxelRecordsRef<'_>) -> (Vec<u64>, Vec<u8>, Vec<u8>, Vec<u64>) {
    let values = view.values().iter().map(|value| value.to_bits()).collect();
    (view.codes().to_vec(), view.levels().to_vec(), view.kinds().to_vec(), values)
}

/// Applies a symmetry until the records are the original ones again.
fn turned(bytes: &mut Bytes<'_>, view: &VoxelRecordsRef<'_>) {
    let symmetry = Symmetry::all().nth(bytes.below(48)).expect("there are 48");
    let mut now = view.turned(symmetry, &CONTROL).expect("enough memory");
    let first = now.clone();
    for record in view.iter() {
        let most = (1u32 << record.cell.level) - 1;
        let at = [0, 1, 2].map(|axis| {
            let from = record.cell.at[symmetry.axes()[axis] as usize];
            if symmetry.flipped()[axis] { most - from } else { from }
        });
        let image = first.view().find(Cell { at, ..record.cell }).expect("it was moved there");
        assert_eq!(first.view().get(image).map(|image| image.kind), Some(record.kind));
    }
    // The order of each divides 12.
    for _ in 1..12 {
        now = now.view().turned(symmetry, &CONTROL).expect("enough memory");
    }
    assert_eq!(numbers(&now.view()), numbers(view));
    let placement = Affine::translation([0.5, -3.0, 8.0]).expect("a good map");
    let there = view.placed_exactly(&placement, &CONTROL).expect("it is exact");
    let back = placement.inverse().and_then(|back| there.view().placed_exactly(&back, &CONTROL));
    assert_eq!(numbers(&back.expect("it is exact").view()), numbers(view));
    // Onto its own lattice by centres.
    let Ok(again) = view.placed_by_centres(&Affine::IDENTITY, view.frame(), &CONTROL) else { return };
    if view.frame().depth() <= 3 {
        for cell in finest(view.frame()) {
            let kind = |records: &VoxelRecordsRef<'_>| {
                records.containing(cell).and_then(|k| records.get(k)).map(|record| record.kind)
            };
            assert_eq!(kind(&again.view()), kind(view), "{cell:?}");
        }
    }
    let any = Affine::new([
        [0.7, 0.1 * bytes.below(9) as f64, 0.0, 1.0],
        [0.0, -1.3, 0.2, 2.0],
        [0.1, 0.0, 0.9, -1.0],
    ]);
    let coarse = view.frame().with_depth(view.frame().depth().min(4)).expect("no deeper");
    let _ = view.placed_by_centres(&any.expect("a good map"), &coarse, &CONTROL);
}

fn finest(frame: &Frame) -> impl Iterator<Item = Cell> + use<> {
    let (n, level) = (frame.cells(), frame.depth());
    (0..n * n * n).map(move |k| Cell { level, at: [k % n, k / n % n, k / n / n] })
}

/// Checks the order from front to back along an axis: each leaf once, nearer leaves first.
fn ordered(bytes: &mut Bytes<'_>, view: &VoxelRecordsRef<'_>) {
    let (axis, depth) = (bytes.below(3), view.frame().depth());
    let mut direction = [0.0; 3];
    direction[axis] = 1.0;
    let order = view.depth_order(&Viewpoint::Parallel(direction), &CONTROL).expect("a good direction");
    let leaves: Vec<u64> = (0..view.len() as u64)
        .filter(|&k| view.get(k as usize).is_some_and(|record| record.kind != VoxelKind::Refined))
        .collect();
    let mut sorted = order.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, leaves);
    let range = |k: u64, axis: usize| {
        let cell = view.get(k as usize).expect("one of the records").cell;
        let size = 1u64 << (depth - cell.level);
        (u64::from(cell.at[axis]) * size, (u64::from(cell.at[axis]) + 1) * size)
    };
    let across = [(axis + 1) % 3, (axis + 2) % 3];
    for (i, &near) in order.iter().enumerate() {
        for &far in &order[i + 1..] {
            let meet = across
                .iter()
                .all(|&a| range(near, a).0 < range(far, a).1 && range(far, a).0 < range(near, a).1);
            // Seen along the axis, records with smaller coordinates are in front.
            assert!(!meet || range(near, axis).0 < range(far, axis).1, "{near} before {far}");
            assert!(!meet || range(near, axis).1 <= range(far, axis).0, "{near} before {far}");
        }
    }
    let eye = [0; 3].map(|_: i32| bytes.byte() as f64 / 16.0 - 8.0);
    let order = view.depth_order(&Viewpoint::Perspective(eye), &CONTROL).expect("a good eye");
    assert_eq!(order.len(), leaves.len());
}

/// Checks the records as an octree, and as a solid.
fn as_solids(bytes: &mut Bytes<'_>, view: &VoxelRecordsRef<'_>) {
    let boundary = [Tag::Empty, Tag::Partial, Tag::Full, Tag::Branch][bytes.below(4)];
    let found = view.to_octree(boundary, &CONTROL);
    if boundary == Tag::Branch {
        return assert!(found.is_err());
    }
    if view.frame().depth() <= 3 {
        let tree = found.as_ref().expect("it is small");
        for cell in finest(view.frame()) {
            let expected = match view.containing(cell).and_then(|k| view.get(k)).map(|record| record.kind) {
                None if view.find(cell).is_some() => continue,
                None | Some(VoxelKind::Outside) => Tag::Empty,
                Some(VoxelKind::Inside) => Tag::Full,
                Some(_) => boundary,
            };
            assert_eq!(tree.view().tag_at(cell.at), expected, "{cell:?}");
        }
    }
    if let Ok(tree) = &found {
        tree.view().check().expect("what was built is sound");
    }
    let solid = VoxelSolid::new(*view, boundary).expect("a good tag");
    let volume = measure(&solid, view.frame(), 0.0, &CONTROL).expect("nothing is wrong with it").volume;
    assert!(0.0 <= volume.lower && volume.upper <= 64.0);
    let ball = Csg::ball([1.0, 2.5, 5.0], 1.5).expect("a good ball");
    let parts = view.solid_parts(&ball, &CONTROL).expect("enough memory");
    assert!(parts.len() == view.len() && parts.iter().all(|part| (0.0..=1.0).contains(part)), "{parts:?}");
    let corners = vec![[-1.0, 0.5, 3.0], [2.0, 1.0, 4.0], [0.3, 4.0, 6.0], [1.0, 2.5, 5.0]];
    let mesh = TriangleMesh::new(corners, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2]]).expect("a good mesh");
    let touched = view.triangles(&mesh, &CONTROL).expect("enough memory");
    for k in 0..view.len() {
        let is_boundary = view.get(k).is_some_and(|record| record.kind == VoxelKind::Boundary);
        assert!(is_boundary || touched.of(k).is_empty());
        assert!(touched.of(k).iter().all(|&triangle| triangle < 3));
    }
}
