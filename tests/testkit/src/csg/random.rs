//! Random expressions that interact with a frame.

use super::{Model, Other};
use crate::{Random, alone};
use leafless::{Affine, Frame, Rule, build};

pub struct Maker<'a> {
    pub random: &'a mut Random,
    pub frame: Frame,
    /// True if coordinates are multiples of half a cell and matrices take axes to axes. Then surfaces lie on
    /// lattice planes, and touch cells in vertices.
    pub aligned: bool,
    /// True if solids other than half-spaces occur.
    pub others: bool,
}

impl Maker<'_> {
    pub fn below(&mut self, end: u64) -> u64 {
        self.random.below(end)
    }

    fn coordinate(&mut self, axis: usize) -> f64 {
        let n = self.frame.cells() as f64;
        let cells = match self.aligned {
            true => (self.random.between(-0.3, 1.3) * 2.0 * n).round() / 2.0,
            false => self.random.between(-0.3, 1.3) * n,
        };
        self.frame.origin()[axis] + cells * self.frame.cell_size()
    }

    pub fn point(&mut self) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.coordinate(axis))
    }

    fn length(&mut self) -> f64 {
        let cells = self.random.between(0.05, 0.8) * self.frame.cells() as f64;
        self.frame.cell_size() * if self.aligned { (2.0 * cells).ceil() / 2.0 } else { cells }
    }

    fn factor(&mut self) -> f64 {
        if self.aligned { self.below(5) as f64 - 2.0 } else { self.random.between(-1.0, 1.0) }
    }

    fn corners(&mut self) -> ([f64; 3], [f64; 3]) {
        let min = self.point();
        (min, min.map(|c| c + self.length()))
    }

    fn normal_and_offset(&mut self) -> ([f64; 3], f64) {
        let normal = [self.factor(), self.factor(), self.factor()];
        if normal == [0.0; 3] {
            return self.normal_and_offset();
        }
        let p = self.point();
        (normal, -(0..3).map(|axis| normal[axis] * p[axis]).sum::<f64>())
    }

    pub fn plane(&mut self) -> Model {
        let (normal, offset) = self.normal_and_offset();
        Model::Plane(normal, offset)
    }

    /// A quadric through a random point, about a random centre.
    pub fn quadric(&mut self, mixed: bool) -> Model {
        let (centre, through) = (self.point(), self.point());
        let mut c = [0.0; 10];
        for i in 0..if mixed { 6 } else { 3 } {
            c[i] = self.factor();
        }
        // Some without a centre: paraboloids, parabolic cylinders.
        let tilt = if self.below(3) == 0 { [self.factor(), self.factor(), self.factor()] } else { [0.0; 3] };
        for axis in 0..3 {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            // The mixed product of an axis and the next is coefficient 3 + axis.
            let slope =
                2.0 * c[axis] * centre[axis] + c[3 + axis] * centre[next] + c[3 + last] * centre[last];
            c[6 + axis] = tilt[axis] * self.frame.edge() - slope;
        }
        let [x, y, z] = through;
        let products = [x * x, y * y, z * z, x * y, y * z, z * x, x, y, z];
        c[9] = -c.iter().zip(products).map(|(c, p)| c * p).sum::<f64>();
        if c[..9] == [0.0; 9] { self.quadric(mixed) } else { Model::Quadric(c) }
    }

    /// A torus around a point of the universe.
    pub fn torus(&mut self) -> Model {
        let edge = self.frame.edge();
        let (major, minor) = (edge * self.random.between(0.1, 0.5), edge * self.random.between(0.02, 0.6));
        self.moved(Model::Torus(major, minor))
    }

    /// A half-space of any kind.
    pub fn half_space(&mut self) -> Model {
        match self.below(6) {
            0 | 1 => self.plane(),
            2 => self.quadric(false),
            3 => self.quadric(true),
            4 => self.power(),
            _ => self.torus(),
        }
    }

    /// A function of two or three half-spaces that is neither an intersection nor a union of them: one
    /// half-space chooses between the others, one holds or both others do, two of three hold, or an odd
    /// number of them does.
    pub fn function(&mut self, mut half_space: impl FnMut(&mut Self) -> Model) -> Model {
        let [a, b, c] = [(); 3].map(|()| half_space(self));
        let and = |a: &Model, b: &Model| Model::Intersection(vec![a.clone(), b.clone()]);
        let not = |a: &Model| Model::Complement(Box::new(a.clone()));
        match self.below(6) {
            0 => Model::Xor(vec![a, b]),
            1 => Model::Xor(vec![a, b, c]),
            2 => Model::Union(vec![and(&a, &b), c]),
            3 => Model::Union(vec![and(&a, &c), and(&b, &not(&c))]),
            4 => Model::Union(vec![and(&a, &b), and(&a, &c), and(&b, &c)]),
            _ => Model::Intersection(vec![a, Model::Xor(vec![b, c])]),
        }
    }

    /// Several half-spaces combined by some operation.
    pub fn joined(&mut self, count: u64) -> Model {
        let mut model = self.half_space();
        for _ in 1..count {
            let other = self.half_space();
            model = match self.below(5) {
                0 => Model::Union(vec![model, other]),
                1 => Model::Intersection(vec![other, model]),
                2 => Model::Difference(Box::new([model, other])),
                3 => Model::Difference(Box::new([other, model])),
                _ => Model::Complement(Box::new(Model::Union(vec![model, other]))),
            };
        }
        model
    }

    pub fn primitive(&mut self) -> Model {
        match self.below(13) {
            0 => self.plane(),
            1 => self.quadric(false),
            2 => self.quadric(true),
            3 => {
                let (min, max) = self.corners();
                Model::Cuboid(min, max)
            }
            4 => Model::Ellipsoid(self.point(), [self.length(); 3]),
            5 => Model::Ellipsoid(self.point(), [self.length(), self.length(), self.length()]),
            6 => self.power(),
            7 => Model::Convex((0..2 + self.below(6)).map(|_| self.normal_and_offset()).collect()),
            8 => Model::Host(self.point(), self.length()),
            9 => {
                let (major, other) = (self.length(), self.length());
                let minor = if self.below(3) == 0 { major } else { other };
                self.moved(Model::Torus(major, minor))
            }
            10 => {
                let size = [self.length(), self.length(), self.length()];
                let top = if self.below(3) == 0 { 0.0 } else { self.length() };
                self.moved(Model::Wedge(size, top))
            }
            11 => self.prism(),
            _ => {
                let (radius, low) = (self.length(), self.coordinate(2));
                let mut radii = [radius, [radius, 0.0, self.length()][self.below(3) as usize]];
                if self.below(2) == 0 {
                    radii.reverse();
                }
                let frustum = Model::Frustum(radii, [low, low + self.length()]);
                self.moved(frustum)
            }
        }
    }

    /// Moves a model from the origin into the universe.
    pub fn moved(&mut self, model: Model) -> Model {
        match Affine::translation(self.point()) {
            Ok(placement) => Model::Placed(Box::new(model), placement),
            Err(_) => model,
        }
    }

    /// A power of moderate size in the universe, through a random point.
    pub fn power(&mut self) -> Model {
        let (centre, through) = (self.point(), self.point());
        let terms = [0, 1, 2].map(|axis| {
            let exponent = 1 + self.below(6) as u32;
            let size = 2f64.powi(self.frame.edge().log2().round() as i32);
            (self.factor() / size.powi(exponent as i32), centre[axis], exponent)
        });
        let along = |axis: usize| {
            let (coefficient, centre, exponent) = terms[axis];
            coefficient * (through[axis] - centre).powi(exponent as i32)
        };
        Model::Power(terms, -(along(0) + along(1) + along(2)))
    }

    fn prism(&mut self) -> Model {
        let (middle, low) = (self.point(), self.coordinate(2));
        let corners = 3 + self.below(8);
        let polygon = (0..corners).map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / corners as f64).sin_cos();
            let radius = self.length();
            let grid = |axis: usize, by: f64| match self.aligned {
                // To whole cells, from a corner of the universe.
                true => {
                    let (origin, cell) = (self.frame.origin()[axis], self.frame.cell_size());
                    origin + ((middle[axis] + by - origin) / cell).round() * cell
                }
                false => middle[axis] + by,
            };
            [grid(0, radius * cos), grid(1, radius * sin)]
        });
        Model::Prism(polygon.collect(), [low, low + self.length()])
    }

    /// A placement that leaves the universe about where it is.
    pub fn placement(&mut self) -> Affine {
        loop {
            let mut rows = [[0.0; 4]; 3];
            if self.aligned {
                let shift = self.below(3) as usize;
                let swap = self.below(2) as usize;
                for i in 0..3 {
                    let scale = [1.0, 1.0, 1.0, 0.5, 2.0][self.below(5) as usize];
                    let column = if swap == 1 { 2 - i } else { i };
                    rows[i][(column + shift) % 3] = if self.below(2) == 0 { scale } else { -scale };
                }
            } else {
                for (i, row) in rows.iter_mut().enumerate() {
                    (0..3).for_each(|j| row[j] = self.random.between(-0.6, 0.6));
                    row[i] += if self.random.below(2) == 0 { 1.0 } else { -1.0 };
                }
            }
            let (from, to) = (self.point(), self.point());
            for (row, to) in rows.iter_mut().zip(to) {
                row[3] = to - (0..3).map(|j| row[j] * from[j]).sum::<f64>();
            }
            match Affine::new(rows) {
                Ok(placement) => return placement,
                Err(_) if self.frame.edge() < 1e-9 => return Affine::IDENTITY,
                Err(_) => {}
            }
        }
    }

    /// Returns the model at another place.
    pub fn placed(&mut self, model: Model) -> Model {
        Model::Placed(Box::new(model), self.placement())
    }

    pub fn other(&mut self) -> Other {
        match self.below(7) {
            0 => {
                let (min, max) = self.corners();
                Other::Cuboid(min, max)
            }
            1 => Other::Ball(self.point(), self.length()),
            2 => {
                let low = self.coordinate(2);
                Other::Slab(low, low + self.length())
            }
            3 => Other::Tetrahedron([self.point(), self.point(), self.point(), self.point()]),
            4 => {
                let depth = 1 + self.below(6) as u8;
                let own = self.frame.with_depth(depth).unwrap();
                let rule = [Rule::Certified, Rule::Sampled, Rule::Inner][self.below(3) as usize];
                let others = std::mem::replace(&mut self.others, false);
                let csg = self.expression(1).csg(&own);
                self.others = others;
                match csg {
                    Ok(csg) => Other::Octree(Box::new(build(&csg, &own, rule, &alone()).unwrap())),
                    Err(_) => self.other(),
                }
            }
            5 => {
                let (min, max) = self.corners();
                let own = Frame::new(min.map(|c| c - self.frame.edge()), 3.5 * self.frame.edge(), 8).unwrap();
                Other::Moved(Box::new(Other::Cuboid(min, max)), own, self.placement())
            }
            _ => Other::Model(Box::new(self.expression(1))),
        }
    }

    /// An expression with at most `height` nested operations.
    pub fn expression(&mut self, height: u32) -> Model {
        let parts = |maker: &mut Self| {
            let count = [2, 2, 3, 4, 1, 0][maker.below(if height > 1 { 6 } else { 4 }) as usize];
            (0..count).map(|_| maker.expression(height - 1)).collect()
        };
        if height == 0 {
            return match self.others && self.below(2) == 0 {
                true => Model::Other(self.other()),
                false => self.primitive(),
            };
        }
        match self.below(7) {
            0 => Model::Union(parts(self)),
            1 => Model::Intersection(parts(self)),
            2 => Model::Xor(parts(self)),
            3 => Model::Difference(Box::new([self.expression(height - 1), self.expression(height - 1)])),
            4 => Model::Complement(Box::new(self.expression(height - 1))),
            5 if !self.others => {
                let part = self.expression(height - 1);
                self.placed(part)
            }
            _ => self.expression(height - 1),
        }
    }
}
