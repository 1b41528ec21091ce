//! Any bytes through every way in to tri-dexel models. No way panics, and all agree.

use super::CONTROL;
use super::ways_in::scratch_file;
use crate::Aligned;
use leafless::dexel::{DexelEditor, DexelFormat, TriDexelRef};
use leafless::op::octree_from_dexels;
use leafless::surface::{dual_contouring_dexels, marching_cubes_dexels};
use leafless::voxel::dexel_voxels;
use leafless::{Error, TriDexel, file, file::dexels};

/// Returns the outcome of an attempt as a comparable text.
fn outcome<T>(result: &Result<T, Error>) -> Result<(), String> {
    result.as_ref().map(|_| ()).map_err(|error| error.cause().to_string())
}

/// Reads `data` in every way, including the ways that need a file if `as_a_file`. Returns whether it is
/// verified as a good tri-dexel model.
pub fn dexels_in_all_ways(data: &[u8], as_a_file: bool) -> bool {
    let aligned = Aligned::new(data);
    // SAFETY: the model and all that is read from it are gone before the bytes are.
    #[allow(unsafe_code)]
    let bytes: &'static [u8] = unsafe { std::slice::from_raw_parts(aligned.bytes().as_ptr(), data.len()) };
    let viewed = dexels::view(bytes);
    let copied = dexels::from_bytes(bytes);
    let still = dexels::from_static(bytes);
    let verified = outcome(&copied);
    // Each way in requires what the previous one requires, and more. (Invalid text is found behind checksums,
    // too.)
    assert!(
        viewed.is_ok()
            || still.is_err() && outcome(&still) == outcome(&viewed) && verified == outcome(&viewed)
    );
    assert!(still.is_ok() || copied.is_err());
    if let Ok(view) = &viewed {
        assert_eq!(outcome(&file::verify(bytes)), verified);
        let said =
            file::probe_bytes(bytes).expect("what can be viewed can be probed").dexels.expect("a model");
        assert_eq!((said.format, said.directions), (view.format(), view.directions()));
        assert_eq!(said.intervals.iter().sum::<u64>(), view.interval_count());
        asked(view, copied.is_ok());
    }
    if let Ok(model) = &still {
        changed(model);
    }
    if let (Ok(copied), Ok(still)) = (&copied, &still) {
        copied.view().check().expect("it was verified");
        assert_eq!(copied.metadata(), still.metadata());
        let written = dexels::to_bytes(copied).expect("a verified model can be written");
        assert_eq!(dexels::to_bytes(still).expect("the same model"), written);
        let back = dexels::from_bytes(&written).expect("what was written can be read");
        assert!(&back == copied && dexels::to_bytes(&back).expect("again") == written);
    }
    if as_a_file {
        let path = scratch_file();
        std::fs::write(&path, data).expect("a place for a file");
        assert_eq!(outcome(&dexels::open(&path)), verified);
        // SAFETY: no other process uses the file, and it is removed only when the models are gone.
        #[allow(unsafe_code)]
        let (mapped, scanned) = unsafe { (dexels::map(&path), dexels::map_verified(&path)) };
        assert_eq!((outcome(&mapped), outcome(&scanned)), (outcome(&still), verified.clone()));
        drop((mapped, scanned));
        std::fs::remove_file(&path).expect("the file that was written");
    }
    verified.is_ok()
}

/// Queries single rays and cells of arrays with any content.
fn asked(view: &TriDexelRef<'_>, sound: bool) {
    let most = view.frame().cells() - 1;
    for rays in (0..3).filter_map(|axis| view.rays(axis)) {
        let [us, vs] = rays.window();
        for ray in
            [[us.start, vs.start], [us.end.saturating_sub(1), vs.start], [most, vs.end / 2], [u32::MAX; 2]]
        {
            let mut last = f64::NEG_INFINITY;
            let mut count = 0;
            for dexel in rays.dexels(ray) {
                assert!(!sound || dexel.start.at >= last && dexel.end.at >= dexel.start.at);
                (last, count) = (dexel.end.at, count + 1);
            }
            assert!(count <= rays.interval_count());
        }
        let statistics = view.statistics(rays.axis()).expect("a direction");
        assert!(statistics.rays <= rays.interval_count());
    }
    for cell in [[0; 3], [most; 3], [most / 2, most / 3, 0], [u32::MAX; 3]] {
        view.contains_cell(cell);
    }
    assert!(view.check().is_ok() || !sound);
}

/// Runs operations on all rays. They end, with a sound model or with the damage.
fn changed(model: &TriDexel) {
    let view = model.view();
    let sound = view.check().is_ok();
    assert_eq!(dexels::to_bytes(model).is_ok(), sound);
    // A complement has all rays.
    let small = view.frame().depth() <= 6;
    let edited = || {
        let mut editor = DexelEditor::new(view)?;
        editor.subtract(view, &CONTROL)?;
        editor.unite(view, &CONTROL)?;
        editor.freeze(&CONTROL)
    };
    let mut results = vec![
        view.union(view, &CONTROL),
        view.xor(view, &CONTROL),
        view.with_material(3, &CONTROL),
        view.to_format(DexelFormat::default(), &CONTROL),
    ];
    if small {
        results.extend([view.complement(&CONTROL), edited()]);
    }
    if small {
        // Other operations on all rays.
        let others = [
            octree_from_dexels(view, &CONTROL).map(drop),
            dexel_voxels(view, &[], &CONTROL).map(drop),
            marching_cubes_dexels(view, &CONTROL).map(drop),
            dual_contouring_dexels(view, &CONTROL).map(drop),
        ];
        for result in others {
            assert_eq!(sound, !matches!(result, Err(Error::DamagedRays { .. })));
        }
    }
    for result in results {
        match result {
            Ok(result) => assert!(sound && result.view().check().is_ok()),
            Err(error) => assert!(!sound && matches!(error, Error::DamagedRays { .. }), "{error}"),
        }
    }
}
