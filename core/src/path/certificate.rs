//! Certificates of paths.
