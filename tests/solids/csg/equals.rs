//! Equal operands of an expression are one solid, without the doubt of coincident faces.

use leafless::query::surface_area;
use leafless::{Affine, Control, Csg, Frame, Rule, build, measure};

fn frame() -> Frame {
    Frame::new([-2.0; 3], 4.0, 4).unwrap()
}

fn cube() -> Csg {
    Csg::cuboid([-1.0; 3], [0.5, 1.0, 1.0]).unwrap()
}

#[test]
fn what_is_left_is_the_same_solid() {
    let ball = |x: f64| Csg::ball([x, 0.1, 0.0], 0.7).unwrap();
    let torus = || Csg::torus(0.8, 0.3).unwrap();
    let parts = || [ball(0.5), cube(), ball(0.5), torus(), cube(), torus(), ball(-0.5), ball(0.5)];
    let once = || [ball(0.5), cube(), torus(), ball(-0.5)];
    let built = |csg: Csg| build(&csg, &frame(), Rule::Certified, &Control::default()).unwrap();
    assert_eq!(built(Csg::union_of(parts()).unwrap()), built(Csg::union_of(once()).unwrap()));
    assert_eq!(built(Csg::intersection_of(parts()).unwrap()), built(Csg::intersection_of(once()).unwrap()));
    // Two equal operands cancel, and three leave one.
    let odd = Csg::xor_of([ball(0.5), ball(-0.5)]).unwrap();
    assert_eq!(built(Csg::xor_of(parts()).unwrap()), built(odd));
}

#[test]
fn a_thousand_cubes_have_the_area_of_one() {
    let all = Csg::union_of((0..1000).map(|_| cube())).unwrap();
    let control = Control::default();
    let area = surface_area(&all, &frame(), 1e-9, &control).unwrap().area;
    assert!(area.contains(20.0) && area.width() < 1e-9, "{area:?}");
    let volume = measure(&all, &frame(), 1e-9, &control).unwrap().volume;
    assert!(volume.contains(6.0) && volume.width() < 1e-9);
}

/// Returns the volume's bounds, and the number of cells split for it.
fn volume(csg: &Csg) -> (f64, f64, u64) {
    let control = Control { max_splits: Some(2_000), ..Control::threads(1) };
    let measured = measure(csg, &frame(), 0.0, &control).unwrap();
    (measured.volume.lower, measured.volume.upper, measured.splits)
}

/// Equal surfaces are one: from both sides, with any factor of their coefficients, and from any source.
#[test]
fn what_coincides_leaves_no_doubt() {
    let ball = || Csg::ball([0.1, 0.2, 0.3], 0.7).unwrap();
    assert_eq!(volume(&ball().difference(&ball()).unwrap()), (0.0, 0.0, 0));
    let all = Csg::union_of([ball(), ball().complement()]).unwrap();
    assert_eq!(volume(&all), (64.0, 64.0, 0));
    let plane = |scale: f64| Csg::half_space([0.3 * scale, -0.7 * scale, 0.1 * scale], 0.2 * scale).unwrap();
    assert_eq!(volume(&Csg::intersection_of([plane(1.0), plane(-1.0)]).unwrap()), (0.0, 0.0, 0));
    assert_eq!(volume(&Csg::union_of([plane(4.0), plane(-0.25)]).unwrap()), (64.0, 64.0, 0));
    // A cylinder that is moved along itself is the same surface.
    let up = Affine::translation([0.0, 0.0, 0.375]).unwrap();
    let bar = || Csg::cylinder(0.5, -1.0, 1.0).unwrap();
    let rest = bar().placed(&up).unwrap().difference(&bar()).unwrap();
    let (lower, upper, _) = volume(&rest);
    let truth = std::f64::consts::PI * 0.25 * 0.375;
    assert!(lower <= truth && truth <= upper, "{lower} to {upper}");
    let lid = bar().difference(&Csg::cylinder(0.5, -2.0, 0.5).unwrap()).unwrap();
    let below = Csg::cuboid([-1.0; 3], [1.0, 1.0, 0.5]).unwrap();
    assert_eq!(volume(&Csg::intersection_of([lid, below]).unwrap()).1, 0.0);
}

/// Touching solids have no common points, in place and rotated.
#[test]
fn contact_is_no_overlap() {
    let (sine, cosine) = 0.7f64.sin_cos();
    let turned = [
        [cosine, -0.8 * sine, 0.6 * sine, 0.1],
        [sine, 0.8 * cosine, -0.6 * cosine, 0.0],
        [0.0, 0.6, 0.8, -0.1],
    ];
    let turned = Affine::new(turned).unwrap();
    let straight = Affine::translation([0.0; 3]).unwrap();
    let (low, high) = ([-1.0, -0.5, -0.25], [0.25, 0.5, 0.75]);
    let block = || Csg::cuboid(low, high).unwrap();
    let beside = || Csg::cuboid([high[0], -0.375, -0.5], [1.0, 0.25, 0.5]).unwrap();
    let pin = || Csg::cylinder(0.3, -1.0, 1.0).unwrap();
    let bored = || block().difference(&pin()).unwrap();
    for (a, b) in [(block(), beside()), (bored(), pin()), (block(), block().complement())] {
        for placement in [&straight, &turned] {
            let [a, b] = [&a, &b].map(|csg| csg.placed(placement).unwrap());
            let (lower, upper, splits) = volume(&Csg::intersection_of([a, b]).unwrap());
            assert!((lower, upper) == (0.0, 0.0) && splits < 500, "{lower} to {upper}, {splits} splits");
        }
    }
    // A slight overlap is an overlap.
    let into = Csg::cuboid([high[0] - 1e-9, -0.375, -0.5], [1.0, 0.25, 0.5]).unwrap();
    let (lower, upper, _) = volume(&Csg::intersection_of([block(), into]).unwrap());
    assert!(lower > 0.0 && upper < 1e-9, "{lower} to {upper}");
}
