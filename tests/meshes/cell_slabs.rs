//! Slabs made for one cell each. Most surfaces in extended octrees of smooth meshes are such slabs.

use crate::oracle::{Oracle, PointOracle};
use crate::shapes;
use leafless_testkit::{Random, alone};

use leafless::octree::SurfaceKind;
use leafless::{
    AnySolid, Cell, Control, Csg, Error, FillRule, Frame, Membership, MeshSolid, Octree, OctreeRef,
    SurfaceOptions, TriangleMesh, build_extended, complement, contains, difference, file, intersection,
    union, xor,
};

const TOLERANCE: f64 = 1e-2;

type Operation = fn(&OctreeRef<'_>, &OctreeRef<'_>, &Control<'_>) -> Result<Octree, Error>;

fn frame() -> Frame {
    Frame::new([-1.5; 3], 3.125, 10).unwrap()
}

/// A mesh of a smooth surface, and its tree.
struct Smooth {
    mesh: TriangleMesh,
    solid: MeshSolid,
    tree: Octree,
}

impl Smooth {
    fn new(centre: [f64; 3], radius: f64) -> Smooth {
        let mesh = shapes::mesh(&shapes::torus(centre, radius, 0.4, 60, 40));
        let solid = MeshSolid::new(mesh.try_clone().unwrap(), FillRule::NonZero).unwrap();
        let tree = built(&solid, &frame(), &alone());
        assert!(cell_slabs(&tree) > 1000 && 2 * cell_slabs(&tree) > tree.view().cuts().unwrap().surfaces);
        Smooth { mesh, solid, tree }
    }
}

fn built(solid: &MeshSolid, frame: &Frame, control: &Control<'_>) -> Octree {
    build_extended(solid, frame, &SurfaceOptions { tolerance: Some(TOLERANCE) }, control).unwrap()
}

fn two() -> [Smooth; 2] {
    [Smooth::new([0.0; 3], 0.9), Smooth::new([0.3, -0.2, 0.1], 0.8)]
}

/// Returns the number of a tree's surfaces that are slabs of cells.
fn cell_slabs(tree: &Octree) -> u64 {
    let surfaces = tree.view().cuts().unwrap().surfaces as u32;
    let is_one = |id: &u32| {
        let surface = tree.view().surface(*id).unwrap();
        surface.kind() == SurfaceKind::Slab && surface.origin().is_some_and(|(_, number)| number >> 63 == 1)
    };
    (0..surfaces).filter(is_one).count() as u64
}

/// Returns a tree's bytes, and checks that the tree is read back from them.
fn bytes(tree: &Octree) -> Vec<u8> {
    tree.view().check().unwrap();
    let bytes = file::to_bytes(tree).unwrap();
    file::verify(&bytes).unwrap();
    let read = file::from_bytes(&bytes).unwrap();
    assert!(read == *tree && file::to_bytes(&read).unwrap() == bytes);
    bytes
}

fn points(random: &mut Random, count: usize) -> Vec<[f64; 3]> {
    (0..count).map(|_| [0, 1, 2].map(|_| random.between(-1.5, 1.5))).collect()
}

fn answers(tree: &Octree, points: &[[f64; 3]]) -> Vec<Membership> {
    let mut answers = vec![Membership::Undecided; points.len()];
    contains(tree, tree.frame(), points, &mut answers, &alone()).unwrap();
    answers
}

/// True if the finest cell that contains a point has no function.
fn is_given_up(tree: &Octree, p: [f64; 3]) -> bool {
    let at = tree.frame().cell_of(p).unwrap();
    tree.view().cell_function(Cell { level: tree.frame().depth(), at }).is_none()
}

#[test]
fn their_files_are_those_of_any_number_of_threads() {
    let Smooth { solid, tree, .. } = Smooth::new([0.0; 3], 0.9);
    let bytes = bytes(&tree);
    for threads in 2..4 {
        assert!(file::to_bytes(&built(&solid, &frame(), &Control::threads(threads))).unwrap() == bytes);
    }
}

#[test]
#[cfg(feature = "mmap")]
fn they_come_back_from_disk() {
    let Smooth { tree, .. } = Smooth::new([0.0; 3], 0.9);
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("smooth.lfl");
    file::save(&tree, &path).unwrap();
    assert!(std::fs::read(&path).unwrap() == bytes(&tree));
    assert!(file::open(&path).unwrap() == tree);
    // SAFETY: nobody changes the file.
    let mapped = unsafe { file::map(&path) }.unwrap();
    mapped.view().check().unwrap();
    assert_eq!(mapped.view().cuts(), tree.view().cuts());
    let mut random = Random(0xCE11);
    for p in points(&mut random, 20_000) {
        assert_eq!(mapped.view().contains(p), tree.view().contains(p), "{p:?}");
    }
    for id in 0..mapped.view().cuts().unwrap().surfaces as u32 {
        let [own, theirs] = [tree.view(), mapped.view()].map(|tree| tree.surface(id).unwrap());
        assert_eq!((own.origin(), own.number(3)), (theirs.origin(), theirs.number(3)));
        assert!(own.placements().eq(theirs.placements()));
    }
}

/// Both in place and as a solid, the answers for points agree with the winding number. Points away from all
/// slabs are decided.
#[test]
fn points_outside_of_slabs_are_told_right() {
    let Smooth { mesh, tree, .. } = Smooth::new([0.0; 3], 0.9);
    let oracle = PointOracle::new(&mesh);
    let mut random = Random(0x51AB);
    let mut points = points(&mut random, 2_000);
    // Also points next to the surface.
    for triangle in mesh.triangles().iter().step_by(3) {
        let corners = triangle.map(|v| mesh.vertices()[v as usize]);
        let off = 10f64.powf(random.between(-6.0, -2.0));
        points.push([0, 1, 2].map(|k| {
            (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0 + off * random.between(-1.0, 1.0)
        }));
    }
    let (mut known, mut near) = (0, 0);
    for (&p, answer) in points.iter().zip(answers(&tree, &points)) {
        let truth = oracle.winding(p).map(|winding| Oracle::inside(FillRule::NonZero, winding));
        for told in [answer, tree.view().contains(p)] {
            match told {
                Membership::Inside => assert!(truth != Some(false), "{p:?}"),
                Membership::Outside => assert!(truth != Some(true), "{p:?}"),
                Membership::Undecided => near += 1,
            }
        }
        known += usize::from(answer != Membership::Undecided);
    }
    println!("{known} of {}, {near} times undecided", points.len());
    assert!(known > 2_000 && near > 10);
}

/// Where several meshes have layers in a cell, the cell has more layers than it can keep.
#[test]
fn several_meshes_in_each_cell() {
    let nearly = |k: usize| {
        let off = 1e-4 * k as f64;
        let mesh = shapes::mesh(&shapes::torus([off, -off, 0.5 * off], 0.9 + off, 0.4, 24, 16));
        Csg::solid(AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).unwrap()))
    };
    let all: Vec<Csg> = (0..3).map(nearly).collect();
    let frame = frame().with_depth(6).unwrap();
    for joined in [Csg::union_of(all.clone()), all[2].difference(&all[0])] {
        let options = SurfaceOptions { tolerance: Some(0.1) };
        let tree = build_extended(&joined.unwrap(), &frame, &options, &alone()).unwrap();
        println!("{:?}, {} slabs of cells", tree.view().cuts(), cell_slabs(&tree));
        assert!(cell_slabs(&tree) > 0);
        bytes(&tree);
    }
}

#[test]
fn set_algebra_of_two_origins() {
    // (The complement of the complement does not remember the mesh's moments.)
    let [a, b] = two().map(|smooth| smooth.tree.without_moments());
    let control = &alone();
    let both = |of: Operation| {
        let one = of(a.view(), b.view(), control).unwrap();
        let other = of(b.view(), a.view(), control).unwrap();
        assert!(bytes(&one) == bytes(&other));
        let threads = of(a.view(), b.view(), &Control::threads(2)).unwrap();
        assert!(threads == one);
        one
    };
    let [joint, meet, odd] = [both(union), both(intersection), both(xor)];
    let less = difference(a.view(), b.view(), control).unwrap();
    bytes(&less);
    let not = |tree: &Octree| complement(tree.view(), control).unwrap();
    for tree in [&a, &b, &joint, &less] {
        assert!(cell_slabs(tree) > 1000);
        assert!(bytes(&not(&not(tree))) == bytes(tree));
        // An operation with itself gives the same, and the next one has nothing to simplify.
        for of in [union as Operation, intersection] {
            let once = of(tree.view(), tree.view(), control).unwrap();
            assert!(bytes(&of(once.view(), tree.view(), control).unwrap()) == bytes(&once));
        }
    }
    // De Morgan.
    let other = union(not(&a).view(), not(&b).view(), control).unwrap();
    assert!(bytes(&not(&other)) == bytes(&meet));

    let points = points(&mut Random(0xA1B2), 20_000);
    let of = |tree: &Octree| answers(tree, &points);
    let [of_a, of_b] = [of(&a), of(&b)];
    type Joins = fn(bool, bool) -> bool;
    let results: [(&Octree, Joins); 4] =
        [(&joint, |a, b| a || b), (&meet, |a, b| a && b), (&odd, |a, b| a != b), (&less, |a, b| a && !b)];
    for (tree, joins) in results {
        for (i, told) in of(tree).into_iter().enumerate() {
            if of_a[i] == Membership::Undecided || of_b[i] == Membership::Undecided {
                continue;
            }
            let truth = joins(of_a[i] == Membership::Inside, of_b[i] == Membership::Inside);
            let is_wrong = told == if truth { Membership::Outside } else { Membership::Inside };
            assert!(!is_wrong, "{:?}", points[i]);
            assert!(told != Membership::Undecided || is_given_up(tree, points[i]), "{:?}", points[i]);
        }
    }
}

/// The difference of a set and itself is empty, even within the slabs that bound the set: both operands have
/// the same slabs.
#[test]
fn a_set_less_itself_is_empty_outside_of_cells_that_were_given_up() {
    let [a, b] = two().map(|smooth| smooth.tree);
    let joint = union(a.view(), b.view(), &alone()).unwrap();
    for tree in [a, joint] {
        // A tree read from a file has other arrays, and the same slabs.
        let read = file::from_bytes(&file::to_bytes(&tree).unwrap()).unwrap();
        for none in [
            difference(tree.view(), tree.view(), &alone()).unwrap(),
            difference(tree.view(), read.view(), &alone()).unwrap(),
            xor(tree.view(), read.view(), &alone()).unwrap(),
        ] {
            bytes(&none);
            if tree.view().cuts().unwrap().given_up == 0 {
                assert_eq!(none.statistics().nodes(), 0);
            }
            for p in points(&mut Random(0xA_A), 10_000) {
                let told = none.view().contains(p);
                assert!(told == Membership::Outside || is_given_up(&tree, p), "{p:?} is told {told:?}");
            }
        }
    }
}

/// On a shallower frame, the home cells of some slabs no longer exist.
#[test]
fn on_less_deep_frames() {
    let [a, b] = two().map(|smooth| smooth.tree);
    let joint = union(a.view(), b.view(), &alone()).unwrap();
    for tree in [a, joint] {
        let points = points(&mut Random(0xDEE), 5_000);
        let known = answers(&tree, &points);
        for depth in [9, 7, 6, 5, 4, 3, 12] {
            let frame = frame().with_depth(depth).unwrap();
            for tolerance in [None, Some(TOLERANCE), Some(0.5)] {
                let less = build_extended(&tree, &frame, &SurfaceOptions { tolerance }, &alone()).unwrap();
                bytes(&less);
                for ((p, told), known) in points.iter().zip(answers(&less, &points)).zip(&known) {
                    let is_open = told == Membership::Undecided || *known == Membership::Undecided;
                    assert!(is_open || told == *known, "{p:?} on depth {depth}");
                }
            }
        }
    }
}
