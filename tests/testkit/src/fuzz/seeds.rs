//! Small files of every kind, made by the library.

use super::layout::{CUTS, File, OBJECTS, PLANES, RECORD, Repairs, Section, number, put};
use super::{CONTROL, joined};
use crate::Random;
use leafless::attribute::{Channel, FillOptions, FunctionAttribute, ScalarType, ValueType, fill_channel};
use leafless::dexel::{DexelEnds, DexelFormat, DexelNormals};
use leafless::op::DexelOptions;
use leafless::solid::{FreeParts, OneByOne, Question, WholeQuestion};
use leafless::{
    Affine, AnySolid, Cell, Classifier, Control, Csg, Error, FillRule, Frame, MeshSolid, Metadata, Octree,
    Proof, Rule, Solid, SurfaceOptions, Tag, TriangleMesh, Verdict, Worker, build, build_extended, dexelize,
    file,
};

/// A different tree for every seed, with coarse and fine cells of every tag.
#[derive(Clone, Copy)]
pub struct Noise(pub u64);

/// Classifier and worker on a frame.
#[derive(Clone, Copy)]
pub struct NoiseOnFrame {
    noise: Noise,
    frame: Frame,
}

impl Solid for Noise {
    type Classifier = NoiseOnFrame;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<NoiseOnFrame, Error> {
        Ok(NoiseOnFrame { noise: *self, frame: *frame })
    }
}

impl Classifier for NoiseOnFrame {
    type Worker = NoiseOnFrame;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<NoiseOnFrame, Error> {
        Ok(*self)
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl FreeParts for NoiseOnFrame {
    type Part = ();
}

impl OneByOne for NoiseOnFrame {}

impl Worker for NoiseOnFrame {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        Ok(Verdict::Partial(()))
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|k| {
            let cell = cell.child(k);
            let [x, y, z] = cell.at.map(u64::from);
            let mut random = Random(self.noise.0 ^ x << 40 ^ y << 20 ^ z ^ (cell.level as u64) << 60);
            let split = if cell.level < 3 { 90 } else { 30 };
            match random.below(256) {
                die if die < split => Verdict::Partial(()),
                die => [Verdict::Empty, Verdict::Full, Verdict::Undecided][die as usize % 3],
            }
        }))
    }

    fn answer(&mut self, _: Cell, _: &(), _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }
}

/// Bytes of the largest file. Small files are mutated faster.
const MOST: usize = 6000;

/// Returns the frame of all seeds at a depth.
pub fn frame(depth: u8) -> Frame {
    Frame::new([0.0; 3], 32.0, depth).expect("a legal frame")
}

fn noise(depth: u8, seed: u64, rule: Rule) -> Octree {
    build(&Noise(seed), &frame(depth), rule, &CONTROL).expect("no limits")
}

fn facts() -> Metadata {
    let mut metadata = Metadata::new();
    metadata.insert("units", "mm");
    metadata.insert("name", "Flansch Ø 120");
    metadata
}

/// A channel of coarse and fine regions, with and without values.
fn channel(name: &str, depth: u8, scalar: ScalarType, components: u8) -> Channel {
    let frame = frame(depth);
    let value = move |point: [f64; 3]| {
        let at = frame.cell_of(point).expect("a point of the universe").map(u64::from);
        let of = |bits: u8| {
            let [x, y, z] = at.map(|a| a >> (depth - bits.min(depth)));
            Random(x << 40 ^ y << 20 ^ z ^ u64::from(bits) << 60).below(256)
        };
        match of(1) % 4 {
            0 => None,
            1 => Some([7.0, 1.0, 2.0, 255.0]),
            _ => (of(2) % 5 != 0).then(|| [0, 1, 2, 3].map(|k| f64::from((of(depth) >> k) as u8 % 6))),
        }
    };
    let attribute = FunctionAttribute::new(components.into(), value).expect("1 to 4");
    let value_type = ValueType::new(scalar, components).expect("1 to 4");
    let options = FillOptions { value_type, frame, solid: None, detail: None };
    fill_channel(&attribute, &options, &CONTROL).expect("no limits").with_name(name)
}

/// Trees with channels of all types, finer and coarser than the solid.
fn trees_with_channels() -> Vec<Octree> {
    let with = |tree: Octree, channels: &[Channel]| {
        channels.iter().fold(tree, |tree, channel| tree.with_channel(channel.clone()).expect("of this cube"))
    };
    let noise = |depth| noise(depth, depth.into(), Rule::Certified);
    let mut unit = facts();
    unit.insert("unit", "K");
    let full = Octree::uniform(frame(4), Tag::Full, Tag::Empty).expect("no branch");
    vec![
        with(noise(3), &[channel("heat", 3, ScalarType::F32, 1).with_metadata(unit)]),
        with(noise(2), &[channel("", 4, ScalarType::U8, 3), channel("b", 1, ScalarType::U16, 2)]),
        with(noise(4), &[channel("c", 2, ScalarType::U32, 4)]),
        with(full, &[channel("fine", 5, ScalarType::U8, 1)]),
    ]
}

/// Trees with cuts: surfaces of all kinds, placed and unplaced, in one cell and in many.
fn trees_with_cuts() -> Vec<Octree> {
    let turn = Affine::new([[0.8, -0.6, 0.0, 9.0], [0.6, 0.8, 0.0, 3.0], [0.0, 0.0, 1.0, 16.0]]);
    let turn = turn.expect("a good map");
    let ball = Csg::ball([15.0, 16.0, 17.0], 12.0).expect("a ball");
    let plane = Csg::half_space([1.0, 2.0, -0.5], 30.0).expect("a plane");
    let bar = Csg::cuboid([3.5, 4.25, 5.0], [20.0, 11.0, 30.5]).expect("a box");
    let bar = bar.placed(&turn).expect("a good map");
    let ring = Csg::torus(7.0, 2.5).expect("a torus").placed(&turn).expect("a good map");
    let corners = vec![[2.0, 3.0, 4.0], [28.0, 5.0, 6.0], [8.0, 27.0, 3.0], [12.0, 10.0, 29.0]];
    let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mesh = TriangleMesh::new(corners, triangles).expect("a mesh");
    let mesh = Csg::solid(AnySolid::new(MeshSolid::new(mesh, FillRule::NonZero).expect("a closed mesh")));
    let make = |csg: &Csg, depth: u8, tolerance: Option<f64>| {
        build_extended(csg, &frame(depth), &SurfaceOptions { tolerance }, &CONTROL).expect("no limits")
    };
    let of = |result: Result<Csg, Error>| result.expect("two figures");
    vec![
        make(&plane, 9, None),
        make(&ball, 3, None),
        make(&of(ball.difference(&bar)), 2, None).with_metadata(facts()),
        make(&of(ball.difference(&bar)), 5, None),
        make(&of(Csg::union_of([ring.clone(), bar])), 4, None),
        make(&ring, 1, None),
        make(&mesh, 3, Some(0.5)),
        make(&of(mesh.difference(&ball)), 4, Some(2.0))
            .with_channel(channel("heat", 2, ScalarType::F32, 1))
            .expect("of this cube"),
    ]
}

/// Small trees of every kind.
pub fn trees() -> Vec<Octree> {
    let mut trees = vec![];
    for (depth, tag) in [(1, Tag::Empty), (2, Tag::Full), (9, Tag::Partial), (20, Tag::Full)] {
        trees.push(Octree::uniform(frame(depth), tag, tag).expect("no branch"));
    }
    for depth in 1..=7 {
        trees.push(noise(depth, depth.into(), Rule::Certified));
        trees.push(noise(depth, 100 + depth as u64, Rule::Inner).with_metadata(facts()));
    }
    let cuboid = Csg::cuboid([2.0; 3], [29.0; 3]).expect("a box");
    let corner = Csg::cuboid([0.0; 3], [1.0; 3]).expect("a box");
    let ball = Csg::ball([15.0, 16.0, 17.0], 12.0).expect("a ball");
    let small = Csg::ball([3.0; 3], 0.001).expect("a ball");
    let certified = Rule::Certified;
    trees.extend([
        build(&cuboid, &frame(5), Rule::Sampled, &CONTROL).expect("no limits"),
        build(&cuboid, &frame(4), certified, &CONTROL).expect("no limits"),
        build(&ball, &frame(5), certified, &CONTROL).expect("no limits"),
        build(&ball, &frame(6), Rule::Sampled, &CONTROL).expect("no limits"),
        build(&corner, &frame(11), certified, &CONTROL).expect("no limits"),
        build(&small, &frame(20), certified, &CONTROL).expect("no limits"),
    ]);
    trees.extend(trees_with_channels());
    trees.extend(trees_with_cuts());
    trees
}

/// The trees' files, and some that a later version might write.
pub fn files() -> Vec<Vec<u8>> {
    let mut files: Vec<_> = trees().iter().map(|tree| file::to_bytes(tree).expect("a good tree")).collect();
    let newer = |tree: usize, change: &dyn Fn(&mut File)| {
        let mut file = File::parse(&files[tree]).expect("a file");
        change(&mut file);
        file.assemble(&Repairs::FRAME)
    };
    let more = [
        newer(6, &|file| {
            put(&mut file.header, 10, 5, 2);
            put(&mut file.header, 20, 1, 4);
            file.header[71] = 5;
            file.header[115] = 9;
        }),
        newer(9, &|file| file.sections.push(Section::new(17, b"colours!".to_vec()))),
        // Two unknown objects. One has the solid's bytes.
        newer(10, &|file| {
            let of = file.sections.iter().position(|section| section.is(PLANES)).expect("planes");
            let objects = file.section(OBJECTS).expect("objects");
            objects.bytes.resize(3 * RECORD, 2);
            let mut own = Section::new(17, b"colours!".to_vec());
            put(&mut own.entry, 4, 1, 4);
            let mut shared = file.sections[of].clone();
            put(&mut shared.entry, 4, 2, 4);
            put(&mut shared.entry, 44, of as u64 + 1, 4);
            file.sections.extend([own, shared]);
        }),
        // Kinds of applications.
        newer(13, &|file| {
            let numbers = Section::new(1 << 31, 0.5f64.to_le_bytes().repeat(3));
            file.sections.push(numbers);
            file.sections.last_mut().expect("a section").entry[8] = 6;
        }),
    ];
    files.extend(more);
    files.retain(|file| file.len() <= MOST);
    files
}

/// Files of tri-dexel models, of all formats and directions.
pub fn dexel_files() -> Vec<Vec<u8>> {
    let ball = Csg::ball([15.0, 16.0, 17.0], 12.0).expect("a ball");
    let bar = Csg::cuboid([10.0, 0.0, 14.0], [32.0, 17.0, 18.0]).expect("a box");
    let cut = ball.difference(&bar).expect("two figures");
    let normals = [DexelNormals::None, DexelNormals::Bits16, DexelNormals::Bits32];
    let mut files = vec![];
    for (i, normals) in normals.into_iter().cycle().take(12).enumerate() {
        let format = DexelFormat {
            ends: if i % 2 == 0 { DexelEnds::Fixed } else { DexelEnds::Double },
            normals,
            surfaces: i % 4 < 2,
            materials: i % 5 < 3,
        };
        let directions = [i % 7 != 0, i % 3 != 1, i % 7 == 0 || i % 4 == 1];
        let options = DexelOptions { directions, format, ..DexelOptions::default() };
        let model = dexelize(&cut, &frame(2 + i as u8 % 3), &options, &CONTROL).expect("no limits");
        let model = if i % 5 == 0 { model.with_metadata(facts()) } else { model };
        files.push(file::dexels::to_bytes(&model).expect("a good model"));
    }
    files
}

/// Inputs of two parts: a file and questions, or two files on one lattice.
pub fn pairs() -> Vec<Vec<u8>> {
    let files = files();
    let mut random = Random(1);
    let mut pairs = vec![];
    for a in &files {
        for b in &files {
            if a[32..65] == b[32..65] && a.len() + b.len() < 12_000 {
                pairs.push(joined(a, b));
            }
        }
        let questions: Vec<u8> = (0..96).map(|_| random.bits() as u8).collect();
        pairs.push(joined(a, &questions));
    }
    pairs
}

/// True if a file has an unknown section or object, or sections that share bytes.
pub fn has_unknown_parts(bytes: &[u8]) -> bool {
    let mut file = File::parse(bytes).expect("a file");
    let objects = file.section(OBJECTS).map_or(0, |objects| objects.bytes.len() / RECORD);
    let has_cuts = number(&file.header, 10, 2) >= 4;
    let known = |section: &Section| {
        let is_known = (1..=10).contains(&section.kind()) || has_cuts && CUTS.contains(&section.kind());
        is_known && section.same().is_none()
    };
    objects > 1 || !file.sections.iter().all(known)
}
