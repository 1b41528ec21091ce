//! Writing: the bytes of a tree, and how they reach a disk.

use super::header::{ENCODING_DICTIONARY, ENCODING_RAW, HEADER_LENGTH, Header, MAGIC, MAJOR, MINOR};
use super::object::Object;
use super::section::{Entry, Kind, MAX_METADATA, SECTION_ALIGNMENT};
use super::wire::Wire;
use crate::error::Error;
use crate::octree::Octree;
use crate::octree::brick::OwnedBricks;
use crate::octree::brick::{Brick, BrickArray, Bricks};
use crate::octree::dictionary;
use crate::octree::view::LevelCounts;
use crate::octree::word::Planes;
use alloc::vec::Vec;
use bytemuck::Zeroable;
use core::mem::offset_of;
#[cfg(feature = "std")]
use std::{
    fs::{File, OpenOptions},
    io::{ErrorKind, Write},
    path::{Path, PathBuf},
};

/// The file of `octree`, in memory.
///
/// The bytes depend on the tree and its metadata alone: not on how its bricks are coded in memory, nor on
/// whether it was built, read or mapped. The tree is [checked](crate::OctreeRef::check) first, so that every
/// file that is written can be read. O(n); besides the result, memory for the dictionary is needed.
///
/// # Errors
/// [`Error::Damaged`] if the tree is a mapped one that nobody has verified, and is damaged;
/// [`Error::Argument`] if the metadata take more than 1 MiB; [`Error::OutOfMemory`].
pub fn to_bytes(octree: &Octree) -> Result<Vec<u8>, Error> {
    let mut file = Vec::new();
    assemble(octree, &mut |length, write| {
        let length = usize::try_from(length).map_err(|_| Error::OutOfMemory)?;
        file.try_reserve_exact(length)?;
        write(&mut |bytes| {
            file.extend_from_slice(bytes);
            Ok(())
        })
    })?;
    Ok(file)
}

/// Writes the file of `octree` to `out`, the same bytes as [`to_bytes`], in a few large pieces: no buffer is
/// needed around `out`, and the file is never in memory as a whole. `out` is flushed at the end.
///
/// # Errors
/// As [`to_bytes`], before anything is written; [`Error::Io`] as `out` returns it.
#[cfg(feature = "std")]
pub fn write_to(octree: &Octree, mut out: impl Write) -> Result<(), Error> {
    assemble(octree, &mut |_, write| write(&mut |bytes| Ok(out.write_all(bytes)?)))?;
    Ok(out.flush()?)
}

/// Saves `octree` in the file at `path`: at any moment, also after a crash or a power failure, there is the
/// old file or the new one, each complete.
///
/// The bytes, those of [`to_bytes`], go to a temporary file in the same directory, which is synchronised with
/// the disk and then renamed over the old file; at last the directory is synchronised (on Unix). Whoever has
/// the old file open or mapped keeps it.
///
/// * A file that is replaced keeps its permissions, a new one gets those that the process gives to new files
///   (its umask). A file that may not be written to is not replaced. The file belongs to the user who saves;
///   its other hard links, if any, keep the old contents.
/// * A symbolic link is followed, also to a file that does not exist yet: what it points to is replaced, the
///   link stays.
/// * What is not a regular file, such as a pipe or a terminal, is written to directly, and so is an open file
///   of the process that is named like `/dev/stdout`: the bytes go to its end.
///
/// A process that is killed meanwhile may leave a file `.leafless-….tmp` behind.
///
/// # Errors
/// As [`to_bytes`], and [`Error::File`] with the path and the cause [`Error::Io`]. The old file is then as it
/// was, and no temporary file is left; only if it is the very last step that fails, synchronising the
/// directory, the new file is already in place.
#[cfg(feature = "std")]
pub fn save(octree: &Octree, path: impl AsRef<Path>) -> Result<(), Error> {
    save_with(path.as_ref(), |file| write_to(octree, file))
}

/// As [`save`] for a file of any kind, whose bytes `write` writes.
#[cfg(feature = "std")]
pub(crate) fn save_with(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<(), Error>,
) -> Result<(), Error> {
    save_path(path, write).map_err(|error| match error {
        Error::Io(_) => error.of_file(path),
        // It is what is to be written that is damaged.
        error => error,
    })
}

#[cfg(feature = "std")]
fn save_path(path: &Path, write: impl FnOnce(&mut File) -> Result<(), Error>) -> Result<(), Error> {
    let existing = match std::fs::metadata(path) {
        Ok(metadata) => Some(metadata),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(error.into()),
    };
    let target = follow_links(path)?.filter(|_| existing.as_ref().is_none_or(|file| file.is_file()));
    let Some(target) = target else {
        return write(&mut OpenOptions::new().append(true).open(path)?);
    };
    let directory = target.parent().filter(|parent| !parent.as_os_str().is_empty());
    let directory = directory.unwrap_or(Path::new("."));
    if existing.is_some() {
        // Renaming would not ask whether the old file may be written to.
        OpenOptions::new().write(true).open(&target)?;
    }
    // A directory that may be written to but not read cannot be synchronised.
    #[cfg(unix)]
    let handle = File::open(directory).ok();

    let mut builder = tempfile::Builder::new();
    builder.prefix(".leafless-").suffix(".tmp");
    #[cfg(unix)]
    if existing.is_none() {
        use std::os::unix::fs::PermissionsExt;
        // The umask is taken off by the system. Where a file is replaced nobody else may look at the new
        // one before it has the old one's permissions.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut temporary = builder.tempfile_in(directory).map_err(without_name)?;
    write(temporary.as_file_mut())?;
    if let Some(existing) = existing {
        temporary.as_file().set_permissions(existing.permissions())?;
    }
    temporary.as_file().sync_all()?;
    temporary.persist(&target).map_err(|refused| refused.error)?;
    #[cfg(unix)]
    if let Some(handle) = handle {
        synchronise(&handle)?;
    }
    Ok(())
}

/// An error of `tempfile` without the temporary file's name, which means nothing to whoever saves. The system's
/// number is kept in its text only.
#[cfg(feature = "std")]
fn without_name(error: std::io::Error) -> std::io::Error {
    let text = alloc::string::ToString::to_string(&error);
    let number = text.split_once("(os error ").and_then(|(_, rest)| rest.split_once(')'));
    let code = number.and_then(|(code, _)| code.parse().ok());
    code.map_or(error.kind().into(), std::io::Error::from_raw_os_error)
}

/// Synchronises a directory, where its file system can.
#[cfg(all(feature = "std", unix))]
fn synchronise(directory: &File) -> Result<(), Error> {
    match directory.sync_all() {
        Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
            Err(error.into())
        }
        _ => Ok(()),
    }
}

/// The path that `path` names once all symbolic links at its end are followed; the last need not exist.
/// `None` if one of them stands for an open file of a process.
#[cfg(feature = "std")]
fn follow_links(path: &Path) -> Result<Option<PathBuf>, Error> {
    let mut target = path.to_path_buf();
    // As many as Linux follows.
    for _ in 0..40 {
        match std::fs::symlink_metadata(&target) {
            Ok(metadata) if metadata.file_type().is_symlink() => {
                let directory = target.parent().unwrap_or(Path::new(""));
                // `/proc/self/fd/1`, which `/dev/stdout` leads to, reads as a link, but is none: what it
                // names may be a pipe, removed, or open for appending.
                if directory.canonicalize().is_ok_and(|directory| directory.starts_with("/proc")) {
                    return Ok(None);
                }
                target = directory.join(std::fs::read_link(&target)?);
            }
            Ok(_) => return Ok(Some(target)),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Some(target)),
            Err(error) => return Err(error.into()),
        }
    }
    // The system says what is wrong with such a chain.
    std::fs::metadata(&target)?;
    Ok(Some(target))
}

/// The elements of a section as they lie in memory.
#[derive(Clone, Copy)]
enum Elements<'a> {
    Planes(&'a [Planes]),
    U16(&'a [u16]),
    U64(&'a [u64]),
    Levels(&'a [LevelCounts]),
    Objects(&'a [Object]),
    Bytes(&'a [u8]),
}

/// Takes bytes of a file, in order.
type Sink<'s> = &'s mut dyn FnMut(&[u8]) -> Result<(), Error>;

impl Elements<'_> {
    fn size(&self) -> usize {
        match self {
            Elements::Planes(_) => size_of::<Planes>(),
            Elements::U16(_) => size_of::<u16>(),
            Elements::U64(_) => size_of::<u64>(),
            Elements::Levels(_) => size_of::<LevelCounts>(),
            Elements::Objects(_) => size_of::<Object>(),
            Elements::Bytes(_) => 1,
        }
    }

    fn count(&self) -> usize {
        match self {
            Elements::Planes(elements) => elements.len(),
            Elements::U16(elements) => elements.len(),
            Elements::U64(elements) => elements.len(),
            Elements::Levels(elements) => elements.len(),
            Elements::Objects(elements) => elements.len(),
            Elements::Bytes(elements) => elements.len(),
        }
    }

    /// Hands the bytes to `sink` in the file's order.
    fn write(&self, sink: Sink<'_>) -> Result<(), Error> {
        match self {
            Elements::Planes(elements) => write_elements(elements, sink),
            Elements::U16(elements) => write_elements(elements, sink),
            Elements::U64(elements) => write_elements(elements, sink),
            Elements::Levels(elements) => write_elements(elements, sink),
            Elements::Objects(elements) => write_elements(elements, sink),
            Elements::Bytes(elements) => sink(elements),
        }
    }
}

fn write_elements<T: Wire>(elements: &[T], sink: Sink<'_>) -> Result<(), Error> {
    if cfg!(target_endian = "little") {
        return sink(bytemuck::cast_slice(elements));
    }
    let mut swapped = [T::zeroed(); 256];
    for piece in elements.chunks(swapped.len()) {
        for (swapped, element) in swapped.iter_mut().zip(piece) {
            *swapped = element.ordered();
        }
        sink(bytemuck::cast_slice(&swapped[..piece.len()]))?;
    }
    Ok(())
}

/// Writes a file into whatever sink it is given.
type WriteFile<'w> = &'w dyn Fn(Sink<'_>) -> Result<(), Error>;

/// Lays out the file of `octree` and tells `deliver` its length and how to write it.
fn assemble(
    octree: &Octree,
    deliver: &mut dyn FnMut(u64, WriteFile<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let tree = octree.view();
    // Thereby the links, too, are the ones that the planes determine.
    tree.check()?;
    if octree.metadata().len_in_file() as u64 > MAX_METADATA {
        return Err(Error::Argument { name: "metadata", problem: "must not take more than 1 MiB in a file" });
    }
    let metadata = octree.metadata().to_bytes()?;
    let encoded = dictionary::encode(&tree.bricks)?;
    let bricks = encoded.as_ref().map_or(tree.bricks, OwnedBricks::view);
    let mut header = Header {
        magic: MAGIC,
        major: MAJOR,
        minor: MINOR,
        header_length: HEADER_LENGTH as u32,
        origin: tree.frame.origin().map(f64::to_bits),
        edge: tree.frame.edge().to_bits(),
        depth: tree.frame.depth(),
        root: tree.root as u8,
        exterior: tree.exterior as u8,
        proof: tree.proof.bits(),
        displacement: tree.proof.displacement().to_bits(),
        brick_planes: if bricks.one_plane() { 1 } else { 2 },
        elements: tree.element_count(),
        bricks: tree.brick_count(),
        ..Header::zeroed()
    };
    let [raw, indices, entries, segments] = match bricks {
        Bricks::One(bricks) => brick_sections(&bricks, Elements::U64, &mut header),
        Bricks::Two(bricks) => brick_sections(&bricks, Elements::Planes, &mut header),
    };
    let objects = [Object::solid(&header)];
    // In ascending order, as they lie in the file: what is asked first lies together.
    let sections = [
        (Kind::Objects, Elements::Objects(&objects)),
        (Kind::Metadata, Elements::Bytes(&metadata)),
        (Kind::Levels, Elements::Levels(octree.counts())),
        (Kind::Planes, Elements::Planes(tree.planes)),
        (Kind::Rel, Elements::U16(tree.rel)),
        (Kind::Base, Elements::U64(tree.base)),
        (Kind::Bricks, raw),
        (Kind::Indices, indices),
        (Kind::Entries, entries),
        (Kind::Segments, segments),
    ];
    let present = || sections.iter().filter(|(_, elements)| elements.count() != 0);

    let mut head = [0; HEADER_LENGTH + Kind::ALL.len() * size_of::<Entry>()];
    let head_length = HEADER_LENGTH + present().count() * size_of::<Entry>();
    let (first, table) = head[..head_length].split_at_mut(HEADER_LENGTH);
    // Offsets cannot overflow: all of it lies in memory.
    let mut end = head_length as u64;
    for ((kind, elements), raw) in present().zip(table.chunks_exact_mut(size_of::<Entry>())) {
        let mut crc = crc32fast::Hasher::new();
        elements.write(&mut |bytes| {
            crc.update(bytes);
            Ok(())
        })?;
        let (element, components) = kind.element(header.brick_planes);
        let entry = Entry {
            kind: *kind as u32,
            element_type: element as u8,
            components,
            flags: kind.flags(),
            offset: end.next_multiple_of(SECTION_ALIGNMENT),
            length: elements.count() as u64 * elements.size() as u64,
            count: elements.count() as u64,
            crc: crc.finalize(),
            ..Entry::zeroed()
        };
        end = entry.range().end;
        header.section_count += 1;
        raw.copy_from_slice(bytemuck::bytes_of(&entry.ordered()));
    }
    header.file_length = end;
    header.table_crc = crc32fast::hash(table);
    first.copy_from_slice(bytemuck::bytes_of(&header.ordered()));
    header.header_crc = crc32fast::hash(&first[..offset_of!(Header, header_crc)]);
    first.copy_from_slice(bytemuck::bytes_of(&header.ordered()));

    deliver(end, &|sink| {
        sink(&head[..head_length])?;
        let mut end = head_length;
        for (_, elements) in present() {
            let start = end.next_multiple_of(SECTION_ALIGNMENT as usize);
            sink(&[0; SECTION_ALIGNMENT as usize][..start - end])?;
            elements.write(sink)?;
            end = start + elements.count() * elements.size();
        }
        Ok(())
    })
}

/// The sections that bricks take (raw bricks, indices, entries, segments), and what the header says of them.
fn brick_sections<'a, T: Brick>(
    bricks: &BrickArray<'a, T>,
    elements: fn(&'a [T]) -> Elements<'a>,
    header: &mut Header,
) -> [Elements<'a>; 4] {
    match *bricks {
        BrickArray::Raw(raw) => {
            header.brick_encoding = ENCODING_RAW;
            [elements(raw), Elements::U16(&[]), elements(&[]), Elements::U64(&[])]
        }
        BrickArray::Dictionary { indices, entries, segments, shift } => {
            header.brick_encoding = ENCODING_DICTIONARY;
            header.segment_shift = shift;
            header.dictionary_entries = entries.len() as u64;
            [elements(&[]), Elements::U16(indices), elements(entries), Elements::U64(segments)]
        }
    }
}
