//! One table of all ways in which the library makes a solid of another: the proof of the result for each
//! proof of the input.
//!
//! The input is an octree of a ball, built by each of the four rules. Each way states which bits of [`Proof`]
//! its result has, and the truth that these bits describe. The bits are compared with the table. Where FULL
//! or EMPTY is claimed, the cells are compared with the truth, point by point and exactly. So a wrong bit is
//! found as a lie, and not only as a difference from the table.
//!
//! The table is complete. The test searches the sources for all solid types and all public functions that
//! return one. Each must be covered by a row, or stand in a list of functions that make solids of numbers.

#![cfg(feature = "std")]

use leafless::attribute::{
    CarryRule, ConstantAttribute, FillOptions, ScalarType, ValueRegion, ValueType, carry_channels,
    fill_channel,
};
use leafless::layout::Item;
use leafless::op::{
    DexelOptions, Zone, build_extended_shard, difference_of, intersection_of, join, octree_from_dexel_ends,
    octree_from_dexels, resolve, shard, union_of, xor_of,
};
use leafless::solid::{
    Adaptive, Band, DynSolid, Prepared, Samples, ShardedOctree, SplitCounter, Transform, VoxelGrid,
};
use leafless::surface::DexelSolid;
use leafless::voxel::{Symmetry, VoxelBoundary, VoxelOptions, VoxelRecords, VoxelRecordsRef, VoxelSolid};
use leafless::{
    Affine, AnySolid, Bounds, Callback, Cell, Control, Csg, Error, FillRule, Frame, LazyOctree, MeshSolid,
    Metadata, Octree, Proof, Rule, Shard, Solid, SurfaceOptions, Tag, Verdict, Volume, build, build_extended,
    build_shard, compact, complement, dexelize, difference, file, intersection, marching_cubes, union, xor,
};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

const CONTROL: Control<'static> =
    Control { threads: 1, max_nodes: None, max_bytes: None, max_splits: None, cancel: None, progress: None };

/// The rules of the inputs, in the order of the table's columns.
const RULES: [Rule; 4] = [Rule::Certified, Rule::Inner, Rule::Outer, Rule::Sampled];

const DEPTH: u8 = 4;

/// A frame whose finest cells have the edge 1.
fn frame(depth: u8) -> Frame {
    Frame::new([0.0; 3], 16.0, depth).unwrap()
}

/// The ball from which everything is made, and another ball. Sums of squares of such numbers are exact.
const BALL: ([f64; 3], f64) = ([7.25, 8.0, 6.5], 5.25);
const OTHER: ([f64; 3], f64) = ([9.5, 7.25, 8.25], 4.5);

fn is_in((centre, radius): ([f64; 3], f64), point: [f64; 3]) -> Option<bool> {
    let square = (0..3).map(|axis| (point[axis] - centre[axis]).powi(2)).sum::<f64>();
    (square != radius * radius).then_some(square < radius * radius)
}

fn ball(point: [f64; 3]) -> Option<bool> {
    is_in(BALL, point)
}

/// The truth that a result claims: whether a point is inside; `None` on a surface, where both answers are
/// allowed.
type Truth = Box<dyn Fn([f64; 3]) -> Option<bool>>;

/// The result of a way, and its truth.
struct Made {
    tree: Octree,
    truth: Truth,
}

type Outcome = Result<Made, Error>;

/// Pairs a tree with the truth of the ball.
fn of_ball(tree: Octree) -> Outcome {
    Ok(Made { tree, truth: Box::new(ball) })
}

/// Builds the octree of a solid of the ball.
fn asked(solid: &impl Solid) -> Outcome {
    of_ball(whole(solid)?)
}

fn whole(solid: &impl Solid) -> Result<Octree, Error> {
    build(solid, &frame(DEPTH), Rule::Certified, &CONTROL)
}

fn of(tree: Octree, truth: impl Fn([f64; 3]) -> Option<bool> + 'static) -> Outcome {
    Ok(Made { tree, truth: Box::new(truth) })
}

/// Pairs a tree with no truth: the tree's cells are the definition of the solid.
fn of_itself(tree: Octree) -> Outcome {
    of(tree, |_| None)
}

/// The ball and the other ball, built by the input's rule.
struct Given {
    rule: Rule,
    tree: Octree,
    other: Octree,
}

impl Given {
    fn new(rule: Rule) -> Given {
        let of = |(centre, radius)| {
            build(&Csg::ball(centre, radius).unwrap(), &frame(DEPTH), rule, &CONTROL).unwrap()
        };
        Given { rule, tree: of(BALL), other: of(OTHER) }
    }

    fn csg(&self) -> Csg {
        Csg::solid(AnySolid::new(self.tree.clone()))
    }

    fn other_csg(&self) -> Csg {
        Csg::solid(AnySolid::new(self.other.clone()))
    }

    /// Builds both balls with their surfaces. The octrees claim the proofs of the inputs.
    fn extended(&self) -> Result<[Octree; 2], Error> {
        let of = |(centre, radius), proof| {
            let ball = Csg::ball(centre, radius)?;
            let tree = build_extended(&ball, &frame(DEPTH), &SurfaceOptions::default(), &CONTROL)?;
            assert!(tree.view().cuts().is_some());
            Ok::<_, Error>(tree.with_proof(proof))
        };
        Ok([of(BALL, self.tree.proof())?, of(OTHER, self.other.proof())?])
    }

    fn records(&self, options: &VoxelOptions) -> VoxelRecords {
        VoxelRecords::of(self.tree.view(), options, None, &CONTROL).unwrap()
    }

    /// Returns the octree with a channel that has a value wherever the octree is not EMPTY.
    fn with_channel(&self) -> Octree {
        let options = FillOptions {
            value_type: ValueType::new(ScalarType::U8, 1).unwrap(),
            frame: frame(DEPTH),
            solid: Some(self.tree.view()),
            detail: None,
        };
        let channel = fill_channel(&ConstantAttribute::new(&[3.0]).unwrap(), &options, &CONTROL).unwrap();
        self.tree.with_channel(channel.with_name("value")).unwrap()
    }
}

fn both(a: Option<bool>, b: Option<bool>, join: fn(bool, bool) -> bool) -> Option<bool> {
    Some(join(a?, b?))
}

fn and(p: [f64; 3]) -> Option<bool> {
    both(ball(p), is_in(OTHER, p), |a, b| a && b)
}

fn or(p: [f64; 3]) -> Option<bool> {
    both(ball(p), is_in(OTHER, p), |a, b| a || b)
}

fn without(p: [f64; 3]) -> Option<bool> {
    both(ball(p), is_in(OTHER, p), |a, b| a && !b)
}

fn odd(p: [f64; 3]) -> Option<bool> {
    both(ball(p), is_in(OTHER, p), |a, b| a ^ b)
}

fn not(p: [f64; 3]) -> Option<bool> {
    ball(p).map(|inside| !inside)
}

/// A map that takes cells to shapes that are not cells, and the ball's image.
fn placement() -> Affine {
    Affine::new([[0.75, 0.0, 0.0, 1.25], [0.0, 0.75, 0.0, 2.5], [0.0, 0.0, 0.75, 1.0]]).unwrap()
}

fn moved(p: [f64; 3]) -> Option<bool> {
    // All of these are multiples of 1/16.
    let ([x, y, z], radius) = BALL;
    is_in(([0.75 * x + 1.25, 0.75 * y + 2.5, 0.75 * z + 1.0], 0.75 * radius), p)
}

/// One way, and the proof of its result.
struct Way {
    name: &'static str,
    /// The solid types and public functions that the way uses, each with its folder and file.
    through: &'static [&'static str],
    make: fn(&Given) -> Outcome,
    /// The proofs of FULL and EMPTY for each rule of [`RULES`]: `1` if proven; `--` where the way refuses the
    /// rule.
    proven: [&'static str; 4],
}

/// The input's proof stays.
const SAME: [&str; 4] = ["11", "10", "01", "00"];
const SWAPPED: [&str; 4] = ["11", "01", "10", "00"];
const NOTHING: [&str; 4] = ["00", "00", "00", "00"];
/// Proven only if both sides are proven.
const IF_BOTH: [&str; 4] = ["11", "00", "00", "00"];
/// A solid of its own: its cells define it, whatever it was made of.
const ITSELF: [&str; 4] = ["11", "11", "11", "11"];

const WAYS: &[Way] = &[
    // ---- octrees
    Way { name: "itself", through: &["Octree"], make: |a| of_ball(a.tree.clone()), proven: SAME },
    Way {
        name: "built",
        through: &["Octree", "op/build.rs build"],
        make: |a| of_ball(build(&a.tree, &frame(DEPTH), Rule::Certified, &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "built inner",
        through: &["op/build.rs build"],
        make: |a| of_ball(build(&a.tree, &frame(DEPTH), Rule::Inner, &CONTROL)?),
        proven: ["10", "10", "00", "00"],
    },
    Way {
        name: "built outer",
        through: &["op/build.rs build"],
        make: |a| of_ball(build(&a.tree, &frame(DEPTH), Rule::Outer, &CONTROL)?),
        proven: ["01", "00", "01", "00"],
    },
    Way {
        name: "built sampled",
        through: &["op/build.rs build"],
        make: |a| of_ball(build(&a.tree, &frame(DEPTH), Rule::Sampled, &CONTROL)?),
        proven: ["--", "00", "00", "00"],
    },
    Way {
        name: "resolved inner",
        through: &["op/build.rs resolve"],
        make: |a| of_ball(resolve(a.tree.view(), Rule::Inner, &CONTROL)?),
        proven: ["10", "10", "00", "00"],
    },
    Way {
        name: "resolved outer",
        through: &["op/build.rs resolve"],
        make: |a| of_ball(resolve(a.tree.view(), Rule::Outer, &CONTROL)?),
        proven: ["01", "00", "01", "00"],
    },
    Way {
        name: "compact",
        through: &["op/build.rs compact"],
        make: |a| of_ball(compact(a.tree.view())?),
        proven: SAME,
    },
    Way {
        name: "built deeper",
        through: &["OctreeRef", "op/build.rs build"],
        make: |a| of_ball(build(a.tree.view(), &frame(DEPTH + 1), Rule::Certified, &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "built less deep",
        through: &["OctreeRef", "op/build.rs build"],
        make: |a| of_ball(build(a.tree.view(), &frame(DEPTH - 1), Rule::Certified, &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "with what it proves",
        through: &["octree/octree.rs with_proof", "octree/view.rs with_proof", "octree/octree.rs view"],
        make: |a| asked(&a.tree.with_proof(a.tree.proof()).view().with_proof(a.tree.proof())),
        proven: SAME,
    },
    Way {
        name: "all FULL",
        through: &["octree/octree.rs uniform"],
        make: |_| of(Octree::uniform(frame(DEPTH), Tag::Full, Tag::Full)?, |_| Some(true)),
        proven: ITSELF,
    },
    Way {
        name: "with metadata",
        through: &["octree/octree.rs with_metadata", "octree/octree.rs with_metadata_from"],
        make: |a| of_ball(a.tree.with_metadata(Metadata::default()).with_metadata_from(&a.tree)),
        proven: SAME,
    },
    // ---- channels
    Way {
        name: "with a channel and without",
        through: &[
            "octree/octree.rs with_channel",
            "octree/octree.rs with_channels_from",
            "octree/octree.rs without_channel",
            "octree/octree.rs without_channels",
        ],
        make: |a| {
            let bare = a.with_channel().without_channel("value")?;
            of_ball(bare.with_channels_from(&a.with_channel()).without_channels())
        },
        proven: SAME,
    },
    Way {
        name: "with carried channels",
        through: &["attribute/carry.rs carry_channels"],
        make: |a| of_ball(carry_channels(&a.tree, &[&a.with_channel()], |_| CarryRule::Left, &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "where a channel has values",
        through: &["ValueRegion", "attribute/value_region.rs new"],
        make: |a| {
            let tree = a.with_channel();
            let channel = tree.channel("value").unwrap().view()?;
            asked(&ValueRegion::new(tree.view(), channel, [3.0; 4], [3.0; 4])?)
        },
        proven: SAME,
    },
    Way {
        // The cells of the channel's values, whatever filled them.
        name: "the cells of a channel's values",
        through: &["attribute/value_region.rs region"],
        make: |a| {
            let tree = a.with_channel();
            let (channel, own) = (tree.channel("value").unwrap().clone(), tree.clone());
            let found = own.channel("value").unwrap().view()?.region([3.0; 4], [3.0; 4], &CONTROL)?;
            of(found, move |p| Some(channel.view().unwrap().value_at(p).is_some()))
        },
        proven: ITSELF,
    },
    // ---- set algebra
    Way {
        name: "union",
        through: &["op/boolean.rs union"],
        make: |a| of(union(a.tree.view(), a.other.view(), &CONTROL)?, or),
        proven: SAME,
    },
    Way {
        name: "intersection",
        through: &["op/boolean.rs intersection"],
        make: |a| of(intersection(a.tree.view(), a.other.view(), &CONTROL)?, and),
        proven: SAME,
    },
    Way {
        name: "difference",
        through: &["op/boolean.rs difference"],
        make: |a| of(difference(a.tree.view(), a.other.view(), &CONTROL)?, without),
        proven: IF_BOTH,
    },
    Way {
        name: "difference from what is certified",
        through: &["op/boolean.rs difference"],
        make: |a| of(difference(Given::new(Rule::Certified).tree.view(), a.other.view(), &CONTROL)?, without),
        proven: SWAPPED,
    },
    Way {
        name: "symmetric difference",
        through: &["op/boolean.rs xor"],
        make: |a| of(xor(a.tree.view(), a.other.view(), &CONTROL)?, odd),
        proven: IF_BOTH,
    },
    Way {
        name: "complement",
        through: &["op/boolean.rs complement"],
        make: |a| of(complement(a.tree.view(), &CONTROL)?, not),
        proven: SWAPPED,
    },
    Way {
        name: "union of three",
        through: &["op/boolean.rs union_of"],
        make: |a| {
            let (tree, other) = (*a.tree.view(), *a.other.view());
            of(union_of(&[tree, other, tree], &CONTROL)?, or)
        },
        proven: SAME,
    },
    Way {
        name: "intersection of three",
        through: &["op/boolean.rs intersection_of"],
        make: |a| {
            let (tree, other) = (*a.tree.view(), *a.other.view());
            of(intersection_of(&[tree, other, tree], &CONTROL)?, and)
        },
        proven: SAME,
    },
    Way {
        name: "symmetric difference of three",
        through: &["op/boolean.rs xor_of"],
        make: |a| {
            let (tree, other) = (*a.tree.view(), *a.other.view());
            of(xor_of(&[tree, other, other], &CONTROL)?, |p| is_in(OTHER, p).and(ball(p)))
        },
        proven: IF_BOTH,
    },
    Way {
        name: "union of one",
        through: &["op/boolean.rs union_of"],
        make: |a| of_ball(union_of(&[*a.tree.view()], &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "difference of many",
        through: &["op/boolean.rs difference_of"],
        make: |a| {
            let (tree, other) = (*a.tree.view(), *a.other.view());
            of(difference_of(&[tree, other, other], &CONTROL)?, without)
        },
        proven: IF_BOTH,
    },
    Way {
        name: "difference of one",
        through: &["op/boolean.rs difference_of"],
        make: |a| of_ball(difference_of(&[*a.tree.view()], &CONTROL)?),
        proven: SAME,
    },
    // ---- shards
    Way {
        name: "shards, joined",
        through: &["op/build.rs build_shard", "op/shards.rs shard", "op/shards.rs join"],
        make: |a| {
            let top = shard(a.tree.view(), Shard::Top { level: 1 }, &CONTROL)?;
            let mut trees = vec![top];
            for cell in trees[0].view().open_cells(1)? {
                let below = Shard::Below(cell);
                trees.push(build_shard(&a.tree, &frame(DEPTH), Rule::Certified, below, &CONTROL)?);
            }
            let views: Vec<_> = trees.iter().map(|tree| *tree.view()).collect();
            let joined = join(&views, &CONTROL)?;
            assert_eq!(file::to_bytes(&joined)?, file::to_bytes(&a.tree)?);
            of_ball(joined)
        },
        proven: SAME,
    },
    Way {
        name: "shards that are not joined",
        through: &[
            "ShardedOctree",
            "solid/stored/sharded.rs new",
            "solid/stored/sharded.rs top",
            "solid/stored/sharded.rs shards",
            "op/shards.rs shard",
        ],
        make: |a| {
            let top = shard(a.tree.view(), Shard::Top { level: 2 }, &CONTROL)?;
            let cells = top.view().open_cells(2)?;
            let one = |cell| Ok((cell, shard(a.tree.view(), Shard::Below(cell), &CONTROL)?));
            let shards = cells.into_iter().map(one).collect::<Result<Vec<_>, Error>>()?;
            let whole = ShardedOctree::new(top, shards)?;
            let again = whole.shards().map(|(cell, shard)| (cell, shard.clone()));
            asked(&ShardedOctree::new(whole.top().clone(), again)?)
        },
        proven: SAME,
    },
    Way {
        name: "one shard, extended",
        through: &["op/extended/build.rs build_extended_shard", "op/shards.rs join"],
        make: |a| {
            let below = Shard::Below(Cell { level: 1, at: [0; 3] });
            let options = SurfaceOptions::default();
            let one = build_extended_shard(&a.csg(), &frame(DEPTH), &options, below, &CONTROL)?;
            of_ball(join(&[*one.view()], &CONTROL)?)
        },
        proven: SAME,
    },
    // ---- expressions
    Way {
        name: "in an expression",
        through: &["Csg", "AnySolid", "solid/csg/mod.rs solid", "solid/any.rs new"],
        make: |a| asked(&a.csg()),
        proven: SAME,
    },
    Way {
        name: "extended",
        through: &["Octree", "op/extended/build.rs build_extended"],
        make: |a| of_ball(build_extended(&a.tree, &frame(DEPTH), &SurfaceOptions::default(), &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "extended expression",
        through: &["solid/csg/mod.rs union_of", "op/extended/build.rs build_extended"],
        make: |a| {
            let csg = Csg::union_of([a.csg(), a.other_csg()])?;
            of(build_extended(&csg, &frame(DEPTH), &SurfaceOptions { tolerance: Some(0.01) }, &CONTROL)?, or)
        },
        proven: SAME,
    },
    Way {
        name: "extended without cuts",
        through: &["octree/octree.rs without_cuts"],
        make: |a| {
            let tree = build_extended(&a.csg(), &frame(DEPTH), &SurfaceOptions::default(), &CONTROL)?;
            of_ball(tree.without_cuts())
        },
        proven: SAME,
    },
    Way {
        name: "extended without moments",
        through: &["octree/octree.rs without_moments"],
        make: |a| {
            let tree = build_extended(&a.csg(), &frame(DEPTH), &SurfaceOptions::default(), &CONTROL)?;
            of_ball(tree.without_moments())
        },
        proven: SAME,
    },
    Way {
        name: "built of extended",
        through: &["op/extended/build.rs build_extended", "op/build.rs build"],
        make: |a| {
            let tree = build_extended(&a.csg(), &frame(DEPTH), &SurfaceOptions::default(), &CONTROL)?;
            of_ball(build(&tree, &frame(DEPTH), Rule::Certified, &CONTROL)?)
        },
        proven: SAME,
    },
    Way {
        name: "union of extended",
        through: &["op/boolean.rs union", "op/boolean.rs union_of"],
        make: |a| {
            let [one, other] = a.extended()?;
            let pair = union(one.view(), other.view(), &CONTROL)?;
            of(union_of(&[*pair.view(), *one.view(), *other.view()], &CONTROL)?, or)
        },
        proven: SAME,
    },
    Way {
        name: "intersection of extended and plain",
        through: &["op/boolean.rs intersection", "op/boolean.rs intersection_of"],
        make: |a| {
            let [one, other] = a.extended()?;
            let pair = intersection(one.view(), a.other.view(), &CONTROL)?;
            of(intersection_of(&[*pair.view(), *other.view()], &CONTROL)?, and)
        },
        proven: SAME,
    },
    Way {
        name: "difference of extended",
        through: &["op/boolean.rs difference", "op/boolean.rs difference_of"],
        make: |a| {
            let [one, other] = a.extended()?;
            let pair = difference(one.view(), other.view(), &CONTROL)?;
            of(difference_of(&[*pair.view(), *other.view(), *a.other.view()], &CONTROL)?, without)
        },
        proven: IF_BOTH,
    },
    Way {
        name: "symmetric difference of extended",
        through: &["op/boolean.rs xor", "op/boolean.rs xor_of"],
        make: |a| {
            let [one, other] = a.extended()?;
            let pair = xor(one.view(), other.view(), &CONTROL)?;
            of(xor_of(&[*pair.view(), *other.view(), *other.view()], &CONTROL)?, odd)
        },
        proven: IF_BOTH,
    },
    Way {
        name: "complement of extended",
        through: &["op/boolean.rs complement"],
        make: |a| {
            let [one, _] = a.extended()?;
            of(complement(one.view(), &CONTROL)?, |p| ball(p).map(|inside| !inside))
        },
        proven: SWAPPED,
    },
    Way {
        name: "plain of extended",
        through: &["op/extended/build.rs build_extended", "op/extended/build.rs plain"],
        make: |a| {
            let tree = build_extended(&a.csg(), &frame(DEPTH), &SurfaceOptions::default(), &CONTROL)?;
            of_ball(leafless::op::plain(&tree, DEPTH, Rule::Certified, &CONTROL)?)
        },
        proven: SAME,
    },
    Way {
        name: "union expression",
        through: &["solid/csg/mod.rs union_of"],
        make: |a| of(whole(&Csg::union_of([a.csg(), a.other_csg()])?)?, or),
        proven: SAME,
    },
    Way {
        name: "intersection expression",
        through: &["solid/csg/mod.rs intersection_of"],
        make: |a| of(whole(&Csg::intersection_of([a.csg(), a.other_csg()])?)?, and),
        proven: SAME,
    },
    Way {
        name: "difference expression",
        through: &["solid/csg/mod.rs difference"],
        make: |a| of(whole(&a.csg().difference(&a.other_csg())?)?, without),
        proven: IF_BOTH,
    },
    Way {
        name: "difference from half-spaces",
        through: &["solid/csg/mod.rs difference"],
        make: |a| of(whole(&Csg::ball(BALL.0, BALL.1)?.difference(&a.other_csg())?)?, without),
        proven: SWAPPED,
    },
    Way {
        name: "parity expression",
        through: &["solid/csg/mod.rs xor_of"],
        make: |a| of(whole(&Csg::xor_of([a.csg(), Csg::ball(OTHER.0, OTHER.1)?])?)?, odd),
        proven: IF_BOTH,
    },
    Way {
        name: "complement expression",
        through: &["solid/csg/mod.rs complement"],
        make: |a| of(whole(&a.csg().complement())?, not),
        proven: SWAPPED,
    },
    Way {
        name: "placed expression",
        through: &["solid/csg/mod.rs placed"],
        make: |a| of(whole(&a.csg().placed(&placement())?)?, moved),
        proven: SAME,
    },
    Way {
        name: "expression of the published tables",
        through: &["solid/csg/mod.rs with_touch"],
        make: |a| asked(&a.csg().with_touch(leafless::solid::Touch::Paper)),
        proven: SAME,
    },
    Way {
        name: "nothing and everything",
        through: &["solid/csg/mod.rs empty", "solid/csg/mod.rs everything"],
        make: |a| {
            let all = Csg::intersection_of([a.csg(), Csg::everything()])?;
            asked(&Csg::union_of([all, Csg::empty()])?)
        },
        proven: SAME,
    },
    // ---- wrappers
    Way { name: "borrowed", through: &["&S"], make: |a| asked(&&a.tree), proven: SAME },
    Way {
        name: "borrowed as any solid",
        through: &["dyn DynSolid + 's"],
        make: |a| asked(&(&a.tree as &dyn DynSolid)),
        proven: SAME,
    },
    Way {
        name: "erased and placed",
        through: &["AnySolid", "solid/any.rs placed"],
        make: |a| of(whole(&AnySolid::new(a.tree.clone()).placed(&placement())?)?, moved),
        proven: SAME,
    },
    Way {
        name: "moved",
        through: &["Transform", "solid/transform/mod.rs of"],
        make: |a| of(whole(&Transform::of(a.tree.clone(), &placement()))?, moved),
        proven: SAME,
    },
    Way {
        name: "moved from a frame",
        through: &["Transform", "solid/transform/mod.rs new"],
        make: |a| of(whole(&Transform::new(a.tree.clone(), &frame(DEPTH), &placement()))?, moved),
        proven: SAME,
    },
    Way {
        name: "moved to the nearest cells",
        through: &["solid/transform/mod.rs nearest"],
        make: |a| of(whole(&Transform::of(a.tree.clone(), &placement()).nearest())?, moved),
        proven: SAME,
    },
    Way {
        name: "adaptive",
        through: &["Adaptive", "solid/adaptive.rs new"],
        make: |a| asked(&Adaptive::new(&a.tree, 0.1)?),
        proven: SAME,
    },
    Way {
        name: "counted",
        through: &["SplitCounter", "solid/split_counter.rs new"],
        make: |a| asked(&SplitCounter::new(&a.tree)),
        proven: SAME,
    },
    Way {
        name: "prepared",
        through: &["Prepared", "solid/prepared.rs new", "solid/prepared.rs solid"],
        make: |a| {
            let prepared = Prepared::new(AnySolid::new(a.tree.clone()));
            whole(&prepared)?;
            let again = whole(&prepared)?;
            assert_eq!(whole(prepared.solid())?.proof(), again.proof());
            of_ball(again)
        },
        proven: SAME,
    },
    Way {
        name: "laid out",
        through: &["layout/item.rs solid"],
        make: |a| asked(Item::new(AnySolid::new(a.tree.clone()))?.solid()),
        proven: SAME,
    },
    // ---- split on demand
    Way {
        name: "lazy",
        through: &["&'n Nodes", "op/lazy/mod.rs new", "op/lazy/mod.rs freeze"],
        make: |a| {
            let mut lazy = LazyOctree::new(&a.tree, &frame(DEPTH))?;
            lazy.refine(&Zone::Whole, DEPTH, &CONTROL)?;
            of_ball(lazy.freeze(&CONTROL)?)
        },
        proven: SAME,
    },
    Way {
        name: "lazy and resumed",
        through: &["op/lazy/mod.rs resume"],
        make: |a| {
            let mut lazy = LazyOctree::new(&a.tree, &frame(DEPTH))?;
            lazy.refine(&Zone::Whole, 2, &CONTROL)?;
            let frozen = lazy.freeze(&CONTROL)?;
            let mut lazy = LazyOctree::resume(&frozen, &a.tree, &frame(DEPTH), &CONTROL)?;
            lazy.refine(&Zone::Whole, DEPTH, &CONTROL)?;
            of_ball(lazy.freeze(&CONTROL)?)
        },
        proven: SAME,
    },
    Way {
        // The fingerprint is that of the cells, which do not contain the proof.
        name: "resumed from what says that it is certified",
        through: &["op/lazy/mod.rs resume"],
        make: |a| {
            let mut lazy = LazyOctree::new(a.tree.with_proof(Proof::CERTIFIED), &frame(DEPTH))?;
            lazy.refine(&Zone::Whole, 2, &CONTROL)?;
            let frozen = lazy.freeze(&CONTROL)?;
            let mut lazy = LazyOctree::resume(&frozen, &a.tree, &frame(DEPTH), &CONTROL)?;
            lazy.refine(&Zone::Whole, DEPTH, &CONTROL)?;
            of_ball(lazy.freeze(&CONTROL)?)
        },
        proven: SAME,
    },
    // ---- solids of their own
    Way {
        // A function defines its own solid, whatever it reads.
        name: "function of a host",
        through: &["Callback", "solid/callback/mod.rs new", "solid/callback/mod.rs with_bounds"],
        make: |_| {
            let ([x, y, z], radius) = BALL;
            let solid = Callback::new(move |min: [f64; 3], max: [f64; 3]| {
                let square = |far: bool| {
                    [x, y, z].into_iter().enumerate().map(move |(k, c)| {
                        let near = (min[k] - c).max(c - max[k]).max(0.0);
                        let distant = (c - min[k]).max(max[k] - c);
                        if far { distant * distant } else { near * near }
                    })
                };
                Ok(if square(true).sum::<f64>() <= radius * radius {
                    Verdict::Full
                } else if square(false).sum::<f64>() >= radius * radius {
                    Verdict::Empty
                } else {
                    Verdict::Partial(())
                })
            });
            asked(&solid.with_bounds(Bounds::new([1.0; 3], [15.0; 3]).unwrap()))
        },
        proven: ITSELF,
    },
    Way {
        // A mesh is a solid of its own, the region inside its triangles.
        name: "mesh of an octree",
        through: &["MeshSolid", "solid/mesh/mesh_solid.rs new"],
        make: |a| {
            let mesh = marching_cubes(resolve(a.tree.view(), Rule::Outer, &CONTROL)?.view(), None, &CONTROL)?;
            of_itself(whole(&MeshSolid::new(Arc::new(mesh), FillRule::NonZero)?)?)
        },
        proven: ITSELF,
    },
    Way {
        // A bitmap is a solid of its own, the union of its voxels.
        name: "bitmap of an octree",
        through: &["Volume", "solid/volume/mod.rs new", "solid/volume/mod.rs with_band"],
        make: |a| {
            let mut bits = vec![0; 16 * 16];
            a.tree.bitmap(DEPTH, [0; 3], [16; 3], &mut bits, None, &CONTROL)?;
            let grid = VoxelGrid::new([16; 3], [0.0; 3], [1.0; 3])?;
            let volume = Volume::new(Samples::Bits(bits.into()), &grid, Band::at_least(0.5)?, &CONTROL)?;
            let volume = volume.with_band(Band::at_least(0.5)?, &CONTROL)?;
            let tree = a.tree.clone();
            of(whole(&volume)?, move |p| Some(tree.view().tag_at(p.map(|c| c as u32)) == Tag::Full))
        },
        proven: ITSELF,
    },
    // ---- tri-dexel models
    Way {
        name: "tri-dexel model to an octree",
        through: &["op/dexel_centres.rs octree_from_dexels"],
        make: |a| {
            let rule = if a.rule == Rule::Certified { Rule::Inner } else { Rule::Sampled };
            let options = DexelOptions { rule, ..DexelOptions::default() };
            let model = dexelize(&a.tree, &frame(DEPTH), &options, &CONTROL)?;
            of_ball(octree_from_dexels(model.view(), &CONTROL)?)
        },
        proven: NOTHING,
    },
    Way {
        name: "tri-dexel model to an octree by its ends",
        through: &["op/dexel_ends.rs octree_from_dexel_ends"],
        make: |a| {
            let rule = if a.rule == Rule::Certified { Rule::Inner } else { Rule::Sampled };
            let options = DexelOptions { rule, ..DexelOptions::default() };
            let model = dexelize(&a.tree, &frame(DEPTH), &options, &CONTROL)?;
            of_ball(octree_from_dexel_ends(model.view(), &CONTROL)?)
        },
        proven: NOTHING,
    },
    Way {
        name: "tri-dexel model as a solid",
        through: &["DexelSolid", "surface/dexel_solid.rs new"],
        make: |_| {
            let ball = Csg::ball(BALL.0, BALL.1)?;
            let model = dexelize(&ball, &frame(DEPTH), &DexelOptions::default(), &CONTROL)?;
            asked(&DexelSolid::new(model.view(), &CONTROL)?)
        },
        proven: NOTHING,
    },
    Way {
        name: "the surface of a tri-dexel model as the truth",
        through: &["DexelSolid", "surface/dexel_solid.rs as_truth"],
        make: |a| {
            let options = DexelOptions { rule: Rule::Outer, ..DexelOptions::default() };
            let model = dexelize(&a.tree, &frame(DEPTH), &options, &CONTROL)?;
            of_itself(whole(&DexelSolid::new(model.view(), &CONTROL)?.as_truth())?)
        },
        proven: ITSELF,
    },
    // ---- voxel records
    Way {
        name: "records, boundary as it is",
        through: &["voxel/records.rs of", "voxel/records.rs view", "voxel/import.rs to_octree"],
        make: |a| of_ball(a.records(&VoxelOptions::new()).view().to_octree(Tag::Partial, &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "records, boundary FULL",
        through: &["VoxelSolid", "voxel/import.rs new"],
        make: |a| asked(&VoxelSolid::new(a.records(&VoxelOptions::new()).view(), Tag::Full)?),
        // Binary octrees have no boundary voxels of this kind.
        proven: ["01", "10", "01", "00"],
    },
    Way {
        name: "records, boundary EMPTY",
        through: &["VoxelSolid", "voxel/import.rs new"],
        make: |a| asked(&VoxelSolid::new(a.records(&VoxelOptions::new()).view(), Tag::Empty)?),
        proven: ["10", "10", "01", "00"],
    },
    Way {
        name: "records, touching boundary as it is",
        through: &["voxel/import.rs to_octree"],
        make: |a| of_ball(a.records(&touching()).view().to_octree(Tag::Partial, &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "records, touching boundary FULL",
        through: &["voxel/import.rs to_octree"],
        make: |a| of_ball(a.records(&touching()).view().to_octree(Tag::Full, &CONTROL)?),
        // The boundary voxels of a binary octree are inside cells.
        proven: ["01", "10", "01", "00"],
    },
    Way {
        name: "records, touching boundary EMPTY",
        through: &["voxel/import.rs to_octree"],
        make: |a| of_ball(a.records(&touching()).view().to_octree(Tag::Empty, &CONTROL)?),
        proven: ["10", "10", "00", "00"],
    },
    Way {
        name: "records, coarse boundary as it is",
        through: &["voxel/import.rs to_octree"],
        make: |a| of_ball(a.records(&coarse()).view().to_octree(Tag::Partial, &CONTROL)?),
        proven: SAME,
    },
    Way {
        name: "records, coarse boundary FULL",
        through: &["voxel/import.rs to_octree"],
        make: |a| of_ball(a.records(&coarse()).view().to_octree(Tag::Full, &CONTROL)?),
        proven: ["01", "00", "01", "00"],
    },
    Way {
        name: "records, coarse boundary EMPTY",
        through: &["voxel/import.rs to_octree"],
        make: |a| of_ball(a.records(&coarse()).view().to_octree(Tag::Empty, &CONTROL)?),
        proven: ["10", "10", "00", "00"],
    },
    Way {
        name: "records, coarse touching boundary FULL",
        through: &["voxel/import.rs to_octree"],
        make: |a| of_ball(a.records(&touching().boundary_depth(2)).view().to_octree(Tag::Full, &CONTROL)?),
        proven: ["01", "00", "01", "00"],
    },
    Way {
        name: "records of all kinds",
        through: &["voxel/import.rs to_octree"],
        make: |a| {
            let options = touching().outside(true).refined(true);
            of_ball(a.records(&options).view().to_octree(Tag::Full, &CONTROL)?)
        },
        proven: ["01", "10", "01", "00"],
    },
    Way {
        name: "records turned",
        through: &["voxel/transform.rs turned"],
        make: |a| {
            let mirror = Symmetry::new([0, 1, 2], [true, false, false])?;
            let turned = a.records(&touching()).view().turned(mirror, &CONTROL)?;
            let tree = turned.view().to_octree(Tag::Full, &CONTROL)?;
            of(tree, |[x, y, z]| ball([16.0 - x, y, z]))
        },
        proven: ["01", "10", "01", "00"],
    },
    Way {
        name: "records moved",
        through: &["voxel/moved.rs moved"],
        make: |a| {
            let mirror = Symmetry::new([0, 1, 2], [true, false, false])?;
            let moved = a.records(&touching()).view().moved(mirror, [0; 3], &CONTROL)?;
            let tree = moved.view().to_octree(Tag::Full, &CONTROL)?;
            of(tree, |[x, y, z]| ball([16.0 - x, y, z]))
        },
        proven: ["01", "10", "01", "00"],
    },
    Way {
        name: "records placed exactly",
        through: &["voxel/transform.rs placed_exactly"],
        make: |a| {
            let shift = Affine::new([[-1.0, 0.0, 0.0, 16.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0]])?;
            let placed = a.records(&touching()).view().placed_exactly(&shift, &CONTROL)?;
            let tree = placed.view().to_octree(Tag::Full, &CONTROL)?;
            of(tree, |[x, y, z]| ball([16.0 - x, z, y]))
        },
        proven: ["01", "10", "01", "00"],
    },
    Way {
        name: "records placed by centres",
        through: &["voxel/transform.rs placed_by_centres"],
        make: |a| {
            let records = a.records(&VoxelOptions::new());
            let placed = records.view().placed_by_centres(&placement(), &frame(DEPTH), &CONTROL)?;
            of(placed.view().to_octree(Tag::Partial, &CONTROL)?, moved)
        },
        proven: NOTHING,
    },
    Way {
        name: "records of somebody's arrays",
        through: &["voxel/records.rs new", "voxel/records.rs from_arrays", "voxel/records.rs unchecked"],
        make: |a| {
            let records = a.records(&VoxelOptions::new());
            let view = records.view();
            let (codes, levels, kinds) = (view.codes(), view.levels(), view.kinds());
            let borrowed = VoxelRecordsRef::new(view.frame(), codes, levels, kinds, 0, &[])?;
            assert_eq!(borrowed.proof(), Proof::new(false, false));
            let unchecked = VoxelRecordsRef::unchecked(view.frame(), codes, levels, kinds);
            assert_eq!(unchecked.proof(), Proof::new(false, false));
            let (codes, levels, kinds) = (codes.to_vec(), levels.to_vec(), kinds.to_vec());
            let owned = VoxelRecords::from_arrays(view.frame(), codes, levels, kinds, 0, vec![])?;
            of_ball(owned.view().to_octree(Tag::Partial, &CONTROL)?)
        },
        proven: NOTHING,
    },
    Way {
        name: "records of which somebody says what they prove",
        through: &["voxel/records.rs with_exterior", "voxel/records.rs with_boundary"],
        make: |a| {
            let records = a.records(&touching());
            let (exterior, proof, boundary) =
                (records.view().exterior(), records.view().proof(), records.view().boundary());
            let said = records.with_exterior(exterior, proof).with_boundary(boundary);
            of_ball(said.view().to_octree(Tag::Full, &CONTROL)?)
        },
        proven: ["01", "10", "01", "00"],
    },
    // ---- files
    Way {
        name: "a file in memory",
        through: &["file/octree.rs from_bytes", "file/octree.rs view", "file/octree.rs from_static"],
        make: |a| {
            let bytes = file::to_bytes(&a.tree)?;
            assert_eq!(file::probe_bytes(&bytes)?.proof, a.tree.proof());
            assert_eq!(file::from_static(bytes.clone().leak())?.proof(), a.tree.proof());
            assert_eq!(file::view(&bytes)?.proof(), a.tree.proof());
            of_ball(file::from_bytes(&bytes)?)
        },
        proven: SAME,
    },
    Way {
        name: "a file on disk",
        through: &["file/octree.rs open", "file/octree.rs map", "file/octree.rs map_verified"],
        make: |a| {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("ball.lfl");
            file::save(&a.tree, &path)?;
            #[cfg(feature = "mmap")]
            {
                // SAFETY: no other process uses the file.
                #[allow(unsafe_code)]
                let mapped = unsafe { [file::map(&path)?, file::map_verified(&path)?] };
                mapped.iter().for_each(|mapped| assert_eq!(mapped.proof(), a.tree.proof()));
            }
            of_ball(file::open(&path)?)
        },
        proven: SAME,
    },
];

fn touching() -> VoxelOptions {
    VoxelOptions::new().boundary(VoxelBoundary::Touching)
}

fn coarse() -> VoxelOptions {
    VoxelOptions::new().boundary_depth(2)
}

/// Counts the points of FULL cells that are outside, and the points of EMPTY cells that are inside.
fn lies(made: &Made) -> [usize; 2] {
    let view = made.tree.view();
    let (cells, size) = (view.frame().cells(), view.frame().cell_size());
    let origin = view.frame().origin();
    let mut lies = [0; 2];
    for n in 0..cells.pow(3) {
        let cell = [n % cells, n / cells % cells, n / cells.pow(2)];
        let tag = view.tag_at(cell);
        if !matches!(tag, Tag::Full | Tag::Empty) {
            continue;
        }
        for k in 0..9u32 {
            let within = |axis: usize| if k == 8 { 0.5 } else { [0.0625, 0.9375][(k >> axis & 1) as usize] };
            let point = [0, 1, 2].map(|axis| origin[axis] + (f64::from(cell[axis]) + within(axis)) * size);
            match (tag, (made.truth)(point)) {
                (Tag::Full, Some(false)) => lies[0] += 1,
                (Tag::Empty, Some(true)) => lies[1] += 1,
                _ => {}
            }
        }
    }
    lies
}

#[test]
fn what_comes_out_is_what_the_table_says_and_true() {
    let given = RULES.map(Given::new);
    // Number of unproven bits whose claim would be a lie.
    let mut seen = 0;
    for way in WAYS {
        for (given, expected) in given.iter().zip(way.proven) {
            let what = format!("{} of {:?}", way.name, given.rule);
            let made = match (way.make)(given) {
                Err(error) => {
                    assert_eq!(expected, "--", "{what}: {error}");
                    continue;
                }
                Ok(made) => made,
            };
            let proof = made.tree.proof();
            let bits = format!("{}{}", u8::from(proof.full), u8::from(proof.empty));
            let found = lies(&made);
            for (is_proven, lies, name) in [(proof.full, found[0], "FULL"), (proof.empty, found[1], "EMPTY")]
            {
                assert!(
                    !is_proven || lies == 0,
                    "{what}: {name} is said to be proven, and {lies} points are not so"
                );
                seen += usize::from(!is_proven && lies > 0);
            }
            assert_eq!(bits, expected, "{what}");
            assert_eq!(proof.displacement(), 0.0, "{what}");
            // The exterior is claimed as cells are.
            match made.tree.view().exterior() {
                Tag::Full if proof.full => assert_ne!((made.truth)([-50.0; 3]), Some(false), "{what}"),
                Tag::Empty if proof.empty => assert_ne!((made.truth)([-50.0; 3]), Some(true), "{what}"),
                _ => {}
            }
        }
    }
    // Most unproven bits would be lies. Hence a false claim would be noticed, too.
    assert!(seen > WAYS.len(), "{seen} of {} ways", WAYS.len());
}

// ---- the completeness of the table ----------------------------------------------------------------------

/// Files whose functions make solids of numbers or of other programs' files, or whose solids the program's
/// own table compares with the truth (`cli/tests/program/proof_table.rs`).
const NUMBERS: &[&str] = &[
    "exchange/volume/mod.rs",
    "scene/lower.rs",
    "solid/callback/mod.rs",
    "solid/csg/faceted.rs",
    "solid/csg/figure/sweep.rs",
    "solid/csg/between.rs",
    "solid/csg/primitive.rs",
    "solid/mesh/mesh_solid.rs placed",
    "mesh/polyhedron",
];

/// Functions that return half-spaces made of numbers, in files with other functions.
const OF_NUMBERS: &[&str] = &["solid/csg/mod.rs half_space"];

fn sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
            let name = path.strip_prefix(root).unwrap().to_str().unwrap().replace('\\', "/");
            let text = std::fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]\nmod ").next().unwrap();
            let lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            found.push((name, lines.collect::<Vec<_>>().join(" ")));
        }
    }
}

/// Returns the length of the text before the first of these marks outside brackets.
fn until(text: &str, marks: &[char]) -> usize {
    let mut depth = 0;
    for (at, mark) in text.char_indices() {
        match mark {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ if depth == 0 && marks.contains(&mark) => return at,
            _ => {}
        }
    }
    text.len()
}

/// Splits a text into words.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|mark: char| !mark.is_alphanumeric() && mark != '_').filter(|word| !word.is_empty())
}

/// Returns the types that implement `Solid`, as written, without their parameters.
fn solid_types(sources: &[(String, String)]) -> BTreeSet<String> {
    let mut types = BTreeSet::new();
    for (_, text) in sources {
        for (at, _) in text.match_indices(" Solid for ") {
            let head = text[..at].rfind("impl").map_or("", |from| &text[from..at]);
            if head.contains(['{', '}']) || text[..at].ends_with("dyn") {
                continue;
            }
            let rest = &text[at + " Solid for ".len()..];
            let name = rest[..rest.find(['<', '{']).unwrap()].trim();
            types.insert(name.to_owned());
        }
    }
    types
}

/// Returns the public functions whose result contains one of these types: file and name.
fn makers(sources: &[(String, String)], types: &BTreeSet<String>) -> BTreeSet<String> {
    let mut makers = BTreeSet::new();
    for (file, text) in sources {
        for (at, _) in text.match_indices("pub ") {
            let rest = text[at + 4..].trim_start_matches("const ").trim_start_matches("unsafe ");
            let Some(rest) = rest.strip_prefix("fn ") else { continue };
            let name = &rest[..until_name(rest)];
            let end = until(rest, &['{', ';']);
            let signature = &rest[..end];
            // The arrow behind the parameters.
            let Some(open) = signature.find('(') else { continue };
            let close = open + 1 + matching(&signature[open + 1..]);
            let result = signature[close..].split(" where ").next().unwrap();
            if words(result).any(|word| types.contains(word)) {
                makers.insert(format!("{file} {name}"));
            }
        }
    }
    makers
}

fn until_name(text: &str) -> usize {
    text.find(|mark: char| !mark.is_alphanumeric() && mark != '_').unwrap_or(text.len())
}

/// Returns the index at which a bracket closes that was opened before the text.
fn matching(text: &str) -> usize {
    let mut depth = 1;
    for (at, mark) in text.char_indices() {
        match mark {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    text.len()
}

#[test]
fn the_table_is_complete() {
    let mut found = vec![];
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut found);
    // The C interface calls the functions in the table.
    let types = solid_types(&found);
    assert!(types.len() >= 16 && types.contains("VoxelSolid") && types.contains("&S"), "{types:?}");
    let through: BTreeSet<&str> = WAYS.iter().flat_map(|way| way.through.iter().copied()).collect();
    for name in &types {
        assert!(through.contains(name.as_str()), "{name} is a solid: which bits does it prove? Add a row");
    }
    let mut results: BTreeSet<String> = types.clone();
    results.extend(["VoxelRecords", "VoxelRecordsRef", "LazyOctree"].map(String::from));
    let makers = makers(&found, &results);
    assert!(makers.len() > 60 && makers.contains("voxel/import.rs to_octree"), "{makers:?}");
    for maker in &makers {
        let is_of_numbers =
            NUMBERS.iter().any(|file| maker.starts_with(file)) || OF_NUMBERS.contains(&&**maker);
        assert!(
            through.contains(maker.as_str()) || is_of_numbers,
            "{maker} returns a solid: which bits does it prove? Add a row"
        );
    }
    // Every name in the table exists.
    for name in through.iter().filter(|name| name.contains(' ') && !name.contains('\'')) {
        assert!(makers.contains(*name), "{name} is in the table, and in no source");
    }
    let names: BTreeSet<&str> = WAYS.iter().map(|way| way.name).collect();
    assert_eq!(names.len(), WAYS.len(), "a name stands twice");
}
