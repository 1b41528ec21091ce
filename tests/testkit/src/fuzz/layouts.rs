//! Any bytes as a container, obstacles and items, some already placed. No verdict of a check contradicts
//! points of the solids, every placement of a search is proven once more, and the number of threads changes
//! nothing.

use super::Bytes;
use leafless::layout::{Bay, Direction, Item, Layout, Objective, Orientations, Placed, SearchOptions};
use leafless::query::GapVerdict;
use leafless::{Affine, AnySolid, Control, Csg};

/// A solid with exact numbers.
#[derive(Debug, Clone, Copy)]
enum Figure {
    Ball(f64),
    Box([f64; 3]),
    /// Two arms of a width, of these lengths, along x and z.
    Hook([f64; 2], f64),
    /// A cylinder around z, by its radius and height.
    Cylinder(f64, f64),
}

/// Points closer than this to a surface count for neither side.
const LITTLE: f64 = 1e-6;

impl Figure {
    fn new(bytes: &mut Bytes<'_>, unit: f64) -> Figure {
        let kind = bytes.below(4);
        let mut size = || unit * (1 + bytes.below(6)) as f64;
        match kind {
            0 => Figure::Ball(size()),
            1 => Figure::Box([size(), size(), size()]),
            2 => Figure::Hook([unit + size(), unit + size()], unit),
            _ => Figure::Cylinder(size(), size()),
        }
    }

    fn solid(&self) -> AnySolid {
        let solid = match *self {
            Figure::Ball(radius) => Csg::ball([0.0; 3], radius),
            Figure::Box(size) => Csg::cuboid([0.0; 3], size),
            Figure::Hook([x, z], width) => {
                let arms = [[x, width, width], [width, width, z]];
                Csg::union_of(arms.map(|arm| Csg::cuboid([0.0; 3], arm).expect("a good box")))
            }
            Figure::Cylinder(radius, height) => Csg::cylinder(radius, 0.0, height),
        };
        AnySolid::new(solid.expect("a good figure"))
    }

    /// Returns the bounding box.
    fn bounds(&self) -> [[f64; 3]; 2] {
        match *self {
            Figure::Ball(radius) => [[-radius; 3], [radius; 3]],
            Figure::Box(size) => [[0.0; 3], size],
            Figure::Hook([x, z], width) => [[0.0; 3], [x, width, z]],
            Figure::Cylinder(radius, height) => [[-radius, -radius, 0.0], [radius, radius, height]],
        }
    }

    /// Returns whether a point surely lies inside, and whether it may.
    fn holds(&self, [x, y, z]: [f64; 3]) -> [bool; 2] {
        let in_box = |size: [f64; 3], slack: f64| {
            [x, y, z].iter().zip(size).all(|(c, size)| slack < *c && *c < size - slack)
        };
        [LITTLE, -LITTLE].map(|slack| match *self {
            Figure::Ball(radius) => (x * x + y * y + z * z).sqrt() < radius - slack,
            Figure::Box(size) => in_box(size, slack),
            Figure::Hook([along, up], width) => {
                in_box([along, width, width], slack) || in_box([width, width, up], slack)
            }
            Figure::Cylinder(radius, height) => {
                (x * x + y * y).sqrt() < radius - slack && slack < z && z < height - slack
            }
        })
    }

    /// Returns points that surely lie inside.
    fn points(&self) -> Vec<[f64; 3]> {
        const STEPS: usize = 5;
        let [low, high] = self.bounds();
        let mut points = vec![];
        for k in 0..STEPS * STEPS * STEPS {
            let steps = [k % STEPS, k / STEPS % STEPS, k / STEPS / STEPS];
            let point = [0, 1, 2].map(|axis| {
                let part = (0.001 + 0.998 * steps[axis] as f64 / (STEPS - 1) as f64).clamp(0.0, 1.0);
                low[axis] + part * (high[axis] - low[axis])
            });
            if self.holds(point)[0] {
                points.push(point);
            }
        }
        points
    }
}

/// The figures of a bay.
struct Figures {
    container: Figure,
    obstacles: Vec<Figure>,
    items: Vec<Figure>,
}

impl Figures {
    /// True if a point of a placed item surely lies where it must not.
    fn contradicts(&self, own: usize, placed: &[Placed]) -> bool {
        let Placed { item, placement } = &placed[own];
        self.items[*item].points().into_iter().any(|point| {
            let point = placement.apply(point);
            let in_other = placed.iter().enumerate().filter(|(k, _)| *k != own).any(|(_, other)| {
                let back = other.placement.inverse().expect("a motion");
                self.items[other.item].holds(back.apply(point))[0]
            });
            let in_obstacle = self.obstacles.iter().any(|obstacle| obstacle.holds(point)[0]);
            in_other || in_obstacle || !self.container.holds(point)[1]
        })
    }
}

/// A rotation by an arbitrary angle, with an offset.
fn anywhere(bytes: &mut Bytes<'_>, within: [[f64; 3]; 2]) -> Affine {
    let (s, c) = [(0.0, 1.0), (1.0, 0.0), (0.6, 0.8), 0.47f64.sin_cos()][bytes.below(4)];
    let at = [0, 1, 2].map(|k| within[0][k] + (within[1][k] - within[0][k]) * bytes.byte() as f64 / 255.0);
    let rows = match bytes.below(2) {
        0 => [[c, -s, 0.0, at[0]], [s, c, 0.0, at[1]], [0.0, 0.0, 1.0, at[2]]],
        _ => [[1.0, 0.0, 0.0, at[0]], [0.0, c, -s, at[1]], [0.0, s, c, at[2]]],
    };
    Affine::new(rows).expect("a good map")
}

/// Runs the fuzz target.
pub fn layouts(data: &[u8]) {
    let mut bytes = Bytes(data);
    let container = Figure::new(&mut bytes, 2.0);
    let obstacles: Vec<Figure> = (0..bytes.below(2)).map(|_| Figure::new(&mut bytes, 0.5)).collect();
    let figures: Vec<Figure> = (0..1 + bytes.below(3)).map(|_| Figure::new(&mut bytes, 0.5)).collect();
    let items = figures.iter().map(|figure| {
        let orientations = match bytes.below(4) {
            0 => Orientations::AsGiven,
            1 => Orientations::Free(2),
            _ => Orientations::Turns,
        };
        let item = Item::new(figure.solid()).expect("a solid with bounds").with_count(bytes.below(5) as u32);
        item.with_orientations(orientations).expect("good turns")
    });
    let items: Vec<Item> = items.collect();
    let clearance = [0.0, 0.0, 1e-3, 0.25][bytes.below(4)];
    let wall_clearance = [0.0, 0.0, 0.125][bytes.below(3)];
    let bay = Bay::new(container.solid()).expect("a container with bounds");
    let mut bay = bay.with_clearances(clearance, wall_clearance).expect("good distances");
    for obstacle in &obstacles {
        bay.add_obstacle(obstacle.solid()).expect("an obstacle with bounds");
    }
    for item in items {
        bay.add_item(item).expect("room");
    }
    let all = Figures { container, obstacles, items: figures };
    let alone = Control { max_splits: Some(2000), ..Control::threads(1) };
    let mut layout = Layout::new(&bay, &alone).expect("a good bay");
    for _ in 0..bytes.below(4) {
        let item = bytes.below(all.items.len());
        layout.place(item, &anywhere(&mut bytes, container.bounds())).expect("a good place");
    }
    let before = layout.placed().to_vec();
    let standings = layout.check_all(&alone).expect("an answer");
    for (k, standing) in standings.iter().enumerate() {
        assert!(standing.verdict != GapVerdict::Yes || !all.contradicts(k, &before), "{k}: {standing:?}");
        assert_eq!(standing.verdict == GapVerdict::Yes, standing.conflicts.is_empty());
        let found = layout.check(k, &alone).expect("an answer");
        assert_eq!((found.verdict, &found.conflicts), (standing.verdict, &standing.conflicts));
    }
    let options = SearchOptions {
        objective: match bytes.below(4) {
            0 => Objective::Count,
            1 => Objective::Height,
            2 => Objective::Density,
            _ => Objective::Balance([1.0, 1.0, 1.0]),
        },
        seed: bytes.byte() as u64,
        rounds: 1 + bytes.below(2) as u32,
        cells: [8, 16, 24, 0][bytes.below(4)],
        max_tests: Some(60),
        free_along: match bytes.below(4) {
            0 => Some(Direction { axis: bytes.below(3) as u8, upward: bytes.below(2) == 0 }),
            _ => None,
        },
    };
    let budget = Control { max_splits: Some(20_000), ..alone };
    let report = layout.search(&options, &budget).expect("a search that ends");
    let placed = layout.placed().to_vec();
    assert!(placed.starts_with(&before) && report.placed as usize == placed.len() - before.len());
    assert!(report.tests <= 60 && report.splits <= 20_000);
    // (A single pair may take more splits than the search had left.)
    for k in before.len()..placed.len() {
        let found = layout.check(k, &Control::threads(1)).expect("an answer");
        assert_eq!(found.verdict, GapVerdict::Yes, "{k}: {found:?}");
        assert!(!all.contradicts(k, &placed), "{k}");
    }
    let measures = layout.measures(0.5, &alone).expect("measures");
    assert!(measures.volume.upper >= measures.volume.lower && measures.height.upper >= measures.height.lower);
    let mut again = Layout::new(&bay, &alone).expect("a good bay");
    for own in &before {
        again.place(own.item, &own.placement).expect("a good place");
    }
    let twice = again.search(&options, &Control { threads: 2, ..budget }).expect("a search that ends");
    assert_eq!((twice, again.placed()), (report, &placed[..]));
}
