//! Rays on meshes from files, on primitives and their combinations, and on mapped files. The true first hit
//! lies in the returned interval.

use crate::triangles::Triangles;
use leafless::query::{Obstacle, RayHit};
use leafless::{
    Control, Csg, FillRule, Frame, Interval, MeshSolid, Octree, Ray, Rule, build, cast_rays, exchange, file,
};
use leafless_testkit::{Random, alone, model};

/// A ray's origin and direction.
type Plain = ([f64; 3], [f64; 3]);

/// Rays from a sphere around a box to points in the box. Every eighth is parallel to an axis.
fn rays_towards(min: [f64; 3], max: [f64; 3], random: &mut Random, count: usize) -> Vec<Plain> {
    let centre = [0, 1, 2].map(|axis| (min[axis] + max[axis]) / 2.0);
    let radius = (0..3).map(|axis| (max[axis] - min[axis]).powi(2)).sum::<f64>().sqrt();
    let ray = |i: usize| {
        let target = [0, 1, 2].map(|axis| random.between(min[axis], max[axis]));
        if i.is_multiple_of(8) {
            let axis = i / 8 % 3;
            let (mut from, mut direction) = (target, [0.0, -0.0, 0.0]);
            direction[axis] = if (i / 24).is_multiple_of(2) { 1.0 } else { -0.5 };
            from[axis] = centre[axis] - direction[axis] * 2.0 * radius;
            return (from, direction);
        }
        let from = loop {
            let way = [0; 3].map(|_| random.between(-1.0, 1.0));
            let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (0.1..1.0).contains(&length) {
                break [0, 1, 2].map(|axis| centre[axis] + way[axis] * radius / length);
            }
        };
        (from, [0, 1, 2].map(|axis| target[axis] - from[axis]))
    };
    (0..count).map(ray).collect()
}

fn rays_of(plain: &[Plain]) -> Vec<Ray> {
    plain.iter().map(|&(from, direction)| Ray::new(from, direction).unwrap()).collect()
}

fn length(direction: [f64; 3]) -> f64 {
    direction.iter().map(|d| d * d).sum::<f64>().sqrt()
}

/// Compares first hits on FULL or PARTIAL cells with intervals that contain the true hits (∞ for a miss).
/// Most returned intervals are narrower than `fine`.
fn assert_hits(
    what: &str,
    plain: &[Plain],
    hits: &[Option<RayHit>],
    truth: impl Fn(&Plain) -> Interval,
    fine: f64,
) {
    let (mut met, mut narrow) = (0, 0);
    for (ray, hit) in plain.iter().zip(hits) {
        let true_t = truth(ray);
        let Some(RayHit { t, normal, .. }) = hit else {
            assert_eq!(true_t.upper, f64::INFINITY, "{what}: {ray:?} is said to miss");
            continue;
        };
        assert!(t.lower <= true_t.upper && true_t.lower <= t.upper, "{what}: {ray:?} {hit:?} {true_t:?}");
        let falls: f64 = (0..3).map(|axis| normal[axis] * ray.1[axis]).sum();
        assert!(falls <= 1e-9 * length(ray.1), "{what}: {ray:?} {hit:?}");
        if true_t.upper < f64::INFINITY {
            met += 1;
            narrow += (t.width() * length(ray.1) < fine) as usize;
        }
    }
    assert!(
        met > plain.len() / 10 && narrow > met * 9 / 10,
        "{what}: {narrow} of {met} are narrower than {fine}"
    );
}

fn mesh_from(name: &str, count: usize, depth: u8) {
    let Some(path) = model(name) else { return };
    let mesh = exchange::read_stl(&std::fs::read(path).unwrap()).unwrap().sewn().unwrap();
    let report = mesh.report().unwrap();
    assert!(report.boundary_edges == 0 && report.misoriented_edges == 0, "{name} is closed");
    let (min, max) = mesh.bounds();
    let frame = Frame::fitted(min, max, depth).unwrap();
    let triangles = Triangles::new(&mesh);
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let plain = rays_towards(min, max, &mut Random(12), count);
    let truth = |&(from, direction): &Plain| triangles.first_hit(from, direction);
    let tree = build(&solid, &frame, Rule::Certified, &Control::default()).unwrap();
    let mut hits = vec![None; count];
    tree.cast_rays(&rays_of(&plain), Obstacle::Upper, &mut hits).unwrap();
    assert_hits(name, &plain, &hits, truth, 30.0 * frame.cell_size());
    // The mesh itself provides slabs.
    let few = &plain[..count / 40];
    let hits = cast_rays(&solid, &frame, &rays_of(few), Obstacle::Upper, &Control::default()).unwrap();
    assert_hits(name, few, &hits, truth, 3.0 * frame.cell_size());
}

#[test]
fn rays_on_a_machined_part() {
    mesh_from("featuretype.STL", 20_000, 8);
}

#[test]
fn rays_on_a_scan() {
    mesh_from("bunny-closed.stl", 20_000, 8);
}

#[test]
#[ignore = "takes minutes"]
fn a_million_rays_on_meshes() {
    mesh_from("featuretype.STL", 1_000_000, 10);
    mesh_from("bunny-closed.stl", 1_000_000, 10);
}

/// The time range of a ray in a convex body, up to rounding; `None` for a miss.
type Spell = Option<[f64; 2]>;

/// Limit below which doubles do not decide the order of two times.
const DOUBT: f64 = 1e-9;

fn in_ball(centre: [f64; 3], radius: f64, (from, direction): &Plain) -> Spell {
    let from = [0, 1, 2].map(|axis| from[axis] - centre[axis]);
    in_quadric(from, *direction, radius, [true; 3])
}

/// Returns the time range in a cylinder along z, or in a ball.
fn in_quadric(from: [f64; 3], direction: [f64; 3], radius: f64, axes: [bool; 3]) -> Spell {
    let dot = |a: [f64; 3], b: [f64; 3]| -> f64 { (0..3).filter(|&i| axes[i]).map(|i| a[i] * b[i]).sum() };
    let (a, b, c) = (dot(direction, direction), dot(from, direction), dot(from, from) - radius * radius);
    if a == 0.0 {
        return (c < 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let discriminant = b * b - a * c;
    (discriminant > 0.0).then(|| [(-b - discriminant.sqrt()) / a, (-b + discriminant.sqrt()) / a])
}

fn in_box(min: [f64; 3], max: [f64; 3], (from, direction): &Plain) -> Spell {
    let mut spell = [f64::NEG_INFINITY, f64::INFINITY];
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if !(min[axis]..=max[axis]).contains(&from[axis]) {
                return None;
            }
            continue;
        }
        let [a, b] = [min[axis], max[axis]].map(|plane| (plane - from[axis]) / direction[axis]);
        spell = [spell[0].max(a.min(b)), spell[1].min(a.max(b))];
    }
    (spell[0] < spell[1]).then_some(spell)
}

fn in_cylinder(from_z: f64, to_z: f64, radius: f64, ray: &Plain) -> Spell {
    let round = in_quadric(ray.0, ray.1, radius, [true, true, false])?;
    let flat = in_box([-9.0, -9.0, from_z], [9.0, 9.0, to_z], ray)?;
    let both = [round[0].max(flat[0]), round[1].min(flat[1])];
    (both[0] < both[1]).then_some(both)
}

/// Returns the time at which a ray first enters (box ∪ cylinder) ∖ ball; `None` where rounding errors may
/// decide.
fn in_part(ray: &Plain) -> Option<f64> {
    let block = in_box([-1.0, -0.7, -0.6], [0.9, 0.8, 0.3], ray);
    let cylinder = in_cylinder(-0.9, 1.1, 0.45, ray);
    let ball = in_ball([0.2, 0.1, 0.7], 0.62, ray);
    let spells = [block, cylinder, ball];
    let mut moments: Vec<f64> = spells.iter().flatten().flatten().copied().filter(|t| *t > -DOUBT).collect();
    moments.push(0.0);
    moments.sort_by(f64::total_cmp);
    if moments.windows(2).any(|pair| pair[1] - pair[0] < DOUBT) {
        return None;
    }
    let is_in = |spell: &Spell, t: f64| spell.is_some_and(|[from, to]| from < t && t < to);
    let first = moments.iter().enumerate().find(|&(i, &t)| {
        // Whether the ray is in it just after this moment.
        let after = moments.get(i + 1).map_or(t + 1.0, |next| (t + next) / 2.0);
        t >= 0.0 && (is_in(&block, after) || is_in(&cylinder, after)) && !is_in(&ball, after)
    });
    Some(first.map_or(f64::INFINITY, |(_, &t)| t))
}

fn primitives(count: usize) {
    let block = Csg::cuboid([-1.0, -0.7, -0.6], [0.9, 0.8, 0.3]).unwrap();
    let cylinder = Csg::cylinder(0.45, -0.9, 1.1).unwrap();
    let ball = Csg::ball([0.2, 0.1, 0.7], 0.62).unwrap();
    let part = Csg::union_of([block, cylinder]).unwrap().difference(&ball).unwrap();
    let frame = Frame::new([-1.5; 3], 3.0, 9).unwrap();
    // Every ray that doubles can follow. Some rays start in the part.
    let mut random = Random(13);
    let mut plain = rays_towards([-1.1; 3], [1.2; 3], &mut random, count);
    for (from, _) in plain.iter_mut().step_by(5) {
        *from = [0; 3].map(|_| random.between(-1.2, 1.2));
    }
    let sure: Vec<Plain> = plain.into_iter().filter(|ray| in_part(ray).is_some()).collect();
    assert!(sure.len() > count * 99 / 100);
    // An oracle in doubles is right up to this fraction of its numbers, unless a ray grazes.
    let truth = |ray: &Plain| {
        let t = in_part(ray).unwrap();
        Interval::new(t - DOUBT, t + DOUBT).unwrap()
    };
    let tree = build(&part, &frame, Rule::Certified, &Control::default()).unwrap();
    let mut hits = vec![None; sure.len()];
    tree.cast_rays(&rays_of(&sure), Obstacle::Upper, &mut hits).unwrap();
    assert_hits("octree", &sure, &hits, truth, 20.0 * frame.cell_size());
    let hits = cast_rays(&part, &frame, &rays_of(&sure), Obstacle::Upper, &Control::default()).unwrap();
    assert_hits("solid", &sure, &hits, truth, 0.2 * frame.cell_size());
}

#[test]
fn rays_on_primitives() {
    primitives(20_000);
}

#[test]
#[ignore = "takes minutes"]
fn a_million_rays_on_primitives() {
    primitives(1_000_000);
}

/// Rays on a mapped file give the same answers, bit for bit.
#[test]
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
fn rays_on_a_mapped_file() {
    let frame = Frame::new([-1.5; 3], 3.0, 8).unwrap();
    let ball = Csg::ball([0.2, 0.1, 0.3], 0.9).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for rule in [Rule::Certified, Rule::Sampled] {
        let tree = build(&ball, &frame, rule, &alone()).unwrap();
        let path = folder.path().join("ball.lfl");
        file::save(&tree, &path).unwrap();
        // SAFETY: no other process uses the file.
        let maps: [Octree; 2] = unsafe { [file::map(&path).unwrap(), file::map_verified(&path).unwrap()] };
        let rays = rays_of(&rays_towards([-1.5; 3], [1.5; 3], &mut Random(14), 5000));
        for mapped in maps {
            for on in [Obstacle::Full, Obstacle::Upper] {
                let (mut hits, mut wanted) = (vec![None; rays.len()], vec![None; rays.len()]);
                mapped.cast_rays(&rays, on, &mut hits).unwrap();
                tree.cast_rays(&rays, on, &mut wanted).unwrap();
                assert!(hits == wanted && hits.iter().flatten().count() > 1000);
            }
            for ray in &rays[..200] {
                assert_eq!(mapped.ray_spans(ray).unwrap(), tree.ray_spans(ray).unwrap());
            }
        }
    }
}

/// The closed block [2, 6]³, with rays from its corners, edges, faces and inside, and from around it, along
/// axes and diagonals. The times are integers. A zero of either sign has no direction.
#[test]
fn rays_from_corners_edges_and_faces() {
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    let block = Csg::cuboid([2.0; 3], [6.0; 3]).unwrap();
    let tree = build(&block, &frame, Rule::Certified, &alone()).unwrap();
    let corners: Vec<[f64; 3]> =
        (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { 2.0 } else { 6.0 })).collect();
    let sides: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = leafless::TriangleMesh::new(corners, triangles).unwrap();
    let mesh = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let (mut plain, mut wanted) = (Vec::new(), Vec::new());
    let places = [-1.0, -0.0, 2.0, 4.0, 6.0, 8.0];
    for from in (0..216).map(|i| [i % 6, i / 6 % 6, i / 36].map(|k: usize| places[k])) {
        for way in (0..27).filter(|&i| i != 13).map(|i| [i % 3, i / 3 % 3, i / 9]) {
            for zero in [0.0, -0.0] {
                let direction = way.map(|k: usize| [-1.0, zero, 1.0][k]);
                let mut spell = [0.0, f64::INFINITY];
                for axis in 0..3 {
                    let stay = if direction[axis] == 0.0 {
                        let stays = (2.0..=6.0).contains(&from[axis]);
                        if stays { [0.0, f64::INFINITY] } else { [1.0, 0.0] }
                    } else {
                        let [a, b] = [2.0, 6.0].map(|plane: f64| (plane - from[axis]) / direction[axis]);
                        [a.min(b), a.max(b)]
                    };
                    spell = [f64::max(spell[0], stay[0]), f64::min(spell[1], stay[1])];
                }
                plain.push((from, direction));
                wanted.push((spell[0] <= spell[1]).then_some(spell[0]));
            }
        }
    }
    let rays = rays_of(&plain);
    assert!(wanted.iter().flatten().count() > 1000 && wanted.iter().filter(|t| t.is_none()).count() > 1000);
    for on in [Obstacle::Full, Obstacle::Upper] {
        let mut stored = vec![None; rays.len()];
        tree.cast_rays(&rays, on, &mut stored).unwrap();
        let of = |solid: &dyn Fn() -> Vec<Option<RayHit>>| solid();
        for hits in [
            stored,
            of(&|| cast_rays(&tree, &frame, &rays, on, &alone()).unwrap()),
            of(&|| cast_rays(&block, &frame, &rays, on, &alone()).unwrap()),
            of(&|| cast_rays(&mesh, &frame, &rays, on, &alone()).unwrap()),
        ] {
            for ((ray, hit), wanted) in plain.iter().zip(hits).zip(&wanted) {
                assert_eq!(hit.map(|hit| hit.t), wanted.map(Interval::exactly), "{ray:?} {hit:?}");
            }
        }
    }
}
