//! Any bytes as an expression of half-spaces on a small lattice. By exact arithmetic, no vertex of the
//! lattice and no centre contradicts the verdicts.

use crate::csg::{Model, Other, Point, Probe};
use crate::exact::Exact;
use leafless::op::{DexelOptions, octree_from_dexels};
use leafless::{Affine, Control, Error, Frame, Octree, Rule, Tag, build, complement, dexelize};

/// The most primitives of an expression, written out. (Exact arithmetic is slow, and few primitives find as
/// many errors as many do.)
const MOST: usize = 12;

/// The remaining bytes.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (&first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(first)
    }

    /// A number: mostly an eighth of a small integer, sometimes a difficult number, sometimes any double.
    fn number(&mut self) -> Option<f64> {
        Some(match self.byte()? {
            code @ 0..160 => (code as f64 - 64.0) / 8.0,
            code @ 160..176 => {
                let values = [
                    0.1,
                    1.0 / 3.0,
                    1e9 + 0.1,
                    2f64.powi(-64),
                    2f64.powi(64),
                    2f64.powi(-256),
                    2f64.powi(256),
                ];
                let value = values.get(code as usize / 2 - 80).copied().unwrap_or(1.0 + f64::EPSILON);
                if code % 2 == 0 { value } else { -value }
            }
            code @ 176..240 => 2f64.powi(code as i32 - 208),
            _ => {
                let (bytes, rest) = self.0.split_first_chunk::<8>()?;
                self.0 = rest;
                f64::from_le_bytes(*bytes)
            }
        })
    }

    fn numbers<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.number()?;
        }
        Some(numbers)
    }

    /// Reads as many numbers as a mask has bits; the others are zero.
    fn sparse<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mask = u16::from_le_bytes([self.byte()?, self.byte()?]);
        let mut numbers = [0.0; N];
        for (i, number) in numbers.iter_mut().enumerate() {
            if mask >> i & 1 != 0 {
                *number = self.number()?;
            }
        }
        Some(numbers)
    }

    fn planes(&mut self) -> Option<Vec<([f64; 3], f64)>> {
        let count = self.byte()? % 8;
        (0..count).map(|_| Some((self.numbers()?, self.number()?))).collect()
    }

    fn frame(&mut self) -> Option<Frame> {
        let code = self.byte()?;
        let depth = if code.is_multiple_of(8) { 2 } else { 1 };
        match code / 8 % 4 {
            0 | 1 => Frame::new([0.0; 3], 8.0, depth).ok(),
            2 => Frame::new([-1.0; 3], 2.0, depth).ok(),
            _ => Frame::new(self.numbers()?, self.number()?.abs(), depth).ok(),
        }
    }

    /// Pushes a primitive, or the result of an operation on the models before it.
    fn step(&mut self, stack: &mut Vec<Model>) -> Option<()> {
        let code = self.byte()?;
        let pop = |stack: &mut Vec<Model>| stack.pop().unwrap_or(Model::Union(Vec::new()));
        let model = match code % 24 {
            0 => Model::Plane(self.numbers()?, self.number()?),
            1 => Model::Quadric(self.sparse()?),
            2 => Model::Cuboid(self.numbers()?, self.numbers()?),
            3 => Model::Ellipsoid(self.numbers()?, self.numbers()?),
            4 => Model::Ellipsoid(self.numbers()?, [self.number()?; 3]),
            5 => Model::Frustum(self.numbers()?, self.numbers()?),
            6 => {
                let mut terms = [(0.0, 0.0, 1); 3];
                for term in &mut terms {
                    *term = (self.number()?, self.number()?, 1 + self.byte()? as u32 % 8);
                }
                Model::Power(terms, self.number()?)
            }
            7 => Model::Torus(self.number()?, self.number()?),
            8 => Model::Wedge(self.numbers()?, self.number()?),
            9 => Model::Convex(self.planes()?),
            10 => {
                let corners = self.byte()? % 12;
                let polygon = (0..corners).map(|_| self.numbers()).collect::<Option<_>>()?;
                Model::Prism(polygon, self.numbers()?)
            }
            11 => Model::Other(Other::Cuboid(self.numbers()?, self.numbers()?)),
            12 => Model::Other(Other::Ball(self.numbers()?, self.number()?)),
            13..=15 => {
                let count = self.byte()? as usize % 5;
                let parts = stack.split_off(stack.len().saturating_sub(count));
                [Model::Union, Model::Intersection, Model::Xor][code as usize % 24 - 13](parts)
            }
            16 | 17 => {
                let (second, first) = (pop(stack), pop(stack));
                Model::Difference(Box::new([first, second]))
            }
            18 => Model::Complement(Box::new(pop(stack))),
            19 => stack.last().cloned().unwrap_or(Model::Intersection(Vec::new())),
            20 => Model::Other(Other::Model(Box::new(pop(stack)))),
            21 => {
                let rows: [f64; 12] = self.sparse()?;
                let rows = [0, 1, 2].map(|i| [rows[i], rows[3 + i], rows[6 + i], rows[9 + i]]);
                Model::Placed(Box::new(pop(stack)), Affine::new(rows).unwrap_or(Affine::IDENTITY))
            }
            _ => {
                // Axes to axes.
                let (code, offset) = (self.byte()? as usize, self.numbers::<3>()?);
                let mut rows = [[0.0; 4]; 3];
                for (i, row) in rows.iter_mut().enumerate() {
                    row[(i * (1 + code % 2) + code / 2 % 3) % 3] =
                        if code >> (3 + i) & 1 == 0 { 1.0 } else { -1.0 };
                    row[3] = offset[i];
                }
                Model::Placed(Box::new(pop(stack)), Affine::new(rows).unwrap_or(Affine::IDENTITY))
            }
        };
        stack.push(model);
        Some(())
    }
}

fn primitives(model: &Model) -> usize {
    match model {
        Model::Union(parts) | Model::Intersection(parts) | Model::Xor(parts) => {
            parts.iter().map(primitives).sum::<usize>() + 1
        }
        Model::Difference(pair) => pair.iter().map(primitives).sum(),
        Model::Complement(part) | Model::Placed(part, _) => primitives(part) + 1,
        Model::Other(Other::Model(model)) => primitives(model) + 1,
        Model::Prism(polygon, _) => polygon.len() + 2,
        Model::Convex(planes) => planes.len(),
        _ => 1,
    }
}

/// Reads an expression and a frame, and checks the library's verdicts.
pub fn csg(data: &[u8]) {
    let mut bytes = Bytes(data);
    let Some(frame) = bytes.frame() else { return };
    let mut stack = Vec::new();
    while bytes.step(&mut stack).is_some() {
        if stack.iter().map(primitives).sum::<usize>() > MOST {
            break;
        }
    }
    let model = match stack.len() {
        1 => stack.swap_remove(0),
        _ => Model::Xor(stack),
    };
    let csg = match model.csg(&frame) {
        Ok(csg) => csg,
        Err(Error::Argument { .. }) => return,
        Err(other) => panic!("{other}"),
    };
    let control = Control::threads(1);
    let made = |rule| match build(&csg, &frame, rule, &control) {
        Ok(tree) => Some(tree),
        // (Other moved solids may not decide points.)
        Err(Error::Limit { .. } | Error::NotSampled) => None,
        // (Moved as far as doubles allow.)
        Err(Error::Argument { name: "placement", .. }) => None,
        Err(other) => panic!("{other}"),
    };
    let Some(tree) = made(Rule::Certified) else { return };
    let other = build(&csg.complement(), &frame, Rule::Certified, &control).expect("as large");
    assert!(complement(tree.view(), &control).expect("memory") == other);
    let samples = made(Rule::Sampled);
    if let Some(samples) = &samples {
        for axis in 0..3 {
            let directions = [0, 1, 2].map(|a| a == axis);
            let options = DexelOptions { directions, ..DexelOptions::default() };
            let dexels = dexelize(&csg, &frame, &options, &control).expect("as much");
            dexels.view().check().expect("a sound model");
            let found = octree_from_dexels(dexels.view(), &control).expect("memory");
            // (Rays show nothing about points outside the universe.)
            let n = frame.cells();
            for i in 0..n * n * n {
                let at = [i % n, i / n % n, i / n / n];
                let [found, expected] = [&found, samples].map(|tree| tree.view().tag_at(at));
                assert_eq!(found, expected, "along {axis} at {at:?} {frame:?}\n{model:#?}");
            }
        }
    }
    for_each_point(&frame, |at| {
        let [x, y, z] = [0, 1, 2].map(|axis| Exact::half_plane(&frame, axis, at[axis]));
        let at_centre = at.iter().all(|k| k % 2 == 1);
        let point = [x, y, z, Exact::from(1.0)];
        let sign = model.sign(&point);
        contradicts(&tree, at, sign, &model);
        if let (true, Some(samples)) = (at_centre, &samples) {
            let inside = match sign {
                0 => model.sampled(&beside(point)),
                sign => Some(sign > 0),
            };
            let tag = samples.view().tag_at(at.map(|k| k / 2));
            if let Some(inside) = inside {
                assert_eq!(tag, if inside { Tag::Full } else { Tag::Empty }, "{at:?} {frame:?}\n{model:#?}");
            }
        }
    });
}

/// A point where the function is zero, and the point beside it. The numbers are long, and rarely needed.
fn beside(at: Point) -> Probe {
    let mut beside = at.clone();
    for (axis, coordinate) in beside[..3].iter_mut().enumerate() {
        *coordinate = coordinate.plus(&Exact::power_of_two(-20_000 - 3000 * axis as i64));
    }
    Probe { at, beside }
}

/// All vertices, centres, and middles of edges and faces of a lattice.
fn for_each_point(frame: &Frame, mut work: impl FnMut([u32; 3])) {
    let n = 2 * frame.cells() + 1;
    (0..n * n * n).for_each(|i| work([i % n, i / n % n, i / n / n]));
}

/// Compares all cells that meet at a point, in half cells, with the point's side.
fn contradicts(tree: &Octree, at: [u32; 3], sign: i32, model: &Model) {
    let lie = match sign {
        1 => Tag::Empty,
        -1 => Tag::Full,
        _ => return,
    };
    let n = tree.frame().cells();
    for corner in 0..8u32 {
        let cell = [0, 1, 2].map(|axis| (at[axis] + (corner >> axis & 1)).wrapping_sub(1) / 2);
        let touches = |axis: usize| at[axis] % 2 == 1 || (at[axis] + (corner >> axis & 1)) > 0;
        if (0..3).all(|axis| touches(axis) && cell[axis] < n) {
            assert_ne!(tree.view().tag_at(cell), lie, "{at:?} in {cell:?}: {:?}\n{model:#?}", tree.frame());
        }
    }
}
