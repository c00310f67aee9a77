//! Conformance of study kinds and writers; [`voussoir_verify::conformance`] checks all other plug-ins.

mod kinds;
mod standard;
mod writers;
