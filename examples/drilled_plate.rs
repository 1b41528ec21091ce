//! A plate and twenty bores, one by one and at once: octrees that keep their surfaces, saved, mapped and
//! measured.
//!
//! Run it with `cargo run --release --example drilled_plate`.

use leafless::op::difference_of;
use leafless::{
    Affine, Control, Csg, Frame, Interval, Membership, Octree, SurfaceOptions, Tag, build_extended,
    difference, file, intersection, measure,
};

const LOW: [f64; 3] = [0.0; 3];
const HIGH: [f64; 3] = [80.0, 60.0, 10.0];
const RADIUS: f64 = 2.5;

/// What became of the plate.
pub struct Drilled {
    /// The octree of what is left.
    pub part: Octree,
    /// Its volume, as proven.
    pub volume: Interval,
    /// Bytes of the file.
    pub bytes: u64,
}

/// What is left of the plate.
pub fn true_volume() -> f64 {
    80.0 * 60.0 * 10.0 - 20.0 * std::f64::consts::PI * RADIUS * RADIUS * 10.0
}

/// Drills the plate.
pub fn drill() -> Result<Drilled, Box<dyn std::error::Error>> {
    let control = Control::default();
    // Exact surfaces need no finest cell: the frame has the greatest depth, and cells end where three
    // surfaces are left.
    let frame = Frame::around(LOW, HIGH, 20)?;
    let extended = |solid: &Csg| build_extended(solid, &frame, &SurfaceOptions::default(), &control);

    let plate = extended(&Csg::cuboid(LOW, HIGH)?)?;
    let mut bores = Vec::new();
    for k in 0..20u8 {
        let centre = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
        let bore = Csg::cylinder(RADIUS, -1.0, 11.0)?.placed(&Affine::translation(centre)?)?;
        bores.push(extended(&bore)?);
    }

    // One by one, as an operator decides on them …
    let mut part = plate.clone();
    for bore in &bores {
        part = difference(part.view(), bore.view(), &control)?;
    }
    // … or all at once, which copies the plate once instead of twenty times.
    let trees: Vec<_> = [&plate].into_iter().chain(&bores).map(|tree| *tree.view()).collect();
    assert_eq!(difference_of(&trees, &control)?, part);

    // Surfaces that are one are one: nothing is left of the part without itself.
    let nothing = difference(part.view(), part.view(), &control)?;
    assert_eq!(nothing.view().root_tag(), Tag::Empty);
    // And a pin of the bore's own radius fits: the two touch, and have nothing in common.
    let pin = Csg::cylinder(RADIUS, -5.0, 15.0)?.placed(&Affine::translation([8.0, 7.5, 0.0])?)?;
    let common = intersection(part.view(), extended(&pin)?.view(), &control)?;
    assert_eq!(common.view().root_tag(), Tag::Empty);

    // The file is the arrays. Mapped, it answers at once.
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("plate.lfl");
    file::save(&part, &path)?;
    let bytes = std::fs::metadata(&path)?.len();
    // SAFETY: the file lies in a folder of our own, where nobody changes it.
    let mapped = unsafe { file::map(&path)? };
    assert_eq!(mapped.contains([8.0 + RADIUS + 1e-9, 7.5, 5.0]), Membership::Inside);
    assert_eq!(mapped.contains([8.0 + RADIUS - 1e-9, 7.5, 5.0]), Membership::Outside);

    // A millionth of the volume: cells are split below the file's own until that is proven.
    let volume = measure(&mapped, &frame, 1e-6, &control)?.volume;

    Ok(Drilled { part, volume, bytes })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Drilled { part, volume, bytes } = drill()?;
    let cuts = part.view().cuts().unwrap_or_default();
    println!(
        "{} nodes, {} cells that keep {} surfaces",
        part.statistics().nodes(),
        cuts.cells,
        cuts.surfaces
    );
    println!("{bytes} bytes, {} cells given up", cuts.given_up);
    println!("volume {:.6} to {:.6}; the truth is {:.6}", volume.lower, volume.upper, true_volume());
    Ok(())
}
