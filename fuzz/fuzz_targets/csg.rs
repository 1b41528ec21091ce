//! Any bytes as expressions of half-spaces, against exact arithmetic.
#![no_main]

#[path = "../bodies/csg.rs"]
mod csg;
#[allow(dead_code)]
#[path = "../../tests/common/cubes.rs"]
mod cubes;
#[allow(dead_code)]
#[path = "../../tests/common/exact.rs"]
mod exact;
#[allow(dead_code)]
#[path = "../../tests/solids/csg/model.rs"]
mod model;

/// The module of the test suite.
mod common {
    pub(crate) use crate::{cubes, exact};
}

libfuzzer_sys::fuzz_target!(|data: &[u8]| csg::csg(data));
