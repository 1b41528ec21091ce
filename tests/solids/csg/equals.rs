//! Operands of expressions that are equal are one: the same solid, without the doubt of coincident faces.

use leafless::query::surface_area;
use leafless::{Control, Csg, Frame, Rule, build, measure};

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
    // Of two nothing is left, and of three one.
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
