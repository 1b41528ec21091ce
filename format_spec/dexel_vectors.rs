//! Test vectors with tri-dexel models. This file builds them number by number, without the library.

use super::{
    APPLICATION, COUNT, F32, F64, HEADER, Invalid, KIND, LEVELS, List, METADATA, NEWER, NO_PARENT, OBJECTS,
    OWNER, PLANES, Parts, RECORD, Section, U8, U16, U32, U64, VALUES, Way, changed, entries, entry, field,
    hex, mix, number, offset, put, record, required, section,
};
use leafless::Metadata;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Kinds of sections: the windows, and the first of the five kinds of each direction.
const WINDOWS: u64 = 32;
const STARTS: [u64; 3] = [33, 38, 43];
/// The kinds of a direction, relative to its first.
const SPANS: u64 = 1;
const NORMALS: u64 = 2;
const SURFACES: u64 = 3;
const MATERIALS: u64 = 4;
const NAMES: [&str; 5] = ["starts", "spans", "normals", "surfaces", "materials"];

/// The type of an object that is a tri-dexel model.
const DEXELS: u64 = 3;

/// Offset of the header's byte that says what is stored.
const FORM: usize = 71;

/// Codes for no surface, and for no normal in 16 and in 32 bits.
const NO_SURFACE: u32 = u32::MAX;
const NO_NORMAL: [u32; 3] = [0, 0x8080, 0x8000_8000];

/// An interval: both ends in cells, and its attributes. A model stores only the attributes of its format.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Both ends, in cells.
    pub ends: [f64; 2],
    /// Codes of the normals, in as many bits as the model stores.
    pub normals: [u32; 2],
    /// Numbers of surfaces.
    pub surfaces: [u32; 2],
    /// Number of the material.
    pub material: u32,
}

impl Interval {
    fn new(start: f64, end: f64) -> Interval {
        Interval {
            ends: [start, end],
            normals: [0x0101, 0x0001_0001],
            surfaces: [3, NO_SURFACE],
            material: 7,
        }
    }
}

/// A tri-dexel model.
#[derive(Debug, Clone)]
pub struct Dexels {
    /// The universe's lower corner.
    pub origin: [f64; 3],
    /// The universe's edge.
    pub edge: f64,
    /// The depth.
    pub depth: u8,
    /// True if ends are stored as doubles.
    pub double: bool,
    /// Bits of a normal, divided by 16.
    pub normals: usize,
    /// True if numbers of surfaces are stored.
    pub surfaces: bool,
    /// True if materials are stored.
    pub materials: bool,
    /// The file's metadata.
    pub metadata: Metadata,
    /// For each direction, the rays that are not empty, by their indices on the other two axes, the higher
    /// axis first.
    pub rays: [Option<BTreeMap<[u32; 2], Vec<Interval>>>; 3],
}

impl Dexels {
    /// A model with empty rays in these directions.
    pub fn new(depth: u8, directions: [bool; 3]) -> Dexels {
        Dexels {
            origin: [0.0; 3],
            edge: (1u64 << depth) as f64,
            depth,
            double: false,
            normals: 0,
            surfaces: false,
            materials: false,
            metadata: Metadata::new(),
            rays: directions.map(|has| has.then(BTreeMap::new)),
        }
    }

    fn carrying(self, double: bool, normals: usize, surfaces: bool, materials: bool) -> Dexels {
        Dexels { double, normals, surfaces, materials, ..self }
    }

    /// Returns the model with one more interval on the ray with the indices `u` and `v` on the other two
    /// axes.
    fn with(mut self, axis: usize, [u, v]: [u32; 2], interval: Interval) -> Dexels {
        self.rays[axis].as_mut().expect("a direction").entry([v, u]).or_default().push(interval);
        self
    }

    /// Adds a cuboid of cells, in all directions.
    fn cuboid(mut self, low: [u32; 3], high: [u32; 3]) -> Dexels {
        for (axis, [a, b]) in [[1, 2], [0, 2], [0, 1]].into_iter().enumerate() {
            for (u, v) in (low[a]..high[a]).flat_map(|u| (low[b]..high[b]).map(move |v| (u, v))) {
                if self.rays[axis].is_some() {
                    let interval = Interval::new(low[axis].into(), high[axis].into());
                    self = self.with(axis, [u, v], interval);
                }
            }
        }
        self
    }

    /// Random intervals on some rays. The directions are independent.
    pub fn random(seed: u64, depth: u8, form: u8) -> Dexels {
        let mut state = seed;
        let mut random = |end: u64| {
            state = mix(state.wrapping_add(0x9E37_79B9_7F4A_7C15));
            state % end
        };
        let directions = [0, 1, 2].map(|axis| form >> (5 + axis) & 1 != 0);
        let model = Dexels::new(depth, directions);
        let mut model =
            model.carrying(form & 1 != 0, (form >> 1 & 3) as usize, form & 8 != 0, form & 16 != 0);
        // Fixed-point ends are halves of cells; some double ends are not.
        let cells = 1u64 << depth;
        for axis in (0..3).filter(|&axis| directions[axis]) {
            for _ in 0..random(3 * cells) {
                let ray = [random(cells) as u32, random(cells) as u32];
                let mut at = 0;
                let mut list: Vec<Interval> = vec![];
                loop {
                    let touches = model.materials && !list.is_empty() && random(3) == 0;
                    let start = if touches { at } else { at + 1 + random(cells) };
                    let end = start + 1 + random(2 * cells);
                    if end > 2 * cells {
                        break;
                    }
                    let mut interval = Interval::new(start as f64 / 2.0, end as f64 / 2.0);
                    if model.double && !touches {
                        interval.ends[0] += 1.0 / (3 + random(7)) as f64 - 0.5;
                    }
                    interval.normals = [0, 1].map(|_| match random(4) {
                        0 => NO_NORMAL[model.normals],
                        _ => random(1 << 32) as u32 & 0x7F7F_7F7F,
                    });
                    interval.surfaces =
                        [0, 1].map(|_| if random(4) == 0 { NO_SURFACE } else { random(99) as u32 });
                    interval.material = list.last().map_or(0, |last| last.material + 1 + random(5) as u32);
                    list.push(interval);
                    at = end;
                }
                if !list.is_empty() {
                    model.rays[axis].as_mut().expect("a direction").insert([ray[1], ray[0]], list);
                }
            }
        }
        model
    }

    /// Returns the byte that says what is stored.
    pub fn form(&self) -> u8 {
        let directions = (0..3).map(|axis| u8::from(self.rays[axis].is_some()) << (5 + axis)).sum::<u8>();
        let carried = u8::from(self.surfaces) << 3 | u8::from(self.materials) << 4;
        u8::from(self.double) | (self.normals as u8) << 1 | carried | directions
    }

    /// Returns the least window that contains all rays that are not empty: the first ray, and the number of
    /// rays.
    fn window(&self, axis: usize) -> [[u32; 2]; 2] {
        let keys = || self.rays[axis].iter().flat_map(|rays| rays.keys());
        let least = |i: usize| keys().map(|key| key[i]).min().unwrap_or(0);
        let most = |i: usize| keys().map(|key| key[i] + 1).max().unwrap_or(0);
        [[least(1), least(0)], [most(1) - least(1), most(0) - least(0)]]
    }

    fn intervals(&self, axis: usize) -> impl Iterator<Item = &Interval> {
        self.rays[axis].iter().flat_map(|rays| rays.values().flatten())
    }

    /// Returns the units of fixed-point ends in a cell.
    fn unit(&self) -> f64 {
        f64::from(1u32 << (31 - self.depth))
    }

    fn parts(&self) -> Parts {
        let mut head = vec![0; HEADER];
        head[..8].copy_from_slice(&leafless::file::MAGIC);
        for (at, value, length) in
            [(10, 3, 2), (12, 128, 4), (16, 1, 4), (64, self.depth.into(), 1), (FORM, self.form().into(), 1)]
        {
            put(&mut head, at, value, length);
        }
        for (i, value) in self.origin.into_iter().chain([self.edge]).enumerate() {
            put(&mut head, 32 + 8 * i, value.to_bits(), 8);
        }
        let mut sections = vec![Section::new(OBJECTS, (RECORD, 16), vec![])];
        if self.metadata.iter().next().is_some() {
            let facts = self.metadata.iter().map(|(key, value)| {
                let lengths = [key, value].map(|text| (text.len() as u32).to_le_bytes());
                [&lengths.concat()[..], key.as_bytes(), value.as_bytes()].concat()
            });
            sections.push(Section::new(METADATA, (U8, 1), facts.collect::<Vec<_>>().concat()));
        }
        let axes = || (0..3).filter(|&axis| self.rays[axis].is_some());
        let windows = axes().flat_map(|axis| self.window(axis).concat()).flat_map(u32::to_le_bytes);
        sections.push(Section::new(WINDOWS, (U32, 4), windows.collect()));
        for axis in axes() {
            let rays = self.rays[axis].as_ref().expect("a direction");
            let [first, size] = self.window(axis);
            let mut starts = vec![0u32];
            for (v, u) in (0..size[1]).flat_map(|v| (0..size[0]).map(move |u| (v, u))) {
                let count = rays.get(&[first[1] + v, first[0] + u]).map_or(0, Vec::len);
                starts.push(starts.last().expect("a start") + count as u32);
            }
            put(&mut head, 72 + 8 * axis, u64::from(*starts.last().expect("a start")), 8);
            let all = |bytes: &dyn Fn(&Interval) -> Vec<u8>| -> Vec<u8> {
                self.intervals(axis).flat_map(bytes).collect()
            };
            let pair = |numbers: [u32; 2]| numbers.map(u32::to_le_bytes).concat();
            let spans = all(&|interval| {
                let ends = interval.ends;
                if self.double {
                    return ends.map(f64::to_le_bytes).concat();
                }
                let [start, end] = ends.map(|end| end * self.unit());
                assert!(start.fract() == 0.0 && end.fract() == 0.0, "a whole number of units");
                pair([start as u32, (end - start) as u32])
            });
            let normals = all(&|interval| match self.normals {
                1 => interval.normals.map(|code| (code as u16).to_le_bytes()).concat(),
                _ => pair(interval.normals),
            });
            let columns = [
                (0, (U32, 1), true, starts.iter().flat_map(|start| start.to_le_bytes()).collect()),
                (SPANS, if self.double { (F64, 2) } else { (U32, 2) }, true, spans),
                (NORMALS, ([U32, U16, U32][self.normals], 2), self.normals != 0, normals),
                (SURFACES, (U32, 2), self.surfaces, all(&|interval| pair(interval.surfaces))),
                (
                    MATERIALS,
                    (U32, 1),
                    self.materials,
                    all(&|interval| interval.material.to_le_bytes().to_vec()),
                ),
            ];
            for (kind, element, _, bytes) in
                columns.into_iter().filter(|(_, _, stored, bytes)| *stored && !bytes.is_empty())
            {
                sections.push(Section::new(STARTS[axis] + kind, element, bytes));
            }
        }
        let mut parts = Parts { head, sections };
        parts.object(DEXELS, NO_PARENT, 1);
        parts
    }

    /// Returns the file.
    pub fn bytes(&self) -> Vec<u8> {
        self.parts().bytes()
    }

    /// Returns the stored part of a code.
    fn code(&self, code: u32) -> u32 {
        if self.normals == 1 { code & 0xFFFF } else { code }
    }

    /// Returns whether the centre of a cell lies inside according to a direction.
    pub fn holds(&self, axis: usize, cell: [u32; 3]) -> Option<bool> {
        let [a, b] = [[1, 2], [0, 2], [0, 1]][axis];
        let ray = self.rays[axis].as_ref()?.get(&[cell[b], cell[a]]);
        let centre = f64::from(cell[axis]) + 0.5;
        Some(ray.is_some_and(|ray| ray.iter().any(|one| one.ends[0] <= centre && centre < one.ends[1])))
    }
}

/// A file that readers must accept, and its contents.
pub struct ValidDexels {
    /// Name of the file without its ending.
    pub name: &'static str,
    /// Purpose of the file.
    pub about: &'static str,
    /// True if a writer should make this file of the model.
    pub canonical: bool,
    /// The file.
    pub bytes: Vec<u8>,
    /// The model.
    pub model: Dexels,
}

/// A bracket of two touching cuboids, in every direction. The upper one is of another material.
fn bracket() -> Dexels {
    let model = Dexels::new(3, [true; 3]).carrying(false, 2, true, true);
    let mut model = model.cuboid([1, 1, 1], [6, 7, 3]);
    for (u, v) in (1..3).flat_map(|u| (1..7).map(move |v| (u, v))) {
        let upper = Interval { material: 9, surfaces: [NO_SURFACE, 5], ..Interval::new(3.0, 6.5) };
        model = model.with(2, [u, v], upper);
    }
    model
}

/// All valid vectors.
pub fn valid() -> Vec<ValidDexels> {
    let mut vectors = vec![];
    let mut add = |name, about, model: Dexels| {
        let bytes = model.bytes();
        vectors.push(ValidDexels { name, about, canonical: true, bytes, model });
    };
    let cube = || Dexels::new(2, [true; 3]).cuboid([1, 1, 1], [3, 3, 4]);
    let about = "a tri-dexel model: a cuboid of 2 · 2 · 3 cells, with fixed-point ends and nothing besides";
    add("dexel-cuboid", about, cube());
    let about = "a model without an interval, in three directions: windows of nothing";
    add("dexel-empty", about, Dexels::new(5, [true; 3]).carrying(true, 1, true, true));
    let about = "one direction, one ray, one interval that fills the universe, at depth 1";
    add(
        "dexel-depth-1",
        about,
        Dexels::new(1, [false, true, false]).with(1, [1, 0], Interval::new(0.0, 2.0)),
    );
    let far = [1_048_575; 2];
    let deep = Dexels::new(20, [true, false, true])
        .with(0, far, Interval::new(1_048_575.0, 1_048_576.0))
        .with(2, [0, 0], Interval::new(0.0, 1.0 / 2048.0))
        .with(2, [2, 3], Interval::new(524_287.5, 524_288.0));
    add(
        "dexel-depth-20",
        "two directions, at the greatest depth, in corners and in the shortest interval",
        deep,
    );
    let about = "two materials that touch, normals of 32 bits, surfaces, of which some are not known";
    add("dexel-bracket", about, bracket());
    let mut frame = bracket().carrying(true, 1, true, true);
    (frame.origin, frame.edge) = ([-9.0, 0.1, 1e5 / 3.0], 10.0 / 3.0);
    frame.metadata.insert("name", "Winkel");
    frame.metadata.insert("units", "mm");
    let about =
        "all that can be stored, ends as doubles, normals of 16 bits, in a universe of other coordinates";
    add("dexel-double", about, frame);
    let thirds = Dexels::new(4, [false, false, true]).carrying(true, 0, false, false);
    let thirds = thirds
        .with(2, [3, 5], Interval::new(1.0 / 3.0, 7.0 / 3.0))
        .with(2, [3, 5], Interval::new(7f64.next_up(), 7.5f64.next_down()))
        .with(2, [9, 5], Interval::new(5e-324, 16.0));
    add("dexel-doubles", "doubles beside centres of cells, and the smallest one above 0", thirds);
    let about = "normals of 16 bits and nothing else, of which some are not known";
    let unknown = Interval { normals: [0x8080, 0x7F81], ..Interval::new(0.5, 1.5) };
    let codes = Dexels::new(2, [true, true, false]).carrying(false, 1, false, false);
    let codes = codes.with(0, [0, 1], unknown).with(1, [2, 2], Interval::new(1.0, 4.0));
    add("dexel-normals", about, codes);
    let about = "directions that do not agree about a cell: no rule asks for it";
    let apart = Dexels::new(2, [true; 3]).with(0, [1, 1], Interval::new(1.0, 3.0));
    add("dexel-apart", about, apart);
    for (name, form) in [("dexel-random-fixed", 0b1111_1100), ("dexel-random-double", 0b1111_1101)] {
        add(name, "intervals by chance, with all that can be stored", Dexels::random(5, 3, form));
    }

    let mut unusual = |name, about, model: Dexels, change: &dyn Fn(&mut Parts)| {
        let mut parts = model.parts();
        change(&mut parts);
        parts.sort();
        vectors.push(ValidDexels { name, about, canonical: false, bytes: parts.bytes(), model });
    };
    let about = "a tri-dexel model beside objects of other types, with sections of unknown kinds";
    unusual("dexel-unknown-parts", about, cube(), &|parts| {
        parts.object(2, 0, 0).fill(0xA5);
        parts.object(9, 1, 0);
        parts.sections.push(Section::new(VALUES, (F32, 4), vec![0x3F; 32]).of(1));
        parts.sections.push(Section::new(APPLICATION, (U16, 1), vec![1; 6]));
        // A kind's meaning for octrees does not apply to tri-dexel models.
        parts.sections.push(Section::new(PLANES, (U8, 1), vec![2; 5]).flagged(0));
        parts.sections.push(Section::new(WINDOWS, (U8, 3), vec![3; 9]).of(2));
    });
    let about = "three directions whose starts lie in one place, and two whose intervals do";
    unusual("dexel-shared", about, Dexels::new(2, [true; 3]).cuboid([1; 3], [3; 3]), &|parts| {
        for (kind, of) in
            [(STARTS[1], STARTS[0]), (STARTS[2], STARTS[0]), (STARTS[2] + SPANS, STARTS[0] + SPANS)]
        {
            let shared = parts.shared(of, 0, kind);
            assert_eq!(shared.bytes, parts.section(kind).bytes);
            *parts.section(kind) = shared;
        }
    });
    let about = "minor version 7: optional flags, reserved fields, flags of sections and objects";
    unusual("dexel-newer", about, bracket(), &|parts| {
        put(&mut parts.head, 10, 7, 2);
        put(&mut parts.head, 20, 0x8000_0001, 4);
        parts.head[112..124].fill(0x55);
        let record = parts.record(0);
        put(record, 8, 0x41, 4);
        for reserved in [22..24, 76..80, 112..128] {
            record[reserved].fill(0x66);
        }
        let windows = parts.section(WINDOWS);
        (windows.flags, windows.reserved) = (0x11, 0xEE);
    });
    vectors
}

impl ValidDexels {
    /// Returns the facts that a reader must find, as the lines of a text; `README.md` explains them.
    pub fn facts(&self) -> String {
        let (bytes, model) = (&self.bytes, &self.model);
        let mut text = String::new();
        let mut line = |key: &str, value: &dyn std::fmt::Display| {
            writeln!(text, "{key}: {value}").expect("strings grow");
        };
        line("about", &self.about);
        line("canonical", &if self.canonical { "yes" } else { "no" });
        line("length", &bytes.len());
        line("version", &format!("{}.{}", number(bytes, 8, 2), number(bytes, 10, 2)));
        let [x, y, z] = model.origin;
        line("origin", &format!("{} {} {}", hex(x), hex(y), hex(z)));
        line("origin-decimal", &format!("{x:?} {y:?} {z:?}"));
        line("edge", &hex(model.edge));
        line("edge-decimal", &format!("{:?}", model.edge));
        line("depth", &model.depth);
        line("ends", &if model.double { "double" } else { "fixed" });
        line("normals", &(16 * model.normals));
        line("surfaces", &if model.surfaces { "yes" } else { "no" });
        line("materials", &if model.materials { "yes" } else { "no" });
        line("objects", &number(bytes, entry(bytes, OBJECTS) + COUNT, 8));
        for (key, field) in [("sections", KIND), ("owners", OWNER)] {
            let numbers = entries(bytes).map(|at| number(bytes, at + field, 4).to_string());
            line(key, &numbers.collect::<Vec<_>>().join(" "));
        }
        let axes = || (0..3).filter(|&axis| model.rays[axis].is_some());
        for axis in axes() {
            let [first, size] = model.window(axis);
            let window = format!("{} {} {} {}", first[0], first[1], size[0], size[1]);
            line("direction", &format!("{axis} {window} {}", model.intervals(axis).count()));
        }
        for (key, value) in model.metadata.iter() {
            line("metadata", &format!("{key}\t{value}"));
        }
        for axis in axes() {
            for ([v, u], list) in model.rays[axis].iter().flatten() {
                for one in list {
                    let mut words = format!("{axis} {u} {v} {} {}", hex(one.ends[0]), hex(one.ends[1]));
                    if model.normals != 0 {
                        let [a, b] = one.normals.map(|code| model.code(code));
                        words += &format!(" {a} {b}");
                    }
                    if model.surfaces {
                        words += &format!(" {} {}", one.surfaces[0], one.surfaces[1]);
                    }
                    if model.materials {
                        words += &format!(" {}", one.material);
                    }
                    line("interval", &words);
                }
            }
        }
        for cell in self.cells() {
            let said = [0, 1, 2]
                .map(|axis| model.holds(axis, cell).map_or("none", |is| if is { "in" } else { "out" }));
            line("cell", &format!("{} {} {} {}", cell[0], cell[1], cell[2], said.join(" ")));
        }
        text
    }

    /// Some cells: cells beside the ends of some intervals, and random ones.
    fn cells(&self) -> Vec<[u32; 3]> {
        let most = (1 << self.model.depth) - 1;
        let mut cells = vec![[0; 3], [most; 3]];
        for axis in 0..3 {
            for ([v, u], list) in self.model.rays[axis].iter().flatten().step_by(7) {
                for end in list.iter().flat_map(|one| one.ends) {
                    for k in [end as u32, (end as u32).saturating_sub(1)] {
                        let mut cell = [*u, *u, *v];
                        cell[1] = if axis == 0 { *u } else { *v };
                        if axis == 2 {
                            cell = [*u, *v, 0];
                        }
                        cell[axis] = k.min(most);
                        cells.push(cell);
                    }
                }
            }
        }
        let chance = |i: u64| [0, 1, 2].map(|axis| (mix(3 * i + axis) % u64::from(most + 1)) as u32);
        cells.extend((0..20).map(chance));
        cells.dedup();
        cells
    }
}

fn damaged(axis: usize, ray: u64) -> String {
    format!("DamagedRays {{ axis: {axis}, ray: {ray} }}")
}

/// All invalid vectors.
pub fn invalid() -> Vec<Invalid> {
    let mut list = List { way: Way::Probing, vectors: vec![] };
    heads(&mut list);
    tables(&mut list);
    list.way = Way::Plain;
    before_use(&mut list);
    list.way = Way::Verification;
    contents(&mut list);
    list.vectors
}

fn heads(list: &mut List) {
    let good = bracket().bytes();
    let mut one = |rule, of: &str, about, error: String, at: usize, value: u64, length| {
        list.add(rule, of, about, error, super::with(&good, at, value, length));
    };
    let about = "a tri-dexel model in a version that does not know them";
    one("header-required-flags", "dexel-version", about, required("flags", 1), 10, 2, 2);
    one("header-required-flags", "dexel", "another required flag", required("flags", 2), 16, 3, 4);
    for (of, at, value) in [
        ("root", 65, 1),
        ("exterior", 66, 3),
        ("planes", 67, 1),
        ("encoding", 68, 1),
        ("shift", 69, 63),
        ("proof", 70, 3),
    ] {
        let about = "a field of octrees in the header of a tri-dexel model";
        one("dexel-field", of, about, field("field of octrees", value), at, value, 1);
    }
    let bits = 0.5f64.to_bits();
    let about = "a displacement of a tri-dexel model";
    one("dexel-field", "displacement", about, field("field of octrees", bits), 104, bits, 8);
    one("dexel-form", "", "no direction", field("form", 0x1C), FORM, 0x1C, 1);
    one("dexel-form", "normals", "normals of a third kind", field("form", 0xFE), FORM, 0xFE, 1);
    let about = "2^32 - 1 intervals along x";
    one("dexel-intervals", "many", about, field("intervals", 0xFFFF_FFFF), 72, 0xFFFF_FFFF, 8);
    let plane = Dexels::new(2, [true, true, false]).bytes();
    let about = "an interval along z, where there are no rays";
    list.add("dexel-intervals", "", about, field("intervals", 1), super::with(&plane, 88, 1, 8));
}

fn tables(list: &mut List) {
    let mut parts = |rule, of: &str, about, error: String, change: &dyn Fn(&mut Parts)| {
        let mut parts = bracket().parts();
        change(&mut parts);
        parts.sort();
        list.add(rule, of, about, error, parts.bytes());
    };
    for (i, name) in NAMES.iter().enumerate() {
        let (kind, name) = (STARTS[1] + i as u64, format!("{name} along y"));
        let of = |what: &str| format!("dexel-{}{what}", NAMES[i]);
        parts("section-size", &of(""), "another type of element", section(&name), &|parts| {
            let section = parts.section(kind);
            section.element = (F64, 1);
            section.bytes.resize(section.bytes.len().next_multiple_of(8), 0);
        });
        if i > 0 {
            parts("section-count", &of(""), "one element too many", section(&name), &|parts| {
                let whole = parts.section(kind);
                whole.bytes.extend(vec![0; whole.size()]);
            });
            parts("section-missing", &of(""), "it is absent", section(&name), &|parts| {
                parts.take(kind);
            });
        }
        parts("section-required", &of(""), "it is not required", field("section flags", 0), &|parts| {
            parts.section(kind).flags = 0;
        });
    }
    let about = "the windows are absent";
    parts("section-missing", "dexel-windows", about, section("windows"), &|parts| {
        parts.take(WINDOWS);
    });
    parts("section-count", "dexel-windows", "a window too many", section("windows"), &|parts| {
        parts.section(WINDOWS).bytes.extend([0; 16]);
    });
    parts("section-size", "dexel-windows", "windows of other numbers", section("windows"), &|parts| {
        parts.section(WINDOWS).element = (U64, 2);
    });
    let about = "a required section that only octrees have";
    parts("section-unknown", "dexel", about, required("section", LEVELS), &|parts| {
        parts.sections.push(Section::new(LEVELS, (U64, 3), vec![0; 24]));
    });
    let about = "a section of a tri-dexel model that an octree has, and that is required";
    let mut octree = Parts::of(&super::example());
    octree.sections.push(Section::new(WINDOWS, (U32, 4), vec![0; 16]));
    list.add("section-unknown", "windows", about, required("section", WINDOWS), octree.bytes());
    let mut plain = Dexels::new(2, [true; 3]).cuboid([1; 3], [3; 3]).parts();
    plain.sections.push(Section::new(STARTS[0] + NORMALS, (U32, 2), vec![1; 32]));
    plain.sort();
    let about = "normals that nothing is said of";
    list.add("section-count", "dexel-needless", about, section("normals along x"), plain.bytes());
}

fn before_use(list: &mut List) {
    let mut parts = |rule, of: &str, about, error: String, change: &dyn Fn(&mut Parts)| {
        let mut parts = bracket().parts();
        change(&mut parts);
        list.add(rule, of, about, error, parts.bytes());
    };
    let mirrored = "Format(Object)";
    parts("object-mirror", "dexel-reserved", "a reserved byte of the record", mirrored.into(), &|parts| {
        parts.record(0)[22] = 1;
    });
    for (of, about, at, value, length) in [
        ("dexel-type", "the record of a tri-dexel model is one of an octree", 0, 1, 4),
        ("dexel-values", "values of a tri-dexel model", 104, 1, 8),
        ("dexel-optional", "the record of a tri-dexel model is not required", 8, 0, 4),
    ] {
        parts("object-mirror", of, about, mirrored.into(), &|parts| put(parts.record(0), at, value, length));
    }
    let good = bracket().bytes();
    let form = changed(&good, |_| ());
    let mut form = form;
    let at = record(&form, 0) + 21;
    form[at] ^= 0x10;
    super::seal(&mut form);
    list.add("object-mirror", "dexel-form", "another form than the header's", mirrored, form);

    let mut window = |of: &str, about, axis: usize, change: &dyn Fn(&mut [u8])| {
        let mut parts = bracket().parts();
        change(&mut parts.section(WINDOWS).bytes[16 * axis..][..16]);
        list.add("dexel-window", of, about, field("window", axis as u64), parts.bytes());
    };
    window("", "a window that ends beyond the universe", 1, &|window| put(window, 0, 4, 4));
    window("overflow", "a window whose end is no number of 32 bits", 2, &|window| {
        put(window, 4, 0xFFFF_FFFF, 4)
    });
    window("empty", "a window without rays that begins somewhere", 0, &|window| put(window, 8, 0, 4));

    let mut parts = bracket().parts();
    let about = "a start less than there are rays";
    let starts = &mut parts.section(STARTS[2]).bytes;
    starts.truncate(starts.len() - 4);
    list.add("dexel-rays", "", about, section("starts along z"), parts.bytes());
    let mut parts = bracket().parts();
    parts.take(STARTS[0]);
    list.add("dexel-rays", "absent", "a direction without starts", section("starts along x"), parts.bytes());
    let mut parts = Dexels::new(2, [false, true, false]).parts();
    parts.sections.push(Section::new(STARTS[2], (U32, 1), vec![0; 4]));
    let about = "starts of a direction without rays";
    list.add("dexel-rays", "needless", about, section("starts along z"), parts.bytes());
    list.way = Way::Metadata;
    let mut parts = bracket();
    parts.metadata.insert("units", "mm");
    let mut parts = parts.parts();
    *parts.section(METADATA).bytes.last_mut().expect("a byte") = 0xFF;
    let about = "a fact of a tri-dexel model that is no UTF-8";
    list.add("metadata-text", "dexel", about, "Format(Metadata)", parts.bytes());
}

fn contents(list: &mut List) {
    let raw = bracket().bytes();
    let at = |axis: usize, kind: u64| offset(&raw, STARTS[axis] + kind);
    let mut one = |rule, of: &str, about, (axis, ray): (usize, u64), change: &dyn Fn(&mut Vec<u8>)| {
        list.add(rule, of, about, damaged(axis, ray), changed(&raw, change));
    };
    // Along x and y each ray of the bracket has one interval; along z the first two rays of each row have
    // two.
    let starts = at(0, 0);
    one("dexel-starts", "first", "the first ray begins at the second interval", (0, 0), &|bytes| {
        bytes[starts] = 1
    });
    let (last, all) = (at(1, 0) + 4 * 10, number(&raw, 80, 8));
    assert_eq!((number(&raw, last, 4), all), (10, 10));
    let about = "the last ray ends before the last interval";
    one("dexel-starts", "last", about, (1, 0), &|bytes| put(bytes, last, 9, 4));
    let about = "a ray that ends before it begins";
    one("dexel-starts", "", about, (2, 2), &|bytes| put(bytes, at(2, 0) + 12, 1, 4));
    let about = "a ray that ends behind the last interval";
    one("dexel-starts", "beyond", about, (2, 2), &|bytes| put(bytes, at(2, 0) + 12, 0xFFFF_0000, 4));
    let (span, spans) = (at(0, SPANS), at(2, SPANS));
    one("dexel-interval", "empty", "an interval of no length", (0, 0), &|bytes| put(bytes, span + 4, 0, 4));
    let about = "an interval that ends beyond the universe";
    one("dexel-interval", "beyond", about, (0, 1), &|bytes| put(bytes, span + 12, 0x7FFF_FFFF, 4));
    let about = "an interval whose end is no number of 32 bits";
    one("dexel-interval", "overflow", about, (0, 2), &|bytes| put(bytes, span + 20, 0xFFFF_FFFF, 4));
    let about = "two intervals of a ray that overlap";
    one("dexel-interval", "overlap", about, (2, 0), &|bytes| {
        let (start, length) = (number(bytes, spans + 8, 4), number(bytes, spans + 12, 4));
        put(bytes, spans + 8, start - 1, 4);
        put(bytes, spans + 12, length + 1, 4);
    });
    let about = "two intervals of a ray that descend";
    one("dexel-interval", "descend", about, (2, 0), &|bytes| {
        let first = bytes[spans..spans + 8].to_vec();
        bytes.copy_within(spans + 8..spans + 16, spans);
        bytes[spans + 8..spans + 16].copy_from_slice(&first);
    });
    let materials = at(2, MATERIALS);
    let about = "two intervals of a ray that touch and are of one material";
    one("dexel-interval", "touch", about, (2, 0), &|bytes| put(bytes, materials + 4, 7, 4));
    let normals = at(1, NORMALS);
    let about = "a normal of which the first component is none";
    one("dexel-normal", "", about, (1, 0), &|bytes| put(bytes, normals, 0x0001_8000, 4));
    let about = "a normal of which the second component is none";
    one("dexel-normal", "second", about, (1, 9), &|bytes| put(bytes, normals + 76, 0x8000_7FFF, 4));

    let plain = Dexels::new(2, [true, false, false]).carrying(false, 1, false, false);
    let plain = plain.with(0, [1, 1], Interval::new(1.0, 2.0)).with(0, [1, 1], Interval::new(2.0, 3.0));
    let about = "two intervals of a ray that touch, of which no material is known";
    list.add("dexel-interval", "touch-plain", about, damaged(0, 0), plain.bytes());
    let coarse = Interval { normals: [0x0080, 0x8080], ..Interval::new(1.0, 2.0) };
    let coarse =
        Dexels::new(2, [true, false, false]).carrying(false, 1, false, false).with(0, [1, 1], coarse);
    let about = "a normal of 16 bits of which the first component is none";
    list.add("dexel-normal", "coarse", about, damaged(0, 0), coarse.bytes());
    let double = |start: f64, end: f64| {
        let model = Dexels::new(2, [false, false, true]).carrying(true, 0, false, false);
        model.with(2, [3, 0], Interval::new(start, end)).bytes()
    };
    for (of, about, start, end) in [
        ("nan", "an interval that begins nowhere", f64::NAN, 1.0),
        ("end-nan", "an interval that ends nowhere", 0.0, f64::NAN),
        ("negative", "an interval that begins below the universe", -5e-324, 1.0),
        ("negative-zero", "an interval that begins at -0", -0.0, 1.0),
        ("infinite", "an interval that ends at infinity", 1.0, f64::INFINITY),
        ("end", "an interval that ends behind the universe", 1.0, 4f64.next_up()),
        ("reverse", "an interval that ends before it begins", 1.0, 0.5),
    ] {
        list.add("dexel-interval", of, about, damaged(2, 0), double(start, end));
    }
    for (of, about, low, high) in [
        ("", "a window with a row more than there are rays", [0, 1], [2, 3]),
        ("above", "a window with a last row of empty rays", [1, 1], [2, 4]),
        ("left", "a window with a first column of empty rays", [0, 1], [3, 2]),
        ("right", "a window with a last column of empty rays", [1, 1], [4, 2]),
    ] {
        let inner = if of == "left" || of.is_empty() { [1, 1] } else { low };
        let model = Dexels::new(2, [true, false, false]);
        let mut parts = model.with(0, inner, Interval::new(1.0, 2.0)).parts();
        let size = [high[0] - low[0], high[1] - low[1]];
        let window = [low, size].concat().into_iter().flat_map(u32::to_le_bytes);
        parts.section(WINDOWS).bytes = window.collect();
        let mut starts = vec![0u32];
        for (v, u) in (low[1]..high[1]).flat_map(|v| (low[0]..high[0]).map(move |u| (v, u))) {
            starts.push(starts.last().expect("a start") + u32::from([u, v] == inner));
        }
        parts.section(STARTS[0]).bytes = starts.into_iter().flat_map(u32::to_le_bytes).collect();
        list.add("dexel-hull", of, about, damaged(0, 0), parts.bytes());
    }
    let mut parts = Dexels::new(2, [true, false, false]).parts();
    parts.section(WINDOWS).bytes = [0u32, 0, 1, 1].into_iter().flat_map(u32::to_le_bytes).collect();
    parts.section(STARTS[0]).bytes = vec![0; 8];
    list.add("dexel-hull", "empty", "a window around an empty ray", damaged(0, 0), parts.bytes());
    let mut parts = bracket().parts();
    parts.section(STARTS[1] + SPANS).bytes[0] ^= 1;
    let mut bytes = parts.bytes();
    let at = offset(&bytes, STARTS[1] + SPANS);
    bytes[at] ^= 1;
    list.add("section-crc", "dexel", "a changed end", super::checksum("spans along y"), bytes);
    let _ = NEWER;
}
