//! Any bytes as tri-dexel models and as triangles: the laws of sets, changes in place, closed surfaces, and
//! equal samples along all three axes.

use super::Bytes;
use leafless::dexel::{Dexel, DexelEditor, DexelEnd, DexelEnds, DexelFormat, DexelNormals};
use leafless::op::{DexelOptions, octree_from_dexels};
use leafless::surface::{dual_contouring_dexels, marching_cubes_dexels};
use leafless::{
    Control, Error, FillRule, Frame, MeshSolid, Rule, TriDexel, TriangleMesh, build, dexelize, file,
};
use std::collections::HashMap;

impl Bytes<'_> {
    fn next(&mut self) -> u8 {
        self.byte() as u8
    }
}

/// Reads two models or triangles, and checks the library's results.
pub fn dexel_algebra(data: &[u8]) {
    let mut bytes = Bytes(data);
    let (depth, form) = (bytes.next(), bytes.next());
    let depth = 1 + depth % 4;
    let frame = Frame::new([0.0; 3], f64::from(1u32 << depth), depth).expect("a frame");
    let format = DexelFormat {
        ends: if form & 1 != 0 { DexelEnds::Double } else { DexelEnds::Fixed },
        normals: [DexelNormals::None, DexelNormals::Bits16, DexelNormals::Bits32, DexelNormals::None]
            [usize::from(form >> 1 & 3)],
        surfaces: form & 8 != 0,
        materials: form & 16 != 0,
    };
    if form & 128 != 0 {
        triangles(&mut bytes, &frame, format)
    } else {
        models(&mut bytes, &frame, format, form)
    }
}

/// Returns the model that the bytes describe; `None` if they describe none.
fn model(
    bytes: &mut Bytes<'_>,
    frame: &Frame,
    format: DexelFormat,
    directions: [bool; 3],
) -> Option<TriDexel> {
    let control = Control::threads(1);
    let one = |_: usize, _: [u32; 2], list: &mut Vec<Dexel>| {
        let mut at = 0.0;
        let count = bytes.next() % 4;
        for _ in 0..count {
            let [gap, length, what] = [bytes.next(), bytes.next(), bytes.next()];
            // Eighths of cells, and sometimes almost nothing.
            let step = |byte: u8| if byte == 255 { 1e-12 } else { f64::from(byte % 32) / 8.0 };
            let end = |at: f64, flip: f64| DexelEnd {
                surface: (what & 1 != 0).then_some(u32::from(what)),
                normal: (what & 2 != 0).then(|| [flip, f64::from(what >> 4) - 8.0, 1.0]),
                ..DexelEnd::new(at)
            };
            let (start, stop) = (at + step(gap), at + step(gap) + step(length));
            if start < stop {
                list.push(Dexel {
                    start: end(start, -1.0),
                    end: end(stop, 1.0),
                    material: u32::from(what >> 2 & 3),
                });
                at = stop;
            }
        }
        Ok(())
    };
    match TriDexel::from_rays(frame, format, directions, one, &control) {
        Ok(model) => Some(model),
        Err(Error::Argument { .. }) => None,
        Err(other) => panic!("{other}"),
    }
}

/// True if triangles use every edge equally often in both directions.
fn is_balanced(mesh: &TriangleMesh) -> bool {
    let mut edges: HashMap<(u32, u32), i64> = HashMap::new();
    for &[a, b, c] in mesh.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    edges.values().all(|&sum| sum == 0)
}

fn models(bytes: &mut Bytes<'_>, frame: &Frame, format: DexelFormat, form: u8) {
    let control = Control::threads(1);
    let mask = 1 + (form >> 5 & 3) * 2 % 7;
    let directions = [0, 1, 2].map(|axis| mask >> axis & 1 != 0);
    let Some(a) = model(bytes, frame, format, directions) else { return };
    let Some(b) = model(bytes, frame, format, directions) else { return };
    // For plain models the laws hold bit for bit.
    let plain = DexelFormat { ends: format.ends, ..DexelFormat::default() };
    let [p, q] = [&a, &b].map(|model| model.view().to_format(plain, &control).expect("a format"));
    let not = |x: &TriDexel| x.view().complement(&control).expect("a complement");
    let or = |x: &TriDexel, y: &TriDexel| x.view().union(y.view(), &control).expect("a union");
    let and =
        |x: &TriDexel, y: &TriDexel| x.view().intersection(y.view(), &control).expect("an intersection");
    let less = |x: &TriDexel, y: &TriDexel| x.view().difference(y.view(), &control).expect("a difference");
    let xor = |x: &TriDexel, y: &TriDexel| x.view().xor(y.view(), &control).expect("a symmetric difference");
    assert!(not(&or(&p, &q)) == and(&not(&p), &not(&q)));
    assert!(not(&not(&p)) == p);
    assert!(less(&p, &q) == and(&p, &not(&q)));
    assert!(xor(&p, &q) == or(&less(&p, &q), &less(&q, &p)));
    assert!(or(&less(&p, &and(&p, &q)), &and(&p, &q)) == p);
    // Attributes of ends do not change their places.
    for (whole, expected) in
        [(or(&a, &b), or(&p, &q)), (less(&a, &b), less(&p, &q)), (xor(&a, &b), xor(&p, &q))]
    {
        whole.view().check().expect("a sound result");
        assert!(whole.view().to_format(plain, &control).expect("a format") == expected);
        let written = file::dexels::to_bytes(&whole).expect("a file");
        assert!(file::dexels::from_bytes(&written).expect("what was written can be read") == whole);
    }
    let mut editor = DexelEditor::new(a.view()).expect("an editor");
    editor.subtract(b.view(), &control).expect("a cut");
    assert!(editor.freeze(&control).expect("a model") == less(&a, &b));
    editor.unite(b.view(), &control).expect("a union");
    editor.intersect(a.view(), &control).expect("an intersection");
    let edited =
        editor.freeze(&control).expect("a model").view().to_format(plain, &control).expect("a format");
    assert!(edited == and(&or(&less(&p, &q), &q), &p));
    for mesh in [marching_cubes_dexels(a.view(), &control), dual_contouring_dexels(a.view(), &control)] {
        assert!(is_balanced(&mesh.expect("a surface").0));
    }
}

fn triangles(bytes: &mut Bytes<'_>, frame: &Frame, format: DexelFormat) {
    let control = Control::threads(1);
    let count = usize::from(3 + bytes.next() % 12);
    // Eighths of cells, some beyond the universe.
    let vertices: Vec<[f64; 3]> =
        (0..count).map(|_| [0; 3].map(|_| f64::from(bytes.next()) / 8.0 - 8.0)).collect();
    let mut triangles = Vec::new();
    while !bytes.0.is_empty() && triangles.len() < 24 {
        triangles.push([0; 3].map(|_| u32::from(bytes.next()) % count as u32));
    }
    let Ok(mesh) = TriangleMesh::new(vertices, triangles) else { return };
    // (Around holes, cells are split twenty levels deep for each end.)
    let is_open = mesh.check_closed(FillRule::NonZero).is_err();
    let frame =
        &frame.with_depth(if is_open { frame.depth().min(2) } else { frame.depth() }).expect("a frame");
    for fill in [FillRule::NonZero, FillRule::Positive, FillRule::EvenOdd] {
        let Ok(solid) = MeshSolid::new(mesh.clone(), fill) else { continue };
        let tree = build(&solid, frame, Rule::Sampled, &control).expect("samples");
        for axis in 0..3 {
            let directions = [0, 1, 2].map(|a| a == axis);
            let options = DexelOptions { directions, format, rule: Rule::Sampled };
            let model = dexelize(&solid, frame, &options, &control).expect("rays");
            model.view().check().expect("a sound model");
            let found = octree_from_dexels(model.view(), &control).expect("an octree");
            // (Rays show nothing about points outside the universe.)
            let n = frame.cells();
            for i in 0..n * n * n {
                let at = [i % n, i / n % n, i / n / n];
                assert_eq!(
                    found.view().tag_at(at),
                    tree.view().tag_at(at),
                    "{fill:?} along {axis} at {at:?}"
                );
            }
        }
    }
}

/// Initial inputs of all kinds.
pub fn seeds() -> Vec<Vec<u8>> {
    let octahedron = [
        &[2, 128, 3][..],
        &[64, 96, 96, 128, 96, 96, 96, 64, 96, 96, 128, 96, 96, 96, 64, 96, 96, 128],
        &[0, 2, 4, 1, 4, 2, 1, 2, 5, 0, 5, 2, 0, 4, 3, 1, 3, 4, 1, 5, 3, 0, 3, 5],
    ]
    .concat();
    let rays: Vec<u8> = (0..600u32).map(|i| (i * i % 251) as u8).collect();
    let forms = [0, 1, 31, 30 | 96, 64 | 9];
    let mut seeds: Vec<Vec<u8>> = forms.map(|form| [&[form, form][..], &rays].concat()).into_iter().collect();
    seeds.push(octahedron);
    seeds
}
