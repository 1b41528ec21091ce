//! The subcommand `leafless heights`, from outside.

use crate::place::{Run, solids};

fn rows(run: &Run) -> Vec<Vec<f64>> {
    run.text().lines().map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect()
}

/// The slab is [2, 6] × [2, 6] × [0, 2] in [0, 8]³, with 32 cells along an axis: four to a unit.
#[test]
fn every_axis_and_side() {
    let place = solids();
    for (axis, from, [first, second], height) in [
        ("z", "above", [2.0..6.0, 2.0..6.0], 2.0),
        ("z", "below", [2.0..6.0, 2.0..6.0], 0.0),
        ("x", "above", [2.0..6.0, 0.0..2.0], 6.0),
        ("y", "below", [2.0..6.0, 0.0..2.0], 2.0),
    ] {
        for on in ["full", "upper"] {
            let line = format!("heights slab.lfl --axis {axis} --from {from} --on {on}");
            let found = rows(&place.run(&line).good());
            assert_eq!(found.len(), 32);
            for (v, row) in found.iter().enumerate() {
                assert_eq!(row.len(), 32);
                for (u, &found) in row.iter().enumerate() {
                    let [x, y] = [u, v].map(|i| (i as f64 + 0.5) / 4.0);
                    let inside = first.contains(&x) && second.contains(&y);
                    assert!(if inside { found == height } else { found.is_nan() }, "{line} {u} {v} {found}");
                }
            }
        }
    }
}

#[test]
fn files_and_doubles() {
    let place = solids();
    let text = place.run("heights slab.lfl --axis x").good();
    assert_eq!(place.run("heights slab.lfl --axis x -o map.csv").good().text(), "");
    assert_eq!(place.bytes("map.csv"), text.bytes);
    place.run("heights slab.lfl --axis x --raw -o map.f64").good();
    let wanted: Vec<u64> = rows(&text).concat().iter().map(|x| x.to_bits()).collect();
    let bytes = place.bytes("map.f64");
    let (doubles, rest) = bytes.as_chunks::<8>();
    let doubles: Vec<u64> = doubles.iter().map(|x| f64::from_le_bytes(*x).to_bits()).collect();
    assert!(doubles == wanted && rest.is_empty());
    assert_eq!(place.run("heights slab.lfl --axis x --raw").good().bytes, place.bytes("map.f64"));
    place.run("heights slab.lfl --axis x -o none/map.csv").bad(1, &["none"]);
    place.run("heights none.lfl --axis x").bad(1, &["none.lfl"]);
}

/// For a ball, the proven and the possible height enclose the true height. A solid's file is also queried on
/// coarser cells.
#[test]
fn meshes_and_scenes() {
    let place = solids();
    place.write("ball.csg", "sphere(r = 2, $fn = 0);");
    let [full, upper] = ["full", "upper"].map(|on| {
        let line = format!("heights ball.csg --axis y --depth 6 --bounds -3,-3,-3,6 --on {on}");
        rows(&place.run(&line).good()).concat()
    });
    let (mut met, mut open) = (0, 0);
    for (index, (full, upper)) in full.iter().zip(&upper).enumerate() {
        let [x, z] = [index % 64, index / 64].map(|i| (i as f64 + 0.5) * 6.0 / 64.0 - 3.0);
        let square = 4.0 - x * x - z * z;
        if square > 0.0 {
            assert!(
                square.sqrt() <= *upper && (full.is_nan() || *full <= square.sqrt()),
                "{x} {z} {full} {upper}"
            );
            met += 1;
        }
        open += (full.is_nan() && !upper.is_nan()) as usize;
    }
    assert!(met > 1000 && (10..400).contains(&open), "{met} {open}");
    assert_eq!(rows(&place.run("heights cube.stl --axis z --depth 4").good()).len(), 16);
    assert_eq!(rows(&place.run("heights cube.lfl --axis z --depth 3").good())[2][2], 3.0);
    // Samples prove nothing, but their cells may be taken for the solid.
    place.run("voxelize cube.stl -o sampled.lfl --depth 5 --bounds 0,0,0,8 --rule sampled").good();
    let open = rows(&place.run("heights sampled.lfl --axis z --on full").good());
    assert!(open.concat().iter().all(|x| x.is_nan()));
    let taken = place.run("heights sampled.lfl --axis z --on full --cells").good();
    assert_eq!(taken.text(), place.run("heights cube.lfl --axis z").good().text());
}
