//! The ZIP archive of a 3MF package and its parts, named according to the Open Packaging Conventions.

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;
use core::cmp::Ordering;

use miniz_oxide::inflate::TINFLStatus;
use miniz_oxide::inflate::core::inflate_flags::TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
use miniz_oxide::inflate::core::{DecompressorOxide, decompress};
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};

use super::xml::{Markup, Namespace, Text, Xml};
use crate::error::{Error, PackageError};
use crate::memory;

/// Maximum ratio of the total length of the decompressed parts to the length of the file.
const EXPANSION: u64 = 64;
/// Additional allowance for the decompressed parts, in bytes.
const ALLOWANCE: u64 = 16 << 20;
/// DEFLATE expands two bits to at most 258 bytes.
const DEFLATE_RATIO: u64 = 1032;

/// The part that contains the package's relationships.
const RELATIONSHIPS: &str = "_rels/.rels";
const CONTENT_TYPES: &str = "[Content_Types].xml";
/// The type of the relationship whose target is the model.
const START_PART: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
/// The type of the relationship whose target is the keys of protected content.
const KEY_STORE: &str = "http://schemas.microsoft.com/3dmanufacturing/2019/04/keystore";
const MODEL_TYPE: &str = "application/vnd.ms-package.3dmanufacturing-3dmodel+xml";

/// A package whose directory has been read.
pub(super) struct Package<'a> {
    archive: ZipSliceArchive<&'a [u8]>,
    /// Sorted by name, ignoring letter case.
    entries: Vec<Entry<'a>>,
    /// Number of bytes that may still be decompressed.
    budget: u64,
}

struct Entry<'a> {
    name: &'a [u8],
    way: ZipArchiveEntryWayfinder,
    method: CompressionMethod,
    encrypted: bool,
    crc: u32,
}

impl<'a> Package<'a> {
    pub fn open(bytes: &'a [u8]) -> Result<Self, Error> {
        let damaged =
            |error: rawzip::Error| broken("", alloc::format!("the ZIP archive is damaged: {error}"));
        let archive = ZipArchive::from_slice(bytes).map_err(|error| {
            if is_markup(bytes) {
                broken("", "this is plain XML, but a 3MF is a ZIP archive that contains such a text")
            } else {
                damaged(error)
            }
        })?;
        let mut entries = Vec::new();
        let mut records = archive.entries();
        // Every record is in the file, so the number of records is at most the file's length in bytes.
        while let Some(record) = records.next_entry().map_err(damaged)? {
            // The records borrow the archive, the names borrow the file.
            let start = record.central_directory_offset() + CENTRAL_HEADER;
            let length = record.file_path().as_bytes().len();
            let name = usize::try_from(start).ok().and_then(|start| bytes.get(start..)?.get(..length));
            let name = name.unwrap_or(b"");
            entries.try_reserve(1)?;
            entries.push(Entry {
                name: name.strip_prefix(b"/").unwrap_or(name),
                way: record.wayfinder(),
                method: record.compression_method(),
                encrypted: record.flags().is_encrypted(),
                crc: record.crc32(),
            });
        }
        if entries.len() as u64 != archive.entries_hint() {
            return Err(broken(
                "",
                "the ZIP archive is damaged: it has another number of files than it says",
            ));
        }
        entries.sort_unstable_by(|a, b| compare(a.name, b.name));
        let budget = (bytes.len() as u64).saturating_mul(EXPANSION).saturating_add(ALLOWANCE);
        Ok(Self { archive, entries, budget })
    }

    /// Returns the part with this name, which may have a leading slash and URI escapes.
    pub fn find(&self, name: &str) -> Result<Option<u32>, Error> {
        let name = name.strip_prefix('/').unwrap_or(name);
        match self.position(name.as_bytes())? {
            None if name.contains('%') => self.position(&percent_decoded(name)),
            found => Ok(found),
        }
    }

    fn position(&self, name: &[u8]) -> Result<Option<u32>, Error> {
        let Ok(at) = self.entries.binary_search_by(|entry| compare(entry.name, name)) else {
            return Ok(None);
        };
        let is_same = |at: usize| self.entries.get(at).is_some_and(|e| compare(e.name, name).is_eq());
        if is_same(at + 1) || at.checked_sub(1).is_some_and(is_same) {
            return Err(broken(&String::from_utf8_lossy(name), "is in the package more than once"));
        }
        u32::try_from(at).map(Some).map_err(|_| Error::OutOfMemory)
    }

    /// Returns the name of a part, for messages.
    pub fn name(&self, part: u32) -> Cow<'_, str> {
        self.entries.get(part as usize).map_or(Cow::Borrowed(""), |e| String::from_utf8_lossy(cut(e.name)))
    }

    /// Returns a part's text, decompressed, after verifying its checksum.
    pub fn text(&mut self, part: u32) -> Result<Text, Error> {
        Text::decode(self.bytes(part)?).map_err(|problem| match problem {
            Some(problem) => broken(&self.name(part), problem),
            None => Error::OutOfMemory,
        })
    }

    fn bytes(&mut self, part: u32) -> Result<Vec<u8>, Error> {
        let name = self.name(part).into_owned();
        let Some(&Entry { way, method, encrypted, crc, .. }) = self.entries.get(part as usize) else {
            return Ok(Vec::new());
        };
        if encrypted {
            return Err(broken(&name, "is encrypted"));
        }
        let found = self.archive.get_entry(way);
        let found = found.map_err(|error| broken(&name, alloc::format!("is damaged: {error}")))?;
        let (data, length) = (found.data(), way.uncompressed_size_hint());
        // The claim of a header is limited by the length of the data.
        let most = match method {
            CompressionMethod::STORE => data.len() as u64,
            _ => (data.len() as u64).saturating_mul(DEFLATE_RATIO),
        };
        if length > most {
            return Err(broken(&name, "claims to be longer than its data can be"));
        }
        self.budget = self.budget.checked_sub(length).ok_or_else(|| {
            let problem = alloc::format!(
                "makes the package, decompressed, more than {EXPANSION} times as long as the file"
            );
            broken(&name, problem)
        })?;
        let length = usize::try_from(length).map_err(|_| Error::OutOfMemory)?;
        let mut bytes = memory::with_capacity(length)?;
        let whole = match method {
            CompressionMethod::STORE => {
                bytes.extend_from_slice(data);
                data.len() == length
            }
            CompressionMethod::DEFLATE => {
                bytes.resize(length, 0);
                inflate(data, &mut bytes)?
            }
            _ => return Err(broken(&name, "is compressed by another method than DEFLATE")),
        };
        if !whole || crc32fast::hash(&bytes) != crc {
            return Err(broken(&name, "is damaged: its length or checksum is wrong"));
        }
        Ok(bytes)
    }

    /// Returns the part that contains the model: the target of the package's relationship.
    pub fn model(&mut self) -> Result<u32, Error> {
        let missing = |name| broken(name, "is missing, so this is no 3MF package");
        let types = self.find(CONTENT_TYPES)?.ok_or_else(|| missing(CONTENT_TYPES))?;
        let relationships = self.find(RELATIONSHIPS)?.ok_or_else(|| missing(RELATIONSHIPS))?;
        let text = self.text(relationships)?;
        let target = start_part(&text)?;
        let part = self.find(&target)?.ok_or_else(|| broken(&target, "is missing in the package"))?;
        let text = self.text(types)?;
        match content_type(&text, &self.name(part))? {
            Some(found) if !found.eq_ignore_ascii_case(MODEL_TYPE) => {
                Err(broken(&target, "is declared to be something else than a 3D model"))
            }
            // Some programs do not declare it.
            _ => Ok(part),
        }
    }
}

/// Number of bytes of a directory record before the name.
const CENTRAL_HEADER: u64 = 46;

/// Returns the target of the only relationship that leads to a model.
fn start_part(text: &Text) -> Result<String, Error> {
    let mut xml = Xml::new(RELATIONSHIPS, text);
    let mut target: Option<Cow<str>> = None;
    while let Some(markup) = xml.next()? {
        let Markup::Start(element) = markup else { continue };
        if !element.is(Namespace::Relationships, "Relationship") {
            continue;
        }
        let (mut kind, mut to, mut external) = (None, None, false);
        for attribute in xml.attributes() {
            match (attribute.prefix, attribute.name) {
                ("", "Type") => kind = Some(xml.name(attribute)?),
                ("", "Target") => to = Some(xml.name(attribute)?),
                ("", "TargetMode") => external = attribute.value.trim() == "External",
                _ => {}
            }
        }
        match kind.as_deref() {
            Some(START_PART) => {}
            Some(KEY_STORE) => {
                return Err(
                    xml.error(element.offset, "the package holds protected content (3MF Secure Content)")
                );
            }
            _ => continue,
        }
        let to = to.ok_or_else(|| xml.error(element.offset, "the relationship has no target"))?;
        if external {
            return Err(xml.error(element.offset, "the model lies outside of the package"));
        }
        if target.as_ref().is_some_and(|known| *known != to) {
            return Err(xml.error(element.offset, "a second relationship leads to another model"));
        }
        target = Some(to);
    }
    let none = || broken(RELATIONSHIPS, "leads to no 3D model, so this is no 3MF package");
    target.map(Cow::into_owned).ok_or_else(none)
}

/// Returns the content type that the package declares for a part: by its name, or else by its extension.
fn content_type<'a>(text: &'a Text, part: &str) -> Result<Option<Cow<'a, str>>, Error> {
    let mut xml = Xml::new(CONTENT_TYPES, text);
    let extension = part.rsplit_once('.').map_or("", |(_, extension)| extension);
    let mut default = None;
    while let Some(markup) = xml.next()? {
        let Markup::Start(element) = markup else { continue };
        let by_name = element.is(Namespace::ContentTypes, "Override");
        if !by_name && !element.is(Namespace::ContentTypes, "Default") {
            continue;
        }
        let (mut matches, mut kind) = (false, None);
        for attribute in xml.attributes() {
            match (attribute.prefix, attribute.name) {
                ("", "ContentType") => kind = Some(xml.name(attribute)?),
                ("", "PartName") if by_name => {
                    let name = xml.name(attribute)?;
                    matches = name.strip_prefix('/').unwrap_or(&name).eq_ignore_ascii_case(part);
                }
                ("", "Extension") if !by_name => {
                    matches = xml.name(attribute)?.eq_ignore_ascii_case(extension);
                }
                _ => {}
            }
        }
        match (matches, by_name) {
            (true, true) => return Ok(kind),
            (true, false) => default = kind,
            _ => {}
        }
    }
    Ok(default)
}

/// Returns whether the first character is the beginning of XML, in UTF-8 or UTF-16.
fn is_markup(bytes: &[u8]) -> bool {
    // Skip byte order marks, and upper halves of UTF-16 characters.
    let mut start =
        bytes.iter().take(64).filter(|byte| !matches!(byte, 0 | 0xBB | 0xBF | 0xEF | 0xFE | 0xFF));
    start.find(|byte| !byte.is_ascii_whitespace()) == Some(&b'<')
}

/// Decompresses `data`, which must fill `bytes` exactly. Returns whether it does.
fn inflate(data: &[u8], bytes: &mut [u8]) -> Result<bool, Error> {
    // The state has 11 kB.
    let mut state = memory::with_capacity(1)?;
    state.push(DecompressorOxide::new());
    let flags = TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
    let (status, _, length) = decompress(&mut state[0], data, bytes, 0, flags);
    Ok(status == TINFLStatus::Done && length == bytes.len())
}

/// Compares part names; names that differ only in the case of ASCII letters are equal.
fn compare(a: &[u8], b: &[u8]) -> Ordering {
    let lower = u8::to_ascii_lowercase;
    a.iter().map(lower).cmp(b.iter().map(lower))
}

/// Returns the bytes that a URI encodes. The length of names is limited.
fn percent_decoded(name: &str) -> Vec<u8> {
    let mut rest = name.as_bytes();
    let mut bytes = Vec::new();
    while let [first, tail @ ..] = rest {
        let digits = tail.get(..2).and_then(|two| core::str::from_utf8(two).ok());
        let code = digits.filter(|_| *first == b'%').and_then(|two| u8::from_str_radix(two, 16).ok());
        bytes.push(code.unwrap_or(*first));
        rest = &tail[if code.is_some() { 2 } else { 0 }..];
    }
    bytes
}

/// Returns the part of a name that a message shows.
fn cut(name: &[u8]) -> &[u8] {
    &name[..name.len().min(256)]
}

/// Makes an error about a whole part, or about the package if the name is empty.
pub(super) fn broken(part: &str, problem: impl Into<String>) -> Error {
    let part = String::from_utf8_lossy(cut(part.as_bytes()));
    PackageError::new(part, (0, 0), problem.into()).into()
}
