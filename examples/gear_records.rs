//! Inside voxels that follow a colour: a gear with a hub, a web and a rim of different colours, and a cover
//! of a gearbox that is warm around its bearing.
//!
//! After Zhu, Tang and Dong (2002), whose gear took 7 571 voxels of one size for a poor picture, 32 059 for a
//! good one, and 13 752 of the size that the colour asks for. Run it with
//! `cargo run --release --example gear_records`.

use leafless::attribute::{Attribute, Criterion, Detail, FunctionAttribute, ValueRange};
use leafless::voxel::{VoxelKind, VoxelOptions, VoxelRecords};
use leafless::{Affine, Bounds, Control, Csg, Error, Frame, Interval, Octree, Rule, build};

/// A part, what is to be seen in it, and how finely.
pub struct Part {
    /// What it is called in the table.
    pub name: &'static str,
    /// The part.
    pub octree: Octree,
    /// Its colour or temperature.
    pub attribute: Box<dyn Attribute>,
    /// What makes a voxel fine enough.
    pub criterion: Criterion,
    /// How much the attribute may change in a voxel.
    pub tolerance: f64,
    /// Levels of the largest and the smallest voxels, and of the boundary.
    pub levels: [u8; 3],
}

/// The records of a part's voxels: no longer than the coarse limit, adaptive, and no longer than the fine
/// one.
pub struct Lists {
    /// Voxels of the coarse limit.
    pub coarse: VoxelRecords,
    /// Voxels that follow the attribute.
    pub adaptive: VoxelRecords,
    /// Voxels of the fine limit.
    pub fine: VoxelRecords,
}

impl Part {
    /// The three lists of a part.
    pub fn lists(&self, control: &Control<'_>) -> Result<Lists, Error> {
        let edge = |level: u8| self.octree.frame().edge() / f64::from(1u32 << level);
        let [coarse, fine, boundary] = self.levels;
        let list = |detail: Detail| {
            let options = VoxelOptions::new().boundary_depth(boundary).detail(detail);
            VoxelRecords::of(self.octree.view(), &options, Some(&*self.attribute), control)
        };
        Ok(Lists {
            coarse: list(Detail::uniform(edge(coarse))?)?,
            adaptive: list(Detail::new(edge(coarse), edge(fine), self.tolerance, self.criterion)?)?,
            fine: list(Detail::uniform(edge(fine))?)?,
        })
    }
}

/// How many inside voxels there are.
pub fn inside(records: &VoxelRecords) -> u64 {
    records.view().count(VoxelKind::Inside)
}

const FRAME: [f64; 2] = [-1.125, 2.25];

/// A gear of 16 trapezoid teeth with a bore.
fn gear() -> Result<Csg, Error> {
    let tooth = Csg::prism(&[[0.7, -0.11], [1.0, -0.05], [1.0, 0.05], [0.7, 0.11]], -0.25, 0.25)?;
    let mut parts = vec![Csg::cylinder(0.8, -0.25, 0.25)?];
    for k in 0..16 {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / 16.0).sin_cos();
        let turn = [[cosine, -sine, 0.0, 0.0], [sine, cosine, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        // What is next to nothing is nothing.
        let turn = turn.map(|row| row.map(|entry: f64| if entry.abs() < 1e-12 { 0.0 } else { entry }));
        parts.push(tooth.placed(&Affine::new(turn)?)?);
    }
    Csg::union_of(parts)?.difference(&Csg::cylinder(0.15, -1.0, 1.0)?)
}

/// The least and the greatest distance of a box from the axis through (x, y) along z.
fn distances(bounds: &Bounds, [x, y]: [f64; 2]) -> [f64; 2] {
    let (mut least, mut most) = (0.0, 0.0);
    for (axis, centre) in [x, y].into_iter().enumerate() {
        let (low, high) = (bounds.min[axis] - centre, bounds.max[axis] - centre);
        let near = 0.0f64.clamp(low, high);
        let far = low.abs().max(high.abs());
        least += near * near;
        most += far * far;
    }
    [least.sqrt() * (1.0 - 1e-12), most.sqrt() * (1.0 + 1e-12)]
}

/// Red, green, blue and opacity of hub, web and rim, 0 to 255, and the radii where these end.
const COLOURS: [[f64; 4]; 3] =
    [[230.0, 51.0, 26.0, 255.0], [26.0, 179.0, 51.0, 77.0], [51.0, 77.0, 230.0, 153.0]];
const RADII: [f64; 2] = [0.32, 0.58];

fn zone(radius: f64) -> usize {
    RADII.iter().filter(|&&end| radius >= end).count()
}

fn colour() -> Result<impl Attribute, Error> {
    let function = |p: [f64; 3]| Some(COLOURS[zone((p[0] * p[0] + p[1] * p[1]).sqrt())]);
    let range = |bounds: &Bounds| {
        let [first, last] = distances(bounds, [0.0; 2]).map(zone);
        ValueRange::Within([0, 1, 2, 3].map(|k| {
            let values = COLOURS[first..=last].iter().map(|colour| colour[k]);
            let lower = values.clone().fold(f64::INFINITY, f64::min);
            Interval::new(lower, values.fold(f64::NEG_INFINITY, f64::max)).unwrap()
        }))
    };
    Ok(FunctionAttribute::new(4, function)?.with_range(range))
}

const BEARING: [f64; 2] = [-0.35, 0.0];

/// A cover: a tray with a flange that has six bores, and a boss with the bearing.
fn cover() -> Result<Csg, Error> {
    let mut solid = Csg::union_of([
        Csg::cuboid([-0.95, -0.65, -0.3], [0.95, 0.65, -0.05])?,
        Csg::cuboid([-0.75, -0.45, -0.3], [0.75, 0.45, 0.5])?,
    ])?;
    solid = solid.difference(&Csg::cuboid([-0.6, -0.3, -0.5], [0.6, 0.3, 0.3])?)?;
    let at = |x: f64, y: f64| Affine::translation([x, y, 0.0]);
    let bearing = at(BEARING[0], BEARING[1])?;
    solid = Csg::union_of([solid, Csg::cylinder(0.3, 0.1, 0.7)?.placed(&bearing)?])?;
    solid = solid.difference(&Csg::cylinder(0.16, -1.0, 1.0)?.placed(&bearing)?)?;
    for (x, y) in [(-0.85, -0.55), (0.0, -0.55), (0.85, -0.55), (-0.85, 0.55), (0.0, 0.55), (0.85, 0.55)] {
        solid = solid.difference(&Csg::cylinder(0.05, -1.0, 1.0)?.placed(&at(x, y)?)?)?;
    }
    Ok(solid)
}

fn warmth(distance: f64) -> f64 {
    20.0 + 60.0 * (-(distance / 0.3) * (distance / 0.3)).exp()
}

fn temperature() -> Result<impl Attribute, Error> {
    let function = |p: [f64; 3]| {
        let (x, y) = (p[0] - BEARING[0], p[1] - BEARING[1]);
        Some([warmth((x * x + y * y).sqrt()), 0.0, 0.0, 0.0])
    };
    let range = |bounds: &Bounds| {
        let [near, far] = distances(bounds, BEARING).map(warmth);
        let range = Interval::new(far * (1.0 - 1e-12), near * (1.0 + 1e-12)).unwrap();
        ValueRange::Within([range; 4])
    };
    Ok(FunctionAttribute::new(1, function)?.with_range(range))
}

/// The gear, by both criteria, and the cover.
pub fn parts(control: &Control<'_>) -> Result<[Part; 3], Error> {
    let octree = |solid: Csg| {
        let frame = Frame::new([FRAME[0]; 3], FRAME[1], 7)?;
        build(&solid, &frame, Rule::Certified, control)
    };
    let gear = octree(gear()?)?;
    Ok([
        Part {
            name: "gear, three colours, variance of corners",
            octree: gear.clone(),
            attribute: Box::new(colour()?),
            criterion: Criterion::Variance,
            tolerance: 2.5,
            levels: [5, 7, 6],
        },
        Part {
            name: "gear, three colours, certified",
            octree: gear,
            attribute: Box::new(colour()?),
            criterion: Criterion::Range,
            tolerance: 2.5,
            levels: [5, 7, 6],
        },
        Part {
            name: "cover, temperature to 1.5 degrees, certified",
            octree: octree(cover()?)?,
            attribute: Box::new(temperature()?),
            criterion: Criterion::Range,
            tolerance: 1.5,
            levels: [5, 8, 6],
        },
    ])
}

fn main() -> Result<(), Error> {
    let control = Control::default();
    println!("{:<44} {:>9} {:>9} {:>9} {:>7}", "inside voxels", "coarse", "adaptive", "fine", "ratio");
    println!("{:<44} {:>9} {:>9} {:>9} {:>7.2}", "published gear", 7571, 13752, 32059, 32059.0 / 13752.0);
    for part in parts(&control)? {
        let lists = part.lists(&control)?;
        let [coarse, adaptive, fine] = [&lists.coarse, &lists.adaptive, &lists.fine].map(inside);
        let ratio = fine as f64 / adaptive as f64;
        println!("{:<44} {coarse:>9} {adaptive:>9} {fine:>9} {ratio:>7.2}", part.name);
    }
    Ok(())
}
