//! Any bytes as expressions of half-spaces, against exact arithmetic.
#![no_main]

#[path = "../bodies/csg.rs"]
mod csg;

libfuzzer_sys::fuzz_target!(|data: &[u8]| csg::csg(data));
