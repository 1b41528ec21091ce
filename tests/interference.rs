use leafless::*;
#[test]
fn balls() {
    for depth in [8, 10, 20] {
        let frame = Frame::new([0.0; 3], 128.0, depth).unwrap();
        let a = Ball::new([50.0; 3], 30.0).unwrap();
        for c in [86.0, 83.0, 84.0, 84.5, 80.0, 70.0] {
            let b = Ball::new([c; 3], 30.0).unwrap();
            let found = interference(&a, &b, &frame, f64::INFINITY, &Control::default()).unwrap();
            println!("{depth} {c} {found:?}");
        }
        let b = Ball::new([83.0; 3], 30.0).unwrap();
        let control = Control { max_splits: Some(20000), ..Control::default() };
        let found = interference(&a, &b, &frame, 5.0, &control).unwrap();
        println!("{depth} {found:?}");
    }
}
#[test]
fn gaps() {
    for depth in [8, 10, 14, 20] {
        let frame = Frame::new([0.0; 3], 128.0, depth).unwrap();
        let a = Ball::new([50.0; 3], 30.0).unwrap();
        for c in [86.0, 83.0, 84.0, 84.641] {
            let b = Ball::new([c; 3], 30.0).unwrap();
            let control = Control { max_splits: Some(20000), ..Control::default() };
            let found = clearance(&a, &b, &frame, 4.0 * frame.cell_size(), &control).unwrap();
            println!("{depth} {c} {found:?}");
        }
        let a = AxisBox::new([10.0; 3], [60.0; 3]).unwrap();
        let b = AxisBox::new([60.7, 1.0, 5.0], [80.0; 3]).unwrap();
        let control = Control { max_splits: Some(20000), ..Control::default() };
        let found = clearance(&a, &b, &frame, 4.0 * frame.cell_size(), &control).unwrap();
        println!("{depth} boxes {found:?}");
    }
}
