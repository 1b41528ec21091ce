//! Any bytes as two solids that touch or nearly do. No answer contradicts another one.
#![no_main]

#[path = "../bodies/contacts.rs"]
mod contacts;

libfuzzer_sys::fuzz_target!(|data: &[u8]| contacts::contacts(data));
