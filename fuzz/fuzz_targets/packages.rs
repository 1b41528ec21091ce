//! Any bytes as 3MF packages and their parts.
#![no_main]

#[allow(dead_code)]
#[path = "../bodies/packages.rs"]
mod packages;

libfuzzer_sys::fuzz_target!(|data: &[u8]| packages::packages(data));
