//! Any bytes as a scene. A scene that is read has a solid, whose cells agree at two depths and with its
//! bounds.

use leafless::scene::read_scene;
use leafless::{Control, Error, Frame, Membership, Octree, Rule, build};

const CONTROL: Control<'static> = Control {
    threads: 1,
    max_nodes: Some(1 << 14),
    max_bytes: None,
    max_splits: None,
    cancel: None,
    progress: None,
};

/// Reads `data` as a scene that names no files, and builds its solid at two depths. Returns whether it is a
/// scene.
pub fn scenes(data: &[u8]) -> bool {
    let scene = match read_scene(data, None) {
        Ok(scene) => scene,
        Err(Error::Scene(error)) => {
            let lines = data.iter().filter(|&&byte| byte == b'\n').count() as u64;
            assert!((1..=lines + 1).contains(&error.line()), "{error}");
            assert!((1..=data.len() as u64 + 1).contains(&error.column()), "{error}");
            return false;
        }
        Err(error) => panic!("{error}"),
    };
    let bounds = scene.bounds().expect("memory");
    let around = bounds.and_then(|(min, max)| Frame::around(min, max, 2).ok());
    let frame = around.unwrap_or(Frame::new([-8.0; 3], 16.0, 2).expect("a good frame"));
    let tree = |depth: u8| -> Option<Octree> {
        let frame = frame.with_depth(depth).ok()?;
        build(&scene.solid(&frame).ok()?, &frame, Rule::Certified, &CONTROL).ok()
    };
    let (Some(coarse), Some(fine)) = (tree(2), tree(4)) else { return true };
    let (outer, inner) = (coarse.statistics().volume(), fine.statistics().volume());
    assert!(outer.lower <= inner.lower && inner.upper <= outer.upper, "{outer:?} {inner:?}");
    let cell = fine.frame().cell_size();
    for at in 0..4096 {
        let centre = [0, 4, 8]
            .map(|shift| f64::from(at >> shift & 15) + 0.5)
            .into_iter()
            .zip(frame.origin())
            .map(|(cells, origin)| origin + cell * cells)
            .collect::<Vec<_>>();
        let point = [centre[0], centre[1], centre[2]];
        if let (Membership::Inside, Some((min, max))) = (fine.contains(point), bounds) {
            assert!((0..3).all(|axis| min[axis] <= point[axis] && point[axis] <= max[axis]), "{point:?}");
        }
        let answers = [coarse.contains(point), fine.contains(point)];
        assert!(answers[0] == Membership::Undecided || answers[0] == answers[1], "{point:?}: {answers:?}");
    }
    true
}

/// Small scenes with all calls.
pub const SEEDS: [&str; 9] = [
    "group() {\n\tcube(size = [1, 2, 3], center = true);\n\t%sphere($fn = 0, $fa = 12, $fs = 2, r = 5);\n}\n",
    "difference() { union() { sphere(r = 5); cylinder(h = 6, r1 = 4, r2 = 0, center = false); } #cube(2); }",
    "multmatrix([[0.8, -0.6, 0, 1], [0.6, 0.8, 0, 0], [0, 0, 1, -2e0], [0, 0, 0, 1]]) render(convexity = 2) cube(4);",
    "color([1, 0, 0, 1]) intersection() { cube(8, true); halfspace([1, 2, 0, 1]); \
     quadric([-1, -1, -1, 1, 0, 0, 0, 0, 0, 9]); power([-1, 0, 4], [-1, 0, 2], [1, 0.5, 3], 8); }",
    "// a ring\ntorus(5, 2); /* and\nanother */ rotate_extrude(angle = 200, start = 30) \
     multmatrix([[1,0,0,5],[0,1,0,1],[0,0,1,0],[0,0,0,1]]) circle(r = 2);",
    "linear_extrude(height = 3, scale = [0.5, 2], v = [0, 1, 2], center = true) \
     polygon(points = [[0, 0], [4, 0], [4, 4], [1, 1], [2, 2]], paths = [[0, 1, 2, 3]], convexity = 1);",
    "linear_extrude(height = 2) difference() { square([4, 4]); polygon([[1, 1], [3, 1], [2, 3]]); circle(1); }",
    "polyhedron(points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], \
     faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], convexity = 1);",
    "mesh(\"a\\\"b.stl\"); octree(file = \"c.lfl\"); import(file = \"d.off\", center = false);",
];
