//! Faces of boundaries: polygons, regions, shells, and their underlying surfaces.

use crate::boundary::{of, plate, random_scene, turn};
use leafless::exchange::{MeshFormat, WriteOptions, read_obj, write_polygons};
use leafless::mesh::{Polyhedron, PolyhedronArrays};
use leafless::solid::SurfaceShape;
use leafless::surface::{Boundary, BoundaryFaces, boundary};
use leafless::{Affine, Csg, Frame, SurfaceOptions, build_extended};
use leafless_testkit::{Random, alone, repeated};
use std::collections::BTreeMap;

fn cuboid(low: [f64; 3], high: [f64; 3]) -> Csg {
    Csg::cuboid(low, high).unwrap()
}

fn faces_of(solid: &Csg, tolerance: f64) -> (Boundary, BoundaryFaces) {
    let found = of(solid, 14, tolerance);
    let faces = found.faces().unwrap();
    assert_faces(&found, &faces, "");
    (found, faces)
}

/// Returns the corners of each loop of a face.
fn loops(arrays: &PolyhedronArrays, face: usize) -> Vec<Vec<u32>> {
    let part = |offsets: &[u32], k: usize| offsets[k] as usize..offsets[k + 1] as usize;
    part(arrays.faces, face).map(|k| arrays.corners[part(arrays.loops, k)].to_vec()).collect()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// Returns half the sum of the cross products of a loop's corners: its area, along its normal.
fn vector_area(vertices: &[[f64; 3]], corners: &[u32]) -> [f64; 3] {
    let origin = vertices[corners[0] as usize];
    let mut sum = [0.0; 3];
    for pair in corners.windows(2) {
        let [a, b] = [0, 1].map(|k| minus(vertices[pair[k] as usize], origin));
        sum = [0, 1, 2].map(|k| sum[k] + 0.5 * cross(a, b)[k]);
    }
    sum
}

/// Checks all faces: loops are paired, a region has the area of its triangles, holes run against their outer
/// loop, each corner of a plane face belongs to a third face, and each region lies on one surface.
fn assert_faces(found: &Boundary, faces: &BoundaryFaces, text: &str) {
    let (mesh, arrays) = (found.mesh(), faces.arrays());
    assert_eq!(arrays.vertices, mesh.vertices());
    let count = arrays.faces.len() - 1;
    let mut sides = BTreeMap::new();
    let mut uses = BTreeMap::new();
    for face in 0..count {
        for corners in loops(&arrays, face) {
            assert!(corners.len() >= 3, "{text}");
            for k in 0..corners.len() {
                let side = (corners[k], corners[(k + 1) % corners.len()]);
                assert!(sides.insert(side, face).is_none(), "{text}: {side:?}");
                *uses.entry(corners[k]).or_insert(0) += 1;
            }
        }
    }
    assert!(sides.keys().all(|&(from, to)| sides.contains_key(&(to, from))), "{text}");
    // (An edge of only two faces has a corner where a piece of a third face, smaller than the tolerance, was
    // removed. The edge bends there.)
    for corners in (0..count).flat_map(|face| loops(&arrays, face)) {
        for (k, corner) in corners.iter().enumerate().filter(|(_, corner)| uses[corner] == 2) {
            let others = [corners.len() - 1, 1].map(|step| corners[(k + step) % corners.len()]);
            let [a, b, c] = [others[0], *corner, others[1]].map(|vertex| arrays.vertices[vertex as usize]);
            let (way, normal) = (minus(c, a), cross(minus(c, a), minus(b, a)));
            let off = (dot(normal, normal) / dot(way, way)).sqrt();
            assert!(off > 1e-9, "{text}: a corner in a straight edge that two faces alone have: {off:e}");
        }
    }
    assert!(uses.values().all(|&uses| uses >= 2), "{text}");

    let mut end = 0;
    for (number, region) in (0u32..).zip(faces.regions()) {
        assert_eq!(region.faces.start, end, "{text}");
        end = region.faces.end;
        assert!(region.faces.clone().all(|face| faces.region_of(face) == Some(number)));
        let mut of_faces = [0.0; 3];
        for face in region.faces.clone() {
            let loops = loops(&arrays, face as usize);
            let areas: Vec<_> = loops.iter().map(|own| vector_area(arrays.vertices, own)).collect();
            assert!(areas[1..].iter().all(|&hole| dot(hole, areas[0]) < 0.0), "{text}: {areas:?}");
            areas.iter().for_each(|own| of_faces = [0, 1, 2].map(|k| of_faces[k] + own[k]));
        }
        let (mut of_triangles, mut area, mut triangles) = ([0.0; 3], 0.0, 0);
        for (triangle, _) in faces.of_triangles().iter().enumerate().filter(|&(_, &own)| own == number) {
            let own = vector_area(arrays.vertices, &mesh.triangles()[triangle]);
            of_triangles = [0, 1, 2].map(|k| of_triangles[k] + own[k]);
            area += dot(own, own).sqrt();
            triangles += 1;
            assert_eq!(found.surface_of(triangle), region.surface, "{text}");
        }
        let off = minus(of_faces, of_triangles);
        let size = {
            let (low, high) = mesh.bounds();
            (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max)
        };
        assert!(dot(off, off).sqrt() <= 1e-14 * size * size, "{text}: {off:?}");
        assert_eq!(triangles, region.triangles, "{text}");
        assert!((region.area - area).abs() <= 1e-13 * area, "{text}");
    }
    assert_eq!(end as usize, count, "{text}");
    assert_eq!(faces.region_of(end), None);
}

/// Checks that the polyhedron of the faces has the volume of the mesh.
fn assert_polyhedron(found: &Boundary, faces: &BoundaryFaces) -> Polyhedron {
    let polyhedron = Polyhedron::new(&faces.arrays()).unwrap();
    let (own, mesh) = (polyhedron.mesh().volume(), found.mesh().volume());
    assert!((own - mesh).abs() <= 1e-13 * mesh, "{own} {mesh}");
    polyhedron
}

#[test]
fn a_box_has_six_quadrilaterals() {
    for placement in [Affine::IDENTITY, turn()] {
        let solid = cuboid([0.0, -1.0, 2.5], [10.0, 20.0, 32.0]).placed(&placement).unwrap();
        let (found, faces) = faces_of(&solid, 1.0);
        let arrays = faces.arrays();
        assert_eq!((faces.regions().len(), arrays.faces.len(), arrays.vertices.len()), (6, 7, 8));
        for (face, region) in faces.regions().iter().enumerate() {
            let loops = loops(&arrays, face);
            assert_eq!((loops.len(), loops[0].len(), region.triangles), (1, 4, 2));
            // The normal of the face points out of the solid, and so does that of the surface.
            let shape = found.surfaces()[region.surface.unwrap() as usize].shape().unwrap();
            let SurfaceShape::Plane { normal, offset } = shape else { panic!() };
            let area = vector_area(arrays.vertices, &loops[0]);
            let sense = if region.is_turned { -1.0 } else { 1.0 };
            assert!((sense * dot(area, normal) / dot(area, area).sqrt() - 1.0).abs() < 1e-14);
            let corner = arrays.vertices[loops[0][0] as usize];
            assert!((dot(normal, corner) - offset).abs() < 1e-13);
            assert!(!region.is_turned);
        }
        assert_eq!((arrays.shells, arrays.solids), (&[0, 6][..], &[0, 1][..]));
        assert_polyhedron(&found, &faces);
        let file = write_polygons(&arrays, MeshFormat::Obj, &WriteOptions::default()).unwrap();
        assert_eq!(String::from_utf8(file.clone()).unwrap().matches("\nf ").count(), 6);
        assert!((read_obj(&file).unwrap().volume() - 10.0 * 21.0 * 29.5).abs() < 1e-9);
    }
}

#[test]
fn a_plate_with_a_bore() {
    let (found, faces) = faces_of(&plate(), 0.008);
    let arrays = faces.arrays();
    assert_eq!(faces.regions().len(), 7);
    let mut counts = Vec::new();
    for region in faces.regions() {
        let shape = found.surfaces()[region.surface.unwrap() as usize].shape().unwrap();
        match shape {
            SurfaceShape::Plane { .. } => {
                assert_eq!(region.faces.len(), 1);
                let loops = loops(&arrays, region.faces.start as usize);
                assert_eq!(loops[0].len(), 4);
                counts.push(loops.len());
                assert!(!region.is_turned);
            }
            SurfaceShape::Cylinder { point, axis, radius } => {
                assert!((radius - 5.0).abs() < 1e-14, "{radius}");
                assert!((point[0] - 40.0).abs() < 1e-13 && (point[1] - 30.0).abs() < 1e-13, "{point:?}");
                assert_eq!(axis.map(f64::abs), [0.0, 0.0, 1.0]);
                assert!(region.is_turned && region.faces.len() > 40);
                let wall = 2.0 * std::f64::consts::PI * 5.0 * 10.0;
                assert!(region.area < wall && region.area > 0.999 * wall);
            }
            other => panic!("{other:?}"),
        }
    }
    counts.sort_unstable();
    assert_eq!(counts, [1, 1, 1, 1, 2, 2]);
    assert_polyhedron(&found, &faces);
    for format in [MeshFormat::Obj, MeshFormat::Off] {
        let file = write_polygons(&arrays, format, &WriteOptions::default()).unwrap();
        let back = leafless::exchange::read_mesh(&file, &Default::default()).unwrap().mesh;
        assert!((back.volume() - found.mesh().volume()).abs() < 1e-9);
    }
    // The same for an octree that keeps its surfaces.
    let frame = Frame::new([-10.0, -10.0, -20.0], 120.0, 9).unwrap();
    let stored = build_extended(&plate(), &frame, &SurfaceOptions::default(), &alone()).unwrap();
    let own = boundary(&stored, &frame, 0.008, &alone()).unwrap();
    let faces = own.faces().unwrap();
    assert_faces(&own, &faces, "stored");
    assert_eq!(faces.regions().len(), 7);
}

/// Faces of several solids in one plane are one face. A corner stays where a third face ends.
#[test]
fn solids_in_the_shape_of_an_l_and_a_t() {
    let arm = cuboid([0.0, 0.0, 0.0], [3.0, 1.0, 1.0]);
    let other = cuboid([0.0, 0.0, 0.0], [1.0, 4.0, 1.0]);
    let (found, faces) = faces_of(&Csg::union_of([arm.clone(), other]).unwrap(), 0.1);
    let mut sizes: Vec<_> = (0..8).map(|face| loops(&faces.arrays(), face)[0].len()).collect();
    sizes.sort_unstable();
    assert_eq!((faces.regions().len(), sizes), (8, vec![4, 4, 4, 4, 4, 4, 6, 6]));
    assert!((assert_polyhedron(&found, &faces).mesh().volume() - 6.0).abs() < 1e-13);
    // A lower post whose top ends within a face. The face behind continues above it.
    let post = cuboid([1.0, 0.5, 0.0], [2.0, 3.0, 0.5]);
    let (found, faces) = faces_of(&Csg::union_of([arm, post]).unwrap(), 0.1);
    let mut sizes: Vec<_> = (0..10).map(|face| loops(&faces.arrays(), face)[0].len()).collect();
    sizes.sort_unstable();
    assert_eq!((faces.regions().len(), sizes), (10, vec![4, 4, 4, 4, 4, 4, 4, 4, 8, 8]));
    assert!((assert_polyhedron(&found, &faces).mesh().volume() - 4.0).abs() < 1e-13);
}

#[test]
fn voids_belong_to_their_solids() {
    let around = |size: f64| cuboid([-size; 3], [size; 3]);
    let hollow = around(5.0).difference(&around(4.0)).unwrap();
    let (found, faces) = faces_of(&hollow, 0.1);
    let arrays = faces.arrays();
    assert_eq!((arrays.shells, arrays.solids), (&[0, 6, 12][..], &[0, 2][..]));
    assert_polyhedron(&found, &faces);
    // A hollow box in its void, and another one beside it.
    let small = around(3.0).difference(&around(2.0)).unwrap();
    let beside = hollow.placed(&Affine::translation([20.0, 1.0, 2.0]).unwrap()).unwrap();
    let (found, faces) = faces_of(&Csg::union_of([hollow, small, beside]).unwrap(), 0.1);
    let arrays = faces.arrays();
    assert_eq!((arrays.shells.len(), arrays.solids), (7, &[0, 2, 4, 6][..]));
    let polyhedron = assert_polyhedron(&found, &faces);
    assert!((polyhedron.mesh().volume() - 2.0 * (1000.0 - 512.0) - (216.0 - 64.0)).abs() < 1e-9);
}

/// Boxes that touch in an edge, and boxes that touch in a corner.
#[test]
fn solids_that_touch_themselves() {
    let first = cuboid([0.0; 3], [1.0, 1.0, 2.0]);
    for other in [cuboid([1.0, 1.0, 0.5], [2.0, 3.0, 1.5]), cuboid([1.0, 1.0, 2.0], [2.0, 3.0, 4.0])] {
        let solid = Csg::union_of([first.clone(), other]).unwrap();
        let (found, faces) = faces_of(&solid, 0.1);
        assert!(faces.regions().iter().all(|region| region.faces.len() == 1));
        assert_polyhedron(&found, &faces);
    }
}

/// Scenes of two to five primitives: loops closed and paired, areas those of the triangles.
#[test]
fn random_scenes_have_faces() {
    check_scenes(repeated(5, 16));
}

/// `cargo test --release --test surfaces faces -- --ignored`
#[test]
#[ignore = "minutes"]
fn sixty_random_scenes_have_faces() {
    check_scenes(60);
}

fn check_scenes(scenes: usize) {
    let mut random = Random(40);
    let mut refused = 0;
    for scene in 0..scenes {
        let solid = random_scene(&mut random);
        let frame = Frame::new([-20.0; 3], 40.0, 11).unwrap();
        let found = boundary(&solid, &frame, [1.0, 0.4][scene % 2], &alone()).unwrap();
        let faces = found.faces().unwrap();
        assert_faces(&found, &faces, &format!("scene {scene}"));
        if found.mesh().triangles().is_empty() {
            continue;
        }
        match Polyhedron::new(&faces.arrays()) {
            Ok(polyhedron) => {
                let (own, mesh) = (polyhedron.mesh().volume(), found.mesh().volume());
                assert!((own - mesh).abs() <= 1e-12 * mesh, "scene {scene}: {own} {mesh}");
            }
            Err(error) => {
                println!("scene {scene}: {error}");
                refused += 1;
            }
        }
    }
    assert_eq!(refused, 0);
}
