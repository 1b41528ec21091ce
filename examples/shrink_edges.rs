//! Draws the triangles of one solid by simple marching cubes, by the published form of coplanar shrink and by
//! the form without cracks, side by side as an SVG picture. Edges without a counterpart, at which a mesh is
//! open, are red.
//!
//! ```text
//! cargo run --release --example shrink_edges > pictures/shrink.svg
//! ```

use leafless::surface::{Snap, coplanar_shrink, published_shrink, simple_marching_cubes};
use leafless::{Control, Csg, Error, Frame, Rule, TriangleMesh, build};
use std::collections::HashMap;

/// Pixels of a picture on either side.
const SIZE: f64 = 380.0;

/// From where the solid is looked at: the directions that are drawn to the right and upwards.
const VIEW: [[f64; 3]; 2] = [[-0.6, 0.8, 0.0], [-0.32, -0.24, 0.9165]];

fn main() -> Result<(), Error> {
    let control = Control::default();
    // A block with a corner and an edge cut off. It is convex, so that no triangle hides another one that
    // faces the eye.
    let frame = Frame::new([0.0; 3], 32.0, 5)?;
    let block = Csg::cuboid([3.0, 3.0, 3.0], [21.0, 19.0, 17.0])?;
    let cut = Csg::half_space([-1.0; 3], 49.0)?;
    let edge = Csg::half_space([-1.0, 1.0, 0.0], 13.0)?;
    let part = Csg::intersection_of([block, cut, edge])?;
    let tree = build(&part, &frame, Rule::Sampled, &control)?;
    let meshes = [
        ("simple marching cubes", simple_marching_cubes(tree.view(), Snap::Fat, None, &control)?),
        ("shrunk as published", published_shrink(tree.view(), Snap::Fat, None, &control)?),
        ("shrunk without cracks", coplanar_shrink(tree.view(), Snap::Fat, None, &control)?),
    ];
    let width = SIZE * meshes.len() as f64;
    println!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {}" font-family="sans-serif">"#,
        SIZE + 30.0
    );
    println!(r#"<rect width="100%" height="100%" fill="white"/>"#);
    for (place, (name, mesh)) in meshes.iter().enumerate() {
        draw(name, mesh, SIZE * place as f64);
    }
    println!("</svg>");
    Ok(())
}

fn draw(name: &str, mesh: &TriangleMesh, left: f64) {
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // To the right and up, in pixels from the middle of the solid.
    let seen = |v: u32| {
        let [x, y, z] = mesh.vertices()[v as usize];
        let p = [x - 12.0, y - 11.0, z - 10.0];
        VIEW.map(|direction| dot(direction, p) * SIZE / 28.0)
    };
    let place = |[x, y]: [f64; 2]| format!("{:.1},{:.1}", left + SIZE / 2.0 + x, SIZE / 2.0 - y);
    let mut sums: HashMap<(u32, u32), i32> = HashMap::new();
    for &[a, b, c] in mesh.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *sums.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    println!(r##"<g stroke="#223" stroke-width="0.5" stroke-linejoin="round">"##);
    for t in mesh.triangles() {
        let [p, q, r] = t.map(seen);
        let faces_away = (q[0] - p[0]) * (r[1] - p[1]) <= (q[1] - p[1]) * (r[0] - p[0]);
        if faces_away {
            continue;
        }
        let corners = [p, q, r];
        let normal = normal(t.map(|v| mesh.vertices()[v as usize]));
        let light = (0.55 + 0.4 * dot(normal, [0.3, 0.1, 0.95])).clamp(0.2, 1.0);
        let shade = (255.0 * light) as u8;
        println!(
            r##"<path d="M{}L{}L{}Z" fill="#{:02x}{shade:02x}ff"/>"##,
            place(corners[0]),
            place(corners[1]),
            place(corners[2]),
            shade.saturating_sub(20),
        );
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if sums[&(a.min(b), a.max(b))] != 0 {
                let (from, to) = (place(corners[k]), place(corners[(k + 1) % 3]));
                println!(
                    r##"<polyline points="{from} {to}" stroke="#d00" stroke-width="1.4" fill="none"/>"##
                );
            }
        }
    }
    println!("</g>");
    println!(
        r#"<text x="{}" y="{}" text-anchor="middle" font-size="15">{name}: {} triangles</text>"#,
        left + SIZE / 2.0,
        SIZE + 15.0,
        mesh.triangles().len()
    );
}

fn normal([p, q, r]: [[f64; 3]; 3]) -> [f64; 3] {
    let [u, v] = [q, r].map(|end| [0, 1, 2].map(|k| end[k] - p[k]));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    n.map(|x| x / length)
}
