//! Solids cut from one another, saved, mapped and queried.
//!
//! Run it with `cargo run --release --example boolean`.

use leafless::query::Region;
use leafless::{Control, Csg, Frame, Metadata, Rule, build, difference, file, intersection};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Everything that is to be combined lies on one frame: here the cube [-1, 1]³ in 512 cells per axis.
    let frame = Frame::new([-1.0; 3], 2.0, 9)?;
    let control = Control::default();

    // A die: a block, its corners rounded off by a ball, hollowed out by another one.
    let block = build(&Csg::cuboid([-0.7; 3], [0.7; 3])?, &frame, Rule::Certified, &control)?;
    let round = build(&Csg::ball([0.0; 3], 1.0)?, &frame, Rule::Certified, &control)?;
    let hollow = build(&Csg::ball([0.0; 3], 0.5)?, &frame, Rule::Certified, &control)?;
    let rounded = intersection(block.view(), round.view(), &control)?;
    let die = difference(rounded.view(), hollow.view(), &control)?;

    // The volume is an interval that contains the true one, and half as wide with every level.
    for level in die.statistics().levels().iter().skip(4) {
        println!("depth {}: volume {:.4} to {:.4}", level.level, level.volume.lower, level.volume.upper);
    }

    // A file is written whole or not at all, and equal solids have equal bytes.
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("die.lfl");
    let mut facts = Metadata::new();
    facts.insert("name", "die");
    facts.insert("units", "inch");
    file::save(&die.with_metadata(facts), &path)?;
    println!("{} nodes in {} bytes", die.statistics().nodes(), std::fs::metadata(&path)?.len());

    // Mapped, it is ready at once, however large it is.
    // SAFETY: the file lies in a folder of our own, where nobody changes it.
    let mapped = unsafe { file::map(&path)? };
    for point in [[0.0, 0.0, 0.0], [0.6, 0.0, 0.0], [0.65, 0.65, 0.65], [0.7, 0.0, 0.0]] {
        println!("{point:?}: {:?}", mapped.contains(point));
    }
    assert_eq!(mapped.classify_box([0.55, -0.1, -0.1], [0.65, 0.1, 0.1])?, Region::Inside);
    assert_eq!(mapped.classify_box([-0.2; 3], [0.2; 3])?, Region::Outside);
    assert_eq!(mapped.metadata().get("units"), Some("inch"));
    Ok(())
}
