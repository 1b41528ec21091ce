//! Decompression of DEFLATE streams of a known length, wrapped as gzip (RFC 1952) or zlib (RFC 1950).

use crate::error::{Error, VolumeFileError};
use crate::memory;
use alloc::vec::Vec;
use miniz_oxide::inflate::TINFLStatus;
use miniz_oxide::inflate::core::inflate_flags::{
    TINFL_FLAG_PARSE_ZLIB_HEADER, TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF,
};
use miniz_oxide::inflate::core::{DecompressorOxide, decompress};

/// DEFLATE expands two bits to at most 258 bytes.
const RATIO: u64 = 1032;

/// Decompresses `length` bytes from `data`: one zlib stream, or one or several gzip members. Further bytes
/// are ignored.
///
/// A length that the compressed bytes cannot reach is refused before anything is allocated.
pub(super) fn inflate(data: &[u8], length: u64) -> Result<Vec<u8>, Error> {
    if length > (data.len() as u64).saturating_mul(RATIO) {
        return Err(VolumeFileError::Length { expected: length, found: data.len() as u64 }.into());
    }
    let length = usize::try_from(length).map_err(|_| Error::OutOfMemory)?;
    let mut bytes = memory::filled(length, 0)?;
    // The state has 11 kB.
    let mut state = memory::with_capacity(1)?;
    state.push(DecompressorOxide::new());
    let Some(state) = state.first_mut() else { return Err(Error::OutOfMemory) };
    if !data.starts_with(b"\x1F\x8B") {
        let flags = TINFL_FLAG_PARSE_ZLIB_HEADER | TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
        let (status, _, made) = decompress(state, data, &mut bytes, 0, flags);
        finished(status, made == length)?;
        return Ok(bytes);
    }
    let (mut rest, mut from) = (data, 0);
    while from < length || from == 0 {
        rest = after_header(rest).ok_or(damaged("a gzip header"))?;
        *state = DecompressorOxide::new();
        let flags = TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
        // Members are independent of each other.
        let member = bytes.get_mut(from..).unwrap_or(&mut []);
        let (status, used, made) = decompress(state, rest, member, 0, flags);
        finished(status, true)?;
        let trailer = rest.get(used..).and_then(|rest| rest.split_first_chunk::<8>());
        let (trailer, behind) = trailer.ok_or(damaged("the end of a gzip member"))?;
        let [a, b, c, d, e, f, g, h] = *trailer;
        let made_bytes = member.get(..made).unwrap_or(&[]);
        let is_right = crc32fast::hash(made_bytes) == u32::from_le_bytes([a, b, c, d])
            && made as u32 == u32::from_le_bytes([e, f, g, h]);
        if !is_right {
            return Err(damaged("the checksum or the length of a gzip member").into());
        }
        (rest, from) = (behind, from + made);
        if made == 0 && !rest.starts_with(b"\x1F\x8B") {
            break;
        }
    }
    finished(TINFLStatus::Done, from == length)?;
    Ok(bytes)
}

fn damaged(what: &'static str) -> VolumeFileError {
    VolumeFileError::Damaged { what }
}

fn finished(status: TINFLStatus, whole: bool) -> Result<(), VolumeFileError> {
    match status {
        TINFLStatus::Done if whole => Ok(()),
        TINFLStatus::Done => Err(damaged("the length of the compressed samples")),
        TINFLStatus::HasMoreOutput => Err(damaged("the length of the compressed samples")),
        TINFLStatus::Adler32Mismatch => Err(damaged("the checksum of the compressed samples")),
        _ => Err(damaged("the compressed samples")),
    }
}

/// Returns the bytes after the header of a gzip member.
fn after_header(bytes: &[u8]) -> Option<&[u8]> {
    let (header, mut rest) = bytes.split_first_chunk::<10>()?;
    let [0x1F, 0x8B, 8, flags, ..] = *header else { return None };
    if flags & 0xE0 != 0 {
        return None;
    }
    if flags & 4 != 0 {
        let (length, behind) = rest.split_first_chunk::<2>()?;
        rest = behind.get(usize::from(u16::from_le_bytes(*length))..)?;
    }
    for text in [8, 16] {
        if flags & text != 0 {
            rest = rest.get(rest.iter().position(|&byte| byte == 0)? + 1..)?;
        }
    }
    if flags & 2 != 0 {
        rest = rest.get(2..)?;
    }
    Some(rest)
}
