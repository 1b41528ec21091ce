//! The parts of a paper as tri-dexel models: honeycomb core, square tube, round tube, a complex part, the
//! difference of two spheres, and a layered composite plate with one material for each ply.
//!
//! After Gao, Zhang and Hou (2007). Each part is made by set operations of tri-dexel models, meshed by dual
//! contouring, and compared with its volume by formula. Run it with
//! `cargo run --release --example dexel_parts [folder]`; with a folder it writes the meshes there, as PLY.

use leafless::dexel::{DexelFormat, DexelNormals};
use leafless::exchange::{MeshFormat, WriteOptions, write_mesh};
use leafless::op::DexelOptions;
use leafless::surface::dual_contouring_dexels;
use leafless::{Affine, Control, Csg, Error, Frame, TriDexel, TriangleMesh, dexelize};
use std::f64::consts::PI;

/// A part, and what is known of it.
pub struct Part {
    /// What it is called in the table.
    pub name: &'static str,
    /// The part.
    pub model: TriDexel,
    /// Its volume by formula, and for each material from 1 on.
    pub volume: f64,
    /// The volumes of its materials, from 1 on; of a part without materials none.
    pub materials: Vec<f64>,
}

impl Part {
    /// Its surface by dual contouring, which keeps edges and corners.
    pub fn surface(&self, control: &Control<'_>) -> Result<TriangleMesh, Error> {
        Ok(dual_contouring_dexels(self.model.view(), control)?.0)
    }

    /// The volume of a material, by the rays along an axis.
    pub fn volume_of(&self, material: u32, axis: usize) -> f64 {
        let frame = self.model.frame();
        let Some(rays) = self.model.view().rays(axis) else { return 0.0 };
        let [us, vs] = rays.window();
        let mut length = 0.0;
        for v in vs {
            for u in us.clone() {
                let own = rays.dexels([u, v]).filter(|dexel| dexel.material == material);
                length += own.map(|dexel| dexel.end.at - dexel.start.at).sum::<f64>();
            }
        }
        length * frame.cell_size().powi(2)
    }
}

/// Makes tri-dexel models on one lattice.
struct Shop<'a> {
    frame: Frame,
    options: DexelOptions,
    control: &'a Control<'a>,
}

impl Shop<'_> {
    fn dexels(&self, solid: &Csg) -> Result<TriDexel, Error> {
        dexelize(solid, &self.frame, &self.options, self.control)
    }

    fn less(&self, part: &TriDexel, solid: &Csg) -> Result<TriDexel, Error> {
        part.view().difference(self.dexels(solid)?.view(), self.control)
    }

    fn with(&self, part: &TriDexel, solid: &Csg) -> Result<TriDexel, Error> {
        part.view().union(self.dexels(solid)?.view(), self.control)
    }
}

fn cylinder(at: [f64; 2], radius: f64, low: f64, high: f64) -> Result<Csg, Error> {
    Csg::cylinder(radius, low, high)?.placed(&Affine::translation([at[0], at[1], 0.0])?)
}

/// The six parts in the cube [−1, 1]³, with 2^depth rays to an axis.
pub fn parts(depth: u8, control: &Control<'_>) -> Result<Vec<Part>, Error> {
    let format = DexelFormat { normals: DexelNormals::Bits32, ..DexelFormat::default() };
    let shop = Shop {
        frame: Frame::new([-1.0; 3], 2.0, depth)?,
        options: DexelOptions { format, ..DexelOptions::default() },
        control,
    };
    let part = |name, model, volume| Part { name, model, volume, materials: Vec::new() };
    let mut parts = Vec::new();

    // Hexagons with walls of 0.05 between their faces.
    let (inner, wall) = (0.14, 0.05);
    let side = 2.0 * inner / 3f64.sqrt();
    let pitch = 2.0 * inner + wall;
    let mut core = shop.dexels(&Csg::cuboid([-0.9, -0.9, -0.31], [0.9, 0.9, 0.29])?)?;
    let mut holes = 0.0;
    for row in -2i32..=2 {
        for column in -2i32..=2 {
            let x = pitch * (f64::from(column) + if row % 2 == 0 { 0.0 } else { 0.5 });
            let y = pitch * 0.75f64.sqrt() * f64::from(row);
            if x.abs() + side < 0.9 {
                let corner = |k: i32| {
                    let angle = PI / 3.0 * (f64::from(k) + 0.5);
                    [x + side * angle.cos(), y + side * angle.sin()]
                };
                let hexagon: Vec<[f64; 2]> = (0..6).map(corner).collect();
                core = shop.less(&core, &Csg::prism(&hexagon, -0.5, 0.5)?)?;
                holes += 1.0;
            }
        }
    }
    let hexagon = 1.5 * 3f64.sqrt() * side * side;
    parts.push(part("honeycomb core", core, (1.8 * 1.8 - holes * hexagon) * 0.6));

    let tube = shop.dexels(&Csg::cuboid([-0.51, -0.47, -0.83], [0.53, 0.49, 0.81])?)?;
    let tube = shop.less(&tube, &Csg::cuboid([-0.41, -0.37, -1.0], [0.43, 0.39, 1.0])?)?;
    parts.push(part("square tube", tube, (1.04 * 0.96 - 0.84 * 0.76) * 1.64));

    let tube = shop.dexels(&cylinder([0.01, 0.02], 0.6, -0.83, 0.81)?)?;
    let tube = shop.less(&tube, &cylinder([0.01, 0.02], 0.45, -1.0, 1.0)?)?;
    parts.push(part("round tube", tube, PI * (0.6 * 0.6 - 0.45 * 0.45) * 1.64));

    // A flange with a boss, a bore, and six holes for bolts.
    let mut flange = shop.dexels(&cylinder([0.0, 0.0], 0.85, -0.41, -0.13)?)?;
    flange = shop.with(&flange, &cylinder([0.0, 0.0], 0.4, -0.2, 0.57)?)?;
    flange = shop.less(&flange, &cylinder([0.0, 0.0], 0.25, -1.0, 1.0)?)?;
    for k in 0..6 {
        let angle = PI / 3.0 * f64::from(k) + 0.2;
        let bolt = cylinder([0.63 * angle.cos(), 0.63 * angle.sin()], 0.09, -1.0, 1.0)?;
        flange = shop.less(&flange, &bolt)?;
    }
    let plate = PI * (0.85 * 0.85 - 0.25 * 0.25 - 6.0 * 0.09 * 0.09) * 0.28;
    parts.push(part("complex part", flange, plate + PI * (0.4 * 0.4 - 0.25 * 0.25) * 0.7));

    // A ball less another one of the same size, whose centre lies on its surface.
    let (radius, apart) = (0.6, 0.6);
    let balls = shop.dexels(&Csg::ball([-0.1, 0.02, 0.03], radius)?)?;
    let balls = shop.less(&balls, &Csg::ball([-0.1 + apart, 0.02, 0.03], radius)?)?;
    let lens = PI * (4.0 * radius + apart) * (2.0 * radius - apart).powi(2) / 12.0;
    parts.push(part("difference of spheres", balls, 4.0 / 3.0 * PI * radius.powi(3) - lens));

    // Five plies of different thickness, each of its own material, with a hole drilled through all of them.
    let ends = [-0.31, -0.23, -0.02, 0.07, 0.19, 0.33];
    let drill = cylinder([0.2, 0.1], 0.22, -1.0, 1.0)?;
    let mut plies = Vec::new();
    for (material, ply) in (1..).zip(ends.windows(2)) {
        let ply = shop.dexels(&Csg::cuboid([-0.81, -0.61, ply[0]], [0.79, 0.63, ply[1]])?)?;
        plies.push(ply.view().with_material(material, control)?);
    }
    let views: Vec<_> = plies.iter().map(|ply| *ply.view()).collect();
    let plate = shop.less(&TriDexel::union_of(&views, control)?, &drill)?;
    let face = 1.6 * 1.24 - PI * 0.22 * 0.22;
    let materials = ends.windows(2).map(|ply| face * (ply[1] - ply[0])).collect();
    parts.push(Part { name: "layered composite", model: plate, volume: face * 0.64, materials });
    Ok(parts)
}

#[allow(dead_code)]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let control = Control::default();
    let folder = std::env::args_os().nth(1);
    println!("{:<22} {:>9} {:>9} {:>10} {:>10}  off", "part", "intervals", "triangles", "volume", "formula");
    for part in parts(8, &control)? {
        let mesh = part.surface(&control)?;
        let off = mesh.volume() / part.volume - 1.0;
        let intervals = part.model.view().interval_count();
        println!(
            "{:<22} {intervals:>9} {:>9} {:>10.6} {:>10.6}  {off:+.1e}",
            part.name,
            mesh.triangles().len(),
            mesh.volume(),
            part.volume
        );
        for (material, volume) in (1..).zip(&part.materials) {
            println!(
                "    material {material}: {:.6} by rays along z, {volume:.6}",
                part.volume_of(material, 2)
            );
        }
        if let Some(folder) = &folder {
            let path = std::path::Path::new(folder).join(part.name.replace(' ', "_")).with_extension("ply");
            std::fs::write(path, write_mesh(&mesh, MeshFormat::Ply, &WriteOptions::default())?)?;
        }
    }
    Ok(())
}
