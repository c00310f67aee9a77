//! Studies and results as files: read back unchanged, and every changed number found.

mod assembly_json;
mod figures;
mod forged_carried;
mod forged_claims;
mod forged_estimates;
mod forged_tables;
mod forgery;
mod gates;
mod labels;
mod left_out;
mod lower_bound;
mod outputs;
mod pages;
mod path_proofs;
mod report;
mod round_trip;
mod snaps;
mod streamed;
mod survey;
mod tampering;
mod tolerances;
mod units;
