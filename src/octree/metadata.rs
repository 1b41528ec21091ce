//! Key–value facts that are stored with a tree.

use crate::error::{Error, FormatError};
use crate::memory;
use alloc::string::String;
use alloc::vec::Vec;

/// UTF-8 keys and values, sorted by key. They mean nothing to the library; files store them.
///
/// Names in use: `name`, `units` (the unit of length), `source` (a fingerprint of the tree's source), `rule`.
/// Operations on views make octrees without metadata; [`common`](Self::common) returns the facts to keep.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Metadata(Vec<(String, String)>);

/// The greatest size of all facts together in a file, in bytes; part of the format.
#[derive(Debug, Clone, Copy)]
pub struct MetadataLimit {
    bytes: usize,
    problem: &'static str,
}

impl MetadataLimit {
    /// The limit for the facts of a solid.
    pub const SOLID: MetadataLimit =
        MetadataLimit { bytes: 1 << 20, problem: "must not take more than 1 MiB in a file" };

    /// The limit for the facts of a channel, which bounds the work of mapping a file.
    pub const CHANNEL: MetadataLimit =
        MetadataLimit { bytes: 1 << 16, problem: "must not take more than 64 KiB in a file for a channel" };

    /// Returns the limit in bytes.
    pub const fn bytes(self) -> usize {
        self.bytes
    }

    /// Refuses facts that take too many bytes in a file.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`].
    pub(crate) fn check(self, bytes: usize) -> Result<(), Error> {
        if bytes > self.bytes {
            return Err(Error::Argument { name: "metadata", problem: self.problem });
        }
        Ok(())
    }
}

/// The facts that set operations keep if their operands agree on them, in ascending order.
const LASTING: [&str; 2] = ["name", "units"];

/// Bytes of the two lengths before a fact in a file.
const LENGTHS: usize = 2 * size_of::<u32>();

impl Metadata {
    /// Returns an empty set of facts.
    pub fn new() -> Metadata {
        Metadata::default()
    }

    /// Sets `key` to `value`.
    pub fn insert(&mut self, key: impl Into<String>, value: impl Into<String>) {
        let (key, value) = (key.into(), value.into());
        match self.find(&key) {
            Ok(at) => self.0[at].1 = value,
            Err(at) => self.0.insert(at, (key, value)),
        }
    }

    /// Removes `key`, and returns its value, if there was one.
    pub fn remove(&mut self, key: &str) -> Option<String> {
        self.find(key).ok().map(|at| self.0.remove(at).1)
    }

    /// Returns a copy in which `key` has another value or, for `None`, does not occur.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] if the copy would not fit into a file; [`Error::OutOfMemory`].
    pub fn changed(&self, key: &str, value: Option<&str>, limit: MetadataLimit) -> Result<Metadata, Error> {
        let kept = || self.iter().filter(|(known, _)| *known != key);
        let length: usize = kept().map(|(key, value)| LENGTHS + key.len() + value.len()).sum();
        if let Some(value) = value {
            limit.check(length + LENGTHS + key.len() + value.len())?;
        }
        let mut facts = memory::with_capacity(self.0.len() + 1)?;
        for (key, value) in kept() {
            facts.push((memory::text(key)?, memory::text(value)?));
        }
        let mut changed = Metadata(facts);
        if let Some(value) = value {
            changed.insert(memory::text(key)?, memory::text(value)?);
        }
        Ok(changed)
    }

    /// Returns the facts that hold for a combination of octrees with these metadata: `name` and `units`, each
    /// if all octrees have it with the same value. Without octrees there are none. (The source and the rule
    /// of an octree do not hold for the result.)
    ///
    /// ```
    /// use leafless::{Control, Frame, Metadata, Octree, Tag, union};
    /// let mut facts = Metadata::new();
    /// facts.insert("units", "mm");
    /// facts.insert("source", "…");
    /// let frame = Frame::new([0.0; 3], 1.0, 4)?;
    /// let a = Octree::uniform(frame, Tag::Full, Tag::Empty)?.with_metadata(facts);
    /// let b = a.clone();
    /// let both = union(a.view(), b.view(), &Control::default())?;
    /// let both = both.with_metadata(Metadata::common([a.metadata(), b.metadata()])?);
    /// assert_eq!(both.metadata().iter().collect::<Vec<_>>(), [("units", "mm")]);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn common<'m>(all: impl IntoIterator<Item = &'m Metadata> + Clone) -> Result<Metadata, Error> {
        let mut common = Metadata(memory::with_capacity(LASTING.len())?);
        for key in LASTING {
            let mut values = all.clone().into_iter().map(|metadata| metadata.get(key));
            if let Some(Some(first)) = values.next()
                && values.all(|value| value == Some(first))
            {
                common.0.push((memory::text(key)?, memory::text(first)?));
            }
        }
        Ok(common)
    }

    /// Returns the value of `key`.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.find(key).ok().and_then(|at| self.0.get(at)).map(|(_, value)| value.as_str())
    }

    /// Returns all facts, by ascending key.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(key, value)| (key.as_str(), value.as_str()))
    }

    /// True if there are no facts.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the position of `key`, or the position where it belongs.
    fn find(&self, key: &str) -> Result<usize, usize> {
        self.0.binary_search_by(|(known, _)| known.as_str().cmp(key))
    }

    /// Returns the bytes that the facts take in a file.
    pub(crate) fn len_in_file(&self) -> usize {
        self.iter().map(|(key, value)| LENGTHS + key.len() + value.len()).sum()
    }

    /// Returns the bytes for a file: for each fact the lengths of key and value as little-endian u32, then
    /// both texts. There must be less than 4 GiB of them.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfMemory`].
    pub(crate) fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        let mut bytes = memory::with_capacity(self.len_in_file())?;
        for (key, value) in self.iter() {
            bytes.extend_from_slice(&(key.len() as u32).to_le_bytes());
            bytes.extend_from_slice(&(value.len() as u32).to_le_bytes());
            bytes.extend_from_slice(key.as_bytes());
            bytes.extend_from_slice(value.as_bytes());
        }
        Ok(bytes)
    }

    /// Reads the bytes of [`to_bytes`](Self::to_bytes). Takes at most six times the memory of `bytes`.
    ///
    /// # Errors
    ///
    /// [`FormatError::Metadata`] unless the keys ascend, everything is UTF-8, and all bytes are used;
    /// [`Error::OutOfMemory`].
    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Metadata, Error> {
        // Everything is checked before anything is allocated.
        let mut last = None;
        let mut count = 0;
        for fact in Facts(bytes) {
            let (key, _) = fact.ok_or(FormatError::Metadata)?;
            if last.is_some_and(|last| last >= key) {
                return Err(FormatError::Metadata.into());
            }
            last = Some(key);
            count += 1;
        }
        let mut facts = memory::with_capacity(count)?;
        for (key, value) in Facts(bytes).flatten() {
            facts.push((memory::text(key)?, memory::text(value)?));
        }
        Ok(Metadata(facts))
    }
}

/// An iterator over the facts in the bytes of a file. At unreadable bytes it yields `None` and ends.
struct Facts<'a>(&'a [u8]);

impl<'a> Facts<'a> {
    fn length(&mut self) -> Option<usize> {
        let (length, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        usize::try_from(u32::from_le_bytes(*length)).ok()
    }

    fn text(&mut self, length: usize) -> Option<&'a str> {
        let (text, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        core::str::from_utf8(text).ok()
    }

    fn fact(&mut self) -> Option<(&'a str, &'a str)> {
        let (key, value) = (self.length()?, self.length()?);
        Some((self.text(key)?, self.text(value)?))
    }
}

impl<'a> Iterator for Facts<'a> {
    type Item = Option<(&'a str, &'a str)>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.0.is_empty() {
            return None;
        }
        let fact = self.fact();
        if fact.is_none() {
            self.0 = &[];
        }
        Some(fact)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_trip_and_damage() {
        let mut metadata = Metadata::new();
        metadata.insert("units", "mm");
        metadata.insert("name", "Flansch Ø 120");
        assert_eq!((metadata.get("units"), metadata.get("unit")), (Some("mm"), None));
        let bytes = metadata.to_bytes().unwrap();
        assert_eq!(bytes.len(), metadata.len_in_file());
        assert_eq!(Metadata::from_bytes(&bytes).unwrap(), metadata);
        assert_eq!(Metadata::from_bytes(&[]).unwrap(), Metadata::new());
        metadata.insert("units", "inch");
        metadata.insert("a", "first");
        let facts = [("a", "first"), ("name", "Flansch Ø 120"), ("units", "inch")];
        assert!(metadata.iter().eq(facts));
        for cut in 1..bytes.len() {
            let first = 8 + 4 + "Flansch Ø 120".len();
            assert_eq!(Metadata::from_bytes(&bytes[..cut]).is_ok(), cut == first, "{cut}");
        }
        let other = Metadata::from_bytes(&bytes).unwrap();
        assert!(Metadata::common([&metadata, &other]).unwrap().iter().eq([("name", "Flansch Ø 120")]));
        assert!(Metadata::common([&other, &other, &other]).unwrap() == other);
        assert!(Metadata::common([&other, &Metadata::new()]).unwrap().is_empty());
        assert!(Metadata::common([]).unwrap().is_empty());
        let twice = [&bytes[..], &bytes[..]].concat();
        let refused = Metadata::from_bytes(&twice);
        assert!(matches!(refused, Err(Error::Format(FormatError::Metadata))));
    }
}
