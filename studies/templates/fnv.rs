//! FNV-1a (Fowler, Noll and Vo; IETF draft draft-eastlake-fnv): 64 bits for checksums, 128 bits for the hash of a case. It finds
//! a difference, not a forger. The build script compiles this file too, so it uses nothing but the standard library.

macro_rules! hash {
    ($name:ident, $number:ty, $offset:expr, $prime:expr, $digits:literal) => {
        #[doc = concat!("A hash that has ", $digits, " hexadecimal digits.")]
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name($number);

        impl $name {
            /// The hash of nothing.
            pub fn new() -> Self {
                $name($offset)
            }

            /// Adds bytes.
            pub fn add(&mut self, bytes: &[u8]) {
                self.0 = bytes.iter().fold(self.0, |hash, byte| (hash ^ <$number>::from(*byte)).wrapping_mul($prime));
            }

            /// Adds another hash.
            #[allow(dead_code, reason = "the build script adds none")]
            pub fn add_hash(&mut self, other: Self) {
                self.add(&other.0.to_le_bytes());
            }

            /// In hexadecimal.
            pub fn text(self) -> String {
                format!(concat!("{:0", $digits, "x}"), self.0)
            }
        }
    };
}

hash!(Fnv64, u64, 0xcbf2_9ce4_8422_2325, 0x100_0000_01b3, 16);
hash!(Fnv128, u128, 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d, (1 << 88) + 0x13b, 32);

impl std::io::Write for Fnv128 {
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

    /// Values of the draft's test vectors.
    #[test]
    fn hashes_are_those_of_the_draft() {
        let short = |text: &str| {
            let mut hash = Fnv64::new();
            hash.add(text.as_bytes());
            hash.text()
        };
        let long = |text: &str| {
            let mut hash = Fnv128::new();
            hash.add(text.as_bytes());
            hash.text()
        };
        assert_eq!(["", "a", "foobar"].map(short), ["cbf29ce484222325", "af63dc4c8601ec8c", "85944171f73967e8"]);
        assert_eq!(long(""), "6c62272e07bb014262b821756295c58d");
        assert_eq!(long("a"), "d228cb696f1a8caf78912b704e4a8964");
        assert_eq!(long("foobar"), "343e1662793c64bf6f0d3597ba446f18");
    }
}
