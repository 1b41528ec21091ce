//! Files of tri-dexel models.

use super::boundary::{guard, out, shared};
use super::source::leafless_access::*;
use super::source::{Source, leafless_sink, leafless_source, sink, source};
use super::status::leafless_status;
use super::tridexel::{give, leafless_tridexel};
use leafless::file::{self, dexels};

/// Reads a tri-dexel model, with its metadata. If a file is damaged in parts that LEAFLESS_ACCESS_MAP does
/// not check, queries return the damaged intervals, and stay in bounds; set algebra, editors and writing
/// check the whole model first and return LEAFLESS_E_DAMAGED.
///
/// - Buffers: `source`, one struct; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT if the file holds
///   an octree, if the file to map is not a regular file, or if bytes to view are misaligned; LEAFLESS_E_IO;
///   LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: leafless_source describes how long a file or bytes must stay unchanged. Release `*tridexel`
///   with leafless_tridexel_free.
/// - Untrusted input: as described in leafless_source.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_read(
    source: *const leafless_source,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let source = self::source(source)?;
        let tridexel = out(tridexel, "tridexel")?;
        // The host promises that data used in place stays unchanged.
        let found = match source {
            (Source::Path(path), LEAFLESS_ACCESS_COPY) => dexels::open(path)?,
            (Source::Path(path), LEAFLESS_ACCESS_MAP) => dexels::map(path)?,
            (Source::Path(path), LEAFLESS_ACCESS_MAP_VERIFIED) => dexels::map_verified(path)?,
            (Source::Bytes(bytes), LEAFLESS_ACCESS_COPY) => dexels::from_bytes(bytes)?,
            (Source::Bytes(bytes), LEAFLESS_ACCESS_MAP) => dexels::from_static(bytes)?,
            (Source::Bytes(bytes), LEAFLESS_ACCESS_MAP_VERIFIED) => {
                let found = dexels::from_static(bytes)?;
                file::verify(bytes)?;
                found
            }
        };
        tridexel.write(give(found))
    })
}

/// Writes a tri-dexel model's file. Equal models with equal metadata give equal bytes. The whole file is in
/// memory only if the sink is a buffer.
///
/// - Buffers: `sink`, one struct.
/// - Errors: LEAFLESS_E_DAMAGED if the model was mapped unverified and is damaged; LEAFLESS_E_IO;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_write(
    tridexel: *const leafless_tridexel,
    sink: *const leafless_sink,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let sink = self::sink(sink)?;
        sink.put(
            |path| dexels::save(model, path),
            |to| dexels::write_to(model, to),
            || dexels::to_bytes(model),
        )
    })
}
