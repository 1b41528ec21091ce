//! Any bytes as a solid. Its boundaries are closed, and nothing contradicts their proven deviation.
#![no_main]

#[path = "../bodies/surfaces.rs"]
mod surfaces;

libfuzzer_sys::fuzz_target!(|data: &[u8]| surfaces::boundaries(data));
