//! Every query that accepts a solid gives intervals for an extended octree that overlap those of its source
//! expression, and are as sharp.

use leafless::lattice::Frame;
use leafless::op::{DexelOptions, Zone};
use leafless::query::{
    Columns, DistanceTo, Obstacle, SectionPlane, Side, cells_in, distances, heights, section_area,
    surface_area, volume_in,
};
use leafless::solid::Adaptive;
use leafless::surface::dual_contouring_solid;
use leafless::{
    Affine, AnySolid, Csg, Interval, LazyOctree, Membership, Ray, Rule, Solid, SurfaceOptions, bounding_box,
    build, build_extended, cast_rays, clearance, contains, dexelize, interference, measure,
};
use leafless_testkit::{Random, alone};

/// A query that takes a solid and returns numbers.
struct Consumer {
    name: &'static str,
    /// Limit of the total width of the tree's intervals, as a multiple of the source's total width.
    factor: f64,
    ask: fn(&AnySolid, &Frame) -> Vec<Interval>,
}

/// A number that both solids must return up to rounding.
fn near(number: f64, frame: &Frame) -> Interval {
    let slack = 1e-9 * frame.edge();
    Interval::new(number - slack, number + slack).unwrap()
}

fn between(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

/// Returns the point at the given fractions of the universe's edges.
fn place(frame: &Frame, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = frame.origin();
    [a + x * frame.edge(), b + y * frame.edge(), c + z * frame.edge()]
}

fn places(frame: &Frame, count: usize) -> Vec<[f64; 3]> {
    let mut random = Random(0x9A27);
    (0..count).map(|_| place(frame, [0; 3].map(|_| random.between(0.01, 0.99)))).collect()
}

/// A ball that interacts with the shapes in the middle of a universe.
fn ball(frame: &Frame, at: [f64; 3], radius: f64) -> Csg {
    Csg::ball(place(frame, at), radius * frame.edge()).unwrap()
}

const CONSUMERS: [Consumer; 17] = [
    Consumer {
        name: "contains",
        factor: 1.0,
        ask: |solid, frame| {
            let points = places(frame, 2000);
            let mut answers = vec![Membership::Undecided; points.len()];
            contains(solid, frame, &points, &mut answers, &alone()).unwrap();
            let told = |answer: &Membership| match answer {
                Membership::Inside => Interval::exactly(1.0),
                Membership::Outside => Interval::exactly(0.0),
                Membership::Undecided => between(0.0, 1.0),
            };
            answers.iter().map(told).collect()
        },
    },
    Consumer {
        name: "cast_rays",
        factor: 1.1,
        ask: |solid, frame| {
            let (from, to) = (places(frame, 200), places(frame, 400));
            let ray = |(from, to): (&[f64; 3], &[f64; 3])| {
                Ray::new(*from, [0, 1, 2].map(|axis| to[axis] - from[axis])).unwrap()
            };
            let rays: Vec<Ray> = from.iter().zip(&to[200..]).map(ray).collect();
            let hits = cast_rays(solid, frame, &rays, Obstacle::Full, &alone()).unwrap();
            hits.iter().map(|hit| hit.map_or(Interval::exactly(-1.0), |hit| hit.t)).collect()
        },
    },
    Consumer {
        name: "measure",
        factor: 1.1,
        ask: |solid, frame| {
            let found = measure(solid, frame, 1e-3, &alone()).unwrap();
            let inertia = found.inertia_about_centroid;
            let mut told = vec![found.volume];
            told.extend(found.centroid.unwrap());
            told.extend([inertia[0][0], inertia[1][1], inertia[2][2], inertia[0][1]]);
            told
        },
    },
    Consumer {
        name: "surface_area",
        factor: 1.5,
        ask: |solid, frame| vec![surface_area(solid, frame, 1e-2, &alone()).unwrap().area],
    },
    Consumer {
        name: "section_area",
        factor: 1.1,
        ask: |solid, frame| {
            let point = place(frame, [0.41, 0.37, 0.06]);
            let normals = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.3, 0.5, 0.8]];
            let area = |normal| {
                let plane = SectionPlane::new(point, normal).unwrap();
                section_area(solid, frame, &plane, 1e-4, &alone()).unwrap().area
            };
            normals.map(area).to_vec()
        },
    },
    Consumer {
        name: "bounding_box",
        factor: 1.1,
        ask: |solid, frame| {
            let extent = bounding_box(solid, frame, 1e-6 * frame.edge(), &alone()).unwrap();
            extent.corners.unwrap().concat()
        },
    },
    Consumer {
        // Each search ends once the interval is within the tolerance.
        name: "distances",
        factor: 1.5,
        ask: |solid, frame| {
            let points = places(frame, 100);
            let tolerance = 1e-4 * frame.edge();
            let to = [DistanceTo::Solid, DistanceTo::Complement, DistanceTo::Boundary];
            let all = to.map(|to| distances(solid, frame, &points, to, tolerance, &alone()).unwrap());
            all.iter().flatten().map(|found| found.distance).collect()
        },
    },
    Consumer {
        name: "interference",
        factor: 1.1,
        ask: |solid, frame| {
            let tool = ball(frame, [0.45, 0.4, 0.1], 0.17);
            let tolerance = 1e-4 * frame.edge().powi(3);
            let found = interference(solid, &tool, frame, tolerance, &alone()).unwrap();
            vec![Interval::exactly(found.verdict as u8 as f64), found.volume]
        },
    },
    Consumer {
        // It ends as soon as the tolerance is met. The final width below the tolerance is arbitrary.
        name: "clearance",
        factor: 2.0,
        ask: |solid, frame| {
            let tool = ball(frame, [0.9, 0.95, 0.93], 0.03);
            vec![clearance(solid, &tool, frame, 1e-4 * frame.edge(), &alone()).unwrap().distance]
        },
    },
    Consumer {
        // The sharpness of the larger cells' slabs determines which cells reach the tolerance.
        name: "Adaptive",
        factor: 2.0,
        ask: |solid, frame| {
            let frame = frame.with_depth(6).unwrap();
            let coarse = Adaptive::new(solid.clone(), 0.02 * frame.edge()).unwrap();
            let tree = build(&coarse, &frame, Rule::Certified, &alone()).unwrap();
            vec![tree.statistics().volume(), measure(&coarse, &frame, 0.0, &alone()).unwrap().volume]
        },
    },
    Consumer {
        name: "LazyOctree",
        factor: 1.0,
        ask: |solid, frame| {
            let frame = frame.with_depth(6).unwrap();
            let mut lazy = LazyOctree::new(solid.clone(), &frame).unwrap();
            let zone = Zone::Box { min: place(&frame, [0.0; 3]), max: place(&frame, [0.4, 0.7, 0.3]) };
            lazy.refine(&zone, 6, &alone()).unwrap();
            vec![lazy.statistics().volume(), lazy.freeze(&alone()).unwrap().statistics().volume()]
        },
    },
    Consumer {
        name: "build",
        factor: 1.0,
        ask: |solid, frame| {
            let frame = frame.with_depth(6).unwrap();
            let rules = [Rule::Certified, Rule::Sampled];
            let volume = |rule| build(solid, &frame, rule, &alone()).unwrap().statistics().volume();
            rules.map(volume).to_vec()
        },
    },
    Consumer {
        name: "dexelize",
        factor: 1.0,
        ask: |solid, frame| {
            let frame = frame.with_depth(6).unwrap();
            let model = dexelize(solid, &frame, &DexelOptions::default(), &alone()).unwrap();
            let rows = |direction| (0..frame.cells()).map(move |row| (direction, row));
            let mut told = Vec::new();
            for (direction, row) in (0..3).flat_map(rows) {
                for column in 0..frame.cells() {
                    let of_ray = model.view().rays(direction).unwrap().dexels([column, row]);
                    let ends = |dexel: leafless::dexel::Dexel| [dexel.start.at, dexel.end.at];
                    told.extend(of_ray.flat_map(ends).map(|at| near(at, &frame)));
                }
            }
            told
        },
    },
    Consumer {
        name: "dual_contouring_solid",
        factor: 1.0,
        ask: |solid, frame| {
            let frame = frame.with_depth(6).unwrap();
            let (mesh, _) = dual_contouring_solid(solid, &frame, &alone()).unwrap();
            let count = Interval::exactly(mesh.triangles().len() as f64);
            let corners = mesh.vertices().iter().flatten();
            core::iter::once(count).chain(corners.map(|&at| near(at, &frame))).collect()
        },
    },
    Consumer {
        name: "cells_in",
        factor: 1.0,
        ask: |solid, frame| {
            let frame = frame.with_depth(6).unwrap();
            let region = ball(&frame, [0.5, 0.3, 0.2], 0.3);
            let found = cells_in(solid, &region, &frame, &alone()).unwrap();
            let range = |least: u64, most: u64| between(least as f64, most as f64);
            vec![range(found.full_least, found.full_most), range(found.upper_least, found.upper_most)]
        },
    },
    Consumer {
        name: "volume_in",
        factor: 1.0,
        ask: |solid, frame| {
            let frame = frame.with_depth(6).unwrap();
            vec![volume_in(solid, &ball(&frame, [0.5, 0.3, 0.2], 0.3), &frame, &alone()).unwrap()]
        },
    },
    Consumer {
        name: "heights",
        factor: 1.0,
        ask: |solid, frame| {
            let frame = frame.with_depth(6).unwrap();
            let columns = Columns::all(&frame, 2).unwrap();
            let map = heights(solid, &frame, &columns, Side::Above, &alone()).unwrap();
            let height = |index| map.height(index).unwrap_or(Interval::exactly(f64::NEG_INFINITY));
            (0..columns.count() as usize).map(height).filter(|height| height.lower.is_finite()).collect()
        },
    },
];

fn plate() -> Csg {
    let bores = (0..20).map(|k| {
        let to = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
        Csg::cylinder(2.5, -1.0, 11.0).unwrap().placed(&Affine::translation(to).unwrap()).unwrap()
    });
    Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap().difference(&Csg::union_of(bores).unwrap()).unwrap()
}

fn sources() -> [(&'static str, Csg); 4] {
    let turn = Affine::new([[0.36, 0.48, -0.8, 0.0], [-0.8, 0.6, 0.0, 0.0], [0.48, 0.64, 0.6, 0.0]]).unwrap();
    let ring = Csg::torus(3.0, 1.0).unwrap();
    let bar = Csg::cuboid([-5.0, -0.6, -0.4], [5.0, 0.6, 0.7]).unwrap();
    let eye = Csg::ball([0.3, 0.2, 0.1], 1.4).unwrap();
    let joined = Csg::union_of([ring.placed(&turn).unwrap(), bar]).unwrap();
    [
        ("plate", plate()),
        ("turned plate", plate().placed(&turn).unwrap()),
        ("ring and bar less a ball", joined.difference(&eye).unwrap()),
        ("cone", Csg::frustum(2.0, 0.0, 0.0, 3.0).unwrap().placed(&turn).unwrap()),
    ]
}

#[test]
fn every_consumer_of_an_extended_tree_gives_what_the_source_gives() {
    let mut wrong = Vec::new();
    for (of, source) in sources() {
        let bounds = source.bounds().unwrap();
        let frame = Frame::around(bounds.min, bounds.max, 20).unwrap();
        let tree = build_extended(&source, &frame, &SurfaceOptions::default(), &alone()).unwrap();
        assert_eq!(tree.view().cuts().unwrap().given_up, 0, "{of}");
        let [tree, source] = [AnySolid::new(tree), AnySolid::new(source)];
        for Consumer { name, factor, ask } in CONSUMERS {
            let [own, told] = [&tree, &source].map(|solid| ask(solid, &frame));
            let apart = |(a, b): (&Interval, &Interval)| {
                let slack = 1e-9 * (1.0 + a.lower.abs().min(a.upper.abs()));
                a.lower > b.upper + slack || b.lower > a.upper + slack
            };
            let contradictions = own.iter().zip(&told).filter(|pair| apart(*pair)).count();
            let width = |all: &[Interval]| all.iter().map(Interval::width).sum::<f64>();
            let scale: f64 = told.iter().map(|told| told.lower.abs()).sum();
            let (own_width, width) = (width(&own), width(&told));
            println!("{of}, {name}: {} numbers, widths {own_width:e} and {width:e}", own.len());
            if own.len() != told.len() || contradictions > 0 {
                wrong.push(format!(
                    "{of}, {name}: {} and {} numbers, {contradictions} apart",
                    own.len(),
                    told.len()
                ));
            }
            if own_width > factor * width + 1e-9 * (1.0 + scale) {
                wrong.push(format!("{of}, {name}: {own_width:e} is wider than {width:e}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[cfg(feature = "mmap")]
#[path = "../../examples/drilled_plate.rs"]
#[allow(dead_code)]
mod drilled_plate;

#[cfg(feature = "mmap")]
#[test]
fn a_drilled_plate_is_known_to_a_millionth() {
    let made = drilled_plate::drill().unwrap();
    let truth = drilled_plate::true_volume();
    assert!(made.volume.contains(truth) && made.volume.width() < 1.01e-6 * truth, "{:?}", made.volume);
    assert!(made.bytes < 6000 && made.part.view().cuts().unwrap().given_up == 0);
}
