//! Pictures of the inside. Voxels that follow a colour make as good a picture as many more voxels of one
//! size.

#[path = "../../examples/gear_pictures.rs"]
#[allow(dead_code)]
mod gear_pictures;

use gear_pictures::gear_records::{inside, parts};
use leafless::Control;

/// For the published gear, 13 752 adaptive voxels looked as good as 32 059 of one size, and better than
/// 7 571.
#[test]
fn adaptive_records_make_good_pictures() {
    let control = Control::default();
    for part in parts(&control).unwrap() {
        let lists = part.lists(&control).unwrap();
        let [coarse, adaptive, fine] = gear_pictures::pictures(&part, &lists, [240, 200], &control).unwrap();
        let (poor, good) =
            (gear_pictures::difference(&coarse, &fine), gear_pictures::difference(&adaptive, &fine));
        println!("{}: RMSE {poor:.2} coarse, {good:.2} adaptive", part.name);
        assert!(poor > 0.5 && good <= poor / 3.0, "{}: {poor} {good}", part.name);
        assert!(inside(&lists.fine) as f64 >= 2.33 * inside(&lists.adaptive) as f64, "{}", part.name);
    }
}
