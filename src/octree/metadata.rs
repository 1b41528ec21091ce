//! Key–value facts that travel with a tree.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

/// UTF-8 keys and values, sorted by key. They mean nothing to the library; files carry them along.
///
/// Names in use: `name`, `units`, `source` (a fingerprint of what the tree was made from), `rule`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Metadata(BTreeMap<String, String>);

impl Metadata {
    /// No facts.
    pub fn new() -> Metadata {
        Metadata::default()
    }

    /// Sets `key` to `value`.
    pub fn insert(&mut self, key: impl Into<String>, value: impl Into<String>) {
        self.0.insert(key.into(), value.into());
    }

    /// The value of `key`.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }

    /// All facts, by ascending key.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(key, value)| (key.as_str(), value.as_str()))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The bytes in a file: per fact the lengths of key and value as little-endian u32, then both texts.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (key, value) in self.iter() {
            bytes.extend_from_slice(&(key.len() as u32).to_le_bytes());
            bytes.extend_from_slice(&(value.len() as u32).to_le_bytes());
            bytes.extend_from_slice(key.as_bytes());
            bytes.extend_from_slice(value.as_bytes());
        }
        bytes
    }

    /// Reads [`to_bytes`](Self::to_bytes); `None` unless the keys ascend and everything is UTF-8 and used up.
    pub(crate) fn from_bytes(mut bytes: &[u8]) -> Option<Metadata> {
        fn text<'a>(bytes: &mut &'a [u8], length: u32) -> Option<&'a str> {
            let (text, rest) = bytes.split_at_checked(usize::try_from(length).ok()?)?;
            *bytes = rest;
            core::str::from_utf8(text).ok()
        }
        fn length(bytes: &mut &[u8]) -> Option<u32> {
            let (length, rest) = bytes.split_first_chunk()?;
            *bytes = rest;
            Some(u32::from_le_bytes(*length))
        }
        let mut metadata = Metadata::new();
        while !bytes.is_empty() {
            let (key, value) = (length(&mut bytes)?, length(&mut bytes)?);
            let (key, value) = (text(&mut bytes, key)?, text(&mut bytes, value)?);
            if metadata.0.last_key_value().is_some_and(|(last, _)| last.as_str() >= key) {
                return None;
            }
            metadata.insert(key, value);
        }
        Some(metadata)
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
        let bytes = metadata.to_bytes();
        assert_eq!(Metadata::from_bytes(&bytes), Some(metadata));
        assert_eq!(Metadata::from_bytes(&[]), Some(Metadata::new()));
        for cut in 1..bytes.len() {
            let first = 8 + 4 + "Flansch Ø 120".len();
            assert_eq!(Metadata::from_bytes(&bytes[..cut]).is_some(), cut == first, "{cut}");
        }
        let twice = [&bytes[..], &bytes[..]].concat();
        assert_eq!(Metadata::from_bytes(&twice), None);
    }
}
