//! Any bytes as scenes of unit cells and queries, against integer counts.
#![no_main]

#[path = "../bodies/measures.rs"]
mod measures;

libfuzzer_sys::fuzz_target!(|data: &[u8]| measures::measures(data));
