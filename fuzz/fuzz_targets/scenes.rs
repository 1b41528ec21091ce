//! Any bytes as a scene.
#![no_main]

#[path = "../bodies/scenes.rs"]
mod scenes;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    scenes::scenes(data);
});
