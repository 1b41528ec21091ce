//! Where intervals of mixed solids begin and end: at the universe's faces, and between centres.

use leafless::dexel::{DexelEnds, DexelFormat};
use leafless::op::DexelOptions;
use leafless::solid::{Band, VoxelGrid};
use leafless::{
    Affine, AnySolid, Callback, Control, Csg, FillRule, Frame, MeshSolid, TriangleMesh, Verdict, Volume,
    dexelize,
};
use leafless_testkit::Random;

const EDGE: f64 = 2.0;

/// Intervals that are in order and do not touch.
type Truth = Vec<[f64; 2]>;

fn holds(truth: &Truth, x: f64) -> bool {
    truth.iter().any(|[low, high]| *low <= x && x < *high)
}

fn between(axis: usize, [low, high]: [f64; 2]) -> [[f64; 3]; 2] {
    let (mut from, mut to) = ([-1.0; 3], [3.0; 3]);
    (from[axis], to[axis]) = (low, high);
    [from, to]
}

fn cuboid([low, high]: [[f64; 3]; 2]) -> AnySolid {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] });
    let triangles = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    let mesh = TriangleMesh::new((0..8).map(corner).collect(), triangles.to_vec()).unwrap();
    AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).unwrap())
}

/// Checks that each end is an end of the truth or lies at a face of the universe inside the solid, and that
/// every centre has its true state.
fn check(solid: &AnySolid, truth: &Truth, axis: usize, depth: u8, name: &str) -> usize {
    let (frame, control) = (Frame::new([0.0; 3], EDGE, depth).unwrap(), Control::default());
    let (mut walls, n) = (0, frame.cells());
    for ends in [DexelEnds::Fixed, DexelEnds::Double] {
        let format = DexelFormat { ends, ..DexelFormat::default() };
        let options = DexelOptions { directions: [0, 1, 2].map(|a| a == axis), format, ..Default::default() };
        let model = dexelize(solid, &frame, &options, &control).unwrap();
        model.view().check().unwrap();
        let ray = [n / 2, n / 4];
        let list: Vec<[f64; 2]> =
            model.view().rays(axis).unwrap().dexels(ray).map(|d| [d.start.at, d.end.at]).collect();
        let told = || format!("{name}, axis {axis}, depth {depth}: {list:?} of {truth:?}");
        for k in 0..n {
            let centre = (f64::from(k) + 0.5) * frame.cell_size();
            assert_eq!(holds(&list, centre), holds(truth, centre), "{}", told());
        }
        for (side, at) in list.iter().flat_map(|ends| [(0, ends[0]), (1, ends[1])]) {
            let face = [0.0, EDGE][side];
            let is_wall = truth.iter().any(|ends| (ends[side] - at).abs() < 4e-6);
            let is_face = at == face && holds(truth, if side == 0 { 0.0 } else { EDGE.next_down() });
            assert!(is_wall || is_face, "{}", told());
            let half = 0.5 * frame.cell_size();
            walls += usize::from(is_wall && ((at - face).abs() < half));
        }
    }
    walls
}

#[test]
fn ends_at_the_faces_of_the_universe_are_where_walls_are() {
    let mut random = Random(3);
    let mut walls = [0; 6];
    for round in 0..120 {
        let (axis, depth) = (round % 3, 1 + random.below(4) as u8);
        let count = 1 + random.below(3) as usize;
        let mut ends: Vec<f64> = (0..2 * count).map(|_| -0.1 + 2.2 * random.unit()).collect();
        // Often near the faces: before the first centre and after the last one.
        let half = 0.5 * EDGE / f64::from(1u32 << depth);
        if random.below(2) == 0 {
            ends[0] = half * random.unit();
        }
        if random.below(2) == 0 {
            ends[1] = EDGE - half * random.unit();
        }
        ends.sort_by(f64::total_cmp);
        if ends.windows(2).any(|pair| pair[1] - pair[0] < 1e-4) {
            continue;
        }
        let truth: Truth = ends.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
        let slabs = || truth.iter().map(|&ends| cuboid(between(axis, ends)));
        let ball = || Csg::ball([1.0; 3], 1.6).unwrap();
        // Meshes joined with each other, and with half-spaces.
        let joined = Csg::union_of(slabs().map(Csg::solid)).unwrap();
        walls[0] += check(&AnySolid::new(joined.clone()), &truth, axis, depth, "union of meshes");
        let cut = Csg::intersection_of([joined.clone(), ball()]).unwrap();
        walls[1] += check(&AnySolid::new(cut), &truth, axis, depth, "meshes in a ball");
        let rest: Truth = {
            let inner = truth.iter().flatten().copied();
            let all: Vec<f64> = [-2.0].into_iter().chain(inner).chain([4.0]).collect();
            all.chunks(2).map(|pair| [pair[0], pair[1]]).collect()
        };
        let hollow = ball().difference(&joined).unwrap();
        walls[2] += check(&AnySolid::new(hollow), &rest, axis, depth, "a ball without meshes");
        // A host's function, and the same in expressions and moved.
        let asked = truth.clone();
        let inside = truth.clone();
        let shift = 0.3;
        let host = Callback::new(move |min, max| {
            let (low, high) = (min[axis] + shift, max[axis] + shift);
            let meets = asked.iter().any(|ends| ends[0] < high && low < ends[1]);
            let full = asked.iter().any(|ends| ends[0] <= low && high <= ends[1]);
            Ok(if full {
                Verdict::Full
            } else if meets {
                Verdict::Partial(())
            } else {
                Verdict::Empty
            })
        })
        .with_contains(move |point| Ok(holds(&inside, point[axis] + shift)));
        let host = AnySolid::new(host);
        let mut translation = [0.0; 3];
        translation[axis] = shift;
        let moved = AnySolid::new(Csg::intersection_of([Csg::solid(host), Csg::everything()]).unwrap())
            .placed(&Affine::translation(translation).unwrap())
            .unwrap();
        walls[3] += check(&moved, &truth, axis, depth, "a host's function, moved");
        let turned = AnySolid::new(joined).placed(&Affine::IDENTITY).unwrap();
        let twice = Csg::union_of([Csg::solid(turned), Csg::solid(moved)]).unwrap();
        walls[4] += check(&AnySolid::new(twice), &truth, axis, depth, "meshes and a host's function");
        // The voxel of a volume.
        let [low, high] = truth[0];
        let (mut corner, mut spacing) = ([-1.0; 3], [4.0; 3]);
        (corner[axis], spacing[axis]) = (low, high - low);
        let grid = VoxelGrid::new([1; 3], corner, spacing).unwrap();
        let band = Band::at_least(1.0).unwrap();
        let volume = Volume::new([1u8][..].into(), &grid, band, &Control::default()).unwrap();
        let boxed = Csg::union_of([Csg::solid(AnySolid::new(volume)), Csg::empty()]).unwrap();
        walls[5] += check(&AnySolid::new(boxed), &vec![[low, high]], axis, depth, "a voxel");
    }
    assert!(walls.iter().all(|&count| count > 20), "{walls:?}");
}
