//! Any bytes as a 3MF package, and as the parts of a package. The reader does not panic, and builds no more
//! than it reports.

use crate::zip::{self, CONTENT_TYPES, Entry, RELATIONSHIPS, model, tetrahedron};
use leafless::exchange::{MeshFormat, MeshOptions, read_mesh};

/// Reads `data` as a package. Also reads its pieces, separated by zero bytes, as a model part, another part
/// that the first may refer to as `/b.model`, relationships and content types.
pub fn packages(data: &[u8]) {
    read(data);
    let mut pieces = data.split(|&b| b == 0);
    let mut piece = |good: &str| pieces.next().map_or(good.as_bytes().to_vec(), <[u8]>::to_vec);
    let (root, other) = (piece(""), piece(""));
    let (relationships, types) = (piece(RELATIONSHIPS), piece(CONTENT_TYPES));
    read(&zip::zip(&[
        Entry::stored("[Content_Types].xml", types),
        Entry::stored("_rels/.rels", relationships),
        Entry::stored("3D/3dmodel.model", root),
        Entry::stored("b.model", other),
    ]));
}

fn read(bytes: &[u8]) {
    let options = MeshOptions { format: Some(MeshFormat::ThreeMf), ..MeshOptions::default() };
    if let Ok(file) = read_mesh(bytes, &options) {
        let (vertices, triangles) = (file.mesh.vertices(), file.mesh.triangles());
        assert!(vertices.len() <= 1 << 25 && triangles.len() <= 1 << 25);
        assert!(triangles.iter().flatten().all(|&v| (v as usize) < vertices.len()));
        assert!(file.unit.is_some());
    }
}

/// Small inputs that contain all elements.
pub fn seeds() -> Vec<Vec<u8>> {
    let components = "<object id=\"2\"><components><component objectid=\"1\"/><component objectid=\"1\" \
        p:path=\"/b.model\" transform=\"1 0 0 0 1 0 0 0 -1 0 0 3\"/></components></object>";
    let items = "<item objectid=\"2\"/><item objectid=\"1\" transform=\"0 1 0 1 0 0 0 0 1 5 6 7\"/>";
    let root = model("unit=\"inch\" requiredextensions=\"p\"", &(tetrahedron(1, "") + components), items);
    let other = model("unit=\"meter\"", &tetrahedron(1, "type=\"model\""), "");
    let all = [&*root, &other, RELATIONSHIPS, CONTENT_TYPES].join("\0").into_bytes();
    let small = "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>\
        <object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/></vertices><triangles>\
        <triangle v1=\"0\" v2=\"0\" v3=\"0\"/></triangles></mesh></object><object id=\"2\"><components>\
        <component objectid=\"1\"/></components></object></resources><build><item objectid=\"2\"/></build></model>";
    let package = zip::package(small);
    let stored: Vec<Entry> = [("[Content_Types].xml", CONTENT_TYPES), ("_rels/.rels", RELATIONSHIPS)]
        .map(|(name, text)| Entry::stored(name, text))
        .into_iter()
        .chain([Entry::stored("3D/3dmodel.model", small)])
        .collect();
    vec![all, root.into_bytes(), small.into(), zip::zip(&package), zip::zip(&stored)]
}
