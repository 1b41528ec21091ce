//! Files of tri-dexel models.

use super::boundary::{guard, out, shared};
use super::source::leafless_access::*;
use super::source::{Source, leafless_sink, leafless_source, sink, source};
use super::status::leafless_status;
use super::tridexel::{give, leafless_tridexel};
use leafless::file::{self, dexels};

/// Reads a tri-dexel model, with its metadata. Of a file that is damaged where LEAFLESS_ACCESS_MAP does not
/// look, intervals are read as they stand there, in bounds; set algebra, editors and writing check all of it
/// first and return LEAFLESS_E_DAMAGED.
///
/// - Buffers: `source`, one struct; `tridexel`, one pointer.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_FORMAT; LEAFLESS_E_VERSION; LEAFLESS_E_DAMAGED; LEAFLESS_E_ARGUMENT if the file holds
///   an octree, if there is no regular file that could be mapped, or if bytes that shall be viewed are
///   misaligned; LEAFLESS_E_IO; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: how long a file or bytes must stay as they are, leafless_source tells. Release `*tridexel`
///   with leafless_tridexel_free.
/// - Untrusted input: as leafless_source tells.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_read(
    source: *const leafless_source,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let source = self::source(source)?;
        let tridexel = out(tridexel, "tridexel")?;
        // What is used in place stays, as the host promises.
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

/// Writes a tri-dexel model's file. Equal models with equal metadata give equal bytes. Only for a buffer is
/// the file in memory as a whole.
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
