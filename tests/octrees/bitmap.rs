//! The cells of a box as bits, against dense arrays and for damaged trees.

use leafless::{Cell, Control, Csg, Error, Frame, Octree, Rule, Tag, build, compact, file};
use leafless_testkit::{Aligned, Dense, Random, alone, cases, shapes};
use proptest::prelude::*;
use std::sync::atomic::AtomicBool;

/// Queries both planes into words that must be overwritten. Returns the number of words a row, and both
/// planes.
fn bitmap(
    tree: &Octree,
    level: u8,
    min: [u32; 3],
    max: [u32; 3],
    control: &Control,
) -> (usize, [Vec<u64>; 2]) {
    let size = [0, 1, 2].map(|axis| (max[axis] - min[axis]) as usize);
    let row = size[0].div_ceil(64);
    let (mut inner, mut outer) = (vec![!0; row * size[1] * size[2]], vec![0xA5; row * size[1] * size[2]]);
    tree.bitmap(level, min, max, &mut inner, Some(&mut outer), control).unwrap();
    let mut alone = vec![7; inner.len()];
    tree.view().bitmap(level, min, max, &mut alone, None, control).unwrap();
    assert_eq!(alone, inner);
    (row, [inner, outer])
}

fn check(tree: &Octree, dense: &Dense, level: u8, min: [u32; 3], max: [u32; 3], control: &Control) {
    let (row, [inner, outer]) = bitmap(tree, level, min, max, control);
    let mut bits = [0, 0];
    for z in min[2]..max[2] {
        for y in min[1]..max[1] {
            for x in min[0]..max[0] {
                let line = (z - min[2]) * (max[1] - min[1]) + y - min[1];
                let word = line as usize * row + (x - min[0]) as usize / 64;
                let bit = |plane: &[u64]| plane[word] >> ((x - min[0]) % 64) & 1 != 0;
                let tag = dense.tag_of(Cell { level, at: [x, y, z] });
                assert_eq!(bit(&inner), tag == Some(Tag::Full), "{:?} of level {level}", [x, y, z]);
                assert_eq!(bit(&outer), tag != Some(Tag::Empty), "{:?} of level {level}", [x, y, z]);
                bits[0] += u32::from(bit(&inner));
                bits[1] += u32::from(bit(&outer));
            }
        }
    }
    // Bits beyond the rows are zero.
    let count = |plane: &[u64]| plane.iter().map(|word| word.count_ones()).sum::<u32>();
    assert_eq!([count(&inner), count(&outer)], bits);
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn boxes_of_all_levels(shape in shapes(1..=5), seed in any::<u64>()) {
        let dense = shape.dense();
        let tree = dense.octree();
        let mut random = Random(seed);
        let small = compact(tree.view()).unwrap();
        for level in 0..=dense.depth {
            check(&tree, &dense, level, [0; 3], [1 << level; 3], &alone());
            let ends = [0; 3].map(|_| {
                let [a, b] = [0; 2].map(|_| random.below((1 << level) + 1) as u32);
                [a.min(b), a.max(b)]
            });
            check(&small, &dense, level, ends.map(|end| end[0]), ends.map(|end| end[1]), &alone());
        }
    }
}

#[test]
fn rows_of_several_words() {
    let frame = Frame::new([-1.0; 3], 2.0, 8).unwrap();
    let ball = Csg::ball([0.1, -0.05, 0.03], 0.77).unwrap();
    let mut random = Random(5);
    for rule in [Rule::Certified, Rule::Sampled] {
        let tree = build(&ball, &frame, rule, &alone()).unwrap();
        let (row, whole) = bitmap(&tree, 8, [0; 3], [256; 3], &Control::default());
        assert_eq!(whole, bitmap(&tree, 8, [0; 3], [256; 3], &alone()).1);
        assert_eq!((row, whole[0] == whole[1]), (4, rule == Rule::Sampled));
        for _ in 0..20_000 {
            let [x, y, z] = [0; 3].map(|_| random.below(256) as u32);
            let bit = |plane: &[u64]| plane[((z * 256 + y) * 4 + x / 64) as usize] >> (x % 64) & 1 != 0;
            let tag = tree.view().tag_at([x, y, z]);
            assert_eq!([bit(&whole[0]), bit(&whole[1])], [tag == Tag::Full, tag != Tag::Empty]);
        }
        // Boxes that begin and end anywhere have the bits of the whole.
        for _ in 0..20 {
            let min = [0; 3].map(|_| random.below(200) as u32);
            let max = min.map(|a| a + 1 + random.below(u64::from(255 - a)) as u32);
            let (words, part) = bitmap(&tree, 8, min, max, &Control::default());
            for _ in 0..2000 {
                let at = [0, 1, 2].map(|axis| random.below(u64::from(max[axis] - min[axis])) as u32);
                let [x, y, z] = [0, 1, 2].map(|axis| min[axis] + at[axis]);
                let line = (at[2] * (max[1] - min[1]) + at[1]) as usize * words;
                for plane in 0..2 {
                    let bit = part[plane][line + at[0] as usize / 64] >> (at[0] % 64) & 1;
                    assert_eq!(bit, whole[plane][((z * 256 + y) * 4 + x / 64) as usize] >> (x % 64) & 1);
                }
            }
        }
    }
}

#[test]
fn what_is_refused() {
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    let tree = build(&Csg::ball([4.0; 3], 3.0).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let name = |level, min: [u32; 3], max: [u32; 3], inner: usize, outer: usize| {
        let (mut inner, mut outer) = (vec![0; inner], vec![0; outer]);
        match tree.bitmap(level, min, max, &mut inner, Some(&mut outer), &alone()) {
            Err(Error::Argument { name, .. }) => name,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(name(4, [0; 3], [8; 3], 64, 64), "level");
    assert_eq!(name(3, [0; 3], [8, 9, 8], 64, 64), "max");
    assert_eq!(name(2, [0; 3], [4, 4, 5], 20, 20), "max");
    assert_eq!(name(3, [0, 3, 0], [8, 2, 8], 64, 64), "max");
    assert_eq!(name(3, [0; 3], [8; 3], 63, 64), "inner");
    assert_eq!(name(3, [0; 3], [8; 3], 64, 65), "outer");
    tree.bitmap(3, [3; 3], [3, 8, 8], &mut [], None, &alone()).unwrap();
    let cancel = AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..Control::default() };
    let result = tree.bitmap(3, [0; 3], [8; 3], &mut [0; 64], None, &control);
    assert!(matches!(result, Err(Error::Cancelled)));
}

/// Damaged files with arbitrary bytes below the section table.
#[test]
fn damaged_trees() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let ball = Csg::ball([0.1, -0.05, 0.03], 0.77).unwrap();
    let good = file::to_bytes(&build(&ball, &frame, Rule::Certified, &alone()).unwrap()).unwrap();
    let mut random = Random(9);
    let mut viewed = 0;
    for _ in 0..60 {
        let mut bytes = good.clone();
        for _ in 0..good.len() / 20 {
            let at = 1024 + random.below(good.len() as u64 - 1024) as usize;
            bytes[at] = random.bits() as u8;
        }
        let bytes = Aligned::new(&bytes);
        let Ok(tree) = file::view(bytes.bytes()) else { continue };
        viewed += 1;
        let planes = [1, 2].map(|threads| {
            let (mut inner, mut outer) = (vec![0; 2 * 128 * 128], vec![0; 2 * 128 * 128]);
            let control = Control::threads(threads);
            tree.bitmap(7, [0; 3], [128; 3], &mut inner, Some(&mut outer), &control).unwrap();
            assert!(inner.iter().zip(&outer).all(|(inner, outer)| inner & !outer == 0));
            [inner, outer]
        });
        assert!(planes[0] == planes[1]);
    }
    assert!(viewed > 30, "{viewed}");
}
