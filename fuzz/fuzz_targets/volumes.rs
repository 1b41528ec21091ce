//! Any bytes as files of volumes.
#![no_main]

#[allow(dead_code)]
#[path = "../bodies/volumes.rs"]
mod volumes;

libfuzzer_sys::fuzz_target!(|data: &[u8]| volumes::volumes(data));
