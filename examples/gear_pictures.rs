//! Pictures of the inside: the gear and the cover of `gear_records`, as voxels of one size and as voxels that
//! follow the colour.
//!
//! After Zhu, Tang and Dong (2002), figure 6: of one size, coarse (a poor picture); adaptive (a good one); of
//! one size, fine. `cargo run --release --features png --example gear_pictures -- FOLDER` writes the pictures
//! to a folder.

#[path = "gear_records.rs"]
#[allow(dead_code)]
pub mod gear_records;

use gear_records::{Lists, Part, inside, parts};
use leafless::render::{Camera, ColourMap, Picture, Shot, Transfer, VolumeLayer, render, write_png};
use leafless::voxel::VoxelRecords;
use leafless::{Control, Error};

/// Pictures of the coarse, the adaptive and the fine records: one camera, one transfer function, one depth of
/// the boundary.
pub fn pictures(
    part: &Part,
    lists: &Lists,
    size: [u32; 2],
    control: &Control<'_>,
) -> Result<[Picture; 3], Error> {
    let bounds = leafless::Bounds { min: [-1.05, -1.05, -0.35], max: [1.05, 1.05, 0.35] };
    let camera =
        Camera::fitted(&bounds.corners(), [25.0, 50.0], None, f64::from(size[0]) / f64::from(size[1]))?;
    let shot = Shot { background: [0; 4], ..Shot::new(camera, size) };
    // Temperatures in degrees; colours are colours already.
    let transfer = Transfer::new(ColourMap::Viridis, [20.0, 80.0], 0.5, 0.1)?;
    let picture = |records: &VoxelRecords| {
        debug_assert!(part.levels[2] > 0);
        render(&shot, &[&VolumeLayer::new(records.view(), transfer)], control)
    };
    Ok([picture(&lists.coarse)?, picture(&lists.adaptive)?, picture(&lists.fine)?])
}

/// The root mean square of the differences of two pictures on white, 0 to 255, over the pixels where either
/// shows something.
pub fn difference(a: &Picture, b: &Picture) -> f64 {
    let on_white = |[r, g, b, a]: [u8; 4]| {
        let a = f64::from(a) / 255.0;
        [r, g, b].map(|x| f64::from(x) * a + 255.0 * (1.0 - a))
    };
    let (mut sum, mut count) = (0.0, 0u32);
    for (a, b) in a.colours().iter().zip(b.colours()) {
        if a[3] > 0 || b[3] > 0 {
            let (a, b) = (on_white(*a), on_white(*b));
            sum += (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>() / 3.0;
            count += 1;
        }
    }
    (sum / f64::from(count.max(1))).sqrt()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os().nth(1).ok_or("name a folder for the pictures")?;
    let folder = std::path::Path::new(&folder);
    let control = Control::default();
    println!(
        "{:<44} {:>8} {:>8} {:>8} {:>7} {:>7}",
        "records; RMSE against fine", "coarse", "adaptive", "fine", "coarse", "adapt."
    );
    for (part, name) in parts(&control)?.iter().zip(["gear-variance", "gear", "cover"]) {
        let lists = part.lists(&control)?;
        let found = pictures(part, &lists, [480, 400], &control)?;
        let [coarse, adaptive, fine] = [&lists.coarse, &lists.adaptive, &lists.fine].map(inside);
        let off = [0, 1].map(|i| difference(&found[i], &found[2]));
        println!("{:<44} {coarse:>8} {adaptive:>8} {fine:>8} {:>7.2} {:>7.2}", part.name, off[0], off[1]);
        for (picture, which) in found.iter().zip(["coarse", "adaptive", "fine"]) {
            std::fs::write(folder.join(format!("{name}-{which}.png")), write_png(picture)?)?;
        }
    }
    Ok(())
}
