//! The enclosures of boundaries in cells that solids provide, against exact arithmetic.

use leafless::lattice::MAX_DEPTH;
use leafless::solid::{Ask, Enclosure, GradientRange, Slab, TangentBalls, Transform};
use leafless::{
    Affine, AnySolid, Callback, Cell, Classifier, Csg, Error, Frame, Interval, Solid, SurfaceOptions,
    Verdict, build_extended,
};
use leafless_testkit::csg::{Maker, Model, Other, Point};
use leafless_testkit::exact::Exact;
use leafless_testkit::slabs::{bits, known, told};
use leafless_testkit::{Random, Way, alone, lattice_frame};

/// Frames whose planes are integers, exact doubles, or no doubles at all; far from the origin; and tiny.
fn frames(depth: u8) -> [Frame; 5] {
    let frame = |origin, edge| Frame::new(origin, edge, depth).unwrap();
    [
        lattice_frame(depth),
        frame([-1.0; 3], 2.0),
        frame([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0),
        frame([1e9 + 0.1, -3.3e8, 0.7], 0.044),
        frame([-1e-20 / 3.0, 1e-20, 0.0], 3e-20),
    ]
}

/// Returns the point of a cell with the coordinates `x` relative to its centre, in half edges.
fn at(frame: &Frame, cell: Cell, x: [f64; 3]) -> Point {
    let half = Exact::from(frame.edge()).times(&Exact::power_of_two(-(cell.level as i64) - 1));
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let steps = Exact::from((2 * cell.at[axis] as u64 + 1) as f64).plus(&x[axis].into());
        Exact::from(frame.origin()[axis]).plus(&steps.times(&half))
    });
    [x, y, z, Exact::from(1.0)]
}

/// A point of the open cell: anywhere, or near a face of a slab.
fn point(random: &mut Random, enclosure: &Enclosure) -> [f64; 3] {
    loop {
        let mut x = [0; 3].map(|_| random.between(-1.0, 1.0));
        let slabs: Vec<&Slab> = known(enclosure).collect();
        if random.below(4) != 0 {
            let slab = slabs[random.below(slabs.len() as u64) as usize];
            let offset = if random.below(2) == 0 { slab.inner } else { slab.outer };
            let axis = (0..3).max_by(|&a, &b| slab.normal[a].abs().total_cmp(&slab.normal[b].abs())).unwrap();
            let others: f64 = (0..3).filter(|&i| i != axis).map(|i| slab.normal[i] * x[i]).sum();
            x[axis] = (offset - others) / slab.normal[axis];
            for _ in 0..random.below(3) {
                x[axis] = if offset == slab.outer { x[axis].next_up() } else { x[axis].next_down() };
            }
        }
        if x.iter().all(|c| c.abs() < 1.0) {
            return x;
        }
    }
}

/// Numbers of queried cells, of cells with an enclosure, and of points decided as inside and outside.
#[derive(Debug, Default)]
struct Found {
    cells: u64,
    enclosed: u64,
    /// Number of cells with more than one slab, and number of cells with an unknown side.
    several: u64,
    one_sided: u64,
    inside: u64,
    outside: u64,
}

/// Walks to a finest cell, and checks every cell on the way.
fn walk(model: &Model, frame: &Frame, csg: &Csg, points: u64, random: &mut Random, found: &mut Found) {
    // (Placements may exceed the range of doubles.)
    let Ok(classifier) = csg.on(frame, &alone()) else { return };
    let opposite = csg.complement().on(frame, &alone()).unwrap();
    let ways = (Way::new(classifier.worker().unwrap()), Way::new(opposite.worker().unwrap()));
    let (Some(mut way), Some(mut opposite)) = ways else { return };
    loop {
        let cell = way.cell;
        let enclosure = way.worker.enclosure(cell, &way.part).unwrap();
        let complement = opposite.worker.enclosure(cell, &opposite.part).unwrap();
        let context = || format!("{cell:?}\n{enclosure:#?}\n{complement:#?}\n{frame:?}\n{model:#?}");
        assert_eq!(enclosure.map(|e| bits(&e.complement())), complement.as_ref().map(bits), "{}", context());
        found.cells += 1;
        if let Some(enclosure) = &enclosure {
            assert_eq!(bits(&enclosure.complement().complement()), bits(enclosure));
            assert!(known(enclosure).count() > 0, "{}", context());
            assert!(known(enclosure).all(|slab| slab.inner <= slab.outer), "{}", context());
            found.enclosed += 1;
            found.several += (known(enclosure).count() > 1) as u64;
            found.one_sided +=
                known(enclosure).any(|slab| slab.inner.is_infinite() || slab.outer.is_infinite()) as u64;
            for _ in 0..points {
                let x = point(random, enclosure);
                let told = told(enclosure, x);
                found.inside += (told > 0) as u64;
                found.outside += (told < 0) as u64;
                if told != 0 {
                    let sign = model.sign(&at(frame, cell, x));
                    assert!(told * sign >= 0, "{x:?} is told {told} and is {sign}: {}", context());
                }
            }
        }
        let mut children = way.children();
        if children.is_empty() {
            return;
        }
        // Half of the descents lead to places where surfaces meet.
        let slabs = |(cell, part): &(Cell, _)| {
            way.worker.enclosure(*cell, part).unwrap().map_or(0, |e| known(&e).count())
        };
        let next = match random.below(2) {
            0 => children.iter().map(slabs).enumerate().max_by_key(|&(_, count)| count).unwrap().0,
            _ => random.below(children.len() as u64) as usize,
        };
        (way.cell, way.part) = children.swap_remove(next);
        opposite.follow(way.cell);
    }
}

/// Checks random solids made by `make`, until `wanted` of their points are decided.
fn hold(name: &str, wanted: u64, make: impl Fn(&mut Maker<'_>) -> Model) {
    hold_as(name, wanted, make, |model, frame| model.csg(frame));
}

/// The same, with solids derived from the models by `solid`.
fn hold_as(
    name: &str,
    wanted: u64,
    make: impl Fn(&mut Maker<'_>) -> Model,
    solid: impl Fn(&Model, &Frame) -> Result<Csg, Error>,
) {
    let mut found = Found::default();
    for seed in 0.. {
        if found.inside + found.outside >= wanted {
            break;
        }
        assert!(seed < 10_000 + wanted, "{name}: {found:?}");
        let mut random = Random(seed ^ 0x5AB5);
        let depth = 1 + random.below(MAX_DEPTH as u64) as u8;
        let frame = frames(depth)[random.below(5) as usize];
        let aligned = random.below(3) == 0;
        let mut maker = Maker { random: &mut random, frame, aligned, others: false };
        let model = make(&mut maker);
        // The library refuses arguments out of range.
        let Ok(csg) = solid(&model, &frame) else { continue };
        walk(&model, &frame, &csg, 8, &mut random, &mut found);
    }
    println!("{name}: {found:?}");
    assert!(!name.starts_with("joined") || found.several > found.cells / 10, "{name}: {found:?}");
    // Both sides are reported. (Rotated balls lie partly outside the universe: 18 % of a million.)
    assert!(found.inside > wanted / 6 && found.outside > wanted / 6, "{name}: {found:?}");
}

/// Two to six half-spaces.
fn joined(maker: &mut Maker<'_>) -> Model {
    let count = 2 + maker.below(5);
    maker.joined(count)
}

/// A solid of another kind that provides slabs, beside half-spaces.
fn lone(maker: &mut Maker<'_>) -> Model {
    let (inner, beside) = (joined(maker), maker.half_space());
    let other = Model::Other(Other::Model(Box::new(inner)));
    match maker.below(4) {
        0 => Model::Union(vec![other, beside]),
        1 => Model::Difference(Box::new([beside, other])),
        2 => Model::Complement(Box::new(other)),
        _ => Model::Intersection(vec![other, beside]),
    }
}

/// Two to four operands, half-spaces and other solids that provide slabs, combined once or twice.
fn several(maker: &mut Maker<'_>) -> Model {
    let operand = |maker: &mut Maker<'_>| match maker.below(3) {
        0 => maker.half_space(),
        1 => Model::Other(Other::Model(Box::new(maker.half_space()))),
        _ => Model::Other(Other::Model(Box::new(maker.joined(2)))),
    };
    let join = |maker: &mut Maker<'_>| {
        let mut parts: Vec<Model> = (0..2 + maker.below(3)).map(|_| operand(maker)).collect();
        match maker.below(4) {
            0 => Model::Union(parts),
            1 => Model::Difference(Box::new([operand(maker), Model::Union(parts)])),
            2 => Model::Complement(Box::new(Model::Intersection(parts))),
            _ => {
                parts.truncate(3);
                Model::Intersection(parts)
            }
        }
    };
    match maker.below(3) {
        0 => {
            let (a, b) = (join(maker), join(maker));
            Model::Union(vec![a, b])
        }
        1 => {
            let (a, b) = (join(maker), join(maker));
            Model::Intersection(vec![a, b])
        }
        _ => join(maker),
    }
}

fn moved(maker: &mut Maker<'_>, make: impl Fn(&mut Maker<'_>) -> Model) -> Model {
    let model = make(maker);
    maker.placed(model)
}

/// A model rotated about a point, by a rotation of rational numbers rounded to doubles, and slightly scaled.
fn turned(maker: &mut Maker<'_>, make: impl Fn(&mut Maker<'_>) -> Model) -> Model {
    let (model, point) = (make(maker), maker.point());
    let scale = maker.random.between(0.8, 1.25);
    let rows = [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]].map(|row| {
        let [a, b, c] = row.map(|c| c * scale);
        [a, b, c, a * point[0] + b * point[1] + c * point[2]]
    });
    let about = [0, 1, 2].map(|axis| {
        let [a, b, c, moved] = rows[axis];
        [a, b, c, point[axis] - moved]
    });
    Model::Placed(Box::new(model), Affine::new(about).unwrap_or(Affine::IDENTITY))
}

/// Places a placed model with `Transform` from its own frame instead of in the expression. Some are
/// complements of complements.
fn by_transform(model: &Model, frame: &Frame) -> Result<Csg, Error> {
    let Model::Placed(model, placement) = model else { panic!("not placed") };
    let csg = model.csg(frame)?;
    let transform = |csg: &Csg| Csg::solid(AnySolid::new(Transform::of(csg.clone(), placement)));
    let is_even = placement.rows()[0][0].to_bits() & 1 == 0;
    Ok(if is_even { transform(&csg) } else { transform(&csg.complement()).complement() })
}

fn ball(maker: &mut Maker<'_>) -> Model {
    let radius = maker.frame.edge() * maker.random.between(0.4, 1.0);
    Model::Ellipsoid(maker.point(), [radius; 3])
}

/// A torus with a hole, around a point of the universe.
fn slim_torus(maker: &mut Maker<'_>) -> Model {
    let major = maker.frame.edge() * maker.random.between(0.2, 0.6);
    let minor = major * maker.random.between(0.1, 0.9);
    let to = maker.point();
    Model::Placed(Box::new(Model::Torus(major, minor)), Affine::translation(to).unwrap_or(Affine::IDENTITY))
}

/// A quadric as a host's gradient function.
fn by_gradient(model: &Model, _: &Frame) -> Result<Csg, Error> {
    let &Model::Quadric([xx, yy, zz, xy, yz, zx, x, y, z, constant]) = model else { panic!("no quadric") };
    // The library's function is positive inside.
    let range = move |low: [f64; 3], high: [f64; 3], [a, b, c, d]: [f64; 4]| {
        let (mut least, mut most, mut size) = (d, d, d.abs());
        for (axis, slope) in [a, b, c].into_iter().enumerate() {
            let ends = [slope * low[axis], slope * high[axis]];
            (least, most) = (least + ends[0].min(ends[1]), most + ends[0].max(ends[1]));
            size += ends[0].abs().max(ends[1].abs());
        }
        Interval::new(least - 1e-14 * size, most + 1e-14 * size).unwrap()
    };
    let gradient = move |min, max| {
        let rows = [[2.0 * xx, xy, zx, x], [xy, 2.0 * yy, yz, y], [zx, yz, 2.0 * zz, z]];
        rows.map(|row| range(min, max, row.map(|c| -c)))
    };
    let callback =
        Callback::new(|_, _| Ok(Verdict::Partial(()))).with_gradient(move |min, max, [p, q, r]| {
            let terms =
                [xx * p * p, yy * q * q, zz * r * r, xy * p * q, yz * q * r, zx * r * p, x * p, y * q, z * r];
            let (value, size) =
                terms.iter().fold((constant, constant.abs()), |(sum, size), t| (sum + t, size + t.abs()));
            let value = Interval::new(-value - 1e-14 * size, -value + 1e-14 * size).unwrap();
            Ok(Some(GradientRange { value, gradient: gradient(min, max) }))
        });
    Ok(Csg::solid(AnySolid::new(callback)))
}

/// A ball or a torus as a host's nearest-point function.
fn by_tangent(model: &Model, _: &Frame) -> Result<Csg, Error> {
    // The centre, the radius of the torus's middle circle, and the radius of its tube.
    let (centre, major, minor) = match model {
        &Model::Ellipsoid(centre, [radius, ..]) => (centre, 0.0, radius),
        Model::Placed(torus, to) => match **torus {
            Model::Torus(major, minor) => (to.rows().map(|row| row[3]), major, minor),
            _ => panic!("no torus"),
        },
        _ => panic!("neither"),
    };
    let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    let callback = Callback::new(|_, _| Ok(Verdict::Partial(()))).with_tangent(move |min, max, middle| {
        let off = [0, 1, 2].map(|axis| middle[axis] - centre[axis]);
        let rho = off[0].hypot(off[1]);
        let share = major / rho;
        let ring = if major > 0.0 { [off[0] * share, off[1] * share, 0.0] } else { [0.0; 3] };
        let away = [0, 1, 2].map(|axis| off[axis] - ring[axis]);
        let distance = length(away);
        if distance < 1e-3 * minor || major > 0.0 && rho < 1e-3 * major {
            return Ok(None);
        }
        let point = [0, 1, 2].map(|axis| centre[axis] + ring[axis] + away[axis] * (minor / distance));
        let size = length(centre) + length(middle) + major + minor;
        let reach = length([0, 1, 2].map(|axis| max[axis] - min[axis])) + distance + minor;
        Ok(Some(TangentBalls {
            point,
            normal: away,
            inner_curvature: 1.0 / minor,
            outer_curvature: if major > 0.0 { 1.0 / (major - minor) } else { -1.0 / minor },
            error: 1e-13 * (size + reach * reach / minor.min((major - minor).abs())),
        }))
    });
    Ok(Csg::solid(AnySolid::new(callback)))
}

/// An extended tree of the solid with few levels.
fn by_tree(model: &Model, frame: &Frame) -> Result<Csg, Error> {
    let shallow = frame.with_depth(frame.depth().min(4))?;
    let tree = build_extended(&model.csg(frame)?, &shallow, &SurfaceOptions::default(), &alone())?;
    Ok(Csg::solid(AnySolid::new(tree)))
}

fn every_producer(points: u64) {
    hold_as("extended trees of half-spaces", points, |maker| maker.half_space(), by_tree);
    hold_as("joined half-spaces, extended", points, |maker| maker.joined(3), by_tree);
    hold_as(
        "functions of half-spaces, extended",
        points,
        |maker| maker.function(|maker| maker.half_space()),
        by_tree,
    );
    hold("planes", points, |maker| maker.plane());
    hold("turned planes", points, |maker| {
        let plane = maker.plane();
        maker.placed(plane)
    });
    hold("quadrics", points, |maker| maker.quadric(false));
    hold("mixed quadrics", points, |maker| maker.quadric(true));
    hold("turned quadrics", points, |maker| {
        let quadric = maker.quadric(false);
        maker.placed(quadric)
    });
    hold("powers", points, |maker| maker.power());
    hold("turned powers", points, |maker| {
        let power = maker.power();
        maker.placed(power)
    });
    hold("tori", points, |maker| maker.torus());
    hold("turned tori", points, |maker| {
        let torus = maker.torus();
        maker.placed(torus)
    });
    hold("primitives", points, |maker| maker.primitive());
    hold("joined half-spaces", points, joined);
    hold("joined half-spaces, turned", points, |maker| {
        let joined = joined(maker);
        maker.placed(joined)
    });
    hold("other solids", points, lone);
    hold("joined other solids", points, several);
    hold_as("moved half-spaces", points, |maker| moved(maker, |maker| maker.half_space()), by_transform);
    hold_as("moved joined half-spaces", points, |maker| moved(maker, joined), by_transform);
    hold_as("moved primitives", points, |maker| moved(maker, |maker| maker.primitive()), by_transform);
    hold_as("gradients of a host", points, |maker| maker.quadric(true), by_gradient);
    hold_as("balls of a host", points, ball, by_tangent);
    hold_as("tori of a host", points, slim_torus, by_tangent);
    let by_placement = |model: &Model, frame: &Frame, host: fn(&Model, &Frame) -> Result<Csg, Error>| {
        let Model::Placed(model, placement) = model else { panic!("not placed") };
        host(model, frame)?.placed(placement)
    };
    hold_as(
        "moved gradients of a host",
        points,
        |maker| moved(maker, |maker| maker.quadric(true)),
        |model, frame| by_placement(model, frame, by_gradient),
    );
    hold_as(
        "turned balls of a host",
        points,
        |maker| turned(maker, ball),
        |model, frame| by_placement(model, frame, by_tangent),
    );
}

#[test]
fn enclosures_do_not_lie() {
    every_producer(4_000);
}

#[test]
#[ignore = "minutes"]
fn a_million_points_of_each_producer() {
    every_producer(1_000_000);
}

/// Returns a function's gradient at a point, and a bound of the sum of the magnitudes of second derivatives
/// over the cube of this half edge around the point.
fn derivatives(model: &Model, p: [f64; 3], half: f64) -> ([f64; 3], f64) {
    match model {
        Model::Plane(normal, _) => (*normal, 0.0),
        Model::Quadric([xx, yy, zz, xy, yz, zx, x, y, z, _]) => (
            [
                2.0 * xx * p[0] + xy * p[1] + zx * p[2] + x,
                xy * p[0] + 2.0 * yy * p[1] + yz * p[2] + y,
                zx * p[0] + yz * p[1] + 2.0 * zz * p[2] + z,
            ],
            2.0 * [xx, yy, zz, xy, yz, zx].map(|c| c.abs()).iter().sum::<f64>(),
        ),
        Model::Power(terms, _) => {
            let along = |axis: usize| {
                let (coefficient, centre, n) = terms[axis];
                let (u, n) = (p[axis] - centre, n as i32);
                let second = (n * (n - 1)) as f64 * (u.abs() + half).powi((n - 2).max(0));
                (coefficient * n as f64 * u.powi(n - 1), (coefficient * second).abs())
            };
            let [x, y, z] = [0, 1, 2].map(along);
            ([x.0, y.0, z.0], x.1 + y.1 + z.1)
        }
        Model::Torus(major, _) => {
            let rho = p[0].hypot(p[1]);
            let share = -2.0 * (rho - major) / rho;
            // For a curve around the axis it is 2 major / ρ − 2.
            let near = rho - 2f64.sqrt() * half;
            let around = if near > 2f64.sqrt() * half { 4.0 * major / near } else { f64::INFINITY };
            ([share * p[0], share * p[1], -2.0 * p[2]], 6.0 + around)
        }
        _ => panic!("not a half-space"),
    }
}

/// Checks that the gradients at random points of a cell lie within the cone.
fn cone_holds(model: &Model, enclosure: &Enclosure, centre: [f64; 3], half: f64, random: &mut Random) {
    let normal = enclosure.slabs[0].normal;
    let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    for _ in 0..4 {
        let point = centre.map(|c| c + half * random.between(-1.0, 1.0));
        // The function grows inward.
        let gradient = derivatives(model, point, 0.0).0.map(|c| -c);
        let cross = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            normal[j] * gradient[k] - normal[k] * gradient[j]
        });
        let dot: f64 = (0..3).map(|i| normal[i] * gradient[i]).sum();
        let angle = length(cross).atan2(dot);
        assert!(angle <= enclosure.cone + 1e-7, "{angle} {enclosure:?} {model:?}");
    }
}

/// Checks that slabs of single half-spaces are at most `share` times as wide as the second derivatives allow,
/// up to rounding.
fn tight(name: &str, share: f64, make: impl Fn(&mut Maker<'_>) -> Model) {
    let mut asked = 0;
    for seed in 0..400 {
        let mut random = Random(seed ^ 0x717);
        let frame = Frame::new([-1.0; 3], 2.0, 8).unwrap();
        let model = make(&mut Maker { random: &mut random, frame, aligned: seed % 3 == 0, others: false });
        let Ok(csg) = model.csg(&frame) else { continue };
        let Some(mut way) = Way::new(csg.on(&frame, &alone()).unwrap().worker().unwrap()) else { continue };
        loop {
            let cell = way.cell;
            let half = 0.5f64.powi(cell.level as i32);
            let centre = cell.at.map(|i| (2 * i + 1) as f64 * half - 1.0);
            let (gradient, second) = derivatives(&model, centre, half);
            let largest = |v: [f64; 3]| v.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
            // In units of the function, where its gradient is not nearly zero.
            if largest(gradient) > 1e-3 * half * second && second.is_finite() {
                let enclosure = way.worker.enclosure(cell, &way.part).unwrap().expect("a half-space");
                let slab = enclosure.slabs[0];
                let unit = largest(slab.normal) / (half * largest(gradient));
                cone_holds(&model, &enclosure, centre, half, &mut random);
                let (width, allowed) = (slab.outer - slab.inner, share * unit * half * half * second);
                let at = format!("{width} for {allowed}: {cell:?} {slab:?} {model:?}");
                assert!(width <= allowed * (1.0 + 1e-9) + 1e-11 * unit.max(1.0), "{name}: {at}");
                asked += 1;
            }
            if !way.descend(&mut random) {
                break;
            }
        }
    }
    assert!(asked > 1000, "{name}: {asked}");
}

#[test]
fn widths_are_of_second_order() {
    tight("planes", 0.0, |maker| maker.plane());
    tight("quadrics", 0.5, |maker| maker.quadric(false));
    tight("mixed quadrics", 1.0, |maker| maker.quadric(true));
    // (x − a)² + (x + y − b)² + (y + 2 z − c)² and the like have one sign.
    tight("definite quadrics", 0.5, |maker| {
        let rows = [0; 3].map(|_| [0; 3].map(|_| maker.random.between(-1.0, 1.0)));
        let through = maker.point();
        let mut c = [0.0; 10];
        for row in rows {
            for (k, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
                c[k] -= if i == j { 1.0 } else { 2.0 } * row[i] * row[j];
            }
            let value: f64 = (0..3).map(|i| row[i] * through[i]).sum();
            c[9] += value * value;
        }
        Model::Quadric(c)
    });
    tight("powers", 1.0, |maker| maker.power());
    tight("tori", 0.5, |maker| Model::Torus(maker.random.between(0.3, 0.7), maker.random.between(0.05, 0.3)));
}
