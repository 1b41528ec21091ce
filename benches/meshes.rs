//! Speed of the readers of meshes, on one thread.
//!
//! ```text
//! cargo bench --bench meshes
//! ```
//!
//! A torus of half a million triangles and a quarter of a million vertices, in files of every format that
//! the fuzz targets can write. Coordinates have six places, as most programs write them. `weld` is the last
//! step of every reader alone. `benches/README.md` has figures measured with this file, and explains what
//! limits them.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use leafless::{TriangleMesh, exchange};
use leafless_testkit::fuzz::meshes;
use std::hint::black_box;

/// A torus of 2 n² triangles; coordinates have six places if they are `short`.
fn torus(n: u32, short: bool) -> TriangleMesh {
    let turn = |i: u32| std::f64::consts::TAU * i as f64 / n as f64;
    let vertices = (0..n * n).map(|i| {
        let ((s, c), (t, d)) = (turn(i / n).sin_cos(), turn(i % n).sin_cos());
        let vertex = [(2.0 + 0.7 * d) * c, (2.0 + 0.7 * d) * s, 0.7 * t];
        if short { vertex.map(|x| (x * 1e6).round() / 1e6) } else { vertex }
    });
    let at = |i: u32, j: u32| i % n * n + j % n;
    let triangles = (0..n * n).flat_map(|i| {
        let (i, j) = (i / n, i % n);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(vertices.collect(), triangles.collect()).expect("a closed mesh")
}

fn read(c: &mut Criterion) {
    let mut group = c.benchmark_group("read a mesh");
    group.sample_size(20);
    let (short, long) = (torus(500, true), torus(500, false));
    let [(obj, _), _, (off, _), _, (ascii, _), (little, _), (big, _), _] = meshes::WRITERS;
    let stl: meshes::Writer = |mesh| exchange::write_stl(mesh).expect("a good mesh");
    let files: [(&str, Vec<u8>, meshes::Reader); 9] = [
        ("OBJ, 6 places", plain_obj(&short), exchange::read_obj),
        ("OBJ, 17 digits", plain_obj(&long), exchange::read_obj),
        ("OBJ, other dialect", obj(&short), exchange::read_obj),
        ("OFF", off(&short), exchange::read_off),
        ("PLY ascii", ascii(&short), exchange::read_ply),
        ("PLY little-endian", little(&short), exchange::read_ply),
        ("PLY big-endian", big(&short), exchange::read_ply),
        ("OBJ of quadrilaterals", quadrilaterals(&short), exchange::read_obj),
        ("STL", stl(&short), exchange::read_stl),
    ];
    for (name, bytes, read) in files {
        group.throughput(Throughput::Bytes(bytes.len() as u64));
        group.bench_function(name, |b| {
            b.iter_with_large_drop(|| read(black_box(&bytes)).expect("a good file"))
        });
    }
    group.throughput(Throughput::Elements(short.vertices().len() as u64));
    let arrays = || (short.vertices().to_vec(), short.triangles().to_vec());
    group.bench_function("weld", |b| {
        b.iter_batched(arrays, |(v, t)| TriangleMesh::new(v, t).expect("a good mesh"), BatchSize::LargeInput)
    });
    group.finish();
}

/// Writes an OBJ as most programs do.
fn plain_obj(mesh: &TriangleMesh) -> Vec<u8> {
    let vertices = mesh.vertices().iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = mesh.triangles().iter().map(|t| t.map(|v| v + 1)).map(|[a, b, c]| format!("f {a} {b} {c}\n"));
    vertices.chain(faces).collect::<String>().into_bytes()
}

/// Writes pairs of triangles as one face.
fn quadrilaterals(mesh: &TriangleMesh) -> Vec<u8> {
    let vertices = mesh.vertices().iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = mesh.triangles().chunks_exact(2).map(|pair| {
        let [[a, b, c], [_, _, d]] = [pair[0], pair[1]].map(|t| t.map(|v| v + 1));
        format!("f {a} {b} {c} {d}\n")
    });
    vertices.chain(faces).collect::<String>().into_bytes()
}

criterion_group!(benches, read);
criterion_main!(benches);
