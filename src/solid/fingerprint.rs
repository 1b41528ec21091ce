//! Fingerprints of solids: 128 bits that identify a solid.

use core::fmt;
use xxhash_rust::xxh3::Xxh3Default;

/// A hash of 128 bits that identifies a solid. It covers everything that the verdicts depend on, so that two
/// solids have the same fingerprint only if they are the same. A stored octree keeps the fingerprint of its
/// source, so that no other solid refines it.
///
/// The hash is XXH3 (128 bits, no seed; the algorithm is frozen), the same on every platform. It guards
/// against mistakes, not against malice: anyone who can write a file can write any fingerprint into it. A
/// cryptographic hash, several times slower on a large mesh, would prove no more.
///
/// Its text form is `xxh3:` and 32 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Fingerprint(u128);

impl Fingerprint {
    /// The fingerprint of a solid that the host program identifies by these bytes: a name, a version, a hash
    /// of its own.
    pub fn of_bytes(bytes: &[u8]) -> Fingerprint {
        Fingerprinter::new("host").bytes(bytes).finish()
    }

    /// The lower and the upper half.
    pub(crate) fn halves(self) -> [u64; 2] {
        [self.0 as u64, (self.0 >> 64) as u64]
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "xxh3:{:032x}", self.0)
    }
}

/// Computes the fingerprint of a solid from its contents, in a fixed order.
///
/// Each piece is preceded by its length, so that no two sequences of pieces of one kind of solid give the
/// same bytes. A composite solid adds the fingerprints of its parts, from the leaves up, so that no recursion
/// is needed.
///
/// ```
/// use leafless::solid::Fingerprinter;
/// let ball = Fingerprinter::new("my ball").numbers(&[0.0, 0.0, 0.0, 1.0]).finish();
/// let shell = Fingerprinter::new("my shell").part(ball).numbers(&[0.1]).finish();
/// assert_ne!(ball, shell);
/// ```
#[derive(Clone)]
pub struct Fingerprinter(Xxh3Default);

/// The number of values that are passed to the hash at once.
const BATCH: usize = 64;

impl Fingerprinter {
    /// Begins with the kind of the solid, a name that no other kind uses. The name must change when verdicts
    /// change for a reason that the following data does not show.
    pub fn new(kind: &str) -> Fingerprinter {
        Fingerprinter(Xxh3Default::new()).bytes(kind.as_bytes())
    }

    /// Adds bytes.
    #[must_use]
    pub fn bytes(mut self, bytes: &[u8]) -> Fingerprinter {
        self.0.update(&(bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
        self
    }

    /// Adds doubles; −0 counts as 0.
    #[must_use]
    pub fn numbers(self, numbers: &[f64]) -> Fingerprinter {
        self.words(numbers.len() as u64, numbers.iter().map(|&number| (number + 0.0).to_bits()))
    }

    /// Adds integers.
    #[must_use]
    pub fn integers(self, integers: &[u64]) -> Fingerprinter {
        self.words(integers.len() as u64, integers.iter().copied())
    }

    /// Adds the fingerprint of a solid that this one contains.
    #[must_use]
    pub fn part(self, part: Fingerprint) -> Fingerprinter {
        self.bytes(&part.0.to_le_bytes())
    }

    /// Adds `count` numbers.
    #[must_use]
    pub(crate) fn words(mut self, count: u64, words: impl Iterator<Item = u64>) -> Fingerprinter {
        self.0.update(&count.to_le_bytes());
        let mut batch = [0; BATCH];
        let mut held = 0;
        for word in words {
            batch[held] = word.to_le();
            held += 1;
            if held == BATCH {
                self.0.update(bytemuck::bytes_of(&batch));
                held = 0;
            }
        }
        self.0.update(bytemuck::cast_slice(&batch[..held]));
        self
    }

    /// Returns the fingerprint of everything added so far.
    pub fn finish(&self) -> Fingerprint {
        Fingerprint(self.0.digest128())
    }
}

impl fmt::Debug for Fingerprinter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Fingerprinter").field(&self.finish()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::ToString;
    use alloc::vec::Vec;

    #[test]
    fn what_is_written_does_not_change() {
        // Fixed for good, because files hold these values. They are those of the algorithm's reference
        // implementation.
        let of = |all: Fingerprinter| all.finish().to_string();
        assert_eq!(of(Fingerprinter::new("")), "xxh3:2c0a8a99dc147d5445c3b49d035665b2");
        let ball = Fingerprinter::new("ball").numbers(&[1.0, 2.0, 3.0]).numbers(&[0.5]);
        assert_eq!(of(ball), "xxh3:bddaf2fb31e50ac9cd825b89a813385b");
        let long = Fingerprinter::new("long").words(1000, 0..1000);
        assert_eq!(of(long), "xxh3:0c566f367577d07a5058965c4f6668bd");
    }

    #[test]
    fn pieces_do_not_run_into_one_another() {
        let of = |pieces: &[&[u8]]| {
            pieces.iter().fold(Fingerprinter::new("k"), |all, piece| all.bytes(piece)).finish()
        };
        let all = [
            of(&[]),
            of(&[b""]),
            of(&[b"", b""]),
            of(&[b"ab"]),
            of(&[b"a", b"b"]),
            of(&[b"", b"ab"]),
            of(&[b"ab", b""]),
            Fingerprinter::new("ka").bytes(b"b").finish(),
        ];
        for (i, a) in all.iter().enumerate() {
            assert!(all.iter().skip(i + 1).all(|b| a != b), "{i}");
        }
    }

    #[test]
    fn batches_do_not_matter() {
        for count in [0, 1, BATCH - 1, BATCH, BATCH + 1, 3 * BATCH] {
            let words: Vec<u64> =
                (0..count as u64).map(|word| word.wrapping_mul(0x9E37_79B9_7F4A_7C15)).collect();
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            let mut whole = Fingerprinter::new("k");
            whole.0.update(&(count as u64).to_le_bytes());
            whole.0.update(&bytes);
            assert_eq!(Fingerprinter::new("k").integers(&words).finish(), whole.finish());
        }
        assert_eq!(
            Fingerprinter::new("k").numbers(&[0.0]).finish(),
            Fingerprinter::new("k").numbers(&[-0.0]).finish()
        );
    }
}
