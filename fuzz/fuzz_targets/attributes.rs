//! Any bytes as attributes, honest and not, and what is made of them, against dense arrays.
#![no_main]

#[path = "../bodies/attributes.rs"]
mod attributes;

libfuzzer_sys::fuzz_target!(|data: &[u8]| attributes::attributes(data));
