//! Any bytes as attributes, honest or not, and their uses, against dense arrays.
#![no_main]

#[path = "../bodies/attributes.rs"]
mod attributes;

libfuzzer_sys::fuzz_target!(|data: &[u8]| attributes::attributes(data));
