//! The set algebra of unverified trees: no panic, bounded work and results. For verified operands, the
//! results are right.

use super::{CONTROL, halves, queries};
use crate::Aligned;
use leafless::op::{intersection_of, join, resolve, shard, union_of, xor_of};
use leafless::solid::ShardedOctree;
use leafless::{
    Cell, Control, Error, Membership, Octree, OctreeRef, Rule, Shard, Solid, Tag, build, compact, complement,
    difference, file, intersection, union, xor,
};

/// Combines the trees in the two halves of `data`.
pub fn set_algebra(data: &[u8]) {
    let Some((first, second)) = halves(data) else { return };
    let (first, second) = (Aligned::new(first), Aligned::new(second));
    let Ok(a) = file::view(first.bytes()) else { return };
    let sure = file::verify(first.bytes()).is_ok();
    in_shards(&a, sure);
    // The laws hold for the cells.
    let plain = a.without_cuts();
    alone(&plain, sure);
    match file::view(second.bytes()) {
        Ok(b) => {
            // Trees of different solids are refused without harm.
            match join(&[a, b], &BUDGET) {
                Err(Error::Argument { name: "trees", .. } | Error::FrameMismatch { .. }) => {}
                result => drop(sharp(result, false)),
            }
            let sure = sure && file::verify(second.bytes()).is_ok();
            with_surfaces(&a, &b, sure);
            together(&plain, &b.without_cuts(), sure);
        }
        Err(_) => {
            with_surfaces(&a, &a, sure);
            together(&plain, &plain, sure);
        }
    }
}

/// Limits memory, because surfaces may cross more cells than any memory holds.
const BUDGET: Control<'static> = Control { max_bytes: Some(1 << 19), ..CONTROL };

/// Checks a result where an operand keeps surfaces; returns `None` for an error.
fn sharp(result: Result<Octree, Error>, sure: bool) -> Option<Octree> {
    match result {
        Ok(tree) => {
            assert!(!sure || tree.view().check().is_ok());
            let _ = (tree.statistics(), tree.view().check(), file::to_bytes(&tree));
            Some(tree)
        }
        Err(Error::Damaged(_)) if !sure => None,
        // The limit of the budget, or of exact numbers.
        Err(Error::Limit { .. }) => None,
        Err(refused) => panic!("{refused}"),
    }
}

/// Checks that a tree in shards, joined, is the tree.
fn in_shards(a: &OctreeRef<'_>, sure: bool) {
    let Some((top, shards, joined)) = cut_and_joined(a, sure) else { return };
    if sure && a.cuts().is_none() {
        assert!(join(&[*a], &BUDGET).is_ok_and(|same| same == joined));
    } else if sure && let Some((.., again)) = cut_and_joined(joined.view(), sure) {
        // (A file may contain functions that are longer than necessary. After one join nothing changes any
        // more.)
        assert!(again == joined);
    }
    let is_split =
        |(cell, own): &(Cell, Octree)| own.statistics().levels()[usize::from(cell.level)].nodes == 1;
    if sure && shards.iter().all(is_split) {
        let all: Vec<_> = shards.iter().map(|(cell, own)| (*cell, own.statistics())).collect();
        assert!(top.statistics_with(&all).is_ok_and(|found| found == joined.statistics()));
    }
    // (Surfaces would be split down to the depth.)
    if a.cuts().is_none()
        && let Ok(solid) = ShardedOctree::new(top, shards)
    {
        let built = build(&solid, a.frame(), Rule::Certified, &BUDGET);
        assert!(!sure || built.is_err() || built.is_ok_and(|built| built == joined));
    }
}

/// The top, the shards of its open cells, and the tree that they form together.
type CutAndJoined = (Octree, Vec<(Cell, Octree)>, Octree);

fn cut_and_joined(a: &OctreeRef<'_>, sure: bool) -> Option<CutAndJoined> {
    let level = a.frame().depth().min(1);
    let top = sharp(shard(a, Shard::Top { level }, &BUDGET), sure)?;
    let mut shards = Vec::new();
    for cell in top.view().open_cells(level).ok()? {
        shards.push((cell, sharp(shard(a, Shard::Below(cell), &BUDGET), sure)?));
    }
    let all = [&top].into_iter().chain(shards.iter().map(|(_, own)| own));
    let views: Vec<_> = all.map(|own| *own.view()).collect();
    let joined = sharp(join(&views, &BUDGET), sure)?;
    Some((top, shards, joined))
}

/// Checks operations on trees of which at least one keeps surfaces.
fn with_surfaces(a: &OctreeRef<'_>, b: &OctreeRef<'_>, sure: bool) {
    if a.cuts().is_none() && b.cuts().is_none() {
        return;
    }
    for tree in [a, b] {
        let refused = resolve(tree, Rule::Outer, &CONTROL);
        assert!(tree.cuts().is_none() || matches!(refused, Err(Error::Argument { .. })));
    }
    let not = |tree: &Octree| sharp(complement(tree.view(), &BUDGET), sure);
    let inverse = sharp(complement(a, &BUDGET), sure);
    let same = sharp(union(a, a, &BUDGET), sure);
    if let (true, Some(inverse), Some(same)) = (sure, inverse, same) {
        // (A file may contain functions that are longer than necessary, in more cells than necessary. Results
        // do not.)
        let back = not(&inverse);
        let twice = back.as_ref().and_then(|back| not(&not(back)?));
        assert!(twice.is_none() || twice == back);
        let again = sharp(intersection(same.view(), same.view(), &BUDGET), sure);
        assert!(again.is_none_or(|again| again == same));
    }
    // A copy keeps them.
    if let (true, Ok(same)) = (sure, compact(a)) {
        assert!(same.view().cuts() == a.cuts() && same.view().check().is_ok());
    }
    if a.frame() != b.frame() {
        assert!(matches!(union(a, b, &CONTROL), Err(Error::FrameMismatch { .. })));
        return;
    }
    let trees = [*a, *b, *a];
    for operation in [union_of, intersection_of, xor_of] {
        sharp(operation(&trees, &BUDGET), sure);
    }
    what_is_certain_stays_so(a, b, sure);
}

/// Checks that results are decided where the operands' cells are, and agree with the operands' cells and
/// surfaces.
fn what_is_certain_stays_so(a: &OctreeRef<'_>, b: &OctreeRef<'_>, sure: bool) {
    let seed = [a.element_count(), b.brick_count()].map(u64::to_le_bytes).concat().repeat(27);
    let points = queries::points(a.frame(), &seed);
    let known = |tree: &OctreeRef<'_>, point| match tree.contains(point) {
        Membership::Inside => Some(true),
        Membership::Outside => Some(false),
        Membership::Undecided => None,
    };
    for (operation, logic) in OPERATIONS {
        let Some(result) = sharp(operation(a, b, &BUDGET), sure).filter(|_| sure) else { continue };
        for &point in &points {
            let (found, expected) = (known(result.view(), point), logic(known(a, point), known(b, point)));
            let agrees = found.is_none() || expected.is_none() || found == expected;
            assert!(agrees, "{point:?}: {found:?}, {expected:?}");
        }
        for at in cells(a) {
            let expected = logic(decided(a.tag_at(at)), decided(b.tag_at(at)));
            let found = decided(result.view().tag_at(at));
            // (Decided cells may be parts of a cell that has a function.)
            let agrees = found.is_none() || expected.is_none() || found == expected;
            assert!(agrees, "{at:?}: {found:?}, {expected:?}");
        }
    }
}

/// Checks that several threads give the same result. It is not for the fuzzer: threads that are still ending
/// look like a leak.
pub fn threads(bytes: &[u8]) {
    let aligned = Aligned::new(bytes);
    let Ok(tree) = file::view(aligned.bytes()) else { return };
    let several = Control { threads: 3, ..CONTROL };
    let solid = tree.without_cuts();
    let built = [CONTROL, several].map(|control| build(&solid, tree.frame(), Rule::Certified, &control));
    match built {
        [Ok(one), Ok(several)] => assert!(one == several),
        [Err(one), Err(several)] => assert_eq!(one.to_string(), several.to_string()),
        [one, several] => panic!("{one:?} and {several:?}"),
    }
}

/// Returns the number of elements and bricks.
fn size(tree: &OctreeRef<'_>) -> u64 {
    tree.element_count() + tree.brick_count()
}

/// Kleene's logic.
type Logic = fn(Option<bool>, Option<bool>) -> Option<bool>;

fn and(a: Option<bool>, b: Option<bool>) -> Option<bool> {
    match (a, b) {
        (Some(false), _) | (_, Some(false)) => Some(false),
        (Some(true), Some(true)) => Some(true),
        _ => None,
    }
}

fn not(a: Option<bool>) -> Option<bool> {
    a.map(|a| !a)
}

fn decided(tag: Tag) -> Option<bool> {
    match tag {
        Tag::Empty => Some(false),
        Tag::Full => Some(true),
        Tag::Partial | Tag::Branch => None,
    }
}

type Binary = fn(&OctreeRef<'_>, &OctreeRef<'_>, &Control<'_>) -> Result<Octree, Error>;

/// The operations on two trees, each with its logic.
const OPERATIONS: [(Binary, Logic); 4] = [
    (union, |a, b| not(and(not(a), not(b)))),
    (intersection, and),
    (difference, |a, b| and(a, not(b))),
    (xor, |a, b| a.zip(b).map(|(a, b)| a ^ b)),
];

/// Checks a result. `most` is the allowed number of elements and bricks.
fn sound(result: Result<Octree, Error>, most: u64, sure: bool) -> Option<Octree> {
    let tree = match result {
        Ok(tree) => tree,
        Err(Error::Damaged(_)) if !sure => return None,
        Err(refused) => panic!("{refused}"),
    };
    assert!(size(tree.view()) <= most, "{} of {most}", size(tree.view()));
    if sure {
        tree.view().check().expect("of good operands comes a good result");
    }
    // Its links are its own, whatever the operands' links are.
    let links = tree.view().on(tree.frame(), &CONTROL);
    assert!(!matches!(links, Err(Error::Damaged(_))));
    let _ = (tree.statistics(), tree.view().check());
    Some(tree)
}

/// Runs all operations on one tree.
fn alone(a: &OctreeRef<'_>, sure: bool) {
    let n = size(a);
    let inverse = sound(complement(a, &CONTROL), n, sure);
    // A copy has the links of the original, good or bad.
    let same = compact(a).inspect(|same| assert_eq!(size(same.view()), n)).ok();
    let copy = sound(resolve(a, Rule::Certified, &CONTROL), n, sure);
    let inner = sound(resolve(a, Rule::Inner, &CONTROL), n, sure);
    let outer = sound(resolve(a, Rule::Outer, &CONTROL), n, sure);
    let sampled = resolve(a, Rule::Sampled, &CONTROL);
    let frame = a.frame();
    for depth in [frame.depth().saturating_sub(1).max(1), (frame.depth() + 1).min(20)] {
        let other = frame.with_depth(depth).expect("a legal depth");
        // With the other parity of depth, an element is spread over up to nine.
        sound(build(&a, &other, Rule::Certified, &CONTROL), 9 * n + 9, sure);
    }
    if !sure {
        return;
    }
    let back = inverse.as_ref().map(|inverse| complement(inverse.view(), &CONTROL));
    let back = back.expect("a good tree has a complement").expect("and that one, too");
    let [same, copy] = [same, copy].map(|tree| tree.expect("a good tree can be copied"));
    assert!(back == same && copy == same);
    assert_eq!(sampled.is_ok(), a.is_binary());
    let [inner, outer] = [inner, outer].map(|tree| tree.expect("a good tree can be resolved"));
    assert!(inner.view().is_binary() && outer.view().is_binary());
    for at in cells(a) {
        let [tag, least, most] = [a, inner.view(), outer.view()].map(|tree| tree.tag_at(at));
        match tag {
            Tag::Partial => assert_eq!((least, most), (Tag::Empty, Tag::Full)),
            tag => assert_eq!((least, most), (tag, tag)),
        }
    }
}

/// Returns some finest cells.
fn cells(tree: &OctreeRef<'_>) -> Vec<[u32; 3]> {
    let frame = tree.frame();
    let seed = [tree.element_count(), tree.brick_count()].map(u64::to_le_bytes).concat().repeat(27);
    let points = queries::points(frame, &seed);
    points.into_iter().filter_map(|point| frame.cell_of(point)).chain([[0; 3]]).collect()
}

/// Runs all operations on two trees.
fn together(a: &OctreeRef<'_>, b: &OctreeRef<'_>, sure: bool) {
    if a.frame() != b.frame() {
        assert!(matches!(union(a, b, &CONTROL), Err(Error::FrameMismatch { .. })));
        return;
    }
    let most = size(a) + size(b);
    for (operation, logic) in OPERATIONS {
        let result = sound(operation(a, b, &CONTROL), most, sure);
        let turned = sound(operation(b, a, &CONTROL), most, sure);
        let alike = sound(operation(a, a, &CONTROL), 2 * size(a), false);
        // Results of damaged operands are operands like any other.
        if let (Some(result), Some(turned)) = (&result, &turned) {
            let most = size(result.view()) + size(turned.view());
            sound(operation(result.view(), turned.view(), &CONTROL), most, sure);
        }
        let _ = alike.map(|tree| file::to_bytes(&tree));
        let Some(result) = result.filter(|_| sure) else { continue };
        for at in cells(a) {
            let expected = logic(decided(a.tag_at(at)), decided(b.tag_at(at)));
            assert_eq!(decided(result.view().tag_at(at)), expected, "{at:?}");
        }
    }
    let trees = [*a, *b, *a];
    for operation in [union_of, intersection_of, xor_of] {
        sound(operation(&trees, &CONTROL), most + size(a), sure);
    }
}
