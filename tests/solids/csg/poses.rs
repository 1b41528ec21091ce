//! Many poses of a block among many balls. The union is prepared once, and a pose costs only its
//! neighbourhood.

use leafless::query::{Overlap, interference_at};
use leafless::solid::SplitCounter;
use leafless::{Affine, Csg, Frame};
use leafless_testkit::cubes::Plain;
use leafless_testkit::{Random, alone};

/// Returns the number of half-space evaluations for each pose among `n` balls.
fn evaluations(n: u32) -> f64 {
    const POSES: usize = 1000;
    let mut random = Random(n as u64);
    // The same number of balls in a unit of volume for any n.
    let edge = (n as f64).cbrt();
    let frame = Frame::new([0.0; 3], edge, 12).unwrap();
    let balls = (0..n).map(|_| Csg::ball([0; 3].map(|_| random.between(0.0, edge)), 0.3).unwrap());
    let union = SplitCounter::new(Csg::union_of(balls.collect::<Vec<_>>()).unwrap());
    let block = SplitCounter::new(Plain::cuboid([-0.1; 3], [0.1; 3]).unwrap());
    let own = Frame::new([-0.2; 3], 0.4, 6).unwrap();
    let poses: Vec<Affine> = (0..POSES)
        .map(|_| {
            let (s, c) = random.between(0.0, 6.0).sin_cos();
            let [x, y, z] = [0; 3].map(|_| random.between(1.0, edge - 1.0));
            Affine::new([[c, -s, 0.0, x], [s, c, 0.0, y], [0.0, 0.0, 1.0, z]]).unwrap()
        })
        .collect();
    let before = union.solid().evaluations();
    let found = interference_at(&union, &block, &own, &poses, &frame, f64::INFINITY, &alone()).unwrap();
    let after = union.solid().evaluations();
    assert_eq!((union.frames(), block.frames()), (1, 1));
    let over = found.iter().filter(|found| found.verdict == Overlap::Overlapping).count();
    let apart = found.iter().filter(|found| found.verdict == Overlap::Disjoint).count();
    println!("{n} balls: {over} poses overlap, {apart} do not; {} evaluations", after - before);
    // The volume of the balls grown by the block is about a quarter of the whole.
    assert!(over > POSES / 20 && apart > POSES / 4);
    (after - before) as f64 / POSES as f64
}

#[test]
fn a_pose_costs_what_is_near_it() {
    let (few, many) = (evaluations(100), evaluations(10_000));
    println!("{few} and {many} evaluations for each pose");
    assert!(few > 0.0 && many < 3.0 * few, "{few}, then {many}");
}

/// The same, with the union moved past the block. The block's frame is of the block's size.
fn evaluations_of_a_moved_union(n: u32) -> f64 {
    const POSES: usize = 1000;
    let mut random = Random(n as u64);
    let edge = (n as f64).cbrt();
    let own = Frame::new([0.0; 3], edge, 12).unwrap();
    let balls = (0..n).map(|_| Csg::ball([0; 3].map(|_| random.between(0.0, edge)), 0.3).unwrap());
    let union = SplitCounter::new(Csg::union_of(balls.collect::<Vec<_>>()).unwrap());
    let block = Plain::cuboid([-0.1; 3], [0.1; 3]).unwrap();
    let frame = Frame::new([-0.2; 3], 0.4, 6).unwrap();
    let poses: Vec<Affine> = (0..POSES)
        .map(|_| {
            let (s, c) = random.between(0.0, 6.0).sin_cos();
            let [x, y, z] = [0; 3].map(|_| random.between(1.0, edge - 1.0));
            // The point (x, y, z) of the union is moved to the block.
            Affine::new([[c, -s, 0.0, s * y - c * x], [s, c, 0.0, -s * x - c * y], [0.0, 0.0, 1.0, -z]])
                .unwrap()
        })
        .collect();
    let found = interference_at(&block, &union, &own, &poses, &frame, f64::INFINITY, &alone()).unwrap();
    assert_eq!(union.frames(), 1);
    let over = found.iter().filter(|found| found.verdict == Overlap::Overlapping).count();
    let apart = found.iter().filter(|found| found.verdict == Overlap::Disjoint).count();
    println!("{n} balls, moved: {over} poses overlap, {apart} do not");
    assert!(over > POSES / 20 && apart > POSES / 4);
    union.solid().evaluations() as f64 / POSES as f64
}

#[test]
fn a_pose_of_many_costs_what_is_near_the_other() {
    let counts = [100, 1000, 10_000].map(evaluations_of_a_moved_union);
    println!("{counts:?} evaluations for each pose");
    // At most logarithmically: by the same for each factor of ten.
    assert!(counts[0] > 0.0 && counts[2] < 2.0 * counts[0], "{counts:?}");
}
