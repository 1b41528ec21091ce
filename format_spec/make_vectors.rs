//! Makes the test vectors of the file format: small files, valid and invalid, and the expected results of a
//! reader for each.
//!
//! ```sh
//! cargo run --release --example make_vectors -- format_spec/vectors
//! ```
//!
//! The expected results of valid files do not come from the library's readers. Tags come from the shapes of
//! the files, counts from a plain recursion over the shapes, and the cells of points from integers.

pub mod cut_vectors;
pub mod dexel_vectors;

use leafless::attribute::{Channel, FillOptions, FunctionAttribute, ScalarType, ValueType, fill_channel};
use leafless::solid::{FreeParts, OneByOne, Question, WholeQuestion};
use leafless::{
    Cell, Classifier, Control, Error, Frame, Metadata, Octree, Proof, Rule, Solid, Tag, Verdict, Worker,
    build, file,
};
use num_bigint::{BigInt, Sign};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn main() -> std::io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1) else {
        eprintln!("usage: make_vectors FOLDER");
        std::process::exit(2);
    };
    for (path, bytes) in files() {
        let path = Path::new(&folder).join(path);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        std::fs::write(path, bytes)?;
    }
    Ok(())
}

/// Returns all files of the folder, by their paths in it.
pub fn files() -> Vec<(PathBuf, Vec<u8>)> {
    let (valid, mut invalid) = (valid(), invalid());
    invalid.extend(dexel_vectors::invalid());
    let mut files = vec![(PathBuf::from("README.md"), readme(&valid, &invalid).into_bytes())];
    for vector in &valid {
        files.push((format!("valid/{}.lfl", vector.name).into(), vector.bytes.clone()));
        files.push((format!("valid/{}.txt", vector.name).into(), vector.facts().into_bytes()));
    }
    for vector in dexel_vectors::valid() {
        files.push((format!("valid/{}.txt", vector.name).into(), vector.facts().into_bytes()));
        files.push((format!("valid/{}.lfl", vector.name).into(), vector.bytes));
    }
    for vector in &invalid {
        files.push((format!("invalid/{}.lfl", vector.name).into(), vector.bytes.clone()));
        files.push((format!("invalid/{}.txt", vector.name).into(), vector.facts().into_bytes()));
    }
    files
}

// ---- shapes ---------------------------------------------------------------------------------------------

/// The source of a tree: the tag of each cell, BRANCH for cells to be cut.
type Shape = Arc<dyn Fn(Cell) -> Tag + Send + Sync>;

/// A shape in a frame. It is solid, classifier and worker at once.
#[derive(Clone)]
struct Model {
    frame: Frame,
    exterior: Tag,
    proof: Proof,
    metadata: Metadata,
    shape: Shape,
    /// Channels in the order of their names.
    channels: Vec<Field>,
    cuts: Option<cut_vectors::Cuts>,
}

impl Solid for Model {
    type Classifier = Model;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<Model, Error> {
        Ok(Model { frame: *frame, ..self.clone() })
    }
}

impl Classifier for Model {
    type Worker = Model;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<Model, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        self.exterior
    }

    // The file's claim is set once the tree is made.
    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl FreeParts for Model {
    type Part = ();
}

impl OneByOne for Model {}

impl Worker for Model {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        Ok(self.verdict(Cell::ROOT))
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|k| self.verdict(cell.child(k))))
    }

    fn answer(&mut self, _: Cell, _: &(), _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl Model {
    fn new(
        origin: [f64; 3],
        edge: f64,
        depth: u8,
        shape: impl Fn(Cell) -> Tag + Send + Sync + 'static,
    ) -> Model {
        let frame = Frame::new(origin, edge, depth).expect("a frame in range");
        let (proof, metadata) = (Proof::CERTIFIED, Metadata::new());
        let channels = vec![];
        Model { frame, exterior: Tag::Empty, proof, metadata, shape: Arc::new(shape), channels, cuts: None }
    }

    /// A model on a frame whose lattice coordinates are model coordinates.
    fn plain(depth: u8, shape: impl Fn(Cell) -> Tag + Send + Sync + 'static) -> Model {
        Model::new([0.0; 3], (1u32 << depth) as f64, depth, shape)
    }

    fn exterior(mut self, exterior: Tag) -> Model {
        self.exterior = exterior;
        self
    }

    fn proof(mut self, proof: Proof) -> Model {
        self.proof = proof;
        self
    }

    fn moved(mut self, displacement: f64) -> Model {
        self.proof = self.proof.with_displacement(displacement).expect("a length");
        self
    }

    fn fact(mut self, key: &str, value: &str) -> Model {
        self.metadata.insert(key, value);
        self
    }

    fn channel(mut self, channel: Field) -> Model {
        self.channels.push(channel);
        self
    }

    fn cuts(self, cuts: cut_vectors::Cuts) -> Model {
        Model { cuts: Some(cuts), ..self }
    }

    fn verdict(&self, cell: Cell) -> Verdict<()> {
        match (self.shape)(cell) {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Partial => Verdict::Undecided,
            Tag::Branch => Verdict::Partial(()),
        }
    }

    fn octree(&self) -> Octree {
        let octree = build(self, &self.frame, Rule::Certified, &Control::threads(1)).expect("a tree");
        let octree = octree.with_proof(self.proof).with_metadata(self.metadata.clone());
        self.channels.iter().fold(octree, |octree, field| {
            octree.with_channel(field.channel(&self.frame)).expect("a channel of this cube")
        })
    }

    /// Returns the tag of a finest cell.
    fn finest(&self, at: [u32; 3]) -> Tag {
        let depth = self.frame.depth();
        let on = |level: u8| Cell { level, at: at.map(|a| a >> (depth - level)) };
        let tags = (0..=depth).map(|level| (self.shape)(on(level)));
        tags.into_iter().find(|&tag| tag != Tag::Branch).expect("the finest cells are not cut")
    }

    /// Returns the canonical tag of a cell. Adds the cells below it to `levels`, but not the cell itself.
    fn count(&self, cell: Cell, levels: &mut [[u64; 3]]) -> Tag {
        let tag = (self.shape)(cell);
        if tag != Tag::Branch {
            return tag;
        }
        let mut below = vec![[0; 3]; levels.len()];
        let mut children = [Tag::Empty; 8];
        for (k, child) in (0..).zip(&mut children) {
            *child = self.count(cell.child(k), &mut below);
            let counts = &mut below[cell.level as usize + 1];
            match child {
                Tag::Branch => counts[0] += 1,
                Tag::Full => counts[1] += 1,
                Tag::Partial => counts[2] += 1,
                Tag::Empty => {}
            }
        }
        if children[0] != Tag::Branch && children.iter().all(|&child| child == children[0]) {
            return children[0];
        }
        for (sum, below) in levels.iter_mut().flatten().zip(below.iter().flatten()) {
            *sum += below;
        }
        Tag::Branch
    }

    /// Returns the universe's tag and the level table: nodes, FULL and PARTIAL cells.
    fn levels(&self) -> (Tag, Vec<[u64; 3]>) {
        let mut levels = vec![[0; 3]; self.frame.depth() as usize + 1];
        let root = self.count(Cell::ROOT, &mut levels);
        levels[0] = [Tag::Branch, Tag::Full, Tag::Partial].map(|tag| (root == tag) as u64);
        (root, levels)
    }
}

/// A channel's value at a point.
type Value = Option<[f64; 4]>;

/// The source of a channel: for each finest cell of the channel's own lattice a value or none.
#[derive(Clone)]
struct Field {
    depth: u8,
    kind: ValueType,
    metadata: Metadata,
    value: Arc<dyn Fn([u32; 3]) -> Value + Send + Sync>,
}

/// The expected facts of a channel in a file.
struct Told {
    root: Tag,
    /// For each level, the numbers of nodes, of cells with a value, and of cells that start a value.
    levels: Vec<[u64; 3]>,
    values: u64,
}

impl Field {
    fn new(
        name: &str,
        depth: u8,
        (scalar, components): (ScalarType, u8),
        value: impl Fn([u32; 3]) -> Value + Send + Sync + 'static,
    ) -> Field {
        let kind = ValueType::new(scalar, components).expect("1 to 4");
        let mut metadata = Metadata::new();
        if !name.is_empty() {
            metadata.insert("name", name);
        }
        Field { depth, kind, metadata, value: Arc::new(value) }
    }

    fn fact(mut self, key: &str, value: &str) -> Field {
        self.metadata.insert(key, value);
        self
    }

    fn channel(&self, frame: &Frame) -> Channel {
        let frame = frame.with_depth(self.depth).expect("1 to 20");
        let value = self.value.clone();
        let at = move |point| value(frame.cell_of(point).expect("a point of the universe"));
        let attribute = FunctionAttribute::new(self.kind.components(), at).expect("1 to 4");
        let options = FillOptions { value_type: self.kind, frame, solid: None, detail: None };
        let channel = fill_channel(&attribute, &options, &Control::threads(1)).expect("a channel");
        channel.with_metadata(self.metadata.clone())
    }

    /// Returns the value of a cell; `None` if the cell has several values, or partly none.
    fn uniform(&self, level: u8, at: [u32; 3]) -> Option<Value> {
        if level == self.depth {
            return Some((self.value)(at));
        }
        let child = |k: u32| self.uniform(level + 1, [0, 1, 2].map(|axis| at[axis] << 1 | k >> axis & 1));
        let first = child(0)?;
        (1..8).all(|k| child(k) == Some(first)).then_some(first)
    }

    /// Returns the cells of a level in Morton order.
    fn morton(level: u8) -> impl Iterator<Item = [u32; 3]> {
        let bit =
            move |m: u32, axis: u32| (0..u32::from(level)).map(move |i| (m >> (3 * i + axis) & 1) << i).sum();
        (0..1u32 << (3 * level)).map(move |m| [0, 1, 2].map(|axis| bit(m, axis)))
    }

    fn told(&self) -> Told {
        let mut levels = vec![[0; 3]; self.depth as usize + 1];
        if let Some(value) = self.uniform(0, [0; 3]) {
            let values = value.is_some() as u64;
            levels[0] = [0, values, values];
            return Told { root: if value.is_some() { Tag::Full } else { Tag::Empty }, levels, values };
        }
        for level in 0..self.depth {
            let cut = Field::morton(level).filter(|&at| self.uniform(level, at).is_none());
            levels[level as usize][0] = cut.count() as u64;
        }
        let (mut before, mut values) = (None, 0);
        // The levels of the cells of elements.
        for level in (1..=self.depth).filter(|level| (self.depth - level).is_multiple_of(2)) {
            let above = level.min(2);
            for (m, at) in Field::morton(level).enumerate() {
                if self.uniform(level - above, at.map(|a| a >> above)).is_some() {
                    continue;
                }
                let Some(Some(value)) = self.uniform(level, at) else { continue };
                let starts = before != Some(value);
                before = Some(value);
                values += starts as u64;
                // Eight equal siblings are one cell.
                let whole = self.uniform(level - 1, at.map(|a| a >> 1)).is_some();
                let counts = &mut levels[(level - whole as u8) as usize];
                counts[1] += (!whole || m % 8 == 0) as u64;
                counts[2] += starts as u64;
            }
        }
        Told { root: Tag::Branch, levels, values }
    }
}

/// A value with one number.
fn one_value(value: f64) -> Value {
    Some([value, 0.0, 0.0, 0.0])
}

/// A shape given by its finest cells.
fn cells(depth: u8, tag: impl Fn([u32; 3]) -> Tag + Sync + 'static) -> impl Fn(Cell) -> Tag + Sync {
    move |cell| if cell.level < depth { Tag::Branch } else { tag(cell.at) }
}

/// A cube of the finest cells with all coordinates in `low..high`.
fn cuboid(depth: u8, low: u32, high: u32) -> impl Fn(Cell) -> Tag + Sync {
    cells(depth, move |at| solid(at.iter().all(|a| (low..high).contains(a))))
}

fn solid(inside: bool) -> Tag {
    if inside { Tag::Full } else { Tag::Empty }
}

fn mix(mut x: u64) -> u64 {
    x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ x >> 31
}

/// A different tree for every seed, with coarse and fine cells of the given tags.
fn noise(depth: u8, seed: u64, tags: &'static [Tag]) -> impl Fn(Cell) -> Tag + Sync {
    move |cell| {
        let hash = cell.at.iter().fold(mix(seed + 1 + cell.level as u64), |hash, &a| mix(hash ^ a as u64));
        let split = if cell.level == 0 { 256 } else { 110 };
        if cell.level < depth && hash % 256 < split {
            return Tag::Branch;
        }
        tags[(hash >> 32) as usize % tags.len()]
    }
}

const BINARY: &[Tag] = &[Tag::Empty, Tag::Full];
const CERTIFIED: &[Tag] = &[Tag::Empty, Tag::Full, Tag::Partial];

/// A certified ball, computed from cells of the lattice in integers.
fn ball(depth: u8) -> impl Fn(Cell) -> Tag + Sync {
    cells(depth, move |at| {
        let (centre, radius) = (1i64 << (depth - 1), (1i64 << (depth - 1)) - 1);
        let near = |a: u32| (a as i64 - centre).abs().min((a as i64 + 1 - centre).abs()).pow(2);
        let far = |a: u32| (a as i64 - centre).abs().max((a as i64 + 1 - centre).abs()).pow(2);
        let sum = |f: &dyn Fn(u32) -> i64| at.iter().map(|&a| f(a)).sum::<i64>();
        match (sum(&far) <= radius.pow(2), sum(&near) >= radius.pow(2)) {
            (true, _) => Tag::Full,
            (_, true) => Tag::Empty,
            _ => Tag::Partial,
        }
    })
}

/// Keeps only the first number.
fn first([value, ..]: [f64; 4]) -> [f64; 4] {
    [value, 0.0, 0.0, 0.0]
}

/// Values that the type can represent, among them the smallest and the greatest.
fn types_of(name: &str, depth: u8, kind: (ScalarType, u8)) -> Field {
    let list: &'static [f64] = match kind.0 {
        ScalarType::U8 => &[0.0, 255.0, 1.0, 7.0],
        ScalarType::U16 => &[0.0, 65_535.0, 256.0, 1.0],
        ScalarType::U32 => &[0.0, 4_294_967_295.0, 65_536.0, 16_777_217.0],
        ScalarType::F32 => &[0.0, -0.5, 3.402_823_466_385_288_6e38, 1.401_298_464_324_817e-45],
    };
    Field::new(name, depth, kind, move |at| {
        let hash = at.iter().fold(mix(17), |hash, &a| mix(hash ^ u64::from(a >> 1)));
        let number = |k: u32| if k < kind.1.into() { list[(hash >> (8 * k)) as usize % 4] } else { 0.0 };
        (hash >> 40 & 3 != 0).then(|| [0, 1, 2, 3].map(number))
    })
}

/// Coarse and fine regions with a few values, and with none.
fn grain(name: &str, depth: u8) -> Field {
    Field::new(name, depth, (ScalarType::F32, 1), move |at| {
        let hash = |bits: u8| at.iter().fold(mix(5), |hash, &a| mix(hash ^ u64::from(a >> (depth - bits))));
        match hash(1) % 4 {
            0 => None,
            1 => one_value(20.5),
            _ => match hash(2) % 6 {
                0 => one_value(hash(depth) as f64 % 5.0 - 2.25),
                1 => None,
                k => one_value(k as f64),
            },
        }
    })
}

/// The example with two channels. The first has odd depth, an element and bricks, the second has one brick.
fn channelled() -> Model {
    let second = |[x, y, z]: [u32; 3]| (x != 1).then_some([(x + y) as f64, z as f64, 0.0, 0.0]);
    example().channel(grain("a", 3).fact("unit", "K")).channel(Field::new(
        "b",
        2,
        (ScalarType::U16, 2),
        second,
    ))
}

/// The finest cells `marks` have tags of their own, and everything else is EMPTY. The branches are long, with
/// nothing beside them.
fn sparse(depth: u8, marks: &'static [([u32; 3], Tag)]) -> impl Fn(Cell) -> Tag + Sync {
    move |cell| {
        let below = |at: [u32; 3]| at.map(|a| a >> (depth - cell.level)) == cell.at;
        match marks.iter().find(|(at, _)| below(*at)) {
            Some((_, tag)) if cell.level == depth => *tag,
            Some(_) => Tag::Branch,
            None => Tag::Empty,
        }
    }
}

/// The tree of the example in the specification.
fn example() -> Model {
    let shape = cells(3, |[x, y, z]| match (x >> 2) | (y >> 2) << 1 | (z >> 2) << 2 {
        0 => Tag::Full,
        1 => [Tag::Full, Tag::Full, Tag::Partial, Tag::Empty][x as usize % 4],
        2 => Tag::Partial,
        7 => solid([x % 4, y % 4, z % 4] == [3, 1, 2]),
        _ => Tag::Empty,
    });
    Model::new([-1.0, 0.0, 0.5], 4.0, 3, shape).fact("units", "mm")
}

/// A corner with two channels on the same cells.
fn shared_channels() -> Model {
    let corner = Model::plain(4, sparse(4, &[([0; 3], Tag::Full)]));
    let value = |at: [u32; 3], low: f64| one_value(if at == [1, 2, 3] { low } else { low + 1.0 });
    let first = Field::new("first", 4, (ScalarType::U8, 1), move |at| value(at, 3.0));
    corner.channel(first).channel(Field::new("second", 4, (ScalarType::F32, 1), move |at| value(at, 0.5)))
}

/// Depth 5, binary. Faces away from the bricks' own faces make many bricks of few kinds, hence a dictionary.
fn coded() -> Model {
    Model::plain(5, cuboid(5, 2, 29))
}

/// Depth 6, decided in the elements, so that there is no brick.
fn without_bricks(tags: &'static [Tag]) -> Model {
    Model::plain(6, noise(4, 11, tags))
}

// ---- valid vectors --------------------------------------------------------------------------------------

/// A file that readers must accept, and its contents.
pub struct Valid {
    /// Name of the file without its ending.
    pub name: &'static str,
    /// Purpose of the file.
    pub about: &'static str,
    /// True if a writer should make this file of the tree.
    pub canonical: bool,
    /// The file.
    pub bytes: Vec<u8>,
    model: Model,
}

/// All valid vectors.
pub fn valid() -> Vec<Valid> {
    let mut vectors = vec![];
    let mut add = |name, about, model: Model| {
        let bytes = file::to_bytes(&model.octree()).expect("a file");
        vectors.push(Valid { name, about, canonical: true, bytes, model });
    };
    add("example", "the example of the specification", example());

    add("uniform-empty", "a universe that is EMPTY: no elements, no bricks", Model::plain(1, |_| Tag::Empty));
    let full = Model::plain(20, |_| Tag::Full).exterior(Tag::Full);
    add("uniform-full", "a universe that is FULL, at the greatest depth; exterior FULL", full);
    let partial = Model::plain(4, |_| Tag::Partial).exterior(Tag::Partial);
    add("uniform-partial", "a universe that is PARTIAL: two planes, but no brick; exterior PARTIAL", partial);

    let half = Model::plain(1, cells(1, |[x, _, _]| solid(x == 0)));
    add("depth-1", "the lower half along x: one brick, of which 8 cells exist", half);
    let all =
        |tags: &'static [Tag]| move |[x, y, z]: [u32; 3]| tags[(x + 2 * y + 4 * z) as usize % tags.len()];
    let depth_1 = Model::plain(1, cells(1, all(CERTIFIED)));
    add("depth-1-certified", "one brick of two planes, of which 8 cells exist", depth_1);
    add("depth-2", "one brick, all of which exists", Model::plain(2, noise(2, 3, BINARY)));
    add("depth-2-certified", "one brick of two planes", Model::plain(2, cells(2, all(CERTIFIED))));
    add("depth-3", "odd depth: the root element begins half-way", Model::plain(3, noise(3, 1, BINARY)));
    add("depth-4", "one element and raw bricks of one plane", Model::plain(4, noise(4, 2, BINARY)));
    let depth_4 = Model::plain(4, noise(4, 4, CERTIFIED));
    add("depth-4-certified", "one element and raw bricks of two planes", depth_4);
    add("depth-5-certified", "two levels of elements, odd depth", Model::plain(5, noise(5, 8, CERTIFIED)));
    let marks: &[_] = &[
        ([0; 3], Tag::Full),
        ([1_048_575; 3], Tag::Full),
        ([524_287; 3], Tag::Full),
        ([524_288; 3], Tag::Partial),
        ([1, 1_000_000, 77_777], Tag::Full),
        ([1, 1_000_000, 77_778], Tag::Partial),
    ];
    let model = Model::new([0.0; 3], 1.0, 20, sparse(20, marks));
    add("depth-20", "the greatest depth: six finest cells at the end of long branches", model);
    let marks: &[_] = &[([0, 0, 524_287], Tag::Full), ([262_144, 5, 6], Tag::Full)];
    add("depth-19", "the greatest odd depth: two finest cells", Model::plain(19, sparse(19, marks)));

    let about = "decided in elements, so that there is no brick; one plane";
    add("without-bricks", about, without_bricks(BINARY));
    let about = "PARTIAL cells in elements, and no brick: two planes of nothing";
    add("without-bricks-certified", about, without_bricks(CERTIFIED));
    let shape = |cell: Cell| {
        let die = |of: u64| cell.at.iter().fold(cell.level as u64, |hash, &a| mix(hash ^ a as u64)) % of;
        match cell.level {
            0..=4 if cell.at[0] << (4 - cell.level) > 4 => Tag::Empty,
            0..=5 | 7 => Tag::Branch,
            6 if die(4000) == 0 => Tag::Branch,
            _ => solid(die(2) == 0),
        }
    };
    add("many-elements", "more than 1024 elements: two numbers in `base`", Model::plain(8, shape));

    add("dictionary", "bricks of one plane through a dictionary", coded());
    let about = "bricks of two planes through a dictionary";
    add("dictionary-certified", about, Model::plain(6, ball(6)));

    let complement = Model::plain(3, cells(3, |at| solid(at != [2, 3, 4]))).exterior(Tag::Full);
    add("exterior-full", "all of space but one finest cell", complement);
    let clipped = Model::plain(3, cells(3, |[x, _, _]| solid(x < 5))).exterior(Tag::Partial);
    add("exterior-partial", "a solid that may go on outside of the universe", clipped);

    let depth_2 = || noise(2, 3, CERTIFIED);
    let frame = |origin: [f64; 3], edge: f64| Model::new(origin, edge, 2, depth_2());
    add("frame-negative", "a universe with negative coordinates only", frame([-9.0, -5.5, -1e6], 4.0));
    let (tiny, huge) = (f64::from_bits((1023 - 256) << 52), f64::from_bits((1023 + 256) << 52));
    add("frame-tiny", "the smallest edge and coordinates, 2^-256", frame([tiny, -tiny, 0.0], tiny));
    add("frame-huge", "the largest edge and coordinates, 2^256", frame([-huge, huge, 0.0], huge));
    let about =
        "an edge far below what doubles can tell at the origin: all planes of x lie between two doubles";
    add("frame-lost", about, frame([1e30, 0.0, 0.0], 1e-3));
    let marks: &[_] = &[
        ([0; 3], Tag::Full),
        ([349_525, 700_000, 12_345], Tag::Full),
        ([349_526, 700_000, 12_345], Tag::Partial),
        ([1_048_575; 3], Tag::Full),
    ];
    let thirds = Model::new([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0, 20, sparse(20, marks));
    add("frame-thirds", "neither planes nor cell size are representable in few bits", thirds);

    let model = || Model::plain(3, noise(3, 5, CERTIFIED));
    let facts = model()
        .fact("", "an empty key")
        .fact("empty", "")
        .fact("name", "Flansch Ø 120, 法兰")
        .fact("units", "mm")
        .fact("unit", "a prefix of the next key");
    add("metadata", "five facts: empty texts, other alphabets", facts);

    let proven = |full, empty| model().proof(Proof::new(full, empty));
    add("proof-full", "FULL is proven, EMPTY is not: inner cells of a solid", proven(true, false));
    add("proof-empty", "EMPTY is proven, FULL is not: outer cells of a solid", proven(false, true));
    add("proof-none", "nothing is proven: a sampled solid", proven(false, false));
    add("displacement", "surfaces were moved by 0.1 at the most", model().moved(0.1));
    let about = "nothing but FULL is proven, and surfaces were moved by as much as a number can say";
    add("displacement-greatest", about, proven(true, false).moved(f64::MAX));
    let about = "surfaces were moved by the smallest number above 0";
    add("displacement-smallest", about, model().moved(f64::from_bits(1)));

    let colour = Field::new("", 4, (ScalarType::U8, 4), |_| Some([200.0, 100.0, 0.0, 255.0]));
    let about = "a channel without a name that is one colour everywhere: a value and no element";
    add("channel-constant", about, model().channel(colour));
    let nothing = Field::new("nothing", 20, (ScalarType::F32, 1), |_| None);
    add(
        "channel-empty",
        "a channel that has a value nowhere",
        model().channel(Field { depth: 5, ..nothing }),
    );
    let types = model()
        .channel(types_of("a", 3, (ScalarType::U8, 1)).fact("unit", "°C").fact("meaning", "temperature"))
        .channel(types_of("b", 3, (ScalarType::U16, 2)).fact("unit", ""))
        .channel(types_of("c", 3, (ScalarType::U32, 3)))
        .channel(types_of("ç", 3, (ScalarType::F32, 4)).fact("unit", "m/s"));
    add("channel-types", "channels of all types and numbers of components, with units", types);
    let coarse =
        Field::new("half", 1, (ScalarType::U8, 1), |[x, _, z]| (z == 0).then_some([x as f64; 4]).map(first));
    let about = "a channel that is coarser than the solid: one brick, of which 8 cells exist";
    add("channel-coarser", about, Model::plain(4, noise(4, 2, BINARY)).channel(coarse));
    let about = "a channel that is finer than the solid, of odd depth, with regions without a value";
    add("channel-finer", about, Model::plain(2, noise(2, 3, BINARY)).channel(grain("heat", 5)));
    let about = "a channel of even depth beside a solid of odd depth, in a universe of other coordinates";
    add("channel-even", about, example().channel(grain("heat", 4)));
    let two = |at: [u32; 3]| one_value(if at[0] % 4 < 2 { 1.0 } else { 2.0 }).filter(|_| at[0] < 16);
    let about =
        "bricks of a channel through a dictionary, and more than 1024 of them: two numbers in `value base`";
    let many = Field::new("stripes", 6, (ScalarType::U8, 1), two);
    add("channel-dictionary", about, Model::plain(3, |_| Tag::Full).channel(many));

    let mut unusual = |name, about, model: Model, change: &dyn Fn(Parts) -> Vec<u8>| {
        let bytes = change(Parts::of(&model));
        vectors.push(Valid { name, about, canonical: false, bytes, model });
    };
    let about = "a section of an unknown kind that is not required";
    unusual("unknown-section", about, model(), &|mut parts| {
        parts.sections.push(Section::new(1000, (U16, 1), b"colours!".to_vec()));
        parts.bytes()
    });
    let about = "two sections of kinds that an application chose, of 32-bit floating point and of bytes";
    unusual("application-sections", about, model(), &|mut parts| {
        parts.sections.push(Section::new(APPLICATION, (F32, 3), vec![0x40; 36]));
        parts.sections.push(Section::new(u32::MAX.into(), (U8, 255), vec![7; 255]));
        parts.bytes()
    });
    let about = "two objects of unknown types, one the other's child, with sections of every element type, of which \
                 two are sections of the solid";
    unusual("unknown-objects", about, model().fact("units", "mm"), &|mut parts| {
        parts.object(2, 0, 0).fill(0xA5);
        parts.object(0x8000_0000, 1, 0);
        parts.object(7, NO_PARENT, 0).fill(0xFF);
        let own =
            [(16, (U8, 1)), (17, (U16, 2)), (18, (U32, 1)), (19, (U64, 1)), (20, (F32, 4)), (21, (F64, 1))];
        for (kind, element) in own {
            parts.sections.push(Section::new(kind, element, vec![0x3F; 32]).of(1).flagged(0));
        }
        // A kind's meaning for the solid does not apply to another object; nor does its being required.
        parts.sections.push(Section::new(REL, (F64, 2), vec![0; 16]).of(2).flagged(0));
        let levels = parts.shared(LEVELS, 3, LEVELS);
        let metadata = parts.shared(METADATA, 3, APPLICATION);
        parts.sections.extend([levels, metadata.flagged(0)]);
        parts.bytes()
    });
    let about = "two pairs of sections of the solid, each of which lies in one place";
    let corner = Model::plain(3, sparse(3, &[([0; 3], Tag::Full)]));
    unusual("shared-sections", about, corner, &|parts| {
        // `rel` and the brick indices are 0, `base` and the dictionary 1.
        let mut parts = parts.encoded();
        for (kind, of) in [(INDICES, REL), (ENTRIES, BASE)] {
            let section = parts.take(kind);
            let shared = parts.shared(of, 0, kind);
            assert!((section.bytes, section.element) == (shared.bytes.clone(), shared.element));
            parts.sections.push(shared);
        }
        parts.sort();
        parts.bytes()
    });
    let about = "minor version 7: optional flags, reserved fields, flags of sections and objects, an element type and an \
                 encoding that 0.1 does not know";
    unusual("newer-minor", about, model(), &|mut parts| {
        put(&mut parts.head, 10, 7, 2);
        put(&mut parts.head, 20, 0x8000_0001, 4);
        parts.head[71] = 0xAB;
        parts.head[112..124].fill(0x55);
        let solid = &mut parts.section(OBJECTS).bytes;
        put(solid, 8, 0x41, 4);
        for reserved in [21..24, 76..80, 112..128] {
            solid[reserved].fill(0x66);
        }
        parts.object(3, 0, 0xFFFF_FFFE).fill(0x77);
        let mut strange = Section::new(VALUES, (200, 3), b"tomorrow".to_vec()).flagged(6);
        (strange.encoding, strange.count) = (9, Some(1 << 60));
        parts.sections.push(strange);
        let mut packed = Section::new(17, (F32, 1), b"packed".to_vec()).of(1);
        (packed.encoding, packed.count) = (1, Some(1000));
        parts.sections.push(packed);
        let levels = parts.section(LEVELS);
        (levels.flags, levels.reserved) = (0x11, 0xEE);
        parts.bytes()
    });
    let about = "minor version 2, and no channel";
    unusual("version-needless", about, model(), &|mut parts| {
        put(&mut parts.head, 10, 2, 2);
        parts.bytes()
    });
    let about = "two channels on the same cells, of which all but the values lies in one place, and the links of the first \
                 are the solid's, too";
    unusual("channels-shared", about, shared_channels(), &|mut parts| {
        let base = parts.shared(BASE, 1, BASE);
        assert_eq!(base.bytes, parts.own(1, BASE).bytes);
        *parts.own(1, BASE) = base;
        for kind in [LEVELS, PLANES, REL, BASE, BRICKS, VALUE_REL, VALUE_BASE] {
            let of = if kind == BASE { 0 } else { 1 };
            let first = Section { owner: 2, same: Some((of, kind)), ..parts.own(1, kind).clone() };
            assert_eq!(first.bytes, parts.own(2, kind).bytes);
            *parts.own(2, kind) = first;
        }
        parts.bytes()
    });
    let about = "a channel beside an object of an unknown type, with sections of unknown kinds";
    unusual("channel-unknown-parts", about, model().channel(grain("heat", 3)), &|mut parts| {
        parts.object(9, 1, 0).fill(0xC3);
        parts.sections.push(Section::new(OBJECTS, (U8, 1), vec![1; 3]).of(1).flagged(0));
        parts.sections.push(Section::new(17, (F64, 1), vec![2; 24]).of(1));
        parts.sections.push(Section::new(APPLICATION, (U8, 1), vec![3; 3]).of(1));
        parts.sections.push(Section::new(VALUES, (U8, 1), vec![4; 3]).of(2));
        // A kind's meaning for a channel does not apply to the solid.
        parts.sections.push(Section::new(VALUES, (F32, 3), vec![5; 12]).flagged(0));
        parts.sort();
        parts.bytes()
    });
    let about = "minor version 5: reserved fields of a channel's record, its flags and those of its sections";
    unusual("channel-newer", about, model().channel(grain("heat", 3)), &|mut parts| {
        put(&mut parts.head, 10, NEWER, 2);
        let record = parts.record(1);
        put(record, 8, 0xFE, 4);
        for reserved in [21..24, 76..80, 112..128] {
            record[reserved].fill(0x99);
        }
        parts.own(1, VALUES).flags = 0x21;
        parts.own(1, PLANES).reserved = 0x44;
        let mut packed = Section::new(17, (77, 1), b"packed".to_vec()).of(1);
        (packed.encoding, packed.count) = (1, Some(1000));
        parts.sections.push(packed);
        parts.sort();
        parts.bytes()
    });
    unusual("unusual-raw", "raw bricks where a dictionary would be shorter", coded(), &|parts| {
        parts.decoded().bytes()
    });
    unusual("unusual-dictionary", "a dictionary where raw bricks are shorter", example(), &|parts| {
        parts.encoded().bytes()
    });
    let about = "more padding between sections than alignment needs";
    unusual("unusual-padding", about, example(), &|mut parts| {
        parts.sections.iter_mut().for_each(|section| section.gap = 64);
        parts.bytes()
    });
    vectors.extend(cut_vectors::valid());
    vectors
}

impl Valid {
    /// Returns the facts that a reader must find, as the lines of a text; `README.md` explains them.
    pub fn facts(&self) -> String {
        let (bytes, model) = (&self.bytes, &self.model);
        let (frame, (root, levels)) = (&model.frame, model.levels());
        let depth = frame.depth();
        let mut text = String::new();
        let mut line = |key: &str, value: &dyn std::fmt::Display| {
            writeln!(text, "{key}: {value}").expect("strings grow");
        };
        line("about", &self.about);
        line("canonical", &if self.canonical { "yes" } else { "no" });
        line("length", &bytes.len());
        line("version", &format!("{}.{}", number(bytes, 8, 2), number(bytes, 10, 2)));
        let [x, y, z] = frame.origin();
        line("origin", &format!("{} {} {}", hex(x), hex(y), hex(z)));
        line("origin-decimal", &format!("{x:?} {y:?} {z:?}"));
        line("edge", &hex(frame.edge()));
        line("edge-decimal", &format!("{:?}", frame.edge()));
        line("depth", &depth);
        line("root", &name(root));
        line("exterior", &name(model.exterior));
        let partial: u64 = levels.iter().map(|counts| counts[2]).sum();
        let Proof { full, empty, .. } = model.proof;
        line("proof", &(full as u8 + 2 * empty as u8));
        line("displacement", &hex(model.proof.displacement()));
        line("planes", &if partial == 0 { 1 } else { 2 });
        line("encoding", &["raw", "dictionary"][number(bytes, 68, 1) as usize]);
        line("shift", &number(bytes, 69, 1));
        let (elements, bricks) = entries_of(depth, &levels);
        line("elements", &elements);
        line("bricks", &bricks);
        line("entries", &number(bytes, 88, 8));
        line("objects", &number(bytes, entry(bytes, OBJECTS) + COUNT, 8));
        for (key, field) in [("sections", KIND), ("owners", OWNER)] {
            let numbers = entries(bytes).map(|at| number(bytes, at + field, 4).to_string());
            line(key, &numbers.collect::<Vec<_>>().join(" "));
        }
        for (level, [nodes, full, partial]) in levels.iter().enumerate() {
            line("level", &format!("{level} {nodes} {full} {partial}"));
        }
        let volume = |i: usize| -> u64 { (0..).zip(&levels).map(|(l, n)| n[i] << (3 * (depth - l))).sum() };
        line("cells", &format!("{} {}", volume(1), volume(1) + volume(2)));
        for (key, value) in model.metadata.iter() {
            line("metadata", &format!("{key}\t{value}"));
        }
        let owners: Vec<u64> = channels(bytes).collect();
        assert_eq!(owners.len(), model.channels.len());
        let told: Vec<Told> = model.channels.iter().map(Field::told).collect();
        for ((&owner, field), told) in owners.iter().zip(&model.channels).zip(&told) {
            let record = &bytes[record(bytes, owner)..];
            let encoding = ["raw", "dictionary"][number(record, 17, 1) as usize];
            let (elements, bricks) = entries_of(field.depth, &told.levels);
            let head = format!("{owner} {} {}", field.depth, name(told.root));
            let values =
                format!("{} {} {}", field.kind.scalar().name(), field.kind.components(), told.values);
            let (shift, dictionary) = (number(record, 18, 1), number(record, 96, 8));
            let coded = format!("{encoding} {shift} {elements} {bricks} {dictionary}");
            line("channel", &format!("{head} {values} {coded}"));
        }
        for (owner, told) in owners.iter().zip(&told) {
            for (level, [nodes, valued, starts]) in told.levels.iter().enumerate() {
                line("channel-level", &format!("{owner} {level} {nodes} {valued} {starts}"));
            }
        }
        for (owner, field) in owners.iter().zip(&model.channels) {
            for (key, value) in field.metadata.iter() {
                line("channel-metadata", &format!("{owner} {key}\t{value}"));
            }
        }
        for (key, value) in model.cut_facts() {
            line(key, &value);
        }
        for point in points(frame) {
            let answer = match cell_of(frame, point).map(|at| model.finest(at)) {
                Some(Tag::Full) => "inside",
                Some(Tag::Empty) => "outside",
                _ => "undecided",
            };
            line("point", &format!("{} {} {} {answer}", hex(point[0]), hex(point[1]), hex(point[2])));
        }
        for point in model.cut_points() {
            line("cut-point", &point);
        }
        for (owner, field) in owners.iter().zip(&model.channels) {
            let frame = frame.with_depth(field.depth).expect("1 to 20");
            for point in points(&frame) {
                let value = match cell_of(&frame, point).and_then(|at| (field.value)(at)) {
                    Some(value) => value[..field.kind.components()].iter().map(|&v| hex(v)).collect(),
                    None => vec!["none".to_owned()],
                };
                let [x, y, z] = point.map(hex);
                line("value", &format!("{x} {y} {z} {owner} {}", value.join(" ")));
            }
        }
        text
    }
}

/// Returns the numbers of elements and bricks, from the level table. They are the nodes of every second
/// level; the finest of these levels has the bricks.
fn entries_of(depth: u8, levels: &[[u64; 3]]) -> (u64, u64) {
    let own = |level: usize| level == 0 || (level + depth as usize).is_multiple_of(2);
    let last = (depth as usize).saturating_sub(2);
    let nodes = |range: std::ops::Range<usize>| -> u64 {
        range.filter(|&level| own(level)).map(|level| levels[level][0]).sum()
    };
    (nodes(0..last), nodes(last..depth as usize))
}

/// Returns the name of a tag in the specification.
pub fn name(tag: Tag) -> &'static str {
    match tag {
        Tag::Empty => "EMPTY",
        Tag::Branch => "BRANCH",
        Tag::Partial => "PARTIAL",
        Tag::Full => "FULL",
    }
}

/// Formats a double as C does with `%a`: without loss, and readable by `strtod`.
pub fn hex(value: f64) -> String {
    let sign = if value.is_sign_negative() { "-" } else { "" };
    if value.is_nan() {
        return "nan".into();
    }
    if value.is_infinite() {
        return format!("{sign}inf");
    }
    let (bits, one) = (value.to_bits(), 1u64 << 52);
    let (exponent, fraction) = ((bits >> 52 & 0x7FF) as i64, bits & (one - 1));
    let (lead, exponent) = match (exponent, fraction) {
        (0, 0) => (0, 0),
        (0, _) => (0, -1022),
        _ => (1, exponent - 1023),
    };
    let digits = format!("{fraction:013x}");
    let digits = digits.trim_end_matches('0');
    let dot = if digits.is_empty() { "" } else { "." };
    format!("{sign}0x{lead}{dot}{digits}p{exponent:+}")
}

// ---- points ---------------------------------------------------------------------------------------------

/// Returns a double as a multiple of 2^-1074.
fn integer(value: f64) -> BigInt {
    let bits = value.to_bits();
    let (exponent, fraction) = (bits >> 52 & 0x7FF, bits & ((1 << 52) - 1));
    let magnitude = match exponent {
        0 => BigInt::from(fraction),
        _ => BigInt::from(fraction | 1 << 52) << (exponent - 1),
    };
    if value.is_sign_negative() { -magnitude } else { magnitude }
}

/// Returns the finest cell that contains a point, by the specification's rule, in integers.
fn cell_of(frame: &Frame, point: [f64; 3]) -> Option<[u32; 3]> {
    let mut at = [0; 3];
    for axis in 0..3 {
        if !point[axis].is_finite() {
            return None;
        }
        let above = (integer(point[axis]) - integer(frame.origin()[axis])) << frame.depth();
        if above.sign() == Sign::Minus {
            return None;
        }
        let (edge, cells) = (integer(frame.edge()), BigInt::from(frame.cells()));
        let on_upper_face = above == &edge * &cells;
        let cell = if on_upper_face { cells.clone() - 1 } else { above / edge };
        if cell >= cells {
            return None;
        }
        at[axis] = u32::try_from(cell).expect("at most 2^20");
    }
    Some(at)
}

/// Points inside cells, on planes and next to planes, on the universe's faces, and outside.
fn points(frame: &Frame) -> Vec<[f64; 3]> {
    let (origin, edge, cells) = (frame.origin(), frame.edge(), frame.cells());
    let size = edge / cells as f64;
    // Rounded points. Their cells are determined in integers.
    let at = |t: [f64; 3]| [0, 1, 2].map(|axis| origin[axis] + t[axis] * size);
    let end = cells as f64;
    let mut points = vec![
        at([0.0; 3]),
        at([end; 3]),
        at([end / 2.0; 3]),
        at([end / 2.0; 3]).map(f64::next_down),
        at([end / 2.0; 3]).map(f64::next_up),
        at([0.5; 3]),
        at([end - 0.5; 3]),
        at([end / 2.0 - 0.5; 3]),
        at([end / 2.0 + 0.5; 3]),
        at([0.5, end - 0.5, end / 4.0 + 0.25]),
        // The cells that the sparse trees mark.
        at([1.25, 1_000_000.75, 77_777.5].map(|t| t % end)),
        at([1.25, 1_000_000.75, 77_778.0].map(|t| t % end)),
        at([349_525.0, 700_000.0, 12_345.0].map(|t| t % end)),
        at([349_525.5, 700_000.5, 12_345.5].map(|t| t % end)),
        at([349_526.5, 700_000.5, 12_345.5].map(|t| t % end)),
        at([0.5, 0.5, 524_287.5].map(|t| t % end)),
        at([262_144.0, 5.0, 6.0].map(|t| t % end)),
        at([2.5, 3.5, 4.5]),
        // The points of the specification's example.
        [2.5, 2.5, 3.5],
        [2.0, 1.0, 1.0],
        [3.0, 4.0, 4.5],
        [3.1, 2.0, 3.5],
    ];
    for i in 0..9 {
        let random = |n: u64| (mix(1000 + 10 * i + n) % (4 * cells as u64)) as f64 / 4.0;
        points.push(at([random(0), random(1), random(2)]));
    }
    let mut low = at([0.5; 3]);
    low[1] = origin[1].next_down();
    let mut high = at([end - 0.5; 3]);
    high[2] = at([end; 3])[2].next_up();
    points.extend([low, high, at([-1.0, 0.5, 0.5]), at([0.5, 0.5, end + 1.0])]);
    points.extend([[f64::NAN, 0.0, 0.0], [0.0, f64::INFINITY, 0.0], [0.0, 0.0, -1e300], [-0.0; 3]]);
    points
}

// ---- bytes ----------------------------------------------------------------------------------------------

/// Reads a little-endian number of `length` bytes.
pub fn number(bytes: &[u8], at: usize, length: usize) -> u64 {
    let mut raw = [0; 8];
    raw[..length].copy_from_slice(&bytes[at..at + length]);
    u64::from_le_bytes(raw)
}

/// Writes a little-endian number of `length` bytes.
pub fn put(bytes: &mut [u8], at: usize, value: u64, length: usize) {
    bytes[at..at + length].copy_from_slice(&value.to_le_bytes()[..length]);
}

/// Kinds of sections.
const OBJECTS: u64 = 1;
const METADATA: u64 = 2;
const LEVELS: u64 = 3;
const PLANES: u64 = 4;
const REL: u64 = 5;
const BASE: u64 = 6;
const BRICKS: u64 = 7;
const INDICES: u64 = 8;
const ENTRIES: u64 = 9;
const SEGMENTS: u64 = 10;
const VALUES: u64 = 16;
const VALUE_REL: u64 = 18;
const VALUE_BASE: u64 = 19;
/// The first kind that belongs to applications.
const APPLICATION: u64 = 1 << 31;

/// Types of elements.
const RECORD: u64 = 0;
const U8: u64 = 1;
const U16: u64 = 2;
const U32: u64 = 3;
const U64: u64 = 4;
const F32: u64 = 5;
const F64: u64 = 6;

/// The type of an object that is a channel.
const CHANNEL: u64 = 2;

/// The parent of an object that has none.
const NO_PARENT: u64 = u32::MAX as u64;

/// A minor version newer than this one.
const NEWER: u64 = 5;

/// Length of a header, and of the record of an object.
const HEADER: usize = 128;
/// Length of an entry of the section table, in bytes.
pub const ENTRY: usize = 48;

/// Offsets of the fields of an entry.
const KIND: usize = 0;
const OWNER: usize = 4;
const TYPE: usize = 8;
const COMPONENTS: usize = 9;
const ENCODING: usize = 10;
const RESERVED: usize = 11;
const FLAGS: usize = 12;
const OFFSET: usize = 16;
const LENGTH: usize = 24;
const COUNT: usize = 32;
const CRC: usize = 40;
const SAME: usize = 44;

/// The fields of the header that the solid's record repeats: offset in the header, offset in the record, and
/// length in bytes.
const MIRRORED: [(usize, usize, usize); 8] = [
    // Depth, root tag, exterior.
    (64, 12, 3),
    // Proof.
    (70, 15, 1),
    // Planes of a brick, brick encoding, segment shift.
    (67, 16, 3),
    // Displacement.
    (104, 24, 8),
    // Origin and edge.
    (32, 32, 32),
    (72, 80, 8),
    (80, 88, 8),
    (88, 96, 8),
];

/// Copies the header's fields into the solid's record, if there is one.
pub fn mirror(bytes: &mut [u8]) {
    let Some(at) = entries(bytes).next().filter(|&at| number(bytes, at + KIND, 8) == OBJECTS) else { return };
    let start = number(bytes, at + OFFSET, 8) as usize;
    if start < at || start.checked_add(HEADER).is_none_or(|end| end > bytes.len()) {
        return;
    }
    for (from, to, length) in MIRRORED {
        bytes.copy_within(from..from + length, start + to);
    }
    // The byte that says what a tri-dexel model stores.
    if number(bytes, start, 4) == 3 {
        bytes.copy_within(71..72, start + 21);
    }
}

/// Sets the checksums of all sections that lie in the file, of the table and of the header.
pub fn seal(bytes: &mut [u8]) {
    for at in entries(bytes) {
        let (start, length) = (number(bytes, at + OFFSET, 8), number(bytes, at + LENGTH, 8));
        let end = usize::try_from(start.saturating_add(length)).unwrap_or(usize::MAX);
        if let Some(section) = bytes.get(start as usize..end) {
            let crc = crc32fast::hash(section);
            put(bytes, at + CRC, crc.into(), 4);
        }
    }
    seal_head(bytes);
}

/// Sets the checksums of the table and of the header.
pub fn seal_head(bytes: &mut [u8]) {
    let end = HEADER + ENTRY * number(bytes, 96, 4) as usize;
    if let Some(table) = bytes.get(HEADER..end) {
        let crc = crc32fast::hash(table);
        put(bytes, 100, crc.into(), 4);
    }
    let crc = crc32fast::hash(&bytes[..124]);
    put(bytes, 124, crc.into(), 4);
}

/// Returns the offsets of the section table's entries.
fn entries(bytes: &[u8]) -> impl Iterator<Item = usize> + use<> {
    let end = bytes.len();
    (0..number(bytes, 96, 4) as usize).map(|i| HEADER + ENTRY * i).take_while(move |at| at + ENTRY <= end)
}

/// Returns the offset of the table's entry of a kind.
fn entry(bytes: &[u8], kind: u64) -> usize {
    entries(bytes).find(|&at| number(bytes, at, 4) == kind).expect("a section of this kind")
}

/// Returns the offset of the record of an object.
fn record(bytes: &[u8], object: u64) -> usize {
    offset(bytes, OBJECTS) + HEADER * object as usize
}

/// Returns the numbers of the objects that are channels.
fn channels(bytes: &[u8]) -> impl Iterator<Item = u64> {
    let known = number(bytes, 10, 2) >= 2;
    let objects = number(bytes, entry(bytes, OBJECTS) + COUNT, 8);
    (1..objects).filter(move |&object| known && number(bytes, record(bytes, object), 4) == CHANNEL)
}

/// True if a file has objects or sections that no reader of this version understands.
#[allow(dead_code)]
pub fn has_unknown_parts(bytes: &[u8]) -> bool {
    let objects = number(bytes, entry(bytes, OBJECTS) + COUNT, 8);
    let of_solid = OBJECTS..=SEGMENTS;
    let unknown = |at: usize| {
        let (kind, owner) = (number(bytes, at + KIND, 4), number(bytes, at + OWNER, 4));
        let of_channel =
            (METADATA..=SEGMENTS).contains(&kind) || [VALUES, VALUE_REL, VALUE_BASE].contains(&kind);
        let of_cuts = cut_vectors::is_of_cuts(kind) && number(bytes, 10, 2) >= 4;
        if owner == 0 { !of_solid.contains(&kind) && !of_cuts } else { !of_channel }
    };
    channels(bytes).count() as u64 + 1 != objects || entries(bytes).any(unknown)
}

/// Returns the offset of an object's section of a kind.
fn offset_of(bytes: &[u8], owner: u64, kind: u64) -> usize {
    let is_it = |&at: &usize| (number(bytes, at + OWNER, 4), number(bytes, at, 4)) == (owner, kind);
    number(bytes, entries(bytes).find(is_it).expect("a section of this kind") + OFFSET, 8) as usize
}

/// Returns the offset of the section of a kind.
fn offset(bytes: &[u8], kind: u64) -> usize {
    number(bytes, entry(bytes, kind) + OFFSET, 8) as usize
}

/// A file in pieces.
struct Parts {
    head: Vec<u8>,
    sections: Vec<Section>,
}

#[derive(Clone)]
struct Section {
    kind: u64,
    owner: u64,
    /// Type and components of an element.
    element: (u64, u64),
    encoding: u64,
    reserved: u64,
    flags: u64,
    /// Number of elements, if it is not the number that fits into the bytes.
    count: Option<u64>,
    bytes: Vec<u8>,
    /// Owner and kind of another section with the same bytes in the file.
    same: Option<(u64, u64)>,
    /// Zero bytes before the section, in addition to those of the alignment.
    gap: usize,
}

impl Section {
    /// A section of the solid. It is required if all readers know its kind, unless it is metadata.
    fn new(kind: u64, element: (u64, u64), bytes: Vec<u8>) -> Section {
        let of_dexels = (32..48).contains(&kind);
        let known = kind <= SEGMENTS || [VALUES, VALUE_REL, VALUE_BASE].contains(&kind) || of_dexels;
        let flags = (known && kind != METADATA) as u64;
        Section {
            kind,
            owner: 0,
            element,
            encoding: 0,
            reserved: 0,
            flags,
            count: None,
            bytes,
            same: None,
            gap: 0,
        }
    }

    /// Returns the section with another owner.
    fn of(self, owner: u64) -> Section {
        Section { owner, ..self }
    }

    fn flagged(self, flags: u64) -> Section {
        Section { flags, ..self }
    }

    /// Returns the bytes of an element.
    fn size(&self) -> usize {
        let (kind, components) = self.element;
        [8, 1, 2, 4, 8, 4, 8].get(kind as usize).map_or(1, |size| size * components as usize)
    }
}

impl Parts {
    fn of(model: &Model) -> Parts {
        let bytes = file::to_bytes(&model.octree()).expect("a file");
        let section = |at: usize| {
            let field = |offset, length| number(&bytes, at + offset, length);
            let (start, length) = (field(OFFSET, 8) as usize, field(LENGTH, 8) as usize);
            let element = (field(TYPE, 1), field(COMPONENTS, 1));
            let section = Section::new(field(KIND, 4), element, bytes[start..start + length].to_vec());
            assert_eq!(section.flags, field(FLAGS, 4));
            section.of(field(OWNER, 4))
        };
        let mut parts =
            Parts { head: bytes[..HEADER].to_vec(), sections: entries(&bytes).map(section).collect() };
        if let Some(cuts) = &model.cuts {
            parts.add_cuts(model, cuts);
        }
        parts
    }

    /// Returns the solid's section of a kind.
    fn section(&mut self, kind: u64) -> &mut Section {
        let of_solid = |section: &&mut Section| section.kind == kind && section.owner == 0;
        self.sections.iter_mut().find(of_solid).expect("a section of this kind")
    }

    fn take(&mut self, kind: u64) -> Section {
        self.take_of(0, kind)
    }

    /// Returns an object's section of a kind.
    fn own(&mut self, owner: u64, kind: u64) -> &mut Section {
        let is_it = |section: &&mut Section| (section.owner, section.kind) == (owner, kind);
        self.sections.iter_mut().find(is_it).expect("a section of this kind")
    }

    fn take_of(&mut self, owner: u64, kind: u64) -> Section {
        let at = self.sections.iter().position(|section| (section.owner, section.kind) == (owner, kind));
        self.sections.remove(at.expect("a section of this kind"))
    }

    /// Returns the record of an object.
    fn record(&mut self, object: u64) -> &mut [u8] {
        &mut self.section(OBJECTS).bytes[HEADER * object as usize..][..HEADER]
    }

    /// Returns a section of `kind` for `owner` that shares the bytes of the solid's section `of`.
    fn shared(&mut self, of: u64, owner: u64, kind: u64) -> Section {
        Section { kind, owner, same: Some((0, of)), ..self.section(of).clone() }
    }

    /// Adds the record of an object with only these fields. Returns the rest of the record, to be filled.
    fn object(&mut self, kind: u64, parent: u64, flags: u64) -> &mut [u8] {
        let records = &mut self.section(OBJECTS).bytes;
        let at = records.len();
        records.resize(at + HEADER, 0);
        for (field, value) in [(0, kind), (4, parent), (8, flags)] {
            put(records, at + field, value, 4);
        }
        &mut records[at + 12..]
    }

    /// Sorts sections into the order that the table requires.
    fn sort(&mut self) {
        self.sections.sort_by_key(|section| (section.owner, section.kind));
    }

    /// Returns the file, with right offsets and checksums.
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.head.clone();
        bytes.resize(HEADER + ENTRY * self.sections.len(), 0);
        for (i, section) in self.sections.iter().enumerate() {
            let of = section.same.and_then(|of| self.sections.iter().position(|s| (s.owner, s.kind) == of));
            let start = match of {
                Some(of) => number(&bytes, HEADER + ENTRY * of + OFFSET, 8) as usize,
                None => {
                    let start = bytes.len().next_multiple_of(64) + section.gap;
                    bytes.resize(start, 0);
                    bytes.extend_from_slice(&section.bytes);
                    start
                }
            };
            let length = section.bytes.len();
            let fields = [
                (KIND, section.kind, 4),
                (OWNER, section.owner, 4),
                (TYPE, section.element.0, 1),
                (COMPONENTS, section.element.1, 1),
                (ENCODING, section.encoding, 1),
                (RESERVED, section.reserved, 1),
                (FLAGS, section.flags, 4),
                (OFFSET, start as u64, 8),
                (LENGTH, length as u64, 8),
                (COUNT, section.count.unwrap_or((length / section.size()) as u64), 8),
                (SAME, of.map_or(0, |of| of as u64 + 1), 4),
            ];
            for (at, value, size) in fields {
                put(&mut bytes, HEADER + ENTRY * i + at, value, size);
            }
        }
        let length = bytes.len() as u64;
        put(&mut bytes, 24, length, 8);
        put(&mut bytes, 96, self.sections.len() as u64, 4);
        mirror(&mut bytes);
        seal(&mut bytes);
        bytes
    }

    /// Returns the file with raw bricks.
    fn decoded(mut self) -> Parts {
        let (indices, entries) = (self.take(INDICES), self.take(ENTRIES));
        self.take(SEGMENTS);
        let entry = |index: &[u8]| {
            let at = number(index, 0, 2) as usize * entries.size();
            entries.bytes[at..at + entries.size()].to_vec()
        };
        let bricks = indices.bytes.chunks(2).flat_map(entry).collect();
        self.sections.push(Section::new(BRICKS, entries.element, bricks));
        self.sort();
        self.head[68..70].fill(0);
        put(&mut self.head, 88, 0, 8);
        self
    }

    /// Returns the file with bricks of one plane through a dictionary, with segments of 2^16 bricks.
    fn in_small_segments(mut self) -> Parts {
        let (shift, entries, starts) = (self.head[69], self.take(ENTRIES).bytes, self.take(SEGMENTS).bytes);
        let indices = self.take(INDICES).bytes;
        let brick = |b: usize| {
            let start = number(&starts, 8 * (b >> shift), 8);
            number(&entries, 8 * (start + number(&indices, 2 * b, 2)) as usize, 8)
        };
        let bricks: Vec<u64> = (0..indices.len() / 2).map(brick).collect();
        let (mut indices, mut entries, mut starts) = (vec![], vec![], vec![]);
        for segment in bricks.chunks(1 << 16) {
            let mut uses = BTreeMap::new();
            segment.iter().for_each(|brick| *uses.entry(brick).or_insert(0) += 1);
            let mut order: Vec<_> = uses.into_iter().map(|(brick, uses)| (Reverse(uses), *brick)).collect();
            order.sort();
            let place: BTreeMap<_, _> = order.iter().zip(0u16..).map(|((_, brick), i)| (*brick, i)).collect();
            starts.extend((entries.len() as u64 / 8).to_le_bytes());
            entries.extend(order.iter().flat_map(|(_, brick)| brick.to_le_bytes()));
            indices.extend(segment.iter().flat_map(|brick| place[brick].to_le_bytes()));
        }
        self.head[69] = 16;
        put(&mut self.head, 88, entries.len() as u64 / 8, 8);
        let sections = [(INDICES, U16, indices), (ENTRIES, U64, entries), (SEGMENTS, U64, starts)];
        self.sections.extend(sections.map(|(kind, element, bytes)| Section::new(kind, (element, 1), bytes)));
        self.sort();
        self
    }

    /// Returns the file with all bricks through a dictionary of one segment. All bricks are different.
    fn encoded(mut self) -> Parts {
        let raw = self.take(BRICKS);
        let size = raw.size();
        let mut bricks: Vec<_> = raw.bytes.chunks(size).collect();
        let value = |brick: &&[u8]| (number(brick, 0, 8), number(brick, brick.len() - 8, 8));
        bricks.sort_by_key(value);
        bricks.dedup();
        let place = |brick: &[u8]| bricks.iter().position(|&entry| entry == brick).expect("an entry") as u16;
        let indices = raw.bytes.chunks(size).flat_map(|brick| place(brick).to_le_bytes()).collect();
        assert_eq!(bricks.len() * size, raw.bytes.len(), "each entry is used once");
        self.head[68..70].copy_from_slice(&[1, 63]);
        put(&mut self.head, 88, bricks.len() as u64, 8);
        let entries = Section::new(ENTRIES, raw.element, bricks.concat());
        let segments = Section::new(SEGMENTS, (U64, 1), vec![0; 8]);
        self.sections.extend([Section::new(INDICES, (U16, 1), indices), entries, segments]);
        self.sort();
        self
    }
}

// ---- invalid vectors ------------------------------------------------------------------------------------

/// The weakest way in that refuses a file. All stronger ways refuse it as well, and all weaker ones accept
/// it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Header and section table.
    Probing,
    /// Checks that keep arrays within bounds.
    Plain,
    /// The same, and the metadata.
    Metadata,
    /// Complete verification.
    Verification,
}

impl Way {
    /// Returns the way's name in the texts.
    pub fn name(self) -> &'static str {
        match self {
            Way::Probing => "probing",
            Way::Plain => "plain",
            Way::Metadata => "metadata",
            Way::Verification => "verification",
        }
    }
}

/// A file that readers must refuse.
pub struct Invalid {
    /// Name of the file without its ending: the rule, and the case of the rule.
    pub name: String,
    /// Name of the rule in the specification.
    pub rule: &'static str,
    /// Description of the error in the file.
    pub about: &'static str,
    /// The weakest way in that must refuse the file.
    pub way: Way,
    /// The library's error, as its `Debug` text.
    pub error: String,
    /// The error of readers that know the number of the file's bytes, if this number makes them refuse the
    /// file earlier.
    pub error_of_length: Option<String>,
    /// The file.
    pub bytes: Vec<u8>,
}

impl Invalid {
    /// Returns the expected behaviour of a reader, as the lines of a text; `README.md` explains them.
    pub fn facts(&self) -> String {
        let mut text = format!("about: {}\nrule: {}\n", self.about, self.rule);
        text += &format!("refused-by: {}\nerror: {}\n", self.way.name(), self.error);
        if let Some(error) = &self.error_of_length {
            text += &format!("error-of-length: {error}\n");
        }
        text
    }
}

/// All invalid vectors.
pub fn invalid() -> Vec<Invalid> {
    let mut list = List { way: Way::Probing, vectors: vec![] };
    header(&mut list);
    table(&mut list);
    list.way = Way::Plain;
    objects(&mut list);
    before_use(&mut list);
    verification(&mut list);
    channel_records(&mut list);
    channel_contents(&mut list);
    cut_vectors::invalid(&mut list);
    list.vectors
}

struct List {
    way: Way,
    vectors: Vec<Invalid>,
}

impl List {
    /// Adds a vector of `rule`. The case `of` becomes part of the file's name.
    fn add(
        &mut self,
        rule: &'static str,
        of: &str,
        about: &'static str,
        error: impl Into<String>,
        bytes: Vec<u8>,
    ) {
        let name = if of.is_empty() { rule.to_owned() } else { format!("{rule}-{of}") };
        let error = error.into();
        self.vectors.push(Invalid { name, rule, about, way: self.way, error, error_of_length: None, bytes });
    }

    /// Notes that the last vector is shorter than its header says.
    fn but_length(&mut self, expected: usize) {
        let last = self.vectors.last_mut().expect("a vector");
        last.error_of_length = Some(length(expected, last.bytes.len()));
    }
}

fn field(name: &str, value: u64) -> String {
    format!("Format(Field {{ name: {name:?}, value: {value} }})")
}

fn length(expected: usize, found: usize) -> String {
    format!("Format(Length {{ expected: {expected}, found: {found} }})")
}

fn section(name: &str) -> String {
    format!("Format(Section {{ name: {name:?} }})")
}

fn checksum(name: &str) -> String {
    format!("Format(Checksum {{ name: {name:?} }})")
}

fn required(name: &str, value: u64) -> String {
    format!("Format(Required {{ name: {name:?}, value: {value} }})")
}

fn link(element: u64) -> String {
    format!("Damaged(Link {{ element: {element} }})")
}

fn levels(level: u64) -> String {
    format!("Damaged(LevelTable {{ level: {level} }})")
}

fn entry_order(entry: u64) -> String {
    format!("Damaged(DictionaryOrder {{ entry: {entry} }})")
}

fn good(model: &Model) -> Vec<u8> {
    file::to_bytes(&model.octree()).expect("a file")
}

/// Returns `bytes` with one number changed, the header repeated in the solid's record, and right checksums.
fn with(bytes: &[u8], at: usize, value: u64, length: usize) -> Vec<u8> {
    changed(bytes, |bytes| put(bytes, at, value, length))
}

fn changed(bytes: &[u8], change: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    change(&mut bytes);
    mirror(&mut bytes);
    seal(&mut bytes);
    bytes
}

/// Names of the known sections, by kind.
const KINDS: [(u64, &str); 10] = [
    (OBJECTS, "objects"),
    (METADATA, "metadata"),
    (LEVELS, "level table"),
    (PLANES, "planes"),
    (REL, "rel"),
    (BASE, "base"),
    (BRICKS, "bricks"),
    (INDICES, "brick indices"),
    (ENTRIES, "dictionary entries"),
    (SEGMENTS, "dictionary segments"),
];

/// Vectors for §10.1, the header.
fn header(list: &mut List) {
    let (raw, coded) = (good(&example()), good(&coded()));
    let uniform = good(&Model::plain(4, |_| Tag::Full));
    let flat = good(&Model::plain(2, noise(2, 3, BINARY)));
    let all = raw.len();
    let table_end = HEADER + ENTRY * number(&raw, 96, 4) as usize;

    let transfer = |from: &str, to: &str| {
        let mut out = vec![];
        let mut rest = &raw[..];
        while let Some(at) = rest.windows(from.len()).position(|window| window == from.as_bytes()) {
            out.extend_from_slice(&rest[..at]);
            out.extend_from_slice(to.as_bytes());
            rest = &rest[at + from.len()..];
        }
        out.extend_from_slice(rest);
        out
    };
    let text = "Format(TextMode)";
    list.add("header-text-mode", "dos-to-unix", "CR LF became LF", text, transfer("\r\n", "\n"));
    list.add("header-text-mode", "unix-to-dos", "LF became CR LF", text, transfer("\n", "\r\n"));
    list.add("header-text-mode", "unix-to-mac", "LF became CR", text, transfer("\n", "\r"));
    let magic = "Format(Magic)";
    list.add("header-magic", "", "the first byte lost its highest bit", magic, with(&raw, 0, 0x09, 1));
    list.add("header-magic", "last", "the last byte of the magic is another", magic, with(&raw, 7, 0x0B, 1));
    list.add(
        "header-magic",
        "short",
        "three bytes that are not the magic's",
        magic,
        b"\x89LF".map(|b| b ^ 1).to_vec(),
    );
    list.add("header-short", "empty", "no byte at all", length(128, 0), vec![]);
    list.add("header-short", "magic", "a part of the magic", length(128, 5), raw[..5].to_vec());
    list.add("header-short", "", "one byte less than a header", length(128, 127), raw[..127].to_vec());
    let version = |major, minor| format!("Format(Version {{ major: {major}, minor: {minor} }})");
    list.add("header-major", "", "major version 1", version(1, 1), with(&raw, 8, 1, 2));
    let about = "version 0.0, which had another section table";
    list.add("header-major", "oldest", about, version(0, 0), with(&raw, 10, 0, 2));
    let mut other = with(&raw, 8, 0xFFFF, 2);
    put(&mut other, 10, 3, 2);
    list.add(
        "header-major",
        "crc",
        "another major version, whose checksum is somewhere else",
        version(65535, 3),
        other,
    );
    let mut wrong = raw.clone();
    wrong[124] ^= 1;
    list.add("header-crc", "", "a bit of the checksum is flipped", checksum("the header"), wrong);
    let mut wrong = raw.clone();
    wrong[40] ^= 1;
    list.add("header-crc", "field", "a bit of the origin is flipped", checksum("the header"), wrong);

    let mut one = |rule, of: &str, about, name: &str, at, value: u64, length| {
        list.add(rule, of, about, field(name, value), with(&raw, at, value, length));
    };
    one("header-length", "", "a longer header", "header length", 12, 136, 4);
    one("header-optional-flags", "", "an unknown flag of version 0.1", "optional flags", 20, 1, 4);
    one("header-reserved", "", "the reserved byte by itself", "reserved field", 71, 1, 1);
    one("header-reserved", "first", "the first of the reserved bytes", "reserved field", 112, 1, 1);
    one("header-reserved", "last", "the last of the reserved bytes", "reserved field", 123, 0x80, 1);
    let beyond = f64::from_bits((1023 + 256) << 52).next_up().to_bits();
    let below = f64::from_bits((1023 - 256) << 52).next_down().to_bits();
    one("header-origin", "nan", "x is not a number", "origin", 32, f64::NAN.to_bits(), 8);
    one("header-origin", "infinite", "z is infinite", "origin", 48, f64::INFINITY.to_bits(), 8);
    one("header-origin", "negative-zero", "y is -0", "origin", 40, (-0f64).to_bits(), 8);
    one("header-origin", "large", "y is more than 2^256", "origin", 40, beyond, 8);
    one("header-origin", "small", "z is less than 2^-256, and not 0", "origin", 48, below, 8);
    one("header-edge", "zero", "0", "edge", 56, 0, 8);
    one("header-edge", "negative", "-4", "edge", 56, (-4f64).to_bits(), 8);
    one("header-edge", "nan", "not a number", "edge", 56, f64::NAN.to_bits(), 8);
    one("header-edge", "large", "more than 2^256", "edge", 56, beyond, 8);
    one("header-edge", "small", "less than 2^-256", "edge", 56, below, 8);
    one("header-depth", "zero", "no level", "depth", 64, 0, 1);
    one("header-depth", "large", "21 levels", "depth", 64, 21, 1);
    one("header-root", "", "a tag of three bits", "root tag", 65, 4, 1);
    one("header-exterior", "branch", "BRANCH", "exterior", 66, 1, 1);
    one("header-exterior", "large", "a tag of three bits", "exterior", 66, 4, 1);
    one("header-proof", "", "a third bit", "proof", 70, 4, 1);
    one("header-proof", "large", "all bits", "proof", 70, 255, 1);
    let mut moved = |of: &str, about, value: f64| {
        one("header-displacement", of, about, "displacement", 104, value.to_bits(), 8);
    };
    moved("nan", "not a number", f64::NAN);
    moved("infinite", "infinite", f64::INFINITY);
    moved("negative", "-1", -1.0);
    moved("negative-zero", "-0", -0.0);
    one("header-brick-planes", "zero", "no plane", "planes of a brick", 67, 0, 1);
    one("header-brick-planes", "large", "three planes", "planes of a brick", 67, 3, 1);
    one("header-encoding", "", "an unknown encoding", "brick encoding", 68, 2, 1);
    one("header-raw-shift", "", "a segment shift of raw bricks", "segment shift", 69, 63, 1);
    one("header-raw-entries", "", "a dictionary entry of raw bricks", "dictionary entries", 88, 1, 8);
    one("header-section-count", "zero", "no section", "section count", 96, 0, 4);
    one("header-section-count", "large", "4097 sections", "section count", 96, 4097, 4);
    one("header-file-length", "", "the file ends with the table", "file length", 24, table_end as u64, 8);
    let flags = required("flags", 4);
    list.add("header-required-flags", "", "a required flag", flags, with(&raw, 16, 4, 4));
    let newer = changed(&raw, |bytes| {
        put(bytes, 10, NEWER, 2);
        put(bytes, 16, 1 << 31, 4);
    });
    let flags = required("flags", 1 << 31);
    list.add("header-required-flags", "newer", "a required flag of a newer minor version", flags, newer);

    let mut one = |rule, of: &str, about, name: &str, at, value: u64, length| {
        list.add(rule, of, about, field(name, value), with(&coded, at, value, length));
    };
    let bricks = number(&coded, 80, 8);
    one("header-shift", "small", "segments of 2^15 bricks", "segment shift", 69, 15, 1);
    one("header-shift", "single", "one segment, and the shift is 16", "segment shift", 69, 16, 1);
    one("header-shift", "large", "a shift of 64", "segment shift", 69, 64, 1);
    one("header-entries", "zero", "no entry", "dictionary entries", 88, 0, 8);
    one("header-entries", "large", "more entries than bricks", "dictionary entries", 88, bricks + 1, 8);
    let none = changed(&coded, |bytes| put(bytes, 80, 0, 8));
    list.add("header-shift", "none", "one segment of no bricks", field("segment shift", 63), none);
    let bytes = with(&flat, 72, 1, 8);
    list.add("header-elements", "flat", "an element at depth 2", field("elements", 1), bytes);
    let bytes = with(&uniform, 72, 3, 8);
    list.add(
        "header-elements",
        "uniform",
        "elements of a universe that is FULL",
        field("elements", 3),
        bytes,
    );
    let bytes = with(&uniform, 80, 2, 8);
    list.add("header-bricks", "", "bricks of a universe that is FULL", field("bricks", 2), bytes);

    let about = "nothing behind the header";
    list.add("table-short", "none", about, length(table_end, HEADER), raw[..HEADER].to_vec());
    list.but_length(all);
    let about = "one byte less than the table";
    list.add("table-short", "", about, length(table_end, table_end - 1), raw[..table_end - 1].to_vec());
    list.but_length(all);
    let mut wrong = raw.clone();
    wrong[100] ^= 1;
    seal_header(&mut wrong);
    list.add("table-crc", "", "a bit of the checksum is flipped", checksum("the section table"), wrong);
    let mut wrong = raw;
    wrong[HEADER + FLAGS] ^= 2;
    list.add("table-crc", "entry", "a bit of an entry is flipped", checksum("the section table"), wrong);
}

/// Sets the header's checksum only.
fn seal_header(bytes: &mut [u8]) {
    let crc = crc32fast::hash(&bytes[..124]);
    put(bytes, 124, crc.into(), 4);
}

/// Vectors for §10.1, the section table.
fn table(list: &mut List) {
    let (raw, coded) = (good(&example()), good(&coded()));
    let end = raw.len() as u64;
    let at = |kind| entry(&raw, kind);
    let mut one = |rule, of: &str, about, name: &str, at, value: u64, length| {
        list.add(rule, of, about, field(name, value), with(&raw, at, value, length));
    };
    one("section-kind", "", "kind 0", "section kind", at(METADATA), 0, 4);
    one("section-flags", "", "an unknown flag of version 0.1", "section flags", at(PLANES) + FLAGS, 3, 4);
    one("table-reserved", "", "the reserved byte", "reserved field", at(PLANES) + RESERVED, 1, 1);
    let about = "an encoding that version 0.1 does not know";
    one("table-encoding", "", about, "section encoding", at(PLANES) + ENCODING, 1, 1);
    one("section-length", "product", "not count times size", "section length", at(PLANES) + LENGTH, 17, 8);
    let about = "on a multiple of 32";
    one("section-alignment", "", about, "section offset", at(METADATA) + OFFSET, 0x2A0, 8);
    one(
        "section-overlap",
        "table",
        "a section in the table",
        "section offset",
        at(OBJECTS) + OFFSET,
        0x140,
        8,
    );
    let about = "a section at the beginning of the file";
    one("section-overlap", "header", about, "section offset", at(OBJECTS) + OFFSET, 0, 8);
    let about = "two sections in one place, and neither says so";
    one("section-overlap", "same", about, "section offset", at(METADATA) + OFFSET, 0x200, 8);
    one("section-required", "", "planes that are not required", "section flags", at(PLANES) + FLAGS, 0, 4);
    one("section-required", "objects", "objects that are not", "section flags", at(OBJECTS) + FLAGS, 0, 4);
    one("section-required", "metadata", "metadata that are", "section flags", at(METADATA) + FLAGS, 1, 4);

    // Element types and components.
    let mut strange = |of: &str, about, kind: u64, components: u64| {
        let bytes = changed(&raw, |bytes| {
            put(bytes, at(PLANES) + TYPE, kind, 1);
            put(bytes, at(PLANES) + COMPONENTS, components, 1);
        });
        list.add("table-element", of, about, field("element type", kind | components << 8), bytes);
    };
    strange("", "an element type that version 0.1 does not know", 7, 2);
    strange("large", "the largest number of a type", 255, 2);
    strange("components", "elements of no component", U64, 0);
    let newer = changed(&raw, |bytes| {
        put(bytes, 10, NEWER, 2);
        put(bytes, at(PLANES) + TYPE, 7, 2);
    });
    let about = "no component, of an unknown type in a newer minor version";
    list.add("table-element", "newer", about, field("element type", 7), newer);
    let newer = changed(&raw, |bytes| {
        put(bytes, 10, NEWER, 2);
        put(bytes, at(PLANES) + ENCODING, 1, 1);
    });
    let about = "planes in an unknown encoding of a newer minor version";
    list.add("table-encoding", "newer", about, required("section encoding", 1), newer);

    // Offsets, lengths and counts.
    let extent = |kind: u64, length: u64, count: u64| {
        changed(&raw, |bytes| {
            put(bytes, at(kind) + LENGTH, length, 8);
            put(bytes, at(kind) + COUNT, count, 8);
        })
    };
    let error = field("section length", 0);
    list.add("section-length", "zero", "an empty section", error.clone(), extent(METADATA, 0, 0));
    list.add("section-length", "overflow", "count times size is 2^64", error, extent(PLANES, 0, 1 << 60));
    let newer = changed(&raw, |bytes| {
        put(bytes, 10, NEWER, 2);
        put(bytes, at(BRICKS) + KIND, 99, 4);
        put(bytes, at(BRICKS) + ENCODING, 1, 1);
        put(bytes, at(BRICKS) + COUNT, 0, 8);
    });
    let about = "no element, in an unknown encoding of a newer minor version";
    list.add("section-length", "newer", about, field("section length", 32), newer);
    let about = "one brick more than the file has";
    list.add("section-beyond", "", about, field("section length", 48), extent(BRICKS, 48, 3));
    let far = changed(&extent(BRICKS, 64, 4), |bytes| put(bytes, at(BRICKS) + OFFSET, u64::MAX - 63, 8));
    list.add("section-beyond", "overflow", "its end is 2^64", field("section length", 64), far);

    // Kinds that readers must understand.
    let unknown = |kind: u64| with(&raw, at(BRICKS), kind, 4);
    let about = "a required section of kind 20";
    list.add("section-unknown", "", about, required("section", 20), unknown(20));
    let about = "a required section of an application's kind";
    list.add("section-unknown", "application", about, required("section", APPLICATION), unknown(APPLICATION));
    let newer = changed(&unknown(u32::MAX.into()), |bytes| put(bytes, 10, NEWER, 2));
    let about = "a required section of a newer minor version";
    list.add("section-unknown", "newer", about, required("section", u32::MAX.into()), newer);

    // Owners and order.
    let mut parts = |rule, of: &str, about, error: String, change: &dyn Fn(&mut Parts)| {
        let mut parts = Parts::of(&example());
        change(&mut parts);
        list.add(rule, of, about, error, parts.bytes());
    };
    let owner = |owner| field("section owner", owner);
    parts("table-owner", "", "the second of one object", owner(1), &|parts| {
        parts.sections.push(Section::new(20, (U8, 1), vec![1; 8]).of(1));
    });
    parts("table-owner", "far", "the last owner that a number can say", owner(u32::MAX.into()), &|parts| {
        parts.object(2, 0, 0);
        parts.sections.push(Section::new(20, (U8, 1), vec![1; 8]).of(u32::MAX.into()));
    });
    parts("table-order", "kind", "the level table after the planes", owner(0), &|parts| {
        parts.sections.swap(2, 3)
    });
    parts("table-order", "unknown", "an unknown kind among lower ones", owner(0), &|parts| {
        parts.sections.insert(2, Section::new(20, (U8, 1), vec![1; 8]));
    });
    parts("table-order", "owner", "a section of the solid after one of another object", owner(0), &|parts| {
        parts.object(2, 0, 0);
        let bricks = parts.sections.len() - 1;
        parts.sections.insert(bricks, Section::new(1, (U8, 1), vec![1; 8]).of(1));
    });
    parts("table-order", "twice", "planes stand twice", owner(0), &|parts| {
        let again = parts.section(PLANES).clone();
        parts.sections.insert(4, again);
    });
    parts("table-order", "metadata", "metadata stand twice", owner(0), &|parts| {
        parts.sections.insert(2, Section::new(METADATA, (U8, 1), vec![0; 8]));
    });
    parts("table-order", "unknown-twice", "an unknown kind stands twice", owner(1), &|parts| {
        parts.object(2, 0, 0);
        let section = Section::new(20, (U8, 1), vec![1; 8]).of(1);
        parts.sections.extend([section.clone(), section]);
    });
    let objects = || section("objects");
    parts("object-count", "none", "there are no objects", objects(), &|parts| drop(parts.take(OBJECTS)));
    parts("object-count", "owner", "objects that belong to the second object", objects(), &|parts| {
        parts.object(2, 0, 0);
        parts.section(OBJECTS).owner = 1;
    });

    // Bytes shared by several sections.
    let two_owners = |change: &dyn Fn(&mut Parts)| {
        let mut parts = Parts::of(&example());
        parts.object(2, 0, 0);
        for kind in [20, 21] {
            let planes = parts.shared(PLANES, 1, kind);
            parts.sections.push(planes.flagged(0));
        }
        change(&mut parts);
        parts.bytes()
    };
    let shared = two_owners(&|_| {});
    let last = HEADER + ENTRY * (number(&shared, 96, 4) as usize - 1);
    assert_eq!((number(&shared, last, 4), number(&shared, last + SAME, 4)), (21, 4));
    let mut same = |of: &str, about, change: &dyn Fn(&mut Vec<u8>)| {
        let bytes = changed(&shared, change);
        let value = number(&bytes, last + SAME, 4);
        // Every change repairs the checksums.
        list.add("table-same", of, about, field("shared section", value), bytes);
    };
    same("itself", "a section that shares its own bytes", &|bytes| put(bytes, last + SAME, 9, 4));
    same("beyond", "one behind the last section", &|bytes| put(bytes, last + SAME, 10, 4));
    same("far", "the last section that a number can say", &|bytes| {
        put(bytes, last + SAME, u32::MAX.into(), 4)
    });
    same("chain", "a section that itself shares another's bytes", &|bytes| put(bytes, last + SAME, 8, 4));
    same("offset", "another place", &|bytes| put(bytes, last + OFFSET, 0x200, 8));
    same("length", "another length", &|bytes| {
        put(bytes, last + LENGTH, 32, 8);
        put(bytes, last + COUNT, 2, 8);
    });
    same("element", "elements of another type", &|bytes| put(bytes, last + TYPE, F64, 1));
    same("components", "elements of other components", &|bytes| {
        put(bytes, last + COMPONENTS, 1, 1);
        put(bytes, last + COUNT, 2, 8);
    });
    let later = changed(&shared, |bytes| {
        // The last section but one names the last, which has bytes of its own.
        put(bytes, last - ENTRY + SAME, 9, 4);
        put(bytes, last + SAME, 0, 4);
    });
    list.add("table-same", "later", "a section that comes later", field("shared section", 9), later);
    let mut crc = shared.clone();
    crc[last + CRC] ^= 1;
    seal_head(&mut crc);
    list.add("table-same", "crc", "another checksum", field("shared section", 4), crc);
    let newer = changed(&shared, |bytes| {
        put(bytes, 10, NEWER, 2);
        put(bytes, last + RESERVED, 1, 1);
    });
    let about = "another value of the reserved byte, which a newer minor version uses";
    list.add("table-same", "reserved", about, field("shared section", 4), newer);
    let newer = changed(&shared, |bytes| {
        put(bytes, 10, NEWER, 2);
        put(bytes, last + ENCODING, 1, 1);
    });
    let about = "another encoding, which is one of a newer minor version";
    list.add("table-same", "encoding", about, field("shared section", 4), newer);

    for (kind, name) in KINDS {
        let base = if (INDICES..=SEGMENTS).contains(&kind) { &coded } else { &raw };
        let at = entry(base, kind);
        let of = name.replace(' ', "-");
        let other = changed(base, |bytes| {
            // Elements of the same size with another type. No other type has the size of a byte.
            let (element, count) = (number(bytes, at + TYPE, 1), number(bytes, at + COUNT, 8));
            match element {
                RECORD => put(bytes, at + TYPE, U64, 1),
                U8 => {
                    put(bytes, at + COMPONENTS, count, 1);
                    put(bytes, at + COUNT, 1, 8);
                }
                U16 => {
                    put(bytes, at + TYPE, U8, 1);
                    put(bytes, at + COMPONENTS, 2, 1);
                }
                _ => put(bytes, at + TYPE, F64, 1),
            }
        });
        list.add("section-size", &of, "elements of another type", section(name), other);
        if kind == OBJECTS || kind == METADATA {
            continue;
        }
        let mut parts =
            Parts::of(&if (INDICES..=SEGMENTS).contains(&kind) { self::coded() } else { example() });
        let whole = parts.section(kind);
        whole.bytes.extend(vec![0; whole.size()]);
        list.add("section-count", &of, "one element too many", section(name), parts.bytes());
        parts.take(kind);
        list.add("section-missing", &of, "it is absent", section(name), parts.bytes());
    }
    let halves = changed(&raw, |bytes| {
        put(bytes, at(PLANES) + COMPONENTS, 1, 1);
        put(bytes, at(PLANES) + COUNT, 2, 8);
    });
    list.add("section-size", "components", "planes one by one", section("planes"), halves);
    let mut parts = Parts::of(&example());
    parts.sections.push(Section::new(INDICES, (U16, 1), vec![0, 0]));
    let about = "a section of dictionaries where bricks are raw";
    list.add("section-count", "zero", about, section("brick indices"), parts.bytes());
    let bytes = with(&raw, 72, 1 << 40, 8);
    list.add("section-count", "header", "2^40 elements in the header", section("planes"), bytes);
    let bytes = with(&raw, 67, 1, 1);
    let about = "one plane in the header, two in the section";
    list.add("section-size", "header", about, section("bricks"), bytes);

    // Only the beginning of a file that is too long.
    let mut begun = |rule, of: &str, about, error: String, kind, length: usize| {
        let mut parts = Parts::of(&example());
        parts.section(kind).bytes.resize(length, 0);
        let bytes = parts.bytes();
        list.add(rule, of, about, error, bytes[..1024].to_vec());
        list.but_length(bytes.len());
    };
    let about = "metadata of 2^20 + 1 bytes, which the file does not have";
    let length = (1 << 20) + 1;
    let error = field("section length", length as u64);
    begun("section-metadata-length", "", about, error, METADATA, length);
    let about = "4097 objects, which the file does not have";
    begun("object-count", "large", about, section("objects"), OBJECTS, 4097 * HEADER);

    let longer = changed(&raw, |bytes| {
        bytes.push(0);
        put(bytes, 24, end + 1, 8);
    });
    let error = self::length(end as usize, end as usize + 1);
    list.add("section-end", "", "a byte after the last section, which the header counts", error, longer);
}

/// Vectors for §10.2, the records of objects.
fn objects(list: &mut List) {
    let records = |change: &dyn Fn(&mut Parts)| {
        let mut parts = Parts::of(&example());
        change(&mut parts);
        parts.bytes()
    };
    let raw = records(&|_| {});
    let solid = offset(&raw, OBJECTS);
    // Only the record, without the repair.
    let mut other = |of: &str, about, at: usize, value: u64, length: usize| {
        let mut bytes = raw.clone();
        assert_ne!(number(&bytes, solid + at, length), value);
        put(&mut bytes, solid + at, value, length);
        seal(&mut bytes);
        list.add("object-mirror", of, about, "Format(Object)", bytes);
    };
    other("type", "the first object is no solid", 0, 2, 4);
    other("type-zero", "the first object is of type 0", 0, 0, 4);
    other("parent", "the solid is its own parent", 4, 0, 4);
    other("optional", "the solid is not required", 8, 0, 4);
    other("flags", "a flag of the solid that version 0.1 does not know", 8, 3, 4);
    other("depth", "another depth than the header's", 12, 4, 1);
    other("root", "another root tag", 13, 3, 1);
    other("exterior", "another exterior", 14, 3, 1);
    other("proof", "another proof", 15, 1, 1);
    other("planes", "other planes of a brick", 16, 1, 1);
    other("encoding", "another brick encoding", 17, 1, 1);
    other("shift", "another segment shift", 18, 63, 1);
    other("value-type", "the solid has values", 19, 1, 1);
    other("components", "values of a solid have components", 20, 1, 1);
    other("reserved", "the first of the reserved bytes", 21, 1, 1);
    other("displacement", "another displacement", 24, 1f64.to_bits(), 8);
    other("displacement-negative-zero", "-0 where the header says 0", 24, (-0f64).to_bits(), 8);
    other("origin", "another origin", 40, 1f64.to_bits(), 8);
    other("edge", "another edge", 56, 2f64.to_bits(), 8);
    other("extents", "extents of another lattice", 64, 8, 4);
    other("reserved-middle", "the reserved number", 76, 1, 4);
    other("elements", "another number of elements", 80, 2, 8);
    other("bricks", "another number of bricks", 88, 1, 8);
    other("entries", "another number of dictionary entries", 96, 1, 8);
    other("values", "a number of values", 104, 1, 8);
    other("reserved-last", "the last of the reserved bytes", 127, 0x80, 1);
    let newer = |at: usize, value: u64, length: usize| {
        let mut bytes = with(&raw, 10, NEWER, 2);
        put(&mut bytes, solid + at, value, length);
        seal(&mut bytes);
        bytes
    };
    let about = "extents of another lattice, in a newer minor version";
    list.add("object-mirror", "newer", about, "Format(Object)", newer(72, 8, 4));
    let about = "the solid is not required, but has a flag of a newer minor version";
    list.add("object-mirror", "newer-optional", about, "Format(Object)", newer(8, 2, 4));

    let mut second = |rule, of: &str, about, error, [kind, parent, flags]: [u64; 3], minor| {
        let bytes = records(&|parts| {
            put(&mut parts.head, 10, minor, 2);
            parts.object(kind, parent, flags);
        });
        list.add(rule, of, about, error, bytes);
    };
    second("object-type", "", "a second object of type 0", field("object type", 0), [0, 0, 0], 1);
    let error = field("object type", 0);
    second("object-type", "newer", "the same of a newer minor version", error, [0, 0, 2], NEWER);
    let about = "a flag that version 0.1 does not know";
    second("object-flags", "", about, field("object flags", 2), [2, 0, 2], 1);
    let about = "its own parent";
    second("object-parent", "", about, field("object parent", 1), [2, 1, 0], 1);
    let about = "a parent beyond the objects";
    second("object-parent", "beyond", about, field("object parent", NO_PARENT - 1), [2, NO_PARENT - 1, 0], 1);
    let about = "an object of unknown type that is required";
    second("object-required", "", about, required("object", 2), [2, 0, 1], 1);
    let about = "another solid that is required";
    second("object-required", "solid", about, required("object", 1), [1, NO_PARENT, 1], 1);
    let about = "an object of a newer minor version that is required";
    second("object-required", "newer", about, required("object", 77), [77, 0, 3], NEWER);
    let later = records(&|parts| {
        parts.object(2, 2, 0);
        parts.object(2, 0, 0);
    });
    let about = "a parent that comes later";
    list.add("object-parent", "later", about, field("object parent", 2), later);
}

/// Vectors for §10.2.
fn before_use(list: &mut List) {
    let (raw, coded) = (good(&example()), good(&coded()));
    let uniform = good(&Model::plain(4, |_| Tag::Full));
    let end = raw.len();
    list.way = Way::Plain;
    let short = raw[..end - 1].to_vec();
    list.add("file-length", "short", "the last byte is missing", length(end, end - 1), short);
    let about = "everything behind the table is missing";
    let table_end = HEADER + ENTRY * number(&raw, 96, 4) as usize;
    list.add("file-length", "table", about, length(end, table_end), raw[..table_end].to_vec());
    let long = [&raw[..], b"\0"].concat();
    list.add("file-length", "long", "a byte too many", length(end, end + 1), long);

    // Entry l of the level table.
    let nodes = |bytes: &[u8], level: usize| offset(bytes, LEVELS) + 24 * level;
    let level = |bytes: &[u8], level, value| with(bytes, nodes(bytes, level), value, 8);
    let about = "no node for the universe, which is BRANCH";
    list.add("level-table-root", "none", about, levels(0), level(&raw, 0, 0));
    list.add("level-table-root", "two", "two nodes for the universe", levels(0), level(&raw, 0, 2));
    let about = "a node for the universe, which is FULL";
    list.add("level-table-root", "uniform", about, levels(0), level(&uniform, 0, 1));
    let about = "one node more than there are elements and bricks";
    list.add("level-table-starts", "", about, levels(1), level(&raw, 1, 3));
    list.add("level-table-starts", "overflow", "2^64 - 1 nodes", levels(1), level(&raw, 1, u64::MAX));
    let about = "a node less than there are elements and bricks";
    list.add("level-table-sum", "", about, levels(3), level(&raw, 1, 1));
    let moved = changed(&coded, |bytes| {
        for (level, change) in [(1, -1), (3, 1)] {
            let at = nodes(bytes, level);
            let sum = number(bytes, at, 8).wrapping_add_signed(change);
            put(bytes, at, sum, 8);
        }
    });
    let about = "a node counted among the bricks' instead of the elements'";
    list.add("level-table-sum", "moved", about, levels(5), moved);
    let none = changed(&good(&Model::plain(2, noise(2, 3, BINARY))), |bytes| put(bytes, 65, 3, 1));
    // Its brick contradicts the root tag first.
    list.way = Way::Probing;
    list.add("header-bricks", "root", "a brick, and the universe is FULL", field("bricks", 1), none);

    list.way = Way::Metadata;
    let mut text = |of: &str, about, bytes: &[u8]| {
        let mut parts = Parts::of(&example());
        parts.section(METADATA).bytes = bytes.to_vec();
        list.add("metadata-text", of, about, "Format(Metadata)", parts.bytes());
    };
    text("key-length", "a key that is longer than the section", b"\x09\0\0\0\0\0\0\0unitsmm");
    text("value-length", "a value that is longer than the section", b"\x05\0\0\0\x03\0\0\0unitsmm");
    text("huge-length", "lengths whose sum is beyond 32 bits", b"\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFFunitsmm");
    text("rest", "seven bytes, too few for another two lengths", b"\x01\0\0\0\0\0\0\0k\0\0\0\0\0\0\0");
    text("key-utf-8", "a key that is no UTF-8", b"\x01\0\0\0\x01\0\0\0\xFFv");
    text("value-utf-8", "a value that is no UTF-8", b"\x01\0\0\0\x01\0\0\0k\xC3");
    text("overlong", "a slash in two bytes", b"\x01\0\0\0\x02\0\0\0k\xC0\xAF");
    text("surrogate", "half of a surrogate pair", b"\x01\0\0\0\x03\0\0\0k\xED\xA0\x80");
    text("descending", "keys that descend", b"\x01\0\0\0\0\0\0\0b\x01\0\0\0\0\0\0\0a");
    text("twice", "a key that stands twice", b"\x01\0\0\0\0\0\0\0a\x01\0\0\0\0\0\0\0a");
}

/// Vectors for §10.3.
fn verification(list: &mut List) {
    list.way = Way::Verification;
    let (raw, coded) = (good(&example()), good(&coded()));
    for (of, at) in [("table", 0x1D0), ("between", 0x28F), ("last", 0x3FF)] {
        let error = field("padding", 1);
        list.add("padding", of, "a byte between sections is not 0", error, with(&raw, at, 1, 1));
    }
    for (kind, name) in KINDS {
        let base = if (INDICES..=SEGMENTS).contains(&kind) { &coded } else { &raw };
        let mut wrong = base.clone();
        let at = entry(base, kind) + CRC;
        wrong[at] ^= 1;
        seal_head(&mut wrong);
        let of = name.replace(' ', "-");
        list.add("section-crc", &of, "a bit of the checksum is flipped", checksum(name), wrong);
    }
    let mut parts = Parts::of(&example());
    parts.object(2, 0, 0);
    for (of, about, name, owner) in [
        ("unknown", "a bit of an unknown section is flipped", "an unknown section", 0),
        ("object", "a bit of a section of an unknown object is flipped", "a section of another object", 1),
    ] {
        parts.sections.push(Section::new(1000, (U16, 1), b"colours!".to_vec()).of(owner));
        let mut wrong = parts.bytes();
        *wrong.last_mut().expect("a byte") ^= 1;
        list.add("section-crc", of, about, checksum(name), wrong);
    }

    links(list);
    elements(list);
    dictionaries(list);
    bricks(list);

    let one_plane = good(&without_bricks(BINARY));
    let partial = good(&Model::plain(4, |_| Tag::Partial));
    let planes = offset(&one_plane, PLANES);
    // The first FULL cell of the root element without children.
    let full = number(&one_plane, planes, 8) & number(&one_plane, planes + 8, 8);
    let cell = full & full.wrapping_neg();
    let lower = number(&one_plane, planes, 8) & !cell;
    let missing = with(&one_plane, planes, lower, 8);
    let about = "a PARTIAL cell, and bricks have one plane";
    list.add("planes-missing", "", about, "Damaged(MissingPlane)", missing);
    let about = "the universe is PARTIAL, and bricks have one plane";
    list.add("planes-missing", "root", about, "Damaged(MissingPlane)", with(&partial, 67, 1, 1));
    let about = "two planes, and there is no PARTIAL cell";
    list.add("planes-needless", "", about, "Damaged(NeedlessPlane)", with(&one_plane, 67, 2, 1));
    let mut parts = Parts::of(&Model::plain(2, noise(2, 3, BINARY)));
    parts.head[67] = 2;
    let two = parts.section(BRICKS);
    two.bytes = [&two.bytes[..], &two.bytes].concat();
    two.element = (U64, 2);
    let about = "bricks of two planes that are the same";
    list.add("planes-needless", "bricks", about, "Damaged(NeedlessPlane)", parts.bytes());

    let table = offset(&raw, LEVELS);
    for (of, about, at, level) in [
        ("nodes", "internal nodes of a level that no start depends on", 48, 2),
        ("full", "FULL cells", 24 + 8, 1),
        ("partial", "PARTIAL cells", 72 + 16, 3),
        ("finest-nodes", "nodes on the finest level", 72, 3),
        ("root", "a universe that is cut and FULL", 8, 0),
    ] {
        let wrong = with(&raw, table + at, number(&raw, table + at, 8) + 1, 8);
        list.add("level-table-counts", of, about, levels(level), wrong);
    }
}

fn links(list: &mut List) {
    let (raw, coded) = (good(&example()), good(&coded()));
    let count = |level, expected, found| {
        format!("Damaged(Count {{ level: {level}, expected: {expected}, found: {found} }})")
    };
    // The BRANCH cell 7 of the root becomes EMPTY.
    let fewer = with(&raw, offset(&raw, PLANES), 0x03, 8);
    list.add("element-count", "bricks", "two bricks for one BRANCH cell", count(1, 1, 2), fewer);
    let planes = offset(&coded, PLANES);
    let fewer = with(&coded, planes, number(&coded, planes, 8) & !0x80, 8);
    list.add("element-count", "", "eight elements for seven BRANCH cells", count(1, 7, 8), fewer);
    let more = with(&raw, offset(&raw, PLANES), 0x93, 8);
    list.add("element-count", "few", "two bricks for three BRANCH cells", count(1, 3, 2), more);

    let (rel, base) = (offset(&coded, REL), offset(&coded, BASE));
    let near = with(&coded, rel + 2, number(&coded, rel + 2, 2) + 1, 2);
    list.add("element-link", "rel", "the children of element 1 are one further", link(1), near);
    let both = changed(&coded, |bytes| {
        let sum = number(bytes, rel + 2, 2) + 1;
        put(bytes, rel + 2, sum, 2);
        // The last BRANCH cell of the last element becomes EMPTY.
        let (lower, upper) = (number(bytes, planes + 128, 8), number(bytes, planes + 136, 8));
        let last = 1 << (lower & !upper).ilog2();
        put(bytes, planes + 128, lower & !last, 8);
    });
    let about = "the children of element 1 are one further, and there is a brick too many, which comes later";
    list.add("element-link", "first", about, link(1), both);
    let back = with(&coded, base, 0, 8);
    list.add("element-link", "base", "the children of element 0 begin with itself", link(0), back);
    let split = changed(&coded, |bytes| {
        put(bytes, base, 0, 8);
        for n in 0..9 {
            let sum = number(bytes, rel + 2 * n, 2) + 1;
            put(bytes, rel + 2 * n, sum, 2);
        }
    });
    let about = "the sums are right, but rel[0] is not 0";
    list.add("element-link", "first-rel", about, link(0), split);
    let far = with(&coded, base, u64::MAX, 8);
    list.add("element-link", "overflow", "the children of element 0 begin at 2^64 - 1", link(0), far);
}

fn elements(list: &mut List) {
    let raw = good(&example());
    let planes = offset(&raw, PLANES);
    let padding = "Damaged(Padding)";
    let outside = changed(&raw, |bytes| {
        bytes[planes + 1] = 1;
        bytes[planes + 9] = 1;
    });
    list.add("element-padding", "", "cell 8 of the root is FULL at depth 3", padding, outside);
    let outside = with(&raw, planes + 15, 0x80, 1);
    list.add("element-padding", "partial", "cell 63 of the root is PARTIAL at depth 3", padding, outside);

    let uniform = |index| format!("Damaged(Uniform {{ index: {index} }})");
    let flat = good(&Model::plain(4, cells(4, |at| solid(at[0] > 3))));
    assert_eq!((number(&flat, 72, 8), number(&flat, 80, 8)), (1, 0), "one element, no brick");
    let planes = offset(&flat, PLANES);
    for (of, about, [lower, upper]) in [
        ("empty", "all cells of the root are EMPTY", [0, 0]),
        ("full", "all cells of the root are FULL", [u64::MAX; 2]),
        ("partial", "all cells of the root are PARTIAL", [0, u64::MAX]),
    ] {
        let same = changed(&flat, |bytes| {
            put(bytes, planes, lower, 8);
            put(bytes, planes + 8, upper, 8);
        });
        list.add("element-uniform", of, about, uniform(0), same);
    }
    let odd = good(&Model::plain(3, cells(3, |at| solid(at[0] > 3))));
    let same = changed(&odd, |bytes| {
        let planes = offset(bytes, PLANES);
        put(bytes, planes, 0xFF, 8);
        put(bytes, planes + 8, 0xFF, 8);
    });
    let about = "all cells that the root has at depth 3 are FULL";
    list.add("element-uniform", "odd", about, uniform(0), same);
    let deeper = good(&without_bricks(BINARY));
    let last = number(&deeper, 72, 8) - 1;
    let same = changed(&deeper, |bytes| {
        let planes = offset(bytes, PLANES) + 16 * last as usize;
        bytes[planes..planes + 16].fill(0);
    });
    list.add("element-uniform", "", "all cells of the last element are EMPTY", uniform(last), same);
}

fn dictionaries(list: &mut List) {
    let coded = good(&coded());
    let bricks = number(&coded, 80, 8);
    let count = number(&coded, 88, 8);
    let (indices, entries, segments) =
        (offset(&coded, INDICES), offset(&coded, ENTRIES), offset(&coded, SEGMENTS));
    let index = |bytes: &[u8], b: u64| number(bytes, indices + 2 * b as usize, 2);
    let uses = |i: u64| (0..bricks).filter(|&b| index(&coded, b) == i).count();
    let damaged = |brick| format!("Damaged(Dictionary {{ brick: {brick} }})");
    let about = "the first segment does not begin with the first entry";
    list.add("dictionary-range", "start", about, damaged(0), with(&coded, segments, 1, 8));
    let about = "the segment begins beyond the entries";
    list.add("dictionary-range", "beyond", about, damaged(0), with(&coded, segments, count + 1, 8));
    let about = "the last brick's index is the number of entries";
    let beyond = with(&coded, indices + 2 * (bricks as usize - 1), count, 2);
    list.add("dictionary-index", "", about, damaged(bricks - 1), beyond);
    let about = "the first brick's index is 65535";
    list.add("dictionary-index", "large", about, damaged(0), with(&coded, indices, 0xFFFF, 2));

    // Bricks with other values would be other trees. Here only their encoding matters, and it is checked
    // first.
    let unused = changed(&coded, |bytes| {
        for b in 0..bricks {
            if index(bytes, b) == count - 1 {
                put(bytes, indices + 2 * b as usize, 0, 2);
            }
        }
    });
    list.add("dictionary-unused", "", "no brick uses the last entry", entry_order(count - 1), unused);
    let swapped = |i: u64, j: u64| {
        changed(&coded, |bytes| {
            let at = |i: u64| entries + 8 * i as usize;
            let (a, b) = (number(bytes, at(i), 8), number(bytes, at(j), 8));
            put(bytes, at(i), b, 8);
            put(bytes, at(j), a, 8);
            for b in 0..bricks {
                let renamed = match index(bytes, b) {
                    old if old == i => j,
                    old if old == j => i,
                    old => old,
                };
                put(bytes, indices + 2 * b as usize, renamed, 2);
            }
        })
    };
    let step = (1..count).find(|&i| uses(i - 1) != uses(i)).expect("different frequencies");
    let about = "an entry that is used less often comes first";
    list.add("dictionary-order", "frequency", about, entry_order(step), swapped(step - 1, step));
    let tie = (1..count).find(|&i| uses(i - 1) == uses(i)).expect("entries that are used equally often");
    let about = "of entries that are used equally often the larger comes first";
    list.add("dictionary-order", "value", about, entry_order(tie), swapped(tie - 1, tie));
    let value = |i: u64| number(&coded, entries + 8 * i as usize, 8);
    let same = with(&coded, entries + 8 * tie as usize, value(tie - 1), 8);
    let about = "an entry that is used as often as the one before it is the same";
    list.add("dictionary-order", "same", about, entry_order(tie), same);
    // In the place of an entry of another frequency, where its value does not disturb the order.
    let fits = |&(i, j): &(u64, u64)| {
        uses(i) != uses(j)
            && (uses(j - 1) != uses(j) || value(j - 1) < value(i))
            && (j + 1 == count || uses(j + 1) != uses(j) || value(i) < value(j + 1))
    };
    let pairs = (1..count).flat_map(|j| (0..j).map(move |i| (i, j)));
    let (first, again) = pairs.into_iter().find(fits).expect("a value that fits");
    let same = with(&coded, entries + 8 * again as usize, value(first), 8);
    let about = "an entry stands twice";
    list.add("dictionary-duplicate", "", about, entry_order(again), same);
}

fn bricks(list: &mut List) {
    let depth_1 = good(&Model::plain(1, cells(1, |[x, _, _]| solid(x == 0))));
    let outside = with(&depth_1, offset(&depth_1, BRICKS), 0x155, 8);
    list.add("brick-padding", "", "cell 8 of the brick is FULL at depth 1", "Damaged(Padding)", outside);
    let uniform = |index| format!("Damaged(Uniform {{ index: {index} }})");
    let all = with(&depth_1, offset(&depth_1, BRICKS), 0xFF, 8);
    let about = "all cells that the brick has at depth 1 are FULL";
    list.add("brick-uniform", "depth-1", about, uniform(0), all);
    let raw = good(&example());
    let bricks = offset(&raw, BRICKS);
    let empty = changed(&raw, |bytes| bytes[bricks + 16..bricks + 32].fill(0));
    list.add("brick-uniform", "empty", "all cells of the second brick are EMPTY", uniform(2), empty);
    let partial = changed(&raw, |bytes| {
        bytes[bricks..bricks + 8].fill(0);
        bytes[bricks + 8..bricks + 16].fill(0xFF);
    });
    list.add("brick-uniform", "partial", "all cells of the first brick are PARTIAL", uniform(1), partial);
    let branch = |brick| format!("Damaged(BrickBranch {{ brick: {brick} }})");
    let cut = with(&raw, bricks + 16, 1, 1);
    list.add("brick-branch", "", "a cell of the second brick is BRANCH", branch(1), cut);
    let depth_2 = good(&Model::plain(2, noise(2, 3, CERTIFIED)));
    let all = changed(&depth_2, |bytes| {
        let at = offset(bytes, BRICKS);
        put(bytes, at, u64::MAX, 8);
        put(bytes, at + 8, 0, 8);
    });
    list.add("brick-branch", "all", "all cells of the only brick are BRANCH", branch(0), all);
}

/// Vectors for §10.2, the records and sections of channels.
fn channel_records(list: &mut List) {
    list.way = Way::Metadata;
    let raw = good(&channelled());
    let mut one = |rule, of: &str, about, error: String, at: usize, value: u64, length| {
        let bytes = with(&raw, record(&raw, 2) + at, value, length);
        list.add(rule, of, about, error, bytes);
    };
    let mut fixed = |of: &str, about, name: &str, at, value: u64, length, found: u64| {
        one("channel-record", of, about, field(name, found), at, value, length);
    };
    fixed("parent", "the parent is another channel", "channel's parent", 4, 1, 4, 1);
    let about = "there is no parent";
    fixed("parent-none", about, "channel's parent", 4, NO_PARENT, 4, NO_PARENT);
    let about = "another universe than the solid's";
    fixed("origin", about, "channel's origin", 40, 1f64.to_bits(), 8, 1);
    let edge = 8f64.to_bits();
    fixed("edge", "a longer edge than the solid's", "channel's edge", 56, edge, 8, edge);
    fixed("exterior", "values outside of the universe", "channel's exterior", 14, 3, 1, 3);
    fixed("proof", "proven values", "channel's proof", 15, 3, 1, 3);
    let displacement = 1f64.to_bits();
    fixed("displacement", "a displacement", "channel's displacement", 24, displacement, 8, displacement);
    fixed("planes", "bricks of one plane", "planes of a brick", 16, 1, 1, 1);
    fixed("extents", "the first extent", "channel's extents", 64, 4, 4, 4);
    fixed("extents-last", "the last extent", "channel's extents", 72, 4, 4, 0);
    fixed("reserved", "the first of the reserved bytes", "reserved field", 21, 1, 1, 2);
    fixed("reserved-middle", "the reserved number", "reserved field", 79, 1, 1, 2);
    fixed("reserved-last", "the last of the reserved bytes", "reserved field", 127, 0x80, 1, 2);
    let mut one = |rule, of: &str, about, name: &str, at: usize, value: u64, length| {
        let bytes = with(&raw, record(&raw, 2) + at, value, length);
        list.add(rule, of, about, field(name, value), bytes);
    };
    one("channel-root", "partial", "cells of a tag that channels have no use for", "root tag", 13, 2, 1);
    one("channel-root", "", "a tag of three bits", "root tag", 13, 4, 1);
    one("channel-depth", "zero", "no level", "depth", 12, 0, 1);
    one("channel-depth", "large", "21 levels", "depth", 12, 21, 1);
    one("channel-type", "zero", "values of bytes of unknown meaning", "value type", 19, 0, 1);
    one("channel-type", "u64", "u64, of which there are no values", "value type", 19, U64, 1);
    one("channel-type", "f64", "f64, of which there are no values", "value type", 19, F64, 1);
    one("channel-type", "", "an unknown type", "value type", 19, 7, 1);
    one("channel-type", "components-zero", "values of no number", "components", 20, 0, 1);
    one("channel-type", "components", "values of five numbers", "components", 20, 5, 1);
    one("channel-counts", "", "an unknown encoding of bricks", "brick encoding", 17, 2, 1);
    one("channel-counts", "shift", "a segment shift of raw bricks", "segment shift", 18, 63, 1);
    one("channel-counts", "entries", "a dictionary entry of raw bricks", "dictionary entries", 96, 1, 8);
    one("channel-counts", "elements", "an element at depth 2", "elements", 80, 1, 8);
    one("channel-counts", "root", "a brick, and one value everywhere", "bricks", 13, 3, 1);
    let last = list.vectors.last_mut().expect("a vector");
    last.error = field("bricks", 1);
    let newer = changed(&raw, |bytes| {
        put(bytes, 10, NEWER, 2);
        let at = record(bytes, 2);
        put(bytes, at + 19, 9, 1);
    });
    let about = "an unknown type of values in a newer minor version";
    list.add("channel-type", "newer", about, field("value type", 9), newer);

    let mut parts = |rule, of: &str, about, error: String, change: &dyn Fn(&mut Parts)| {
        let mut parts = Parts::of(&channelled());
        change(&mut parts);
        parts.sort();
        list.add(rule, of, about, error, parts.bytes());
    };
    let about = "a required section of an unknown kind";
    parts("channel-unknown", "", about, required("section", 17), &|parts| {
        parts.sections.push(Section::new(17, (U8, 1), vec![1; 8]).of(1).flagged(1));
    });
    let about = "a required section of a kind that only the solid has";
    parts("channel-unknown", "objects", about, required("section", 1), &|parts| {
        parts.sections.push(Section::new(OBJECTS, (U8, 1), vec![1; 8]).of(2));
    });
    let about = "values in an unknown encoding of a newer minor version";
    parts("channel-unknown", "encoding", about, required("section encoding", 1), &|parts| {
        put(&mut parts.head, 10, NEWER, 2);
        parts.own(2, VALUES).encoding = 1;
    });
    for (kind, name) in [
        (LEVELS, "level table"),
        (PLANES, "planes"),
        (BRICKS, "bricks"),
        (VALUES, "values"),
        (VALUE_REL, "value rel"),
        (VALUE_BASE, "value base"),
    ] {
        let of = |what: &str| format!("{}-{what}", name.replace(' ', "-"));
        parts("channel-section", &of("absent"), "it is absent", section(name), &|parts| {
            parts.take_of(1, kind);
        });
        parts("channel-section", &of("count"), "one element too many", section(name), &|parts| {
            let whole = parts.own(1, kind);
            whole.bytes.extend(vec![0; whole.size()]);
        });
    }
    let about = "a section of dictionaries where bricks are raw";
    parts("channel-section", "indices", about, section("brick indices"), &|parts| {
        parts.sections.push(Section::new(INDICES, (U16, 1), vec![0, 0]).of(1));
    });
    parts("channel-section", "type", "values of another type", section("values"), &|parts| {
        parts.own(2, VALUES).element = (U8, 4);
    });
    let about = "values of other components";
    parts("channel-section", "components", about, section("values"), &|parts| {
        let values = parts.own(2, VALUES);
        (values.element, values.count) = ((U16, 1), None);
    });
    let about = "values that are not required";
    parts("channel-section", "optional", about, field("section flags", 0), &|parts| {
        parts.own(2, VALUES).flags = 0;
    });
    let about = "metadata that are required";
    parts("channel-section", "metadata-required", about, field("section flags", 1), &|parts| {
        parts.own(2, METADATA).flags = 1;
    });
    let about = "metadata of 2^16 + 1 bytes";
    parts("channel-section", "metadata-length", about, field("section length", 65_537), &|parts| {
        parts.own(2, METADATA).bytes.resize(65_537, 0);
    });
    let about = "more values than there are bytes";
    parts("channel-section", "huge", about, section("values"), &|parts| {
        put(parts.record(1), 104, u64::MAX, 8);
    });

    let nodes = |parts: &mut Parts, level: usize, value: u64| {
        put(&mut parts.own(1, LEVELS).bytes, 24 * level, value, 8)
    };
    let about = "a channel without a node for the universe, which is cut";
    parts("level-table-root", "channel", about, levels(0), &|parts| nodes(parts, 0, 0));
    let about = "2^64 - 1 nodes of a channel";
    parts("level-table-starts", "channel", about, levels(1), &|parts| nodes(parts, 1, u64::MAX));
    let about = "a node less than a channel has elements and bricks";
    parts("level-table-sum", "channel", about, levels(3), &|parts| {
        let bricks = number(&parts.own(1, LEVELS).bytes, 24, 8);
        nodes(parts, 1, bricks - 1);
    });
    let text = "Format(Metadata)";
    parts("metadata-text", "channel", "a channel's value that is no UTF-8", text.into(), &|parts| {
        *parts.own(1, METADATA).bytes.last_mut().expect("a byte") = 0xFF;
    });
    let name = |parts: &mut Parts, channel, name: u8| {
        parts.own(channel, METADATA).bytes = [b"\x04\0\0\0\x01\0\0\0name", &[name][..]].concat();
    };
    let about = "names that descend";
    parts("channel-name", "", about, field("name of channel", 2), &|parts| name(parts, 1, b'c'));
    let about = "two channels of one name";
    parts("channel-name", "twice", about, field("name of channel", 2), &|parts| name(parts, 1, b'b'));
    let about = "two channels without a name";
    parts("channel-name", "none", about, field("name of channel", 2), &|parts| {
        parts.take_of(1, METADATA);
        parts.take_of(2, METADATA);
    });
    let mut crowd = Parts::of(&Model::plain(1, |_| Tag::Full));
    crowd.head[10] = 2;
    for channel in 1..=257u64 {
        let record = crowd.object(CHANNEL, 0, 0);
        // A channel of depth 1, without a value, in the solid's universe: the fields from the depth on.
        (record[0], record[4], record[7], record[8]) = (1, 2, 1, 1);
        put(record, 56 - 12, 2f64.to_bits(), 8);
        let name = format!("{channel:03}");
        let facts = [b"\x04\0\0\0\x03\0\0\0name", name.as_bytes()].concat();
        crowd.sections.push(Section::new(METADATA, (U8, 1), facts).of(channel));
        let table = Section::new(LEVELS, (U64, 3), vec![0; 48]).of(channel);
        crowd.sections.push(Section { same: (channel > 1).then_some((1, LEVELS)), ..table });
    }
    list.add("channel-count", "", "257 channels", field("channels", 257), crowd.bytes());
}

/// Vectors for §10.3, the contents of channels.
fn channel_contents(list: &mut List) {
    list.way = Way::Verification;
    let raw = good(&channelled());
    let at = |owner, kind| offset_of(&raw, owner, kind);
    let (elements, bricks) = (number(&raw, record(&raw, 1) + 80, 8), number(&raw, record(&raw, 1) + 88, 8));
    let (planes, blocks) = (at(1, PLANES), at(1, BRICKS));
    let words = |at: usize| [number(&raw, at, 8), number(&raw, at + 8, 8)];
    let mut one = |rule, of: &str, about, error: String, change: &dyn Fn(&mut Vec<u8>)| {
        list.add(rule, of, about, error, changed(&raw, change));
    };
    assert!(elements == 1 && bricks > 1);
    let [lower, upper] = words(planes);
    let branch = (lower & !upper) & (lower & !upper).wrapping_neg();
    let count = (lower & !upper).count_ones() as u64;
    let error = format!("Damaged(Count {{ level: 1, expected: {}, found: {bricks} }})", count - 1);
    let about = "a refined cell of a channel's root less than there are bricks";
    one("element-count", "channel", about, error, &|bytes| put(bytes, planes, lower & !branch, 8));
    let about = "the children of a channel's element are one further";
    one("element-link", "channel", about, link(0), &|bytes| put(bytes, at(1, BASE), 2, 8));
    let about = "cell 63 of a channel's root continues a value at odd depth";
    one("element-padding", "channel", about, "Damaged(Padding)".into(), &|bytes| bytes[planes + 15] |= 0x80);
    let cut = "Damaged(BrickBranch { brick: 0 })";
    let about = "a cell of a channel's brick is refined";
    one("brick-branch", "channel", about, cut.into(), &|bytes| {
        let [lower, upper] = words(blocks);
        put(bytes, blocks, lower | 1, 8);
        put(bytes, blocks + 8, upper & !1, 8);
    });
    let uniform = |index| format!("Damaged(Uniform {{ index: {index} }})");
    let about = "no cell of a brick has a value";
    one("channel-uniform", "empty", about, uniform(elements), &|bytes| bytes[blocks..blocks + 16].fill(0));
    let about = "all cells of a brick continue one value";
    one("channel-uniform", "", about, uniform(elements), &|bytes| {
        bytes[blocks..blocks + 8].fill(0);
        bytes[blocks + 8..blocks + 16].fill(0xFF);
    });
    let about = "the first cell of a brick starts a value, all others continue it";
    one("channel-uniform", "starts", about, uniform(elements), &|bytes| {
        put(bytes, blocks, 1, 8);
        bytes[blocks + 8..blocks + 16].fill(0xFF);
    });
    let rank = |index| format!("Damaged(Rank {{ index: {index} }})");
    let (rel, base, second) = (at(1, VALUE_REL), at(1, VALUE_BASE), at(2, VALUES));
    let about = "one value more before the second element than there is";
    one("channel-rank", "", about, rank(1), &|bytes| {
        let wrong = number(bytes, rel + 2, 2) + 1;
        put(bytes, rel + 2, wrong, 2);
    });
    one("channel-rank", "base", "a value before the first element", rank(0), &|bytes| put(bytes, base, 1, 8));
    let about = "2^64 - 1 values before the first element";
    one("channel-rank", "overflow", about, rank(0), &|bytes| put(bytes, base, u64::MAX, 8));
    let about = "a value starts that no array has";
    let starts = |bytes: &mut Vec<u8>| {
        // In the second channel, the last cell that continues a value starts one.
        let block = at(2, BRICKS);
        let [lower, upper] = [number(bytes, block, 8), number(bytes, block + 8, 8)];
        let last = (upper & !lower).checked_ilog2().expect("a cell that continues a value");
        put(bytes, block, lower | 1 << last, 8);
    };
    one("channel-values", "", about, rank(1), &starts);
    let value = |index: u64| format!("Damaged(Value {{ index: {index} }})");
    let about = "the first cell that has a value continues one";
    one("channel-start", "", about, value(0), &|bytes| {
        let block = at(2, BRICKS);
        let lower = number(bytes, block, 8);
        put(bytes, block, lower & (lower - 1), 8);
    });
    let about = "a value that is the one before";
    one("channel-value", "same", about, value(1), &|bytes| bytes.copy_within(second..second + 4, second + 4));
    let floats = at(1, VALUES);
    for (of, about, bits) in [
        ("nan", "not a number", f32::NAN.to_bits()),
        ("infinite", "infinite", f32::INFINITY.to_bits()),
        ("negative-infinite", "minus infinity", f32::NEG_INFINITY.to_bits()),
        ("negative-zero", "-0", (-0f32).to_bits()),
    ] {
        one("channel-value", of, about, value(2), &|bytes| put(bytes, floats + 8, bits.into(), 4));
    }
    let table = at(1, LEVELS);
    for (of, about, entry, level) in [
        ("channel-nodes", "nodes of a channel of a level that no start depends on", 48, 2),
        ("channel-full", "cells of a channel that have a value", 24 + 8, 1),
        ("channel-partial", "cells of a channel that start a value", 72 + 16, 3),
    ] {
        one("level-table-counts", of, about, levels(level), &|bytes| {
            let wrong = number(bytes, table + entry, 8) + 1;
            put(bytes, table + entry, wrong, 8);
        });
    }
    let mut parts = Parts::of(&channelled());
    let values = parts.own(2, VALUES);
    values.bytes.extend(vec![9; 4]);
    let count = values.bytes.len() as u64 / 4;
    put(parts.record(2), 104, count, 8);
    list.add("channel-values", "many", "a value that no cell starts", rank(1), parts.bytes());
    let constant = || {
        Model::plain(1, |_| Tag::Full).channel(Field::new("one", 4, (ScalarType::U8, 1), |_| one_value(5.0)))
    };
    let mut parts = Parts::of(&constant());
    parts.own(1, VALUES).bytes.push(6);
    put(parts.record(1), 104, 2, 8);
    list.add("channel-values", "uniform", "two values of a universe that has one", rank(0), parts.bytes());
    let mut parts = Parts::of(&constant());
    parts.record(1)[13] = 0;
    list.add("channel-values", "nowhere", "a value of a universe that has none", rank(0), parts.bytes());
    let mut parts = Parts::of(&constant());
    parts.take_of(1, VALUES);
    put(parts.record(1), 104, 0, 8);
    list.add("channel-values", "none", "no value of a universe that has one", rank(0), parts.bytes());

    let coded = Model::plain(1, |_| Tag::Full);
    let stripes = |at: [u32; 3]| one_value(if at[0] % 4 < 2 { 1.0 } else { 2.0 });
    let coded = good(&coded.channel(Field::new("stripes", 4, (ScalarType::U8, 1), stripes)));
    let entry = offset_of(&coded, 1, INDICES);
    assert_eq!(number(&coded, record(&coded, 1) + 96, 8), 1);
    let about = "an index of a channel's brick beyond its dictionary";
    let error = "Damaged(Dictionary { brick: 3 })";
    list.add("dictionary-index", "channel", about, error, with(&coded, entry + 6, 1, 2));
}

// ---- vectors too large for the folder -------------------------------------------------------------------

fn many() -> Model {
    Model::plain(8, |cell| {
        let [x, y, z] = cell.at;
        if cell.level < 8 {
            return Tag::Branch;
        }
        let morton = |at: [u32; 3], bits: u32| {
            (0..3 * bits).fold(0u64, |m, i| m | (at[i as usize % 3] as u64 >> (i / 3) & 1) << i)
        };
        let brick = morton([x >> 2, y >> 2, z >> 2], 6);
        let value = mix((brick >> 16) * 100_000 + brick % 25_000);
        solid(value >> morton([x & 3, y & 3, z & 3], 2) & 1 != 0)
    })
}

/// A file of 64³ bricks with 25 000 kinds in every block of 2^16: two dictionary segments of 2^17 bricks.
#[allow(dead_code)]
pub fn many_bricks() -> Vec<u8> {
    good(&many())
}

/// The same tree with four segments of 2^16 bricks.
#[allow(dead_code)]
pub fn many_bricks_in_small_segments() -> Vec<u8> {
    Parts::of(&many()).in_small_segments().bytes()
}

// ---- the list of vectors --------------------------------------------------------------------------------

fn readme(valid: &[Valid], invalid: &[Invalid]) -> String {
    let mut text = String::from(include_str!("vectors.md"));
    text += "\n## Valid\n\n| file | what it is there for |\n|---|---|\n";
    let dexels = dexel_vectors::valid();
    let dexels = dexels.iter().map(|vector| (vector.name, vector.about, vector.canonical));
    for (name, about, canonical) in valid.iter().map(|v| (v.name, v.about, v.canonical)).chain(dexels) {
        let mark = if canonical { "" } else { " (not canonical)" };
        writeln!(text, "| [{name}](valid/{name}.txt) | {about}{mark} |").expect("strings grow");
    }
    text += "\n## Invalid\n\n| file | what is wrong | refused by |\n|---|---|---|\n";
    for vector in invalid {
        let (name, about, way) = (&vector.name, vector.about, vector.way.name());
        writeln!(text, "| [{name}](invalid/{name}.txt) | {about} | {way} |").expect("strings grow");
    }
    text
}
