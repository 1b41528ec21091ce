//! Pictures of layouts: the copies of each item in one colour, obstacles in grey, and the edges of a box
//! around the container.

use leafless::layout::{Layout, Placed};
use leafless::render::{Camera, LinesLayer, MeshEdges, MeshLayer, Shot, render, write_png};
use leafless::{Affine, Bounds, Control, Error, TriangleMesh};

/// Width and height in pixels.
const SIZE: [u32; 2] = [1024, 768];
/// Azimuth and elevation in degrees.
const FROM: [f64; 2] = [30.0, 25.0];
const FIELD_OF_VIEW: f64 = 30.0;
/// Most triangles of all copies together; they take about ten gigabytes.
const MOST: usize = 50_000_000;

/// Colours that nearly everybody can distinguish (Okabe & Ito 2008), one for each item; the eighth item has
/// the first colour again.
const COLOURS: [[u8; 4]; 7] = [
    [86, 180, 233, 255],
    [230, 159, 0, 255],
    [0, 158, 115, 255],
    [204, 121, 167, 255],
    [240, 228, 66, 255],
    [0, 114, 178, 255],
    [213, 94, 0, 255],
];
const OBSTACLE: [u8; 4] = [178, 187, 196, 255];
const EDGES: [u8; 4] = [40, 40, 40, 120];
const BOX: [u8; 4] = [120, 120, 120, 255];

/// Returns a PNG of a layout from the surfaces of its items and obstacles.
pub fn picture(
    layout: &Layout,
    items: &[TriangleMesh],
    obstacles: &[TriangleMesh],
    control: &Control<'_>,
) -> Result<Vec<u8>, Error> {
    let (mesh, colours) = all(layout.placed(), items, obstacles)?;
    let bounds = layout.bounds();
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let camera = Camera::fitted(&bounds.corners(), FROM, Some(FIELD_OF_VIEW), aspect)?;
    let edges = edges(bounds);
    let solids = MeshLayer::new(&mesh).triangle_colours(&colours).edges(MeshEdges::Features, 1.0, EDGES);
    let lines = LinesLayer::new(&edges).width(1.5).colour(BOX);
    write_png(&render(&Shot::new(camera, SIZE), &[&solids, &lines], control)?)
}

/// Returns the triangles of all copies and obstacles, with their colours.
fn all(
    placed: &[Placed],
    items: &[TriangleMesh],
    obstacles: &[TriangleMesh],
) -> Result<(TriangleMesh, Vec<[u8; 4]>), Error> {
    let copies = placed
        .iter()
        .map(|Placed { item, placement }| (&items[*item], *placement, COLOURS[*item % COLOURS.len()]));
    let fixed = obstacles.iter().map(|surface| (surface, Affine::IDENTITY, OBSTACLE));
    let shown = || copies.clone().chain(fixed.clone());
    if shown().map(|(surface, ..)| surface.triangles().len()).sum::<usize>() > MOST {
        let problem = "would show more than 50 million triangles";
        return Err(Error::Argument { name: "the picture", problem });
    }
    let (mut vertices, mut triangles, mut colours) = (vec![], vec![], vec![]);
    for (surface, placement, colour) in shown() {
        let first = vertices.len() as u32;
        vertices.extend(surface.vertices().iter().map(|&vertex| placement.apply(vertex)));
        triangles.extend(surface.triangles().iter().map(|own| own.map(|vertex| first + vertex)));
        colours.resize(triangles.len(), colour);
    }
    Ok((TriangleMesh::new(vertices, triangles)?, colours))
}

/// Returns the edges of a box.
fn edges(bounds: &Bounds) -> Vec<[[f64; 3]; 2]> {
    let corners = bounds.corners();
    let mut edges = vec![];
    for (k, a) in corners.iter().enumerate() {
        let differ = |b: &[f64; 3]| (0..3).filter(|&axis| a[axis] != b[axis]).count();
        edges.extend(corners[k + 1..].iter().filter(|b| differ(b) == 1).map(|b| [*a, *b]));
    }
    edges
}
