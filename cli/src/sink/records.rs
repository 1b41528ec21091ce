//! Voxel records as arrays for NumPy, written and read back.

use crate::sink::npz::{Arrays, Reader};
use leafless::solid::Fingerprinter;
use leafless::voxel::{VoxelRecords, VoxelRecordsRef, VoxelTriangles};
use leafless::{Frame, Proof, Tag};

/// Returns the file of records.
///
/// The tag's number and the two bits of the proof are those of the C interface.
pub fn npz(view: &VoxelRecordsRef<'_>, triangles: Option<&VoxelTriangles>) -> Vec<u8> {
    let (n, frame) = (view.len() as u64, view.frame());
    let mut arrays = Arrays::default();
    arrays.add("codes", &[n], view.codes());
    arrays.add("levels", &[n], view.levels());
    arrays.add("kinds", &[n], view.kinds());
    let corners: Vec<f64> = (0..view.len()).flat_map(|i| view.corner(i).unwrap_or_default()).collect();
    arrays.add("corners", &[n, 3], &corners);
    arrays.add("origin", &[3], &frame.origin());
    arrays.add("edge", &[], &[frame.edge()]);
    arrays.add("depth", &[], &[frame.depth()]);
    arrays.add("exterior", &[], &[view.exterior() as u8]);
    arrays.add("boundary", &[], &[view.boundary() as u8]);
    arrays.add("proof", &[3], &proof_numbers(view));
    let seal = seal(view);
    arrays.add("seal", &[seal.len() as u64], &seal);
    if view.components() > 0 {
        arrays.add("values", &[n, view.components() as u64], view.values());
    }
    if let Some(found) = triangles {
        arrays.add("triangle_offsets", &[n + 1], found.offsets());
        arrays.add("triangles", &[found.triangles().len() as u64], found.triangles());
    }
    arrays.finish()
}

fn proof_numbers(view: &VoxelRecordsRef<'_>) -> [f64; 3] {
    let proof = view.proof();
    [f64::from(u8::from(proof.full)), f64::from(u8::from(proof.empty)), proof.displacement()]
}

/// Returns a fingerprint of the records, without their values, and of their descriptions. Arrays are easily
/// changed, and a proof for other records does not hold for these. (The fingerprint guards against mistakes.
/// It does not guard against intent, as anybody can also write a solid that claims to be proven.)
fn seal(view: &VoxelRecordsRef<'_>) -> Vec<u8> {
    let frame = view.frame();
    let all = Fingerprinter::new("voxel records")
        .numbers(&frame.origin())
        .numbers(&[frame.edge()])
        .integers(&[frame.depth().into(), view.exterior() as u64, view.boundary() as u64])
        .numbers(&proof_numbers(view))
        .integers(view.codes())
        .bytes(view.levels())
        .bytes(view.kinds());
    all.finish().to_string().into_bytes()
}

/// Reads the file that [`npz`] writes. Nothing is proven unless the seal shows that the records are
/// unchanged. Missing descriptions are unknown.
pub fn records(bytes: &[u8]) -> Result<VoxelRecords, String> {
    let arrays = Reader::new(bytes).map_err(|error| format!("is no NPZ: {error}"))?;
    let text = |error: std::io::Error| error.to_string();
    let one = |list: Vec<f64>| list.first().copied().ok_or("an array is empty".to_string());
    let origin = arrays.array::<f64>("origin").map_err(text)?.1;
    let origin = <[f64; 3]>::try_from(origin).map_err(|_| "origin: must be three numbers")?;
    let edge = one(arrays.array("edge").map_err(text)?.1)?;
    let depth = arrays.array::<u8>("depth").map_err(text)?.1;
    let depth = depth.first().copied().ok_or("depth: is empty")?;
    let frame = Frame::new(origin, edge, depth).map_err(|error| error.to_string())?;
    let codes = arrays.array("codes").map_err(text)?.1;
    let levels = arrays.array("levels").map_err(text)?.1;
    let kinds = arrays.array("kinds").map_err(text)?.1;
    let (components, values) = match arrays.has("values") {
        false => (0, vec![]),
        true => {
            let (shape, values) = arrays.array::<f64>("values").map_err(text)?;
            let components = shape.get(1).copied().unwrap_or(1);
            (usize::try_from(components).map_err(|_| "values: has too many columns")?, values)
        }
    };
    let records = VoxelRecords::from_arrays(&frame, codes, levels, kinds, components, values)
        .map_err(|error| error.to_string())?;
    let tag = |arrays: &Reader<'_>, name: &str| match arrays.has(name) {
        true => Ok(arrays.array::<u8>(name).map_err(text)?.1.first().copied().map(Tag::from_code)),
        false => Ok::<_, String>(None),
    };
    let exterior = tag(&arrays, "exterior")?.unwrap_or(Tag::Partial);
    let boundary = tag(&arrays, "boundary")?.unwrap_or(Tag::Partial);
    let mut proof = Proof::new(false, false);
    if arrays.has("proof") {
        let numbers = arrays.array::<f64>("proof").map_err(text)?.1;
        let [full, empty, displacement] =
            <[f64; 3]>::try_from(numbers).map_err(|_| "proof: must be three numbers")?;
        let told = Proof::new(full == 1.0, empty == 1.0).with_displacement(displacement);
        proof = told.map_err(|error| error.to_string())?;
    }
    let told = records.with_exterior(exterior, proof).with_boundary(boundary);
    let is_sealed = arrays.has("seal") && arrays.array::<u8>("seal").map_err(text)?.1 == seal(&told.view());
    (proof.full, proof.empty) = (proof.full && is_sealed, proof.empty && is_sealed);
    Ok(told.with_exterior(exterior, proof))
}
