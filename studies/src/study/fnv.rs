//! 128 bits of FNV-1a (Fowler, Noll and Vo; IETF draft draft-eastlake-fnv).

use serde::Serialize;
use std::io::Write;

/// The hash of the written bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fnv(u128);

impl Fnv {
    const OFFSET: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = (1 << 88) + 0x13b;

    /// Returns the hash of a value's JSON.
    pub fn of(value: &impl Serialize) -> Self {
        let mut hash = Fnv(Fnv::OFFSET);
        // Writing to a hash does not fail.
        let _ = serde_json::to_writer(&mut hash, value);
        hash
    }

    /// Adds bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |hash, byte| (hash ^ u128::from(*byte)).wrapping_mul(Fnv::PRIME));
    }

    /// Adds another hash.
    pub fn add_hash(&mut self, other: Fnv) {
        self.add(&other.0.to_le_bytes());
    }

    /// Returns the hash in hexadecimal.
    pub fn text(self) -> String {
        format!("{:032x}", self.0)
    }
}

impl Write for Fnv {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.add(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test vectors of the draft.
    #[test]
    fn hashes_are_those_of_the_draft() {
        let hash = |text: &str| {
            let mut hash = Fnv(Fnv::OFFSET);
            hash.add(text.as_bytes());
            hash.text()
        };
        assert_eq!(hash(""), "6c62272e07bb014262b821756295c58d");
        assert_eq!(hash("a"), "d228cb696f1a8caf78912b704e4a8964");
        assert_eq!(hash("foobar"), "343e1662793c64bf6f0d3597ba446f18");
    }
}
