//! Any bytes through every reader of meshes. No reader panics, and each mesh read comes back after it is
//! written.

use leafless::{Error, TriangleMesh, exchange};

/// A function that reads a mesh.
pub type Reader = fn(&[u8]) -> Result<TriangleMesh, Error>;
/// A function that writes a mesh.
pub type Writer = fn(&TriangleMesh) -> Vec<u8>;

/// All readers of single files.
pub const READERS: [(&str, Reader); 4] = [
    ("STL", exchange::read_stl),
    ("OBJ", exchange::read_obj),
    ("PLY", exchange::read_ply),
    ("OFF", exchange::read_off),
];

/// Writers of several dialects, each with its reader.
pub const WRITERS: [(Writer, Reader); 8] = [
    (obj, exchange::read_obj),
    (obj_from_behind, exchange::read_obj),
    (off, exchange::read_off),
    (off_of_numbers, exchange::read_off),
    (|mesh| ply("ascii", mesh), exchange::read_ply),
    (|mesh| ply("binary_little_endian", mesh), exchange::read_ply),
    (|mesh| ply("binary_big_endian", mesh), exchange::read_ply),
    (strips, exchange::read_ply),
];

/// Reads `data` as a file of every format.
pub fn meshes(data: &[u8]) {
    for (name, read) in READERS {
        let Ok(mesh) = read(data) else { continue };
        let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
        assert!(vertices.len() <= data.len() && triangles.len() <= data.len(), "{name}");
        assert!(triangles.iter().flatten().all(|&v| (v as usize) < vertices.len()), "{name}");
        // An OBJ needs some content to be recognised.
        for (write, read) in WRITERS.into_iter().filter(|_| !vertices.is_empty()) {
            let written = write(&mesh);
            let back = read(&written).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert!(back.vertices() == vertices && back.triangles() == triangles, "{name}");
        }
        if let Ok(written) = exchange::write_stl(&mesh) {
            let back = exchange::read_stl(&written).expect("what was written can be read");
            let report = back.report().expect("memory");
            assert_eq!(report.facets_read, triangles.len() as u64, "{name}");
        }
    }
}

/// Small files of every dialect.
pub fn seeds() -> Vec<Vec<u8>> {
    let mut seeds: Vec<Vec<u8>> = TEXTS.iter().map(|text| text.as_bytes().to_vec()).collect();
    for text in &TEXTS[..2] {
        let mesh = exchange::read_obj(text.as_bytes()).expect("a good file");
        seeds.extend(WRITERS.map(|(write, _)| write(&mesh)));
        seeds.push(exchange::write_stl(&mesh).expect("a good mesh"));
    }
    let binary = |header: &str, numbers: &[i32]| {
        let numbers = numbers.iter().flat_map(|number| number.to_be_bytes());
        header.bytes().chain(numbers).collect::<Vec<u8>>()
    };
    let one = 1f32.to_bits() as i32;
    let corners = [0, 0, 0, one, 0, 0, 0, one, 0];
    seeds.push(binary("OFF BINARY\n", &[&[3, 1, 0], &corners[..], &[3, 0, 1, 2, 3, one, 0, 0]].concat()));
    seeds.push(binary("4nOFF BINARY\r\n", &[3, 1, 1, 0, one, 0, 0, one, 1, 0, 0]));
    seeds
}

const TEXTS: [&str; 12] = [
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    "# L\r\nv 0 0 0\r\nv 2 0 0\r\nv 2 1 0\r\nv 1 1 0\r\nv 1 2 0\r\nv 0 2 0\r\nf 1 2 3 \\\r\n4 5 6\r\n",
    "mtllib a\nusemtl \nvt 0 1\nvn 0 0 1\nf 1/1/1 2//1 3/1\nv .5 -1. +1e-3 1\ng a b\nv 1E+2 0 0 1 0 0\ns off\nv 0 1 0\nf -3 -2 -1\n",
    "ply\r\nformat ascii 1.0\r\ncomment a\r\nelement vertex 3\r\nproperty double x\r\nproperty int y\r\nproperty float z\r\n\
     property uchar red\r\nelement face 1\r\nproperty list uchar int vertex_index\r\nproperty list char float t\r\nend_header\r\n\
     0 0 0 9\r\n1 0 0 9\r\n0 1 0 9\r\n3 0 1 2 2 .5 1\r\n",
    "ply\nformat binary_big_endian 1.0\nelement other 1\nproperty list short double a\nelement face 1\nproperty list int char \
     vertex_indices\nproperty uchar b\nelement vertex 3\nproperty char x\nproperty char z\nproperty char y\nobj_info c\nend_header\n\
     \0\x01\0\0\0\0\0\0\0\0\0\0\0\x03\0\x01\x02\x07\0\0\0\x01\0\0\0\x01\0",
    "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 1 2 # c\n",
    "COFF 3 1\n0 0 0 255 0 0 255\n1 0 0 0 1 0\n0 1 0 0 1 0 1\n3 0 1 2 .5 .5 .5 1\n",
    "STN4nOFF 3\n3 1 9\n0 0 0 1 0 0 1 .5 .5\n2 0 0 2 0 0 1 .5 .5\n0 1 0 1 0 0 1 .5 .5\n3 0 1 2\n",
    "# x\n3\n2\n1\n0 0 0 1 0 0\n0 1 0\n3 0 1 2 7\n2 0 1\n",
    "OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n",
    "v 1d5 0x1 nan\nv 12345678901234567890e-5 9007199254740993 1e-400\nsurf 1\ncall a\nf 1\nf 1 2 9\n",
];

fn line(text: &mut Vec<u8>, line: std::fmt::Arguments) {
    text.extend(line.to_string().into_bytes());
    text.push(b'\n');
}

fn obj(mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = b"g mesh\n".to_vec();
    mesh.vertices().iter().for_each(|[x, y, z]| line(&mut text, format_args!("v {x:e} {y:e} {z:e}")));
    let one = |v: u32| u64::from(v) + 1;
    mesh.triangles().iter().map(|t| t.map(one)).for_each(|[a, b, c]| {
        line(&mut text, format_args!("f {a} {b}/1 {c}//2"));
    });
    text
}

/// Writes an OBJ with faces before vertices.
fn obj_from_behind(mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = b"# mesh\r\n".to_vec();
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|v| i64::from(v) + 1);
        line(&mut text, format_args!("f {a} \\\r\n {b} {c}\r"));
    }
    mesh.vertices()
        .iter()
        .for_each(|[x, y, z]| line(&mut text, format_args!("v\t{x:e}\t{y:e}\t{z:e} 1 1 1\r")));
    text
}

fn off(mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = b"COFF\n".to_vec();
    line(&mut text, format_args!("{} {} 0", mesh.vertices().len(), mesh.triangles().len()));
    mesh.vertices().iter().for_each(|[x, y, z]| line(&mut text, format_args!("{x:e} {y:e} {z:e} 1 0 0")));
    mesh.triangles().iter().for_each(|[a, b, c]| line(&mut text, format_args!("3 {a} {b} {c} 7")));
    text
}

fn off_of_numbers(mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = vec![];
    line(&mut text, format_args!("{}\n{}\n0", mesh.vertices().len(), mesh.triangles().len()));
    mesh.vertices().iter().for_each(|[x, y, z]| line(&mut text, format_args!("{x:e}\n{y:e}#{z}\n{z:e}")));
    mesh.triangles().iter().for_each(|[a, b, c]| line(&mut text, format_args!("3\n{a}\n{b}\n{c}")));
    text
}

fn ply(format: &str, mesh: &TriangleMesh) -> Vec<u8> {
    let mut file = vec![];
    line(&mut file, format_args!("ply\nformat {format} 1.0\nelement vertex {}", mesh.vertices().len()));
    line(
        &mut file,
        format_args!("property double z\nproperty double y\nproperty uchar a\nproperty double x"),
    );
    line(&mut file, format_args!("element face {}", mesh.triangles().len()));
    line(&mut file, format_args!("property uchar a\nproperty list uchar uint vertex_indices\nend_header"));
    let in_order = |mut bytes: Vec<u8>| {
        if format.contains("big") {
            bytes.reverse();
        }
        bytes
    };
    for &[x, y, z] in mesh.vertices() {
        if format == "ascii" {
            line(&mut file, format_args!("{z:e} {y:e} 7 {x:e}"));
            continue;
        }
        for (x, a) in [(z, false), (y, true), (x, false)] {
            file.extend(in_order(x.to_le_bytes().to_vec()));
            file.extend(a.then_some(7));
        }
    }
    for &[a, b, c] in mesh.triangles() {
        if format == "ascii" {
            line(&mut file, format_args!("7 3 {a} {b} {c}"));
            continue;
        }
        file.extend([7, 3]);
        [a, b, c].iter().for_each(|v| file.extend(in_order(v.to_le_bytes().to_vec())));
    }
    file
}

fn strips(mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = vec![];
    line(&mut text, format_args!("ply\nformat ascii 1.0\nelement tristrips 1"));
    line(
        &mut text,
        format_args!("property list uint int vertex_index\nelement vertex {}", mesh.vertices().len()),
    );
    line(&mut text, format_args!("property double x\nproperty double y\nproperty double z\nend_header"));
    line(&mut text, format_args!("{}", 4 * mesh.triangles().len()));
    mesh.triangles().iter().for_each(|[a, b, c]| line(&mut text, format_args!("{a} {b} {c} -1")));
    mesh.vertices().iter().for_each(|[x, y, z]| line(&mut text, format_args!("{x:e} {y:e} {z:e}")));
    text
}
