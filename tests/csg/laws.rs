//! What holds of every expression, whatever it stands for.

use super::model::Model;
use super::random::Maker;
use super::{frames, lattice_frame};
use crate::common::{Dense, Random, alone};
use leafless::{
    AnySolid, Cell, Control, Counted, Csg, CsgPart, CsgScratch, Cube, Frame, Octree, Rule, Scratch, Solid,
    Tag, Verdict, build, complement,
};

/// Ways to descend to the finest cells, which must all find the same.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// The scratch memory is released after each cell.
    Released,
    /// It is never released.
    Kept,
    /// Two levels at once.
    Twice,
    /// Each part is handed over to the other of two scratch memories.
    HandedOver,
    /// What has been found out about a cell is asked again after everything below it.
    Again,
}

struct Descent<'a> {
    csg: &'a Csg,
    frame: &'a Frame,
    way: Way,
    out: Dense,
}

impl Descent<'_> {
    fn run(csg: &Csg, frame: &Frame, way: Way) -> Dense {
        let mut scratches = [CsgScratch::default(), CsgScratch::default()];
        let out = Dense::uniform(frame.depth(), Tag::Empty);
        let mut descent = Descent { csg, frame, way, out };
        let [here, there] = &mut scratches;
        let root = csg.root(here, frame).unwrap();
        descent.cell(here, there, Cell::ROOT, &root);
        descent.out
    }

    fn cell(
        &mut self,
        here: &mut CsgScratch,
        there: &mut CsgScratch,
        cell: Cell,
        verdict: &Verdict<CsgPart>,
    ) {
        let depth = self.frame.depth();
        let part = match verdict {
            Verdict::Partial(part) if cell.level < depth => part,
            verdict => {
                let edge = 1 << (depth - cell.level);
                for at in crate::common::positions(depth - cell.level) {
                    let place = [0, 1, 2].map(|axis| cell.at[axis] * edge + at[axis]);
                    self.out.set(place, verdict.tag());
                }
                return;
            }
        };
        let marks = [here.mark(), there.mark()];
        let cube = Cube { frame: self.frame, cell };
        if let (Way::Twice, true) = (self.way, cell.level + 2 <= depth) {
            let mut parts = Vec::new();
            let planes = self.csg.split64(here, &cube, part, &mut parts).unwrap();
            let mut parts = parts.into_iter().peekable();
            for c in 0..64 {
                let verdict = match planes.tag(c) {
                    Tag::Full => Verdict::Full,
                    Tag::Empty => Verdict::Empty,
                    _ => parts
                        .next_if(|(index, _)| *index as u32 == c)
                        .map_or(Verdict::Undecided, |(_, part)| Verdict::Partial(part)),
                };
                let grandchild = cell.child((c >> 3) as u8).child((c & 7) as u8);
                self.cell(here, there, grandchild, &verdict);
            }
            assert_eq!(parts.next().map(|(index, _)| index), None);
        } else {
            let children = self.csg.split(here, &cube, part).unwrap();
            for (k, child) in (0..).zip(&children) {
                match (self.way, child) {
                    (Way::HandedOver, Verdict::Partial(part)) => {
                        let part = self.csg.hand_over(here, part, there).unwrap();
                        self.cell(there, here, cell.child(k), &Verdict::Partial(part));
                    }
                    _ => self.cell(here, there, cell.child(k), child),
                }
            }
            if let Way::Again = self.way {
                let again = self.csg.split(here, &cube, part).unwrap();
                let tags = |children: &[Verdict<CsgPart>; 8]| children.each_ref().map(|child| child.tag());
                assert_eq!(tags(&again), tags(&children), "{cell:?}");
            }
        }
        if !matches!(self.way, Way::Kept) {
            here.release(marks[0]);
            there.release(marks[1]);
        }
    }
}

/// Random expressions, some with other solids, with a frame for each.
fn expressions(count: u64, depths: [u8; 2], height: u32, mut check: impl FnMut(&Model, &Csg, &Frame)) {
    for seed in 0..count {
        let mut random = Random(seed ^ 0x1A35);
        let depth = depths[0] + random.below((depths[1] - depths[0] + 1) as u64) as u8;
        let frame = frames(depth)[random.below(4) as usize];
        let (aligned, others) = (random.below(2) == 0, random.below(2) == 0);
        let model = Maker { random: &mut random, frame, aligned, others }.expression(height);
        if let Ok(csg) = model.csg(&frame) {
            check(&model, &csg, &frame);
        }
    }
}

fn built(solid: &impl Solid, frame: &Frame, rule: Rule) -> Octree {
    build(solid, frame, rule, &alone()).unwrap()
}

fn all_ways_find_the_same(model: &Model, csg: &Csg, frame: &Frame) {
    let truth = Dense::of(built(csg, frame, Rule::Certified).view());
    for way in [Way::Released, Way::Kept, Way::Twice, Way::HandedOver, Way::Again] {
        let found = Descent::run(csg, frame, way);
        assert!(found == truth, "{way:?}\n{frame:?}\n{model:#?}\n{found:?}\n{truth:?}");
    }
}

#[test]
fn verdicts_do_not_depend_on_the_way() {
    expressions(400, [1, 4], 3, all_ways_find_the_same);
}

/// Words that are written for a child and taken back, because a later operand decides what they belong to, must not take
/// anything with them that others need.
#[test]
fn parts_of_other_solids_live_as_long_as_their_cells() {
    for seed in 0..200 {
        let mut random = Random(seed);
        let frame = lattice_frame(5);
        let mut maker = Maker { random: &mut random, frame, aligned: seed % 2 == 0, others: true };
        let mut planes = [0; 5].map(|_| maker.plane()).to_vec();
        let last = planes.split_off(4);
        planes.insert(3, Model::Other(maker.other()));
        let model = Model::Union([vec![Model::Intersection(planes)], last].concat());
        if let Ok(csg) = model.csg(&frame) {
            all_ways_find_the_same(&model, &csg, &frame);
        }
    }
}

#[test]
fn scratch_memory_of_another_expression_is_as_good_as_new() {
    let mut used = CsgScratch::default();
    let mut evaluations = 0;
    expressions(300, [2, 4], 3, |model, csg, frame| {
        let mut fresh = CsgScratch::default();
        let tags = [&mut used, &mut fresh].map(|scratch| {
            let mut tags = Vec::new();
            let mut cell = Cell::ROOT;
            let mut verdict = csg.root(scratch, frame).unwrap();
            while let (Verdict::Partial(part), true) = (&verdict, cell.level < frame.depth()) {
                let children = csg.split(scratch, &Cube { frame, cell }, part).unwrap();
                tags.extend(children.iter().map(|child| child.tag()));
                let (k, child) =
                    (0..).zip(children).max_by_key(|(_, child)| child.tag() == Tag::Partial).unwrap();
                (cell, verdict) = (cell.child(k), child);
            }
            tags
        });
        assert_eq!(tags[0], tags[1], "{frame:?}\n{model:#?}");
        assert!(used.evaluations() >= evaluations, "the count of evaluations falls\n{model:#?}");
        evaluations = used.evaluations();
    });
}

#[test]
fn any_number_of_threads_builds_the_same() {
    expressions(40, [7, 7], 3, |model, csg, frame| {
        let alone = built(csg, frame, Rule::Certified);
        for threads in [2, 16] {
            let tree = build(csg, frame, Rule::Certified, &Control::threads(threads)).unwrap();
            assert!(tree == alone, "{threads} threads\n{frame:?}\n{model:#?}");
        }
    });
}

#[test]
fn the_complement_is_the_complement() {
    expressions(150, [1, 5], 3, |model, csg, frame| {
        let tree = built(csg, frame, Rule::Certified);
        let other = built(&csg.complement(), frame, Rule::Certified);
        let dense = [&tree, &other].map(|tree| Dense::of(tree.view()));
        assert!(dense[0].complement() == dense[1], "{frame:?}\n{model:#?}");
        if tree.view().exterior() == other.view().exterior().complement() {
            assert!(complement(tree.view(), &alone()).unwrap() == other, "{frame:?}\n{model:#?}");
        } else {
            panic!("{:?} {:?}\n{frame:?}\n{model:#?}", tree.view().exterior(), other.view().exterior());
        }
    });
}

/// Of expressions, and of points.
type Operation = (fn(Csg, Csg) -> Csg, fn(bool, bool) -> bool);

#[test]
fn booleans_are_those_of_the_trees() {
    let operations: [Operation; 4] = [
        (|a, b| Csg::union_of([a, b]).unwrap(), |a, b| a | b),
        (|a, b| Csg::intersection_of([a, b]).unwrap(), |a, b| a & b),
        (|a, b| a.difference(&b).unwrap(), |a, b| a & !b),
        (|a, b| Csg::xor_of([a, b]).unwrap(), |a, b| a ^ b),
    ];
    let mut before: Option<(Model, u8)> = None;
    expressions(200, [3, 4], 2, |model, _, frame| {
        let Some((other, depth)) = before.replace((model.clone(), frame.depth())) else { return };
        let frame = &lattice_frame(depth);
        let (Ok(a), Ok(b)) = (model.csg(frame), other.csg(frame)) else { return };
        for (join, op) in operations {
            let both = join(a.clone(), b.clone());
            for rule in [Rule::Certified, Rule::Sampled] {
                let [Ok(a), Ok(b), Ok(both)] = [&a, &b, &both].map(|csg| build(csg, frame, rule, &alone()))
                else {
                    continue;
                };
                let [a, b, both] = [a, b, both].map(|tree| Dense::of(tree.view()));
                let joined = a.combine(&b, op);
                // What the trees decide the expression decides, too; a rotated one may know more.
                let agree = joined.tags.iter().zip(&both.tags).all(|(&t, &e)| t == Tag::Partial || t == e);
                assert!(agree, "{rule:?}\n{model:#?}\n{other:#?}");
            }
        }
    });
}

#[test]
fn evaluations_behind_the_common_face_count() {
    let frame = lattice_frame(5);
    let ball = Csg::ball([16.0; 3], 10.0).unwrap();
    let counted = Counted::new(&ball);
    build(&counted, &frame, Rule::Certified, &alone()).unwrap();
    let mut nested = ball.clone();
    for _ in 0..3 {
        nested = Csg::solid(AnySolid::new(Counted::new(nested)));
        let again = Counted::new(&nested);
        build(&again, &frame, Rule::Certified, &alone()).unwrap();
        assert_eq!(again.splits(), counted.splits());
        assert!(again.evaluations() >= counted.evaluations());
    }
    // Asked again with the memory of an earlier root, the count goes on.
    let counted = Counted::new(&nested);
    let mut scratch = CsgScratch::default();
    let mut last = 0;
    for _ in 0..3 {
        let Verdict::Partial(part) = counted.root(&mut scratch, &frame).unwrap() else { panic!() };
        counted.split(&mut scratch, &Cube { frame: &frame, cell: Cell::ROOT }, &part).unwrap();
        let now = counted.evaluations();
        assert!(now > last && now < 1000, "{last}, then {now}");
        last = now;
    }
}
