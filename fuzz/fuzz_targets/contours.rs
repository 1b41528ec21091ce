//! Any bytes as a solid: its contours are closed, and what is proven of them is not contradicted.
#![no_main]

#[path = "../bodies/surfaces.rs"]
mod surfaces;

libfuzzer_sys::fuzz_target!(|data: &[u8]| surfaces::contours(data));
