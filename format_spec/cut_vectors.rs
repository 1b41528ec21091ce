//! Test vectors with cuts. This file builds the sections number by number, and decides points in exact
//! arithmetic. Neither comes from the library.

use super::{
    APPLICATION, CERTIFIED, F32, F64, Field, List, Model, NEWER, Parts, RECORD, ScalarType, Section, U8, U16,
    U32, U64, Valid, Way, cell_of, checksum, example, field, hex, integer, mix, noise, one_value, points,
    put, section,
};
use leafless::{Cell, Frame, Tag};
use num_bigint::{BigInt, Sign};
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

/// Kinds of sections.
const HEADS: u64 = 11;
const IDS: u64 = 12;
const BLOCKS: u64 = 13;
const FIRST: u64 = 14;
const SURFACES: u64 = 15;
const NUMBERS: u64 = 20;
const PLACEMENTS: u64 = 21;
const ORIGINS: u64 = 22;
const CELL_SLABS: u64 = 23;
const GROUPS: u64 = 24;
const MOMENTS: u64 = 25;

/// The kinds with their names, types and components.
const KINDS: [(u64, &str, (u64, u64)); 11] = [
    (HEADS, "cut heads", (U8, 1)),
    (IDS, "cut ids", (U8, 1)),
    (BLOCKS, "cut blocks", (U32, 2)),
    (FIRST, "cut first", (U32, 1)),
    (SURFACES, "surfaces", (U32, 4)),
    (NUMBERS, "surface numbers", (F64, 1)),
    (PLACEMENTS, "placements", (RECORD, 13)),
    (ORIGINS, "origins", (U64, 2)),
    (CELL_SLABS, "cell slabs", (U64, 2)),
    (GROUPS, "cell slab groups", (U64, 3)),
    (MOMENTS, "moments", (F64, 23)),
];

/// True if sections of a kind belong to cuts.
pub fn is_of_cuts(kind: u64) -> bool {
    KINDS.iter().any(|&(own, ..)| own == kind)
}

// ---- models ---------------------------------------------------------------------------------------------

/// The kinds of surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Plane = 0,
    Quadric = 1,
    Powers = 2,
    Torus = 3,
    Slab = 4,
}

impl Kind {
    fn name(self) -> &'static str {
        ["plane", "quadric", "powers", "torus", "slab"][self as usize]
    }
}

/// Rows of an affine map.
type Map = [[f64; 4]; 3];

/// A slab stored as a slab of a cell: the values that its words encode.
#[derive(Debug, Clone, Copy)]
struct CellSlab {
    cell: Cell,
    /// The slab's index among the cell's slabs.
    index: u64,
    axis: usize,
    is_negative: bool,
    /// The components of the normal along the next two axes, in units of 2^-15.
    others: [i64; 2],
    /// The inner offset, in steps from the cell's centre.
    offset: i64,
    /// The width, in steps.
    width: u64,
    /// The exponent of the step: a step is 2^-step of the universe's edge.
    step: u64,
}

impl CellSlab {
    fn words(&self) -> [u64; 2] {
        let Cell { level, at } = self.cell;
        let mut home = 1;
        for l in (0..level).rev() {
            let octant = (0..3).map(|axis| u64::from(at[axis] >> l & 1) << axis).sum::<u64>();
            home = 8 * home + octant;
        }
        let [a, b] = self.others.map(|own| own as u64 & 0xFFFF);
        let offset = (self.offset as u64 & 0x7FFFF) << 32;
        let planes = a | b << 16 | offset | self.width << 51 | self.step << 55;
        [home | self.index << 61, planes | (self.axis as u64) << 61 | u64::from(self.is_negative) << 63]
    }

    /// Returns the normal and the two offsets in units of the universe. All are exact multiples of 2^-50.
    fn numbers(&self) -> [f64; 5] {
        let unit = 1i128 << 50;
        let mut normal = [0i128; 3];
        normal[self.axis] = if self.is_negative { -unit } else { unit };
        for k in 0..2 {
            normal[(self.axis + 1 + k) % 3] = i128::from(self.others[k]) * (unit >> 15);
        }
        let centre = |axis: usize| i128::from(2 * self.cell.at[axis] + 1) * (unit >> (self.cell.level + 1));
        let step = unit >> self.step;
        let inner =
            (0..3).map(|i| normal[i] * centre(i) / unit).sum::<i128>() + i128::from(self.offset) * step;
        let outer = inner + i128::from(self.width) * step;
        let exactly = |n: i128| {
            assert!(n as f64 as i128 == n);
            n as f64 / unit as f64
        };
        let [x, y, z] = normal;
        [x, y, z, inner, outer].map(exactly)
    }
}

/// A surface. Each of its numbers is given by the doubles that sum up to it.
#[derive(Clone)]
pub struct Surface {
    kind: Kind,
    numbers: Vec<Vec<f64>>,
    /// The maps, with the outermost first.
    maps: Vec<Map>,
    /// The origin of a slab, and the slab's number there.
    origin: Option<([u64; 2], u64)>,
    /// The slab of a cell, if the surface is stored as one. The map of the universe places it.
    cell: Option<CellSlab>,
}

impl Surface {
    fn new(kind: Kind, numbers: &[f64]) -> Surface {
        let number = |&c: &f64| if c == 0.0 { vec![] } else { vec![c] };
        Surface {
            kind,
            numbers: numbers.iter().map(number).collect(),
            maps: vec![],
            origin: None,
            cell: None,
        }
    }

    fn plane(a: f64, b: f64, c: f64, d: f64) -> Surface {
        Surface::new(Kind::Plane, &[a, b, c, d])
    }

    fn slab(normal: [f64; 3], inner: f64, outer: f64) -> Surface {
        Surface::new(Kind::Slab, &[normal[0], normal[1], normal[2], inner, outer])
    }

    /// A ball, positive inside.
    fn ball(centre: [f64; 3], radius: f64) -> Surface {
        let [x, y, z] = centre;
        let constant = radius * radius - x * x - y * y - z * z;
        let linear = [2.0 * x, 2.0 * y, 2.0 * z];
        let [x, y, z] = linear;
        Surface::new(Kind::Quadric, &[-1.0, -1.0, -1.0, 0.0, 0.0, 0.0, x, y, z, constant])
    }

    /// Returns the surface with the number `i` as the sum of these doubles.
    fn with(mut self, i: usize, doubles: &[f64]) -> Surface {
        self.numbers[i] = doubles.to_vec();
        self
    }

    fn placed(mut self, maps: &[Map]) -> Surface {
        self.maps = maps.to_vec();
        self
    }

    /// A slab of a cell; `origin` is 0 for none.
    fn of_cell(frame: &Frame, slab: CellSlab, origin: u64) -> Surface {
        let ([x, y, z], edge) = (frame.origin(), frame.edge());
        let map = [[edge, 0.0, 0.0, x], [0.0, edge, 0.0, y], [0.0, 0.0, edge, z]];
        let plain = Surface::new(Kind::Slab, &slab.numbers()).placed(&[map]);
        let own = if origin == 0 { plain } else { plain.of(origin, 1 << 63 | slab.words()[0]) };
        Surface { cell: Some(slab), ..own }
    }

    fn of(mut self, origin: u64, number: u64) -> Surface {
        self.origin = Some(([mix(origin), mix(origin + 1)], number));
        self
    }

    /// Returns whether the function is positive at a point. It is `Err` if the sign is unknown, or if the
    /// point lies on the surface.
    fn side(&self, point: &[Q; 3]) -> Result<bool, ()> {
        let mut p = point.clone();
        for map in &self.maps {
            p = inverse(map, &p);
        }
        let n: Vec<Q> = self.numbers.iter().map(|doubles| doubles.iter().map(|&c| Q::of(c)).sum()).collect();
        let [x, y, z] = &p;
        let product = |factors: &[&Q]| factors.iter().fold(Q::of(1.0), |all, &one| all * one.clone());
        let value = match self.kind {
            Kind::Plane => product(&[&n[0], x]) + product(&[&n[1], y]) + product(&[&n[2], z]) + n[3].clone(),
            Kind::Quadric => {
                let pairs = [[x, x], [y, y], [z, z], [x, y], [y, z], [z, x]];
                let square: Q =
                    pairs.iter().zip(&n).map(|(&[s, t], coefficient)| product(&[coefficient, s, t])).sum();
                let linear: Q =
                    p.iter().zip(&n[6..]).map(|(s, coefficient)| product(&[coefficient, s])).sum();
                square + linear + n[9].clone()
            }
            Kind::Powers => {
                let term = |axis: usize| {
                    let base = p[axis].clone() - n[3 * axis + 1].clone();
                    let exponent = self.numbers[3 * axis + 2][0] as usize;
                    n[3 * axis].clone() * (0..exponent).fold(Q::of(1.0), |all, _| all * base.clone())
                };
                term(0) + term(1) + term(2) + n[9].clone()
            }
            Kind::Torus => {
                let [major, square, scale, shift] = &n[..] else { panic!("four numbers") };
                let plane = product(&[scale, scale]) * (product(&[x, x]) + product(&[y, y]));
                let height = product(&[scale, z]) + shift.clone();
                // q − (ρ − R)² − h² = 2 R ρ − (ρ² + R² + h² − q)
                let rest =
                    plane.clone() + product(&[major, major]) + product(&[&height, &height]) - square.clone();
                let twice = product(&[major, major]) * plane * Q::of(4.0);
                if rest.sign() < 0 { Q::of(1.0) } else { twice - product(&[&rest, &rest]) }
            }
            Kind::Slab => {
                let along = product(&[&n[0], x]) + product(&[&n[1], y]) + product(&[&n[2], z]);
                let (below, above) = (n[3].clone() - along.clone(), n[4].clone() - along);
                match (below.sign(), above.sign()) {
                    (1, _) => Q::of(1.0),
                    (_, -1) => Q::of(-1.0),
                    _ => Q::of(0.0),
                }
            }
        };
        match value.sign() {
            0 => Err(()),
            sign => Ok(sign > 0),
        }
    }
}

/// The knowledge about a cell.
#[derive(Clone)]
pub enum Cut {
    /// None: the cell was given up.
    Nothing,
    /// Surfaces of the model, and a truth table. Bit m is set if a point is inside when exactly the surfaces
    /// whose bits m has are positive there.
    Table(Vec<usize>, u8),
    /// The knowledge about the children.
    Split,
}

/// The knowledge about the PARTIAL cells of a tree, and below them.
#[derive(Clone)]
pub struct Cuts {
    surfaces: Vec<Surface>,
    cut: Arc<dyn Fn(Cell) -> Cut + Send + Sync>,
    /// A point, and both ends of the volume and of the first and second moments about the point.
    moments: Option<[f64; 23]>,
}

impl Cuts {
    fn new(surfaces: Vec<Surface>, cut: impl Fn(Cell) -> Cut + Send + Sync + 'static) -> Cuts {
        Cuts { surfaces, cut: Arc::new(cut), moments: None }
    }

    fn moments(self, moments: [f64; 23]) -> Cuts {
        Cuts { moments: Some(moments), ..self }
    }

    /// Gives all cells one table of all surfaces, of which there are up to three.
    fn everywhere(surfaces: Vec<Surface>, table: u8) -> Cuts {
        let all: Vec<usize> = (0..surfaces.len()).collect();
        Cuts::new(surfaces, move |_| Cut::Table(all.clone(), table))
    }
}

/// The tables of one surface.
const POSITIVE: u8 = 0xAA;
const NEGATIVE: u8 = 0x55;

/// Returns a table. Each of its bits follows from three signs.
fn table(inside: impl Fn(bool, bool, bool) -> bool) -> u8 {
    (0..8u8).fold(0, |all, m| all | u8::from(inside(m & 1 != 0, m & 2 != 0, m & 4 != 0)) << m)
}

// ---- rational numbers -----------------------------------------------------------------------------------

/// A quotient of two integers with a positive denominator.
#[derive(Debug, Clone)]
struct Q(BigInt, BigInt);

impl Q {
    fn new(numerator: BigInt, denominator: BigInt) -> Q {
        let both =
            numerator.trailing_zeros().unwrap_or(u64::MAX).min(denominator.trailing_zeros().unwrap_or(0));
        let (numerator, denominator) = (numerator >> both.min(1 << 20), denominator >> both.min(1 << 20));
        match denominator.sign() {
            Sign::Minus => Q(-numerator, -denominator),
            Sign::Plus => Q(numerator, denominator),
            Sign::NoSign => panic!("a quotient by zero"),
        }
    }

    fn of(value: f64) -> Q {
        Q::new(integer(value), BigInt::from(1) << 1074)
    }

    fn sign(&self) -> i32 {
        match self.0.sign() {
            Sign::Minus => -1,
            Sign::NoSign => 0,
            Sign::Plus => 1,
        }
    }
}

impl std::ops::Add for Q {
    type Output = Q;

    fn add(self, other: Q) -> Q {
        Q::new(self.0 * &other.1 + other.0 * &self.1, self.1 * other.1)
    }
}

impl std::ops::Sub for Q {
    type Output = Q;

    fn sub(self, other: Q) -> Q {
        self + Q(-other.0, other.1)
    }
}

impl std::ops::Mul for Q {
    type Output = Q;

    fn mul(self, other: Q) -> Q {
        Q::new(self.0 * other.0, self.1 * other.1)
    }
}

impl std::iter::Sum for Q {
    fn sum<I: Iterator<Item = Q>>(all: I) -> Q {
        all.fold(Q::of(0.0), |sum, one| sum + one)
    }
}

/// Returns the point that a map takes to `p`.
fn inverse(map: &Map, p: &[Q; 3]) -> [Q; 3] {
    let m = map.map(|row| row.map(Q::of));
    let q = [0, 1, 2].map(|i| p[i].clone() - m[i][3].clone());
    // Cramer's rule.
    let minor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c].clone() * m[b][d].clone() - m[a][d].clone() * m[b][c].clone()
    };
    let determinant: Q = (0..3).map(|j| m[0][j].clone() * minor(0, j)).sum();
    [0, 1, 2].map(|j| {
        let sum: Q = (0..3).map(|i| q[i].clone() * minor(i, j)).sum();
        Q::new(sum.0 * &determinant.1, sum.1 * &determinant.0)
    })
}

// ---- sections -------------------------------------------------------------------------------------------

/// The stored form of cuts.
#[derive(Default)]
struct Stored {
    heads: Vec<u8>,
    ids: Vec<u64>,
    blocks: Vec<[u32; 2]>,
    first: Vec<u32>,
    /// The model's surfaces in the order of the file. The first `records` of them are stored as records.
    order: Vec<usize>,
    records: usize,
    /// For each record, the place of its map and the place of its origin.
    places: Vec<[u64; 2]>,
    placements: Vec<(Map, u64)>,
    origins: Vec<[u64; 2]>,
    /// For each group of slabs of cells, its origin and its end.
    groups: Vec<([u64; 2], u64)>,
}

/// Returns the number of bits of an id for this number of surfaces.
fn bits_of_an_id(surfaces: usize) -> usize {
    (0..).find(|&bits| 1 << bits >= surfaces).map_or(1, |bits: usize| bits.max(1))
}

/// Packs numbers into a stream of bits.
fn packed(numbers: &[u64], bits: usize) -> Vec<u8> {
    let mut bytes = vec![0; (numbers.len() * bits).div_ceil(8)];
    for (i, number) in numbers.iter().enumerate() {
        for k in (0..bits).filter(|k| number >> k & 1 != 0) {
            bytes[(i * bits + k) / 8] |= 1 << ((i * bits + k) % 8);
        }
    }
    bytes
}

/// Returns the same table for surfaces in another order. The i-th surface was at the i-th place of `order`
/// before.
fn permuted(table: u8, order: &[usize]) -> u8 {
    let low = (1 << order.len()) - 1;
    (0..8u8).fold(0, |all, m| {
        let before =
            order.iter().enumerate().fold(m & !low, |signs, (to, &from)| signs | (m >> to & 1) << from);
        all | (table >> before & 1) << m
    })
}

impl Model {
    /// Returns the tag of a cell in the canonical tree.
    fn canonical(&self, cell: Cell) -> Tag {
        self.count(cell, &mut vec![[0; 3]; self.frame.depth() as usize + 1])
    }

    /// Returns the PARTIAL cells of the tree in their order, and the number of them before each element and
    /// brick.
    fn partial_cells(&self) -> (Vec<Cell>, Vec<u32>) {
        let (mut cells, mut first) = (vec![], vec![]);
        // The root of odd depth has one octant, the universe.
        let mut elements = VecDeque::new();
        match self.canonical(Cell::ROOT) {
            Tag::Partial => cells.push(Cell::ROOT),
            Tag::Branch if self.frame.depth().is_multiple_of(2) => elements.push_back(Some(Cell::ROOT)),
            Tag::Branch => elements.push_back(None),
            _ => {}
        }
        while let Some(element) = elements.pop_front() {
            first.push(cells.len() as u32);
            let octants = element.map_or(vec![Cell::ROOT], |cell| (0..8).map(|k| cell.child(k)).collect());
            for octant in octants {
                match self.canonical(octant) {
                    Tag::Partial => cells.push(octant),
                    Tag::Branch => {
                        for child in (0..8).map(|k| octant.child(k)) {
                            match self.canonical(child) {
                                Tag::Partial => cells.push(child),
                                Tag::Branch => elements.push_back(Some(child)),
                                _ => {}
                            }
                        }
                    }
                    _ => {}
                }
            }
        }
        first.push(cells.len() as u32);
        (cells, first)
    }

    fn stored(&self, cuts: &Cuts) -> Stored {
        let (cells, first) = self.partial_cells();
        let mut all = Stored { first, ..Stored::default() };
        // The surfaces of all tables in the order of their first use; after that, those of records first,
        // then group by group.
        let mut met: Vec<usize> = vec![];
        let mut walk = VecDeque::from(cells.clone());
        while let Some(cell) = walk.pop_front() {
            match (cuts.cut)(cell) {
                Cut::Nothing => {}
                Cut::Split => walk.extend((0..8).map(|k| cell.child(k))),
                Cut::Table(surfaces, _) => {
                    for surface in surfaces {
                        if !met.contains(&surface) {
                            met.push(surface);
                        }
                    }
                }
            }
        }
        let (of_cells, records): (Vec<usize>, Vec<usize>) =
            met.into_iter().partition(|&i| cuts.surfaces[i].cell.is_some());
        all.records = records.len();
        all.order = records;
        let origin = |i: usize| cuts.surfaces[i].origin.map_or([0; 2], |(origin, _)| origin);
        for &slab in &of_cells {
            if all.groups.iter().all(|&(own, _)| own != origin(slab)) {
                all.groups.push((origin(slab), 0));
            }
        }
        for (own, end) in &mut all.groups {
            all.order.extend(of_cells.iter().filter(|&&slab| origin(slab) == *own));
            *end = (all.order.len() - all.records) as u64;
        }
        let mut cells = VecDeque::from(cells);
        let mut splits = 0;
        while let Some(cell) = cells.pop_front() {
            if all.heads.len().is_multiple_of(32) {
                all.blocks.push([all.ids.len() as u32, splits]);
            }
            all.heads.push(match (cuts.cut)(cell) {
                Cut::Nothing => 0,
                Cut::Split => {
                    splits += 1;
                    cells.extend((0..8).map(|k| cell.child(k)));
                    0xFF
                }
                Cut::Table(surfaces, table) => {
                    let number = |surface: usize| all.order.iter().position(|&own| own == surface);
                    let mut order: Vec<usize> = (0..surfaces.len()).collect();
                    order.sort_by_key(|&i| number(surfaces[i]));
                    all.ids.extend(order.iter().map(|&i| number(surfaces[i]).expect("a number") as u64));
                    permuted(table, &order)
                }
            });
        }
        for &surface in &all.order[..all.records] {
            let surface = &cuts.surfaces[surface];
            let mut outer = 0;
            for map in &surface.maps {
                let is_it = |&(own, before): &(Map, u64)| (own, before) == (*map, outer);
                let place = all.placements.iter().position(is_it);
                let place = place.unwrap_or_else(|| {
                    all.placements.push((*map, outer));
                    all.placements.len() - 1
                });
                outer = place as u64 + 1;
            }
            let origin = surface.origin.map_or(0, |(origin, _)| {
                let place = all.origins.iter().position(|&own| own == origin).unwrap_or_else(|| {
                    all.origins.push(origin);
                    all.origins.len() - 1
                });
                place as u64 + 1
            });
            all.places.push([outer, origin]);
        }
        all
    }
}

impl Stored {
    /// Returns the number of bits of an id.
    fn width(&self) -> usize {
        bits_of_an_id(self.order.len())
    }

    fn sections(&self, cuts: &Cuts) -> Vec<Section> {
        let (mut records, mut words) = (vec![], vec![]);
        for (i, &[placement, origin]) in self.places.iter().enumerate() {
            let surface = &cuts.surfaces[self.order[i]];
            let mut counts: Vec<usize> = surface.numbers.iter().map(Vec::len).collect();
            let first = words.len() as u32;
            words.extend(surface.numbers.iter().flatten().map(|c| c.to_bits()));
            // The number of a slab, if it differs from its place.
            if let Some((_, number)) = surface.origin.filter(|&(_, number)| number != i as u64) {
                counts.push(1);
                words.push(number);
            }
            let terms = counts.iter().enumerate().map(|(i, &own)| (own as u32) << (3 * i)).sum::<u32>();
            let kind = surface.kind as u32 + 256 * origin as u32;
            records.extend([kind, terms, first, placement as u32].map(u32::to_le_bytes).concat());
        }
        let slabs = self.order[self.records..]
            .iter()
            .map(|&i| cuts.surfaces[i].cell.expect("a slab of a cell").words());
        let placement = |(map, outer): &(Map, u64)| {
            let bits = map.as_flattened().iter().map(|c| c.to_bits()).chain([*outer]);
            bits.flat_map(u64::to_le_bytes).collect::<Vec<_>>()
        };
        let bytes = [
            self.heads.clone(),
            packed(&self.ids, self.width()),
            self.blocks.iter().flatten().flat_map(|n| n.to_le_bytes()).collect(),
            self.first.iter().flat_map(|n| n.to_le_bytes()).collect(),
            records,
            words.iter().flat_map(|c| c.to_le_bytes()).collect(),
            self.placements.iter().flat_map(placement).collect(),
            self.origins.iter().flatten().flat_map(|n| n.to_le_bytes()).collect(),
            slabs.flatten().flat_map(u64::to_le_bytes).collect(),
            self.groups
                .iter()
                .flat_map(|&([low, high], end)| [low, high, end])
                .flat_map(u64::to_le_bytes)
                .collect(),
            cuts.moments.iter().flatten().flat_map(|c| c.to_le_bytes()).collect(),
        ];
        let sections = KINDS.iter().zip(bytes).filter(|(_, bytes)| !bytes.is_empty());
        sections.map(|(&(kind, _, element), bytes)| Section::new(kind, element, bytes)).collect()
    }
}

impl Parts {
    /// Adds the cuts of a model.
    pub(super) fn add_cuts(&mut self, model: &Model, cuts: &Cuts) {
        let stored = model.stored(cuts);
        if stored.heads.is_empty() {
            return;
        }
        put(&mut self.head, 10, 4, 2);
        self.sections.extend(stored.sections(cuts));
        self.sort();
    }
}

// ---- expected results -----------------------------------------------------------------------------------

impl Model {
    /// Returns the cuts' part of a text, as keys and values.
    pub(super) fn cut_facts(&self) -> Vec<(&'static str, String)> {
        let Some(cuts) = &self.cuts else { return vec![] };
        let stored = self.stored(cuts);
        let count = |of: u8| stored.heads.iter().filter(|&&head| head == of).count();
        let (none, splits) = (count(0), count(0xFF));
        let tables = stored.heads.len() - none - splits;
        let counts = [
            stored.order.len(),
            stored.placements.len(),
            stored.origins.len(),
            stored.order.len() - stored.records,
            stored.groups.len(),
        ];
        let counts = counts.map(|count| count.to_string()).join(" ");
        let mut facts = vec![("cuts", format!("{tables} {none} {splits} {counts}"))];
        for (i, &[placement, origin]) in stored.places.iter().enumerate() {
            let surface = &cuts.surfaces[stored.order[i]];
            let mut numbers: Vec<String> = vec![];
            for doubles in &surface.numbers {
                numbers.push(match &doubles[..] {
                    [] => "0".to_owned(),
                    doubles => doubles.iter().map(|&c| hex(c)).collect::<Vec<_>>().join(","),
                });
            }
            if surface.kind == Kind::Slab {
                numbers.push(origin.to_string());
                numbers.push(surface.origin.map_or(0, |(_, number)| number).to_string());
            }
            let numbers = numbers.join(" ");
            facts.push(("surface", format!("{i} {} {placement} {numbers}", surface.kind.name())));
        }
        for (i, (map, outer)) in stored.placements.iter().enumerate() {
            let entries = map.as_flattened().iter().map(|&c| hex(c)).collect::<Vec<_>>().join(" ");
            facts.push(("placement", format!("{i} {outer} {entries}")));
        }
        for (i, [low, high]) in stored.origins.iter().enumerate() {
            facts.push(("slab-origin", format!("{i} {low:016x} {high:016x}")));
        }
        for (i, &surface) in stored.order.iter().enumerate().skip(stored.records) {
            let slab = cuts.surfaces[surface].cell.expect("a slab of a cell");
            let Cell { level, at: [x, y, z] } = slab.cell;
            let numbers = slab.numbers().map(hex).join(" ");
            facts.push(("cell-slab", format!("{i} {level} {x} {y} {z} {} {numbers}", slab.index)));
        }
        for (i, ([low, high], end)) in stored.groups.iter().enumerate() {
            facts.push(("cell-slab-group", format!("{i} {low:016x} {high:016x} {end}")));
        }
        if let Some(numbers) = &cuts.moments {
            facts.push(("moments", numbers.map(hex).join(" ")));
        }
        facts
    }

    /// Returns the lines for points, with the cuts.
    pub(super) fn cut_points(&self) -> Vec<String> {
        let Some(cuts) = &self.cuts else { return vec![] };
        let (mut lines, mut counts) = (vec![], BTreeMap::new());
        let mut line = |point: [f64; 3], answer: &str| {
            let [x, y, z] = point.map(hex);
            lines.push(format!("{x} {y} {z} {answer}"));
        };
        let (origin, edge) = (self.frame.origin(), self.frame.edge());
        for i in 0..480 {
            let k = [0, 1, 2].map(|axis| mix(77_000 + 3 * i + axis) % 2048);
            let point = [0, 1, 2].map(|axis| origin[axis] + edge * ((2 * k[axis] + 1) as f64 / 4096.0));
            let Some(answer) = self.answer(cuts, point) else { continue };
            let count = counts.entry(answer).or_insert(0);
            if *count < 8 {
                line(point, answer);
                *count += 1;
            }
        }
        // Points outside the universe, and invalid points.
        let outside = points(&self.frame).into_iter().filter(|&point| cell_of(&self.frame, point).is_none());
        outside.for_each(|point| line(point, "undecided"));
        lines
    }

    /// Returns the expected answer for a point with the cuts; `None` next to a surface.
    fn answer(&self, cuts: &Cuts, point: [f64; 3]) -> Option<&'static str> {
        let word = |inside: bool| if inside { "inside" } else { "outside" };
        let finest = cell_of(&self.frame, point)?;
        let depth = self.frame.depth();
        let on = |level: u8| Cell { level, at: finest.map(|a| a >> (depth - level)) };
        let (level, tag) = (0..=depth)
            .map(|level| (level, self.canonical(on(level))))
            .find(|&(_, tag)| tag != Tag::Branch)
            .expect("the finest cells are not cut");
        match tag {
            Tag::Partial => {}
            tag => return Some(word(tag == Tag::Full)),
        }
        let cut = (level..=depth).map(|level| (cuts.cut)(on(level))).find(|cut| !matches!(cut, Cut::Split));
        let Some(Cut::Table(surfaces, mut table)) = cut else { return Some("undecided") };
        for (i, &surface) in surfaces.iter().enumerate() {
            let surface = &cuts.surfaces[surface];
            let mask = [0xAA, 0xCC, 0xF0][i];
            let near = self.frame.edge() / 65_536.0;
            let side = surface.side(&point.map(Q::of));
            let far = (0..8).all(|k| {
                let corner =
                    [0, 1, 2].map(|axis| point[axis] + if k >> axis & 1 != 0 { near } else { -near });
                surface.side(&corner.map(Q::of)) == side
            });
            if !far || side.is_err() && surface.kind != Kind::Slab {
                return None;
            }
            if let Ok(positive) = side {
                let half = if positive { table & mask } else { table & !mask };
                table = half | if positive { half >> (1 << i) } else { half << (1 << i) };
            }
        }
        Some(match table {
            0 => "outside",
            0xFF => "inside",
            _ => "undecided",
        })
    }
}

// ---- valid vectors --------------------------------------------------------------------------------------

/// A ball in a universe of edge 2^depth, with coarse and fine PARTIAL cells; its surface is exact.
fn ball(depth: u8) -> Model {
    let unit = f64::from(1u32 << (depth - 1));
    let (centre, radius) = ([0.6875, 0.8125, 0.90625].map(|c| c * unit), 0.28125 * unit);
    let shape = move |cell: Cell| {
        let size = f64::from(1u32 << (depth - cell.level));
        let low = cell.at.map(|a| f64::from(a) * size);
        // Everything is a multiple of 1/32 and exact.
        let (mut near, mut far) = (0.0, 0.0);
        for axis in 0..3 {
            let (a, b) = (low[axis] - centre[axis], low[axis] + size - centre[axis]);
            near += if a > 0.0 { a * a } else { b.min(0.0) * b.min(0.0) };
            far += (a * a).max(b * b);
        }
        if far <= radius * radius {
            Tag::Full
        } else if near >= radius * radius {
            Tag::Empty
        } else if cell.level == depth || cell.level >= 2 && cell.at.iter().sum::<u32>() % 3 == 0 {
            Tag::Partial
        } else {
            Tag::Branch
        }
    };
    Model::plain(depth, shape).cuts(Cuts::everywhere(vec![Surface::ball(centre, radius)], POSITIVE))
}

/// Returns the moments of a ball about a point. The rounding error is below 2^-48 of each moment.
fn moments_of_ball(centre: [f64; 3], radius: f64, point: [f64; 3]) -> [f64; 23] {
    let volume = 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let d = [0, 1, 2].map(|i| centre[i] - point[i]);
    let own = radius * radius / 5.0;
    let second = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
        .map(|(i, j)| volume * (d[i] * d[j] + if i == j { own } else { 0.0 }));
    let all = [volume].into_iter().chain(d.map(|d| volume * d)).chain(second);
    // (Zero has no sign.)
    let ends = all.flat_map(|c| [-1.0, 1.0].map(|sign| c + sign * c.abs() / 2f64.powi(48) + 0.0));
    point.into_iter().chain(ends).collect::<Vec<_>>().try_into().expect("23 numbers")
}

/// A ball that keeps its moments, about a point that is not its centre.
fn ball_with_moments() -> Model {
    let model = ball(1);
    let moments = moments_of_ball([0.6875, 0.8125, 0.90625], 0.28125, [0.6875, 1.0, -0.25]);
    let cuts = model.cuts.clone().expect("cuts").moments(moments);
    model.cuts(cuts)
}

/// Half of an octant, a box whose moments about its centre are exact.
fn box_with_moments() -> Model {
    let shape = |cell: Cell| match (cell.level, cell.octant()) {
        (0, _) => Tag::Branch,
        (_, 0) => Tag::Partial,
        _ => Tag::Empty,
    };
    let mut moments = [0.0; 23];
    moments[..5].copy_from_slice(&[0.75, 0.5, 0.5, 0.5, 0.5]);
    // ∫ (x − c)² is the volume times a twelfth of the square of the edge; 1/24 is between two doubles.
    let twenty_fourth = 1.0 / 24.0;
    for (i, c) in [twenty_fourth / 4.0, twenty_fourth, twenty_fourth].into_iter().enumerate() {
        moments[11 + 2 * i..13 + 2 * i].copy_from_slice(&[f64::next_down(c), f64::next_up(c)]);
    }
    let plane = Cuts::everywhere(vec![Surface::plane(1.0, 0.0, 0.0, -0.5)], POSITIVE);
    Model::plain(1, shape).cuts(plane.moments(moments))
}

/// A PARTIAL universe that was given up, with moments that say nothing, either.
fn nothing_with_moments() -> Model {
    let mut moments = [0.0; 23];
    for (i, c) in moments[3..].iter_mut().enumerate().skip(1) {
        *c = if i % 2 == 0 { -f64::MAX } else { f64::MAX };
    }
    moments[0] = f64::from_bits(1);
    moments[1] = -f64::MAX;
    whole(5, Cuts::new(vec![], |_| Cut::Nothing).moments(moments)).exterior(Tag::Empty)
}

/// A universe that is PARTIAL, with cuts.
fn whole(depth: u8, cuts: Cuts) -> Model {
    Model::plain(depth, |_| Tag::Partial).exterior(Tag::Partial).cuts(cuts)
}

/// Two planes and a ball in a tree of depth 4: tables of one to three surfaces, splits, and cells that were
/// given up.
fn tables() -> Model {
    let shape = |cell: Cell| match cell.level {
        0 => Tag::Branch,
        1 => [Tag::Branch, Tag::Partial, Tag::Branch, Tag::Full][cell.octant() as usize % 4],
        2 => [Tag::Partial, Tag::Empty, Tag::Branch, Tag::Partial][cell.octant() as usize % 4],
        3 => [Tag::Partial, Tag::Branch][cell.octant() as usize % 2],
        _ => [Tag::Partial, Tag::Full, Tag::Partial][cell.at.iter().sum::<u32>() as usize % 3],
    };
    let surfaces = vec![
        Surface::plane(1.0, 2.0, -1.0, -9.5),
        Surface::ball([7.0, 8.0, 9.0], 5.5),
        Surface::plane(-0.5, 0.25, 1.0, -3.0),
    ];
    let cut = |cell: Cell| {
        let hash = cell.at.iter().fold(u64::from(cell.level) + 11, |hash, &a| mix(hash ^ u64::from(a)));
        let two = |i: usize, j: usize| vec![i, j];
        match hash % 8 {
            0 | 1 if cell.level < 4 => Cut::Split,
            2 => Cut::Nothing,
            3 => Cut::Table(vec![2], NEGATIVE),
            4 => Cut::Table(two(2, 0), table(|a, b, _| a && b)),
            5 => Cut::Table(two(1, 0), table(|a, b, _| a && !b)),
            6 => Cut::Table(two(1, 2), table(|a, b, _| a != b)),
            _ => Cut::Table(vec![2, 0, 1], table(|a, b, c| a && b || c && !a)),
        }
    };
    Model::plain(4, shape).cuts(Cuts::new(surfaces, cut))
}

/// A rotation by the angle with sine 0.6 and cosine 0.8, rounded to doubles.
const TURN: Map = [[0.8, -0.6, 0.0, 0.25], [0.6, 0.8, 0.0, -0.5], [0.0, 0.0, 1.0, 0.125]];
const SHEAR: Map = [[1.0, 0.0, 0.5, 0.0], [0.0, -2.0, 0.0, 0.0], [0.0, 0.25, 1.5, 1.0]];
const SHIFT: Map = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, -1.0], [0.0, 0.0, 1.0, 3.0]];

/// A torus, a sum of powers and a plane, each moved by two or three maps. Their first maps are the same.
fn placed() -> Model {
    let torus = Surface::new(Kind::Torus, &[2.0, 1.5, 1.0, 0.25]).placed(&[SHIFT, TURN]);
    let powers = [-1.0, 0.5, 4.0, -0.5, -0.5, 6.0, -1.0, 0.0, 2.0, 20.0];
    let powers = Surface::new(Kind::Powers, &powers).placed(&[SHIFT, TURN, SHEAR]);
    let plane = Surface::plane(1.0, 1.0, -2.0, 0.5).placed(&[SHIFT, SHEAR]);
    let inside = |a, b, c| (a || b) && c;
    let cuts = Cuts::everywhere(vec![torus, powers, plane], table(inside));
    Model { frame: Frame::new([-4.0, -4.0, -1.0], 8.0, 5).expect("a frame"), ..whole(5, cuts) }
}

/// Slabs of two origins, and slabs without an origin. One slab's number is its place; the bits of another
/// slab's number are those of a NaN.
fn slabs() -> Model {
    let slab = Surface::slab;
    let surfaces = vec![
        slab([1.0, 0.0, 0.0], 2.0, 2.5).of(1, 0),
        slab([0.0, 1.0, 0.5], 3.0, 4.0).of(3, u64::MAX),
        slab([0.6, 0.0, -0.8], -1.25, 0.0),
        slab([0.0, 1.0, 0.0], 5.5, 6.0).of(1, 0),
        slab([0.0, 0.0, 1.0], 4.0, 4.0),
    ];
    let cut = |cell: Cell| match (cell.level, cell.octant() % 4) {
        (0, _) => Cut::Split,
        (1, 0) => Cut::Table(vec![0], POSITIVE),
        (1, 1) => Cut::Table(vec![1, 2], table(|a, b, _| a && b)),
        (1, 2) => Cut::Table(vec![3, 4, 0], table(|a, b, c| a && b || c)),
        _ => Cut::Table(vec![1], NEGATIVE),
    };
    whole(3, Cuts::new(surfaces, cut))
}

/// More surfaces than eight bits can number, in more cuts than a block has.
fn many() -> Model {
    let plane = |i: usize| Surface::plane(1.0, i as f64 / 256.0, 0.5, -0.03125 * i as f64);
    let cut = |cell: Cell| {
        let i = (cell.at[0] + 8 * cell.at[1] + 64 * cell.at[2]) as usize;
        match cell.level {
            3 if i < 270 => Cut::Table(vec![269 - i], NEGATIVE),
            3 => Cut::Table(vec![i % 270, (i + 1) % 270], table(|a, b, _| a || b)),
            _ => Cut::Split,
        }
    };
    whole(3, Cuts::new((0..270).map(plane).collect(), cut))
}

/// Numbers that are sums of up to seven doubles.
fn long_numbers() -> Model {
    let power = |n: i32| 2f64.powi(n);
    let seven = [1.0, -power(-53), power(-106), power(-170), -power(-300), power(-800), -f64::from_bits(1)];
    let plane = Surface::plane(0.0, 1.0, -0.5, -1.0).with(0, &seven).with(3, &[-2.0, power(-60)]);
    let ball =
        Surface::ball([2.0; 3], 1.75).with(3, &[power(-9), power(-62)]).with(9, &[-8.9375, -power(-70)]);
    whole(2, Cuts::everywhere(vec![plane, ball], table(|a, b, _| a && b)))
}

/// A tree of depth 3 with all kinds of surfaces.
fn all_kinds() -> Model {
    let shape = |cell: Cell| match cell.level {
        0 => Tag::Branch,
        1 if cell.at[0] == 0 => Tag::Partial,
        1 => [Tag::Empty, Tag::Branch][cell.at[1] as usize],
        2 => [Tag::Full, Tag::Partial, Tag::Branch][cell.at.iter().sum::<u32>() as usize % 3],
        _ => [Tag::Partial, Tag::Empty][cell.octant() as usize % 2],
    };
    let surfaces = vec![
        Surface::new(Kind::Torus, &[1.5, 0.75, 0.5, -1.0]).placed(&[SHIFT]),
        Surface::slab([1.0, 0.0, 1.0], 5.0, 5.5).of(9, 3),
        Surface::new(Kind::Powers, &[1.0, 2.0, 3.0, 0.5, 1.0, 1.0, 0.0, 0.0, 5.0, -4.0]),
        Surface::plane(0.5, -1.0, 0.0, 1.0),
        Surface::ball([3.0, 4.0, 5.0], 2.5).placed(&[SHIFT, TURN]),
    ];
    let cut = |cell: Cell| match (cell.level, cell.at.iter().sum::<u32>() % 4) {
        (1, 1) => Cut::Split,
        (3, 2) | (2, 3) => Cut::Nothing,
        (_, 0) => Cut::Table(vec![3, 4], table(|a, b, _| a && b)),
        (_, 1) => Cut::Table(vec![1, 0, 2], table(|a, b, c| a && b || c)),
        _ => Cut::Table(vec![0], POSITIVE),
    };
    Model::plain(3, shape).cuts(Cuts::new(surfaces, cut))
}

/// A slab that cuts a cell about in the middle. Its width is an eighth of the cell's edge.
fn middle(cell: Cell, index: u64) -> CellSlab {
    let hash = cell.at.iter().fold(u64::from(cell.level) + 5 * index, |hash, &a| mix(hash ^ u64::from(a)));
    let part = |shift: u32| (hash >> shift & 0x7FFF) as i64 - 0x4000;
    CellSlab {
        cell,
        index,
        axis: (hash % 3) as usize,
        is_negative: hash >> 40 & 1 != 0,
        others: [part(8), part(23)],
        offset: (hash >> 50) as i64 % 16 - 12,
        width: 8,
        step: u64::from(cell.level) + 6,
    }
}

/// Cells of the level at which a PARTIAL universe is split.
fn cells_of(level: u8) -> Vec<Cell> {
    let side = 0..1u32 << level;
    let each = |z: u32| side.clone().flat_map(move |y| (0..1u32 << level).map(move |x| [x, y, z]));
    side.clone().flat_map(each).map(|at| Cell { level, at }).collect()
}

/// Slabs of cells, of two origins and of none, beside a plane and a slab that does not belong to a cell.
fn cell_slabs() -> Model {
    let frame = Frame::new([-1.0, 0.5, 0.0], 4.0, 3).expect("a frame");
    let mut surfaces = vec![
        Surface::plane(1.0, 0.5, 0.25, -1.25),
        Surface::slab([0.0, 1.0, 1.0], 2.5, 3.0).of(1, 1 << 63 | 1),
    ];
    let cells = cells_of(2);
    for (i, &cell) in cells.iter().enumerate() {
        let origin = [0, 1, 3][i % 3];
        surfaces.push(Surface::of_cell(&frame, middle(cell, 0), origin));
        surfaces.push(Surface::of_cell(&frame, middle(cell, 2), origin));
    }
    let cut = move |cell: Cell| {
        if cell.level < 2 {
            return Cut::Split;
        }
        let i = cells.iter().position(|&own| own == cell).expect("a cell of level two");
        let (one, other) = (2 + 2 * i, 3 + 2 * i);
        match cell.at.iter().sum::<u32>() % 5 {
            0 => Cut::Table(vec![other, one], table(|a, b, _| a && b)),
            1 => Cut::Table(vec![one, 0], table(|a, b, _| a || b)),
            2 => Cut::Nothing,
            3 => Cut::Table(vec![1, other, one], table(|a, b, c| a && b || c)),
            _ => Cut::Table(vec![one], NEGATIVE),
        }
    };
    Model { frame, ..whole(3, Cuts::new(surfaces, cut)) }
}

/// Only slabs of cells: one of each of the eight octants.
fn cell_slabs_alone() -> Model {
    let frame = Model::plain(2, |_| Tag::Partial).frame;
    let cells = cells_of(1);
    let origins = [1, 1, 3, 3, 3, 0, 0, 5];
    let surfaces =
        cells.iter().zip(origins).map(|(&cell, origin)| Surface::of_cell(&frame, middle(cell, 1), origin));
    let surfaces: Vec<_> = surfaces.collect();
    let cut = move |cell: Cell| match cells.iter().position(|&own| own == cell) {
        Some(i) => Cut::Table(vec![i], POSITIVE),
        None => Cut::Split,
    };
    whole(2, Cuts::new(surfaces, cut))
}

/// Slabs of the smallest possible cells and of the universe, with the greatest and the least numbers.
fn cell_slabs_extreme() -> Model {
    let frame = Model::plain(20, |_| Tag::Partial).frame;
    let finest = Cell { level: 20, at: [0xF_FFFF, 0x5_5555, 0] };
    let slab = CellSlab {
        cell: finest,
        index: 0,
        axis: 2,
        is_negative: true,
        others: [-32_767, 32_767],
        offset: 262_143,
        width: 15,
        step: 2,
    };
    let surfaces = vec![
        Surface::of_cell(&frame, slab, 1),
        Surface::of_cell(&frame, CellSlab { offset: -262_144, step: 50, axis: 1, index: 1, ..slab }, 1),
        Surface::of_cell(
            &frame,
            CellSlab {
                cell: Cell::ROOT,
                axis: 0,
                others: [0, 1],
                offset: 0,
                width: 0,
                step: 25,
                index: 2,
                ..slab
            },
            0,
        ),
    ];
    let inside = |a: bool, b: bool, c: bool| a && !b || c;
    whole(20, Cuts::everywhere(surfaces, table(inside)))
}

/// All valid vectors with cuts, and some that mention cuts.
pub(super) fn valid() -> Vec<Valid> {
    let mut vectors = vec![];
    let mut add = |name, about, model: Model| {
        let bytes = Parts::of(&model).bytes();
        vectors.push(Valid { name, about, canonical: true, bytes, model });
    };
    let plane = || Cuts::everywhere(vec![Surface::plane(1.0, 2.0, -0.5, -9.25)], NEGATIVE);
    add("cut-plane", "a universe that is PARTIAL, with one cut: the side of a plane", whole(4, plane()));
    for (name, depth) in [("cut-ball-1", 1), ("cut-ball-2", 2), ("cut-ball-3", 3), ("cut-ball-4", 4)] {
        let about = "a ball, with a quadric in all PARTIAL cells";
        add(name, about, ball(depth));
    }
    let about = "tables of one to three surfaces of two kinds, splits, and cells of which nothing is known";
    add("cut-tables", about, tables());
    let about = "surfaces that are placed by chains of two and three maps, which begin with the same one";
    add("cut-placed", about, placed());
    add("cut-slabs", "slabs of two origins, and slabs without", slabs());
    add("cut-many", "more than 256 surfaces: ids of nine bits; many blocks", many());
    let about =
        "slabs of cells of two origins and of none, behind a plane and a slab of one of these origins";
    add("cut-cell-slabs", about, cell_slabs());
    add("cut-cell-slabs-alone", "no surfaces but slabs of cells, and ids of three bits", cell_slabs_alone());
    let about =
        "slabs of a finest cell of depth 20 and of the universe, with the greatest and the least numbers";
    add("cut-cell-slabs-extreme", about, cell_slabs_extreme());
    add(
        "cut-kinds",
        "surfaces of all kinds in a tree of odd depth, with octants that are PARTIAL",
        all_kinds(),
    );
    add("cut-long-numbers", "numbers that are sums of up to seven doubles", long_numbers());
    let powers = [1.0, 3.0, 64.0, -0.5, 2.0, 3.0, 0.0, 0.0, 1.0, -0.75];
    let powers = Cuts::everywhere(vec![Surface::new(Kind::Powers, &powers)], NEGATIVE);
    let about = "a sum of powers with the greatest exponent, and one axis that does not count";
    add("cut-powers", about, whole(3, powers));
    let torus = Cuts::everywhere(vec![Surface::new(Kind::Torus, &[1.5, 0.25, 0.5, -0.75])], POSITIVE);
    add("cut-torus", "a torus that is scaled and shifted", whole(2, torus));
    let shift =
        |i: u32| [[1.0, 0.0, 0.0, f64::from(i % 3) - 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.5]];
    let chain =
        Surface::new(Kind::Torus, &[1.5, 0.25, 1.0, 30.0]).placed(&(0..64).map(shift).collect::<Vec<_>>());
    let about = "a torus that is moved by as many maps as a surface may be";
    add("cut-chain", about, whole(2, Cuts::everywhere(vec![chain], POSITIVE)));
    let about = "a ball that keeps its moments, about a point that is not its centre";
    add("cut-moments", about, ball_with_moments());
    add(
        "cut-moments-exact",
        "a box whose moments are known without rounding, or nearly so",
        box_with_moments(),
    );
    let about = "moments with the greatest and the least numbers, of a universe of which nothing is known";
    add("cut-moments-wide", about, nothing_with_moments());
    let nothing = |_| Cut::Nothing;
    let about = "cuts of which nothing is known: no ids, no surfaces";
    let model = Model::plain(3, noise(3, 5, CERTIFIED)).cuts(Cuts::new(vec![], nothing));
    add("cut-nothing", about, model);
    let about = "a PARTIAL universe of which nothing is known";
    add("cut-nothing-whole", about, whole(20, Cuts::new(vec![], nothing)));
    let about = "a split down to the finest cells, in an octant of a brick that is PARTIAL as a whole";
    let shape = |cell: Cell| match cell.level {
        0 => Tag::Branch,
        _ if cell.at.map(|a| a >> (cell.level - 1)) == [1, 0, 1] => Tag::Partial,
        _ => Tag::Empty,
    };
    let deep = |cell: Cell| match cell.octant() {
        0..=5 if cell.level == 2 => Cut::Table(vec![0], POSITIVE),
        _ if cell.level == 2 => Cut::Nothing,
        _ => Cut::Split,
    };
    let octant = Cuts::new(vec![Surface::ball([3.0, 1.0, 3.0], 0.875)], deep);
    add("cut-octant", about, Model::plain(2, shape).cuts(octant));
    let heat = |at: [u32; 3]| (at[0] != 1).then(|| one_value((at[1] + at[2]) as f64)).flatten();
    let about = "cuts, channels and metadata";
    let model = ball(3).fact("units", "mm").channel(Field::new("heat", 2, (ScalarType::F32, 1), heat));
    add("cut-channels", about, model);

    let mut unusual = |name, about, model: Model, change: &dyn Fn(&mut Parts)| {
        let mut parts = Parts::of(&model);
        change(&mut parts);
        parts.sort();
        vectors.push(Valid { name, about, canonical: false, bytes: parts.bytes(), model });
    };
    let plain = || Model { cuts: None, ..tables() };
    let about = "minor version 4, and no cuts";
    unusual("cut-version-needless", about, example(), &|parts| put(&mut parts.head, 10, 4, 2));
    let about = "sections of the kinds of cuts in minor version 3, where they are unknown ones";
    unusual("cut-version-before", about, plain(), &|parts| {
        let model = tables();
        let cuts = model.cuts.clone().expect("cuts");
        parts.add_cuts(&model, &cuts);
        put(&mut parts.head, 10, 3, 2);
        // As unknown sections they may have any content.
        parts.section(FIRST).bytes.truncate(4);
        parts.section(HEADS).bytes.fill(0xF0);
    });
    let about = "minor version 5: cuts whose sections have flags and reserved bytes of a newer version";
    unusual("cut-newer", about, tables(), &|parts| {
        put(&mut parts.head, 10, NEWER, 2);
        for (kind, ..) in KINDS.iter().take(6) {
            let section = parts.section(*kind);
            (section.flags, section.reserved) = (0x22, 0x7E);
        }
    });
    let about = "cuts beside sections of the same kinds that another object and a channel own, and beside unknown sections";
    let model = ball(4).channel(Field::new("one", 1, (ScalarType::U8, 1), |_| one_value(1.0)));
    unusual("cut-unknown-parts", about, model, &|parts| {
        parts.object(77, 0, 0);
        parts.sections.push(Section::new(HEADS, (U8, 3), vec![0xF0; 9]).of(1));
        parts.sections.push(Section::new(ORIGINS, (F32, 1), vec![1; 4]).of(2).flagged(1));
        parts.sections.push(Section::new(GROUPS, (U16, 1), vec![2; 2]).of(1));
        parts.sections.push(Section::new(MOMENTS, (U16, 1), vec![2; 2]).of(1));
        parts.sections.push(Section::new(MOMENTS + 1, (U16, 1), vec![2; 4]));
        parts.sections.push(Section::new(APPLICATION, (U8, 1), vec![3; 4]));
    });
    let about = "the blocks and the first cuts lie in one place with other sections";
    let one = |cell: Cell| if cell.octant() == 0 { Tag::Partial } else { Tag::Empty };
    let shape = move |cell: Cell| if cell.level == 0 { Tag::Branch } else { one(cell) };
    let model =
        Model::plain(1, shape).cuts(Cuts::everywhere(vec![Surface::plane(1.0, 0.0, 0.0, -0.5)], POSITIVE));
    unusual("cut-shared", about, model, &|parts| {
        // An unknown section and the blocks have the same two zeros.
        let blocks = parts.section(BLOCKS).clone();
        parts.sections.push(Section { kind: APPLICATION, same: Some((0, BLOCKS)), ..blocks });
    });
    vectors
}

// ---- invalid vectors ------------------------------------------------------------------------------------

fn record(record: usize) -> String {
    format!("Damaged(CutRecord {{ record: {record} }})")
}

fn surface(surface: u64) -> String {
    format!("Damaged(Surface {{ surface: {surface} }})")
}

fn placement(placement: u64) -> String {
    format!("Damaged(Placement {{ placement: {placement} }})")
}

fn first(index: u64) -> String {
    format!("Damaged(CutCount {{ index: {index} }})")
}

/// The invalid vectors with cuts.
pub(super) fn invalid(list: &mut List) {
    tables_of_sections(list);
    list.way = Way::Verification;
    records(list);
    slabs_of_cells(list);
    moments(list);
    surfaces(list);
}

/// Returns a file with cuts after a change.
fn changed(model: &Model, change: impl FnOnce(&mut Parts)) -> Vec<u8> {
    let mut parts = Parts::of(model);
    change(&mut parts);
    parts.sort();
    parts.bytes()
}

fn pop(bytes: &mut Vec<u8>, count: usize) {
    bytes.truncate(bytes.len() - count);
}

fn tables_of_sections(list: &mut List) {
    let (model, cell_slabs, moments) = (all_kinds(), cell_slabs(), box_with_moments());
    // A file with sections of a kind.
    let with = |kind: u64| match kind {
        MOMENTS => &moments,
        CELL_SLABS | GROUPS => &cell_slabs,
        _ => &model,
    };
    let add = |list: &mut List,
               rule,
               of: &str,
               about,
               error: String,
               model: &Model,
               change: &dyn Fn(&mut Parts)| {
        list.add(rule, of, about, error, changed(model, change));
    };
    list.way = Way::Probing;
    for (kind, name, element) in KINDS {
        let of = name.replace(' ', "-");
        let about = "a section of cuts of another type";
        add(list, "section-size", &of, about, section(name), with(kind), &|parts| {
            let section = parts.section(kind);
            // Bytes of the same length.
            section.element = if element == (U8, 1) { (U8, section.bytes.len() as u64) } else { (U8, 4) };
        });
        let about = "a section of cuts that is required";
        add(list, "section-required", &of, about, field("section flags", 1), with(kind), &|parts| {
            parts.section(kind).flags = 1;
        });
    }
    for (of, ty, size) in [("u16", U16, 2), ("u32", U32, 4), ("u64", U64, 8)] {
        let about = "ids that are no bytes";
        add(list, "section-size", &format!("cut-ids-{of}"), about, section("cut ids"), &model, &|parts| {
            parts.section(IDS).bytes.resize(8 * size, 0);
            parts.section(IDS).element = (ty, 1);
        });
    }
    let about = "cut heads in an unknown encoding of a newer minor version";
    let error = "Format(Required { name: \"section encoding\", value: 1 })".to_owned();
    add(list, "table-encoding", "cuts", about, error, &model, &|parts| {
        put(&mut parts.head, 10, NEWER, 2);
        parts.section(HEADS).encoding = 1;
    });
    let cuts = |list: &mut List, of: &str, about, name, model: &Model, change: &dyn Fn(&mut Parts)| {
        add(list, "section-cuts", of, about, section(name), model, change);
    };
    cuts(list, "heads", "sections of cuts without heads", "cut ids", &model, &|parts| {
        drop(parts.take(HEADS))
    });
    let about = "origins, and nothing else of cuts";
    cuts(list, "origins-alone", about, "origins", &model, &|parts| {
        let others = KINDS.iter().map(|&(kind, ..)| kind).filter(|&kind| kind < ORIGINS);
        others.for_each(|kind| drop(parts.take(kind)));
    });
    let about = "slabs of cells, and nothing else of cuts";
    cuts(list, "cell-slabs-alone", about, "cell slabs", &cell_slabs_alone(), &|parts| {
        [HEADS, IDS, BLOCKS, FIRST].into_iter().for_each(|kind| drop(parts.take(kind)));
    });
    let about = "moments, and nothing else of cuts";
    cuts(list, "moments-alone", about, "moments", &nothing_with_moments(), &|parts| {
        [HEADS, BLOCKS, FIRST].into_iter().for_each(|kind| drop(parts.take(kind)));
    });
    cuts(list, "moments-two", "moments of two solids", "moments", &moments, &|parts| {
        let bytes = &mut parts.section(MOMENTS).bytes;
        bytes.extend_from_within(..);
    });
    for (kind, of) in [(CELL_SLABS, "cell-slabs"), (GROUPS, "cell-slab-groups")] {
        cuts(list, of, "a section of cuts is absent", "cell slab groups", &cell_slabs, &|parts| {
            drop(parts.take(kind))
        });
    }
    let about = "more groups than slabs of cells";
    cuts(list, "cell-slab-groups-more", about, "cell slab groups", &cell_slabs_alone(), &|parts| {
        let group = |i: u64| [i, i, i].map(u64::to_le_bytes).concat();
        parts.section(GROUPS).bytes = (1..10).flat_map(group).collect();
    });
    for (kind, name, element) in KINDS {
        if [NUMBERS, PLACEMENTS, ORIGINS].contains(&kind) {
            let of = format!("{}-of-cell-slabs", name.replace(' ', "-"));
            let about = "a section of records, where there are slabs of cells alone";
            cuts(list, &of, about, name, &cell_slabs_alone(), &|parts| {
                let size = 8 * if element.0 == RECORD { 13 } else { 2 };
                parts.sections.push(Section::new(kind, element, vec![0; size]));
            });
        }
    }
    for (kind, of, name) in [
        (IDS, "ids", "cut ids"),
        (BLOCKS, "blocks", "cut blocks"),
        (FIRST, "first", "cut first"),
        (SURFACES, "surfaces", "cut ids"),
        (NUMBERS, "numbers", "surface numbers"),
    ] {
        cuts(list, of, "a section of cuts is absent", name, &model, &|parts| drop(parts.take(kind)));
    }
    for (kind, of, name, size) in [(BLOCKS, "blocks", "cut blocks", 8), (FIRST, "first", "cut first", 4)] {
        let more = format!("{of}-more");
        cuts(list, &more, "one element too many", name, &model, &|parts| {
            parts.section(kind).bytes.extend(vec![0; size]);
        });
        let less = format!("{of}-less");
        let about = "one element too few";
        cuts(list, &less, about, name, &tables(), &|parts| pop(&mut parts.section(kind).bytes, size));
    }
    let nothing = || whole(2, Cuts::new(vec![], |_| Cut::Nothing));
    for (kind, name, element) in KINDS {
        let size = 8 * if element.0 == RECORD { 13 } else { 2 } * if kind == GROUPS { 3 } else { 1 };
        if [IDS, NUMBERS, PLACEMENTS, ORIGINS, GROUPS].contains(&kind) {
            let of = format!("{}-needless", name.replace(' ', "-"));
            cuts(list, &of, "a section of cuts that have no surfaces", name, &nothing(), &|parts| {
                parts.sections.push(Section::new(kind, element, vec![0; size]));
            });
        }
    }
    let about = "surfaces that no cut has, and no ids";
    cuts(list, "surfaces-needless", about, "cut ids", &nothing(), &|parts| {
        parts.sections.push(Section::new(SURFACES, (U32, 4), vec![0; 16]));
    });
    let about = "slabs of cells that no cut has, and no ids";
    cuts(list, "cell-slabs-needless", about, "cut ids", &nothing(), &|parts| {
        let words = middle(Cell::ROOT, 0).words();
        parts.sections.push(Section::new(CELL_SLABS, (U64, 2), words.map(u64::to_le_bytes).concat()));
    });
    list.way = Way::Verification;
    for (kind, name, _) in KINDS {
        let of = name.replace(' ', "-");
        let mut bytes = Parts::of(with(kind)).bytes();
        let at = super::offset_of(&bytes, 0, kind);
        bytes[at] ^= 1;
        list.add("section-crc", &of, "a bit of a section of cuts has fallen over", checksum(name), bytes);
    }
}

fn records(list: &mut List) {
    let model = tables();
    let stored = model.stored(model.cuts.as_ref().expect("cuts"));
    let (heads, known) = (&stored.heads, *stored.first.last().expect("a number") as usize);
    let mut add = |rule, of: &str, about, error: String, change: &dyn Fn(&mut Parts)| {
        list.add(rule, of, about, error, changed(&model, change));
    };
    let entries = stored.first.len() - 1;
    add("cut-first", "", "a cut before the first element", first(0), &|parts| {
        put(&mut parts.section(FIRST).bytes, 0, 1, 4);
    });
    add("cut-first", "brick", "a cut too few before a brick", first(entries as u64 - 1), &|parts| {
        let wrong = stored.first[entries - 1] - 1;
        put(&mut parts.section(FIRST).bytes, 4 * (entries - 1), wrong.into(), 4);
    });
    add("cut-first", "all", "a cut too few of all elements and bricks", first(entries as u64), &|parts| {
        put(&mut parts.section(FIRST).bytes, 4 * entries, known as u64 - 1, 4);
    });
    let about = "less cuts than the tree has PARTIAL cells";
    let short = |parts: &mut Parts| {
        parts.section(HEADS).bytes.truncate(1);
        parts.section(BLOCKS).bytes.truncate(8);
    };
    let beyond = (0..entries).find(|&n| stored.first[n] > 1).expect("an element with cuts before");
    add("cut-first", "short", about, first(beyond as u64), &short);
    let block = |block: u64| format!("Damaged(CutBlock {{ block: {block} }})");
    for (of, about, at) in [
        ("", "an id before the first cut", 0),
        ("splits", "a split before the first cut", 4),
        ("ids", "an id too many before a block", 8),
        ("last", "splits before the last block", 8 * (stored.blocks.len() - 1) + 4),
    ] {
        add("cut-block", of, about, block(at as u64 / 8), &|parts| {
            let bytes = &mut parts.section(BLOCKS).bytes;
            let wrong = super::number(bytes, at, 4) + 1;
            put(bytes, at, wrong, 4);
        });
    }
    for (of, about, head) in [
        ("third", "a table that depends on the third surface alone", 0xF0),
        ("second", "a table that depends on the second surface alone", 0xCC),
        ("last-two", "a table that depends on the second surface and the third", 0xC0),
        ("first-third", "a table that depends on the first surface and the third", 0xA0),
    ] {
        add("cut-head", of, about, record(0), &|parts| parts.section(HEADS).bytes[0] = head);
    }
    let finest = model.partial_cells().0.iter().position(|cell| cell.level == 4).expect("a finest cell");
    let about = "a finest cell that is split";
    let unlike = |of: &[u8]| of.iter().filter(|&&head| head == 0xFF).count();
    assert!(unlike(heads) > 2 && finest < known);
    add("cut-head", "finest", about, record(finest), &|parts| {
        parts.section(HEADS).bytes[finest] = 0xFF;
    });
    let last = heads.len();
    let about = "eight cuts more than there are splits";
    add("cut-group", "more", about, record(last), &|parts| {
        parts.section(HEADS).bytes.extend([0; 8]);
        let blocks = parts.section(BLOCKS);
        if last.next_multiple_of(32) < last + 8 {
            let counts = [stored.ids.len() as u32, unlike(heads) as u32];
            blocks.bytes.extend(counts.map(u32::to_le_bytes).concat());
        }
    });
    let split = heads.iter().rposition(|&head| head == 0xFF).expect("a split");
    let about = "no cuts of the children of the last split";
    add("cut-group", "", about, record(split), &|parts| {
        parts.section(HEADS).bytes.truncate(last - 8);
        let blocks = (last - 8).div_ceil(32) * 8;
        parts.section(BLOCKS).bytes.truncate(blocks);
    });
    let uniform = heads.iter().position(|&head| head == 0xFF).expect("a split");
    let about = "nothing is known of the children of a split";
    add("cut-uniform", "", about, record(uniform), &|parts| {
        parts.section(HEADS).bytes[known..known + 8].fill(0);
    });
    // The first cut with two surfaces, and the beginning of its ids.
    let count = |head: u8| usize::from(SURFACES_OF[usize::from(head)]);
    let pair = heads.iter().position(|&head| count(head) >= 2).expect("a table of two");
    let at: usize = heads[..pair].iter().map(|&head| count(head)).sum();
    let width = stored.width();
    let with_ids = |parts: &mut Parts, change: &dyn Fn(&mut Vec<u64>)| {
        let mut ids = stored.ids.clone();
        change(&mut ids);
        parts.section(IDS).bytes = packed(&ids, width);
    };
    let about = "surfaces of a cut that descend";
    add("cut-ids", "descend", about, record(pair), &|parts| with_ids(parts, &|ids| ids.swap(at, at + 1)));
    add("cut-ids", "same", "a surface twice in a cut", record(pair), &|parts| {
        with_ids(parts, &|ids| ids[at] = ids[at + 1]);
    });
    let one = heads.iter().position(|&head| count(head) > 0).expect("a table");
    let about = "the first surface that is used is not the first surface";
    add("cut-ids", "first", about, record(one), &|parts| with_ids(parts, &|ids| ids[0] = 1));
    assert!(width == 2 && stored.order.len() == 3);
    add("cut-ids", "beyond", "a surface that is not there", record(one), &|parts| {
        with_ids(parts, &|ids| ids[0] = 3);
    });
    // The first cut whose ids reach into the last byte.
    let in_last = (0..heads.len())
        .find(|&n| {
            let ids: usize = heads[..=n].iter().map(|&head| count(head)).sum();
            (ids * width).div_ceil(8) == (stored.ids.len() * width).div_ceil(8)
        })
        .expect("a cut");
    let about = "the ids end before those of the last cuts";
    add("cut-ids", "less", about, record(in_last), &|parts| pop(&mut parts.section(IDS).bytes, 1));
    let about = "a byte more than the ids take";
    add("cut-ids", "more", about, record(last), &|parts| parts.section(IDS).bytes.push(0));
    let about = "a surface that no cut has";
    add("cut-ids", "unused", about, record(last), &|parts| {
        let doubles = parts.section(NUMBERS).bytes.len() as u32 / 8;
        let plane = [0, 0o1111, doubles, 0].map(u32::to_le_bytes).concat();
        parts.section(SURFACES).bytes.extend(plane);
        parts.section(NUMBERS).bytes.extend([1f64; 4].map(f64::to_le_bytes).concat());
    });
    let about = "a PARTIAL universe whose cut is split, and whose children are not there";
    let plane = whole(2, Cuts::everywhere(vec![Surface::plane(1.0, 0.0, 0.0, -1.0)], POSITIVE));
    let bytes = changed(&plane, |parts| parts.section(HEADS).bytes[0] = 0xFF);
    list.add("cut-group", "root", about, record(0), bytes);
    let bytes = changed(&plane, |parts| put(&mut parts.section(FIRST).bytes, 0, 0, 4));
    list.add("cut-first", "root", "a PARTIAL universe without a cut", first(0), bytes);
    let about = "a bit of the last byte behind the last id";
    for (of, bit) in [("rest", 1), ("rest-last", 7)] {
        let bytes = changed(&plane, |parts| parts.section(IDS).bytes[0] |= 1 << bit);
        list.add("cut-ids", of, about, record(1), bytes);
    }
}

/// Slabs of cells, and their groups.
fn slabs_of_cells(list: &mut List) {
    let model = cell_slabs_alone();
    let stored = model.stored(model.cuts.as_ref().expect("cuts"));
    let mut add = |rule, of: &str, about, error: String, model: &Model, change: &dyn Fn(&mut Parts)| {
        list.add(rule, of, about, error, changed(model, change));
    };
    // The origins of the slabs are 1 1 3 3 3 0 0 5. Their cuts follow the split cut of the universe.
    assert!(stored.groups.iter().map(|&(_, end)| end).eq([2, 5, 7, 8]) && stored.heads.len() == 9);
    let word = |parts: &mut Parts, kind: u64, at: usize, value: u64| {
        put(&mut parts.section(kind).bytes, 8 * at, value, 8)
    };
    let end = |parts: &mut Parts, group: usize, value: u64| word(parts, GROUPS, 3 * group + 2, value);
    for (of, about, group, value, at) in [
        ("empty", "a group of no slabs", 0, 0, 0),
        ("same", "a group that ends where the one before does", 1, 2, 2),
        ("descend", "a group that ends before the one before does", 2, 4, 5),
        ("beyond", "a group that ends where there are no slabs", 3, 9, 8),
        ("less", "slabs of cells behind the last group", 3, 7, 7),
        ("great", "a group that ends far beyond all slabs", 1, u64::MAX, 8),
    ] {
        add("cell-slab-group", of, about, surface(at), &model, &|parts| end(parts, group, value));
    }
    let about = "a last group that ends before the last slab";
    add("cell-slab-group", "short", about, surface(7), &model, &|parts| {
        pop(&mut parts.section(GROUPS).bytes, 24);
    });
    let origin = |parts: &mut Parts, group: usize, [low, high]: [u64; 2]| {
        word(parts, GROUPS, 3 * group, low);
        word(parts, GROUPS, 3 * group + 1, high);
    };
    let (one, none) = (stored.groups[0].0, stored.groups[2].0);
    assert_eq!(none, [0; 2]);
    for (of, about, group, of_group, at) in [
        ("next", "two groups of one origin that follow each other", 1, one, 2),
        ("again", "two groups of one origin, with others between them", 3, one, 7),
        ("none", "two groups without origin", 3, none, 7),
        ("twice", "a later group that has the origin of an earlier one", 2, one, 5),
    ] {
        add("cell-slab-group", of, about, surface(at), &model, &|parts| origin(parts, group, of_group));
    }

    let ids = |parts: &mut Parts, ids: [u64; 8]| parts.section(IDS).bytes = packed(&ids, stored.width());
    assert_eq!(stored.ids, [0, 1, 2, 3, 4, 5, 6, 7]);
    for (of, about, wrong, at) in [
        ("group", "the second slab of a group before the first one", [0, 1, 3, 2, 4, 5, 6, 7], 3),
        ("groups", "a group before the one that stands before it", [0, 5, 2, 3, 4, 1, 6, 7], 2),
        ("group-first", "a group that is not the first one before all others", [2, 0, 1, 3, 4, 5, 6, 7], 1),
    ] {
        add("cut-ids", of, about, record(at), &model, &|parts| ids(parts, wrong));
    }
    let about = "a slab of a group that no cut has, while a later group has been used";
    add("cut-ids", "group-unused", about, record(9), &model, &|parts| ids(parts, [0, 1, 2, 3, 3, 5, 6, 7]));
    let about = "the first slab of a cell has the number of the next surface of a record";
    let mixed = cell_slabs();
    let of_mixed = mixed.stored(mixed.cuts.as_ref().expect("cuts"));
    assert!(of_mixed.records == 2);
    let first = of_mixed.ids.iter().position(|&id| id == 2).expect("a slab of a cell");
    let at = (0..of_mixed.heads.len())
        .find(|&n| {
            of_mixed.heads[..=n]
                .iter()
                .map(|&head| usize::from(SURFACES_OF[usize::from(head)]))
                .sum::<usize>()
                > first
        })
        .expect("a cut");
    add("cut-ids", "slab-next", about, record(at), &mixed, &|parts| {
        let mut ids = of_mixed.ids.clone();
        ids[first] = 3;
        parts.section(IDS).bytes = packed(&ids, of_mixed.width());
    });

    let part = |parts: &mut Parts, at: usize, shift: u64, bits: u64, value: u64| {
        let before = super::number(&parts.section(CELL_SLABS).bytes, 8 * at, 8);
        let mask = ((1 << bits) - 1) << shift;
        word(parts, CELL_SLABS, at, before & !mask | value << shift);
    };
    for (of, about, at, shift, bits, value) in [
        ("index", "the fourth slab of a cell", 0, 61, 2, 3),
        ("bit", "bit 63 of a home", 2, 63, 1, 1),
        ("no-cell", "a home without the bit that leads", 4, 0, 61, 0),
        ("no-level", "a home whose leading bit is none of a level", 6, 0, 61, 0b10_101),
        ("no-level-two", "a home whose leading bit is one less than that of a level", 8, 0, 61, 0b100_101),
        ("deep", "a cell below the finest ones", 10, 0, 61, 0b1_101_011_001),
        ("deepest", "the last finest cell of an octree of depth 20", 10, 0, 61, (1 << 61) - 1),
        ("axis", "a fourth axis", 1, 61, 2, 3),
        ("component", "a component of a normal that is as long as the greatest", 3, 0, 16, 0x8000),
        (
            "other-component",
            "the other component of a normal that is as long as the greatest",
            5,
            16,
            16,
            0x8000,
        ),
        ("step", "steps that are too small", 7, 55, 6, 51),
        ("step-least", "the least step that can be written", 7, 55, 6, 63),
        ("step-half", "steps that are too large: half the universe", 9, 55, 6, 1),
        ("step-one", "steps that are as large as the universe", 15, 55, 6, 0),
    ] {
        add("cell-slab", of, about, surface(at as u64 / 2), &model, &|parts| {
            part(parts, at, shift, bits, value)
        });
    }
    for (of, about, at, value) in [
        (
            "edge-great",
            "slabs of cells in a universe that is too large for them",
            56,
            2f64.powi(64).next_up(),
        ),
        (
            "edge-small",
            "slabs of cells in a universe that is too small for them",
            56,
            2f64.powi(-64).next_down(),
        ),
        ("origin-great", "slabs of cells in a universe that is too far away for them", 40, -2f64.powi(65)),
        (
            "origin-small",
            "slabs of cells in a universe whose origin is too near to zero for them",
            48,
            2f64.powi(-65),
        ),
    ] {
        let mut bytes = Parts::of(&model).bytes();
        put(&mut bytes, at, value.to_bits(), 8);
        super::mirror(&mut bytes);
        super::seal(&mut bytes);
        list.add("cell-slab", of, about, surface(0), bytes);
    }
    let mut add = |rule, of: &str, about, error: String, model: &Model, change: &dyn Fn(&mut Parts)| {
        list.add(rule, of, about, error, changed(model, change));
    };
    let about = "a slab of a cell that is not legal, behind records";
    add("cell-slab", "behind", about, surface(2), &mixed, &|parts| part(parts, 1, 61, 2, 3));
}

/// Invalid moments.
fn moments(list: &mut List) {
    let model = ball_with_moments();
    // Offsets: the point from 0 on, the volume from 3, the first moments from 5, the second moments from 11.
    let legal = model.cuts.as_ref().and_then(|cuts| cuts.moments).expect("moments");
    assert!(legal[3] > 0.0 && legal[7] < 0.0 && legal[5..7] == [0.0; 2]);
    for (of, about, place, value) in [
        ("nan", "an end of the volume that is no number", 4, f64::NAN),
        ("nan-point", "a coordinate of the point that is no number", 1, f64::NAN),
        ("nan-negative", "an end of a second moment that is no number, with a sign", 21, -f64::NAN),
        ("infinite", "an infinite volume", 4, f64::INFINITY),
        ("infinite-point", "a point that lies nowhere", 0, f64::INFINITY),
        ("negative-infinite", "a second moment without a lower end", 21, f64::NEG_INFINITY),
        ("negative-zero", "-0 as the lower end of a first moment", 5, -0.0),
        ("negative-zero-upper", "-0 as the upper end of a first moment", 6, -0.0),
        ("negative-zero-point", "-0 in the point", 0, -0.0),
        ("negative-zero-volume", "-0 as the lower end of the volume", 3, -0.0),
        ("order", "a first moment whose lower end is above the upper one", 5, f64::from_bits(1)),
        ("order-volume", "a volume whose lower end is above the upper one", 3, legal[4].next_up()),
        ("order-first", "a first moment whose upper end is below the lower one", 8, legal[7].next_down()),
        ("order-second", "the last second moment, whose upper end is below the lower one", 22, -f64::MAX),
        ("negative-volume", "a volume that may be less than nothing", 3, -f64::from_bits(1)),
    ] {
        let bytes = changed(&model, |parts| {
            put(&mut parts.section(MOMENTS).bytes, 8 * place, value.to_bits(), 8);
        });
        list.add("moments", of, about, "Damaged(Moments)".to_owned(), bytes);
    }
}

/// The number of surfaces of each table.
const SURFACES_OF: [u8; 256] = {
    let mut counts = [0; 256];
    let mut head = 0;
    while head < 256 {
        let table = head as u8;
        counts[head] = if (table & 0xF0) >> 4 != table & 0x0F {
            3
        } else if (table & 0xCC) >> 2 != table & 0x33 {
            2
        } else {
            ((table & 0xAA) >> 1 != table & 0x55) as u8
        };
        head += 1;
    }
    counts
};

/// A PARTIAL universe with a table of these surfaces.
fn table_of(surfaces: Vec<Surface>) -> Model {
    let table = match surfaces.len() {
        1 => POSITIVE,
        2 => table(|a, b, _| a && b),
        _ => table(|a, b, c| a && b && c),
    };
    whole(2, Cuts::everywhere(surfaces, table))
}

fn surfaces(list: &mut List) {
    let plane = || Surface::plane(1.0, 2.0, 3.0, -4.0);
    let two = || table_of(vec![plane(), Surface::ball([1.0; 3], 1.5)]);
    let mut add = |rule, of: &str, about, error: String, model: &Model, change: &dyn Fn(&mut Parts)| {
        list.add(rule, of, about, error, changed(model, change));
    };
    let word =
        |parts: &mut Parts, at: usize, value: u64| put(&mut parts.section(SURFACES).bytes, at, value, 4);
    add("surface-record", "kind", "a surface of an unknown kind", surface(1), &two(), &|parts| {
        word(parts, 16, 5)
    });
    let about = "a plane with a fifth number";
    add("surface-record", "terms", about, surface(0), &two(), &|parts| word(parts, 4, 0o11111));
    let about = "a bit beyond the ten numbers of a quadric";
    add("surface-record", "terms-bit", about, surface(1), &two(), &|parts| {
        let terms = super::number(&parts.section(SURFACES).bytes, 20, 4);
        word(parts, 20, terms | 1 << 31);
    });
    add(
        "surface-record",
        "kind-great",
        "the greatest kind that a byte can tell",
        surface(1),
        &two(),
        &|parts| word(parts, 16, 255),
    );
    let about = "doubles that begin before those of the first surface end";
    add("surface-record", "first", about, surface(1), &two(), &|parts| word(parts, 24, 3));
    add("surface-record", "begin", "the first doubles are no numbers", surface(0), &two(), &|parts| {
        word(parts, 8, 1)
    });
    add("surface-record", "more", "a double that no surface has", surface(2), &two(), &|parts| {
        parts.section(NUMBERS).bytes.extend(1f64.to_le_bytes());
    });
    add(
        "surface-record",
        "less",
        "the doubles end before those of a surface",
        surface(1),
        &two(),
        &|parts| {
            pop(&mut parts.section(NUMBERS).bytes, 8);
        },
    );

    let numbers = |list: &mut List, of: &str, about, wrong: Surface| {
        let model = table_of(vec![plane(), wrong]);
        list.add("surface-number", of, about, surface(1), Parts::of(&model).bytes());
    };
    let odd = |i: usize, doubles: &[f64]| plane().with(i, doubles);
    for (of, about, value) in [
        ("nan", "a number that is none", f64::NAN),
        ("infinite", "an infinite number", f64::INFINITY),
        ("negative-infinite", "minus infinity", f64::NEG_INFINITY),
        ("zero", "a zero that is stored", 0.0),
        ("negative-zero", "-0", -0.0),
    ] {
        numbers(list, of, about, odd(3, &[value]));
    }
    let about = "a second double that is too great";
    numbers(list, "sum", about, odd(0, &[1.0, 2f64.powi(-53).next_up()]));
    numbers(list, "sum-zero", "a second double that is zero", odd(0, &[1.0, 0.0]));
    numbers(list, "sum-nan", "a second double that is no number", odd(0, &[1.0, f64::NAN]));
    let about = "a second double that is too great beside one that a product with 2^-53 would be rounded for";
    numbers(list, "sum-tiny", about, odd(0, &[3.0 * 2f64.powi(-1022), f64::from_bits(2)]));
    let about = "a third double that is too great";
    numbers(list, "sum-third", about, odd(3, &[-1.0, 2f64.powi(-60), 2f64.powi(-100)]));
    numbers(list, "plane", "a plane without a normal", Surface::plane(0.0, 0.0, 0.0, 1.0));
    let constant = Surface::new(Kind::Quadric, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    numbers(list, "quadric", "a quadric that is constant", constant);
    let good = [1.0, 0.5, 3.0, 1.0, 0.0, 2.0, 1.0, 0.0, 1.0, -1.0];
    let powers = |i: usize, doubles: &[f64]| Surface::new(Kind::Powers, &good).with(i, doubles);
    for (of, about, wrong) in [
        ("powers-nothing", "an exponent of 0", powers(2, &[])),
        ("powers-negative", "a negative exponent", powers(5, &[-2.0])),
        ("powers-high", "an exponent of 65", powers(8, &[65.0])),
        ("powers-broken", "an exponent that is no whole number", powers(2, &[2.5])),
        ("powers-two", "an exponent that is a sum", powers(2, &[3.0, 2f64.powi(-60)])),
        ("powers-low", "no exponent that is greater than 2", powers(2, &[2.0])),
        ("powers-unused", "the only exponent greater than 2 has no coefficient", powers(0, &[])),
        ("powers-sum", "a coefficient that is a sum", powers(3, &[1.0, 2f64.powi(-60)])),
        ("powers-great", "a constant that is too great", powers(9, &[2f64.powi(257)])),
        ("powers-small", "a centre that is too small", powers(1, &[2f64.powi(-257)])),
    ] {
        numbers(list, of, about, wrong);
    }
    let torus = |i: usize, doubles: &[f64]| Surface::new(Kind::Torus, &[2.0, 1.0, 1.0, 0.0]).with(i, doubles);
    for (of, about, wrong) in [
        ("torus-radius", "a torus whose circle has a negative radius", torus(0, &[-2.0])),
        ("torus-point", "a torus whose circle is a point", torus(0, &[])),
        ("torus-square", "a torus whose other radius has a negative square", torus(1, &[-1.0])),
        ("torus-scale", "a torus of a negative scale", torus(2, &[-1.0])),
    ] {
        numbers(list, of, about, wrong);
    }
    let slab = |inner: f64, outer: f64| Surface::slab([1.0, 0.0, 0.5], inner, outer);
    for (of, about, wrong) in [
        ("slab-order", "a slab whose outer face lies before the inner one", slab(1.0, 0.5)),
        ("slab-flat", "a slab without a normal", Surface::slab([0.0; 3], 0.0, 1.0)),
        ("slab-sum", "an offset of a slab that is a sum", slab(1.0, 2.0).with(4, &[2.0, 2f64.powi(-60)])),
        ("slab-normal", "an entry of a normal that is a sum", slab(1.0, 2.0).with(0, &[1.0, 2f64.powi(-60)])),
    ] {
        numbers(list, of, about, wrong);
    }
    // A slab with an origin, and with a number that is not its place.
    let slab = || table_of(vec![slab(1.0, 2.0).of(5, 6)]);

    let mut add = |rule, of: &str, about, error: String, model: &Model, change: &dyn Fn(&mut Parts)| {
        list.add(rule, of, about, error, changed(model, change));
    };
    let about = "the first slab has the second origin";
    add("surface-origin", "", about, surface(0), &slab(), &|parts| {
        word(parts, 0, 4 | 2 << 8);
        parts.section(ORIGINS).bytes.extend([7; 16]);
    });
    let about = "a slab with the greatest origin that a record can name";
    add("surface-origin", "great", about, surface(0), &slab(), &|parts| word(parts, 0, 4 | 0xFF_FFFF << 8));
    let about = "a plane with an origin";
    add("surface-origin", "plane", about, surface(0), &two(), &|parts| {
        word(parts, 0, 1 << 8);
        parts.sections.push(Section::new(ORIGINS, (U64, 2), vec![7; 16]));
    });
    let about = "a number of a slab that has no origin";
    add("surface-origin", "needless-number", about, surface(0), &slab(), &|parts| {
        word(parts, 0, 4);
        parts.take(ORIGINS);
    });
    let about = "a number of a slab that is its place, and is stored";
    add("surface-origin", "number", about, surface(0), &slab(), &|parts| {
        let words = &mut parts.section(NUMBERS).bytes;
        let at = words.len() - 8;
        put(words, at, 0, 8);
    });
    for (of, about, more) in [
        ("slab-terms", "a slab with two words for its number", 2 << 15),
        ("slab-terms-bit", "a bit beyond the number of a slab", 1 << 15 | 1 << 18),
    ] {
        add("surface-record", of, about, surface(0), &slab(), &|parts| {
            let terms = super::number(&parts.section(SURFACES).bytes, 4, 4);
            word(parts, 4, terms & 0x7FFF | more);
            parts.section(NUMBERS).bytes.extend([1; 8]);
        });
    }
    let about = "an origin that no slab has";
    add("surface-origin", "unused", about, surface(1), &slab(), &|parts| {
        parts.section(ORIGINS).bytes.extend([7; 16]);
    });
    add("surface-origin", "none", "an origin that is not there", surface(0), &slab(), &|parts| {
        parts.take(ORIGINS);
    });
    let about = "an origin that is not there, of a slab whose number is its place";
    let first = table_of(vec![Surface::slab([1.0, 0.0, 0.5], 1.0, 2.0).of(5, 0)]);
    add("surface-origin", "absent", about, surface(1), &first, &|parts| {
        parts.take(ORIGINS);
    });

    let chain = || {
        let first = plane().placed(&[SHIFT, TURN]);
        table_of(vec![first, Surface::ball([1.0; 3], 1.5).placed(&[SHIFT, SHEAR])])
    };
    let outer = |parts: &mut Parts, i: usize, value: u64| {
        put(&mut parts.section(PLACEMENTS).bytes, 104 * i + 96, value, 8)
    };
    let about = "a map that is not there";
    add("surface-placement", "beyond", about, surface(1), &chain(), &|parts| word(parts, 28, 4));
    add("surface-placement", "absent", about, surface(0), &two(), &|parts| word(parts, 12, 1));
    let about = "the maps of the first surface are not the first ones";
    add("surface-placement", "order", about, surface(0), &chain(), &|parts| word(parts, 12, 3));
    let about = "a map that is its own outer one";
    add("surface-placement", "cycle", about, surface(0), &chain(), &|parts| outer(parts, 0, 1));
    let about = "a map whose outer one comes later";
    add("surface-placement", "later", about, surface(0), &chain(), &|parts| outer(parts, 1, 3));
    let about = "a map whose outer one is not there";
    add("surface-placement", "outer", about, surface(1), &chain(), &|parts| outer(parts, 2, u64::MAX));
    let about = "two new maps of a surface, the second of which is not the outer one of the first";
    add("surface-placement", "apart", about, surface(0), &chain(), &|parts| outer(parts, 1, 0));
    add("surface-placement", "unused", "a map that no surface has", surface(2), &chain(), &|parts| {
        let map = parts.section(PLACEMENTS).bytes[..104].to_vec();
        parts.section(PLACEMENTS).bytes.extend(map);
    });
    let long = table_of(vec![plane().placed(&[SHIFT; 65])]);
    add("surface-placement", "long", "a surface that is moved by 65 maps", surface(0), &long, &|_| {});
    for (of, about, value) in [
        ("negative-zero", "-0 in a map", -0.0),
        ("nan", "no number in a map", f64::NAN),
        ("infinite", "an infinite entry of a map", f64::INFINITY),
        ("great", "an entry of a map that is too great", 2f64.powi(64).next_up()),
        ("small", "an entry of a map that is too small", -(2f64.powi(-64).next_down())),
    ] {
        add("placement-map", of, about, placement(2), &chain(), &|parts| {
            put(&mut parts.section(PLACEMENTS).bytes, 208 + 8, value.to_bits(), 8);
        });
    }
    let singular = |rows: [[f64; 3]; 3]| {
        move |parts: &mut Parts| {
            for (i, row) in rows.iter().enumerate() {
                for (j, c) in row.iter().enumerate() {
                    put(&mut parts.section(PLACEMENTS).bytes, 8 * (4 * i + j), c.to_bits(), 8);
                }
            }
        }
    };
    let about = "a map onto a plane";
    let flat = singular([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]);
    add("placement-map", "flat", about, placement(0), &chain(), &flat);
    let about = "a map whose matrix is singular, which sums of rounded products do not tell";
    let row = [0.1, 0.7, -0.3];
    let sum = [row[0] * 2.0, row[1] * 2.0, row[2] * 2.0];
    let rows = singular([row, [0.9, 1e-9, 1e9], sum]);
    add("placement-map", "singular", about, placement(0), &chain(), &rows);
}
